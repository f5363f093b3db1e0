//! The events in an episode's log. Each event is one line of JSON.

use crate::client::{ChatReply, Failure, Finish, Role, Usage};
use crate::commitment::Commitment;
use crate::player::Validity;
use crate::predictions::{Grade, Predicted};
use crate::track::SeriesPlace;
use base::{Digest, Seed};
use engine::{Action, Outcome, StateHash};
use serde::{Deserialize, Serialize};

/// The version of the event format. It is incremented whenever programs that read older logs might misread
/// newer ones.
pub const SCHEMA: u32 = 1;

/// An event in an episode, stored as one line of the log. Two runs of the same evaluation with the same
/// answers differ only in their times (`latency_ms`, `waited_ms`, `took_ms`).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "event", rename_all = "snake_case", deny_unknown_fields)]
pub enum Event {
    /// The start of the episode, recorded in the first line of the log.
    Start {
        /// The version of the event format: [`SCHEMA`].
        schema: u32,
        /// The version of the engine's semantics ([`engine::SEMANTICS`]). Under a different version, the same
        /// actions may have different effects.
        semantics: u32,
        /// The game's folder name in the results.
        game: String,
        /// The game's digest.
        game_digest: Digest,
        /// The level number.
        level: usize,
        /// The level's digest.
        level_digest: Digest,
        /// The episode's index among this player's episodes on this level.
        run: u64,
        /// The seed of the game's randomness. It is the same for all players, so that runs are paired.
        seed: Seed,
        /// The maximum number of actions in the episode.
        max_steps: u64,
        /// The number of actions that the player commits to at each decision.
        #[serde(default, skip_serializing_if = "Commitment::is_one")]
        commit: Commitment,
        /// The maximum number of output tokens per answer, including reasoning, if the user has set it.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        max_output_tokens: Option<u32>,
        /// The track (bundle of prompt settings) with its version, such as `masked@1`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        track: Option<String>,
        /// The level's position in a series of levels played in one conversation.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        series: Option<SeriesPlace>,
        /// The state hash before the first tick.
        hash: StateHash,
        /// The avatar's column and row, if there is an avatar.
        avatar: Option<(i32, i32)>,
    },
    /// A text sent to a model or received from one. Each text is recorded once, and later events refer to it
    /// by its index.
    Message {
        /// The index of the text within the episode, starting at 0.
        id: u32,
        /// The author of the text.
        role: Role,
        /// The message text.
        text: String,
        /// The digest of the PNG image that accompanies the text. The image is determined by the state and
        /// the settings.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        image: Option<Digest>,
    },
    /// A request about to be sent. If the log contains no reply to it, the request may have been paid for
    /// although its reply was lost.
    Request {
        /// The number of actions played before the decision.
        step: u64,
        /// The index of the attempt within the step, starting at 0. Each time the question is repeated after
        /// an invalid answer, a new attempt starts.
        attempt: u32,
        /// The messages in the conversation, by index.
        messages: Vec<u32>,
        /// The local token count of the conversation, which determines when the history is truncated.
        tokens: u64,
    },
    /// A model's answer to a request.
    Reply(Reply),
    /// A plan of several actions that the player commits to, played in the following steps. Players that
    /// commit to one action log no plans.
    Plan {
        /// The number of steps before the plan.
        step: u64,
        /// The plan's actions, up to the number due. If there are fewer, the player does nothing in the
        /// remaining ticks.
        actions: Vec<Action>,
        /// The validity of the choice, which applies to all steps in the plan.
        validity: Validity,
    },
    /// A step, in which one action was played.
    Step {
        /// The step's index, starting at 0.
        step: u64,
        /// The action played.
        action: Action,
        /// The validity of the choice.
        validity: Validity,
        /// The score after the action.
        score: f64,
        /// The state hash after the action.
        hash: StateHash,
        /// The outcome after the action.
        outcome: Outcome,
        /// The avatar's column and row after the action, if there is an avatar.
        avatar: Option<(i32, i32)>,
        /// The number of forward-model calls made by a planner.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        calls: Option<u64>,
        /// The duration of the decision, in milliseconds.
        took_ms: f64,
    },
    /// The player's answer to the question about the rules that follows the last level of a series.
    Predictions {
        /// The number of steps before the answer.
        step: u64,
        /// The sprite types in the question, under the game's own names.
        kinds: Vec<String>,
        /// The types for which the player predicts each fact, or `None` if no answer could be read.
        predicted: Option<Predicted>,
        /// The validity of the predictions.
        validity: Validity,
        /// The comparison of the predictions with the rules. If the answer was unusable, no prediction is
        /// correct.
        grade: Grade,
    },
    /// An aborted episode. If the evaluation is resumed with `--resume`, the episode continues after this
    /// line.
    Halt {
        /// The category of the abort: `infrastructure`, `budget`, `rejected` or `unusable`.
        reason: String,
        /// The reason for the abort, in one sentence.
        message: String,
    },
    /// The end of the episode, recorded in the last line of the log.
    End {
        /// The reason why the episode ended.
        status: Status,
        /// The outcome of the game.
        outcome: Outcome,
        /// The final score.
        score: f64,
        /// The number of actions played.
        steps: u64,
    },
}

/// The record of a model's answer to a request.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reply {
    /// The index of the request's step.
    pub step: u64,
    /// The index of the request's attempt.
    pub attempt: u32,
    /// The classification of the answer.
    pub class: ReplyClass,
    /// The raw text of the answer.
    pub text: String,
    /// The model's reasoning, if the provider returns it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reasoning: Option<String>,
    /// The action read from the text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
    /// The actions read from the text, if the player commits to several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plan: Option<Vec<Action>>,
    /// The parser rule that read the text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stage: Option<String>,
    /// The reason why the answer ended.
    pub finish: Finish,
    /// The token counts of the request and its answer.
    pub usage: Usage,
    /// The provider's name for the model that answered.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub served_by: Option<String>,
    /// The failed tries before this answer.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub failures: Vec<Failure>,
    /// `true` if the answer came from the cache.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub cached: bool,
    /// The time from the request to the answer, in milliseconds.
    pub latency_ms: f64,
}

impl Reply {
    /// Creates the record of an answer. The action read from the answer is not yet part of the record.
    pub fn of(step: u64, attempt: u32, class: ReplyClass, answer: ChatReply) -> Reply {
        let ChatReply { text, reasoning, finish, usage, served_by, failures, latency_ms, cached } = answer;
        let latency_ms = (latency_ms * 1000.0).round() / 1000.0;
        Reply {
            step,
            attempt,
            class,
            text,
            reasoning,
            action: None,
            plan: None,
            stage: None,
            finish,
            usage,
            served_by,
            failures,
            cached,
            latency_ms,
        }
    }
}

/// The classification of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ReplyClass {
    /// The answer states an action in the requested format.
    Strict,
    /// The answer states an action in a format other than the requested one. A tolerant rule read the action.
    Tolerant,
    /// The answer contains no readable action, or states a nonexistent one.
    Invalid,
    /// The model declined to answer.
    Refused,
    /// The answer was cut off before it stated an action.
    Truncated,
}

/// The reason why an episode ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// The game is over.
    Over,
    /// The episode reached its step limit.
    StepLimit,
}

/// Returns the origins of the decisions in a log. A decision is a plan, or a step if the player commits to
/// one action.
pub fn decisions(log: &[Event]) -> impl Iterator<Item = Validity> {
    let is_one = !matches!(log.first(), Some(Event::Start { commit, .. }) if !commit.is_one());
    log.iter().filter_map(move |event| match event {
        Event::Step { validity, .. } if is_one => Some(*validity),
        Event::Plan { validity, .. } => Some(*validity),
        _ => None,
    })
}

/// Returns the event with its times set to 0, so that runs can be compared.
pub fn without_times(event: &Event) -> Event {
    let mut event = event.clone();
    match &mut event {
        Event::Reply(reply) => {
            reply.latency_ms = 0.0;
            reply.failures.iter_mut().for_each(|failure| failure.waited_ms = 0);
        }
        Event::Step { took_ms, .. } => *took_ms = 0.0,
        _ => {}
    }
    event
}
