//! The texts about a rethemed game: the title, the summary and the goal. They are derived from the rules, and from the
//! scene, which supplies nouns and sentences.

use super::casting;
use super::english::{capital, headline, one, plural, series, spaced};
use super::kind::Kind;
use crate::kernels::words::scene::Retelling;
use base::Sampler;
use engine::SpriteType;
use engine::analysis::{Analysis, Role as Use};
use engine::describe::Guide;
use itertools::Itertools;

/// The maximum number of names in a clause of a summary.
const MAX_NAMES: usize = 4;
/// The number of titles to draw before falling back to a plain title.
const MAX_TITLES: usize = 32;

/// Returns the name of the player character.
pub(crate) fn hero(analysis: &Analysis) -> String {
    let avatar = analysis.start_avatar().or(analysis.avatars().first());
    avatar.map_or_else(|| "stranger".to_owned(), |avatar| spaced(analysis.game().name(avatar.stype)))
}

/// Draws a title for which `is_new` returns `true`, from the kind of game, the avatar's noun and the scene.
pub(super) fn title(
    analysis: &Analysis,
    retelling: &Retelling,
    hero: &str,
    is_new: impl Fn(&str) -> bool,
    sampler: &mut Sampler,
) -> String {
    let kind = Kind::of(analysis);
    let hero = headline(hero);
    let mut titles = (0..MAX_TITLES).map(|_| {
        let title_word = kind.title_word(sampler);
        retelling.title(&hero, title_word, sampler)
    });
    titles.find(|title| is_new(title) && !title.contains("Avatar")).unwrap_or_else(|| format!("The {hero}"))
}

/// Describes the avatar and the setting, the tasks and the dangers.
pub(crate) fn summary(analysis: &Analysis, retelling: &Retelling, hero: &str) -> String {
    let game = analysis.game();
    let types = |fits: &dyn Fn(SpriteType, Use) -> bool| -> Vec<String> {
        let there = game.sprite_types().filter(|&stype| {
            let facts = analysis.facts(stype);
            facts.possible && facts.concrete && fits(stype, analysis.role(stype))
        });
        there.map(|stype| spaced(game.name(stype))).take(MAX_NAMES).collect()
    };
    let many = |names: Vec<String>| names.iter().map(|name| plural(name)).collect::<Vec<_>>();
    let single = |names: Vec<String>| names.iter().map(|name| format!("the {name}")).collect::<Vec<_>>();
    let caught = |stype| casting::is_caught(analysis, stype);
    let dangerous = |stype| casting::is_dangerous(analysis, stype);
    let must_go = |stype| analysis.aims().remove.contains(&stype);
    let prey = |stype, role| role == Use::Prey || (role == Use::Enemy && must_go(stype));
    // The pushed things. If `is_aim` is `true`, only those that must be removed, because all others stay at their
    // destinations.
    let pushed = |is_aim: bool| types(&|stype, role| role == Use::Pushable && (!is_aim || must_go(stype)));
    let aims = pushed(true);
    let tasks = [
        ("gather", many(types(&|_, role| role == Use::Collectable)), ""),
        ("fetch", single(types(&|_, role| role == Use::Key)), ""),
        ("push", many(if aims.is_empty() { pushed(false) } else { aims }), ""),
        ("catch", many(types(&|stype, role| prey(stype, role) && caught(stype))), ""),
        ("make an end of", many(types(&|stype, role| prey(stype, role) && !caught(stype))), ""),
        ("get past", single(types(&|_, role| role == Use::Gate)), ""),
        ("keep", single(types(&|_, role| role == Use::Ward)), " from harm"),
        ("get to", single(types(&|_, role| role == Use::Exit)), ""),
        (
            "mind",
            single(types(&|stype, role| role == Use::Enemy && !must_go(stype) && !dangerous(stype))),
            "",
        ),
        ("beware of", single(types(&|stype, _| dangerous(stype))), ""),
    ];
    let told = tasks.into_iter().filter(|(_, names, _)| !names.is_empty());
    let clause = |(verb, names, rest): (&str, Vec<String>, &str)| format!("{verb} {}{rest}", series(&names));
    let mut clauses: Vec<String> = told.map(clause).collect();
    if analysis.aims().survive.is_some() {
        clauses.insert(0, "hold out".to_owned());
    }
    let start = format!("{} {}", capital(&one(hero)), retelling.place);
    if clauses.is_empty() { format!("{start}.") } else { format!("{start} has to {}.", clauses.join("; ")) }
}

/// Returns the winning conditions in the words of the engine's [`Guide`], but with names written as ordinary English.
pub(crate) fn goal(analysis: &Analysis) -> String {
    let names: Vec<&str> = analysis.game().sprite_types().map(|stype| analysis.game().name(stype)).collect();
    let word = |word: &str| {
        let name = word.trim_end_matches([',', '.']);
        let rest = &word[name.len()..];
        if names.contains(&name) {
            format!("{}{rest}", spaced(name))
        } else if let Some(one) = names.iter().find(|one| plural(one) == name) {
            format!("{}{rest}", plural(&spaced(one)))
        } else {
            word.to_owned()
        }
    };
    Guide::from_analysis(analysis).goal().split(' ').map(word).join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::Game;

    #[test]
    fn goals_about_several_have_spaced_names() {
        let game = Game::from_source(
            "BasicGame\n  SpriteSet\n    fairLamp > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    l > fairLamp\n  \
             InteractionSet\n    fairLamp avatar > killSprite\n  TerminationSet\n    SpriteCounter stype=fairLamp limit=2 win=True\n",
        )
        .unwrap();
        assert_eq!(goal(&Analysis::of(&game)), "You win when at most 2 fair lamps are left.");
    }
}
