# Recomputes the headline numbers of results.json from responses.csv, in R alone:
#   Rscript recompute.R responses.csv
# Prints scene,quantity,value. ALL pools the scenes: each participant counts once, by the mean of the
# pages that they answered. Second showings and people who were taken out are left out.
file <- commandArgs(trailingOnly = TRUE)[1]
rows <- read.csv(file, check.names = FALSE, encoding = "UTF-8", na.strings = "",
                 colClasses = c(participant = "character", scene = "character", technique = "character"))
if ("included" %in% names(rows)) rows <- rows[!toupper(rows$included) %in% c("FALSE", "0"), ]
if ("repeat" %in% names(rows)) rows <- rows[is.na(rows[["repeat"]]) | rows[["repeat"]] == 0, ]
digits <- rows$digit_as_typed
# Counted from 1 for the most realistic.
if (!is.null(digits) && !is.null(rows$best_digit)) digits <- ifelse(rows$best_digit %in% 9, 10 - digits, digits)
as_typed <- !is.null(digits) && all(!is.na(digits))
rows$value <- if (as_typed) digits else rows$rank_1_is_most_realistic

say <- function(scene, quantity, value) writeLines(paste(scene, quantity, format(value, digits = 12), sep = ","))
by_participant <- function(part, column) {
  # Rounded, since means of mid-ranks that are equal may differ in their last digit.
  round(tapply(part[[column]], list(part$participant, part$technique), mean), 9)
}
cat("scene,quantity,value\n")
report <- function(scene, part) {
  values <- by_participant(part, "value")
  for (name in sort(colnames(values), method = "radix")) {
    say(scene, paste0("n:", name), sum(!is.na(values[, name])))
    say(scene, paste0("mean_rank:", name), mean(values[, name], na.rm = TRUE))
  }
  ranks <- by_participant(part, "rank_1_is_most_realistic")
  complete <- ranks[complete.cases(ranks), , drop = FALSE]
  if (nrow(complete) > 1 && ncol(complete) > 1) {
    test <- suppressWarnings(friedman.test(complete))
    say(scene, "friedman_chi_square", unname(test$statistic))
    say(scene, "friedman_df", unname(test$parameter))
    say(scene, "friedman_p", test$p.value)
  }
  names <- sort(colnames(values), method = "radix")
  pairs <- if (length(names) > 1) combn(names, 2) else matrix(character(0), 2, 0)
  for (i in seq_len(ncol(pairs))) {
    d <- values[, pairs[1, i]] - values[, pairs[2, i]]
    d <- d[!is.na(d)]
    if (length(d) < 2 || var(d) < 1e-18) next
    test <- t.test(d)
    label <- paste(pairs[1, i], pairs[2, i], sep = ":")
    say(scene, paste0("paired_t:", label), unname(test$statistic))
    say(scene, paste0("p_bonferroni:", label), min(1, test$p.value * ncol(pairs)))
  }
}
for (scene in sort(unique(rows$scene), method = "radix")) report(scene, rows[rows$scene == scene, ])
report("ALL", rows)
