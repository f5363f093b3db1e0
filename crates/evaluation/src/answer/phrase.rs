//! Reads a phrase that states an action: the text after the word "action", the content of a tag, or a JSON
//! value. A phrase consists of words that introduce an action, the action itself, and optionally an
//! explanation. A phrase with any other word is rejected, so the parser never guesses.

use super::read::{action_of, pattern};
use engine::Action;
use regex::{Match, Regex};
use std::sync::LazyLock;

/// The result of reading a phrase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phrase<'a> {
    Plain {
        choice: Action,
        /// `true` if other words precede the action, as in `move left`.
        is_led: bool,
    },
    /// The phrase states several actions.
    Several,
    /// The phrase states an action, but negates it, judges it, or says something else about it.
    Unclear,
    /// The phrase begins with the given word or number, and does not state an action.
    Unknown(&'a str),
    Empty,
}

/// The effect that the text around a phrase has on the phrase's action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Context {
    Free,
    /// The phrase is not about the player's next action.
    Aside,
    Negated,
}

static TOKEN: LazyLock<Regex> =
    LazyLock::new(|| pattern(r"(?P<word>[\p{L}\p{N}_]+(?:['-][\p{L}\p{N}]+)*)|(?P<sign>\S)"));

static LETTERS: LazyLock<Regex> = LazyLock::new(|| pattern("[A-Za-z]+"));

/// Words that retract an action or a plan.
static RETRACTION: LazyLock<Regex> = LazyLock::new(|| {
    pattern(
        r"(?i)\b(?:actually|scratch that|on second thought|correction|never ?mind|oops|let me (?:reconsider|rethink|correct)|instead[ \t]*(?:[,.;:!]|$))",
    )
});

static SECOND_THOUGHT: LazyLock<Regex> =
    LazyLock::new(|| pattern(r"(?i)\b(?:wait|no|hmm)\b[ \t]*(?:[,.!:—–]|-[ \t])"));

/// Words that may precede an action.
const LEAD: [&str; 68] = [
    "action",
    "answer",
    "choice",
    "decision",
    "move",
    "direction",
    "output",
    "final",
    "next",
    "best",
    "optimal",
    "correct",
    "chosen",
    "selected",
    "my",
    "the",
    "is",
    "to",
    "i",
    "i'll",
    "i'd",
    "i'm",
    "we",
    "we'll",
    "we're",
    "let",
    "let's",
    "me",
    "us",
    "will",
    "would",
    "shall",
    "should",
    "must",
    "need",
    "want",
    "like",
    "have",
    "am",
    "are",
    "going",
    "gonna",
    "go",
    "moving",
    "step",
    "walk",
    "turn",
    "head",
    "face",
    "press",
    "push",
    "hit",
    "choose",
    "select",
    "pick",
    "play",
    "take",
    "do",
    "decide",
    "decided",
    "think",
    "try",
    "so",
    "then",
    "now",
    "therefore",
    "towards",
    "player",
];

/// Words that may follow an action without changing its meaning.
const AFTER: [&str; 10] =
    ["key", "arrow", "button", "direction", "now", "again", "once", "please", "action", "first"];

/// Words that introduce a reason.
const REASONS: [&str; 7] = ["because", "since", "as", "so", "to", "toward", "towards"];

/// Words that continue the sentence after an action.
const PREPOSITIONS: [&str; 20] = [
    "for", "in", "into", "onto", "through", "past", "along", "around", "at", "on", "by", "from", "with",
    "until", "over", "off", "out", "via", "across", "and",
];

/// Words that introduce an alternative or a second action.
const JOINS: [&str; 13] = [
    "or",
    "and",
    "then",
    "plus",
    "followed",
    "maybe",
    "perhaps",
    "possibly",
    "probably",
    "alternatively",
    "not",
    "never",
    "no",
];

/// Words that turn a phrase into a statement about its action, rather than a choice.
const JUDGING: [&str; 12] =
    ["is", "isn't", "was", "wasn't", "would", "could", "might", "may", "if", "unless", "but", "otherwise"];

const NEGATIONS: [&str; 29] = [
    "not",
    "never",
    "no",
    "cannot",
    "dont",
    "cant",
    "wont",
    "shouldnt",
    "avoid",
    "avoiding",
    "without",
    "neither",
    "nor",
    "or",
    "except",
    "unless",
    "if",
    "instead",
    "rather",
    "wrong",
    "bad",
    "worse",
    "worst",
    "impossible",
    "illegal",
    "invalid",
    "unavailable",
    "against",
    "refuse",
];

/// Words that mark an action as a past action, or as one of several listed actions.
const ASIDES: [&str; 15] = [
    "previous",
    "last",
    "prior",
    "earlier",
    "past",
    "recent",
    "available",
    "possible",
    "legal",
    "valid",
    "allowed",
    "example",
    "format",
    "options",
    "alternative",
];

fn is_negation(word: &str) -> bool {
    NEGATIONS.contains(&word) || word.ends_with("n't")
}

fn words(text: &str) -> impl Iterator<Item = String> + '_ {
    TOKEN.captures_iter(text).filter_map(|token| {
        let word = token.name("word")?;
        Some(word.as_str().trim_matches('_').to_ascii_lowercase())
    })
}

/// Returns `true` if a text states an action other than `choice`. If `choice` is `None`, any action counts.
pub(super) fn names_other(text: &str, choice: Option<Action>) -> bool {
    let mut named = LETTERS.find_iter(text).filter_map(|word| action_of(word.as_str()));
    named.any(|action| choice != Some(action))
}

/// Returns `true` if a text retracts the preceding action.
pub(super) fn retracts(text: &str) -> bool {
    retracts_plan(text) || SECOND_THOUGHT.is_match(text)
}

/// Returns `true` if a text retracts the preceding plan. The word `wait` alone does not retract a plan,
/// because it can be one of the plan's actions.
pub(super) fn retracts_plan(text: &str) -> bool {
    RETRACTION.is_match(text)
}

/// Reads a phrase. `listed` maps numbers to actions, or is `None` if a number cannot be a choice in this
/// phrase.
pub(super) fn read<'a>(text: &'a str, listed: Option<&[Action]>) -> Phrase<'a> {
    let (mut unknown, mut is_led, mut is_minus) = (None, false, false);
    for token in TOKEN.captures_iter(text) {
        let Some(word) = token.name("word") else {
            let sign = &token["sign"];
            is_minus = sign == "-";
            if !"*`\"'~$([{<>#:=-→⇒\\".contains(sign) {
                unknown = unknown.or(Some(&text[..0]));
            }
            continue;
        };
        let name = word.as_str().trim_matches('_');
        let is_number = name.bytes().all(|byte| byte.is_ascii_digit()) && !name.is_empty();
        let action = match (is_number, listed) {
            (true, Some(listed)) if !is_led && unknown.is_none() => {
                let number = name.parse::<usize>().ok().filter(|_| !is_minus);
                match number.and_then(|number| listed.get(number)) {
                    Some(&action) if is_whole(&text[word.end()..]) => Some(action),
                    Some(_) => return Phrase::Unclear,
                    None => return Phrase::Unknown(word.as_str()),
                }
            }
            _ => action_of(name),
        };
        match action {
            Some(choice) if unknown.is_none() => {
                return match tail(&text[word.end()..], choice) {
                    None => Phrase::Plain { choice, is_led },
                    Some(flaw) => flaw,
                };
            }
            Some(_) => break,
            None if LEAD.contains(&name.to_ascii_lowercase().as_str()) => is_led = true,
            None => unknown = unknown.filter(|known| !known.is_empty()).or(Some(word.as_str())),
        }
    }
    let mut named = LETTERS.find_iter(text).filter_map(|word| action_of(word.as_str()));
    match named.next() {
        Some(first) if named.any(|other| other != first) => Phrase::Several,
        Some(_) => Phrase::Unclear,
        None => match unknown.filter(|word| !word.is_empty()) {
            Some(word) => Phrase::Unknown(word),
            // The phrase contains words that introduce an action, but no action.
            None => TOKEN
                .captures_iter(text)
                .find_map(|token| token.name("word"))
                .map_or(Phrase::Empty, |word: Match<'a>| Phrase::Unknown(word.as_str())),
        },
    }
}

/// Returns `false` if a number continues after its first digits, as in `3,4` or `2.5`.
fn is_whole(rest: &str) -> bool {
    let rest = rest.trim_start_matches([' ', '\t']);
    let mut signs = rest.chars();
    let goes_on = signs.next().is_some_and(|sign| ",./:x×-".contains(sign));
    !(goes_on && signs.as_str().trim_start().starts_with(|c: char| c.is_ascii_digit()))
}

/// Checks the text between an action and the end of the line. Returns `None` if the text leaves the choice
/// unchanged.
pub(super) fn tail<'a>(rest: &str, choice: Action) -> Option<Phrase<'a>> {
    let flaw = || if names_other(rest, Some(choice)) { Phrase::Several } else { Phrase::Unclear };
    for token in TOKEN.captures_iter(rest) {
        if let Some(word) = token.name("word") {
            let after = &rest[word.end()..];
            let name = word.as_str().trim_matches('_').to_ascii_lowercase();
            let name = name.as_str();
            match action_of(name) {
                Some(other) if other == choice => continue,
                Some(_) => return Some(Phrase::Several),
                None => {}
            }
            if AFTER.contains(&name) {
                continue;
            }
            if REASONS.contains(&name) {
                return reason(after, choice);
            }
            if PREPOSITIONS.contains(&name) {
                return (is_denied(after, choice) || retracts(after)).then(flaw);
            }
            return Some(flaw());
        }
        let sign = token.name("sign")?;
        let after = &rest[sign.end()..];
        match sign.as_str() {
            "*" | "`" | "\"" | "'" | "~" | "$" | ")" | "]" | "}" | ">" | "\\" => {}
            "<" => return None,
            "/" | "|" | "&" | "+" => return words(after).next().map(|_| flaw()),
            "?" => return Some(flaw()),
            "." | "!" | ";" => return explanation(after, choice, true),
            _ => return explanation(after, choice, false),
        }
    }
    None
}

fn reason<'a>(after: &str, choice: Action) -> Option<Phrase<'a>> {
    let is_range = words(after).next().and_then(|word| action_of(&word)).is_some_and(|other| other != choice);
    match is_range {
        true => Some(Phrase::Several),
        false => retracts(after).then_some(Phrase::Unclear),
    }
}

/// Checks the text after a punctuation mark, which is either a separate sentence or the rest of the same
/// sentence.
fn explanation<'a>(text: &str, choice: Action, is_sentence: bool) -> Option<Phrase<'a>> {
    let flaw = || if names_other(text, Some(choice)) { Phrase::Several } else { Phrase::Unclear };
    let first = words(text).next()?;
    let first = first.as_str();
    if action_of(first).is_some_and(|other| other != choice) {
        return Some(Phrase::Several);
    }
    if JOINS.contains(&first) || !is_sentence && JUDGING.contains(&first) || retracts(text) {
        return Some(flaw());
    }
    (!is_sentence && !REASONS.contains(&first) && is_denied(text, choice)).then(flaw)
}

/// Returns `true` if the first clause of a text negates something, or states a different action.
fn is_denied(text: &str, choice: Action) -> bool {
    let clause = text.split(['.', ';', '!', '?']).next().unwrap_or_default();
    names_other(clause, Some(choice))
        || words(clause).any(|word| is_negation(&word) || JUDGING.contains(&&*word))
}

/// Returns the context that the text `before` gives to the text after it.
pub(super) fn context(before: &str) -> Context {
    let clause = clause(before);
    let mut context = Context::Free;
    for (at, word) in words(clause).enumerate() {
        if is_negation(&word) || at > 0 && word == "but" {
            return Context::Negated;
        }
        if word.split('_').any(|part| ASIDES.contains(&part)) {
            context = Context::Aside;
        }
    }
    context
}

/// Returns `true` if the last clause of `before` introduces an action of the player, as `So I will` does and
/// `the ghost will` does not.
pub(super) fn leads(before: &str) -> bool {
    let words: Vec<String> = words(clause(before)).collect();
    let person = words.iter().rposition(|word| {
        matches!(word.as_str(), "i" | "i'll" | "i'd" | "i'm" | "we" | "we'll" | "we're" | "let's" | "let")
    });
    words[person.unwrap_or(0)..].iter().all(|word| LEAD.contains(&word.as_str()))
}

/// Returns the last clause of a line.
fn clause(line: &str) -> &str {
    static CUT: LazyLock<Regex> =
        LazyLock::new(|| pattern(r"(?i)[.;!?,\n→—–|]|\bno:|\b(?:so|thus|hence|therefore)\b"));
    let from = CUT.find_iter(line).last().map_or(0, |cut| cut.end());
    &line[from..]
}
