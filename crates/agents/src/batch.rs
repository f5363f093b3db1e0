//! Steps many states of one game together, for learners that play many episodes in parallel and for planners
//! that try many futures of one state.
//!
//! Each state has its own random seed, and keeps its index on every thread, so no result depends on the number of
//! threads. Actions and results are slices, so one call replaces thousands of calls. Lanes are not reset
//! automatically, so the caller can inspect the last state of an episode before deciding how to continue.

use base::Seed;
use engine::{Action, Chance, Game, Level, Outcome, State};
use rayon::prelude::*;

/// The number of steps in one task. It is large enough to justify waking a thread, and small enough that no
/// thread waits long for the last task to finish.
const STEPS_OF_A_TASK: usize = 64;

/// A batch of states of one game, each with its current episode. A lane consists of the state and all other values at
/// one index.
///
/// Work is distributed over the current rayon pool. Fewer than a few hundred steps run on the calling thread.
///
/// # Examples
/// Each lane plays one episode after another:
///
/// ```
/// use infinite_arcade_agents::Batch;
/// # use base as infinite_arcade_base;
/// # use engine as infinite_arcade_engine;
/// use infinite_arcade_base::Seed;
/// use infinite_arcade_engine::{Action, Game, Outcome};
///
/// let game = Game::from_source("
/// BasicGame
///     SpriteSet
///         nut > Immovable
///         squirrel > MovingAvatar
///     LevelMapping
///         n > nut
///         S > squirrel
///     InteractionSet
///         nut squirrel > killSprite scoreChange=1
///     TerminationSet
///         SpriteCounter stype=nut win=True
///         Timeout limit=20 win=False
/// ")?;
/// let levels = [game.level("S n")?, game.level("S  n")?];
/// let mut batch = Batch::start(&game, &levels, 100, Seed::from_text("forest"))?;
///
/// batch.step(&[Action::Right; 100])?;
/// let outcomes = batch.step(&[Action::Right; 100])?;
/// assert_eq!(outcomes[..2], [Outcome::Won, Outcome::Ongoing]);
/// assert_eq!(batch.scores()[..2], [1.0, 0.0]);
/// assert_eq!(batch.reset_over(), 50);
/// assert_eq!(batch.outcomes()[..2], [Outcome::Ongoing, Outcome::Ongoing]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Each lane tries a different plan from the same state:
///
/// ```
/// # use infinite_arcade_agents::Batch;
/// # use base as infinite_arcade_base;
/// # use engine as infinite_arcade_engine;
/// # use infinite_arcade_base::Seed;
/// # use infinite_arcade_engine::{Action, Game};
/// # let game = Game::from_source("
/// # BasicGame
/// #     SpriteSet
/// #         nut > Immovable
/// #         squirrel > MovingAvatar
/// #     LevelMapping
/// #         n > nut
/// #         S > squirrel
/// #     InteractionSet
/// #         nut squirrel > killSprite scoreChange=1
/// #     TerminationSet
/// #         SpriteCounter stype=nut win=True
/// # ")?;
/// # let level = game.level("S n")?;
/// let state = game.start(&level, Seed::from_text("episode"));
/// let mut batch = Batch::fork(&game, &state, 2, Seed::from_text("imagined"));
/// batch.play(&[Action::Right, Action::Right, Action::Left, Action::Right])?;
/// assert_eq!(batch.scores(), [1.0, 0.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Batch {
    game: Game,
    seed: Seed,
    /// The initial states of episodes. Lane `i` starts from the state at index `i % roots.len()`. The list is never
    /// empty.
    roots: Vec<State>,
    states: Vec<State>,
    /// The number of previous episodes in each lane, whether finished or abandoned.
    episodes: Vec<u64>,
    outcomes: Vec<Outcome>,
    scores: Vec<f64>,
}

/// An error from a batch.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum BatchError {
    /// The list of levels is empty.
    #[error("a batch of episodes needs at least one level")]
    NoLevels,
    /// The number of actions differs from the number of states.
    #[error("{actions} actions were given for {lanes} states; pass one action for each state")]
    Actions {
        /// The number of actions passed.
        actions: usize,
        /// The number of states.
        lanes: usize,
    },
    /// The number of actions is not a multiple of the number of states.
    #[error(
        "{actions} actions cannot be divided into plans for {lanes} states; pass the same number of \
         actions for each state"
    )]
    Plans {
        /// The number of actions passed.
        actions: usize,
        /// The number of states.
        lanes: usize,
    },
    /// The lane does not exist.
    #[error("state {lane} does not exist; there are {lanes} states, counted from 0")]
    NoLane {
        /// The lane's index.
        lane: usize,
        /// The number of states.
        lanes: usize,
    },
}

impl Batch {
    /// Starts an episode in each of `lanes` lanes. Lane `i` always plays level `i % levels.len()`.
    ///
    /// # Errors
    ///
    /// Returns an error if `levels` is empty.
    pub fn start(game: &Game, levels: &[Level], lanes: usize, seed: Seed) -> Result<Batch, BatchError> {
        if levels.is_empty() {
            return Err(BatchError::NoLevels);
        }
        let roots = levels.iter().map(|level| game.start(level, seed)).collect();
        Ok(Batch::of(game, roots, lanes, seed))
    }

    /// Copies a state of this game `lanes` times, each with its own random seed. See [`State::fork`].
    pub fn fork(game: &Game, state: &State, lanes: usize, seed: Seed) -> Batch {
        Batch::of(game, vec![state.clone()], lanes, seed)
    }

    fn of(game: &Game, roots: Vec<State>, lanes: usize, seed: Seed) -> Batch {
        let states: Vec<State> = roots.iter().cycle().take(lanes).cloned().collect();
        let (outcomes, scores) = states.iter().map(|state| (state.outcome(), state.score())).unzip();
        let mut batch =
            Batch { game: game.clone(), seed, roots, states, episodes: vec![0; lanes], outcomes, scores };
        batch.begin(|_| true);
        batch
    }

    /// Replaces all episodes with futures of `state`, like [`Batch::fork`]. Does not allocate once the buffers are
    /// large enough.
    pub fn fork_from(&mut self, state: &State, seed: Seed) {
        self.roots.truncate(1);
        self.roots[0].clone_from(state);
        self.seed = seed;
        self.episodes.fill(0);
        self.begin(|_| true);
    }

    /// Returns the number of states.
    pub fn len(&self) -> usize {
        self.states.len()
    }

    /// Returns `true` if there are no states.
    pub fn is_empty(&self) -> bool {
        self.states.is_empty()
    }

    /// Returns the game that all lanes play.
    pub fn game(&self) -> &Game {
        &self.game
    }

    /// Returns the states, indexed by lane.
    pub fn states(&self) -> &[State] {
        &self.states
    }

    /// Returns the current outcome of each episode, indexed by lane.
    pub fn outcomes(&self) -> &[Outcome] {
        &self.outcomes
    }

    /// Returns the scores, indexed by lane.
    pub fn scores(&self) -> &[f64] {
        &self.scores
    }

    /// Returns the seed of a lane's current episode. In a batch that plays levels, [`Game::start`] with this
    /// seed and the same actions produces the same states.
    ///
    /// # Errors
    ///
    /// Returns an error if the lane does not exist.
    pub fn seed(&self, lane: usize) -> Result<Seed, BatchError> {
        let episode = self.episodes.get(lane).ok_or(BatchError::NoLane { lane, lanes: self.len() })?;
        Ok(seed_of(self.seed, lane, *episode))
    }

    /// Plays one tick in every lane, with one action per lane. Finished episodes remain unchanged.
    ///
    /// # Errors
    ///
    /// Returns an error and plays nothing if the number of actions differs from the number of states.
    pub fn step(&mut self, actions: &[Action]) -> Result<&[Outcome], BatchError> {
        if actions.len() != self.len() {
            return Err(BatchError::Actions { actions: actions.len(), lanes: self.len() });
        }
        self.play(actions)
    }

    /// Plays a plan in every lane. All plans have the same length. The layout of `plans` is `[lane][tick]`, one plan
    /// after another. The results are the same as if [`Batch::step`] were called once per tick. However, `play` is
    /// faster, because the threads synchronise only once instead of in every tick.
    ///
    /// # Errors
    ///
    /// Returns an error and plays nothing if the number of actions is not a multiple of the number of states.
    pub fn play(&mut self, plans: &[Action]) -> Result<&[Outcome], BatchError> {
        let ticks = plans.len().checked_div(self.len()).unwrap_or(0);
        if ticks * self.len() != plans.len() {
            return Err(BatchError::Plans { actions: plans.len(), lanes: self.len() });
        }
        if ticks > 0 {
            let (game, task) = (&self.game, STEPS_OF_A_TASK.div_ceil(ticks));
            (&mut self.states, plans.par_chunks_exact(ticks), &mut self.outcomes, &mut self.scores)
                .into_par_iter()
                .with_min_len(task)
                .with_max_len(task)
                .for_each(|(state, plan, outcome, score)| {
                    plan.iter().for_each(|&action| *outcome = game.step(state, action));
                    *score = state.score();
                });
        }
        Ok(&self.outcomes)
    }

    /// Starts a new episode in a lane, with a new random seed.
    ///
    /// # Errors
    ///
    /// Returns an error if the lane does not exist.
    pub fn reset(&mut self, lane: usize) -> Result<(), BatchError> {
        let lanes = self.len();
        *self.episodes.get_mut(lane).ok_or(BatchError::NoLane { lane, lanes })? += 1;
        let chance = Chance::from_seed(self.seed(lane)?);
        let root = &self.roots[lane % self.roots.len()];
        self.states[lane].fork_from(root, chance);
        (self.outcomes[lane], self.scores[lane]) = (root.outcome(), root.score());
        Ok(())
    }

    /// Starts a new episode in every lane whose episode is over, and returns the number of restarted lanes.
    /// If `reset_over` is called after every step, no lane is ever idle. A level that is over before its
    /// first tick is restarted in each call.
    pub fn reset_over(&mut self) -> usize {
        let over = |outcome: &Outcome| *outcome != Outcome::Ongoing;
        let mut count = 0;
        for (episode, outcome) in self.episodes.iter_mut().zip(&self.outcomes) {
            *episode += u64::from(over(outcome));
            count += usize::from(over(outcome));
        }
        self.begin(over);
        count
    }

    /// Resets every lane whose outcome satisfies `whose` to the start of its current episode.
    fn begin(&mut self, whose: impl Fn(&Outcome) -> bool + Sync) {
        let (seed, roots) = (self.seed, &self.roots);
        (&mut self.states, &self.episodes, &mut self.outcomes, &mut self.scores)
            .into_par_iter()
            .with_min_len(STEPS_OF_A_TASK)
            .enumerate()
            .filter(|(_, (_, _, outcome, _))| whose(outcome))
            .for_each(|(lane, (state, episode, outcome, score))| {
                let root = &roots[lane % roots.len()];
                state.fork_from(root, Chance::from_seed(seed_of(seed, lane, *episode)));
                (*outcome, *score) = (root.outcome(), root.score());
            });
    }
}

fn seed_of(seed: Seed, lane: usize, episode: u64) -> Seed {
    seed.child("lane", lane as u64).child("episode", episode)
}
