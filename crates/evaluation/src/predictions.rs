//! Predictions about the effects of touching each of a game's sprite types, and their comparison with the
//! rules.

use crate::prompt::kinds_at_start;
use crate::subject::Subject;
use engine::analysis::{Harm, Removal, Touch};
use engine::{Analysis, SpriteType};
use itertools::Itertools;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

base::named_enum! {
    /// A predictable fact about touching sprites of a type.
    pub enum TouchFact {
        /// Touching the sprite kills the avatar, at least while the avatar holds nothing.
        Kills = "kills",
        /// The avatar cannot enter the sprite's cell, at least while the avatar holds nothing.
        Stops = "stops",
        /// The sprite disappears or turns into a different type, either immediately or when the avatar holds
        /// the required resource.
        Goes = "goes",
        /// The score changes, either immediately or when the avatar holds the required resource.
        Scores = "scores",
    }
}

/// The sprite types for which each fact is predicted, under the game's own names.
pub type Predicted = BTreeMap<TouchFact, BTreeSet<String>>;

/// The result of comparing predictions with the rules.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grade {
    /// The number of correct predictions among the pairs of types and facts that the rules determine.
    pub right: u64,
    /// The number of pairs of types and facts that the rules determine.
    pub of: u64,
    /// The mean insight over facts. A fact's insight is the fraction of types predicted among those for which
    /// the fact is true, minus the fraction predicted among all other types.
    ///
    /// A fact counts only if it is true for some types and false for others. The insight ranges from −1 to 1.
    /// It is 0 for predictions made without knowledge, and 1 for entirely correct predictions. `None` if no
    /// fact counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub insight: Option<f64>,
}

/// A game's sprite types, except avatars and floors, grouped by the effect of touching them. The groups
/// matter to a player that does not know the rules and must learn them by touching.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Trials {
    /// The types that hurt the avatar or cost points when touched.
    pub costly: Vec<String>,
    /// The types that react to a touch only if the avatar holds the required resource.
    pub gated: Vec<String>,
    /// The decoys: types other than walls and floors that have no effect when touched.
    pub idle: Vec<String>,
}

impl Trials {
    /// Returns the trials for the sprite types present at the start of a game's levels.
    pub fn of(subject: &Subject) -> Trials {
        let analysis = &subject.analysis;
        let mut trials = Trials::default();
        for kind in kinds_at_start(analysis, subject.levels.iter().map(|level| &level.level)) {
            let Some(stype) = analysis.game().sprite_type(&kind) else { continue };
            let touches = || analysis.avatars().iter().map(|avatar| analysis.touch(avatar.stype, stype));
            let is_costly = |touch: &Touch| touch.harm != Harm::None || touch.score < 0;
            if touches().any(is_costly) {
                trials.costly.push(kind);
            } else if touches().any(|touch| matches!(touch.removal, Removal::IfHolds(..))) {
                trials.gated.push(kind);
            } else if touches().all(|touch| !touch.any) {
                trials.idle.push(kind);
            }
        }
        trials
    }
}

/// Returns the truth value of a fact about a sprite type according to the rules. Returns `None` if the truth
/// value depends on more than the avatar's type and possessions.
///
/// If the avatar can have several types, returns `None` unless the truth value is the same for all of them.
pub fn truth(analysis: &Analysis, kind: SpriteType, fact: TouchFact) -> Option<bool> {
    let each = analysis.avatars().iter().map(|avatar| fact_of(analysis.touch(avatar.stype, kind), fact));
    each.dedup().exactly_one().ok().flatten()
}

fn fact_of(touch: &Touch, fact: TouchFact) -> Option<bool> {
    match fact {
        TouchFact::Kills => match touch.harm {
            Harm::None => Some(false),
            Harm::Kills => Some(true),
            Harm::Conditional => touch.safe_with.map(|_| true),
            Harm::Wounds => None,
        },
        // If a sprite moves or disappears at the first touch, the avatar can enter its cell at the second
        // touch.
        TouchFact::Stops if touch.pushes || (touch.blocks && touch.removal == Removal::Always) => None,
        TouchFact::Stops if touch.harm != Harm::None => None,
        TouchFact::Stops => Some(touch.blocks),
        TouchFact::Goes => match touch.removal {
            _ if touch.changes.is_some() => Some(true),
            Removal::Never => Some(false),
            Removal::IfHolds(..) | Removal::Always => Some(true),
            Removal::Sometimes => None,
        },
        TouchFact::Scores => Some(touch.score != 0),
    }
}

/// Grades predictions about sprite types. Ignores names that are not in the game, and types that are not in
/// the question.
pub fn grade(analysis: &Analysis, kinds: &[String], predicted: &Predicted) -> Grade {
    let mut grade = Grade::default();
    let mut insights = Vec::new();
    for fact in TouchFact::ALL {
        // The numbers of types, indexed by whether the fact is true and by whether it was predicted.
        let mut counts = [[0_u64; 2]; 2];
        for kind in kinds {
            let Some(stype) = analysis.game().sprite_type(kind) else { continue };
            let Some(is_true) = truth(analysis, stype, fact) else { continue };
            let is_named = predicted.get(&fact).is_some_and(|named| named.contains(kind));
            counts[usize::from(is_true)][usize::from(is_named)] += 1;
        }
        grade.right += counts[0][0] + counts[1][1];
        grade.of += counts.iter().flatten().sum::<u64>();
        let share = |[not, named]: [u64; 2]| (not + named > 0).then(|| named as f64 / (not + named) as f64);
        insights.extend(share(counts[1]).zip(share(counts[0])).map(|(hits, alarms)| hits - alarms));
    }
    let count = insights.len() as f64;
    grade.insight = (!insights.is_empty()).then(|| insights.into_iter().sum::<f64>() / count);
    grade
}

/// Reads an answer about sprite types. For each fact, the last line of the form `KILLS: t1, t4` or
/// `STOPS: none` counts. `names` maps the names in the question to the game's own names.
///
/// Emphasis, list markers, unknown types and text outside these lines are ignored. A semicolon also ends a
/// line.
///
/// # Errors
/// Returns an error if a line is missing, or contains neither a type nor `none`. The message is a clause
/// whose subject is the answer.
pub fn read(answer: &str, names: &BTreeMap<String, String>) -> Result<Predicted, String> {
    let answer = crate::answer::without_reasoning(answer);
    let is_mark = |c: char| matches!(c, '*' | '`' | '#' | '-' | '>' | '_') || c.is_whitespace();
    let line_of = |fact: TouchFact| {
        let own = |line: &str| {
            let (word, rest) = line.split_once(':')?;
            word.trim_matches(is_mark).eq_ignore_ascii_case(fact.name()).then(|| rest.to_owned())
        };
        answer.split(['\n', ';']).filter_map(own).next_back()
    };
    let mut predicted = Predicted::new();
    for fact in TouchFact::ALL {
        let word = fact.name().to_uppercase();
        let line = line_of(fact).ok_or_else(|| format!("it has no line {word}:"))?;
        let words =
            line.split(|c: char| !(c.is_alphanumeric() || matches!(c, '_'))).filter(|word| !word.is_empty());
        let mut kinds = BTreeSet::new();
        let mut is_none = false;
        for name in words.map(str::to_lowercase) {
            is_none |= name == "none" || name == "nothing";
            // Types that were not in the question are ignored.
            is_none |= is_kind(&name);
            kinds.extend(names.get(&name).cloned());
        }
        if kinds.is_empty() && !is_none {
            return Err(format!("its line {word}: names no kind; if there is none, it says none"));
        }
        predicted.insert(fact, kinds);
    }
    Ok(predicted)
}

/// Returns `true` if a word has the format of a type name in a question.
fn is_kind(word: &str) -> bool {
    word.strip_prefix('t').is_some_and(|rest| !rest.is_empty() && rest.chars().all(|c| c.is_ascii_digit()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::Game;

    const GAME: &str = "BasicGame\n  SpriteSet\n    key > Resource limit=1\n    gate > Immovable\n    trap > Immovable\n    moat > Immovable\n    box > Passive\n    pebble > Immovable\n    gem > Immovable\n    hero > MovingAvatar\n  LevelMapping\n    A > hero\n  InteractionSet\n    key hero > collectResource\n    gate hero > killIfOtherHasMore resource=key limit=1 scoreChange=2\n    hero gate > stepBack\n    hero trap > killSprite\n    hero moat > killIfHasLess resource=key limit=0\n    box hero > bounceForward\n    hero wall > stepBack\n    gem hero > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=gem win=True\n";

    #[test]
    fn truths_follow_from_the_rules() {
        let analysis = Analysis::of(&Game::from_source(GAME).unwrap());
        for (kind, expect) in [
            ("key", "kills no, stops no, goes yes, scores no"),
            ("gate", "kills no, stops yes, goes yes, scores yes"),
            ("trap", "kills yes, stops -, goes no, scores no"),
            ("moat", "kills yes, stops -, goes no, scores no"),
            ("box", "kills no, stops -, goes no, scores no"),
            ("wall", "kills no, stops yes, goes no, scores no"),
            ("pebble", "kills no, stops no, goes no, scores no"),
            ("gem", "kills no, stops no, goes yes, scores yes"),
        ] {
            let kind_type = analysis.game().sprite_type(kind).unwrap();
            let told = TouchFact::ALL.map(|fact| {
                let truth = truth(&analysis, kind_type, fact);
                format!("{} {}", fact.name(), truth.map_or("-", |truth| if truth { "yes" } else { "no" }))
            });
            assert_eq!(told.join(", "), expect, "{kind}");
        }
    }

    fn names() -> BTreeMap<String, String> {
        [("t1", "key"), ("t2", "gate"), ("t3", "trap"), ("t4", "gem")]
            .map(|(shown, own)| (shown.to_owned(), own.to_owned()))
            .into()
    }

    #[track_caller]
    fn check(answer: &str, expect: Result<(u64, u64, Option<f64>), &str>) {
        let analysis = Analysis::of(&Game::from_source(GAME).unwrap());
        let kinds: Vec<String> = names().into_values().collect();
        let found = read(answer, &names()).map(|predicted| grade(&analysis, &kinds, &predicted));
        let found = found.map(|Grade { right, of, insight }| (right, of, insight));
        assert_eq!(found, expect.map_err(str::to_owned));
    }

    #[test]
    fn answers_are_graded() {
        check("KILLS: t3; STOPS: t2; GOES: t1, t2, t4; SCORES: t2, t4.", Ok((15, 15, Some(1.0))));
        check("KILLS: t3\nSTOPS: t2\nGOES: t1, t2, t4\nSCORES: t2, t4", Ok((15, 15, Some(1.0))));
        // The same prediction for all types shows no knowledge of the rules.
        check("KILLS: none\nSTOPS: none\nGOES: none\nSCORES: none", Ok((8, 15, Some(0.0))));
        let all = "t1, t2, t3, t4";
        check(&format!("KILLS: {all}\nSTOPS: {all}\nGOES: {all}\nSCORES: {all}"), Ok((7, 15, Some(0.0))));
        check("KILLS: t1\nSTOPS: t1\nGOES: t3\nSCORES: t1, t3", Ok((3, 15, Some(-0.7083333333333333))));
    }

    #[test]
    fn answers_are_read_with_tolerance() {
        check(
            "I think so.\nKILLS: t1\n\n**Kills:** T3.\n- stops: `t2`\ngoes: t1 and t2, t4\n> SCORES: t2 t4\nThat is all.",
            Ok((15, 15, Some(1.0))),
        );
        check("<think>KILLS: t1</think>STOPS: none", Err("it has no line KILLS:"));
        check(
            "KILLS: t3\nSTOPS:\nGOES: t1",
            Err("its line STOPS: names no kind; if there is none, it says none"),
        );
        check("KILLS: t9, t3\nSTOPS: t2, t8\nGOES: t1, t2, t4\nSCORES: t2, t4", Ok((15, 15, Some(1.0))));
        check("KILLS: t9\nSTOPS: t7\nGOES: t9\nSCORES: none", Ok((8, 15, Some(0.0))));
    }
}
