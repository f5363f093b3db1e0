//! Foreign names of game classes, sections, sprite classes and terminations.

use super::meaning::{Meaning, means};

pub(super) const GAMES: &[Meaning] =
    &[means("game vgdl vgdlgame simplegame gridgame basicgrid newgame", &["BasicGame"], "")];

pub(super) const SECTIONS: &[Meaning] = &[
    means(
        "sprites spritedefinitions spritedefinition objects entities objectset entityset spritelist",
        &["SpriteSet"],
        "",
    ),
    means(
        "mapping mappings levelmap legend charmapping charactermapping leveldefinition levelmappings symbols",
        &["LevelMapping"],
        "",
    ),
    means(
        "interactions rules collisions effects collisionset ruleset interactionrules effectset events",
        &["InteractionSet"],
        "",
    ),
    means(
        "terminations termination endconditions winconditions wincondition goals objectives terminationconditions endset ending",
        &["TerminationSet"],
        "",
    ),
];

pub(super) const CLASSES: &[Meaning] = &[
    means(
        "collectible collectable collectibles pickup item items coin gem treasure loot food pellet bonus diamond reward prize",
        &[],
        "use `Resource` with the effect `collectResource`, or `Immovable` with the effect `killSprite`",
    ),
    means(
        "key keys",
        &[],
        "use `Resource` with the effect `collectResource`; `killIfOtherHasMore` opens a door to its holder",
    ),
    means(
        "movable moveable pushable box crate boulder pushed pushbox draggable pushableobject movableobject",
        &["Passive"],
        "use `Passive`, which the effect `bounceForward` pushes",
    ),
    means(
        "wall walls obstacle barrier solid block blocks solidblock rock unmovable nonmovable",
        &["Immovable"],
        "use `Immovable`, with the effect `stepBack` for the sprites that it stops",
    ),
    means(
        "static stationary floor ground tile background decoration scenery object sprite entity thing fixed structure terrain basic \
         vgdlsprite water grass",
        &["Immovable"],
        "",
    ),
    means(
        "goal exit target finish flag home destination win",
        &["Immovable"],
        "use `Immovable`, and write rules for reaching it",
    ),
    means(
        "trap hazard spike spikes lava pit hole danger",
        &["Immovable"],
        "use `Immovable`, with a rule such as `avatar trap > killSprite`",
    ),
    means(
        "switch button lever pressureplate",
        &["Immovable"],
        "use `Immovable`, and write rules for touching it, such as `transformToAll`",
    ),
    means(
        "player avatar hero character playeravatar useravatar playercharacter playable controllable controllableavatar gridavatar \
         moveavatar movableavatar moveableavatar walkingavatar walkavatar topdownavatar basicavatar simpleavatar heroavatar humanavatar \
         fourwayavatar keyboardavatar pacmanavatar movingplayer",
        &["MovingAvatar"],
        "use `MovingAvatar`, which walks in four directions",
    ),
    means(
        "marioavatar jumpavatar jumpingavatar jumperavatar platformavatar gravityavatar platformplayer platformer jumper",
        &[],
        "use `PlatformerAvatar`, which runs and jumps under gravity",
    ),
    means(
        "inertialavatar inertiaavatar physicsavatar driftingavatar",
        &[],
        "use `MovingAvatar`, or `SpaceshipAvatar` for a ship that drifts: no avatar has inertia on the grid",
    ),
    means(
        "rotatingavatar rotatingflippingavatar noisyrotatingflippingavatar turningavatar rotateavatar tankavatar",
        &[],
        "use `OrientedAvatar`, which turns first and then walks: no avatar turns relative to itself on \
         the grid",
    ),
    means(
        "aimedflakavatar",
        &[],
        "use `AimedAvatar`, which aims, or `FlakAvatar`, which moves: no avatar does both",
    ),
    means(
        "shootingavatar shooteravatar shooter gunavatar firingavatar attackavatar swordavatar shootingplayer",
        &[],
        "use `ShootAvatar`; its `stype=` names the sprite that it shoots",
    ),
    means("leftrightavatar sidewaysavatar", &["HorizontalAvatar"], ""),
    means("updownavatar", &["VerticalAvatar"], ""),
    means(
        "enemy enemies monster ghost villain foe hostile npc mob creature animal opponent alien zombie movingenemy movingnpc",
        &[],
        "use `RandomNPC`, which wanders, `Chaser`, which hunts the sprite that its `stype=` names, or `Missile`, which flies straight on",
    ),
    means(
        "astarchaser smartchaser pathfinder pathfinding",
        &[],
        "use `PathChaser` with `stype=`, and `obs=wall` on the first line",
    ),
    means(
        "follower hunter pursuer seeker chasing chase chasingnpc stalker follow",
        &[],
        "use `Chaser`; its `stype=` names the sprite that it hunts",
    ),
    means(
        "fleer fleeer flee runner prey escaper evader avoider fleeingnpc runaway",
        &[],
        "use `Fleeing`; its `stype=` names the sprite that it avoids",
    ),
    means(
        "wanderer wandering randomwalker randommover random randomsprite roamer randomly randommoving randomenemy",
        &["RandomNPC"],
        "",
    ),
    means(
        "bullet projectile arrow laser rocket shot movingsprite mover moving movingobject car vehicle bird",
        &["Missile"],
        "use `Missile`, which flies straight on",
    ),
    means(
        "patrol patroller guard patrolling patrolnpc patrolenemy",
        &[],
        "use `Missile`, with the effect `reverseDirection` for the walls that turn it back",
    ),
    means(
        "spawner generator producer factory spawn emitter spawning",
        &["SpawnPoint"],
        "use `SpawnPoint`; its `stype=` names the sprite that it makes",
    ),
    means(
        "teleporter teleport teleportal warp entrance",
        &[],
        "use `Portal`; its `stype=` names the exit, and the effect `teleportToExit` takes a sprite there",
    ),
    means(
        "explosion temporary effect flash spark",
        &["Flicker"],
        "use `Flicker`, which disappears after a few ticks",
    ),
    means(
        "fire virus spreading mold mould",
        &["Spreader"],
        "use `Spreader`, which spreads to the cells around it",
    ),
    means("gate lock", &["Door"], ""),
    means("walkjumper", &["WalkerJumper"], ""),
    means(
        "platform elevator lift movingplatform",
        &[],
        "use `Missile` if it moves, or `Immovable` if it does not; the effect `pullWithIt` takes a sprite along",
    ),
    means(
        "orientedsprite",
        &[],
        "use `Conveyor`, which stands still and has a direction, or `Missile`, which flies in it",
    ),
];

pub(super) const TERMINATIONS: &[Meaning] = &[
    means(
        "timer timelimit time countdown maxtime timeup clock turnlimit steplimit ticklimit timecounter maxsteps stepcounter timeoutcounter \
         timelapse tickcounter",
        &["Timeout"],
        "",
    ),
    means(
        "win wincondition victory goal goalreached success won collectall allcollected avatarreachesgoal reachgoal levelcomplete wingame",
        &[],
        "count sprites: `SpriteCounter stype=goal limit=0 win=True` wins when the last goal is removed",
    ),
    means(
        "lose losecondition gameover death avatardead avatarkilled defeat failure loss avatardeath playerdead playerdeath losegame die \
         avatardies avatarcounter noavatar lost",
        &[],
        "count sprites: `SpriteCounter stype=avatar limit=0 win=False` loses when the avatar is removed",
    ),
    means(
        "score scorecounter scorereached scorelimit pointscounter points scorethreshold minscore targetscore scoretermination",
        &[],
        "count sprites, as in `SpriteCounter stype=coin limit=0 win=True`: no termination waits for a score",
    ),
    means(
        "resourcecounter resourcecount resourcecollected hasresource inventorycounter resourcelimit",
        &[],
        "count the remaining sprites, as in `SpriteCounter stype=coin limit=0 win=True`: no termination \
         counts held resources",
    ),
    means(
        "spritecount countsprites counter spritescounter nosprites spritekilled allkilled killall spritesleft spriteless spritecounterless \
         allcollectedcounter count spriteexists nospritesleft spritegone",
        &["SpriteCounter"],
        "",
    ),
    means("spritecounterequal spritecountermorethan spritecountergreater", &["SpriteCounterMore"], ""),
    means(
        "multicounter multiplespritecounter multispritecount multispritescounter multiplesspritecounter",
        &["MultiSpriteCounter"],
        "",
    ),
    means("noveltytermination", &[], "remove the line: the game then ends only by its other terminations"),
];
