//! Finds the decisions that an answer states, and chooses the last of them.

use super::Stage;
use super::phrase::{self, Context, Phrase};
use super::read::{Chosen, action_of, is_number, pattern};
use super::text::boundary;
use engine::Action;
use regex::{Captures, Regex};
use std::ops::Range;
use std::sync::LazyLock;

/// The number of non-empty lines at the end of an answer in which an action counts even without the word
/// "action".
const LAST_LINES: usize = 5;

/// The maximum number of bytes to examine per line.
pub(super) const MAX_SCANNED: usize = 400;

/// The maximum number of decisions to examine, counted from the end of the answer.
const DECISIONS: usize = 100;

/// The start of a decision in a player's text: a tag, `\boxed{`, or a word such as "action" followed by a punctuation
/// mark.
static MARK: LazyLock<Regex> = LazyLock::new(|| {
    pattern(
        r#"(?i)<\|?(?P<tag>(?:final[_ ]?)?(?:answer|action|move|choice|decision))\|?>|(?P<box>\\boxed\{)|(?-u:\b)(?P<key>(?:[a-z]{1,12}_)?actions?|(?:[a-z]{1,12}_)?(?:answer|move|choice|decision))(?P<quote>["']?)[*`_\])]{0,3}[ \t]{0,4}(?:[:=]|->|→|⇒)"#,
    )
});

/// A JSON value: a string, a list or an object.
static VALUE: LazyLock<Regex> = LazyLock::new(|| {
    pattern(
        r#"^[ \t]*(?:"(?P<double>[^"\n]*)|'(?P<single>[^'\n]*)|\[(?P<list>[^\]]*)|\{(?P<object>[^}]*)|(?P<bare>[^,}\n]*))"#,
    )
});

/// The word "action" immediately followed by an action or a number.
static MARKED_BY_WORD: LazyLock<Regex> = LazyLock::new(|| {
    pattern(
        r#"(?i)(?-u:\b)action[*`]{0,3}[ \t]{1,4}[*`"'<(\[{]{0,4}(?P<word>action_[a-z]+|up|left|down|right|use|nil|[0-9]+)(?-u:\b)"#,
    )
});

/// An action in the reference engine's spelling, such as `ACTION_LEFT`.
static SPELLED: LazyLock<Regex> = LazyLock::new(|| pattern(r"(?i)(?-u:\b)(?P<word>action_[a-z]+)(?-u:\b)"));

/// An action alone on a line.
static ALONE: LazyLock<Regex> = LazyLock::new(|| {
    pattern(
        r#"(?im)^[ \t*`"'>(\[{<_#$•=→~-]*(?P<word>action_[a-z]+|[a-z]+)(?:[ \t]+(?:arrow|key)){0,2}[ \t*`"'.!)\]}>_$~,;]*\r?$"#,
    )
});

/// A direction in a player's statement about its next move.
static STATED: LazyLock<Regex> = LazyLock::new(|| {
    let verbs = "go|going|move|moving|step|walk|turn|head|press|choose|select|play|try|shoot|face|push";
    let between = "to|the|towards|toward|one|step|cell|action|key|arrow|straight";
    let nouns = "answer|action|move|choice|decision|direction";
    pattern(&format!(
        r#"(?i)\b(?:(?:{verbs})|(?:{nouns})[ \t]+(?:is|would[ \t]+be|will[ \t]+be|should[ \t]+be)[ \t]*:?)[ \t]+(?:(?:{between})[ \t]+){{0,3}}[*`"']{{0,3}}(?P<word>up|left|down|right)\b(?P<now>[ \t]+(?:now|away))?"#
    ))
});

/// The result of reading one decision.
#[derive(Clone, Copy, Debug)]
enum Found<'a> {
    Plain(Action, Stage),
    Unknown(&'a str),
    Several,
    Unclear,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Tag,
    Box,
    Json,
    Alone,
    Word,
}

impl Kind {
    fn stage(self, is_led: bool) -> Stage {
        match self {
            Kind::Tag => Stage::Tag,
            Kind::Box | Kind::Alone => Stage::Words,
            Kind::Json => Stage::Json,
            Kind::Word if is_led => Stage::Line,
            Kind::Word => Stage::Marker,
        }
    }
}

/// A decision, with its position in the answer.
#[derive(Clone, Copy, Debug)]
struct Decision<'a> {
    found: Found<'a>,
    at: usize,
    /// The position up to which the text has been read.
    end: usize,
    kind: Kind,
}

/// Reads a normalised answer that does not follow the requested format. First reads the decisions that a tag or a word
/// such as "action" introduces. If the last of them contains an unknown word, also reads the text after it. If no
/// decision is introduced, reads the entire answer.
pub(super) fn read<'a>(said: &'a str, listed: &[Action]) -> Option<(Chosen<'a>, Stage)> {
    let places: Vec<usize> = MARK.find_iter(said).map(|found| found.start()).collect();
    let marks = &places[places.len().saturating_sub(DECISIONS)..];
    let marks = marks.iter().filter_map(|&at| marked_at(said, &MARK.captures_at(said, at)?, listed));
    let marked = settle(said, &marks.collect::<Vec<_>>());
    let from = match marked {
        None => 0,
        Some(Decision { found: Found::Unknown(word), end, .. }) if !is_number(word) => end,
        Some(decision) => return Some(decision.chosen(said)),
    };
    let unmarked = |pattern: &Regex, stage| {
        let found = pattern.captures_iter(&said[from..]).filter_map(|found| {
            let (at, word) = (from + found.get(0)?.start(), found.name("word")?);
            unmarked(said, at, from + word.start()..from + word.end(), stage, listed)
        });
        settle(said, &found.collect::<Vec<_>>())
    };
    let by_word = if marked.is_none() { unmarked(&MARKED_BY_WORD, Stage::Marker) } else { None };
    let loose = by_word.or_else(|| unmarked(&SPELLED, Stage::Reference)).or_else(|| words(said, from));
    loose.or(marked).map(|decision| decision.chosen(said))
}

impl<'a> Decision<'a> {
    /// Returns the decision's choice, or [`Chosen::Unclear`] if the text after the decision retracts it.
    fn chosen(&self, said: &str) -> (Chosen<'a>, Stage) {
        match self.found {
            Found::Plain(_, stage) if self.kind != Kind::Json && phrase::retracts(&said[self.end..]) => {
                (Chosen::Unclear, stage)
            }
            Found::Plain(action, stage) => (Chosen::Action(action), stage),
            Found::Unknown(word) => (Chosen::Unknown(word), Stage::Marker),
            Found::Several => (Chosen::Several, Stage::Marker),
            Found::Unclear => (Chosen::Unclear, Stage::Marker),
        }
    }
}

/// Reads the decision after an introduction such as "action:". Returns `None` if no decision follows.
fn marked_at<'a>(said: &'a str, mark: &Captures<'a>, listed: &[Action]) -> Option<Decision<'a>> {
    let whole = mark.get(0)?;
    let name = mark.name("tag").or(mark.name("key")).map_or("", |name| name.as_str()).to_ascii_lowercase();
    let is_json = mark.name("quote").is_some_and(|quote| !quote.is_empty());
    let kind = match (mark.name("tag"), mark.name("box")) {
        (Some(_), _) => Kind::Tag,
        (_, Some(_)) => Kind::Box,
        _ if is_json => Kind::Json,
        _ => Kind::Word,
    };
    if name.ends_with('s') && kind != Kind::Json {
        return None;
    }
    let (at, line) = (whole.start(), line_before(said, whole.start()));
    let near = &said[whole.end()..boundary(said, whole.end() + MAX_SCANNED)];
    let (skipped, text) = match kind {
        Kind::Tag => (0, near.split('<').next()?),
        Kind::Box => (0, near.split(['}', '\n']).next()?),
        Kind::Json => {
            let value = VALUE.captures(near)?;
            let text = (1..value.len()).find_map(|group| value.get(group))?;
            (text.start(), text.as_str())
        }
        // Inside quotation marks, the decision ends at the closing quotation mark.
        Kind::Word | Kind::Alone if line.matches('"').count() % 2 == 1 => {
            (0, near.split(['"', '\n']).next()?)
        }
        Kind::Word | Kind::Alone => (0, near.lines().next().unwrap_or_default()),
    };
    let end = whole.end() + skipped + text.len();
    let is_action = name.contains("action");
    let read = match kind {
        Kind::Tag if text.trim().contains('\n') => in_several_lines(text),
        Kind::Json if near.trim_start().starts_with('{') => in_object(text),
        _ => phrase::read(text, is_action.then_some(listed)),
    };
    let is_alone = kind != Kind::Word || line.chars().all(|c| " \t*#>`_-".contains(c));
    let found = match read {
        Phrase::Plain { choice, is_led } => Found::Plain(choice, kind.stage(is_led)),
        Phrase::Several => Found::Several,
        Phrase::Unclear => Found::Unclear,
        Phrase::Unknown(word) if is_action && is_alone => Found::Unknown(word),
        Phrase::Unknown(_) | Phrase::Empty => return None,
    };
    let context = match kind {
        Kind::Json => phrase::context(&name),
        // The introduction itself may show that the action lies in the past, as `last_action` does.
        _ => phrase::context(&said[at - line.len()..at + name.len()]),
    };
    match context {
        Context::Free if is_action || kind != Kind::Word || phrase::leads(line) => {
            Some(Decision { found, at, end, kind })
        }
        Context::Negated => Some(Decision { found: Found::Unclear, at, end, kind }),
        Context::Free | Context::Aside => None,
    }
}

/// Reads a JSON object that represents an action, such as `{"name": "left"}`.
fn in_object(text: &str) -> Phrase<'_> {
    let mut named = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').filter_map(action_of);
    match named.next() {
        None => Phrase::Empty,
        Some(choice) if named.all(|other| other == choice) && phrase::context(text) == Context::Free => {
            Phrase::Plain { choice, is_led: false }
        }
        Some(_) => Phrase::Unclear,
    }
}

/// Reads the content of a tag that spans several lines. One of the lines may introduce the decision again, such as with
/// "action:".
fn in_several_lines(text: &str) -> Phrase<'_> {
    if phrase::names_other(text, None) { Phrase::Unclear } else { Phrase::Empty }
}

/// Reads the action at `word`, which is not introduced by a tag or a word such as "action". The decision starts at
/// `at`.
fn unmarked<'a>(
    said: &'a str,
    at: usize,
    word: Range<usize>,
    stage: Stage,
    listed: &[Action],
) -> Option<Decision<'a>> {
    let line = said[word.start..boundary(said, word.start + MAX_SCANNED)].lines().next().unwrap_or_default();
    let found = match phrase::read(line, Some(listed)) {
        Phrase::Plain { choice, .. } => Found::Plain(choice, stage),
        Phrase::Several => Found::Several,
        Phrase::Unknown(word) => Found::Unknown(word),
        Phrase::Unclear | Phrase::Empty => return None,
    };
    let found = match phrase::context(line_before(said, at)) {
        Context::Free => found,
        Context::Aside => return None,
        Context::Negated => Found::Unclear,
    };
    Some(Decision { found, at, end: word.end, kind: Kind::Word })
}

/// Returns the action that the last lines state without the word "action", if any.
fn words<'a>(said: &'a str, from: usize) -> Option<Decision<'a>> {
    let from = from.max(last_lines(said));
    let tail = &said[from..];
    let alone = ALONE.captures_iter(tail).filter_map(|found| {
        let (whole, word) = (found.get(0)?, found.name("word")?);
        let action = action_of(word.as_str())?;
        // `I would never choose` on the preceding line negates the action.
        let before = said[..from + whole.start()].trim_end();
        let is_free = phrase::context(line_before(said, before.len())) != Context::Negated;
        let (at, end) = (from + word.start(), from + word.end());
        is_free.then_some(Decision { found: Found::Plain(action, Stage::Words), at, end, kind: Kind::Alone })
    });
    let stated = STATED.captures_iter(tail).filter_map(|found| {
        let word = found.name("word").filter(|_| found.name("now").is_none())?;
        let (at, end) = (from + found.get(0)?.start(), from + word.end());
        let line = line_before(said, at);
        let rest = said[end..boundary(said, end + MAX_SCANNED)].lines().next().unwrap_or_default();
        let choice = action_of(word.as_str())?;
        let found = match phrase::tail(rest, choice) {
            None if phrase::context(line) == Context::Free && phrase::leads(line) => {
                Found::Plain(choice, Stage::Words)
            }
            Some(Phrase::Several) => Found::Several,
            _ => return None,
        };
        Some(Decision { found, at, end, kind: Kind::Word })
    });
    let mut found: Vec<Decision<'a>> = alone.chain(stated).collect();
    found.sort_by_key(|decision| decision.at);
    settle(said, &found)
}

/// Returns the last of several decisions, or [`Found::Several`] if a related decision differs. Decisions are
/// related if they are on the same line, or if all of them are tags, boxes, or actions alone on a line.
fn settle<'a>(said: &str, found: &[Decision<'a>]) -> Option<Decision<'a>> {
    let (last, earlier) = found.split_last()?;
    let Found::Plain(choice, _) = last.found else { return Some(*last) };
    let belongs = |other: &&Decision<'_>| {
        let is_near = !said[other.at..last.at].contains('\n');
        is_near || other.kind == last.kind && matches!(last.kind, Kind::Tag | Kind::Box | Kind::Alone)
    };
    let mut belonging = earlier.iter().rev().take(DECISIONS).filter(belongs);
    let differs = belonging.any(|other| match other.found {
        Found::Plain(action, _) => action != choice,
        Found::Several => true,
        Found::Unknown(_) | Found::Unclear => false,
    });
    Some(Decision { found: if differs { Found::Several } else { last.found }, ..*last })
}

/// Returns the byte offset at which the last [`LAST_LINES`] non-empty lines start.
fn last_lines(said: &str) -> usize {
    let from = boundary(said, said.len().saturating_sub(MAX_SCANNED * LAST_LINES));
    let mut starts = vec![from];
    starts.extend(said[from..].match_indices('\n').map(|(at, _)| from + at + 1));
    let is_full = |at: &&usize| said[**at..].lines().next().is_some_and(|line| !line.trim().is_empty());
    starts.iter().rev().filter(is_full).take(LAST_LINES).last().copied().unwrap_or(from)
}

/// Returns the part of a line before `at`, truncated to [`MAX_SCANNED`] bytes.
pub(super) fn line_before(said: &str, at: usize) -> &str {
    let from = boundary(said, at.saturating_sub(MAX_SCANNED));
    let near = &said[from..at];
    &near[near.rfind('\n').map_or(0, |end| end + 1)..]
}
