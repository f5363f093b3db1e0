//! `arcade studio`: serves games on a web page on this machine.

mod browser;
mod judge;
pub(crate) mod open;

use crate::book::manual;
use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::input::trusted::{self, TrustArgs};
use crate::version;
use serde_json::json;
use std::path::PathBuf;
use studio::judging::MOST_PAIRS;
use studio::{Kind, Server, Stop, Studio, Workspace};

/// Opens a page on this machine to write, check, play and browse games, until Ctrl-C.
///
/// Without an argument, it shows the games that are built into this program. In a folder of games, every game can be
/// edited; a game of the corpus or of a release is copied first. The first line of output is the address of the page.
/// Only this machine can reach it, and only with the token in the address; see `arcade docs studio`. With --judge, it
/// shows pairs of games instead, without revealing where they come from, and records people's judgements.
///
/// Example: arcade studio my-game/
#[derive(clap::Args)]
pub(crate) struct Args {
    /// A game or a folder of games, a release (folder or archive), or the results of an evaluation
    #[arg(value_name = "PLACE")]
    place: Option<String>,
    /// The port; 0 selects any free port
    #[arg(long, value_name = "N", default_value_t = 0)]
    port: u16,
    /// Print the address without opening a browser
    #[arg(long)]
    no_open: bool,
    /// The folder for copies of games [default: the opened folder of games, or the current one]. With --judge, the file that
    /// judgements are added to
    #[arg(long, value_name = "PATH")]
    out: Option<PathBuf>,
    /// A release to compare with the opened release
    #[arg(long, value_name = "SNAPSHOT", value_parser = crate::paths::release_parser())]
    against: Option<PathBuf>,
    /// Snapshots, or folders of snapshots, to search for earlier releases when verifying the opened release, in
    /// addition to the parent folders of the opened release and of --against
    #[arg(long, value_name = "DIR", num_args = 1.., requires = "place")]
    chain: Vec<PathBuf>,
    #[command(flatten)]
    trust: TrustArgs,
    /// Games to judge blindly, in pairs: a folder of games, a release, or `corpus`. Give this flag at least twice
    #[arg(long, value_name = "GAMES", conflicts_with = "place")]
    judge: Vec<String>,
    /// Text to derive the pairs, and the side of each game, from
    #[arg(long, value_name = "TEXT", default_value = "judge", requires = "judge")]
    seed: String,
    /// The number of pairs
    #[arg(long, value_name = "N", default_value_t = 20, requires = "judge", value_parser = clap::value_parser!(u64).range(1..=MOST_PAIRS as u64))]
    pairs: u64,
    /// Print the results in a file of judgements without opening a page
    #[arg(long, value_name = "FILE", conflicts_with_all = ["place", "judge", "out", "against"])]
    judge_report: Option<PathBuf>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    if let Some(file) = &args.judge_report {
        return judge::report(file, console);
    }
    let page = |name: &str| manual::page(name).ok().map(|page| page.text.to_owned());
    if !args.judge.is_empty() {
        let pairs = usize::try_from(args.pairs).unwrap_or(MOST_PAIRS);
        let judging = judge::session(&args.judge, &args.seed, pairs, args.out.as_deref(), console)?;
        // The page shows only the pairs, because a list of games would reveal where they come from.
        let workspace = Workspace::new(Kind::Games, "pairs to judge", PathBuf::new(), Vec::new());
        return serve(Studio::new(workspace, version::version(), page).judging(judging), args, console);
    }
    let mut workspace = open::workspace(args.place.as_deref(), args.out.as_deref(), args.against.as_deref())?;
    let root = workspace.root.clone();
    if root.is_none() && !(args.chain.is_empty() && args.trust.is_empty()) {
        bail!("--chain and --key require a release: pass one to open");
    }
    args.trust.check()?;
    workspace.chain.clone_from(&args.chain);
    let studio = Studio::new(workspace, version::version(), page);
    serve(with_signatures(studio, root, &args.trust), args, console)
}

/// Adds the signature check for the opened release, if a key was given.
fn with_signatures(studio: Studio, root: Option<PathBuf>, trust: &TrustArgs) -> Studio {
    let Some(root) = root.filter(|_| !trust.is_empty()) else { return studio };
    let trust = trust.clone();
    studio.vouched(move |verification| match trust.judge_release(&root, verification) {
        Ok(Some(signed)) if signed.problems.is_empty() => Ok(trusted::sentence(&signed)),
        Ok(signed) => Err(signed.map_or_else(Vec::new, |signed| signed.problems)),
        Err(failure) => Err(vec![failure.to_string()]),
    })
}

fn serve(studio: Studio, args: &Args, console: &Console) -> Answer {
    let server = Server::bind(studio, args.port)
        .map_err(|error| Failure::environment(error, "the studio cannot be started"))?;
    let url = server.url();
    if console.is_json() {
        console.line(&json!({ "url": url, "port": server.port() }));
    } else {
        console.say(&url);
    }
    console.remark("the studio serves only this machine; press Ctrl-C to stop");
    // Dropping this file at the end removes it.
    let opened = if args.no_open { None } else { browser::open(&url) };
    let (stop, run) = server.stoppable();
    end_on_signal(stop);
    let served = run().map_err(|error| Failure::environment(error, "the studio has stopped"));
    drop(opened);
    served.map(|()| true)
}

/// Stops the server and the program at the first SIGINT, SIGTERM or SIGHUP.
#[cfg(unix)]
fn end_on_signal(stop: Stop) {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    // If no handler can be installed, a signal ends the program as usual.
    let Ok(mut signals) = signal_hook::iterator::Signals::new([SIGINT, SIGTERM, SIGHUP]) else {
        std::mem::forget(stop);
        return;
    };
    std::thread::spawn(move || {
        signals.forever().next();
        drop(stop);
    });
}

/// Does nothing on non-Unix systems, where the system ends the program.
#[cfg(not(unix))]
fn end_on_signal(stop: Stop) {
    std::mem::forget(stop);
}
