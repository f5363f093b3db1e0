//! Designers' scores as a table.

use super::DesignerScore;
use report::{Table, TableCell};

/// Returns a table with one column per designer: the percentage of drafts that reach each step, and the costs per
/// accepted game, with 95% intervals.
pub fn table(scores: &[DesignerScore]) -> Table {
    let names = scores.iter().map(|score| score.designer.as_str());
    let columns: Vec<&str> = ["measure"].into_iter().chain(names).collect();
    let note = "Percentages of drafts, and costs per accepted game, with 95% intervals over drafts.";
    let mut table = Table::new("designers", "Designers", note, &columns);
    let mut row = |name: &str, cell: &dyn Fn(&DesignerScore) -> TableCell| {
        table.push([TableCell::text(name)].into_iter().chain(scores.iter().map(cell)).collect());
    };
    row("drafts", &|score| TableCell::Count(score.drafts));
    let mut steps: Vec<&str> = Vec::new();
    for rate in scores.iter().flat_map(|score| &score.rates) {
        if !steps.contains(&rate.step.as_str()) {
            steps.push(&rate.step);
        }
    }
    for step in steps {
        row(&format!("{step}, %"), &|score| {
            let rate = score.rates.iter().find(|rate| rate.step == step && score.drafts > 0);
            rate.map_or(TableCell::Missing, |rate| {
                let value = 100.0 * rate.count as f64 / score.drafts as f64;
                let (low, high) = (100.0 * rate.low, 100.0 * rate.high);
                TableCell::Interval { value, low, high, digits: 0 }
            })
        });
    }
    row("median distance", &|score| TableCell::number(score.distance, 2));
    for (at, digits) in [1, 1, 0, 4].into_iter().enumerate() {
        let Some(unit) = scores.first().and_then(|score| score.costs.get(at)).map(|cost| &cost.unit) else {
            break;
        };
        row(&format!("{unit} per game"), &|score| {
            let Some(cost) = score.costs.get(at) else { return TableCell::Missing };
            match (cost.value, cost.low, cost.high) {
                (Some(value), Some(low), Some(high)) => TableCell::Interval { value, low, high, digits },
                (value, ..) => TableCell::number(value, digits),
            }
        });
    }
    table
}
