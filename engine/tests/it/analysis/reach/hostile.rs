//! Tests games and levels at the limits. Their reach is computed fast, with a coarse result if necessary.

use super::*;
use engine::limits::{MAX_CELLS, MAX_SIDE};
use std::fmt::Write;

/// Returns the largest level, filled with one character except at the start.
fn vast(start: &str, fill: char) -> String {
    let mut level = String::new();
    for row in 0..MAX_CELLS / MAX_SIDE {
        let own = if row == 0 { start } else { "" };
        writeln!(level, "{own}{}", fill.to_string().repeat(MAX_SIDE - own.len())).unwrap();
    }
    level
}

/// Returns `true` if the result is coarse.
fn is_coarse(sprites: &str, mapping: &str, rules: &str, level: &str) -> bool {
    let game = game(sprites, mapping, rules, "SpriteCounter stype=hero win=False");
    let level = game.level(level).unwrap_or_else(|problems| panic!("{problems}"));
    Analysis::of(&game).reach(&level).is_coarse()
}

const WALLS: &str = "hero wall > stepBack\nhero EOS > stepBack";

#[test]
fn a_usual_game_in_the_largest_level() {
    let sprites =
        "wall > Immovable\nhero > ShootAvatar stype=bolt\nbolt > Missile\nbox > Passive\ncow > RandomNPC";
    let mapping = "h > hero\nw > wall\nb > box\nc > cow";
    let rules = format!(
        "{WALLS}\ncow wall > stepBack\ncow EOS > stepBack\nbox hero > bounceForward\nbox wall > undoAll\n\
         box EOS > undoAll\nbolt wall > killSprite\nbolt EOS > killSprite\ncow bolt > killSprite"
    );
    assert!(!is_coarse(sprites, mapping, &rules, &vast("h b c w", ' ')));
}

#[test]
fn jumps_and_long_strides_in_the_largest_level() {
    let jumper =
        "wall > Immovable solid=True\nhero > PlatformerAvatar physicstype=CONT gravity=1 max_speed=2";
    let mapping = "h > hero\nw > wall";
    assert!(!is_coarse(jumper, mapping, "hero wall > wallStop\nhero EOS > stepBack", &vast("h  w", ' ')));
    assert!(is_coarse("wall > Immovable\nhero > MovingAvatar speed=300", mapping, WALLS, &vast("h w", ' ')));
    let pushed = "wall > Immovable\nhero > MovingAvatar speed=300\nbox > Passive";
    let push = format!("{WALLS}\nbox hero > bounceForward");
    assert!(is_coarse(pushed, "h > hero\nw > wall\nb > box", &push, &vast("h w b", ' ')));
}

/// The game has doors in a row, each with its key behind the previous door.
#[test]
fn a_long_row_of_doors() {
    let (mut sprites, mut rules) =
        ("wall > Immovable\nhero > HorizontalAvatar\n".to_owned(), WALLS.to_owned());
    let (mut mapping, mut level) = ("A > hero\nw > wall\n".to_owned(), "A".to_owned());
    let symbols = ('!'..='~').filter(|symbol| !"#Aw".contains(*symbol)).collect::<Vec<_>>();
    for (number, pair) in symbols.chunks_exact(2).enumerate() {
        writeln!(sprites, "key{number} > Resource\ndoor{number} > Immovable").unwrap();
        writeln!(mapping, "{} > key{number}\n{} > door{number}", pair[0], pair[1]).unwrap();
        write!(
            rules,
            "\nkey{number} hero > collectResource\ndoor{number} hero > killIfOtherHasMore resource=key{number} \
             limit=1\nhero door{number} > stepBack"
        )
        .unwrap();
        write!(level, "{}{}", pair[0], pair[1]).unwrap();
    }
    assert!(!is_coarse(&sprites, &mapping, &rules, &vast(&level, ' ')));
}

#[test]
fn everything_does_everything_to_everything() {
    for class in ["RandomNPC", "Passive", "Missile", "RandomInertial"] {
        let (mut sprites, mut mapping) =
            ("hero > MovingAvatar\nroot >\n".to_owned(), "A > hero\n".to_owned());
        (0..480).for_each(|number| writeln!(sprites, "  t{number} > {class}").unwrap());
        let symbols = ('!'..='~').filter(|symbol| !"#A".contains(*symbol));
        for (symbol, names) in symbols.zip((0..480).collect::<Vec<_>>().chunks(8)) {
            let names: Vec<String> = names.iter().map(|number| format!("t{number}")).collect();
            writeln!(mapping, "{symbol} > {}", names.join(" ")).unwrap();
        }
        let effects = [
            "bounceForward",
            "spawn stype=t9",
            "transformTo stype=t7",
            "pullWithIt",
            "stepBack",
            "teleportToExit",
            "turnAround",
            "wrapAround",
            "transformToRandomChild stype=root",
            "undoAll",
            "killSprite",
        ];
        let mut rules = String::new();
        for number in 0..1900 {
            let one = format!("t{}", number * 7 % 480);
            let others: Vec<String> =
                (1..6).map(|other| format!("t{}", (number + other * 31) % 480)).collect();
            writeln!(rules, "{one} {} > {}", others.join(" "), effects[number % effects.len()]).unwrap();
        }
        let row: String = ('!'..='~').filter(|symbol| !"#A".contains(*symbol)).take(60).collect();
        assert!(is_coarse(&sprites, &mapping, &rules, &vast(&format!("A{row}"), ' ')));
        assert!(is_coarse(&sprites, &mapping, &rules, &format!("A{row}")));
        let more = format!("{rules}\nroot root > bounceForward");
        assert!(is_coarse(&sprites, &mapping, &more, &format!("A{row}")));
    }
}

/// Each type turns into the next type when it meets itself.
#[test]
fn a_long_chain() {
    let (mut sprites, mut rules) = ("hero > MovingAvatar\n".to_owned(), String::new());
    for number in 0..480 {
        writeln!(sprites, "t{number} > RandomNPC").unwrap();
        if number > 0 {
            let before = number - 1;
            writeln!(rules, "t{before} t{before} > spawn stype=t{number}").unwrap();
        }
    }
    let reverse: Vec<&str> = rules.lines().rev().collect();
    assert!(!is_coarse(&sprites, "A > hero\n0 > t0", &reverse.join("\n"), "A0 "));
    assert!(is_coarse(&sprites, "A > hero\n0 > t0", &reverse.join("\n"), &vast("A0", ' ')));
    assert!(is_coarse(&sprites, "A > hero\n0 > t0", &rules, &vast("A0", ' ')));
}
