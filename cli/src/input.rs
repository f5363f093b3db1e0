//! Games and levels as the user names them: files, folders, names of the corpus.

use crate::failure::Failure;
use engine::{Diagnostic, Diagnostics, Game, Severity, line_and_column};
use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteDiagnostic, NamedSource, Report};
use serde::Serialize;
use std::io::{IsTerminal, Read};
use std::path::Path;

/// Reads a text file of at most `limit` bytes (a byte more shows that it is longer).
pub(crate) fn read_text(path: &Path, limit: usize) -> Result<String, Failure> {
    let name = path.display();
    let open = || std::fs::File::open(path);
    let file = open().map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => Failure::malformed(format!("{name}: there is no such file")),
        _ => Failure::surroundings(error, name.to_string()),
    })?;
    let mut bytes = Vec::new();
    let read = file.take(limit as u64 + 1).read_to_end(&mut bytes);
    read.map_err(|error| Failure::surroundings(error, name.to_string()))?;
    if bytes.len() > limit {
        return Err(Failure::malformed(format!(
            "{name}: larger than {limit} bytes, the limit for such a file"
        )));
    }
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        Failure::malformed(format!("{name}: not a text file (byte {at} is not UTF-8)"))
    })
}

/// Parses and compiles the text of a game file; problems are rendered into the failure.
pub(crate) fn compile(name: &str, source: &str) -> Result<Game, Failure> {
    Game::from_source(source).map_err(|problems| Failure::malformed(rendered(name, source, &problems)))
}

/// A summary line, then every problem with its place.
pub(crate) fn rendered(name: &str, source: &str, problems: &Diagnostics) -> String {
    let errors = problems.0.iter().filter(|problem| problem.severity == Severity::Error).count();
    let plural = if errors == 1 { "problem" } else { "problems" };
    let mut text = format!("{name} has {errors} {plural}\n");
    for problem in &problems.0 {
        text.push_str(&render(name, source, problem));
    }
    text
}

/// One problem as people read it: code, message, file, line, column, the line with a caret, help.
pub(crate) fn render(name: &str, source: &str, problem: &Diagnostic) -> String {
    let label = Some(problem.label.clone()).filter(|label| !label.is_empty());
    let length = problem.span.end - problem.span.start;
    let severity = match problem.severity {
        Severity::Error => miette::Severity::Error,
        Severity::Warning => miette::Severity::Warning,
    };
    let mut diagnostic = MietteDiagnostic::new(problem.message.clone())
        .with_code(problem.code)
        .with_severity(severity)
        .with_label(LabeledSpan::new(label.or_else(|| Some("here".to_owned())), problem.span.start, length));
    diagnostic.help.clone_from(&problem.help);
    let theme = match std::io::stderr().is_terminal() {
        true => GraphicalTheme::unicode(),
        false => GraphicalTheme::unicode_nocolor(),
    };
    let report = Report::new(diagnostic).with_source_code(NamedSource::new(name, source.to_owned()));
    let mut text = String::new();
    let handler = GraphicalReportHandler::new_themed(theme).with_context_lines(0).with_width(100);
    let _ = handler.render_report(&mut text, report.as_ref());
    text
}

/// One problem as programs read it.
#[derive(Serialize)]
pub(crate) struct Placed<'a> {
    file: &'a str,
    line: usize,
    column: usize,
    #[serde(flatten)]
    problem: &'a Diagnostic,
}

/// The problems of a file with line and column.
pub(crate) fn placed<'a>(file: &'a str, source: &str, problems: &'a [Diagnostic]) -> Vec<Placed<'a>> {
    let place = |problem: &'a Diagnostic| {
        let (line, column) = line_and_column(source, problem.span.start);
        Placed { file, line, column, problem }
    };
    problems.iter().map(place).collect()
}
