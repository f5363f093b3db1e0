//! Placement patterns of sprite types. A type's [`Idiom`] is the kind of position that suits its sprites.

use engine::analysis::{EffectSummary, Encounter, Harm, Motion, Role, Side};
use engine::{Analysis, SpriteType};

/// The kind of position that suits a type's sprites, derived from the rules.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Idiom {
    /// A type that stops or kills the player until a rule opens, removes or disarms its sprites. The sprites belong in
    /// gaps, and in rows that divide a board.
    Barrier,
    /// A type whose sprites stop or kill the player until pushed or thrown objects fill them. The sprites form a river
    /// across the board.
    Crossing,
    /// A type that stands still and interacts with its neighbours, such as soil, fuel, ice or planks. The sprites form
    /// rows and patches.
    Ground,
    /// A type that breaks under the player, or changes into an obstacle. The sprites belong in gaps, where they form a
    /// road to the other side.
    Road,
    /// A type that no rule removes and that always stops the player, as a wall does. The sprites form gulfs, ponds, and
    /// lines crossed by roads.
    Obstacle,
    /// A type that kills or stops the player, and that can never be opened, removed or passed. The sprites form pools
    /// beside the path.
    Hazard,
    /// A type that is collected, touched or guarded. The sprites belong in groups.
    Thing,
    /// A type that the player pushes. The sprites belong on open floor, away from walls.
    Heavy,
    /// A type onto which the player pushes or carries an object. The sprites belong in cells that can be reached from
    /// opposite sides.
    Spot,
    /// A type that moves straight ahead. The sprites belong on long free lanes.
    Patrol,
    /// A type that follows other sprites. The sprites belong at a distance from the player.
    Hunter,
    /// A type that flees or wanders. The sprites belong on open floor.
    Stray,
    /// A type that creates other sprites. The sprites belong next to walls, far from the player.
    Source,
    /// A type that ends the level when touched, or leads to a different location. The sprites belong next to walls, far
    /// from the player.
    Exit,
}

impl Idiom {
    /// Returns the kind of position that suits a type, with respect to the initial avatar. Returns `None` for types
    /// that are not placed as pieces: the avatar, floor, shots, and types that play no part in the game. Cost:
    /// O(encounters × relatives).
    pub fn of(analysis: &Analysis, stype: SpriteType) -> Option<Idiom> {
        let start = analysis.start_avatar()?.stype;
        let facts = analysis.facts(stype);
        let role = analysis.role(stype);
        if facts.symbols.is_empty() || !facts.concrete {
            return None;
        }
        match role {
            Role::Avatar | Role::Shot => return None,
            _ if shuts(analysis, stype) => return Some(Idiom::Barrier),
            Role::Floor => return None,
            Role::Wall if is_ended(analysis, stype) => return Some(Idiom::Barrier),
            Role::Wall if acts(analysis, stype) => return Some(Idiom::Spot),
            Role::Wall => return Some(Idiom::Obstacle),
            Role::Portal | Role::PortalExit | Role::Exit => return Some(Idiom::Exit),
            Role::Pushable => return Some(Idiom::Heavy),
            _ => {}
        }
        match facts.motion {
            Motion::Straight(_) => return Some(Idiom::Patrol),
            Motion::Chasing(_) => return Some(Idiom::Hunter),
            Motion::Fleeing(_) | Motion::Wandering => return Some(Idiom::Stray),
            Motion::Still | Motion::Steered => {}
        }
        let is_at_stake = is_at_stake(analysis, stype);
        if !is_at_stake && is_road(analysis, stype) {
            return Some(Idiom::Road);
        }
        if !is_at_stake && (is_fuel(analysis, stype) || role == Role::Soil) {
            return Some(Idiom::Ground);
        }
        if !facts.makes.is_empty() {
            return Some(Idiom::Source);
        }
        let touch = analysis.touch(start, stype);
        let bars = touch.blocks || touch.harm != Harm::None;
        let is_filled = is_partner(analysis, stype, |fills| fills);
        if bars && is_filled && !is_at_stake {
            return Some(Idiom::Crossing);
        }
        if is_partner(analysis, stype, |_| true) {
            return Some(Idiom::Spot);
        }
        if is_at_stake {
            return Some(Idiom::Thing);
        }
        if role == Role::Key || !touch.opens.is_empty() {
            return Some(Idiom::Thing);
        }
        if bars {
            let opens = analysis.locks().iter().any(|lock| lock.stype == stype) || is_ended(analysis, stype);
            let passes = touch.safe_with.is_some()
                || analysis
                    .avatars()
                    .iter()
                    .any(|avatar| avatar.stype != start && analysis.touch(avatar.stype, stype).lets_pass());
            return Some(if opens || passes { Idiom::Barrier } else { Idiom::Hazard });
        }
        if touch.changes.is_some() {
            return Some(Idiom::Ground);
        }
        let is_plain = touch.gives.is_empty() && touch.makes.is_empty() && touch.becomes.is_none();
        if touch.ends_other() && is_plain && holds_up(analysis, stype) {
            return Some(Idiom::Ground);
        }
        if touch.ends_other() || !touch.gives.is_empty() {
            return Some(Idiom::Thing);
        }
        let takes_part = touch.any || acts(analysis, stype);
        takes_part.then_some(if is_ended(analysis, stype) { Idiom::Ground } else { Idiom::Spot })
    }

    /// Returns `true` if the type's sprites move by themselves.
    pub fn moves(self) -> bool {
        matches!(self, Idiom::Patrol | Idiom::Hunter | Idiom::Stray)
    }
}

/// Returns `true` if an avatar can push a sprite onto the type so that one of the two is removed or changed. `wanted`
/// receives `true` if the push fills the type, and decides whether such a push counts.
fn is_partner(analysis: &Analysis, stype: SpriteType, wanted: impl Fn(bool) -> bool) -> bool {
    let sinks = analysis.pushables().iter().flat_map(|pushable| &pushable.sinks);
    sinks.into_iter().any(|sink| sink.partner == stype && wanted(sink.fills))
}

/// Returns the interactions that involve the type, each with the type's side.
fn with(analysis: &Analysis, stype: SpriteType) -> impl Iterator<Item = (&Encounter, Side)> {
    let first = move |met: &&Encounter| met.second.is_some() && analysis.applies(met.first, stype);
    let second = move |met: &&Encounter| met.second.is_some_and(|written| analysis.applies(written, stype));
    let encounters = analysis.encounters().iter();
    encounters
        .clone()
        .filter(first)
        .map(|met| (met, Side::First))
        .chain(encounters.filter(second).map(|met| (met, Side::Second)))
}

/// Returns `true` if an interaction removes or changes sprites of the type, either the sprite in contact or every
/// sprite on the board.
fn is_ended(analysis: &Analysis, stype: SpriteType) -> bool {
    let afar = |effect: &EffectSummary| match effect {
        EffectSummary::KillAll(other) | EffectSummary::BecomeAll(other, _) => analysis.applies(*other, stype),
        _ => false,
    };
    analysis.encounters().iter().any(|met| met.does(afar))
        || with(analysis, stype).any(|(met, side)| met.ends(side))
}

/// Returns `true` if a type takes part in an interaction that does more than stop a sprite. Such an interaction
/// creates, opens, gives, ends or transports something.
fn acts(analysis: &Analysis, stype: SpriteType) -> bool {
    let stops = |effect: &EffectSummary| {
        matches!(effect, EffectSummary::Stop | EffectSummary::Undo(_) | EffectSummary::Turn)
    };
    let ends_mover = |met: &Encounter| {
        met.ends(Side::First) && !met.does(|effect| matches!(effect, EffectSummary::Become(_)))
    };
    with(analysis, stype)
        .any(|(met, side)| met.does(|effect| !stops(effect)) && !(side == Side::Second && ends_mover(met)))
}

/// Returns `true` if the type can turn into a type that spreads or creates other sprites, as fuel does.
fn is_fuel(analysis: &Analysis, stype: SpriteType) -> bool {
    let spreads = |to: SpriteType| {
        analysis.game().class(to) == Some(engine::SpriteClass::Spreader)
            || !analysis.facts(to).makes.is_empty()
    };
    let facts = analysis.facts(stype);
    !facts.is_resource && facts.makes.is_empty() && analysis.turns(stype).iter().any(|&(to, _)| spreads(to))
}

/// Returns `true` if a win requires removing the type, or if removing all of its sprites loses the game.
fn is_at_stake(analysis: &Analysis, stype: SpriteType) -> bool {
    let aims = analysis.aims();
    aims.remove.contains(&stype)
        || aims.protect.contains(&stype)
        || analysis.turns(stype).iter().any(|(to, _)| aims.prevent.contains(to))
}

/// Returns `true` if the type lets the avatar pass until an interaction turns all of its sprites into obstacles.
fn shuts(analysis: &Analysis, stype: SpriteType) -> bool {
    let Some(start) = analysis.start_avatar() else { return false };
    let bars = |to: SpriteType| analysis.touch(start.stype, to).blocks;
    let closes = |effect: &EffectSummary| matches!(effect, EffectSummary::BecomeAll(from, to) if *from == stype && bars(*to));
    !bars(stype) && analysis.encounters().iter().any(|met| met.does(closes))
}

/// Returns `true` if an avatar can pass over the type once, after which it becomes an obstacle.
fn is_road(analysis: &Analysis, stype: SpriteType) -> bool {
    let Some(start) = analysis.start_avatar() else { return false };
    let bars = |to: SpriteType| {
        let touch = analysis.touch(start.stype, to);
        touch.blocks || touch.harm != Harm::None
    };
    let by_avatar =
        |by: SpriteType| analysis.avatars().iter().any(|avatar| analysis.applies(by, avatar.stype));
    let mut turns = analysis.turns(stype).into_iter();
    !bars(stype) && turns.any(|(to, by)| by_avatar(by) && bars(to))
}

/// Returns `true` if the type stops moving or pushed sprites.
fn holds_up(analysis: &Analysis, stype: SpriteType) -> bool {
    analysis.game().sprite_types().any(|mover| {
        let facts = analysis.facts(mover);
        let moves = !matches!(facts.motion, Motion::Still | Motion::Steered);
        let pushed = analysis.role(mover) == Role::Pushable;
        facts.possible && (moves || pushed) && analysis.blocks(stype, mover)
    })
}
