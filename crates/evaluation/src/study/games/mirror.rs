//! Recognises the left-right mirror image of a game (`docs/how-to/twins.md`).

use crate::mask;
use engine::syntax::SpriteLine;
use engine::{Description, Direction, Game};

/// Returns `true` if swapping left and right turns one game's rules into the other's, regardless of names.
pub(in crate::study) fn is_image(one: &Game, other: &Game) -> bool {
    let facing = |game: &Game| -> Vec<Direction> {
        let concrete = game.sprite_types().filter(|&stype| game.class(stype).is_some());
        concrete.map(|stype| game.orientation(stype)).collect()
    };
    let image: Vec<Direction> = facing(one).into_iter().map(direction).collect();
    let rules = |game: &Game, swap| mask::nameless(&undirected(game.description(), swap));
    image == facing(other) && rules(one, true) == rules(other, false)
}

/// Returns a level's canonical text with left and right swapped.
pub(in crate::study) fn level(text: &str) -> String {
    text.lines().map(|row| row.chars().rev().chain(['\n']).collect::<String>()).collect()
}

fn direction(direction: Direction) -> Direction {
    match direction {
        Direction::LEFT => Direction::RIGHT,
        Direction::RIGHT => Direction::LEFT,
        other => other,
    }
}

/// Returns the rules without the sprite types' orientations, which are compared in the compiled games. If
/// `swap` is `true`, exchanges left and right in the remaining rules.
fn undirected(rules: &Description, swap: bool) -> Description {
    let mut rules = rules.clone();
    sprites(&mut rules.sprites, swap);
    for line in rules.interactions.iter_mut().filter(|_| swap) {
        let planned = line.params.iter_mut().filter(|param| param.key.text == "ftype");
        for keyword in std::iter::once(&mut line.effect).chain(planned.map(|param| &mut param.value)) {
            exchange(&mut keyword.text, ["spawnLeft", "spawnRight"]);
        }
    }
    rules
}

fn sprites(lines: &mut [SpriteLine], swap: bool) {
    for line in lines {
        line.params.retain(|param| param.key.text != "orientation");
        for param in line.params.iter_mut().filter(|param| swap && param.key.text == "spawnorientation") {
            exchange(&mut param.value.text, ["LEFT", "RIGHT"]);
            exchange(&mut param.value.text, ["DLEFT", "DRIGHT"]);
        }
        sprites(&mut line.children, swap);
    }
}

/// Replaces each of two words with the other.
fn exchange(text: &mut String, [one, other]: [&str; 2]) {
    if text == one {
        other.clone_into(text);
    } else if text == other {
        one.clone_into(text);
    }
}
