//! Questions with exact answers.

use crate::errors::{failed, invalid};
use crate::evaluate::{LevelText, subject};
use crate::game::Game;
use crate::interrupt::interruptible;
use base::Seed;
use evaluation::Subject;
use evaluation::questions::{Evidence, Question, QuestionKind, QuestionOrder, draw, is_right};
use pyo3::prelude::*;

/// A game with its ID and its levels.
type GameWithLevels<'py> = (Bound<'py, Game>, String, Vec<LevelText>);

/// Draws questions from the levels of games, like `arcade export`. Returns one JSON object per question.
#[pyfunction]
#[pyo3(signature = (games, *, kinds, count, seed))]
pub(crate) fn draw_questions(
    py: Python<'_>,
    games: Vec<GameWithLevels<'_>>,
    kinds: Option<Vec<String>>,
    count: usize,
    seed: &str,
) -> PyResult<Vec<String>> {
    let read = |(game, id, levels): &GameWithLevels<'_>| subject(&game.borrow(), id, levels);
    let subjects: Vec<Subject> = games.iter().map(read).collect::<PyResult<_>>()?;
    let kinds = match kinds {
        None => QuestionKind::ALL.to_vec(),
        Some(names) => names.iter().map(|name| kind(name)).collect::<PyResult<_>>()?,
    };
    let order = QuestionOrder { kinds, count, seed: Seed::from_text(seed) };
    interruptible(py, move |_| {
        let questions = draw(&subjects, &order, &mut |_| ()).map_err(failed)?;
        questions.iter().map(|question| serde_json::to_string(question).map_err(failed)).collect()
    })
}

/// Returns `True` if a text states the right answer to a question of the given kind, with this number of options.
#[pyfunction]
pub(crate) fn is_right_answer(kind: &str, options: usize, answer: String, text: &str) -> PyResult<bool> {
    let question = Question {
        id: String::new(),
        kind: self::kind(kind)?,
        game: String::new(),
        level: 0,
        prompt: String::new(),
        options: vec![String::new(); options.min(4)],
        answer,
        check: Evidence::default(),
    };
    Ok(is_right(&question, text))
}

/// Returns the names of the kinds of questions.
#[pyfunction]
pub(crate) fn question_kinds() -> Vec<&'static str> {
    QuestionKind::ALL.map(QuestionKind::name).to_vec()
}

fn kind(name: &str) -> PyResult<QuestionKind> {
    let found = QuestionKind::ALL.into_iter().find(|kind| kind.name() == name);
    found.ok_or_else(|| {
        let names = QuestionKind::ALL.map(QuestionKind::name).join(", ");
        invalid(format!("`{name}` is not a kind of question; the kinds are {names}"))
    })
}
