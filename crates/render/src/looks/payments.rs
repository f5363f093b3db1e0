//! The uses of resources: what they open, what they protect against, and what they are spent on.

use super::glyph::is_avatar;
use super::remarks;
use super::wins::{self, Terms, counted};
use engine::analysis::{EffectSummary, Encounter, Harm, Key, Lock, Motion, Precondition, Side};
use engine::{Analysis, SpriteType};

/// The outcome of a payment that removes its recipient.
const REMOVES: &str = "removes it";

/// The maximum number of uses in a note.
const USES: usize = 2;

/// Returns the resources that a type gives, and the type itself if it is a resource.
fn resources(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    let is_it = |resource: &&engine::analysis::Resource| {
        resource.stype == stype || resource.givers.iter().any(|(giver, _)| *giver == stype)
    };
    analysis.resources().iter().filter(is_it).map(|resource| resource.stype).collect()
}

/// Returns the locks for which a type gives the key.
fn own_locks(analysis: &Analysis, stype: SpriteType) -> impl Iterator<Item = &Lock> {
    analysis.locks().iter().filter(move |lock| lock.givers.iter().any(|(giver, _)| *giver == stype))
}

/// Returns `true` if the locked type can also be opened by something other than its key.
fn has_other_means(analysis: &Analysis, lock: &Lock) -> bool {
    let all = |effect: &EffectSummary| match effect {
        EffectSummary::KillAll(of) | EffectSummary::BecomeAll(of, _) => *of == lock.stype,
        _ => false,
    };
    let by_key = matches!(lock.key, Key::Resource { .. } | Key::Avatar(_));
    let at_large = by_key && analysis.encounters().iter().any(|encounter| encounter.does(all));
    let free = |avatar: &engine::analysis::Avatar| {
        let is_keyless = match lock.key {
            Key::Resource { .. } => true,
            Key::Avatar(needed) => avatar.stype != needed,
            Key::Switch(..) => false,
        };
        let touch = analysis.touch(avatar.stype, lock.stype);
        is_keyless && touch.any && touch.removal == engine::analysis::Removal::Always
    };
    let touched = analysis.avatars().iter().any(free);
    let has_several = by_key && keys(analysis, lock.stype).len() > 1;
    at_large || touched || has_several || !remarks::clearers(analysis, lock.stype).is_empty()
}

/// Returns `true` if a win may require opening the lock: either the lock itself must be opened for the win,
/// or it bars the way.
fn can_matter(analysis: &Analysis, lock: &Lock) -> bool {
    let is_goal = wins::able(analysis, lock.stype).is_some();
    let is_lost = wins::is_to_keep(analysis, lock.stype) && lock.vanishes;
    (is_goal || lock.guards) && !is_lost
}

/// Returns the types that can be opened only with a given type's key. Each of them is a goal, or bars the way.
pub(super) fn needed_for(analysis: &Analysis, stype: SpriteType) -> Vec<SpriteType> {
    let needed = |lock: &&Lock| {
        (lock.vanishes || matches!(lock.key, Key::Avatar(_)))
            && can_matter(analysis, lock)
            && !has_other_means(analysis, lock)
    };
    own_locks(analysis, stype).filter(needed).map(|lock| lock.stype).collect()
}

/// Returns the harmful types against which a resource protects the avatar.
fn protects_from(analysis: &Analysis, resource: SpriteType) -> Vec<SpriteType> {
    let is_safe = |stype: &SpriteType| {
        let mut touches = analysis.avatars().iter().map(|avatar| analysis.touch(avatar.stype, *stype));
        analysis.facts(*stype).possible
            && touches.any(|touch| {
                touch.harm == Harm::Conditional && touch.safe_with.is_some_and(|(safe, _)| safe == resource)
            })
    };
    analysis.game().sprite_types().filter(is_safe).collect()
}

/// A use of a resource when the avatar touches sprites of a type.
struct Use {
    at: SpriteType,
    spent: bool,
    outcome: Option<String>,
}

/// Returns `true` if an encounter takes some of a resource from the sprite on this side.
fn takes(encounter: &Encounter, own: Side, resource: SpriteType) -> bool {
    encounter.does(|effect| match effect {
        EffectSummary::Change { side, resource: of, by } => *side == own && *of == resource && *by < 0,
        _ => false,
    })
}

/// Returns the amount of a resource that an avatar on this side must hold in an encounter, if any.
fn asks(encounter: &Encounter, own: Side, resource: SpriteType) -> Option<i32> {
    match encounter.precondition {
        Precondition::Holds(side, of, amount) if side == own && of == resource && amount > 0 => Some(amount),
        _ => None,
    }
}

/// Describes the first consequence of an encounter that has a description: `makes leopard`, `makes you laden`; `None`
/// if no consequence has one.
fn outcome(analysis: &Analysis, encounter: &Encounter, own: Side) -> Option<String> {
    let name = |stype: &SpriteType| analysis.game().name(*stype);
    encounter.effects.iter().find_map(|effect| match effect {
        EffectSummary::Make(to) => Some(format!("makes {}", name(to))),
        EffectSummary::Become(to) if own == Side::First => Some(format!("makes you {}", name(to))),
        EffectSummary::Become(to) => Some(format!("makes {}", name(to))),
        EffectSummary::KillAll(of) => Some(format!("removes {}", name(of))),
        EffectSummary::BecomeAll(of, _) => Some(format!("changes {}", name(of))),
        EffectSummary::Kill(side) if *side != own => Some(REMOVES.to_owned()),
        EffectSummary::Change { side, resource, by } if *side == own && *by > 0 => {
            Some(format!("gives {}", name(resource)))
        }
        EffectSummary::Teleport => Some("takes you elsewhere".to_owned()),
        _ => None,
    })
}

/// Returns the encounters between avatars and a type.
fn meetings(analysis: &Analysis, stype: SpriteType) -> impl Iterator<Item = (&Encounter, Side)> {
    let avatars = analysis.avatars().iter();
    avatars.flat_map(move |avatar| wins::met(analysis, avatar.stype, stype))
}

/// Returns `true` if the encounter kills the avatar on this side.
fn kills(encounter: &Encounter, own: Side) -> bool {
    encounter.does(|effect| *effect == EffectSummary::Kill(own))
}

fn other(side: Side) -> Side {
    if side == Side::First { Side::Second } else { Side::First }
}

/// Returns the uses of a resource at types that are not in `known`.
fn uses(analysis: &Analysis, resource: SpriteType, known: &[SpriteType]) -> Vec<Use> {
    let found = |at: SpriteType| {
        let facts = analysis.facts(at);
        if !facts.possible || is_avatar(analysis, at) || known.contains(&at) || at == resource {
            return None;
        }
        let concerned: Vec<(&Encounter, Side)> = meetings(analysis, at)
            .filter(|(encounter, own)| !kills(encounter, *own))
            .filter(|(encounter, own)| {
                takes(encounter, *own, resource) || asks(encounter, *own, resource).is_some()
            })
            .collect();
        let spent = concerned.iter().any(|(encounter, own)| takes(encounter, *own, resource));
        let outcome = concerned.iter().find_map(|(encounter, own)| outcome(analysis, encounter, *own));
        (!concerned.is_empty()).then_some(Use { at, spent, outcome })
    };
    analysis.game().sprite_types().filter_map(found).collect()
}

/// Describes where an avatar dies if it holds enough of a resource: `2 are deadly at lake`.
fn burdens(analysis: &Analysis, resource: SpriteType) -> Option<String> {
    let found = |at: SpriteType| {
        let mut deadly = meetings(analysis, at).filter(|(encounter, own)| kills(encounter, *own));
        let amount = deadly.find_map(|(encounter, own)| asks(encounter, own, resource))?;
        analysis.facts(at).possible.then_some((at, amount))
    };
    let (at, amount) = analysis.game().sprite_types().find_map(found)?;
    let at = analysis.game().name(at);
    Some(if amount == 1 { format!("deadly at {at}") } else { format!("{amount} are deadly at {at}") })
}

/// Returns `true` if sprites of the type stay in their cell and stop some avatar.
fn is_barrier(analysis: &Analysis, stype: SpriteType) -> bool {
    let blocks = analysis.avatars().iter().any(|avatar| analysis.touch(avatar.stype, stype).blocks);
    blocks && analysis.facts(stype).motion == Motion::Still
}

/// Describes the uses: `spent at gong: makes leopard`, `used at bakeHouse, gate`; `None` for an empty list.
fn told(analysis: &Analysis, uses: &[Use]) -> Option<String> {
    let verb = if uses.iter().all(|used| used.spent) { "spent at" } else { "used at" };
    let places: Vec<SpriteType> = uses.iter().map(|used| used.at).collect();
    let places = remarks::names(analysis, &places)?;
    Some(match uses {
        [Use { outcome: Some(outcome), .. }] if outcome == REMOVES => {
            let verb =
                if uses.iter().any(|used| is_barrier(analysis, used.at)) { "opens" } else { "removes" };
            format!("{verb} {places}")
        }
        [Use { outcome: Some(outcome), .. }] => format!("{verb} {places}: {outcome}"),
        _ => format!("{verb} {places}"),
    })
}

/// Describes the uses of a type that the avatar collects: `needed for door`, `ammunition for dart`, `spent at gong:
/// makes leopard`; `None` if it has no use.
pub(super) fn purposes(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let needed = needed_for(analysis, stype);
    let opened: Vec<SpriteType> = own_locks(analysis, stype)
        .filter(|lock| lock.vanishes && !needed.contains(&lock.stype) && lock.stype != stype)
        .filter(|lock| !matches!(lock.key, Key::Avatar(_)))
        .map(|lock| lock.stype)
        .collect();
    let (barriers, removed): (Vec<SpriteType>, Vec<SpriteType>) =
        opened.iter().partition(|stype| is_barrier(analysis, **stype));
    let resources = resources(analysis, stype);
    let collected = |of: &dyn Fn(SpriteType) -> Vec<SpriteType>| -> Vec<SpriteType> {
        resources.iter().flat_map(|&resource| of(resource)).collect()
    };
    let mut safe = collected(&|resource| protects_from(analysis, resource));
    safe.retain(|at| !needed.contains(at) && !opened.contains(at));
    let ammunition = collected(&|resource| remarks::ammunition_for(analysis, resource));
    let known = [needed.clone(), opened.clone(), safe.clone()].concat();
    let uses: Vec<Use> = resources.iter().flat_map(|&resource| uses(analysis, resource, &known)).collect();
    let phrase =
        |verb: &str, types: &[SpriteType]| Some(format!("{verb} {}", remarks::names(analysis, types)?));
    let parts = [
        phrase("needed for", &needed),
        phrase("opens", &barriers),
        phrase("removes", &removed),
        phrase("protects from", &safe),
        phrase("ammunition for", &ammunition),
        told(analysis, &uses),
        resources.iter().find_map(|&resource| burdens(analysis, resource)),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().take(USES).collect();
    (!parts.is_empty()).then(|| parts.join(", "))
}

/// Describes the effect of a resource at a type: `key here makes leopard`, `takes your coin`; `None` if no resource has
/// an effect there.
pub(super) fn paid_here(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let effect = |(encounter, own): (&Encounter, Side)| {
        let Precondition::Holds(side, resource, amount) = encounter.precondition else { return None };
        let outcome = outcome(analysis, encounter, own)?;
        let held = counted(analysis, resource, amount);
        let is_use = side == own && amount > 0 && !kills(encounter, own) && outcome != REMOVES;
        is_use.then(|| format!("{held} here {outcome}"))
    };
    meetings(analysis, stype).find_map(effect).or_else(|| theft(analysis, stype))
}

/// Describes the resource that a type takes from the avatar; `None` if it takes none.
pub(super) fn theft(analysis: &Analysis, stype: SpriteType) -> Option<String> {
    let mut resources = analysis.resources().iter();
    let taken = resources.find(|resource| resource.takers.iter().any(|(taker, _)| *taker == stype))?;
    Some(format!("takes your {}", analysis.game().name(taken.stype)))
}

/// Returns the resources that let the avatar remove sprites of a type, each with the required amount. Any one of them
/// is enough.
pub(super) fn keys(analysis: &Analysis, stype: SpriteType) -> Vec<(SpriteType, i32)> {
    let mut keys = Vec::new();
    for (encounter, own) in meetings(analysis, stype) {
        let Precondition::Holds(side, resource, amount) = encounter.precondition else { continue };
        let removes = encounter.does(|effect| *effect == EffectSummary::Kill(other(own)));
        if side == own && removes && !keys.contains(&(resource, amount)) {
            keys.push((resource, amount));
        }
    }
    keys
}

/// Returns `true` if an encounter removes the avatar on this side, or turns it into something else.
pub(super) fn is_deadly(analysis: &Analysis, encounter: &Encounter, own: Side) -> bool {
    encounter.does(|effect| match effect {
        EffectSummary::Kill(side) => *side == own,
        EffectSummary::KillAll(of) | EffectSummary::BecomeAll(of, _) => is_avatar(analysis, *of),
        EffectSummary::Become(to) => own == Side::First && !is_avatar(analysis, *to),
        EffectSummary::BecomeAny(_) => own == Side::First,
        _ => false,
    })
}

/// Returns the resource condition on which all harm by contact with a type depends. Returns `None` if the harm also
/// depends on something else.
pub(super) fn deadly_terms(analysis: &Analysis, avatar: SpriteType, stype: SpriteType) -> Option<Terms> {
    let wounds = |effect: &EffectSummary| matches!(effect, EffectSummary::Health { by, .. } if *by < 0);
    let is_deadly =
        |encounter: &Encounter, own: Side| encounter.does(wounds) || is_deadly(analysis, encounter, own);
    let mut deadly = wins::met(analysis, avatar, stype).filter(|(encounter, own)| is_deadly(encounter, *own));
    let conditions = |(encounter, own): (&Encounter, Side)| match encounter.precondition {
        Precondition::Holds(side, resource, amount) if side == own && amount > 0 => {
            Terms::Holds(resource, amount)
        }
        Precondition::HoldsAtMost(side, resource, most) if side == own => Terms::HoldsAtMost(resource, most),
        _ => Terms::Sometimes,
    };
    let first = conditions(deadly.next()?);
    let same = deadly.all(|met| conditions(met) == first);
    (same && first != Terms::Sometimes).then_some(first)
}
