//! Invented games as a source of candidates. The source provides the rules and the boards that a search finds for them.

use super::level::LATER_SHARE;
use super::sources::{Board, BoardSource, Boards, PlaceBrief, Rules};
use crate::boards::{BoardBudget, BoardMeasures, BoardOrder, first_executions, make_board, search_boards};
use crate::games::FoundLevel;
use base::{Seed, SeedPath};
use engine::{Analysis, Game, SpriteType};
use generators::GenerateError;
use generators::boards::{BoardBrief, BoardVariation, Idiom};
use generators::games::GeneratedGame;
use generators::invention::{Invented, Invention};
use validators::CheckedCriteria;

/// The last position in the sequence of levels, counted from 0. It corresponds to a difficulty of 1.
const DEMANDS: u8 = 4;

/// The position in the sequence of levels for which a quick evaluation looks for a board on which every mechanic
/// matters.
const JOINT: u8 = 2;
/// The number of mechanics that must matter on a board, by its position in the sequence of levels. At the last position,
/// every mechanic must matter.
const LEAST_JOINT: [usize; DEMANDS as usize] = [1, 1, 2, 2];

/// The position in the sequence of levels for which boards are made in a quick evaluation.
const LOOK_DEMAND: u8 = 1;
/// The number of boards in a quick evaluation.
const LOOKS: usize = 24;
/// The number of boards in a quick evaluation after which a game without a winnable board is rejected. With good rules,
/// at least one in five compositions is winnable. A quick evaluation rejects more than half of all rule sets, so it
/// should be cheap rather than accurate.
const HOPELESS: usize = 8;
/// The maximum number of forward-model calls in a quick evaluation's search for a win.
const LOOK_SEARCH: u64 = 20_000;
/// The total number of forward-model calls for a quick evaluation's boards.
const LOOK_CALLS: u64 = 1_500_000;
/// The number of forward-model calls in the search for a board on which every mechanic matters.
const JOINT_CALLS: u64 = 2_000_000;
/// The reason for rejecting a game without a board on which every mechanic matters.
pub(super) const USELESS: &str = "a mechanic does not matter";
/// The minimum fraction of necessary interactions on a quick evaluation's best board.
const LEAST_NECESSITY: f64 = 0.4;
/// The minimum fraction of wrong choices that have a cost on a quick evaluation's best board.
const LEAST_TRAPS: f64 = 0.1;
/// The maximum degree to which an unmet condition can count as met.
const NEARLY: f64 = 0.999;

impl Rules for Invention {
    type Boards = InventedBoards;

    fn build(&self) -> Option<(GeneratedGame, InventedBoards)> {
        let Invented { game, mechanics, idioms, own_types } = Invention::build(self).ok()?;
        Some((game, InventedBoards { mechanics, idioms, own_types }))
    }

    fn has_clock(&self) -> bool {
        false
    }

    fn timed(&self, ticks: Option<u32>) -> Invention {
        Invention::timed(self, ticks)
    }
}

/// The boards of an invented game.
pub(crate) struct InventedBoards {
    /// The interactions of each mechanic.
    mechanics: Vec<Vec<usize>>,
    idioms: Vec<(String, Idiom)>,
    own_types: Vec<Vec<String>>,
}

impl BoardSource for InventedBoards {
    fn name(&self) -> &'static str {
        "board maker"
    }

    fn is_course(&self) -> bool {
        true
    }

    fn look(&self, game: &Game, seed: Seed) -> Result<(), &'static str> {
        // The first won board of most games has no obstacle, so the best board is rarely needed.
        let mut look = self.look_at(game, seed, 0);
        if look.board.is_some() && look.obstacle().is_some() {
            look = self.look_quickly(game, seed);
        }
        if let Some(obstacle) = look.obstacle() {
            return Err(obstacle);
        }
        if self.can_all_matter(game, seed.child("joint use", 0)) { Ok(()) } else { Err(USELESS) }
    }

    fn mechanics(&self) -> &[Vec<usize>] {
        &self.mechanics
    }

    fn is_ordered(&self) -> bool {
        true
    }

    fn boards<'a>(
        &'a self,
        game: &'a Game,
        place: &PlaceBrief<'a>,
    ) -> Result<Box<dyn Boards + 'a>, GenerateError> {
        let demand = (place.difficulty * f64::from(DEMANDS)).round() as u8;
        Ok(Box::new(PlaceBoards {
            source: self,
            analysis: Analysis::of(game),
            number: place.number,
            demand,
            others: place.others,
            criteria: place.criteria,
        }))
    }
}

/// The result of a quick evaluation of an invented game, on a few boards.
pub(crate) struct QuickLook {
    /// The best board's measures; `None` if no board is winnable.
    board: Option<BoardMeasures>,
    /// The fraction of board constraints met by the board closest to a win.
    nearness: f64,
    /// The number of forward-model calls spent on the evaluation.
    pub(crate) calls: u64,
}

impl QuickLook {
    /// Returns the reason why the game is not worth a board search; `None` if there is no such reason.
    pub(crate) fn obstacle(&self) -> Option<&'static str> {
        let names = [
            "no board was won",
            "hardly anything is necessary",
            "no wrong choice costs",
            "no wrong choice kills",
        ];
        self.constraints().iter().zip(names).find(|(met, _)| **met < 1.0).map(|(_, name)| name)
    }

    /// Returns the degree to which each condition is met, in the order of the obstacles.
    fn constraints(&self) -> [f64; 4] {
        let Some(board) = &self.board else { return [self.nearness.min(NEARLY), 0.0, 0.0, 0.0] };
        let necessity = (board.necessity() / LEAST_NECESSITY).min(1.0);
        let deaths = if board.deaths > 0.0 { 1.0 } else { 0.0 };
        [1.0, necessity, (board.traps / LEAST_TRAPS).min(1.0), deaths]
    }

    /// Returns the degree to which all conditions are met, which is 1.0 exactly if there is no obstacle.
    pub(crate) fn feasibility(&self) -> f64 {
        let constraints = self.constraints();
        constraints.iter().sum::<f64>() / constraints.len() as f64
    }

    /// Returns the quality of the best board.
    pub(crate) fn quality(&self) -> f64 {
        self.board.as_ref().map_or(0.0, |board| board.quality)
    }
}

impl InventedBoards {
    /// Returns a request for composing boards. It specifies where exits are placed, and where types are placed whose
    /// placement does not follow from the rules alone.
    fn brief(&self, analysis: &Analysis, demand: u8) -> BoardBrief {
        let game = analysis.game();
        let named = self.idioms.iter().filter_map(|(name, idiom)| Some((game.sprite_type(name)?, *idiom)));
        let is_told = |(stype, idiom): &(SpriteType, Idiom)| {
            *idiom == Idiom::Exit || Idiom::of(analysis, *stype).is_none()
        };
        let idioms: Vec<(SpriteType, Idiom)> = named.filter(is_told).collect();
        let exits = idioms.iter().filter(|(_, idiom)| *idiom == Idiom::Exit);
        let counts = exits.map(|(stype, _)| (*stype, (1, 1))).collect();
        BoardBrief { idioms, counts, ..BoardBrief::of_demand(demand) }
    }

    /// Returns `true` if a short search finds a board on which every mechanic matters.
    fn can_all_matter(&self, game: &Game, seed: Seed) -> bool {
        let analysis = Analysis::of(game);
        let order = BoardOrder::of(self.brief(&analysis, JOINT));
        let order = BoardOrder { mechanics: self.mechanics.clone(), ..order };
        let budget = BoardBudget { total: JOINT_CALLS, patience: 0, scrutiny: 1, ..BoardBudget::default() };
        make_board(&analysis, &order, seed, &budget).is_some()
    }

    /// Composes a few boards for a game and measures the best one.
    pub(crate) fn look_quickly(&self, game: &Game, seed: Seed) -> QuickLook {
        self.look_at(game, seed, BoardBudget::default().patience)
    }

    /// Composes a few boards for a game and measures the best one, or the first won one if `patience` is 0.
    fn look_at(&self, game: &Game, seed: Seed, patience: usize) -> QuickLook {
        let analysis = Analysis::of(game);
        let order = BoardOrder::of(self.brief(&analysis, LOOK_DEMAND));
        let budget = BoardBudget {
            compositions: LOOKS,
            evaluations: LOOKS,
            patience,
            hopeless: HOPELESS,
            calls: LOOK_SEARCH,
            total: LOOK_CALLS,
            scrutiny: 1,
            ..BoardBudget::default()
        };
        let search = search_boards(&analysis, &order, seed, &budget);
        let board = search.made.map(|made| made.measures);
        QuickLook { board, nearness: search.feasibility, calls: search.calls }
    }
}

/// The boards for one position of an invented game.
struct PlaceBoards<'a> {
    source: &'a InventedBoards,
    analysis: Analysis,
    number: u32,
    demand: u8,
    others: &'a [(u32, FoundLevel)],
    criteria: &'a CheckedCriteria,
}

impl PlaceBoards<'_> {
    /// Returns the types to omit from a candidate's board. Introductory levels omit the types of one mechanic, drawn at
    /// random for each candidate, if boards can be composed without that mechanic.
    fn left_out(&self, candidate: &SeedPath) -> Vec<SpriteType> {
        if self.demand > 0 {
            return Vec::new();
        }
        let game = self.analysis.game();
        let types = |names: &Vec<String>| -> Vec<SpriteType> {
            game.sprite_types().filter(|&stype| names.iter().any(|name| name == game.name(stype))).collect()
        };
        let composes = |without: &Vec<SpriteType>| {
            let brief = self.source.brief(&self.analysis, self.demand);
            let brief = BoardBrief { without: without.clone(), ..brief };
            BoardVariation::new(&self.analysis, &brief).is_ok()
        };
        let optional = self.source.own_types.iter().filter(|own| !own.is_empty()).map(types);
        let optional: Vec<Vec<SpriteType>> = optional.filter(composes).collect();
        if optional.is_empty() {
            return Vec::new();
        }
        let drawn = candidate.seed().child("left out", 0).sampler().below(optional.len());
        optional.into_iter().nth(drawn).unwrap_or_default()
    }

    fn order(&self, candidate: &SeedPath) -> BoardOrder {
        let without = self.left_out(candidate);
        let brief = BoardBrief { without, ..self.source.brief(&self.analysis, self.demand) };
        let mechanics = self.source.mechanics.clone();
        let unlike = self.others.iter().map(|(_, found)| found.level.clone()).collect();
        let order = BoardOrder::of(brief);
        let acting = mechanics.iter().filter(|lines| !lines.is_empty()).count();
        let least = LEAST_JOINT.get(usize::from(self.demand));
        let idle = least.map_or(0, |least| acting.saturating_sub(*least));
        BoardOrder {
            mechanics,
            idle,
            unlike,
            known: self.known(),
            ticks: self.ticks(order.ticks),
            gates: Some(self.criteria.clone()),
            ..order
        }
    }

    /// Returns, for each win of another level, its interactions in the order of their first executions.
    fn known(&self) -> Vec<Vec<usize>> {
        let firsts = |(_, found): &(u32, FoundLevel)| {
            let win = found.report.witness.as_ref()?;
            Some(first_executions(&self.analysis, &found.level, win))
        };
        self.others.iter().filter_map(firsts).collect()
    }

    /// Narrows the default win length to the range allowed by the criteria and by the wins of other levels. The last
    /// level is found before the levels between, so no win is longer than the win of the last level.
    fn ticks(&self, (low, high): (usize, usize)) -> (usize, usize) {
        let (mut low, mut high) = (low.max(self.criteria.least_ticks), high.min(self.criteria.most_ticks));
        for (number, found) in self.others {
            let Some(win) = &found.report.witness else { continue };
            match *number < self.number {
                true => low = low.max((win.actions.len() as f64 * LATER_SHARE).ceil() as usize),
                false => high = high.min(win.actions.len()),
            }
        }
        (low, high.max(low))
    }
}

impl Boards for PlaceBoards<'_> {
    fn generate(&self, candidate: &SeedPath) -> Result<Board, GenerateError> {
        let seed = candidate.seed().child("layout", 0);
        let made = make_board(&self.analysis, &self.order(candidate), seed, &BoardBudget::default());
        let none = || GenerateError::Unlucky("no board was won as the place asks".to_owned());
        let made = made.ok_or_else(none)?;
        Ok(Board { level: made.level, asks: None, known: Some(made.win.actions) })
    }
}
