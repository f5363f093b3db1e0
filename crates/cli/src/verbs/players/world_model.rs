//! `arcade world-model`: examines players that write games from recordings.

use super::evaluate::subjects::{self, Wanted};
use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::interrupt;
use crate::paths;
use crate::protected;
use crate::shell;
use base::canonical::to_canonical_json;
use base::{Digest, MessagePath};
use disk::Access;
use engine::{Outcome, SEMANTICS};
use evaluation::client::{ChatMessage, ChatReply, Finish};
use evaluation::player::mailbox::{Address, EpisodeResult, Finished, Mailbox};
use evaluation::world_model::{
    Examined, Hints, MAX_ATTEMPTS, WorldModelSettings, WorldModelTask, examine, induce, table,
};
use evaluation::{Halt, Journal};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Examines how well a player works out the rules of games from recordings.
///
/// The player sees the levels of a game under meaningless names, and recordings of an exploring player, but no rules.
/// It writes the game in VGDL. The score is the percentage of other recorded steps that its game reproduces exactly:
/// the board, and the whole observable state. A fixed planner also plans wins with its game and plays them in the true
/// game. Only deterministic levels are used, at most three per game. The command writes to OUT: the questions and
/// answers in logs/, the player's games in games/, and results.json. See `arcade docs world-model`.
///
/// Exit status 0: all games were examined. 3: a file could not be written; --resume continues.
///
/// Example: arcade world-model first-ice --player induce --out models
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Games, or one snapshot; corpus games by name
    #[arg(value_name = "GAMES", required = true)]
    subjects: Vec<String>,
    /// `induce` (the reference player, a program), or `mailbox:DIR`, for any program or person that answers the files
    /// in a folder
    #[arg(long, value_name = "NAME")]
    player: String,
    /// Words of VGDL to list in the question: `used` (those of the game), `candidates` (all deterministic
    /// ones) or `none`
    #[arg(long, value_name = "LEVEL", default_value = "used", value_parser = hints)]
    hints: Hints,
    /// Number of recorded episodes to show. The same number of other episodes is used for the score
    #[arg(long, value_name = "N", default_value_t = 6, value_parser = clap::value_parser!(u64).range(1..=100))]
    episodes: u64,
    /// Let the player explore with this number of actions, instead of showing recorded episodes
    #[arg(long, value_name = "ACTIONS", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=10_000))]
    explore: u16,
    /// Maximum number of actions per episode
    #[arg(long, value_name = "N", default_value_t = 40, value_parser = clap::value_parser!(u16).range(1..=1000))]
    steps: u16,
    /// Text to derive all seeds from
    #[arg(long, value_name = "TEXT", default_value = "world model")]
    seed: String,
    /// Output folder for the logs, games and results (new or empty)
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Continue an interrupted examination that the same command started
    #[arg(long)]
    resume: bool,
}

/// The file with the settings of an examination.
const SETTINGS_FILE: &str = "settings.json";

/// The settings of an examination, which must be the same when it is resumed.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct RunSettings {
    format: u32,
    semantics: u32,
    player: String,
    task: WorldModelSettings,
    /// The digests of the games, by ID.
    games: BTreeMap<String, Digest>,
}

enum Player {
    Induce,
    Mailbox(Arc<Mailbox>),
}

fn hints(text: &str) -> Result<Hints, String> {
    let found = Hints::ALL.into_iter().find(|hints| hints.name() == text);
    found.ok_or_else(|| "expected `used`, `candidates` or `none`".to_owned())
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let wanted = Wanted { subjects: &args.subjects, games: &[], levels: &[], as_reference: false };
    let games = subjects::read(&wanted)?.games;
    let task = WorldModelSettings {
        hints: args.hints,
        episodes: args.episodes,
        actions: usize::from(args.explore),
        steps: usize::from(args.steps),
        seed: args.seed.clone(),
    };
    let mut tasks = Vec::new();
    for subject in &games {
        match WorldModelTask::new(subject, &task) {
            Ok(task) => tasks.push(task),
            Err(error) if games.len() > 1 => console.remark(format_args!("left out: {error}")),
            Err(error) => return Err(error.into()),
        }
    }
    if tasks.is_empty() {
        bail!("none of the games has a deterministic level; choose other games");
    }
    let digests = games.iter().map(|subject| (subject.id.clone(), subject.game.digest())).collect();
    let (format, semantics, player) = (1, SEMANTICS, args.player.clone());
    let settings = RunSettings { format, semantics, player, task, games: digests };
    let player = open(args, &settings, console)?;
    let hint = format!("interrupted: all answers are in {}; continue with --resume", args.out.in_message());
    interrupt::watch(|| (), hint);
    let mut examined = Vec::new();
    for task in &tasks {
        let result = one(args, &player, task)?;
        console.say(line(&task.id, &result));
        examined.push((task.id.as_str(), result));
    }
    interrupt::defer();
    finish(args, &player, &examined, console)
}

/// Opens the output folder and, if requested, the mailbox.
fn open(args: &Args, settings: &RunSettings, console: &Console) -> Result<Player, Failure> {
    let mailbox = match (args.player.as_str(), args.player.strip_prefix("mailbox:")) {
        ("induce", _) if args.explore > 0 => {
            bail!("the player `induce` does not explore; remove --explore, or pass --player mailbox:DIR")
        }
        ("induce", _) => None,
        (_, Some(folder)) if !folder.is_empty() => Some(PathBuf::from(folder)),
        _ => bail!(
            "`{}` is not a player for this command; pass --player induce, or --player mailbox:DIR",
            args.player
        ),
    };
    protected::check(&args.out)?;
    let out = &args.out;
    disk::create_folder(out).map_err(|error| Failure::write(out, error))?;
    let file = out.join(SETTINGS_FILE);
    let entries = fs::read_dir(out).map_err(|error| Failure::write(out, error))?.count();
    let written = to_canonical_json(settings).expect("settings contain only finite numbers");
    match args.resume {
        false if entries > 0 => bail!(
            "{} is not empty; choose a new folder, or continue the same command with --resume",
            out.in_message()
        ),
        true if entries > 0
            && disk::read_start(&file, 1 << 20).ok().as_deref() != Some(written.as_bytes()) =>
        {
            bail!(
                "{} does not contain an examination with these settings; repeat the command that started it",
                out.in_message()
            )
        }
        _ => write(&file, &written)?,
    }
    let Some(folder) = mailbox else { return Ok(Player::Induce) };
    let digest = Digest::of(written.as_bytes());
    let mailbox = Mailbox::open_as(&folder, &settings.player, digest, args.resume, console.remarks())?;
    console.remark(format_args!(
        "questions appear in {}; `{}` lists them",
        folder.in_message(),
        shell::command([Path::new("mailbox"), &folder, Path::new("--list")])
    ));
    Ok(Player::Mailbox(Arc::new(mailbox)))
}

/// Examines the player on one game, and stores the player's version of the game.
fn one(args: &Args, player: &Player, task: &WorldModelTask) -> Result<Examined, Failure> {
    let logs = args.out.join("logs");
    disk::create_folder_no_follow(&logs).map_err(|error| Failure::write(&logs, error))?;
    let mut journal = Journal::open(&logs.join(format!("{}.jsonl", task.id)))?;
    let mut ask = |at: Address, messages: &[ChatMessage]| match player {
        Player::Induce => Ok(ChatReply::new(induce(task), Finish::Stop)),
        Player::Mailbox(mailbox) => mailbox.ask(&task.id, at, messages).map_err(Halt::from),
    };
    let examined = examine(task, &mut journal, &mut ask).map_err(|halt| match halt {
        Halt::Log(why) => Failure::malformed(why),
        halt => Failure::environment(halt, "the examination stopped; continue with --resume"),
    })?;
    if let Some(game) = &examined.game {
        let games = args.out.join("games");
        disk::create_folder_no_follow(&games).map_err(|error| Failure::write(&games, error))?;
        write(&games.join(format!("{}.vgdl", task.id)), game)?;
    }
    if let Player::Mailbox(mailbox) = player {
        let steps = u64::from(examined.attempts);
        let result = EpisodeResult { outcome: Outcome::Ended, score: 0.0, steps };
        mailbox.end(&task.id, &result, "The examination is over. Thank you.\n")?;
    }
    Ok(examined)
}

fn write(path: &Path, text: &str) -> Result<(), Failure> {
    disk::write(path, text.as_bytes(), Access::Shared).map_err(|error| Failure::write(path, error))
}

/// Describes the result for one game on one line.
fn line(id: &str, examined: &Examined) -> String {
    let Examined { attempts, problems, score, .. } = examined;
    if let Some(problems) = problems {
        let first = problems.lines().next().unwrap_or_default();
        return format!("{id}: no usable game after {attempts} of {MAX_ATTEMPTS} answers: {first}");
    }
    let (total, planner) = (score.total(), &score.planner);
    format!(
        "{id}: {} steps, {} boards and {} states reproduced; plans win {} of {} levels (true game: {})",
        total.transitions, total.board, total.state, planner.wins, planner.levels, planner.true_wins
    )
}

fn finish(args: &Args, player: &Player, examined: &[(&str, Examined)], console: &Console) -> Answer {
    let results: BTreeMap<_, _> = examined.iter().map(|(id, examined)| (*id, examined)).collect();
    let text = to_canonical_json(&results).expect("results contain only finite numbers");
    write(&args.out.join("results.json"), &text)?;
    if let Player::Mailbox(mailbox) = player {
        let usable = examined.iter().filter(|(_, examined)| examined.problems.is_none()).count();
        mailbox.finish_with(&Finished { episodes: examined.len() as u64, won: usable as u64 })?;
    }
    console.document(&serde_json::json!({ "out": paths::in_json(&args.out), "games": results }))?;
    let scores: Vec<_> = examined.iter().map(|(_, examined)| &examined.score).collect();
    console.say(format_args!("\n{}", table(&scores).to_markdown()));
    Ok(true)
}
