//! A game's canonical form, as printed by `arcade fmt`.

use crate::problems::{Problem, problems};
use engine::{Diagnostics, syntax};

/// Returns the text in canonical form. Sections are in canonical order, indents are four spaces, and comments
/// are preserved.
///
/// # Errors
///
/// Returns the problems in the text if any line cannot be parsed, because the canonical form would then omit that
/// line.
pub fn format(source: &str) -> Result<String, Vec<Problem>> {
    let (description, found) = syntax::parse(source);
    if Diagnostics::has_errors(&found) {
        return Err(problems(source));
    }
    Ok(syntax::print(&description))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_cannot_be_read_are_not_lost() {
        let source = "BasicGame\n SpriteSet\n   a > Immovable # stone\n LevelMapping\n InteractionSet\n TerminationSet\n";
        assert!(format(source).is_ok_and(|text| text.contains("        a > Immovable  # stone\n")));
        let faulty = source.replace("a > Imm", "a Imm");
        assert!(format(&faulty).is_err_and(|problems| problems[0].code == "missing-arrow"));
    }
}
