//! Describes the visible effects of an action, without stating any rules.

use super::scene::{Scene, places};
use crate::direction::direction_name;
use crate::legend::Legend;
use engine::{Action, AvatarView, Observation};
use itertools::Itertools;
use std::collections::{BTreeMap, BTreeSet};

/// The maximum number of newly occupied cells, and of vacated cells, listed per type.
const MAX_CELLS: usize = 4;

/// Describes the effects of an action by comparing the observations before and after it. The lines describe
/// what happened to the avatar, what it met and what it holds. They also list the types that have moved, or
/// that occupy more or fewer cells than before. The score is not included. Cost: O(cells log cells).
pub fn events(before: &Observation, now: &Observation, action: Action, legend: &Legend) -> Vec<String> {
    let (old, new) = (Scene::of(before, legend), Scene::of(now, legend));
    let mut lines =
        vec![format!("{action} was played. {}", moved(before.avatar.as_ref(), now.avatar.as_ref()))];
    let met = met(&old, &new, before, now, action, legend);
    if !met.is_empty() {
        lines.push(format!("You met {}.", met.iter().join(", ")));
    }
    let (mut still, mut changed) = (BTreeSet::new(), Vec::new());
    let (cells_before, cells_now) = (by_kind(&old, legend), by_kind(&new, legend));
    let none = BTreeSet::new();
    for kind in cells_before.keys().chain(cells_now.keys()).copied().collect::<BTreeSet<&str>>() {
        let [was, is] = [&cells_before, &cells_now].map(|cells| cells.get(kind).unwrap_or(&none));
        let (gone, come): (Vec<_>, Vec<_>) =
            (was.difference(is).copied().collect(), is.difference(was).copied().collect());
        if was.len() == is.len() {
            if !gone.is_empty() {
                still.insert(kind);
            }
            continue;
        }
        let cells = |cells: &[(usize, usize)]| match cells.len() {
            0..=MAX_CELLS => places(cells),
            more => format!("{} and {} more", places(&cells[..MAX_CELLS]), more - MAX_CELLS),
        };
        let gone = (!gone.is_empty()).then(|| format!("; gone from {}", cells(&by_row(gone))));
        let come = (!come.is_empty()).then(|| format!("; new in {}", cells(&by_row(come))));
        changed.push(format!(
            "{kind}: {} cell{} before, {} now{}{}.",
            was.len(),
            if was.len() == 1 { "" } else { "s" },
            is.len(),
            gone.unwrap_or_default(),
            come.unwrap_or_default()
        ));
    }
    lines.extend(changed);
    if !still.is_empty() {
        lines.push(format!("Moved: {}.", still.iter().join(", ")));
    }
    let held = |seen: &Observation| -> BTreeMap<String, i32> { seen.resources.iter().cloned().collect() };
    let (had, has) = (held(before), held(now));
    for kind in had.keys().chain(has.keys()).collect::<BTreeSet<_>>() {
        let [had, has] = [&had, &has].map(|held| held.get(kind).copied().unwrap_or_default());
        if had != has && now.avatar.is_some() {
            lines.push(format!("You hold {has} {kind}, {had} before."));
        }
    }
    if let (Some(was), Some(is)) = (&before.avatar, &now.avatar)
        && was.health != is.health
    {
        lines.push(format!("Your health is {}, {} before.", is.health, was.health));
    }
    lines
}

/// Describes what happened to the avatar.
fn moved(before: Option<&AvatarView>, now: Option<&AvatarView>) -> String {
    let (Some(before), Some(now)) = (before, now) else {
        return if now.is_none() { "You are gone." } else { "You are back." }.to_owned();
    };
    let from = |avatar: &AvatarView| format!("({},{})", avatar.column, avatar.row);
    let mut told = match (before.column, before.row) == (now.column, now.row) {
        true => "You did not move.".to_owned(),
        false => format!("You moved here from {}.", from(before)),
    };
    if let Some(way) = direction_name(now.facing).filter(|_| before.facing != now.facing) {
        told += &format!(" You turned to face {way}.");
    }
    if before.name != now.name {
        told += &format!(" You became {}.", now.name);
    }
    told
}

/// Returns the types that the avatar met: the types in its cell and, if it neither moved nor turned, those in
/// the adjacent cell in the direction of the action. If the avatar is gone, its last cell counts.
fn met(
    old: &Scene<'_>,
    new: &Scene<'_>,
    before: &Observation,
    now: &Observation,
    action: Action,
    legend: &Legend,
) -> BTreeSet<String> {
    let is_other = |name: &&str| !is_avatar(legend, name);
    let at = |scene: &Scene<'_>, (column, row): (usize, usize)| -> Vec<String> {
        scene.at(column, row).iter().filter(|name| is_other(name)).map(|name| (*name).to_owned()).collect()
    };
    let mut met = BTreeSet::new();
    if let Some(cell) = new.avatar {
        met.extend(at(new, cell));
    }
    let facing = |seen: &Observation| seen.avatar.as_ref().map(|avatar| avatar.facing);
    let is_turned = now.avatar.is_some() && facing(before) != facing(now);
    if let Some(from) = old.avatar.filter(|from| new.avatar.is_none_or(|to| to == *from) && !is_turned) {
        if let Some(ahead) = ahead(old, from, action) {
            met.extend(at(old, ahead));
        }
        if new.avatar.is_none() {
            met.extend(at(old, from));
            met.extend(at(new, from));
            met.extend(ahead(new, from, action).map(|cell| at(new, cell)).unwrap_or_default());
        }
    }
    met
}

/// Returns the adjacent cell in the action's direction, if that cell is on the board.
fn ahead(scene: &Scene<'_>, (column, row): (usize, usize), action: Action) -> Option<(usize, usize)> {
    let (right, down) = match action {
        Action::Up => (0, -1),
        Action::Left => (-1, 0),
        Action::Down => (0, 1),
        Action::Right => (1, 0),
        Action::Nil | Action::Use => return None,
    };
    let column = column.checked_add_signed(right).filter(|&column| column < scene.columns)?;
    let row = row.checked_add_signed(down).filter(|&row| row < scene.rows)?;
    Some((column, row))
}

/// Returns the cells occupied by each type, except avatars.
fn by_kind<'a>(scene: &Scene<'a>, legend: &Legend) -> BTreeMap<&'a str, BTreeSet<(usize, usize)>> {
    let mut cells: BTreeMap<&str, BTreeSet<(usize, usize)>> = BTreeMap::new();
    for (at, names) in scene.cells.iter().enumerate() {
        for name in names.iter().filter(|name| !is_avatar(legend, name)) {
            cells.entry(name).or_default().insert((at % scene.columns, at / scene.columns));
        }
    }
    cells
}

fn by_row(mut cells: Vec<(usize, usize)>) -> Vec<(usize, usize)> {
    cells.sort_by_key(|&(column, row)| (row, column));
    cells
}

fn is_avatar(legend: &Legend, name: &str) -> bool {
    legend.entry(name).is_some_and(|entry| entry.role == crate::legend::EntryRole::Avatar)
}

/// Adds rulers to a board's edges. Above each column is the last digit of its number, and before each row is
/// its number.
pub fn ruled(grid: &str) -> String {
    let columns = grid.lines().next().map_or(0, |row| row.chars().count());
    let width = grid.lines().count().saturating_sub(1).to_string().len();
    let digits: String = (0..columns).map(|column| char::from(b'0' + (column % 10) as u8)).collect();
    let rows = grid.lines().enumerate().map(|(number, row)| format!("{number:width$} {row}"));
    std::iter::once(format!("{:width$} {digits}", "")).chain(rows).join("\n")
}
