//! `arcade study calibrate`: measures the difficulties of a release's levels with fixed reference players
//! (examinees).

use super::scale::left_out;
use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::paths;
use crate::verbs::players::evaluate::subjects::{self, Subjects, Wanted};
use crate::{interrupt, protected, whole_file};
use base::MessagePath;
use base::count;
use engine::SEMANTICS;
use evaluation::reference::{SCALE_PLAYERS, ScalePlayer, scale_player_named};
use evaluation::run::{FORMAT, PlayResult, Progress, StoppedEpisodes, SubjectEntry, Task};
use evaluation::scale::{PersonPlays, ScaleFile, Span, played};
use evaluation::{Commitment, Evaluation, EvaluationError, Halt, Settings};
use indicatif::ProgressBar;
use rayon::prelude::*;
use serde_json::json;
use statistics::scale::{Calibration, GamePlays, Month, Plays, Spreads};
use std::path::{Path, PathBuf};

/// Measures the difficulty of the levels of a release on one scale for all months (see `arcade docs scale`).
///
/// Examinees (reference players that never change) play every level, with random seeds that no mint uses. The command
/// writes to DIR: scale.json, and plays/ with one results folder per examinee. With --scale, the release is added to an
/// earlier scale, whose examinees play.
///
/// Exit status 0: calibrated. 2: malformed input. 3: the disk failed; --resume continues. 128 + signal: interrupted;
/// --resume continues.
///
/// Example: arcade study calibrate releases/2026-12 --scale scales/2026-11/scale.json --out scales/2026-12
#[derive(clap::Args)]
pub(crate) struct Args {
    /// A snapshot's folder or .tar.zst; or games, folders of games, corpus games by name
    #[arg(value_name = "SNAPSHOT|GAME", required = true)]
    subjects: Vec<String>,
    /// Folder for scale.json and the episodes (new or empty)
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// The scale to add the release to
    #[arg(long, value_name = "FILE")]
    scale: Option<PathBuf>,
    /// Results of readers (models whose versions do not change) to include, written by `arcade evaluate`
    #[arg(long, value_name = "RESULTS", num_args = 1..)]
    readers: Vec<PathBuf>,
    /// Number of episodes per examinee and level
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u64).range(1..=1000))]
    runs: u64,
    /// Maximum number of actions per episode [default: 500, or the scale's limit]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    max_steps: Option<u64>,
    /// Number of parametric bootstrap replicates, for the interval of the correlation and the bias of the spreads
    #[arg(long, value_name = "N", default_value_t = 40, value_parser = clap::value_parser!(u64).range(..=10_000))]
    replicates: u64,
    /// Text to derive the episodes' randomness from; another text gives new episodes
    #[arg(long, value_name = "TEXT", default_value = "calibrate")]
    seed: String,
    /// The name of the release on the scale [default: the name of its folder]
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
    /// Resume the calibration in the --out folder
    #[arg(long)]
    resume: bool,
}

/// The default seed text for evaluations, also used when mints play their reference players. Calibrations must use a
/// different seed text.
const OTHERS: &str = "evaluate";

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    if args.seed == OTHERS {
        bail!("--seed {OTHERS} is the seed for evaluations; a calibration needs a different one");
    }
    let earlier = args.scale.as_deref().map(ScaleFile::read).transpose()?;
    let wanted = Wanted { subjects: &args.subjects, games: &[], levels: &[], as_reference: false };
    let Subjects { snapshot, games, .. } = subjects::read(&wanted)?;
    let max_steps = args.max_steps.or(earlier.as_ref().map(|scale| scale.max_steps)).unwrap_or(500);
    if let Some(scale) = earlier.as_ref().filter(|scale| scale.max_steps != max_steps) {
        bail!("--max-steps {max_steps}: the scale was calibrated with {}; omit --max-steps", scale.max_steps);
    }
    let examinees = examinees(earlier.as_ref(), &args.scale)?;
    let plays_folder = args.out.join("plays");
    let is_begun = plays_folder.is_dir();
    if args.resume != is_begun {
        match args.resume {
            true => bail!("there is nothing to resume in {}; omit --resume to start", args.out.in_message()),
            false => bail!("{} contains a calibration; pass --resume to continue it", args.out.in_message()),
        }
    }
    protected::check(&args.out)?;
    let place = args.out.join("scale.json");
    if args.out.is_dir() {
        whole_file::check(&place, &args.scale.iter().map(PathBuf::as_path).collect::<Vec<_>>())?;
    }
    let settings = |examinee: &ScalePlayer| Settings {
        format: FORMAT,
        semantics: SEMANTICS,
        suite: env!("CARGO_PKG_VERSION").to_owned(),
        snapshot,
        entrant: examinee.entrant(),
        seed: args.seed.clone(),
        runs: args.runs,
        max_steps,
        commit: Commitment::ONE,
        max_output_tokens: None,
        track: None,
        series: 1,
        adaptive: None,
        games: Evaluation::entries(&games),
    };
    let first = settings(examinees[0]);
    first.check().map_err(|problem| malformed!("{problem}; see --runs and --max-steps"))?;
    check_readers(args, &first, earlier.as_ref())?;
    let hint = format!(
        "interrupted: finished episodes are in {}; run the same command with --resume to continue",
        args.out.in_message()
    );
    interrupt::watch(|| (), hint);
    let levels: u64 = games.iter().map(|game| game.levels.len() as u64).sum();
    let bar = Bar(console.progress(levels * args.runs * examinees.len() as u64, "playing"));
    let stopped = |error: EvaluationError| Failure::from(error).resumable("calibration");
    for &examinee in &examinees {
        let folder = plays_folder.join(examinee.name);
        let settings = settings(examinee);
        let evaluation = match Evaluation::is_begun(&folder) {
            true => Evaluation::resume(&folder, &settings).or_else(|error| {
                match folder.join(evaluation::run::SETTINGS_FILE).exists() {
                    true => Err(error),
                    false => Evaluation::create(&folder, settings, games.clone()),
                }
            }),
            false => Evaluation::create(&folder, settings, games.clone()),
        }
        .map_err(stopped)?;
        let players = examinee.players(&games, max_steps)?;
        let tally = evaluation
            .run(|task: &Task<'_>| Ok::<_, Halt>(players(&task.subject.id)), &bar)
            .map_err(stopped)?;
        for StoppedEpisodes { game, reason, episodes } in &tally.stopped {
            console.remark(format_args!(
                "warning: the engine stopped {} of {} in {game}: {reason}; these episodes are left out",
                count(*episodes as usize, "episode"),
                examinee.name
            ));
        }
        if let Some(why) = tally.halted {
            return Err(Failure::environment(
                anyhow::anyhow!("{}: {why}", examinee.name),
                "continue with --resume",
            ));
        }
    }
    bar.0.finish_and_clear();
    let folders: Vec<PathBuf> = examinees.iter().map(|one| plays_folder.join(one.name)).collect();
    let persons = played(&[folders, args.readers.clone()].concat(), max_steps)?;
    let name = args.name.clone().unwrap_or_else(|| default_name(&args.subjects));
    let found = calibrated(args, earlier, &first, &persons, &name)?;
    interrupt::defer();
    whole_file::write(&place, found.to_text().as_bytes()).map_err(|error| error.resumable("calibration"))?;
    print(&found, &place, console)?;
    Ok(true)
}

/// Returns the examinees (reference players that never change) that take part: all examinees, or those of an earlier
/// scale.
fn examinees(
    earlier: Option<&ScaleFile>,
    path: &Option<PathBuf>,
) -> Result<Vec<&'static ScalePlayer>, Failure> {
    let Some(scale) = earlier else { return Ok(SCALE_PLAYERS.iter().collect()) };
    let known: Vec<&ScalePlayer> =
        scale.examinees.iter().filter_map(|entry| scale_player_named(&entry.name)).collect();
    if known.is_empty() {
        let path = path.as_deref().unwrap_or(Path::new("scale.json")).in_message();
        bail!(
            "{path}: this version of arcade lacks the reference players (examinees) of this scale; calibrate \
             with the version that has them"
        );
    }
    Ok(known)
}

/// Returns the scale with the current release added.
fn calibrated(
    args: &Args,
    earlier: Option<ScaleFile>,
    settings: &Settings,
    persons: &[PersonPlays],
    name: &str,
) -> Result<ScaleFile, Failure> {
    let failed = || malformed!("there are too few episodes to calibrate; raise --runs");
    if let Some(mut scale) = earlier {
        if scale.months.iter().any(|month| month.name == name) {
            bail!("the scale already has a release `{name}`; give this one a different name with --name");
        }
        let names: Vec<&str> = scale.examinees.iter().map(|entry| entry.name.as_str()).collect();
        let plays = plays(settings, persons, &names);
        let month = scale.calibration().add(&plays).ok_or_else(failed)?;
        scale.add(name, settings, &month, &plays);
        return Ok(scale);
    }
    let labels: Vec<String> = persons.iter().map(|person| person.player.label()).collect();
    let labels: Vec<&str> = labels.iter().map(String::as_str).collect();
    let names: Vec<(String, String)> = persons
        .iter()
        .zip(&labels)
        .map(|(person, label)| {
            let family = scale_player_named(&person.player.name).map_or(*label, |one| one.family);
            ((*label).to_owned(), family.to_owned())
        })
        .collect();
    let families: Vec<&str> = names.iter().map(|(_, family)| family.as_str()).collect();
    let members: Vec<statistics::scale::Examinee> = persons
        .iter()
        .zip(&families)
        .map(|(person, family)| statistics::scale::Examinee {
            dimension: person.dimension,
            family: families.iter().position(|other| other == family).unwrap_or(0),
        })
        .collect();
    let plays = plays(settings, persons, &labels);
    let (rough, _) = Calibration::new(&members, &plays).ok_or_else(failed)?;
    let replicates: Vec<Spreads> =
        (0..args.replicates).into_par_iter().filter_map(|seed| rough.replicate(&plays, seed)).collect();
    let spreads = rough.corrected(&replicates);
    let (found, month): (Calibration, Month) =
        Calibration::with_spreads(&members, &plays, spreads).ok_or_else(failed)?;
    let mut scale = ScaleFile::new(&found, &names, settings.max_steps);
    scale.replicates = replicates.len() as u64;
    scale.correlation = rough.correlation(&replicates).map(Span::from);
    scale.add(name, settings, &month, &plays);
    Ok(scale)
}

/// Rejects the results of readers (players that see only prompts) that could not be included, before anything is
/// played.
fn check_readers(args: &Args, settings: &Settings, earlier: Option<&ScaleFile>) -> Result<(), Failure> {
    if args.readers.is_empty() {
        return Ok(());
    }
    for person in played(&args.readers, settings.max_steps)? {
        let name = person.player.label();
        if let Some(line) = left_out(&name, &person.left_out, settings.max_steps).first() {
            bail!("{line}, or omit it from --readers");
        }
        let has_played = |game: &SubjectEntry| {
            game.levels.iter().any(|level| person.levels.contains_key(&(game.digest, level.digest)))
        };
        if !settings.games.iter().any(has_played) {
            bail!(
                "{name} has not played any level of this release; evaluate this reader on the release, or omit \
                 it from --readers"
            );
        }
        if earlier.is_some_and(|scale| scale.examinees.iter().all(|entry| entry.name != name)) {
            bail!(
                "{name} did not play the first release of the scale, so it is not an anchor (a reader that \
                 plays every release); place it with `arcade study scale`, and omit it from --readers"
            );
        }
    }
    Ok(())
}

/// Returns the episodes played by the persons (players) with the given names on a release's levels.
fn plays(settings: &Settings, persons: &[PersonPlays], names: &[&str]) -> Vec<GamePlays> {
    let of_game = |game: &SubjectEntry| {
        let mut found = GamePlays { levels: game.levels.len(), plays: Vec::new() };
        for (examinee, name) in names.iter().enumerate() {
            let Some(person) = persons.iter().find(|person| person.player.label() == *name) else { continue };
            for (level, entry) in game.levels.iter().enumerate() {
                let counts = person.levels.get(&(game.digest, entry.digest));
                found.plays.extend(counts.map(|&(won, of)| Plays {
                    examinee,
                    level,
                    won: won as f64,
                    of: of as f64,
                }));
            }
        }
        found
    };
    settings.games.iter().map(of_game).collect()
}

/// Returns the default name: the name of the first subject's folder.
fn default_name(subjects: &[String]) -> String {
    let path = Path::new(&subjects[0]);
    // The published part of a sealed release lies in a folder named after the release.
    let path = if path.ends_with("public") { path.parent().unwrap_or(path) } else { path };
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
    name.unwrap_or_else(|| subjects[0].clone()).trim_end_matches(".tar.zst").to_owned()
}

fn print(scale: &ScaleFile, path: &Path, console: &Console) -> Result<(), Failure> {
    let month = scale.months.last().expect("a month was just added");
    console.document(&json!({
        "scale": paths::in_json(path),
        "month": { "name": month.name, "shifts": month.shifts, "planners_shift": month.planners_shift, "link": month.link, "drift": month.drift },
        "examinees": scale.examinees,
        "correlation": scale.correlation,
    }))?;
    let levels = month.games.iter().map(|game| game.levels.len()).sum::<usize>();
    console.say(format_args!(
        "{}: {} of {} on the scale",
        month.name,
        count(levels, "level"),
        count(month.games.len(), "game")
    ));
    if scale.months.len() > 1 {
        let shift = month.planners_shift;
        console.say(format_args!(
            "mean difficulty {:+.2} logits (± {:.2}) for these planners, {:+.2} (± {:.2}) for any planner",
            shift.value,
            1.96 * shift.error,
            month.shifts[0].value,
            1.96 * month.shifts[0].error
        ));
    }
    if let Some(drift) = month.drift {
        let flagged = drift.value.abs() > 1.96 * drift.error;
        let flag = if flagged { ": flagged" } else { "" };
        console.say(format_args!(
            "drift according to anchors {:+.2} logits (± {:.2}){flag}",
            drift.value,
            1.96 * drift.error
        ));
    }
    if let Some(Span { value, low, high }) = scale.correlation {
        console.say(format_args!(
            "correlation between the difficulty for planners and for readers {value:.2} ({low:.2} to \
             {high:.2})"
        ));
    }
    console.say(format_args!("scale in {}", path.in_message()));
    Ok(())
}

/// A progress bar that counts episodes.
struct Bar(ProgressBar);

impl Progress for Bar {
    fn episode(&self, task: &Task<'_>, result: &PlayResult) {
        if let PlayResult::Halted(halt) = result {
            self.0.println(format!("{}: {halt}", task.file_name()));
        }
        self.0.inc(1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use statistics::scale::Dimension;

    #[test]
    fn releases_are_named_after_their_folders() {
        for (subject, name) in [
            ("releases/2026-12", "2026-12"),
            ("r/2027-01/public", "2027-01"),
            ("a/month.tar.zst", "month"),
            ("corpus", "corpus"),
        ] {
            assert_eq!(default_name(&[subject.to_owned()]), name);
        }
    }

    #[test]
    fn examinees_of_a_new_scale_are_all() {
        let found = examinees(None, &None).expect("all are known");
        assert_eq!(found.len(), SCALE_PLAYERS.len());
        assert!(found.iter().any(|one| one.dimension == Dimension::Reader));
    }
}
