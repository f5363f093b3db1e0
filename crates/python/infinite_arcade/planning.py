"""Planners: players that look ahead on copies of the state."""

from __future__ import annotations

from . import _native
from .games import Level, State

__all__ = ["PLANNERS", "Planner", "play"]

#: The names of all planners, the weakest first.
PLANNERS: list[str] = _native.planner_names()


class Planner:
    """A planner with its own random streams: ``mcts``, or ``olets:500`` with the forward-model calls of a decision."""

    __slots__ = ("_native",)

    def __init__(self, name: str, *, seed: str, budget: int = 1000) -> None:
        """Creates it.

        Args:
            name: one of :data:`PLANNERS`, with ``:CALLS`` or without.
            seed: the text that its random streams are derived from.
            budget: the forward-model calls of a decision, if the name has none.

        Raises:
            ValueError: there is no such planner.
        """
        self._native = _native.Planner(name, seed=seed, budget=budget)

    def plan(self, state: State, count: int = 1) -> tuple[list[str], int]:
        """The next actions, and the forward-model calls that they cost. The lock is released meanwhile."""
        return self._native.plan(state._native, count)

    def act(self, state: State) -> str:
        """The next action."""
        actions, _ = self.plan(state)
        return actions[0]

    def __repr__(self) -> str:
        return repr(self._native)


def play(level: Level, planner: Planner, *, seed: str, max_steps: int | None = None) -> tuple[State, list[str]]:
    """Plays an episode and returns its last state and its actions. ``seed`` decides the game's chance."""
    state, actions = level.start(seed), list[str]()
    while not state.is_over and (max_steps is None or len(actions) < max_steps):
        actions.append(planner.act(state))
        state.step(actions[-1])
    return state, actions
