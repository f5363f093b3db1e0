//! A user's reference to a rule of a game, such as `box hole`, `box hole killSprite`, or the rule's line number.

use crate::evidence::Line;
use crate::measures::EDGE;
use engine::{Analysis, EFFECTS, Episode, Level, Meeting, SpriteType, Watch, nearest};
use itertools::Itertools;

/// The interactions in a game that match a written name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RuleRef {
    text: String,
    /// The indices of the matching lines in the description, each with the pair that must meet, or `None` if any of the
    /// line's partners may meet.
    meant: Vec<(usize, Option<Pair>)>,
}

/// The sprite type that the rule acts on, and its partner, or `None` for the screen edge.
type Pair = (SpriteType, Option<SpriteType>);

/// The error for a name that does not refer to any rule.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{text}` isn't an interaction of the game: {reason}")]
pub struct RuleRefError {
    /// The reference, as written.
    pub text: String,
    /// The problem, possibly with a suggestion.
    pub reason: String,
}

/// The maximum number of interactions listed in a message.
const MAX_LISTED: usize = 4;

impl RuleRef {
    /// Parses a rule name, which is either the number of the rule's line in the InteractionSet, counted from 1, or the
    /// names of the two sprites. A sprite is named as on the line, or by a type below the one on the line.
    ///
    /// If the two sprites meet in more than one way, the effect must follow: `box hole killSprite`, or
    /// equivalently `box hole > killSprite`. If the two sprites occur only in the opposite order, the name
    /// refers to that interaction.
    ///
    /// # Errors
    /// Returns an error if the number is too large, or if the game does not contain such an interaction,
    /// sprite or effect. The message suggests alternatives.
    pub fn parse(analysis: &Analysis, text: &str) -> Result<RuleRef, RuleRefError> {
        let game = analysis.game();
        let wrong = |reason: String| Err(RuleRefError { text: text.to_owned(), reason });
        let lines = &game.description().interactions;
        let named = |meant: Vec<(usize, Option<Pair>)>| RuleRef { text: text.trim().to_owned(), meant };
        if let Ok(number) = text.trim().parse::<usize>() {
            return match number {
                1.. if number <= lines.len() => Ok(named(vec![(number - 1, None)])),
                _ => wrong(format!("the InteractionSet has lines 1 to {}", lines.len())),
            };
        }
        let (sprites, effect) = words(analysis, text);
        let [first, second] = sprites[..] else {
            return wrong("write two sprites (`box hole`), or the number of the line".to_owned());
        };
        for name in [first, second] {
            if name != EDGE && game.sprite_type(name).is_none() {
                let names: Vec<&str> = game.sprite_types().map(|stype| game.name(stype)).collect();
                let help = suggestion(name, names);
                return wrong(format!("there is no sprite `{name}`{help}"));
            }
        }
        let between = |first: &str, second: &str| -> Vec<(usize, Option<Pair>)> {
            let Some(pair) = game.sprite_type(first).map(|stype| (stype, game.sprite_type(second))) else {
                return Vec::new();
            };
            let meets = |line: &usize| {
                let of_line = |word: &str, name: &str| {
                    let types = game.sprite_type(word).zip(game.sprite_type(name));
                    word == name || types.is_some_and(|(written, stype)| analysis.applies(written, stype))
                };
                let written = &lines[*line];
                of_line(&written.first.text, first)
                    && written.second.iter().any(|word| of_line(&word.text, second))
            };
            (0..lines.len()).filter(meets).map(|line| (line, Some(pair))).collect()
        };
        let met = Some(between(first, second)).filter(|met| !met.is_empty());
        let met = met.unwrap_or_else(|| between(second, first));
        if met.is_empty() {
            return wrong(format!("`{first}` and `{second}` do not meet{}", meetings_of(analysis, first)));
        }
        let Some(effect) = effect else { return Ok(named(met)) };
        let of_effect =
            |(line, _): &(usize, Option<Pair>)| lines[*line].effect.text.eq_ignore_ascii_case(effect);
        let meant: Vec<(usize, Option<Pair>)> = met.iter().filter(|met| of_effect(met)).copied().collect();
        if meant.is_empty() {
            let effects: Vec<&str> = met.iter().map(|(line, _)| lines[*line].effect.text.as_str()).collect();
            let help = suggestion(effect, effects.iter().copied());
            return wrong(format!("their effect is {}, not `{effect}`{help}", quoted(&effects)));
        }
        Ok(named(meant))
    }

    /// Returns the reference as the user wrote it.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the matching lines as indices into [`Description::interactions`](engine::Description), in ascending
    /// order.
    pub fn lines(&self) -> impl Iterator<Item = usize> + '_ {
        self.meant.iter().map(|(line, _)| *line)
    }

    /// Returns `true` if an episode executes one of the interactions on sprites of the given types. Costs one replay of
    /// the episode.
    pub fn is_used(&self, analysis: &Analysis, level: &Level, episode: &Episode) -> bool {
        let game = analysis.game();
        let mut recorder = MeetingRecorder { rule: self, analysis, heard: false };
        let mut state = game.start(level, episode.seed);
        episode.actions.iter().any(|&action| {
            game.step_watched(&mut state, action, &mut recorder);
            recorder.heard
        })
    }
}

/// A watcher for a rule's executions.
struct MeetingRecorder<'a> {
    rule: &'a RuleRef,
    analysis: &'a Analysis,
    heard: bool,
}

impl Watch for MeetingRecorder<'_> {
    fn interaction(&mut self, line: usize) {
        self.heard |= self.rule.meant.contains(&(line, None));
    }

    fn wants_meetings(&self) -> bool {
        !self.heard
    }

    fn meeting(&mut self, meeting: Meeting) {
        let is = |named: SpriteType, stype: SpriteType| self.analysis.applies(named, stype);
        let fits = |&(line, pair): &(usize, Option<Pair>)| {
            let Some((first, second)) = pair else { return false };
            line == meeting.line
                && is(first, meeting.first)
                && match (second, meeting.second) {
                    (Some(named), Some(met)) => is(named, met),
                    (None, None) => true,
                    _ => false,
                }
        };
        self.heard |= self.rule.meant.iter().any(fits);
    }
}

/// Splits a written rule into its sprites and its effect. If there is no `>`, a third word is the effect.
fn words<'a>(analysis: &Analysis, text: &'a str) -> (Vec<&'a str>, Option<&'a str>) {
    if let Some((sprites, effect)) = text.split_once('>') {
        return (sprites.split_whitespace().collect(), effect.split_whitespace().next());
    }
    let mut words: Vec<&str> = text.split_whitespace().collect();
    let is_sprite = |word: &str| analysis.game().sprite_type(word).is_some();
    let is_effect = |word: &&str| EFFECTS.iter().any(|effect| effect.eq_ignore_ascii_case(word));
    let effect =
        words.last().copied().filter(|word| words.len() > 2 && (is_effect(word) || !is_sprite(word)));
    if effect.is_some() {
        words.pop();
    }
    (words, effect)
}

fn suggestion<'a>(wrong: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    nearest(wrong, candidates).map_or(String::new(), |near| format!("; did you mean `{near}`?"))
}

fn quoted(words: &[&str]) -> String {
    words.iter().map(|word| format!("`{word}`")).join(" and ")
}

/// Describes a sprite's interactions.
fn meetings_of(analysis: &Analysis, name: &str) -> String {
    let game = analysis.game();
    let lines = &game.description().interactions;
    let has = |line: &usize| {
        lines[*line].first.text == name || lines[*line].second.iter().any(|word| word.text == name)
    };
    let known: Vec<String> =
        (0..lines.len()).filter(has).map(|line| Line::interaction(game, line).text).collect();
    match known.len() {
        0 => String::new(),
        many => {
            let listed: Vec<&str> = known.iter().take(MAX_LISTED).map(String::as_str).collect();
            let more =
                if many > MAX_LISTED { format!(", and {} more", many - MAX_LISTED) } else { String::new() };
            format!("; `{name}` has `{}`{more}", listed.join("`, `"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::Seed;
    use engine::{Action, Game};

    const GAME: &str = "BasicGame\n  SpriteSet\n    pit > Immovable\n    load > Passive\n      crate >\n      barrel >\n    avatar > MovingAvatar\n  LevelMapping\n    o > pit\n    c > crate\n    b > barrel\n  InteractionSet\n    avatar wall pit > stepBack\n    load avatar > bounceForward\n    load wall > undoAll\n    crate pit > killSprite scoreChange=1\n    crate pit > addHealthPoints value=1\n    avatar EOS > stepBack\n  TerminationSet\n    SpriteCounter stype=crate win=True\n";

    fn analysis() -> Analysis {
        Analysis::of(&Game::from_source(GAME).unwrap())
    }

    #[track_caller]
    fn check(text: &str, lines: &[usize]) -> RuleRef {
        let rule = RuleRef::parse(&analysis(), text).unwrap();
        assert_eq!(rule.lines().collect::<Vec<_>>(), lines, "{text}");
        rule
    }

    #[test]
    fn rules_are_named_by_sprites_effect_or_number() {
        check("1", &[0]);
        check(" 4 ", &[3]);
        check("crate pit", &[3, 4]);
        check("crate pit killSprite", &[3]);
        check("crate pit > killsprite", &[3]);
        // These pairs are in the opposite order, name a type below the written one, or are at the edge.
        check("pit crate", &[3, 4]);
        check("barrel avatar", &[1]);
        check("avatar EOS", &[5]);
    }

    #[track_caller]
    fn refuse(text: &str, expect: &str) {
        let error = RuleRef::parse(&analysis(), text).unwrap_err().to_string();
        assert!(error.contains(expect), "{error}");
    }

    #[test]
    fn unknown_rules_are_reported_with_a_suggestion() {
        refuse("7", "lines 1 to 6");
        refuse("0", "lines 1 to 6");
        refuse("crate", "write two sprites");
        refuse("crate pti", "no sprite `pti`; did you mean `pit`?");
        refuse("barrel pit", "`barrel` and `pit` do not meet");
        refuse("crate avatar killSprite", "their effect is `bounceForward`, not `killSprite`");
        refuse("crate pit kilSprite", "did you mean `killSprite`?");
        refuse("pit pit", "`pit` has `avatar wall pit > stepBack`, `crate pit > killSprite scoreChange=1`");
    }

    #[test]
    fn an_episode_uses_a_rule_if_it_is_executed_on_the_named_sprites() {
        let analysis = analysis();
        let game = analysis.game();
        let played = |level: &str| {
            let level = game.level(level).unwrap();
            let (mut episode, mut state) = Episode::begin(game, &level, Seed::from_text("used"));
            for action in [Action::Right, Action::Up] {
                episode.play(game, &mut state, action);
            }
            (level, episode)
        };
        let (walled, open) = (played("wwwwww\nwAc bw\nw  c w\nwo   w\nwwwwww\n"), played("A c b\n    o\n"));
        let uses = |text: &str, (level, episode): &(Level, Episode)| {
            RuleRef::parse(&analysis, text).unwrap().is_used(&analysis, level, episode)
        };
        let used = ["crate avatar", "load avatar", "2"];
        assert!(used.iter().all(|text| uses(text, &walled)));
        assert!(!uses("barrel avatar", &walled), "only the crate was pushed");
        assert!(["crate pit", "avatar pit", "avatar EOS", "6"].iter().all(|text| !uses(text, &walled)));
        assert!(uses("avatar EOS", &open) && uses("6", &open) && !uses("2", &open));
    }
}
