//! Tests chains of causes: the missing requirements of rules, and their positions.

use super::*;
use engine::analysis::{Missing, Shortage, Unreachable};

const SPRITES: &str =
    "wall > Immovable\nlamp > Resource limit=5\ndoor > Immovable\ngem > Door\nhero > MovingAvatar";
const MAPPING: &str = "w > wall\nl > lamp\nd > door\ng > gem\nh > hero";
const ENDS: &str = "SpriteCounter stype=gem win=True\nSpriteCounter stype=hero win=False";

/// Checks the chain of the only winning termination, in short form.
#[track_caller]
fn check(rules: &str, level: &str, expect: &str) {
    let analysis = Analysis::of(&game(SPRITES, MAPPING, &format!("hero wall > stepBack\n{rules}"), ENDS));
    let level = analysis.game().level(level).unwrap();
    assert!(!analysis.reach(&level).can_win());
    let chains = analysis.causes(&level);
    assert_eq!(chains.len(), 1, "{chains:?}");
    let found: Vec<String> = chains[0].obstacles.iter().map(|found| obstacle(&analysis, found)).collect();
    assert_eq!(found.join("; "), expect);
}

fn obstacle(analysis: &Analysis, Obstacle { target, line, missing }: &Obstacle) -> String {
    let name = |stype: SpriteType| analysis.game().name(stype).to_owned();
    let missing = match missing {
        Missing::Absent(stype) => format!("no {}", name(*stype)),
        Missing::Unmade(stype, why) => {
            let why: Vec<String> = why.iter().map(|found| obstacle(analysis, found)).collect();
            format!("no {} yet ({})", name(*stype), why.join("; "))
        }
        Missing::Resource(Shortage { resource, needed, capacity, most, rules, sources }) => {
            let sources: Vec<String> = sources
                .iter()
                .map(|source| {
                    let got =
                        source.unreachable.as_ref().map_or("got".to_owned(), |found| apart(analysis, found));
                    format!("{} at {} {got}", name(source.stype), source.cell)
                })
                .collect();
            let capacity = capacity.map_or(String::new(), |capacity| format!(", holds {capacity}"));
            let of = format!("{needed} {} of {most}{capacity}", name(*resource));
            format!("{of} by {rules:?} from {sources:?}")
        }
        Missing::Unreachable(found) => apart(analysis, found),
        Missing::Blocked(stype, by) => format!("{} blocked by {by}", name(*stype)),
        Missing::Nowhere(..) => "nowhere together".to_owned(),
        Missing::Inside => "never at the edge".to_owned(),
    };
    format!("{} by {line:?}: {missing}", name(*target))
}

fn apart(analysis: &Analysis, Unreachable { stype, cell, blockers }: &Unreachable) -> String {
    let name = |stype: SpriteType| analysis.game().name(stype).to_owned();
    let blockers: Vec<String> = blockers
        .iter()
        .map(|blocker| {
            let why: Vec<String> = blocker.obstacles.iter().map(|found| obstacle(analysis, found)).collect();
            format!("{} at {} ({})", name(blocker.stype), blocker.cell, why.join("; "))
        })
        .collect();
    format!("{} not at {cell}, behind {blockers:?}", name(*stype))
}

const TOLL: &str = "lamp hero > collectResource\ngem hero > killIfOtherHasMore resource=lamp limit=2";

#[test]
fn a_resource_that_is_short() {
    check(TOLL, "wwwwww\nwh lgw\nwwwwww", r#"gem by Some(2): 2 lamp of 1 by [1] from ["lamp at 9 got"]"#);
    let few = TOLL.replace("limit=2", "limit=9");
    let level = "wwwwww\nwhllgw\nwwwwww";
    let sources = r#"["lamp at 8 got", "lamp at 9 got"]"#;
    check(&few, level, &format!("gem by Some(2): 9 lamp of 2, holds 5 by [1] from {sources}"));
    // No rule gives the resource.
    let swapped = TOLL.replace("lamp hero", "hero lamp");
    check(&swapped, "wwwwww\nwh lgw\nwwwwww", "gem by Some(2): 2 lamp of 0 by [] from []");
    // One of two lamps is behind a wall that cannot be opened.
    let level = "wwwwwww\nwh lgww\nwwwwwww\nwlw   w\nwwwwwww";
    let sources = r#"["lamp at 10 got", "lamp at 22 hero not at 22, behind []"]"#;
    check(TOLL, level, &format!("gem by Some(2): 2 lamp of 1 by [1] from {sources}"));
}

#[test]
fn a_door_in_the_way() {
    let rules = "hero door > stepBack\nlamp hero > collectResource\ndoor hero > killIfOtherHasMore resource=lamp limit=1\ngem hero > killSprite";
    // The key is behind its own door.
    let toll = "1 lamp of 0 by [2] from [\"lamp at 11 hero not at 11, behind [\\\"door at 9 ()\\\"]\"]";
    let door = format!("door at 9 (door by Some(3): {toll})");
    let expect = format!("gem by Some(4): hero not at 12, behind {:?}", [door]);
    check(rules, "wwwwwww\nwhd lgw\nwwwwwww", &expect);
    // A wall cannot be opened.
    check(rules, "wwwwww\nwhwlgw\nwwwwww", "gem by Some(4): hero not at 10, behind []");
}

#[test]
fn rules_that_come_too_late_or_lack_a_requirement() {
    check("hero gem > stepBack\ngem hero > killSprite", "hg", "gem by Some(2): hero blocked by 1");
    check("gem door > killSprite", "hg", "gem by Some(1): no door");
    // The hero turns doors into lamps, but cannot get to a door.
    let unmade = "gem by Some(1): no lamp yet (lamp by Some(2): hero not at 10, behind [])";
    check("gem lamp > killSprite\ndoor hero > transformTo stype=lamp", "wwwwww\nwhgwdw\nwwwwww", unmade);
    check("hero gem > stepBack", "hg", "");
    check("gem door > killSprite", "hgd", "gem by Some(1): door not at 1, behind []");
}
