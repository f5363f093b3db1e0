"""Tests of games, states, planners, judges, generators and snapshots."""

from __future__ import annotations

import copy
import json
import pickle
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import infinite_arcade as ia

from conftest import NUT

BROKEN = "BasicGame\n    SpriteSet\n        a > Door\n        b > Foo\n    LevelMapping\n        a > c\n"


def test_games_describe_themselves(nut: ia.Game) -> None:
    assert nut.actions == ["nil", "up", "left", "down", "right"]
    assert nut.types == ["nut", "squirrel"] or set(nut.types) >= {"nut", "squirrel"}
    assert nut.is_deterministic and nut.time_limit == 21
    assert "nut" in nut.describe()
    assert nut.facts()["digest"] == nut.digest
    assert [level.size for level in nut.levels] == [(3, 1), (4, 1)]


def test_problems_are_exceptions_with_places() -> None:
    with pytest.raises(ia.VgdlError) as caught:
        ia.Game(BROKEN, name="broken.vgdl")
    codes = {problem["code"] for problem in caught.value.diagnostics}
    assert "unknown-class" in codes
    place = next(problem for problem in caught.value.diagnostics if problem["code"] == "unknown-class")
    assert (place["line"], place["column"], place["severity"]) == (4, 13, "error")
    assert BROKEN[place["start"] : place["end"]] == "Foo"


def test_problems_print_as_on_the_command_line(arcade: Path, tmp_path: Path) -> None:
    path = tmp_path / "broken.vgdl"
    path.write_text(BROKEN)
    with pytest.raises(ia.VgdlError) as caught:
        ia.load(path)
    said = subprocess.run([arcade, "describe", str(path)], capture_output=True, text=True, check=False)
    assert said.returncode == 2
    assert str(caught.value).splitlines()[1:] == said.stderr.strip().splitlines()[1:]
    assert str(caught.value).splitlines()[0] in said.stderr


def test_problems_of_levels_name_the_level(nut: ia.Game) -> None:
    with pytest.raises(ia.VgdlError, match="lvl2.txt"):
        nut.level("S x")
    assert len(nut.levels) == 2


def test_states_step_copy_and_hash(nut: ia.Game) -> None:
    state = nut.levels[0].start("seed")
    copy = state.copy()
    assert state.step("right") == "ongoing" and state.ticks == 1 and copy.ticks == 0
    assert state.state_hash() != copy.state_hash()
    hashes = copy.play(["right", "right", "right"])
    assert hashes[0] == state.state_hash() and len(hashes) == 2, "it ends with the episode"
    assert (copy.outcome, copy.score, copy.is_over) == ("won", 1.0, True)
    with pytest.raises(ValueError, match="there is no action `jump`"):
        state.step("jump")


def test_seeds_are_texts_or_digits(nut: ia.Game) -> None:
    digits = ia.seed_from_text("a")
    level = nut.levels[0]
    assert level.start("a").state_hash() == level.start(digits).state_hash()
    assert ia.seed_child("a", "level", 0) != ia.seed_child("a", "level", 1)


@pytest.mark.parametrize("name", sorted(ia.corpus()))
def test_planes_show_what_is_observed(name: str) -> None:
    game = ia.corpus()[name].compile()
    types = {stype: at for at, stype in enumerate(game.types)}
    state = game.levels[0].start(name)
    for tick in range(8):
        planes, seen = state.planes(), state.observe()
        expected = np.zeros_like(planes)
        for row, cells in enumerate(seen["cells"]):
            for column, names in enumerate(cells):
                for stype in names:
                    expected[types[stype], row, column] = 1
        assert np.array_equal(planes, expected)
        state.step(game.actions[tick % len(game.actions)])


def test_boards_are_pictures(nut: ia.Game) -> None:
    state = nut.levels[0].start("seed")
    assert state.rgb(8).shape == (8, 24, 3)
    assert state.png().startswith(b"\x89PNG") and state.svg().startswith("<svg")
    assert state.png() == nut.levels[0].start("seed").png()
    assert "data:image/png;base64," in state._repr_html_() and "<pre>" in nut._repr_html_()
    with pytest.raises(ValueError, match="cell"):
        state.rgb(1)


def test_episodes_are_animations(nut: ia.Game) -> None:
    episode = ia.Episode(nut.levels[0], "seed", ("right", "right"))
    assert episode.replay().outcome == "won"
    assert episode.gif().startswith(b"GIF89a") and episode.gif() == episode.gif()
    assert "data:image/gif;base64," in episode._repr_html_()
    with pytest.raises(ValueError, match="jump"):
        ia.Episode(nut.levels[0], "seed", ("jump",)).gif()


def test_planners_plan_alike_from_alike_seeds(nut: ia.Game) -> None:
    def won(name: str) -> list[str]:
        state, actions = ia.play(nut.levels[1], ia.Planner(name, seed="p"), seed="s")
        assert state.outcome == "won"
        return actions

    assert won("mcts:200") == won("mcts:200")
    with pytest.raises(ValueError, match="no-such"):
        ia.Planner("no-such", seed="p")


def test_levels_are_judged(nut: ia.Game) -> None:
    report = ia.validate(nut.levels[0], budget=20_000)
    found = {judgement["criterion"]: judgement for judgement in report["judgements"]}
    assert found["winnable"]["verdict"] == "pass"
    assert not report["passes"], "two keys in a row win it"


def test_levels_are_made_alike() -> None:
    game = ia.load("hailglass")
    one, two = (ia.generate_levels(game, method="constructive", count=2, seed="t") for _ in range(2))
    assert [level["text"] for level in one] == [level["text"] for level in two]
    assert len(one) == 2
    game.level(one[0]["text"])


def test_what_is_no_snapshot_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ia.ArcadeError):
        ia.open_snapshot(tmp_path)


def test_snapshots_open_and_verify(tiny: Path, tmp_path: Path) -> None:
    out = shutil.copytree(tiny, tmp_path / "tiny")
    root = (Path(__file__).parents[3] / "crates/cli/tests/tiny.root").read_text().split()
    release = ia.open_snapshot(out)
    assert release.root in root
    assert ia.verify(out)["problems"] == []
    game = next(iter(release.games()))
    compiled = game.compile()
    witness = game.witness(0)
    assert witness is not None
    state = compiled.levels[0].start(witness["seed"])
    assert state.play(witness["actions"]) == witness["hashes"]
    assert (state.outcome, state.score) == ("won", witness["score"])
    file = out / "games" / game.id / "lvl0.txt"
    file.write_text(file.read_text().replace(".", " ", 1) + " ")
    with pytest.raises(ia.ArcadeError, match="lvl0.txt"):
        ia.open_snapshot(out)
    assert json.dumps(ia.verify(out)["problems"]) != "[]"


SEALED = """name = "sealed"
description = "x"
commitment = "{commitment}"
[generated]
games = 1
levels = 1
kinds = ["survival"]
[criteria]
decision = 100
budget = 80000
"""


def test_sealed_releases_open_without_their_wins(arcade: Path, tmp_path: Path) -> None:
    recipe = tmp_path / "sealed.toml"

    def release(*more: str) -> str:
        command = [arcade, "--json", "release", recipe, *more]
        return subprocess.run(command, check=True, cwd=tmp_path, stdout=subprocess.PIPE, text=True).stdout

    recipe.write_text(SEALED.format(commitment="0" * 64))
    commitment = json.loads(release("--commit"))["commitment"]
    recipe.write_text(SEALED.format(commitment=commitment))
    release("--secret", "sealed.secret.json", "--out", "out")
    public = tmp_path / "out/public"
    (game,) = ia.open_snapshot(public).games()
    assert game.witness(0) is None
    assert game.compile().levels[0].start("s").outcome == "ongoing"
    report = ia.verify(public)
    assert (report["problems"], report["witnesses"], report["is_secret"]) == ([], "held", True)
    with pytest.raises(ia.ArcadeError, match=r"has no MANIFEST\.json: pass a snapshot folder"):
        ia.open_snapshot(tmp_path / "out/held")


def test_mints_are_those_of_the_command_line(tiny: Path, tmp_path: Path) -> None:
    def files_of(folder: Path) -> dict[str, bytes]:
        files = (path for path in sorted(folder.rglob("*")) if path.is_file())
        return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}

    parts = [ia.mint("tiny", tmp_path / f"part{number}", shard=f"{number}/2", jobs=2) for number in (1, 2)]
    assert [part["shard"] for part in parts] == ["1/2", "2/2"]
    merged = ia.merge([tmp_path / "part1", tmp_path / "part2"], tmp_path / "merged")
    assert files_of(tmp_path / "merged") == files_of(tiny)
    assert merged["root"] == ia.open_snapshot(tiny).root
    again = ia.mint("tiny", tmp_path / "merged", resume=True)
    assert again["complete"]
    with pytest.raises(ia.ArcadeError, match="not an empty folder"):
        ia.mint("tiny", tmp_path / "merged")
    with pytest.raises(FileNotFoundError, match="no recipe named `tinny`"):
        ia.mint("tinny", tmp_path / "other")
    with pytest.raises(ValueError, match="expected K/N"):
        ia.mint("tiny", tmp_path / "other", shard="3/2")


def test_archives_verify_and_are_unpacked_to_be_opened(arcade: Path, tiny: Path, tmp_path: Path) -> None:
    archive = tmp_path / "tiny.tar.zst"
    subprocess.run([arcade, "export", tiny, "--format", "archive", "--out", archive], check=True)
    assert ia.verify(archive) == ia.verify(tiny) | {"papers": 0}, "papers are published beside an archive"
    with pytest.raises(ia.ArcadeError, match="unpack an archive first"):
        ia.open_snapshot(archive)


def test_what_is_no_game_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="did you mean the corpus game `hailglass`"):
        ia.load("hailglas")
    file = tmp_path / "game.vgdl"
    file.write_bytes(b"BasicGame\xff")
    with pytest.raises(ia.ArcadeError, match=r"game\.vgdl: not a text file \(byte 9 is not UTF-8\); save it"):
        ia.load(file)


def same_future(one: ia.State, two: ia.State, game: ia.Game) -> bool:
    actions = [game.actions[tick % len(game.actions)] for tick in range(12)]
    return one.state_hash() == two.state_hash() and one.copy().play(actions) == two.copy().play(actions)


@pytest.mark.parametrize("name", ["heath-fire", "hailglass", "diving-bell"])
def test_games_levels_and_states_are_pickled(name: str) -> None:
    game = ia.load(name)
    for other in (pickle.loads(pickle.dumps(game)), copy.deepcopy(game)):
        assert (other.id, other.title, other.digest, other.name) == (game.id, game.title, game.digest, game.name)
        assert [level.digest for level in other.levels] == [level.digest for level in game.levels]
        other.levels.clear()
    assert game.levels
    level = pickle.loads(pickle.dumps(game.levels[2]))
    assert (level.number, level.name, level.digest) == (2, game.levels[2].name, game.levels[2].digest)
    state = game.levels[2].start(5)
    state.play([game.actions[tick % len(game.actions)] for tick in range(9)])
    forked = state.fork("another future")
    forked.play([game.actions[-1]] * 3)
    for one in (state, forked, game.levels[0].start("x")):
        assert same_future(one, pickle.loads(pickle.dumps(one)), game)
        assert same_future(one, copy.deepcopy(one), game)
    over = game.levels[0].start("over")
    while not over.is_over:
        over.step("nil")
    over.step("nil")
    assert pickle.loads(pickle.dumps(over)).state_hash() == over.state_hash()
    episode = ia.Episode(level, 7, tuple(game.actions))
    assert pickle.loads(pickle.dumps(episode)).replay().state_hash() == episode.replay().state_hash()


def test_games_as_reference_are_pickled() -> None:
    game = ia.Game(NUT, ["S n"], id="nut", as_reference=True)
    assert pickle.loads(pickle.dumps(game))._native.as_reference
    assert pickle.loads(pickle.dumps(game.levels[0]))._native.game.as_reference


@pytest.mark.parametrize("name", ia.PLANNERS)
def test_planners_are_pickled(name: str) -> None:
    game = ia.load("heath-fire")
    state, planner = game.levels[0].start("s"), ia.Planner(f"{name}:60", seed=1)
    for _ in range(3):
        state.step(planner.act(state))
    copies = [pickle.loads(pickle.dumps(planner)), copy.deepcopy(planner)]
    for _ in range(4):
        plan = planner.plan(state, 2)
        assert [other.plan(state, 2) for other in copies] == [plan, plan]
        state.step(plan[0][0])


def test_an_integer_is_a_seed(nut: ia.Game) -> None:
    game = ia.load("heath-fire")
    level = game.levels[0]
    assert level.start(7).state_hash() == level.start("7").state_hash() == level.start(np.int64(7)).state_hash()
    assert level.start(7).fork(8).state_hash() == level.start("7").fork("8").state_hash()
    assert ia.validate(nut.levels[0], budget=500, seed=1) == ia.validate(nut.levels[0], budget=500, seed="1")
    for wrong in (1.5, None, True):
        with pytest.raises(TypeError, match="`seed` must be a text or an integer, not"):
            level.start(wrong)  # type: ignore[arg-type]


def test_wrong_numbers_are_named(nut: ia.Game) -> None:
    with pytest.raises(ValueError, match="`budget` must be at least 1, not -5"):
        ia.validate(nut.levels[0], budget=-5)
    with pytest.raises(ValueError, match="`levels` must be at least 1, not 0"):
        ia.generate_games(levels=0)
    with pytest.raises(TypeError, match="`size` must be a pair of columns and rows, not 9"):
        ia.generate_levels(nut, size=9)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="the planner mcts:0 needs a budget of at least 1"):
        ia.Planner("mcts:0", seed="s")
    with pytest.raises(TypeError, match="`game` must be one game, by path or name, not list"):
        ia.load(["hailglass", "heath-fire"])  # type: ignore[arg-type]


def test_a_checked_level_does_not_change_the_game(nut: ia.Game) -> None:
    level = nut.level("S   n")
    assert level.number == 2 and len(nut.levels) == 2
    nut.levels.append(level)
    assert [found.number for found in nut.levels] == [0, 1, 2]


def test_games_are_saved(nut: ia.Game, tmp_path: Path) -> None:
    nut.save(tmp_path / "nut")
    again = ia.load(tmp_path / "nut")
    assert (again.id, again.digest) == ("nut", nut.digest)
    assert [level.digest for level in again.levels] == [level.digest for level in nut.levels]
    with pytest.raises(FileExistsError, match="not empty"):
        nut.save(tmp_path / "nut")


def test_games_without_a_name_have_ids_of_their_own() -> None:
    one, two = ia.Game(NUT), ia.Game(NUT.replace("limit=20", "limit=30"))
    assert one.id == one.title == f"game-{one.digest[:8]}" and one.id != two.id


def test_levels_are_verified_on_request() -> None:
    drawn = ia.generate_levels("hailglass", method="constructive", count=3, seed="v")
    assert [(level["verified"], level["witness"]) for level in drawn] == [(False, None)] * 3
    game = ia.load("hailglass")
    for made in ia.generate_levels(game, method="constructive", count=2, seed="v", verified=True):
        assert made["verified"]
        state = game.level(made["text"]).start(made["witness"]["seed"])
        state.play(made["witness"]["actions"])
        assert state.outcome == "won"


INTERRUPTED = """
import os, signal, threading
import infinite_arcade as ia
signal.signal(signal.SIGINT, signal.default_int_handler)  # A shell in the background ignores the signal.
threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT)).start()
try:
    {call}
except KeyboardInterrupt:
    print("interrupted")
"""


@pytest.mark.parametrize(
    "call",
    [
        "ia.generate_games(count=50, levels=5)",
        "ia.generate_levels('hailglass', method='search', count=500)",
        "ia.validate(ia.load('heath-fire').levels[4], budget=1_000_000_000)",
        "ia.mint('2026-12', 'out')",
        "ia.Planner('mcts', seed=0, budget=100_000_000).act(ia.load('heath-fire').levels[4].start(0))",
    ],
)
def test_long_calls_end_soon_after_an_interrupt(call: str, tmp_path: Path) -> None:
    command = [sys.executable, "-c", INTERRUPTED.format(call=call)]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout == "interrupted\n"
