//! Diagnostics as people and programs read them.

use crate::failure::Failure;
use crate::input::Named;
use engine::{Diagnostic, Severity, line_and_column};
use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteDiagnostic, NamedSource, Report};
use serde::Serialize;
use std::fmt;
use std::io::IsTerminal;

/// The problems of a file, as an error.
#[derive(Debug)]
pub(crate) struct Problems {
    /// The line that says how many there are.
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

/// The failure of a verb that cannot go on because of the problems of a file.
pub(crate) fn failure(source: &Named, problems: &[Diagnostic]) -> Failure {
    let text = in_words(source, problems);
    let summary = text.lines().next().unwrap_or_default().to_owned();
    Failure::Malformed(Problems { summary, placed: placed(source, problems), text }.into())
}

/// A summary line, then every problem with its place.
pub(crate) fn in_words(source: &Named, problems: &[Diagnostic]) -> String {
    let errors = problems.iter().filter(|problem| problem.severity == Severity::Error).count();
    let plural = if errors == 1 { "problem" } else { "problems" };
    let mut text = format!("{} has {errors} {plural}\n", source.name);
    for problem in problems {
        text.push_str(&one_in_words(source, problem));
    }
    text.trim_end().to_owned()
}

/// One problem: code, message, file, line, column, the line with a caret, help.
pub(crate) fn one_in_words(source: &Named, problem: &Diagnostic) -> String {
    let label = if problem.label.is_empty() { "here" } else { &problem.label };
    let length = problem.span.end - problem.span.start;
    let severity = match problem.severity {
        Severity::Error => miette::Severity::Error,
        Severity::Warning => miette::Severity::Warning,
    };
    let mut diagnostic = MietteDiagnostic::new(problem.message.clone())
        .with_code(problem.code)
        .with_severity(severity)
        .with_label(LabeledSpan::new(Some(label.to_owned()), problem.span.start, length));
    diagnostic.help.clone_from(&problem.help);
    let theme = match std::io::stderr().is_terminal() {
        true => GraphicalTheme::unicode(),
        false => GraphicalTheme::unicode_nocolor(),
    };
    let code = NamedSource::new(&source.name, source.text.clone());
    let report = Report::new(diagnostic).with_source_code(code);
    let mut text = String::new();
    let handler = GraphicalReportHandler::new_themed(theme).with_context_lines(1).with_width(100);
    match handler.render_report(&mut text, report.as_ref()) {
        Ok(()) => text,
        Err(_) => format!("{}: {}\n", problem.code, problem.message),
    }
}

/// One problem for programs.
#[derive(Debug, Serialize)]
pub(crate) struct Placed {
    file: String,
    line: usize,
    column: usize,
    #[serde(flatten)]
    problem: Diagnostic,
}

/// The problems of a file with line and column.
pub(crate) fn placed(source: &Named, problems: &[Diagnostic]) -> Vec<Placed> {
    let place = |problem: &Diagnostic| {
        let (line, column) = line_and_column(&source.text, problem.span.start);
        Placed { file: source.name.clone(), line, column, problem: problem.clone() }
    };
    problems.iter().map(place).collect()
}
