//! Sets of rules that are assigned in advance to games made independently of each other: no two sets are near, and each
//! has its own names.

use super::cast::Cast;
use crate::levels::Method;
use base::{Sampler, Seed};
use engine::Game;
use generators::Variation;
use generators::games::{GeneratedGame, Kind};
use generators::kernels::{KernelGenome, KernelVariation, Turns};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;
use validators::novelty::GameForm;

/// The number of draws of numbers for each form of a kernel, with and without its variants, and the number of draws of
/// grafts for a kernel.
const DRAWS: (u64, u64) = (10, 96);

/// The number of draws of different numbers for a game of a set.
const REDRAWS: u64 = 4;

/// The maximum number of sets with grafts per kernel.
const GRAFTED: usize = 8;

/// The number of sets with grafts per kernel that find names in any mint of all kinds.
const USUAL_GRAFTED: usize = 4;

/// The number of places that have spare sets, which take turns with their own sets; small releases have as many places.
const SMALL: usize = 16;

/// The number of spare sets of each of these places. They are taken from the end, which few other places reach.
const SPARE: usize = 3;

/// The number of draws of nouns for a set in each scene.
const NAMINGS: u64 = 6;

/// The number of sets of an archive.
const OF_ARCHIVE: usize = 6;

/// A set of rules: a kernel in one of its forms, with variants, grafts and numbers, and with the nouns of a scene. The
/// levels are open, and so are the numbers as long as a game does not come near another set.
#[derive(Clone, Debug)]
pub(crate) struct RuleSet {
    genome: KernelGenome,
    form: GameForm,
}

/// Sets of rules in the order of their turns: each kernel has one before any kernel has a second.
///
/// A place always has the same set, regardless of the number of places. Only the first set of each kernel is drawn at
/// once. The others are drawn when they are needed, because most releases are small.
#[derive(Clone, Debug)]
pub struct RuleSets {
    draws: Draws,
    /// The kernels in the order of their turns, each with all of its sets, which have no names yet.
    kernels: Vec<(&'static str, OnceLock<Parts>)>,
    /// The first sets, without grafts.
    opening: Vec<RuleSet>,
    all: OnceLock<Parts>,
}

/// Sets without grafts, and sets with grafts.
type Parts = (Vec<RuleSet>, Vec<RuleSet>);

/// The inputs for drawing the sets of a kernel.
#[derive(Clone, Debug)]
struct Draws {
    seed: Seed,
    with_grafts: bool,
    known: Vec<GameForm>,
}

/// Returns the rules of a game and its title; `None` if the rules do not compile.
fn built(genome: &KernelGenome) -> Option<(Game, String)> {
    let GeneratedGame { rules, title, .. } = genome.build().ok()?.game;
    Some((rules, title))
}

/// Returns the form of a game's rules; `None` if they do not compile.
fn form_of(genome: &KernelGenome) -> Option<GameForm> {
    Some(GameForm::of(&built(genome)?.0))
}

/// The sets of one kernel so far.
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
    /// Returns the seed of a kernel, and a game of each of its forms in the order in which they become sets.
    fn of_kernel(&self, kernel: &str) -> (Seed, Vec<KernelGenome>) {
        let seed = self.seed.child("kernel", 0).child(kernel, 0);
        let mut all = KernelGenome::all_of(kernel);
        seed.child("order", 0).sampler().shuffle(&mut all);
        (seed, all)
    }

    /// Adds sets without grafts until there are `most`.
    fn fill(&self, sets: &mut OfKernel<'_>, of_kernel: &(Seed, Vec<KernelGenome>), most: usize) {
        (0..DRAWS.0).for_each(|draw| self.draw(sets, of_kernel, draw, most));
    }

    /// Adds the sets of one draw of numbers until there are `most`.
    fn draw(&self, sets: &mut OfKernel<'_>, (seed, all): &(Seed, Vec<KernelGenome>), draw: u64, most: usize) {
        let seed = seed.child("numbers", draw);
        for genome in all {
            if sets.sets.len() == most {
                return;
            }
            sets.admit(genome.redrawn(seed));
        }
    }

    /// Returns the first set of a kernel, without grafts; `None` if all of its games are near known ones.
    fn first(&self, kernel: &str) -> Option<RuleSet> {
        let mut first = OfKernel { known: &self.known, sets: Vec::new() };
        self.fill(&mut first, &self.of_kernel(kernel), 1);
        first.sets.pop()
    }

    /// Returns all sets of a kernel.
    fn all(&self, kernel: &str) -> Parts {
        let of_kernel = self.of_kernel(kernel);
        let mut sets = OfKernel { known: &self.known, sets: Vec::new() };
        self.fill(&mut sets, &of_kernel, usize::MAX);
        let (own, (seed, all)) = (sets.sets.len(), of_kernel);
        for draw in (0..DRAWS.1).filter(|_| self.with_grafts) {
            if sets.sets.len() >= own + GRAFTED {
                break;
            }
            let seed = seed.child("graft", draw);
            let host = all[seed.child("host", 0).sampler().below(all.len())].redrawn(seed);
            host.grafted(seed).into_iter().for_each(|genome| sets.admit(genome));
        }
        let grafted = sets.sets.split_off(own);
        (sets.sets, grafted)
    }

    /// Returns the same sets with names of their own: no two share a title or most of a cast, and scenes take turns.
    /// Sets for which there are no names left are dropped.
    fn named(&self, (plain, grafted): Parts) -> Parts {
        let mut given = Given::default();
        let mut named = |at: u64, sets: Vec<RuleSet>| -> Vec<RuleSet> {
            let seed = self.seed.child("names", 0).child("sets", at);
            let unnamed = (0..).zip(sets);
            unnamed.filter_map(|(number, set)| given.named(set, seed.child("set", number))).collect()
        };
        (named(0, plain), named(1, grafted))
    }
}

impl RuleSets {
    /// Draws the sets of the given kinds that are not near a `known` game; sets with grafts only if requested. Cost:
    /// about a millisecond per set that is considered and per naming that is tried: about 100 for the first sets of all
    /// kernels. The other sets take about 900 more without grafts, and up to 4,000 more with grafts, once a method or a
    /// place needs them.
    pub fn draw(kinds: &[Kind], with_grafts: bool, known: &[GameForm], seed: Seed) -> RuleSets {
        let draws = Draws { seed, with_grafts, known: known.to_vec() };
        let turns = Turns::draw(kinds, seed);
        let kernels: Vec<_> = turns.kernels().map(|(kernel, _)| (kernel, OnceLock::new())).collect();
        let first = kernels.iter().filter_map(|(kernel, _)| draws.first(kernel)).collect();
        let (opening, _) = draws.named((first, Vec::new()));
        RuleSets { draws, kernels, opening, all: OnceLock::new() }
    }

    /// Returns all sets, which begin with the opening.
    fn all(&self) -> &Parts {
        self.all.get_or_init(|| {
            let (plain, grafted) =
                self.kernels.iter().map(|of_kernel| self.of_kernel(of_kernel).clone()).unzip();
            self.draws.named((in_turn(plain), in_turn(grafted)))
        })
    }

    /// Returns all sets of one of the kernels.
    fn of_kernel<'a>(&self, (kernel, sets): &'a (&'static str, OnceLock<Parts>)) -> &'a Parts {
        sets.get_or_init(|| self.draws.all(kernel))
    }

    /// Returns the sets that a method draws on. Searches and archives take a quarter each of the sets with grafts;
    /// constructive games take the others, after all sets without grafts.
    fn of_method(&self, method: Method) -> Vec<&RuleSet> {
        let (plain, grafted) = self.all();
        let quarter = |first: usize| grafted.iter().skip(first).step_by(4);
        match method {
            Method::Search if !grafted.is_empty() => quarter(0).collect(),
            Method::Evolutionary if !grafted.is_empty() => quarter(1).collect(),
            _ => plain.iter().chain(quarter(2)).chain(quarter(3)).collect(),
        }
    }

    /// Returns the set for a place among the games of a method, in the given turn; `None` if there is no set left.
    pub(crate) fn of_place(&self, method: Method, place: u32, turn: u32) -> Option<&RuleSet> {
        let (place, turn) = (place as usize, turn as usize);
        if let (Method::Constructive, 0, Some(set)) = (method, turn, self.opening.get(place)) {
            return Some(set);
        }
        let sets = self.of_method(method);
        let at = match turn % (1 + SPARE) {
            0 if turn == 0 || place < SMALL => place,
            spare if place < SMALL => sets.len().checked_sub(1 + place + SMALL * (spare - 1))?,
            _ => return None,
        };
        sets.get(at).copied()
    }

    /// Returns the sets of an archive.
    pub(crate) fn of_archive(&self, number: u32) -> Vec<&RuleSet> {
        let sets = self.of_method(Method::Evolutionary);
        let first = number as usize * OF_ARCHIVE;
        (first..first + OF_ARCHIVE.min(sets.len())).map(|at| sets[at % sets.len()]).collect()
    }

    /// Draws a game of a set, with different numbers unless they bring it near another set.
    pub(crate) fn draw_of(&self, set: &RuleSet, seed: Seed) -> KernelGenome {
        let mut drawn = (0..REDRAWS).map(|draw| set.genome.redrawn(seed.child("numbers", draw)));
        drawn.find(|genome| self.is_of(genome, set)).unwrap_or_else(|| set.genome.clone())
    }

    /// Returns `true` if a game has the kernel of a set and is near none of that kernel's other sets.
    fn is_of(&self, genome: &KernelGenome, own: &RuleSet) -> bool {
        let kernel = self.kernels.iter().find(|(kernel, _)| *kernel == genome.kernel());
        let parts = kernel.into_iter().map(|of_kernel| self.of_kernel(of_kernel));
        let mut rivals = parts
            .flat_map(|(plain, grafted)| plain.iter().chain(grafted))
            .filter(|other| other.form != own.form);
        genome.kernel() == own.genome.kernel()
            && form_of(genome).is_some_and(|form| rivals.all(|other| !form.is_near(&other.form)))
    }
}

/// The number of sets that a mint can count on, whatever its seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Supply {
    plain: usize,
    grafted: usize,
}

impl Supply {
    /// Counts the sets of the given kinds. Sets without grafts are those of one draw of numbers that are near neither a
    /// `known` game nor a game of an `earlier` release. Sets with grafts, if requested, are [`USUAL_GRAFTED`] per
    /// kernel, less the other games of earlier releases. Cost: about a millisecond per form of a kernel.
    pub fn of(kinds: &[Kind], with_grafts: bool, known: &[GameForm], earlier: &[GameForm]) -> Supply {
        let draws = Draws { seed: Seed::from_text("supply"), with_grafts, known: known.to_vec() };
        let turns = Turns::draw(kinds, draws.seed);
        let mut all = Vec::new();
        for (kernel, _) in turns.kernels() {
            let mut sets = OfKernel { known: &draws.known, sets: Vec::new() };
            draws.draw(&mut sets, &draws.of_kernel(kernel), 0, usize::MAX);
            all.extend(sets.sets);
        }
        let is_near = |set: &RuleSet, game: &GameForm| set.form.is_near(game);
        let plain = all.iter().filter(|set| !earlier.iter().any(|game| is_near(set, game))).count();
        let others = earlier.iter().filter(|game| !all.iter().any(|set| is_near(set, game))).count();
        let grafted = if with_grafts { USUAL_GRAFTED * turns.kernels().count() } else { 0 };
        Supply { plain, grafted: grafted.saturating_sub(others) }
    }

    /// Returns the number of sets that a method draws on ([`RuleSets::of_method`]).
    pub fn count(&self, method: Method) -> usize {
        match method {
            Method::Search | Method::Evolutionary if self.grafted > 0 => self.grafted / 4,
            _ => self.plain + self.grafted / 2,
        }
    }
}

/// The names that have been given to sets.
#[derive(Default)]
struct Given {
    titles: BTreeSet<String>,
    casts: Vec<Cast>,
    scenes: BTreeMap<&'static str, usize>,
    /// The pairs of kernels and scenes that have been used.
    of_kernels: BTreeSet<(String, &'static str)>,
}

impl Given {
    /// Gives a set names of its own; returns `None` if there are no names left.
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

    /// Returns a game with its title and its cast, if no other set has the title or shares the cast.
    fn free(&self, genome: KernelGenome) -> Option<(KernelGenome, String, Cast)> {
        let (game, title) = built(&genome)?;
        let cast = Cast::of(&game);
        let is_taken = self.titles.contains(&title) || self.casts.iter().any(|other| cast.is_shared(other));
        (!is_taken).then_some((genome, title, cast))
    }
}

/// Orders the sets of kernels in rounds: each kernel has one set in every round, as long as it has more.
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

/// All sets, and the sets to which a search is limited.
pub(crate) type Own<'a> = (&'a RuleSets, Vec<&'a RuleSet>);

/// The number of attempts at a change before a parent is returned unchanged.
pub(crate) const CHANGES: usize = 8;

/// A variation of games that is limited to some sets of rules, if any are given.
pub(crate) struct SetVariation<'a> {
    pub(crate) variation: KernelVariation,
    pub(crate) own: Option<Own<'a>>,
}

impl<'a> SetVariation<'a> {
    /// Returns a variation of games of the same kind as `genome`.
    pub(crate) fn of_kind_of(genome: &KernelGenome, own: Option<Own<'a>>) -> SetVariation<'a> {
        SetVariation { variation: KernelVariation::new(&[genome.kind()]), own }
    }

    /// Returns the game with the names of its set; `None` if it belongs to no set.
    fn kept(&self, genome: KernelGenome) -> Option<KernelGenome> {
        let Some((all, own)) = &self.own else { return Some(genome) };
        let set = own.iter().find(|set| all.is_of(&genome, set))?;
        genome.named_like(&set.genome)
    }
}

impl Variation for SetVariation<'_> {
    type Candidate = KernelGenome;

    fn create(&self, seed: Seed) -> Option<KernelGenome> {
        let Some((all, own)) = &self.own else { return self.variation.create(seed) };
        let set = own.get(seed.child("set", 0).sampler().below(own.len().max(1)))?;
        Some(all.draw_of(set, seed))
    }

    fn mutate(&self, parent: &KernelGenome, sampler: &mut Sampler) -> KernelGenome {
        let changed = (0..CHANGES).map(|_| self.variation.mutate(parent, sampler));
        let mut kept = changed.filter_map(|genome| self.kept(genome));
        kept.find(|genome| genome.key() != parent.key()).unwrap_or_else(|| parent.clone())
    }

    fn cross(&self, one: &KernelGenome, two: &KernelGenome, sampler: &mut Sampler) -> KernelGenome {
        let child = self.variation.cross(one, two, sampler);
        self.kept(child).unwrap_or_else(|| one.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::LazyLock;

    static SETS: LazyLock<RuleSets> =
        LazyLock::new(|| RuleSets::draw(&[Kind::Lure, Kind::Demolition], true, &[], Seed::from_text("sets")));

    #[test]
    fn no_two_sets_are_near_and_kernels_take_turns() {
        let (plain, grafted) = SETS.all();
        let all: Vec<&RuleSet> = plain.iter().chain(grafted).collect();
        for (at, one) in all.iter().enumerate() {
            for other in &all[at + 1..] {
                let kernels = (one.genome.kernel(), other.genome.kernel());
                assert!(!one.form.is_near(&other.form), "{kernels:?}");
            }
        }
        let kernels: BTreeSet<&str> = all.iter().map(|set| set.genome.kernel()).collect();
        let first: BTreeSet<&str> = plain.iter().take(kernels.len()).map(|set| set.genome.kernel()).collect();
        assert_eq!(first, kernels);
        assert!(grafted.len() > kernels.len());
    }

    #[test]
    fn all_sets_begin_with_the_opening() {
        let key = |set: &RuleSet| (set.genome.key(), set.genome.scene());
        let opening: Vec<_> = SETS.opening.iter().map(key).collect();
        assert!(opening.len() > 2);
        assert_eq!(SETS.all().0[..opening.len()].iter().map(key).collect::<Vec<_>>(), opening);
    }

    #[test]
    fn games_of_a_set_stay_with_it() {
        let sets = &*SETS;
        let (plain, grafted) = sets.all();
        for set in plain.iter().chain(grafted) {
            for draw in 0..2 {
                let genome = sets.draw_of(set, Seed::from_text("draw").child("draw", draw));
                assert!(sets.is_of(&genome, set), "{}", set.genome.kernel());
                assert_eq!(genome.scene(), set.genome.scene());
            }
        }
        let own = sets.of_archive(0);
        let variation = KernelVariation::new(&[Kind::Lure, Kind::Demolition]);
        let variation = SetVariation { variation, own: Some((sets, own.clone())) };
        let mut sampler = Seed::from_text("changes").sampler();
        let mut genome = variation.create(Seed::from_text("first")).unwrap();
        for _ in 0..20 {
            genome = variation.mutate(&genome, &mut sampler);
            assert!(own.iter().any(|set| set.genome.kernel() == genome.kernel()));
        }
    }

    #[test]
    fn places_have_sets_of_their_own() {
        let sets = RuleSets::draw(Kind::ALL, false, &[], Seed::from_text("sets"));
        let all = sets.of_method(Method::Constructive);
        let at = |place: usize, turn| {
            let set = sets.of_place(Method::Constructive, place as u32, turn)?;
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
        let none = RuleSets::draw(&[], true, &[], Seed::from_text("none"));
        assert!(
            none.of_place(Method::Search, 0, 0).is_none() && none.of_place(Method::Search, 0, 1).is_none()
        );
    }

    /// A commitment cannot be changed, so no seed may yield fewer sets than a recipe can count on.
    #[test]
    fn every_seed_has_the_sets_that_a_recipe_counts_on() {
        let kinds = [Kind::Lure, Kind::Demolition];
        for with_grafts in [false, true] {
            let supply = Supply::of(&kinds, with_grafts, &[], &[]);
            for seed in ["one", "two"] {
                let sets = RuleSets::draw(&kinds, with_grafts, &[], Seed::from_text(seed));
                for method in [Method::Constructive, Method::Search, Method::Evolutionary] {
                    let (there, counted) = (sets.of_method(method).len(), supply.count(method));
                    assert!((1..=there).contains(&counted), "{seed} {method:?}: {counted} of {there}");
                }
            }
        }
        // Sets that earlier releases have used do not occur again.
        let form = |set: &RuleSet| set.form.clone();
        let used: Vec<GameForm> = SETS.all().0.iter().take(2).map(form).collect();
        let (fresh, left) = (Supply::of(&kinds, true, &[], &[]), Supply::of(&kinds, true, &[], &used));
        assert!(left.plain < fresh.plain, "{left:?} {fresh:?}");
    }

    #[test]
    fn known_games_are_kept_apart_from() {
        let seed = Seed::from_text("sets");
        let all = RuleSets::draw(&[Kind::Lure], false, &[], seed);
        let known: Vec<GameForm> = all.all().0.iter().take(2).map(|set| set.form.clone()).collect();
        let left = RuleSets::draw(&[Kind::Lure], false, &known, seed);
        let (left, all) = (&left.all().0, &all.all().0);
        assert!(!left.is_empty() && left.len() < all.len());
        assert!(left.iter().all(|set| known.iter().all(|known| !set.form.is_near(known))));
    }
}
