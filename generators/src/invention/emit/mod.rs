//! Conversion of merged ports (roles filled by one type) to rules: the mechanics' clauses with type names, and the
//! rules that follow from a type's body.

mod bodies;
mod clauses;
mod losses;

pub(super) use clauses::names_of;

use super::genome::Invention;
use super::mechanic::{Body, Origin, Tag};
use super::merge::Merged;
use crate::GenerateError;
use crate::games::english;
use bodies::{Bodies, collect_instead, is_contradictory};
use clauses::{Clauses, clauses, extend_to_states};
use engine::syntax::{self, InteractionLine, MappingLine, Param, SpriteLine, TerminationLine, Word};
use engine::{Description, Diagnostic, Game};
use losses::{count_states, is_deadly, lose_with_goals, misses_states};
use std::collections::{BTreeMap, BTreeSet};

/// An invention's rules, with internal names.
pub(in crate::invention) struct Written {
    pub(in crate::invention) description: Description,
    /// The index of each interaction's mechanic; `None` for interactions that follow from the types' bodies.
    pub(in crate::invention) owners: Vec<Option<usize>>,
}

impl Written {
    /// Removes a partner that triggers a compiler warning from its interaction, if the interaction follows from the
    /// types' bodies. Returns `false` if the interaction belongs to a mechanic.
    pub(in crate::invention) fn leave_out(
        &mut self,
        dressed: &mut Description,
        rules: &Game,
        warning: &Diagnostic,
    ) -> bool {
        let lines = rules.description().interactions.iter();
        let place = lines.enumerate().rfind(|(_, line)| line.first.span.start <= warning.span.start);
        let Some((at, line)) = place else { return false };
        let is_named =
            |word: &&Word| word.span == warning.span || warning.message.contains(&format!("`{}`", word.text));
        let idle = line.second.iter().position(|word| is_named(&word)).filter(|_| self.owners[at].is_none());
        let Some(idle) = idle.filter(|_| at < dressed.interactions.len()) else { return false };
        for lines in [&mut dressed.interactions, &mut self.description.interactions] {
            lines[at].second.remove(idle);
            if lines[at].second.is_empty() {
                lines.remove(at);
            }
        }
        if line.second.len() == 1 {
            self.owners.remove(at);
        }
        true
    }
}

/// Returns the internal name of the type that fills the given class of merged ports (open roles of mechanics).
pub(in crate::invention) fn name(class: usize) -> String {
    format!("type{class}")
}

/// Returns the internal name of a mechanic's own type.
pub(in crate::invention) fn own_name(mechanic: usize, own: &str) -> String {
    format!("own{mechanic}{}", english::capital(own))
}

/// Returns the internal name of a lost goal's marker.
pub(in crate::invention) fn lost_name(class: usize) -> String {
    format!("type{class}Lost")
}

/// The effects that remove the first sprite whenever two sprites meet.
const REMOVING: [&str; 3] = ["killSprite", "transformTo", "killBoth"];

/// Writes an invention's rules.
///
/// # Errors
/// Returns an error if two mechanics assign a class to the same type.
pub(in crate::invention) fn write(invention: &Invention, types: &[Merged]) -> Result<Written, GenerateError> {
    let mut clauses: Vec<Clauses> =
        (0..invention.mechanics.len()).map(|at| clauses(invention, types, at)).collect::<Result<_, _>>()?;
    extend_to_states(invention, types, &mut clauses);
    if clauses.last().is_some_and(|ending| misses_states(invention, types, ending)) {
        return Err(GenerateError::Unlucky("the ending misses a state of what it counts".to_owned()));
    }
    let losses = lose_with_goals(invention, types, &mut clauses);
    let mut bodies = Bodies::of(invention, types);
    let mut description = syntax::parse("BasicGame\n").0;
    description.has = [true; 4];
    description.sprites = sprites(types, &bodies, &mut clauses)?;
    description.sprites.extend(losses.iter().map(|class| sprite(&lost_name(*class), "Immovable")));
    move_hero_last(&mut description.sprites);
    bodies.marching = of_class(&description.sprites, "Missile");
    bodies.still = of_class(&description.sprites, "Immovable");
    description.mapping = mapping(types, &description.sprites);
    let mut before: Vec<InteractionLine> =
        clauses.iter().flat_map(|own| own.before.iter().cloned()).collect();
    let mut rules: Vec<InteractionLine> = clauses.iter().flat_map(|own| own.rules.iter().cloned()).collect();
    let items: BTreeSet<&str> = bodies.with(Body::Item).collect();
    before.iter_mut().chain(&mut rules).for_each(|line| collect_instead(line, &items));
    let all: Vec<InteractionLine> = before.iter().chain(&rules).cloned().collect();
    if is_contradictory(&bodies, types, &all) {
        return Err(GenerateError::Unlucky("two effects of a touch contradict each other".to_owned()));
    }
    let loses = |line: &TerminationLine| {
        line.params.iter().any(|param| param.key.text == "win" && param.value.text == "False")
    };
    let is_losable = clauses.iter().any(|own| own.terminations.iter().any(loses));
    if losses.is_empty() && !is_losable && !is_deadly(&description.sprites, &all) {
        return Err(GenerateError::Unlucky("nothing can be lost".to_owned()));
    }
    let taken: BTreeSet<String> = all
        .iter()
        .filter(|line| line.effect.text == "collectResource")
        .map(|line| line.first.text.clone())
        .collect();
    let of_bodies = |lines: Vec<InteractionLine>| lines.into_iter().map(|line| (line, None));
    let owned = |lines: Vec<InteractionLine>, count: fn(&Clauses) -> usize| {
        let owners = clauses.iter().enumerate().flat_map(move |(at, own)| vec![Some(at); count(own)]);
        lines.into_iter().zip(owners).collect::<Vec<_>>()
    };
    let all: Vec<(InteractionLine, Option<usize>)> = of_bodies(bodies.pushes(&before))
        .chain(touched_first(owned(before.clone(), |own| own.before.len()), &bodies))
        .chain(of_bodies(bodies.stops(&before)))
        .chain(of_bodies(bodies.picks_up(&taken)))
        .chain(owned(rules, |own| own.rules.len()))
        .collect();
    let (interactions, owners) = all.into_iter().unzip();
    description.interactions = interactions;
    description
        .terminations
        .push(termination("SpriteCounter", &[("stype", "hero"), ("limit", "0"), ("win", "False")]));
    for class in losses {
        let lost = lost_name(class);
        let params = [("stype", lost.as_str()), ("limit", "1"), ("win", "False")];
        description.terminations.push(termination("SpriteCounterMore", &params));
    }
    for mut line in clauses.into_iter().flat_map(|own| own.terminations) {
        count_states(invention, types, &mut line);
        description.terminations.push(line);
    }
    if let Some(time) = invention.time {
        let time = time.to_string();
        description.terminations.push(termination("Timeout", &[("limit", &time), ("win", "False")]));
    }
    Ok(Written { description, owners })
}

/// Reorders the rules, so that the effects of the player's touch on a solid type precede the rules that affect the
/// player. The latter run together with the rule that stops the player, after which the player no longer touches the
/// type.
fn touched_first(
    mut lines: Vec<(InteractionLine, Option<usize>)>,
    bodies: &Bodies,
) -> Vec<(InteractionLine, Option<usize>)> {
    let meets = |line: &InteractionLine, first: &str, second: &str| {
        line.first.text == first && line.second.iter().any(|word| word.text == second)
    };
    for stype in bodies.with(Body::Solid) {
        let Some(at) = lines.iter().position(|(line, _)| meets(line, "hero", stype)) else { continue };
        let (touched, others): (Vec<_>, Vec<_>) =
            lines.split_off(at).into_iter().partition(|(line, _)| meets(line, stype, "hero"));
        lines.extend(touched);
        lines.extend(others);
    }
    lines
}

fn is_hero(origin: &Origin) -> bool {
    matches!(origin, Origin::State { port, .. } if port == "hero")
}

/// Writes the SpriteSet. Types drawn below others come first, and the avatar comes last.
fn sprites(
    types: &[Merged],
    bodies: &Bodies,
    clauses: &mut [Clauses],
) -> Result<Vec<SpriteLine>, GenerateError> {
    let mut lines = vec![sprite("floor", "Immovable"), sprite("wall", "Immovable")];
    let mut own: BTreeMap<String, Vec<(usize, SpriteLine)>> = BTreeMap::new();
    for (at, clauses) in clauses.iter_mut().enumerate() {
        for line in clauses.sprites.drain(..) {
            own.entry(line.name.text.clone()).or_default().push((at, line));
        }
    }
    let order = [Body::Ground, Body::Solid, Body::Item, Body::Crate, Body::Mover, Body::Flash];
    for body in order {
        for name in bodies.with(body) {
            let given = own.remove(name).unwrap_or_default();
            let given: Vec<SpriteLine> =
                given.into_iter().filter(|(at, _)| is_of(types, *at, name)).map(|(_, line)| line).collect();
            match <[SpriteLine; 1]>::try_from(given) {
                Ok([line]) => lines.push(line),
                Err(none) if none.is_empty() => lines.push(default(name, body)),
                Err(_) => return Err(GenerateError::Unlucky("a type of two classes".to_owned())),
            }
        }
    }
    let hero = clauses.iter_mut().find_map(|clauses| clauses.hero.take());
    lines.push(hero.unwrap_or_else(|| sprite("hero", "MovingAvatar")));
    Ok(lines)
}

/// Returns `true` if a mechanic's line for a type is used. For a type that moves by itself, only the line from the
/// mechanic that moves it is used.
fn is_of(types: &[Merged], mechanic: usize, own: &str) -> bool {
    let merged = types.iter().enumerate().find(|(class, _)| name(*class) == own);
    merged.is_none_or(|(_, merged)| {
        merged.body != Body::Mover
            || merged.ports.iter().any(|((at, _), port)| *at == mechanic && port.tags.contains(&Tag::Moves))
    })
}

fn move_hero_last(lines: &mut Vec<SpriteLine>) {
    if let Some(at) = lines.iter().position(|line| line.name.text == "hero") {
        let hero = lines.remove(at);
        lines.push(hero);
    }
}

fn default(name: &str, body: Body) -> SpriteLine {
    match body {
        Body::Item => SpriteLine { params: vec![Param::new("limit", 9)], ..sprite(name, "Resource") },
        Body::Crate => sprite(name, "Passive"),
        Body::Flash => SpriteLine { params: vec![Param::new("limit", 0)], ..sprite(name, "Flicker") },
        _ => sprite(name, "Immovable"),
    }
}

fn sprite(name: &str, class: &str) -> SpriteLine {
    SpriteLine { name: Word::from(name), class: Some(Word::from(class)), ..SpriteLine::default() }
}

fn termination(class: &str, params: &[(&str, &str)]) -> TerminationLine {
    let params = params.iter().map(|(key, value)| Param::new(key, value)).collect();
    TerminationLine { class: Word::from(class), params, ..TerminationLine::default() }
}

/// Returns the names of the types whose lines specify the given class.
fn of_class(lines: &[SpriteLine], class: &str) -> BTreeSet<String> {
    let has = |line: &&SpriteLine| line.class.as_ref().is_some_and(|word| word.text == class);
    lines.iter().filter(has).map(|line| line.name.text.clone()).collect()
}

/// Returns the LevelMapping with internal names. The fiction assigns a character to each line.
fn mapping(types: &[Merged], sprites: &[SpriteLine]) -> Vec<MappingLine> {
    let line = |names: &[&str]| MappingLine {
        names: names.iter().map(|name| Word::from(*name)).collect(),
        ..MappingLine::default()
    };
    let states = sprites.last().and_then(|hero| hero.children.first());
    let hero = states.map_or("hero", |line| line.name.text.as_str());
    let mut lines = vec![line(&["floor"]), line(&["wall"]), line(&["floor", hero])];
    lines.extend((0..types.len()).map(|class| line(&["floor", &name(class)])));
    lines
}
