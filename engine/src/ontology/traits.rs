//! The traits of a sprite type: base fields, class defaults, parameters (`spec/02` §1, `spec/01` §3.1).

use super::class::SpriteClass;
use crate::game::SpriteType;
use crate::geometry::Direction;
use smallvec::SmallVec;

/// The values of a type's fields after class defaults and parameters: the initial values of a sprite and its constants.
#[derive(Clone, Debug)]
pub(crate) struct Traits {
    pub(crate) speed: f64,
    pub(crate) cooldown: i32,
    pub(crate) orientation: Direction,
    pub(crate) is_oriented: bool,
    pub(crate) rotate_in_place: bool,
    pub(crate) is_static: bool,
    pub(crate) only_active: bool,
    pub(crate) stationary: bool,
    pub(crate) solid: bool,
    pub(crate) width_factor: f64,
    pub(crate) height_factor: f64,
    pub(crate) health: i32,
    pub(crate) max_health: i32,
    pub(crate) limit_health: i32,
    pub(crate) time_to_live: i32,
    pub(crate) portal: bool,
    pub(crate) is_npc: bool,
    pub(crate) is_resource: bool,
    pub(crate) is_avatar: bool,
    pub(crate) is_from_avatar: bool,
    /// The initial values of a sprite: ticks since the last move, first passive movement still to come, standing on
    /// something.
    pub(crate) last_move: i32,
    pub(crate) is_first_tick: bool,
    pub(crate) on_ground: bool,
    /// `true` if it has pictures for the four directions and for no others.
    pub(crate) oriented_image: bool,
    pub(crate) hidden: bool,
    pub(crate) invisible: bool,
    pub(crate) color: Option<[u8; 3]>,
    /// `limit` of Resource and Flicker.
    pub(crate) limit: i32,
    pub(crate) value: i32,
    /// The type that a Resource is collected as.
    pub(crate) resource: SpriteType,
    pub(crate) age: i32,
    pub(crate) spread_probability: f64,
    pub(crate) cons: i32,
    pub(crate) fleeing: bool,
    pub(crate) max_distance: f64,
    pub(crate) prob: f64,
    pub(crate) total: i32,
    pub(crate) spawn_orientation: Direction,
    pub(crate) min_ammo: i32,
    pub(crate) ammo_cost: i32,
    /// `true` for continuous physics, `false` for grid physics.
    pub(crate) continuous: bool,
    /// `true` unless declared to have grid physics. An unknown physics acts as the grid's, but avatars have passive
    /// movement.
    pub(crate) off_grid: bool,
    pub(crate) mass: f64,
    pub(crate) gravity: f64,
    pub(crate) friction: f64,
    /// The speed limit; −1 for none.
    pub(crate) max_speed: f64,
    pub(crate) jump_strength: f64,
    /// Radians a tick.
    pub(crate) angle_diff: f64,
    pub(crate) rotation: f64,
    /// CarAvatar: 0 forwards, 1 backwards.
    pub(crate) facing: f64,
    /// WizardAvatar: the direction that it faces, and the tick of its last block.
    pub(crate) facing_dir: Direction,
    pub(crate) last_block_time: i32,
    pub(crate) ground_speedup: f64,
    pub(crate) air_slowdown: f64,
    pub(crate) air_steering: bool,
    /// WalkerJumper: the probability of a jump in each tick on the ground.
    pub(crate) probability: f64,
    pub(crate) epsilon: f64,
    pub(crate) random_target: bool,
    pub(crate) spawn_behind: Option<SpriteType>,
    /// `stype`, `stype1`, `stypes` or `stypeMissile`: the types that it shoots, spawns, chases or leads to.
    pub(crate) stypes: SmallVec<[SpriteType; 2]>,
    /// `ammo`: the resources that shots cost.
    pub(crate) ammo: SmallVec<[SpriteType; 2]>,
}

impl Traits {
    /// The columns and rows of the cells that such a sprite overlaps if it starts at the corner of one: at least one
    /// each, at most [`MAX_REACH`](crate::limits::MAX_REACH).
    pub(crate) fn span(&self) -> (usize, usize) {
        let cells = |factor: f64| (factor.ceil() as usize).max(1);
        (cells(self.width_factor), cells(self.height_factor))
    }

    /// The base defaults, overridden by those of the class, from its root down.
    pub(crate) fn of_class(class: SpriteClass) -> Traits {
        let mut traits = Traits {
            speed: 0.0,
            cooldown: 0,
            orientation: Direction::NONE,
            is_oriented: false,
            rotate_in_place: false,
            is_static: false,
            only_active: false,
            stationary: false,
            solid: false,
            width_factor: 1.0,
            height_factor: 1.0,
            health: 0,
            max_health: 0,
            limit_health: 1000,
            time_to_live: -1,
            portal: false,
            is_npc: false,
            is_resource: false,
            is_avatar: class.is_avatar(),
            is_from_avatar: false,
            last_move: 0,
            is_first_tick: true,
            on_ground: false,
            oriented_image: false,
            hidden: false,
            invisible: false,
            color: None,
            limit: 0,
            value: 1,
            resource: SpriteType::NONE,
            age: 0,
            spread_probability: 1.0,
            cons: 0,
            fleeing: false,
            max_distance: -1.0,
            prob: 1.0,
            total: 0,
            spawn_orientation: Direction::NONE,
            min_ammo: -1,
            ammo_cost: 1,
            continuous: false,
            off_grid: false,
            mass: 1.0,
            gravity: 0.0,
            friction: 0.0,
            max_speed: -1.0,
            jump_strength: 0.0,
            angle_diff: 0.0,
            rotation: 0.0,
            facing: 0.0,
            facing_dir: Direction::RIGHT,
            last_block_time: 0,
            ground_speedup: 1.0,
            air_slowdown: 2.0,
            air_steering: false,
            probability: 0.1,
            epsilon: 0.0,
            random_target: false,
            spawn_behind: None,
            stypes: SmallVec::new(),
            ammo: SmallVec::new(),
        };
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
            C::Door => {
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
            class if class.is_a(C::RandomNPC) => {
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
            C::Portal => {
                self.is_static = true;
                self.portal = true;
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
            _ => {}
        }
    }

    /// Completes the traits as the reference does after the parameters are set (`spec/01` §3.5).
    pub(crate) fn settle(&mut self) {
        self.is_oriented |= self.orientation != Direction::NONE;
        if self.max_health == 0 {
            self.max_health = self.health;
        }
        self.health = self.health.min(self.max_health);
        self.cooldown = self.cooldown.max(1);
    }
}
