"""Trains DQN or PPO on all levels of a game, with one network per game and the same settings for all games.

Example: python tools/learn/train.py ppo /path/to/games/aliens --steps 2000000 --out checkpoints

Writes GAME-ALGORITHM.npz, which `player.py` plays, and GAME-ALGORITHM.csv, the learning curve. The settings are those
of the seed table (docs/reference/spec/04-agents.md, 11) as far as it states them: learning rate 3e-4, batches of 256,
discount 0.99. PPO has λ 0.95 and entropy 0.01. DQN has exploration from 1 to 0.02 over the first tenth. The same
arguments give the same random draws, but the floats of JAX may differ between machines.

The reward is the change in score, clipped to ±1, and ±1 in addition for a win or a loss. The outcome is included
because the scores of some games say little about winning.
"""

from __future__ import annotations

import argparse
import csv
import time
from collections import deque
from functools import partial
from pathlib import Path
from typing import Any

import gymnasium
import jax
import jax.numpy as jnp
import numpy as np
import optax

import infinite_arcade as ia
from infinite_arcade.gymnasium import GameVectorEnv
from network import Parameters, Shape, forward, fresh, save

GAMMA, RATE, BATCH = 0.99, 3e-4, 256


class Episodes:
    """A vector of environments, with the wins and scores of the last 200 episodes for the learning curve."""

    def __init__(self, game: ia.Game, count: int, max_steps: int, seed: int, curve: Path) -> None:
        mode = gymnasium.vector.AutoresetMode.SAME_STEP
        self.envs = GameVectorEnv(game, num_envs=count, max_steps=max_steps, autoreset_mode=mode, threads=1)
        _, rows, columns = self.envs.single_observation_space.shape or (0, 0, 0)
        self.shape = Shape(tuple(self.envs.planes), rows, columns, tuple(game.actions))
        self.boards = self.envs.reset(seed=seed)[0].reshape(count, -1)
        self.steps, self.episodes = 0, 0
        self.wins, self.scores = deque[bool](maxlen=200), deque[float](maxlen=200)
        self.started, self.shown = time.perf_counter(), 0.0
        self.file = curve.open("w", newline="")
        self.curve = csv.writer(self.file)
        self.curve.writerow(["steps", "episodes", "wins", "score", "seconds"])

    def step(self, actions: Any) -> tuple[Any, Any, Any]:
        """Plays a step. Returns the rewards, the ends of episodes, and the boards reached by the step. For an episode
        that ended, the board is its last board.
        """
        boards, rewards, terminated, truncated, info = self.envs.step(np.asarray(actions))
        rewards = np.clip(rewards, -1, 1)
        reached = self.boards = boards.reshape(len(boards), -1)
        over = terminated | truncated
        if over.any():
            reached = reached.copy()
            for at in np.flatnonzero(over):
                reached[at] = info["final_obs"][at].reshape(-1)
                outcome = info["final_info"]["outcome"][at]
                rewards[at] += {"won": 1.0, "lost": -1.0}.get(outcome, 0.0)
                self.wins.append(outcome == "won")
                self.scores.append(float(info["final_info"]["score"][at]))
                self.episodes += 1
        self.steps += len(rewards)
        return rewards.astype(np.float32), over, reached

    def note(self) -> None:
        """Adds a point to the learning curve every ten seconds."""
        passed = time.perf_counter() - self.started
        if passed - self.shown >= 10 and self.wins:
            self.shown = passed
            row = [self.steps, self.episodes, f"{np.mean(self.wins):.3f}", f"{np.mean(self.scores):.2f}", f"{passed:.0f}"]
            self.curve.writerow(row)
            self.file.flush()
            print(*row, flush=True)


def values(parameters: Parameters, boards: Any) -> Any:
    """Returns the outputs of the network for boards of bytes."""
    return forward(parameters, boards.astype(jnp.float32), jnp.maximum)


# --- DQN -----------------------------------------------------------------------------------------------------------


@partial(jax.jit, static_argnums=0, donate_argnums=(1, 2))
def learn_values(optimiser: Any, parameters: Any, memory: Any, target: Any, batch: Any) -> Any:
    """Performs a step of double DQN with the Huber loss."""
    boards, actions, rewards, over, reached = batch
    chosen = values(parameters, reached).argmax(1)
    later = jnp.take_along_axis(values(target, reached), chosen[:, None], 1)[:, 0]
    goal = rewards + GAMMA * later * ~over

    def loss(parameters: Any) -> Any:
        said = jnp.take_along_axis(values(parameters, boards), actions[:, None], 1)[:, 0]
        return optax.huber_loss(said, goal).mean()

    updates, memory = optimiser.update(jax.grad(loss)(parameters), memory, parameters)
    return optax.apply_updates(parameters, updates), memory


def dqn(episodes: Episodes, steps: int, seed: int, buffer: int = 200_000, count: int = 64) -> Parameters:
    """Trains by deep Q-learning. Boards are packed in a replay buffer. Four samples are learnt for each step, and the
    target network is updated every 500 updates.
    """
    draws, actions = np.random.default_rng(seed), len(episodes.shape.actions)
    parameters: Any = jax.tree.map(jnp.asarray, fresh(draws, episodes.shape.inputs, actions))
    target = jax.tree.map(jnp.copy, parameters)
    optimiser = optax.chain(optax.clip_by_global_norm(10), optax.adam(RATE))
    memory = optimiser.init(parameters)
    best = jax.jit(lambda parameters, boards: values(parameters, boards).argmax(1))
    inputs = episodes.shape.inputs
    size = min(buffer, steps) // count * count
    packed = np.zeros((2, size, (inputs + 7) // 8), np.uint8)
    acted, gained, ended = np.zeros(size, np.int32), np.zeros(size, np.float32), np.zeros(size, np.bool_)
    updates = 0
    while episodes.steps < steps:
        explored = max(0.02, 1 - 0.98 * episodes.steps / (0.1 * steps))
        before = episodes.boards
        chosen = np.array(best(parameters, before), np.int64)
        random = draws.random(count) < explored
        chosen[random] = draws.integers(actions, size=int(random.sum()))
        at = episodes.steps % size
        rewards, over, reached = episodes.step(chosen)
        place = slice(at, at + count)
        packed[0, place], packed[1, place] = np.packbits(before, axis=1), np.packbits(reached, axis=1)
        acted[place], gained[place], ended[place] = chosen, rewards, over
        filled = min(episodes.steps, size)
        if episodes.steps >= 10_000:
            rows = draws.integers(filled, size=BATCH)
            one, two = (np.unpackbits(packed[side, rows], axis=1, count=inputs) for side in range(2))
            batch = (one, acted[rows], gained[rows], ended[rows], two)
            parameters, memory = learn_values(optimiser, parameters, memory, target, batch)
            updates += 1
            if updates % 500 == 0:
                target = jax.tree.map(jnp.copy, parameters)
        episodes.note()
    return parameters


# --- PPO -----------------------------------------------------------------------------------------------------------


@partial(jax.jit, static_argnums=0, donate_argnums=(1, 2))
def learn_policy(optimiser: Any, parameters: Any, memory: Any, batch: Any) -> Any:
    """Performs a step of PPO with a clipped ratio, values and entropy."""
    boards, actions, before, advantages, returns = batch
    advantages = (advantages - advantages.mean()) / (advantages.std() + 1e-8)

    def loss(parameters: Any) -> Any:
        outputs = values(parameters, boards)
        logs = jax.nn.log_softmax(outputs[:, :-1])
        ratio = jnp.exp(jnp.take_along_axis(logs, actions[:, None], 1)[:, 0] - before)
        gain = jnp.minimum(ratio * advantages, jnp.clip(ratio, 0.8, 1.2) * advantages).mean()
        entropy = -(jnp.exp(logs) * logs).sum(1).mean()
        return 0.5 * ((outputs[:, -1] - returns) ** 2).mean() - gain - 0.01 * entropy

    updates, memory = optimiser.update(jax.grad(loss)(parameters), memory, parameters)
    return optax.apply_updates(parameters, updates), memory


@jax.jit
def decide(parameters: Any, boards: Any, key: Any) -> Any:
    """Draws actions. Returns the actions, their log probabilities and the values."""
    outputs = values(parameters, boards)
    logs = jax.nn.log_softmax(outputs[:, :-1])
    actions = jax.random.categorical(key, logs)
    return actions, jnp.take_along_axis(logs, actions[:, None], 1)[:, 0], outputs[:, -1]


def ppo(episodes: Episodes, steps: int, seed: int, count: int = 64, ticks: int = 64, epochs: int = 4) -> Parameters:
    """Trains by proximal policy optimisation. A truncated episode counts as an episode that ends."""
    draws, key = np.random.default_rng(seed), jax.random.key(seed)
    shape = episodes.shape
    parameters: Any = jax.tree.map(jnp.asarray, fresh(draws, shape.inputs, len(shape.actions) + 1))
    optimiser = optax.chain(optax.clip_by_global_norm(0.5), optax.adam(RATE))
    memory = optimiser.init(parameters)
    boards = np.zeros((ticks, count, shape.inputs), np.uint8)
    actions = np.zeros((ticks, count), np.int32)
    logs, worth, gained = (np.zeros((ticks, count), np.float32) for _ in range(3))
    ended = np.zeros((ticks, count), np.bool_)
    while episodes.steps < steps:
        for tick in range(ticks):
            key, own = jax.random.split(key)
            boards[tick] = episodes.boards
            actions[tick], logs[tick], worth[tick] = decide(parameters, boards[tick], own)
            gained[tick], ended[tick], _ = episodes.step(actions[tick].astype(np.int64))
        later = np.asarray(decide(parameters, episodes.boards, key)[2])
        advantages, running = np.zeros_like(worth), np.zeros(count, np.float32)
        for tick in reversed(range(ticks)):
            alive = ~ended[tick]
            difference = gained[tick] + GAMMA * later * alive - worth[tick]
            running = difference + GAMMA * 0.95 * alive * running
            advantages[tick], later = running, worth[tick]
        returns = advantages + worth
        rows = ticks * count
        flat = [part.reshape(rows, *part.shape[2:]) for part in (boards, actions, logs, advantages, returns)]
        for _ in range(epochs):
            order = draws.permutation(rows)
            for at in range(0, rows, BATCH):
                batch = tuple(part[order[at : at + BATCH]] for part in flat)
                parameters, memory = learn_policy(optimiser, parameters, memory, batch)
        episodes.note()
    return parameters


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("algorithm", choices=["dqn", "ppo"])
    parser.add_argument("game", help="a game, as accepted by `infinite_arcade.load`")
    parser.add_argument("--steps", type=int, default=2_000_000, help="number of environment steps")
    parser.add_argument("--max-steps", type=int, default=1000, help="maximum number of steps per episode")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, default=Path("checkpoints"), help="folder for the checkpoint and the curve")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    game = ia.load(arguments.game, as_reference=True)
    name = arguments.out / f"{game.id}-{arguments.algorithm}"
    episodes = Episodes(game, 64, arguments.max_steps, arguments.seed, name.with_suffix(".csv"))
    train = {"dqn": dqn, "ppo": ppo}[arguments.algorithm]
    parameters = train(episodes, arguments.steps, arguments.seed)
    if arguments.algorithm == "ppo":
        # Players do not need the values.
        weights, biases = parameters[-1]
        parameters = [*parameters[:-1], (weights[:, :-1], biases[:-1])]
    save(name.with_suffix(".npz"), episodes.shape, parameters)
    print(f"{episodes.steps} steps in {time.perf_counter() - episodes.started:.0f} s: {name}.npz")


if __name__ == "__main__":
    main()
