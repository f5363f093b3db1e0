//! Tests of signed roots. They cover thresholds, rotation and revocation, altered files, and power failures.

use base::Digest;
use disk::Disk;
use infinite_arcade_trust::{
    Anchor, KeySet, KeysInForce, NamedKey, NewKey, Provenance, SecretKey, Signatures, Signed, Statement,
    generate, sign_into,
};
use std::fs;
use std::path::Path;

struct Holder {
    name: &'static str,
    new: NewKey,
}

impl Holder {
    fn new(name: &'static str) -> Holder {
        Holder { name, new: generate(None).unwrap() }
    }

    fn named(&self) -> NamedKey {
        NamedKey { name: self.name.to_owned(), key: self.new.public.to_base64() }
    }

    fn secret(&self) -> SecretKey {
        SecretKey::open(&self.new.secret_file, None).unwrap()
    }
}

fn root() -> Digest {
    Digest::of(b"root")
}

fn statement(set: Option<&KeySet>) -> Statement {
    let keys = set.map(|set| KeysInForce { version: set.version, digest: set.digest().unwrap() });
    let provenance = Provenance {
        version: Some("0.13.0".to_owned()),
        generation: 13,
        semantics: 3,
        lockfile: Digest::of(b"lock"),
        commit: Some("0123456789abcdef0123456789abcdef01234567".to_owned()),
    };
    Statement::new("2027-01".to_owned(), root(), keys, provenance)
}

fn sign(folder: &Path, set: Option<&KeySet>, holders: &[&Holder]) {
    let statement = statement(set);
    let secrets: Vec<SecretKey> = holders.iter().map(|holder| holder.secret()).collect();
    let (file, bytes) = (statement.file().unwrap(), statement.to_bytes().unwrap());
    sign_into(folder, &file, &bytes, &statement.comment(), &secrets, &Disk::new()).unwrap();
}

fn publish(folder: &Path, set: &KeySet, holders: &[&Holder]) {
    let secrets: Vec<SecretKey> = holders.iter().map(|holder| holder.secret()).collect();
    sign_into(folder, &set.file(), &set.to_bytes().unwrap(), "keys", &secrets, &Disk::new()).unwrap();
}

fn judge(folder: &Path, anchor: &Anchor) -> Signed {
    Signatures::read(folder).unwrap().judge("2027-01", &root(), anchor)
}

#[track_caller]
fn refused(folder: &Path, anchor: &Anchor, words: &str) {
    let said = judge(folder, anchor).problems.join("\n");
    assert!(said.contains(words), "{said}");
}

fn set_anchor(set: &KeySet) -> Anchor {
    Anchor::Set(Box::new(set.clone()))
}

#[test]
fn one_key_signs_one_root() {
    let home = tempfile::tempdir().unwrap();
    let (ada, eve) = (Holder::new("ada"), Holder::new("eve"));
    sign(home.path(), None, &[&ada]);
    let signed = judge(home.path(), &Anchor::Key(ada.new.public.clone()));
    assert_eq!((signed.problems.as_slice(), signed.signers.len()), (&[] as &[String], 1));
    assert_eq!(signed.commit.unwrap().len(), 40);
    refused(home.path(), &Anchor::Key(eve.new.public.clone()), "not signed by the key ");
    let found = Signatures::read(home.path()).unwrap();
    let other = found.judge("2027-01", &Digest::of(b"other"), &Anchor::Key(ada.new.public.clone()));
    assert!(other.problems[0].contains("no signed statement says that `2027-01` has the root"), "{other:?}");
    let renamed = found.judge("2027-02", &root(), &Anchor::Key(ada.new.public.clone()));
    assert!(
        renamed.problems[1].contains("the statement is about a different release, `2027-01`"),
        "{renamed:?}"
    );
    // For a reader who trusts a set, the statement must name a set, because a lone signature may be older
    // than a revocation.
    let set = KeySet::next(None, Some(1), vec![ada.named()], &[]).unwrap();
    refused(home.path(), &set_anchor(&set), "does not specify a set of keys");
}

#[test]
fn two_of_three_keys_sign() {
    let home = tempfile::tempdir().unwrap();
    let [ada, bo, cy, eve] = ["ada", "bo", "cy", "eve"].map(Holder::new);
    let set = KeySet::next(None, Some(2), vec![ada.named(), bo.named(), cy.named()], &[]).unwrap();
    let anchor = set_anchor(&set);
    publish(home.path(), &set, &[]);
    sign(home.path(), Some(&set), &[&ada]);
    refused(home.path(), &anchor, "signed by ada, but 2 of ada, bo, cy must sign");
    // Two signatures with the same key count once, and the signature of an unknown key does not count.
    sign(home.path(), Some(&set), &[&ada, &eve]);
    refused(home.path(), &anchor, "signed by ada, but 2 of");
    // The second holder signs on a different machine, which adds a signature file.
    sign(home.path(), Some(&set), &[&cy]);
    let signed = judge(home.path(), &anchor);
    assert_eq!(signed.problems, [""; 0]);
    assert_eq!(
        (signed.signers, signed.threshold, signed.keys),
        (vec!["ada".into(), "cy".into()], 2, Some(1))
    );
}

/// Checks that the other two holders can replace a lost key, whose signatures then no longer count.
#[test]
fn a_lost_key_is_revoked_and_replaced() {
    let home = tempfile::tempdir().unwrap();
    let [ada, bo, cy, di] = ["ada", "bo", "cy", "di"].map(Holder::new);
    let first = KeySet::next(None, Some(2), vec![ada.named(), bo.named(), cy.named()], &[]).unwrap();
    publish(home.path(), &first, &[]);
    sign(home.path(), Some(&first), &[&ada, &bo]);
    assert_eq!(judge(home.path(), &set_anchor(&first)).problems, [""; 0]);

    let lost = [("bo".to_owned(), "lost".to_owned())];
    let second = KeySet::next(Some(&first), None, vec![di.named()], &lost).unwrap();
    // One signature does not suffice for the new set, so the new set is not trusted, and neither is any later
    // set.
    publish(home.path(), &second, &[&ada, &di]);
    refused(
        home.path(),
        &set_anchor(&first),
        "keys-2.json: signed by ada of the previous set, but 2 must sign",
    );
    publish(home.path(), &second, &[&cy]);
    refused(
        home.path(),
        &set_anchor(&first),
        "signed by ada, but 2 of ada, bo, cy must sign; the key of `bo` is revoked: lost",
    );
    refused(home.path(), &set_anchor(&second), "the key of `bo` is revoked: lost");
    refused(home.path(), &Anchor::Key(bo.new.public.clone()), "the key of `bo` is revoked: lost");
    // After the release is signed again under the new set, it is accepted by readers who trust either set.
    sign(home.path(), Some(&second), &[&cy, &di]);
    for anchor in [&first, &second] {
        let signed = judge(home.path(), &set_anchor(anchor));
        assert_eq!((signed.problems.as_slice(), signed.keys), (&[] as &[String], Some(2)));
    }
    // A revoked key remains revoked in later sets.
    let third =
        KeySet { revoked: Vec::new(), version: 3, previous: Some(second.digest().unwrap()), ..second };
    publish(home.path(), &third, &[&ada, &cy, &di]);
    refused(home.path(), &set_anchor(&first), "the revoked key of `bo` is no longer revoked");
}

/// The holder of one key cannot return to an earlier set for which one key sufficed.
#[test]
fn earlier_thresholds_count_no_longer() {
    let home = tempfile::tempdir().unwrap();
    let [ada, bo] = ["ada", "bo"].map(Holder::new);
    let first = KeySet::next(None, Some(1), vec![ada.named(), bo.named()], &[]).unwrap();
    let second = KeySet::next(Some(&first), Some(2), Vec::new(), &[]).unwrap();
    publish(home.path(), &first, &[]);
    sign(home.path(), Some(&first), &[&ada]);
    assert_eq!(judge(home.path(), &set_anchor(&first)).problems, [""; 0]);
    publish(home.path(), &second, &[&ada, &bo]);
    for anchor in [&first, &second] {
        refused(
            home.path(),
            &set_anchor(anchor),
            "signed by ada of the newest set of keys (2), but 2 must sign",
        );
    }
    // An earlier statement is valid if sufficiently many of the current keys have signed it.
    sign(home.path(), Some(&first), &[&bo]);
    assert_eq!(judge(home.path(), &set_anchor(&first)).problems, [""; 0]);
}

#[test]
fn another_history_of_keys_is_refused() {
    let home = tempfile::tempdir().unwrap();
    let [ada, eve] = ["ada", "eve"].map(Holder::new);
    let first = KeySet::next(None, None, vec![ada.named()], &[]).unwrap();
    let forged = KeySet::next(None, None, vec![eve.named()], &[]).unwrap();
    publish(home.path(), &forged, &[&eve]);
    sign(home.path(), Some(&forged), &[&eve]);
    assert_eq!(judge(home.path(), &set_anchor(&forged)).problems, [""; 0]);
    refused(home.path(), &set_anchor(&first), "which is not connected to the set that you trust");
    // A forged set claims to follow the genuine one.
    fs::remove_file(home.path().join("keys-1.json")).unwrap();
    let next = KeySet::next(Some(&first), None, vec![eve.named()], &[]).unwrap();
    publish(home.path(), &next, &[&eve]);
    refused(home.path(), &set_anchor(&first), "keys-2.json: signed by none of the previous set");
}

#[test]
fn sets_that_cannot_be_are_refused() {
    let ada = Holder::new("ada");
    let refuse = |threshold, names: &[&str], revoke: &str, words: &str| {
        let keys = names.iter().map(|name| NamedKey { name: (*name).to_owned(), ..ada.named() }).collect();
        let revoke: Vec<_> =
            Some((revoke.to_owned(), "lost".to_owned())).into_iter().filter(|r| !r.0.is_empty()).collect();
        let error = KeySet::next(None, Some(threshold), keys, &revoke).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    };
    refuse(1, &[], "", "its threshold is 1, but it has 0 keys");
    refuse(2, &["ada"], "", "choose a threshold from 1 to 1");
    refuse(0, &["ada"], "", "its threshold is 0");
    refuse(1, &["ada", "ada"], "", "two keys have the name `ada`");
    refuse(1, &["ada", "bo"], "", "the key of `bo` occurs twice");
    refuse(1, &["Ada"], "", "must consist of 1 to 40 lower-case letters");
    refuse(1, &["ada"], "bo", "the set has no key `bo`");
}

/// If the power fails while two keys sign, the release is either signed or unsigned, and signing again
/// completes it.
#[test]
fn a_loss_of_power_leaves_nothing_half_signed() {
    let [ada, bo] = ["ada", "bo"].map(Holder::new);
    let set = KeySet::next(None, Some(2), vec![ada.named(), bo.named()], &[]).unwrap();
    let statement = statement(Some(&set));
    let (file, bytes) = (statement.file().unwrap(), statement.to_bytes().unwrap());
    let secrets = [ada.secret(), bo.secret()];
    let mut signed = Vec::new();
    for steps in 0.. {
        let home = tempfile::tempdir().unwrap();
        publish(home.path(), &set, &[]);
        let cut = Disk::losing_power_after(steps);
        let written = sign_into(home.path(), &file, &bytes, "", &secrets, &cut);
        let found = judge(home.path(), &set_anchor(&set));
        let is_there = home.path().join(&file).exists();
        assert_eq!(found.problems.is_empty(), is_there, "{found:?} after {steps} steps");
        signed.push(is_there);
        sign_into(home.path(), &file, &bytes, "", &secrets, &Disk::new()).unwrap();
        assert_eq!(judge(home.path(), &set_anchor(&set)).problems, [""; 0]);
        if written.is_ok() {
            break;
        }
    }
    assert!(signed.is_sorted() && signed.len() > 12, "{signed:?}");
}

/// A signed statement, a set or a signature with an altered byte is rejected. The first line of a signature
/// is an exception, because it is a comment that no signature covers.
#[test]
fn altered_files_are_refused() {
    let home = tempfile::tempdir().unwrap();
    let [ada, bo] = ["ada", "bo"].map(Holder::new);
    let first = KeySet::next(None, Some(1), vec![ada.named()], &[]).unwrap();
    let second =
        KeySet::next(Some(&first), Some(1), vec![bo.named()], &[("ada".into(), "lost".into())]).unwrap();
    publish(home.path(), &second, &[&ada, &bo]);
    sign(home.path(), Some(&second), &[&bo]);
    let anchor = set_anchor(&first);
    assert_eq!(judge(home.path(), &anchor).problems, [""; 0]);
    let sweeping = std::env::var_os("ARCADE_SWEEP").is_some();
    let mut altered = 0;
    for entry in fs::read_dir(home.path()).unwrap() {
        let path = entry.unwrap().path();
        let bytes = fs::read(&path).unwrap();
        let start = match path.extension().is_some_and(|end| end == "minisig") {
            true => bytes.iter().position(|byte| *byte == b'\n').unwrap() + 1,
            false => 0,
        };
        for at in (start..bytes.len()).step_by(if sweeping { 1 } else { 13 }) {
            let mut copy = bytes.clone();
            copy[at] ^= 1 << (at % 7);
            fs::write(&path, &copy).unwrap();
            // The line feed at the end of a signature is not significant.
            let is_end = at + 1 == bytes.len() && start > 0;
            let found = judge(home.path(), &anchor);
            assert!(is_end || !found.problems.is_empty(), "{}: byte {at}", path.display());
            altered += 1;
        }
        fs::write(&path, &bytes).unwrap();
    }
    assert!(altered > 80, "{altered}");
    assert_eq!(judge(home.path(), &anchor).problems, [""; 0]);
}
