//! A candidate game without levels, and a finished game with levels, a card and a winning episode for each level.

use super::found_level::FoundLevel;
use super::levels::FoundLevels;
use crate::card::{Card, Origin};
use base::SeedPath;
use engine::{Analysis, Description, Episode, Game, syntax};
use generators::games::GeneratedGame;
use validators::Judgement;

/// A candidate game without levels.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// The game's rules.
    pub game: Game,
    /// The title in the game's theme.
    pub title: String,
    /// A description of the game for players.
    pub description: String,
    /// The way to win, explained to players.
    pub goal: String,
    /// The kind of game.
    pub kind: String,
    /// `true` if sprites move even while the player does nothing.
    pub real_time: bool,
    /// The game's origin.
    pub origin: Origin,
}

/// A game with levels, accepted by its judges.
#[derive(Clone, Debug)]
pub struct MadeGame {
    /// The game's rules.
    pub game: Game,
    /// The rules as text, headed by the title and the release's canary (its identifier in text corpora).
    pub text: String,
    /// The game's card.
    pub card: Card,
    /// The levels, from easiest to hardest.
    pub levels: Vec<FoundLevel>,
    /// The findings about the levels as a whole.
    pub together: Vec<Judgement>,
    /// The winning episode of each level.
    pub witnesses: Vec<Episode>,
    /// The seed for levels and judges.
    pub seed: SeedPath,
}

impl Candidate {
    /// Creates a candidate from a generated game, with its generator and its index among the candidates for the game's
    /// position.
    pub fn generated(made: GeneratedGame, generator: &str, candidate: u32) -> Candidate {
        let GeneratedGame { rules: game, title, summary, goal, kind, real_time, patterns } = made;
        let origin = Origin::Generated { generator: generator.to_owned(), patterns, candidate };
        let kind = kind.name().to_owned();
        Candidate { game, title, description: summary, goal, kind, real_time, origin }
    }

    /// Returns the game with its levels; `None` if the judges' results are not sufficient for a card.
    pub fn finish(self, found: FoundLevels, canary: &str) -> Option<MadeGame> {
        let Candidate { game, title, description, goal, kind, real_time, origin } = self;
        let mut tree = game.description().clone();
        tree.header.trivia.above.insert(0, title.clone());
        let text = marked(&tree, canary);
        let rated = found.levels.iter().zip(&found.mcts).enumerate();
        let cards = rated.map(|(number, (level, mcts))| level.card(number, mcts));
        let (levels, witnesses) = cards.collect::<Option<Vec<_>>>()?.into_iter().unzip();
        let card = Card {
            canary: canary.to_owned(),
            id: format!("{}-{}", slug(&title), game.digest().short()),
            title,
            description,
            goal,
            kind,
            real_time,
            deterministic: !Analysis::of(&game).is_stochastic(),
            digest: game.digest(),
            origin,
            rules: engine::describe(&game),
            levels,
        };
        let FoundLevels { levels, together, seed, .. } = found;
        Some(MadeGame { text, game, card, levels, together, witnesses, seed })
    }
}

/// Returns a game's text, headed by its title and the release's canary (its identifier in text corpora). An empty
/// canary is omitted.
pub fn marked(titled: &Description, canary: &str) -> String {
    let mut tree = titled.clone();
    if !canary.is_empty() {
        let below = tree.header.trivia.above.len().min(1);
        tree.header.trivia.above.insert(below, format!("canary {canary}"));
    }
    syntax::print(&tree)
}

/// Converts a title to a folder name consisting of lower-case letters, digits and single dashes.
pub fn slug(title: &str) -> String {
    let mut slug = String::new();
    for c in title.chars() {
        if c.is_ascii_alphanumeric() {
            slug.push(c.to_ascii_lowercase());
        } else if !slug.ends_with('-') && !slug.is_empty() && c != '\'' {
            slug.push('-');
        }
    }
    slug.truncate(40);
    let slug = slug.trim_end_matches('-');
    if slug.is_empty() { "game".to_owned() } else { slug.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::slug;

    #[test]
    fn slugs_are_plain() {
        assert_eq!(slug("The Salt Orchard"), "the-salt-orchard");
        assert_eq!(slug("  Keeper's  — Light! "), "keepers-light");
        assert_eq!(slug("!!"), "game");
    }
}
