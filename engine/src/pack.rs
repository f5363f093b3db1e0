//! States stored as differences from another state, for searches that keep millions of them.
//!
//! Most of a state is the same in all states of a level: walls, floors and their tables. A [`Packed`] state stores only
//! the bytes in which it differs from a base, usually the start of the search: some hundred bytes instead of tens of
//! thousands.

use crate::chance::Chance;
use crate::contribution::{Contribution, FlightMotion, HashClass};
use crate::flight::Flight;
use crate::game::{Action, Outcome, SpriteType};
use crate::geometry::{Direction, Rect};
use crate::moved::Resized;
use crate::overrides::{Extra, Overrides, Target};
use crate::side_tables::{Held, Replaced};
use crate::sleep::Sleeper;
use crate::state::{Group, Sprite, State, Timer};

/// A state, stored as the difference from a base. It can only be restored by [`State::unpack_from`] with the same base.
#[derive(Clone, Debug)]
pub struct Packed {
    outcome: Outcome,
    last_action: Action,
    bytes: Box<[u8]>,
}

impl Packed {
    /// The size in bytes.
    pub fn size_in_bytes(&self) -> usize {
        size_of::<Packed>() + self.bytes.len()
    }
}

impl State {
    /// Packs this state as the difference from `base`. Cost: that of comparing the two, O(size of a state).
    pub fn pack(&self, base: &State) -> Packed {
        let mut bytes = Vec::with_capacity(512);
        self.differences(base, &mut bytes);
        Packed { outcome: self.outcome, last_action: self.last_action, bytes: bytes.into() }
    }

    /// Makes this state the packed one again; keeps the buffers. `base` is the state that it was packed against. Cost:
    /// that of a copy of `base`.
    ///
    /// # Panics
    /// May panic if the state was packed against another base.
    pub fn unpack_from(&mut self, packed: &Packed, base: &State) {
        self.clone_from(base);
        (self.outcome, self.last_action) = (packed.outcome, packed.last_action);
        let mut bytes = &*packed.bytes;
        self.apply(&mut bytes);
        assert!(bytes.is_empty(), "packed against this base");
    }
}

/// Both directions over all fields: here the compiler notices a missing field.
macro_rules! state_fields {
    (scalars $($scalar:ident)*; buffers $($buffer:ident)*; scratch $($scratch:ident)*) => {
        impl State {
            fn differences(&self, base: &State, to: &mut Vec<u8>) {
                let State { outcome: _, last_action: _, $($scratch: _,)* $($scalar,)* $($buffer,)* } = self;
                $(put_scalar($scalar, &base.$scalar, to);)*
                $(put_buffer($buffer, &base.$buffer, to);)*
            }

            fn apply(&mut self, from: &mut &[u8]) {
                $(take_scalar(&mut self.$scalar, from);)*
                $(take_buffer(&mut self.$buffer, from);)*
            }
        }
    };
}

state_fields! {
    scalars tick score chance avatar next_id population messages block columns rows free can_end sum memory_hash memory_is_dirty big off multi_cell_bits big_bits next_due census_changed jumps vast left_behind;
    buffers sprites contributions hash_classes groups cells masks crowds covered together meets reasons possible moved resized dirty killed held memory templates shields pulled overrides extras sleepers watched stamps flights timers replaced counters;
    scratch touched paths scenery
}

fn put_scalar<T: Bytes>(value: &T, base: &T, to: &mut Vec<u8>) {
    let same = value.same(base);
    same.put(to);
    if !same {
        value.put(to);
    }
}

fn take_scalar<T: Bytes>(value: &mut T, from: &mut &[u8]) {
    if !bool::take(from) {
        *value = T::take(from);
    }
}

/// The length, then the entries that differ, each preceded by its distance from the one before, then a distance of 0.
fn put_buffer<T: Bytes>(buffer: &[T], base: &[T], to: &mut Vec<u8>) {
    put_number(buffer.len(), to);
    let mut next = 0;
    for (at, value) in buffer.iter().enumerate() {
        if !base.get(at).is_some_and(|base| value.same(base)) {
            put_number(at + 1 - next, to);
            value.put(to);
            next = at + 1;
        }
    }
    put_number(0, to);
}

fn take_buffer<T: Bytes>(buffer: &mut Vec<T>, from: &mut &[u8]) {
    let length = take_number(from);
    buffer.truncate(length);
    let mut next = 0;
    loop {
        let distance = take_number(from);
        if distance == 0 {
            return;
        }
        next += distance;
        let value = T::take(from);
        match buffer.get_mut(next - 1) {
            Some(old) => *old = value,
            // Beyond the length of the base, every entry differs.
            None => buffer.push(value),
        }
    }
}

/// Writes seven bits per byte, low bits first (LEB128).
fn put_number(mut number: usize, to: &mut Vec<u8>) {
    while number >= 0x80 {
        to.push(number as u8 | 0x80);
        number >>= 7;
    }
    to.push(number as u8);
}

fn take_number(from: &mut &[u8]) -> usize {
    let (mut number, mut shift) = (0, 0);
    loop {
        let byte = u8::take(from);
        number |= usize::from(byte & 0x7F) << shift;
        shift += 7;
        if byte < 0x80 {
            return number;
        }
    }
}

/// A type that is written as bytes and read back bit for bit.
trait Bytes: Copy {
    fn put(self, to: &mut Vec<u8>);
    fn take(from: &mut &[u8]) -> Self;
    /// Tests whether the bits are the same.
    fn same(&self, other: &Self) -> bool;
}

macro_rules! numbers {
    ($($number:ident)*) => {$(
        impl Bytes for $number {
            fn put(self, to: &mut Vec<u8>) {
                to.extend(self.to_le_bytes());
            }

            fn take(from: &mut &[u8]) -> $number {
                let (head, rest) = from.split_first_chunk().expect("at least as much was written");
                *from = rest;
                $number::from_le_bytes(*head)
            }

            fn same(&self, other: &$number) -> bool {
                self.to_le_bytes() == other.to_le_bytes()
            }
        }
    )*};
}

numbers! { u8 u16 u32 u64 u128 i16 i32 i64 f64 }

impl Bytes for bool {
    fn put(self, to: &mut Vec<u8>) {
        to.push(u8::from(self));
    }

    fn take(from: &mut &[u8]) -> bool {
        u8::take(from) != 0
    }

    fn same(&self, other: &bool) -> bool {
        self == other
    }
}

macro_rules! fields {
    ($($name:ident { $($field:ident)* })*) => {$(
        impl Bytes for $name {
            fn put(self, to: &mut Vec<u8>) {
                let $name { $($field),* } = self;
                $($field.put(to);)*
            }

            fn take(from: &mut &[u8]) -> $name {
                $name { $($field: Bytes::take(from)),* }
            }

            fn same(&self, other: &$name) -> bool {
                let $name { $($field),* } = self;
                $($field.same(&other.$field))&&*
            }
        }
    )*};
}

fields! {
    Rect { x y w h }
    Direction { x y }
    Flight { slot due }
    Sleeper { slot pass left top right bottom }
    Timer { due timed }
    Held { holder resource amount }
    Replaced { holder place stype }
    Group { head tail count disabled multi_cell big off skipped }
    Contribution { word motion still }
    HashClass { period phase flights growth }
    Resized { slot w h }
    Overrides { orientation speed health max_health start spawns extra holder }
    Extra { holder rotation gravity facing block_time target last_known }
    Sprite { rect last_corner id moved_at time_to_live count flags stype overrides activity next previous cell_next cell_previous column row }
}

macro_rules! wrapped {
    ($($name:ident)*) => {$(
        impl Bytes for $name {
            fn put(self, to: &mut Vec<u8>) {
                self.0.put(to);
            }

            fn take(from: &mut &[u8]) -> $name {
                $name(Bytes::take(from))
            }

            fn same(&self, other: &$name) -> bool {
                self == other
            }
        }
    )*};
}

wrapped! { SpriteType Chance FlightMotion }

impl<T: Bytes, U: Bytes> Bytes for (T, U) {
    fn put(self, to: &mut Vec<u8>) {
        self.0.put(to);
        self.1.put(to);
    }

    fn take(from: &mut &[u8]) -> (T, U) {
        (T::take(from), U::take(from))
    }

    fn same(&self, other: &(T, U)) -> bool {
        self.0.same(&other.0) && self.1.same(&other.1)
    }
}

/// Shields.
impl Bytes for (SpriteType, SpriteType, u16) {
    fn put(self, to: &mut Vec<u8>) {
        ((self.0, self.1), self.2).put(to);
    }

    fn take(from: &mut &[u8]) -> Self {
        let ((one, two), keyword) = Bytes::take(from);
        (one, two, keyword)
    }

    fn same(&self, other: &Self) -> bool {
        self == other
    }
}

impl Bytes for [u64; 2] {
    fn put(self, to: &mut Vec<u8>) {
        (self[0], self[1]).put(to);
    }

    fn take(from: &mut &[u8]) -> [u64; 2] {
        let (one, two) = Bytes::take(from);
        [one, two]
    }

    fn same(&self, other: &[u64; 2]) -> bool {
        self == other
    }
}

impl Bytes for Option<(i32, i32)> {
    fn put(self, to: &mut Vec<u8>) {
        (self.is_some(), self.unwrap_or_default()).put(to);
    }

    fn take(from: &mut &[u8]) -> Self {
        let (is_some, value) = Bytes::take(from);
        Some(value).filter(|_| is_some)
    }

    fn same(&self, other: &Self) -> bool {
        self == other
    }
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
