//! One step of a game: the cycle of `spec/01` §4, and the operations on sprites that the ontology is written in.

use crate::Seed;
use crate::chance::Chance;
use crate::game::{Action, Game, Limit, Outcome, Rules, SpriteType};
use crate::geometry::{Direction, Rect};
use crate::level::{Level, MAX_SPRITES};
use crate::ontology::{avatars, sprites};
use crate::state::{Group, NONE, Slot, Sprite, State, Timer, flag, memory};

/// The tick at which the reference ends every game.
pub const MAX_TICKS: i32 = 2000;
/// Messages after which the reference ends a game without a winner.
const MAX_MESSAGES: u32 = 25;
/// Pixels of the longer side of a board whose game does not set `square_size`.
const SCREEN: i32 = 800;

/// Work of the effects of one tick at most: an execution counts one, those that go through many sprites one a sprite.
/// The busiest tick of a real game does some thousands.
pub const MAX_EFFECTS: usize = 1 << 20;
/// Timers that can be planned at a time.
pub(crate) const MAX_TIMERS: usize = 1 << 16;

/// Learns what happens inside a step: which interaction of the description was executed on which sprites.
pub trait Watch {
    /// Interaction `line` (index into [`Description::interactions`](crate::Description)) was executed.
    fn interaction(&mut self, line: usize);
}

/// Watches nothing, costs nothing.
impl Watch for () {
    fn interaction(&mut self, _: usize) {}
}

/// A step under way.
pub(crate) struct Step<'a> {
    pub(crate) rules: &'a Rules,
    pub(crate) state: &'a mut State,
    /// The place in the update order that is being updated; types with a lower place are still to come in this tick.
    pub(crate) updating: i32,
    /// What stopped the step, if anything did.
    pub(crate) stopped: Option<Limit>,
    /// Work of effects so far.
    pub(crate) effects: usize,
}

impl Game {
    /// The state before the first tick. The seed decides the game's chance, nothing else.
    pub fn start(&self, level: &Level, seed: Seed) -> State {
        self.start_with(level, seed.chance())
    }

    /// [`Game::start`] with a chance of the caller's, such as a trace's.
    pub fn start_with(&self, level: &Level, chance: Chance) -> State {
        let rules = &*self.0;
        let (columns, rows) = (level.columns() as i32, level.rows() as i32);
        let block = self.block(level);
        let initial = |on: bool| if on { memory::APPLY_SCORE } else { 0 };
        let mut state = State {
            tick: -1,
            score: 0,
            outcome: Outcome::Ongoing,
            chance,
            last_action: Action::Nil,
            avatar: NONE,
            next_id: 0,
            population: 0,
            messages: rules.messages + level.messages,
            block,
            columns,
            rows,
            free: NONE,
            can_end: true,
            sprite_hash: 0,
            sprites: Vec::new(),
            groups: vec![Group::EMPTY; rules.types.len()],
            cells: vec![NONE; State::cell_count(columns, rows)],
            moved: Vec::new(),
            stale: Vec::new(),
            killed: Vec::new(),
            held: Vec::new(),
            memory: rules.effects.iter().map(|effect| initial(effect.apply_score)).collect(),
            templates: vec![false; rules.types.len()],
            shields: Vec::new(),
            pulled: Vec::new(),
            extras: Vec::new(),
            timers: Vec::new(),
            obstacles: Vec::new(),
            jumps: chance,
        };
        let mut step = Step { rules, state: &mut state, updating: -1, stopped: None, effects: 0 };
        for (at, &symbol) in level.cells().iter().enumerate() {
            let (column, row) = ((at % level.columns()) as i32, (at / level.columns()) as i32);
            for &stype in self.places(symbol) {
                step.add(stype, column * block, row * block);
            }
        }
        step.remove_extra_avatars();
        step.find_avatar();
        if let Some(limit) = step.stopped {
            state.outcome = Outcome::Stopped(limit);
        }
        for (at, timed) in rules.timed.iter().enumerate() {
            if let Some(due) = timed.first_due {
                state.plan(Timer { due, timed: at as u16 });
            }
        }
        if !rules.obstacles.is_empty() {
            state.mark_obstacles(rules);
        }
        state.freshen();
        state
    }

    /// Pixels of a cell.
    pub(crate) fn block(&self, level: &Level) -> i32 {
        let side = level.columns().max(level.rows()) as i32;
        self.0.square_size.unwrap_or_else(|| 2.max(SCREEN / side))
    }

    /// Plays one tick. Does nothing once the episode is over; an action that the avatar does not have counts as none.
    ///
    /// Allocates nothing once the state's buffers have grown.
    pub fn step(&self, state: &mut State, action: Action) -> Outcome {
        self.step_watched(state, action, &mut ())
    }

    /// [`Game::step`], telling `watch` which interactions are executed.
    pub fn step_watched(&self, state: &mut State, action: Action, watch: &mut impl Watch) -> Outcome {
        if state.is_over() {
            return state.outcome;
        }
        let allowed = self.actions(state).contains(&action);
        let mut step = Step { rules: &self.0, state, updating: i32::MAX, stopped: None, effects: 0 };
        step.cycle(if allowed { action } else { Action::Nil }, watch);
        state.freshen();
        state.outcome
    }
}

impl Step<'_> {
    fn cycle(&mut self, action: Action, watch: &mut impl Watch) {
        self.state.tick += 1;
        self.state.last_action = action;
        self.settle_moved();
        self.update(action);
        if self.stopped.is_none() {
            self.events(watch);
        }
        self.clear();
        if let Some(limit) = self.stopped {
            self.state.outcome = Outcome::Stopped(limit);
            return;
        }
        self.terminate();
        if self.state.messages > MAX_MESSAGES {
            self.state.messages = 0;
            if self.state.outcome == Outcome::Ongoing {
                self.state.outcome = Outcome::Ended;
            }
        }
        if self.state.tick >= MAX_TICKS && self.state.outcome != Outcome::Won {
            self.state.outcome = Outcome::Lost;
        }
    }

    /// The last rectangle becomes the rectangle. The reference does so for every sprite before its own update; only
    /// those that moved since can tell the difference, and nothing reads another's last rectangle before the events.
    fn settle_moved(&mut self) {
        let mut moved = std::mem::take(&mut self.state.moved);
        moved.retain(|&slot| {
            if self.is_updated(slot) {
                let sprite = self.state.edit(slot);
                sprite.last = sprite.rect;
                sprite.set(flag::MOVED, false);
                return false;
            }
            true
        });
        self.state.moved = moved;
    }

    /// Whether the sprite takes part in update phases: its type does, and it is the player's avatar or none.
    fn is_updated(&self, slot: Slot) -> bool {
        let sprite = self.state.sprite(slot);
        !sprite.is(flag::FROZEN)
            && self.rules.types[sprite.stype.index()].order.is_some()
            && (!sprite.is(flag::AVATAR) || slot == self.state.avatar)
    }

    fn update(&mut self, action: Action) {
        let avatar = self.state.avatar;
        if avatar != NONE && !self.state.sprite(avatar).is(flag::DISABLED) {
            avatars::update(self, avatar, action);
        }
        for at in 0..self.rules.movers.len() {
            let stype = self.rules.movers[at];
            self.updating =
                i32::from(self.rules.types[stype.index()].order.expect("movers are in the update order"));
            let mut slot = self.state.group(stype).head;
            while slot != NONE {
                sprites::update(self, slot);
                if self.stopped.is_some() {
                    return;
                }
                slot = self.state.sprite(slot).next;
            }
        }
        self.updating = -1;
    }

    /// The player's avatar: of the sprites of avatar classes, by update order, the last one made of the first type
    /// (`spec/01` §4.2; a single avatar is what checked levels have).
    fn find_avatar(&mut self) {
        let types = self.rules.order.iter().skip(1).rev();
        let slots = types.flat_map(|&stype| self.state.slots(stype));
        let avatar = slots.filter(|&slot| self.state.sprite(slot).is(flag::AVATAR)).last();
        match avatar {
            Some(slot) => self.control(slot),
            None => self.message(),
        }
    }

    /// The reference removes all avatars but the first made, with a message; checked levels have one.
    fn remove_extra_avatars(&mut self) {
        let slots = 0..self.state.sprites.len() as Slot;
        let avatars: Vec<Slot> = slots.filter(|&slot| self.state.sprite(slot).is(flag::AVATAR)).collect();
        let Some((_, extra @ [_, ..])) = avatars.split_first() else { return };
        self.message();
        for &slot in extra {
            self.state.release(slot);
            self.state.stale.retain(|&stale| stale != slot);
            self.state.moved.retain(|&moved| moved != slot);
        }
    }

    /// Makes a sprite the player's: from now on it is updated, and ages.
    pub(crate) fn control(&mut self, slot: Slot) {
        self.state.avatar = slot;
        let tick = self.state.tick;
        let sprite = self.state.edit(slot);
        if sprite.is(flag::FROZEN) && !sprite.is(flag::DISABLED) {
            sprite.set(flag::FROZEN, false);
            sprite.moved_at = tick - sprite.moved_at;
        }
    }

    /// Removes what was killed in this tick (`spec/01` §4.10).
    fn clear(&mut self) {
        let mut killed = std::mem::take(&mut self.state.killed);
        for &slot in &killed {
            // The kill list may name a sprite twice; the counter goes down twice, as in the reference.
            self.state.population -= 1;
            if self.state.sprite(slot).is(flag::GONE) {
                continue;
            }
            if slot == self.state.avatar {
                self.state.avatar = NONE;
            }
            self.state.release(slot);
        }
        if !killed.is_empty() {
            let State { stale, moved, sprites, .. } = &mut *self.state;
            let gone = |slot: &Slot| sprites[usize::from(*slot)].is(flag::GONE);
            stale.retain(|slot| !gone(slot));
            moved.retain(|slot| !gone(slot));
            killed.clear();
        }
        self.state.killed = killed;
        self.state.shields.clear();
        self.state.pulled.clear();
    }

    fn terminate(&mut self) {
        for termination in &self.rules.terminations {
            if let Some(can_end) = termination.permits(self.rules, self.state) {
                self.state.can_end = can_end;
            }
            if termination.holds(self.rules, self.state) {
                self.state.outcome = if termination.win { Outcome::Won } else { Outcome::Lost };
                return;
            }
        }
    }

    /// Stops the episode: what happened makes the reference engine throw, or met a limit of ours.
    pub(crate) fn stop(&mut self, limit: Limit) {
        self.stopped.get_or_insert(limit);
    }

    /// Counts work of effects; too much of it stops the episode.
    pub(crate) fn work(&mut self, amount: usize) {
        self.effects = self.effects.saturating_add(amount);
        if self.effects > MAX_EFFECTS {
            self.stop(Limit::Effects);
        }
    }

    pub(crate) fn message(&mut self) {
        self.state.messages = self.state.messages.saturating_add(1);
    }

    /// Makes a sprite unless a singleton of its line exists or there are too many (`spec/01` §3.5).
    pub(crate) fn add(&mut self, stype: SpriteType, x: i32, y: i32) -> Option<Slot> {
        let rules = self.rules;
        if stype == SpriteType::NONE {
            self.stop(Limit::NoType);
            return None;
        }
        for &ancestor in &rules.types[stype.index()].path {
            if rules.types[ancestor.index()].singleton && self.state.count(rules, ancestor) > 0 {
                return None;
            }
        }
        self.add_forced(stype, x, y)
    }

    /// Makes a sprite whatever singletons there are.
    pub(crate) fn add_forced(&mut self, stype: SpriteType, x: i32, y: i32) -> Option<Slot> {
        let info = &self.rules.types[stype.index()];
        if self.state.population > MAX_SPRITES as i32 {
            self.message();
            return None;
        }
        if info.class.is_none() {
            self.stop(Limit::NoType);
            return None;
        }
        let traits = &info.traits;
        let block = self.state.block;
        let scaled = |factor: f64| (f64::from(block) * factor) as i32;
        let rect = Rect { x, y, w: scaled(traits.width_factor), h: scaled(traits.height_factor) };
        let first = !std::mem::replace(&mut self.state.templates[stype.index()], true);
        if first {
            self.state.messages = self.state.messages.saturating_add(info.unknown_parameters);
        }
        let is_avatar = info.class.is_some_and(|class| class.is_avatar());
        // Sprites of avatar classes are updated, and age, only as the player's.
        let order = info.order.map(i32::from).filter(|_| !is_avatar);
        // Still to be updated in this tick: then its age will be 1 at that update.
        let due = order.is_some_and(|order| order < self.updating);
        let mut flags = flag::FIRST_TICK;
        for (bit, on) in
            [(flag::AVATAR, is_avatar), (flag::ORIENTED, traits.is_oriented), (flag::FROZEN, order.is_none())]
        {
            flags |= if on { bit } else { 0 };
        }
        let sprite = Sprite {
            rect,
            // The first sprite of a type keeps the unscaled size until its first update.
            last: if first && !due { Rect { x, y, w: block, h: block } } else { rect },
            orientation: traits.orientation,
            speed: traits.speed,
            id: self.state.next_id,
            moved_at: match order {
                None => 0,
                Some(_) => self.state.tick - i32::from(due),
            },
            health: traits.health,
            max_health: traits.max_health,
            time_to_live: traits.time_to_live,
            count: traits.age,
            start: traits.start,
            spawns: traits.stypes.first().copied().unwrap_or(SpriteType::NONE),
            extra: NONE,
            stype,
            flags,
            heading: sprites::NO_HEADING,
            next: NONE,
            previous: NONE,
            cell_next: NONE,
            cell_previous: NONE,
            column: 0,
            row: 0,
        };
        if order.is_some_and(|order| order == self.updating) {
            self.stop(Limit::SpawnIntoUpdatedType);
            return None;
        }
        let Some(slot) = self.state.admit(sprite) else {
            self.stop(Limit::Sprites);
            return None;
        };
        self.state.next_id += 1;
        self.state.population += 1;
        if sprite.last != sprite.rect {
            self.mark_moved(slot);
        }
        Some(slot)
    }

    /// Kills: avatars are disabled and stay, others go at the end of the tick (`spec/03` §5.1).
    pub(crate) fn kill(&mut self, slot: Slot) {
        let sprite = self.state.sprite(slot);
        if !sprite.is(flag::AVATAR) {
            return self.remove(slot);
        }
        if sprite.is(flag::DISABLED) {
            return;
        }
        let age = self.age(slot);
        let stype = sprite.stype;
        let sprite = self.state.edit(slot);
        sprite.set(flag::DISABLED | flag::FROZEN, true);
        sprite.moved_at = age;
        self.state.groups[stype.index()].disabled += 1;
    }

    /// Kills for good, avatar or not.
    pub(crate) fn remove(&mut self, slot: Slot) {
        self.state.edit(slot).set(flag::KILLED, true);
        self.state.killed.push(slot);
    }

    /// The reference's `lastmove`: ticks since the last move, as it stands in this tick's update or events.
    pub(crate) fn age(&self, slot: Slot) -> i32 {
        let sprite = self.state.sprite(slot);
        if sprite.is(flag::FROZEN) { sprite.moved_at } else { self.state.tick - sprite.moved_at }
    }

    pub(crate) fn set_age(&mut self, slot: Slot, age: i32) {
        let tick = self.state.tick;
        let sprite = self.state.edit(slot);
        sprite.moved_at = if sprite.is(flag::FROZEN) { age } else { tick - age };
    }

    fn mark_moved(&mut self, slot: Slot) {
        let sprite = &mut self.state.sprites[usize::from(slot)];
        if !sprite.is(flag::MOVED) {
            sprite.set(flag::MOVED, true);
            self.state.moved.push(slot);
        }
    }

    /// Puts a sprite somewhere else, size included.
    pub(crate) fn place(&mut self, slot: Slot, rect: Rect) {
        if self.state.sprite(slot).rect == rect {
            return;
        }
        if rect.h == 0 {
            self.stop(Limit::FlatSprite);
        }
        self.state.leave_cell(slot);
        self.state.edit(slot).rect = rect;
        self.state.enter_cell(slot);
        self.mark_moved(slot);
    }

    pub(crate) fn set_last(&mut self, slot: Slot, last: Rect) {
        self.state.edit(slot).last = last;
        self.mark_moved(slot);
    }

    /// The basic step of `spec/01` §3.3: moves by `amount` pixels along `direction` unless the cooldown forbids.
    pub(crate) fn displace(&mut self, slot: Slot, direction: Direction, amount: i32) -> bool {
        let sprite = self.state.sprite(slot);
        let amount = if amount == 0 { sprite.speed as i32 } else { amount };
        let cooldown = self.rules.types[sprite.stype.index()].traits.cooldown;
        if amount == 0 || cooldown > self.age(slot) || direction.x.abs() + direction.y.abs() == 0.0 {
            return false;
        }
        let rect = sprite.rect;
        let shift = |component: f64| (component * f64::from(amount)) as i32;
        let (x, y) = (rect.x.wrapping_add(shift(direction.x)), rect.y.wrapping_add(shift(direction.y)));
        self.place(slot, rect.at(x, y));
        self.set_age(slot, 0);
        true
    }

    /// The game's screen, in pixels.
    pub(crate) fn screen(&self) -> Rect {
        let State { columns, rows, block, .. } = *self.state;
        Rect { x: 0, y: 0, w: columns * block, h: rows * block }
    }

    /// (x, y) of the displacement in this tick.
    pub(crate) fn last_direction(&self, slot: Slot) -> Direction {
        let Sprite { rect, last, .. } = *self.state.sprite(slot);
        Direction { x: f64::from(rect.x - last.x), y: f64::from(rect.y - last.y) }
    }
}
