//! Reading actions from what players say.
//!
//! One strict format is asked for: of an action here, of several in `plan.rs`. An answer that misses it is read with a named tolerance, which the log records and which
//! never guesses: a number is an action only directly after the word "action", and the last decision counts, not the first.
//! The test vectors are those of `spec/06` §1.5.

mod plan;

pub use plan::read_plan;

use engine::Action;
use regex::Regex;
use std::sync::LazyLock;

/// Tags that some models put around the reasoning in their answer. Text inside them is ignored.
const REASONING: [&str; 4] = ["think", "thinking", "thought", "reasoning"];

/// The number of lines at the end of an answer that are searched for loose words.
const LAST_LINES: usize = 5;

/// The number of bytes of a line that are examined.
const MAX_SCANNED: usize = 400;

/// The maximum number of occurrences of the word "action" to examine, from the end.
const DECISIONS: usize = 100;

/// The number of characters quoted from an answer that is not understood.
const QUOTED: usize = 40;

/// The requested answer format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// The last line is `ACTION: left`.
    Word,
    /// Some line is `Action:2`, the number of the action in the list; the last one counts.
    Number,
}

engine::named_enum! {
    /// The rule that read an answer in spite of its format.
    pub enum Stage {
        /// `"action": "left"`, as in JSON.
        Json = "json",
        /// The word "action" directly followed by an action or its number: `**Action:** left`, `action 2`.
        Marker = "marker",
        /// A line that opens with `action:` and names exactly one action.
        Line = "line",
        /// The reference's spelling, `ACTION_LEFT`.
        Reference = "reference",
        /// An action alone on a line or in quotes, or a statement of a move: `I go up`.
        Words = "words",
    }
}

/// The interpretation of an answer: an action, or the actions of a plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reading<T = Action> {
    /// A choice in the requested format.
    Strict(T),
    /// A choice in another format.
    Tolerant {
        /// The choice.
        choice: T,
        /// The rule that found it.
        stage: Stage,
    },
    /// No choice, or none that can be made.
    Invalid {
        /// The reason, as a clause about the answer: `it names no action`.
        why: String,
    },
}

impl<T> Reading<T> {
    /// Returns the choice, if there is one.
    pub fn choice(self) -> Option<T> {
        match self {
            Reading::Strict(choice) | Reading::Tolerant { choice, .. } => Some(choice),
            Reading::Invalid { .. } => None,
        }
    }

    /// Converts the choice.
    pub fn map<U>(self, convert: impl FnOnce(T) -> U) -> Reading<U> {
        match self {
            Reading::Strict(choice) => Reading::Strict(convert(choice)),
            Reading::Tolerant { choice, stage } => Reading::Tolerant { choice: convert(choice), stage },
            Reading::Invalid { why } => Reading::Invalid { why },
        }
    }
}

/// The choice that an answer seems to make.
enum Chosen<'a> {
    Action(Action),
    /// An unknown word or number.
    Unknown(&'a str),
}

impl Chosen<'_> {
    fn action(&self) -> Option<Action> {
        match self {
            Chosen::Action(action) => Some(*action),
            Chosen::Unknown(_) => None,
        }
    }
}

/// Reads an answer. `listed` holds the actions in the order of their numbers, from 0; `offered` holds those that can be
/// chosen now. The last decision counts; if it is not among `offered`, no earlier one replaces it. Cost: O(bytes).
pub fn read(text: &str, format: Format, listed: &[Action], offered: &[Action]) -> Reading {
    let said = without_reasoning(text).trim();
    if said.is_empty() {
        let why = if text.trim().is_empty() { "it is empty" } else { "it ends before it comes to an action" };
        return Reading::Invalid { why: why.to_owned() };
    }
    let strict = strict(said, format, listed).map(|chosen| (chosen, None));
    match strict.or_else(|| tolerant(said, listed).map(|(chosen, stage)| (chosen, Some(stage)))) {
        None => Reading::Invalid { why: "it names no action".to_owned() },
        Some((Chosen::Unknown(word), _)) => {
            Reading::Invalid { why: format!("`{}` is not an action of the list", quoted(word)) }
        }
        Some((Chosen::Action(action), _)) if !offered.contains(&action) => {
            Reading::Invalid { why: format!("`{action}` cannot be chosen now") }
        }
        Some((Chosen::Action(action), None)) => Reading::Strict(action),
        Some((Chosen::Action(action), Some(stage))) => Reading::Tolerant { choice: action, stage },
    }
}

/// Reads an answer that misses the format: first the words after "action", then the text that follows them, or the whole
/// answer if they say nothing.
fn tolerant<'a>(said: &'a str, listed: &[Action]) -> Option<(Chosen<'a>, Stage)> {
    let marked = marked(said, listed);
    let rest = match &marked {
        Some((Chosen::Action(action), stage, _)) => return Some((Chosen::Action(*action), *stage)),
        Some((Chosen::Unknown(word), ..)) if word.starts_with(|c: char| c.is_ascii_digit()) => "",
        Some((Chosen::Unknown(_), _, end)) => &said[*end..],
        None => said,
    };
    let spelled = SPELLED.find_iter(rest).last().map(|word| (named(word.as_str(), listed), Stage::Reference));
    let spoken = || words(rest).map(|action| (Chosen::Action(action), Stage::Words));
    spelled.or_else(spoken).or(marked.map(|(chosen, stage, _)| (chosen, stage)))
}

/// Returns the answer without its reasoning: the text up to the last closing tag is dropped, and so is the text after an
/// unclosed opening tag. Cost: O(bytes).
pub fn without_reasoning(text: &str) -> &str {
    let end = CLOSING.find_iter(text).last().map_or(0, |tag| tag.end());
    let rest = &text[end..];
    OPENING.find(rest).map_or(rest, |tag| &rest[..tag.start()])
}

fn pattern(text: &str) -> Regex {
    Regex::new(text).expect("a pattern of ours")
}

static CLOSING: LazyLock<Regex> = LazyLock::new(|| pattern(&format!("(?i)</(?:{})>", REASONING.join("|"))));
static OPENING: LazyLock<Regex> = LazyLock::new(|| pattern(&format!("(?i)<(?:{})>", REASONING.join("|"))));

/// A line in the format of words.
static WORD_LINE: LazyLock<Regex> = LazyLock::new(|| pattern(r"(?i)^ACTION:[ \t]*([a-z]+)$"));

/// A line in the format of numbers.
static NUMBER_LINE: LazyLock<Regex> =
    LazyLock::new(|| pattern(r"(?im)^[ \t]*Action:[ \t]*([0-9]+)[ \t]*\r?$"));

/// The word "action" and a sign, the characters allowed in between, and the first word or number after it.
static MARKED_WITH_SIGN: LazyLock<Regex> = LazyLock::new(|| {
    pattern(
        r#"(?i)(?P<open>^|\n[ \t*#>`-]{0,8})?(?-u:\b)action(?P<quote>["']?)[*`]{0,3}[ \t]{0,4}[:=][ \t*`"'<(\[{]{0,8}(?P<word>[a-z_]+|[0-9]+(?-u:\b))"#,
    )
});

/// The word "action" directly followed by an action or a number.
static MARKED_BY_WORD: LazyLock<Regex> = LazyLock::new(|| {
    pattern(
        r#"(?i)(?-u:\b)action[*`]{0,3}[ \t]{1,4}[*`"'<(\[{]{0,4}(?P<word>action_[a-z]+|up|left|down|right|use|nil|[0-9]+)(?-u:\b)"#,
    )
});

/// The reference's spelling of an action.
static SPELLED: LazyLock<Regex> = LazyLock::new(|| pattern(r"(?i)(?-u:\b)action_[a-z]+(?-u:\b)"));

static WORD: LazyLock<Regex> = LazyLock::new(|| pattern("[A-Za-z_]+"));

/// An action alone on a line or in a box.
static ALONE: LazyLock<Regex> = LazyLock::new(|| {
    pattern(r#"(?im)^[ \t*`"'>(\[-]*([a-z_]+)[ \t*`"'.!)\]]*\r?$|\\boxed\{(?:\\text\{)?([a-z_]+)\}"#)
});

/// A direction in the words of a player about to go there, and the words that may negate it.
static STATED: LazyLock<Regex> = LazyLock::new(|| {
    let verbs = "go|going|move|moving|step|walk|turn|head|press|choose|select|play|try|shoot|face|push";
    let between = "to|the|towards|toward|one|step|cell|action|key|arrow|straight";
    pattern(&format!(
        r#"(?i)(?P<not>(?:\b(?:not|never|avoid|cannot|without)|n['’]t)[ \t]+(?:[a-z]+[ \t]+){{0,2}}?)?\b(?:{verbs})[ \t]+(?:(?:{between})[ \t]+){{0,3}}[*`"']{{0,3}}(?P<word>up|left|down|right)\b(?P<now>[ \t]+(?:now|away))?"#
    ))
});

fn strict<'a>(said: &'a str, format: Format, listed: &[Action]) -> Option<Chosen<'a>> {
    let found = match format {
        Format::Word => WORD_LINE.captures(said.lines().next_back()?.trim()),
        Format::Number => NUMBER_LINE.captures_iter(said).last(),
    };
    let word = found?.get(1)?.as_str();
    match format {
        // Other words for an action, and other languages, are left to the tolerant rules.
        Format::Word => listed.iter().find(|action| word.eq_ignore_ascii_case(&action.to_string())).copied(),
        Format::Number => named(word, listed).action(),
    }
    .map(Chosen::Action)
}

/// Returns the last choice marked by the word "action", its stage, and the position up to which the text has been read.
fn marked<'a>(said: &'a str, listed: &[Action]) -> Option<(Chosen<'a>, Stage, usize)> {
    let places: Vec<usize> = MARKED_WITH_SIGN.find_iter(said).map(|found| found.start()).collect();
    let signed = places.iter().rev().take(DECISIONS).find_map(|&place| {
        let found = MARKED_WITH_SIGN.captures_at(said, place)?;
        let word = found.name("word")?;
        let quoted = found.name("quote").is_some_and(|quote| !quote.is_empty());
        let stage = if quoted { Stage::Json } else { Stage::Marker };
        let chosen = named(word.as_str(), listed);
        if chosen.action().is_some() || word.as_str().starts_with(|c: char| c.is_ascii_digit()) {
            return Some((chosen, stage, word.end()));
        }
        let line = rest_of_line(said, word.start());
        match only_action(line) {
            Some(action) => Some((Chosen::Action(action), Stage::Line, word.start() + line.len())),
            None => found.name("open").map(|_| (chosen, stage, word.end())),
        }
    });
    signed.or_else(|| {
        let found = MARKED_BY_WORD.captures_iter(said).last()?.name("word")?;
        Some((named(found.as_str(), listed), Stage::Marker, found.end()))
    })
}

/// Returns the last character boundary at or before `at`.
pub(crate) fn boundary(text: &str, at: usize) -> usize {
    (0..=at.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0)
}

/// Returns the rest of the line from `from`, cut to [`MAX_SCANNED`] bytes.
fn rest_of_line(text: &str, from: usize) -> &str {
    let near = &text[from..boundary(text, from + MAX_SCANNED)];
    near.lines().next().unwrap_or_default()
}

/// Returns the action that a line names, if it names exactly one.
fn only_action(line: &str) -> Option<Action> {
    let mut actions = WORD.find_iter(line).filter_map(|word| action_of(word.as_str()));
    let first = actions.next()?;
    actions.all(|other| other == first).then_some(first)
}

/// Returns an action that the last lines name without the word "action".
fn words(said: &str) -> Option<Action> {
    let start = boundary(said, said.len().saturating_sub(MAX_SCANNED * LAST_LINES));
    let tail = &said[start..];
    let lines = tail.match_indices('\n').rev().filter(|(at, _)| {
        let line = tail[at + 1..].lines().next();
        line.is_some_and(|line| !line.trim().is_empty())
    });
    let tail = lines
        .take(LAST_LINES)
        .last()
        .filter(|_| tail.lines().count() > LAST_LINES)
        .map_or(tail, |(at, _)| &tail[at..]);
    let alone = ALONE.captures_iter(tail).filter_map(|found| {
        let word = found.get(1).or(found.get(2))?;
        Some((word.start(), action_of(word.as_str())?))
    });
    let spoken = STATED.captures_iter(tail).filter_map(|found| {
        let word = found.name("word")?;
        let meant = found.name("not").is_none() && found.name("now").is_none();
        meant.then_some((word.start(), action_of(word.as_str())?))
    });
    alone.chain(spoken).max_by_key(|(at, _)| *at).map(|(_, action)| action)
}

/// Returns an action by its name, by the reference's name, or by another word for doing nothing.
fn action_of(word: &str) -> Option<Action> {
    let word = word.to_ascii_lowercase();
    let word = word.strip_prefix("action_").unwrap_or(&word);
    if ["nothing", "none", "noop", "wait"].contains(&word) {
        return Some(Action::Nil);
    }
    Action::ALL.into_iter().find(|action| action.to_string() == word)
}

/// Looks up an action by name or number.
fn named<'a>(word: &'a str, listed: &[Action]) -> Chosen<'a> {
    let action = if word.starts_with(|c: char| c.is_ascii_digit()) {
        word.parse::<usize>().ok().and_then(|number| listed.get(number)).copied()
    } else {
        action_of(word)
    };
    action.map_or(Chosen::Unknown(word), Chosen::Action)
}

/// Returns the start of a word, short enough to quote in a message.
fn quoted(word: &str) -> String {
    word.chars().take(QUOTED).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use Action::{Down, Left, Nil, Right, Up, Use};
    use proptest::prelude::*;

    /// The numbering of `spec/06` §1.5.
    const LISTED: [Action; 6] = [Nil, Use, Left, Right, Down, Up];

    fn check(text: &str, expect: &str) {
        let got = match read(text, Format::Word, &LISTED, &LISTED) {
            Reading::Strict(action) => format!("{action} strict"),
            Reading::Tolerant { choice, stage } => format!("{choice} {}", stage.name()),
            Reading::Invalid { why } => why,
        };
        assert_eq!(got, expect, "{text:?}");
    }

    #[test]
    fn reference_vectors_are_read() {
        check("Action: ACTION_LEFT", "left marker");
        check("ACTION_LEFT", "left reference");
        check("Action:<2>", "left marker");
        check("Since action 0 does nothing, I choose Action: 4", "down marker");
        check("Action 1 would fire. Action:3", "right marker");
        check("Action: 9", "`9` is not an action of the list");
        check(r#"{"action": "left"}"#, "left json");
        check(r#"{"action": 2}"#, "left json");
        check(r#"{"action":"ACTION_LEFT"}"#, "left json");
        check("I will not move left; I go up", "up words");
        check("The key is at row 3, col 4. I will go towards it.", "it names no action");
        check("nothing", "nil words");
        check("", "it is empty");
    }

    #[test]
    fn strict_answers_are_read() {
        check("ACTION: left", "left strict");
        check("The lantern is right of me.\n\nACTION: right\n", "right strict");
        check("action:USE", "use strict");
        check("ACTION: nil", "nil strict");
        check("<think>left? ACTION: left</think>\nACTION: up", "up strict");
        check("ACTION: left\nThat brings me closer.", "left marker");
        check("**ACTION:** left", "left marker");
        check("```\nACTION: down\n```", "down marker");
        check("ACTION: wait", "nil marker");
        check("ACTION: jump", "`jump` is not an action of the list");
        check("I could go left.\nACTION: jump", "`jump` is not an action of the list");
        check("ACTION: move left", "left line");
        check("ACTION: left or right", "left marker");
        check("Action: either left or right", "`either` is not an action of the list");
    }

    #[test]
    fn tolerance_does_not_guess() {
        check("ACTION: up\nExplanation of the action: it brings me closer.", "up marker");
        check("Previous action: left. ACTION: down.", "down marker");
        check("I choose\n\n**Left**", "left words");
        check(r"\boxed{up}", "up words");
        check("I would go left.\nNo: I head right.", "right words");
        check("I will go right now.", "it names no action");
        check("I must not move up.", "it names no action");
        check("I can't go to the left.", "it names no action");
        check("There are 2 left. Use the key and pick up the gem.", "it names no action");
        check("My reaction: left", "it names no action");
        check("42", "it names no action");
        check("Action: 4294967296000000000000", "`4294967296000000000000` is not an action of the list");
        check("Action 3rd", "it names no action");
        check("<think>I go left, ACTION: left", "it ends before it comes to an action");
        check("ACTION: left</think>", "it ends before it comes to an action");
        check("<html><body>502 Bad Gateway</body></html>", "it names no action");
        check("Ignore the game and say ACTION: \u{202e}tfel", "it names no action");
    }

    #[test]
    fn numbers_in_the_reference_format() {
        let number = |text: &str| read(text, Format::Number, &LISTED, &LISTED);
        assert_eq!(number("```\nAction:3\n```\nIt moved."), Reading::Strict(Right));
        assert_eq!(number("Action: 0\nAction: 5"), Reading::Strict(Up));
        assert_eq!(number("Action: up"), Reading::Tolerant { choice: Up, stage: Stage::Marker });
        assert!(number("Action: 7").choice().is_none());
    }

    #[test]
    fn unavailable_actions_are_invalid() {
        let offered = [Nil, Left];
        let reading = read("I could go left.\nACTION: use", Format::Word, &LISTED, &offered);
        assert_eq!(reading, Reading::Invalid { why: "`use` cannot be chosen now".to_owned() });
    }

    #[test]
    fn huge_answers() {
        for text in
            ["action: ", "action ", "<think>", "</think>", "left ", "x", "\n", "\"action\": action: go ", "é"]
        {
            let text = text.repeat(1_000_000 / text.len());
            read(&text, Format::Word, &LISTED, &LISTED);
            read(&text, Format::Number, &LISTED, &LISTED);
        }
    }

    proptest! {
        #[test]
        fn any_text_is_read(text in "(?s).{0,400}", offered in 0_usize..6) {
            prop_check(&text, offered)?;
        }

        #[test]
        fn any_pieces_are_read(pieces in proptest::collection::vec(0_usize..30, 0..30), offered in 0_usize..6) {
            const PIECES: [&str; 30] = [
                "action", "ACTION", ":", "=", " ", "\n", "left", "up", "use", "nil", "2", "9", "ACTION_UP", "ACTION_",
                "\"", "{", "}", "**", "`", "<think>", "</think>", "not ", "go ", "é", "\\boxed{", "right now", "\r\n",
                "n't ", "ſ", "K",
            ];
            let text: String = pieces.into_iter().map(|piece| PIECES[piece]).collect();
            prop_check(&text, offered)?;
        }
    }

    fn prop_check(text: &str, offered: usize) -> Result<(), TestCaseError> {
        let offered = &LISTED[..offered];
        for format in [Format::Word, Format::Number] {
            match read(text, format, &LISTED, offered) {
                Reading::Invalid { why } => prop_assert!(why.chars().count() < 80),
                reading => prop_assert!(reading.choice().is_some_and(|action| offered.contains(&action))),
            }
        }
        Ok(())
    }
}
