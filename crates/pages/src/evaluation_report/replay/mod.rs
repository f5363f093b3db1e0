//! Step-by-step replays of selected episodes. Each board is shown with its prompts and answers.

mod frames;
mod talk;

use super::Results;
use crate::PageError;
use crate::page::{Figure, words};
use engine::{Action, Outcome, State};
use evaluation::log::Event;
use evaluation::metrics::{Ending, EndingKind, EpisodeMetrics};
use evaluation::run::Task;
use evaluation::study::StudyEpisode;
use evaluation::{Evaluation, Validity};
use frames::{Boards, Tiles};
use itertools::Itertools;
use render::{Looks, RenderError, Style, picture};
use serde::Serialize;
use std::collections::BTreeMap;
use talk::{Talk, talks};

/// The number of decisions shown at the start of a long episode.
const FIRST: usize = 200;
/// The number of decisions shown at the end of a long episode.
const LAST: usize = 100;
/// The cell size of animated boards, in pixels.
const CELL: u32 = 20;
/// The length of the longer side of still boards, in pixels.
const STILL: u32 = 220;
/// The number of still boards per episode, including the start and the end.
const STILLS: usize = 4;

#[derive(Serialize)]
pub(super) struct Replays {
    /// The tiles of the boards, as SVG groups.
    symbols: String,
    players: Vec<PlayerReplays>,
    note: String,
}

#[derive(Serialize)]
struct PlayerReplays {
    name: String,
    episodes: Vec<Replay>,
}

#[derive(Serialize)]
struct Replay {
    /// The replay's title, with the game, level and run.
    title: String,
    result: String,
    /// `true` if the episode was won.
    won: bool,
    size: [u32; 2],
    /// The data for the page's script: the tiles, the changes from board to board, and the text below each
    /// board.
    data: String,
    stills: Vec<Figure>,
    /// The episode's actions, with repeated actions counted.
    actions: String,
    /// The prompt that the player received before its first decision.
    told: Vec<String>,
    /// The messages of each decision, or an empty list for players without messages.
    decisions: Vec<Decision>,
    /// The number of decisions omitted from the middle of the episode.
    skipped: usize,
}

#[derive(Serialize)]
struct Decision {
    /// The board on which the player based the decision, as an index into the boards shown.
    at: usize,
    /// The index of the decision's first step.
    step: usize,
    action: String,
    /// A phrase stating the problem with the choice. Empty if there is no problem.
    validity: &'static str,
    talk: Talk,
}

/// The data read by the page's script.
#[derive(Serialize)]
struct Data<'a> {
    cell: u32,
    prefix: &'a str,
    changes: &'a [String],
    captions: &'a [String],
}

/// An episode that the page may replay.
struct Candidate<'a> {
    evaluation: &'a Evaluation,
    task: Task<'a>,
    ending: Option<Ending>,
}

impl Replays {
    /// Returns up to `results.replays` episodes per player. Failures come first, with one episode per cause. If the
    /// replays would exceed `room` bytes, models take precedence. Cost: O(steps) per episode, for playing and
    /// drawing.
    pub(super) fn of(results: &Results<'_>, room: usize) -> Result<Replays, PageError> {
        let (players, mut left_out) = (candidates(results), 0);
        let mut tiles: BTreeMap<String, Tiles> = BTreeMap::new();
        let mut shown: Vec<Vec<Replay>> = players.iter().map(|_| Vec::new()).collect();
        let most = players.iter().map(|player| player.1.len()).max().unwrap_or(0);
        let mut bytes = 0;
        for at in 0..most {
            for ((_, candidates), shown) in players.iter().zip(&mut shown) {
                let Some(candidate) = candidates.get(at) else { continue };
                if bytes >= room {
                    left_out += 1;
                    continue;
                }
                let count = tiles.len();
                let digest = candidate.task.subject.game.digest().to_string();
                let tiles = tiles.entry(digest).or_insert_with(|| Tiles::new(format!("t{count}-")));
                if let Some(replay) = Replay::of(candidate, tiles)? {
                    bytes += replay.bytes();
                    shown.push(replay);
                }
            }
        }
        let symbols = tiles.values().map(Tiles::symbols).collect();
        let names = players.into_iter().map(|(name, _)| name).zip(shown);
        let players: Vec<PlayerReplays> = names
            .map(|(name, episodes)| PlayerReplays { name, episodes })
            .filter(|player| !player.episodes.is_empty())
            .collect();
        Ok(Replays { symbols, players, note: note(results.replays, left_out) })
    }

    /// Returns `true` if there is at least one replay.
    pub(super) fn is_some(&self) -> bool {
        !self.players.is_empty()
    }
}

fn note(episodes: usize, left_out: u64) -> String {
    let mut note = format!(
        "Up to {} of each player: first episodes that were not won, one for each cause, starting \
         with the most frequent cause of each kind and choosing the episode closest to a win. All other \
         episodes are in the logs. For episodes with more than {} decisions, only the first {FIRST} and \
         the last {LAST} decisions are shown.",
        words::many(episodes as u64, "episode"),
        FIRST + LAST
    );
    if left_out > 0 {
        note += &format!(" {} left out for lack of space.", words::many(left_out, "more episode"));
    }
    note
}

/// Returns the episodes to replay for each player, models first.
fn candidates<'a>(results: &Results<'a>) -> Vec<(String, Vec<Candidate<'a>>)> {
    let Results { study, evaluations, replays } = *results;
    let order = study.leaderboard.iter().map(|row| row.player);
    let order = order.sorted_by_key(|&player| study.players[player].is_reference());
    let of_player = |player: usize| {
        let chosen = study.telling(player, replays);
        let found = chosen.into_iter().filter_map(|episode| found(evaluations, episode));
        (study.players[player].label(), found.collect())
    };
    order.map(of_player).collect()
}

/// Finds the evaluation and the task for an episode in a study; `None` if the evaluations do not contain the episode.
fn found<'a>(evaluations: &'a [Evaluation], episode: &StudyEpisode) -> Option<Candidate<'a>> {
    let EpisodeMetrics { folder, game, level, run, ending, .. } = &episode.metrics;
    let evaluation = evaluations.get((*folder)?)?;
    let is_it = |task: &Task<'_>| task.subject.id == *game && task.level.number == *level && task.run == *run;
    let task = evaluation.tasks().into_iter().find(is_it)?;
    Some(Candidate { evaluation, task, ending: ending.clone() })
}

impl Replay {
    /// Replays an episode and draws its boards. Returns `None` if nothing was played.
    fn of(
        Candidate { evaluation, task, ending }: &Candidate<'_>,
        tiles: &mut Tiles,
    ) -> Result<Option<Replay>, PageError> {
        let log = evaluation.events(task)?;
        let steps: Vec<(Action, Validity)> = log
            .iter()
            .filter_map(|event| match event {
                Event::Step { action, validity, .. } => Some((*action, *validity)),
                _ => None,
            })
            .collect();
        if steps.is_empty() {
            return Ok(None);
        }
        let shown = |decision: &usize| *decision < FIRST || decision + LAST >= steps.len();
        let (game, looks) = (&task.subject.game, Looks::of(&task.subject.analysis));
        let mut state = game.start(&task.level.level, task.chance());
        let (mut boards, mut captions, mut stills) = (Boards::new(CELL), Vec::new(), Vec::new());
        let mut size = [0, 0];
        let mut show = |state: &State, caption: String, still: Option<&'static str>| {
            let drawn = picture(&looks, state, &Style::bare(CELL)).map_err(failed)?;
            size = [drawn.width(), drawn.height()];
            boards.push(&drawn, tiles);
            if let Some(head) = still {
                stills.push(figure(&looks, state, head, captions.len())?);
            }
            captions.push(caption);
            Ok::<(), PageError>(())
        };
        for (decision, (action, validity)) in steps.iter().enumerate() {
            if shown(&decision) {
                let note = told(*validity);
                let note = if note.is_empty() { String::new() } else { format!(" ({note})") };
                let caption =
                    format!("step {decision}, score {}: {action}{note}", words::short(state.score()));
                show(&state, caption, still(decision, steps.len()))?;
            }
            game.step(&mut state, *action);
        }
        let result = result(&log, &state, steps.len(), task.max_steps) + &because(ending.as_ref());
        show(&state, format!("the end: {result}"), Some("the end"))?;
        let data = Data { cell: CELL, prefix: &tiles.prefix, changes: &boards.changes, captions: &captions };
        let data = serde_json::to_string(&data).map_err(PageError::failed("a replay"))?;
        let mut spoken = talks(&log);
        let told_first = spoken.first_mut().map(|first| std::mem::take(&mut first.shown)).unwrap_or_default();
        let words = spoken.iter().any(|talk| !talk.answers.is_empty());
        let decisions: Vec<Decision> = steps
            .iter()
            .zip(spoken)
            .enumerate()
            .filter(|(step, _)| words && shown(step))
            .enumerate()
            .map(|(at, (step, ((action, validity), talk)))| Decision {
                at,
                step,
                action: action.to_string(),
                validity: told(*validity),
                talk,
            })
            .collect();
        let title = &task.subject.facts.title;
        Ok(Some(Replay {
            title: format!("{title}, level {}, run {}", task.level.number, task.run),
            won: state.outcome() == Outcome::Won,
            result,
            size,
            data,
            stills,
            actions: counted(&steps),
            told: told_first,
            decisions,
            skipped: steps.len().saturating_sub(FIRST + LAST),
        }))
    }

    /// Returns the approximate size of the replay in the page, in bytes.
    fn bytes(&self) -> usize {
        let talk = |talk: &Talk| {
            let answers = talk.answers.iter();
            let answers = answers
                .map(|answer| answer.text.len() + answer.reasoning.as_ref().map_or(0, String::len) + 120);
            answers.sum::<usize>() + talk.shown.iter().map(String::len).sum::<usize>()
        };
        let stills: usize = self.stills.iter().map(Figure::bytes).sum();
        let told: usize = self.told.iter().map(String::len).sum();
        let words: usize = self.decisions.iter().map(|decision| talk(&decision.talk) + 200).sum();
        self.data.len() + stills + told + words + self.actions.len()
    }
}

/// Returns the heading of the still board before the given decision, if the page shows such a board.
fn still(decision: usize, steps: usize) -> Option<&'static str> {
    if decision == 0 {
        return Some("the start");
    }
    let between = (1..STILLS - 1).any(|part| decision == steps * part / (STILLS - 1));
    between.then_some("")
}

fn figure(looks: &Looks, state: &State, head: &'static str, at: usize) -> Result<Figure, PageError> {
    let (columns, rows) = state.size();
    let cell = (STILL / columns.max(rows).max(1).cast_unsigned()).clamp(4, 24);
    let drawn = picture(looks, state, &Style::bare(cell)).map_err(failed)?;
    let head = if head.is_empty() { format!("step {at}") } else { head.to_owned() };
    Figure::of(&drawn, head).map_err(failed)
}

fn failed(error: RenderError) -> PageError {
    PageError::failed("the boards of a replay")(error)
}

/// Returns an episode's result, such as `won in 34 steps, score 5`.
fn result(log: &[Event], state: &State, steps: usize, max_steps: u64) -> String {
    let how = match state.outcome() {
        Outcome::Won => "won in",
        Outcome::Lost => "lost after",
        Outcome::Ended => "over without a winner after",
        Outcome::Stopped(_) => "stopped by the engine after",
        Outcome::Ongoing if steps as u64 >= max_steps => "not over at the limit of",
        Outcome::Ongoing if matches!(log.last(), Some(Event::Halt { .. })) => "aborted after",
        Outcome::Ongoing => "interrupted after",
    };
    format!("{how} {}, score {}", words::many(steps as u64, "step"), words::short(state.score()))
}

/// Returns an ending's cause, such as `: died of touching dragonfly; 2 of 5 gem left`.
fn because(ending: Option<&Ending>) -> String {
    ending.map_or(String::new(), |ending| {
        let distance = ending.distance.as_ref().map_or(String::new(), |left| format!("; {}", left.words()));
        match ending.kind {
            EndingKind::StepLimit | EndingKind::NoWinner | EndingKind::Otherwise => distance,
            _ => format!(": {}{distance}", ending.words()),
        }
    })
}

/// Returns a phrase stating the problem with a choice, or an empty text if there is no problem.
fn told(validity: Validity) -> &'static str {
    match validity {
        Validity::Valid => "",
        Validity::Invalid => "invalid answers",
        Validity::Refused => "refused",
        Validity::Truncated => "cut off",
    }
}

/// Returns a summary of actions, such as `right ×3, use, nil ×2`.
fn counted(steps: &[(Action, Validity)]) -> String {
    let runs = steps.chunk_by(|one, other| one.0 == other.0);
    let said = |run: &[(Action, Validity)]| match run.len() {
        1 => run[0].0.to_string(),
        many => format!("{} ×{many}", run[0].0),
    };
    runs.map(said).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_actions_are_counted() {
        let steps = [Action::Up, Action::Up, Action::Use, Action::Nil, Action::Nil, Action::Nil];
        assert_eq!(counted(&steps.map(|action| (action, Validity::Valid))), "up ×2, use, nil ×3");
    }

    #[test]
    fn the_note_counts_episodes() {
        assert!(note(4, 0).starts_with("Up to 4 episodes of each player: "));
        assert!(note(1, 2).starts_with("Up to 1 episode of each player: "));
        assert!(note(1, 2).ends_with(" 2 more episodes left out for lack of space."));
    }

    #[test]
    fn still_boards_are_spread() {
        let found: Vec<usize> = (0..90).filter(|&at| still(at, 90).is_some()).collect();
        assert_eq!(found, [0, 30, 60]);
        assert_eq!((0..1).filter(|&at| still(at, 1).is_some()).count(), 1);
    }
}
