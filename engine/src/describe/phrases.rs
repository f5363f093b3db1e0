//! Templates with named placeholders, for parts of sentences and for sentences that do not come from effects.

use crate::rules::effects::templates;
use std::collections::BTreeSet;

/// Declares the phrases, each with its template.
macro_rules! phrases {
    ($($name:ident: $text:literal,)*) => {
        /// The template for a sentence or a part of a sentence.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(super) enum Phrase { $($name,)* }

        impl Phrase {
            pub(super) const ALL: &[Phrase] = &[$(Phrase::$name,)*];

            pub(super) fn text(self) -> &'static str {
                match self { $(Phrase::$name => $text,)* }
            }
        }
    };
}

phrases! {
    // The course of a tick.
    YouThenOthers: "Each tick you act, then the others act, then contacts count, in the order of the lines below.",
    YouThenContacts: "Each tick you act, then contacts count, in the order of the lines below.",
    Touch: "Sprites touch in each tick in which they overlap after the moves; swapping places is no touch. Sprites that no line names together pass over each other.",
    Period: "What moves every N ticks does so N, 2N, 3N ticks after it appeared{sooner}; a blocked move is lost.",
    Sooner: ", a tick sooner for the {names}",
    Rest: "What moves straight ahead waits one tick after it appears.",
    RestFirst: "What moves straight ahead does not move in the tick in which it appears.",
    Glide: "While gliding between two cells, a sprite touches everything in both.",
    Clock: "What is due by the clock happens before contacts.",
    PutBack: "A bump is a touch for the lines above the one that stops the mover, but for those below only if both still share a cell then.",
    Lingers: "What disappears still blocks and touches others in that tick{reopened}.",
    Reopened: ": what you open lets you in at the next press",
    AtLimit: "At the limit of what can be held, more stays where it is and brings no points.",
    HeldUncounted: "Lines that count sprites do not count held ones.",
    TooMuch: "A gain beyond the limit of what can be held does not happen, not even in part.",
    ChaseStep: "Chasers take a step nearer, not around obstacles, at random if several are.",
    Paths: "A shortest way leads around where {obstacles} stood at the start, and is always the same between two cells; the walker runs into anything else that stops it, and waits there.",
    PathsFree: "A shortest way leads through everything, and is always the same between two cells; the walker runs into what stops it, and waits there.",
    FleeStep: "Fleeing ones take a step further away, sideways too, at random if several are.",
    NoTarget: "With none to chase or flee{near}, the step is in a random direction.",
    TieLost: "If you win and lose in the same tick, you lose.",
    TieWon: "If you win and lose in the same tick, you win.",
    TieUnlessDead: "If you win and lose in the same tick, you win, unless you died.",
    TieUnlessTime: "If you win and lose in the same tick, you lose, unless only time runs out.",
    TieMixed: "If you win and lose in the same tick, you win, but you lose {ways}.",
    TieOrder: "Of several ways to win or lose in one tick, the first of these counts: {ways}.",
    // Movement.
    MovesTo: "moves {way}, {pace}",
    MovesFirstTo: "moves {way} at first, {pace}",
    Faces: "faces {way}",
    FacesFirst: "faces {way} at first",
    FacesPush: "faces {way} at first, and the way of its last push after that",
    MovesAnyWay: "moves straight in a random direction, {pace}",
    MovesAhead: "moves straight ahead, {pace}",
    Falls: "falls",
    SetOff: "stands until a rule gives it speed",
    Wanders: "wanders at random, {pace}",
    WandersAnew: "wanders, {pace}, each time up, left, down or right at random",
    Chases: "chases {target}{near}, {pace}",
    Flees: "flees from {target}{near}, {pace}",
    Near: " within {distance}",
    Follows: "follows a shortest way to {target}, {pace}",
    LooksOut: "chases {target} where it is straight ahead of its last step, and else wanders, {pace}",
    Strays: "takes a random step instead with a chance of {chance}",
    // Making other sprites.
    Makes: "makes {made} every {period}{from}{chance}{total}",
    From: ", first in tick 1",
    Soon: ", first within {period}",
    Total: ", {total} in all, and then disappears",
    Spreads: "puts {made} into each of the four cells beside it, whatever is there, {delay} after it appears{chance}",
    SpreadsOne: "puts {made} into one of the four cells beside it, whatever is there, {delay} after it appears{chance}",
    SpreadsUp: "puts {made} into the cell above it, whatever is there, {delay} after it appears",
    // Other properties.
    LeadsTo: "leads to a random {exit}, and kills if there is none",
    Held: "can be held, up to {limit}{each}",
    HeldBeyond: "can be collected up to {limit}, and held beyond that{each}",
    Each: ", {value} each",
    Vanishes: "vanishes {ticks} after it appears",
    Health: "has {points}{most}",
    Single: "only one exists at a time: no other is made until it is gone",
    SingleOnly: "exists only once at a time: no other is made until it is gone",
    Hidden: "cannot be seen",
    Idle: "Everything else does nothing by itself.",
    WalkOver: "You can walk over the {names}.",
    // The player.
    NoAvatar: "You control nothing: the engine finds no avatar when a level starts, so no key does anything, and the game stops without a winner at the first rule that counts points.",
    Shoots: "; the use key puts {made} into the cell ahead of you, empty or not{cost}",
    StillTurns: "; a blocked step still turns you",
    Drops: "; the use key puts {made} where you are{cost}",
    Leaves: "; you leave {made} behind",
    Builds: "; the up key puts {made} beside you",
    KeyShoots: "the {key} key shoots {made}",
    Costs: ", which costs {costs}",
    CostsMore: ", which costs {costs}, if you hold more than {least}",
    HasHealth: "; you start with {points}{most}",
    Most: ", and the limit is {limit}",
    // Groups and times.
    Group: "Any {name} means {members}.",
    Every: "every {period} from tick {first} on, {planned}",
    Once: "at tick {tick}, {planned}",
    // Points.
    Gains: "you gain {points}",
    Loses: "you lose {points}",
    Instead: "If that kills, {points} instead.",
    Counter: "Counter {number} changes by {change}.",
    // Endings.
    Gone: "when you are gone",
    NoneLeft: "when no {name} is left",
    AtMost: "when at most {limit} {name} {are} left",
    AtLeast: "when there {are} at least {limit} {name}",
    OnlyLeft: "when only {limit} {name} {are} left",
    Exactly: "when there {are} exactly {limit} {name}",
    Survive: "if you last until tick {tick}",
    Reached: "when tick {tick} is reached",
    OfKinds: ", of exactly {kinds}",
    HeldUp: ", unless there {are} exactly {limit} {name}{then}",
    HeldUpBy: ", unless there {are} more than {limit} {name}{then}",
    Before: " at the end of the tick before",
    NotFirst: ", and not in the first tick",
    Repeated: "{name} (each counted {times} times)",
    UnlessZero: ", if your score is not 0",
    AndZero: " and your score is 0",
    UnlessEqual: ", if the counters are not all the same",
    AndEqual: " and the counters are all the same",
    IfCounter: ", if the counter is at {value}",
    AndCounter: " and the counter is not at {value}",
}

impl Phrase {
    /// Returns the template with each placeholder replaced by the text of the same name.
    pub(super) fn with(self, values: &[(&str, &str)]) -> String {
        let mut text = String::new();
        let mut rest = self.text();
        while let Some((before, after)) = rest.split_once('{') {
            let (hole, after) = after.split_once('}').expect("a hole of a template ends");
            let value = values.iter().find(|(name, _)| *name == hole);
            text += before;
            text += value.expect("a hole of a template has a value").1;
            rest = after;
        }
        text + rest
    }
}

/// Returns the templates for all sentences and parts of sentences. `{one}` and `{two}` are the colliding
/// sprites, `{one:die|disappears}` is a word that agrees with the sprite `{one}`, and all other placeholders
/// are values.
///
/// ```
/// let all = infinite_arcade_engine::describe::texts();
/// assert!(all.contains(&"{one} cannot enter {two}") && all.contains(&"when no {name} is left"));
/// ```
pub fn texts() -> Vec<&'static str> {
    let mut texts: Vec<&'static str> = templates().collect();
    texts.extend(Phrase::ALL.iter().map(|phrase| phrase.text()));
    let mut seen = BTreeSet::new();
    texts.retain(|text| seen.insert(*text));
    texts
}
