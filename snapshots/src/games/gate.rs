//! The last word on a game: levels for it, what it can do without, and the panel.

use super::candidate::{Candidate, MadeGame};
use super::levels::{FoundLevel, FoundLevels, Levels};
use super::order::GameOrder;
use super::shrink::shrunk;
use crate::mint::Tally;
use engine::{Analysis, Game, Seed};
use generators::games::GameGenome;
use std::collections::BTreeSet;
use validators::game_measures::Guards;
use validators::novelty::{GameForm, NEAR};
use validators::{Panel, used_rules};

/// Judges games for good, with dice that no search has seen.
pub(super) struct Gate<'a> {
    order: &'a GameOrder,
    /// The games that others have to differ from.
    known: &'a [GameForm],
    canary: &'a str,
    panel: Panel,
}

/// Why a game is turned down in which too little happens.
const MEAGRE: &str = "meagre";
/// Why a game is turned down that is too much like another.
pub(super) const NEAR_KNOWN: &str = "near to a known game";

impl<'a> Gate<'a> {
    pub(super) fn new(order: &'a GameOrder, known: &'a [GameForm], canary: &'a str) -> Gate<'a> {
        Gate { order, known, canary, panel: Panel::new(&order.criteria) }
    }

    /// Finds levels for a game, takes away what it can do without, and judges what is left on the same levels; none, with the
    /// reason in the tally, if anything stands in its way. `number` is told in the card.
    pub(super) fn judge(
        &self,
        genome: &GameGenome,
        number: u32,
        seed: Seed,
        tally: &mut Tally,
    ) -> Option<MadeGame> {
        let generator = self.order.method.name();
        let candidate =
            |genome: &GameGenome| Candidate::generated(genome.build().ok()?, generator, number).ok();
        let Some(first) = candidate(genome) else {
            tally.game_rejected("the rules do not compile");
            return None;
        };
        if self.is_known(&first) {
            tally.game_rejected(NEAR_KNOWN);
            return None;
        }
        if interactions(&first.game) < self.order.least_interactions {
            tally.game_rejected(MEAGRE);
            return None;
        }
        let levels = Levels {
            count: self.order.levels,
            tries: self.order.level_tries,
            board: &self.order.board,
            criteria: &self.order.criteria,
            panel: &self.panel,
            seed,
        };
        let found = levels.each(&first.game, tally)?;
        let (candidate, found) = match shrunk(genome, &first, &found, candidate) {
            None => (first, found),
            Some(smaller) => {
                let again = found.iter().map(|found| levels.again(&smaller.game, found, tally));
                let Some(again) = again.collect::<Option<Vec<_>>>() else {
                    tally.game_rejected("shrunk");
                    return None;
                };
                (smaller, again)
            }
        };
        if self.is_known(&candidate) {
            tally.game_rejected(NEAR_KNOWN);
            return None;
        }
        if interactions(&candidate.game) < self.order.least_interactions
            || mechanics(&candidate.game, &found) < self.order.least_mechanics
        {
            tally.game_rejected(MEAGRE);
            return None;
        }
        // What a second look with other dice does not find would not be found by others either.
        levels.together(&candidate.game, &found, seed.child("second look", 0), tally)?;
        let together =
            levels.together(&candidate.game, &found, seed.child("judges of the game", 0), tally)?;
        let made = candidate.finish(FoundLevels { levels: found, together }, self.canary);
        if made.is_some() {
            tally.game_accepted();
        }
        made
    }

    fn is_known(&self, candidate: &Candidate) -> bool {
        let form = GameForm::of(&candidate.game);
        form.nearest(self.known).is_some_and(|(_, apart)| apart < NEAR)
    }
}

fn interactions(game: &Game) -> usize {
    game.description().interactions.len()
}

/// The interactions that the wins of the levels execute, guards apart.
fn mechanics(game: &Game, levels: &[FoundLevel]) -> usize {
    let guards: BTreeSet<usize> = Guards::of(&Analysis::of(game)).lines().collect();
    let won = levels.iter().filter_map(|found| Some((&found.level, found.report.witness.as_ref()?)));
    let used: BTreeSet<usize> = won.flat_map(|(level, witness)| used_rules(game, level, witness)).collect();
    used.difference(&guards).count()
}
