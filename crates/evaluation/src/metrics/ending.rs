//! The ending of an episode without a win: its cause, and its distance from a win.

use crate::run::Task;
use crate::subject::Subject;
use engine::analysis::{Condition, EffectSummary, Goal};
use engine::syntax::Param;
use engine::{Action, Limit, Meeting, Outcome, Removal, Span, SpriteType, State, Watch};
use itertools::Itertools;
use serde::Serialize;

base::named_enum! {
    /// The kind of ending of an episode without a win.
    pub enum EndingKind {
        /// The avatar was removed, or turned into a different type.
        Died = "died",
        /// The game was lost because a required sprite other than the avatar was removed.
        Lost = "lost_sprite",
        /// The game was lost because a sprite of a certain type appeared, which the rules forbid.
        Appeared = "sprite_appeared",
        /// The time limit of the game was reached.
        OutOfTime = "out_of_time",
        /// The game was lost for a different or an unknown reason.
        Otherwise = "lost_otherwise",
        /// The episode reached its step limit.
        StepLimit = "step_limit",
        /// The game ended without a winner.
        NoWinner = "no_winner",
        /// The engine stopped the episode, because of the game's rules or an engine limit.
        Stopped = "stopped",
    }
}

impl EndingKind {
    /// Returns the ending's name for use in headings.
    pub fn title(self) -> &'static str {
        match self {
            EndingKind::Died => "died",
            EndingKind::Lost => "lost a sprite",
            EndingKind::Appeared => "sprite appeared",
            EndingKind::OutOfTime => "out of time",
            EndingKind::Otherwise => "lost otherwise",
            EndingKind::StepLimit => "limit of steps",
            EndingKind::NoWinner => "no winner",
            EndingKind::Stopped => "stopped by the engine",
        }
    }
}

/// The ending of an episode without a win.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Ending {
    /// The kind of ending.
    pub kind: EndingKind,
    /// The sprite type whose removal or appearance lost the game, if any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sprite: Option<String>,
    /// The other sprite type (or `EOS`) in the interaction that last removed or created the sprite. `None` if
    /// no interaction removed or created the sprite.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by: Option<String>,
    /// The line in the game description that caused the ending, as written: the interaction if known, and
    /// otherwise the termination.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rule: Option<String>,
    /// The reason why the engine stopped the episode, if it did.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stop: Option<Limit>,
    /// The distance from a win in the last state, or `None` if no winning termination counts anything.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance: Option<GoalDistance>,
}

/// The name for the screen edge in interactions.
const EDGE: &str = "EOS";

/// The name for ticks as a counted quantity.
const TICKS: &str = "ticks";

/// The distance from satisfying a winning termination. If there are several, the nearest one counts.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct GoalDistance {
    /// The names of the counted sprite types, as in the termination, or `ticks`.
    pub counted: String,
    /// The number of sprites left to remove or to create, or the number of ticks left to survive.
    pub left: u32,
    /// The value of `left` in the first state of the episode.
    pub of: u32,
}

impl GoalDistance {
    /// Returns the fraction of the initial distance that remains.
    pub fn fraction(&self) -> f64 {
        f64::from(self.left) / f64::from(self.of.max(1))
    }

    /// Formats the distance, as in `2 of 5 gem left`.
    pub fn words(&self) -> String {
        let GoalDistance { counted, left, of } = self;
        let to_survive = if counted == TICKS { " to survive" } else { "" };
        let of = if left > of { String::new() } else { format!("of {of} ") };
        format!("{left} {of}{counted} left{to_survive}")
    }
}

impl Ending {
    /// Formats the ending with its cause, as in `died of touching dragonfly`.
    pub fn words(&self) -> String {
        let particulars = self.particulars().unwrap_or_default();
        match self.kind {
            EndingKind::Died => format!("died {particulars}").trim_end().to_owned(),
            EndingKind::Lost => format!("lost {particulars}"),
            EndingKind::Appeared => format!("lost when {particulars} appeared"),
            EndingKind::OutOfTime => "ran out of time".to_owned(),
            EndingKind::Otherwise => "lost by the rules".to_owned(),
            EndingKind::StepLimit => "reached the limit of steps".to_owned(),
            EndingKind::NoWinner => "ended without a winner".to_owned(),
            EndingKind::Stopped => format!("was stopped by the engine: {particulars}"),
        }
    }

    /// Formats the sprites that caused the ending, as text to append to its kind, such as `of touching
    /// dragonfly`, `flower to arrow` or `weed`. Returns `None` if the sprites are unknown, or if no sprites
    /// cause this kind of ending.
    pub fn particulars(&self) -> Option<String> {
        let sprite = || self.sprite.as_deref().unwrap_or("a sprite");
        match (self.kind, &self.by) {
            (EndingKind::Stopped, _) => self.stop.map(|limit| limit.to_string()),
            (EndingKind::Died, Some(by)) if by == EDGE => Some("at the edge of the screen".to_owned()),
            (EndingKind::Died, Some(by)) => Some(format!("of touching {by}")),
            (EndingKind::Lost, Some(by)) => Some(format!("{} to {by}", sprite())),
            (EndingKind::Lost, None) | (EndingKind::Appeared, _) => Some(sprite().to_owned()),
            (EndingKind::Died, None)
            | (
                EndingKind::OutOfTime | EndingKind::Otherwise | EndingKind::StepLimit | EndingKind::NoWinner,
                _,
            ) => None,
        }
    }

    /// Returns the ending of an episode of which only the outcome is known, or `None` for a win.
    pub(crate) fn unknown(outcome: Outcome) -> Option<Ending> {
        let kind = match outcome {
            Outcome::Won => return None,
            Outcome::Ongoing => EndingKind::StepLimit,
            Outcome::Ended => EndingKind::NoWinner,
            Outcome::Stopped(_) => EndingKind::Stopped,
            Outcome::Lost => EndingKind::Otherwise,
        };
        let stop = match outcome {
            Outcome::Stopped(limit) => Some(limit),
            _ => None,
        };
        Some(Ending { kind, sprite: None, by: None, rule: None, stop, distance: None })
    }

    /// Derives the ending from the first state, the last state and the last tick's interactions. Returns
    /// `None` for a win.
    pub(super) fn of(subject: &Subject, first: &State, last: &State, tick: LastTick) -> Option<Ending> {
        if last.outcome() == Outcome::Lost {
            return Some(lost(subject, first, last, &tick));
        }
        let ending = Ending::unknown(last.outcome())?;
        Some(Ending { distance: distance(subject, first, last), ..ending })
    }
}

/// The lines of a game description that ended an episode.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EndCause {
    /// The termination that won or lost the game, as an index into the description's terminations.
    pub termination: Option<usize>,
    /// For a lost game, the interaction that removed the required sprite in the last tick, as an index into the
    /// description's interactions.
    pub interaction: Option<usize>,
}

impl EndCause {
    /// Finds the lines that ended an episode by replaying its actions. Cost: one forward-model call per action.
    pub(crate) fn replayed(task: &Task<'_>, actions: &[Action]) -> EndCause {
        let (subject, game) = (task.subject, &task.subject.game);
        let mut state = game.start(&task.level.level, task.chance());
        let mut tick = LastTick::default();
        for (at, &action) in actions.iter().enumerate() {
            match at + 1 == actions.len() {
                true => game.step_watched(&mut state, action, &mut tick),
                false => game.step(&mut state, action),
            };
        }
        let termination = game.ended_by(&state);
        let goals = subject.analysis.goals();
        let lost =
            goals.iter().find(|goal| Some(goal.line) == termination && state.outcome() == Outcome::Lost);
        let removes = |goal: &&Goal| match goal.condition {
            Condition::Tick(_) | Condition::AtLeast(..) => false,
            Condition::Exactly(_, limit) => limit == 0,
            _ => true,
        };
        let cause = lost.filter(removes).and_then(|goal| culprit(subject, &tick, goal.condition.types()));
        EndCause { termination, interaction: cause.map(|(line, ..)| line) }
    }
}

/// The interactions in an episode's last tick.
#[derive(Default)]
pub(super) struct LastTick {
    meetings: Vec<Meeting>,
    removals: Vec<Removal>,
}

impl Watch for LastTick {
    fn interaction(&mut self, _: usize) {}

    fn wants_meetings(&self) -> bool {
        true
    }

    fn meeting(&mut self, meeting: Meeting) {
        self.meetings.push(meeting);
    }

    fn wants_removals(&self) -> bool {
        true
    }

    fn removal(&mut self, removal: Removal) {
        self.removals.push(removal);
    }
}

/// Returns the ending of a lost game.
fn lost(subject: &Subject, first: &State, last: &State, tick: &LastTick) -> Ending {
    let (game, analysis) = (&subject.game, &subject.analysis);
    let distance = distance(subject, first, last);
    let line = game.ended_by(last);
    let rule = line.and_then(|line| {
        Some(written(&subject.source, game.description().terminations.get(line)?.class.span))
    });
    let ending = |kind| Ending {
        kind,
        sprite: None,
        by: None,
        rule: rule.clone(),
        stop: None,
        distance: distance.clone(),
    };
    let Some(goal) = analysis.goals().iter().find(|goal| Some(goal.line) == line) else {
        // The reference engine's time limit does not appear as a line in the game.
        let late = line.is_none() && u64::try_from(last.tick()).is_ok_and(|tick| tick >= game.time_limit());
        return ending(if late { EndingKind::OutOfTime } else { EndingKind::Otherwise });
    };
    let types = goal.condition.types();
    let avatars = || analysis.avatars().iter().map(|avatar| avatar.stype);
    let kind = match goal.condition {
        Condition::Tick(_) => return ending(EndingKind::OutOfTime),
        Condition::AtLeast(..) => EndingKind::Appeared,
        Condition::Exactly(_, limit) if limit > 0 => EndingKind::Appeared,
        // An avatar that has turned into a different avatar type is still alive.
        _ if last.avatar_type().is_none() && avatars().any(|avatar| types.contains(&avatar)) => {
            EndingKind::Died
        }
        _ => EndingKind::Lost,
    };
    if kind == EndingKind::Appeared {
        let present = types.iter().find(|&&stype| last.alive(stype) > 0);
        return Ending { sprite: present.map(|&stype| game.name(stype).to_owned()), ..ending(kind) };
    }
    let cause = culprit(subject, tick, types).and_then(|(line, sprite, by)| {
        let line = game.description().interactions.get(line)?;
        let is_edge = by.is_none() && line.second.iter().any(|word| word.text == EDGE);
        let by = by.map(|stype| game.name(stype)).or(is_edge.then_some(EDGE));
        Some((sprite, by.map(str::to_owned), written(&subject.source, line.first.span)))
    });
    let name = |stype: SpriteType| game.name(stype).to_owned();
    match cause {
        Some((sprite, by, rule)) => {
            Ending { sprite: Some(name(sprite)), by, rule: Some(rule), ..ending(kind) }
        }
        None => Ending { sprite: types.first().map(|&stype| name(stype)), ..ending(kind) },
    }
}

/// Returns the interaction that removed a sprite of one of these types in the last tick: its line, the removed type, and
/// the type that the interaction acted on. If several interactions are possible causes, the last one counts.
fn culprit(
    subject: &Subject,
    tick: &LastTick,
    types: &[SpriteType],
) -> Option<(usize, SpriteType, Option<SpriteType>)> {
    let seen = tick.removals.iter().rev().find(|removal| types.contains(&removal.sprite));
    // An effect on all sprites of a type can also remove sprites other than the two that met.
    seen.map(|removal| (removal.line, removal.sprite, removal.by))
        .or_else(|| tick.meetings.iter().rev().find_map(|meeting| removed_at_large(subject, meeting, types)))
}

/// Returns the line of a meeting's interaction if the interaction may have removed sprites anywhere on the
/// board. Also returns the removed type (one of `types`), and the type that the interaction acted on.
fn removed_at_large(
    subject: &Subject,
    meeting: &Meeting,
    types: &[SpriteType],
) -> Option<(usize, SpriteType, Option<SpriteType>)> {
    let of_line = subject.analysis.encounters().iter().filter(|encounter| encounter.line == meeting.line);
    let at_large = |effect: &EffectSummary| match effect {
        EffectSummary::KillAll(stype) | EffectSummary::BecomeAll(stype, _) => Some(*stype),
        EffectSummary::Health { of, by, .. } => of.filter(|_| *by < 0),
        _ => None,
    };
    let mut all = of_line.flat_map(|encounter| &encounter.effects).filter_map(at_large);
    all.find(|stype| types.contains(stype)).map(|stype| (meeting.line, stype, Some(meeting.first)))
}

/// Returns the distance from the nearest win.
fn distance(subject: &Subject, first: &State, last: &State) -> Option<GoalDistance> {
    let analysis = &subject.analysis;
    let wins = analysis.goals().iter().filter(|goal| goal.win);
    let distances = wins.map(|goal| {
        let line = subject.game.description().terminations.get(goal.line);
        let named = |param: &&Param| param.key.text.starts_with("stype");
        let names = line.into_iter().flat_map(|line| line.params.iter().filter(named));
        let counted = names.map(|param| param.value.text.as_str()).join(" or ");
        let counted = if counted.is_empty() { TICKS.to_owned() } else { counted };
        GoalDistance { counted, left: analysis.missing(goal, last), of: analysis.missing(goal, first) }
    });
    let open = distances.filter(|distance| distance.left > 0 && distance.of > 0);
    open.min_by(|one, other| one.fraction().total_cmp(&other.fraction()))
}

/// Returns the source line that contains a span, without its comment and with runs of spaces collapsed.
fn written(source: &str, span: Span) -> String {
    let from = source.get(..span.start).map_or(0, |before| before.rfind('\n').map_or(0, |at| at + 1));
    let line = source.get(from..).unwrap_or("").lines().next().unwrap_or("");
    let line = line.split('#').next().unwrap_or("");
    line.split_whitespace().join(" ")
}
