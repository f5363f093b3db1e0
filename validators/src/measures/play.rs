//! Measures of a game in play, computed from its recorded episodes.

use super::futures::{Futures, Standing};
use super::guards::Guards;
use crate::measures::{Mean, actions};
use crate::recording::Recorded;
use base::Seed;
use engine::{Analysis, Episode, Game, Level, Meeting, Outcome, SpriteRecord, State, Watch};
use itertools::Itertools;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// A game's measures in play, as means over its levels, with one episode per level: the first won episode or,
/// if none is won, the first episode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlayMeasures {
    /// The pace, from 0 to 1: the fraction of ticks in which something other than the avatar moves, turns, appears,
    /// disappears or changes.
    pub pace: f64,
    /// The number of executed interactions per tick, not counting guards ([`Guards`]). An interaction that
    /// returns the same sprite to the same position in every tick counts only once.
    pub density: f64,
    /// The randomness, from 0 to 1: the fraction of actions, at some ticks, whose result differs between random seeds.
    pub chance: f64,
    /// The total number of distinct interactions executed in won episodes, not counting guards (rules that only keep
    /// sprites on the board and out of walls).
    pub mechanics: usize,
    /// The planning depth in ticks, from 1 to [`SIGHT`](super::SIGHT). From a given moment, this is the look-ahead that
    /// is needed to see that the episode is better than random play, because it wins, does not lose, or scores more.
    /// Random play presses random keys, except keys that lose immediately. Moments from which random play also wins do
    /// not count, and the value is 0 if no moment counts.
    ///
    /// The value is low in a game that rewards every step or kills an inactive player. It is high in a game in which a
    /// good move looks like any other for a long time, or worse than a greedy one. The measure shows how far away the
    /// consequences are. Unlike the look-ahead that a planner requires, its cost does not grow with the branching
    /// factor.
    pub sight: f64,
    /// The despair on the way to a win, from 0 to 1. The lead at a moment is the fraction of continuations with random
    /// keys that win, minus the fraction that lose within [`SIGHT`](super::SIGHT) ticks. Drama is the mean, over all
    /// moments, of the square root of the player's deficit, which is 0 at moments at which the game does not lead. A
    /// game that random play can neither win nor lose has a drama of 0.
    ///
    /// The measure follows Browne and Maire ("Evolutionary game design", IEEE TCIAIG 2:1, 2010), with three changes.
    /// The game is the opponent, continuations with random keys give the value of a position, and the mean is taken
    /// over all moments, so that a single bad moment does not make a drama.
    pub drama: f64,
    /// The mean number of times that the lead changes sides on the way to the win. At the win, the player leads. This
    /// is Browne and Maire's *lead change*, but not divided by the number of moves.
    pub lead_changes: f64,
    /// The number of levels with a measured episode.
    pub levels: usize,
}

/// The maximum number of evenly spaced moments per episode from which futures start.
const MOMENTS: usize = 12;
/// The number of random seeds with which to try an action.
const CHANCES: u64 = 3;
/// The maximum number of won episodes per level to search for mechanics.
const WINS: usize = 12;

impl PlayMeasures {
    /// Measures a game's recorded episodes. Returns `None` if there are no recorded episodes. The same
    /// arguments give the same numbers on every machine. Costs a replay of the episodes, and a few
    /// milliseconds of forward-model calls per level. Futures take 12 × 8 × 64 calls, or up to three times as
    /// many, and randomness takes 12 × 6 × 3 calls.
    pub fn of(analysis: &Analysis, recording: &[Recorded<'_>], seed: Seed) -> Option<PlayMeasures> {
        let game = analysis.game();
        let guards = Guards::of(analysis);
        let mut all: [Mean; 6] = Default::default();
        let mut levels = 0;
        let mut used = BTreeSet::new();
        for (number, recorded) in (0u64..).zip(recording) {
            let won = || recorded.episodes.iter().filter(|episode| episode.outcome == Outcome::Won);
            let Some(episode) = won().next().or(recorded.episodes.first()) else { continue };
            let seed = seed.child("level", number);
            let measured = Measured::of(analysis, &guards, recorded.level, episode, seed);
            for (mean, value) in all.iter_mut().zip(measured.0) {
                if let Some(value) = value {
                    mean.add(value);
                }
            }
            levels += 1;
            for episode in won().take(WINS) {
                used.extend(mechanics(game, &guards, recorded.level, episode));
            }
        }
        let [pace, density, chance, sight, drama, lead_changes] = all.map(|mean| mean.value());
        let mechanics = used.len();
        let measures = PlayMeasures { pace, density, chance, mechanics, sight, drama, lead_changes, levels };
        (levels > 0).then_some(measures)
    }
}

/// Returns the interactions executed in an episode, as indices into [`Description::interactions`](engine::Description).
/// Guards, which only keep sprites on the board and out of walls, are not counted.
pub(crate) fn mechanics(game: &Game, guards: &Guards, level: &Level, episode: &Episode) -> BTreeSet<usize> {
    let mut counter = Counter::new(guards);
    let mut state = game.start(level, episode.seed);
    for &action in &episode.actions {
        game.step_watched(&mut state, action, &mut counter);
    }
    counter.lines
}

/// An episode's pace, density, chance, sight, drama and lead changes.
struct Measured([Option<f64>; 6]);

impl Measured {
    fn of(analysis: &Analysis, guards: &Guards, level: &Level, episode: &Episode, seed: Seed) -> Measured {
        let game = analysis.game();
        let mut state = game.start(level, episode.seed);
        let mut counter = Counter::new(guards);
        let (mut pace, mut chance) = (Mean::default(), Mean::default());
        let stride = episode.actions.len().div_ceil(MOMENTS).max(1);
        let mut line = vec![Standing::of(&state)];
        let mut moments: Vec<(usize, Futures)> = Vec::new();
        let mut before = others(game, &state);
        for (tick, &action) in episode.actions.iter().enumerate() {
            if tick % stride == 0 {
                let seed = seed.child("tick", tick as u64);
                moments.push((tick, Futures::of(game, &state, seed)));
                chance.add(unsure(analysis, &state, seed));
            }
            game.step_watched(&mut state, action, &mut counter);
            let after = others(game, &state);
            pace.add(f64::from(u8::from(before != after)));
            before = after;
            line.push(Standing::of(&state));
        }
        let mut sight = Mean::default();
        let mut sights = 0;
        for far in moments.iter().filter_map(|(tick, futures)| futures.sight(&line[*tick..])) {
            sight.add(far as f64);
            sights += 1;
        }
        let mut drama = Mean::default();
        let leads: Vec<f64> = moments.iter().map(|(_, futures)| futures.lead()).collect();
        leads.iter().for_each(|lead| drama.add((-lead).max(0.0).sqrt()));
        let ends = (state.outcome() == Outcome::Won).then_some(1.0);
        let density = counter.executions as f64 / episode.actions.len().max(1) as f64;
        let changes = changes(leads.into_iter().chain(ends));
        Measured([
            Some(pace.value()),
            Some(density),
            Some(chance.value()),
            (sights > 0).then(|| sight.value()),
            Some(drama.value()),
            Some(changes as f64),
        ])
    }
}

/// Returns the number of sign changes, skipping zeros.
fn changes(leads: impl Iterator<Item = f64>) -> usize {
    let signs: Vec<bool> = leads.filter(|lead| *lead != 0.0).map(|lead| lead > 0.0).collect();
    signs.iter().tuple_windows().filter(|(one, next)| one != next).count()
}

/// Returns all sprites except the avatar.
fn others(game: &Game, state: &State) -> Vec<SpriteRecord> {
    let avatar = state.avatar_id();
    let mut records = game.records(state);
    records.retain(|record| Some(record.id) != avatar);
    records
}

/// Returns the fraction of actions whose result differs between random seeds. Cost: actions × [`CHANCES`]
/// calls, or none in a game in which randomness has no effect.
fn unsure(analysis: &Analysis, state: &State, seed: Seed) -> f64 {
    if !analysis.is_stochastic() {
        return 0.0;
    }
    let game = analysis.game();
    let actions = actions(game, state);
    let differs = |action| {
        let after = |number: u64| {
            let mut after = state.fork(seed.child("chance", number));
            game.step(&mut after, action);
            (game.records(&after), after.score(), after.outcome())
        };
        let first = after(0);
        (1..CHANCES).any(|number| after(number) != first)
    };
    let unsure = actions.iter().filter(|&&action| differs(action)).count();
    unsure as f64 / actions.len() as f64
}

/// A counter for executed interactions other than guards, which only keep sprites on the board and out of walls.
struct Counter<'a> {
    guards: &'a Guards,
    executions: u64,
    lines: BTreeSet<usize>,
}

impl Counter<'_> {
    fn new(guards: &Guards) -> Counter<'_> {
        Counter { guards, executions: 0, lines: BTreeSet::new() }
    }

    fn count(&mut self, line: usize) {
        self.executions += 1;
        self.lines.insert(line);
    }
}

impl Watch for Counter<'_> {
    fn interaction(&mut self, line: usize) {
        // Count only timed lines here. All other executions are reported with their sprites.
        if self.guards.runs_by_clock(line) {
            self.count(line);
        }
    }

    fn wants_meetings(&self) -> bool {
        true
    }

    fn meeting(&mut self, meeting: Meeting) {
        if !self.guards.runs_by_clock(meeting.line) && !self.guards.covers(meeting) {
            self.count(meeting.line);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measures::SIGHT;
    use engine::Action;
    use engine::Action::{Nil, Right};

    /// A game in which crates go into pits, wasps fly along a row, and a beetle strolls.
    const GAME: &str = "BasicGame\n  SpriteSet\n    pit > Immovable\n    crate > Passive\n    wasp > Missile orientation=LEFT speed=1\n    beetle > RandomNPC\n    avatar > MovingAvatar\n  LevelMapping\n    o > pit\n    c > crate\n    s > wasp\n    b > beetle\n  InteractionSet\n    avatar wall > stepBack\n    crate avatar > bounceForward\n    crate wall > undoAll\n    crate pit > killSprite scoreChange=1\n    avatar wasp > killSprite\n    wasp wall > reverseDirection\n    beetle wall avatar > stepBack\n    avatar EOS > stepBack\n  TerminationSet\n    SpriteCounter stype=crate win=True\n    SpriteCounter stype=avatar win=False\n";

    fn check(level: &str, actions: &[Action]) -> PlayMeasures {
        let game = Game::from_source(GAME).unwrap();
        let level = game.level(level).unwrap();
        let (mut episode, mut state) = Episode::begin(&game, &level, Seed::from_text("play"));
        for &action in actions {
            episode.play(&game, &mut state, action);
        }
        let recording = [Recorded { level: &level, episodes: &[episode] }];
        let of = || PlayMeasures::of(&Analysis::of(&game), &recording, Seed::from_text("futures")).unwrap();
        assert_eq!(of(), of());
        of()
    }

    #[test]
    fn puzzles_have_no_pace() {
        // The first two steps are in the open, then the crate moves, and then it falls.
        let found = check("wwwwwwww\nwA  c ow\nw      w\nwwwwwwww\n", &[Nil, Right, Right, Right, Right]);
        assert_eq!(found.pace, 2.0 / 5.0, "{found:?}");
        // These are `bounceForward` twice and `killSprite` once. The guards do not count.
        assert_eq!((found.density, found.mechanics), (3.0 / 5.0, 2), "{found:?}");
        // The player cannot lose, and the level is deterministic without a beetle.
        assert_eq!((found.drama, found.lead_changes, found.chance), (0.0, 0.0, 0.0), "{found:?}");
        // The win is seen 8, 4, 4, 2 and 1 ticks ahead.
        assert_eq!(found.sight, 3.8, "{found:?}");
    }

    #[test]
    fn moving_types_set_the_pace() {
        let flight = check("wwwwwwww\nwA c   ow\nwwwwwwww\nwo   s w\nwwwwwwww\n", &[Nil; 4]);
        // Missiles start moving in their second tick.
        assert_eq!((flight.pace, flight.chance, flight.mechanics), (0.75, 0.0, 0), "{flight:?}");
        let stroll = check("wwwwwwww\nwA c  ow\nwwwwwwww\nwob    w\nwwwwwwww\n", &[Nil; 12]);
        assert_eq!(stroll.chance, 1.0, "{stroll:?}");
    }

    #[test]
    fn danger_raises_drama_and_shortens_planning_depth() {
        // In the wasp's row, the game leads against an avatar that stays there. In the row below, the crate is one push
        // away from its pit.
        let danger = check("wwwwwwwww\nwA     sw\nwwwwwwwww\nw c o   w\nwwwwwwwww\n", &[Right; 1]);
        assert!(danger.drama > 0.9, "{danger:?}");
        let calm = check("wwwwwwwww\nwA      w\nwwwwwwwww\nw c o   w\nwwwwwwwww\n", &[Right; 1]);
        assert_eq!((calm.drama, calm.sight), (0.0, SIGHT as f64), "{calm:?}");
    }

    #[test]
    fn the_lead_changes_with_its_sign() {
        assert_eq!(changes([0.0, -0.5, 0.0, 0.25, 0.5, -0.25, 1.0].into_iter()), 3);
        assert_eq!(changes([0.0, 1.0].into_iter()), 0);
    }
}
