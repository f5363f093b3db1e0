//! The `no-dead-time` gate: checks that a win has no long stretch in which playing has no effect.

use super::{Gates, NO_WIN, WonLevel, finding, without_subject, won_levels};
use crate::allowance::Setting;
use crate::evidence::Evidence;
use crate::validator::{GameCase, GameValidator};
use crate::verdict::Finding;
use engine::analysis::{Motion, Role};
use engine::{Analysis, SpriteType, State};
use std::collections::BTreeSet;

/// Passes if the longest stretch without progress in the shortest known win takes at most [`Gates::dead_share`] of the
/// win's ticks, or at most [`Gates::dead_ticks`] ticks.
///
/// A tick makes progress if one of these changes:
///
/// - the score
/// - the avatar's type or resources
/// - the number of sprites that a termination counts
/// - the number of a type's stationary sprites
/// - the position of a pushable sprite
///
/// It also makes progress if the avatar enters a cell that it has not visited since the last such change. Waiting,
/// pacing to and fro and walking back are therefore dead time. Costs one replay of each win.
#[derive(Clone, Debug)]
pub(crate) struct NoDeadTime(Gates);

pub(crate) const QUESTION: &str = "does every stretch of the win make progress?";

pub(crate) fn judge(setting: &Setting<'_>) -> NoDeadTime {
    NoDeadTime(setting.criteria.gates.clone())
}

impl GameValidator for NoDeadTime {
    fn validate(&self, case: GameCase<'_>) -> Finding {
        let Some(wins) = won_levels(case) else { return without_subject(NO_WIN) };
        let telling = Telling::of(case.analysis);
        let (mut problems, mut notes, mut worst) = (Vec::new(), Vec::new(), 0.0f64);
        for won in wins {
            let ticks = won.ticks();
            let (dead, from) = telling.longest_stretch(won, case);
            let most = ((ticks as f64 * self.0.dead_share) as usize).max(self.0.dead_ticks);
            worst = worst.max(dead as f64 / ticks.max(1) as f64);
            let text = format!(
                "level {}: {dead} of the {ticks} ticks of a win make no progress (at most {most} allowed)",
                won.number
            );
            let seen = Evidence { tick: Some(from + 1), ..Evidence::new(text) };
            match dead <= most {
                true => notes.push(seen),
                false => problems
                    .push(seen.advise("shorten the wait, or give the player something to do meanwhile")),
            }
        }
        finding(problems, notes, Some(worst))
    }
}

/// The types whose sprite counts or positions indicate progress.
struct Telling {
    /// The types whose sprite counts indicate progress.
    counted: Vec<SpriteType>,
    /// The types whose sprites' positions indicate progress.
    pushed: Vec<SpriteType>,
    resources: Vec<SpriteType>,
}

/// The part of a state that indicates progress.
#[derive(PartialEq)]
struct Standing {
    score: f64,
    avatar: Option<SpriteType>,
    held: Vec<i32>,
    alive: Vec<usize>,
    places: Vec<(i32, i32)>,
}

impl Telling {
    fn of(analysis: &Analysis) -> Telling {
        let game = analysis.game();
        let goals: BTreeSet<SpriteType> =
            analysis.goals().iter().flat_map(|goal| goal.condition.types()).copied().collect();
        let stands = |stype: SpriteType| {
            let facts = analysis.facts(stype);
            facts.possible && facts.motion == Motion::Still && !facts.fleeting
        };
        let counts = |stype: &SpriteType| {
            goals.contains(stype) || stands(*stype) && analysis.role(*stype) != Role::Shot
        };
        let pushed = analysis.pushables().iter().map(|pushable| pushable.stype).collect();
        let resources = game.sprite_types().filter(|&stype| analysis.facts(stype).is_resource).collect();
        Telling { counted: game.sprite_types().filter(counts).collect(), pushed, resources }
    }

    fn standing(&self, state: &State) -> Standing {
        Standing {
            score: state.score(),
            avatar: state.avatar_type(),
            held: self.resources.iter().map(|&stype| state.amount_held(stype)).collect(),
            alive: self.counted.iter().map(|&stype| state.alive(stype)).collect(),
            places: self.pushed.iter().flat_map(|&stype| state.places(stype)).collect(),
        }
    }

    /// Returns the number of ticks in the longest stretch of a win without progress, and the tick before that stretch.
    fn longest_stretch(&self, won: WonLevel<'_>, case: GameCase<'_>) -> (usize, usize) {
        let mut state = case.game.start(won.level, won.win.seed);
        let mut standing = self.standing(&state);
        let mut been: BTreeSet<Option<(i32, i32)>> = [state.avatar_place()].into();
        let (mut since, mut longest) = (0, (0, 0));
        for (tick, &action) in won.win.actions.iter().enumerate() {
            case.game.step(&mut state, action);
            let now = self.standing(&state);
            let happened = now != standing || state.is_over();
            standing = now;
            if happened {
                been.clear();
            }
            if been.insert(state.avatar_place()) || happened {
                since = tick + 1;
            }
            if tick + 1 - since > longest.0 {
                longest = (tick + 1 - since, since);
            }
        }
        longest
    }
}

#[cfg(test)]
mod tests {
    use crate::Criterion;
    use crate::gates::tests::check;

    const GAME: &str = "BasicGame\n  SpriteSet\n    plum > Immovable\n    slug > Missile orientation=LEFT cooldown=6\n    avatar > MovingAvatar\n  LevelMapping\n    p > plum\n    s > slug\n  InteractionSet\n    avatar wall > stepBack\n    slug avatar > killSprite scoreChange=1\n    plum avatar > killSprite scoreChange=1\n  TerminationSet\n    MultiSpriteCounter stype1=plum stype2=slug limit=0 win=True\n    Timeout limit=200 win=False\n";

    #[test]
    fn walking_is_progress_and_waiting_is_not() {
        check(
            Criterion::NoDeadTime,
            GAME,
            &["wwwwwwwwwwwwwwwwwwww\nwA                pw\nwwwwwwwwwwwwwwwwwwww\n"],
            None,
        );
        check(Criterion::NoDeadTime, GAME, &["wwwwwwwwww\nwA      sw\nwwwwwwwwww\n"], None);
        let barred = GAME
            .replace(
                "    avatar wall > stepBack\n",
                "    avatar wall > stepBack\n    avatar bar > stepBack\n",
            )
            .replace("    avatar > MovingAvatar\n", "    bar > Immovable\n    avatar > MovingAvatar\n")
            .replace("    s > slug\n", "    s > slug\n    b > bar\n");
        check(
            Criterion::NoDeadTime,
            &barred,
            &["wwwwwwwwww\nwAb     sw\nwwwwwwwwww\n"],
            Some("make no progress"),
        );
    }
}
