"""Tests of games, states, planners, judges, generators and snapshots."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import infinite_arcade as ia

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
