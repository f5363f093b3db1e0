//! Tests levels with a reachable goal, and similar levels with an unreachable goal.

use super::*;

/// Checks a game that is won when no gem is left. The level `open` may be won, and `closed` is proved
/// unwinnable.
#[track_caller]
fn check(sprites: &str, rules: &str, open: &str, closed: &str) {
    let sprites = format!("wall > Immovable solid=True\ngem > Immovable\n{sprites}");
    let rules = format!("hero wall > stepBack\nhero EOS > stepBack\n{rules}");
    let names = sprites.lines().filter_map(|line| line.split_once(" > ")).map(|(name, _)| name);
    let mapping: Vec<String> = names.map(|name| format!("{} > {name}", &name[..1])).collect();
    let ends = "SpriteCounter stype=gem win=True\nSpriteCounter stype=hero win=False";
    let analysis = Analysis::of(&game(&sprites, &mapping.join("\n"), &rules, ends));
    assert!(reach(&analysis, open).can_win(), "{open}");
    let closed = reach(&analysis, closed);
    assert!(!closed.can_win(), "{}", picture(&analysis, &closed, "hero"));
    let gem = named(&analysis, "gem");
    let [ImpossibleGoal { goal: 0, cause: Cause::Permanent(gems) }] = &closed.impossible_goals()[..1] else {
        panic!("{:?}", closed.impossible_goals());
    };
    assert!(gems.iter().all(|(stype, cell)| *stype == gem && closed.can_be(gem, *cell)), "{gems:?}");
}

const TAKE: &str = "gem hero > killSprite";

#[test]
fn on_foot() {
    check("hero > MovingAvatar", TAKE, "h w \n  wg\n    ", "h w \n  wg\n  w ");
    check("hero > OrientedAvatar", TAKE, "hg", "hwg");
    check("hero > HorizontalAvatar", TAKE, "    \nh  g", "   g\nh   ");
    check("hero > VerticalAvatar", TAKE, "h \ng ", "hg\n  ");
    check("hero > OngoingAvatar", TAKE, "h w \n   g", "h w \n  wg");
    check("hero > MissileAvatar orientation=RIGHT", TAKE, "h  g\n    ", "h   \n   g");
}

#[test]
fn by_shots() {
    let shot = "shot > Missile orientation=UP";
    let rules = "shot wall > killSprite\nshot EOS > killSprite\ngem shot > killSprite";
    let flak = format!("hero > FlakAvatar stype=shot\n{shot}");
    check(&flak, rules, "  g \n    \nwh w", "   g\n  w \nwh w");
    let shooter = "hero > ShootAvatar stype=shot\nshot > Missile";
    // A shot does not turn.
    let pond = "pond > Immovable";
    let rules = format!("{rules}\nhero pond > stepBack");
    check(&format!("{shooter}\n{pond}"), &rules, "hppg\npppp", "hppp\npppg");
    let loaded = "hero > ShootAvatar stype=shot ammo=quiver\nshot > Missile\nquiver > Resource limit=3\n"
        .to_owned()
        + pond;
    let rules = format!("{rules}\nquiver hero > collectResource");
    check(&loaded, &rules, "hqppg", "h ppg\nppppq");
}

#[test]
fn by_jumps() {
    // A cell is 80 pixels, and a jump lifts the avatar by 46 pixels. Walls can be climbed, because an avatar
    // that falls against a wall stands on it.
    let hero = "hero > PlatformerAvatar physicstype=CONT gravity=1 max_speed=15 jump_strength=8";
    let stairs = "          \n          \n         g\n        ww\n  h    www\nwwwwwwwwww";
    let cloud = "          \n         g\n          \n          \n  h       \nwwwwwwwwww";
    check(hero, TAKE, stairs, cloud);
}

#[test]
fn behind_doors() {
    let sprites = "hero > MovingAvatar\nkey > Resource limit=1\ndoor > Door";
    let rules = format!(
        "{TAKE}\nkey hero > collectResource\ndoor hero > killIfOtherHasMore resource=key limit=1\n\
         hero door > stepBack"
    );
    check(sprites, &rules, "hkdg", "h dg\nwwwk");
    // The key is behind its own door, and each of two doors hides the other's key.
    check(sprites, &rules, "kh dg", "h dkg");
    let two = format!("{sprites}\nring > Resource limit=1\nlock > Door");
    let both = format!(
        "{rules}\nring hero > collectResource\nlock hero > killIfOtherHasMore resource=ring limit=1\n\
         hero lock > stepBack"
    );
    check(&two, &both, "hrlkdg", "hlkwg\n drww");
}

#[test]
fn with_boxes() {
    let sprites = "hero > MovingAvatar\nbox > Passive";
    let rules = "box hero > bounceForward\nbox wall > undoAll\nbox EOS > undoAll\ngem box > killSprite\nhero gem > stepBack";
    // A box stays in a corner, and never leaves a wall.
    check(sprites, rules, "     \nh b g\n     ", "b    \nh   g\n     ");
    check(sprites, rules, "h b g\n     ", "h b  \n    g");
}

#[test]
fn through_portals() {
    let sprites = "hero > MovingAvatar\nportal > Portal stype=xit\nxit > Immovable";
    let rules = format!("{TAKE}\nhero portal > teleportToExit");
    check(sprites, &rules, "hpwxg", "hxwpg");
    check(sprites, &rules, "hpwxg", "hpw g");
}

#[test]
fn goals_reached_by_made_sprites() {
    let sprites = "hero > NullAvatar\nnest > SpawnPoint stype=drop\ndrop > Missile orientation=DOWN";
    let rules = "drop wall > killSprite\ndrop EOS > killSprite\ngem drop > killSprite";
    check(sprites, rules, "hn \n   \n g ", "hn \n   \n  g");
    check(sprites, rules, "hn \n   \n g ", "hn \n w \n g ");
    // The way takes two steps: the drop turns into a splash, and the splash runs.
    let sprites = format!("{sprites}\nsplash > Missile orientation=RIGHT");
    let rules = "drop wall > transformTo stype=splash\ndrop EOS > killSprite\nsplash EOS > killSprite\ngem splash > killSprite";
    check(&sprites, rules, "hn  \n    \n w g", "hn  \n    \n   g");
}

#[test]
fn in_disguise() {
    let sprites = "hero > MovingAvatar\nuniform > Immovable\nadmiral > MovingAvatar\nriver > Immovable";
    let rules = "hero river > stepBack\nhero uniform > transformTo stype=admiral\nadmiral wall > stepBack\n\
                 admiral EOS > stepBack\ngem admiral > killSprite";
    check(sprites, rules, "hurg", "hrug");
    check(sprites, rules, "hurg", "hurw\nwwwg");
}

/// Returns the unaffordable removals, if it is proved that they make a win by removing all houses impossible.
fn unpaid(rules: &str, level: &str) -> Option<(i64, i64, i64)> {
    let sprites = "wall > Immovable\nhouse > Immovable\nparcel > Resource limit=9\nhero > MovingAvatar";
    let mapping = "w > wall\nh > house\np > parcel\nA > hero";
    let rules = format!("hero wall > stepBack\nparcel hero > collectResource\n{rules}");
    let analysis = Analysis::of(&game(sprites, mapping, &rules, "SpriteCounter stype=house win=True"));
    match &reach(&analysis, level).impossible_goals() {
        [] => None,
        [ImpossibleGoal { cause: Cause::Unpaid(unpaid), .. }] => {
            Some((unpaid.removals, unpaid.each, unpaid.most))
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn removals_that_cost_more_than_there_is_are_counted() {
    let at_once = "house hero > killIfOtherHasMore resource=parcel limit=1 subtract=True";
    let kill = "house hero > killIfOtherHasMore resource=parcel limit=1";
    let take = "hero house > changeResource resource=parcel value=-1";
    let (short, enough, near) = ("A p h  h", "App h  h", "A p hh  ");
    assert_eq!(unpaid(at_once, short), Some((2, 1, 1)));
    assert_eq!(unpaid(at_once, enough), None);
    assert_eq!(unpaid(at_once, near), Some((2, 1, 1)));
    let later = format!("{kill}\n{take}");
    assert_eq!(unpaid(&later, short), Some((2, 1, 1)));
    assert_eq!(unpaid(&later, enough), None);
    // If two houses are side by side, one payment might serve both.
    assert_eq!(unpaid(&later, near), None);
    // In the first game, an avatar that is moved back in between does not pay. In the second game, nothing is
    // taken without the payment. In the third game, another rule opens for free.
    assert_eq!(unpaid(&format!("{kill}\nhero house > stepBack\n{take}"), short), None);
    assert_eq!(unpaid(kill, short), None);
    assert_eq!(
        unpaid(&format!("{at_once}\nhouse hero > killIfOtherHasMore resource=parcel limit=0"), short),
        None
    );
    // Nothing is proved if parcels or houses reappear.
    assert_eq!(unpaid(&format!("{at_once}\nhero house > spawn stype=parcel"), short), None);
    assert_eq!(
        unpaid(&format!("hero house > transformToAll stype=wall stypeTo=house\n{at_once}"), "A p h  hw"),
        None
    );
}
