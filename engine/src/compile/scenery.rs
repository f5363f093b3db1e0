//! Types whose sprites never change: scenery, to which no rule, other sprite or termination refers, and
//! fixtures, which only collide with other sprites.

use super::interactions::Program;
use crate::rules::class::SpriteClass;
use crate::rules::{SpriteType, TypeInfo};
use crate::syntax::{Description, Param, Word};
use std::collections::BTreeSet;

/// The parameter that identifies a type by its index in the reference engine.
const BY_NUMBER: &str = "itype";

/// Returns, for each type, `true` if anything other than its own line, its parents' lines and the
/// LevelMapping refers to the type. If in doubt, the result is `true`: a value that merely has the same
/// spelling counts, too. Cost: O(n log n), where n is the number of words in the game.
pub(crate) fn referenced(description: &Description, types: &[TypeInfo]) -> Vec<bool> {
    let interactions = &description.interactions;
    let sides = interactions.iter().flat_map(|line| line.second.iter().chain([&line.first]));
    let sides: BTreeSet<&str> = sides.map(|word: &Word| word.text.as_str()).collect();
    let at_side =
        |info: &TypeInfo| info.tree.iter().any(|other| sides.contains(types[other.index()].name.as_str()));
    let valued = valued(description, types);
    types.iter().zip(valued).map(|(info, valued)| valued || at_side(info)).collect()
}

/// Returns, for each type, `true` if a parameter value on any line refers to the type. Costs as much as
/// [`referenced`].
fn valued(description: &Description, types: &[TypeInfo]) -> Vec<bool> {
    let lines = description.sprite_lines();
    let lines = lines.iter().flat_map(|(_, line)| &line.params);
    let endings = description.terminations.iter().flat_map(|line| &line.params);
    let params: Vec<&Param> = lines
        .chain(description.interactions.iter().flat_map(|line| &line.params))
        .chain(endings)
        .chain(&description.header.params)
        .collect();
    let named: BTreeSet<&str> = params.iter().flat_map(|param| param.value.text.split(',')).collect();
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

/// Returns `true` if, once a level has placed a type's sprites, neither their own updates nor the engine
/// itself change them.
fn stays_as_made(types: &[TypeInfo], stype: SpriteType) -> bool {
    let info = &types[stype.index()];
    // The first sprite of a type differs from later ones only if it is larger or smaller than a cell.
    let is_whole = info.traits.width_factor == 1.0 && info.traits.height_factor == 1.0;
    let is_still = info.order.is_some() && info.is_idle() && !info.is_like_avatar();
    // Some avatars leave walls behind although no parameter refers to walls.
    let leave_walls = |info: &TypeInfo| info.class == Some(SpriteClass::OngoingTurningAvatar);
    is_whole && is_still && (stype != SpriteType(0) || !types.iter().any(leave_walls))
}

/// Returns, for each type, `true` if its sprites are scenery, which means that no rule involves them.
pub(crate) fn scenery(types: &[TypeInfo], referenced: &[bool]) -> Vec<bool> {
    // Type 0 is `wall`, which the engine itself refers to.
    let is_scenery = |stype: SpriteType| {
        stype != SpriteType(0) && !referenced[stype.index()] && stays_as_made(types, stype)
    };
    (0..types.len() as u16).map(SpriteType).map(is_scenery).collect()
}

/// Returns, for each type, `true` if its sprites are fixtures. Other sprites collide with fixtures, but no
/// rule creates, moves, changes or removes them. No parameter refers to a fixture's type, no effect runs on
/// fixtures, and effects that run on other sprites leave fixtures unchanged.
pub(crate) fn fixtures(description: &Description, types: &[TypeInfo], program: &Program) -> Vec<bool> {
    let firsts = program.passes.iter().map(|pass| pass.first);
    let firsts = firsts.chain(program.edge.iter().map(|&(stype, _)| stype));
    let firsts = firsts.chain(program.timed.iter().filter_map(|timed| timed.target));
    let touched = program
        .passes
        .iter()
        .filter(|pass| !program.effects[usize::from(pass.effect)].summary.spares_still_second());
    let trees = firsts.chain(touched.map(|pass| pass.second)).filter_map(|stype| types.get(stype.index()));
    let touched: BTreeSet<SpriteType> = trees.flat_map(|info| info.tree.iter().copied()).collect();
    let valued = valued(description, types);
    let is_fixture = |stype: SpriteType| {
        let info = &types[stype.index()];
        let is_single = info.path.iter().any(|ancestor| types[ancestor.index()].singleton);
        !valued[stype.index()] && !touched.contains(&stype) && !is_single && stays_as_made(types, stype)
    };
    (0..types.len() as u16).map(SpriteType).map(is_fixture).collect()
}
