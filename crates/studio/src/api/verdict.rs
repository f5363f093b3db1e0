//! Requests whose responses are sent line by line: the verdict on a level, a game's criteria, and new levels.

use crate::answers::Asked;
use crate::compiled::Compiled;
use crate::frames::{Frame, Tiles};
use crate::lines::{Ended, Lines};
use crate::positions;
use crate::refusal::Refusal;
use crate::running::Work;
use crate::studio::Studio;
use crate::verdict::{BYTES, FORESIGHT, Subject, criterion};
use agents::{PortfolioConfig, Solution, solve_until};
use base::Seed;
use engine::{Diagnostic, Diagnostics, Episode, Level};
use forge::levels::{LevelOrder, MadeLevel, Method, make_levels};
use generators::levels::{Examples, LevelConfig};
use serde::Deserialize;
use serde_json::{Value, json};
use std::sync::Arc;
use validators::{
    Criteria, Criterion, CriterionSet, Demand, Difficulty, Effort, Judgement, Judging, Panel, Report, Tier,
    shorter_win,
};

/// A request to judge a level.
#[derive(Deserialize)]
pub(crate) struct Judge {
    source: String,
    level: String,
    budget: Option<u64>,
    seed: Option<String>,
}

fn problems(place: &str, text: &str, problems: &[Diagnostic]) -> Vec<Value> {
    let listed = problems.iter().map(|found| {
        let mut found = positions::problem(text, found);
        found["in"] = json!(place);
        found
    });
    listed.collect()
}

pub(crate) fn verdict(studio: &Studio, asked: Asked<Judge>, lines: &Lines) -> Result<(), Ended> {
    let _running = studio.verdicts.begin(Work::Level, asked.page, lines);
    let Judge { source, level, budget, seed } = asked.body;
    let send = |problems: Vec<Value>| lines.send(&json!({ "stage": "problems", "problems": problems }));
    let compiled = match studio.compiled.find(&source) {
        Ok(compiled) => compiled,
        Err(Diagnostics(found)) => return Ok(send(problems("source", &source, &found))?),
    };
    let mut found = problems("source", &source, compiled.game.warnings());
    let checked = match compiled.game.level(&level) {
        Ok(checked) => checked,
        Err(Diagnostics(of_level)) => {
            found.extend(problems("level", &level, &of_level));
            return Ok(send(found)?);
        }
    };
    found.extend(problems("level", &level, checked.warnings()));
    send(found)?;
    let seed = Seed::from_text(seed.as_deref().unwrap_or("studio")).child(&checked.digest().to_string(), 0);
    Subject { compiled: &compiled, level: &checked, seed, budget }.judge(lines)
}

/// A request to judge a game across all its levels.
#[derive(Deserialize)]
pub(crate) struct Necessity {
    source: String,
    levels: Vec<String>,
}

/// The number of forward-model calls for each of these tasks: judging a level, judging a game across all its levels,
/// and winning a new level.
const CALLS: u64 = 300_000;

pub(crate) fn necessity(studio: &Studio, asked: Asked<Necessity>, lines: &Lines) -> Result<(), Ended> {
    let _running = studio.verdicts.begin(Work::Game, asked.page, lines);
    let compiled = studio.compiled.need(&asked.body.source)?;
    let texts = asked.body.levels.iter();
    let levels: Vec<Level> = texts.map(|text| compiled.level(text)).collect::<Result<_, Refusal>>()?;
    if levels.is_empty() {
        return Err(Refusal::bad("the game has no level").help("draw one first").into());
    }
    let full = Criteria::full();
    let criteria = Criteria { ask: full.ask.with(CriterionSet::GATES), budget: CALLS, ..full };
    let panel = Panel::new(criteria.check().map_err(Refusal::failed)?, Effort::Calls(CALLS));
    let seed = Seed::from_text("studio");
    let gone = &|| lines.check().is_err();
    let mut reports: Vec<Report> = Vec::new();
    for (number, level) in levels.iter().enumerate() {
        lines.send(&json!({ "stage": "judging", "level": number, "of": levels.len() }))?;
        let own = seed.child(&level.digest().to_string(), 0);
        let judging = Judging::level(&compiled.game, level, own);
        reports.push(panel.judge(judging.watched_by(&mut |_| true, gone)));
        lines.check()?;
    }
    let tell = &mut |judged: &Judgement| lines.send(&criterion(judged, &compiled.source)).is_ok();
    panel.judge(Judging::together(&compiled.game, &levels, &reports, seed).watched_by(tell, gone));
    Ok(lines.check()?)
}

/// A request to generate levels.
#[derive(Deserialize)]
pub(crate) struct More {
    source: String,
    /// The level that the new levels should resemble.
    level: Option<String>,
    method: String,
    width: Option<usize>,
    height: Option<usize>,
    difficulty: Option<String>,
    tier: Option<u8>,
    #[serde(default)]
    seed: String,
    count: u32,
}

/// The maximum number of levels per request.
const MOST_LEVELS: u32 = 20;
/// The maximum number of levels to generate per requested level. The limit matters if a tier is requested, because
/// generators do not aim at a tier.
const TRIES: u32 = 4;

pub(crate) fn more(studio: &Studio, asked: Asked<More>, lines: &Lines) -> Result<(), Ended> {
    let More { source, level, method, width, height, difficulty, tier, seed, count } = asked.body;
    let compiled = studio.compiled.need(&source)?;
    let method: Method = method.parse().map_err(Refusal::bad)?;
    let example = level.and_then(|text| compiled.game.level(&text).ok());
    let config = example.and_then(|level| Examples::of(&compiled.game, &[level]));
    let mut config =
        config.map_or_else(LevelConfig::default, |examples| LevelConfig::like(Arc::new(examples)));
    if let Some(width) = width {
        config.columns = (width, width);
    }
    if let Some(height) = height {
        config.rows = (height, height);
    }
    let asked_for = difficulty.filter(|label| !label.is_empty());
    let difficulty: Option<Difficulty> =
        asked_for.map(|label| label.parse()).transpose().map_err(Refusal::bad)?;
    let wanted: Option<Tier> = tier.map(Tier::try_from).transpose().map_err(Refusal::bad)?;
    let seed = Seed::from_text(&seed).child(method.name(), 0);
    let mut tiles = Tiles::default();
    let count = count.min(MOST_LEVELS);
    let tries = if wanted.is_some() { TRIES * count } else { count };
    let mut sent = 0;
    // Levels are made one after another, so that each is sent as soon as it is made.
    for number in 0..tries {
        if sent == count {
            break;
        }
        lines.check()?;
        let order = LevelOrder { difficulty, ..LevelOrder::new(method, 1, config.clone()) };
        let made = make_levels(&compiled.game, &order, seed.child("level", u64::from(number)), &());
        let set = match made {
            Ok(set) => set,
            Err(error) => {
                lines.send(&json!({ "stage": "none", "text": error.to_string() }))?;
                continue;
            }
        };
        for made in set.levels {
            let seed = seed.child("win", u64::from(number));
            let Some((win, is_shortest)) = known_win(&compiled, &made, seed, lines) else {
                lines.send(&json!({ "stage": "none", "text": "no win was found" }))?;
                continue;
            };
            let win = match wanted {
                Some(_) => shorter_win(&compiled.analysis, &made.level, &win, seed.child("shorter win", 0))
                    .unwrap_or(win),
                None => win,
            };
            let measured = wanted.and_then(|_| {
                Demand::of(&compiled.analysis, &made.level, &win, is_shortest, seed.child("tier", 0))
            });
            let tier = measured.as_ref().map(Demand::tier);
            if let (Some(wanted), Some(tier)) = (wanted, tier)
                && tier != wanted
            {
                lines.send(&json!({ "stage": "none", "text": format!("tier {tier}, not {wanted}") }))?;
                continue;
            }
            sent += 1;
            let state = compiled.game.start(&made.level, Seed::from_text("board"));
            let frame = Frame::of(&compiled, &state, 0, &mut tiles)?;
            lines.send(&json!({
                "stage": "level",
                "level": made.level.to_string(),
                "tiles": tiles.fresh(),
                "frame": frame,
                "ticks": win.actions.len(),
                "episode": win,
                "difficulty": made.ladder.map(|ladder| ladder.difficulty),
                "tier": tier,
            }))?;
        }
    }
    Ok(())
}

/// Returns a new level's winning episode. It comes from the level's judges or, if the level was not judged, from a
/// search. Also returns `true` if the episode is proved to be a shortest win.
fn known_win(compiled: &Compiled, made: &MadeLevel, seed: Seed, lines: &Lines) -> Option<(Episode, bool)> {
    if let Some(report) = &made.report {
        let win = report.witness.clone()?;
        let optimal = report.finding(Criterion::Winnable).and_then(|finding| finding.optimal);
        let is_shortest = optimal == Some(win.actions.len());
        return Some((win, is_shortest));
    }
    let config =
        PortfolioConfig { budget: CALLS, foresight: FORESIGHT, bytes: BYTES, ..PortfolioConfig::default() };
    let gone = || lines.check().is_err();
    match solve_until(&compiled.analysis, &made.level, &config, seed, &gone).solution {
        Solution::Won { episode, shortest } => Some((*episode, shortest)),
        Solution::Impossible { .. } | Solution::Unknown => None,
    }
}
