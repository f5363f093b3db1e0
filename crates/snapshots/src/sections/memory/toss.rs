//! The creation of pairs (two renamings of a game, or two wins of a level), and the coin tosses that decide which
//! member is published. Both are part of minting a game.

use super::{PREFIX, SecondWin, Sibling, publishes_sibling, publishes_win};
use crate::sections::frozen::FrozenGame;
use crate::sections::memory::part::MemoryPart;
use crate::twin;
use agents::search::{Answer, Pushes, SearchLimits, a_star, best_first};
use agents::{PortfolioConfig, Solution, solve, systematic_seed};
use base::{Seed, SeedPath};
use engine::{Action, Analysis, Episode, Game, Level, Outcome};
use forge::card::Origin;
use forge::games::slug;
use rayon::prelude::*;
use validators::Criteria;

/// The number of attempts at a second win. In each attempt, planners search first, followed by a systematic search.
const TRIES: u64 = 4;
/// The maximum number of actions in a detour at the start of a deterministic level. The search for a win begins after
/// the detour.
const DETOUR: usize = 6;
/// The maximum number of pairs of renamings to create in search of a pair with distinct themes.
const THEME_TRIES: u64 = 16;

/// Creates the pairs requested for a game. A coin toss selects the member of each pair that is published. A game
/// without a second theme gets no sibling (withheld renamed copy), and a level without a second win gets no pair.
/// `criteria` are the criteria of the game's judges.
///
/// Cost: up to [`TRIES`] attempts at a second win per level.
pub(crate) fn toss(frozen: &mut FrozenGame, root: Seed, part: MemoryPart, criteria: &Criteria) {
    if part.siblings {
        toss_siblings(frozen, root);
    }
    if part.witnesses {
        toss_wins(frozen, root, criteria);
    }
}

/// Replaces a game with one of two renamings, and stores the other as its sibling. Both renamings are created from
/// the game in the same way, so nothing that is published reveals which one was withheld.
fn toss_siblings(frozen: &mut FrozenGame, root: Seed) {
    let Ok(game) = Game::from_source(&frozen.text) else { return };
    let seed = root.child(&format!("siblings of {}", game.digest()), 0);
    let renaming = |number| {
        twin::renamed(&frozen.text, &frozen.levels, &frozen.witnesses, seed.child("renaming", number)).ok()
    };
    // Two renamings into the same theme would share words.
    let pair = (0..THEME_TRIES).find_map(|number| {
        let (one, other) = (renaming(2 * number)?, renaming(2 * number + 1)?);
        (one.1 != other.1).then_some([one.0, other.0])
    });
    let Some([one, other]) = pair else { return };
    let games = [&one, &other].map(|twin| Game::from_source(&twin.text));
    let [Ok(first), Ok(second)] = games else { return };
    let ((published, game), withheld) = match publishes_sibling(root, first.digest(), second.digest()) {
        true => ((one, first), other),
        false => ((other, second), one),
    };
    let witnesses: Option<Vec<Episode>> = published.witnesses.into_iter().collect();
    let Some(witnesses) = witnesses else { return };
    let card = &mut frozen.card;
    card.id = format!("{}-{}", slug(&published.title), game.digest().short());
    (card.digest, card.rules) = (game.digest(), engine::describe(&game));
    (card.title, card.description, card.goal) = (published.title, published.description, published.goal);
    if let Origin::Generated { patterns, .. } = &mut card.origin {
        patterns.retain(|pattern| !["scene/", "fiction/"].iter().any(|kind| pattern.starts_with(kind)));
    }
    for (level, witness) in card.levels.iter_mut().zip(&witnesses) {
        // The sentence about the level's problem uses the names of the original scene (theme), so it is dropped.
        (level.digest, level.asks) = (witness.level, None);
    }
    (frozen.text, frozen.levels, frozen.witnesses) = (published.text, published.levels, witnesses);
    frozen.sibling = Some(Sibling { title: withheld.title, text: withheld.text, levels: withheld.levels });
}

fn toss_wins(frozen: &mut FrozenGame, root: Seed, criteria: &Criteria) {
    let Ok(game) = Game::from_source(&frozen.text) else { return };
    let analysis = Analysis::of(&game);
    let config = PortfolioConfig { shortest: 0.0, systematic: 0.0, ..criteria.search() };
    let levels: Vec<(&String, &Episode)> = frozen.levels.iter().zip(&frozen.witnesses).collect();
    let second = |(text, known): (&String, &Episode)| {
        let level = game.level(text).ok()?;
        (0..TRIES).find_map(|number| {
            let seed = SeedPath::from(root).child(&format!("second win of {}", level.digest()), 0);
            let seed = seed.child("try", number);
            let searches: [Search; 2] = [planned, after_a_detour];
            let mut episode = searches
                .into_iter()
                .filter_map(|search| search(&analysis, &level, &config, &seed))
                .find(|episode| differ(&episode.actions, &known.actions))?;
            Some(SecondWin { path: std::mem::take(&mut episode.path), episode })
        })
    };
    frozen.seconds = levels.into_par_iter().map(second).collect();
    let pairs = frozen.seconds.iter_mut().zip(&mut frozen.witnesses).zip(&mut frozen.paths);
    for (((second, witness), path), card) in pairs.zip(&mut frozen.card.levels) {
        let Some(second) = second else { continue };
        if !publishes_win(root, witness, &second.episode) {
            std::mem::swap(witness, &mut second.episode);
            std::mem::swap(path, &mut second.path);
            (card.witness_ticks, card.witness_score) = (witness.actions.len(), witness.score);
        }
    }
}

/// Returns `true` if two wins begin differently, so that no sequence of actions can begin like both.
pub(crate) fn differ(one: &[Action], other: &[Action]) -> bool {
    let common = PREFIX.min(one.len()).min(other.len());
    one[..common] != other[..common]
}

/// A win search on a level, with a given seed.
type Search = fn(&Analysis, &Level, &PortfolioConfig, &SeedPath) -> Option<Episode>;

/// Searches for a win with planners; `None` if they find no win.
fn planned(analysis: &Analysis, level: &Level, config: &PortfolioConfig, seed: &SeedPath) -> Option<Episode> {
    let Solution::Won { episode, .. } = solve(analysis, level, config, seed).solution else { return None };
    Some(*episode)
}

/// Searches systematically for a win after a detour at the start of a deterministic level; `None` if no win is found.
fn after_a_detour(
    analysis: &Analysis,
    level: &Level,
    config: &PortfolioConfig,
    seed: &SeedPath,
) -> Option<Episode> {
    let game = analysis.game();
    let (mut episode, mut state) = Episode::begin(game, level, systematic_seed(seed));
    if state.is_over() || !analysis.is_deterministic_from(&state) {
        return None;
    }
    let mut sampler = seed.seed().child("detour", 0).sampler();
    for _ in 0..sampler.between(1, DETOUR) {
        let action = *sampler.choose(game.actions(&state));
        if episode.play(game, &mut state, action) != Outcome::Ongoing {
            return None;
        }
    }
    let limits = |share: u64| SearchLimits { calls: config.budget / share, bytes: config.bytes };
    let pushes = Pushes::of(analysis, level);
    let answer = match a_star(analysis, &pushes, &state, limits(10)).answer {
        won @ Answer::Won { .. } => won,
        _ => best_first(analysis, &pushes, &state, limits(2)).answer,
    };
    let Answer::Won { actions, .. } = answer else { return None };
    for action in actions {
        episode.play(game, &mut state, action);
    }
    (episode.outcome == Outcome::Won).then_some(episode)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wins_differ_by_their_beginning() {
        use Action::{Down, Left, Up};
        let check = |one: &[Action], other: &[Action], expect: bool| {
            assert_eq!((differ(one, other), differ(other, one)), (expect, expect));
        };
        check(&[Up], &[Down], true);
        check(&[Up, Left], &[Up, Down], true);
        check(&[Up, Left], &[Up], false);
        check(&[vec![Up; 10], vec![Left]].concat(), &[Up; 12], false);
        check(&[vec![Up; 9], vec![Left]].concat(), &[Up; 12], true);
    }
}
