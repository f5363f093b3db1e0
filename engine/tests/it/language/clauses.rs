//! Tests rules as clauses.

use engine::{Clauses, Game, Party, Term};

const GAME: &str = "BasicGame square_size=30\n  SpriteSet\n    egg > Immovable color=RED\n    moving > speed=0.5\n      fox > Chaser stype=hen\n      hen > RandomNPC speed=1\n    avatar > MovingAvatar\n  LevelMapping\n    e > egg fox\n  InteractionSet\n    egg avatar hen > killSprite scoreChange=2\n    avatar EOS > stepBack\n    EOS fox > wrapAround offset=0\n    fox TIME > addTimer ftype=transformTo stype=hen timer=9\n  TerminationSet\n    SpriteCounter stype=egg limit=0 win=True\n    Timeout limit=99\n";

fn clauses(source: &str) -> Clauses {
    Game::from_source(source).unwrap_or_else(|problems| panic!("{problems}")).clauses()
}

#[test]
fn inherited_and_default_values_are_not_distinguished() {
    let of = clauses(GAME);
    let spelled = GAME
        .replace("moving > speed=0.5", "moving >")
        .replace("fox > Chaser stype=hen", "fox > Chaser stype=hen speed=0.5 cooldown=1")
        .replace("color=RED", "img=pearl is_static=True");
    assert_eq!(of.types[3..], clauses(&spelled).types[3..]);
    assert_eq!(of.interactions, clauses(&spelled).interactions);
    assert_ne!(of.types, clauses(&GAME.replace("0.5", "0.4")).types);
}

#[test]
fn interactions_are_described_pair_by_pair() {
    let of = clauses(GAME);
    let effects: Vec<&str> = of.interactions.iter().map(|clause| clause.effect).collect();
    assert_eq!(effects, ["killSprite", "killSprite", "stepBack", "wrapAround", "addTimer"]);
    assert_eq!(of.interactions[0].terms, [("scoreChange", Term::Number(2.0))]);
    assert_eq!(of.interactions[3].terms, []);
    assert_eq!(of.interactions[3].second, Party::Edge);
    let planned = &of.interactions[4];
    assert_eq!(planned.second, Party::Clock);
    let keys: Vec<&str> = planned.terms.iter().map(|(key, _)| *key).collect();
    assert!(["ftype", "stype", "timer"].iter().all(|key| keys.contains(key)), "{keys:?}");
    assert_eq!(of.terminations[0].terms.len(), 1);
    assert!(of.terminations[0].win && !of.terminations[1].win);
    assert_eq!(of.header, []);
    // The file does not declare `wall`, so the mapping of `w` is not one of its rules.
    let symbols: Vec<char> = of.mapping.iter().map(|(symbol, _)| *symbol).collect();
    assert_eq!(symbols, ['A', 'e']);
}
