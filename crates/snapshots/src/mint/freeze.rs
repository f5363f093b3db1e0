//! Conversion of generated games into a job's games. It adds the tiers, the results of the reference players for
//! publication, and the seed paths of the witnesses.

use crate::sections::frozen::FrozenGame;
use base::SeedPath;
use engine::Analysis;
use forge::games::MadeGame;
use validators::{Case, CheckedCriteria, Demand, shorter_win};

impl FrozenGame {
    /// Converts a generated game. `criteria` are the criteria by which it was judged. If they include a ladder, its
    /// reference players play again with fresh seeds, because the episodes that led to a level's acceptance are biased
    /// by luck. If `measured` is set, the tier of every level without a tier is measured.
    pub(super) fn of(mut made: MadeGame, criteria: &CheckedCriteria, measured: bool) -> FrozenGame {
        let ladders = made.card.levels.iter().filter_map(|level| level.ladder.as_ref());
        let difficulties = ladders.map(|ladder| ladder.difficulty).collect();
        let published = made.seed.child("published", 0);
        climb_again(&mut made, &published, criteria);
        if measured {
            measure(&mut made);
        }
        let MadeGame { text, card, levels, mut witnesses, .. } = made;
        let paths = witnesses.iter_mut().map(|witness| std::mem::take(&mut witness.path)).collect();
        let levels = levels.iter().map(|found| found.level.to_string()).collect();
        let (marks, ceilings, sibling, seconds) = (Vec::new(), Vec::new(), None, Vec::new());
        FrozenGame { text, card, difficulties, levels, witnesses, paths, marks, ceilings, sibling, seconds }
    }
}

/// Measures the tier (difficulty class) of every level without a tier. In stochastic games, a shorter win found during
/// the measurement replaces the witness.
fn measure(made: &mut MadeGame) {
    let analysis = Analysis::of(&made.game);
    let won = made.levels.iter().zip(&mut made.witnesses);
    for (number, (card, (found, witness))) in (0..).zip(made.card.levels.iter_mut().zip(won)) {
        if card.demand.is_some() {
            continue;
        }
        let seed = made.seed.child("demand", 0).child("level", number);
        if let Some(shorter) = shorter_win(&analysis, &found.level, witness, seed.child("shorter win", 0)) {
            card.witness_ticks = shorter.actions.len();
            card.witness_score = shorter.score;
            *witness = shorter;
        }
        let shortest = card.optimal_ticks == Some(witness.actions.len());
        card.demand = Demand::of(&analysis, &found.level, witness, shortest, seed.seed());
        card.tier = card.demand.as_ref().map(Demand::tier);
    }
}

/// Replaces the reference players' results on a game's card with new results from fresh seeds.
fn climb_again(made: &mut MadeGame, seed: &SeedPath, criteria: &CheckedCriteria) {
    let players = criteria.players();
    let analysis = Analysis::of(&made.game);
    let won = made.levels.iter().zip(&made.witnesses);
    for (number, (card, (found, witness))) in made.card.levels.iter_mut().zip(won).enumerate() {
        if card.ladder.is_some() {
            let seed = &seed.child("level", number as u64);
            let (game, level) = (&made.game, &found.level);
            card.ladder =
                Some(players.ladder(Case { game, level, seed, analysis: &analysis, witness: Some(witness) }));
        }
    }
}
