//! Words that VGDL does not have, although people, language models and other dialects write them, each with the words of
//! VGDL that do what is meant. A spelling that is merely close may mean the opposite, so this table is asked first.

use crate::limits::MAX_NAME;

/// The place of an unknown word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// The first word of the file.
    Game,
    /// A parameter of the first line.
    GameParameter,
    /// The name of a section.
    Section,
    /// The class of a sprite.
    Class,
    /// A parameter of a sprite.
    SpriteParameter,
    /// The effect of an interaction.
    Effect,
    /// A parameter of an interaction.
    EffectParameter,
    /// The class of a termination.
    Termination,
    /// A parameter of a termination.
    TerminationParameter,
}

/// The intended meaning of some words.
#[derive(Debug)]
pub(crate) struct Meaning {
    /// The words, in small letters and digits only.
    words: &'static str,
    /// The words of VGDL to write instead, the first that fits; none if a line has to be written anew.
    pub(crate) write: &'static [&'static str],
    /// The advice; empty if the word to write says it all.
    pub(crate) advice: &'static str,
}

/// The meaning of a word at a place, however it is capitalised and joined.
pub(crate) fn meaning(place: Place, word: &str) -> Option<&'static Meaning> {
    let plain: String =
        word.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()).collect();
    // A name in another script has no letters left.
    if plain.is_empty() || plain.len() < word.chars().filter(|c| c.is_alphanumeric()).count() {
        return None;
    }
    let found = table(place).iter().find(|known| known.words.split(' ').any(|word| word == plain));
    found.or_else(|| AVATAR.iter().find(|_| place == Place::Class && plain.ends_with("avatar")))
}

/// The meaning of a word that one letter separates from those of the table.
pub(crate) fn near_meaning(place: Place, word: &str) -> Option<&'static Meaning> {
    let plain = word.to_lowercase();
    let near = |known: &str| known.len() > 4 && strsim::damerau_levenshtein(known, &plain) == 1;
    let fits = |known: &&Meaning| known.words.split_whitespace().any(near);
    table(place).iter().find(fits).filter(|_| plain.len() <= MAX_NAME)
}

fn table(place: Place) -> &'static [Meaning] {
    match place {
        Place::Game => GAMES,
        Place::GameParameter => GAME_PARAMETERS,
        Place::Section => SECTIONS,
        Place::Class => CLASSES,
        Place::SpriteParameter => SPRITE_PARAMETERS,
        Place::Effect => EFFECTS,
        Place::EffectParameter => EFFECT_PARAMETERS,
        Place::Termination => TERMINATIONS,
        Place::TerminationParameter => TERMINATION_PARAMETERS,
    }
}

const fn means(words: &'static str, write: &'static [&'static str], advice: &'static str) -> Meaning {
    Meaning { words, write, advice }
}

const GAMES: &[Meaning] =
    &[means("game vgdl vgdlgame simplegame gridgame basicgrid newgame", &["BasicGame"], "")];

const GAME_PARAMETERS: &[Meaning] = &[
    means("blocksize cellsize tilesize squaresize gridsize", &["square_size"], ""),
    means("players numplayers playercount nplayers", &["no_players"], ""),
    means("counters numcounters", &["no_counters"], ""),
    means("obstacles blocked", &["obs"], ""),
    means(
        "framerate fps tickrate",
        &[],
        "remove it: the rules do not depend on the pace, which `arcade play --fps` sets",
    ),
    means(
        "title name author description maxsprites seed",
        &[],
        "remove it, or write it as a comment, after `#`",
    ),
    means(
        "timelimit maxsteps timeout limit",
        &[],
        "remove it, and add a line `Timeout limit=500 win=False` to the TerminationSet",
    ),
];

const SECTIONS: &[Meaning] = &[
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

/// Any other avatar.
const AVATAR: &[Meaning] = &[means(
    "",
    &[],
    "use `MovingAvatar`, which walks in four directions; `arcade docs sprites` lists the other avatars",
)];

const CLASSES: &[Meaning] = &[
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
        "use `Immovable`, with the effect `stepBack` for those that it stops",
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
        "use `Immovable`: what reaching it does is said by rules",
    ),
    means(
        "trap hazard spike spikes lava pit hole danger",
        &["Immovable"],
        "use `Immovable`, with a rule such as `avatar trap > killSprite`",
    ),
    means(
        "switch button lever pressureplate",
        &["Immovable"],
        "use `Immovable`: what touching it does is said by rules, such as `transformToAll`",
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
        "use `OrientedAvatar`, which turns first and walks then: no avatar turns relative to itself on the grid",
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
        "use `RandomNPC`, which wanders, `Chaser`, which hunts what its `stype=` names, or `Missile`, which flies straight on",
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
        "use `Flicker`, which is gone after a few ticks",
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
        "use `Missile` for one that moves, or `Immovable`; `pullWithIt` takes a sprite along",
    ),
    means(
        "orientedsprite",
        &[],
        "use `Conveyor`, which stands still and has a direction, or `Missile`, which flies in it",
    ),
];

const EFFECTS: &[Meaning] = &[
    means(
        "kill destroy die dies death remove delete eliminate disappear vanish despawn removesprite destroysprite deletesprite killself \
         eat consume crush killfirst killit removefirst removeself destroyself killed squash killobject",
        &["killSprite"],
        "use `killSprite`, which removes the first sprite of the line",
    ),
    means(
        "killother killpartner killsecond destroyother removeother killtarget removesecond destroysecond",
        &[],
        "swap the two sprites and use `killSprite`, which removes the first sprite of the line",
    ),
    means("destroyboth removeboth killeachother bothdie", &["killBoth"], ""),
    means(
        "killavatar killplayer loselife lose losegame gameover endgame defeat lost",
        &[],
        "use `killSprite` with the avatar first; a line `SpriteCounter stype=avatar limit=0 win=False` of the TerminationSet then ends the game",
    ),
    means(
        "win wins wingame victory won reachgoal levelcomplete complete completelevel goal winlevel nextlevel finish end terminate",
        &[],
        "use `killSprite` with the goal first; a line `SpriteCounter stype=goal limit=0 win=True` of the TerminationSet then ends the game",
    ),
    means(
        "collect collects pickup pick take takes gather collectitem collectsprite collectcoin collectkey collectible grab get obtain harvest \
         pickupitem acquire",
        &[],
        "use `collectResource` if the first sprite is a `Resource`, else `killSprite`, which removes it",
    ),
    means(
        "push pushes shove move pushbox pushforward pushsprite moveforward pushblock pushobject pushaway moveable kick",
        &["bounceForward"],
        "use `bounceForward`, by which the partner pushes the first sprite",
    ),
    means(
        "block blocks blocked stop stops stopmovement blockmovement preventmovement nomove solid wall collide collision stopsprite goback \
         moveback undo undomove halt impassable obstruct stepbackward pushback blockmove stay",
        &["stepBack"],
        "use `stepBack`, which puts the first sprite back to where it was",
    ),
    means(
        "bounce bounces bounceback bounceoff ricochet rebound reflect bounceaway",
        &[],
        "use `reverseDirection`, which turns the first sprite back, or `wallBounce`, which reflects it in continuous physics",
    ),
    means(
        "reverse turnback changedirection invertdirection reversedir",
        &["reverseDirection"],
        "use `reverseDirection`, which turns the first sprite back",
    ),
    means(
        "turn rotate randomdirection changedirectionrandomly turnrandomly",
        &[],
        "use `reverseDirection`, which turns the first sprite back, or `flipDirection`, which turns it by chance",
    ),
    means(
        "teleport teleports warp teleportto teleportsprite teleportexit transport useportal enterportal",
        &["teleportToExit"],
        "use `teleportToExit`: the partner is a `Portal`, whose `stype=` names the exit",
    ),
    means(
        "addscore score scores changescore increasescore scorepoints addpoints givepoints points point reward gainscore setscore updatescore \
         scorechange scoreup gainpoints incrementscore awardpoints earnpoints",
        &[],
        "write `scoreChange=1` on another rule of these two sprites: points are a parameter of every effect",
    ),
    means(
        "decreasescore losescore subtractscore losepoints penalty deductscore reducescore losepoint",
        &[],
        "write `scoreChange=-1` on another rule of these two sprites: points are a parameter of every effect",
    ),
    means(
        "transform transforms become becomes convert turninto changetype morph replace transforminto changeto changeinto transformsprite \
         changesprite replacewith swapsprite",
        &["transformTo"],
        "use `transformTo`; its `stype=` names the new sprite",
    ),
    means(
        "open opens unlock opendoor unlockdoor usekey openwithkey openifhaskey unlockifhaskey killifhaskey",
        &[],
        "use `killIfOtherHasMore resource=key limit=1`, which removes a door that its partner holds a key to",
    ),
    means(
        "spawnsprite create generate produce spawnobject createsprite spawnat makesprite addsprite",
        &["spawn"],
        "use `spawn`; its `stype=` names the new sprite",
    ),
    means("clone duplicate copy replicate", &["cloneSprite"], ""),
    means(
        "nothing none noop null ignore donothing pass noeffect passthrough nulleffect overlap allow",
        &[],
        "remove this line: two sprites without a rule for each other do nothing",
    ),
    means(
        "heal addhealth restorehealth gainhealth increasehealth gainlife addlife",
        &["addHealthPoints"],
        "",
    ),
    means(
        "damage hurt hit takedamage losehealth subtracthealth reducehealth decreasehealth harm dealdamage injure",
        &["subtractHealthPoints"],
        "use `subtractHealthPoints`, or `killSprite`, which removes the first sprite at once",
    ),
    means("wrap loop wraparoundscreen screenwrap", &["wrapAround"], ""),
    means(
        "pull carry attach ride drag movewith stick",
        &["pullWithIt"],
        "use `pullWithIt`, by which the partner takes the first sprite along",
    ),
    means(
        "conveysprite convey",
        &[],
        "use `attractGaze`, by which a belt turns what moves on it, or `pullWithIt`, by which a moving sprite takes another along",
    ),
    means(
        "windgust slipforward slide slip",
        &[],
        "remove this line: no effect moves a sprite that does not move by itself",
    ),
    means(
        "follow follows chase chases attract",
        &[],
        "an effect is about a meeting; for a sprite that hunts another one use the class `Chaser`",
    ),
    means(
        "flee escape avoid",
        &[],
        "an effect is about a meeting; for a sprite that avoids another one use the class `Fleeing`",
    ),
    means(
        "shoot fire attack",
        &[],
        "an effect is about a meeting; for an avatar that shoots use the class `ShootAvatar`",
    ),
    means(
        "killifotherhasless",
        &[],
        "use `killIfOtherHasMore` for the amounts that kill, or `killIfHasLess`, which looks at the first sprite: no effect asks whether the partner has less",
    ),
    means(
        "killifhasnot killifnothas killifdoesnothave killifhasno killifno killifnokey killunlesshas",
        &[],
        "use `killIfHasLess resource=key limit=0`, which removes the first sprite if it holds none",
    ),
    means(
        "killifhas killifhaskeys killifhasresource killifhasitem",
        &[],
        "use `killIfHasMore resource=key limit=1`, which removes the first sprite if it holds one",
    ),
    means("killifotherhas", &["killIfOtherHasMore"], ""),
    means(
        "addresource increaseresource giveresource gainresource addtoresource",
        &[],
        "use `changeResource resource=… value=1`",
    ),
    means(
        "loseresource removeresource useresource spendresource decreaseresource consumeresource subtractresource",
        &[],
        "use `changeResource resource=… value=-1`",
    ),
    means("slow slowdown slowed", &["halfSpeed"], ""),
    means(
        "speedup accelerate boost",
        &["increaseSpeedToAll"],
        "use `increaseSpeedToAll`; its `stype=` names the sprites that get faster",
    ),
];

const TERMINATIONS: &[Meaning] = &[
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
        "count what is left, as in `SpriteCounter stype=coin limit=0 win=True`: no termination counts what a sprite holds",
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
    means("noveltytermination", &[], "remove it: the game then ends by its other terminations only"),
];

const SPRITE_PARAMETERS: &[Meaning] = &[
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
        "remove it, or write `invisible=True` to hide the sprite from the player's eyes",
    ),
    means(
        "points point score scorechange reward worth",
        &[],
        "remove it: points are given by rules, such as `coin avatar > killSprite scoreChange=1`",
    ),
    means(
        "collectible collectable pickup",
        &[],
        "remove it: picking up is a rule, such as `coin avatar > killSprite`",
    ),
    means(
        "pushable movable moveable",
        &[],
        "remove it: pushing is a rule, such as `crate avatar > bounceForward`",
    ),
    means(
        "blocking blocksmovement walkable passable obstacle issolid collidable",
        &[],
        "remove it: stopping is a rule, such as `avatar wall > stepBack`",
    ),
    means(
        "deadly harmful damage lethal dangerous kills",
        &[],
        "remove it: harm is a rule, such as `avatar trap > killSprite`",
    ),
    means(
        "static immovable fixed",
        &[],
        "remove it: the class says whether a sprite moves, and `Immovable` does not",
    ),
    means("alternatekeys keys controls", &[], "remove it: the player chooses among the actions of the class"),
];

const EFFECT_PARAMETERS: &[Meaning] = &[
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
    means("friction", &[], "remove it: friction is a parameter of sprites with `physicstype=CONT`"),
    means(
        "win lose",
        &[],
        "remove it: only terminations end the game, such as `SpriteCounter stype=goal limit=0 win=True`",
    ),
];

const TERMINATION_PARAMETERS: &[Meaning] = &[
    means(
        "time ticks steps duration max value turns timeout count limt maximum threshold number amount maxtime timelimit seconds min",
        &["limit"],
        "",
    ),
    means("sprite type target object stype1 sprites spritetype name", &["stype", "stype1"], ""),
    means("stype", &["stype1"], ""),
    means("victory wins success outcome won winner iswin", &["win"], ""),
    means("lose loss lost gameover loses", &[], "remove it, and write `win=False`"),
    means(
        "bonus score scorechange points reward",
        &[],
        "remove it: terminations give no points; write `scoreChange=` on the rule that decides the game",
    ),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keywords;
    use std::collections::BTreeSet;

    const PLACES: [Place; 9] = [
        Place::Game,
        Place::GameParameter,
        Place::Section,
        Place::Class,
        Place::SpriteParameter,
        Place::Effect,
        Place::EffectParameter,
        Place::Termination,
        Place::TerminationParameter,
    ];

    #[test]
    fn a_word_has_one_meaning_at_a_place() {
        for place in PLACES {
            let mut seen = BTreeSet::new();
            for word in table(place).iter().flat_map(|known| known.words.split(' ')) {
                assert!(
                    !word.is_empty() && word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit()),
                    "{word}"
                );
                assert!(seen.insert(word), "{word} has two meanings as {place:?}");
            }
        }
    }

    #[test]
    fn words_of_vgdl_are_not_foreign_and_words_to_write_are_of_vgdl() {
        for (place, known) in [
            (Place::Class, keywords::CLASSES),
            (Place::Effect, keywords::EFFECTS),
            (Place::Termination, keywords::TERMINATIONS),
        ] {
            for meaning in table(place) {
                assert!(meaning.write.iter().all(|word| known.contains(word)), "{meaning:?}");
                assert!(!meaning.write.is_empty() || !meaning.advice.is_empty(), "{meaning:?}");
            }
            let exact = |word: &&&str| {
                table(place).iter().any(|known| known.words.split(' ').any(|own| own == word.to_lowercase()))
            };
            assert_eq!(known.iter().find(exact), None);
        }
    }

    #[test]
    fn spelling_does_not_matter_and_avatars_are_avatars() {
        let writes = |place, word| meaning(place, word).map(|found| found.write);
        assert_eq!(writes(Place::Class, "Movable"), Some(&["Passive"][..]));
        assert_eq!(writes(Place::Effect, "remove_sprite"), Some(&["killSprite"][..]));
        assert_eq!(writes(Place::Class, "PlayerAvatar"), Some(&["MovingAvatar"][..]));
        assert!(
            meaning(Place::Class, "SwimmingAvatar")
                .is_some_and(|found| found.advice.contains("MovingAvatar"))
        );
        assert!(meaning(Place::Effect, "SwimmingAvatar").is_none());
        assert!(meaning(Place::Class, "Qüz").is_none() && meaning(Place::Class, "").is_none());
    }
}
