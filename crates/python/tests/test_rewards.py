"""Tests of the components of rewards, and of players that try to earn them without winning."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from itertools import count
from statistics import mean

import pytest

import infinite_arcade as ia

#: A policy: the next action, from the number of the tick, a source of random numbers and the actions of the game.
Policy = Callable[[int, random.Random, list[str]], str]

#: The maximum mean reward of a player that does not try to win, relative to the mean reward of a competent player.
LIMIT = 0.05


@pytest.fixture(scope="module")
def items() -> list[ia.StreamItem]:
    games = ("hailglass", "quiet-jars", "foxglove-round")
    return [item for game in games for item in map(ia.stream("rewards", game).__getitem__, range(10))]


def played(item: ia.StreamItem, policy: Policy, seed: str) -> ia.State:
    state, draws = item.level.start(seed), random.Random(seed)
    for tick in count():
        if state.is_over:
            return state
        state.step(policy(tick, draws, item.game.actions))
    raise AssertionError


def rewards(items: list[ia.StreamItem], policy: Policy, episodes: int = 1) -> Iterator[float]:
    weights = ia.RewardWeights()
    for item in items:
        for episode in range(episodes):
            yield weights.reward(played(item, policy, f"episode {episode}"), item.witness)


def competent(items: list[ia.StreamItem]) -> float:
    return mean(ia.RewardWeights().reward(item.witness.replay(), item.witness) for item in items)


def test_a_witness_earns_nearly_everything(items: list[ia.StreamItem]) -> None:
    assert len({item.level.digest for item in items}) == 30
    for item in items:
        found = ia.reward_components(item.witness.replay(), item.witness)
        assert (found.win, found.progress, found.efficiency) == (1, 1, 1)
        assert found.score == (item.witness.replay().score > 0)
    assert competent(items) >= 0.9


def test_a_planner_that_wins_earns_most_of_it(items: list[ia.StreamItem]) -> None:
    item = next(item for item in items if item.game.id == "quiet-jars")
    state, actions = ia.play(item.level, ia.Planner("systematic:20000", seed="rewards"), seed="rewards")
    assert state.outcome == "won"
    found = ia.reward_components(state, item.witness)
    assert found.efficiency == min(1, len(item.witness.actions) / len(actions))
    assert ia.RewardWeights().reward(state, item.witness) > 0.7


@pytest.mark.parametrize(
    ("policy", "episodes"),
    [
        (lambda tick, draws, actions: "nil", 1),
        (lambda tick, draws, actions: draws.choice(actions), 8),
        (lambda tick, draws, actions: ("up", "right", "down", "left")[tick % 4], 1),
        (lambda tick, draws, actions: ("right", "left")[tick // 6 % 2], 1),
    ],
    ids=["nothing", "random keys", "circles", "to and fro"],
)
def test_a_player_without_a_plan_earns_next_to_nothing(
    items: list[ia.StreamItem], policy: Policy, episodes: int
) -> None:
    assert mean(rewards(items, policy, episodes)) <= LIMIT * competent(items)


def test_a_player_that_stops_before_the_win_earns_next_to_nothing(items: list[ia.StreamItem]) -> None:
    """The player collects the score and the progress of the witness, and omits its last action."""
    weights, ungated = ia.RewardWeights(), list[float]()
    earned = list[float]()
    for item in items:
        state = item.level.start(item.witness.seed)
        state.play(item.witness.actions[:-1])
        assert state.outcome == "ongoing"
        found = ia.reward_components(state, item.witness)
        assert (found.win, found.score, found.efficiency) == (0, 0, 0)
        ungated.append(state.score / item.witness.replay().score)
        earned.append(weights.reward(state, item.witness))
    assert 0 < mean(earned) and max(earned) <= LIMIT * competent(items)
    assert mean(ungated) > 0.5, "without the gate, this player would earn most of the score"


def test_progress_is_the_fraction_of_the_requirements_that_are_met() -> None:
    rules = """
BasicGame
    SpriteSet
        hero > MovingAvatar
        coin > Immovable
        floor > Immovable
    InteractionSet
        coin hero > killSprite scoreChange=1
    TerminationSet
        SpriteCounter stype=coin limit=0 win=True
        Timeout limit=20 win=False
    LevelMapping
        h > hero
        c > coin
        . > floor
"""
    level = ia.Game(rules, ["....\nhccc\n....\n"]).levels[0]
    witness = ia.Episode(level, "a", ("right",) * 3)
    state, found = level.start("b"), list[float]()
    for action in ("right", "left", "right", "right", "up", "down", "right"):
        state.step(action)
        found.append(round(ia.reward_components(state, witness).progress, 3))
    assert found == [0.333, 0.333, 0.333, 0.667, 0.667, 0.667, 1]
    assert state.outcome == "won"
    assert ia.reward_components(state, witness) == ia.RewardComponents(1, 1, 1, 3 / 7)
    assert ia.RewardWeights().reward(state, witness) == pytest.approx(0.84 + 0.16 * 3 / 7)
    assert ia.RewardWeights(win=2, score=0, progress=0, efficiency=0).reward(state, witness) == 2
    quick = ia.Episode(level, "a", ("up", "down", *("right",) * 3))
    assert ia.reward_components(witness.replay(), quick).efficiency == 1, "a shorter win earns no more than 1"


def test_a_survived_game_has_no_progress() -> None:
    item = ia.stream("rewards", "bog-lantern")[0]
    state = item.level.start(item.witness.seed)
    state.play(item.witness.actions[:-1])
    assert ia.reward_components(state, item.witness).progress == 0
    assert ia.reward_components(item.witness.replay(), item.witness).progress == 1


def test_faults_are_named(items: list[ia.StreamItem]) -> None:
    lost = ia.Episode(items[0].level, "a seed", ())
    with pytest.raises(ValueError, match="`witness` must win its level, but its outcome is `ongoing`"):
        ia.reward_components(items[0].witness.replay(), lost)
    for weight in (-1.0, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="`score` must be a finite number of at least 0"):
            ia.RewardWeights(score=weight)
