"""Recomputes the headline numbers of results.json from responses.csv with pandas:

    python3 recompute.py responses.csv

Prints scene,quantity,value. ALL pools the scenes: each participant counts once, by the mean of the
pages that they answered. Second showings and people who were taken out are left out. With scipy
installed, p-values stand beside the statistics.
"""

import itertools
import math
import sys

import pandas

try:
    from scipy import stats
except ImportError:
    stats = None


def say(scene, quantity, value):
    print(f"{scene},{quantity},{value:.12g}")


def by_participant(part, column):
    # Rounded, since means of mid-ranks that are equal may differ in their last digit.
    return part.pivot_table(index="participant", columns="technique", values=column,
                            aggfunc="mean").round(9)


def friedman(complete):
    """Chi-square corrected for ties, and its degrees of freedom."""
    n, k = complete.shape
    ranks = complete.rank(axis=1)
    ties = sum((count ** 3 - count) for _, row in ranks.iterrows() for count in row.value_counts())
    spread = 12.0 * ((ranks.sum() - n * (k + 1) / 2.0) ** 2).sum() / (n * k * (k + 1))
    correction = 1.0 - ties / (n * k * (k * k - 1))
    return (spread / correction if correction > 0 else math.nan), k - 1


def report(scene, part):
    values = by_participant(part, "value")
    names = sorted(values.columns)
    for name in names:
        say(scene, f"n:{name}", values[name].count())
        say(scene, f"mean_rank:{name}", values[name].mean())
    complete = by_participant(part, "rank_1_is_most_realistic").dropna()
    if len(complete) > 1 and len(complete.columns) > 1:
        statistic, df = friedman(complete)
        say(scene, "friedman_chi_square", statistic)
        say(scene, "friedman_df", df)
        if stats:
            say(scene, "friedman_p", stats.chi2.sf(statistic, df))
    pairs = list(itertools.combinations(names, 2))
    for a, b in pairs:
        d = (values[a] - values[b]).dropna()
        if len(d) < 2 or d.var() < 1e-18:
            continue
        t = d.mean() / (d.std() / math.sqrt(len(d)))
        say(scene, f"paired_t:{a}:{b}", t)
        if stats:
            say(scene, f"p_bonferroni:{a}:{b}",
                min(1.0, len(pairs) * 2.0 * stats.t.sf(abs(t), len(d) - 1)))


def main():
    rows = pandas.read_csv(sys.argv[1],
                           dtype={"participant": str, "scene": str, "technique": str})
    if "included" in rows:
        rows = rows[~rows["included"].astype(str).str.upper().isin(["FALSE", "0"])]
    if "repeat" in rows:
        rows = rows[rows["repeat"].fillna(0) == 0]
    digits = rows.get("digit_as_typed")
    if digits is not None and "best_digit" in rows:  # counted from 1 for the most realistic
        digits = digits.where(rows["best_digit"] != 9, 10 - digits)
    as_typed = digits is not None and bool(digits.notna().all()) and len(rows) > 0
    rows = rows.assign(value=digits if as_typed else rows["rank_1_is_most_realistic"])
    print("scene,quantity,value")
    for scene in sorted(rows["scene"].unique()):
        report(scene, rows[rows["scene"] == scene])
    report("ALL", rows)


main()
