//! Variation of levels for searches: small edits and crossover.

use super::draft::{Draft, Faults, SymbolUse, Vocabulary};
use super::edits::{Edit, pick};
use crate::levels::config::LevelConfig;
use crate::levels::construct::constructive::ConstructiveLevels;
use crate::{GenerateError, Generator, Variation};
use base::{Sampler, Seed};
use engine::{Game, Level};

/// The number of attempts at an edit before a different kind of edit is tried.
const REDRAWS: usize = 24;
/// The number of mutations or crossovers to try before returning a candidate unchanged.
const ATTEMPTS: usize = 12;

/// Levels for any game, as search candidates. [`ConstructiveLevels`] generates the levels, which are then changed by
/// edits that are meaningful in the game. Edits move sprites, or add and remove them by role. They also extend,
/// shorten, open and shift lines of walls.
///
/// All results are levels with one avatar and with the parent's size and closed border. No termination holds at the
/// start. No problem is worse than in the parents: required sprites are present, and numbers and cover are as requested
/// and normal. No cell is cut off, no harmful sprite is next to the avatar, no gate is in the open, and no wall block
/// is isolated. Symmetric walls mostly stay symmetric. The variation does not test whether a level can be won.
///
/// Cost: tens of microseconds per mutation of a typical level.
pub struct LevelVariation<'a> {
    levels: ConstructiveLevels<'a>,
    vocabulary: Vocabulary,
}

impl<'a> LevelVariation<'a> {
    /// Creates a variation for a game. Costs as much as generating 16 constructive levels.
    ///
    /// # Errors
    /// Returns the errors of [`ConstructiveLevels::new`].
    pub fn new(game: &'a Game, config: LevelConfig) -> Result<LevelVariation<'a>, GenerateError> {
        let levels = ConstructiveLevels::new(game, config.clone())?;
        Ok(LevelVariation { vocabulary: Vocabulary::of(&levels, &config), levels })
    }

    /// Returns the constructive generator, which provides a search's initial levels.
    pub fn constructive(&self) -> &ConstructiveLevels<'a> {
        &self.levels
    }

    fn draft(&self, level: &Level) -> Draft<'_> {
        Draft::of(&self.levels, &self.vocabulary, level)
    }

    /// Returns a draft with one more edit; `None` if all attempts at edits of one kind cause problems or change
    /// nothing.
    fn edited<'v>(&self, draft: &Draft<'v>, allowed: &Faults, sampler: &mut Sampler) -> Option<Draft<'v>> {
        let edit = Edit::draw(sampler);
        (0..REDRAWS).find_map(|_| {
            let mut next = draft.clone();
            next.edit(edit, sampler)?;
            (next.cells != draft.cells && next.faults().no_worse_than(allowed)).then_some(next)
        })
    }

    /// Applies one to three edits.
    fn mutated(&self, parent: &Draft<'_>, allowed: &Faults, sampler: &mut Sampler) -> Option<Level> {
        let edits = 1 + sampler.weighted(&[5, 3, 2]).unwrap_or(0);
        let mut draft = parent.clone();
        for _ in 0..edits {
            let next = (0..ATTEMPTS).find_map(|_| self.edited(&draft, allowed, sampler))?;
            draft = next;
        }
        if draft.cells == parent.cells { None } else { draft.level() }
    }

    /// Places a part of the second level into the first, and repairs the result.
    fn crossed(&self, one: &Draft<'_>, two: &Draft<'_>, sampler: &mut Sampler) -> Option<Level> {
        let mut child = one.clone();
        let columns = one.grid.columns.min(two.grid.columns);
        let rows = one.grid.rows.min(two.grid.rows);
        let (left, right) = stretch(columns, sampler);
        let (top, bottom) = if (left, right) != (0, columns) && sampler.ratio(1, 2) {
            (0, rows)
        } else {
            stretch(rows, sampler)
        };
        for y in top..bottom {
            for x in left..right {
                let (to, from) = (one.grid.at(x, y), two.grid.at(x, y));
                if one.is_editable(to) && two.is_editable(from) {
                    child.cells[to] = two.cells[from];
                }
            }
        }
        let avatars = child.cells_where(|draft, cell| draft.kind(cell) == SymbolUse::Avatar);
        match pick(&avatars, sampler) {
            Some(kept) => {
                avatars.into_iter().filter(|&cell| cell != kept).for_each(|cell| child.clear(cell));
            }
            None => {
                let avatar = one.avatar()?;
                let free = child.cells_where(Draft::is_ground);
                let near = free.into_iter().min_by_key(|&cell| one.grid.manhattan(cell, avatar))?;
                child.cells[near] = one.cells[avatar];
            }
        }
        child.open_ways();
        child.recount(sampler);
        let allowed = one.faults().or(&two.faults());
        let new = child.cells != one.cells && child.cells != two.cells;
        if new && child.faults().no_worse_than(&allowed) { child.level() } else { None }
    }
}

impl Variation for LevelVariation<'_> {
    type Candidate = Level;

    fn create(&self, seed: Seed) -> Option<Level> {
        self.levels.generate(seed).ok()
    }

    /// Applies one to three edits. Returns the parent itself if many attempts fail to yield a level.
    fn mutate(&self, parent: &Level, sampler: &mut Sampler) -> Level {
        let draft = self.draft(parent);
        let allowed = draft.faults();
        let mutated = (0..ATTEMPTS).find_map(|_| self.mutated(&draft, &allowed, sampler));
        mutated.unwrap_or_else(|| parent.clone())
    }

    /// Copies a half or a rectangle from the second level into the first, as far as the two levels overlap. Mutates the
    /// first level if several attempts fail to yield a level.
    fn cross(&self, one: &Level, two: &Level, sampler: &mut Sampler) -> Level {
        let (first, second) = (self.draft(one), self.draft(two));
        let crossed = (0..ATTEMPTS).find_map(|_| self.crossed(&first, &second, sampler));
        crossed.unwrap_or_else(|| self.mutate(one, sampler))
    }
}

/// Draws a section of a side: a half, the whole side, or a third to two thirds of it at any position. Returns the start
/// and the end.
fn stretch(length: usize, sampler: &mut Sampler) -> (usize, usize) {
    match sampler.below(4) {
        0 => (0, length / 2),
        1 => (length / 2, length),
        2 => (0, length),
        _ => {
            let size = sampler.between((length / 3).max(1), (length * 2 / 3).max(1));
            let from = sampler.below(length - size + 1);
            (from, from + size)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use std::fs;
    use std::path::Path;

    fn seed(name: &str) -> Seed {
        Seed::from_text("variation").child(name, 0)
    }

    /// Returns the border cells; `None` unless all border cells are walls.
    fn border(variation: &LevelVariation<'_>, level: &Level) -> Option<Vec<u8>> {
        let draft = variation.draft(level);
        let border: Vec<usize> = (0..draft.grid.len()).filter(|&cell| draft.grid.on_border(cell)).collect();
        let closed = border.iter().all(|&cell| draft.is_wall(cell));
        closed.then(|| border.into_iter().map(|cell| draft.cells[cell]).collect())
    }

    fn check(name: &str, game: &Game, parents: &[&Level], child: &Level, variation: &LevelVariation<'_>) {
        let text = child.to_string();
        assert_eq!(game.level(&text).as_ref(), Ok(child), "{name}\n{text}");
        let one = parents[0];
        assert_eq!((child.columns(), child.rows()), (one.columns(), one.rows()), "{name}");
        assert!(game.start(child, seed(name)).avatar_id().is_some(), "{name}\n{text}");
        if let Some(border_of_parent) = border(variation, one) {
            assert_eq!(border(variation, child), Some(border_of_parent), "{name}\n{text}");
        }
        let allowed = parents.iter().map(|parent| variation.draft(parent).faults());
        let allowed = allowed.reduce(|one, two| one.or(&two)).unwrap_or_default();
        let faults = variation.draft(child).faults();
        assert!(faults.no_worse_than(&allowed), "{name}: {faults:?}\n{text}");
    }

    #[test]
    fn varied_levels_are_levels() {
        let corpora = fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../corpora")).unwrap();
        for folder in corpora.map(|entry| entry.unwrap().path()) {
            let Ok(source) = fs::read_to_string(folder.join("game.vgdl")) else { continue };
            let game = Game::from_source(&source).unwrap();
            let name = folder.file_name().unwrap().to_string_lossy().into_owned();
            let variation = LevelVariation::new(&game, LevelConfig::default()).unwrap();
            let mut sampler = seed(&name).sampler();
            let create = |index: u64| variation.create(seed(&name).child("level", index)).unwrap();
            let (mut level, other) = (create(0), create(1));
            let (mut changed, mut different) = (0, BTreeSet::new());
            for turn in 0..500 {
                let crossing = turn % 5 == 4;
                let child = if crossing {
                    variation.cross(&level, &other, &mut sampler)
                } else {
                    variation.mutate(&level, &mut sampler)
                };
                let parents = if crossing { vec![&level, &other] } else { vec![&level] };
                check(&name, &game, &parents, &child, &variation);
                changed += u32::from(child != level);
                different.insert(child.to_string());
                level = if turn % 50 == 49 { create(turn) } else { child };
            }
            assert!(changed >= 490, "{name}: {changed} of 500 changed something");
            assert!(different.len() >= 450, "{name}: {} different levels", different.len());
        }
    }
}
