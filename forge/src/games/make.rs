//! The making of games by each method.

use super::candidate::{MadeGame, Step};
use super::cast::Cast;
use super::gate::{GameGate, NEAR_KNOWN};
use super::look::{Looker, axes};
use super::order::GameOrder;
use crate::levels::Method;
use crate::search_loop::{Finalists, run_search, spread};
use crate::tally::Tally;
use engine::Seed;
use generators::games::Kind;
use generators::kernels::{KernelGenome, KernelVariation, Turns};
use generators::{Annealing, AnnealingConfig, MapElites, MapElitesConfig};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use validators::CriteriaError;
use validators::novelty::GameForm;

/// The games of an order.
#[derive(Clone, Debug)]
pub struct GameSet {
    /// The games that could be made, in the order of their numbers.
    pub games: Vec<MadeGame>,
    /// The candidates that were tried, and why the others failed.
    pub tally: Tally,
    /// Games that a search looked at.
    pub looks: u64,
}

/// The reasons why no game was made.
#[derive(Debug, thiserror::Error)]
pub enum GamesError {
    /// The criteria are not sensible.
    #[error("the criteria: {0}")]
    Criteria(#[from] CriteriaError),
    /// No candidate passed.
    #[error(
        "no game was accepted of {looks} that were looked at and {} that were judged: {}", .tally.games_tried, .tally.reasons()
    )]
    NoneAccepted {
        /// Candidates that a search looked at.
        looks: u64,
        /// Candidates before the last judges, and their obstacles.
        tally: Box<Tally>,
    },
}

/// Told how the making goes; from several threads.
pub trait Progress: Sync {
    /// A game was looked at, or judged.
    fn looked(&self) {}
    /// A game is accepted.
    fn made(&self, _title: &str) {}
}

impl Progress for () {}

/// Makes the games of an order; no two of them, and none of them and a `known` game, are nearer than
/// [`NEAR`](validators::novelty::NEAR), no two have a title or most of their names in common, each kernel has one game before any has two, and three of twenty are of one kind. `canary` marks their files. Cost: some ten seconds of one core a game, on all threads
/// of the current rayon pool. The same order, known games and seed give the same games on any number of threads.
///
/// Games that could not be made are missing in the set.
///
/// # Errors
/// The criteria are not sensible, or not one game was accepted.
pub fn make_games(
    order: &GameOrder,
    known: &[GameForm],
    canary: &str,
    seed: Seed,
    progress: &dyn Progress,
) -> Result<GameSet, GamesError> {
    order.check()?;
    let gate = GameGate::new(order, known, canary);
    let maker = Maker::new(order, gate, seed, progress);
    let set = match order.method {
        Method::Constructive | Method::Search => maker.one_by_one(),
        Method::Evolutionary => maker.evolved(),
    };
    if set.games.is_empty() && order.count > 0 {
        return Err(GamesError::NoneAccepted { looks: set.looks, tally: Box::new(set.tally) });
    }
    Ok(set)
}

/// The game of this number of an order that is made one by one, if it can be made, whatever the others are like: known games
/// only are kept apart from. Cost, and what decides it: as of [`make_games`].
pub fn make_one(
    order: &GameOrder,
    known: &[GameForm],
    canary: &str,
    seed: Seed,
    number: u32,
) -> (Option<MadeGame>, Tally) {
    let maker = Maker::new(order, GameGate::new(order, known, canary), seed, &());
    let Attempted { made, tally, .. } = maker.attempt(number, 0, &Company::of(order));
    (made.map(|(game, _)| game), tally)
}

/// The least number of games that are looked at in a round of an archive, and of finalists that are judged on all threads.
const LEAST_OF_ROUND: usize = 4;

struct Maker<'a> {
    order: &'a GameOrder,
    gate: GameGate<'a>,
    seed: Seed,
    turns: Turns,
    progress: &'a dyn Progress,
}

/// The result of the attempts for one game.
struct Attempted {
    /// The game, and the attempt after the one that it comes from.
    made: Option<(MadeGame, u32)>,
    tally: Tally,
    looks: u64,
}

impl<'a> Maker<'a> {
    fn new(order: &'a GameOrder, gate: GameGate<'a>, seed: Seed, progress: &'a dyn Progress) -> Maker<'a> {
        Maker { order, gate, seed, turns: Turns::draw(&order.kinds, seed), progress }
    }

    /// Each game by itself; one that is near to earlier ones, or of a crowded kind, makes way for the next of its place.
    fn one_by_one(&self) -> GameSet {
        let mut company = Company::of(self.order);
        let mut set = GameSet { games: Vec::new(), tally: Tally::default(), looks: 0 };
        let mut games = BTreeMap::new();
        let mut open: Vec<(u32, u32)> = (0..self.order.count).map(|number| (number, 0)).collect();
        while !open.is_empty() {
            let attempt = |&(number, from): &(u32, u32)| (number, self.attempt(number, from, &company));
            let attempted: Vec<(u32, Attempted)> = open.par_iter().map(attempt).collect();
            open.clear();
            for (number, mut attempted) in attempted {
                if let Some((game, next)) = attempted.made {
                    match company.welcome(&game) {
                        Ok(()) => drop(games.insert(number, game)),
                        Err(why) => {
                            attempted.tally.taken_back(why);
                            open.push((number, next));
                        }
                    }
                }
                set.tally.add(&attempted.tally);
                set.looks += attempted.looks;
            }
        }
        set.games = games.into_values().collect();
        set
    }

    /// Attempts from one on, until a game is accepted; none at kernels and kinds of which there are enough.
    fn attempt(&self, number: u32, from: u32, company: &Company) -> Attempted {
        let mut attempted = Attempted { made: None, tally: Tally::default(), looks: 0 };
        let seed = self.seed.child("game", u64::from(number));
        for attempt in from..self.order.effort.attempts {
            let seed = seed.child("attempt", u64::from(attempt));
            let patience = self.order.effort.patience.max(1);
            let passes = attempt / patience;
            let drawn = KernelGenome::in_turn(&self.turns, number, passes, seed.child("rules", 0));
            let Some(drawn) = drawn else { break };
            if !company.has_room(drawn.kernel(), drawn.form(), drawn.kind().name()) {
                continue;
            }
            let proposed = match self.order.method {
                Method::Constructive if (attempt + 1) % patience == 0 => vec![drawn],
                Method::Constructive => self.promising(drawn, seed, &mut attempted),
                _ => self.searched(&drawn, seed.child("search", 0), &mut attempted),
            };
            if proposed.is_empty() {
                attempted.tally.game_rejected("look");
            }
            for (at, genome) in (0..).zip(&proposed) {
                let seed = seed.child("judges", at);
                let made = self.gate.judge(genome, attempt, seed, &company.forms, &mut attempted.tally);
                self.progress.looked();
                if let Some(mut made) = made {
                    self.progress.made(&made.card.title);
                    made.path = path([("game", number.into()), ("attempt", attempt.into()), ("judges", at)]);
                    attempted.made = Some((made, attempt + 1));
                    return attempted;
                }
            }
        }
        attempted
    }

    /// The game, if a look at it promises something: the judges cost many looks. The last game of a kernel before its turn
    /// passes is judged in any case, since some are beyond the players of a look.
    fn promising(&self, drawn: KernelGenome, seed: Seed, attempted: &mut Attempted) -> Vec<KernelGenome> {
        self.progress.looked();
        let look = Looker::new(seed.child("look", 0)).look(&drawn);
        attempted.note(&look);
        if look.is_promising { vec![drawn] } else { Vec::new() }
    }

    /// The best games of a search that starts from games of the same kind.
    fn searched(&self, drawn: &KernelGenome, seed: Seed, attempted: &mut Attempted) -> Vec<KernelGenome> {
        let variation = KernelVariation::new(&[drawn.kind()]);
        let looks = self.order.effort.looks as usize;
        let looker = Looker::new(seed.child("look", 0));
        let config = AnnealingConfig { starts: looks / 3, ..AnnealingConfig::of(looks) };
        let mut search = Annealing::new(&variation, config, seed.child("annealing", 0));
        let mut best = Finalists::new();
        let look = |genome: &KernelGenome| {
            self.progress.looked();
            looker.look(genome)
        };
        run_search(&mut search, (looks, self.order.effort.batch), look, |genome, look| {
            attempted.note(&look);
            best.note(genome, genome.key(), &look.evaluation);
            look.evaluation
        });
        best.into_candidates().collect()
    }

    /// Fills an archive of games that differ, and picks games that lie far apart in it until enough are accepted.
    fn evolved(&self) -> GameSet {
        let looker = Looker::new(self.seed.child("look", 0));
        let variation = KernelVariation::new(&self.order.kinds);
        let wanted = self.order.count as usize;
        let looks = self.order.effort.looks as usize * wanted;
        let config = MapElitesConfig { initial: (looks / 3).max(1), ..MapElitesConfig::default() };
        let mut search =
            MapElites::new(&variation, KernelGenome::key, axes(), config, self.seed.child("archive", 0));
        let mut company = Company::of(self.order);
        let mut set = GameSet { games: Vec::new(), tally: Tally::default(), looks: 0 };
        let mut shown = BTreeSet::new();
        for round in 0..self.order.effort.attempts {
            // The first round fills the archive, the others mend it where the judges said no.
            let missing = wanted - set.games.len();
            let looks = if round == 0 {
                looks
            } else {
                (self.order.effort.looks as usize * missing / 4).max(LEAST_OF_ROUND)
            };
            let look = |genome: &KernelGenome| {
                self.progress.looked();
                looker.look(genome)
            };
            run_search(&mut search, (looks, self.order.effort.batch), look, |_, look| {
                set.looks += 1;
                set.tally.calls(look.calls);
                look.evaluation
            });
            let is_welcome = |genome: &KernelGenome| {
                company.has_room(genome.kernel(), genome.form(), genome.kind().name())
            };
            let is_near = |one: &KernelGenome, other: &KernelGenome| one.kernel() == other.kernel();
            let wanted_now = missing.max(LEAST_OF_ROUND);
            let key = KernelGenome::key;
            let picked = spread(search.archive(), wanted_now, &[], is_near, is_welcome, &mut shown, key);
            let judge = |(cell, genome): &(usize, KernelGenome)| {
                let mut tally = Tally::default();
                let key = genome.key().to_string();
                let seed = self.seed.child("judges", 0).child(&key, 0);
                let mut made = self.gate.judge(genome, round, seed, &[], &mut tally);
                self.progress.looked();
                if let Some(made) = &mut made {
                    made.path = path([("judges", 0), (&key, 0)]);
                }
                (*cell, made, tally)
            };
            let judged: Vec<_> = picked.par_iter().map(judge).collect();
            for (cell, made, mut tally) in judged {
                match made.map(|made| company.welcome(&made).map(|()| made)) {
                    Some(Ok(_)) if set.games.len() == wanted => tally.taken_back("more than asked for"),
                    Some(Ok(made)) => {
                        self.progress.made(&made.card.title);
                        set.games.push(made);
                    }
                    Some(Err(why)) => tally.taken_back(why),
                    None => search.demote(cell, REFUSED),
                }
                set.tally.add(&tally);
            }
            if set.games.len() == wanted {
                break;
            }
        }
        set
    }
}

/// Steps from seed to seed, with words of their own.
fn path<const N: usize>(steps: [(&str, u64); N]) -> Vec<Step> {
    steps.into_iter().map(|(purpose, index)| (purpose.to_owned(), index)).collect()
}

/// The games of a set so far: no two are near, none has the title or the cast of another, no kernel and no kind is crowded,
/// and games of a kernel have different maps.
struct Company {
    forms: Vec<GameForm>,
    titles: BTreeSet<String>,
    casts: Vec<Cast>,
    /// The number of games of each kernel, kernels that are hardly different together.
    of_families: BTreeMap<String, usize>,
    /// The kernels and forms that there are.
    of_forms: BTreeSet<(String, Option<String>)>,
    /// The number of games of each kind.
    of_kinds: BTreeMap<String, usize>,
    /// The walls of the levels of all games, by family and slot.
    walls: BTreeSet<(String, usize, Vec<String>)>,
    /// The most games of a kernel and of a kind; none if only some kinds are asked for.
    room: Option<(usize, usize)>,
}

impl Company {
    /// A kernel has one game, or one in each form if there are more games than kernels, and three of twenty games are of a
    /// kind, or two of a few; as many as there are, where only some kinds are asked for.
    fn of(order: &GameOrder) -> Company {
        let count = order.count as usize;
        let of_kernel = count.div_ceil(KernelGenome::kernels().count()).max(1);
        let room = (order.kinds.len() >= Kind::ALL.len()).then_some((of_kernel, (count * 3 / 20).max(2)));
        Company {
            forms: Vec::new(),
            titles: BTreeSet::new(),
            casts: Vec::new(),
            of_families: BTreeMap::new(),
            of_forms: BTreeSet::new(),
            of_kinds: BTreeMap::new(),
            walls: BTreeSet::new(),
            room,
        }
    }

    /// Tests whether a game of this kernel, in this form, and kind could be taken in.
    fn has_room(&self, kernel: &str, form: Option<&str>, kind: &str) -> bool {
        let Some((of_family, of_kind)) = self.room else { return true };
        let count = |counts: &BTreeMap<String, usize>, name: &str| counts.get(name).copied().unwrap_or(0);
        let is_other = KernelGenome::forms(kernel) < 2
            || !self.of_forms.contains(&(kernel.to_owned(), form.map(str::to_owned)));
        let family = KernelGenome::family(kernel);
        is_other && count(&self.of_families, family) < of_family && count(&self.of_kinds, kind) < of_kind
    }

    /// Takes the game in, or says why not.
    fn welcome(&mut self, made: &MadeGame) -> Result<(), &'static str> {
        let form = GameForm::of(&made.game);
        if self.forms.iter().any(|other| form.is_near(other)) {
            return Err(NEAR_KNOWN);
        }
        if self.titles.contains(&made.card.title) {
            return Err("a title twice");
        }
        let cast = Cast::of(&made.game);
        if self.casts.iter().any(|other| cast.is_shared(other)) {
            return Err("a cast twice");
        }
        let (kernel, its_form) = (made.card.origin.kernel().unwrap_or_default(), made.card.origin.form());
        if !self.has_room(kernel, its_form, &made.card.kind) {
            return Err("enough of its kind");
        }
        let family = KernelGenome::family(kernel).to_owned();
        let levels = made.levels.iter().map(|found| walls(&found.level.to_string())).enumerate();
        let walls: Vec<_> = levels.map(|(slot, walls)| (family.clone(), slot, walls)).collect();
        if self.room.is_some() && walls.iter().any(|level| self.walls.contains(level)) {
            return Err("a map twice");
        }
        self.walls.extend(walls);
        self.of_forms.insert((kernel.to_owned(), its_form.map(str::to_owned)));
        *self.of_families.entry(family).or_default() += 1;
        *self.of_kinds.entry(made.card.kind.clone()).or_default() += 1;
        self.titles.insert(made.card.title.clone());
        self.casts.push(cast);
        self.forms.push(form);
        Ok(())
    }
}

/// The walls of a level, mirrored such that levels which are mirror images have the same.
fn walls(level: &str) -> Vec<String> {
    let rows: Vec<String> = level
        .lines()
        .map(|row| row.chars().map(|symbol| if symbol == 'w' { '#' } else { '.' }).collect())
        .collect();
    let turned = |mirrored: bool, upside_down: bool| {
        let row = |row: &String| if mirrored { row.chars().rev().collect() } else { row.clone() };
        let mut rows: Vec<String> = rows.iter().map(row).collect();
        if upside_down {
            rows.reverse();
        }
        rows
    };
    let all = [(false, false), (true, false), (false, true), (true, true)];
    all.into_iter().map(|(mirrored, upside_down)| turned(mirrored, upside_down)).min().unwrap_or_default()
}

/// The feasibility of a game that a look took for feasible and the last judges did not.
const REFUSED: f64 = 0.95;

impl Attempted {
    fn note(&mut self, look: &super::look::Look) {
        self.looks += 1;
        self.tally.calls(look.calls);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mirror_images_have_the_same_walls() {
        let level = "wwww\nwA.w\nww.w\nwwww\n";
        let mirrored = "wwww\nw.ww\nw.Bw\nwwww\n";
        assert_eq!(walls(level), walls(mirrored));
        assert_ne!(walls(level), walls("wwww\nwA.w\nw..w\nwwww\n"));
    }
}
