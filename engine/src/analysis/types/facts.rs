//! Properties of single sprite types: how their sprites move, which sprites they create, and whether they can
//! occur.

use crate::analysis::futures::{PossibleFutures, Start};
use crate::analysis::interactions::encounter::{EffectSummary, Encounter, Precondition, timed_effects};
use crate::numbers::geometry::Direction;
use crate::rules::class::{ClassFamily, SpriteClass};
use crate::rules::traits::Traits;
use crate::rules::{Rules, SpriteType};
use std::collections::BTreeSet;

/// The cell size in pixels on a board of typical size.
const USUAL_BLOCK: i32 = 40;

/// The movement of a type's sprites on their own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// The sprites do not move.
    Still,
    /// The sprites move straight ahead. [`Direction::NIL`] and [`Direction::NONE`] stand for a direction that
    /// is set later.
    Straight(Direction),
    /// The sprites move at random.
    Wandering,
    /// The sprites move towards the nearest sprite of a type.
    Chasing(SpriteType),
    /// The sprites move away from the nearest sprite of a type.
    Fleeing(SpriteType),
    /// The player moves the sprite.
    Steered,
}

/// The player's control over an avatar's movement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Steering {
    /// The player moves the avatar up, left, down and right.
    FourWay,
    /// The player moves the avatar left and right only.
    Horizontal,
    /// The player moves the avatar up and down only.
    Vertical,
    /// The avatar always moves ahead, and the player turns it.
    Ongoing,
    /// The avatar always moves ahead, and the player cannot turn it.
    Unsteered,
    /// The avatar stays in its cell, and the player aims and shoots.
    Fixed,
    /// The avatar turns and accelerates, and keeps its velocity.
    Thrust,
    /// The avatar falls, walks left and right on solid ground, and jumps or flaps.
    Jumping,
}

impl Steering {
    /// Returns `true` if the avatar stays in its cell unless a key moves it.
    pub(crate) fn waits_for_keys(self) -> bool {
        matches!(self, Steering::FourWay | Steering::Horizontal | Steering::Vertical | Steering::Fixed)
    }
}

/// A possible type of the player's avatar.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Avatar {
    /// The avatar's type.
    pub stype: SpriteType,
    /// The player's control over the avatar's movement.
    pub steering: Steering,
    /// The types created by the use key. The key creates the first type for which the avatar has ammunition.
    pub shots: Vec<SpriteType>,
    /// The resources that shots cost, one per type of shot.
    pub ammo: Vec<SpriteType>,
    /// `true` if a level can place the type, and `false` if it only results from a transformation.
    pub starts: bool,
}

impl Avatar {
    /// Returns `true` if the use key can have an effect.
    pub fn has_use(&self) -> bool {
        !self.shots.is_empty() || self.steering == Steering::Jumping
    }
}

/// The properties of a single sprite type.
#[derive(Clone, Debug, PartialEq)]
pub struct Facts {
    /// `true` if the type has a class, so that its sprites can exist.
    pub concrete: bool,
    /// `true` if sprites of the type can ever be on the board, either placed by a level or created by
    /// existing sprites. Levels are assumed not to use characters that the game leaves unused: see
    /// [`Analysis::can_exist`](crate::analysis::Analysis::can_exist).
    pub possible: bool,
    /// The level characters that place the type, sorted by the number of sprites that they place, then by
    /// character code.
    pub symbols: Vec<u8>,
    /// The motion of the type's sprites.
    pub motion: Motion,
    /// The initial speed in cells per tick, or 0 for types that do not move.
    pub pace: f64,
    /// The types that sprites of the type create by themselves or, for avatars, with the use key.
    pub makes: Vec<SpriteType>,
    /// The numbers of columns and rows that a sprite covers, extending right and down from the cell in which
    /// it is placed.
    pub span: (usize, usize),
    /// `true` if sprites of the type live for only a few ticks.
    pub fleeting: bool,
    /// `true` if at most one sprite of the type, including related singleton types in the SpriteSet, exists at a time.
    pub singleton: bool,
    /// `true` if the type can be held as a resource.
    pub is_resource: bool,
    /// `true` if sprites of the type are invisible to players.
    pub hidden: bool,
}

pub(crate) fn facts(rules: &Rules, encounters: &[Encounter]) -> Vec<Facts> {
    // Sprites with continuous physics move by pixels. If the game does not set the cell size, assume the
    // typical size.
    let block = f64::from(rules.square_size.unwrap_or(USUAL_BLOCK));
    let effects = || rules.effects.iter().map(|effect| &effect.summary);
    let takes_orientation = effects().any(|summary| summary.takes_orientation);
    let turns = effects().any(|summary| summary.turn.is_some() || summary.forces_orientation);
    let makers = rules.types.iter().filter_map(|info| Some(makes(info.class?, &info.traits)));
    let made: BTreeSet<SpriteType> = makers.flatten().collect();
    let mut facts: Vec<Facts> = rules
        .types
        .iter()
        .zip((0u16..).map(SpriteType))
        .map(|(info, stype)| {
            let traits = &info.traits;
            // Continuous physics also moves sprites that are not oriented, once they face some direction.
            let is_faced = takes_orientation || traits.continuous && (turns || made.contains(&stype));
            let oriented = traits.is_oriented || is_faced;
            let motion = info.class.map_or(Motion::Still, |class| motion(class, traits, oriented));
            let path = info.path.iter();
            Facts {
                concrete: info.class.is_some(),
                possible: false,
                symbols: Vec::new(),
                motion,
                pace: pace(motion, traits, block),
                makes: info.class.map_or(Vec::new(), |class| makes(class, traits)),
                span: traits.span(),
                fleeting: info.class.is_some_and(|c| c.is_a(SpriteClass::Flicker))
                    || traits.time_to_live >= 0,
                singleton: path.clone().any(|stype| rules.types[stype.index()].singleton),
                is_resource: traits.is_resource,
                hidden: traits.hidden || traits.invisible,
            }
        })
        .collect();
    for (symbol, types) in (0..=u8::MAX).zip(&rules.mapping) {
        if is_idle_default(rules, symbol) {
            continue;
        }
        for stype in types {
            let symbols = &mut facts[stype.index()].symbols;
            if !symbols.contains(&symbol) {
                symbols.push(symbol);
            }
        }
    }
    for fact in &mut facts {
        fact.symbols.sort_by_key(|&symbol| (rules.mapping[usize::from(symbol)].len(), symbol));
    }
    let placed = (0u16..).map(SpriteType).zip(&facts).filter(|(_, fact)| !fact.symbols.is_empty());
    let existing = placed.map(|(stype, _)| stype).collect();
    let start = Start { existing, scheduled: Start::scheduled(rules), ..Start::default() };
    let possible = PossibleFutures::of(rules, &facts, encounters, start).exists;
    for (fact, possible) in facts.iter_mut().zip(possible) {
        fact.possible = possible;
    }
    let start = Start { held: None, ..Start::of_any_level(rules) };
    let exists = PossibleFutures::of(rules, &facts, encounters, start).exists;
    let played = played(rules, &exists, encounters);
    for (at, (fact, info)) in facts.iter_mut().zip(&rules.types).enumerate() {
        // Sprites of parent types are never updated. Among avatars, only the player's avatar is updated, even
        // if its type is a parent.
        let updated =
            if info.class.is_some_and(SpriteClass::is_avatar) { played[at] } else { info.order.is_some() };
        if exists[at] && !updated {
            (fact.motion, fact.pace, fact.fleeting) = (Motion::Still, 0.0, false);
            fact.makes.clear();
        }
    }
    facts
}

/// Returns, for each type, whether the player's avatar can be of that type in at least one level, regardless of the
/// characters that the level uses. The avatar is determined when a level starts. From then on, the player controls
/// whatever the avatar turns into.
fn played(rules: &Rules, exists: &[bool], encounters: &[Encounter]) -> Vec<bool> {
    let is_avatar = |at: usize| rules.types[at].is_like_avatar() && exists[at];
    let mut played = vec![false; exists.len()];
    for stype in rules.mapping.iter().flatten() {
        played[stype.index()] |= rules.types[stype.index()].is_sought();
    }
    let any_avatar = |types: &[SpriteType]| types.iter().any(|stype| is_avatar(stype.index()));
    let mut note = |written: Option<SpriteType>, effects: &[EffectSummary]| {
        let tree = written.map_or(&[][..], |written| &*rules.types[written.index()].tree);
        for effect in effects {
            let turned = if let EffectSummary::BecomeAll(from, _) = effect {
                std::slice::from_ref(from)
            } else {
                tree
            };
            let turns = !matches!(effect, EffectSummary::Make(_)) && any_avatar(turned);
            for to in effect.makes().iter().filter(|_| turns) {
                played[to.index()] |= is_avatar(to.index());
            }
        }
    };
    encounters.iter().for_each(|encounter| note(Some(encounter.first), &encounter.effects));
    timed_effects(rules).iter().for_each(|(target, effects)| note(*target, effects));
    played
}

/// Returns `true` if the character has a meaning only because every game maps `w` and `A`, and this game does
/// not use the character. Either the game has a different avatar, or it neither declares nor mentions a wall.
fn is_idle_default(rules: &Rules, symbol: u8) -> bool {
    let stype = match symbol {
        b'w' => SpriteType(0),
        b'A' => SpriteType(1),
        _ => return false,
    };
    let is_written =
        |symbol: u8| rules.description.mapping.iter().any(|line| line.symbol == char::from(symbol));
    if is_written(symbol) {
        return false;
    }
    let is_other = |other: u8| other != symbol && (!matches!(other, b'w' | b'A') || is_written(other));
    let others = rules.mapping.iter().zip(0u8..).filter(|(_, other)| is_other(*other));
    let mut others = others.flat_map(|(types, _)| types);
    let is_avatar = |stype: SpriteType| rules.types[stype.index()].class.is_some_and(|c| c.is_avatar());
    if symbol == b'A' && is_avatar(stype) {
        return others.any(|&other| is_avatar(other));
    }
    let name = &rules.types[stype.index()].name;
    let is_declared = rules.description.sprite_lines().iter().any(|(_, line)| line.name.text == *name);
    !is_declared && !rules.referenced[stype.index()]
}

fn motion(class: SpriteClass, traits: &Traits, oriented: bool) -> Motion {
    use SpriteClass as C;
    let drifts = !traits.is_static && !traits.only_active && traits.speed != 0.0;
    // `stationary` merely prevents a sprite with grid physics from choosing its own moves.
    let walks = !traits.stationary || traits.continuous;
    let follows = class.is_a(C::Chaser) || class.is_a(C::AlternateChaser) || class == C::PathChaser;
    use ClassFamily as Family;
    match (class, class.family()) {
        (_, Family::Avatar) => Motion::Steered,
        _ if follows && walks => match traits.stypes.first().filter(|target| **target != SpriteType::NONE) {
            Some(&target) if traits.fleeing => Motion::Fleeing(target),
            Some(&target) => Motion::Chasing(target),
            None => Motion::Wandering,
        },
        (C::RandomNPC | C::RandomInertial | C::RandomBomber, _) if walks => Motion::Wandering,
        (_, Family::Walker) => Motion::Straight(traits.orientation),
        // A sprite without a direction of its own moves only if something gives it a direction.
        _ if drifts && traits.is_oriented => Motion::Straight(traits.orientation),
        _ if drifts && traits.falls() => Motion::Straight(Direction::DOWN),
        _ if drifts && oriented => Motion::Straight(traits.orientation),
        (_, Family::Thing | Family::Resource | Family::Flicker | Family::Missile) => Motion::Still,
        (_, Family::Npc | Family::Producer) => Motion::Still,
    }
}

fn pace(motion: Motion, traits: &Traits, block: f64) -> f64 {
    if motion == Motion::Still {
        return 0.0;
    }
    // A speed of 0 means 1 in active movement, and a speed of −1 means 1 in passive movement.
    let speed = if traits.speed <= 0.0 { 1.0 } else { traits.speed };
    let speed = if traits.continuous { speed / block } else { speed };
    speed / f64::from(traits.cooldown.max(1))
}

/// Returns the types that sprites of a class create when they are updated.
pub(crate) fn makes(class: SpriteClass, traits: &Traits) -> Vec<SpriteType> {
    use SpriteClass as C;
    let producer = class.is_a(C::SpawnPoint) || matches!(class, C::Spreader | C::SpawnPointMultiSprite);
    let shoots = class.is_a(C::ShootAvatar) || matches!(class, C::FlakAvatar | C::WizardAvatar);
    let made: &[SpriteType] = if producer || shoots { &traits.stypes } else { &[] };
    // The sprites left behind are walls unless the sprite type specifies a different type.
    let behind = traits.spawn_behind.or((class == C::OngoingTurningAvatar).then_some(SpriteType(0)));
    made.iter().copied().chain(behind).filter(|&stype| stype != SpriteType::NONE).collect()
}

/// Returns the possible types of the player's avatar: first the types that levels place, then the others,
/// with each group sorted by type. The list is empty if the engine finds no avatar among the placed types.
pub(crate) fn avatars(rules: &Rules, facts: &[Facts]) -> Vec<Avatar> {
    use ClassFamily as Family;
    use SpriteClass as C;
    let mut avatars: Vec<Avatar> = Vec::new();
    for (info, (fact, at)) in rules.types.iter().zip(facts.iter().zip(0u16..)) {
        let plays =
            |class: &SpriteClass| class.is_avatar() && fact.possible && fact.motion == Motion::Steered;
        let Some(class) = info.class.filter(plays) else { continue };
        let steering = match (class, class.family()) {
            (C::HorizontalAvatar | C::FlakAvatar, _) => Steering::Horizontal,
            (C::VerticalAvatar, _) => Steering::Vertical,
            (C::OngoingAvatar | C::OngoingShootAvatar | C::OngoingTurningAvatar, _) => Steering::Ongoing,
            (C::MissileAvatar, _) => Steering::Unsteered,
            (C::AimedAvatar, _) if !info.traits.stationary => Steering::Thrust,
            (C::NullAvatar | C::AimedAvatar | C::ShootOnlyAvatar, _) => Steering::Fixed,
            (C::SpaceshipAvatar | C::LanderAvatar | C::CarAvatar, _) => Steering::Thrust,
            (C::BirdAvatar | C::PlatformerAvatar | C::WizardAvatar, _) => Steering::Jumping,
            (_, Family::Avatar) => Steering::FourWay,
            (_, Family::Thing | Family::Resource | Family::Flicker | Family::Missile) => continue,
            (_, Family::Npc | Family::Walker | Family::Producer) => continue,
        };
        let (shots, mut ammo) = (fact.makes.clone(), info.traits.ammo.to_vec());
        ammo.retain(|&stype| stype != SpriteType::NONE);
        avatars.push(Avatar {
            stype: SpriteType(at),
            steering,
            shots,
            ammo,
            starts: info.is_sought() && !fact.symbols.is_empty(),
        });
    }
    if !avatars.iter().any(|avatar| avatar.starts) {
        return Vec::new();
    }
    avatars.sort_by_key(|avatar| (!avatar.starts, avatar.stype));
    avatars
}

/// Returns `true` if an interaction happens regardless of the avatar's resources and the sprites' movements.
pub(crate) fn is_certain(encounter: &Encounter) -> bool {
    matches!(encounter.precondition, Precondition::Always | Precondition::Chance(_))
}
