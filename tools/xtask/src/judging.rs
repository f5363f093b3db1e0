//! `cargo xtask judging` compares sequential judging of candidates with full judging.

use anyhow::Context;
use base::Seed;
use forge::games::GameOrder;
use generators::games::GeneratedGame;
use generators::kernels::{KernelGame, KernelGenome, Slot};
use rayon::prelude::*;
use report::{Share, Table, TableCell};
use std::collections::{BTreeMap, BTreeSet};
use validators::{Criteria, Criterion, CriterionSet, Effort, Judging, Panel, Report};

/// Judges candidates for levels of generated games both sequentially and in full, with the same randomness, and counts
/// the verdicts that differ.
///
/// Minting stops random play once it is certain that the level is rejected, and stops the reference players' episodes
/// once the answer is almost certain. Prints a table of the verdicts, with one row per kind, and the number of calls of
/// both methods. Cost: about a second on one core per candidate.
///
/// Example: cargo xtask judging --candidates 2000
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Number of candidates to judge
    #[arg(long, value_name = "N", default_value_t = 200)]
    candidates: u64,
    /// Text from which all seeds are derived
    #[arg(long, value_name = "TEXT", default_value = "judging")]
    seed: String,
}

/// The result of judging a level by one method.
struct Answer {
    /// The criterion that the level fails, or `None` if it passes all criteria.
    obstacle: Option<Criterion>,
    calls: u64,
}

/// The results of judging a level by both methods.
struct Compared {
    in_full: Answer,
    sequential: Answer,
}

/// The judges of both methods. Both use the same search for a win, so the search runs only once.
struct Judges {
    search: Panel,
    in_full: Panel,
    sequential: Panel,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let judges = Judges::of(&GameOrder::criteria_by_default())?;
    let kernels: Vec<&str> = KernelGenome::kernels().collect();
    let seed = Seed::from_text(&args.seed);
    let compared: Vec<Compared> = (0..args.candidates)
        .into_par_iter()
        .filter_map(|number| {
            let kernel = kernels[number as usize % kernels.len()];
            let slot = Slot::ALL[number as usize / kernels.len() % Slot::ALL.len()];
            judges.compare(kernel, slot, seed.child("candidate", number))
        })
        .collect();
    print(&compared);
    Ok(())
}

impl Judges {
    fn of(criteria: &Criteria) -> anyhow::Result<Judges> {
        let asking = |ask: &[Criterion]| {
            let criteria = Criteria { ask: CriterionSet::of(ask), ..criteria.clone() };
            criteria.check().context("the criteria of generated games")
        };
        let played = asking(&[Criterion::NotIdle, Criterion::NotRandom, Criterion::Skill])?;
        Ok(Judges {
            search: Panel::new(asking(&[Criterion::WellFormed, Criterion::Winnable])?, Effort::Full),
            in_full: Panel::new(played.clone(), Effort::Full),
            sequential: Panel::new(played, Effort::Sequential),
        })
    }

    /// Judges a level of a kernel's game by both methods. Returns `None` if no level can be drawn, or no win
    /// is found.
    fn compare(&self, kernel: &str, slot: Slot, seed: Seed) -> Option<Compared> {
        let genome = KernelGenome::of_kernel(kernel, |_| true, &BTreeSet::new(), seed.child("rules", 0))?;
        let KernelGame { game: GeneratedGame { rules: game, .. }, course } = genome.build().ok()?;
        let level = game.level(&course.level(slot, seed.child("layout", 0)).ok()?.text).ok()?;
        let seed = seed.child("judges", 0);
        let judging = || Judging::level(&game, &level, seed).until_failure();
        let witness = self.search.judge(judging()).witness?;
        let ask = |panel: &Panel| Answer::of(&panel.judge(judging().won_by(witness.clone())));
        Some(Compared { in_full: ask(&self.in_full), sequential: ask(&self.sequential) })
    }
}

impl Answer {
    fn of(report: &Report) -> Answer {
        let obstacle = report.first_obstacle().map(|judgement| judgement.criterion);
        let calls = report.judgements.iter().map(|judgement| judgement.finding.calls()).sum();
        Answer { obstacle, calls }
    }

    fn name(&self) -> &'static str {
        self.obstacle.map_or("accepted", Criterion::name)
    }
}

fn print(compared: &[Compared]) {
    let mut kinds: BTreeMap<[&str; 2], u64> = BTreeMap::new();
    for Compared { in_full, sequential } in compared {
        *kinds.entry([in_full.name(), sequential.name()]).or_default() += 1;
    }
    let columns = ["in full", "sequential", "candidates"];
    let note = "Accepted, or the first criterion that fails.";
    let mut table = Table::new("judging", "Verdicts", note, &columns);
    for ([in_full, sequential], count) in &kinds {
        table.push(vec![TableCell::text(*in_full), TableCell::text(*sequential), TableCell::Count(*count)]);
    }
    println!("{}", table.to_markdown());
    let differ = compared.iter().filter(|judged| judged.in_full.name() != judged.sequential.name()).count();
    let share = Share::new(differ as u64, compared.len() as u64);
    let [low, high] = share.interval.map(|bound| 100.0 * bound);
    println!(
        "different verdicts: {differ} of {}, {:.2}% (95%: {low:.2} to {high:.2})",
        compared.len(),
        100.0 * share.share(),
    );
    let calls = |of: fn(&Compared) -> &Answer| {
        compared.iter().map(|judged| of(judged).calls).sum::<u64>() as f64 / 1e6
    };
    let (in_full, sequential) = (calls(|judged| &judged.in_full), calls(|judged| &judged.sequential));
    println!(
        "calls, millions: in full {in_full:.1}, sequential {sequential:.1}, ratio {:.2}",
        sequential / in_full
    );
}
