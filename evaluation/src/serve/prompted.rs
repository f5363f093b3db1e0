//! A served player without a server: the same prompts, the same answers, read the same way.

use super::PromptPlayer;
use crate::answer::Reading;
use crate::log::Journal;
use crate::player::{Agent, Choice, Halt, Validity};
use crate::prompt::{Attempt, Past, Prompter};
use crate::turn::Turn;
use engine::Action;
use std::sync::Arc;

/// Plays what a [`PromptPlayer`] answers to the prompts of a game. Its log holds no prompts: the settings and the state say
/// what they were.
#[derive(Debug)]
pub struct Prompted {
    player: PromptPlayer,
    prompter: Arc<Prompter>,
    past: Vec<Past>,
}

impl Prompted {
    /// For one episode of the prompter's game.
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
        // The same prompt gets the same answer, whose words nobody has kept.
        self.act(turn, &mut Journal::in_memory()).map(|_| ())
    }
}
