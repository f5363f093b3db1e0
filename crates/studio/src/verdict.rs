//! The verdict on a level while it is being edited. The cheapest results come first, and each result is sent
//! as soon as it is known.

use crate::compiled::Compiled;
use crate::lines::{Ended, Lines};
use crate::positions;
use crate::refusal::Refusal;
use agents::{PortfolioConfig, Solution, Solved, solve_until};
use base::Seed;
use engine::analysis::{Reach, Role};
use engine::{Analysis, Level, describe, line_and_column};
use serde_json::{Value, json};
use validators::{
    Criteria, Criterion, CriterionSet, Effort, Evidence, Judgement, Judging, Ladder, Line, Panel,
    PlayerResult, Verdict,
};

/// The numbers of forward-model calls in the successive searches for a win. The first search is enough for most
/// levels.
const SEARCHES: [u64; 4] = [20_000, 100_000, 400_000, 2_000_000];
/// The maximum number of calls that a request can specify.
const MOST_CALLS: u64 = 50_000_000;
/// The memory limit for a search, in bytes.
pub(crate) const BYTES: usize = 256 << 20;
/// The fraction of a search's calls that is spent on foreseeing the randomness of one episode. Without
/// foresight, some games would never be won.
pub(crate) const FORESIGHT: f64 = 0.4;
/// The number of forward-model calls that the criteria share.
const CRITERIA: u64 = 300_000;

/// A level to judge.
pub(crate) struct Subject<'a> {
    pub(crate) compiled: &'a Compiled,
    pub(crate) level: &'a Level,
    pub(crate) seed: Seed,
    /// The maximum number of calls to spend on finding a win.
    pub(crate) budget: Option<u64>,
}

impl Subject<'_> {
    /// Sends all facts about the level, until the client leaves.
    pub(crate) fn judge(&self, lines: &Lines) -> Result<(), Ended> {
        let Subject { compiled: Compiled { source, game, analysis, .. }, level, seed, .. } = *self;
        let reach = analysis.reach(level);
        let told = describe::hindered_wins(analysis, level, &reach);
        let impossible = (!reach.can_win()).then(|| self.why_not(CRITERIA)).transpose()?;
        let why = impossible.as_ref().map_or(Vec::new(), |judged| evidence(&judged.finding.evidence, source));
        lines.send(&reached(analysis, level, &reach, &why))?;
        let mut witness = None;
        match &impossible {
            Some(judged) => {
                let text = told.first().cloned().unwrap_or_else(|| judged.answer());
                lines.send(&json!({ "stage": "impossible", "text": text, "states": 0 }))?;
                lines.send(&criterion(judged, source))?;
            }
            None => match self.search(lines)? {
                Solution::Won { episode, .. } => witness = Some(*episode),
                Solution::Impossible { states, .. } => {
                    lines.check()?;
                    // The proof was cheap enough to repeat, this time with an explanation.
                    let budget = SEARCHES[SEARCHES.len() - 1].max(states.saturating_mul(8)).min(MOST_CALLS);
                    lines.send(&criterion(&self.why_not(budget)?, source))?;
                }
                Solution::Unknown => {
                    lines.check()?;
                    // Nothing has been proved. However, if a game that differs in only one line can be won, that line
                    // shows where to look.
                    let judged = self.why_not(CRITERIA)?;
                    if !judged.finding.evidence.is_empty() {
                        lines.send(&criterion(&judged, source))?;
                    }
                }
            },
        }
        let is_open = impossible.is_none() && witness.is_some();
        // Either it is already known whether the level can be won, or finding out takes more calls than are available
        // here.
        let answered = CriterionSet::of(&[Criterion::Winnable]);
        let of_wins = CriterionSet::of(&[Criterion::Length, Criterion::Skill]);
        let skipped = if is_open { answered } else { answered.with(of_wins) };
        let criteria = Criteria { budget: CRITERIA, ..Criteria::full() }.check().map_err(Refusal::failed)?;
        let panel = Panel::new(criteria.without(skipped), Effort::Calls(CRITERIA));
        let gone = || lines.check().is_err();
        let mut heard = Ok(());
        let tell = &mut |judged: &Judgement| {
            heard = lines.send(&criterion(judged, source));
            if let (Ok(()), Some(ladder)) = (heard, &judged.finding.ladder) {
                heard = lines.send(&ladder_rows(ladder));
            }
            heard.is_ok()
        };
        panel.judge(Judging::level(game, level, seed).won_by(witness).watched_by(tell, &gone));
        Ok(heard.and_then(|()| lines.check())?)
    }

    /// Searches for a win, and sends the result.
    fn search(&self, lines: &Lines) -> Result<Solution, Ended> {
        let Subject { compiled, level, seed, budget } = *self;
        let most = budget.unwrap_or(SEARCHES[SEARCHES.len() - 1]);
        let gone = || lines.check().is_err();
        let tell = &mut |spent| lines.send(&json!({ "stage": "search", "calls": spent })).is_ok();
        let (solution, spent) = look_for_win(&compiled.analysis, level, most, seed, &gone, tell);
        lines.check()?;
        match &solution {
            Solution::Won { episode, shortest } => {
                let ticks = episode.actions.len();
                lines.send(&json!({
                    "stage": "win", "ticks": ticks, "shortest": shortest, "calls": spent, "episode": episode,
                }))?;
            }
            Solution::Impossible { states, .. } => {
                let text = format!("the level cannot be won: all {states} reachable states were searched");
                lines.send(&json!({ "stage": "impossible", "text": text, "states": states }))?;
            }
            Solution::Unknown => {
                let text = format!("no win found with {spent} forward-model calls; a win may still exist");
                lines.send(&json!({ "stage": "unknown", "calls": spent, "text": text }))?;
            }
        }
        Ok(solution)
    }

    /// Returns the judgement on a level that cannot be won, with the chain of reasons.
    fn why_not(&self, budget: u64) -> Result<Judgement, Refusal> {
        let ask = CriterionSet::of(&[Criterion::Winnable]);
        let criteria = Criteria { ask, budget, ..Criteria::full() }.check().map_err(Refusal::failed)?;
        let panel = Panel::new(criteria, Effort::Full);
        let mut report = panel.judge(Judging::level(&self.compiled.game, self.level, self.seed));
        Ok(report.judgements.pop().expect("one criterion was requested"))
    }
}

/// Searches for a win with increasing numbers of calls, up to `most` per search, until `gone` returns `true`. After
/// each search without an answer, `tell` receives the number of calls spent so far, and can stop the work by
/// returning `false`. Returns the answer and the number of calls spent.
pub(crate) fn look_for_win(
    analysis: &Analysis,
    level: &Level,
    most: u64,
    seed: Seed,
    gone: &(dyn Fn() -> bool + Sync),
    tell: &mut dyn FnMut(u64) -> bool,
) -> (Solution, u64) {
    let most = most.clamp(1, MOST_CALLS);
    let mut spent = 0;
    for budget in SEARCHES.into_iter().filter(|&calls| calls < most).chain([most]) {
        if gone() {
            break;
        }
        let config =
            PortfolioConfig { budget, foresight: FORESIGHT, bytes: BYTES, ..PortfolioConfig::default() };
        let Solved { solution, calls, .. } = solve_until(analysis, level, &config, seed, gone);
        spent += calls;
        if !matches!(solution, Solution::Unknown) {
            return (solution, spent);
        }
        if !tell(spent) {
            break;
        }
    }
    (Solution::Unknown, spent)
}

/// The roles of sprites whose initial positions the player wants to reach.
const WANTED: [Role; 6] =
    [Role::Exit, Role::Key, Role::Collectable, Role::Pushable, Role::Portal, Role::Breakable];

/// Returns the types that the avatar can reach, the types that it cannot reach, and the cells where it can be.
fn reached(analysis: &Analysis, level: &Level, reach: &Reach, why: &[Value]) -> Value {
    let game = analysis.game();
    let cell = |at: usize| json!([at % level.columns(), at / level.columns()]);
    let (mut reachable, mut unreachable) = (Vec::new(), Vec::new());
    for stype in game.sprite_types().filter(|&stype| WANTED.contains(&analysis.role(stype))) {
        let mut placed =
            (0..level.cells().len()).filter(|&at| game.places(level.cells()[at]).contains(&stype)).peekable();
        if placed.peek().is_none() {
            continue;
        }
        let cells: Vec<Value> = placed.filter(|&at| !reach.avatar_touches(at)).map(cell).collect();
        match cells.is_empty() {
            true => reachable.push(game.name(stype)),
            false => unreachable.push(json!({ "type": game.name(stype), "cells": cells })),
        }
    }
    let avatar: Vec<Value> =
        (0..level.cells().len()).filter(|&at| reach.avatar_reaches(at)).map(cell).collect();
    json!({
        "stage": "reach",
        "reachable": reachable,
        "unreachable": unreachable,
        "avatar": avatar,
        "coarse": reach.is_coarse(),
        "why": why,
    })
}

/// Returns evidence in the page's format. Cells are counted from 0, and rules are identified by their
/// positions in the text.
fn evidence(seen: &[Evidence], source: &str) -> Vec<Value> {
    seen.iter()
        .map(|seen| {
            json!({
                "text": seen.text,
                "tick": seen.tick,
                "cell": seen.cell.map(|(column, row)| [column.saturating_sub(1), row.saturating_sub(1)]),
                "rule": seen.rule.as_ref().map(|rule| located(rule, source)),
                "advice": seen.advice,
            })
        })
        .collect()
}

fn located(rule: &Line, source: &str) -> Value {
    let (start, end) = positions::range(source, rule.span);
    json!({ "line": line_and_column(source, rule.span.start).0, "start": start, "end": end, "text": rule.text })
}

/// Returns the line that reports a judgement.
pub(crate) fn criterion(judged: &Judgement, source: &str) -> Value {
    let (verdict, episode) = match &judged.finding.verdict {
        Verdict::Pass { witness } => ("pass", witness.as_ref()),
        Verdict::Fail { witness, .. } => ("fail", witness.as_ref()),
        Verdict::Unknown { .. } if judged.is_skipped() => ("skipped", None),
        Verdict::Unknown { .. } => ("unknown", None),
    };
    json!({
        "stage": "criterion",
        "name": judged.criterion,
        "verdict": verdict,
        "text": judged.answer(),
        "evidence": evidence(&judged.finding.evidence, source),
        "episode": episode,
    })
}

fn ladder_rows(ladder: &Ladder) -> Value {
    let row = |result: &PlayerResult| {
        let [low, high] = result.rate.interval;
        json!({ "player": result.player, "wins": result.rate.wins, "plays": result.rate.plays, "low": low, "high": high })
    };
    let rows: Vec<Value> = ladder.rungs.iter().chain(&ladder.held_out).map(row).collect();
    json!({ "stage": "ladder", "rows": rows, "difficulty": ladder.difficulty })
}
