//! The meanings of sprite types in legends, derived from the rules.

use super::figure::Form;
use super::glyph::{Glyph, changes_speed, is_avatar, is_spoilt};
use super::remarks;
use engine::analysis::{Condition, EffectSummary, Encounter, Goal, Harm, Key, Motion, Role};
use engine::{Analysis, SpriteType};

/// Returns the types that a type's sprites open, and the types that use up the resource that the type is or
/// gives.
fn uses(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    let gives = |givers: &[(SpriteType, i32)]| givers.iter().any(|(giver, _)| *giver == stype);
    let locks = analysis.locks().iter().filter(|lock| gives(&lock.givers)).map(|lock| lock.stype);
    let resources = analysis.resources().iter();
    let resources = resources.filter(|resource| resource.stype == stype || gives(&resource.givers));
    locks.chain(resources.flat_map(|resource| resource.takers.iter().map(|(taker, _)| *taker))).collect()
}

/// Returns the types whose sprites all disappear or change when the avatar touches `stype`.
fn opened(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    let avatars = analysis.avatars().iter();
    avatars.flat_map(|avatar| analysis.touch(avatar.stype, stype).opens.iter().copied()).collect()
}

/// Returns the types from [`opened`], the types that `stype` opens or pays for, and the type whose speed it
/// changes.
fn changed(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    let opened = opened(analysis, stype).into_iter();
    opened.chain(uses(analysis, stype)).chain(changes_speed(analysis, stype)).collect()
}

/// Returns a description of how a certain number of the type's sprites ends the game, if this is possible:
/// `2 win`, `one, and you lose`.
fn ending(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let mut goals: Vec<&Goal> = analysis.goals().iter().collect();
    goals.sort_by_key(|goal| !goal.win);
    goals.into_iter().find_map(|goal| {
        let (degree, types, limit) = match &goal.condition {
            Condition::AtLeast(types, limit) => ("", types, limit),
            Condition::Exactly(types, limit) if !goal.win && analysis.only_falls(types) => {
                ("only ", types, limit)
            }
            Condition::Exactly(types, limit) => ("exactly ", types, limit),
            Condition::AtMost(..) | Condition::Tick(_) => return None,
        };
        if *limit <= 0 || !types.contains(&stype) {
            return None;
        }
        let count = format!("{degree}{limit}{}", if types.len() > 1 { " in all" } else { "" });
        Some(match (goal.win, count.as_str()) {
            (true, "1") => "one wins".to_owned(),
            (true, count) => format!("{count} win"),
            (false, "1") => "one, and you lose".to_owned(),
            (false, count) => format!("{count}, and you lose"),
        })
    })
}

/// Returns the resource that the avatar receives from a type.
fn given(analysis: &Analysis, stype: SpriteType) -> Option<&str> {
    let mut touches = analysis.avatars().iter().map(|avatar| analysis.touch(avatar.stype, stype));
    let resource = touches.find_map(|touch| touch.gives.iter().find(|(_, by)| *by > 0))?.0;
    Some(analysis.game().name(resource))
}

/// Returns a description of what the avatar turns into when it touches a type.
fn becomes(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let mut touches = analysis.avatars().iter().map(|avatar| analysis.touch(avatar.stype, stype));
    let becomes = touches.find_map(|touch| touch.becomes)?;
    Some(format!("makes you {}", analysis.game().name(becomes)))
}

/// Returns a description for a type that changes the health of sprites that touch it, or `None`.
fn health(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let heals = |effect: &EffectSummary| matches!(effect, EffectSummary::Health { .. });
    let is_met = |second: Option<SpriteType>| second.is_some_and(|second| analysis.applies(second, stype));
    let mut encounters = analysis.encounters().iter();
    let changes = encounters.any(|encounter| is_met(encounter.second) && encounter.does(heals));
    changes.then(|| "changes your health".to_owned())
}

/// Returns a description of the avatar's benefit from an item that no rule requires.
fn gain(analysis: &Analysis, stype: SpriteType) -> String {
    if let Some(effect) = becomes(analysis, stype).or_else(|| health(analysis, stype)) {
        return effect;
    }
    let touches = || analysis.avatars().iter().map(|avatar| analysis.touch(avatar.stype, stype));
    if let Some(to) = touches().find_map(|touch| touch.changes) {
        return format!("becomes {} when touched", analysis.game().name(to));
    }
    match touches().map(|touch| touch.score).max() {
        Some(score) if score > 0 => "take it for points".to_owned(),
        _ => Glyph::Gem.meaning().to_owned(),
    }
}

/// Returns the types whose contact with any sprite changes all sprites of `stype`. Avatars are excluded,
/// because an avatar moves to the contact itself. Types that turn into `stype` by themselves and back again
/// are excluded, too.
fn openers(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    let opens =
        |effect: &EffectSummary| matches!(effect, EffectSummary::BecomeAll(from, _) if *from == stype);
    let thing = |encounter: &Encounter| match is_avatar(analysis, encounter.first) {
        true => encounter.second,
        false => Some(encounter.first),
    };
    let things = analysis.encounters().iter().filter(|encounter| encounter.does(opens)).filter_map(thing);
    things.filter(|&opener| !alternates(analysis, opener, stype)).collect()
}

/// Returns `true` if a switch turns into the type that it opens, like a portal that is closed for some
/// ticks.
fn alternates(analysis: &Analysis, switch: SpriteType, stype: SpriteType) -> bool {
    analysis.turns(switch).iter().any(|(becomes, _)| *becomes == stype)
}

/// Returns `true` if some encounter changes all sprites of a type together.
fn changes_as_a_whole(analysis: &Analysis, stype: SpriteType) -> bool {
    let changes =
        |effect: &EffectSummary| matches!(effect, EffectSummary::BecomeAll(from, _) if *from == stype);
    analysis.encounters().iter().any(|encounter| encounter.does(changes))
}

/// Returns the type of which `stype` is a later state.
fn earlier(analysis: &Analysis, stype: SpriteType) -> Option<SpriteType> {
    let possible = |from: SpriteType| analysis.facts(from).possible && !is_avatar(analysis, from);
    let change = |encounter: &Encounter| {
        encounter.effects.iter().find_map(|effect| match effect {
            EffectSummary::Become(to) if *to == stype => Some(encounter.first),
            EffectSummary::BecomeAll(from, to) if *to == stype => Some(*from),
            _ => None,
        })
    };
    analysis.encounters().iter().filter_map(change).find(|&from| possible(from))
}

/// Returns a description of how a motionless type affects other sprites that reach it. The type removes
/// sprites that must disappear for the win, or changes all sprites of a type. Rules about sprites that
/// neither move nor are shot are omitted, because such sprites cannot reach the type.
fn use_of_others(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let (game, wanted) = (analysis.game(), &analysis.aims().remove);
    if let Some(taken) = remarks::swallowed(analysis, stype).iter().find(|taken| wanted.contains(taken)) {
        return Some(format!("bring {} here to win", game.name(*taken)));
    }
    let comes = |other: &SpriteType| {
        let is_shot = analysis.role(*other) == Role::Shot && analysis.facts(*other).possible;
        is_shot || remarks::moves(analysis, *other)
    };
    game.sprite_types().filter(comes).find_map(|other| {
        let mut effects = analysis.between(stype, other).flat_map(|encounter| &encounter.effects);
        let changed = effects.find_map(|effect| {
            if let EffectSummary::BecomeAll(from, _) = effect { Some(*from) } else { None }
        })?;
        Some(format!("{} here changes {}", game.name(other), game.name(changed)))
    })
}

/// Returns the names of the types that a type chases or flees from, including `first`. The avatar is called
/// `you`.
fn targets(analysis: &Analysis, stype: SpriteType, first: SpriteType) -> String {
    let game = analysis.game();
    let lines = game.description().sprite_lines();
    let own = lines.iter().find(|(_, line)| line.name.text == game.name(stype));
    let mut params = own.into_iter().flat_map(|(_, line)| &line.params);
    let given = params.find(|param| matches!(param.key.text.as_str(), "stype" | "stype1"));
    let written = given.map_or("", |param| param.value.text.as_str());
    let written: Vec<SpriteType> =
        written.split(',').filter_map(|name| game.sprite_type(name.trim())).collect();
    let written = if written.contains(&first) { written } else { vec![first] };
    // A sprite with several types to chase draws one of them at a time.
    written.into_iter().map(|of| target(analysis, of)).collect::<Vec<_>>().join(" or ")
}

/// Returns the name of a type that others chase. If the type is a group that contains the avatar and other
/// types, its members are listed.
fn target(analysis: &Analysis, of: SpriteType) -> String {
    let game = analysis.game();
    if !is_avatar(analysis, of) {
        return game.name(of).to_owned();
    }
    let other = |&other: &SpriteType| {
        let facts = analysis.facts(other);
        analysis.applies(of, other) && facts.possible && facts.concrete && !is_avatar(analysis, other)
    };
    let others: Vec<SpriteType> = game.sprite_types().filter(other).collect();
    match remarks::names(analysis, &others) {
        Some(names) => format!("the nearest of you, {names}"),
        None => "you".to_owned(),
    }
}

/// Returns a description of how sprites of a type move, or an empty text for motionless types.
fn motion(analysis: &Analysis, stype: SpriteType) -> String {
    match analysis.facts(stype).motion {
        Motion::Chasing(other) => format!("chases {}", targets(analysis, stype, other)),
        Motion::Fleeing(other) => format!("flees from {}", targets(analysis, stype, other)),
        Motion::Wandering => "wanders".to_owned(),
        Motion::Straight(_) => "goes straight on".to_owned(),
        Motion::Still | Motion::Steered => String::new(),
    }
}

/// Returns `true` if a type stops every avatar.
fn blocks(analysis: &Analysis, stype: SpriteType) -> bool {
    let avatars = analysis.avatars();
    !avatars.is_empty() && avatars.iter().all(|avatar| analysis.touch(avatar.stype, stype).blocks)
}

/// Returns a lock's requirement: `needs 3 shell`, `opened by bell`, `only as laden`.
fn requirement(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let game = analysis.game();
    let lock = analysis.locks().iter().find(|lock| lock.stype == stype)?;
    Some(match lock.key {
        Key::Resource { resource, amount: 1, .. } => format!("needs {}", game.name(resource)),
        Key::Resource { resource, amount, .. } => format!("needs {amount} {}", game.name(resource)),
        Key::Avatar(avatar) => format!("only as {}", game.name(avatar)),
        Key::Switch(switch, _) if alternates(analysis, switch, stype) => "solid for a while".to_owned(),
        Key::Switch(switch, None) if analysis.role(switch) == Role::Floor => "solid as it is".to_owned(),
        Key::Switch(switch, Some(pushed)) => {
            format!("opened by {} on {}", game.name(pushed), game.name(switch))
        }
        Key::Switch(switch, None) => format!("opened by {}", game.name(switch)),
    })
}

/// Returns the types from [`openers`] that are not ground.
fn opening_things(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    openers(analysis, stype).into_iter().filter(|&opener| analysis.role(opener) != Role::Floor).collect()
}

/// Returns the meaning of a solid type: the type of which it is a state, or the means to open or remove it.
fn solid(analysis: &Analysis, stype: SpriteType) -> String {
    let own = opened(analysis, stype);
    if let Some(names) = remarks::names(analysis, &own) {
        return format!("touch it to change {names}");
    }
    let things = opening_things(analysis, stype);
    if let Some(things) = remarks::names(analysis, &things) {
        return format!("opened by {things}");
    }
    if changes_as_a_whole(analysis, stype) {
        let passing = openers(analysis, stype).is_empty();
        return if passing { "solid for a while" } else { "solid as it is" }.to_owned();
    }
    if let Some(removers) = remarks::names(analysis, &remarks::removers(analysis, stype)) {
        return format!("solid, cleared by {removers}");
    }
    match earlier(analysis, stype) {
        _ if !analysis.turns(stype).is_empty() => "solid as it is".to_owned(),
        Some(from) => format!("was {}, solid", analysis.game().name(from)),
        None => Glyph::Wall.meaning().to_owned(),
    }
}

/// Returns the meaning of a type that must be touched for the win.
fn goal(analysis: &Analysis, stype: SpriteType, meaning: &str) -> String {
    let touches =
        || analysis.avatars().iter().map(|avatar| (avatar.stype, analysis.touch(avatar.stype, stype)));
    if let Some(Key::Resource { .. } | Key::Avatar(_)) =
        analysis.locks().iter().find(|lock| lock.stype == stype).map(|lock| &lock.key)
        && touches().all(|(_, touch)| touch.changes.is_none())
        && let Some(requirement) = requirement(analysis, stype)
    {
        return format!("{meaning}, {requirement}");
    }
    let able = touches().filter(|(_, touch)| {
        touch.ends_other() || touch.makes.iter().any(|made| analysis.aims().create.contains(made))
    });
    let able: Vec<SpriteType> = able.map(|(avatar, _)| avatar).collect();
    match remarks::names(analysis, &able) {
        Some(names) if able.len() < analysis.avatars().len() => format!("{meaning}, only as {names}"),
        _ => meaning.to_owned(),
    }
}

/// Returns the meaning of a type whose loss loses the game.
fn ward(analysis: &Analysis, stype: SpriteType) -> String {
    let protected = analysis.aims().protect.contains(&stype);
    // A type that is a state of a different type is counted together with that type.
    if let Some(from) = earlier(analysis, stype).filter(|from| !analysis.aims().protect.contains(from)) {
        return format!("was {}", analysis.game().name(from));
    }
    let taken = analysis.avatars().iter().any(|avatar| {
        let touch = analysis.touch(avatar.stype, stype);
        touch.ends_other() || touch.gives.iter().any(|(_, by)| *by > 0)
    });
    let made = analysis.turns(stype).iter().any(|(to, _)| analysis.aims().create.contains(to));
    match (protected, remarks::names(analysis, &uses(analysis, stype))) {
        (true, Some(names)) => format!("needed for {names}, too few and you lose"),
        (true, None) if taken && made => "take it to win, too few and you lose".to_owned(),
        (true, None) if taken => "take it, too few and you lose".to_owned(),
        (true, None) => "too few left, and you lose".to_owned(),
        (false, _) => "others can spoil it".to_owned(),
    }
}

/// Returns the meaning of a resource that the avatar holds.
fn held(analysis: &Analysis, stype: SpriteType, meaning: &str) -> String {
    let mut needed = uses(analysis, stype);
    if needed.is_empty() {
        needed = remarks::requirers(analysis, stype);
    }
    let ammunition = remarks::names(analysis, &remarks::ammunition_for(analysis, stype));
    remarks::names(analysis, &needed)
        .map(|names| format!("needed for {names}"))
        .or_else(|| Some(format!("ammunition for {}", ammunition?)))
        .or_else(|| becomes(analysis, stype))
        .unwrap_or_else(|| meaning.to_owned())
}

/// Returns the meaning of a motionless type without another role.
fn neutral(analysis: &Analysis, stype: SpriteType) -> String {
    let state = || Some(format!("was {}", analysis.game().name(earlier(analysis, stype)?)));
    let changed = || {
        let openers = openers(analysis, stype).into_iter();
        let openers: Vec<SpriteType> =
            openers.filter(|&opener| analysis.role(opener) != Role::Floor).collect();
        Some(format!("changed by {}", remarks::names(analysis, &openers)?))
    };
    let swallowed =
        || Some(format!("swallows {}", remarks::names(analysis, &remarks::swallowed(analysis, stype))?));
    use_of_others(analysis, stype)
        .or_else(|| becomes(analysis, stype))
        .or_else(|| health(analysis, stype))
        .or_else(swallowed)
        .or_else(changed)
        .or_else(state)
        .or_else(|| blocks(analysis, stype).then(|| "solid".to_owned()))
        .unwrap_or_else(|| "harmless".to_owned())
}

/// Returns the meaning of a type that moves by itself.
fn mover(analysis: &Analysis, stype: SpriteType, glyph: Glyph, motion: &str) -> String {
    let harm = remarks::harm(analysis, stype).unwrap_or_else(|| {
        // An enemy that is harmless on contact does harm with the sprites that it makes, or to things that
        // must be kept.
        let is_enemy = matches!(glyph, Glyph::Enemy | Glyph::Charger);
        let kept = remarks::names(analysis, &remarks::spoilt_by(analysis, stype)).filter(|_| is_enemy);
        match kept {
            _ if is_spoilt(analysis, stype) => "keep it safe".to_owned(),
            Some(kept) => format!("takes {kept}"),
            None if is_enemy => "harms".to_owned(),
            None => "harmless".to_owned(),
        }
    });
    let wanted = analysis.aims().remove.contains(&stype);
    let win = wanted.then(|| remarks::win_by_removing(analysis, stype)).flatten();
    [Some(format!("{motion}, {harm}")), win].into_iter().flatten().collect::<Vec<_>>().join("; ")
}

/// Returns a type's meaning in legends: its glyph's meaning, and the effects of the rules.
pub(crate) fn meaning(analysis: &Analysis, stype: SpriteType, form: Form) -> String {
    let glyph = Glyph::of(analysis, stype);
    let own = own_meaning(analysis, stype, form, glyph);
    let mut remarks: Vec<String> = Vec::new();
    let harmful = "deadly";
    if let Some(harm) =
        remarks::harm(analysis, stype).filter(|harm| !own.contains(harm.as_str()) && !own.contains(harmful))
    {
        remarks.push(harm);
    }
    if matches!(glyph, Glyph::Portal | Glyph::Mire | Glyph::Hazard) {
        let swallowed = remarks::swallowed(analysis, stype);
        remarks.extend(remarks::names(analysis, &swallowed).map(|names| format!("swallows {names}")));
    }
    [own].into_iter().chain(remarks).collect::<Vec<_>>().join(", ")
}

/// Returns `true` if a resource or the avatar's current type protects the avatar from a harmful type.
fn is_guarded(analysis: &Analysis, stype: SpriteType) -> bool {
    let touches = || analysis.avatars().iter().map(|avatar| analysis.touch(avatar.stype, stype));
    analysis.harm(stype) != Harm::None
        && touches().any(|touch| touch.safe_with.is_some() || touch.harm == Harm::None)
}

/// Returns a type's meaning, excluding the harm caused by motionless types.
fn own_meaning(analysis: &Analysis, stype: SpriteType, form: Form, glyph: Glyph) -> String {
    let plain = || glyph.meaning().to_owned();
    let named = |verb: &str, types: &[SpriteType]| {
        remarks::names(analysis, types).map_or_else(plain, |names| format!("{verb} {names}"))
    };
    let motion = motion(analysis, stype);
    let fleeting = analysis.facts(stype).fleeting;
    match glyph {
        _ if analysis.aims().prevent.contains(&stype) => ending(analysis, stype).unwrap_or_else(plain),
        Glyph::Neutral if form == Form::Glyph(Glyph::Floor) => "ground".to_owned(),
        Glyph::Enemy | Glyph::Charger | Glyph::Friend | Glyph::Raft if !motion.is_empty() => {
            mover(analysis, stype, glyph, &motion)
        }
        Glyph::Prey => {
            let win = remarks::win_by_removing(analysis, stype).unwrap_or_else(plain);
            if motion.is_empty() { win } else { format!("{win}, {motion}") }
        }
        Glyph::Target | Glyph::Peril => {
            remarks::win_by_removing(analysis, stype).unwrap_or_else(|| Glyph::Target.meaning().to_owned())
        }
        Glyph::Neutral => neutral(analysis, stype),
        Glyph::Maker | Glyph::Nest => {
            let solid = if blocks(analysis, stype) { ", solid" } else { "" };
            format!("{}{solid}", named("makes", &analysis.facts(stype).makes))
        }
        Glyph::Wall if fleeting => "solid for a while".to_owned(),
        Glyph::Wall | Glyph::Breakable => solid(analysis, stype),
        Glyph::Ward if fleeting => "soon gone".to_owned(),
        Glyph::Ward => ward(analysis, stype),
        Glyph::Switch => named("touch it to change", &changed(analysis, stype)),
        Glyph::Key | Glyph::Token => held(analysis, stype, glyph.meaning()),
        Glyph::Gem if blocks(analysis, stype) && !analysis.turns(stype).is_empty() => {
            "solid as it is".to_owned()
        }
        Glyph::Gem => gain(analysis, stype),
        Glyph::Spring if blocks(analysis, stype) => {
            given(analysis, stype).map_or_else(plain, |name| format!("gives {name}"))
        }
        Glyph::Socket => remarks::socket(analysis, stype).unwrap_or_else(plain),
        Glyph::Crate => named("push it onto", &remarks::destinations(analysis, stype)),
        Glyph::Exit | Glyph::Treasure => goal(analysis, stype, glyph.meaning()),
        Glyph::Gate => match requirement(analysis, stype) {
            // The description of the harm includes the protection against it.
            Some(_) if is_guarded(analysis, stype) => remarks::harm(analysis, stype).unwrap_or_else(plain),
            Some(requirement) => requirement,
            None => plain(),
        },
        Glyph::Hazard => {
            let harm = remarks::harm(analysis, stype).unwrap_or_else(plain);
            match remarks::names(analysis, &remarks::removers(analysis, stype)) {
                Some(removers) => format!("{harm}, cleared by {removers}"),
                None => harm,
            }
        }
        Glyph::Mire => {
            remarks::harm(analysis, stype).or_else(|| requirement(analysis, stype)).unwrap_or_else(plain)
        }
        _ => plain(),
    }
}
