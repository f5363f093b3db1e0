mod games;
mod levels;

use crate::File;
use std::path::{Path, PathBuf};

/// Returns the names of the corpus games.
fn corpus() -> Vec<String> {
    let folders = std::fs::read_dir(corpora()).unwrap().map(|entry| entry.unwrap().path());
    let games = folders.filter(|folder| folder.join("game.vgdl").is_file());
    let mut names: Vec<String> =
        games.map(|folder| folder.file_name().unwrap().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Returns a corpus game's rules and the texts of its levels.
fn texts(game: &str) -> (String, Vec<String>) {
    let read = |file: &str| std::fs::read_to_string(corpora().join(game).join(file));
    let levels = (0..).map_while(|number| read(&format!("lvl{number}.txt")).ok());
    (read("game.vgdl").unwrap(), levels.collect())
}

fn corpora() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpora")
}

/// Returns the content of a file in a report.
fn read(files: &[File], name: &str) -> Vec<u8> {
    files.iter().find(|file| file.name == name).unwrap().bytes.clone()
}

/// Returns the page of a three-file report, after checking that the page is self-contained.
fn page(files: &[File], pictures: usize) -> String {
    assert_eq!(files.len(), 3);
    let read = |name: &str| read(files, name);
    let json = String::from_utf8(read("report.json")).unwrap();
    assert!(!json.contains("seconds"), "time is no part of the report");
    assert!(read("sheet.png").starts_with(b"\x89PNG"));
    let page = String::from_utf8(read("report.html")).unwrap();
    assert_eq!(page.matches("<img src=\"data:image/png;base64,").count(), pictures);
    for outside in ["http://", "https://", "src=\"/", "href=", "<script"] {
        assert!(!page.contains(outside), "{outside}");
    }
    page
}
