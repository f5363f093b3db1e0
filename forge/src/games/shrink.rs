//! Smaller games that play the same: redundant rules are taken away.

use super::candidate::Candidate;
use super::levels::FoundLevel;
use engine::{Episode, Game, Level};
use generators::games::GameGenome;
use std::collections::{BTreeMap, BTreeSet};
use validators::{Recorded, executions};

/// Things that are taken away from one game at most.
const STEPS: usize = 12;
/// Executions of a rule that is taken away that are looked at before everything is.
const USES: usize = 8;

/// The smallest game that comes of taking away one thing after another without which every episode that the judges of the
/// levels have played ends as it did: after the same keys, with the same outcome and score. None if nothing can go.
///
/// Cost: some tens of builds for each thing. What is missed is missed in the first episodes that show it; for each thing that
/// can go all episodes are replayed.
pub(super) fn shrunk(
    genome: &GameGenome,
    first: &Candidate,
    levels: &[FoundLevel],
    candidate: impl Fn(&GameGenome) -> Option<Candidate>,
) -> Option<Candidate> {
    smallest(genome, first, &Played::of(levels), candidate)
}

fn smallest(
    genome: &GameGenome,
    first: &Candidate,
    played: &Played,
    candidate: impl Fn(&GameGenome) -> Option<Candidate>,
) -> Option<Candidate> {
    // What plays alike does the same in the same episodes: one recording serves all that come of this game.
    let uses = played.executions(&first.game);
    let mut smallest: Option<(GameGenome, Candidate)> = None;
    for _ in 0..STEPS {
        let (from, game) =
            smallest.as_ref().map_or((genome, &first.game), |(genome, candidate)| (genome, &candidate.game));
        let smaller = from.shrunk_once().into_iter().find_map(|smaller| {
            let candidate = candidate(&smaller)?;
            played.alike(game, &candidate.game, &uses).then_some((smaller, candidate))
        });
        match smaller {
            Some(smaller) => smallest = Some(smaller),
            None => break,
        }
    }
    smallest.map(|(_, candidate)| candidate)
}

/// The texts of the levels, and what was played on them.
struct Played {
    levels: Vec<(String, Vec<Episode>)>,
}

impl Played {
    fn of(levels: &[FoundLevel]) -> Played {
        let level = |found: &FoundLevel| (found.level.to_string(), found.report.episodes());
        Played { levels: levels.iter().map(level).collect() }
    }

    fn read(&self, game: &Game) -> Option<Vec<Level>> {
        self.levels.iter().map(|(text, _)| game.level(text).ok()).collect()
    }

    /// The places where the rules of a game, by their text, are executed.
    fn executions(&self, game: &Game) -> BTreeMap<String, Vec<[usize; 2]>> {
        let Some(levels) = self.read(game) else { return BTreeMap::new() };
        let recorded =
            levels.iter().zip(&self.levels).map(|(level, (_, episodes))| Recorded { level, episodes });
        rules(game).zip(executions(game, &recorded.collect::<Vec<_>>())).collect()
    }

    /// Tests whether a smaller game plays as a game does; `uses` has the places where rules are executed.
    fn alike(&self, game: &Game, smaller: &Game, uses: &BTreeMap<String, Vec<[usize; 2]>>) -> bool {
        let Some(levels) = self.read(smaller) else { return false };
        let same = |[level, episode]: [usize; 2]| {
            ends_alike(smaller, &levels[level], &self.levels[level].1[episode])
        };
        let kept: BTreeSet<String> = rules(smaller).collect();
        let gone = rules(game).filter(|rule| !kept.contains(rule)).filter_map(|rule| uses.get(&rule));
        let telling = gone.flat_map(|uses| uses.iter().take(USES).copied());
        let witnesses = (0..levels.len()).map(|level| [level, 0]);
        let all = self.levels.iter().enumerate();
        let all = all.flat_map(|(level, (_, episodes))| (0..episodes.len()).map(move |at| [level, at]));
        telling.chain(witnesses).chain(all).all(same)
    }
}

/// The interactions, each as one text.
fn rules(game: &Game) -> impl Iterator<Item = String> + '_ {
    game.description().interactions.iter().map(|line| {
        let words = line.second.iter().chain([&line.effect]).map(|word| word.text.as_str());
        let params =
            line.params.iter().flat_map(|param| [param.key.text.as_str(), param.value.text.as_str()]);
        [line.first.text.as_str()].into_iter().chain(words).chain(params).collect::<Vec<_>>().join(" ")
    })
}

fn ends_alike(game: &Game, level: &Level, episode: &Episode) -> bool {
    let mut state = game.start(level, episode.seed);
    for &action in &episode.actions {
        if state.is_over() {
            return false;
        }
        game.step(&mut state, action);
    }
    state.outcome() == episode.outcome && state.score() == episode.score
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::{Action, Seed, syntax};
    use generators::games::GameVariation;
    use generators::levels::{ConstructiveLevels, LevelConfig};
    use generators::{Generator as _, Variation as _};

    #[test]
    fn what_nothing_runs_can_go_and_what_decides_an_episode_stays() {
        let source = "BasicGame\n  SpriteSet\n    gem > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    g > gem\n  InteractionSet\n    avatar wall > stepBack\n    gem avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=gem win=True\n    Timeout limit=60 win=False\n";
        let game = Game::from_source(source).unwrap();
        let level = "wwwwww\nwA  gw\nwwwwww\n";
        let (mut episode, mut state) =
            Episode::begin(&game, &game.level(level).unwrap(), Seed::from_text("gem"));
        while !state.is_over() {
            episode.play(&game, &mut state, Action::Right);
        }
        assert_eq!(episode.outcome, engine::Outcome::Won);
        let played = Played { levels: vec![(level.to_owned(), vec![episode])] };
        let uses = played.executions(&game);
        let altered = |line: &str, to: &str| Game::from_source(&source.replace(line, to)).unwrap();
        // Whoever goes straight for the gem meets no wall.
        assert!(played.alike(&game, &altered("    avatar wall > stepBack\n", ""), &uses));
        assert!(!played.alike(&game, &altered("scoreChange=1", ""), &uses));
        assert!(!played.alike(&game, &altered("gem avatar > killSprite", "gem avatar > stepBack"), &uses));
    }

    #[test]
    fn rules_that_no_episode_needs_are_gone() {
        let seed = Seed::from_text("shrunk");
        let genome = GameVariation::default().create(seed).unwrap();
        let candidate = |genome: &GameGenome| Candidate::generated(genome.build().ok()?, "test", 0).ok();
        let first = candidate(&genome).unwrap();
        let level = ConstructiveLevels::new(&first.game, LevelConfig::default())
            .and_then(|levels| levels.generate(seed))
            .unwrap();
        let (mut episode, mut state) = Episode::begin(&first.game, &level, seed);
        let mut sampler = seed.sampler();
        while !state.is_over() && episode.actions.len() < 40 {
            let action = *sampler.choose(first.game.actions(&state));
            episode.play(&first.game, &mut state, action);
        }
        let played = Played { levels: vec![(level.to_string(), vec![episode])] };
        let smaller = smallest(&genome, &first, &played, candidate).expect("40 ticks do not need all rules");
        let size = |candidate: &Candidate| syntax::print(candidate.game.description()).len();
        assert!(size(&smaller) < size(&first));
        let (text, episodes) = &played.levels[0];
        assert!(ends_alike(&smaller.game, &smaller.game.level(text).unwrap(), &episodes[0]));
    }
}
