//! Boards as candidates of a search.

use super::brief::BoardBrief;
use super::draft::Draft;
use super::edits::Edit;
use super::furnish::compose;
use super::kit::Kit;
use crate::{GenerateError, Variation};
use base::{Sampler, Seed};
use engine::{Analysis, Level};

/// Compositions to try for one board.
const COMPOSITIONS: u64 = 40;
/// Draws of an edit before the board stays as it is.
const DRAWS: usize = 40;
/// Fragments that a board may have in any case; see [`Draft::fragments`].
const FRAGMENTS: usize = 2;

/// Boards of any game as candidates of a search: composed of plans and idioms, changed by edits.
///
/// All boards have one hero, connected ground that is mostly wide, the numbers that the brief asks for, and nothing harmful
/// beside the hero. Nothing is played here. Cost: about a millisecond for a board, some tens of microseconds for an edit.
#[derive(Clone, Debug)]
pub struct BoardVariation<'a> {
    kit: Kit<'a>,
}

impl<'a> BoardVariation<'a> {
    /// Creates a variation for a game and a brief.
    ///
    /// # Errors
    /// If no character of the game places exactly one avatar.
    pub fn new(analysis: &'a Analysis, brief: &BoardBrief) -> Result<BoardVariation<'a>, GenerateError> {
        let kit = Kit::of(analysis, brief);
        let kit = kit
            .ok_or_else(|| GenerateError::Unsuitable("no character places exactly one avatar".to_owned()))?;
        Ok(BoardVariation { kit })
    }

    /// The boards that lack one small thing which this one has, for a search that looks for what is not missed.
    pub fn tidied(&self, level: &Level) -> Vec<Level> {
        Draft::of(&self.kit, level).tidied().iter().filter_map(Draft::level).collect()
    }

    /// Returns a sound board with one to three edits more, or the same board.
    fn edited<'k>(&'k self, draft: Draft<'k>, sampler: &mut Sampler) -> Draft<'k> {
        let mut edits = 1 + sampler.weighted(&[5, 3, 2]).unwrap_or(0);
        let mut draft = draft;
        let fragments = draft.fragments().max(FRAGMENTS);
        for _ in 0..DRAWS {
            let mut next = draft.clone();
            let edit = Edit::draw(sampler);
            let is_made = next.edit(edit, sampler).is_some();
            if is_made && next.cells != draft.cells && next.fragments() <= fragments && next.is_sound() {
                draft = next;
                edits -= 1;
            }
            if edits == 0 {
                break;
            }
        }
        draft
    }
}

impl Variation for BoardVariation<'_> {
    type Candidate = Level;

    fn create(&self, seed: Seed) -> Option<Level> {
        let analysis = self.kit.analysis;
        (0..COMPOSITIONS).find_map(|at| {
            let level = compose(&self.kit, seed.child("composition", at))?.level()?;
            let start = analysis.game().start(&level, seed);
            let begins = analysis.goal_met(&start).is_none() && analysis.reach(&level).can_win();
            begins.then_some(level)
        })
    }

    fn mutate(&self, parent: &Level, sampler: &mut Sampler) -> Level {
        let draft = self.edited(Draft::of(&self.kit, parent), sampler);
        draft.level().unwrap_or_else(|| parent.clone())
    }

    /// Returns the first board with a part of the second, if they have one size and that is sound; else an edit of the first.
    fn cross(&self, one: &Level, two: &Level, sampler: &mut Sampler) -> Level {
        let (mut child, other) = (Draft::of(&self.kit, one), Draft::of(&self.kit, two));
        let cut = sampler.between(3, child.grid.columns.max(7) - 4);
        if child.grid == other.grid {
            for cell in (0..child.grid.len()).filter(|&cell| child.grid.x(cell) >= cut) {
                child.cells[cell] = other.cells[cell];
            }
        }
        let is_whole = child.grid == other.grid && child.is_sound();
        let level = if is_whole { child.level() } else { None };
        level.unwrap_or_else(|| self.mutate(one, sampler))
    }
}
