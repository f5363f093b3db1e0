//! Drawing of inventions: the constructive method.

use super::fiction::Noun;
use super::genome::{Invention, apart};
use super::mechanic::{Mechanic, Port, Tag};
use super::merge::{Merged, PortId, ports};
use super::soundness::{self, Unsound};
use base::{Sampler, Seed};
use std::collections::BTreeMap;

/// The number of partitions that are drawn for a choice of mechanics.
const PARTITIONS: usize = 24;
/// The number of choices of mechanics before a draw fails.
const CHOICES: u64 = 400;
/// The most ports that one type fills.
const MOST_PORTS: usize = 3;
/// The weight of a mechanic that no earlier game has.
const FRESH: u32 = 6400;

/// What an invention is drawn of.
#[derive(Clone, Debug)]
pub struct InventionConfig {
    /// The number of mechanics besides the ending: from 2 to this.
    pub mechanics: usize,
}

impl Default for InventionConfig {
    fn default() -> InventionConfig {
        InventionConfig { mechanics: 3 }
    }
}

/// The number of games in which each mechanic, ending and coupling was used.
///
/// A draw prefers what was used least, so that players of many months see all mechanics equally often.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Census {
    uses: BTreeMap<String, u32>,
}

impl Census {
    /// Creates a census with these counts by pattern.
    pub fn of(uses: &BTreeMap<String, u32>) -> Census {
        Census { uses: uses.clone() }
    }

    /// Counts a game by its patterns, such as `mechanic/lock`; returns `false` if no pattern is one of an invented game.
    pub fn count<'a>(&mut self, patterns: impl IntoIterator<Item = &'a str>) -> bool {
        let mut is_invented = false;
        for pattern in patterns {
            if ["mechanic/", "ending/", "coupling/"].iter().any(|kind| pattern.starts_with(kind)) {
                *self.uses.entry(pattern.to_owned()).or_default() += 1;
                is_invented = true;
            }
        }
        is_invented
    }

    /// Returns all counts by pattern.
    pub fn all(&self) -> impl Iterator<Item = (&str, u32)> {
        self.uses.iter().map(|(pattern, uses)| (pattern.as_str(), *uses))
    }

    /// Returns the counts of a kind of pattern, such as `mechanic`, by name.
    pub fn of_kind<'a>(&'a self, kind: &'a str) -> impl Iterator<Item = (&'a str, u32)> + 'a {
        self.uses
            .iter()
            .filter_map(move |(name, uses)| Some((name.strip_prefix(kind)?.strip_prefix('/')?, *uses)))
    }

    fn uses(&self, kind: &str, name: &str) -> u32 {
        self.uses.get(&format!("{kind}/{name}")).copied().unwrap_or_default()
    }

    /// The weight of what was used so often: it falls with the square of its excess over the rarest.
    fn weight(&self, kind: &str, name: &str, least: u32) -> u32 {
        let excess = 1 + self.uses(kind, name).saturating_sub(least);
        (FRESH / (excess * excess)).max(1)
    }

    /// Draws a mechanic, or an ending, that is not one of `others`: the least used most often.
    pub(super) fn choose(
        &self,
        is_ending: bool,
        others: &[&'static Mechanic],
        sampler: &mut Sampler,
    ) -> Option<&'static Mechanic> {
        let kind = if is_ending { "ending" } else { "mechanic" };
        let free = |mechanic: &&'static Mechanic| !others.iter().any(|other| other.name == mechanic.name);
        let options: Vec<&'static Mechanic> = Mechanic::endings(is_ending).filter(free).collect();
        let least = options.iter().map(|mechanic| self.uses(kind, &mechanic.name)).min()?;
        let weights: Vec<u32> =
            options.iter().map(|mechanic| self.weight(kind, &mechanic.name, least)).collect();
        Some(options[sampler.weighted(&weights)?])
    }
}

impl Invention {
    /// Draws an invention whose rules compile. Cost: some milliseconds.
    ///
    /// Returns `None` if no draw of a few hundred is sound.
    pub fn draw(config: &InventionConfig, census: &Census, seed: Seed) -> Option<Invention> {
        (0..CHOICES).find_map(|at| Invention::attempt(config, census, seed.child("choice", at)))
    }

    fn attempt(config: &InventionConfig, census: &Census, seed: Seed) -> Option<Invention> {
        let sampler = &mut seed.child("mechanics", 0).sampler();
        let count = sampler.between(2, config.mechanics.max(2));
        let mechanics = choose(count, census, sampler)?;
        let fiction = seed.child("fiction", 0);
        let drawn = (0..PARTITIONS).find_map(|_| {
            let partition = partition(&mechanics, sampler)?;
            Invention::of(mechanics.clone(), partition, sampler, fiction).ok()
        })?;
        drawn.build().is_ok().then_some(drawn)
    }

    /// Draws once and returns the condition that the draw does not meet, for statistics.
    ///
    /// # Errors
    /// The condition that is not met.
    pub fn sample(config: &InventionConfig, seed: Seed) -> Result<Invention, Unsound> {
        let sampler = &mut seed.child("mechanics", 0).sampler();
        let count = sampler.between(2, config.mechanics.max(2));
        let mechanics = choose(count, &Census::default(), sampler).ok_or(Unsound::Idle)?;
        let partition = partition(&mechanics, sampler).ok_or(Unsound::Unconnected)?;
        Invention::of(mechanics, partition, sampler, seed.child("fiction", 0))
    }
}

/// Draws different mechanics and an ending, the least used most often.
fn choose(count: usize, census: &Census, sampler: &mut Sampler) -> Option<Vec<&'static Mechanic>> {
    let mut chosen: Vec<&'static Mechanic> = Vec::new();
    for number in 0..=count {
        chosen.push(census.choose(number == count, &chosen, sampler)?);
    }
    Some(chosen)
}

/// Draws a partition: merges pairs of ports until every mechanic is linked, every mover has its motion and nothing is idle, and
/// perhaps one pair more.
fn partition(mechanics: &[&'static Mechanic], sampler: &mut Sampler) -> Option<Vec<u8>> {
    let ports = ports(mechanics);
    let mut draft = Draft { partition: apart(mechanics), ports };
    let mut pairs: Vec<(usize, usize)> = (0..draft.ports.len())
        .flat_map(|one| (one + 1..draft.ports.len()).map(move |other| (one, other)))
        .filter(|(one, other)| can_merge(&draft.ports[*one], &draft.ports[*other]))
        .collect();
    sampler.shuffle(&mut pairs);
    // Ports that are nothing alone choose first, then mechanics that nothing links.
    for port in 0..draft.ports.len() {
        if draft.is_needy(port) {
            draft.merge_one(&pairs, |one, other| one == port || other == port)?;
        }
    }
    while let Some(mechanic) = draft.lonely(mechanics.len()) {
        let owners: Vec<usize> = draft.ports.iter().map(|((owner, _), _)| *owner).collect();
        draft.merge_one(&pairs, |one, other| (owners[one] == mechanic) != (owners[other] == mechanic))?;
    }
    if sampler.ratio(1, 3) {
        draft.merge_one(&pairs, |_, _| true);
    }
    Some(draft.partition)
}

type Ported = (PortId, &'static Port);

/// A partition that is being drawn.
struct Draft {
    partition: Vec<u8>,
    ports: Vec<Ported>,
}

impl Draft {
    /// Tests whether the type of a port would be nothing: a mover without motion, or a thing that nobody wants.
    fn is_needy(&self, port: usize) -> bool {
        let members = self.members(self.partition[port]);
        let Some(merged) = Merged::of(members) else { return false };
        !soundness::has_one_motion(&merged) || soundness::is_idle(&merged)
    }

    fn members(&self, class: u8) -> Vec<Ported> {
        let all = self.ports.iter().zip(&self.partition);
        all.filter(|(_, other)| **other == class).map(|(port, _)| *port).collect()
    }

    /// Returns a mechanic whose ports share no type with another, if there is one.
    fn lonely(&self, mechanics: usize) -> Option<usize> {
        let types: Vec<Merged> = (0..=u8::MAX)
            .map_while(|class| (usize::from(class) < self.ports.len()).then(|| self.members(class)))
            .filter_map(Merged::of)
            .collect();
        (!soundness::are_connected(mechanics, &types)).then(|| {
            let is_linked = |mechanic: usize| {
                let has = |merged: &Merged| merged.ports.iter().any(|((of, _), _)| *of == mechanic);
                types.iter().any(|merged| merged.is_joint() && has(merged))
            };
            (0..mechanics).find(|mechanic| !is_linked(*mechanic)).unwrap_or(mechanics - 1)
        })
    }

    /// Merges the first pair that can be merged; `None` if there is none.
    fn merge_one(
        &mut self,
        pairs: &[(usize, usize)],
        is_wanted: impl Fn(usize, usize) -> bool,
    ) -> Option<()> {
        pairs.iter().filter(|(one, other)| is_wanted(*one, *other)).find_map(|(one, other)| {
            let (into, from) = (self.partition[*one], self.partition[*other]);
            let members = [self.members(into), self.members(from)].concat();
            if into == from || members.len() > MOST_PORTS {
                return None;
            }
            let merged = Merged::of(members)?;
            if merged.count(Tag::Moves) > 1
                || !Noun::all().iter().any(|noun| noun.fits(merged.body, merged.predicates()))
            {
                return None;
            }
            self.partition.iter_mut().filter(|class| **class == from).for_each(|class| *class = into);
            Some(())
        })
    }
}

fn can_merge(((first, _), one): &Ported, ((second, _), other): &Ported) -> bool {
    let both_move = one.tags.contains(&Tag::Moves) && other.tags.contains(&Tag::Moves);
    first != second && !both_move && one.bodies.iter().any(|body| other.bodies.contains(body))
}
