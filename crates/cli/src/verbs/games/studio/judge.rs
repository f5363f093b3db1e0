//! `arcade studio --judge`: shows people pairs of games to judge without seeing where the games come from.

use super::open;
use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::input;
use crate::input::embedded;
use crate::input::game_input::GameInput;
use crate::whole_file;
use engine::{Game, Level};
use snapshots::released::Released;
use std::path::Path;
use studio::judging::{Candidate, Judgements, Judging, JudgingError, MeasureRow, Report, Source, SourceRow};

/// Opens the game folders and the record file.
pub(super) fn session(
    folders: &[String],
    seed: &str,
    pairs: usize,
    out: Option<&Path>,
    console: &Console,
) -> Result<Judging, Failure> {
    let Some(out) = out else { bail!("specify the file for the judgements: --out judged.jsonl") };
    whole_file::check(out, &[])?;
    let sources =
        folders.iter().map(|name| source(name, console)).collect::<Result<Vec<Source>, Failure>>()?;
    let (judging, remarks) = Judging::open(sources, seed, pairs, out)?;
    remarks.iter().for_each(|remark| console.remark(remark));
    Ok(judging)
}

/// Prints the results in a record file.
pub(super) fn report(file: &Path, console: &Console) -> Answer {
    let (judgements, remarks) = Judgements::read(file)?;
    remarks.iter().for_each(|remark| console.remark(remark));
    let report = Report::of(&judgements);
    console.document(&report)?;
    console.say(text(&report).trim_end());
    Ok(true)
}

impl From<JudgingError> for Failure {
    fn from(error: JudgingError) -> Failure {
        match error {
            error @ JudgingError::Io { .. } => {
                let what = error.to_string();
                Failure::environment(error, what)
            }
            error => Failure::malformed(error),
        }
    }
}

fn source(name: &str, console: &Console) -> Result<Source, Failure> {
    let path = Path::new(name);
    let games = if open::is_release(path)? {
        let released = Released::read(path).map_err(|error| open::unsound(path, &error))?;
        let candidate = |game: snapshots::released::ReleasedGame| Candidate {
            id: game.card.id,
            title: game.card.title,
            game: game.game,
            levels: game.levels.into_iter().map(|level| level.level).collect(),
        };
        released.games.into_iter().map(candidate).collect()
    } else {
        let mut games = Vec::new();
        for input in input::games(name)? {
            match candidate(&input) {
                Ok(Some(candidate)) => games.push(candidate),
                Ok(None) => console.remark(format_args!("{}: left out, since it has no level", input.title)),
                Err(failure) => console.remark(format_args!("{}: left out: {failure}", input.title)),
            }
        }
        games
    };
    Ok(Source { name: name.to_owned(), games })
}

/// Returns the game as a candidate, or `None` if the game has no levels.
fn candidate(input: &GameInput) -> Result<Option<Candidate>, Failure> {
    let game: Game = input.compile(false)?;
    let levels: Vec<Level> = input.checked_levels(&game)?;
    let title = title(input)?;
    Ok((!levels.is_empty()).then(|| Candidate { id: input.title.clone(), title, game, levels }))
}

/// Returns the title from the game's card, or else the name of the game's folder.
fn title(input: &GameInput) -> Result<String, Failure> {
    if input.path.is_none() {
        let corpus = embedded::corpus()?;
        let found = corpus.find(&input.title);
        return Ok(found.map_or_else(|| input.title.clone(), |game| game.card.title.clone()));
    }
    let of_card = open::card(input).and_then(|card| Some(card.get("title")?.as_str()?.to_owned()));
    let named = || {
        let name = Path::new(&input.title).file_name();
        name.map_or_else(|| input.title.clone(), |name| name.to_string_lossy().into_owned())
    };
    Ok(of_card.unwrap_or_else(named))
}

fn text(report: &Report) -> String {
    let mut text = format!("{} pairs judged\n", report.judged);
    let percent = |rate: Option<f64>, low: f64, high: f64| match rate {
        Some(rate) => format!("{:.0}% ({:.0} to {:.0})", 100.0 * rate, 100.0 * low, 100.0 * high),
        None => "no answer yet".to_owned(),
    };
    for row in &report.sources {
        let SourceRow { name, wins, losses, ties, rate, low, high, again, machine } = row;
        let preferred = percent(*rate, *low, *high);
        let again = percent(again.rate, again.low, again.high);
        text += &format!(
            "{name}: better in {wins}, worse in {losses}, equal in {ties}; preferred {preferred}; would play \
             again {again}"
        );
        if machine.of > 0 {
            text +=
                &format!("; judged to be machine-made {}", percent(machine.rate, machine.low, machine.high));
        }
        text.push('\n');
    }
    if !report.measures.is_empty() {
        text += "\npairs in which the better game has the larger value:\n";
    }
    for MeasureRow { name, agrees, pairs, rate, low, high } in &report.measures {
        text += &format!("{name}: {agrees} of {pairs}, {}\n", percent(*rate, *low, *high));
    }
    text
}
