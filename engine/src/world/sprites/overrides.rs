//! Copy-on-write overrides for sprites: orientation, speed, health and other values that rarely differ from
//! those of the type.
//!
//! Sprites share their type's values until the first change gives them overrides of their own. Sharing keeps
//! sprites small and state copies cheap.

use crate::flat::{Bytes, bytes_of_fields};
use crate::numbers::geometry::{Direction, Rect};
use crate::rules::class::SpriteClass;
use crate::rules::{Rules, SpriteType};
use crate::world::{NONE, Slot, Sprite, World};

/// A sprite's rarely changed values: either those of its type or its own copy (copy on write).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Overrides {
    pub(crate) orientation: Direction,
    pub(crate) speed: f64,
    pub(crate) health: i32,
    pub(crate) max_health: i32,
    /// The tick of a spawner's first update, or −1 before that update.
    pub(crate) start: i32,
    /// The type that a spawner currently creates, which updateSpawnType can change.
    pub(crate) spawns: SpriteType,
    /// The index into `World::extras`, or `NONE`.
    pub(crate) extra: u16,
    /// The sprite that owns the overrides, or `NONE` if they belong to a type.
    pub(crate) holder: Slot,
}

bytes_of_fields! { Overrides { orientation speed health max_health start spawns extra holder } }

/// Additional values for the few sprites that turn, fall differently from their type, or chase one target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Extra {
    pub(crate) holder: Slot,
    pub(crate) rotation: f64,
    pub(crate) gravity: f64,
    /// For a CarAvatar, 0 or 1 in x. For a WizardAvatar, the direction that it faces.
    pub(crate) facing: Direction,
    /// The tick of a WizardAvatar's last block.
    pub(crate) block_time: i32,
    /// The target of a PathAltChaser, and the last target position to which the sprite knew a path.
    pub(crate) target: Target,
    pub(crate) last_known: Option<(i32, i32)>,
}

bytes_of_fields! { Extra { holder rotation gravity facing block_time target last_known } }

/// The target of a PathAltChaser. The reference engine keeps a pointer to the target, so a removed target is
/// chased to its last position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Target {
    None,
    Sprite(Slot),
    Gone(Rect),
}

impl Bytes for Target {
    fn put(self, to: &mut Vec<u8>) {
        match self {
            Target::None => 0u8.put(to),
            Target::Sprite(slot) => (1u8, slot).put(to),
            Target::Gone(rect) => (2u8, rect).put(to),
        }
    }

    fn take(from: &mut &[u8]) -> Target {
        match u8::take(from) {
            0 => Target::None,
            1 => Target::Sprite(Bytes::take(from)),
            _ => Target::Gone(Bytes::take(from)),
        }
    }

    fn same(&self, other: &Target) -> bool {
        self == other
    }
}

impl World {
    /// Returns a sprite's overrides. The sprite may be scenery.
    #[inline(always)]
    pub(crate) fn overrides_of(&self, sprite: &Sprite) -> &Overrides {
        &self.overrides[usize::from(sprite.overrides)]
    }

    /// Returns the number of overrides: one per type, plus the overrides that sprites own.
    pub(crate) fn overrides_count(&self) -> usize {
        self.overrides.len()
    }

    #[inline(always)]
    pub(crate) fn overrides(&self, slot: Slot) -> &Overrides {
        self.overrides_of(self.sprite(slot))
    }

    /// Returns a sprite's overrides for modification. Copies shared overrides first.
    #[inline]
    pub(crate) fn edit_overrides(&mut self, slot: Slot) -> &mut Overrides {
        let at = usize::from(self.edit(slot).overrides);
        if self.overrides[at].holder == slot { &mut self.overrides[at] } else { self.copy_overrides(slot) }
    }

    /// Creates a sprite's own copy of its overrides.
    #[inline(never)]
    fn copy_overrides(&mut self, slot: Slot) -> &mut Overrides {
        let sprite = &mut self.sprites[usize::from(slot)];
        let at = usize::from(std::mem::replace(&mut sprite.overrides, self.overrides.len() as u16));
        self.overrides.push(Overrides { holder: slot, ..self.overrides[at] });
        self.overrides.last_mut().expect("an entry was just pushed")
    }

    /// Turns a sprite.
    #[inline(always)]
    pub(crate) fn face(&mut self, slot: Slot, direction: Direction) {
        let bits = |direction: Direction| (direction.x.to_bits(), direction.y.to_bits());
        // Most sprites keep their orientation, so their hash contribution does not change.
        if bits(self.overrides_of(self.own(slot)).orientation) != bits(direction) {
            self.turn_to(slot, direction);
        }
    }

    /// Completes [`World::face`] if the orientation changes.
    #[inline(never)]
    pub(crate) fn turn_to(&mut self, slot: Slot, direction: Direction) {
        self.edit_overrides(slot).orientation = direction;
    }

    /// Releases the overrides and the extra values that a sprite owns.
    pub(crate) fn release_overrides(&mut self, slot: Slot) {
        let at = self.sprite(slot).overrides;
        let Overrides { holder, extra, .. } = self.overrides[usize::from(at)];
        if holder != slot {
            return;
        }
        if extra != NONE {
            self.extras.swap_remove(usize::from(extra));
            if let Some(&Extra { holder, .. }) = self.extras.get(usize::from(extra)) {
                let own = self.sprite(holder).overrides;
                self.overrides[usize::from(own)].extra = extra;
            }
        }
        self.overrides.swap_remove(usize::from(at));
        if let Some(moved) = self.overrides.get(usize::from(at)) {
            self.sprites[usize::from(moved.holder)].overrides = at;
        }
    }

    /// Returns a sprite's extra values. If it has none yet, creates them from the traits of its type.
    pub(crate) fn extra(&mut self, rules: &Rules, slot: Slot) -> &mut Extra {
        if self.overrides(slot).extra == NONE {
            let info = &rules.types[self.sprite(slot).stype.index()];
            let traits = &info.traits;
            let is_car = info.class == Some(SpriteClass::CarAvatar);
            let facing = if is_car { Direction { x: traits.facing, y: 0.0 } } else { traits.facing_dir };
            self.edit_overrides(slot).extra = self.extras.len() as u16;
            self.extras.push(Extra {
                holder: slot,
                rotation: traits.rotation,
                gravity: traits.gravity,
                facing,
                block_time: traits.last_block_time,
                target: Target::None,
                last_known: None,
            });
        }
        let extra = self.overrides(slot).extra;
        &mut self.extras[usize::from(extra)]
    }

    /// Returns a sprite's extra values, or `None` if it has none.
    pub(crate) fn extra_of(&self, sprite: &Sprite) -> Option<&Extra> {
        self.extras.get(usize::from(self.overrides_of(sprite).extra))
    }

    pub(crate) fn rotation(&self, rules: &Rules, sprite: &Sprite) -> f64 {
        let own = self.extra_of(sprite).map(|extra| extra.rotation);
        own.unwrap_or(rules.types[sprite.stype.index()].traits.rotation)
    }

    pub(crate) fn gravity(&self, rules: &Rules, slot: Slot) -> f64 {
        let sprite = self.sprite(slot);
        let own = self.extra_of(sprite).map(|extra| extra.gravity);
        own.unwrap_or(rules.types[sprite.stype.index()].traits.gravity)
    }
}
