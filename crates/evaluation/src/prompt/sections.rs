//! Prompt sections. Each section begins with a heading.

/// The prefix of a heading line.
const HEADING: &str = "## ";

/// The name of the text before the first heading.
pub const TASK: &str = "Task";

/// Returns a message's sections, each with its heading and its text without surrounding blank lines. The
/// section before the first heading is named [`TASK`]. If a heading occurs more than once, the first
/// occurrence belongs to the template, and later ones belong to inserted text. Cost: O(bytes).
pub fn sections(message: &str) -> Vec<(&str, &str)> {
    let mut sections = Vec::new();
    let (mut heading, mut start, mut at) = (TASK, 0, 0);
    for line in message.split_inclusive('\n') {
        if let Some(next) = line.strip_prefix(HEADING) {
            sections.push((heading, message[start..at].trim_matches('\n')));
            (heading, start) = (next.trim_end(), at + line.len());
        }
        at += line.len();
    }
    sections.push((heading, message[start..].trim_matches('\n')));
    sections.retain(|(heading, body)| *heading != TASK || !body.is_empty());
    sections
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sections_are_split_at_headings() {
        let text = "Play.\n\n## Rules\nYou win.\n\nYou lose.\n\n## Board\nww\n w\n";
        assert_eq!(
            sections(text),
            [("Task", "Play."), ("Rules", "You win.\n\nYou lose."), ("Board", "ww\n w")]
        );
        assert_eq!(sections("## Turn\nTick 1"), [("Turn", "Tick 1")]);
        assert_eq!(sections(""), []);
    }
}
