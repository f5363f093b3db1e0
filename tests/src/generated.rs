//! Random games that compile, with any classes, effects and parameters.

use base::Sampler;
use engine::SpriteClass;

/// Returns a game and a level, as texts. The game does not necessarily compile.
pub fn game(sampler: &mut Sampler) -> (String, String) {
    let count = sampler.between(3, 7);
    let mut names: Vec<String> = (0..count).map(|number| format!("s{number}")).collect();
    // A wall is solid, and exists in every game.
    names.push("wall".to_owned());
    names.push("hero".to_owned());
    // Some of the games are more plausible ones about jumping.
    let jumps = sampler.ratio(1, 6);
    let mut sprites = String::new();
    let mut depth = 0;
    for name in names.iter().filter(|name| *name != "wall") {
        depth = if *name != "hero" && sampler.ratio(1, 5) { depth ^ 1 } else { 0 };
        let indent = "    ".repeat(2 + depth);
        let text =
            if jumps && name == "hero" { jumper(sampler) } else { sprite(sampler, &names, name == "hero") };
        sprites += &format!("{indent}{name} > {text}\n");
        if depth == 1 {
            continue;
        }
        // Sometimes the next type is a child of this one.
        if sampler.ratio(1, 6) {
            depth = 0;
        }
    }
    let mut rules: String = (0..sampler.between(2, 14)).map(|_| interaction(sampler, &names)).collect();
    if jumps {
        let stop = pick(sampler, &["wallStop", "stepBack", "stepBack pixelPerfect=True"]);
        rules += &format!("        hero wall > {stop}\n        hero EOS > stepBack\n");
    }
    let ends: String = (0..sampler.between(1, 3)).map(|_| termination(sampler, &names)).collect();
    let symbols: Vec<char> = ('a'..='z').take(count + 2).collect();
    let mut mapping = "        A > hero\n        w > wall\n".to_owned();
    for &symbol in &symbols {
        let placed: Vec<&str> = (0..sampler.between(1, 2)).map(|_| some(sampler, &names[..count])).collect();
        mapping += &format!("        {symbol} > {}\n", placed.join(" "));
    }
    let header = match sampler.below(6) {
        0 => " square_size=10",
        1 => " square_size=24",
        2 => " square_size=7 obs=wall",
        3 => " obs=wall,s0",
        _ => "",
    };
    let source = format!(
        "BasicGame{header}\n    SpriteSet\n{sprites}    LevelMapping\n{mapping}    InteractionSet\n{rules}    TerminationSet\n{ends}"
    );
    (source, level(sampler, &symbols, jumps))
}

/// Returns an avatar that falls, walks and jumps.
fn jumper(sampler: &mut Sampler) -> String {
    let class = pick(sampler, &["PlatformerAvatar", "PlatformerAvatar", "WizardAvatar stype=wall"]);
    let (strength, gravity) =
        (pick(sampler, &["3", "6", "10", "16"]), pick(sampler, &["0.3", "1", "1", "2", "3"]));
    let (mass, most) = (pick(sampler, &["0.5", "1", "1", "2"]), pick(sampler, &["5", "8", "15", "30", "-1"]));
    let friction = pick(sampler, &["0", "0.1", "0.3"]);
    format!(
        "{class} physicstype=CONT jump_strength={strength} gravity={gravity} mass={mass} max_speed={most} friction={friction}"
    )
}

fn some<'a>(sampler: &mut Sampler, names: &'a [String]) -> &'a str {
    &names[sampler.below(names.len())]
}

pub(crate) fn pick<'a>(sampler: &mut Sampler, options: &[&'a str]) -> &'a str {
    options[sampler.below(options.len())]
}

/// Returns a class with parameters.
pub(crate) fn sprite(sampler: &mut Sampler, names: &[String], hero: bool) -> String {
    let classes: Vec<SpriteClass> =
        SpriteClass::ALL.iter().copied().filter(|class| class.is_avatar() == hero).collect();
    // Walls, things and walkers matter more than other classes.
    let plain = [SpriteClass::Immovable, SpriteClass::Passive, SpriteClass::Missile, SpriteClass::Resource];
    let class = match (hero, sampler.ratio(1, 2)) {
        (false, true) => *sampler.choose(&plain),
        (true, true) => SpriteClass::MovingAvatar,
        _ => *sampler.choose(&classes),
    };
    let mut text = class.name().to_owned();
    let takes = class.parameters();
    for (key, many) in [
        ("stype", false),
        ("stype1", false),
        ("stypes", true),
        ("stypeMissile", true),
        ("spawnBehind", false),
    ] {
        if takes.contains(&key) {
            let first = some(sampler, names);
            let more = if many { format!(",{}", some(sampler, names)) } else { String::new() };
            text += &format!(" {key}={first}{more}");
        }
    }
    if takes.contains(&"ammo") && sampler.ratio(1, 4) {
        text += &format!(" ammo={}", some(sampler, names));
    }
    let wild = sampler.ratio(1, 3);
    for (key, values, odds) in [
        ("orientation", &["UP", "LEFT", "DOWN", "RIGHT", "NONE"][..], 3),
        ("speed", &["0", "0.3", "0.5", "1", "1", "2", "3", "-1", "5", "0.25"], 3),
        ("cooldown", &["1", "2", "3", "5"], 4),
        ("singleton", &["True"], 12),
        ("is_static", &["True", "False"], 10),
        ("only_active", &["True"], 14),
        ("stationary", &["True"], 14),
        ("rotateInPlace", &["True", "False"], 8),
        ("timeToLive", &["4", "20"], 14),
        ("hidden", &["True"], 10),
        ("healthPoints", &["0", "2", "5"], 8),
        ("solid", &["True"], 6),
        ("limit", &["0", "1", "3"], 3),
        ("value", &["1", "2", "-1"], 4),
        ("total", &["1", "4"], 4),
        ("prob", &["0", "0.3", "1"], 3),
        ("spawnorientation", &["UP", "RIGHT", "NONE"], 4),
        ("cons", &["0", "3"], 4),
        ("spreadprob", &["0.4", "1"], 3),
    ] {
        if (takes.contains(&key) || !OWN.contains(&key)) && sampler.ratio(1, odds) {
            text += &format!(" {key}={}", pick(sampler, values));
        }
    }
    for (key, values, odds) in [
        ("physicstype", &["CONT"][..], 3),
        ("gravity", &["0.5", "1", "2"], 3),
        ("mass", &["1", "2", "0.5"], 5),
        ("friction", &["0.1", "0.5"], 5),
        ("max_speed", &["3", "8", "30", "-1"], 2),
        ("jump_strength", &["5", "10", "20"], 4),
        ("wMult", &["0.5", "1", "2", "0.7"], 5),
        ("hMult", &["0.5", "1", "3"], 6),
    ] {
        if wild && sampler.ratio(1, odds) {
            text += &format!(" {key}={}", pick(sampler, values));
        }
    }
    text
}

/// The parameters specific to certain classes.
const OWN: [&str; 8] = ["limit", "value", "total", "prob", "spawnorientation", "cons", "spreadprob", "stype"];

/// Every effect with its parameters. N stands for a sprite, I for a small integer, S for a speed, P for a
/// probability, B for a Boolean, and E for an effect.
const EFFECTS: [&str; 72] = [
    "killSprite",
    "killSprite",
    "killSprite",
    "killBoth",
    "killAll stype=N",
    "killIfAlive",
    "killIfFromAbove",
    "killIfHasLess resource=N limit=I",
    "killIfHasMore resource=N limit=I",
    "killIfOtherHasMore resource=N limit=I subtract=B",
    "killIfFrontal",
    "killIfNotFrontal",
    "killIfFast limspeed=S",
    "killIfSlow limspeed=S",
    "killIfNotUpright",
    "addHealthPoints value=I killSecond=B",
    "addHealthPointsToMax value=I killSecond=B",
    "subtractHealthPoints value=I",
    "subtractHealthPoints value=I stype=N",
    "stepBack",
    "stepBack",
    "stepBack",
    "stepBack pixelPerfect=True",
    "undoAll",
    "undoAll notStype=N",
    "turnAround",
    "reverseDirection",
    "flipDirection",
    "halfSpeed",
    "wrapAround",
    "wrapAround offset=S",
    "align orient=B",
    "attractGaze align=B prob=P",
    "bounceForward",
    "bounceForward",
    "pullWithIt pixelPerfect=B",
    "teleportToExit",
    "increaseSpeedToAll stype=N value=S",
    "decreaseSpeedToAll stype=N value=S",
    "setSpeedForAll stype=N value=S",
    "spawn stype=N prob=P",
    "spawnIfHasMore resource=N limit=I stype=N spend=I",
    "spawnIfHasLess resource=N limit=I stype=N",
    "spawnAbove stype=N stepBack=B",
    "spawnBelow stype=N prob=P",
    "spawnLeft stype=N stepBack=B",
    "spawnRight stype=N",
    "spawnBehind stype=N",
    "cloneSprite",
    "transformTo stype=N killSecond=B",
    "transformTo stype=N forceOrientation=B",
    "transformTo stype=N",
    "transformToAll stype=N stypeTo=N",
    "transformToRandomChild stype=N",
    "transformIfCount stype=N stypeCount=N geq=I leq=I",
    "transformIfCount stype=N stypeCount=N geq=I estype=N",
    "transformToSingleton stype=N stype_other=N takeOrientation=B",
    "collectResource killResource=B",
    "collectResource",
    "collectResourceIfHeld heldResource=N value=I",
    "changeResource resource=N value=I killResource=B",
    "shieldFrom stype=N ftype=E",
    "removeScore killSecond=B",
    "updateSpawnType stype=N spawnPoint=N",
    "spawnIfCounterSubTypes stype=N estype=N stypeCount=N limit=I subTypesNum=I",
    "waterPhysics",
    "bounceDirection",
    "wallStop",
    "wallBounce",
    "wallReverse",
    "addTimer timer=9 ftype=killAll stype=N",
    "addTimer timer=5 ftype=transformToAll stype=N stypeTo=N",
];

fn effect(sampler: &mut Sampler, names: &[String]) -> String {
    let template = *sampler.choose(&EFFECTS);
    let words = template.split(' ').map(|word| match word.split_once('=') {
        Some((key, "N")) => format!("{key}={}", some(sampler, names)),
        Some((key, "I")) => format!("{key}={}", pick(sampler, &["0", "1", "2", "4", "-1"])),
        Some((key, "S")) => format!("{key}={}", pick(sampler, &["0.1", "0.5", "1", "2", "0"])),
        Some((key, "P")) => format!("{key}={}", pick(sampler, &["0.3", "1", "0"])),
        Some((key, "B")) => format!("{key}={}", pick(sampler, &["True", "False"])),
        Some((key, "E")) => format!("{key}={}", pick(sampler, &["stepBack", "killSprite", "undoAll"])),
        _ => word.to_owned(),
    });
    words.collect::<Vec<_>>().join(" ")
}

pub(crate) fn interaction(sampler: &mut Sampler, names: &[String]) -> String {
    let one = some(sampler, names).to_owned();
    let mut two = some(sampler, names).to_owned();
    let mut clock = String::new();
    match sampler.below(12) {
        0..=2 => two = "EOS".to_owned(),
        3 => {
            two = "TIME".to_owned();
            clock = format!(" timer={} repeating=True", pick(sampler, &["3", "7", "30"]));
        }
        4..=6 => two = "wall".to_owned(),
        _ => {}
    }
    let effect = effect(sampler, names);
    if two == "TIME" && effect.starts_with("addTimer") {
        return String::new();
    }
    format!("        {one} {two} > {effect}{clock}\n")
}

pub(crate) fn termination(sampler: &mut Sampler, names: &[String]) -> String {
    let limit = pick(sampler, &["0", "0", "1", "2", "5"]).to_owned();
    let win = pick(sampler, &["True", "False"]).to_owned();
    let (one, two) = (some(sampler, names).to_owned(), some(sampler, names).to_owned());
    let text = match sampler.below(7) {
        0 | 1 => format!("SpriteCounter stype={one}"),
        2 => format!("SpriteCounterMore stype={one}"),
        3 => format!("MultiSpriteCounter stype1={one} stype2={two}"),
        4 => format!("StopCounter stype1={one}"),
        5 => format!("MultiSpriteCounterSubTypes stype1={one} subTypesNum=1"),
        _ => "Timeout".to_owned(),
    };
    let limit = if text == "Timeout" { "150".to_owned() } else { limit };
    format!("        {text} limit={limit} win={win}\n")
}

fn level(sampler: &mut Sampler, symbols: &[char], high: bool) -> String {
    let (columns, rows) = (sampler.between(3, 12), sampler.between(2, if high { 16 } else { 8 }));
    let mut cells = vec![' '; columns * rows];
    for cell in &mut cells {
        *cell = match sampler.below(10) {
            0 | 1 => 'w',
            2 | 3 => *sampler.choose(symbols),
            _ => ' ',
        };
    }
    let start = sampler.below(cells.len());
    cells[start] = 'A';
    cells.chunks(columns).map(|row| row.iter().collect::<String>() + "\n").collect()
}
