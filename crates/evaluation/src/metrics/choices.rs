//! The validity and costs of an episode's choices.

use crate::log::{Event, ReplyClass};
use crate::player::Validity;
use serde::Serialize;

/// The number of steps by the validity of their choice. The counts add up to the total number of steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Choices {
    /// The number of steps whose action was chosen by an answer in the requested format, or by a player that
    /// does not answer prompts.
    pub valid: u64,
    /// The number of steps whose action was chosen by an answer in a different format, read by a tolerant
    /// rule.
    pub tolerant: u64,
    /// The number of steps in which the player did nothing because no answer could be read.
    pub invalid: u64,
    /// The number of steps in which the player did nothing because it refused to answer.
    pub refused: u64,
    /// The number of steps in which the player did nothing because its answer was cut off.
    pub truncated: u64,
}

impl Choices {
    /// Counts a log's choices by validity.
    pub fn of(log: &[Event]) -> Choices {
        let mut choices = Choices::default();
        let mut class = None;
        // The answer class of the plan being played.
        let mut planned = None;
        for event in log {
            match event {
                Event::Reply(reply) => class = Some(reply.class),
                Event::Plan { .. } => planned = class.take(),
                Event::Step { validity, .. } => {
                    let count = match (validity, class.take().or(planned)) {
                        (Validity::Valid, Some(ReplyClass::Tolerant)) => &mut choices.tolerant,
                        (Validity::Valid, _) => &mut choices.valid,
                        (Validity::Invalid, _) => &mut choices.invalid,
                        (Validity::Refused, _) => &mut choices.refused,
                        (Validity::Truncated, _) => &mut choices.truncated,
                    };
                    *count += 1;
                }
                _ => {}
            }
        }
        choices
    }

    /// Returns the total number of steps.
    pub fn total(&self) -> u64 {
        self.valid + self.tolerant + self.invalid + self.refused + self.truncated
    }

    /// Adds the counts in `other` to these counts.
    pub fn add(&mut self, other: &Choices) {
        self.valid += other.valid;
        self.tolerant += other.tolerant;
        self.invalid += other.invalid;
        self.refused += other.refused;
        self.truncated += other.truncated;
    }
}

/// The cost of an episode's answers. Token counts are as reported by the provider. A sum is `None` if any
/// answer lacks the count, or if there are no answers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Spending {
    /// The number of requests sent, whether or not they were answered. Requests that a cap forbids are not
    /// sent.
    pub requests: u64,
    /// The number of answers.
    pub replies: u64,
    /// The number of cached answers. Their tokens are counted, although cached answers cost nothing.
    pub cached_replies: u64,
    /// The number of failed tries that preceded answers.
    pub failures: u64,
    /// The number of prompt tokens.
    pub input_tokens: Option<u64>,
    /// The number of prompt tokens read from the provider's cache.
    pub cached_input_tokens: Option<u64>,
    /// The number of answer tokens, including reasoning.
    pub output_tokens: Option<u64>,
    /// The number of answer tokens used for reasoning.
    pub reasoning_tokens: Option<u64>,
}

impl Spending {
    /// Sums up the costs of the answers in a log.
    pub fn of(log: &[Event]) -> Spending {
        let replies: Vec<_> = log
            .iter()
            .filter_map(|event| match event {
                Event::Reply(reply) => Some(reply),
                _ => None,
            })
            .collect();
        let sum = |of: fn(&crate::client::Usage) -> Option<u64>| {
            let mut each = replies.iter().map(|reply| of(&reply.usage));
            let sum = each.try_fold(0u64, |sum, tokens| Some(sum.saturating_add(tokens?)));
            sum.filter(|_| !replies.is_empty())
        };
        Spending {
            requests: requests(log),
            replies: replies.len() as u64,
            cached_replies: replies.iter().filter(|reply| reply.cached).count() as u64,
            failures: replies.iter().map(|reply| reply.failures.len() as u64).sum(),
            input_tokens: sum(|usage| usage.input_tokens),
            cached_input_tokens: sum(|usage| usage.cached_input_tokens),
            output_tokens: sum(|usage| usage.output_tokens),
            reasoning_tokens: sum(|usage| usage.reasoning_tokens),
        }
    }

    /// Adds the costs in `other` to these costs. An episode without answers adds nothing.
    pub fn add(&mut self, other: &Spending) {
        if other.replies > 0 {
            let first = self.replies == 0;
            let sum = |a: Option<u64>, b: Option<u64>| if first { b } else { Some(a?.saturating_add(b?)) };
            self.input_tokens = sum(self.input_tokens, other.input_tokens);
            self.cached_input_tokens = sum(self.cached_input_tokens, other.cached_input_tokens);
            self.output_tokens = sum(self.output_tokens, other.output_tokens);
            self.reasoning_tokens = sum(self.reasoning_tokens, other.reasoning_tokens);
        }
        self.requests += other.requests;
        self.replies += other.replies;
        self.cached_replies += other.cached_replies;
        self.failures += other.failures;
    }
}

/// Returns the number of requests in a log that were actually sent.
///
/// Requests are recorded before it is known whether a cap allows them. When the evaluation is resumed, a
/// request that a cap had forbidden is sent without being recorded again.
fn requests(log: &[Event]) -> u64 {
    let (mut sent, mut is_open) = (0, false);
    for event in log {
        match event {
            Event::Request { .. } => (sent, is_open) = (sent + 1, true),
            Event::Halt { reason, .. } if reason == "budget" && is_open => {
                (sent, is_open) = (sent - 1, false)
            }
            Event::Reply(_) => (sent, is_open) = (sent + u64::from(!is_open), false),
            _ => {}
        }
    }
    sent
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::client::{Finish, Usage};
    use crate::log::Reply;

    #[test]
    fn sums_of_tokens_saturate() {
        let huge = Spending { replies: 1, input_tokens: Some(u64::MAX), ..Spending::default() };
        let mut all = huge;
        all.add(&huge);
        assert_eq!(all.input_tokens, Some(u64::MAX));
        let mut unknown = Spending { replies: 1, ..Spending::default() };
        unknown.add(&huge);
        assert_eq!(unknown.input_tokens, None, "one answer does not tell");
    }

    #[test]
    fn requests_rejected_by_a_cap_are_not_counted() {
        let ask = || Event::Request { step: 0, attempt: 0, messages: Vec::new(), tokens: 9 };
        let halt = |reason: &str| Event::Halt { reason: reason.to_owned(), message: String::new() };
        let reply = || {
            Event::Reply(Reply {
                step: 0,
                attempt: 0,
                class: ReplyClass::Strict,
                text: String::new(),
                reasoning: None,
                action: None,
                plan: None,
                stage: None,
                finish: Finish::Stop,
                usage: Usage::default(),
                served_by: None,
                failures: Vec::new(),
                cached: false,
                latency_ms: 0.0,
            })
        };
        let check = |log: &[Event], sent: u64| assert_eq!(Spending::of(log).requests, sent);
        check(&[ask(), reply(), ask(), halt("budget")], 1);
        check(&[ask(), reply(), ask(), halt("budget"), halt("budget"), reply()], 2);
        check(&[ask(), halt("infrastructure"), reply(), ask(), halt("infrastructure")], 2);
        check(&[halt("budget"), ask(), reply()], 1);
    }
}
