//! Checks of reference results against the recipe's request, against the games' cards and against each other, without
//! replaying episodes.

use super::{Falls, GameMarks, LevelMarks, Marks, MarksPart, Wins, rates};
use crate::contents::Contents;
use crate::error::SnapshotError;
use crate::format::canary::carries;
use crate::format::layout::HELD;
use crate::format::manifest::Manifest;
use crate::format::manifest::item::ReleaseKind;
use crate::format::manifest::withheld::HeldPart;
use forge::card::Card;
use generators::GENERATION;
use std::collections::BTreeMap;

/// Returns the problems with the stored results of reference players, given the cards of the release's games. For
/// releases of a different generation, only the canary is compared.
pub(super) fn problems(
    contents: &Contents,
    manifest: &Manifest,
    cards: &[&Card],
) -> Result<Vec<String>, SnapshotError> {
    let Some(path) = Marks::path_in(manifest) else { return Ok(Vec::new()) };
    let named = |what: String| format!("{path}: {what}");
    if path.starts_with(HELD) && manifest.hides(HeldPart::Rest) {
        return Ok(Vec::new());
    }
    if manifest.item(&path).is_none() {
        return Ok(vec![named("missing, although the recipe requests marks".to_owned())]);
    }
    let Some(text) = contents.find(&path)? else {
        // A listed file is absent only if it is withheld.
        return Ok(match manifest.kind == ReleaseKind::Sealed && path.starts_with(HELD) {
            true => Vec::new(),
            false => vec![named("missing".to_owned())],
        });
    };
    if manifest.generation != GENERATION {
        let carries = carries(&text, &manifest.canary);
        return Ok(if carries {
            Vec::new()
        } else {
            vec![named("the release's canary is missing".to_owned())]
        });
    }
    let marks = match Marks::read(&text) {
        Ok(marks) => marks,
        Err(error) => return Ok(vec![named(format!("not the marks of a release: {error}"))]),
    };
    let asked: Option<MarksPart> =
        manifest.recipe.get("marks").and_then(|part| serde_json::from_value(part.clone()).ok());
    Ok(of_marks(&marks, asked.as_ref(), &manifest.canary, cards).into_iter().map(named).collect())
}

fn of_marks(marks: &Marks, asked: Option<&MarksPart>, canary: &str, cards: &[&Card]) -> Vec<String> {
    if marks.canary != canary {
        return vec!["the canary differs from the release's canary".to_owned()];
    }
    if asked != Some(&marks.asked) {
        return vec!["the marks' settings do not match the recipe".to_owned()];
    }
    let by_id: BTreeMap<&str, &Card> = cards.iter().map(|card| (card.id.as_str(), *card)).collect();
    if !marks.games.iter().map(|game| game.id.as_str()).eq(by_id.keys().copied()) {
        return vec!["the games do not match the release's games".to_owned()];
    }
    let mut problems = Vec::new();
    for game in &marks.games {
        problems.extend(of_game(game, by_id[game.id.as_str()], &marks.asked));
    }
    if problems.is_empty() && rates(&marks.asked, &marks.games) != marks.rates {
        problems.push("the `rates` do not match the games".to_owned());
    }
    if problems.is_empty() && Falls::of(&marks.asked, &marks.games) != marks.falls {
        problems.push("the `falls` do not match the games".to_owned());
    }
    problems
}

fn of_game(game: &GameMarks, card: &Card, asked: &MarksPart) -> Option<String> {
    let tiers = |level: &LevelMarks| Some(level.tier);
    if !game.levels.iter().map(tiers).eq(card.levels.iter().map(|level| level.tier)) {
        return Some(format!("`{}` does not have the levels and tiers that its card states", game.id));
    }
    let wins: Vec<&Wins> = game.levels.iter().map(|level| &level.wins).collect();
    let asked = (asked.players.len(), asked.commits.len(), asked.plays);
    numbers_problem(&wins, asked).map(|what| format!("`{}`: {what}", game.id))
}

/// Returns a sentence about the problem with a game's reference results in a job's result; `None` if they are
/// sound.
pub(super) fn shape_problem(wins: &[Wins], levels: usize, asked: Option<&MarksPart>) -> Option<String> {
    let Some(asked) = asked else {
        return (!wins.is_empty()).then(|| "marks that the recipe does not request".to_owned());
    };
    if wins.len() != levels {
        return Some("the levels do not all have marks".to_owned());
    }
    let wins: Vec<&Wins> = wins.iter().collect();
    numbers_problem(&wins, (asked.players.len(), asked.commits.len(), asked.plays))
}

fn numbers_problem(wins: &[&Wins], (players, commits, plays): (usize, usize, u64)) -> Option<String> {
    let has_shape = |wins: &&&Wins| wins.len() == players && wins.iter().all(|own| own.len() == commits);
    if wins.iter().filter(has_shape).count() < wins.len() {
        return Some("marks without a number for each player and commitment".to_owned());
    }
    let most = wins.iter().flat_map(|wins| wins.iter().flatten()).copied().max().unwrap_or(0);
    (most > plays).then(|| format!("{most} wins in {plays} plays"))
}

#[cfg(test)]
mod tests {
    use super::super::tests::{asked, marks};
    use super::*;
    use crate::card::rungs::tests::card;
    use validators::Tier;

    #[track_caller]
    fn check(alter: impl Fn(&mut Marks), expect: &str) {
        let mut cards = vec![card("a", &[[1, 1]; 2]), card("b", &[[1, 1]; 2])];
        for card in &mut cards {
            (card.levels[0].tier, card.levels[1].tier) = (Some(Tier::One), Some(Tier::Four));
        }
        let mut altered = marks(&["a", "b"], |_, _| vec![vec![1, 0], vec![2, 2]]);
        alter(&mut altered);
        let cards: Vec<&Card> = cards.iter().collect();
        let found = of_marks(&altered, Some(&asked()), "canary", &cards).join("; ");
        assert!(found.contains(expect) && found.is_empty() == expect.is_empty(), "{found:?}");
    }

    #[test]
    fn forged_marks_are_noticed() {
        check(|_| (), "");
        check(|marks| marks.canary.clear(), "the canary differs");
        check(|marks| marks.asked.plays = 3, "do not match the recipe");
        check(|marks| drop(marks.games.pop()), "do not match the release's games");
        check(|marks| marks.games[1].id.push('x'), "do not match the release's games");
        check(|marks| marks.games[0].levels[0].tier = Tier::Two, "tiers that its card states");
        check(|marks| drop(marks.games[0].levels.pop()), "tiers that its card states");
        check(|marks| marks.games[0].levels[1].wins[1][1] = 3, "3 wins in 2 plays");
        check(|marks| marks.games[0].levels[1].wins[1].truncate(1), "for each player and commitment");
        check(|marks| marks.games[0].levels[1].wins[1][1] = 1, "`rates`");
        check(|marks| marks.rates[0].rate.mean = 0.25, "`rates`");
        check(|marks| marks.falls.tiers.clear(), "`falls`");
    }
}
