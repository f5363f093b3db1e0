//! Diagnostics for people and programs.

mod excerpt;
mod words;

use crate::failure::Failure;
use crate::input::Named;
use engine::{Diagnostic, line_and_column};
use serde::Serialize;
use std::fmt;
pub(crate) use words::{in_words, one_in_words};

/// The problems of a file, as an error.
#[derive(Debug)]
pub(crate) struct Problems {
    /// The line with the number of problems.
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

/// Returns the failure of a verb that cannot go on because of the problems of a file.
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

/// The problems of a file with line and column.
pub(crate) fn placed(source: &Named, problems: &[Diagnostic]) -> Vec<Placed> {
    let place = |problem: &Diagnostic| {
        let (line, column) = line_and_column(&source.text, problem.span.start);
        let problem = Diagnostic { help: words::help(source, problem), ..problem.clone() };
        Placed { file: source.name.clone(), line, column, problem }
    };
    problems.iter().map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(text: &str, problem: &Diagnostic) -> String {
        one_in_words(&Named { name: "game.vgdl".to_owned(), text: text.to_owned() }, problem)
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
        // A tab is one column, and is made visible.
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
