//! Tests of archives: the same release gives identical bytes, and no other bytes are accepted.

use super::small::{Small, home, small};
use snapshots::archive::{Archive, pack};
use snapshots::{Draft, MANIFEST_FILE, SnapshotError, check_integrity, verify};
use std::fs;
use std::io::Write;
use std::path::Path;
use tar::{Builder, EntryType, Header};

/// A release's archive entries, which can be altered before they are packed by hand.
struct Entries {
    name: String,
    list: Vec<(Header, Vec<u8>)>,
}

fn header(path: &str, size: u64) -> Header {
    let mut header = Header::new_ustar();
    header.set_path(path).expect("short");
    header.set_size(size);
    header.set_mode(0o644);
    header.set_uid(0);
    header.set_gid(0);
    header.set_mtime(0);
    header.set_entry_type(EntryType::Regular);
    header.set_cksum();
    header
}

impl Entries {
    fn of(release: &Small) -> Entries {
        let name = release.manifest.name.clone();
        let mut list = Vec::new();
        let manifest = (MANIFEST_FILE.to_owned(), release.manifest.to_bytes().expect("sound"));
        let mut files = release.files.clone();
        files.sort();
        for (path, content) in [manifest].into_iter().chain(files) {
            list.push((header(&format!("{name}/{path}"), content.len() as u64), content));
        }
        Entries { name, list }
    }

    fn add(&mut self, place: usize, path: &str, content: &[u8]) {
        let path = format!("{}/{path}", self.name);
        self.list.insert(place, (header(&path, content.len() as u64), content.to_vec()));
    }

    fn tar(&self) -> Vec<u8> {
        let mut builder = Builder::new(Vec::new());
        for (header, content) in &self.list {
            let mut header = header.clone();
            header.set_cksum();
            builder.append(&header, content.as_slice()).expect("in memory");
        }
        builder.into_inner().expect("in memory")
    }
}

/// Compresses and seals bytes as archives do.
pub(crate) fn compress(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = zstd::Encoder::new(Vec::new(), 3).expect("in memory");
    encoder.window_log(23).expect("legal");
    encoder.include_checksum(true).expect("legal");
    encoder.include_contentsize(true).expect("legal");
    encoder.set_pledged_src_size(Some(bytes.len() as u64)).expect("legal");
    encoder.write_all(bytes).expect("in memory");
    seal(&encoder.finish().expect("in memory"))
}

/// Appends the frame that detects accidental damage.
fn seal(compressed: &[u8]) -> Vec<u8> {
    let digest = base::Digest::of(compressed);
    [compressed, &[0x50, 0x2a, 0x4d, 0x18, 32, 0, 0, 0], digest.as_bytes()].concat()
}

#[test]
fn packing_round_trips() {
    let home = home();
    let release = small("mole", None);
    let folder = release.write_in(&home);
    let file = home.path().join("mole.tar.zst");
    let packed = pack(&folder, &file).expect("packed");
    assert_eq!(packed.root, release.manifest.root);
    assert_eq!(packed.size, fs::metadata(&file).expect("there").len());
    let archive = Archive::open(&file).expect("sound");
    assert!(archive.integrity.is_sound());
    assert_eq!((archive.digest, archive.unpacked), (packed.digest, packed.unpacked));
    archive.unpack(&home.path().join("again")).expect("unpacked");
    let again = check_integrity(&home.path().join("again")).expect("readable");
    assert!(again.is_sound() && again.manifest == release.manifest);
    let verification = verify(&file).expect("readable");
    assert!(verification.problems.is_empty(), "{:?}", verification.problems);
    assert_eq!(verification.witnesses, snapshots::Witnesses::Replayed(1));

    // The folder's times and modes do not matter, so a second archive has the same bytes.
    let other = home.path().join("other");
    release.write(&other);
    let second = pack(&other, &home.path().join("second.tar.zst")).expect("packed");
    assert_eq!(second, packed);
    assert_eq!(fs::read(&file).expect("there"), fs::read(home.path().join("second.tar.zst")).expect("there"));
    // The zstd frame contains the tar archive described in the documentation of the format.
    let mut tar = Vec::new();
    zstd::stream::copy_decode(fs::File::open(&file).expect("there"), &mut tar).expect("zstd");
    assert_eq!(tar, Entries::of(&release).tar());
    assert_eq!(base::Digest::of(&tar), packed.digest);
}

/// The digest of a fixed release's archive changes only with the format.
#[test]
fn packing_is_fixed() {
    let home = home();
    let folder = super::old::unpacked("format-1", &home);
    let packed = pack(&folder, &home.path().join("a.tar.zst")).expect("packed");
    assert_eq!(packed.digest.to_string(), super::old::FORMAT_1_ARCHIVE);
}

#[test]
fn packing_is_careful() {
    let home = home();
    let release = small("mole", None);
    let folder = release.write_in(&home);
    let file = home.path().join("mole.tar.zst");
    fs::write(&file, "mine").expect("written");
    assert!(matches!(pack(&folder, &file), Err(SnapshotError::Taken(_))));
    assert_eq!(fs::read(&file).expect("there"), b"mine");
    fs::remove_file(&file).expect("removed");
    // Only a killed run's leftovers are replaced. An empty file is not, and neither is a file that begins
    // like an archive.
    let partial = home.path().join("mole.tar.zst.partial");
    for mine in [&b"mine"[..], b"", &[&b"\x28\xb5\x2f\xfd"[..], &[7; 100_000]].concat()] {
        fs::write(&partial, mine).expect("written");
        assert!(matches!(pack(&folder, &file), Err(SnapshotError::Foreign(_))));
        assert_eq!(fs::read(&partial).expect("there"), mine);
    }
    fs::remove_file(&partial).expect("removed");
    drop(Draft::create(&file).expect("vacant"));
    pack(&folder, &file).expect("packed");
    assert!(Archive::open(&file).expect("sound").integrity.is_sound());
    assert!(!partial.exists());
    fs::write(folder.join("README.md"), "other").expect("written");
    let error = pack(&folder, &home.path().join("b.tar.zst")).expect_err("altered").to_string();
    assert!(error.contains("README.md: wrong size"), "{error}");
    assert!(!home.path().join("b.tar.zst").exists());
}

/// An alteration of a list of entries.
type Change<'a> = &'a dyn Fn(&mut Entries);

#[track_caller]
fn check(change: Change, names: &str, what: &str) {
    let home = home();
    let mut entries = Entries::of(&small("mole", None));
    change(&mut entries);
    check_bytes(&home.path().join("mole.tar.zst"), &compress(&entries.tar()), names, what);
}

#[track_caller]
fn check_bytes(file: &Path, bytes: &[u8], names: &str, what: &str) {
    fs::write(file, bytes).expect("written");
    let said = match verify(file) {
        Ok(verification) => verification.problems.join("\n"),
        Err(error) => error.to_string(),
    };
    assert!(said.contains(names) && said.contains(what), "expected `{names}` and `{what}`: {said}");
}

#[test]
fn entries_that_no_release_has() {
    let level = "games/mole-";
    // The entries are the manifest, the release's card, README, card, game, level and witness.
    check(&|e| drop(e.list.remove(5)), "witness/lvl0.json", "out of order");
    check(&|e| drop(e.list.remove(6)), level, "witness/lvl0.json: missing");
    check(&|e| e.list.truncate(1), "CARD.json", "missing");
    check(&|e| e.list.clear(), "MANIFEST.json", "");
    check(
        &|e| e.list.swap(0, 1),
        "MANIFEST.json",
        "the manifest must come first, but the first entry is `mole/CARD.json`",
    );
    check(&|e| e.list.swap(3, 4), "game.vgdl", "out of order");
    check(&|e| e.add(3, "README.md", b"other"), "README.md", "the entry occurs twice in the archive");
    check(&|e| e.add(7, "README.md", b"other"), "README.md", "the entry occurs twice in the archive");
    check(&|e| e.add(7, MANIFEST_FILE, b"other"), MANIFEST_FILE, "the entry occurs twice in the archive");
    check(&|e| e.add(7, "games/x", b"other"), "games/x", "extra");
    check(&|e| e.add(1, "A", b"other"), "A", "extra");
    check(&|e| e.list[2].1.push(b'x'), "README.md", "");
    check(&|e| e.list[2].1[3] ^= 1, "README.md", "altered");
    check(
        &|e| {
            let (header, content) = &mut e.list[2];
            content.push(b'x');
            header.set_size(content.len() as u64);
        },
        "README.md",
        "wrong size",
    );
}

#[test]
fn headers_that_no_release_has() {
    check(&|e| e.list[2].0.set_mode(0o755), "README.md", "an unexpected owner, mode");
    check(&|e| e.list[2].0.set_uid(1000), "README.md", "an unexpected owner");
    check(&|e| e.list[2].0.set_gid(1000), "README.md", "an unexpected owner");
    check(&|e| e.list[2].0.set_mtime(1), "README.md", "an unexpected owner");
    check(&|e| e.list[2].0.set_username("me").expect("short"), "README.md", "an unexpected owner");
    check(&|e| e.list[2].0.set_device_major(1).expect("ustar"), "README.md", "an unexpected owner");
    check(&|e| e.list[0].0.set_mode(0o600), "MANIFEST.json", "an unexpected owner");
    let kind = |kind: EntryType| move |e: &mut Entries| e.list[2].0.set_entry_type(kind);
    check(&kind(EntryType::Symlink), "README.md", "symbolic link");
    check(&kind(EntryType::Link), "README.md", "hard link");
    check(&kind(EntryType::Char), "README.md", "neither a file nor a folder");
    check(&kind(EntryType::Block), "README.md", "neither a file nor a folder");
    check(&kind(EntryType::Fifo), "README.md", "neither a file nor a folder");
    check(&kind(EntryType::Directory), "README.md", "a folder");
    check(&kind(EntryType::GNUSparse), "README.md", "sparse");
    check(&kind(EntryType::Continuous), "README.md", "contiguous");
    check(&kind(EntryType::XHeader), "README.md", "pax");
    check(&kind(EntryType::XGlobalHeader), "README.md", "pax");
    check(&kind(EntryType::GNULongName), "README.md", "long names");
    check(&kind(EntryType::new(b'Z')), "README.md", "unknown kind 0x5a");
    check(
        &|e| {
            e.list[2].0.set_entry_type(EntryType::Symlink);
            e.list[2].0.set_link_name("../../etc/passwd").expect("short");
        },
        "README.md",
        "symbolic link",
    );
    let kind = |kind: EntryType| move |e: &mut Entries| e.list[0].0.set_entry_type(kind);
    check(&kind(EntryType::Symlink), "MANIFEST.json", "symbolic link");
    check(&kind(EntryType::XGlobalHeader), "MANIFEST.json", "pax");
}

/// Names are written into the header verbatim, because the `tar` crate would reject some of them.
#[test]
fn names_that_lead_elsewhere() {
    let name = |path: &'static str| {
        move |e: &mut Entries| {
            let field = &mut e.list[2].0.as_ustar_mut().expect("ustar").name;
            *field = [0; 100];
            field[..path.len()].copy_from_slice(path.as_bytes());
        }
    };
    check(&name("mole/../../etc/passwd"), "../../etc/passwd", "unsafe name");
    check(&name("/etc/passwd"), "/etc/passwd", "absolute");
    check(&name("mole/a\u{1b}b"), "a\\u{1b}b", "unsafe name");
    check(&name("other/README.md"), "other/README.md", "not in the folder `mole`");
    check(&name("mole//README.md"), "/README.md", "absolute");
    check(&name("./mole/README.md"), "README.md", "unsafe name");
    check(&name("README.md"), "README.md", "not in the folder");
    let top = |path: &'static str| {
        move |e: &mut Entries| {
            let field = &mut e.list[0].0.as_ustar_mut().expect("ustar").name;
            *field = [0; 100];
            field[..path.len()].copy_from_slice(path.as_bytes());
        }
    };
    check(&top("../MANIFEST.json"), "MANIFEST.json", "must come first");
    check(&top("/MANIFEST.json"), "MANIFEST.json", "must come first");
    check(&top("MANIFEST.json"), "MANIFEST.json", "must come first");
    check(&top("a/b/MANIFEST.json"), "MANIFEST.json", "must come first");
    check(
        &top("vole/MANIFEST.json"),
        "MANIFEST.json",
        "the folder is called `vole`, but the release is called `mole`",
    );
}

#[test]
fn ends() {
    let home = home();
    let file = home.path().join("mole.tar.zst");
    let tar = Entries::of(&small("mole", None)).tar();
    let sound = compress(&tar);
    check_bytes(&file, &sound, "", "");
    assert!(verify(&file).expect("readable").problems.is_empty());
    check_bytes(
        &file,
        &[&sound[..], b"x"].concat(),
        "mole.tar.zst: different from the packed form",
        "bytes after the seal",
    );
    check_bytes(
        &file,
        &[&sound[..], &sound[..]].concat(),
        "mole.tar.zst: different from the packed form",
        "bytes after the seal",
    );
    let skippable = [0x50, 0x2a, 0x4d, 0x18, 1, 0, 0, 0, 7];
    check_bytes(
        &file,
        &[&sound[..], &skippable[..]].concat(),
        "mole.tar.zst: different from the packed form",
        "bytes after the seal",
    );
    let unsealed = &sound[..sound.len() - 40];
    check_bytes(&file, unsealed, "mole.tar.zst: different from the packed form", "the seal is missing");
    check_bytes(
        &file,
        &seal(&[unsealed, unsealed].concat()),
        "mole.tar.zst: different from the packed form",
        "the seal is missing or damaged",
    );
    check_bytes(
        &file,
        &[unsealed, &seal(b"")].concat(),
        "mole.tar.zst: different from the packed form",
        "do not match the seal",
    );
    check_bytes(
        &file,
        &[&skippable[..], &sound[..]].concat(),
        "mole.tar.zst",
        "does not begin with an archive header",
    );
    check_bytes(
        &file,
        &compress(&[&tar[..], &[0; 512]].concat()),
        "mole.tar.zst: different from the packed form",
        "extra data after the end of the archive",
    );
    check_bytes(
        &file,
        &compress(&tar[..tar.len() - 512]),
        "mole.tar.zst: different from the packed form",
        "the archive is truncated",
    );
    check_bytes(
        &file,
        &compress(&tar[..tar.len() - 1024]),
        "mole.tar.zst: different from the packed form",
        "the archive is truncated",
    );
    let mut padded = tar.clone();
    let last = padded.len() - 1025;
    padded[last] = 1;
    check_bytes(&file, &compress(&padded), "witness/lvl0.json", "not zero");
    for length in 0..sound.len() {
        fs::write(&file, &sound[..length]).expect("written");
        let passed = verify(&file).is_ok_and(|verification| verification.problems.is_empty());
        assert!(!passed, "cut to {length} of {} bytes", sound.len());
    }
    // Different compressions of the same bytes are not accepted.
    let plain = zstd::encode_all(&tar[..], 3).expect("in memory");
    check_bytes(&file, &plain, "mole.tar.zst", "differs from the packed form");
    // A file with an archive's name is a damaged archive; with a different name, it is not an archive.
    fs::write(&file, "BasicGame").expect("written");
    assert!(matches!(verify(&file), Err(SnapshotError::Archive { .. })));
    fs::write(&file, "").expect("written");
    assert!(matches!(verify(&file), Err(SnapshotError::Archive { .. })));
    let file = home.path().join("mole.vgdl");
    fs::write(&file, "BasicGame").expect("written");
    assert!(matches!(verify(&file), Err(SnapshotError::NotASnapshot(_))));
}

/// A small file that claims to have large content is rejected before it is unpacked.
#[test]
fn bombs() {
    let home = home();
    let file = home.path().join("mole.tar.zst");
    let zeros = compress(&vec![0; 64 << 20]);
    assert!(zeros.len() < 16_384);
    check_bytes(&file, &zeros, "mole.tar.zst", "the archive would unpack to 67108864 bytes");
    // One frame states less than it contains, and one states more.
    let tar = Entries::of(&small("mole", None)).tar();
    let sound = compress(&tar);
    let mut lies = sound[..sound.len() - 40].to_vec();
    assert_eq!(lies[4] >> 6, 1, "two bytes of size");
    for size in [0_u16, 300, u16::MAX] {
        lies[5..7].copy_from_slice(&size.to_le_bytes());
        fs::write(&file, seal(&lies)).expect("written");
        assert!(!verify(&file).is_ok_and(|verification| verification.problems.is_empty()), "{size}");
    }
    // An entry claims to be large.
    check(&|e| e.list[0].0.set_size(1 << 40), "MANIFEST.json", "larger than 67108864 bytes");
    check(&|e| e.list[0].0.set_size(1 << 20), "MANIFEST.json", "too short");
    check(&|e| e.list[2].0.set_size(1 << 40), "README.md", "wrong size (1099511627776 bytes");
}

/// Regression test: with a manifest of 99,999 items, each in its own 124 folders, half a megabyte used three
/// gigabytes of memory.
#[test]
fn manifests_of_deep_paths() {
    let honest = small("mole", None);
    let text = String::from_utf8(honest.manifest.to_bytes().expect("sound")).expect("JSON");
    let (start, end) =
        (text.find("\"items\": [").expect("items"), text.find("\n  ],\n  \"kind\"").expect("kind"));
    let digest = base::Digest::of(b"");
    let folders = "/a".repeat(124);
    let item = |n| {
        format!(
            "\n    {{\n      \"digest\": \"{digest}\",\n      \"path\": \"g{n:05}{folders}\",\n      \"size\": 0\n    }}"
        )
    };
    let items: Vec<String> = (0..99_999).map(item).collect();
    let bomb = format!("{}\"items\": [{}{}", &text[..start], items.join(","), &text[end..]).into_bytes();
    drop(items);
    let size = bomb.len() as u64;
    let mut entries = Entries::of(&honest);
    entries.list = vec![(header("mole/MANIFEST.json", size), bomb)];
    let home = home();
    let file = home.path().join("mole.tar.zst");
    fs::write(&file, compress(&entries.tar())).expect("written");
    drop(entries);
    let mut error = None;
    let memory = allocation_counter::measure(|| error = verify(&file).err());
    let error = error.expect("too deep").to_string();
    assert!(error.contains("more than 16 components"), "{error}");
    // The bound allows for the manifest's bytes on arrival, and for one copy of its items.
    assert!(memory.bytes_max < 4 * size, "{memory:?}, for {size} bytes");
}

/// A recipe may be any JSON. The indented form of a deeply nested recipe would be hundreds of times larger,
/// so reading stops early. This recipe is within the compression ratio allowed for archives: 14 MB in about 2
/// kB.
#[test]
fn recipes_that_nest_deeply() {
    let honest = small("mole", None);
    let text = String::from_utf8(honest.manifest.to_bytes().expect("sound")).expect("JSON");
    let nested = format!("{}{}", "[".repeat(120), "]".repeat(120));
    let bomb = format!("\"deep\": [{}],\n    \"seed\": ", vec![nested; 60_000].join(","));
    let bomb = text.replacen("\"seed\": ", &bomb, 1).into_bytes();
    assert!(bomb.len() > 14_000_000);
    let home = home();
    let folder = honest.write_in(&home);
    fs::write(folder.join(MANIFEST_FILE), &bomb).expect("written");
    let mut entries = Entries::of(&honest);
    entries.list[0] = (header("mole/MANIFEST.json", bomb.len() as u64), bomb);
    let file = home.path().join("mole.tar.zst");
    fs::write(&file, compress(&entries.tar())).expect("written");
    for place in [folder, file] {
        let error = verify(&place).expect_err("too deep");
        assert!(error.to_string().contains(MANIFEST_FILE), "{error}");
        let source = std::error::Error::source(&error).expect("a place").to_string();
        assert!(source.contains("the recipe is nested deeper than 16 levels"), "{source}");
    }
}

/// The cost of a wide, flat recipe is proportional to its size, so the recipe is accepted.
#[test]
fn recipes_that_are_wide() {
    let mut wide = small("mole", None);
    wide.manifest.recipe["zeros"] = vec![0; 1_000_000].into();
    wide.manifest.seal_root().expect("distinct paths");
    let home = home();
    let folder = wide.write_in(&home);
    assert!(check_integrity(&folder).expect("readable").is_sound());
    wide.manifest.recipe["zeros"] = vec![0; 2_000_000].into();
    wide.manifest.seal_root().expect("distinct paths");
    let error = wide.manifest.to_bytes().expect_err("too wide").to_string();
    assert!(error.contains("the recipe has more than 1048576 values"), "{error}");
}

#[cfg(unix)]
#[test]
fn non_files_are_not_opened() {
    let home = home();
    let socket = home.path().join("mole.tar.zst");
    let _bound = std::os::unix::net::UnixListener::bind(&socket).expect("bound");
    assert!(verify(&socket).is_err());
    assert!(Archive::open(&socket).is_err());
}
