//! The distance between two games by their rules, independent of names and line order
//! ([measurements](../../../docs/explanation/novelty.md)).

mod colours;
mod graph;
mod kernel;
mod labelling;

use base::Digest;
use engine::{Game, SpriteType};
use graph::RuleGraph;
use kernel::Features;

/// The rules of a game without names, symbols, colours or order. Two games are the same game in different
/// themes if their forms have the same [`digest`](GameForm::digest).
///
/// The following parts of a game's text do not count:
///
/// - the names and appearance of sprite types;
/// - the level characters, except that the form includes which types are placed together;
/// - the order of lines, and of partners on a line;
/// - whether a parameter is inherited, written, or written with its default value;
/// - types without sprites that only serve as parents and do not have a class of their own;
/// - lines that are not enabled;
/// - `wall` and `avatar`, if the file does not declare them and no rule names them.
///
/// Games whose rules run in a different order may play differently and still share a form. Such games count as one
/// game.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GameForm {
    digest: Digest,
    features: Features,
}

/// The distance below which two games count as duplicates, which have the same rules with different numbers or in a
/// different theme.
pub const NEAR: f64 = 0.3;

impl GameForm {
    /// Computes a game's form. Cost: about a millisecond, and no forward-model calls.
    pub fn of(game: &Game) -> GameForm {
        let graph = RuleGraph::of(game);
        let digest = Digest::of(labelling::canonical(&graph).text.as_bytes());
        GameForm { digest, features: Features::of(&graph) }
    }

    /// Returns the digest, which depends only on the parts that count. Different rules never share a digest. Equal
    /// rules always share a digest, except in games with many types that look alike but are not equivalent, as the
    /// source of `labelling` explains.
    pub fn digest(&self) -> Digest {
        self.digest
    }

    /// Returns the index and distance of the nearest form; `None` without forms. Ties go to the earlier form. Cost:
    /// O(rules) per form.
    pub fn nearest<'a>(&self, forms: impl IntoIterator<Item = &'a GameForm>) -> Option<(usize, f64)> {
        let apart = forms.into_iter().map(|form| distance(self, form)).enumerate();
        apart.reduce(|best, next| if next.1 < best.1 { next } else { best })
    }

    /// Returns `true` if the two games are duplicates: their distance is less than [`NEAR`].
    pub fn is_near(&self, other: &GameForm) -> bool {
        distance(self, other) < NEAR
    }
}

/// Returns the distance between the rules of two games, from 0 (equal forms) to 1 (nothing in common). The distance is
/// symmetric and obeys the triangle inequality. Cost: O(rules).
pub fn distance(one: &GameForm, two: &GameForm) -> f64 {
    one.features.distance(&two.features)
}

/// Returns the types of a game in a canonical order, independent of names and file order. In games with equal
/// forms, types at the same position correspond to each other. Types that can be exchanged without changing
/// the rules may trade positions. Types that no rule names and no character places are omitted. Costs as much
/// as [`GameForm::of`].
pub fn canonical_types(game: &Game) -> Vec<SpriteType> {
    let graph = RuleGraph::of(game);
    labelling::canonical(&graph).order.into_iter().map(|at| graph.stypes[at]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the form of a game in which types chase each other as specified, and all types kill the avatar.
    fn chase(chases: &[usize]) -> GameForm {
        let name = |number: usize| format!("t{number}");
        let sprites: String = chases
            .iter()
            .enumerate()
            .map(|(at, &to)| format!("    {} > Chaser stype={}\n", name(at), name(to)))
            .collect();
        let rules: String =
            (0..chases.len()).map(|at| format!("    avatar {} > killSprite\n", name(at))).collect();
        let placed: String = (0..chases.len())
            .map(|at| format!("    {} > {}\n", (b'a' + at as u8) as char, name(at)))
            .collect();
        let source = format!(
            "BasicGame\n  SpriteSet\n{sprites}    avatar > MovingAvatar\n  LevelMapping\n{placed}  InteractionSet\n{rules}  TerminationSet\n    SpriteCounter stype=avatar\n    Timeout limit=90 win=True\n"
        );
        GameForm::of(&Game::from_source(&source).unwrap_or_else(|problems| panic!("{problems}\n{source}")))
    }

    #[test]
    fn rotated_rings_of_types_are_one_game() {
        let ring = chase(&[1, 2, 3, 4, 5, 0]);
        assert_eq!(ring.digest(), chase(&[3, 4, 0, 5, 2, 1]).digest());
        assert_eq!(ring.digest(), chase(&[5, 0, 1, 2, 3, 4]).digest());
        // Colours alone do not distinguish two rings of three from one ring of six. The digest distinguishes
        // them, but the distance does not.
        let rings = chase(&[1, 2, 0, 4, 5, 3]);
        assert_ne!(ring.digest(), rings.digest());
        assert_eq!(distance(&ring, &rings), 0.0);
        assert_eq!(rings.digest(), chase(&[2, 3, 4, 5, 0, 1]).digest());
    }

    /// All 20 types can be exchanged. Individualizing them one by one would produce 20! texts.
    #[test]
    fn many_equal_types_are_canonicalized_quickly() {
        let twins: Vec<usize> = (0..20).map(|_| 20).chain([20]).collect();
        let one = chase(&twins);
        let mut other: Vec<usize> = vec![3; 21];
        other[3] = 3;
        assert_eq!(one.digest(), chase(&other).digest());
    }

    /// The types chase each other in pairs, so exchanging two types of different pairs does not map the game onto
    /// itself.
    #[test]
    fn equal_pairs_are_canonicalized() {
        let pairs: Vec<usize> = (0..16).map(|at| at ^ 1).collect();
        let crossed: Vec<usize> = (0..16).map(|at| (at + 8) % 16).collect();
        assert_eq!(chase(&pairs).digest(), chase(&crossed).digest());
    }

    #[test]
    fn ties_go_to_the_first_neighbour() {
        let (ring, pairs, chain) = (chase(&[1, 2, 0]), chase(&[1, 0, 1]), chase(&[1, 2, 3, 4, 5, 0]));
        assert_eq!(ring.nearest([&chain, &pairs, &ring, &ring]), Some((2, 0.0)));
        assert_eq!(ring.nearest([]), None);
        assert!(ring.is_near(&ring) && distance(&ring, &pairs) > 0.0);
    }
    /// Corresponding types have the same position, regardless of names and order.
    #[test]
    fn canonical_positions_are_distinct() {
        let game = |names: [&str; 3], order: [usize; 3]| {
            let classes = ["Immovable", "RandomNPC", "Door"];
            let sprites: String =
                order.iter().map(|&at| format!("    {} > {}\n", names[at], classes[at])).collect();
            let source = format!(
                "BasicGame\n  SpriteSet\n{sprites}    avatar > MovingAvatar\n  LevelMapping\n    a > {}\n    b > {}\n    c > {}\n  InteractionSet\n    {} avatar > killSprite\n    avatar {} > killSprite\n  TerminationSet\n    SpriteCounter stype={} win=True\n    SpriteCounter stype=avatar\n",
                names[0], names[1], names[2], names[0], names[1], names[0]
            );
            Game::from_source(&source).unwrap_or_else(|problems| panic!("{problems}\n{source}"))
        };
        let (one, two) = (game(["gem", "imp", "gate"], [0, 1, 2]), game(["orc", "cup", "well"], [2, 0, 1]));
        assert_eq!(GameForm::of(&one).digest(), GameForm::of(&two).digest());
        let names = |game: &Game| {
            let name = |stype: SpriteType| game.name(stype).to_owned();
            canonical_types(game).into_iter().map(name).collect::<Vec<String>>()
        };
        let dress = |name: String| match name.as_str() {
            "gem" => "orc".to_owned(),
            "imp" => "cup".to_owned(),
            "gate" => "well".to_owned(),
            _ => name,
        };
        assert_eq!(names(&one).into_iter().map(dress).collect::<Vec<String>>(), names(&two));
        assert_eq!(names(&one).len(), 4);
    }
}
