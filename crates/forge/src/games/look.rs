//! A quick look at the game of a kernel: the evaluation of a search.

use super::searched::{Look, Searchable};
use agents::{Play, ReferencePlanner};
use base::{Digest, Seed};
use engine::{Analysis, Episode, Level, Outcome};
use generators::kernels::{Course, KernelGame, KernelGenome, Slot};
use generators::{Axis, Evaluation};
use validators::measures::{Coupling, PlayMeasures, Regret};
use validators::{Case, Ladder, LadderConfig, Recorded};

/// The levels of a look.
const SLOTS: [Slot; 3] = [Slot::Introduce, Slot::Combine, Slot::Exam];
/// Boards that are tried for each.
const BOARDS: u64 = 3;
/// The players of a look: none of those that only acceptance asks.
const PLAYERS: [&str; 4] = ["do-nothing", "random", "mcts:30", "olets:50"];
/// The number of those who do not look ahead, who come first.
const CARELESS: usize = 2;
/// Plays of each player on each level, at most.
const PLAYS: u64 = 4;
/// Forward-model calls of all of them on a level, after which no further round of plays begins.
const CALLS: u64 = 300_000;
/// Ticks of a play: half as many again as the judges let a win take.
const TICKS: usize = 240;
/// The greatest share of plays that those who do not look ahead may win.
const LUCK: f64 = 0.1;
/// The least share that somebody who looks ahead has to win, more than they do.
const EDGE: f64 = 0.3;
/// Levels that somebody has to win.
const WON: f64 = 2.0;
/// Interactions of a won play, guards apart, that are enough.
const MECHANICS: f64 = 6.0;
/// Ticks of foresight that are enough.
const SIGHT: f64 = 24.0;
/// The share of plays that the best player wins where a game is neither too easy nor too hard.
const CHALLENGE: f64 = 0.75;

/// The axes of an archive of games: the kernel, how much the rules pull against each other, and how much happens without
/// the player.
pub(super) fn axes() -> Vec<Axis> {
    let kernels = KernelGenome::kernels().count();
    vec![
        Axis::new("kernel", (0.0, kernels as f64), kernels),
        Axis::new("coupling", (0.0, 1.0), 3),
        Axis::new("pace", (0.0, 1.0), 2),
    ]
}

/// The results of the players on one level.
struct Played {
    level: Level,
    ladder: Ladder,
    episodes: Vec<Episode>,
}

impl Played {
    fn wins(&self) -> impl Iterator<Item = &Episode> {
        self.episodes.iter().filter(|episode| episode.outcome == Outcome::Won)
    }

    fn is_won(&self) -> bool {
        self.wins().next().is_some()
    }
}

impl Searchable for KernelGenome {
    fn key(&self) -> Digest {
        KernelGenome::key(self)
    }

    /// Cost: 24 to 48 plays of at most 240 ticks, and [`PlayMeasures`].
    fn look(&self, seed: Seed) -> Look {
        let Ok(KernelGame { game, course }) = KernelGenome::build(self) else {
            return look_of([0.0; 4], 0.0, vec![0.0; 3], 0);
        };
        let game = game.rules;
        let analysis = Analysis::of(&game);
        let coupling = Coupling::of(&analysis).strength();
        let kernel = KernelGenome::kernels().position(|name| name == self.kernel()).unwrap_or_default();
        let mut played: Vec<Played> = Vec::new();
        for (number, slot) in (0..).zip(SLOTS) {
            // Who wins neither an introduction nor a level after it does not win the exam.
            let is_beyond = played.len() == WON as usize && !played.iter().any(Played::is_won);
            let plays = if is_beyond { 0 } else { PLAYS };
            played.extend(Played::play(&analysis, &course, slot, plays, seed.child("level", number)));
        }
        let calls = played.iter().flat_map(|played| &played.ladder.rungs).map(|fared| fared.rate.calls).sum();
        let recording: Vec<Recorded<'_>> = played
            .iter()
            .map(|played| Recorded { level: &played.level, episodes: &played.episodes })
            .collect();
        let measures = PlayMeasures::of(&analysis, &recording, seed.child("measures", 0));
        let place = |pace| vec![kernel as f64, coupling, pace];
        let drawn = played.len() as f64 / SLOTS.len() as f64;
        let Some(measures) = measures else {
            return look_of([drawn, 0.0, 0.0, 0.0], 0.0, place(0.0), calls);
        };

        let share = |at: usize| {
            let rates = || played.iter().map(|played| &played.ladder.rungs[at].rate);
            let plays: u64 = rates().map(|rate| rate.plays).sum();
            rates().map(|rate| rate.wins).sum::<u64>() as f64 / plays.max(1) as f64
        };
        let [idle, random, weak, strong] = [share(0), share(1), share(2), share(3)];
        let (floor, best) = (idle.max(random), weak.max(strong));
        let lucky = if floor <= LUCK { 1.0 } else { 1.0 - floor };
        let edge = ((best - floor) / EDGE).clamp(0.0, 1.0);
        let won = played.iter().filter(|played| played.is_won()).count();
        let constraints = [drawn, lucky, edge, (won as f64 / WON).min(1.0)];
        // Only feasible games are compared by their objective.
        let is_feasible = constraints.iter().all(|met| *met >= 1.0);
        let regret = played.iter().filter(|_| is_feasible).filter_map(|played| {
            let won = played.wins().next()?;
            Some(Regret::of(&game, &played.level, won, seed.child("regret", 0)).strength())
        });
        let regret = regret.fold(0.0, f64::max);
        let objective = 0.2 * (best - floor).max(0.0)
            + 0.1 * (measures.mechanics as f64 / MECHANICS).min(1.0)
            + 0.1 * (1.0 - (best - CHALLENGE).abs() / CHALLENGE)
            + 0.1 * (measures.sight / SIGHT).min(1.0)
            + 0.1 * measures.drama
            + 0.2 * coupling
            + 0.2 * regret;
        look_of(constraints, objective.clamp(0.0, 1.0), place(measures.pace), calls)
    }
}

impl Played {
    /// Lets the players of a look play a level of a slot.
    fn play(analysis: &Analysis, course: &Course, slot: Slot, plays: u64, seed: Seed) -> Option<Played> {
        let game = analysis.game();
        let level = (0..BOARDS).find_map(|board| {
            let level = course.level(slot, seed.child("board", board)).ok()?;
            game.level(&level.text).ok()
        })?;
        let rung = |name: &&str| ReferencePlanner::new(name, 1).expect("a player with its calls");
        let climb = LadderConfig {
            rungs: PLAYERS.iter().map(rung).collect(),
            held_out: Vec::new(),
            plays,
            calls: CALLS,
            ticks: TICKS,
            patience: 1,
        };
        let seed = seed.child("plays", 0).into();
        let case = Case { game, level: &level, seed: &seed, analysis, witness: None };
        // Of a planner that won both first plays, or neither, two more would tell little.
        let is_won = |play: &Play| play.episode.outcome == Outcome::Won;
        let is_settled = |own: &Vec<Play>| own.iter().all(|play| is_won(play) == is_won(&own[0]));
        let enough = |plays: &[Vec<Play>]| plays.iter().skip(CARELESS).all(is_settled);
        let (ladder, episodes) = climb.play_until(case, enough);
        Some(Played { level, ladder, episodes })
    }
}

fn look_of(constraints: [f64; 4], objective: f64, measures: Vec<f64>, calls: u64) -> Look {
    let feasibility = constraints.iter().sum::<f64>() / constraints.len() as f64;
    Look { evaluation: Evaluation { feasibility, objective, measures }, calls }
}
