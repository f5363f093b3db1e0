//! The texts that examined players read, such as the question and the messages about unusable answers.

use super::recording::Recording;
use super::seen::Seen;
use super::task::{Words, WorldModelTask};
use engine::{Outcome, SPRITE_PARAMETERS, SpriteClass, effect_parameters};
use itertools::Itertools;
use std::collections::BTreeSet;

const INTRODUCTION: &str = "\
Work out the rules of a game from recordings, and write the game in VGDL, the Video Game Description Language.

Your game will be played from the start of the same levels with other actions. The score is the percentage of steps \
after which your game shows the same board, score, resources, health and outcome as the original game.";

const NOTATION: &str = "\
Columns (x) are counted from 0 at the left, and rows (y) from 0 at the top. `(x,y): a -> b` means that the cell \
contained the sprites a before the step, and contains the sprites b after it. The score, the resources that the \
player's sprite holds, and its health are given whenever they change. Each episode starts at the beginning of its level.";

const FORMAT: &str = "\
Write the complete game in one fenced block, in this form:

```
BasicGame
    SpriteSet
        name > Class parameter=value
    LevelMapping
        c > name
    InteractionSet
        first second > effect parameter=value
    TerminationSet
        Termination parameter=value
```

Use the names from the recordings. You may declare further types that are never visible (hidden=True). An effect acts \
on the sprite whose type is written first. The partner EOS is the edge of the board. Every effect accepts \
scoreChange=N. If your game has errors, you will be told the errors, and you can correct the game twice.";

/// Returns the text of the question about a task.
pub(super) fn question(task: &WorldModelTask) -> String {
    let mut parts = vec![INTRODUCTION.to_owned(), levels(task)];
    if let Some(words) = task.words() {
        parts.push(help(&words));
    }
    parts.push(if task.actions == 0 { recordings(task) } else { exploring(task) });
    parts.extend([format!("# Answer\n\n{FORMAT}\n")]);
    parts.join("\n\n")
}

/// Returns the message about actions that the examined player chose.
pub(super) fn played(task: &WorldModelTask, recording: &Recording, left: usize) -> String {
    let next = match left {
        0 => "You have no actions left. Write the game.".to_owned(),
        _ => format!("You have {left} actions left. Play on from the start of a level, or write the game."),
    };
    format!("{}\n\n{next}", recorded(task, recording))
}

/// Explains how to explore the game.
fn exploring(task: &WorldModelTask) -> String {
    let first = task.masked.levels[0].number;
    format!(
        "# Exploring\n\nThere are no recordings. You can play {} actions in total to explore the game. To play, answer \
         only with a line such as:\n\nPLAY {first}: right right up nil\n\nThe number is that of a level, which always \
         starts again from its beginning. The actions are {}. You receive a recording of what happens. Write the game \
         when you know enough.\n\n{NOTATION}",
        task.actions,
        engine::Action::ALL.iter().format(", ")
    )
}

/// Returns the message about an unusable answer.
pub(super) fn complaint(problems: &str) -> String {
    format!(
        "The game cannot be used:\n\n{problems}\n\nCorrect these errors, and write the complete game again."
    )
}

fn levels(task: &WorldModelTask) -> String {
    let mapping = task.masked.mapping.iter().map(|line| format!("    {line}")).join("\n");
    let levels =
        task.masked.levels.iter().map(|level| {
            format!("Level {}:\n\n```\n{}\n```", level.number, level.text.trim_end_matches('\n'))
        });
    format!(
        "# The game\n\nThe names of the sprite types mean nothing, except for `wall` and `avatar` if they occur. \
         {} Each character of a level places the sprites on its line of the LevelMapping. Copy these lines into your \
         game:\n\n{mapping}\n\n{}",
        player(task),
        levels.format("\n\n")
    )
}

fn player(task: &WorldModelTask) -> String {
    let names = players(task).into_iter().map(|name| format!("`{name}`"));
    format!("The player controls {}.", names.collect_vec().join(" or "))
}

/// Returns the names of the types that the player controls at the start of the levels.
pub(super) fn players(task: &WorldModelTask) -> BTreeSet<String> {
    let game = &task.masked.game;
    let at_start = task.masked.levels.iter().filter_map(|level| {
        let state = game.start(&level.level, base::Seed::from_text("start"));
        state.avatar_type().map(|stype| game.name(stype).to_owned())
    });
    at_start.collect()
}

/// Lists the given words, each with its parameters.
fn help(words: &Words) -> String {
    let with = |word: &String, parameters: Vec<&str>| match parameters[..] {
        [] => format!("- {word}"),
        _ => format!("- {word} ({})", parameters.iter().join(", ")),
    };
    let class = |name: &String| {
        let found = SpriteClass::ALL.iter().find(|class| class.name() == name);
        with(name, found.map_or(Vec::new(), |class| class.own_parameters().to_vec()))
    };
    let effect =
        |name: &String| with(name, effect_parameters(name).into_iter().map(|(key, _)| key).collect());
    let termination = |name: &String| with(name, termination_parameters(name).to_vec());
    format!(
        "# Words\n\nThe original game uses words from these lists only. Parameters are given in brackets.\n\n\
         Classes of sprites:\n\n{}\n\nParameters of all classes: {}.\n\nEffects:\n\n{}\n\nTerminations:\n\n{}",
        words.classes.iter().map(class).format("\n"),
        SPRITE_PARAMETERS.iter().format(", "),
        words.effects.iter().map(effect).format("\n"),
        words.terminations.iter().map(termination).format("\n"),
    )
}

fn termination_parameters(name: &str) -> &'static [&'static str] {
    match name {
        "SpriteCounter" | "SpriteCounterMore" => &["stype", "limit", "win"],
        "Timeout" => &["limit", "win"],
        "StopCounter" => &["stype1", "stype2", "stype3", "limit"],
        _ => &["stype1", "stype2", "limit", "win"],
    }
}

fn recordings(task: &WorldModelTask) -> String {
    let episodes = task.recorded.iter().zip(1..).map(|(recording, number)| {
        format!(
            "Episode {number}, level {}:\n\n{}",
            task.masked.levels[recording.level].number,
            recorded(task, recording)
        )
    });
    format!("# Recordings\n\n{NOTATION}\n\n{}", episodes.format("\n\n"))
}

/// Returns the steps of a recording, one per line.
pub(super) fn recorded(task: &WorldModelTask, recording: &Recording) -> String {
    let columns = task.masked.levels[recording.level].level.columns() as u32;
    let first = recording.seen.first().map(|seen| facts(task, None, seen)).filter(|facts| !facts.is_empty());
    let start = first.map(|facts| format!("start: {}", facts.join("; ")));
    let steps = recording.seen.windows(2).zip(&recording.actions).zip(1..).map(|((pair, action), number)| {
        let mut told = cells(task, columns, &pair[0], &pair[1]);
        told.extend(facts(task, Some(&pair[0]), &pair[1]));
        let told = if told.is_empty() { "nothing changes".to_owned() } else { told.join("; ") };
        format!("{number} {action}: {told}")
    });
    start.into_iter().chain(steps).join("\n")
}

fn cells(task: &WorldModelTask, columns: u32, before: &Seen, after: &Seen) -> Vec<String> {
    let contents = |seen: &Seen, cell: u32| {
        let first = seen.board.partition_point(|entry| entry.0 < cell);
        let here = seen.board[first..].iter().take_while(|entry| entry.0 == cell);
        here.map(|entry| task.names[usize::from(entry.1)].as_str()).collect::<Vec<_>>()
    };
    let told = |names: &[&str]| if names.is_empty() { "nothing".to_owned() } else { names.join(" ") };
    let all: BTreeSet<u32> = before.board.iter().chain(&after.board).map(|entry| entry.0).collect();
    let changed = all.into_iter().map(|cell| (cell, contents(before, cell), contents(after, cell)));
    let changed = changed.filter(|(_, old, new)| old != new);
    changed
        .map(|(cell, old, new)| {
            format!("({},{}): {} -> {}", cell % columns, cell / columns, told(&old), told(&new))
        })
        .collect()
}

/// Returns the facts that boards do not show, if they have changed.
fn facts(task: &WorldModelTask, before: Option<&Seen>, after: &Seen) -> Vec<String> {
    let none = Vec::new();
    let (score, resources, health, outcome) = before.map_or((0.0, &none, 0, Outcome::Ongoing), |seen| {
        (seen.score, &seen.resources, seen.health, seen.outcome)
    });
    let mut facts = Vec::new();
    if after.score != score {
        facts.push(format!("score {}", after.score));
    }
    if after.resources != *resources {
        let held = after.resources.iter();
        let held =
            held.map(|(name, amount)| format!("{amount} {}", task.names[usize::from(*name)])).join(" and ");
        facts.push(if held.is_empty() { "holds nothing".to_owned() } else { format!("holds {held}") });
    }
    if after.health != health {
        facts.push(format!("health {}", after.health));
    }
    match after.outcome {
        now if now == outcome => {}
        Outcome::Won => facts.push("the player has won".to_owned()),
        Outcome::Lost => facts.push("the player has lost".to_owned()),
        _ => facts.push("the game has ended without a winner".to_owned()),
    }
    facts
}
