//! `arcade gallery`: writes a release as a static web page.

use super::export::unsound;
use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::paths;
use crate::verbs::games::studio::open;
use crate::{protected, version};
use base::MessagePath;
use rayon::prelude::*;
use serde_json::json;
use snapshots::released::Released;
use std::path::PathBuf;
use studio::{Gallery, Studio};

/// Writes a release as a page that needs no server: its games, cards and boards, and a replay of every recorded win.
///
/// The release is verified first. The folder can be opened from the disk, or served by any web server. It contains
/// all solutions that the release contains. The folder is either complete or absent.
///
/// Exit status 0: written. 1: the release does not verify. 2: there is no such release. 3: environment failure.
///
/// Example: arcade gallery releases/starter --out starter-gallery
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The release: a folder or an archive
    #[arg(value_name = "SNAPSHOT", value_parser = crate::paths::release_parser())]
    snapshot: PathBuf,
    /// Folder for the page (new or empty)
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    // A non-empty output folder is reported before the work starts.
    let draft = protected::draft(&args.out)?;
    let released = match Released::read(&args.snapshot) {
        Ok(released) => released,
        Err(error) => return unsound(error, console),
    };
    let workspace = open::of_release(&args.snapshot, released, PathBuf::new());
    let studio = Studio::new(workspace, version::version(), |_| None);
    let gallery = Gallery::of(&studio);
    let games = gallery.games();
    let bar = console.progress(games.len() as u64, "games");
    games.par_iter().try_for_each(|id| {
        let (path, content) = gallery.game(id).map_err(Failure::malformed)?;
        draft.write(&path, &content)?;
        bar.inc(1);
        Ok::<(), Failure>(())
    })?;
    bar.finish_and_clear();
    for (path, content) in gallery.page().map_err(Failure::malformed)? {
        draft.write(&path, &content)?;
    }
    draft.commit()?;
    let page = args.out.join("index.html");
    console.document(&json!({ "page": paths::in_json(&page), "games": games }))?;
    console.say(format_args!("{} games in {}", games.len(), page.in_message()));
    Ok(true)
}
