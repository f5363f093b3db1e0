//! `arcade release --dry-run`: a mint's contents and cost.

use super::cost::{forecast, words};
use super::progress::Remarks;
use crate::console::Console;
use crate::failure::{Answer, Failure};
use base::MessagePath;
use base::count;
use serde_json::json;
use snapshots::mint::{Job, JobFolder, Plan};
use snapshots::{Corpus, Draft, Order, Prepared, PuzzleKind, Recipe, SnapshotError, Tools, check_vacant};
use std::path::{Path, PathBuf};

/// Prints a mint's contents and its cost on this machine. Probes the machine's speed if the mint takes more
/// than half a minute. If the order resumes a mint, only the unfinished jobs are counted.
pub(super) fn outline(prepared: &Prepared<'_>, order: &Order, corpus: &Corpus, console: &Console) -> Answer {
    let Prepared { plan, jobs, .. } = prepared;
    let &Order { ref recipe, ref out, resume, .. } = order;
    let (old, new) = (&recipe.corpus, &recipe.generated);
    let names: Vec<String> = jobs.iter().map(|&job| plan.name(job)).collect();
    let made = made(plan, &names, out)?;
    let left: Vec<Job> = match resume {
        true => jobs.iter().zip(&made).filter(|(_, made)| !**made).map(|(&job, _)| job).collect(),
        false => jobs.clone(),
    };
    let (forecast, slowness) = forecast(plan, &left, corpus);
    let place = out.in_message().to_string();
    let taken = check_vacant(out).err();
    let there = made.iter().filter(|made| **made).count();
    console.document(&json!({
        "recipe": recipe, "out": place, "jobs": names, "jobs_made": there, "core_minutes": forecast.median / 60.0,
        "core_seconds": [forecast.median, forecast.tail],
        "slowness": slowness, "out_is_taken": taken.is_some(), "caveats": recipe.caveats(),
    }))?;
    console.say(format_args!("recipe `{}`: {}", recipe.name, recipe.description.trim()));
    let invented = recipe.invented.as_ref().map(|part| (part.games, part.levels, "invented game"));
    let puzzle =
        |kind: PuzzleKind| recipe.puzzles_of(kind).map(|part| (part.games, part.levels, kind.noun()));
    let designs = recipe.designs.as_ref().map(|part| (part.games, part.levels, "design"));
    let made = invented.into_iter().chain(designs).chain([(new.games, new.levels, "new game")]);
    let made = made.chain(PuzzleKind::ALL.into_iter().filter_map(puzzle)).filter(|(games, ..)| *games > 0);
    let made = made.map(|(games, levels, noun)| {
        format!("{} of {}", count(games as usize, noun), count(levels as usize, "level"))
    });
    let more = (old.games > 0).then(|| {
        let [levels, games] = [(old.levels, "new level"), (old.games, "corpus game")];
        format!("{} for each of {}", count(levels.0 as usize, levels.1), count(games.0 as usize, games.1))
    });
    for (at, part) in made.chain(more).enumerate() {
        console.say(format_args!("{} {part}", if at == 0 { "would mint" } else { "and" }));
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
    console.say(format_args!("in {}", words(forecast)));
    if let Some(times) = slowness {
        console.say(format_args!("this machine takes {times:.2} times as long as the reference machine"));
    }
    console.say(format_args!("into {place}"));
    match taken {
        Some(SnapshotError::Occupied(_)) => {
            console.say(format_args!("which already exists: choose another --out, or remove that folder"));
        }
        Some(other) => return Err(other.into()),
        None if there > 0 && !resume => {
            console.say(format_args!(
                "which contains an interrupted mint with {there} of the jobs finished: continue with --resume"
            ));
        }
        None => {}
    }
    recipe.caveats().iter().for_each(|caveat| console.say(format_args!("note: {caveat}")));
    Ok(true)
}

/// Returns, for each job, `true` if an interrupted mint has already finished it.
fn made(plan: &Plan<'_>, names: &[String], out: &Path) -> Result<Vec<bool>, Failure> {
    let Some(folder) = Draft::jobs_of(out) else { return Ok(vec![false; names.len()]) };
    let digest = plan.digest()?;
    match JobFolder::there(&folder, digest, names) {
        // A mint into this folder would fail, but an outline does not mint.
        Err(SnapshotError::OtherPlan(_)) => Ok(vec![false; names.len()]),
        there => Ok(there?),
    }
}

/// Prints the public facts of a sealed release without using its secret.
pub(super) fn without_secret(recipe: &Recipe, tools: Tools<'_>, console: &Console) -> Answer {
    // The number of games that can be made does not depend on the seed.
    let open = Recipe { seed: Some(recipe.name.clone()), commitment: None, beacon: None, ..recipe.clone() };
    let order = Order { recipe: open, secret: None, out: PathBuf::new(), shard: None, resume: false };
    let plan = order.prepare(tools, &Remarks(console))?.plan;
    let (forecast, _) = forecast(&plan, plan.jobs(), tools.corpus);
    let caveats = recipe.caveats();
    let seconds = [forecast.median, forecast.tail];
    console.document(&json!({ "recipe": recipe, "core_seconds": seconds, "caveats": caveats }))?;
    let games = recipe.games();
    console.say(format_args!("recipe `{}`: {}", recipe.name, recipe.description.trim()));
    console.say(format_args!(
        "would mint {games} games with {} levels, sealed; pass --secret FILE to see the plan",
        recipe.levels()
    ));
    console.say(format_args!("in {}", words(forecast)));
    caveats.iter().for_each(|caveat| console.say(format_args!("note: {caveat}")));
    Ok(true)
}
