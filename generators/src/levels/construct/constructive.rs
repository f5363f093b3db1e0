//! The constructive level generator. It builds the walls, places sprites according to the types' roles, and then
//! inspects the result.

use super::board::Board;
use super::builder::Builder;
use super::jobs::Jobs;
use super::layout::{self, Family};
use super::plan::furnishable;
use crate::levels::config::LevelConfig;
use crate::levels::construct::furnish::crossing;
use crate::levels::examples::{Target, cover};
use crate::levels::grid::Grid;
use crate::levels::palette::Palette;
use crate::{GenerateError, Generator};
use base::{Sampler, Seed};
use engine::analysis::{Condition, EffectSummary, Goal, Motion, Reason, Role, Steering};
use engine::{Action, Analysis, Game, Level, SpriteType};

/// The number of boards to try for one seed.
const ATTEMPTS: u64 = 40;
/// The number of additional boards to try in order to meet the optional requirements. These are the fraction of
/// occupied cells, types that stand next to each other as in the examples, and a level that is not trivial.
const COVERS: u64 = 6;
/// The maximum total number of cells on all tried boards. Large boards take longer.
const PATIENCE: u64 = 2600;
/// The number of boards to try for a puzzle. If all of them fail, sprites are placed as in a level without a puzzle.
const PUZZLES: u64 = 30;

/// The rank of a board that meets all optional requirements.
const ALL: u32 = 0b1111;
/// The number of layouts to draw. The layout whose walls are most similar to the examples is used.
const LAYOUTS: usize = 2;
/// The maximum fraction of inner walls at which a board counts as intentionally bare.
const BARE: f64 = 0.02;

/// Generates levels for any game, with the roles of its sprite types derived from the rules.
///
/// Levels fit the game's LevelMapping and contain one avatar. No termination holds at the start. Everything that a win
/// needs can be reached on foot, by shooting, or through locks whose keys can be reached first. An idle player survives
/// the first ticks, if the game permits that at all. Pushing puzzles come with a solution that has been tested by
/// playing it.
///
/// Cost: about a millisecond for a typical level. The cost grows with the square of the number of cells.
pub struct ConstructiveLevels<'a> {
    pub(crate) game: &'a Game,
    pub(crate) analysis: Analysis,
    pub(crate) palette: Palette,
    pub(crate) config: LevelConfig,
}

/// A level with a winning sequence of actions, if the generator knows one.
#[derive(Clone, Debug)]
pub struct Solved {
    /// The generated level.
    pub level: Level,
    /// The actions that win the level; `None` except for pushing puzzles in deterministic games.
    pub solution: Option<Vec<Action>>,
}

/// A board with all sprites, and its solution.
pub(crate) struct Made {
    pub(crate) board: Board,
    /// The actions that win the level; `None` if the generator does not know any.
    solution: Option<Vec<Action>>,
    /// `true` if the board contains a puzzle whose solution has been tested by playing it.
    pub(crate) played: bool,
    /// The types that the level should contain according to the examples, if there are any.
    pub(crate) expected: Vec<SpriteType>,
}

impl Made {
    fn plain(builder: Builder<'_>) -> Made {
        let expected = builder.expected();
        Made { board: builder.board, solution: None, played: false, expected }
    }
}

impl<'a> ConstructiveLevels<'a> {
    /// Creates a generator for a game. Cost: one analysis.
    ///
    /// # Errors
    /// Returns [`GenerateError::Unsuitable`] in each of these cases:
    ///
    /// - The configuration is invalid.
    /// - No level can be won by playing, or every level is won by waiting.
    /// - No character places exactly one avatar.
    /// - A termination holds in every level that the LevelMapping can express.
    pub fn new(game: &'a Game, config: LevelConfig) -> Result<Self, GenerateError> {
        if let Some(problem) = config.problem() {
            return Err(GenerateError::Unsuitable(problem));
        }
        let analysis = Analysis::of(game);
        if !analysis.can_win() {
            let problem = "no winning termination can hold during play, in any level".to_owned();
            return Err(GenerateError::Unsuitable(problem));
        }
        let waits = |goal: &Goal| !goal.win || matches!(goal.condition, Condition::Tick(_));
        if !analysis.can_lose() && analysis.goals().iter().all(waits) {
            let problem = "every level is won by waiting: nothing in the rules can prevent it".to_owned();
            return Err(GenerateError::Unsuitable(problem));
        }
        let base = config.like.as_ref().and_then(|examples| examples.base);
        let palette = match base {
            Some(base) => Palette::on(&analysis, base),
            None => Palette::of(&analysis),
        };
        let Some(palette) = palette else {
            let problem = "no level character places exactly one avatar".to_owned();
            return Err(GenerateError::Unsuitable(problem));
        };
        if let Some(problem) = unmet_count(&analysis, &palette, &config) {
            return Err(GenerateError::Unsuitable(problem));
        }
        for requirement in analysis.requirements() {
            let placed = |stype: &SpriteType| palette.symbol(*stype).is_some();
            let met = requirement.at_least == 0 || requirement.types.iter().any(placed);
            let room = config.columns.1 * config.rows.1;
            let met = met && requirement.at_least as usize <= room;
            if let (Reason::Goal(at), false) = (requirement.reason, met) {
                let number = analysis.goals()[at].line + 1;
                let problem = format!(
                    "termination {number} of the game holds before the first tick of every level of the \
                     requested size"
                );
                return Err(GenerateError::Unsuitable(problem));
            }
        }
        Ok(ConstructiveLevels { game, analysis, palette, config })
    }

    /// Returns the game's analysis.
    pub fn analysis(&self) -> &Analysis {
        &self.analysis
    }

    /// Generates the level for a seed, with its solution if the generator knows one.
    ///
    /// # Errors
    /// Returns [`GenerateError::Unlucky`] if every attempted board has a fault.
    pub fn generate_solved(&self, seed: Seed) -> Result<Solved, GenerateError> {
        // The best board so far, ranked by the optional requirements that it meets.
        let mut second_best: Option<(u32, Solved)> = None;
        let mut tried = 0;
        let mut fault = "no board could be filled with the required sprites".to_owned();
        for attempt in 0..ATTEMPTS {
            let seed = seed.child("board", attempt);
            let Some(made) = self.attempt(seed, attempt) else { continue };
            match self.inspect(&made, seed) {
                Ok((level, survivable)) => {
                    let covered = self
                        .config
                        .cover
                        .is_none_or(|(low, high)| (low..=high).contains(&cover(&self.analysis, &level)));
                    let cells = level.cells().len() as u64;
                    let has_companions = self.has_companions(&made)
                        && (self.config.like.is_none() || self.chasers_reach_targets(&made.board));
                    let trivial = self.config.like.is_some() && self.is_trivial(&level, seed);
                    let solved = Solved { level, solution: made.solution };
                    // The most important requirement comes first.
                    let rank = [survivable, covered, !trivial, has_companions];
                    let rank = rank.into_iter().fold(0, |rank, met| 2 * rank + u32::from(met));
                    if rank == ALL {
                        return Ok(solved);
                    }
                    if second_best.as_ref().is_none_or(|(best, _)| rank > *best) {
                        second_best = Some((rank, solved));
                    }
                    // Stop early, because a requirement that several boards have failed to meet is unlikely to be met.
                    tried += u64::from(survivable);
                    if tried > COVERS || tried * cells > PATIENCE {
                        break;
                    }
                }
                Err(problem) => fault = problem,
            }
        }
        second_best.map(|(_, solved)| solved).ok_or(GenerateError::Unlucky(fault))
    }

    /// Builds one board with all sprites.
    fn attempt(&self, seed: Seed, attempt: u64) -> Option<Made> {
        let mut layout = seed.child("layout", 0).sampler();
        let examples = self.config.like.as_deref();
        let target =
            examples.map(|examples| examples.draw(self.config.columns, self.config.rows, &mut layout));
        let mut grid = target.as_ref().map_or_else(|| self.size(&mut layout), |target| target.grid);
        let sampler = seed.child("furniture", 0).sampler();
        let ring = examples.map_or(self.palette.ring, |examples| examples.closed)
            && grid.columns > 4
            && grid.rows > 4;
        let steering = self.analysis.start_avatar()?.steering;
        if matches!(steering, Steering::Horizontal | Steering::Vertical) {
            let wall = layout::walls(Family::Field, grid, ring, 0.0, &mut layout);
            let mut builder = self.builder(Board::new(grid, wall), sampler, target);
            builder.gallery(steering, ring);
            builder.adjust_cover();
            return Some(Made::plain(builder));
        }
        if attempt < PUZZLES {
            let mut sampler = seed.child("puzzle", 0).sampler();
            let border = if ring { 2 * (grid.columns + grid.rows) } else { 0 };
            let difficulty = self.config.difficulty;
            let inner = grid.len().saturating_sub(border);
            if let Some(plan) = Jobs::draw(
                &self.analysis,
                &self.palette,
                inner,
                difficulty,
                &self.config.counts,
                &mut sampler,
            ) {
                let board = self.puzzle_walls(&plan, grid, ring, target.as_ref(), &mut layout);
                return self.puzzle(&plan, self.builder(board, sampler, target), seed);
            }
        }
        if grid.rows >= 6
            && self.crosses()
            && let Some(traffic) = crossing::traffic(&self.analysis, &self.palette)
        {
            let closed = self.palette.wall.is_some();
            let mut builder = self.builder(Board::new(grid, vec![false; grid.len()]), sampler, target);
            let rows = builder.rows(grid, closed, &traffic);
            builder.board = Board::new(grid, Builder::lane_walls(grid, &rows, closed, &traffic));
            builder.crossing(&rows, &traffic);
            builder.adjust_cover();
            return Some(Made::plain(builder));
        }
        let mut family = self.family(&mut layout);
        if family == Family::Maze && grid.columns.min(grid.rows) < 7 {
            family = Family::Arena;
        }
        if family == Family::Maze && target.is_none() {
            // Mazes need odd sides.
            grid.columns -= usize::from(grid.columns & 1 == 0 && grid.columns > self.config.columns.0);
            grid.rows -= usize::from(grid.rows & 1 == 0 && grid.rows > self.config.rows.0);
        }
        // If something chases the avatar, the avatar's survival depends on alternative routes.
        let chased = furnishable(&self.analysis, &self.palette, Role::Enemy)
            .into_iter()
            .any(|stype| matches!(self.analysis.facts(stype).motion, Motion::Chasing(_)));
        let loops =
            if chased { 0.8 - 0.3 * self.config.difficulty } else { 0.5 - 0.5 * self.config.difficulty };
        // Closed layouts have a border even if no sprite could leave the board, unless sprites wrap around to the other
        // side.
        let wraps = self
            .analysis
            .encounters()
            .iter()
            .any(|encounter| encounter.does(|effect| *effect == EffectSummary::Wrap));
        let closed = self.palette.wall.is_some() && !wraps && grid.columns > 4 && grid.rows > 4;
        let ring = ring || (closed && family != Family::Field && target.is_none());
        let wall = match &target {
            Some(target) => self.walls_like(target, ring, loops, &mut layout),
            None => layout::walls(family, grid, ring, loops, &mut layout),
        };
        let mut builder = self.builder(Board::new(grid, wall), sampler, target);
        if builder.board.area() == 0 {
            return None;
        }
        builder.adventure();
        builder.adjust_cover();
        Some(Made::plain(builder))
    }

    /// Returns `true` if the exits are above the avatar in the examples, or if there are no examples.
    fn crosses(&self) -> bool {
        let exits = furnishable(&self.analysis, &self.palette, Role::Exit);
        let avatar = self.palette.avatars[0].0;
        self.config
            .like
            .as_ref()
            .is_none_or(|examples| exits.iter().all(|&exit| examples.is_below(avatar, exit)))
    }

    fn size(&self, layout: &mut Sampler) -> Grid {
        Grid {
            columns: layout.between(self.config.columns.0, self.config.columns.1),
            rows: layout.between(self.config.rows.0, self.config.rows.1),
        }
    }

    /// Draws walls similar to those in the examples. They are assembled from windows of the examples, or come from a
    /// layout family that suits the game and has a similar number of walls.
    fn walls_like(&self, target: &Target, ring: bool, loops: f64, layout: &mut Sampler) -> Vec<bool> {
        let grid = target.grid;
        let patterns = self.config.like.as_deref().map(|examples| &examples.patterns);
        let patterns = patterns.filter(|patterns| patterns.has_structure());
        let draw = |at: usize, layout: &mut Sampler| {
            let learnt = patterns.filter(|_| at == 0);
            let learnt = learnt.and_then(|patterns| layout::learnt(patterns, grid, layout));
            learnt.unwrap_or_else(|| {
                let family = match self.family(layout) {
                    _ if target.walls < BARE || self.palette.wall.is_none() => Family::Field,
                    Family::Maze if grid.columns.min(grid.rows) < 7 => Family::Arena,
                    family => family,
                };
                layout::walls(family, grid, ring, loops, layout)
            })
        };
        // Prefer layouts with the requested number of walls whose windows could occur in the examples.
        let off = |wall: &Vec<bool>| {
            let strange = patterns.map_or(0.0, |patterns| 1.0 - patterns.familiar(grid, wall));
            let inner = || (0..grid.len()).filter(|&cell| !grid.on_border(cell));
            let wanted = (target.walls * inner().count() as f64) as usize;
            let off = inner().filter(|&cell| wall[cell]).count().abs_diff(wanted) as f64;
            ((strange + 0.5 * off / inner().count().max(1) as f64) * 1e6) as u64
        };
        let drawn = (0..LAYOUTS).map(|at| draw(at, layout)).collect::<Vec<_>>();
        let mut wall = drawn.into_iter().min_by_key(off).expect("at least one layout is drawn");
        if self.config.like.as_deref().is_some_and(|examples| examples.draw_mirrored(layout)) {
            layout::mirror(grid, &mut wall);
        }
        if self.palette.wall.is_some() {
            layout::adjust(grid, target.walls, layout, &mut wall);
        }
        wall
    }

    /// Draws the walls for a pushing puzzle.
    fn puzzle_walls(
        &self,
        plan: &Jobs,
        grid: Grid,
        ring: bool,
        target: Option<&Target>,
        layout: &mut Sampler,
    ) -> Board {
        if let Some(target) = target {
            let loops = if plan.is_barred() { 0.0 } else { 0.4 };
            return Board::new(grid, self.walls_like(target, ring, loops, layout));
        }
        // Puzzles do not benefit from wide halls.
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

    /// Creates a pushing puzzle and plays its solution. Returns `None` if no puzzle fits the board, or if the solution
    /// fails.
    fn puzzle(&self, plan: &Jobs, mut builder: Builder<'_>, seed: Seed) -> Option<Made> {
        let ways = builder.warehouse(plan)?;
        let bare = self.play(&builder.board, &ways, plan.is_all, seed)?;
        let puzzle = builder.board.clone();
        builder.furnish_rest(plan);
        builder.adjust_cover();
        let expected = builder.expected();
        if !self.analysis.is_deterministic() {
            return Some(Made { board: builder.board, solution: None, played: true, expected });
        }
        let furnished = self.play(&builder.board, &ways, plan.is_all, seed);
        // If later furniture breaks the solution of a turn-based game, the furniture is omitted. In other games, it
        // stays, because it may only have changed the timing.
        let (board, actions) = match furnished {
            None if self.analysis.is_turn_based() => (puzzle, Some(bare)),
            actions => (builder.board, actions),
        };
        Some(Made { board, solution: actions.filter(|_| plan.is_all), played: true, expected })
    }

    fn builder(&self, board: Board, sampler: Sampler, target: Option<Target>) -> Builder<'_> {
        Builder {
            analysis: &self.analysis,
            palette: &self.palette,
            config: &self.config,
            sampler,
            board,
            log: Vec::new(),
            target,
        }
    }
}

/// Describes a requested number of sprites that no level can contain; `None` if all requested numbers are possible.
fn unmet_count(analysis: &Analysis, palette: &Palette, config: &LevelConfig) -> Option<String> {
    let room = config.columns.1 * config.rows.1;
    let sum: usize = config.counts.iter().fold(0, |sum, (_, count)| sum.saturating_add(*count));
    if sum > room {
        return Some(format!("{sum} sprites requested, but a level has at most {room} cells"));
    }
    config.counts.iter().find_map(|&(stype, count)| {
        let name = analysis.game().name(stype);
        if analysis.role(stype) == Role::Avatar {
            return (count != 1)
                .then(|| format!("{count} of `{name}` requested, but a level has exactly one avatar"));
        }
        let lies = palette.symbol(stype).is_some();
        (count > 0 && !lies)
            .then(|| format!("{count} of `{name}` requested, but no level character places it alone"))
    })
}

impl Generator for ConstructiveLevels<'_> {
    type Output = Level;

    fn generate(&self, seed: Seed) -> Result<Level, GenerateError> {
        self.generate_solved(seed).map(|solved| solved.level)
    }
}
