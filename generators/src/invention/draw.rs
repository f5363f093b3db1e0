//! The constructive method of inventing games, which draws inventions at random.

use super::fiction::Noun;
use super::genome::{Invention, apart};
use super::mechanic::{Mechanic, Port, Tag};
use super::merge::{Merged, PortId, ports};
use super::soundness::{self, Unsound};
use base::{Sampler, Seed};
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// The number of partitions of the ports (the mechanics' open roles) to draw per choice of mechanics.
const PARTITIONS: usize = 24;
/// The maximum number of choices of mechanics per draw.
const CHOICES: u64 = 400;
/// The maximum number of ports (open roles of mechanics) that one sprite type fills.
const MOST_PORTS: usize = 3;
/// The number of sound draws (draws that can become a game) to compare. The draw with the hardest choices for the
/// player is preferred. Among equals, the draw whose merged pairs of ports (open roles of mechanics) were used least is
/// preferred.
const PROPOSALS: usize = 6;
/// The number added to the use count of each mechanic, so that the first few uses hardly change the weights.
const MECHANICS: u64 = 4;
/// The number added to the use count of each ending, so that the first few uses hardly change the weights.
const ENDINGS: u64 = 12;

/// The limits on the size of inventions.
#[derive(Clone, Debug)]
pub struct InventionConfig {
    /// The maximum number of mechanics besides the ending. The minimum is 2.
    pub mechanics: usize,
    /// The parts that each draw should contain.
    pub lead: Lead,
}

impl Default for InventionConfig {
    fn default() -> InventionConfig {
        InventionConfig { mechanics: 3, lead: Lead::default() }
    }
}

/// The mechanics and the ending that draws should contain, chosen by [`Census::lead`]. If no draw that can become a
/// game contains all of them, the mechanic is dropped first, and then the ending.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lead {
    /// The name of a mechanic.
    pub mechanic: Option<&'static str>,
    /// The name of a mechanic with a danger that acts by itself.
    pub danger: Option<&'static str>,
    /// The name of an ending.
    pub ending: Option<&'static str>,
}

/// The number of games in which each mechanic, each ending and each coupling (merged pair of ports) was used.
///
/// Draws prefer the least-used entries, so that over many months each of them occurs about equally often.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Census {
    uses: BTreeMap<String, u32>,
}

impl Census {
    /// Creates a census from the given use counts, by pattern (such as `mechanic/lock`).
    pub fn of(uses: &BTreeMap<String, u32>) -> Census {
        Census { uses: uses.clone() }
    }

    /// Counts a game by its patterns, such as `mechanic/lock`. Returns `false` if none of the patterns belongs to an
    /// invented game.
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

    /// Returns the number of games for each pattern.
    pub fn all(&self) -> impl Iterator<Item = (&str, u32)> {
        self.uses.iter().map(|(pattern, uses)| (pattern.as_str(), *uses))
    }

    /// Returns the counts for one kind of pattern, such as `mechanic`, by name.
    pub fn of_kind<'a>(&'a self, kind: &'a str) -> impl Iterator<Item = (&'a str, u32)> + 'a {
        self.uses
            .iter()
            .filter_map(move |(name, uses)| Some((name.strip_prefix(kind)?.strip_prefix('/')?, *uses)))
    }

    /// Returns the mechanics and the ending that a draw should contain: the danger and the ending for `turn`, and the
    /// mechanic for `mechanic_turn`. They take turns from least to most used, and the seed breaks ties. Thus, games
    /// that are drawn independently differ if their turns differ.
    pub fn lead(&self, seed: Seed, turn: usize, mechanic_turn: usize) -> Lead {
        let next = |(kind, part): (&str, u64), turn: usize, is_part: fn(&Mechanic) -> bool| {
            let parts = Mechanic::all().iter().filter(|mechanic| is_part(mechanic));
            let mut names: Vec<&'static str> = parts.map(|mechanic| mechanic.name.as_str()).collect();
            seed.child("leads", part).sampler().shuffle(&mut names);
            names.sort_by_key(|name| self.uses(kind, name));
            Some(names[turn % names.len()])
        };
        Lead {
            mechanic: next(("mechanic", 0), mechanic_turn, |mechanic| {
                mechanic.ending.is_none() && !mechanic.presses()
            }),
            danger: next(("mechanic", 1), turn, |mechanic| mechanic.ending.is_none() && mechanic.presses()),
            ending: next(("ending", 2), turn, |mechanic| mechanic.ending.is_some()),
        }
    }

    fn uses(&self, kind: &str, name: &str) -> u32 {
        self.uses.get(&format!("{kind}/{name}")).copied().unwrap_or_default()
    }

    /// Returns the total use count of an invention's couplings, which are its merged pairs of ports. A lower total
    /// makes an invention look newer.
    fn familiarity(&self, drawn: &Invention) -> u32 {
        drawn.couplings().iter().map(|pair| self.uses("coupling", pair)).sum()
    }

    /// Draws a mechanic or ending that is not in `others`, preferring the least-used ones.
    pub(super) fn choose(
        &self,
        is_ending: bool,
        others: &[&'static Mechanic],
        sampler: &mut Sampler,
    ) -> Option<&'static Mechanic> {
        choose_one(is_ending, others, self.weights().of(), sampler)
    }

    /// Returns the weights of all mechanics and endings in a draw. A weight decreases with the square of the number of
    /// uses relative to the mean. It is higher for mechanics that are rarely part of a draw that can become a game.
    fn weights(&self) -> Weights {
        let weights =
            [("mechanic", MECHANICS, false), ("ending", ENDINGS, true)].map(|(kind, prior, are)| {
                let all = Mechanic::endings(are).count().max(1);
                let mean = self.of_kind(kind).map(|(_, uses)| u64::from(uses)).sum::<u64>() / all as u64;
                let weight = move |mechanic: &'static Mechanic| {
                    let share = 64 * (mean + prior) / (u64::from(self.uses(kind, &mechanic.name)) + prior);
                    let weight = share * share * rarity(&mechanic.name) / 64;
                    (mechanic.name.as_str(), u32::try_from(weight.max(1)).unwrap_or(u32::MAX))
                };
                Mechanic::endings(are).map(weight).collect::<Vec<_>>()
            });
        Weights(weights.into_iter().flatten().collect())
    }
}

/// The weights of all mechanics and endings in a draw, by name.
struct Weights(BTreeMap<&'static str, u32>);

impl Weights {
    fn of(&self) -> impl Fn(&Mechanic) -> u32 {
        |mechanic| self.0.get(mechanic.name.as_str()).copied().unwrap_or_default()
    }
}

/// The number of samples used to measure how often each mechanic is part of a sound draw (one that can become a game).
const SAMPLES: u64 = 6_000;
/// The rarity of a mechanic that is part of sound draws (draws that can become a game) as often as the average
/// mechanic.
const USUAL: u64 = 16;
/// The maximum factor that [`rarity`] returns for a mechanic.
const RAREST: u64 = 64;

/// Returns the factor by which a mechanic's weight is increased because it is rarely part of a draw that can become a
/// game. The first call takes a third of a second.
fn rarity(name: &str) -> u64 {
    static ALL: OnceLock<BTreeMap<&str, u64>> = OnceLock::new();
    let all = ALL.get_or_init(|| {
        let seed = Seed::from_text("rarity of mechanics");
        let mut tried: BTreeMap<&str, (u64, u64)> = BTreeMap::new();
        for at in 0..SAMPLES {
            let sampler = &mut seed.child("sample", at).sampler();
            let count = size(&InventionConfig::default(), sampler);
            let Some(mechanics) = choose(count, Lead::default(), |_| 1, sampler) else { continue };
            let is_sound = partition(&mechanics, sampler)
                .is_some_and(|partition| Invention::of(mechanics.clone(), partition, sampler, seed).is_ok());
            for mechanic in mechanics {
                let (all, sound) = tried.entry(&mechanic.name).or_default();
                *all += 1;
                *sound += u64::from(is_sound);
            }
        }
        let sum = |part: fn(&(u64, u64)) -> u64| tried.values().map(part).sum::<u64>().max(1);
        let (all, sound) = (sum(|tried| tried.0), sum(|tried| tried.1));
        let factor = |(tried, own): (u64, u64)| USUAL * sound * (tried + 1) / (all * (own + 1)).max(1);
        tried.into_iter().map(|(name, tried)| (name, factor(tried).clamp(1, RAREST))).collect()
    });
    all.get(name).copied().unwrap_or(USUAL)
}

/// Returns `true` if two games, given by their patterns, share two mechanics, or a mechanic and the ending. Players
/// would consider them to be the same game.
pub fn share_idea(one: &[String], two: &[String]) -> bool {
    one.iter().filter(|pattern| is_part(pattern) && two.contains(pattern)).count() > 1
}

/// Returns `true` if a pattern names a mechanic or an ending.
pub fn is_part(pattern: &str) -> bool {
    pattern.starts_with("mechanic/") || pattern.starts_with("ending/")
}

impl Invention {
    /// Draws an invention whose rules compile. Cost: a few milliseconds.
    ///
    /// Returns `None` if none of several hundred draws can become a game.
    pub fn draw(config: &InventionConfig, census: &Census, seed: Seed) -> Option<Invention> {
        let any_mechanic = Lead { mechanic: None, ..config.lead };
        let danger_only = Lead { ending: None, ..any_mechanic };
        // All draws may be unsound if the requested mechanics do not fit any others, or if the use counts favour
        // mechanics that do not fit together.
        let (weights, equal) = (census.weights(), Census::default().weights());
        let tries = [
            (config.lead, &weights, "choice"),
            (any_mechanic, &weights, "choice without mechanic"),
            (danger_only, &weights, "choice without ending"),
            (Lead::default(), &equal, "any choice"),
        ];
        tries.into_iter().find_map(|(lead, weights, name)| {
            let config = InventionConfig { lead, ..config.clone() };
            let attempt = |at| Invention::attempt(&config, weights, seed.child(name, at));
            let mut drawn: Vec<Invention> = (0..CHOICES).filter_map(attempt).take(PROPOSALS).collect();
            drawn.sort_by_key(|drawn| (Reverse(drawn.tension()), census.familiarity(drawn)));
            drawn.into_iter().find(|drawn| drawn.build().is_ok())
        })
    }

    fn attempt(config: &InventionConfig, weights: &Weights, seed: Seed) -> Option<Invention> {
        let sampler = &mut seed.child("mechanics", 0).sampler();
        let count = size(config, sampler);
        let chosen = choose(count, config.lead, weights.of(), sampler)?;
        Invention::of_choice(chosen, sampler, seed)
    }

    /// Draws one choice of `count` mechanics, with equal probability for all choices. Returns an invention with these
    /// mechanics if a drawn partition of their ports (open roles) can become a game.
    pub(super) fn of_uniform_choice(count: usize, seed: Seed) -> Option<Invention> {
        let sampler = &mut seed.child("mechanics", 0).sampler();
        let drawn = Invention::of_choice(choose(count, Lead::default(), |_| 1, sampler)?, sampler, seed)?;
        drawn.build().is_ok().then_some(drawn)
    }

    fn of_choice(mechanics: Vec<&'static Mechanic>, sampler: &mut Sampler, seed: Seed) -> Option<Invention> {
        let fiction = seed.child("fiction", 0);
        (0..PARTITIONS).find_map(|_| {
            let partition = partition(&mechanics, sampler)?;
            Invention::of(mechanics.clone(), partition, sampler, fiction).ok()
        })
    }

    /// Makes a single draw, for statistics.
    ///
    /// # Errors
    /// Returns the unmet condition.
    pub fn sample(config: &InventionConfig, seed: Seed) -> Result<Invention, Unsound> {
        let sampler = &mut seed.child("mechanics", 0).sampler();
        let count = size(config, sampler);
        let mechanics = choose(count, Lead::default(), |_| 1, sampler).ok_or(Unsound::Idle)?;
        let partition = partition(&mechanics, sampler).ok_or(Unsound::Unconnected)?;
        Invention::of(mechanics, partition, sampler, seed.child("fiction", 0))
    }
}

/// Draws how many mechanics a game has. Half of the draws give the minimum, because players must grasp the rules
/// quickly.
fn size(config: &InventionConfig, sampler: &mut Sampler) -> usize {
    if sampler.ratio(1, 2) { config.mechanics.max(2) } else { 2 }
}

/// Draws a mechanic or ending that is not in `others`, by weight.
fn choose_one(
    is_ending: bool,
    others: &[&'static Mechanic],
    weight: impl Fn(&Mechanic) -> u32,
    sampler: &mut Sampler,
) -> Option<&'static Mechanic> {
    let free = |mechanic: &&'static Mechanic| !others.iter().any(|other| other.name == mechanic.name);
    let options: Vec<&'static Mechanic> = Mechanic::endings(is_ending).filter(free).collect();
    let weights: Vec<u32> = options.iter().map(|mechanic| weight(mechanic)).collect();
    Some(options[sampler.weighted(&weights)?])
}

/// Draws `count` distinct mechanics and then an ending, in proportion to their weights. The requested mechanics come
/// first. At least one mechanic is a danger that acts by itself. Returns `None` if too few mechanics have a positive
/// weight.
fn choose(
    count: usize,
    lead: Lead,
    weight: impl Fn(&Mechanic) -> u32,
    sampler: &mut Sampler,
) -> Option<Vec<&'static Mechanic>> {
    let named =
        |name: Option<&str>| Mechanic::all().iter().find(|mechanic| Some(mechanic.name.as_str()) == name);
    let mut chosen: Vec<&'static Mechanic> = named(lead.mechanic).into_iter().collect();
    if !chosen.iter().any(|mechanic| mechanic.presses()) {
        let pressing = |mechanic: &Mechanic| if mechanic.presses() { weight(mechanic) } else { 0 };
        let danger = named(lead.danger).map_or_else(|| choose_one(false, &chosen, pressing, sampler), Some);
        chosen.push(danger?);
    }
    while chosen.len() < count {
        chosen.push(choose_one(false, &chosen, &weight, sampler)?);
    }
    let ending = named(lead.ending).map_or_else(|| choose_one(true, &chosen, &weight, sampler), Some);
    chosen.push(ending?);
    Some(chosen)
}

/// Partitions the ports (the mechanics' open roles) at random. One sprite type fills all ports in a class. Merges
/// pairs of classes until shared types connect all mechanics, a rule moves every type that should move, and every
/// type is needed. May then merge one more pair. Returns `None` if no remaining pair repairs a type
/// or connects a mechanic.
fn partition(mechanics: &[&'static Mechanic], sampler: &mut Sampler) -> Option<Vec<u8>> {
    completed(mechanics, apart(mechanics), sampler)
}

/// Completes a partition in which some ports (the mechanics' open roles) are already merged, in the same way as
/// [`partition`].
pub(super) fn completed(
    mechanics: &[&'static Mechanic],
    begun: Vec<u8>,
    sampler: &mut Sampler,
) -> Option<Vec<u8>> {
    let mut draft = Draft { partition: begun, ports: ports(mechanics) };
    let mut pairs: Vec<(usize, usize)> = (0..draft.ports.len())
        .flat_map(|one| (one + 1..draft.ports.len()).map(move |other| (one, other)))
        .filter(|(one, other)| can_merge(&draft.ports[*one], &draft.ports[*other]))
        .collect();
    sampler.shuffle(&mut pairs);
    // Ports (open roles) whose type would be useless on its own are merged first, then the ports of unlinked mechanics.
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

/// A partition of the ports (the mechanics' open roles) under construction.
struct Draft {
    partition: Vec<u8>,
    ports: Vec<Ported>,
}

impl Draft {
    /// Returns `true` if the type that fills a port (an open role) would be useless, because it should move but has no
    /// rule of motion, or because nothing needs it.
    fn is_needy(&self, port: usize) -> bool {
        let members = self.members(self.partition[port]);
        let Some(merged) = Merged::of(members) else { return false };
        !soundness::has_one_motion(&merged) || soundness::is_idle(&merged)
    }

    fn members(&self, class: u8) -> Vec<Ported> {
        let all = self.ports.iter().zip(&self.partition);
        all.filter(|(_, other)| **other == class).map(|(port, _)| *port).collect()
    }

    /// Returns a mechanic to connect to the others, preferably one that does not share a type with any other mechanic;
    /// `None` if all mechanics are connected.
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

    /// Merges the first wanted pair that can be merged; returns `None` if there is no such pair.
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
            if merged.count(Tag::Moves) > 1 || !Noun::exists(merged.body, merged.predicates()) {
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
