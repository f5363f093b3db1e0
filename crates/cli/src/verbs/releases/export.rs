//! `arcade export`: writes a snapshot as a dataset, as folders of games, as questions, or as one file.

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::input::trusted::{OriginArgs, SIGNATURES, refuse, signatures_of};
use crate::paths;
use crate::protected;
use crate::shell;
use crate::verbs::releases::questions::QuestionArgs;
use crate::verbs::releases::verify;
use base::MessagePath;
use base::count;
use serde_json::json;
use snapshots::archive::{Packed, pack};
use snapshots::export::{Export, ExportError, Exported, Format, export};
use snapshots::released::{Released, ReleasedError};
use snapshots::twin::Twin;
use snapshots::{Draft, SnapshotError, integrity_of};
use std::path::{Path, PathBuf};

/// Writes a snapshot for other tools: as a dataset, as folders of games, as questions, or as one file.
///
/// A dataset has one row per level, with rules, level, legend, kind, difficulty and digests. PATH gets README.md, the dataset
/// card that hubs read, and one file of rows in data/. Rows contain solutions only on request. The columns are explained in
/// `arcade docs export`. With --twin, every game has a different surface and the same mechanics (see `arcade docs twins`). The
/// same snapshot gives the same bytes.
///
/// Questions are single-turn questions about the levels, with exact answers (see `arcade docs questions`). With --check, the
/// same questions are drawn again, and the answers in a file are checked.
///
/// Exit status 0: written. 1: the snapshot does not verify, and nothing is written. 2: not a snapshot.
///
/// Example: arcade export releases/starter --format jsonl --out starter-items
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The snapshot's folder or .tar.zst
    #[arg(value_name = "SNAPSHOT", value_parser = crate::paths::release_parser())]
    snapshot: PathBuf,
    /// The format to write
    #[arg(long, value_enum, value_name = "FORMAT")]
    format: FormatName,
    /// Folder to write (new or empty); for an archive, a file that does not exist
    #[arg(long, value_name = "PATH", required_unless_present = "check")]
    out: Option<PathBuf>,
    /// Write the games' twins instead: masked, mirrored, renamed, or the withheld siblings
    #[arg(long, value_name = "TWIN")]
    twin: Option<Twin>,
    /// Add the actions that win each level
    #[arg(long)]
    solutions: bool,
    #[command(flatten)]
    questions: QuestionArgs,
    #[command(flatten)]
    origin: OriginArgs,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum FormatName {
    /// JSON Lines: one object per line
    Jsonl,
    /// Apache Parquet
    #[cfg(feature = "parquet")]
    Parquet,
    /// A folder for each game, with game.vgdl and its levels, as accepted by `arcade evaluate` and `arcade run`
    Games,
    /// Questions with exact answers, as JSON Lines, with a task for lm-evaluation-harness
    Questions,
    /// The release itself as one .tar.zst, as accepted by `arcade verify`
    Archive,
}

impl FormatName {
    /// Returns the format of exports of games and levels, or `None` for other formats.
    fn of_export(self) -> Option<Format> {
        match self {
            FormatName::Jsonl => Some(Format::JsonLines),
            #[cfg(feature = "parquet")]
            FormatName::Parquet => Some(Format::Parquet),
            FormatName::Games => Some(Format::Games),
            FormatName::Questions | FormatName::Archive => None,
        }
    }
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    if !matches!(args.format, FormatName::Questions) {
        args.questions.refuse()?;
    }
    let Some(out) = &args.out else { return questions(args, console) };
    protected::check(out)?;
    let Some(format) = args.format.of_export() else {
        return if matches!(args.format, FormatName::Questions) {
            questions(args, console)
        } else {
            archive(args, out, console)
        };
    };
    if args.solutions && matches!(args.format, FormatName::Games) {
        bail!("folders of games contain no solutions: omit --solutions, or choose --format jsonl");
    }
    // A non-empty output folder is reported before the work starts.
    let draft = Draft::create(out)?;
    let released = match Released::read(&args.snapshot) {
        Ok(released) => released,
        Err(error) => return unsound(error, console),
    };
    let found = args.origin.check(&args.snapshot, &released.manifest.name, released.manifest.root)?;
    let origin = match found {
        Ok(origin) => origin,
        Err(problems) => return refuse(&problems, console),
    };
    verify::remark_unreplayed(&released.manifest, console);
    let wanted = Export { format, solutions: args.solutions, twin: args.twin };
    let exported = export(&released, &wanted)?;
    let Exported { files, games, levels, left_out } = &exported;
    for (path, content) in files {
        draft.write(path, content)?;
    }
    draft.commit()?;
    let manifest = &released.manifest;
    let names: Vec<&str> = files.iter().map(|(path, _)| path.as_str()).collect();
    let left_out: Vec<_> =
        left_out.iter().map(|(id, why)| json!({ "game": id, "why": why.to_string() })).collect();
    console.document(&json!({
        "out": paths::in_json(out),
        "release": manifest.name,
        "root": manifest.root,
        "origin": origin,
        "twin": args.twin,
        "games": games,
        "levels": levels,
        "left_out": left_out,
        "files": names,
    }))?;
    let twin = args.twin.map(|twin| format!(", {twin}")).unwrap_or_default();
    console.say(format_args!(
        "{}{twin}: {levels} levels of {games} games in {}",
        manifest.name,
        out.in_message()
    ));
    for (id, why) in &exported.left_out {
        console.say(format_args!("left out: {id}: {why}"));
    }
    Ok(true)
}

/// Exports questions, or checks answers to them.
fn questions(args: &Args, console: &Console) -> Answer {
    if args.twin.is_some() || args.solutions {
        bail!(
            "questions are about the release itself, and contain their answers: omit --twin and --solutions"
        );
    }
    let draft = args.out.as_deref().map(Draft::create).transpose()?;
    let released = match Released::read(&args.snapshot) {
        Ok(released) => released,
        Err(error) => return unsound(error, console),
    };
    let found = args.origin.check(&args.snapshot, &released.manifest.name, released.manifest.root)?;
    if let Err(problems) = found {
        return refuse(&problems, console);
    }
    verify::remark_unreplayed(&released.manifest, console);
    args.questions.answer(&args.snapshot, &released, draft, args.out.as_deref(), console)
}

/// Exports the release itself as one archive file.
fn archive(args: &Args, out: &Path, console: &Console) -> Answer {
    if args.twin.is_some() || args.solutions {
        bail!(
            "an archive is the whole release, with its solutions: omit --twin and --solutions, or choose another --format"
        );
    }
    if !args.origin.is_empty() {
        let manifest = integrity_of(&args.snapshot)?.manifest;
        if let Err(problems) = args.origin.check(&args.snapshot, &manifest.name, manifest.root)? {
            return refuse(&problems, console);
        }
    }
    let Packed { root, digest, unpacked, size, papers } = match pack(&args.snapshot, out) {
        Ok(packed) => packed,
        Err(error @ SnapshotError::Unsound { .. }) => {
            console.document(&json!({ "problems": [error.to_string()] }))?;
            console.say(&error);
            return Ok(false);
        }
        Err(error) => return Err(error.into()),
    };
    console.document(&json!({
        "out": paths::in_json(out), "root": root, "digest": digest, "bytes": size, "unpacked": unpacked,
        "papers_left_out": papers,
    }))?;
    console.say(format_args!("{}: {size} bytes, {unpacked} unpacked, digest {digest}", out.in_message()));
    console.say(format_args!("root {root}"));
    if papers > 0 {
        let papers = count(papers, "file");
        console.say(format_args!("papers/ ({papers}) is not in the archive: publish that folder next to it"));
        let (signed, beside) = (args.snapshot.join(SIGNATURES), signatures_of(out));
        if signed.is_dir() && !beside.exists() {
            console.say(format_args!(
                "`arcade verify --key` looks for signatures next to the archive:  cp -r {} {}",
                shell::quoted(&signed),
                shell::quoted(&beside)
            ));
        }
    }
    Ok(true)
}

/// Reports a snapshot that fails verification. The report lists all problems. It is an answer, not a failure.
pub(crate) fn unsound(error: ReleasedError, console: &Console) -> Answer {
    match error {
        ReleasedError::Unsound(verification) => {
            console.document(&verification)?;
            verification.problems.iter().for_each(|problem| console.say(problem));
            console.say(format_args!("{}: does NOT verify", verification.name));
            Ok(false)
        }
        ReleasedError::Snapshot(error) => Err(error.into()),
        error => Err(Failure::Environment(error.into())),
    }
}

impl From<ExportError> for Failure {
    fn from(error: ExportError) -> Failure {
        match error {
            #[cfg(feature = "parquet")]
            error @ ExportError::Parquet(_) => Failure::Environment(error.into()),
            error => Failure::malformed(error.to_string()),
        }
    }
}
