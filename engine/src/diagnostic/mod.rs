//! Problems in VGDL files, as plain data. The `editor` crate renders them in words (`in_words/`).

pub(crate) mod causes;

use crate::limits::MAX_PROBLEMS;
use crate::meanings::{Place, meaning, near_meaning};
use serde::Serialize;
use std::fmt;

/// A range of bytes in a source text. The default span marks generated nodes, which have no source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize)]
pub struct Span {
    /// The index of the first byte.
    pub start: usize,
    /// The index of the byte after the last byte.
    pub end: usize,
}

impl Span {
    /// Creates the span of the bytes `start..end`.
    pub fn new(start: usize, end: usize) -> Span {
        Span { start, end }
    }
}

/// The severity of a problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The file does not define a valid game or level.
    Error,
    /// The file is valid, but almost certainly not as intended.
    Warning,
}

/// A replacement of a range of text. An edit with an empty range inserts text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edit {
    /// The range of the replaced bytes.
    pub span: Span,
    /// The replacement text.
    pub text: String,
}

impl Edit {
    /// Creates an edit that replaces the bytes of `span` with `text`.
    pub fn new(span: Span, text: impl Into<String>) -> Edit {
        Edit { span, text: text.into() }
    }
}

/// A machine-applicable repair: edits with disjoint ranges, to be applied together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fix {
    /// The name of the repair, as an imperative: "Write `avatar`".
    pub title: String,
    /// The edits, sorted by position.
    pub edits: Vec<Edit>,
}

/// One problem: a stable code, a position, a message and the next step.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Diagnostic {
    /// The stable code, in kebab-case, such as `unknown-sprite`.
    pub code: &'static str,
    /// The severity: error or warning.
    pub severity: Severity,
    /// The message, in lower case and without a full stop. It contains the faulty word.
    pub message: String,
    /// The position of the problem.
    pub span: Span,
    /// The text under the caret, which may be empty.
    pub label: String,
    /// The suggested next step, if any.
    pub help: Option<String>,
    /// The repair that the help describes, if there is only one possible repair and its text is known.
    #[serde(skip)]
    pub fix: Option<Box<Fix>>,
}

impl Diagnostic {
    /// Creates an error at `span`.
    pub fn error(code: &'static str, span: Span, message: impl Into<String>) -> Diagnostic {
        let (message, label) = (message.into(), String::new());
        Diagnostic { code, severity: Severity::Error, message, span, label, help: None, fix: None }
    }

    /// Creates a warning at `span`.
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

    /// Sets a repair that replaces the bytes of `span` with `text`.
    pub(crate) fn replace(self, span: Span, text: &str) -> Diagnostic {
        self.fix(format!("Write `{text}`"), vec![Edit::new(span, text)])
    }

    /// Sets a repair that removes the bytes of `span`, which contain `name`.
    pub(crate) fn remove(self, span: Span, name: &str) -> Diagnostic {
        self.fix(format!("Remove `{name}`"), vec![Edit::new(span, "")])
    }

    /// Sets the same repair as [`Diagnostic::remove`], unless a repair is already set.
    pub(crate) fn or_remove(self, span: Span, name: &str) -> Diagnostic {
        if self.fix.is_some() { self } else { self.remove(span, name) }
    }

    /// Has the same effect as [`Diagnostic::mean`] if `found` is low enough for the problem to be shown.
    /// Otherwise, skips the lookup.
    pub(crate) fn mean_after<'a>(
        self,
        found: usize,
        place: Place,
        wrong: &str,
        candidates: impl IntoIterator<Item = &'a str>,
    ) -> Diagnostic {
        if found < MAX_PROBLEMS { self.mean(place, wrong, candidates) } else { self }
    }

    /// Suggests the VGDL equivalent if `wrong` is a word from a different dialect. Otherwise, adds "did you
    /// mean" if one of `candidates` is close to `wrong`. If the problem's span contains nothing but `wrong`,
    /// the repair replaces `wrong` with the VGDL word.
    pub(crate) fn mean<'a>(
        self,
        place: Place,
        wrong: &str,
        candidates: impl IntoIterator<Item = &'a str>,
    ) -> Diagnostic {
        let candidates: Vec<&str> = candidates.into_iter().collect();
        let found = match meaning(place, wrong) {
            None if nearest(wrong, candidates.iter().copied()).is_none() => near_meaning(place, wrong),
            found => found,
        };
        let write = |word: &&&str| candidates.contains(*word);
        match found.map(|found| (found.advice, found.write.iter().find(write))) {
            None | Some(("", None)) => self.suggest(wrong, candidates),
            Some(("", Some(word))) => self.help(format!("did you mean `{word}`?")).instead_of(wrong, word),
            Some((advice, None)) => self.help(advice),
            Some((advice, Some(word))) => self.help(advice).instead_of(wrong, word),
        }
    }

    /// Sets the repair that replaces `wrong` with `word`, if the problem's span contains nothing but `wrong`.
    fn instead_of(self, wrong: &str, word: &str) -> Diagnostic {
        let span = self.span;
        let is_all = span.end.saturating_sub(span.start) == wrong.len() && !wrong.is_empty();
        if is_all { self.replace(span, word) } else { self }
    }

    /// Adds "did you mean" if one of `candidates` is close to `wrong`. If the problem's span contains nothing but
    /// `wrong`, the repair replaces `wrong` with the candidate.
    pub fn suggest<'a>(self, wrong: &str, candidates: impl IntoIterator<Item = &'a str>) -> Diagnostic {
        match nearest(wrong, candidates) {
            Some(name) => self.help(format!("did you mean `{name}`?")).instead_of(wrong, name),
            None => self,
        }
    }
}

/// Returns the candidate most likely meant by `wrong`: a candidate with the same words in a different order, or with a
/// few different letters. Candidates that have the opposite meaning, or that share only their ending with `wrong`, are
/// not considered. Returns `None` if no candidate is similar enough.
pub fn nearest<'a>(wrong: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let (key, parts) = (wrong.to_lowercase(), words(wrong));
    let length = key.chars().count();
    let sorted = |mut words: Vec<String>| {
        words.sort_unstable();
        words
    };
    let (limit, own) = (|name: &str| near(name.chars().count().min(length)), sorted(parts.clone()));
    let same_words = |name: &str| parts.len() > 1 && own == sorted(words(name));
    let distance = |name: &str| match same_words(name) {
        true => 0,
        false => strsim::damerau_levenshtein(&key, &name.to_lowercase()),
    };
    candidates
        .into_iter()
        // The distance is at least the difference in length, which is cheaper to compute.
        .filter(|name| name.chars().count().abs_diff(length) <= limit(name) || same_words(name))
        .map(|name| (distance(name), name))
        .filter(|&(distance, name)| distance <= limit(name))
        .filter(|&(distance, name)| {
            distance == 0 || alike(&parts, &words(name)) && !opposite(&key, &name.to_lowercase(), distance)
        })
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, name)| name)
}

/// Returns the maximum number of wrong letters in a word of the given length.
fn near(length: usize) -> usize {
    1.max(length / 3)
}

/// Returns `true` if each word in one name is close to the word at the same position in the other name. Names
/// that share only their ending are therefore not alike.
fn alike(one: &[String], other: &[String]) -> bool {
    let close = |(one, other): (&String, &String)| {
        let distance = strsim::damerau_levenshtein(one, other);
        let shared = one.chars().zip(other.chars()).take_while(|(one, other)| one == other).count();
        // Two wrong letters do not count as a typo if the first letters differ, except in pairs such as
        // `move` and `moving`.
        let limit = near(one.chars().count().min(other.chars().count()));
        distance <= if shared > 0 { limit } else { 1 } || shared >= 3 && distance <= 3
    };
    one.len() != other.len() || one.iter().zip(other).all(close)
}

/// Returns `true` if two words differ by a prefix that negates one of the two.
fn opposite(one: &str, other: &str, distance: usize) -> bool {
    const NOT: [&str; 9] = ["im", "in", "un", "non", "not", "no", "dis", "anti", "de"];
    let negates = |long: &str, short: &str| {
        let rest = NOT.iter().filter_map(|not| long.strip_prefix(not).filter(|_| !short.starts_with(not)));
        rest.filter(|rest| !rest.is_empty()).any(|rest| strsim::damerau_levenshtein(rest, short) < distance)
    };
    let turns = |one: &str, other: &str| one.contains("increase") && other.contains("decrease");
    negates(one, other) || negates(other, one) || turns(one, other) || turns(other, one)
}

/// Splits a name like `scoreChange`, `score_change` or `RandomNPC` into words in lower case.
fn words(name: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut before = ' ';
    let mut letters = name.chars().peekable();
    while let Some(c) = letters.next() {
        let ends = matches!(c, '_' | '-' | ' ');
        let humps = c.is_uppercase()
            && (!before.is_uppercase() || letters.peek().is_some_and(|next| next.is_lowercase()));
        match words.last_mut() {
            Some(word) if !humps && !matches!(before, '_' | '-' | ' ') && !ends => {
                word.extend(c.to_lowercase())
            }
            _ if !ends => words.push(c.to_lowercase().collect()),
            _ => {}
        }
        before = c;
    }
    words
}

/// All problems in a file, including at least one error.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostics(pub Vec<Diagnostic>);

impl Diagnostics {
    /// Creates a list of problems sorted by position, without duplicates.
    pub fn sorted(mut list: Vec<Diagnostic>) -> Diagnostics {
        list.sort_by(|a, b| (a.span, a.code).cmp(&(b.span, b.code)));
        list.dedup();
        Diagnostics(list)
    }

    /// Truncates the list to the first [`MAX_PROBLEMS`] problems, and adds a problem that states the number
    /// of problems left out. The added problem is at `end`, the end of the text.
    pub(crate) fn shortened(mut self, end: usize) -> Diagnostics {
        let Some(rest) = self.0.len().checked_sub(MAX_PROBLEMS).filter(|&rest| rest > 0) else { return self };
        let severity = self.0.iter().map(|problem| problem.severity).min().unwrap_or(Severity::Error);
        self.0.truncate(MAX_PROBLEMS);
        let are = if rest == 1 { "problem is" } else { "problems are" };
        let message = format!("{rest} more {are} not shown");
        let more = Diagnostic::error("too-many-problems", Span::new(end, end), message);
        self.0.push(Diagnostic { severity, ..more.help("fix the problems above first") });
        self
    }

    /// Returns `true` if `list` contains an error.
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

/// Returns the line and column of byte `offset` in `source`, both counted from 1. Columns count characters.
pub fn line_and_column(source: &str, offset: usize) -> (usize, usize) {
    let mut offset = offset.min(source.len());
    while !source.is_char_boundary(offset) {
        offset -= 1;
    }
    let before = &source[..offset];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}

/// Returns the start of the line that contains byte `offset`.
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
        assert_eq!(nearest("score_change", ["cooldown", "scoreChange"]), Some("scoreChange"));
    }

    #[test]
    fn suggestions_are_no_opposites_and_share_more_than_an_end() {
        use crate::keywords::{CLASSES, EFFECTS};
        for wrong in [
            "Movable",
            "Movible",
            "PlayerAvatar",
            "MarioAvatar",
            "InertialAvatar",
            "RandomAvatar",
            "Blocker",
            "Timer",
        ] {
            assert_eq!(nearest(wrong, CLASSES.iter().copied()), None, "{wrong}");
        }
        for wrong in [
            "killIfHasLes",
            "removeSprite",
            "killIfOtherHasLess",
            "increaseScore",
            "spawnSprite",
            "unkillSprite",
        ] {
            let near = nearest(wrong, EFFECTS.iter().copied());
            assert_eq!(near, Some("killIfHasLess").filter(|_| wrong == "killIfHasLes"), "{wrong}");
        }
        assert_eq!(nearest("visible", ["invisible"]), None);
        assert_eq!(nearest("invisble", ["invisible", "visible"]), Some("invisible"));
        assert_eq!(nearest("dncreaseSpeedToAll", ["increaseSpeedToAll"]), Some("increaseSpeedToAll"));
        for (wrong, meant) in [
            ("Imovable", "Immovable"),
            ("Inmovable", "Immovable"),
            ("MoveAvatar", "MovingAvatar"),
            ("Fleeling", "Fleeing"),
            ("ShotAvatar", "ShootAvatar"),
            ("randomnpc", "RandomNPC"),
            ("LOSchaser", "LOSChaser"),
            ("Chase", "Chaser"),
            ("resourcePack", "ResourcePack"),
            ("Misslie", "Missile"),
        ] {
            assert_eq!(nearest(wrong, CLASSES.iter().copied()), Some(meant), "{wrong}");
        }
        for (wrong, meant) in [
            ("killIfhasMore", "killIfHasMore"),
            ("CollectResources", "collectResource"),
            ("spwanIfHasMore", "spawnIfHasMore"),
            ("backStep", "stepBack"),
        ] {
            assert_eq!(nearest(wrong, EFFECTS.iter().copied()), Some(meant), "{wrong}");
        }
    }

    #[test]
    fn places_count_from_one() {
        assert_eq!(line_and_column("ab\ncd", 0), (1, 1));
        assert_eq!(line_and_column("ab\ncd", 4), (2, 2));
        assert_eq!(line_and_column("ab\ncd", 99), (2, 3));
    }
}
