"""Checks answers for lm-evaluation-harness. Needs the Python package infinite-arcade."""

from infinite_arcade import questions


def process_results(doc, results):
    """Returns 1 for the right answer and 0 for any other answer."""
    return {"right": float(questions.is_right(doc, results[0]))}
