//! Foreign names of parameters.

use super::meaning::{Meaning, means};

pub(super) const GAME_PARAMETERS: &[Meaning] = &[
    means("blocksize cellsize tilesize squaresize gridsize", &["square_size"], ""),
    means("players numplayers playercount nplayers", &["no_players"], ""),
    means("counters numcounters", &["no_counters"], ""),
    means("obstacles blocked", &["obs"], ""),
    means(
        "framerate fps tickrate",
        &[],
        "remove the parameter: the rules do not depend on the pace, which `arcade play --fps` sets",
    ),
    means(
        "title name author description maxsprites seed",
        &[],
        "remove the parameter, or write it as a comment, after `#`",
    ),
    means(
        "timelimit maxsteps timeout limit",
        &[],
        "remove the parameter, and add a line `Timeout limit=500 win=False` to the TerminationSet",
    ),
];

pub(super) const SPRITE_PARAMETERS: &[Meaning] = &[
    means("colour colors colours", &["color"], ""),
    means("velocity movespeed movementspeed", &["speed"], ""),
    means("direction dir facing heading initialdirection orient", &["orientation"], ""),
    means(
        "delay interval firerate spawnrate rate frequency period spawndelay spawninterval reload movedelay",
        &["cooldown"],
        "",
    ),
    means(
        "probability chance spawnprob spawnprobability spawnchance likelihood p",
        &["prob", "spreadprob"],
        "",
    ),
    means(
        "target targets follow follows chase chases enemy prey exit destination projectile bullet missile shoot shoots weapon spawn spawns \
         spawntype spawnsprite produces makes type sprite shot projectiletype stypes subtype creates",
        &["stype", "stypes"],
        "",
    ),
    means("image icon texture picture graphic graphics symbol appearance", &["img"], ""),
    means("health hp lives life hitpoints", &["healthPoints"], ""),
    means("maxhealth maxhp", &["maxHealthPoints"], ""),
    means("lifetime ttl duration lifespan timer", &["timeToLive"], ""),
    means("max maximum capacity maxamount", &["limit", "total"], ""),
    means("count amount number maxspawn maxspawns spawncount totalspawns", &["total", "limit"], ""),
    means("size scale shrink shrinkfactors", &["shrinkfactor"], ""),
    means("width", &["wMult"], ""),
    means("height", &["hMult"], ""),
    means("physics physictype physicsmode", &["physicstype"], ""),
    means("jump jumpforce jumpheight jumppower", &["jump_strength"], ""),
    means("ammunition ammotype", &["ammo"], ""),
    means(
        "visible show shown",
        &[],
        "remove the parameter, or write `invisible=True` to hide the sprite from the player",
    ),
    means(
        "points point score scorechange reward worth",
        &[],
        "remove the parameter: points are given by rules, such as `coin avatar > killSprite scoreChange=1`",
    ),
    means(
        "collectible collectable pickup",
        &[],
        "remove the parameter: picking up is a rule, such as `coin avatar > killSprite`",
    ),
    means(
        "pushable movable moveable",
        &[],
        "remove the parameter: pushing is a rule, such as `crate avatar > bounceForward`",
    ),
    means(
        "blocking blocksmovement walkable passable obstacle issolid collidable",
        &[],
        "remove the parameter: stopping is a rule, such as `avatar wall > stepBack`",
    ),
    means(
        "deadly harmful damage lethal dangerous kills",
        &[],
        "remove the parameter: harm is a rule, such as `avatar trap > killSprite`",
    ),
    means(
        "static immovable fixed",
        &[],
        "remove the parameter: the class says whether a sprite moves, and `Immovable` does not",
    ),
    means(
        "alternatekeys keys controls",
        &[],
        "remove the parameter: the player chooses among the actions of the class",
    ),
];

pub(super) const EFFECT_PARAMETERS: &[Meaning] = &[
    means(
        "points point score scores changescore addscore reward scorechanges scoredelta scoreincrease scoremodifier scorevalue bonus",
        &["scoreChange"],
        "",
    ),
    means(
        "target to type into newtype newsprite sprite spawn becomes transformto spawns result stypeto object",
        &["stype", "stypeTo"],
        "",
    ),
    means("from affected all", &["stype"], ""),
    means("amount change delta quantity increment number", &["value"], ""),
    means(
        "item res key required requires resourcetype resourcename collectible",
        &["resource", "heldResource"],
        "",
    ),
    means("max min threshold minimum maximum atleast atmost count needed", &["limit", "geq"], ""),
    means("probability chance p", &["prob"], ""),
    means("limitspeed speedlimit speed", &["limspeed"], ""),
    means("damage hp health healthpoints", &["value"], ""),
    means("killother removeother", &["killSecond"], ""),
    means(
        "friction",
        &[],
        "remove the parameter: friction is a parameter of sprites with `physicstype=CONT`",
    ),
    means(
        "win lose",
        &[],
        "remove the parameter: only terminations end the game, such as `SpriteCounter stype=goal limit=0 win=True`",
    ),
];

pub(super) const TERMINATION_PARAMETERS: &[Meaning] = &[
    means(
        "time ticks steps duration max value turns timeout count limt maximum threshold number amount maxtime timelimit seconds min",
        &["limit"],
        "",
    ),
    means("sprite type target object stype1 sprites spritetype name", &["stype", "stype1"], ""),
    means("stype", &["stype1"], ""),
    means("victory wins success outcome won winner iswin", &["win"], ""),
    means("lose loss lost gameover loses", &[], "remove the parameter, and write `win=False`"),
    means(
        "bonus score scorechange points reward",
        &[],
        "remove the parameter, because terminations give no points; write `scoreChange=` on the rule that decides the game",
    ),
];
