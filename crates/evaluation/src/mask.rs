//! Masks games: replaces all names with meaningless ones, without changing the rules.

use crate::error::EvaluationError;
use base::{Digest, Seed};
use engine::syntax::{SpriteLine, Trivia, meaningless_names};
use engine::{Description, Game, Observation};
use std::collections::BTreeMap;

/// A renaming that hides the names of a game's sprite types.
#[derive(Clone, Debug)]
pub(crate) struct Mask {
    /// The renamed game. The renamed sprite types keep their positions in the registry.
    pub(crate) game: Game,
    /// `true` if the avatar's resources are sorted by their new names, which hides the original order.
    is_neutral: bool,
    names: BTreeMap<String, String>,
}

impl Mask {
    /// Renames the sprite types to `t1`, `t2` and so on, in an order derived from the game's digest.
    /// Comments, colours and images are removed.
    ///
    /// # Errors
    /// Returns an error if the game does not compile under different names. Such a game has faults that only
    /// the reference engine tolerates.
    pub(crate) fn of(game: &Game) -> Result<Mask, EvaluationError> {
        let description = game.description();
        let seed = Seed::from_text(&game.digest().to_string());
        let mut sampler = seed.child("masked names", 0).sampler();
        let names = meaningless_names(&description.own_names(), &mut sampler);
        let mut masked = description.renamed(&names);
        strip(&mut masked, &["img", "autotiling", "randomtiling", "color"]);
        let game = Game::compile(&masked).map_err(|problems| {
            EvaluationError::Malformed(format!("the names of the game cannot be masked: {problems}"))
        })?;
        Ok(Mask { game, is_neutral: false, names })
    }

    /// Renames all sprite types to `t1`, `t2` and so on, including types whose names are built into the
    /// engine. The order is derived from the game's digest. The game's levels remain valid.
    pub(crate) fn neutral(game: &Game) -> Mask {
        let own: Vec<&str> = game.sprite_types().map(|stype| game.name(stype)).collect();
        let seed = Seed::from_text(&game.digest().to_string());
        let names = meaningless_names(&own, &mut seed.child("neutral names", 0).sampler());
        Mask { game: game.under_names(&names), is_neutral: true, names }
    }

    /// Returns the number that selects the neutral characters, which is different for each game.
    pub(crate) fn neutral_characters(game: &Game) -> u64 {
        Seed::from_text(&game.digest().to_string()).child("neutral characters", 0).sampler().bits()
    }

    /// Returns the replacement for a name in the game.
    pub(crate) fn name<'a>(&'a self, own: &'a str) -> &'a str {
        self.names.get(own).map_or(own, String::as_str)
    }

    /// Returns the observation with all names replaced.
    pub(crate) fn observation(&self, seen: &Observation) -> Observation {
        let mut masked = seen.clone();
        let avatar = masked.avatar.iter_mut().map(|avatar| &mut avatar.name);
        let held = masked.resources.iter_mut().map(|(name, _)| name);
        let movers = masked.movers.iter_mut().map(|mover| &mut mover.name);
        let clocks = masked.countdowns.iter_mut().map(|countdown| &mut countdown.name);
        let others = held.chain(avatar).chain(movers).chain(clocks);
        for name in masked.cells.iter_mut().flatten().chain(others) {
            if let Some(other) = self.names.get(name) {
                name.clone_from(other);
            }
        }
        if self.is_neutral {
            masked.resources.sort();
        }
        masked
    }
}

/// Returns a digest of the rules that ignores type names, level characters, colours, images and comments.
/// Games with the same lines in the same order have equal digests, even if their names differ.
pub(crate) fn nameless(description: &Description) -> Digest {
    let own = description.own_names().into_iter().zip(1..);
    let names = own.map(|(name, number)| (name.to_owned(), format!("t{number}"))).collect();
    let mut rules = description.renamed(&names);
    strip(&mut rules, &["img", "autotiling", "randomtiling", "color"]);
    rules.mapping.clear();
    Digest::of(engine::syntax::print_bare(&rules).as_bytes())
}

/// Removes comments and the given parameters of sprite types.
fn strip(description: &mut Description, keys: &[&str]) {
    fn sprites(lines: &mut [SpriteLine], keys: &[&str]) {
        for line in lines {
            line.trivia = Trivia::default();
            line.params.retain(|param| !keys.contains(&param.key.text.as_str()));
            sprites(&mut line.children, keys);
        }
    }
    sprites(&mut description.sprites, keys);
}

/// Returns the rules without image names, which would reveal the sprite types' roles.
pub(crate) fn without_pictures(description: &Description) -> Description {
    let mut description = description.clone();
    strip(&mut description, &["img", "autotiling", "randomtiling"]);
    description
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::Action;
    use itertools::Itertools;

    const GAME: &str = "BasicGame\n  SpriteSet\n    t3 > Immovable\n    bug > RandomNPC\n    avatar > MovingAvatar\n  LevelMapping\n    g > t3\n    b > bug\n  InteractionSet\n    avatar wall > stepBack\n    t3 avatar > killSprite\n  TerminationSet\n    SpriteCounter stype=t3 win=True\n";

    /// Neutral names replace all type names, including names that already look neutral. Nothing else changes.
    #[test]
    fn neutral_names_change_nothing_else() {
        let game = Game::from_source(GAME).unwrap();
        let mask = Mask::neutral(&game);
        let names: Vec<&str> = game.sprite_types().map(|stype| mask.game.name(stype)).sorted().collect();
        assert_eq!(names, ["t1", "t2", "t3", "t4"]);
        let level = game.level("wwwww\nwA bw\nw  gw\nwwwww\n").unwrap();
        let [mut own, mut other] =
            [&game, &mask.game].map(|game| game.start(&level, Seed::from_text("mask")));
        for action in Action::ALL.into_iter().cycle().take(30) {
            game.step(&mut own, action);
            mask.game.step(&mut other, action);
            assert_eq!(own.state_hash(), other.state_hash());
            let mut masked = mask.game.observe(&other);
            masked.resources.sort();
            assert_eq!(mask.observation(&game.observe(&own)), masked);
        }
        assert_eq!(mask.game.digest(), game.digest());
    }
}
