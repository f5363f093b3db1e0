"""Tests of streams, and of the environment that plays them."""

from __future__ import annotations

import copy
import json
import pickle
import subprocess
from itertools import islice
from pathlib import Path
from typing import Any

import gymnasium
import pytest
from gymnasium.utils.env_checker import check_env

import infinite_arcade as ia


@pytest.fixture(scope="module")
def lessons() -> ia.Stream:
    return ia.stream("lessons", ["hailglass", "foxglove-round"])


def test_items_are_won_and_new(lessons: ia.Stream) -> None:
    known = {level.digest for game in lessons.games for level in game.levels}
    for position, item in enumerate(islice(lessons, 3)):
        assert item.index == item.level.number == position
        assert item.witness.replay().outcome == "won"
        assert item.level.digest not in known
        assert item.path[:2] == (("train", 0), ("item", position))
    assert [level.number for level in lessons[2].alone().levels] == [2]


def test_items_are_the_same_in_any_order_and_process(lessons: ia.Stream, arcade: Path) -> None:
    other = ia.stream("lessons", ["foxglove-round", "hailglass"])
    digests = {at: lessons[at].level.digest for at in (123_456_789, 0, 5)}
    assert digests == {at: other[at].level.digest for at in (5, 0, 123_456_789)}
    assert pickle.loads(pickle.dumps(lessons))[5].level.digest == digests[5]
    assert copy.deepcopy(lessons)[5].level.digest == digests[5]
    command = [arcade, "stream", "lessons", "--games", "hailglass,foxglove-round", "--from", "5", "--count", "1"]
    printed = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
    assert (printed["digest"], printed["witness_seed"]) == (digests[5], lessons[5].witness.seed)


def test_a_range_of_levels_repeats() -> None:
    three = ia.stream("lessons", "hailglass", start_level=10, num_levels=3)
    assert [three[at].index for at in range(5)] == [10, 11, 12, 10, 11]
    assert three[0] is three[3]


def test_levels_of_releases_are_avoided(tiny: Path) -> None:
    assert ia.stream("lessons", "hailglass", avoid=[tiny])[0].witness.replay().outcome == "won"
    with pytest.raises(ia.ArcadeError, match="nowhere"):
        ia.stream("lessons", "hailglass", avoid=["nowhere"])


def test_faults_are_named() -> None:
    for arguments, words in [
        ({"difficulty": 1.5}, "`difficulty` must be from 0 to 1, not 1.5"),
        ({"num_levels": -1}, "`num_levels` must be at least 0, not -1"),
        ({"size": (2, 2)}, "columns from 2 to 2"),
        ({"games": []}, "at least one game"),
        ({"games": ["hailglass", "hailglass"]}, "`hailglass` and `hailglass` have the same rules: omit one"),
    ]:
        with pytest.raises(ValueError, match=words):
            ia.stream("lessons", **{"games": "hailglass", **arguments})  # type: ignore[arg-type]
    with pytest.raises(IndexError, match="no position -1"):
        ia.stream("lessons", "hailglass")[-1]
    with pytest.raises(ia.ArcadeError, match="item 0 has no level"):
        ia.stream("lessons", "heath-fire")[0]


def test_an_environment_plays_a_new_level_in_each_episode() -> None:
    def episodes(env: gymnasium.Env[Any, Any], seed: int) -> list[tuple[int, str]]:
        started = [env.reset(seed=seed)[1], env.reset()[1]]
        return [(info["level"], info["seed"]) for info in started]

    one, other = (gymnasium.make("InfiniteArcade/Stream-v0", game="hailglass", stream_seed="lessons") for _ in range(2))
    first = episodes(one, 7)
    assert first == episodes(other, 7) == episodes(one, 7)
    assert len({level for level, _ in first}) == len({seed for _, seed in first}) == 2
    assert one.unwrapped.item.level.digest == one.unwrapped.stream[first[1][0]].level.digest
    again = pickle.loads(pickle.dumps(one.unwrapped))
    assert (again.reset()[0] == one.unwrapped.reset()[0]).all()
    env = gymnasium.make("InfiniteArcade/Stream-v0", game="hailglass", start_level=10, num_levels=2)
    assert {env.reset(seed=seed)[1]["level"] for seed in range(8)} == {10, 11}
    assert env.reset(options={"level": 11})[1]["level"] == 11
    with pytest.raises(ValueError, match="has the levels 10 to 11, not 12"):
        env.reset(options={"level": 12})
    check_env(env.unwrapped, skip_render_check=True)


def test_weights_reward_the_end_of_an_episode() -> None:
    weights = ia.RewardWeights()
    env = gymnasium.make(
        "InfiniteArcade/Stream-v0", game="hailglass", stream_seed="lessons", max_steps=200, reward=weights
    )

    def play(actions: list[str]) -> tuple[list[float], dict[str, Any]]:
        plain: Any = env.unwrapped
        witness = plain.stream[0].witness
        _, info = env.reset(options={"level": 0, "seed": witness.seed})
        rewards = []
        for name in actions:
            _, reward, terminated, truncated, info = env.step(plain.game.actions.index(name))
            rewards.append(float(reward))
            if terminated or truncated:
                break
        return rewards, info

    env.reset(seed=1)
    stream: ia.Stream = env.get_wrapper_attr("stream")
    item = stream[0]
    rewards, info = play(list(item.witness.actions))
    assert info["outcome"] == "won"
    assert info["components"]["win"] == info["components"]["efficiency"] == 1
    assert set(rewards[:-1]) == {0.0}
    assert rewards[-1] == pytest.approx(weights.reward(item.witness.replay(), item.witness))
    idle, info = play(["nil"] * 200)
    assert sum(idle) <= weights.progress and info["components"]["win"] == 0
