//! The genome of an invented game: mechanics, a partition of their ports (open roles) into types, numbers and texts.

use super::emit;
use super::fiction::Fiction;
use super::mechanic::Mechanic;
use super::merge::{Merged, merged, ports};
use super::soundness::{self, Unsound};
use crate::GenerateError;
use crate::boards::Idiom;
use crate::games::{GeneratedGame, Kind};
use crate::kernels::has_movers;
use base::{Digest, Sampler, Seed};
use engine::{Game, syntax};
use itertools::Itertools;

/// An invented game as a list of choices.
#[derive(Clone, Debug)]
pub struct Invention {
    /// The mechanics. The last one is the ending, which states how the game is won.
    pub(super) mechanics: Vec<&'static Mechanic>,
    /// The index of the type that fills each port (open role of a mechanic), in the order of [`ports`].
    pub(super) partition: Vec<u8>,
    /// The values of each mechanic's numeric parameters.
    pub(super) values: Vec<Vec<u32>>,
    /// The seed for the nouns, the title and the story.
    pub(super) fiction: Seed,
    /// The number of ticks after which the game is lost; `None` if there is no limit.
    pub(super) time: Option<u32>,
}

/// An invented game that compiles.
#[derive(Clone, Debug)]
pub struct Invented {
    /// The game, with its texts.
    pub game: GeneratedGame,
    /// For each mechanic except the ending, the indices of its interactions. The list is empty if the mechanic only
    /// defines a motion or a class.
    pub mechanics: Vec<Vec<usize>>,
    /// The kind of position ([`Idiom`]) that suits each placeable type, by type name.
    pub idioms: Vec<(String, Idiom)>,
    /// For each mechanic except the ending, the types that no other mechanic uses. Without these types, a board lacks
    /// the mechanic.
    pub own_types: Vec<Vec<String>>,
}

/// The maximum number of rules that follow from the bodies (the physical nature) of types but never apply. Games with
/// more such rules are rejected.
const MOST_IDLE: usize = 8;
/// The tick limit of an invention whose wins are not yet known.
const LONG: u32 = 399;

impl Invention {
    /// Builds an invention from mechanics, the last of which is the ending.
    ///
    /// # Errors
    /// Returns the unmet condition.
    pub(super) fn of(
        mechanics: Vec<&'static Mechanic>,
        partition: Vec<u8>,
        sampler: &mut Sampler,
        fiction: Seed,
    ) -> Result<Invention, Unsound> {
        let partition = normal(&partition);
        let values = mechanics.iter().map(|mechanic| mechanic.numbers.draw(sampler)).collect();
        let invention = Invention { mechanics, partition, values, fiction, time: Some(LONG) };
        invention.check()?;
        Ok(invention)
    }

    /// Checks the static conditions.
    ///
    /// # Errors
    /// Returns the first unmet condition.
    pub(super) fn check(&self) -> Result<(), Unsound> {
        let types = self.types().ok_or(Unsound::Body)?;
        soundness::check(&self.mechanics, &types)?;
        if Fiction::can_name(&types, &self.mechanics) { Ok(()) } else { Err(Unsound::Noun) }
    }

    /// Returns a score for the hard choices that the rules offer; see [`soundness::tension`].
    pub(super) fn tension(&self) -> usize {
        self.types().map_or(0, |types| soundness::tension(&self.mechanics, &types))
    }

    /// Returns the types that result from merging ports (open roles of mechanics); `None` if some type has no body that
    /// fits all of its ports.
    pub(super) fn types(&self) -> Option<Vec<Merged>> {
        merged(&self.mechanics, &self.partition)
    }

    /// Returns the names of the mechanics. The last mechanic is the ending.
    pub fn mechanics(&self) -> impl Iterator<Item = &'static str> {
        self.mechanics.iter().map(|mechanic| mechanic.name.as_str())
    }

    /// Returns the couplings, which are the merged pairs of ports, such as `feed.food+lock.key`, sorted by name.
    pub fn couplings(&self) -> Vec<String> {
        let name = |((mechanic, port), _): &((usize, usize), _)| {
            let mechanic = self.mechanics[*mechanic];
            format!("{}.{}", mechanic.name, mechanic.ports[*port].name)
        };
        let types = self.types().unwrap_or_default();
        let pairs = types.iter().flat_map(|merged| {
            let names: Vec<String> = merged.ports.iter().map(name).sorted().collect();
            names.into_iter().tuple_combinations().map(|(one, other)| format!("{one}+{other}")).collect_vec()
        });
        pairs.sorted().collect()
    }

    /// Returns the kind of game, as determined by the ending.
    pub fn kind(&self) -> Kind {
        let ending = self.mechanics.last().and_then(|mechanic| mechanic.ending.as_ref());
        ending.map_or(Kind::CollectAndAvoid, |(_, kind)| *kind)
    }

    /// Returns the same rules with a different tick limit, or without one.
    #[must_use]
    pub fn timed(&self, time: Option<u32>) -> Invention {
        Invention { time, ..self.clone() }
    }

    /// Returns the same rules with different nouns, a different title and a different story.
    #[must_use]
    pub fn retold(&self, fiction: Seed) -> Invention {
        Invention { fiction, ..self.clone() }
    }

    /// Builds the game. Cost: about a millisecond.
    ///
    /// # Errors
    /// Returns an error if the rules do not compile, or if the compiler warns about them.
    pub fn build(&self) -> Result<Invented, GenerateError> {
        let unlucky = |why: String| GenerateError::Unlucky(why);
        let types = self.types().ok_or_else(|| unlucky(Unsound::Body.name().to_owned()))?;
        let mut written = emit::write(self, &types)?;
        let fiction = Fiction::draw(self, &types)?;
        let mut dressed = fiction.dress(written.description.clone());
        let names = || self.mechanics().join("+");
        let rules = (0..MOST_IDLE).find_map(|_| {
            let rules = Game::from_source(&syntax::print(&dressed));
            match rules.as_ref().map(|rules| rules.warnings().first().cloned()) {
                Ok(Some(warning)) if written.leave_out(&mut dressed, rules.as_ref().ok()?, &warning) => None,
                _ => Some(rules),
            }
        });
        let rules = rules.ok_or_else(|| unlucky(format!("{}: idle rules", names())))?;
        let rules = rules
            .map_err(|problems| unlucky(format!("{}: the rules do not compile: {problems}", names())))?;
        if let Some(warning) = rules.warnings().first() {
            return Err(unlucky(format!("{}: {}", names(), warning.message)));
        }
        let (mechanics, ending) = self.mechanics.split_at(self.mechanics.len() - 1);
        let names = mechanics.iter().map(|mechanic| format!("mechanic/{}", mechanic.name));
        let ending = ending.iter().map(|ending| format!("ending/{}", ending.name));
        let couplings = self.couplings().into_iter().map(|pair| format!("coupling/{pair}"));
        let own_lines = (0..mechanics.len()).map(|at| interactions(at, &written)).collect();
        let own_types = (0..mechanics.len()).map(|at| {
            let own = types
                .iter()
                .enumerate()
                .filter(|(_, merged)| merged.ports.iter().all(|((of, _), _)| *of == at));
            own.map(|(class, _)| fiction.name(&emit::name(class)).to_owned()).collect()
        });
        let own_types = own_types.collect();
        let idioms = types.iter().enumerate();
        let idioms = idioms
            .map(|(class, merged)| (fiction.name(&emit::name(class)).to_owned(), merged.idiom()))
            .collect();
        let game = GeneratedGame {
            real_time: has_movers(rules.description()),
            title: fiction.title.clone(),
            summary: fiction.summary.clone(),
            goal: fiction.goal.clone(),
            kind: self.kind(),
            patterns: names.chain(ending).chain(couplings).collect(),
            rules,
        };
        Ok(Invented { game, mechanics: own_lines, idioms, own_types })
    }

    /// Returns a digest of the rules, ignoring the texts and the tick limit. Two inventions with the same key differ at
    /// most in their texts and tick limits.
    pub fn key(&self) -> Digest {
        let names = self.mechanics().join(" ");
        Digest::of(format!("{names} {:?} {:?}", self.partition, self.values).as_bytes())
    }
}

/// Returns a mechanic's interactions, except those that only remove sprites created inside walls.
fn interactions(mechanic: usize, written: &emit::Written) -> Vec<usize> {
    let lines = written.description.interactions.iter().zip(&written.owners).enumerate();
    let own = lines.filter(|(_, (line, owner))| {
        let clears_walls = matches!(&line.second[..], [second] if second.text == "wall");
        **owner == Some(mechanic) && !(clears_walls && line.effect.text == "killSprite")
    });
    own.map(|(at, _)| at).collect()
}

/// Numbers a partition's classes in the order of their first ports (open roles of mechanics).
pub(super) fn normal(partition: &[u8]) -> Vec<u8> {
    let mut seen: Vec<u8> = Vec::new();
    let number = |class: &u8| {
        let at = seen.iter().position(|other| other == class).unwrap_or_else(|| {
            seen.push(*class);
            seen.len() - 1
        });
        u8::try_from(at).unwrap_or(u8::MAX)
    };
    partition.iter().map(number).collect()
}

/// Returns the partition in which each port (open role of a mechanic) has its own type.
pub(super) fn apart(mechanics: &[&'static Mechanic]) -> Vec<u8> {
    (0..=u8::MAX).take(ports(mechanics).len()).collect()
}
