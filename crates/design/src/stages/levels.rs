//! Checks levels: they must load and be winnable, and the game must pass the gates.

use super::rules::{GAME_FILE, Rules, shown, warnings};
use super::{Problem, attempt};
use crate::brief::Brief;
use base::Seed;
use engine::{Analysis, Diagnostics, Level};
use forge::review::{Review, ReviewedLevel, locate};
use std::collections::BTreeMap;
use validators::{CheckedCriteria, Criterion, Demand, Effort, GameReport, Judging, Panel, Report, Tier};

/// The seed of the judges, which is the default seed of `arcade validate`, so that both give the same verdicts.
const SEED: &str = "validate";

/// Levels that load.
#[derive(Clone, Debug)]
pub(crate) struct Loaded {
    pub(crate) texts: Vec<String>,
    pub(crate) levels: Vec<Level>,
}

/// The verdicts on a game.
#[derive(Clone, Debug)]
pub(crate) struct Verdicts {
    /// The number of levels with a known win.
    pub(crate) won: usize,
    /// For each criterion, `true` if the game or all of its levels meet it.
    pub(crate) criteria: BTreeMap<Criterion, bool>,
    /// The tier (difficulty class from 1 to 4) of the last level, if a tier is required and the level has a known win.
    pub(crate) tier: Option<Tier>,
    /// The problem, if the game is not accepted.
    pub(crate) problem: Option<Problem>,
}

fn file(number: usize) -> String {
    format!("lvl{number}.txt")
}

/// Parses levels.
pub(crate) fn load(texts: Vec<String>, rules: &Rules, brief: &Brief) -> Result<Loaded, Problem> {
    let parsed = texts.iter().map(|text| rules.game.level(text));
    let (mut levels, mut problems) = (Vec::new(), Vec::new());
    for (number, level) in parsed.enumerate() {
        match level {
            Ok(level) => levels.push(level),
            Err(found) => problems.push((number, found)),
        }
    }
    if !problems.is_empty() {
        let word = |(number, found): &(usize, Diagnostics)| {
            editor::in_words(shown(&file(*number), &texts[*number]), &found.0)
        };
        let report: Vec<String> = problems.iter().map(word).collect();
        let summary = format!("{} cannot be loaded", base::count(problems.len(), "level"));
        let introduction = "Some levels cannot be loaded. Correct all of these problems.";
        return Err(Problem::reported(summary, introduction, &report.join("\n\n")));
    }
    if levels.len() != brief.levels {
        return Err(Problem::plain(format!(
            "The answer contains {}, but the game needs {}. Each level has its own block, ```` ```level ````.",
            base::count(levels.len(), "level"),
            brief.levels
        )));
    }
    Ok(Loaded { texts, levels })
}

/// Judges a game. Cost: the criteria's budgets for each level, and the gates' budgets.
pub(crate) fn judge(rules: &Rules, loaded: &Loaded, brief: &Brief, criteria: &CheckedCriteria) -> Verdicts {
    let seed = Seed::from_text(SEED);
    let panel = Panel::new(criteria.clone(), Effort::Calls(criteria.budget));
    let mut report = panel.judge(Judging::game(&rules.game, &loaded.levels, seed));
    let findings = report.levels.iter_mut().flat_map(|level| &mut level.judgements);
    for judgement in findings.chain(&mut report.judgements) {
        locate(&mut judgement.finding, &rules.source);
    }
    let tier = brief.tier.and_then(|_| last_tier(rules, loaded, &report, seed));
    let is_low = brief.tier.is_some_and(|wanted| tier.is_none_or(|tier| tier < wanted));
    let problem = (!report.passes() || is_low).then(|| problem(rules, loaded, &report, brief.tier.zip(tier)));
    Verdicts {
        won: report.levels.iter().filter(|level| level.witness.is_some()).count(),
        criteria: met(&report),
        tier,
        problem,
    }
}

/// Returns the criteria, each with `true` if the game or all of its levels meet it.
fn met(report: &GameReport) -> BTreeMap<Criterion, bool> {
    let mut met = BTreeMap::new();
    for judgement in report.levels.iter().flat_map(|level| &level.judgements).chain(&report.judgements) {
        *met.entry(judgement.criterion).or_insert(true) &= judgement.finding.verdict.is_pass();
    }
    met
}

fn last_tier(rules: &Rules, loaded: &Loaded, report: &GameReport, seed: Seed) -> Option<Tier> {
    let (level, judged) = (loaded.levels.last()?, report.levels.last()?);
    let win = judged.witness.as_ref()?;
    let shortest = judged.finding(Criterion::Winnable).is_some_and(|finding| finding.optimal.is_some());
    let demand = Demand::of(&Analysis::of(&rules.game), level, win, shortest, seed.child("tier", 0))?;
    Some(demand.tier())
}

/// Describes why a game is not accepted, with the same review that users get, and with the best attempts at the levels
/// that fail.
fn problem(rules: &Rules, loaded: &Loaded, report: &GameReport, tiers: Option<(Tier, Tier)>) -> Problem {
    let names: Vec<String> = (0..loaded.levels.len()).map(file).collect();
    let boards: Vec<Vec<String>> =
        loaded.levels.iter().map(|level| level.to_string().lines().map(str::to_owned).collect()).collect();
    let level = |((name, board), judged)| ReviewedLevel {
        name: String::as_str(name),
        passes: Report::passes(judged),
        board: Vec::as_slice(board),
        report: Some(judged),
    };
    let warnings = warnings(rules);
    let review = Review {
        source: GAME_FILE,
        passes: report.passes(),
        levels: names.iter().zip(&boards).zip(&report.levels).map(level).collect(),
        judgements: &report.judgements,
        warnings: &warnings,
    };
    let mut text = review.text(true);
    // If only the game as a whole fails, the wins on all levels are shown as evidence.
    let all_pass = report.levels.iter().all(Report::passes);
    let failing = report.levels.iter().enumerate().filter(|(_, level)| all_pass || !level.passes());
    for (at, judged) in failing {
        let level = &loaded.levels[at];
        let seed = Seed::from_text(SEED).child("attempt", at as u64);
        let best = attempt::best(&rules.game, level, judged, seed);
        text += "\n";
        text += &attempt::in_words(&rules.game, level, &names[at], &best);
    }
    if let Some((wanted, found)) = tiers.filter(|(wanted, found)| found < wanted) {
        text += &format!("\nThe last level belongs to tier {found}, but tier {wanted} is required.\n");
    }
    let mut judgements = report.levels.iter().flat_map(|level| &level.judgements).chain(&report.judgements);
    let obstacle = judgements.find(|judgement| !judgement.finding.verdict.is_pass());
    let summary = obstacle.map_or("the tier is too low".to_owned(), |judgement| {
        format!("{}: {}", judgement.criterion, judgement.answer())
    });
    let introduction = "The game is not accepted yet. This is the review of the game. Lines that begin with FAIL or ? \
                        state what must change, and lines that begin with `try:` give advice.";
    Problem::reported(summary, introduction, &text)
}
