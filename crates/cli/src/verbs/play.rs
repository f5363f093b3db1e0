//! `arcade play`: play a level in the terminal, watch a planner play it, or replay an episode.

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::{episodes, input, paths};
use agents::{Budget, PLANNERS, PlannerSpec};
use base::MessagePath;
use base::Seed;
use engine::Analysis;
use serde_json::json;
use std::path::{Path, PathBuf};
use terminal::{MAX_PACE, Player, Session, View};

/// Plays a level in the terminal: by hand, by a planner that you watch, or as a replay of a recorded episode.
///
/// Keys: arrows or WASD move, space uses, `.` waits, `p` pauses, `n` plays one tick, `u` takes one back, `r`
/// restarts, `+` and `-` change the pace, `t` changes between turn by turn and real time, Page Up and Page Down
/// scroll the rules, `q` quits. A game in which nothing happens unless you act waits for you; in the others the clock
/// runs.
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
    /// Forward-model calls of a decision, for a planner without a number of its own such as `mcts:500`
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
    /// Ticks a second, if the clock runs
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u16).range(1..=i64::from(MAX_PACE)))]
    fps: u16,
    /// Use no symbols beyond ASCII
    #[arg(long)]
    ascii: bool,
    /// Load the game as the reference engine does: overlook faults that it overlooks
    #[arg(long)]
    as_reference: bool,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let input = input::game(&args.game)?;
    if let Some(path) = &args.record {
        episodes::check(path, &input, args.level.as_deref().as_slice())?;
    }
    let game = input.compile(args.as_reference)?;
    let (named, level, recorded) =
        episodes::recorded(&input, &game, args.level.as_deref(), args.replay.as_deref())?;
    let own = Seed::from_text(&args.seed).child(&level.digest().to_string(), 0);
    let seed = recorded.as_ref().map_or(own.child("chance", 0), |episode| episode.seed);
    let player = match (recorded, &args.planner) {
        (Some(episode), _) => Player::Recording(episode.actions),
        (None, Some(name)) => {
            let spec: PlannerSpec = name.parse().map_err(Failure::malformed)?;
            let budget = spec.budget().unwrap_or(Budget(args.budget));
            let planner = Box::new(spec.player(own.child("planner", 0)));
            Player::Planner { name: spec.name().to_owned(), planner, budget }
        }
        (None, None) => Player::Person,
    };
    let analysis = Analysis::of(&game);
    let view = View::new(&analysis, title(&input.title, &named.name), args.ascii);
    let mut session = Session::begin((game, level), seed, player, analysis.is_turn_based(), args.fps);
    terminal::play(&mut session, &view)?;

    let episode = session.episode();
    let written = args.record.as_ref().filter(|_| !episode.actions.is_empty());
    if let Some(path) = written {
        episodes::write(path, episode)?;
    }
    let (ticks, score) = (episode.actions.len(), episode.score);
    console.document(&json!({
        "game": input.source.name,
        "level": named.name,
        "ticks": ticks,
        "score": score,
        "outcome": episode.outcome,
        "recorded": written.map(|path| paths::in_json(path)),
    }))?;
    let outcome = format!("{:?}", episode.outcome).to_lowercase();
    console.say(format_args!(
        "{}: {outcome} after {}, score {score}",
        named.name,
        base::count(ticks, "tick")
    ));
    if let Some(path) = args.record.as_deref().map(MessagePath::in_message) {
        console.say(match written {
            Some(_) => format!("recorded in {path}"),
            None => format!("nothing was played: {path} is not written"),
        });
    }
    Ok(true)
}

/// Returns the game and the file of the level, without their folders.
fn title(game: &str, level: &str) -> String {
    let file = |name: &str| {
        Path::new(name).file_name().map_or(name.to_owned(), |n| n.to_string_lossy().into_owned())
    };
    format!("{} {}", file(game), file(level))
}
