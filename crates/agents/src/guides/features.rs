//! The features that determine novelty: the sprites' positions and the avatar's resources.

use engine::analysis::{Analysis, Motion, StateAbstraction};
use engine::{Direction, SpriteType, State};
use serde::{Deserialize, Serialize};

/// The number of values that features distinguish for each resource amount and for each sprite count.
const AMOUNTS: usize = 16;

/// The atoms that can occur in any state reachable from a start state. An atom is a fact such as "a sprite of this
/// type is in this cell" or "the avatar has this amount of this resource". Types that never change are omitted.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Features {
    columns: i32,
    rows: i32,
    /// The types whose positions are features, as indices into the registry.
    types: Vec<u16>,
    /// The number of avatar types, which come first in `types`. Their orientation is also a feature, because some
    /// avatars turn before they move.
    avatars: usize,
    /// The types whose sprite count is a feature.
    numbers: Vec<u16>,
    resources: Vec<u16>,
}

impl Features {
    /// Returns the features of all types and resources that can change.
    pub(crate) fn of(analysis: &Analysis, abstraction: &StateAbstraction, start: &State) -> Features {
        let changes = |stype: SpriteType| {
            analysis.facts(stype).concrete
                && analysis.facts(stype).possible
                && !abstraction.is_constant(stype)
        };
        let (columns, rows) = start.size();
        let types = analysis.game().sprite_types().filter(|&stype| changes(stype)).map(|stype| stype.0);
        let is_avatar = |&stype: &u16| analysis.facts(SpriteType(stype)).motion == Motion::Steered;
        let (mut types, others): (Vec<u16>, Vec<u16>) = types.partition(is_avatar);
        let avatars = types.len();
        types.extend(others);
        let resources = analysis.resources().iter().map(|resource| resource.stype.0).collect();
        Features { columns, rows, types, avatars, numbers: Vec::new(), resources }
    }

    /// Returns the features from [`Features::of`], except the positions of types that move on their own or soon
    /// vanish. Such positions change constantly, whatever the player does. For these types, only the sprite counts
    /// are features.
    pub(crate) fn without_moving_types(
        analysis: &Analysis,
        abstraction: &StateAbstraction,
        start: &State,
    ) -> Features {
        let mut features = Features::of(analysis, abstraction, start);
        let calm = |&stype: &u16| {
            let facts = analysis.facts(SpriteType(stype));
            matches!(facts.motion, Motion::Still | Motion::Steered) && !facts.fleeting
        };
        features.numbers = features.types.iter().copied().filter(|stype| !calm(stype)).collect();
        features.types.retain(calm);
        features
    }

    /// Returns the number of atoms, which are facts about a state such as the cell of a type's sprite.
    pub(crate) fn len(&self) -> usize {
        self.places() + AMOUNTS * (self.resources.len() + self.numbers.len())
    }

    fn places(&self) -> usize {
        self.cells() * (self.types.len() + (FACINGS - 1) * self.avatars)
    }

    /// Returns the number of cells, plus one for all positions outside the board.
    fn cells(&self) -> usize {
        (self.columns * self.rows) as usize + 1
    }

    /// Visits the atoms (facts) of a state. Some atoms may be visited twice. Cost: O(sprites of types that change).
    pub(crate) fn each(&self, state: &State, mut atom: impl FnMut(usize)) {
        let block = state.block();
        let cells = self.cells();
        for (at, &stype) in self.types.iter().enumerate() {
            for (rect, facing) in state.bodies(SpriteType(stype)) {
                // The position of a sprite is the cell of its centre.
                let column = rect.x.wrapping_add(rect.w / 2).div_euclid(block);
                let row = rect.y.wrapping_add(rect.h / 2).div_euclid(block);
                let inside = (0..self.columns).contains(&column) && (0..self.rows).contains(&row);
                let cell = if inside { (row * self.columns + column) as usize } else { cells - 1 };
                let place = if at < self.avatars {
                    FACINGS * at + quarter(facing)
                } else {
                    (FACINGS - 1) * self.avatars + at
                };
                atom(place * cells + cell);
            }
        }
        let resources = self.places();
        for (at, &resource) in self.resources.iter().enumerate() {
            let amount = usize::try_from(state.amount_held(SpriteType(resource))).unwrap_or(0);
            atom(resources + at * AMOUNTS + amount.min(AMOUNTS - 1));
        }
        let numbers = resources + AMOUNTS * self.resources.len();
        for (at, &stype) in self.numbers.iter().enumerate() {
            atom(numbers + at * AMOUNTS + state.alive(SpriteType(stype)).min(AMOUNTS - 1));
        }
    }
}

/// The number of orientations: none, up, left, down, right.
const FACINGS: usize = 5;

fn quarter(facing: Direction) -> usize {
    let Direction { x, y } = facing;
    if x == 0.0 && y == 0.0 {
        0
    } else if y.abs() >= x.abs() {
        if y < 0.0 { 1 } else { 3 }
    } else if x < 0.0 {
        2
    } else {
        4
    }
}

/// A set of atoms, which are facts about a state.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Atoms(Vec<u64>);

impl Atoms {
    pub(crate) fn new(atoms: usize) -> Atoms {
        Atoms(vec![0; atoms.div_ceil(64)])
    }

    /// Adds an atom (a fact about a state). Returns `true` if the atom is new.
    pub(crate) fn insert(&mut self, atom: usize) -> bool {
        let (word, bit) = (&mut self.0[atom / 64], 1 << (atom % 64));
        let is_new = *word & bit == 0;
        *word |= bit;
        is_new
    }
}
