//! The forms of a kernel (a hand-written game design): the same dilemma with a different ending, different sprite
//! types, or different moving sprites.

use super::kernel::{Casting, File, LevelFile, VariantFile};
use crate::kernels::words::phrase;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A form as written in its kernel's file.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Form {
    pub(crate) name: String,
    /// The sentence that replaces the kernel's dilemma if the form lacks types that the dilemma mentions.
    dilemma: Option<String>,
    goal: String,
    /// The types missing from the form. Sentences, levels, variants and rules that mention these types are omitted.
    #[serde(default)]
    without: Vec<String>,
    /// `true` if the form has only the levels that are marked as its own.
    #[serde(default)]
    own_levels: bool,
    /// `true` if the form has only the facts that it lists itself.
    #[serde(default)]
    own_facts: bool,
    #[serde(default)]
    facts: Vec<String>,
    #[serde(default)]
    titles: Vec<String>,
    /// Lines for the SpriteSet. A line with the name of a kernel type replaces that type.
    #[serde(default)]
    sprites: String,
    /// Interactions that replace the kernel's interactions between the same types.
    #[serde(default)]
    instead: String,
    /// Interactions to insert before the kernel's interactions.
    #[serde(default)]
    first: String,
    #[serde(default)]
    interactions: String,
    /// The TerminationSet that replaces the kernel's TerminationSet.
    terminations: String,
    #[serde(default)]
    roles: BTreeMap<String, Casting>,
}

impl Form {
    /// Returns the text of the kernel's file with only this form's changes applied.
    pub(crate) fn applied(&self, file: &File) -> File {
        let tells = |text: &str| self.without.iter().any(|stype| phrase::tells_of(text, stype));
        let said = |texts: &[String]| texts.iter().filter(|text| !tells(text)).cloned().collect::<Vec<_>>();
        let is_for = |level: &&LevelFile| match &level.form {
            Some(form) => *form == self.name,
            None => !self.own_levels,
        };
        let names = |rules: &str| rules.split([' ', '\n', '=', ',']).any(|word| self.lacks(word));
        let fits = |variant: &&VariantFile| {
            !tells(&variant.fact)
                && !variant.parts().into_iter().any(names)
                && !variant.roles.values().any(|casting| self.lacks(casting.role()))
        };
        let of_kernel = if self.own_facts { Vec::new() } else { said(&file.facts) };
        let mut roles = file.roles.clone();
        roles.retain(|stype, _| !self.lacks(stype));
        roles.extend(self.roles.clone());
        File {
            dilemma: self.dilemma.clone().unwrap_or_else(|| file.dilemma.clone()),
            goal: self.goal.clone(),
            facts: of_kernel.into_iter().chain(self.facts.clone()).collect(),
            titles: said(&file.titles).into_iter().chain(self.titles.clone()).collect(),
            rules: self.rules(&file.rules),
            whole_rules: file.rules.clone(),
            roles,
            level: file.level.iter().filter(is_for).filter(|level| !tells(&level.asks)).cloned().collect(),
            variant: file.variant.iter().filter(fits).cloned().collect(),
            form: Vec::new(),
            ..file.clone()
        }
    }

    /// Returns the missing types that the form's levels may still name. Such types are omitted from the levels.
    pub(crate) fn absent(&self) -> &[String] {
        &self.without
    }

    fn lacks(&self, word: &str) -> bool {
        self.without.iter().any(|stype| stype == word)
    }

    /// Returns the kernel's rules with the form's changes.
    fn rules(&self, rules: &str) -> String {
        let mut section = "";
        let own: Vec<&str> = self.sprites.lines().filter(|line| !line.trim().is_empty()).collect();
        let is_new = |line: &&&str| !rules.lines().any(|of_kernel| name(of_kernel) == name(line));
        let mut text = String::new();
        for line in rules.lines() {
            let mut add = |line: &str| text.extend([line, "\n"]);
            match line.trim_end() {
                "SpriteSet" => {
                    section = "SpriteSet";
                    add(line);
                }
                "InteractionSet" => {
                    section = "InteractionSet";
                    add(line);
                    add(&self.first);
                    add(&self.instead);
                }
                "TerminationSet" => {
                    section = "TerminationSet";
                    add(&self.interactions);
                    add(line);
                    add(&self.terminations);
                }
                _ if section == "SpriteSet" => {
                    let margin = &line[..line.len() - line.trim_start().len()];
                    // New types come before the avatar, which is drawn above them.
                    if name(line) == "hero" {
                        own.iter()
                            .filter(is_new)
                            .for_each(|new| add(&format!("{margin}{}", new.trim_start())));
                    }
                    match own.iter().find(|own| name(own) == name(line)) {
                        // A replaced type stays in its group.
                        Some(own) => add(&format!("{margin}{}", own.trim_start())),
                        None if self.lacks(name(line)) => {}
                        None => add(line),
                    }
                }
                _ if section == "InteractionSet" => self.interaction(line).iter().for_each(|line| add(line)),
                _ => {}
            }
        }
        text
    }

    /// Returns an InteractionSet line without the types that the form lacks; `None` if nothing remains of the line, or
    /// if the form replaces it.
    fn interaction(&self, line: &str) -> Option<String> {
        let (sides, effect) = line.split_once('>')?;
        let param = |word: &str| {
            word.split_once('=').is_some_and(|(_, value)| value.split(',').any(|name| self.lacks(name)))
        };
        let same = |own: &str| {
            own.split_once('>').is_some_and(|(own, _)| own.split_whitespace().eq(sides.split_whitespace()))
        };
        if self.instead.lines().any(same) {
            return None;
        }
        let mut sides = sides.split_whitespace();
        let first = sides.next()?;
        let partners: Vec<&str> = sides.filter(|name| !self.lacks(name)).collect();
        let stays = !self.lacks(first) && !partners.is_empty() && !effect.split_whitespace().any(param);
        stays.then(|| format!("    {first} {} >{effect}", partners.join(" ")))
    }
}

/// Returns the name at the start of a SpriteSet line.
fn name(line: &str) -> &str {
    line.split_whitespace().next().unwrap_or_default()
}
