//! Checks of pairs after the reveal. A pair consists of two renamings of a game or two wins of a level. The two members
//! must differ only in permitted ways, and the published member must be the one that the secret random choice selected.

use super::toss::differ;
use super::{SecondWin, Sibling, publishes_sibling, publishes_win};
use crate::contents::replay::problem as replay_problem;
use crate::sections::frozen::FrozenGame;
use base::{Seed, SeedPath};
use engine::{Episode, Game, Level};
use validators::GameForm;

/// A game's levels with their published wins.
pub(super) type Levels = [(Level, Option<Episode>)];

/// A game's sibling (the withheld renamed copy), loaded from its texts.
pub(crate) struct SecretGame {
    /// The sibling's rules.
    pub(crate) game: Game,
    /// The levels of the sibling, each with its original text.
    pub(crate) levels: Vec<(String, Level)>,
}

impl SecretGame {
    /// Loads the texts of a sibling (a withheld renamed copy).
    ///
    /// # Errors
    /// Returns a message if the rules or a level do not load.
    pub(crate) fn load(source: &str, levels: &[String]) -> Result<SecretGame, String> {
        let game = Game::from_source(source).map_err(|problems| format!("not a valid game: {problems}"))?;
        let level = |(number, text): (usize, &String)| {
            let level = game.level(text);
            let level =
                level.map_err(|problems| format!("lvl{number}.txt is not a level of this game: {problems}"));
            Ok((text.clone(), level?))
        };
        let levels = levels.iter().enumerate().map(level).collect::<Result<_, String>>()?;
        Ok(SecretGame { game, levels })
    }

    /// Returns a sentence about the problem with a published game's sibling (its withheld renamed copy). It is a
    /// problem if the rules or the levels differ from the game's, or if the random choice selected the sibling for
    /// publication. `root` is the seed for the random choices.
    pub(crate) fn flaw(&self, published: &Game, levels: &Levels, root: Option<Seed>) -> Option<String> {
        let (one, other) = (published.digest(), self.game.digest());
        if one == other {
            return Some("identical to the original game".to_owned());
        }
        if GameForm::of(published).digest() != GameForm::of(&self.game).digest() {
            return Some("the rules are not those of the game under different names".to_owned());
        }
        // With the same fixed seed, the initial states must be equal.
        let start = |game: &Game, level: &Level| game.start(level, Seed::from_text("start")).state_hash();
        let differing = self.levels.len() != levels.len()
            || self
                .levels
                .iter()
                .zip(levels)
                .any(|((_, own), (level, _))| start(&self.game, own) != start(published, level));
        if differing {
            return Some("the levels are not those of the game under different names".to_owned());
        }
        let is_tossed = root.is_none_or(|root| publishes_sibling(root, one, other));
        (!is_tossed).then(|| {
            "the coin (the secret random choice) selects this withheld game for publication".to_owned()
        })
    }
}

/// Returns a sentence about the problem with a level's pair of wins (published and withheld), without replaying the
/// withheld win; `None` if there is no problem.
pub(super) fn pair_flaw(published: Option<&Episode>, second: &Episode, root: Option<Seed>) -> Option<String> {
    let published = published?;
    if !differ(&published.actions, &second.actions) {
        return Some("the second win begins like the published win".to_owned());
    }
    let is_tossed = root.is_none_or(|root| publishes_win(root, published, second));
    (!is_tossed)
        .then(|| "the coin (the secret random choice) selects this withheld win for publication".to_owned())
}

/// Returns a sentence about the problem with a game's pairs in a job's result; `None` if there is no problem. `root` is
/// the root seed of the plan.
pub(super) fn shape_problem(frozen: &FrozenGame, game: &Game, root: Seed) -> Option<String> {
    let FrozenGame { levels, witnesses, sibling, seconds, .. } = frozen;
    if !seconds.is_empty() && seconds.len() != levels.len() {
        return Some("the number of second wins differs from the number of levels".to_owned());
    }
    let loaded: Option<Vec<(Level, Option<Episode>)>> = levels
        .iter()
        .zip(witnesses)
        .map(|(text, won)| Some((game.level(text).ok()?, Some(won.clone()))))
        .collect();
    let loaded = loaded?;
    if let Some(Sibling { text, levels, .. }) = sibling {
        let flaw = match SecretGame::load(text, levels) {
            Ok(secret) => secret.flaw(game, &loaded, Some(root)),
            Err(what) => Some(what),
        };
        if let Some(what) = flaw {
            return Some(format!("invalid sibling: {what}"));
        }
    }
    for ((level, published), second) in loaded.iter().zip(seconds) {
        let Some(SecondWin { episode, path }) = second else { continue };
        let foreign = path.is_empty() || SeedPath::new(root, path.clone()).seed() != episode.seed;
        let flaw = foreign.then(|| "the randomness does not come from the plan's seed".to_owned());
        let flaw = flaw.or_else(|| pair_flaw(published.as_ref(), episode, Some(root)));
        if let Some(what) = flaw.or_else(|| replay_problem(episode, game, level)) {
            return Some(format!("invalid second win: {what}"));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::twin;
    use engine::Action;
    use engine::Action::{Down, Left, Up};
    use engine::Outcome;

    const GAME: &str = "BasicGame\n    SpriteSet\n        earth > Immovable color=BLACK\n        wall > Immovable color=BROWN\n        \
        door > Door color=GREEN\n        mole > MovingAvatar color=WHITE\n    LevelMapping\n        . > earth\n        w > earth wall\n        \
        d > earth door\n        m > earth mole\n    InteractionSet\n        mole wall > stepBack\n        door mole > killSprite scoreChange=1\n    \
        TerminationSet\n        SpriteCounter stype=door limit=0 win=True\n        Timeout limit=50 win=False\n";
    const LEVEL: &str = "wwwww\nwm.dw\nwwwww\n";

    /// Checks the sibling (renamed copy) of the game of the mole after a change. `heads` is the result of the random
    /// choice between the two copies.
    #[track_caller]
    fn check(change: impl Fn(&mut String, &mut Vec<String>), heads: bool, expect: Option<&str>) {
        let game = Game::from_source(GAME).unwrap();
        let levels = [(game.level(LEVEL).unwrap(), None)];
        let renamed = twin::renamed(GAME, &[LEVEL.to_owned()], &[], Seed::from_text("secret")).unwrap().0;
        let other = Game::from_source(&renamed.text).unwrap().digest();
        let seeds = (0..).map(|number| Seed::from_text("coins").child("try", number));
        let mut tossed = seeds.map(|seed| (seed, publishes_sibling(seed, game.digest(), other)));
        let (root, _) = tossed.find(|(_, publishes)| *publishes == heads).unwrap();
        let (mut text, mut texts) = (renamed.text, renamed.levels);
        change(&mut text, &mut texts);
        let found = match SecretGame::load(&text, &texts) {
            Ok(secret) => secret.flaw(&game, &levels, Some(root)),
            Err(what) => Some(what),
        };
        assert_eq!(found.is_some(), expect.is_some(), "{found:?}");
        assert!(found.unwrap_or_default().contains(expect.unwrap_or_default()), "{expect:?}");
    }

    #[test]
    fn siblings_are_the_game_under_other_names() {
        let same = |_: &mut String, _: &mut Vec<String>| ();
        check(same, true, None);
        check(same, false, Some("selects this withheld game"));
        check(|text, _| text.clear(), true, Some("not a valid game"));
        check(|_, levels| levels[0] = "?".to_owned(), true, Some("lvl0.txt is not a level of this game"));
        check(|_, levels| levels.clear(), true, Some("the levels are not those"));
        check(
            |text, _| *text = text.replace("scoreChange=1", "scoreChange=2"),
            true,
            Some("the rules are not"),
        );
        let mirrored = |_: &mut String, levels: &mut Vec<String>| {
            let flip = |line: &str| line.chars().rev().collect::<String>() + "\n";
            levels[0] = levels[0].lines().map(flip).collect();
        };
        check(mirrored, true, Some("the levels are not those"));
        let itself = |text: &mut String, levels: &mut Vec<String>| {
            (*text, *levels) = (GAME.to_owned(), vec![LEVEL.to_owned()]);
        };
        check(itself, true, Some("identical to the original game"));
    }

    #[test]
    fn wins_of_a_pair_differ_and_the_coin_withholds_one() {
        let of = |actions: &[Action]| Episode {
            game: base::Digest::of(b"game"),
            level: base::Digest::of(b"level"),
            seed: Seed::from_text("seed"),
            actions: actions.to_vec(),
            hashes: Vec::new(),
            outcome: Outcome::Won,
            score: 1.0,
            path: Vec::new(),
        };
        let (one, other) = (of(&[Up, Left]), of(&[Down, Left]));
        let flaw = |root: Seed, one: &Episode, other: &Episode| pair_flaw(Some(one), other, Some(root));
        for number in 0..8 {
            let root = Seed::from_text("coins").child("try", number);
            let (published, withheld) =
                if publishes_win(root, &one, &other) { (&one, &other) } else { (&other, &one) };
            assert_eq!(flaw(root, published, withheld), None);
            assert!(flaw(root, withheld, published).unwrap().contains("selects this withheld win"));
        }
        assert!(
            flaw(Seed::from_text("x"), &one, &of(&[Up])).unwrap().contains("begins like the published win")
        );
        assert_eq!(pair_flaw(None, &other, None), None);
    }
}
