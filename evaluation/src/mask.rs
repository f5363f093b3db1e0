//! Games without their fiction: the rules as they are, under names that tell nothing.

use crate::error::EvaluationError;
use engine::syntax::{SpriteLine, Trivia};
use engine::{Description, Game, Observation, Seed};
use std::collections::BTreeMap;

/// Names that the engine gives a meaning to: they stay.
const RESERVED: [&str; 2] = ["wall", "avatar"];

/// What hides the names of a game's sprite types.
#[derive(Clone, Debug)]
pub(crate) struct Mask {
    game: Game,
    names: BTreeMap<String, String>,
}

impl Mask {
    /// Types are called `t1`, `t2` and so on, in an order that the game's digest decides. Comments, colours and pictures go.
    ///
    /// # Errors
    /// The game does not compile under other names: it was loaded with faults that only the reference overlooks.
    pub(crate) fn of(game: &Game) -> Result<Mask, EvaluationError> {
        let description = game.description();
        let mut own: Vec<String> = Vec::new();
        for (_, line) in description.sprite_lines() {
            let name = &line.name.text;
            if !RESERVED.contains(&name.as_str()) && !own.contains(name) {
                own.push(name.clone());
            }
        }
        let mut numbers: Vec<usize> = (1..=own.len()).collect();
        Seed::from_text(&game.digest().to_string()).child("masked names", 0).sampler().shuffle(&mut numbers);
        let names: BTreeMap<String, String> =
            own.into_iter().zip(numbers).map(|(name, number)| (name, format!("t{number}"))).collect();
        let mut masked = description.renamed(&names);
        undress(&mut masked);
        let game = Game::compile(&masked).map_err(|problems| {
            EvaluationError::Malformed(format!("the names of the game cannot be masked: {problems}"))
        })?;
        Ok(Mask { game, names })
    }

    /// The game under other names. Its types have the places in the registry that they had.
    pub(crate) fn game(&self) -> &Game {
        &self.game
    }

    /// What is seen, under other names.
    pub(crate) fn observation(&self, seen: &Observation) -> Observation {
        let mut masked = seen.clone();
        let avatar = masked.avatar.iter_mut().map(|avatar| &mut avatar.name);
        let held = masked.resources.iter_mut().map(|(name, _)| name);
        for name in masked.cells.iter_mut().flatten().chain(held).chain(avatar) {
            if let Some(other) = self.names.get(name) {
                name.clone_from(other);
            }
        }
        masked
    }
}

/// Takes away what is no rule.
fn undress(description: &mut Description) {
    fn sprites(lines: &mut [SpriteLine]) {
        for line in lines {
            line.trivia = Trivia::default();
            line.params.retain(|param| !["img", "color"].contains(&param.key.text.as_str()));
            sprites(&mut line.children);
        }
    }
    sprites(&mut description.sprites);
}
