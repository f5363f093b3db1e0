"""A server for the Model Context Protocol, through which an agent plays levels with tools.

``python -m infinite_arcade.mcp hailglass`` serves the levels of a game over standard input and output. A connection is a
process with one session, which consists of the current episode and the agent's notes. There are four tools:

- ``look`` returns the rules and the current turn;
- ``act`` plays one action or a short list of actions, and returns the new turn;
- ``reset`` starts an episode, on the same level or a different one;
- ``notes`` reads or replaces the agent's notes, which are kept across episodes.

Rules and turns are the texts that ``arcade evaluate`` shows a model. An error tells the agent what to do next. With
``--logs DIR``, each episode leaves a log in the format of ``arcade evaluate``.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from ._arguments import Seed
from ._native import ArcadeError, VgdlError
from .sessions import Shelf, TextSession, add_arguments, section, shelf_of

try:
    from mcp.server import MCPServer
    from mcp.server.mcpserver.exceptions import ToolError
except ImportError:  # mcp 1
    from mcp.server.fastmcp import FastMCP as MCPServer
    from mcp.server.fastmcp.exceptions import ToolError

__all__ = ["Player", "main", "server_of"]

#: The maximum number of actions in one call.
MOST_ACTIONS = 20

#: The maximum length of notes, in characters.
MOST_NOTES = 20_000

_INSTRUCTIONS = """You play levels of a game on a board of cells. Call `look` to read the rules and the current turn. \
Call `act` with an action of the game, or with a short list of actions. When an episode is over, call `reset`. \
`notes` keeps a text of yours across episodes."""


class Player:
    """The session of one connection, with the tools as methods."""

    def __init__(
        self, shelf: Shelf, *, seed: Seed = "evaluate", max_steps: int = 1000, logs: str | Path | None = None
    ) -> None:
        """Opens a session, which plays the first level of the shelf.

        Args:
            shelf: the levels that may be played.
            seed: the text or integer from which the games' randomness is derived.
            max_steps: the maximum number of actions per episode.
            logs: a folder for the logs of episodes.
        """
        self._shelf, self._seed, self._max_steps = shelf, seed, max_steps
        self._logs = None if logs is None else Path(logs)
        self._written = 0
        self._logged: TextSession | None = None
        self._runs: dict[tuple[str, int], int] = {}
        self._notes = ""
        self.session = self._start(None, None)

    async def look(self) -> str:
        """Shows the rules of the game, the legend of the board, the list of actions, and the current turn."""
        return f"{self.session.rules}\n{self._turn()}"

    async def act(self, actions: list[str] | str) -> str:
        """Plays one action, such as "right", or a short list of actions, such as ["right", "right", "up"]. Each action
        takes one tick. Returns the turn after the last action. A list stops early if an action is not available or the
        episode is over.
        """
        wanted = [actions] if isinstance(actions, str) else actions
        if not 1 <= len(wanted) <= MOST_ACTIONS:
            raise ToolError(f"give 1 to {MOST_ACTIONS} actions, not {len(wanted)}")
        session, done = self.session, list[str]()
        for action in wanted:
            if done and session.is_over:
                break
            try:
                turn = session.act(action)
            except ValueError as error:
                text = str(error)
                if done:
                    played = f"{len(done)} of {len(wanted)} actions were played, then"
                    text = "\n\n".join([f"{played} {text}", *self._played(done), self._turn()])
                raise ToolError(text) from None
            done.append(f"{action}: {section(turn, 'Last action') or session.outcome}")
        if session.is_over:
            self._write()
        return "\n\n".join([*(self._played(done) if len(wanted) > 1 else []), self._turn()])

    async def reset(self, game: str | None = None, level: int | None = None) -> str:
        """Starts a new episode. Without arguments, the current level is played again, with new random choices if the
        game is random. `level` is the number of a level, and `game` is the name of a game if there are several.
        """
        before = self.session
        if before.history:
            # An episode without actions does not count, and starts again.
            self._runs[before.game.id, before.level.number] = before.run + 1
        if game is None and level is None:
            game, level = None if self._shelf.stream else before.game.id, before.level.number
        elif game is None and self._shelf.stream is None:
            game = before.game.id
        try:
            started = self._start(game, level)
        except (ValueError, ArcadeError) as error:
            raise ToolError(str(error)) from None
        self._write()
        self.session = started
        rules = [] if started.rules == before.rules else [started.rules]
        return "\n".join([*rules, self._turn()])

    async def notes(self, text: str | None = None) -> str:
        """Returns your notes. With `text`, replaces your notes by this text. Notes are kept when an episode ends."""
        if text is not None:
            if len(text) > MOST_NOTES:
                raise ToolError(f"the notes have {len(text)} characters; shorten them to {MOST_NOTES}")
            self._notes = text
        return self._notes or "You have no notes. Call `notes` with a text to write some."

    def close(self) -> None:
        """Writes the log of an episode that is not over."""
        self._write()

    def _start(self, game: str | None, level: int | None) -> TextSession:
        own, found = self._shelf.find(game, level)
        run = self._runs.get((own.id, found.number), 0)
        return TextSession(own, found, seed=self._seed, run=run, max_steps=self._max_steps)

    def _turn(self) -> str:
        session = self.session
        head = f"Game {session.game.id}, level {session.level.number}, episode {session.run + 1}."
        tail = "\nCall `reset` to play again, or with `level` to play a different level.\n" if session.is_over else ""
        return f"{head}\n\n{session.observation}{tail}"

    @staticmethod
    def _played(done: list[str]) -> list[str]:
        return ["## Actions played\n" + "\n".join(done)]

    def _write(self) -> None:
        session = self.session
        if self._logs is None or session is self._logged or not session.history:
            return
        self._logs.mkdir(parents=True, exist_ok=True)
        self._written += 1
        self._logged = session
        path = self._logs / f"{self._written:04}-{session.game.id}-{session.level.number}.jsonl"
        path.write_text(session.log(), "utf-8")


def server_of(player: Player) -> Any:
    """Returns an MCP server with the tools of a player."""
    server = MCPServer("infinite-arcade", instructions=_INSTRUCTIONS, log_level="WARNING")
    tools: list[Callable[..., Any]] = [player.look, player.act, player.reset, player.notes]
    for tool in tools:
        server.add_tool(tool, structured_output=False)
    return server


def main() -> None:
    """Serves the levels that the command line requests, over standard input and output."""
    parser = argparse.ArgumentParser(
        prog="python -m infinite_arcade.mcp",
        description="Serves levels as tools over the Model Context Protocol, on standard input and output.",
    )
    add_arguments(parser)
    parser.add_argument("--seed", default="evaluate", help="the seed of the games' randomness; default: evaluate")
    parser.add_argument("--logs", type=Path, help="a folder for the logs of episodes")
    arguments = parser.parse_args()
    try:
        player = Player(
            shelf_of(arguments), seed=arguments.seed, max_steps=arguments.max_steps, logs=arguments.logs
        )
    except (ArcadeError, OSError, ValueError, VgdlError) as error:
        print(f"error: {error}", file=sys.stderr)
        raise SystemExit(2) from None
    try:
        server_of(player).run()
    except KeyboardInterrupt:
        raise SystemExit(130) from None
    finally:
        player.close()


if __name__ == "__main__":
    main()
