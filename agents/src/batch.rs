//! Many states of one game, stepped together: for learners that play many episodes at once, and for planners that try many
//! futures of one state.
//!
//! Each state plays by itself, with a chance of its own, and is found under the same number whoever steps it: no result
//! depends on the number of threads. Actions go in and results come out as slices, so that one call does the work of a
//! thousand. What to do next is the caller's choice: nothing is reset that nobody asked to reset, and the last state of
//! an episode can be looked at.

use engine::{Action, Game, Level, Outcome, Seed, State};
use rayon::prelude::*;

/// Steps that a thread takes on at a time: many enough to be worth its waking, few enough that none waits long for the
/// last one to finish.
const STEPS_OF_A_TASK: usize = 64;

/// States of one game, each with the episode that it is in. Those of one number are called a lane.
///
/// Work is spread over the current rayon pool; fewer than some hundred steps are played where they are asked for.
///
/// # Examples
/// Episodes, one after the other in each lane:
///
/// ```
/// use agents::Batch;
/// use engine::{Action, Game, Outcome, Seed};
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
/// Futures of one state, each by a plan of its own:
///
/// ```
/// # use agents::Batch;
/// # use engine::{Action, Game, Seed};
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
    /// What episodes begin with: those of lane `i` with the one of number `i % roots.len()`. Never empty.
    roots: Vec<State>,
    states: Vec<State>,
    /// How many episodes have ended or been given up before this one.
    episodes: Vec<u64>,
    outcomes: Vec<Outcome>,
    scores: Vec<f64>,
}

/// What a batch cannot do.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BatchError {
    /// There is nothing to play.
    #[error("a batch of episodes needs at least one level")]
    NoLevels,
    /// Not one action for every state.
    #[error("{actions} actions are given for {lanes} states; give one for each")]
    Actions {
        /// So many are given.
        actions: usize,
        /// So many states there are.
        lanes: usize,
    },
    /// Not equally many actions for every state.
    #[error("{actions} actions are no plans for {lanes} states; give equally many for each")]
    Plans {
        /// So many are given.
        actions: usize,
        /// So many states there are.
        lanes: usize,
    },
    /// No state has that number.
    #[error("there is no state {lane} among {lanes}; count from 0")]
    NoLane {
        /// The number.
        lane: usize,
        /// So many states there are.
        lanes: usize,
    },
}

impl Batch {
    /// Episodes at their start, in so many lanes. The levels take turns: lane `i` always plays number `i % levels.len()`.
    ///
    /// # Errors
    /// Without a level.
    pub fn start(game: &Game, levels: &[Level], lanes: usize, seed: Seed) -> Result<Batch, BatchError> {
        if levels.is_empty() {
            return Err(BatchError::NoLevels);
        }
        let roots = levels.iter().map(|level| game.start(level, seed)).collect();
        Ok(Batch::of(game, roots, lanes, seed))
    }

    /// So many futures of a state of this game: copies of it, each with another chance, see [`State::fork`].
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

    /// Gives up all episodes for futures of this state, see [`Batch::fork`]. Allocates nothing once the buffers have grown
    /// to its size.
    pub fn fork_from(&mut self, state: &State, seed: Seed) {
        self.roots.truncate(1);
        self.roots[0].clone_from(state);
        self.seed = seed;
        self.episodes.fill(0);
        self.begin(|_| true);
    }

    /// How many states there are.
    pub fn len(&self) -> usize {
        self.states.len()
    }

    /// Whether there are no states at all.
    pub fn is_empty(&self) -> bool {
        self.states.is_empty()
    }

    /// The game that all play.
    pub fn game(&self) -> &Game {
        &self.game
    }

    /// The states, by lane.
    pub fn states(&self) -> &[State] {
        &self.states
    }

    /// How each episode stands, by lane.
    pub fn outcomes(&self) -> &[Outcome] {
        &self.outcomes
    }

    /// The scores, by lane.
    pub fn scores(&self) -> &[f64] {
        &self.scores
    }

    /// The seed of the episode that a lane is in. In a batch that plays levels, [`Game::start`] with it and the same actions
    /// give the same states.
    ///
    /// # Errors
    /// If there is no such lane.
    pub fn seed(&self, lane: usize) -> Result<Seed, BatchError> {
        let episode = self.episodes.get(lane).ok_or(BatchError::NoLane { lane, lanes: self.len() })?;
        Ok(seed_of(self.seed, lane, *episode))
    }

    /// Plays one tick in every lane: its own action, one a lane. Those that are over stay as they are.
    ///
    /// # Errors
    /// Unless there are as many actions as states; then nothing is played.
    pub fn step(&mut self, actions: &[Action]) -> Result<&[Outcome], BatchError> {
        if actions.len() != self.len() {
            return Err(BatchError::Actions { actions: actions.len(), lanes: self.len() });
        }
        self.play(actions)
    }

    /// Plays a plan in every lane, all equally long; `plans` is `[lane][tick]`, one plan after the other. The same as that
    /// many calls of [`Batch::step`], in less time: threads wait for each other once, not every tick.
    ///
    /// # Errors
    /// Unless there are equally many actions for every state; then nothing is played.
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

    /// Begins another episode in a lane, with another chance.
    ///
    /// # Errors
    /// If there is no such lane.
    pub fn reset(&mut self, lane: usize) -> Result<(), BatchError> {
        let lanes = self.len();
        *self.episodes.get_mut(lane).ok_or(BatchError::NoLane { lane, lanes })? += 1;
        let chance = self.seed(lane)?.chance();
        let root = &self.roots[lane % self.roots.len()];
        self.states[lane].fork_from(root, chance);
        (self.outcomes[lane], self.scores[lane]) = (root.outcome(), root.score());
        Ok(())
    }

    /// Begins another episode in every lane whose episode is over; how many these are. With a call after every step no
    /// lane ever rests. (A level that is over before its first tick is begun again each time.)
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

    /// Puts the lanes whose outcome is such at the start of their episode.
    fn begin(&mut self, whose: impl Fn(&Outcome) -> bool + Sync) {
        let (seed, roots) = (self.seed, &self.roots);
        (&mut self.states, &self.episodes, &mut self.outcomes, &mut self.scores)
            .into_par_iter()
            .with_min_len(STEPS_OF_A_TASK)
            .enumerate()
            .filter(|(_, (_, _, outcome, _))| whose(outcome))
            .for_each(|(lane, (state, episode, outcome, score))| {
                let root = &roots[lane % roots.len()];
                state.fork_from(root, seed_of(seed, lane, *episode).chance());
                (*outcome, *score) = (root.outcome(), root.score());
            });
    }
}

/// The seed of one episode of a lane.
fn seed_of(seed: Seed, lane: usize, episode: u64) -> Seed {
    seed.child("lane", lane as u64).child("episode", episode)
}
