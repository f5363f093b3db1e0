//! The named constants in parameter values (`spec/01` §1.10).

use crate::numbers::geometry::Direction;

/// A constant's value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Constant {
    Direction(Direction),
    Int(i32),
    Color([u8; 3]),
    /// A constant of a kind that no parameter accepts.
    Unusable,
}

/// Returns the constant with this name; `None` if there is no such constant. The name is case-sensitive.
pub(crate) fn constant(name: &str) -> Option<Constant> {
    use Constant::{Color, Int};
    let bare = name.strip_prefix('D').filter(|rest| DIRECTIONS.iter().any(|(name, _)| name == rest));
    if let Some((_, direction)) = DIRECTIONS.iter().find(|(known, _)| *known == bare.unwrap_or(name)) {
        return Some(Constant::Direction(*direction));
    }
    if let Some((_, rgb)) = COLORS.iter().find(|(known, _)| *known == name) {
        return Some(Color(*rgb));
    }
    Some(match name {
        "PHYSICS_NONE" | "LEARNING_RESULT_DISQ" => Int(-1),
        "LEARNING_FINISH_ROUND" => Int(-2),
        "SCORE_DISQ" => Int(-1000),
        "GRID" | "VGDL_GAME_DEF" | "TYPE_AVATAR" | "DEFAULT_SINGLE_PLAYER_KEYIDX" => Int(0),
        "CONT" | "VGDL_SPRITE_SET" | "TYPE_RESOURCE" => Int(1),
        "VGDL_INTERACTION_SET" | "TYPE_PORTAL" => Int(2),
        "VGDL_LEVEL_MAPPING" | "TYPE_NPC" | "NUM_TRAINING_LEVELS" => Int(3),
        "VGDL_TERMINATION_SET" | "TYPE_STATIC" => Int(4),
        "VGDL_PARAMETER_SET" | "TYPE_FROMAVATAR" | "NUM_LEARNING_LEVELS" => Int(5),
        "TYPE_MOVABLE" => Int(6),
        "BASEDIRS" | "DBASEDIRS" | "ALL_ACTIONS" | "COLOR_DISC" | "RANDOM" => Constant::Unusable,
        _ => return None,
    })
}

const DIRECTIONS: &[(&str, Direction)] = &[
    ("UP", Direction::UP),
    ("DOWN", Direction::DOWN),
    ("LEFT", Direction::LEFT),
    ("RIGHT", Direction::RIGHT),
    ("NONE", Direction::NONE),
    ("NIL", Direction::NIL),
];

/// Returns the direction names, for suggestions.
pub(crate) fn direction_names() -> impl Iterator<Item = &'static str> {
    DIRECTIONS.iter().map(|(name, _)| *name)
}

/// The named colours, as red, green and blue components.
pub(crate) const COLORS: &[(&str, [u8; 3])] = &[
    ("GREEN", [0, 200, 0]),
    ("BLUE", [0, 0, 200]),
    ("RED", [200, 0, 0]),
    ("GRAY", [90, 90, 90]),
    ("WHITE", [250, 250, 250]),
    ("BROWN", [140, 120, 100]),
    ("BLACK", [0, 0, 0]),
    ("ORANGE", [250, 160, 0]),
    ("YELLOW", [250, 250, 0]),
    ("PINK", [250, 200, 200]),
    ("GOLD", [250, 212, 0]),
    ("LIGHTRED", [250, 50, 50]),
    ("LIGHTORANGE", [250, 200, 100]),
    ("LIGHTBLUE", [50, 100, 250]),
    ("LIGHTGREEN", [50, 250, 50]),
    ("DARKGREEN", [35, 117, 29]),
    ("LIGHTYELLOW", [255, 250, 128]),
    ("LIGHTGRAY", [238, 238, 238]),
    ("DARKGRAY", [30, 30, 30]),
    ("DARKBLUE", [20, 20, 100]),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_have_two_spellings_and_colours_one() {
        assert_eq!(constant("UP"), Some(Constant::Direction(Direction::UP)));
        assert_eq!(constant("DUP"), Some(Constant::Direction(Direction::UP)));
        assert_eq!(constant("DARKBLUE"), Some(Constant::Color([20, 20, 100])));
        assert_eq!(constant("up"), None);
        assert_eq!(constant("TYPE_STATIC"), Some(Constant::Int(4)));
    }
}
