//! A served player without a server: the same prompts, and the same answers, read in the same way.

use super::PromptPlayer;
use crate::answer::Reading;
use crate::log::Journal;
use crate::player::{Agent, Choice, Halt, Validity};
use crate::prompt::{Attempt, Past, Prompter};
use crate::turn::Turn;
use engine::Action;
use std::sync::Arc;

/// An agent that plays the answers of a [`PromptPlayer`] to the prompts of a game. Its log holds no prompts, because the
/// settings and the state determine them.
#[derive(Debug)]
pub struct Prompted {
    player: PromptPlayer,
    prompter: Arc<Prompter>,
    past: Vec<Past>,
}

impl Prompted {
    /// Creates the agent for one episode of the prompter's game.
    pub fn new(player: PromptPlayer, prompter: Arc<Prompter>) -> Prompted {
        Prompted { player, prompter, past: Vec::new() }
    }
}

impl Agent for Prompted {
    fn act(&mut self, turn: &Turn<'_>, _: &mut Journal) -> Result<Choice, Halt> {
        let prompt = self.prompter.prompt(turn, &self.past, &[]);
        let answer = self.player.answer(&prompt.messages).map_err(|why| Halt::Rejected(why.to_string()))?;
        let choice = match self.prompter.read(&answer, turn) {
            Reading::Strict(action) | Reading::Tolerant { action, .. } => {
                Choice { action, validity: Validity::Valid }
            }
            Reading::Invalid { .. } => Choice { action: Action::Nil, validity: Validity::Invalid },
        };
        self.past.push(Past::new(prompt.shown, &[Attempt { answer, complaint: None }], choice.action));
        Ok(choice)
    }

    fn recall(&mut self, turn: &Turn<'_>, _: &Journal, _: &Choice) -> Result<(), Halt> {
        // The same prompt gets the same answer, whose text was not kept.
        self.act(turn, &mut Journal::in_memory()).map(|_| ())
    }
}
