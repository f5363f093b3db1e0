//! The section `[designs]`: games from a pool, which a model, a person or a program has written with `arcade design`.
//!
//! A recipe contains only the digest of its pool. The pool is needed to mint a release and to mint it again, but not to
//! verify it, because the release contains the selected games.

mod make;
mod pool;
mod section;

use crate::mint::MintError;
use crate::recipe::Recipe;
use crate::recipe::error::RecipeError;
use base::Digest;
pub(crate) use make::make;
pub use pool::{Design, DesignPool, PoolError, Provenance};
pub(crate) use section::DesignsSection;
use serde::{Deserialize, Serialize};

base::with_defaults! {
    /// Games from a pool of designs, which `arcade release --designs` reads.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    pub struct DesignsPart {
        /// The number of games.
        pub games: u32 = 0,
        /// The number of levels per game. Designs with a different number of levels are not used.
        pub levels: u32 = 3,
        /// The digest of the pool, which `arcade release --designs` prints if the key is missing.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub digest: Option<Digest> = None,
    }
}

/// Checks that the pool is the one that the recipe names, and that it has enough designs.
pub(crate) fn check_pool(recipe: &Recipe, pool: Option<&DesignPool>) -> Result<(), MintError> {
    let wrong = |key, message| Err(RecipeError::Value { key, message }.into());
    let (part, pool) = match (&recipe.designs, pool) {
        (None, None) => return Ok(()),
        (None, Some(_)) => {
            let help = "is missing, but --designs was passed: add the section, or omit --designs";
            return wrong("designs", help.to_owned());
        }
        (Some(_), None) => {
            let help = "takes games from a folder that `arcade design` wrote: pass the folder with --designs";
            return wrong("designs", help.to_owned());
        }
        (Some(part), Some(pool)) => (part, pool),
    };
    let line = format!("`digest = \"{}\"`", pool.digest);
    match part.digest {
        None => {
            return wrong(
                "designs.digest",
                format!("is missing: for the folder passed with --designs, write {line}"),
            );
        }
        Some(digest) if digest != pool.digest => {
            let help = "pass the folder for which the recipe was written, or write";
            return wrong(
                "designs.digest",
                format!("is not the digest of the folder passed with --designs: {help} {line}"),
            );
        }
        Some(_) => {}
    }
    let (asked, most) = (part.games as usize, pool.fitting(part).len());
    if most >= asked {
        return Ok(());
    }
    Err(MintError::Unfillable {
        part: "designs",
        asked,
        most,
        why: format!(
            "{most} of the {} designs have {}",
            pool.designs.len(),
            base::count(part.levels as usize, "level")
        ),
        advice: format!("lower `designs.games` to {most} or less, or pass a folder with more designs"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mint::plan::corpus::Corpus;
    use crate::mint::{Memory, Minted, Plan, lay_out, make_jobs};
    use std::fs;
    use std::path::Path;

    const FETCH: &str = "# Fetch the gem first.
BasicGame
    SpriteSet
        gem > Immovable
        exit > Door
        avatar > MovingAvatar
    LevelMapping
        g > gem
        e > exit
    InteractionSet
        avatar wall > stepBack
        gem avatar > killSprite scoreChange=1
        exit avatar > killSprite
    TerminationSet
        MultiSpriteCounter stype1=gem stype2=exit limit=0 win=True
        Timeout limit=50 win=False
";
    const PUSH: &str = "BasicGame
    SpriteSet
        hole > Immovable
        crate > Passive
        avatar > MovingAvatar
    LevelMapping
        h > hole
        c > crate
    InteractionSet
        crate avatar > bounceForward
        crate wall > undoAll
        avatar wall > stepBack
        crate hole > killSprite scoreChange=2
        avatar hole > killSprite
    TerminationSet
        SpriteCounter stype=avatar limit=0 win=False
        SpriteCounter stype=crate limit=0 win=True
        Timeout limit=60 win=False
";
    const FETCH_LEVEL: &str =
        "wwwwwwwwwwww\nwA         w\nw          w\nw  wwwwww  w\nwg        ew\nwwwwwwwwwwww\n";
    const PUSH_LEVEL: &str = "wwwwwwwwww\nwA       w\nw  c   h w\nw        w\nwwwwwwwwww\n";

    fn design(folder: &Path, name: &str, files: &[(&str, &str)]) {
        let place = folder.join("games").join(name);
        fs::create_dir_all(&place).unwrap();
        files.iter().for_each(|(file, text)| fs::write(place.join(file), text).unwrap());
    }

    fn provenance(draft: u64) -> String {
        let digest = Digest::of(b"test");
        format!(
            "{{\"designer\":\"alice\",\"settings\":\"{digest}\",\"draft\":{draft},\"answers\":\"{digest}\",\"idea\":null}}"
        )
    }

    /// Writes a pool of two games.
    fn pool(folder: &Path) -> DesignPool {
        let (first, second) = (provenance(0), provenance(1));
        let fetch = [("game.vgdl", FETCH), ("lvl0.txt", FETCH_LEVEL), ("design.json", &first)];
        design(folder, "gem-run", &fetch);
        design(
            folder,
            "hole-in-one",
            &[("game.vgdl", PUSH), ("lvl0.txt", PUSH_LEVEL), ("design.json", &second)],
        );
        DesignPool::read(folder).unwrap()
    }

    fn recipe(games: u32, digest: &str) -> Recipe {
        let text = format!(
            "name = 'one'\ndescription = 'one'\nseed = 'designs'\n[designs]\ngames = {games}\nlevels = 1\n{digest}\n[criteria]\n\
             ask = ['not-idle', 'not-random', 'winnable']\nbudget = 20000\n"
        );
        Recipe::from_toml(&text).unwrap()
    }

    fn minted(recipe: &Recipe, pool: Option<&DesignPool>) -> Result<Minted, MintError> {
        let corpus = Corpus { designs: pool.cloned(), ..Corpus::default() };
        let plan = Plan::new(recipe, None, &corpus)?;
        let store = Memory::default();
        make_jobs(&plan, plan.jobs(), &store, &())?;
        lay_out(&plan, None, &store, Digest::of(b""), &mut |_, _| Ok(()))
    }

    #[test]
    fn designs_are_judged_and_keep_their_origin() {
        let folder = tempfile::tempdir().unwrap();
        let pool = pool(folder.path());
        let asked = recipe(2, &format!("digest = '{}'", pool.digest));
        let first = minted(&asked, Some(&pool)).unwrap();
        let mut titles: Vec<&str> = first.cards.iter().map(|card| card.title.as_str()).collect();
        titles.sort_unstable();
        assert_eq!(titles, ["Gem Run", "Hole In One"]);
        for card in &first.cards {
            let patterns = card.origin.patterns();
            assert!(patterns.contains(&"designer/alice".to_owned()), "{patterns:?}");
            assert_eq!(card.levels[0].generator, "design");
        }
        assert_eq!(first.manifest.root, minted(&asked, Some(&pool)).unwrap().manifest.root);
        // A level that nobody can win is rejected, whatever its designer's run found.
        let walled = PUSH_LEVEL.replace('c', "w");
        let second = provenance(1);
        design(
            folder.path(),
            "hole-in-one",
            &[("lvl0.txt", &walled.replace('h', "c")), ("design.json", &second)],
        );
        let changed = DesignPool::read(folder.path()).unwrap();
        let digest = format!("digest = '{}'", changed.digest);
        let error = minted(&recipe(2, &digest), Some(&changed)).unwrap_err().to_string();
        assert!(error.contains("designs") && error.contains("winnable"), "{error}");
    }

    #[test]
    fn the_recipe_names_its_pool() {
        let folder = tempfile::tempdir().unwrap();
        let pool = pool(folder.path());
        let line = format!("digest = \"{}\"", pool.digest);
        let error = |recipe: &Recipe, pool| minted(recipe, pool).unwrap_err().to_string();
        let says = |error: String, expect: &str| assert!(error.contains(expect), "{error}");
        says(error(&recipe(1, ""), Some(&pool)), &line);
        let other = format!("digest = '{}'", Digest::of(b"other"));
        says(error(&recipe(1, &other), Some(&pool)), &line);
        says(error(&recipe(1, &line), None), "--designs");
        says(error(&recipe(3, &line), Some(&pool)), "lower `designs.games` to 2");
        says(error(&crate::mint::tests::recipe("plain"), Some(&pool)), "add the section");
        let renamed = folder.path().join("games/gem-dash");
        fs::rename(folder.path().join("games/gem-run"), renamed).unwrap();
        assert_ne!(DesignPool::read(folder.path()).unwrap().digest, pool.digest);
    }

    #[test]
    fn all_problems_of_a_pool_are_reported() {
        let folder = tempfile::tempdir().unwrap();
        let error = || DesignPool::read(folder.path()).unwrap_err().to_string();
        assert!(error().contains("arcade design --out DIR"), "{}", error());
        design(folder.path(), "a", &[("game.vgdl", FETCH), ("lvl0.txt", "w?w"), ("design.json", "{}")]);
        design(folder.path(), "b", &[("game.vgdl", "BasicGame\n  SpriteSet\n    x > Nothing\n")]);
        // A run that was interrupted has not written the rules yet.
        design(folder.path(), "c", &[("lvl0.txt", FETCH_LEVEL)]);
        for expect in [
            "a/lvl0.txt: ",
            "a/design.json: ",
            "b/game.vgdl: ",
            "b/lvl0.txt: missing",
            "b/design.json: missing",
        ] {
            assert!(error().contains(expect), "{expect}: {}", error());
        }
        assert!(!error().contains("games/c"), "{}", error());
    }
}
