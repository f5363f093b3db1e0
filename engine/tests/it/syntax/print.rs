//! Tests printed game descriptions.

use engine::syntax::{parse, print, print_bare};

#[test]
fn printing_is_stable_and_keeps_comments() {
    let source = "BasicGame\n SpriteSet # what exists\n\t\ta >   Missile # fast\n\t # fruit\n\t\t\tb > color=RED\n  LevelMapping\n    x >  a\n  InteractionSet\n  TerminationSet\n    Timeout   limit=5\n# end\n";
    let once = print(&parse(source).0);
    assert_eq!(print(&parse(&once).0), once);
    assert!(once.contains("            # fruit\n            b > color=RED\n"), "{once}");
    assert!(once.contains("        a > Missile  # fast\n"), "{once}");
    assert!(once.contains("    SpriteSet  # what exists\n"), "{once}");
    assert!(once.ends_with("# end\n"), "{once}");
    assert!(!print_bare(&parse(source).0).contains('#'));
}

#[test]
fn an_empty_comment_does_not_stand_in_the_first_column() {
    let source = "##\nBasicGame\n  SpriteSet\n#\n";
    let once = print(&parse(source).0);
    assert!(once.starts_with(" # #\nBasicGame\n") && once.ends_with("\n #\n"), "{once}");
    assert_eq!(print(&parse(&once).0), once);
}
