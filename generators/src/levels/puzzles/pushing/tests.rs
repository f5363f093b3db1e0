//! Tests that compare the puzzle rules and the backward search with a plain forward search, for every kind of
//! destination.

#[path = "../../../../tests/it/levels/puzzles/crates.rs"]
mod crates;

use self::crates::{hole, place, sink};
use super::floor::{FloorPlans, MAX_POSITIONS};
use super::floor_plan::{FloorPlan, Position, Pushing, bit, each};
use super::rules::{Destination, Rules};
use crate::Variation;
use crate::levels::grid::Grid;
use crate::levels::palette::Palette;
use base::Seed;
use engine::{Analysis, Game};
use std::collections::{BTreeMap, VecDeque};

fn rules_of(game: &Game) -> Rules {
    let analysis = Analysis::of(game);
    Rules::of(&analysis, &Palette::of(&analysis).unwrap()).unwrap()
}

/// Returns a corpus game with two kinds of pushable objects, in which objects of different kinds vanish when they
/// meet.
fn jars() -> Game {
    Game::from_source(include_str!("../../../../../corpora/quiet-jars/game.vgdl")).unwrap()
}

#[test]
fn rules_are_recognised() {
    assert_eq!(rules_of(&sink()).destinations, [Destination::Sink]);
    assert_eq!(rules_of(&hole()).destinations, [Destination::Hole]);
    assert!(!rules_of(&hole()).walkable[0]);
    assert_eq!(rules_of(&place()).destinations, [Destination::Place]);
    assert_eq!(rules_of(&jars()).destinations, [Destination::Partner; 2]);
}

/// Returns the number of pushes from a position to the nearest solved position, by forward search; `None` if no solved
/// position is reachable.
fn forward(pushing: &Pushing<'_>, start: Position) -> Option<usize> {
    let key = |position: &Position| (position.things, position.targets, position.avatar);
    let solved = pushing.solved();
    let done = |position: &Position| {
        solved.iter().any(|solved| (solved.things, solved.targets) == (position.things, position.targets))
    };
    let mut known = BTreeMap::from([(key(&start), 0)]);
    let mut queue = VecDeque::from([(start, 0)]);
    while let Some((position, pushes)) = queue.pop_front() {
        if known[&key(&position)] < pushes {
            continue;
        }
        if done(&position) {
            return Some(pushes);
        }
        for stride in pushing.strides() {
            let Some(next) = pushing.step(&position, stride) else { continue };
            let walked = next.things == position.things;
            let cost = pushes + usize::from(!walked);
            if known.get(&key(&next)).is_none_or(|&known| cost < known) {
                known.insert(key(&next), cost);
                if walked { queue.push_front((next, cost)) } else { queue.push_back((next, cost)) }
            }
        }
    }
    None
}

fn floors_of(rules: &Rules, grid: Grid, things: usize) -> FloorPlans<'_> {
    let counts = FloorPlans::counts_of(rules, things);
    FloorPlans { rules, grid, counts, most_positions: MAX_POSITIONS, sills: true }
}

#[test]
fn backward_and_forward_search_agree() {
    for (game, things) in [(sink(), 2), (hole(), 2), (place(), 2), (jars(), 2)] {
        let rules = rules_of(&game);
        let grid = Grid { columns: 7, rows: 6 };
        let floors = floors_of(&rules, grid, things);
        for index in 0..3 {
            let floor_plan: FloorPlan = floors.create(Seed::from_text("agree").child("yard", index)).unwrap();
            let pushing = Pushing { floor_plan: &floor_plan, rules: &rules };
            let searched = pushing.by_pushes(usize::MAX);
            assert!(searched.complete);
            let starts = searched.iter().filter(|(position, _)| pushing.is_start(position));
            for (position, pushes) in starts.step_by(7) {
                assert_eq!(
                    forward(&pushing, *position),
                    Some(pushes),
                    "{:?} {position:?}",
                    rules.destinations
                );
            }
            // Positions that were not found cannot be solved.
            let floor = pushing.lies(0, &Position { targets: floor_plan.targets, ..Position::default() });
            let cells: Vec<usize> = each(floor).collect();
            for pair in cells.windows(2).step_by(3).filter(|_| rules.kinds.len() == 1) {
                let things = [bit(pair[0]) | bit(pair[1]), 0];
                let position = Position { things, targets: floor_plan.targets, avatar: 0 };
                let stands = pushing.stands(&position);
                let region = pushing.flood(stands & stands.wrapping_neg(), stands);
                let position = Position { avatar: region.trailing_zeros() as u8, ..position };
                if pushing.is_start(&position) {
                    assert_eq!(
                        searched.distance(&position),
                        forward(&pushing, position),
                        "{:?}",
                        rules.destinations
                    );
                }
            }
        }
    }
}
