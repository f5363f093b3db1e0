//! The player's choices during a win: what else the player could do next, and which of these choices are wrong.

use super::replay::is_guard;
use super::shortest::{Limits, shortest_win};
use base::Seed;
use engine::analysis::Role;
use engine::{Action, Analysis, Level, Meeting, Outcome, SearchKey, State, Watch};
use std::collections::{BTreeSet, VecDeque};

/// The maximum number of decisions of a win at which other choices are examined.
const DECISIONS: usize = 5;
/// The maximum number of other choices per decision.
const OTHERS: usize = 3;
/// The maximum number of forward-model calls in the search for other choices at a decision.
const CALLS: usize = 600;

/// The consequences of a win's other choices.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Choices {
    /// The number of other choices examined.
    pub(super) examined: usize,
    /// The number of examined choices after which no win is found.
    pub(super) wrong: usize,
    /// The number of forward-model calls.
    pub(super) calls: u64,
}

impl Choices {
    /// Returns the fraction of wrong choices; 0.0 if there are no choices.
    pub(super) fn share(&self) -> f64 {
        self.wrong as f64 / self.examined.max(1) as f64
    }
}

/// An event: the interactions of one tick that involve the avatar, a shot or a pushed sprite, with their cells. Guards
/// do not count.
type Event = BTreeSet<(usize, (i32, i32))>;

/// Examines what else the player could do at the decisions of a win.
///
/// A decision is the start of the level, or the tick after an event of the win. At up to five decisions, a breadth-first
/// search finds up to three events that the player could cause instead of the win's next event. Events that end the game
/// do not count. An event is wrong if no win is found after the event, although the same search finds a win from the
/// decision.
pub(super) fn choices(
    analysis: &Analysis,
    level: &Level,
    win: &[Action],
    seed: Seed,
    limits: Limits,
) -> Choices {
    let mut choices = Choices::default();
    let decisions = decisions(analysis, level, win, seed);
    for at in 0..DECISIONS.min(decisions.len()) {
        let (start, next) = &decisions[at * decisions.len() / DECISIONS.min(decisions.len())];
        let (others, calls) = others(analysis, start, next);
        choices.calls += calls;
        let mut is_wrong = |state: &State| {
            let found = shortest_win(analysis, state, limits);
            choices.calls += found.calls;
            found.win.is_none()
        };
        if others.is_empty() || is_wrong(start) {
            continue;
        }
        let wrong = others.iter().filter(|other| is_wrong(other)).count();
        choices.examined += others.len();
        choices.wrong += wrong;
    }
    choices
}

/// Returns the states after the events of a win, beginning with the start, each with the next event.
fn decisions(analysis: &Analysis, level: &Level, win: &[Action], seed: Seed) -> Vec<(State, Event)> {
    let mut decisions = Vec::new();
    let mut state = analysis.game().start(level, seed);
    let mut since = state.clone();
    for &action in win {
        let (outcome, event) = act(analysis, &mut state, action);
        if !event.is_empty() {
            decisions.push((since, event));
            since = state.clone();
        }
        if outcome != Outcome::Ongoing {
            break;
        }
    }
    decisions
}

/// Returns the states after other events than the next one, nearest first, and the number of calls.
fn others(analysis: &Analysis, start: &State, next: &Event) -> (Vec<State>, u64) {
    let abstraction = analysis.abstraction(start).without_chance();
    let mut met: BTreeSet<SearchKey> = BTreeSet::from([abstraction.key(analysis, start)]);
    let mut seen: BTreeSet<Event> = BTreeSet::from([next.clone()]);
    let (mut queue, mut found, mut calls) = (VecDeque::from([start.clone()]), Vec::new(), 0);
    while let Some(state) = queue.pop_front() {
        for &action in analysis.game().actions(&state) {
            if calls == CALLS || found.len() == OTHERS {
                return (found, calls as u64);
            }
            calls += 1;
            let mut child = state.clone();
            let (outcome, event) = act(analysis, &mut child, action);
            if outcome != Outcome::Ongoing || !met.insert(abstraction.key(analysis, &child)) {
                continue;
            }
            if event.is_empty() {
                queue.push_back(child);
            } else if seen.insert(event) {
                found.push(child);
            }
        }
    }
    (found, calls as u64)
}

fn act(analysis: &Analysis, state: &mut State, action: Action) -> (Outcome, Event) {
    let mut log = Log { analysis, event: Event::new() };
    let outcome = analysis.game().step_watched(state, action, &mut log);
    (outcome, log.event)
}

struct Log<'a> {
    analysis: &'a Analysis,
    event: Event,
}

impl Watch for Log<'_> {
    fn interaction(&mut self, _: usize) {}

    fn wants_meetings(&self) -> bool {
        true
    }

    fn meeting(&mut self, meeting: Meeting) {
        let is_moved = |stype| {
            let role = self.analysis.role(stype);
            matches!(role, Role::Avatar | Role::Shot | Role::Pushable)
        };
        let is_event = is_moved(meeting.first) || meeting.second.is_some_and(is_moved);
        if is_event && !is_guard(self.analysis, meeting.line) {
            self.event.insert((meeting.line, meeting.cell));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::Game;

    const GAME: &str = "BasicGame\n  SpriteSet\n    wall > Immovable\n    gate > Immovable\n    key > Resource limit=2\n    plum > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    G > gate\n    k > key\n    p > plum\n  InteractionSet\n    avatar wall > stepBack\n    gate avatar > killIfOtherHasMore resource=key limit=1 subtract=True\n    avatar gate > stepBack\n    key avatar > collectResource\n    plum avatar > killSprite\n  TerminationSet\n    SpriteCounter stype=avatar win=False\n    SpriteCounter stype=plum win=True\n";

    #[test]
    fn the_only_key_is_wrong_for_a_second_gate() {
        let game = Game::from_source(GAME).unwrap();
        let analysis = Analysis::of(&game);
        let seed = Seed::from_text("choices");
        let examine = |level: &str| {
            let level = game.level(level).unwrap();
            let limits = Limits { calls: 5_000, ticks: 40 };
            let win = shortest_win(&analysis, &game.start(&level, seed), limits).win.unwrap();
            let Choices { examined, wrong, .. } = choices(&analysis, &level, &win, seed, limits);
            (examined, wrong)
        };
        assert_eq!(examine("wwwwwwwww\nwG kA Gpw\nwwwwwwwww\n"), (1, 1));
        let (examined, wrong) = examine("wwwwwwwwww\nwGk kA Gpw\nwwwwwwwwww\n");
        assert!(examined > 1 && wrong == 0, "{wrong} of {examined} are wrong");
        assert_eq!(examine("wwwwwwwww\nw  kA Gpw\nwwwwwwwww\n"), (0, 0));
    }
}
