//! The `readable` criterion: checks that a player can see everything that decides the game.

use crate::allowance::Setting;
use crate::case::Case;
use crate::evidence::{Evidence, Line};
use crate::explain::board::drawn;
use crate::validator::Validator;
use crate::verdict::{Finding, Verdict};
use engine::analysis::{Analysis, Reach, Role};
use engine::{Game, Level, SpriteType};
use itertools::Itertools;

/// Passes if every visible type has a character of its own and nothing decisive is hidden.
///
/// A type is decisive if it counts towards a win or a loss, or if it affects the avatar. It is a failure if such a type
/// is `hidden`, or if the level places it only under sprites that cover it. A hidden type that only creates other
/// sprites (a spawner) is reported, but is not a failure. Covered types that are not decisive are scenery.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Readable;

/// The number of printable characters, excluding the space. Each visible type needs one character.
const CHARACTERS: usize = 94;

pub(crate) const QUESTION: &str = "can the player see everything that decides the game?";

pub(crate) fn judge(_: &Setting<'_>) -> Readable {
    Readable
}

impl Validator for Readable {
    fn validate(&self, case: Case<'_>) -> Finding {
        let Case { game, level, analysis, .. } = case;
        let reach = analysis.reach(level);
        let mut faults = Vec::new();
        let mut notes = Vec::new();
        let hidden = |stype: &&SpriteType| is_present(&reach, **stype);
        for &stype in analysis.unseen().iter().filter(hidden) {
            let name = game.name(stype);
            let seen = Evidence { rule: Line::sprite(game, name), ..Evidence::default() };
            if decides(analysis, stype) {
                let text = format!("`{name}` affects the outcome, but is hidden");
                faults.push(Evidence { text, ..seen }.advise("remove `hidden=True`"));
            } else {
                notes
                    .push(Evidence { text: format!("`{name}` is hidden, but spawns other sprites"), ..seen });
            }
        }
        faults.extend(covered(analysis, level));
        let visible = |stype: &SpriteType| is_present(&reach, *stype) && !analysis.facts(*stype).hidden;
        let types = game.sprite_types().filter(visible).count();
        if types > CHARACTERS {
            faults.push(Evidence::new(format!(
                "{types} types are visible, but there are only {CHARACTERS} characters"
            )));
        }
        let verdict = match faults.first() {
            None => Verdict::pass(),
            Some(fault) => Verdict::fail(fault.text.clone()),
        };
        Finding::from(verdict).seen(faults).seen(notes)
    }
}

fn is_present(reach: &Reach, stype: SpriteType) -> bool {
    reach.touched(stype).next().is_some()
}

/// Returns `true` if a type counts towards a termination, or if a rule applies between the type and an avatar.
fn decides(analysis: &Analysis, stype: SpriteType) -> bool {
    let counted = analysis.goals().iter().any(|goal| goal.condition.types().contains(&stype));
    let meets = |avatar: SpriteType| {
        analysis.between(avatar, stype).next().is_some() || analysis.between(stype, avatar).next().is_some()
    };
    counted || analysis.avatars().iter().any(|avatar| meets(avatar.stype))
}

/// Returns evidence of the types that no character shows because the level always covers them with another type.
fn covered(analysis: &Analysis, level: &Level) -> Vec<Evidence> {
    let game = analysis.game();
    let visible = |stype: &&SpriteType| !analysis.facts(**stype).hidden;
    let ground = |stype: SpriteType| analysis.role(stype) == Role::Floor;
    let mut faults = Vec::new();
    let symbols = level.cells().iter().copied().sorted_unstable().dedup().collect_vec();
    let shown = |stype: &SpriteType| !ground(*stype) && !analysis.facts(*stype).hidden;
    for stype in game.sprite_types().filter(|stype| shown(stype) && decides(analysis, *stype)) {
        let with = |symbol: &&u8| game.places(**symbol).contains(&stype);
        let mut placing = symbols.iter().filter(with).peekable();
        let Some(&&first) = placing.peek() else { continue };
        // The avatar does not count as a cover, because it moves off the sprite on which it stands.
        let over = |symbol: u8| {
            let others = game.places(symbol).iter().filter(visible);
            others.copied().find(|&other| {
                other != stype
                    && analysis.role(other) != Role::Avatar
                    && drawn(game, other) > drawn(game, stype)
            })
        };
        let Some(cover) = over(first).filter(|_| placing.all(|&symbol| over(symbol).is_some())) else {
            continue;
        };
        if shown_elsewhere(game, stype, over) {
            continue;
        }
        let (name, cover) = (game.name(stype), game.name(cover));
        let symbol = game.character(first);
        let text = format!("`{name}` has no symbol of its own: `{symbol}` shows the `{cover}` above it");
        let cell = level.cells().iter().position(|&cell| cell == first);
        let cell = cell.map(|at| (at % level.columns() + 1, at / level.columns() + 1));
        let advice =
            format!("give `{name}` a character of its own in the LevelMapping, and a cell of its own");
        let rule = Line::mapping(game, symbol);
        faults.push(Evidence { text, cell, rule, ..Evidence::default() }.advise(advice));
    }
    faults
}

/// Returns `true` if a character shows the type, even if this level does not use the character. Players can then
/// learn what the type looks like.
fn shown_elsewhere(game: &Game, stype: SpriteType, over: impl Fn(u8) -> Option<SpriteType>) -> bool {
    (b'!'..=b'~').any(|symbol| game.places(symbol).contains(&stype) && over(symbol).is_none())
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::Seed;

    const GAME: &str = "BasicGame\n  SpriteSet\n    floor > Immovable hidden=True\n    nest > SpawnPoint stype=bug hidden=True\n    bug > RandomNPC\n    gem > Immovable\n    rock > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    . > floor\n    n > nest\n    g > floor gem\n    r > floor rock\n    x > gem rock\n    A > floor avatar\n  InteractionSet\n    gem avatar > killSprite\n    rock avatar > killSprite\n  TerminationSet\n    SpriteCounter stype=gem win=True\n";

    #[track_caller]
    fn check(source: &str, level: &str, fault: Option<&str>, told: usize) {
        let game = Game::from_source(source).unwrap();
        let level = game.level(level).unwrap();
        let (analysis, seed) = (Analysis::of(&game), Seed::from_text("readable").into());
        let case = Case { game: &game, level: &level, seed: &seed, analysis: &analysis, witness: None };
        let finding = Readable.validate(case);
        match (&finding.verdict, fault) {
            (Verdict::Pass { .. }, None) => {}
            (Verdict::Fail { reason, .. }, Some(fault)) => assert_eq!(reason.0, fault),
            other => panic!("{other:?}"),
        }
        assert_eq!(finding.evidence.len(), told, "{:?}", finding.evidence);
    }

    #[test]
    fn decisive_types_must_be_visible() {
        check(GAME, "A.gr", None, 0);
        // The type is hidden, but only creates other sprites.
        check(GAME, "Ang.", None, 1);
        // Some character shows gems, so players can recognize them.
        check(GAME, "A.xg", None, 0);
        let hidden = GAME.replace("gem > Immovable", "gem > Immovable hidden=True");
        check(&hidden, "A.gr", Some("`gem` affects the outcome, but is hidden"), 1);
        let covered = GAME.replace("    g > floor gem\n", "");
        let fault = "`gem` has no symbol of its own: `x` shows the `rock` above it";
        check(&covered, "A.xr", Some(fault), 1);
    }
}
