//! The meaning of the rules' sentences for choosing a target. Only sentences written by `engine::describe` are read.

use itertools::Itertools;
use regex::{Captures, Regex};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::LazyLock;

/// The beliefs of a player about the things on the board, by name. Sentences that it does not understand are ignored.
#[derive(Debug, Default)]
pub(super) struct Beliefs<'a> {
    /// The current type of the player.
    me: &'a str,
    groups: BTreeMap<&'a str, Vec<&'a str>>,
    /// Things that cannot be entered.
    pub(super) blocks: BTreeSet<&'a str>,
    /// Things that can be pushed.
    pub(super) pushed: BTreeSet<&'a str>,
    /// Things that kill by touch, if the condition holds.
    kills: Vec<(&'a str, Option<ResourceCondition<'a>>)>,
    /// Things that are removed by touch, if the condition holds.
    taken: Vec<(&'a str, Option<ResourceCondition<'a>>)>,
    /// Things whose touch has another effect: on the type of the player, on its resources, or elsewhere.
    pub(super) changes: BTreeSet<&'a str>,
    /// Things whose removal wins the game.
    pub(super) wins: BTreeSet<&'a str>,
    /// Things whose removal loses the game.
    pub(super) must_keep: BTreeSet<&'a str>,
    pub(super) moves: BTreeSet<&'a str>,
    /// Pairs of a thing and another one whose touch removes it.
    removals: Vec<(&'a str, &'a str)>,
    /// The product of the use key.
    pub(super) shot: Option<Shot<'a>>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct ResourceCondition<'a> {
    resource: &'a str,
    least: i32,
    /// `true` if the resource must not be held.
    not: bool,
}

/// The product of the use key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Shot<'a> {
    pub(super) name: &'a str,
    /// `true` if it appears at the player's position, not ahead.
    pub(super) at_player: bool,
    pub(super) ammo: Vec<&'a str>,
    /// `Some` if it moves by itself; the direction is given if it is always the same.
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
    /// The first cannot enter the second.
    Block,
    /// The first is removed by touching the second.
    End,
    EndBoth,
    /// The second pushes the first.
    Push,
    /// Their touch has another effect.
    Change,
    /// The first moves by itself.
    Motion,
}

/// The patterns of the sentences, in the words of `engine::describe`. The first match counts.
static SENTENCES: LazyLock<Vec<(Regex, Subject)>> = LazyLock::new(|| {
    use Subject::{Block, Change, End, EndBoth, Group, Lose, Motion, Push, Win};
    let need = r"(?: (?P<when>if|unless) you hold at least (?P<least>\d+) (?P<resource>\S+?)(?:,.*)?)?";
    let touching = "(?P<one>.+?) (?:die|dies|disappear|disappears) on";
    let all: [(String, Subject); 16] = [
        (r"^Any (?P<one>\S+) means (?P<two>.+)$".into(), Group),
        (r"^You win when (?:no (?P<one>.+) is left|at most \d+ (?P<two>.+) are left)$".into(), Win),
        (r"^You lose when no (?P<one>.+) is left$".into(), Lose),
        (r"^(?P<one>.+) cannot enter (?P<two>.+?)(?:: .*)?$".into(), Block),
        (format!("^{touching} touching (?P<two>.+?){need}$"), End),
        (format!("^{touching} touching (?P<two>.+?) unless .*$"), End),
        (format!("^{touching} running into (?P<two>.+) head-on$"), End),
        (r"^(?P<one>you) die if (?P<two>.+) falls on you from above$".into(), End),
        (r"^(?P<one>.+) and (?P<two>.+) both (?:die|disappear) when they touch$".into(), EndBoth),
        (r"^(?P<one>.+) loses? \d+ health points? on touching (?P<two>.+), and .*$".into(), End),
        (format!("^(?P<two>.+?) collects? (?P<one>.+?){need}$"), End),
        (r"^(?P<two>.+) push(?:es)? (?P<one>.+)$".into(), Push),
        (r"^(?P<one>.+) turns? into .+ on touching (?P<two>.+?)(?:, and .*)?$".into(), Change),
        (r"^(?P<one>.+) gains? \d+ .+ on touching (?P<two>.+?)(?:, and .*)?$".into(), Change),
        (r"^when (?P<one>.+?) touch(?:es)? (?P<two>.+?)(?: and .*)?, .+$".into(), Change),
        (
            r"^the (?P<one>\S+) (?:moves (?:straight|up|left|down|right)|wanders|chases|flees).*$".into(),
            Motion,
        ),
    ];
    let compile = |(pattern, subject): (String, Subject)| {
        let regex = regex::RegexBuilder::new(&pattern).case_insensitive(true).build();
        (regex.expect("a pattern of ours"), subject)
    };
    all.into_iter().map(compile).collect()
});

/// The effect of the use key in the description of the keys.
static USE_KEY: LazyLock<Regex> = LazyLock::new(|| {
    let pattern = r"the use key puts (?:a|an) (?P<shot>\S+?)(?: or .*?)? (?P<place>where you are|ahead of you)(?: and costs (?P<ammo>[^;.]+))?[;.]";
    Regex::new(pattern).expect("a pattern of ours")
});

impl<'a> Beliefs<'a> {
    /// Derives the beliefs of a player of type `me` from sentences. Cost: O(sentences × bytes).
    pub(super) fn of(sentences: &[&'a str], me: &'a str) -> Beliefs<'a> {
        let mut beliefs = Beliefs { me, ..Beliefs::default() };
        let fits = |sentence: &&'a str| {
            // The text after the first full stop is about points.
            let first = sentence.split_once(". ").map_or(*sentence, |(first, _)| first).trim_end_matches('.');
            SENTENCES.iter().find_map(|(regex, subject)| Some((*subject, regex.captures(first)?)))
        };
        let mut read: Vec<(Subject, Captures<'a>)> = sentences.iter().filter_map(fits).collect();
        // Groups have to be known before other sentences are read.
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

    /// Returns `true` if touching it kills, given the resources held.
    pub(super) fn is_deadly(&self, name: &str, held: &BTreeMap<&str, i32>) -> bool {
        applies(&self.kills, name, held)
    }

    /// Returns `true` if touching it removes it, given the resources held.
    pub(super) fn is_taken(&self, name: &str, held: &BTreeMap<&str, i32>) -> bool {
        applies(&self.taken, name, held)
    }

    /// Returns `true` if a shot removes it.
    pub(super) fn is_shot(&self, name: &str) -> bool {
        self.shot.as_ref().is_some_and(|shot| self.removals.contains(&(name, shot.name)))
    }

    /// Returns `true` if it stops a shot.
    pub(super) fn stops_shots(&self, name: &str) -> bool {
        self.shot.as_ref().is_some_and(|shot| self.removals.contains(&(shot.name, name)))
    }

    fn end(&mut self, found: &Captures<'a>) {
        let need = found.name("resource").map(|resource| ResourceCondition {
            resource: resource.as_str(),
            least: found.name("least").and_then(|least| least.as_str().parse().ok()).unwrap_or(1),
            not: found.name("when").is_some_and(|when| when.as_str() == "unless"),
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

    /// Splits `you`, `you as bare`, `the crate or any beast` into parties, with groups expanded.
    fn parties(&self, found: &Captures<'a>, part: &str) -> Vec<Party<'a>> {
        let text = found.name(part).map_or("", |found| found.as_str());
        let words = text.split(" or ").flat_map(|part| part.split(", "));
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
            let name = ["the ", "any ", "an ", "a "].into_iter().find_map(lower).unwrap_or(word);
            match self.groups.get(name) {
                Some(members) => members.iter().copied().map(Party::It).chain([Party::It(name)]).collect(),
                None => vec![Party::It(name)],
            }
        };
        words.flat_map(party).collect()
    }
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
        (held.get(self.resource).copied().unwrap_or(0) >= self.least) != self.not
    }
}
