"""Planners: players that look ahead on copies of the state."""

from __future__ import annotations

from typing import Any

from . import _native
from ._arguments import Seed, at_least, seed_text
from .games import Level, State

__all__ = ["PLANNERS", "Planner", "play"]

#: The names of all planners, from weakest to strongest.
PLANNERS: list[str] = _native.planner_names()


class Planner:
    """A planner with its own random streams, such as ``mcts`` or ``olets:500``. The number in the name is the number
    of forward-model calls per decision. A pickled or copied planner continues like the original.
    """

    __slots__ = ("_native",)

    def __init__(self, name: str, *, seed: Seed, budget: int = 1000) -> None:
        """Creates a planner.

        Args:
            name: one of :data:`PLANNERS`, with or without ``:CALLS``.
            seed: the text or integer from which the random streams are derived.
            budget: the number of forward-model calls per decision, used if the name contains no number.

        Raises:
            ValueError: if there is no such planner, or the budget is less than 1 call.
        """
        at_least(1, budget=budget)
        self._native = _native.Planner(name, seed=seed_text(seed), budget=budget)

    def __reduce__(self) -> Any:
        return _planner_of, (self._native.save(),)

    def plan(self, state: State, count: int = 1) -> tuple[list[str], int]:
        """Returns the next actions, and their cost in forward-model calls. Releases the interpreter's lock while
        planning.

        Raises:
            ValueError: if ``count`` is less than 1.
        """
        at_least(1, count=count)
        return self._native.plan(state._native, count)

    def act(self, state: State) -> str:
        """Returns the next action."""
        actions, _ = self.plan(state)
        return actions[0]

    def __repr__(self) -> str:
        return repr(self._native)


def play(level: Level, planner: Planner, *, seed: Seed, max_steps: int | None = None) -> tuple[State, list[str]]:
    """Plays an episode with a planner. Returns its last state and its actions. ``seed`` determines the game's
    randomness.
    """
    at_least(0, max_steps=max_steps)
    state, actions = level.start(seed), list[str]()
    while not state.is_over and (max_steps is None or len(actions) < max_steps):
        actions.append(planner.act(state))
        state.step(actions[-1])
    return state, actions


def _planner_of(saved: str) -> Planner:
    planner = Planner.__new__(Planner)
    planner._native = _native.Planner.load(saved)
    return planner
