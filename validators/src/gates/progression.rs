//! The `progression` gate: checks that later levels need more mechanics than earlier ones and are not easier.

use super::{Gates, NO_WIN, careless, finding, without_subject, won_levels};
use crate::allowance::Setting;
use crate::evidence::{Evidence, Line};
use crate::measures::{Guards, mechanics};
use crate::validator::{GameCase, GameValidator};
use crate::verdict::Finding;
use std::collections::BTreeSet;

/// Passes if the mechanics needed to win grow over the levels. A level's mechanics are the interactions executed in its
/// shortest known win, not counting guards (rules that only keep sprites on the board). There are three conditions:
///
/// - At least [`Gates::growth`] levels need mechanics that no earlier level needed.
/// - The last level needs as many mechanics as the first, and at least [`Gates::last_share`] of all mechanics needed on
///   any level.
/// - The last level is not easier than either of the first two by more than [`Gates::easier`].
///
/// If a ladder (reference players of increasing strength) played every level, the ease of a level is its ease for these
/// players. If not, it is the win rate of careless players, which press a random key in some ticks. They play four
/// times as many episodes if the last level seems easier. Games with fewer than three levels have no progression to
/// judge. Costs one replay of each win, and the careless players' episodes.
#[derive(Clone, Debug)]
pub(crate) struct Progression(Gates);

/// The minimum number of levels that a game needs for a progression.
const COURSE: usize = 3;

pub(crate) const QUESTION: &str =
    "does each level introduce something new, and demand more than the level before?";

pub(crate) fn judge(setting: &Setting<'_>) -> Progression {
    Progression(setting.criteria.gates.clone())
}

impl GameValidator for Progression {
    fn validate(&self, case: GameCase<'_>) -> Finding {
        let gates = &self.0;
        let Some(wins) = won_levels(case) else { return without_subject(NO_WIN) };
        if wins.len() < COURSE {
            return without_subject("skipped: fewer than three levels have a known win");
        }
        let guards = Guards::of(case.analysis);
        let used: Vec<BTreeSet<usize>> =
            wins.iter().map(|won| mechanics(case.game, &guards, won.level, won.win)).collect();
        let mut all = BTreeSet::new();
        let mut growth = 0;
        for (number, used) in used.iter().enumerate() {
            let before = all.len();
            all.extend(used.iter().copied());
            growth += usize::from(number > 0 && all.len() > before);
        }
        let (first, last) = (&used[0], &used[used.len() - 1]);
        let counts: Vec<String> = used.iter().map(|used| used.len().to_string()).collect();
        let share = last.len() as f64 / all.len().max(1) as f64;
        let mut problems = Vec::new();
        if growth < gates.growth {
            problems.push(format!(
                "{growth} levels after the first bring new mechanics (at least {} required): the wins use {} of {} mechanics",
                gates.growth,
                counts.join(", "),
                all.len()
            ));
        }
        if last.len() < first.len() || share < gates.last_share {
            problems.push(format!(
                "the last level needs {} of {} mechanics, the first {}",
                last.len(),
                all.len(),
                first.len()
            ));
        }
        let eases = self.eases(case, &wins);
        let (ease, easiest) = last_and_easiest(&eases);
        if ease > easiest + gates.easier {
            problems.push(format!("the last level is easier ({ease:.2}) than an early one ({easiest:.2})"));
        }
        let problems = problems.into_iter().map(Evidence::new);
        let unused = all.difference(last).map(|&line| {
            let rule = Line::interaction(case.game, line);
            Evidence::new(format!("the last level does not use `{}`", rule.text)).of_rule(rule)
        });
        let texts: Vec<String> = eases.iter().map(|ease| format!("{ease:.2}")).collect();
        let notes = [
            format!("the wins use {} of {} mechanics, level by level", counts.join(", "), all.len()),
            format!("ease, level by level: {}", texts.join(", ")),
        ];
        finding(
            problems.collect(),
            notes.map(Evidence::new).into_iter().chain(unused).collect(),
            Some(growth as f64),
        )
    }
}

impl Progression {
    /// Returns the levels' ease, from 0 to 1. If the ease is the win rate of careless players and the first episodes
    /// count against the game, plays more episodes on the compared levels.
    fn eases(&self, case: GameCase<'_>, wins: &[super::WonLevel<'_>]) -> Vec<f64> {
        let of_ladder = |won: &super::WonLevel<'_>| case.ladders.get(won.number).copied().flatten()?.ease;
        let known: Option<Vec<f64>> = wins.iter().map(of_ladder).collect();
        if let Some(known) = known {
            return known;
        }
        let of_plays = |won: &super::WonLevel<'_>| careless::win_share(case.careless.plays(*won, &self.0));
        let mut eases: Vec<f64> = wins.iter().map(of_plays).collect();
        let (ease, easiest) = last_and_easiest(&eases);
        if ease > easiest + self.0.easier {
            for number in [0, 1, wins.len() - 1] {
                eases[number] = case.careless.closer_win_share(wins[number], &self.0);
            }
        }
        eases
    }
}

/// Returns the ease of the last level, and the lower ease of the first two levels.
fn last_and_easiest(eases: &[f64]) -> (f64, f64) {
    (eases[eases.len() - 1], eases[0].min(eases[1]))
}

#[cfg(test)]
mod tests {
    use crate::Criterion;
    use crate::gates::tests::check;

    const GAME: &str = "BasicGame\n  SpriteSet\n    plum > Immovable\n    key > Resource limit=2\n    gate > Immovable\n    crate > Passive\n    avatar > MovingAvatar\n  LevelMapping\n    p > plum\n    k > key\n    g > gate\n    c > crate\n  InteractionSet\n    avatar wall > stepBack\n    key avatar > collectResource\n    gate avatar > killIfOtherHasMore resource=key limit=1 subtract=True\n    avatar gate > stepBack\n    crate avatar > bounceForward\n    crate wall > undoAll\n    plum avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=plum win=True\n    Timeout limit=200 win=False\n";
    const FIRST: &str = "wwwwwwww\nwA    pw\nwwwwwwww\n";
    const SECOND: &str = "wwwwwwww\nwA c  pw\nwwwwwwww\nw      w\nwwwwwwww\n";
    const THIRD: &str = "wwwwwwww\nwA c  kw\nw wwwwww\nw    gpw\nwwwwwwww\n";

    #[test]
    fn mechanics_grow_or_stay() {
        let second = SECOND.replace("wA c  pw\nwwwwwwww\nw      w", "wA c   w\nwwww wpw\nw      w");
        check(Criterion::Progression, GAME, &[FIRST, &second, THIRD], None);
        check(
            Criterion::Progression,
            GAME,
            &[FIRST, FIRST, FIRST],
            Some("0 levels after the first bring new mechanics"),
        );
        check(
            Criterion::Progression,
            GAME,
            &[FIRST, &second, THIRD, FIRST],
            Some("the last level needs 1 of"),
        );
    }
}
