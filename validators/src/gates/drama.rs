//! The `drama` gate: checks that a win is in doubt along the way.

use super::{Gates, NO_WIN, measured, without_subject, won_levels};
use crate::PlayMeasures;
use crate::allowance::Setting;
use crate::evidence::Evidence;
use crate::recording::Recorded;
use crate::validator::{GameCase, GameValidator};
use crate::verdict::Finding;
use std::slice;

/// Passes if the drama of the shortest known wins ([`PlayMeasures::drama`]) averages at least [`Gates::drama`] over the
/// levels. Costs one call of [`PlayMeasures::of`] per level, which takes a few milliseconds.
#[derive(Clone, Debug)]
pub(crate) struct Drama(Gates);

pub(crate) const QUESTION: &str = "does the way to the win have ups and downs?";

pub(crate) fn judge(setting: &Setting<'_>) -> Drama {
    Drama(setting.criteria.gates.clone())
}

impl GameValidator for Drama {
    fn validate(&self, case: GameCase<'_>) -> Finding {
        let won = won_levels(case).unwrap_or_default();
        let recording: Vec<Recorded<'_>> =
            won.iter().map(|won| Recorded { level: won.level, episodes: slice::from_ref(won.win) }).collect();
        let Some(play) = PlayMeasures::of(case.analysis, &recording, case.seed) else {
            return without_subject(NO_WIN);
        };
        let (drama, least) = (play.drama, self.0.drama);
        let text = format!(
            "drama is {drama:.2} on average over {} levels (at least {least:.2} required)",
            play.levels
        );
        let note =
            Evidence::new(text).advise("add danger on the way to the goal, or costs that can ruin a win");
        measured(drama >= least, note, drama)
    }
}

#[cfg(test)]
mod tests {
    use crate::Criterion;
    use crate::gates::tests::check;

    const GAME: &str = "BasicGame\n  SpriteSet\n    plum > Immovable\n    trap > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    p > plum\n    t > trap\n  InteractionSet\n    avatar wall > stepBack\n    avatar trap > killSprite\n    plum avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=plum win=True\n    SpriteCounter stype=avatar win=False\n    Timeout limit=200 win=False\n";

    #[test]
    fn a_way_between_traps_is_dramatic_and_an_empty_room_is_not() {
        let narrow = "wwwwwwwwwwww\nwtttttttttpw\nwA         w\nwttttttttttw\nwwwwwwwwwwww\n";
        check(Criterion::Drama, GAME, &[narrow], None);
        let calm = "wwwwwwwwwwww\nwA        pw\nwwwwwwwwwwww\n";
        check(Criterion::Drama, GAME, &[calm], Some("drama is 0.00"));
    }
}
