//! Starts and steps episodes.

use crate::game::{Compiled, Game};
use crate::level::Level;
use crate::numbers::chance::Chance;
use crate::rules::{Action, Outcome};
use crate::schedule::{Foresight, Schedule};
use crate::state::State;
use crate::tick::{Step, Unscheduled, Watch};
use crate::world::{Timer, World};
use base::Seed;

impl Game {
    /// Returns the state before the first tick. The seed affects only the game's random numbers.
    pub fn start(&self, level: &Level, seed: Seed) -> State {
        self.start_with(level, Chance::from_seed(seed))
    }

    /// Starts an episode like [`Game::start`], but with a given random number generator, such as the one
    /// recorded in a trace.
    pub fn start_with(&self, level: &Level, chance: Chance) -> State {
        let rules = &self.0.rules;
        let mut world =
            World::empty(rules, &self.0.models, (level.columns() as i32, level.rows() as i32), chance);
        world.add_messages(level.messages);
        let schedule = Schedule::empty(&self.0.plan, &world);
        let mut state = State { world, schedule };
        let block = state.world.block();
        let mut step = Step { updating: -1, ..self.scheduled(&mut state) };
        for (at, &symbol) in level.cells().iter().enumerate() {
            let (column, row) = ((at % level.columns()) as i32, (at / level.columns()) as i32);
            for &stype in self.places(symbol) {
                step.add(stype, column * block, row * block);
            }
        }
        step.remove_extra_avatars();
        step.find_avatar();
        if let Some(limit) = step.stopped {
            state.world.end(Outcome::Stopped(limit));
        }
        for (at, timed) in rules.timed.iter().enumerate() {
            if let Some(due) = timed.first_due {
                state.world.plan(Timer { due, timed: at as u16 });
            }
        }
        if rules.finds_paths {
            state.world.mark_obstacles(rules);
        }
        state.settle_hash();
        state
    }

    /// Plays one tick. Does nothing once the episode is over. An action that is not available to the avatar
    /// counts as [`Action::Nil`].
    ///
    /// Does not allocate once the state's buffers have grown.
    pub fn step(&self, state: &mut State, action: Action) -> Outcome {
        self.step_scheduled(state, action, &mut ())
    }

    /// Plays one tick like [`Game::step`], and reports each executed interaction to `watch`.
    pub fn step_watched(&self, state: &mut State, action: Action, watch: &mut dyn Watch) -> Outcome {
        self.step_scheduled(state, action, watch)
    }

    fn step_scheduled(
        &self,
        state: &mut State,
        action: Action,
        watch: &mut (impl Watch + ?Sized),
    ) -> Outcome {
        if state.is_over() {
            return state.world.outcome();
        }
        let action = self.allowed(state, action);
        let mut step = self.scheduled(state);
        step.cycle(action, watch);
        watch.worked(step.work);
        state.world.outcome()
    }

    fn scheduled<'a>(&'a self, state: &'a mut State) -> Step<'a, Foresight<'a>> {
        let Compiled { rules, models, plan } = &*self.0;
        let foresight = Foresight::new(plan, &mut state.schedule, &state.world);
        Step::new(rules, models, &mut state.world, foresight)
    }

    /// Plays one tick like [`Game::step`], but without the scheduler: the plain cycle of `spec/01` §4. Tests
    /// compare this method with the scheduled step. This method counts more work towards the limit, and takes
    /// O(sprites + cells) more time.
    #[doc(hidden)]
    pub fn step_unscheduled(&self, state: &mut State, action: Action, watch: &mut impl Watch) -> Outcome {
        if state.is_over() {
            return state.world.outcome();
        }
        let action = self.allowed(state, action);
        Schedule::suspend(&mut self.scheduled(state));
        let Compiled { rules, models, plan } = &*self.0;
        let mut step = Step::new(rules, models, &mut state.world, Unscheduled);
        step.cycle(action, watch);
        watch.worked(step.work);
        state.schedule = Schedule::of(plan, models, &mut state.world);
        state.world.outcome()
    }

    fn allowed(&self, state: &State, action: Action) -> Action {
        if self.allows(state, action) { action } else { Action::Nil }
    }
}
