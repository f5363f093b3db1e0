//! What is new, kept, changed and gone.

use super::Compared;
use crate::released::ReleasedGame;
use engine::{Digest, Level};
use serde::Serialize;
use std::collections::BTreeMap;
use validators::novelty::canonical_types;

/// What became of a game or an item.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// There is none like it in the earlier release.
    New,
    /// It is in both, to the letter of its canonical text.
    Kept,
    /// It is in both, but for names, looks, order and, of a level, characters and the side that it is seen from.
    Changed,
    /// There is none like it in the later release.
    Gone,
}

/// What became of one of them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Change {
    /// What became of it.
    pub status: Status,
    /// Its place in the later release, or where it was if it is gone: `<game>` or `<game>/lvl<n>`.
    pub id: String,
    /// Where it was in the earlier one, if it is kept or changed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub was: Option<String>,
    /// Whether the rules are a generator's. Corpus games return with new levels; generated ones should not.
    pub generated: bool,
}

/// What became of all.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Changes {
    /// How many are new.
    pub new: usize,
    /// How many are kept.
    pub kept: usize,
    /// How many are changed.
    pub changed: usize,
    /// How many are gone.
    pub gone: usize,
    /// How many of the kept and changed have generated rules.
    pub returned_generated: usize,
    /// The later release's in its order, then those that are gone.
    pub each: Vec<Change>,
}

/// A game or an item: where it is, its text's digest, and the digest of what it is but for its dress.
struct Thing {
    id: String,
    exact: Digest,
    form: Digest,
    generated: bool,
}

impl Changes {
    /// Pairs the things of two releases: first those that are the same to the letter, then those that are the same otherwise,
    /// each with the first that is left.
    fn of(before: &[Thing], after: &[Thing]) -> Changes {
        let mut was: Vec<Option<(Status, usize)>> = vec![None; after.len()];
        let mut taken = vec![false; before.len()];
        for status in [Status::Kept, Status::Changed] {
            let key = |thing: &Thing| match status {
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

/// What became of the games.
pub(super) fn games(before: &[Compared<'_>], after: &[Compared<'_>]) -> Changes {
    let thing = |game: &Compared<'_>| Thing {
        id: game.released.card.id.clone(),
        exact: game.released.game.digest(),
        form: game.form.digest(),
        generated: game.is_generated(),
    };
    let [before, after] = [before, after].map(|side| side.iter().map(thing).collect::<Vec<_>>());
    Changes::of(&before, &after)
}

/// What became of the items.
pub(super) fn items(before: &[Compared<'_>], after: &[Compared<'_>]) -> Changes {
    let of_game = |game: &Compared<'_>| {
        let ReleasedGame { card, game: rules, levels, .. } = game.released;
        let pair =
            |rules: Digest, level: Digest| Digest::of([*rules.as_bytes(), *level.as_bytes()].as_flattened());
        let thing = |(number, form): (usize, &Digest)| Thing {
            id: format!("{}/lvl{number}", card.id),
            exact: pair(rules.digest(), levels[number].level.digest()),
            form: pair(game.form.digest(), *form),
            generated: game.is_generated(),
        };
        game.levels.iter().enumerate().map(thing).collect::<Vec<Thing>>()
    };
    let [before, after] = [before, after].map(|side| side.iter().flat_map(of_game).collect::<Vec<_>>());
    Changes::of(&before, &after)
}

/// By level of a game: a digest that levels share, in games with equal forms, that place the same types in the same cells when
/// seen from some side. (Types that can be exchanged for each other may hide that; nothing else can.) Cost: as for a
/// [`GameForm`](validators::GameForm), and O(cells).
pub(super) fn level_forms(released: &ReleasedGame) -> Vec<Digest> {
    let game = &released.game;
    let mut place = vec![None; game.sprite_types().count()];
    for (at, stype) in canonical_types(game).into_iter().enumerate() {
        place[stype.index()] = Some(at as u32);
    }
    // By character: what it places, in an order that does not depend on names.
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

/// The least of the eight images of a board.
fn level_form(level: &Level, placed: &[Vec<u32>]) -> Digest {
    let (columns, rows) = (level.columns(), level.rows());
    let image = |symmetry: usize| {
        let (wide, high) = if symmetry & 4 != 0 { (rows, columns) } else { (columns, rows) };
        let mut bytes: Vec<u8> = [wide as u32, high as u32].map(u32::to_le_bytes).as_flattened().to_vec();
        for (x, y) in (0..high).flat_map(|y| (0..wide).map(move |x| (x, y))) {
            let (x, y) = if symmetry & 4 != 0 { (y, x) } else { (x, y) };
            let x = if symmetry & 1 != 0 { columns - 1 - x } else { x };
            let y = if symmetry & 2 != 0 { rows - 1 - y } else { y };
            let here = &placed[usize::from(level.cells()[y * columns + x])];
            bytes.extend((here.len() as u32).to_le_bytes());
            bytes.extend(here.iter().flat_map(|at| at.to_le_bytes()));
        }
        bytes
    };
    Digest::of(&(0..8).map(image).min().expect("there are eight images"))
}
