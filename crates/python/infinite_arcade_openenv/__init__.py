"""An environment for OpenEnv: client and models. The server is in :mod:`infinite_arcade_openenv.server`.

>>> from infinite_arcade_openenv import ArcadeAction, ArcadeEnv
>>> with ArcadeEnv(base_url="http://localhost:8000").sync() as env:
...     observation = env.reset(seed=7).observation
...     result = env.step(ArcadeAction(action="right"))

The client needs only ``openenv``. The server also needs ``infinite_arcade``.
"""

from .client import ArcadeEnv
from .models import ArcadeAction, ArcadeObservation, ArcadeState

__all__ = ["ArcadeAction", "ArcadeEnv", "ArcadeObservation", "ArcadeState"]
