//! Variants of a game that differ in one rule.

use super::place::Place;
use crate::legend::EntryRole;
use base::Sampler;
use engine::describe::{Guide, interaction};
use engine::syntax::{Description, Param, SpriteLine, print_bare};
use engine::{Action, Analysis, Game};

/// A game with one changed rule.
pub(super) struct Variant {
    pub(super) game: Game,
    /// The source text of the game.
    pub(super) vgdl: String,
    /// The changed rule in plain English.
    pub(super) told: String,
}

/// The effects that can replace an interaction's effect.
const EFFECTS: [&str; 8] = [
    "killSprite",
    "killBoth",
    "stepBack",
    "bounceForward",
    "undoAll",
    "turnAround",
    "reverseDirection",
    "cloneSprite",
];

/// The classes that can replace a sprite type's class, each with its parameters.
const CLASSES: [(&str, &[(&str, &str)]); 9] = [
    ("Immovable", &[]),
    ("Missile", &[("orientation", "UP"), ("cooldown", "1")]),
    ("Missile", &[("orientation", "DOWN"), ("cooldown", "1")]),
    ("Missile", &[("orientation", "LEFT"), ("cooldown", "1")]),
    ("Missile", &[("orientation", "RIGHT"), ("cooldown", "1")]),
    ("Missile", &[("orientation", "UP"), ("cooldown", "2")]),
    ("Missile", &[("orientation", "DOWN"), ("cooldown", "2")]),
    ("Missile", &[("orientation", "LEFT"), ("cooldown", "2")]),
    ("Missile", &[("orientation", "RIGHT"), ("cooldown", "2")]),
];

/// A type's class is replaced only if the level starts with at most this many sprites of the type.
const MAX_SPRITES: usize = 8;

/// Draws a rule. Returns a question about it, and variants of the game that differ in that rule, in random order. Rules
/// about interactions are drawn from the interactions that apply during the actions.
pub(super) fn variants(
    place: Place<'_>,
    actions: &[Action],
    sampler: &mut Sampler,
) -> Option<(String, Vec<Variant>)> {
    let (about, mut variants) =
        if sampler.ratio(1, 2) { of_class(place, sampler)? } else { of_effect(place, actions, sampler)? };
    sampler.shuffle(&mut variants);
    Some((about, variants))
}

fn of_effect(place: Place<'_>, actions: &[Action], sampler: &mut Sampler) -> Option<(String, Vec<Variant>)> {
    let (_, fired) = place.record(place.rules(), actions);
    let lines: Vec<usize> = fired.into_iter().collect();
    let line = *lines.get(sampler.below(lines.len().max(1)))?;
    let own = place.rules().description();
    let change = |effect: &str| {
        let mut description = own.clone();
        let changed = &mut description.interactions[line];
        if changed.effect.text != effect {
            (changed.effect, changed.params) = (effect.into(), Vec::new());
        }
        let told = |analysis: &Analysis| interaction(analysis, line).join(" ");
        variant(&description, told)
    };
    let written = own.interactions[line].effect.text.as_str();
    let others = EFFECTS.into_iter().filter(|&effect| effect != written);
    let variants = std::iter::once(written).chain(others).filter_map(change).collect();
    Some(("The rules above lack one rule for sprites that meet. Which is it?".to_owned(), variants))
}

fn of_class(place: Place<'_>, sampler: &mut Sampler) -> Option<(String, Vec<Variant>)> {
    let own = place.rules().description();
    let lines = own.sprite_lines();
    let names = lines.iter().filter(|(_, line)| line.children.is_empty() && line.class.is_some());
    let names: Vec<&str> =
        names.map(|(_, line)| line.name.text.as_str()).filter(|name| is_mobile(place, name)).collect();
    let name = *names.get(sampler.below(names.len().max(1)))?;
    let change = |(class, params): (&str, &[(&str, &str)])| {
        let mut description = own.clone();
        let line = find(&mut description.sprites, name)?;
        line.class = Some(class.into());
        line.params.retain(|param| ["img", "color", "singleton", "speed"].contains(&param.key.text.as_str()));
        line.params.extend(params.iter().map(|(key, value)| Param::new(key, value)));
        let beginning = format!("The {name} ");
        let told = |analysis: &Analysis| {
            let sprites = Guide::from_analysis(analysis).sprites;
            let told = sprites.into_iter().find(|line| line.starts_with(&beginning));
            told.unwrap_or_else(|| format!("The {name} does not move by itself."))
        };
        variant(&description, told)
    };
    let about = format!("The rules above do not say how the {name} moves by itself. Which sentence is true?");
    Some((about, CLASSES.into_iter().filter_map(change).collect()))
}

/// Returns `true` if the level starts with a few sprites of the type, and the type is not an avatar, a wall or a floor.
fn is_mobile(place: Place<'_>, name: &str) -> bool {
    let entry = place.game.prompter.legend().entry(name);
    let is_thing = entry.is_some_and(|entry| matches!(entry.role, EntryRole::Thing | EntryRole::Scenery));
    let count = place.rules().sprite_type(name).map_or(0, |stype| place.level.start.alive(stype));
    is_thing && (1..=MAX_SPRITES).contains(&count)
}

fn find<'a>(lines: &'a mut [SpriteLine], name: &str) -> Option<&'a mut SpriteLine> {
    for line in lines {
        if line.name.text == name {
            return Some(line);
        }
        if let Some(found) = find(&mut line.children, name) {
            return Some(found);
        }
    }
    None
}

/// Compiles a changed game. Returns `None` if the game does not compile, or if the changed rule has no description.
fn variant(description: &Description, told: impl Fn(&Analysis) -> String) -> Option<Variant> {
    let game = Game::compile(description).ok()?;
    let told = told(&Analysis::of(&game));
    (!told.is_empty()).then(|| Variant { game, vgdl: print_bare(description), told })
}
