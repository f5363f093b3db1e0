//! Simulations of the scale, which compare the stated errors of the months' positions (links), of abilities and of
//! drifts with the true errors.

use super::{Args, share};
use rayon::prelude::*;
use report::{Table, TableCell};
use statistics::scale::simulated::{
    AbilityCase, AbilityTrial, AdaptiveTrial, LinkTrial, Plan, ability_trials, adaptive_trials, link_trial,
};
use statistics::scale::{Dimension, Spreads};

/// The number of players per case, on one pair of months.
const PERSONS: usize = 40;
/// The number of bootstrap replicates for correcting the bias of the spreads. `arcade study calibrate` uses
/// 40.
const REPLICATES: u64 = 4;

fn plan(families: Vec<usize>, runs: u32) -> Plan {
    let spreads = Spreads { game: 1.6, level: 1.6, family: 1.5, planner: 0.5, ..Spreads::default() };
    Plan {
        games: 120,
        levels: 5,
        families,
        runs,
        anchors: 0,
        anchor_runs: 0,
        replicates: REPLICATES,
        spreads,
    }
}

/// Returns the results of all trials whose calibration succeeded. Each trial has its own seed.
fn trials<T: Send>(args: &Args, trials: u64, case: usize, one: impl Fn(u64) -> Option<T> + Sync) -> Vec<T> {
    let seed = args.seed * 1_000_003 + case as u64 * 10_007;
    (0..trials).into_par_iter().filter_map(|trial| one(seed + trial)).collect()
}

/// Returns the root mean square error, the mean stated error, and the fraction of cases in which the 95%
/// interval contains the truth.
fn errors(found: &[(f64, f64)]) -> [TableCell; 3] {
    let count = found.len() as f64;
    let square = found.iter().map(|(off, _)| off * off).sum::<f64>() / count;
    let stated = found.iter().map(|(_, error)| error).sum::<f64>() / count;
    let covered = found.iter().filter(|(off, error)| off.abs() <= statistics::Z95 * error).count();
    [share(square.sqrt()), share(stated), share(covered as f64 / count)]
}

/// Simulates estimating the difference in difficulty between two months of 120 games with 5 levels each.
pub(super) fn link(args: &Args) -> Table {
    let count = args.trials.unwrap_or(200);
    let cases = [
        ("2 families of 3 and 1", plan(vec![3, 1], 4)),
        ("8 families", plan(vec![1; 8], 1)),
        ("8 families", plan(vec![1; 8], 2)),
        ("8 families", plan(vec![1; 8], 4)),
        ("8 families, 4 with two members", plan(vec![2, 2, 2, 2, 1, 1, 1, 1], 2)),
        ("16 families", plan(vec![1; 16], 2)),
    ];
    let note = format!(
        "{count} pairs of months each, the second 0.3 logits harder. Standard deviation of games and levels 1.6, of family and game \
         1.5, of planner and game 0.5 logit. Errors in logits."
    );
    let columns = [
        "planners",
        "plays of each on a level",
        "to these",
        "stated",
        "coverage",
        "to any",
        "stated",
        "coverage",
    ];
    let mut table = Table::new("link", "Errors of the link of two months", &note, &columns);
    for (case, (name, plan)) in cases.iter().enumerate() {
        let found: Vec<LinkTrial> = trials(args, count, case, |seed| link_trial(plan, 0.3, 0.0, seed));
        let these = errors(&found.iter().map(|trial| trial.to_these).collect::<Vec<_>>());
        let any = errors(&found.iter().map(|trial| trial.to_any).collect::<Vec<_>>());
        let runs = TableCell::Count(u64::from(plan.runs));
        table.rows.push([TableCell::text(*name), runs].into_iter().chain(these).chain(any).collect());
    }
    table
}

/// Simulates estimating a player's ability on a month that has been placed on the scale.
pub(super) fn ability(args: &Args) -> Table {
    let count = args.trials.unwrap_or(50);
    let alone = plan(vec![1; 8], 2);
    let anchored = |runs| Plan { anchors: 3, anchor_runs: runs, ..alone.clone() };
    let mut cases = Vec::new();
    for (mismatch, ability) in [(1.0, 0.0), (1.0, -2.0), (2.0, 0.0), (2.0, -2.0)] {
        cases.extend([100, 200, 600].map(|episodes| AbilityCase { ability, mismatch, episodes }));
    }
    let note = format!(
        "{} players each, {PERSONS} on each of {count} pairs of months of 120 games × 5 levels, which 8 families calibrated with 2 \
         plays of each on a level and {REPLICATES} replicates; an episode on each level, spread over games. Errors in logits.",
        count * PERSONS as u64
    );
    let columns = ["difficulty", "mismatch SD", "ability", "episodes", "error", "stated", "coverage"];
    let mut table = Table::new("ability", "Errors of abilities", &note, &columns);
    let dimensions = [
        ("planners'", alone.clone(), Dimension::Planner),
        ("readers', 3 anchors once", anchored(1), Dimension::Reader),
        ("readers', 3 anchors twice", anchored(2), Dimension::Reader),
    ];
    for (number, (name, plan, dimension)) in dimensions.into_iter().enumerate() {
        // All players play the same months.
        let found: Vec<Vec<Vec<AbilityTrial>>> =
            trials(args, count, number, |seed| ability_trials(&plan, dimension, &cases, PERSONS, seed));
        for (at, case) in cases.iter().enumerate() {
            let found: Vec<AbilityTrial> = found.iter().flat_map(|of| &of[at]).copied().collect();
            let pairs: Vec<(f64, f64)> = found.iter().map(|trial| (trial.off, trial.error)).collect();
            let [off, stated, _] = errors(&pairs);
            let covered = found.iter().filter(|trial| trial.is_covered).count() as f64 / found.len() as f64;
            let place = [TableCell::number(case.mismatch, 0), TableCell::number(case.ability, 0)];
            let episodes = TableCell::Count(case.episodes as u64);
            let row = [TableCell::text(name)].into_iter().chain(place);
            table.rows.push(row.chain([episodes, off, stated, share(covered)]).collect());
        }
    }
    table
}

/// Simulates a month's drift (the additional difficulty for players that see only prompts), estimated with anchors
/// (unchanging players of this kind).
pub(super) fn drift(args: &Args) -> Table {
    let count = args.trials.unwrap_or(100);
    let mut cases = Vec::new();
    for (games, anchors) in [(40, 3), (120, 3), (120, 6)] {
        cases.extend([0.0, 0.5].map(|drift| (games, anchors, drift)));
    }
    let note = format!(
        "{count} pairs of months each, of 5 levels per game, the second 0.3 logits harder for planners; each \
         anchor plays each level \
         once. Flagged at 5%."
    );
    let columns = ["games", "levels", "anchors", "planted drift", "flagged", "error", "stated", "coverage"];
    let mut table = Table::new("drift", "Drift as anchors see it", &note, &columns);
    for (case, (games, anchors, drift)) in cases.into_iter().enumerate() {
        let plan = Plan { games, anchors, anchor_runs: 1, ..plan(vec![1; 8], 2) };
        // The months with and without drift are otherwise the same.
        let found: Vec<LinkTrial> = trials(args, count, case / 2, |seed| link_trial(&plan, 0.3, drift, seed));
        let flagged = found.iter().filter(|trial| trial.drift.0.abs() > statistics::Z95 * trial.drift.1);
        let flagged = flagged.count() as f64 / found.len() as f64;
        let pairs: Vec<(f64, f64)> =
            found.iter().map(|trial| (trial.drift.0 - drift, trial.drift.1)).collect();
        let sizes = [games, games * 5, anchors].map(|count| TableCell::Count(count as u64));
        let shares = [TableCell::number(drift, 1), share(flagged)];
        table.rows.push(sizes.into_iter().chain(shares).chain(errors(&pairs)).collect());
    }
    table
}

/// Returns a table of the number of episodes that an adaptive choice needs to reach the same error as a
/// design that spreads episodes over the games.
pub(super) fn adaptive(args: &Args) -> Table {
    const EPISODES: usize = 200;
    const PLAYERS: usize = 20;
    let months = args.trials.unwrap_or(20);
    let plan = plan(vec![1; 8], 2);
    let counts: Vec<usize> = (6..=20).map(|tens| tens * 10).collect();
    let mut cases = Vec::new();
    for mismatch in [1.0, 2.0] {
        cases.extend([-4.0, -3.0, -2.0, 0.0, 2.0, 3.0].map(|ability| (ability, mismatch)));
    }
    let note = format!(
        "{} players each, {PLAYERS} on each of {months} pairs of months of 120 games × 5 levels, which 8 families calibrated with 2 \
         plays of each on a level and {REPLICATES} replicates; one episode on a level. Spread: {EPISODES} episodes, over games \
         first. Adaptive: the smallest number of episodes (in tens) whose stated error is no larger. Errors in logits.",
        months * PLAYERS as u64
    );
    let columns = [
        "mismatch SD",
        "ability",
        "spread: error",
        "stated",
        "coverage",
        "adaptive episodes",
        "share",
        "error",
        "stated",
        "coverage",
    ];
    let mut table = Table::new("adaptive", "Episodes of an adaptive choice at equal error", &note, &columns);
    // All players play the same months.
    let all: Vec<Vec<Vec<AdaptiveTrial>>> =
        trials(args, months, 0, |seed| adaptive_trials(&plan, &cases, (EPISODES, &counts), PLAYERS, seed));
    for (at, (ability, mismatch)) in cases.iter().copied().enumerate() {
        let found: Vec<&AdaptiveTrial> = all.iter().flat_map(|of| &of[at]).collect();
        let cells = |of: &dyn Fn(&AdaptiveTrial) -> AbilityTrial| {
            let all: Vec<AbilityTrial> = found.iter().map(|trial| of(trial)).collect();
            let [off, stated, _] = errors(&all.iter().map(|one| (one.off, one.error)).collect::<Vec<_>>());
            let covered = all.iter().filter(|one| one.is_covered).count();
            [off, stated, share(covered as f64 / all.len() as f64)]
        };
        let stated = |of: &dyn Fn(&AdaptiveTrial) -> f64| {
            found.iter().map(|trial| of(trial)).sum::<f64>() / found.len() as f64
        };
        let bar = stated(&|trial| trial.spread.error);
        let enough = (0..counts.len()).find(|&at| stated(&|trial| trial.adaptive[at].error) <= bar);
        let mut row = vec![TableCell::number(mismatch, 0), TableCell::number(ability, 0)];
        row.extend(cells(&|trial| trial.spread));
        match enough {
            Some(at) => {
                row.extend([TableCell::Count(counts[at] as u64), share(counts[at] as f64 / EPISODES as f64)]);
                row.extend(cells(&|trial| trial.adaptive[at]));
            }
            None => row.extend([TableCell::text("more than 200")]),
        }
        table.push(row);
    }
    table
}
