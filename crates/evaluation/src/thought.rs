//! Budgets of thought: the limit on the output tokens of each answer, including reasoning.

use crate::client::ChatReply;

/// The start of the flag, such as `max-output-tokens=500`, that states the budget in a player's aids.
const AID: &str = "max-output-tokens=";

/// A limit on the length of each answer, as prompts state it. An answer that exceeds the limit counts as no answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnswerLimit {
    /// The maximum number of output tokens, including reasoning. Servers count the tokens.
    Tokens(u32),
    /// The maximum number of words, for players that answer through files. The words count unless the player states a
    /// count of its own.
    Words(u32),
}

impl AnswerLimit {
    /// Returns the maximum number of tokens or words.
    pub fn most(self) -> u64 {
        match self {
            AnswerLimit::Tokens(most) | AnswerLimit::Words(most) => u64::from(most),
        }
    }

    /// Returns `true` if the answer exceeds the limit.
    pub(crate) fn is_exceeded(self, answer: &ChatReply) -> bool {
        thought(answer.usage.output_tokens, &answer.text, answer.reasoning.as_deref()) > self.most()
    }
}

/// Returns the budget of thought, such as `max-output-tokens=500`, in the notation of a player's aids.
pub fn budget_aid(max_output_tokens: u32) -> String {
    format!("{AID}{max_output_tokens}")
}

/// Returns `true` if an aid states a budget of thought.
pub(crate) fn is_budget_aid(aid: &str) -> bool {
    aid.starts_with(AID)
}

/// Returns the amount of thought in an answer: the reported number of output tokens, or the number of words in the
/// answer and its reasoning if no number was reported.
pub(crate) fn thought(reported: Option<u64>, text: &str, reasoning: Option<&str>) -> u64 {
    let words = |text: &str| text.split_whitespace().count() as u64;
    reported.unwrap_or_else(|| words(text) + reasoning.map_or(0, words))
}

/// Returns the count that a player states in the first line of its answer, as in `Tokens: 812`; `None` if there is no
/// such line.
pub(crate) fn stated_count(text: &str) -> Option<u64> {
    let (name, count) = text.lines().next()?.split_once(':')?;
    name.trim().eq_ignore_ascii_case("tokens").then(|| count.trim().parse().ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::client::{Finish, Usage};

    #[test]
    fn words_stand_in_for_tokens() {
        let answer = |text: &str, reasoning: Option<&str>, output_tokens| ChatReply {
            reasoning: reasoning.map(str::to_owned),
            usage: Usage { output_tokens, ..Usage::default() },
            ..ChatReply::new(text.to_owned(), Finish::Stop)
        };
        let check = |answer: ChatReply, most: u32, exceeds: bool| {
            assert_eq!(AnswerLimit::Tokens(most).is_exceeded(&answer), exceeds, "{answer:?}");
        };
        check(answer("go up\nACTION: up", None, None), 4, false);
        check(answer("go up\nACTION: up", Some("two words"), None), 5, true);
        check(answer("go up\nACTION: up", Some("two words"), Some(5)), 5, false);
        check(answer("ACTION: up", None, Some(6)), 5, true);
    }

    #[test]
    fn counts_are_stated_in_the_first_line() {
        assert_eq!(stated_count("Tokens: 812\nACTION: up"), Some(812));
        assert_eq!(stated_count(" tokens : 7 "), Some(7));
        for other in ["", "ACTION: up\nTokens: 812", "Tokens: many", "Tokens: -1", "My tokens: 3"] {
            assert_eq!(stated_count(other), None, "{other}");
        }
    }
}
