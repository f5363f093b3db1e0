//! `cargo xtask judging`: compares the sequential judging of candidates with judging in full.
//!
//! Minting searches a win of each candidate for a short time first, and stops the plays of the ladder when the answer is as good as
//! sure. Here the same candidates are judged both ways, with the same dice.

use anyhow::Context;
use engine::{Game, Seed, syntax};
use forge::games::{FIRST_SEARCH, GameOrder};
use generators::kernels::{KernelGame, KernelGenome, Slot};
use rayon::prelude::*;
use report::{Share, Table, TableCell};
use std::collections::{BTreeMap, BTreeSet};
use validators::{Criteria, Judgement, Panel, Report, Verdict};

/// Judges candidates for levels of generated games sequentially and in full, and counts the verdicts that differ.
///
/// Prints a table of the verdicts that differ, each kind in a row, and the calls of both ways. Cost: about a second of one core a
/// candidate.
///
/// Example: cargo xtask judging --candidates 2000
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Candidates to judge
    #[arg(long, value_name = "N", default_value_t = 200)]
    candidates: u64,
    /// Text that all seeds are derived from
    #[arg(long, value_name = "TEXT", default_value = "judging")]
    seed: String,
}

/// The answer of one way of judging.
struct Answer {
    /// The criterion that says no; none if all say yes.
    obstacle: Option<&'static str>,
    calls: u64,
}

/// A candidate judged both ways.
struct Compared {
    in_full: Answer,
    sequential: Answer,
    /// `true` if the short search found no win, so that a long one followed.
    is_searched_twice: bool,
}

/// The judges of both ways.
struct Judges {
    in_full: Panel,
    brief: Panel,
    thorough: Panel,
    skill: Panel,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let mut criteria = GameOrder::criteria_by_default();
    criteria.ask.push("skill".to_owned());
    let judges = Judges::of(&criteria)?;
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
        let ask: Vec<String> = criteria.ask.iter().filter(|name| *name != "skill").cloned().collect();
        let alone = Criteria { ask, ..criteria.clone() };
        let skill = Criteria { ask: vec!["skill".to_owned()], ..criteria.clone() };
        let panel = |criteria| Panel::new(criteria).context("the criteria of generated games");
        Ok(Judges {
            in_full: panel(criteria)?,
            brief: Panel::brief(&alone, FIRST_SEARCH)?,
            thorough: panel(&alone)?,
            skill: Panel::sequential(&skill)?,
        })
    }

    /// Judges a level of a game of the kernel both ways; `None` if none could be drawn.
    fn compare(&self, kernel: &str, slot: Slot, seed: Seed) -> Option<Compared> {
        let genome = KernelGenome::of_kernel(kernel, |_| true, &BTreeSet::new(), seed.child("rules", 0))?;
        let KernelGame { game, course } = genome.build().ok()?;
        let game = Game::from_source(&syntax::print(&game.description)).ok()?;
        let level = game.level(&course.level(slot, seed.child("layout", 0)).ok()?.text).ok()?;
        let seed = seed.child("judges", 0);
        let in_full = Answer::of(&self.in_full.screen(&game, &level, seed));
        let mut report = self.brief.screen(&game, &level, seed);
        let mut calls = 0;
        let is_searched_twice = report.first_obstacle().is_some_and(is_unsolved);
        if is_searched_twice {
            calls += Answer::of(&report).calls;
            report = self.thorough.screen(&game, &level, seed);
        }
        let alone = Answer::of(&report);
        calls += alone.calls;
        let sequential = match (alone.obstacle, report.witness) {
            (None, Some(witness)) => {
                let skill = Answer::of(&self.skill.screen_won(&game, &level, witness, seed));
                Answer { calls: calls + skill.calls, ..skill }
            }
            (obstacle, _) => Answer { obstacle, calls },
        };
        Some(Compared { in_full, sequential, is_searched_twice })
    }
}

impl Answer {
    fn of(report: &Report) -> Answer {
        let obstacle = report.first_obstacle().map(|judgement| judgement.criterion);
        let calls = report.judgements.iter().map(|judgement| judgement.finding.calls()).sum();
        Answer { obstacle, calls }
    }

    fn name(&self) -> &'static str {
        self.obstacle.unwrap_or("accepted")
    }
}

/// Tests whether no win was found within the budget.
fn is_unsolved(judgement: &Judgement) -> bool {
    judgement.criterion == "winnable" && matches!(judgement.finding.verdict, Verdict::Unknown { .. })
}

fn print(compared: &[Compared]) {
    let mut kinds: BTreeMap<[&str; 2], u64> = BTreeMap::new();
    for Compared { in_full, sequential, .. } in compared {
        *kinds.entry([in_full.name(), sequential.name()]).or_default() += 1;
    }
    let all = compared.len() as u64;
    let columns = ["in full", "sequential", "candidates"];
    let note = "`accepted`, or the criterion that says no first.";
    let mut table = Table::new("judging", "Verdicts", note, &columns);
    for ([in_full, sequential], count) in &kinds {
        table.push(vec![TableCell::text(*in_full), TableCell::text(*sequential), TableCell::Count(*count)]);
    }
    println!("{}", table.to_markdown());
    let differ = |is_other: fn(&Compared) -> bool| {
        let share = Share::new(compared.iter().filter(|judged| is_other(judged)).count() as u64, all);
        let [low, high] = share.interval;
        format!(
            "{} of {all}, {:.2} % (95 %: {:.2} to {:.2})",
            share.count,
            100.0 * share.share(),
            100.0 * low,
            100.0 * high
        )
    };
    let accepts = |answer: &Answer| answer.obstacle.is_none();
    println!(
        "accepted by one way only: {}",
        differ(|judged| judged.in_full.obstacle.is_none() != judged.sequential.obstacle.is_none())
    );
    println!("searched twice: {}", differ(|judged| judged.is_searched_twice));
    let calls = |of: fn(&Compared) -> &Answer| {
        compared.iter().map(|judged| of(judged).calls).sum::<u64>() as f64 / 1e6
    };
    let (in_full, sequential) = (calls(|judged| &judged.in_full), calls(|judged| &judged.sequential));
    println!(
        "calls, millions: in full {in_full:.1}, sequential {sequential:.1}, ratio {:.2}",
        sequential / in_full
    );
    let accepted = compared.iter().filter(|judged| accepts(&judged.in_full)).count();
    println!("accepted in full: {accepted}");
}
