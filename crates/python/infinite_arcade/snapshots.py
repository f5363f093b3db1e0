"""Releases: reading and verifying them."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from . import _native
from ._native import ArcadeError
from .games import Game

__all__ = ["Release", "SnapshotGame", "open_snapshot", "verify"]


@dataclass(frozen=True)
class SnapshotGame:
    """A game of a release."""

    id: str
    card: dict[str, Any] = field(repr=False)
    folder: Path = field(repr=False)

    def compile(self) -> Game:
        """The game with its levels.

        Raises:
            VgdlError: it does not compile, which no verified release has.
        """
        path = self.folder / "game.vgdl"
        game = Game(path.read_text("utf-8"), name=str(path), id=self.id, title=str(self.card["title"]))
        for level in self.card["levels"]:
            file = self.folder / level["file"]
            game.level(file.read_text("utf-8"), name=str(file), optimal_ticks=level.get("optimal_ticks"))
        return game

    def witness(self, level: int) -> dict[str, Any] | None:
        """The episode that wins a level: ``seed``, ``actions``, ``hashes``, ``outcome``, ``score``; None if it is withheld."""
        path = self.folder / "witness" / f"lvl{level}.json"
        if not path.is_file():
            return None
        episode: dict[str, Any] = json.loads(path.read_text("utf-8"))["episode"]
        return episode


@dataclass(frozen=True)
class Release:
    """A release whose digests have been checked."""

    path: Path
    manifest: dict[str, Any] = field(repr=False)

    @property
    def name(self) -> str:
        """Its name."""
        return str(self.manifest["name"])

    @property
    def root(self) -> str:
        """Its root digest."""
        return str(self.manifest["root"])

    def games(self) -> Iterator[SnapshotGame]:
        """Its games, in the order of the manifest."""
        for item in self.manifest["items"]:
            parts = str(item["path"]).split("/")
            if len(parts) == 3 and parts[0] == "games" and parts[2] == "card.json":
                folder = self.path / "games" / parts[1]
                card = json.loads((folder / "card.json").read_text("utf-8"))
                yield SnapshotGame(parts[1], card, folder)

    def game(self, id: str) -> SnapshotGame:
        """The game of that id.

        Raises:
            KeyError: there is none.
        """
        for game in self.games():
            if game.id == id:
                return game
        raise KeyError(f"{self.path}: there is no game `{id}`")


def open_snapshot(path: str | Path) -> Release:
    """Opens a release's folder after checking the digest of every file.

    Raises:
        ArcadeError: it is not a release, or a digest is wrong.
    """
    path = Path(path)
    manifest, problems = _native.integrity(path)
    if problems:
        raise ArcadeError(f"{path}: does not verify: {problems[0]}; `infinite_arcade.verify` lists all problems")
    return Release(path, json.loads(manifest))


def verify(path: str | Path) -> dict[str, Any]:
    """Verifies a release's folder or archive, as ``arcade verify`` does: digests, games, levels, and a replay of every witness.

    Returns:
        ``name``, ``root``, ``games``, ``levels``, ``witnesses`` and ``problems``, which is empty for a sound release.

    Raises:
        ArcadeError: there is no manifest, or it is broken.
    """
    found: dict[str, Any] = json.loads(_native.verify(Path(path)))
    return found
