# Reads answers (scene, participant, technique, mid-rank, weight) and prints, line by line, a name and a
# value of what base R makes of them.
answers <- read.csv(commandArgs(trailingOnly = TRUE)[1])
say <- function(..., value) cat(paste(..., sep = "|"), sprintf("%.15g", value), "\n")

for (scene in unique(answers$scene)) {
  here <- answers[answers$scene == scene, ]
  ranks <- tapply(here$rank, list(here$participant, here$technique), mean)
  weights <- tapply(here$weight, here$participant, mean)[rownames(ranks)]
  names <- colnames(ranks)
  complete <- ranks[complete.cases(ranks), ]

  if (nrow(complete) == nrow(ranks)) {
    test <- friedman.test(complete)
    say(scene, "friedman", "chi_square", value = test$statistic)
    say(scene, "friedman", "p_value", value = test$p.value)
  }
  test <- quade.test(complete)
  say(scene, "quade", "f", value = test$statistic)
  say(scene, "quade", "p_value", value = test$p.value)

  for (name in names) {
    column <- ranks[, name]
    seen <- !is.na(column)
    say(scene, name, "mean_rank", value = mean(column[seen]))
    say(scene, name, "sd", value = sd(column[seen]))
    say(scene, name, "median", value = median(column[seen]))
    interval <- t.test(column[seen])$conf.int
    say(scene, name, "ci95_low", value = interval[1])
    say(scene, name, "ci95_high", value = interval[2])
    w <- weights[seen]
    fit <- lm(column[seen] ~ 1, weights = w)
    say(scene, name, "weighted_mean_rank", value = coef(fit))
    # HC1: (X'WX)^-1 X'W diag(e^2) W X (X'WX)^-1, times n / (n - 1)
    hc1 <- sum((w * residuals(fit))^2) / sum(w)^2 * length(w) / (length(w) - 1)
    say(scene, name, "weighted_se", value = sqrt(hc1))
  }

  pairs <- combn(names, 2)
  p <- list(paired_t = c(), wilcoxon = c(), sign = c())
  for (i in seq_len(ncol(pairs))) {
    a <- pairs[1, i]
    b <- pairs[2, i]
    d <- (ranks[, a] - ranks[, b])
    d <- d[!is.na(d)]
    t <- t.test(d)
    say(scene, "paired_t", a, b, "t", value = t$statistic)
    say(scene, "paired_t", a, b, "p_value", value = t$p.value)
    dz <- function(p) uniroot(function(x) pt(t$statistic, t$parameter, x) - p, c(-35, 35),
                              tol = 1e-12)$root / sqrt(length(d))
    say(scene, "paired_t", a, b, "dz_low", value = dz(0.975))
    say(scene, "paired_t", a, b, "dz_high", value = dz(0.025))
    w <- suppressWarnings(wilcox.test(d))
    say(scene, "wilcoxon", a, b, "statistic_v", value = w$statistic)
    say(scene, "wilcoxon", a, b, "p_value", value = w$p.value)
    s <- binom.test(sum(d < 0), sum(d != 0))
    say(scene, "sign", a, b, "p_value", value = s$p.value)
    p$paired_t <- c(p$paired_t, t$p.value)
    p$wilcoxon <- c(p$wilcoxon, w$p.value)
    p$sign <- c(p$sign, s$p.value)
    k <- length(names)
    sums <- colSums(t(apply(complete, 1, rank)))
    q <- abs(sums[a] - sums[b]) / sqrt(nrow(complete) * k * (k + 1) / 12)
    say(scene, "nemenyi", a, b, "p_value",
        value = ptukey(q, k, Inf, lower.tail = FALSE))
  }
  for (test in names(p)) for (method in c("bonferroni", "holm", "hochberg")) {
    adjusted <- p.adjust(p[[test]], method)
    for (i in seq_len(ncol(pairs)))
      say(scene, test, pairs[1, i], pairs[2, i], paste0("p_", method), value = adjusted[i])
  }
}
