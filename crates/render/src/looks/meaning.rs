//! The meanings of sprite types in legends, derived from the rules.

use super::figure::Form;
use super::glyph::{Glyph, is_avatar, is_spoilt};
use super::{openings, payments, remarks, touches, wins};
use engine::analysis::{Attainable, Condition, EffectSummary, Encounter, Harm, Key, Motion, Role, Side};
use engine::{Analysis, Direction, SpriteType};

/// The note on a type that does nothing to the avatar.
const HARMLESS: &str = "harmless";

/// Describes the number of the type's sprites that ends the game, if there is one: `2 win`, `one, and you lose`. If
/// one number wins and another loses, both are stated.
fn ending(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let mut endings: Vec<(bool, String)> = Vec::new();
    for (at, goal) in analysis.goals().iter().enumerate() {
        let (degree, types, limit) = match &goal.condition {
            Condition::AtLeast(types, limit) => ("", types, limit),
            Condition::Exactly(types, limit) if !goal.win && analysis.only_falls(types) => {
                ("only ", types, limit)
            }
            Condition::Exactly(types, limit) => ("exactly ", types, limit),
            Condition::AtMost(..) | Condition::Tick(_) => continue,
        };
        let is_real = if goal.win && !goal.is_open() {
            wins::can_win(analysis, at)
        } else {
            goal.attainable != Attainable::Never
        };
        if *limit <= 0 || !types.contains(&stype) || !is_real {
            continue;
        }
        let count = format!("{degree}{limit}{}", if types.len() > 1 { " in all" } else { "" });
        let text = match (goal.win, count.as_str()) {
            _ if goal.is_open() => format!("{count} may win or lose"),
            (true, "1") => "one wins".to_owned(),
            (true, count) => format!("{count} win"),
            (false, "1") => "one, and you lose".to_owned(),
            (false, count) => format!("{count}, and you lose"),
        };
        endings.push((!goal.win, text));
    }
    endings.sort_by_key(|(loses, _)| *loses);
    endings.dedup_by_key(|(loses, _)| *loses);
    let texts: Vec<String> = endings.into_iter().map(|(_, text)| text).collect();
    (!texts.is_empty()).then(|| texts.join("; "))
}

/// Describes the effect on the avatar of an item that no rule requires.
fn gain(analysis: &Analysis, stype: SpriteType) -> String {
    let touches = || analysis.avatars().iter().map(|avatar| analysis.touch(avatar.stype, stype));
    let points = || {
        let best = touches().map(|touch| touch.score).max();
        let taken = touches().any(|touch| touch.ends_other() || touch.opens.contains(&stype));
        let worth = if taken { "take it for points" } else { "touch it for points" };
        best.filter(|score| *score > 0).map(|_| worth.to_owned())
    };
    let locked = || {
        let is_own = |lock: &&engine::analysis::Lock| lock.stype == stype;
        analysis.locks().iter().find(is_own).and_then(|_| requirement(analysis, stype))
    };
    touches::becomes(analysis, stype)
        .or_else(|| touches::health(analysis, stype))
        .or_else(|| payments::paid_here(analysis, stype))
        .or_else(|| touches::changes(analysis, stype))
        .or_else(|| touches::makes(analysis, stype))
        .or_else(locked)
        .or_else(|| {
            Some(format!(
                "touch it to change {}",
                remarks::names(analysis, &touches::opened(analysis, stype))?
            ))
        })
        .or_else(|| {
            Some(format!("gives {}", touches::given(analysis, stype)?))
                .filter(|_| !is_resource(analysis, stype))
        })
        .or_else(points)
        .unwrap_or_else(|| Glyph::Gem.meaning().to_owned())
}

fn is_resource(analysis: &Analysis, stype: SpriteType) -> bool {
    analysis.facts(stype).is_resource
}

/// Describes how a motionless type affects other sprites that reach it. It may remove sprites that must disappear for
/// the win, or change all sprites of a type. Rules about sprites that neither move nor are shot are omitted, because
/// such sprites cannot reach the type. Returns `None` if the type has no such effect.
fn use_of_others(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let game = analysis.game();
    let brought = |taken: &&SpriteType| {
        wins::is_to_go(analysis, **taken)
            && !wins::is_to_keep(analysis, **taken)
            && !wins::is_in_vain(analysis, **taken, stype)
    };
    if let Some(taken) = remarks::swallowed(analysis, stype).iter().find(brought) {
        return Some(format!("bring {} here to win", game.name(*taken)));
    }
    let comes = |other: &SpriteType| {
        let is_shot = analysis.role(*other) == Role::Shot && analysis.facts(*other).possible;
        is_shot || remarks::moves(analysis, *other)
    };
    game.sprite_types().filter(comes).find_map(|other| {
        let met = analysis.between(stype, other).chain(analysis.between(other, stype));
        let (verb, changed) = met.flat_map(|encounter| &encounter.effects).find_map(|effect| {
            let (verb, of) = match effect {
                EffectSummary::BecomeAll(from, _) => ("changes", *from),
                EffectSummary::KillAll(of) => ("removes", *of),
                _ => return None,
            };
            let is_thing = analysis.facts(of).possible && !is_avatar(analysis, of);
            is_thing.then_some((verb, of))
        })?;
        Some(format!("{} here {verb} {}", game.name(other), game.name(changed)))
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

/// Describes how sprites of a type move. Returns an empty text for motionless types.
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

/// Describes a lock's requirement: `needs 3 shell`, `opened by bell`, `only as laden`; `None` if the type is not a
/// lock.
fn requirement(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let game = analysis.game();
    let lock = analysis.locks().iter().find(|lock| lock.stype == stype)?;
    Some(match lock.key {
        Key::Resource { resource, amount, .. } => {
            let keys = payments::keys(analysis, stype);
            let keys = if keys.is_empty() { vec![(resource, amount)] } else { keys };
            format!("needs {}", wins::alternatives(analysis, &keys))
        }
        Key::Avatar(avatar) => format!("only as {}", game.name(avatar)),
        Key::Switch(switch, _) if openings::alternates(analysis, switch, stype) => {
            "solid for a while".to_owned()
        }
        Key::Switch(switch, None) if analysis.role(switch) == Role::Floor => "solid as it is".to_owned(),
        Key::Switch(switch, Some(pushed)) => {
            let verb = openings::opening_verb(analysis, stype);
            format!("{verb} by {} on {}", game.name(pushed), game.name(switch))
        }
        Key::Switch(switch, None) => {
            format!("{} by {}", openings::opening_verb(analysis, stype), game.name(switch))
        }
    })
}

/// Returns the meaning of a solid type: either the type whose state it represents, or the means of opening or
/// removing it.
fn solid(analysis: &Analysis, stype: SpriteType) -> String {
    let own = touches::opened(analysis, stype);
    if let Some(names) = remarks::names(analysis, &own) {
        return format!("touch it to change {names}");
    }
    let cleared = remarks::names(analysis, &remarks::clearers(analysis, stype));
    if let Some(paid) = payments::paid_here(analysis, stype) {
        return match cleared {
            Some(clearers) => format!("{paid}, cleared by {clearers}"),
            None => format!("{paid}, solid"),
        };
    }
    if let Some(use_of) = use_of_others(analysis, stype) {
        return format!("solid, {use_of}");
    }
    let things = openings::opening_things(analysis, stype);
    if let Some(things) = remarks::names(analysis, &things) {
        return format!("{} by {things}", openings::opening_verb(analysis, stype));
    }
    if openings::changes_as_a_whole(analysis, stype) {
        let passing = openings::openers(analysis, stype).is_empty();
        return if passing { "solid for a while" } else { "solid as it is" }.to_owned();
    }
    if let Some(clearers) = cleared {
        return format!("solid, cleared by {clearers}");
    }
    if let Some(made) = touches::makes(analysis, stype).or_else(|| touches::health(analysis, stype)) {
        return format!("{made}, solid");
    }
    let changers = remarks::names(analysis, &remarks::reachable_removers(analysis, stype));
    let ends = |encounter: &Encounter| {
        openings::changes_all(encounter, stype)
            || (analysis.applies(encounter.first, stype) && encounter.ends(Side::First))
            || (encounter.second.is_some_and(|second| analysis.applies(second, stype))
                && encounter.ends(Side::Second))
    };
    match openings::earlier(analysis, stype) {
        _ if changers.is_some() => format!("solid, changed by {}", changers.unwrap_or_default()),
        _ if !analysis.turns(stype).is_empty() => "solid as it is".to_owned(),
        Some(from) => format!("was {}, solid", analysis.game().name(from)),
        None if analysis.encounters().iter().any(ends) || openings::is_timed(analysis, stype) => {
            "solid".to_owned()
        }
        None => Glyph::Wall.meaning().to_owned(),
    }
}

/// Returns the meaning of a type that must be touched for the win, with the condition under which the touch
/// counts.
fn goal(analysis: &Analysis, stype: SpriteType, meaning: &str) -> String {
    let Some((able, terms)) = wins::able(analysis, stype) else {
        return remarks::win_by_removing(analysis, stype).unwrap_or_else(|| unwon(analysis, stype));
    };
    let some = able.len() < analysis.avatars().len();
    let only = remarks::names(analysis, &able).filter(|_| some);
    let only = only.map_or(String::new(), |names| format!(", only as {names}"));
    let is_part = wins::is_one_of_several(analysis, stype) && meaning == Glyph::Exit.meaning();
    let meaning = if is_part { "part of the win" } else { meaning };
    format!("{meaning}{only}{}", terms.note(analysis))
}

/// Returns the meaning of a type that looks like a goal although no known way of winning involves it.
fn unwon(analysis: &Analysis, stype: SpriteType) -> String {
    if wins::is_to_go(analysis, stype) {
        return Glyph::Target.meaning().to_owned();
    }
    if wins::is_open(analysis, stype) {
        return "may win or lose the game".to_owned();
    }
    if wins::is_to_keep(analysis, stype) {
        return "too few left, and you lose".to_owned();
    }
    let touches = || analysis.avatars().iter().map(|avatar| analysis.touch(avatar.stype, stype));
    let taken = touches().any(|touch| touch.ends_other() || touch.gives.iter().any(|(_, by)| *by > 0));
    match requirement(analysis, stype) {
        Some(requirement) => requirement,
        None if taken => gain(analysis, stype),
        None => neutral(analysis, stype),
    }
}

/// Returns the types that create something forbidden when they reach sprites of `stype`.
fn spoilers(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    let brings = |effect: &EffectSummary| match effect {
        EffectSummary::Make(to) | EffectSummary::Become(to) => analysis.aims().prevent.contains(to),
        _ => false,
    };
    let spoils = |other: &SpriteType| {
        let facts = analysis.facts(*other);
        let mut met = analysis.between(*other, stype);
        facts.possible && facts.concrete && met.any(|encounter| encounter.does(brings))
    };
    analysis.game().sprite_types().filter(spoils).collect()
}

/// Returns the meaning of a type whose loss loses the game.
fn ward(analysis: &Analysis, stype: SpriteType) -> String {
    let protected = wins::is_to_keep(analysis, stype);
    // If a type is a state of a different type, the two are counted together.
    if let Some(from) =
        openings::earlier(analysis, stype).filter(|from| !analysis.aims().protect.contains(from))
    {
        return format!("was {}", analysis.game().name(from));
    }
    if !protected {
        return match remarks::names(analysis, &spoilers(analysis, stype)) {
            Some(spoilers) => format!("keep {spoilers} away"),
            None => unwon(analysis, stype),
        };
    }
    let touches = || analysis.avatars().iter().map(|avatar| analysis.touch(avatar.stype, stype));
    let kept = |to: SpriteType| wins::are_kept_together(analysis, stype, to);
    let taken = touches().any(|touch| touch.changes.is_some_and(kept))
        && touches().all(|touch| touch.removal == engine::analysis::Removal::Never);
    let wins = wins::able(analysis, stype).is_some();
    let use_of = match payments::purposes(analysis, stype) {
        _ if wins => Some("take it to win".to_owned()),
        Some(purpose) => Some(purpose),
        None => taken.then(|| "take it".to_owned()),
    };
    match use_of {
        Some(use_of) => format!("{use_of}, too few and you lose"),
        None => "too few left, and you lose".to_owned(),
    }
}

/// Returns the meaning of a resource that the avatar holds, or of a type that gives a key.
fn held(analysis: &Analysis, stype: SpriteType, meaning: &str) -> String {
    let is_held = is_resource(analysis, stype) && touches::given(analysis, stype).is_some();
    payments::purposes(analysis, stype)
        .or_else(|| touches::becomes(analysis, stype))
        .or_else(|| is_held.then(|| Glyph::Token.meaning().to_owned()).filter(|token| token == meaning))
        .unwrap_or_else(|| gain(analysis, stype))
}

/// Returns the meaning of a motionless type that has no other role.
fn neutral(analysis: &Analysis, stype: SpriteType) -> String {
    let state = || Some(format!("was {}", analysis.game().name(openings::earlier(analysis, stype)?)));
    let changed = || {
        let openers = openings::openers(analysis, stype).into_iter();
        let openers: Vec<SpriteType> =
            openers.filter(|&opener| analysis.role(opener) != Role::Floor).collect();
        Some(format!("changed by {}", remarks::names(analysis, &openers)?))
    };
    let swallowed =
        || Some(format!("swallows {}", remarks::names(analysis, &remarks::swallowed(analysis, stype))?));
    let switch = || {
        Some(format!("touch it to change {}", remarks::names(analysis, &touches::opened(analysis, stype))?))
    };
    let turned = || {
        let all = |effect: &EffectSummary| match effect {
            EffectSummary::BecomeAll(from, to) if *from == stype => Some(*to),
            _ => None,
        };
        let all = analysis.encounters().iter().flat_map(|encounter| encounter.effects.iter().filter_map(all));
        let turns = analysis.turns(stype).into_iter().map(|(to, _)| to).chain(all);
        let turns: Vec<SpriteType> = turns.filter(|to| analysis.facts(*to).possible).collect();
        Some(format!("may become {}", remarks::names(analysis, &turns)?))
    };
    ending(analysis, stype)
        .or_else(|| use_of_others(analysis, stype))
        .or_else(|| payments::paid_here(analysis, stype))
        .or_else(|| touches::becomes(analysis, stype))
        .or_else(|| touches::health(analysis, stype))
        .or_else(swallowed)
        .or_else(switch)
        .or_else(|| touches::makes(analysis, stype))
        .or_else(changed)
        .or_else(state)
        .or_else(|| blocks(analysis, stype).then(|| "solid".to_owned()))
        .or_else(turned)
        .unwrap_or_else(|| HARMLESS.to_owned())
}

/// Describes the harm that a moving type causes other than by touching the avatar. Such a type harms things that
/// matter, or makes sprites that do harm. An enemy may also take things whose use is unknown. Returns `None` if the
/// type causes no such harm.
fn mischief(analysis: &Analysis, stype: SpriteType, is_enemy: bool) -> Option<String> {
    let spoilt = remarks::spoilt_by(analysis, stype);
    let matters = |other: &SpriteType| {
        let role = analysis.role(*other);
        wins::is_to_keep(analysis, *other)
            || matches!(role, Role::Key | Role::Collectable | Role::Ward | Role::Pushable)
    };
    let is_object = |other: SpriteType| {
        use Role as R;
        !matches!(analysis.role(other), R::Shot | R::Wall | R::Breakable | R::Cover | R::Floor | R::Enemy)
    };
    let matters: Vec<SpriteType> = spoilt.iter().copied().filter(matters).collect();
    let takes = |types: &[SpriteType]| Some(format!("takes {}", remarks::names(analysis, types)?));
    let makes = || {
        let made = remarks::names(analysis, &analysis.facts(stype).makes);
        made.filter(|_| analysis.makes_harm(stype)).map(|made| format!("makes {made}"))
    };
    let spoils = || {
        let makes_bad = |encounter: &&Encounter| {
            let is_there = analysis.applies(encounter.first, stype)
                || encounter.second.is_some_and(|second| analysis.applies(second, stype));
            is_there
                && encounter.does(|effect| match effect {
                    EffectSummary::Make(to) | EffectSummary::Become(to) => {
                        analysis.aims().prevent.contains(to)
                    }
                    _ => false,
                })
        };
        analysis.encounters().iter().find(makes_bad).map(|_| "can lose you the game".to_owned())
    };
    let others: Vec<SpriteType> =
        spoilt.iter().copied().filter(|other| is_enemy && is_object(*other)).collect();
    payments::theft(analysis, stype)
        .or_else(|| takes(&matters))
        .or_else(|| takes(&others))
        .or_else(makes)
        .or_else(spoils)
}

/// Returns the meaning of a type that moves by itself.
fn mover(analysis: &Analysis, stype: SpriteType, glyph: Glyph, motion: &str) -> String {
    let harm = remarks::harm(analysis, stype).unwrap_or_else(|| {
        // An enemy that is harmless on contact does harm with the sprites that it makes, or to things that
        // must be kept.
        let is_enemy = matches!(glyph, Glyph::Enemy | Glyph::Charger | Glyph::HostileShot);
        let taken = analysis.role(stype) == Role::Collectable;
        match mischief(analysis, stype, is_enemy) {
            _ if is_spoilt(analysis, stype) => "keep it safe".to_owned(),
            Some(mischief) => mischief,
            None if taken => gain(analysis, stype),
            None => HARMLESS.to_owned(),
        }
    });
    let win = remarks::win_by_removing(analysis, stype);
    [Some(format!("{motion}, {harm}")), win].into_iter().flatten().collect::<Vec<_>>().join("; ")
}

/// Returns the meaning of a type that makes other sprites.
fn maker(analysis: &Analysis, stype: SpriteType) -> String {
    let Some(made) = remarks::names(analysis, &analysis.facts(stype).makes) else {
        return unwon(analysis, stype);
    };
    let switch = remarks::names(analysis, &touches::opened(analysis, stype));
    let parts = [
        Some(format!("makes {made}")),
        switch.map(|names| format!("touch it to change {names}")),
        blocks(analysis, stype).then(|| "solid".to_owned()),
        remarks::win_by_removing(analysis, stype),
    ];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// Returns the meaning of a type that the avatar places on the board, and that stays in its cell.
fn laid(analysis: &Analysis, stype: SpriteType, plain: &str) -> String {
    let made = remarks::names(analysis, &analysis.facts(stype).makes);
    let strikes = !remarks::spoilt_by(analysis, stype).is_empty();
    match made {
        Some(made) => format!("what you lay, makes {made}"),
        None if strikes || plain != Glyph::Blade.meaning() => plain.to_owned(),
        None => "what you lay".to_owned(),
    }
}

/// Returns the meaning of a type that can be hit by shots.
fn cover(analysis: &Analysis, stype: SpriteType) -> String {
    let stops = |shot: &SpriteType| {
        let dies = |side: Side| move |effect: &EffectSummary| *effect == EffectSummary::Kill(side);
        let is_shot =
            matches!(analysis.facts(*shot).motion, Motion::Straight(_)) || analysis.role(*shot) == Role::Shot;
        is_shot
            && (analysis.between(*shot, stype).any(|encounter| encounter.does(dies(Side::First)))
                || analysis.between(stype, *shot).any(|encounter| encounter.does(dies(Side::Second))))
    };
    if analysis.game().sprite_types().any(|shot| stops(&shot)) {
        return Glyph::Cover.meaning().to_owned();
    }
    match remarks::names(analysis, &remarks::removers(analysis, stype)) {
        Some(removers) => format!("removed by {removers}"),
        None => neutral(analysis, stype),
    }
}

/// Returns a type's meaning in legends: the meaning of its glyph (symbol), and the effects of its rules.
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
    let own = Some(own).filter(|own| remarks.is_empty() || own != HARMLESS);
    own.into_iter().chain(remarks).collect::<Vec<_>>().join(", ")
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
    let motion = motion(analysis, stype);
    let fleeting = analysis.facts(stype).fleeting;
    let is_prevented = analysis.aims().prevent.contains(&stype);
    if let Some(ending) = ending(analysis, stype).filter(|_| is_prevented) {
        let win = remarks::win_by_removing(analysis, stype);
        return [Some(ending), win].into_iter().flatten().collect::<Vec<_>>().join("; ");
    }
    match glyph {
        Glyph::Neutral if form == Form::Glyph(Glyph::Floor) => "ground".to_owned(),
        Glyph::Floor if !is_inert(analysis, stype) => "ground".to_owned(),
        Glyph::Enemy | Glyph::Charger | Glyph::Friend | Glyph::Raft if !motion.is_empty() => {
            mover(analysis, stype, glyph, &motion)
        }
        Glyph::HostileShot if analysis.harm(stype) == Harm::None => mover(analysis, stype, glyph, &motion),
        Glyph::Boulder if !falls(analysis, stype) => format!("{motion}, blocks"),
        Glyph::Portal if analysis.role(stype) != Role::Portal => neutral(analysis, stype),
        Glyph::Blade | Glyph::Bomb => laid(analysis, stype, glyph.meaning()),
        Glyph::Cover => cover(analysis, stype),
        Glyph::Prey => {
            let win = remarks::win_by_removing(analysis, stype).unwrap_or_else(|| unwon(analysis, stype));
            if motion.is_empty() { win } else { format!("{win}, {motion}") }
        }
        Glyph::Target | Glyph::Peril => {
            remarks::win_by_removing(analysis, stype).unwrap_or_else(|| unwon(analysis, stype))
        }
        Glyph::Neutral => neutral(analysis, stype),
        Glyph::Maker | Glyph::Nest => maker(analysis, stype),
        Glyph::Wall if fleeting => "solid for a while".to_owned(),
        Glyph::Wall | Glyph::Breakable => solid(analysis, stype),
        Glyph::Ward if fleeting => "soon gone".to_owned(),
        Glyph::Ward => ward(analysis, stype),
        Glyph::Switch => remarks::names(analysis, &touches::changed(analysis, stype))
            .map_or_else(|| unwon(analysis, stype), |names| format!("touch it to change {names}")),
        Glyph::Key | Glyph::Token => held(analysis, stype, glyph.meaning()),
        Glyph::Gem if blocks(analysis, stype) && !analysis.turns(stype).is_empty() => {
            "solid as it is".to_owned()
        }
        Glyph::Gem => gain(analysis, stype),
        Glyph::Spring if touches::given(analysis, stype).is_none() => unwon(analysis, stype),
        Glyph::Spring if blocks(analysis, stype) => {
            touches::given(analysis, stype).map_or_else(plain, |name| format!("gives {name}"))
        }
        Glyph::Socket | Glyph::Slot => {
            remarks::socket(analysis, stype).unwrap_or_else(|| unwon(analysis, stype))
        }
        Glyph::Crate => remarks::destinations(analysis, stype).unwrap_or_else(plain),
        Glyph::Exit | Glyph::Treasure => goal(analysis, stype, glyph.meaning()),
        Glyph::Gate => match requirement(analysis, stype) {
            // The description of the harm already includes the protection against it.
            Some(_) if is_guarded(analysis, stype) => remarks::harm(analysis, stype).unwrap_or_else(plain),
            Some(requirement) => requirement,
            None => plain(),
        },
        Glyph::Hazard => {
            let harm = remarks::harm(analysis, stype).unwrap_or_else(plain);
            match remarks::names(analysis, &remarks::clearers(analysis, stype)) {
                Some(clearers) => format!("{harm}, cleared by {clearers}"),
                None => harm,
            }
        }
        Glyph::Mire => remarks::harm(analysis, stype)
            .or_else(|| requirement(analysis, stype))
            .unwrap_or_else(|| neutral(analysis, stype)),
        _ => plain(),
    }
}

/// Returns `true` if sprites of the type fall, so that they can crush sprites below them.
fn falls(analysis: &Analysis, stype: SpriteType) -> bool {
    matches!(analysis.facts(stype).motion, Motion::Straight(direction) if direction == Direction::DOWN)
}

/// Returns `true` if no interaction and no termination involves the type.
fn is_inert(analysis: &Analysis, stype: SpriteType) -> bool {
    let meets = analysis.encounters().iter().any(|encounter| {
        analysis.applies(encounter.first, stype)
            || encounter.second.is_some_and(|second| analysis.applies(second, stype))
    });
    !meets && !analysis.goals().iter().any(|goal| goal.condition.types().contains(&stype))
}
