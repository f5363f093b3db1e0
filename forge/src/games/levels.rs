//! Levels for one game: candidates of the level generator until enough pass.

use super::puzzles::{self, PuzzleGenerator, PuzzleLevels};
use crate::card::LevelCard;
use crate::tally::Tally;
use engine::{Action, Analysis, Digest, Episode, Game, Level, Outcome, Seed};
use generators::kernels::{Course, CourseLevel, Slot};
use generators::levels::{ConstructiveLevels, LevelConfig};
use generators::{GenerateError, Generator};
use std::slice;
use validators::{
    Criteria, Demand, Finding, GATES, Gates, Judgement, Panel, Rate, Report, SkillOverall, Verdict, mcts_rate,
};

/// A level that its judges let in.
#[derive(Clone, Debug)]
pub struct FoundLevel {
    /// The level.
    pub level: Level,
    /// The findings of its judges; its witness wins it.
    pub report: Report,
    /// The generator that made it.
    pub generator: &'static str,
    /// Its question to the player, if it is one of a course.
    pub asks: Option<String>,
    /// The difficulty that its generator was asked for, from 0 to 1.
    pub difficulty: f64,
    /// Its number among the candidates for its place, from 0.
    pub candidate: u32,
    /// The seed of its judges.
    pub seed: Seed,
    /// Its demands on a player, if it was made to a tier.
    pub demand: Option<Demand>,
}

/// The levels of a game, and what was found of all of them together.
#[derive(Clone, Debug)]
pub struct FoundLevels {
    /// In the order of the game: from the easiest to the hardest for the ladder, if it played, or else as was asked for.
    pub levels: Vec<FoundLevel>,
    /// The win rate of plain tree search on each.
    pub mcts: Vec<Rate>,
    /// The findings of the judges of the game.
    pub together: Vec<Judgement>,
}

/// The generator of the candidates for levels.
#[derive(Clone, Copy)]
pub enum LevelSource<'a> {
    /// Levels from the rules alone; each place has a difficulty of its own.
    Rules(&'a LevelConfig),
    /// The maps of a kernel; each place has a slot.
    Course(&'a Course),
    /// Puzzles of pushed things or of locks; each place has a tier.
    Puzzles(&'a PuzzleLevels),
}

impl LevelSource<'_> {
    /// The name in cards.
    fn name(self) -> &'static str {
        match self {
            LevelSource::Rules(_) => "constructive",
            LevelSource::Course(_) => "course",
            LevelSource::Puzzles(_) => "puzzle",
        }
    }
}

/// A generator of candidates for one place.
enum PlaceGenerator<'a> {
    Rules(Box<ConstructiveLevels<'a>>),
    Course(&'a Course, Slot),
    Puzzles(PuzzleGenerator<'a>),
}

/// A level, its question to the player if it is one of a course, and actions that win it if they are known.
type Generated = (Level, Option<String>, Option<Vec<Action>>);

impl PlaceGenerator<'_> {
    fn generate(&self, game: &Game, seed: Seed) -> Result<Generated, GenerateError> {
        match self {
            PlaceGenerator::Rules(levels) => Ok((levels.generate(seed)?, None, None)),
            PlaceGenerator::Puzzles(puzzles) => {
                let far = || GenerateError::Unlucky("no puzzle is far enough from its solution".to_owned());
                let (level, known) = puzzles.create_solved(game, seed).ok_or_else(far)?;
                Ok((level, None, Some(known)))
            }
            PlaceGenerator::Course(course, slot) => {
                let CourseLevel { text, asks, .. } = course.level(*slot, seed)?;
                let level =
                    game.level(&text).map_err(|problems| GenerateError::Unlucky(problems.to_string()))?;
                Ok((level, Some(asks), None))
            }
        }
    }
}

/// The levels of one candidate game.
pub struct Levels<'a> {
    /// The number of levels.
    pub count: u32,
    /// Candidates for each, at most.
    pub tries: u32,
    /// The generator of candidates.
    pub source: LevelSource<'a>,
    /// The criteria that each level and all levels together have to meet.
    pub criteria: &'a Criteria,
    /// The judges of these criteria.
    pub panel: &'a Panel,
    /// The seed of candidates and judges.
    pub seed: Seed,
}

impl Levels<'_> {
    /// All levels that meet the criteria, with what was found of them together; None as soon as one cannot be had, or if the
    /// game does not meet a criterion on all of them together.
    pub fn find(&self, game: &Game, tally: &mut Tally) -> Option<FoundLevels> {
        let mut spent = Tally::default();
        let found = self.found(game, &mut spent);
        tally.add(&if found.is_some() { spent } else { spent.of_lost() });
        found
    }

    fn found(&self, game: &Game, tally: &mut Tally) -> Option<FoundLevels> {
        let levels = self.each(game, tally)?;
        let together = self.together(game, &levels, self.seed.child("judges of the game", 0), tally)?;
        Some(self.told(game, levels, together, tally))
    }

    /// Accepted levels with their further data.
    pub(crate) fn told(
        &self,
        game: &Game,
        levels: Vec<FoundLevel>,
        together: Vec<Judgement>,
        tally: &mut Tally,
    ) -> FoundLevels {
        let rate = |found: &FoundLevel| {
            let seed = found.seed.child("mcts verdict", 0);
            let witness = found.report.witness.as_ref()?;
            Some(mcts_rate(game, &found.level, witness, self.criteria, seed))
        };
        let mcts: Vec<Rate> = levels.iter().filter_map(rate).collect();
        for rate in &mcts {
            tally.judge("rate of mcts", true, rate.calls);
        }
        FoundLevels { levels, mcts, together }
    }

    /// All levels, from the easiest to the hardest; None as soon as one cannot be had, or skill cannot be hoped to pay over
    /// all of them.
    pub(crate) fn each(&self, game: &Game, tally: &mut Tally) -> Option<Vec<FoundLevel>> {
        let mut levels: Vec<(u32, FoundLevel)> = Vec::new();
        // The easiest may be too easy, and the hardest too hard: what is to fail should fail soon.
        let ends = [0, self.count - 1].into_iter().take(self.count as usize);
        for number in ends.chain(1..self.count.max(1) - 1) {
            match self.level(game, number, &levels, tally) {
                Some(level) => {
                    levels.push((number, level));
                    if levels.len() == OUTLINE
                        && let Some(obstacle) = self.objection_to_outline(game, &levels, tally)
                    {
                        tally.game_rejected(obstacle);
                        return None;
                    }
                    if self.is_hopeless(game, &levels) {
                        tally.game_rejected("skill-overall");
                        return None;
                    }
                }
                None => {
                    tally.game_rejected(&format!("no level {number}"));
                    return None;
                }
            }
        }
        levels.sort_by_key(|(number, _)| *number);
        let mut levels: Vec<FoundLevel> = levels.into_iter().map(|(_, level)| level).collect();
        // What was asked for is a guess: how the ladder fared is known. Of equals, what was asked for. A course has an order.
        if matches!(self.source, LevelSource::Rules(_)) {
            levels.sort_by(|a, b| b.ease().total_cmp(&a.ease()));
        }
        Some(levels)
    }

    /// Returns the gate that the first two levels and the last of a course cannot be hoped to pass together with the others:
    /// the last is easier or does without what the first need, or there is not half the drama.
    fn objection_to_outline(
        &self,
        game: &Game,
        levels: &[(u32, FoundLevel)],
        tally: &mut Tally,
    ) -> Option<&'static str> {
        if !matches!(self.source, LevelSource::Course(_)) || self.count as usize == OUTLINE {
            return None;
        }
        let gates = &self.criteria.gates;
        let lax = Gates { growth: 0, drama: gates.drama / 2.0, ..gates.clone() };
        let panel = self.panel_of(&["progression", "drama"], lax);
        let mut levels: Vec<&(u32, FoundLevel)> = levels.iter().collect();
        levels.sort_by_key(|(number, _)| *number);
        let (boards, reports): (Vec<Level>, Vec<Report>) =
            levels.iter().map(|(_, found)| (found.level.clone(), found.report.clone())).unzip();
        let seed = self.seed.child("outline", 0);
        let together = panel.screen_together(game, &boards, &reports, seed);
        tally.judgements(&together);
        let obstacle = together.iter().find(|judgement| !judgement.finding.verdict.is_pass());
        obstacle.map(|judgement| judgement.criterion)
    }

    /// The judges of those criteria that are asked of all and named here.
    fn panel_of(&self, names: &[&str], gates: Gates) -> Panel {
        let ask = self.criteria.ask.iter().filter(|name| names.contains(&name.as_str())).cloned().collect();
        Panel::new(&Criteria { ask, gates, ..self.criteria.clone() }).expect("the criteria were checked")
    }

    /// Tests whether skill cannot be hoped to pay over all levels, after some of them: before the others cost as much again. After
    /// all of them, whether it does not pay.
    fn is_hopeless(&self, game: &Game, levels: &[(u32, FoundLevel)]) -> bool {
        let ladders: Vec<_> = levels.iter().filter_map(|(_, found)| found.report.ladder()).collect();
        let skill = SkillOverall { wins: self.criteria.skill_overall };
        self.criteria.includes("skill-overall")
            && skill.is_hopeless(&ladders, game.is_deterministic(), self.count as usize)
    }

    /// Returns the findings of the judges of the game; `None`, with the reason in the tally, if one of them says no.
    pub(crate) fn together(
        &self,
        game: &Game,
        levels: &[FoundLevel],
        seed: Seed,
        tally: &mut Tally,
    ) -> Option<Vec<Judgement>> {
        let (boards, reports): (Vec<Level>, Vec<Report>) =
            levels.iter().map(|found| (found.level.clone(), found.report.clone())).unzip();
        let together = self.panel.screen_together(game, &boards, &reports, seed);
        tally.judgements(&together);
        match together.iter().find(|judgement| !judgement.finding.verdict.is_pass()) {
            Some(obstacle) => {
                tally.game_rejected(obstacle.criterion);
                None
            }
            None => Some(together),
        }
    }

    /// Tests whether judges with other dice let the same levels in, as far as chance has a say. The first judges choose among
    /// candidates, so that their findings about the chosen ones are too good; here nothing is chosen. Cost: as of
    /// judging the levels that were let in, without the search for a win.
    pub(crate) fn hold(&self, game: &Game, levels: &[FoundLevel], seed: Seed, tally: &mut Tally) -> bool {
        let ask =
            self.criteria.ask.iter().filter(|name| !CERTAIN.contains(&name.as_str())).cloned().collect();
        let panel =
            Panel::new(&Criteria { ask, ..self.criteria.clone() }).expect("the criteria were checked");
        let (mut boards, mut reports) = (Vec::new(), Vec::new());
        for (number, found) in (0..).zip(levels) {
            let Some(witness) = found.report.witness.clone() else { return false };
            let report = panel.screen_won(game, &found.level, witness, seed.child("level", number));
            tally.judgements(&report.judgements);
            if !report.passes() {
                return false;
            }
            boards.push(found.level.clone());
            reports.push(report);
        }
        let together = panel.screen_together(game, &boards, &reports, seed.child("game", 0));
        tally.judgements(&together);
        together.iter().all(|judgement| judgement.finding.verdict.is_pass())
    }

    /// Tests whether the gates let the game in, whatever the dice: `times` judges in turn, each of whom knows one win of a
    /// level, the witness. Cost: some seconds for each.
    pub(crate) fn hold_again(
        &self,
        game: &Game,
        levels: &[FoundLevel],
        (seed, times): (Seed, u64),
        tally: &mut Tally,
    ) -> bool {
        let panel = self.panel_of(GATES, self.criteria.gates.clone());
        let boards: Vec<Level> = levels.iter().map(|found| found.level.clone()).collect();
        let report =
            |found: &FoundLevel| Report { judgements: Vec::new(), witness: found.report.witness.clone() };
        let reports: Vec<Report> = levels.iter().map(report).collect();
        (0..times).all(|number| {
            let together = panel.screen_together(game, &boards, &reports, seed.child("judges", number));
            tally.judgements(&together);
            together.iter().all(|judgement| judgement.finding.verdict.is_pass())
        })
    }

    /// A level that was found for a game that had another time limit: judged again, but for the criteria whose plays are
    /// dear, which are carried over if the win still wins. The dice are the same, so that a replay ends as before.
    pub(crate) fn again(&self, game: &Game, found: &FoundLevel, tally: &mut Tally) -> Option<FoundLevel> {
        let level = game.level(&found.level.to_string()).ok()?;
        let witness = recorded(game, &level, found.report.witness.as_ref()?);
        let is_won = witness.outcome == Outcome::Won;
        let is_carried = |criterion: &str| PLAYED.contains(&criterion) || is_won && criterion == "winnable";
        let ask = self.criteria.ask.iter().filter(|name| !is_carried(name)).cloned().collect();
        let panel =
            Panel::new(&Criteria { ask, ..self.criteria.clone() }).expect("the criteria were checked");
        let win = is_won.then_some(witness);
        let (place, seed) = ((found.difficulty, found.candidate), found.seed);
        let judged = self.judged(&panel, game, level, (place, win), seed, tally);
        let Judged::Passed(mut again) = judged else { return None };
        let carried = found.report.judgements.iter().filter(|judgement| is_carried(judgement.criterion));
        for mut judgement in carried.cloned() {
            for episode in &mut judgement.finding.episodes {
                *episode = recorded(game, &again.level, episode);
            }
            if let Verdict::Pass { witness: Some(won) } = &mut judgement.finding.verdict {
                *won = recorded(game, &again.level, won);
            }
            again.report.judgements.push(judgement);
        }
        let place_of = |judgement: &Judgement| {
            found.report.judgements.iter().position(|before| before.criterion == judgement.criterion)
        };
        again.report.judgements.sort_by_key(place_of);
        again.asks.clone_from(&found.asks);
        Some(*again)
    }

    /// A level for a place, beside those of other places.
    fn level(
        &self,
        game: &Game,
        number: u32,
        others: &[(u32, FoundLevel)],
        tally: &mut Tally,
    ) -> Option<FoundLevel> {
        let taken: Vec<Digest> = others.iter().map(|(_, found)| found.level.digest()).collect();
        let difficulty = f64::from(number) / f64::from((self.count - 1).max(1));
        let generator = match self.source {
            LevelSource::Rules(config) => {
                let config = LevelConfig { difficulty, ..config.clone() };
                ConstructiveLevels::new(game, config).map(|levels| PlaceGenerator::Rules(Box::new(levels)))
            }
            LevelSource::Course(course) => {
                let last = Slot::ALL.len() - 1;
                let slot = Slot::ALL[(difficulty * last as f64).round() as usize];
                Ok(PlaceGenerator::Course(course, slot))
            }
            LevelSource::Puzzles(puzzles) => puzzles.generator(game, number).map(PlaceGenerator::Puzzles),
        };
        let generator = match generator {
            Ok(generator) => generator,
            Err(error) => {
                tally.game_rejected(&error.to_string());
                return None;
            }
        };
        // Most candidates that can be won are won soon, and a vain search costs many times as much: all get a short one first.
        let ask: Vec<String> =
            self.criteria.ask.iter().filter(|name| !PLAYED.contains(&name.as_str())).cloned().collect();
        let alone = Criteria { ask, ..self.criteria.clone() };
        let brief = Panel::brief(&alone, FIRST_SEARCH).expect("the criteria were checked");
        let mut unsolved = Vec::new();
        let mut misfits = 0;
        for candidate in 0..self.tries {
            let seed = self.seed.child("level", u64::from(number)).child("candidate", u64::from(candidate));
            let (level, asks, known) = match generator.generate(game, seed.child("layout", 0)) {
                Ok((level, ..)) if taken.contains(&level.digest()) => {
                    tally.no_level("the same level twice");
                    continue;
                }
                Ok(generated) => generated,
                Err(_) => {
                    tally.no_level("level generator");
                    continue;
                }
            };
            let place = ((difficulty, candidate), seed);
            if let (LevelSource::Puzzles(puzzles), Some(known)) = (self.source, known) {
                let mut spent = Tally::default();
                let found = self.puzzle(puzzles, game, level, known, (number, place), &mut spent);
                tally.add(&if found.is_some() { spent } else { spent.of_refused() });
                match found {
                    Some(found) => return Some(found),
                    None => continue,
                }
            }
            match self.in_company(&brief, game, level, place, (number, others), tally) {
                Judged::Passed(found) => return Some(FoundLevel { asks, ..*found }),
                Judged::Unsolved(level) => unsolved.push((level, asks, place)),
                Judged::Misfit => misfits += 1,
                Judged::Failed => {}
            }
            if misfits == MISFITS {
                return None;
            }
        }
        if self.criteria.budget <= FIRST_SEARCH {
            return None;
        }
        // The more levels a game has, the more would be lost with it.
        let patience = SECOND_SEARCHES * (others.len() + 1);
        let thorough = Panel::new(&alone).expect("the criteria were checked");
        unsolved.into_iter().take(patience).find_map(|(level, asks, place)| {
            match self.in_company(&thorough, game, level, place, (number, others), tally) {
                Judged::Passed(found) => Some(FoundLevel { asks, ..*found }),
                Judged::Unsolved(_) | Judged::Misfit | Judged::Failed => None,
            }
        })
    }

    /// Judges a level alone, then beside the others of its course, then the skill that pays on it: the cheapest question first.
    fn in_company(
        &self,
        panel: &Panel,
        game: &Game,
        level: Level,
        (place, seed): ((f64, u32), Seed),
        (number, others): (u32, &[(u32, FoundLevel)]),
        tally: &mut Tally,
    ) -> Judged {
        let spent = &mut Tally::default();
        let mut judged = self.judged(panel, game, level, (place, None), seed, spent);
        if let Judged::Passed(found) = &mut judged {
            let others = (number, others);
            let objection = self
                .objection_to_place(game, found, others, spent)
                .or_else(|| self.objection_to_skill(game, found, spent));
            if let Some(objection) = objection {
                spent.level_taken_back(objection);
                judged = Judged::Failed;
            } else if let Some(objection) = self.objection_to_course(game, found, others, spent) {
                spent.level_taken_back(objection);
                judged = Judged::Misfit;
            }
        }
        let spent = std::mem::take(spent);
        tally.add(&if matches!(judged, Judged::Passed(_)) { spent } else { spent.of_refused() });
        judged
    }

    /// Lets the ladder play, as far as skill is asked for, and adds what is found to the report.
    fn objection_to_skill(
        &self,
        game: &Game,
        found: &mut FoundLevel,
        tally: &mut Tally,
    ) -> Option<&'static str> {
        if !self.criteria.includes("skill") {
            return None;
        }
        let criteria = Criteria { ask: vec!["skill".to_owned()], ..self.criteria.clone() };
        // What follows from the plays of all levels together needs all plays.
        let panel = match self.criteria.includes("skill-overall") {
            true => Panel::new(&criteria),
            false => Panel::sequential(&criteria),
        };
        let panel = panel.expect("the criteria were checked");
        let (witness, seed) = (found.report.witness.clone()?, found.seed.child("judges", 0));
        let report = panel.screen_won(game, &found.level, witness, seed);
        tally.judgements(&report.judgements);
        let is_met = report.passes();
        found.report.judgements.extend(report.judgements);
        (!is_met).then_some("skill")
    }

    /// Asks the cheap gates about all levels of a course when the last one is found: another candidate may mend what a game would be
    /// refused for.
    fn objection_to_course(
        &self,
        game: &Game,
        found: &FoundLevel,
        (number, others): (u32, &[(u32, FoundLevel)]),
        tally: &mut Tally,
    ) -> Option<&'static str> {
        let is_last = others.len() + 1 == self.count as usize;
        if !is_last || !matches!(self.source, LevelSource::Course(_)) {
            return None;
        }
        let panel = self.panel_of(CHEAP_GATES, self.criteria.gates.clone());
        let mut levels: Vec<(u32, &FoundLevel)> =
            others.iter().map(|(place, found)| (*place, found)).chain([(number, found)]).collect();
        levels.sort_by_key(|(place, _)| *place);
        let (boards, reports): (Vec<Level>, Vec<Report>) =
            levels.iter().map(|(_, found)| (found.level.clone(), found.report.clone())).unzip();
        let together = panel.screen_together(game, &boards, &reports, found.seed.child("course", 0));
        tally.judgements(&together);
        let obstacle = together.iter().find(|judgement| !judgement.finding.verdict.is_pass());
        obstacle.map(|judgement| judgement.criterion)
    }

    /// Returns the reason why a level does not fit its place in a course: its win is much shorter than that of an earlier level, or
    /// has dead time.
    fn objection_to_place(
        &self,
        game: &Game,
        found: &FoundLevel,
        (number, others): (u32, &[(u32, FoundLevel)]),
        tally: &mut Tally,
    ) -> Option<&'static str> {
        if !matches!(self.source, LevelSource::Course(_)) {
            return None;
        }
        let in_order = |(place, other): &(u32, FoundLevel)| match *place < number {
            true => found.asks_as_much_as(other),
            false => other.asks_as_much_as(found),
        };
        if !others.iter().all(in_order) {
            return Some("less than an earlier level");
        }
        self.is_tedious(game, found, tally).then_some("no-dead-time")
    }

    /// A puzzle of the tier of its place: won, judged, and measured; the search for its shortest win is that of `winnable`. Cost: a proof of the shortest win within the share of the
    /// budget for it, the judges, and [`Demand::of`].
    fn puzzle(
        &self,
        puzzles: &PuzzleLevels,
        game: &Game,
        level: Level,
        known: Vec<Action>,
        (number, (place, seed)): (u32, ((f64, u32), Seed)),
        tally: &mut Tally,
    ) -> Option<FoundLevel> {
        let analysis = Analysis::of(game);
        let of_win = seed.child("judges", 0).child("winnable", 0).child("systematic", 0);
        let calls = (self.criteria.budget as f64 * self.criteria.shortest) as u64;
        let (win, shortest, calls) = puzzles::win(&analysis, &level, known, calls, of_win)?;
        tally.judge("winnable", true, calls);
        let ask = self.criteria.ask.iter().filter(|name| *name != "winnable").cloned().collect();
        let panel =
            Panel::new(&Criteria { ask, ..self.criteria.clone() }).expect("the criteria were checked");
        let judged = self.judged(&panel, game, level, (place, Some(win.clone())), seed, tally);
        let Judged::Passed(mut found) = judged else { return None };
        let demand = Demand::of(&analysis, &found.level, &win, shortest, seed.child("demand", 0))?;
        let optimal = shortest.then_some(win.actions.len());
        let verdict = Verdict::Pass { witness: Some(win) };
        let finding = Finding { searched: Some(calls), optimal, ..Finding::from(verdict) };
        found.report.judgements.insert(0, Judgement { criterion: "winnable", finding });
        if demand.tier() != puzzles.tier(number) {
            tally.level_taken_back("tier");
            return None;
        }
        Some(FoundLevel { demand: Some(demand), ..*found })
    }

    /// Tests whether the win of a level has dead time: the gate looks at each level alone.
    fn is_tedious(&self, game: &Game, found: &FoundLevel, tally: &mut Tally) -> bool {
        let panel = self.panel_of(&["no-dead-time"], self.criteria.gates.clone());
        let (board, report) = (&found.level, &found.report);
        let seed = found.seed.child("dead time", 0);
        let judged = panel.screen_together(game, slice::from_ref(board), slice::from_ref(report), seed);
        tally.judgements(&judged);
        judged.iter().any(|judgement| !judgement.finding.verdict.is_pass())
    }

    /// A level that meets all criteria; `win` is one that is known.
    fn judged(
        &self,
        panel: &Panel,
        game: &Game,
        level: Level,
        ((difficulty, candidate), win): ((f64, u32), Option<Episode>),
        seed: Seed,
        tally: &mut Tally,
    ) -> Judged {
        let seed_of_judges = seed.child("judges", 0);
        let report = match win {
            Some(win) => panel.screen_won(game, &level, win, seed_of_judges),
            None => panel.screen(game, &level, seed_of_judges),
        };
        let obstacle = report.first_obstacle().map(|judgement| judgement.criterion);
        tally.level(&report.judgements, obstacle);
        let is_unsolved = report.first_obstacle().is_some_and(|judgement| {
            judgement.criterion == "winnable" && matches!(judgement.finding.verdict, Verdict::Unknown { .. })
        });
        if is_unsolved {
            return Judged::Unsolved(level);
        }
        if obstacle.is_some() || report.witness.is_none() {
            return Judged::Failed;
        }
        Judged::Passed(Box::new(FoundLevel {
            level,
            report,
            generator: self.source.name(),
            asks: None,
            difficulty,
            candidate,
            seed,
            demand: None,
        }))
    }
}

/// The judges' answer on a level.
enum Judged {
    /// It meets all criteria.
    Passed(Box<FoundLevel>),
    /// It misses one.
    Failed,
    /// It meets all, and all levels together do not.
    Misfit,
    /// No win was found within the budget: with a larger one it may pass.
    Unsolved(Level),
}

/// The calls of the first search for a win of a candidate.
pub const FIRST_SEARCH: u64 = 150_000;

/// The number of candidates of the first place whose win is searched for with the whole budget, if none is accepted before; each
/// later place has as many more.
const SECOND_SEARCHES: usize = 2;

/// Candidates of the last place beside which the others fail a gate, after which the game is given up.
const MISFITS: usize = 3;

/// The share of the ticks of an earlier level's win that a later one takes at least: a course never asks for much less.
const LATER_SHARE: f64 = 0.6;

/// The levels of a course that are found first: two to begin with and the exam.
const OUTLINE: usize = 3;

/// The gates that cost little.
const CHEAP_GATES: &[&str] = &["progression", "drama", "no-dead-time", "not-instant"];

/// The criteria whose answer does not depend on dice once there is a witness.
const CERTAIN: [&str; 4] = ["well-formed", "readable", "winnable", "length"];

/// The criteria whose plays are dear, and the one that counts them.
const PLAYED: [&str; 2] = ["skill", "skill-overall"];

/// An episode replayed as one of another game.
fn recorded(game: &Game, level: &Level, played: &Episode) -> Episode {
    let (mut episode, mut state) = Episode::begin(game, level, played.seed);
    for &action in &played.actions {
        episode.play(game, &mut state, action);
    }
    episode
}

impl FoundLevel {
    /// Tests whether winning takes about as long as winning an earlier level of a course, or longer.
    fn asks_as_much_as(&self, earlier: &FoundLevel) -> bool {
        let ticks = |found: &FoundLevel| found.report.witness.as_ref().map_or(0, |win| win.actions.len());
        ticks(self) as f64 >= LATER_SHARE * ticks(earlier) as f64
    }

    /// Its ease for the ladder, from 0 to 1; the same for all levels if none played.
    fn ease(&self) -> f64 {
        self.report.ladder().and_then(|ladder| ladder.ease).unwrap_or_default()
    }

    /// Returns the card of the level and the episode that wins it; `None` unless its judges were asked about idle and random
    /// play and for a win.
    pub(crate) fn card(&self, number: usize, mcts: &Rate) -> Option<(LevelCard, Episode)> {
        let report = &self.report;
        let rate = |criterion: &str| -> Option<Rate> { report.finding(criterion)?.measured.clone() };
        let witness = report.witness.clone()?;
        let card = LevelCard {
            file: format!("lvl{number}.txt"),
            digest: self.level.digest(),
            columns: self.level.columns(),
            rows: self.level.rows(),
            generator: self.generator.to_owned(),
            asks: self.asks.clone(),
            difficulty: self.difficulty,
            candidate: self.candidate,
            witness_ticks: witness.actions.len(),
            witness_score: witness.score,
            optimal_ticks: report.finding("winnable").and_then(|finding| finding.optimal),
            search_calls: report.finding("winnable").map_or(0, Finding::calls),
            mcts: mcts.clone(),
            random: rate("not-random")?,
            idle: rate("not-idle")?,
            ladder: report.ladder().cloned(),
            tier: self.demand.as_ref().map(Demand::tier),
            demand: self.demand.clone(),
        };
        Some((card, witness))
    }
}
