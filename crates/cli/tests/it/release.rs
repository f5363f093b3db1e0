//! Tests of minting and verifying releases, and of the guarantees that a release gives.

use crate::arcade::{
    SLICES_RECIPE, TINY, arcade, copy_of_slices, copy_of_tiny, copy_tree, files, run, sweeping, text,
};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;

/// Returns a non-Unicode folder name, on systems that allow such names.
fn unusual() -> PathBuf {
    #[cfg(target_os = "linux")]
    {
        PathBuf::from(<std::ffi::OsStr as std::os::unix::ffi::OsStrExt>::from_bytes(b"one\xff"))
    }
    #[cfg(not(target_os = "linux"))]
    {
        PathBuf::from("one")
    }
}

/// Answers that contain a path work for folders with any name.
#[test]
fn folders_may_have_any_name() {
    let home = tempfile::tempdir().unwrap();
    let out = unusual();
    let answer = |arguments: &[&str]| -> serde_json::Value {
        let output =
            arcade(home.path()).args(arguments).arg("--json").arg("--out").arg(&out).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
        serde_json::from_slice(&output.stdout).unwrap()
    };
    assert_eq!(answer(&["release", "tiny", "--dry-run"])["out"], out.display().to_string());
    assert_eq!(answer(&["release", "tiny", "--commit"])["secret"], out.display().to_string());
}

#[test]
fn a_release_verifies_and_regenerates() {
    let folder = TINY.path();
    let output = run(folder, &["verify", "tiny"], 0);
    assert!(text(&output.stdout).contains("witnesses replayed to a win"), "{}", text(&output.stdout));
    let out = unusual();
    let output = arcade(folder).args(["regenerate", "tiny", "--out"]).arg(&out).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let said = text(&output.stdout);
    assert!(said.starts_with("identical") && said.contains("the regenerated release is in one"), "{said}");
    assert_eq!(files(&folder.join("tiny")), files(&folder.join(out)));
}

/// If the digest changes although `seeds/tiny.toml` has not changed, GENERATION (or SEMANTICS) must be
/// raised.
#[test]
fn the_root_of_tiny_is_the_one_in_the_repository() {
    let output = run(TINY.path(), &["--json", "verify", "tiny"], 0);
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["root"].as_str().unwrap(), include_str!("../tiny.root").trim());
}

#[test]
fn the_version_names_generation_and_semantics() {
    let output = run(TINY.path(), &["--version"], 0);
    let expect = format!(
        "arcade {} (GENERATION {}, SEMANTICS {})\n",
        env!("CARGO_PKG_VERSION"),
        generators::GENERATION,
        engine::SEMANTICS
    );
    assert_eq!(text(&output.stdout), expect);
    let manifest = fs::read_to_string(TINY.path().join("tiny/MANIFEST.json")).unwrap();
    let expect = format!("\"version\": \"{}\"", snapshots::version::CURRENT.number);
    assert!(manifest.contains(&expect), "{manifest}");
}

/// The README's first command runs in an empty folder. Here, its cost is only estimated. In a sweep, the
/// release is minted.
#[test]
fn the_starter_is_minted_and_verifies() {
    let folder = tempfile::tempdir().unwrap();
    let output = run(folder.path(), &["release", "--dry-run"], 0);
    assert!(text(&output.stdout).contains("starter"), "{}", text(&output.stdout));
    if sweeping() {
        run(folder.path(), &["release"], 0);
        run(folder.path(), &["verify", "releases/starter"], 0);
        run(folder.path(), &["regenerate", "releases/starter"], 0);
    }
}

/// The same seed gives the same candidates, and the parent already contains the best of them.
#[test]
fn content_of_earlier_releases_is_not_minted_again() {
    let (home, _) = copy_of_slices();
    let folder = home.path();
    let recipe = SLICES_RECIPE.replacen("'slices'", "'next'", 1);
    fs::write(folder.join("next.toml"), recipe.replace("candidates = 2.0", "candidates = 1.0")).unwrap();
    let output = run(folder, &["release", "next.toml", "--parent", "slices", "--out", "next"], 2);
    let said = text(&output.stderr);
    assert!(said.contains("can be selected") && said.contains("in an earlier release"), "{said}");
    fs::write(folder.join("slices.toml"), SLICES_RECIPE).unwrap();
    let output = run(folder, &["release", "slices.toml", "--parent", "slices", "--out", "next"], 2);
    assert!(text(&output.stderr).contains("choose another name"), "{}", text(&output.stderr));
    // A different seed gives different candidates, and the parent's items are known.
    fs::write(folder.join("next.toml"), recipe.replacen("'pieces'", "'other pieces'", 1)).unwrap();
    run(folder, &["release", "next.toml", "--parent", "slices", "--out", "later"], 0);
    let said = text(&run(folder, &["verify", "later", "--chain", "slices"], 0).stdout);
    assert!(said.contains("chain: sound; `next` and 1 before it"), "{said}");
}

#[test]
fn any_flipped_byte_is_named() {
    let (folder, root) = copy_of_tiny();
    for (name, content) in files(&root).into_iter().filter(|(name, _)| !name.starts_with("papers/")) {
        for place in [0, content.len() / 3, content.len() / 2, content.len() - 1] {
            let mut altered = content.clone();
            altered[place] ^= 1;
            fs::write(root.join(&name), &altered).unwrap();
            let output = arcade(folder.path()).args(["verify", "tiny"]).output().unwrap();
            assert_eq!(output.status.code(), Some(1), "{name} byte {place}");
            let said = text(&output.stdout) + &text(&output.stderr);
            assert!(said.contains(&name), "{name} byte {place}: {said}");
        }
        fs::write(root.join(&name), content).unwrap();
    }
    run(folder.path(), &["verify", "tiny"], 0);
}

/// The arguments for comparing `tiny` with `again`, which is already minted.
const REGENERATED: [&str; 5] = ["regenerate", "tiny", "--out", "again", "--resume"];

#[test]
fn a_file_removed_added_or_linked_is_named() {
    let (folder, root) = copy_of_tiny();
    copy_tree(&root, &folder.path().join("again"));
    let level = files(&root).into_keys().find(|name| name.ends_with("lvl0.txt")).unwrap();
    let content = fs::read(root.join(&level)).unwrap();

    fs::remove_file(root.join(&level)).unwrap();
    let output = run(folder.path(), &["verify", "tiny"], 1);
    assert!(text(&output.stdout).contains(&level), "{}", text(&output.stdout));
    let output = run(folder.path(), &REGENERATED, 1);
    assert!(text(&output.stdout).contains(&level), "{}", text(&output.stdout));

    let elsewhere = folder.path().join("elsewhere.txt");
    fs::write(&elsewhere, &content).unwrap();
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&elsewhere, root.join(&level)).unwrap();
        let output = run(folder.path(), &["verify", "tiny"], 1);
        assert!(text(&output.stdout).contains(&level), "{}", text(&output.stdout));
        fs::remove_file(root.join(&level)).unwrap();
    }
    fs::write(root.join(&level), &content).unwrap();

    fs::write(root.join("games/stowaway.txt"), "x").unwrap();
    let output = run(folder.path(), &["verify", "tiny"], 1);
    assert!(text(&output.stdout).contains("games/stowaway.txt"), "{}", text(&output.stdout));
}

/// A release's papers may be changed or added to. No other file may change.
#[test]
fn papers_accompany_a_release() {
    let (folder, root) = copy_of_tiny();
    copy_tree(&root, &folder.path().join("again"));
    let papers: Vec<String> =
        files(&root).into_keys().filter_map(|name| Some(name.strip_prefix("papers/")?.to_owned())).collect();
    assert_eq!(papers, ["CHANGELOG.md", "CITATION.cff", "DATASHEET.md", "LICENSE"]);
    let digest = |out: &str| {
        let output =
            run(folder.path(), &["--json", "export", "tiny", "--format", "archive", "--out", out], 0);
        serde_json::from_slice::<serde_json::Value>(&output.stdout).unwrap()["digest"].clone()
    };
    let before = digest("before.tar.zst");
    fs::write(root.join("papers/LICENSE"), "CC0-1.0").unwrap();
    fs::write(root.join("papers/doi.txt"), "10.5281/zenodo.0").unwrap();
    fs::create_dir_all(root.join(".git/objects")).unwrap();
    fs::write(root.join(".git/a file"), "x").unwrap();
    fs::write(root.join(".DS_Store"), "x").unwrap();
    let said = text(&run(folder.path(), &["verify", "tiny"], 0).stdout);
    assert!(said.contains("papers: 5 files, not covered by the root\nignored: .DS_Store, .git\n"), "{said}");
    let said = text(&run(folder.path(), &REGENERATED, 0).stdout);
    assert!(said.contains("\nidentical: "), "{said}");
    let chained = run(folder.path(), &["verify", "tiny", "--chain", "."], 0);
    assert!(text(&chained.stdout).contains("is the first release"), "{}", text(&chained.stdout));
    // A release's archive does not depend on its papers.
    assert_eq!(digest("after.tar.zst"), before);

    fs::write(root.join("games/.DS_Store"), "x").unwrap();
    let said = text(&run(folder.path(), &["verify", "tiny"], 1).stdout);
    assert!(said.contains("games/.DS_Store: extra"), "{said}");
    fs::remove_file(root.join("games/.DS_Store")).unwrap();
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("/etc/hostname", root.join("papers/host")).unwrap();
        let said = text(&run(folder.path(), &["verify", "tiny"], 1).stdout);
        assert!(said.contains("papers/host: a symbolic link"), "{said}");
    }
}

#[test]
fn occupied_outputs_are_refused_before_minting() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("mine")).unwrap();
    fs::write(folder.path().join("mine/thesis.txt"), "x").unwrap();
    let output = run(folder.path(), &["release", "tiny", "--out", "mine"], 2);
    assert!(text(&output.stderr).contains("choose another --out"), "{}", text(&output.stderr));
    assert_eq!(fs::read(folder.path().join("mine/thesis.txt")).unwrap(), b"x");
    // A dry run writes nothing.
    let output = run(folder.path(), &["release", "tiny", "--out", "mine", "--dry-run"], 0);
    let said = text(&output.stdout);
    assert!(said.contains("would mint 2 new games") && said.contains("which already exists"), "{said}");
}

/// A repeated job in a job array has nothing to do, and succeeds.
#[test]
fn a_finished_mint_is_complete() {
    let (folder, _) = copy_of_tiny();
    let resumed = ["release", "tiny", "--out", "tiny", "--resume"];
    for arguments in [&resumed[..], &[&resumed[..], &["--dry-run"]].concat()] {
        let said = text(&run(folder.path(), arguments, 0).stdout);
        assert!(said.contains("already complete: tiny"), "{said}");
    }
    let other = text(&run(folder.path(), &["release", "starter", "--out", "tiny", "--resume"], 2).stderr);
    assert!(other.contains("is not an empty folder"), "{other}");
    fs::write(folder.path().join("tiny/README.md"), "x").unwrap();
    run(folder.path(), &resumed, 2);
}

/// Any file written into a release breaks its verification, unless the file is among the papers.
#[test]
fn nothing_is_written_into_a_release() {
    let (folder, root) = copy_of_tiny();
    for arguments in [
        &["verify", "tiny", "--item", "MANIFEST.json", "--write-proof", "tiny/p.json"][..],
        &["release", "tiny", "--out", "tiny/sub"],
        &["release", "tiny", "--commit", "--out", "tiny/secret.json"],
        &["regenerate", "tiny", "--out", "tiny/again"],
        &["merge", "x", "--out", "tiny/merged"],
        &["export", "tiny", "--format", "archive", "--out", "tiny/games/a.tar.zst"],
        &["evaluate", "tiny", "--player", "random", "--out", "tiny/results"],
        &["report", "x", "--out", "tiny/report"],
        &["render", "hailglass", "-o", "tiny/board.png"],
    ] {
        let said = text(&run(folder.path(), arguments, 2).stderr);
        assert!(said.contains("is in the release itself"), "{arguments:?}: {said}");
    }
    run(folder.path(), &["render", "hailglass", "-o", "tiny/papers/board.png"], 0);
    assert_eq!(files(&root).len(), files(&TINY.path().join("tiny")).len() + 1);
    fs::write(root.join("DOI.txt"), "x").unwrap();
    let said = text(&run(folder.path(), &["verify", "tiny"], 1).stdout);
    assert!(said.contains("DOI.txt: extra") && said.contains("papers/"), "{said}");
    let said = text(
        &run(folder.path(), &["export", "tiny", "--format", "games", "--solutions", "--out", "x"], 2).stderr,
    );
    assert!(said.contains("contain no solutions"), "{said}");
}

/// No version has minted this release, so no version can be installed to mint it again.
#[test]
fn a_changed_version_is_damage() {
    let (folder, root) = copy_of_tiny();
    let manifest = fs::read_to_string(root.join("MANIFEST.json")).unwrap();
    let stated = format!("\"semantics\": {}", engine::SEMANTICS);
    assert!(manifest.contains(&stated), "{manifest}");
    fs::write(root.join("MANIFEST.json"), manifest.replace(&stated, "\"semantics\": 1")).unwrap();
    let said = text(&run(folder.path(), &["regenerate", "tiny"], 2).stderr);
    assert!(said.contains("is damaged or was changed") && !said.contains("install"), "{said}");
}

#[test]
fn recipes_of_other_months_are_explained() {
    let folder = tempfile::tempdir().unwrap();
    let said = text(&run(folder.path(), &["release", "2026-11"], 2).stderr);
    for words in [
        "did you mean `2026-12`?",
        "`arcade recipes show 2026-12 > 2026-11.toml`",
        "`arcade release 2026-11.toml`",
    ] {
        assert!(said.contains(words), "`{words}` is not in\n{said}");
    }
    let said = text(&run(folder.path(), &["release", "startr"], 2).stderr);
    assert!(said.contains("did you mean `starter`? Or pass a .toml file"), "{said}");
}

/// A shard may have nothing to do.
#[test]
fn more_shards_than_jobs_are_reported() {
    let folder = tempfile::tempdir().unwrap();
    let shard = ["release", "tiny", "--shard", "300/300", "--out", "x", "--dry-run"];
    let output = run(folder.path(), &shard, 0);
    assert!(text(&output.stderr).contains("more shards than jobs"), "{}", text(&output.stderr));
    assert!(
        text(&output.stdout).contains("in 0 seconds: there is nothing to make"),
        "{}",
        text(&output.stdout)
    );
}

/// An existing file is never removed.
#[test]
fn files_in_the_way_are_reported() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("file"), "x").unwrap();
    let said = |out: &str| text(&run(folder.path(), &["release", "tiny", "--out", out], 2).stderr);
    let below = said("file/x");
    assert!(below.contains("part of its path is a file"), "{below}");
    let file = said("file");
    assert!(file.contains("choose another --out") && !file.contains("remove"), "{file}");
    fs::write(folder.path().join("long.toml"), "x".repeat(5000)).unwrap();
    let long = text(&run(folder.path(), &["release", "tiny", "--secret", "long.toml"], 2).stderr);
    assert!(long.contains("is not the secret of a sealed release"), "{long}");
}

/// A mint killed at any moment leaves nothing that verifies.
#[cfg(unix)]
#[test]
fn a_killed_mint_leaves_nothing_that_verifies() {
    for milliseconds in [1, 20, 100, 400] {
        let folder = tempfile::tempdir().unwrap();
        let mut child = arcade(folder.path())
            .args(["release", "starter", "--out", "out", "--jobs", "1"])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(std::time::Duration::from_millis(milliseconds));
        child.kill().unwrap();
        child.wait().unwrap();
        assert!(!folder.path().join("out").exists());
        for place in ["out", "out.partial", "out.partial/tree"] {
            let output = arcade(folder.path()).args(["verify", place]).output().unwrap();
            assert_ne!(output.status.code(), Some(0), "{place} after {milliseconds} ms");
        }
    }
}

/// A complete but unpublished folder is not a release.
#[test]
fn an_unpublished_tree_does_not_verify() {
    let (folder, root) = copy_of_tiny();
    fs::create_dir(folder.path().join("new.partial")).unwrap();
    fs::rename(&root, folder.path().join("new.partial/tree")).unwrap();
    let resumed = "`arcade release RECIPE --out new --resume`";
    for place in ["new.partial", "new.partial/tree"] {
        for arguments in [
            &["verify", place][..],
            &["regenerate", place],
            &["export", place, "--format", "archive", "--out", "new.tar.zst"],
            &["export", place, "--format", "games", "--out", "games"],
        ] {
            let said = text(&run(folder.path(), arguments, 2).stderr);
            assert!(said.contains("is unfinished") && said.contains(resumed), "{arguments:?}: {said}");
        }
    }
}

#[test]
fn bad_recipes_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let good = "name = 'mine'\ndescription = 'x'\nseed = 'x'\n[generated]\ngames = 1\n";
    for (recipe, words) in [
        (good.replace("games", "gamse"), "gamse"),
        (good.replace("= 1", "= 0"), "nothing to mint"),
        (format!("{good}[corpus]\ngames = 1000\n"), "corpus.games"),
        ("name".to_owned(), "expected"),
    ] {
        fs::write(folder.path().join("mine.toml"), recipe).unwrap();
        let output = run(folder.path(), &["release", "mine.toml"], 2);
        assert!(text(&output.stderr).contains(words), "{}", text(&output.stderr));
    }
    let more = "[invented]\ngames = 2\nlevels = 4\n[corpus]\ngames = 3\n";
    fs::write(folder.path().join("mine.toml"), format!("{good}{more}")).unwrap();
    let output = run(folder.path(), &["release", "mine.toml", "--dry-run"], 0);
    for part in
        ["would mint 2 invented games of 4 levels\n", "and 1 new game of", "for each of 3 corpus games"]
    {
        assert!(text(&output.stdout).contains(part), "{}", text(&output.stdout));
    }
    assert!(!folder.path().join("releases").exists());
}

/// Returns a release stored in the repository.
fn kept(name: &str) -> String {
    format!("{}/../../tests/suite/snapshots/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// Without replays, nothing shows that the levels can be won. The answer is no, unless the user accepts this.
#[test]
fn unreplayed_witnesses_are_not_verified() {
    let folder = tempfile::tempdir().unwrap();
    let place = kept("other-semantics");
    let said = text(&run(folder.path(), &["verify", &place], 1).stdout);
    assert!(said.contains("witnesses: not replayed (needs a version of arcade with semantics 1"), "{said}");
    assert!(said.contains("other-semantics: NOT verified") && said.contains("--accept-unreplayed"), "{said}");
    run(folder.path(), &["--json", "verify", &place], 1);
    let said = text(&run(folder.path(), &["verify", &place, "--accept-unreplayed"], 0).stdout);
    assert!(said.contains("accepted without replaying its witnesses"), "{said}");
    assert!(!said.contains("verified"), "{said}");
    // A version that never existed does not count as different semantics.
    let forged = folder.path().join("forged");
    copy_tree(Path::new(&place), &forged);
    let path = forged.join("MANIFEST.json");
    let manifest = fs::read(&path).unwrap();
    let mut manifest = snapshots::Manifest::parse(&manifest).unwrap();
    manifest.semantics = 0;
    manifest.seal_root().unwrap();
    fs::write(&path, manifest.to_bytes().unwrap()).unwrap();
    let said = text(&run(folder.path(), &["verify", "forged", "--accept-unreplayed"], 1).stdout);
    assert!(said.contains("GENERATION 1 never had SEMANTICS 0"), "{said}");
}

/// Without a root from another source, nothing shows which release the folder is, and the answer states this.
#[test]
fn only_the_published_root_identifies_a_release() {
    let folder = tempfile::tempdir().unwrap();
    let place = kept("other-semantics");
    let verify = ["--json", "verify", &place, "--accept-unreplayed"];
    let told = |arguments: &[&str]| -> serde_json::Value {
        serde_json::from_slice(&run(folder.path(), arguments, 0).stdout).unwrap()
    };
    let answer = told(&verify);
    assert_eq!(answer["root_compared"], false);
    let root = answer["root"].as_str().unwrap();
    assert_eq!(told(&[&verify[..], &["--root", root]].concat())["root_compared"], true);
    let said = text(&run(folder.path(), &verify[1..], 0).stdout);
    assert!(said.contains("The folder is consistent.") && said.contains("pass --root DIGEST"), "{said}");
    let said = text(&run(folder.path(), &[&verify[1..], &["--root", root]].concat(), 0).stdout);
    run(folder.path(), &[&verify[1..], &["--root", &root.to_uppercase()]].concat(), 0);
    assert!(said.contains("as given") && !said.contains("is consistent"), "{said}");
    let other = "0".repeat(64);
    let said = text(&run(folder.path(), &[&verify[1..], &["--root", &other]].concat(), 1).stdout);
    assert!(said.contains(&format!("not {other}")), "{said}");
}

#[test]
fn non_snapshots_are_named() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    fs::write(folder.join("passwd"), "root:x:0:0\n").unwrap();
    fs::write(folder.join("game.vgdl"), "BasicGame\n").unwrap();
    fs::write(folder.join("recipe.toml"), "name = 'x'\n").unwrap();
    fs::create_dir_all(folder.join("game")).unwrap();
    fs::write(folder.join("game/game.vgdl"), "BasicGame\n").unwrap();
    fs::create_dir_all(folder.join("empty")).unwrap();
    fs::create_dir_all(folder.join("sealed/public")).unwrap();
    fs::write(folder.join("sealed/public/MANIFEST.json"), "{}").unwrap();
    // The folder with both parts stands for the published part, whose manifest is damaged here.
    let said = text(&run(folder, &["verify", "sealed"], 1).stdout);
    assert!(said.contains("sealed/public: does NOT verify"), "{said}");
    let takes = "a snapshot is a folder that contains MANIFEST.json, or the .tar.zst that";
    for (place, what) in [
        ("passwd", "`passwd` is a file, but not a snapshot archive"),
        ("game.vgdl", "is a text file: check a game with `arcade validate`"),
        ("recipe.toml", "mint it with `arcade release`"),
        ("game", "is a game's folder"),
        ("sealed/public/MANIFEST.json", "is a manifest: pass the folder that contains it"),
        ("empty", "is a folder without MANIFEST.json"),
    ] {
        let said = text(&run(folder, &["verify", place], 2).stderr);
        assert!(said.contains(what) && said.contains(takes), "{place}: {said}");
    }
    for verb in ["verify", "regenerate"] {
        let said = text(&run(folder, &[verb, "nowhere"], 2).stderr);
        assert!(said.contains("`nowhere` does not exist"), "{said}");
    }
    let said = text(&run(folder, &["regenerate", "sealed/public/MANIFEST.json"], 2).stderr);
    assert!(said.contains("is a manifest: pass the folder that contains it"), "{said}");
}

/// The number of replayed steps is bounded, and the user can change the bound.
#[test]
fn replays_take_no_more_than_is_allowed() {
    let said = text(&run(TINY.path(), &["verify", "tiny", "--max-work", "100"], 1).stdout);
    let expect = "tiny: not checked: the bound of 100 units of work is too small for its witnesses";
    assert!(said.contains(expect) && !said.contains("NOT verify"), "{said}");
    let output = run(TINY.path(), &["--json", "verify", "tiny", "--max-work", "100"], 1);
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["exceeded"], 100);
    // A different root is a fault under any bound.
    let root = "0".repeat(64);
    let said = text(&run(TINY.path(), &["verify", "tiny", "--max-work", "100", "--root", &root], 1).stdout);
    assert!(said.contains("replaying the witnesses takes more than 100 units of work"), "{said}");
    assert!(said.contains("tiny: does NOT verify; problems: 2"), "{said}");
    run(TINY.path(), &["verify", "tiny", "--max-work", "100000000"], 0);
}

/// A non-Unicode name is valid.
#[cfg(target_os = "linux")]
#[test]
fn exports_to_any_name() {
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().unwrap();
    let place = kept("other-semantics");
    for (format, out) in [("games", &b"games\xff"[..]), ("archive", &b"archive\xff"[..])] {
        for json in [&["--json"][..], &[]] {
            let out = folder.path().join(std::ffi::OsStr::from_bytes(out));
            let mut export = arcade(folder.path());
            export.args(json).args(["export", &place, "--format", format, "--out"]).arg(&out);
            let output = export.output().unwrap();
            assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
            assert!(text(&output.stdout).contains('\u{fffd}'), "{}", text(&output.stdout));
            fs::remove_dir_all(&out).or_else(|_| fs::remove_file(&out)).unwrap();
        }
    }
}
