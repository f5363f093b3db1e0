"""The server of the environment for OpenEnv."""

from infinite_arcade_openenv.server.environment import ArcadeEnvironment

__all__ = ["ArcadeEnvironment"]
