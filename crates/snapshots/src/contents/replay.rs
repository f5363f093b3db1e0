//! Replays of witnesses within bounds that limit the cost of checking an untrusted release.

use engine::{Divergence, Episode, Game, Level, MAX_TICKS, Outcome, Watch};
use std::sync::atomic::{AtomicU64, Ordering};

/// The bound on the work of a release's replays. The unit of work is the same as in the engine's limit on one tick
/// ([`MAX_WORK`](engine::MAX_WORK)): visiting a sprite or a cell costs one unit. One core does about 50 to 200
/// million units per second.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bounds {
    /// The number of units allowed for every release.
    pub work: u64,
    /// The number of additional units for each level declared in the release.
    pub work_per_level: u64,
}

impl Bounds {
    /// 2³¹ units plus 2²¹ units per level, which is 10 to 60 seconds on one core. 2²¹ units allow 455 ticks of a game
    /// in which little happens.
    pub const RELEASE: Bounds = Bounds { work: 1 << 31, work_per_level: 1 << 21 };

    /// Returns the maximum number of units for a release with the given number of levels.
    pub fn of(&self, levels: usize) -> u64 {
        self.work.saturating_add(self.work_per_level.saturating_mul(levels as u64))
    }
}

/// A counter of the work of all replays of a release, shared between threads.
///
/// The result does not depend on the number of threads, because the limit applies to the total work of all replays.
pub(crate) struct Meter {
    limit: u64,
    spent: AtomicU64,
}

impl Meter {
    pub(crate) fn new(limit: u64) -> Meter {
        Meter { limit, spent: AtomicU64::new(0) }
    }

    /// Returns the limit if it was exceeded.
    pub(crate) fn exceeded(&self) -> Option<u64> {
        (self.spent() > self.limit).then_some(self.limit)
    }

    /// Returns the number of units spent so far.
    pub(crate) fn spent(&self) -> u64 {
        self.spent.load(Ordering::Relaxed)
    }

    fn spend(&self, units: u64) {
        // Relaxed ordering suffices. The sum cannot overflow, because 2^64 units would take a thousand years.
        self.spent.fetch_add(units, Ordering::Relaxed);
    }
}

/// The minimum number of units counted per tick. Among ticks with almost no counted work, the slowest take 50
/// microseconds.
const TICK: u64 = 4096;

/// The result of [`replay`].
pub(crate) enum Replayed {
    /// The episode matches its record and ends in a win.
    Won,
    /// The episode is invalid.
    Wrong(String),
    /// The replays' total work exceeded the limit.
    OutOfWork,
}

/// Replays a witness like [`Episode::replay`], as far as the meter permits. Episodes that cannot be witnesses
/// are rejected before the first tick.
pub(crate) fn replay(episode: &Episode, game: &Game, level: &Level, meter: &Meter) -> Replayed {
    let wrong = |divergence: Divergence| Replayed::Wrong(divergence.to_string());
    if episode.game != game.digest() {
        return wrong(Divergence::Game { recorded: episode.game, given: game.digest() });
    }
    if episode.level != level.digest() {
        return wrong(Divergence::Level { recorded: episode.level, given: level.digest() });
    }
    let (actions, hashes) = (episode.actions.len(), episode.hashes.len());
    if actions != hashes {
        return wrong(Divergence::Lengths { actions, hashes });
    }
    if actions > MAX_TICKS as usize {
        return Replayed::Wrong(format!(
            "the episode has {actions} ticks, more than the limit of {MAX_TICKS}"
        ));
    }
    if episode.outcome != Outcome::Won {
        return Replayed::Wrong("the episode does not win".to_owned());
    }
    let mut state = game.start(level, episode.seed);
    meter.spend((level.columns() * level.rows()) as u64);
    for (tick, (&action, &recorded)) in episode.actions.iter().zip(&episode.hashes).enumerate() {
        if meter.exceeded().is_some() {
            return Replayed::OutOfWork;
        }
        if state.is_over() {
            return Replayed::Wrong(format!("the episode ends in tick {tick}, but contains further actions"));
        }
        let mut work = Work(0);
        game.step_watched(&mut state, action, &mut work);
        meter.spend(TICK + work.0);
        let got = state.state_hash();
        if got != recorded {
            return wrong(Divergence::Hash { tick, recorded, got });
        }
    }
    let (got, score) = (state.outcome(), state.score());
    if got != episode.outcome || score != episode.score {
        let (recorded, recorded_score) = (episode.outcome, episode.score);
        return wrong(Divergence::End { recorded, recorded_score, got, score });
    }
    Replayed::Won
}

/// Returns the reason why an episode does not replay to a win within the bounds for a one-level release; `None` if
/// it does.
pub(crate) fn problem(episode: &Episode, game: &Game, level: &Level) -> Option<String> {
    match replay(episode, game, level, &Meter::new(Bounds::RELEASE.of(1))) {
        Replayed::Won => None,
        Replayed::Wrong(what) => Some(what),
        Replayed::OutOfWork => {
            Some("replaying the episode takes more work than a release may require".to_owned())
        }
    }
}

/// A watch that records the work of a single tick.
struct Work(u64);

impl Watch for Work {
    fn interaction(&mut self, _: usize) {}

    fn worked(&mut self, work: usize) {
        self.0 = work as u64;
    }
}
