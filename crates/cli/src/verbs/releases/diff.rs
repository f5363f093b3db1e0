//! `arcade diff`: compares two snapshots.

use crate::console::Console;
use crate::failure::Answer;
use crate::input::trusted::{TrustArgs, refuse};
use crate::shell;
use crate::verbs::releases::export::unsound;
use crate::verbs::releases::verify::remark_unreplayed;
use base::count;
use report::Quantiles;
use snapshots::diff::{
    Change, Changes, Diff, Neighbours, NumberShift, Order, Share, Shift, Side, Status, Unmeasured,
};
use snapshots::marks::MarkDifference;
use snapshots::released::Released;
use snapshots::rungs::RungDifference;
use std::ffi::OsStr;
use std::path::PathBuf;

/// Compares two snapshots, the earlier first: new, kept, changed and removed items; differences in difficulty, kinds, mechanics
/// and win rates; and the distance between the games.
///
/// The first line is the verdict: whether difficulty was measured and differs, how many levels return, and how near the
/// nearest two games are. With --quiet, it is the only line.
///
/// Every figure is explained in `arcade docs diff`. --json prints all figures, item by item.
///
/// Exit status 0: compared. 1: one of the two does not verify. 2: one is not a snapshot.
///
/// Example: arcade diff releases/2026-11 releases/2026-12
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The earlier snapshot's folder or .tar.zst
    #[arg(value_name = "BEFORE", value_parser = crate::paths::release_parser())]
    before: PathBuf,
    /// The later snapshot's folder or .tar.zst
    #[arg(value_name = "AFTER", value_parser = crate::paths::release_parser())]
    after: PathBuf,
    /// Number of pairs of games to list, the most similar first
    #[arg(long, value_name = "N", default_value_t = 5)]
    closest: usize,
    #[command(flatten)]
    trust: TrustArgs,
}

/// The maximum number of a distribution's values to list. The most frequent values are listed first.
const MAX_LISTED: usize = 12;
/// The maximum number of kept and changed items to list.
const MAX_RETURNED: usize = 20;

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let mut sides = Vec::new();
    for path in [&args.before, &args.after] {
        match Released::read(path) {
            Ok(released) => {
                let signed = args.trust.judge(path, &released.manifest.name, &released.manifest.root)?;
                if let Some(signed) = signed.filter(|signed| !signed.problems.is_empty()) {
                    return refuse(&signed.problems, console);
                }
                remark_unreplayed(&released.manifest, console);
                sides.push(released);
            }
            Err(error) => return unsound(error, console),
        }
    }
    let diff = Diff::of(&sides[0], &sides[1], args.closest);
    console.document(&diff)?;
    console.say(&diff.verdict);
    if diff.order == Order::Reversed {
        let swapped = [OsStr::new("diff"), args.after.as_os_str(), args.before.as_os_str()];
        console.say(format_args!(
            "the order is reversed: `{}` follows `{}`, so pass the earlier one first: {}",
            diff.before.name,
            diff.after.name,
            shell::command(swapped)
        ));
    }
    if !console.is_quiet() {
        say(&diff, console);
    }
    Ok(true)
}

fn say(diff: &Diff, console: &Console) {
    let Diff { before, after, games, items, shifts, numbers, rungs, marks, neighbours, .. } = diff;
    console.say("");
    console.say(side("before", before));
    console.say(side("after ", after));
    if before.semantics != after.semantics {
        console.say(
            "the two releases were minted under different semantics, so measurements of play are not \
             comparable",
        );
    }
    console.say(format_args!("\ngames  {}", counts(games)));
    console.say(format_args!("items  {}", counts(items)));
    for (what, changes) in [("generated games", games), ("generated items", items)] {
        if changes.returned_generated > 0 {
            console.say(format_args!("{what} that recur: {}", changes.returned_generated));
        }
    }
    let returned: Vec<&Change> =
        items.each.iter().filter(|one| matches!(one.status, Status::Kept | Status::Changed)).collect();
    for change in returned.iter().take(MAX_RETURNED) {
        let was = change.was.as_deref().unwrap_or_default();
        let how = if change.status == Status::Kept { "" } else { " with a different theme" };
        console.say(format_args!("  {} is {was}{how}", change.id));
    }
    if returned.len() > MAX_RETURNED {
        console.say(format_args!("  and {} more; --json lists all", returned.len() - MAX_RETURNED));
    }
    shifts.iter().for_each(|found| shift(found, console));
    console.say("");
    numbers.iter().for_each(|found| number(found, console));
    ladder(rungs, console);
    marked(marks, console);
    near(neighbours, console);
}

fn side(what: &str, side: &Side) -> String {
    let Side { name, games, generated, levels, .. } = side;
    let (games, levels) = (count(*games, "game"), count(*levels, "level"));
    format!("{what} {name}: {games}, {generated} of them generated, {levels}; root {}", side.root.short())
}

fn counts(changes: &Changes) -> String {
    let Changes { new, kept, changed, gone, .. } = changes;
    format!("{new} new, {kept} kept, {changed} kept with a different theme, {gone} removed")
}

/// Describes a distance, and states whether it may be due to chance. If a side has no values, there is no
/// distance to describe.
fn verdict(distance: Option<f64>, p: Option<f64>, unmeasured: Unmeasured) -> String {
    let partly = match unmeasured {
        Unmeasured { before: 0, after: 0 } => String::new(),
        Unmeasured { before, after } => format!("; levels not measured: {before} → {after}"),
    };
    match (distance, p) {
        (Some(distance), Some(p)) if p < 0.05 => {
            format!("distance {distance:.2}, statistically significant (p = {p:.3}){partly}")
        }
        (Some(distance), Some(p)) => format!("distance {distance:.2}, not significant (p = {p:.3}){partly}"),
        _ if !unmeasured.is_none() => format!("not compared{partly}"),
        _ => "nothing to compare".to_owned(),
    }
}

fn shift(shift: &Shift, console: &Console) {
    console.say(format_args!("\n{}: {}", shift.name, verdict(shift.distance, shift.p, shift.unmeasured)));
    let mut shares: Vec<_> = shift.shares.iter().collect();
    shares.sort_by_key(|share| std::cmp::Reverse(share.before + share.after));
    let total = |of: fn(&Share) -> usize| shift.shares.iter().map(of).sum::<usize>().max(1) as f64;
    let (before, after) = (total(|share| share.before), total(|share| share.after));
    for Share { value, before: was, after: is } in shares.iter().take(MAX_LISTED) {
        let (old, new) = (100.0 * *was as f64 / before, 100.0 * *is as f64 / after);
        console.say(format_args!("  {value:<32} {was:>4} {old:>3.0}%  → {is:>4} {new:>3.0}%"));
    }
    if shares.len() > MAX_LISTED {
        console.say(format_args!("  and {} more; --json lists all", shares.len() - MAX_LISTED));
    }
}

fn number(shift: &NumberShift, console: &Console) {
    let told = |quantiles: &Option<Quantiles>| match quantiles {
        Some(Quantiles { lower, median, upper, .. }) => {
            format!("{} ({} to {})", rounded(*median), rounded(*lower), rounded(*upper))
        }
        None => "–".to_owned(),
    };
    if shift.before.is_none() && shift.after.is_none() {
        return console.say(format_args!(
            "{}: {}",
            shift.name,
            verdict(shift.distance, shift.p, shift.unmeasured)
        ));
    }
    let (before, after) = (told(&shift.before), told(&shift.after));
    console.say(format_args!(
        "{}: {before} → {after}; {}",
        shift.name,
        verdict(shift.distance, shift.p, shift.unmeasured)
    ));
}

/// Rounds a figure to three significant digits, but keeps all digits before the decimal point and omits
/// trailing zeros.
fn rounded(figure: f64) -> String {
    let decimals = match figure.abs() {
        size if size >= 100.0 => 1,
        size if size >= 10.0 => 2,
        _ => 3,
    };
    let text = format!("{figure:.decimals$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn ladder(rungs: &[RungDifference], console: &Console) {
    if rungs.is_empty() {
        console.say("\nwin rates: no reference player played both releases");
        return;
    }
    console
        .say("\nwin rates in percent, all levels weighted equally, with 95% intervals, clustered by game:");
    for rung in rungs {
        let points = |share: f64| 100.0 * share;
        let [low, high] = rung.interval.map(points);
        let detectable = rung.detectable.map_or("–".to_owned(), |apart| format!("{:.1}", points(apart)));
        console.say(format_args!(
            "  {:<14} {:>5.1} → {:>5.1}   difference {:+.1} ({low:+.1} to {high:+.1}){}; detectable at these sizes: {detectable}",
            rung.ours.player,
            points(rung.theirs.mean),
            points(rung.ours.mean),
            points(rung.difference),
            if rung.includes_zero() { "" } else { ", not 0" },
        ));
    }
}

/// Lists the differences in the results of reference players by tier (difficulty class), with the overall differences
/// last.
fn marked(marks: &[MarkDifference], console: &Console) {
    if marks.is_empty() {
        return;
    }
    console.say("\nmarks, in percent, all levels weighted equally, with 95% intervals, clustered by game:");
    for mark in marks {
        let points = |share: f64| 100.0 * share;
        let [low, high] = mark.interval.map(points);
        let tier = mark.tier.map_or("all levels".to_owned(), |tier| format!("tier {tier}"));
        console.say(format_args!(
            "  {tier:<10} {:<16} {:>3} actions  {:>5.1} → {:>5.1}   difference {:+.1} ({low:+.1} to {high:+.1})",
            mark.player,
            mark.commit.name(),
            points(mark.theirs.mean),
            points(mark.ours.mean),
            points(mark.difference),
        ));
    }
}

fn near(neighbours: &Neighbours, console: &Console) {
    console.say(
        "\ndistance from each later game's rules to the nearest earlier game's (0 = identical, 1 = nothing \
         in common):",
    );
    let Neighbours { across, across_generated, within, closest, near, near_generated } = neighbours;
    for (what, quantiles) in
        [("across", across), ("across, generated", across_generated), ("within the later", within)]
    {
        if let Some(Quantiles { min, lower, median, upper, max, .. }) = quantiles {
            console.say(format_args!(
                "  {what:<18} min {min:.2}, lower quartile {lower:.2}, median {median:.2}, upper quartile \
                 {upper:.2}, max {max:.2}"
            ));
        }
    }
    let limit = validators::novelty::NEAR;
    console.say(format_args!(
        "  closer than {limit:.1}: {near}, of which {near_generated} between generated games"
    ));
    for pair in closest {
        console.say(format_args!("  {:.2}  {}  {}", pair.distance, pair.after, pair.before));
    }
}

#[cfg(test)]
mod tests {
    use super::rounded;

    #[test]
    fn figures_have_significant_digits_only() {
        for (figure, expect) in [
            (113.5, "113.5"),
            (1234.0, "1234"),
            (100.0, "100"),
            (12.25, "12.25"),
            (1.0 / 3.0, "0.333"),
            (0.25, "0.25"),
            (0.0, "0"),
            (-0.0001, "0"),
            (-2.5, "-2.5"),
        ] {
            assert_eq!(rounded(figure), expect);
        }
    }
}
