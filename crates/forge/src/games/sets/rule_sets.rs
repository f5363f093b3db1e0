//! Sets of rules, assigned in advance to independently generated games. No two sets are similar, and each set has its
//! own names.

use super::cast::Cast;
use base::Seed;
use engine::Game;
use generators::games::{GeneratedGame, Kind};
use generators::kernels::{KernelGenome, Turns};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;
use validators::novelty::GameForm;

/// The number of parameter draws for each form (variation) of a kernel (hand-written design), with and without its
/// variants.
const DRAWS: u64 = 10;

/// The number of attempts to draw new parameters for a game from a set.
const REDRAWS: u64 = 4;

/// The number of positions that have spare sets. Small releases contain at most this number of games.
const SMALL: usize = 16;

/// The number of spare sets for each of the first [`SMALL`] positions. Spare sets are taken from the end of the list,
/// which few other positions reach.
const SPARE: usize = 3;

/// The number of times that nouns are drawn for a rule set in each scene (theme).
const NAMINGS: u64 = 6;

/// A set of rules: a kernel (hand-written design) in one of its forms, with variants and parameters, named with the
/// nouns of a scene (theme). A set does not fix the levels. Its parameters may still change, as long as the game does
/// not become similar to another set.
#[derive(Clone, Debug)]
pub(crate) struct RuleSet {
    genome: KernelGenome,
    form: GameForm,
}

/// Sets of rules. Kernels (hand-written designs) take turns, so each kernel has one set before any kernel has a second.
///
/// A position always has the same set, regardless of the number of positions. Only the first set of each kernel is
/// drawn immediately. Further sets are drawn on demand, because most releases are small.
#[derive(Clone, Debug)]
pub struct RuleSets {
    draws: Draws,
    /// The kernels (hand-written designs), in the order in which they take turns, each with its rule sets before names
    /// are assigned.
    kernels: Vec<(&'static str, OnceLock<Vec<RuleSet>>)>,
    /// The first rule set of each kernel (hand-written design).
    opening: Vec<RuleSet>,
    all: OnceLock<Vec<RuleSet>>,
}

/// The inputs for drawing the rule sets of a kernel (hand-written design).
#[derive(Clone, Debug)]
struct Draws {
    seed: Seed,
    known: Vec<GameForm>,
}

/// Returns a game's rules and title; `None` if the rules do not compile.
fn built(genome: &KernelGenome) -> Option<(Game, String)> {
    let GeneratedGame { rules, title, .. } = genome.build().ok()?.game;
    Some((rules, title))
}

/// Returns the form of a game's rules, by which games are compared; `None` if the rules do not compile.
fn form_of(genome: &KernelGenome) -> Option<GameForm> {
    Some(GameForm::of(&built(genome)?.0))
}

/// The rule sets of one kernel (hand-written design) found so far.
struct OfKernel<'a> {
    known: &'a [GameForm],
    sets: Vec<RuleSet>,
}

impl OfKernel<'_> {
    /// Adds a set, unless it is near an existing set or a known game.
    fn admit(&mut self, genome: KernelGenome) {
        let Some(form) = form_of(&genome) else { return };
        let is_near = |other: &GameForm| form.is_near(other);
        if !self.sets.iter().any(|other| is_near(&other.form)) && !self.known.iter().any(is_near) {
            self.sets.push(RuleSet { genome, form });
        }
    }
}

impl Draws {
    /// Returns a kernel's seed, and one game for each of its forms (variations), in the order in which the forms are
    /// turned into rule sets.
    fn of_kernel(&self, kernel: &str) -> (Seed, Vec<KernelGenome>) {
        let seed = self.seed.child("kernel", 0).child(kernel, 0);
        let mut all = KernelGenome::all_of(kernel);
        seed.child("order", 0).sampler().shuffle(&mut all);
        (seed, all)
    }

    /// Adds sets until there are `most` sets or no draws are left.
    fn fill(&self, sets: &mut OfKernel<'_>, of_kernel: &(Seed, Vec<KernelGenome>), most: usize) {
        (0..DRAWS).for_each(|draw| self.draw(sets, of_kernel, draw, most));
    }

    /// Adds the sets from one parameter draw until there are `most` sets.
    fn draw(&self, sets: &mut OfKernel<'_>, (seed, all): &(Seed, Vec<KernelGenome>), draw: u64, most: usize) {
        let seed = seed.child("numbers", draw);
        for genome in all {
            if sets.sets.len() == most {
                return;
            }
            sets.admit(genome.redrawn(seed));
        }
    }

    /// Returns the first rule set of a kernel (hand-written design); `None` if all of the kernel's sets are near known
    /// games.
    fn first(&self, kernel: &str) -> Option<RuleSet> {
        let mut first = OfKernel { known: &self.known, sets: Vec::new() };
        self.fill(&mut first, &self.of_kernel(kernel), 1);
        first.sets.pop()
    }

    /// Returns all rule sets of a kernel (hand-written design).
    fn all(&self, kernel: &str) -> Vec<RuleSet> {
        let mut sets = OfKernel { known: &self.known, sets: Vec::new() };
        self.fill(&mut sets, &self.of_kernel(kernel), usize::MAX);
        sets.sets
    }

    /// Returns the sets with their own names. No two sets share a title or most of their type names, and the scenes
    /// (themes) take turns. Sets for which no names are left are dropped.
    fn named(&self, sets: Vec<RuleSet>) -> Vec<RuleSet> {
        let seed = self.seed.child("names", 0).child("sets", 0);
        let mut given = Given::default();
        let unnamed = (0..).zip(sets);
        unnamed.filter_map(|(number, set)| given.named(set, seed.child("set", number))).collect()
    }
}

impl RuleSets {
    /// Draws the rule sets of the given kinds, except those near a `known` game. Costs about a millisecond per set
    /// considered and per naming tried. There are about 100 such steps for the first sets of all kernels, and about 900
    /// for the other sets, which are drawn on demand.
    pub fn draw(kinds: &[Kind], known: &[GameForm], seed: Seed) -> RuleSets {
        let draws = Draws { seed, known: known.to_vec() };
        let turns = Turns::draw(kinds, seed);
        let kernels: Vec<_> = turns.kernels().map(|(kernel, _)| (kernel, OnceLock::new())).collect();
        let first = kernels.iter().filter_map(|(kernel, _)| draws.first(kernel)).collect();
        let opening = draws.named(first);
        RuleSets { draws, kernels, opening, all: OnceLock::new() }
    }

    /// Returns the number of rule sets of the given kinds that minting can rely on, whatever the seed. Counts the sets
    /// from one parameter draw that are not near a `known` game or a game from an `earlier` release. Costs about a
    /// millisecond per kernel form.
    pub fn supply(kinds: &[Kind], known: &[GameForm], earlier: &[GameForm]) -> usize {
        let draws = Draws { seed: Seed::from_text("supply"), known: known.to_vec() };
        let of_kernel = |(kernel, _)| {
            let mut sets = OfKernel { known: &draws.known, sets: Vec::new() };
            draws.draw(&mut sets, &draws.of_kernel(kernel), 0, usize::MAX);
            sets.sets
        };
        let turns = Turns::draw(kinds, draws.seed);
        let all = turns.kernels().flat_map(of_kernel);
        all.filter(|set| !earlier.iter().any(|game| set.form.is_near(game))).count()
    }

    /// Returns all rule sets, starting with the first set of each kernel (hand-written design).
    fn all(&self) -> &[RuleSet] {
        self.all.get_or_init(|| {
            let of_kernels = self.kernels.iter().map(|of_kernel| self.of_kernel(of_kernel).to_vec());
            self.draws.named(in_turn(of_kernels.collect()))
        })
    }

    /// Returns all rule sets of one kernel (hand-written design).
    fn of_kernel<'a>(&self, (kernel, sets): &'a (&'static str, OnceLock<Vec<RuleSet>>)) -> &'a [RuleSet] {
        sets.get_or_init(|| self.draws.all(kernel))
    }

    /// Returns the set to use at a position in a given turn; `None` if no set is left.
    pub(crate) fn of_place(&self, place: u32, turn: u32) -> Option<&RuleSet> {
        let (place, turn) = (place as usize, turn as usize);
        if let (0, Some(set)) = (turn, self.opening.get(place)) {
            return Some(set);
        }
        let sets = self.all();
        let at = match turn % (1 + SPARE) {
            0 if turn == 0 || place < SMALL => place,
            spare if place < SMALL => sets.len().checked_sub(1 + place + SMALL * (spare - 1))?,
            _ => return None,
        };
        sets.get(at)
    }

    /// Draws a game from a set. The game's parameters differ from the set's, unless every draw of new parameters brings
    /// the game near another set.
    pub(crate) fn draw_of(&self, set: &RuleSet, seed: Seed) -> KernelGenome {
        let mut drawn = (0..REDRAWS).map(|draw| set.genome.redrawn(seed.child("numbers", draw)));
        drawn.find(|genome| self.is_of(genome, set)).unwrap_or_else(|| set.genome.clone())
    }

    /// Returns `true` if a game has the kernel of a rule set and is not near any other set of that kernel.
    fn is_of(&self, genome: &KernelGenome, own: &RuleSet) -> bool {
        let kernel = self.kernels.iter().find(|(kernel, _)| *kernel == genome.kernel());
        let sets = kernel.into_iter().flat_map(|of_kernel| self.of_kernel(of_kernel));
        let mut rivals = sets.filter(|other| other.form != own.form);
        genome.kernel() == own.genome.kernel()
            && form_of(genome).is_some_and(|form| rivals.all(|other| !form.is_near(&other.form)))
    }
}

/// The names already assigned to sets.
#[derive(Default)]
struct Given {
    titles: BTreeSet<String>,
    casts: Vec<Cast>,
    scenes: BTreeMap<&'static str, usize>,
    /// The pairs of kernel (hand-written design) and scene (theme) that are already in use.
    of_kernels: BTreeSet<(String, &'static str)>,
}

impl Given {
    /// Assigns unique names to a set. Returns `None` if there are no names left.
    fn named(&mut self, set: RuleSet, seed: Seed) -> Option<RuleSet> {
        let mut scenes = set.genome.scenes();
        seed.child("scenes", 0).sampler().shuffle(&mut scenes);
        let kernel = set.genome.kernel().to_owned();
        let uses = |scene: &&'static str| {
            let is_again = self.of_kernels.contains(&(kernel.clone(), *scene));
            (is_again, self.scenes.get(scene).copied().unwrap_or_default())
        };
        scenes.sort_by_key(uses);
        let all = (0..NAMINGS).flat_map(|draw| scenes.iter().map(move |&scene| (draw, scene)));
        let mut named = all.filter_map(|(draw, scene)| set.genome.named(scene, seed.child(scene, draw)));
        let (genome, title, cast) = named.find_map(|genome| self.free(genome))?;
        *self.scenes.entry(genome.scene()).or_default() += 1;
        self.of_kernels.insert((kernel, genome.scene()));
        self.titles.insert(title);
        self.casts.push(cast);
        Some(RuleSet { genome, ..set })
    }

    /// Returns a game with its title and the names of its types, if no other set has the title or shares most of the
    /// names.
    fn free(&self, genome: KernelGenome) -> Option<(KernelGenome, String, Cast)> {
        let (game, title) = built(&genome)?;
        let cast = Cast::of(&game);
        let is_taken = self.titles.contains(&title) || self.casts.iter().any(|other| cast.is_shared(other));
        (!is_taken).then_some((genome, title, cast))
    }
}

/// Orders the kernels' rule sets in rounds. Each kernel contributes one set per round, as long as it has sets left.
fn in_turn(of_kernels: Vec<Vec<RuleSet>>) -> Vec<RuleSet> {
    let mut left: Vec<_> = of_kernels.into_iter().map(Vec::into_iter).collect();
    let mut all = Vec::new();
    loop {
        let round: Vec<RuleSet> = left.iter_mut().filter_map(Iterator::next).collect();
        if round.is_empty() {
            return all;
        }
        all.extend(round);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::LazyLock;

    static SETS: LazyLock<RuleSets> =
        LazyLock::new(|| RuleSets::draw(&[Kind::Lure, Kind::Demolition], &[], Seed::from_text("sets")));

    #[test]
    fn no_two_sets_are_near_and_kernels_take_turns() {
        let all = SETS.all();
        for (at, one) in all.iter().enumerate() {
            for other in &all[at + 1..] {
                let kernels = (one.genome.kernel(), other.genome.kernel());
                assert!(!one.form.is_near(&other.form), "{kernels:?}");
            }
        }
        let kernels: BTreeSet<&str> = all.iter().map(|set| set.genome.kernel()).collect();
        let first: BTreeSet<&str> = all.iter().take(kernels.len()).map(|set| set.genome.kernel()).collect();
        assert_eq!(first, kernels);
        assert!(all.len() > kernels.len());
    }

    #[test]
    fn all_sets_begin_with_the_opening() {
        let told = |set: &RuleSet| (built(&set.genome).unwrap().1, set.form.clone());
        let opening: Vec<_> = SETS.opening.iter().map(told).collect();
        assert!(opening.len() > 2);
        assert!(SETS.all()[..opening.len()].iter().map(told).eq(opening));
    }

    #[test]
    fn games_of_a_set_stay_with_it() {
        let sets = &*SETS;
        for set in sets.all() {
            for draw in 0..2 {
                let genome = sets.draw_of(set, Seed::from_text("draw").child("draw", draw));
                assert!(sets.is_of(&genome, set), "{}", set.genome.kernel());
                assert_eq!(genome.scene(), set.genome.scene());
            }
        }
    }

    #[test]
    fn places_have_sets_of_their_own() {
        let sets = RuleSets::draw(Kind::ALL, &[], Seed::from_text("sets"));
        let all = sets.all();
        let at = |place: usize, turn| {
            let set = sets.of_place(place as u32, turn)?;
            all.iter().position(|other| other.form == set.form)
        };
        assert!(all.len() > (1 + SPARE) * SMALL);
        let spare = |place, number| all.len() - SMALL * number + (SMALL - 1 - place);
        for place in 0..all.len() {
            let turns: Vec<_> = (0..=4).map(|turn| at(place, turn)).collect();
            let spare = |number| (place < SMALL).then(|| spare(place, number));
            let again = (place < SMALL).then_some(place);
            assert_eq!(turns, [Some(place), spare(1), spare(2), spare(3), again]);
        }
        assert_eq!(at(all.len(), 0), None);
        let none = RuleSets::draw(&[], &[], Seed::from_text("none"));
        assert!(none.of_place(0, 0).is_none() && none.of_place(0, 1).is_none());
    }

    /// A commitment cannot be changed later, so no seed may yield fewer sets than recipes can rely on.
    #[test]
    fn every_seed_has_the_sets_that_a_recipe_counts_on() {
        let kinds = [Kind::Lure, Kind::Demolition];
        let supply = RuleSets::supply(&kinds, &[], &[]);
        for seed in ["one", "two"] {
            let there = RuleSets::draw(&kinds, &[], Seed::from_text(seed)).all().len();
            assert!((1..=there).contains(&supply), "{seed}: {supply} of {there}");
        }
        // Sets used by earlier releases are no longer available.
        let used: Vec<GameForm> = SETS.all().iter().take(2).map(|set| set.form.clone()).collect();
        let left = RuleSets::supply(&kinds, &[], &used);
        assert!(left < supply, "{left} {supply}");
    }

    #[test]
    fn known_games_are_kept_apart_from() {
        let seed = Seed::from_text("sets");
        let all = RuleSets::draw(&[Kind::Lure], &[], seed);
        let known: Vec<GameForm> = all.all().iter().take(2).map(|set| set.form.clone()).collect();
        let left = RuleSets::draw(&[Kind::Lure], &known, seed);
        let (left, all) = (left.all(), all.all());
        assert!(!left.is_empty() && left.len() < all.len());
        assert!(left.iter().all(|set| known.iter().all(|known| !set.form.is_near(known))));
    }
}
