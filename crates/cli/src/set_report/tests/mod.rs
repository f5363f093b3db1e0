mod games;
mod levels;

use std::path::Path;

/// The page of a report of three files, which needs no other.
fn page(dir: &Path, pictures: usize) -> String {
    let read = |name: &str| std::fs::read(dir.join(name)).unwrap();
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
