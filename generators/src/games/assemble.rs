//! From a draft to a description: derives the rules of movement and harm from the bodies and orders everything.

use super::body::Body;
use super::draft::{AVATAR, Draft, Ending, FLOOR, Harm, Part, Phase, Rule, Stamina, Value, WALL};
use super::effect::Effect;
use super::palette;
use engine::Description;
use engine::syntax::{
    Header, InteractionLine, MappingLine, Param, SpriteLine, TerminationLine, Trivia, Word,
};

/// Adds the rules and the ending that follow from the bodies and from the harmful parts, and sorts everything into the
/// order of the InteractionSet and the TerminationSet.
pub(crate) fn complete(draft: &mut Draft) {
    let order = drawing_order(draft);
    let derived: Vec<Rule> = movement(draft, &order).into_iter().chain(harm(draft)).collect();
    draft.rules.extend(derived);
    draft.rules.sort_by_key(|rule| rule.phase);
    let wanes = draft.rules.iter().any(|rule| matches!(rule.effect, Effect::Wane { .. }));
    if wanes || !draft.harms.is_empty() {
        draft.endings.insert(0, (Ending::NoneLeft(vec![AVATAR]), false));
    }
    // Losing comes before winning, time last.
    draft.endings.sort_by_key(|(ending, win)| (matches!(ending, Ending::Timeout(_)), *win));
}

/// Writes a complete draft as a description.
pub(crate) fn describe(draft: &Draft) -> Description {
    let order = drawing_order(draft);
    Description {
        header: Header { class: "BasicGame".into(), ..Header::default() },
        sprites: sprites(draft, &order),
        mapping: mapping(draft, &order),
        interactions: draft.rules.iter().map(|rule| interaction(draft, rule)).collect(),
        terminations: terminations(draft),
        has: [true; 4],
        ..Description::default()
    }
}

/// All parts, the lowest first.
fn drawing_order(draft: &Draft) -> Vec<Part> {
    let mut order: Vec<Part> = draft.parts().filter(|&part| !draft.sprite(part).removed).collect();
    order.sort_by_key(|&part| draft.sprite(part).body);
    order
}

/// The rules for obstacles: one for each top-level part that moves and each effect of being stopped.
fn movement(draft: &Draft, order: &[Part]) -> Vec<Rule> {
    let tops = order.iter().copied().filter(|&part| draft.sprite(part).parent.is_none());
    let tops: Vec<Part> = tops.collect();
    let mut rules = Vec::new();
    for &mover in &tops {
        let body = draft.sprite(mover).body;
        let stops = |&obstacle: &Part| {
            body.is_stopped_by(draft.sprite(obstacle).body) && !draft.handled.contains(&(mover, obstacle))
        };
        let second: Vec<Part> = tops.iter().copied().filter(stops).collect();
        let phase = match body {
            Body::Carrier => Phase::Carry,
            Body::Crate => Phase::Push,
            _ => Phase::Block,
        };
        for &effect in body.when_stopped().iter().filter(|_| !second.is_empty()) {
            rules.push(Rule { phase, first: mover, second: second.clone(), effect, score: 0, gene: None });
        }
    }
    // The hero first, then the other movers, in drawing order.
    rules.sort_by_key(|rule| rule.first != AVATAR);
    rules
}

/// The effects of touching harmful parts, according to the hero's stamina.
fn harm(draft: &Draft) -> Vec<Rule> {
    let all: Vec<Part> = draft.harms.iter().map(|&(part, _)| part).collect();
    if all.is_empty() {
        return Vec::new();
    }
    let line = |first: Part, second: &[Part], effect: Effect, score: i32| Rule {
        phase: Phase::Harm,
        first,
        second: second.to_vec(),
        effect,
        score,
        gene: None,
    };
    match draft.stamina {
        Stamina::Fragile => vec![line(AVATAR, &all, Effect::KillSprite, -2)],
        Stamina::Hearts(_) => {
            let spent = draft.harms.iter().filter(|(_, harm)| *harm == Harm::Spent);
            let hurt = Effect::SubtractHealthPoints { score_if_killed: -2 };
            [line(AVATAR, &all, hurt, -1)]
                .into_iter()
                .chain(spent.map(|&(part, _)| line(part, &[AVATAR], Effect::KillSprite, 0)))
                .collect()
        }
        Stamina::Warded(ward) => vec![
            line(AVATAR, &all, Effect::KillIfHasLess { resource: ward, limit: 0 }, -2),
            line(AVATAR, &all, Effect::Spend { resource: ward }, 0),
        ],
    }
}

fn sprites(draft: &Draft, order: &[Part]) -> Vec<SpriteLine> {
    let mut colors = Vec::new();
    let mut lines: Vec<(Part, SpriteLine)> = Vec::new();
    for &part in order {
        let sprite = draft.sprite(part);
        let mut params: Vec<Param> =
            sprite.params.iter().map(|&(key, value)| param(draft, key, value)).collect();
        if part != WALL && part != AVATAR {
            let color = palette::color(sprite.role, draft.theme, &colors);
            colors.push(color);
            params.push(Param::new("color", color));
        }
        let line = SpriteLine {
            name: Word::from(sprite.name.as_str()),
            class: sprite.class.map(|class| class.name().into()),
            params,
            children: Vec::new(),
            trivia: Trivia::default(),
        };
        match sprite.parent {
            None => lines.push((part, line)),
            Some(parent) => {
                let parent = lines.iter_mut().find(|(other, _)| *other == parent);
                parent.expect("parents are made first").1.children.push(line);
            }
        }
    }
    lines.into_iter().map(|(_, line)| line).collect()
}

fn mapping(draft: &Draft, order: &[Part]) -> Vec<MappingLine> {
    let mut taken: Vec<char> = Vec::new();
    let placed = order.iter().copied().filter(|&part| draft.sprite(part).placed);
    // Floor, wall and hero first: their characters are the same in every game.
    let known = |part: Part| match draft.sprite(part).body {
        Body::Floor => 0,
        Body::Wall => 1,
        Body::Hero => 2,
        _ => 3,
    };
    let mut placed: Vec<Part> = placed.collect();
    placed.sort_by_key(|&part| known(part));
    let lines = placed.into_iter().map(|part| {
        let sprite = draft.sprite(part);
        let symbol = match known(part) {
            0 => '.',
            1 => 'w',
            2 => 'A',
            _ => palette::symbol(&sprite.name, &taken),
        };
        taken.push(symbol);
        let below = (known(part) > 1).then(|| Word::from(draft.name(FLOOR)));
        let names = below.into_iter().chain([Word::from(sprite.name.as_str())]).collect();
        MappingLine { symbol, names, ..MappingLine::default() }
    });
    lines.collect()
}

fn interaction(draft: &Draft, rule: &Rule) -> InteractionLine {
    let word = |part: Part| Word::from(draft.name(part));
    let params = rule.effect.params().into_iter().map(|(key, value)| param(draft, key, value));
    let score = (rule.score != 0).then(|| Param::new("scoreChange", rule.score));
    InteractionLine {
        first: word(rule.first),
        second: rule.second.iter().copied().map(word).collect(),
        effect: rule.effect.keyword().into(),
        params: params.chain(score).collect(),
        trivia: Trivia::default(),
    }
}

fn terminations(draft: &Draft) -> Vec<TerminationLine> {
    let lines = draft.endings.iter().map(|(ending, win)| {
        let (class, mut params) = match ending {
            Ending::NoneLeft(parts) if parts.len() == 1 => {
                ("SpriteCounter", vec![Param::new("stype", draft.name(parts[0])), Param::new("limit", 0)])
            }
            Ending::NoneLeft(parts) => {
                let keys = ["stype1", "stype2", "stype3"];
                let named = keys.iter().zip(parts).map(|(key, &part)| Param::new(key, draft.name(part)));
                assert!(parts.len() <= keys.len(), "MultiSpriteCounter counts three types");
                ("MultiSpriteCounter", named.chain([Param::new("limit", 0)]).collect())
            }
            &Ending::Many(part, count) => {
                let params = vec![Param::new("stype", draft.name(part)), Param::new("limit", count)];
                ("SpriteCounterMore", params)
            }
            Ending::Timeout(limit) => ("Timeout", vec![Param::new("limit", limit)]),
        };
        params.push(Param::new("win", if *win { "True" } else { "False" }));
        TerminationLine { class: class.into(), params, trivia: Trivia::default() }
    });
    lines.collect()
}

fn param(draft: &Draft, key: &str, value: Value) -> Param {
    match value {
        Value::Count(count) => Param::new(key, count),
        Value::Score(score) => Param::new(key, score),
        Value::Hundredths(100) => Param::new(key, 1),
        Value::Hundredths(share) => Param::new(key, format!("0.{share:02}").trim_end_matches('0')),
        Value::Flag(on) => Param::new(key, if on { "True" } else { "False" }),
        Value::Word(word) => Param::new(key, word),
        Value::Part(part) => Param::new(key, draft.name(part)),
    }
}
