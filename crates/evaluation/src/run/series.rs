//! Series of levels. In a series, one player plays a game's levels in succession, and remembers the earlier
//! levels.

use crate::error::EvaluationError;
use crate::log::{Event, Journal};
use crate::player::{Contestant, Halt, Validity};
use crate::run::episode::{Context, PlayResult, Task, play_watched};

/// A series of episodes, in the order in which they are played. A level played alone is a series with one episode.
pub(crate) struct Series<'a> {
    pub(crate) tasks: &'a [Task<'a>],
    /// A function that receives the validity of each new decision, and can abort the episode.
    pub(crate) watch: &'a dyn Fn(Validity) -> Option<Halt>,
    /// A function that returns `true` once no further episodes should be started.
    pub(crate) is_stopped: &'a dyn Fn() -> bool,
}

/// Divides an evaluation's episodes into series.
pub(crate) fn series_of<'a>(tasks: &'a [Task<'a>]) -> Vec<&'a [Task<'a>]> {
    let is_next = |_: &Task<'_>, next: &Task<'_>| next.series.is_some_and(|place| place.index > 0);
    tasks.chunk_by(is_next).collect()
}

/// Plays the episodes of a series with one player. Returns the results of the episodes that were started,
/// each with `true` if it is practice. Ended episodes are replayed only if a later episode is open, so that
/// the player remembers them.
pub(crate) fn play_series(
    series: &Series<'_>,
    contestant: &impl Fn(&Task<'_>) -> Result<Contestant, Halt>,
    open: impl Fn(&Task<'_>) -> Result<Journal, EvaluationError>,
    played: &impl Fn(&Task<'_>, &PlayResult, &Journal),
) -> Result<Vec<(bool, PlayResult)>, EvaluationError> {
    let mut journals = series.tasks.iter().map(open).collect::<Result<Vec<Journal>, EvaluationError>>()?;
    let ending = |journal: &Journal| match journal.events().last() {
        Some(Event::End { outcome, .. }) => Some(*outcome),
        _ => None,
    };
    let all_ended = journals.iter().all(|journal| ending(journal).is_some());
    let Some(first) = series.tasks.first() else { return Ok(Vec::new()) };
    let mut player = None;
    let (mut previous, mut results) = (None, Vec::new());
    for (task, journal) in series.tasks.iter().zip(&mut journals) {
        let context = Context { previous: previous.as_ref(), watch: series.watch };
        let (result, end) = match ending(journal) {
            Some(outcome) if all_ended => (PlayResult::Ended(outcome), None),
            _ => match player.take().map_or_else(|| contestant(first), Ok) {
                Ok(mut own) => {
                    let played = play_watched(task, &mut own, journal, &context)?;
                    player = Some(own);
                    played
                }
                Err(halt) => (PlayResult::Halted(halt), None),
            },
        };
        previous = end;
        played(task, &result, journal);
        let is_over = matches!(result, PlayResult::Halted(_)) || (series.is_stopped)();
        results.push((task.is_practice(), result));
        if is_over {
            break;
        }
    }
    Ok(results)
}

/// Plays the episodes of one series, or a single episode, with one player, as in an evaluation. `open`
/// returns the log of an episode, and `played` receives each episode with its log. Returns the results of the
/// episodes that were started.
///
/// # Errors
/// Returns an error if a log belongs to a different episode, or cannot be written.
pub fn play_together(
    tasks: &[Task<'_>],
    contestant: &impl Fn(&Task<'_>) -> Result<Contestant, Halt>,
    open: impl Fn(&Task<'_>) -> Result<Journal, EvaluationError>,
    played: &impl Fn(&Task<'_>, &PlayResult, &Journal),
) -> Result<Vec<PlayResult>, EvaluationError> {
    let series = Series { tasks, watch: &|_| None, is_stopped: &|| false };
    let results = play_series(&series, contestant, open, played)?;
    Ok(results.into_iter().map(|(_, result)| result).collect())
}
