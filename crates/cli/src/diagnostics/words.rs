//! Diagnostics in words. The Python package compiles this file too, so that its exceptions read as the messages of `arcade`.

use super::excerpt::Excerpt;
use crate::input::Named;
use engine::{Diagnostic, Severity};
use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteDiagnostic, Report};
use std::io::IsTerminal;

/// A summary line, then every problem with its position.
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
    let code = Excerpt::of(&source.name, &source.text, problem.span.start, problem.span.end);
    let severity = match problem.severity {
        Severity::Error => miette::Severity::Error,
        Severity::Warning => miette::Severity::Warning,
    };
    let mut diagnostic = MietteDiagnostic::new(problem.message.clone())
        .with_code(problem.code)
        .with_severity(severity)
        .with_label(LabeledSpan::new_with_span(Some(label.to_owned()), code.span()));
    diagnostic.help = help(source, problem);

    let theme = match std::io::stderr().is_terminal() {
        true => GraphicalTheme::unicode(),
        false => GraphicalTheme::unicode_nocolor(),
    };
    let report = Report::new(diagnostic).with_source_code(code);
    let mut text = String::new();
    let handler = GraphicalReportHandler::new_themed(theme).with_context_lines(1).with_width(100);
    match handler.render_report(&mut text, report.as_ref()) {
        Ok(()) => text,
        Err(_) => format!("{}: {}\n", problem.code, problem.message),
    }
}

/// The help of a problem. The engine does not know the name of the file, and a command must work as printed.
pub(crate) fn help(source: &Named, problem: &Diagnostic) -> Option<String> {
    let help = problem.help.as_ref()?;
    if problem.code != "other-dialect" {
        return Some(help.clone());
    }
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "_./-".contains(c);
    let name = match source.name.chars().all(is_plain) {
        true => source.name.clone(),
        false => format!("'{}'", source.name.replace('\'', "'\\''")),
    };
    Some(help.replacen(" GAME`", &format!(" {name}`"), 1))
}
