//! Computes the meaningful steps in the same way as the reference code (`spec/06` §2.1 and §1.2), for
//! comparison with its numbers.
//!
//! The following faults of the reference code are reproduced:
//!
//! - The window is two steps.
//! - A reversal does not count even if it earned a reward.
//! - A new sprite does not count unless it covers a character.
//! - The avatar is the first `a` or `A` of the text.
//! - The last step of an episode is omitted.
//!
//! The boards' one-tick lag in one version of the reference code is not reproduced.

use engine::{Action, Game, Observation};
use itertools::Itertools;
use std::collections::{BTreeMap, BTreeSet};

/// Returns, for each step except the last, `true` if the reference code considers the step meaningful.
/// `texts` contains the board before each action, so there is no board after the last one. Board rows are
/// joined by line feeds.
///
/// ```
/// # use engine as infinite_arcade_engine;
/// use infinite_arcade_engine::Action::{Left, Right, Up};
/// use infinite_arcade_evaluation::metrics::flags_as_code;
/// let texts = ["wa..w", "w.a.w", "wa..w"].map(str::to_owned);
/// assert_eq!(flags_as_code(&texts, &[Right, Left, Up], &[0.0, 5.0, 0.0]), [true, false]);
/// ```
pub fn flags_as_code(texts: &[String], actions: &[Action], rewards: &[f64]) -> Vec<bool> {
    let places: Vec<Option<(usize, usize)>> = texts.iter().map(|text| place(text)).collect();
    let steps = actions.len().min(texts.len().saturating_sub(1)).min(rewards.len());
    (0..steps)
        .map(|t| {
            let still = places[t] == places[t + 1];
            let idle = still && rewards[t] == 0.0 && !vanished(&texts[t], &texts[t + 1]);
            let back = t > 0 && places[t - 1] == places[t + 1] && !still;
            actions[t] != Action::Nil && !idle && !back
        })
        .collect()
}

/// Returns the row and column of the character that the reference code takes for the avatar; `None` if there is no such
/// character.
fn place(text: &str) -> Option<(usize, usize)> {
    text.lines().enumerate().find_map(|(row, line)| {
        let column = line.chars().position(|character| character.eq_ignore_ascii_case(&'a'))?;
        Some((row, column))
    })
}

/// Returns `true` if any character other than the avatar's occurs less often than before.
fn vanished(before: &str, after: &str) -> bool {
    let count = |text: &str| {
        let mut counts = BTreeMap::new();
        for character in text.chars().filter(|c| !c.eq_ignore_ascii_case(&'a') && *c != '\n') {
            *counts.entry(character).or_insert(0) += 1;
        }
        counts
    };
    let after = count(after);
    count(before).into_iter().any(|(character, count)| after.get(&character).copied().unwrap_or(0) < count)
}

/// Draws boards with the characters that the reference code assigns to cell contents. The assignment depends
/// on the order in which contents appear, and stays the same throughout an episode.
#[derive(Clone, Debug)]
pub struct AsCode {
    /// The level mapping's entries, each as a character and its names as written.
    mapping: Vec<(char, Vec<String>)>,
    symbols: BTreeMap<String, char>,
}

impl AsCode {
    /// Creates the character assignment at the start of an episode.
    pub fn new(game: &Game) -> AsCode {
        let lines = game.description().mapping.iter();
        let mapping =
            lines.map(|line| (line.symbol, line.names.iter().map(|name| name.text.clone()).collect()));
        let symbols = BTreeMap::from([("avatar".to_owned(), 'a')]);
        AsCode { mapping: mapping.collect(), symbols }
    }

    /// Returns a board as text, with its rows joined by line feeds.
    pub fn text(&mut self, seen: &Observation) -> String {
        let cells: Vec<String> = seen.cells.iter().map(|cell| entity(cell)).collect();
        self.learn(&cells);
        let symbol = |cell: &String| {
            let part = || cell.split(' ').find_map(|name| self.symbols.get(name));
            self.symbols.get(cell).or_else(part).copied().unwrap_or('.')
        };
        cells.chunks(seen.columns.max(1)).map(|row| row.iter().map(symbol).join("")).join("\n")
    }

    /// Assigns characters to cell contents that have not appeared before.
    fn learn(&mut self, cells: &[String]) {
        let entities: BTreeSet<&str> =
            cells.iter().map(String::as_str).filter(|entity| !entity.is_empty()).collect();
        let ground = ["background", "floor"].into_iter().find(|name| entities.contains(name));
        if let Some(ground) = ground.filter(|ground| !self.symbols.contains_key(*ground)) {
            self.symbols.insert(ground.to_owned(), '.');
        }
        for (character, names) in &self.mapping {
            let key = names.join(" ");
            let taken = self.symbols.values().any(|symbol| symbol == character);
            if !taken && !self.symbols.contains_key(&key) && names.iter().all(|name| name != "avatar") {
                self.symbols.insert(key, *character);
            }
        }
        let first_letters = entities.iter().filter_map(|entity| entity.chars().next());
        let pool = "@#$%&*".chars().chain(first_letters.map(|letter| letter.to_ascii_lowercase()));
        let pool = pool.chain('a'..='z').chain('A'..='Z').chain('0'..='9');
        let mut used: BTreeSet<char> = self.symbols.values().copied().collect();
        let mut free = pool.filter(|&symbol| used.insert(symbol)).collect::<Vec<char>>().into_iter();
        for entity in entities {
            if entity.contains("avatar") || self.symbols.contains_key(entity) {
                continue;
            }
            // The reference code fails when it runs out of characters. Here, the remaining contents are drawn
            // as floor.
            let Some(symbol) = free.next() else { break };
            self.symbols.insert(entity.to_owned(), symbol);
        }
    }
}

/// Returns the distinct names in a cell, sorted.
fn entity(cell: &[String]) -> String {
    cell.iter().sorted().dedup().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::Action::{Left, Nil, Right, Up};
    use engine::Outcome;

    #[track_caller]
    fn check(texts: &[&str], actions: &[Action], rewards: &[f64], expect: &[bool]) {
        let texts: Vec<String> = texts.iter().map(|text| text.replace('/', "\n")).collect();
        assert_eq!(flags_as_code(&texts, actions, rewards), expect);
    }

    /// The test vectors come from `spec/06` §2.1.
    #[test]
    fn published_vectors() {
        check(&["wa..w", "w.a.w", "wa..w"], &[Left, Right, Up], &[0.0, 5.0, 0.0], &[true, false]);
        let (a, b, c) = ("a...", ".a..", "..a.");
        check(&[a, b, a, b, c], &[Right, Left, Right, Right, Right], &[0.0; 5], &[true, false, false, true]);
        check(&["waw", "waw#"], &[Up], &[0.0], &[false]);
        let walls = ["wA..w/w.a.w", "wA..w/w..aw", "wA..w/w.a.w"];
        check(&walls, &[Right, Left], &[0.0; 2], &[false, false]);
    }

    #[test]
    fn faults_of_the_reference_are_kept() {
        // An episode with a single step has no flags.
        check(&["a."], &[Right], &[1.0], &[]);
        // Doing nothing never counts, whatever its effect.
        check(&["a#", "a."], &[Nil], &[1.0], &[false]);
        check(&["a#", "a."], &[Up], &[0.0], &[true]);
        check(&["a.", "a#"], &[Up], &[0.0], &[true]);
        // Without an avatar, all positions are equal.
        check(&["..", ".."], &[Up], &[0.0], &[false]);
    }

    fn seen(cells: &[&[&str]]) -> Observation {
        Observation {
            ticks: 0,
            score: 0.0,
            outcome: Outcome::Ongoing,
            columns: cells.len(),
            rows: 1,
            cells: cells.iter().map(|cell| cell.iter().map(|&name| name.to_owned()).collect()).collect(),
            resources: Vec::new(),
            avatar: None,
            movers: Vec::new(),
            countdowns: Vec::new(),
        }
    }

    /// The level mapping's characters are used first, for contents whose names match the mapping's spelling.
    /// Next come the characters of the pool, in order. Contents that appear later get the remaining
    /// characters.
    #[test]
    fn characters_depend_on_the_order_of_appearance() {
        let game = Game::from_source(
            "
BasicGame
    SpriteSet
        floor > Immovable
        wall > Immovable
        goal > Immovable
        hero > MovingAvatar
    LevelMapping
        w > floor wall
        x > goal
        A > floor hero
    InteractionSet
        hero wall > stepBack
    TerminationSet
        SpriteCounter stype=goal win=True
",
        )
        .unwrap();
        let mut code = AsCode::new(&game);
        let board = seen(&[&["floor"], &["wall", "floor"], &["floor", "hero"], &["goal"], &[]]);
        assert_eq!(code.text(&board), ".wAx.");
        // A new stack of sprites takes the next character, and a known stack keeps its character.
        let board =
            seen(&[&["floor"], &["wall", "floor"], &["goal", "hero"], &["wall", "goal"], &["floor", "wall"]]);
        assert_eq!(code.text(&board), ".w@#w");
    }
}
