"""Questions about levels, with exact answers.

>>> import infinite_arcade as ia
>>> from infinite_arcade.questions import Questions
>>> drawn = Questions([ia.load("quiet-jars")], count=1, kinds=["next-board"])
>>> drawn.score_answer(drawn[0]["answer"], drawn[0])
1.0
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from . import _native
from .games import Game

__all__ = ["KINDS", "Questions", "is_right"]

#: The kinds of questions (``arcade docs questions``).
KINDS: tuple[str, ...] = tuple(_native.question_kinds())


def is_right(question: Mapping[str, Any], text: str) -> bool:
    """Returns True if a text states the right answer to a question.

    Reasoning is ignored, and several answer formats are accepted.

    Args:
        question: a row of the dataset, with ``kind``, ``options`` and ``answer``.
        text: the answer of a model.
    """
    return _native.is_right_answer(question["kind"], len(question["options"]), question["answer"], text)


class Questions:
    """A sequence of questions, in the style of a reasoning-gym dataset: an entry has ``question``, ``answer`` and
    ``metadata``, and :meth:`score_answer` scores an answer to it.

    The same games and arguments give the same questions. There are fewer questions if the levels do not provide enough.

    Args:
        games: the games from whose levels the questions are drawn.
        count: the number of questions of each kind.
        kinds: the kinds to draw, from :data:`KINDS`; by default all kinds.
        seed: the text from which the questions are derived.
    """

    def __init__(
        self,
        games: Iterable[Game],
        *,
        count: int = 100,
        kinds: Sequence[str] | None = None,
        seed: str = "questions",
    ) -> None:
        texts = [
            (game._native, game.id, [(level.number, level.text, level.optimal_ticks) for level in game.levels])
            for game in games
        ]
        wanted = None if kinds is None else list(kinds)
        drawn = _native.draw_questions(texts, kinds=wanted, count=count, seed=seed)
        #: The questions as rows of the dataset that ``arcade export --format questions`` writes.
        self.rows: list[dict[str, Any]] = [json.loads(row) for row in drawn]

    def __len__(self) -> int:
        return len(self.rows)

    def __getitem__(self, index: int) -> dict[str, Any]:
        row = self.rows[index]
        return {"question": row["prompt"], "answer": row["answer"], "metadata": row}

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return (self[index] for index in range(len(self)))

    def score_answer(self, answer: str | None, entry: Mapping[str, Any]) -> float:
        """Returns 1 for the right answer to an entry, and 0 for any other answer or None."""
        return float(answer is not None and is_right(entry["metadata"], answer))
