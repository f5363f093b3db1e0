//! Sets of rules, shared out beforehand among games that are made independently of each other: no two of them are near.

use crate::levels::Method;
use engine::{Game, Sampler, Seed, syntax};
use generators::Variation;
use generators::games::Kind;
use generators::kernels::{KernelGenome, KernelVariation, Turns};
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use validators::novelty::GameForm;

/// Draws of numbers for each form of a kernel, with and without its variants, and draws of grafts for a kernel.
const DRAWS: (u64, u64) = (6, 96);

/// Draws of other numbers for a game of a set.
const REDRAWS: u64 = 4;

/// The sets between those of neighbouring places that pass on to others: no divisor of the usual numbers of sets.
const STRIDE: usize = 17;

/// The neighbouring sets that have different scenes, as far as their kernels allow.
const BLOCK: usize = 40;

/// The sets of an archive.
const OF_ARCHIVE: usize = 6;

/// A set of rules: a kernel in one of its forms, with variants, grafts and numbers, in a scene. Nouns and levels are open, and so are
/// the numbers as far as a game does not come near to another set.
#[derive(Clone, Debug)]
pub(super) struct RuleSet {
    genome: KernelGenome,
    form: GameForm,
}

/// Sets of rules in the order of their turns: each kernel has one before any has a second.
///
/// The same place has the same set, however many places there are.
#[derive(Clone, Debug)]
pub struct RuleSets {
    /// Without grafts.
    plain: Vec<RuleSet>,
    /// With grafts.
    grafted: Vec<RuleSet>,
}

/// The form of the rules of a game; `None` if they do not compile.
fn form_of(genome: &KernelGenome) -> Option<GameForm> {
    let built = genome.build().ok()?;
    Some(GameForm::of(&Game::from_source(&syntax::print(&built.game.description)).ok()?))
}

/// The sets of one kernel, so far.
struct OfKernel<'a> {
    known: &'a [GameForm],
    sets: Vec<RuleSet>,
}

impl OfKernel<'_> {
    /// Takes a set in, unless it is near to one that is there or to a known game.
    fn welcome(&mut self, genome: KernelGenome) {
        let Some(form) = form_of(&genome) else { return };
        let is_near = |other: &GameForm| form.is_near(other);
        if !self.sets.iter().any(|other| is_near(&other.form)) && !self.known.iter().any(is_near) {
            self.sets.push(RuleSet { genome, form });
        }
    }
}

impl RuleSets {
    /// Draws the sets of these kinds that are not near to a `known` game; those with grafts if they are asked for. Cost: about a
    /// millisecond for each that is considered, some 500 without grafts and 4,000 more with.
    pub fn draw(kinds: &[Kind], with_grafts: bool, known: &[GameForm], seed: Seed) -> RuleSets {
        let (mut plain, mut grafted) = (Vec::new(), Vec::new());
        for (kernel, _) in Turns::draw(kinds, seed).kernels() {
            let seed = seed.child("kernel", 0).child(kernel, 0);
            let mut of_kernel = OfKernel { known, sets: Vec::new() };
            let mut all = KernelGenome::all_of(kernel);
            seed.child("order", 0).sampler().shuffle(&mut all);
            for draw in 0..DRAWS.0 {
                let seed = seed.child("numbers", draw);
                all.iter().for_each(|genome| of_kernel.welcome(genome.redrawn(seed)));
            }
            let own = of_kernel.sets.len();
            for draw in (0..DRAWS.1).filter(|_| with_grafts) {
                let seed = seed.child("graft", draw);
                let host = all[seed.child("host", 0).sampler().below(all.len())].redrawn(seed);
                host.grafted(seed).into_iter().for_each(|genome| of_kernel.welcome(genome));
            }
            grafted.push(of_kernel.sets.split_off(own));
            plain.push(of_kernel.sets);
        }
        let sets = RuleSets { plain: in_turn(plain), grafted: in_turn(grafted) };
        sets.staged(seed.child("scenes", 0))
    }

    /// The same sets in scenes that differ: no two of a kernel, and none of neighbours, as far as there are enough.
    fn staged(mut self, seed: Seed) -> RuleSets {
        let mut before: VecDeque<String> = VecDeque::new();
        let mut of_kernels: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for (number, set) in (0..).zip(self.plain.iter_mut().chain(&mut self.grafted)) {
            let of_kernel = of_kernels.entry(set.genome.kernel().to_owned()).or_default();
            let taken = before.iter().cloned().collect();
            let seed = seed.child("scene", number);
            let fresh = set.genome.in_free_scene(&of_kernel.union(&taken).cloned().collect(), seed);
            let staged = fresh.or_else(|| set.genome.in_free_scene(of_kernel, seed));
            set.genome = staged.unwrap_or_else(|| set.genome.clone());
            of_kernel.insert(set.genome.scene().to_owned());
            before.push_back(set.genome.scene().to_owned());
            if before.len() > BLOCK {
                before.pop_front();
            }
        }
        self
    }

    /// The sets that a method draws on: of those with grafts, searches and archives take a third each, and constructive games the others
    /// after all without.
    fn of_method(&self, method: Method) -> Vec<&RuleSet> {
        let third = |first: usize| self.grafted.iter().skip(first).step_by(3);
        match method {
            Method::Search if !self.grafted.is_empty() => third(0).collect(),
            Method::Evolutionary if !self.grafted.is_empty() => third(1).collect(),
            _ => self.plain.iter().chain(third(2)).collect(),
        }
    }

    /// The set of a place among the games of a method, or the next one after some passes; `None` if there is none.
    pub(super) fn of_place(&self, method: Method, place: u32, passes: u32) -> Option<&RuleSet> {
        let sets = self.of_method(method);
        if sets.is_empty() {
            return None;
        }
        let (place, passes, half) = (place as usize, passes as usize, sets.len() / 2);
        // Sets that have their turn late, and that smaller numbers of games have no place for, come first.
        let late = sets.len() - half;
        let at = match passes {
            0 => place % sets.len(),
            passed if passed <= late => half + (place + STRIDE * (passed - 1)) % late,
            passed => (place + passed) % sets.len(),
        };
        Some(sets[at])
    }

    /// The sets of an archive.
    pub(super) fn of_archive(&self, number: u32) -> Vec<&RuleSet> {
        let sets = self.of_method(Method::Evolutionary);
        let first = number as usize * OF_ARCHIVE;
        (first..first + OF_ARCHIVE.min(sets.len())).map(|at| sets[at % sets.len()]).collect()
    }

    /// A game of a set, with other numbers if they do not bring it near to another set.
    pub(super) fn draw_of(&self, set: &RuleSet, seed: Seed) -> KernelGenome {
        let mut drawn = (0..REDRAWS).map(|draw| set.genome.redrawn(seed.child("numbers", draw)));
        drawn.find(|genome| self.is_of(genome, set)).unwrap_or_else(|| set.genome.clone())
    }

    /// Tests whether a game is of the kernel of a set, and near to no other set of it.
    fn is_of(&self, genome: &KernelGenome, own: &RuleSet) -> bool {
        let others = self.plain.iter().chain(&self.grafted);
        let mut rivals =
            others.filter(|other| other.genome.kernel() == genome.kernel() && other.form != own.form);
        genome.kernel() == own.genome.kernel()
            && form_of(genome).is_some_and(|form| rivals.all(|other| !form.is_near(&other.form)))
    }
}

/// The sets of kernels, in rounds: each kernel has one in every round, as long as it has more.
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

/// All sets, and those that a search keeps to.
pub(super) type Own<'a> = (&'a RuleSets, Vec<&'a RuleSet>);

/// The draws of a change before a parent is returned unchanged.
const CHANGES: usize = 8;

/// Variation of games that keeps to some sets of rules, if there are any to keep to.
pub(super) struct SetVariation<'a> {
    pub(super) variation: KernelVariation,
    pub(super) own: Option<Own<'a>>,
}

impl SetVariation<'_> {
    fn is_own(&self, genome: &KernelGenome) -> bool {
        let Some((all, own)) = &self.own else { return true };
        own.iter().any(|set| all.is_of(genome, set))
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
        let mut changed = (0..CHANGES).map(|_| self.variation.mutate(parent, sampler));
        changed.find(|genome| self.is_own(genome)).unwrap_or_else(|| parent.clone())
    }

    fn cross(&self, one: &KernelGenome, two: &KernelGenome, sampler: &mut Sampler) -> KernelGenome {
        let child = self.variation.cross(one, two, sampler);
        if self.is_own(&child) { child } else { one.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sets() -> RuleSets {
        let kinds = [Kind::Lure, Kind::Demolition];
        RuleSets::draw(&kinds, true, &[], Seed::from_text("sets"))
    }

    #[test]
    fn no_two_sets_are_near_and_kernels_take_turns() {
        let sets = sets();
        let all: Vec<&RuleSet> = sets.plain.iter().chain(&sets.grafted).collect();
        for (at, one) in all.iter().enumerate() {
            for other in &all[at + 1..] {
                let kernels = (one.genome.kernel(), other.genome.kernel());
                assert!(!one.form.is_near(&other.form), "{kernels:?}");
            }
        }
        let kernels: BTreeSet<&str> = all.iter().map(|set| set.genome.kernel()).collect();
        let first: BTreeSet<&str> =
            sets.plain.iter().take(kernels.len()).map(|set| set.genome.kernel()).collect();
        assert_eq!(first, kernels);
        assert!(sets.grafted.len() > kernels.len());
    }

    #[test]
    fn games_of_a_set_stay_with_it() {
        let sets = sets();
        for set in sets.plain.iter().chain(&sets.grafted) {
            for draw in 0..4 {
                let genome = sets.draw_of(set, Seed::from_text("draw").child("draw", draw));
                assert!(sets.is_of(&genome, set), "{}", set.genome.kernel());
                assert_eq!(genome.scene(), set.genome.scene());
            }
        }
        let own = sets.of_archive(0);
        let variation = KernelVariation::new(&[Kind::Lure, Kind::Demolition]);
        let variation = SetVariation { variation, own: Some((&sets, own.clone())) };
        let mut sampler = Seed::from_text("changes").sampler();
        let mut genome = variation.create(Seed::from_text("first")).unwrap();
        for _ in 0..20 {
            genome = variation.mutate(&genome, &mut sampler);
            assert!(own.iter().any(|set| set.genome.kernel() == genome.kernel()));
        }
    }

    #[test]
    fn places_pass_on_to_different_sets() {
        let sets = sets();
        let at = |place, passes| {
            let set = sets.of_place(Method::Constructive, place, passes).unwrap();
            let mut all = sets.plain.iter().chain(&sets.grafted);
            let at = all.position(|other| other.form == set.form).unwrap();
            let grafted = at.checked_sub(sets.plain.len());
            grafted.map_or(at, |grafted| sets.plain.len() + grafted / 3)
        };
        let all = sets.of_method(Method::Constructive).len();
        let half = all / 2;
        let first: Vec<usize> = (0..all as u32).map(|place| at(place, 0)).collect();
        assert_eq!(first, (0..all).collect::<Vec<_>>());
        let passed: BTreeSet<usize> = (0..half as u32).map(|place| at(place, 1)).collect();
        assert!(passed.len() == half && passed.iter().all(|&at| at >= half));
        assert!(
            RuleSets::draw(&[], true, &[], Seed::from_text("none")).of_place(Method::Search, 3, 1).is_none()
        );
    }

    #[test]
    fn known_games_are_kept_apart_from() {
        let seed = Seed::from_text("sets");
        let all = RuleSets::draw(&[Kind::Lure], false, &[], seed);
        let known: Vec<GameForm> = all.plain.iter().take(2).map(|set| set.form.clone()).collect();
        let left = RuleSets::draw(&[Kind::Lure], false, &known, seed);
        assert!(!left.plain.is_empty() && left.plain.len() < all.plain.len());
        assert!(left.plain.iter().all(|set| known.iter().all(|known| !set.form.is_near(known))));
    }
}
