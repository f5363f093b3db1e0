//! Facts that players may know from the rules: the time left, the remaining requirements for a win, and
//! countdowns.

use super::wins;
use engine::analysis::{Condition, Goal};
use engine::{Analysis, Countdown, Event, Game, SpriteClass, SpriteType, State};

/// The facts about a game that captions display.
#[derive(Clone, Debug)]
pub(crate) struct Prospects {
    /// The tick at which the game ends, with `true` if the game is won at that tick.
    deadline: Option<(i32, bool)>,
    /// The sprite counts that win, with the names that the terminations use.
    goals: Vec<(String, Goal)>,
    /// The resources required in amounts above 1, each with the required amount.
    needed: Vec<(SpriteType, i32)>,
    counts_down: bool,
}

impl Prospects {
    pub(crate) fn of(analysis: &Analysis) -> Prospects {
        let (game, aims) = (analysis.game(), analysis.aims());
        let lost = aims.deadline.map(|tick| (tick, false));
        let deadline = lost.into_iter().chain(aims.survive.map(|tick| (tick, true))).min();
        let counted = |(at, goal): &(usize, &Goal)| {
            wins::is_plain_win(analysis, *at) && !goal.condition.types().is_empty()
        };
        let goals = analysis.goals().iter().enumerate().filter(counted);
        let goals = goals.map(|(_, goal)| (names(game, goal), goal.clone())).collect();
        let several = analysis.resources().iter().filter(|resource| resource.needed > 1);
        let needed = several.map(|resource| (resource.stype, resource.needed)).collect();
        let counts = |stype: SpriteType| {
            let facts = analysis.facts(stype);
            let is_a = |class| game.class(stype).is_some_and(|own| own.is_a(class));
            let lasts = is_a(SpriteClass::Flicker) && !facts.fleeting;
            let regular = is_a(SpriteClass::SpawnPoint) && !is_left_to_chance(game, stype);
            facts.possible && !facts.hidden && (regular || lasts)
        };
        let counts_down = game.has_timed_countdowns() || game.sprite_types().any(counts);
        Prospects { deadline, goals, needed, counts_down }
    }

    /// Returns the amount of a resource that some rule requires, if the amount is more than 1.
    pub(crate) fn needed(&self, resource: &str, game: &Game) -> Option<i32> {
        let known = self.needed.iter().find(|(stype, _)| game.name(*stype) == resource);
        known.map(|(_, number)| *number)
    }

    /// Returns the resources that are required in amounts above 1.
    pub(crate) fn required(&self) -> impl Iterator<Item = (SpriteType, i32)> + '_ {
        self.needed.iter().copied()
    }

    /// Describes the time left: `89 left`, or `survive 40`; `None` if the game ends at no particular tick.
    pub(crate) fn time(&self, state: &State) -> Option<String> {
        let (limit, wins) = self.deadline?;
        let left = limit.saturating_sub(state.tick()).max(0);
        Some(if wins { format!("survive {left}") } else { format!("{left} left") })
    }

    pub(crate) fn has_goals(&self) -> bool {
        !self.goals.is_empty()
    }

    /// Describes the remaining requirements for a win: `friend 1 of 3`, `exit 1 to go`.
    pub(crate) fn goals(&self, state: &State) -> String {
        let part = |(names, goal): &(String, Goal)| {
            let count = |stype| i32::try_from(state.alive(stype)).unwrap_or(i32::MAX);
            let now: i32 = goal.condition.types().iter().map(|&stype| count(stype)).sum();
            match goal.condition {
                Condition::AtLeast(_, limit) => format!("{names} {now} of {limit}"),
                Condition::Exactly(_, limit) if limit > 0 => format!("{names} {now} of {limit}"),
                _ => format!("{names} {} to go", goal.condition.missing(count, state.tick())),
            }
        };
        self.goals.iter().map(part).collect::<Vec<_>>().join(" or ")
    }

    pub(crate) fn counts_down(&self) -> bool {
        self.counts_down
    }

    /// Describes, for each type with a countdown, its next event other than a move, if the event occurs before the time limit:
    /// `molehill acts in 4 (2 left)`, `fire ends in 3`.
    pub(crate) fn countdowns(&self, game: &Game, state: &State) -> String {
        let mut next: Vec<Countdown> = Vec::new();
        for found in game.countdowns(state).into_iter().filter(|found| found.event != Event::Moves) {
            let soon = |countdown: &Countdown| countdown.ticks.unwrap_or(i32::MAX);
            match next.iter_mut().find(|known| known.stype == found.stype) {
                Some(known) if soon(&found) < soon(known) => *known = found,
                Some(_) => {}
                None => next.push(found),
            }
        }
        let part = |countdown: &Countdown| {
            let name = game.name(countdown.stype);
            let left = countdown.left.map_or(String::new(), |left| format!(" ({left} left)"));
            match (countdown.ticks, countdown.event) {
                (Some(ticks), Event::Makes) => format!("{name} acts in {ticks}{left}"),
                (Some(ticks), Event::Moves) => format!("{name} moves in {ticks}"),
                (Some(ticks), Event::Turns) => format!("{name} changes in {ticks}"),
                (Some(ticks), Event::Ends) => format!("{name} ends in {ticks}"),
                (None, _) => format!("{name}{left}"),
            }
        };
        let left = self.deadline.map_or(i32::MAX, |(limit, _)| limit.saturating_sub(state.tick()));
        let told =
            |countdown: &&Countdown| countdown.ticks.map_or(countdown.left.is_some(), |ticks| ticks <= left);
        next.iter().filter(told).map(part).collect::<Vec<_>>().join(", ")
    }
}

/// Returns `true` if a type's line has the parameter `prob` but not the parameter `total`.
fn is_left_to_chance(game: &Game, stype: SpriteType) -> bool {
    let lines = game.description().sprite_lines();
    let line = lines.iter().find(|(_, line)| line.name.text == game.name(stype));
    let has = |key: &str| line.is_some_and(|(_, line)| line.params.iter().any(|param| param.key.text == key));
    has("prob") && !has("total")
}

/// Returns the names of the types that a termination counts, as written in the termination. A name such as
/// `angryPirate` is omitted if it only denotes a state of another counted type.
fn names(game: &Game, goal: &Goal) -> String {
    let line = &game.description().terminations[goal.line];
    let given = line.params.iter().filter(|param| param.key.text.starts_with("stype"));
    let given: Vec<&str> = given.flat_map(|param| param.value.text.split(',')).collect();
    let is_state = |name: &&str| given.iter().any(|other| is_state_of(name, other));
    given.iter().filter(|name| !is_state(name)).copied().collect::<Vec<_>>().join("+")
}

/// Returns `true` if a name in camel case ends with another name, such as `angryPirate` with `pirate`.
fn is_state_of(name: &str, other: &str) -> bool {
    let mut letters = other.chars();
    letters.next().is_some_and(|first| {
        let word: String = first.to_uppercase().chain(letters).collect();
        name != other && name.ends_with(&word)
    })
}
