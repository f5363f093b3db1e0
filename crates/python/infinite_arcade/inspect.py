"""Evaluation tasks for Inspect AI: ``infinite_arcade/starter``, ``infinite_arcade/snapshot``,
``infinite_arcade/corpus``, ``infinite_arcade/questions``.

A sample is a level, and its ID is the digest of the level. On the track ``discover``, a sample is a series of levels,
and its ID is the digest of the last level. An epoch is a run. The suite plays the episodes itself, with the prompts,
the answer parser and the logs of ``arcade evaluate``. Inspect obtains the answers, with its limits, retries and
caches. Episodes with the same ``seed``, level and run have the same randomness as in ``arcade evaluate``, so that the
results of both can be paired. The input of a sample is the first request of its first episode, with the rules and the
board. A solver other than :func:`play` receives this input.

The log of each episode is stored in the sample's store. The scorers replay each log, and compare every state hash,
score and outcome. They reject a log that differs from the replay or belongs to a different episode. With
``journal=DIR``, logs are written to that folder during the episodes. A retried evaluation continues these logs, so
that no answer is requested twice.

A limit of Inspect, such as ``--token-limit``, can end an episode before the game does. Such an episode is not won, and
its score is the score so far. Every sample therefore counts in every mean. The scorer ``unfinished`` reports the number
and the fraction of samples with such an episode.
"""

from __future__ import annotations

import hashlib
import json
from base64 import b64encode
from collections.abc import Awaitable, Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import anyio.to_thread
from inspect_ai import Task, task
from inspect_ai.dataset import MemoryDataset, Sample
from inspect_ai.model import (
    ChatMessage,
    ChatMessageAssistant,
    ChatMessageSystem,
    ChatMessageUser,
    Content,
    ContentImage,
    ContentText,
    GenerateConfig,
    ModelAPI,
    ModelOutput,
    ModelUsage,
    get_model,
    modelapi,
)
from inspect_ai.scorer import Metric, SampleScore, Score, Scorer, Target, mean, metric, scorer, stderr
from inspect_ai.solver import Generate, Solver, TaskState, generate, solver
from inspect_ai.tool import ToolChoice, ToolInfo
from inspect_ai.util import LimitExceededError

from . import _native
from ._arguments import Numbers, Seed, at_least, check_games, check_levels, level_numbers, seed_text
from ._native import ArcadeError, LogError, __version__
from .games import Game, corpus as corpus_games, load
from .questions import Questions, is_right
from .sessions import facts_of, level_texts, native_game, open_series, replay_log
from .snapshots import open_snapshot

__all__ = [
    "corpus", "game", "play", "points", "questions", "right", "samples", "scripted", "snapshot", "starter",
    "unfinished", "win",
]

#: Names or numbers, as a list or as comma-separated text. Inspect passes ``-T games=a,b`` as a list of texts.
Names = str | list[str] | None

#: A function that answers a request.
Answer = Callable[[list[ChatMessage]], Awaitable[ModelOutput]]

#: The name under which a sample's logs are stored.
LOGS = "infinite_arcade_logs"

#: The results of an episode without a log.
_UNPLAYED = {"actions": [], "outcome": "ongoing", "score": 0.0, "steps": 0, "ended": False, "stopped_by": None}

#: The reasons why an answer ended, with their names in logs.
_FINISHES = {
    "stop": "stop",
    "max_tokens": "length",
    "model_length": "length",
    "content_filter": "refusal",
}


@task
def snapshot(
    path: str,
    games: Names = None,
    levels: Numbers = None,
    track: str | None = None,
    commit: int | str = 1,
    mode: str | None = None,
    max_steps: int = 1000,
    seed: Seed = "evaluate",
    reasks: int = 1,
    journal: str | None = None,
) -> Task:
    """Returns a task with the levels in the folder of a release.

    Args:
        path: the folder of the release, whose digests are checked first.
        games: the IDs of the games to include; by default all games.
        levels: the numbers of the levels to include; by default all levels.
        track: ``told``, ``masked``, ``discover`` or ``vision`` (``arcade docs tracks``).
        commit: the number of actions that the player commits to per decision, or ``all`` for the whole episode.
        mode: ``zero-shot`` or ``contextual``.
        max_steps: the maximum number of actions per episode.
        seed: the text or integer from which the games' randomness is derived. The randomness is the same for every
            player.
        reasks: the number of repeated requests after an answer without a usable action.
        journal: a folder for the logs of episodes, which retries continue.

    Raises:
        ValueError: if a game or level does not exist, or another argument is invalid.
    """
    release, wanted = open_snapshot(path), _listed(games)
    there = {found.id: found for found in release.games()}
    check_games(wanted, there, str(path))
    found = [found.compile() for id, found in there.items() if wanted is None or id in wanted]
    options = _options(track, commit, mode, max_steps, seed, reasks)
    return _task(found, levels, options, journal, {"snapshot": release.root, "release": release.name})


@task
def starter(path: str = "releases/starter", **options: Any) -> Task:
    """Returns a task with the release ``starter``, which ``arcade release`` mints into ``releases/starter``. The
    arguments are those of :func:`snapshot`.
    """
    if not Path(path).is_dir():
        raise ArcadeError(f"{path}: there is no such release; `arcade release` mints it, or pass its folder with -T path=DIR")
    return snapshot(path, **options)


@task
def corpus(
    games: Names = None,
    levels: Numbers = None,
    track: str | None = None,
    commit: int | str = 1,
    mode: str | None = None,
    max_steps: int = 1000,
    seed: Seed = "evaluate",
    reasks: int = 1,
    journal: str | None = None,
) -> Task:
    """Returns a task with the corpus games, which are embedded in the package. The arguments are those of
    :func:`snapshot`.
    """
    wanted = _listed(games)
    check_games(wanted, corpus_games(), "the corpus")
    found = [entry.compile() for name, entry in corpus_games().items() if wanted is None or name in wanted]
    options = _options(track, commit, mode, max_steps, seed, reasks)
    return _task(found, levels, options, journal, {})


@task
def game(
    path: str,
    levels: Numbers = None,
    track: str | None = None,
    commit: int | str = 1,
    mode: str | None = None,
    max_steps: int = 1000,
    seed: Seed = "evaluate",
    reasks: int = 1,
    journal: str | None = None,
) -> Task:
    """Returns a task with one game, which is a file, a folder, or the name of a corpus game. The other arguments are
    those of :func:`snapshot`.
    """
    options = _options(track, commit, mode, max_steps, seed, reasks)
    return _task([load(path)], levels, options, journal, {})


@task
def questions(
    path: str, count: int = 100, kinds: str | list[str] | None = None, seed: str = "questions"
) -> Task:
    """Returns a task with questions about the levels in the folder of a release. Each question has exactly one right
    answer, and a sample is a question.

    Args:
        path: the folder of the release, whose digests are checked first.
        count: the number of questions of each kind.
        kinds: the kinds of questions to include (``arcade docs questions``); by default all kinds.
        seed: the text from which the questions are derived.
    """
    release = open_snapshot(path)
    found = (found.compile() for found in release.games())
    drawn = Questions(found, count=count, kinds=_listed(kinds), seed=seed)
    shown = ("kind", "game", "level", "options", "answer")
    rows = [
        Sample(id=row["id"], input=row["prompt"], target=row["answer"], metadata={key: row[key] for key in shown})
        for row in drawn.rows
    ]
    return Task(
        dataset=MemoryDataset(rows, name="infinite-arcade-questions"),
        solver=generate(),
        scorer=right(),
        version=__version__,
        metadata={"suite": __version__, "snapshot": release.root, "release": release.name, "seed": seed},
    )


@scorer(metrics=[mean(), stderr(cluster="game")])
def right() -> Scorer:
    """Scores the fraction of right answers to questions. Standard errors are clustered by game."""

    async def score(state: TaskState, target: Target) -> Score:
        answer = state.output.completion
        return Score(value=float(is_right(state.metadata, answer)), answer=answer)

    return score


def samples(
    games: Iterable[Game],
    *,
    levels_wanted: Sequence[int] | None = None,
    options: dict[str, Any] | None = None,
) -> Iterator[Sample]:
    """Returns the samples of the given games. Each sample contains the texts of its game and levels, so that its log
    can be replayed without the release. Its input is the first request of its first episode.
    """
    options = options or _options(None, 1, None, 1000, "evaluate", 1)
    ids = set[str]()
    for own in games:
        levels = [level for level in own.levels if levels_wanted is None or level.number in levels_wanted]
        facts = facts_of(own, levels, **options)
        by_number = {level.number: level for level in levels}
        plan = _native.Series.plan(own._native, own.id, facts["level_texts"], track=options["track"])
        for group, numbers in enumerate(plan):
            digest = by_number[numbers[-1]].digest
            id = digest if digest not in ids else f"{digest}-{own.id}"
            ids.add(id)
            metadata = {
                **facts,
                "title": own.title,
                "game_digest": own.digest,
                "level_digests": [by_number[number].digest for number in numbers],
                "levels": numbers,
                "group": group,
            }
            request = open_series(metadata, 0, game=own._native).next_request()
            if request is None:
                raise ArcadeError(f"{own.id}, level {numbers[0]}: the game ends before the first action")
            input = [_message(*message) for message in request]
            yield Sample(id=id, input=input, target="win", metadata=metadata)


@solver
def play(journal: str | None = None, answer: Answer | None = None) -> Solver:
    """Plays the episodes of a sample with the model, using the suite's prompts, answer parser and logs.

    Args:
        journal: a folder for the logs of episodes, which retries continue.
        answer: an asynchronous function that answers a request, by default with one call of the model. An agent with
            tools, or with several calls per action, can be passed as such a function.
    """

    async def solve(state: TaskState, generate: Generate) -> TaskState:
        options, ask = state.metadata, answer or get_model().generate
        folder = None if journal is None else Path(journal)
        if folder is not None:
            folder.mkdir(parents=True, exist_ok=True)
        series = open_series(options, state.epoch - 1, folder=folder)
        try:
            while (request := await anyio.to_thread.run_sync(series.next_request)) is not None:
                state.messages = [_message(*message) for message in request]
                try:
                    output = await ask(state.messages)
                except LimitExceededError as error:
                    series.fail(str(error), kind="budget")
                    raise
                except BaseException as error:
                    series.fail(f"{type(error).__name__}: {error}")
                    raise
                state.output = output
                if output.choices:
                    state.messages.append(output.message)
                _answer(series, output)
        finally:
            state.store.set(LOGS, _logs(series))
        halted = [log["halted"] for log in state.store.get(LOGS) if log["halted"]]
        if halted:
            raise ArcadeError(f"an episode was aborted: {halted[0]}")
        state.completed = True
        return state

    return solve


@scorer(metrics=[mean(), stderr(cluster="game")])
def win() -> Scorer:
    """Scores the fraction of levels won, by replaying the logs. A level whose episode is unfinished is not won.
    Practice levels do not count. Standard errors are clustered by game.
    """

    async def score(state: TaskState, target: Target) -> Score:
        played = _replayed(state)
        counted = [one for one in played if not one["practice"]]
        won = sum(one["outcome"] == "won" for one in counted if one["ended"])
        return Score(
            value=won / len(counted),
            answer=", ".join(one["outcome"] if one["ended"] else "unfinished" for one in counted),
            explanation="; ".join(map(_explained, counted)),
            metadata={"episodes": played},
        )

    return score


def _explained(episode: dict[str, Any]) -> str:
    """Describes an episode in one line. If the engine stopped it, the episode reveals nothing about the model."""
    level, steps, score = episode["level"], episode["steps"], episode["score"]
    if not episode["ended"]:
        return f"level {level}: unfinished after {steps} steps with score {score}, so not won"
    reason = episode["stopped_by"]
    stop = "" if reason is None else f" (stopped by the engine: {reason})"
    return f"level {level}: {episode['outcome']} after {steps} steps with score {score}{stop}"


@scorer(metrics=[mean(), stderr(cluster="game")])
def points() -> Scorer:
    """Scores the mean score of the games, by replaying the logs. An unfinished episode counts with its score so far."""

    async def score(state: TaskState, target: Target) -> Score:
        counted = [one for one in _replayed(state) if not one["practice"]]
        return Score(value=sum(float(one["score"]) for one in counted) / len(counted))

    return score


@metric
def count() -> Metric:
    """The sum of the values. With several epochs, the value of a sample is its mean over the epochs."""

    def total(scores: list[SampleScore]) -> float:
        return sum(one.score.as_float() for one in scores)

    return total


@scorer(metrics=[count(), mean()])
def unfinished() -> Scorer:
    """Scores 1 if an episode of the sample is unfinished, and 0 otherwise. Limits and custom solvers can leave episodes
    unfinished.
    """

    async def score(state: TaskState, target: Target) -> Score:
        counted = [one for one in _replayed(state) if not one["practice"]]
        return Score(value=float(any(not one["ended"] for one in counted)))

    return score


@modelapi(name="scripted")
def scripted() -> type[ModelAPI]:
    """An offline model for tests. ``scripted/left-up`` answers with one of the actions in its name, chosen by the
    digest of the prompt.
    """
    return _Scripted


class _Scripted(ModelAPI):
    async def generate(
        self, input: list[ChatMessage], tools: list[ToolInfo], tool_choice: ToolChoice, config: GenerateConfig
    ) -> ModelOutput:
        actions = self.model_name.split("-")
        digest = hashlib.blake2b(input[-1].text.encode(), digest_size=8).digest()
        answer = f"ACTION: {actions[int.from_bytes(digest) % len(actions)]}"
        output = ModelOutput.from_content(self.model_name, answer)
        words = sum(len(message.text.split()) for message in input)
        output.usage = ModelUsage(input_tokens=words, output_tokens=2, total_tokens=words + 2)
        return output


def _task(
    games: list[Game],
    levels_wanted: Numbers,
    options: dict[str, Any],
    journal: str | None,
    facts: dict[str, Any],
) -> Task:
    levels = level_numbers(levels_wanted)
    check_levels(levels, (level.number for own in games for level in own.levels))
    found = list(samples(games, levels_wanted=levels, options=options))
    if not found:
        raise ValueError("there is no level to play: the selection of games or levels is empty")
    return Task(
        dataset=MemoryDataset(found, name="infinite-arcade"),
        solver=play(journal),
        scorer=[win(), points(), unfinished()],
        version=__version__,
        metadata={"semantics": _native.SEMANTICS, "suite": __version__, **facts, **options},
    )


def _options(
    track: str | None, commit: int | str, mode: str | None, max_steps: int, seed: Seed, reasks: int
) -> dict[str, Any]:
    if mode not in (None, "zero-shot", "contextual"):
        raise ValueError(f"there is no mode `{mode}`; choose zero-shot or contextual")
    if mode is not None and track is not None:
        raise ValueError("`mode` contradicts `track`, which sets it; leave out one of the two")
    at_least(1, max_steps=max_steps)
    at_least(0, reasks=reasks)
    prompts = None if mode is None else json.dumps({"mode": mode})
    return {
        "track": track,
        "commit": str(commit),
        "prompts": prompts,
        "max_steps": max_steps,
        "seed": seed_text(seed),
        "reasks": reasks,
    }


def _listed(names: Names) -> list[str] | None:
    return names.split(",") if isinstance(names, str) else names


def _message(role: str, text: str, image: bytes | None) -> ChatMessage:
    match role:
        case "system":
            return ChatMessageSystem(content=text)
        case "assistant":
            return ChatMessageAssistant(content=text)
        case _ if image is not None:
            url = "data:image/png;base64," + b64encode(image).decode("ascii")
            content: list[Content] = [ContentText(text=text), ContentImage(image=url)]
            return ChatMessageUser(content=content)
        case _:
            return ChatMessageUser(content=text)


def _answer(series: _native.Series, output: ModelOutput) -> None:
    usage = output.usage
    series.answer(
        output.completion,
        finish=_FINISHES.get(output.stop_reason, "other") if output.choices else "other",
        input_tokens=usage.input_tokens if usage else None,
        output_tokens=usage.output_tokens if usage else None,
        served_by=output.model or None,
        latency_ms=(output.time or 0.0) * 1000,
    )


def _logs(series: _native.Series) -> list[dict[str, Any]]:
    """Returns the logs of a series that has ended or was aborted."""
    try:
        if series.next_request() is not None:
            series.fail("the sample was cancelled")
            series.next_request()
        return series.results()
    except (ArcadeError, RuntimeError, ValueError):
        return []


def _replayed(state: TaskState) -> list[dict[str, Any]]:
    """Returns the results of a sample's logs, each of which is replayed on its game. A level without a log is an
    unfinished episode without steps.

    Raises:
        LogError: if a log differs from its replay, or belongs to a different episode.
    """
    options, replayed = state.metadata, list[dict[str, Any]]()
    own = native_game(options)
    logs: list[dict[str, Any]] = state.store.get(LOGS, [])
    levels = [log["level"] for log in logs]
    if levels != options["levels"][: len(levels)]:
        raise LogError(f"the logs cover the levels {levels}, not {options['levels']}")
    for log in logs:
        found = replay_log(options, log["log"], level=log["level"], run=state.epoch - 1, game=own)
        metrics = json.loads(_native.metrics_of_log(own, options["game"], level_texts(options), log["log"]))
        practice = bool(log["practice"])
        replayed.append({"level": log["level"], "practice": practice, **found, "metrics": metrics})
    for level in options["levels"][len(levels) :]:
        replayed.append({"level": level, "practice": False, **_UNPLAYED})
    return replayed
