//! A canvas that builds SVG text.

use super::{Label, shortened};
use crate::page::facts::number;
use report::visible;
use std::fmt::Write;

/// The maximum length of a row name, in characters.
const LETTERS: usize = 18;

/// The part of a text that is placed at a given position.
#[derive(Clone, Copy, Debug)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// A drawing under construction. Later shapes cover earlier shapes.
pub(super) struct Canvas {
    text: String,
}

/// Escapes a text for XML, where control characters are not allowed.
fn escaped(text: &str) -> String {
    render::escaped(&visible(text))
}

impl Canvas {
    /// Creates an empty drawing of the given kind, with its size in pixels. `label` describes the drawing for
    /// people who cannot see it.
    pub(super) fn new(kind: &str, width: f64, height: f64, label: &str) -> Canvas {
        let (width, height, label) = (number(width), number(height), escaped(label));
        let text = format!(
            "<svg class=\"plot {kind}\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" role=\"img\" \
             aria-label=\"{label}\">\n"
        );
        Canvas { text }
    }

    /// Opens a group with the given class. `title` is its tooltip.
    pub(super) fn open(&mut self, class: &str, title: &str) {
        let _ = write!(self.text, "<g class=\"{class}\">");
        if !title.is_empty() {
            let _ = write!(self.text, "<title>{}</title>", escaped(title));
        }
    }

    /// Closes the most recently opened group.
    pub(super) fn close(&mut self) {
        self.text.push_str("</g>\n");
    }

    pub(super) fn rect(&mut self, [x, y, w, h]: [f64; 4]) {
        let [x, y, w, h] = [x, y, w, h].map(number);
        let _ = write!(self.text, "<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"/>");
    }

    pub(super) fn dot(&mut self, x: f64, y: f64, radius: f64, class: &str) {
        let [x, y, radius] = [x, y, radius].map(number);
        let _ = write!(self.text, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" class=\"{class}\"/>");
    }

    /// Draws polylines through the given points.
    pub(super) fn lines(&mut self, lines: &[&[[f64; 2]]], class: &str) {
        let ways: String = lines.iter().map(|points| way(points)).collect();
        let _ = write!(self.text, "<path class=\"{class}\" d=\"{ways}\"/>");
    }

    pub(super) fn area(&mut self, points: &[[f64; 2]], class: &str) {
        let _ = write!(self.text, "<path class=\"{class}\" d=\"{}Z\"/>", way(points));
    }

    /// Draws a text with its baseline at the given position.
    pub(super) fn text(&mut self, x: f64, y: f64, anchor: Anchor, class: &str, words: &str) {
        let (x, y, words) = (number(x), number(y), escaped(words));
        let anchor = match anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let class = if class.is_empty() { String::new() } else { format!(" class=\"{class}\"") };
        let _ = write!(self.text, "<text x=\"{x}\" y=\"{y}\"{anchor}{class}>{words}</text>");
    }

    /// Draws a row label to the left of a position. A one-line label is at the height of the position, and a
    /// two-line label is vertically centred on it. Each line is shortened to fit.
    pub(super) fn label(&mut self, x: f64, y: f64, Label { name, note }: &Label) {
        let lift = if note.is_empty() { 0.0 } else { 5.0 };
        self.text(x, y - lift, Anchor::End, "", &shortened(name, LETTERS));
        if !note.is_empty() {
            self.text(x, y + 6.0, Anchor::End, "soft", &shortened(note, LETTERS + 4));
        }
    }

    /// Draws a vertical text that reads upwards, with its middle at the given position.
    pub(super) fn upright(&mut self, x: f64, y: f64, class: &str, words: &str) {
        let (x, y, words) = (number(x), number(y), escaped(words));
        let _ = write!(
            self.text,
            "<text transform=\"translate({x} {y}) rotate(-90)\" text-anchor=\"middle\" class=\"{class}\">{words}</text>"
        );
    }

    /// Draws a grey, hatched rectangle that contains a dash, as a placeholder for a missing value.
    pub(super) fn missing(&mut self, [x, y, w, h]: [f64; 4], title: &str) {
        self.open("none", title);
        self.rect([x, y, w, h]);
        let far = |at: u32| f64::from(at) * 11.0;
        let strokes = (1..).take_while(|&at| far(at) < w + h).map(far);
        let stroke =
            |far: f64| [[x + far.min(w), y + (far - w).max(0.0)], [x + (far - h).max(0.0), y + far.min(h)]];
        let strokes: Vec<[[f64; 2]; 2]> = strokes.map(stroke).collect();
        self.lines(&strokes.iter().map(<[_; 2]>::as_slice).collect::<Vec<_>>(), "hatch");
        self.text(x + w / 2.0, y + h / 2.0 + 4.0, Anchor::Middle, "", crate::page::words::NONE);
        self.close();
    }

    pub(super) fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }
}

/// Returns the SVG path through the given points.
fn way(points: &[[f64; 2]]) -> String {
    let point = |(at, [x, y]): (usize, &[f64; 2])| {
        format!("{}{} {}", if at == 0 { 'M' } else { 'L' }, number(*x), number(*y))
    };
    points.iter().enumerate().map(point).collect()
}
