//! Whether a manifest is sound in itself: everything but the syntax, the root and the files.

use std::collections::BTreeMap;

use super::{FORMAT, HEADER_LEAF, Item, Kind, MANIFEST_FILE, MANIFEST_LIMIT, Manifest, OLDEST_FORMAT};
use crate::canary::is_canary;
use crate::error::SnapshotError;
use crate::folder::Limits;
use crate::path::check_path;
use crate::version::is_version_number;

/// The first thing that is wrong. Cost: O(n log n) in the items.
pub(super) fn check(manifest: &Manifest) -> Result<(), SnapshotError> {
    check_format(manifest)?;
    let name = &manifest.name;
    if name.contains('/') || check_path(name).is_err() {
        return Err(unsound(format!("the name `{}` is not one safe path component", name.escape_debug())));
    }
    if !is_canary(&manifest.canary) {
        return Err(unsound(format!(
            "the canary `{}` is not a version 8 GUID",
            manifest.canary.escape_debug()
        )));
    }
    match (manifest.kind, manifest.commitment) {
        (Kind::Sealed, None) => return Err(unsound("it is sealed and has no commitment".into())),
        (Kind::Open, Some(_)) => return Err(unsound("it is open and has a commitment".into())),
        _ => {}
    }
    check_items(&manifest.items, &Limits::SNAPSHOT)
}

/// From format 2 on a manifest names the version that minted it.
fn check_format(manifest: &Manifest) -> Result<(), SnapshotError> {
    let shape = if manifest.version.is_some() { FORMAT } else { OLDEST_FORMAT };
    if manifest.format != shape {
        return Err(unsound(format!(
            "it says format {}, but has the shape of format {shape}",
            manifest.format
        )));
    }
    match &manifest.version {
        Some(version) if !is_version_number(version) => {
            let shown = version.escape_debug();
            Err(unsound(format!("the version `{shown}` is not three numbers, as in `0.12.0`")))
        }
        _ => Ok(()),
    }
}

/// A [`SnapshotError::Manifest`] that does not know its place yet.
pub(super) fn unsound(message: String) -> SnapshotError {
    SnapshotError::Manifest { path: MANIFEST_FILE.into(), message }
}

fn check_items(items: &[Item], limits: &Limits) -> Result<(), SnapshotError> {
    // One file and up to `MANIFEST_LIMIT` bytes are the manifest's own.
    if items.len() as u64 >= limits.files {
        return Err(unsound(format!(
            "{} items are too many (the limit is {})",
            items.len(),
            limits.files - 1
        )));
    }
    for item in items {
        let path = &item.path;
        check_path(path).map_err(|problem| {
            unsound(format!("`{}` cannot be in a snapshot: {problem}", path.escape_debug()))
        })?;
        if [HEADER_LEAF, MANIFEST_FILE].iter().any(|reserved| path.eq_ignore_ascii_case(reserved)) {
            return Err(unsound(format!("the path `{path}` is reserved")));
        }
        if item.size > limits.file_bytes {
            return Err(unsound(format!("`{path}` is larger than {} bytes", limits.file_bytes)));
        }
    }
    if let Some(pair) = items.windows(2).find(|pair| pair[0].path >= pair[1].path) {
        let (first, second) = (&pair[0].path, &pair[1].path);
        return Err(unsound(match first == second {
            true => format!("`{first}` is listed twice"),
            false => format!("the items are not sorted: `{second}` comes after `{first}`"),
        }));
    }
    let total = items.iter().fold(MANIFEST_LIMIT, |total, item| total.saturating_add(item.size));
    if total > limits.total_bytes {
        return Err(unsound(format!("its files are larger than {} bytes altogether", limits.total_bytes)));
    }
    check_tree(items, limits)
}

/// Whether the items are the files of one folder tree on any file system: no file is also a folder, and no two
/// names differ in capitals only.
fn check_tree(items: &[Item], limits: &Limits) -> Result<(), SnapshotError> {
    let mut names: BTreeMap<String, (&str, bool)> = BTreeMap::new();
    let mut folders = 0;
    for item in items {
        let path = item.path.as_str();
        let ends = path.match_indices('/').map(|(end, _)| (end, true)).chain([(path.len(), false)]);
        for (end, folder) in ends {
            let name = &path[..end];
            match names.insert(name.to_ascii_lowercase(), (name, folder)) {
                Some((other, _)) if other != name => {
                    return Err(unsound(format!("`{other}` and `{name}` differ in capitals only")));
                }
                Some((_, was_folder)) if was_folder != folder => {
                    return Err(unsound(format!("`{name}` is both a file and a folder")));
                }
                Some(_) => {}
                None => folders += u64::from(folder),
            }
        }
    }
    if folders > limits.files {
        return Err(unsound(format!("{folders} folders are too many (the limit is {})", limits.files)));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::tests::example;
    use super::*;

    #[track_caller]
    fn refuse(change: impl FnOnce(&mut Manifest), expect: &str) {
        let mut manifest = example(&[("a/b", b"1"), ("c", b"2"), ("d", b"3")]);
        check(&manifest).expect("the example is sound");
        change(&mut manifest);
        let error = check(&manifest).expect_err(expect);
        assert!(error.to_string().contains(expect), "{error}");
        // The same from bytes: the reader refuses what the writer refuses.
        let text = manifest.text().expect("plain recipe");
        let from_text = Manifest::parse(text.as_bytes()).expect_err(expect);
        assert_eq!(from_text.to_string(), error.to_string());
        assert!(manifest.to_bytes().is_err());
    }

    #[test]
    fn headers() {
        refuse(|m| m.format = 1, "it says format 1, but has the shape of format 2");
        refuse(|m| m.version = None, "it says format 2, but has the shape of format 1");
        refuse(
            |m| m.version = Some("0.12.0; rm x".into()),
            "the version `0.12.0; rm x` is not three numbers",
        );
        refuse(|m| m.name = String::new(), "the name `` is not one safe path component");
        refuse(|m| m.name = "a/b".into(), "the name `a/b` is not");
        refuse(|m| m.name = "a\u{1b}".into(), "the name `a\\u{1b}` is not");
        refuse(|m| m.canary = "xyz".into(), "the canary `xyz` is not");
        refuse(|m| m.commitment = None, "sealed and has no commitment");
        refuse(|m| m.kind = Kind::Open, "open and has a commitment");
    }

    #[test]
    fn items() {
        refuse(|m| m.items.swap(1, 2), "not sorted: `c` comes after `d`");
        refuse(|m| m.items[2].path = "c".into(), "`c` is listed twice");
        refuse(|m| m.items[0].path = "../b".into(), "`../b` cannot be in a snapshot");
        refuse(|m| m.items[0].path = "/b".into(), "`/b` cannot be in a snapshot: it is absolute");
        refuse(|m| m.items[0].path = "MANIFEST".into(), "`MANIFEST` is reserved");
        refuse(|m| m.items[0].path = "Manifest.JSON".into(), "`Manifest.JSON` is reserved");
        refuse(|m| m.items[1].size = (64 << 20) + 1, "`c` is larger than 67108864 bytes");
        refuse(|m| m.items[2].path = "c/d".into(), "`c` is both a file and a folder");
        refuse(|m| m.items[0].path = "C".into(), "`C` and `c` differ in capitals only");
        refuse(|m| m.items[1].path = "a/B/c".into(), "not sorted");
        refuse(|m| m.items[0].path = "D/x".into(), "`D` and `d` differ in capitals only");
    }

    fn many(count: usize, size: u64) -> Vec<Item> {
        (0..count).map(|n| Item { size, ..Item::of(format!("f{n:06}"), b"") }).collect()
    }

    #[test]
    fn limits() {
        let limits = &Limits::SNAPSHOT;
        assert!(check_items(&many(99_999, 0), limits).is_ok());
        assert!(check_items(&many(100_000, 0), limits).is_err());
        // 63 files of 64 MiB leave 64 MiB for the manifest.
        assert!(check_items(&many(63, 64 << 20), limits).is_ok());
        assert!(check_items(&many(64, 64 << 20), limits).is_err());
        let deep = [Item::of("a/b/c/d", b"")];
        assert!(check_items(&deep, &Limits { files: 3, ..*limits }).is_ok());
        assert!(check_items(&deep, &Limits { files: 2, ..*limits }).is_err());
    }
}
