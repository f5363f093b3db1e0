//! Tests of the log of a year, and of attacks on it. Each attack is tried in many ways: 1,000 in a sweep
//! (`cargo xtask sweep`).

use base::{Digest, Sampler, Seed};
use blst::min_sig;
use disk::Disk;
use infinite_arcade_trust::log::{
    CHECKPOINT_FILE, Checkpoint, Consistency, Entry, Inclusion, Log, ResultRow, Revealed, Round, append,
    frozen, problems, unkept,
};
use infinite_arcade_trust::{Chain, Drawn, Metadata, Proof, SecretKey, TrustError, generate};
use sha2::{Digest as _, Sha256};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The number of ways in which an attack is tried.
fn mutations() -> u64 {
    if std::env::var_os("ARCADE_SWEEP").is_some() { 1000 } else { 20 }
}

/// Returns the sampler of one mutation. Its seed includes the value of `ARCADE_SWEEP`, so each sweep can differ.
fn chance(purpose: &str, number: u64) -> Sampler {
    let sweep = std::env::var_os("ARCADE_SWEEP").and_then(|text| text.into_string().ok());
    Seed::from_text(&format!("{purpose} {}", sweep.unwrap_or_default())).child("mutation", number).sampler()
}

fn digest(text: &str) -> Digest {
    Digest::of(text.as_bytes())
}

/// Computes the commitment with a formula for these tests; the formula of releases is in `snapshots`.
fn commitment_of(revealed: &Revealed) -> Digest {
    digest(&format!("{} {} {}", revealed.seed, revealed.nonce, revealed.recipe))
}

fn rules(entries: &[Entry]) -> Vec<String> {
    problems(entries, &commitment_of)
}

fn secret_of(month: &str) -> Revealed {
    Revealed {
        release: month.to_owned(),
        root: digest(month),
        seed: format!("seed of {month}"),
        nonce: digest(&format!("nonce of {month}")),
        recipe: digest(&format!("recipe of {month}")),
    }
}

fn months() -> Vec<String> {
    (1..=12).map(|month| format!("2027-{month:02}")).collect()
}

/// A drand-like network, whose key the tests have.
struct Network {
    key: min_sig::SecretKey,
    chain: Chain,
}

impl Network {
    fn new() -> Network {
        let key = min_sig::SecretKey::key_gen(&[7; 32], &[]).unwrap();
        let mut chain = Chain {
            public_key: hex(&key.sk_to_pk().to_bytes()),
            period: 3,
            genesis_time: 1_800_000_000,
            hash: digest("filled in"),
            group_hash: digest("group"),
            scheme: "bls-unchained-g1-rfc9380".to_owned(),
            metadata: Metadata { beacon_id: "tests".to_owned() },
        };
        chain.hash = chain.computed_hash().unwrap();
        Network { key, chain }
    }

    fn round(&self, round: u64) -> Drawn {
        let message = Sha256::digest(round.to_be_bytes());
        let signature =
            self.key.sign(&message, b"BLS_SIG_BLS12381G1_XMD:SHA-256_SSWU_RO_NUL_", &[]).to_bytes();
        let value: [u8; 32] = Sha256::digest(signature).into();
        let chain = Some(self.chain.clone());
        let proof = Proof { signature: hex(&signature), previous_signature: None, chain };
        let round = Round { source: format!("drand {}", self.chain.hash), round };
        Drawn { round, value: Digest::from_bytes(value), proof: Some(proof) }
    }
}

fn bytes_of(hex: &str) -> Vec<u8> {
    (0..hex.len()).step_by(2).map(|at| u8::from_str_radix(&hex[at..at + 2], 16).unwrap()).collect()
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Returns a year as its publisher states it: each month is committed to, waits for its beacon, is minted, revealed,
/// calibrated, and played by somebody.
fn year() -> Vec<Entry> {
    let first_keys = Entry::Keys { version: 1, digest: digest("keys 1"), previous: None };
    let mut entries = vec![first_keys];
    let network = Network::new();
    let mut parent = None;
    for (number, month) in (1..).zip(months()) {
        let secret = secret_of(&month);
        let drawn = network.round(1000 * number);
        let (round, value) = (drawn.round.clone(), drawn.value);
        let (release, root) = (month.clone(), secret.root);
        let commitment = commitment_of(&secret);
        entries.push(Entry::Commitment {
            release: release.clone(),
            commitment,
            recipe: secret.recipe,
            parent,
            beacon: Some(round),
        });
        entries.push(drawn.entry());
        entries.push(Entry::Root {
            release: release.clone(),
            root,
            parent,
            commitment: Some(commitment),
            beacon: Some(value),
            statement: Some(digest(&format!("statement of {month}"))),
        });
        entries.push(Entry::Reveal(secret));
        entries.push(Entry::Calibration { release: release.clone(), root, file: digest("scale") });
        entries.push(Entry::Result(ResultRow {
            release,
            root,
            results: digest(&format!("results of {month}")),
            player: "mcts:100".to_owned(),
            track: Some("told@1".to_owned()),
            horizon: "1".to_owned(),
            episodes: 600,
            open: 0,
            wins: 150,
            rate: 0.25,
            interval: (0.21, 0.3),
            score: Some(3.5),
        }));
        parent = Some(root);
    }
    entries.push(Entry::Keys { version: 2, digest: digest("keys 2"), previous: Some(digest("keys 1")) });
    entries
}

struct Publisher {
    secret: SecretKey,
}

impl Publisher {
    fn new() -> Publisher {
        Publisher { secret: SecretKey::open(&generate(None).unwrap().secret_file, None).unwrap() }
    }

    fn append(&self, folder: &Path, entries: &[Entry]) -> Result<Log, String> {
        append(folder, Some("example.org/arcade"), &self.secret, entries, &rules, &Disk::new())
            .map_err(|error| error.to_string())
    }

    /// Writes a log regardless of its entries, because publishers who attack their readers do not use `append`.
    fn forge(&self, entries: &[Entry]) -> (TempDir, Log) {
        let home = tempfile::tempdir().unwrap();
        let no_rules = |_: &[Entry]| Vec::new();
        let name = Some("example.org/arcade");
        let log = append(home.path(), name, &self.secret, entries, &no_rules, &Disk::new()).unwrap();
        (home, log)
    }
}

fn read(folder: &Path) -> Log {
    Log::open(folder).unwrap().unwrap()
}

#[test]
fn a_year_is_sound() {
    let home = tempfile::tempdir().unwrap();
    let publisher = Publisher::new();
    let key = publisher.secret.public();
    let entries = year();
    let mut seen: Option<Checkpoint> = None;
    // The entries are appended in steps, as over a year.
    for step in entries.chunks(5) {
        let log = publisher.append(home.path(), step).unwrap();
        assert_eq!(log.faults(&key), [""; 0]);
        if let Some(seen) = &seen {
            assert_eq!(log.fork(seen), None);
            let growth = log.prove_growth(seen.size).unwrap().to_text();
            let growth = Consistency::parse(&growth, "growth").unwrap();
            assert_eq!(growth.check(seen, &key), Ok(()));
        }
        seen = Some(log.checkpoint.clone());
    }
    let log = read(home.path());
    assert_eq!(log.entries().unwrap(), entries);
    assert_eq!(rules(&entries), [""; 0]);
    assert_eq!((unkept(&entries), frozen(&entries, "2027-12")), (Vec::new(), None));
    for number in 0..entries.len() as u64 {
        let proof = Inclusion::parse(&log.prove(number).unwrap().to_text(), "proof").unwrap();
        let entry = log.entry(number).unwrap();
        assert_eq!(proof.check(entry, &key), Ok(()));
        assert!(
            proof.check(b"{}", &key).is_err()
                && proof.check(entry, &Publisher::new().secret.public()).is_err()
        );
    }
    // A second writer and a different name are rejected.
    let other = append(home.path(), Some("other"), &publisher.secret, &[], &rules, &Disk::new());
    assert!(other.unwrap_err().to_string().contains("omit --origin"));
    assert!(Publisher::new().append(home.path(), &[]).unwrap_err().contains("is not signed by the key"));
}

/// Whenever the power fails while a month is appended, the log is either the old one or the new one. Appending again
/// gives the bytes of an undisturbed log.
#[test]
fn a_loss_of_power_leaves_the_old_log_or_the_new_one() {
    let publisher = Publisher::new();
    let entries = year();
    let (old, new) = entries.split_at(7);
    let whole = tempfile::tempdir().unwrap();
    publisher.append(whole.path(), old).unwrap();
    publisher.append(whole.path(), &new[..6]).unwrap();
    for steps in 0.. {
        let home = tempfile::tempdir().unwrap();
        publisher.append(home.path(), old).unwrap();
        let cut = Disk::losing_power_after(steps);
        let done = append(home.path(), None, &publisher.secret, &new[..6], &rules, &cut);
        let log = read(home.path());
        assert_eq!(log.faults(&publisher.secret.public()), [""; 0], "after {steps} steps");
        let size = log.checkpoint.size;
        assert!(size == 7 || size == 13, "{size} entries after {steps} steps");
        if size == 7 {
            publisher.append(home.path(), &new[..6]).unwrap();
        }
        assert_eq!(
            fs::read(home.path().join(CHECKPOINT_FILE)).unwrap(),
            fs::read(whole.path().join(CHECKPOINT_FILE)).unwrap()
        );
        assert_eq!(read(home.path()).faults(&publisher.secret.public()), [""; 0]);
        if done.is_ok() {
            assert!(steps > 10, "{steps}");
            break;
        }
    }
}

/// Checks that the entries break a rule, with these words in the message.
#[track_caller]
fn broken(entries: &[Entry], words: &str) {
    let found = rules(entries);
    assert!(found.iter().any(|problem| problem.contains(words)), "no `{words}` in {found:?}");
}

fn at(entries: &[Entry], is_it: impl Fn(&Entry) -> bool) -> Vec<usize> {
    (0..entries.len()).filter(|at| is_it(&entries[*at])).collect()
}

fn one_of(places: &[usize], chance: &mut Sampler) -> usize {
    places[chance.below(places.len())]
}

fn any_digest(chance: &mut Sampler) -> Digest {
    digest(&chance.bits().to_string())
}

#[test]
fn equivocation_is_told() {
    let entries = year();
    let roots = at(&entries, |entry| matches!(entry, Entry::Root { .. }));
    for number in 0..mutations() {
        let mut chance = chance("equivocation", number);
        let place = one_of(&roots, &mut chance);
        let mut second = entries[place].clone();
        if let Entry::Root { root, .. } = &mut second {
            *root = any_digest(&mut chance);
        }
        let mut forged = entries.clone();
        forged.insert(place + 1 + chance.below(entries.len() - place), second);
        broken(&forged, "a second root for");
    }
}

#[test]
fn swapped_beacons_are_told() {
    let entries = year();
    let [commitments, beacons, roots] = [
        at(&entries, |entry| matches!(entry, Entry::Commitment { .. })),
        at(&entries, |entry| matches!(entry, Entry::Beacon { .. })),
        at(&entries, |entry| matches!(entry, Entry::Root { .. })),
    ];
    for number in 0..mutations() {
        let mut chance = chance("beacon", number);
        let mut forged = entries.clone();
        let words = match number % 8 {
            0 => {
                // The release was minted with a different value.
                if let Entry::Root { beacon, .. } = &mut forged[one_of(&roots, &mut chance)] {
                    *beacon = Some(any_digest(&mut chance));
                }
                "was minted with a different value than round"
            }
            1 => {
                // The release was minted without a value.
                if let Entry::Root { beacon, .. } = &mut forged[one_of(&roots, &mut chance)] {
                    *beacon = None;
                }
                "was minted with a different value than round"
            }
            2 => {
                // The value was known before the commitment.
                let place = one_of(&commitments, &mut chance);
                forged.swap(place, place + 1);
                "which was known before it"
            }
            3 => {
                // The round has a second value, which suits the publisher.
                let place = one_of(&beacons, &mut chance);
                let mut second = forged[place].clone();
                if let Entry::Beacon { value, .. } = &mut second {
                    *value = any_digest(&mut chance);
                }
                forged.insert(place + 1, second);
                "has two values"
            }
            4 => {
                // The value is made up, and so is the release.
                let place = one_of(&beacons, &mut chance);
                let made_up = any_digest(&mut chance);
                if let Entry::Beacon { value, proof, .. } = &mut forged[place] {
                    *value = made_up;
                    if chance.below(2) == 0 {
                        *proof = None;
                    }
                }
                if let Entry::Root { beacon, .. } = &mut forged[place + 1] {
                    *beacon = Some(made_up);
                }
                "the value of round"
            }
            5 => {
                // The signature is altered, and the value is its hash.
                let place = one_of(&beacons, &mut chance);
                let mut made_up = None;
                if let Entry::Beacon { value, proof: Some(proof), .. } = &mut forged[place] {
                    let mut signature = bytes_of(&proof.signature);
                    let at = chance.below(signature.len());
                    signature[at] ^= 1 << chance.below(8);
                    proof.signature = hex(&signature);
                    let hash: [u8; 32] = Sha256::digest(&signature).into();
                    *value = Digest::from_bytes(hash);
                    made_up = Some(*value);
                }
                if let Entry::Root { beacon, .. } = &mut forged[place + 1] {
                    *beacon = made_up;
                }
                "its `signature` does not belong to round"
            }
            6 => {
                // The value belongs to a different round of the network, which suits the publisher.
                let place = one_of(&beacons, &mut chance);
                let other = Network::new().round(100_000 + chance.below(1_000_000) as u64);
                if let Entry::Beacon { value, proof, .. } = &mut forged[place] {
                    (*value, *proof) = (other.value, other.proof);
                }
                if let Entry::Root { beacon, .. } = &mut forged[place + 1] {
                    *beacon = Some(other.value);
                }
                "its `signature` does not belong to round"
            }
            _ => {
                // The value never came.
                forged.remove(one_of(&beacons, &mut chance));
                "whose value is not in the log"
            }
        };
        broken(&forged, words);
    }
}

#[test]
fn choosing_among_a_hundred_secrets_is_told() {
    let entries = year();
    let commitments = at(&entries, |entry| matches!(entry, Entry::Commitment { .. }));
    for number in 0..mutations() {
        let mut chance = chance("secrets", number);
        let place = one_of(&commitments, &mut chance);
        let Entry::Commitment { release, beacon, parent, .. } = entries[place].clone() else {
            panic!("chosen")
        };
        let mut forged = entries.clone();
        match number % 3 {
            // A hundred commitments under one name.
            0 => {
                for _ in 0..99 {
                    let (commitment, recipe) = (any_digest(&mut chance), any_digest(&mut chance));
                    let (release, beacon) = (release.clone(), beacon.clone());
                    forged
                        .insert(place + 1, Entry::Commitment { release, commitment, recipe, parent, beacon });
                }
                broken(&forged, "and a publisher may commit only once");
            }
            // A hundred names with one round, of which the publisher keeps the preferred one.
            1 => {
                for other in 0..99 {
                    let (commitment, recipe) = (any_digest(&mut chance), any_digest(&mut chance));
                    let (release, beacon) = (format!("{release}-{other}"), beacon.clone());
                    forged
                        .insert(place + 1, Entry::Commitment { release, commitment, recipe, parent, beacon });
                }
                broken(&forged, "as another commitment does: one of the two could be chosen");
                assert_eq!(unkept(&forged).len(), 99);
            }
            // The secret is chosen afterwards.
            _ => {
                if let Some(Entry::Reveal(revealed)) = forged.get_mut(place + 3) {
                    revealed.seed = format!("better {number}");
                }
                broken(&forged, "does not match the commitment");
            }
        }
    }
}

#[test]
fn rollbacks_and_freezes_are_told() {
    let publisher = Publisher::new();
    let entries = year();
    let (_home, newest) = publisher.forge(&entries);
    for number in 0..mutations() {
        let mut chance = chance("rollback", number);
        let length = 1 + chance.below(entries.len() - 1);
        let (_home, old) = publisher.forge(&entries[..length]);
        assert_eq!(old.faults(&publisher.secret.public()), [""; 0]);
        let said = old.fork(&newest.checkpoint).unwrap();
        assert!(said.contains("the log was rolled back"), "{said}");
        // A copy that is no longer updated lacks the months after its newest, regardless of its other entries.
        let is_root = |entry: &&Entry| matches!(entry, Entry::Root { .. });
        let minted = old.entries().unwrap().iter().filter(is_root).count();
        let mut copy = entries[..length].to_vec();
        for name in ["starter", "2028", "2028-13", "2028-1", "2028-001"] {
            let (release, root) = (name.to_owned(), digest(name));
            let [parent, commitment, beacon, statement] = [None; 4];
            copy.push(Entry::Root { release, root, parent, commitment, beacon, statement });
        }
        for (month, number) in months().iter().zip(1..) {
            assert_eq!(frozen(&copy, month).is_some(), number > minted, "{month} of {length} entries");
        }
    }
}

/// A publisher rewrites an entry, such as the row of a result, and signs the log again.
#[test]
fn forks_are_told() {
    let publisher = Publisher::new();
    let entries = year();
    let (_home, honest) = publisher.forge(&entries);
    for number in 0..mutations() {
        let mut chance = chance("fork", number);
        let mut forged = entries.clone();
        let place = chance.below(entries.len());
        match &mut forged[place] {
            Entry::Result(row) => row.wins += 1,
            Entry::Keys { digest, .. } | Entry::Calibration { file: digest, .. } => {
                *digest = any_digest(&mut chance)
            }
            Entry::Commitment { commitment, .. } => *commitment = any_digest(&mut chance),
            Entry::Beacon { value, .. } => *value = any_digest(&mut chance),
            Entry::Root { root, .. } => *root = any_digest(&mut chance),
            Entry::Reveal(revealed) => revealed.seed.push('x'),
        }
        let (_home, fork) = publisher.forge(&forged);
        let said = fork.fork(&honest.checkpoint).unwrap();
        assert!(said.contains("the log has forked"), "{said}");
        // A proof of growth cannot be made either, because a proof of a different log does not fit.
        let old = 1 + place as u64;
        let (_home, short) = publisher.forge(&entries[..old as usize]);
        let proof = fork.prove_growth(old).unwrap();
        assert!(proof.check(&short.checkpoint, &publisher.secret.public()).is_err());
    }
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.is_dir() {
            true => found.extend(files(&path)),
            false if path.file_name().is_some_and(|name| name != ".lock") => found.push(path),
            false => {}
        }
    }
    found.sort();
    found
}

/// Somebody without the key alters, cuts or removes files.
#[test]
fn altered_and_truncated_files_are_told() {
    let publisher = Publisher::new();
    let entries = year();
    let (home, _) = publisher.forge(&entries);
    let all = files(home.path());
    assert_eq!(all.len(), 3, "{all:?}");
    for number in 0..mutations() {
        let mut chance = chance("files", number);
        let path = &all[chance.below(all.len())];
        let bytes = fs::read(path).unwrap();
        let place = chance.below(bytes.len());
        match number % 4 {
            0 => {
                let mut altered = bytes.clone();
                altered[place] ^= 1 << chance.below(8);
                fs::write(path, altered).unwrap();
            }
            1 => fs::write(path, &bytes[..place]).unwrap(),
            2 => fs::remove_file(path).unwrap(),
            _ => {
                fs::remove_file(path).unwrap();
                fs::create_dir(path).unwrap();
            }
        }
        let is_sound = match Log::open(home.path()) {
            Ok(Some(log)) => log.faults(&publisher.secret.public()).is_empty(),
            // The error is a statement about the log, and not a failure of the disk.
            Err(error) => !matches!(error, TrustError::Document { .. }),
            Ok(None) => false,
        };
        assert!(!is_sound, "{}: byte {place}", path.display());
        if path.is_dir() {
            fs::remove_dir(path).unwrap();
        }
        fs::write(path, &bytes).unwrap();
    }
    assert_eq!(read(home.path()).faults(&publisher.secret.public()), [""; 0]);
}

/// A lost or stolen key cannot continue the log, nor a history of keys with a gap.
#[test]
fn other_keys_are_told() {
    let (publisher, thief) = (Publisher::new(), Publisher::new());
    let entries = year();
    let (_home, log) = thief.forge(&entries);
    let said = log.faults(&publisher.secret.public()).join("\n");
    assert!(said.contains("is not signed by the key"), "{said}");
    for number in 0..mutations() {
        let mut chance = chance("keys", number);
        let mut forged = entries.clone();
        forged.push(match number % 2 {
            0 => Entry::Keys {
                version: 4 + chance.below(9) as u32,
                digest: any_digest(&mut chance),
                previous: Some(digest("keys 2")),
            },
            _ => Entry::Keys {
                version: 3,
                digest: any_digest(&mut chance),
                previous: Some(any_digest(&mut chance)),
            },
        });
        broken(&forged, "does not follow the previous set in the log");
    }
}

/// If the logs give different numbers than a result row, every improved number is reported.
#[test]
fn altered_rows_are_told() {
    let entries = year();
    let row = entries.iter().find_map(|entry| match entry {
        Entry::Result(row) => Some(row.clone()),
        _ => None,
    });
    let honest = row.unwrap();
    assert_eq!(honest.differences(&honest), [""; 0]);
    // The last bits of a logarithm may differ between machines.
    let rounded = ResultRow { interval: (honest.interval.0 + 1e-13, honest.interval.1), ..honest.clone() };
    assert_eq!(honest.differences(&rounded), [""; 0]);
    for number in 0..mutations() {
        let mut chance = chance("rows", number);
        let mut better = honest.clone();
        let by = 1 + chance.below(100);
        let share = by as f64 / 1000.0;
        let key = match number % 10 {
            0 => (better.wins += by as u64, "`wins`").1,
            1 => (better.episodes -= by as u64, "`episodes`").1,
            2 => (better.rate += share, "`rate`").1,
            3 => (better.interval.0 += share, "`interval.low`").1,
            4 => (better.interval.1 += share, "`interval.high`").1,
            5 => (better.score = Some(3.5 + share), "`score`").1,
            6 => (better.score = None, "`score`").1,
            7 => (better.player = format!("mcts:{by}1"), "`player`").1,
            8 => (better.horizon = format!("{by}0"), "`horizon`").1,
            _ => (better.track = None, "`track`").1,
        };
        let found = better.differences(&honest);
        assert!(found.len() == 1 && found[0].starts_with(key), "{key}: {found:?}");
    }
}

/// Anyone who prepares the folder of a log can replace its lock by a link.
#[cfg(unix)]
#[test]
fn a_linked_lock_empties_nothing() {
    let home = tempfile::tempdir().unwrap();
    let (victim, folder) = (home.path().join("victim"), home.path().join("log"));
    fs::write(&victim, "precious").unwrap();
    fs::create_dir(&folder).unwrap();
    std::os::unix::fs::symlink(&victim, folder.join(".lock")).unwrap();
    assert!(Publisher::new().append(&folder, &year()[..1]).is_err());
    assert_eq!(fs::read_to_string(&victim).unwrap(), "precious");
}

/// Readers of earlier states still read the partial tiles of those states.
#[test]
fn damaged_tiles_of_earlier_states_are_faults() {
    let home = tempfile::tempdir().unwrap();
    let publisher = Publisher::new();
    let entries = year();
    publisher.append(home.path(), &entries[..2]).unwrap();
    let log = publisher.append(home.path(), &entries[2..4]).unwrap();
    for tile in ["tile/0/000.p/2", "tile/entries/000.p/2"] {
        let path = home.path().join(tile);
        let whole = fs::read(&path).unwrap();
        fs::write(&path, &whole[..3]).unwrap();
        let faults = log.faults(&publisher.secret.public());
        assert!(faults.len() == 1 && faults[0].starts_with(tile), "{faults:?}");
        fs::write(&path, whole).unwrap();
    }
    assert_eq!(log.faults(&publisher.secret.public()), [""; 0]);
}
