//! Characteristics of inventions that are known before any board exists. An archive uses them as axes.

use super::genome::Invention;
use super::mechanic::{Body, Tag};
use super::merge::Merged;
use super::soundness::is_opposed;

base::named_enum! {
    /// The player's most distinctive action on a game's types.
    pub enum Verb {
        /// The player changes its shape, state or way of moving.
        Change = "change",
        /// The player pushes objects.
        Push = "push",
        /// The player uses up items that it carries.
        Spend = "spend",
        /// The player removes obstacles.
        Open = "open",
        /// The player decides where a sprite that moves by itself goes.
        Lead = "lead",
        /// The player only collects, catches or avoids objects.
        Take = "take",
    }
}

impl Verb {
    /// Returns the verb's index in the list of all verbs.
    pub fn number(self) -> usize {
        Verb::ALL.into_iter().position(|verb| verb == self).unwrap_or_default()
    }
}

/// An invention's characteristics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    /// The number of ports (roles of mechanics) that are filled by types with opposed uses. Such a type is needed in
    /// one port, and used up, removed, harmful or in the way in another.
    pub coupling: usize,
    /// The most distinctive verb.
    pub verb: Verb,
    /// The fraction of types that move by themselves, from 0.0 to 1.0.
    pub pace: f64,
}

impl Invention {
    /// Returns the invention's characteristics. Cost: microseconds.
    pub fn profile(&self) -> Profile {
        let types = self.types().unwrap_or_default();
        let opposed = types.iter().filter(|merged| is_opposed(merged));
        let movers = types.iter().filter(|merged| merged.body == Body::Mover).count();
        Profile {
            coupling: opposed.map(|merged| merged.ports.len()).sum(),
            verb: self.verb(&types),
            pace: movers as f64 / types.len().max(1) as f64,
        }
    }

    fn verb(&self, types: &[Merged]) -> Verb {
        let any = |is: &dyn Fn(&Merged) -> bool| types.iter().any(is);
        let is_spent = |merged: &Merged| merged.body == Body::Item && merged.has(Tag::Spent);
        let verbs = [
            (Verb::Push, any(&|merged| merged.body == Body::Crate)),
            (Verb::Spend, any(&is_spent)),
            (Verb::Open, any(&|merged| merged.has(Tag::Bars) && merged.has(Tag::Removed))),
            (Verb::Lead, any(&|merged| merged.has(Tag::Led))),
            (Verb::Change, self.mechanics.iter().any(|mechanic| mechanic.has_hero())),
        ];
        verbs.into_iter().find(|(_, is_done)| *is_done).map_or(Verb::Take, |(verb, _)| verb)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::invention::{Census, InventionConfig};
    use base::Seed;
    use std::collections::BTreeMap;

    #[test]
    fn draws_differ_in_all_characteristics() {
        let seed = Seed::from_text("profiles");
        let draw =
            |at| Invention::draw(&InventionConfig::default(), &Census::default(), seed.child("draw", at));
        let profiles: Vec<Profile> = (0..80).filter_map(draw).map(|drawn| drawn.profile()).collect();
        let mut verbs: BTreeMap<Verb, usize> = BTreeMap::new();
        profiles.iter().for_each(|profile| *verbs.entry(profile.verb).or_default() += 1);
        let couplings = profiles.iter().map(|profile| profile.coupling);
        let (least, most) = (couplings.clone().min(), couplings.max());
        assert!(least >= Some(2) && most > Some(4), "{least:?} {most:?}: some type is opposed to itself");
        assert!(verbs.len() >= 4 && verbs.values().all(|count| *count < 50), "{verbs:?}");
        assert!(profiles.iter().all(|profile| (0.0..=1.0).contains(&profile.pace)));
    }
}
