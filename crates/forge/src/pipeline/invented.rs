//! Invented games as a source of candidates: their rules, and boards that the maker of boards finds for them.

use super::sources::{Board, BoardSource, Boards, PlaceBrief, Rules};
use crate::boards::{BoardBudget, BoardOrder, make_board};
use crate::games::FoundLevel;
use base::{Seed, SeedPath};
use engine::{Analysis, Game, SpriteType};
use generators::GenerateError;
use generators::boards::{BoardBrief, Idiom};
use generators::games::GeneratedGame;
use generators::invention::{Invented, Invention, JointType};
use validators::CheckedCriteria;

/// The demands of the places of a course, from the introduction to the exam.
const DEMANDS: u8 = 4;

/// The demand of the boards of a quick look, their number, and the forward-model calls for all of them.
const LOOK_DEMAND: u8 = 1;
const LOOKS: usize = 24;
const LOOK_CALLS: u64 = 1_500_000;
/// The share of necessary interactions and the share of wrong choices that cost on the best board of a quick look, at least.
const LEAST_NECESSITY: f64 = 0.4;
const LEAST_TRAPS: f64 = 0.1;

impl Rules for Invention {
    type Boards = InventedBoards;

    fn build(&self) -> Option<(GeneratedGame, InventedBoards)> {
        let Invented { game, joint, idioms, own_types } = Invention::build(self).ok()?;
        Some((game, InventedBoards { joint, idioms, own_types }))
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
    joint: Vec<JointType>,
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
        let analysis = Analysis::of(game);
        let order = BoardOrder::of(self.brief(&analysis, LOOK_DEMAND));
        let budget = BoardBudget {
            compositions: LOOKS,
            evaluations: LOOKS,
            total: LOOK_CALLS,
            ..BoardBudget::default()
        };
        let measures = make_board(&analysis, &order, seed, &budget).ok_or("no board was won")?.measures;
        if measures.necessity() < LEAST_NECESSITY {
            return Err("hardly anything is necessary");
        }
        if measures.traps < LEAST_TRAPS {
            return Err("no wrong choice costs");
        }
        if measures.deaths == 0.0 {
            return Err("no wrong choice kills");
        }
        Ok(())
    }

    fn joint_types(&self) -> &[JointType] {
        &self.joint
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
            demand,
            others: place.others,
            criteria: place.criteria,
        }))
    }
}

impl InventedBoards {
    /// Returns a brief for boards: exits and types whose place the rules alone do not tell are placed as the invention says.
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
}

/// The boards of one place of an invented game.
struct PlaceBoards<'a> {
    source: &'a InventedBoards,
    analysis: Analysis,
    demand: u8,
    others: &'a [(u32, FoundLevel)],
    criteria: &'a CheckedCriteria,
}

impl PlaceBoards<'_> {
    /// The types that the board of a candidate lacks: introductions leave out a mechanic, a different one each time.
    fn left_out(&self, candidate: &SeedPath) -> Vec<SpriteType> {
        let optional: Vec<&Vec<String>> =
            self.source.own_types.iter().filter(|own| !own.is_empty()).collect();
        if self.demand > 0 || optional.is_empty() {
            return Vec::new();
        }
        let drawn = candidate.seed().child("left out", 0).sampler().below(optional.len());
        let names = optional.get(drawn).map_or(&[][..], |own| own.as_slice());
        let game = self.analysis.game();
        let is_named = |stype: &SpriteType| names.iter().any(|name| name == game.name(*stype));
        game.sprite_types().filter(is_named).collect()
    }

    fn order(&self, candidate: &SeedPath) -> BoardOrder {
        let without = self.left_out(candidate);
        let brief = BoardBrief { without, ..self.source.brief(&self.analysis, self.demand) };
        let unlike = self.others.iter().map(|(_, found)| found.level.clone()).collect();
        BoardOrder { unlike, gates: Some(self.criteria.clone()), ..BoardOrder::of(brief) }
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
