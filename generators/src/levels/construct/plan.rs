//! The planned number of sprites per type in a level.

use crate::levels::examples::Target;
use crate::levels::palette::Palette;
use base::Sampler;
use engine::analysis::{Motion, Reason, Role};
use engine::{Analysis, SpriteType};

/// The desired number of sprites of a type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Wish {
    pub(crate) stype: SpriteType,
    pub(crate) role: Role,
    pub(crate) count: usize,
}

/// Returns the types to place on a board that has `area` open cells, and the number of each. Gates, keys, walls and
/// soil are placed separately.
pub(crate) fn wishes(
    analysis: &Analysis,
    palette: &Palette,
    area: usize,
    difficulty: f64,
    sampler: &mut Sampler,
) -> Vec<Wish> {
    let mut wishes: Vec<Wish> = Vec::new();
    for role in ROLES {
        let types: Vec<SpriteType> = furnishable(analysis, palette, role);
        if types.is_empty() {
            continue;
        }
        let wanted = types.iter().any(|stype| analysis.aims().remove.contains(stype));
        let harmful = types.iter().any(|&stype| analysis.makes_harm(stype));
        let total = total(role, wanted, harmful, area as f64, difficulty);
        let total = round(total, sampler).max(least(role, types.len()));
        wishes.extend(share(types, role, total, sampler));
    }
    make_feasible(analysis, area, &mut wishes);
    wishes
}

/// Returns the types to place on a level's board, and the number of each, following the examples.
pub(crate) fn wishes_like(
    analysis: &Analysis,
    palette: &Palette,
    target: &Target,
    area: usize,
    difficulty: f64,
    sampler: &mut Sampler,
) -> Vec<Wish> {
    let mut wishes: Vec<Wish> = Vec::new();
    for role in ROLES {
        for stype in furnishable(analysis, palette, role) {
            let (drawn, [least, usual, most]) = target.counts[stype.index()];
            let wanted = analysis.aims().remove.contains(&stype);
            // With increasing difficulty, there are more harmful or required things, and fewer helpful ones.
            let share = match role {
                Role::Enemy | Role::Boulder | Role::Hazard => Some(difficulty),
                Role::Spawner if analysis.makes_harm(stype) => Some(difficulty),
                Role::Prey | Role::Collectable if wanted => Some(difficulty),
                Role::Collectable => Some(1.0 - difficulty),
                _ => None,
            };
            let count = match share {
                Some(share) => {
                    // Difficulty 0.5 gives the median, because the minimum or maximum over the examples may be an
                    // outlier.
                    let (from, to, share) = if share < 0.5 {
                        (least, usual, 2.0 * share)
                    } else {
                        (usual, most, 2.0 * share - 1.0)
                    };
                    let asked = from as f64 + (to - from) as f64 * share;
                    round(0.5 * (asked + drawn as f64), sampler).clamp(least, most)
                }
                None => drawn,
            };
            wishes.push(Wish { stype, role, count });
        }
    }
    // The keys that locks need are added elsewhere.
    for stype in furnishable(analysis, palette, Role::Key) {
        wishes.push(Wish { stype, role: Role::Key, count: target.counts[stype.index()].0 });
    }
    for &(stype, count) in &target.decor {
        if palette.symbol(stype).is_some() && wishes.iter().all(|wish| wish.stype != stype) {
            wishes.push(Wish { stype, role: Role::Neutral, count });
        }
    }
    make_feasible(analysis, area, &mut wishes);
    wishes.retain(|wish| wish.count > 0);
    wishes
}

/// Limits the counts to feasible numbers.
fn make_feasible(analysis: &Analysis, area: usize, wishes: &mut [Wish]) {
    for wish in wishes.iter_mut().filter(|wish| analysis.facts(wish.stype).singleton) {
        wish.count = wish.count.min(1);
    }
    require(analysis, area, wishes);
}

/// The roles in placement order. Sprites that must not be obstructed come first.
const ROLES: [Role; 16] = [
    Role::Exit,
    Role::Portal,
    Role::PortalExit,
    Role::Pushable,
    Role::Socket,
    Role::Ward,
    Role::Spawner,
    Role::Prey,
    Role::Enemy,
    Role::Boulder,
    Role::Hazard,
    Role::Breakable,
    Role::Cover,
    Role::Refuge,
    Role::Neutral,
    Role::Collectable,
];

/// Returns the types with the given role that are worth placing. Such types have a level character, persist, and are
/// not mere projectiles.
pub(crate) fn furnishable(analysis: &Analysis, palette: &Palette, role: Role) -> Vec<SpriteType> {
    let types = analysis.game().sprite_types().filter(|&stype| {
        let facts = analysis.facts(stype);
        let own = analysis.role(stype) == role
            || (role == Role::Neutral && is_special_floor(analysis, palette, stype));
        own && facts.possible
            && !facts.fleeting
            && palette.symbol(stype).is_some()
            && !palette.ground.contains(&stype)
    });
    let flies = |stype: &SpriteType| {
        let straight = matches!(analysis.facts(*stype).motion, Motion::Straight(_));
        let made =
            |maker: SpriteType| analysis.facts(maker).possible && analysis.facts(maker).makes.contains(stype);
        straight && !analysis.aims().remove.contains(stype) && analysis.game().sprite_types().any(made)
    };
    types.filter(|stype| !flies(stype)).collect()
}

/// Returns `true` if a type is floor that occurs only in some cells and takes part in an interaction.
fn is_special_floor(analysis: &Analysis, palette: &Palette, stype: SpriteType) -> bool {
    let takes_part = || {
        analysis.encounters().iter().any(|encounter| {
            analysis.applies(encounter.first, stype)
                || encounter.second.is_some_and(|second| analysis.applies(second, stype))
        })
    };
    analysis.role(stype) == Role::Floor && !palette.ground.contains(&stype) && takes_part()
}

/// Returns the total number of sprites of all types with the given role. `wanted` is `true` if these sprites must be
/// removed for a win.
fn total(role: Role, wanted: bool, harmful: bool, area: f64, difficulty: f64) -> f64 {
    match role {
        Role::Exit | Role::Portal | Role::PortalExit | Role::Neutral => 1.0,
        Role::Pushable | Role::Socket => area * 0.04,
        Role::Ward => 5.0 - 2.0 * difficulty,
        Role::Spawner if harmful => 1.0 + 1.5 * difficulty,
        Role::Spawner => 1.0 + area * 0.04,
        Role::Prey => 2.5 + area * 0.015 + difficulty,
        Role::Enemy if wanted => 2.0 + area * (0.01 + 0.03 * difficulty),
        Role::Enemy => area * (0.012 + 0.03 * difficulty),
        Role::Boulder => area * 0.09,
        Role::Hazard => area * (0.015 + 0.04 * difficulty),
        Role::Breakable | Role::Refuge => area * 0.07,
        Role::Cover => area * (0.1 - 0.05 * difficulty),
        Role::Collectable if wanted => area * (0.05 + 0.04 * difficulty),
        Role::Collectable => area * (0.08 - 0.04 * difficulty),
        _ => 0.0,
    }
}

/// Returns the minimum number of sprites for a role. If the types with the role differ in meaning, the minimum is one
/// sprite per type, unless there are too many types.
fn least(role: Role, types: usize) -> usize {
    match role {
        Role::Exit | Role::Portal | Role::PortalExit | Role::Neutral => types,
        Role::Ward | Role::Prey | Role::Collectable => types.clamp(2, 6),
        _ => types.min(4),
    }
}

/// Rounds up or down at random, such that the expected result equals the value.
pub(crate) fn round(value: f64, sampler: &mut Sampler) -> usize {
    (value + sampler.unit()) as usize
}

/// Distributes a total over the types. Each type gets one sprite if possible, and the rest is distributed at random.
fn share(mut types: Vec<SpriteType>, role: Role, total: usize, sampler: &mut Sampler) -> Vec<Wish> {
    sampler.shuffle(&mut types);
    let mut wishes: Vec<Wish> = types.iter().map(|&stype| Wish { stype, role, count: 0 }).collect();
    for at in 0..total {
        let to = if at < wishes.len() { at } else { sampler.below(wishes.len()) };
        wishes[to].count += 1;
    }
    wishes.retain(|wish| wish.count > 0);
    wishes
}

/// Raises or lowers counts until no termination holds at the start.
fn require(analysis: &Analysis, area: usize, wishes: &mut [Wish]) {
    for requirement in analysis.requirements() {
        if matches!(requirement.reason, Reason::Avatar | Reason::Lock(_)) {
            continue;
        }
        let sum = |wishes: &[Wish]| -> usize {
            let listed = wishes.iter().filter(|wish| requirement.types.contains(&wish.stype));
            listed.map(|wish| wish.count).sum()
        };
        // The capacity of the board limits the counts.
        while sum(wishes) < (requirement.at_least as usize).min(area) {
            let fewest = wishes.iter_mut().filter(|wish| requirement.types.contains(&wish.stype));
            let Some(wish) = fewest.min_by_key(|wish| wish.count) else { break };
            wish.count += 1;
        }
        while requirement.at_most.is_some_and(|most| sum(wishes) > most as usize) {
            let most = wishes.iter_mut().filter(|wish| requirement.types.contains(&wish.stype));
            let Some(wish) = most.max_by_key(|wish| wish.count).filter(|wish| wish.count > 0) else { break };
            wish.count -= 1;
        }
    }
}
