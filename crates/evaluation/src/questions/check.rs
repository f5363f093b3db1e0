//! Checks answers to questions.

use super::draft::LETTERS;
use super::question::{Question, QuestionKind};
use crate::answer::{Reading, read_board, read_choice};

/// Reads the answer to a question, and returns it in the form of [`Question::answer`]. Reasoning is ignored, and
/// formats other than the requested one are tolerated ([`read_choice`], [`read_board`]). Cost: O(bytes).
pub fn read(question: &Question, text: &str) -> Reading<String> {
    let word = |words: &[&str]| read_choice(text, words).map(|choice| words[choice].to_owned());
    match question.kind {
        QuestionKind::NextBoard => {
            let mut rows = question.answer.lines();
            let columns = rows.next().map_or(0, |row| row.chars().count());
            read_board(text, columns, rows.count() + 1)
        }
        QuestionKind::Winnable | QuestionKind::WinWithin => word(&["yes", "no"]),
        QuestionKind::BoardChoice | QuestionKind::ChangedRule | QuestionKind::SpriteBehaviour => {
            word(&LETTERS[..question.options.len().min(LETTERS.len())])
        }
    }
}

/// Returns `true` if a text gives the right answer to a question, in any format that [`read`] accepts.
pub fn is_right(question: &Question, text: &str) -> bool {
    read(question, text).choice().is_some_and(|answer| answer == question.answer)
}
