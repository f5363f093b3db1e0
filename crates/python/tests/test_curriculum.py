"""Tests of curricula: simulated learners of known ability, and a player of real levels."""

from __future__ import annotations

import copy
import json
import math
import pickle
import random
from itertools import islice

import pytest

import infinite_arcade as ia

#: The number of episodes in a group.
GROUP = 8
FAMILIES = sorted(ia.corpus())[:20]
DIFFICULTIES = (0.0, 0.25, 0.5, 0.75, 1.0)


class Learner:
    """A learner whose win rate is logistic in the difficulty. Each useful group raises the ability in its family."""

    def __init__(self, families: dict[str, tuple[float, float]], *, growth: float = 0.0) -> None:
        self.abilities = {family: ability for family, (ability, _) in families.items()}
        self.slopes = {family: slope for family, (_, slope) in families.items()}
        self.growth = growth
        self._draws = random.Random("learner")

    def win_rate(self, family: str, difficulty: float) -> float:
        return 1 / (1 + math.exp(self.slopes[family] * difficulty - self.abilities[family]))

    def play(self, family: str, difficulty: float) -> list[float]:
        rate = self.win_rate(family, difficulty)
        results = [float(self._draws.random() < rate) for _ in range(GROUP)]
        if len(set(results)) > 1:
            self.abilities[family] += self.growth
        return results


def learner(growth: float = 0.0) -> Learner:
    """Returns a learner that never wins 12 of 20 families, always wins 4, and wins easy levels of the other 4."""
    kinds = [(-7.0, 3.0), (-6.0, 3.0), (9.0, 3.0), (-8.0, 0.0), (2.0, 8.0)]
    return Learner({family: kinds[at % 5] for at, family in enumerate(FAMILIES)}, growth=growth)


def useful_groups(player: Learner, count: int, curriculum: ia.Curriculum | None = None) -> list[bool]:
    """Returns whether each group is useful. Without a curriculum, families and difficulties are drawn uniformly."""
    draws, found = random.Random("uniform"), list[bool]()
    for _ in range(count):
        if curriculum is None:
            results = player.play(draws.choice(FAMILIES), draws.choice(DIFFICULTIES))
        else:
            lesson = curriculum.draw()
            results = player.play(lesson.family, lesson.difficulty)
            curriculum.report(lesson, results)
        found.append(len(set(results)) > 1)
    return found


def share(found: list[bool]) -> float:
    return sum(found) / len(found)


def test_useful_groups_are_three_times_as_frequent_as_without_a_curriculum() -> None:
    curriculum = ia.Curriculum("simulated", FAMILIES)
    found = useful_groups(learner(), 500, curriculum)
    assert share(useful_groups(learner(), 2000)) < 0.2
    assert share(found) > 0.6 and share(found[200:]) > 0.7
    assert curriculum.groups == 500
    assert curriculum.useful == share(found)
    assert curriculum.recent_useful == share(found[-100:])


def test_the_learner_wins_about_half() -> None:
    player = Learner({"hailglass": (2.0, 4.0)})
    curriculum = ia.Curriculum("simulated", "hailglass")
    results = list[float]()
    for _ in range(200):
        lesson = curriculum.draw()
        results += player.play(lesson.family, lesson.difficulty)
        curriculum.report(lesson, results[-GROUP:])
    assert 0.4 < share(list(map(bool, results[400:]))) < 0.6
    assert curriculum.win_rate("hailglass", 0.5) == pytest.approx(0.5, abs=0.15)
    assert curriculum.win_rate("hailglass", 0) > 0.7 > 0.3 > curriculum.win_rate("hailglass", 1)


@pytest.mark.parametrize(("before", "after"), [(0.0, 4.0), (4.0, 0.0)], ids=["better", "worse"])
def test_the_difficulty_follows_a_sudden_change_within_ten_reports(before: float, after: float) -> None:
    player = Learner({"hailglass": (before, 4.0)})
    curriculum = ia.Curriculum("simulated", "hailglass")
    useful_groups(player, 50, curriculum)
    assert curriculum.win_rate("hailglass", before / 4) == pytest.approx(0.5, abs=0.2)
    player.abilities["hailglass"] = after
    reports = 0
    while abs(curriculum.win_rate("hailglass", after / 4) - 0.5) > 0.2:
        useful_groups(player, 1, curriculum)
        reports += 1
    assert 1 < reports <= 10


def test_a_jump_of_all_abilities_is_found() -> None:
    player, curriculum = learner(), ia.Curriculum("simulated", FAMILIES)
    useful_groups(player, 300, curriculum)
    for family in FAMILIES:
        player.abilities[family] += 7
    found = useful_groups(player, 300, curriculum)
    assert share(found[100:]) > 0.6


def test_a_learner_that_improves_learns_more() -> None:
    """Every ability below the hardest levels grows by 0.04 per useful group, and the sampler follows it."""
    taught, other = learner(0.04), learner(0.04)
    curriculum = ia.Curriculum("simulated", FAMILIES)
    found = useful_groups(taught, 400, curriculum)
    uniform = useful_groups(other, 400)
    assert share(found[200:]) > 0.6
    assert sum(found) > 3 * sum(uniform)


def test_families_without_a_gradient_get_less_weight_but_are_tried_again() -> None:
    flat, always, never, split = "hailglass", "quiet-jars", "foxglove-round", "first-ice"
    player = Learner({flat: (0.0, 0.0), always: (12.0, 0.0), never: (-12.0, 0.0), split: (0.0, 0.0)})
    curriculum = ia.Curriculum("simulated", [flat, always, never, split], explore=0.2)
    drawn = list[str]()
    draws = random.Random("levels")
    for _ in range(400):
        lesson = curriculum.draw()
        drawn.append(lesson.family)
        results = player.play(lesson.family, lesson.difficulty)
        if lesson.family == split:  # Each level is either always won or always lost.
            results = [float(draws.random() < 0.5)] * GROUP
        curriculum.report(lesson, results)
    assert curriculum.weight(flat) > 0.5
    for family in (always, never, split):
        assert curriculum.weight(family) < 0.2
        assert 0.2 / 4 / 2 <= drawn[100:].count(family) / 300 <= 0.2
    assert drawn[100:].count(flat) / 300 > 0.6


def test_a_family_without_levels_is_skipped_and_loses_weight() -> None:
    curriculum = ia.Curriculum("lessons 1", ["heath-fire", "hailglass"], difficulties=[0.5])
    before = curriculum.weight("heath-fire")
    assert [curriculum.draw(number).family for number in range(2)] == ["heath-fire", "hailglass"]
    lesson, item = next(iter(curriculum))
    assert lesson.number == 1 and item.game.id == "hailglass"
    assert curriculum.weight("heath-fire") < before
    assert curriculum.groups == 0 and math.isnan(curriculum.useful) and math.isnan(curriculum.recent_useful)


def test_lessons_depend_on_seed_number_and_reports_alone() -> None:
    one, other, fresh, different = (ia.Curriculum(seed, FAMILIES) for seed in ("simulated",) * 3 + ("other",))
    lessons = [one.draw() for _ in range(60)]
    assert lessons == [other.draw(number) for number in range(60)]
    assert lessons != [different.draw(number) for number in range(60)]
    assert len({(lesson.family, lesson.difficulty) for lesson in lessons}) > 20
    player = learner()
    results = [(lesson, player.play(lesson.family, lesson.difficulty)) for lesson in lessons if lesson.number % 7]
    for lesson, found in results:
        one.report(lesson, found)
    for lesson, found in random.Random(0).sample(results, len(results)):
        other.report(lesson, found)
    after = [one.draw(number) for number in range(60, 160)]
    assert after == [other.draw(number) for number in range(60, 160)]
    assert after != [fresh.draw(number) for number in range(60, 160)]
    assert (one.useful, one.recent_useful) == (other.useful, other.recent_useful)


def test_a_restored_curriculum_continues_like_the_original() -> None:
    curriculum = ia.Curriculum("simulated", FAMILIES[:5])
    useful_groups(learner(), 80, curriculum)
    restored = ia.Curriculum("simulated", FAMILIES[:5])
    restored.load_state_dict(json.loads(json.dumps(curriculum.state_dict())))
    copies = [restored, copy.deepcopy(curriculum), pickle.loads(pickle.dumps(curriculum))]
    player = learner()
    for _ in range(10):
        lesson = curriculum.draw()
        results = player.play(lesson.family, lesson.difficulty)
        for each in copies:
            assert each.draw() == lesson
            each.report(lesson, results)
        curriculum.report(lesson, results)
    assert {json.dumps(each.state_dict()) for each in copies} == {json.dumps(curriculum.state_dict())}
    with pytest.raises(ValueError, match="the state has the families"):
        ia.Curriculum("simulated", FAMILIES[:4]).load_state_dict(curriculum.state_dict())


def test_items_have_the_game_and_the_difficulty_of_their_lesson() -> None:
    curriculum = ia.Curriculum("lessons", ["hailglass", "quiet-jars"], difficulties=[0, 1], num_levels=3)
    for lesson, item in islice(curriculum, 2):
        assert (item.game.id, item.difficulty) == (lesson.family, lesson.difficulty)
        assert item.index == lesson.number % 3
        stream = ia.stream("lessons", lesson.family, difficulty=lesson.difficulty)
        assert item.level.digest == stream[lesson.number % 3].level.digest


def test_faults_are_named() -> None:
    for arguments, words in [
        ({"decay": 1}, "`decay` must be greater than 0 and less than 1, not 1"),
        ({"explore": 0}, "`explore` must be greater than 0 and at most 1, not 0"),
        ({"difficulties": []}, "`difficulties` must be numbers from 0 to 1"),
        ({"difficulties": [0, 1.5]}, "`difficulties` must be numbers from 0 to 1"),
        ({"difficulties": [1, 1]}, "must not repeat a number"),
        ({"games": []}, "at least one game"),
    ]:
        with pytest.raises(ValueError, match=words):
            ia.Curriculum("lessons", **{"games": "hailglass", **arguments})  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="chooses the difficulty itself"):
        ia.Curriculum("lessons", "hailglass", difficulty=0.5)
    curriculum = ia.Curriculum("lessons", "hailglass")
    lesson = curriculum.draw()
    for wrong, results, words in [
        (lesson, [0, 2], "`results` must be numbers from 0 to 1"),
        (lesson, [math.nan], "`results` must be numbers from 0 to 1"),
        (ia.Lesson(0, "hailglas", 0), [1], "no family `hailglas`; did you mean `hailglass`"),
        (ia.Lesson(0, "hailglass", 0.3), [1], "no difficulty 0.3; it has"),
    ]:
        with pytest.raises(ValueError, match=words):
            curriculum.report(wrong, results)
    assert curriculum.groups == 0
    curriculum.report(lesson, [0, 1])
    with pytest.raises(ValueError, match="lesson 0 was reported before"):
        curriculum.report(lesson, [0, 1])
    with pytest.raises(ValueError, match="`number` must be at least 0"):
        curriculum.draw(-1)
