//! A guess at the rules of a game, as lines of VGDL.

use crate::world_model::task::WorldModelTask;
use std::fmt::Write;

/// A guess at the rules. It is stored as text, so any change is easy to make, but may fail to compile.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Guess {
    /// The sprite types with their classes and parameters, such as `("t3", "Missile orientation=LEFT")`.
    pub(super) types: Vec<(String, String)>,
    pub(super) rules: Vec<Rule>,
    /// The lines of the TerminationSet.
    pub(super) ends: Vec<String>,
}

/// An interaction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Rule {
    pub(super) first: String,
    pub(super) second: String,
    /// The effect with its parameters.
    pub(super) effect: String,
}

impl Guess {
    /// Returns the game as text.
    pub(super) fn source(&self, task: &WorldModelTask) -> String {
        let mut text = "BasicGame\n    SpriteSet\n".to_owned();
        let mut line = |line: &str| writeln!(text, "    {line}").expect("texts grow");
        self.types.iter().for_each(|(name, class)| line(&format!("    {name} > {class}")));
        line("LevelMapping");
        task.masked.mapping.iter().for_each(|mapping| line(&format!("    {mapping}")));
        line("InteractionSet");
        for Rule { first, second, effect } in &self.rules {
            line(&format!("    {first} {second} > {effect}"));
        }
        line("TerminationSet");
        self.ends.iter().for_each(|end| line(&format!("    {end}")));
        text
    }

    /// Returns the number of words. Among guesses that explain the recordings equally well, the shortest is preferred.
    pub(super) fn words(&self) -> usize {
        let words = |text: &String| text.split(' ').count();
        self.types.iter().map(|(_, class)| words(class)).sum::<usize>()
            + self.rules.iter().map(|rule| 2 + words(&rule.effect)).sum::<usize>()
            + self.ends.iter().map(words).sum::<usize>()
    }
}
