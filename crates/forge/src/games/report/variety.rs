//! The kinds of games in a set.

use super::entry::Measured;
use crate::reported::counted;
use report::{Section, Share, Table, TableCell, Value};
use serde::Serialize;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};
use validators::measures::{AvatarKind, GoalKind};

/// The games with one kind of avatar and one kind of goal.
#[derive(Serialize)]
struct Pair {
    avatar: AvatarKind,
    goal: GoalKind,
    games: u64,
}

/// The number of games with a property.
#[derive(Serialize)]
struct Having {
    name: String,
    games: Share,
}

fn pairs(measured: &[Measured<'_>]) -> BTreeMap<(AvatarKind, GoalKind), u64> {
    let mut pairs = BTreeMap::new();
    for kind in measured.iter().map(|game| &game.kind) {
        *pairs.entry((kind.avatar, kind.goal)).or_default() += 1;
    }
    pairs
}

pub(super) fn variety(measured: &[Measured<'_>]) -> Section {
    let of = measured.len() as u64;
    let mut pairs: Vec<_> = pairs(measured).into_iter().collect();
    pairs.sort_by_key(|(_, games)| Reverse(*games));
    let largest = pairs.first().map(|(_, games)| Share::new(*games, of));
    let kinds: Vec<Pair> =
        pairs.iter().map(|&((avatar, goal), games)| Pair { avatar, goal, games }).collect();
    let mut section =
        Section::new("variety", "How varied are the games?", "Number of games with each feature.")
            .data("kinds", &kinds)
            .data("largest", &largest)
            .figure("kinds", "kinds of avatar × goal", Value::CountOf(kinds.len() as u64, of, "game"));
    if let Some(share) = largest {
        section = section.shown("games of the most frequent kind", share.into());
    }
    let kind = || measured.iter().map(|game| &game.kind);
    let effects = counted(kind().flat_map(|kind| &kind.effects).map(|family| family.name()));
    let npcs = counted(kind().flat_map(|kind| &kind.npcs).map(String::as_str));
    let producers = counted(kind().flat_map(|kind| &kind.producers).map(String::as_str));
    for (key, name, counts) in [
        ("effects", "families of effects", effects),
        ("npcs", "classes of sprites that move by themselves", npcs),
        ("producers", "classes of sprites that create other sprites", producers),
    ] {
        let having = counts.into_iter().map(|(name, count)| Having { name, games: Share::new(count, of) });
        let mut having: Vec<Having> = having.collect();
        having.sort_by_key(|having| Reverse(having.games.count));
        section = section.data(key, &having).shown(name, Value::Count(having.len() as u64));
        section = having.into_iter().fold(section, |section, having| {
            section.shown(format!("– {}", having.name), having.games.into())
        });
    }
    section
}

/// Returns a table of avatar kinds by goal kinds.
pub(super) fn kinds(measured: &[Measured<'_>]) -> Table {
    let pairs = pairs(measured);
    let avatars: BTreeSet<AvatarKind> = pairs.keys().map(|(avatar, _)| *avatar).collect();
    let goals: BTreeSet<GoalKind> = pairs.keys().map(|(_, goal)| *goal).collect();
    let columns: Vec<&str> = [""].into_iter().chain(goals.iter().map(|goal| goal.name())).collect();
    let note = "Number of games by the avatar's abilities and by the goal of a win.";
    let mut table = Table::new("kinds", "Kinds", note, &columns);
    for avatar in avatars {
        let games = |goal: &GoalKind| pairs.get(&(avatar, *goal)).copied().unwrap_or(0);
        let cells = [TableCell::text(avatar.name())].into_iter();
        table.push(cells.chain(goals.iter().map(|goal| TableCell::Count(games(goal)))).collect());
    }
    table
}
