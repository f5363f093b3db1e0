//! Variation of inventions for searches.

use super::draw::{Census, InventionConfig, completed};
use super::genome::{Invention, normal};
use super::mechanic::Mechanic;
use super::merge::ports;
use crate::Variation;
use base::{Sampler, Seed};

/// The number of attempts at a change before the parent is returned unchanged.
const ATTEMPTS: usize = 64;

/// A kind of mutation of an invention.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Change {
    /// Redraws a mechanic's numbers.
    Number,
    /// Changes the type that fills a port (an open role of a mechanic).
    Merge,
    /// Replaces a mechanic with a different one.
    Mechanic,
}

/// The kinds of mutation with their weights.
const CHANGES: [(Change, u32); 3] = [(Change::Mechanic, 4), (Change::Merge, 5), (Change::Number, 3)];

/// Inventions as search candidates. New candidates are drawn as in the constructive method. Mutation changes a
/// mechanic's numbers, a merge or a whole mechanic. Crossover replaces a mechanic with one from the other parent.
///
/// The rules of every candidate compile without errors or warnings. Cost: a few milliseconds per mutation.
#[derive(Clone, Debug, Default)]
pub struct InventionVariation {
    config: InventionConfig,
    census: Census,
}

impl InventionVariation {
    /// Creates a variation that prefers the mechanics, endings and merged pairs of ports (open roles) with the lowest
    /// use counts in the census.
    pub fn new(config: InventionConfig, census: Census) -> InventionVariation {
        InventionVariation { config, census }
    }

    /// Returns a genome with one change of the given kind, if the result can become a game.
    fn changed(&self, parent: &Invention, kind: Change, sampler: &mut Sampler) -> Option<Invention> {
        let mut child = parent.clone();
        match kind {
            Change::Number => {
                let at = sampler.below(child.mechanics.len());
                child.values[at] = child.mechanics[at].numbers.draw(sampler);
            }
            Change::Merge => {
                let ports = ports(&child.mechanics);
                let port = sampler.below(ports.len());
                let classes = child.partition.iter().max().map_or(0, |last| *last + 1);
                child.partition[port] = u8::try_from(sampler.below(usize::from(classes) + 1)).ok()?;
                child.partition = normal(&child.partition);
            }
            Change::Mechanic => {
                let at = sampler.below(child.mechanics.len());
                let is_ending = at + 1 == child.mechanics.len();
                let kept: Vec<&'static Mechanic> = child.mechanics.clone();
                let drawn = self.census.choose(is_ending, &kept, sampler)?;
                return child.replaced(at, drawn, sampler);
            }
        }
        child.check().is_ok().then_some(child)
    }
}

impl Invention {
    /// Returns the same invention with a different mechanic at the given index. The ports (open roles) of the new
    /// mechanic are merged from scratch.
    fn replaced(&self, at: usize, mechanic: &'static Mechanic, sampler: &mut Sampler) -> Option<Invention> {
        let mut mechanics = self.mechanics.clone();
        if mechanics.iter().any(|other| other.name == mechanic.name) {
            return None;
        }
        mechanics[at] = mechanic;
        let old = ports(&self.mechanics);
        let mut fresh = self.partition.iter().max().map_or(0, |last| *last + 1);
        let class = |id: (usize, usize)| {
            let kept = old.iter().position(|(other, _)| *other == id).filter(|_| id.0 != at);
            kept.map_or_else(
                || {
                    fresh += 1;
                    fresh
                },
                |port| self.partition[port],
            )
        };
        let begun: Vec<u8> = ports(&mechanics).iter().map(|(id, _)| *id).map(class).collect();
        let partition = completed(&mechanics, normal(&begun), sampler)?;
        Invention::of(mechanics, partition, sampler, self.fiction).ok()
    }
}

impl Variation for InventionVariation {
    type Candidate = Invention;

    fn create(&self, seed: Seed) -> Option<Invention> {
        Invention::draw(&self.config, &self.census, seed)
    }

    fn mutate(&self, parent: &Invention, sampler: &mut Sampler) -> Invention {
        let first = sampler.weighted(&CHANGES.map(|(_, weight)| weight)).unwrap_or_default();
        // If a kind of change is not possible, the next kind is tried.
        for at in first..first + CHANGES.len() {
            let (kind, _) = CHANGES[at % CHANGES.len()];
            let changed = (0..ATTEMPTS).filter_map(|_| self.changed(parent, kind, sampler));
            let mut sound = changed.filter(|child| child.key() != parent.key() && child.build().is_ok());
            if let Some(child) = sound.next() {
                return child;
            }
        }
        parent.clone()
    }

    /// Replaces a mechanic in one invention with a mechanic from the other.
    fn cross(&self, one: &Invention, two: &Invention, sampler: &mut Sampler) -> Invention {
        for _ in 0..ATTEMPTS {
            let at = sampler.below(one.mechanics.len());
            let from = match at + 1 == one.mechanics.len() {
                true => two.mechanics.len() - 1,
                false => sampler.below(two.mechanics.len() - 1),
            };
            let child = one.replaced(at, two.mechanics[from], sampler);
            if let Some(child) = child.filter(|child| child.build().is_ok()) {
                return child;
            }
        }
        one.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Annealing, AnnealingConfig, Evaluation, MapElites, MapElitesConfig, Search};
    use std::collections::{BTreeMap, BTreeSet};

    /// Requests candidates from a search, checks that each passes the static conditions and can be built, and returns
    /// the number of distinct candidates.
    fn check(mut search: impl Search<Candidate = Invention>) -> usize {
        let mut keys = BTreeSet::new();
        for _ in 0..4 {
            let candidates = search.ask(6);
            for candidate in &candidates {
                assert!(
                    candidate.check().is_ok() && candidate.build().is_ok(),
                    "{:?}",
                    candidate.couplings()
                );
                keys.insert(candidate.key());
            }
            let rate = |candidate: Invention| {
                let objective = candidate.couplings().len() as f64 / 16.0;
                (candidate, Evaluation { feasibility: 1.0, objective, measures: vec![objective] })
            };
            search.tell(candidates.into_iter().map(rate).collect());
        }
        keys.len()
    }

    #[test]
    fn searches_see_sound_inventions_only() {
        let (variation, seed) = (InventionVariation::default(), Seed::from_text("sound"));
        let annealing = Annealing::new(&variation, AnnealingConfig::of(48), seed);
        assert!(check(annealing) > 12);
        let axes = vec![crate::Axis::new("couplings", (0.0, 1.0), 8)];
        let config = MapElitesConfig { initial: 8, ..MapElitesConfig::default() };
        assert!(check(MapElites::new(&variation, Invention::key, axes, config, seed)) > 12);
    }

    #[test]
    fn changes_bring_in_what_the_census_counts_least() {
        let rare = "lock";
        let all = Mechanic::all().iter().map(|mechanic| mechanic.name.as_str());
        let kind = |name: &str| {
            if Mechanic::endings(true).any(|other| other.name == name) { "ending" } else { "mechanic" }
        };
        let uses: BTreeMap<String, u32> =
            all.filter(|name| *name != rare).map(|name| (format!("{}/{name}", kind(name)), 40)).collect();
        let seed = Seed::from_text("rare");
        let plain = InventionVariation::default();
        let with = |census: Census| {
            let variation = InventionVariation::new(InventionConfig::default(), census);
            let parents = (0..64).filter_map(|at| plain.create(seed.child("parent", at)));
            let parents = parents.filter(|parent| !parent.mechanics().any(|name| name == rare));
            let child = |(at, parent): (u64, Invention)| {
                variation.mutate(&parent, &mut seed.child("child", at).sampler())
            };
            (0..).zip(parents).map(child).filter(|child| child.mechanics().any(|name| name == rare)).count()
        };
        let (often, seldom) = (with(Census::of(&uses)), with(Census::default()));
        assert!(often > seldom + 2, "{often} {seldom}");
    }
}
