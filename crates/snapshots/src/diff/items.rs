//! New, kept, changed and removed games and items.

use super::Compared;
use crate::released::ReleasedGame;
use base::Digest;
use engine::Level;
use itertools::Itertools;
use serde::Serialize;
use std::collections::BTreeMap;
use validators::novelty::canonical_types;

/// The status of a game or an item.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// The earlier release has no equal game or item.
    New,
    /// The game or item is in both releases, with the same canonical text.
    Kept,
    /// The game or item is in both releases, but differs in names, appearance or order (or, for a level, in
    /// characters or orientation).
    Changed,
    /// The later release has no equal game or item.
    Gone,
}

/// The change in one game or item.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Change {
    /// The status of the game or item.
    pub status: Status,
    /// The path in the later release, `<game>` or `<game>/lvl<n>`; for the status [`Gone`](Status::Gone), the
    /// path in the earlier release.
    pub id: String,
    /// The path in the earlier release, if the game or item is kept or changed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub was: Option<String>,
    /// `true` if the rules were generated. Corpus games are expected to return with new levels, but generated games
    /// are not.
    pub generated: bool,
}

/// The changes in all games or items.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Changes {
    /// The number of new entries.
    pub new: usize,
    /// The number of kept entries.
    pub kept: usize,
    /// The number of changed entries.
    pub changed: usize,
    /// The number of removed entries.
    pub gone: usize,
    /// The number of kept and changed entries with generated rules.
    pub returned_generated: usize,
    /// The changes in the order of the later release, followed by the removed entries.
    pub each: Vec<Change>,
}

/// A game or an item: its path, the digest of its text, and a digest that ignores the theme.
struct Entry {
    id: String,
    exact: Digest,
    form: Digest,
    generated: bool,
}

impl Changes {
    /// Pairs the entries of two releases. Entries with equal texts are paired first, and then entries that are equal
    /// apart from the theme. Each entry is paired with its first unpaired candidate.
    fn of(before: &[Entry], after: &[Entry]) -> Changes {
        let mut was: Vec<Option<(Status, usize)>> = vec![None; after.len()];
        let mut taken = vec![false; before.len()];
        for status in [Status::Kept, Status::Changed] {
            let key = |thing: &Entry| match status {
                Status::Kept => (thing.form, thing.exact),
                _ => (thing.form, thing.form),
            };
            let mut left: BTreeMap<(Digest, Digest), Vec<usize>> = BTreeMap::new();
            for (at, thing) in before.iter().enumerate().rev().filter(|(at, _)| !taken[*at]) {
                left.entry(key(thing)).or_default().push(at);
            }
            for (at, thing) in after.iter().enumerate() {
                if was[at].is_none()
                    && let Some(found) = left.get_mut(&key(thing)).and_then(Vec::pop)
                {
                    taken[found] = true;
                    was[at] = Some((status, found));
                }
            }
        }
        let mut changes = Changes::default();
        for (thing, was) in after.iter().zip(was) {
            let status = was.map_or(Status::New, |(status, _)| status);
            let was = was.map(|(_, at)| before[at].id.clone());
            changes.note(Change { status, id: thing.id.clone(), was, generated: thing.generated });
        }
        for (thing, _) in before.iter().zip(taken).filter(|(_, taken)| !taken) {
            let generated = thing.generated;
            changes.note(Change { status: Status::Gone, id: thing.id.clone(), was: None, generated });
        }
        changes
    }

    fn note(&mut self, change: Change) {
        let count = match change.status {
            Status::New => &mut self.new,
            Status::Kept => &mut self.kept,
            Status::Changed => &mut self.changed,
            Status::Gone => &mut self.gone,
        };
        *count += 1;
        let returned = matches!(change.status, Status::Kept | Status::Changed);
        self.returned_generated += usize::from(returned && change.generated);
        self.each.push(change);
    }
}

pub(super) fn games(before: &[Compared<'_>], after: &[Compared<'_>]) -> Changes {
    let thing = |game: &Compared<'_>| Entry {
        id: game.released.card.id.clone(),
        exact: game.released.game.digest(),
        form: game.form.digest(),
        generated: game.is_generated(),
    };
    let [before, after] = [before, after].map(|side| side.iter().map(thing).collect::<Vec<_>>());
    Changes::of(&before, &after)
}

pub(super) fn items(before: &[Compared<'_>], after: &[Compared<'_>]) -> Changes {
    let of_game = |game: &Compared<'_>| {
        let ReleasedGame { card, game: rules, levels, .. } = game.released;
        let pair =
            |rules: Digest, level: Digest| Digest::of([*rules.as_bytes(), *level.as_bytes()].as_flattened());
        let thing = |(number, form): (usize, &Digest)| Entry {
            id: format!("{}/lvl{number}", card.id),
            exact: pair(rules.digest(), levels[number].level.digest()),
            form: pair(game.form.digest(), *form),
            generated: game.is_generated(),
        };
        game.levels.iter().enumerate().map(thing).collect::<Vec<Entry>>()
    };
    let [before, after] = [before, after].map(|side| side.iter().flat_map(of_game).collect::<Vec<_>>());
    Changes::of(&before, &after)
}

/// Returns a digest for each level of a game. Levels of games with equal forms have the same digest if they place the
/// same types in the same cells, up to a symmetry of the board. Equal levels can have different digests only if types
/// are interchangeable.
///
/// Cost: one [`GameForm`](validators::GameForm), plus O(cells).
pub(super) fn level_forms(released: &ReleasedGame) -> Vec<Digest> {
    let game = &released.game;
    let mut place = vec![None; game.sprite_types().count()];
    for (at, stype) in canonical_types(game).into_iter().enumerate() {
        place[stype.index()] = Some(at as u32);
    }
    // The positions of the types that each character places, in an order that does not depend on names.
    let placed: Vec<Vec<u32>> = (0..=u8::MAX)
        .map(|symbol| {
            let mut places: Vec<u32> =
                game.places(symbol).iter().filter_map(|stype| place[stype.index()]).collect();
            places.sort_unstable();
            places
        })
        .collect();
    released.levels.iter().map(|level| level_form(&level.level, &placed)).collect()
}

/// Returns the digest of the smallest of a board's eight symmetric images.
fn level_form(level: &Level, placed: &[Vec<u32>]) -> Digest {
    let (columns, rows) = (level.columns(), level.rows());
    let image = |symmetry: usize| {
        let (wide, high) = if symmetry & 4 != 0 { (rows, columns) } else { (columns, rows) };
        let mut bytes: Vec<u8> = [wide as u32, high as u32].map(u32::to_le_bytes).as_flattened().to_vec();
        for (y, x) in (0..high).cartesian_product(0..wide) {
            let (x, y) = if symmetry & 4 != 0 { (y, x) } else { (x, y) };
            let x = if symmetry & 1 != 0 { columns - 1 - x } else { x };
            let y = if symmetry & 2 != 0 { rows - 1 - y } else { y };
            let here = &placed[usize::from(level.cells()[y * columns + x])];
            bytes.extend((here.len() as u32).to_le_bytes());
            bytes.extend(here.iter().flat_map(|at| at.to_le_bytes()));
        }
        bytes
    };
    Digest::of(&(0..8).map(image).min().expect("a board has eight images"))
}
