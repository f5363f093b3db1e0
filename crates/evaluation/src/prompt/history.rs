//! An episode's past turns, and the choice of the turns that a conversation still shows.

use crate::answer;
use crate::tokens;
use engine::Action;

/// The maximum number of bytes of an answer to show in later turns. Longer answers lose their beginning.
const MAX_ANSWER: usize = 2_000;

/// The text that replaces an empty answer, because providers reject empty messages.
const NO_ANSWER: &str = "(no answer)";

/// An answer given within a turn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Attempt {
    /// The raw text of the answer.
    pub answer: String,
    /// The message about the answer, if the answer was unusable and a new answer was requested.
    pub complaint: Option<String>,
}

/// A past turn, as shown in later prompts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Past {
    pub(super) shown: String,
    pub(super) attempts: Vec<Attempt>,
    pub(super) played: Action,
    shown_tokens: u64,
    pub(super) tokens: u64,
}

impl Past {
    /// Creates a past turn from the shown text ([`Prompt::shown`](super::Prompt::shown)), the answers, and
    /// the action played.
    ///
    /// Only the end of each answer is retained, without reasoning. Providers require roles to alternate in a
    /// conversation. Therefore, a turn without an answer gets a placeholder, and the message about the last
    /// answer is dropped.
    pub fn new(shown: String, attempts: &[Attempt], played: Action) -> Past {
        let mut attempts = kept(attempts);
        match attempts.last_mut() {
            Some(last) => last.complaint = None,
            None => attempts.push(Attempt { answer: NO_ANSWER.to_owned(), complaint: None }),
        }
        let shown_tokens = cost(&shown);
        let tokens = shown_tokens + answer_tokens(&attempts);
        Past { shown, attempts, played, shown_tokens, tokens }
    }
}

/// Returns answers as shown in conversations.
pub(super) fn kept(attempts: &[Attempt]) -> Vec<Attempt> {
    let kept = |attempt: &Attempt| Attempt {
        answer: shortened(&attempt.answer),
        complaint: attempt.complaint.clone(),
    };
    attempts.iter().map(kept).collect()
}

/// Returns the number of tokens in a message, including the overhead per message.
pub(super) fn cost(text: &str) -> u64 {
    tokens::count(text) + tokens::PER_MESSAGE
}

pub(super) fn answer_tokens(attempts: &[Attempt]) -> u64 {
    let one = |attempt: &Attempt| cost(&attempt.answer) + attempt.complaint.as_deref().map_or(0, cost);
    attempts.iter().map(one).sum()
}

/// Returns an earlier answer as shown in a conversation.
fn shortened(answer: &str) -> String {
    let said = answer::without_reasoning(answer).trim();
    if said.is_empty() {
        return NO_ANSWER.to_owned();
    }
    let start = answer::boundary(said, said.len().saturating_sub(MAX_ANSWER));
    if start == 0 { said.to_owned() } else { format!("…{}", &said[start..]) }
}

/// Returns the index of the first past turn that is still shown. `fixed` is the number of tokens in the
/// static part, and `now` is the number of tokens in the newest turn. The static part and the newest turn are
/// always shown.
///
/// Whenever the budget would be exceeded, the oldest turns are dropped until a quarter of the budget is free.
/// Between two such cuts, a conversation grows only at its end, so providers can cache its beginning. Cost:
/// O(turns).
pub(super) fn first_kept(past: &[Past], fixed: u64, now: u64, budget: u64) -> usize {
    let (mut start, mut kept) = (0, 0);
    let current = past.iter().map(|turn| turn.shown_tokens).chain([now]);
    for (number, shown) in current.enumerate() {
        if fixed + kept + shown > budget {
            while start < number && fixed + kept + shown > budget - budget / 4 {
                kept -= past[start].tokens;
                start += 1;
            }
        }
        kept += past.get(number).map_or(0, |turn| turn.tokens);
    }
    start
}
