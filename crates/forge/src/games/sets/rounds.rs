//! Sets of games that are made one by one in short rounds. Each round knows the games of all earlier rounds.

use super::company::{Company, Families};
use crate::games::attempt::Attempted;
use crate::games::candidate::Candidate;
use crate::games::make::{GameSet, Maker};
use generators::kernels::{KernelGenome, Turns};
use rayon::prelude::*;
use std::slice;

/// The minimum and maximum number of attempts in a round. The resulting bytes depend on these numbers.
const ROUND: (usize, usize) = (8, 24);

/// The number of attempts by which a kernel is postponed for each of its games. Kernels differ in how often they pass,
/// so waiting for a kernel must come to an end.
const TRIES_PER_GAME: u32 = 16;

/// A kernel and its record.
struct Fared {
    kernel: &'static str,
    /// The number of attempts since the kernel's last admitted game.
    tries: u32,
}

/// An attempt of a round.
pub(crate) struct Turn {
    /// The number of the attempt in the set.
    pub(crate) number: u32,
    /// The game that is attempted.
    pub(crate) drawn: KernelGenome,
}

/// The kernels in the order of their turns.
struct Ledger(Vec<Fared>);

impl Ledger {
    /// Plans a round. Kernels with the fewest games and attempts come first, no kernel occurs twice while others are
    /// left, and each game has a different scene if possible.
    fn plan(&mut self, maker: &Maker<'_>, company: &Company, size: usize, first: u32) -> Vec<Turn> {
        let mut families = company.families.clone();
        let mut scenes = company.scenes.clone();
        let mut turns = Vec::new();
        for number in (first..).take(size) {
            let Some(at) = self.next(&families) else { break };
            let fared = &mut self.0[at];
            let seed = maker.seed_of(number);
            let rules = seed.seed().child("rules", 0);
            let drawn = KernelGenome::of_kernel(fared.kernel, |_| true, &scenes, rules);
            fared.tries += 1;
            let Some(drawn) = drawn else { continue };
            scenes.insert(drawn.scene().to_owned());
            families.count(fared.kernel);
            turns.push(Turn { number, drawn });
        }
        turns
    }

    /// Returns the index of the kernel to try next; `None` if there are no kernels.
    fn next(&self, families: &Families) -> Option<usize> {
        let late = |fared: &Fared| fared.tries + TRIES_PER_GAME * families.games_of(fared.kernel) as u32;
        self.0.iter().enumerate().min_by_key(|(_, fared)| late(fared)).map(|(at, _)| at)
    }

    fn note_game(&mut self, kernel: &str) {
        for fared in self.0.iter_mut().filter(|fared| fared.kernel == kernel) {
            fared.tries = 0;
        }
    }
}

impl Maker<'_> {
    /// Makes short rounds of attempts on all threads, until there are enough games, no room for more games, or no
    /// attempts left.
    pub(crate) fn make_in_rounds(&self) -> GameSet {
        let (order, wanted) = (self.order, self.order.count as usize);
        let mut company = Company::default();
        let mut set = GameSet::default();
        let fared = |(kernel, _)| Fared { kernel, tries: 0 };
        let mut ledger =
            Ledger(Turns::draw(&self.order.kinds, self.seed.seed()).kernels().map(fared).collect());
        let (mut number, most) = (0, order.count.saturating_mul(order.effort.attempts));
        while set.games.len() < wanted && number < most {
            let size = (wanted - set.games.len()).clamp(ROUND.0, ROUND.1).min((most - number) as usize);
            let turns = ledger.plan(self, &company, size, number);
            if turns.is_empty() {
                break;
            }
            number += size as u32;
            let attempted: Vec<Attempted> = turns
                .par_iter()
                .map(|turn| self.kept_or_made(&turn.number.to_string(), || self.make_in_turn(turn, &company)))
                .collect();
            for (turn, mut attempted) in turns.iter().zip(attempted) {
                if let Some(game) = attempted.made.take() {
                    match company.admit(&game) {
                        _ if set.games.len() == wanted => attempted.tally.taken_back("more than asked for"),
                        Err(why) => attempted.tally.taken_back(why),
                        Ok(()) => {
                            self.progress.made(&game.card.title);
                            ledger.note_game(turn.drawn.kernel());
                            set.games.push(game);
                        }
                    }
                }
                set.tally.add(&attempted.tally);
            }
        }
        set
    }

    /// Makes one attempt of a round.
    fn make_in_turn(&self, turn: &Turn, company: &Company) -> Attempted {
        let mut attempted = Attempted::default();
        let seed = self.seed_of(turn.number);
        let (drawn, objection) =
            (slice::from_ref(&turn.drawn), |candidate: &Candidate| company.objection(candidate));
        self.judge_in_turn(drawn, turn.number, &seed, &objection, &mut attempted);
        attempted
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn kernels_without_a_game_come_first_but_not_for_ever() {
        let fared = |kernel| Fared { kernel, tries: 0 };
        let mut ledger = Ledger(["one-pull", "one-spark"].map(fared).into());
        let mut families = Families::default();
        families.count("one-pull");
        let mut tried = BTreeMap::new();
        for _ in 0..40 {
            let at = ledger.next(&families).unwrap();
            let fared = &mut ledger.0[at];
            fared.tries += 1;
            *tried.entry(fared.kernel).or_insert(0) += 1;
        }
        assert_eq!(tried, BTreeMap::from([("one-pull", 12), ("one-spark", 28)]));
    }
}
