//! Measures of a level in play, used as axes of archives and of expressive range.

use crate::criterion::Criterion;
use crate::measures::ladder::{Ladder, PlayerResult, Rate};
use crate::report::Report;
use crate::thresholds::Criteria;
use agents::{Budget, Limits, Mcts, MctsConfig, Play, play};
use base::Seed;
use engine::analysis::EffectSummary;
use engine::{Action, Analysis, Episode, Game, Level, Meeting, Outcome, SpriteType, State, Watch};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// The measures of a level with a win. The first six are computed from the witness, and therefore describe
/// the shortest win found. `shortest` and `skill` describe the level itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measures {
    /// The number of ticks in the witness.
    pub ticks: usize,
    /// The number of pushes that moved or removed a sprite. In Sokoban, this is the number of pushes in the solution.
    pub pushes: usize,
    /// The effect of choices, from 0 to 1: the fraction of actions that lead to distinct states
    /// ([`State::search_key`]), averaged over the witness's ticks. A value of 1 means that every action matters, and 1
    /// / actions means that none does.
    pub branching: f64,
    /// The mechanics used, from 0 to 1: the fraction of the game's interactions that the witness executes.
    /// Interactions with the screen edge do not count, because walls can make these guards idle.
    pub mechanics: f64,
    /// The interactions that the witness executes, as returned by [`used_rules`].
    pub rules: Vec<usize>,
    /// The risk of losing along the witness, from 0 to 1. It is the probability that [`FORESIGHT`] random actions in a
    /// row lose the game, averaged over the witness's ticks.
    pub pressure: f64,
    /// The number of ticks in the shortest win, if it is proven to be the shortest.
    pub shortest: Option<usize>,
    /// The advantage of looking ahead, if a ladder of reference players was played.
    pub skill: Option<SkillGap>,
}

/// The advantage of players that look ahead over players that do not (`random`, `do-nothing`). It is the
/// difference between the means over the players of each kind, including held-out players.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SkillGap {
    /// The difference between the win rates, from −1 to 1.
    pub wins: f64,
    /// The difference between the rewards ([`PlayerResult::reward`]), from −1 to 1, or `None` if all episodes
    /// had the same score.
    pub reward: Option<f64>,
}

/// The number of ticks that pressure looks ahead.
pub const FORESIGHT: usize = 8;
/// The number of random futures per action.
const FUTURES: u64 = 3;
/// The maximum number of evenly spaced witness ticks to sample.
const MOMENTS: usize = 60;

impl Measures {
    /// Measures a judged level, with or without the results of a ladder of reference players. Returns `None` if the
    /// report does not contain a witness. The same arguments give the same numbers on every machine.
    ///
    /// Costs a replay of the witness, and trials of every action at up to 60 of its ticks. There is one trial for
    /// branching, and three trials of up to [`FORESIGHT`] ticks for pressure. With five actions, the trials take at
    /// most 7,500 forward-model calls.
    pub fn of(
        analysis: &Analysis,
        level: &Level,
        report: &Report,
        ladder: Option<&Ladder>,
        seed: Seed,
    ) -> Option<Measures> {
        let witness = report.witness.as_ref()?;
        let shortest = report.finding(Criterion::Winnable).and_then(|finding| finding.optimal);
        Some(Measures {
            shortest,
            skill: ladder.and_then(SkillGap::of),
            ..Measures::of_episode(analysis, level, witness, seed)
        })
    }

    /// Measures one episode on a level, without `shortest` and `skill`. Costs as much as [`Measures::of`].
    pub fn of_episode(analysis: &Analysis, level: &Level, episode: &Episode, seed: Seed) -> Measures {
        let game = analysis.game();
        let mut state = game.start(level, episode.seed);
        let mut recorder = MeetingRecorder::new(game);
        let (mut pushes, mut branching, mut pressure) = (0, Mean::default(), Mean::default());
        let stride = episode.actions.len().div_ceil(MOMENTS).max(1);
        for (tick, &action) in episode.actions.iter().enumerate() {
            if tick % stride == 0 {
                branching.add(different(game, &state));
                pressure.add(danger(game, &state, seed.child("tick", tick as u64)));
            }
            let before = state.clone();
            recorder.meetings.clear();
            game.step_watched(&mut state, action, &mut recorder);
            pushes += pushed(analysis, &recorder.meetings, &before, &state);
        }
        let rules = recorder.executed();
        let inner = |line: &usize| !is_guard(game, *line);
        let (of, used) =
            ((0..recorder.lines.len()).filter(inner).count(), rules.iter().copied().filter(inner).count());
        Measures {
            ticks: episode.actions.len(),
            pushes,
            branching: branching.value(),
            mechanics: used as f64 / of.max(1) as f64,
            rules,
            pressure: pressure.value(),
            shortest: None,
            skill: None,
        }
    }
}

impl SkillGap {
    /// Compares the reference players on a ladder. Returns `None` unless some players look ahead and some do not.
    pub fn of(ladder: &Ladder) -> Option<SkillGap> {
        let players = || ladder.rungs.iter().chain(&ladder.held_out);
        let gap = |value: &dyn Fn(&PlayerResult) -> Option<f64>| {
            let mean = |looks_ahead: bool| {
                let kind = players().filter(|result| result.looks_ahead == looks_ahead);
                let values: Option<Vec<f64>> = kind.map(value).collect();
                statistics::Summary::of(&values?).map(|summary| summary.mean)
            };
            Some(mean(true)? - mean(false)?)
        };
        let wins = gap(&|result| Some(result.rate.wins as f64 / result.rate.plays.max(1) as f64))?;
        Some(SkillGap { wins, reward: gap(&|result| result.reward) })
    }
}

/// Returns the interactions executed in an episode, as indices into [`Description::interactions`](engine::Description)
/// in ascending order. Costs one replay of the episode.
pub fn used_rules(game: &Game, level: &Level, episode: &Episode) -> Vec<usize> {
    let mut recorder = MeetingRecorder::new(game);
    let mut state = game.start(level, episode.seed);
    for &action in &episode.actions {
        game.step_watched(&mut state, action, &mut recorder);
    }
    recorder.executed()
}

/// The name of the screen edge in interactions.
pub(crate) const EDGE: &str = "EOS";

/// Returns `true` if an interaction is with the screen edge.
pub fn is_guard(game: &Game, line: usize) -> bool {
    let written = &game.description().interactions[line];
    written.first.text == EDGE || written.second.iter().any(|word| word.text == EDGE)
}

/// Returns the actions available in a state, including doing nothing.
pub(crate) fn actions(game: &Game, state: &State) -> Vec<Action> {
    let known = game.actions(state);
    let idle = (!known.contains(&Action::Nil)).then_some(Action::Nil);
    known.iter().copied().chain(idle).collect()
}

/// Returns the fraction of actions that lead to distinct states under the same random draws.
fn different(game: &Game, state: &State) -> f64 {
    let actions = actions(game, state);
    let after = |&action: &Action| {
        let mut after = state.clone();
        game.step(&mut after, action);
        after.search_key(game)
    };
    let keys: BTreeSet<_> = actions.iter().map(after).collect();
    keys.len() as f64 / actions.len() as f64
}

/// Returns the fraction of random futures that lose. All first actions get the same random draws and are followed by
/// the same actions.
fn danger(game: &Game, state: &State, seed: Seed) -> f64 {
    let (mut lost, mut all) = (0u64, 0u64);
    for action in actions(game, state) {
        for future in (0..FUTURES).map(|number| seed.child("future", number)) {
            let mut after = state.fork(future.child("chance", 0));
            let mut keys = future.child("keys", 0).sampler();
            game.step(&mut after, action);
            for _ in 1..FORESIGHT {
                if after.is_over() {
                    break;
                }
                let key = *keys.choose(game.actions(&after));
                game.step(&mut after, key);
            }
            lost += u64::from(after.outcome() == Outcome::Lost);
            all += 1;
        }
    }
    lost as f64 / all.max(1) as f64
}

/// Returns the number of sprites moved or removed by a push in a tick. A push against an obstacle is undone in the same
/// tick, and does not count.
fn pushed(analysis: &Analysis, meetings: &[Meeting], before: &State, after: &State) -> usize {
    let pushes = |meeting: &&Meeting| {
        let of_line = analysis.encounters().iter().filter(|encounter| encounter.line == meeting.line);
        of_line.into_iter().any(|encounter| encounter.does(|effect| *effect == EffectSummary::Push))
    };
    let types: Vec<SpriteType> = meetings.iter().filter(pushes).map(|meeting| meeting.first).collect();
    if types.is_empty() {
        return 0;
    }
    let game = analysis.game();
    let was = game.records(before);
    let of_types = was.iter().filter(|record| types.contains(&SpriteType(record.stype)));
    let is = game.records(after);
    let stays = |id: u32, rect: engine::Rect| is.iter().any(|record| record.id == id && record.rect == rect);
    let moved = of_types.filter(|record| !stays(record.id, record.rect)).count();
    moved.min(types.len())
}

/// Returns the number of pushes in an episode, counted as in [`Measures::pushes`]. Costs one replay of the episode.
pub(crate) fn pushes_of(analysis: &Analysis, level: &Level, episode: &Episode) -> usize {
    let game = analysis.game();
    let mut state = game.start(level, episode.seed);
    let mut recorder = MeetingRecorder::new(game);
    let mut pushes = 0;
    for &action in &episode.actions {
        let before = state.clone();
        recorder.meetings.clear();
        game.step_watched(&mut state, action, &mut recorder);
        pushes += pushed(analysis, &recorder.meetings, &before, &state);
    }
    pushes
}

/// Runs the reference's tree search ([`Mcts`]) on a level with a witness, and returns its win rate. An
/// episode stops after [`Criteria::patience`] times the witness's ticks, plus 50. Cost: `mcts_plays` episodes
/// with `decision` calls per tick.
pub fn mcts_rate(game: &Game, level: &Level, witness: &Episode, criteria: &Criteria, seed: Seed) -> Rate {
    let ticks = witness.actions.len().saturating_mul(criteria.patience).saturating_add(50);
    let limits = Limits { ticks, ..Limits::default() };
    let plays: Vec<Play> = (0..u64::from(criteria.mcts_plays))
        .into_par_iter()
        .map(|run| {
            let seed = seed.child("mcts", run);
            let mut planner = Mcts::new(MctsConfig::default(), seed.child("planner", 0));
            play(game, level, &mut planner, Budget(criteria.decision), seed.child("chance", 0), limits)
        })
        .collect();
    Rate::of(&plays)
}

/// A recorder for executed interactions, and for the current tick's meetings.
pub(crate) struct MeetingRecorder {
    lines: Vec<bool>,
    pub(crate) meetings: Vec<Meeting>,
}

/// The maximum number of meetings to record per tick.
const MAX_MEETINGS: usize = 256;

impl MeetingRecorder {
    pub(crate) fn new(game: &Game) -> MeetingRecorder {
        MeetingRecorder { lines: vec![false; game.description().interactions.len()], meetings: Vec::new() }
    }

    /// Returns the executed interactions in ascending order.
    fn executed(&self) -> Vec<usize> {
        (0..self.lines.len()).filter(|&line| self.lines[line]).collect()
    }
}

impl Watch for MeetingRecorder {
    fn interaction(&mut self, line: usize) {
        self.lines[line] = true;
    }

    fn wants_meetings(&self) -> bool {
        self.meetings.len() < MAX_MEETINGS
    }

    fn meeting(&mut self, meeting: Meeting) {
        self.meetings.push(meeting);
    }
}

/// A running mean, which is 0 as long as no values were added.
#[derive(Default)]
pub(crate) struct Mean {
    sum: f64,
    count: u64,
}

impl Mean {
    pub(crate) fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1;
    }

    pub(crate) fn value(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Difficulty;

    /// A game in which crates are pushed into pits. The wasp flies along its row.
    const GAME: &str = "BasicGame\n  SpriteSet\n    pit > Immovable\n    crate > Passive\n    wasp > Missile orientation=LEFT speed=1\n    avatar > MovingAvatar\n  LevelMapping\n    o > pit\n    c > crate\n    s > wasp\n  InteractionSet\n    avatar wall > stepBack\n    crate avatar > bounceForward\n    crate wall > undoAll\n    crate pit > killSprite scoreChange=1\n    avatar wasp > killSprite\n    wasp wall > reverseDirection\n    avatar EOS > stepBack\n  TerminationSet\n    SpriteCounter stype=crate win=True\n    SpriteCounter stype=avatar win=False\n";

    fn play(level: &str, actions: &[Action]) -> (Analysis, Level, Episode) {
        let game = Game::from_source(GAME).unwrap();
        let level = game.level(level).unwrap();
        let (mut episode, mut state) = Episode::begin(&game, &level, Seed::from_text("measures"));
        for &action in actions {
            episode.play(&game, &mut state, action);
        }
        (Analysis::of(&game), level, episode)
    }

    fn check(level: &str, actions: &[Action]) -> Measures {
        let (analysis, level, episode) = play(level, actions);
        let measures = Measures::of_episode(&analysis, &level, &episode, Seed::from_text("futures"));
        assert_eq!(measures.rules, used_rules(analysis.game(), &level, &episode));
        assert_eq!(measures, Measures::of_episode(&analysis, &level, &episode, Seed::from_text("futures")));
        measures
    }

    use Action::{Left, Right, Up};

    #[test]
    fn pushes_that_move_something_are_counted() {
        let solved = check("wwwwww\nwAc ow\nw    w\nwwwwww\n", &[Right; 2]);
        assert_eq!((solved.ticks, solved.pushes, solved.rules.as_slice()), (2, 2, &[1, 3][..]));
        assert!((solved.mechanics - 2.0 / 6.0).abs() < 1e-12, "{solved:?}");
        assert_eq!(solved.pressure, 0.0);
        // A move against a wall has no effect, and a step past the crate does not push it.
        let stuck = check("wwwwww\nwAcw w\nw   ow\nwwwwww\n", &[Right, Right, Left]);
        assert_eq!(stuck.pushes, 0, "{stuck:?}");
    }

    #[test]
    fn branching_is_higher_in_open_space() {
        // In a closed cell, all actions lead to the same state. In the open, five actions lead to five states.
        let caged = check("wwwwww\nwAw ow\nwww cw\nwwwwww\n", &[Up]);
        let free = check("wwwwww\nw    w\nw A  w\nw   ow\nw   cw\nwwwwww\n", &[Action::Nil]);
        assert!(caged.branching < free.branching && free.branching == 1.0, "{caged:?} {free:?}");
    }

    #[test]
    fn pressure_is_high_where_most_futures_lose() {
        let near = check("wwwwww\nwA  sw\nwwwwww\nwo c w\nwwwwww\n", &[Right]);
        let far = check("wwwwww\nwA  ww\nww www\nwo csw\nwwwwww\n", &[Right]);
        assert!(near.pressure > 0.5 && far.pressure < 0.2, "{near:?} {far:?}");
    }

    #[test]
    fn the_skill_gap_is_between_kinds_of_players() {
        let result = |looks_ahead, wins, reward| PlayerResult {
            player: String::new(),
            looks_ahead,
            rate: Rate { wins, plays: 10, interval: [0.0, 1.0], calls: 0, mean_score: 0.0 },
            win_ticks: None,
            reward,
        };
        let ladder = |rungs| Ladder { rungs, held_out: Vec::new(), ease: None, difficulty: Difficulty::Easy };
        let rungs = vec![result(false, 1, Some(0.2)), result(true, 5, Some(0.5)), result(true, 9, Some(0.9))];
        let gap = SkillGap::of(&ladder(rungs)).unwrap();
        assert!((gap.wins - 0.6).abs() < 1e-12 && (gap.reward.unwrap() - 0.5).abs() < 1e-12, "{gap:?}");
        assert_eq!(SkillGap::of(&ladder(vec![result(true, 5, None)])), None);
        let flat = SkillGap::of(&ladder(vec![result(false, 0, None), result(true, 5, None)])).unwrap();
        assert_eq!(flat, SkillGap { wins: 0.5, reward: None });
    }
}
