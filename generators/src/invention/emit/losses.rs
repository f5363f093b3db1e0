//! The ways to lose: losing objects that an ending needs, and the player's death.

use super::clauses::Clauses;
use super::{REMOVING, lost_name, name, own_name};
use crate::invention::genome::Invention;
use crate::invention::mechanic::{Body, Origin, OwnType, Port, Tag};
use crate::invention::merge::{Merged, PortId};
use engine::syntax::{InteractionLine, Param, SpriteLine, TerminationLine, Word};

/// Makes the loss of a goal end the game, except for goals that only have to be removed. Returns the types that can be
/// lost in this way.
pub(super) fn lose_with_goals(
    invention: &Invention,
    types: &[Merged],
    clauses: &mut [Clauses],
) -> Vec<usize> {
    let ending = invention.mechanics.len() - 1;
    let mut losses = Vec::new();
    for (class, merged) in types.iter().enumerate() {
        if !merged.is_kept_for(ending) {
            continue;
        }
        let lost = lost_name(class);
        let things = [vec![name(class)], lasting_states(invention, types, class)].concat();
        let losing =
            merged.ports.iter().filter(|((mechanic, _), port)| *mechanic != ending && merged.loses(port));
        let mut is_lost = false;
        for ((mechanic, _), _) in losing {
            let own = &mut clauses[*mechanic];
            for (lines, thing) in things.iter().flat_map(|thing| [(0, thing), (1, thing)]) {
                let lines = if lines == 0 { &mut own.before } else { &mut own.rules };
                is_lost |= mark_losses(lines, thing, &lost);
            }
        }
        if is_lost {
            losses.push(class);
        }
    }
    losses
}

/// Returns the states of a type that an ending still counts as the type, because the mechanic that defines the state
/// does not remove or use up the type.
fn lasting_states(invention: &Invention, types: &[Merged], class: usize) -> Vec<String> {
    let merged = &types[class];
    let of_port = |((at, _), port): &(PortId, &'static Port)| {
        let is_gone = port.tags.contains(&Tag::Removed) || port.tags.contains(&Tag::Spent);
        let is_state = |own: &&OwnType| {
            let is_lasting = own.body != Body::Flash && !is_gone;
            matches!(&own.origin, Origin::State { port: of, .. } if *of == port.name) && is_lasting
        };
        let types = invention.mechanics[*at].types.iter().filter(is_state);
        types.map(|own| own_name(*at, &own.name)).collect::<Vec<_>>()
    };
    merged.ports.iter().flat_map(of_port).collect()
}

/// Makes an ending that counts a type also count the states into which the type can turn and which still count as the
/// type.
pub(super) fn count_states(invention: &Invention, types: &[Merged], line: &mut TerminationLine) {
    let value = |line: &TerminationLine, key: &str| {
        line.params.iter().find(|param| param.key.text == key).map(|param| param.value.text.clone())
    };
    let counted = (line.class.text == "SpriteCounter").then(|| value(line, "stype")).flatten();
    let class = counted.and_then(|counted| (0..types.len()).find(|class| name(*class) == counted));
    let Some(class) = class else { return };
    let states = lasting_states(invention, types, class);
    if states.is_empty() {
        return;
    }
    line.class = Word::from("MultiSpriteCounter");
    line.params.retain(|param| param.key.text != "stype");
    let all = [vec![name(class)], states].concat();
    let counted = (1..).zip(all).map(|(at, stype)| Param::new(&format!("stype{at}"), stype));
    line.params.splice(0..0, counted);
}

/// Returns `true` if an ending's rules count a type that has lasting states or is produced by a mechanic. The rules
/// would miss the states, or the sprites that have not been produced yet.
pub(super) fn misses_states(invention: &Invention, types: &[Merged], ending: &Clauses) -> bool {
    let counts = |stype: &str| {
        let params = ending.before.iter().chain(&ending.rules).flat_map(|line| &line.params);
        params.into_iter().any(|param| param.key.text == "stypeCount" && param.value.text == stype)
    };
    (0..types.len())
        .filter(|class| counts(&name(*class)))
        .any(|class| types[class].has(Tag::Made) || !lasting_states(invention, types, class).is_empty())
}

/// Makes every rule that removes an object leave a marker in its place. Returns `true` if there is such a rule.
fn mark_losses(lines: &mut Vec<InteractionLine>, thing: &str, lost: &str) -> bool {
    let mut marked = Vec::new();
    let mut is_lost = false;
    for mut line in lines.drain(..) {
        let is_removing = REMOVING.contains(&line.effect.text.as_str());
        let is_second = line.second.iter().any(|word| word.text == thing);
        let takes_second = line.effect.text == "killBoth"
            || line.params.iter().any(|param| param.key.text == "killSecond" && param.value.text == "True");
        if is_removing && line.first.text == thing && line.effect.text == "killSprite" {
            line.effect = Word::from("transformTo");
            line.params.push(Param::new("stype", lost));
            is_lost = true;
        } else if is_removing && (line.first.text == thing || (is_second && takes_second)) {
            marked.push(InteractionLine {
                effect: Word::from("spawn"),
                params: vec![Param::new("stype", lost)],
                ..line.clone()
            });
            is_lost = true;
        }
        marked.push(line);
    }
    *lines = marked;
    is_lost
}

/// Returns `true` if a rule kills the player.
pub(super) fn is_deadly(sprites: &[SpriteLine], rules: &[InteractionLine]) -> bool {
    let heroes = sprites.last().map_or(&[][..], |hero| &hero.children);
    let is_hero =
        |word: &Word| word.text == "hero" || heroes.iter().any(|state| state.name.text == word.text);
    let kills = ["killSprite", "killIfAlive", "killIfHasLess", "subtractHealthPoints"];
    rules.iter().any(|line| is_hero(&line.first) && kills.contains(&line.effect.text.as_str()))
}
