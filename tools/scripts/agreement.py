#!/usr/bin/env python3
"""Compares the statistics of reports with scipy and statsmodels on random inputs.

    pip install numpy scipy statsmodels
    cargo xtask agreement | python3 tools/scripts/agreement.py

Prints the largest relative error of each function. Fails if an error is above 1e-8.
"""

import json
import math
import sys
import warnings
from collections import Counter, defaultdict

import numpy as np
from scipy import stats
from statsmodels.stats.multitest import multipletests
from statsmodels.stats.proportion import confint_proportions_2indep, proportion_confint, proportion_effectsize

LIMIT = 1e-8


def exact_within_strata(strata):
    """Returns the two-sided p-value of the sum of independent hypergeometric numbers, and the odds ratio of Mantel
    and Haenszel.
    """
    chances, observed, odds, against = np.array([1.0]), 0, 0.0, 0.0
    for a, m, b, n in strata:
        first, last = max(0, a + b - n), min(m, a + b)
        chances = np.convolve(chances, stats.hypergeom.pmf(np.arange(first, last + 1), m + n, a + b, m))
        observed += a - first
        odds += a * (n - b) / (m + n)
        against += b * (m - a) / (m + n)
    p = min(1.0, chances[chances <= chances[observed] * (1 + 1e-7)].sum())
    return [p, odds / against if against > 0 else None]


def rate_over_games(games):
    won, of = (np.array(column, float) for column in zip(*games))
    rate, count = won.sum() / of.sum(), len(games)
    variance = ((won - rate * of) ** 2).sum() * count / (count - 1) / of.sum() ** 2
    effective = min(max(rate * (1 - rate) / variance, 1), of.sum()) if variance > 1e-18 else count
    alpha = 2 * stats.norm.sf(stats.t.ppf(0.975, count - 1))
    low, high = proportion_confint(rate * effective, effective, alpha, "wilson")
    return [rate, effective, low, high]


def paired_over_games(games):
    ours, theirs = zip(*games)
    test = stats.ttest_rel(ours, theirs)
    interval = test.confidence_interval(0.95)
    p = max(test.pvalue, 2.0 ** (1 - len(games)))
    return [np.mean(ours) - np.mean(theirs), p, max(interval.low, -1), min(interval.high, 1)]


def welch(groups):
    test = stats.ttest_ind(*groups, equal_var=False)
    return [test.statistic, test.df, test.pvalue] if math.isfinite(test.statistic) else None


def correlation(test):
    def of(pairs):
        found = test(*zip(*pairs))
        return [found.statistic, found.pvalue] if math.isfinite(found.statistic) else None
    return of


THEIRS = {
    "wilson": lambda given: proportion_confint(*given, method="wilson"),
    "difference": lambda g: confint_proportions_2indep(*g, method="newcomb", compare="diff"),
    "fisher": lambda g: stats.fisher_exact([[g[0], g[1] - g[0]], [g[2], g[3] - g[2]]])[1],
    "stratified": exact_within_strata,
    "benjamini_hochberg": lambda p: list(multipletests(p, method="fdr_bh")[1]),
    "cohens_h": lambda given: proportion_effectsize(*given),
    "quantile": lambda given: np.quantile(*given),
    "welch": welch,
    "pearson": correlation(stats.pearsonr),
    "spearman": correlation(stats.spearmanr),
    "student": lambda g: [2 * stats.t.sf(abs(g[0]), g[1]), stats.t.isf(g[2] / 2, g[1])],
    # Strictly, both tails count. At these powers, the far tail is negligible.
    "power": lambda g: (stats.norm.isf(0.025) + stats.norm.ppf(g[1])) * math.sqrt(2 / g[0]),
    "rate_over_games": rate_over_games,
    "paired_over_games": paired_over_games,
}


def flat(value):
    if isinstance(value, (list, tuple, np.ndarray)):
        return [leaf for part in value for leaf in flat(part)]
    return [value]


def error(ours, theirs):
    if ours is None or theirs is None:
        return 0.0 if ours is None and theirs is None else math.inf
    return abs(ours - theirs) / max(abs(theirs), 1e-6)


def main():
    warnings.simplefilter("ignore")
    worst, cases = defaultdict(lambda: (0.0, None)), Counter()
    for line in sys.stdin:
        case = json.loads(line)
        name = case["function"]
        ours, theirs = flat(case["output"]), flat(THEIRS[name](case["input"]))
        found = max(map(error, ours, theirs)) if len(ours) == len(theirs) else math.inf
        cases[name] += 1
        worst[name] = max(worst[name], (found, line), key=lambda pair: pair[0])
    for name in THEIRS:
        print(f"{name:20} {cases[name]:5} inputs, largest relative error {worst[name][0]:.1e}")
    bad = [name for name, (found, _) in worst.items() if not found <= LIMIT]
    for name in bad:
        print(f"{name}: {worst[name][1].strip()}\n  there: {THEIRS[name](json.loads(worst[name][1])['input'])}")
    print(f"{sum(cases.values())} inputs, {'all agree' if not bad else 'NOT all agree'}")
    return 1 if bad or not cases else 0


sys.exit(main())
