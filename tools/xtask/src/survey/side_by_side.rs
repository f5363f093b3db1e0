//! `cargo xtask side-by-side` compares two groups of games by the same criteria, line by line.

use super::folders;
use crate::levels::{load, name_of};
use anyhow::Context;
use base::{Digest, Seed};
use engine::{Episode, Game, Level, Outcome};
use forge::survey::{Comparison, GameRow, GameSurvey, GateRow, GateSurvey};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use validators::Criteria;

/// Judges the games in two folders by the same criteria with the same budget, and prints a table in Markdown.
///
/// On each of seven lines, the table shows the mean or fraction for each group, and the difference with its
/// 95% interval. With --rows, games that have already been judged are not judged again, so that an
/// interrupted run can continue.
///
/// Example: cargo xtask side-by-side --ours corpora --theirs gvgai/games --games 50 --rows side-by-side.jsonl
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Folder of game folders, each with game.vgdl or game.txt and lvl*.txt
    #[arg(long, value_name = "DIR")]
    ours: PathBuf,
    /// Folder of the second group, whose games are loaded as the reference loads them
    #[arg(long, value_name = "DIR")]
    theirs: Option<PathBuf>,
    /// Maximum number of games per folder, drawn with the seed
    #[arg(long, value_name = "N", default_value_t = 50)]
    games: usize,
    /// Maximum number of levels per game: the first level, the last level, and evenly spaced levels in
    /// between
    #[arg(long, value_name = "N", default_value_t = 3)]
    levels: usize,
    /// Text from which the samples and all random draws are derived
    #[arg(long, value_name = "TEXT", default_value = "side by side")]
    seed: String,
    /// File of rows, with one line of JSON per game. Games with a row are not judged again, and new rows are
    /// added
    #[arg(long, value_name = "FILE")]
    rows: Option<PathBuf>,
    /// Forward-model calls to win a level
    #[arg(long, value_name = "CALLS", default_value_t = GameSurvey::criteria().budget)]
    budget: u64,
    /// Maximum number of episodes on a level for each reference player
    #[arg(long, value_name = "N", default_value_t = GameSurvey::criteria().ladder_plays)]
    plays: u64,
    /// Forward-model calls of all players on a level, after which no further round of episodes begins
    #[arg(long, value_name = "CALLS", default_value_t = GameSurvey::criteria().ladder_calls)]
    ladder_calls: u64,
    /// Print only the names of the games that the seed draws
    #[arg(long)]
    sample: bool,
    /// Apply the gates of docs/reference/gates.md to the games with all their levels instead, and print how
    /// many games pass each gate. A level with a win in the folder `witness` of its game is judged by that
    /// win. --rows has one line per game, and --budget is 300000 by default
    #[arg(long)]
    gates: bool,
    /// Number of threads, or 0 for all cores. Does not affect the results
    #[arg(long, value_name = "N", default_value_t = 0)]
    jobs: usize,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let seed = Seed::from_text(&args.seed);
    let criteria = Criteria {
        budget: args.budget,
        ladder_plays: args.plays,
        ladder_calls: args.ladder_calls,
        ..GameSurvey::criteria()
    };
    let mut groups = vec![("ours", draw(&args.ours, args.games, seed)?)];
    if let Some(theirs) = &args.theirs {
        groups.push(("theirs", draw(theirs, args.games, seed)?));
    }
    for (group, folders) in &groups {
        let names: Vec<String> = folders.iter().map(|folder| name_of(folder)).collect();
        println!("{group}, {} games: {}", names.len(), names.join(", "));
    }
    if args.sample {
        return Ok(());
    }
    if args.gates {
        return gates(args, &groups, seed);
    }
    let mut judge = Judge {
        survey: GameSurvey::new(&criteria, seed)?,
        levels: args.levels,
        known: args.rows.as_deref().map_or(Ok(BTreeMap::new()), read)?,
        file: args.rows.as_deref(),
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.jobs).build()?;
    let mut rows: Vec<Vec<GameRow>> = Vec::new();
    for (group, folders) in &groups {
        println!("\n{group}");
        rows.push(pool.install(|| judge.group(folders))?);
    }
    if let [ours, theirs] = &rows[..] {
        let comparison = Comparison::of(ours, theirs, seed.child("comparison", 0));
        println!("\n{}", comparison.table().to_markdown());
    }
    Ok(())
}

/// Applies the gates to both groups of games.
fn gates(args: &Args, groups: &[(&str, Vec<PathBuf>)], seed: Seed) -> anyhow::Result<()> {
    let usual = GateSurvey::criteria();
    let given = args.budget != GameSurvey::criteria().budget;
    let budget = if given { args.budget } else { usual.budget };
    let survey = GateSurvey::new(&Criteria { budget, ..usual }, seed)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.jobs).build()?;
    let mut rows: Vec<(&str, Vec<GateRow>)> = Vec::new();
    for (group, folders) in groups {
        println!("\n{group}");
        let mut of_group = Vec::new();
        for folder in folders {
            let (game, levels) = load(folder)?;
            let levels: Vec<_> =
                (0..).zip(levels).map(|(number, level)| won(folder, number, &game, level)).collect();
            let row = pool.install(|| survey.row(&name_of(folder), &game, &levels));
            println!("{}", row.line());
            if let Some(path) = &args.rows {
                append(path, &row)?;
            }
            of_group.push(row);
        }
        rows.push((group, of_group));
    }
    let rows: Vec<(&str, &[GateRow])> = rows.iter().map(|(group, rows)| (*group, &rows[..])).collect();
    println!("\n{}", GateRow::table(&rows).to_markdown());
    Ok(())
}

/// Returns a level and its winning episode, if the folder contains such an episode.
fn won(folder: &Path, number: usize, game: &Game, level: Level) -> (Level, Option<Episode>) {
    /// The fields of a witness file that are needed.
    #[derive(Deserialize)]
    struct Witness {
        episode: Episode,
    }
    let read = || {
        let text = fs::read_to_string(folder.join(format!("witness/lvl{number}.json"))).ok()?;
        let Witness { episode } = serde_json::from_str(&text).ok()?;
        (episode.outcome == Outcome::Won && episode.replay(game, &level).is_ok()).then_some(episode)
    };
    let win = read();
    (level, win)
}

/// Returns a random sample of a folder's game folders, up to `most` of them, sorted by name. The sample
/// depends on the seed and on the names in the folder.
fn draw(folder: &Path, most: usize, seed: Seed) -> anyhow::Result<Vec<PathBuf>> {
    let mut folders = folders(folder)?;
    seed.child("sample", 0).sampler().shuffle(&mut folders);
    folders.truncate(most);
    folders.sort();
    Ok(folders)
}

/// Returns up to `most` levels: the first level, the last level, and evenly spaced levels in between.
fn spread(levels: Vec<Level>, most: usize) -> Vec<Level> {
    let (count, steps) = (levels.len(), most.saturating_sub(1).max(1));
    if count <= most {
        return levels;
    }
    let chosen: Vec<usize> = (0..most).map(|at| at * (count - 1) / steps).collect();
    levels.into_iter().enumerate().filter(|(at, _)| chosen.contains(at)).map(|(_, level)| level).collect()
}

struct Judge<'a> {
    survey: GameSurvey,
    levels: usize,
    /// The rows of previously judged games, by digest.
    known: BTreeMap<Digest, GameRow>,
    file: Option<&'a Path>,
}

impl Judge<'_> {
    /// Returns the rows for a group of games. Each new row is printed and written to the file as soon as it
    /// is available.
    fn group(&mut self, folders: &[PathBuf]) -> anyhow::Result<Vec<GameRow>> {
        let mut rows = Vec::new();
        for folder in folders {
            let (game, levels) = load(folder)?;
            let (name, levels) = (name_of(folder), spread(levels, self.levels));
            let row = match self.known.get(&self.survey.digest(&game, &levels)) {
                Some(row) => row.clone(),
                None => {
                    let row = self.survey.row(&name, &game, &levels);
                    println!("{row}");
                    if let Some(path) = self.file {
                        append(path, &row)?;
                    }
                    row
                }
            };
            rows.push(GameRow { name, ..row });
        }
        Ok(rows)
    }
}

/// Reads the rows in a file, by digest. Returns no rows if the file does not exist.
fn read(path: &Path) -> anyhow::Result<BTreeMap<Digest, GameRow>> {
    if !path.exists() {
        return Ok(BTreeMap::new());
    }
    let text = fs::read_to_string(path).with_context(|| path.display().to_string())?;
    let row = |line: &str| -> anyhow::Result<(Digest, GameRow)> {
        let row: GameRow = serde_json::from_str(line).with_context(|| path.display().to_string())?;
        Ok((row.digest, row))
    };
    text.lines().map(row).collect()
}

fn append(path: &Path, row: &impl serde::Serialize) -> anyhow::Result<()> {
    let file = OpenOptions::new().create(true).append(true).open(path);
    let mut file = file.with_context(|| path.display().to_string())?;
    let line = serde_json::to_string(row)? + "\n";
    file.write_all(line.as_bytes()).with_context(|| path.display().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_spread_over_all() {
        let game = Game::from_source(
            "BasicGame\n  SpriteSet\n    avatar > MovingAvatar\n  LevelMapping\n  InteractionSet\n    \
             avatar EOS > stepBack\n  TerminationSet\n    Timeout limit=9 win=False\n",
        );
        let game = game.unwrap();
        let levels: Vec<Level> =
            (0..5).map(|width| game.level(&format!("A{}\n", " ".repeat(width))).unwrap()).collect();
        let check = |most: usize, expect: &[usize]| {
            let widths: Vec<usize> =
                spread(levels.clone(), most).iter().map(|level| level.columns() - 1).collect();
            assert_eq!(widths, expect);
        };
        check(3, &[0, 2, 4]);
        check(2, &[0, 4]);
        check(1, &[0]);
        check(9, &[0, 1, 2, 3, 4]);
    }
}
