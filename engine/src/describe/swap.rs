//! Swaps: three interaction lines that turn two types into each other by way of a third type.

use crate::analysis::{Analysis, EffectSummary, Encounter};
use crate::rules::{SpriteType, Timed};

/// Two types that turn into each other in the same collision.
pub(super) struct Swap {
    pub(super) one: SpriteType,
    pub(super) other: SpriteType,
    /// The type that exists only between the first and the third line.
    between: SpriteType,
}

impl Swap {
    /// Returns the swap that three consecutive parts of the interactions form, if any. Each part contains the
    /// encounters of one line.
    pub(super) fn of(analysis: &Analysis, parts: &[(usize, Vec<&Encounter>)]) -> Option<Swap> {
        let [first, second, third] = parts else { return None };
        let pairs = |part: &(usize, Vec<&Encounter>)| {
            part.1.iter().map(|encounter| (encounter.first, encounter.second)).collect::<Vec<_>>()
        };
        let (one, between) = changed(analysis, first)?;
        let (other, back) = changed(analysis, second)?;
        let is_swap = back == one && changed(analysis, third)? == (between, other);
        let is_together = pairs(first) == pairs(second) && pairs(second) == pairs(third);
        let is_between = is_made_once(analysis, between) && one != other && between != other;
        (is_swap && is_together && is_between).then_some(Swap { one, other, between })
    }

    /// Returns the types that exist only while a swap is under way.
    pub(super) fn betweens(analysis: &Analysis) -> Vec<SpriteType> {
        let parts = parts(analysis);
        parts.windows(3).filter_map(|three| Some(Swap::of(analysis, three)?.between)).collect()
    }
}

/// Returns the encounters of each interaction line, in order of execution.
pub(super) fn parts(analysis: &Analysis) -> Vec<(usize, Vec<&Encounter>)> {
    let parts = analysis.encounters().chunk_by(|one, next| one.line == next.line);
    parts.map(|part| (part[0].line, part.iter().collect())).collect()
}

/// Returns the two types of a line that does nothing except turn every sprite of the first type into a sprite of the
/// second; `None` for any other line.
fn changed(
    analysis: &Analysis,
    (line, encounters): &(usize, Vec<&Encounter>),
) -> Option<(SpriteType, SpriteType)> {
    let info = analysis.game().0.effects.iter().find(|info| info.line == *line)?;
    let is_plain = info.score_change == 0 && info.summary.score_if_killed == 0 && info.counting.is_none();
    let is_met = encounters.iter().all(|encounter| encounter.second.is_some());
    match info.summary.effects[..] {
        [EffectSummary::BecomeAll(of, to)] if is_plain && is_met => Some((of, to)),
        _ => None,
    }
}

/// Returns `true` if no level places a type's sprites and only one line creates them.
fn is_made_once(analysis: &Analysis, stype: SpriteType) -> bool {
    let game = analysis.game();
    let makes = |encounter: &&Encounter| encounter.does(|effect| effect.makes().contains(&stype));
    let mut lines: Vec<usize> = analysis.encounters().iter().filter(makes).map(|made| made.line).collect();
    lines.dedup();
    let is_placed = game
        .description()
        .mapping
        .iter()
        .flat_map(|line| &line.names)
        .any(|word| word.text == game.name(stype));
    let is_spawned = game.sprite_types().any(|maker| analysis.facts(maker).makes.contains(&stype));
    let effects = |timed: &Timed| &game.0.effects[usize::from(timed.effect)].summary.effects;
    let is_timed = game.0.timed.iter().flat_map(effects).any(|effect| effect.makes().contains(&stype));
    lines.len() == 1 && !is_placed && !is_spawned && !is_timed
}
