//! Plays random episodes of a game one after another, in order to measure time and instructions.

use crate::levels::folders;
use anyhow::{Context, bail};
use base::Seed;
use cpu_time::ThreadTime;
use engine::{Chance, Game, State};
use std::fs;
use std::path::Path;
use std::time::Duration;

/// The maximum number of ticks per episode, as in the reference's figures.
const EPISODE: usize = 2001;
/// The number of episodes that are prepared together, outside the measurement.
const BATCH: usize = 16;

/// The number of random numbers drawn in advance.
const DRAWS: usize = 1 << 16;

/// A game at the start of level 0, loaded in the same way as in the reference.
pub(crate) struct Subject {
    pub(crate) name: String,
    pub(crate) game: Game,
    pub(crate) start: State,
}

/// Returns the games with the given names in a folder's subfolders, or all games if `only` is empty.
pub(crate) fn subjects(games: &Path, only: &[String]) -> anyhow::Result<Vec<Subject>> {
    let folders = folders(games, only)?;
    if folders.is_empty() {
        bail!("{}: this folder does not contain the game", games.display());
    }
    folders.into_iter().map(|(name, folder)| subject(name, &folder)).collect()
}

fn subject(name: String, folder: &Path) -> anyhow::Result<Subject> {
    let file = ["game.txt", "game.vgdl"].iter().map(|file| folder.join(file)).find(|path| path.exists());
    let file =
        file.with_context(|| format!("{}: contains neither game.txt nor game.vgdl", folder.display()))?;
    let game = Game::from_source_as_reference(&fs::read_to_string(&file)?)
        .with_context(|| file.display().to_string())?;
    let level = game.level(&fs::read_to_string(folder.join("lvl0.txt"))?)?;
    let start = game.start_with(&level, Chance::from_java(0));
    Ok(Subject { name, game, start })
}

/// A sequence of random episodes of one game.
pub(crate) struct EpisodeRun<'a> {
    subject: &'a Subject,
    episodes: u64,
    states: Vec<State>,
    draws: Vec<u32>,
    pub(crate) ticks: u64,
    /// The CPU time spent on steps.
    pub(crate) time: Duration,
    /// The combined digest of the hashes of all visited states, in the order of the visits.
    pub(crate) digest: u128,
}

impl<'a> EpisodeRun<'a> {
    pub(crate) fn new(subject: &'a Subject) -> EpisodeRun<'a> {
        let mut sampler = Seed::from_text(&subject.name).sampler();
        let draws = (0..DRAWS).map(|_| sampler.bits() as u32).collect();
        let (states, digest) = (vec![subject.start.clone(); BATCH], 0);
        EpisodeRun { subject, episodes: 0, states, draws, ticks: 0, time: Duration::ZERO, digest }
    }

    /// Plays `ticks` ticks outside the measurement, so that the states' buffers grow to their final size.
    pub(crate) fn warm_up(&mut self, ticks: u64) {
        self.prepare();
        self.play(ticks);
        (self.episodes, self.ticks, self.digest) = (0, 0, 0);
    }

    fn prepare(&mut self) {
        for state in &mut self.states {
            state.fork_from(&self.subject.start, Chance::from_java(self.episodes as i64));
            self.episodes += 1;
        }
    }

    /// Plays [`BATCH`] episodes, or fewer if `ticks` ticks are reached earlier.
    pub(crate) fn batch(&mut self, ticks: u64) {
        self.prepare();
        let clock = ThreadTime::now();
        self.play_measured(ticks);
        self.time += clock.elapsed();
    }

    /// Plays the measured part of a batch. Instruction counting refers to this function by name.
    #[inline(never)]
    fn play_measured(&mut self, ticks: u64) {
        self.play(ticks);
    }

    #[inline(always)]
    fn play(&mut self, ticks: u64) {
        let mut draw = (self.episodes as usize).wrapping_mul(7919);
        for state in &mut self.states {
            for _ in 0..EPISODE {
                if self.ticks == ticks || state.is_over() {
                    break;
                }
                let actions = self.subject.game.actions(state);
                let drawn = u64::from(self.draws[draw & (DRAWS - 1)]);
                draw += 1;
                let action = actions[((drawn * actions.len() as u64) >> 32) as usize];
                self.subject.game.step(state, action);
                state.settle_hash();
                self.digest = chain(self.digest, state.state_hash().0);
                self.ticks += 1;
            }
        }
    }
}

fn chain(digest: u128, hash: u128) -> u128 {
    (digest.rotate_left(5) ^ hash).wrapping_mul(0x2360_ED05_1FC6_5DA4_4385_DF64_9FCC_F645)
}

/// Returns the digest of the states visited in the first batch. Also checks that it equals a digest computed
/// from scratch.
pub(crate) fn first_digest(subject: &Subject) -> anyhow::Result<u128> {
    const TICKS: u64 = 300;
    let mut episode_run = EpisodeRun::new(subject);
    episode_run.batch(TICKS);
    let mut digest = 0;
    let (mut ticks, mut draw) = (0, BATCH.wrapping_mul(7919));
    for episode in 0..BATCH {
        let mut state = subject.start.clone();
        state.fork_from(&subject.start, Chance::from_java(episode as i64));
        for _ in 0..EPISODE {
            if ticks == TICKS || state.is_over() {
                break;
            }
            let actions = subject.game.actions(&state);
            let drawn = u64::from(episode_run.draws[draw & (DRAWS - 1)]);
            draw += 1;
            subject.game.step_unscheduled(
                &mut state,
                actions[((drawn * actions.len() as u64) >> 32) as usize],
                &mut (),
            );
            digest = chain(digest, state.state_hash_from_scratch().0);
            ticks += 1;
        }
    }
    if digest != episode_run.digest {
        bail!("{}: the running hash is not the hash from scratch", subject.name);
    }
    Ok(digest)
}
