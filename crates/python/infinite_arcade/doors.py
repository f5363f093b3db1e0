"""Plays the same action logs through every interface, and compares state hashes, scores and outcomes.

The command line plays episodes of the corpus with a random player, and the resulting logs are the reference. The
actions of each log are then played

- with Gymnasium, in a single environment and in a vector of all episodes of a level;
- with Inspect, by a scripted model that answers with the actions;
- with ``cmd:``, by a program that sends the actions to ``arcade evaluate``;
- with the tools of an MCP server, if the extra mcp is installed;
- with a server for OpenEnv, if the extra openenv is installed;
- on a Ray cluster, if Ray is installed and ``--ray`` is given.

``python -m infinite_arcade.doors --count 1000 --ray`` compares 1,000 logs. It requires ``arcade`` and the extras
gymnasium and inspect.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from .games import Game, load

__all__ = ["Log", "compare", "main", "openenv_server", "read_logs", "record"]

#: The maximum number of actions that the comparison sends to the MCP server in one call.
_ACTIONS_PER_CALL = 5

#: The program that plays logs over standard input and output. It finds the log that matches the rules and the first
#: board.
_PLAYER = """
import json, sys
logs = json.load(open(sys.argv[1]))
for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "hello":
        rules = message["rules"]
    elif message["type"] == "turn":
        if message["turn"] in (0, 1) and "actions_left" not in globals():
            actions_left = logs[json.dumps([rules, message["grid"]])]
            first = message["turn"]
        print(json.dumps({"turn": message["turn"], "action": actions_left[message["turn"] - first]}), flush=True)
"""

#: The program that records the rules and the first board of each level.
_SCOUT = """
import json, os, sys
for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "hello":
        rules = message["rules"]
    elif message["type"] == "turn":
        print(json.dumps({"action": "nil"}), flush=True)
        if "noted" not in globals():
            noted = json.dumps([rules, message["grid"]])
    elif message["type"] == "end":
        sys.stderr.write("")
        open(os.path.join(sys.argv[1], str(os.getpid())), "w").write(noted)
"""


@dataclass(frozen=True)
class Log:
    """An episode recorded by the command line."""

    game: str
    level: int
    level_digest: str
    seed: str
    actions: tuple[str, ...]
    hashes: tuple[str, ...]
    score: float
    outcome: str

    @property
    def key(self) -> tuple[str, int]:
        """The game and level of the episode."""
        return self.game, self.level

    @property
    def end(self) -> tuple[str, float, str]:
        """The last state hash, the score and the outcome of the episode."""
        return self.hashes[-1], self.score, self.outcome


def read_logs(results: Path) -> list[Log]:
    """Returns the episodes in a results folder, sorted by name."""
    return _logs_in(results / "episodes")


def _logs_in(folder: Path) -> list[Log]:
    logs = []
    for path in sorted(folder.glob("*.jsonl")):
        events = [json.loads(line) for line in path.read_text("utf-8").splitlines()]
        start, steps, end = events[0], [event for event in events if event["event"] == "step"], events[-1]
        logs.append(
            Log(
                game=start["game"],
                level=start["level"],
                level_digest=start["level_digest"],
                seed=start["seed"],
                actions=tuple(step["action"] for step in steps),
                hashes=tuple(step["hash"] for step in steps),
                score=end["score"],
                outcome=_outcome(end["outcome"]),
            )
        )
    return logs


def _outcome(value: Any) -> str:
    return value if isinstance(value, str) else "stopped"


def record(
    arcade: Path, games: list[str], seed: str, max_steps: int, out: Path, player: str = "random"
) -> list[Log]:
    """Uses the command line to play one episode on each level of the given games."""
    command = [str(arcade), "evaluate", *games, "--player", player, "--seed", seed, "--max-steps", str(max_steps)]
    subprocess.run([*command, "--out", str(out), "-q"], check=True, stdout=subprocess.DEVNULL)
    return read_logs(out)


def by_single(games: dict[str, Game], logs: list[Log]) -> Iterator[tuple[str, float, str]]:
    """Plays the logs in single environments."""
    from .gymnasium import GameEnv

    for log in logs:
        env = GameEnv(games[log.game], log.level)
        env.reset(options={"seed": log.seed})
        for action, expected in zip(log.actions, log.hashes, strict=True):
            info = env.step(env.game.actions.index(action))[4]
            assert env.state.state_hash() == expected, f"{log.game}, level {log.level}: a hash differs"
        yield env.state.state_hash(), float(info["score"]), str(info["outcome"])


def by_vector(games: dict[str, Game], logs: list[Log]) -> Iterator[tuple[str, float, str]]:
    """Plays the logs in vectors, with one vector for all logs of a level. Finished episodes wait for the other
    episodes.
    """
    from gymnasium.vector import AutoresetMode

    from .gymnasium import GameVectorEnv

    ends = dict[int, tuple[str, float, str]]()
    for key in dict.fromkeys(log.key for log in logs):
        own = [(at, log) for at, log in enumerate(logs) if log.key == key]
        game = games[key[0]]
        longest = max(len(log.actions) for _, log in own)
        # The longest log sets the limit, so that no environment is truncated before the end of its episode.
        envs = GameVectorEnv(
            game, key[1], num_envs=len(own), max_steps=longest + 1, autoreset_mode=AutoresetMode.NEXT_STEP
        )
        envs.reset(seed=0, options={"seed": [log.seed for _, log in own]})
        for tick in range(longest):
            played = [log.actions[tick] if tick < len(log.actions) else "nil" for _, log in own]
            envs.step(np.array([game.actions.index(action) for action in played], np.int64))
            for lane, (at, log) in enumerate(own):
                if tick + 1 == len(log.actions):
                    ends[at] = envs.hashes[lane], envs.scores[lane], envs.outcomes[lane]
    for at in range(len(logs)):
        yield ends[at]


def by_inspect(
    names: list[str], logs: list[Log], seed: str, max_steps: int, folder: Path
) -> Iterator[tuple[str, float, str]]:
    """Plays the logs of one seed with Inspect. A scripted model answers with the logs' actions."""
    import inspect_ai
    from inspect_ai.model import ModelOutput, ModelUsage, get_model

    from . import inspect as tasks

    task = tasks.corpus(games=names, seed=seed, max_steps=max_steps)
    by_key = {log.key: log for log in logs}
    order = [by_key[sample.metadata["game"], sample.metadata["levels"][0]] for sample in task.dataset if sample.metadata]
    script = iter([action for log in order for action in log.actions])

    def answer(*_: Any) -> ModelOutput:
        output = ModelOutput.from_content("mockllm/model", f"ACTION: {next(script)}")
        output.usage = ModelUsage(input_tokens=1, output_tokens=1, total_tokens=2)
        return output

    model = get_model("mockllm/model", custom_outputs=answer)
    [result] = inspect_ai.eval(task, model=model, log_dir=str(folder), display="none", max_samples=1, max_connections=1)
    assert result.status == "success" and result.samples is not None, result.error
    ends = dict[tuple[str, int], tuple[str, float, str]]()
    for sample in result.samples:
        assert sample.scores is not None and sample.scores["win"].metadata is not None
        [episode] = sample.scores["win"].metadata["episodes"]
        ends[sample.metadata["game"], episode["level"]] = episode["hash"], episode["score"], episode["outcome"]
    for log in logs:
        yield ends[log.key]


def by_program(
    arcade: Path, names: list[str], logs: list[Log], seed: str, max_steps: int, folder: Path
) -> Iterator[tuple[str, float, str]]:
    """Plays the logs with an external program, through ``cmd:``."""
    folder.mkdir(parents=True)
    scout, player, book = folder / "scout.py", folder / "player.py", folder / "book.json"
    scout.write_text(_SCOUT)
    player.write_text(_PLAYER)
    actions = dict[str, list[str]]()
    for log in logs:
        noted = folder / "noted" / f"{log.game}-{log.level}"
        noted.mkdir(parents=True)
        command = [str(arcade), "evaluate", log.game, "--levels", str(log.level), "--seed", seed, "--max-steps", str(max_steps)]
        flags = ["--player", f"cmd:{sys.executable} {scout} {noted}", "--out", str(noted / "out"), "-q"]
        subprocess.run([*command, *flags], check=True, stdout=subprocess.DEVNULL)
        [note] = [path for path in noted.iterdir() if path.is_file()]
        assert note.read_text() not in actions, f"{log.game}: two levels begin alike"
        actions[note.read_text()] = list(log.actions)
    book.write_text(json.dumps(actions))
    played = record(arcade, names, seed, max_steps, folder / "out", f"cmd:{sys.executable} {player} {book}")
    for log, again in zip(logs, played, strict=True):
        assert (log.key, log.actions, log.hashes) == (again.key, again.actions, again.hashes)
        yield again.end


def by_mcp(
    names: list[str], logs: list[Log], seed: str, max_steps: int, folder: Path
) -> Iterator[tuple[str, float, str]]:
    """Plays the logs of one seed with the tools of an MCP server. The server's own logs contain the hashes."""
    from mcp import ClientSession, StdioServerParameters
    from mcp.client.stdio import stdio_client

    options = ["--games", ",".join(names), "--seed", seed, "--max-steps", str(max_steps), "--logs", str(folder)]
    server = StdioServerParameters(command=sys.executable, args=["-m", "infinite_arcade.mcp", "corpus", *options])

    async def play() -> None:
        async with stdio_client(server) as streams, ClientSession(*streams[:2]) as session:
            await session.initialize()
            for log in logs:
                await session.call_tool("reset", {"game": log.game, "level": log.level})
                for at in range(0, len(log.actions), _ACTIONS_PER_CALL):
                    await session.call_tool("act", {"actions": list(log.actions[at : at + _ACTIONS_PER_CALL])})

    asyncio.run(play())
    for log, again in zip(logs, _logs_in(folder), strict=True):
        assert (log.key, log.actions, log.hashes) == (again.key, again.actions, again.hashes)
        yield again.end


@contextmanager
def openenv_server(*arguments: str) -> Iterator[str]:
    """Runs a server for OpenEnv in a process of its own, and yields its address."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    module = "infinite_arcade_openenv.server.app"
    command = [sys.executable, "-m", module, *arguments, "--port", str(port)]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    address = f"http://127.0.0.1:{port}"
    try:
        for _ in range(600):
            assert process.poll() is None, f"the server has exited with status {process.returncode}"
            try:
                urllib.request.urlopen(f"{address}/health", timeout=5).close()
                break
            except OSError:
                time.sleep(0.1)
        yield address
    finally:
        process.terminate()
        process.wait(10)


def by_openenv(
    names: list[str], logs: list[Log], seed: str, max_steps: int
) -> Iterator[tuple[str, float, str]]:
    """Plays the logs of one seed with a server for OpenEnv."""
    from infinite_arcade_openenv import ArcadeAction, ArcadeEnv

    arguments = ["corpus", "--games", ",".join(names), "--max-steps", str(max_steps)]
    with openenv_server(*arguments) as address, ArcadeEnv(base_url=address).sync() as env:
        for log in logs:
            env.reset(seed=seed, game=log.game, level=log.level)
            for action, expected in zip(log.actions, log.hashes, strict=True):
                env.step(ArcadeAction(action=action))
                found = env.state()
                assert found.state_hash == expected, f"{log.game}, level {log.level}: a hash differs"
            yield found.state_hash, found.score, found.outcome


def by_ray(logs: list[Log]) -> Iterator[tuple[str, float, str]]:
    """Plays the logs on a Ray cluster."""
    from . import ray as cluster

    episodes = [cluster.ActionLog(log.game, log.level, log.seed, log.actions) for log in logs]
    for end in cluster.replay(episodes):
        yield end.hash, end.score, end.outcome


def compare(
    arcade: Path, names: list[str], seed: str, *, max_steps: int, folder: Path, with_ray: bool = False
) -> dict[str, int]:
    """Compares one log per level of the given games. Returns the number of logs that each interface reproduced.

    Raises:
        AssertionError: if a hash, a score or an outcome differs.
    """
    games = {name: load(name) for name in names}
    logs = record(arcade, names, seed, max_steps, folder / "reference")
    doors: dict[str, Callable[[], Iterator[tuple[str, float, str]]]] = {
        "gymnasium": lambda: by_single(games, logs),
        "vector": lambda: by_vector(games, logs),
        "inspect": lambda: by_inspect(names, logs, seed, max_steps, folder / "inspect"),
        "cmd": lambda: by_program(arcade, names, logs, seed, max_steps, folder / "cmd"),
    }
    if find_spec("mcp"):
        doors["mcp"] = lambda: by_mcp(names, logs, seed, max_steps, folder / "mcp")
    if find_spec("openenv"):
        doors["openenv"] = lambda: by_openenv(names, logs, seed, max_steps)
    if with_ray:
        doors["ray"] = lambda: by_ray(logs)
    counts = {"command line": len(logs)}
    for door, play in doors.items():
        for log, end in zip(logs, play(), strict=True):
            assert end == log.end, f"{door}: {log.game}, level {log.level} ends with {end}, not with {log.end}"
        counts[door] = len(logs)
    return counts


def main() -> None:
    """Compares as many logs as the command line requests."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=1000, help="the minimum number of logs")
    parser.add_argument("--max-steps", type=int, default=30, help="the maximum number of actions per log")
    parser.add_argument("--arcade", type=Path, default=shutil.which("arcade") or "arcade", help="the path of arcade")
    parser.add_argument("--ray", action="store_true", help="also use a Ray cluster, which is local by default")
    arguments = parser.parse_args()
    from .games import corpus

    names, total = sorted(corpus()), dict[str, int]()
    while total.get("command line", 0) < arguments.count:
        seed = f"doors {len(total) and total['command line']}"
        with tempfile.TemporaryDirectory() as folder:
            found = compare(
                arguments.arcade,
                names,
                seed,
                max_steps=arguments.max_steps,
                folder=Path(folder),
                with_ray=arguments.ray,
            )
        total = {door: total.get(door, 0) + count for door, count in found.items()}
        print(", ".join(f"{door} {count}" for door, count in total.items()), flush=True)
    print("all state hashes, scores and outcomes are equal")


if __name__ == "__main__":
    main()
