//! Guards, which are interactions that only keep sprites on the board and out of walls, and that hardly count as
//! mechanics.

use super::families::EffectFamily;
use crate::measures::is_guard;
use engine::analysis::Role;
use engine::{Analysis, Meeting, SpriteType};

/// A game's guards: interactions with the screen edge, and interactions in which a wall undoes a move at no
/// cost. A wall ([`Role::Wall`]) is stationary, always blocks and cannot be removed.
#[derive(Clone, Debug)]
pub struct Guards {
    /// The kind of each interaction line.
    lines: Vec<GuardKind>,
    /// For each type, `true` if it is a wall.
    walls: Vec<bool>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum GuardKind {
    /// An interaction with the screen edge.
    Edge,
    /// A timed interaction, which does not depend on contacts.
    Clock,
    /// An interaction that only undoes a move. `walls` is `true` if all of the interaction's partners are walls.
    Block { walls: bool },
    /// An interaction of any other kind.
    Other,
}

impl Guards {
    /// Finds the guards, which only keep sprites on the board and out of walls. Cost: O(interactions × types).
    pub fn of(analysis: &Analysis) -> Guards {
        let game = analysis.game();
        let is_wall =
            |stype: SpriteType| analysis.role(stype) == Role::Wall || !analysis.facts(stype).possible;
        let walls: Vec<bool> = game.sprite_types().map(is_wall).collect();
        let names_walls = |name: &str| {
            let Some(written) = game.sprite_type(name) else { return false };
            game.sprite_types().filter(|&stype| analysis.applies(written, stype)).all(is_wall)
        };
        let kind = |(at, line): (usize, &engine::syntax::InteractionLine)| {
            let clock =
                line.second.iter().chain([&line.first]).any(|word| word.text.eq_ignore_ascii_case("TIME"));
            let priced =
                line.params.iter().any(|param| param.key.text == "scoreChange" && param.value.text != "0");
            match EffectFamily::of(&line.effect.text) {
                _ if clock => GuardKind::Clock,
                _ if is_guard(game, at) => GuardKind::Edge,
                Some(EffectFamily::Block) if !priced => {
                    GuardKind::Block { walls: line.second.iter().all(|second| names_walls(&second.text)) }
                }
                _ => GuardKind::Other,
            }
        };
        Guards { lines: game.description().interactions.iter().enumerate().map(kind).collect(), walls }
    }

    /// Returns the lines that only keep sprites on the board and out of walls: indices into
    /// [`Description::interactions`](engine::Description).
    pub fn lines(&self) -> impl Iterator<Item = usize> + '_ {
        let guards =
            |line: &usize| matches!(self.lines[*line], GuardKind::Edge | GuardKind::Block { walls: true });
        (0..self.lines.len()).filter(guards)
    }

    /// Returns `true` for an execution of a guard. Either the line is a guard, or the line also has other partners but
    /// the execution involves a wall.
    pub fn covers(&self, meeting: Meeting) -> bool {
        match self.lines[meeting.line] {
            GuardKind::Edge => true,
            GuardKind::Block { .. } => meeting.second.is_some_and(|second| self.walls[second.index()]),
            GuardKind::Clock | GuardKind::Other => false,
        }
    }

    /// Returns `true` if a line is timed.
    pub(super) fn runs_by_clock(&self, line: usize) -> bool {
        self.lines[line] == GuardKind::Clock
    }
}
