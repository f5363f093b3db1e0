//! Grafts: types of one kernel, with the rules that tie them to types of the same roles in another kernel.

use crate::kernels::file::kernel::{Casting, Kernel};
use crate::kernels::file::map::{Item, Place};
use crate::kernels::words::scene::Scene;
use base::Seed;
use engine::Description;
use engine::syntax::{self, InteractionLine, SpriteLine};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

/// The maximum number of types in a graft.
const MAX_TYPES: usize = 3;
/// Types that every kernel has.
const SHARED: [&str; 3] = ["hero", "wall", "floor"];

/// Types of another kernel, ready to be added to games of one kernel.
#[derive(Debug)]
pub(crate) struct Graft {
    /// The name of the source kernel and of the type there: `fed-for-one-meal/bait`.
    pub(crate) name: String,
    /// The new types, with names that the kernel does not use.
    pub(crate) sprites: Vec<SpriteLine>,
    /// The rules of the new types, with the kernel's names.
    pub(crate) interactions: Vec<InteractionLine>,
    pub(crate) roles: BTreeMap<String, Casting>,
    /// Sentences of the other kernel about the new types.
    pub(crate) facts: Vec<String>,
    /// The mapping from names in the other kernel to names in the game.
    pub(crate) names: BTreeMap<String, String>,
    /// The sprites that a level places, as the other kernel's maps do.
    pub(crate) items: Vec<Item>,
}

impl Graft {
    /// Returns all grafts that games of a kernel can take. They are computed once.
    pub(crate) fn all(host: &Kernel) -> &'static [Graft] {
        static ALL: OnceLock<BTreeMap<String, Vec<Graft>>> = OnceLock::new();
        let all = ALL.get_or_init(|| {
            let guests: Vec<Guest<'_>> = Kernel::all().iter().filter_map(Guest::of).collect();
            let grafts = |host: &Kernel| {
                let others = guests.iter().filter(|guest| guest.kernel.name != host.name);
                others.flat_map(|guest| guest.grafts(host)).collect()
            };
            Kernel::all().iter().map(|host| (host.name.clone(), grafts(host))).collect()
        });
        all.get(&host.name).map_or(&[], Vec::as_slice)
    }

    /// Returns an item with the game's name for its type.
    pub(crate) fn placed(&self, item: &Item) -> Item {
        Item { stype: self.names[&item.stype].clone(), ..item.clone() }
    }

    /// Returns `true` if a scene has a noun for each role of the new types.
    pub(crate) fn fits(&self, scene: &Scene, kernel: &Kernel) -> bool {
        self.roles.values().all(|casting| match casting {
            Casting::Role(role) => scene.nouns(role, &kernel.name).is_some(),
            Casting::State { .. } => true,
        })
    }
}

/// A kernel as a source of grafts.
struct Guest<'a> {
    kernel: &'a Kernel,
    rules: Description,
    values: Vec<u32>,
}

impl<'a> Guest<'a> {
    fn of(kernel: &'a Kernel) -> Option<Guest<'a>> {
        let values = kernel.numbers.draw(&mut Seed::from_text(&kernel.name).child("graft", 0).sampler());
        let (rules, problems) = syntax::parse(&kernel.text(&[], &values));
        problems.is_empty().then_some(Guest { kernel, rules, values })
    }

    fn grafts(&self, host: &Kernel) -> Vec<Graft> {
        let role = |kernel: &Kernel, role: &str| {
            let named = |(_, casting): &(&String, &Casting)| **casting == Casting::Role(role.to_owned());
            kernel.roles.iter().find(named).map(|(stype, _)| stype.clone())
        };
        // Types with the same role are the same thing in both kernels.
        let mut names: BTreeMap<String, String> =
            SHARED.map(|stype| (stype.to_owned(), stype.to_owned())).into();
        for (stype, casting) in &self.kernel.roles {
            if let Casting::Role(of) = casting
                && let Some(own) = role(host, of)
            {
                names.insert(stype.clone(), own);
            }
        }
        let strange =
            self.kernel.roles.iter().filter(|(stype, casting)| {
                matches!(casting, Casting::Role(_)) && !names.contains_key(*stype)
            });
        strange.filter_map(|(stype, _)| self.graft(host, stype, &names)).collect()
    }

    /// Returns the graft of a type, if it has rules about the hero and about a type of the host.
    fn graft(&self, host: &Kernel, stype: &str, same: &BTreeMap<String, String>) -> Option<Graft> {
        let items = self.items(stype)?;
        let mut types: BTreeSet<&str> = BTreeSet::from([stype]);
        // The graft includes everything that its types turn into or create.
        loop {
            let (lines, rules) = (self.sprites(&types)?, self.interactions(&types, same));
            let params = lines.iter().flat_map(|line| &line.params);
            let named: Vec<&str> = params
                .chain(rules.iter().flat_map(|line| &line.params))
                .filter_map(|param| self.kernel.roles.get_key_value(&param.value.text))
                .map(|(name, _)| name.as_str())
                .filter(|name| !types.contains(name) && !same.contains_key(*name))
                .collect();
            if named.is_empty() {
                break;
            }
            types.extend(named);
            if types.len() > MAX_TYPES {
                return None;
            }
        }
        let mut names = same.clone();
        for &stype in &types {
            let taken = host.knows(stype).then(|| format!("{stype}Too"));
            names.insert(stype.to_owned(), taken.unwrap_or_else(|| stype.to_owned()));
        }
        let interactions = self.interactions(&types, same);
        let meets = |wanted: &dyn Fn(&str) -> bool| {
            let sides = |line: &InteractionLine| {
                line.second.iter().chain([&line.first]).any(|word| wanted(&word.text))
            };
            interactions.iter().any(sides)
        };
        let ties = meets(&|name| name == "hero")
            && meets(&|name| same.contains_key(name) && !SHARED.contains(&name));
        if !ties {
            return None;
        }
        let role = |stype: &&str| {
            let casting = match &self.kernel.roles[*stype] {
                Casting::State { of, adjective } => {
                    Casting::State { of: names.get(of).unwrap_or(of).clone(), adjective: adjective.clone() }
                }
                role => role.clone(),
            };
            (names[*stype].clone(), casting)
        };
        let facts = self
            .kernel
            .facts
            .iter()
            .map(|fact| crate::kernels::file::template::filled(fact, &self.kernel.numbers, &self.values));
        let graft = Description {
            sprites: self.sprites(&types)?.into_iter().cloned().collect(),
            interactions: interactions.clone(),
            ..self.rules.clone()
        };
        let graft = graft.renamed(&names);
        Some(Graft {
            name: format!("{}/{stype}", self.kernel.name),
            sprites: graft.sprites,
            interactions: graft.interactions,
            roles: types.iter().map(role).collect(),
            facts: facts
                .filter(|fact| {
                    crate::kernels::words::phrase::tells_of(fact, stype)
                        && crate::kernels::words::phrase::fill(fact, &names).is_ok()
                })
                .collect(),
            names,
            items,
        })
    }

    /// Returns the sprite lines of the types; `None` if one of the types is part of a group.
    fn sprites(&self, types: &BTreeSet<&str>) -> Option<Vec<&SpriteLine>> {
        let line = |stype: &&str| {
            let named = |line: &&SpriteLine| line.name.text == *stype && line.children.is_empty();
            self.rules.sprites.iter().find(named)
        };
        types.iter().map(line).collect()
    }

    /// Returns the rules among the types, and between the types and types of the host.
    fn interactions(&self, types: &BTreeSet<&str>, same: &BTreeMap<String, String>) -> Vec<InteractionLine> {
        let is_known = |name: &str| types.contains(name) || same.contains_key(name);
        let rule = |line: &InteractionLine| {
            let mut line = line.clone();
            line.second.retain(|word| is_known(&word.text));
            let first = types.contains(line.first.text.as_str());
            if !first {
                line.second.retain(|word| types.contains(word.text.as_str()));
            }
            let foreign = line.params.iter().any(|param| {
                let name = param.value.text.as_str();
                self.kernel.roles.contains_key(name) && !is_known(name)
            });
            (is_known(&line.first.text) && !line.second.is_empty() && !foreign).then_some(line)
        };
        self.rules.interactions.iter().filter_map(rule).collect()
    }

    /// Returns the items by which a level places the type: an item of the kernel's maps, or one that stands apart from
    /// other things if the type occurs only in drawn pieces.
    fn items(&self, stype: &str) -> Option<Vec<Item>> {
        let maps = self.kernel.levels.iter().filter_map(|level| level.map(&self.values).ok());
        let rooms: Vec<_> = maps.flat_map(|map| map.rooms).collect();
        if let Some(item) = rooms.iter().flat_map(|room| &room.items).find(|item| item.stype == stype) {
            return Some(vec![item.clone()]);
        }
        let symbol = self.kernel.legend.iter().find(|(_, name)| *name == stype).map(|(symbol, _)| *symbol)?;
        let pieces = rooms.iter().filter_map(|room| self.kernel.pieces.get(&room.piece.as_ref()?.name));
        let is_drawn = pieces.flatten().any(|row| row.contains(symbol));
        is_drawn.then(|| vec![Item { stype: stype.to_owned(), count: (1, 1), place: Place::default() }])
    }
}
