"""A curriculum over streams: levels that the learner wins about half of the time.

>>> import infinite_arcade as ia
>>> curriculum = ia.Curriculum("lessons", ["hailglass", "foxglove-round"])
>>> lesson = curriculum.draw()
>>> curriculum.report(lesson, [1, 0, 0, 1, 1, 0, 0, 0])    # eight episodes of curriculum.item(lesson)
>>> curriculum.recent_useful
1.0

Training that compares the episodes of a group, such as GRPO, learns nothing from a group whose episodes all have the
same result. A group is *useful* if its results differ. The curriculum chooses the family (a game) and the difficulty of
each lesson so that groups are useful.

The method is adaptive testing with item response theory. In a family, the learner wins a level of difficulty ``d`` with
the probability ``p(d) = 1 / (1 + exp(slope × d - ability))``. For each family, the curriculum keeps a posterior over a
grid of abilities and slopes, with a broad prior. The ``k``-th newest report of the family has the weight ``decay^k``,
so that the posterior follows a learner that improves or forgets. The value of a difficulty is the posterior mean of
``4 p (1 - p)``, which is the information of an item in the Rasch model and the learnability of Rutherford et al. (2024,
arXiv:2408.15099). It is 1 if the learner wins half of the episodes, and 0 if the learner wins or loses all of them.

- A difficulty is drawn with a probability proportional to the fourth power of its value.
- A family is drawn with a probability proportional to the square of its value. That is the highest value of its
  difficulties, times the ratio of the useful groups to the number that the posterior predicts. The ratio lowers the
  weight of a family whose levels are each always won or always lost, whatever their difficulty.
- With the probability ``explore``, all families are equally likely. Families that are too hard or too easy are
  therefore tried again now and then.

RLVE (2025) also adapts the difficulty of each environment to the learner, and prioritized level
replay (Jiang et al., 2021, arXiv:2010.03934) draws levels by their learning potential. The curriculum needs
no store of levels, because each lesson has a new level.
"""

from __future__ import annotations

import math
from bisect import insort
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._arguments import Seed, at_least, did_you_mean, seed_text
from ._native import ArcadeError
from .games import Game, seed_child, seed_from_text
from .streams import Games, Stream, StreamItem

__all__ = ["Curriculum", "Lesson"]

#: The grid of the posterior, and the logarithm of its prior: a normal distribution of the ability at the middle of the
#: range of difficulty, and an exponential distribution of the slope.
_ABILITIES, _SLOPES = (axis.ravel() for axis in np.meshgrid(np.linspace(-6, 12, 37), [0.0, 1.0, 2.0, 4.0, 8.0]))
_PRIOR = -((_ABILITIES - _SLOPES / 2) ** 2) / (2 * 2.5**2) - _SLOPES / 4

#: The exponents with which the values of difficulties and families become weights.
_OF_DIFFICULTIES, _OF_FAMILIES = 4, 2

#: The number of predicted useful groups by which the ratio of useful groups is smoothed.
_SMOOTHING = 2.0

#: The number of newest reports of which :attr:`Curriculum.recent_useful` is the share.
_RECENT = 100

#: Reports with a smaller weight than this are dropped.
_NEGLIGIBLE = 1e-3

#: The number of hexadecimal digits in a random number.
_DIGITS = 13


@dataclass(frozen=True)
class Lesson:
    """A family and a difficulty for the next group of episodes. A lesson is plain data, and every process that has a
    curriculum with the same arguments can make its level.
    """

    #: The number of the lesson, which is also the position of its level in the stream.
    number: int
    #: The ID of the game.
    family: str
    #: The difficulty, from 0 to 1.
    difficulty: float


#: A report: the number of the lesson, its difficulty, the sum of the results, the number of results, and whether the
#: results differ.
_Report = tuple[int, float, float, int, bool]


class Curriculum:
    """A sampler of lessons that adapts to the learner's results.

    A lesson depends only on the arguments, its number, and the reports so far, whose order does not matter. Reports may
    be late or missing, so several workers can play the lessons of one curriculum. A copied, pickled or restored
    curriculum continues like the original.
    """

    def __init__(
        self,
        seed: Seed,
        games: Games = None,
        *,
        difficulties: Sequence[float] = (0.0, 0.25, 0.5, 0.75, 1.0),
        decay: float = 0.9,
        explore: float = 0.1,
        **arguments: Any,
    ) -> None:
        """Creates a curriculum without reports.

        Args:
            seed: the text or integer from which the lessons and the streams are derived.
            games: the families, as in :func:`infinite_arcade.stream`; by default the corpus.
            difficulties: the difficulties of the lessons, each from 0 to 1.
            decay: the weight of a report relative to the next newer report of the same family, from 0 to 1, both
                excluded. A posterior rests on about ``1 / (1 - decay)`` reports.
            explore: the probability with which all families are equally likely, greater than 0 and at most 1. With 1,
                the curriculum samples families uniformly.
            arguments: the arguments ``size``, ``start_level``, ``num_levels`` and ``avoid`` of
                :func:`infinite_arcade.stream`.

        Raises:
            TypeError: if there is no such argument.
            ValueError: if an argument is invalid, or two games have the same ID.
        """
        if not difficulties or not all(0 <= difficulty <= 1 for difficulty in difficulties):
            raise ValueError(f"`difficulties` must be numbers from 0 to 1, not {difficulties!r}")
        if len(set(difficulties)) < len(difficulties):
            raise ValueError(f"`difficulties` must not repeat a number, unlike {difficulties!r}")
        if not 0 < decay < 1:
            raise ValueError(f"`decay` must be greater than 0 and less than 1, not {decay}")
        if not 0 < explore <= 1:
            raise ValueError(f"`explore` must be greater than 0 and at most 1, not {explore}")
        if "difficulty" in arguments:
            raise TypeError("a curriculum chooses the difficulty itself; pass `difficulties` for those to choose from")
        if "avoid" in arguments:
            arguments["avoid"] = tuple(arguments["avoid"])
        self._seed = seed_from_text(seed_text(seed))
        self.difficulties = tuple(map(float, difficulties))
        self.decay, self.explore = decay, explore
        whole = Stream(seed, games, **arguments)
        #: The games by ID.
        self.families: dict[str, Game] = {game.id: game for game in whole.games}
        if len(self.families) < len(whole.games):
            raise ValueError("two games have the same ID; give each a different `id`")
        self._arguments: tuple[Seed, dict[str, Any]] = seed, arguments
        self._streams: dict[tuple[str, float], Stream] = {}
        self._kept = math.ceil(math.log(_NEGLIGIBLE) / math.log(decay))
        self._next = 0
        self._reports: dict[str, list[_Report]] = {family: [] for family in self.families}
        self._recent: list[tuple[int, bool]] = []
        self._groups = self._useful = 0
        self._estimates: dict[str, _Estimate] = {}

    @property
    def groups(self) -> int:
        """The number of groups reported so far. Reports without results do not count."""
        return self._groups

    @property
    def useful(self) -> float:
        """The share of useful groups among all reported groups, or NaN before the first report."""
        return self._useful / self._groups if self._groups else math.nan

    @property
    def recent_useful(self) -> float:
        """The share of useful groups among the 100 newest reported lessons, or NaN before the first report."""
        return sum(useful for _, useful in self._recent) / len(self._recent) if self._recent else math.nan

    def draw(self, number: int | None = None) -> Lesson:
        """Chooses a lesson. By default, the number of the lesson follows that of the previous call without a number.

        Raises:
            ValueError: if ``number`` is negative.
        """
        at_least(0, number=number)
        if number is None:
            number, self._next = self._next, self._next + 1
        digits = seed_child(self._seed, "curriculum", number)
        uniform = [int(digits[at : at + _DIGITS], 16) / 16**_DIGITS for at in range(0, 3 * _DIGITS, _DIGITS)]
        names = sorted(self.families)
        weights = np.array([1.0 if uniform[0] < self.explore else self.weight(family) for family in names])
        family = names[_drawn(weights, uniform[1])]
        difficulty = self.difficulties[_drawn(self._estimate(family).values ** _OF_DIFFICULTIES, uniform[2])]
        return Lesson(number, family, difficulty)

    def item(self, lesson: Lesson) -> StreamItem:
        """Makes the level of a lesson, in up to a few seconds. The level does not depend on any report.

        Raises:
            ArcadeError: if the stream has no level for this lesson. Report the lesson with no results in this case.
            ValueError: if the lesson is not one of this curriculum.
        """
        self._check(lesson)
        key = lesson.family, lesson.difficulty
        if key not in self._streams:
            seed, arguments = self._arguments
            game = self.families[lesson.family]
            self._streams[key] = Stream(seed, game, difficulty=lesson.difficulty, **arguments)
        return self._streams[key][lesson.number]

    def __iter__(self) -> Iterator[tuple[Lesson, StreamItem]]:
        """Returns an endless iterator over lessons and their levels. If a lesson has no level, that is reported, and
        the next lesson follows.
        """
        while True:
            lesson = self.draw()
            try:
                item = self.item(lesson)
            except ArcadeError:
                self.report(lesson, [])
            else:
                yield lesson, item

    def report(self, lesson: Lesson, results: Sequence[float]) -> None:
        """Records the results of the group of a lesson.

        Args:
            lesson: the lesson, which :meth:`draw` has returned.
            results: one number from 0 to 1 per episode: 1 for a win and 0 for a loss, or a reward. The list is empty if
                the lesson has no level.

        Raises:
            ValueError: if the lesson is not one of this curriculum or was reported before, or a result is not from 0
                to 1.
        """
        self._check(lesson)
        results = [float(result) for result in results]
        if not all(0 <= result <= 1 for result in results):
            raise ValueError(f"`results` must be numbers from 0 to 1, not {results}")
        reports = self._reports[lesson.family]
        if any(report[0] == lesson.number for report in reports):
            raise ValueError(f"lesson {lesson.number} was reported before")
        useful = len(set(results)) > 1
        insort(reports, (lesson.number, lesson.difficulty, sum(results), len(results), useful))
        del reports[: -self._kept]
        self._estimates.pop(lesson.family, None)
        if results:
            self._groups += 1
            self._useful += useful
            insort(self._recent, (lesson.number, useful))
            del self._recent[:-_RECENT]

    def win_rate(self, family: str, difficulty: float) -> float:
        """Returns the estimated win rate of the learner at a difficulty.

        Raises:
            KeyError: if there is no such family.
        """
        return float(_rates([difficulty])[0] @ self._estimate(family).posterior)

    def weight(self, family: str) -> float:
        """Returns the weight of a family, to which its probability is proportional in lessons that do not explore.

        Raises:
            KeyError: if there is no such family.
        """
        return self._estimate(family).weight

    def state_dict(self) -> dict[str, Any]:
        """Returns the reports and counters as plain data, which JSON can store."""
        return {
            "next": self._next,
            "groups": self._groups,
            "useful": self._useful,
            "recent": [list(entry) for entry in self._recent],
            "reports": {family: [list(report) for report in reports] for family, reports in self._reports.items()},
        }

    def load_state_dict(self, state: dict[str, Any]) -> None:
        """Replaces the reports and counters by those of :meth:`state_dict`. The arguments of both curricula must be
        equal.

        Raises:
            ValueError: if the families differ.
        """
        if state["reports"].keys() != self.families.keys():
            found, own = ", ".join(state["reports"]), ", ".join(self.families)
            raise ValueError(f"the state has the families {found}, not {own}")
        self._next, self._groups, self._useful = state["next"], state["groups"], state["useful"]
        self._recent = [(number, useful) for number, useful in state["recent"]]
        self._reports = {
            family: [(number, difficulty, total, count, useful) for number, difficulty, total, count, useful in reports]
            for family, reports in state["reports"].items()
        }
        self._estimates = {}

    def _check(self, lesson: Lesson) -> None:
        if lesson.family not in self.families:
            hint = did_you_mean(lesson.family, self.families)
            raise ValueError(f"the curriculum has no family `{lesson.family}`{hint}")
        if lesson.difficulty not in self.difficulties:
            raise ValueError(f"the curriculum has no difficulty {lesson.difficulty}; it has {self.difficulties}")

    def _estimate(self, family: str) -> _Estimate:
        if family not in self._estimates:
            self._estimates[family] = _Estimate(self._reports[family], self.difficulties, self.decay)
        return self._estimates[family]

    def __repr__(self) -> str:
        return f"<Curriculum of {len(self.families)} families, {self._groups} groups>"


class _Estimate:
    """The posterior of a family, and the values that follow from it."""

    __slots__ = ("posterior", "values", "weight")

    def __init__(self, reports: list[_Report], difficulties: Sequence[float], decay: float) -> None:
        weights = decay ** np.arange(len(reports) - 1, -1, -1)
        levels, totals, counts, useful = np.array([report[1:] for report in reports]).reshape(-1, 4).T
        rates, counts = _rates(levels), counts[:, None]
        terms = totals[:, None] * np.log(rates) + (counts - totals[:, None]) * np.log1p(-rates)
        logarithm = _PRIOR + weights @ terms
        posterior = np.exp(logarithm - logarithm.max())
        #: The probabilities of the points of the grid.
        self.posterior: NDArray[np.float64] = posterior / posterior.sum()
        offered = _rates(difficulties)
        #: The values of the difficulties.
        self.values: NDArray[np.float64] = (4 * offered * (1 - offered)) @ self.posterior
        chances = np.where(counts > 0, 1 - rates**counts - (1 - rates) ** counts, 1.0) @ self.posterior
        # A report without results counts as a group that should have been useful.
        ratio = min(1.0, float((_SMOOTHING + weights @ useful) / (_SMOOTHING + weights @ chances)))
        #: The weight of the family.
        self.weight = (float(self.values.max()) * ratio) ** _OF_FAMILIES


def _rates(difficulties: Sequence[float] | NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the win rates of the points of the grid, ``[difficulties][points]``."""
    rates: NDArray[np.float64] = 1 / (1 + np.exp(_SLOPES * np.asarray(difficulties)[:, None] - _ABILITIES))
    return rates


def _drawn(weights: NDArray[np.float64], uniform: float) -> int:
    """Returns an index that is drawn with a probability proportional to its weight."""
    sums = np.cumsum(weights)
    return int(np.searchsorted(sums[:-1], uniform * sums[-1], side="right"))
