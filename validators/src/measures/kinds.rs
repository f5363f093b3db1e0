//! The kind of a game, derived from its rules alone: the avatar, the goal, and the sources of randomness and movement.

use super::families::{ClassFamily, EffectFamily};
use super::guards::Guards;
use engine::analysis::{
    Attainable, Condition, EffectSummary, Genre, Key, Motion, Role, Side, Steering, WinMethod,
};
use engine::{Analysis, SpriteClass, SpriteType, Term};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

base::named_enum! {
    /// The initial avatar's abilities: its way of moving, and whether the use key creates a sprite.
    pub enum AvatarKind {
        /// The avatar moves up, left, down and right.
        Walks = "walks",
        /// The avatar moves in four directions, but turns before moving.
        Turns = "turns",
        /// The avatar moves in four directions, and shoots, hits or places a sprite ahead.
        WalksAndShoots = "walks-and-shoots",
        /// The avatar moves along a line.
        Slides = "slides",
        /// The avatar moves along a line, and shoots.
        SlidesAndShoots = "slides-and-shoots",
        /// The avatar always moves ahead, whether or not the player can turn it.
        Runs = "runs",
        /// The avatar always moves ahead, and shoots or leaves a sprite behind.
        RunsAndShoots = "runs-and-shoots",
        /// The avatar stays in place, aims and shoots.
        Aims = "aims",
        /// The avatar has thrust and momentum, whether or not it is armed.
        Flies = "flies",
        /// The avatar falls and jumps.
        Jumps = "jumps",
        /// The avatar does nothing, or does not exist at the start.
        Watches = "watches",
    }
}

impl AvatarKind {
    /// Classifies a game. Cost: O(1).
    pub fn of(analysis: &Analysis) -> AvatarKind {
        let Some(avatar) = analysis.start_avatar() else { return AvatarKind::Watches };
        let class = analysis.game().class(avatar.stype);
        let turns = class.is_some_and(|class| class.is_a(SpriteClass::OrientedAvatar));
        match (avatar.steering, !avatar.shots.is_empty()) {
            (Steering::FourWay, true) => AvatarKind::WalksAndShoots,
            (Steering::FourWay, false) if turns => AvatarKind::Turns,
            (Steering::FourWay, false) => AvatarKind::Walks,
            (Steering::Horizontal | Steering::Vertical, true) => AvatarKind::SlidesAndShoots,
            (Steering::Horizontal | Steering::Vertical, false) => AvatarKind::Slides,
            (Steering::Ongoing | Steering::Unsteered, true) => AvatarKind::RunsAndShoots,
            (Steering::Ongoing | Steering::Unsteered, false) => AvatarKind::Runs,
            (Steering::Fixed, true) => AvatarKind::Aims,
            (Steering::Fixed, false) => AvatarKind::Watches,
            (Steering::Thrust, _) => AvatarKind::Flies,
            (Steering::Jumping, _) => AvatarKind::Jumps,
        }
    }
}

base::named_enum! {
    /// The task required to win, according to the analysed goals. If several tasks fit, the first one in
    /// declaration order counts.
    pub enum GoalKind {
        /// Other sprites head for the same goal, and the first to arrive wins.
        Race = "race",
        /// Pushed sprites must reach their targets.
        Deliver = "deliver",
        /// Many copies of a created type must exist.
        Grow = "grow",
        /// Sprites must be removed by shots or by obstacles that the avatar places.
        Eliminate = "eliminate",
        /// Moving sprites must be caught.
        Hunt = "hunt",
        /// Items on the board must be taken: either all items of a type, or many units of a resource that an exit
        /// requires.
        Collect = "collect",
        /// A sprite must be reached or taken, but is inaccessible until the avatar has the key or the right
        /// form.
        Unlock = "unlock",
        /// A location must be reached.
        Reach = "reach",
        /// Self-moving sprites must be brought together with each other or to a location.
        Herd = "herd",
        /// Stationary objects must be switched, lit or used up.
        Switch = "switch",
        /// A sprite other than the avatar must be protected for a while.
        Guard = "guard",
        /// The avatar must stay alive until a certain tick.
        Survive = "survive",
        /// The only goal is the score. Play cannot cause a win, or the game is won when the time is up in any case.
        Score = "score",
    }
}

/// The minimum count for a goal to be classified as a quantity goal.
const MANY: i32 = 3;

impl GoalKind {
    /// Classifies a game. Cost: O(types × avatars + interactions × relatives).
    pub fn of(analysis: &Analysis) -> GoalKind {
        let means = analysis.win_methods();
        let has = |wanted: WinMethod| means.contains(&wanted);
        let in_play = |win: bool| {
            let goals = analysis.goals().iter();
            goals.filter(move |goal| goal.win == win && goal.attainable == Attainable::InPlay)
        };
        let is_avatar = |stype: &SpriteType| analysis.avatars().iter().any(|avatar| avatar.stype == *stype);
        let grows = in_play(true).any(|goal| match &goal.condition {
            Condition::AtLeast(types, limit) | Condition::Exactly(types, limit) => {
                *limit >= MANY && !types.iter().any(is_avatar)
            }
            Condition::AtMost(..) | Condition::Tick(_) => false,
        });
        let many = analysis
            .locks()
            .iter()
            .any(|lock| matches!(lock.key, Key::Resource { amount, .. } if amount >= MANY));
        let guards = analysis.of_role(Role::Ward).any(|ward| analysis.aims().protect.contains(&ward));
        let can_lose = in_play(false).any(|goal| !matches!(goal.condition, Condition::Tick(_)));
        let waits = has(WinMethod::Wait);
        let fits = [
            (GoalKind::Race, analysis.taxonomy().genres.contains(&Genre::Race)),
            (GoalKind::Deliver, has(WinMethod::Push)),
            (GoalKind::Grow, grows),
            (GoalKind::Eliminate, has(WinMethod::Shoot) || has(WinMethod::Tool)),
            (GoalKind::Hunt, has(WinMethod::Catch)),
            (GoalKind::Collect, has(WinMethod::Take) || (has(WinMethod::Exit) && many)),
            (GoalKind::Unlock, has(WinMethod::Exit) && !analysis.locks().is_empty()),
            (GoalKind::Reach, has(WinMethod::Exit)),
            (GoalKind::Herd, has(WinMethod::Others) && moves_to_a_goal(analysis)),
            (GoalKind::Switch, has(WinMethod::Others)),
            (GoalKind::Guard, waits && guards),
            (GoalKind::Survive, waits && can_lose),
        ];
        fits.into_iter().find(|(_, fits)| *fits).map_or(GoalKind::Score, |(kind, _)| kind)
    }
}

/// Returns `true` if two types meet, one of which moves by itself, and their meeting serves a goal. It must remove a
/// type that a win requires to be removed, or create one that a win requires to exist.
fn moves_to_a_goal(analysis: &Analysis) -> bool {
    let moves = |written: SpriteType| {
        let types = analysis.game().sprite_types().filter(|&stype| analysis.applies(written, stype));
        types.into_iter().any(|stype| analysis.facts(stype).motion != Motion::Still)
    };
    let is_goal = |written: SpriteType| {
        let mut wanted = analysis.aims().remove.iter();
        wanted.any(|&stype| analysis.applies(written, stype))
    };
    let won_by_number = analysis.goals().iter().filter_map(|goal| match &goal.condition {
        Condition::AtLeast(types, _) if goal.win => Some(types),
        _ => None,
    });
    let made: BTreeSet<SpriteType> = won_by_number.flatten().copied().collect();
    analysis.encounters().iter().any(|encounter| {
        let Some(second) = encounter.second else { return false };
        let ends = |side: Side, written: SpriteType| encounter.ends(side) && is_goal(written);
        let brings_goal = encounter.does(|effect| match effect {
            EffectSummary::Become(to) | EffectSummary::Make(to) => made.contains(to),
            _ => false,
        });
        (ends(Side::First, encounter.first) || ends(Side::Second, second) || brings_goal)
            && (moves(encounter.first) || moves(second))
    })
}

base::named_enum! {
    /// The source of randomness that affects a game.
    pub enum ChanceKind {
        /// No randomness affects the game.
        None = "none",
        /// The movement of sprites other than the avatar is random.
        Movers = "movers",
        /// The times at which sprites appear are random.
        Makers = "makers",
        /// The results of interactions are random.
        Rules = "rules",
        /// Several of the above sources are random.
        Several = "several",
    }
}

impl ChanceKind {
    /// Classifies a game. Cost: O(types + interactions).
    pub fn of(analysis: &Analysis) -> ChanceKind {
        if !analysis.is_stochastic() {
            return ChanceKind::None;
        }
        let game = analysis.game();
        let clauses = game.clauses();
        let possible = || clauses.types.iter().filter(|clause| analysis.facts(clause.stype).possible);
        let unsure = |terms: &engine::Terms, keys: &[&str]| {
            let below = |term: &Term| matches!(term, Term::Number(share) if *share > 0.0 && *share < 1.0);
            terms.iter().any(|(key, term)| keys.contains(key) && below(term))
        };
        let makes = possible().any(|clause| unsure(&clause.terms, &["prob", "spread_probability"]));
        let moves = possible().any(|clause| {
            let class = clause.class;
            let random = class.is_some_and(|class| {
                use SpriteClass as C;
                matches!(class, C::ErraticMissile | C::RandomMissile | C::RandomBomber | C::WalkerJumper)
            });
            let motion = analysis.facts(clause.stype).motion;
            random || matches!(motion, Motion::Wandering | Motion::Chasing(_) | Motion::Fleeing(_))
        });
        let rolls = clauses.interactions.iter().any(|clause| {
            let rolls = ["flipDirection", "attractGaze", "teleportToExit", "transformToRandomChild"];
            rolls.contains(&clause.effect) || unsure(&clause.terms, &["prob"])
        });
        match [(moves, ChanceKind::Movers), (makes, ChanceKind::Makers), (rolls, ChanceKind::Rules)]
            .into_iter()
            .filter_map(|(is, kind)| is.then_some(kind))
            .collect::<Vec<ChanceKind>>()[..]
        {
            [one] => one,
            // Randomness has an effect in some other way, such as through bouncing missiles.
            [] => ChanceKind::Movers,
            _ => ChanceKind::Several,
        }
    }
}

/// A game's kind, derived from its rules alone. Cost: at most a few milliseconds, and no forward-model calls.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GameKind {
    /// The avatar's kind.
    pub avatar: AvatarKind,
    /// The kind of goal.
    pub goal: GoalKind,
    /// The source of randomness.
    pub chance: ChanceKind,
    /// The families of the interactions' effects, including guards (rules that only keep sprites on the board), in
    /// [`EffectFamily`] order.
    pub effects: Vec<EffectFamily>,
    /// The self-moving classes that can be present, in alphabetical order.
    pub npcs: Vec<String>,
    /// The classes that can be present and whose sprites create others by themselves, in alphabetical order.
    pub producers: Vec<String>,
    /// The number of lines in the InteractionSet, not counting guards (rules that only keep sprites on the board and
    /// out of walls).
    pub interactions: usize,
    /// The number of lines that only keep sprites from leaving the board or going through walls; see [`Guards`].
    pub guards: usize,
}

impl GameKind {
    /// Classifies a game by its rules.
    pub fn of(analysis: &Analysis) -> GameKind {
        let game = analysis.game();
        let lines = &game.description().interactions;
        let families = lines.iter().filter_map(|line| EffectFamily::of(&line.effect.text));
        let classes = |family: &[ClassFamily]| {
            let types = game.sprite_types().filter(|&stype| analysis.facts(stype).possible);
            let classes = types.filter_map(|stype| game.class(stype));
            let of_family = classes.filter(|class| family.contains(&class.family()));
            let names: BTreeSet<&str> = of_family.map(SpriteClass::name).collect();
            names.into_iter().map(str::to_owned).collect::<Vec<String>>()
        };
        let guards = Guards::of(analysis).lines().count();
        GameKind {
            avatar: AvatarKind::of(analysis),
            goal: GoalKind::of(analysis),
            chance: ChanceKind::of(analysis),
            effects: families.collect::<BTreeSet<_>>().into_iter().collect(),
            npcs: classes(&[ClassFamily::Npc, ClassFamily::Missile, ClassFamily::Walker]),
            producers: classes(&[ClassFamily::Producer]),
            interactions: lines.len() - guards,
            guards,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::Game;

    fn kind(sprites: &str, interactions: &str, terminations: &str) -> GameKind {
        let indent = |text: &str| text.split("; ").map(|line| format!("    {line}\n")).collect::<String>();
        let source = format!(
            "BasicGame\n  SpriteSet\n{}  LevelMapping\n    p > prop\n    o > other\n  InteractionSet\n{}  TerminationSet\n{}",
            indent(sprites),
            indent(interactions),
            indent(terminations)
        );
        let game = Game::from_source(&source).unwrap_or_else(|problems| panic!("{problems}\n{source}"));
        GameKind::of(&Analysis::of(&game))
    }

    #[track_caller]
    fn goal(sprites: &str, interactions: &str, terminations: &str, expect: GoalKind) {
        assert_eq!(kind(sprites, interactions, terminations).goal, expect);
    }

    const WALKER: &str = "prop > Passive; other > Immovable; avatar > MovingAvatar";
    const ROAMER: &str = "prop > RandomNPC; other > Immovable; avatar > MovingAvatar";

    #[test]
    fn goal_kinds_follow_from_the_winning_condition() {
        let none_left = "SpriteCounter stype=prop win=True; SpriteCounter stype=avatar";
        let push = "prop avatar > bounceForward; prop other > killSprite";
        goal(WALKER, push, none_left, GoalKind::Deliver);
        goal(WALKER, "prop avatar > killSprite", none_left, GoalKind::Collect);
        goal(ROAMER, "prop avatar > killSprite", none_left, GoalKind::Hunt);
        let door = "prop > Door; other > Immovable; avatar > MovingAvatar";
        goal(door, "prop avatar > killSprite", none_left, GoalKind::Reach);
        let key = "prop > Door; other > Immovable; avatar > MovingAvatar; bearer > MovingAvatar";
        let opens =
            "avatar other > transformTo stype=bearer; avatar prop > stepBack; prop bearer > killSprite";
        goal(key, opens, none_left, GoalKind::Unlock);
        let gun = "prop > RandomNPC; other > Missile; avatar > ShootAvatar stype=other";
        goal(gun, "prop other > killBoth", none_left, GoalKind::Eliminate);
        goal(ROAMER, "prop other > killSprite", none_left, GoalKind::Herd);
        let safe = "prop > RandomNPC; other > Immovable; safe > Immovable; avatar > MovingAvatar";
        let two_safe = "SpriteCounterMore stype=safe limit=2 win=True; SpriteCounter stype=avatar";
        goal(safe, "prop other > transformTo stype=safe", two_safe, GoalKind::Herd);
        let lamp = "prop > Immovable; other > Immovable; avatar > MovingAvatar";
        let lit = "avatar prop > spawn stype=other; prop other > killSprite";
        goal(lamp, lit, none_left, GoalKind::Switch);
        let time = "Timeout limit=90 win=True; SpriteCounter stype=avatar";
        goal(ROAMER, "avatar prop > killSprite", time, GoalKind::Survive);
        let ward = "Timeout limit=90 win=True; SpriteCounter stype=other";
        goal(ROAMER, "other prop > killSprite", ward, GoalKind::Guard);
        goal(ROAMER, "prop avatar > killSprite scoreChange=1", "Timeout limit=90 win=True", GoalKind::Score);
        let many = "SpriteCounterMore stype=other limit=9 win=True";
        goal(WALKER, "prop avatar > transformTo stype=other", many, GoalKind::Grow);
    }

    #[test]
    fn avatar_kinds_follow_from_abilities() {
        let check = |class: &str, expect: AvatarKind| {
            let sprites = format!("prop > Passive; other > Missile; avatar > {class}");
            let found = kind(&sprites, "prop avatar > killSprite", "SpriteCounter stype=prop win=True");
            assert_eq!(found.avatar, expect, "{class}");
        };
        check("MovingAvatar", AvatarKind::Walks);
        check("OrientedAvatar", AvatarKind::Turns);
        check("ShootAvatar stype=other", AvatarKind::WalksAndShoots);
        check("VerticalAvatar", AvatarKind::Slides);
        check("FlakAvatar stype=other", AvatarKind::SlidesAndShoots);
        check("OngoingAvatar", AvatarKind::Runs);
        check("ShootOnlyAvatar stype=other", AvatarKind::Aims);
        check("PlatformerAvatar", AvatarKind::Jumps);
        check("NullAvatar", AvatarKind::Watches);
    }

    #[test]
    fn guards_and_classes_are_counted_separately() {
        let sprites = "prop > RandomNPC; other > SpawnPoint stype=prop prob=0.5; avatar > MovingAvatar";
        let rules = "avatar wall > stepBack; prop wall EOS > stepBack; avatar EOS > stepBack; prop avatar > killSprite; prop other > stepBack";
        let found = kind(sprites, rules, "SpriteCounter stype=other win=True; Timeout limit=50");
        assert_eq!((found.interactions, found.guards), (2, 3), "{found:?}");
        assert_eq!(found.effects, [EffectFamily::Kill, EffectFamily::Block]);
        assert_eq!(
            (found.npcs, found.producers),
            (vec!["RandomNPC".to_owned()], vec!["SpawnPoint".to_owned()])
        );
        assert_eq!(found.chance, ChanceKind::Several);
    }
}
