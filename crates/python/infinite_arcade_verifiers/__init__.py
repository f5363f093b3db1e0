"""A taskset for verifiers: ``infinite-arcade-verifiers``.

A task is a level. The suite plays the episode and takes the role of the user in the conversation. It uses the prompts
of the contextual mode, the answer parser and the log of ``arcade evaluate``. The reward ``win`` is 1 if a replay of
the log wins. The score and the number of steps are metrics.

The package is separate from ``infinite_arcade``, because verifiers finds tasksets by the name of a top-level module.
"""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from typing import Any

import verifiers.v1 as vf
from verifiers.v1.task import task_key

from infinite_arcade import LogError
from infinite_arcade._arguments import check_levels, seed_text
from infinite_arcade.sessions import CONTEXTUAL, facts_of, games_of, open_series, replay_log

__all__ = ["ArcadeConfig", "ArcadeData", "ArcadeEnv", "ArcadeEnvConfig", "ArcadeTask", "ArcadeTaskset"]


class ArcadeConfig(vf.TasksetConfig):
    """The taskset's settings."""

    source: str = "corpus"
    """A release's folder, a game's file or folder, the name of a corpus game, or ``corpus``."""
    games: list[str] | None = None
    """The IDs of the games to include, or None for all games."""
    levels: list[int] | None = None
    """The numbers of the levels to include, or None for all levels."""
    runs: int = 1
    """The number of episodes per level."""
    seed: str | int = "evaluate"
    """The text or integer from which the games' randomness is derived."""
    max_steps: int = 200
    """The maximum number of actions per episode."""
    commit: str = "1"
    """The number of actions that the player commits to per decision."""
    reasks: int = 1
    """The number of repeated requests after an answer without a usable action."""


class ArcadeData(vf.TaskData):
    """The data of a task, which describes a level."""

    info: dict[str, Any]
    """The texts of the game and the level, and the settings of the episode."""


class ArcadeTask(vf.Task[ArcadeData, vf.State, vf.TaskConfig]):
    """A task, which is a level to play."""

    @property
    def key(self) -> str:
        """The identity of the task. Unlike the default key of verifiers, it does not depend on the other tasks."""
        return str(task_key(self.data.model_dump(mode="json", exclude_none=True, exclude={"idx"})))


class ArcadeEnvConfig(vf.EnvConfig):
    """The configuration of the environment, which has one player. The player only answers, so it has no tools and runs
    on this machine.
    """

    player: vf.AgentConfig = vf.AgentConfig.model_validate(
        {"harness": {"id": "null"}, "runtime": {"type": "subprocess"}}
    )


class ArcadeEnv(vf.Env[ArcadeEnvConfig]):
    """The environment, in which the suite takes the role of the user in the conversation."""

    async def run(self, task: vf.Task, agents: vf.Agents) -> None:
        info = task.data.info
        series = open_series(info, info["run"])
        request = await asyncio.to_thread(series.next_request)
        async with agents.player.interaction(task) as interaction:
            segment = await interaction.turn()
            while request is not None and not segment.terminated:
                series.answer(segment.last_reply)
                before, request = len(request), await asyncio.to_thread(series.next_request)
                if request is None:
                    break
                if len(request) != before + 2:
                    raise ValueError("the conversation was truncated")
                segment = await interaction.turn(request[-1][1])
        if request is not None:
            series.fail("the player has stopped")
            await asyncio.to_thread(series.next_request)
        trace = interaction.trace
        [episode] = series.results()
        played = replayed(info, episode["log"])
        trace.info["infinite_arcade_log"] = episode["log"]
        trace.record_reward("win", float(played["outcome"] == "won"), 1.0)
        trace.record_metric("score", float(played["score"]))
        trace.record_metric("steps", float(played["steps"]))


class ArcadeTaskset(vf.Taskset[ArcadeTask, ArcadeConfig]):
    """A taskset with the levels of a release, of a game or of the corpus."""

    def load(self) -> Iterator[ArcadeTask]:
        """Yields the tasks.

        Raises:
            ValueError: if a game or level of the configuration does not exist.
        """
        config = self.config
        games = games_of(config.source, config.games)
        check_levels(config.levels, (level.number for game in games for level in game.levels))
        for game in games:
            for level in game.levels:
                if config.levels is not None and level.number not in config.levels:
                    continue
                for run in range(config.runs):
                    # Conversations are never truncated, so that training uses exactly the text that the model was shown.
                    info = facts_of(
                        game,
                        [level],
                        level=level.number,
                        run=run,
                        seed=seed_text(config.seed),
                        max_steps=config.max_steps,
                        commit=config.commit,
                        prompts=CONTEXTUAL,
                        reasks=config.reasks,
                    )
                    request = open_series(info, run, game=game._native).next_request()
                    if request is None:
                        continue
                    [(_, system, _), (_, shown, _)] = request
                    data = ArcadeData(
                        id=f"{level.digest}-{run}",
                        name=f"{game.id} {level.number} {run}",
                        prompt=shown,
                        system_prompt=system,
                        info=info,
                    )
                    yield ArcadeTask(data, config.task)


def replayed(info: dict[str, Any], log: str) -> dict[str, Any]:
    """Returns the results of a log, which is replayed on its task's level.

    Raises:
        LogError: if the log differs from its replay, or belongs to a different episode.
    """
    found = replay_log(info, log, level=info["level"], run=info["run"])
    if not found["ended"] and found["outcome"] != "ongoing":
        raise LogError("the log of a finished episode has no end")
    return found
