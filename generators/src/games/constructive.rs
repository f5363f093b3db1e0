//! The constructive generator of games: draws patterns that go together and a theme, and builds the game.

use super::genome::GameGenome;
use super::kind::Kind;
use crate::{GenerateError, Generator};
use engine::{Description, Seed};
use serde::{Deserialize, Serialize};

/// The configuration of a game generator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GameConfig {
    /// The kinds to draw from.
    pub kinds: Vec<Kind>,
}

impl Default for GameConfig {
    /// All kinds.
    fn default() -> GameConfig {
        GameConfig { kinds: Kind::ALL.to_vec() }
    }
}

/// A game with its description in prose.
#[derive(Clone, Debug, PartialEq)]
pub struct GeneratedGame {
    /// The rules; they compile without errors or warnings.
    pub description: Description,
    /// The title, in the terms of the game's own theme.
    pub title: String,
    /// The contents of the game, in a few sentences.
    pub summary: String,
    /// The instructions for winning, in one sentence.
    pub goal: String,
    /// The kind of game.
    pub kind: Kind,
    /// `true` if something moves even when the player does not act.
    pub real_time: bool,
    /// The names of the patterns used, and of the theme.
    pub patterns: Vec<String>,
}

/// Composes games from typed patterns. Cost: well under a millisecond a game.
#[derive(Clone, Debug, Default)]
pub struct ConstructiveGames {
    config: GameConfig,
}

impl ConstructiveGames {
    /// Creates a generator of these kinds of games.
    pub fn new(config: GameConfig) -> ConstructiveGames {
        ConstructiveGames { config }
    }

    /// Returns the genome of the game that a seed gives.
    ///
    /// # Errors
    /// If no kinds are allowed, or generation fails with this seed. The genome may still fail to build: see
    /// [`GameGenome::build`].
    pub fn genome(&self, seed: Seed) -> Result<GameGenome, GenerateError> {
        GameGenome::draw(&self.config, seed)
    }
}

impl Generator for ConstructiveGames {
    type Output = GeneratedGame;

    fn generate(&self, seed: Seed) -> Result<GeneratedGame, GenerateError> {
        self.genome(seed)?.build()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::levels::{ConstructiveLevels, LevelConfig};
    use engine::{Game, Outcome};
    use std::collections::{BTreeMap, BTreeSet};

    fn games(count: u64) -> Vec<GeneratedGame> {
        let generator = ConstructiveGames::default();
        let seed = Seed::from_text("games");
        (0..count).map(|number| generator.generate(seed.child("game", number)).unwrap()).collect()
    }

    #[test]
    fn the_same_seed_gives_the_same_game() {
        assert_eq!(games(20), games(20));
    }

    #[test]
    fn games_differ_and_every_pattern_and_kind_occurs() {
        let games = games(600);
        let digests: BTreeSet<String> =
            games.iter().map(|game| Game::compile(&game.description).unwrap().digest().to_string()).collect();
        assert!(digests.len() > 590, "{} different games", digests.len());
        let mut uses: BTreeMap<&str, u32> = BTreeMap::new();
        for pattern in games.iter().flat_map(|game| &game.patterns) {
            *uses.entry(pattern).or_default() += 1;
        }
        let all = super::super::goals::all().into_iter().map(|goal| goal.pattern.name);
        let rest = [super::super::movement::MOVEMENTS, super::super::threats::THREATS];
        let more = [super::super::obstacles::OBSTACLES, super::super::boons::BOONS];
        let names = all.chain(rest.into_iter().chain(more).flatten().map(|pattern| pattern.name));
        let missing: Vec<&str> = names.filter(|name| !uses.contains_key(name)).collect();
        assert_eq!(missing, Vec::<&str>::new());
        let kinds: BTreeSet<Kind> = games.iter().map(|game| game.kind).collect();
        assert_eq!(kinds.len(), Kind::ALL.len());
    }

    #[test]
    fn a_game_of_each_kind_can_be_requested() {
        for &kind in Kind::ALL {
            let generator = ConstructiveGames::new(GameConfig { kinds: vec![kind] });
            for number in 0..10 {
                let game = generator.generate(Seed::from_text(kind.name()).child("game", number)).unwrap();
                assert_eq!(game.kind, kind);
            }
        }
    }

    /// Descriptions are built as trees, not parsed; printing one and parsing the text must give the same game.
    #[test]
    fn the_printed_rules_are_the_same_game() {
        for game in games(200) {
            let text = engine::syntax::print(&game.description);
            let again = Game::from_source(&text).unwrap_or_else(|problems| panic!("{problems}\n{text}"));
            assert_eq!(again.digest(), Game::compile(&game.description).unwrap().digest());
            assert_eq!(again.warnings(), []);
        }
    }

    /// With generated levels, random play does nothing that stops the engine.
    #[test]
    fn games_play_on_generated_levels() {
        let mut levels = 0;
        for (number, made) in games(60).iter().enumerate() {
            let game = Game::compile(&made.description).unwrap();
            let seed = Seed::from_text("levels").child("game", number as u64);
            let generator = ConstructiveLevels::new(&game, LevelConfig::default()).unwrap();
            let Ok(level) = generator.generate(seed) else { continue };
            levels += 1;
            let mut sampler = seed.child("actions", 0).sampler();
            let mut state = game.start(&level, seed.child("chance", 0));
            for _ in 0..400 {
                let action = *sampler.choose(game.actions(&state));
                let outcome = game.step(&mut state, action);
                assert!(!matches!(outcome, Outcome::Stopped(_)), "{}: {outcome:?}", made.title);
            }
        }
        assert!(levels >= 55, "{levels} of 60 games got a level");
    }

    #[test]
    fn texts_for_people_are_sentences() {
        for game in games(100) {
            for text in [&game.summary, &game.goal] {
                assert!(text.ends_with('.') && text.starts_with(|c: char| c.is_uppercase()), "{text}");
                assert!(!text.contains("  ") && !text.contains(" ,"), "{text}");
            }
            assert!(!game.title.is_empty() && game.title.is_ascii(), "{}", game.title);
        }
    }
}
