"""Games in VGDL for Python, with the engine, planners, judges, generators and snapshots of Infinite Arcade.

>>> import infinite_arcade as ia
>>> game = ia.load("hailglass")
>>> state = game.levels[0].start("a seed")
>>> state.step("right")
'ongoing'

The environments are in :mod:`infinite_arcade.gymnasium`, the evaluation tasks in :mod:`infinite_arcade.inspect`, and
the tables in :mod:`infinite_arcade.tables`. The package needs only NumPy. If Gymnasium is installed, importing the
package registers the environments.
"""

from contextlib import suppress

from ._native import ACTIONS, GENERATION, SEMANTICS, ArcadeError, LogError, VgdlError, __version__
from .curriculum import Curriculum, Lesson
from .games import CorpusGame, Episode, Game, Level, State, corpus, load, seed_child, seed_from_text
from .judging import generate_games, generate_levels, validate
from .planning import PLANNERS, Planner, play
from .rewards import RewardComponents, RewardWeights, reward_components
from .snapshots import Release, SnapshotGame, merge, mint, open_snapshot, verify
from .streams import Stream, StreamItem, stream

__all__ = [
    "ACTIONS",
    "GENERATION",
    "PLANNERS",
    "SEMANTICS",
    "ArcadeError",
    "CorpusGame",
    "Curriculum",
    "Episode",
    "Game",
    "Lesson",
    "Level",
    "LogError",
    "Planner",
    "Release",
    "RewardComponents",
    "RewardWeights",
    "SnapshotGame",
    "State",
    "Stream",
    "StreamItem",
    "VgdlError",
    "__version__",
    "corpus",
    "generate_games",
    "generate_levels",
    "load",
    "merge",
    "mint",
    "open_snapshot",
    "play",
    "reward_components",
    "seed_child",
    "seed_from_text",
    "stream",
    "validate",
    "verify",
]

# Gymnasium is missing, or is too old for the environments.
with suppress(ImportError):
    from . import gymnasium as gymnasium
