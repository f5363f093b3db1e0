//! Describes the sprites' behaviour, the player's keys and the level characters in plain English.

use super::phrases::Phrase;
use super::swap::Swap;
use super::words::{Party, a, count, glide, list, pace, percent, plural};
use crate::analysis::{Analysis, Avatar, EffectSummary, Encounter, Motion, Precondition, Role, Steering};
use crate::numbers::geometry::Direction;
use crate::rules::SpriteType;
use crate::rules::class::{ClassFamily, SpriteClass};
use crate::rules::traits::Traits;

/// Returns one line for each possible non-avatar type whose sprites act on their own, followed by lines about
/// the remaining types.
pub(super) fn sprites(analysis: &Analysis) -> Vec<String> {
    let game = analysis.game();
    let (mut lines, mut is_all) = (Vec::new(), true);
    let betweens = Swap::betweens(analysis);
    for stype in game.sprite_types() {
        let facts = analysis.facts(stype);
        if !facts.possible || facts.motion == Motion::Steered || betweens.contains(&stype) {
            continue;
        }
        let parts = sprite(analysis, stype);
        is_all &= !parts.is_empty();
        if !parts.is_empty() {
            lines.push(format!("The {} {}.", game.name(stype), parts.join("; ")));
        }
    }
    if !is_all {
        lines.push(Phrase::Idle.with(&[]));
    }
    let walked_over = walked_over(analysis).filter(|stype| !betweens.contains(stype));
    let walked_over: Vec<&str> = walked_over.map(|stype| game.name(stype)).collect();
    if !walked_over.is_empty() {
        lines.push(Phrase::WalkOver.with(&[("names", &list(&walked_over, "and"))]));
    }
    lines
}

/// Returns the visible types, other than floors, whose sprites stand still and have no interaction with the player.
fn walked_over(analysis: &Analysis) -> impl Iterator<Item = SpriteType> + '_ {
    let avatars = analysis.avatars();
    let walks = avatars.iter().any(|avatar| avatar.steering != Steering::Fixed);
    let meets_you = move |stype: SpriteType| {
        avatars.iter().any(|avatar| {
            analysis
                .between(avatar.stype, stype)
                .chain(analysis.between(stype, avatar.stype))
                .next()
                .is_some()
        })
    };
    analysis.game().sprite_types().filter(move |&stype| {
        let facts = analysis.facts(stype);
        walks
            && facts.possible
            && facts.motion == Motion::Still
            && !facts.hidden
            && analysis.role(stype) != Role::Floor
            && !meets_you(stype)
    })
}

/// Returns the phrases about a type's behaviour, without the type's name. The list is empty for types that
/// merely stand still.
fn sprite(analysis: &Analysis, stype: SpriteType) -> Vec<String> {
    let info = &analysis.game().0.types[stype.index()];
    let facts = analysis.facts(stype);
    let traits = &info.traits;
    // Sprites of parent types never act on their own.
    let updated = info.class.filter(|class| info.order.is_some() && !class.is_avatar());
    let name = |stype: SpriteType| analysis.game().name(stype);
    let mut parts: Vec<String> =
        motion(analysis, stype).or_else(|| facing(analysis, stype)).into_iter().collect();
    if matches!(updated, Some(SpriteClass::RandomAltChaser | SpriteClass::RandomPathAltChaser)) {
        parts.push(Phrase::Strays.with(&[("chance", &percent(traits.epsilon))]));
    }
    if let (Some(class), false) = (info.class, facts.makes.is_empty()) {
        let made: Vec<String> = facts.makes.iter().map(|&made| a(name(made))).collect();
        let word = if class == SpriteClass::SpawnPointMultiSprite { "and" } else { "or" };
        parts.push(making(analysis, stype, class, &list(&made, word)));
    }
    if let Some(exit) = analysis.leads_to(stype).filter(|_| info.class == Some(SpriteClass::Portal)) {
        parts.push(Phrase::LeadsTo.with(&[("exit", name(exit))]));
    }
    if facts.is_resource {
        let value = traits.value.to_string();
        let each = if traits.value == 1 { String::new() } else { Phrase::Each.with(&[("value", &value)]) };
        let held = if analysis.can_exceed_limit(stype) { Phrase::HeldBeyond } else { Phrase::Held };
        parts.push(held.with(&[("limit", &info.resource_limit.to_string()), ("each", &each)]));
    }
    if updated.is_some_and(|class| class.is_a(SpriteClass::Flicker)) {
        parts.extend(vanishing(analysis, stype, i64::from(traits.limit) - i64::from(traits.age) + 2));
    }
    if updated.is_some() && traits.time_to_live >= 0 {
        parts.extend(vanishing(analysis, stype, i64::from(traits.time_to_live) + 1));
    }
    if traits.health != 0 {
        let points = count(i64::from(traits.health), "health point");
        let most = most_health(analysis, traits);
        parts.push(Phrase::Health.with(&[("points", &points), ("most", &most)]));
    }
    if facts.singleton && !is_made_regardless(analysis, stype) {
        let phrase = if parts.is_empty() { Phrase::SingleOnly } else { Phrase::Single };
        parts.push(phrase.with(&[]));
    }
    if facts.hidden && analysis.role(stype) != Role::Floor {
        parts.push(Phrase::Hidden.with(&[]));
    }
    parts
}

fn motion(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let info = &analysis.game().0.types[stype.index()];
    let traits = &info.traits;
    let pace = step(analysis, traits);
    let near = distance(analysis, traits).map(|distance| Phrase::Near.with(&[("distance", &distance)]));
    let near = near.unwrap_or_default();
    let following = |phrase: Phrase, target: SpriteType| {
        let party = Party::of(analysis, target);
        let target =
            if party.you { party.name } else { format!("the nearest {}", analysis.game().name(target)) };
        phrase.with(&[("target", &target), ("near", &near), ("pace", &pace)])
    };
    Some(match analysis.facts(stype).motion {
        Motion::Still if analysis.is_set_off(stype) => Phrase::SetOff.with(&[]),
        Motion::Still | Motion::Steered => return None,
        Motion::Straight(_) if !traits.is_oriented && traits.falls() => Phrase::Falls.with(&[]),
        Motion::Straight(direction) => match direction_name(direction) {
            Some(way) if is_turned(analysis, stype) => {
                Phrase::MovesFirstTo.with(&[("way", way), ("pace", &pace)])
            }
            Some(way) => Phrase::MovesTo.with(&[("way", way), ("pace", &pace)]),
            None if info.class == Some(SpriteClass::RandomMissile) => {
                Phrase::MovesAnyWay.with(&[("pace", &pace)])
            }
            None => Phrase::MovesAhead.with(&[("pace", &pace)]),
        },
        Motion::Wandering
            if info.class == Some(SpriteClass::RandomNPC) && traits.cons == 0 && !traits.continuous =>
        {
            Phrase::WandersAnew.with(&[("pace", &pace)])
        }
        Motion::Wandering => Phrase::Wanders.with(&[("pace", &pace)]),
        Motion::Chasing(target) => following(chase(info.class), target),
        Motion::Fleeing(target) => following(Phrase::Flees, target),
    })
}

/// Returns a phrase for the direction that a sign faces; `None` if it faces none.
fn facing(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let way = direction_name(analysis.sign(stype)?)?;
    let is_pushed = |encounter: &Encounter| {
        analysis.applies(encounter.first, stype) && encounter.does(|effect| *effect == EffectSummary::Push)
    };
    let phrase = if is_turned(analysis, stype) {
        Phrase::FacesFirst
    } else if analysis.encounters().iter().any(is_pushed) {
        Phrase::FacesPush
    } else {
        Phrase::Faces
    };
    Some(phrase.with(&[("way", way)]))
}

/// Returns the phrase for how sprites of a class chase.
pub(super) fn chase(class: Option<SpriteClass>) -> Phrase {
    use SpriteClass as C;
    match class {
        Some(C::PathChaser | C::PathAltChaser | C::RandomPathAltChaser) => Phrase::Follows,
        Some(C::LOSChaser) => Phrase::LooksOut,
        _ => Phrase::Chases,
    }
}

/// Returns the distance within which a sprite chases or flees, if the distance is limited.
pub(super) fn distance(analysis: &Analysis, traits: &Traits) -> Option<String> {
    let far = traits.max_distance;
    (far >= 0.0).then(|| match analysis.game().0.square_size {
        Some(block) if !traits.continuous => {
            format!("{} cells, columns plus rows", (far / f64::from(block.max(1))).floor())
        }
        _ => format!("{far} pixels"),
    })
}

/// Returns `true` if sprites that move in a fixed direction can be turned, or can be created from sprites
/// that face a different direction.
fn is_turned(analysis: &Analysis, stype: SpriteType) -> bool {
    let into =
        |effect: &EffectSummary| effect.makes().contains(&stype) && !matches!(effect, EffectSummary::Make(_));
    let turns = |encounter: &Encounter| {
        let is_own = analysis.applies(encounter.first, stype);
        encounter.does(|effect| into(effect) || (is_own && *effect == EffectSummary::Turn))
    };
    analysis.encounters().iter().any(turns)
}

/// Returns two flags about the sprites of a type that are created during an episode. The first is `true` if
/// some of them are updated in the tick in which they appear, and the second if some are not.
pub(super) fn is_updated_at_once(analysis: &Analysis, stype: SpriteType) -> (bool, bool) {
    let rules = &analysis.game().0;
    let order = |stype: SpriteType| rules.types[stype.index()].order;
    let makes = |maker: &SpriteType| {
        let facts = analysis.facts(*maker);
        facts.possible && facts.makes.contains(&stype)
    };
    // A sprite created by an avatar, or by a type that is updated earlier in the tick, is itself updated in
    // that tick.
    let at_once =
        |maker: SpriteType| analysis.facts(maker).motion == Motion::Steered || order(maker) > order(stype);
    let makers: Vec<bool> = analysis.game().sprite_types().filter(makes).map(at_once).collect();
    let by_rules = |encounter: &Encounter| {
        encounter.does(|effect| effect.makes().contains(&stype) || *effect == EffectSummary::Clone)
    };
    // Levels rarely place a type that is created during play, even if a character stands for it.
    let later = makers.is_empty() || makers.contains(&false) || analysis.encounters().iter().any(by_rules);
    (makers.contains(&true), later)
}

/// Returns, as text, the number of ticks from a sprite's appearance to its update with the index `updates`.
/// The text contains two numbers if the delay depends on how the sprite was created.
fn delay(analysis: &Analysis, stype: SpriteType, updates: i64) -> String {
    match is_updated_at_once(analysis, stype) {
        (true, true) => format!("{} or {}", (updates - 1).max(0), count(updates, "tick")),
        (true, false) => count((updates - 1).max(0), "tick"),
        (false, _) => count(updates, "tick"),
    }
}

/// Returns `true` if some effect creates sprites of a singleton type even if one already exists.
fn is_made_regardless(analysis: &Analysis, stype: SpriteType) -> bool {
    let all = |effect: &EffectSummary| matches!(effect, EffectSummary::BecomeAll(_, to) if *to == stype);
    let becomes = |effect: &EffectSummary| *effect == EffectSummary::Become(stype);
    // This condition identifies `transformIfCount`.
    let counting = |met: &Encounter| met.precondition == Precondition::Movement && met.does(becomes);
    analysis.any_effect(all) || analysis.encounters().iter().any(counting)
}

/// Returns the phrase about the limit on health points, in games where sprites can gain health points.
fn most_health(analysis: &Analysis, traits: &Traits) -> String {
    let gains = |effect: &EffectSummary| matches!(effect, EffectSummary::Health { by, .. } if *by > 0);
    let gained = analysis.encounters().iter().any(|encounter| encounter.does(gains));
    let limit = traits.limit_health.to_string();
    if gained { Phrase::Most.with(&[("limit", &limit)]) } else { String::new() }
}

/// Returns the phrase about a type whose sprites vanish after the given number of updates, if that happens
/// before the time limit.
fn vanishing(analysis: &Analysis, stype: SpriteType, updates: i64) -> Option<String> {
    let is_seen = updates <= analysis.game().time_limit().cast_signed();
    is_seen.then(|| Phrase::Vanishes.with(&[("ticks", &delay(analysis, stype, updates))]))
}

fn making(analysis: &Analysis, stype: SpriteType, class: SpriteClass, made: &str) -> String {
    let traits = &analysis.game().0.types[stype.index()].traits;
    let chance = |probability: f64| match probability {
        certain if certain >= 1.0 => String::new(),
        probability => format!(", with a chance of {}", percent(probability)),
    };
    if class == SpriteClass::Spreader {
        // A spreader spreads at age 2, in the order of `Direction::BASE`. If its type is a singleton, only
        // the first sprite appears.
        let delay = delay(analysis, stype, 2 - i64::from(traits.age));
        let chance = chance(traits.spread_probability);
        let is_single = analysis.facts(stype).makes.iter().any(|&made| analysis.facts(made).singleton);
        return match (is_single, chance.is_empty()) {
            (true, true) => Phrase::SpreadsUp.with(&[("made", made), ("delay", &delay)]),
            (true, false) => {
                Phrase::SpreadsOne.with(&[("made", made), ("delay", &delay), ("chance", &chance)])
            }
            (false, true) => Phrase::Spreads.with(&[("made", made), ("delay", &delay), ("chance", "")]),
            (false, false) => {
                let chance = format!("{chance} each");
                Phrase::Spreads.with(&[("made", made), ("delay", &delay), ("chance", &chance)])
            }
        };
    }
    let period = if traits.cooldown == 1 { "tick".to_owned() } else { count(traits.cooldown.into(), "tick") };
    // Producers that a level places start counting at their first update.
    let from = if traits.cooldown < 2 {
        String::new()
    } else if analysis.facts(stype).symbols.is_empty() {
        // For producers that appear later, the time of the first creation also depends on the tick in which
        // they appeared.
        Phrase::Soon.with(&[("period", &period)])
    } else {
        Phrase::From.with(&[])
    };
    let total = match traits.total {
        total if total > 0 => Phrase::Total.with(&[("total", &total.to_string())]),
        _ => String::new(),
    };
    Phrase::Makes.with(&[
        ("made", made),
        ("period", &period),
        ("from", &from),
        ("chance", &chance(traits.prob)),
        ("total", &total),
    ])
}

/// Returns, as text, the speed of a sprite with the given traits.
fn step(analysis: &Analysis, traits: &Traits) -> String {
    if traits.continuous {
        return format!("{} pixels a tick", traits.speed);
    }
    // A speed of 0 means 1 in active movement, and a speed of −1 means 1 in passive movement.
    let speed = if traits.speed <= 0.0 { 1.0 } else { traits.speed };
    let cooldown = traits.cooldown.max(1);
    if speed < 1.0 { glide(speed, cooldown, analysis.game().0.square_size) } else { pace(speed, cooldown) }
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

/// Returns one line for each avatar, with its name in the game and its keys.
pub(super) fn controls(analysis: &Analysis) -> Vec<String> {
    if analysis.avatars().is_empty() {
        return vec![Phrase::NoAvatar.with(&[])];
    }
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
        text += &format!(", {}", step(analysis, &info.traits));
    }
    let shots: Vec<String> = avatar.shots.iter().map(|&shot| a(game.name(shot))).collect();
    let made = |made: &str| [("made", made.to_owned()), ("cost", cost(analysis, avatar, class))];
    let told = |phrase: Phrase, text: &str| {
        let made = made(text);
        phrase.with(&made.each_ref().map(|(name, value)| (*name, value.as_str())))
    };
    text += &match (class, class.family()) {
        _ if shots.is_empty() => String::new(),
        (C::OngoingTurningAvatar, _) => told(Phrase::Leaves, &list(&shots, "and")),
        (C::WizardAvatar, _) => told(Phrase::Builds, &list(&shots, "and")),
        (C::ShootOnlyAvatar, _) => {
            let keys = ["left", "up", "right", "down", "use"].iter().zip(&shots);
            let keys: Vec<String> =
                keys.map(|(key, shot)| Phrase::KeyShoots.with(&[("key", key), ("made", shot)])).collect();
            format!("; {}", keys.join(", "))
        }
        (C::FlakAvatar, _) => told(Phrase::Drops, &shots[0]),
        (_, Family::Avatar) => {
            let turns = avatar.steering == Steering::FourWay
                && !info.traits.rotate_in_place
                && !info.traits.continuous
                && !info.traits.stationary
                && info.traits.cooldown < 2;
            let turns = if turns { Phrase::StillTurns.text() } else { "" };
            told(Phrase::Shoots, &list(&shots, "or")) + turns
        }
        (_, Family::Thing | Family::Resource | Family::Flicker | Family::Missile) => String::new(),
        (_, Family::Npc | Family::Walker | Family::Producer) => String::new(),
    };
    if info.traits.health != 0 {
        let points = count(i64::from(info.traits.health), "health point");
        let most = most_health(analysis, &info.traits);
        text += &Phrase::HasHealth.with(&[("points", &points), ("most", &most)]);
    }
    text + "."
}

/// Returns the phrase about the cost of a shot, if a shot costs anything.
fn cost(analysis: &Analysis, avatar: &Avatar, class: SpriteClass) -> String {
    let game = analysis.game();
    let traits = &game.0.types[avatar.stype.index()].traits;
    let each = if class == SpriteClass::FlakAvatar { traits.ammo_cost } else { 1 };
    let amount = |amount: i32, ammo: SpriteType| {
        let name = game.name(ammo);
        format!("{amount} {}", if amount == 1 { name.to_owned() } else { plural(name) })
    };
    let costs: Vec<String> = avatar.ammo.iter().map(|&ammo| amount(each, ammo)).collect();
    let costs = list(&costs, "or");
    match avatar.ammo.first() {
        None => String::new(),
        // The shot requires more ammunition than it costs.
        Some(&ammo) if class == SpriteClass::FlakAvatar && (traits.min_ammo > 0 || each != 1) => {
            let least = amount(traits.min_ammo.max(0), ammo);
            Phrase::CostsMore.with(&[("costs", &costs), ("least", &least)])
        }
        Some(_) => Phrase::Costs.with(&[("costs", &costs)]),
    }
}

/// Returns the phrase about the functions of the keys, except shooting.
fn keys(class: SpriteClass, avatar: &Avatar, turns_first: bool, continuous: bool) -> &'static str {
    use SpriteClass as C;
    match (class, avatar.steering) {
        (C::NullAvatar, _) => "no key does anything",
        (C::ShootOnlyAvatar, _) if continuous => "you drift, and no key steers you",
        (C::AimedAvatar, Steering::Thrust) => "the arrow keys move you, and up and down turn your aim",
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

/// Returns one line for each character that the game's levels can use, with the sprites that the character
/// places.
pub(super) fn legend(analysis: &Analysis) -> Vec<String> {
    let game = analysis.game();
    let used = |symbol: &u8| {
        let places = game.places(*symbol);
        let own = |stype: &SpriteType| analysis.facts(*stype).symbols.contains(symbol);
        !places.is_empty() && places.iter().any(own)
    };
    let line = |symbol: u8| {
        let names: Vec<&str> = game.places(symbol).iter().map(|&stype| game.name(stype)).collect();
        format!("{}  {}", game.character(symbol), names.join(", "))
    };
    (0..128).filter(used).map(line).collect()
}
