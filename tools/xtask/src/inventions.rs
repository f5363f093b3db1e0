//! `cargo xtask inventions` invents games, and reports the reasons why attempts fail.

use anyhow::Context;
use base::{Seed, SeedPath};
use forge::Tally;
use forge::games::{GameOrder, MadeGame, invent_one};
use forge::levels::Method;
use generators::invention::Census;
use rayon::prelude::*;
use snapshots::Recipe;
use std::fs;
use std::path::{Path, PathBuf};

/// Invents games under the criteria of a recipe, writes the accepted games, and counts the reasons why other
/// attempts fail.
///
/// Cost: a minute or two on one core per game.
///
/// Example: cargo xtask inventions seeds/2026-12.toml --count 4 --out invented
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Recipe with the criteria
    #[arg(value_name = "FILE")]
    recipe: PathBuf,
    /// Number of games to invent
    #[arg(long, value_name = "N", default_value_t = 4)]
    count: u32,
    /// Number of rule sets to try per game
    #[arg(long, value_name = "N", default_value_t = 12)]
    attempts: u32,
    /// Method for generating the levels: constructive, search, evolutionary
    #[arg(long, value_name = "NAME", default_value_t = Method::Constructive)]
    method: Method,
    /// Text from which all seeds are derived
    #[arg(long, value_name = "TEXT", default_value = "inventions")]
    seed: String,
    /// Folder for the games
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let text = fs::read_to_string(&args.recipe).with_context(|| args.recipe.display().to_string())?;
    let recipe = Recipe::from_toml(&text).with_context(|| args.recipe.display().to_string())?;
    let part = &recipe.generated;
    let mut order = GameOrder {
        levels: part.levels,
        level_tries: part.level_tries,
        least_interactions: part.least_interactions.min(5),
        least_mechanics: part.least_mechanics,
        criteria: recipe.criteria.check()?,
        method: args.method,
        ..GameOrder::new(1)
    };
    order.effort.attempts = args.attempts;
    let seed = SeedPath::from(Seed::from_text(&args.seed));
    let invent = |number| -> anyhow::Result<Tally> {
        let (made, tally) = invent_one(&order, &Census::default(), &[], seed.clone(), number);
        if let Some(made) = made {
            let card = &made.card;
            println!("{number}: {} ({})\n   {}\n   {}", card.title, card.id, card.description, card.goal);
            args.out.as_ref().map_or(Ok(()), |out| write(&out.join(&card.id), &made))?;
        }
        Ok(tally)
    };
    let tallies: Vec<Tally> = (0..args.count).into_par_iter().map(invent).collect::<Result<_, _>>()?;
    let mut all = Tally::default();
    tallies.iter().for_each(|tally| all.add(tally));
    let calls = all.calls / 1_000_000;
    let (made, looks) = (all.games_accepted, all.looks());
    println!("{made} of {} games, {looks} inspected, {calls} million calls: {}", args.count, all.reasons());
    Ok(())
}

fn write(folder: &Path, made: &MadeGame) -> anyhow::Result<()> {
    fs::create_dir_all(folder)?;
    fs::write(folder.join("game.vgdl"), &made.text)?;
    let about = format!("{}\n\n{}\n", made.card.description, made.card.goal);
    fs::write(folder.join("about.txt"), about)?;
    for (number, found) in made.levels.iter().enumerate() {
        fs::write(folder.join(format!("lvl{number}.txt")), found.level.to_string())?;
    }
    Ok(())
}
