//! `cargo xtask kernels` reports why the games of each kernel fail.

use anyhow::{Context, bail};
use base::Seed;
use forge::Tally;
use forge::games::{GameOrder, attempt_kernel};
use generators::kernels::KernelGenome;
use itertools::Itertools;
use rayon::prelude::*;
use report::{Table, TableCell};
use snapshots::Recipe;
use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use validators::novelty::{GameForm, NEAR, distance};

/// Attempts games of each kernel under the criteria of a recipe. Counts the accepted games, and the reasons
/// why the other games fail.
///
/// If a kernel rarely passes, other kernels take its turns, so that a release has many games from few kernels.
/// Attempts are independent, so the games of a kernel may be similar to each other. Cost: 1 to 15 seconds on one core
/// per attempt.
///
/// Example: cargo xtask kernels seeds/2026-12.toml --kernel one-pull
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Recipe with the criteria
    #[arg(value_name = "FILE")]
    recipe: PathBuf,
    /// Kernels to attempt [default: all]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    kernel: Vec<String>,
    /// The only form to attempt; `plain` for kernels without a form [default: all]
    #[arg(long, value_name = "NAME")]
    form: Option<String>,
    /// Print the distance from the rules of each form to the nearest other form of its kernel, and attempt
    /// nothing
    #[arg(long, conflicts_with = "form")]
    distances: bool,
    /// Number of attempts per kernel
    #[arg(long, value_name = "N", default_value_t = 24, value_parser = clap::value_parser!(u32).range(1..))]
    attempts: u32,
    /// Text from which all seeds are derived
    #[arg(long, value_name = "TEXT", default_value = "kernels")]
    seed: String,
}

/// The name for a kernel without forms.
const PLAIN: &str = "plain";

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let text = fs::read_to_string(&args.recipe).with_context(|| args.recipe.display().to_string())?;
    let recipe = Recipe::from_toml(&text).with_context(|| args.recipe.display().to_string())?;
    let part = &recipe.generated;
    let order = GameOrder {
        levels: part.levels,
        level_tries: part.level_tries,
        least_interactions: part.least_interactions,
        least_mechanics: part.least_mechanics,
        criteria: recipe.criteria.check()?,
        ..GameOrder::new(1)
    };
    let mut kernels: Vec<&str> = KernelGenome::kernels().collect();
    if let Some(strange) = args.kernel.iter().find(|name| !kernels.contains(&name.as_str())) {
        bail!("there is no kernel {strange}; the kernels are: {}", kernels.iter().join(", "));
    }
    kernels.retain(|name| args.kernel.is_empty() || args.kernel.iter().any(|wanted| wanted == name));
    if let Some(form) = &args.form {
        let forms: BTreeSet<&str> = kernels
            .iter()
            .flat_map(|kernel| KernelGenome::forms(kernel))
            .map(|form| form.unwrap_or(PLAIN))
            .collect();
        if !forms.contains(form.as_str()) {
            bail!("there is no form {form}; the forms are: {}", forms.iter().join(", "));
        }
    }
    if args.distances {
        kernels.iter().for_each(|kernel| println!("{}", distances(kernel).to_markdown()));
        return Ok(());
    }
    let seed = Seed::from_text(&args.seed);
    let columns = ["kernel", "made", "of", "forms made", "calls, millions", "why not"];
    let note = "The reasons for rejected levels and games, with their counts, most frequent first.";
    let mut table = Table::new("kernels", "Games of each kernel", note, &columns);
    for kernel in kernels {
        let is_wanted =
            |form: Option<&str>| args.form.as_deref().is_none_or(|wanted| wanted == form.unwrap_or(PLAIN));
        let attempt = |number| attempt_kernel(&order, kernel, is_wanted, seed, number);
        let attempts: Vec<_> = (0..args.attempts).into_par_iter().map(attempt).collect();
        let mut tally = Tally::default();
        attempts.iter().for_each(|(_, of_attempt)| tally.add(of_attempt));
        let forms = attempts.iter().filter_map(|(made, _)| made.as_ref());
        let forms = forms.map(|made| made.card.origin.form().unwrap_or(PLAIN)).counts();
        table.push(vec![
            TableCell::text(kernel),
            TableCell::Count(tally.games_accepted),
            TableCell::Count(args.attempts.into()),
            TableCell::text(forms.iter().sorted().map(|(form, made)| format!("{form} {made}")).join(", ")),
            TableCell::number(tally.calls as f64 / 1e6, 0),
            TableCell::text(tally.reasons()),
        ]);
    }
    println!("{}", table.to_markdown());
    Ok(())
}

/// Returns a table of distances. For each of a kernel's forms, with and without variants, it states the
/// distance to the nearest other form.
fn distances(kernel: &str) -> Table {
    let built = KernelGenome::all_of(kernel).into_iter().filter_map(|genome| genome.build().ok());
    let forms: Vec<(String, GameForm)> = built
        .map(|built| {
            let of_rules = |name: &&String| name.starts_with("form/") || name.starts_with("variant/");
            let parts = built.game.patterns.iter().filter(of_rules).join(", ");
            let name = if parts.is_empty() { PLAIN.to_owned() } else { parts };
            (name, GameForm::of(&built.game.rules))
        })
        .collect();
    let note = format!("Rules nearer than {NEAR} count as the same.");
    let mut table = Table::new(kernel, kernel, &note, &["rules", "nearest others", "distance"]);
    for (at, (name, form)) in forms.iter().enumerate() {
        let others = forms.iter().enumerate().filter(|(other, _)| *other != at);
        let apart = others.map(|(_, (name, other))| (distance(form, other), name));
        let Some((apart, nearest)) = apart.min_by(|one, two| one.0.total_cmp(&two.0)) else { continue };
        table.push(vec![TableCell::text(name), TableCell::text(nearest), TableCell::number(apart, 2)]);
    }
    table
}
