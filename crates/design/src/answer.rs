//! Reads ideas, rules and levels from a designer's answers.

/// A fenced block in an answer.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Block<'a> {
    /// The word after the opening fence, in lower case.
    tag: String,
    lines: Vec<&'a str>,
}

/// The idea for a game.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Idea {
    /// The game's name: lower-case words, joined by dashes.
    pub(crate) name: String,
    /// The description, on one line.
    pub(crate) text: String,
}

/// The levels in an answer, possibly with changed rules.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Levels {
    pub(crate) levels: Vec<String>,
    pub(crate) rules: Option<String>,
}

/// Returns the blocks between fences. A block without a closing fence ends with the text.
fn blocks(text: &str) -> Vec<Block<'_>> {
    let mut blocks: Vec<Block<'_>> = Vec::new();
    let mut is_open = false;
    for line in text.lines() {
        match (line.trim().strip_prefix("```"), is_open) {
            (Some(_), true) => is_open = false,
            (Some(tag), false) => {
                is_open = true;
                blocks.push(Block { tag: tag.trim().to_lowercase(), lines: Vec::new() });
            }
            (None, true) => blocks.last_mut().expect("a block is open").lines.push(line),
            (None, false) => {}
        }
    }
    blocks
}

impl Block<'_> {
    fn text(&self) -> String {
        self.lines.iter().map(|line| format!("{}\n", line.trim_end())).collect()
    }

    fn is_rules(&self) -> bool {
        self.tag == "vgdl" || self.lines.iter().any(|line| line.trim_start().starts_with("BasicGame"))
    }

    /// Returns the block as a level, without empty lines at its start and end.
    fn level(&self) -> String {
        let is_blank = |line: &&&str| line.trim().is_empty();
        let first = self.lines.iter().take_while(is_blank).count();
        let last = self.lines.iter().rev().take_while(is_blank).count();
        let kept = self.lines.get(first..self.lines.len() - last).unwrap_or_default();
        kept.iter().map(|line| format!("{}\n", line.trim_end_matches('\r'))).collect()
    }
}

/// Returns the rest of the line after `label`, which may be emphasised with asterisks. Returns `None` if the line does
/// not begin with the label.
fn labelled<'a>(line: &'a str, label: &str) -> Option<&'a str> {
    let line = line.trim_start_matches(['*', '#', ' ', '-']);
    let start = line.get(..label.len()).filter(|start| start.eq_ignore_ascii_case(label))?;
    Some(line[start.len()..].trim_matches(['*', ':', ' ', '`']))
}

/// Reads the idea: a line `NAME: …`, and a text that begins with `IDEA: …` and continues to the end of the answer.
///
/// # Errors
/// Returns a sentence that states the missing part.
pub(crate) fn idea(text: &str) -> Result<Idea, String> {
    let lines: Vec<&str> = text.lines().filter(|line| !line.trim().starts_with("```")).collect();
    let name = lines.iter().find_map(|line| labelled(line, "NAME:"));
    let name = name.ok_or("The answer has no line that begins with `NAME:`.")?;
    let at = lines.iter().position(|line| labelled(line, "IDEA:").is_some());
    let at = at.ok_or("The answer has no line that begins with `IDEA:`.")?;
    let first = labelled(lines[at], "IDEA:").unwrap_or_default();
    let rest = lines[at + 1..].iter().take_while(|line| labelled(line, "NAME:").is_none());
    let words: Vec<&str> =
        first.split_whitespace().chain(rest.flat_map(|line| line.split_whitespace())).collect();
    Ok(Idea { name: name.to_owned(), text: words.join(" ") })
}

/// Reads the rules: the last block that contains a game. Returns `None` if there is no such block.
pub(crate) fn rules(text: &str) -> Option<String> {
    blocks(text).iter().rfind(|block| block.is_rules()).map(Block::text)
}

/// Reads the levels: all blocks tagged `level` or, if there are none, all blocks that do not contain a game. Returns
/// `None` if there are no levels.
pub(crate) fn levels(text: &str) -> Option<Levels> {
    let blocks = blocks(text);
    let others = || blocks.iter().filter(|block| !block.is_rules());
    let is_tagged = |block: &&Block<'_>| block.tag.starts_with("level");
    let found: Vec<String> = match others().any(|block| is_tagged(&block)) {
        true => others().filter(is_tagged).map(Block::level).collect(),
        false => others().map(Block::level).collect(),
    };
    let levels: Vec<String> = found.into_iter().filter(|level| !level.is_empty()).collect();
    (!levels.is_empty()).then(|| Levels { levels, rules: rules(text) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ideas() {
        let read =
            idea("Here it is.\n**NAME:** `peat-fire`\nIDEA: Feed the fire,\nbut keep some peat.\n").unwrap();
        assert_eq!(
            (read.name.as_str(), read.text.as_str()),
            ("peat-fire", "Feed the fire, but keep some peat.")
        );
        assert!(idea("NAME: x").unwrap_err().contains("`IDEA:`"));
        assert!(idea("IDEA: x").unwrap_err().contains("`NAME:`"));
    }

    #[test]
    fn the_last_game_counts() {
        let text = "```vgdl\nBasicGame\n  one\n```\nBetter:\n```\nBasicGame\n  two  \n```\n";
        assert_eq!(rules(text).unwrap(), "BasicGame\n  two\n");
        assert_eq!(rules("no game"), None);
        assert_eq!(rules("```vgdl\nBasicGame").unwrap(), "BasicGame\n");
    }

    #[test]
    fn levels_may_come_with_rules() {
        let text =
            "```level\n\nww \nwA\n\n```\n```\na note\n```\n```vgdl\nBasicGame\n```\n```level 2\nw\n```";
        let read = levels(text).unwrap();
        assert_eq!(read.levels, ["ww \nwA\n", "w\n"]);
        assert_eq!(read.rules.unwrap(), "BasicGame\n");
        assert_eq!(levels("```\nww\n```").unwrap().levels, ["ww\n"]);
        assert_eq!(levels("```vgdl\nBasicGame\n```"), None);
    }
}
