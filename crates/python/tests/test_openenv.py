"""Tests of the environment for OpenEnv, with a server in a process of its own. Runs only if openenv is installed."""

from __future__ import annotations

import json
import urllib.request
from collections.abc import Iterator
from typing import Any

import pytest

pytest.importorskip("openenv.core", reason="openenv is not installed: pip install 'infinite-arcade[openenv]'")

import infinite_arcade as ia
from infinite_arcade.doors import openenv_server
from infinite_arcade.sessions import TextSession
from infinite_arcade_openenv import ArcadeAction, ArcadeEnv

#: A game without randomness, so that a witness wins in every episode.
GAME = "quiet-jars"


@pytest.fixture(scope="module")
def server() -> Iterator[str]:
    with openenv_server("stream", "lessons", "--games", GAME, "--count", "4", "--sessions", "2") as address:
        yield address


def test_a_witness_wins(server: str) -> None:
    item = ia.stream("lessons", [GAME])[0]
    with ArcadeEnv(base_url=server).sync() as env:
        result = env.reset(seed=7, index=0)
        assert "## Rules" in result.observation.rules and "## Board" in result.observation.text
        assert (result.reward, result.done) == (0.0, False)
        steps = [env.step(ArcadeAction(action=action)) for action in item.witness.actions]
        rewards = [step.reward for step in steps]
        components = [step.observation.components for step in steps]
        assert components[:-1] == [None] * (len(steps) - 1)
        assert components[-1]["win"] == components[-1]["efficiency"] == 1
        state = env.state()
        assert rewards == [0.0] * (len(rewards) - 1) + [1.0]
        assert (state.outcome, state.history) == ("won", list(item.witness.actions))
        again = TextSession(item.alone(), item.alone().levels[0], seed=7)
        again.play(item.witness.actions)
        assert (state.seed, state.state_hash) == ("7", again.state_hash())
        result = env.step(ArcadeAction(action="right"))
        assert result.done and result.reward == 0.0 and "reset to play again" in result.observation.error


def test_two_sessions_are_separate_and_seeds_repeat(server: str) -> None:
    with ArcadeEnv(base_url=server).sync() as one, ArcadeEnv(base_url=server).sync() as two:
        first, second = one.reset(seed=5).observation, two.reset(seed=5).observation
        assert first == second
        moved = one.step(ArcadeAction(action=first.actions[1])).observation
        assert one.state().step_count == 1 and two.state().step_count == 0
        assert two.step(ArcadeAction(action=first.actions[1])).observation == moved
        assert one.reset(seed=5).observation == first
        levels = {one.reset(seed=seed).observation.level for seed in range(20)}
        assert levels == {0, 1, 2, 3}


def test_errors_name_the_next_step(server: str) -> None:
    with ArcadeEnv(base_url=server).sync() as env:
        with pytest.raises(RuntimeError, match="call reset first"):
            env.step(ArcadeAction(action="right"))
        with pytest.raises(RuntimeError, match="the indices are 0 to 3"):
            env.reset(index=9)
        with pytest.raises(RuntimeError, match="there is no split `test`; the split is `train`"):
            env.reset(split="test", index=0)
        before = env.reset(index=0).observation
        result = env.step(ArcadeAction(action="jump"))
        assert "there is no action `jump` now" in result.observation.error
        assert result.observation.text == before.text and env.state().step_count == 0


def test_levels_are_tasks(server: str) -> None:
    def asked(path: str, **body: Any) -> Any:
        data = json.dumps(body).encode() if body else None
        request = urllib.request.Request(f"{server}/infinite_arcade/{path}", data, {"Content-Type": "application/json"})
        return json.load(urllib.request.urlopen(request, timeout=60))

    stream = ia.stream("lessons", [GAME])
    assert [split["name"] for split in asked("splits")] == ["train"]
    assert asked("num_tasks", split="train")["num_tasks"] == 4
    tasks = asked("tasks", split="train")["tasks"]
    assert [task["id"] for task in tasks] == [stream[index].level.digest for index in range(4)]
    assert asked("task", split="train", index=2)["task"] == tasks[2]
