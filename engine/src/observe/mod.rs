//! Observations for players, and full records of states for comparison with traces.

pub(crate) mod planes;

use crate::game::Game;
use crate::limits::MAX_SEEN;
use crate::numbers::geometry::{Direction, Rect};
use crate::rules::class::SpriteClass;
use crate::rules::effects::{Ending, Side, Target};
use crate::rules::{Outcome, SpriteType, Timed};
use crate::state::State;
use crate::tick::sprites::npcs::path_ahead;
use crate::world::{Sprite, Timer, World, flag};

/// An observation: the part of a state that is visible to players.
#[derive(Clone, Debug, PartialEq)]
pub struct Observation {
    /// The number of ticks played.
    pub ticks: u32,
    /// The score.
    pub score: f64,
    /// The outcome of the episode so far.
    pub outcome: Outcome,
    /// The number of columns of the board.
    pub columns: usize,
    /// The number of rows of the board.
    pub rows: usize,
    /// For each cell in row-major order, the names of the sprites that overlap it, in drawing order, without
    /// hidden sprites.
    pub cells: Vec<Vec<String>>,
    /// The resources that the avatar holds, as pairs of name and amount, sorted by name.
    pub resources: Vec<(String, i32)>,
    /// The player's avatar, regardless of its type's name, or `None` once the avatar is gone.
    pub avatar: Option<AvatarView>,
    /// The visible non-avatar sprites that follow paths, or that can move and have an orientation. Sorted in
    /// drawing order.
    pub movers: Vec<MoverView>,
    /// The countdowns of visible sprites ([`Game::countdowns`]).
    pub countdowns: Vec<CountdownView>,
}

/// A countdown with the name of its type.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CountdownView {
    /// The name of the type.
    pub name: String,
    /// The countdown.
    pub countdown: Countdown,
}

/// The observable properties of a sprite that follows paths, or that can move and has an orientation.
#[derive(Clone, Debug, PartialEq)]
pub struct MoverView {
    /// The name of the sprite's type.
    pub name: String,
    /// The column of the cell that contains the sprite's centre, from 0 at the left.
    pub column: i32,
    /// The row of the cell that contains the sprite's centre, from 0 at the top.
    pub row: i32,
    /// The direction in which the sprite moves. If the sprite follows paths, the direction of its next step
    /// while its target stays, or [`Direction::NONE`] if it has no target or no path.
    pub facing: Direction,
}

/// The observable properties of the avatar.
#[derive(Clone, Debug, PartialEq)]
pub struct AvatarView {
    /// The name of the avatar's type, which may change as the avatar transforms.
    pub name: String,
    /// The column of the cell that contains the avatar's centre, from 0 at the left. Out of range while the
    /// avatar is off the board.
    pub column: i32,
    /// The row of the cell that contains the avatar's centre, from 0 at the top.
    pub row: i32,
    /// The direction that the avatar faces.
    pub facing: Direction,
    /// The avatar's health points, or 0 in games without health.
    pub health: i32,
}

/// The properties of a sprite that golden traces record.
#[derive(Clone, Debug, PartialEq)]
pub struct SpriteRecord {
    /// The sprite's creation number.
    pub id: u32,
    /// The index of the sprite's type in the registry.
    pub stype: u16,
    /// The sprite's position and size in pixels.
    pub rect: Rect,
    /// The sprite's orientation.
    pub orientation: (f64, f64),
    /// The sprite's speed.
    pub speed: f64,
    /// The sprite's health points.
    pub health: i32,
    /// The sum of the sprite's flags: 1 for disabled, 2 for an avatar, 4 for created by the avatar, 8 for on
    /// the ground.
    pub flags: u16,
    /// The resources that the sprite holds, sorted by type. Each entry contains the type ([`u16::MAX`] for an
    /// undeclared type) and the amount.
    pub resources: Vec<(u16, i32)>,
    /// The sprite's rotation in radians.
    pub rotation: f64,
}

/// The event at the end of a countdown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The sprite can take its next step.
    Moves,
    /// The sprite creates another sprite.
    Makes,
    /// The sprite turns into a sprite of another type.
    Turns,
    /// The sprite vanishes.
    Ends,
}

/// A sprite's countdown, or the countdown to a timed effect on a type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Countdown {
    /// The sprite's type.
    pub stype: SpriteType,
    /// The column and the row of the cell that contains the sprite's centre, or `None` for a timed effect.
    pub cell: Option<(i32, i32)>,
    /// The event at the end of the countdown.
    pub event: Event,
    /// The number of steps until the event, at least 1, or `None` if the event is random.
    pub ticks: Option<i32>,
    /// The number of sprites that the sprite can still create, or `None` for no limit.
    pub left: Option<i32>,
}

/// The categories that the reference passes to its planners (`spec/01` §9.5). If several apply, the first one
/// is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Category {
    /// A sprite that the player can control.
    Avatar,
    /// A sprite that can be held.
    Resource,
    /// A door, a portal, or a sprite declared as a portal.
    Portal,
    /// A character that decides its own moves.
    Npc,
    /// A sprite that never moves.
    Static,
    /// Any other sprite that moves.
    Movable,
}

impl Game {
    /// Returns the category of a type's sprites. If that category is [`Category::Static`] or
    /// [`Category::Movable`], sprites that an avatar creates have a different category.
    pub fn category(&self, stype: SpriteType) -> Category {
        let info = &self.0.types[stype.index()];
        match &info.traits {
            _ if info.is_like_avatar() => Category::Avatar,
            traits if traits.is_resource => Category::Resource,
            traits if traits.portal => Category::Portal,
            traits if traits.is_npc => Category::Npc,
            traits if traits.is_static => Category::Static,
            _ => Category::Movable,
        }
    }

    /// Returns `true` if observations omit sprites of the type.
    pub fn is_hidden(&self, stype: SpriteType) -> bool {
        self.0.types[stype.index()].traits.hidden
    }

    /// Returns the observation of a state. Only the first [`MAX_SEEN`] names are included. This limit matters
    /// only for boards full of giant sprites. Cost: O(sprites + cells).
    pub fn observe(&self, state: &State) -> Observation {
        let (columns, rows) = (state.world.columns() as usize, state.world.rows() as usize);
        let mut cells = vec![Vec::new(); columns * rows];
        let mut room = MAX_SEEN;
        let mut movers = Vec::new();
        for &stype in &self.0.order {
            let info = &self.0.types[stype.index()];
            if info.traits.hidden {
                continue;
            }
            let follows = self.0.finds_paths && info.class == Some(SpriteClass::PathChaser);
            let is_mover =
                follows || info.traits.is_oriented && !info.traits.is_static && !info.is_like_avatar();
            for sprite in state.world.sprites_of(stype) {
                if is_mover && movers.len() < MAX_SEEN {
                    let (column, row) = centre(&state.world, sprite.rect);
                    movers.push(MoverView {
                        name: info.name.clone(),
                        column,
                        row,
                        facing: match follows {
                            true => path_ahead(&self.0, &state.world, &sprite),
                            false => state.world.overrides_of(&sprite).orientation,
                        },
                    });
                }
                let span = |from: i32, size: i32, limit: i32| {
                    let first = from.div_euclid(state.world.block()).clamp(0, limit);
                    let last = from
                        .saturating_add(size.saturating_sub(1))
                        .div_euclid(state.world.block())
                        .clamp(-1, limit - 1);
                    first as usize..(last + 1) as usize
                };
                for row in span(sprite.rect.y, sprite.rect.h, state.world.rows()) {
                    let seen = span(sprite.rect.x, sprite.rect.w, state.world.columns()).take(room);
                    for column in seen {
                        room -= 1;
                        cells[row * columns + column].push(info.name.clone());
                    }
                }
            }
        }
        let resources = self.held_by_avatar(state);
        let (ticks, score, outcome) = ((state.world.tick() + 1) as u32, state.score(), state.world.outcome());
        let avatar = self.seen_avatar(state);
        let view =
            |countdown: Countdown| CountdownView { name: self.name(countdown.stype).to_owned(), countdown };
        let countdowns = self.countdowns(state).into_iter().take(MAX_SEEN).map(view).collect();
        Observation { ticks, score, outcome, columns, rows, cells, resources, avatar, movers, countdowns }
    }

    /// Returns the avatar's observable properties, or `None` if there is no living avatar. Cost: O(1).
    pub fn seen_avatar(&self, state: &State) -> Option<AvatarView> {
        let stype = state.avatar_type()?;
        let (sprite, overrides) =
            (state.world.sprite(state.world.avatar()), state.world.overrides(state.world.avatar()));
        let (column, row) = centre(&state.world, sprite.rect);
        Some(AvatarView {
            name: self.name(stype).to_owned(),
            column,
            row,
            facing: overrides.orientation,
            health: overrides.health,
        })
    }

    /// Returns the resources that the avatar holds, as pairs of name and amount, sorted by name.
    pub fn held_by_avatar(&self, state: &State) -> Vec<(String, i32)> {
        let held = state.world.held_by(state.world.avatar()).iter();
        let mut resources: Vec<_> =
            held.map(|held| (self.name(held.resource).to_owned(), held.amount)).collect();
        resources.sort();
        resources
    }

    /// Returns the record of every sprite, by ascending ID, for conformance tests and debugging. Cost: O(sprites log
    /// sprites).
    pub fn records(&self, state: &State) -> Vec<SpriteRecord> {
        let record = |sprite: &Sprite, resources: Vec<(u16, i32)>| {
            let overrides = state.world.overrides_of(sprite);
            SpriteRecord {
                id: sprite.id,
                stype: sprite.stype.0,
                rect: sprite.rect,
                orientation: (overrides.orientation.x, overrides.orientation.y),
                speed: overrides.speed,
                health: overrides.health,
                flags: (sprite.flags & flag::RECORDED) as u16,
                resources,
                rotation: state.world.rotation(&self.0, sprite),
            }
        };
        let slots = self.sprite_types().flat_map(|stype| state.world.slots(stype)).map(|slot| {
            let held = state.world.held_by(slot).iter();
            let resources = held.map(|held| (held.resource.0, held.amount)).collect();
            record(&state.world.present(slot), resources)
        });
        let scenery = self.sprite_types().flat_map(|stype| state.world.scenery_of(stype));
        let scenery = scenery.map(|sprite| record(sprite, Vec::new()));
        let mut records: Vec<SpriteRecord> = slots.chain(scenery).collect();
        records.sort_unstable_by_key(|record| record.id);
        records
    }

    /// Returns the countdowns of sprites that create other sprites, vanish on their own or cannot move in
    /// every tick. They are sorted by type and then by creation. After these come the countdowns to timed
    /// effects on types that currently have sprites, in order of execution. Cost: O(sprites with countdowns +
    /// timers).
    pub fn countdowns(&self, state: &State) -> Vec<Countdown> {
        let own = self.sprite_types().filter(|&stype| !self.is_hidden(stype)).flat_map(|stype| {
            let changes = self.changes_by_itself(stype);
            let rests = self.rests_between_moves(stype);
            let sprites = state.world.sprites_of(stype).filter(move |_| changes || rests);
            sprites.flat_map(move |sprite| {
                let change = changes.then(|| self.next_change(state, &sprite));
                let moves = rests && !sprite.is(flag::FROZEN);
                change.into_iter().chain(moves.then(|| self.next_move(state, &sprite)))
            })
        });
        own.chain(self.timed_countdowns(state)).collect()
    }

    /// Returns `true` if sprites of the type create other sprites or vanish on their own.
    fn changes_by_itself(&self, stype: SpriteType) -> bool {
        use SpriteClass as C;
        let classes = [C::SpawnPoint, C::Flicker, C::OrientedFlicker];
        self.class(stype).is_some_and(|own| classes.iter().any(|&class| own.is_a(class)))
    }

    /// Returns `true` if sprites of the type move on their own or when a key is pressed, but cannot move in
    /// every tick.
    fn rests_between_moves(&self, stype: SpriteType) -> bool {
        let info = &self.0.types[stype.index()];
        let traits = &info.traits;
        let walks = !traits.stationary && (traits.is_npc || info.is_like_avatar());
        let drifts = traits.is_oriented && !traits.only_active && traits.speed != 0.0;
        traits.cooldown > 1 && !traits.continuous && !traits.is_static && (walks || drifts)
    }

    /// Returns the countdown to the next tick in which a sprite can move.
    fn next_move(&self, state: &State, sprite: &Sprite) -> Countdown {
        let traits = &self.0.types[sprite.stype.index()].traits;
        let age = state.world.tick().wrapping_sub(sprite.moved_at);
        let ticks = traits.cooldown.saturating_sub(age).max(1);
        Countdown {
            stype: sprite.stype,
            cell: Some(centre(&state.world, sprite.rect)),
            event: Event::Moves,
            ticks: Some(ticks),
            left: None,
        }
    }

    /// Returns the countdown to the next tick in which a sprite creates another sprite or vanishes on its own.
    fn next_change(&self, state: &State, sprite: &Sprite) -> Countdown {
        use SpriteClass as C;
        let is_a = |class: C| self.class(sprite.stype).is_some_and(|own| own.is_a(class));
        let traits = &self.0.types[sprite.stype.index()].traits;
        let (event, ticks, left) =
            if is_a(C::Spreader) && sprite.count < 2 && traits.spread_probability >= 1.0 {
                // A spreader spreads at age 2.
                (Event::Makes, Some(2_i32.saturating_sub(sprite.count)), None)
            } else if !is_a(C::SpawnPoint) {
                let ticks = traits.limit.saturating_sub(sprite.count).saturating_add(2).max(1);
                (Event::Ends, Some(ticks), None)
            } else {
                let next = state.world.tick().saturating_add(1);
                // A producer's first update sets its start tick.
                let start =
                    if sprite.is(flag::STARTED) { state.world.overrides_of(sprite).start } else { next };
                let gone = start.wrapping_add(next).rem_euclid(traits.cooldown.max(1));
                let ticks = if gone == 0 { 1 } else { traits.cooldown - gone + 1 };
                let left = (traits.total > 0).then(|| traits.total.saturating_sub(sprite.count));
                (Event::Makes, (traits.prob >= 1.0).then_some(ticks), left)
            };
        Countdown { stype: sprite.stype, cell: Some(centre(&state.world, sprite.rect)), event, ticks, left }
    }

    /// Returns `true` if [`Game::countdowns`] can contain countdowns to timed effects.
    pub fn has_timed_countdowns(&self) -> bool {
        self.0.timed.iter().any(|timed| self.timed_event(timed).is_some())
    }

    fn timed_countdowns<'a>(&'a self, state: &'a State) -> impl Iterator<Item = Countdown> + use<'a> {
        let countdown = |timer: &Timer| {
            let (stype, event) = self.timed_event(&self.0.timed[usize::from(timer.timed)])?;
            let ticks = timer.due.saturating_sub(state.world.tick()).max(1);
            (state.alive(stype) > 0).then_some(Countdown {
                stype,
                cell: None,
                event,
                ticks: Some(ticks),
                left: None,
            })
        };
        state.world.timers().iter().rev().filter_map(countdown)
    }

    /// Returns the event that a timed effect causes, and the type that it concerns. Returns `None` for effects without
    /// a visible event, and for effects that run in every tick or every second tick.
    fn timed_event(&self, timed: &Timed) -> Option<(SpriteType, Event)> {
        if timed.repeating && timed.timer <= 2 {
            return None;
        }
        let effects = &self.0.effects[usize::from(timed.effect)].summary.effects;
        let event = effects.iter().find_map(|effect| match effect.ending() {
            Some((Target::All(of), Ending::Turned)) => Some((of, Event::Turns)),
            Some((Target::All(of), Ending::Killed)) => Some((of, Event::Ends)),
            Some((Target::Side(Side::First), Ending::Turned)) => Some((timed.target?, Event::Turns)),
            Some(_) => None,
            None if effect.makes().is_empty() => None,
            None => Some((timed.target?, Event::Makes)),
        });
        event.filter(|(stype, _)| !self.is_hidden(*stype))
    }

    /// Returns the colour, as red, green and blue, that the SpriteSet sets for a type or one of its parents.
    /// Returns `None` if no colour is set.
    pub fn color(&self, stype: SpriteType) -> Option<[u8; 3]> {
        self.0.types.get(stype.index()).and_then(|info| info.traits.color)
    }

    /// Returns the types with at least one sprite, in registry order. Cost: O(types).
    pub fn present_types<'a>(&self, state: &'a State) -> impl Iterator<Item = SpriteType> + use<'a> {
        self.sprite_types().filter(|&stype| state.world.group(stype).count > 0)
    }

    /// Returns the types that sprites hold as resources. A type occurs once per holder.
    pub fn held_types<'a>(&self, state: &'a State) -> impl Iterator<Item = SpriteType> + use<'a> {
        let held = state.world.held().iter().filter(|held| held.amount != 0).map(|held| held.resource);
        held.filter(|&stype| stype != SpriteType::NONE)
    }

    /// Returns the termination that has ended an episode, as an index into
    /// [`Description::terminations`](crate::Description). Returns `None` if the episode is not over, or if no
    /// termination ended it.
    pub fn ended_by(&self, state: &State) -> Option<usize> {
        let ended = matches!(state.world.outcome(), Outcome::Won | Outcome::Lost);
        let mut terminations = self.0.terminations.iter();
        terminations.position(|termination| termination.holds(&self.0, &state.world)).filter(|_| ended)
    }

    /// Returns the drawing order of the types, as indices into the registry.
    pub fn drawing_order(&self) -> Vec<u16> {
        self.0.order.iter().map(|stype| stype.0).collect()
    }
}

impl State {
    /// Returns the rectangles of a type's sprites, in pixels, in order of creation, including disabled avatars. Cost:
    /// O(1) per sprite.
    pub fn rects(&self, stype: SpriteType) -> impl Iterator<Item = Rect> + '_ {
        self.world.sprites_of(stype).map(|sprite| sprite.rect)
    }

    /// Returns the rectangles, in pixels, and the orientations of a type's sprites, including disabled
    /// avatars.
    pub fn bodies(&self, stype: SpriteType) -> impl Iterator<Item = (Rect, Direction)> + '_ {
        self.world.sprites_of(stype).map(|sprite| (sprite.rect, self.world.overrides_of(&sprite).orientation))
    }

    /// Returns the number of sprites of a type, excluding disabled avatars. Cost: O(1).
    pub fn alive(&self, stype: SpriteType) -> usize {
        let group = self.world.group(stype);
        usize::from(group.count - group.disabled)
    }

    /// Returns the amount of a resource that the avatar holds. Cost: O(log holdings).
    pub fn amount_held(&self, resource: SpriteType) -> i32 {
        self.world.amount(self.world.avatar(), resource)
    }

    /// Returns the number of messages that the reference engine would have logged so far. More than 25
    /// messages end a game.
    pub fn messages(&self) -> u32 {
        self.world.messages()
    }

    /// Returns the top-left corners of a type's sprites, in pixels, in order of creation. Cost: O(sprites of the type).
    pub fn places(&self, stype: SpriteType) -> impl Iterator<Item = (i32, i32)> + '_ {
        self.rects(stype).map(|rect| (rect.x, rect.y))
    }

    /// Returns the top-left corner of the player's avatar in pixels, even if the avatar is disabled, or `None` once the
    /// episode is over.
    pub fn avatar_place(&self) -> Option<(i32, i32)> {
        let there = !self.is_over() && self.world.avatar_sprite().is_some();
        there.then(|| {
            let rect = self.world.present(self.world.avatar()).rect;
            (rect.x, rect.y)
        })
    }

    /// Returns the creation number of the player's avatar, even if the avatar is disabled; `None` if there is no
    /// avatar.
    pub fn avatar_id(&self) -> Option<u32> {
        self.world.avatar_id()
    }
}

/// Returns the column and the row of the cell that contains the centre of a rectangle.
fn centre(world: &World, rect: Rect) -> (i32, i32) {
    let cell = |from: i32, size: i32| from.saturating_add(size / 2).div_euclid(world.block().max(1));
    (cell(rect.x, rect.w), cell(rect.y, rect.h))
}
