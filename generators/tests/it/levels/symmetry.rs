//! Tests of the equality and distance of levels up to symmetry.

use super::measures::{cellar, level};
use engine::Analysis;
use generators::levels::LevelSimilarity;

#[track_caller]
fn distance(one: &str, two: &str) -> f64 {
    let game = cellar();
    let similarity = LevelSimilarity::of(&Analysis::of(&game));
    let (one, two) = (level(&game, one), level(&game, two));
    let distance = similarity.distance(&one, &two);
    assert_eq!(distance, similarity.distance(&two, &one), "it is symmetric");
    assert_eq!(distance == 0.0, similarity.digest(&one) == similarity.digest(&two), "distance {distance}");
    distance
}

#[test]
fn mirror_images_have_equal_digests() {
    let seen = "wwwww/wA.gw/w.w.w/wwwww";
    for image in ["wwwww/wg.Aw/w.w.w/wwwww", "wwwww/w.w.w/wA.gw/wwwww", "wwww/w.Aw/ww.w/w.gw/wwww"] {
        assert_eq!(distance(seen, image), 0.0);
    }
    // The level is rotated by 90 degrees, and its wall has a different character.
    assert_eq!(distance(seen, "vvvv/vA.v/v.vv/vg.v/vvvv"), 0.0);
    assert!(distance(seen, "wwwww/wAg.w/w.w.w/wwwww") > 0.0);
}

#[test]
fn ground_does_not_count() {
    // The levels share the avatar and one gem. The other gem is moved, which counts as two cells of weight 2.
    assert_eq!(distance("A....g/g.....", "A....g/.g...."), 4.0 / 8.0);
    // Inner walls weigh half as much, and border walls weigh nothing.
    assert_eq!(distance("wwwwww/wA..ww/wwwwww", "wwwwww/wA.www/wwwwww"), 1.0 / 4.0);
    // Columns that one of the levels lacks count like walls.
    assert_eq!(distance("A.g/...", "A.g./...."), 2.0 / 6.0);
}

#[test]
fn levels_without_common_cells_have_distance_one() {
    assert_eq!(distance("A.........../......g.....", "....A......./ggg........."), 1.0);
}
