//! Tests problems of game descriptions.

use engine::MAX_SOURCE;
use engine::syntax::parse;

fn codes(source: &str) -> Vec<&'static str> {
    parse(source).1.into_iter().map(|problem| problem.code).collect()
}

const NONE: [&str; 0] = [];
const SMALL: &str = "BasicGame square_size=10\n  SpriteSet\n    a > Missile speed=1.5\n      b > color=RED\n  LevelMapping\n    x > a b\n  InteractionSet\n    a b EOS > killSprite scoreChange=-1\n  TerminationSet\n    Timeout limit=5 win=True\n";

#[test]
fn a_small_game_parses_without_problems() {
    let (game, problems) = parse(SMALL);
    assert_eq!(problems, []);
    assert_eq!(game.sprites[0].children[0].name.text, "b");
    assert_eq!(game.mapping[0].names.len(), 2);
    assert_eq!(game.interactions[0].second[1].text, "EOS");
    assert_eq!(game.terminations[0].params[1].value.text, "True");
    let speed = &game.sprites[0].params[0];
    assert_eq!(&SMALL[speed.span().start..speed.span().end], "speed=1.5");
}

#[test]
fn a_bad_line_costs_one_problem() {
    assert_eq!(codes(&SMALL.replace("a b EOS > killSprite", "a b EOS killSprite")), ["missing-arrow"]);
    assert_eq!(codes(&SMALL.replace("a > Missile", "a Missile")), ["missing-arrow"]);
    assert_eq!(codes(&SMALL.replace("limit=5", "limit=")), ["bad-parameter"]);
    assert_eq!(codes(&SMALL.replace("  LevelMapping", "  LevelMaping")), ["unknown-section"]);
    assert_eq!(codes(&SMALL.replace("  LevelMapping\n", "")), ["missing-section"]);
    assert_eq!(codes(&SMALL.replace("    a b EOS", "   a b EOS")), NONE);
    assert_eq!(codes(&SMALL.replace("speed=1.5", "speed = 1.5")), ["bad-parameter"]);
    assert_eq!(codes(&SMALL.replace("speed=1.5", "speed1.5")), ["stray-word"]);
    assert_eq!(
        codes(&SMALL.replace("    x > a b\n", "    x > a b\n    Timeout limit=1\n")),
        ["wrong-section"]
    );
    assert_eq!(codes(&SMALL.replace("x > a b", "xy > a b")), ["bad-mapping"]);
    assert_eq!(codes(&SMALL.replace("BasicGame", "Basicgame")), ["unknown-game-class"]);
    assert_eq!(codes(""), ["empty-game"]);
    assert_eq!(codes("\u{0}"), ["not-text"]);
    assert_eq!(codes(&"x".repeat(MAX_SOURCE + 1)), ["too-large"]);
}

/// The suggested repair of a line of the LevelMapping works, even for several lines at once.
#[test]
fn mappings_are_repaired_as_told() {
    for (line, code, help) in [
        ("xy > a b", "bad-mapping", "write `x > a b`, and `x` in the levels"),
        ("x y > a b", "bad-mapping", "write `x > a b`, and `x` in the levels"),
        ("é > a b", "bad-mapping", "write `a > a b`, and `a` in the levels"),
        ("> a b", "bad-mapping", "write `a > a b`, and `a` in the levels"),
        ("x a b", "missing-arrow", "write `x > a b`"),
        ("x: a b", "missing-arrow", "write `x > a b`"),
        ("x=a b", "missing-arrow", "write `x > a b`"),
        ("xy a b", "missing-arrow", "write `x > a b`"),
    ] {
        let source = SMALL.replace("x > a b", line);
        let (_, problems) = parse(&source);
        let [problem] = &problems[..] else { panic!("{line}: {problems:?}") };
        assert_eq!((problem.code, problem.help.as_deref()), (code, Some(help)), "{line}");
        assert!(problem.message.ends_with("a mapping is `c > sprite sprite …`"), "{}", problem.message);
        let [edit] = &problem.fix.as_ref().expect("a repair").edits[..] else { panic!("{line}") };
        let mut repaired = source.clone();
        repaired.replace_range(edit.span.start..edit.span.end, &edit.text);
        assert_eq!(codes(&repaired), NONE, "{line}: {repaired}");
    }
    let (_, problems) = parse(&SMALL.replace("x > a b", "xy > a\n    xz > b\n    x > a"));
    let helps: Vec<_> = problems.iter().filter_map(|problem| problem.help.as_deref()).collect();
    assert_eq!(helps, ["write `y > a`, and `y` in the levels", "write `z > b`, and `z` in the levels"]);
    let (_, problems) = parse(&SMALL.replace("x > a b", "x > a b\n    b"));
    assert_eq!(
        problems[0].help.as_deref(),
        Some("write the names of sprites after it, `b > sprite`, or remove the line")
    );
    let (_, problems) = parse(&SMALL.replace("x > a b", "x > a b\n    bb"));
    assert_eq!(
        problems[0].help.as_deref(),
        Some("write a character before it, `b > bb`, or remove the line")
    );
}
