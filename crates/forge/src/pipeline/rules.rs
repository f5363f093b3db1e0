//! Stages that check whether a game's rules are new, and whether the rules produce enough interactions.

use super::game::Trial;
use super::invented::USELESS;
use super::stage::{Passage, Refusal, Stage};
use crate::games::FoundLevel;
use crate::tally::Tally;
use engine::{Analysis, Game};
use std::collections::BTreeSet;
use validators::measures::Guards;
use validators::novelty::{GameForm, NEAR};

/// The reason for rejecting a game that is near a known game.
pub(crate) const NEAR_KNOWN: &str = "near to a known game";
/// The reason for rejecting a game that has too few interactions, or whose wins execute too few of them.
pub(super) const MEAGRE: &str = "meagre";

impl Trial<'_> {
    pub(super) const NEW_RULES: Stage<Self> = Stage {
        name: "new rules",
        purpose: "compares rules, title and names with known games and with the games of the set",
        cost: "a millisecond",
        reasons: &[NEAR_KNOWN, "duplicate title", "duplicate cast"],
        ..Stage::once(Self::ask_for_new_rules)
    };

    pub(super) const INTERACTIONS: Stage<Self> = Stage {
        name: "interactions",
        purpose: "counts the interactions of the rules: at least 7, unless the order says otherwise",
        reasons: &[MEAGRE],
        ..Stage::once(Self::count_interactions)
    };

    pub(super) const MECHANICS: Stage<Self> = Stage {
        name: "mechanics",
        purpose: "counts the distinct interactions that the wins execute, guards excluded: at least 3, unless the order says \
                  otherwise",
        cost: "a replay of each win",
        reasons: &[MEAGRE],
        ..Stage::once(Self::count_mechanics)
    };

    pub(super) const QUICK_LOOK: Stage<Self> = Stage {
        name: "quick look",
        purpose: "for an invented game, composes a few boards, and requires one win with costly choices \
                  and one board on which every mechanic matters",
        cost: "up to 3.5 million forward-model calls",
        reasons: &[
            "no board was won",
            "hardly anything is necessary",
            "no wrong choice costs",
            "no wrong choice kills",
            USELESS,
        ],
        ..Stage::once(Self::look_quickly)
    };

    fn look_quickly(&mut self, _: &mut Tally) -> Passage {
        let seed = self.levels.seed.seed().child("quick look", 0);
        self.levels.source.look(&self.candidate.game, seed).map_err(Refusal::from)
    }

    fn ask_for_new_rules(&mut self, _: &mut Tally) -> Passage {
        let form = GameForm::of(&self.candidate.game);
        let is_known = form.nearest(self.demands.known).is_some_and(|(_, apart)| apart < NEAR);
        let objection = if is_known { Some(NEAR_KNOWN) } else { (self.demands.objection)(&self.candidate) };
        objection.map_or(Ok(()), |why| Err(why.into()))
    }

    fn count_interactions(&mut self, _: &mut Tally) -> Passage {
        let interactions = self.candidate.game.description().interactions.len();
        if interactions < self.demands.least_interactions { Err(MEAGRE.into()) } else { Ok(()) }
    }

    fn count_mechanics(&mut self, _: &mut Tally) -> Passage {
        let mechanics = mechanics(&self.candidate.game, &self.found);
        if mechanics < self.demands.least_mechanics { Err(MEAGRE.into()) } else { Ok(()) }
    }
}

/// Counts the interactions that the levels' wins execute, not counting guards (rules that only keep sprites on the
/// board and out of walls).
fn mechanics(game: &Game, levels: &[FoundLevel]) -> usize {
    let guards = Guards::of(&Analysis::of(game));
    levels.iter().flat_map(|found| found.mechanics(game, &guards)).collect::<BTreeSet<usize>>().len()
}
