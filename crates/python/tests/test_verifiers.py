"""Tests of the taskset for verifiers, with a chat server on loopback. Runs only if verifiers is installed."""

from __future__ import annotations

import asyncio
import json
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("verifiers.v1", reason="verifiers is not installed: pip install 'infinite-arcade[verifiers]'")

import verifiers.v1 as vf
from verifiers.v1.clients import ModelContext

import infinite_arcade as ia
import infinite_arcade_verifiers as arcade

from conftest import NUT


class Server(BaseHTTPRequestHandler):
    conversations: list[list[dict[str, Any]]] = []

    def do_POST(self) -> None:
        body = json.loads(self.rfile.read(int(self.headers["content-length"])))
        self.conversations.append(body["messages"])
        said = {"id": "1", "created": 0, "model": "m"}
        message = {"role": "assistant", "content": "ACTION: right"}
        usage = {"prompt_tokens": 5, "completion_tokens": 2, "total_tokens": 7}
        if body.get("stream"):
            said["object"] = "chat.completion.chunk"
            start = {"index": 0, "delta": message, "finish_reason": None}
            end = {"index": 0, "delta": {}, "finish_reason": "stop"}
            parts = [{**said, "choices": [start]}, {**said, "choices": [end], "usage": usage}]
            reply = "".join(f"data: {json.dumps(part)}\n\n" for part in parts) + "data: [DONE]\n\n"
        else:
            said["object"] = "chat.completion"
            choice = {"index": 0, "message": message, "finish_reason": "stop"}
            reply = json.dumps({**said, "choices": [choice], "usage": usage})
        self.send_response(200)
        self.send_header("content-type", "text/event-stream" if body.get("stream") else "application/json")
        self.send_header("content-length", str(len(reply)))
        self.end_headers()
        self.wfile.write(reply.encode())

    def log_message(self, *_: Any) -> None:
        pass


@pytest.fixture
def server(monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.setenv("SCRIPTED_KEY", "none")
    found = ThreadingHTTPServer(("127.0.0.1", 0), Server)
    threading.Thread(target=found.serve_forever, daemon=True).start()
    return f"http://127.0.0.1:{found.server_address[1]}/v1"


def test_an_episode_is_played_and_rewarded(server: str, tmp_path: Path) -> None:
    (tmp_path / "game.vgdl").write_text(NUT)
    (tmp_path / "lvl0.txt").write_text("S n")
    (tmp_path / "lvl1.txt").write_text("n S")
    # The lines of the README, which need no account and no sandbox.
    taskset = {"id": "infinite-arcade-verifiers", "source": str(tmp_path), "max_steps": 4}
    env = arcade.ArcadeEnv(arcade.ArcadeEnvConfig.model_validate({"taskset": taskset}))
    tasks = list(env.taskset)
    game = ia.load(tmp_path)
    assert [task.data.id for task in tasks] == [f"{level.digest}-0" for level in game.levels]

    async def play() -> list[vf.Episode]:
        client = vf.EvalClientConfig(base_url=server, api_key_var="SCRIPTED_KEY")
        context = ModelContext(model="m", client=client)
        async with env.serving():
            return [await env.run_episode(task, context) for task in tasks]

    episodes = asyncio.run(play())
    for episode, task, won in zip(episodes, tasks, (1.0, 0.0), strict=True):
        assert episode.ok, [episode.errors, [trace.errors for trace in episode.traces]]
        [trace] = episode.traces
        assert trace.reward == won
        log = trace.info["infinite_arcade_log"]
        assert arcade.replayed(task.data.info, log)["steps"] == (2 if won else 4)
        with pytest.raises(ia.LogError):
            arcade.replayed(task.data.info, log.replace('"action":"right"', '"action":"nil"', 1))
    assert any(len(conversation) >= 4 for conversation in Server.conversations)


def tasks(**config: Any) -> list[Any]:
    taskset = {"id": "infinite-arcade-verifiers", "source": "corpus", **config}
    return list(arcade.ArcadeEnv(arcade.ArcadeEnvConfig.model_validate({"taskset": taskset})).taskset)


def test_unknown_games_and_levels_are_named() -> None:
    with pytest.raises(ValueError, match="there is no game `nope` in the corpus; the games are"):
        tasks(games=["hailglass", "nope"])
    with pytest.raises(ValueError, match="there is no level 9; the levels are 0, 1, 2, 3, 4"):
        tasks(games=["hailglass"], levels=[9])


def test_keys_do_not_depend_on_the_selection() -> None:
    [one] = tasks(games=["hailglass"], levels=[3])
    several = tasks(games=["hailglass"], runs=2)
    keys = [task.key for task in several]
    assert one.key in keys and len(set(keys)) == len(keys)
    assert one.key != tasks(games=["hailglass"], levels=[3], seed=5)[0].key
