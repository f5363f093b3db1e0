//! The `tight` gate: checks that a win uses most of the available resources, and that players who press a random key in
//! some ticks rarely win.

use super::{Gates, NO_WIN, WonLevel, careless, finding, without_subject, won_levels};
use crate::allowance::Setting;
use crate::evidence::Evidence;
use crate::validator::{GameCase, GameValidator};
use crate::verdict::Finding;
use engine::State;
use engine::analysis::Resource;

/// Passes if the fraction of consumables left after a win, averaged over the levels, is within [`Gates::spare`].
/// Careless players, which head for the nearest goal but press a random key in some ticks, must win at most
/// [`Gates::careless_wins`] of their episodes on levels after the first. If they win more, they play four times as many
/// episodes.
///
/// A consumable is a resource that a rule takes, or that shots cost. Its supply is the amount that the avatar spends in
/// the win, holds at the end, and could still collect from the board. Levels on which the win spends no consumables are
/// skipped. Costs one replay of each win, and the careless players' episodes.
#[derive(Clone, Debug)]
pub(crate) struct Tight(Gates);

pub(crate) const QUESTION: &str =
    "does a win use up most of the resources, and does a careless player rarely win?";

pub(crate) fn judge(setting: &Setting<'_>) -> Tight {
    Tight(setting.criteria.gates.clone())
}

impl GameValidator for Tight {
    fn validate(&self, case: GameCase<'_>) -> Finding {
        let gates = &self.0;
        let Some(wins) = won_levels(case) else { return without_subject(NO_WIN) };
        let (mut problems, mut notes, mut spares) = (Vec::new(), Vec::new(), Vec::new());
        let consumed = |resource: &&Resource| !resource.takers.is_empty() || resource.is_ammunition;
        for won in &wins {
            for resource in case.analysis.resources().iter().filter(consumed) {
                let Some((spent, left)) = balance(case, *won, resource) else { continue };
                spares.push(left / (spent + left));
                let name = case.game.name(resource.stype);
                let text = format!("level {}: a win spends {spent} `{name}` and leaves {left}", won.number);
                notes.push(Evidence::new(text));
            }
        }
        let later = || wins.iter().filter(|won| won.number > 0 || wins.len() == 1);
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len().max(1) as f64;
        if !spares.is_empty() {
            let (spare, (least, most)) = (mean(&spares), gates.spare);
            let text = format!(
                "a win leaves {:.0}% of the consumables on average ({:.0} to {:.0}% required)",
                100.0 * spare,
                100.0 * least,
                100.0 * most
            );
            let seen = Evidence::new(text).advise("place fewer resources, or require more");
            if spare < least || spare > most { &mut problems } else { &mut notes }.push(seen);
        }
        let shares = |of: &dyn Fn(&WonLevel<'_>) -> f64| mean(&later().map(of).collect::<Vec<f64>>());
        let mut won = shares(&|won| careless::win_share(case.careless.plays(*won, gates)));
        if won > gates.careless_wins {
            won = shares(&|won| case.careless.closer_win_share(*won, gates));
        }
        let text = format!(
            "careless players win {:.0}% of their episodes (at most {:.0}% allowed)",
            100.0 * won,
            100.0 * gates.careless_wins
        );
        let seen = Evidence::new(text).advise("make careless play costly");
        if won > gates.careless_wins { &mut problems } else { &mut notes }.push(seen);
        finding(problems, notes, (!spares.is_empty()).then(|| mean(&spares)))
    }
}

/// Returns the spent and the remaining amount of a resource in a win, or `None` if the win does not spend the resource.
fn balance(case: GameCase<'_>, won: WonLevel<'_>, resource: &Resource) -> Option<(f64, f64)> {
    let held = |state: &State| state.amount_held(resource.stype);
    let mut state = case.game.start(won.level, won.win.seed);
    let mut before = held(&state);
    let mut spent = 0;
    for &action in &won.win.actions {
        case.game.step(&mut state, action);
        // A dead avatar holds nothing, so its resources would count as spent, but a win ends with a living avatar.
        spent += (before - held(&state)).max(0);
        before = held(&state);
    }
    let givers = resource.givers.iter().filter(|(_, amount)| *amount > 0);
    let placed: i64 = givers.map(|(stype, amount)| state.alive(*stype) as i64 * i64::from(*amount)).sum();
    (spent > 0).then(|| (f64::from(spent), f64::from(before.max(0)) + placed as f64))
}

#[cfg(test)]
mod tests {
    use crate::Criterion;
    use crate::gates::tests::{check, judged};
    use crate::{Gates, Verdict};

    /// A game in which every gate costs a key, and traps lie beside the path.
    const GAME: &str = "BasicGame\n  SpriteSet\n    plum > Immovable\n    trap > Immovable\n    key > Resource limit=9\n    gate > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    p > plum\n    t > trap\n    k > key\n    g > gate\n  InteractionSet\n    avatar wall > stepBack\n    avatar trap > killSprite\n    key avatar > collectResource\n    gate avatar > killIfOtherHasMore resource=key limit=1 subtract=True\n    avatar gate > stepBack\n    plum avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=plum win=True\n    SpriteCounter stype=avatar win=False\n    Timeout limit=60 win=False\n";
    const NARROW: &str = "wwwwwwwwwwwww\nwttttttttttww\nwAkkkk g g gw\nwtttttttttt w\nwwwwtttt    w\nwwwwtp   ttww\nwwwwwwwwwwwww\n";

    #[test]
    fn slack_and_carelessness_are_measured() {
        check(Criterion::Tight, GAME, &[NARROW], None);
        let slack = NARROW.replace("kkkk g g g", "kkkkkkkk g");
        check(Criterion::Tight, GAME, &[&slack], Some("a win leaves 88% of the consumables"));
        check(Criterion::Tight, GAME, &["wwwwww\nwA  pw\nwwwwww\n"], Some("careless players win 100%"));
    }

    /// The first episode is won, and so are two of the next three.
    #[test]
    fn few_plays_are_followed_by_more() {
        let level = "wttttw\nwA  pw\nwttttw\n";
        let judge = |careless_wins| {
            let few = |gates: &mut Gates| (gates.careless_plays, gates.careless_wins) = (1, careless_wins);
            judged(Criterion::Tight, GAME, &[level], few).verdict
        };
        assert!(matches!(judge(0.8), Verdict::Pass { .. }), "{:?}", judge(0.8));
        let Verdict::Fail { reason, .. } = judge(0.7) else { panic!("{:?}", judge(0.7)) };
        assert!(reason.0.contains("careless players win 75%"), "{reason:?}");
    }
}
