//! Evidence of other dialects: words that exist in a dialect but not in VGDL.

use super::{Dialect, python_file};
use crate::diagnostic::{Diagnostic, Span};
use crate::syntax::Description;
use std::collections::BTreeSet;

/// Words of py-vgdl, each of which is sufficient evidence on its own.
const PY_VGDL: [&str; 17] = [
    "block_size",
    "AStarChaser",
    "WalkJumper",
    "RotatingAvatar",
    "RotatingFlippingAvatar",
    "NoisyRotatingFlippingAvatar",
    "AimedFlakAvatar",
    "VGDLSprite",
    "OrientedSprite",
    "conveySprite",
    "windGust",
    "slipForward",
    "limitspeed",
    "GridPhysics",
    "ContinuousPhysics",
    "NoFrictionPhysics",
    "GravityPhysics",
];
/// Words of py-vgdl that authors may also invent independently. Only two or more such words are sufficient
/// evidence.
const PY_VGDL_MAYBE: [&str; 4] = ["frame_rate", "MarioAvatar", "InertialAvatar", "killIfOtherHasLess"];
/// Words that occur in EMPA's games.
const EMPA: [&str; 2] = ["bonus", "NoveltyTermination"];
const EMPA_MAYBE: [&str; 2] = ["nothing", "changeScore"];
/// The maximum number of words listed in a message.
const SHOWN: usize = 4;

/// Returns the problems in a faulty game, starting with the one about its dialect. Python files and
/// multiplayer games cannot be repaired line by line. For such files, returns only the problem that reports
/// the kind of file.
pub(crate) fn told(
    source: &str,
    description: &Description,
    mut problems: Vec<Diagnostic>,
) -> Vec<Diagnostic> {
    let start = description.header.class.span;
    if ["\"\"\"", "'''"].iter().any(|mark| source.contains(mark))
        && let Some(file) = python_file(source)
    {
        let message =
            format!("this is a Python file; its game is in a string that starts in line {}", file.line);
        return vec![other_dialect(start, message, Dialect::PyVgdl)];
    }
    if is_of_several_players(description) {
        problems.retain(|problem| problem.code == "unsupported");
        return problems;
    }
    if let Some((dialect, words)) = dialect(description) {
        let words: Vec<String> = words.iter().take(SHOWN).map(|word| format!("`{word}`")).collect();
        let message = format!("this game is in the dialect of {}", dialect.name());
        let problem = other_dialect(start, message, dialect);
        // The help, not the message, lists the dialect's words, so that the message stays the same when one
        // of them is fixed.
        let help = format!(
            "{}; words of this dialect: {}",
            problem.help.as_deref().unwrap_or_default(),
            words.join(", ")
        );
        problems.insert(0, problem.help(help));
    }
    problems
}

/// Returns `true` if the game's first line declares a multiplayer game.
pub(crate) fn is_of_several_players(description: &Description) -> bool {
    let players = description.header.params.iter().filter(|param| param.key.text == "no_players");
    players.filter_map(|param| param.value.text.parse::<i64>().ok()).any(|players| players > 1)
}

fn other_dialect(span: Span, message: String, dialect: Dialect) -> Diagnostic {
    let help = format!(
        "`arcade fmt --from {} GAME` converts everything with an exact equivalent, and lists the rest",
        dialect.flag()
    );
    Diagnostic::error("other-dialect", span, message).help(help)
}

/// Returns a game's dialect, with the words that reveal the dialect; `None` if no words reveal a dialect.
fn dialect(description: &Description) -> Option<(Dialect, Vec<&str>)> {
    let lines = description.sprite_lines();
    let declared: BTreeSet<&str> = lines.iter().map(|(_, line)| line.name.text.as_str()).collect();
    let mut words: Vec<&str> =
        description.header.params.iter().map(|param| param.key.text.as_str()).collect();
    for (_, line) in &lines {
        words.extend(line.class.iter().map(|class| class.text.as_str()));
        let physics = line.params.iter().filter(|param| param.key.text == "physicstype");
        words.extend(physics.map(|param| param.value.text.as_str()));
    }
    for line in &description.interactions {
        words.push(&line.effect.text);
        let speed = line.params.iter().map(|param| param.key.text.as_str());
        words.extend(speed.filter(|key| *key == "limitspeed"));
    }
    let mut ends: Vec<&str> = Vec::new();
    for line in &description.terminations {
        words.push(&line.class.text);
        ends.extend(line.params.iter().map(|param| param.key.text.as_str()).filter(|key| *key == "bonus"));
    }
    words.extend(ends);
    words.retain(|word| !declared.contains(word));
    let mut seen = BTreeSet::new();
    words.retain(|word| seen.insert(*word));
    let among = |sure: &[&str], maybe: &[&str]| -> Vec<&str> {
        let found: Vec<&str> =
            words.iter().copied().filter(|word| sure.contains(word) || maybe.contains(word)).collect();
        let enough = found.len() > 1 || found.iter().any(|word| sure.contains(word));
        if enough { found } else { Vec::new() }
    };
    let (empa, py_vgdl) = (among(&EMPA, &EMPA_MAYBE), among(&PY_VGDL, &PY_VGDL_MAYBE));
    match (empa.is_empty(), py_vgdl.is_empty()) {
        (true, true) => None,
        (true, false) => Some((Dialect::PyVgdl, py_vgdl)),
        (false, _) => Some((Dialect::Empa, empa.into_iter().chain(py_vgdl).collect())),
    }
}
