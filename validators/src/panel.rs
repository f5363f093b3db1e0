//! The panel of judges for a set of criteria.

use crate::allowance::{Effort, Setting};
use crate::case::Case;
use crate::criteria::{is_over_at_once, without_proof};
use crate::criterion::{About, Criterion, Stage};
use crate::evidence::Evidence;
use crate::explain::{causes, culprits, too_soon};
use crate::gates::CarelessPlays;
use crate::judging::{GameSubject, Judging, LevelSubject, Observer, TogetherSubject};
use crate::measures::Ladder;
use crate::recording::{Usage, record, recorded};
use crate::report::{GameReport, Judgement, OVER, Report};
use crate::thresholds::CheckedCriteria;
use crate::validator::{GameCase, GameJudge, LevelJudge};
use crate::verdict::{Finding, Verdict};
use agents::Stopped;
use engine::{Analysis, Episode, Level};
use rayon::prelude::*;

/// The judges for a set of criteria. The criteria are checked from cheapest to most expensive.
#[derive(Clone, Debug)]
pub struct Panel {
    criteria: CheckedCriteria,
    effort: Effort,
}

/// The message for criteria skipped on an unwinnable level.
const UNWINNABLE: &str = "skipped: the level cannot be won";
/// The message for criteria skipped because the game stops in its first tick.
const STOPPED: &str = "skipped: the game stops in its first tick";

impl Panel {
    /// Creates the panel for the given criteria.
    pub fn new(criteria: CheckedCriteria, effort: Effort) -> Panel {
        Panel { criteria, effort }
    }

    /// Judges a level, a game with its levels, or, if the levels have already been judged, the game as a whole.
    pub fn judge<S: Subject>(&self, judging: Judging<'_, S>) -> S::Findings {
        S::judged_by(self, judging)
    }

    /// Judges a game. First judges each level, with a seed derived from its text, so that the result does not
    /// depend on the other levels. Then judges all levels together.
    fn judge_game(&self, judging: Judging<'_, GameSubject<'_>>) -> GameReport {
        let Judging { subject: GameSubject { game, levels }, seed, stop_at_first, observer } = judging;
        let stopped = observer.as_ref().map(|observer| observer.stopped);
        let judge = |level: &Level| {
            let hear = &mut |_: &Judgement| true;
            let observer = stopped.map(|stopped| Observer { hear, stopped });
            let seed = seed.child(&level.digest().to_string(), 0);
            self.judge_level(Judging { stop_at_first, observer, ..Judging::level(game, level, seed) })
        };
        let reports: Vec<Report> = levels.par_iter().map(judge).collect();
        let together = Judging { stop_at_first, observer, ..Judging::together(game, levels, &reports, seed) };
        let judgements = self.judge_together(together);
        GameReport { levels: reports, judgements }
    }

    fn judge_together(&self, judging: Judging<'_, TogetherSubject<'_>>) -> Vec<Judgement> {
        let Judging { subject, seed, stop_at_first, observer } = judging;
        let seed = seed.seed();
        let TogetherSubject { game, levels, reports } = subject;
        let mut ignore = |_: &Judgement| true;
        let (hear, stopped): (&mut dyn FnMut(&Judgement) -> bool, Stopped<'_>) = match observer {
            Some(Observer { hear, stopped }) => (hear, stopped),
            None => (&mut ignore, &|| false),
        };
        if levels.is_empty() || !self.criteria.ask.iter().any(Criterion::of_game) {
            return Vec::new();
        }
        let setting = Setting::new(&self.criteria, self.effort, game, levels);
        let asked = self.criteria.ask.iter();
        let judges: Vec<GameJudge> = asked.filter_map(|criterion| criterion.game_judge(&setting)).collect();
        let analysis = Analysis::of(game);
        let explores = judges.iter().any(|judge| judge.validator.asks_for_usage());
        let ticks = if explores { setting.exploration() } else { 0 };
        let episodes = record(game, levels, reports, seed.child("explore", 0), ticks);
        let recording = recorded(levels, &episodes);
        let usage = Usage::within(game, &recording, ticks);
        let ladders: Vec<Option<&Ladder>> = reports.iter().map(Report::ladder).collect();
        let careless = CarelessPlays::new(game, levels.len(), seed.child("careless", 0));
        let mut judgements = Vec::new();
        for GameJudge { criterion, about, validator } in &judges {
            if stopped() {
                break;
            }
            let case = GameCase {
                game,
                analysis: &analysis,
                recording: &recording,
                ladders: &ladders,
                usage: &usage,
                careless: &careless,
                seed: seed.child(criterion.name(), 0),
            };
            let finding = validator.validate_until(case, stopped);
            let why = consequence(reports, &finding.verdict).filter(|_| *about == About::Rules);
            let finding = why.map_or(finding, |why| skipped(&why));
            let passed = finding.verdict.is_pass();
            let judgement = Judgement { criterion: *criterion, finding };
            let goes_on = !stopped() && hear(&judgement);
            judgements.push(judgement);
            if !goes_on || stop_at_first && !passed {
                break;
            }
        }
        judgements
    }

    fn judge_level(&self, judging: Judging<'_, LevelSubject<'_>>) -> Report {
        let Judging { subject: LevelSubject { game, level, witness }, seed, stop_at_first, observer } =
            judging;
        let mut ignore = |_: &Judgement| true;
        let (hear, stopped): (&mut dyn FnMut(&Judgement) -> bool, Stopped<'_>) = match observer {
            Some(Observer { hear, stopped }) => (hear, stopped),
            None => (&mut ignore, &|| false),
        };
        let setting = Setting::new(&self.criteria, self.effort, game, [level]);
        let asked = self.criteria.ask.iter();
        let judges: Vec<LevelJudge> = asked.filter_map(|criterion| criterion.level_judge(&setting)).collect();
        let analysis = Analysis::of(game);
        let mut report = Report { judgements: Vec::new(), witness };
        let run = |judge: &LevelJudge, witness: Option<&Episode>| {
            let LevelJudge { criterion, stage, validator } = judge;
            let seed = criterion.seed(&seed);
            let case = Case { game, level, seed: &seed, analysis: &analysis, witness };
            let mut finding = validator.validate_until(case, stopped);
            if *stage == Stage::Search && !stop_at_first && !stopped() {
                causes::explain(case, &mut finding);
                if !too_soon::explain(case, &mut finding, &setting.search()) {
                    culprits::explain(case, &mut finding, &setting.search());
                }
            }
            Judgement { criterion: *criterion, finding }
        };
        let mut is_over = false;
        for judge in &judges {
            let LevelJudge { criterion, stage, .. } = judge;
            let why = match stage {
                Stage::Start => None,
                _ if report.is_stopped() => Some(STOPPED),
                _ if is_over => Some(OVER),
                Stage::Win | Stage::Ladder if report.is_unwinnable() => Some(UNWINNABLE),
                _ => None,
            };
            if let Some(why) = why {
                let judgement = Judgement { criterion: *criterion, finding: skipped(why) };
                let goes_on = hear(&judgement);
                report.judgements.push(judgement);
                if !goes_on {
                    return report;
                }
                continue;
            }
            let mut judgement = run(judge, report.witness.as_ref());
            match stage {
                Stage::Search => report.accept(&mut judgement),
                Stage::Win => without_proof(&mut judgement.finding, &report),
                _ => {}
            }
            let passed = judgement.finding.verdict.is_pass();
            let is_decided = matches!(judgement.finding.verdict, Verdict::Fail { witness: Some(_), .. });
            let is_start = *criterion == Criterion::WellFormed && is_decided;
            let goes_on = !stopped() && hear(&judgement);
            report.judgements.push(judgement);
            if !goes_on || stop_at_first && !passed {
                return report;
            }
            is_over |= is_start && is_over_at_once(game, level, seed.seed());
        }
        // A reference player on the ladder may win a level that the search did not.
        if let (None, Some(won)) = (&report.witness, report.shortest_win()) {
            report.witness = Some(won);
            let searched = report.clone();
            for (judge, judged) in judges.iter().zip(&mut report.judgements) {
                let Verdict::Unknown { .. } = judged.finding.verdict else { continue };
                match judge.stage {
                    Stage::Search => {
                        judged.finding.verdict = Verdict::Pass { witness: report.witness.clone() }
                    }
                    Stage::Win => {
                        *judged = run(judge, report.witness.as_ref());
                        without_proof(&mut judged.finding, &searched);
                    }
                    _ => continue,
                }
                if !hear(judged) {
                    break;
                }
            }
        }
        report
    }
}

/// A subject for a [`Panel`] of judges: a level or a game.
pub trait Subject: Sized + sealed::Sealed {
    /// The findings about the subject.
    type Findings;

    #[doc(hidden)]
    fn judged_by(panel: &Panel, judging: Judging<'_, Self>) -> Self::Findings;
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::LevelSubject<'_> {}
    impl Sealed for super::GameSubject<'_> {}
    impl Sealed for super::TogetherSubject<'_> {}
}

impl Subject for LevelSubject<'_> {
    type Findings = Report;

    fn judged_by(panel: &Panel, judging: Judging<'_, Self>) -> Report {
        panel.judge_level(judging)
    }
}

impl Subject for GameSubject<'_> {
    type Findings = GameReport;

    fn judged_by(panel: &Panel, judging: Judging<'_, Self>) -> GameReport {
        panel.judge_game(judging)
    }
}

impl Subject for TogetherSubject<'_> {
    type Findings = Vec<Judgement>;

    fn judged_by(panel: &Panel, judging: Judging<'_, Self>) -> Vec<Judgement> {
        panel.judge_together(judging)
    }
}

/// Returns the finding for a criterion that is skipped for the given reason.
fn skipped(why: &str) -> Finding {
    Finding::from(Verdict::Unknown { spent: 0 }).seen([Evidence::new(why)])
}

/// Returns the reason why a verdict on the rules should not count, if there is one. The verdict may merely be a
/// consequence of levels that are unwinnable or over in their first tick. If all levels are, the verdict is
/// meaningless.
fn consequence(reports: &[Report], verdict: &Verdict) -> Option<String> {
    if reports.iter().any(Report::is_stopped) && !verdict.is_pass() {
        return Some(STOPPED.to_owned());
    }
    let count = |is: fn(&Report) -> bool| reports.iter().filter(|report| is(report)).count();
    let (lost, over, all) = (count(Report::is_unwinnable), count(Report::is_over), reports.len());
    if over == all {
        return Some(OVER.to_owned());
    }
    match verdict {
        _ if lost + over == 0 => None,
        _ if lost == all => {
            Some(if all == 1 { UNWINNABLE } else { "skipped: no level can be won" }.to_owned())
        }
        Verdict::Pass { .. } => None,
        // A proof over all levels holds even if some levels cannot be won.
        Verdict::Fail { .. } => None,
        Verdict::Unknown { .. } if over > 0 => {
            Some(format!("skipped: the game is over in its first tick on {over} of {all} levels"))
        }
        Verdict::Unknown { .. } => Some(format!("skipped: {lost} of {all} levels cannot be won")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Criteria;
    use base::{Seed, SeedPath};
    use engine::{Game, Outcome};

    const GAME: &str = "BasicGame\n  SpriteSet\n    wall > Immovable\n    goal > Door\n    pit > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    g > goal\n    p > pit\n  InteractionSet\n    avatar wall > stepBack\n    avatar pit > killSprite\n    goal avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=goal win=True\n    SpriteCounter stype=avatar win=False\n    Timeout limit=60 win=False\n";

    fn check(game: &str, level: &str, expect: &[(&str, &str)]) -> Report {
        let game = Game::from_source(game).unwrap();
        let level = game.level(level).unwrap();
        let criteria = Criteria { budget: 100_000, ..Criteria::default() };
        let panel = Panel::new(criteria.check().unwrap(), Effort::Full);
        let report = panel.judge(Judging::level(&game, &level, Seed::from_text("panel")));
        let word = |verdict: &Verdict| match verdict {
            Verdict::Pass { .. } => "pass",
            Verdict::Fail { .. } => "fail",
            Verdict::Unknown { .. } => "unknown",
        };
        let got = report.judgements.iter().map(|j| (j.criterion.name(), word(&j.finding.verdict)));
        assert_eq!(got.collect::<Vec<_>>(), expect);
        if let Some(witness) = &report.witness {
            assert_eq!(witness.replay(&game, &level).unwrap().outcome(), Outcome::Won);
        }
        // Any episode may become the witness, and the path of the witness's seed is published.
        for episode in report.episodes() {
            let path = SeedPath::new(Seed::from_text("panel"), episode.path);
            assert_eq!(path.seed(), episode.seed, "{path}");
        }
        report
    }

    #[test]
    fn an_observer_hears_every_judgement_and_can_end_the_judging() {
        use std::slice::from_ref;
        let game = Game::from_source(GAME).unwrap();
        let levels = [game.level(GOOD).unwrap()];
        let criteria = Criteria { budget: 20_000, ..Criteria::default() };
        let panel = Panel::new(criteria.check().unwrap(), Effort::Full);
        let seed = Seed::from_text("panel");
        let together = |reports: &[Report], stopped: Stopped<'_>| {
            let mut heard = Vec::new();
            let hear = &mut |judged: &Judgement| {
                heard.push(judged.clone());
                true
            };
            let together = Judging::together(&game, &levels, reports, seed);
            let judgements = panel.judge(together.watched_by(hear, stopped));
            (judgements, heard)
        };
        let mut heard = Vec::new();
        let hear = &mut |judged: &Judgement| {
            heard.push(judged.clone());
            true
        };
        let report = panel.judge(Judging::level(&game, &levels[0], seed).watched_by(hear, &|| false));
        let unwatched = panel.judge(Judging::level(&game, &levels[0], seed));
        assert_eq!((&report, &heard), (&unwatched, &report.judgements));
        let (judgements, heard) = together(from_ref(&report), &|| false);
        assert_eq!(
            (&judgements, &heard),
            (&panel.judge(Judging::together(&game, &levels, from_ref(&report), seed)), &judgements)
        );
        // An observer that has cancelled the judging receives no more judgements.
        let count = std::sync::atomic::AtomicUsize::new(0);
        let mut heard = 0;
        let hear = &mut |_: &Judgement| {
            heard += 1;
            count.store(heard, std::sync::atomic::Ordering::Relaxed);
            true
        };
        let left = || count.load(std::sync::atomic::Ordering::Relaxed) >= 2;
        let ended = panel.judge(Judging::level(&game, &levels[0], seed).watched_by(hear, &left));
        assert!(heard == 2 && ended.judgements.len() < report.judgements.len(), "{heard}");
        assert_eq!(together(&[report], &|| true), (Vec::new(), Vec::new()));
    }

    const GOOD: &str = "wwwwwwwww\nwA   w  w\nw wp wp w\nw  w   gw\nw pww   w\nwwwwwwwww\n";
    const WALLED: &str = "wwwwwwwww\nwA   w  w\nw wp wp w\nw  w  wgw\nw pww  ww\nwwwwwwwww\n";

    #[test]
    fn a_good_level_passes_with_a_witness() {
        let criteria =
            ["well-formed", "readable", "not-idle", "not-random", "early-death", "winnable", "length"];
        assert!(check(GAME, GOOD, &criteria.map(|criterion| (criterion, "pass"))).passes());
    }

    #[test]
    fn unreachable_goals_are_proved() {
        let report = check(
            GAME,
            &WALLED.replace("wp w\n", "wpww\n"),
            &[
                ("well-formed", "pass"),
                ("readable", "pass"),
                ("not-idle", "pass"),
                ("not-random", "pass"),
                ("early-death", "pass"),
                ("winnable", "fail"),
                ("length", "unknown"),
            ],
        );
        assert_eq!(report.first_obstacle().unwrap().criterion, Criterion::Winnable);
    }

    #[test]
    fn wins_by_doing_nothing_are_found() {
        let idle = GAME.replace("Timeout limit=60 win=False", "Timeout limit=60 win=True");
        let report = check(
            &idle,
            GOOD,
            &[
                ("well-formed", "pass"),
                ("readable", "pass"),
                ("not-idle", "fail"),
                ("not-random", "pass"),
                ("early-death", "pass"),
                ("winnable", "pass"),
                ("length", "pass"),
            ],
        );
        assert_eq!(report.first_obstacle().unwrap().criterion, Criterion::NotIdle);
    }

    #[test]
    fn games_decided_at_the_start_or_unwinnable_are_not_well_formed() {
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
            let panel = Panel::new(Criteria::default().check().unwrap(), Effort::Full);
            let report = panel.judge(Judging::level(&game, &level, Seed::from_text("over")).until_failure());
            assert_eq!(report.judgements.len(), 1);
            let obstacle = report.first_obstacle().unwrap();
            assert_eq!(obstacle.criterion, Criterion::WellFormed);
            let Verdict::Fail { reason: told, .. } = &obstacle.finding.verdict else {
                panic!("{obstacle:?}")
            };
            assert!(told.0.contains(reason), "{told:?}");
        }
    }
}
