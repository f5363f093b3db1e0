//! Facts that players may know from the rules: the time left, what a win still needs, countdowns, and how sprites move.

use super::figure::Form;
use super::glyph::{Glyph, changes_speed, is_avatar, is_spoilt};
use engine::analysis::{Condition, EffectSummary, Encounter, Goal, Harm, Key, Motion, Role, Side};
use engine::{Analysis, Countdown, Event, Game, SpriteClass, SpriteType, State};

/// The facts about a game that captions show.
#[derive(Clone, Debug)]
pub(crate) struct Prospects {
    /// The tick at which the game ends, and `true` if it is won then.
    deadline: Option<(i32, bool)>,
    /// The counts that win, with the names that the terminations use.
    goals: Vec<(String, Goal)>,
    /// The resources of which several are required at once, with the required numbers.
    needed: Vec<(SpriteType, i32)>,
    counts_down: bool,
}

impl Prospects {
    pub(crate) fn of(analysis: &Analysis) -> Prospects {
        let (game, aims) = (analysis.game(), analysis.aims());
        let lost = aims.deadline.map(|tick| (tick, false));
        let deadline = lost.into_iter().chain(aims.survive.map(|tick| (tick, true))).min();
        let counted = |goal: &&Goal| goal.win && !goal.condition.types().is_empty();
        let goals = analysis.goals().iter().filter(counted);
        let goals = goals.map(|goal| (names(game, goal), goal.clone())).collect();
        let several = analysis.resources().iter().filter(|resource| resource.needed > 1);
        let needed = several.map(|resource| (resource.stype, resource.needed)).collect();
        let counts = |stype: SpriteType| {
            let facts = analysis.facts(stype);
            let is_a = |class| game.class(stype).is_some_and(|own| own.is_a(class));
            let lasts = is_a(SpriteClass::Flicker) && !facts.fleeting;
            let regular = is_a(SpriteClass::SpawnPoint) && !is_left_to_chance(game, stype);
            facts.possible && !facts.hidden && (regular || lasts)
        };
        let counts_down = game.sprite_types().any(counts);
        Prospects { deadline, goals, needed, counts_down }
    }

    /// Returns the number of a resource that some rule requires, if it is more than one.
    pub(crate) fn needed(&self, resource: &str, game: &Game) -> Option<i32> {
        let known = self.needed.iter().find(|(stype, _)| game.name(*stype) == resource);
        known.map(|(_, number)| *number)
    }

    /// Returns the resources of which several are required.
    pub(crate) fn required(&self) -> impl Iterator<Item = (SpriteType, i32)> + '_ {
        self.needed.iter().copied()
    }

    /// Returns a short description of the time left: `89 left`, or `survive 40`.
    pub(crate) fn time(&self, state: &State) -> Option<String> {
        let (limit, wins) = self.deadline?;
        let left = limit.saturating_sub(state.tick()).max(0);
        Some(if wins { format!("survive {left}") } else { format!("{left} left") })
    }

    pub(crate) fn has_goals(&self) -> bool {
        !self.goals.is_empty()
    }

    /// Returns a description of what a win still needs: `friend 1 of 3`, `exit 1 to go`.
    pub(crate) fn goals(&self, state: &State) -> String {
        let part = |(names, goal): &(String, Goal)| {
            let count = |stype| i32::try_from(state.alive(stype)).unwrap_or(i32::MAX);
            let now: i32 = goal.condition.types().iter().map(|&stype| count(stype)).sum();
            match goal.condition {
                Condition::AtLeast(_, limit) => format!("{names} {now} of {limit}"),
                Condition::Exactly(_, limit) if limit > 0 => format!("{names} {now} of {limit}"),
                _ => format!("{names} {} to go", goal.condition.missing(count, state.tick())),
            }
        };
        self.goals.iter().map(part).collect::<Vec<_>>().join(" or ")
    }

    pub(crate) fn counts_down(&self) -> bool {
        self.counts_down
    }

    /// Returns the next event of each type that counts down, if it comes before the time is up: `molehill acts in 4 (2 left)`,
    /// `fire ends in 3`.
    pub(crate) fn countdowns(&self, game: &Game, state: &State) -> String {
        let mut next: Vec<Countdown> = Vec::new();
        for found in game.countdowns(state) {
            let soon = |countdown: &Countdown| countdown.ticks.unwrap_or(i32::MAX);
            match next.iter_mut().find(|known| known.stype == found.stype) {
                Some(known) if soon(&found) < soon(known) => *known = found,
                Some(_) => {}
                None => next.push(found),
            }
        }
        let part = |countdown: &Countdown| {
            let name = game.name(countdown.stype);
            let left = countdown.left.map_or(String::new(), |left| format!(" ({left} left)"));
            match (countdown.ticks, countdown.event) {
                (Some(ticks), Event::Makes) => format!("{name} acts in {ticks}{left}"),
                (Some(ticks), Event::Ends) => format!("{name} ends in {ticks}"),
                (None, _) => format!("{name}{left}"),
            }
        };
        let left = self.deadline.map_or(i32::MAX, |(limit, _)| limit.saturating_sub(state.tick()));
        let told =
            |countdown: &&Countdown| countdown.ticks.map_or(countdown.left.is_some(), |ticks| ticks <= left);
        next.iter().filter(told).map(part).collect::<Vec<_>>().join(", ")
    }
}

/// Returns `true` if the line of a type specifies a probability and no total.
fn is_left_to_chance(game: &Game, stype: SpriteType) -> bool {
    let lines = game.description().sprite_lines();
    let line = lines.iter().find(|(_, line)| line.name.text == game.name(stype));
    let has = |key: &str| line.is_some_and(|(_, line)| line.params.iter().any(|param| param.key.text == key));
    has("prob") && !has("total")
}

/// Returns the names of the types that a termination counts, as written in the termination.
fn names(game: &Game, goal: &Goal) -> String {
    let line = &game.description().terminations[goal.line];
    let given = line.params.iter().filter(|param| param.key.text.starts_with("stype"));
    let given: Vec<String> = given.map(|param| param.value.text.replace(',', "+")).collect();
    given.join("+")
}

/// The maximum number of names in a meaning.
const NAMED: usize = 3;

/// Returns the types that are opened with a type, or paid for with it.
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

/// Returns the types of [`opened`], the types that are opened or paid for with `stype`, and the type whose speed it changes.
fn changed(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    let opened = opened(analysis, stype).into_iter();
    opened.chain(uses(analysis, stype)).chain(changes_speed(analysis, stype)).collect()
}

/// Returns the effect of a type's count, if some number of these sprites ends the game: `2 win`, `one, and you lose`.
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

/// Returns the resource that a type gives to the avatar.
fn given(analysis: &Analysis, stype: SpriteType) -> Option<&str> {
    let mut touches = analysis.avatars().iter().map(|avatar| analysis.touch(avatar.stype, stype));
    let resource = touches.find_map(|touch| touch.gives.iter().find(|(_, by)| *by > 0))?.0;
    Some(analysis.game().name(resource))
}

/// Returns a description of what the avatar becomes when it touches a type.
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

/// Returns a description of the avatar's benefit from a thing that no rule requires.
fn gain(analysis: &Analysis, stype: SpriteType) -> String {
    if let Some(effect) = becomes(analysis, stype).or_else(|| health(analysis, stype)) {
        return effect;
    }
    let touches = analysis.avatars().iter().map(|avatar| analysis.touch(avatar.stype, stype));
    match touches.map(|touch| touch.score).max() {
        Some(score) if score > 0 => "take it for points".to_owned(),
        _ => Glyph::Gem.meaning().to_owned(),
    }
}

/// Returns the types whose contact, with any sprite, changes all sprites of `stype`. Avatars, which come to the contact, and
/// types that turn into `stype` by themselves and back again, are excluded.
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

/// Returns `true` if a switch turns into the type that it opens, like a portal that is shut for some ticks.
fn alternates(analysis: &Analysis, switch: SpriteType, stype: SpriteType) -> bool {
    analysis.turns(switch).iter().any(|(becomes, _)| *becomes == stype)
}

/// Returns `true` if some encounter changes all sprites of a type at once.
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

/// Returns a description of how a still thing affects other sprites that come to it: it takes what must disappear for the win, or
/// changes all sprites of a type.
fn use_of_others(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let (game, wanted) = (analysis.game(), &analysis.aims().remove);
    let is_other = |other: SpriteType| analysis.facts(other).possible && !is_avatar(analysis, other);
    let others = || game.sprite_types().filter(|&other| is_other(other));
    let moves = |other: &SpriteType| {
        analysis.facts(*other).motion != Motion::Still || analysis.role(*other) == Role::Pushable
    };
    let takes = |other: &SpriteType| {
        let goes = |side: Side| move |effect: &EffectSummary| *effect == EffectSummary::Kill(side);
        analysis.between(*other, stype).any(|encounter| encounter.does(goes(Side::First)))
            || analysis.between(stype, *other).any(|encounter| encounter.does(goes(Side::Second)))
    };
    if let Some(taken) = others().find(|other| wanted.contains(other) && moves(other) && takes(other)) {
        return Some(format!("bring {} here", game.name(taken)));
    }
    others().find_map(|other| {
        let mut effects = analysis.between(stype, other).flat_map(|encounter| &encounter.effects);
        let changed = effects.find_map(|effect| {
            if let EffectSummary::BecomeAll(from, _) = effect { Some(*from) } else { None }
        })?;
        Some(format!("{} here changes {}", game.name(other), game.name(changed)))
    })
}

/// Returns the meaning of a type in legends: the meaning of its glyph, with its movement and harm.
pub(crate) fn meaning(analysis: &Analysis, stype: SpriteType, form: Form) -> String {
    let glyph = Glyph::of(analysis, stype);
    let game = analysis.game();
    let whom = |other: SpriteType| {
        if is_avatar(analysis, other) { "you".to_owned() } else { game.name(other).to_owned() }
    };
    let motion = match analysis.facts(stype).motion {
        Motion::Chasing(other) => format!("chases {}", whom(other)),
        Motion::Fleeing(other) => format!("flees from {}", whom(other)),
        Motion::Wandering => "wanders".to_owned(),
        Motion::Straight(_) => "goes straight on".to_owned(),
        Motion::Still | Motion::Steered => String::new(),
    };
    let harm = match analysis.harm(stype) {
        Harm::Kills => "deadly",
        Harm::Wounds => "wounds",
        Harm::Conditional => "deadly at times",
        Harm::None if is_spoilt(analysis, stype) => "keep it safe",
        // An enemy does harm in some other way: with what it makes, or to what must be kept.
        Harm::None if matches!(glyph, Glyph::Enemy | Glyph::Charger) => "harms",
        Harm::None => "harmless",
    };
    let named = |verb: &str, types: &[SpriteType]| {
        let mut names: Vec<&str> = types.iter().map(|&other| game.name(other)).collect();
        names.sort_unstable();
        names.dedup();
        names.truncate(NAMED);
        if names.is_empty() { glyph.meaning().to_owned() } else { format!("{verb} {}", names.join(", ")) }
    };
    let blocks = || {
        let avatars = analysis.avatars();
        !avatars.is_empty() && avatars.iter().all(|avatar| analysis.touch(avatar.stype, stype).blocks)
    };
    let state = || Some(format!("was {}", game.name(earlier(analysis, stype)?)));
    match glyph {
        _ if analysis.aims().prevent.contains(&stype) => {
            ending(analysis, stype).unwrap_or_else(|| glyph.meaning().to_owned())
        }
        Glyph::Neutral if form == Form::Glyph(Glyph::Floor) => "ground".to_owned(),
        Glyph::Enemy | Glyph::Charger | Glyph::Friend | Glyph::Raft if !motion.is_empty() => {
            format!("{motion}, {harm}")
        }
        Glyph::Prey if !motion.is_empty() => format!("{}, {motion}", glyph.meaning()),
        Glyph::Neutral if blocks() => "solid".to_owned(),
        Glyph::Neutral => use_of_others(analysis, stype)
            .or_else(|| becomes(analysis, stype))
            .or_else(|| health(analysis, stype))
            .or_else(state)
            .unwrap_or_else(|| harm.to_owned()),
        Glyph::Maker | Glyph::Nest if blocks() => format!("{}, solid", glyph.meaning()),
        Glyph::Wall if analysis.facts(stype).fleeting => "solid for a while".to_owned(),
        Glyph::Wall if !analysis.turns(stype).is_empty() => "solid as it is".to_owned(),
        Glyph::Wall if !opened(analysis, stype).is_empty() => {
            named("touch it to change", &opened(analysis, stype))
        }
        Glyph::Wall => match openers(analysis, stype) {
            none if none.is_empty() && changes_as_a_whole(analysis, stype) => "solid for a while".to_owned(),
            openers => named("opened by", &openers),
        },
        Glyph::Ward if analysis.facts(stype).fleeting => "soon gone".to_owned(),
        // A type that is a state of something else is counted with it.
        Glyph::Ward
            if earlier(analysis, stype).is_some_and(|from| !analysis.aims().protect.contains(&from)) =>
        {
            state().unwrap_or_default()
        }
        Glyph::Ward if analysis.aims().protect.contains(&stype) => "too few left, and you lose".to_owned(),
        Glyph::Ward => "others can spoil it".to_owned(),
        Glyph::Switch => named("touch it to change", &changed(analysis, stype)),
        Glyph::Key | Glyph::Token => named("needed for", &uses(analysis, stype)),
        Glyph::Gem if blocks() && !analysis.turns(stype).is_empty() => "solid as it is".to_owned(),
        Glyph::Gem => gain(analysis, stype),
        Glyph::Spring if blocks() => {
            given(analysis, stype).map_or_else(|| glyph.meaning().to_owned(), |name| format!("gives {name}"))
        }
        Glyph::Gate => match analysis.locks().iter().find(|lock| lock.stype == stype).map(|lock| &lock.key) {
            Some(Key::Resource { resource, amount: 1, .. }) => format!("needs {}", game.name(*resource)),
            Some(Key::Resource { resource, amount, .. }) => {
                format!("needs {amount} {}", game.name(*resource))
            }
            Some(Key::Switch(switch, _)) if alternates(analysis, *switch, stype) => {
                "solid for a while".to_owned()
            }
            Some(Key::Switch(switch, _)) => format!("opened by {}", game.name(*switch)),
            _ => glyph.meaning().to_owned(),
        },
        _ => glyph.meaning().to_owned(),
    }
}
