//! The sources of candidates. To add a source, implement [`Rules`] for rules, or [`BoardSource`] for boards.

use crate::games::FoundLevel;
use crate::games::judges_seed;
use crate::games::puzzles::PuzzleGenerator;
use crate::games::{FinishedLevels, PuzzleLevels};
use agents::systematic_seed;
use base::{Seed, SeedPath};
use engine::{Action, Game, Level};
use generators::games::GeneratedGame;
use generators::kernels::{Course, CourseLevel, KernelGame, KernelGenome, Slot};
use generators::levels::{ConstructiveLevels, LevelConfig};
use generators::{GenerateError, Generator};
use validators::{CheckedCriteria, Criterion, Tier};

/// Rules proposed by a source for a game.
pub(crate) trait Rules: Sized {
    /// The source of the game's boards.
    type Boards: BoardSource;

    /// Builds the game. Returns `None` if the rules do not compile.
    fn build(&self) -> Option<(GeneratedGame, Self::Boards)>;

    /// Returns `true` if the rules need a time limit.
    fn has_clock(&self) -> bool;

    /// Returns the same rules with a different time limit, or without one.
    #[must_use]
    fn timed(&self, ticks: Option<u32>) -> Self;
}

impl Rules for KernelGenome {
    type Boards = Course;

    fn build(&self) -> Option<(GeneratedGame, Course)> {
        let KernelGame { game, course } = KernelGenome::build(self).ok()?;
        Some((game, course))
    }

    fn has_clock(&self) -> bool {
        KernelGenome::has_clock(self)
    }

    fn timed(&self, ticks: Option<u32>) -> KernelGenome {
        KernelGenome::timed(self, ticks)
    }
}

/// A source of boards for a game's positions.
pub trait BoardSource: Sync {
    /// Returns the name used on cards.
    fn name(&self) -> &'static str;

    /// Returns `true` if the levels form a course, in which each level demands more than the levels before it. The
    /// levels must then fit together.
    fn is_course(&self) -> bool {
        false
    }

    /// Evaluates a few boards quickly.
    ///
    /// # Errors
    /// Returns the reason if no board is worth a search.
    fn look(&self, _game: &Game, _seed: Seed) -> Result<(), &'static str> {
        Ok(())
    }

    /// Returns the interactions of each mechanic that should matter, if the source knows them.
    fn mechanics(&self) -> &[Vec<usize>] {
        &[]
    }

    /// Returns the required tier of the level at a position; `None` if the source's levels have no required tiers.
    fn tier(&self, _number: u32) -> Option<Tier> {
        None
    }

    /// Returns `true` if levels keep the order of their positions. Otherwise the levels are ordered by measured
    /// ease.
    fn is_ordered(&self) -> bool;

    /// Prepares the boards for a position.
    ///
    /// # Errors
    /// Returns an error if the source does not support the game.
    fn boards<'a>(
        &'a self,
        game: &'a Game,
        place: &PlaceBrief<'a>,
    ) -> Result<Box<dyn Boards + 'a>, GenerateError>;
}

/// The position of a board in a game.
pub struct PlaceBrief<'a> {
    /// The level's number.
    pub number: u32,
    /// The target difficulty of the level, from 0 to 1.
    pub difficulty: f64,
    /// The levels at other positions, with their numbers.
    pub others: &'a [(u32, FoundLevel)],
    /// The criteria for the level and for the game.
    pub criteria: &'a CheckedCriteria,
}

/// The boards for one position.
pub trait Boards {
    /// Generates the board for a candidate's seed.
    ///
    /// # Errors
    /// Returns an error if there is no board for this seed.
    fn generate(&self, candidate: &SeedPath) -> Result<Board, GenerateError>;
}

/// A level, and the source's knowledge about it.
pub struct Board {
    /// The level on the board.
    pub level: Level,
    /// A sentence about the problem that the level poses to the player, if the level was made for a position in the
    /// game.
    pub asks: Option<String>,
    /// A winning sequence of actions; `None` if none is known.
    pub known: Option<Vec<Action>>,
}

/// Returns the seed for a candidate's layout.
fn layout(candidate: &SeedPath) -> Seed {
    candidate.seed().child("layout", 0)
}

/// Returns the seed for winning a candidate's puzzle. It is the seed that the win search would have used without a
/// known win.
pub(super) fn seed_of_win(candidate: &SeedPath) -> SeedPath {
    systematic_seed(&Criterion::Winnable.seed(&judges_seed(candidate)))
}

/// Generates levels from the rules alone. The difficulty depends on the position.
impl BoardSource for LevelConfig {
    fn name(&self) -> &'static str {
        "constructive"
    }

    fn is_ordered(&self) -> bool {
        false
    }

    fn boards<'a>(
        &'a self,
        game: &'a Game,
        place: &PlaceBrief<'a>,
    ) -> Result<Box<dyn Boards + 'a>, GenerateError> {
        let config = LevelConfig { difficulty: place.difficulty, ..self.clone() };
        Ok(Box::new(ConstructiveLevels::new(game, config)?))
    }
}

impl Boards for ConstructiveLevels<'_> {
    fn generate(&self, candidate: &SeedPath) -> Result<Board, GenerateError> {
        let level = Generator::generate(self, layout(candidate))?;
        Ok(Board { level, asks: None, known: None })
    }
}

/// Generates levels from the maps of a kernel (hand-written design). Each position in the game has its own purpose and
/// maps.
impl BoardSource for Course {
    fn name(&self) -> &'static str {
        "course"
    }

    fn is_course(&self) -> bool {
        true
    }

    fn is_ordered(&self) -> bool {
        true
    }

    fn boards<'a>(
        &'a self,
        game: &'a Game,
        place: &PlaceBrief<'a>,
    ) -> Result<Box<dyn Boards + 'a>, GenerateError> {
        let last = Slot::ALL.len() - 1;
        let slot = Slot::ALL[(place.difficulty * last as f64).round() as usize];
        Ok(Box::new(SlotBoards { game, course: self, slot }))
    }
}

/// The boards for one position in a course of levels.
struct SlotBoards<'a> {
    game: &'a Game,
    course: &'a Course,
    slot: Slot,
}

impl Boards for SlotBoards<'_> {
    fn generate(&self, candidate: &SeedPath) -> Result<Board, GenerateError> {
        let CourseLevel { text, asks, .. } = self.course.level(self.slot, layout(candidate))?;
        let level =
            self.game.level(&text).map_err(|problems| GenerateError::Unlucky(problems.to_string()))?;
        Ok(Board { level, asks: Some(asks), known: None })
    }
}

/// Generates pushing puzzles, lock puzzles or yards (puzzles about carrying parcels). The tier depends on the position.
impl BoardSource for PuzzleLevels {
    fn name(&self) -> &'static str {
        "puzzle"
    }

    fn tier(&self, number: u32) -> Option<Tier> {
        Some(PuzzleLevels::tier(self, number))
    }

    fn is_ordered(&self) -> bool {
        true
    }

    fn boards<'a>(
        &'a self,
        game: &'a Game,
        place: &PlaceBrief<'a>,
    ) -> Result<Box<dyn Boards + 'a>, GenerateError> {
        Ok(Box::new(PuzzleBoards { game, generator: self.generator(game, place.number)? }))
    }
}

/// The puzzles for one position.
struct PuzzleBoards<'a> {
    game: &'a Game,
    generator: PuzzleGenerator<'a>,
}

impl Boards for PuzzleBoards<'_> {
    fn generate(&self, candidate: &SeedPath) -> Result<Board, GenerateError> {
        let win = seed_of_win(candidate).seed();
        let solved = self.generator.create_solved(self.game, layout(candidate), win);
        let far = || GenerateError::Unlucky("no puzzle is far enough from its solution".to_owned());
        let (level, known) = solved.ok_or_else(far)?;
        Ok(Board { level, asks: None, known: Some(known) })
    }
}

/// Returns the level of each position. There is nothing to generate.
impl BoardSource for FinishedLevels {
    fn name(&self) -> &'static str {
        "design"
    }

    fn is_ordered(&self) -> bool {
        true
    }

    fn boards<'a>(
        &'a self,
        _: &'a Game,
        place: &PlaceBrief<'a>,
    ) -> Result<Box<dyn Boards + 'a>, GenerateError> {
        let level = self.0.get(place.number as usize);
        let missing = || GenerateError::Unsuitable("the game has too few levels".to_owned());
        Ok(Box::new(level.ok_or_else(missing)?))
    }
}

impl Boards for &Level {
    fn generate(&self, _: &SeedPath) -> Result<Board, GenerateError> {
        Ok(Board { level: (*self).clone(), asks: None, known: None })
    }
}
