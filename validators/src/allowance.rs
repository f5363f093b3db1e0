//! A validation budget: a number of forward-model calls, divided among the criteria.
//!
//! Minting does not need such a budget, because recipes limit each criterion separately. A designer, in contrast, sets
//! a single number and expects an answer after about that much work, whatever the game.

use crate::measures::LadderConfig;
use crate::thresholds::CheckedCriteria;
use agents::PortfolioConfig;
use base::Seed;
use engine::{Action, Game, Level, Meeting, Watch};

/// The maximum work per tick, in the engine's units, at which a call has a weight of 1.
const USUAL_WORK: u64 = 4096;
/// The number of ticks to play when estimating a level's work per tick.
const SAMPLED_TICKS: u64 = 16;

/// The number of forward-model calls to divide among the criteria, both for each level and for the game as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Allowance {
    calls: u64,
    /// The weight of a single call. It is greater than 1 if ticks are unusually expensive.
    weight: u64,
}

/// A counter of the total work done by all ticks.
struct WorkCounter(u64);

impl Watch for WorkCounter {
    fn interaction(&mut self, _: usize) {}

    fn meeting(&mut self, _: Meeting) {}

    fn worked(&mut self, work: usize) {
        self.0 = self.0.saturating_add(work as u64);
    }
}

impl Allowance {
    /// Returns the allowance (the call budgets of the criteria) for the given levels. It is smaller if the ticks on any
    /// level are unusually expensive. Costs a few ticks on each level.
    pub(crate) fn of<'a>(calls: u64, game: &Game, levels: impl IntoIterator<Item = &'a Level>) -> Allowance {
        let weight_of = |level: &Level| {
            let mut state = game.start(level, Seed::from_text("weigh"));
            let mut counter = WorkCounter(0);
            let mut ticks = 0;
            while ticks < SAMPLED_TICKS && !state.is_over() {
                game.step_watched(&mut state, Action::Nil, &mut counter);
                ticks += 1;
            }
            counter.0 / ticks.max(1) / USUAL_WORK + 1
        };
        Allowance { calls, weight: levels.into_iter().map(weight_of).max().unwrap_or(1) }
    }

    /// Returns the fraction `times / of` of the calls, but at least `least`.
    fn share(self, times: u64, of: u64, least: u64) -> u64 {
        let share = u128::from(self.calls) * u128::from(times) / u128::from(of.max(1));
        let share = u64::try_from(share).unwrap_or(u64::MAX).max(least);
        (share / self.weight).max(1)
    }
}

/// The effort that a panel of judges spends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// All episodes and searches that the criteria specify. Used for reports.
    Full,
    /// Like [`Effort::Full`], except that `skill` stops its players as soon as the answer is practically certain. Used
    /// for minting, which judges many candidates.
    Sequential,
    /// A number of forward-model calls to divide among the criteria, both for each level and for the game as a whole.
    /// All criteria together make up to about eight times as many calls, but at least as many as an answer requires.
    /// Work beyond the limit is stopped, which leaves the answer unknown. An unusually expensive tick counts as several
    /// calls.
    Calls(u64),
}

/// The criteria, with their judges' budgets for the given levels.
#[derive(Clone, Copy)]
pub(crate) struct Setting<'a> {
    /// The criteria. For numbers that the allowance (the call budget) limits, use the methods instead of this field.
    pub(crate) criteria: &'a CheckedCriteria,
    allowance: Option<Allowance>,
    is_sequential: bool,
}

impl<'a> Setting<'a> {
    /// Returns the setting for judging the given levels. Costs a few ticks on each level if the number of calls is
    /// limited.
    pub(crate) fn new(
        criteria: &'a CheckedCriteria,
        effort: Effort,
        game: &Game,
        levels: impl IntoIterator<Item = &'a Level>,
    ) -> Setting<'a> {
        let allowance = match effort {
            Effort::Full | Effort::Sequential => None,
            Effort::Calls(calls) => Some(Allowance::of(calls, game, levels)),
        };
        Setting { criteria, allowance, is_sequential: effort == Effort::Sequential }
    }

    /// Returns `full` or, if that is smaller, the fraction `times / of` of the allowance.
    fn bounded(&self, full: u64, [times, of]: [u64; 2]) -> u64 {
        self.allowance.map_or(full, |allowance| allowance.share(times, of, 1).min(full))
    }

    /// Returns the number of ticks per idle episode.
    pub(crate) fn idle_ticks(&self) -> usize {
        self.allowance.map_or(usize::MAX, |allowance| allowance.share(1, 16, 500) as usize)
    }

    /// Returns the number of ticks per episode of random actions.
    pub(crate) fn random_ticks(&self) -> usize {
        self.allowance.map_or(usize::MAX, |allowance| allowance.share(1, 80, 250) as usize)
    }

    /// Returns the number of forward-model calls to spend, per random seed, on surviving the first ticks.
    pub(crate) fn early_calls(&self) -> u64 {
        let seeds = u64::from(self.criteria.early_seeds);
        self.bounded(self.criteria.early_calls, [1, 2 * seeds])
    }

    /// Returns the configuration of the win search.
    pub(crate) fn search(&self) -> PortfolioConfig {
        PortfolioConfig { budget: self.bounded(self.criteria.budget, [1, 1]), ..self.criteria.search() }
    }

    /// Returns the players of the ladder, which are reference players of increasing strength.
    pub(crate) fn players(&self) -> LadderConfig {
        LadderConfig { calls: self.bounded(self.criteria.ladder_calls, [5, 3]), ..self.criteria.players() }
    }

    /// Returns the number of forward-model calls per episode of a player on the ladder of reference players.
    pub(crate) fn ladder_play_calls(&self) -> u64 {
        self.bounded(u64::MAX, [2, self.criteria.players().round_plays()])
    }

    /// Returns `true` if players stop as soon as the answer is practically certain.
    pub(crate) fn is_sequential(&self) -> bool {
        self.is_sequential
    }

    /// Returns the number of ticks per level for random walks that look for rules not executed so far.
    pub(crate) fn exploration(&self) -> u64 {
        self.bounded(u64::MAX, [1, 3])
    }

    /// Returns the limit, if any, on the total number of forward-model calls for ablating all rules.
    pub(crate) fn ablation_calls(&self) -> Option<u64> {
        self.allowance.map(|allowance| allowance.share(4, 1, 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Criteria, Criterion, GameReport, Judging, Panel, Report};

    /// A game in which a moth eventually reaches the goal, but rarely before the 1000th tick.
    const GAME: &str = "BasicGame\n  SpriteSet\n    wall > Immovable\n    goal > Door\n    moth > RandomNPC cooldown=60\n    avatar > MovingAvatar\n  LevelMapping\n    g > goal\n    m > moth\n  InteractionSet\n    avatar wall > stepBack\n    moth wall > stepBack\n    goal moth > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=goal win=True\n    Timeout limit=1000 win=False\n";
    const LEVEL: &str = "wwwwwwwwwwwwwwwwwwwwwwwwwwwwwww\nwA                            w\nwwwwwwwwwwwwwwwwwwwwwwwwwwwwwww\nwm                           gw\nwwwwwwwwwwwwwwwwwwwwwwwwwwwwwww\n";

    fn report(calls: u64) -> GameReport {
        let game = Game::from_source(GAME).unwrap();
        let level = game.level(LEVEL).unwrap();
        let criteria = Criteria { budget: calls, ..Criteria::full() };
        let panel = Panel::new(criteria.check().unwrap(), Effort::Calls(calls));
        panel.judge(Judging::game(&game, &[level], Seed::from_text("allowance")))
    }

    /// Returns the number of calls plus the ticks in all episodes.
    fn spent(report: &Report) -> u64 {
        let of = |judged: &crate::Judgement| {
            let ticks: usize = judged.finding.episodes.iter().map(|episode| episode.actions.len()).sum();
            judged.finding.calls() + ticks as u64
        };
        report.judgements.iter().map(of).sum()
    }

    #[test]
    fn a_budget_bounds_all_criteria_together() {
        for calls in [1, 1000, 20_000] {
            let report = report(calls);
            let spent = spent(&report.levels[0]);
            // The minimum consists of one decision per player and the shortest episodes.
            assert!(spent < 30_000 + 8 * calls, "{calls}: {spent}");
            // An episode that was stopped early gives no answer.
            for judged in report.levels[0].judgements.iter().chain(&report.judgements) {
                let broken =
                    [Criterion::NotRandom, Criterion::Winnable, Criterion::Skill].contains(&judged.criterion);
                let unknown = matches!(judged.finding.verdict, crate::Verdict::Unknown { .. });
                assert!(!broken || unknown, "{calls}: {} is answered", judged.criterion);
            }
        }
    }

    #[test]
    fn heavy_ticks_count_for_more() {
        let game = Game::from_source(GAME).unwrap();
        let usual = game.level(LEVEL).unwrap();
        assert_eq!(Allowance::of(900, &game, [&usual]).weight, 1);
        let crowd = format!("{}A\n", "m".repeat(90)) + &format!("{}\n", "m".repeat(91)).repeat(80);
        let crowd = game.level(&crowd).unwrap();
        let heavy = Allowance::of(900, &game, [&usual, &crowd]);
        assert!(heavy.weight > 1, "{heavy:?}");
        assert!(heavy.share(1, 3, 1) < 300);
    }

    #[test]
    fn the_default_budget_covers_usual_levels() {
        let game = Game::from_source(GAME).unwrap();
        let criteria = Criteria::full().check().unwrap();
        let level = game.level(LEVEL).unwrap();
        let setting = |effort| Setting::new(&criteria, effort, &game, [&level]);
        let (bounded, full) = (setting(Effort::Calls(criteria.budget)), setting(Effort::Full));
        let limits = |setting: Setting<'_>| (setting.search(), setting.early_calls(), setting.players());
        assert_eq!(limits(bounded), limits(full));
        assert!(bounded.idle_ticks() > 2000 && bounded.random_ticks() > 2000);
        assert!(bounded.ladder_play_calls() > 1000 * 301);
    }
}
