//! The interactions executed in a game's recorded episodes, and the types that occur in them.

use crate::report::Report;
use base::Seed;
use engine::{Action, Episode, Game, Level, Meeting, Outcome, Watch};
use rayon::prelude::*;

/// A level with the episodes that its validators played, from most to least informative.
#[derive(Clone, Copy, Debug)]
pub struct Recorded<'a> {
    /// The level on which the episodes were played.
    pub level: &'a Level,
    /// The recorded episodes.
    pub episodes: &'a [Episode],
}

/// An execution of an interaction within a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Use {
    pub(crate) level: usize,
    pub(crate) episode: usize,
    /// The tick in the episode in which the line is first executed, counted from 0.
    pub(crate) tick: usize,
}

/// The interactions and types that occur in a recording.
#[derive(Clone, Debug)]
pub(crate) struct Usage {
    /// For each interaction line, its first execution in each of up to 24 episodes, alternating between levels.
    pub(crate) lines: Vec<Vec<Use>>,
    /// For each type, `true` if a sprite of the type was present, or the type was held as a resource.
    pub(crate) types: Vec<bool>,
    /// `true` if every level has at least one won episode.
    pub(crate) won: bool,
    /// The number of replayed episodes. The next field contains their total number of ticks.
    pub(crate) episodes: usize,
    pub(crate) ticks: u64,
}

/// The maximum number of episodes to store per interaction.
const USES: usize = 24;
/// The maximum number of ticks to replay from a level's episodes. The most informative episodes come first.
const TICKS: u64 = 100_000;

struct MeetingRecorder<'a> {
    usage: &'a mut Usage,
    at: Use,
}

impl Watch for MeetingRecorder<'_> {
    fn interaction(&mut self, line: usize) {
        let uses = &mut self.usage.lines[line];
        let of_this = |last: &Use| (last.level, last.episode) == (self.at.level, self.at.episode);
        if uses.len() < USES && !uses.last().is_some_and(of_this) {
            uses.push(self.at);
        }
    }

    fn wants_meetings(&self) -> bool {
        true
    }

    fn meeting(&mut self, meeting: Meeting) {
        for stype in [Some(meeting.first), meeting.second].into_iter().flatten() {
            self.usage.types[stype.index()] = true;
        }
    }
}

impl Usage {
    fn new(game: &Game) -> Usage {
        let lines = vec![Vec::new(); game.description().interactions.len()];
        Usage { lines, types: vec![false; game.sprite_types().count()], won: true, episodes: 0, ticks: 0 }
    }

    /// Replays the recording. Costs a replay of the episodes, with at most 100,000 ticks per level.
    pub(crate) fn of(game: &Game, recording: &[Recorded<'_>]) -> Usage {
        Usage::within(game, recording, TICKS)
    }

    /// Replays the recording like [`Usage::of`], but with about `most` ticks per level. The episode that exceeds the
    /// limit is the last one to be replayed.
    pub(crate) fn within(game: &Game, recording: &[Recorded<'_>], most: u64) -> Usage {
        let most = most.min(TICKS);
        let numbered: Vec<(usize, &Recorded<'_>)> = recording.iter().enumerate().collect();
        let of_level =
            |&(number, recorded): &(usize, &Recorded<'_>)| Usage::of_level(game, number, *recorded, most);
        let mut usage = Usage::new(game);
        let levels: Vec<Usage> = numbered.par_iter().map(of_level).collect();
        for (line, all) in usage.lines.iter_mut().enumerate() {
            // Take the first execution on every level, then the second, because a rule's effect may show on
            // only one level.
            let ranked =
                (0..USES).flat_map(|rank| levels.iter().filter_map(move |of| of.lines[line].get(rank)));
            all.extend(ranked.copied().take(USES));
        }
        for of_level in levels {
            for (all, there) in usage.types.iter_mut().zip(of_level.types) {
                *all |= there;
            }
            usage.won &= of_level.won;
            usage.episodes += of_level.episodes;
            usage.ticks += of_level.ticks;
        }
        usage
    }

    fn of_level(game: &Game, number: usize, recorded: Recorded<'_>, most: u64) -> Usage {
        let mut usage = Usage::new(game);
        usage.won = recorded.episodes.iter().any(|episode| episode.outcome == Outcome::Won);
        for (episode, played) in recorded.episodes.iter().enumerate() {
            if usage.ticks >= most {
                break;
            }
            let mut state = game.start(recorded.level, played.seed);
            usage.note_types(game, &state);
            for (tick, &action) in played.actions.iter().enumerate() {
                let at = Use { level: number, episode, tick };
                game.step_watched(&mut state, action, &mut MeetingRecorder { usage: &mut usage, at });
                usage.note_types(game, &state);
            }
            usage.episodes += 1;
            usage.ticks += played.actions.len() as u64;
        }
        usage
    }

    fn note_types(&mut self, game: &Game, state: &engine::State) {
        for stype in game.present_types(state) {
            self.types[stype.index()] = true;
        }
        for stype in game.held_types(state) {
            self.types[stype.index()] = true;
        }
    }
}

/// Returns, for each interaction line, the level and episode of up to 24 recorded executions, each in a different
/// episode. These episodes serve to examine a rule's effect. Costs a replay of the episodes, with at most 100,000 ticks
/// per level.
pub fn executions(game: &Game, recording: &[Recorded<'_>]) -> Vec<Vec<[usize; 2]>> {
    let places = |uses: Vec<Use>| uses.iter().map(|at| [at.level, at.episode]).collect();
    Usage::of(game, recording).lines.into_iter().map(places).collect()
}

/// The maximum number of random walks per level, if any rule was never executed.
const MAX_WALKS: u64 = 400;
/// The number of random actions per walk.
const WALK_TICKS: usize = 40;

/// Searches for executions of interactions that a recording lacks, by random walks from random moments in each level's
/// episodes. Uses up to `most` ticks per level, plus one walk. For each level, returns new, ordinary episodes that
/// contain these executions.
pub(crate) fn explore(
    game: &Game,
    recording: &[Recorded<'_>],
    usage: &Usage,
    seed: Seed,
    most: u64,
) -> Vec<Vec<Episode>> {
    let unseen: Vec<bool> = usage.lines.iter().map(Vec::is_empty).collect();
    if !unseen.contains(&true) {
        return vec![Vec::new(); recording.len()];
    }
    let numbered: Vec<(u64, &Recorded<'_>)> = (0..).zip(recording).collect();
    let of_level = |&(number, recorded): &(u64, &Recorded<'_>)| {
        let mut unseen = unseen.clone();
        let tries = (0..MAX_WALKS).map(|number| seed.child("way", number));
        let tries = tries.map(|way| way.child("level", number));
        let mut left = most;
        let tries = tries
            .map_while(|way| (left > 0).then(|| random_walk(game, *recorded, &mut unseen, way, &mut left)));
        tries.flatten().collect()
    };
    numbered.par_iter().map(of_level).collect()
}

/// Takes a random walk, and marks the new interactions that it executes. Returns the episode up to the last
/// new interaction.
fn random_walk(
    game: &Game,
    recorded: Recorded<'_>,
    unseen: &mut [bool],
    seed: Seed,
    left: &mut u64,
) -> Option<Episode> {
    struct NewLines<'a>(&'a mut [bool], bool);
    impl Watch for NewLines<'_> {
        fn interaction(&mut self, line: usize) {
            self.1 |= std::mem::replace(&mut self.0[line], false);
        }
    }
    if !unseen.contains(&true) || recorded.episodes.is_empty() {
        return None;
    }
    let mut sampler = seed.sampler();
    // The most informative episode comes first. Half of the walks start from it, and the others from any episode.
    let among = if sampler.ratio(1, 2) { 1 } else { recorded.episodes.len() };
    let from = &recorded.episodes[sampler.below(among)];
    let start = sampler.below(from.actions.len().max(1));
    let mut state = game.start(recorded.level, from.seed);
    let mut actions: Vec<Action> = Vec::new();
    let mut informative = 0;
    for tick in 0..start + WALK_TICKS {
        if state.is_over() {
            break;
        }
        let action = match from.actions.get(tick).filter(|_| tick < start) {
            Some(&action) => action,
            None => *sampler.choose(game.actions(&state)),
        };
        let mut new_lines = NewLines(unseen, false);
        game.step_watched(&mut state, action, &mut new_lines);
        actions.push(action);
        *left = left.saturating_sub(1);
        if new_lines.1 {
            informative = actions.len();
        }
    }
    if informative == 0 {
        return None;
    }
    let (mut episode, mut state) = Episode::begin(game, recorded.level, from.seed);
    for action in actions.into_iter().take(informative) {
        episode.play(game, &mut state, action);
    }
    Some(episode)
}

/// Returns each level's episodes, plus random walks of at most `most` ticks per level if any rule was never executed.
pub(crate) fn record(
    game: &Game,
    levels: &[Level],
    reports: &[Report],
    seed: Seed,
    most: u64,
) -> Vec<Vec<Episode>> {
    let mut episodes: Vec<Vec<Episode>> = reports.iter().map(Report::episodes).collect();
    let new = {
        let recording = recorded(levels, &episodes);
        let usage = Usage::within(game, &recording, most);
        explore(game, &recording, &usage, seed, most)
    };
    for (episodes, new) in episodes.iter_mut().zip(new) {
        // Insert the walks after the witness, but before episodes that may exceed the limit.
        let at = usize::from(!episodes.is_empty());
        episodes.splice(at..at, new);
    }
    episodes
}

pub(crate) fn recorded<'a>(levels: &'a [Level], episodes: &'a [Vec<Episode>]) -> Vec<Recorded<'a>> {
    levels.iter().zip(episodes).map(|(level, episodes)| Recorded { level, episodes }).collect()
}
