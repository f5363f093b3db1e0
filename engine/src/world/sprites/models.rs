//! Sprite prototypes: one model per type, with the values that all its sprites share.

use crate::numbers::geometry::Rect;
use crate::rules::class::SpriteClass;
use crate::rules::{Rules, SpriteType, TypeInfo};
use crate::world::{NO_HEADING, NONE, Overrides, Sprite, flag};

/// The number of bits in a cell mask. If there are more types than bits, the remaining types share the last
/// bit. Rules on these types are then tested more often than necessary, with the same results.
const BITS: usize = 64;

/// The part of a type's data that the world needs.
#[derive(Clone, Debug)]
pub(crate) struct Model {
    pub(crate) prototype: Sprite,
    /// The values that sprites of the type share.
    pub(crate) overrides: Overrides,
    /// `true` if a termination may count sprites of the type.
    pub(crate) counted: bool,
}

/// A type's bits in the cell masks.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TypeBits {
    /// The type's own bit, or 0 for types without rules.
    pub(crate) own: u64,
    /// The bits of the types that a rule pairs with this type.
    pub(crate) partners: u64,
}

/// The models of a game's sprite types, and the types' bits in the cell masks.
#[derive(Clone, Debug)]
pub(crate) struct Models {
    /// The model of each type, from which new sprites are copied.
    pub(crate) of_type: Vec<Model>,
    /// Each type's bits in the cell masks.
    pub(crate) bits: Vec<TypeBits>,
    /// For each type, the bits of the types in its tree.
    pub(crate) trees: Vec<u64>,
    /// The number of mask bits in use.
    pub(crate) used_bits: usize,
}

impl Models {
    /// Builds a game's models. Cost: O(types + passes × size of the largest trees).
    pub(crate) fn of(rules: &Rules) -> Models {
        let model = |(at, info): (u16, &TypeInfo)| Model {
            prototype: prototype(SpriteType(at), info),
            overrides: overrides(info),
            counted: info.counted,
        };
        let mut bits = vec![TypeBits::default(); rules.types.len()];
        let mut used_bits = 0;
        let tree = |side: SpriteType| &rules.types[side.index()].tree;
        for stype in rules.passes.iter().flat_map(|pass| [pass.first, pass.second]).flat_map(tree) {
            let own = &mut bits[stype.index()].own;
            if *own == 0 {
                *own = 1 << used_bits.min(BITS - 1);
                used_bits = (used_bits + 1).min(BITS);
            }
        }
        let mut partners = [0; BITS];
        for pass in &rules.passes {
            let sides = [pass.first, pass.second].map(|side| all(&bits, tree(side)));
            ones(sides[0]).for_each(|bit| partners[bit] |= sides[1]);
            ones(sides[1]).for_each(|bit| partners[bit] |= sides[0]);
        }
        for of_type in bits.iter_mut().filter(|of_type| of_type.own != 0) {
            of_type.partners = partners[of_type.own.trailing_zeros() as usize];
        }
        Models {
            of_type: (0..).zip(&rules.types).map(model).collect(),
            trees: rules.types.iter().map(|info| all(&bits, &info.tree)).collect(),
            bits,
            used_bits,
        }
    }

    #[inline(always)]
    pub(crate) fn bit(&self, stype: SpriteType) -> u64 {
        self.bits[stype.index()].own
    }

    /// Returns the combined mask bits of several types.
    pub(crate) fn all(&self, types: &[SpriteType]) -> u64 {
        all(&self.bits, types)
    }

    /// Returns a type's bit, or 0 if the type may share it with other types.
    pub(crate) fn sole_bit(&self, stype: SpriteType) -> u64 {
        self.bit(stype) & !(1 << (BITS - 1))
    }
}

fn all(bits: &[TypeBits], types: &[SpriteType]) -> u64 {
    types.iter().fold(0, |all, stype| all | bits[stype.index()].own)
}

/// Returns the indices of the set bits, in ascending order.
pub(crate) fn ones(mut bits: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = bits.trailing_zeros() as usize;
        bits &= bits.wrapping_sub(1);
        (bit < 64).then_some(bit)
    })
}

/// Returns the prototype for a type's sprites. The rectangles, the creation number and the age are set when a
/// sprite is created.
pub(crate) fn prototype(stype: SpriteType, info: &TypeInfo) -> Sprite {
    let (traits, is_avatar) = (&info.traits, info.class.is_some_and(SpriteClass::is_avatar));
    let flags = [
        (flag::AVATAR, traits.is_avatar),
        (flag::FROM_AVATAR, traits.is_from_avatar),
        (flag::ON_GROUND, traits.on_ground),
        (flag::FIRST_TICK, traits.is_first_tick),
        (flag::ORIENTED, traits.is_oriented),
        // Sprites of avatar classes are updated, and age, only while the player controls them.
        (flag::FROZEN, info.order.is_none() || is_avatar),
        (flag::NO_COOLDOWN, traits.cooldown <= 1 && traits.last_move == 0 && !is_avatar),
    ];
    let no_heading = NO_HEADING << flag::HEADING;
    Sprite {
        rect: Rect::default(),
        last_corner: (0, 0),
        id: 0,
        moved_at: traits.last_move,
        time_to_live: traits.time_to_live,
        count: traits.age,
        stype,
        overrides: stype.0,
        activity: 0,
        period: 0,
        flags: flags.into_iter().fold(no_heading, |all, (bit, on)| if on { all | bit } else { all }),
        next: NONE,
        previous: NONE,
        cell_next: NONE,
        cell_previous: NONE,
        column: 0,
        row: 0,
    }
}

/// Returns the values that a type's sprites share.
pub(crate) fn overrides(info: &TypeInfo) -> Overrides {
    let traits = &info.traits;
    Overrides {
        orientation: traits.orientation,
        speed: traits.speed,
        health: traits.health,
        max_health: traits.max_health,
        start: -1,
        spawns: match info.class {
            Some(SpriteClass::OngoingTurningAvatar) => SpriteType(0),
            _ => traits.stypes.first().copied().unwrap_or(SpriteType::NONE),
        },
        extra: NONE,
        holder: NONE,
    }
}
