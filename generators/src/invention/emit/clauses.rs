//! A mechanic's clauses, with the names of types in place of ports, which are the mechanic's open roles.

use super::name;
use super::own_name;
use crate::GenerateError;
use crate::invention::genome::Invention;
use crate::invention::mechanic::{Mechanic, Origin};
use crate::invention::merge::Merged;
use crate::kernels::file::template::Template;
use engine::syntax::{self, InteractionLine, SpriteLine, TerminationLine, Word};
use std::collections::BTreeMap;

/// The clauses of one mechanic, with internal names.
pub(super) struct Clauses {
    pub(super) sprites: Vec<SpriteLine>,
    pub(super) before: Vec<InteractionLine>,
    pub(super) rules: Vec<InteractionLine>,
    pub(super) hero: Option<SpriteLine>,
    pub(super) terminations: Vec<TerminationLine>,
}

/// Reads a mechanic's clauses, and replaces its ports (open roles) with the names of the types that fill them.
pub(super) fn clauses(invention: &Invention, types: &[Merged], at: usize) -> Result<Clauses, GenerateError> {
    let mechanic = invention.mechanics[at];
    let values = &invention.values[at];
    let names = names_of(mechanic, types, at);
    let filled = |template: &Template| template.fill(values);
    let read = |sprites: &str, interactions: &str, terminations: &str| {
        let text = format!(
            "BasicGame\n{}{}{}{}",
            section("SpriteSet", sprites),
            section("LevelMapping", ". > floor"),
            section("InteractionSet", interactions),
            section("TerminationSet", terminations)
        );
        let (description, problems) = syntax::parse(&text);
        match problems.first() {
            Some(problem) => {
                Err(GenerateError::Unsuitable(format!("mechanic {}: {}", mechanic.name, problem.message)))
            }
            None => Ok(description.renamed(&names)),
        }
    };
    let first = read(&filled(&mechanic.sprites), &filled(&mechanic.before), &filled(&mechanic.terminations))?;
    let second = read("", &filled(&mechanic.rules), "")?;
    let class = mechanic.hero.as_ref().map(filled);
    let heroes = mechanic.heroes.as_ref().map(filled).unwrap_or_default();
    let hero = match class {
        None if heroes.is_empty() => None,
        class => {
            let children: String = heroes.lines().map(|line| format!("    {line}\n")).collect();
            let line = format!("hero > {}\n{children}", class.as_deref().unwrap_or("MovingAvatar"));
            let mut hero = read(&line, "", "")?.sprites.pop();
            // A state inherits the class of its group anyway.
            for line in hero.iter_mut() {
                let text = |line: &SpriteLine| line.class.as_ref().map(|class| class.text.clone());
                let class = text(line);
                line.children
                    .iter_mut()
                    .filter(|state| text(state) == class)
                    .for_each(|state| state.class = None);
            }
            hero
        }
    };
    Ok(Clauses {
        sprites: first.sprites,
        before: first.interactions,
        rules: second.interactions,
        hero,
        terminations: first.terminations,
    })
}

fn section(name: &str, lines: &str) -> String {
    let lines = lines.lines().filter(|line| !line.trim().is_empty());
    format!("    {name}\n{}", lines.map(|line| format!("        {line}\n")).collect::<String>())
}

/// Returns the internal names of the types that fill a mechanic's ports (open roles), and of the mechanic's own types.
pub(in crate::invention) fn names_of(
    mechanic: &Mechanic,
    types: &[Merged],
    at: usize,
) -> BTreeMap<String, String> {
    let class_of = |port: usize| {
        types
            .iter()
            .position(|merged| merged.ports.iter().any(|(id, _)| *id == (at, port)))
            .unwrap_or_default()
    };
    let ports =
        mechanic.ports.iter().enumerate().map(|(port, value)| (value.name.clone(), name(class_of(port))));
    let own = mechanic.types.iter().map(|own| (own.name.clone(), own_name(at, &own.name)));
    ports.chain(own).collect()
}

/// Extends the rules that other mechanics have for the type of a port (open role) to those states of the type that
/// still count as the type.
pub(super) fn extend_to_states(invention: &Invention, types: &[Merged], clauses: &mut [Clauses]) {
    for (at, mechanic) in invention.mechanics.iter().enumerate() {
        let names = names_of(mechanic, types, at);
        for own in &mechanic.types {
            let Origin::State { port, is_still: true, .. } = &own.origin else { continue };
            let Some(thing) = names.get(port) else { continue };
            let state = own_name(at, &own.name);
            for (_, other) in clauses.iter_mut().enumerate().filter(|(other, _)| *other != at) {
                extend(&mut other.before, thing, &state);
                extend(&mut other.rules, thing, &state);
            }
        }
    }
}

fn extend(lines: &mut Vec<InteractionLine>, thing: &str, state: &str) {
    let mut extended = Vec::new();
    for mut line in lines.drain(..) {
        if line.second.iter().any(|word| word.text == thing) {
            line.second.push(Word::from(state));
        }
        let again =
            (line.first.text == thing).then(|| InteractionLine { first: Word::from(state), ..line.clone() });
        extended.push(line);
        extended.extend(again);
    }
    *lines = extended;
}
