//! Tests of releases made in slices, interrupted and resumed. The bytes are the same as for an undisturbed
//! mint.

use crate::arcade::{SLICES, SLICES_RECIPE, arcade, copy_of_slices, files, run, sweeping, terminate, text};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

fn recipe(folder: &Path) {
    fs::write(folder.join("slices.toml"), SLICES_RECIPE).unwrap();
}

#[test]
fn the_number_of_threads_changes_no_byte() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    recipe(folder);
    let minted = files(&SLICES.path().join("slices"));
    for jobs in if sweeping() { &["1", "3"][..] } else { &["1"] } {
        run(folder, &["release", "slices.toml", "--jobs", jobs, "--out", jobs], 0);
        assert_eq!(files(&folder.join(jobs)), minted, "{jobs} and 2 threads");
    }
}

#[test]
fn shards_in_any_order_give_the_bytes_of_one_process() {
    let (home, whole) = copy_of_slices();
    let folder = home.path();
    recipe(folder);
    for shard in ["3/3", "1/3", "2/3"] {
        run(
            folder,
            &["release", "slices.toml", "--shard", shard, "--out", &format!("shard{}", &shard[..1])],
            0,
        );
    }
    let output = run(folder, &["merge", "shard2", "shard3", "shard1", "--out", "all merged"], 0);
    // The proposed command can be pasted into a shell.
    assert!(text(&output.stdout).contains("arcade verify 'all merged'"), "{}", text(&output.stdout));
    fs::rename(folder.join("all merged"), folder.join("merged")).unwrap();
    // The bytes are the same, so the properties of a release in one piece (`release.rs`) hold, and it
    // regenerates.
    assert_eq!(files(&whole), files(&folder.join("merged")));
    if sweeping() {
        run(folder, &["regenerate", "merged"], 0);
    }

    let said = |arguments: &[&str]| text(&run(folder, arguments, 2).stderr);
    assert!(said(&["merge", "shard1", "shard3", "--out", "x"]).contains("shards are missing: 2/3"));
    assert!(
        said(&["merge", "shard1", "shard2", "shard3", "shard1", "--out", "x"])
            .contains("both folders hold the same shard")
    );
    assert!(said(&["merge", "slices", "--out", "x"]).contains("not a shard"));
    assert!(said(&["release", "slices.toml", "--shard", "4/3", "--out", "x"]).contains("K from 1 to N"));
    assert!(said(&["release", "slices.toml", "--shard", "1/3"]).contains("--shard needs --out"));
    fs::write(folder.join("other.toml"), SLICES_RECIPE.replace("'slices'", "'others'")).unwrap();
    run(folder, &["release", "other.toml", "--shard", "2/3", "--out", "other2"], 0);
    assert!(said(&["merge", "shard1", "other2", "shard3", "--out", "x"]).contains("different recipes"));

    let (job, content) =
        files(&folder.join("shard1")).into_iter().find(|(name, _)| name.starts_with("jobs/")).unwrap();
    let mut altered = content.clone();
    altered[content.len() / 2] ^= 1;
    fs::write(folder.join("shard1").join(&job), altered).unwrap();
    let said = said(&["merge", "shard1", "shard2", "shard3", "--out", "x"]);
    assert!(said.contains(&job) && said.contains("changed after it was made"), "{said}");
    assert!(!folder.join("x").exists() && !folder.join("x.partial").exists());

    // `arcade clean` lists shards and removes them on request, but keeps a shard that contains a foreign
    // file.
    fs::write(folder.join("shard2/notes.txt"), "mine").unwrap();
    let clean = |flags: &[&str]| {
        let output = arcade(folder).env("TMPDIR", folder).arg("clean").args(flags).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        text(&output.stdout)
    };
    assert!(clean(&[]).contains("kept ./shard1: shard 1/3 of `slices`"));
    assert!(clean(&["--shards"]).contains("3 of 3 removed"));
    let is_there = |name: &str| folder.join(name).exists();
    assert!(!is_there("shard1") && !is_there("shard3") && !is_there("other2"));
    assert!(is_there("shard2/SHARD.json") && is_there("slices") && is_there("merged"));
}

/// Interrupts a mint into the folder `out`, kills it repeatedly, and resumes it. Finished work is kept unless
/// its removal is requested.
#[cfg(unix)]
fn kill_and_resume(folder: &Path, mint: &[&str]) {
    let start = |resume: &[&str]| {
        let mut command = arcade(folder);
        command.args(mint).args(["--out", "out", "--jobs", "1"]).args(resume);
        command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
    };
    let is_lot = |entry: &fs::DirEntry| entry.path().extension().is_some_and(|end| end == "json");
    let jobs = || {
        let there = fs::read_dir(folder.join("out.partial/jobs"));
        there.map_or(0, |there| there.flatten().filter(is_lot).count())
    };
    let interrupted = || {
        let mut child = start(&[]);
        // Wait for the first job, however long that takes.
        while jobs() == 0 && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(5));
        }
        terminate(&child);
        let output = child.wait_with_output().unwrap();
        // On a busy machine, all jobs may be finished before the signal is sent.
        let finished = output.status.success();
        if finished {
            fs::remove_dir_all(folder.join("out")).unwrap();
        }
        (!finished).then_some(output)
    };
    let output = (0..10).find_map(|_| interrupted()).expect("a mint is interrupted between its jobs");
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(143), "{said}");
    assert!(said.contains(&format!("interrupted; continue with: arcade {}", mint.join(" "))), "{said}");
    assert!(said.contains("--resume"), "{said}");
    assert!(jobs() > 0 && !folder.join("out").exists());
    let said = text(&run(folder, &[mint, &["--out", "out"]].concat(), 2).stderr);
    assert!(said.contains("continue with the same command and --resume"), "{said}");
    if mint[0] == "release" {
        let plan = |resume: &[&str]| {
            let output = run(folder, &[mint, &["--out", "out", "--dry-run", "--json"], resume].concat(), 0);
            serde_json::from_slice::<serde_json::Value>(&output.stdout).unwrap()
        };
        let (whole, left) = (plan(&[]), plan(&["--resume"]));
        let minutes = |plan: &serde_json::Value| plan["core_minutes"].as_f64().unwrap();
        assert!(minutes(&left) < minutes(&whole), "{left} {whole}");
        assert_eq!(left["jobs_made"], jobs());
        let said = text(&run(folder, &[mint, &["--out", "out", "--dry-run", "--resume"]].concat(), 0).stdout);
        assert!(said.contains(&format!("of which {} are finished", jobs())), "{said}");
    }
    for milliseconds in [1, 30, 300] {
        let mut child = start(&["--resume"]);
        std::thread::sleep(Duration::from_millis(milliseconds));
        child.kill().unwrap();
        child.wait().unwrap();
    }
    if !folder.join("out").exists() {
        let output = run(folder, &[mint, &["--out", "out", "--resume"]].concat(), 0);
        assert!(text(&output.stderr).contains("jobs were already finished"), "{}", text(&output.stderr));
    }
    assert!(!folder.join("out.partial").exists());
}

/// An interrupted mint gives the same bytes as an undisturbed mint, and so does an interrupted regeneration of a
/// release.
#[cfg(unix)]
#[test]
fn killed_mints_resume() {
    let (home, whole) = copy_of_slices();
    let folder = home.path();
    recipe(folder);
    let mints = [["release", "slices.toml"], ["regenerate", "slices"]];
    for mint in mints.into_iter().take(if sweeping() { 2 } else { 1 }) {
        kill_and_resume(folder, &mint);
        assert_eq!(files(&folder.join("out")), files(&whole));
        fs::remove_dir_all(folder.join("out")).unwrap();
    }
}

/// On a full disk, a mint ends by printing the command that resumes it.
#[cfg(unix)]
#[test]
fn full_disks_report_how_to_continue() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    recipe(folder);
    // Files are limited to about a kilobyte, so no job has room.
    let full = |resume: &str| {
        let mint = format!("exec \"$0\" release slices.toml --out 'my release' {resume}");
        let script = format!("trap '' XFSZ; ulimit -f 2; {mint}");
        let binary = env!("CARGO_BIN_EXE_arcade");
        let output = Command::new("sh").args(["-c", &script, binary]).current_dir(folder).output().unwrap();
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(3), "{said}");
        assert!(
            said.contains("continue with: arcade release slices.toml --out 'my release' --resume"),
            "{said}"
        );
        said
    };
    let said = full("");
    assert!(!said.contains("finished jobs are kept"), "{said}");
    // Finish the jobs of a recipe from which nothing can be selected.
    greedy(folder);
    run(folder, &["release", "slices.toml", "--out", "my release", "--resume"], 2);
    recipe(folder);
    let said = full("--resume");
    assert!(said.contains("finished jobs are kept; once this is fixed"), "{said}");
}

/// Writes a recipe that requests more games of a kind than there are candidates.
fn greedy(folder: &Path) {
    let greedy = format!("{SLICES_RECIPE}[taxonomy]\navatars = {{ watches = [1.0, 1.0] }}\n");
    fs::write(folder.join("slices.toml"), greedy).unwrap();
}

/// Finished jobs are kept if only the selection changes.
#[test]
fn more_candidates_reuse_finished_jobs() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    // The recipe requests more games of a kind than there are candidates. No pattern set has two games of this
    // kind.
    greedy(folder);
    let said = text(&run(folder, &["release", "slices.toml", "--out", "out"], 2).stderr);
    assert!(said.contains("avatar watches 0 (requested 2 to 2)"), "{said}");
    // Without a bar, the output has a forecast and plain lines.
    assert!(said.contains("minting takes about ") && said.contains("4 of 4 jobs; about 0 s left"), "{said}");
    recipe(folder);
    let output = run(folder, &["release", "slices.toml", "--out", "out", "--resume"], 0);
    let said = text(&output.stderr);
    assert!(said.contains("4 of 4 jobs were already finished"), "{said}");
    assert!(said.contains("minting takes 0 seconds: there is nothing to make"), "{said}");
    run(folder, &["verify", "out"], 0);
}
