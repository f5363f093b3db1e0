//! Players of known strength that see only the prompt. The players answer chat completion requests on the
//! loopback interface, or are called directly
//! ([docs/how-to/serve-player.md](../../../../docs/how-to/serve-player.md)).
//!
//! Such players have no access to the game, so all their knowledge comes from the conversation. They
//! therefore test the entire path from the state to the prompt, the answer and the action, and can also test
//! third-party harnesses. The same conversation always gets the same answer.

mod origin;
mod prompted;
mod reflex;
mod refusal;
mod replan;
mod server;
mod shown;
mod unanswerable;

pub use prompted::Prompted;
pub use server::{Running, Server};
pub use unanswerable::Unanswerable;

use crate::client::{ChatError, ChatErrorKind, ChatMessage, ChatReply, ChatRequest, Finish, Model, Usage};
use agents::PlannerSpec;
use base::Seed;
use engine::Action;
use shown::Shown;
use std::fmt;
use std::str::FromStr;

/// The names of the players that need only a prompt, from weakest to strongest. Names of the form
/// `planner:NAME` are also accepted.
pub const PROMPT_PLAYERS: &[&str] = &["random", "reflex"];

/// A player that answers prompts without access to the game.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PromptPlayer {
    /// Plays random actions other than nil, derived from the digest of the conversation.
    Random,
    /// Takes the shortest path to a target that is good according to the rules, as described in [the
    /// documentation](../../../../docs/how-to/serve-player.md).
    Reflex,
    /// Plans from the position reconstructed from the prompt. The prompt must show all relevant information
    /// about the game.
    Planner(PlannerSpec),
}

impl PromptPlayer {
    /// Checks that the player can answer a conversation. Cost: parsing the conversation once.
    ///
    /// # Errors
    /// Returns an error if the conversation lacks information that the player needs.
    pub fn check(&self, messages: &[ChatMessage]) -> Result<(), Unanswerable> {
        let shown = Shown::of(messages)?;
        match self {
            PromptPlayer::Random => Ok(()),
            PromptPlayer::Reflex => reflex::choose(shown, seed(messages)).map(drop),
            PromptPlayer::Planner(spec) => replan::check(&shown, spec),
        }
    }

    /// Returns the player's answer to a conversation. Cost: O(bytes), or a planner's budget in forward-model
    /// calls.
    ///
    /// # Errors
    /// Returns an error if the conversation lacks information that the player needs.
    pub fn answer(&self, messages: &[ChatMessage]) -> Result<String, Unanswerable> {
        let shown = Shown::of(messages)?;
        let seed = seed(messages);
        let actions = match self {
            PromptPlayer::Random => {
                let (keys, mut draws) = (actions_except_nil(&shown.actions), seed.sampler());
                (0..shown.due).map(|_| *draws.choose(&keys)).collect()
            }
            PromptPlayer::Reflex => reflex::choose(shown.clone(), seed)?,
            PromptPlayer::Planner(spec) => replan::choose(&shown, spec, seed)?,
        };
        Ok(shown.answer(&actions))
    }
}

impl FromStr for PromptPlayer {
    type Err = Unanswerable;

    fn from_str(name: &str) -> Result<PromptPlayer, Unanswerable> {
        if let Some(planner) = name.strip_prefix("planner:") {
            let spec = planner.parse::<PlannerSpec>().map_err(|error| Unanswerable(error.to_string()))?;
            return Ok(PromptPlayer::Planner(spec));
        }
        match name {
            "random" => Ok(PromptPlayer::Random),
            "reflex" => Ok(PromptPlayer::Reflex),
            _ => {
                let near = engine::nearest(name, PROMPT_PLAYERS.iter().copied());
                let near = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
                let names = PROMPT_PLAYERS.join(", ");
                Err(Unanswerable(format!(
                    "there is no prompt player `{name}`{near}; available: {names}, and `planner:NAME`, such as `planner:mcts:300`"
                )))
            }
        }
    }
}

impl fmt::Display for PromptPlayer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PromptPlayer::Random => f.write_str("random"),
            PromptPlayer::Reflex => f.write_str("reflex"),
            PromptPlayer::Planner(spec) => write!(f, "planner:{spec}"),
        }
    }
}

impl Model for PromptPlayer {
    fn chat(&self, request: &ChatRequest) -> Result<ChatReply, ChatError> {
        let answer = self.answer(&request.messages).map_err(|error| ChatError {
            kind: ChatErrorKind::Rejected,
            message: error.to_string(),
            failures: Vec::new(),
        })?;
        Ok(ChatReply {
            usage: Usage {
                input_tokens: Some(prompt_tokens(&request.messages)),
                output_tokens: Some(tokens(&answer)),
                ..Usage::default()
            },
            served_by: Some(self.to_string()),
            ..ChatReply::new(answer, Finish::Stop)
        })
    }
}

/// Returns the seed for the player's random choices: a digest of every byte of the conversation.
fn seed(messages: &[ChatMessage]) -> Seed {
    let mut hasher = blake3::Hasher::new_derive_key("infinite-arcade 1 served conversation");
    for message in messages {
        let role = [message.role as u8];
        let image = message.image.as_deref().unwrap_or_default();
        for part in [&role, message.text.as_bytes(), image] {
            hasher.update(&(part.len() as u64).to_le_bytes()).update(part);
        }
    }
    Seed::from_text(&hasher.finalize().to_hex())
}

/// Returns the number of tokens that the server reports for a text: one per four bytes.
fn tokens(text: &str) -> u64 {
    text.len().div_ceil(4) as u64
}

fn prompt_tokens(messages: &[ChatMessage]) -> u64 {
    messages.iter().map(|message| tokens(&message.text)).sum()
}

/// Returns all actions except nil, or the unchanged list if it contains only nil.
fn actions_except_nil(actions: &[Action]) -> Vec<Action> {
    let actions_except_nil: Vec<Action> =
        actions.iter().copied().filter(|&action| action != Action::Nil).collect();
    if actions_except_nil.is_empty() { actions.to_vec() } else { actions_except_nil }
}
