//! A game before it has levels, and a game that is made: with levels, a card and an episode that wins each.

use super::levels::{FoundLevel, FoundLevels};
use crate::card::{Card, Origin};
use base::SeedPath;
use engine::{Analysis, Description, Episode, Game, syntax};
use generators::games::GeneratedGame;
use validators::Judgement;

/// A candidate before it has levels.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// The rules.
    pub game: Game,
    /// Title in the game's own fiction.
    pub title: String,
    /// A description of the game for people.
    pub description: String,
    /// The way to win, for people.
    pub goal: String,
    /// The kind of game.
    pub kind: String,
    /// `true` if anything moves unless the player acts.
    pub real_time: bool,
    /// The source of the game.
    pub origin: Origin,
}

/// A game with its levels, all of which its judges let in.
#[derive(Clone, Debug)]
pub struct MadeGame {
    /// The rules.
    pub game: Game,
    /// The rules as text, headed by title and canary.
    pub text: String,
    /// Its card.
    pub card: Card,
    /// Its levels, from the easiest to the hardest.
    pub levels: Vec<FoundLevel>,
    /// The findings about all levels together.
    pub together: Vec<Judgement>,
    /// The episode that wins each level.
    pub witnesses: Vec<Episode>,
    /// The seed of its levels and of its judges.
    pub seed: SeedPath,
}

impl Candidate {
    /// A generated game: which candidate for its place it is, and who made it.
    pub(crate) fn generated(made: GeneratedGame, generator: &str, candidate: u32) -> Candidate {
        let GeneratedGame { rules: game, title, summary, goal, kind, real_time, patterns } = made;
        let origin = Origin::Generated { generator: generator.to_owned(), patterns, candidate };
        let kind = kind.name().to_owned();
        Candidate { game, title, description: summary, goal, kind, real_time, origin }
    }

    /// The game with its levels; none if its judges were not asked what cards tell.
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

/// The text of a game that is headed by its title, with the mark of a release below it; without, if there is none yet.
pub fn marked(titled: &Description, canary: &str) -> String {
    let mut tree = titled.clone();
    if !canary.is_empty() {
        let below = tree.header.trivia.above.len().min(1);
        tree.header.trivia.above.insert(below, format!("canary {canary}"));
    }
    syntax::print(&tree)
}

/// A title as a folder name: lower-case letters, digits, single dashes.
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
