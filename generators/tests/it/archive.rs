//! Tests of archives: the grid, its elites and its pockets.

use generators::{AddStatus, Archive, Axis, Evaluation};

fn archive() -> Archive<&'static str> {
    Archive::new(vec![Axis::new("length", (0.0, 30.0), 3), Axis::new("share", (0.0, 1.0), 4)], 2)
}

fn judged(feasibility: f64, objective: f64, measures: [f64; 2]) -> Evaluation {
    Evaluation { feasibility, objective, measures: measures.to_vec() }
}

#[test]
fn values_beyond_the_range_are_clamped() {
    let axis = Axis::new("length", (10.0, 30.0), 4);
    let bins = [-1e300, 10.0, 14.9, 15.0, 29.9, 30.0, f64::INFINITY, f64::NAN].map(|value| axis.bin(value));
    assert_eq!(bins, [0, 0, 0, 1, 3, 3, 3, 0]);
    let nothing = Axis { bins: 0, range: (1.0, 1.0), ..axis };
    assert_eq!([0.0, 1.0, 2.0].map(|value| nothing.bin(value)), [0, 0, 0]);
}

#[test]
fn a_cell_keeps_its_best() {
    let mut archive = archive();
    assert_eq!(archive.add("first", judged(1.0, 0.4, [5.0, 0.1])), AddStatus::New);
    assert_eq!(archive.add("equal", judged(1.0, 0.4, [6.0, 0.2])), AddStatus::Rejected);
    assert_eq!(archive.add("better", judged(1.0, 0.5, [6.0, 0.2])), AddStatus::Improved);
    assert_eq!(archive.add("elsewhere", judged(1.0, 0.1, [25.0, 0.9])), AddStatus::New);
    let elites: Vec<(usize, &str)> = archive.elites().map(|(cell, elite)| (cell, elite.candidate)).collect();
    assert_eq!(elites, [(0, "better"), (11, "elsewhere")]);
    assert_eq!((archive.coverage(), archive.qd_score()), (2.0 / 12.0, 0.6));
    assert_eq!(archive.best().map(|elite| elite.candidate), Some("better"));
}

#[test]
fn missing_measures_count_as_the_lowest() {
    let archive = archive();
    assert_eq!([&[][..], &[15.0], &[15.0, 0.6, 9.0]].map(|measures| archive.cell(measures)), [0, 4, 6]);
}

#[test]
fn a_pocket_keeps_the_least_infeasible_and_the_youngest_of_equals() {
    let mut archive = archive();
    let mut add = |name, feasibility| archive.add(name, judged(feasibility, 1.0, [15.0, 0.6]));
    assert_eq!(add("half", 0.5), AddStatus::New);
    assert_eq!(add("third", 0.3), AddStatus::Improved);
    assert_eq!(add("fifth", 0.2), AddStatus::Rejected);
    assert_eq!(add("other third", 0.3), AddStatus::Improved);
    let names: Vec<&str> = archive.pocket(6).iter().map(|judged| judged.candidate).collect();
    assert_eq!(names, ["half", "other third"]);
    assert_eq!((archive.elites().len(), archive.best()), (0, None));
    assert!(archive.qd_score().is_sign_positive());
}

#[test]
fn neighbours_differ_by_one_bin_of_one_axis() {
    let archive = archive();
    assert_eq!(archive.neighbours(0), [4, 1]);
    assert_eq!(archive.neighbours(5), [1, 9, 4, 6]);
    assert_eq!(archive.neighbours(11), [7, 10]);
    for cell in 0..archive.cells() {
        let bins = archive.bins(cell);
        assert_eq!(archive.cell(&[bins[0] as f64 * 10.0 + 5.0, bins[1] as f64 * 0.25 + 0.1]), cell);
    }
}
