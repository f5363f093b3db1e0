//! Sets of games picked from archives, which a search has filled with different games.

use super::company::Company;
use super::rule_sets::{Own, SetVariation};
use crate::games::attempt::Attempted;
use crate::games::candidate::Candidate;
use crate::games::look::axes;
use crate::games::make::{GameSet, Maker, Shortfall};
use crate::games::searched::REFUSED;
use crate::search_loop::spread;
use crate::tally::Tally;
use base::Digest;
use generators::kernels::{KernelGenome, KernelVariation};
use generators::{Archive, Evaluated, MapElites, MapElitesConfig};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// The minimum number of games that are looked at in a round of an archive, and of finalists that are judged on all
/// threads.
const LEAST_OF_ROUND: usize = 4;

/// The number of consecutive rejections after which an archive is given up: the remaining games seldom pass.
const DRY: usize = 48;

/// A set that is being filled.
struct Filling {
    set: GameSet,
    company: Company,
    /// The keys of the games that have been judged.
    shown: BTreeSet<Digest>,
    /// The number of rounds so far, over all archives.
    rounds: u32,
}

impl Maker<'_> {
    /// Fills archives, one after the other, until enough games are accepted, all rounds are used, or an archive has
    /// yielded no game. With its own sets of rules, there is only one archive, which is never given up.
    pub(crate) fn make_from_archives(&self, own: Option<Own<'_>>) -> GameSet {
        let dry = if own.is_some() { usize::MAX } else { DRY };
        let variation = SetVariation { variation: KernelVariation::new(&self.order.kinds), own };
        let (set, company) = (GameSet::default(), Company::of(self.order));
        let mut filling = Filling { set, company, shown: BTreeSet::new(), rounds: 0 };
        let wanted = self.order.count as usize;
        for number in 0.. {
            let before = filling.set.games.len();
            self.fill_archive(number, &variation, dry, &mut filling);
            let made = filling.set.games.len();
            if made == wanted || made == before || filling.rounds == self.order.effort.attempts {
                break;
            }
        }
        let Filling { mut set, company, .. } = filling;
        set.end(&company, wanted, Shortfall::Attempts);
        set
    }

    /// Fills archive `number` with different games, and picks games that lie far apart in it, until enough are
    /// accepted, all rounds are used, or `most_dry` games in a row are rejected. A round counts as at least
    /// [`LEAST_OF_ROUND`] rejections.
    fn fill_archive(
        &self,
        number: u64,
        variation: &SetVariation<'_>,
        most_dry: usize,
        filling: &mut Filling,
    ) {
        let Filling { set, company, shown, rounds } = filling;
        let wanted = self.order.count as usize;
        let of_game = self.order.effort.looks as usize;
        let initial = of_game * (wanted - set.games.len());
        let config = MapElitesConfig { initial: (initial / 3).max(1), ..MapElitesConfig::default() };
        let seed = self.seed.seed().child("archive", number);
        let mut search = MapElites::new(variation, KernelGenome::key, axes(), config, seed);
        let (first, mut dry) = (*rounds, 0);
        while set.games.len() < wanted && *rounds < self.order.effort.attempts && dry < most_dry {
            // The first round fills the archive; the others refill the cells that the judges rejected.
            let missing = wanted - set.games.len();
            let looks = if *rounds == first { initial } else { (of_game * missing / 4).max(LEAST_OF_ROUND) };
            // Games that have no place in the set are neither bred from nor looked at.
            let has_place = |genome: &KernelGenome| company.has_place_for(genome);
            search.retain(has_place);
            let effort = (looks, self.seed.seed().child("look", 0));
            self.search(&mut search, effort, has_place, &mut set.tally, |_, _| {});
            let is_near = |one: &KernelGenome, other: &KernelGenome| one.kernel() == other.kernel();
            let wanted_now = missing.max(LEAST_OF_ROUND);
            let key = KernelGenome::key;
            let elites = spread(search.archive(), wanted_now, &[], is_near, shown, key);
            let others = nearly_feasible(search.archive(), wanted_now - elites.len(), &elites, shown);
            let elites = elites.into_iter().map(|(cell, genome)| (Some(cell), genome));
            let picked: Vec<_> = elites.chain(others.into_iter().map(|genome| (None, genome))).collect();
            let objection = |candidate: &Candidate| company.objection(candidate);
            let judge = |(cell, genome): &(Option<usize>, KernelGenome)| {
                let key = genome.key().to_string();
                let seed = self.seed.child("judges", 0).child(&key, 0);
                let judged = self.kept_or_made(&format!("{rounds}-{key}"), || {
                    let mut tally = Tally::default();
                    let made = self.gate.judge(genome, *rounds, &seed, &objection, &mut tally);
                    Attempted { made, tally }
                });
                self.progress.looked();
                (*cell, judged.made, judged.tally)
            };
            let judged: Vec<_> = picked.par_iter().map(judge).collect();
            dry += judged.len().max(LEAST_OF_ROUND);
            for (cell, made, mut tally) in judged {
                match made.map(|made| company.admit(&made).map(|()| made)) {
                    Some(Ok(_)) if set.games.len() == wanted => tally.taken_back("more than asked for"),
                    Some(Ok(made)) => {
                        self.progress.made(&made.card.title);
                        set.games.push(made);
                        dry = 0;
                    }
                    Some(Err(why)) => tally.taken_back(why),
                    None => cell.into_iter().for_each(|cell| search.demote(cell, REFUSED)),
                }
                set.tally.add(&tally);
            }
            *rounds += 1;
        }
    }
}

/// Returns games of kernels of which no game was picked: for each kernel, the least infeasible game that has not been
/// judged. The players of a look are weak and cannot win games of some kernels.
fn nearly_feasible(
    archive: &Archive<KernelGenome>,
    wanted: usize,
    picked: &[(usize, KernelGenome)],
    shown: &mut BTreeSet<Digest>,
) -> Vec<KernelGenome> {
    let mut left: Vec<&Evaluated<KernelGenome>> = archive.pockets().flat_map(|(_, pocket)| pocket).collect();
    let is_new = |judged: &&Evaluated<KernelGenome>| !shown.contains(&judged.candidate.key());
    left.retain(|judged| judged.evaluation.feasibility > 0.0 && is_new(judged));
    left.sort_by(|one, other| other.evaluation.feasibility.total_cmp(&one.evaluation.feasibility));
    let mut kernels: BTreeSet<&str> = picked.iter().map(|(_, genome)| genome.kernel()).collect();
    let first = left.into_iter().filter(|judged| kernels.insert(judged.candidate.kernel()));
    let nearly: Vec<_> = first.take(wanted).map(|judged| judged.candidate.clone()).collect();
    shown.extend(nearly.iter().map(KernelGenome::key));
    nearly
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::games::{GameEffort, GameOrder, GamesError, make_games};
    use crate::levels::Method;
    use crate::pipeline::tests::order;
    use base::Seed;
    use generators::Evaluation;
    use generators::games::Kind;

    #[test]
    fn kernels_without_an_elite_send_their_least_infeasible() {
        let seed = Seed::from_text("pockets");
        let draws = |kind: Kind| {
            (0..).map(move |draw| KernelGenome::draw(&[kind], seed.child("draw", draw)).unwrap())
        };
        let of_kernel = |kind: Kind| {
            let first = draws(kind).next().unwrap();
            draws(kind).filter(move |genome| genome.kernel() == first.kernel()).take(3)
        };
        let mut archive = Archive::new(axes(), 4);
        let mut expected = None;
        for (kind, feasibilities) in [(Kind::Lure, [0.5, 0.75, 0.25]), (Kind::Rescue, [1.0, 0.9, 0.0])] {
            for (genome, feasibility) in of_kernel(kind).zip(feasibilities) {
                if feasibility == 0.75 {
                    expected = Some(genome.key());
                }
                archive.add(genome, Evaluation { feasibility, objective: 0.5, measures: vec![0.0; 3] });
            }
        }
        let elites: Vec<_> = archive.elites().map(|(cell, elite)| (cell, elite.candidate.clone())).collect();
        let mut shown = BTreeSet::new();
        let keys =
            |genomes: Vec<KernelGenome>| genomes.iter().map(|genome| Some(genome.key())).collect::<Vec<_>>();
        assert_eq!(keys(nearly_feasible(&archive, 4, &elites, &mut shown)), [expected]);
        assert_eq!(nearly_feasible(&archive, 0, &elites, &mut shown).len(), 0);
        assert_eq!(
            nearly_feasible(&archive, 4, &[], &mut shown).len(),
            2,
            "what has been shown is not shown again"
        );
    }

    /// There are only as many rounds as it takes to judge [`DRY`] games, and only one archive.
    #[test]
    fn a_dry_archive_is_given_up() {
        let looks = 12;
        let order = GameOrder { method: Method::Evolutionary, least_interactions: usize::MAX, ..order() };
        let order = GameOrder { effort: GameEffort { attempts: 1000, looks, ..order.effort }, ..order };
        let made = make_games(&order, &[], "", Seed::from_text("dry"), &());
        let Err(GamesError::NoneAccepted { tally }) = made else { panic!("{made:?}") };
        let (first, rounds) = (u64::from(looks), (DRY / LEAST_OF_ROUND) as u64);
        assert_eq!(tally.looks(), first + (rounds - 1) * LEAST_OF_ROUND as u64);
    }
}
