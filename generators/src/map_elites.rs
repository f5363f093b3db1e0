//! Illumination search, which finds the best candidate for each cell by varying known candidates.

use crate::breeding::Breeding;
use crate::{Archive, Axis, Evaluated, Evaluation, Search, Variation};
use base::{Digest, Sampler, Seed};

/// The minimum size of the tournament among infeasible parents. The tournament grows with the number of pockets (a
/// cell's lists of infeasible candidates), because pockets retain many candidates that lead nowhere.
const TOURNAMENT: usize = 3;
/// The number of pockets (lists of infeasible candidates) for each additional entrant in the tournament among
/// infeasible parents.
const SHARE: usize = 8;

base::with_defaults! {
    /// The parameters of [`MapElites`].
    #[derive(Clone, Debug, PartialEq)]
    pub struct MapElitesConfig {
        /// The number of candidates to create before breeding starts.
        pub initial: usize = 64,
        /// The probability that a child has two parents.
        pub crossing: f64 = 0.4,
        /// The fraction of candidates created from scratch once breeding has started.
        pub fresh: f64 = 0.05,
        /// The fraction of candidates bred from infeasible parents once elites exist.
        pub infeasible: f64 = 0.15,
        /// The maximum number of infeasible candidates per cell.
        pub pocket: usize = 4,
    }
}

/// Constrained MAP-Elites, whose result is an [`Archive`] (Khalifa et al., "Talakat: Bullet Hell Generation through
/// Constrained Map-Elites", 2018; Alvarez et al., "Empowering Quality Diversity in Dungeon Design with Interactive
/// Constrained MAP-Elites", 2019).
///
/// Parents and mates are elites, drawn uniformly from the filled cells. A fraction of the parents are infeasible. They
/// preferably come from the pockets of empty cells next to filled cells, where the frontier can advance. No candidate
/// is proposed twice.
///
/// ```
/// # use base as infinite_arcade_base;
/// use infinite_arcade_base::{Digest, Sampler, Seed};
/// use infinite_arcade_generators::{Axis, Evaluation, MapElites, MapElitesConfig, Search, Variation};
///
/// /// Rectangles of up to 20 × 20.
/// struct Rectangles;
///
/// impl Variation for Rectangles {
///     type Candidate = [u8; 2];
///     fn create(&self, seed: Seed) -> Option<[u8; 2]> {
///         let mut sampler = seed.sampler();
///         Some([0; 2].map(|_| sampler.between(1, 20) as u8))
///     }
///     fn mutate(&self, parent: &[u8; 2], sampler: &mut Sampler) -> [u8; 2] {
///         parent.map(|side| (side + sampler.below(5) as u8).saturating_sub(2).clamp(1, 20))
///     }
///     fn cross(&self, one: &[u8; 2], two: &[u8; 2], _: &mut Sampler) -> [u8; 2] {
///         [one[0], two[1]]
///     }
/// }
///
/// // The largest area for every perimeter.
/// let axes = vec![Axis::new("perimeter", (4.0, 84.0), 20)];
/// let (config, seed) = (MapElitesConfig::default(), Seed::from_text("rectangles"));
/// let mut search = MapElites::new(&Rectangles, |sides: &[u8; 2]| Digest::of(sides), axes, config, seed);
/// for _ in 0..20 {
///     let judge = |sides: [u8; 2]| {
///         let [width, height] = sides.map(f64::from);
///         let (objective, measures) = (width * height / 400.0, vec![2.0 * (width + height)]);
///         (sides, Evaluation { feasibility: 1.0, objective, measures })
///     };
///     let judged = search.ask(16).into_iter().map(judge).collect();
///     search.tell(judged);
/// }
/// assert!(search.archive().coverage() > 0.9);
/// assert_eq!(search.archive().best().map(|elite| elite.candidate), Some([20, 20]));
/// ```
pub struct MapElites<'a, V: Variation> {
    config: MapElitesConfig,
    breeding: Breeding<'a, V>,
    /// The number of candidates to create before breeding starts.
    initial: usize,
    archive: Archive<V::Candidate>,
}

impl<'a, V: Variation> MapElites<'a, V> {
    /// Creates a search. Candidates with equal keys count as the same candidate. The axes are the measures of the
    /// evaluations, in the same order.
    pub fn new(
        variation: &'a V,
        key: impl Fn(&V::Candidate) -> Digest + Send + 'a,
        axes: Vec<Axis>,
        config: MapElitesConfig,
        seed: Seed,
    ) -> Self {
        let breeding = Breeding::new(variation, Box::new(key), config.crossing, seed);
        let (initial, archive) = (config.initial.max(1), Archive::new(axes, config.pocket));
        MapElites { config, breeding, initial, archive }
    }

    /// Returns the archive of all results so far.
    pub fn archive(&self) -> &Archive<V::Candidate> {
        &self.archive
    }

    /// Removes an elite that a more thorough evaluation found infeasible; see [`Archive::demote`].
    pub fn demote(&mut self, cell: usize, feasibility: f64) {
        self.archive.demote(cell, feasibility);
    }

    fn propose(&mut self) -> Option<V::Candidate> {
        let mut sampler = self.breeding.next_sampler();
        let is_fresh = sampler.unit() < self.config.fresh;
        let is_infeasible = sampler.unit() < self.config.infeasible;
        let (elites, pockets) = (self.archive.elites().len(), self.archive.pockets().len());
        if self.initial > 0 || is_fresh || elites + pockets == 0 {
            self.initial = self.initial.saturating_sub(1);
            return self.breeding.create();
        }
        let parent = if elites == 0 || (is_infeasible && pockets > 0) {
            infeasible(&self.archive, &mut sampler)
        } else {
            elite(&self.archive, &mut sampler)
        };
        let mate = if elites == 0 {
            infeasible(&self.archive, &mut sampler)
        } else {
            elite(&self.archive, &mut sampler)
        };
        let mate = (!std::ptr::eq(parent, mate)).then_some(&mate.candidate);
        let child = self.breeding.breed(&parent.candidate, mate, &mut sampler);
        child.or_else(|| self.breeding.create())
    }
}

impl<V: Variation> Search for MapElites<'_, V> {
    type Candidate = V::Candidate;

    /// Returns fewer than `count` candidates only if the variation yields no new candidates. A later call may return
    /// more. Cost per candidate, in addition to the cost of its variation: O(pockets × axes).
    fn ask(&mut self, count: usize) -> Vec<V::Candidate> {
        (0..count).filter_map(|_| self.propose()).collect()
    }

    /// Also accepts candidates that the search did not propose, so that the caller can provide a starting population.
    fn tell(&mut self, evaluated: Vec<(V::Candidate, Evaluation)>) {
        for (candidate, evaluation) in evaluated {
            self.breeding.note(&candidate);
            self.archive.add(candidate, evaluation);
        }
    }
}

/// Draws an elite from an archive with at least one elite.
fn elite<'c, C>(archive: &'c Archive<C>, sampler: &mut Sampler) -> &'c Evaluated<C> {
    let at = sampler.below(archive.elites().len());
    archive.elites().nth(at).expect("an index below the length").1
}

/// Draws an infeasible candidate from an archive with at least one. Prefers cells that have no elite and are next to
/// cells with an elite, and otherwise uses any cell with infeasible candidates.
fn infeasible<'c, C>(archive: &'c Archive<C>, sampler: &mut Sampler) -> &'c Evaluated<C> {
    let is_filled = |cell: usize| archive.elite(cell).is_some();
    let at_frontier = |(cell, _): &(usize, &[Evaluated<C>])| {
        !is_filled(*cell) && archive.neighbours(*cell).into_iter().any(is_filled)
    };
    let mut pockets: Vec<(usize, &[Evaluated<C>])> = archive.pockets().filter(at_frontier).collect();
    if pockets.is_empty() {
        pockets = archive.pockets().collect();
    }
    let drawn: Vec<&Evaluated<C>> = (0..TOURNAMENT + pockets.len() / SHARE)
        .map(|_| {
            let (_, pocket) = *sampler.choose(&pockets);
            sampler.choose(pocket)
        })
        .collect();
    let merit = |judged: &Evaluated<C>| judged.evaluation.feasibility;
    drawn
        .into_iter()
        .reduce(|best, other| if merit(other) > merit(best) { other } else { best })
        .expect("several")
}
