//! Reference players, which never change and are played in memory. A release keeps their results, to compare others
//! with.

use crate::commitment::Commitment;
use crate::error::EvaluationError;
use crate::log::Journal;
use crate::player::{Contestant, Touching};
use crate::prompt::{PromptSettings, Prompter};
use crate::run::{PlayResult, Task, play};
use crate::serve::{PromptPlayer, Prompted};
use crate::subject::{Subject, SubjectFacts, SubjectLevel};
use agents::{Budget, PlannerSpec};
use base::Seed;
use engine::Outcome;
use itertools::iproduct;
use rayon::prelude::*;
use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

/// A player of the suite that depends only on its name: a planner, in open loop, or a player that reads prompts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MarkPlayer {
    /// A planner.
    Planner(PlannerSpec),
    /// A player that reads the default prompts.
    Prompted(PromptPlayer),
    /// The player that ignores the rules and touches everything.
    Touching,
}

impl FromStr for MarkPlayer {
    type Err = String;

    fn from_str(name: &str) -> Result<MarkPlayer, String> {
        if name == Touching::NAME {
            return Ok(MarkPlayer::Touching);
        }
        // As in `arcade evaluate`, `random` is the planner of that name.
        match name.parse() {
            Ok(planner) => Ok(MarkPlayer::Planner(planner)),
            Err(unknown) => match name.parse() {
                Ok(PromptPlayer::Planner(_)) | Err(_) => Err(unknown.to_string()),
                Ok(player) => Ok(MarkPlayer::Prompted(player)),
            },
        }
    }
}

impl fmt::Display for MarkPlayer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MarkPlayer::Planner(planner) => planner.fmt(f),
            MarkPlayer::Prompted(player) => player.fmt(f),
            MarkPlayer::Touching => f.write_str(Touching::NAME),
        }
    }
}

/// The parameters of a reference player's episodes.
#[derive(Clone, Copy, Debug)]
pub struct MarkPlays {
    /// The seed of the evaluation whose episodes are played.
    pub seed: Seed,
    /// The number of episodes per commitment.
    pub runs: u64,
    /// The maximum number of actions per episode.
    pub max_steps: u64,
}

/// The text from which `arcade evaluate` derives the randomness of games by default. The results of reference players
/// are those of such an evaluation.
pub const SEED: &str = "evaluate";

impl MarkPlays {
    /// Plays the levels of a game, given as texts, with players and commitments, given by name. Returns the number of
    /// episodes won for each level, player and commitment.
    ///
    /// # Errors
    /// Returns an error if the game does not load, if there is no player or commitment with a name, or if a player
    /// cannot play the game.
    pub fn of_game<'a>(
        &self,
        game: &str,
        levels: &[String],
        players: &[String],
        commits: impl Iterator<Item = &'a str>,
    ) -> Result<Vec<Vec<Vec<u64>>>, String> {
        let texts: Vec<_> = levels.iter().enumerate().map(|(at, text)| (at, text.clone(), None)).collect();
        let subject = Subject::read("game", game, &texts, SubjectFacts::default());
        let subject = subject.map_err(|error| error.to_string())?;
        let players: Vec<MarkPlayer> = players.iter().map(|name| name.parse()).collect::<Result<_, _>>()?;
        let commits: Vec<Commitment> = commits.map(str::parse).collect::<Result<_, _>>()?;
        let each: Vec<(&SubjectLevel, &MarkPlayer)> = iproduct!(&subject.levels, &players).collect();
        let wins = each.into_par_iter().with_max_len(1).map(|(level, player)| {
            self.wins(&subject, level, player, &commits).map_err(|error| error.to_string())
        });
        let wins: Vec<Vec<u64>> = wins.collect::<Result<_, _>>()?;
        Ok(wins.chunks(players.len()).map(<[_]>::to_vec).collect())
    }

    /// Returns the number of episodes won with each commitment. They match an evaluation of the player with the same
    /// seed, runs and step limit. On deterministic levels, a planner plans the same actions that it would choose at
    /// each look, so its episodes with one commitment stand for all commitments.
    ///
    /// # Errors
    /// Returns an error if the player cannot play the game.
    pub fn wins(
        &self,
        subject: &Subject,
        level: &SubjectLevel,
        player: &MarkPlayer,
        commits: &[Commitment],
    ) -> Result<Vec<u64>, EvaluationError> {
        let start = subject.game.start(&level.level, self.seed);
        let is_certain = subject.analysis.is_deterministic_from(&start);
        let mut wins: Vec<u64> = Vec::new();
        for &commit in commits {
            let known =
                wins.first().copied().filter(|_| is_certain && matches!(player, MarkPlayer::Planner(_)));
            wins.push(match known {
                Some(wins) => wins,
                None => self.wins_of(subject, level, player, commit)?,
            });
        }
        Ok(wins)
    }

    fn wins_of(
        &self,
        subject: &Subject,
        level: &SubjectLevel,
        player: &MarkPlayer,
        commit: Commitment,
    ) -> Result<u64, EvaluationError> {
        let prompter = match player {
            MarkPlayer::Planner(_) | MarkPlayer::Touching => None,
            MarkPlayer::Prompted(_) => {
                let prompter = Prompter::within(subject, PromptSettings::default(), self.max_steps, commit)?;
                Some(Arc::new(prompter))
            }
        };
        let mut wins = 0;
        for run in 0..self.runs {
            let task = Task {
                subject,
                level,
                run,
                seed: self.seed,
                max_steps: self.max_steps,
                commit,
                track: None,
                series: None,
            };
            let mut contestant = match (player, &prompter) {
                (MarkPlayer::Prompted(player), Some(prompter)) => {
                    Contestant::Agent(Box::new(Prompted::new(player.clone(), prompter.clone())))
                }
                (MarkPlayer::Planner(spec), _) => {
                    Contestant::Planner { spec: spec.clone(), budget: Budget(0) }
                }
                (MarkPlayer::Touching, _) => Contestant::Agent(Box::new(Touching::new(task.chance()))),
                (MarkPlayer::Prompted(_), None) => unreachable!("it has been made above"),
            };
            match play(&task, &mut contestant, &mut Journal::in_memory())? {
                PlayResult::Ended(outcome) => wins += u64::from(outcome == Outcome::Won),
                PlayResult::Halted(halt) => {
                    return Err(EvaluationError::Malformed(format!("`{player}`: {halt}")));
                }
            }
        }
        Ok(wins)
    }
}
