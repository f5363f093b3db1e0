//! Claims extracted from the texts that users see, and from the proofs in the analysis.

use super::{Case, Claim, Ending, Fact, Policy, Provided, Tie, Unless, When};
use base::Seed;
use engine::analysis::{Cause, Chain, Missing, Obstacle, Spatiality, Steering, Unreachable};
use engine::describe::{self, Guide, plural};
use engine::{Action, Diagnostic, Game, SpriteType};

/// Returns all claims about a case, and the number of sentences about endings that cannot be parsed.
pub fn claims(case: &Case) -> (Vec<Claim>, usize) {
    let mut reader = Reader { case, claims: Vec::new(), unread: 0 };
    let guide = Guide::from_analysis(&case.analysis);
    reader.endings(&guide);
    reader.controls(&guide);
    reader.sprites(&guide);
    reader.meetings(&guide);
    reader.groups(&guide);
    reader.kind(&guide);
    reader.analysis();
    reader.level();
    case.game.warnings().iter().for_each(|warning| reader.warning(warning));
    case.level.warnings().iter().for_each(|warning| reader.warning(warning));
    (reader.claims, reader.unread)
}

struct Reader<'a> {
    case: &'a Case,
    claims: Vec<Claim>,
    unread: usize,
}

/// Returns the types in a list of names such as `a, b or c`. `several` is `true` if the names are in the
/// plural.
fn listed(game: &Game, text: &str, several: bool) -> Option<Vec<SpriteType>> {
    let find = |name: &str| {
        let name = name.strip_prefix("no ").unwrap_or(name);
        let is_meant = |stype: &SpriteType| {
            if several { plural(game.name(*stype)) == name } else { game.name(*stype) == name }
        };
        game.sprite_types().find(is_meant)
    };
    let repeated = |item: &str| {
        let (name, times) = item.split_once(" (each counted ").unwrap_or((item, "1 times)"));
        let times: usize = times.split(' ').next()?.parse().ok()?;
        Some(vec![find(name)?; times])
    };
    Some(items(text).map(repeated).collect::<Option<Vec<_>>>()?.concat())
}

/// Returns the items of a list such as `a, b or c` or `a, b and c`.
fn items(text: &str) -> impl Iterator<Item = &str> {
    text.split(", ").flat_map(|part| part.split(" or ")).flat_map(|part| part.split(" and "))
}

/// Parses a sentence about an ending; `None` for any other sentence.
pub(super) fn ending(game: &Game, avatars: &[SpriteType], text: &str) -> Option<Ending> {
    let text = text.strip_suffix('.')?;
    let (win, text) = match text.strip_prefix("You win ") {
        Some(rest) => (true, rest),
        None => (false, text.strip_prefix("You lose ")?),
    };
    let (text, unless) = match text.split_once(", unless there ") {
        Some((text, rest)) => (text, Some(unless(game, rest)?)),
        None => (text, None),
    };
    let provisos = [
        (", if your score is not 0", Provided::Score),
        (" and your score is 0", Provided::NoScore),
        (", if the counters are not all the same", Provided::Difference),
        (" and the counters are all the same", Provided::NoDifference),
    ];
    let values = [(", if the counter is at ", true), (" and the counter is not at ", false)];
    let known = provisos.iter().find_map(|(words, provided)| Some((text.strip_suffix(words)?, *provided)));
    let known = known.or_else(|| {
        values.iter().find_map(|(words, is_at)| {
            let (text, value) = text.split_once(words)?;
            let value = value.parse().ok()?;
            Some((text, if *is_at { Provided::Value(value) } else { Provided::OtherValue(value) }))
        })
    });
    let (text, provided) = known.unwrap_or((text, Provided::Always));
    let (text, kinds) = match text.split_once(", of exactly ") {
        Some((text, kinds)) => (text, Some(kinds.split(' ').next()?.parse().ok()?)),
        None => (text, None),
    };
    let ticks = text.strip_prefix("if you last until tick ");
    let ticks = ticks.or_else(|| text.strip_prefix("when tick ")?.strip_suffix(" is reached"));
    let when = if let Some(ticks) = ticks {
        When::Ticks(ticks.parse().ok()?)
    } else if text == "when you are gone" {
        When::AtMost(avatars.to_vec(), 0)
    } else if let Some(name) = text.strip_prefix("when no ") {
        When::AtMost(listed(game, name.strip_suffix(" is left")?, false)?, 0)
    } else {
        // If the sentence ends with "left", the words are removed.
        let text = text.strip_suffix(" are left").or_else(|| text.strip_suffix(" is left")).unwrap_or(text);
        let text = text.strip_prefix("when ")?;
        let text = text.strip_prefix("there are ").or_else(|| text.strip_prefix("there is ")).unwrap_or(text);
        let (how, rest) = match text.strip_prefix("at most ") {
            Some(rest) => (0, rest),
            None => match text.strip_prefix("at least ") {
                Some(rest) => (1, rest),
                None => (2, text.strip_prefix("only ").or_else(|| text.strip_prefix("exactly "))?),
            },
        };
        let (number, names) = rest.split_once(' ')?;
        let number: i64 = number.parse().ok()?;
        let types = listed(game, names, number != 1)?;
        match how {
            0 => When::AtMost(types, number),
            1 => When::AtLeast(types, number),
            _ => When::Exactly(types, number),
        }
    };
    Some(Ending { win, when, kinds, provided, unless })
}

/// Parses the exception under which an ending does not count.
fn unless(game: &Game, text: &str) -> Option<Unless> {
    let (text, not_first) = match text.strip_suffix(", and not in the first tick") {
        Some(text) => (text, true),
        None => (text, false),
    };
    let (text, before) = match text.strip_suffix(" at the end of the tick before") {
        Some(text) => (text, true),
        None => (text, false),
    };
    let (_, text) = text.split_once(' ')?;
    let (exactly, text) = match text.strip_prefix("exactly ") {
        Some(text) => (true, text),
        None => (false, text.strip_prefix("more than ")?),
    };
    let (number, names) = text.split_once(' ')?;
    let number: i64 = number.parse().ok()?;
    let types = listed(game, names, number != 1)?;
    let when = if exactly { When::Exactly(types, number) } else { When::AtLeast(types, number + 1) };
    Some(Unless { when, before, not_first })
}

impl Reader<'_> {
    fn claim(&mut self, text: impl Into<String>, fact: Fact) {
        self.claims.push(Claim { text: text.into(), fact });
    }

    fn game(&self) -> &Game {
        &self.case.game
    }

    /// Returns the types to which a rule about `written` applies.
    fn family(&self, written: SpriteType) -> Vec<SpriteType> {
        self.game().sprite_types().filter(|&stype| self.case.analysis.applies(written, stype)).collect()
    }

    fn endings(&mut self, guide: &Guide) {
        let sentences: Vec<&String> = guide.winning.iter().chain(&guide.losing).collect();
        let avatars: Vec<SpriteType> =
            self.case.analysis.avatars().iter().map(|avatar| avatar.stype).collect();
        let read: Option<Vec<Ending>> =
            sentences.iter().map(|sentence| ending(self.game(), &avatars, sentence)).collect();
        let tie = guide.order.iter().find_map(|line| match line.as_str() {
            "If you win and lose in the same tick, you lose." => Some(Tie::Lost),
            "If you win and lose in the same tick, you win." => Some(Tie::Won),
            _ => None,
        });
        let text = || sentences.iter().map(|line| line.as_str()).collect::<Vec<_>>().join(" ");
        match read {
            // The level has an avatar that the sentences do not describe.
            Some(_) if self.uses_idle_default(b'A') => {}
            Some(endings) => self.claim(text(), Fact::Endings(endings, tie.unwrap_or(Tie::Open))),
            None => self.unread += 1,
        }
        for sentence in &sentences {
            if sentence.contains(" only ")
                && let Some(Ending { when: When::Exactly(types, _), .. }) =
                    ending(self.game(), &avatars, sentence)
            {
                self.claim(sentence.as_str(), Fact::OnlyFalls(types));
            }
        }
    }

    /// Returns `true` if the level uses a built-in character that the game itself does not use. Claims assume
    /// that levels use no such characters.
    fn uses_idle_default(&self, symbol: u8) -> bool {
        let facts = |&stype: &SpriteType| self.case.analysis.facts(stype);
        let is_idle =
            self.game().places(symbol).iter().map(facts).any(|facts| !facts.symbols.contains(&symbol));
        is_idle && self.case.level.cells().contains(&symbol)
    }

    fn controls(&mut self, guide: &Guide) {
        let avatars = self.case.analysis.avatars();
        let types: Vec<SpriteType> = avatars.iter().map(|avatar| avatar.stype).collect();
        if self.uses_idle_default(b'A') {
            return;
        }
        self.claim(guide.controls.join(" "), Fact::OnlyAvatars(types.clone()));
        if avatars.is_empty() && guide.controls.iter().any(|line| line.contains("no key does anything")) {
            self.claim(guide.controls.join(" "), Fact::DeadKeys);
        }
        let [avatar] = avatars else { return };
        let [text] = &guide.controls[..] else { return };
        let steering = avatar.steering;
        if text.contains("no key does anything")
            || text.contains("no key changes that") && !text.contains(';')
        {
            self.claim(text.as_str(), Fact::DeadKeys);
        }
        if text.contains("you stay where you are") {
            self.claim(text.as_str(), Fact::Stands(types[0]));
        }
        // A glide, a shot or a turn on the spot may still depend on the other keys.
        match steering {
            Steering::Horizontal if text.contains("the arrow keys move you left and right") => {
                self.claim(text.as_str(), Fact::IdleKeys(vec![Action::Up, Action::Down]));
            }
            Steering::Vertical if text.contains("the arrow keys move you up and down") => {
                self.claim(text.as_str(), Fact::IdleKeys(vec![Action::Left, Action::Right]));
            }
            _ => {}
        }
        if !avatar.has_use() && !text.contains("the use key") {
            self.claim(text.as_str(), Fact::IdleKeys(vec![Action::Use]));
        }
    }

    fn sprites(&mut self, guide: &Guide) {
        for line in &guide.sprites {
            if line == "Everything else does nothing by itself." {
                for stype in self.others(guide) {
                    self.claim(line.as_str(), Fact::Stands(stype));
                }
            }
            let Some(rest) = line.strip_prefix("The ").and_then(|line| line.strip_suffix('.')) else {
                continue;
            };
            let Some((name, parts)) = rest.split_once(' ') else { continue };
            let Some(stype) = self.game().sprite_type(name) else { continue };
            for part in parts.split("; ") {
                let number = |start: &str| {
                    let rest = part.strip_prefix(start)?;
                    rest.split([',', ' ', '.']).next()?.parse::<i64>().ok()
                };
                if part.starts_with("only one exists at a time")
                    || part.starts_with("exists only once at a time")
                {
                    self.claim(line.as_str(), Fact::Single(vec![stype]));
                } else if part == "cannot be seen" && self.game().is_hidden(stype) {
                    self.claim(line.as_str(), Fact::Unseen(stype));
                } else if let Some(limit) = number("can be held, up to ") {
                    self.claim(line.as_str(), Fact::HeldAtMost(stype, limit.max(0)));
                }
            }
        }
        if guide.order.first().is_some_and(|line| !line.contains("the others act")) {
            self.claim(guide.order[0].as_str(), Fact::OthersIdle);
        }
    }

    /// Returns the types other than avatars that can occur without a line of their own.
    fn others(&self, guide: &Guide) -> Vec<SpriteType> {
        let analysis = &self.case.analysis;
        let has_line = |stype: SpriteType| {
            let start = format!("The {} ", self.game().name(stype));
            guide.sprites.iter().any(|line| line.starts_with(&start))
        };
        let is_you = |stype| analysis.avatars().iter().any(|avatar| avatar.stype == stype);
        let all = self.game().sprite_types().filter(|&stype| analysis.facts(stype).possible);
        all.filter(|&stype| !is_you(stype) && !has_line(stype)).collect()
    }

    fn groups(&mut self, guide: &Guide) {
        for line in &guide.groups {
            let Some((name, members)) = line.strip_prefix("Any ").and_then(|rest| rest.split_once(" means "))
            else {
                continue;
            };
            let Some(group) = self.game().sprite_type(name) else { continue };
            if let Some(Some(types)) = self.party(members.trim_end_matches('.')) {
                self.claim(line.as_str(), Fact::OnlyMembers(group, types));
            }
        }
    }

    /// Returns the types that the subject or object of a sentence denotes, or `None` for the edge.
    fn party(&self, text: &str) -> Option<Option<Vec<SpriteType>>> {
        if text == "the edge of the board" {
            return Some(None);
        }
        let (mut types, mut are_forms) = (Vec::new(), false);
        for item in items(text) {
            if item == "you" {
                types.extend(self.case.analysis.avatars().iter().map(|avatar| avatar.stype));
                continue;
            }
            // Sentences name each form of the player that is meant, so the name of a parent type means no other form.
            let form = item.strip_prefix("you as ");
            let named = ["the ", "any ", "no "].into_iter().find_map(|start| item.strip_prefix(start));
            are_forms = form.is_some() || are_forms && named.is_none();
            let stype = self.game().sprite_type(form.or(named).unwrap_or(item))?;
            types.extend(if are_forms { vec![stype] } else { self.family(stype) });
        }
        Some(Some(types))
    }

    fn meetings(&mut self, guide: &Guide) {
        for line in &guide.meetings {
            let text = line.split(". ").next().unwrap_or_default().trim_end_matches('.');
            let forbids = text.split_once(" cannot enter ");
            let Some((first, second)) = forbids.or_else(|| text.split_once(" can enter ")) else { continue };
            let second = second.split(": ").next().unwrap_or_default();
            let first = ["The ", "Any ", "No ", "You"].iter().find_map(|start| {
                let rest = first.strip_prefix(start)?;
                Some(start.to_lowercase() + rest)
            });
            let Some(Some(first)) = first.and_then(|first| self.party(&first)) else { continue };
            let Some(second) = self.party(second) else { continue };
            self.claim(line.as_str(), Fact::CannotEnter(first, second));
        }
    }

    fn kind(&mut self, guide: &Guide) {
        for line in &guide.kind {
            let fact = match line.as_str() {
                "Turn-based: nothing happens unless you act." => Fact::TurnBased,
                "Chance plays no part." => Fact::NoChance,
                "Everything that matters is shown." => Fact::AllShown,
                _ => continue,
            };
            self.claim(line.as_str(), fact);
        }
        if self.case.analysis.taxonomy().spatiality == Spatiality::Fixed {
            for avatar in self.case.analysis.avatars() {
                self.claim("Space: you stay where you are.", Fact::Stands(avatar.stype));
            }
        }
    }

    fn analysis(&mut self) {
        let analysis = &self.case.analysis;
        let possible = self.game().sprite_types().filter(|&stype| analysis.facts(stype).possible).collect();
        if !self.uses_idle_default(b'A') && !self.uses_idle_default(b'w') {
            self.claim("the types that can occur", Fact::OnlyTypes(possible));
        }
        for (can, win) in [(analysis.can_win(), true), (analysis.can_lose(), false)] {
            if !can {
                self.claim("analysis of the rules", Fact::Unattainable(win));
            }
        }
        for resource in analysis.resources() {
            if !resource.obtainable {
                let needed = i64::from(resource.needed);
                self.claim(
                    "a resource that cannot be obtained",
                    Fact::HeldAtMost(resource.stype, needed - 1),
                );
            }
        }
    }

    fn level(&mut self) {
        let Case { analysis, level, reach, .. } = self.case;
        for line in describe::level(analysis, level, reach) {
            let number = line.strip_prefix("You can get to ").and_then(|rest| rest.split(' ').next());
            if let Some(cells) = number.and_then(|number| number.parse().ok()) {
                self.claim(line.as_str(), Fact::CellsVisited(cells));
            }
        }
        let start = self.game().start(level, Seed::from_text("start"));
        if let Some(most) = analysis.most_points(&start) {
            self.claim("highest score", Fact::ScoreAtMost(most));
        }
        for (can, win) in [(reach.can_win(), true), (reach.can_lose(), false)] {
            if !can {
                self.claim("reach of the level", Fact::OutOfReach(win));
            }
        }
        for impossible in reach.impossible_goals() {
            let types = analysis.goals()[impossible.goal].condition.types().to_vec();
            self.claim("impossible termination", Fact::GoalNeverHolds(impossible.goal));
            self.claim(
                "cause of an impossible termination",
                match &impossible.cause {
                    Cause::Permanent(sprites) => Fact::Permanent(sprites.clone()),
                    Cause::AtMost(most) => Fact::CountAtMost(types, *most),
                    Cause::Unpaid(unpaid) => Fact::HeldAtMost(unpaid.resource, unpaid.most),
                },
            );
        }
        if !reach.is_coarse() {
            let cells = level.cells().len();
            let within = |stype: SpriteType| (0..cells).map(|cell| reach.can_be(stype, cell)).collect();
            let within = self.game().sprite_types().map(within).collect();
            self.claim("reach of the level", Fact::Within(within));
        }
        for Chain { obstacles, .. } in analysis.causes(level) {
            obstacles.iter().for_each(|obstacle| self.obstacle(obstacle));
        }
    }

    fn obstacle(&mut self, Obstacle { missing, line, .. }: &Obstacle) {
        let text = "chain of causes";
        match missing {
            // This sprite would create the missing one by itself.
            Missing::Absent(maker) if line.is_none() => self.claim(text, Fact::Absent(*maker)),
            Missing::Absent(written) => {
                for stype in self.family(*written) {
                    self.claim(text, Fact::Absent(stype));
                }
            }
            Missing::Unmade(stype, obstacles) => {
                self.claim(text, Fact::Absent(*stype));
                obstacles.iter().for_each(|obstacle| self.obstacle(obstacle));
            }
            Missing::Resource(shortage) => {
                let most = shortage.capacity.map_or(shortage.most, i64::from).max(0);
                self.claim(
                    text,
                    Fact::HeldAtMost(shortage.resource, most.min(i64::from(shortage.needed) - 1)),
                );
                for source in &shortage.sources {
                    source.unreachable.iter().for_each(|unreachable| self.unreachable(unreachable));
                }
            }
            Missing::Unreachable(unreachable) => self.unreachable(unreachable),
            Missing::Nowhere(first, second) => {
                let fact = Fact::NeverMeet(self.family(*first), second.map(|second| self.family(second)));
                self.claim(text, fact);
            }
            Missing::Blocked(..) | Missing::Inside => {}
        }
    }

    fn unreachable(&mut self, unreachable: &Unreachable) {
        for stype in self.family(unreachable.stype) {
            self.claim("chain of causes", Fact::NeverAt(stype, unreachable.cell));
        }
        for blocker in &unreachable.blockers {
            blocker.obstacles.iter().for_each(|obstacle| self.obstacle(obstacle));
        }
    }

    fn warning(&mut self, warning: &Diagnostic) {
        let message = warning.message.as_str();
        let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
        let named = |at: usize| quoted.get(at).and_then(|name| self.game().sprite_type(name));
        let line = || {
            let lines = &self.game().description().interactions;
            lines.iter().position(|line| line.first.span.start == warning.span.start)
        };
        let facts: Vec<Fact> = match warning.code {
            "no-win" => vec![Fact::Unattainable(true)],
            "no-lose" => vec![Fact::Unattainable(false)],
            "swapped-rule" if message.contains("cannot be won") => vec![Fact::Unattainable(true)],
            "swapped-rule" => {
                named(0).map_or(Vec::new(), |stype| self.family(stype).into_iter().map(Fact::Fixed).collect())
            }
            // Such a warning is conditional.
            "ends-at-once" if message.contains("unless") => Vec::new(),
            "ends-at-once" => vec![Fact::OverAtOnce(match message {
                _ if message.contains("level is won") => Some(true),
                _ if message.contains("level is lost") => Some(false),
                _ => None,
            })],
            "never-fires" => {
                let resource = named(0).filter(|_| message.contains("no rule gives any"));
                let mut facts: Vec<Fact> =
                    resource.map(|stype| Fact::HeldAtMost(stype, 0)).into_iter().collect();
                if facts.is_empty() {
                    facts.extend(line().map(Fact::Silent));
                    for stype in [named(0), named(1)].into_iter().flatten() {
                        facts.extend(self.family(stype).into_iter().map(Fact::Fixed));
                    }
                }
                facts
            }
            "never-there" => named(0).map(Fact::Absent).into_iter().collect(),
            "parent-sprite" if !message.contains("the player's") => {
                named(0).map(Fact::Stands).into_iter().collect()
            }
            // The player's avatar may have a different type.
            "lost-avatar" if self.case.analysis.avatars().is_empty() => vec![Fact::DeadKeys],
            "ignored-parameter" => {
                // The reference's recovery may have changed what is at the position.
                let strict = self.case.policy == Policy::Strict;
                strict.then_some(Fact::Ignored(warning.span.start)).into_iter().collect()
            }
            _ => Vec::new(),
        };
        for fact in facts {
            self.claim(format!("{}: {message}", warning.code), fact);
        }
    }
}
