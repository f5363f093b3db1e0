//! Tests of the illumination of slopes by MAP-Elites.

use crate::toys::{Slopes, run, sample};
use base::{Digest, Seed};
use generators::{Archive, Axis, Evaluation, MapElites, MapElitesConfig, Search};

const BINS: usize = 20;

fn axes() -> Vec<Axis> {
    ["first half", "second half"].map(|name| Axis::new(name, (0.0, 1.0), BINS)).to_vec()
}

fn search(config: MapElitesConfig, seed: u64) -> MapElites<'static, Slopes> {
    let seed = Seed::from_text("slopes").child("run", seed);
    MapElites::new(&Slopes, Slopes::key, axes(), config, seed)
}

/// The means of random numbers cluster in the middle. Illumination reaches the corners and smooths its candidates.
#[test]
fn far_more_is_illuminated_than_by_random_sampling() {
    for seed in 0..3 {
        let mut search = search(MapElitesConfig::default(), seed);
        let judged = run(&mut search, Slopes::judge, 200, 50);
        let mut random = Archive::new(axes(), 0);
        for (candidate, evaluation) in sample(&Slopes, Slopes::judge, seed, judged.len()) {
            random.add(candidate, evaluation);
        }
        let figures = [search.archive(), &random].map(|archive| (archive.coverage(), archive.qd_score()));
        let [(coverage, score), (random_coverage, random_score)] = figures;
        assert!(coverage > 0.9 && coverage > 1.3 * random_coverage, "{figures:?}");
        assert!(score > 1.5 * random_score, "{figures:?}");
    }
}

/// Pockets are the only parents when all created candidates are infeasible.
#[test]
fn pockets_lead_to_the_first_feasible_candidate() {
    let steep = |slope: &[u8; 8]| {
        let drops = [(0, 7), (1, 6), (2, 5)].map(|(one, two)| f64::from(slope[one].abs_diff(slope[two])));
        let met = drops.map(|drop| (drop / 90.0).min(1.0));
        Evaluation { feasibility: met.iter().sum::<f64>() / 3.0, ..Slopes::judge(slope) }
    };
    let found = |pocket, seed| {
        let mut search = search(MapElitesConfig { pocket, ..MapElitesConfig::default() }, seed);
        run(&mut search, steep, 60, 50);
        search.archive().elites().len()
    };
    let with: Vec<usize> = (0..3).map(|seed| found(4, seed)).collect();
    let without: Vec<usize> = (0..3).map(|seed| found(0, seed)).collect();
    assert!(with.iter().all(|&elites| elites > 5), "{with:?}");
    assert_eq!(without, [0; 3]);
}

#[test]
fn equal_seeds_ask_for_equal_candidates_and_none_twice() {
    let asked = |seed| run(&mut search(MapElitesConfig::default(), seed), Slopes::judge, 12, 20);
    assert_eq!(asked(1), asked(1));
    assert_ne!(asked(1), asked(2));
    let mut keys: Vec<Digest> = asked(3).iter().map(|(slope, _)| Slopes::key(slope)).collect();
    keys.sort_unstable();
    keys.dedup();
    assert_eq!(keys.len(), 240);
}

#[test]
fn foreign_candidates_can_start_the_search() {
    let mut search = search(MapElitesConfig { initial: 1, ..MapElitesConfig::default() }, 0);
    let flat = [50, 50, 50, 50, 50, 50, 50, 70];
    search.tell(vec![(flat, Slopes::judge(&flat))]);
    assert_eq!(search.archive().best().map(|elite| elite.candidate), Some(flat));
    assert_eq!(search.ask(10).len(), 10);
}
