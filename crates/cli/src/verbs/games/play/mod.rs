//! `arcade play`: plays a level in the terminal, lets a planner play it, or replays an episode.

#[cfg(feature = "terminal")]
mod on_screen;

#[cfg(feature = "terminal")]
pub(crate) use on_screen::run;

use agents::{Budget, PLANNERS};
use std::path::PathBuf;

/// The maximum pace in ticks per second, equal to the maximum in the crate `terminal`.
const MAX_PACE: i64 = 60;

/// Plays a level in the terminal: by hand, by a planner that you watch, or as a replay of a recorded episode.
///
/// Keys: arrows or WASD move, space uses, `.` waits, `p` pauses, `n` plays one tick, `u` undoes one, `r` restarts, `+`
/// and `-` change the pace, `t` switches between turn-based play and real time, Page Up and Page Down scroll the rules,
/// `q` quits. A game in which nothing happens unless you act waits for you; in other games, the clock runs.
///
/// Example: arcade play quiet-jars 0 --record win.json
#[derive(clap::Args)]
pub(crate) struct Args {
    /// A .vgdl or .txt file, a folder with game.vgdl or game.txt, a level beside its game, or the name of a corpus game
    #[arg(value_name = "GAME")]
    game: String,
    /// A level file, or the number of one of the game's own levels; by default the recording's level, or the first
    #[arg(value_name = "LEVEL")]
    level: Option<String>,
    #[arg(long, value_name = "NAME", help = format!("Watch this planner play: {}", PLANNERS.join(", ")))]
    planner: Option<String>,
    /// Forward-model calls per decision, unless the planner's name states them, as in `mcts:500`
    #[arg(long, value_name = "CALLS", default_value_t = 1000, allow_negative_numbers = true,
        value_parser = clap::value_parser!(u64).range(0..=Budget::MOST.0))]
    budget: u64,
    /// Text to derive the seeds of the game and the planner from
    #[arg(long, value_name = "TEXT", default_value = "play")]
    seed: String,
    /// Write the episode to this file when you quit; `arcade render --episode` shows it
    #[arg(long, value_name = "FILE", conflicts_with = "replay")]
    record: Option<PathBuf>,
    /// Watch a recorded episode
    #[arg(long, value_name = "FILE", conflicts_with = "planner")]
    replay: Option<PathBuf>,
    /// Ticks per second while the clock is running
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u16).range(1..=MAX_PACE))]
    fps: u16,
    /// Use ASCII symbols only
    #[arg(long)]
    ascii: bool,
    /// Load the game as the reference engine does, and tolerate the faults that it tolerates
    #[arg(long)]
    as_reference: bool,
}

/// Rejects the command, because this build lacks the terminal player.
#[cfg(not(feature = "terminal"))]
pub(crate) fn run(_: &Args, _: &crate::console::Console) -> crate::failure::Answer {
    Err(malformed!("this program was built without the `terminal` feature: use `arcade studio`"))
}
