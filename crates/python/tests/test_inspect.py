"""Tests of the Inspect tasks, with scripted models."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import pytest
from inspect_ai import Task, eval
from inspect_ai.log import EvalLog, read_eval_log
from inspect_ai.model import ChatMessage, ChatMessageUser, Model, ModelOutput, ModelUsage, get_model
from inspect_ai.solver import Generate, Solver, TaskState, solver

import infinite_arcade as ia
from infinite_arcade import _native, inspect as tasks

from conftest import NUT

Answer = Callable[[list[ChatMessage]], str]


def scripted(answer: Answer) -> Model:
    def output(input: list[ChatMessage], *_: Any) -> ModelOutput:
        said = ModelOutput.from_content("mockllm/model", answer(input))
        # If the scripted model did not count tokens itself, it would request a tokenizer from a server.
        said.usage = ModelUsage(input_tokens=5, output_tokens=2, total_tokens=7)
        return said

    return get_model("mockllm/model", custom_outputs=output)


def right(_: list[ChatMessage]) -> str:
    return "The nut is to the right.\nACTION: right"


def run(task: Task, answer: Answer, tmp_path: Path, **options: Any) -> EvalLog:
    [log] = eval(task, model=scripted(answer), log_dir=str(tmp_path / "logs"), display="none", **options)
    return log


def nut_task(tmp_path: Path, **options: Any) -> Task:
    folder = tmp_path / "nut"
    folder.mkdir(exist_ok=True)
    (folder / "game.vgdl").write_text(NUT)
    for number, level in enumerate(("S n", "S  n", "n  S")):
        (folder / f"lvl{number}.txt").write_text(level)
    return tasks.game(str(folder), **options)


def metrics(log: EvalLog) -> dict[str, dict[str, float]]:
    assert log.status == "success", log.error
    assert log.results is not None
    return {
        score.name: {name: metric.value for name, metric in score.metrics.items()} for score in log.results.scores
    }


def test_a_scripted_model_wins(tmp_path: Path) -> None:
    task = nut_task(tmp_path, levels=[0, 1])
    game = ia.load(tmp_path / "nut")
    assert [sample.id for sample in task.dataset] == [level.digest for level in game.levels[:2]]
    log = run(task, right, tmp_path)
    assert metrics(log)["win"]["mean"] == 1.0 and metrics(log)["points"]["mean"] == 1.0
    assert "stderr" in metrics(log)["win"]
    assert log.samples is not None
    [first, second] = sorted(log.samples, key=lambda sample: sample.metadata["levels"])
    [episode] = second.scores["win"].metadata["episodes"]
    assert episode["actions"] == ["right"] * 3 and episode["ended"]


class Server(BaseHTTPRequestHandler):
    """A server for chat completions, with scripted answers."""

    answer: Answer

    def do_POST(self) -> None:
        body = json.loads(self.rfile.read(int(self.headers["content-length"])))
        said = type(self).answer(body["messages"])
        choice = {"index": 0, "message": {"role": "assistant", "content": said}, "finish_reason": "stop"}
        reply = json.dumps({"model": "m", "choices": [choice], "usage": {"prompt_tokens": 5, "completion_tokens": 2}}).encode()
        self.send_response(200)
        self.send_header("content-type", "application/json")
        self.send_header("content-length", str(len(reply)))
        self.end_headers()
        self.wfile.write(reply)

    def log_message(self, *_: Any) -> None:
        pass


@pytest.mark.parametrize("track", [None, "masked", "discover"])
def test_logs_are_those_of_the_command_line(track: str | None, arcade: Path, tmp_path: Path) -> None:
    """Checks that the same answers give the same log, line by line, with `arcade evaluate` and with Inspect. Prompts,
    classes, steps and hashes must be equal.
    """
    script = ["ACTION: left", "I do not know", "**Action:** right", "ACTION: right", "ACTION: jump", "ACTION: left"]

    def answers() -> Answer:
        asked = 0

        def answer(_: Any) -> str:
            nonlocal asked
            asked += 1
            return script[asked % len(script)]

        return answer

    task = nut_task(tmp_path, max_steps=6, levels=[0, 1], track=track)
    log = run(task, answers(), tmp_path, max_samples=1, max_connections=1)
    assert log.samples is not None
    logs = [log for sample in log.samples for log in sample.store[tasks.LOGS]]
    ours = {log["level"]: [json.loads(line) for line in log["log"].splitlines()] for log in logs}
    Server.answer = staticmethod(answers())
    server = ThreadingHTTPServer(("127.0.0.1", 0), Server)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    command = [arcade, "evaluate", str(tmp_path / "nut"), "--levels", "0,1", "--max-steps", "6", "--seed", "evaluate", "--model", "m"]
    flags = ["--base-url", f"http://127.0.0.1:{server.server_address[1]}/v1", "--concurrency", "1", "--reasks", "1", "--keep-going"]
    flags += ["--track", track] if track else []
    subprocess.run([*command, *flags, "--out", str(tmp_path / "out"), "-q"], check=True)
    server.shutdown()

    def without_times(events: list[dict[str, Any]]) -> list[dict[str, Any]]:
        skipped = {"latency_ms", "took_ms", "served_by"}
        return [{name: value for name, value in event.items() if name not in skipped} for event in events]

    for path in (tmp_path / "out" / "episodes").glob("*.jsonl"):
        theirs = [json.loads(line) for line in path.read_text().splitlines()]
        assert without_times(ours[theirs[0]["level"]]) == without_times(theirs)
    classes = {event["class"] for events in ours.values() for event in events if event["event"] == "reply"}
    assert {"strict", "tolerant", "invalid"} <= classes


def test_runs_differ_and_are_those_of_the_command_line(arcade: Path, tmp_path: Path) -> None:
    task = tasks.corpus(games="heath-fire", levels=0, max_steps=3)
    log = run(task, lambda _: "ACTION: up", tmp_path, epochs=2)
    assert log.samples is not None
    out = tmp_path / "out"
    command = [arcade, "evaluate", "heath-fire", "--levels", "0", "--max-steps", "3", "--runs", "2", "--player", "nil"]
    subprocess.run([*command, "--seed", "evaluate", "--out", str(out), "-q"], check=True)
    ours = {sample.epoch - 1: json.loads(sample.store[tasks.LOGS][0]["log"].splitlines()[0]) for sample in log.samples}
    theirs = [json.loads(path.read_text().splitlines()[0]) for path in (out / "episodes").glob("*.jsonl")]
    assert ours == {start["run"]: start for start in theirs}
    assert ours[0]["seed"] != ours[1]["seed"]


def test_a_log_that_differs_from_its_replay_is_refused(tmp_path: Path) -> None:
    log = run(nut_task(tmp_path, levels=[1]), right, tmp_path)
    assert log.samples is not None
    sample = log.samples[0]
    [episode] = sample.store[tasks.LOGS]
    options = sample.metadata
    game = _native.Game(options["source"])
    texts = [tuple(text) for text in options["level_texts"]]
    arguments = {"level": 1, "run": 0, "seed": options["seed"], "max_steps": options["max_steps"]}

    def replay(text: str, **changed: Any) -> dict[str, Any]:
        return json.loads(_native.replay_log(game, "nut", texts, text, **{**arguments, **changed}))

    assert replay(episode["log"])["outcome"] == "won"
    lines = episode["log"].splitlines(keepends=True)
    steps = [at for at, line in enumerate(lines) if '"event":"step"' in line]
    forged = [
        re.sub('"action":"right"', '"action":"nil"', lines[steps[0]]),
        re.sub('"score":0.0', '"score":5.0', lines[steps[0]]),
        re.sub('"hash":"[0-9a-f]{4}', '"hash":"0000', lines[steps[0]]),
    ]
    for line in forged:
        assert line != lines[steps[0]]
        with pytest.raises(ia.LogError):
            replay("".join([*lines[: steps[0]], line, *lines[steps[0] + 1 :]]))
    with pytest.raises(ia.LogError):
        replay("".join(lines[: steps[0]] + lines[steps[1] :]))
    for other in ({"seed": "another"}, {"run": 1}, {"max_steps": 7}, {"level": 0}, {"commit": "2"}, {"track": "masked"}):
        with pytest.raises(ia.LogError):
            replay(episode["log"], **other)


@pytest.mark.parametrize("track", ["told", "masked", "vision", "discover"])
def test_tracks(track: str, tmp_path: Path) -> None:
    shown = list[ChatMessage]()

    def answer(messages: list[ChatMessage]) -> str:
        shown.extend(messages)
        return "ACTION: right"

    log = run(nut_task(tmp_path, track=track, max_steps=5), answer, tmp_path)
    assert log.samples is not None
    assert len(log.samples) == (1 if track == "discover" else 3)
    words = "\n".join(message.text for message in shown)
    assert ("squirrel" in words) == (track in ("told", "vision"))
    has_picture = any(isinstance(message.content, list) and any(part.type == "image" for part in message.content) for message in shown)
    assert has_picture == (track == "vision")
    assert metrics(log)["win"]["mean"] == pytest.approx(1 / 2 if track == "discover" else 2 / 3)


def test_a_player_can_commit_to_several_actions(tmp_path: Path) -> None:
    answers = list[str]()

    def answer(messages: list[ChatMessage]) -> str:
        answers.append(messages[-1].text)
        return "ACTIONS: right, right, right"

    log = run(nut_task(tmp_path, levels=[1], commit=3), answer, tmp_path)
    assert metrics(log)["win"]["mean"] == 1.0 and len(answers) == 1


LIMITS = [{"token_limit": 15}, {"message_limit": 5}, {"time_limit": 2}]


@pytest.mark.parametrize("limit", LIMITS, ids=lambda limit: next(iter(limit)))
def test_every_sample_counts_within_a_limit(limit: dict[str, int], tmp_path: Path) -> None:
    """Checks that the quick level is won, and that the other levels reach the limit, so they are unfinished and not
    won.
    """

    def answer(messages: list[ChatMessage]) -> str:
        is_quick = "S.n\n" in messages[1].text
        if "time_limit" in limit and not is_quick:
            time.sleep(1.5)
        return "ACTION: right"

    log = run(nut_task(tmp_path, max_steps=20, mode="contextual"), answer, tmp_path, max_samples=1, **limit)
    assert log.samples is not None and log.results is not None
    assert any(sample.limit for sample in log.samples)
    for score in log.results.scores:
        assert (score.scored_samples, score.unscored_samples or 0) == (3, 0), score.name
    found = metrics(log)
    open_samples = [sample for sample in log.samples if sample.scores and sample.scores["unfinished"].value == 1.0]
    assert found["unfinished"] == {"count": len(open_samples), "mean": pytest.approx(len(open_samples) / 3)}
    assert 0 < len(open_samples) < 3 and found["win"]["mean"] == pytest.approx(1 / 3)
    for sample in open_samples:
        assert sample.scores is not None and sample.scores["win"].value == 0.0
        assert "unfinished" in (sample.scores["win"].answer or "")
        assert "so not won" in (sample.scores["win"].explanation or "")


@solver
def talkative() -> Solver:
    async def solve(state: TaskState, generate: Generate) -> TaskState:
        return await generate(state)

    return solve


def test_another_solver_receives_the_observation(tmp_path: Path) -> None:
    shown = list[ChatMessage]()

    def answer(messages: list[ChatMessage]) -> str:
        shown.extend(messages)
        return "ACTION: right"

    task = nut_task(tmp_path, levels="0")
    [sample] = task.dataset
    log = run(task, answer, tmp_path, solver=talkative())
    assert [message.text for message in shown] == [message.text for message in sample.input]
    assert "squirrel" in shown[0].text + shown[-1].text and "S" in shown[-1].text
    first = list[ChatMessage]()
    run(task, lambda messages: first.extend(messages) or "ACTION: right", tmp_path, limit=1)
    assert [message.text for message in first[:2]] == [message.text for message in shown], "the solver of the suite"
    assert metrics(log)["win"]["mean"] == 0.0 and metrics(log)["unfinished"] == {"count": 1.0, "mean": 1.0}


def test_an_agent_of_its_own_answers_the_requests(tmp_path: Path) -> None:
    async def agent(messages: list[ChatMessage]) -> ModelOutput:
        thought = await get_model().generate([*messages, ChatMessageUser(content="Think first.")])
        return ModelOutput.from_content("agent", f"ACTION: {thought.completion}")

    log = run(nut_task(tmp_path, levels=[0, 1]), lambda _: "right", tmp_path, solver=tasks.play(answer=agent))
    assert metrics(log)["win"]["mean"] == 1.0 and metrics(log)["unfinished"]["count"] == 0


@pytest.mark.parametrize("levels", [[0, 1], "0,1", ["0", "1"]])
def test_levels_are_selected_in_every_form(levels: Any, tmp_path: Path) -> None:
    task = nut_task(tmp_path, levels=levels)
    assert [sample.metadata["levels"] for sample in task.dataset] == [[0], [1]]


def test_unknown_games_and_levels_are_named(tiny: Path, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="there is no game `foo` in the corpus; the games are belfry-sling"):
        tasks.corpus(games="hailglass,foo")
    with pytest.raises(ValueError, match="there is no game `hailglas` in the corpus; did you mean `hailglass`"):
        tasks.corpus(games=["hailglas"])
    with pytest.raises(ValueError, match="there is no level 9; the levels are 0, 1, 2, 3, 4"):
        tasks.corpus(games="hailglass", levels=[0, 9])
    with pytest.raises(ValueError, match="`levels` must be numbers, such as 0,1, not 'easy'"):
        nut_task(tmp_path, levels="easy")
    [name, *_] = [game.id for game in ia.open_snapshot(tiny).games()]
    with pytest.raises(ValueError, match=f"there is no game `{name}x` in .*; did you mean `{name}`"):
        tasks.snapshot(str(tiny), games=f"{name}x")


def test_wrong_settings_are_refused_before_an_episode_starts(tmp_path: Path) -> None:
    for wrong in ({"commit": "abc"}, {"max_steps": 0}, {"reasks": -1}, {"track": "tolled"}, {"mode": "x"}):
        with pytest.raises(ValueError):
            nut_task(tmp_path, **wrong)
    assert nut_task(tmp_path, seed=7).dataset[0].metadata["seed"] == "7"


def test_a_retry_asks_for_no_answer_twice(tmp_path: Path) -> None:
    asked, fails = 0, True

    def answer(_: list[ChatMessage]) -> str:
        nonlocal asked
        if fails and asked == 3:
            raise RuntimeError("the server is gone")
        asked += 1
        return "ACTION: left" if asked < 3 else "ACTION: right"

    task = nut_task(tmp_path, levels=[1], journal=str(tmp_path / "journal"))
    model = scripted(answer)
    [failed] = eval(task, model=model, log_dir=str(tmp_path / "logs"), display="none")
    assert failed.status == "error" and asked == 3
    fails = False
    [log] = eval(task, model=model, log_dir=str(tmp_path / "logs"), display="none")
    assert metrics(log)["win"]["mean"] == 1.0
    assert asked == 5, "two steps to the left edge, three to the right"


def test_the_entry_point_is_known(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "inspect_ai", "eval", "infinite_arcade/corpus", "--model", "scripted/up-left"]
    flags = ["-T", "games=hailglass", "-T", "levels=0,1", "-T", "max_steps=2", "--display", "none", "--log-dir", str(tmp_path)]
    subprocess.run([*command, *flags], check=True, cwd=tmp_path)
    [path] = tmp_path.glob("*.eval")
    log = read_eval_log(str(path))
    assert log.status == "success" and log.eval.task == "infinite_arcade/corpus"
    assert log.samples is not None and len(log.samples) == 2
