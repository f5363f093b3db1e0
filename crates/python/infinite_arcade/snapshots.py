"""Mints, reads and verifies releases."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from . import _native
from ._arguments import at_least, did_you_mean
from ._native import ArcadeError
from .games import Game

__all__ = ["Release", "SnapshotGame", "merge", "mint", "open_snapshot", "verify"]


@dataclass(frozen=True)
class SnapshotGame:
    """A game in a release."""

    id: str
    card: dict[str, Any] = field(repr=False)
    folder: Path = field(repr=False)

    def compile(self) -> Game:
        """Compiles the game and its levels.

        Raises:
            VgdlError: if the game does not compile, which cannot happen in a verified release.
        """
        path = self.folder / "game.vgdl"
        game = Game(path.read_text("utf-8"), name=str(path), id=self.id, title=str(self.card["title"]))
        for level in self.card["levels"]:
            file = self.folder / level["file"]
            text, optimal = file.read_text("utf-8"), level.get("optimal_ticks")
            game.levels.append(game.level(text, name=str(file), optimal_ticks=optimal))
        return game

    def witness(self, level: int) -> dict[str, Any] | None:
        """Returns the winning episode of a level, or None if the episode is withheld. The episode has ``seed``,
        ``actions``, ``hashes``, ``outcome`` and ``score``.
        """
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
        """The release's name."""
        return str(self.manifest["name"])

    @property
    def root(self) -> str:
        """The release's root digest."""
        return str(self.manifest["root"])

    def games(self) -> Iterator[SnapshotGame]:
        """The release's games, in manifest order."""
        for item in self.manifest["items"]:
            parts = str(item["path"]).split("/")
            if len(parts) == 3 and parts[0] == "games" and parts[2] == "card.json":
                folder = self.path / "games" / parts[1]
                card = json.loads((folder / "card.json").read_text("utf-8"))
                yield SnapshotGame(parts[1], card, folder)

    def game(self, id: str) -> SnapshotGame:
        """Returns the game with the given ID.

        Raises:
            KeyError: if there is no such game.
        """
        known = []
        for game in self.games():
            if game.id == id:
                return game
            known.append(game.id)
        raise KeyError(f"{self.path}: there is no game `{id}`{did_you_mean(id, known)}")


def open_snapshot(path: str | Path) -> Release:
    """Opens a release's folder, after checking the digest of every file.

    Raises:
        ArcadeError: if the folder is not a release, or a digest is wrong.
    """
    path = Path(path)
    manifest, problems = _native.integrity(path)
    if problems:
        raise ArcadeError(f"{path}: does not verify: {problems[0]}; `infinite_arcade.verify` lists all problems")
    return Release(path, json.loads(manifest))


def verify(path: str | Path) -> dict[str, Any]:
    """Verifies the folder or archive of a release, in the same way as ``arcade verify``. Checks the digests, the
    games and the levels, and replays every witness.

    Returns:
        A dictionary with ``name``, ``root``, ``games``, ``levels``, ``witnesses`` and ``problems``. ``problems`` is
        empty if the release is valid.

    Raises:
        ArcadeError: if there is no manifest, or the manifest is damaged.
    """
    found: dict[str, Any] = json.loads(_native.verify(Path(path)))
    return found


def mint(
    recipe: str | Path,
    out: str | Path,
    *,
    parent: str | Path | None = None,
    secret: str | Path | None = None,
    shard: str | None = None,
    resume: bool = False,
    jobs: int | None = None,
) -> dict[str, Any]:
    """Mints a release, like ``arcade release``. The same recipe always gives the same bytes.

    The folder is either complete or absent. If the mint is interrupted, the finished jobs are kept next to the folder
    for ``resume``.

    Args:
        recipe: the name of a recipe embedded in the package, or a .toml file.
        out: the folder for the release, which must be absent or empty.
        parent: the folder of the previous release. No content of the previous release is minted again.
        secret: the secret of a sealed release, as created by ``arcade release --commit``.
        shard: ``K/N`` to mint only the K-th of N shards, for :func:`merge`.
        resume: keep the jobs that an interrupted mint has finished.
        jobs: the number of threads; by default one per core.

    Returns:
        A dictionary with ``out``, ``root``, ``games`` (their cards), ``card`` and ``caveats``. For a shard, a
        dictionary with ``out``, ``shard`` and ``jobs`` (the number of jobs).

    Raises:
        ArcadeError: if the recipe cannot be minted, or the folder cannot be written.
        FileNotFoundError: if there is no such recipe.
        ValueError: if ``shard`` does not have the form ``K/N``.
    """
    at_least(1, jobs=jobs)
    made: dict[str, Any] = json.loads(
        _native.mint(
            recipe_text(recipe),
            Path(out),
            parent=_path(parent),
            secret=_path(secret),
            shard=shard,
            resume=resume,
            jobs=jobs,
        )
    )
    return made


def merge(
    shards: Sequence[str | Path], out: str | Path, *, secret: str | Path | None = None, jobs: int | None = None
) -> dict[str, Any]:
    """Merges the shards of a release, in the same way as ``arcade merge``. The result is the same as that of a mint
    without shards.

    Args:
        shards: the folders of all shards, in any order.
        out: the folder for the release, which must be absent or empty.
        secret: the secret of a sealed release.
        jobs: the number of threads; by default one per core.

    Returns:
        A dictionary in the form that :func:`mint` returns.

    Raises:
        ArcadeError: if a shard is missing or has been altered, or the folder cannot be written.
    """
    at_least(1, jobs=jobs)
    folders = [Path(shard) for shard in shards]
    made: dict[str, Any] = json.loads(_native.merge(folders, Path(out), secret=_path(secret), jobs=jobs))
    return made


def recipe_text(recipe: str | Path) -> str:
    """Returns the text of a recipe, which is a .toml file or is embedded in the package.

    Raises:
        FileNotFoundError: if there is no such recipe.
    """
    if str(recipe).endswith(".toml"):
        return Path(recipe).read_text("utf-8")
    text = _native.recipe(str(recipe))
    if text is None:
        raise FileNotFoundError(f"there is no recipe named `{recipe}`: pass a .toml file, or a recipe listed by `arcade recipes`")
    return text


def _path(path: str | Path | None) -> Path | None:
    return None if path is None else Path(path)
