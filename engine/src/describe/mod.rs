//! A game's rules in plain English. The same game always produces the same text.
//!
//! This module is the only source of rules in English: prompts, cards and `arcade describe` all use it.

mod fill;
mod kind;
mod level;
mod order;
mod phrases;
mod rules;
mod sprites;
mod swap;
mod template;
mod words;

pub use level::{hindered_wins, level};
pub use phrases::texts;
pub use template::{Part, Template, templates};
pub use words::plural;

use crate::analysis::Analysis;
use crate::game::Game;
use crate::rules::SpriteType;
use std::fmt;

/// A game in plain English, as sections of sentences.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Guide {
    /// The functions of the keys, with one sentence for each possible avatar type.
    pub controls: Vec<String>,
    /// The ways to win, in order of priority.
    pub winning: Vec<String>,
    /// The ways to lose, in order of priority.
    pub losing: Vec<String>,
    /// The course of a tick: the facts that apply to all interactions and matter in this game.
    pub order: Vec<String>,
    /// The behaviour of all sprites other than avatars, one line per type, in registry order.
    pub sprites: Vec<String>,
    /// The members of the groups to which interactions, chasers and fleeing sprites refer, one line per
    /// group.
    pub groups: Vec<String>,
    /// The timed effects, one line per effect.
    pub timed_effects: Vec<String>,
    /// The interactions, one line per interaction, in order of execution. Interactions with the edge come
    /// first.
    pub meetings: Vec<String>,
    /// The sprites that each level character places, by character.
    pub legend: Vec<String>,
    /// The kind of game, in the terms of its [`Taxonomy`](crate::analysis::Taxonomy). It is not printed with
    /// the other sections, because it classifies the rules instead of stating one, and players may have to
    /// discover it.
    pub kind: Vec<String>,
}

impl Guide {
    /// Returns the guide (the rules in plain English) to a game.
    pub fn of(game: &Game) -> Guide {
        Guide::from_analysis(&Analysis::of(game))
    }

    /// Returns the guide to an analysed game.
    pub fn from_analysis(analysis: &Analysis) -> Guide {
        Guide {
            controls: sprites::controls(analysis),
            winning: rules::endings(analysis, true),
            losing: rules::endings(analysis, false),
            order: order::order(analysis),
            sprites: sprites::sprites(analysis),
            groups: rules::groups(analysis),
            timed_effects: rules::timed_effects(analysis),
            meetings: rules::meetings(analysis),
            legend: sprites::legend(analysis),
            kind: kind::kind(&analysis.taxonomy()),
        }
    }

    /// Returns how to win, as one sentence.
    pub fn goal(&self) -> String {
        let mut ways = self.winning.iter().map(|way| way.trim_end_matches('.'));
        let Some(first) = ways.next() else { return "Nothing wins.".to_owned() };
        let others = ways.map(|way| format!(", or {}", way.strip_prefix("You win ").unwrap_or(way)));
        format!("{first}{}.", others.collect::<String>())
    }
}

impl fmt::Display for Guide {
    /// Writes all non-empty sections of the rules, each with a heading.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sections = [
            ("How you play", &self.controls),
            ("How you win", &self.winning),
            ("How you lose", &self.losing),
            ("How a tick goes", &self.order),
            ("What the others do", &self.sprites),
            ("Words for several", &self.groups),
            ("What happens by the clock", &self.timed_effects),
            ("What happens when sprites meet", &self.meetings),
            ("What the level's characters stand for", &self.legend),
        ];
        let filled = sections.into_iter().filter(|(_, lines)| !lines.is_empty());
        for (at, (heading, lines)) in filled.enumerate() {
            let gap = if at == 0 { "" } else { "\n" };
            writeln!(f, "{gap}{heading}:")?;
            for line in lines {
                writeln!(f, "  {line}")?;
            }
        }
        Ok(())
    }
}

/// Returns the types that interactions use only to swap two other types. Their sprites exist only during the swap, so
/// no player ever sees one.
pub fn passing_types(analysis: &Analysis) -> Vec<SpriteType> {
    swap::Swap::betweens(analysis)
}

/// Returns a game's rules in plain English: all sections of its [`Guide`] except its kind.
pub fn describe(game: &Game) -> String {
    Guide::of(game).to_string()
}

/// Returns the sentences of [`Guide::meetings`] that describe interaction `line`, an index into
/// [`Description::interactions`](crate::Description). Returns an empty list if the interaction can never
/// occur.
pub fn interaction(analysis: &Analysis, line: usize) -> Vec<String> {
    rules::meetings_of(analysis, line)
}

/// Returns the sentence of [`Guide::winning`] or [`Guide::losing`] that describes termination `line`, an index into
/// [`Description::terminations`](crate::Description). Returns `None` if the termination never ends a game like that.
pub fn termination(analysis: &Analysis, line: usize, is_won: bool) -> Option<String> {
    let goal = analysis.goals().iter().find(|goal| goal.line == line)?;
    let ends = if is_won { goal.win } else { goal.can_lose() };
    ends.then(|| format!("{}.", rules::goal(analysis, goal, is_won)))
}
