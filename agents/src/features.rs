//! What novelty is measured on: which sprites are where, and what the avatar holds.

use engine::analysis::{Analysis, Keying};
use engine::{Game, SpriteType, State};
use serde::{Deserialize, Serialize};

/// Amounts of a resource that are told apart.
const AMOUNTS: usize = 16;

/// The atoms of states that can follow from one state: "a sprite of this type is in this cell", "the avatar holds so many of
/// this resource". Types that never change are left out.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Features {
    columns: i32,
    rows: i32,
    /// By their place in the registry.
    types: Vec<u16>,
    resources: Vec<u16>,
}

impl Features {
    pub(crate) fn of(analysis: &Analysis, keying: &Keying, start: &State) -> Features {
        let game: &Game = analysis.game();
        let (columns, rows) = start.size();
        let types = game.sprite_types().filter(|&stype| {
            analysis.facts(stype).concrete && analysis.facts(stype).possible && !keying.is_constant(stype)
        });
        let resources = analysis.resources().iter().map(|resource| resource.stype.0).collect();
        Features { columns, rows, types: types.map(|stype| stype.0).collect(), resources }
    }

    /// How many atoms there are.
    pub(crate) fn len(&self) -> usize {
        self.cells() * self.types.len() + AMOUNTS * self.resources.len()
    }

    /// With a cell for all that is outside.
    fn cells(&self) -> usize {
        (self.columns * self.rows) as usize + 1
    }

    /// The atoms of a state, some perhaps twice. Cost: O(sprites of types that change).
    pub(crate) fn each(&self, state: &State, mut atom: impl FnMut(usize)) {
        let block = state.block();
        let cells = self.cells();
        for (at, &stype) in self.types.iter().enumerate() {
            for rect in state.rects(SpriteType(stype)) {
                // Where its centre is.
                let column = rect.x.wrapping_add(rect.w / 2).div_euclid(block);
                let row = rect.y.wrapping_add(rect.h / 2).div_euclid(block);
                let inside = (0..self.columns).contains(&column) && (0..self.rows).contains(&row);
                let cell = if inside { (row * self.columns + column) as usize } else { cells - 1 };
                atom(at * cells + cell);
            }
        }
        let resources = cells * self.types.len();
        for (at, &resource) in self.resources.iter().enumerate() {
            let amount = usize::try_from(state.amount_held(SpriteType(resource))).unwrap_or(0);
            atom(resources + at * AMOUNTS + amount.min(AMOUNTS - 1));
        }
    }
}

/// A set of atoms.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Atoms(Vec<u64>);

impl Atoms {
    pub(crate) fn new(atoms: usize) -> Atoms {
        Atoms(vec![0; atoms.div_ceil(64)])
    }

    pub(crate) fn contains(&self, atom: usize) -> bool {
        self.0[atom / 64] >> (atom % 64) & 1 != 0
    }

    /// Whether the atom was not in the set yet.
    pub(crate) fn insert(&mut self, atom: usize) -> bool {
        let (word, bit) = (&mut self.0[atom / 64], 1 << (atom % 64));
        let is_new = *word & bit == 0;
        *word |= bit;
        is_new
    }
}
