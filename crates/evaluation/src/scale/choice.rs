//! Chooses levels with a scale. A plan chooses levels for a target in advance. An adaptive choice selects
//! each level based on the results of the preceding episodes.

use super::file::ScaleFile;
use crate::run::{Adaptive, Settings, SubjectEntry};
use serde::Serialize;
use statistics::scale::{Chosen, MismatchPrior, PlayedGame, PlayedLevel, Selection, expected_error};

/// The sum of the two normal quantiles for a two-sided test at the 5% level with 80% power.
const POWER: f64 = 1.959964 + 0.841621;

/// An evaluation's levels, with their difficulties for a player.
#[derive(Clone, Debug, PartialEq)]
pub struct ScaledLevels {
    /// The levels, indexed by game and level in the evaluation.
    games: Vec<PlayedGame>,
    /// The error of the release's position on the scale: the standard error shared by the difficulties of all levels.
    link: f64,
    prior: MismatchPrior,
    /// `true` if `arcade study scale` could estimate the player's ability from results on each of the levels.
    pub is_linked: bool,
}

/// A plan's target.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Target {
    /// The given standard error of the ability, in logits.
    Error(f64),
    /// The given difference in logits between two players on the same levels, to be detected at the 5% level
    /// in 80% of evaluations.
    Difference(f64),
    /// The given number of episodes.
    Episodes(u64),
}

/// An evaluation plan: the levels to play and the expected errors.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plan {
    /// The plan's target.
    pub target: Target,
    /// The player's expected ability.
    pub ability: f64,
    /// The indices of the levels to play, by game.
    pub levels: Vec<Vec<usize>>,
    /// The number of episodes per level.
    pub runs: u64,
    /// The plan's number of episodes and expected errors.
    pub errors: PlannedErrors,
    /// `true` if the plan reaches the target.
    pub is_reached: bool,
    /// The expected errors for other numbers of episodes, up to one episode on each level.
    pub others: Vec<PlannedErrors>,
}

/// The expected errors after a number of episodes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PlannedErrors {
    /// The number of episodes.
    pub episodes: u64,
    /// The number of games played.
    pub games: u64,
    /// The ability's standard error.
    pub error: f64,
    /// The smallest difference between two players on the same levels that is detectable at the 5% level in
    /// 80% of evaluations.
    pub difference: f64,
}

impl ScaledLevels {
    /// Locates an evaluation's levels on a scale.
    ///
    /// # Errors
    /// Returns a message if any level is missing from the scale.
    pub fn of(scale: &ScaleFile, games: &[SubjectEntry], is_reader: bool) -> Result<ScaledLevels, String> {
        let (side, mut link, mut is_linked) = (usize::from(is_reader), 0.0_f64, true);
        let mut found = Vec::new();
        for game in games {
            let mut played = PlayedGame::default();
            for level in &game.levels {
                let place = scale.place(game.digest, level.digest);
                let (month, at, place) =
                    place.ok_or_else(|| format!("level {} of {}", level.number, game.id))?;
                let entry = &scale.months[month].games[at];
                let (difficulty, own) = entry.difficulty(place, side);
                played.common = entry.common[side];
                played.levels.push(PlayedLevel { difficulty, own, won: 0.0, of: 0.0 });
                link = link.max(scale.months[month].link[side]);
                is_linked &= !is_reader || scale.links_readers(month);
            }
            found.push(played);
        }
        Ok(ScaledLevels { games: found, link, prior: scale.mismatch_prior(is_reader), is_linked })
    }

    /// Plans an evaluation for a target. Episodes are spread over games first: each round adds each game's
    /// most informative remaining level at the given ability. If one run of all levels does not reach the
    /// target, each level is played several times, up to `most_runs`. Cost: O(levels² + levels · log
    /// `most_runs`).
    pub fn plan(&self, ability: f64, target: Target, most_runs: u64) -> Plan {
        let order = self.order(ability);
        let all = order.len() as u64;
        let is_reached = |errors: &PlannedErrors| match target {
            Target::Error(most) => errors.error <= most,
            Target::Difference(most) => errors.difference <= most,
            Target::Episodes(count) => errors.episodes >= count,
        };
        let sized =
            |count: u64, runs: u64| (count, runs, self.errors(&order[..count as usize], runs, ability));
        let of_one_run = (1..=all).map(|count| sized(count, 1)).find(|(.., errors)| is_reached(errors));
        let (count, runs, errors) = of_one_run.unwrap_or_else(|| {
            // More runs never increase an error, so bisection finds the minimum number of runs that reaches
            // the target.
            let (mut too_few, mut runs) = (1, most_runs.max(1));
            let is_reached = |runs: u64| is_reached(&sized(all, runs).2);
            while too_few + 1 < runs && is_reached(runs) {
                let middle = too_few + (runs - too_few) / 2;
                match is_reached(middle) {
                    true => runs = middle,
                    false => too_few = middle,
                }
            }
            sized(all, runs)
        });
        let mut levels = vec![Vec::new(); self.games.len()];
        order[..count as usize].iter().for_each(|&(game, level)| levels[game].push(level));
        levels.iter_mut().for_each(|of| of.sort_unstable());
        let games = self.games.len() as u64;
        let mut others: Vec<u64> = [25, 50, 100, 200, 400, games, all]
            .into_iter()
            .filter(|&count| (1..=all).contains(&count))
            .collect();
        others.sort_unstable();
        others.dedup();
        let others =
            others.into_iter().map(|count| self.errors(&order[..count as usize], 1, ability)).collect();
        Plan { target, ability, levels, runs, errors, is_reached: is_reached(&errors), others }
    }

    /// Returns all levels, in the order in which plans add them.
    fn order(&self, ability: f64) -> Vec<(usize, usize)> {
        let mut order: Vec<(usize, f64, usize, usize)> = Vec::new();
        for (game, of) in self.games.iter().enumerate() {
            let mut levels: Vec<(f64, usize)> =
                (0..of.levels.len()).map(|level| (self.error_of(game, level, ability), level)).collect();
            levels.sort_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)));
            order.extend(
                levels.into_iter().enumerate().map(|(round, (error, level))| (round, error, game, level)),
            );
        }
        order.sort_by(|one, other| {
            one.0.cmp(&other.0).then(one.1.total_cmp(&other.1)).then((one.2, one.3).cmp(&(other.2, other.3)))
        });
        order.into_iter().map(|(.., game, level)| (game, level)).collect()
    }

    /// Returns the standard error of the ability after a single episode on a level.
    fn error_of(&self, game: usize, level: usize, ability: f64) -> f64 {
        let one = PlayedLevel { of: 1.0, ..self.games[game].levels[level] };
        let game = PlayedGame { common: self.games[game].common, levels: vec![one] };
        expected_error(&[game], ability, self.prior.median, 0.0)
    }

    fn errors(&self, levels: &[(usize, usize)], runs: u64, ability: f64) -> PlannedErrors {
        let mut games = self.games.clone();
        levels.iter().for_each(|&(game, level)| games[game].levels[level].of = runs as f64);
        let error = expected_error(&games, ability, self.prior.median, self.link);
        // The errors of the difficulties cancel out, because both players play the same levels.
        for game in &mut games {
            game.common = 0.0;
            game.levels.iter_mut().for_each(|level| level.own = 0.0);
        }
        let alone = expected_error(&games, ability, self.prior.median, 0.0);
        let played =
            games.iter().filter(|game| game.levels.iter().any(|level| level.of > 0.0)).count() as u64;
        PlannedErrors {
            episodes: levels.len() as u64 * runs,
            games: played,
            error,
            difference: POWER * std::f64::consts::SQRT_2 * alone,
        }
    }
}

/// The adaptive choice of an evaluation's episodes. It depends only on the scale, the settings and the
/// outcomes so far, so an evaluation's logs reproduce its choices.
#[derive(Clone, Debug)]
pub struct AdaptiveChoice {
    selection: Selection,
    adaptive: Adaptive,
    /// For each episode of a run, the indices of its game and its level.
    places: Vec<(usize, usize)>,
    /// The number of times that each level has been chosen.
    runs: Vec<u64>,
    link: f64,
    choices: Vec<AdaptiveStep>,
}

/// A chosen episode, with the ability estimated before the episode.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AdaptiveStep {
    /// The game's ID.
    pub game: String,
    /// The level number.
    pub level: usize,
    /// The episode's index among the episodes on this level.
    pub run: u64,
    /// The ability estimated from previous episodes.
    pub ability: f64,
    /// The standard error of the estimated ability.
    pub error: f64,
}

impl AdaptiveChoice {
    /// Starts the choice for an evaluation with the given settings. Returns `None` if the settings are not
    /// adaptive.
    pub fn new(levels: &ScaledLevels, settings: &Settings) -> Option<AdaptiveChoice> {
        let places: Vec<(usize, usize)> = (settings.games.iter().enumerate())
            .flat_map(|(game, entry)| (0..entry.levels.len()).map(move |level| (game, level)))
            .collect();
        Some(AdaptiveChoice {
            selection: Selection::new(&levels.games, levels.prior.median, settings.runs),
            adaptive: settings.adaptive.clone()?,
            runs: vec![0; places.len()],
            places,
            link: levels.link,
            choices: Vec::new(),
        })
    }

    /// Returns the next episodes' indices among all of the evaluation's episodes, or an empty list to finish.
    /// `played` contains the episodes that have ended since the last call, with `true` for wins.
    pub fn next(&mut self, settings: &Settings, played: &[(usize, bool)]) -> Vec<usize> {
        for &(episode, won) in played {
            let (game, level) = self.places[episode % self.places.len()];
            self.selection.record(game, level, won);
        }
        let (_, error) = self.ability();
        let is_exact = self.adaptive.error.is_some_and(|most| error <= most);
        let left = self.adaptive.episodes.saturating_sub(self.choices.len() as u64);
        let due = if is_exact { 0 } else { self.adaptive.batch.min(left) };
        let link = self.link;
        let mut next = Vec::new();
        for _ in 0..due {
            let Some(Chosen { game, level, ability, error }) = self.selection.choose() else { break };
            let Some(at) = self.places.iter().position(|place| *place == (game, level)) else { break };
            let run = self.runs[at];
            self.runs[at] += 1;
            let entry = &settings.games[game];
            self.choices.push(AdaptiveStep {
                game: entry.id.clone(),
                level: entry.levels[level].number,
                run,
                ability,
                error: (error * error + link * link).sqrt(),
            });
            next.push(run as usize * self.places.len() + at);
        }
        next
    }

    /// Returns the ability estimated from the episodes so far, and its standard error.
    pub fn ability(&self) -> (f64, f64) {
        let (ability, error) = self.selection.ability();
        (ability, (error * error + self.link * self.link).sqrt())
    }

    /// Returns all choices made so far.
    pub fn choices(&self) -> &[AdaptiveStep] {
        &self.choices
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn levels() -> ScaledLevels {
        let level = |difficulty: f64| PlayedLevel { difficulty, own: 0.2, won: 0.0, of: 0.0 };
        let game = PlayedGame { common: 0.2, levels: [-2.0, 0.0, 2.0].map(level).to_vec() };
        ScaledLevels { games: vec![game; 40], link: 0.1, prior: MismatchPrior::default(), is_linked: true }
    }

    #[test]
    fn plans_spread_over_games_first() {
        let plan = levels().plan(2.0, Target::Episodes(50), 1);
        assert_eq!((plan.errors.episodes, plan.errors.games, plan.runs), (50, 40, 1));
        // The plan takes the most informative level of each game, and a second level of some games.
        assert!(plan.levels.iter().all(|of| of.contains(&2)), "{plan:?}");
        assert_eq!(plan.levels.iter().filter(|of| of.len() == 2).count(), 10);
    }

    #[test]
    fn targets_are_reached_or_not() {
        let plan = levels().plan(0.0, Target::Error(0.5), 1);
        assert!(plan.is_reached && plan.errors.error <= 0.5 && plan.errors.episodes < 60, "{plan:?}");
        let before = levels().plan(0.0, Target::Episodes(plan.errors.episodes - 1), 1);
        assert!(before.errors.error > 0.5, "{before:?}");
        let far = levels().plan(0.0, Target::Difference(0.2), 3);
        assert!(!far.is_reached && far.runs == 3 && far.errors.episodes == 360, "{far:?}");
        // The maximum number of runs does not affect the cost of planning. A plan has no more runs than the
        // target requires.
        let much = levels().plan(0.0, Target::Error(0.25), 1_000_000);
        let [enough, less] =
            [much.runs, much.runs - 1].map(|runs| levels().plan(0.0, Target::Error(0.25), runs));
        assert!(much.is_reached && much.runs > 1 && enough == much && !less.is_reached, "{much:?}");
        let none = ScaledLevels { games: Vec::new(), ..levels() }.plan(0.0, Target::Episodes(1), 9);
        assert!(!none.is_reached && none.errors.episodes == 0, "{none:?}");
        // A single run has at most as many episodes as there are levels.
        assert_eq!(far.others.last().map(|one| one.episodes), Some(120));
    }
}
