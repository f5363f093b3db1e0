"""The extension module. Use the documented classes and functions of the package instead."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

__version__: str
SEMANTICS: int
GENERATION: int
ACTIONS: list[str]

class ArcadeError(Exception):
    """Raised if the suite cannot fulfil a request. The message states the reason."""

class LogError(ArcadeError):
    """Raised if a log is damaged, was changed, or belongs to a different episode."""

class VgdlError(ValueError):
    """Raised if a game or level does not compile. The exception prints like the messages of ``arcade``."""

    diagnostics: list[dict[str, Any]]

_LevelText = tuple[int, str, int | None]

def corpus() -> list[tuple[str, str, list[str], str]]: ...
def games_of_files(names: list[str]) -> list[tuple[str, list[tuple[int, str]]]]: ...
def levels_of_files(source: str, names: list[str]) -> list[tuple[int, str]]: ...
def game_of_level(level: str, names: list[str]) -> str | None: ...
def seed_from_text(text: str) -> str:
    """Returns the seed derived from a text, as 64 hexadecimal digits."""

def seed_child(seed: str, purpose: str, index: int) -> str:
    """Derives a seed from ``seed``, ``purpose`` and ``index``. Distinct purposes give independent seeds."""

def planner_names() -> list[str]: ...

class Game:
    def __init__(self, source: str, *, name: str = ..., as_reference: bool = ...) -> None: ...
    name: str
    source: str
    as_reference: bool
    digest: str
    actions: list[str]
    time_limit: int
    is_deterministic: bool
    types: list[str]
    symbols: list[tuple[str, str]]
    warnings: list[dict[str, Any]]
    def level(self, text: str, *, name: str = ...) -> Level: ...
    def describe(self) -> str: ...
    def facts(self) -> str: ...

class Level:
    name: str
    game: Game
    digest: str
    columns: int
    rows: int
    text: str
    def describe(self) -> list[str]: ...
    def start(self, seed: str) -> State: ...
    def gif(
        self, seed: str, actions: list[str], cell: int, delay: int, caption: bool
    ) -> bytes: ...

class State:
    level: Level
    history: list[tuple[str, list[str]]]
    ticks: int
    score: float
    outcome: str
    stopped_by: str | None
    is_over: bool
    size: tuple[int, int]
    actions: list[str]
    def step(self, action: str) -> str: ...
    def play(self, actions: list[str]) -> list[str]: ...
    def state_hash(self) -> str: ...
    def copy(self) -> State: ...
    def fork(self, seed: str) -> State: ...
    def observe(self) -> dict[str, Any]: ...
    def planes(self) -> NDArray[np.uint8]: ...
    def text(self) -> str: ...
    def full_text(self) -> str: ...
    def rgb(self, cell: int) -> tuple[int, int, NDArray[np.uint8]]: ...
    def png(self, cell: int, *, caption: bool = ..., legend: bool = ...) -> bytes: ...
    def svg(self, cell: int, *, caption: bool = ..., legend: bool = ...) -> str: ...

class Stream:
    def __init__(
        self,
        games: list[tuple[str, Game, list[Level]]],
        *,
        seed: str,
        difficulty: float | None = ...,
        size: tuple[int, int] | None = ...,
        avoid: list[str] = ...,
    ) -> None: ...
    def item(self, index: int) -> str: ...

class Planner:
    def __init__(self, name: str, *, seed: str, budget: int = ...) -> None: ...
    def save(self) -> str: ...
    @staticmethod
    def load(saved: str) -> Planner: ...
    def plan(self, state: State, count: int = ...) -> tuple[list[str], int]: ...

_SavedLane = tuple[int, str, int, str, bytes, bool, tuple[float, str, list[float]]]

class Lanes:
    status_names: list[str]
    shape: list[int]
    planes: list[str]
    seeds: list[str]
    levels: list[int]
    hashes: list[str]
    outcomes: list[str]
    scores: list[float]
    def __init__(
        self,
        levels: list[Level],
        count: int,
        *,
        size: tuple[int, int],
        observation: str,
        cell: int,
        max_steps: int,
        autoreset: str,
        threads: int,
    ) -> None: ...
    def __len__(self) -> int: ...
    def last(self, lane: int) -> tuple[float, str, list[float]]: ...
    def status(self, out: NDArray[np.float32]) -> None: ...
    def save(self) -> list[_SavedLane]: ...
    def restore(self, saved: list[_SavedLane], observations: NDArray[np.uint8]) -> None: ...
    def state(self, lane: int) -> State: ...
    def seed(self, lane: int, seed: str, exact: bool) -> None: ...
    def seed_all(self, seed: str) -> None: ...
    def choose(self, lane: int, level: int) -> None: ...
    def reset(
        self, mask: NDArray[np.bool_], observations: NDArray[np.uint8], exact: bool = ...
    ) -> None: ...
    def step(
        self,
        actions: NDArray[np.int64],
        observations: NDArray[np.uint8],
        rewards: NDArray[np.float64],
        terminated: NDArray[np.bool_],
        truncated: NDArray[np.bool_],
        last: NDArray[np.uint8] | None,
    ) -> int: ...
    def step_blindly(self, actions: NDArray[np.int64], rounds: int) -> int: ...

class Series:
    seeds: list[str]
    folder: Path | None
    def __init__(
        self,
        game: Game,
        id: str,
        levels: list[_LevelText],
        *,
        group: int = ...,
        run: int = ...,
        seed: str,
        max_steps: int,
        commit: str = ...,
        track: str | None = ...,
        prompts: str | None = ...,
        reasks: int = ...,
        folder: Path | None = ...,
    ) -> None: ...
    @staticmethod
    def plan(
        game: Game, id: str, levels: list[_LevelText], *, track: str | None = ...
    ) -> list[list[int]]: ...
    def next_request(self) -> list[tuple[str, str, bytes | None]] | None: ...
    def answer(
        self,
        text: str,
        *,
        finish: str = ...,
        reasoning: str | None = ...,
        input_tokens: int | None = ...,
        output_tokens: int | None = ...,
        served_by: str | None = ...,
        latency_ms: float = ...,
    ) -> None: ...
    def fail(self, message: str, *, kind: str = ...) -> None: ...
    def results(self) -> list[dict[str, Any]]: ...

def prompt_digest(
    game: Game, *, track: str | None = ..., prompts: str | None = ..., commit: str = ...
) -> str: ...
def replay_log(
    game: Game,
    id: str,
    levels: list[_LevelText],
    log: str,
    *,
    level: int | None = ...,
    run: int = ...,
    seed: str | None = ...,
    max_steps: int | None = ...,
    commit: str = ...,
    track: str | None = ...,
) -> str: ...
def metrics_of_log(game: Game, id: str, levels: list[_LevelText], log: str) -> str: ...
def read_log(path: Path, timeless: bool) -> str: ...
def draw_questions(
    games: list[tuple[Game, str, list[_LevelText]]], *, kinds: list[str] | None, count: int, seed: str
) -> list[str]: ...
def is_right_answer(kind: str, options: int, answer: str, text: str) -> bool: ...
def question_kinds() -> list[str]: ...
def validate(level: Level, *, budget: int, seed: str) -> str: ...
def generate_levels(
    game: Game,
    examples: list[Level],
    *,
    method: str,
    count: int,
    seed: str,
    difficulty: str | None = ...,
    size: tuple[tuple[int, int], tuple[int, int]] | None = ...,
    min_solution: int | None = ...,
    verified: bool = ...,
    sprites: list[tuple[str, int]] = ...,
) -> str: ...
def generate_games(*, kinds: list[str], method: str, count: int, levels: int, seed: str) -> str: ...
def verify(path: Path) -> str: ...
def integrity(path: Path) -> tuple[str, list[str]]: ...
def recipe(name: str) -> str | None: ...
def mint(
    recipe: str,
    out: Path,
    *,
    parent: Path | None = ...,
    secret: Path | None = ...,
    shard: str | None = ...,
    resume: bool = ...,
    jobs: int | None = ...,
) -> str: ...
def merge(shards: list[Path], out: Path, *, secret: Path | None = ..., jobs: int | None = ...) -> str: ...
