//! Spending caps for an evaluation, shared by all its threads.

use super::estimate::Estimate;
use super::prices::{Price, Usd};
use crate::client::chat::Usage;
use crate::log::Event;
use crate::tokens;
use std::sync::{Mutex, MutexGuard};

/// The spending limits. `None` means no limit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Limits {
    /// The maximum cost, computed from the price table.
    pub cost: Option<Usd>,
    /// The maximum number of tokens in prompts and answers.
    pub tokens: Option<u64>,
    /// The maximum number of answered requests. All tries of one request count as one request.
    pub requests: Option<u64>,
}

/// The amounts spent by an evaluation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Spent {
    /// The number of answered requests.
    pub requests: u64,
    /// The number of tokens in prompts and answers.
    pub tokens: u64,
    /// The total cost of all requests with known prices.
    pub cost: Usd,
}

/// Enforces an evaluation's limits.
///
/// A request is allowed if the total of its prompt, the prompts in flight and the amounts spent does not
/// exceed the limits. The request is charged once, according to the usage in its reply, or to a local count
/// of its text if the reply reports no usage. An answer's cost is not known in advance, so the answers in
/// flight can exceed a limit after it is reached. Failed tries are not charged, because their cost is not
/// reported.
#[derive(Debug)]
pub struct Caps {
    limits: Limits,
    price: Option<Price>,
    ledger: Mutex<Ledger>,
}

#[derive(Debug, Default)]
struct Ledger {
    spent: Spent,
    /// The amounts reserved for prompts in flight.
    reserved: Spent,
}

impl Caps {
    /// Creates caps with the given limits. `price` is the model's price, or `None` if it is unknown.
    pub fn new(limits: Limits, price: Option<Price>) -> Caps {
        Caps { limits, price, ledger: Mutex::default() }
    }

    /// Returns the amounts spent so far, excluding requests in flight.
    pub fn spent(&self) -> Spent {
        self.ledger().spent
    }

    /// Charges the amounts that an episode's log recorded in earlier runs of the program. Cached answers are
    /// free.
    pub fn charge_logged(&self, events: &[Event]) {
        let mut prompt = 0;
        for event in events {
            match event {
                Event::Request { tokens, .. } => prompt = *tokens,
                Event::Reply(reply) if !reply.cached => {
                    let charge = self.charge(&reply.usage, prompt, &reply.text, reply.reasoning.as_deref());
                    let mut ledger = self.ledger();
                    ledger.spent = ledger.spent.plus(charge);
                }
                _ => {}
            }
        }
    }

    /// Admits a request whose prompt has about `prompt` tokens.
    ///
    /// # Errors
    /// Returns a message stating the limit that the request would exceed.
    pub(in crate::client) fn reserve(&self, prompt: u64) -> Result<Reservation<'_>, String> {
        let usage = Usage { input_tokens: Some(prompt), output_tokens: Some(0), ..Usage::default() };
        let cost = self.price.as_ref().and_then(|price| price.cost(&usage)).unwrap_or_default();
        let amount = Spent { requests: 1, tokens: prompt, cost };
        let mut ledger = self.ledger();
        let reserved = ledger.reserved.plus(amount);
        if let Some(problem) = self.limits.exceeded(&ledger.spent.plus(reserved)) {
            // The message omits the amount spent, because requests in flight are not charged yet. The final
            // report states the amount.
            return Err(format!("the next request would exceed {problem}"));
        }
        ledger.reserved = reserved;
        drop(ledger);
        Ok(Reservation { caps: self, amount, prompt })
    }

    fn charge(&self, usage: &Usage, prompt: u64, text: &str, reasoning: Option<&str>) -> Spent {
        let counted = || tokens::count(text) + reasoning.map_or(0, tokens::count);
        let usage = Usage {
            input_tokens: usage.input_tokens.or(Some(prompt)),
            output_tokens: usage.output_tokens.or_else(|| Some(counted())),
            ..*usage
        };
        let counts = [usage.input_tokens, usage.output_tokens];
        Spent {
            requests: 1,
            tokens: counts.into_iter().flatten().fold(0, u64::saturating_add),
            cost: self.price.as_ref().and_then(|price| price.cost(&usage)).unwrap_or_default(),
        }
    }

    fn ledger(&self) -> MutexGuard<'_, Ledger> {
        self.ledger.lock().expect("nothing panics while it holds the ledger")
    }
}

impl Limits {
    /// Returns the limit that the given amounts would exceed, written as its command-line option; `None` if they stay
    /// within all limits.
    fn exceeded(&self, spent: &Spent) -> Option<String> {
        if let Some(limit) = self.cost.filter(|limit| spent.cost > *limit) {
            return Some(format!("--max-cost {limit}"));
        }
        if let Some(limit) = self.tokens.filter(|limit| spent.tokens > *limit) {
            return Some(format!("--max-tokens {limit}"));
        }
        let limit = self.requests.filter(|limit| spent.requests > *limit)?;
        Some(format!("--max-requests {limit}"))
    }

    /// Returns the limit that an evaluation is estimated to exceed in total, written as its command-line
    /// option. Dry runs report this limit.
    pub fn exceeded_by_estimate(&self, estimate: &Estimate) -> Option<String> {
        let tokens = estimate.input_tokens.saturating_add(estimate.output_tokens);
        self.exceeded(&Spent { requests: estimate.requests, tokens, cost: estimate.cost.unwrap_or_default() })
    }
}

impl Spent {
    fn plus(self, other: Spent) -> Spent {
        Spent {
            requests: self.requests.saturating_add(other.requests),
            tokens: self.tokens.saturating_add(other.tokens),
            cost: self.cost.plus(other.cost),
        }
    }

    fn minus(self, other: Spent) -> Spent {
        Spent {
            requests: self.requests.saturating_sub(other.requests),
            tokens: self.tokens.saturating_sub(other.tokens),
            cost: self.cost.minus(other.cost),
        }
    }
}

/// A reservation for a request in flight. Dropping a reservation before it is settled charges nothing.
#[derive(Debug)]
#[must_use]
pub(in crate::client) struct Reservation<'a> {
    caps: &'a Caps,
    amount: Spent,
    prompt: u64,
}

impl Reservation<'_> {
    pub(in crate::client) fn settle(mut self, usage: &Usage, text: &str, reasoning: Option<&str>) {
        let charge = self.caps.charge(usage, self.prompt, text, reasoning);
        // Releasing the reservation and charging the request happen in one step, so that the request is never
        // counted twice.
        let amount = std::mem::take(&mut self.amount);
        let mut ledger = self.caps.ledger();
        ledger.reserved = ledger.reserved.minus(amount);
        ledger.spent = ledger.spent.plus(charge);
    }
}

impl Drop for Reservation<'_> {
    fn drop(&mut self) {
        let mut ledger = self.caps.ledger();
        ledger.reserved = ledger.reserved.minus(self.amount);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::client::chat::Finish;
    use crate::log::{Reply, ReplyClass};

    fn price() -> Price {
        Price { input: 1.0, cached_input: 0.5, cache_write: 1.0, output: 10.0, as_of: String::new() }
    }

    fn usage(input: u64, output: u64) -> Usage {
        Usage { input_tokens: Some(input), output_tokens: Some(output), ..Usage::default() }
    }

    #[test]
    fn each_limit_rejects_a_request() {
        let check = |limits: Limits, words: &str| {
            let caps = Caps::new(limits, Some(price()));
            caps.reserve(100).unwrap().settle(&usage(100, 10), "", None);
            let problem = caps.reserve(100).unwrap_err();
            assert!(problem.contains(words), "{problem}");
            assert_eq!((caps.spent().requests, caps.spent().tokens), (1, 110));
        };
        check(Limits { requests: Some(1), ..Limits::default() }, "--max-requests 1");
        check(Limits { tokens: Some(209), ..Limits::default() }, "--max-tokens 209");
        check(Limits { cost: Usd::from_dollars(0.000299), ..Limits::default() }, "--max-cost $0.0003");
        let caps = Caps::new(Limits { tokens: Some(210), ..Limits::default() }, None);
        caps.reserve(100).unwrap().settle(&usage(100, 10), "", None);
        caps.reserve(100).unwrap().settle(&usage(100, 0), "", None);
        assert_eq!(caps.spent(), Spent { requests: 2, tokens: 210, cost: Usd::default() });
    }

    #[test]
    fn requests_in_flight_count_until_they_fail() {
        let caps = Caps::new(Limits { requests: Some(1), ..Limits::default() }, None);
        let reservation = caps.reserve(5).unwrap();
        assert!(caps.reserve(5).is_err());
        drop(reservation);
        assert_eq!(caps.spent(), Spent::default());
        assert!(caps.reserve(5).is_ok());
    }

    #[test]
    fn missing_usage_is_estimated() {
        let caps = Caps::new(Limits::default(), Some(price()));
        caps.reserve(50).unwrap().settle(&Usage::default(), "Action: up, I say", None);
        let spent = caps.spent();
        assert!(spent.tokens > 50 && spent.tokens < 60 && spent.cost > Usd::default(), "{spent:?}");
    }

    #[test]
    fn logged_requests_are_charged_once() {
        let reply = |cached| {
            Event::Reply(Reply {
                step: 0,
                attempt: 0,
                class: ReplyClass::Strict,
                text: "up".to_owned(),
                reasoning: None,
                action: None,
                plan: None,
                stage: None,
                finish: Finish::Stop,
                usage: usage(100, 10),
                served_by: None,
                failures: Vec::new(),
                cached,
                latency_ms: 0.0,
            })
        };
        let request = || Event::Request { step: 0, attempt: 0, messages: Vec::new(), tokens: 90 };
        let first = Caps::new(Limits::default(), Some(price()));
        first.reserve(90).unwrap().settle(&usage(100, 10), "up", None);
        let again = Caps::new(Limits::default(), Some(price()));
        again.charge_logged(&[request(), reply(false), request(), reply(true), request()]);
        assert_eq!(again.spent(), first.spent());
    }

    #[test]
    fn threads_do_not_spend_past_the_limit() {
        let caps = Caps::new(Limits { requests: Some(10), ..Limits::default() }, None);
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    for _ in 0..10 {
                        if let Ok(reservation) = caps.reserve(1) {
                            reservation.settle(&usage(1, 1), "", None);
                        }
                    }
                });
            }
        });
        assert_eq!(caps.spent(), Spent { requests: 10, tokens: 20, cost: Usd::default() });
    }
}
