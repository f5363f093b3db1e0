//! Builds games from kernels, which are hand-written game designs.

use super::attempt::Attempted;
use super::candidate::{Candidate, MadeGame};
use super::kept::Kept;
use super::order::{GameEffort, GameOrder};
use crate::games::sets::rule_sets::RuleSets;
use crate::levels::Method;
use crate::pipeline::{GameGate, Rules};
use crate::progress::Progress;
use crate::tally::Tally;
use base::{Seed, SeedPath};
use generators::kernels::KernelGenome;
use std::collections::BTreeSet;
use validators::novelty::GameForm;

/// The games generated for an order.
#[derive(Clone, Debug, Default)]
pub struct GameSet {
    /// The successfully generated games, ordered by number.
    pub games: Vec<MadeGame>,
    /// The numbers of candidates tried, and the reasons why some failed.
    pub tally: Tally,
}

/// The errors of game generation.
#[derive(Debug, thiserror::Error)]
pub enum GamesError {
    /// No candidate passed all judges.
    #[error(
        "no game was accepted ({looks} inspected, {} judged): {}", .tally.games_tried, .tally.reasons(), looks = .tally.looks()
    )]
    NoneAccepted {
        /// The numbers of candidates searched and judged, and the reasons for failures.
        tally: Box<Tally>,
    },
}

/// Builds an order's games from kernels, which are hand-written game designs. The files contain `canary`. The same
/// order, known games and seed give the same games on any number of threads.
///
/// - Any two of the games and the `known` games are at least [`NEAR`](validators::novelty::NEAR) apart.
/// - No two games share a title or most of their names.
/// - Each kernel is used once before any kernel is used twice.
/// - At most three games of twenty are of the same kind.
///
/// Cost: 20 to 30 core seconds per game, on all threads of the current rayon pool.
///
/// Games that could not be generated are missing from the set.
///
/// # Errors
/// Returns [`GamesError::NoneAccepted`] if not a single game was accepted.
pub fn make_games(
    order: &GameOrder,
    known: &[GameForm],
    canary: &str,
    seed: impl Into<SeedPath>,
    progress: &dyn Progress,
) -> Result<GameSet, GamesError> {
    Maker::of_kernels(order, known, canary, seed.into(), progress).make_in_rounds().unless_empty(order)
}

/// Builds game `number` of an order whose games are generated one by one, from the [rules](RuleSets) assigned to that
/// number. The game is kept apart from known games, but does not depend on the other games of the order. Returns no
/// game if all attempts fail. Cost and reproducibility are as for [`make_games`].
pub fn make_one(
    order: &GameOrder,
    sets: &RuleSets,
    known: &[GameForm],
    seed: SeedPath,
    number: u32,
) -> (Option<MadeGame>, Tally) {
    let Attempted { made, tally } = Maker::of_kernels(order, known, "", seed, &()).attempt(sets, number);
    (made, tally)
}

/// Attempts to build a game from a kernel, in one of the open forms (variations of the kernel). This function is meant
/// for kernel authors. `number` is the number of the attempt. Cost: 1 to 15 core seconds. Returns no game if the kernel
/// or form does not exist, or if the attempt fails. The returned counts state the reason.
pub fn attempt_kernel(
    order: &GameOrder,
    kernel: &str,
    is_open: impl Fn(Option<&str>) -> bool,
    seed: Seed,
    number: u32,
) -> (Option<MadeGame>, Tally) {
    let maker = Maker::of_kernels(order, &[], "", seed.into(), &());
    let seed = maker.seed.child(kernel, number.into());
    let drawn = KernelGenome::of_kernel(kernel, is_open, &BTreeSet::new(), seed.seed().child("rules", 0));
    let mut attempted = Attempted::default();
    if let Some(drawn) = drawn {
        maker.judge_in_turn(&[drawn], number, &seed, &|_| None, &mut attempted);
    }
    (attempted.made, attempted.tally)
}

/// The reason reported for a position in the order that stays empty.
pub const NO_RULES: &str = "no rules left";

/// A game maker that supports every method.
pub(super) struct Maker<'a> {
    pub(super) order: &'a GameOrder,
    pub(super) gate: GameGate<'a>,
    pub(super) seed: SeedPath,
    pub(super) progress: &'a dyn Progress,
}

impl GameSet {
    /// Returns the set, or an error if games were requested but the set is empty.
    pub(super) fn unless_empty(self, order: &GameOrder) -> Result<GameSet, GamesError> {
        match self.games.is_empty() && order.count > 0 {
            true => Err(GamesError::NoneAccepted { tally: Box::new(self.tally) }),
            false => Ok(self),
        }
    }
}

impl<'a> Maker<'a> {
    /// Creates a maker that builds games from kernels (hand-written designs). Such games are drawn at random, whatever
    /// the order's method.
    fn of_kernels(
        order: &'a GameOrder,
        known: &'a [GameForm],
        canary: &'a str,
        seed: SeedPath,
        progress: &'a dyn Progress,
    ) -> Maker<'a> {
        let gate = GameGate::new(order, Method::Constructive, known, canary);
        Maker { order, gate, seed, progress }
    }

    /// Returns the seed for one attempt at generating a set.
    pub(super) fn seed_of(&self, number: u32) -> SeedPath {
        self.seed.child("game", u64::from(number))
    }

    /// Returns the result of an attempt. Reuses the result saved by an interrupted run, if there is one. Otherwise
    /// makes the attempt and saves its result.
    pub(super) fn kept_or_made(&self, attempt: &str, make: impl FnOnce() -> Attempted) -> Attempted {
        if let Some(attempted) = self.progress.kept(attempt).and_then(Kept::restored) {
            return attempted;
        }
        let attempted = make();
        self.progress.keep(attempt, &Kept::of(&attempted));
        attempted
    }

    /// Judges the candidates one by one until one is accepted.
    pub(super) fn judge_in_turn<R: Rules>(
        &self,
        candidates: &[R],
        attempt: u32,
        seed: &SeedPath,
        objection: &dyn Fn(&Candidate) -> Option<&'static str>,
        attempted: &mut Attempted,
    ) {
        for (at, candidate) in (0..).zip(candidates) {
            let judges = seed.child("judges", at);
            attempted.made = self.gate.judge(candidate, attempt, &judges, objection, &mut attempted.tally);
            self.progress.looked();
            if attempted.made.is_some() {
                break;
            }
        }
    }

    /// Attempts to generate the game for a position, until a game is accepted.
    fn attempt(&self, sets: &RuleSets, number: u32) -> Attempted {
        let mut attempted = Attempted::default();
        let GameEffort { attempts, patience, .. } = self.order.effort;
        for attempt in 0..attempts {
            let seed = self.seed_of(number).child("attempt", u64::from(attempt));
            let turn = attempt / patience.max(1);
            let Some(set) = sets.of_place(number, turn) else {
                if attempt == 0 {
                    attempted.tally.game_rejected(NO_RULES);
                }
                break;
            };
            let drawn = sets.draw_of(set, seed.seed().child("rules", 0));
            self.judge_in_turn(&[drawn], attempt, &seed, &|_| None, &mut attempted);
            if attempted.made.is_some() {
                break;
            }
        }
        attempted
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline::tests::order;

    /// A chain of releases reaches this state once it has used up all rules.
    #[test]
    fn no_rules_are_no_games() {
        let (order, seed) = (order(), SeedPath::from(Seed::from_text("none")));
        let sets = RuleSets::draw(&[], &[], seed.seed());
        let (made, tally) = make_one(&order, &sets, &[], seed, 3);
        assert!(made.is_none());
        assert_eq!(tally.rejections.get(NO_RULES), Some(&1));
    }
}
