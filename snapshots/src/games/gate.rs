//! The last word on a game: levels for it, what it can do without, and the panel.

use super::candidate::{Candidate, MadeGame};
use super::levels::{FoundLevels, Levels};
use super::order::GameOrder;
use super::shrink::shrunk;
use crate::mint::Tally;
use engine::Seed;
use generators::games::GameGenome;
use validators::Panel;
use validators::novelty::{GameForm, NEAR};

/// Judges games for good, with dice that no search has seen.
pub(super) struct Gate<'a> {
    order: &'a GameOrder,
    /// The games that others have to differ from.
    known: &'a [GameForm],
    canary: &'a str,
    panel: Panel,
}

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
        let together = levels.together(&candidate.game, &found, tally)?;
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
