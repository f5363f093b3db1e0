"""Compares uniform sampling with a curriculum on real levels, and measures rewards of players without a plan.

The learner plays the actions of the witness, but presses a random key in a fraction of the ticks. The fraction differs
by game, so that the learner wins almost no level of some games, and every level of others.

Example: python tools/learn/curriculum.py --lessons 300
"""

from __future__ import annotations

import argparse
import random
from collections.abc import Callable
from itertools import count
from statistics import mean

import infinite_arcade as ia

GAMES = (
    "bog-lantern,crumb-and-cauldron,diving-bell,first-ice,foxglove-round,garden-post,hailglass,moth-observatory,"
    "quiet-jars,turnip-heist"
)
#: The fractions of random keys, which the games take in turn.
SLIPS = (0.9, 0.0, 0.1, 0.9, 0.02)
DIFFICULTIES = (0.0, 0.5, 1.0)
#: The number of episodes in a group, and the number of levels of a game and a difficulty.
GROUP, LEVELS = 8, 4

Policy = Callable[[ia.State, random.Random, list[str]], str]


def play(item: ia.StreamItem, seed: str, policy: Policy, keys: str) -> ia.State:
    """Plays an episode. The randomness of the game follows from `seed`, and random keys follow from `keys`."""
    state, draws = item.level.start(seed), random.Random(keys)
    while not state.is_over and state.ticks < 1000:
        state.step(policy(state, draws, item.game.actions))
    return state


def learner(item: ia.StreamItem, slips: float) -> Policy:
    """Returns a policy that replays the witness and presses random keys in a fraction of the ticks."""
    known = item.witness.actions

    def policy(state: ia.State, draws: random.Random, actions: list[str]) -> str:
        if draws.random() < slips or state.ticks >= len(known):
            return draws.choice(actions)
        return known[state.ticks]

    return policy


def group(item: ia.StreamItem, slips: float, number: int) -> list[float]:
    """Plays a group of episodes and returns their wins. The game has the randomness of the witness, so that the actions
    of the witness can win games of chance.
    """
    seed, policy = str(item.witness.seed), learner(item, slips)
    return [float(play(item, seed, policy, f"{number} {episode}").outcome == "won") for episode in range(GROUP)]


def useful_groups(
    levels: ia.Curriculum, curriculum: ia.Curriculum | None, slips: dict[str, float], lessons: int
) -> list[bool]:
    """Plays lessons and returns whether each group is useful. Without a curriculum, lessons are drawn uniformly."""
    draws, found = random.Random("uniform"), list[bool]()
    for number in count():
        if len(found) == lessons:
            break
        if curriculum is None:
            lesson = ia.Lesson(number, draws.choice(sorted(slips)), draws.choice(DIFFICULTIES))
        else:
            lesson = curriculum.draw(number)
        try:
            results = group(levels.item(lesson), slips[lesson.family], number)
        except ia.ArcadeError:
            results = []
        if curriculum is not None:
            curriculum.report(lesson, results)
        if results:
            found.append(len(set(results)) > 1)
    return found


def main() -> None:
    """Prints the shares of useful groups, and the mean rewards."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--games", default=GAMES, help="the games, separated by commas")
    parser.add_argument("--lessons", type=int, default=300, help="the number of groups with each sampler; default: 300")
    asked = parser.parse_args()
    games = [ia.load(game) for game in sorted(asked.games.split(","))]
    slips = {game.id: SLIPS[at % len(SLIPS)] for at, game in enumerate(games)}
    levels, curriculum = (
        ia.Curriculum("curriculum", games, difficulties=DIFFICULTIES, num_levels=LEVELS) for _ in range(2)
    )
    for name, sampler in (("uniform", None), ("curriculum", curriculum)):
        found = useful_groups(levels, sampler, slips, asked.lessons)
        third = len(found) // 3
        print(f"{name}: {mean(found):.2f} of {len(found)} groups are useful, {mean(found[third:]):.2f} after a third")
    for game, own in slips.items():
        print(f"  {game}: {own:.0%} random keys, weight {curriculum.weight(game):.2f}")

    numbers = [(game, difficulty, at) for game in slips for difficulty in DIFFICULTIES for at in range(LEVELS)]
    items = list[ia.StreamItem]()
    for game, difficulty, at in numbers:
        try:
            items.append(levels.item(ia.Lesson(at, game, difficulty)))
        except ia.ArcadeError:
            continue
    weights = ia.RewardWeights()
    best = mean(weights.reward(item.witness.replay(), item.witness) for item in items)
    print(f"mean reward of the witness on {len(items)} levels: {best:.3f}; relative to it:")
    policies: dict[str, Policy] = {
        "nothing": lambda state, draws, actions: "nil",
        "random keys": lambda state, draws, actions: draws.choice(actions),
        "circles": lambda state, draws, actions: ("up", "right", "down", "left")[state.ticks % 4],
    }
    for name, policy in policies.items():
        runs = [(item, f"{run}") for item in items for run in range(GROUP)]
        earned = mean(weights.reward(play(item, run, policy, run), item.witness) for item, run in runs)
        print(f"  {name}: {earned / best:.3f}")
    stopped = list[float]()
    for item in items:
        state = item.level.start(item.witness.seed)
        state.play(item.witness.actions[:-1])
        stopped.append(weights.reward(state, item.witness))
    print(f"  the witness without its last action: {mean(stopped) / best:.3f}")


if __name__ == "__main__":
    main()
