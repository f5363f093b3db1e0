//! Finished drafts of games, with their measures and costs.

use crate::known::Nearest;
use crate::stages::Stage;
use base::Digest;
use evaluation::client::{Price, Usage};
use evaluation::log::Event;
use evaluation::tokens;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use validators::{Criterion, Tier};

/// The maximum number of corrections in each stage.
pub const MAX_REPAIRS: u32 = 3;

base::named_enum! {
    /// The result of a draft.
    pub enum Status {
        /// The game meets all criteria and is new.
        Accepted = "accepted",
        /// An answer still had a problem after all corrections of its stage, or the server rejected a question.
        GivenUp = "given_up",
    }
}

/// A finished draft.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Draft {
    /// The index of the draft, starting at 0.
    pub number: u64,
    /// The outcome of the draft.
    pub status: Status,
    /// The stage in which the draft ended.
    pub stage: Stage,
    /// The last problem in one line, or `None` for an accepted game.
    pub problem: Option<String>,
    /// The game's name, or `None` if no idea was accepted.
    pub name: Option<String>,
    /// The idea, or `None` if no idea was accepted.
    pub idea: Option<String>,
    /// The number of corrections, by stage. Stages that were not reached are absent.
    pub repairs: BTreeMap<Stage, u32>,
    /// The findings about the last version of the game.
    pub measures: DraftMeasures,
    /// The answers, tokens and money that the draft used.
    pub spending: Spending,
    /// The digest of all answers, in the order in which they were given.
    pub answers: Digest,
    /// The last rules that compiled; `None` if no rules did.
    pub rules: Option<String>,
    /// The last levels that loaded with these rules.
    pub levels: Vec<String>,
}

/// The findings about the last version of a draft's game.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DraftMeasures {
    /// `true` if the rules compile.
    pub compiles: bool,
    /// The nearest known game, if the rules compile and any game is known.
    pub nearest: Option<Nearest>,
    /// `true` if the requested number of levels load.
    pub loads: bool,
    /// The number of levels for which a win was found.
    pub won: usize,
    /// For each criterion, `true` if the game or all of its levels meet it. Empty if the levels do not load.
    pub criteria: BTreeMap<Criterion, bool>,
    /// The tier (difficulty class from 1 to 4) of the last level, if a tier is required and a win was found.
    pub tier: Option<Tier>,
}

/// The costs of a draft.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spending {
    /// The number of answers.
    pub answers: u64,
    /// The number of tokens in all questions, as reported by the provider, or else counted locally.
    pub input_tokens: u64,
    /// The number of tokens in all answers.
    pub output_tokens: u64,
    /// The price of all answers in US dollars, including cached answers, or `None` if the price is unknown.
    pub cost: Option<f64>,
}

impl Draft {
    /// Returns `true` if the game was accepted.
    pub fn is_accepted(&self) -> bool {
        self.status == Status::Accepted
    }
}

/// Returns the digest of the answers in a log, in the log's order. It does not depend on times or interruptions.
pub(crate) fn digest(events: &[Event]) -> Digest {
    let answers = events.iter().filter_map(|event| match event {
        Event::Reply(reply) => Some((reply.step, reply.attempt, &reply.text)),
        _ => None,
    });
    let answers = serde_json::to_vec(&answers.collect::<Vec<_>>()).expect("answers are plain data");
    Digest::of(&answers)
}

impl Spending {
    pub(crate) fn of(events: &[Event], price: Option<&Price>) -> Spending {
        let mut spending = Spending { cost: price.map(|_| 0.0), ..Spending::default() };
        let mut question = 0;
        for event in events {
            match event {
                Event::Request { tokens, .. } => question = *tokens,
                Event::Reply(reply) => {
                    let counted =
                        || tokens::count(&reply.text) + reply.reasoning.as_deref().map_or(0, tokens::count);
                    let input = reply.usage.input_tokens.unwrap_or(question);
                    let output = reply.usage.output_tokens.unwrap_or_else(counted);
                    let usage =
                        Usage { input_tokens: Some(input), output_tokens: Some(output), ..reply.usage };
                    spending.answers += 1;
                    spending.input_tokens = spending.input_tokens.saturating_add(input);
                    spending.output_tokens = spending.output_tokens.saturating_add(output);
                    let cost = price.and_then(|price| price.cost(&usage)).map(|cost| cost.dollars());
                    spending.cost = spending.cost.zip(cost).map(|(sum, cost)| sum + cost);
                }
                _ => {}
            }
        }
        spending
    }
}
