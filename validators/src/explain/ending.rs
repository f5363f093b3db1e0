//! The ending of an episode and the lines that caused it, to explain verdicts.

use crate::evidence::{Evidence, Line};
use crate::explain::board::Board;
use crate::measures::level::MeetingRecorder;
use engine::analysis::{Encounter, Side};
use engine::{Action, Analysis, Episode, Game, Level, Meeting, Outcome, SpriteType};

/// An episode's ending.
#[derive(Clone, Debug)]
pub(crate) struct Ending {
    /// The number of ticks played.
    pub(crate) ticks: usize,
    outcome: Outcome,
    /// The termination that holds, as an index into the description's terminations.
    termination: Option<usize>,
    /// The last tick's interaction that caused the ending, by removing the avatar or the sprite that had to
    /// be removed.
    cause: Option<Meeting>,
    /// The board before the last tick.
    before: Option<Board>,
    /// The episode's last action.
    action: Option<Action>,
}

impl Ending {
    /// Replays an episode and records its last tick. Costs one replay of the episode.
    pub(crate) fn of(analysis: &Analysis, level: &Level, episode: &Episode) -> Ending {
        let game = analysis.game();
        let mut state = game.start(level, episode.seed);
        let mut before = None;
        let mut recorder = MeetingRecorder::new(game);
        if let Some((&last, rest)) = episode.actions.split_last() {
            for &action in rest {
                game.step(&mut state, action);
            }
            before = Some(Board::of(game, &state));
            game.step_watched(&mut state, last, &mut recorder);
        }
        let termination = game.ended_by(&state);
        let avatars = || analysis.avatars().iter().map(|avatar| avatar.stype).collect();
        let counted = |line| {
            let goal = analysis.goals().iter().find(|goal| goal.line == line);
            goal.map_or(Vec::new(), |goal| goal.condition.types().to_vec())
        };
        let ended: Vec<SpriteType> = match state.outcome() {
            Outcome::Lost => avatars(),
            Outcome::Won => termination.map_or(Vec::new(), counted),
            _ => Vec::new(),
        };
        Ending {
            ticks: episode.actions.len(),
            outcome: state.outcome(),
            termination,
            cause: recorder.meetings.into_iter().rev().find(|meeting| ends(analysis, meeting, &ended)),
            before,
            action: episode.actions.last().copied(),
        }
    }

    /// Returns the last tick's events, as one sentence per line involved.
    pub(crate) fn evidence(&self, game: &Game) -> Vec<Evidence> {
        let mut list = Vec::new();
        let key = self.action.filter(|action| *action != Action::Nil);
        let key = key.map_or(String::new(), |action| format!(" (the key was {action})"));
        let word = if self.outcome == Outcome::Won { "won" } else { "lost" };
        if let Some(Meeting { line, first, second, cell }) = self.cause {
            let (first, partner) = (game.name(first), second.map(|second| game.name(second)));
            let text = format!("{first} meets {}{key}", partner.unwrap_or("the edge of the screen"));
            let rule = Some(Line::interaction(game, line));
            list.push(Evidence { text, cell: placed(cell), rule, ..Evidence::default() });
        }
        if let Some(line) = self.termination {
            let text = format!("then the game is {word}");
            let text = if list.is_empty() { format!("the game is {word} by this line{key}") } else { text };
            let rule = Some(Line::termination(game, line));
            list.push(Evidence { text, rule, ..Evidence::default() });
        }
        list.iter_mut().for_each(|seen| seen.tick = Some(self.ticks));
        if let (Some(first), Some(board)) = (list.first_mut(), &self.before) {
            first.board = Some(board.clone());
        }
        list
    }
}

/// Returns `true` if an interaction may have removed a sprite whose type is in `types`, on either side.
fn ends(analysis: &Analysis, meeting: &Meeting, types: &[SpriteType]) -> bool {
    let of_line = |encounter: &&Encounter| encounter.line == meeting.line;
    let ends =
        |side: Side| analysis.encounters().iter().filter(of_line).any(|encounter| encounter.ends(side));
    let first = types.contains(&meeting.first) && ends(Side::First);
    first || meeting.second.is_some_and(|second| types.contains(&second)) && ends(Side::Second)
}

/// Converts a cell's coordinates to a column and row counted from 1.
fn placed((column, row): (i32, i32)) -> Option<(usize, usize)> {
    Some((usize::try_from(column).ok()? + 1, usize::try_from(row).ok()? + 1))
}
