//! The panel of all validators.

use crate::ablation::RulesMatter;
use crate::allowance::Allowance;
use crate::causes;
use crate::culprits;
use crate::evidence::Evidence;
use crate::game_report::{GameCase, GameReport, GameValidator};
use crate::gates::{self, CarelessPlays};
use crate::length;
use crate::level_report::{Judgement, OVER, Report};
use crate::recording::{Recorded, Usage, explore};
use crate::too_soon;
use crate::well_formed::is_over_at_once;
use crate::{
    Case, Criteria, CriteriaError, Finding, Ladder, LengthWithin, NoEarlyDeath, NotIdle, NotRandom,
    Reachable, Readable, RuleUse, SkillOverall, SkillPays, Validator, Verdict, WellFormed, Winnable,
};
use agents::{PortfolioConfig, Stopped};
use base::Seed;
use engine::{Analysis, Episode, Game, Level};
use rayon::prelude::*;

/// The validators of a set of criteria, cheapest first.
pub struct Panel {
    validators: Vec<(Stage, Box<dyn Validator + Send>)>,
    of_game: Vec<(Subject, Box<dyn GameValidator + Send>)>,
    /// The criteria, and the calls that they share, if those are bounded.
    bound: Option<(Criteria, u64)>,
    /// The search for a win.
    search: PortfolioConfig,
    /// Ticks of the random walks that look for rules which were never executed, for each level.
    exploration: u64,
}

/// The purpose of a panel.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Purpose {
    /// To tell all about a level.
    Reports,
    /// To tell candidates of use from others, with as little work as possible.
    Candidates,
}

/// The stage of a criterion of levels: what it takes for granted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// It asks nothing of play, or its answer is why the others are not asked.
    Start,
    /// It asks about plays that get beyond the first tick.
    Play,
    /// It searches for a win.
    Search,
    /// It asks about the win.
    Win,
    /// It lets a ladder of players play, who may win what no search did; skipped on a level that nobody can win.
    Ladder,
}

/// The subject of a criterion of games.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Subject {
    /// The players.
    Players,
    /// Winning play: levels without a known win are left out.
    Play,
    /// The rules: doubts about them may follow from a level that nobody can win.
    Rules,
}

/// The message for criteria that are skipped on an unwinnable level.
const UNWINNABLE: &str = "skipped: the level cannot be won";
/// The message for criteria that are skipped because the game stops in its first tick.
const STOPPED: &str = "skipped: the game stops in its first tick";
impl Panel {
    /// Returns the panel of these criteria.
    ///
    /// # Errors
    /// The first of their values that is out of its range; see [`Criteria::check`].
    pub fn new(criteria: &Criteria) -> Result<Panel, CriteriaError> {
        criteria.check()?;
        Ok(Panel::with_allowance(criteria, None, Purpose::Reports))
    }

    /// Like [`Panel::new`], but with little work, for minting, where candidates are many: random play stops once a level is refused for
    /// sure, and players stop as soon as the answer is as good as sure (see [`SkillPays::sequential`]).
    ///
    /// # Errors
    /// As [`Panel::new`].
    pub fn of_candidates(criteria: &Criteria) -> Result<Panel, CriteriaError> {
        criteria.check()?;
        Ok(Panel::with_allowance(criteria, None, Purpose::Candidates))
    }

    /// Like [`Panel::new`], with a number of forward-model calls for each level, and for the game over all its
    /// levels, divided among all criteria: together they take up to about eight times as many, and at least the
    /// minimum for an answer. Work that does not fit is broken off, and its answer is unknown. A tick with unusually
    /// much work counts as several calls.
    ///
    /// # Errors
    /// As [`Panel::new`].
    pub fn bounded(criteria: &Criteria, calls: u64) -> Result<Panel, CriteriaError> {
        Ok(Panel { bound: Some((criteria.clone(), calls)), ..Panel::new(criteria)? })
    }

    /// The panel of criteria that were checked.
    fn with_allowance(criteria: &Criteria, allowance: Option<Allowance>, purpose: Purpose) -> Panel {
        let bounded = allowance.map(|allowance| allowance.bounds(criteria));
        let c = bounded.as_ref().unwrap_or(criteria);
        let players = c.ladder_config().expect("the criteria were checked");
        let play_calls = allowance.map_or(u64::MAX, |allowance| allowance.ladder_play(players.round_plays()));
        let [idle, random] = match allowance {
            None => [usize::MAX; 2],
            Some(allowance) => [allowance.idle_play(), allowance.random_play()],
        };
        let is_hasty = purpose == Purpose::Candidates;
        let search = c.search();
        let level: [(Stage, Box<dyn Validator + Send>); 8] = [
            (Stage::Start, Box::new(WellFormed)),
            (Stage::Start, Box::new(Readable)),
            (Stage::Play, Box::new(NotIdle { plays: c.idle_plays, ticks: idle })),
            (Stage::Play, Box::new(NotRandom { plays: c.random_plays, most: c.random_wins, ticks: random })),
            (
                Stage::Play,
                Box::new(NoEarlyDeath {
                    ticks: c.early_ticks,
                    calls: c.early_calls,
                    seeds: c.early_seeds,
                    share: c.early_deaths,
                }),
            ),
            (Stage::Search, Box::new(Reachable(Winnable(search.clone())))),
            (Stage::Win, Box::new(LengthWithin { least: c.least_ticks, most: c.most_ticks })),
            (
                Stage::Ladder,
                Box::new(SkillPays {
                    players,
                    wins: c.skill_wins,
                    scores: c.skill_scores,
                    play_calls,
                    sequential: is_hasty,
                }),
            ),
        ];
        let rules: [(Subject, Box<dyn GameValidator + Send>); 3] = [
            (Subject::Players, Box::new(SkillOverall { wins: c.skill_overall })),
            (Subject::Rules, Box::new(RuleUse)),
            (
                Subject::Rules,
                Box::new(RulesMatter { calls: c.ablation_calls, total: allowance.map(Allowance::ablation) }),
            ),
        ];
        let gates = gates::all(&c.gates).map(|gate| (Subject::Play, gate));
        let game = rules.into_iter().chain(gates);
        Panel {
            validators: level.into_iter().filter(|(_, validator)| c.includes(validator.name())).collect(),
            of_game: game.filter(|(_, validator)| c.includes(validator.name())).collect(),
            bound: None,
            search,
            exploration: allowance.map_or(u64::MAX, Allowance::exploration),
        }
    }

    /// Runs every validator of levels.
    pub fn judge(&self, game: &Game, level: &Level, seed: Seed) -> Report {
        match &self.bound {
            None => self.run(game, level, None, seed, false),
            Some((criteria, calls)) => {
                let allowance = Allowance::of(*calls, game, [level]);
                Panel::with_allowance(criteria, Some(allowance), Purpose::Reports)
                    .run(game, level, None, seed, false)
            }
        }
    }

    /// Like [`Panel::judge`], for someone who watches: `heard` gets each judgement when it is made, once more if it changes later, and
    /// ends the judging by returning `false`. Once `stopped` returns `true`, the judging ends soon, and its last judgement means nothing
    /// and is not heard. A known win can be given; the criterion `winnable` looks for one regardless.
    pub fn judge_aloud(
        &self,
        game: &Game,
        level: &Level,
        witness: Option<Episode>,
        seed: Seed,
        heard: &mut dyn FnMut(&Judgement) -> bool,
        stopped: Stopped<'_>,
    ) -> Report {
        match &self.bound {
            None => self.run_aloud(game, level, witness, seed, false, (heard, stopped)),
            Some((criteria, calls)) => {
                let allowance = Allowance::of(*calls, game, [level]);
                let panel = Panel::with_allowance(criteria, Some(allowance), Purpose::Reports);
                panel.run_aloud(game, level, witness, seed, false, (heard, stopped))
            }
        }
    }

    /// Runs the validators until one does not pass: for minting, where candidates are many.
    pub fn screen(&self, game: &Game, level: &Level, seed: Seed) -> Report {
        self.run(game, level, None, seed, true)
    }

    /// Like [`Panel::screen`], for a level that `witness` is known to win.
    pub fn screen_won(&self, game: &Game, level: &Level, witness: Episode, seed: Seed) -> Report {
        self.run(game, level, Some(witness), seed, true)
    }

    /// Runs every validator, on the levels and on the game. Each level has a seed derived from its text, so that it gets
    /// the same answer alone and among others.
    pub fn judge_game(&self, game: &Game, levels: &[Level], seed: Seed) -> GameReport {
        let judge = |level: &Level| self.judge(game, level, seed.child(&level.digest().to_string(), 0));
        let reports: Vec<Report> = levels.par_iter().map(judge).collect();
        let judgements = self.judge_together(game, levels, &reports, seed);
        GameReport { levels: reports, judgements }
    }

    /// Runs the validators of a game over all its levels, with the reports of the levels in order.
    pub fn judge_together(
        &self,
        game: &Game,
        levels: &[Level],
        reports: &[Report],
        seed: Seed,
    ) -> Vec<Judgement> {
        self.together(game, levels, reports, seed, &mut |_| true, &|| false)
    }

    /// Like [`Panel::judge_together`], for someone who watches, as [`Panel::judge_aloud`] does it.
    pub fn judge_together_aloud(
        &self,
        game: &Game,
        levels: &[Level],
        reports: &[Report],
        seed: Seed,
        heard: &mut dyn FnMut(&Judgement) -> bool,
        stopped: Stopped<'_>,
    ) -> Vec<Judgement> {
        self.together(game, levels, reports, seed, heard, stopped)
    }

    /// Like [`Panel::judge_together`], until a validator does not pass.
    pub fn screen_together(
        &self,
        game: &Game,
        levels: &[Level],
        reports: &[Report],
        seed: Seed,
    ) -> Vec<Judgement> {
        self.together(
            game,
            levels,
            reports,
            seed,
            &mut |judgement| judgement.finding.verdict.is_pass(),
            &|| false,
        )
    }

    fn together(
        &self,
        game: &Game,
        levels: &[Level],
        reports: &[Report],
        seed: Seed,
        heard: &mut dyn FnMut(&Judgement) -> bool,
        stopped: Stopped<'_>,
    ) -> Vec<Judgement> {
        if self.of_game.is_empty() || levels.is_empty() {
            return Vec::new();
        }
        if let Some((criteria, calls)) = &self.bound {
            let allowance = Allowance::of(*calls, game, levels);
            let panel = Panel::with_allowance(criteria, Some(allowance), Purpose::Reports);
            return panel.together(game, levels, reports, seed, heard, stopped);
        }
        let analysis = Analysis::of(game);
        let explores = self.of_game.iter().any(|(_, validator)| validator.asks_for_usage());
        let ticks = if explores { self.exploration } else { 0 };
        let episodes = record(game, levels, reports, seed.child("explore", 0), ticks);
        let recording = recorded(levels, &episodes);
        let usage = Usage::within(game, &recording, ticks);
        let ladders: Vec<Option<&Ladder>> = reports.iter().map(Report::ladder).collect();
        let careless = CarelessPlays::new(levels.len(), seed.child("careless", 0));
        let mut judgements = Vec::new();
        for (subject, validator) in &self.of_game {
            if stopped() {
                break;
            }
            let criterion = validator.name();
            let seed = seed.child(criterion, 0);
            let case = GameCase {
                game,
                analysis: &analysis,
                recording: &recording,
                ladders: &ladders,
                usage: &usage,
                careless: &careless,
                seed,
            };
            let finding = validator.validate_until(case, stopped);
            let why = consequence(reports, &finding.verdict).filter(|_| *subject == Subject::Rules);
            let judgement = Judgement { criterion, finding: why.map_or(finding, |why| skipped(&why)) };
            let goes_on = !stopped() && heard(&judgement);
            judgements.push(judgement);
            if !goes_on {
                break;
            }
        }
        judgements
    }

    fn run(&self, game: &Game, level: &Level, witness: Option<Episode>, seed: Seed, screen: bool) -> Report {
        self.run_aloud(game, level, witness, seed, screen, (&mut |_| true, &|| false))
    }

    fn run_aloud(
        &self,
        game: &Game,
        level: &Level,
        witness: Option<Episode>,
        seed: Seed,
        screen: bool,
        (heard, stopped): (&mut dyn FnMut(&Judgement) -> bool, Stopped<'_>),
    ) -> Report {
        let analysis = Analysis::of(game);
        let mut report = Report { judgements: Vec::new(), witness };
        let run = |stage: Stage, validator: &(dyn Validator + Send), witness: Option<&Episode>| {
            let criterion = validator.name();
            let case = Case { game, level, seed: seed.child(criterion, 0), analysis: &analysis, witness };
            let mut finding = validator.validate_until(case, stopped);
            if stage == Stage::Search && !screen && !stopped() {
                causes::explain(case, &mut finding);
                if !too_soon::explain(case, &mut finding, &self.search) {
                    culprits::explain(case, &mut finding, &self.search);
                }
            }
            Judgement { criterion, finding }
        };
        let mut is_over = false;
        for (stage, validator) in &self.validators {
            let why = match stage {
                Stage::Start => None,
                _ if report.is_stopped() => Some(STOPPED),
                _ if is_over => Some(OVER),
                Stage::Win | Stage::Ladder if report.is_unwinnable() => Some(UNWINNABLE),
                _ => None,
            };
            if let Some(why) = why {
                let judgement = Judgement { criterion: validator.name(), finding: skipped(why) };
                let goes_on = heard(&judgement);
                report.judgements.push(judgement);
                if !goes_on {
                    return report;
                }
                continue;
            }
            let mut judgement = run(*stage, &**validator, report.witness.as_ref());
            match stage {
                Stage::Search => report.accept(&mut judgement),
                Stage::Win => length::without_proof(&mut judgement.finding, &report),
                _ => {}
            }
            let passed = judgement.finding.verdict.is_pass();
            let is_decided = matches!(judgement.finding.verdict, Verdict::Fail { witness: Some(_), .. });
            let is_start = judgement.criterion == "well-formed" && is_decided;
            let goes_on = !stopped() && heard(&judgement);
            report.judgements.push(judgement);
            if !goes_on || screen && !passed {
                return report;
            }
            is_over |= is_start && is_over_at_once(game, level, seed);
        }
        // A player of the ladder may win a level that the search did not.
        if let (None, Some(won)) = (&report.witness, report.shortest_win()) {
            report.witness = Some(won);
            let searched = report.clone();
            for ((stage, validator), judged) in self.validators.iter().zip(&mut report.judgements) {
                let Verdict::Unknown { .. } = judged.finding.verdict else { continue };
                match stage {
                    Stage::Search => {
                        judged.finding.verdict = Verdict::Pass { witness: report.witness.clone() }
                    }
                    Stage::Win => {
                        *judged = run(*stage, &**validator, report.witness.as_ref());
                        length::without_proof(&mut judged.finding, &searched);
                    }
                    _ => continue,
                }
                if !heard(judged) {
                    break;
                }
            }
        }
        report
    }
}

/// Returns the finding of a criterion that is skipped, with the reason.
fn skipped(why: &str) -> Finding {
    Finding::from(Verdict::Unknown { spent: 0 }).seen([Evidence::new(why)])
}

/// Returns the reason why a verdict on the rules is only a consequence of levels that cannot be won or are over in
/// their first tick, or says nothing since all are.
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
        // A proof over all levels holds even if some cannot be won.
        Verdict::Fail { .. } => None,
        Verdict::Unknown { .. } if over > 0 => {
            Some(format!("skipped: the game is over in its first tick on {over} of {all} levels"))
        }
        Verdict::Unknown { .. } => Some(format!("skipped: {lost} of {all} levels cannot be won")),
    }
}

/// Returns the episodes of each level, plus random walks of at most `most` ticks a level if some rule was never
/// executed.
pub(crate) fn record(
    game: &Game,
    levels: &[Level],
    reports: &[Report],
    seed: Seed,
    most: u64,
) -> Vec<Vec<Episode>> {
    let mut episodes: Vec<Vec<Episode>> = reports.iter().map(Report::episodes).collect();
    let new = {
        let recording = recorded(levels, &episodes);
        let usage = Usage::within(game, &recording, most);
        explore(game, &recording, &usage, seed, most)
    };
    for (episodes, new) in episodes.iter_mut().zip(new) {
        // After the witness, before episodes that may exceed the limit.
        let at = usize::from(!episodes.is_empty());
        episodes.splice(at..at, new);
    }
    episodes
}

pub(crate) fn recorded<'a>(levels: &'a [Level], episodes: &'a [Vec<Episode>]) -> Vec<Recorded<'a>> {
    levels.iter().zip(episodes).map(|(level, episodes)| Recorded { level, episodes }).collect()
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
        let report = Panel::new(&criteria).unwrap().judge(&game, &level, Seed::from_text("panel"));
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

    #[test]
    fn judging_aloud_is_judging_and_ends_when_nobody_listens() {
        use std::slice::from_ref;
        let game = Game::from_source(GAME).unwrap();
        let levels = [game.level(GOOD).unwrap()];
        let criteria = Criteria { budget: 20_000, ..Criteria::default() };
        let panel = Panel::new(&criteria).unwrap();
        let seed = Seed::from_text("panel");
        let together = |reports: &[Report], stopped: Stopped<'_>| {
            let mut heard = Vec::new();
            let tell = &mut |judged: &Judgement| {
                heard.push(judged.clone());
                true
            };
            let judgements = panel.judge_together_aloud(&game, &levels, reports, seed, tell, stopped);
            (judgements, heard)
        };
        let mut heard = Vec::new();
        let tell = &mut |judged: &Judgement| {
            heard.push(judged.clone());
            true
        };
        let report = panel.judge_aloud(&game, &levels[0], None, seed, tell, &|| false);
        assert_eq!((&report, &heard), (&panel.judge(&game, &levels[0], seed), &report.judgements));
        let (judgements, heard) = together(from_ref(&report), &|| false);
        assert_eq!(
            (&judgements, &heard),
            (&panel.judge_together(&game, &levels, from_ref(&report), seed), &judgements)
        );
        // Whoever left hears nothing more.
        let count = std::sync::atomic::AtomicUsize::new(0);
        let mut heard = 0;
        let tell = &mut |_: &Judgement| {
            heard += 1;
            count.store(heard, std::sync::atomic::Ordering::Relaxed);
            true
        };
        let left = || count.load(std::sync::atomic::Ordering::Relaxed) >= 2;
        let ended = panel.judge_aloud(&game, &levels[0], None, seed, tell, &left);
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
        assert_eq!(report.first_obstacle().unwrap().criterion, "winnable");
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
        assert_eq!(report.first_obstacle().unwrap().criterion, "not-idle");
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
            let report =
                Panel::new(&Criteria::default()).unwrap().screen(&game, &level, Seed::from_text("over"));
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
