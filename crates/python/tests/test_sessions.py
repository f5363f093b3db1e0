"""Tests of episodes that are played through text."""

from __future__ import annotations

from pathlib import Path

import pytest

import infinite_arcade as ia
from infinite_arcade.sessions import Shelf, TextSession, games_of, replay_log, section


def test_an_episode_is_played_and_its_log_replayed(nut: ia.Game) -> None:
    session = TextSession(nut, nut.levels[0], seed="a")
    assert "## Rules" in session.rules and "## Answer" not in session.rules
    assert section(session.observation, "Board") == "@.n"
    assert "right" in session.actions and session.actions[0] == "nil"
    assert "right was played" in section(session.act("right"), "Last action")
    session.act("right")
    assert (session.outcome, session.is_over, session.score) == ("won", True, 1.0)
    assert session.observation.startswith("## End\nYou won after 2 ticks, with score 1.")
    found = replay_log(session.facts, session.log(), level=0, run=0)
    assert (found["outcome"], found["hash"]) == ("won", session.state_hash())
    with pytest.raises(ValueError, match="the episode is over"):
        session.act("right")


def test_invalid_actions_play_nothing(nut: ia.Game) -> None:
    session = TextSession(nut, nut.levels[1], seed="a")
    with pytest.raises(ValueError, match="there is no action `rigth` now; did you mean `right`"):
        session.act("rigth")
    with pytest.raises(ValueError, match="there is no action `jump`"):
        session.play(["right", "jump"])
    assert session.history == ["right"]


def test_the_step_limit_ends_an_episode(nut: ia.Game) -> None:
    session = TextSession(nut, nut.levels[0], max_steps=1)
    assert "You did not win" in session.act("nil") and session.is_over and session.actions == []
    assert '"event":"end"' in session.log()


def test_an_unfinished_episode_leaves_a_log(nut: ia.Game) -> None:
    session = TextSession(nut, nut.levels[0])
    session.act("nil")
    found = replay_log(session.facts, session.log(), level=0, run=0)
    assert (found["actions"], found["ended"]) == (["nil"], False)


def test_a_shelf_finds_and_draws_levels() -> None:
    shelf = Shelf("hailglass", levels=[1, 3])
    assert [shelf[at][1].number for at in range(len(shelf))] == [1, 3]
    assert shelf.find(level=3)[1].number == 3 and shelf.find("hailglass")[1].number == 1
    assert shelf.draw(7)[1].digest == shelf.draw("7")[1].digest
    with pytest.raises(ValueError, match="there is no level 2; the levels are 1, 3"):
        shelf.find(level=2)
    with pytest.raises(ValueError, match="there is no game `nope` in this session"):
        shelf.find("nope")
    with pytest.raises(IndexError, match="the indices are 0 to 1"):
        shelf[2]


def test_a_shelf_of_a_stream() -> None:
    stream = ia.stream("lessons", ["hailglass"], start_level=3, num_levels=2)
    shelf = Shelf(stream)
    assert len(shelf) == 2 and shelf.find()[1].number == 3 and shelf.find(level=4)[1].number == 4
    assert shelf[1][1].digest == stream[1].level.digest
    with pytest.raises(ValueError, match="the levels are 3 to 4"):
        shelf.find(level=5)
    game, level = shelf[0]
    session = TextSession(game, level, seed="a")
    assert "## Board" in session.observation


def test_sources(tmp_path: Path, nut: ia.Game) -> None:
    nut.save(tmp_path / "nut")
    assert [game.id for game in games_of(tmp_path / "nut")] == ["nut"]
    assert [game.id for game in games_of("corpus", ["hailglass"])] == ["hailglass"]
    with pytest.raises(ValueError, match="there is no game `nope` in the corpus"):
        games_of("corpus", ["nope"])
    with pytest.raises(FileNotFoundError, match="did you mean the corpus game `hailglass`"):
        games_of("hailgass")


def test_a_witness_wins_through_text() -> None:
    item = ia.stream("lessons", ["quiet-jars"])[0]
    game = item.alone()
    assert game.is_deterministic
    session = TextSession(game, game.levels[0])
    session.play(item.witness.actions)
    assert (session.outcome, session.history) == ("won", list(item.witness.actions))


def test_the_openenv_package_has_the_version_of_the_suite() -> None:
    folder = Path(__file__).parents[1] / "infinite_arcade_openenv"
    for file, line in [("openenv.yaml", f"version: {ia.__version__}"), ("pyproject.toml", f'version = "{ia.__version__}"')]:
        assert line in (folder / file).read_text("utf-8").splitlines()
