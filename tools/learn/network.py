"""The network of the learning agents, a perceptron on planes, which is trained by JAX and played by NumPy.

JAX is used instead of PyTorch, because the wheel of PyTorch contains the libraries of graphics cards. A perceptron is
used instead of a convolutional network, because a training step costs less on two cores. The performance of the two
was not compared.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

#: The widths of the hidden layers.
HIDDEN = (256, 128)

#: The weights and biases of each layer.
Parameters = list[tuple[Any, Any]]


@dataclass(frozen=True)
class Shape:
    """The inputs and outputs of a network: the names of the planes, the size of the board, and the names of the
    actions.
    """

    planes: tuple[str, ...]
    rows: int
    columns: int
    actions: tuple[str, ...]

    @property
    def inputs(self) -> int:
        """The number of inputs."""
        return len(self.planes) * self.rows * self.columns


def fresh(draws: np.random.Generator, inputs: int, outputs: int) -> Parameters:
    """Returns random parameters by He's rule. The last layer has small weights."""
    widths, layers = [inputs, *HIDDEN, outputs], []
    for at, (before, after) in enumerate(zip(widths, widths[1:], strict=False)):
        scale = 0.01 if at == len(HIDDEN) else np.sqrt(2 / before)
        weights = draws.standard_normal((before, after)).astype(np.float32) * np.float32(scale)
        layers.append((weights, np.zeros(after, np.float32)))
    return layers


def forward(parameters: Parameters, inputs: Any, maximum: Any = np.maximum) -> Any:
    """Returns the outputs of the network. ``inputs`` is ``[batch][inputs]``, and ``maximum`` is the function of NumPy
    or of JAX.
    """
    for weights, biases in parameters[:-1]:
        inputs = maximum(inputs @ weights + biases, 0)
    weights, biases = parameters[-1]
    return inputs @ weights + biases


def save(path: Path, shape: Shape, parameters: Parameters) -> None:
    """Writes a checkpoint to a file."""
    arrays = {f"w{at}": np.asarray(weights) for at, (weights, _) in enumerate(parameters)}
    arrays |= {f"b{at}": np.asarray(biases) for at, (_, biases) in enumerate(parameters)}
    np.savez_compressed(path, shape=np.array(json.dumps(asdict(shape))), **arrays)


def load(path: Path) -> tuple[Shape, Parameters]:
    """Reads a checkpoint from a file."""
    with np.load(path) as file:
        said = json.loads(str(file["shape"]))
        shape = Shape(tuple(said["planes"]), said["rows"], said["columns"], tuple(said["actions"]))
        layers = sum(name.startswith("w") for name in file.files)
        return shape, [(file[f"w{at}"], file[f"b{at}"]) for at in range(layers)]


def greedy(shape: Shape, parameters: Parameters, board: NDArray[np.uint8], offered: list[str]) -> str:
    """Returns the best of the offered actions."""
    outputs = forward(parameters, board.reshape(1, -1).astype(np.float32))[0][: len(shape.actions)]
    known = [at for at, action in enumerate(shape.actions) if action in offered]
    return shape.actions[max(known, key=lambda at: outputs[at])] if known else "nil"
