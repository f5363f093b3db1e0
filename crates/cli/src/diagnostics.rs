//! Diagnostics, formatted for people and for programs.

use crate::failure::{Failure, Placed, Problems};
use editor::Source;
use engine::{Diagnostic, Game, Level, line_and_column};
use std::io::IsTerminal;

/// A text and its name in messages.
#[derive(Clone, Debug)]
pub(crate) struct Named {
    pub(crate) name: String,
    pub(crate) text: String,
}

impl Named {
    /// Parses the text as a level of the given game.
    pub(crate) fn level(&self, game: &Game) -> Result<Level, Failure> {
        game.level(&self.text).map_err(|problems| failure(self, &problems.0))
    }
}

/// Returns a human-readable report: a summary line, followed by every problem with its position.
pub(crate) fn in_words(source: &Named, problems: &[Diagnostic]) -> String {
    editor::in_words(shown(source), problems)
}

/// Returns one problem as human-readable text.
pub(crate) fn one_in_words(source: &Named, problem: &Diagnostic) -> String {
    editor::one_in_words(shown(source), problem)
}

fn shown(source: &Named) -> Source<'_> {
    Source { name: &source.name, text: &source.text, is_coloured: std::io::stderr().is_terminal() }
}

/// Returns the failure of a subcommand that cannot continue because a file has problems.
pub(crate) fn failure(source: &Named, problems: &[Diagnostic]) -> Failure {
    let text = in_words(source, problems);
    let summary = text.lines().next().unwrap_or_default().to_owned();
    Failure::Malformed(Problems { summary, placed: placed(source, problems), text }.into())
}

/// Returns a file's problems with their lines and columns.
pub(crate) fn placed(source: &Named, problems: &[Diagnostic]) -> Vec<Placed> {
    let place = |problem: &Diagnostic| {
        let (line, column) = line_and_column(&source.text, problem.span.start);
        let problem = Diagnostic { help: editor::help(&source.name, problem), ..problem.clone() };
        Placed { file: source.name.clone(), line, column, problem }
    };
    problems.iter().map(place).collect()
}
