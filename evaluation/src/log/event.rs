//! What is recorded, a line of JSON each.

use crate::client::{Failure, Finish, Role, Usage};
use crate::player::Validity;
use engine::{Action, Digest, Outcome, Seed, StateHash};
use serde::{Deserialize, Serialize};

/// The version of the events below: bumped when a reader of older logs could misread newer ones.
pub const SCHEMA: u32 = 1;

/// A line of an episode's log. Times (`latency_ms`, `waited_ms`, `took_ms`) are the only fields in which two runs of the same
/// evaluation with the same answers may differ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "event", rename_all = "snake_case", deny_unknown_fields)]
pub enum Event {
    /// The first line.
    Start {
        /// [`SCHEMA`].
        schema: u32,
        /// [`engine::SEMANTICS`]: under another number, the actions may lead elsewhere.
        semantics: u32,
        /// The game, by the name of its folder in the results.
        game: String,
        /// The game's digest.
        game_digest: Digest,
        /// The level's number.
        level: usize,
        /// The level's digest.
        level_digest: Digest,
        /// Which of the episodes of this player on this level it is.
        run: u64,
        /// Decides the game's chance: the same for every player, so that runs are paired.
        seed: Seed,
        /// Decisions at most.
        max_steps: u64,
        /// The state hash before the first tick.
        hash: StateHash,
        /// Column and row of the avatar, if there is one.
        avatar: Option<(i32, i32)>,
    },
    /// A text that is said to a model or by it: recorded once, later named by its number.
    Message {
        /// Counted from 0 within the episode.
        id: u32,
        /// Who says it.
        role: Role,
        /// The words.
        text: String,
        /// The digest of the picture beside the words, a PNG that the state and the settings decide.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        image: Option<Digest>,
    },
    /// What is about to be asked. Without a reply after it, it may have been paid for and lost.
    Request {
        /// Decisions before this one.
        step: u64,
        /// Counted from 0 within the step: a re-ask after an invalid answer is another attempt.
        attempt: u32,
        /// The conversation, by numbers of messages.
        messages: Vec<u32>,
        /// Tokens of the conversation by our own count, by which history is cut.
        tokens: u64,
    },
    /// What was answered.
    Reply(Reply),
    /// An action was played.
    Step {
        /// Counted from 0.
        step: u64,
        /// What was played.
        action: Action,
        /// How it came about.
        validity: Validity,
        /// The score after it.
        score: f64,
        /// The state hash after it.
        hash: StateHash,
        /// How the episode stands after it.
        outcome: Outcome,
        /// Column and row of the avatar after it, if there is one.
        avatar: Option<(i32, i32)>,
        /// Forward-model calls that a planner spent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        calls: Option<u64>,
        /// How long the decision took, ms.
        took_ms: f64,
    },
    /// The episode was broken off; a later `--resume` goes on after this line.
    Halt {
        /// `infrastructure`, `budget`, `rejected`.
        reason: String,
        /// In words.
        message: String,
    },
    /// The last line.
    End {
        /// Why there is no more.
        status: Status,
        /// How the game stands.
        outcome: Outcome,
        /// The score.
        score: f64,
        /// Actions played.
        steps: u64,
    },
}

/// A model's answer to a request.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reply {
    /// Of the request.
    pub step: u64,
    /// Of the request.
    pub attempt: u32,
    /// What it is worth.
    pub class: ReplyClass,
    /// The words, raw.
    pub text: String,
    /// The reasoning, where the provider shows it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reasoning: Option<String>,
    /// The action that was read from it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
    /// The rule of the parser that read it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stage: Option<String>,
    /// Why the answer ends.
    pub finish: Finish,
    /// What it cost.
    pub usage: Usage,
    /// The model that answered, as the provider calls it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub served_by: Option<String>,
    /// The tries that failed before.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub failures: Vec<Failure>,
    /// Whether it comes from the cache.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub cached: bool,
    /// From request to answer, ms.
    pub latency_ms: f64,
}

/// What an answer is worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ReplyClass {
    /// An action in the format that was asked for.
    Strict,
    /// An action, read with tolerance.
    Tolerant,
    /// No action can be read, or one that does not exist.
    Invalid,
    /// The model would not answer.
    Refused,
    /// Cut off before it came to an action.
    Truncated,
}

/// Why an episode has no further step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// The game is over.
    Over,
    /// The limit of steps was met.
    StepLimit,
}

/// The event with its times set to 0, for comparing runs.
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
