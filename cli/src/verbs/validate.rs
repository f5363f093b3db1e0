//! `arcade validate`: is this game or level well-formed, winnable, and not for free?

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::input::{self, Named};
use crate::render::{self, Placed};
use engine::syntax::InteractionLine;
use engine::{Analysis, Digest, Episode, Game, Level, Seed, Watch, describe};
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;
use validators::{Criteria, Judgement, Panel, Rate, Report, Verdict};

/// Judges a game and its levels: all problems of the files first, then each criterion of a release.
///
/// Exit status 0: every level meets every criterion. 1: one does not, or could not be shown to. 2: a file is malformed.
///
/// Example: arcade validate my-game/ --witness win.json
#[derive(clap::Args)]
pub(crate) struct Args {
    /// A .vgdl or .txt file, a folder with game.vgdl or game.txt, or the name of a corpus game
    #[arg(value_name = "GAME")]
    game: String,
    /// Level files, or numbers of the game's own levels; all of those if none is named
    #[arg(value_name = "LEVEL")]
    levels: Vec<String>,
    /// Forward-model calls to find a win, for each level
    #[arg(long, value_name = "CALLS", default_value_t = Criteria::default().budget)]
    budget: u64,
    /// Text that the judges' seed comes from
    #[arg(long, value_name = "TEXT", default_value = "validate")]
    seed: String,
    /// Load the game as the reference engine does: overlook faults that it overlooks
    #[arg(long)]
    as_reference: bool,
    /// Write the winning episode here (one level only)
    #[arg(long, value_name = "FILE")]
    witness: Option<PathBuf>,
}

#[derive(Serialize)]
struct Document {
    game: String,
    digest: Option<Digest>,
    passes: bool,
    problems: Vec<Placed>,
    levels: Vec<LevelDocument>,
}

#[derive(Serialize)]
struct LevelDocument {
    level: String,
    digest: Option<Digest>,
    passes: bool,
    problems: Vec<Placed>,
    /// Terminations that win and can never hold in the level, whatever is played, with the cause.
    out_of_reach: Vec<String>,
    /// Interactions that the witness never executes.
    unused_rules: Vec<String>,
    #[serde(flatten)]
    report: Option<Report>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let input = input::game(&args.game)?;
    let load = if args.as_reference { Game::from_source_as_reference } else { Game::from_source };
    let game = match load(&input.source.text) {
        Ok(game) => game,
        Err(problems) => {
            let problems_placed = render::placed(&input.source, &problems.0);
            let (digest, passes, levels) = (None, false, Vec::new());
            let game = input.source.name.clone();
            console.document(&Document { game, digest, passes, problems: problems_placed, levels })?;
            return Err(Failure::malformed(render::problems(&input.source, &problems.0)));
        }
    };
    let levels: Vec<Named> = match args.levels[..] {
        [] => input.levels()?,
        _ => args.levels.iter().map(|name| input.level(name)).collect::<Result<_, _>>()?,
    };
    if levels.is_empty() {
        let name = &input.source.name;
        let help = "name a level file after it, or put lvl0.txt beside game.vgdl";
        return Err(Failure::malformed(format!(
            "{name}: the game compiles, but there is no level to judge; {help}"
        )));
    }
    if args.witness.is_some() && levels.len() > 1 {
        let message = format!("--witness takes one level, not {}: name it after the game", levels.len());
        return Err(Failure::malformed(message));
    }
    for warning in game.warnings() {
        console.say(render::one(&input.source, warning).trim_end());
    }
    let criteria = Criteria { budget: args.budget, ..Criteria::default() };
    let panel = Panel::new(&criteria);
    let seed = Seed::from_text(&args.seed);
    let analysis = Analysis::of(&game);
    let mut documents = Vec::new();
    let mut malformed = Vec::new();
    let bar = console.progress(levels.len() as u64, "judging");
    for named in &levels {
        let level = match game.level(&named.text) {
            Ok(level) => level,
            Err(problems) => {
                malformed.push(render::problems(named, &problems.0));
                let problems = render::placed(named, &problems.0);
                let (level, digest, passes, report) = (named.name.clone(), None, false, None);
                let (out_of_reach, unused_rules) = (Vec::new(), Vec::new());
                documents.push(LevelDocument {
                    level,
                    digest,
                    passes,
                    problems,
                    out_of_reach,
                    unused_rules,
                    report,
                });
                continue;
            }
        };
        for warning in level.warnings() {
            console.say(render::one(named, warning).trim_end());
        }
        // The seed is the level's own, so that judging it alone or among others gives the same answer.
        let report = panel.judge(&game, &level, seed.child(&level.digest().to_string(), 0));
        bar.inc(1);
        console.say(table(named, &report).trim_end());
        let out_of_reach = describe::hindered_wins(&analysis, &level, &analysis.reach(&level));
        for sentence in &out_of_reach {
            console.say(format_args!("  note  out of reach: {sentence}"));
        }
        let unused_rules =
            report.witness.as_ref().map_or(Vec::new(), |witness| unused(&game, &level, witness));
        if !unused_rules.is_empty() {
            console.say(format_args!(
                "  note  rules that the winning episode never uses: {}",
                unused_rules.join("; ")
            ));
        }
        if let (Some(path), Some(witness)) = (&args.witness, &report.witness) {
            let text = serde_json::to_string(witness)
                .map_err(|error| Failure::surroundings(error, "the witness cannot be written as JSON"))?;
            std::fs::write(path, text).map_err(|error| Failure::surroundings(error, path.display()))?;
            console.say(format_args!("witness written to {}", path.display()));
        }
        documents.push(LevelDocument {
            level: named.name.clone(),
            digest: Some(level.digest()),
            passes: report.passes(),
            problems: render::placed(named, level.warnings()),
            out_of_reach,
            unused_rules,
            report: Some(report),
        });
    }
    bar.finish_and_clear();
    let passes = documents.iter().all(|level| level.passes);
    let (passed, count) = (documents.iter().filter(|level| level.passes).count(), documents.len());
    console.document(&Document {
        game: input.source.name.clone(),
        digest: Some(game.digest()),
        passes,
        problems: render::placed(&input.source, game.warnings()),
        levels: documents,
    })?;
    if !malformed.is_empty() {
        return Err(Failure::malformed(malformed.join("\n")));
    }
    console.say(format_args!("{passed} of {count} levels meet every criterion"));
    Ok(passes)
}

/// Marks the interactions that are executed.
struct Used(Vec<bool>);

impl Watch for Used {
    fn interaction(&mut self, line: usize) {
        self.0[line] = true;
    }
}

/// The interaction lines that an episode never executes, as `first second … > effect`.
fn unused(game: &Game, level: &Level, witness: &Episode) -> Vec<String> {
    let lines = &game.description().interactions;
    let mut used = Used(vec![false; lines.len()]);
    let mut state = game.start(level, witness.seed);
    for &action in &witness.actions {
        game.step_watched(&mut state, action, &mut used);
    }
    let text = |line: &InteractionLine| {
        let second: Vec<&str> = line.second.iter().map(|word| word.text.as_str()).collect();
        format!("`{} {} > {}`", line.first.text, second.join(" "), line.effect.text)
    };
    lines.iter().zip(used.0).filter(|(_, used)| !used).map(|(line, _)| text(line)).collect()
}

/// The judgements on one level, a line each.
fn table(level: &Named, report: &Report) -> String {
    let mut text = format!("{}\n", level.name);
    for Judgement { criterion, finding } in &report.judgements {
        let measured = finding.measured.as_ref().map_or(String::new(), rate);
        let (mark, words) = match &finding.verdict {
            Verdict::Pass { witness: Some(witness) } => {
                ("pass", format!("won in {} ticks, score {}", witness.actions.len(), witness.score))
            }
            Verdict::Pass { witness: None } => ("pass", String::new()),
            Verdict::Fail { reason, .. } => ("FAIL", reason.0.clone()),
            Verdict::Unknown { spent: 0 } => ("?", "nothing to judge without a win".to_owned()),
            Verdict::Unknown { spent } => ("?", format!("no win found with {spent} forward-model calls")),
        };
        let comma = if words.is_empty() || measured.is_empty() { "" } else { "; " };
        let _ = writeln!(text, "  {mark:<5}{criterion:<13}{words}{comma}{measured}");
    }
    text
}

fn rate(rate: &Rate) -> String {
    let Rate { wins, plays, interval: [low, high], .. } = rate;
    format!("{wins} of {plays} plays won (95 %: {:.0} to {:.0} %)", 100.0 * low, 100.0 * high)
}
