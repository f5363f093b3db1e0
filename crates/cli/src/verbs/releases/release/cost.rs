//! The cost of a mint on this machine.

use super::probe;
use snapshots::Corpus;
use snapshots::mint::{Forecast, Job, Plan};

/// The minimum expected duration of a mint, in seconds on one core, for printing the command that resumes it.
pub(crate) const LONG: f64 = 30.0;

/// The minimum expected duration of a mint, in seconds on one core, for which measuring the machine's speed
/// is worth a third of a second.
const PROBED: f64 = 30.0;

/// Returns the cost of jobs on this machine. If the machine's speed was probed, also returns its slowdown
/// relative to the machine on which the costs were measured.
pub(crate) fn forecast(plan: &Plan<'_>, jobs: &[Job], corpus: &Corpus) -> (Forecast, Option<f64>) {
    let usual = plan.forecast(jobs);
    let slowness = if usual.median >= PROBED { probe::slowness(corpus) } else { None };
    (usual.times(slowness.unwrap_or(1.0)), slowness)
}

/// Returns the cost as text.
pub(crate) fn words(Forecast { median, tail }: Forecast) -> String {
    if tail == 0.0 {
        return "0 seconds: there is nothing to make".to_owned();
    }
    format!("about {} on one core; one mint in twenty takes more than {}", duration(median), duration(tail))
}

/// Formats a number of seconds in a suitable unit.
fn duration(seconds: f64) -> String {
    match seconds {
        _ if seconds < 1.5 => "a second".to_owned(),
        _ if seconds < 120.0 => format!("{seconds:.0} seconds"),
        _ if seconds < 7200.0 => format!("{:.0} minutes", seconds / 60.0),
        _ => format!("{:.1} hours", seconds / 3600.0),
    }
}
