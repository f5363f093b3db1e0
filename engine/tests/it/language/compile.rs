//! Tests warnings of the compiler.

use engine::Game;

const GAME: &str = "BasicGame\n  SpriteSet\n    egg > Immovable\n    chick > RandomNPC\n    coop > SpawnPoint stype=chick\n    purse > Resource\n    avatar > MovingAvatar\n  LevelMapping\n    e > egg\n    c > coop\n  InteractionSet\n    egg avatar > killSprite\n    avatar chick > changeResource resource=purse\n  TerminationSet\n    SpriteCounter stype=egg win=True\n    Timeout limit=99\n";

#[track_caller]
fn warnings(source: &str, expect: &[&str]) {
    let game = Game::from_source(source).unwrap_or_else(|problems| panic!("{problems}"));
    let reported = game.warnings().iter().filter(|warning| warning.code == "never-there");
    assert_eq!(reported.map(|warning| warning.message.as_str()).collect::<Vec<_>>(), expect);
}

#[test]
fn sprites_that_never_exist() {
    warnings(GAME, &[]);
    let egg = "`egg` never exists: no level character places it and nothing makes it";
    warnings(&GAME.replace("    e > egg\n", ""), &[egg]);
    let chick = "`chick` never exists: no level character places it and nothing makes it";
    warnings(&GAME.replace("coop > SpawnPoint stype=chick", "coop > SpawnPoint stype=egg"), &[chick]);
}
