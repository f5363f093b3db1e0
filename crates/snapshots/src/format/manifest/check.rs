//! Checks the internal consistency of a manifest, but not its syntax, its root or the files.

use super::{FORMAT, HEADER_LEAF, Manifest, OLDEST_FORMAT, SEALED_FORMAT};
use crate::error::SnapshotError;
use crate::format::canary::is_canary;
use crate::format::folder::Limits;
use crate::format::layout::HELD;
use crate::format::manifest::item::{Item, ReleaseKind};
use crate::format::manifest::{MANIFEST_FILE, MANIFEST_LIMIT};
use crate::format::path::check_path;
use crate::format::version::is_version_number;

/// Checks a manifest, and returns its first problem as an error. Cost: O(n log n) in the number of items.
pub(super) fn check(manifest: &Manifest) -> Result<(), SnapshotError> {
    check_format(manifest)?;
    let name = &manifest.name;
    if name.contains('/') || check_path(name).is_err() {
        return Err(unsound(format!(
            "the name `{}` is not a single, safe path component",
            name.escape_debug()
        )));
    }
    if !is_canary(&manifest.canary) {
        return Err(unsound(format!(
            "the canary `{}` is not a version 8 GUID",
            manifest.canary.escape_debug()
        )));
    }
    match (manifest.kind, manifest.commitment) {
        (ReleaseKind::Sealed, None) => {
            return Err(unsound("the manifest is sealed, but has no commitment".into()));
        }
        (ReleaseKind::Open, Some(_)) => {
            return Err(unsound("the manifest is open, but has a commitment".into()));
        }
        _ => {}
    }
    if manifest.withheld.is_some() {
        if manifest.kind == ReleaseKind::Open {
            return Err(unsound("the manifest is open, but withholds files".into()));
        }
        if let Some(item) = manifest.items.iter().find(|item| item.path.starts_with(HELD)) {
            return Err(unsound(format!(
                "`{}` is listed, but all of {HELD} is withheld",
                item.path.escape_debug()
            )));
        }
    }
    check_files(manifest)
}

/// Checks the items together with the known withheld files.
pub(super) fn check_files(manifest: &Manifest) -> Result<(), SnapshotError> {
    check_items(&manifest.items, &Limits::SNAPSHOT)?;
    if manifest.disclosed().is_empty() {
        return Ok(());
    }
    let mut items: Vec<Item> = manifest.files().cloned().collect();
    items.sort_by(|a, b| a.path.cmp(&b.path));
    check_items(&items, &Limits::SNAPSHOT)
}

/// Infers a manifest's format from the fields that are present.
pub(super) fn shape(manifest: &Manifest) -> u32 {
    match (&manifest.version, &manifest.withheld) {
        (None, _) => OLDEST_FORMAT,
        (Some(_), None) => FORMAT,
        (Some(_), Some(_)) => SEALED_FORMAT,
    }
}

/// Checks the format and the version. From format 2 on, a manifest states which version minted it.
fn check_format(manifest: &Manifest) -> Result<(), SnapshotError> {
    let shape = shape(manifest);
    if manifest.format != shape {
        return Err(unsound(format!(
            "the manifest states format {}, but has the layout of format {shape}",
            manifest.format
        )));
    }
    match &manifest.version {
        Some(version) if !is_version_number(version) => {
            let shown = version.escape_debug();
            Err(unsound(format!("the version `{shown}` must have three numbers, as in `0.12.0`")))
        }
        _ => Ok(()),
    }
}

/// Returns a [`SnapshotError::Manifest`] with a provisional path.
pub(super) fn unsound(message: String) -> SnapshotError {
    SnapshotError::Manifest { path: MANIFEST_FILE.into(), message }
}

fn check_items(items: &[Item], limits: &Limits) -> Result<(), SnapshotError> {
    // One file, of up to `MANIFEST_LIMIT` bytes, is reserved for the manifest.
    if items.len() as u64 >= limits.files {
        return Err(unsound(format!(
            "the manifest has {} items; the limit is {}",
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
        return Err(unsound(format!("the files are larger than {} bytes in total", limits.total_bytes)));
    }
    check_tree(items, limits)
}

/// Checks that the items form a single folder tree on any file system: no path is both a file and a folder, and no
/// two names differ only in case.
///
/// Each item is compared only with its predecessor in tree order, so no paths are stored. Uses two words of
/// memory per item, and stops at the first folder beyond the limit.
fn check_tree(items: &[Item], limits: &Limits) -> Result<(), SnapshotError> {
    let mut paths: Vec<&str> = items.iter().map(|item| item.path.as_str()).collect();
    paths.sort_unstable_by(|a, b| tree_order(a).cmp(tree_order(b)));
    let mut folders = 0;
    let mut before = "";
    for path in paths {
        let depth = path.matches('/').count();
        let shared = shared_components(before, path)?;
        folders += (depth - shared.min(depth)) as u64;
        if folders > limits.files {
            return Err(unsound(format!("the manifest has more than {} folders", limits.files)));
        }
        before = path;
    }
    Ok(())
}

/// Returns the bytes by which a path is sorted. All entries in a folder are then adjacent, ignoring case, because
/// the separator sorts before every other character.
fn tree_order(path: &str) -> impl Iterator<Item = u8> {
    path.bytes().map(|byte| if byte == b'/' { 0 } else { byte.to_ascii_lowercase() })
}

/// Returns the number of leading components shared by two paths that are adjacent in tree order.
fn shared_components(before: &str, path: &str) -> Result<usize, SnapshotError> {
    let (mut shared, mut ends) = (0, (0, 0));
    for (one, two) in before.split('/').zip(path.split('/')).take_while(|(a, b)| a.eq_ignore_ascii_case(b)) {
        if one.is_empty() {
            break;
        }
        ends = (ends.0 + one.len(), ends.1 + two.len());
        if one != two {
            let (first, second) = (&before[..ends.0], &path[..ends.1]);
            let (first, second) = (first.min(second), first.max(second));
            return Err(unsound(format!("`{first}` and `{second}` differ only in case")));
        }
        ends = (ends.0 + 1, ends.1 + 1);
        shared += 1;
    }
    // The previous file's path is a folder here. The opposite case cannot occur, because a file sorts after the
    // content of a folder with the same path.
    if shared > 0 && before.split('/').count() == shared {
        return Err(unsound(format!("`{before}` is both a file and a folder")));
    }
    Ok(shared)
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
        // The text is also parsed, because the reader must reject whatever the writer rejects.
        let text = manifest.text().expect("plain recipe");
        let from_text = Manifest::parse(text.as_bytes()).expect_err(expect);
        assert_eq!(from_text.to_string(), error.to_string());
        assert!(manifest.to_bytes().is_err());
    }

    #[test]
    fn headers() {
        refuse(|m| m.format = 1, "the manifest states format 1, but has the layout of format 2");
        refuse(|m| m.version = None, "the manifest states format 2, but has the layout of format 1");
        refuse(
            |m| m.version = Some("0.12.0; rm x".into()),
            "the version `0.12.0; rm x` must have three numbers",
        );
        refuse(|m| m.name = String::new(), "the name `` is not a single, safe path component");
        refuse(|m| m.name = "a/b".into(), "the name `a/b` is not");
        refuse(|m| m.name = "a\u{1b}".into(), "the name `a\\u{1b}` is not");
        refuse(|m| m.canary = "xyz".into(), "the canary `xyz` is not");
        refuse(|m| m.commitment = None, "sealed, but has no commitment");
        refuse(|m| m.kind = ReleaseKind::Open, "open, but has a commitment");
    }

    #[test]
    fn items() {
        refuse(|m| m.items.swap(1, 2), "not sorted: `c` comes after `d`");
        refuse(|m| m.items[2].path = "c".into(), "`c` is listed twice");
        refuse(|m| m.items[0].path = "../b".into(), "`../b` cannot be in a snapshot");
        refuse(|m| m.items[0].path = "/b".into(), "`/b` cannot be in a snapshot: the path is absolute");
        refuse(|m| m.items[0].path = "MANIFEST".into(), "`MANIFEST` is reserved");
        refuse(|m| m.items[0].path = "Manifest.JSON".into(), "`Manifest.JSON` is reserved");
        refuse(|m| m.items[1].size = (64 << 20) + 1, "`c` is larger than 67108864 bytes");
        refuse(|m| m.items[2].path = "c/d".into(), "`c` is both a file and a folder");
        refuse(|m| m.items[0].path = "C".into(), "`C` and `c` differ only in case");
        refuse(|m| m.items[1].path = "a/B/c".into(), "not sorted");
        refuse(|m| m.items[0].path = "D/x".into(), "`D` and `d` differ only in case");
    }

    fn many(count: usize, size: u64) -> Vec<Item> {
        (0..count).map(|n| Item { size, ..Item::of(format!("f{n:06}"), b"") }).collect()
    }

    #[test]
    fn limits() {
        let limits = &Limits::SNAPSHOT;
        assert!(check_items(&many(99_999, 0), limits).is_ok());
        assert!(check_items(&many(100_000, 0), limits).is_err());
        // 63 files of 64 MiB leave exactly 64 MiB for the manifest.
        assert!(check_items(&many(63, 64 << 20), limits).is_ok());
        assert!(check_items(&many(64, 64 << 20), limits).is_err());
        let deep = [Item::of("a/b/c/d", b"")];
        assert!(check_items(&deep, &Limits { files: 3, ..*limits }).is_ok());
        assert!(check_items(&deep, &Limits { files: 2, ..*limits }).is_err());
    }

    fn items_at(paths: impl IntoIterator<Item = String>) -> Vec<Item> {
        let mut items: Vec<Item> = paths.into_iter().map(|path| Item::of(path, b"")).collect();
        items.sort_by(|a, b| a.path.cmp(&b.path));
        items
    }

    /// Regression test: an archive of half a megabyte, with 99,999 items that each had their own folder at
    /// depth 124, took three gigabytes.
    #[test]
    fn deep_paths_are_refused_early() {
        let deep = items_at((0..99_999).map(|n| format!("g{n:05}{}", "/a".repeat(124))));
        let mut found = None;
        let memory = allocation_counter::measure(|| found = check_items(&deep, &Limits::SNAPSHOT).err());
        let error = found.expect("too deep").to_string();
        assert!(error.contains("more than 16 components"), "{error}");
        assert!(memory.bytes_max < 65_536, "{memory:?}");
    }

    /// At the maximum depth, folders are counted rather than stored, and only up to the limit.
    #[test]
    fn folders_are_counted_in_small_memory() {
        let wide = items_at((0..99_999).map(|n| format!("g{n:05}{}", "/a".repeat(15))));
        let mut found = None;
        let memory = allocation_counter::measure(|| found = check_items(&wide, &Limits::SNAPSHOT).err());
        let error = found.expect("too many").to_string();
        assert!(error.contains("more than 100000 folders"), "{error}");
        assert!(memory.bytes_max < 4 << 20, "{memory:?}");
        let shared = items_at((0..99_999).map(|n| format!("games/g{}/f{n:05}", n / 2)));
        assert!(check_items(&shared, &Limits::SNAPSHOT).is_ok());
    }

    /// Checks the same paths by building a complete tree of names.
    fn by_names(items: &[Item], limit: usize) -> bool {
        let mut names = std::collections::BTreeMap::new();
        let mut folders = std::collections::BTreeSet::new();
        items.iter().all(|item| {
            let path = item.path.as_str();
            path.match_indices('/').map(|(end, _)| (end, true)).chain([(path.len(), false)]).all(
                |(end, folder)| {
                    let name = &path[..end];
                    if folder {
                        folders.insert(name);
                    }
                    let known = names.entry(name.to_ascii_lowercase()).or_insert((name, folder));
                    *known == (name, folder)
                },
            )
        }) && folders.len() <= limit
    }

    #[test]
    fn the_walk_matches_a_tree_of_names() {
        let mut sampler = base::Seed::from_text("trees").sampler();
        let names = ["a", "A", "b", "a-b", "a.b", "B", "c"];
        let mut counts = [0; 2];
        for _ in 0..4000 {
            let paths: std::collections::BTreeSet<String> = (0..1 + sampler.below(5))
                .map(|_| {
                    let depth = 1 + sampler.below(3);
                    (0..depth).map(|_| *sampler.choose(&names)).collect::<Vec<_>>().join("/")
                })
                .collect();
            let items = items_at(paths);
            let expect = by_names(&items, 3);
            let found = check_tree(&items, &Limits { files: 3, ..Limits::SNAPSHOT });
            assert_eq!(found.is_ok(), expect, "{items:?} {found:?}");
            counts[usize::from(expect)] += 1;
        }
        assert!(counts.iter().all(|count| *count > 500), "{counts:?}");
    }
}
