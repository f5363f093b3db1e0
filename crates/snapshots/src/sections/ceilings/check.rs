//! Checks of ceilings against the recipe's request, against the games and against each other, without replaying
//! episodes.

use super::{CEILING_COMMITS, Ceiling, Ceilings, CeilingsPart, GameCeilings, LevelCeilings};
use crate::contents::Contents;
use crate::error::SnapshotError;
use crate::format::canary::carries;
use crate::format::layout::HELD;
use crate::format::manifest::Manifest;
use crate::format::manifest::item::ReleaseKind;
use crate::format::manifest::withheld::HeldPart;
use base::Seed;
use engine::{Analysis, Game};
use forge::card::Card;
use generators::GENERATION;
use std::collections::BTreeMap;

/// Returns the problems with the stored ceilings (highest known win rates), given the cards of the release's games. For
/// releases of a different generation, only the canary is compared.
pub(super) fn problems(
    contents: &Contents,
    manifest: &Manifest,
    cards: &[&Card],
) -> Result<Vec<String>, SnapshotError> {
    let Some(path) = Ceilings::path_in(manifest) else { return Ok(Vec::new()) };
    let named = |what: String| format!("{path}: {what}");
    if path.starts_with(HELD) && manifest.hides(HeldPart::Rest) {
        return Ok(Vec::new());
    }
    if manifest.item(&path).is_none() {
        return Ok(vec![named("missing, although the recipe requests ceilings".to_owned())]);
    }
    let Some(text) = contents.find(&path)? else {
        // A listed file is absent only if it is withheld.
        return Ok(match manifest.kind == ReleaseKind::Sealed && path.starts_with(HELD) {
            true => Vec::new(),
            false => vec![named("missing".to_owned())],
        });
    };
    if manifest.generation != GENERATION {
        return Ok(match carries(&text, &manifest.canary) {
            true => Vec::new(),
            false => vec![named("the release's canary is missing".to_owned())],
        });
    }
    let ceilings = match Ceilings::read(&text) {
        Ok(ceilings) => ceilings,
        Err(error) => return Ok(vec![named(format!("not the ceilings of a release: {error}"))]),
    };
    let asked: Option<CeilingsPart> =
        manifest.recipe.get("ceilings").and_then(|part| serde_json::from_value(part.clone()).ok());
    let mut found = of_ceilings(&ceilings, asked, &manifest.canary, cards);
    if found.is_empty() {
        for game in &ceilings.games {
            found.extend(exactness_problem(contents, game)?);
        }
    }
    Ok(found.into_iter().map(named).collect())
}

fn of_ceilings(
    ceilings: &Ceilings,
    asked: Option<CeilingsPart>,
    canary: &str,
    cards: &[&Card],
) -> Vec<String> {
    if ceilings.canary != canary {
        return vec!["the canary differs from the release's canary".to_owned()];
    }
    if asked != Some(ceilings.asked) {
        return vec!["the settings do not match the recipe".to_owned()];
    }
    let by_id: BTreeMap<&str, &Card> = cards.iter().map(|card| (card.id.as_str(), *card)).collect();
    if !ceilings.games.iter().map(|game| game.id.as_str()).eq(by_id.keys().copied()) {
        return vec!["the games do not match the release's games".to_owned()];
    }
    let problem = |game: &GameCeilings| {
        let what = shape_problem(&game.levels, by_id[game.id.as_str()].levels.len(), asked)?;
        Some(format!("`{}`: {what}", game.id))
    };
    ceilings.games.iter().filter_map(problem).collect()
}

/// Returns a sentence about a level that is wrongly stated to be with or without randomness.
fn exactness_problem(
    contents: &Contents,
    GameCeilings { id, levels }: &GameCeilings,
) -> Result<Option<String>, SnapshotError> {
    let read = |file: String| -> Result<Option<String>, SnapshotError> {
        Ok(contents.find(&format!("games/{id}/{file}"))?.and_then(|bytes| String::from_utf8(bytes).ok()))
    };
    let Some(game) = read("game.vgdl".to_owned())?.and_then(|text| Game::from_source(&text).ok()) else {
        return Ok(Some(format!("`{id}`: the game cannot be read")));
    };
    let analysis = Analysis::of(&game);
    for (number, stated) in levels.iter().enumerate() {
        let level = read(format!("lvl{number}.txt"))?.and_then(|text| game.level(&text).ok());
        let start = level.map(|level| game.start(&level, Seed::from_text("start")));
        if start.map(|start| analysis.is_deterministic_from(&start)) != Some(stated.exact) {
            return Ok(Some(format!("`{id}`, level {number}: `exact` is wrong")));
        }
    }
    Ok(None)
}

/// Returns a sentence about the problem with the ceilings (highest known win rates) of a game with `levels` levels;
/// `None` if they are sound.
pub(super) fn shape_problem(
    found: &[LevelCeilings],
    levels: usize,
    asked: Option<CeilingsPart>,
) -> Option<String> {
    let Some(asked) = asked else {
        return (!found.is_empty()).then(|| "ceilings that the recipe does not request".to_owned());
    };
    if found.len() != levels {
        return Some("the levels do not all have ceilings".to_owned());
    }
    let problem = |(number, level)| Some(format!("level {number}: {}", level_problem(level, asked)?));
    found.iter().enumerate().find_map(problem)
}

fn level_problem(level: &LevelCeilings, asked: CeilingsPart) -> Option<&'static str> {
    if level.exact {
        return (*level != LevelCeilings::exact()).then_some("the ceilings are not those of a certain win");
    }
    if !level.ceilings.iter().map(|ceiling| ceiling.commit).eq(CEILING_COMMITS) {
        return Some("the ceilings are not at the measured commitments");
    }
    level.ceilings.iter().find_map(|ceiling| {
        let &Ceiling { commit, played, wins, episodes, .. } = ceiling;
        let recomputed = || Ceiling::of(commit, (ceiling.player.clone(), played), wins, episodes);
        if episodes != asked.episodes || wins > episodes {
            Some("the wins and episodes do not match the recipe")
        } else if played < commit || !CEILING_COMMITS.contains(&played) {
            Some("the player looks more often than the commitment allows")
        } else {
            (*ceiling != recomputed()).then_some("the win rate and its interval do not follow from the wins")
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::card::rungs::tests::card;
    use validators::Commitment;

    #[track_caller]
    fn check(alter: impl Fn(&mut Ceilings), expect: &str) {
        let asked = CeilingsPart { episodes: 20 };
        let player = || ("olets:500".to_owned(), Commitment::All);
        let ceilings = CEILING_COMMITS.map(|commit| Ceiling::of(commit, player(), 15, 20)).to_vec();
        let levels = vec![LevelCeilings::exact(), LevelCeilings { exact: false, ceilings }];
        let game = |id: &str| GameCeilings { id: id.to_owned(), levels: levels.clone() };
        let mut altered = Ceilings::of("canary", asked, vec![game("b"), game("a")]);
        alter(&mut altered);
        let cards = [card("a", &[[1, 1]; 2]), card("b", &[[1, 1]; 2])];
        let cards: Vec<&Card> = cards.iter().collect();
        let found = of_ceilings(&altered, Some(asked), "canary", &cards).join("; ");
        assert!(found.contains(expect) && found.is_empty() == expect.is_empty(), "{found:?}");
    }

    #[test]
    fn forged_ceilings_are_noticed() {
        check(|_| (), "");
        check(|file| file.canary.clear(), "the canary differs");
        check(|file| file.asked.episodes = 30, "do not match the recipe");
        check(|file| drop(file.games.pop()), "do not match the release's games");
        check(|file| drop(file.games[0].levels.pop()), "do not all have ceilings");
        check(|file| file.games[0].levels[0].ceilings[3].rate = 0.5, "not those of a certain win");
        check(|file| drop(file.games[0].levels[1].ceilings.pop()), "not at the measured commitments");
        check(|file| file.games[1].levels[1].ceilings[0].wins = 16, "do not follow from the wins");
        check(|file| file.games[1].levels[1].ceilings[0].interval[1] = 1.0, "do not follow from the wins");
        check(|file| file.games[1].levels[1].ceilings[0].episodes = 16, "do not match the recipe");
        check(|file| file.games[1].levels[1].ceilings[2].played = Commitment::One, "looks more often");
    }
}
