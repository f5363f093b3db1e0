//! Tests of results whose logs were altered, before or after their row was entered in a public log. Each test
//! tries many alterations, and 1,000 in a sweep.

use crate::arcade::{TINY, arcade, copy_tree, files, run, sweeping, text};
use base::{Digest, Sampler, Seed};
use disk::Disk;
use engine::{Action, Game};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use trust::SecretKey;
use trust::log::{Entry, Log, ResultRow, append};

/// The files of a results folder.
type Files = BTreeMap<String, Vec<u8>>;

/// The expected judgement on an altered folder whose row contains the digest of the altered files.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Expect {
    /// The row is rejected, for a reason with one of these words.
    Refused(&'static [&'static str]),
    /// The row is accepted, because the episodes have the same actions and results.
    Same,
}

/// A publisher's log, with the row of one results folder.
struct Rows {
    home: tempfile::TempDir,
    secret: SecretKey,
    honest: Files,
    row: ResultRow,
}

impl Rows {
    fn new() -> Rows {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path();
        copy_tree(&TINY.path().join("tiny"), &folder.join("tiny"));
        run(folder, &["trust", "keygen", "log", "--no-password"], 0);
        let player = ["--player", "olets:200", "--max-steps", "120", "--out", "results"];
        run(folder, &[&["evaluate", "tiny"][..], &player].concat(), 0);
        let origin =
            ["--origin", "example.org/arcade", "--release", "tiny", "--unsigned", "--result", "results"];
        run(folder, &[&["trust", "log", "append", "log", "--secret", "log.key"][..], &origin].concat(), 0);
        let entries = Log::open(&folder.join("log")).unwrap().unwrap().entries().unwrap();
        let row = entries.into_iter().find_map(|entry| match entry {
            Entry::Result(row) => Some(row),
            _ => None,
        });
        let secret = SecretKey::open(&fs::read_to_string(folder.join("log.key")).unwrap(), None).unwrap();
        let honest = files(&folder.join("results"));
        Rows { row: row.unwrap(), secret, honest, home }
    }

    fn place(&self, name: &str) -> PathBuf {
        self.home.path().join(name)
    }

    /// Checks a folder against a log. Returns the exit status and the output.
    fn check(&self, log: &str, more: &[&str]) -> (Option<i32>, String) {
        let args = ["trust", "log", "check", log, "--key", "log.pub", "--jobs", "1", "--replay", "altered"];
        let output = arcade(self.home.path()).args(args).args(more).output().unwrap();
        (output.status.code(), text(&output.stdout) + &text(&output.stderr))
    }

    /// Writes the altered files.
    fn write(&self, altered: &Files) {
        let folder = self.place("altered");
        let _ = fs::remove_dir_all(&folder);
        for (name, content) in altered {
            let path = folder.join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, content).unwrap();
        }
    }

    /// Writes a log whose row belongs to the altered files, as a cheating publisher could without using
    /// `arcade trust log append`.
    fn forge(&self, results: Digest) {
        let folder = self.place("forged");
        let _ = fs::remove_dir_all(&folder);
        let honest = Log::open(&self.place("log")).unwrap().unwrap().entries().unwrap();
        let forge = |entry| match entry {
            Entry::Result(row) => Entry::Result(ResultRow { results, ..row }),
            other => other,
        };
        let entries: Vec<Entry> = honest.into_iter().map(forge).collect();
        let no_rules = |_: &[Entry]| Vec::new();
        append(&folder, Some("example.org/arcade"), &self.secret, &entries, &no_rules, &Disk::new()).unwrap();
    }
}

/// Returns the random choices for one alteration. Each sweep makes different choices, because its seed comes
/// from an environment variable.
fn chance(purpose: &str, number: u64) -> Sampler {
    let sweep = std::env::var_os("ARCADE_SWEEP").and_then(|text| text.into_string().ok());
    Seed::from_text(&format!("{purpose} {}", sweep.unwrap_or_default())).child("alteration", number).sampler()
}

fn episodes(files: &Files) -> Vec<String> {
    files.keys().filter(|name| name.ends_with(".jsonl")).cloned().collect()
}

fn one_of<'a, T>(all: &'a [T], chance: &mut Sampler) -> &'a T {
    &all[chance.below(all.len())]
}

/// Returns the lines of an episode's log. Each line is an event.
fn events(files: &Files, name: &str) -> Vec<Value> {
    text(&files[name]).lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn store(files: &mut Files, name: &str, events: &[Value]) {
    let lines: String = events.iter().map(|event| format!("{event}\n")).collect();
    files.insert(name.to_owned(), lines.into_bytes());
}

/// Returns the indices of the steps among the events.
fn steps(events: &[Value]) -> Vec<usize> {
    (0..events.len()).filter(|&at| events[at]["event"] == "step").collect()
}

/// Returns `true` if a different action at a step leads to the same state according to the engine. The log
/// then belongs to an episode that could have been played, with the same results.
fn leads_to_the_same(files: &Files, events: &[Value], at: usize, action: Action) -> bool {
    let start = &events[0];
    let id = start["game"].as_str().unwrap();
    let game = Game::from_source(&text(&files[&format!("games/{id}/game.vgdl")])).unwrap();
    let level = text(&files[&format!("games/{id}/lvl{}.txt", start["level"])]);
    let level = game.level(&level).unwrap();
    let mut state = game.start(&level, start["seed"].as_str().unwrap().parse().unwrap());
    for event in &events[1..at] {
        game.step(&mut state, action_of(event));
    }
    game.step(&mut state, action);
    state.state_hash().to_string() == events[at]["hash"].as_str().unwrap()
}

fn action_of(event: &Value) -> Action {
    serde_json::from_value(event["action"].clone()).unwrap()
}

const OF_ANOTHER: &[&str] =
    &["line 1: ", "the episode was played on game", "it was played on another", "starts in"];
const NOT_REPLAYED: &[&str] = &["but the log records", "is recorded as", "after the end of the episode"];

/// Alters files in one of many ways.
fn alter(files: &mut Files, number: u64, chance: &mut Sampler) -> Expect {
    let all = episodes(files);
    let name = one_of(&all, chance).clone();
    let mut found = events(files, &name);
    let steps = steps(&found);
    let at = *one_of(&steps, chance);
    let other = |chance: &mut Sampler, not: &str| loop {
        let name = one_of(&all, chance).clone();
        if name != not {
            return name;
        }
    };
    match number % 16 {
        // A step has a different action.
        0 | 1 => {
            let names: Vec<&str> = ["nil", "left", "right", "up", "down", "use"]
                .into_iter()
                .filter(|name| found[at]["action"] != **name)
                .collect();
            found[at]["action"] = Value::from(*one_of(&names, chance));
            let is_same = leads_to_the_same(files, &found, at, action_of(&found[at]));
            store(files, &name, &found);
            if is_same { Expect::Same } else { Expect::Refused(NOT_REPLAYED) }
        }
        2 => {
            let seed = Digest::of(&chance.below(1 << 30).to_le_bytes()).to_string();
            found[0]["seed"] = Value::from(seed);
            store(files, &name, &found);
            Expect::Refused(OF_ANOTHER)
        }
        3 => {
            found[at]["step"] = Value::from(found[at]["step"].as_u64().unwrap() + 1 + chance.below(9) as u64);
            store(files, &name, &found);
            Expect::Refused(NOT_REPLAYED)
        }
        // The log claims results that do not follow from the actions.
        4 => {
            match chance.below(4) {
                0 => found[at]["hash"] = Value::from(format!("{:032x}", chance.below(1 << 30))),
                1 => found[at]["score"] = Value::from(found[at]["score"].as_f64().unwrap() + 1.0),
                2 => found[at]["outcome"] = Value::from("lost"),
                _ => found[at]["avatar"] = Value::from(vec![97, chance.below(90)]),
            }
            store(files, &name, &found);
            Expect::Refused(NOT_REPLAYED)
        }
        5 => {
            let end = found.last_mut().unwrap();
            match chance.below(3) {
                0 => {
                    end["outcome"] = Value::from(if end["outcome"] == "won" { "lost" } else { "won" });
                    end["status"] = Value::from("ended");
                }
                1 => end["score"] = Value::from(end["score"].as_f64().unwrap() + 1.0),
                _ => end["steps"] = Value::from(end["steps"].as_u64().unwrap() + 1),
            }
            store(files, &name, &found);
            Expect::Refused(&["restore", "unknown variant", "but the log records", "the episode"])
        }
        // Lines are missing, duplicated or in a different order.
        6 => {
            found.remove(at);
            store(files, &name, &found);
            Expect::Refused(NOT_REPLAYED_OR_ENDED)
        }
        7 => {
            found.insert(at, found[at].clone());
            store(files, &name, &found);
            Expect::Refused(NOT_REPLAYED)
        }
        8 => {
            let second = *one_of(&steps, chance);
            if second == at {
                found.swap(0, at);
            } else {
                found.swap(at, second);
            }
            store(files, &name, &found);
            Expect::Refused(&["is recorded as", "is not the start of an episode", "a second start"])
        }
        // Episodes are missing, unfinished, duplicated or on a different level.
        9 => {
            files.remove(&name);
            Expect::Refused(&["`episodes` is"])
        }
        10 => {
            found.truncate(1 + chance.below(found.len() - 1));
            store(files, &name, &found);
            Expect::Refused(&["`episodes` is"])
        }
        11 => {
            let copy = files[&name].clone();
            if chance.below(2) == 0 {
                files.insert(name.replace("run0", "run1"), copy);
                return Expect::Refused(&["does not list this episode"]);
            }
            files.insert(other(chance, &name), copy);
            Expect::Refused(OF_ANOTHER)
        }
        12 => {
            let second = other(chance, &name);
            let [one, two] = [files[&name].clone(), files[&second].clone()];
            files.insert(name, two);
            files.insert(second, one);
            Expect::Refused(OF_ANOTHER)
        }
        // The settings are changed.
        13 => {
            let mut settings: Value = serde_json::from_slice(&files["evaluation.json"]).unwrap();
            let words: &[&str] = match chance.below(5) {
                0 => {
                    settings["entrant"]["name"] = Value::from("mcts:200");
                    &["`player` is"]
                }
                1 => {
                    settings["max_steps"] = Value::from(61 + chance.below(1000));
                    OF_ANOTHER
                }
                2 => {
                    settings["seed"] = Value::from(format!("seed {}", chance.below(1000)));
                    OF_ANOTHER
                }
                3 => {
                    settings["runs"] = Value::from(2 + chance.below(9));
                    &["`open` is"]
                }
                _ => {
                    settings["snapshot"] = Value::from(Digest::of(&[7]).to_string());
                    &["which is not in the log"]
                }
            };
            files.insert("evaluation.json".to_owned(), settings.to_string().into_bytes());
            Expect::Refused(words)
        }
        // The text of a game or level is changed, but the settings contain the digest of the original.
        14 => {
            let games: Vec<String> = files.keys().filter(|name| name.ends_with("txt")).cloned().collect();
            let name = one_of(&games, chance);
            let text = text(&files[name]);
            let at =
                one_of(&text.match_indices('.').map(|(at, _)| at).collect::<Vec<_>>(), chance).to_owned();
            let wall = text.replacen('\n', "w\n", 1);
            let altered = if chance.below(2) == 0 { wall } else { text[..at].to_owned() + &text[at + 1..] };
            files.insert(name.clone(), altered.into_bytes());
            Expect::Refused(&["restore the results folder", "digest", "level"])
        }
        // The content is the same, but the bytes differ in spaces, or in times, which no replay can check.
        _ => {
            if chance.below(2) == 0 {
                let spaced = text(&files[&name]).replacen(",\"", ", \"", 1 + chance.below(99));
                files.insert(name, spaced.into_bytes());
            } else {
                found[at]["took_ms"] = Value::from(1 + chance.below(100_000));
                store(files, &name, &found);
            }
            Expect::Same
        }
    }
}

const NOT_REPLAYED_OR_ENDED: &[&str] = &["is recorded as", "the log records", "the episode"];

/// However it is altered, a folder no longer matches the log. If the row belongs to the altered folder, the
/// episodes contradict the row's results.
#[test]
fn altered_logs_are_refused() {
    let rows = Rows::new();
    let (mut refused, mut same) = (0, 0);
    for number in 0..if sweeping() { 1000 } else { 30 } {
        let mut chance = chance("altered rows", number);
        let mut altered = rows.honest.clone();
        let expect = alter(&mut altered, number, &mut chance);
        assert_ne!(altered, rows.honest, "{number}");
        rows.write(&altered);
        let (status, said) = rows.check("log", &[]);
        let words = "no row in the log has the digest of these results, ";
        assert!(status == Some(1) && said.contains(words), "{number}: {said}");
        let digest = said.split(words).nth(1).unwrap().split(':').next().unwrap();
        rows.forge(digest.parse().unwrap());
        let (status, said) = rows.check("forged", &["--release", "tiny"]);
        match expect {
            Expect::Same => {
                same += 1;
                assert!(status == Some(0) && said.contains("sound; 2 entries"), "{number}: {said}");
            }
            Expect::Refused(words) => {
                refused += 1;
                let is_told = words.iter().any(|words| said.contains(words));
                assert!(status == Some(1) && is_told, "{number}: none of {words:?} in: {said}");
            }
        }
    }
    assert!(refused > 8 * same, "{refused} refused, {same} of the same meaning");
}

/// Changing any byte of any file makes the folder differ from the log.
#[test]
fn altered_bytes_are_refused() {
    let rows = Rows::new();
    let names: Vec<String> = rows.honest.keys().filter(|name| !name.starts_with('.')).cloned().collect();
    for number in 0..if sweeping() { 1000 } else { 24 } {
        let mut chance = chance("altered bytes", number);
        let mut altered = rows.honest.clone();
        let content = altered.get_mut(one_of(&names, &mut chance)).unwrap();
        let at = chance.below(content.len());
        match number % 3 {
            0 => content[at] ^= 1 << chance.below(8),
            1 => drop(content.remove(at)),
            _ => content.insert(at, b' '),
        }
        rows.write(&altered);
        let (status, said) = rows.check("log", &[]);
        assert!(
            status == Some(1) && said.contains("no row in the log has the digest of these results"),
            "{number}: {said}"
        );
    }
}

/// An easier game is given the name of one of the release's games. The episodes replay, but not on the
/// release's games.
#[test]
fn results_on_another_game_are_refused() {
    let rows = Rows::new();
    let folder = rows.home.path();
    copy_tree(&folder.join("tiny/games"), &folder.join("games"));
    let games = files(&folder.join("games"));
    let levels: Vec<&String> = games.keys().filter(|name| name.ends_with("lvl0.txt")).collect();
    for name in games.keys().filter(|name| !name.ends_with("txt") && !name.ends_with("vgdl")) {
        fs::remove_file(folder.join("games").join(name)).unwrap();
    }
    let level = folder.join("games").join(levels[0]);
    let easier = fs::read_to_string(&level).unwrap().replacen('.', "w", 1);
    fs::write(&level, easier).unwrap();
    let played = Path::new("games").join(Path::new(levels[0]).parent().unwrap());
    let played = played.to_str().unwrap();
    run(folder, &["evaluate", played, "--player", "olets:200", "--max-steps", "60", "--out", "easier"], 0);
    let mut altered = files(&folder.join("easier"));
    let mut settings: Value = serde_json::from_slice(&altered["evaluation.json"]).unwrap();
    settings["snapshot"] = Value::from(rows.row.root.to_string());
    altered.insert("evaluation.json".to_owned(), settings.to_string().into_bytes());
    rows.write(&altered);
    let append = ["trust", "log", "append", "log", "--secret", "log.key", "--result", "altered"];
    run(folder, &append, 0);
    let (status, said) = rows.check("log", &[]);
    assert!(
        status == Some(0) && said.contains("its games were not compared with those of the release"),
        "{said}"
    );
    let (status, said) = rows.check("log", &["--release", "tiny"]);
    assert!(status == Some(1) && said.contains("does not match any file in the release `tiny`"), "{said}");
}
