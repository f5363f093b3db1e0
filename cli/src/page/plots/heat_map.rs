//! Heat maps: a value for each row and column, as a colour and in digits.

use super::canvas::{Anchor, Canvas};
use super::{Label, shortened, step};

/// Pixels of the rows' names, of a cell, and of the columns' names above.
const LEFT: f64 = 142.0;
const CELL: [f64; 2] = [38.0, 28.0];
const TOP: f64 = 36.0;
/// The gap between two groups of columns.
const GAP: f64 = 8.0;

pub(crate) struct HeatMap<'a> {
    pub(crate) label: &'a str,
    pub(crate) rows: &'a [Label],
    /// The groups of columns, each with the names of its columns: a game with its levels.
    pub(crate) groups: &'a [(String, Vec<String>)],
    /// By row, then by column; `None` is missing.
    pub(crate) cells: &'a [Vec<Option<f64>>],
    /// The values at the two ends of the scale.
    pub(crate) scale: [f64; 2],
    /// A value in at most four letters.
    pub(crate) show: fn(f64) -> String,
}

/// Draws the heat map. Cost: O(cells).
pub(crate) fn heat_map(map: &HeatMap<'_>) -> String {
    let columns: usize = map.groups.iter().map(|(_, names)| names.len()).sum();
    let gaps = map.groups.len().saturating_sub(1) as f64 * GAP;
    let width = LEFT + columns as f64 * CELL[0] + gaps + 2.0;
    let mut canvas = Canvas::new("heat-map", width, TOP + map.rows.len() as f64 * CELL[1] + 2.0, map.label);
    let top = |row: usize| TOP + row as f64 * CELL[1];
    for (row, label) in map.rows.iter().enumerate() {
        canvas.label(LEFT - 8.0, top(row) + 18.0, label);
    }
    let (mut left, mut column) = (LEFT, 0);
    for (group, names) in map.groups {
        // A letter of a name is about seven pixels wide, and the name may extend over the gap.
        let room = (names.len() as f64 * CELL[0] / 6.6) as usize;
        canvas.text(left + 2.0, 14.0, Anchor::Start, "head", &shortened(group, room.max(4)));
        for name in names {
            canvas.text(left + CELL[0] / 2.0, TOP - 6.0, Anchor::Middle, "soft", name);
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
        left += GAP;
    }
    canvas.finish()
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
    fn titles_of_groups_stay_above_their_columns() {
        let groups = ["hands-off-the-fuse-cord", "the-kneaders-stand"];
        let groups = groups.map(|name| (name.to_owned(), vec!["0".to_owned()]));
        let svg = heat_map(&HeatMap {
            label: "win rate",
            rows: &[label("random", "")],
            groups: &groups,
            cells: &[vec![Some(0.0), Some(1.0)]],
            scale: [0.0, 1.0],
            show: |value| format!("{value}"),
        });
        // The second title starts a cell and a gap later; a letter is less than eight pixels wide.
        let letters = ((CELL[0] + GAP) / 8.0) as usize;
        let titles: Vec<&str> =
            svg.split("class=\"head\">").skip(1).map(|rest| rest.split('<').next().unwrap()).collect();
        assert_eq!(titles, ["ha…rd", "th…nd"]);
        assert!(titles.iter().all(|title| title.chars().count() <= letters), "{titles:?}");
    }
}
