//! Checks rules: they must compile, use the required words, and be new.

use super::Problem;
use crate::brief::{Brief, keywords, uses};
use crate::known::{Known, Nearest};
use editor::Source;
use engine::Game;
use validators::novelty::NEAR;

/// The name of the game file in messages.
pub(super) const GAME_FILE: &str = "game.vgdl";

/// Rules that compile.
#[derive(Clone, Debug)]
pub(crate) struct Rules {
    pub(crate) source: String,
    pub(crate) game: Game,
    /// The nearest known game; `None` if no game is known.
    pub(crate) nearest: Option<Nearest>,
}

/// Compiles rules.
pub(crate) fn compile(source: &str, known: &Known) -> Result<Rules, Problem> {
    let game = Game::from_source(source).map_err(|problems| {
        let text = editor::in_words(shown(GAME_FILE, source), &problems.0);
        let first = problems.0.first().map_or(String::new(), |problem| format!(": {}", problem.message));
        let introduction = "The rules do not compile. Correct all of these problems.";
        Problem::reported(format!("the rules do not compile{first}"), introduction, &text)
    })?;
    let nearest = known.nearest(&game);
    Ok(Rules { source: source.to_owned(), game, nearest })
}

/// Checks that compiled rules meet the brief and are new.
pub(crate) fn check(rules: &Rules, brief: &Brief) -> Result<(), Problem> {
    let required = brief.required.iter();
    let mut words = required.flat_map(|word| keywords(word).into_iter().map(move |key| (word, key)));
    if let Some((word, key)) = words.find(|(_, key)| !uses(&rules.source, key)) {
        let cause = if *word == key { String::new() } else { format!(" by the mechanic `{word}`") };
        return Err(Problem::plain(format!(
            "The rules do not use `{key}`, which is required{cause}: add it."
        )));
    }
    match &rules.nearest {
        Some(nearest) if !nearest.is_far() => Err(Problem::plain(format!(
            "The rules are almost the same as those of {}: their distance is {:.2}, and it must be at least {NEAR:.2}. \
             Names and colours do not count. Change what the sprites do to each other, or how the game is won.",
            nearest.name, nearest.distance
        ))),
        _ => Ok(()),
    }
}

/// Returns the warnings about rules, one text per warning.
pub(crate) fn warnings(rules: &Rules) -> Vec<String> {
    let word = |warning| editor::one_in_words(shown(GAME_FILE, &rules.source), warning);
    rules.game.warnings().iter().map(word).collect()
}

pub(super) fn shown<'a>(name: &'a str, text: &'a str) -> Source<'a> {
    Source { name, text, is_coloured: false }
}
