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

/// The tables of CONTRIBUTING.md name files with the functions and the other names that they contain. A third column
/// lists functions. In the second column of other tables, `name()` is a function.
#[test]
fn contributing_names_functions_that_exist() {
    let page = read("CONTRIBUTING.md");
    let (mut functions, mut others) = (0, 0);
    for row in page.lines().filter(|line| line.starts_with("| ")) {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let (file, text, has_steps) = match cells[..] {
            [_, file, text] => (file, text, true),
            [file, text] => (file, text, false),
            _ => continue,
        };
        let Some(file) = file.strip_prefix('`').and_then(|file| file.strip_suffix('`')) else { continue };
        let source = read(file);
        for piece in text.split('`').skip(1).step_by(2) {
            let call = piece.strip_suffix("()").or_else(|| has_steps.then_some(piece));
            let is_letter = |c: char| c.is_alphanumeric() || c == '_';
            if let Some(name) = call {
                let is_there = ["(", "<"].iter().any(|next| source.contains(&format!("fn {name}{next}")));
                assert!(is_there, "CONTRIBUTING.md: {file} has no function `{name}`");
                functions += 1;
            } else if piece.chars().all(is_letter) {
                let is_there = source.split(|c| !is_letter(c)).any(|word| word == piece);
                assert!(is_there, "CONTRIBUTING.md: {file} does not contain `{piece}`");
                others += 1;
            }
        }
    }
    assert!(functions > 20 && others > 8, "{functions} functions, {others} other names");
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

/// The page on releases states the number of ticks of all witnesses that the README lists.
#[test]
fn pages_show_the_ticks_of_tiny() {
    let readme = read("README.md");
    let wins = readme.lines().filter_map(|line| line.split_once("won in ")?.1.strip_suffix(" ticks"));
    let ticks: u32 =
        wins.flat_map(|wins| wins.split(", ")).map(|win| win.parse::<u32>().expect("a number")).sum();
    let page = read("docs/reference/snapshots.md");
    let expect = format!("the six witnesses of `tiny` have {ticks} ticks");
    assert!(page.contains(&expect), "docs/reference/snapshots.md does not say that {expect}");
}
