//! One step of a game: the cycle of `spec/01` §4, and the operations on sprites that the ontology is written in.

use crate::Seed;
use crate::chance::Chance;
use crate::game::{Action, EffectInfo, Game, Limit, Outcome, Rules, SpriteType};
use crate::geometry::{Direction, Rect};
use crate::level::Level;
use crate::limits::{EFFECT_WORK, MAX_HELD, MAX_MESSAGES, MAX_SPRITES, MAX_TICKS, MAX_WORK};
use crate::ontology::class::SpriteClass;
use crate::ontology::traits::Traits;
use crate::ontology::{avatars, sprites};
use crate::state::{Group, NONE, Slot, Sprite, State, Timer, flag};

/// Pixels of the longer side of a board whose game does not set `square_size`.
const SCREEN: i32 = 800;

/// Learns what happens inside a step: which interaction of the description was executed on which sprites.
pub trait Watch {
    /// Interaction `line` (index into [`Description::interactions`](crate::Description)) was executed.
    fn interaction(&mut self, line: usize);

    /// The step is over and was so much work, see [`MAX_WORK`].
    fn worked(&mut self, _work: usize) {}
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
    /// Work so far, see [`MAX_WORK`].
    pub(crate) work: usize,
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
        let block = rules.square_size.unwrap_or_else(|| 2.max(SCREEN / columns.max(rows)));
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
            can_end: rules.can_end,
            sprite_hash: 0,
            sprites: Vec::new(),
            groups: vec![Group::EMPTY; rules.types.len()],
            cells: vec![NONE; State::cell_count(columns, rows)],
            moved: Vec::new(),
            stale: Vec::new(),
            killed: Vec::new(),
            held: Vec::new(),
            memory: rules.effects.iter().map(EffectInfo::initial_memory).collect(),
            templates: vec![false; rules.types.len()],
            shields: Vec::new(),
            pulled: Vec::new(),
            extras: Vec::new(),
            timers: Vec::new(),
            obstacles: Vec::new(),
            sideways: false,
            counters: vec![0; rules.counters],
            replaced: Vec::new(),
            jumps: chance,
        };
        let mut step = Step { rules, state: &mut state, updating: -1, stopped: None, work: 0 };
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
        if rules.finds_paths {
            state.mark_obstacles(rules);
        }
        state.freshen();
        state
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
        let mut step = Step { rules: &self.0, state, updating: i32::MAX, stopped: None, work: 0 };
        step.cycle(if allowed { action } else { Action::Nil }, watch);
        watch.worked(step.work);
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
            // The loss is the avatar's: without one, the reference dies.
            let gone = self.state.avatar == NONE;
            self.state.outcome = if gone { Outcome::Stopped(Limit::NoAvatar) } else { Outcome::Lost };
        }
    }

    /// The last rectangle becomes the rectangle. The reference does so for every sprite before its own update; only
    /// those that moved since can tell the difference, and nothing reads another's last rectangle before the events.
    fn settle_moved(&mut self) {
        let mut moved = std::mem::take(&mut self.state.moved);
        moved.retain(|&slot| {
            let sprite = self.state.sprite(slot);
            let (back, settles) = (sprite.last == sprite.rect, !sprite.is(flag::FROZEN));
            if settles && !back {
                let sprite = self.state.edit(slot);
                sprite.last = sprite.rect;
            }
            let keep = !settles && !back;
            self.state.sprites[usize::from(slot)].set(flag::MOVED, keep);
            keep
        });
        self.state.moved = moved;
    }

    /// Whether the sprite's class is an avatar's; what the sprite passes for is [`flag::AVATAR`].
    pub(crate) fn can_be_played(&self, slot: Slot) -> bool {
        self.rules.types[self.state.sprite(slot).stype.index()].class.is_some_and(SpriteClass::is_avatar)
    }

    fn update(&mut self, action: Action) {
        let avatar = self.state.avatar;
        if avatar != NONE && !self.state.sprite(avatar).is(flag::DISABLED) {
            let stype = self.state.sprite(avatar).stype;
            self.turn_picture(&self.rules.types[stype.index()].traits, avatar);
            avatars::update(self, avatar, action);
        }
        for at in 0..self.rules.movers.len() {
            let stype = self.rules.movers[at];
            let info = &self.rules.types[stype.index()];
            self.updating = i32::from(info.order.expect("movers are in the update order"));
            let mut slot = self.state.group(stype).head;
            while slot != NONE {
                self.work(1);
                self.turn_picture(&info.traits, slot);
                sprites::update(self, slot);
                if self.stopped.is_some() {
                    return;
                }
                slot = self.state.sprite(slot).next;
            }
        }
        self.updating = -1;
    }

    /// The reference looks for the picture of a sprite's orientation before each update, and throws if there is none.
    fn turn_picture(&mut self, traits: &Traits, slot: Slot) {
        if traits.oriented_image && !Direction::BASE.contains(&self.state.sprite(slot).orientation) {
            self.stop(Limit::UnfitSprite);
        }
    }

    /// The player's avatar: of the sprites of avatar classes, by update order, the last one made of the first type
    /// (`spec/01` §4.2; a single avatar is what checked levels have).
    fn find_avatar(&mut self) {
        let types = self.rules.order.iter().skip(1).rev();
        let slots = types.flat_map(|&stype| self.state.slots(stype));
        let avatar = slots.filter(|&slot| self.state.sprite(slot).is(flag::AVATAR)).last();
        match avatar {
            Some(slot) if !self.can_be_played(slot) => self.stop(Limit::UnfitSprite),
            Some(slot) => self.control(slot),
            // The reference looks when it builds the level, and again when the run starts.
            None => (0..2).for_each(|_| self.message()),
        }
    }

    /// The reference removes all avatars but the first made, with a message; checked levels have one.
    fn remove_extra_avatars(&mut self) {
        let slots = 0..self.state.sprites.len() as Slot;
        let counts = |slot: &Slot| self.state.sprite(*slot).is(flag::AVATAR) || self.can_be_played(*slot);
        let avatars: Vec<Slot> = slots.filter(counts).collect();
        let Some((_, extra @ [_, ..])) = avatars.split_first() else { return };
        self.message();
        for &slot in extra {
            self.state.release(slot);
        }
        self.state.forget_gone();
    }

    /// Makes a sprite the player's: from now on it is updated, and ages, and the one before is not and does not.
    pub(crate) fn control(&mut self, slot: Slot) {
        let before = std::mem::replace(&mut self.state.avatar, slot);
        if before != NONE && before != slot && !self.state.sprite(before).is(flag::FROZEN) {
            self.freeze(before);
        }
        let tick = self.state.tick;
        let sprite = self.state.edit(slot);
        if sprite.is(flag::FROZEN) && !sprite.is(flag::DISABLED) {
            sprite.set(flag::FROZEN, false);
            sprite.moved_at = tick.wrapping_sub(sprite.moved_at);
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
            self.state.forget_gone();
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
                let won = termination.wins(self.state);
                self.state.outcome = if won { Outcome::Won } else { Outcome::Lost };
                return;
            }
        }
    }

    /// Stops the episode: what happened makes the reference engine throw, or met a limit of ours.
    pub(crate) fn stop(&mut self, limit: Limit) {
        self.stopped.get_or_insert(limit);
    }

    /// Counts sprites or cells that are looked at; too many of them in one tick stop the episode.
    pub(crate) fn work(&mut self, amount: usize) {
        self.work = self.work.saturating_add(amount);
        if self.work > MAX_WORK {
            self.stop(Limit::Work);
        }
    }

    /// Counts an execution of an effect.
    pub(crate) fn work_of_effect(&mut self) {
        self.work(EFFECT_WORK);
    }

    /// [`State::add_amount`], within the limit.
    pub(crate) fn add_amount(&mut self, holder: Slot, resource: SpriteType, change: i32) {
        self.state.add_amount(holder, resource, change);
        if self.state.held.len() > MAX_HELD {
            self.stop(Limit::Resources);
        }
    }

    pub(crate) fn message(&mut self) {
        self.state.messages = self.state.messages.saturating_add(1);
    }

    /// Makes a sprite unless a singleton of its line exists or there are too many (`spec/01` §3.5).
    pub(crate) fn add(&mut self, stype: SpriteType, x: i32, y: i32) -> Option<Slot> {
        let rules = self.rules;
        if self.is_full() {
            return None;
        }
        let path = rules.types.get(stype.index()).map_or(&[][..], |info| &info.path);
        for &ancestor in path {
            if rules.types[ancestor.index()].singleton && self.state.count(rules, ancestor) > 0 {
                return None;
            }
        }
        self.make(stype, x, y)
    }

    /// Makes a sprite whatever singletons there are.
    pub(crate) fn add_forced(&mut self, stype: SpriteType, x: i32, y: i32) -> Option<Slot> {
        if self.is_full() { None } else { self.make(stype, x, y) }
    }

    /// Whether there are too many sprites for another one; a message if so.
    fn is_full(&mut self) -> bool {
        let full = self.state.population > MAX_SPRITES as i32;
        if full {
            self.message();
        }
        full
    }

    fn make(&mut self, stype: SpriteType, x: i32, y: i32) -> Option<Slot> {
        let info = self.rules.types.get(stype.index());
        let Some((info, class)) = info.and_then(|info| Some((info, info.class?))) else {
            self.stop(Limit::NoType);
            return None;
        };
        if info.incomplete {
            self.stop(Limit::UnfitSprite);
        }
        let traits = &info.traits;
        let block = self.state.block;
        let scaled = |factor: f64| (f64::from(block) * factor) as i32;
        let rect = Rect { x, y, w: scaled(traits.width_factor), h: scaled(traits.height_factor) };
        let first = !std::mem::replace(&mut self.state.templates[stype.index()], true);
        if !first && rect.h == 0 {
            self.stop(Limit::FlatSprite);
        }
        if first {
            self.state.messages = self.state.messages.saturating_add(info.unknown_parameters);
        }
        // Sprites of avatar classes are updated, and age, only as the player's.
        let order = info.order.map(i32::from).filter(|_| !class.is_avatar());
        // Still to be updated in this tick: then its age will be 1 at that update.
        let due = order.is_some_and(|order| order < self.updating);
        let flags = [
            (flag::AVATAR, traits.is_avatar),
            (flag::FROM_AVATAR, traits.is_from_avatar),
            (flag::ON_GROUND, traits.on_ground),
            (flag::FIRST_TICK, traits.is_first_tick),
            (flag::ORIENTED, traits.is_oriented),
            (flag::FROZEN, order.is_none()),
        ];
        let flags = flags.into_iter().fold(0, |all, (bit, on)| if on { all | bit } else { all });
        let sprite = Sprite {
            rect,
            // The first sprite of a type keeps the unscaled size until its first update.
            last: if first && !due { Rect { x, y, w: block, h: block } } else { rect },
            orientation: traits.orientation,
            speed: traits.speed,
            id: self.state.next_id,
            moved_at: match order {
                None => traits.last_move,
                Some(_) => (self.state.tick - i32::from(due)).wrapping_sub(traits.last_move),
            },
            health: traits.health,
            max_health: traits.max_health,
            time_to_live: traits.time_to_live,
            count: traits.age,
            start: traits.start,
            spawns: match class {
                // A copy of the first one has forgotten what it leaves behind, and leaves what has the number 0: wall.
                SpriteClass::OngoingTurningAvatar if !first => SpriteType(0),
                SpriteClass::OngoingTurningAvatar => traits.spawn_behind.unwrap_or(SpriteType(0)),
                _ => traits.stypes.first().copied().unwrap_or(SpriteType::NONE),
            },
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
        if !self.can_be_played(slot) {
            return self.remove(slot);
        }
        let sprite = self.state.sprite(slot);
        if sprite.is(flag::DISABLED) {
            return;
        }
        let stype = sprite.stype;
        self.freeze(slot);
        self.state.edit(slot).set(flag::DISABLED, true);
        self.state.groups[stype.index()].disabled += 1;
    }

    /// The sprite is not updated any more, and stays as old as it is.
    fn freeze(&mut self, slot: Slot) {
        let age = self.age(slot);
        let sprite = self.state.edit(slot);
        sprite.set(flag::FROZEN, true);
        sprite.moved_at = age;
    }

    /// Kills for good, avatar or not.
    pub(crate) fn remove(&mut self, slot: Slot) {
        self.state.edit(slot).set(flag::KILLED, true);
        self.state.killed.push(slot);
    }

    /// The reference's `lastmove`: ticks since the last move, as it stands in this tick's update or events.
    pub(crate) fn age(&self, slot: Slot) -> i32 {
        let sprite = self.state.sprite(slot);
        // The reference counts on beyond the largest number, too.
        if sprite.is(flag::FROZEN) { sprite.moved_at } else { self.state.tick.wrapping_sub(sprite.moved_at) }
    }

    pub(crate) fn set_age(&mut self, slot: Slot, age: i32) {
        let tick = self.state.tick;
        let sprite = self.state.edit(slot);
        sprite.moved_at = if sprite.is(flag::FROZEN) { age } else { tick.wrapping_sub(age) };
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
        if rect.h == 0 {
            self.stop(Limit::FlatSprite);
        }
        if self.state.sprite(slot).rect == rect {
            return;
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
        Direction { x: f64::from(rect.x.wrapping_sub(last.x)), y: f64::from(rect.y.wrapping_sub(last.y)) }
    }
}
