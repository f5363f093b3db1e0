"""Tests of the MCP server, which runs in a process of its own. Runs only if mcp is installed."""

from __future__ import annotations

import asyncio
import json
import signal
import subprocess
import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("mcp", reason="mcp is not installed: pip install 'infinite-arcade[mcp]'")

from mcp import ClientSession, StdioServerParameters
from mcp.client.stdio import stdio_client

import infinite_arcade as ia


@asynccontextmanager
async def connected(*arguments: str) -> AsyncIterator[ClientSession]:
    server = StdioServerParameters(command=sys.executable, args=["-m", "infinite_arcade.mcp", *arguments])
    async with stdio_client(server) as streams, ClientSession(*streams[:2]) as session:
        await session.initialize()
        yield session


async def call(session: ClientSession, tool: str, **arguments: Any) -> tuple[str, bool]:
    """Returns the text of the result, and True if it is an error."""
    result: Any = await session.call_tool(tool, arguments)
    failed = result.is_error if hasattr(result, "is_error") else result.isError
    return "".join(part.text for part in result.content), failed


@pytest.fixture
def folder(nut: ia.Game, tmp_path: Path) -> str:
    nut.save(tmp_path / "nut")
    return str(tmp_path / "nut")


def test_a_level_is_played_with_tools(folder: str, tmp_path: Path) -> None:
    async def play() -> None:
        async with connected(folder, "--logs", str(tmp_path / "logs")) as session:
            tools = {tool.name: tool for tool in (await session.list_tools()).tools}
            assert sorted(tools) == ["act", "look", "notes", "reset"]
            shown, _ = await call(session, "look")
            assert "## Rules" in shown and "Game nut, level 0, episode 1." in shown and "\n@.n\n" in shown
            assert (await call(session, "act", actions="left"))[0].count("## Board") == 1
            shown, failed = await call(session, "act", actions=["right", "jump", "right"])
            assert failed and "1 of 3 actions were played, then there is no action `jump` now" in shown
            assert "right: right was played." in shown and "\n.@n\n" in shown
            shown, failed = await call(session, "act", actions=["right", "right"])
            assert not failed and "You won after 3 ticks" in shown and "Call `reset`" in shown
            shown, failed = await call(session, "act", actions="right")
            assert failed and "the episode is over (won); reset to play again" in shown
            shown, failed = await call(session, "reset", level=7)
            assert failed and "there is no level 7; the levels are 0, 1" in shown
            shown, failed = await call(session, "reset", game="nit")
            assert failed and "did you mean `nut`" in shown
            assert "level 0, episode 2." in (await call(session, "reset"))[0]
            assert "level 1, episode 1." in (await call(session, "reset", level=1))[0]
            await call(session, "act", actions="right")

    asyncio.run(play())
    logs = sorted((tmp_path / "logs").iterdir())
    assert [log.name for log in logs] == ["0001-nut-0.jsonl", "0002-nut-1.jsonl"]
    assert '"event":"end"' in logs[0].read_text() and '"event":"end"' not in logs[1].read_text()


def test_notes_are_kept_within_a_session_only(folder: str) -> None:
    async def play() -> None:
        async with connected(folder) as one, connected(folder) as two:
            assert "You have no notes" in (await call(one, "notes"))[0]
            await call(one, "notes", text="the nut is on the right")
            await call(one, "act", actions="right")
            await call(one, "reset")
            assert (await call(one, "notes"))[0] == "the nut is on the right"
            assert "You have no notes" in (await call(two, "notes"))[0]
            assert "Tick 0 of" in (await call(two, "look"))[0]
            shown, failed = await call(one, "notes", text="x" * 20_001)
            assert failed and "shorten them to 20000" in shown

    asyncio.run(play())


def test_a_stream_is_played(tmp_path: Path) -> None:
    async def play() -> None:
        async with connected("stream", "lessons", "--games", "hailglass", "--count", "2") as session:
            first, _ = await call(session, "look")
            shown, failed = await call(session, "reset", level=1)
            assert not failed and "Game hailglass, level 1," in shown and "## Board" in first
            shown, failed = await call(session, "reset", level=2)
            assert failed and "the levels are 0 to 1" in shown

    asyncio.run(play())


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["hailgass"], "did you mean the corpus game `hailglass`"),
        (["hailglass", "--levels", "first"], "`levels` must be numbers, such as 0,1, not 'first'"),
        (["hailglass", "--levels", "9"], "there is no level 9; the levels are"),
        (["stream"], "the seed of the stream is missing"),
        (["hailglass", "seed"], "only `stream` takes a seed"),
    ],
)
def test_invalid_arguments_end_the_server(arguments: list[str], message: str) -> None:
    command = [sys.executable, "-m", "infinite_arcade.mcp", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=60)
    assert done.returncode == 2 and message in done.stderr


def test_an_interrupt_ends_the_server_without_a_traceback(folder: str) -> None:
    # A shell may start the tests with interrupts ignored, and children inherit that.
    program = (
        "import runpy, signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
        "runpy.run_module('infinite_arcade.mcp', run_name='__main__')"
    )
    command = [sys.executable, "-c", program, folder]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=pipe, text=True) as server:
        assert server.stdin is not None and server.stdout is not None and server.stderr is not None
        hello = {"protocolVersion": "2025-03-26", "capabilities": {}, "clientInfo": {"name": "test", "version": "1"}}
        server.stdin.write(json.dumps({"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": hello}) + "\n")
        server.stdin.flush()
        assert "infinite-arcade" in server.stdout.readline()
        server.send_signal(signal.SIGINT)
        server.stdin.close()
        assert server.wait(60) == 130 and "Traceback" not in server.stderr.read()
