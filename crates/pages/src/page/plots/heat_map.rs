//! Heat maps, which show one value per row and column, as a colour and as text.

use super::canvas::{Anchor, Canvas};
use super::{Label, step};

/// The width reserved for row names, in pixels.
const LEFT: f64 = 142.0;
/// The width and height of a cell, in pixels.
const CELL: [f64; 2] = [38.0, 28.0];
/// The height reserved for column names above the cells, in pixels.
const TOP: f64 = 36.0;
/// The line height in titles, in pixels.
const LINE: f64 = 15.0;
/// The maximum width of a character, in pixels.
const LETTER: f64 = 7.4;
/// The maximum number of characters per line in a title wider than the columns below it.
const LETTERS: usize = 14;
/// The gap between groups of columns, in pixels.
const GAP: f64 = 8.0;

pub(crate) struct HeatMap<'a> {
    pub(crate) label: &'a str,
    pub(crate) rows: &'a [Label],
    /// The column groups, each with its title and its column names. A group is a game with its levels.
    pub(crate) groups: &'a [(String, Vec<String>)],
    /// The values by row and column, with `None` for a missing value.
    pub(crate) cells: &'a [Vec<Option<f64>>],
    /// The values at the low end and at the high end of the scale.
    pub(crate) scale: [f64; 2],
    /// A function that formats a value in at most four characters.
    pub(crate) show: fn(f64) -> String,
}

/// Draws the heat map. Cost: O(cells).
pub(crate) fn heat_map(map: &HeatMap<'_>) -> String {
    let titles: Vec<Vec<String>> =
        map.groups.iter().map(|(title, names)| title_lines(title, names.len())).collect();
    let lines = titles.iter().map(Vec::len).max().unwrap_or(1);
    let head = TOP + lines.saturating_sub(1) as f64 * LINE;
    let widths: Vec<f64> = map.groups.iter().map(|(title, names)| group_width(title, names.len())).collect();
    let width = LEFT + widths.iter().sum::<f64>() - GAP + 2.0;
    let mut canvas = Canvas::new("heat-map", width, head + map.rows.len() as f64 * CELL[1] + 2.0, map.label);
    let top = |row: usize| head + row as f64 * CELL[1];
    for (row, label) in map.rows.iter().enumerate() {
        canvas.label(LEFT - 8.0, top(row) + 18.0, label);
    }
    let (mut left, mut column) = (LEFT, 0);
    for (((group, names), title), width) in map.groups.iter().zip(&titles).zip(&widths) {
        let next = left + width;
        for (line, words) in title.iter().enumerate() {
            canvas.text(left + 2.0, 14.0 + line as f64 * LINE, Anchor::Start, "head", words);
        }
        for name in names {
            canvas.text(left + CELL[0] / 2.0, head - 6.0, Anchor::Middle, "soft", name);
            for (row, label) in map.rows.iter().enumerate() {
                let place = [left + 0.5, top(row) + 0.5, CELL[0] - 1.0, CELL[1] - 1.0];
                let title = |value: &str| {
                    let note =
                        if label.note.is_empty() { String::new() } else { format!(" · {}", label.note) };
                    format!("{}{note}, {group} {name}: {value}", label.name)
                };
                match map.cells[row][column].filter(|value| value.is_finite()) {
                    None => canvas.missing(place, &title("no value")),
                    Some(value) => {
                        let shown = (map.show)(value);
                        canvas.open(&format!("q{}", step(value, map.scale[0], map.scale[1])), &title(&shown));
                        canvas.rect(place);
                        canvas.text(left + CELL[0] / 2.0, top(row) + 18.0, Anchor::Middle, "", &shown);
                        canvas.close();
                    }
                }
            }
            left += CELL[0];
            column += 1;
        }
        left = next;
    }
    canvas.finish()
}

/// Returns a column group's width in pixels, including the gap after it. A group is as wide as its columns or
/// its title, whichever is wider.
pub(crate) fn group_width(title: &str, columns: usize) -> f64 {
    let lines = title_lines(title, columns);
    let longest = lines.iter().map(|line| line.chars().count()).max().unwrap_or(0);
    (columns as f64 * CELL[0]).max(longest as f64 * LETTER) + GAP
}

/// Breaks a title above columns into lines. Lines are broken between words, after hyphens, or within words
/// that are longer than a line.
fn title_lines(title: &str, columns: usize) -> Vec<String> {
    let room = ((columns as f64 * CELL[0] / LETTER) as usize).max(LETTERS);
    let mut lines = vec![String::new()];
    for word in title.split_inclusive([' ', '-']) {
        let letters: Vec<char> = word.chars().collect();
        for piece in letters.chunks(room) {
            let piece: String = piece.iter().collect();
            let last = lines.last_mut().expect("the text has a first line");
            if last.is_empty() || last.chars().count() + piece.trim_end().chars().count() <= room {
                last.push_str(&piece);
            } else {
                lines.push(piece);
            }
        }
    }
    lines.iter().map(|line| line.trim_end().to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn label(name: &str, note: &str) -> Label {
        Label { name: name.to_owned(), note: note.to_owned() }
    }

    fn drawn(cells: &[Vec<Option<f64>>]) -> String {
        let rows = [label("random", ""), label("small & \"wise\"", "zero-shot")];
        let groups = [
            ("Hailglass".to_owned(), vec!["0".to_owned(), "1".to_owned()]),
            ("Pond".to_owned(), vec!["0".to_owned()]),
        ];
        heat_map(&HeatMap {
            label: "win rate",
            rows: &rows,
            groups: &groups,
            cells,
            scale: [0.0, 1.0],
            show: |value| format!("{:.0}", 100.0 * value),
        })
    }

    #[test]
    fn values_are_shown_and_gaps_hatched() {
        let cells = [vec![Some(0.0), Some(0.5), None], vec![Some(1.0), Some(f64::NAN), Some(0.25)]];
        let svg = drawn(&cells);
        for value in [">0<", ">50<", ">100<", ">25<", "class=\"q0\"", "class=\"q10\""] {
            assert!(svg.contains(value), "{value} in {svg}");
        }
        assert_eq!(svg.matches("class=\"none\"").count(), 2);
        assert!(!svg.contains("NaN") && svg.contains("small &amp; &quot;wise&quot;"));
        assert_eq!(svg.matches("<g ").count(), svg.matches("</g>").count());
    }

    #[test]
    fn titles_are_whole_and_apart() {
        for title in [
            "hands-off-the-fuse-cord",
            "Before the Canal Ice Goes Out",
            "pneumonoultramicroscopic",
            "Pond",
            "",
        ] {
            for columns in [1, 2, 6] {
                let lines = title_lines(title, columns);
                assert_eq!(lines.concat().replace(' ', ""), title.replace(' ', ""));
                let room = group_width(title, columns) - GAP;
                assert!(lines.iter().all(|line| line.chars().count() as f64 * LETTER <= room), "{lines:?}");
            }
        }
        assert_eq!(title_lines("hands-off-the-fuse-cord", 1), ["hands-off-the-", "fuse-cord"]);
        assert_eq!(title_lines("The Kneader's Stand", 6), ["The Kneader's Stand"]);
    }
}
