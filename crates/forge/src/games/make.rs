//! The making of games by each method.

use super::attempt::Attempted;
use super::candidate::MadeGame;
use super::kept::Kept;
use super::order::{GameEffort, GameOrder};
use crate::games::sets::company::{CROWDED, Company};
use crate::games::sets::rule_sets::{RuleSets, SetVariation};
use crate::levels::Method;
use crate::pipeline::GameGate;
use crate::progress::Progress;
use crate::tally::Tally;
use base::{Seed, SeedPath};
use generators::kernels::KernelGenome;
use std::collections::BTreeSet;
use validators::novelty::GameForm;

/// The games of an order.
#[derive(Clone, Debug, Default)]
pub struct GameSet {
    /// The games that could be made, ordered by number.
    pub games: Vec<MadeGame>,
    /// The candidates that were tried, and the reasons why some failed.
    pub tally: Tally,
    /// The reason why there are fewer games than ordered.
    pub shortfall: Option<Shortfall>,
}

/// A reason why there are fewer games than ordered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shortfall {
    /// All attempts have been used.
    Attempts,
    /// Every kernel has its maximum number of games or belongs to a kind that has: more games would be too similar.
    Room,
}

/// The errors of making games.
#[derive(Debug, thiserror::Error)]
pub enum GamesError {
    /// No candidate passed.
    #[error(
        "no game was accepted of {looks} that were looked at and {} that were judged: {}", .tally.games_tried, .tally.reasons(), looks = .tally.looks()
    )]
    NoneAccepted {
        /// The number of candidates that a search looked at and that reached the final judges, and the reasons why they
        /// failed.
        tally: Box<Tally>,
    },
}

/// Makes the games of an order. No game is nearer than [`NEAR`](validators::novelty::NEAR) to another one or to a
/// `known` game, and no two share a title or most of their names. Each kernel has one game before any kernel has two,
/// and at most three of twenty games are of one kind. `canary` marks their files. Cost: 20 to 30 seconds of one core
/// per game, on all threads of the current rayon pool. The same order, known games and seed give the same games on any
/// number of threads.
///
/// Games that could not be made are missing from the set.
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
    let gate = GameGate::new(order, known, canary);
    let maker = Maker { order, gate, seed: seed.into(), progress };
    let set = match order.method {
        Method::Constructive | Method::Search => maker.make_in_rounds(),
        Method::Evolutionary => maker.make_from_archives(None),
    };
    set.unless_empty(order)
}

/// Makes game `number` of an order, from the [rules](RuleSets) that are assigned to it and independently of the order's
/// other games: it only has to differ from known games. Returns `None` for the game if it cannot be made. The cost and
/// the inputs that decide the result are those of one game of [`make_games`].
pub fn make_one(
    order: &GameOrder,
    sets: &RuleSets,
    known: &[GameForm],
    seed: SeedPath,
    number: u32,
) -> (Option<MadeGame>, Tally) {
    let maker = Maker { order, gate: GameGate::new(order, known, ""), seed, progress: &() };
    let Attempted { made, tally, .. } = maker.attempt(sets, number);
    (made, tally)
}

/// Attempts to make a game of a kernel, in one of the open forms, for authors of kernels; `number` is the number of the
/// attempt. Cost: one to 15 seconds of one core. Returns no game if there is no such kernel or form, or if the attempt
/// fails for a reason in the tally.
pub fn attempt_kernel(
    order: &GameOrder,
    kernel: &str,
    is_open: impl Fn(Option<&str>) -> bool,
    seed: Seed,
    number: u32,
) -> (Option<MadeGame>, Tally) {
    let maker = Maker { order, gate: GameGate::new(order, &[], ""), seed: seed.into(), progress: &() };
    let seed = maker.seed.child(kernel, number.into());
    let drawn = KernelGenome::of_kernel(kernel, is_open, &BTreeSet::new(), seed.seed().child("rules", 0));
    let mut attempted = Attempted::default();
    if let Some(drawn) = drawn {
        let variation = SetVariation::of_kind_of(&drawn, None);
        maker.judge_proposed((drawn, &variation), number, &seed, &|_| None, &mut attempted);
    }
    (attempted.made, attempted.tally)
}

/// Makes the games of archive `number`, from the [rules](RuleSets) that are assigned to it; in all other
/// respects, like [`make_games`].
///
/// # Errors
/// Returns the errors of [`make_games`].
pub fn make_archive(
    order: &GameOrder,
    sets: &RuleSets,
    known: &[GameForm],
    seed: SeedPath,
    number: u32,
) -> Result<GameSet, GamesError> {
    let maker = Maker { order, gate: GameGate::new(order, known, ""), seed, progress: &() };
    maker.make_from_archives(Some((sets, sets.of_archive(number)))).unless_empty(order)
}

/// The reason recorded for a place that stays empty because there are no rules left.
pub const NO_RULES: &str = "no rules left";

/// A maker of games by any of the methods.
pub(super) struct Maker<'a> {
    pub(super) order: &'a GameOrder,
    pub(super) gate: GameGate<'a>,
    pub(super) seed: SeedPath,
    pub(super) progress: &'a dyn Progress,
}

impl GameSet {
    /// Returns the set, or an error if it is empty although games were ordered.
    pub(super) fn unless_empty(self, order: &GameOrder) -> Result<GameSet, GamesError> {
        match self.games.is_empty() && order.count > 0 {
            true => Err(GamesError::NoneAccepted { tally: Box::new(self.tally) }),
            false => Ok(self),
        }
    }

    /// Completes the set: if there are fewer games than wanted, removes games of crowded kinds.
    pub(super) fn end(&mut self, company: &Company, wanted: usize, shortfall: Shortfall) {
        if self.games.len() < wanted {
            self.shortfall = Some(shortfall);
            for _ in 0..company.thin(&mut self.games) {
                self.tally.taken_back(CROWDED);
            }
        }
    }
}

impl<'a> Maker<'a> {
    /// Returns the seed for game `number`.
    pub(super) fn seed_of(&self, number: u32) -> SeedPath {
        self.seed.child("game", u64::from(number))
    }

    /// Returns the result of an attempt: the one kept by an interrupted run, or else a new one, which is then kept.
    pub(super) fn kept_or_made(&self, attempt: &str, make: impl FnOnce() -> Attempted) -> Attempted {
        if let Some(attempted) = self.progress.kept(attempt).and_then(Kept::restored) {
            return attempted;
        }
        let attempted = make();
        self.progress.keep(attempt, &Kept::of(&attempted));
        attempted
    }

    /// Makes attempts at the game for a place until one is accepted.
    fn attempt(&self, sets: &RuleSets, number: u32) -> Attempted {
        let mut attempted = Attempted::default();
        let GameEffort { attempts, patience, .. } = self.order.effort;
        for attempt in 0..attempts {
            let seed = self.seed_of(number).child("attempt", u64::from(attempt));
            let turn = attempt / patience.max(1);
            let Some(set) = sets.of_place(self.order.method, number, turn) else {
                if attempt == 0 {
                    attempted.tally.game_rejected(NO_RULES);
                }
                break;
            };
            let drawn = sets.draw_of(set, seed.seed().child("rules", 0));
            let variation = SetVariation::of_kind_of(&drawn, Some((sets, vec![set])));
            let drawn = (drawn, &variation);
            self.judge_proposed(drawn, attempt, &seed, &|_| None, &mut attempted);
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
    use crate::games::GameEffort;
    use crate::pipeline::tests::order;
    use generators::games::Kind;

    /// Makes few attempts at a game by looking at others, with the same result on any number of threads.
    #[track_caller]
    fn check(method: Method) {
        let order = GameOrder { method, kinds: vec![Kind::KeyAndDoor], ..order() };
        let order = GameOrder { effort: GameEffort { attempts: 4, looks: 6, ..order.effort }, ..order };
        let made_by = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let set =
                pool.install(|| make_games(&order, &[], "", Seed::from_text("two threads"), &())).unwrap();
            let game = |made: &MadeGame| (made.text.clone(), made.witnesses.clone(), made.seed.clone());
            (set.games.iter().map(game).collect::<Vec<_>>(), set.tally.looks(), set.tally)
        };
        let one = made_by(1);
        assert!(one.0.len() == 1 && one.1 >= 6, "{} games of {} looks", one.0.len(), one.1);
        assert_eq!(one, made_by(3));
    }

    #[test]
    fn searched_games_are_the_same_on_any_number_of_threads() {
        check(Method::Search);
    }

    #[test]
    fn evolved_games_are_the_same_on_any_number_of_threads() {
        check(Method::Evolutionary);
    }

    /// This is the situation at the end of a chain of releases that has used up all rules.
    #[test]
    fn no_rules_are_no_games() {
        let (order, seed) = (order(), SeedPath::from(Seed::from_text("none")));
        let sets = RuleSets::draw(&[], true, &[], seed.seed());
        let (made, tally) = make_one(&order, &sets, &[], seed.clone(), 3);
        assert!(made.is_none());
        assert_eq!(tally.rejections.get(NO_RULES), Some(&1));
        let order = GameOrder { method: Method::Evolutionary, ..order };
        let archive = make_archive(&order, &sets, &[], seed, 3);
        assert!(matches!(archive, Err(GamesError::NoneAccepted { .. })));
    }
}
