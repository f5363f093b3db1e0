//! Lanes. A lane plays one episode of a game after another. Many lanes are stepped together, with their
//! observations in one buffer.
//!
//! Each lane plays independently, with its own seed. The results do not depend on the number of threads.

use crate::errors::{failed, invalid};
use crate::game::{Game, Level, Rules, outcome_name, seed_of};
use crate::picture;
use crate::state::State;
use base::Seed;
use engine::{Action, Chance, Drawn, Outcome, Planes};
use numpy::{PyReadonlyArray1, PyReadwriteArray1};
use pyo3::prelude::*;
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// The number of lanes per task in the thread pool.
const LANES_OF_A_TASK: usize = 64;

/// The rule that determines when a lane whose episode has ended starts a new one.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Autoreset {
    /// The next step starts a new episode and ignores its action.
    NextStep,
    /// The step that ends an episode also starts the next episode.
    SameStep,
    /// A lane whose episode has ended stays idle until it is reset.
    Disabled,
}

/// The format of an observation.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Sight {
    /// `[planes][rows][columns]`, with 1 in each cell that contains a sprite of the plane's type.
    Planes,
    /// `[rows][columns]`, with the ASCII code for each cell's topmost sprite. `Lanes.symbols` lists the
    /// characters.
    Symbols,
    /// `[height][width][3]`, an RGB image with the given number of pixels per cell.
    Rgb(u32),
}

/// The data shared by all lanes.
struct Setting {
    game: Game,
    roots: Vec<engine::State>,
    planes: Planes,
    columns: usize,
    rows: usize,
    sight: Sight,
    /// The sprite types in drawing order, each with the character that represents it on boards of symbols.
    characters: Vec<(usize, u8)>,
    max_steps: u64,
    autoreset: Autoreset,
}

/// A lane, with its current episode.
struct Lane {
    state: engine::State,
    root: usize,
    seed: Seed,
    /// The number of episodes started with this seed before the current one.
    episodes: u64,
    /// The seed of the current episode.
    current: Seed,
    steps: u64,
    is_over: bool,
    /// The score and outcome of the last finished episode. Callers need them if the step that ended it has
    /// already started the next episode.
    last: (f64, Outcome),
    drawn: Drawn,
}

/// The output of one lane's step.
struct Told<'a> {
    observation: &'a mut [u8],
    reward: &'a mut f64,
    terminated: &'a mut bool,
    truncated: &'a mut bool,
}

impl Setting {
    fn rules(&self) -> &Rules {
        &self.game.0
    }

    /// Returns the size of an observation, in bytes.
    fn size(&self) -> usize {
        match self.sight {
            Sight::Planes => self.planes.size(),
            Sight::Symbols => self.columns * self.rows,
            Sight::Rgb(cell) => self.columns * self.rows * (cell * cell * 3) as usize,
        }
    }

    fn shape(&self) -> Vec<usize> {
        match self.sight {
            Sight::Planes => vec![self.planes.types().len(), self.rows, self.columns],
            Sight::Symbols => vec![self.rows, self.columns],
            Sight::Rgb(cell) => vec![self.rows * cell as usize, self.columns * cell as usize, 3],
        }
    }

    /// Draws an observation from scratch.
    fn draw(&self, lane: &mut Lane, out: &mut [u8]) {
        match self.sight {
            Sight::Planes => self.planes.draw(&mut lane.state, &mut lane.drawn, out),
            Sight::Symbols => self.draw_symbols(&lane.state, out),
            Sight::Rgb(cell) => self.draw_pixels(&lane.state, cell, out),
        }
    }

    /// Draws an observation by updating the lane's previous observation.
    fn update(&self, lane: &mut Lane, out: &mut [u8]) {
        match self.sight {
            Sight::Planes => self.planes.update(&mut lane.state, &mut lane.drawn, out),
            _ => self.draw(lane, out),
        }
    }

    fn draw_symbols(&self, state: &engine::State, out: &mut [u8]) {
        out.fill(render::EMPTY as u8);
        for &(plane, character) in &self.characters {
            self.planes.visit(state, plane, |cell| out[cell] = character);
        }
    }

    fn draw_pixels(&self, state: &engine::State, cell: u32, out: &mut [u8]) {
        let image = picture::pixels(&self.rules().looks, state, cell).expect("the size was checked");
        let width = self.columns * cell as usize * 3;
        out.fill(0);
        for (row, line) in out.chunks_exact_mut(width).zip(image.pixels.chunks(image.width as usize)) {
            for (pixel, colour) in row.chunks_exact_mut(3).zip(line) {
                pixel.copy_from_slice(&colour.0);
            }
        }
    }

    /// Starts the next episode in a lane.
    fn begin(&self, lane: &mut Lane, out: &mut [u8]) {
        lane.current = lane.seed.child("episode", lane.episodes);
        lane.episodes += 1;
        self.start(lane, out);
    }

    /// Starts an episode in a lane with the lane's current seed.
    fn start(&self, lane: &mut Lane, out: &mut [u8]) {
        lane.state.fork_from(&self.roots[lane.root], Chance::from_seed(lane.current));
        (lane.steps, lane.is_over) = (0, false);
        self.draw(lane, out);
    }

    /// Plays one step in a lane. Returns `true` if the step ended an episode.
    fn step(&self, lane: &mut Lane, action: Action, told: Told<'_>, last: Option<&mut [u8]>) -> bool {
        (*told.reward, *told.terminated, *told.truncated) = (0.0, false, false);
        if lane.is_over {
            if self.autoreset == Autoreset::NextStep {
                self.begin(lane, told.observation);
            }
            return false;
        }
        let before = lane.state.score();
        let outcome = self.rules().game.step(&mut lane.state, action);
        lane.steps += 1;
        *told.reward = lane.state.score() - before;
        *told.terminated = outcome != Outcome::Ongoing;
        *told.truncated = !*told.terminated && lane.steps >= self.max_steps;
        lane.is_over = *told.terminated || *told.truncated;
        match last.filter(|_| lane.is_over) {
            Some(last) => {
                self.draw(lane, last);
                lane.last = (lane.state.score(), outcome);
                self.begin(lane, told.observation);
                true
            }
            None => {
                self.update(lane, told.observation);
                lane.is_over
            }
        }
    }
}

/// Many lanes of one game, stepped together.
#[pyclass(module = "infinite_arcade")]
pub(crate) struct Lanes {
    setting: Setting,
    lanes: Vec<Lane>,
    /// The actions, in index order.
    actions: Vec<Action>,
    /// The thread pool, or `None` to use the calling thread only.
    pool: Option<ThreadPool>,
}

#[pymethods]
impl Lanes {
    #[new]
    #[pyo3(signature = (levels, count, *, observation, cell, max_steps, autoreset, threads))]
    fn new(
        levels: Vec<Bound<'_, Level>>,
        count: usize,
        observation: &str,
        cell: u32,
        max_steps: u64,
        autoreset: &str,
        threads: usize,
    ) -> PyResult<Lanes> {
        let Some(first) = levels.first() else { return Err(invalid("there is no level to play")) };
        let game = first.get().game.clone();
        if levels.iter().any(|level| level.get().game.0.game.digest() != game.0.game.digest()) {
            return Err(invalid("all levels of a vector environment must belong to one game"));
        }
        if count == 0 || max_steps == 0 {
            return Err(invalid("an environment needs at least one lane and one step"));
        }
        let sight = match observation {
            "planes" => Sight::Planes,
            "symbols" => Sight::Symbols,
            "rgb" => Sight::Rgb(cell),
            _ => {
                let message =
                    format_args!("unknown observation `{observation}`; choose planes, symbols or rgb");
                return Err(invalid(message));
            }
        };
        let autoreset = match autoreset {
            "next-step" => Autoreset::NextStep,
            "same-step" => Autoreset::SameStep,
            "disabled" => Autoreset::Disabled,
            _ => return Err(invalid(format_args!("there is no autoreset mode `{autoreset}`"))),
        };
        let seed = Seed::from_text("unseeded");
        let roots: Vec<engine::State> =
            levels.iter().map(|level| game.0.game.start(&level.get().level, seed)).collect();
        let most = |size: fn(&engine::Level) -> usize| {
            levels.iter().map(|level| size(&level.get().level)).max().unwrap_or_default()
        };
        let (columns, rows) = (most(engine::Level::columns), most(engine::Level::rows));
        if let Sight::Rgb(cell) = sight {
            for root in &roots {
                picture::pixels(&game.0.looks, root, cell).map_err(invalid)?;
            }
        }
        let planes = Planes::new(&game.0.game, game.0.looks.shown(), columns, rows);
        let characters = characters(&game.0, &planes);
        if sight == Sight::Symbols && characters.is_none() {
            return Err(invalid("the game has more sprite types than there are ASCII characters"));
        }
        let characters = characters.unwrap_or_default();
        let lane = |number: usize| {
            let root = number % roots.len();
            let current = seed.child("lane", number as u64);
            let (state, last, drawn) = (roots[root].clone(), (0.0, Outcome::Ongoing), Drawn::default());
            Lane { state, root, seed: current, episodes: 0, current, steps: 0, is_over: false, last, drawn }
        };
        let lanes = (0..count).map(lane).collect();
        let actions = game.0.actions.clone();
        let setting = Setting { game, roots, planes, columns, rows, sight, characters, max_steps, autoreset };
        let pool = match threads {
            1 => None,
            _ => Some(ThreadPoolBuilder::new().num_threads(threads).build().map_err(failed)?),
        };
        Ok(Lanes { setting, lanes, actions, pool })
    }

    fn __len__(&self) -> usize {
        self.lanes.len()
    }

    /// The shape of one observation.
    #[getter]
    fn shape(&self) -> Vec<usize> {
        self.setting.shape()
    }

    /// The names of the planes' sprite types.
    #[getter]
    fn planes(&self) -> Vec<&str> {
        let game = &self.setting.rules().game;
        self.setting.planes.types().iter().map(|&stype| game.name(stype)).collect()
    }

    /// The seed of each lane's current episode.
    #[getter]
    fn seeds(&self) -> Vec<String> {
        self.lanes.iter().map(|lane| lane.current.to_string()).collect()
    }

    /// The index of each lane's level.
    #[getter]
    fn levels(&self) -> Vec<usize> {
        self.lanes.iter().map(|lane| lane.root).collect()
    }

    /// The state hash of each lane.
    #[getter]
    fn hashes(&self) -> Vec<String> {
        self.lanes.iter().map(|lane| lane.state.state_hash().to_string()).collect()
    }

    /// The current outcome of each lane.
    #[getter]
    fn outcomes(&self) -> Vec<&'static str> {
        self.lanes.iter().map(|lane| outcome_name(lane.state.outcome())).collect()
    }

    /// The current score of each lane.
    #[getter]
    fn scores(&self) -> Vec<f64> {
        self.lanes.iter().map(|lane| lane.state.score()).collect()
    }

    /// Returns the score and outcome of the last finished episode in a lane. They are needed for lanes that
    /// start the next episode in the same step.
    fn last(&self, lane: usize) -> PyResult<(f64, &'static str)> {
        let found = self.lanes.get(lane).ok_or_else(|| invalid("there is no such lane"))?;
        Ok((found.last.0, outcome_name(found.last.1)))
    }

    /// Returns a copy of a lane's state.
    fn state(&self, lane: usize) -> PyResult<State> {
        let found = self.lanes.get(lane).ok_or_else(|| invalid("there is no such lane"))?;
        Ok(State::new(self.setting.game.clone(), found.state.clone()))
    }

    /// Sets a lane's seed, from which the seeds of its episodes are derived. If `exact` is `true`, the next
    /// episode uses the seed itself.
    fn seed(&mut self, lane: usize, seed: &str, exact: bool) -> PyResult<()> {
        let found = self.lanes.get_mut(lane).ok_or_else(|| invalid("there is no such lane"))?;
        (found.seed, found.episodes) = (seed_of(seed), 0);
        if exact {
            found.current = found.seed;
        }
        Ok(())
    }

    /// Sets the seed of each lane `i` to `seed.child("lane", i)`.
    fn seed_all(&mut self, seed: &str) {
        let seed = seed_of(seed);
        for (number, lane) in self.lanes.iter_mut().enumerate() {
            (lane.seed, lane.episodes) = (seed.child("lane", number as u64), 0);
        }
    }

    /// Sets the level that a lane plays, starting with its next episode.
    fn choose(&mut self, lane: usize, level: usize) -> PyResult<()> {
        if level >= self.setting.roots.len() {
            return Err(invalid(format_args!("the environment has no level {level}")));
        }
        self.lanes.get_mut(lane).ok_or_else(|| invalid("there is no such lane"))?.root = level;
        Ok(())
    }

    /// Starts the next episode in each lane whose flag in `mask` is set, and writes the lane's observation.
    #[pyo3(signature = (mask, observations, exact = false))]
    fn reset(
        &mut self,
        py: Python<'_>,
        mask: PyReadonlyArray1<'_, bool>,
        mut observations: PyReadwriteArray1<'_, u8>,
        exact: bool,
    ) -> PyResult<()> {
        let (mask, out) = (mask.as_slice()?, observations.as_slice_mut()?);
        let Lanes { setting, lanes, pool, .. } = self;
        let size = setting.size();
        if mask.len() != lanes.len() || out.len() != lanes.len() * size {
            return Err(invalid("a flag and an observation are needed for each lane"));
        }
        py.detach(|| {
            let setting = &*setting;
            let begin = |((lane, &flag), out): ((&mut Lane, &bool), &mut [u8])| match (flag, exact) {
                (true, true) => setting.start(lane, out),
                (true, false) => setting.begin(lane, out),
                (false, _) => {}
            };
            match pool {
                None => lanes.iter_mut().zip(mask).zip(out.chunks_exact_mut(size)).for_each(begin),
                Some(pool) => pool.install(|| {
                    let lanes = lanes.par_iter_mut().with_min_len(LANES_OF_A_TASK);
                    lanes.zip(mask).zip(out.par_chunks_exact_mut(size)).for_each(begin);
                }),
            }
        });
        Ok(())
    }

    /// Plays one step in every lane. If lanes reset in the same step, `last` receives the last observations
    /// of the episodes that ended. Returns the number of episodes that ended.
    #[allow(clippy::too_many_arguments, reason = "each argument is an array")]
    fn step(
        &mut self,
        py: Python<'_>,
        actions: PyReadonlyArray1<'_, i64>,
        mut observations: PyReadwriteArray1<'_, u8>,
        mut rewards: PyReadwriteArray1<'_, f64>,
        mut terminated: PyReadwriteArray1<'_, bool>,
        mut truncated: PyReadwriteArray1<'_, bool>,
        mut last: Option<PyReadwriteArray1<'_, u8>>,
    ) -> PyResult<usize> {
        let Lanes { setting, lanes, pool, actions: named } = self;
        let (chosen, out, size) = (actions.as_slice()?, observations.as_slice_mut()?, setting.size());
        let (rewards, terminated) = (rewards.as_slice_mut()?, terminated.as_slice_mut()?);
        let truncated = truncated.as_slice_mut()?;
        let same_step = setting.autoreset == Autoreset::SameStep;
        let last = last.as_mut().map(|last| last.as_slice_mut()).transpose()?;
        let count = lanes.len();
        let of_each = [chosen.len(), rewards.len(), terminated.len(), truncated.len()];
        let lasts = last.as_ref().map(|last| last.len());
        if of_each.iter().any(|&length| length != count)
            || out.len() != count * size
            || lasts != same_step.then_some(count * size)
        {
            return Err(invalid(format_args!(
                "an action and an observation are needed for each of {count} lanes"
            )));
        }
        let is_known = |action: &i64| usize::try_from(*action).is_ok_and(|at| at < named.len());
        if let Some(wrong) = chosen.iter().find(|action| !is_known(action)) {
            return Err(invalid(format_args!(
                "action {wrong} is not one of the game's {} actions",
                named.len()
            )));
        }
        Ok(py.detach(|| {
            let (setting, named) = (&*setting, &*named);
            let play = |lane: &mut Lane, action: &i64, told: Told<'_>, last: Option<&mut [u8]>| {
                usize::from(setting.step(lane, named[*action as usize], told, last))
            };
            let task = |(lanes, first): (&mut [Lane], usize), told: Buffers<'_>| {
                let Buffers { out, rewards, terminated, truncated, mut last } = told;
                let mut ended = 0;
                let zipped = lanes
                    .iter_mut()
                    .zip(out.chunks_exact_mut(size))
                    .zip(rewards)
                    .zip(terminated)
                    .zip(truncated);
                for (number, ((((lane, observation), reward), terminated), truncated)) in zipped.enumerate() {
                    let told = Told { observation, reward, terminated, truncated };
                    let last = last.as_mut().map(|last| &mut last[number * size..][..size]);
                    ended += play(lane, &chosen[first + number], told, last);
                }
                ended
            };
            let whole = Buffers { out, rewards, terminated, truncated, last };
            match pool {
                None => task((lanes, 0), whole),
                Some(pool) => pool.install(|| {
                    whole.split(lanes, size).into_par_iter().map(|(lanes, told)| task(lanes, told)).sum()
                }),
            }
        }))
    }

    /// Plays steps without producing observations, in order to measure the speed. Draws the same actions as
    /// `cargo xtask bench --batch`. Returns the number of episodes that ended.
    fn step_blindly(
        &mut self,
        py: Python<'_>,
        actions: PyReadonlyArray1<'_, i64>,
        rounds: usize,
    ) -> PyResult<u64> {
        let chosen = actions.as_slice()?;
        let Lanes { setting, lanes, actions: named, .. } = self;
        let wrong = |action: &i64| usize::try_from(*action).map_or(true, |at| at >= named.len());
        if chosen.is_empty() || chosen.iter().any(wrong) {
            return Err(invalid("some of the actions do not exist in the game"));
        }
        Ok(py.detach(|| {
            let (game, mut at, mut ended) = (&setting.rules().game, 0, 0);
            for _ in 0..rounds {
                for lane in lanes.iter_mut() {
                    if game.step(&mut lane.state, named[chosen[at] as usize]) != Outcome::Ongoing {
                        lane.current = lane.seed.child("episode", lane.episodes);
                        lane.episodes += 1;
                        lane.state.fork_from(&setting.roots[lane.root], Chance::from_seed(lane.current));
                        ended += 1;
                    }
                    at = if at + 1 == chosen.len() { 0 } else { at + 1 };
                }
            }
            ended
        }))
    }
}

/// The output buffers for a step, or one task's parts of the buffers.
struct Buffers<'a> {
    out: &'a mut [u8],
    rewards: &'a mut [f64],
    terminated: &'a mut [bool],
    truncated: &'a mut [bool],
    last: Option<&'a mut [u8]>,
}

impl<'a> Buffers<'a> {
    /// Splits the lanes and buffers into tasks. Each task includes the index of its first lane.
    fn split<'l>(self, lanes: &'l mut [Lane], size: usize) -> Vec<((&'l mut [Lane], usize), Buffers<'a>)> {
        let count = lanes.len().div_ceil(LANES_OF_A_TASK);
        let mut lasts: Vec<Option<&mut [u8]>> = match self.last {
            Some(last) => last.chunks_mut(LANES_OF_A_TASK * size).map(Some).collect(),
            None => (0..count).map(|_| None).collect(),
        };
        let parts = lanes
            .chunks_mut(LANES_OF_A_TASK)
            .zip(self.out.chunks_mut(LANES_OF_A_TASK * size))
            .zip(self.rewards.chunks_mut(LANES_OF_A_TASK))
            .zip(self.terminated.chunks_mut(LANES_OF_A_TASK))
            .zip(self.truncated.chunks_mut(LANES_OF_A_TASK))
            .zip(lasts.drain(..))
            .enumerate();
        let part = |(number, (((((lanes, out), rewards), terminated), truncated), last))| {
            ((lanes, number * LANES_OF_A_TASK), Buffers { out, rewards, terminated, truncated, last })
        };
        parts.map(part).collect()
    }
}

/// Returns the planes in drawing order with their characters, without floors. Returns `None` if a character
/// is not ASCII.
fn characters(rules: &Rules, planes: &Planes) -> Option<Vec<(usize, u8)>> {
    let order = rules.game.drawing_order();
    let place = |stype: engine::SpriteType| order.iter().position(|&other| other == stype.0);
    let mut shown: Vec<(Option<usize>, usize, char)> = planes
        .types()
        .iter()
        .enumerate()
        .map(|(plane, &stype)| (place(stype), plane, rules.symbols.symbol(stype)))
        .filter(|&(_, _, symbol)| symbol != render::EMPTY)
        .collect();
    shown.sort_unstable();
    shown.into_iter().map(|(_, plane, symbol)| symbol.is_ascii().then_some((plane, symbol as u8))).collect()
}
