//! Tests of the memory tests. For each level, a random choice decided which of two wins was published. A player that
//! replays the published wins is detected, and other players are not.

use crate::arcade::{copy_tree, files, run, text};
use base::Digest;
use engine::Game;
use serde_json::Value;
use snapshots::mint::{Memory, Plan, lay_out, make_jobs};
use snapshots::released::{Released, ReleasedGame};
use snapshots::{
    Corpus, CorpusCard, CorpusGame, Item, MANIFEST_FILE, Manifest, Recipe, Regeneration, Secret,
};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::sync::LazyLock;
use tempfile::TempDir;

/// The number of games, each with one level. Twelve random choices are enough evidence after correction.
const GAMES: u32 = 12;

/// Returns a game in which the player fetches the gem and leaves. The limit makes each game different.
fn source(limit: u32) -> String {
    format!(
        "BasicGame\n    SpriteSet\n        floor > Immovable\n        wall > Immovable\n        gem > Immovable color=YELLOW\n        \
         exit > Door color=GREEN\n        avatar > MovingAvatar\n    LevelMapping\n        . > floor\n        w > floor wall\n        \
         g > floor gem\n        e > floor exit\n        A > floor avatar\n    InteractionSet\n        avatar wall > stepBack\n        \
         gem avatar > killSprite scoreChange=1\n        exit avatar > killSprite\n    TerminationSet\n        \
         MultiSpriteCounter stype1=gem stype2=exit limit=0 win=True\n        Timeout limit={limit} win=False\n"
    )
}

fn corpus() -> Corpus {
    let game = |number: u32| {
        let name = format!("fetch-{number:02}");
        let words = || name.clone();
        let card = CorpusCard {
            title: words(),
            description: words(),
            goal: words(),
            kind: words(),
            real_time: false,
            skill: words(),
            levels: Vec::new(),
        };
        CorpusGame { name: words(), source: source(100 + number), levels: Vec::new(), card }
    };
    Corpus { games: (0..GAMES).map(game).collect(), designs: None }
}

/// A folder with a sealed release. The release's parts are in `public` and `held`, the whole release is in `revealed`,
/// and the withheld renamed copies of its games are in `siblings`. The folder also contains two players' results on
/// both.
static COINS: LazyLock<TempDir> = LazyLock::new(|| {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let text = format!(
        "name = 'coins'\ndescription = 'x'\n[corpus]\ngames = {GAMES}\nlevels = 1\ncandidates = 1.0\n[board]\ncolumns = [7, 8]\n\
         rows = [6, 7]\n[memory]\n[criteria]\nask = ['not-idle', 'not-random', 'winnable']\ndecision = 50\nbudget = 20000\n\
         random_plays = 5\nmcts_plays = 1\n"
    );
    let mut recipe = Recipe::to_commit(&text).unwrap();
    let secret = Secret::draw("coins", recipe.committed(), [7; 64]);
    recipe.commitment = Some(secret.commitment());
    let (corpus, store) = (corpus(), Memory::default());
    let plan = Plan::new(&recipe, Some(&secret), &corpus).unwrap();
    make_jobs(&plan, plan.jobs(), &store, &()).unwrap();
    let write = |part: &str, path: &str, content: &[u8]| {
        let path = folder.join(part).join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    };
    let minted = lay_out(&plan, Some(&secret), &store, Digest::of(b""), &mut |path, content| {
        match path.strip_prefix("held/") {
            Some(path) => write("held", path, content),
            None => write("public", path, content),
        }
        Ok(())
    });
    write("public", MANIFEST_FILE, &minted.unwrap().manifest.to_bytes().unwrap());
    run(folder, &["release", "public", "--reveal", "held", "--out", "revealed"], 0);
    run(folder, &["export", "revealed", "--twin", "sibling", "--format", "games", "--out", "siblings"], 0);
    fs::write(
        folder.join("memoriser.sh"),
        memoriser(&Released::read(&folder.join("revealed")).unwrap().games),
    )
    .unwrap();
    for (games, part) in [("revealed", "published"), ("siblings", "withheld")] {
        for (player, name) in [("cmd:sh memoriser.sh", "memoriser"), ("nearest-goal", "clean")] {
            let out = format!("{name}-{part}");
            run(
                folder,
                &["evaluate", games, "--player", player, "--max-steps", "120", "--out", &out, "-q"],
                0,
            );
        }
    }
    home
});

/// Returns a program that replays a game's published win. It recognises the game by the name and position of
/// its exit, and does nothing in other games.
fn memoriser(games: &[ReleasedGame]) -> String {
    let turn = "\"type\":\"turn\"";
    let mut script = format!("plan=nil; while read -r line; do case $line in *'{turn},\"turn\":0,'*)\n");
    for ReleasedGame { game, levels, .. } in games {
        // The exit follows the floor, the wall, the gem and one of the engine's own types.
        let exit = game.sprite_types().map(|stype| game.name(stype)).nth(4).unwrap();
        let symbol =
            (0..128_u8).find(|&symbol| game.places(symbol).iter().any(|&stype| game.name(stype) == exit));
        let symbol = char::from(symbol.unwrap());
        let lines = levels[0].text.lines().enumerate();
        let exits = lines.filter_map(|(row, line)| Some(format!("[{},{row}]", line.find(symbol)?)));
        let place = exits.collect::<Vec<_>>().join(",");
        let known = format!("\"name\":\"{exit}\",\"cells\":[{place}]");
        let actions = &levels[0].witness.as_ref().unwrap().actions;
        let plan: String = actions.iter().map(|action| format!("{action:?} ").to_lowercase()).collect();
        let _ = writeln!(script, "case $line in *'{known}'*) plan='{plan}nil';; esac");
    }
    script
        + &format!(
            ";; esac; case $line in *'{turn}'*) echo \"{{\\\"action\\\":\\\"${{plan%% *}}\\\"}}\"; plan=${{plan#* }};; esac; done\n"
        )
}

const MEMORISER: [&str; 2] = ["memoriser-published", "memoriser-withheld"];

#[test]
fn a_planted_memoriser_is_found() {
    let folder = COINS.path();
    let output =
        run(folder, &[&["study", "contamination", "--release", "revealed"][..], &MEMORISER].concat(), 1);
    let (said, page) = (text(&output.stdout), include_str!("../../../../docs/how-to/memory.md"));
    // The page shows this run.
    assert!(page.contains(&said), "{said}");
}

#[test]
fn a_clean_player_is_not() {
    let folder = COINS.path();
    let all =
        ["clean-published", "clean-withheld", MEMORISER[0], MEMORISER[1], "--release", "revealed", "--json"];
    let output = run(folder, &[&["study", "contamination"][..], &all].concat(), 1);
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let players = found["findings"]["players"].as_array().unwrap();
    let evidence: Vec<_> = players.iter().map(|player| player["evidence"].as_str().unwrap()).collect();
    assert_eq!(
        evidence,
        ["has_seen_the_solutions_and_the_games", "consistent_with_not_having_seen"],
        "{found:#}"
    );
    assert_eq!(found["findings"]["tests"], 4);
    // The player ignores names, so its episodes on the renamed copies are the same.
    let games = &players[1]["games"];
    assert_eq!((&games["published"], &games["informative"]), (&games["withheld"], &0.into()));
    let alone = ["study", "contamination", "clean-published", "clean-withheld", "--release", "revealed"];
    let said = text(&run(folder, &alone, 0).stdout);
    assert!(said.contains("nearest-goal: consistent with not having seen"), "{said}");
    assert!(said.contains("these episodes say little"), "{said}");
}

#[test]
fn power_is_stated_before_anybody_plays() {
    let said = text(&run(COINS.path(), &["study", "contamination", "--release", "revealed"], 0).stdout);
    assert!(said.contains("by its solutions") && said.contains("by its games"), "{said}");
}

#[test]
fn wrong_inputs_name_the_next_move() {
    let folder = COINS.path();
    let refused = |arguments: &[&str], words: &str| {
        let said = text(&run(folder, &[&["study", "contamination"][..], arguments].concat(), 2).stderr);
        assert!(said.contains(words), "{said}");
    };
    let [published, withheld] = MEMORISER;
    refused(&[published, "--release", "public"], "arcade release PUBLIC --reveal HELD --out DIR");
    refused(
        &[withheld, "--release", "revealed"],
        "arcade export revealed --twin sibling --format games --out siblings",
    );
    run(
        folder,
        &[
            "evaluate",
            "hailglass",
            "--levels",
            "0",
            "--player",
            "random",
            "--max-steps",
            "2",
            "--out",
            "foreign",
        ],
        0,
    );
    refused(&["foreign", "--release", "revealed"], "no episode on any level of the release");
    refused(&[published, published, "--release", "revealed"], "two folders contain the same episodes");
}

/// The wins that were selected at random for publication are revealed before the other files, under the same root.
#[test]
fn solutions_are_revealed_before_the_rest() {
    let (home, made) = (tempfile::tempdir().unwrap(), COINS.path());
    let folder = home.path();
    for part in ["public", "held"] {
        copy_tree(&made.join(part), &folder.join(part));
    }
    run(folder, &["release", "public", "--reveal", "held", "--solutions", "--out", "solved"], 0);
    let said = text(&run(folder, &["verify", "solved"], 0).stdout);
    assert!(
        said.contains("12 witnesses replayed to a win; seed, siblings and second wins withheld"),
        "{said}"
    );
    let there = files(&folder.join("solved/held"));
    assert_eq!(there.len(), 13, "{:?}", there.keys());
    let is_early = |path: &String| path == "SOLUTIONS.json" || path.split('/').count() == 2;
    assert!(there.keys().all(is_early), "{:?}", there.keys());
    let all = files(&made.join("revealed"));
    let secret: Value = serde_json::from_slice(&all["held/secret.json"]).unwrap();
    for (name, content) in files(&folder.join("solved")) {
        assert!(!text(&content).contains(secret["seed"].as_str().unwrap()), "{name}");
    }
    let said = text(&run(folder, &["study", "contamination", "--release", "solved"], 2).stderr);
    assert!(said.contains("the withheld parts of `coins` are missing"), "{said}");
    run(folder, &["release", "solved", "--reveal", "held", "--out", "revealed"], 0);
    assert_eq!(files(&folder.join("revealed")), all);
    // If one of the revealed files is missing, the release does not verify.
    let first = there.keys().find(|path| path.contains('/')).unwrap();
    fs::remove_file(folder.join("solved/held").join(first)).unwrap();
    let said = text(&run(folder, &["verify", "solved"], 1).stdout);
    assert!(said.contains("missing"), "{said}");
}

/// A release's seed reproduces everything that its random choices withheld.
#[test]
fn coins_are_minted_again_bit_for_bit() {
    let (corpus, store) = (corpus(), Memory::default());
    let regeneration = Regeneration::of(&COINS.path().join("revealed")).unwrap();
    let plan = regeneration.plan(&corpus).unwrap();
    make_jobs(&plan, plan.jobs(), &store, &()).unwrap();
    let minted = regeneration.compare(&plan, &store, Digest::of(b""), &mut |_, _| Ok(())).unwrap();
    assert_eq!(minted.compared.differences, Vec::<String>::new());
}

/// A change to a release's files.
type Forgery<'a> = &'a dyn Fn(&mut BTreeMap<String, Vec<u8>>);

#[test]
fn what_was_withheld_is_verified() {
    let said = text(&run(COINS.path(), &["verify", "revealed"], 0).stdout);
    assert!(said.contains("24 witnesses replayed to a win\n"), "{said}");
    // Both copies are renamings, and neither is the corpus game, so nothing public shows which one was withheld.
    let released = Released::read(&COINS.path().join("revealed")).unwrap();
    let corpus: Vec<Digest> =
        corpus().games.iter().map(|game| Game::from_source(&game.source).unwrap().digest()).collect();
    for game in &released.games {
        let sibling = game.sibling.as_ref().unwrap().game.digest();
        assert!(!corpus.contains(&game.game.digest()) && !corpus.contains(&sibling), "{}", game.card.id);
    }
    // The length of the shortest win would reveal which of two wins was published.
    let all = files(&COINS.path().join("revealed"));
    for path in all.keys().filter(|path| path.starts_with("held/seconds/")) {
        let (id, level) = path["held/seconds/".len()..].split_once('/').unwrap();
        let number: usize = level.trim_start_matches("lvl").trim_end_matches(".json").parse().unwrap();
        let game = released.games.iter().find(|game| game.card.id == id).unwrap();
        assert_eq!(game.card.levels[number].optimal_ticks, None, "{path}");
    }
    // These forgeries have their own root.
    let forged = |change: Forgery<'_>, words: &str| {
        let (home, mut all) = (tempfile::tempdir().unwrap(), files(&COINS.path().join("revealed")));
        let mut manifest = Manifest::parse(&all.remove(MANIFEST_FILE).unwrap()).unwrap();
        change(&mut all);
        all.retain(|path, _| !["held/REST.json", "held/SOLUTIONS.json"].contains(&path.as_str()));
        manifest.items = all.iter().map(|(path, content)| Item::of(path.clone(), content)).collect();
        let secret = serde_json::from_slice(&all["held/secret.json"]).unwrap();
        all.extend(snapshots::withhold(&mut manifest, &secret).unwrap());
        manifest.seal_root().unwrap();
        all.insert(MANIFEST_FILE.to_owned(), manifest.to_bytes().unwrap());
        for (path, content) in all {
            let path = home.path().join("forged").join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, content).unwrap();
        }
        let said = text(&run(home.path(), &["verify", "forged"], 1).stdout);
        assert!(said.contains(words), "{words}: {said}");
    };
    let all = files(&COINS.path().join("revealed"));
    let first = |part: &str| all.keys().find(|path| path.starts_with(part)).unwrap().clone();
    let (second, sibling) = (first("held/seconds/"), first("held/siblings/"));
    let won = second.replace("seconds/", "");
    let swap = |files: &mut BTreeMap<String, Vec<u8>>| {
        let (one, other) = (files[&won].clone(), files[&second].clone());
        files.extend([(won.clone(), other), (second.clone(), one)]);
    };
    forged(&swap, &format!("{second}: the coin (the secret random choice) selects this withheld win"));
    let repeat = |files: &mut BTreeMap<String, Vec<u8>>| {
        files.insert(second.clone(), files[&won].clone());
    };
    forged(&repeat, &format!("{second}: the second win begins like the published win"));
    let other_rules = |files: &mut BTreeMap<String, Vec<u8>>| {
        let changed = text(&files[&sibling]).replace("scoreChange=1", "scoreChange=2");
        files.insert(sibling.clone(), changed.into_bytes());
    };
    forged(&other_rules, &format!("{sibling}: the rules are not those"));
    let without_level = |files: &mut BTreeMap<String, Vec<u8>>| {
        files.remove(&sibling.replace("game.vgdl", "lvl0.txt"));
    };
    forged(&without_level, "lvl0.txt: not covered by the commitment");
    let foreign = |files: &mut BTreeMap<String, Vec<u8>>| {
        files.insert("held/siblings/x/game.vgdl".to_owned(), files[&sibling].clone());
    };
    forged(&foreign, "held/siblings/x/game.vgdl: not part of a sealed release");
}
