//! The vector shapes of tiles: the common input of both back-ends.
//!
//! A tile is a unit square with x to the right and y down, both from 0 to 1. Nothing is transparent, so an image
//! needs few colours, and looks the same however its tiles are layered.

use super::colour::Colour;

/// A point in the unit square.
pub type Point = [f32; 2];

/// The distance from each end point of a quarter circle to its control point, as a fraction of the radius, in the usual
/// cubic Bézier approximation. The error is at most 0.03%.
const QUARTER: f32 = 0.552_284_8;

/// A step of an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Segment {
    /// The start of a new part at the given point.
    Move(Point),
    /// A straight line to the given point.
    Line(Point),
    /// A cubic Bézier curve, given by two control points and the end.
    Cubic(Point, Point, Point),
    /// A line back to the start of the part.
    Close,
}

/// A path, which may be open or closed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outline(pub Vec<Segment>);

/// An outline's paint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Paint {
    /// The outline is filled (non-zero winding rule).
    Fill,
    /// The outline is drawn as a line of the given width, in tiles, with round ends and corners.
    Stroke(f32),
}

/// An outline with its paint.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// The outline.
    pub outline: Outline,
    /// The outline's paint.
    pub paint: Paint,
    /// The colour.
    pub colour: Colour,
}

impl Outline {
    /// Parses the outline in one of this crate's own SVG paths, such as `M.1,.2 L.3,.4 C.5,.6,.7,.8,.9,1 Z`,
    /// with absolute coordinates, and with spaces only between commands.
    pub(crate) fn path(path: &str) -> Outline {
        let segment = |command: &str| {
            let numbers = command[1..].split(',').filter_map(|number| number.parse().ok());
            match (&command[..1], &numbers.collect::<Vec<f32>>()[..]) {
                ("M", &[x, y]) => Segment::Move([x, y]),
                ("L", &[x, y]) => Segment::Line([x, y]),
                ("C", &[ax, ay, bx, by, x, y]) => Segment::Cubic([ax, ay], [bx, by], [x, y]),
                ("Z", []) => Segment::Close,
                _ => unreachable!("`{command}` is not a command, and a test draws every tile"),
            }
        };
        Outline(path.split(' ').map(segment).collect())
    }

    /// Returns an open line through the given points.
    pub(crate) fn line(points: &[Point]) -> Outline {
        let step = |(at, &point): (usize, &Point)| match at {
            0 => Segment::Move(point),
            _ => Segment::Line(point),
        };
        Outline(points.iter().enumerate().map(step).collect())
    }

    /// Returns a closed line through the given points.
    pub(crate) fn polygon(points: &[Point]) -> Outline {
        let mut outline = Outline::line(points);
        outline.0.push(Segment::Close);
        outline
    }

    pub(crate) fn rect(x: f32, y: f32, w: f32, h: f32) -> Outline {
        Outline::polygon(&[[x, y], [x + w, y], [x + w, y + h], [x, y + h]])
    }

    /// Returns a rectangle with rounded corners of radius `r`.
    pub(crate) fn rounded(x: f32, y: f32, w: f32, h: f32, r: f32) -> Outline {
        let (k, right, bottom) = (r * (1.0 - QUARTER), x + w, y + h);
        Outline(vec![
            Segment::Move([x + r, y]),
            Segment::Line([right - r, y]),
            Segment::Cubic([right - k, y], [right, y + k], [right, y + r]),
            Segment::Line([right, bottom - r]),
            Segment::Cubic([right, bottom - k], [right - k, bottom], [right - r, bottom]),
            Segment::Line([x + r, bottom]),
            Segment::Cubic([x + k, bottom], [x, bottom - k], [x, bottom - r]),
            Segment::Line([x, y + r]),
            Segment::Cubic([x, y + k], [x + k, y], [x + r, y]),
            Segment::Close,
        ])
    }

    pub(crate) fn circle(x: f32, y: f32, r: f32) -> Outline {
        Outline::ellipse(x, y, r, r)
    }

    pub(crate) fn ellipse(x: f32, y: f32, rx: f32, ry: f32) -> Outline {
        let (kx, ky) = (rx * QUARTER, ry * QUARTER);
        Outline(vec![
            Segment::Move([x + rx, y]),
            Segment::Cubic([x + rx, y + ky], [x + kx, y + ry], [x, y + ry]),
            Segment::Cubic([x - kx, y + ry], [x - rx, y + ky], [x - rx, y]),
            Segment::Cubic([x - rx, y - ky], [x - kx, y - ry], [x, y - ry]),
            Segment::Cubic([x + kx, y - ry], [x + rx, y - ky], [x + rx, y]),
            Segment::Close,
        ])
    }

    /// Returns a star or a similar round zigzag, with `points` tips at distance `outer` from the centre, and notches
    /// at distance `inner`. One tip is at the top.
    pub(crate) fn star(x: f32, y: f32, points: u16, outer: f32, inner: f32) -> Outline {
        let corner = |at: u16| {
            let turn = std::f32::consts::PI * f32::from(at) / f32::from(points);
            let radius = if at.is_multiple_of(2) { outer } else { inner };
            [x + radius * libm::sinf(turn), y - radius * libm::cosf(turn)]
        };
        Outline::polygon(&(0..2 * points).map(corner).collect::<Vec<Point>>())
    }

    /// Returns the outline with every point mapped by `place`.
    pub(crate) fn mapped(mut self, place: impl Fn(Point) -> Point) -> Outline {
        for segment in &mut self.0 {
            match segment {
                Segment::Move(point) | Segment::Line(point) => *point = place(*point),
                Segment::Cubic(one, two, end) => {
                    (*one, *two, *end) = (place(*one), place(*two), place(*end));
                }
                Segment::Close => {}
            }
        }
        self
    }

    /// Returns the outline rotated around the middle of the tile, so that right becomes the unit vector
    /// `direction`.
    pub(crate) fn turned(self, [cos, sin]: Point) -> Outline {
        self.mapped(|[x, y]| {
            let (x, y) = (x - 0.5, y - 0.5);
            [0.5 + x * cos - y * sin, 0.5 + x * sin + y * cos]
        })
    }

    /// Returns the mirror image, in which x becomes `1 - x`.
    pub(crate) fn mirrored(self) -> Outline {
        self.mapped(|[x, y]| [1.0 - x, y])
    }
}

/// Returns a direction as a unit vector, or `None` for a direction of length zero.
pub(crate) fn unit((x, y): (f64, f64)) -> Option<Point> {
    let length = (x * x + y * y).sqrt();
    (length > 0.0).then(|| [(x / length) as f32, (y / length) as f32])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turning_goes_clockwise_from_the_right() {
        let nose = || Outline::line(&[[0.5, 0.5], [1.0, 0.5]]);
        let end = |outline: Outline| match outline.0[1] {
            Segment::Line(point) => point,
            _ => [0.0, 0.0],
        };
        assert_eq!(end(nose().turned([0.0, 1.0])), [0.5, 1.0]);
        assert_eq!(end(nose().turned([-1.0, 0.0])), [0.0, 0.5]);
        assert_eq!(end(nose().mirrored()), [0.0, 0.5]);
    }

    #[test]
    fn stars_have_two_corners_a_tip() {
        assert_eq!(Outline::star(0.5, 0.5, 5, 0.4, 0.2).0.len(), 11);
    }
}
