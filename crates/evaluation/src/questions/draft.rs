//! Drafts of questions, and their completion: the order of the options, the answer format and the ID.

use super::place::Place;
use super::question::{Evidence, OptionSource, Question, QuestionKind};
use base::Seed;
use itertools::Itertools;

/// The letters of the options, in order.
pub(super) const LETTERS: [&str; 4] = ["A", "B", "C", "D"];

const TASK: &str = "This question is about a game on a board of cells. In each tick, the player presses one key. \
    A cell is written (x,y): x is its column, counted from 0 at the left; y is its row, counted from 0 at the top.";

/// A question before its options are ordered.
pub(super) struct Draft {
    game: String,
    level: usize,
    body: String,
    form: Form,
    evidence: Evidence,
}

/// The form of an answer.
pub(super) enum Form {
    /// A board to write out.
    Board(String),
    /// Yes or no.
    YesNo(bool),
    /// Four options. The first one is right.
    Options(Box<[(String, OptionSource); 4]>),
}

impl Draft {
    /// Creates a draft. Its prompt consists of the rules, the legend, the actions and the given parts.
    pub(super) fn new(
        place: Place<'_>,
        rules: &str,
        parts: &[String],
        form: Form,
        evidence: Evidence,
    ) -> Draft {
        let game = place.game;
        let fixed = [
            TASK.to_owned(),
            rules.to_owned(),
            game.section("Legend") + "\n" + &game.layers(),
            game.section("Actions"),
        ];
        let body = fixed.iter().chain(parts).join("\n\n");
        Draft { game: game.subject.id.clone(), level: place.level.source.number, body, form, evidence }
    }

    /// Returns the prompt without the options and the answer format.
    pub(super) fn body(&self) -> &str {
        &self.body
    }

    /// Completes the question. The right option gets the letter with the index `right`, and the seed determines the
    /// order of the other options.
    pub(super) fn complete(self, kind: QuestionKind, number: usize, right: usize, seed: Seed) -> Question {
        let Draft { game, level, body, form, mut evidence } = self;
        let (mut options, mut told) = (Vec::new(), String::new());
        let (answer, format) = match form {
            Form::Board(board) => (board, "Think first. End your answer with a line that says ANSWER: and then the board, one line per row, in the characters of the legend.".to_owned()),
            Form::YesNo(answer) => {
                let word = if answer { "yes" } else { "no" };
                (word.to_owned(), last_line("yes or no"))
            }
            Form::Options(all) => {
                let mut all = all.to_vec();
                seed.sampler().shuffle(&mut all[1..]);
                all.swap(0, right);
                (options, evidence.options) = all.into_iter().unzip();
                told = format!("\n\n{}", list(&options));
                (LETTERS[right].to_owned(), last_line("A, B, C or D"))
            }
        };
        let prompt = format!("{body}{told}\n\n{format}\n");
        Question {
            id: format!("{}-{number:05}", kind.name()),
            kind,
            game,
            level,
            prompt,
            options,
            answer,
            check: evidence,
        }
    }
}

fn last_line(answers: &str) -> String {
    format!(
        "Think first. The last line of your answer must be ANSWER: followed by {answers}, and nothing after it."
    )
}

/// Lists the options with their letters. Boards begin on a line of their own.
fn list(options: &[String]) -> String {
    let is_long = options.iter().any(|option| option.contains('\n'));
    let gap = if is_long { "\n" } else { " " };
    LETTERS.iter().zip(options).map(|(letter, option)| format!("{letter}.{gap}{option}")).join(if is_long {
        "\n\n"
    } else {
        "\n"
    })
}
