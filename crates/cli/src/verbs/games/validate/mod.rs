//! `arcade validate`: judges whether a game or level is well-formed, winnable, fair and worth playing.

mod document;

use crate::console::Console;
use crate::diagnostics::Named;
use crate::failure::{Answer, Failure};
use crate::input;
use crate::input::episodes;
use crate::input::game_input::GameInput;
use crate::{diagnostics, shell};
use base::MessagePath;
use base::Seed;
use document::{Document, LevelDocument};
use engine::{Analysis, Diagnostic, Diagnostics, Game, Level, LevelMapping, describe};
use forge::review::locate;
use rayon::prelude::*;
use std::path::PathBuf;
use validators::{Criteria, CriterionSet, Effort, Judging, Panel, Report};

/// Judges a game and its levels: all problems in all files first, then each criterion for a release.
///
/// The verdict comes first: one line per level and one for the game. The warnings about the files follow, and then the
/// criteria, each with its observations and advice. If no level is left out, the criterion that every rule is used is
/// checked across all levels of the game. With -q, everything that passes is left out. See `arcade docs validate` for
/// the criteria.
///
/// Exit status 0: every level and the game meet every criterion. 1: a level or the game fails a criterion, or could not
/// be shown to meet it. 2: a file is malformed.
///
/// Example: arcade validate my-game/ --witness win.json
#[derive(clap::Args)]
pub(crate) struct Args {
    /// A .vgdl or .txt file, a folder with game.vgdl or game.txt, a level beside its game, or the name of a corpus game
    #[arg(value_name = "GAME")]
    game: String,
    /// Level files, or numbers of the game's own levels [default: all of the game's own levels]
    #[arg(value_name = "LEVEL")]
    levels: Vec<String>,
    /// Forward-model calls per level to find a win; all other criteria together take up to about eight times
    /// this number
    #[arg(long, value_name = "CALLS", default_value_t = Criteria::default().budget, value_parser = clap::value_parser!(u64).range(1..), allow_negative_numbers = true)]
    budget: u64,
    /// Also check the game and all its levels against the gates for generated games (`arcade docs gates`)
    #[arg(long)]
    gates: bool,
    /// Text to derive the validators' seed from
    #[arg(long, value_name = "TEXT", default_value = "validate")]
    seed: String,
    /// Load the game as the reference engine does, and tolerate the faults that it tolerates
    #[arg(long)]
    as_reference: bool,
    /// Write the winning episode to this file (for one level only)
    #[arg(long, value_name = "FILE")]
    witness: Option<PathBuf>,
}

/// A level and its findings: either problems in its text, or judgements.
struct JudgedLevel<'a> {
    named: &'a Named,
    level: Result<Level, Diagnostics>,
    report: Option<Report>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let input = input::game(&args.game)?;
    let load = if args.as_reference { Game::from_source_as_reference } else { Game::from_source };
    let game = match load(&input.source.text) {
        Ok(game) => game,
        Err(problems) => return Err(malformed(args, console, &input, &problems.0)),
    };
    let levels = levels(args, &input)?;
    if levels.is_empty() {
        let name = &input.source.name;
        let stem = std::path::Path::new(name).file_stem().unwrap_or_default().to_string_lossy();
        let own = match stem.eq_ignore_ascii_case("game") {
            true => "lvl0.txt".to_owned(),
            false => format!("{stem}_lvl0.txt"),
        };
        let help = format!("pass a level file after it, or put {own} next to it");
        bail!("{name}: the game compiles, but there is no level to judge; {help}");
    }
    if args.witness.is_some() && levels.len() > 1 {
        bail!("--witness takes one level, not {}: pass that level after the game", levels.len());
    }
    if let Some(path) = &args.witness {
        episodes::check(path, &input, &args.levels.iter().map(String::as_str).collect::<Vec<_>>())?;
    }
    let mut criteria = Criteria { budget: args.budget, ..Criteria::full() };
    if args.gates {
        if levels.len() < input.count() {
            let (all, some) = (input.count(), levels.len());
            let command = shell::command(["validate", &args.game, "--gates"]);
            bail!(
                "--gates judges a game with all its levels, but only {some} of {all} were given: `{command}`"
            );
        }
        criteria.ask = criteria.ask.with(CriterionSet::GATES);
    }
    let panel = Panel::new(criteria.check().map_err(Failure::malformed)?, Effort::Calls(args.budget));
    let seed = Seed::from_text(&args.seed);
    let bar = console.progress(levels.len() as u64, "judging");
    // The seed depends on the level, so that a level is judged the same, alone or with other levels.
    let judge = |level: &Level| {
        let seed = seed.child(&level.digest().to_string(), 0);
        panel.judge(Judging::level(&game, level, seed))
    };
    let judged = levels.par_iter().map(|named| {
        let level = game.level(&named.text);
        let report = level.as_ref().ok().map(judge);
        bar.inc(1);
        JudgedLevel { named, level, report }
    });
    let mut judged: Vec<JudgedLevel<'_>> = judged.collect();
    let sound: Vec<Level> = judged.iter().filter_map(|judged| judged.level.clone().ok()).collect();
    let reports: Vec<Report> = judged.iter().filter_map(|judged| judged.report.clone()).collect();
    // Criteria that judge the game across its levels require all levels.
    let all = sound.len() == judged.len() && judged.len() >= input.count();
    let together = || panel.judge(Judging::together(&game, &sound, &reports, seed));
    let mut of_game = if all { together() } else { Vec::new() };
    bar.finish_and_clear();
    let findings = judged.iter_mut().filter_map(|judged| judged.report.as_mut());
    let findings = findings.flat_map(|report| &mut report.judgements).chain(&mut of_game);
    findings.for_each(|judgement| locate(&mut judgement.finding, &input.source.text));

    let analysis = Analysis::of(&game);
    let documents: Vec<LevelDocument<'_>> =
        judged.iter().map(|judged| document_of(&analysis, judged)).collect();
    let malformed: Vec<String> = judged
        .iter()
        .filter_map(|judged| Some(diagnostics::in_words(judged.named, &judged.level.as_ref().err()?.0)))
        .collect();
    let passes_together = of_game.iter().all(|judgement| judgement.finding.verdict.is_pass());
    let passes = passes_together && documents.iter().all(|level| level.passes);
    let document = Document {
        game: input.source.name.clone(),
        digest: Some(game.digest()),
        passes,
        seed: Some(&args.seed),
        criteria: Some(&criteria),
        problems: diagnostics::placed(&input.source, game.warnings()),
        levels: documents,
        judgements: &of_game,
    };
    console.document(&document)?;
    let warnings = warnings(&game, &input.source, &judged);
    let text = document.review(&warnings).text(console.is_quiet());
    if !text.is_empty() {
        console.say(text.trim_end());
    }
    if !malformed.is_empty() {
        return Err(Failure::malformed(malformed.join("\n")));
    }
    if let Some(path) = &args.witness {
        match judged.iter().find_map(|judged| judged.report.as_ref()?.witness.as_ref()) {
            Some(witness) => {
                episodes::write(path, witness)?;
                if !console.is_quiet() {
                    console.say(format_args!("witness written to {}", path.in_message()));
                }
            }
            None => {
                console.remark(format_args!("{}: not written, because no win was found", path.in_message()))
            }
        }
    }
    Ok(passes)
}

/// Returns warnings about a game and its levels as text.
fn warnings(game: &Game, source: &Named, judged: &[JudgedLevel<'_>]) -> Vec<String> {
    let of_game = game.warnings().iter().map(|warning| (source, warning));
    let of_levels = judged.iter().flat_map(|judged| {
        let warnings = judged.level.iter().flat_map(Level::warnings);
        warnings.map(|warning| (judged.named, warning))
    });
    let all = of_game.chain(of_levels);
    all.map(|(source, warning)| diagnostics::one_in_words(source, warning)).collect()
}

fn levels(args: &Args, input: &GameInput) -> Result<Vec<Named>, Failure> {
    input.named_levels(&args.levels)
}

/// Returns the failure for a game that does not compile. Lists the game's problems, and the problems in its
/// levels that can be determined without the compiled game.
fn malformed(args: &Args, console: &Console, input: &GameInput, problems: &[Diagnostic]) -> Failure {
    let mut told = vec![diagnostics::in_words(&input.source, problems)];
    let mapping = Some(&input.source.text).filter(|_| !args.as_reference);
    let mapping = mapping.and_then(|source| LevelMapping::of_source(source));
    let levels = match levels(args, input) {
        Ok(levels) => levels,
        Err(failure) => {
            told.push(failure.to_string());
            Vec::new()
        }
    };
    let mut documents = Vec::new();
    for level in &levels {
        let problems = mapping.as_ref().map_or(Vec::new(), |mapping| mapping.problems(&level.text));
        if Diagnostics::has_errors(&problems) {
            told.push(diagnostics::in_words(level, &problems));
        }
        let problems = diagnostics::placed(level, &problems);
        documents.push(LevelDocument { level: level.name.clone(), problems, ..LevelDocument::default() });
    }
    let (game, problems) = (input.source.name.clone(), diagnostics::placed(&input.source, problems));
    match console.document(&Document { game, problems, levels: documents, ..Document::default() }) {
        Ok(()) => Failure::malformed(told.join("\n")),
        Err(failure) => failure,
    }
}

fn document_of<'a>(analysis: &Analysis, judged: &'a JudgedLevel<'_>) -> LevelDocument<'a> {
    let JudgedLevel { named, level, report } = judged;
    let problems = match level {
        Ok(level) => level.warnings(),
        Err(problems) => &problems.0,
    };
    let out_of_reach =
        level.as_ref().map(|level| describe::hindered_wins(analysis, level, &analysis.reach(level)));
    LevelDocument {
        level: named.name.clone(),
        digest: level.as_ref().ok().map(Level::digest),
        passes: report.as_ref().is_some_and(Report::passes),
        problems: diagnostics::placed(named, problems),
        board: level
            .as_ref()
            .map_or(Vec::new(), |level| level.to_string().lines().map(str::to_owned).collect()),
        out_of_reach: out_of_reach.unwrap_or_default(),
        report: report.as_ref(),
        witness: report.as_ref().and_then(|report| report.witness.as_ref()),
    }
}
