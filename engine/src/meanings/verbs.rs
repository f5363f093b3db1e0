//! Foreign names of effects.

use super::meaning::{Meaning, means};

pub(super) const EFFECTS: &[Meaning] = &[
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
        "use `bounceForward`, with which the partner pushes the first sprite",
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
        "use `reverseDirection`, which turns the first sprite back, or `flipDirection`, which turns it in \
         a random direction",
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
        "use `killIfOtherHasMore resource=key limit=1`, which removes a door if its partner holds the key",
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
        "use `pullWithIt`, with which the partner takes the first sprite along",
    ),
    means(
        "conveysprite convey",
        &[],
        "use `attractGaze`, with which a belt turns the sprites that move on it, or `pullWithIt`, with which a moving sprite takes another along",
    ),
    means(
        "windgust slipforward slide slip",
        &[],
        "remove this line: no effect moves a sprite that does not move by itself",
    ),
    means(
        "follow follows chase chases attract",
        &[],
        "effects apply when sprites meet; for a sprite that hunts another sprite, use the class `Chaser`",
    ),
    means(
        "flee escape avoid",
        &[],
        "effects apply when sprites meet; for a sprite that avoids another sprite, use the class `Fleeing`",
    ),
    means(
        "shoot fire attack",
        &[],
        "effects apply when sprites meet; for an avatar that shoots, use the class `ShootAvatar`",
    ),
    means(
        "killifotherhasless",
        &[],
        "use `killIfOtherHasMore` for the amounts that kill, or `killIfHasLess`, which checks the first \
         sprite: no effect checks whether the partner has less",
    ),
    means(
        "killifhasnot killifnothas killifdoesnothave killifhasno killifno killifnokey killunlesshas",
        &[],
        "use `killIfHasLess resource=key limit=0`, which removes the first sprite if it holds no such resource",
    ),
    means(
        "killifhas killifhaskeys killifhasresource killifhasitem",
        &[],
        "use `killIfHasMore resource=key limit=1`, which removes the first sprite if it holds such a resource",
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
