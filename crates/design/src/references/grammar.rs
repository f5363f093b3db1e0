//! Random games from a grammar of VGDL. All alternatives of a grammar rule are equally likely.

use super::Proposal;
use base::{Sampler, Seed};
use std::fmt::Write;

/// The minimum and maximum number of sprite types, besides the wall and the avatar.
const TYPES: (usize, usize) = (3, 6);
/// The minimum and maximum number of interactions.
const RULES: (usize, usize) = (5, 10);
/// The numbers of columns and rows in a level, including walls.
const SIZE: (usize, usize) = (12, 8);
/// The fraction of cells with a sprite, as numerator and denominator.
const FILLED: (usize, usize) = (1, 8);
/// The alternatives for an avatar. `T` stands for a random type.
const AVATARS: [&str; 4] = ["MovingAvatar", "HorizontalAvatar", "ShootAvatar stype=T", "FlakAvatar stype=T"];
/// The alternatives for any other type. The list is fixed, so that a new class does not change the designer.
const CLASSES: [&str; 14] = [
    "Immovable",
    "Passive",
    "Door",
    "Resource limit=3",
    "Flicker limit=5",
    "Missile orientation=LEFT",
    "Missile orientation=DOWN",
    "RandomNPC cooldown=2",
    "Chaser stype=T cooldown=2",
    "Fleeing stype=T cooldown=2",
    "PathChaser stype=T cooldown=3",
    "SpawnPoint stype=T cooldown=8",
    "Bomber stype=T orientation=RIGHT",
    "Portal stype=T",
];
/// The alternatives for an effect. The list is fixed, so that a new effect does not change the designer.
const EFFECTS: [&str; 16] = [
    "killSprite",
    "killSprite scoreChange=1",
    "killBoth",
    "stepBack",
    "undoAll",
    "turnAround",
    "reverseDirection",
    "bounceForward",
    "collectResource",
    "transformTo stype=T",
    "spawn stype=T",
    "cloneSprite",
    "wrapAround",
    "teleportToExit",
    "killIfHasLess resource=T limit=1",
    "killIfOtherHasMore resource=T limit=1",
];

pub(super) fn propose(levels: usize, seed: Seed) -> Proposal {
    let sampler = &mut seed.child("rules", 0).sampler();
    let types: Vec<String> =
        (0..sampler.between(TYPES.0, TYPES.1)).map(|number| format!("type{number}")).collect();
    let rules = rules(&types, sampler);
    let level = |number| level(types.len(), &mut seed.child("level", number as u64).sampler());
    Proposal { rules, levels: (0..levels).map(level).collect() }
}

fn rules(types: &[String], sampler: &mut Sampler) -> String {
    let mut text = "BasicGame\n    SpriteSet\n".to_owned();
    for name in types {
        let _ = writeln!(text, "        {name} > {}", drawn(&CLASSES, types, sampler));
    }
    let _ = writeln!(text, "        avatar > {}", drawn(&AVATARS, types, sampler));
    text += "    LevelMapping\n        w > wall\n        A > avatar\n";
    for (number, name) in types.iter().enumerate() {
        let _ = writeln!(text, "        {number} > {name}");
    }
    text += "    InteractionSet\n        avatar wall > stepBack\n";
    for _ in 0..sampler.between(RULES.0, RULES.1) {
        let (first, second) = (party(types, sampler), party(types, sampler));
        let _ = writeln!(text, "        {first} {second} > {}", drawn(&EFFECTS, types, sampler));
    }
    let counted = sampler.choose(types);
    text + &format!(
        "    TerminationSet\n        SpriteCounter stype={counted} limit=0 win=True\n        SpriteCounter stype=avatar \
         limit=0 win=False\n        Timeout limit=200 win=False\n"
    )
}

/// Draws an alternative, and replaces its `T` with a random type.
fn drawn(alternatives: &[&str], types: &[String], sampler: &mut Sampler) -> String {
    let chosen = *sampler.choose(alternatives);
    chosen.replace("=T", &format!("={}", sampler.choose(types)))
}

fn party<'a>(types: &'a [String], sampler: &mut Sampler) -> &'a str {
    let at = sampler.below(types.len() + 2);
    types.get(at).map_or(if at == types.len() { "avatar" } else { "wall" }, String::as_str)
}

fn level(types: usize, sampler: &mut Sampler) -> String {
    let (columns, rows) = SIZE;
    let avatar = (sampler.between(1, columns - 2), sampler.between(1, rows - 2));
    let mut text = String::new();
    for y in 0..rows {
        for x in 0..columns {
            let is_edge = x == 0 || y == 0 || x == columns - 1 || y == rows - 1;
            text.push(match (x, y) {
                _ if is_edge => 'w',
                at if at == avatar => 'A',
                _ if sampler.ratio(FILLED.0, FILLED.1) => (b'0' + sampler.below(types) as u8) as char,
                _ => ' ',
            });
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_floor_never_changes() {
        let drawn = |number| propose(2, Seed::from_text("grammar").child("draft", number));
        let (one, two) = (drawn(0), drawn(1));
        assert_ne!(one.rules, two.rules);
        let written = format!("{}{}", one.rules, one.levels.concat());
        let digest = base::Digest::of(written.as_bytes()).to_string();
        assert_eq!(&digest[..16], "5155e249469f4e45", "a changed designer needs a new name\n{written}");
    }
}
