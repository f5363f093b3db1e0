//! The one-sentence verdict on a comparison, and the order of the two releases.

use super::Diff;
use super::shifts::{DIFFICULTY, Shift};
use crate::format::manifest::Manifest;
use serde::Serialize;

/// The smallest p-value at which a difference is attributed to chance.
const CHANCE: f64 = 0.05;

/// The order of two releases, according to the parents and ancestors that they state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Order {
    /// The later release follows the earlier release.
    Follows,
    /// The releases are reversed: the one passed as the earlier release is the later one.
    Reversed,
    /// Neither release follows the other.
    Unrelated,
}

impl Order {
    /// Determines the order of two releases. `before` is the release passed as the earlier one.
    pub(super) fn of(before: &Manifest, after: &Manifest) -> Order {
        match (follows(after, before), follows(before, after)) {
            (true, _) => Order::Follows,
            (false, true) => Order::Reversed,
            (false, false) => Order::Unrelated,
        }
    }
}

/// Returns `true` if `later` states `earlier` as its parent or among its ancestors.
fn follows(later: &Manifest, earlier: &Manifest) -> bool {
    let listed = later.recipe.get("known").and_then(|known| known.get("releases")?.as_array());
    let is_listed = listed.is_some_and(|names| names.iter().any(|name| name.as_str() == Some(&earlier.name)));
    later.parent == Some(earlier.root) || is_listed
}

/// Summarises the comparison in one sentence.
pub(super) fn verdict(diff: &Diff) -> String {
    if diff.before.root == diff.after.root {
        return "Both releases have the same root, so they are the same release".to_owned();
    }
    let difficulty = diff.shifts.iter().find(|shift| shift.name == DIFFICULTY).map(difficulty);
    let returned = diff.items.kept + diff.items.changed;
    let levels = if returned == 1 { "1 level recurs".to_owned() } else { format!("{returned} levels recur") };
    let nearest = match &diff.neighbours.across {
        Some(across) => format!("distance of the nearest pair of games: {:.2}", across.min),
        None => "no pair of games".to_owned(),
    };
    [difficulty.unwrap_or_default(), levels, nearest].join("; ")
}

fn difficulty(shift: &Shift) -> String {
    let counted = |of: fn(&super::Share) -> usize| shift.shares.iter().map(of).sum::<usize>();
    let (before, after) = (counted(|share| share.before), counted(|share| share.after));
    let (distance, p) = match (before, after, shift.distance, shift.p) {
        (0, 0, ..) => return "Difficulty was not measured (no `skill`)".to_owned(),
        (0, ..) => {
            return "Difficulty was measured in the later release only (the earlier has no `skill`)"
                .to_owned();
        }
        (_, 0, ..) => {
            return "Difficulty was measured in the earlier release only (the later has no `skill`)"
                .to_owned();
        }
        (_, _, Some(distance), Some(p)) => (distance, p),
        _ => return "Difficulty cannot be compared".to_owned(),
    };
    let unmeasured = shift.unmeasured.before + shift.unmeasured.after;
    let partly = match unmeasured {
        0 => String::new(),
        _ => format!(", {unmeasured} levels not measured"),
    };
    let what = if p < CHANCE { "Difficulty differs" } else { "No difference in difficulty is apparent" };
    format!("{what} ({distance:.2} apart, p = {p:.3}{partly})")
}
