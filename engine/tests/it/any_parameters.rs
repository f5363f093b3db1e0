//! Tests sprite parameters with extreme values.

use base::Seed;
use engine::{Action, Game, SpriteClass};

/// Any class with any parameters and extreme values either continues or ends in a typed outcome, in strict
/// mode and in reference mode.
#[test]
fn any_parameters() {
    const VALUES: [&str; 22] = [
        "0",
        "1",
        "2",
        "-1",
        "-2147483648",
        "2147483647",
        "0.5",
        "-0.5",
        "1e300",
        "-1e300",
        "1e-300",
        "NaN",
        "Infinity",
        "True",
        "False",
        "UP",
        "LEFT",
        "NIL",
        "CONT",
        "a",
        "a,b",
        "ghost",
    ];
    const BASE: [&str; 26] = [
        "speed",
        "cooldown",
        "physicstype",
        "orientation",
        "rotateInPlace",
        "is_static",
        "mass",
        "gravity",
        "friction",
        "max_speed",
        "jump_strength",
        "solid",
        "wMult",
        "hMult",
        "healthPoints",
        "timeToLive",
        "singleton",
        "is_resource",
        "is_avatar",
        "hidden",
        "rotation",
        "orientedImg",
        "lastmove",
        "isFirstTick",
        "on_ground",
        "is_from_avatar",
    ];
    let rules = "    me a > transformTo stype=b\n    b a > wallBounce\n    me b > wallStop\n    b wall > wallReverse\n    b wall > bounceForward\n    a me > collectResource\n    me wall > pullWithIt\n    b EOS > wrapAround\n    me wall > stepBack pixelPerfect=True\n    a wall > turnAround\n    me b > bounceDirection";
    let mut sampler = Seed::from_text("any parameters").sampler();
    let mut played = 0;
    let games = if std::env::var_os("ARCADE_SWEEP").is_some() { 1500 } else { 500 };
    for class in SpriteClass::ALL.iter().cycle().take(games) {
        let own = class.parameters();
        let mut params = || {
            let many = sampler.between(1, 5);
            let one = |_| {
                let key = *sampler.choose(&BASE);
                let key =
                    if own.is_empty() || sampler.between(0, 1) == 0 { key } else { *sampler.choose(&own) };
                format!(" {key}={}", sampler.choose(&VALUES))
            };
            (0..many).map(one).collect::<String>()
        };
        let (avatar, other) =
            if class.is_avatar() { (class.name(), "Missile") } else { ("MovingAvatar", class.name()) };
        let source = format!(
            "BasicGame square_size=10\n  SpriteSet\n    me > {avatar} stype=b{}\n    b > {other} stype=a stype1=a stypes=a,a stypeMissile=a,a resource_name=a{}\n    a > Resource{}\n  LevelMapping\n    m > me\n    b > b\n    a > a\n  InteractionSet\n{rules}\n  TerminationSet\n    Timeout limit=100 win=True\n",
            params(),
            params(),
            params()
        );
        for game in
            [Game::from_source(&source), Game::from_source_as_reference(&source)].into_iter().flatten()
        {
            let Ok(level) = game.level("w w w w\n ba  b \n am b  \n  w w b\n") else { continue };
            let mut state = game.start(&level, Seed::from_text("any"));
            for action in Action::ALL.iter().cycle().take(18) {
                game.step(&mut state, *action);
                assert_eq!(state.state_hash(), state.state_hash_from_scratch(), "{source}");
            }
            let _ = (state.search_key(&game), game.observe(&state));
            played += 1;
        }
    }
    assert!(played > games / 3, "only {played} of the games load");
}
