//! The prose in the book and on the front pages. It must contain no long sentences, and no phrases that a
//! native editor would replace.

use std::path::Path;

use tests::{read, workspace_files};

/// The pages in the root folder.
const FRONT_PAGES: [&str; 4] = ["ARCHITECTURE.md", "CHANGELOG.md", "CONTRIBUTING.md", "README.md"];

/// Pages that are not checked, because they are generated or show program output.
const GENERATED: [&str; 4] =
    ["docs/SUMMARY.md", "docs/lab/gallery.md", "docs/reference/commands.md", "docs/reference/recipe-keys.md"];

/// The maximum length of a sentence, in words.
const WORDS: usize = 35;

/// Phrases in lower case, each with its replacement.
const PHRASES: &[(&str, &str)] = &[
    ("is of no", "a plain adjective, or: belongs to none of the"),
    ("are of no", "a plain adjective, or: belong to none of the"),
    ("is not there", "does not exist, or: is missing"),
    ("are not there", "do not exist, or: are missing"),
    ("can be had", "is available, or: is achievable"),
    ("sees to it that", "ensures"),
    ("see to it that", "ensure"),
    ("question for a password", "password prompt"),
    ("a line each", "one line for each"),
    ("one a line", "one per line"),
    ("an object a line", "one object per line"),
    ("dies of", "crashes on"),
    ("dies on", "crashes on"),
    ("broken off", "stopped, or: aborted"),
    ("likewise", "the same"),
    ("altogether", "in total"),
    ("any more", "any longer"),
    ("is told", "is reported"),
    ("are told", "are reported"),
    ("tells what", "shows"),
    ("tell what", "show"),
    ("are others", "are different"),
    ("blank", "space"),
    ("blanks", "spaces"),
    ("picture", "image"),
    ("pictures", "images"),
    ("remark", "warning, or: note"),
    ("remarks", "warnings, or: notes"),
];

/// Words that form a fixed phrase with a preceding `no`, as in "is no longer".
const AFTER_NO: [&str; 8] = ["longer", "more", "less", "fewer", "later", "better", "worse", "other"];

#[test]
fn the_book_has_no_phrase_that_an_editor_replaces() {
    let mut problems = Vec::new();
    for_each_page(&mut |name, text| {
        for (line, text) in blocks(text, true) {
            for (phrase, instead) in found(&text) {
                problems.push(format!("{name}:{line}: `{phrase}`: write {instead}"));
            }
        }
    });
    assert!(problems.is_empty(), "{} problems\n{}", problems.len(), problems.join("\n"));
}

#[test]
fn sentences_of_the_book_are_short() {
    let mut problems = Vec::new();
    for_each_page(&mut |name, text| {
        for (line, text) in blocks(text, false) {
            for sentence in sentences(&text) {
                let words = count(sentence);
                if words > WORDS {
                    let start: String = sentence.chars().take(60).collect();
                    problems.push(format!("{name}:{line}: {words} words, at most {WORDS}: {start} …"));
                }
            }
        }
    });
    assert!(problems.is_empty(), "{} problems\n{}", problems.len(), problems.join("\n"));
}

fn for_each_page(look: &mut dyn FnMut(&str, &str)) {
    let mut count = 0;
    for file in workspace_files() {
        let name = file.to_string_lossy().into_owned();
        let is_page = file.starts_with("docs") && file.extension() == Some("md".as_ref());
        if (is_page && !GENERATED.contains(&name.as_str()))
            || FRONT_PAGES.iter().any(|page| file == Path::new(page))
        {
            look(&name, &read(&file));
            count += 1;
        }
    }
    assert!(count > 200, "{count} pages");
}

/// Returns a page's paragraphs, items and headings as plain text, each with its first line number. Table cells are
/// included on request. Code is never included.
fn blocks(page: &str, with_tables: bool) -> Vec<(usize, String)> {
    let mut blocks: Vec<(usize, String)> = Vec::new();
    let mut is_open = false;
    let mut fence: Option<&str> = None;
    for (number, line) in (1..).zip(page.lines()) {
        let text = line.trim();
        if let Some(mark) = ["```", "~~~"].into_iter().find(|mark| text.starts_with(mark)) {
            fence = if fence == Some(mark) { None } else { fence.or(Some(mark)) };
            is_open = false;
            continue;
        }
        if fence.is_some() || text.is_empty() || text.starts_with("<!--") {
            is_open = false;
            continue;
        }
        if text.starts_with('|') {
            is_open = false;
            if with_tables {
                blocks.extend(text.trim_matches('|').split(" | ").map(|cell| (number, cell.to_owned())));
            }
            continue;
        }
        let item = item(text);
        if !is_open || item.is_some() || text.starts_with('#') {
            blocks.push((number, String::new()));
        }
        let block = &mut blocks.last_mut().expect("just pushed").1;
        block.push_str(item.unwrap_or_else(|| text.trim_start_matches(['#', '>', ' '])));
        block.push(' ');
        is_open = !text.starts_with('#');
    }
    blocks.iter().map(|(number, text)| (*number, plain(text))).collect()
}

/// Returns the text of a list item without its marker; `None` if the text is not a list item.
fn item(text: &str) -> Option<&str> {
    let digits = text.trim_start_matches(|c: char| c.is_ascii_digit());
    let numbered = digits.strip_prefix(". ").filter(|_| digits.len() < text.len());
    numbered.or_else(|| ["- ", "* ", "+ "].iter().find_map(|mark| text.strip_prefix(mark)))
}

/// Returns a text without markup. Code becomes one word, and links become their text.
fn plain(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find('`') {
        plain.push_str(&rest[..at]);
        let ticks = rest[at..].len() - rest[at..].trim_start_matches('`').len();
        let mark = &rest[at..at + ticks];
        rest = &rest[at + ticks..];
        let Some(end) = rest.find(mark) else { break };
        plain.push_str("Code");
        rest = &rest[end + ticks..];
    }
    plain.push_str(rest);
    let mut text = String::with_capacity(plain.len());
    let mut rest = plain.as_str();
    while let Some(at) = rest.find("](") {
        text.push_str(&rest[..at]);
        rest = rest[at..].find(')').map_or("", |end| &rest[at + end + 1..]);
    }
    text.push_str(rest);
    text.replace(['*', '['], "")
}

/// Returns a text's sentences. Items between `·` count as separate sentences.
fn sentences(text: &str) -> impl Iterator<Item = &str> {
    text.split(" · ").flat_map(|part| {
        let mut starts = vec![0];
        let ends = part.match_indices(['.', '!', '?']);
        starts.extend(ends.filter_map(|(at, mark)| {
            let rest = part[at + mark.len()..].trim_start_matches([')', '"', '”', '’']);
            let next = rest.strip_prefix(' ')?.trim_start();
            let begins = next
                .trim_start_matches(['"', '“', '('])
                .starts_with(|c: char| c.is_uppercase() || c.is_ascii_digit());
            begins.then(|| part.len() - next.len())
        }));
        let ends: Vec<usize> = starts.iter().skip(1).copied().chain([part.len()]).collect();
        starts.into_iter().zip(ends).map(|(from, to)| part[from..to].trim()).collect::<Vec<_>>()
    })
}

fn count(sentence: &str) -> usize {
    sentence.split_whitespace().filter(|word| word.contains(char::is_alphanumeric)).count()
}

/// Returns the phrases in a text that an editor would replace, with their replacements.
fn found(text: &str) -> Vec<(String, &'static str)> {
    let lower = text.to_lowercase();
    let words: Vec<&str> = lower
        .split(|c: char| !c.is_alphanumeric() && c != '\'' && c != '_')
        .filter(|word| !word.is_empty())
        .collect();
    let mut found: Vec<(String, &str)> = PHRASES
        .iter()
        .filter(|(phrase, _)| has_phrase(&words, phrase))
        .map(|(phrase, instead)| ((*phrase).to_owned(), *instead))
        .collect();
    for at in 0..words.len().saturating_sub(2) {
        let is_no =
            ["is", "are"].contains(&words[at]) && words[at + 1] == "no" && !AFTER_NO.contains(&words[at + 2]);
        if is_no && (at == 0 || !["there", "answer"].contains(&words[at - 1])) {
            found.push((words[at..at + 3].join(" "), "isn't a …, or: is not"));
        }
    }
    if lower.as_bytes().windows(3).any(|three| three[0].is_ascii_digit() && &three[1..] == b" %") {
        found.push(("95 %".to_owned(), "95%"));
    }
    found
}

fn has_phrase(words: &[&str], phrase: &str) -> bool {
    let phrase: Vec<&str> = phrase.split(' ').collect();
    words.windows(phrase.len()).any(|window| window == phrase)
}

#[test]
fn phrases_are_found_as_whole_words() {
    let names = |text: &str| found(text).into_iter().map(|(phrase, _)| phrase).collect::<Vec<_>>();
    assert_eq!(names("A key is no door."), ["is no door"]);
    assert_eq!(names("There is no door. It is no longer shut."), [""; 0]);
    assert_eq!(names("A line that is not there, in 95 % of cases."), ["is not there", "95 %"]);
    assert_eq!(names("Blankets are pictured, 95% of them."), [""; 0]);
}

#[test]
fn blocks_and_sentences_are_found() {
    let page = "# A title\n\nOne `is no` word.\nTwo [words](a.md).\n- Item e.g. one\n| a | b |\n\n```text\nis no\n```\n";
    let texts = |with_tables| {
        blocks(page, with_tables)
            .into_iter()
            .map(|(line, text)| (line, text.trim().to_owned()))
            .collect::<Vec<_>>()
    };
    let expect = [(1, "A title"), (3, "One Code word. Two words."), (5, "Item e.g. one")];
    assert_eq!(texts(false), expect.map(|(line, text)| (line, text.to_owned())));
    assert_eq!(texts(true).len(), 5);
    let all: Vec<&str> = sentences("One is e.g. one. Two (of 3). (Three) · four. five").collect();
    assert_eq!(all, ["One is e.g. one.", "Two (of 3).", "(Three)", "four. five"]);
    assert_eq!(count("One – two, Code."), 3);
}
