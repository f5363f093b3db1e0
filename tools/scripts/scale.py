#!/usr/bin/env python3
"""Compares the calibration of a scale with an independent calibration, on simulated months.

    pip install numpy scipy
    cargo xtask agreement --scale | python3 tools/scripts/scale.py

In this script, all linear predictors are one normal vector with a dense covariance (C. E. Rasmussen and C. K. I. Williams, "Gaussian
Processes for Machine Learning", 2006, chapter 3). The program uses effects of games and a Schur complement instead. Months are linked
by finite differences, and abilities are integrated over a fine grid. Prints the largest difference of each kind. Fails if a difference
is above 1e-2.
"""

import json
import sys

import numpy as np
from scipy import optimize, special

LIMIT = 1e-2
ABILITY_VARIANCE = 25.0


class Field:
    """Normal variables, each represented by its loadings on named, independent standard normal variables."""

    def __init__(self, spreads, examinees, shared):
        (self.game, self.level, self.family, self.planner) = spreads[:4]
        (self.game_slope, self.level_slope, self.game_rest, self.level_rest, self.reader) = spreads[4:]
        self.examinees, self.shared, self.names = examinees, shared, {}

    def difficulty(self, game, level, reads, shift):
        row = {}
        if reads:
            row["game", game] = self.game_slope * self.game
            row["level", game, level] = self.level_slope * self.level
            row["game rest", game] = self.game_rest
            row["level rest", game, level] = self.level_rest
        else:
            row["game", game] = self.game
            row["level", game, level] = self.level
        if shift:
            row["shift"] = (self.game_slope if reads else 1.0) * ABILITY_VARIANCE**0.5
            if reads:
                row["drift"] = ABILITY_VARIANCE**0.5
        return row

    def logit(self, examinee, game, level, shift):
        family = self.examinees[examinee]["family"]
        row = {name: -value for name, value in self.difficulty(game, level, family is None, shift).items()}
        if family is None:
            row["reader", examinee, game] = self.reader
        else:
            row["family", family, game] = self.family
            row["planner", examinee, game] = self.planner
        if not shift:
            row["ability", examinee] = ABILITY_VARIANCE**0.5
        return row


def dense(rows):
    names = {}
    for row in rows:
        for name in row:
            names.setdefault(name, len(names))
    matrix = np.zeros((len(rows), len(names)))
    for at, row in enumerate(rows):
        for name, value in row.items():
            matrix[at, names[name]] = value
    return matrix, list(names)


def mode(covariance, offset, won, of):
    """Returns the mode of the logits, the weights at the mode, and the logarithm of the integral."""
    deviation = np.zeros(len(won))
    alpha = np.zeros(len(won))
    for _ in range(200):
        chance = special.expit(offset + deviation)
        weight = of * chance * (1 - chance)
        root = np.sqrt(weight)
        factor = np.linalg.cholesky(np.eye(len(won)) + root[:, None] * covariance * root[None, :])
        b = weight * deviation + won - of * chance
        inner = np.linalg.solve(factor, root * (covariance @ b))
        target = b - root * np.linalg.solve(factor.T, inner)
        step = target - alpha
        length = 1.0
        while length > 1e-6 and np.abs(covariance @ step * length).max() > 5:
            length /= 2
        alpha = alpha + length * step
        deviation = covariance @ alpha
        if np.abs(length * step).max() < 1e-10:
            break
    logits = offset + deviation
    likelihood = (won * logits - of * np.logaddexp(0, logits)).sum()
    evidence = likelihood - 0.5 * alpha @ deviation - np.log(np.diag(factor)).sum()
    return alpha, weight, evidence


def expected(covariance, shared, offset, won, of):
    """Returns the normal distribution nearest to the posterior. The result consists of the means of the shared
    parameters, the weights of the logits' rows, the expected weights, and the covariance of the shared parameters.
    """
    nodes = np.arange(-3.0, 4.0)
    shares = np.exp(-(nodes**2) / 2) / np.exp(-(nodes**2) / 2).sum()
    values, alpha, variance = np.zeros(shared.shape[1]), np.zeros(len(won)), np.zeros(len(won))
    for _ in range(500):
        logits = offset + shared @ values + covariance @ alpha
        chances = special.expit(logits[:, None] + np.sqrt(variance)[:, None] * nodes[None, :])
        chance, weight = of * (chances @ shares), of * ((chances * (1 - chances)) @ shares)
        inverse = np.linalg.inv(covariance + np.diag(1 / weight))
        information = shared.T @ inverse @ shared + np.eye(len(values))
        target = shared @ values + covariance @ alpha + (won - chance) / weight
        new_values = np.linalg.solve(information, shared.T @ inverse @ target)
        new_alpha = inverse @ (target - shared @ new_values)
        variance = np.diag(covariance - covariance @ inverse @ covariance)
        move = max(np.abs(new_values - values).max(), np.abs(new_alpha - alpha).max())
        values, alpha = values + 0.7 * (new_values - values), alpha + 0.7 * (new_alpha - alpha)
        if move < 1e-9:
            break
    return values, alpha, inverse, np.linalg.inv(information)


def entries(month):
    plays = [(game, *one) for game, entries in enumerate(month) for one in entries]
    return plays, np.array([one[3] for one in plays]), np.array([one[4] for one in plays])


def solve(field, month, wanted, offsets):
    """Returns the means and the covariance of the wanted functions, each of which is a list of (share, row)."""
    plays, won, of = entries(month)
    shift = offsets is not None
    rows = [field.logit(examinee, game, level, shift) for game, examinee, level, _, _ in plays]
    offset = np.array([offsets[examinee] if shift else 0.0 for _, examinee, *_ in plays])
    flat = [row for parts in wanted for _, row in parts]
    all_rows, names = dense(rows + flat)
    is_shared = np.array([name in ("shift", "drift") or name[0] == "ability" for name in names])
    logits, parts = all_rows[: len(rows)], all_rows[len(rows) :]
    functions, at = np.zeros((len(wanted), all_rows.shape[1])), 0
    for which, shares in enumerate(wanted):
        for share, _ in shares:
            functions[which] += share * parts[at]
            at += 1
    own, own_functions = logits[:, ~is_shared], functions[:, ~is_shared]
    shared, shared_functions = logits[:, is_shared], functions[:, is_shared]
    values, alpha, inverse, of_shared = expected(own @ own.T, shared, offset, won, of)
    cross = own_functions @ own.T
    means = shared_functions @ values + cross @ alpha
    slopes = shared_functions - cross @ inverse @ shared
    within = own_functions @ own_functions.T - cross @ inverse @ cross.T
    return means, slopes @ of_shared @ slopes.T + within


def evidence_of(parameters, examinees, month):
    spreads = to_spreads(parameters)
    field = Field(spreads, examinees, None)
    plays, won, of = entries(month)
    rows, _ = dense([field.logit(examinee, game, level, False) for game, examinee, level, _, _ in plays])
    _, _, evidence = mode(rows @ rows.T, np.zeros(len(won)), won, of)
    return evidence - 0.5 * (np.asarray(parameters) ** 2).sum()


def to_spreads(parameters):
    spreads = np.exp(parameters)
    spreads[4:6] = np.asarray(parameters)[4:6]
    return spreads


def mean_rows(field, levels, reads, shift):
    return [(1 / len(levels), field.difficulty(game, level, reads, shift)) for game, level in levels]


def planners_rows(field, levels, planners, shift):
    share = 1 / len(levels) / len(planners)
    return [(share, field.logit(one, game, level, shift)) for game, level in levels for one in planners]


def person(found):
    """Returns the mean, the standard deviation and the ends of the interval of an ability's posterior."""
    steps = np.linspace(-9, 9, 361)
    nodes, weights = np.polynomial.hermite_e.hermegauss(41)
    weights = weights / weights.sum()
    # The nodes of the mismatch are part of the model.
    mismatches = 0.2 * 1.4 ** np.arange(10)
    logs = np.zeros((len(mismatches), len(steps)))
    logs += -0.5 * (np.log(mismatches)[:, None] / 0.7) ** 2 - 0.5 * (steps[None, :] / 5) ** 2
    for game in found:
        for which, mismatch in enumerate(mismatches):
            sd = np.hypot(mismatch, game["common"])
            centre = steps[:, None] + sd * nodes[None, :]
            likelihood = np.ones_like(centre)
            for difficulty, own, won, of in game["levels"]:
                logit = centre[:, :, None] - difficulty + own * nodes[None, None, :]
                log = won * logit - of * np.logaddexp(0, logit)
                likelihood *= (np.exp(log) * weights).sum(axis=2)
            logs[which] += np.log((likelihood * weights).sum(axis=1))
    density = np.exp(logs - logs.max()).sum(axis=0)
    density /= density.sum()
    mean = density @ steps
    total = np.concatenate([[0], np.cumsum((density[1:] + density[:-1]) / 2)])
    ends = np.interp([0.025, 0.975], total / total[-1], steps)
    return [mean, np.sqrt(density @ (steps - mean) ** 2), *ends]


def main():
    given = json.load(sys.stdin)
    examinees, months = given["examinees"], given["months"]
    start = np.array([np.log(1.0)] * 4 + [0.5, 0.5] + [np.log(0.7)] * 3)
    search = optimize.minimize(
        lambda x: -evidence_of(x, examinees, months[0]), start, method="L-BFGS-B", options={"maxfun": 20000}
    )
    spreads = to_spreads(search.x)
    worst = {}

    def compare(kind, found, expect):
        apart = np.abs(np.asarray(found, float) - np.asarray(expect, float)).max()
        worst[kind] = max(worst.get(kind, 0), apart)

    compare("spreads", given["spreads"], spreads)
    # The following values are compared at the program's spreads, so that a small difference in the spreads is not
    # counted again.
    field = Field(given["spreads"], examinees, None)
    count = len(examinees)
    levels = [(game, level) for game in range(len(months[0])) for level in range(3)]
    planners = [at for at, one in enumerate(examinees) if one["family"] is not None]
    wanted = [[(1.0, {("ability", at): ABILITY_VARIANCE**0.5})] for at in range(count)]
    wanted += [mean_rows(field, levels, reads, False) for reads in (False, True)]
    wanted += [planners_rows(field, levels, planners, False)]
    wanted += [[(1.0, field.difficulty(*level, reads, False))] for reads in (False, True) for level in levels]
    means, covariance = solve(field, months[0], wanted, None)
    joint = covariance[: count + 3, : count + 3]
    for at, one in enumerate(examinees):
        origin = count + (one["family"] is None)
        variance = joint[at, at] + joint[origin, origin] - 2 * joint[at, origin]
        compare("abilities", given["abilities"][at], [means[at] - means[origin], variance**0.5])
    for reads in (0, 1):
        own = np.reshape(given["difficulties"][0][reads], (-1, 2))
        first = count + 3 + reads * len(levels)
        compare("difficulties", own[:, 0], means[first : first + len(levels)] - means[count + reads])
    abilities = means[:count]

    def second(offsets):
        wanted = [mean_rows(field, levels, reads, True) for reads in (False, True)]
        wanted += [planners_rows(field, levels, planners, True), [(1.0, {"drift": ABILITY_VARIANCE**0.5})]]
        wanted += [[(1.0, field.difficulty(*level, reads, True))] for reads in (False, True) for level in levels]
        found, covariance = solve(field, months[1], wanted, offsets)
        found[2] += np.mean([offsets[one] for one in planners])
        return found, covariance

    found, covariance = second(abilities)
    # The factors by which each value changes with the abilities.
    moves = np.zeros((4, count + 3))
    for at in range(count):
        near = abilities.copy()
        near[at] += 1e-4
        moves[:, at] = (second(near)[0][:4] - found[:4]) / 1e-4
    for which in range(3):
        moves[which, count + which] -= 1
    errors = np.sqrt(np.diag(covariance)[:4] + np.diag(moves @ joint @ moves.T))
    for reads in (0, 1):
        compare("shifts", given["shifts"][reads], [found[reads] - means[count + reads], errors[reads]])
        own = np.reshape(given["difficulties"][1][reads], (-1, 2))
        first = 4 + reads * len(levels)
        compare("difficulties", own[:, 0], found[first : first + len(levels)] - means[count + reads])
    compare("shift for these planners", given["planners_shift"], [means[count + 2] - found[2], errors[2]])
    compare("drift", given["drift"], [found[3], errors[3]])
    compare("ability of a player", given["ability"], person(given["person"]))
    for kind, apart in worst.items():
        print(f"{kind:26} {apart:.1e}")
    if max(worst.values()) > LIMIT:
        sys.exit(f"a difference is above {LIMIT}")


if __name__ == "__main__":
    main()
