//! Checks whether a level is complete.

use engine::analysis::{Condition, Reason, Role};
use engine::{Analysis, Level, SpriteType};
use std::collections::BTreeSet;

/// Returns the names of the types that the goals or the placed sprites require but the level lacks.
pub(super) fn missing(analysis: &Analysis, level: &Level) -> Vec<String> {
    let game = analysis.game();
    let count = |stype: SpriteType| {
        let placed = level.cells().iter().flat_map(|&symbol| game.places(symbol));
        placed.filter(|&&placed| placed == stype).count()
    };
    let sum = |types: &[SpriteType]| types.iter().map(|&stype| count(stype)).sum::<usize>();
    let mut names = BTreeSet::new();
    for goal in analysis.goals().iter().filter(|goal| goal.win) {
        let Condition::AtMost(types, _) = &goal.condition else { continue };
        let placed = |stype: &&SpriteType| {
            !analysis.facts(**stype).symbols.is_empty() && analysis.role(**stype) != Role::Avatar
        };
        let types: Vec<SpriteType> = types.iter().filter(placed).copied().collect();
        if !types.is_empty() && sum(&types) == 0 {
            names.insert(game.name(types[0]).to_owned());
        }
    }
    for requirement in analysis.requirements() {
        let asked = match requirement.reason {
            Reason::Avatar | Reason::Goal(_) => true,
            // Other rules may create the missing sprite.
            Reason::WinMethod(_) => false,
            Reason::Lock(stype) | Reason::Portal(stype) => count(stype) > 0,
        };
        let there = sum(&requirement.types);
        let few = there < requirement.at_least as usize;
        let many = requirement.at_most.is_some_and(|most| there > most as usize);
        if asked && (few || many) {
            let name = requirement.types.first().map_or("nothing", |&stype| game.name(stype));
            names.insert(name.to_owned());
        }
    }
    names.into_iter().collect()
}
