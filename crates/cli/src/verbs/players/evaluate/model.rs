//! The language-model flags, and the settings that they select.

use super::Args;
use super::prompt_args::PromptArgs;
use crate::failure::Failure;
use crate::flags::numbers::number;
use evaluation::client::{self, Batch, Decoding, Estimate, Limits, ModelOptions, ModelSettings, Usd};
use evaluation::prompt::{Mode, PromptSettings, Prompter};
use evaluation::run::Task;
use evaluation::{Commitment, Entrant, Observed, SeriesPlace, Subject};
use serde::Serialize;
use serde_json::json;
use std::collections::BTreeMap;
use std::num::{NonZeroU32, NonZeroU64, NonZeroUsize};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// The number of tokens per answer that dry runs assume if answers are not limited.
const ANSWER_TOKENS: u64 = 100;

/// The model, its requests, and the limits on their cost.
#[derive(clap::Args)]
#[command(next_help_heading = "Language models")]
pub(crate) struct ModelArgs {
    /// A language model: `openai:ID`, `anthropic:ID`, `gemini:ID`; any name with --base-url (see `arcade docs models`)
    #[arg(long, value_name = "ID")]
    pub(crate) model: Option<String>,
    /// Base URL of an OpenAI-compatible server: vLLM, llama.cpp, Ollama, `arcade serve-player`
    #[arg(long, value_name = "URL", requires = "model")]
    base_url: Option<String>,
    /// The environment variable that holds the key, if not the provider's usual one
    #[arg(long, value_name = "VARIABLE", requires = "model")]
    key_variable: Option<String>,
    /// Sampling temperature; not sent by default
    #[arg(long, value_name = "T", requires = "model", value_parser = number(0.0..=2.0))]
    temperature: Option<f64>,
    /// Nucleus sampling threshold; not sent by default
    #[arg(long, value_name = "P", requires = "model", value_parser = number(0.0..=1.0))]
    top_p: Option<f64>,
    /// Maximum number of tokens per answer, reasoning included
    #[arg(long, value_name = "N", requires = "model")]
    max_output_tokens: Option<u32>,
    /// The provider's sampling seed
    #[arg(long, value_name = "N", requires = "model")]
    sampling_seed: Option<u64>,
    /// `low`, `medium`, `high`, or another value that the provider accepts
    #[arg(long, value_name = "EFFORT", requires = "model")]
    reasoning_effort: Option<String>,
    /// Maximum number of repeated requests after an answer without a usable action
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) reasks: u32,
    /// Maximum US dollars to spend, according to the price table
    #[arg(long, value_name = "USD", requires = "model", value_parser = number(0.0..=1e9))]
    max_cost: Option<f64>,
    /// Maximum number of tokens to spend, prompts and answers together
    #[arg(long, value_name = "N", requires = "model")]
    max_tokens: Option<u64>,
    /// Maximum number of answered requests
    #[arg(long, value_name = "N", requires = "model")]
    max_requests: Option<u64>,
    /// TOML file with prices that override the embedded ones
    #[arg(long, value_name = "FILE", requires = "model")]
    prices: Option<PathBuf>,
    /// Folder for an answer cache, which is kept between evaluations
    #[arg(long, value_name = "DIR", requires = "model")]
    cache: Option<PathBuf>,
    /// Number of concurrent requests, and so of concurrent episodes [default: 4]
    #[arg(long, value_name = "N", requires = "model")]
    concurrency: Option<NonZeroUsize>,
    /// Maximum number of requests to start per minute
    #[arg(long, value_name = "N", requires = "model")]
    requests_per_minute: Option<NonZeroU64>,
    /// Maximum number of tokens per minute, requests and answers together
    #[arg(long, value_name = "N", requires = "model")]
    tokens_per_minute: Option<NonZeroU64>,
    /// Maximum number of tries per request [default: 8]
    #[arg(long, value_name = "N", requires = "model")]
    tries: Option<NonZeroU32>,
    /// Maximum number of seconds per try, or per answer of a program [default: 600]
    #[arg(long, value_name = "S", value_parser = clap::value_parser!(u64).range(1..), allow_negative_numbers = true)]
    pub(crate) timeout: Option<u64>,
    #[command(flatten)]
    pub(crate) prompt: PromptArgs,
}

/// Default values of flags that are rejected for players that they do not affect.
const CONCURRENCY: NonZeroUsize = NonZeroUsize::new(4).expect("the default is positive");
const TRIES: NonZeroU32 = NonZeroU32::new(8).expect("the default is positive");
const TIMEOUT: u64 = 600;

impl ModelArgs {
    /// Returns the first of the given flags that affects only language models, if any.
    pub(crate) fn unused_without_model(&self) -> Option<&'static str> {
        let given = [
            ("--base-url", self.base_url.is_some()),
            ("--key-variable", self.key_variable.is_some()),
            ("--temperature", self.temperature.is_some()),
            ("--top-p", self.top_p.is_some()),
            ("--max-output-tokens", self.max_output_tokens.is_some()),
            ("--sampling-seed", self.sampling_seed.is_some()),
            ("--reasoning-effort", self.reasoning_effort.is_some()),
            ("--max-cost", self.max_cost.is_some()),
            ("--max-tokens", self.max_tokens.is_some()),
            ("--max-requests", self.max_requests.is_some()),
            ("--prices", self.prices.is_some()),
            ("--cache", self.cache.is_some()),
            ("--requests-per-minute", self.requests_per_minute.is_some()),
            ("--tokens-per-minute", self.tokens_per_minute.is_some()),
            ("--concurrency", self.concurrency.is_some()),
            ("--tries", self.tries.is_some()),
        ];
        given.into_iter().find(|(_, is_given)| *is_given).map(|(flag, _)| flag)
    }

    /// Returns the number of concurrent requests.
    pub(crate) fn concurrency(&self) -> NonZeroUsize {
        self.concurrency.unwrap_or(CONCURRENCY)
    }

    /// Returns the time limit for a single try, or for a program's answer.
    pub(crate) fn timeout(&self) -> Duration {
        Duration::from_secs(self.timeout.unwrap_or(TIMEOUT))
    }

    fn options(&self, model: &str) -> Result<ModelOptions, Failure> {
        let cost = |dollars: f64| {
            Usd::from_dollars(dollars)
                .ok_or_else(|| malformed!("--max-cost takes an amount in US dollars, not {dollars}"))
        };
        let cost = self.max_cost.map(cost).transpose()?;
        Ok(ModelOptions {
            base_url: self.base_url.clone(),
            key_variable: self.key_variable.clone(),
            decoding: Decoding {
                temperature: self.temperature,
                top_p: self.top_p,
                max_output_tokens: self.max_output_tokens,
                seed: self.sampling_seed,
                reasoning_effort: self.reasoning_effort.clone(),
            },
            limits: Limits { cost, tokens: self.max_tokens, requests: self.max_requests },
            prices: self.prices.clone(),
            cache: self.cache.clone(),
            concurrency: self.concurrency(),
            requests_per_minute: self.requests_per_minute,
            tokens_per_minute: self.tokens_per_minute,
            tries: self.tries.unwrap_or(TRIES),
            timeout: self.timeout(),
            ..ModelOptions::new(model)
        })
    }
}

/// The games' prompters, by game ID.
type Prompters = BTreeMap<String, Arc<Prompter>>;

/// Creates the prompters for episodes of up to `max_steps` actions.
pub(super) fn prompters(
    subjects: &[Subject],
    settings: &PromptSettings,
    max_steps: u64,
    commit: Commitment,
) -> Result<Prompters, Failure> {
    let prompter = |subject: &Subject| {
        let prompter = Prompter::within(subject, settings.clone(), max_steps, commit)?;
        Ok((subject.id.clone(), Arc::new(prompter)))
    };
    subjects.iter().map(prompter).collect()
}

/// A requested model, not yet connected.
pub(crate) struct RequestedModel {
    options: ModelOptions,
    settings: ModelSettings,
    prompts: PromptSettings,
    reasks: u32,
}

pub(crate) struct ConnectedModel {
    model: Arc<dyn client::Model>,
    prompters: Prompters,
    decoding: Decoding,
    reasks: u32,
    /// `true` if the model's price is known. Otherwise, the cost is unknown.
    pub(crate) is_priced: bool,
    /// The spending so far, with its caps.
    pub(crate) caps: Arc<client::Caps>,
}

/// The cost of an evaluation, assuming that every episode reaches its step limit.
#[derive(Serialize)]
pub(crate) struct Forecast {
    episodes: u64,
    requests: u64,
    input_tokens: u64,
    cacheable_tokens: u64,
    output_tokens: u64,
    /// The cost in US dollars, or `None` if the price is unknown.
    cost: Option<f64>,
    cost_if_cached: Option<f64>,
    answer_tokens: u64,
    /// The maximum number of tokens per answer, or `None` if there is no limit.
    max_answer_tokens: Option<u64>,
    /// The number of output tokens, assuming that all answers are as long as possible.
    max_output_tokens: Option<u64>,
    /// The cost in US dollars, assuming that all answers are as long as possible.
    max_cost: Option<f64>,
    /// The number of requests, assuming that every episode lasts as long as its level's shortest known win.
    /// `None` if any level lacks a known win.
    estimated_requests: Option<u64>,
    /// The cost of the estimated requests in US dollars.
    estimated_cost: Option<f64>,
    /// The cap that the forecast exceeds, as text, or `None` if no cap is exceeded.
    forbidden: Option<String>,
}

impl RequestedModel {
    pub(crate) fn new(model: &str, args: &ModelArgs) -> Result<RequestedModel, Failure> {
        let options = args.options(model)?;
        let settings = client::settings(&options)?;
        client::price(&options)?;
        let (prompts, reasks) = (args.prompt.settings()?, args.reasks);
        Ok(RequestedModel { options, settings, prompts, reasks })
    }

    /// Returns the player's entry in results.
    pub(super) fn entrant(&self, subjects: &[Subject], args: &Args) -> Result<Entrant, Failure> {
        let digest = subjects
            .first()
            .map(|subject| self.prompter(subject, u64::MAX, args.commit).map(|own| own.digest()))
            .transpose()?;
        Ok(Entrant {
            name: args.name.clone().unwrap_or_else(|| self.settings.model.clone()),
            mode: Some(self.prompts.mode.name().to_owned()),
            aids: args.model.prompt.aids(&self.prompts),
            details: json!({
                "model": self.settings,
                "prompt": self.prompts,
                "prompt_digest": digest,
                "reasks": self.reasks,
            }),
        })
    }

    fn prompter(&self, subject: &Subject, max_steps: u64, commit: Commitment) -> Result<Prompter, Failure> {
        Prompter::within(subject, self.prompts.clone(), max_steps, commit).map_err(Failure::from)
    }

    /// Connects without sending a request, so that a missing key is reported before anything is written.
    pub(crate) fn connect(
        &self,
        subjects: &[Subject],
        max_steps: u64,
        commit: Commitment,
    ) -> Result<ConnectedModel, Failure> {
        let connection = client::connect(&self.options)?;
        Ok(ConnectedModel {
            model: Arc::from(connection.model),
            prompters: prompters(subjects, &self.prompts, max_steps, commit)?,
            decoding: connection.settings.decoding,
            reasks: self.reasks,
            is_priced: connection.price.is_some(),
            caps: connection.caps,
        })
    }

    /// Estimates the cost, assuming that each episode reaches its step limit and no request is repeated.
    pub(crate) fn forecast(&self, tasks: &[Task<'_>]) -> Result<Forecast, Failure> {
        let price = client::price(&self.options)?;
        let most = self.settings.decoding.max_output_tokens.map(u64::from);
        let answer = most.map_or(ANSWER_TOKENS, |most| ANSWER_TOKENS.min(most));
        let batches = self.batches(tasks, answer, |task| task.most_decisions())?;
        let known = |task: &Task<'_>| task.subject.facts.known_wins.get(&task.level.number).copied();
        let estimated = match tasks.iter().all(|task| known(task).is_some()) {
            true => {
                let decisions = |task: &Task<'_>| {
                    let steps = known(task).unwrap_or(u64::MAX).min(task.most_steps());
                    steps.div_ceil(task.commit.due(steps).max(1)).max(1)
                };
                Some(Estimate::of(&self.batches(tasks, answer, decisions)?, price.as_ref()))
            }
            false => None,
        };
        let estimate = Estimate::of(&batches, price.as_ref());
        let longest = most.map(|output_tokens| {
            let longest: Vec<_> = batches.iter().map(|batch| Batch { output_tokens, ..*batch }).collect();
            Estimate::of(&longest, price.as_ref())
        });
        Ok(Forecast {
            episodes: tasks.len() as u64,
            requests: estimate.requests,
            input_tokens: estimate.input_tokens,
            cacheable_tokens: estimate.cacheable_tokens,
            output_tokens: estimate.output_tokens,
            cost: estimate.cost.map(Usd::dollars),
            cost_if_cached: estimate.cost_if_cached.map(Usd::dollars),
            answer_tokens: answer,
            max_answer_tokens: most,
            max_output_tokens: longest.map(|longest| longest.output_tokens),
            max_cost: longest.and_then(|longest| longest.cost).map(Usd::dollars),
            estimated_requests: estimated.map(|estimated| estimated.requests),
            estimated_cost: estimated.and_then(|estimated| estimated.cost).map(Usd::dollars),
            forbidden: self.options.limits.exceeded_by_estimate(&estimate),
        })
    }

    /// Returns each episode's requests, assuming that an episode makes `decisions(task)` decisions.
    fn batches(
        &self,
        tasks: &[Task<'_>],
        answer: u64,
        decisions: impl Fn(&Task<'_>) -> u64,
    ) -> Result<Vec<Batch>, Failure> {
        let mut batches = Vec::new();
        // The number of decisions on earlier levels of the same conversation.
        let mut earlier = 0;
        for task in tasks {
            let prompter = self.prompter(task.subject, task.max_steps, task.commit)?;
            let decisions = decisions(task);
            let first = Observed::first(task);
            let prompt = prompter.prompt(&first.turn(task), &[], &[]);
            let (fixed, turn) = (prompt.tokens.fixed(), prompt.tokens.total - prompt.tokens.fixed());
            let room = self.prompts.history_tokens.saturating_sub(fixed + turn);
            if task.series.is_none_or(|place| place.index == 0) {
                earlier = 0;
            }
            // The final question also counts as a decision.
            let asked =
                u64::from(prompter.asks_predictions() && task.series.is_some_and(SeriesPlace::is_last));
            let decisions = decisions + asked;
            let past = match self.prompts.mode {
                Mode::ZeroShot => 0,
                Mode::Contextual => {
                    let until = |steps: u64| history(steps, turn + answer, room);
                    until(earlier + decisions) - until(earlier)
                }
            };
            earlier += decisions;
            batches.push(Batch {
                requests: decisions,
                stable_tokens: fixed,
                changing_tokens: turn + past / decisions,
                output_tokens: answer,
            });
        }
        Ok(batches)
    }
}

/// Returns the total number of tokens that earlier turns occupy in the prompts of `steps` steps. The history
/// grows by `turn` tokens per step, up to `room`.
fn history(steps: u64, turn: u64, room: u64) -> u64 {
    let Some(most) = room.checked_div(turn) else { return 0 };
    let growing = steps.min(most + 1);
    let grown = turn.saturating_mul(growing.saturating_mul(growing.saturating_sub(1)) / 2);
    grown.saturating_add((steps - growing).saturating_mul(room))
}

impl ConnectedModel {
    pub(crate) fn contestant(&self, task: &Task<'_>) -> evaluation::Contestant {
        let prompter = self.prompters[&task.subject.id].clone();
        let samples = task.chance().child("answers", 0);
        let player = evaluation::player::ModelPlayer::new(
            self.model.clone(),
            prompter,
            self.decoding.clone(),
            self.reasks,
            samples,
        );
        evaluation::Contestant::Agent(Box::new(player))
    }
}

impl std::fmt::Display for Forecast {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let million = |tokens: u64| tokens as f64 / 1e6;
        writeln!(f, "if every episode takes all its steps and no request is repeated:")?;
        writeln!(f, "{} episodes, {} requests", self.episodes, self.requests)?;
        let (input, cached) = (million(self.input_tokens), million(self.cacheable_tokens));
        writeln!(f, "{input:.2} M prompt tokens, of which a provider's cache may hold {cached:.2} M")?;
        let (output, assumed) = (million(self.output_tokens), self.answer_tokens);
        write!(f, "{output:.2} M answer tokens, assuming {assumed} tokens per answer; ")?;
        match (self.max_answer_tokens, self.max_output_tokens) {
            (Some(answer), Some(all)) => {
                writeln!(f, "at most {:.2} M, as an answer has at most {answer}", million(all))?;
            }
            _ => writeln!(f, "--max-output-tokens would limit them")?,
        }
        match (self.cost, self.cost_if_cached) {
            (Some(cost), Some(cached)) => {
                write!(f, "{cost:.2} USD, {cached:.2} with the cache")?;
                self.max_cost
                    .iter()
                    .try_for_each(|most| write!(f, "; {most:.2} USD with the longest answers"))?;
            }
            _ => write!(f, "cost: unknown; pass prices with --prices FILE")?,
        }
        if let Some(requests) = self.estimated_requests {
            write!(
                f,
                "\nif every episode lasts as long as the shortest known win of its level: {requests} requests"
            )?;
            self.estimated_cost.iter().try_for_each(|cost| write!(f, ", {cost:.2} USD"))?;
        }
        self.forbidden.iter().try_for_each(|cap| write!(f, "\nthat exceeds {cap}"))
    }
}

#[cfg(test)]
mod tests {
    use super::history;

    #[test]
    fn earlier_turns_accumulate_up_to_the_limit() {
        for (steps, turn, room) in
            [(0, 7, 30), (1, 7, 30), (5, 7, 30), (12, 7, 28), (12, 7, 30), (9, 0, 30), (9, 40, 30)]
        {
            let added: u64 = (0..steps).map(|step| room.min(step * turn)).sum();
            assert_eq!(history(steps, turn, room), added, "{steps} {turn} {room}");
        }
    }
}
