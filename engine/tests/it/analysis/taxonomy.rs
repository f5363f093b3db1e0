//! Tests of the taxonomy of games.

use super::*;

/// Returns the taxonomy as `time, spatiality: genres`.
fn kind(analysis: &Analysis) -> String {
    let Taxonomy { time, spatiality, genres, .. } = analysis.taxonomy();
    let genres: Vec<&str> = genres.iter().map(|genre| genre.name()).collect();
    format!("{}, {}: {}", time.name(), spatiality.name(), genres.join(" "))
}

#[track_caller]
fn check(sprites: &str, rules: &str, terminations: &str, expect: &str) {
    let symbols = ('a'..='z').zip(sprites.lines().filter(|line| !line.starts_with("made")));
    let name = |line: &str| line.split(' ').next().unwrap_or_default().to_owned();
    let mapping: Vec<String> = symbols.map(|(symbol, line)| format!("{symbol} > {}", name(line))).collect();
    let sprites = sprites.lines().map(|line| line.trim_start_matches("made ")).collect::<Vec<_>>().join("\n");
    let analysis = Analysis::of(&game(&sprites, &mapping.join("\n"), rules, terminations));
    assert_eq!(kind(&analysis), expect, "{sprites}");
}

#[test]
fn genres() {
    let dies = "SpriteCounter stype=hero win=False\n";
    check(
        "pit > Immovable\nrock > Passive\nhero > MovingAvatar",
        "rock hero > bounceForward\nrock pit > killSprite",
        "SpriteCounter stype=rock win=True",
        "turn-based, grid: puzzle",
    );
    check(
        "exit > Door\nhero > MovingAvatar\ncar > Missile orientation=LEFT",
        "hero car > killSprite\ncar EOS > wrapAround\nexit hero > killSprite",
        &format!("{dies}SpriteCounter stype=exit win=True"),
        "real-time, grid: crossing escape",
    );
    check(
        "exit > Door\nhero > MovingAvatar\ncar > Missile orientation=LEFT",
        "hero car > killSprite\ncar EOS > killSprite\nexit hero > killSprite",
        &format!("{dies}SpriteCounter stype=exit win=True"),
        "real-time, grid: escape",
    );
    check(
        "fly > RandomNPC\nmade web > Missile orientation=UP\nhero > FlakAvatar stype=web",
        "fly web > killBoth",
        "SpriteCounter stype=fly win=True",
        "real-time, line: shooter",
    );
    check(
        "fly > RandomNPC\nhero > MovingAvatar",
        "fly hero > killSprite",
        "SpriteCounter stype=fly win=True",
        "real-time, grid: hunt",
    );
    check(
        "fly > RandomNPC\npot > Immovable\nhero > MovingAvatar",
        "pot fly > killSprite",
        "SpriteCounter stype=pot win=False\nTimeout limit=99 win=True",
        "real-time, grid: defence survive",
    );
    check(
        "goat > Chaser stype=hero\npen > Immovable\nhero > MovingAvatar",
        "goat pen > killSprite",
        "SpriteCounter stype=goat win=True",
        "real-time, grid: guide",
    );
    check(
        "rival > Missile orientation=UP\nline > Door\nmade wins > Immovable\nmade loses > Immovable\nhero > MovingAvatar",
        "line hero > transformTo stype=wins\nrival line > transformTo stype=loses",
        "SpriteCounterMore stype=wins limit=1 win=True\nSpriteCounterMore stype=loses limit=1 win=False",
        "real-time, grid: race escape",
    );
    check(
        "gate > Door\nrust > RandomNPC\nkey > Resource limit=9\nhero > MovingAvatar",
        "key hero > collectResource\ngate hero > killIfOtherHasMore resource=key limit=1\nhero gate > stepBack",
        "SpriteCounter stype=gate win=True",
        "real-time, grid: adventure escape",
    );
    check(
        "gate > Door\nrust > RandomNPC\nkey > Resource limit=9\nhero > MovingAvatar",
        "key hero > collectResource\ngate hero > killIfOtherHasMore resource=key limit=8\nhero gate > stepBack",
        "SpriteCounter stype=gate win=True",
        "real-time, grid: collect escape",
    );
    check(
        "flag > Immovable\ncoin > Immovable\nhero > PlatformerAvatar physicstype=CONT gravity=1",
        "flag hero > killSprite\ncoin hero > killSprite scoreChange=1",
        "SpriteCounter stype=flag win=True",
        "real-time, gravity: platformer escape",
    );
    check("hero > AimedAvatar stype=wall", "hero wall > stepBack", dies, "turn-based, fixed: ");
}

#[test]
fn time_is_real_if_anything_happens_by_itself() {
    let (rules, ends) =
        ("gem hero > killSprite", "SpriteCounter stype=gem win=True\nTimeout limit=99 win=False");
    let with = |sprite: &str, rule: &str, expect: &str| {
        let sprites = format!("gem > Immovable\nhero > MovingAvatar\n{sprite}");
        check(&sprites, &format!("{rules}\n{rule}"), ends, expect);
    };
    let (waits, runs) = ("turn-based, grid: puzzle collect", "real-time, grid: puzzle collect");
    with("rock > Passive", "rock hero > bounceForward", waits);
    with("made puff > Flicker limit=3", "hero gem > spawn stype=puff", waits);
    with("rain > Missile orientation=DOWN", "rain EOS > wrapAround", runs);
    // A candle burns down, but a candle that no rule mentions is decoration.
    with("candle > Flicker limit=30", "gem candle > killSprite", runs);
    with("candle > Flicker limit=30", "", waits);
    // A ball stands still until the hero kicks it.
    with("ball > Missile orientation=UP speed=0", "ball hero > setSpeedForAll stype=ball value=1", runs);
    with("seed > Immovable", "seed TIME > transformTo stype=gem timer=9", runs);
}

#[test]
fn names_do_not_count() {
    let analysis = vault();
    let mut text = engine::syntax::print(analysis.game().description());
    for (number, name) in
        ["thief", "plain", "ghost", "coin", "cloak", "gate", "crown", "spike", "guard", "post", "fence"]
            .iter()
            .enumerate()
    {
        text = text.replace(name, &format!("x{number}"));
    }
    let renamed =
        Analysis::of(&Game::from_source(&text).unwrap_or_else(|problems| panic!("{problems}\n{text}")));
    assert_eq!(analysis.taxonomy(), renamed.taxonomy());
    assert_eq!(kind(&renamed), "real-time, grid: collect adventure escape");
}

/// The labels were judged by hand, and fit.
#[test]
fn games_that_many_know() {
    let expected = [
        ("aliens", "real-time, line: shooter"),
        ("boulderdash", "real-time, grid: collect escape"),
        ("camelRace", "real-time, grid: race escape"),
        ("defender", "real-time, grid: shooter defence survive"),
        ("escape", "turn-based, grid: puzzle escape"),
        ("frogs", "real-time, grid: crossing collect"),
        ("lander", "real-time, gravity: escape"),
        ("mario", "real-time, gravity: platformer escape"),
        ("pacman", "real-time, grid: collect"),
        ("sokoban", "turn-based, grid: puzzle"),
        ("theshepherd", "real-time, grid: guide"),
        ("zelda", "real-time, grid: adventure escape"),
        // Games from our own corpora.
        ("bog-lantern", "real-time, grid: survive"),
        ("foxglove-round", "real-time, grid: collect"),
        ("garden-post", "real-time, grid: crossing escape"),
        ("hailglass", "real-time, line: shooter defence"),
        ("quiet-jars", "turn-based, grid: puzzle"),
        ("tinkers-attic", "real-time, grid: adventure escape"),
    ];
    for folder in folders("corpora").into_iter().chain(folders("../shared/gvgai/games")) {
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if let Some((_, expected)) = expected.iter().find(|(known, _)| *known == name) {
            assert_eq!(kind(&Analysis::of(&game_in(&folder).unwrap())), *expected, "{name}");
        }
    }
}
