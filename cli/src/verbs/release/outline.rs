//! `arcade release --dry-run`: the contents and the cost of a mint.

use super::probe;
use crate::console::Console;
use crate::counted::count;
use crate::failure::Answer;
use serde_json::json;
use snapshots::mint::{Job, JobFolder, Plan};
use snapshots::{Corpus, Draft, Recipe, SnapshotError, check_vacant};
use std::path::Path;

/// The mint to outline.
pub(super) struct Asked<'a> {
    pub(super) jobs: &'a [Job],
    pub(super) out: &'a Path,
    /// Only what an interrupted mint left to do.
    pub(super) resume: bool,
}

/// Prints the contents of a mint and its cost on this machine. Mints of more than [`PROBED`] seconds are worth a probe of its speed.
pub(super) fn outline(plan: &Plan<'_>, corpus: &Corpus, asked: &Asked<'_>, console: &Console) -> Answer {
    let (&Asked { jobs, out, resume }, recipe) = (asked, plan.recipe);
    let (old, new) = (&recipe.corpus, &recipe.generated);
    let names: Vec<String> = jobs.iter().map(|&job| plan.name(job)).collect();
    let made = made(plan, &names, out)?;
    let left: Vec<Job> = match resume {
        true => jobs.iter().zip(&made).filter(|(_, made)| !**made).map(|(&job, _)| job).collect(),
        false => jobs.to_vec(),
    };
    let seconds = plan.seconds(&left);
    let slowness = if seconds >= PROBED { probe::slowness(corpus) } else { None };
    let range = estimate_range(seconds * slowness.unwrap_or(1.0));
    let place = out.display().to_string();
    let taken = check_vacant(out).err();
    let there = made.iter().filter(|made| **made).count();
    console.document(&json!({
        "recipe": recipe, "out": place, "lots": names, "lots_made": there, "core_minutes": seconds / 60.0,
        "core_seconds": [range.0, range.1],
        "slowness": slowness, "out_is_taken": taken.is_some(),
    }))?;
    console.say(format_args!("recipe `{}`: {}", recipe.name, recipe.description.trim()));
    if new.games > 0 {
        console.say(format_args!(
            "would mint {} of {}",
            count(new.games as usize, "new game"),
            count(new.levels as usize, "level")
        ));
    }
    let puzzles = [
        (&recipe.puzzles, "new puzzle"),
        (&recipe.locks, "new lock puzzle"),
        (&recipe.yards, "new yard"),
        (&recipe.strays, "new stray puzzle"),
    ];
    let puzzles: Vec<_> =
        puzzles.into_iter().filter_map(|(part, what)| Some((part.as_ref()?, what))).collect();
    for (at, (part, what)) in puzzles.iter().enumerate() {
        let would = if new.games > 0 || at > 0 { "and" } else { "would mint" };
        console.say(format_args!(
            "{would} {} of {}",
            count(part.games as usize, what),
            count(part.levels as usize, "level")
        ));
    }
    if old.games > 0 {
        let would = if new.games > 0 || !puzzles.is_empty() { "and" } else { "would mint" };
        console.say(format_args!(
            "{would} {} for each of {}",
            count(old.levels as usize, "new level"),
            count(old.games as usize, "corpus game")
        ));
    }
    if !recipe.difficulty.is_empty() {
        let shares = plan.histogram().into_iter().map(|(label, levels)| format!("{label} {levels}"));
        console
            .say(format_args!("with levels of each difficulty: {}", shares.collect::<Vec<_>>().join(", ")));
    }
    let goals = recipe.goal_quotas().into_iter().map(|(goal, quota)| (goal.name(), quota));
    let avatars = recipe.avatar_quotas().into_iter().map(|(avatar, quota)| (avatar.name(), quota));
    let quotas: Vec<String> =
        goals.chain(avatars).map(|(name, (least, most))| format!("{name} {least} to {most}")).collect();
    if !quotas.is_empty() {
        console.say(format_args!("with games of each kind: {}", quotas.join(", ")));
    }
    console.say(format_args!("selected from the candidates of {}", count(jobs.len(), "job")));
    if resume {
        console.say(format_args!("of which {there} are finished and {} are left", left.len()));
    }
    match slowness {
        Some(times) => console.say(format_args!(
            "in {} of one core of this machine, which takes {times:.2} times as long as the one that was measured",
            words(range)
        )),
        None => console.say(format_args!("in {} of one core", words(range))),
    }
    console.say(format_args!("into {place}"));
    match taken {
        Some(SnapshotError::Occupied(_)) => {
            console.say(format_args!("which exists: choose another --out, or remove it"));
        }
        Some(other) => return Err(other.into()),
        None if there > 0 && !resume => {
            console.say(format_args!(
                "which holds an interrupted mint with {there} of the jobs finished: continue with --resume"
            ));
        }
        None => {}
    }
    Ok(true)
}

/// Returns, for each job, `true` if an interrupted mint has finished it.
fn made(plan: &Plan<'_>, names: &[String], out: &Path) -> Result<Vec<bool>, crate::failure::Failure> {
    let Some(folder) = Draft::jobs_of(out) else { return Ok(vec![false; names.len()]) };
    let digest = plan.digest()?;
    match JobFolder::there(&folder, digest, names) {
        // A mint into this place would fail; a plan is not a mint.
        Err(SnapshotError::OtherPlan(_)) => Ok(vec![false; names.len()]),
        there => Ok(there?),
    }
}

/// The seconds of one core from which it is worth a third of a second to measure the speed of the machine.
const PROBED: f64 = 30.0;

/// The greatest deviation from the estimate, as a share.
const SPREAD: f64 = 0.25;

/// Returns the least and the greatest seconds to expect.
fn estimate_range(seconds: f64) -> (f64, f64) {
    // An empty sum may be -0.
    let seconds = seconds.abs();
    (seconds * (1.0 - SPREAD), seconds * (1.0 + SPREAD))
}

/// Formats a range of seconds in a suitable unit.
fn words((least, most): (f64, f64)) -> String {
    match most {
        _ if most < 120.0 => format!("{least:.0} to {most:.0} seconds"),
        _ if most < 7200.0 => format!("{:.0} to {:.0} minutes", least / 60.0, most / 60.0),
        _ => format!("{:.1} to {:.1} hours", least / 3600.0, most / 3600.0),
    }
}

/// Prints the public facts of a sealed release, without its secret.
pub(super) fn without_secret(recipe: &Recipe, console: &Console) -> Answer {
    console.document(&json!({ "recipe": recipe }))?;
    let games = recipe.games();
    console.say(format_args!("recipe `{}`: {}", recipe.name, recipe.description.trim()));
    console.say(format_args!(
        "would mint {games} games with {} levels, sealed; give --secret FILE for the plan",
        recipe.levels()
    ));
    Ok(true)
}
