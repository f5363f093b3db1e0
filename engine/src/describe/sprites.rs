//! The behaviour of the sprites, the player's keys and the level characters, in words.

use super::words::{a, count, list, pace, percent};
use crate::analysis::{Analysis, Avatar, Motion, Role, Steering};
use crate::geometry::Direction;
use crate::rules::SpriteType;
use crate::rules::class::{ClassFamily, SpriteClass};

/// One line for each type that can occur and does something by itself, without avatars; the last line lists the types
/// that only stand there.
pub(super) fn sprites(analysis: &Analysis) -> Vec<String> {
    let game = analysis.game();
    let (mut lines, mut still) = (Vec::new(), Vec::new());
    for stype in game.sprite_types() {
        let facts = analysis.facts(stype);
        if !facts.possible || facts.motion == Motion::Steered {
            continue;
        }
        let parts = sprite(analysis, stype);
        if parts.is_empty() {
            still.push(game.name(stype));
        } else {
            lines.push(format!("The {} {}.", game.name(stype), parts.join("; ")));
        }
    }
    if !still.is_empty() {
        let stands = if still.len() == 1 { "only stands there" } else { "only stand there" };
        lines.push(format!("The {} {stands}.", list(&still, "and")));
    }
    lines
}

/// The behaviour of a type, without its name; empty for types that only stand there.
fn sprite(analysis: &Analysis, stype: SpriteType) -> Vec<String> {
    let info = &analysis.game().0.types[stype.index()];
    let facts = analysis.facts(stype);
    let traits = &info.traits;
    let name = |stype: SpriteType| analysis.game().name(stype);
    let speed = || step(traits);
    let mut parts = vec![match facts.motion {
        Motion::Still => String::new(),
        Motion::Straight(direction) => match direction_name(direction) {
            Some(direction) => format!("moves {direction}, {}", speed()),
            None if info.class == Some(SpriteClass::RandomMissile) => {
                format!("moves straight in a random direction, {}", speed())
            }
            None => format!("moves straight ahead, {}", speed()),
        },
        Motion::Wandering => format!("wanders at random, {}", speed()),
        Motion::Chasing(target) => format!("chases the nearest {}, {}", name(target), speed()),
        Motion::Fleeing(target) => format!("flees from the nearest {}, {}", name(target), speed()),
        Motion::Steered => "is steered by the player".to_owned(),
    }];
    if matches!(facts.motion, Motion::Chasing(_) | Motion::Fleeing(_)) && traits.max_distance >= 0.0 {
        parts.push(format!("within {} pixels", traits.max_distance));
    }
    if let (Some(class), false) = (info.class, facts.makes.is_empty()) {
        let made: Vec<String> = facts.makes.iter().map(|&made| a(name(made))).collect();
        let word = if class == SpriteClass::SpawnPointMultiSprite { "and" } else { "or" };
        parts.push(making(class, traits, &list(&made, word)));
    }
    if let Some(exit) = analysis.leads_to(stype).filter(|_| info.class == Some(SpriteClass::Portal)) {
        parts.push(format!("leads to {}", name(exit)));
    }
    if facts.is_resource {
        let each = if traits.value == 1 { String::new() } else { format!(", {} each", traits.value) };
        parts.push(format!("can be held, up to {}{each}", info.resource_limit));
    }
    if info.class.is_some_and(|class| class.is_a(SpriteClass::Flicker)) {
        parts.push(format!(
            "vanishes after {}",
            count(i64::from(traits.limit) - i64::from(traits.age) + 2, "tick")
        ));
    }
    if traits.time_to_live >= 0 {
        parts.push(format!("lives for {}", count(i64::from(traits.time_to_live) + 1, "tick")));
    }
    if traits.health != 0 {
        parts.push(format!("has {}", count(i64::from(traits.health), "health point")));
    }
    parts.retain(|part| !part.is_empty());
    if facts.singleton {
        let once = if parts.is_empty() { "exists only once at a time" } else { "only one exists at a time" };
        parts.push(once.to_owned());
    }
    if facts.hidden && analysis.role(stype) != Role::Floor {
        parts.push("cannot be seen".to_owned());
    }
    parts
}

fn making(class: SpriteClass, traits: &crate::rules::traits::Traits, made: &str) -> String {
    let chance = |probability: f64| match probability {
        certain if certain >= 1.0 => String::new(),
        probability => format!(", with a chance of {}", percent(probability)),
    };
    if class == SpriteClass::Spreader {
        return format!("spreads {made} to each side once{}", chance(traits.spread_probability));
    }
    let every = match traits.cooldown {
        1 => "every tick".to_owned(),
        ticks => format!("every {ticks} ticks"),
    };
    let total = match traits.total {
        total if total > 0 => format!(", {total} in all"),
        _ => String::new(),
    };
    format!("makes {made} {every}{}{total}", chance(traits.prob))
}

/// The speed of a sprite with these traits.
fn step(traits: &crate::rules::traits::Traits) -> String {
    if traits.continuous {
        return format!("{} pixels a tick", traits.speed);
    }
    // Active movement takes a speed of 0 for 1, passive movement one of −1.
    pace(if traits.speed <= 0.0 { 1.0 } else { traits.speed }, traits.cooldown.max(1))
}

fn direction_name(direction: Direction) -> Option<&'static str> {
    let names = [
        (Direction::UP, "up"),
        (Direction::LEFT, "left"),
        (Direction::DOWN, "down"),
        (Direction::RIGHT, "right"),
    ];
    names.iter().find(|(known, _)| *known == direction).map(|(_, name)| *name)
}

/// One line for each avatar: its place in the game, and its keys.
pub(super) fn controls(analysis: &Analysis) -> Vec<String> {
    let single = analysis.avatars().len() == 1;
    analysis.avatars().iter().map(|avatar| control(analysis, avatar, single)).collect()
}

fn control(analysis: &Analysis, avatar: &Avatar, single: bool) -> String {
    use ClassFamily as Family;
    use SpriteClass as C;
    let game = analysis.game();
    let info = &game.0.types[avatar.stype.index()];
    let name = game.name(avatar.stype);
    let class = info.class.unwrap_or(C::MovingAvatar);
    let keys = keys(class, avatar, info.traits.rotate_in_place, info.traits.continuous);
    let mut text = if single { format!("You are the {name}: {keys}") } else { format!("As {name}: {keys}") };
    let walks = !info.traits.continuous && class != C::NullAvatar && avatar.steering != Steering::Fixed;
    if walks && analysis.facts(avatar.stype).pace != 1.0 {
        text += &format!(", {}", step(&info.traits));
    }
    let shots: Vec<String> = avatar.shots.iter().map(|&shot| a(game.name(shot))).collect();
    text += &match (class, class.family()) {
        _ if shots.is_empty() => String::new(),
        (C::OngoingTurningAvatar, _) => format!("; you leave {} behind", list(&shots, "and")),
        (C::WizardAvatar, _) => format!("; the up key puts {} beside you", list(&shots, "and")),
        (C::ShootOnlyAvatar, _) => {
            let keys = ["left", "up", "right", "down", "use"].iter().zip(&shots);
            let keys: Vec<String> = keys.map(|(key, shot)| format!("the {key} key shoots {shot}")).collect();
            format!("; {}", keys.join(", "))
        }
        (C::FlakAvatar, _) => format!("; the use key puts {} where you are", shots[0]),
        (_, Family::Avatar) => format!("; the use key puts {} ahead of you", list(&shots, "or")),
        (_, Family::Thing | Family::Resource | Family::Flicker | Family::Missile) => String::new(),
        (_, Family::Npc | Family::Walker | Family::Producer) => String::new(),
    };
    if !avatar.ammo.is_empty() {
        let ammo: Vec<&str> = avatar.ammo.iter().map(|&ammo| game.name(ammo)).collect();
        text += &format!(" and costs {}", list(&ammo, "or"));
    }
    if info.traits.health != 0 {
        text += &format!("; you start with {}", count(i64::from(info.traits.health), "health point"));
    }
    text + "."
}

/// The function of the keys, except for shots.
fn keys(class: SpriteClass, avatar: &Avatar, turns_first: bool, continuous: bool) -> &'static str {
    use SpriteClass as C;
    match (class, avatar.steering) {
        (C::NullAvatar, _) => "no key does anything",
        (C::AimedAvatar, _) => "the up and down keys turn your aim",
        (C::CarAvatar, _) => "the left and right keys steer you, up and down choose forwards or backwards",
        (C::LanderAvatar, _) => "you fall; the left and right keys turn you, and up fires your engine",
        (C::BirdAvatar, _) => "you fall, and drift to the right; the use key lifts you",
        (C::OngoingTurningAvatar, _) => "you always move ahead; the arrow keys turn you to the sides",
        (_, Steering::Thrust) => {
            "the left and right keys turn you, up and down push you ahead or back, and you keep drifting"
        }
        (_, Steering::Jumping) => "you fall; the left and right keys walk you, and the use key jumps",
        (_, Steering::Fixed) => "you stay where you are",
        (_, Steering::FourWay) if continuous => "the arrow keys push you, and you keep drifting",
        (_, Steering::FourWay) if turns_first => {
            "an arrow key turns you that way, or moves you if you face it already"
        }
        (_, Steering::FourWay) => "the arrow keys move you up, left, down and right",
        (_, Steering::Horizontal) => "the arrow keys move you left and right",
        (_, Steering::Vertical) => "the arrow keys move you up and down",
        (_, Steering::Ongoing) => "you always move ahead; the arrow keys turn you",
        (_, Steering::Unsteered) => "you always move ahead; no key changes that",
    }
}

/// One line for each character that the game's levels can use, with the sprites that it places.
pub(super) fn legend(analysis: &Analysis) -> Vec<String> {
    let game = analysis.game();
    let used = |symbol: &u8| {
        let places = game.places(*symbol);
        let own = |stype: &SpriteType| analysis.facts(*stype).symbols.contains(symbol);
        !places.is_empty() && places.iter().any(own)
    };
    let line = |symbol: u8| {
        let names: Vec<&str> = game.places(symbol).iter().map(|&stype| game.name(stype)).collect();
        format!("{}  {}", char::from(symbol), names.join(", "))
    };
    (b'!'..=b'~').filter(used).map(line).collect()
}
