//! All criteria of a release, in one place.

use crate::{Case, Finding, LengthWithin, NotIdle, NotRandom, Validator, Verdict, WellFormed, Winnable};
use engine::{Episode, Game, Level, Seed};
use serde::{Deserialize, Serialize};

/// The thresholds of all criteria; what a recipe's `[criteria]` says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Criteria {
    /// Forward-model calls of one decision of the searching player.
    pub decision: u64,
    /// Forward-model calls to find a win, all plays together.
    pub budget: u64,
    /// Look-ahead in ticks of each searching play.
    pub depths: Vec<u32>,
    /// Episodes of doing nothing.
    pub idle_plays: u32,
    /// Episodes of random play.
    pub random_plays: u32,
    /// The greatest share of them that may be won.
    pub random_wins: f64,
    /// Ticks that the shortest win found takes at least.
    pub least_ticks: usize,
    /// Ticks that it takes at most.
    pub most_ticks: usize,
}

impl Default for Criteria {
    fn default() -> Criteria {
        Criteria {
            decision: 500,
            budget: 3_000_000,
            depths: vec![10, 20, 40],
            idle_plays: 8,
            random_plays: 40,
            random_wins: 0.2,
            least_ticks: 8,
            most_ticks: 1000,
        }
    }
}

/// The validators of a set of criteria, cheapest first.
pub struct Panel {
    validators: Vec<Box<dyn Validator + Send>>,
}

/// What one validator found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Judgement {
    /// The validator.
    pub criterion: &'static str,
    /// What it found.
    #[serde(flatten)]
    pub finding: Finding,
}

/// What all validators found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// In the order of asking.
    pub judgements: Vec<Judgement>,
    /// The shortest win found.
    #[serde(skip)]
    pub witness: Option<Episode>,
}

impl Report {
    /// Whether every criterion is met.
    pub fn passes(&self) -> bool {
        self.judgements.iter().all(|judgement| judgement.finding.verdict.is_pass())
    }

    /// The first criterion that is not met.
    pub fn first_obstacle(&self) -> Option<&Judgement> {
        self.judgements.iter().find(|judgement| !judgement.finding.verdict.is_pass())
    }
}

impl Panel {
    /// The panel of these criteria.
    pub fn new(criteria: &Criteria) -> Panel {
        let &Criteria {
            decision,
            budget,
            idle_plays,
            random_plays,
            random_wins,
            least_ticks,
            most_ticks,
            ..
        } = criteria;
        let depths = criteria.depths.clone();
        Panel {
            validators: vec![
                Box::new(WellFormed),
                Box::new(NotIdle { plays: idle_plays }),
                Box::new(NotRandom { plays: random_plays, most: random_wins }),
                Box::new(Winnable { decision, budget, depths }),
                Box::new(LengthWithin { least: least_ticks, most: most_ticks }),
            ],
        }
    }

    /// Asks every validator.
    pub fn judge(&self, game: &Game, level: &Level, seed: Seed) -> Report {
        self.ask(game, level, seed, false)
    }

    /// Asks until one does not pass: for minting, where candidates are many.
    pub fn screen(&self, game: &Game, level: &Level, seed: Seed) -> Report {
        self.ask(game, level, seed, true)
    }

    fn ask(&self, game: &Game, level: &Level, seed: Seed, screen: bool) -> Report {
        let mut report = Report { judgements: Vec::new(), witness: None };
        for validator in &self.validators {
            let criterion = validator.name();
            let case = Case { game, level, seed: seed.child(criterion, 0), witness: report.witness.as_ref() };
            let finding = validator.validate(case);
            if let Verdict::Pass { witness: Some(witness) } = &finding.verdict {
                report.witness = Some(witness.clone());
            }
            let passed = finding.verdict.is_pass();
            report.judgements.push(Judgement { criterion, finding });
            if screen && !passed {
                break;
            }
        }
        report
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::Outcome;

    const GAME: &str = "BasicGame\n  SpriteSet\n    wall > Immovable\n    goal > Door\n    pit > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    g > goal\n    p > pit\n  InteractionSet\n    avatar wall > stepBack\n    avatar pit > killSprite\n    goal avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=goal win=True\n    SpriteCounter stype=avatar win=False\n    Timeout limit=60 win=False\n";

    fn check(game: &str, level: &str, expect: &[(&str, &str)]) -> Report {
        let game = Game::from_source(game).unwrap();
        let level = game.level(level).unwrap();
        let criteria = Criteria { budget: 100_000, ..Criteria::default() };
        let report = Panel::new(&criteria).judge(&game, &level, Seed::from_text("panel"));
        let word = |verdict: &Verdict| match verdict {
            Verdict::Pass { .. } => "pass",
            Verdict::Fail { .. } => "fail",
            Verdict::Unknown { .. } => "unknown",
        };
        let got = report.judgements.iter().map(|j| (j.criterion, word(&j.finding.verdict)));
        assert_eq!(got.collect::<Vec<_>>(), expect);
        if let Some(witness) = &report.witness {
            assert_eq!(witness.replay(&game, &level).unwrap().outcome(), Outcome::Won);
        }
        report
    }

    const GOOD: &str = "wwwwwwwww\nwA   w  w\nw wp wp w\nw  w   gw\nw pww   w\nwwwwwwwww\n";
    const WALLED: &str = "wwwwwwwww\nwA   w  w\nw wp wp w\nw  w  wgw\nw pww  ww\nwwwwwwwww\n";

    #[test]
    fn a_good_level_passes_with_a_witness() {
        let criteria = ["well-formed", "not-idle", "not-random", "winnable", "length"];
        assert!(check(GAME, GOOD, &criteria.map(|criterion| (criterion, "pass"))).passes());
    }

    #[test]
    fn a_goal_walled_in_is_unknown_never_a_pass() {
        let walled = WALLED.replace("wp w\n", "wppw\n");
        let report = check(
            GAME,
            &walled,
            &[
                ("well-formed", "pass"),
                ("not-idle", "pass"),
                ("not-random", "pass"),
                ("winnable", "unknown"),
                ("length", "unknown"),
            ],
        );
        assert_eq!(report.first_obstacle().unwrap().criterion, "winnable");
    }

    #[test]
    fn a_win_for_nothing_is_found() {
        let idle = GAME.replace("Timeout limit=60 win=False", "Timeout limit=60 win=True");
        let report = check(
            &idle,
            GOOD,
            &[
                ("well-formed", "pass"),
                ("not-idle", "fail"),
                ("not-random", "pass"),
                ("winnable", "pass"),
                ("length", "pass"),
            ],
        );
        assert_eq!(report.first_obstacle().unwrap().criterion, "not-idle");
    }

    #[test]
    fn a_game_over_at_the_start_or_never_won_is_not_well_formed() {
        let faults = [
            ("limit=60", "limit=0", "lost in its first tick"),
            (
                "goal avatar > killSprite scoreChange=1",
                "goal avatar > stepBack",
                "nothing lowers the number of",
            ),
            ("SpriteCounter stype=goal win=True", "Timeout limit=2500 win=True", "cannot be won"),
        ];
        for (part, fault, reason) in faults {
            let game = Game::from_source(&GAME.replace(part, fault)).unwrap();
            let level = game.level(GOOD).unwrap();
            let report = Panel::new(&Criteria::default()).screen(&game, &level, Seed::from_text("over"));
            assert_eq!(report.judgements.len(), 1);
            let obstacle = report.first_obstacle().unwrap();
            assert_eq!(obstacle.criterion, "well-formed");
            let Verdict::Fail { reason: told, .. } = &obstacle.finding.verdict else {
                panic!("{obstacle:?}")
            };
            assert!(told.0.contains(reason), "{told:?}");
        }
    }
}
