//! Diagnostics for people and programs.

use crate::failure::Failure;
use crate::input::Named;
use editor::Source;
use engine::{Diagnostic, line_and_column};
use serde::Serialize;
use std::fmt;
use std::io::IsTerminal;

/// The problems in a file, as an error.
#[derive(Debug)]
pub(crate) struct Problems {
    /// The line that states the number of problems.
    pub(crate) summary: String,
    pub(crate) placed: Vec<Placed>,
    text: String,
}

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl std::error::Error for Problems {}

/// Returns a summary line and every problem with its position, for people.
pub(crate) fn in_words(source: &Named, problems: &[Diagnostic]) -> String {
    editor::in_words(shown(source), problems)
}

/// Returns one problem as text for people.
pub(crate) fn one_in_words(source: &Named, problem: &Diagnostic) -> String {
    editor::one_in_words(shown(source), problem)
}

fn shown(source: &Named) -> Source<'_> {
    Source { name: &source.name, text: &source.text, is_coloured: std::io::stderr().is_terminal() }
}

/// Returns the failure of a subcommand that cannot continue because of the problems in a file.
pub(crate) fn failure(source: &Named, problems: &[Diagnostic]) -> Failure {
    let text = in_words(source, problems);
    let summary = text.lines().next().unwrap_or_default().to_owned();
    Failure::Malformed(Problems { summary, placed: placed(source, problems), text }.into())
}

#[derive(Debug, Serialize)]
pub(crate) struct Placed {
    file: String,
    line: usize,
    column: usize,
    #[serde(flatten)]
    problem: Diagnostic,
}

/// Returns the problems in a file with their lines and columns.
pub(crate) fn placed(source: &Named, problems: &[Diagnostic]) -> Vec<Placed> {
    let place = |problem: &Diagnostic| {
        let (line, column) = line_and_column(&source.text, problem.span.start);
        let problem = Diagnostic { help: editor::help(&source.name, problem), ..problem.clone() };
        Placed { file: source.name.clone(), line, column, problem }
    };
    problems.iter().map(place).collect()
}
