//! The constructive level generator: walls first, then furniture by role, then a last look.

use super::board::Board;
use super::builder::Builder;
use super::config::LevelConfig;
use super::crossing;
use super::grid::Grid;
use super::jobs::Jobs;
use super::layout::{self, Family};
use super::palette::Palette;
use super::plan::furnishable;
use crate::{GenerateError, Generator};
use engine::analysis::{Deed, Motion, Reason, Role, Steering};
use engine::{Action, Analysis, Game, Level, Sampler, Seed};

/// Boards tried for one seed.
const ATTEMPTS: u64 = 40;
/// Boards tried for a puzzle before it is furnished like any other level.
const PUZZLES: u64 = 30;

/// Makes levels for one game, any game: what its sprite types are for is derived from the rules.
///
/// Levels fit the game's LevelMapping and hold one avatar; no termination holds at the start; what counts for a win can
/// be reached on foot (locks opened with keys that can be reached before, and shots, included); and a player who does
/// nothing lives through the first ticks if the game allows it at all. Puzzles of pushed things come with a solution that
/// has been played through.
///
/// Cost: about a millisecond for a level of usual size; it grows with the square of the cells.
pub struct ConstructiveLevels<'a> {
    pub(super) game: &'a Game,
    pub(super) analysis: Analysis,
    pub(super) palette: Palette,
    config: LevelConfig,
}

/// A level with the actions that win it, where the generator knows them.
#[derive(Clone, Debug)]
pub struct Solved {
    /// The level.
    pub level: Level,
    /// Actions that win it: known for puzzles of pushed things, in games without chance.
    pub solution: Option<Vec<Action>>,
}

/// A furnished board.
pub(super) struct Made {
    pub(super) board: Board,
    /// What wins it.
    solution: Option<Vec<Action>>,
    /// Its puzzle has been played through.
    pub(super) played: bool,
}

impl Made {
    fn plain(board: Board) -> Made {
        Made { board, solution: None, played: false }
    }
}

impl<'a> ConstructiveLevels<'a> {
    /// A generator for a game. Cost: one analysis.
    ///
    /// # Errors
    /// [`GenerateError::Unsuitable`] if the configuration is not sensible, if no character places exactly one avatar, or
    /// if a termination holds in every level that the LevelMapping can express.
    pub fn new(game: &'a Game, config: LevelConfig) -> Result<Self, GenerateError> {
        if let Some(problem) = config.problem() {
            return Err(GenerateError::Unsuitable(problem));
        }
        let analysis = Analysis::of(game);
        let Some(palette) = Palette::of(&analysis) else {
            let problem = "no level character places exactly one avatar".to_owned();
            return Err(GenerateError::Unsuitable(problem));
        };
        for requirement in analysis.requirements() {
            let placed = |stype: &engine::SpriteType| palette.symbol(*stype).is_some();
            let met = requirement.at_least == 0 || requirement.types.iter().any(placed);
            let room = config.columns.1 * config.rows.1;
            let met = met && requirement.at_least as usize <= room;
            if let (Reason::Goal(at), false) = (requirement.reason, met) {
                let number = analysis.goals()[at].line + 1;
                let problem = format!(
                    "termination {number} of the game holds before the first tick of every level of that size"
                );
                return Err(GenerateError::Unsuitable(problem));
            }
        }
        Ok(ConstructiveLevels { game, analysis, palette, config })
    }

    /// The game's analysis.
    pub fn analysis(&self) -> &Analysis {
        &self.analysis
    }

    /// Makes the level of this seed, with its solution if the generator knows one.
    ///
    /// # Errors
    /// [`GenerateError::Unlucky`] if all boards that were tried had a fault.
    pub fn generate_solved(&self, seed: Seed) -> Result<Solved, GenerateError> {
        let mut second_best: Option<Solved> = None;
        let mut fault = "no board could be furnished".to_owned();
        for attempt in 0..ATTEMPTS {
            let seed = seed.child("board", attempt);
            let Some(made) = self.attempt(seed, attempt) else { continue };
            match self.inspect(&made, seed) {
                Ok((level, true)) => return Ok(Solved { level, solution: made.solution }),
                Ok((level, false)) => {
                    second_best.get_or_insert(Solved { level, solution: made.solution });
                }
                Err(problem) => fault = problem,
            }
        }
        second_best.ok_or(GenerateError::Unlucky(fault))
    }

    /// One board, furnished.
    fn attempt(&self, seed: Seed, attempt: u64) -> Option<Made> {
        let mut layout = seed.child("layout", 0).sampler();
        let mut grid = Grid {
            columns: layout.between(self.config.columns.0, self.config.columns.1),
            rows: layout.between(self.config.rows.0, self.config.rows.1),
        };
        let sampler = seed.child("furniture", 0).sampler();
        let ring = self.palette.ring && grid.columns > 4 && grid.rows > 4;
        let steering = self.analysis.start_avatar()?.steering;
        if matches!(steering, Steering::Horizontal | Steering::Vertical) {
            let wall = layout::walls(Family::Field, grid, ring, 0.0, &mut layout);
            let mut builder = self.builder(Board::new(grid, wall), sampler);
            builder.gallery(steering, ring);
            return Some(Made::plain(builder.board));
        }
        if attempt < PUZZLES {
            let mut sampler = seed.child("puzzle", 0).sampler();
            let border = if ring { 2 * (grid.columns + grid.rows) } else { 0 };
            let difficulty = self.config.difficulty;
            let inner = grid.len().saturating_sub(border);
            if let Some(plan) = Jobs::draw(&self.analysis, &self.palette, inner, difficulty, &mut sampler) {
                let board = self.puzzle_walls(&plan, grid, ring, &mut layout);
                return self.puzzle(&plan, self.builder(board, sampler), seed);
            }
        }
        if grid.rows >= 6
            && let Some(traffic) = crossing::traffic(&self.analysis, &self.palette)
        {
            let closed = self.palette.wall.is_some();
            let mut builder = self.builder(Board::new(grid, vec![false; grid.len()]), sampler);
            let rows = builder.rows(grid, closed, &traffic);
            builder.board = Board::new(grid, Builder::lane_walls(grid, &rows, closed, &traffic));
            builder.crossing(&rows, &traffic);
            return Some(Made::plain(builder.board));
        }
        let mut family = self.family(&mut layout);
        if family == Family::Maze && grid.columns.min(grid.rows) < 7 {
            family = Family::Arena;
        }
        if family == Family::Maze {
            // Mazes want odd sides.
            grid.columns -= usize::from(grid.columns & 1 == 0 && grid.columns > self.config.columns.0);
            grid.rows -= usize::from(grid.rows & 1 == 0 && grid.rows > self.config.rows.0);
        }
        // Where something chases, a way round is a matter of life and death.
        let chased = furnishable(&self.analysis, &self.palette, Role::Enemy)
            .into_iter()
            .any(|stype| matches!(self.analysis.facts(stype).motion, Motion::Chasing(_)));
        let loops =
            if chased { 0.8 - 0.3 * self.config.difficulty } else { 0.5 - 0.5 * self.config.difficulty };
        // Closed layouts have a border even where nothing could leave; unless things come in again at the other side.
        let wraps =
            self.analysis.encounters().iter().any(|encounter| encounter.does(|deed| *deed == Deed::Wrap));
        let closed = self.palette.wall.is_some() && !wraps && grid.columns > 4 && grid.rows > 4;
        let ring = ring || (closed && family != Family::Field);
        let wall = layout::walls(family, grid, ring, loops, &mut layout);
        let mut builder = self.builder(Board::new(grid, wall), sampler);
        builder.adventure();
        Some(Made::plain(builder.board))
    }

    /// Walls for a puzzle of pushed things.
    fn puzzle_walls(&self, plan: &Jobs, grid: Grid, ring: bool, layout: &mut Sampler) -> Board {
        // Puzzles gain nothing from wide halls.
        let grid = Grid {
            columns: grid.columns.min(self.config.columns.0.max(9 + plan.jobs.len())),
            rows: grid.rows.min(self.config.rows.0.max(9)),
        };
        let barred = plan.is_barred();
        let families: &[Family] = if barred {
            &[Family::Rooms, Family::Rooms, Family::Arena]
        } else if plan.jobs.is_empty() {
            &[Family::Rooms, Family::Arena, Family::Rooms]
        } else {
            &[Family::Arena, Family::Cave, Family::Rooms, Family::Arena]
        };
        let family = *layout.choose(families);
        let loops = if barred { 0.0 } else { 0.4 };
        Board::new(grid, layout::walls(family, grid, ring, loops, layout))
    }

    /// A puzzle of pushed things, played through; None: this board does not work out.
    fn puzzle(&self, plan: &Jobs, mut builder: Builder<'_>, seed: Seed) -> Option<Made> {
        let ways = builder.warehouse(plan)?;
        let bare = self.play(&builder.board, &ways, plan.is_all, seed)?;
        let puzzle = builder.board.clone();
        builder.garnish(plan);
        if !self.analysis.is_deterministic() {
            return Some(Made { board: builder.board, solution: None, played: true });
        }
        let garnished = self.play(&builder.board, &ways, plan.is_all, seed);
        // If what came after the puzzle is in its way, the level does without; unless it only spoils the timing.
        let (board, actions) = match garnished {
            None if self.analysis.is_turn_based() => (puzzle, Some(bare)),
            actions => (builder.board, actions),
        };
        Some(Made { board, solution: actions.filter(|_| plan.is_all), played: true })
    }

    fn builder(&self, board: Board, sampler: Sampler) -> Builder<'_> {
        Builder {
            analysis: &self.analysis,
            palette: &self.palette,
            config: &self.config,
            sampler,
            board,
            log: Vec::new(),
        }
    }
}

impl Generator for ConstructiveLevels<'_> {
    type Output = Level;

    fn generate(&self, seed: Seed) -> Result<Level, GenerateError> {
        self.generate_solved(seed).map(|solved| solved.level)
    }
}
