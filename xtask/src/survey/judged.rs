//! The measurements of one level.

use super::Made;
use agents::{Budget, DoNothing, Limits, Planner, PortfolioConfig, Random, Solution, play, solve};
use engine::analysis::{Condition, Reason, Role};
use engine::{Analysis, Digest, Level, Outcome, Seed, SpriteType};
use generators::levels::{LevelSimilarity, cover};
use std::collections::BTreeSet;

/// The result of the search for a win.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Found {
    Won,
    Impossible,
    Unknown,
}

/// The measurements of one level.
pub(super) struct Judged {
    pub(super) made: bool,
    pub(super) found: Found,
    /// The ticks of the witness.
    pub(super) ticks: usize,
    /// The share of episodes won by doing nothing.
    pub(super) idle: f64,
    /// The share of episodes won by random play.
    pub(super) random: f64,
    /// The names of missing things, if any.
    pub(super) missing: Vec<String>,
    pub(super) fits_size: bool,
    pub(super) fits_cover: bool,
    pub(super) cover: f64,
    /// A digest that is equal for a level and its reflections and rotations.
    pub(super) form: Option<Digest>,
    pub(super) milliseconds: f64,
}

/// The judge, which takes the measurements.
pub(super) struct Judge<'a> {
    pub(super) analysis: &'a Analysis,
    pub(super) likeness: &'a LevelSimilarity,
    pub(super) own: &'a [Level],
    pub(super) config: PortfolioConfig,
    pub(super) plays: u64,
    pub(super) seed: Seed,
}

impl Judge<'_> {
    pub(super) fn judge(&self, number: usize, made: &Made) -> Judged {
        let game = self.analysis.game();
        let again = |level: &&Level| game.level(&level.to_string()).as_ref() == Ok(*level);
        let Some(level) = made.level.as_ref().ok().filter(again) else { return Judged::nothing(made) };
        let seed = self.seed.child("level", number as u64);
        let (found, ticks) = self.found(level, seed);
        let share = cover(self.analysis, level);
        let range = |measure: &dyn Fn(&Level) -> f64, value: f64| {
            let low = self.own.iter().map(measure).fold(f64::INFINITY, f64::min);
            let high = self.own.iter().map(measure).fold(f64::NEG_INFINITY, f64::max);
            self.own.is_empty() || (low..=high).contains(&value)
        };
        Judged {
            made: true,
            found,
            ticks,
            idle: self.rate(level, seed.child("idle", 0), &|_| Box::new(DoNothing)),
            random: self.rate(level, seed.child("random", 0), &|seed| Box::new(Random::new(seed))),
            missing: missing(self.analysis, level),
            fits_size: range(&|own| own.columns() as f64, level.columns() as f64)
                && range(&|own| own.rows() as f64, level.rows() as f64),
            fits_cover: range(&|own| cover(self.analysis, own), share),
            cover: share,
            form: Some(self.likeness.digest(level)),
            milliseconds: made.milliseconds,
        }
    }

    fn found(&self, level: &Level, seed: Seed) -> (Found, usize) {
        if self.config.budget == 0 {
            return (Found::Unknown, 0);
        }
        if !self.analysis.can_win() || !self.analysis.reach(level).can_win() {
            return (Found::Impossible, 0);
        }
        match solve(self.analysis, level, &self.config, seed).solution {
            Solution::Won { episode, .. } => {
                let state = episode.replay(self.analysis.game(), level).expect("a witness replays");
                assert_eq!(state.outcome(), Outcome::Won, "a witness wins");
                (Found::Won, episode.actions.len())
            }
            Solution::Impossible { .. } => (Found::Impossible, 0),
            Solution::Unknown => (Found::Unknown, 0),
        }
    }

    /// The share of episodes that a player wins.
    fn rate(&self, level: &Level, seed: Seed, player: &dyn Fn(Seed) -> Box<dyn Planner>) -> f64 {
        let game = self.analysis.game();
        let wins = (0..self.plays).filter(|&run| {
            let seed = seed.child("play", run);
            let mut planner = player(seed.child("planner", 0));
            let chance = seed.child("chance", 0);
            let played = play(game, level, planner.as_mut(), Budget(0), chance, Limits::default());
            played.episode.outcome == Outcome::Won
        });
        wins.count() as f64 / self.plays.max(1) as f64
    }
}

impl Judged {
    /// The columns of [`Judged::line`].
    pub(super) const HEAD: &str =
        "game,level,made,found,ticks,idle,random,missing,size,cover,share,milliseconds\n";

    fn nothing(made: &Made) -> Judged {
        Judged {
            made: false,
            found: Found::Unknown,
            ticks: 0,
            idle: 0.0,
            random: 0.0,
            missing: vec![made.level.as_ref().err().cloned().unwrap_or_default()],
            fits_size: false,
            fits_cover: false,
            cover: 0.0,
            form: None,
            milliseconds: made.milliseconds,
        }
    }

    /// Returns `true` if neither doing nothing nor random play wins often.
    pub(super) fn is_hard(&self) -> bool {
        self.made && self.idle <= 0.1 && self.random <= 0.1
    }

    fn found_name(&self) -> &'static str {
        match self.found {
            Found::Won => "won",
            Found::Impossible => "impossible",
            Found::Unknown => "unknown",
        }
    }

    pub(super) fn caption(&self) -> String {
        let percent = |share: f64| (100.0 * share).round();
        format!(
            "{} {} idle {} random {}",
            self.found_name(),
            self.ticks,
            percent(self.idle),
            percent(self.random)
        )
    }

    pub(super) fn line(&self, game: &str, number: usize) -> String {
        format!(
            "{game},{number},{},{},{},{},{},{},{},{},{:.3},{:.2}\n",
            self.made,
            self.found_name(),
            self.ticks,
            self.idle,
            self.random,
            self.missing.join(" ").replace(',', ";"),
            self.fits_size,
            self.fits_cover,
            self.cover,
            self.milliseconds
        )
    }
}

/// The names of things that the goals or placed things require and that are missing.
fn missing(analysis: &Analysis, level: &Level) -> Vec<String> {
    let game = analysis.game();
    let count = |stype: SpriteType| {
        let placed = level.cells().iter().flat_map(|&symbol| game.places(symbol));
        placed.filter(|&&placed| placed == stype).count()
    };
    let sum = |types: &[SpriteType]| types.iter().map(|&stype| count(stype)).sum::<usize>();
    let mut names = BTreeSet::new();
    for goal in analysis.goals().iter().filter(|goal| goal.win) {
        let Condition::AtMost(types, _) = &goal.condition else { continue };
        let placed = |stype: &&SpriteType| {
            !analysis.facts(**stype).symbols.is_empty() && analysis.role(**stype) != Role::Avatar
        };
        let types: Vec<SpriteType> = types.iter().filter(placed).copied().collect();
        if !types.is_empty() && sum(&types) == 0 {
            names.insert(game.name(types[0]).to_owned());
        }
    }
    for requirement in analysis.requirements() {
        let asked = match requirement.reason {
            Reason::Avatar | Reason::Goal(_) => true,
            // Other rules may create missing things.
            Reason::WinMethod(_) => false,
            Reason::Lock(stype) | Reason::Portal(stype) => count(stype) > 0,
        };
        let there = sum(&requirement.types);
        let few = there < requirement.at_least as usize;
        let many = requirement.at_most.is_some_and(|most| there > most as usize);
        if asked && (few || many) {
            let name = requirement.types.first().map_or("nothing", |&stype| game.name(stype));
            names.insert(name.to_owned());
        }
    }
    names.into_iter().collect()
}
