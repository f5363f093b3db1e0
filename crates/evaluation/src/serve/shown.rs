//! Parses a conversation's text (`docs/reference/prompts.md` describes the prompt sections).

use super::unanswerable::Unanswerable;
use crate::client::ChatMessage;
use engine::Action;
use std::collections::BTreeMap;

/// The maximum number of actions in a plan. A limit is needed, because a served player does not know how long
/// the game lasts.
const MAX_PLAN: u64 = 1000;

/// The avatar's default character, unless the legend defines a different one.
const AVATAR: char = '@';

/// A prompt's parsed content.
#[derive(Clone, Debug, Default)]
pub(super) struct Shown<'a> {
    /// The sentences of the rules, in the prompt's order, including the sentences about the keys.
    pub(super) rules: Vec<&'a str>,
    /// The rules as VGDL, if the prompt shows them in this form.
    pub(super) vgdl: Option<&'a str>,
    pub(super) actions: Vec<Action>,
    /// The number of board columns, or 0 if there is no board.
    pub(super) columns: usize,
    /// The names in each cell, in row-major order. Within a cell, the names are ordered from bottom to top,
    /// without floors.
    pub(super) cells: Vec<Vec<&'a str>>,
    /// The names of the floors, which the board does not show.
    pub(super) floors: Vec<&'a str>,
    pub(super) tick: u32,
    /// The player's position and type, or `None` if the player is gone.
    pub(super) you: Option<You<'a>>,
    /// The player's resources, or `None` if the prompt does not list them.
    pub(super) held: Option<BTreeMap<&'a str, i32>>,
    /// The number of actions that the answer must contain.
    pub(super) due: u64,
    /// `true` if the prompt requests a plan instead of a single action.
    is_plan: bool,
    /// The numbered actions, if the answer must be a number, as in the reference style.
    numbered: Option<Vec<Action>>,
}

/// The player's position and type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct You<'a> {
    /// The player's type if the prompt states it, and otherwise the player's name in the legend.
    pub(super) name: &'a str,
    pub(super) cell: usize,
    pub(super) facing: Option<Action>,
}

/// Returns the first section of a message with the given heading; `None` if there is no such section.
fn section<'a>(message: &'a ChatMessage, heading: &str) -> Option<&'a str> {
    crate::prompt::sections(&message.text)
        .into_iter()
        .find(|(known, _)| *known == heading)
        .map(|(_, body)| body)
}

impl<'a> Shown<'a> {
    /// Parses a conversation. The first message contains the static part, and the last message that contains
    /// a turn is the current turn.
    ///
    /// # Errors
    /// Returns an error if the conversation lists no actions.
    pub(super) fn of(messages: &'a [ChatMessage]) -> Result<Shown<'a>, Unanswerable> {
        let missing = |what: &str| {
            Unanswerable(format!(
                "the prompt has no {what}; `arcade docs prompts` describes the layout of prompts"
            ))
        };
        let first = messages.first().ok_or_else(|| missing("messages"))?;
        let is_turn =
            |message: &&ChatMessage| ["Board", "Turn"].iter().any(|name| section(message, name).is_some());
        let last = messages.iter().rev().find(is_turn);
        let fixed = |heading: &str| section(first, heading);
        let turn = |heading: &str| section(last?, heading);
        let mut shown = Shown::default();

        let actions = fixed("Actions").ok_or_else(|| missing("section `Actions`"))?;
        shown.read_actions(actions);
        let rules = fixed("Rules").unwrap_or_default();
        match rules.find("BasicGame").filter(|_| rules.contains("SpriteSet")) {
            Some(start) => shown.vgdl = Some(&rules[start..]),
            None => {
                shown.rules =
                    rules.lines().chain(actions.lines()).map(|line| line.trim_start_matches("- ")).collect()
            }
        }
        let told = turn("Turn").unwrap_or_default();
        if let Some(now) = told.lines().find_map(|line| line.strip_prefix("Actions now: ")) {
            shown.actions = actions_of(now);
        }
        if shown.actions.is_empty() {
            return Err(missing("actions that can be chosen"));
        }
        if let Some(board) = turn("Board") {
            let legend = turn("Legend").or(fixed("Legend")).unwrap_or_default();
            let symbols = Symbols::of(legend);
            shown.read_board(board, &symbols, told);
            shown.floors = symbols.floors;
            shown.read_stacks(turn("Cells with several").unwrap_or_default());
        }
        let number = |text: Option<&str>| text.and_then(leading_number);
        shown.tick = number(told.strip_prefix("Tick ")).unwrap_or(0) as u32;
        let last = told.split_once(" of at most ").map(|(_, rest)| rest);
        let left = number(last).map_or(MAX_PLAN, |last| last.saturating_sub(u64::from(shown.tick)));
        let asked = fixed("Answer").and_then(|answer| answer.split_once("PLAN: followed by "));
        shown.is_plan = asked.is_some();
        shown.due = asked.map_or(1, |(_, rest)| leading_number(rest).unwrap_or(left).min(left));
        shown.due = shown.due.clamp(1, MAX_PLAN);
        shown.held = told.lines().find_map(|line| line.strip_prefix("You hold ")).map(holdings);
        Ok(shown)
    }

    /// Formats actions in the form that the conversation requires: a single action or a plan.
    pub(super) fn answer(&self, actions: &[Action]) -> String {
        let action = actions.first().copied().unwrap_or(Action::Nil);
        match &self.numbered {
            _ if self.is_plan => {
                let run = |run: &[Action]| match run.len() {
                    1 => run[0].to_string(),
                    times => format!("{} x{times}", run[0]),
                };
                let runs: Vec<String> = actions.chunk_by(|a, b| a == b).map(run).collect();
                format!("PLAN: {}", runs.join(", "))
            }
            None => format!("ACTION: {action}"),
            Some(listed) => {
                let number = listed.iter().position(|listed| *listed == action).unwrap_or_default();
                format!("```\nAction:{number}\n```")
            }
        }
    }

    /// Parses a list such as `nil, up, left`, or one line per action with its number.
    fn read_actions(&mut self, section: &str) {
        let numbered =
            |line: &str| line.split_once(": ACTION_").and_then(|(_, name)| action(&name.to_lowercase()));
        let listed: Vec<Action> = section.lines().filter_map(numbered).collect();
        self.actions = if listed.is_empty() {
            actions_of(section.lines().next().unwrap_or_default())
        } else {
            listed.clone()
        };
        self.numbered = Some(listed).filter(|listed| !listed.is_empty());
    }

    fn read_board(&mut self, board: &'a str, symbols: &Symbols<'a>, told: &'a str) {
        self.columns = board.lines().map(|line| line.chars().count()).max().unwrap_or(0);
        let you = told.lines().find_map(|line| line.strip_prefix("You are the "));
        let you = you.and_then(|line| line.split_once(" at (")).and_then(|(name, rest)| {
            let (place, facing) = rest.split_once(')')?;
            let (column, row) = place.split_once(',')?;
            let cell = row.parse::<usize>().ok()? * self.columns + column.parse::<usize>().ok()?;
            let facing = facing.strip_prefix(", facing ").and_then(|word| action(word.trim_end_matches('.')));
            Some(You { name, cell, facing })
        });
        self.you = you;
        for line in board.lines() {
            let row = self.cells.len();
            for symbol in line.chars() {
                let cell = self.cells.len();
                let own = symbol == symbols.you;
                if own && self.you.is_none() {
                    let name = symbols.names.get(&symbol).copied().unwrap_or("avatar");
                    self.you = Some(You { name, cell, facing: None });
                }
                let here = self.you.filter(|you| you.cell == cell).map(|you| you.name);
                self.cells.push(here.or(symbols.names.get(&symbol).copied()).into_iter().collect());
            }
            self.cells.resize(row + self.columns, Vec::new());
        }
        self.you = self.you.filter(|you| you.cell < self.cells.len());
    }

    /// Parses stacks of sprites, one per line, such as `frost over snow: (3,4) (5,4)`.
    fn read_stacks(&mut self, section: &'a str) {
        for line in section.lines() {
            let Some((names, places)) = line.split_once(": ") else { continue };
            let names: Vec<&str> = names.rsplit(" over ").collect();
            let places = places.split_whitespace().filter_map(|place| {
                let (column, row) = place.strip_prefix('(')?.strip_suffix(')')?.split_once(',')?;
                Some((column.parse::<usize>().ok()?, row.parse::<usize>().ok()?))
            });
            for (column, row) in places.filter(|(column, _)| *column < self.columns) {
                if let Some(cell) = self.cells.get_mut(row * self.columns + column) {
                    cell.clone_from(&names);
                }
            }
        }
    }
}

struct Symbols<'a> {
    names: BTreeMap<char, &'a str>,
    you: char,
    floors: Vec<&'a str>,
}

impl<'a> Symbols<'a> {
    /// Parses a legend with lines such as `w wall`, `@ you: bare or armed` and `. nothing or floor`, or with
    /// lines such as `wall -> 'w'` in the reference style.
    fn of(legend: &'a str) -> Symbols<'a> {
        let mut symbols = Symbols { names: BTreeMap::new(), you: AVATAR, floors: Vec::new() };
        for line in legend.lines() {
            if let Some((name, symbol)) = line.strip_suffix('\'').and_then(|line| line.split_once(" -> '")) {
                symbols.names.extend(symbol.chars().next().map(|symbol| (symbol, name)));
                continue;
            }
            let mut characters = line.chars();
            let (Some(symbol), Some(names)) = (characters.next(), characters.as_str().strip_prefix(' '))
            else {
                continue;
            };
            match names.strip_prefix("you: ") {
                _ if names.starts_with("nothing") => symbols.floors = names.split(" or ").skip(1).collect(),
                Some(states) => {
                    symbols.you = symbol;
                    symbols.names.insert(symbol, states.split(" or ").next().unwrap_or(states));
                }
                None => {
                    symbols.names.insert(symbol, names);
                }
            }
        }
        symbols
    }
}

/// Parses resources such as `2 key, 1 gem.` or `nothing.`, possibly followed by other sentences.
fn holdings(text: &str) -> BTreeMap<&str, i32> {
    let list = text.split_once('.').map_or(text, |(list, _)| list);
    let items = list.split(", ").filter_map(|item| item.split_once(' '));
    items.filter_map(|(amount, name)| Some((name, amount.parse().ok()?))).collect()
}

/// Parses the number at the start of a string; `None` if the string does not start with a number.
fn leading_number(text: &str) -> Option<u64> {
    let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    text[..end].parse().ok()
}

/// Parses a list of actions such as `nil, up, left`.
fn actions_of(list: &str) -> Vec<Action> {
    list.split(", ").filter_map(|word| action(word.trim())).collect()
}

fn action(word: &str) -> Option<Action> {
    Action::ALL.into_iter().find(|action| action.to_string() == word)
}
