//! Diagnostics as text, for the messages of `arcade` and of Python exceptions.

mod excerpt;

use engine::{Diagnostic, Severity};
use excerpt::Excerpt;
use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteDiagnostic, Report};

/// A text with problems, and the way to display it.
#[derive(Clone, Copy, Debug)]
pub struct Source<'a> {
    /// The text's name in messages, such as a file path.
    pub name: &'a str,
    /// The text with the problems.
    pub text: &'a str,
    /// `true` to use colours, for a terminal.
    pub is_coloured: bool,
}

/// Returns a summary line, followed by every problem with its position.
#[must_use]
pub fn in_words(source: Source<'_>, problems: &[Diagnostic]) -> String {
    let errors = problems.iter().filter(|problem| problem.severity == Severity::Error).count();
    let plural = if errors == 1 { "problem" } else { "problems" };
    let mut text = format!("{} has {errors} {plural}\n", source.name);
    for problem in problems {
        text.push_str(&one_in_words(source, problem));
    }
    text.trim_end().to_owned()
}

/// Formats one problem: its code and message, the file with line and column, the line with a caret, and the
/// help.
#[must_use]
pub fn one_in_words(source: Source<'_>, problem: &Diagnostic) -> String {
    let label = if problem.label.is_empty() { "here" } else { &problem.label };
    let code = Excerpt::of(source.name, source.text, problem.span.start, problem.span.end);
    let severity = match problem.severity {
        Severity::Error => miette::Severity::Error,
        Severity::Warning => miette::Severity::Warning,
    };
    let mut diagnostic = MietteDiagnostic::new(problem.message.clone())
        .with_code(problem.code)
        .with_severity(severity)
        .with_label(LabeledSpan::new_with_span(Some(label.to_owned()), code.span()));
    diagnostic.help = help(source.name, problem);

    let theme = match source.is_coloured {
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

/// Returns the help for a problem in the text with the given name; `None` if the problem has no help. The name replaces
/// the placeholder in the engine's help, so that the commands work as printed.
#[must_use]
pub fn help(name: &str, problem: &Diagnostic) -> Option<String> {
    let help = problem.help.as_ref()?;
    if problem.code != "other-dialect" {
        return Some(help.clone());
    }
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "_./-".contains(c);
    let name = match name.chars().all(is_plain) {
        true => name.to_owned(),
        false => format!("'{}'", name.replace('\'', "'\\''")),
    };
    Some(help.replacen(" GAME`", &format!(" {name}`"), 1))
}

/// Returns the terminal escape sequences that turn the colours of diagnostics on and off.
#[must_use]
pub fn colours() -> Vec<String> {
    let styles = GraphicalTheme::unicode().styles;
    let single = [styles.error, styles.warning, styles.advice, styles.help, styles.link, styles.linum];
    let mut found = Vec::new();
    for style in single.into_iter().chain(styles.highlights) {
        let around = style.style('|').to_string();
        found.extend(around.split('|').filter(|sequence| !sequence.is_empty()).map(str::to_owned));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(text: &str, problem: &Diagnostic) -> String {
        one_in_words(Source { name: "game.vgdl", text, is_coloured: false }, problem)
    }

    #[track_caller]
    fn check(text: &str, marked: &str, expect: &[&str]) {
        let start = text.find(marked).unwrap();
        let span = engine::Span::new(start, start + marked.len());
        let told = shown(text, &Diagnostic::error("bad", span, "no such thing").label("this"));
        for words in expect {
            assert!(told.contains(words), "`{words}` is not in\n{told}");
        }
    }

    #[test]
    fn the_place_is_marked_in_its_lines() {
        check(
            "one\ntwo bad\nthree\n",
            "bad",
            &["game.vgdl:2:5", " 1 │ one", " 2 │ two bad", "    ─┬─", " 3 │ three"],
        );
        check("bad", "bad", &["game.vgdl:1:1", "1 │ bad", "─┬─"]);
        check("one\r\nbad\r\n", "bad", &["game.vgdl:2:1", "1 │ one\n", "2 │ bad\n"]);
        // A tab is one column wide, and is made visible.
        check("a\n\tbad\n", "bad", &["game.vgdl:2:2", "2 │ →bad", "·  ─┬─"]);
        check("", "", &["no such thing"]);
    }

    #[test]
    fn lines_are_cropped_around_the_place() {
        let wide = format!("first\n{}bad{}\nlast\n", " ".repeat(66_000), "x".repeat(90_000));
        check(&wide, "bad", &["game.vgdl:2:66001", "2 │ …", " bad", "…"]);
        let wide = format!("{}\nbad\n{}", "蟻".repeat(70_000), "\t".repeat(70_000));
        check(&wide, "bad", &["game.vgdl:2:1", "─┬─"]);
    }

    #[test]
    fn any_text_and_span_are_accepted() {
        let mut sampler = base::Seed::from_text("excerpts").sampler();
        let pieces = ["\t", "蟻", "\u{301}", " ", "a", "\r", "\n", "\u{feff}", "🎮", "\u{200b}"];
        for _ in 0..400 {
            let mut text = String::new();
            for _ in 0..sampler.below(9) {
                let longest = if sampler.ratio(1, 4) { 70_000 } else { 300 };
                text.push_str(&sampler.choose(&pieces).repeat(sampler.below(longest)));
            }
            let start = sampler.below(text.len() + 3);
            let span = engine::Span::new(start, start + sampler.below(70_000));
            let told = shown(&text, &Diagnostic::error("bad", span, "no such thing").help("try another"));
            assert!(told.len() < 10_000, "{} bytes of {} for {span:?}", told.len(), text.len());
        }
    }
}
