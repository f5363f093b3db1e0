//! One step of a game: the cycle of `spec/01` §4. The operations of the ontology on sprites are in `population.rs` and
//! `motion.rs`.

use crate::Seed;
use crate::chance::Chance;
use crate::game::{Action, EffectInfo, Game, Limit, Outcome, Rules, SpriteType};
use crate::geometry::Direction;
use crate::level::Level;
use crate::limits::{EFFECT_WORK, MAX_HELD, MAX_MESSAGES, MAX_TICKS, MAX_WORK};
use crate::ontology::sprites::{Mover, UpdateKind, npcs, producers};
use crate::ontology::traits::Traits;
use crate::ontology::{avatars, sprites};
use crate::sleep::mark;
use crate::state::{Group, NONE, Slot, State, Timer, flag};

/// The length in pixels of the longer side of a board whose game does not set `square_size`.
const SCREEN: i32 = 800;

/// An execution of an interaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Meeting {
    /// Index into [`Description::interactions`](crate::Description).
    pub line: usize,
    /// The type of the sprite that the effect acts on, before the effect.
    pub first: SpriteType,
    /// The type of its partner; `None` for the edge of the screen or the clock.
    pub second: Option<SpriteType>,
    /// The column and row of the cell with the first sprite's top-left corner.
    pub cell: (i32, i32),
}

/// An observer of a step: it is told about the executed interactions and their sprites.
pub trait Watch {
    /// Called when interaction `line` (index into [`Description::interactions`](crate::Description)) has been executed.
    /// An interaction that puts the same sprite back to the same place tick after tick is reported once.
    fn interaction(&mut self, line: usize);

    /// Returns `true` if [`Watch::meeting`] is to be called.
    fn wants_meetings(&self) -> bool {
        false
    }

    /// Called after [`Watch::interaction`] with the sprites of the execution. Not called for timed effects that run on no
    /// sprite.
    fn meeting(&mut self, _meeting: Meeting) {}

    /// Called at the end of the step with its work, see [`MAX_WORK`].
    fn worked(&mut self, _work: usize) {}
}

/// An observer that ignores everything and costs nothing.
impl Watch for () {
    fn interaction(&mut self, _: usize) {}
}

/// A step under way.
pub(crate) struct Step<'a> {
    pub(crate) rules: &'a Rules,
    pub(crate) state: &'a mut State,
    /// The place in the update order that is being updated; types with a lower place are still to come in this tick.
    pub(crate) updating: i32,
    /// The reason why the step was stopped, if it was.
    pub(crate) stopped: Option<Limit>,
    /// The work so far, see [`MAX_WORK`].
    pub(crate) work: usize,
    /// The creation number of the sprite that is being updated.
    pub(crate) updating_id: u32,
    /// The pass of the event phase; −1 before the first.
    pub(crate) pass: i32,
    /// `true` if sprites may sleep in this step.
    pub(crate) sleeps: bool,
    /// `true` if sprites may fly in this step.
    pub(crate) flies: bool,
    /// `true` if a sprite that may sleep or fly has moved by itself.
    pub(crate) any_moved: bool,
}

impl Game {
    /// The state before the first tick. The seed affects only the game's random numbers.
    pub fn start(&self, level: &Level, seed: Seed) -> State {
        self.start_with(level, seed.chance())
    }

    /// [`Game::start`] with a given random number generator, such as a trace's.
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
            sum: [0; 2],
            memory_hash: 0,
            memory_is_dirty: true,
            big: 0,
            off: 0,
            multi_cell_bits: 0,
            big_bits: 0,
            sprites: Vec::new(),
            contributions: Vec::new(),
            hash_classes: Vec::new(),
            groups: vec![Group::EMPTY; rules.types.len()],
            cells: vec![NONE; State::cell_count(columns, rows)],
            masks: Vec::new(),
            crowds: Vec::new(),
            covered: Vec::new(),
            left_behind: 0,
            vast: 0,
            together: Vec::new(),
            meets: Vec::new(),
            reasons: Vec::new(),
            possible: Vec::new(),
            moved: Vec::new(),
            resized: Vec::new(),
            dirty: Vec::new(),
            killed: Vec::new(),
            held: Vec::new(),
            memory: rules.effects.iter().map(EffectInfo::initial_memory).collect(),
            templates: vec![0; rules.types.len()],
            shields: Vec::new(),
            pulled: Vec::new(),
            overrides: rules.base_overrides.clone(),
            extras: Vec::new(),
            sleepers: Vec::new(),
            watched: vec![0; State::cell_count(columns, rows)],
            stamps: vec![-1; State::cell_count(columns, rows)],
            flights: Vec::new(),
            next_due: i32::MAX,
            census_changed: true,
            touched: Vec::new(),
            timers: Vec::new(),
            paths: None,
            scenery: None,
            counters: vec![0; rules.counters],
            replaced: Vec::new(),
            jumps: chance,
        };
        state.empty_contacts(&rules.contacts);
        let mut step = Step { updating: -1, ..Step::new(rules, &mut state) };
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
        state.settle_hash();
        state
    }

    /// Plays one tick. Does nothing once the episode is over; an action that the avatar does not have counts as
    /// [`Action::Nil`].
    ///
    /// Does not allocate once the state's buffers have grown.
    pub fn step(&self, state: &mut State, action: Action) -> Outcome {
        self.step_watched(state, action, &mut ())
    }

    /// [`Game::step`] with an observer of the executed interactions.
    pub fn step_watched(&self, state: &mut State, action: Action, watch: &mut impl Watch) -> Outcome {
        self.step_with(state, action, watch, false)
    }

    /// [`Game::step`] without shortcuts: every sprite is updated in every tick. Tests compare the optimised step with it.
    #[doc(hidden)]
    pub fn step_unoptimised(&self, state: &mut State, action: Action, watch: &mut impl Watch) -> Outcome {
        self.step_with(state, action, watch, true)
    }

    fn step_with(
        &self,
        state: &mut State,
        action: Action,
        watch: &mut impl Watch,
        unoptimised: bool,
    ) -> Outcome {
        if state.is_over() {
            return state.outcome;
        }
        let action = if self.allows(state, action) { action } else { Action::Nil };
        let mut step = Step::new(&self.0, state);
        step.prepare_shortcuts(unoptimised);
        step.cycle(action, watch);
        watch.worked(step.work);
        state.outcome
    }
}

impl<'a> Step<'a> {
    fn new(rules: &'a Rules, state: &'a mut State) -> Step<'a> {
        let (updating, updating_id, pass) = (i32::MAX, 0, -1);
        Step {
            rules,
            state,
            updating,
            updating_id,
            stopped: None,
            work: 0,
            pass,
            sleeps: false,
            flies: false,
            any_moved: false,
        }
    }

    fn cycle(&mut self, action: Action, watch: &mut impl Watch) {
        self.state.tick += 1;
        self.state.last_action = action;
        self.state.fly(self.rules);
        self.wake();
        self.settle_moved();
        self.update(action);
        if self.stopped.is_none() {
            self.events(watch);
        }
        if self.stopped.is_some() {
            self.wake_and_land_all();
        }
        self.pass = i32::MAX;
        self.clear();
        self.sleep_or_fly();
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
            // The avatar loses: without one, the reference crashes.
            let gone = self.state.avatar == NONE;
            self.state.outcome = if gone { Outcome::Stopped(Limit::NoAvatar) } else { Outcome::Lost };
        }
    }

    fn update(&mut self, action: Action) {
        let avatar = self.state.avatar;
        if avatar != NONE && !self.state.sprite(avatar).is(flag::DISABLED) {
            let stype = self.state.sprite(avatar).stype;
            if self.rules.types[stype.index()].traits.oriented_image {
                self.turn_picture(avatar);
            }
            avatars::update(self, avatar, action);
            if self.stopped.is_some() {
                return;
            }
        }
        let rules = self.rules;
        for mover in &rules.movers {
            let group = self.state.group(mover.stype);
            let (head, count, skipped) = (group.head, group.count, group.skipped);
            if count == 0 {
                continue;
            }
            self.updating = mover.order;
            self.updating_id = 0;
            self.work(usize::from(count));
            if self.stopped.is_some() {
                return;
            }
            if skipped == count && mover.update_kind != UpdateKind::Draws {
                continue;
            }
            let traits = &rules.types[mover.stype.index()].traits;
            let mut slot = head;
            while slot != NONE {
                if mover.update_kind == UpdateKind::Draws {
                    slot = producers::pass_over(self.state, traits, mover.threshold, slot);
                    if slot == NONE {
                        break;
                    }
                }
                let sprite = self.state.sprite(slot);
                let idle = match mover.update_kind {
                    UpdateKind::Moves => {
                        mover.may_fly && sprite.activity & mark::SKIPPED != 0
                            || sprites::stays(sprite, traits, self.state)
                    }
                    UpdateKind::Chooses => {
                        let waits = sprites::waits(sprite, traits, self.state);
                        if waits {
                            npcs::choose(self, slot, mover.class);
                            if self.stopped.is_some() {
                                return;
                            }
                        }
                        waits
                    }
                    UpdateKind::Draws => {
                        if sprite.flies() {
                            self.land_before_update(slot);
                        }
                        false
                    }
                    UpdateKind::Other => mover.may_fly && sprite.activity & mark::SKIPPED != 0,
                };
                if !idle {
                    self.update_one(slot, mover, traits);
                    if self.stopped.is_some() {
                        return;
                    }
                }
                slot = self.state.sprite(slot).next;
            }
        }
        self.updating = -1;
    }

    #[inline(always)]
    fn update_one(&mut self, slot: Slot, mover: &Mover, traits: &Traits) {
        self.updating_id = self.state.sprite(slot).id;
        if traits.oriented_image {
            self.turn_picture(slot);
        }
        match mover.update_kind {
            UpdateKind::Moves => sprites::base(self, slot),
            _ => sprites::update(self, slot, mover.class),
        }
        let sprite = &mut self.state.sprites[usize::from(slot)];
        let moved = mover.may_fly && self.flies && !sprite.is_back();
        sprite.activity = if moved { mark::MOVED } else { mark::NOTHING };
        self.any_moved |= moved;
    }

    /// Checks the orientation: the reference looks for a picture of the orientation before each update, and throws if
    /// there is none.
    fn turn_picture(&mut self, slot: Slot) {
        if !Direction::BASE.contains(&self.state.overrides(slot).orientation) {
            self.stop(Limit::UnfitSprite);
        }
    }

    /// Finds the player's avatar: the last sprite of an avatar class in update order, without the first drawn type
    /// (`spec/01` §4.2; checked levels have a single avatar).
    fn find_avatar(&mut self) {
        let types = self.rules.order.iter().skip(1).rev();
        let slots = types.flat_map(|&stype| self.state.slots(stype));
        let avatar = slots.filter(|&slot| self.state.sprite(slot).is(flag::AVATAR)).last();
        match avatar {
            Some(slot) if !self.can_be_played(slot) => self.stop(Limit::UnfitSprite),
            Some(slot) => self.control(slot),
            // The reference looks once when it builds the level, and again when the run starts.
            None => (0..2).for_each(|_| self.message()),
        }
    }

    /// Removes all avatars but the first made, with a message, as the reference does; checked levels have one.
    fn remove_extra_avatars(&mut self) {
        let slots = 0..self.state.sprites.len() as Slot;
        let counts = |slot: &Slot| self.state.sprite(*slot).is(flag::AVATAR) || self.can_be_played(*slot);
        let avatars: Vec<Slot> = slots.filter(counts).collect();
        let Some((_, extra @ [_, ..])) = avatars.split_first() else { return };
        self.message();
        for &slot in extra {
            self.state.release(self.rules, slot);
        }
        self.state.forget_gone();
    }

    /// Removes the sprites that were killed in this tick (`spec/01` §4.10).
    #[inline]
    fn clear(&mut self) {
        if !self.state.killed.is_empty() {
            self.clear_killed();
        }
        self.wake();
        self.state.shields.clear();
        self.state.pulled.clear();
    }

    fn terminate(&mut self) {
        // The last result still holds: all terminations but Timeouts count sprites.
        if !self.state.census_changed && self.state.tick < self.rules.first_timeout {
            return;
        }
        self.state.census_changed = false;
        for termination in &self.rules.terminations {
            if let Some(can_end) = termination.permits(self.rules, self.state) {
                // The terminations before it look again in the next tick.
                self.state.census_changed |= can_end != self.state.can_end;
                self.state.can_end = can_end;
            }
            if termination.holds(self.rules, self.state) {
                let won = termination.wins(self.state);
                self.state.outcome = if won { Outcome::Won } else { Outcome::Lost };
                return;
            }
        }
    }

    /// Stops the episode: the reference engine would throw, or a limit of this engine is exceeded.
    pub(crate) fn stop(&mut self, limit: Limit) {
        self.stopped.get_or_insert(limit);
    }

    /// Counts sprites or cells that have been looked at; too many of them in one tick stop the episode.
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

    /// [`State::add_amount`], with the limit on resources.
    pub(crate) fn add_amount(&mut self, holder: Slot, resource: SpriteType, change: i32) {
        self.state.add_amount(holder, resource, change);
        if self.state.held.len() > MAX_HELD {
            self.stop(Limit::Resources);
        }
    }

    pub(crate) fn message(&mut self) {
        self.state.messages = self.state.messages.saturating_add(1);
    }
}
