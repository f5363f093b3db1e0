//! Attacks on a log's folder, and on readers of earlier states.

use super::*;

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
        // A copy that is no longer updated lacks all months after its newest month, whatever other entries it
        // has.
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
        // A growth proof cannot be made either, because a proof from a different log does not fit.
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

/// An attacker without the key alters, truncates or removes files.
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
            // The error must be a statement about the log, not a disk failure.
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

/// Anyone who prepares a log's folder can replace its lock with a link.
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

/// Readers of earlier states still read the partial tiles from those states.
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
