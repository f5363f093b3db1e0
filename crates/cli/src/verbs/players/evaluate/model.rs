//! The language-model flags, and the settings that they select.

use super::Args;
use super::prompt_args::PromptArgs;
use crate::console::Console;
use crate::failure::Failure;
use crate::flags::client::ClientArgs;
use evaluation::client::{self, Batch, Decoding, Estimate, ModelOptions, ModelSettings, OnFailure, Usd};
use evaluation::prompt::{Mode, PromptSettings, Prompter};
use evaluation::run::Task;
use evaluation::{AnswerLimit, Commitment, Entrant, Observed, SeriesPlace, Settings, Subject};
use serde::Serialize;
use serde_json::json;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The number of tokens per answer that dry runs assume if answers are not limited.
const ANSWER_TOKENS: u64 = 100;

/// The model, and its prompts.
#[derive(clap::Args)]
#[command(next_help_heading = "Language models")]
pub(crate) struct ModelArgs {
    #[command(flatten)]
    pub(crate) client: ClientArgs,
    /// Maximum number of repeated requests after an answer without a usable action
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) reasks: u32,
    #[command(flatten)]
    pub(crate) prompt: PromptArgs,
}

/// The games' prompters, by game ID.
type Prompters = BTreeMap<String, Arc<Prompter>>;

/// Creates the prompters for an evaluation. The prompts state the limit on each answer's length, if there is one.
pub(super) fn prompters(
    subjects: &[Subject],
    prompts: &PromptSettings,
    settings: &Settings,
    limit: Option<AnswerLimit>,
) -> Result<Prompters, Failure> {
    let Settings { max_steps, commit, .. } = *settings;
    let prompter = |subject: &Subject| {
        let prompter = Prompter::within(subject, prompts.clone(), max_steps, commit)?;
        Ok((subject.id.clone(), Arc::new(prompter.with_answer_limit(limit))))
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
    /// The spending so far, and the caps on it.
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
        let options = args.client.options(model)?;
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
        let prompter = Prompter::within(subject, self.prompts.clone(), max_steps, commit)?;
        Ok(prompter.with_answer_limit(self.answer_limit()))
    }

    /// Returns the limit on each answer's length, if the user set it.
    fn answer_limit(&self) -> Option<AnswerLimit> {
        self.options.decoding.max_output_tokens.map(AnswerLimit::Tokens)
    }

    /// Connects without sending a request, so that a missing key is reported before anything is written.
    pub(crate) fn connect(
        &self,
        subjects: &[Subject],
        settings: &Settings,
        console: &Console,
    ) -> Result<ConnectedModel, Failure> {
        let on_failure = Some(OnFailure(console.remarks()));
        let connection = client::connect(&ModelOptions { on_failure, ..self.options.clone() })?;
        Ok(ConnectedModel {
            model: Arc::from(connection.model),
            prompters: prompters(subjects, &self.prompts, settings, self.answer_limit())?,
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
