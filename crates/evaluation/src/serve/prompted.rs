//! A prompt player that is called directly, without a server. It gets the same prompts as with a server, and
//! its answers are parsed in the same way.

use super::PromptPlayer;
use crate::log::Journal;
use crate::player::{Agent, Choice, Halt, Validity};
use crate::prompt::{Attempt, Past, Prompter};
use crate::turn::Turn;
use std::sync::Arc;

/// An agent that plays a [`PromptPlayer`]'s answers to a game's prompts. The agent's log contains no prompts,
/// because the settings and the state determine them.
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
        let answer = self.player.answer(&prompt.messages).map_err(|why| Halt::Unfit(why.to_string()))?;
        let actions = self.prompter.read(&answer, turn).choice();
        let choice = actions.map_or_else(|| Choice::nothing(Validity::Invalid), Choice::plan);
        self.past.push(Past::new(prompt.shown, &[Attempt { answer, complaint: None }], choice.action(0)));
        Ok(choice)
    }

    fn recall(&mut self, turn: &Turn<'_>, _: &Journal, _: &Choice) -> Result<(), Halt> {
        // The same prompt always gets the same answer, so answers need not be stored.
        self.act(turn, &mut Journal::in_memory()).map(|_| ())
    }
}
