//! The events of a log, one line of JSON each.

use crate::client::{ChatReply, Failure, Finish, Role, Usage};
use crate::commitment::Commitment;
use crate::player::Validity;
use crate::predictions::{Grade, Predicted};
use crate::track::SeriesPlace;
use base::{Digest, Seed};
use engine::{Action, Outcome, StateHash};
use serde::{Deserialize, Serialize};

/// The version of the events below, raised when a reader of older logs could misread newer ones.
pub const SCHEMA: u32 = 1;

/// A line of an episode's log. Times (`latency_ms`, `waited_ms`, `took_ms`) are the only fields in which two runs of the
/// same evaluation with the same answers may differ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "event", rename_all = "snake_case", deny_unknown_fields)]
pub enum Event {
    /// The first line.
    Start {
        /// [`SCHEMA`].
        schema: u32,
        /// [`engine::SEMANTICS`]. Under another version, the actions may lead elsewhere.
        semantics: u32,
        /// The game, by the name of its folder in the results.
        game: String,
        /// The game's digest.
        game_digest: Digest,
        /// The level's number.
        level: usize,
        /// The level's digest.
        level_digest: Digest,
        /// The index of the episode among those of this player on this level.
        run: u64,
        /// The seed of the game's chance: the same for every player, so that runs are paired.
        seed: Seed,
        /// The maximum number of actions.
        max_steps: u64,
        /// The number of actions that the player commits to at each look.
        #[serde(default, skip_serializing_if = "Commitment::is_one")]
        commit: Commitment,
        /// The track with its version, such as `masked@1`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        track: Option<String>,
        /// The place of the level in a series that is played in one conversation.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        series: Option<SeriesPlace>,
        /// The state hash before the first tick.
        hash: StateHash,
        /// Column and row of the avatar, if there is one.
        avatar: Option<(i32, i32)>,
    },
    /// A text sent to a model or received from it. It is recorded once and referred to by its number afterwards.
    Message {
        /// The number of the text within the episode, from 0.
        id: u32,
        /// The author.
        role: Role,
        /// The words.
        text: String,
        /// The digest of the picture beside the words, a PNG determined by the state and the settings.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        image: Option<Digest>,
    },
    /// A request about to be sent. Without a reply after it, it may have been paid for and lost.
    Request {
        /// The number of decisions before this one.
        step: u64,
        /// The number of the attempt within the step, from 0; asking again after an invalid answer is another attempt.
        attempt: u32,
        /// The conversation, by numbers of messages.
        messages: Vec<u32>,
        /// The tokens of the conversation by our own count, which decides when the history is cut.
        tokens: u64,
    },
    /// The answer to a request.
    Reply(Reply),
    /// The player committed to several actions. The steps that follow play them. Logs with a look before every action have
    /// none.
    Plan {
        /// The number of steps before it.
        step: u64,
        /// The actions, at most those that are due. Nothing is done in the ticks that they leave.
        actions: Vec<Action>,
        /// The origin of the choice, which is that of all its steps.
        validity: Validity,
    },
    /// An action was played.
    Step {
        /// The number of the step, from 0.
        step: u64,
        /// The action played.
        action: Action,
        /// The origin of the choice.
        validity: Validity,
        /// The score after it.
        score: f64,
        /// The state hash after it.
        hash: StateHash,
        /// The outcome after it.
        outcome: Outcome,
        /// Column and row of the avatar after it, if there is one.
        avatar: Option<(i32, i32)>,
        /// The forward-model calls spent by a planner.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        calls: Option<u64>,
        /// The duration of the decision, ms.
        took_ms: f64,
    },
    /// The player has answered the question about the rules after the last level of a series.
    Predictions {
        /// The number of steps before it.
        step: u64,
        /// The kinds that were asked about, by the game's own names.
        kinds: Vec<String>,
        /// The kinds of which the player expects each fact; `None` if no answer could be read.
        predicted: Option<Predicted>,
        /// The origin of the answer.
        validity: Validity,
        /// The comparison with the rules. Without a usable answer, nothing is right.
        grade: Grade,
    },
    /// The episode was aborted; a later `--resume` continues after this line.
    Halt {
        /// `infrastructure`, `budget`, `rejected`, `unusable`.
        reason: String,
        /// The reason in words.
        message: String,
    },
    /// The last line.
    End {
        /// The reason for the end.
        status: Status,
        /// The outcome of the game.
        outcome: Outcome,
        /// The score.
        score: f64,
        /// The number of actions played.
        steps: u64,
    },
}

/// A model's answer to a request.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reply {
    /// The step of the request.
    pub step: u64,
    /// The attempt of the request.
    pub attempt: u32,
    /// The classification of the answer.
    pub class: ReplyClass,
    /// The raw text.
    pub text: String,
    /// The reasoning, if the provider returns it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reasoning: Option<String>,
    /// The action read from the text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
    /// The actions read from the text, where the player commits to several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plan: Option<Vec<Action>>,
    /// The rule of the parser that read it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stage: Option<String>,
    /// The reason why the answer ends.
    pub finish: Finish,
    /// The tokens used.
    pub usage: Usage,
    /// The model that answered, as the provider calls it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub served_by: Option<String>,
    /// The failed tries before this answer.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub failures: Vec<Failure>,
    /// `true` if the answer comes from the cache.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub cached: bool,
    /// The time from request to answer, ms.
    pub latency_ms: f64,
}

impl Reply {
    /// The record of an answer, without the action that was read from it.
    pub(crate) fn of(step: u64, attempt: u32, class: ReplyClass, answer: ChatReply) -> Reply {
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
    /// An action in the requested format.
    Strict,
    /// An action, read with tolerance.
    Tolerant,
    /// No action can be read, or the action does not exist.
    Invalid,
    /// The model refused to answer.
    Refused,
    /// The answer was cut off before it named an action.
    Truncated,
}

/// The reason why an episode has no further step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// The game is over.
    Over,
    /// The step limit was reached.
    StepLimit,
}

/// Returns the origins of the decisions of a log: of its plans, or of its steps where there is a look before every action.
pub fn decisions(log: &[Event]) -> impl Iterator<Item = Validity> {
    let is_one = !matches!(log.first(), Some(Event::Start { commit, .. }) if !commit.is_one());
    log.iter().filter_map(move |event| match event {
        Event::Step { validity, .. } if is_one => Some(*validity),
        Event::Plan { validity, .. } => Some(*validity),
        _ => None,
    })
}

/// Returns the event with its times set to 0, for comparing runs.
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
