//! The types that result from merging ports, which are the open roles of mechanics.

use super::fiction::Predicates;
use super::mechanic::{Body, Mechanic, Port, Tag};
use crate::boards::Idiom;
use std::collections::BTreeSet;

/// A port (an open role of a mechanic), given by the index of its mechanic and its index within the mechanic.
pub(crate) type PortId = (usize, usize);

/// A type that fills one or more ports (open roles of mechanics).
#[derive(Clone, Debug)]
pub(crate) struct Merged {
    pub(crate) ports: Vec<(PortId, &'static Port)>,
    pub(crate) body: Body,
}

impl Merged {
    /// Merges ports (open roles of mechanics). Returns `None` if no body can fill all ports, or if two ports belong to
    /// the same mechanic.
    pub(crate) fn of(ports: Vec<(PortId, &'static Port)>) -> Option<Merged> {
        let mechanics: BTreeSet<usize> = ports.iter().map(|((mechanic, _), _)| *mechanic).collect();
        let (first, others) = ports.split_first()?;
        let fits = |body: &&Body| others.iter().all(|(_, port)| port.bodies.contains(body));
        let body = *first.1.bodies.iter().find(fits)?;
        (mechanics.len() == ports.len()).then_some(Merged { ports, body })
    }

    /// Returns `true` if one of the ports (roles) that the type fills has the given tag, which states its use.
    pub(crate) fn has(&self, tag: Tag) -> bool {
        self.ports.iter().any(|(_, port)| port.tags.contains(&tag))
    }

    /// Counts the ports (roles) with the given tag that the type fills.
    pub(crate) fn count(&self, tag: Tag) -> usize {
        self.ports.iter().filter(|(_, port)| port.tags.contains(&tag)).count()
    }

    /// Returns `true` if an ending needs the type's sprites to exist until the player takes them. Any other loss of
    /// such a sprite ends the game.
    pub(crate) fn is_kept_for(&self, ending: usize) -> bool {
        let is_taken = |((mechanic, _), port): &(PortId, &Port)| {
            *mechanic == ending && port.tags.contains(&Tag::Goal) && port.tags.contains(&Tag::Removed)
        };
        self.ports.iter().any(is_taken)
    }

    /// Returns `true` if the mechanic with the given port (open role) removes sprites of the type from the board.
    pub(crate) fn loses(&self, port: &Port) -> bool {
        port.tags.contains(&Tag::Lost) || (port.tags.contains(&Tag::Spent) && self.body != Body::Item)
    }

    /// Returns the predicates required for the type's noun.
    pub(crate) fn predicates(&self) -> Predicates {
        self.ports.iter().fold(Predicates::default(), |all, (_, port)| all.with(port.predicates))
    }

    /// Returns the kind of position that suits the type on boards, as far as the type's ports determine it.
    pub(crate) fn idiom(&self) -> Idiom {
        let is = |words: &[&str]| self.predicates().words().any(|word| words.contains(&word));
        match self.body {
            _ if is(&["exit"]) && self.has(Tag::Goal) => Idiom::Exit,
            Body::Item | Body::Flash => Idiom::Thing,
            Body::Crate => Idiom::Heavy,
            Body::Mover => Idiom::Thing,
            Body::Solid if is(&["hole", "water"]) => Idiom::Crossing,
            Body::Solid if self.has(Tag::Bars) => Idiom::Barrier,
            Body::Solid => Idiom::Thing,
            Body::Ground if is(&["burns", "soft", "thin", "bridge", "slippery", "sticky", "water"]) => {
                Idiom::Ground
            }
            Body::Ground => Idiom::Spot,
        }
    }

    /// Returns `true` if the type fills more than one port (open role of a mechanic).
    pub(crate) fn is_joint(&self) -> bool {
        self.ports.len() > 1
    }
}

/// Returns all ports (open roles) of the mechanics, mechanic by mechanic.
pub(crate) fn ports(mechanics: &[&'static Mechanic]) -> Vec<(PortId, &'static Port)> {
    let of_mechanic = |(at, mechanic): (usize, &&'static Mechanic)| {
        let mechanic: &'static Mechanic = mechanic;
        mechanic.ports.iter().enumerate().map(move |(port, value)| ((at, port), value))
    };
    mechanics.iter().enumerate().flat_map(of_mechanic).collect()
}

/// Groups ports (open roles of mechanics) by the class that a partition assigns to each.
pub(crate) fn merged(mechanics: &[&'static Mechanic], partition: &[u8]) -> Option<Vec<Merged>> {
    let ports = ports(mechanics);
    let classes = partition.iter().max().map_or(0, |last| usize::from(*last) + 1);
    let mut groups = vec![Vec::new(); classes];
    for (port, class) in ports.into_iter().zip(partition) {
        groups[usize::from(*class)].push(port);
    }
    groups.into_iter().map(Merged::of).collect()
}
