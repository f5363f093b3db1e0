//! Evolves levels with a cheap substitute for the judges, and compares them with the same number of levels from the
//! constructive generator.

use base::{Digest, Seed};
use engine::{Analysis, Game, Level};
use generators::levels::{LevelConfig, LevelMeasure, LevelMeasures, LevelSimilarity, LevelVariation};
use generators::{Archive, Axis, Evaluation, MapElites, MapElitesConfig, Search, Variation};
use std::collections::VecDeque;

/// A game in which the diver goes down to the hatch, past the rats.
const GAME: &str = "
BasicGame
    SpriteSet
        wall > Immovable
        gem > Immovable
        hatch > Door
        rat > Chaser stype=diver
        diver > MovingAvatar
    LevelMapping
        w > wall
        g > gem
        h > hatch
        r > rat
        d > diver
    InteractionSet
        diver wall > stepBack
        rat wall > stepBack
        gem diver > killSprite scoreChange=1
        diver rat > killSprite
        hatch diver > killSprite
    TerminationSet
        SpriteCounter stype=hatch win=True
        SpriteCounter stype=diver win=False
";
/// The number of runs, each with its own seed.
const RUNS: u64 = 1;
/// The number of batches in a run.
const BATCHES: usize = 75;
/// The number of levels in a batch.
const BATCH: usize = 40;

/// A judge that requires a long path to the hatch, two to four rats, walls that are built rather than scattered, and
/// a path to every gem.
struct Judge {
    measures: LevelMeasures,
    /// The minimum symmetry between the left and right halves.
    symmetry: f64,
    /// The minimum number of steps to the hatch.
    steps: usize,
}

impl Judge {
    fn judge(&self, level: &Level) -> Evaluation {
        let cells = level.cells();
        let count = |symbol: u8| cells.iter().filter(|&&cell| cell == symbol).count();
        let steps = ways(level);
        let reached = |symbol: u8| {
            let reached = (0..cells.len()).filter(|&cell| cells[cell] == symbol && steps[cell].is_some());
            if count(symbol) == 0 { 0.0 } else { reached.count() as f64 / count(symbol) as f64 }
        };
        let all = self.measures.of(level);
        let walls = all[LevelMeasure::Walls as usize];
        let rats = count(b'r') as f64;
        let hatch = cells.iter().position(|&cell| cell == b'h').and_then(|cell| steps[cell]).unwrap_or(0);
        let constraints = [
            if count(b'h') == 1 { reached(b'h') } else { 0.0 },
            reached(b'g'),
            reaches(walls, 0.45),
            reaches(1.0 - walls, 0.35),
            1.0 - all[LevelMeasure::Sprinkle as usize],
            reaches(rats, 2.0) * (4.0 / rats.max(4.0)),
            reaches(all[LevelMeasure::LeftRight as usize], self.symmetry),
            reaches(hatch as f64, self.steps as f64),
        ];
        let met = constraints.iter().sum::<f64>() / constraints.len() as f64;
        Evaluation {
            feasibility: if constraints.iter().all(|&met| met >= 1.0) { 1.0 } else { met.min(0.999) },
            objective: (hatch as f64 / 40.0).min(1.0),
            measures: vec![all[LevelMeasure::Openness as usize], all[LevelMeasure::Pressure as usize]],
        }
    }
}

/// Returns the degree to which a value reaches a required minimum.
fn reaches(value: f64, least: f64) -> f64 {
    if value >= least { 1.0 } else { value / least }
}

/// Returns the number of steps from the diver to every cell, ignoring rats.
fn ways(level: &Level) -> Vec<Option<usize>> {
    let (columns, cells) = (level.columns(), level.cells());
    let start = cells.iter().position(|&cell| cell == b'd').expect("a level has a diver");
    let mut steps = vec![None; cells.len()];
    steps[start] = Some(0);
    let mut queue = VecDeque::from([start]);
    while let Some(cell) = queue.pop_front() {
        // The border consists of walls, so no step wraps around.
        for next in [cell - columns, cell - 1, cell + 1, cell + columns] {
            if cells[next] != b'w' && steps[next].is_none() {
                steps[next] = steps[cell].map(|steps| steps + 1);
                queue.push_back(next);
            }
        }
    }
    steps
}

fn axes() -> Vec<Axis> {
    vec![Axis::new("openness", (0.3, 0.8), 10), Axis::new("enemy pressure", (0.0, 0.5), 10)]
}

/// The results of [`BATCHES`] batches.
#[derive(Debug)]
struct Figures {
    /// The number of feasible candidates in each fifth of all batches.
    feasible: Vec<usize>,
    /// All evaluated candidates, as an archive.
    archive: Archive<Level>,
}

impl Figures {
    /// Evaluates the levels that `ask` returns, and passes the results to `ask`.
    fn of(judge: &Judge, mut ask: impl FnMut(Vec<(Level, Evaluation)>) -> Vec<Level>) -> Figures {
        let (mut archive, mut feasible, mut told) = (Archive::new(axes(), 0), vec![0; 5], Vec::new());
        for batch in 0..BATCHES {
            let asked = ask(told).into_iter();
            told = asked.map(|level| (level.clone(), judge.judge(&level))).collect();
            for (level, evaluation) in &told {
                feasible[batch * 5 / BATCHES] += usize::from(evaluation.is_feasible());
                archive.add(level.clone(), evaluation.clone());
            }
        }
        Figures { feasible, archive }
    }

    fn best(&self) -> f64 {
        self.archive.best().map_or(0.0, |elite| elite.evaluation.objective)
    }
}

/// Reports the results to a search, and requests the next candidates.
fn asks(search: &mut impl Search<Candidate = Level>, told: Vec<(Level, Evaluation)>) -> Vec<Level> {
    search.tell(told);
    search.ask(BATCH)
}

/// Returns the mean of a figure over the runs.
fn mean(runs: &[Figures], figure: impl Fn(&Figures) -> f64) -> f64 {
    runs.iter().map(figure).sum::<f64>() / runs.len() as f64
}

/// Returns a table row with the feasible candidates by fifth of the run, the best objective, the coverage and the QD
/// score.
fn table(name: &str, runs: &[Figures]) -> String {
    let fifths: Vec<String> =
        (0..5).map(|fifth| format!("{:.0}", mean(runs, |run| run.feasible[fifth] as f64))).collect();
    let best = mean(runs, Figures::best);
    let coverage = mean(runs, |run| run.archive.coverage());
    let score = mean(runs, |run| run.archive.qd_score());
    format!("{name}: feasible {}, best {best:.3}, coverage {coverage:.3}, score {score:.1}", fifths.join(" "))
}

/// The results for the same number of levels, by generator or search.
struct Contest {
    constructive: Vec<Figures>,
    elites: Vec<Figures>,
    /// The results of MAP-Elites without infeasible candidates in its archive.
    without_pockets: Vec<Figures>,
}

impl Contest {
    /// Runs the generator and all searches with levels of 13 × 9 cells.
    #[allow(clippy::print_stderr, reason = "figures for whoever asks with --nocapture")]
    fn of(symmetry: f64, steps: usize) -> Contest {
        let game = Game::from_source(GAME).expect("a game");
        let analysis = Analysis::of(&game);
        let config = LevelConfig { columns: (13, 13), rows: (9, 9), ..LevelConfig::default() };
        let variation = LevelVariation::new(&game, config).expect("levels can be made for the game");
        let measures = LevelMeasures::new(&analysis).expect("a diver can be placed");
        let judge = Judge { measures, symmetry, steps };
        let likeness = LevelSimilarity::of(&analysis);
        let key = |level: &Level| -> Digest { likeness.digest(level) };
        let constructive = |seed: Seed| {
            let mut created = 0..;
            let mut next = || created.by_ref().find_map(|at| variation.create(seed.child("level", at)));
            Figures::of(&judge, |_| (0..BATCH).filter_map(|_| next()).collect())
        };
        let elites = |pocket, seed| {
            let config = MapElitesConfig { pocket, ..MapElitesConfig::default() };
            let mut search = MapElites::new(&variation, key, axes(), config, seed);
            Figures::of(&judge, |told| asks(&mut search, told))
        };
        let seeds = || (0..RUNS).map(|run| Seed::from_text("evolution").child("run", run));
        let contest = Contest {
            constructive: seeds().map(constructive).collect(),
            elites: seeds().map(|seed| elites(MapElitesConfig::default().pocket, seed)).collect(),
            without_pockets: seeds().map(|seed| elites(0, seed)).collect(),
        };
        eprintln!("{}", contest.table());
        contest
    }

    fn table(&self) -> String {
        let rows = [
            ("constructive", &self.constructive),
            ("MAP-Elites", &self.elites),
            ("MAP-Elites without pockets", &self.without_pockets),
        ];
        rows.map(|(name, runs)| table(name, runs)).join("\n")
    }
}

#[test]
fn evolution_beats_as_many_levels_from_the_constructive_generator() {
    let contest = Contest::of(0.0, 0);
    let gain = |figure: &dyn Fn(&Figures) -> f64| {
        mean(&contest.elites, figure) / mean(&contest.constructive, figure)
    };
    assert!(gain(&|run| run.feasible[4] as f64) > 2.0, "{}", contest.table());
    assert!(gain(&Figures::best) > 1.1, "{}", contest.table());
    assert!(gain(&|run| run.archive.coverage()) > 1.5, "{}", contest.table());
    assert!(gain(&|run| run.archive.qd_score()) > 2.0, "{}", contest.table());
}

/// The test requires long paths on boards that are nearly symmetric.
#[test]
fn infeasible_parents_lead_to_rare_feasible_levels() {
    let contest = Contest::of(0.7, 24);
    let feasible = |runs: &[Figures]| mean(runs, |run| run.feasible.iter().sum::<usize>() as f64);
    assert!(contest.elites.iter().all(|run| run.best() > 0.0), "{}", contest.table());
    assert!(feasible(&contest.elites) > 10.0 * feasible(&contest.constructive), "{}", contest.table());
    assert!(feasible(&contest.elites) > 2.0 * feasible(&contest.without_pockets), "{}", contest.table());
}
