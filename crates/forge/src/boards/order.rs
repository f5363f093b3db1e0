//! Board orders, search budgets and search results. An order states the requirements for a board.

use engine::{Episode, Level};
use generators::boards::BoardBrief;
use validators::CheckedCriteria;

/// The minimum and maximum length of a shortest win in ticks, by the level's position in the game.
const LENGTHS: [(usize, usize); 5] = [(12, 32), (25, 55), (28, 70), (32, 90), (40, 110)];

/// The requirements for a board.
#[derive(Clone, Debug)]
pub struct BoardOrder {
    /// The types and sprites that the board must contain.
    pub brief: BoardBrief,
    /// The mechanics of an invented game, of which all but [`BoardOrder::idle`] must matter. Each mechanic is a list of
    /// interactions, as indices into [`Description::interactions`](engine::Description). A mechanic matters if the win
    /// needs one of its interactions, if wrong keys are fatal because of the mechanic, or if a clearly shorter win
    /// exists without the mechanic.
    pub mechanics: Vec<Vec<usize>>,
    /// The maximum number of mechanics that may not matter.
    pub idle: usize,
    /// Earlier boards that the new board must not resemble.
    pub unlike: Vec<Level>,
    /// For each earlier win, the order of its first executions of interactions; see [`BoardMeasures::firsts`].
    pub known: Vec<Vec<usize>>,
    /// The minimum and maximum number of ticks in the shortest win.
    pub ticks: (usize, usize),
    /// The criteria whose gates the board should meet on its own, as far as a single level can. Gates are criteria for
    /// whole games. `None` if the board need not meet any gate.
    pub gates: Option<CheckedCriteria>,
}

impl BoardOrder {
    /// Creates an order with the default contents and win length for the requested position in the game.
    pub fn of(brief: BoardBrief) -> BoardOrder {
        let ticks = LENGTHS[usize::from(brief.demand).min(LENGTHS.len() - 1)];
        BoardOrder {
            brief,
            mechanics: Vec::new(),
            idle: 0,
            unlike: Vec::new(),
            known: Vec::new(),
            ticks,
            gates: None,
        }
    }
}

base::with_defaults! {
    /// The budget of a board search. The budget contains no durations, so the result is the same on every machine.
    #[derive(Clone, Debug, PartialEq)]
    pub struct BoardBudget {
        /// The number of initial compositions. The search then modifies the best of them.
        pub compositions: usize = 24,
        /// The total number of boards that reach the win search, including compositions.
        pub evaluations: usize = 60,
        /// The number of boards without improvement after which the search ends, once a board is winnable and all
        /// compositions were judged. If 0, the search ends at the first winnable board.
        pub patience: usize = 24,
        /// The number of boards without a win after which the search ends.
        pub hopeless: usize = 32,
        /// The maximum number of forward-model calls in a search for the shortest win.
        pub calls: u64 = 40_000,
        /// The maximum number of forward-model calls in a search for a win without an interaction or after a deviation.
        pub small_calls: u64 = 5_000,
        /// The factor by which `calls` and `small_calls` are multiplied when the best board is finally judged. A factor
        /// of 1 omits the final judging, and the tidying before it.
        pub scrutiny: u64 = 8,
        /// The number of deviations from the win to try.
        pub deviations: usize = 10,
        /// The total number of forward-model calls after which no more boards are judged.
        pub total: u64 = 4_000_000,
    }
}

/// A finished board, as a level, with its shortest known win.
#[derive(Clone, Debug)]
pub struct MadeBoard {
    /// The level with the board.
    pub level: Level,
    /// The shortest win found.
    pub win: Episode,
    /// The properties of the board.
    pub measures: BoardMeasures,
    /// `true` if the board has every property that the search requires.
    pub is_complete: bool,
    /// The number of boards judged in the search.
    pub evaluations: usize,
    /// The number of forward-model calls of the whole search.
    pub calls: u64,
}

/// The measured properties of a won board.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BoardMeasures {
    /// The quality that the search maximizes, from 0.0 to 1.0.
    pub quality: f64,
    /// The number of ticks of the win.
    pub ticks: usize,
    /// `true` if the win is proved to be the shortest.
    pub is_shortest: bool,
    /// The fraction of alternative random futures in which the same actions win; 1.0 in deterministic games.
    pub steady: f64,
    /// The interactions without which every win is clearly longer or does not exist.
    pub needed: Vec<usize>,
    /// The fraction of deviations from the win after which the player is dead or no win is found.
    pub traps: f64,
    /// The fraction of deviations after which the player is dead.
    pub deaths: f64,
    /// The tick of the last deviation that has a cost, as a fraction of the tick of the last deviation tried. After
    /// that tick, the rest of the win is safe.
    pub last: f64,
    /// The fraction of placed types, not counting walls and floor, that are involved in the win.
    pub used: f64,
    /// The fraction of the gates that the board meets on its own; 1.0 if no gates were requested.
    pub gates: f64,
    /// The longest stretch of the win without an event, as a fraction of its ticks.
    pub dead: f64,
    /// The mean number of cells swept by self-moving sprites; `None` without such sprites.
    pub sweep: Option<f64>,
    /// The area of the largest empty rectangle, as a fraction of the area within the border.
    pub emptiness: f64,
    /// The interactions of the win, except those that only stop or turn a sprite, in the order of their first
    /// executions.
    pub firsts: Vec<usize>,
    /// `true` if no known win has the same order of first interactions.
    pub is_new: bool,
}

impl BoardMeasures {
    /// Returns the fraction of the executed interactions that the win needs; 1.0 if the win executes none of them.
    pub fn necessity(&self) -> f64 {
        match self.firsts.len() {
            0 => 1.0,
            executed => {
                let needed = self.firsts.iter().filter(|line| self.needed.contains(line));
                needed.count() as f64 / executed as f64
            }
        }
    }
}
