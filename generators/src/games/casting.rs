//! The assignment of a game's sprite types to the nouns of a scene, according to their use in the rules.

use engine::analysis::{Analysis, Harm, Motion, Removal, Role as Use};
use engine::{Direction, SpriteType};

/// Returns the roles that a type can play, from most to least fitting. The list is never empty.
pub(super) fn roles(analysis: &Analysis, stype: SpriteType) -> &'static [&'static str] {
    let facts = analysis.facts(stype);
    let still = facts.motion == Motion::Still;
    match analysis.role(stype) {
        Use::Avatar => &["hero"],
        Use::Shot if !still => &["bolt", "shot", "blade"],
        Use::Shot if facts.fleeting => &["blade", "blast", "bolt"],
        Use::Shot => &["charge", "bolt"],
        Use::Portal => &["portal"],
        Use::PortalExit => &["outlet"],
        Use::Pushable => &["crate", "cargo"],
        Use::Exit => &["exit", "haven", "door"],
        Use::Gate => &["door", "gate"],
        Use::Boulder => &["drop", "rover"],
        Use::Enemy => enemy(analysis, stype),
        Use::Socket => &["socket", "plate", "gulf"],
        Use::Hazard if facts.fleeting => &["blast", "steam", "trap"],
        Use::Hazard if facts.symbols.is_empty() => &["creep", "trail", "trap"],
        Use::Hazard => &["trap", "gulf"],
        Use::Spawner if analysis.makes_harm(stype) => nest(analysis, stype),
        Use::Spawner => &["tree", "bush", "rack"],
        Use::Ward if still => &["crop", "relic", "lamp"],
        Use::Ward => &["friend"],
        Use::Prey => prey(analysis, stype),
        Use::Key if facts.is_resource => &["key", "torch", "coin"],
        Use::Key => &["lever", "key"],
        Use::Soil => &["soil"],
        Use::Collectable => collectable(analysis, stype),
        Use::Breakable => &["idol", "rubble"],
        Use::Wall => &["wall", "rubble", "statue"],
        Use::Cover => &["cover"],
        Use::Refuge => &["haven", "bush"],
        Use::Floor => &["floor"],
        Use::Neutral if facts.is_resource => &["coin", "ammo", "ward"],
        Use::Neutral if !still => &["slug", "friend", "cart"],
        Use::Neutral if facts.fleeting => &["steam", "blast"],
        Use::Neutral if facts.symbols.is_empty() => &["trophy", "rubble", "plant"],
        Use::Neutral => &["plot", "plate", "archway", "cart"],
    }
}

/// Returns words for a group of types that contains a type with the given use. They are more general than the words of
/// any scene.
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

fn enemy(analysis: &Analysis, stype: SpriteType) -> &'static [&'static str] {
    let facts = analysis.facts(stype);
    let is_avatar =
        |target: SpriteType| analysis.avatars().iter().any(|avatar| analysis.applies(target, avatar.stype));
    let makes = !facts.makes.is_empty();
    match facts.motion {
        Motion::Chasing(target) if is_avatar(target) => &["hunter", "stroller"],
        Motion::Chasing(_) => &["pest", "snuffer", "hunter"],
        Motion::Straight(_) if makes => &["bomber", "patrol"],
        Motion::Straight(Direction::DOWN) if facts.symbols.is_empty() => &["drop", "shot"],
        Motion::Straight(_) if facts.symbols.is_empty() => &["shot", "rover"],
        Motion::Straight(_) => &["patrol", "rover"],
        _ if makes => &["slug", "stroller"],
        _ => &["stroller", "pest", "snuffer"],
    }
}

/// Returns the roles for a spawner of harmful sprites.
fn nest(analysis: &Analysis, stype: SpriteType) -> &'static [&'static str] {
    let made = analysis.facts(stype).makes.first().map(|&made| analysis.facts(made));
    match made.map(|made| (made.motion, made.fleeting)) {
        Some((Motion::Still, _)) | Some((_, true)) => &["vent", "nest"],
        Some((Motion::Straight(_), _)) => &["shooter", "nest", "vent"],
        _ => &["nest", "vent"],
    }
}

fn prey(analysis: &Analysis, stype: SpriteType) -> &'static [&'static str] {
    let facts = analysis.facts(stype);
    match facts.motion {
        Motion::Still => &["idol", "chest", "lamp"],
        Motion::Straight(Direction::DOWN) => &["fruit", "stroller"],
        Motion::Straight(_) => &["rover", "patrol", "stroller"],
        _ if is_caught(analysis, stype) => &["friend", "stroller", "pest"],
        _ => &["pest", "stroller", "snuffer"],
    }
}

fn collectable(analysis: &Analysis, stype: SpriteType) -> &'static [&'static str] {
    let ammunition =
        analysis.resources().iter().any(|resource| resource.stype == stype && resource.is_ammunition);
    let facts = analysis.facts(stype);
    match facts.motion {
        _ if ammunition => &["ammo", "coin"],
        _ if facts.is_resource => &["coin", "ore", "cargo"],
        Motion::Still if analysis.aims().remove.contains(&stype) => &["prize", "treasure", "relic"],
        Motion::Still => &["food", "treasure", "coin"],
        _ => &["fruit", "friend"],
    }
}

/// Returns `true` if an avatar removes the type by touching it.
pub(super) fn is_caught(analysis: &Analysis, stype: SpriteType) -> bool {
    let removed = |avatar: SpriteType| analysis.touch(avatar, stype).removal != Removal::Never;
    analysis.avatars().iter().any(|avatar| removed(avatar.stype))
}

/// Returns `true` if the avatar should keep away from the type.
pub(super) fn is_dangerous(analysis: &Analysis, stype: SpriteType) -> bool {
    let role = analysis.role(stype);
    matches!(role, Use::Enemy | Use::Hazard | Use::Boulder) && analysis.harm(stype) != Harm::None
}
