"""The server. ``python -m infinite_arcade_openenv.server.app hailglass --port 8000`` starts it.

``uvicorn infinite_arcade_openenv.server.app:app`` starts it, too, with the arguments in the environment variable
``INFINITE_ARCADE_ARGUMENTS``, such as ``stream lesson-1 --games hailglass``. The default is ``corpus``.
"""

from __future__ import annotations

import argparse
import os
import shlex
import sys
from collections.abc import Sequence
from functools import partial
from typing import Any

from openenv.core.env_server.http_server import create_app

from infinite_arcade import ArcadeError, VgdlError
from infinite_arcade._arguments import at_least
from infinite_arcade.sessions import add_arguments, shelf_of
from infinite_arcade_openenv.models import ArcadeAction, ArcadeObservation, ArcadeState
from infinite_arcade_openenv.server.environment import ArcadeEnvironment

__all__ = ["app_of", "main"]


def app_of(arguments: argparse.Namespace) -> Any:
    """Returns the application that serves the requested levels."""
    at_least(1, sessions=arguments.sessions)
    return create_app(
        partial(ArcadeEnvironment, shelf_of(arguments), max_steps=arguments.max_steps),
        ArcadeAction,
        ArcadeObservation,
        env_name="infinite_arcade",
        max_concurrent_envs=arguments.sessions,
        state_cls=ArcadeState,
    )


def _parsed(words: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m infinite_arcade_openenv.server.app", description="Serves levels as an environment of OpenEnv."
    )
    add_arguments(parser)
    parser.add_argument("--sessions", type=int, default=64, help="the maximum number of sessions at once; default: 64")
    parser.add_argument("--host", default="127.0.0.1", help="the address to listen on; default: 127.0.0.1")
    parser.add_argument("--port", type=int, default=8000, help="the port to listen on; default: 8000")
    return parser.parse_args(words)


def __getattr__(name: str) -> Any:
    # Only a server asks for `app`. Importing the module opens no levels.
    if name == "app":
        return app_of(_parsed(shlex.split(os.environ.get("INFINITE_ARCADE_ARGUMENTS", "corpus"))))
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def main() -> None:
    """Serves the levels that the command line requests."""
    import uvicorn

    arguments = _parsed(sys.argv[1:])
    try:
        app = app_of(arguments)
    except (ArcadeError, OSError, ValueError, VgdlError) as error:
        print(f"error: {error}", file=sys.stderr)
        raise SystemExit(2) from None
    uvicorn.run(app, host=arguments.host, port=arguments.port)


if __name__ == "__main__":
    main()
