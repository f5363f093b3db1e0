//! The games of a stream.

use super::item::StreamItem;
use super::{Stream, StreamConfig, StreamError};
use crate::progress::Progress;
use crate::tally::Tally;
use base::{Seed, SeedPath};
use engine::{Analysis, Episode, Game, Level};
use generators::Generator;
use generators::levels::{ConstructiveLevels, Examples, LevelConfig, LevelSimilarity};
use std::sync::Arc;
use validators::{Case, Criterion, Judging};

/// A game for a stream.
#[derive(Clone, Debug)]
pub struct StreamGame {
    /// The name of the game in items and messages.
    pub name: String,
    /// The game.
    pub game: Game,
    /// The game's own levels. New levels resemble them, but none equals them.
    pub levels: Vec<Level>,
}

/// A game of a stream, with everything that its levels have in common.
pub(super) struct Source {
    name: String,
    game: Game,
    config: LevelConfig,
    similarity: LevelSimilarity,
}

/// A level that met all criteria.
struct Verified {
    path: SeedPath,
    level: Level,
    witness: Episode,
}

impl Source {
    pub(super) fn new(game: StreamGame, config: &StreamConfig) -> Result<Source, StreamError> {
        let StreamGame { name, game, levels } = game;
        let examples = Examples::of(&game, &levels).map(Arc::new);
        let like = examples.map_or_else(LevelConfig::default, LevelConfig::like);
        let like = LevelConfig { difficulty: config.difficulty.unwrap_or(like.difficulty), ..like };
        let config = match config.size {
            Some((columns, rows)) => LevelConfig { columns: (columns, columns), rows: (rows, rows), ..like },
            None => like,
        };
        if let Err(why) = ConstructiveLevels::new(&game, config.clone()) {
            return Err(StreamError::Generate { game: name, why });
        }
        let similarity = LevelSimilarity::of(&Analysis::of(&game));
        Ok(Source { name, game, config, similarity })
    }

    /// Draws levels until enough of them are verified, and returns the one whose rank among them fits the difficulty.
    /// Returns `None` if no drawn level is verified.
    pub(super) fn make(
        &self,
        stream: &Stream,
        index: u64,
        path: &SeedPath,
        tally: &mut Tally,
        progress: &dyn Progress,
    ) -> Option<StreamItem> {
        let StreamConfig { difficulty, choices, attempts, .. } = stream.config;
        let drawn = || path.seed().child("difficulty", 0).sampler().unit();
        let config = LevelConfig { difficulty: difficulty.unwrap_or_else(drawn), ..self.config.clone() };
        let generator = ConstructiveLevels::new(&self.game, config).expect("only the difficulty differs");
        // A random rank among several levels would only be a random level.
        let choices = if difficulty.is_some() { choices } else { 1 };
        let attempts = (0..attempts).map(|attempt| path.child("attempt", attempt));
        let verified = attempts.filter_map(|path| {
            progress.looked();
            self.draw(stream, &generator, path, tally)
        });
        let mut verified: Vec<Verified> = verified.take(choices).collect();
        if verified.len() > 1 {
            self.sort_by_ease(stream, generator.analysis(), &mut verified);
        }
        let rank = rank(difficulty.unwrap_or_default(), verified.len(), path.seed().child("rank", 0))?;
        let Verified { path, level, witness } = verified.swap_remove(rank);
        Some(StreamItem { index, game: self.name.clone(), path, difficulty, level, witness })
    }

    /// Draws one level, and returns it if it is new and meets all criteria.
    fn draw(
        &self,
        stream: &Stream,
        generator: &ConstructiveLevels<'_>,
        path: SeedPath,
        tally: &mut Tally,
    ) -> Option<Verified> {
        let Ok(level) = generator.generate(path.seed()) else {
            tally.no_level("no board has room");
            return None;
        };
        if stream.avoided.contains(&self.similarity.digest(&level)) {
            tally.no_level("a known level");
            return None;
        }
        let judging = Judging::level(&self.game, &level, path.child("panel", 0)).until_failure();
        let report = stream.panel.judge(judging);
        let obstacle = report.first_obstacle().map(|judgement| judgement.criterion);
        let obstacle = obstacle.or(report.witness.is_none().then_some(Criterion::Winnable));
        tally.level(&report.judgements, obstacle.map(Criterion::name));
        let witness = report.witness.filter(|_| obstacle.is_none())?;
        Some(Verified { path, level, witness })
    }

    /// Sorts levels from the easiest to the hardest for the stream's reference players. Levels of equal ease are sorted
    /// by the length of their witness.
    fn sort_by_ease(&self, stream: &Stream, analysis: &Analysis, levels: &mut Vec<Verified>) {
        let measured = levels.drain(..).map(|verified| {
            let Verified { path, level, witness } = &verified;
            let seed = path.child("players", 0);
            let case = Case { game: &self.game, level, seed: &seed, analysis, witness: Some(witness) };
            (stream.players.ladder(case).ease.unwrap_or_default(), verified)
        });
        let mut measured: Vec<(f64, Verified)> = measured.collect();
        measured.sort_by(|(one, shorter), (other, longer)| {
            let [shorter, longer] = [shorter, longer].map(|verified| verified.witness.actions.len());
            other.total_cmp(one).then(shorter.cmp(&longer))
        });
        levels.extend(measured.into_iter().map(|(_, verified)| verified));
    }
}

/// Returns the rank, from 0, of a difficulty among some levels; `None` if there are no levels. A difficulty between two
/// ranks yields the harder one with a probability that grows linearly.
fn rank(difficulty: f64, levels: usize, seed: Seed) -> Option<usize> {
    let exact = difficulty * levels.checked_sub(1)? as f64;
    Some(exact as usize + usize::from(seed.sampler().unit() < exact.fract()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_are_proportional_to_the_difficulty() {
        let seed = Seed::from_text("ranks");
        let mean = |difficulty, levels| {
            let ranks = (0..1000).map(|at| rank(difficulty, levels, seed.child("rank", at)).unwrap());
            ranks.sum::<usize>() as f64 / 1000.0
        };
        for (difficulty, levels, expect) in [(0.0, 4, 0.0), (1.0, 4, 3.0), (0.5, 3, 1.0), (0.9, 1, 0.0)] {
            assert_eq!(mean(difficulty, levels), expect, "{difficulty} of {levels}");
        }
        assert!((mean(0.25, 3) - 0.5).abs() < 0.05);
        assert_eq!(rank(0.5, 0, seed), None);
    }
}
