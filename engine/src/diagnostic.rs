//! The problems that a VGDL file can have, as plain data; `cli` renders them.

use crate::limits::MAX_PROBLEMS;
use serde::Serialize;
use std::fmt;

/// A range of bytes in a source text. The default span marks generated nodes, which have no source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize)]
pub struct Span {
    /// First byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

impl Span {
    /// The bytes `start..end`.
    pub fn new(start: usize, end: usize) -> Span {
        Span { start, end }
    }
}

/// The severity of a problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The file does not make a game or level.
    Error,
    /// The file is legal, but surely not as intended.
    Warning,
}

/// The replacement of a range of a text; an empty range is a place to insert at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edit {
    /// The replaced bytes.
    pub span: Span,
    /// The text to put there.
    pub text: String,
}

impl Edit {
    /// `text` instead of the bytes of `span`.
    pub fn new(span: Span, text: impl Into<String>) -> Edit {
        Edit { span, text: text.into() }
    }
}

/// A repair of a problem that a program can make: edits of disjoint ranges, which belong together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fix {
    /// The name of the repair, a command: "Write `avatar`".
    pub title: String,
    /// The edits, sorted by place.
    pub edits: Vec<Edit>,
}

/// One problem: a stable code, a place, a message and the next step.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Diagnostic {
    /// The stable code, in kebab-case: `unknown-sprite`.
    pub code: &'static str,
    /// Error or warning.
    pub severity: Severity,
    /// The message, which names the faulty word; lower-case, no full stop.
    pub message: String,
    /// The place.
    pub span: Span,
    /// The text under the caret; may be empty.
    pub label: String,
    /// The suggested next step, if there is one.
    pub help: Option<String>,
    /// The repair that the help speaks of, where there is only one and its text is known.
    #[serde(skip)]
    pub fix: Option<Box<Fix>>,
}

impl Diagnostic {
    /// An error at `span`.
    pub fn error(code: &'static str, span: Span, message: impl Into<String>) -> Diagnostic {
        let (message, label) = (message.into(), String::new());
        Diagnostic { code, severity: Severity::Error, message, span, label, help: None, fix: None }
    }

    /// A warning at `span`.
    pub fn warning(code: &'static str, span: Span, message: impl Into<String>) -> Diagnostic {
        Diagnostic { severity: Severity::Warning, ..Diagnostic::error(code, span, message) }
    }

    /// Sets the text under the caret.
    pub fn label(self, label: impl Into<String>) -> Diagnostic {
        Diagnostic { label: label.into(), ..self }
    }

    /// Sets the suggested next step.
    pub fn help(self, help: impl Into<String>) -> Diagnostic {
        Diagnostic { help: Some(help.into()), ..self }
    }

    /// Sets the repair.
    pub fn fix(self, title: impl Into<String>, edits: Vec<Edit>) -> Diagnostic {
        Diagnostic { fix: Some(Box::new(Fix { title: title.into(), edits })), ..self }
    }

    /// Sets the repair of writing `text` instead of the bytes of `span`.
    pub(crate) fn replace(self, span: Span, text: &str) -> Diagnostic {
        self.fix(format!("Write `{text}`"), vec![Edit::new(span, text)])
    }

    /// Sets the repair of removing `name`, the bytes of `span`.
    pub(crate) fn remove(self, span: Span, name: &str) -> Diagnostic {
        self.fix(format!("Remove `{name}`"), vec![Edit::new(span, "")])
    }

    /// [`Diagnostic::remove`], unless there is a repair already.
    pub(crate) fn or_remove(self, span: Span, name: &str) -> Diagnostic {
        if self.fix.is_some() { self } else { self.remove(span, name) }
    }

    /// [`Diagnostic::suggest`] for the problems of a list that will be shown; for the others nothing is looked up.
    pub(crate) fn suggest_after<'a>(
        self,
        found: usize,
        wrong: &str,
        candidates: impl IntoIterator<Item = &'a str>,
    ) -> Diagnostic {
        if found < MAX_PROBLEMS { self.suggest(wrong, candidates) } else { self }
    }

    /// Adds "did you mean" if one of `candidates` is close to `wrong`; if `wrong` is all that the problem marks, the name
    /// instead of it is the repair.
    pub fn suggest<'a>(self, wrong: &str, candidates: impl IntoIterator<Item = &'a str>) -> Diagnostic {
        match nearest(wrong, candidates) {
            Some(name) => {
                let (span, problem) = (self.span, self.help(format!("did you mean `{name}`?")));
                let is_all = span.end.saturating_sub(span.start) == wrong.len() && !wrong.is_empty();
                if is_all { problem.replace(span, name) } else { problem }
            }
            None => self,
        }
    }
}

/// The candidate that `wrong` most likely stands for: the same words in another order, or a few letters off.
pub fn nearest<'a>(wrong: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let (key, parts) = (wrong.to_lowercase(), words(wrong));
    let length = key.chars().count();
    let near = |name: &str| 1.max(name.chars().count().min(length) / 3);
    let same_words = |name: &str| parts.len() > 1 && parts == words(name);
    let distance = |name: &str| match same_words(name) {
        true => 0,
        false => strsim::damerau_levenshtein(&key, &name.to_lowercase()),
    };
    candidates
        .into_iter()
        // The distance is at least the difference in length, which is cheaper to compute.
        .filter(|name| name.chars().count().abs_diff(length) <= near(name) || same_words(name))
        .map(|name| (distance(name), name))
        .filter(|&(distance, name)| distance <= near(name))
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, name)| name)
}

/// The words of a name like `scoreChange`, sorted.
fn words(name: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for c in name.chars() {
        match words.last_mut() {
            Some(word) if !c.is_uppercase() => word.push(c),
            _ => words.push(c.to_lowercase().collect()),
        }
    }
    words.sort_unstable();
    words
}

/// All problems of a file; at least one is an error.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostics(pub Vec<Diagnostic>);

impl Diagnostics {
    /// Sorts the problems by place.
    pub fn sorted(mut list: Vec<Diagnostic>) -> Diagnostics {
        list.sort_by(|a, b| (a.span, a.code).cmp(&(b.span, b.code)));
        list.dedup();
        Diagnostics(list)
    }

    /// Keeps the first [`MAX_PROBLEMS`] and adds the number of the others; `end` is the end of the text.
    pub(crate) fn shortened(mut self, end: usize) -> Diagnostics {
        let Some(rest) = self.0.len().checked_sub(MAX_PROBLEMS).filter(|&rest| rest > 0) else { return self };
        let severity = self.0.iter().map(|problem| problem.severity).min().unwrap_or(Severity::Error);
        self.0.truncate(MAX_PROBLEMS);
        let are = if rest == 1 { "problem is" } else { "problems are" };
        let message = format!("{rest} more {are} not shown");
        let more = Diagnostic::error("too-many-problems", Span::new(end, end), message);
        self.0.push(Diagnostic { severity, ..more.help("repair those above first") });
        self
    }

    /// Tests whether `list` contains an error.
    pub fn has_errors(list: &[Diagnostic]) -> bool {
        list.iter().any(|diagnostic| diagnostic.severity == Severity::Error)
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, diagnostic) in self.0.iter().enumerate() {
            let newline = if i == 0 { "" } else { "\n" };
            write!(f, "{newline}{}: {}", diagnostic.code, diagnostic.message)?;
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostics {}

/// Line and column, both from 1, of byte `offset` in `source`; columns count characters.
pub fn line_and_column(source: &str, offset: usize) -> (usize, usize) {
    let mut offset = offset.min(source.len());
    while !source.is_char_boundary(offset) {
        offset -= 1;
    }
    let before = &source[..offset];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}

/// The start of the line that contains byte `offset`.
pub(crate) fn line_start(source: &str, offset: usize) -> usize {
    let before = &source.as_bytes()[..offset.min(source.len())];
    before.iter().rposition(|byte| b"\n\r".contains(byte)).map_or(0, |newline| newline + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suggestions_are_close_or_absent() {
        let names = ["avatar", "alien", "wall"];
        assert_eq!(nearest("alein", names), Some("alien"));
        assert_eq!(nearest("Avatar", names), Some("avatar"));
        assert_eq!(nearest("spaceship", names), None);
        assert_eq!(nearest("changeScore", ["cooldown", "scoreChange"]), Some("scoreChange"));
    }

    #[test]
    fn places_count_from_one() {
        assert_eq!(line_and_column("ab\ncd", 0), (1, 1));
        assert_eq!(line_and_column("ab\ncd", 4), (2, 2));
        assert_eq!(line_and_column("ab\ncd", 99), (2, 3));
    }
}
