//! Plays a level in the terminal.

use super::{Args, MAX_PACE};
use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::input::episodes;
use crate::{input, paths};
use agents::{Budget, PlannerSpec};
use base::{MessagePath, Seed};
use engine::Analysis;
use serde_json::json;
use std::path::Path;
use terminal::{Player, Session, View};

const _: () = assert!(MAX_PACE == terminal::MAX_PACE as i64);

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
            None => format!("nothing was played, so {path} was not written"),
        });
    }
    Ok(true)
}

/// Returns the names of the game and the level file, without their folders.
fn title(game: &str, level: &str) -> String {
    let file = |name: &str| {
        Path::new(name).file_name().map_or(name.to_owned(), |n| n.to_string_lossy().into_owned())
    };
    format!("{} {}", file(game), file(level))
}
