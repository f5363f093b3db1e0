//! `arcade design`: lets a language model design games.

mod designer;
mod results;

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::flags::client::ClientArgs;
use crate::input::{self, embedded};
use crate::interrupt;
use crate::protected;
use base::MessagePath;
use design::{Brief, DesignError, DesignFolder, DesignSettings, FORMAT, Known, KnownGame, Outcome};
use designer::RequestedDesigner;
use engine::{Game, SEMANTICS};
use std::path::PathBuf;
use validators::{Criteria, Tier};

/// Lets a language model design games: the idea, the rules and the levels, with feedback after each answer.
///
/// Each stage comes with a short manual of VGDL. After each answer, the model receives the problems in its files, the
/// verdicts and the gates, in the wording of `arcade validate`, and may correct its answer three times. The command
/// writes to OUT: the accepted games in games/, each with its provenance; the log of all questions and answers; and
/// results.json. Every command accepts the games. See `arcade docs model-designs`.
///
/// Exit status 0: all drafts were written, accepted or not. 1: a cap was reached first (raise it and use --resume), or a replay
/// differs. 2: malformed input. 3: network, server or disk failed; --resume continues. 128 + signal, such as 130 for
/// Ctrl-C: interrupted; --resume continues.
///
/// Example: arcade design --model openai:gpt-4o-mini --drafts 5 --max-cost 1 --out designs
#[derive(clap::Args)]
pub(crate) struct Args {
    /// `mailbox:DIR`, for any program or person that answers the files in a folder (see `arcade docs mailbox`); or a
    /// reference designer: `grammar`, `kernels`, `inventor`
    #[arg(long, value_name = "NAME", conflicts_with = "model")]
    designer: Option<String>,
    /// The designer's name in results [default: the name of the model, or of the mailbox]
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
    /// Number of drafts
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..=10_000))]
    drafts: u64,
    /// Number of levels per game
    #[arg(long, value_name = "N", default_value_t = 3)]
    levels: usize,
    /// The theme of the games, in a few words
    #[arg(long, value_name = "TEXT")]
    theme: Option<String>,
    /// The minimum tier of each game's last level, from 1 to 4 (see `arcade docs tiers`)
    #[arg(long, value_name = "TIER", value_parser = tier)]
    tier: Option<Tier>,
    /// Sprite classes, effects, terminations and mechanics that each game must use, such as `Chaser,ignite`
    #[arg(long, value_name = "WORD", value_delimiter = ',')]
    require: Vec<String>,
    /// Games from which each game must differ, besides the corpus, the kernels and earlier drafts. May be repeated
    #[arg(long, value_name = "GAME")]
    unlike: Vec<String>,
    /// Forward-model calls per level to find a win
    #[arg(long, value_name = "CALLS", default_value_t = BUDGET, value_parser = clap::value_parser!(u64).range(1..))]
    budget: u64,
    /// Text to derive the seeds from
    #[arg(long, value_name = "TEXT", default_value = "design")]
    seed: String,
    /// Output folder for the games, logs and results (new or empty)
    #[arg(long, value_name = "DIR", required_unless_present_any = ["replay", "report"])]
    out: Option<PathBuf>,
    /// Continue an interrupted run of the same command
    #[arg(long, requires = "out")]
    resume: bool,
    /// Recompute all finished drafts in this folder from their logs, without the model, and compare them with
    /// the stored ones
    #[arg(long, value_name = "DIR", conflicts_with_all = ["out", "model", "designer"])]
    replay: Option<PathBuf>,
    /// Print the designers' scores for the drafts in these folders, with intervals and costs per accepted game
    #[arg(long, value_name = "DIR", num_args = 1.., conflicts_with_all = ["out", "model", "designer", "replay"])]
    report: Vec<PathBuf>,
    #[command(flatten)]
    client: ClientArgs,
}

/// The default for `--budget`, which is that of most recipes.
const BUDGET: u64 = 500_000;

fn tier(text: &str) -> Result<Tier, String> {
    let number: u8 = text.parse().map_err(|_| "a tier is a number from 1 to 4".to_owned())?;
    Tier::try_from(number)
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    if let Some(folder) = &args.replay {
        let folder = DesignFolder::open(folder)?;
        let known = known(&folder.settings.brief.unlike)?;
        let (drafts, differing) = design::replay(&folder, &known)?;
        return results::replayed(&drafts, &differing, console);
    }
    if !args.report.is_empty() {
        return results::report(&args.report, console);
    }
    let Some(out) = &args.out else { unreachable!("the parser requires --out") };
    let requested = RequestedDesigner::new(args)?;
    let unlike = unlike(&args.unlike)?;
    let known = known(&unlike)?;
    let settings = settings(args, &requested, unlike, &known)?;
    if args.client.has_concurrency() {
        bail!(
            "--concurrency does not apply to `arcade design`, which writes one draft after another; remove it"
        );
    }
    protected::check(out)?;
    let folder = match args.resume {
        true => DesignFolder::resume(out, &settings)?,
        false => DesignFolder::create(out, settings)?,
    };
    let connected = requested.connect(args, &folder, console)?;
    let hint = format!(
        "interrupted: all answers are in {}; run the same command with --resume to continue",
        out.in_message()
    );
    interrupt::watch(|| (), hint);
    let bar = console.progress(args.drafts, "drafts");
    let outcome = design::run(&folder, &connected.designer, &known, &mut |draft| {
        bar.inc(1);
        bar.suspend(|| console.remark(results::line(draft)));
    });
    interrupt::defer();
    bar.finish_and_clear();
    let Outcome { results, halt } = outcome?;
    connected.finish(&results, halt.is_some())?;
    results::print(out, &folder, &results, halt, &connected, console)
}

fn settings(
    args: &Args,
    requested: &RequestedDesigner,
    unlike: Vec<KnownGame>,
    known: &Known,
) -> Result<DesignSettings, Failure> {
    let (levels, theme, tier) = (args.levels, args.theme.clone(), args.tier);
    let brief = Brief { levels, theme, tier, required: args.require.clone(), unlike };
    brief.check().map_err(Failure::malformed)?;
    let criteria: Criteria = DesignSettings::criteria(args.budget);
    criteria.check().map_err(Failure::malformed)?;
    Ok(DesignSettings {
        format: FORMAT,
        semantics: SEMANTICS,
        suite: env!("CARGO_PKG_VERSION").to_owned(),
        designer: requested.name(args),
        details: requested.details(),
        price: requested.price()?,
        drafts: args.drafts,
        seed: args.seed.clone(),
        brief,
        criteria,
        known: known.digest(),
    })
}

/// Reads the games from which all drafts must differ.
fn unlike(names: &[String]) -> Result<Vec<KnownGame>, Failure> {
    let mut games = Vec::new();
    for name in names {
        for game in input::games(name)? {
            game.compile(false)?;
            games.push(KnownGame { name: game.title.clone(), rules: game.source.text });
        }
    }
    Ok(games)
}

/// Returns the corpus games, one game for each kernel (hand-written design), and the given games.
fn known(unlike: &[KnownGame]) -> Result<Known, Failure> {
    let mut known = Known::default();
    for corpus in &embedded::corpus()?.games {
        let game = Game::from_source(&corpus.source).expect("the games in the binary compile");
        known.push(&format!("the corpus game `{}`", corpus.name), &game);
    }
    known.push_kernels();
    for KnownGame { name, rules } in unlike {
        let game = Game::from_source(rules);
        let game = game.map_err(|_| {
            malformed!("`{name}` no longer compiles; use the version of arcade that began the run")
        })?;
        known.push(&format!("the game `{name}`"), &game);
    }
    Ok(known)
}

impl From<DesignError> for Failure {
    fn from(error: DesignError) -> Failure {
        match error {
            DesignError::Evaluation(error) => error.into(),
            DesignError::Io { action: "read", path, source } => Failure::read(&path, source),
            error @ DesignError::Io { .. } => Failure::Environment(error.into()),
            error => Failure::Malformed(error.into()),
        }
    }
}
