//! The taxonomy of games: time, space and genre, derived from the rules alone.
//!
//! Every term has exactly one definition. Names do not matter: renaming a game's sprites does not change its
//! taxonomy.

use super::Analysis;
use crate::analysis::goals::attain;
use crate::analysis::goals::win_methods::{WinMethod, WinMethods};
use crate::analysis::interactions::encounter::{EffectSummary, Encounter};
use crate::analysis::interactions::lock::{Key, Sink};
use crate::analysis::interactions::touch::Touch;
use crate::analysis::types::facts::{Motion, Steering};
use crate::analysis::types::role::Role;
use crate::rules::SpriteType;
use crate::rules::class::SpriteClass;
use crate::rules::effects::{SpeedChange, SpeedEffect};
use serde::{Deserialize, Serialize};

/// The minimum amount of a resource that an exit must require for the game to count as a collecting game.
/// Smaller amounts count as keys.
const MANY: i32 = 3;

/// A game's classification.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct Taxonomy {
    /// The game's pace: turn-based or real-time.
    pub time: Time,
    /// The greatest spatial freedom that any possible avatar type gives the player. Later variants mean more
    /// freedom.
    pub spatiality: Spatiality,
    /// The genres, starting with the main genre. Empty if no genre fits.
    pub genres: Vec<Genre>,
    /// `true` if randomness can have an effect: see [`Analysis::is_stochastic`].
    pub chance: bool,
    /// `true` if sprites invisible to the player can have an effect: see [`Analysis::unseen`].
    pub hidden: bool,
}

base::named_enum! {
    /// The game's pace: turn-based or real-time.
    pub enum Time {
        /// Nothing moves, appears or disappears unless the player acts. Exceptions are short-lived effects of
        /// an action (a shot, a puff of smoke), sprites without rules, and a limit on the number of ticks.
        TurnBased = "turn-based",
        /// Something changes without an action by the player.
        RealTime = "real-time",
    }
}

base::named_enum! {
    /// The player's spatial freedom.
    pub enum Spatiality {
        /// The avatar stays in its cell.
        Fixed = "fixed",
        /// The avatar moves along one axis only, in steps or by drifting.
        Line = "line",
        /// The avatar moves along both axes, up, left, down and right, in steps of whole cells or parts of cells.
        Grid = "grid",
        /// The avatar has a velocity that the keys may change, and does not fall.
        Continuous = "continuous",
        /// The avatar has a velocity that the keys change, and falls.
        Gravity = "gravity",
    }
}

base::named_enum! {
    /// A game's genre. If several genres fit, they are listed in this order. However, shooting that does not
    /// lead to a win comes last if something other than waiting leads to a win.
    pub enum Genre {
        /// The avatar falls, walks and jumps.
        Platformer = "platformer",
        /// The player and other sprites compete for the same goal. Whoever reaches it first decides whether
        /// the game is won or lost.
        Race = "race",
        /// Pushing sprites to certain cells wins or opens a path. Alternatively, the game is on a grid with
        /// an avatar that can stop, winning requires more than waiting, and there are neither random effects
        /// nor moving hostile sprites.
        Puzzle = "puzzle",
        /// The avatar, on a grid, must avoid traffic that it cannot shoot: harmful sprites that keep moving
        /// straight ahead and reappear at the opposite edge.
        Crossing = "crossing",
        /// The avatar's shots remove moving sprites that must be removed for a win. Alternatively, the shots
        /// move and remove hostile sprites.
        Shooter = "shooter",
        /// The avatar must catch sprites that move on their own.
        Hunt = "hunt",
        /// The avatar must collect motionless sprites: all sprites of a type, or many of a resource that an
        /// exit requires.
        Collect = "collect",
        /// The player must find a key to open a lock.
        Adventure = "adventure",
        /// Touching an exit wins. The exit is a door, something dangerous to touch, or the only type that
        /// must be touched while other types merely give points.
        Escape = "escape",
        /// The player must bring other sprites together with something. The actions of these sprites achieve
        /// the win, not the player's touch, shots or pushes.
        Guide = "guide",
        /// Something other than the avatar must be protected.
        Defence = "defence",
        /// Surviving until a certain tick wins.
        Survive = "survive",
    }
}

impl Analysis {
    /// Classifies the game. Cost: O(types × avatars + interactions).
    pub fn taxonomy(&self) -> Taxonomy {
        Taxonomy {
            time: self.time(),
            spatiality: self.spatiality(),
            genres: self.genres(),
            chance: self.is_stochastic,
            hidden: !self.unseen.is_empty(),
        }
    }

    fn time(&self) -> Time {
        let rules = &*self.game.0;
        let drifts = |stype: SpriteType| rules.types[stype.index()].traits.continuous;
        let drifting = self.avatars.iter().any(|avatar| drifts(avatar.stype));
        let fades = |stype: SpriteType| {
            let fact = self.facts(stype);
            let placed = fact.possible && !fact.symbols.is_empty();
            placed && attain::disappears_by_itself(rules, stype) && self.takes_part(stype)
        };
        // Find sprites that stand still until an interaction gives them a speed.
        let sets_off = |encounter: &Encounter| {
            use SpeedChange as How;
            let speed = &rules.effects[usize::from(encounter.effect)].summary.speed;
            let Some(SpeedEffect::OfAll { stype, value, how: How::Set | How::Increase }) = speed else {
                return false;
            };
            let starts = |stype: &SpriteType| {
                let info = &rules.types[stype.index()];
                let avatar = info.class.is_none_or(|class| class.is_avatar());
                !avatar && info.traits.is_oriented && !info.traits.is_static
            };
            *value > 0.0 && rules.types[stype.index()].tree.iter().any(starts)
        };
        let idle = self.is_turn_based() && !drifting && !self.encounters.iter().any(sets_off);
        if idle && !self.game.sprite_types().any(fades) { Time::TurnBased } else { Time::RealTime }
    }

    /// Returns `true` if some interaction or termination concerns the type.
    fn takes_part(&self, stype: SpriteType) -> bool {
        let meets = self.encounters.iter().any(|encounter| {
            self.applies(encounter.first, stype)
                || encounter.second.is_some_and(|second| self.applies(second, stype))
        });
        meets || self.goals.iter().any(|goal| goal.condition.types().contains(&stype))
    }

    fn spatiality(&self) -> Spatiality {
        let of = |avatar: &super::Avatar| {
            let traits = &self.game.0.types[avatar.stype.index()].traits;
            let falls = traits.gravity > 0.0 || avatar.steering == Steering::Jumping;
            match avatar.steering {
                _ if traits.continuous && falls => Spatiality::Gravity,
                Steering::Fixed if !traits.continuous => Spatiality::Fixed,
                Steering::Horizontal | Steering::Vertical => Spatiality::Line,
                _ if traits.continuous => Spatiality::Continuous,
                _ if traits.stationary && avatar.steering.waits_for_keys() => Spatiality::Fixed,
                _ => Spatiality::Grid,
            }
        };
        self.avatars.iter().map(of).max().unwrap_or(Spatiality::Fixed)
    }

    fn genres(&self) -> Vec<Genre> {
        use Genre as G;
        let methods = WinMethods::of(self);
        let means = methods.methods();
        let has = |wanted: WinMethod| means.contains(&wanted);
        let waits = means.iter().all(|&means| means == WinMethod::Wait);
        let exit = has(WinMethod::Exit);
        let calm = !self.is_stochastic && self.of_role(Role::Enemy).next().is_none();
        let on_grid = self.spatiality() == Spatiality::Grid;
        let stops = self.start_avatar().is_some_and(|avatar| avatar.steering == Steering::FourWay);
        let guarded = |stype: SpriteType| {
            let protected = self.aims.protect.binary_search(&stype).is_ok() && self.facts(stype).possible;
            protected && self.role(stype) == Role::Ward
        };
        let amounts = self.locks.iter().map(|lock| match lock.key {
            Key::Resource { amount, .. } => amount,
            Key::Avatar(_) | Key::Switch(..) => 1,
        });
        let amounts: Vec<i32> = amounts.collect();
        let shoots = methods.shoots();
        let fits = [
            (G::Platformer, self.has_class(SpriteClass::PlatformerAvatar)),
            (G::Race, self.is_race()),
            (G::Puzzle, has(WinMethod::Push) || self.bridges() || (calm && on_grid && stops && !waits)),
            (G::Crossing, on_grid && self.has_traffic(&methods)),
            (G::Shooter, has(WinMethod::Shoot) || (shoots && waits)),
            (G::Hunt, has(WinMethod::Catch)),
            (G::Collect, has(WinMethod::Take) || (exit && amounts.iter().any(|&amount| amount >= MANY))),
            (G::Adventure, amounts.iter().any(|&amount| amount < MANY)),
            (G::Escape, exit),
            (G::Guide, has(WinMethod::Others)),
            (G::Defence, self.game.sprite_types().any(guarded)),
            (G::Survive, has(WinMethod::Wait)),
            (G::Shooter, shoots && !waits && !has(WinMethod::Shoot)),
        ];
        fits.into_iter().filter(|(_, fits)| *fits).map(|(genre, _)| genre).collect()
    }

    fn has_class(&self, class: SpriteClass) -> bool {
        let of = |avatar: &super::Avatar| self.game.class(avatar.stype);
        self.avatars.iter().filter_map(of).any(|own| own.is_a(class))
    }

    /// Returns `true` if a pushed sprite can open a path by filling a type that blocks or harms the avatar.
    fn bridges(&self) -> bool {
        let bars = |stype: SpriteType| {
            let blocks = self.touches.iter().any(|row| row[stype.index()].blocks);
            blocks || self.harm(stype) != super::Harm::None
        };
        let fills = |sink: &Sink| {
            let lies = self.facts(sink.partner).motion == Motion::Still;
            sink.fills && lies && bars(sink.partner)
        };
        self.pushables.iter().any(|pushable| pushable.sinks.iter().any(fills))
    }

    /// Returns `true` if some harmful type that cannot be shot moves straight ahead and reappears at the
    /// opposite edge.
    fn has_traffic(&self, methods: &WinMethods<'_>) -> bool {
        self.of_role(Role::Enemy).any(|stype| {
            let wraps =
                self.at_edge(stype).any(|encounter| encounter.does(|effect| *effect == EffectSummary::Wrap));
            let straight = matches!(self.facts(stype).motion, Motion::Straight(_));
            wraps && straight && !methods.is_shot_down(stype)
        })
    }

    /// Returns `true` if the outcome depends on who reaches something first. The game is then lost if a type
    /// that moves by itself touches the type that the avatar must touch to win. Alternatively, the moving
    /// type's touch can cause either result.
    fn is_race(&self) -> bool {
        let (wins, losses) = (&self.aims.create, &self.aims.prevent);
        let runs = |stype: &SpriteType| {
            let fact = self.facts(*stype);
            fact.possible && !matches!(fact.motion, Motion::Still | Motion::Steered)
        };
        let finish = self.encounters.iter().filter(|encounter| {
            let tree = &self.game.0.types[encounter.first.index()].tree;
            tree.iter().any(runs) && encounter.brings_one_of(losses)
        });
        finish.filter_map(|encounter| Some((encounter, encounter.second?))).any(|(encounter, goal)| {
            let thing = self.facts(goal).motion != Motion::Steered;
            let won = |row: &Vec<Touch>| {
                let touch = &row[goal.index()];
                touch.makes.iter().chain(&touch.changes).any(|made| wins.binary_search(made).is_ok())
            };
            thing && (encounter.brings_one_of(wins) || self.touches.iter().any(won))
        })
    }
}
