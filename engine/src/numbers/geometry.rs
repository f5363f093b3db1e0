//! Integer rectangles in pixels, and directions with two `f64` components (`spec/01` §5, §6.1).

use crate::flat::bytes_of_fields;
/// An integer rectangle in pixels: its top-left corner and its size. The y axis points down.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct Rect {
    /// The left edge.
    pub x: i32,
    /// The top edge.
    pub y: i32,
    /// The width.
    pub w: i32,
    /// The height.
    pub h: i32,
}

bytes_of_fields! { Rect { x y w h } }

impl Rect {
    /// Returns `true` if the overlap of the two rectangles has a positive area. Empty rectangles never
    /// overlap.
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

    /// Returns `true` if `other` is not empty and lies completely inside this rectangle.
    pub fn contains(self, other: Rect) -> bool {
        other.w > 0
            && other.h > 0
            && other.x >= self.x
            && other.y >= self.y
            && other.x.saturating_add(other.w) <= self.x.saturating_add(self.w)
            && other.y.saturating_add(other.h) <= self.y.saturating_add(self.h)
    }

    /// Returns a rectangle of the same size with its top-left corner at (`x`, `y`).
    pub fn at(self, x: i32, y: i32) -> Rect {
        Rect { x, y, ..self }
    }

    /// Returns the centre of the rectangle.
    pub fn centre(self) -> (f64, f64) {
        (f64::from(self.x) + f64::from(self.w) / 2.0, f64::from(self.y) + f64::from(self.h) / 2.0)
    }
}

/// A direction or displacement. Equality compares components, so −0.0 equals 0.0.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Direction {
    /// The horizontal component, which is positive to the right.
    pub x: f64,
    /// The vertical component, which is positive downwards.
    pub y: f64,
}

bytes_of_fields! { Direction { x y } }

impl Direction {
    /// No direction.
    pub const NONE: Direction = Direction { x: 0.0, y: 0.0 };
    /// The reference's marker for a direction that has not been chosen yet.
    pub const NIL: Direction = Direction { x: -1.0, y: -1.0 };
    /// The unit vector up.
    pub const UP: Direction = Direction { x: 0.0, y: -1.0 };
    /// The unit vector to the left.
    pub const LEFT: Direction = Direction { x: -1.0, y: 0.0 };
    /// The unit vector down.
    pub const DOWN: Direction = Direction { x: 0.0, y: 1.0 };
    /// The unit vector to the right.
    pub const RIGHT: Direction = Direction { x: 1.0, y: 0.0 };
    /// The four unit vectors, in the order of every random choice and every loop over directions.
    pub const BASE: [Direction; 4] = [Direction::UP, Direction::LEFT, Direction::DOWN, Direction::RIGHT];

    /// Returns the direction as a unit vector. Zero stays zero.
    pub fn normalised(self) -> Direction {
        let length = (self.x * self.x + self.y * self.y).sqrt();
        if length == 0.0 { Direction::NONE } else { Direction { x: self.x / length, y: self.y / length } }
    }

    /// Returns the opposite direction. Zero components become −0.0, as in the reference.
    pub fn reversed(self) -> Direction {
        Direction { x: -self.x, y: -self.y }
    }
}
