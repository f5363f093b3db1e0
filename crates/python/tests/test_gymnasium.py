"""Tests of the Gymnasium environments."""

from __future__ import annotations

import copy
import pickle
import subprocess
import sys
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode, SyncVectorEnv

import infinite_arcade as ia
import infinite_arcade.gymnasium as arcade

ID = arcade.ENV_ID


@pytest.mark.filterwarnings("ignore:.*render.*")
@pytest.mark.parametrize("observation", ["planes", "symbols", "rgb", "full"])
@pytest.mark.parametrize("game", ["hailglass", "night-mail-sled", "heath-fire"])
def test_the_checker_passes(game: str, observation: str) -> None:
    env = gymnasium.make(ID, game=game, level=0, observation=observation, render_mode="rgb_array")
    check_env(env.unwrapped)
    assert env.unwrapped.action_space.n == len(ia.load(game).actions)


def rollout(env: gymnasium.Env[Any, Any], seed: int, steps: int = 60) -> list[Any]:
    rng = np.random.default_rng(seed)
    history: list[Any] = [env.reset(seed=seed)]
    for _ in range(steps):
        history.append(env.step(rng.integers(env.action_space.n)))
        if history[-1][2] or history[-1][3]:
            history.append(env.reset())
    return history


def same(one: Any, two: Any) -> bool:
    if isinstance(one, np.ndarray):
        return bool(np.array_equal(one, two))
    if isinstance(one, dict):
        return one.keys() == two.keys() and all(same(one[name], two[name]) for name in one)
    if isinstance(one, (tuple, list)):
        return len(one) == len(two) and all(map(same, one, two))
    return bool(one == two)


def test_the_same_seed_gives_the_same_bytes() -> None:
    envs = [gymnasium.make(ID, game="heath-fire", level=1, max_steps=25) for _ in range(2)]
    assert same(rollout(envs[0], 3), rollout(envs[1], 3))
    assert not same(rollout(envs[0], 3), rollout(envs[1], 4))


def test_no_seed_is_dropped() -> None:
    env = gymnasium.make(ID, game="heath-fire", level=0)
    seeds = [env.reset(seed=seed)[1]["seed"] for seed in range(300)]
    seeds += [env.reset()[1]["seed"] for _ in range(300)]
    assert len(set(seeds)) == 600
    vector = gymnasium.make_vec(ID, num_envs=500, game="heath-fire")
    vector.reset(seed=0)
    one = set(vector.unwrapped.seeds)
    vector.reset(seed=1)
    two = set(vector.unwrapped.seeds)
    assert len(one) == len(two) == 500 and not one & two and not one & set(seeds)
    unseeded = [gymnasium.make(ID, game="heath-fire", level=0).reset()[1]["seed"] for _ in range(2)]
    assert unseeded[0] != unseeded[1]


def test_an_episode_can_be_played_again() -> None:
    env = gymnasium.make(ID, game="heath-fire", level=2)
    _, info = env.reset(seed=9)
    actions = [1, 2, 3, 4, 0, 2, 2]
    for action in actions:
        env.step(action)
    base = env.unwrapped
    state = base.game.levels[2].start(info["seed"])
    state.play([base.game.actions[action] for action in actions])
    assert state.state_hash() == base.state.state_hash()
    _, again = env.reset(options={"seed": info["seed"]})
    assert again["seed"] == info["seed"]


def test_episodes_that_are_over_need_a_reset(nut: ia.Game) -> None:
    env = arcade.GameEnv(nut, 0)
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.step(0)
    env.reset(seed=0)
    right = nut.actions.index("right")
    env.step(right)
    _, reward, terminated, truncated, info = env.step(right)
    assert (reward, terminated, truncated, info["outcome"]) == (1.0, True, False, "won")
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.step(right)


def test_episodes_are_truncated(nut: ia.Game) -> None:
    env = arcade.GameEnv(nut, 1, max_steps=2, reward="outcome")
    env.reset(seed=0)
    assert env.step(0)[2:4] == (False, False)
    assert env.step(0)[1:4] == (0.0, False, True)


@pytest.mark.parametrize("mode", list(AutoresetMode))
@pytest.mark.parametrize(("name", "observation"), [("heath-fire", "planes"), ("hailglass", "symbols"), ("great-yawn", "rgb")])
def test_vectors_play_what_single_environments_play(mode: AutoresetMode, name: str, observation: str) -> None:
    """Checks that the vector behaves like Gymnasium's vector of single environments, in every mode and on all levels.
    """
    count, game = 5, ia.load(name)
    make = lambda: arcade.GameEnv(game, observation=observation, max_steps=12)
    single = SyncVectorEnv([make] * count, autoreset_mode=mode)
    vector = gymnasium.make_vec(
        ID, num_envs=count, game=game, observation=observation, max_steps=12, autoreset_mode=mode, threads=2
    )
    assert vector.metadata["autoreset_mode"] is mode
    assert vector.observation_space == single.observation_space
    assert vector.action_space == single.action_space
    seeds = [7, 1, 4, 2**40, 0]
    vector.action_space.seed(0)
    one, two = single.reset(seed=seeds)[0], vector.reset(seed=seeds)[0]
    assert np.array_equal(one, two) and vector.observation_space.contains(two)
    for _ in range(40):
        actions = vector.action_space.sample()
        expected, got = single.step(actions), vector.step(actions)
        for part in range(4):
            assert np.array_equal(expected[part], got[part]), part
        assert expected[1].dtype == got[1].dtype and expected[0].dtype == got[0].dtype
        assert vector.observation_space.contains(got[0])
        over = got[2] | got[3]
        if mode == AutoresetMode.SAME_STEP:
            assert ("final_obs" in expected[4]) == ("final_obs" in got[4])
            for at in np.flatnonzero(over):
                assert np.array_equal(expected[4]["final_obs"][at], got[4]["final_obs"][at])
                assert expected[4]["final_info"]["score"][at] == got[4]["final_info"]["score"][at]
                assert expected[4]["final_info"]["outcome"][at] == got[4]["final_info"]["outcome"][at]
        if mode == AutoresetMode.DISABLED and over.any():
            with pytest.raises(gymnasium.error.ResetNeeded):
                vector.step(actions)
            masks = [over.copy(), over.copy()]
            pair = [env.reset(options={"reset_mask": mask}) for env, mask in zip((single, vector), masks, strict=True)]
            assert np.array_equal(pair[0][0], pair[1][0])


@pytest.mark.parametrize("observation", ["planes", "symbols", "rgb"])
def test_threads_change_nothing(observation: str) -> None:
    def played(threads: int) -> list[Any]:
        envs = arcade.GameVectorEnv("heath-fire", num_envs=300, observation=observation, threads=threads, cell=4)
        rng = np.random.default_rng(5)
        history: list[Any] = [envs.reset(seed=5)[0]]
        for _ in range(15):
            history.append(envs.step(rng.integers(envs.single_action_space.n, size=300))[:4])
        return [*history, envs.hashes, envs.seeds]

    one = played(1)
    assert same(one, played(2)) and same(one, played(3))


@pytest.mark.parametrize("name", sorted(ia.corpus()))
def test_boards_are_kept_up_to_date(name: str) -> None:
    """Checks that boards drawn over earlier boards equal boards drawn from scratch, in environments of all levels."""
    envs = arcade.GameVectorEnv(name, num_envs=10, autoreset_mode=AutoresetMode.SAME_STEP, threads=1, copy=False)
    rng = np.random.default_rng(1)
    observations, _ = envs.reset(seed=1)
    assert not observations.flags.writeable
    for _ in range(120):
        observations = envs.step(rng.integers(envs.single_action_space.n, size=10))[0]
        at = int(rng.integers(10))
        planes = envs.state(at).planes()
        _, rows, columns = planes.shape
        assert np.array_equal(observations[at, :, :rows, :columns], planes)
        assert not observations[at, :, rows:].any() and not observations[at, :, :, columns:].any()


def test_symbols_are_the_text() -> None:
    game = ia.load("hailglass")
    env = arcade.GameEnv(game, 0, observation="symbols", size=game.levels[0].size)
    board, _ = env.reset(seed=0)
    lines = ["".join(map(chr, row)) for row in board]
    assert "\n".join(lines) + "\n" == env.state.text()


def test_pictures_are_those_of_the_renderer() -> None:
    game = ia.load("hailglass")
    env = arcade.GameEnv(game, 0, observation="rgb", cell=8, size=game.levels[0].size)
    board, _ = env.reset(seed=0)
    assert np.array_equal(board, env.state.rgb(8))


def test_a_vector_takes_episodes_of_their_own() -> None:
    game = ia.load("heath-fire")
    seeds = [ia.seed_from_text(f"episode {at}") for at in range(3)]
    envs = arcade.GameVectorEnv(game, 0, num_envs=3)
    envs.reset(seed=1, options={"seed": seeds})
    assert envs.seeds == seeds
    envs.step(np.array([1, 2, 3]))
    for at, action in enumerate([1, 2, 3]):
        state = game.levels[0].start(seeds[at])
        state.step(game.actions[action])
        assert envs.hashes[at] == state.state_hash()


def test_wrong_arguments_are_refused(nut: ia.Game) -> None:
    for wrong in (
        {"max_steps": -1}, {"num_envs": 0}, {"threads": -1}, {"size": (2, 1)}, {"size": (0, 1)}, {"level": []}
    ):
        with pytest.raises(ValueError):
            arcade.GameVectorEnv(nut, **wrong)
    for wrong in ({"observation": "smell"}, {"reward": "fun"}, {"level": 7}, {"cell": 1, "observation": "rgb"}, {"max_steps": 0}):
        with pytest.raises(ValueError):
            arcade.GameEnv(nut, **wrong)
    envs = arcade.GameVectorEnv(nut, num_envs=3)
    with pytest.raises(gymnasium.error.ResetNeeded):
        envs.step(np.zeros(3, np.int64))
    envs.reset(seed=0)
    for actions in (np.zeros(2, np.int64), np.array([0, 0, 99]), np.zeros((3, 1), np.int64), np.array([0, 1.7, 0])):
        with pytest.raises(ValueError):
            envs.step(actions)
    env = arcade.GameEnv(nut)
    env.reset(seed=0)
    with pytest.raises(TypeError):
        env.step(1.7)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="reset_mask"):
        envs.reset(options={"reset_mask": np.zeros(3, np.bool_)})


def test_every_level_is_played() -> None:
    env = gymnasium.make(ID, game="hailglass")
    played = [env.reset(seed=0)[1]["level"], *(env.reset()[1]["level"] for _ in range(60))]
    assert set(played) == {level.number for level in ia.load("hailglass").levels}
    game = ia.load("quiet-jars")
    for text in [level.text for level in game.levels] * 7:
        game.levels.append(game.level(text))
    assert len(game.levels) >= 32
    envs = arcade.GameVectorEnv(game, num_envs=4, max_steps=5)
    envs.reset(seed=0)
    seen = set[int](envs.levels)
    for _ in range(400):
        envs.step(np.zeros(4, np.int64))
        seen |= set(envs.levels)
    assert seen == set(range(len(game.levels)))


def test_an_episode_of_one_level_is_that_of_many() -> None:
    """Checks that the level is drawn from the episode's seed, and that the episode's randomness does not depend on the
    draw.
    """
    several = arcade.GameEnv("heath-fire")
    _, info = several.reset(seed=11)
    one = arcade.GameEnv("heath-fire", info["level"])
    assert one.reset(seed=11)[1] == info
    assert one.state.state_hash() == several.state.state_hash()


def test_levels_are_selected_by_number() -> None:
    env = arcade.GameEnv("hailglass", [2, 4])
    for level in (4, 2, np.int64(4)):
        assert env.reset(options={"level": level})[1]["level"] == level
    with pytest.raises(ValueError, match=r"has the levels \[2, 4\], not 1"):
        env.reset(options={"level": 1})
    envs = arcade.GameVectorEnv("hailglass", np.arange(5), num_envs=3)
    envs.reset(seed=0, options={"level": [3, 3, 1]})
    assert envs.levels == [3, 3, 1]
    envs.reset(options={"level": 2})
    assert envs.levels == [2, 2, 2]
    assert arcade.GameEnv("hailglass", np.int64(1)).reset()[1]["level"] == 1
    with pytest.raises(ValueError, match=r"hailglass has the levels \[0, 1, 2, 3, 4\], not \[7\]"):
        arcade.GameEnv("hailglass", [0, 7])


def test_unknown_options_are_refused() -> None:
    with pytest.raises(ValueError, match="there is no option `levle`; did you mean `level`"):
        arcade.GameEnv("hailglass").reset(options={"levle": 1})
    with pytest.raises(ValueError, match="there is no option `mask`"):
        arcade.GameVectorEnv("hailglass").reset(options={"mask": 1})


def test_the_board_has_the_size_of_the_game() -> None:
    spaces = {
        str(maker(ID, game="hailglass", **selected).unwrapped.observation_space.shape[-3:])
        for maker in (gymnasium.make, lambda id, **more: gymnasium.make_vec(id, num_envs=1, **more))
        for selected in ({}, {"level": 0}, {"level": [0, 1]}, {"level": [4]})
    }
    assert len(spaces) == 1
    env = arcade.GameEnv("hailglass", 0, size=(30, 20))
    board, _ = env.reset(seed=0)
    assert board.shape[1:] == (20, 30)
    assert not board[:, :, env.game.levels[0].size[0] :].any()


@pytest.mark.parametrize("name", sorted(ia.corpus()))
def test_full_observations_show_what_planes_hide(name: str) -> None:
    envs = arcade.GameVectorEnv(name, num_envs=3, observation="full", max_steps=40, autoreset_mode=AutoresetMode.SAME_STEP)
    single = arcade.GameEnv(name, observation="full", max_steps=40)
    assert envs.status_names == single.status_names
    names, limit = envs.status_names, envs.game.time_limit
    rng = np.random.default_rng(2)
    observed, _ = envs.reset(seed=2)
    for _ in range(60):
        assert envs.observation_space.contains(observed)
        for at in range(3):
            seen = envs.state(at).observe()
            shown = dict(zip(names, observed["status"][at].tolist(), strict=True))
            _, _, _, facing, health = seen["avatar"] or (None, 0, 0, (0, 0), 0)
            held = dict(seen["resources"])
            assert (shown.pop("facing_x"), shown.pop("facing_y"), shown.pop("health")) == pytest.approx(
                (*facing, health)
            )
            assert shown.pop("ticks_left") == min(limit, 40) - seen["ticks"]
            assert {name.removeprefix("held_"): amount for name, amount in shown.items() if amount} == {
                name: amount for name, amount in held.items() if amount
            }
        observed, _, terminated, truncated, info = envs.step(rng.integers(envs.single_action_space.n, size=3))
        for at in np.flatnonzero(terminated | truncated):
            assert envs.single_observation_space.contains(info["final_obs"][at])


@pytest.mark.parametrize("observation", ["planes", "symbols", "rgb", "full"])
def test_environments_are_pickled(observation: str) -> None:
    env = gymnasium.make(ID, game=ia.load("heath-fire"), observation=observation)
    env.reset(seed=4)
    for action in (1, 2, 3, 0, 1):
        env.step(action)
    copies = [copy.deepcopy(env), pickle.loads(pickle.dumps(env)), gymnasium.make(env.spec)]
    copies[2].reset(seed=4)
    for action in (1, 2, 3, 0, 1):
        copies[2].step(action)
    histories = [rollout_on(one) for one in (env, *copies)]
    assert all(same(histories[0], history) for history in histories[1:])


def rollout_on(env: gymnasium.Env[Any, Any]) -> list[Any]:
    history = list[Any]()
    for tick in range(80):
        history.append(env.step(tick % 5))
        if history[-1][2] or history[-1][3]:
            history.append(env.reset())
    return [*history, env.unwrapped.state.state_hash()]


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_vectors_are_pickled(mode: AutoresetMode) -> None:
    envs = arcade.GameVectorEnv("heath-fire", num_envs=6, max_steps=9, observation="full", autoreset_mode=mode)
    envs.reset(seed=3)
    played = 8 if mode == AutoresetMode.DISABLED else 23
    for tick in range(played):
        envs.step(np.full(6, tick % 4))
    other = pickle.loads(pickle.dumps(envs))
    assert (other.hashes, other.seeds, other.levels) == (envs.hashes, envs.seeds, envs.levels)
    for tick in range(30):
        if mode == AutoresetMode.DISABLED:
            one, two = envs.reset(), other.reset()
        else:
            one, two = envs.step(np.full(6, tick % 4)), other.step(np.full(6, tick % 4))
        assert same(one[0], two[0]) and same(one[1:4], two[1:4])
        assert (other.hashes, other.seeds) == (envs.hashes, envs.seeds)


def test_vectors_render_boards_of_one_size() -> None:
    envs = gymnasium.make_vec(ID, num_envs=6, game="hailglass", render_mode="rgb_array")
    envs.reset(seed=0)
    frames = np.array(envs.render())
    assert frames.shape == (6, envs.single_observation_space.shape[1] * 8, envs.single_observation_space.shape[2] * 8, 3)


def test_importing_the_package_registers_the_environments() -> None:
    script = "import infinite_arcade, gymnasium; print(gymnasium.make('InfiniteArcade/Hailglass-v0').unwrapped.game.id)"
    assert subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout == "hailglass\n"
    script = "import gymnasium; gymnasium.make_vec('infinite_arcade:InfiniteArcade/Game-v0', game='hailglass')"
    subprocess.run([sys.executable, "-c", script], check=True)


def test_seeds_are_derived_as_before() -> None:
    """Checks that recorded seeds give the same episodes as before, whatever levels the environment has."""
    for levels in (None, 0):
        env = arcade.GameEnv("heath-fire", levels)
        found = [env.reset(seed=7)[1]["seed"], env.reset()[1]["seed"]]
        assert found == [ia.seed_child("7", "episode", at) for at in range(2)]
        envs = arcade.GameVectorEnv("heath-fire", levels, num_envs=3)
        envs.reset(seed=7)
        lanes = [ia.seed_child("7", "lane", at) for at in range(3)]
        assert envs.seeds == [ia.seed_child(lane, "episode", 0) for lane in lanes]
