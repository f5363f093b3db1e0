//! A reference player, identified by its name.

use crate::commitment::Commitment;
use crate::error::EvaluationError;
use crate::player::{Contestant, Touching};
use crate::prompt::{PromptSettings, Prompter};
use crate::serve::{PromptPlayer, Prompted};
use crate::subject::Subject;
use agents::{Budget, PlannerSpec};
use base::Seed;
use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

/// A reference player, completely determined by its name. It either plans in open loop, reads prompts, or
/// learns by touching.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ReferencePlayer {
    /// A planner that searches with the forward model.
    Planner(PlannerSpec),
    /// A player that reads the default prompts.
    Prompted(PromptPlayer),
    /// The player that learns the rules by touching everything.
    Touching,
}

impl FromStr for ReferencePlayer {
    type Err = String;

    fn from_str(name: &str) -> Result<ReferencePlayer, String> {
        if name == Touching::NAME {
            return Ok(ReferencePlayer::Touching);
        }
        // `random` is the planner of that name, as in `arcade evaluate`.
        match name.parse() {
            Ok(planner) => Ok(ReferencePlayer::Planner(planner)),
            Err(unknown) => match name.parse() {
                Ok(PromptPlayer::Planner(_)) | Err(_) => Err(unknown.to_string()),
                Ok(player) => Ok(ReferencePlayer::Prompted(player)),
            },
        }
    }
}

impl fmt::Display for ReferencePlayer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ReferencePlayer::Planner(planner) => planner.fmt(f),
            ReferencePlayer::Prompted(player) => player.fmt(f),
            ReferencePlayer::Touching => f.write_str(Touching::NAME),
        }
    }
}

impl ReferencePlayer {
    /// Returns the prompter for a player that reads prompts, or `None` for any other player.
    ///
    /// # Errors
    /// Returns an error if a prompt cannot be written.
    pub(crate) fn prompter(
        &self,
        subject: &Subject,
        max_steps: u64,
        commit: Commitment,
    ) -> Result<Option<Arc<Prompter>>, EvaluationError> {
        match self {
            ReferencePlayer::Planner(_) | ReferencePlayer::Touching => Ok(None),
            ReferencePlayer::Prompted(_) => {
                Ok(Some(Arc::new(Prompter::within(subject, PromptSettings::default(), max_steps, commit)?)))
            }
        }
    }

    /// Returns the player for one episode. `chance` is the seed for the player's random choices. A player
    /// that reads prompts requires the prompter for its game.
    pub(crate) fn contestant(&self, prompter: Option<&Arc<Prompter>>, chance: Seed) -> Contestant {
        match (self, prompter) {
            (ReferencePlayer::Prompted(player), Some(prompter)) => {
                Contestant::Agent(Box::new(Prompted::new(player.clone(), prompter.clone())))
            }
            (ReferencePlayer::Planner(spec), _) => {
                Contestant::Planner { spec: spec.clone(), budget: Budget(0) }
            }
            (ReferencePlayer::Touching, _) => Contestant::Agent(Box::new(Touching::new(chance))),
            (ReferencePlayer::Prompted(_), None) => {
                unreachable!("a player that reads prompts has a prompter")
            }
        }
    }
}
