//! A measure of progress towards a win, derived from the meaning of the rules.
//!
//! The measure has two parts. *Progress* counts the sprites that must still disappear or appear for a winning
//! termination, and the keys that the avatar holds. *Closeness* is the proximity of the next useful target, with
//! paths around obstacles. Closeness is at most 1, so that taking a target is worth more than standing in front of
//! the next one.

use base::Digest;
use engine::analysis::{Attainable, Fate, Goal, Harm, Key, Removal, Touch};
use engine::{Analysis, Game, SpriteType, State};
use std::collections::VecDeque;

/// The distance, in cells, at which closeness is one half.
const HALF_WAY: f64 = 8.0;
const UNREACHED: u16 = u16::MAX;

/// The useful targets in a game, by avatar type.
#[derive(Clone, Debug)]
pub(crate) struct GoalGuide {
    digest: Digest,
    analysis: Analysis,
    /// The winning terminations that depend on sprite counts and can be satisfied through play.
    goals: Vec<Goal>,
    /// The targets for each avatar type, in the order of [`Analysis::avatars`].
    targets: Vec<Targets>,
    /// Pairs of a pushable type and the type onto which it must be pushed.
    pushes: Vec<(SpriteType, SpriteType)>,
}

/// The roles of a game's types for avatars of one type.
#[derive(Clone, Debug)]
struct Targets {
    avatar: SpriteType,
    blocks: Vec<SpriteType>,
    targets: Vec<Target>,
}

#[derive(Clone, Debug)]
struct Target {
    stype: SpriteType,
    /// The resource that the target requires, with the required amount; `None` if it requires none.
    needs: Option<(SpriteType, i32)>,
}

/// Buffers for the distance search.
#[derive(Clone, Debug, Default)]
pub(crate) struct Distances {
    steps: Vec<u16>,
    queue: VecDeque<u32>,
}

impl GoalGuide {
    /// Derives the targets from the rules. Cost: one [`Analysis::of`].
    pub(crate) fn of(game: &Game) -> GoalGuide {
        let analysis = Analysis::of(game);
        let wanted = |goal: &&Goal| {
            goal.win && goal.attainable == Attainable::InPlay && !goal.condition.types().is_empty()
        };
        let goals: Vec<Goal> = analysis.goals().iter().filter(wanted).cloned().collect();
        let targets =
            analysis.avatars().iter().map(|avatar| targets_of(game, &analysis, avatar.stype)).collect();
        let aims = analysis.aims();
        let mut pushes = Vec::new();
        for pushable in analysis.pushables() {
            for sink in &pushable.sinks {
                let helps = match sink.fate {
                    Fate::Becomes(to) => aims.create.contains(&to) || aims.remove.contains(&pushable.stype),
                    Fate::Goes => aims.remove.contains(&pushable.stype),
                    Fate::Stays => false,
                };
                let fills = sink.fills && aims.remove.contains(&sink.partner);
                if helps || fills || !sink.opens.is_empty() {
                    pushes.push((pushable.stype, sink.partner));
                }
            }
        }
        GoalGuide { digest: game.digest(), analysis, goals, targets, pushes }
    }

    /// Returns `true` if the guide was created for this game.
    pub(crate) fn fits(&self, game: &Game) -> bool {
        self.digest == game.digest()
    }

    /// Returns the progress of a state: minus one for each sprite that must still disappear or appear, plus at most
    /// one for the keys that the avatar holds.
    pub(crate) fn progress(&self, state: &State) -> f64 {
        let missing = self.goals.iter().map(|goal| self.analysis.missing(goal, state)).min();
        let avatar = state.avatar_type();
        let keys = self.analysis.locks().iter().map(|lock| match &lock.key {
            Key::Avatar(stype) => f64::from(u8::from(avatar == Some(*stype))),
            Key::Resource { resource, amount, .. } => {
                f64::from(state.amount_held(*resource).clamp(0, *amount)) / f64::from((*amount).max(1))
            }
            Key::Switch(..) => 0.0,
        });
        let keys = keys.fold(0.0, f64::max);
        keys - f64::from(missing.unwrap_or(0).min(1000))
    }

    /// Returns the closeness of the nearest useful target, from 0 to 1, or 0 if there is no target. Cost: O(cells +
    /// sprites).
    pub(crate) fn closeness(&self, state: &State, distances: &mut Distances) -> f64 {
        let Some(targets) = state.avatar_type().and_then(|avatar| self.targets_of(avatar)) else {
            return 0.0;
        };
        let Some(place) = state.avatar_place() else { return 0.0 };
        let at = cell(state, place);
        self.flood(targets, state, at, distances);
        let (columns, rows) = state.size();
        let mut nearest = f64::INFINITY;
        // If a cell cannot be entered, its distance is that of its nearest neighbour plus one.
        let mut consider = |place: (i32, i32), further: f64, distances: &Distances| {
            let (x, y) = cell(state, place);
            let reached = [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)].into_iter().filter_map(|(dx, dy)| {
                let (x, y) = (x + dx, y + dy);
                let inside = (0..columns).contains(&x) && (0..rows).contains(&y);
                let steps = inside.then(|| distances.steps[(y * columns + x) as usize])?;
                (steps != UNREACHED).then(|| f64::from(steps) + f64::from(u8::from((dx, dy) != (0, 0))))
            });
            let straight = f64::from((x - at.0).abs() + (y - at.1).abs());
            // A target to which no path is known has little value, but more value if it is near.
            let steps = reached.fold(f64::INFINITY, f64::min).min(40.0 + 4.0 * straight);
            nearest = nearest.min(steps + further);
        };
        for target in &targets.targets {
            if target.needs.is_none_or(|(resource, amount)| state.amount_held(resource) >= amount) {
                state.places(target.stype).for_each(|place| consider(place, 0.0, distances));
            }
        }
        for &(pushed, onto) in &self.pushes {
            for place in state.places(pushed) {
                let (x, y) = cell(state, place);
                let apart = state.places(onto).map(|other| {
                    let (u, v) = cell(state, other);
                    f64::from((x - u).abs() + (y - v).abs())
                });
                let apart = apart.fold(f64::INFINITY, f64::min);
                if apart > 0.0 && apart.is_finite() {
                    consider(place, 3.0 * apart, distances);
                }
            }
        }
        HALF_WAY / (HALF_WAY + nearest)
    }

    fn targets_of(&self, avatar: SpriteType) -> Option<&Targets> {
        self.targets.iter().find(|targets| targets.avatar == avatar)
    }

    /// Computes the number of steps from a cell to every other cell, around obstacles.
    fn flood(&self, targets: &Targets, state: &State, from: (i32, i32), distances: &mut Distances) {
        let (columns, rows) = state.size();
        let Distances { steps: distances, queue } = distances;
        distances.clear();
        distances.resize((columns * rows) as usize, UNREACHED);
        let index = |(x, y): (i32, i32)| {
            ((0..columns).contains(&x) && (0..rows).contains(&y)).then(|| (y * columns + x) as usize)
        };
        // Blocked cells count as reached during the flood.
        for &stype in &targets.blocks {
            for place in state.places(stype) {
                if let Some(at) = index(cell(state, place)) {
                    distances[at] = UNREACHED - 1;
                }
            }
        }
        queue.clear();
        if let Some(at) = index(from) {
            distances[at] = 0;
            queue.push_back(at as u32);
        }
        while let Some(at) = queue.pop_front() {
            let steps = distances[at as usize];
            let (x, y) = (at as i32 % columns, at as i32 / columns);
            for next in [(x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)] {
                if let Some(next) = index(next)
                    && distances[next] == UNREACHED
                {
                    distances[next] = steps + 1;
                    queue.push_back(next as u32);
                }
            }
        }
        distances.iter_mut().filter(|steps| **steps == UNREACHED - 1).for_each(|steps| *steps = UNREACHED);
    }
}

fn cell(state: &State, (x, y): (i32, i32)) -> (i32, i32) {
    let block = state.block().max(1);
    ((x + block / 2).div_euclid(block), (y + block / 2).div_euclid(block))
}

fn targets_of(game: &Game, analysis: &Analysis, avatar: SpriteType) -> Targets {
    let aims = analysis.aims();
    let shots = analysis.avatars().iter().find(|known| known.stype == avatar);
    let shots = shots.map_or(&[][..], |known| &known.shots);
    let mut blocks = Vec::new();
    let mut targets = Vec::new();
    for stype in game.sprite_types().filter(|&stype| stype != avatar && analysis.facts(stype).possible) {
        let touch: &Touch = analysis.touch(avatar, stype);
        if (touch.blocks && !touch.pushes) || touch.harm == Harm::Kills {
            blocks.push(stype);
        }
        let wanted = aims.remove.contains(&stype);
        let unlocked = |resource: &SpriteType| {
            analysis.resources().iter().any(|known| known.stype == *resource && known.needed > 0)
        };
        let gives = touch.gives.iter().any(|(resource, amount)| *amount > 0 && unlocked(resource));
        let creates = touch.makes.iter().chain(&touch.changes).any(|to| aims.create.contains(to));
        let useful = gives
            || creates
            || touch.score > 0
            || touch.becomes.is_some()
            || touch.opens.iter().any(|opened| wanted || analysis.blocks(*opened, avatar))
            || (wanted && touch.ends_other());
        let by_shot = wanted
            && !touch.ends_other()
            && shots.iter().any(|&shot| analysis.between(stype, shot).next().is_some());
        let needs = match touch.removal {
            Removal::IfHolds(resource, amount) => Some((resource, amount)),
            _ => touch.safe_with,
        };
        if (useful && (touch.harm < Harm::Wounds || needs.is_some())) || by_shot {
            targets.push(Target { stype, needs });
        }
    }
    Targets { avatar, blocks, targets }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::Seed;
    use engine::Action;

    /// A test game in which a key turns the bear into a different avatar, and only that avatar can open the
    /// hive.
    const GAME: &str = "BasicGame\n  SpriteSet\n    hive > Door\n    key > Immovable\n    trap > Immovable\n    avatar >\n      bear > MovingAvatar\n      smith > MovingAvatar\n  LevelMapping\n    h > hive\n    k > key\n    t > trap\n    b > bear\n  InteractionSet\n    avatar wall > stepBack\n    bear hive > stepBack\n    bear trap > killSprite\n    smith trap > killSprite\n    hive smith > killSprite scoreChange=1\n    bear key > transformTo stype=smith\n    key smith > killSprite\n  TerminationSet\n    SpriteCounter stype=hive win=True\n    SpriteCounter stype=avatar win=False\n";

    #[track_caller]
    fn check(level: &str, actions: &[Action], progress: f64, steps: f64) {
        let game = Game::from_source(GAME).unwrap();
        let guide = GoalGuide::of(&game);
        let mut state = game.start(&game.level(level).unwrap(), Seed::from_text("compass"));
        for &action in actions {
            game.step(&mut state, action);
        }
        assert_eq!(guide.progress(&state), progress);
        let closeness = guide.closeness(&state, &mut Distances::default());
        assert_eq!(closeness, if steps.is_finite() { HALF_WAY / (HALF_WAY + steps) } else { 0.0 });
    }

    #[test]
    fn keys_come_before_doors_and_paths_avoid_walls() {
        // One hive must be removed, and the key is two steps away. The hive beside the bear is useless for now.
        check("hb k", &[], -1.0, 2.0);
        // Once the bear has the key, the hive is the target.
        check("hb k", &[Action::Right, Action::Right], 0.0, 3.0);
        // The paths lead around the wall and the trap. There is no hive to remove here.
        check("bwk\n w \n   ", &[], 0.0, 6.0);
        check("btk\n t \n   ", &[], 0.0, 6.0);
        // There is no useful target, because there is neither a key nor a path.
        check("b h", &[], -1.0, f64::INFINITY);
    }
}
