//! Direction names.

use engine::Direction;

/// Returns `up`, `left`, `down` or `right`, or `None` for other directions.
pub(crate) fn direction_name(direction: Direction) -> Option<&'static str> {
    let names = [
        (Direction::UP, "up"),
        (Direction::LEFT, "left"),
        (Direction::DOWN, "down"),
        (Direction::RIGHT, "right"),
    ];
    names.iter().find(|(known, _)| *known == direction).map(|(_, name)| *name)
}
