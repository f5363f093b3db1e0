//! The sentence for each effect: a template with named placeholders, and the placeholders' values.
//!
//! `engine::describe` fills the placeholders, and lists the templates for programs that parse the sentences.
//!
//! The placeholders `{one}` and `{two}` are the colliding sprites. `{one:die|disappears}` is a word that
//! agrees with a sprite: the first form is for the player, and the second for any other sprite. `{both:…|…}`
//! agrees with either sprite. `{every}` stands for the sprites on which a timed effect runs. Every other
//! placeholder has its own value.

use super::parameters::Recorder;
use super::{Effect, SpawnIf, SpawnIfCounterSubTypes, SpeedChange, Summary, TransformIfCount, build};
use crate::keywords::EFFECTS;
use crate::rules::SpriteType;
use smallvec::SmallVec;

/// The texts that describe an effect.
#[derive(Clone, Debug)]
pub(crate) struct Sentence {
    /// The template for two colliding sprites.
    pub(crate) meeting: &'static str,
    /// The template for a timed effect. The placeholder `{alone}` in [`Sentence::meeting`] stands for this
    /// template.
    pub(crate) alone: &'static str,
    /// The words that introduce the points, if they are awarded under a different condition than the one in
    /// the sentence.
    pub(crate) if_scored: &'static str,
    values: SmallVec<[(&'static str, Value); 3]>,
}

/// The template for effects that do nothing when timed, or that have no description.
pub(crate) const UNTOLD: &str = "something happens to {every}";

/// The template for effects that do nothing.
const NOTHING: &str = "when {one} {one:touch|touches} {two}, nothing happens";

/// The template for two types that turn into each other.
const SWAP: &str =
    "when {one} {one:touch|touches} {two}, every {type} turns into {to}, and every {other} into {back}";

/// The text that introduces a probability.
pub(crate) const CHANCE: &str = " with a chance of ";

/// The value of a placeholder.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    /// The name of a type.
    Name(SpriteType),
    /// The name of a type, in the singular or plural form that the given number of sprites requires.
    Many(SpriteType, i64),
    /// The name of a type with its indefinite article.
    A(SpriteType),
    /// One of several types, with articles.
    AnyOf(Box<[SpriteType]>),
    /// A type as a party to an interaction.
    Party(SpriteType),
    Number(i64),
    Decimal(f64),
    /// A number with its noun.
    Count(i64, &'static str),
    /// A probability, which is omitted if it is 1.
    Chance(f64),
    Text(String),
    /// A part with its own placeholders, which is included if `present` is `true`.
    Part {
        text: &'static str,
        present: bool,
    },
    /// The delay of a timed effect.
    Delay(u16),
    /// The sentence of a timed effect.
    Planned(u16),
}

impl Sentence {
    fn of(meeting: &'static str) -> Sentence {
        Sentence { meeting, alone: UNTOLD, if_scored: "", values: SmallVec::new() }
    }

    /// Returns the sentence for an effect that does nothing.
    pub(crate) fn of_nothing() -> Sentence {
        Sentence::of(NOTHING)
    }

    /// Returns the sentence for two types that turn into each other.
    pub(crate) fn of_swap(one: SpriteType, other: SpriteType) -> Sentence {
        Sentence::of(SWAP)
            .with("type", Value::Name(one))
            .with("to", Value::A(other))
            .with("other", Value::Name(other))
            .with("back", Value::A(one))
    }

    fn alone(self, alone: &'static str) -> Sentence {
        Sentence { alone, ..self }
    }

    /// Sets the condition for awarding the points.
    fn scored(self, if_scored: &'static str) -> Sentence {
        Sentence { if_scored, ..self }
    }

    /// Sets the condition for awarding the points: the first sprite is removed.
    fn scored_if_killed(self) -> Sentence {
        self.scored("if {one:you die|it disappears}, ")
    }

    /// Sets the condition for awarding the points: any contact, regardless of the outcome.
    fn scored_always(self) -> Sentence {
        self.scored("in any case, ")
    }

    /// Awards the points on every contact. The text says so if the effect itself is random.
    fn scored_if(self, prob: f64) -> Sentence {
        if prob < 1.0 { self.scored_always() } else { self }
    }

    fn with(mut self, hole: &'static str, value: Value) -> Sentence {
        self.values.push((hole, value));
        self
    }

    /// Adds a part about the partner, if the partner is removed, too.
    fn and_gone(self, gone: bool) -> Sentence {
        self.part("gone", gone, ", and {two} {two:die|disappears}")
    }

    fn part(self, hole: &'static str, present: bool, part: &'static str) -> Sentence {
        self.with(hole, Value::Part { text: part, present })
    }

    /// Returns the text with which a placeholder's value starts, if the value can be empty.
    pub(crate) fn optional_start(&self, hole: &str) -> Option<&'static str> {
        match self.value(hole)? {
            Value::Chance(_) => Some(CHANCE),
            Value::Part { text, .. } => text.split('{').next(),
            Value::Name(_)
            | Value::Many(..)
            | Value::A(_)
            | Value::AnyOf(_)
            | Value::Party(_)
            | Value::Number(_)
            | Value::Decimal(_)
            | Value::Count(..)
            | Value::Text(_)
            | Value::Delay(_)
            | Value::Planned(_) => None,
        }
    }

    /// Returns the value of a placeholder; `None` if the sentence has no such placeholder.
    pub(crate) fn value(&self, hole: &str) -> Option<&Value> {
        self.values.iter().find(|(name, _)| *name == hole).map(|(_, value)| value)
    }
}

/// Returns the effect for every keyword, with each of two sets of parameters.
fn recorded() -> impl Iterator<Item = Effect> {
    let effect = |(contrary, keyword): (bool, &&str)| {
        build(keyword, &mut Recorder::contrary(contrary)).expect("every keyword builds an effect")
    };
    [false, true]
        .into_iter()
        .flat_map(|contrary| EFFECTS.iter().map(move |keyword| (contrary, keyword)))
        .map(effect)
}

/// Returns the sentences for all effects, without duplicate templates. Each sentence is paired with the
/// summary of one effect that uses its template.
pub(crate) fn sentences() -> Vec<(Sentence, Summary)> {
    let mut found: Vec<(Sentence, Summary)> = Vec::new();
    for effect in recorded() {
        let sentence = effect.sentence();
        if !found.iter().any(|(other, _)| other.meeting == sentence.meeting) {
            found.push((sentence, effect.summary()));
        }
    }
    found
}

/// Returns the templates for all effects, both for collisions and for timed effects, except [`UNTOLD`].
pub(crate) fn templates() -> impl Iterator<Item = &'static str> {
    let both = |effect: Effect| {
        let sentence = effect.sentence();
        [sentence.meeting, sentence.alone]
    };
    recorded().flat_map(both).filter(|text| *text != UNTOLD).chain([NOTHING, SWAP])
}

impl Effect {
    /// Returns the effect's sentence. Some effects have a shorter sentence if their partner never disappears.
    pub(crate) fn sentence_beside(&self, partner_stays: impl FnOnce() -> bool) -> Sentence {
        // A partner that never disappears is alive.
        let is_alive = matches!(self, Effect::KillIfAlive) && partner_stays();
        if is_alive { Effect::KillSprite.sentence() } else { self.sentence() }
    }

    /// Returns the effect's sentence.
    pub(crate) fn sentence(&self) -> Sentence {
        match *self {
            Effect::KillSprite => Sentence::of("{one} {one:die|disappears} on touching {two}")
                .alone("{every} {every:die|disappears}"),
            Effect::KillIfAlive => {
                Sentence::of("{one} {one:die|disappears} on touching {two} unless {two:you died|that disappeared} earlier in that tick")
                    .scored_always()
            }
            Effect::KillBoth => Sentence::of("{one} and {two} both {both:die|disappear} when they touch"),
            Effect::KillAll { stype } => Sentence::of("when {one} {one:touch|touches} {two}, {alone}")
                .alone("every {type} disappears")
                .with("type", Value::Name(stype)),
            Effect::KillIfFromAbove => {
                Sentence::of("{one} {one:die|disappears} if {two} {two:come|comes} down on {one:you|it} from above")
                    .scored_if_killed()
            }
            Effect::KillIfHasLess { resource, limit } => Sentence::of(
                "{one} {one:die|disappears} on touching {two} unless {one:you hold|it holds} at least {least} {resource}",
            )
            .with("least", Value::Number(i64::from(limit) + 1))
            .with("resource", Value::Many(resource, i64::from(limit) + 1))
            .scored_if_killed(),
            Effect::KillIfHasMore { resource, limit } => Sentence::of(
                "{one} {one:die|disappears} on touching {two} if {one:you hold|it holds} at least {least} {resource}",
            )
            .with("least", Value::Number(limit.into()))
            .with("resource", Value::Many(resource, limit.into()))
            .scored_if_killed(),
            Effect::KillIfOtherHasMore { resource, limit, subtract } => Sentence::of(
                "{one} {one:die|disappears} on touching {two} if {two:you hold|that holds} at least {least} {resource}{spent}",
            )
            .with("least", Value::Number(limit.into()))
            .with("resource", Value::Many(resource, limit.into()))
            .part("spent", subtract, ", which costs {least} {resource}")
            .scored_if_killed(),
            Effect::KillIfFrontal { frontal: true } => {
                Sentence::of(
                    "{one} {one:die|disappears} on touching {two} if they move head-on at each other or {one:you stand|it stands} still",
                )
                .scored_if_killed()
            }
            Effect::KillIfFrontal { frontal: false } => {
                Sentence::of("{one} {one:die|disappears} on touching {two} unless they move head-on at each other")
                    .scored_if_killed()
            }
            Effect::KillIfSpeed { limit, fast: true } => {
                Sentence::of("{one} {one:die|disappears} on touching {two} if the one that moves is faster than {limit}")
                    .with("limit", Value::Decimal(limit))
                    .scored_always()
            }
            Effect::KillIfSpeed { limit, fast: false } => {
                Sentence::of("{one} {one:die|disappears} on touching {two} if the one that moves is slower than {limit}")
                    .with("limit", Value::Decimal(limit))
                    .scored_always()
            }
            Effect::KillIfNotUpright => {
                Sentence::of("{one} {one:die|disappears} on touching {two} unless upright").scored_always()
            }
            Effect::RemoveScore { kill_second, .. } => {
                Sentence::of("when {one} {one:touch|touches} {two}, the score goes back to 0{gone}")
                    .and_gone(kill_second)
            }
            Effect::AddHealthPoints { value, kill_second, to_max } => {
                let sentence = if to_max {
                    Sentence::of("{one} {one:gain|gains} {points} on touching {two}, up to the limit{gone}")
                } else {
                    Sentence::of(
                        "{one} {one:gain|gains} {points} on touching {two} if that stays below the limit{gone}",
                    )
                };
                sentence
                    .alone("{every} {every:gain|gains} {points}")
                    .with("points", Value::Count(value.into(), "health point"))
                    .and_gone(kill_second)
            }
            Effect::SubtractHealthPoints { value, limit, stype, .. } => {
                let sentence = match stype {
                    None => Sentence::of(
                        "{one} {one:lose|loses} {points} on touching {two}, and {one:die|dies} when {last}",
                    )
                    .alone("{every} {every:lose|loses} {points}, and {every:die|dies} when {last}"),
                    Some(stype) => Sentence::of(
                        "when {one} {one:touch|touches} {two}, that costs {who} {points}, and kills when {last}",
                    )
                    .alone("it costs {who} {points}, and kills when {last}")
                    .with("who", Value::Party(stype)),
                };
                let last = match limit {
                    0 => "none is left".to_owned(),
                    limit => format!("{limit} or fewer are left"),
                };
                sentence
                    .with("points", Value::Count(value.into(), "health point"))
                    .with("last", Value::Text(last))
            }
            Effect::CollectResource { kill_resource } => {
                Sentence::of("{two} {two:collect|collects} {one}{stays}").part(
                    "stays",
                    !kill_resource,
                    ", which stays where it is",
                )
            }
            Effect::CollectResourceIfHeld { held, value, kill_resource } => Sentence::of(
                "{two} {two:collect|collects} {one} if {two:you hold|it holds} at least {least} {resource}{lost}",
            )
            .with("least", Value::Number(value.into()))
            .with("resource", Value::Many(held, value.into()))
            .part("lost", kill_resource, ", and it is lost if there is no room for it"),
            Effect::ChangeResource { resource, value, kill_resource } => {
                let (template, number) = if value < 0 {
                    ("{one} {one:use|uses} up {number} {resource}, if any, on touching {two}{gone}", value.saturating_neg())
                } else {
                    ("{one} {one:gain|gains} {number} {resource} on touching {two}{gone}", value)
                };
                Sentence::of(template)
                    .with("number", Value::Number(number.into()))
                    .with("resource", Value::Many(resource, number.into()))
                    .and_gone(kill_resource)
            }
            Effect::Spawn { stype, prob } => {
                Sentence::of("when {one} {one:touch|touches} {two}, {made} appears there{chance}")
                    .alone("{made} appears at {every}{chance}")
                    .scored_if(prob)
                    .with("made", Value::A(stype))
                    .with("chance", Value::Chance(prob))
            }
            Effect::SpawnIf(SpawnIf { resource, limit, stype, spend, prob, more }) => Sentence::of(
                "when {one} {one:touch|touches} {two} and {one:you hold|it holds} {bound} {limit} {resource}, {made} appears \
                 there{chance}{cost}",
            )
            .with("bound", Value::Text(if more { "at least" } else { "at most" }.to_owned()))
            .with("limit", Value::Number(limit.into()))
            .with("resource", Value::Many(resource, limit.into()))
            .with("made", Value::A(stype))
            .with("chance", Value::Chance(prob))
            .part("cost", more && spend != 0, ", which costs {spend} {spent}")
            .with("spend", Value::Number(spend.into()))
            .with("spent", Value::Many(resource, spend.into()))
            .scored("if it appears, "),
            Effect::SpawnBeside { stype, shift, step_back, prob } => {
                let side = match shift {
                    (0, -1) => "above",
                    (0, 1) => "below",
                    (-1, 0) => "to the left of",
                    _ => "to the right of",
                };
                let sentence = if step_back {
                    Sentence::of(
                        "when {one} {one:touch|touches} {two}, {made} appears {side} the cell that {two} {two:have|has} just left{chance}",
                    )
                    .scored_always()
                } else {
                    Sentence::of("when {one} {one:touch|touches} {two}, {made} appears {side} {two}{chance}")
                        .scored_if(prob)
                };
                sentence
                    .with("made", Value::A(stype))
                    .with("side", Value::Text(side.to_owned()))
                    .with("chance", Value::Chance(prob))
            }
            Effect::SpawnBehind { stype, prob } => {
                Sentence::of(
                    "when {one} {one:touch|touches} {two}, {made} appears in the cell that {two} {two:have|has} just left{chance}",
                )
                    .scored_always()
                    .with("made", Value::A(stype))
                    .with("chance", Value::Chance(prob))
            }
            Effect::SpawnIfCounterSubTypes(SpawnIfCounterSubTypes {
                stype, otherwise, counted, limit, ..
            }) => Sentence::of(
                "when {one} {one:touch|touches} {two}, {made} appears there if there are {limit} {counted} of the right kinds, \
                 else {other}",
            )
            .scored("if so, ")
            .with("made", Value::A(stype))
            .with("limit", Value::Number(limit.into()))
            .with("counted", Value::Many(counted, limit.into()))
            .with("other", Value::A(otherwise)),
            Effect::CloneSprite => {
                Sentence::of("when {one} {one:touch|touches} {two}, another one like {one:you|it} appears")
            }
            Effect::UpdateSpawnType { stype, spawn_point } => Sentence::of(
                "when {one} {one:touch|touches} {two}, every {spawner} makes {made} from then on",
            )
            .with("spawner", Value::Name(spawn_point))
            .with("made", Value::A(stype)),
            Effect::TransformTo { stype, kill_second, .. } => {
                Sentence::of("{one} {one:turn|turns} into {to} on touching {two}{gone}")
                    .alone("{every} {every:turn|turns} into {to}")
                    .with("to", Value::A(stype))
                    .and_gone(kill_second)
            }
            Effect::TransformToAll { stype, to, kill_second, .. } => {
                Sentence::of("when {one} {one:touch|touches} {two}, {alone}{gone}")
                    .alone("every {type} turns into {to}")
                    .with("type", Value::Name(stype))
                    .with("to", Value::A(to))
                    .and_gone(kill_second)
            }
            Effect::TransformToRandomChild { ref options, kill_second, .. } => {
                Sentence::of("{one} {one:turn|turns} into {to} on touching {two}{gone}")
                    .with("to", Value::AnyOf(options.clone()))
                    .and_gone(kill_second)
            }
            Effect::TransformIfCount(ref rule) => {
                let TransformIfCount { stype, counted, at_least, at_most, otherwise, .. } = **rule;
                let many = match (at_least, at_most) {
                    (least, 10_000) => (format!("at least {least}"), least),
                    (0, 0) => ("no".to_owned(), 0),
                    (0, most) => (format!("at most {most}"), most),
                    (least, most) if least == most => (format!("exactly {least}"), least),
                    (least, most) => (format!("{least} to {most}"), most),
                };
                let (many, number) = many;
                let sentence = Sentence::of(
                    "{one} {one:turn|turns} into {to} on touching {two} if there are {many} {counted}{otherwise}",
                )
                .with("to", Value::A(stype))
                .with("many", Value::Text(many))
                .with("counted", Value::Many(counted, number.into()))
                .part("otherwise", otherwise.is_some(), ", and otherwise into {other}")
                .scored("if so, ");
                match otherwise {
                    Some(other) => sentence.with("other", Value::A(other)),
                    None => sentence,
                }
            }
            Effect::TransformToSingleton { stype, other, .. } => Sentence::of(
                "{one} {one:turn|turns} into the {to} on touching {two}, and who was that before becomes {other}",
            )
            .with("to", Value::Name(stype))
            .with("other", Value::A(other)),
            Effect::StepBack { .. } => Sentence::of("{one} cannot enter {two}"),
            Effect::UndoAll { ref spare } => {
                Sentence::of("{one} cannot enter {two}: when {one} {one:touch|touches} {two}, {alone}")
                    .alone("every move of that tick is taken back{spared}")
                    .part("spared", !spare.is_empty(), ", but not that of {spare}")
                    .with("spare", Value::AnyOf(spare.clone()))
            }
            Effect::TurnAround => Sentence::of("{one} {one:turn|turns} around at {two}, two steps further down"),
            Effect::ReverseDirection => {
                Sentence::of("{one} {one:turn|turns} back at {two}").alone("{every} {every:turn|turns} back")
            }
            Effect::FlipDirection => {
                Sentence::of("{one} {one:turn|turns} in a random direction on touching {two}")
                    .alone("{every} {every:turn|turns} in a random direction")
            }
            Effect::AttractGaze { prob, align } => Sentence::of(
                "{one} {one:turn|turns} to face the way of {two} on touching {two}{aligned}{chance}",
            )
            .part("aligned", align, ", in line with it")
            .scored_if(prob)
            .with("chance", Value::Chance(prob)),
            Effect::Align { orient } => {
                Sentence::of("{one} {one:are|is} put in the place of {two} on touching {two}{turned}").part(
                    "turned",
                    orient,
                    ", and {one:face|faces} its way",
                )
            }
            Effect::BounceForward => Sentence::of("{two} {two:push|pushes} {one}"),
            Effect::PullWithIt { .. } => Sentence::of("{two} {two:carry|carries} {one} along"),
            Effect::TeleportToExit => {
                Sentence::of("{one} {one:jump|jumps} to where {two} leads on touching {two}")
            }
            Effect::WrapAround { .. } => {
                Sentence::of("{one} {one:come|comes} in again at the opposite edge on reaching {two}")
            }
            Effect::HalfSpeed => {
                Sentence::of("{one} {one:slow down|slows down} to half speed on touching {two}")
            }
            Effect::ChangeSpeed { stype, value, how } => {
                let alone = match how {
                    SpeedChange::Increase => "each step of every {type} becomes {value} longer",
                    SpeedChange::Decrease => "each step of every {type} becomes {value} shorter",
                    SpeedChange::Set => "each step of every {type} becomes {value} long",
                };
                let cells = if value == 1.0 { "a cell".to_owned() } else { format!("{value} cells") };
                Sentence::of("when {one} {one:touch|touches} {two}, {alone}")
                    .alone(alone)
                    .with("type", Value::Name(stype))
                    .with("value", Value::Text(cells))
            }
            Effect::WaterPhysics => {
                Sentence::of("{one} {one:sink|sinks} slowly from then on on touching {two}")
            }
            Effect::BounceDirection { .. } => {
                Sentence::of("{one} {one:bounce|bounces} off {two}, the steeper the further from its middle")
            }
            Effect::WallStop => {
                Sentence::of("{one} {one:stop|stops} at {two}, and can only go along it")
            }
            Effect::WallBounce => Sentence::of("{one} {one:bounce|bounces} off {two}"),
            Effect::WallReverse => Sentence::of("{one} {one:turn|turns} back at {two}"),
            Effect::AddTimer { timed } => {
                Sentence::of("when {one} {one:touch|touches} {two}, {delay} later {planned}")
                    .with("delay", Value::Delay(timed))
                    .with("planned", Value::Planned(timed))
            }
            Effect::ShieldFrom { stype, .. } => Sentence::of(
                "while {one} {one:touch|touches} {two}, {one:you|it} {one:are|is} safe from {from}",
            )
            .with("from", Value::Party(stype)),
            Effect::Disabled(_) => Sentence::of_nothing(),
        }
    }
}
