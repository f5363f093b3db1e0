//! How an episode ended, and by which lines: the cause that a reason names.

use crate::board::Board;
use crate::evidence::{Evidence, Line};
use engine::analysis::{Encounter, Side};
use engine::{Action, Analysis, Episode, Game, Level, Meeting, Outcome, Watch};

/// How an episode ended.
#[derive(Clone, Debug)]
pub(crate) struct Ending {
    /// Ticks played.
    pub(crate) ticks: usize,
    outcome: Outcome,
    /// The termination that holds, as an index into the description.
    termination: Option<usize>,
    /// What ended the avatar in the last tick.
    blow: Option<Meeting>,
    /// The board before the last tick.
    before: Option<Board>,
    /// The last action.
    action: Option<Action>,
}

/// Listens for what happens to avatars.
struct Ear<'a> {
    analysis: &'a Analysis,
    blow: Option<Meeting>,
}

impl Watch for Ear<'_> {
    fn interaction(&mut self, _: usize) {}

    fn wants_meetings(&self) -> bool {
        true
    }

    fn meeting(&mut self, meeting: Meeting) {
        let avatars = self.analysis.avatars();
        let is_avatar = |stype| avatars.iter().any(|avatar| avatar.stype == stype);
        let ends = |side: Side| {
            let of_line = |encounter: &&Encounter| encounter.line == meeting.line;
            self.analysis.encounters().iter().filter(of_line).any(|encounter| encounter.ends(side))
        };
        let first = is_avatar(meeting.first) && ends(Side::First);
        let second = meeting.second.is_some_and(|second| is_avatar(second) && ends(Side::Second));
        if first || second {
            self.blow = Some(meeting);
        }
    }
}

impl Ending {
    /// Plays an episode again, and listens to its last tick. Cost: that of the episode.
    pub(crate) fn of(analysis: &Analysis, level: &Level, episode: &Episode) -> Ending {
        let game = analysis.game();
        let mut state = game.start(level, episode.seed);
        let mut before = None;
        let mut ear = Ear { analysis, blow: None };
        if let Some((&last, rest)) = episode.actions.split_last() {
            for &action in rest {
                game.step(&mut state, action);
            }
            before = Some(Board::of(game, &state));
            game.step_watched(&mut state, last, &mut ear);
        }
        Ending {
            ticks: episode.actions.len(),
            outcome: state.outcome(),
            termination: game.ended_by(&state),
            blow: ear.blow,
            before,
            action: episode.actions.last().copied(),
        }
    }

    /// What happened in the last tick, a sentence for each line that had a part in it.
    pub(crate) fn evidence(&self, game: &Game) -> Vec<Evidence> {
        let mut list = Vec::new();
        let lost = self.outcome == Outcome::Lost;
        if let (true, Some(Meeting { line, first, second, cell })) = (lost, self.blow) {
            let partner = second.map_or("the edge of the screen", |second| game.name(second));
            let text = format!("{} meets {partner} and is lost", game.name(first));
            list.push(Evidence {
                text,
                tick: Some(self.ticks),
                cell: placed(cell),
                rule: Some(Line::interaction(game, line)),
                ..Evidence::default()
            });
        }
        if let Some(line) = self.termination {
            let word = if lost { "lost" } else { "won" };
            let text = format!("the game is {word} by its rule on when it ends");
            let rule = Some(Line::termination(game, line));
            list.push(Evidence { text, tick: Some(self.ticks), rule, ..Evidence::default() });
        }
        if let (Some(first), Some(board)) = (list.first_mut(), &self.before) {
            first.board = Some(board.clone());
            if let Some(action) = self.action.filter(|action| *action != Action::Nil) {
                first.text.push_str(&format!(" (the key was {action})"));
            }
        }
        list
    }
}

/// Counted from 1, as people count.
fn placed((column, row): (i32, i32)) -> Option<(usize, usize)> {
    Some((usize::try_from(column).ok()? + 1, usize::try_from(row).ok()? + 1))
}
