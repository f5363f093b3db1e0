//! Tests of marks: the results of reference players, stored in a release.

use crate::arcade::{commit, files, run, sweeping, text};
use std::fs;
use std::path::Path;
use std::sync::LazyLock;
use tempfile::TempDir;

/// A recipe with three jobs that take seconds each. With this seed, the reference players win some of the episodes.
const RECIPE: &str = "name = 'marked'\ndescription = 'x'\nseed = 'lamps'\n[corpus]\ngames = 2\nlevels = 1\n\
    candidates = 1.5\n[criteria]\ndecision = 100\nbudget = 80000\ndepths = [10, 25]\nrandom_plays = 10\n";
/// The section of the recipe that requests the results of reference players.
const MARKS: &str = "[marks]\nplayers = ['random', 'touch-everything', 'nearest-goal', 'reflex', 'guided-mcts:60']\n\
    commits = ['1', '5', 'all']\nplays = 2\nmax_steps = 200\n";

/// A folder that contains a release with stored results of reference players in `marked`, and its recipe.
static MARKED: LazyLock<TempDir> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    recipe(folder.path());
    run(folder.path(), &["release", "marked.toml", "--out", "marked", "--jobs", "2"], 0);
    folder
});

fn recipe(folder: &Path) {
    fs::write(folder.join("marked.toml"), RECIPE.to_owned() + MARKS).unwrap();
}

fn marks(release: &Path) -> serde_json::Value {
    serde_json::from_slice(&fs::read(release.join("MARKS.json")).unwrap()).unwrap()
}

#[test]
fn marks_are_minted_again_bit_for_bit() {
    let (home, whole) = (tempfile::tempdir().unwrap(), MARKED.path().join("marked"));
    let folder = home.path();
    recipe(folder);
    let said = text(&run(folder, &["verify", &whole.display().to_string()], 0).stdout);
    assert!(said.contains("verified"), "{said}");
    if sweeping() {
        run(folder, &["regenerate", &whole.display().to_string(), "--jobs", "1"], 0);
    }
    for shard in ["1/2", "2/2"] {
        run(folder, &["release", "marked.toml", "--shard", shard, "--out", &shard[..1]], 0);
    }
    run(folder, &["merge", "1", "2", "--out", "merged"], 0);
    assert_eq!(files(&whole), files(&folder.join("merged")));
}

/// Runs only in `cargo xtask sweep`. The games are made before the reference players play them.
#[test]
fn games_are_the_same_without_marks() {
    if !sweeping() {
        return;
    }
    let of_games = |release: &Path| {
        let mut files = files(&release.join("games"));
        files.retain(|name, _| name.ends_with(".txt"));
        files
    };
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("plain.toml"), RECIPE).unwrap();
    run(home.path(), &["release", "plain.toml", "--out", "plain"], 0);
    assert_eq!(of_games(&MARKED.path().join("marked")), of_games(&home.path().join("plain")));
    assert!(!home.path().join("plain/MARKS.json").exists());
}

/// Anyone can replay the episodes of the reference players with a subcommand that knows nothing of the stored results.
#[test]
fn marks_are_the_episodes_of_an_evaluation() {
    let (home, whole) = (tempfile::tempdir().unwrap(), MARKED.path().join("marked"));
    let folder = home.path();
    let marks = marks(&whole);
    let mut won = 0;
    let players = marks["asked"]["players"].as_array().unwrap();
    for (player, name) in players.iter().map(|name| name.as_str().unwrap()).enumerate() {
        for (commit, k) in ["1", "5", "all"].into_iter().enumerate() {
            let games = marks["games"].as_array().unwrap().iter();
            let levels = games.flat_map(|game| game["levels"].as_array().unwrap());
            let kept: u64 = levels.map(|level| level["wins"][player][commit].as_u64().unwrap()).sum();
            let out = format!("{}-{k}", name.replace(':', "-"));
            let release = whole.display().to_string();
            let asked = ["--runs", "2", "--max-steps", "200", "--commit", k, "--player", name, "--out", &out];
            let output = run(folder, &[&["--json", "evaluate", &release][..], &asked].concat(), 0);
            let answer: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
            assert_eq!(answer["tally"]["won"].as_u64(), Some(kept), "{name} {k}");
            won += kept;
        }
    }
    assert!(won > 0, "{marks:#}");
    // If these numbers change without a new GENERATION, the reference players' results have changed although they must
    // not.
    let digest = base::Digest::of(marks["games"].to_string().as_bytes());
    assert_eq!(digest.short(), "8b626bb9", "{}", marks["games"]);

    // Reports show the stored results of reference players beside the players.
    run(folder, &["report", "reflex-1", "guided-mcts-60-5", "--out", "report"], 0);
    let csv = fs::read_to_string(folder.join("report/tables/marks.csv")).unwrap();
    assert!(csv.contains("nearest-goal,mark"), "{csv}");
    let page = fs::read_to_string(folder.join("report/report.html")).unwrap();
    assert!(page.contains("Compared with the marks of the release"));
}

#[test]
fn marks_of_two_releases_are_compared() {
    let whole = MARKED.path().join("marked").display().to_string();
    let output = run(MARKED.path(), &["diff", &whole, &whole], 0);
    let said = text(&output.stdout);
    assert!(said.contains("marks, in percent") && said.contains("reflex"), "{said}");
}

#[test]
fn unknown_marks_are_named() {
    let home = tempfile::tempdir().unwrap();
    let recipe = RECIPE.to_owned() + &MARKS.replace("reflex", "reflexes");
    fs::write(home.path().join("wrong.toml"), recipe).unwrap();
    let said = text(&run(home.path(), &["release", "wrong.toml", "--out", "x"], 2).stderr);
    assert!(said.contains("`marks.players`") && said.contains("reflexes"), "{said}");
}

#[test]
fn marks_of_a_sealed_release_are_withheld() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    commit(folder, &|commitment| {
        let sealed = RECIPE
            .replace("seed = 'lamps'", &format!("commitment = '{commitment}'"))
            .replace("games = 2", "games = 1");
        let marks =
            "[marks]\nplayers = ['random', 'nearest-goal']\ncommits = ['1']\nplays = 1\nmax_steps = 100\n";
        sealed + marks
    });
    run(folder, &["release", "marked.toml", "--secret", "marked.secret.json", "--out", "out"], 0);
    assert!(folder.join("out/held/MARKS.json").exists());
    assert!(files(&folder.join("out/public")).keys().all(|name| !name.contains("MARKS")));
    run(folder, &["verify", "out/public"], 0);
    run(folder, &["release", "out/public", "--reveal", "out/held", "--out", "revealed"], 0);
    run(folder, &["verify", "revealed"], 0);
    run(folder, &["regenerate", "revealed"], 0);
}
