//! A batch of environments (*lanes* in the code), each of which plays one episode of a game after another. All
//! environments are stepped together, with their observations in one buffer.
//!
//! Each environment plays independently, with its own seed. The results do not depend on the number of threads.

use crate::errors::{failed, invalid};
use crate::game::{Level, outcome_name, seed_of};
use crate::lane::{Autoreset, Lane, Last, SavedLane, Setting, Sight, Told};
use crate::state::State;
use engine::Outcome;
use numpy::{PyReadonlyArray1, PyReadwriteArray1};
use pyo3::prelude::*;
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// The number of environments per task in the thread pool.
const LANES_OF_A_TASK: usize = 64;
/// The minimum number of environments for which a thread pool is faster than the calling thread alone.
const LANES_OF_A_POOL: usize = 4 * LANES_OF_A_TASK;

/// Many environments of one game, stepped together.
#[pyclass(module = "infinite_arcade")]
pub(crate) struct Lanes {
    setting: Setting,
    lanes: Vec<Lane>,
    /// The thread pool, or `None` to use the calling thread only.
    pool: Option<ThreadPool>,
}

#[pymethods]
impl Lanes {
    #[new]
    #[pyo3(signature = (levels, count, *, size, observation, cell, max_steps, autoreset, threads))]
    #[allow(clippy::too_many_arguments, reason = "the arguments are the settings of the environments")]
    fn new(
        levels: Vec<Bound<'_, Level>>,
        count: usize,
        size: (usize, usize),
        observation: &str,
        cell: u32,
        max_steps: u64,
        autoreset: &str,
        threads: usize,
    ) -> PyResult<Lanes> {
        if count == 0 || max_steps == 0 {
            return Err(invalid("an environment needs at least one lane and one step"));
        }
        let levels = levels.iter().map(|level| level.get().clone()).collect();
        let (sight, autoreset) = (Sight::named(observation, cell)?, Autoreset::named(autoreset)?);
        let setting = Setting::new(levels, size, sight, max_steps, autoreset)?;
        let lanes = (0..count).map(|number| setting.lane(number)).collect();
        let pool = match threads {
            0 | 2.. if count >= LANES_OF_A_POOL => {
                Some(ThreadPoolBuilder::new().num_threads(threads).build().map_err(failed)?)
            }
            _ => None,
        };
        Ok(Lanes { setting, lanes, pool })
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

    /// The names of the numbers in a status.
    #[getter]
    fn status_names(&self) -> Vec<String> {
        self.setting.status.names()
    }

    /// Writes the status of each environment, one after another.
    fn status(&self, py: Python<'_>, mut out: PyReadwriteArray1<'_, f32>) -> PyResult<()> {
        let (out, size) = (out.as_slice_mut()?, self.setting.status.len());
        if out.len() != self.lanes.len() * size {
            return Err(invalid("a status is needed for each lane"));
        }
        py.detach(|| {
            for (lane, out) in self.lanes.iter().zip(out.chunks_exact_mut(size)) {
                self.setting.write_status(lane, out);
            }
        });
        Ok(())
    }

    /// Returns the parts from which [`Lanes::restore`] restores the environments.
    fn save(&self) -> Vec<SavedLane> {
        self.lanes.iter().map(Lane::saved).collect()
    }

    /// Restores saved environments by replaying their episodes, and writes their observations.
    fn restore(
        &mut self,
        py: Python<'_>,
        saved: Vec<SavedLane>,
        mut observations: PyReadwriteArray1<'_, u8>,
    ) -> PyResult<()> {
        let out = observations.as_slice_mut()?;
        let Lanes { setting, lanes, .. } = self;
        let size = setting.size();
        let is_same = saved.len() == lanes.len() && saved.iter().all(|saved| setting.fits(saved));
        if !is_same || out.len() != lanes.len() * size {
            return Err(invalid("the saved lanes belong to a different environment"));
        }
        py.detach(|| {
            for ((lane, saved), out) in lanes.iter_mut().zip(saved).zip(out.chunks_exact_mut(size)) {
                setting.restore(lane, saved, out);
            }
        });
        Ok(())
    }

    /// The seed of each environment's current episode.
    #[getter]
    fn seeds(&self) -> Vec<String> {
        self.lanes.iter().map(|lane| lane.current.to_string()).collect()
    }

    /// The index of each environment's level.
    #[getter]
    fn levels(&self) -> Vec<usize> {
        self.lanes.iter().map(|lane| lane.root).collect()
    }

    /// The state hash of each environment.
    #[getter]
    fn hashes(&self) -> Vec<String> {
        self.lanes.iter().map(|lane| lane.state.state_hash().to_string()).collect()
    }

    /// The current outcome of each environment.
    #[getter]
    fn outcomes(&self) -> Vec<&'static str> {
        self.lanes.iter().map(|lane| outcome_name(lane.state.outcome())).collect()
    }

    /// The current score of each environment.
    #[getter]
    fn scores(&self) -> Vec<f64> {
        self.lanes.iter().map(|lane| lane.state.score()).collect()
    }

    /// Returns the score, outcome and status at the end of the last finished episode in an environment. They are needed
    /// for environments that start the next episode in the same step.
    fn last(&self, lane: usize) -> PyResult<Last> {
        Ok(self.lanes.get(lane).ok_or_else(|| invalid("there is no such lane"))?.last.clone())
    }

    /// Returns a copy of an environment's state.
    fn state(&self, lane: usize) -> PyResult<State> {
        let found = self.lanes.get(lane).ok_or_else(|| invalid("there is no such lane"))?;
        let named = &self.setting.rules().actions;
        let actions = found.actions.iter().map(|&action| named[usize::from(action)]).collect();
        let level = self.setting.levels[found.root].clone();
        Ok(State::of_episode(level, found.state.clone(), found.current, actions))
    }

    /// Sets an environment's seed, from which the seeds of its episodes are derived. If `exact` is `true`, the next
    /// episode uses the seed itself.
    fn seed(&mut self, lane: usize, seed: &str, exact: bool) -> PyResult<()> {
        let found = self.lanes.get_mut(lane).ok_or_else(|| invalid("there is no such lane"))?;
        (found.seed, found.episodes) = (seed_of(seed), 0);
        if exact {
            found.current = found.seed;
        }
        Ok(())
    }

    /// Sets the seed of each environment `i` to `seed.child("lane", i)`.
    fn seed_all(&mut self, seed: &str) {
        let seed = seed_of(seed);
        for (number, lane) in self.lanes.iter_mut().enumerate() {
            (lane.seed, lane.episodes) = (seed.child("lane", number as u64), 0);
        }
    }

    /// Sets the level of an environment's next episode.
    fn choose(&mut self, lane: usize, level: usize) -> PyResult<()> {
        if level >= self.setting.roots.len() {
            return Err(invalid(format_args!("the environment has no level {level}")));
        }
        self.lanes.get_mut(lane).ok_or_else(|| invalid("there is no such lane"))?.chosen = Some(level);
        Ok(())
    }

    /// Starts the next episode in each environment whose flag in `mask` is set, and writes the environment's
    /// observation.
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

    /// Plays one step in every environment. If environments reset in the same step, `last` receives the last
    /// observations of the episodes that ended. Returns the number of episodes that ended.
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
        let Lanes { setting, lanes, pool } = self;
        let named = setting.rules().actions.len();
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
        let is_known = |action: &i64| usize::try_from(*action).is_ok_and(|at| at < named);
        if let Some(wrong) = chosen.iter().find(|action| !is_known(action)) {
            return Err(invalid(format_args!(
                "action {wrong} is not one of the game's {named} actions; they are numbered from 0"
            )));
        }
        Ok(py.detach(|| {
            let setting = &*setting;
            let play = |lane: &mut Lane, action: &i64, told: Told<'_>, last: Option<&mut [u8]>| {
                usize::from(setting.step(lane, *action as u8, told, last))
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
        let Lanes { setting, lanes, .. } = self;
        let named = setting.rules().actions.len();
        let wrong = |action: &i64| usize::try_from(*action).map_or(true, |at| at >= named);
        if chosen.is_empty() || chosen.iter().any(wrong) {
            return Err(invalid("some of the actions do not exist in the game"));
        }
        Ok(py.detach(|| {
            let (mut at, mut ended) = (0, 0);
            for _ in 0..rounds {
                for lane in lanes.iter_mut() {
                    if setting.advance(lane, chosen[at] as u8) != Outcome::Ongoing {
                        lane.current = lane.seed.child("episode", lane.episodes);
                        lane.episodes += 1;
                        setting.place(lane);
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
    /// Splits the environments and buffers into tasks. Each task includes the index of its first environment.
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
