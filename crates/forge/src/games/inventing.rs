//! Generation of invented games by each method.

use super::apart::{FarInventions, LONG_PATIENCE};
use super::attempt::Attempted;
use super::candidate::MadeGame;
use super::make::{GameSet, GamesError, Maker};
use super::order::GameOrder;
use super::searched::REFUSED;
use super::sets::company::Company;
use crate::levels::Method;
use crate::pipeline::GameGate;
use crate::progress::Progress;
use crate::search_loop::spread;
use crate::tally::Tally;
use base::SeedPath;
use generators::invention::{Census, Invention, Verb};
use generators::{Axis, MapElites, MapElitesConfig, Variation};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::ops::Range;
use validators::novelty::GameForm;

/// The divisor for the number of quick evaluations in each archive round after the first. Another round follows if the
/// judges have rejected the elites of the last one.
const MENDING: usize = 3;
/// The maximum number of games in a round. Changing this number changes the generated games.
const ROUND: usize = 4;
/// The maximum number of attempts per requested game.
const ROUNDS: u32 = 4;
/// The number of rounds after which an archive is replaced if no elite was accepted.
const ARCHIVE_ROUNDS: u32 = 6;
/// The maximum number of elites to judge per archive round.
const ELITES: usize = 3;

/// Invents game `number` of an order. Returns no game if every attempt that the order allows fails. Prefers the
/// mechanics with the lowest use counts in the census, and keeps the game apart from known games only. Cost: several
/// core minutes per game.
pub fn invent_one(
    order: &GameOrder,
    census: &Census,
    known: &[GameForm],
    seed: SeedPath,
    number: u32,
) -> (Option<MadeGame>, Tally) {
    let gate = GameGate::new(order, order.method, known, "");
    let Attempted { made, tally } = Maker { order, gate, seed, progress: &() }.invent(census, known, number);
    (made, tally)
}

/// Invents the games of an order in rounds. Each round takes the games of all earlier rounds into account. Any two of
/// the games and the `known` games are at least [`NEAR`](validators::novelty::NEAR) apart, and no two games share a
/// title or most of their names. The games' files contain `canary`, which identifies the release in text corpora. The
/// same order, known games and seed give the same games on any number of threads. Cost: several core minutes per game,
/// on all threads of the current rayon pool.
///
/// If too few games succeed, the set contains fewer games than requested.
///
/// # Errors
/// Returns an error if games are requested but no game is accepted.
pub fn invent_games(
    order: &GameOrder,
    known: &[GameForm],
    canary: &str,
    seed: impl Into<SeedPath>,
    progress: &dyn Progress,
) -> Result<GameSet, GamesError> {
    let (seed, wanted) = (seed.into(), order.count as usize);
    let (mut company, mut set, mut census) = (Company::default(), GameSet::default(), Census::default());
    let mut known = known.to_vec();
    let (mut number, most) = (0, order.count.saturating_mul(ROUNDS));
    while set.games.len() < wanted && number < most {
        let size = (wanted - set.games.len()).clamp(1, ROUND).min((most - number) as usize) as u32;
        let numbers = number..number + size;
        number += size;
        let invent = |number: u32| {
            let gate = GameGate::new(order, order.method, &known, canary);
            let maker = Maker { order, gate, seed: seed.clone(), progress };
            maker.kept_or_made(&number.to_string(), || maker.invent(&census, &known, number))
        };
        let attempted: Vec<Attempted> = numbers.into_par_iter().map(invent).collect();
        for mut attempted in attempted {
            if let Some(game) = attempted.made.take() {
                match company.admit(&game) {
                    Err(why) => attempted.tally.taken_back(why),
                    Ok(()) => {
                        progress.made(&game.card.title);
                        census.count(game.card.origin.mechanics());
                        known.push(GameForm::of(&game.game));
                        set.games.push(game);
                    }
                }
            }
            set.tally.add(&attempted.tally);
        }
    }
    set.unless_empty(order)
}

impl Maker<'_> {
    fn invent(&self, census: &Census, known: &[GameForm], number: u32) -> Attempted {
        let seed = self.seed.seed();
        let variation = |attempt| FarInventions::new(census, known, (number, attempt), seed);
        match self.order.method {
            Method::Constructive | Method::Search => self.invent_in_attempts(variation, number),
            Method::Evolutionary => self.invent_from_archives(variation, number),
        }
    }

    /// Draws or anneals inventions until one is accepted. If a search finds no invention, the judges receive the drawn
    /// one.
    fn invent_in_attempts<'a>(&self, variation: impl Fn(u32) -> FarInventions<'a>, number: u32) -> Attempted {
        let mut attempted = Attempted::default();
        for attempt in 0..self.order.effort.attempts {
            let seed = self.seed_of(number).child("attempt", u64::from(attempt));
            let variation = variation(attempt);
            let Some(drawn) = variation.create(seed.seed().child("rules", 0)) else { continue };
            let found = match self.order.method {
                Method::Constructive => Vec::new(),
                _ => self.annealed(&variation, seed.seed().child("search", 0), &mut attempted),
            };
            let proposed = if found.is_empty() { vec![drawn] } else { found };
            self.judge_in_turn(&proposed, attempt, &seed, &|_| None, &mut attempted);
            if attempted.made.is_some() {
                break;
            }
        }
        attempted
    }

    /// Fills archives one after the other, and judges their elites, until one is accepted. Each attempt is a round in an
    /// archive. Different parts are requested for each archive.
    fn invent_from_archives<'a>(
        &self,
        variation: impl Fn(u32) -> FarInventions<'a>,
        number: u32,
    ) -> Attempted {
        let mut attempted = Attempted::default();
        let attempts = self.order.effort.attempts;
        for (archive, first) in (0..attempts).step_by(ARCHIVE_ROUNDS as usize).enumerate() {
            let rounds = first..attempts.min(first + ARCHIVE_ROUNDS);
            let seed = self.seed_of(number).child("archive", archive as u64);
            let variation = variation(archive as u32 * LONG_PATIENCE);
            attempted.made = self.invent_from_archive(&variation, &seed, rounds, &mut attempted.tally);
            if attempted.made.is_some() {
                break;
            }
        }
        attempted
    }

    /// Fills an archive with diverse inventions, and judges elites that are spread far apart in it, until one is
    /// accepted. The first round fills the archive, and later rounds refill the cells that the judges rejected.
    fn invent_from_archive(
        &self,
        variation: &FarInventions<'_>,
        seed: &SeedPath,
        rounds: Range<u32>,
        tally: &mut Tally,
    ) -> Option<MadeGame> {
        let looks = self.order.effort.looks as usize;
        let config = MapElitesConfig { initial: (looks / 2).max(1), ..MapElitesConfig::default() };
        let archive = seed.seed().child("elites", 0);
        let mut search = MapElites::new(variation, Invention::key, axes(), config, archive);
        let mut shown = BTreeSet::new();
        for round in rounds.clone() {
            let looks = if round == rounds.start { looks } else { looks.div_ceil(MENDING) };
            let effort = (looks, seed.seed().child("look", 0));
            self.search(&mut search, effort, tally, |_, _| {});
            let picked = spread(search.archive(), ELITES, &[], |_, _| false, &mut shown, Invention::key);
            for (cell, elite) in picked {
                let judges = seed.child("judges", 0).child(&elite.key().to_string(), 0);
                let made = self.gate.judge(&elite, round, &judges, &|_| None, tally);
                if made.is_some() {
                    return made;
                }
                search.demote(cell, REFUSED);
            }
        }
        None
    }
}

/// Returns the axes of an archive of inventions: the number of ports (roles of mechanics) filled by types with opposed
/// uses, the player's main activity, and the fraction of types that move by themselves. A type has opposed uses if one
/// port needs it, and another spends or removes it, or makes it a danger or an obstacle.
fn axes() -> Vec<Axis> {
    vec![
        Axis::new("coupling", (2.0, 10.0), 4),
        Axis::new("verb", (0.0, Verb::ALL.len() as f64), Verb::ALL.len()),
        Axis::new("pace", (0.0, 0.75), 3),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::games::GameEffort;
    use crate::pipeline::tests::order;
    use base::Seed;

    /// Runs one round with few quick evaluations, and with judges that accept every winnable game.
    fn invent(method: Method, threads: usize) -> (Option<String>, Tally) {
        let order = GameOrder { method, levels: 1, level_tries: 1, ..order() };
        let order =
            GameOrder { effort: GameEffort { attempts: 1, looks: 4, judges: 0, ..order.effort }, ..order };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let seed = Seed::from_text("inventions on threads").into();
        let (made, tally) = pool.install(|| invent_one(&order, &Census::default(), &[], seed, 0));
        (made.map(|made| made.text), tally)
    }

    #[test]
    fn searched_inventions_are_the_same_on_any_number_of_threads() {
        let one = invent(Method::Search, 1);
        assert_eq!((one.1.looks(), one.1.games_tried > 0), (4, true));
        assert_eq!(one, invent(Method::Search, 3));
    }

    #[test]
    fn evolved_inventions_are_the_same_on_any_number_of_threads() {
        let one = invent(Method::Evolutionary, 1);
        assert_eq!(one.1.looks(), 4);
        assert_eq!(one, invent(Method::Evolutionary, 3));
    }
}
