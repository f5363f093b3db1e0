//! Scenery: the types that no rule, no other sprite and no termination refers to, and that do nothing by themselves.

use crate::rules::{SpriteType, TypeInfo};
use crate::syntax::{Description, Param, Word};
use std::collections::BTreeSet;

/// The parameter with which the reference reads a type by its number.
const BY_NUMBER: &str = "itype";

/// By type: `true` if anything but its own line, its parents' and the LevelMapping refers to it. `true` in case of doubt:
/// a value that is only spelled like the type counts, too. Cost: O(words of the game × log).
pub(crate) fn referenced(description: &Description, types: &[TypeInfo]) -> Vec<bool> {
    let lines = description.sprite_lines();
    let lines = lines.iter().flat_map(|(_, line)| &line.params);
    let interactions = &description.interactions;
    let endings = description.terminations.iter().flat_map(|line| &line.params);
    let params: Vec<&Param> = lines
        .chain(interactions.iter().flat_map(|line| &line.params))
        .chain(endings)
        .chain(&description.header.params)
        .collect();
    let sides = interactions.iter().flat_map(|line| line.second.iter().chain([&line.first]));
    let words = sides.chain(params.iter().map(|param| &param.value));
    let named: BTreeSet<&str> = words.flat_map(|word: &Word| word.text.split(',')).collect();
    let numbered: BTreeSet<usize> = params
        .iter()
        .filter(|param| param.key.text == BY_NUMBER)
        .filter_map(|param| param.value.text.parse().ok())
        .collect();
    let speaks_of = |other: &SpriteType| {
        named.contains(types[other.index()].name.as_str()) || numbered.contains(&other.index())
    };
    types.iter().map(|info| info.tree.iter().any(speaks_of)).collect()
}

/// By type: `true` if its sprites are scenery.
pub(crate) fn scenery(types: &[TypeInfo], referenced: &[bool]) -> Vec<bool> {
    let is_scenery = |(number, info): (u16, &TypeInfo)| {
        let stype = SpriteType(number);
        // The first sprite of a type differs from later ones only if its size differs from a cell's.
        let is_whole = info.traits.width_factor == 1.0 && info.traits.height_factor == 1.0;
        let is_idle = info.is_idle();
        let is_still = info.order.is_some() && is_idle && !info.is_like_avatar();
        // Some avatars leave walls behind without naming them.
        stype != SpriteType(0) && !referenced[stype.index()] && is_whole && is_still
    };
    (0..).zip(types).map(is_scenery).collect()
}
