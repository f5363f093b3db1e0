//! Turning what the generators made into the games of a job: published plays, tiers, and the paths to the seeds of witnesses.

use crate::format::witness::{descendant, way_of_search};
use crate::sections::frozen::FrozenGame;
use base::Seed;
use engine::{Analysis, Episode};
use forge::games::{FoundLevel, MadeGame, Step};
use validators::{Case, CheckedCriteria, Criterion, Demand, shorter_win};

impl FrozenGame {
    /// The game of a job. `job` holds the steps from the release's root to the job's seed. `criteria` are those of its
    /// judges: if they asked a ladder, it plays once more, because accepted levels were lucky in the plays that they
    /// were accepted for.
    /// If `measured`, levels without a tier are given one.
    pub(super) fn of(
        mut made: MadeGame,
        root: Seed,
        job: &[Step],
        criteria: &CheckedCriteria,
        measured: bool,
    ) -> FrozenGame {
        let start: Vec<Step> = job.iter().chain(&made.path).cloned().collect();
        let ladders = made.card.levels.iter().filter_map(|level| level.ladder.as_ref());
        let difficulties = ladders.map(|ladder| ladder.difficulty).collect();
        climb_again(&mut made, descendant(root, &start).child("published", 0), criteria);
        let shorter = if measured { measure(&mut made, root, &start) } else { Vec::new() };
        let won = made.levels.iter().zip(&made.witnesses);
        let paths = won.enumerate().map(|(number, (found, witness))| {
            let known = shorter.get(number).cloned().flatten();
            known.or_else(|| path(root, &start, found, made.levels.len(), witness)).unwrap_or_default()
        });
        let paths = paths.collect();
        let MadeGame { text, card, levels, witnesses, .. } = made;
        let levels = levels.iter().map(|found| found.level.to_string()).collect();
        let (marks, sibling, seconds) = (Vec::new(), None, Vec::new());
        FrozenGame { text, card, difficulties, levels, witnesses, paths, marks, sibling, seconds }
    }
}

/// Measures what the levels of a game demand, where that is not known. Where chance plays a part, a shorter win that is found takes
/// the place of the witness; returns the steps from the root seed to each of those, by level.
fn measure(made: &mut MadeGame, root: Seed, start: &[Step]) -> Vec<Option<Vec<Step>>> {
    let analysis = Analysis::of(&made.game);
    let mut paths = vec![None; made.levels.len()];
    let won = made.levels.iter().zip(&mut made.witnesses);
    for (number, (card, (found, witness))) in made.card.levels.iter_mut().zip(won).enumerate() {
        if card.demand.is_some() {
            continue;
        }
        let mut path = start.to_vec();
        path.extend([("demand".to_owned(), 0), ("level".to_owned(), number as u64)]);
        let seed = descendant(root, &path);
        let shorter = shorter_win(&analysis, &found.level, witness, seed.child("shorter win", 0));
        if let Some((play, shorter)) = shorter {
            card.witness_ticks = shorter.actions.len();
            card.witness_score = shorter.score;
            *witness = shorter;
            path.extend([("shorter win".to_owned(), 0), ("play".to_owned(), play)]);
            paths[number] = Some(path);
        }
        let shortest = card.optimal_ticks == Some(witness.actions.len());
        card.demand = Demand::of(&analysis, &found.level, witness, shortest, seed);
        card.tier = card.demand.as_ref().map(Demand::tier);
    }
    paths
}

/// Replaces the ladders of a game's card by fresh ones.
fn climb_again(made: &mut MadeGame, seed: Seed, criteria: &CheckedCriteria) {
    let players = criteria.players();
    let analysis = Analysis::of(&made.game);
    let won = made.levels.iter().zip(&made.witnesses);
    for (number, (card, (found, witness))) in made.card.levels.iter_mut().zip(won).enumerate() {
        if card.ladder.is_some() {
            let seed = seed.child("level", number as u64);
            let (game, level) = (&made.game, &found.level);
            card.ladder =
                Some(players.ladder(Case { game, level, seed, analysis: &analysis, witness: Some(witness) }));
        }
    }
}

/// The steps from the root seed to the episode that wins a level, beginning with `start`: which of `count` places the
/// level was made for, and which play of which judge won it. `None` if the level was won in another way.
fn path(
    root: Seed,
    start: &[Step],
    found: &FoundLevel,
    count: usize,
    witness: &Episode,
) -> Option<Vec<Step>> {
    let to = |steps: &[(&str, u64)]| -> Vec<Step> {
        steps.iter().map(|&(purpose, index)| (purpose.to_owned(), index)).collect()
    };
    let find = |from: Seed, seed: Seed, mut ways: Box<dyn Iterator<Item = Vec<Step>>>| {
        ways.find(|steps| descendant(from, steps) == seed)
    };
    let judges = descendant(root, start);
    let candidate = found.candidate.into();
    let places = (0..count as u64).map(move |place| to(&[("level", place), ("candidate", candidate)]));
    let place = find(judges, found.seed, Box::new(places))?;
    // Usually the search for a win; if it found none, a win that another judge has seen.
    let others = (0..PLAYS).flat_map(move |play| {
        [
            to(&[(Criterion::Skill.name(), 0), ("chance", play)]),
            to(&[(Criterion::NotRandom.name(), 0), ("random", play), ("chance", 0)]),
            to(&[(Criterion::NotIdle.name(), 0), ("idle", play)]),
            to(&[(Criterion::EarlyDeath.name(), 0), ("chance", play)]),
        ]
    });
    let asked = to(&[("judges", 0)]);
    let asked_seed = descendant(found.seed, &asked);
    let search = to(&[(Criterion::Winnable.name(), 0)]);
    let searched = way_of_search(descendant(asked_seed, &search), witness.seed);
    let won = match searched {
        Some(way) => search.into_iter().chain(way).collect(),
        None => find(asked_seed, witness.seed, Box::new(others))?,
    };
    Some(start.iter().cloned().chain(place).chain(asked).chain(won).collect())
}

/// The upper bound for the plays of judges other than the search for a win.
const PLAYS: u64 = 10_000;
