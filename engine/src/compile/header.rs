//! The first line of a game: settings for the whole game (`spec/01` §1.5).

use super::params::{Expected, Value, convert, wrong_type};
use crate::diagnostic::Diagnostic;
use crate::limits::{MAX_COUNTERS, MAX_SQUARE};
use crate::meanings::Place;
use crate::syntax::{Description, Param, Word};

const KEYS: [&str; 5] = ["square_size", "key_handler", "no_players", "no_counters", "obs"];

/// The settings in the first line.
#[derive(Debug, Default)]
pub(super) struct Header {
    /// The cell size in pixels; `None` if the game does not set it.
    pub(super) square_size: Option<i32>,
    pub(super) counters: usize,
    /// The sprite types that paths avoid, or `None` if the game does not use path finding.
    pub(super) obstacles: Option<Vec<Word>>,
}

impl Header {
    pub(super) fn of(description: &Description, problems: &mut Vec<Diagnostic>) -> Header {
        let mut header = Header::default();
        for param in &description.header.params {
            let key = param.key.text.as_str();
            let value = convert(key, &param.value.text);
            match (key, value) {
                ("square_size", Value::Int(-1)) => header.square_size = None,
                ("square_size", Value::Int(size @ 1..=MAX_SQUARE)) => header.square_size = Some(size),
                ("square_size", Value::Int(_)) => {
                    let message =
                        format!("`square_size` must be a number of pixels between 1 and {MAX_SQUARE}");
                    problems.push(unsupported(param, message));
                }
                ("no_counters", Value::Int(count @ 0..=MAX_COUNTERS)) => header.counters = count as usize,
                ("no_counters", Value::Int(_)) => {
                    let message = format!("`no_counters` must be a number between 0 and {MAX_COUNTERS}");
                    problems.push(unsupported(param, message));
                }
                ("no_players", Value::Int(1)) => {}
                ("no_players", Value::Int(players)) if players > 1 => {
                    let message = format!(
                        "games for several players are not supported, but this game is for {players}"
                    );
                    let help = "make it a single-player game: remove `no_players`, and all avatars but one";
                    problems.push(unsupported(param, message).help(help));
                }
                ("no_players", Value::Int(_)) => {
                    let message = "`no_players` is the number of players, and can only be 1";
                    problems.push(unsupported(param, message.to_owned()));
                }
                ("square_size" | "no_counters" | "no_players", _) => {
                    problems.push(wrong_type(param, Expected::Int));
                }
                ("obs", Value::Text(names)) => header.obstacles = Some(listed(param, names)),
                ("key_handler", Value::Text(_)) => {}
                ("obs" | "key_handler", _) => problems.push(wrong_type(param, Expected::Text)),
                (key, _) => {
                    let message = format!("a game has no parameter `{key}`");
                    let problem = Diagnostic::error("unknown-parameter", param.key.span, message);
                    problems.push(problem.mean(Place::GameParameter, key, KEYS).or_remove(param.span(), key));
                }
            }
        }
        header
    }

    /// Returns the number of messages that the reference logs about unknown parameters. There are two
    /// messages per parameter.
    pub(super) fn messages(description: &Description) -> u32 {
        let mut unknown: Vec<&str> =
            description.header.params.iter().map(|param| param.key.text.as_str()).collect();
        unknown.sort_unstable();
        unknown.dedup();
        unknown.retain(|key| !KEYS.contains(key));
        2 * unknown.len() as u32
    }
}

/// Returns the diagnostic for a feature that neither policy supports.
fn unsupported(param: &Param, message: String) -> Diagnostic {
    let problem = Diagnostic::error("unsupported", param.span(), message);
    problem.help(format!("remove `{}`", param.key.text)).remove(param.span(), &param.key.text)
}

fn listed(param: &Param, names: &str) -> Vec<Word> {
    let names = names.trim_end_matches(',').split(',');
    names.map(|name| Word { text: name.to_owned(), span: param.value.span }).collect()
}
