//! The work that a validation may take: a number of forward-model calls, divided among the criteria.
//!
//! Minting does not need this: its recipe bounds each criterion by itself. A designer names one number and wants an
//! answer after about as much work, whatever the game.

use crate::Criteria;
use base::Seed;
use engine::{Action, Game, Level, Meeting, Watch};

/// The work of a tick, as `engine` counts it, up to which a call counts as one.
const USUAL_WORK: u64 = 4096;
/// Ticks that are played to estimate the work of a level's ticks.
const SAMPLED_TICKS: u64 = 16;

/// Forward-model calls for each level, and for the game over all its levels, to divide among the criteria.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Allowance {
    calls: u64,
    /// The number of calls that one call counts as: more than one where ticks are unusually heavy.
    weight: u64,
}

/// Adds up the work of ticks.
struct WorkCounter(u64);

impl Watch for WorkCounter {
    fn interaction(&mut self, _: usize) {}

    fn meeting(&mut self, _: Meeting) {}

    fn worked(&mut self, work: usize) {
        self.0 = self.0.saturating_add(work as u64);
    }
}

impl Allowance {
    /// Returns the calls allowed for these levels: fewer where the ticks of one of them are unusually heavy. Cost:
    /// some ticks of each.
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

    /// A share of the calls, at least `least`.
    fn share(self, times: u64, of: u64, least: u64) -> u64 {
        let share = u128::from(self.calls) * u128::from(times) / u128::from(of.max(1));
        let share = u64::try_from(share).unwrap_or(u64::MAX).max(least);
        (share / self.weight).max(1)
    }

    /// Ticks of one episode of doing nothing.
    pub(crate) fn idle_play(self) -> usize {
        self.share(1, 16, 500) as usize
    }

    /// Ticks of one episode of random actions.
    pub(crate) fn random_play(self) -> usize {
        self.share(1, 80, 250) as usize
    }

    /// Returns the criteria with the call limits of this allowance.
    pub(crate) fn bounds(self, criteria: &Criteria) -> Criteria {
        let seeds = u64::from(criteria.early_seeds.max(1));
        Criteria {
            budget: self.share(1, 1, 1).min(criteria.budget),
            early_calls: self.share(1, 2 * seeds, 1).min(criteria.early_calls),
            ladder_calls: self.share(5, 3, 1).min(criteria.ladder_calls),
            ..criteria.clone()
        }
    }

    /// Calls of one play of the ladder, with `round_plays` plays a round.
    pub(crate) fn ladder_play(self, round_plays: u64) -> u64 {
        self.share(2, round_plays, 1)
    }

    /// Ticks of the random walks that look for rules which were never executed, for each level.
    pub(crate) fn exploration(self) -> u64 {
        self.share(1, 3, 1)
    }

    /// Calls of the ablation of all rules together.
    pub(crate) fn ablation(self) -> u64 {
        self.share(4, 1, 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Panel, Report};

    /// A moth that reaches the goal at some time, rarely before the 1000th tick.
    const GAME: &str = "BasicGame\n  SpriteSet\n    wall > Immovable\n    goal > Door\n    moth > RandomNPC cooldown=60\n    avatar > MovingAvatar\n  LevelMapping\n    g > goal\n    m > moth\n  InteractionSet\n    avatar wall > stepBack\n    moth wall > stepBack\n    goal moth > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=goal win=True\n    Timeout limit=1000 win=False\n";
    const LEVEL: &str = "wwwwwwwwwwwwwwwwwwwwwwwwwwwwwww\nwA                            w\nwwwwwwwwwwwwwwwwwwwwwwwwwwwwwww\nwm                           gw\nwwwwwwwwwwwwwwwwwwwwwwwwwwwwwww\n";

    fn report(calls: u64) -> (Report, Vec<crate::Judgement>) {
        let game = Game::from_source(GAME).unwrap();
        let level = game.level(LEVEL).unwrap();
        let criteria = Criteria { budget: calls, ..Criteria::full() };
        let panel = Panel::bounded(&criteria, calls).unwrap();
        let report = panel.judge(&game, &level, Seed::from_text("allowance"));
        let together = panel.judge_together(
            &game,
            &[level],
            std::slice::from_ref(&report),
            Seed::from_text("allowance"),
        );
        (report, together)
    }

    /// Returns the calls, and the ticks of all episodes.
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
            let (report, together) = report(calls);
            let spent = spent(&report);
            // The minimum is one decision of each player, and the shortest plays.
            assert!(spent < 30_000 + 8 * calls, "{calls}: {spent}");
            // A play that was broken off gives no answer.
            for judged in report.judgements.iter().chain(&together) {
                let broken = ["not-random", "winnable", "skill"].contains(&judged.criterion);
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
        assert!(heavy.exploration() < 300);
    }

    #[test]
    fn the_default_budget_covers_usual_levels() {
        let game = Game::from_source(GAME).unwrap();
        let criteria = Criteria::full();
        let allowance = Allowance::of(criteria.budget, &game, [&game.level(LEVEL).unwrap()]);
        assert_eq!(allowance.bounds(&criteria), criteria);
        assert!(allowance.idle_play() > 2000 && allowance.random_play() > 2000);
        assert!(allowance.ladder_play(16) > 1000 * 301);
    }
}
