//! Sets whose games are picked from archives that a search for games that differ has filled.

use super::candidate::Candidate;
use super::company::Company;
use super::look::{Looker, axes};
use super::make::{Attempted, GameSet, Maker, Shortfall, path};
use super::rule_sets::{Own, SetVariation};
use crate::search_loop::{run_search, spread};
use crate::tally::{LOOK, Tally};
use engine::Digest;
use generators::kernels::{KernelGenome, KernelVariation};
use generators::{MapElites, MapElitesConfig};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// The least number of games that are looked at in a round of an archive, and of finalists that are judged on all threads.
const LEAST_OF_ROUND: usize = 4;

/// Games judged in a row, none of them accepted, after which an archive is given up: what is left of it seldom passes.
const DRY: usize = 48;

/// The feasibility of a game that a look took for feasible and the last judges did not.
const REFUSED: f64 = 0.95;

/// A set that is being filled.
struct Filling {
    set: GameSet,
    company: Company,
    /// The keys of the games that were judged.
    shown: BTreeSet<Digest>,
    /// The number of rounds so far, of all archives.
    rounds: u32,
}

impl Maker<'_> {
    /// Fills archives, one after the other, until enough games are accepted, all rounds are spent, or an archive has made nothing.
    /// With sets of rules of its own there is one archive, which is never given up.
    pub(super) fn evolved(&self, own: Option<Own<'_>>) -> GameSet {
        let dry = if own.is_some() { usize::MAX } else { DRY };
        let variation = SetVariation { variation: KernelVariation::new(&self.order.kinds), own };
        let (set, company) = (GameSet::default(), Company::of(self.order));
        let mut filling = Filling { set, company, shown: BTreeSet::new(), rounds: 0 };
        let wanted = self.order.count as usize;
        for number in 0.. {
            let before = filling.set.games.len();
            self.archive(number, &variation, dry, &mut filling);
            let made = filling.set.games.len();
            if made == wanted || made == before || filling.rounds == self.order.effort.attempts {
                break;
            }
        }
        let Filling { mut set, company, .. } = filling;
        set.end(&company, wanted, Shortfall::Attempts);
        set
    }

    /// Fills the archive of a number with games that differ, and picks games that lie far apart in it until enough are accepted, all
    /// rounds are spent, or so many judged in a row are refused; a round counts as [`LEAST_OF_ROUND`] of them at least.
    fn archive(&self, number: u64, variation: &SetVariation<'_>, most_dry: usize, filling: &mut Filling) {
        let Filling { set, company, shown, rounds } = filling;
        let wanted = self.order.count as usize;
        let looker = Looker::new(self.seed.child("look", 0));
        let of_game = self.order.effort.looks as usize;
        let initial = of_game * (wanted - set.games.len());
        let config = MapElitesConfig { initial: (initial / 3).max(1), ..MapElitesConfig::default() };
        let seed = self.seed.child("archive", number);
        let mut search = MapElites::new(variation, KernelGenome::key, axes(), config, seed);
        let (first, mut dry) = (*rounds, 0);
        while set.games.len() < wanted && *rounds < self.order.effort.attempts && dry < most_dry {
            // The first round fills the archive, the others mend it where the judges said no.
            let missing = wanted - set.games.len();
            let looks = if *rounds == first { initial } else { (of_game * missing / 4).max(LEAST_OF_ROUND) };
            let look = |genome: &KernelGenome| {
                self.progress.looked();
                looker.look(genome)
            };
            run_search(&mut search, (looks, self.order.effort.batch), look, |_, look| {
                set.looks += 1;
                set.tally.judge(LOOK, look.evaluation.is_feasible(), look.calls);
                look.evaluation
            });
            let is_welcome = |genome: &KernelGenome| {
                company.room.has_room(genome.kernel(), genome.kind().name())
                    && company.room.is_open(genome.kernel(), genome.form())
            };
            let is_near = |one: &KernelGenome, other: &KernelGenome| one.kernel() == other.kernel();
            let wanted_now = missing.max(LEAST_OF_ROUND);
            let key = KernelGenome::key;
            let picked = spread(search.archive(), wanted_now, &[], is_near, is_welcome, shown, key);
            let objection = |candidate: &Candidate| company.objection(candidate);
            let judge = |(cell, genome): &(usize, KernelGenome)| {
                let key = genome.key().to_string();
                let seed = self.seed.child("judges", 0).child(&key, 0);
                let judged = self.once(&format!("{rounds}-{key}"), || {
                    let mut tally = Tally::default();
                    let mut made = self.gate.judge(genome, *rounds, seed, &objection, &mut tally);
                    if let Some(made) = &mut made {
                        made.path = path([("judges", 0), (&key, 0)]);
                    }
                    Attempted { made, tally, looks: 0 }
                });
                self.progress.looked();
                (*cell, judged.made, judged.tally)
            };
            let judged: Vec<_> = picked.par_iter().map(judge).collect();
            dry += judged.len().max(LEAST_OF_ROUND);
            for (cell, made, mut tally) in judged {
                match made.map(|made| company.welcome(&made).map(|()| made)) {
                    Some(Ok(_)) if set.games.len() == wanted => tally.taken_back("more than asked for"),
                    Some(Ok(made)) => {
                        self.progress.made(&made.card.title);
                        set.games.push(made);
                        dry = 0;
                    }
                    Some(Err(why)) => tally.taken_back(why),
                    None => search.demote(cell, REFUSED),
                }
                set.tally.add(&tally);
            }
            *rounds += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::games::gate::tests::order;
    use crate::games::{GameEffort, GameOrder, GamesError, make_games};
    use crate::levels::Method;
    use engine::Seed;

    /// As many rounds as it takes to judge [`DRY`] games, not all that there are; one archive, not one after the other.
    #[test]
    fn a_dry_archive_is_given_up() {
        let looks = 12;
        let order = GameOrder { method: Method::Evolutionary, least_interactions: usize::MAX, ..order() };
        let order = GameOrder { effort: GameEffort { attempts: 1000, looks, ..order.effort }, ..order };
        let made = make_games(&order, &[], "", Seed::from_text("dry"), &());
        let Err(GamesError::NoneAccepted { looks: spent, .. }) = made else { panic!("{made:?}") };
        let (first, rounds) = (u64::from(looks), (DRY / LEAST_OF_ROUND) as u64);
        assert_eq!(spent, first + (rounds - 1) * LEAST_OF_ROUND as u64);
    }
}
