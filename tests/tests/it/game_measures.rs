//! Measures of corpus games, compared with their authors' intentions.

use agents::{PortfolioConfig, Solution, solve};
use base::Seed;
use engine::Analysis;
use tests::{games, workspace_root};
use validators::Recorded;
use validators::measures::{AvatarKind, ChanceKind, GameKind, GoalKind, PlayMeasures};

#[test]
fn kinds_of_our_own_games() {
    use AvatarKind as A;
    use ChanceKind as C;
    use GoalKind as G;
    let expect = [
        ("bog-lantern", A::Walks, G::Survive, C::Movers),
        ("dormouse-millrace", A::Walks, G::Herd, C::None),
        ("dyepot-newt", A::Walks, G::Unlock, C::None),
        ("foxglove-round", A::Walks, G::Collect, C::Movers),
        ("great-yawn", A::Walks, G::Hunt, C::Movers),
        ("hailglass", A::SlidesAndShoots, G::Eliminate, C::Makers),
        ("pillow-fort", A::WalksAndShoots, G::Eliminate, C::Several),
        ("quiet-jars", A::Walks, G::Deliver, C::None),
        ("salmon-weir", A::Slides, G::Herd, C::Makers),
    ];
    let all = games(&workspace_root().join("corpora"));
    for (name, avatar, goal, chance) in expect {
        let (_, game, _) = all.iter().find(|game| game.0 == name).expect(name);
        let kind = GameKind::of(&Analysis::of(game));
        assert_eq!((kind.avatar, kind.goal, kind.chance), (avatar, goal, chance), "{name}");
    }
}

/// Measures the first level, using the win that the portfolio finds.
fn played(name: &str) -> PlayMeasures {
    let all = games(&workspace_root().join("corpora"));
    let (_, game, levels) = all.iter().find(|game| game.0 == name).expect(name);
    let analysis = Analysis::of(game);
    let config = PortfolioConfig { budget: 150_000, ..PortfolioConfig::default() };
    let solved = solve(&analysis, &levels[0], &config, Seed::from_text("solve"));
    let Solution::Won { episode, .. } = solved.solution else { panic!("{name} is not won") };
    let recording = [Recorded { level: &levels[0], episodes: &[*episode] }];
    PlayMeasures::of(&analysis, &recording, Seed::from_text("measures")).expect("an episode")
}

/// In the puzzle, the jars wait for their porter, who can lose only on time. In the flight, the hounds of the
/// bog do not wait, and catch an avatar that stays where it is.
#[test]
fn measures_match_play_of_a_puzzle_and_a_flight() {
    let (jars, bog) = (played("quiet-jars"), played("bog-lantern"));
    assert_eq!((jars.chance, jars.drama, jars.lead_changes), (0.0, 0.0, 0.0), "{jars:?}");
    // Jars are pushed and come to rest.
    assert!(jars.mechanics >= 2, "{jars:?}");
    // In the bog, something moves in most ticks, and it moves randomly. Among the jars, only pushed jars
    // move.
    assert!(bog.pace > 0.5 && bog.chance > 0.1 && bog.drama > 0.3, "{bog:?}");
    assert!(bog.density < jars.density, "{jars:?} {bog:?}");
}
