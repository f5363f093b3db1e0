//! Tests of the hostile set (`tests/suite/hostile/`). Under both loading policies, each case has the result
//! stated in its file.
//!
//! `BLESS=1 cargo test -p infinite-arcade-tests --test it hostile` rewrites the results. Review the diff as you
//! would review code.

use tests::hostile::Case;

#[test]
fn every_case_ends_as_expected() {
    let cases = Case::all();
    assert!(cases.len() > 90, "{} cases", cases.len());
    let bless = std::env::var_os("BLESS").is_some();
    let mut wrong = Vec::new();
    for case in cases {
        if bless {
            case.bless();
        } else if case.got() != case.expect {
            wrong.push(format!(
                "{} is expected to end so:\n{}but ends so:\n{}",
                case.name,
                case.expect,
                case.got()
            ));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// Besides play, a game's warnings, description and canonical printing terminate as well.
#[test]
fn every_game_is_described_or_refused() {
    for case in Case::all() {
        tests::robustness::text(case.source.as_bytes());
        if let Ok(game) = engine::Game::from_source(&case.source) {
            let _ = engine::describe(&game);
        }
    }
}
