//! Tests of a log that covers a year, and of attacks on it. Each attack is tried in many ways: 1,000 in a
//! sweep (`cargo xtask sweep`).

mod entries;
mod folders;

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

/// Returns the number of ways in which to try an attack.
fn mutations() -> u64 {
    if std::env::var_os("ARCADE_SWEEP").is_some() { 1000 } else { 20 }
}

/// Returns the sampler for one mutation. Its seed includes the value of `ARCADE_SWEEP`, so each sweep can
/// differ.
fn chance(purpose: &str, number: u64) -> Sampler {
    let sweep = std::env::var_os("ARCADE_SWEEP").and_then(|text| text.into_string().ok());
    Seed::from_text(&format!("{purpose} {}", sweep.unwrap_or_default())).child("mutation", number).sampler()
}

fn digest(text: &str) -> Digest {
    Digest::of(text.as_bytes())
}

/// Computes the commitment with a formula used only in these tests. The formula for releases is in
/// `snapshots`.
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

/// A drand-like network whose secret key the tests have.
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

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Returns a publisher's log entries for a year. Each month is committed to, waits for its beacon, and is
/// then minted, revealed, calibrated and played.
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
    // The entries are appended in steps, as they would be over a year.
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

/// If the power fails at any moment while a month is appended, the log is either the old one or the new one.
/// Appending again yields the same bytes as without the failure.
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

/// Checks that the entries break a rule, and that the message contains these words.
#[track_caller]
fn broken(entries: &[Entry], words: &str) {
    let found = rules(entries);
    assert!(found.iter().any(|problem| problem.contains(words)), "no `{words}` in {found:?}");
}

fn any_digest(chance: &mut Sampler) -> Digest {
    digest(&chance.bits().to_string())
}

/// Neither a lost or stolen key nor a key history with a gap can continue the log.
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
