//! Static measures of levels, computed without playing.

use super::grid::{FAR, Grid};
use super::palette::{Palette, Walk};
use super::symmetry::{LevelSimilarity, Mirror};
use engine::analysis::{Harm, Motion, Role};
use engine::{Analysis, Level};

/// The amount at which a saturating measure reaches half of its maximum. It is a number of goal sprites, or of enemies
/// with full weight next to the avatar.
const HALF: f64 = 4.0;
/// The number of steps at which nearness is half of its maximum.
const NEAR: f64 = 4.0;

base::named_enum! {
    /// A static measure of a level, from 0.0 to 1.0. A fraction with a zero denominator counts as 0.0.
    pub enum LevelMeasure {
        /// The fraction of cells that are neither empty nor ground.
        Cover = "cover",
        /// The fraction of cells that the initial avatar can never enter or clear.
        Walls = "walls",
        /// The mean number of open neighbours of the cells reachable on foot, divided by four. Locks count as open, and
        /// deadly cells do not.
        Openness = "openness",
        /// The distance, in steps, to the farthest cell reachable on foot, as a fraction of the number of reachable
        /// cells. The value is 1.0 in a single corridor and small in a hall.
        Linearity = "linearity",
        /// The nearness of harm, as s / (s + 4). Each cell with a harmful sprite contributes the mean of two terms to
        /// s. The first term is 4 / (4 + d) for the cell's Manhattan distance d to the avatar. The second term is the
        /// same for the distance to the nearest goal sprite, or for the avatar again if there is no goal sprite.
        /// Stationary sprites that do not spawn others count half.
        Pressure = "enemy pressure",
        /// The number of goal sprites, as n / (n + 4). Here, n is the number of cells with an exit, or with sprites
        /// that must be removed or protected to win.
        Goals = "goal things",
        /// The left-right symmetry: 1.0 minus the distance ([`LevelSimilarity::distance`]) between the level and its
        /// mirror image, without other symmetries.
        LeftRight = "left-right symmetry",
        /// The up-down symmetry, computed like the left-right symmetry.
        UpDown = "up-down symmetry",
        /// The fraction of walls without an adjacent wall, not counting the border. The value is high if walls are
        /// scattered rather than built.
        Sprinkle = "sprinkle",
    }
}

/// A calculator for the measures of one game's levels.
#[derive(Clone, Debug)]
pub struct LevelMeasures {
    similarity: LevelSimilarity,
    /// The properties of each character.
    marks: Vec<Mark>,
}

/// The properties of a character, as used by the measures.
#[derive(Clone, Copy, Debug, Default)]
struct Mark {
    is_avatar: bool,
    is_ground: bool,
    is_wall: bool,
    /// `true` if the avatar can eventually enter a cell with the character.
    is_open: bool,
    is_goal: bool,
    /// The degree of harm: 1.0 for harmful sprites that move or spawn, 0.5 for other harmful sprites, and 0.0 for
    /// harmless sprites.
    harm: f64,
}

impl LevelMeasures {
    /// Creates a calculator; `None` if no level character in the game places exactly one avatar. Cost: O(characters ×
    /// types).
    pub fn new(analysis: &Analysis) -> Option<LevelMeasures> {
        let palette = Palette::of(analysis)?;
        let marks = (0..128).map(|symbol| Mark::of(analysis, &palette, symbol)).collect();
        Some(LevelMeasures { similarity: LevelSimilarity::of(analysis), marks })
    }

    /// Returns all measures of one of the game's levels, in the order of [`LevelMeasure::ALL`]. Cost: O(cells).
    pub fn of(&self, level: &Level) -> [f64; LevelMeasure::ALL.len()] {
        let board = Marked {
            grid: Grid { columns: level.columns(), rows: level.rows() },
            marks: level.cells().iter().map(|&symbol| self.marks[usize::from(symbol)]).collect(),
        };
        let (openness, linearity) = board.shape();
        LevelMeasure::ALL.map(|measure| match measure {
            LevelMeasure::Cover => board.share(|mark| !mark.is_ground),
            LevelMeasure::Walls => board.share(|mark| mark.is_wall),
            LevelMeasure::Openness => openness,
            LevelMeasure::Linearity => linearity,
            LevelMeasure::Pressure => board.pressure(),
            LevelMeasure::Goals => saturate(board.count(|mark| mark.is_goal) as f64),
            LevelMeasure::LeftRight => self.similarity.mirror(level, Mirror::LeftRight),
            LevelMeasure::UpDown => self.similarity.mirror(level, Mirror::UpDown),
            LevelMeasure::Sprinkle => board.sprinkle(),
        })
    }
}

impl Mark {
    fn of(analysis: &Analysis, palette: &Palette, symbol: u8) -> Mark {
        let types = || analysis.game().places(symbol).iter().copied();
        let aims = analysis.aims();
        let harm = |stype| {
            let facts = analysis.facts(stype);
            let harms = analysis.harm(stype) != Harm::None || analysis.makes_harm(stype);
            match (harms, facts.motion == Motion::Still && facts.makes.is_empty()) {
                (false, _) => 0.0,
                (true, true) => 0.5,
                (true, false) => 1.0,
            }
        };
        let is_goal = |stype| {
            let wanted = aims.remove.contains(&stype) || aims.protect.contains(&stype);
            wanted || analysis.role(stype) == Role::Exit
        };
        let walk = palette.walk(symbol);
        Mark {
            is_avatar: types().any(|stype| analysis.role(stype) == Role::Avatar),
            is_ground: symbol == palette.base || types().all(|stype| analysis.role(stype) == Role::Floor),
            is_wall: walk == Walk::Blocked,
            is_open: matches!(walk, Walk::Open | Walk::Breakable | Walk::Pushed | Walk::Locked(_)),
            is_goal: types().any(is_goal),
            harm: types().map(harm).fold(0.0, f64::max),
        }
    }
}

/// A level, represented by the properties of its cells.
struct Marked {
    grid: Grid,
    marks: Vec<Mark>,
}

impl Marked {
    fn cells_with(&self, is: impl Fn(&Mark) -> bool) -> Vec<usize> {
        (0..self.marks.len()).filter(|&cell| is(&self.marks[cell])).collect()
    }

    fn count(&self, is: impl Fn(&Mark) -> bool) -> usize {
        self.marks.iter().filter(|mark| is(mark)).count()
    }

    fn share(&self, is: impl Fn(&Mark) -> bool) -> f64 {
        share(self.count(is), self.marks.len())
    }

    /// Returns the openness and the linearity.
    fn shape(&self) -> (f64, f64) {
        let start = self.cells_with(|mark| mark.is_avatar);
        let steps = self.grid.flood(&start, |cell| self.marks[cell].is_open);
        let reached: Vec<usize> = (0..steps.len()).filter(|&cell| steps[cell] != FAR).collect();
        let open_beside =
            |&cell: &usize| self.grid.beside(cell).filter(|&next| self.marks[next].is_open).count();
        let ways: usize = reached.iter().map(open_beside).sum();
        let furthest = reached.iter().map(|&cell| steps[cell] as usize).max().unwrap_or(0);
        (share(ways, 4 * reached.len()), share(furthest, reached.len().saturating_sub(1)))
    }

    fn pressure(&self) -> f64 {
        let to_avatar = self.grid.flood(&self.cells_with(|mark| mark.is_avatar), |_| true);
        let goals = self.cells_with(|mark| mark.is_goal);
        let to_goal = if goals.is_empty() { to_avatar.clone() } else { self.grid.flood(&goals, |_| true) };
        let near = |steps: u32| NEAR / (NEAR + f64::from(steps));
        let harm = |cell: usize| self.marks[cell].harm * (near(to_avatar[cell]) + near(to_goal[cell])) / 2.0;
        // `sum` would return -0.0 for no cells.
        saturate((0..self.marks.len()).map(harm).fold(0.0, |sum, harm| sum + harm))
    }

    fn sprinkle(&self) -> f64 {
        let inner = |cell: &usize| !self.grid.on_border(*cell);
        let walls: Vec<usize> = self.cells_with(|mark| mark.is_wall).into_iter().filter(inner).collect();
        let alone = |cell: &&usize| self.grid.beside(**cell).all(|next| !self.marks[next].is_wall);
        share(walls.iter().filter(alone).count(), walls.len())
    }
}

fn share(part: usize, whole: usize) -> f64 {
    if whole == 0 { 0.0 } else { part as f64 / whole as f64 }
}

fn saturate(amount: f64) -> f64 {
    amount / (amount + HALF)
}
