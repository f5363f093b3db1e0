//! The table of scores.

use super::recording::TransitionKind;
use super::score::{Reproduced, WorldModelScore};
use report::{Table, TableCell};

/// Returns a table of the scores of several games, pooled over all of their transitions, with one row per kind of
/// event.
pub fn table(scores: &[&WorldModelScore]) -> Table {
    let of_kind = |kind: TransitionKind| {
        let counts = scores.iter().filter_map(|score| score.kinds.get(&kind)).copied();
        (kind.name(), counts.sum::<Reproduced>())
    };
    let mut rows: Vec<_> = TransitionKind::ALL.into_iter().map(of_kind).collect();
    rows.push(("all", rows.iter().map(|(_, counts)| *counts).sum()));
    let percentage = |part: u64, counts: &Reproduced| {
        let all = counts.transitions;
        TableCell::number((all > 0).then(|| 100.0 * part as f64 / all as f64), 1)
    };
    Table::of(
        "world-models",
        "World models",
        "Held-out transitions reproduced by the games of the examinee, by the most important event of a transition.",
        &rows,
        &[
            ("event", &|row| TableCell::text(row.0)),
            ("transitions", &|row| TableCell::count(row.1.transitions)),
            ("board, %", &|row| percentage(row.1.board, &row.1)),
            ("state, %", &|row| percentage(row.1.state, &row.1)),
            ("first deviations", &|row| TableCell::count(row.1.first_deviations)),
        ],
    )
}
