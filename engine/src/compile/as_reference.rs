//! Compiles a faulty file in reference mode. Like the reference engine, the compiler reads the sections in
//! file order, and stops at the first fault that the reference does not ignore (`spec/01` §1.4).

use super::header::Header;
use super::interactions::{Partner, Reader, partner};
use super::{
    Fate, Names, Policy, Setting, compile_with, refuse_large, space, sprites, terminations,
    unknown_parameters,
};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::rules::Rules;
use crate::syntax::{Description, InteractionLine, Section, Word};

pub(crate) fn compile_as_reference(description: &Description) -> Result<Rules, Diagnostics> {
    refuse_large(description)?;
    let mut problems = Vec::new();
    let description = &*space::settled(description, Policy::Reference, &mut problems);
    problems.retain(|problem| problem.code == "bad-parameter-values");
    if !problems.is_empty() {
        return Err(Diagnostics::sorted(problems));
    }
    let mut read = Description {
        mapping: Vec::new(),
        interactions: Vec::new(),
        terminations: Vec::new(),
        ..description.clone()
    };
    let counters = Header::of(description, &mut Vec::new()).counters;
    let setting = Setting { policy: Policy::Reference, counters };
    let (types, _) = sprites::types(description, Policy::Reference, &mut Vec::new());
    // Before the SpriteSet, only the built-in types are known.
    let (built_in, _) = sprites::types(&Description::default(), Policy::Reference, &mut Vec::new());
    let mut fate =
        Fate { messages: description.messages + Header::messages(description), dies_at_edge: false };
    let mut at = [0; Section::ALL.len() + 1];
    let mut has_sprites = false;
    for &(section, lines) in &description.order {
        let from = at[section as usize];
        at[section as usize] += lines;
        let lines = from..from + lines;
        let names = Names { types: if has_sprites { &types } else { &built_in } };
        let aborted = match section {
            Section::SpriteSet => {
                has_sprites = true;
                false
            }
            Section::ParameterSet => false,
            Section::LevelMapping => {
                read.mapping.extend_from_slice(&description.mapping[lines]);
                false
            }
            // Without a SpriteSet, there is nothing to add interactions to.
            Section::InteractionSet if !has_sprites => !lines.is_empty(),
            Section::InteractionSet => description.interactions[lines].iter().any(|line| {
                let usable = usable(line, names, setting);
                fate.messages += usable.messages;
                fate.dies_at_edge |= usable.dies_at_edge;
                read.interactions.extend(usable.line);
                usable.aborts
            }),
            Section::TerminationSet => description.terminations[lines].iter().any(|line| {
                let (usable, messages) = terminations::usable(line, names, setting);
                fate.messages += messages;
                if usable {
                    read.terminations.push(line.clone());
                }
                !usable
            }),
        };
        if aborted {
            fate.messages += 1;
            break;
        }
    }
    if !has_sprites {
        let message = "the reference engine gives up on this file before it reads the SpriteSet";
        let problem = Diagnostic::error("missing-section", description.header.class.span, message);
        return Err(Diagnostics(vec![problem.help("put the SpriteSet first")]));
    }
    compile_with(&read, setting.policy, fate, Vec::new())
}

/// The result of reading a line in reference mode.
struct Usable {
    /// The line, reduced to the partners before the first rejected one, or `None` if no partner remains.
    line: Option<InteractionLine>,
    /// The number of messages about parameters that the reference logs.
    messages: u32,
    /// `true` if the reference stops reading at this line.
    aborts: bool,
    /// `true` if the line is about an undeclared sprite at the edge, which crashes the reference in the first
    /// tick (`spec/03` §2).
    dies_at_edge: bool,
}

fn usable(line: &InteractionLine, names: Names<'_>, setting: Setting) -> Usable {
    let mut reader = Reader::new(line, names, setting, 0);
    let built = reader.line(0);
    let failed = built.is_none() || reader.failed;
    let known = built.is_some() && !reader.is_silent();
    let unknown = unknown_parameters(&reader.problems);
    let passes = if line.effect.text == "transformIfCount" { 2 } else { 1 };
    let messages = if known { passes * unknown } else { 0 };
    if failed || line.second.is_empty() {
        return Usable { line: None, messages, aborts: true, dies_at_edge: false };
    }
    let of = |word: &Word| partner(word, names, &mut Vec::new());
    let first = of(&line.first);
    let mut dies_at_edge = false;
    let accepts = |(at, word): &(usize, &Word)| match (first, of(word)) {
        (Partner::Sprite(_), Partner::Sprite(_) | Partner::Edge) | (Partner::Edge, Partner::Sprite(_)) => {
            true
        }
        (_, Partner::Edge) | (Partner::Edge, _) => {
            dies_at_edge = true;
            false
        }
        (Partner::Clock, _) => true,
        // A line is timed only if its first partner is the clock.
        (_, Partner::Clock) => *at == 0,
        (Partner::Unknown, _) | (_, Partner::Unknown) => false,
    };
    let second: Vec<Word> =
        line.second.iter().enumerate().take_while(accepts).map(|(_, word)| word.clone()).collect();
    let aborts = second.len() < line.second.len();
    let line = (!second.is_empty()).then(|| InteractionLine { second, ..line.clone() });
    Usable { line, messages, aborts, dies_at_edge }
}
