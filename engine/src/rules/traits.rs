//! A sprite type's traits: base fields, class defaults, parameters (`spec/02` §1, `spec/01` §3.1).

use super::class::SpriteClass;
use crate::numbers::geometry::Direction;
use crate::rules::SpriteType;
use smallvec::SmallVec;

base::with_defaults! {
    /// The values of a type's fields after class defaults and parameters are applied: a sprite's initial
    /// values and its constants. `Default` gives the values of the base sprite.
    #[derive(Clone, Debug)]
    pub(crate) struct Traits {
        pub(crate) speed: f64 = 0.0,
        pub(crate) cooldown: i32 = 0,
        pub(crate) orientation: Direction = Direction::NONE,
        pub(crate) is_oriented: bool = false,
        pub(crate) rotate_in_place: bool = false,
        pub(crate) is_static: bool = false,
        pub(crate) only_active: bool = false,
        pub(crate) stationary: bool = false,
        pub(crate) solid: bool = false,
        pub(crate) width_factor: f64 = 1.0,
        pub(crate) height_factor: f64 = 1.0,
        pub(crate) health: i32 = 0,
        pub(crate) max_health: i32 = 0,
        pub(crate) limit_health: i32 = 1000,
        pub(crate) time_to_live: i32 = -1,
        pub(crate) portal: bool = false,
        pub(crate) is_npc: bool = false,
        pub(crate) is_resource: bool = false,
        pub(crate) is_avatar: bool = false,
        pub(crate) is_from_avatar: bool = false,
        /// The initial values of a sprite: the number of ticks since its last move, whether its first passive
        /// movement is still to come, and whether it stands on something.
        pub(crate) last_move: i32 = 0,
        pub(crate) is_first_tick: bool = true,
        pub(crate) on_ground: bool = false,
        /// `true` if sprites of the type have images for exactly the four directions.
        pub(crate) oriented_image: bool = false,
        pub(crate) hidden: bool = false,
        pub(crate) invisible: bool = false,
        pub(crate) color: Option<[u8; 3]> = None,
        /// The `limit` parameter of Resource and Flicker.
        pub(crate) limit: i32 = 0,
        pub(crate) value: i32 = 1,
        /// The resource type that a sprite gains by collecting a Resource.
        pub(crate) resource: SpriteType = SpriteType::NONE,
        pub(crate) age: i32 = 0,
        pub(crate) spread_probability: f64 = 1.0,
        pub(crate) cons: i32 = 0,
        pub(crate) fleeing: bool = false,
        pub(crate) max_distance: f64 = -1.0,
        pub(crate) prob: f64 = 1.0,
        pub(crate) total: i32 = 0,
        pub(crate) spawn_orientation: Direction = Direction::NONE,
        pub(crate) min_ammo: i32 = -1,
        pub(crate) ammo_cost: i32 = 1,
        /// `true` for continuous physics, `false` for grid physics.
        pub(crate) continuous: bool = false,
        /// `true` unless the type is declared to have grid physics. An unknown kind of physics acts like grid
        /// physics, except that it gives avatars passive movement.
        pub(crate) off_grid: bool = false,
        pub(crate) mass: f64 = 1.0,
        pub(crate) gravity: f64 = 0.0,
        pub(crate) friction: f64 = 0.0,
        /// The speed limit, or −1 for no limit.
        pub(crate) max_speed: f64 = -1.0,
        pub(crate) jump_strength: f64 = 0.0,
        /// The angle by which the player can turn the avatar in a tick, in radians.
        pub(crate) angle_diff: f64 = 0.0,
        pub(crate) rotation: f64 = 0.0,
        /// The direction of a CarAvatar, 0 for forwards or 1 for backwards.
        pub(crate) facing: f64 = 0.0,
        /// The direction that a WizardAvatar faces, and the tick of its last block.
        pub(crate) facing_dir: Direction = Direction::RIGHT,
        pub(crate) last_block_time: i32 = 0,
        pub(crate) ground_speedup: f64 = 1.0,
        pub(crate) air_slowdown: f64 = 2.0,
        pub(crate) air_steering: bool = false,
        /// The probability that a WalkerJumper on the ground jumps in a tick.
        pub(crate) probability: f64 = 0.1,
        pub(crate) epsilon: f64 = 0.0,
        pub(crate) random_target: bool = false,
        pub(crate) spawn_behind: Option<SpriteType> = None,
        /// The types that sprites shoot, spawn, chase or lead to: `stype`, `stype1`, `stypes` or
        /// `stypeMissile`.
        pub(crate) stypes: SmallVec<[SpriteType; 2]> = SmallVec::new(),
        /// The resources that shots cost: `ammo`.
        pub(crate) ammo: SmallVec<[SpriteType; 2]> = SmallVec::new(),
    }
}

/// The number of ticks between two blocks created by a wizard.
pub(crate) const BLOCK_PAUSE: i32 = 5;

impl Traits {
    /// Returns `true` if gravity pulls drifting sprites of the type down.
    pub(crate) fn falls(&self) -> bool {
        self.continuous && self.gravity > 0.0 && self.mass > 0.0
    }

    /// Returns the number of columns and rows that a sprite of the type overlaps if it starts at a cell's
    /// corner. Each number is at least 1 and at most [`MAX_REACH`](crate::limits::MAX_REACH).
    pub(crate) fn span(&self) -> (usize, usize) {
        let cells = |factor: f64| (factor.ceil() as usize).max(1);
        (cells(self.width_factor), cells(self.height_factor))
    }

    /// Returns the base defaults, overridden by the defaults of the class and its ancestors, starting with
    /// the root.
    pub(crate) fn of_class(class: SpriteClass) -> Traits {
        let mut traits = Traits { is_avatar: class.is_avatar(), ..Traits::default() };
        traits.class_defaults(class);
        traits
    }

    fn class_defaults(&mut self, class: SpriteClass) {
        use SpriteClass as C;
        if class.is_avatar() {
            self.speed = 1.0;
        }
        if class.is_a(C::OrientedAvatar) {
            self.orientation = Direction::RIGHT;
            self.is_oriented = true;
            self.rotate_in_place = true;
        }
        match class {
            C::Immovable => self.is_static = true,
            C::Door | C::Portal => {
                self.is_static = true;
                self.portal = true;
            }
            C::Conveyor => {
                self.is_static = true;
                self.is_oriented = true;
                self.jump_strength = 1.0;
            }
            C::Resource | C::ResourcePack => {
                self.is_resource = true;
                self.limit = 2;
                self.is_static = class == C::ResourcePack;
            }
            C::Flicker | C::Spreader => self.limit = 1,
            C::OrientedFlicker => {
                self.limit = 1;
                self.is_oriented = true;
            }
            C::Missile | C::ErraticMissile | C::RandomMissile => {
                self.speed = 1.0;
                self.is_oriented = true;
                if class == C::RandomMissile {
                    self.orientation = Direction::NIL;
                }
            }
            C::RandomNPC
            | C::RandomInertial
            | C::Chaser
            | C::Fleeing
            | C::LOSChaser
            | C::PathChaser
            | C::AlternateChaser
            | C::RandomAltChaser
            | C::PathAltChaser
            | C::RandomPathAltChaser => {
                self.speed = 1.0;
                self.is_npc = true;
                self.fleeing = class == C::Fleeing;
                if class == C::RandomInertial {
                    (self.continuous, self.off_grid) = (true, true);
                    self.is_oriented = true;
                }
            }
            C::Walker | C::WalkerJumper => {
                self.speed = 5.0;
                self.max_speed = 5.0;
                self.is_oriented = true;
                self.jump_strength = if class == C::WalkerJumper { 1.0 } else { 0.0 };
            }
            C::SpawnPoint => {
                self.cooldown = 1;
                self.is_static = true;
            }
            C::SpawnPointMultiSprite => {
                self.cooldown = 1;
                self.is_static = true;
                self.is_oriented = true;
                self.orientation = Direction::RIGHT;
                self.is_npc = true;
            }
            C::Bomber | C::RandomBomber | C::BomberRandomMissile => {
                self.cooldown = 1;
                self.is_oriented = true;
                self.orientation = Direction::RIGHT;
                self.is_npc = true;
                self.speed = if class == C::RandomBomber { 1.0 } else { 0.0 };
            }
            C::AimedAvatar => {
                self.speed = 0.0;
                self.stationary = true;
                self.angle_diff = 0.15;
            }
            C::SpaceshipAvatar | C::LanderAvatar => {
                self.speed = 5.0;
                self.orientation = Direction::NONE;
                self.angle_diff = 0.3;
            }
            C::CarAvatar => {
                self.speed = 0.0;
                self.angle_diff = 0.15;
            }
            C::BirdAvatar => self.jump_strength = 10.0,
            C::PlatformerAvatar | C::WizardAvatar => {
                self.jump_strength = 10.0;
                self.max_speed = 30.0;
                if class == C::WizardAvatar {
                    self.speed = 0.0;
                }
            }
            C::Passive | C::SpriteProducer => {}
            C::MovingAvatar
            | C::HorizontalAvatar
            | C::VerticalAvatar
            | C::NullAvatar
            | C::FlakAvatar
            | C::OrientedAvatar
            | C::ShootAvatar
            | C::ShootOnlyAvatar
            | C::OngoingAvatar
            | C::OngoingShootAvatar
            | C::OngoingTurningAvatar
            | C::MissileAvatar => {}
        }
    }

    /// Completes the traits as the reference does after setting the parameters (`spec/01` §3.5).
    pub(crate) fn settle(&mut self) {
        self.is_oriented |= self.orientation != Direction::NONE;
        if self.max_health == 0 {
            self.max_health = self.health;
        }
        self.health = self.health.min(self.max_health);
        self.cooldown = self.cooldown.max(1);
    }
}
