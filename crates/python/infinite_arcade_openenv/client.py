"""The client of the environment."""

from __future__ import annotations

from typing import Any

from openenv.core import EnvClient
from openenv.core.client_types import StepResult

from infinite_arcade_openenv.models import ArcadeAction, ArcadeObservation, ArcadeState

__all__ = ["ArcadeEnv"]


class ArcadeEnv(EnvClient[ArcadeAction, ArcadeObservation, ArcadeState]):
    """A client with its own session on the server.

    ``reset`` accepts ``seed``, ``index`` (with ``split``), or ``game`` and ``level``.
    """

    def _step_payload(self, action: ArcadeAction) -> dict[str, Any]:
        return {"action": action.action}

    def _parse_result(self, payload: dict[str, Any]) -> StepResult[ArcadeObservation]:
        reward, done = payload.get("reward"), payload.get("done", False)
        observation = ArcadeObservation(**{**payload["observation"], "reward": reward, "done": done})
        return StepResult(observation=observation, reward=reward, done=done, metadata=payload.get("metadata"))

    def _parse_state(self, payload: dict[str, Any]) -> ArcadeState:
        return ArcadeState(**payload)
