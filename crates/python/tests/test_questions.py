"""Tests of questions with exact answers."""

from __future__ import annotations

from collections import Counter

import pytest

import infinite_arcade as ia
from infinite_arcade.questions import KINDS, Questions, is_right


def test_questions_are_balanced_and_checked() -> None:
    games = [entry.compile() for name, entry in ia.corpus().items() if name in ("button-mice", "quiet-jars")]
    drawn = Questions(games, count=8, kinds=["next-board", "board-choice"], seed="python")
    assert len(drawn) == 16
    assert [row["id"] for row in drawn.rows] == [entry["metadata"]["id"] for entry in drawn]
    for entry in drawn:
        assert drawn.score_answer(f"ANSWER: {entry['answer']}", entry) == 1
        assert drawn.score_answer("ANSWER: E", entry) == drawn.score_answer(None, entry) == 0
    letters = Counter(row["answer"] for row in drawn.rows if row["kind"] == "board-choice")
    assert letters == dict.fromkeys("ABCD", 2)
    again = Questions(games, count=8, kinds=["next-board", "board-choice"], seed="python")
    assert again.rows == drawn.rows


def test_kinds_are_named() -> None:
    assert "winnable" in KINDS
    assert is_right({"kind": "winnable", "options": [], "answer": "no"}, "<think>yes</think>\n**ANSWER:** no")
    with pytest.raises(ValueError, match="is not a kind of question"):
        Questions([], kinds=["riddle"])
