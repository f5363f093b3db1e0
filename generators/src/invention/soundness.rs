//! Static conditions on merged ports (open roles of mechanics), which reject partitions that cannot become a game
//! before any rules are written.

use super::mechanic::{Body, Mechanic, Port, Tag};
use super::merge::{Merged, PortId};

/// The maximum number of types that a player encounters.
const MOST_TYPES: usize = 8;

/// The reason for rejecting a partition of the mechanics' ports (open roles).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Unsound {
    /// No body (kind of physical object) suits all roles of a type.
    Body,
    /// A moving type has no motion or several motions.
    Motion,
    /// The mechanics are not all connected by shared types.
    Unconnected,
    /// A type is produced or carried, but nothing needs it.
    Idle,
    /// No type has opposed uses (one port needs the type, and another spends, removes or fears it), so no choice has a
    /// price.
    NoTension,
    /// The player cannot influence a moving type.
    NoAgency,
    /// The goal is met by losing objects, or nothing removes the objects of the goal.
    Goal,
    /// No danger that acts by itself has a second use.
    NoPressure,
    /// There are too many types.
    TooMany,
    /// More than one mechanic needs its own avatar.
    Avatar,
    /// No noun suits everything that a type does.
    Noun,
}

impl Unsound {
    /// Returns the name used in reports.
    pub fn name(self) -> &'static str {
        match self {
            Unsound::Body => "body",
            Unsound::Motion => "motion",
            Unsound::Unconnected => "unconnected",
            Unsound::Idle => "idle",
            Unsound::NoTension => "no tension",
            Unsound::NoAgency => "no agency",
            Unsound::Goal => "goal",
            Unsound::NoPressure => "no pressure",
            Unsound::TooMany => "too many types",
            Unsound::Avatar => "avatar",
            Unsound::Noun => "no noun",
        }
    }
}

/// Checks a partition of the mechanics' ports (open roles), except for its nouns.
///
/// # Errors
/// Returns the first unmet condition.
pub(super) fn check(mechanics: &[&'static Mechanic], types: &[Merged]) -> Result<(), Unsound> {
    let conditions: [(Unsound, bool); 9] = [
        (Unsound::Avatar, mechanics.iter().filter(|mechanic| mechanic.has_hero()).count() <= 1),
        (Unsound::Motion, types.iter().all(has_one_motion)),
        (Unsound::Unconnected, are_connected(mechanics.len(), types)),
        (Unsound::Idle, !types.iter().any(is_idle)),
        (Unsound::Goal, types.iter().all(has_honest_goal)),
        (Unsound::NoTension, types.iter().any(is_opposed)),
        (
            Unsound::NoAgency,
            types.iter().all(|merged| is_influenced(merged) && !wins_alone(merged, mechanics.len())),
        ),
        (Unsound::NoPressure, types.iter().any(|merged| is_pressure(merged, types))),
        (Unsound::TooMany, visible(mechanics, types) <= MOST_TYPES && are_few_crowded(types)),
    ];
    conditions.iter().find(|(_, holds)| !holds).map_or(Ok(()), |(why, _)| Err(*why))
}

pub(super) fn has_one_motion(merged: &Merged) -> bool {
    merged.count(Tag::Moves) == usize::from(merged.body == Body::Mover)
}

/// Returns `true` if shared (merged) types connect all mechanics.
pub(super) fn are_connected(mechanics: usize, types: &[Merged]) -> bool {
    let mut group: Vec<usize> = (0..mechanics).collect();
    for merged in types {
        let first = group[merged.ports[0].0.0];
        for ((mechanic, _), _) in &merged.ports {
            let old = group[*mechanic];
            group.iter_mut().filter(|at| **at == old).for_each(|at| *at = first);
        }
    }
    group.iter().all(|at| *at == group[0])
}

/// Returns `true` if the type is neither needed nor harmful, or if it is only carried or only blocks like a wall.
pub(super) fn is_idle(merged: &Merged) -> bool {
    let matters = [Tag::Tool, Tag::Goal, Tag::Harm, Tag::Bars, Tag::Road, Tag::Foe];
    let wanted = matters.iter().any(|tag| merged.has(*tag));
    let is_only_carried = merged.body == Body::Item && !merged.has(Tag::Tool) && !merged.has(Tag::Goal);
    // A type that only blocks is equivalent to a wall.
    let is_wall = merged.has(Tag::Bars)
        && ![Tag::Removed, Tag::Lost, Tag::Road, Tag::Tool, Tag::Goal].iter().any(|tag| merged.has(*tag));
    !wanted || is_only_carried || is_wall
}

/// Returns `true` if a goal can be achieved. Either the ending takes or requires the goal's type, or a different
/// mechanic removes it. A type that only has to be removed must exist from the beginning and must not be produced.
fn has_honest_goal(merged: &Merged) -> bool {
    // If an ending is lost with its last goal on the board, the loss comes before another mechanic produces more goals.
    let can_run_out =
        |(_, port): &(PortId, &Port)| port.tags.contains(&Tag::Goal) && port.tags.contains(&Tag::Lost);
    if merged.has(Tag::Goal)
        && merged.has(Tag::Made)
        && (!merged.has(Tag::Tool) || merged.ports.iter().any(can_run_out))
    {
        return false;
    }
    let is_only_counted = |port: &Port| {
        port.tags.contains(&Tag::Goal)
            && ![Tag::Removed, Tag::Tool, Tag::Spent].iter().any(|tag| port.tags.contains(tag))
    };
    !merged.ports.iter().any(|(_, port)| is_only_counted(port))
        || merged.has(Tag::Removed)
        || merged.has(Tag::Spent)
}

/// Returns `true` if the type's uses are opposed, so that using the type for one purpose has a price. This is the case
/// if one port needs the type, and another port spends or removes it, or makes it a danger or an obstacle.
pub(crate) fn is_opposed(merged: &Merged) -> bool {
    let ports = &merged.ports;
    let across = |one: Tag, other: Tag| {
        ports.iter().enumerate().any(|(at, (_, first))| {
            ports.iter().enumerate().any(|(to, (_, second))| {
                at != to && first.tags.contains(&one) && second.tags.contains(&other)
            })
        })
    };
    let wants = [Tag::Tool, Tag::Road, Tag::Goal];
    let costs = [Tag::Spent, Tag::Lost, Tag::Harm, Tag::Bars, Tag::Foe];
    wants.iter().any(|want| costs.iter().any(|cost| across(*want, *cost)))
        || across(Tag::Removed, Tag::Tool)
        || across(Tag::Removed, Tag::Road)
}

/// The tension above which a higher value makes no difference.
const ENOUGH: usize = 12;

/// Returns a score for the hard choices that merged types offer, up to [`ENOUGH`]. A type counts twice if it is a
/// danger that acts by itself and is also needed, or if two mechanics use it up. It counts once if its uses are opposed
/// in a different way, or if it is a danger that acts by itself and the player can remove it. The score is relative to
/// the number of mechanics.
pub(super) fn tension(mechanics: &[&'static Mechanic], types: &[Merged]) -> usize {
    let wants = [Tag::Tool, Tag::Road, Tag::Goal];
    let is_wanted = |port: &Port| wants.iter().any(|want| port.tags.contains(want));
    let is_needed_danger = |merged: &Merged| {
        let presses = |port: &Port| port.tags.contains(&Tag::Presses);
        merged.has(Tag::Presses) && merged.ports.iter().any(|(_, port)| !presses(port) && is_wanted(port))
    };
    let is_contested = |merged: &Merged| {
        let uses_up = |port: &Port| is_wanted(port) && merged.loses(port) || port.tags.contains(&Tag::Spent);
        merged.ports.iter().filter(|(_, port)| uses_up(port)).count() > 1
    };
    let score = |merged: &Merged| {
        if is_needed_danger(merged) || is_contested(merged) {
            2
        } else {
            usize::from(is_opposed(merged) || merged.has(Tag::Presses) && merged.has(Tag::Removed))
        }
    };
    (12 * types.iter().map(score).sum::<usize>() / mechanics.len().max(1)).min(ENOUGH)
}

/// Returns `true` if the player can influence a type that moves by itself, in a way other than avoiding it. If such a
/// type has to be brought to a place, the player must be able to guide it there.
fn is_influenced(merged: &Merged) -> bool {
    let is_affected = [Tag::Removed, Tag::Lost, Tag::Spent].iter().any(|tag| merged.has(*tag));
    merged.body != Body::Mover || merged.has(Tag::Led) || (is_affected && !merged.has(Tag::Brought))
}

/// Returns `true` if a danger that spreads by itself is also a place to which the ending requires objects to be
/// brought. Such a danger would reach the objects without the player's help.
fn wins_alone(merged: &Merged, mechanics: usize) -> bool {
    let is_place = |((mechanic, _), port): &(PortId, &Port)| {
        mechanic + 1 == mechanics && port.tags.contains(&Tag::Tool) && !port.tags.contains(&Tag::Spent)
    };
    merged.has(Tag::Presses) && merged.body != Body::Mover && merged.ports.iter().any(is_place)
}

/// Returns `true` if a type becomes a danger without any action by the player, and a different mechanic also uses it. A
/// danger that only the player can cause is easily avoided. A danger that takes things away without harming the player
/// counts only if it takes something that the ending needs.
fn is_pressure(merged: &Merged, types: &[Merged]) -> bool {
    let presses = |port: &Port| port.tags.contains(&Tag::Presses);
    merged.is_joint()
        && merged.ports.iter().filter(|(_, port)| presses(port)).any(|((mechanic, _), port)| {
            let is_indirect = !port.tags.contains(&Tag::Harm)
                && [Tag::Foe, Tag::Lost].iter().any(|tag| port.tags.contains(tag));
            let takes = |((of, _), port): &(PortId, &Port)| {
                let is_taken = port.tags.contains(&Tag::Lost)
                    || port.tags.contains(&Tag::Spent) && !port.tags.contains(&Tag::Tool);
                of == mechanic && is_taken
            };
            !is_indirect || types.iter().any(|taken| taken.has(Tag::Goal) && taken.ports.iter().any(takes))
        })
}

/// Counts the types that players can see.
fn visible(mechanics: &[&'static Mechanic], types: &[Merged]) -> usize {
    let own = mechanics.iter().flat_map(|mechanic| &mechanic.types);
    types.len() + own.filter(|own| own.body != Body::Flash).count()
}

/// Returns `true` if at most one type fills more than two ports (open roles of mechanics), and none fills more than
/// three.
fn are_few_crowded(types: &[Merged]) -> bool {
    let crowded = types.iter().filter(|merged| merged.ports.len() > 2).count();
    crowded <= 1 && types.iter().all(|merged| merged.ports.len() <= 3)
}
