//! Removes problems that merely follow from another problem in the same file.

use crate::diagnostic::{Diagnostic, Diagnostics, Severity, line_start};
use crate::limits::MAX_PROBLEMS;
use std::collections::BTreeMap;

/// Problem codes that make the declared sprites uncertain.
const HIDES_DECLARATIONS: [&str; 4] = ["missing-section", "missing-arrow", "stray-line", "too-deep"];
/// Problem codes that make the first word of a line uncertain.
const HIDES_START: [&str; 4] = ["missing-arrow", "bad-mapping", "bad-interaction", "bad-termination"];
/// Problem codes about a name. Such a problem is reported only once, however often the name is used.
const OF_A_NAME: [&str; 2] = ["unknown-sprite", "parent-sprite"];

/// Returns all problems in a file, sorted by position, except problems that follow from other problems.
/// `read` contains the problems found while parsing the file, and `compiled` those found while compiling its
/// rules. A problem's subject is the word quoted in its message and its help text.
pub(crate) fn reported(read: Vec<Diagnostic>, compiled: Vec<Diagnostic>, source: &str) -> Diagnostics {
    let unread = Diagnostics::has_errors(&read);
    let all = Diagnostics::sorted(read.into_iter().chain(once_each(compiled)).collect()).0;
    let faulty = Diagnostics::has_errors(&all);
    let roots: Vec<Diagnostic> =
        all.iter().filter(|problem| is_root(problem)).take(MAX_PROBLEMS).cloned().collect();
    let mut reported: Vec<Diagnostic> = Vec::new();
    for problem in all {
        let hidden = || match problem.code {
            "no-win" => unread,
            _ => roots.iter().any(|root| follows(&problem, root, source)),
        };
        // Problems beyond the limit are only counted.
        if reported.len() > MAX_PROBLEMS || !hidden() {
            reported.push(problem);
        }
    }
    if faulty && !Diagnostics::has_errors(&reported) {
        // All errors follow from the indentation.
        let roots = reported.iter_mut().filter(|problem| is_uneven(problem));
        roots.for_each(|root| root.severity = Severity::Error);
    }
    Diagnostics(reported).shortened(source.len())
}

/// Returns `true` if `problem` may be the cause of other problems.
fn is_root(problem: &Diagnostic) -> bool {
    let warns = ["ignored-class", "empty-mapping"].contains(&problem.code);
    problem.severity == Severity::Error || warns || is_uneven(problem)
}

/// Returns `true` if the problem is with a sprite's indent, which makes parents and subtypes uncertain.
fn is_uneven(problem: &Diagnostic) -> bool {
    problem.code == "uneven-indent" && !problem.message.ends_with("sections")
}

fn follows(problem: &Diagnostic, root: &Diagnostic, source: &str) -> bool {
    let line = |problem: &Diagnostic| line_start(source, problem.span.start);
    let same_line = || line(problem) == line(root);
    match problem.code {
        "unknown-sprite" => HIDES_DECLARATIONS.contains(&root.code),
        // If the word is not a single character, `bad-mapping` quotes the whole word, so compare its first
        // character.
        "duplicate-mapping" => root.code == "bad-mapping" && quoted(root).starts_with(quoted(problem)),
        "no-class" => root.code != problem.code && same_line(),
        // The parameter is present but misspelt. For subtypes, it may be on their parent's line.
        "missing-parameter" => {
            let key = problem.message.split('`').find_map(|quoted| quoted.strip_suffix('='));
            let (help, key) = (root.help.as_deref().unwrap_or_default(), key.unwrap_or_default());
            let names = help.contains(&format!("`{key}`")) || help.contains(&format!("`{key}="));
            root.code != problem.code && names && line(root) <= line(problem)
        }
        // The indent separated the missing word from the rest of the line.
        "uneven-indent" | "stray-indent" => HIDES_START.contains(&root.code) && same_line(),
        "ignored-class" => is_uneven(root),
        "parent-sprite" => {
            let subtypes = problem.help.as_deref().and_then(|help| help.split(": ").nth(1));
            let below = || subtypes.unwrap_or_default().split(", ").any(|subtype| subtype == quoted(root));
            is_uneven(root) || root.code == "ignored-class" && below()
        }
        "never-there" => match root.code {
            "ignored-class" => same_line(),
            code => is_uneven(root) || code == "empty-mapping",
        },
        _ => false,
    }
}

/// Returns the subject of a problem: the first word that its message quotes.
fn quoted(problem: &Diagnostic) -> &str {
    problem.message.split('`').nth(1).unwrap_or_default()
}

/// Keeps only the first report of a repeatedly misused name.
fn once_each(problems: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let problems = Diagnostics::sorted(problems).0;
    let mut places: BTreeMap<(&str, String), usize> = BTreeMap::new();
    let mut reported: Vec<Diagnostic> = Vec::new();
    for problem in problems {
        let count = places.entry((problem.code, problem.message.clone())).or_default();
        *count += 1;
        if *count == 1 || !OF_A_NAME.contains(&problem.code) {
            reported.push(problem);
        }
    }
    for problem in reported.iter_mut().filter(|problem| OF_A_NAME.contains(&problem.code)) {
        let more = places[&(problem.code, problem.message.clone())] - 1;
        if more > 0 {
            let (places, name) = if more == 1 { ("place", "names") } else { ("places", "name") };
            problem.message += &format!("; {more} more {places} {name} it");
        }
    }
    reported
}
