//! Plays the episodes of reference players in memory. Their results are stored in a release (as its *marks*), where
//! they are the baseline for other results.

use super::ReferencePlayer;
use crate::commitment::Commitment;
use crate::error::EvaluationError;
use crate::log::Journal;
use crate::run::{PlayResult, Task, play};
use crate::subject::{Subject, SubjectFacts, SubjectLevel};
use base::Seed;
use engine::Outcome;
use itertools::iproduct;
use rayon::prelude::*;

/// The parameters for a reference player's episodes.
#[derive(Clone, Copy, Debug)]
pub struct ReferencePlays {
    /// The seed of the evaluation to which the episodes belong.
    pub seed: Seed,
    /// The number of episodes per commitment, which is a number of actions per decision.
    pub runs: u64,
    /// The maximum number of actions per episode.
    pub max_steps: u64,
}

/// The default text from which `arcade evaluate` derives the randomness of games. With this text, reference
/// players have the same results as in such an evaluation.
pub const SEED: &str = "evaluate";

impl ReferencePlays {
    /// Plays a game's levels with each player and each commitment (number of actions per decision). Levels are given as
    /// texts, and players and commitments by name. Returns the number of wins for each level, player and commitment.
    ///
    /// # Errors
    /// Returns an error if the game cannot be loaded, if a player or commitment does not exist, or if a player cannot
    /// play the game.
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
        let players: Vec<ReferencePlayer> =
            players.iter().map(|name| name.parse()).collect::<Result<_, _>>()?;
        let commits: Vec<Commitment> = commits.map(str::parse).collect::<Result<_, _>>()?;
        let each: Vec<(&SubjectLevel, &ReferencePlayer)> = iproduct!(&subject.levels, &players).collect();
        let wins = each.into_par_iter().with_max_len(1).map(|(level, player)| {
            self.wins(&subject, level, player, &commits).map_err(|error| error.to_string())
        });
        let wins: Vec<Vec<u64>> = wins.collect::<Result<_, _>>()?;
        Ok(wins.chunks(players.len()).map(<[_]>::to_vec).collect())
    }

    /// Returns the number of wins with each commitment (number of actions per decision).
    ///
    /// The numbers match an evaluation of the player with the same seed, runs and step limit. On deterministic levels,
    /// a planner plans the same actions that it would choose one by one, so its results with one commitment also apply
    /// to all other commitments.
    ///
    /// # Errors
    /// Returns an error if the player cannot play the game.
    pub fn wins(
        &self,
        subject: &Subject,
        level: &SubjectLevel,
        player: &ReferencePlayer,
        commits: &[Commitment],
    ) -> Result<Vec<u64>, EvaluationError> {
        let start = subject.game.start(&level.level, self.seed);
        let is_certain = subject.analysis.is_deterministic_from(&start);
        let mut wins: Vec<u64> = Vec::new();
        for &commit in commits {
            let known =
                wins.first().copied().filter(|_| is_certain && matches!(player, ReferencePlayer::Planner(_)));
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
        player: &ReferencePlayer,
        commit: Commitment,
    ) -> Result<u64, EvaluationError> {
        let prompter = player.prompter(subject, self.max_steps, commit)?;
        let mut wins = 0;
        for run in 0..self.runs {
            let task = Task {
                subject,
                level,
                run,
                seed: self.seed,
                max_steps: self.max_steps,
                commit,
                max_output_tokens: None,
                track: None,
                series: None,
            };
            let mut contestant = player.contestant(prompter.as_ref(), task.chance());
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
