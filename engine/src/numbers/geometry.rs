//! Integer rectangles in pixels and directions of two doubles (`spec/01` §5, §6.1).

use crate::flat::bytes_of_fields;
/// An integer rectangle: the top-left corner and the size, in pixels, y down.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct Rect {
    /// Left edge.
    pub x: i32,
    /// Top edge.
    pub y: i32,
    /// Width.
    pub w: i32,
    /// Height.
    pub h: i32,
}

bytes_of_fields! { Rect { x y w h } }

impl Rect {
    /// Tests whether the two share positive area; empty rectangles never do.
    pub fn intersects(self, other: Rect) -> bool {
        self.w > 0
            && self.h > 0
            && other.w > 0
            && other.h > 0
            && self.x < other.x.saturating_add(other.w)
            && other.x < self.x.saturating_add(self.w)
            && self.y < other.y.saturating_add(other.h)
            && other.y < self.y.saturating_add(self.h)
    }

    /// Tests whether `other` is not empty and lies wholly inside.
    pub fn contains(self, other: Rect) -> bool {
        other.w > 0
            && other.h > 0
            && other.x >= self.x
            && other.y >= self.y
            && other.x.saturating_add(other.w) <= self.x.saturating_add(self.w)
            && other.y.saturating_add(other.h) <= self.y.saturating_add(self.h)
    }

    /// A rectangle of the same size at another corner.
    pub fn at(self, x: i32, y: i32) -> Rect {
        Rect { x, y, ..self }
    }

    /// The centre, in doubles.
    pub fn centre(self) -> (f64, f64) {
        (f64::from(self.x) + f64::from(self.w) / 2.0, f64::from(self.y) + f64::from(self.h) / 2.0)
    }
}

/// A direction or displacement. Equality is that of the components, so −0.0 equals 0.0.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Direction {
    /// The horizontal component; positive is right.
    pub x: f64,
    /// The vertical component; positive is down.
    pub y: f64,
}

bytes_of_fields! { Direction { x y } }

impl Direction {
    /// No direction.
    pub const NONE: Direction = Direction { x: 0.0, y: 0.0 };
    /// The reference's marker for "not yet chosen".
    pub const NIL: Direction = Direction { x: -1.0, y: -1.0 };
    /// Up.
    pub const UP: Direction = Direction { x: 0.0, y: -1.0 };
    /// Left.
    pub const LEFT: Direction = Direction { x: -1.0, y: 0.0 };
    /// Down.
    pub const DOWN: Direction = Direction { x: 0.0, y: 1.0 };
    /// Right.
    pub const RIGHT: Direction = Direction { x: 1.0, y: 0.0 };
    /// The order of every random choice and every loop over directions.
    pub const BASE: [Direction; 4] = [Direction::UP, Direction::LEFT, Direction::DOWN, Direction::RIGHT];

    /// The direction with unit length; zero stays zero.
    pub fn normalised(self) -> Direction {
        let length = (self.x * self.x + self.y * self.y).sqrt();
        if length == 0.0 { Direction::NONE } else { Direction { x: self.x / length, y: self.y / length } }
    }

    /// The opposite; zero components become −0.0, as in the reference.
    pub fn reversed(self) -> Direction {
        Direction { x: -self.x, y: -self.y }
    }
}
