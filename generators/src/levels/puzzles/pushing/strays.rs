//! Pushing puzzles on open boards among wandering deadly sprites. The player must plan the pushes ahead and look at the
//! board before walking.

use super::floor_plan::{FloorPlan, Position, Pushing, bit, each};
use super::lookout::{Lookout, Strays};
use super::rules::{Destination, KINDS, Rules};
use super::trail::Trail;
use crate::games::PushRules;
use crate::levels::grid::{ACTIONS, Grid, WAYS};
use crate::levels::palette::Palette;
use crate::levels::puzzles::fuse;
use base::{Sampler, Seed};
use engine::{Action, Analysis, Game, Level, SpriteType};

base::with_defaults! {
    /// The configuration of pushing puzzles among wandering deadly sprites.
    #[derive(Clone, Debug, PartialEq)]
    pub struct StrayConfig {
        /// The minimum and maximum number of columns.
        pub columns: (usize, usize) = (10, 11),
        /// The minimum and maximum number of rows, including the row of the fuse that limits the time. Without that
        /// row, a board can have at most 128 cells.
        pub rows: (usize, usize) = (11, 12),
        /// The range of win lengths, in actions, on the same board without wandering sprites. The upper end is
        /// exclusive.
        pub decisions: (usize, usize) = (50, 120),
        /// The minimum and maximum number of wandering deadly sprites. A level gets the largest number that keeps it
        /// fair.
        pub strays: (usize, usize) = (2, 10),
        /// The minimum fraction of episodes won by a simulated player that looks at the board before every action.
        pub fairness: f64 = 0.9,
        /// The commitments for which the simulated player's win rate is measured. A commitment is the number of ticks
        /// between two looks at the board.
        pub commitments: Vec<usize> = Vec::new(),
        /// The maximum number of boards to draw per level.
        pub boards: u64 = 400,
    }
}

/// The minimum side length of boards, in cells.
const LEAST_SIDE: usize = 7;
/// The fraction of the inner cells that are walls.
const WALLS: f64 = 0.08;
/// The fraction of the inner cells that are sills (cells that objects cannot enter), for rules with sills.
const SILLS: f64 = 0.05;
/// The approximate number of actions per pushed object.
const ACTIONS_EACH: usize = 15;
/// The minimum number of inner cells per pushed object, which limits the number of objects.
const ROOM: usize = 8;
/// The number of actions in a win per spare action that the fuse (the time limit) allows.
const SPARE: usize = 2;
/// The minimum distance between wandering sprites and the avatar at the start.
const AWAY: usize = 4;
/// The number of episodes played by the simulated player per fairness test.
const PLAYS: usize = 40;
/// The number of episodes played by the simulated player per measured commitment.
const MEASURED: usize = 200;

/// A pushing puzzle among wandering deadly sprites. Its text uses the level characters of [`PushRules::game`].
#[derive(Clone, Debug, PartialEq)]
pub struct StrayLevel {
    /// The level, as text.
    pub text: String,
    /// The actions that win if no wandering sprite gets in the way.
    pub solution: Vec<Action>,
    /// The fraction of episodes won by a simulated player, for each commitment in the configuration.
    pub chances: Vec<f64>,
    /// The level without wandering sprites.
    calm: Level,
    /// The cells of the wandering sprites.
    cells: Vec<usize>,
    /// The length of the fuse (the time limit) in cells, including the keg at its end.
    fuse: usize,
}

/// A level generator for the rules in [`PushRules::AMONG_STRAYS`], in which deadly sprites wander at random.
///
/// Boards are open, so that the avatar is not cornered for long. The solution pushes one object at a time, always the
/// one that takes the fewest steps. The wandering sprites pass over everything except walls. A simulated player follows
/// the solution and looks at the board before each action. Its win rate shows how often the level can be won.
pub struct StrayLevels {
    /// The game without wandering sprites.
    calm: Game,
    rules: Rules,
    config: StrayConfig,
}

impl StrayLevels {
    /// Creates a generator for rules with wandering deadly sprites.
    pub fn new(rules: PushRules, config: StrayConfig) -> StrayLevels {
        // Without the wandering sprites, all rules are valid rules of pushing puzzles, as a test verifies.
        let calm = rules.without_strays().game();
        let analysis = Analysis::of(&calm);
        let palette = Palette::of(&analysis).expect("an avatar can be placed");
        let rules = Rules::of(&analysis, &palette).expect("the game is won by pushing alone");
        StrayLevels { calm, rules, config }
    }

    /// Generates the level for a seed, by drawing boards until one meets the target. Returns `None` if all drawn boards
    /// miss the target, or if no board of the drawn size is possible. Cost: a millisecond per board, and up to a second
    /// more for each board that meets the rest of the target.
    pub fn level(&self, seed: Seed) -> Option<StrayLevel> {
        let mut sampler = seed.child("size", 0).sampler();
        let mut side = |(least, most): (usize, usize)| sampler.between(least, most.max(least));
        let (columns, rows) = (side(self.config.columns), side(self.config.rows));
        // The fuse has its own row.
        let grid = Grid { columns, rows: rows.saturating_sub(1) };
        if grid.columns.min(grid.rows) < LEAST_SIDE || grid.len() > super::floor_plan::MAX_CELLS {
            return None;
        }
        (0..self.config.boards).find_map(|draw| self.draw(grid, seed.child("board", draw)))
    }

    fn draw(&self, grid: Grid, seed: Seed) -> Option<StrayLevel> {
        let mut sampler = seed.sampler();
        let (floor_plan, start) = self.furnished(grid, &mut sampler)?;
        let pushing = Pushing { floor_plan: &floor_plan, rules: &self.rules };
        let ways = errands(&pushing, start)?;
        if !(self.config.decisions.0..self.config.decisions.1).contains(&ways.len()) {
            return None;
        }
        let fuse = (ways.len() + ways.len() / SPARE).div_ceil(PushRules::BURN);
        if fuse >= grid.columns {
            return None;
        }
        let solution: Vec<Action> = ways.into_iter().map(|way| ACTIONS[way]).collect();
        let calm = self.calm.level(&text(&floor_plan, &start)).ok()?;
        let mut lookout = self.lookout(&calm, &solution, Vec::new(), fuse)?;
        let is_bare = |cell: &usize| char::from(calm.cells()[*cell]) == PushRules::FLOOR;
        let is_far = |cell: &usize| grid.manhattan(lookout.start(), *cell) >= AWAY;
        let mut cells: Vec<usize> = (0..grid.len()).filter(is_bare).filter(is_far).collect();
        sampler.shuffle(&mut cells);
        let (least, most) = self.config.strays;
        let number = lookout.most_fair(&cells, least..=most, self.config.fairness, PLAYS, &mut sampler)?;
        cells.truncate(number);
        let rate = |&commit: &usize| lookout.rate(commit, MEASURED, &mut sampler);
        let chances = self.config.commitments.iter().map(rate).collect();
        Some(StrayLevel { text: among(&calm, &cells, fuse), solution, chances, calm, cells, fuse })
    }

    /// Draws a board with objects and targets.
    fn furnished(&self, grid: Grid, sampler: &mut Sampler) -> Option<(FloorPlan, Position)> {
        let mut is_floor: Vec<bool> = (0..grid.len()).map(|cell| !grid.on_border(cell)).collect();
        let inner = (grid.columns - 2) * (grid.rows - 2);
        let share = |share: f64| (inner as f64 * share).round() as usize;
        grid.wall_off(&mut is_floor, share(WALLS), sampler);
        let mut free: Vec<usize> = (0..grid.len()).filter(|&cell| is_floor[cell]).collect();
        sampler.shuffle(&mut free);
        let mut floor_plan = FloorPlan {
            grid,
            wall: (0..grid.len()).filter(|&cell| !is_floor[cell]).map(bit).sum(),
            targets: [0; KINDS],
            sills: 0,
            counts: [0; KINDS],
        };
        if self.rules.sill.is_some() {
            (0..share(SILLS)).filter_map(|_| free.pop()).for_each(|cell| floor_plan.sills |= bit(cell));
        }
        let things = self.config.decisions.0.div_ceil(ACTIONS_EACH).clamp(2, inner / ROOM);
        let kinds = self.rules.kinds.len();
        let mut start = Position::default();
        for thing in 0..things {
            let kind = thing % kinds;
            floor_plan.counts[kind] += 1;
            // All objects of a kind disappear into the same drain (a target that remains).
            if self.rules.destinations[kind] != Destination::Sink || thing < kinds {
                floor_plan.targets[kind] |= bit(free.pop()?);
            }
            // A thing in a corner could not be moved.
            let at = free.iter().rposition(|&cell| {
                let is_free = |way: usize| grid.shift(cell, WAYS[way]).is_some_and(|next| is_floor[next]);
                (0..WAYS.len()).all(is_free)
            })?;
            start.things[kind] |= bit(free.remove(at));
        }
        start.targets = floor_plan.targets;
        start.avatar = free.pop()? as u8;
        Some((floor_plan, start))
    }

    /// Wins a level from this generator, in any theme, by playing like the simulated player. `stray` is the type of the
    /// wandering sprites, and `seed` determines their moves. Returns `None` if the player loses with every patience
    /// setting.
    pub fn win(
        &self,
        made: &StrayLevel,
        (game, level): (&Game, &Level),
        stray: SpriteType,
        seed: Seed,
    ) -> Option<Vec<Action>> {
        let mut lookout = self.lookout(&made.calm, &made.solution, made.cells.clone(), made.fuse)?;
        lookout.win_game(game, level, stray, seed)
    }

    /// Returns the simulated player of a finished level, given its board without wandering sprites.
    pub(super) fn finished(
        &self,
        board: &str,
        win: &[Action],
        cells: Vec<usize>,
        fuse: usize,
    ) -> Option<Lookout> {
        self.lookout(&self.calm.level(board).ok()?, win, cells, fuse)
    }

    fn lookout(&self, calm: &Level, solution: &[Action], cells: Vec<usize>, fuse: usize) -> Option<Lookout> {
        let trail = Trail::of(&self.calm, calm, solution)?;
        let grid = Grid { columns: calm.columns(), rows: calm.rows() };
        let is_floor = calm.cells().iter().map(|&symbol| char::from(symbol) != PushRules::WALL).collect();
        Some(Lookout::new(
            Strays { grid, is_floor, cells, cooldown: PushRules::COOLDOWN },
            trail,
            // The keg explodes in the tick in which the last cell of the fuse burns down.
            PushRules::BURN * fuse - 1,
        ))
    }
}

/// Returns the steps that push one object after another to its destination, as indices into [`WAYS`]. The next object
/// is always the one that takes the fewest steps. Returns `None` if an object cannot reach its destination in this
/// order. Cost: O(objects² · cells²).
fn errands(pushing: &Pushing<'_>, start: Position) -> Option<Vec<usize>> {
    let (mut position, mut ways) = (start, Vec::new());
    loop {
        let things = (0..KINDS).flat_map(|kind| each(position.things[kind]).map(move |cell| (kind, cell)));
        let rests = |&(kind, cell): &(usize, usize)| {
            pushing.rules.destinations.get(kind) == Some(&Destination::Place)
                && position.targets[kind] & bit(cell) != 0
        };
        let left: Vec<(usize, usize)> = things.filter(|thing| !rests(thing)).collect();
        if left.is_empty() {
            return Some(ways);
        }
        let next = left.into_iter().filter_map(|thing| errand(pushing, position, thing));
        let (walk, after) = next.min_by_key(|(walk, _)| walk.len())?;
        ways.extend(walk);
        position = after;
    }
}

/// Returns the shortest sequence of steps that pushes one object to its destination while all other objects stay in
/// place, and the resulting position.
fn errand(
    pushing: &Pushing<'_>,
    start: Position,
    (kind, cell): (usize, usize),
) -> Option<(Vec<usize>, Position)> {
    let cells = pushing.floor_plan.grid.len();
    let others = start.things[kind] & !bit(cell);
    let mut seen = vec![false; cells * cells];
    seen[cell * cells + usize::from(start.avatar)] = true;
    // The positions found, each with the index of its predecessor and the step that led to it.
    let mut found: Vec<(Position, usize, usize)> = vec![(start, 0, 0)];
    let mut at = 0;
    while at < found.len() {
        let (position, ..) = found[at];
        for (way, stride) in pushing.strides().into_iter().enumerate() {
            let Some(after) = pushing.step(&position, stride) else { continue };
            let moved = after.things[kind] & !others;
            if after.things[1 - kind] != start.things[1 - kind] || after.things[kind] & others != others {
                continue;
            }
            let arrived = moved == 0 || moved & after.targets[kind] != 0;
            if arrived {
                let mut walk = vec![way];
                let mut back = at;
                while back > 0 {
                    walk.push(found[back].2);
                    back = found[back].1;
                }
                walk.reverse();
                return Some((walk, after));
            }
            let key = moved.trailing_zeros() as usize * cells + usize::from(after.avatar);
            if !std::mem::replace(&mut seen[key], true) {
                found.push((after, at, way));
            }
        }
        at += 1;
    }
    None
}

fn text(floor_plan: &FloorPlan, start: &Position) -> String {
    let symbol = |cell: usize| {
        let has = |cells: u128| cells & bit(cell) != 0;
        match () {
            () if has(floor_plan.wall) => PushRules::WALL,
            () if usize::from(start.avatar) == cell => PushRules::AVATAR,
            () if has(floor_plan.sills) => PushRules::SILL,
            () => {
                let thing =
                    (0..KINDS).find(|&kind| has(start.things[kind])).map(|kind| PushRules::THINGS[kind]);
                let target =
                    (0..KINDS).find(|&kind| has(start.targets[kind])).map(|kind| PushRules::TARGETS[kind]);
                thing.or(target).unwrap_or(PushRules::FLOOR)
            }
        }
    };
    rows((0..floor_plan.grid.len()).map(symbol).collect(), floor_plan.grid.columns)
}

/// Returns a level with wandering sprites on floor, and with a fuse of `length` cells above the board.
fn among(calm: &Level, strays: &[usize], length: usize) -> String {
    let mut cells: Vec<char> = calm.cells().iter().map(|&symbol| char::from(symbol)).collect();
    for &stray in strays {
        cells[stray] = PushRules::STRAY;
    }
    fuse::row(calm.columns(), length, &PushRules::FUSE_SYMBOLS) + &rows(cells, calm.columns())
}

fn rows(cells: Vec<char>, columns: usize) -> String {
    cells.chunks(columns).map(|row| row.iter().collect::<String>() + "\n").collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Levels can be won if no wandering sprite is in the way, and the simulated player's win rate is the same in the
    /// game as in the generator. This test covers one set of rules, or two in a sweep (`cargo xtask sweep`).
    #[test]
    fn plays_among_strays_agree_with_the_game() {
        const PLAYS: u64 = 40;
        let seed = Seed::from_text("strays");
        let sets = if std::env::var_os("ARCADE_SWEEP").is_some() { &[0, 3][..] } else { &[3] };
        for rules in sets.iter().map(|&at| PushRules::AMONG_STRAYS[at]) {
            let config =
                StrayConfig { decisions: (30, 60), commitments: vec![1, 10], ..StrayConfig::default() };
            let levels = StrayLevels::new(rules, config);
            let made = levels.level(seed.child(&rules.name(), 0)).unwrap();
            let [looking, blind] = made.chances[..] else { panic!("{:?}", made.chances) };
            assert!(looking > blind + 0.1, "{looking} {blind}");
            let game = rules.game();
            let level = game.level(&made.text).unwrap();
            let stray = game.sprite_types().find(|stype| game.name(*stype) == "stray").unwrap();
            let lookout = levels.lookout(&made.calm, &made.solution, made.cells.clone(), made.fuse).unwrap();
            let dice = |play: &u64| seed.child("dice", *play);
            let wins = (0..PLAYS).filter_map(|play| lookout.play_game(&game, &level, stray, 1, dice(&play)));
            let rate = wins.count() as f64 / PLAYS as f64;
            assert!((rate - looking).abs() < 0.2, "{rate} in the game, {looking} here");
        }
    }
}
