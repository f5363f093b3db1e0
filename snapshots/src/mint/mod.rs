//! Minting: where candidates meet their judges.
//!
//! A release is a list of independent places, each with a seed of its own. For each place candidates are made and judged
//! until one passes, so the bytes of a release depend on the recipe alone: not on threads, order or time.

mod folder;
mod tally;

use crate::card::{Card, Origin};
use crate::corpus::Corpus;
use crate::games::{Candidate, Levels, MadeGame};
use crate::manifest::Manifest;
use crate::recipe::{Part, Recipe};
use crate::{Digest, SnapshotError};
use engine::{Game, Sampler, Seed};
use generators::games::{ConstructiveGames, GameConfig, Kind};
use generators::{GenerateError, Generator};
use rayon::prelude::*;
pub use tally::Tally;
pub(crate) use tally::reasons;
use validators::{GameForm, Panel};

/// A release in memory: every file, in path order, the manifest apart.
#[derive(Clone, Debug)]
pub struct Minted {
    /// The manifest, root included.
    pub manifest: Manifest,
    /// Relative path and content.
    pub files: Vec<(String, Vec<u8>)>,
    /// The cards of the games, in the order of their places.
    pub cards: Vec<Card>,
    /// How many candidates were tried, and why the others failed.
    pub tally: Tally,
}

/// Why nothing was minted.
#[derive(Debug, thiserror::Error)]
pub enum MintError {
    /// The recipe asks for more corpus games than there are.
    #[error("`corpus.games` is {asked}, but the corpus has {known} games")]
    SmallCorpus {
        /// In the recipe.
        asked: u32,
        /// In the corpus.
        known: usize,
    },
    /// A corpus game does not compile.
    #[error("the corpus game `{name}` does not compile: {problems}")]
    BrokenCorpus {
        /// The game.
        name: String,
        /// What is wrong.
        problems: engine::Diagnostics,
    },
    /// No candidate for a place passed.
    #[error("{place}: none of {tried} candidates passed ({why}); raise the tries or relax the criteria")]
    Unfilled {
        /// The place.
        place: String,
        /// Candidates tried.
        tried: u32,
        /// How the candidates failed.
        why: String,
    },
    /// Files or manifest could not be made.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
}

/// Told how minting goes; from several threads.
pub trait Progress: Sync {
    /// So many places are to be filled.
    fn begin(&self, _places: usize) {}
    /// A candidate for a place was judged.
    fn tried(&self, _place: &str, _passed: bool) {}
    /// A place is filled.
    fn filled(&self, _card: &Card) {}
}

impl Progress for () {}

/// A place in a release.
#[derive(Clone, Copy, Debug)]
enum Place {
    /// New levels for a corpus game: index into the corpus.
    Corpus(usize),
    /// A new game: its number among them.
    Generated(u32),
}

/// A filled place.
struct Filled {
    made: MadeGame,
    /// Equal for games that are the same rules in another fiction.
    form: Digest,
    tally: Tally,
}

/// Mints a release. Cost: minutes for tens of games, on all threads of the current rayon pool.
///
/// # Errors
/// The recipe cannot be fulfilled, or the corpus is broken.
pub fn mint(
    recipe: &Recipe,
    corpus: &Corpus,
    lockfile: Digest,
    progress: &dyn Progress,
) -> Result<Minted, MintError> {
    let (places, reserve) = places(recipe, corpus)?;
    progress.begin(places.len());
    let mint = Mint { recipe, corpus, panel: Panel::new(&recipe.criteria), progress };
    let filled: Vec<Result<Filled, MintError>> =
        places.par_iter().map(|&place| mint.fill(place, 0)).collect();
    let mut games = mint.with_reserve(&places, filled, reserve)?;
    mint.replace_twins(&places, &mut games)?;
    folder::assemble(recipe, lockfile, games)
}

/// Whether the corpus has what the recipe asks for: for a question answered before the work begins.
///
/// # Errors
/// It has not.
pub fn check(recipe: &Recipe, corpus: &Corpus) -> Result<(), MintError> {
    places(recipe, corpus).map(drop)
}

/// The places of a release, in order; which corpus games are taken is drawn. The others follow in the order of the draw: they are
/// the reserve.
fn places(recipe: &Recipe, corpus: &Corpus) -> Result<(Vec<Place>, Vec<Place>), MintError> {
    let (asked, known) = (recipe.corpus.games, corpus.games.len());
    if asked as usize > known {
        return Err(MintError::SmallCorpus { asked, known });
    }
    let mut order: Vec<usize> = (0..known).collect();
    let mut sampler: Sampler = recipe.root_seed().child("corpus order", 0).sampler();
    sampler.shuffle(&mut order);
    let reserve = order.split_off(asked as usize);
    order.sort_unstable();
    let generated = (0..recipe.generated.games).map(Place::Generated);
    let places = order.into_iter().map(Place::Corpus).chain(generated).collect();
    Ok((places, reserve.into_iter().map(Place::Corpus).collect()))
}

struct Mint<'a> {
    recipe: &'a Recipe,
    corpus: &'a Corpus,
    panel: Panel,
    progress: &'a dyn Progress,
}

impl Mint<'_> {
    /// Fills a place with the first candidate, from number `from` on, that passes.
    fn fill(&self, place: Place, from: u32) -> Result<Filled, MintError> {
        let (name, seed, part) = self.describe(place);
        let mut tally = Tally::default();
        let tries = match place {
            Place::Corpus(_) => from + 1,
            Place::Generated(_) => part.game_tries,
        };
        for number in from..tries {
            let seed = seed.child("candidate", u64::from(number));
            let candidate = match self.candidate(place, number, seed)? {
                Ok(candidate) => candidate,
                Err(error) => {
                    tally.game_rejected(&error.to_string());
                    continue;
                }
            };
            let levels = Levels {
                count: part.levels,
                tries: part.level_tries,
                board: &self.recipe.board,
                criteria: &self.recipe.criteria,
                panel: &self.panel,
                seed,
            };
            let found = levels.find(&candidate.game, &mut tally);
            self.progress.tried(&name, found.is_some());
            let canary = folder::canary_of(self.recipe);
            if let Some(made) = found.and_then(|found| candidate.finish(found, &canary)) {
                tally.game_accepted();
                self.progress.filled(&made.card);
                return Ok(Filled { form: GameForm::of(&made.game).digest(), made, tally });
            }
        }
        Err(MintError::Unfilled { place: name, tried: tries - from.min(tries), why: tally.reasons() })
    }

    /// The filled places; those of corpus games that no new level was found for go to games of the reserve, in order.
    fn with_reserve(
        &self,
        places: &[Place],
        filled: Vec<Result<Filled, MintError>>,
        reserve: Vec<Place>,
    ) -> Result<Vec<Filled>, MintError> {
        let mut reserve = reserve.into_iter();
        let instead = |(place, result): (&Place, Result<Filled, MintError>)| match (place, result) {
            (Place::Corpus(_), Err(error @ MintError::Unfilled { .. })) => {
                let mut tried = reserve.by_ref().map(|place| self.fill(place, 0));
                let other =
                    |result: &Result<Filled, MintError>| !matches!(result, Err(MintError::Unfilled { .. }));
                tried.find(other).unwrap_or(Err(error))
            }
            (_, result) => result,
        };
        places.iter().zip(filled).map(instead).collect()
    }

    /// Name, seed and part of a place.
    fn describe(&self, place: Place) -> (String, Seed, &Part) {
        let root = self.recipe.root_seed();
        match place {
            Place::Corpus(at) => {
                let name = &self.corpus.games[at].name;
                (format!("levels for {name}"), root.child("corpus", 0).child(name, 0), &self.recipe.corpus)
            }
            Place::Generated(number) => {
                let seed = root.child("generated", u64::from(number));
                (format!("new game {}", number + 1), seed, &self.recipe.generated)
            }
        }
    }

    fn candidate(
        &self,
        place: Place,
        number: u32,
        seed: Seed,
    ) -> Result<Result<Candidate, GenerateError>, MintError> {
        match place {
            Place::Corpus(at) => self.corpus_game(at).map(Ok),
            Place::Generated(number_of_place) => {
                // Places take turns through the kinds, so that a release has as many as it can.
                let mut kinds = Kind::ALL.to_vec();
                self.recipe.root_seed().child("kinds", 0).sampler().shuffle(&mut kinds);
                let kind = kinds[number_of_place as usize % kinds.len()];
                let generator = ConstructiveGames::new(GameConfig { kinds: vec![kind] });
                Ok(generator
                    .generate(seed.child("rules", 0))
                    .and_then(|made| Candidate::generated(made, "constructive", number)))
            }
        }
    }

    fn corpus_game(&self, at: usize) -> Result<Candidate, MintError> {
        let corpus_game = &self.corpus.games[at];
        let name = corpus_game.name.clone();
        let game = Game::from_source(&corpus_game.source)
            .map_err(|problems| MintError::BrokenCorpus { name: name.clone(), problems })?;
        let card = corpus_game.card.clone();
        Ok(Candidate {
            game,
            title: card.title,
            description: card.description,
            goal: card.goal,
            kind: card.kind,
            real_time: card.real_time,
            origin: Origin::Corpus { name },
        })
    }

    /// Fills a place anew if an earlier one holds the same rules: the later place moves on to its next candidates.
    fn replace_twins(&self, places: &[Place], games: &mut [Filled]) -> Result<(), MintError> {
        for at in 1..games.len() {
            loop {
                let twin = games[..at].iter().any(|other| other.form == games[at].form);
                let Origin::Generated { candidate, .. } = games[at].made.card.origin else { break };
                if !twin {
                    break;
                }
                let mut tally = games[at].tally.clone();
                games[at] = self.fill(places[at], candidate + 1)?;
                tally.taken_back("same rules as another game");
                games[at].tally.add(&tally);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::corpus::{CorpusCard, CorpusGame};

    /// Fetch the gem and leave, before time is up.
    const FETCH: &str = "BasicGame
    SpriteSet
        floor > Immovable
        wall > Immovable
        gem > Immovable color=YELLOW
        exit > Door color=GREEN
        avatar > MovingAvatar
    LevelMapping
        . > floor
        w > floor wall
        g > floor gem
        e > floor exit
        A > floor avatar
    InteractionSet
        avatar wall > stepBack
        gem avatar > killSprite scoreChange=1
        exit avatar > killSprite
    TerminationSet
        MultiSpriteCounter stype1=gem stype2=exit limit=0 win=True
        Timeout limit=50 win=False
";

    fn corpus(sources: &[(&str, &str)]) -> Corpus {
        let game = |&(name, source): &(&str, &str)| {
            let words = || name.to_owned();
            let card = CorpusCard {
                title: words(),
                description: words(),
                goal: words(),
                kind: words(),
                real_time: false,
                skill: words(),
                levels: Vec::new(),
            };
            CorpusGame { name: words(), source: source.to_owned(), levels: Vec::new(), card }
        };
        Corpus { games: sources.iter().map(game).collect() }
    }

    /// One corpus game with one level.
    fn recipe(seed: &str) -> Recipe {
        let text = format!(
            "name = 'one'\ndescription = 'one'\nseed = '{seed}'\n[corpus]\ngames = 1\nlevels = 1\n\
             [criteria]\nask = ['not-idle', 'not-random', 'winnable']\nbudget = 20000\n"
        );
        Recipe::from_toml(&text).unwrap()
    }

    #[test]
    fn a_corpus_game_without_new_levels_makes_room_for_the_next_of_the_draw() {
        let hopeless = FETCH.replace("gem avatar > killSprite scoreChange=1", "avatar gem > stepBack");
        let corpus = corpus(&[("fetch", FETCH), ("hopeless", &hopeless)]);
        // Whichever is drawn first: both orders are drawn.
        let mut first = Vec::new();
        for seed in ["a", "b", "c", "d", "e", "f"] {
            let recipe = recipe(seed);
            let Place::Corpus(drawn) = places(&recipe, &corpus).unwrap().0[0] else { unreachable!() };
            first.push(drawn);
            let minted = mint(&recipe, &corpus, Digest::of(b""), &()).unwrap();
            assert_eq!(minted.cards[0].title, "fetch");
        }
        assert!(first.contains(&0) && first.contains(&1), "{first:?}");
    }

    /// Only a game without levels is passed over: what is broken is told.
    #[test]
    fn a_broken_game_of_the_reserve_is_told() {
        let hopeless = FETCH.replace("gem avatar > killSprite scoreChange=1", "avatar gem > stepBack");
        let corpus = corpus(&[("hopeless", &hopeless), ("torn", "BasicGame\n    SpriteSet\n")]);
        for seed in ["a", "b", "c", "d"] {
            let error = mint(&recipe(seed), &corpus, Digest::of(b""), &()).unwrap_err();
            assert!(matches!(&error, MintError::BrokenCorpus { name, .. } if name == "torn"), "{error}");
        }
    }
}
