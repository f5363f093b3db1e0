//! Reads games and explorations from answers, and reports the problems in unusable answers.

use super::recording::Recording;
use super::task::WorldModelTask;
use crate::player::mailbox::MAX_ANSWER;
use engine::{Action, Diagnostic, Diagnostics, Game, line_and_column};
use itertools::Itertools;

/// The maximum number of problems that are reported to the examined player at once.
const MAX_TOLD: usize = 20;

/// The content of an answer.
#[derive(Debug)]
pub(super) enum Answer {
    /// A usable game.
    Game(Game),
    /// The recording of the actions that the examined player chose. It is never empty.
    Played(Recording),
    /// The problems in an unusable answer, one per line.
    Unusable(String),
}

/// Shortens an answer to slightly more than the limit for answers, so that a huge answer is neither logged nor repeated.
pub(super) fn shorten(answer: &mut String) {
    let longest = answer.len().min(MAX_ANSWER + 8);
    let end = (0..=longest).rev().find(|&at| answer.is_char_boundary(at));
    answer.truncate(end.unwrap_or_default());
}

/// Reads an answer: a game, or at most `left` actions that explore the game.
pub(super) fn read(task: &WorldModelTask, answer: &str, left: usize) -> Answer {
    if answer.len() > MAX_ANSWER {
        return Answer::Unusable(format!(
            "The answer is longer than the limit of {} KiB.",
            MAX_ANSWER / 1024
        ));
    }
    let read = match (source(answer), answer.lines().rev().find_map(|line| line.trim().strip_prefix("PLAY ")))
    {
        (Some(source), _) => game(task, &source).map(Answer::Game),
        (None, Some(_)) if left == 0 => Err("There are no actions left; write the game.".to_owned()),
        (None, Some(line)) => played(task, line, left).map(Answer::Played),
        (None, None) => Err("The answer contains no line that begins with `BasicGame`.".to_owned()),
    };
    read.unwrap_or_else(Answer::Unusable)
}

/// Returns the text from the last line that begins with `BasicGame` to the end of its fenced block; `None` if no line
/// begins with `BasicGame`.
fn source(answer: &str) -> Option<String> {
    let lines: Vec<&str> = answer.lines().collect();
    let first = lines.iter().rposition(|line| line.trim_start().starts_with("BasicGame"))?;
    let game = lines[first..].iter().take_while(|line| !line.trim_start().starts_with("```"));
    Some(game.map(|line| format!("{line}\n")).collect())
}

/// Compiles a game, and checks that it accepts the levels.
fn game(task: &WorldModelTask, source: &str) -> Result<Game, String> {
    let game = Game::from_source(source).map_err(|problems| told(source, &problems))?;
    for masked in &task.masked.levels {
        if let Err(problems) = game.level(&masked.text) {
            return Err(format!("Level {}:\n{}", masked.number, told(&masked.text, &problems)));
        }
    }
    Ok(game)
}

/// Plays the actions of a line such as `0: right right up` from the start of a level.
fn played(task: &WorldModelTask, line: &str, left: usize) -> Result<Recording, String> {
    let (number, words) = line.split_once(':').ok_or("The line that begins with PLAY has no colon.")?;
    let level = task.masked.levels.iter().position(|level| level.number.to_string() == number.trim());
    let level = level.ok_or_else(|| format!("There is no level `{}`.", number.trim()))?;
    let action = |word: &str| {
        let found = Action::ALL.into_iter().find(|action| action.name().eq_ignore_ascii_case(word));
        found.ok_or_else(|| {
            format!("`{word}` is not an action; the actions are {}.", Action::ALL.iter().join(", "))
        })
    };
    let words = words.split([' ', ',']).filter(|word| !word.is_empty());
    let actions: Vec<Action> = words.take(left).map(action).collect::<Result<_, _>>()?;
    let recording = Recording::of_actions(task, level, &actions);
    match recording.actions.is_empty() {
        true => Err("The line that begins with PLAY contains no action that could be played.".to_owned()),
        false => Ok(recording),
    }
}

fn told(source: &str, problems: &Diagnostics) -> String {
    let line = |problem: &Diagnostic| {
        let (line, column) = line_and_column(source, problem.span.start);
        let help = problem.help.as_ref().map_or(String::new(), |help| format!(" ({help})"));
        format!("line {line}, column {column}: {}{help}", problem.message)
    };
    let more = problems.0.len().saturating_sub(MAX_TOLD);
    let rest = (more > 0).then(|| format!("… and {more} more"));
    problems.0.iter().take(MAX_TOLD).map(line).chain(rest).join("\n")
}
