//! Pushing puzzles as search candidates.

use super::floor::{self, FloorPlans};
use super::floor_plan::{Cells, FloorPlan, MAX_CELLS, Position, Pushing, bit, each};
use super::rules::{KINDS, Rules};
use crate::levels::config::LevelConfig;
use crate::levels::construct::board::Board;
use crate::levels::construct::builder::Builder;
use crate::levels::construct::constructive::{ConstructiveLevels, Solved};
use crate::levels::construct::jobs::Jobs;
use crate::levels::grid::Grid;
use crate::{Annealing, AnnealingConfig, GenerateError, Search, Variation};
use base::{Sampler, Seed};
use engine::{Game, Level, SpriteType};

/// The maximum number of positions to search per floor plan when creating its level.
const MAX_POSITIONS: usize = 400_000;
/// The maximum number of positions to search for the one that takes the avatar the most steps. Here, positions also
/// differ by the avatar's cell. If there are more positions, an arbitrary one is used.
const MAX_STEPS: usize = 250_000;
/// The approximate total number of positions to search per level. If floor plans have many positions, fewer floor plans
/// are rated.
const POSITIONS: usize = 1_200_000;
/// The number of floor plans to request at a time. They are then rated one by one.
const BATCH: usize = 8;
/// The number of attempts to turn floor plans into a level before generation fails for the seed.
const ATTEMPTS: u64 = 4;
/// The number of changed floor plans from which a mutation selects the best.
const CHANGES: usize = 6;

base::with_defaults! {
    /// The configuration for pushing puzzles.
    #[derive(Clone, Debug, PartialEq)]
    pub struct PuzzleConfig {
        /// The number of pushable objects. If `None`, the number comes from [`LevelConfig::counts`]. If that does not
        /// contain it either, the number is at least two and depends on the difficulty and the available room. With a
        /// target and more than three objects, a floor plan takes up to several seconds and 500 MB.
        pub things: Option<usize> = None,
        /// The maximum number of floor plans to examine per level.
        pub floor_plans: usize = 600,
        /// The range of the level's distance from its solution, as a fraction of the longest distance. Distances at the
        /// lower end are more likely. If `None`, the range is derived from [`LevelConfig::difficulty`].
        pub way: Option<(f64, f64)> = None,
        /// The minimum requirements for a level. If they are set, floor plans are searched until one meets them, and
        /// more positions are examined per plan.
        pub target: Option<PuzzleTarget> = None,
    }
}

/// The minimum requirements for a puzzle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PuzzleTarget {
    /// The minimum number of pushes in any win.
    pub pushes: usize,
    /// The minimum number of actions in the solution with the fewest pushes.
    pub decisions: usize,
}

/// The maximum number of positions per floor plan, if the search has a target and up to [`DEEP_THINGS`] objects.
const DEEP_POSITIONS: usize = 150_000;
/// The maximum total number of positions, if the search has a target and up to [`DEEP_THINGS`] objects.
const DEEP_SEARCH: usize = 150_000_000;
/// The maximum number of positions per floor plan, if the search has a target and more than [`DEEP_THINGS`] objects.
const VAST_POSITIONS: usize = 3_000_000;
/// The maximum total number of positions, if the search has a target and more than [`DEEP_THINGS`] objects.
const VAST_SEARCH: usize = 1_500_000_000;
/// The default number of objects in a puzzle with a target. It is also the maximum number of objects to which the lower
/// limits apply.
const DEEP_THINGS: usize = 3;
/// The number of additional pushes that a floor plan must have after an earlier one had enough pushes but too few
/// actions.
const RAISE: usize = 3;

/// Levels for games that are won by pushing objects to their destinations (Sokoban and its relatives).
///
/// Simulated annealing optimises the floor plan for the number of pushes that its farthest position requires. That
/// number is exact, because all positions are searched backwards from all solved positions (Taylor and Parberry 2011,
/// "Procedural generation of Sokoban levels"). Among the farthest positions, the one that takes the avatar the most
/// steps becomes the level. Each level has been won in the game itself.
///
/// Cost: about a tenth of a millisecond per 8×8 floor plan with three objects. A level takes at most about a second,
/// because the number of positions to search is limited.
pub struct PuzzleVariation<'a> {
    levels: ConstructiveLevels<'a>,
    rules: Rules,
    config: LevelConfig,
    puzzle: PuzzleConfig,
}

impl<'a> PuzzleVariation<'a> {
    /// Creates a variation for a game. Costs about as much as generating a few small puzzles.
    ///
    /// # Errors
    /// Returns [`GenerateError::Unsuitable`] with the reason if the game is not won by pushing alone, or if no board of
    /// the requested size is small enough to search. Also returns the errors of [`ConstructiveLevels::new`].
    pub fn new(
        game: &'a Game,
        config: LevelConfig,
        puzzle: PuzzleConfig,
    ) -> Result<PuzzleVariation<'a>, GenerateError> {
        let levels = ConstructiveLevels::new(game, config.clone())?;
        let unsuitable = |why: &str| Err(GenerateError::Unsuitable(why.to_owned()));
        let rules = Rules::of(&levels.analysis, &levels.palette)?;
        let (columns, rows) = (config.columns.0, config.rows.0);
        if columns * rows > MAX_CELLS || columns.max(rows) > config.columns.1.max(config.rows.1) {
            return unsuitable("the board is too large for a backward search");
        }
        if config.columns.1.min(config.rows.1) < 6 {
            return unsuitable("the board is too small for a push");
        }
        if puzzle.things == Some(0) || puzzle.floor_plans == 0 {
            return unsuitable("a puzzle needs at least one sprite to push and one floor plan");
        }
        if puzzle.way.is_some_and(|(from, to)| !(0.0..=to).contains(&from) || to > 1.0) {
            return unsuitable("the fraction of the solution must be between 0 and 1, in ascending order");
        }
        let variation = PuzzleVariation { levels, rules, config, puzzle };
        let trial = |index: u64| variation.made(Seed::from_text("trial").child("puzzle", index), BATCH, None);
        if (0..ATTEMPTS).all(|index| trial(index).is_none()) {
            return unsuitable("no trial puzzle could be won by pushing");
        }
        Ok(variation)
    }

    /// Returns the constructive generator for the game, with its analysis.
    pub fn constructive(&self) -> &ConstructiveLevels<'a> {
        &self.levels
    }

    /// Generates the level for a seed, with a winning sequence of actions. The sequence uses the minimum number of
    /// pushes, but not always the minimum number of actions. Returns `None` if no level is found or none meets the
    /// target.
    pub fn create_solved(&self, seed: Seed) -> Option<Solved> {
        if self.puzzle.target.is_some() {
            return self.made(seed, self.puzzle.floor_plans, self.puzzle.target);
        }
        (0..ATTEMPTS)
            .find_map(|attempt| self.made(seed.child("attempt", attempt), self.puzzle.floor_plans, None))
    }

    fn made(&self, seed: Seed, floor_plans: usize, target: Option<PuzzleTarget>) -> Option<Solved> {
        let mut sampler = seed.child("size", 0).sampler();
        let mut side = |(low, high): (usize, usize)| {
            let low = low.max(6).min(high);
            if target.is_some() {
                return sampler.between(low, high);
            }
            // Puzzles do not benefit from wide halls.
            sampler.between(low, high.min(low.max(9)))
        };
        let grid = Grid { columns: side(self.config.columns), rows: side(self.config.rows) };
        if grid.len() > MAX_CELLS {
            return None;
        }
        let inner = (grid.columns - 2) * (grid.rows - 2);
        let usual =
            2 + crate::levels::construct::plan::round(0.2 + 2.0 * self.config.difficulty, &mut sampler);
        let of_kind = |(stype, _): &&(SpriteType, usize)| self.rules.kinds.contains(stype);
        let asked: usize = self.config.counts.iter().filter(of_kind).map(|(_, count)| count).sum();
        let asked = self.puzzle.things.or((asked > 0).then_some(asked));
        let usual = if self.puzzle.target.is_some() { DEEP_THINGS } else { usual.min(inner / 10).max(2) };
        let floors = self.floors(grid, FloorPlans::counts_of(&self.rules, asked.unwrap_or(usual)));
        if let Some(target) = target {
            return self.deep(&floors, target, floor_plans, seed);
        }
        let floor_plan = anneal(&floors, floor_plans, seed.child("floor plans", 0))?;
        self.level_of(&floors.tidy(&floor_plan), seed)
    }

    fn floors(&self, grid: Grid, counts: [usize; KINDS]) -> FloorPlans<'_> {
        let is_deep = self.puzzle.target.is_some();
        let most_positions = if is_deep { deep(counts).0 } else { floor::MAX_POSITIONS };
        FloorPlans { rules: &self.rules, grid, counts, most_positions, sills: is_deep }
    }

    /// Anneals floor plans until a resulting level meets the target.
    fn deep(
        &self,
        floors: &FloorPlans<'_>,
        target: PuzzleTarget,
        floor_plans: usize,
        seed: Seed,
    ) -> Option<Solved> {
        let most = deep(floors.counts).1;
        let mut search = annealing(floors, floor_plans, most, seed.child("floor plans", 0));
        let mut least = target.pushes;
        loop {
            let plans = search.ask(BATCH);
            if plans.is_empty() {
                return None;
            }
            for plan in plans {
                let rated = floors.rate(&plan);
                let is_far = floors.is_at_least(&rated, least);
                let level = is_far.then(|| self.level_of(&floors.tidy(&plan), seed)).flatten();
                let enough = |solved: &Solved| {
                    solved.solution.as_ref().is_some_and(|win| win.len() >= target.decisions)
                };
                match level {
                    Some(solved) if enough(&solved) => return Some(solved),
                    _ if is_far => least += RAISE,
                    _ => {}
                }
                search.tell(vec![(plan, rated)]);
            }
        }
    }

    /// Creates a level from a floor plan's farthest position.
    fn level_of(&self, floor_plan: &FloorPlan, seed: Seed) -> Option<Solved> {
        let pushing = Pushing { floor_plan, rules: &self.rules };
        let is_deep = self.puzzle.target.is_some();
        let most = if is_deep { 2 * deep(floor_plan.counts).0 } else { MAX_POSITIONS };
        let searched = pushing.by_pushes(most);
        let starts = || searched.iter().filter(|(position, _)| pushing.is_start(position));
        let most = starts().map(|(_, pushes)| pushes).max()?;
        // Easy levels start closer to the solution.
        let share = match self.puzzle.way {
            Some((from, to)) => {
                let drawn = seed.child("way", 0).sampler().unit();
                from + (to - from) * drawn * drawn
            }
            None if is_deep => 1.0,
            None => (0.3 + 1.4 * self.config.difficulty).min(1.0),
        };
        let least = (most as f64 * share) as usize;
        let wanted = starts().map(|(_, pushes)| pushes).filter(|&pushes| pushes >= least).min()?;
        let far = starts().filter(|(_, pushes)| *pushes == wanted);
        let steps = pushing.by_steps(MAX_STEPS);
        let stands = far.flat_map(|(position, _)| {
            let region = pushing.flood(bit(position.avatar.into()), pushing.stands(position));
            let clear = region & !position.all_targets();
            let clear = if clear == 0 { region } else { clear };
            each(clear).map(|avatar| Position { avatar: avatar as u8, ..*position })
        });
        // If the search for steps was cut short, any position is used.
        let start = stands.max_by_key(|start| (steps.distance(start), std::cmp::Reverse(start.avatar)))?;
        let ways = pushing.solution(&searched, start)?;
        self.furnish(floor_plan, &start, &ways, seed)
    }

    /// Puts a position on a board and adds the game's other sprites, if the level remains winnable.
    fn furnish(
        &self,
        floor_plan: &FloorPlan,
        start: &Position,
        ways: &[(i32, i32)],
        seed: Seed,
    ) -> Option<Solved> {
        let wall = (0..floor_plan.grid.len()).map(|cell| floor_plan.wall & bit(cell) != 0).collect();
        let mut builder = Builder {
            analysis: &self.levels.analysis,
            palette: &self.levels.palette,
            config: &self.config,
            sampler: seed.child("furniture", 0).sampler(),
            board: Board::new(floor_plan.grid, wall),
            log: Vec::new(),
            target: None,
        };
        for (kind, target) in self.rules.targets.iter().enumerate() {
            if let Some(target) = *target {
                each(start.targets[kind]).for_each(|cell| builder.put(cell, target));
            }
        }
        if let Some(sill) = self.rules.sill {
            each(floor_plan.sills).for_each(|cell| builder.put(cell, sill));
        }
        for (kind, &stype) in self.rules.kinds.iter().enumerate() {
            each(start.things[kind]).for_each(|cell| builder.put(cell, stype));
        }
        builder.put_avatar(start.avatar.into());
        let solved = |board: &Board| {
            let solution = self.levels.play(board, ways, true, seed)?;
            let level = self.levels.game.level(&board.text(&self.levels.palette)).ok()?;
            Some(Solved { level, solution: Some(solution) })
        };
        let bare = solved(&builder.board)?;
        let mut cell = usize::from(start.avatar);
        for &way in ways {
            cell = floor_plan.grid.shift(cell, way)?;
            for used in [Some(cell), floor_plan.grid.shift(cell, way)].into_iter().flatten() {
                builder.board.kept[used] = true;
            }
        }
        builder.furnish_rest(&Jobs::default());
        Some(solved(&builder.board).unwrap_or(bare))
    }

    /// Returns a level's floor plan; `None` if the level is not a puzzle of this kind.
    fn floor_plan_of(&self, level: &Level) -> Option<FloorPlan> {
        let grid = Grid { columns: level.columns(), rows: level.rows() };
        if grid.len() > MAX_CELLS {
            return None;
        }
        let wall = self.levels.palette.wall?;
        let mut floor_plan = FloorPlan { grid, wall: 0, targets: [0; KINDS], sills: 0, counts: [0; KINDS] };
        for (cell, &symbol) in level.cells().iter().enumerate() {
            let places = self.levels.game.places(symbol);
            if symbol == wall {
                floor_plan.wall |= bit(cell);
            }
            let has = |stype: Option<SpriteType>| stype.is_some_and(|stype| places.contains(&stype));
            if self.puzzle.target.is_some() && has(self.rules.sill) {
                floor_plan.sills |= bit(cell);
            }
            for (kind, stype) in self.rules.kinds.iter().enumerate() {
                if has(self.rules.targets[kind]) {
                    floor_plan.targets[kind] |= bit(cell);
                }
                floor_plan.counts[kind] += usize::from(places.contains(stype));
            }
        }
        let border: Cells = (0..grid.len()).filter(|&cell| grid.on_border(cell)).map(bit).sum();
        (floor_plan.wall & border == border && floor_plan.counts[0] > 0).then_some(floor_plan)
    }

    /// Rates a few floor plans and creates a level from the best one.
    fn best(
        &self,
        parent: &FloorPlan,
        sampler: &mut Sampler,
        plan: impl Fn(&FloorPlans<'_>, &mut Sampler) -> FloorPlan,
    ) -> Option<Level> {
        let floors = self.floors(parent.grid, parent.counts);
        let plans = (0..CHANGES).map(|_| plan(&floors, sampler)).filter(|plan| plan != parent);
        let rated: Vec<(f64, FloorPlan)> = plans.map(|plan| (floors.rate(&plan).objective, plan)).collect();
        // Among equally good plans, the first is used.
        let best = rated.into_iter().reduce(|best, next| if next.0 > best.0 { next } else { best })?;
        let seed = Seed::from_text("mutation").child("draw", sampler.bits());
        self.level_of(&best.1, seed).map(|solved| solved.level)
    }
}

impl Variation for PuzzleVariation<'_> {
    type Candidate = Level;

    fn create(&self, seed: Seed) -> Option<Level> {
        self.create_solved(seed).map(|solved| solved.level)
    }

    /// Creates a level from the best of a few changes to the parent's floor plan. Returns the parent itself on failure.
    fn mutate(&self, parent: &Level, sampler: &mut Sampler) -> Level {
        let varied = self.floor_plan_of(parent).and_then(|floor_plan| {
            (0..ATTEMPTS).find_map(|_| {
                self.best(&floor_plan, sampler, |floors, sampler| floors.mutate(&floor_plan, sampler))
            })
        });
        varied.unwrap_or_else(|| parent.clone())
    }

    /// Creates a level from halves of two floor plans, with a small change. Mutates the first level if the halves do
    /// not fit together.
    fn cross(&self, one: &Level, two: &Level, sampler: &mut Sampler) -> Level {
        let (first, second) = (self.floor_plan_of(one), self.floor_plan_of(two));
        let fit = first
            .zip(second)
            .filter(|(first, second)| (first.grid, first.counts) == (second.grid, second.counts));
        let crossed = fit.and_then(|(first, second)| {
            self.best(&first, sampler, |floors, sampler| {
                let child = floors.cross(&first, &second, sampler);
                floors.mutate(&child, sampler)
            })
        });
        crossed.unwrap_or_else(|| self.mutate(one, sampler))
    }
}

/// Returns the limits of a search that has a target, for the given numbers of objects: the number of positions per
/// floor plan, and in total.
fn deep(counts: [usize; KINDS]) -> (usize, usize) {
    match counts.iter().sum::<usize>() {
        ..=DEEP_THINGS => (DEEP_POSITIONS, DEEP_SEARCH),
        _ => (VAST_POSITIONS, VAST_SEARCH),
    }
}

/// Returns the best of `floor_plans` floor plans.
fn anneal(floors: &FloorPlans<'_>, floor_plans: usize, seed: Seed) -> Option<FloorPlan> {
    let mut search = annealing(floors, floor_plans, POSITIONS, seed);
    loop {
        let plans = search.ask(BATCH);
        if plans.is_empty() {
            let best = search.best().filter(|(_, evaluation)| evaluation.is_feasible());
            return best.map(|(floor_plan, _)| floor_plan.clone());
        }
        search.tell(plans.into_iter().map(|plan| (plan.clone(), floors.rate(&plan))).collect());
    }
}

/// Creates a search over `floor_plans` floor plans, or fewer if they would have more than `most` positions in total.
fn annealing<'a, 'b>(
    floors: &'a FloorPlans<'b>,
    floor_plans: usize,
    most: usize,
    seed: Seed,
) -> Annealing<&'a FloorPlans<'b>> {
    let samples: Vec<FloorPlan> = (0..4).filter_map(|at| floors.create(seed.child("sample", at))).collect();
    let positions: usize = samples.iter().map(|floor_plan| floors.positions(floor_plan)).sum();
    let affordable = most * samples.len() / positions.max(1);
    let config = AnnealingConfig::of(floor_plans.min(affordable.max(BATCH)));
    Annealing::new(floors, config, seed)
}
