//! The pages in the root folder: their length, the functions they name, and the output they show.

use tests::read;

/// The maximum length of a front page, in lines.
const LINES: [(&str, usize); 3] = [("README.md", 100), ("ARCHITECTURE.md", 130), ("CHANGELOG.md", 150)];

#[test]
fn front_pages_are_short() {
    for (page, most) in LINES {
        let lines = read(page).lines().count();
        assert!(
            lines <= most,
            "{page} has {lines} lines, and at most {most} may be; move details into the book"
        );
    }
}

/// The rows `| step | file | functions |` of the walk from the seed to the release name functions that exist.
#[test]
fn contributing_names_functions_that_exist() {
    let page = read("CONTRIBUTING.md");
    let mut count = 0;
    for row in page.lines().filter(|line| line.starts_with("| ")) {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let [_, file, functions] = cells[..] else { continue };
        let Some(file) = file.strip_prefix('`').and_then(|file| file.strip_suffix('`')) else { continue };
        let source = read(file);
        for function in functions.split(", ") {
            let name = function.trim_matches('`');
            assert!(
                source.contains(&format!("fn {name}")),
                "CONTRIBUTING.md: {file} has no function `{name}`"
            );
            count += 1;
        }
    }
    assert!(count > 10, "{count}");
}

/// The output of `arcade release tiny`, as shown in the README and the first tutorial, contains the root that
/// a test mints.
#[test]
fn pages_show_the_root_of_tiny() {
    let root = read("crates/cli/tests/tiny.root");
    for page in ["README.md", "docs/start/first-release.md"] {
        let text = read(page);
        let shown: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("root ")).collect();
        assert!(
            !shown.is_empty() && shown.iter().all(|shown| *shown == root.trim()),
            "{page}: {shown:?}, minted: {root}"
        );
    }
}
