//! Observations in a form that can be compared between two games.

use engine::{Game, Outcome, Rect, SpriteType, State};

/// The maximum number of entries on a board. Only boards full of giant sprites have more.
const MAX_ENTRIES: usize = 1 << 18;
/// The number used instead of a name's index for types that the true game does not have.
const UNKNOWN: u16 = u16::MAX;

/// The observable part of a state, which can be compared between games with the same names.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Seen {
    /// The visible sprites, as sorted pairs of a cell index in row-major order and a name's index. A sprite that
    /// overlaps several cells has one entry for each cell.
    pub(super) board: Vec<(u32, u16)>,
    pub(super) score: f64,
    /// The resources that the avatar holds, as sorted pairs of a name's index and a positive or negative amount.
    pub(super) resources: Vec<(u16, i32)>,
    /// The avatar's health points, or 0 if there is no avatar or the game has no health.
    pub(super) health: i32,
    pub(super) outcome: Outcome,
}

/// A game, with the index of each sprite type's name in the true game.
#[derive(Clone, Debug)]
pub(super) struct Viewer {
    pub(super) game: Game,
    /// For each sprite type, the index of its name.
    numbers: Vec<u16>,
    shown: Vec<SpriteType>,
}

impl Viewer {
    /// Creates a viewer for a game. `names` contains the names of the true game.
    pub(super) fn new(game: &Game, names: &[String]) -> Viewer {
        let number = |name: &str| names.iter().position(|own| own == name).map_or(UNKNOWN, |at| at as u16);
        let numbers = game.sprite_types().map(|stype| number(game.name(stype))).collect();
        let shown = game.sprite_types().filter(|&stype| !game.is_hidden(stype)).collect();
        Viewer { game: game.clone(), numbers, shown }
    }

    /// Returns the observable part of a state. Cost: O(sprites log sprites).
    pub(super) fn see(&self, state: &State) -> Seen {
        let mut board = Vec::new();
        for &stype in &self.shown {
            for rect in state.rects(stype) {
                cover(state, rect, self.numbers[stype.index()], &mut board);
            }
        }
        board.sort_unstable();
        let number =
            |name: &str| self.game.sprite_type(name).map_or(UNKNOWN, |stype| self.numbers[stype.index()]);
        let held = self.game.held_by_avatar(state).into_iter().filter(|(_, amount)| *amount != 0);
        let mut resources: Vec<(u16, i32)> = held.map(|(name, amount)| (number(&name), amount)).collect();
        resources.sort_unstable();
        let health = self.game.seen_avatar(state).map_or(0, |avatar| avatar.health);
        Seen { board, score: state.score(), resources, health, outcome: state.outcome() }
    }
}

/// Adds the cells that a sprite overlaps to a board.
fn cover(state: &State, rect: Rect, number: u16, board: &mut Vec<(u32, u16)>) {
    let (block, (columns, rows)) = (state.block().max(1), state.size());
    let span = |from: i32, size: i32, limit: i32| {
        let last = from.saturating_add(size.saturating_sub(1)).div_euclid(block).min(limit - 1);
        from.div_euclid(block).max(0)..=last
    };
    for row in span(rect.y, rect.h, rows) {
        for column in span(rect.x, rect.w, columns) {
            if board.len() < MAX_ENTRIES {
                board.push(((row * columns + column) as u32, number));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::Seed;
    use engine::Action;

    /// The boards contain the same sprites as the observations for players.
    #[test]
    fn boards_agree_with_observations() {
        let source = "BasicGame\n  SpriteSet\n    ghost > Immovable hidden=True\n    rover > Missile orientation=RIGHT speed=0.3\n    hero > MovingAvatar\n  LevelMapping\n    r > rover\n    g > ghost\n    h > hero\n  InteractionSet\n    hero wall > stepBack\n  TerminationSet\n    Timeout limit=99 win=False\n";
        let game = Game::from_source(source).unwrap();
        let level = game.level("wwwww\nwr gw\nw h w\n").unwrap();
        let names: Vec<String> = game.sprite_types().map(|stype| game.name(stype).to_owned()).collect();
        let viewer = Viewer::new(&game, &names);
        let mut state = game.start(&level, Seed::from_text("any"));
        for action in Action::ALL.into_iter().cycle().take(20) {
            game.step(&mut state, action);
            let cells = game.observe(&state).cells;
            let number = |name: &String| names.iter().position(|own| own == name).unwrap() as u16;
            let mut expected: Vec<(u32, u16)> = cells
                .iter()
                .zip(0..)
                .flat_map(|(cell, at)| cell.iter().map(move |name| (at, name)))
                .map(|(at, name)| (at, number(name)))
                .collect();
            expected.sort_unstable();
            assert!(expected.len() > 8);
            assert_eq!(viewer.see(&state).board, expected);
        }
    }
}
