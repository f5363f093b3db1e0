//! Twins: games with the same mechanics under a different theme. They help to test whether a model understands a game
//! or only remembers it ([the properties of each kind](../../../../docs/how-to/twins.md)).

mod mirrored;
mod released;

pub use released::of_released;

use engine::describe::Guide;

use base::Seed;
use engine::{Action, Analysis, Description, Diagnostics, Episode, Game, Level, Outcome, syntax};
use generators::GenerateError;
use generators::games::{Masked, Rethemed};
use std::fmt;
use std::str::FromStr;

base::named_enum! {
    /// The kind of twin, which determines how the game's surface (names, characters or orientation) changes.
    pub enum Twin {
        /// Names and level characters no longer carry meaning.
        Masked = "masked",
        /// The board and every direction in the rules are reflected left to right.
        Mirrored = "mirrored",
        /// The game has a different theme.
        Renamed = "renamed",
        /// The renamed copy that is withheld until the reveal. A secret random choice decided which of two copies is
        /// published ([`crate::sections::memory`]).
        Sibling = "sibling",
    }
}

impl fmt::Display for Twin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Twin {
    type Err = String;

    fn from_str(text: &str) -> Result<Twin, String> {
        let found = Twin::ALL.into_iter().find(|kind| kind.name() == text);
        found.ok_or_else(|| format!("there is no twin `{text}`: choose masked, mirrored, renamed or sibling"))
    }
}

/// A twin: a game with the same mechanics as the original but a different surface.
#[derive(Clone, Debug, PartialEq)]
pub struct TwinGame {
    /// The rules, preceded by the title and the canary (an identifier for finding the release in text corpora).
    pub text: String,
    /// The levels, in the original's order.
    pub levels: Vec<String>,
    /// A winning episode for each level; `None` if the original has no win, or if the original's actions do
    /// not win in the twin and no other win was found.
    pub witnesses: Vec<Option<Episode>>,
    /// The twin's title.
    pub title: String,
    /// A description of the player and of the rest of the game, as far as the twin's surface reveals them.
    pub description: String,
    /// The goal, as one sentence.
    pub goal: String,
}

/// A reason why a game has no twin.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TwinError {
    /// The text is not a game.
    #[error("not a valid game: {0}")]
    Game(Diagnostics),
    /// A level does not belong to the game.
    #[error("lvl{number}.txt is not a level of this game: {problems}")]
    Level {
        /// The level's number, from 0.
        number: usize,
        /// The level's diagnostics.
        problems: Diagnostics,
    },
    /// The rules cannot be mirrored faithfully.
    #[error("the game cannot be mirrored: {0}")]
    Unmirrorable(String),
    /// The game has no sibling (withheld renamed copy), or the sibling was not revealed.
    #[error("the game has no sibling, or the sibling was not revealed")]
    NoSibling,
    /// The game has no second theme.
    #[error(transparent)]
    NoTheme(#[from] GenerateError),
}

/// Creates a game's twin, with the same mechanics and one level for each level of the game. `witnesses` are the
/// winning episodes of the levels, in level order. There may be fewer witnesses than levels. The same arguments
/// produce the same twin.
///
/// Cost: well under a second, unless a witness search is needed.
///
/// # Errors
/// Returns an error if the rules or the levels do not load, or if the game has no twin of this kind.
pub fn of_game(
    kind: Twin,
    source: &str,
    levels: &[String],
    witnesses: &[Episode],
) -> Result<TwinGame, TwinError> {
    let known = (0..levels.len()).map(|number| witnesses.get(number)).collect();
    of_levels(kind, source, levels, known)
}

/// Creates a twin (a copy with a different surface) like [`of_game`], but any level may lack a witness.
fn of_levels(
    kind: Twin,
    source: &str,
    levels: &[String],
    witnesses: Vec<Option<&Episode>>,
) -> Result<TwinGame, TwinError> {
    let original = Original::load(source, levels, witnesses)?;
    match kind {
        Twin::Masked => original.masked(),
        Twin::Mirrored => mirrored::twin(&original),
        Twin::Renamed => original.renamed(original.seed(Twin::Renamed)).map(|(twin, _)| twin),
        Twin::Sibling => Err(TwinError::NoSibling),
    }
}

/// Creates a renamed twin (a copy under different names) from the caller's seed, instead of the publicly known seed.
/// Also returns the name of the twin's scene (theme).
pub(crate) fn renamed(
    source: &str,
    levels: &[String],
    witnesses: &[Episode],
    seed: Seed,
) -> Result<(TwinGame, &'static str), TwinError> {
    let known = (0..levels.len()).map(|number| witnesses.get(number)).collect();
    Original::load(source, levels, known)?.renamed(seed)
}

/// The original game from which a twin is made.
struct Original<'a> {
    game: Game,
    /// The canonical level texts.
    levels: Vec<String>,
    /// The witnesses, with one entry per level.
    witnesses: Vec<Option<&'a Episode>>,
}

impl<'a> Original<'a> {
    /// Loads a game whose levels may each have a witness.
    fn load(
        source: &str,
        levels: &[String],
        witnesses: Vec<Option<&'a Episode>>,
    ) -> Result<Original<'a>, TwinError> {
        let game = Game::from_source(source).map_err(TwinError::Game)?;
        let canonical = |(number, level): (usize, &String)| {
            let level = game.level(level).map_err(|problems| TwinError::Level { number, problems })?;
            Ok(level.to_string())
        };
        let levels = levels.iter().enumerate().map(canonical).collect::<Result<_, TwinError>>()?;
        Ok(Original { game, levels, witnesses })
    }

    /// Returns the seed for a twin's random draws. The seed depends only on the game and the kind.
    fn seed(&self, kind: Twin) -> Seed {
        Seed::from_text(&format!("twin {} of {}", kind.name(), self.game.digest()))
    }

    /// Returns the title, which releases place above the rules.
    fn title(&self) -> Option<String> {
        let comments = self.game.description().header.trivia.above.iter().map(|line| line.trim());
        comments.filter(|line| !line.is_empty() && !line.starts_with(CANARY)).map(str::to_owned).next()
    }

    fn masked(&self) -> Result<TwinGame, TwinError> {
        let masked = Masked::of(self.game.description(), self.seed(Twin::Masked));
        let levels = self.levels.iter().map(|level| masked.level(level)).collect();
        let mut made = Made::of(self, masked.description(), levels, |action| action)?;
        made.twin.title = made.plain_title();
        Ok(made.headed(self))
    }

    fn renamed(&self, seed: Seed) -> Result<(TwinGame, &'static str), TwinError> {
        let rethemed = Rethemed::of(&self.game, seed)?;
        let levels = self.levels.iter().map(|level| rethemed.level(level)).collect();
        let mut made = Made::of(self, &rethemed.description, levels, |action| action)?;
        made.twin.title = rethemed.title;
        made.twin.description = rethemed.summary;
        made.twin.goal = rethemed.goal;
        Ok((made.headed(self), rethemed.scene))
    }
}

/// The prefix of the comments that state that a text must not be used for training.
const CANARY: &str = "canary ";

/// A twin whose title and text are still missing, and its compiled game.
struct Made {
    twin: TwinGame,
    game: Game,
}

impl Made {
    /// Creates a twin from rules. In these rules, the image of an action must have the same effect as the action
    /// itself in the original.
    fn of(
        original: &Original<'_>,
        rules: &Description,
        levels: Vec<String>,
        image: fn(Action) -> Action,
    ) -> Result<Made, TwinError> {
        // The game is compiled from the printed text, so that the game played is the frozen one.
        let game = Game::from_source(&syntax::print_bare(rules)).map_err(TwinError::Game)?;
        let mut witnesses = Vec::new();
        for (number, text) in levels.iter().enumerate() {
            let level = game.level(text).map_err(|problems| TwinError::Level { number, problems })?;
            let known = original.witnesses[number];
            let again = |known: &Episode| replayed(&game, &level, known.seed, &known.actions, image);
            witnesses.push(known.and_then(again));
        }
        let guide = Guide::from_analysis(&Analysis::of(&game));
        let (description, goal) = (guide.controls.join(" "), guide.goal());
        let twin =
            TwinGame { text: String::new(), levels, witnesses, title: String::new(), description, goal };
        Ok(Made { twin, game })
    }

    /// Returns a title without meaning, which is derived from the game's digest.
    fn plain_title(&self) -> String {
        format!("Game {}", self.game.digest().short())
    }

    /// Completes the twin with its text, preceded by the title and by the original's canary (the release's identifier
    /// in text corpora) if there is one.
    fn headed(self, original: &Original<'_>) -> TwinGame {
        let comments = original.game.description().header.trivia.above.iter().map(|line| line.trim());
        let canaries = comments.filter(|line| line.starts_with(CANARY));
        let mut tree = self.game.description().clone();
        let above = [self.twin.title.as_str()].into_iter().chain(canaries);
        tree.header.trivia.above = above.map(str::to_owned).collect();
        TwinGame { text: syntax::print(&tree), ..self.twin }
    }
}

/// Replays the images of the given actions. Returns `None` if the episode is not a win.
fn replayed(
    game: &Game,
    level: &Level,
    seed: Seed,
    actions: &[Action],
    image: fn(Action) -> Action,
) -> Option<Episode> {
    let (mut episode, mut state) = Episode::begin(game, level, seed);
    for &action in actions {
        if episode.play(game, &mut state, image(action)) != Outcome::Ongoing {
            break;
        }
    }
    (episode.outcome == Outcome::Won).then_some(episode)
}
