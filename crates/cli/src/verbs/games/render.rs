//! `arcade render`: draws a board or an episode, as text or as an image.

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::input::episodes;
use crate::{input, paths, whole_file};
use agents::{Budget, Limits, PLANNERS, PlannerSpec, play};
use base::MessagePath;
use base::Seed;
use clap::ValueEnum;
use engine::{Analysis, Episode, Game, Level, State};
use render::{Animation, Looks, RenderError, Style, Symbols};
use serde::Serialize;
use serde_json::json;
use std::path::{Path, PathBuf};

/// The maximum length of a GIF's longer side, in pixels, unless the user specifies a scale.
const GIF_SIDE: u32 = 480;

/// Draws a level, a tick of an episode, or a whole episode, as PNG, SVG, GIF or text, depending on the
/// extension of the output file.
///
/// A sprite's shape shows its role: spikes, teeth and angry eyes harm, a star wins, bricks block, and the figure in the
/// bright ring is the player. The colours come from the game.
///
/// Example: arcade render hailglass 0 --planner mcts --budget 500 -o hailglass.gif
#[derive(clap::Args)]
pub(crate) struct Args {
    /// A .vgdl or .txt file, a folder with game.vgdl or game.txt, a level beside its game, or the name of a corpus game
    #[arg(value_name = "GAME")]
    game: String,
    /// A level file, or the number of one of the game's own levels; by default the episode's level, or the first
    #[arg(value_name = "LEVEL")]
    level: Option<String>,
    /// Show this recorded episode: a file from `arcade validate --witness` or `arcade play --record`, or a
    /// snapshot's witness
    #[arg(long, value_name = "FILE", conflicts_with = "planner")]
    episode: Option<PathBuf>,
    #[arg(long, value_name = "NAME", help = format!("Let this planner play the episode: {}", PLANNERS.join(", ")))]
    planner: Option<String>,
    /// Forward-model calls per decision, unless the planner's name states them, as in `mcts:500`
    #[arg(long, value_name = "CALLS", default_value_t = 1000, value_parser = clap::value_parser!(u64).range(0..=Budget::MOST.0))]
    budget: u64,
    /// Text to derive the seeds of the game and the planner from
    #[arg(long, value_name = "TEXT", default_value = "render")]
    seed: String,
    /// Maximum number of ticks that the planner plays
    #[arg(long, value_name = "N", default_value_t = 2000)]
    max_ticks: usize,
    /// Show the state after this tick of the episode; for a GIF, end at this tick [default: the episode's last tick]
    #[arg(long, value_name = "N")]
    tick: Option<usize>,
    /// Pixels per cell
    #[arg(long, value_name = "PIXELS")]
    scale: Option<u32>,
    /// Ticks per second of a GIF
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u16).range(1..=50))]
    fps: u16,
    /// Add a legend with the game's sprite types and their names
    #[arg(long)]
    legend: bool,
    /// Leave out the caption (tick, score, the avatar's resources, outcome)
    #[arg(long)]
    bare: bool,
    /// Load the game as the reference engine does, and tolerate the faults that it tolerates
    #[arg(long)]
    as_reference: bool,
    /// The file to write, ending in .png, .svg, .gif or .txt; `-` for text on standard output
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
}

#[derive(Clone, Copy, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
enum Format {
    #[value(name = "txt")]
    Text,
    Png,
    Svg,
    Gif,
}

impl Format {
    fn of(path: &Path) -> Result<Format, Failure> {
        if path == Path::new("-") {
            return Ok(Format::Text);
        }
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        Format::from_str(&ending, true).map_err(|_| {
            malformed!(
                "{}: unknown image format; use a file name that ends in .png, .svg, .gif or .txt",
                path.in_message()
            )
        })
    }
}

struct Subject<'a> {
    looks: Looks,
    symbols: Symbols,
    game: &'a Game,
    level: &'a Level,
    /// The episode's actions up to the last tick in the image. Empty if there is no episode.
    actions: &'a [engine::Action],
    seed: Seed,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let format = Format::of(&args.out)?;
    let spec: Option<PlannerSpec> =
        args.planner.as_ref().map(|name| name.parse()).transpose().map_err(Failure::malformed)?;
    let input = input::game(&args.game)?;
    let to_screen = args.out == Path::new("-");
    if !to_screen {
        let episode = args.episode.as_deref().and_then(Path::to_str);
        let others: Vec<&str> = args.level.as_deref().into_iter().chain(episode).collect();
        episodes::check(&args.out, &input, &others)?;
    }
    let game = input.compile(args.as_reference)?;
    let (named, level, recorded) =
        episodes::recorded(&input, &game, args.level.as_deref(), args.episode.as_deref())?;
    let seed = Seed::from_text(&args.seed).child(&level.digest().to_string(), 0);
    let episode = spec.map(|spec| played(args, &spec, &game, &level, seed)).or(recorded);
    let actions = shown(args, format, episode.as_ref())?;
    let analysis = Analysis::of(&game);
    let looks = Looks::of(&analysis);
    let subject = Subject {
        symbols: Symbols::of(&analysis, &looks),
        looks,
        game: &game,
        level: &level,
        actions,
        seed: episode.as_ref().map_or(seed.child("chance", 0), |episode| episode.seed),
    };
    let last = subject.last();
    let bytes = match format {
        Format::Text => render::text(&subject.looks, &subject.symbols, &last).into_bytes(),
        Format::Png => render::png(&subject.picture(args, format, &last)?).map_err(failed)?,
        Format::Svg => render::svg(&subject.picture(args, format, &last)?).into_bytes(),
        Format::Gif => subject.gif(args, console)?,
    };
    let text = (format == Format::Text).then(|| String::from_utf8_lossy(&bytes).into_owned());
    if !to_screen {
        whole_file::write(&args.out, &bytes)?;
    }
    console.document(&json!({
        "game": input.source.name,
        "level": named.name,
        "file": paths::in_json(&args.out),
        "format": format,
        "bytes": bytes.len(),
        "ticks": subject.actions.len(),
        "score": last.score(),
        "outcome": last.outcome(),
        "text": text,
    }))?;
    match text {
        Some(text) if to_screen => console.say(text.trim_end()),
        _ => {
            let ticks = match subject.actions.len() {
                0 => String::new(),
                ticks => format!(", tick {ticks}"),
            };
            let shown = if format == Format::Gif { ", from the start" } else { "" };
            console.say(format_args!("{}: {}{ticks}{shown}", args.out.in_message(), named.name));
        }
    }
    Ok(true)
}

fn played(args: &Args, spec: &PlannerSpec, game: &Game, level: &Level, seed: Seed) -> Episode {
    let budget = spec.budget().unwrap_or(Budget(args.budget));
    // Play no further than the tick to show.
    let ticks = args.tick.map_or(args.max_ticks, |tick| tick.min(args.max_ticks));
    let limits = Limits { ticks, ..Limits::default() };
    let mut planner = spec.player(seed.child("planner", 0));
    play(game, level, &mut planner, budget, seed.child("chance", 0), limits).episode
}

/// Returns the actions up to the displayed tick.
fn shown<'a>(
    args: &Args,
    format: Format,
    episode: Option<&'a Episode>,
) -> Result<&'a [engine::Action], Failure> {
    let help = format!("add --episode FILE, or --planner NAME ({})", PLANNERS.join(", "));
    match (episode, args.tick) {
        (None, Some(0)) if format != Format::Gif => Ok(&[]),
        (None, Some(_)) => Err(malformed!("--tick requires an episode; {help}")),
        (None, None) if format == Format::Gif => {
            Err(malformed!("{}: a GIF requires an episode; {help}", args.out.in_message()))
        }
        (None, None) => Ok(&[]),
        (Some(episode), None) => Ok(&episode.actions),
        (Some(episode), Some(tick)) => episode.actions.get(..tick).ok_or_else(|| {
            let last = episode.actions.len();
            malformed!("--tick {tick}: the episode ends after tick {last}; pass that tick or an earlier one")
        }),
    }
}

impl Subject<'_> {
    fn start(&self) -> State {
        self.game.start(self.level, self.seed)
    }

    fn last(&self) -> State {
        let mut state = self.start();
        for &action in self.actions {
            self.game.step(&mut state, action);
        }
        state
    }

    fn style(&self, args: &Args, format: Format) -> Style {
        let (columns, rows) = (self.level.columns() as u32, self.level.rows() as u32);
        let usual = Style::cell_for(columns, rows);
        let usual =
            if format == Format::Gif { usual.min((GIF_SIDE / columns.max(rows)).max(12)) } else { usual };
        let caption =
            !args.bare && (format == Format::Gif || args.episode.is_some() || args.planner.is_some());
        Style { cell: args.scale.unwrap_or(usual), caption, legend: args.legend }
    }

    fn picture(&self, args: &Args, format: Format, state: &State) -> Result<render::Picture, Failure> {
        render::picture(&self.looks, state, &self.style(args, format)).map_err(failed)
    }

    fn gif(&self, args: &Args, console: &Console) -> Result<Vec<u8>, Failure> {
        let mut state = self.start();
        let draw = |state: &State| self.picture(args, Format::Gif, state);
        // The legend is drawn as well, so that the palette includes the colours of types that appear later.
        let style = Style { legend: true, ..self.style(args, Format::Gif) };
        let legend = render::picture(&self.looks, &state, &style).map_err(failed)?;
        let specimens = [draw(&state)?, draw(&self.last())?, legend];
        let mut animation = Animation::new(&specimens, 100 / args.fps).map_err(failed)?;
        let bar = console.progress(self.actions.len() as u64, "drawing");
        animation.add(&specimens[0]).map_err(failed)?;
        for &action in self.actions {
            self.game.step(&mut state, action);
            animation.add(&draw(&state)?).map_err(failed)?;
            bar.inc(1);
        }
        bar.finish_and_clear();
        animation.finish().map_err(failed)
    }
}

/// Converts a rendering error into a malformed question, because only an invalid size can cause one.
fn failed(error: RenderError) -> Failure {
    let help = "--scale sets the number of pixels per cell";
    match error {
        RenderError::Cell { .. } => malformed!("--scale: {error}"),
        RenderError::TooLarge { .. } | RenderError::TooLargeForGif { .. } => {
            malformed!("{error}: {help}")
        }
        error => Failure::environment(error, "the image cannot be written"),
    }
}
