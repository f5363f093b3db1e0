//! Plays the actions in a trace, and compares every recorded field at every tick.

use super::trace::{Line, Tick, Trace};
use engine::{Action, Chance, Game, Level, Outcome, SpriteRecord, State};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

/// The maximum number of differences shown per tick. The first of them is the first divergence.
const SHOWN: usize = 6;

/// The first tick at which the engine and the trace differ.
#[derive(Debug, Serialize)]
pub(crate) struct Difference {
    /// The tick number, where −1 represents the state before the first tick.
    pub(crate) tick: i32,
    action: Option<Action>,
    /// The state of the game's random generator before the tick.
    chance_before: u64,
    /// The first fields that differ in the tick, up to [`SHOWN`].
    fields: Vec<Field>,
    /// The number of further fields that differ.
    more: usize,
}

#[derive(Debug, Serialize)]
struct Field {
    /// The sprite's creation number and type, if the field belongs to a sprite.
    sprite: Option<String>,
    field: &'static str,
    expected: String,
    got: String,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let action = self.action.map_or(String::new(), |action| format!(", action {action}"));
        writeln!(f, "  tick {}{action}, chance before it {}", self.tick, self.chance_before)?;
        for Field { sprite, field, expected, got } in &self.fields {
            let sprite = sprite.as_ref().map_or(String::new(), |sprite| format!("{sprite} "));
            writeln!(f, "    {sprite}{field}: expected {expected}, got {got}")?;
        }
        if self.more > 0 {
            writeln!(f, "    and {} more in this tick", self.more)?;
        }
        Ok(())
    }
}

/// Returns the first tick that differs, or `None` if all ticks are equal.
pub(crate) fn compare(game: &Game, level: &Level, trace: &Trace) -> Option<Difference> {
    let mut state = game.start_with(level, Chance::from_java(trace.header.seed));
    let mut expected: BTreeMap<u32, SpriteRecord> =
        trace.sprites.iter().map(|record| (record.id, record.clone())).collect();
    let mut check = Check { game, fields: Vec::new() };
    check.start(&state, trace);
    check.sprites(&state, &expected);
    if let Some(difference) = check.finish(-1, None, state.chance()) {
        return Some(difference);
    }
    for tick in &trace.ticks {
        let before = state.chance();
        game.step(&mut state, tick.action);
        check.apply(tick, &mut expected);
        match &tick.line.engine_error {
            Some(error) => check.engine_error(&state, error),
            None => {
                check.tick(&state, &tick.line);
                check.sprites(&state, &expected);
            }
        }
        if let Some(difference) = check.finish(tick.line.tick, Some(tick.action), before) {
            return Some(difference);
        }
    }
    None
}

struct Check<'a> {
    game: &'a Game,
    fields: Vec<Field>,
}

impl Check<'_> {
    fn finish(&mut self, tick: i32, action: Option<Action>, before: Chance) -> Option<Difference> {
        let mut fields = std::mem::take(&mut self.fields);
        let more = fields.len().saturating_sub(SHOWN);
        fields.truncate(SHOWN);
        (!fields.is_empty()).then(|| Difference { tick, action, chance_before: before.state(), fields, more })
    }

    fn equal<T: PartialEq + fmt::Debug>(&mut self, field: &'static str, expected: T, got: T) {
        if expected != got {
            self.differs(field, &expected, &got);
        }
    }

    fn differs(&mut self, field: &'static str, expected: &impl fmt::Debug, got: &impl fmt::Debug) {
        let (expected, got) = (format!("{expected:?}"), format!("{got:?}"));
        self.fields.push(Field { sprite: None, field, expected, got });
    }

    fn start(&mut self, state: &State, trace: &Trace) {
        let header = &trace.header;
        let game = self.game;
        let types: Vec<String> = game.sprite_types().map(|stype| game.name(stype).to_owned()).collect();
        self.equal("types", &header.types, &types);
        self.equal("sprite_order", &header.sprite_order, &game.drawing_order());
        let (columns, rows) = state.size();
        self.equal("block_size", header.block_size, state.block());
        self.equal("width", header.width, columns * state.block());
        self.equal("height", header.height, rows * state.block());
        // NIL is ignored, because it is always possible although not every avatar lists it.
        let nil = Some(Action::Nil);
        let mut actions: Vec<_> = header.actions.iter().map(|name| Action::from_reference(name)).collect();
        actions.retain(|action| *action != nil);
        actions.sort_unstable();
        let own = game.actions(state).iter().copied().map(Some).filter(|action| *action != nil);
        self.equal("actions", actions, own.collect());
        self.equal("avatar", header.avatar, state.avatar_id());
        // The second of the two messages about a missing avatar is logged at the start of the run, so a trace
        // may lack it.
        let messages = state.messages() as usize;
        let late = header.avatar.is_none() && header.log.len() < messages;
        self.equal("log", header.log.len(), messages - usize::from(late));
        self.equal("rng", trace.rng, state.chance().state());
    }

    fn tick(&mut self, state: &State, tick: &Line) {
        let avatar = state.avatar_id();
        self.equal("tick", tick.tick, state.tick());
        self.equal("rng", tick.rng, state.chance().state());
        self.equal("avatar", tick.avatar, avatar);
        self.equal("score", tick.score, avatar.map(|_| state.score()));
        let winner = match state.outcome() {
            Outcome::Won => "PLAYER_WINS",
            Outcome::Lost => "PLAYER_LOSES",
            Outcome::Ongoing | Outcome::Ended | Outcome::Stopped(_) => "NO_WINNER",
        };
        self.equal("winner", tick.winner.as_deref(), avatar.map(|_| winner));
        self.equal("ended", tick.ended, state.is_over());
        let resources = self.game.held_by_avatar(state).into_iter().collect();
        self.equal("resources", &tick.resources, &resources);
        self.equal("counters", &tick.counters[..], state.counters());
        if !matches!(state.outcome(), Outcome::Won | Outcome::Lost) {
            self.equal("note", tick.note.is_some(), state.outcome() == Outcome::Ended);
        }
    }

    fn engine_error(&mut self, state: &State, error: &str) {
        if !matches!(state.outcome(), Outcome::Stopped(_)) {
            self.equal("engine_error", error.to_owned(), format!("{:?}", state.outcome()));
        }
    }

    /// Applies a tick's changes to the expected sprites. Records a difference if the trace contradicts
    /// itself.
    fn apply(&mut self, tick: &Tick, expected: &mut BTreeMap<u32, SpriteRecord>) {
        for id in &tick.line.del {
            let gone = expected.remove(id);
            self.equal("del", Some(*id), gone.map(|record| record.id));
        }
        for record in &tick.changed {
            expected.insert(record.id, record.clone());
        }
    }

    fn sprites(&mut self, state: &State, expected: &BTreeMap<u32, SpriteRecord>) {
        let got = self.game.records(state);
        let mut got = got.iter().peekable();
        for wanted in expected.values() {
            while let Some(extra) = got.next_if(|record| record.id < wanted.id) {
                self.presence(extra, "nothing", "a sprite");
            }
            match got.next_if(|record| record.id == wanted.id) {
                Some(record) => self.record(wanted, record),
                None => self.presence(wanted, "a sprite", "nothing"),
            }
        }
        for extra in got {
            self.presence(extra, "nothing", "a sprite");
        }
    }

    fn presence(&mut self, record: &SpriteRecord, expected: &str, got: &str) {
        let sprite = Some(self.sprite_name(record));
        let (expected, got) = (expected.to_owned(), got.to_owned());
        self.fields.push(Field { sprite, field: "presence", expected, got });
    }

    fn sprite_name(&self, record: &SpriteRecord) -> String {
        let name = self.game.sprite_types().find(|stype| stype.0 == record.stype);
        let name = name.map_or("?", |stype| self.game.name(stype));
        let &SpriteRecord { id, rect, .. } = record;
        format!("sprite {id} ({name} at {},{})", rect.x, rect.y)
    }

    fn record(&mut self, wanted: &SpriteRecord, got: &SpriteRecord) {
        let numbers = |record: &SpriteRecord| {
            let (x, y) = record.orientation;
            [x, y, record.speed, record.rotation].map(f64::to_bits)
        };
        if wanted == got && numbers(wanted) == numbers(got) {
            return;
        }
        let from = self.fields.len();
        self.equal("type", wanted.stype, got.stype);
        self.equal("x", wanted.rect.x, got.rect.x);
        self.equal("y", wanted.rect.y, got.rect.y);
        self.equal("w", wanted.rect.w, got.rect.w);
        self.equal("h", wanted.rect.h, got.rect.h);
        self.exact("orientation.x", wanted.orientation.0, got.orientation.0);
        self.exact("orientation.y", wanted.orientation.1, got.orientation.1);
        self.exact("speed", wanted.speed, got.speed);
        self.equal("hp", wanted.health, got.health);
        self.equal("flags", wanted.flags, got.flags);
        self.equal("res", &wanted.resources, &got.resources);
        // A trace cannot contain a rotation of −0.0.
        self.exact("rot", wanted.rotation + 0.0, got.rotation + 0.0);
        if from < self.fields.len() {
            let name = self.sprite_name(got);
            self.fields[from..].iter_mut().for_each(|field| field.sprite = Some(name.clone()));
        }
    }

    fn exact(&mut self, field: &'static str, expected: f64, got: f64) {
        if bits(expected) != bits(got) {
            self.differs(field, &expected, &got);
        }
    }
}

/// Returns the bits of a value, for comparison with a trace. −0.0 and 0.0 are different values, but all NaNs
/// are equal.
fn bits(value: f64) -> u64 {
    if value.is_nan() { f64::NAN.to_bits() } else { value.to_bits() }
}
