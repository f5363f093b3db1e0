//! Imports between the layers of the engine go in one direction.

use super::report;
use tests::rust_files;

const ENGINE: &str = "engine/src/";

/// The layers, from bottom to top. Modules outside all layers are above them.
const LAYERS: [&[&str]; 5] = [&["syntax"], &["rules", "compile"], &["world"], &["tick"], &["schedule"]];

/// The modules that do not depend on games, and that every layer may use.
const VALUES: [&str; 6] = ["diagnostic", "flat", "keywords", "limits", "meanings", "numbers"];

fn layer(module: &str) -> Option<usize> {
    LAYERS.iter().position(|modules| modules.contains(&module))
}

/// Returns the engine modules to which a line of code refers through `crate::`.
fn named(line: &str) -> impl Iterator<Item = &str> {
    line.split("crate::").skip(1).filter_map(|rest| {
        let end =
            rest.find(|letter: char| !letter.is_ascii_lowercase() && letter != '_').unwrap_or(rest.len());
        Some(&rest[..end]).filter(|module| !module.is_empty())
    })
}

#[test]
fn layers_of_the_engine_import_one_way() {
    let mut problems = Vec::new();
    let mut seen = 0;
    for (file, text) in rust_files() {
        let file = file.display().to_string();
        let Some(inside) = file.strip_prefix(ENGINE) else { continue };
        let module = inside.split(['/', '.']).next().unwrap_or_default();
        let Some(own) = layer(module).filter(|_| !inside.contains("/tests")) else { continue };
        let code = (1..).zip(text.lines()).take_while(|(_, line)| *line != "#[cfg(test)]");
        for (number, line) in code.filter(|(_, line)| !line.trim_start().starts_with("//")) {
            for other in named(line).filter(|other| *other != module && !VALUES.contains(other)) {
                seen += 1;
                let points_up = layer(other).is_none_or(|other| other > own);
                let is_macro = line.contains(&format!("crate::{other}!"));
                if points_up && !is_macro {
                    problems.push(format!(
                        "{file}:{number}: `{module}` must not import `{other}`, which stands on it"
                    ));
                }
            }
        }
    }
    assert!(seen > 100, "{seen} imports between modules");
    report(problems);
}
