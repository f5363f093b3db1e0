//! The roles in a theme that the sprite types of a game can play, according to its rules.

use super::role::Role;
use engine::analysis::{Analysis, Harm, Motion, Removal, Role as Use};
use engine::{Direction, SpriteType};

/// The roles that a type can play, the most fitting first; never empty.
pub(super) fn roles(analysis: &Analysis, stype: SpriteType) -> &'static [Role] {
    use Role as R;
    let facts = analysis.facts(stype);
    let still = facts.motion == Motion::Still;
    match analysis.role(stype) {
        Use::Avatar => &[R::Hero],
        Use::Shot if !still => &[R::Bolt, R::Dart, R::Blade],
        Use::Shot if facts.fleeting => &[R::Blade, R::Blast, R::Bolt],
        Use::Shot => &[R::Charge, R::Bolt],
        Use::Portal => &[R::PortalIn],
        Use::PortalExit => &[R::PortalOut],
        Use::Pushable => &[R::Crate, R::Parcel],
        Use::Exit => &[R::Exit, R::Haven, R::Door],
        Use::Gate => &[R::Door, R::Gate],
        Use::Boulder => &[R::Drop, R::Rover],
        Use::Enemy => enemy(analysis, stype),
        Use::Socket => &[R::Socket, R::Plate, R::Pool],
        Use::Hazard if facts.fleeting => &[R::Blast, R::Steam, R::Trap],
        Use::Hazard if facts.symbols.is_empty() => &[R::Creep, R::Slime, R::Trap],
        Use::Hazard => &[R::Trap, R::Pool],
        Use::Spawner if analysis.makes_harm(stype) => nest(analysis, stype),
        Use::Spawner => &[R::Tree, R::Bush, R::Rack],
        Use::Ward if still => &[R::Crop, R::Relic, R::Lamp],
        Use::Ward => &[R::Friend],
        Use::Prey => prey(analysis, stype),
        Use::Key if facts.is_resource => &[R::Key, R::Torch, R::Coin],
        Use::Key => &[R::Lever, R::Key],
        Use::Soil => &[R::Soil],
        Use::Collectable => collectable(analysis, stype),
        Use::Breakable => &[R::Idol, R::Rubble],
        Use::Wall => &[R::Wall, R::Rubble, R::Statue],
        Use::Cover => &[R::Cover],
        Use::Refuge => &[R::Haven, R::Bush],
        Use::Floor => &[R::Floor],
        Use::Neutral if facts.is_resource => &[R::Coin, R::Ammo, R::Ward],
        Use::Neutral if !still => &[R::Slug, R::Friend, R::Cart],
        Use::Neutral if facts.fleeting => &[R::Steam, R::Blast],
        Use::Neutral if facts.symbols.is_empty() => &[R::Trophy, R::Rubble, R::Sprout],
        Use::Neutral => &[R::Plot, R::Plate, R::Archway, R::Cart],
    }
}

/// Words for a group of types one of which has this use; more general than those of any theme.
pub(super) fn group(role: Use) -> &'static [&'static str] {
    match role {
        Use::Avatar => &["figure", "actor"],
        Use::Enemy | Use::Hazard | Use::Boulder | Use::Spawner => &["danger", "menace", "peril"],
        Use::Collectable | Use::Key => &["find", "prize", "bounty"],
        Use::Wall | Use::Gate | Use::Soil | Use::Breakable | Use::Cover => &["barrier", "obstacle"],
        Use::Exit | Use::Socket | Use::Portal | Use::PortalExit | Use::Refuge => &["destination", "spot"],
        Use::Prey => &["quarry", "target"],
        Use::Ward => &["favourite", "fosterling"],
        Use::Pushable => &["burden", "cargo"],
        Use::Shot => &["weapon", "missive"],
        Use::Floor | Use::Neutral => &["sort", "thing", "kind"],
    }
}

fn enemy(analysis: &Analysis, stype: SpriteType) -> &'static [Role] {
    use Role as R;
    let facts = analysis.facts(stype);
    let is_avatar =
        |target: SpriteType| analysis.avatars().iter().any(|avatar| analysis.applies(target, avatar.stype));
    let makes = !facts.makes.is_empty();
    match facts.motion {
        Motion::Chasing(target) if is_avatar(target) => &[R::Chaser, R::Wanderer],
        Motion::Chasing(_) => &[R::Pest, R::Snuffer, R::Chaser],
        Motion::Straight(_) if makes => &[R::Bomber, R::Patroller],
        Motion::Straight(Direction::DOWN) if facts.symbols.is_empty() => &[R::Drop, R::Dart],
        Motion::Straight(_) if facts.symbols.is_empty() => &[R::Dart, R::Rover],
        Motion::Straight(_) => &[R::Patroller, R::Rover],
        _ if makes => &[R::Slug, R::Wanderer],
        _ => &[R::Wanderer, R::Pest, R::Snuffer],
    }
}

/// The roles for a spawner of harmful sprites.
fn nest(analysis: &Analysis, stype: SpriteType) -> &'static [Role] {
    use Role as R;
    let made = analysis.facts(stype).makes.first().map(|&made| analysis.facts(made));
    match made.map(|made| (made.motion, made.fleeting)) {
        Some((Motion::Still, _)) | Some((_, true)) => &[R::Vent, R::Nest],
        Some((Motion::Straight(_), _)) => &[R::Turret, R::Nest, R::Vent],
        _ => &[R::Nest, R::Vent],
    }
}

fn prey(analysis: &Analysis, stype: SpriteType) -> &'static [Role] {
    use Role as R;
    let facts = analysis.facts(stype);
    match facts.motion {
        Motion::Still => &[R::Idol, R::Chest, R::Lamp],
        Motion::Straight(Direction::DOWN) => &[R::Fruit, R::Wanderer],
        Motion::Straight(_) => &[R::Rover, R::Patroller, R::Wanderer],
        _ if is_caught(analysis, stype) => &[R::Friend, R::Wanderer, R::Pest],
        _ => &[R::Pest, R::Wanderer, R::Snuffer],
    }
}

fn collectable(analysis: &Analysis, stype: SpriteType) -> &'static [Role] {
    use Role as R;
    let ammunition =
        analysis.resources().iter().any(|resource| resource.stype == stype && resource.is_ammunition);
    let facts = analysis.facts(stype);
    match facts.motion {
        _ if ammunition => &[R::Ammo, R::Coin],
        _ if facts.is_resource => &[R::Coin, R::Ore, R::Parcel],
        Motion::Still if analysis.aims().remove.contains(&stype) => &[R::Gem, R::Charm, R::Relic],
        Motion::Still => &[R::Berry, R::Charm, R::Coin],
        _ => &[R::Fruit, R::Friend],
    }
}

/// Returns `true` if an avatar removes it by touch.
pub(super) fn is_caught(analysis: &Analysis, stype: SpriteType) -> bool {
    let removed = |avatar: SpriteType| analysis.touch(avatar, stype).removal != Removal::Never;
    analysis.avatars().iter().any(|avatar| removed(avatar.stype))
}

/// Returns `true` if the avatar should keep away from it.
pub(super) fn is_dangerous(analysis: &Analysis, stype: SpriteType) -> bool {
    let role = analysis.role(stype);
    matches!(role, Use::Enemy | Use::Hazard | Use::Boulder) && analysis.harm(stype) != Harm::None
}
