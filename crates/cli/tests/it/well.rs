//! Tests of `arcade study well`, as users run it.

use crate::arcade::{run, text};
use serde_json::Value;

#[test]
fn a_short_chain_is_told_as_tables_and_as_json() {
    let folder = tempfile::tempdir().unwrap();
    let well = |more: &[&str]| {
        run(folder.path(), &[&["study", "well", "--months", "2", "--games", "2"], more].concat(), 0)
    };
    let json: Value = serde_json::from_slice(&well(&["--json"]).stdout).unwrap();
    let months = json["months"].as_array().unwrap();
    assert_eq!((months.len(), &months[1]["month"]), (2, &2.into()));
    assert!(months[0]["nearest"]["least"].as_f64().unwrap() >= 0.3);
    assert!(json["sets"].as_f64().unwrap() > 1000.0);
    let again: Value = serde_json::from_slice(&well(&["--json", "--jobs", "1"]).stdout).unwrap();
    assert_eq!(json, again);
    let said = text(&well(&["--yield", "1"]).stdout);
    assert!(said.contains("## Rules of each month") && said.contains("| unseen at 0.4 |"), "{said}");
}

#[test]
fn a_recipe_without_invented_games_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let said = text(&run(folder.path(), &["study", "well", "tiny"], 2).stderr);
    assert!(said.contains("requests no invented games"), "{said}");
}
