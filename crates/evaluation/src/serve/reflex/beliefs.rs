//! Interprets the sentences of the rules in order to choose a target. Understands only sentences written by
//! `engine::describe`.

use engine::EffectFamily;
use engine::analysis::{EffectSummary, Precondition, Side};
use engine::describe::{Part, Template, plural, templates};
use itertools::Itertools;
use regex::{Captures, Regex};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::LazyLock;

/// A player's beliefs about the sprites on the board, by name. Unknown sentences are ignored.
#[derive(Debug, Default)]
pub(super) struct Beliefs<'a> {
    /// The player's current type.
    me: &'a str,
    groups: BTreeMap<&'a str, Vec<&'a str>>,
    /// The sprites that the player cannot enter.
    pub(super) blocks: BTreeSet<&'a str>,
    /// The sprites that the player can push.
    pub(super) pushed: BTreeSet<&'a str>,
    /// The sprites that kill the player when touched, each with the condition on a resource, if any.
    kills: Vec<(&'a str, Option<ResourceCondition<'a>>)>,
    /// The sprites removed when touched, each with the condition on a resource, if any.
    taken: Vec<(&'a str, Option<ResourceCondition<'a>>)>,
    /// The sprites with any other effect when touched, whether on the player's type, on its resources, or
    /// elsewhere.
    pub(super) changes: BTreeSet<&'a str>,
    /// The sprites whose removal wins the game. Names may be in the singular or the plural, because the rules
    /// contain phrases such as `no lamp` and `at most 2 lamps`.
    wins: BTreeSet<&'a str>,
    /// The sprites whose removal loses the game.
    pub(super) must_keep: BTreeSet<&'a str>,
    pub(super) moves: BTreeSet<&'a str>,
    /// Pairs of sprites in which the first is removed when it touches the second.
    removals: Vec<(&'a str, &'a str)>,
    /// The sprite created by the use key.
    pub(super) shot: Option<Shot<'a>>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct ResourceCondition<'a> {
    resource: &'a str,
    least: i32,
    /// `true` if the condition requires that the resource is not held.
    not: bool,
}

/// A sprite created by the use key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Shot<'a> {
    pub(super) name: &'a str,
    /// `true` if the sprite appears at the player's position rather than ahead of it.
    pub(super) at_player: bool,
    pub(super) ammo: Vec<&'a str>,
    /// `Some` if the sprite moves by itself. The inner value is the direction, if it is constant.
    pub(super) flight: Option<Option<&'a str>>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Party<'a> {
    You,
    It(&'a str),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Subject {
    Group,
    Win,
    Lose,
    /// The first party cannot enter the second party's cell.
    Block,
    /// The first party is removed when it touches the second party.
    End,
    /// The first party is removed when it touches the second party, depending on their movement.
    MayEnd,
    EndBoth,
    /// The second party pushes the first party.
    Push,
    /// A touch between the two parties has an effect other than blocking, removing or pushing.
    Change,
    /// The first party moves by itself.
    Motion,
}

/// The sentence patterns. The first match wins. The patterns for touches come from the
/// templates in `engine::describe`. Templates with more fixed text come first, because they are more
/// specific.
static SENTENCES: LazyLock<Vec<(Regex, Option<Subject>)>> = LazyLock::new(|| {
    use Subject::{Block, Group, Lose, Motion, Win};
    let others = [
        (r"^Any (?P<one>\S+) means (?P<two>.+)$", Group),
        (r"^No (?P<one>\S+) can enter (?P<two>.+?)(?::.*)?$", Block),
        (r"^You win when (?:no (?P<one>.+) is left|at most \d+ (?P<two>.+) (?:is|are) left)$", Win),
        (r"^You lose when no (?P<one>.+) is left$", Lose),
        (
            r"^the (?P<one>\S+) (?:moves (?:straight|up|left|down|right)|wanders|chases|flees|follows).*$",
            Motion,
        ),
    ];
    let others = others.map(|(pattern, subject)| (pattern.to_owned(), Some(subject)));
    let mut meetings = templates();
    meetings.sort_by_key(|template| {
        let length = |part: &Part| if let Part::Text(text) = part { text.len() } else { 0 };
        Reverse(template.parts.iter().map(length).sum::<usize>())
    });
    let meetings = meetings.iter().map(|template| (pattern(template), subject(template)));
    let compile = |(pattern, subject): (String, Option<Subject>)| {
        let regex = regex::RegexBuilder::new(&pattern).case_insensitive(true).build();
        (regex.expect("a pattern of ours"), subject)
    };
    others.into_iter().chain(meetings).map(compile).collect()
});

/// Returns a template's pattern. The groups `one` and `two` match the two sprites. The groups `holds`,
/// `least` and `resource` match the condition on a resource.
fn pattern(template: &Template) -> String {
    let mut named = BTreeSet::new();
    let mut group = |name: &'static str, pattern: &str| {
        if named.insert(name) { format!("(?P<{name}>{pattern})") } else { format!("(?:{pattern})") }
    };
    let part = |part: &Part| match *part {
        Part::Text(text) => regex::escape(text),
        Part::First => group("one", ".+?"),
        Part::Second => group("two", ".+?"),
        Part::Agreeing { with_you, with_it } => {
            let forms = format!("{}|{}", regex::escape(with_you), regex::escape(with_it));
            if with_you == YOU_HOLD { group("holds", &forms) } else { format!("(?:{forms})") }
        }
        Part::Value { name: "least", .. } => group("least", r"-?\d+"),
        Part::Value { name: "resource", .. } => group("resource", r"[^\s,]+"),
        Part::Value { optional_start: Some(start), .. } => format!("(?:{}.*)?", regex::escape(start)),
        Part::Value { optional_start: None, .. } => ".+?".to_owned(),
    };
    format!("^{}$", template.parts.iter().map(part).collect::<String>())
}

/// Returns a template's subject, derived from its effects. Returns `None` if the template is irrelevant to
/// the choice of a target.
fn subject(template: &Template) -> Option<Subject> {
    use EffectSummary as Does;
    let does = |wanted: fn(&Does) -> bool| template.effects.iter().any(wanted);
    let kills_first = does(|effect| matches!(effect, Does::Kill(Side::First) | Does::Collect));
    let wounds = does(|effect| matches!(effect, Does::Health { of: None, by, .. } if *by < 0));
    if template.family == EffectFamily::Block {
        Some(Subject::Block)
    } else if kills_first && does(|effect| *effect == Does::Kill(Side::Second)) {
        Some(Subject::EndBoth)
    } else if kills_first && template.precondition == Precondition::Movement {
        Some(Subject::MayEnd)
    } else if kills_first || wounds {
        Some(Subject::End)
    } else if does(|effect| *effect == Does::Push) {
        Some(Subject::Push)
    } else {
        let changes = |effect: &Does| match effect {
            Does::Change { by, .. } => *by > 0,
            Does::Speed(of) => of.is_some(),
            Does::KillAll(_)
            | Does::Become(_)
            | Does::BecomeAny(_)
            | Does::BecomeAll(..)
            | Does::Make(_)
            | Does::Clone
            | Does::Health { .. } => true,
            Does::Kill(_)
            | Does::Stop
            | Does::Undo(_)
            | Does::Turn
            | Does::Push
            | Does::Carry
            | Does::Teleport
            | Does::Wrap
            | Does::Collect
            | Does::Shield { .. } => false,
        };
        // A template's effects do not include delayed effects or effects elsewhere.
        (template.effects.is_empty() || template.effects.iter().any(changes)).then_some(Subject::Change)
    }
}

/// The words that introduce a condition on the player's resources.
const YOU_HOLD: &str = "you hold";

/// The pattern for the use key's effect in the description of the keys.
static USE_KEY: LazyLock<Regex> = LazyLock::new(|| {
    let pattern = r"the use key puts (?:a|an) (?P<shot>\S+?)(?: or .*?)? (?P<place>where you are|into the cell ahead of you, empty or not)(?:, which costs (?P<ammo>[^;.]+?)(?:, if you hold more than [^;.]+)?)?[;.]";
    Regex::new(pattern).expect("a pattern of ours")
});

impl<'a> Beliefs<'a> {
    /// Derives the beliefs of a player of type `me` from the sentences of the rules. Cost: O(sentences ×
    /// bytes).
    pub(super) fn of(sentences: &[&'a str], me: &'a str) -> Beliefs<'a> {
        let mut beliefs = Beliefs { me, ..Beliefs::default() };
        let fits = |sentence: &&'a str| {
            // The text after the first full stop is about points.
            let first = sentence.split_once(". ").map_or(*sentence, |(first, _)| first).trim_end_matches('.');
            let (subject, found) =
                SENTENCES.iter().find_map(|(regex, subject)| Some((*subject, regex.captures(first)?)))?;
            Some((subject?, found))
        };
        let mut read: Vec<(Subject, Captures<'a>)> = sentences.iter().filter_map(fits).collect();
        // Groups must be known before other sentences are interpreted.
        read.sort_by_key(|(subject, _)| *subject);
        for (subject, found) in read {
            let [one, two] = ["one", "two"].map(|part| beliefs.names(&found, part));
            let [one_is_me, two_is_me] = ["one", "two"].map(|part| beliefs.is_me(&found, part));
            match subject {
                Subject::Group => _ = found.name("one").map(|name| beliefs.groups.insert(name.as_str(), two)),
                Subject::Win => beliefs.wins.extend(one.into_iter().chain(two)),
                Subject::Lose => beliefs.must_keep.extend(one),
                Subject::Block if one_is_me => beliefs.blocks.extend(two),
                Subject::Push if two_is_me => beliefs.pushed.extend(one),
                Subject::Block | Subject::Push => {}
                Subject::End => beliefs.end(&found),
                // Sprites that may kill must be avoided, but sprites that may be removed are not targets.
                Subject::MayEnd if one_is_me => {
                    beliefs.kills.extend(two.into_iter().map(|name| (name, None)))
                }
                Subject::MayEnd => {}
                Subject::EndBoth => beliefs.end_both(&found),
                Subject::Change => {
                    beliefs.changes.extend(two.into_iter().filter(|_| one_is_me));
                    beliefs.changes.extend(one.into_iter().filter(|_| two_is_me));
                }
                Subject::Motion => beliefs.moves.extend(found.name("one").map(|name| name.as_str())),
            }
        }
        beliefs.read_keys(sentences);
        beliefs
    }

    /// Returns `true` if touching the named sprite kills the player, given the held resources.
    pub(super) fn is_deadly(&self, name: &str, held: &BTreeMap<&str, i32>) -> bool {
        applies(&self.kills, name, held)
    }

    /// Returns `true` if touching the named sprite removes it, given the held resources.
    pub(super) fn is_taken(&self, name: &str, held: &BTreeMap<&str, i32>) -> bool {
        applies(&self.taken, name, held)
    }

    /// Returns `true` if removing the named sprite wins the game.
    pub(super) fn is_wanted(&self, name: &str) -> bool {
        self.wins.contains(name) || self.wins.contains(plural(name).as_str())
    }

    /// Returns `true` if a shot would remove the named sprite.
    pub(super) fn is_shot(&self, name: &str) -> bool {
        self.shot.as_ref().is_some_and(|shot| self.removals.contains(&(name, shot.name)))
    }

    /// Returns `true` if the named sprite stops a shot.
    pub(super) fn stops_shots(&self, name: &str) -> bool {
        self.shot.as_ref().is_some_and(|shot| self.removals.contains(&(shot.name, name)))
    }

    fn end(&mut self, found: &Captures<'a>) {
        let holder = found.name("holds").map(|holds| holds.as_str());
        if holder.is_some_and(|holder| !holder.eq_ignore_ascii_case(YOU_HOLD)) {
            // The resources of other sprites are not shown.
            return;
        }
        let need = found.name("resource").filter(|_| holder.is_some()).map(|resource| ResourceCondition {
            resource: resource.as_str(),
            least: found.name("least").and_then(|least| least.as_str().parse().ok()).unwrap_or(1),
            not: found.get(0).is_some_and(|all| all.as_str().contains(" unless ")),
        });
        let (goes, by) = (self.names(found, "one"), self.names(found, "two"));
        if self.is_me(found, "one") {
            self.kills.extend(by.iter().map(|&name| (name, need)));
        }
        if self.is_me(found, "two") {
            self.taken.extend(goes.iter().map(|&name| (name, need)));
        }
        self.removals.extend(goes.iter().copied().cartesian_product(by.iter().copied()));
    }

    fn end_both(&mut self, found: &Captures<'a>) {
        let (one, two) = (self.names(found, "one"), self.names(found, "two"));
        if self.is_me(found, "one") {
            self.kills.extend(two.iter().map(|&name| (name, None)));
        }
        if self.is_me(found, "two") {
            self.kills.extend(one.iter().map(|&name| (name, None)));
        }
        for (one, two) in one.into_iter().cartesian_product(two) {
            self.removals.extend([(one, two), (two, one)]);
        }
    }

    fn read_keys(&mut self, sentences: &[&'a str]) {
        let mine = sentences.iter().find(|line| {
            line.starts_with(&format!("You are the {}:", self.me))
                || line.starts_with(&format!("As {}:", self.me))
        });
        let Some(found) = mine.and_then(|line| USE_KEY.captures(line)) else { return };
        let name = found.name("shot").map_or("", |name| name.as_str());
        let flight = |line: &&'a str| {
            let rest = line.strip_prefix("The ")?.strip_prefix(name)?.strip_prefix(" moves ")?;
            Some(["up", "left", "down", "right"].into_iter().find(|way| rest.starts_with(way)))
        };
        let ammo = found.name("ammo").map_or("", |ammo| ammo.as_str());
        self.shot = Some(Shot {
            name,
            at_player: found.name("place").is_some_and(|place| place.as_str() == "where you are"),
            ammo: ammo
                .split(" or ")
                .flat_map(|part| part.split(", "))
                .map(|part| part.split_once(' ').map_or(part, |(_, name)| name))
                .filter(|name| !name.is_empty())
                .collect(),
            flight: sentences.iter().find_map(flight),
        });
    }

    fn is_me(&self, found: &Captures<'a>, part: &str) -> bool {
        let parties = self.parties(found, part);
        parties.contains(&Party::You) || parties.contains(&Party::It(self.me))
    }

    fn names(&self, found: &Captures<'a>, part: &str) -> Vec<&'a str> {
        self.parties(found, part).into_iter().filter_map(Party::name).collect()
    }

    /// Splits a phrase such as `you`, `you as bare` or `the crate or any beast` into parties. Groups are
    /// expanded to their members.
    fn parties(&self, found: &Captures<'a>, part: &str) -> Vec<Party<'a>> {
        let text = found.name(part).map_or("", |found| found.as_str());
        let words =
            text.split(" or ").flat_map(|part| part.split(" and no ")).flat_map(|part| part.split(", "));
        let party = |word: &'a str| {
            let lower = |prefix: &str| {
                let (head, name) = word.split_at_checked(prefix.len())?;
                head.eq_ignore_ascii_case(prefix).then_some(name)
            };
            if word.eq_ignore_ascii_case("you") {
                return vec![Party::You];
            }
            if let Some(state) = lower("you as ") {
                return vec![Party::It(state)];
            }
            let name = ["the ", "any ", "no ", "an ", "a "].into_iter().find_map(lower).unwrap_or(word);
            match self.groups.get(name) {
                Some(members) => members.iter().copied().map(Party::It).chain([Party::It(name)]).collect(),
                None => vec![Party::It(name)],
            }
        };
        words.flat_map(party).collect()
    }
}

/// Returns `true` if two words are the same noun, in the singular or the plural.
pub(super) fn same_thing(one: &str, other: &str) -> bool {
    one == other || plural(one) == other || plural(other) == one
}

fn applies(to: &[(&str, Option<ResourceCondition<'_>>)], name: &str, held: &BTreeMap<&str, i32>) -> bool {
    to.iter().any(|(other, need)| *other == name && need.is_none_or(|need| need.is_met(held)))
}

impl<'a> Party<'a> {
    fn name(self) -> Option<&'a str> {
        match self {
            Party::You => None,
            Party::It(name) => Some(name),
        }
    }
}

impl ResourceCondition<'_> {
    fn is_met(self, held: &BTreeMap<&str, i32>) -> bool {
        let own = |name: &str| same_thing(name, self.resource);
        let amount: i32 = held.iter().filter(|(name, _)| own(name)).map(|(_, amount)| amount).sum();
        (amount >= self.least) != self.not
    }
}
