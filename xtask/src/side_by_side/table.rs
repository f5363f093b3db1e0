//! The comparison as a Markdown table.

use forge::games::survey::{Comparison, Group, Line, Unit};
use std::fmt::Write;

pub(super) fn markdown(comparison: &Comparison) -> String {
    let mut text = String::from(
        "| Line | Ours | Theirs | Difference (95 %) | Points | At least level |\n|---|---|---|---|---|---|\n",
    );
    for line in &comparison.lines {
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} |",
            name(line),
            group(&line.ours, line.unit),
            group(&line.theirs, line.unit),
            difference(line),
            line.points.map_or("–".to_owned(), |points| format!("{points:+.0}")),
            line.level.map_or("–", |level| if level { "yes" } else { "no" }),
        );
    }
    let _ = writeln!(text, "\nAt least level on {} of {} lines.", comparison.level(), comparison.lines.len());
    for (side, of) in [("ours", (|line| &line.ours) as fn(&Line) -> &Group), ("theirs", |line| &line.theirs)]
    {
        for line in &comparison.lines {
            for (reason, count) in &of(line).left_out {
                let _ = writeln!(text, "{}, {side}: {count} left out, {reason}.", line.name);
            }
        }
    }
    text
}

fn name(line: &Line) -> String {
    match line.unit {
        Unit::Share => format!("{} (share)", line.name),
        Unit::Scale | Unit::Count => format!("{} (mean)", line.name),
    }
}

fn group(group: &Group, unit: Unit) -> String {
    let Some(mean) = group.mean else { return "–".to_owned() };
    format!("{} of {}", figure(mean, unit), group.games)
}

fn difference(line: &Line) -> String {
    let (Some(difference), Some([low, high])) = (line.difference, line.interval) else {
        return "–".to_owned();
    };
    let figure = |value: f64| match line.unit {
        Unit::Share => format!("{:+.0}", 100.0 * value),
        Unit::Scale => format!("{value:+.2}"),
        Unit::Count => format!("{value:+.1}"),
    };
    format!("{} ({} to {})", figure(difference), figure(low), figure(high))
}

fn figure(value: f64, unit: Unit) -> String {
    match unit {
        Unit::Share => format!("{:.0} %", 100.0 * value),
        Unit::Scale => format!("{value:.2}"),
        Unit::Count => format!("{value:.1}"),
    }
}
