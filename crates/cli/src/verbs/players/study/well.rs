//! `arcade study well`: estimates how many new games are left for a chain of monthly releases.

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::flags::numbers::number;
use crate::input::embedded;
use crate::verbs::releases::release::find_recipe;
use base::MessagePath;
use base::Seed;
use engine::Game;
use forge::well::{WellOrder, simulate};
use snapshots::Recipe;
use std::path::PathBuf;
use validators::novelty::GameForm;

/// Simulates a chain of monthly releases with rules only, and measures how many new games are left.
///
/// Each month draws the invented games of the recipe as minting does: it knows all games of the earlier months, prefers
/// the mechanics that they used least, and rejects rules close to theirs or to the corpus. No boards are made. Instead,
/// a fraction of the rules, chosen by the seed, is assumed to fail. Without RECIPE, a month has 100 games. `arcade docs
/// well` explains the columns.
///
/// Exit status 0: simulated. 2: malformed input.
///
/// Example: arcade study well --months 24 --games 100
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Recipe: a TOML file, or the name of a built-in recipe; its `[invented]` section specifies what a month draws
    #[arg(value_name = "RECIPE")]
    recipe: Option<PathBuf>,
    /// Number of months in the chain
    #[arg(long, value_name = "N", default_value_t = 24, value_parser = clap::value_parser!(u32).range(1..=1200))]
    months: u32,
    /// Invented games per month [default: the number in the recipe, or 100]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    games: Option<u32>,
    /// Fraction of the new rules for which boards are found
    #[arg(long = "yield", value_name = "SHARE", default_value_t = 0.1, value_parser = number(0.0..=1.0))]
    passing: f64,
    /// Text to derive all draws from
    #[arg(long, value_name = "TEXT", default_value = "the well")]
    seed: String,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let order = order(args)?;
    let corpus = embedded::corpus()?;
    let known = corpus.games.iter().filter_map(|game| Game::from_source(&game.source).ok());
    let known: Vec<GameForm> = known.map(|game| GameForm::of(&game)).collect();
    let bar = console.progress(order.months.into(), "months");
    let well = simulate(&order, &known, Seed::from_text(&args.seed), &|_| bar.inc(1));
    bar.finish_and_clear();
    console.document(&well)?;
    console.say(format_args!(
        "{:.0} rule sets: combinations of mechanics and an ending that can be built ({:.0}% of all \
         combinations); {:.0}% of the rule sets are assumed to pass",
        well.sets,
        100.0 * well.sound,
        100.0 * order.passing
    ));
    for table in well.tables() {
        console.say(format_args!("\n{}", table.to_markdown().trim_end()));
    }
    Ok(true)
}

fn order(args: &Args) -> Result<WellOrder, Failure> {
    let usual = WellOrder { months: args.months, passing: args.passing, ..WellOrder::default() };
    let usual = WellOrder { games: args.games.unwrap_or(usual.games), ..usual };
    let Some(path) = &args.recipe else { return Ok(usual) };
    let recipe = find_recipe(path, Recipe::to_commit)?;
    let Some(part) = recipe.invented.filter(|part| part.games > 0 || args.games.is_some()) else {
        bail!(
            "{}: requests no invented games; pass the number per month with --games, or add `[invented]` to \
             the recipe",
            path.in_message()
        );
    };
    Ok(WellOrder {
        games: args.games.unwrap_or(part.games),
        candidates: part.candidates,
        tries: part.game_tries,
        ..usual
    })
}
