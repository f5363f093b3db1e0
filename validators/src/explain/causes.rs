//! Explanations for levels that cannot be won: the chain of causes that the analysis proves, from the
//! termination back to the first obstacle.

use crate::case::Case;
use crate::evidence::{Evidence, Line};
use crate::verdict::{Finding, Verdict};
use engine::analysis::{
    Blocker, Cause, Chain, EffectSummary, Missing, Motion, Obstacle, Shortage, Side, Unpaid, Unreachable,
};
use engine::{Analysis, Game, Level, SpriteClass, SpriteType, describe, swapped_rule};

/// The maximum number of chains to report, one per winning termination.
const MAX_CHAINS: usize = 3;
/// The maximum effort of a search for swapped rules: the number of cells times the number of interactions.
const MAX_EFFORT: usize = 1 << 18;

/// Rewrites the failure of a level that is proven unwinnable. Adds the chain of causes, and the rule whose sides are
/// most likely swapped. All other findings remain unchanged. Cost: several analyses of the level, one per rule.
pub(crate) fn explain(case: Case<'_>, finding: &mut Finding) {
    let Case { game, level, analysis, .. } = case;
    if !matches!(finding.verdict, Verdict::Fail { .. }) || analysis.reach(level).can_win() {
        return;
    }
    let mut evidence = Vec::new();
    let effort = level.cells().len() * game.description().interactions.len();
    if analysis.can_win() && effort <= MAX_EFFORT {
        // If no level of the game can be won, the game's own warnings report it.
        let text = level.to_string();
        let wins = |game: &Game| {
            let level = game.level(&text);
            level.is_ok_and(|level| Analysis::of(game).reach(&level).can_win())
        };
        evidence.extend(swapped_rule(game, wins).map(|swapped| {
            let text = "with the two sides of this rule swapped, the level may be winnable";
            let meant: Vec<String> = swapped.repaired.iter().map(|line| format!("`{line}`")).collect();
            let rule = Line::interaction(game, swapped.line);
            Evidence::new(text).of_rule(rule).advise(format!("did you mean {}?", meant.join(" and ")))
        }));
    }
    let told = describe::hindered_wins(analysis, level, &analysis.reach(level));
    let chains = analysis.causes(level);
    let mut reason = None;
    for (chain, sentence) in chains.iter().zip(&told).take(MAX_CHAINS) {
        let mut words = Explanation { analysis, level, links: Vec::new() };
        words.chain(chain);
        let links: Vec<&str> = words.links.iter().map(|link| link.text.as_str()).collect();
        reason.get_or_insert_with(|| match &chain.obstacles[..] {
            [Obstacle { missing: Missing::Resource(_), .. }, ..] => links.join("; "),
            [] if matches!(chain.cause, Cause::Unpaid(_)) => [links[0], links[links.len() - 1]].join("; "),
            _ => format!("{}: {}", lower(sentence), links.join("; ")),
        });
        let first = words.ending(chain, sentence);
        evidence.push(first);
        evidence.extend(words.links);
    }
    let Some(reason) = reason else { return };
    finding.verdict = Verdict::fail(format!("the level cannot be won: {reason}"));
    finding.evidence = evidence;
}

/// Returns a sentence in a form that can be appended to another sentence.
pub(crate) fn lower(sentence: &str) -> String {
    let mut characters = sentence.trim_end_matches('.').chars();
    characters.next().map_or(String::new(), |first| first.to_lowercase().chain(characters).collect())
}

/// The causes in a chain, as text.
struct Explanation<'a> {
    analysis: &'a Analysis,
    level: &'a Level,
    links: Vec<Evidence>,
}

impl Explanation<'_> {
    /// Returns the termination, with the first sprite that would need to be removed.
    fn ending(&self, chain: &Chain, sentence: &str) -> Evidence {
        let goal = &self.analysis.goals()[chain.goal];
        let cell = match &chain.cause {
            Cause::Permanent(sprites) => sprites.first().map(|(_, cell)| self.place(*cell)),
            Cause::AtMost(_) | Cause::Unpaid(_) => None,
        };
        let rule = Some(Line::termination(self.analysis.game(), goal.line));
        let text = sentence.trim_end_matches('.').to_owned();
        Evidence { text, cell, rule, ..Evidence::default() }
    }

    fn chain(&mut self, chain: &Chain) {
        if let Cause::Unpaid(unpaid) = &chain.cause {
            return self.unpaid(unpaid);
        }
        if !chain.obstacles.is_empty() {
            return chain.obstacles.iter().for_each(|obstacle| self.obstacle(obstacle));
        }
        let (text, advice) = match &chain.cause {
            Cause::Permanent(sprites) => {
                let name = sprites.first().map_or("sprite", |(stype, _)| self.name(*stype));
                let target = sprites.first().map(|(stype, _)| *stype);
                match target.is_some_and(|stype| self.is_ended(stype)) {
                    true => (
                        format!("no rule that removes {} can run on this sprite", article(name)),
                        "open a path to this sprite, or remove it".to_owned(),
                    ),
                    false => (
                        format!("no rule removes {}", article(name)),
                        format!("add a rule that removes `{name}`"),
                    ),
                }
            }
            Cause::AtMost(_) | Cause::Unpaid(_) => (
                "no rule creates more of the counted sprites".to_owned(),
                "place more of the counted sprites, or lower the limit".to_owned(),
            ),
        };
        self.links.push(Evidence::new(text).advise(advice));
    }

    /// Adds the removals that cost more of a resource than is available.
    fn unpaid(&mut self, unpaid: &Unpaid) {
        let Unpaid { target, removals, resource, each, most, removing, taking } = unpaid;
        let (game, name) = (self.analysis.game(), self.name(*resource).to_owned());
        let target = self.name(*target).to_owned();
        let text = format!(
            "{} must be removed, and each removal takes {}",
            count(*removals, &target),
            count(*each, &name)
        );
        let rule = removing.first().map(|&line| Line::interaction(game, line));
        self.links.push(Evidence { rule, ..Evidence::new(text) });
        if let Some(&line) = taking.iter().find(|line| !removing.contains(line)) {
            let text = format!("this rule takes {}", count(*each, &name));
            self.links.push(Evidence::new(text).of_rule(Line::interaction(game, line)));
        }
        let wanted = removals.saturating_mul(*each);
        let text = format!(
            "{wanted} would be needed, but {} can be collected",
            if *most == 0 { "none".to_owned() } else { format!("only {most}") }
        );
        let advice = format!(
            "place {} more, or {} fewer",
            count(wanted - most, &name),
            count(removals - most / each, &target)
        );
        self.links.push(Evidence::new(text).advise(advice));
    }

    /// Returns `true` if a rule removes sprites of the type.
    fn is_ended(&self, stype: SpriteType) -> bool {
        let applies = |written: SpriteType| self.analysis.applies(written, stype);
        self.analysis.encounters().iter().any(|encounter| {
            encounter.ends(Side::First) && applies(encounter.first)
                || encounter.ends(Side::Second) && encounter.second.is_some_and(applies)
                || encounter.does(|effect| match effect {
                    EffectSummary::KillAll(all) | EffectSummary::BecomeAll(all, _) => *all == stype,
                    EffectSummary::Health { of: Some(of), .. } => applies(*of),
                    _ => false,
                })
        })
    }

    fn obstacle(&mut self, obstacle: &Obstacle) {
        let Obstacle { target, line, missing } = obstacle;
        let rule = line.map(|line| Line::interaction(self.analysis.game(), line));
        match missing {
            Missing::Resource(shortage) => self.shortage(*target, rule, shortage),
            Missing::Unreachable(unreachable) => {
                let there = self.standing(unreachable.cell, *target);
                let text = format!("{} cannot reach {}", self.acting(unreachable.stype), self.the(there));
                self.unreachable(unreachable, text, rule);
            }
            Missing::Blocked(stype, by) => {
                let by = Line::interaction(self.analysis.game(), *by);
                let text = format!(
                    "{} is put back from {} by `{}` before a later rule can remove that sprite",
                    self.acting(*stype),
                    self.the(*target),
                    by.text
                );
                let advice = format!("move the rule that removes `{}` before that one", self.name(*target));
                self.links.push(Evidence::new(text).of_rule(by).advise(advice));
            }
            Missing::Absent(absent) => {
                let name = self.name(*absent);
                let what = match line {
                    Some(_) => format!("a rule on {} needs {}", self.the(*target), article(name)),
                    None => format!("{} makes {}", article(name), article(self.name(*target))),
                };
                let text = format!("{what}; the level does not place this type, and no rule creates it");
                let advice = format!("place {} in the level", article(name));
                self.links.push(Evidence { rule, ..Evidence::new(text) }.advise(advice));
            }
            Missing::Unmade(unmade, obstacles) => {
                let name = self.name(*unmade);
                let text = format!(
                    "a rule on {} needs {}, but no such sprite can exist",
                    self.the(*target),
                    article(name)
                );
                self.links.push(Evidence { rule, ..Evidence::new(text) });
                obstacles.iter().for_each(|obstacle| self.obstacle(obstacle));
            }
            Missing::Inside => {
                let text = format!("this {} never reaches the edge of the screen", self.name(*target));
                self.links.push(
                    Evidence { rule, ..Evidence::new(text) }.advise("open a path to the edge of the screen"),
                );
            }
            Missing::Nowhere(first, second) => {
                let second = second.map_or("the edge of the screen".to_owned(), |second| self.acting(second));
                let text = format!("{} and {second} never meet", self.acting(*first));
                self.links.push(Evidence { rule, ..Evidence::new(text) }.advise("open a path between them"));
            }
        }
    }

    /// Adds a required resource that cannot be obtained.
    fn shortage(&mut self, target: SpriteType, rule: Option<Line>, shortage: &Shortage) {
        let Shortage { resource, needed, capacity, most, rules, sources } = shortage;
        let name = self.name(*resource).to_owned();
        let still = self.analysis.facts(target).motion == Motion::Still;
        let verb = if still { "opens" } else { "is removed" };
        let text = format!("{} {verb} for {}", self.the(target), count(i64::from(*needed), &name));
        self.links.push(Evidence { rule, ..Evidence::new(text) });
        let class = self.analysis.game().class(*resource);
        if let Some(class) = class.filter(|class| capacity.is_some() && !class.is_a(SpriteClass::Resource)) {
            let text = format!("collectResource collects only a Resource; {name} is {}", class.name());
            let advice = format!("make it a Resource: `{name} > Resource limit={needed}`");
            let rule = Line::sprite(self.analysis.game(), &name);
            self.links.push(Evidence { rule, ..Evidence::new(text) }.advise(advice));
            return;
        }
        if let Some(capacity) = capacity {
            let text = format!("the avatar can hold at most {}", count(i64::from(*capacity), &name));
            let advice = format!("raise the `limit=` of `{name}` to {needed}, or require fewer");
            let rule = Line::sprite(self.analysis.game(), &name);
            self.links.push(Evidence { rule, ..Evidence::new(text) }.advise(advice));
            return;
        }
        if rules.is_empty() {
            let text = format!("no rule gives {}", article(&name));
            let advice = format!("add a rule that gives `{name}`");
            self.links.push(Evidence::new(text).advise(advice));
            return;
        }
        let all: i64 = sources.iter().map(|source| source.each * i64::from(source.count)).sum();
        let verb = if all < 2 { "exists" } else { "exist" };
        let text = format!("{} {verb}", if all == 0 { format!("no {name}") } else { count(all, &name) });
        let cell = sources.first().map(|source| self.place(source.cell));
        let rule = rules.first().map(|&line| Line::interaction(self.analysis.game(), line));
        self.links.push(Evidence { cell, rule, ..Evidence::new(text) });
        let lost: Vec<_> =
            sources.iter().filter_map(|source| Some((source, source.unreachable.as_ref()?))).collect();
        for (source, unreachable) in &lost {
            let text =
                format!("{} cannot reach the {}", self.acting(unreachable.stype), self.name(source.stype));
            self.unreachable(unreachable, text, None);
        }
        if !lost.is_empty() && *most > 0 {
            self.links.push(Evidence::new(format!("{most} can be collected")));
        }
        let missing = count(i64::from(*needed) - all, &name);
        let advice = match (lost.is_empty(), *most) {
            (true, 0) => format!("place {missing}"),
            (true, most) => format!("place {missing} more, or require only {most}"),
            (false, _) => format!("open a path to {}, or place more where it can be reached", article(&name)),
        };
        self.links.push(Evidence::new("no rule creates more").advise(advice));
    }

    /// Adds a position that a sprite never reaches, with the obstacle.
    fn unreachable(&mut self, unreachable: &Unreachable, text: String, rule: Option<Line>) {
        let cell = Some(self.place(unreachable.cell));
        let link = Evidence { cell, rule, ..Evidence::new(text) };
        // If there are several sources, the advice is part of the shortage.
        let alone = unreachable.blockers.is_empty() && link.rule.is_some();
        self.links.push(if alone { link.advise("open a path to it") } else { link });
        for Blocker { stype, cell, obstacles } in &unreachable.blockers {
            let name = self.name(*stype);
            let again = obstacles.is_empty();
            let text = format!("{} {name} is in the way", if again { "that" } else { "the" });
            let link = Evidence { cell: Some(self.place(*cell)), ..Evidence::new(text) };
            let advice = format!("make whatever opens the {name} reachable without passing it");
            self.links.push(if again { link.advise(advice) } else { link });
            obstacles.iter().for_each(|obstacle| self.obstacle(obstacle));
        }
    }

    /// Returns the type if the level places it in the cell. Otherwise, returns the cell's topmost type.
    fn standing(&self, cell: usize, stype: SpriteType) -> SpriteType {
        let places = self.analysis.game().places(self.level.cells()[cell]);
        let known = places.contains(&stype) || places.is_empty();
        if known { stype } else { places[places.len() - 1] }
    }

    fn name(&self, stype: SpriteType) -> &str {
        self.analysis.game().name(stype)
    }

    fn the(&self, stype: SpriteType) -> String {
        format!("the {}", self.name(stype))
    }

    /// Describes the acting sprite, which is either the avatar (under any name) or sprites of a type.
    fn acting(&self, stype: SpriteType) -> String {
        let own = self.analysis.avatars().iter().any(|avatar| self.analysis.applies(stype, avatar.stype));
        if own { "the avatar".to_owned() } else { self.the(stype) }
    }

    /// Returns a cell's column and row, counted from 1.
    fn place(&self, cell: usize) -> (usize, usize) {
        (cell % self.level.columns() + 1, cell / self.level.columns() + 1)
    }
}

/// Returns a number with a noun: `1 lamp`, `2 lamps`, `2 boxes`, `2 pennies`.
fn count(number: i64, name: &str) -> String {
    if number == 1 {
        return format!("1 {name}");
    }
    let stem = name.strip_suffix('y').filter(|stem| !stem.ends_with(['a', 'e', 'i', 'o', 'u']));
    match stem {
        Some(stem) => format!("{number} {stem}ies"),
        None if ["s", "x", "z", "ch", "sh"].iter().any(|end| name.ends_with(end)) => {
            format!("{number} {name}es")
        }
        None => format!("{number} {name}s"),
    }
}

/// Returns a noun with its indefinite article: `a lamp`, `an exit`.
fn article(name: &str) -> String {
    let vowel = name.starts_with(['a', 'e', 'i', 'o', 'u', 'A', 'E', 'I', 'O', 'U']);
    format!("{} {name}", if vowel { "an" } else { "a" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_get_their_plural() {
        let words = [count(1, "lamp"), count(2, "lamp"), count(3, "penny"), count(2, "box"), count(0, "key")];
        assert_eq!(words, ["1 lamp", "2 lamps", "3 pennies", "2 boxes", "0 keys"]);
        assert_eq!([article("exit"), article("lamp")], ["an exit", "a lamp"]);
    }
}
