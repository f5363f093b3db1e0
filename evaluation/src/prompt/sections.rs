//! The sections of a prompt: what stands between its headings.

/// What opens a heading, at the start of a line.
const HEADING: &str = "## ";

/// What comes before the first heading.
pub const TASK: &str = "Task";

/// The sections of a message, each with its heading and its lines without the blank ones around them; what comes before
/// the first heading is [`TASK`]. Where a heading comes twice, the first one is ours and later ones are part of a text that
/// somebody put in. Cost: O(bytes).
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
    fn between_the_headings() {
        let text = "Play.\n\n## Rules\nYou win.\n\nYou lose.\n\n## Board\nww\n w\n";
        assert_eq!(
            sections(text),
            [("Task", "Play."), ("Rules", "You win.\n\nYou lose."), ("Board", "ww\n w")]
        );
        assert_eq!(sections("## Turn\nTick 1"), [("Turn", "Tick 1")]);
        assert_eq!(sections(""), []);
    }
}
