//! Turns that are over, and how many of them a conversation still shows.

use crate::answer;
use crate::tokens;
use engine::Action;

/// Bytes of an answer that later turns are shown, from its end.
const REMEMBERED: usize = 2_000;

/// What stands for an answer of no words: providers refuse empty messages.
const NO_ANSWER: &str = "(no answer)";

/// An answer that was given within a turn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Attempt {
    /// The words, raw.
    pub answer: String,
    /// What was said to it, if it could not be used and another one was asked for.
    pub complaint: Option<String>,
}

/// A turn that is over.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Past {
    pub(super) shown: String,
    pub(super) attempts: Vec<Attempt>,
    pub(super) played: Action,
    /// Tokens of what was shown.
    shown_tokens: u64,
    /// Tokens of the whole turn.
    pub(super) tokens: u64,
}

impl Past {
    /// What was shown ([`Prompt::shown`](super::Prompt::shown)), what was answered, and what was played in the end.
    /// Of answers only what is remembered of them is kept: their end, reasoning left out. A turn without an answer has an
    /// empty one, and to the last one nothing is said: providers want the two sides of a conversation to take turns.
    pub fn new(shown: String, attempts: &[Attempt], played: Action) -> Past {
        let mut attempts = kept(attempts);
        match attempts.last_mut() {
            Some(last) => last.complaint = None,
            None => attempts.push(Attempt { answer: NO_ANSWER.to_owned(), complaint: None }),
        }
        let shown_tokens = cost(&shown);
        let tokens = shown_tokens + spoken(&attempts);
        Past { shown, attempts, played, shown_tokens, tokens }
    }
}

/// What conversations show of answers.
pub(super) fn kept(attempts: &[Attempt]) -> Vec<Attempt> {
    let kept = |attempt: &Attempt| Attempt {
        answer: remembered(&attempt.answer),
        complaint: attempt.complaint.clone(),
    };
    attempts.iter().map(kept).collect()
}

/// Tokens of a message.
pub(super) fn cost(text: &str) -> u64 {
    tokens::count(text) + tokens::PER_MESSAGE
}

/// Tokens of answers and complaints.
pub(super) fn spoken(attempts: &[Attempt]) -> u64 {
    let one = |attempt: &Attempt| cost(&attempt.answer) + attempt.complaint.as_deref().map_or(0, cost);
    attempts.iter().map(one).sum()
}

/// What a conversation shows of an earlier answer.
fn remembered(answer: &str) -> String {
    let said = answer::without_reasoning(answer).trim();
    if said.is_empty() {
        return NO_ANSWER.to_owned();
    }
    let start = answer::boundary(said, said.len().saturating_sub(REMEMBERED));
    if start == 0 { said.to_owned() } else { format!("…{}", &said[start..]) }
}

/// The first past turn that is still shown. `fixed`: tokens of the static part; `now`: of the newest turn, which together
/// with the static part is shown in any case. As soon as the budget would be exceeded, so many of the oldest turns go that
/// a quarter of it becomes free: in between, a conversation only grows at its end, and providers can take its start from
/// their caches. Cost: O(turns).
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
