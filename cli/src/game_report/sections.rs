//! The tables of the page, one for each question.

use crate::page::facts::{Fact, Five, Section, five, section};
use crate::page::words;
use forge::games::report::{
    Counted, Difficulties, GameSetReport, GamesCost, Mean, Novelty, Play, Rules, Skill, Variety,
};
use report::Share;

/// What is looked at first.
pub(super) fn headlines(report: &GameSetReport) -> Vec<Fact> {
    let mut facts = vec![Fact::share("meet every criterion", &report.validity.games)];
    facts.extend(report.skill.as_ref().map(|skill| Fact::share("skill pays", &skill.pays)));
    facts.push(Fact::share("every rule used", &report.rules.all_used));
    facts.push(Fact::plain("kinds of avatar × goal", report.variety.kinds.len().to_string()));
    let mechanics = report.play.mechanics.as_ref();
    facts.extend(
        mechanics.map(|count| Fact::plain("mechanics in winning play, median", words::short(count.median))),
    );
    facts.push(Fact::share("different games", &report.novelty.unique));
    facts.extend(report.accepted.as_ref().map(|share| Fact::share("accepted of those judged", share)));
    facts
}

/// All questions with their answers.
pub(super) fn all(report: &GameSetReport) -> Vec<Section> {
    let mut sections = vec![validity(report)];
    sections.extend(report.skill.as_ref().map(skill));
    sections.extend([rules(&report.rules), play(&report.play)]);
    sections.extend(report.difficulty.as_ref().and_then(rising));
    sections.push(variety(&report.variety, report.count));
    sections.push(novelty(&report.novelty));
    sections.extend(report.cost.as_ref().map(|cost| price(cost, report.accepted.as_ref())));
    sections
}

fn with(section: Section, quantiles: impl IntoIterator<Item = Option<Five>>) -> Section {
    Section { quantiles: quantiles.into_iter().flatten().collect(), ..section }
}

fn over_games(name: &str, mean: &Mean) -> Fact {
    Fact::signed(name, mean.mean, mean.interval).of(words::many(mean.games, "game"))
}

fn validity(report: &GameSetReport) -> Section {
    let validity = &report.validity;
    let mut facts = vec![
        Fact::share("games: all levels, and all together", &validity.games),
        Fact::share("levels", &validity.levels),
    ];
    for (criterion, count) in &validity.obstacles {
        facts.push(Fact::share(format!("fail first: {criterion}"), &Share::new(*count, report.count)));
    }
    section("Do they meet the criteria?", "See `arcade docs validate` for what each criterion asks.", facts)
}

fn skill(skill: &Skill) -> Section {
    let mut facts = vec![
        Fact::share("skill pays, in wins or in score", &skill.pays),
        Fact::share("of these, in score only", &skill.by_score_only),
        Fact::share("at least 25 points at the lower end of the interval", &skill.sure),
    ];
    facts.extend(
        skill
            .order
            .as_ref()
            .map(|order| over_games("players fare in the order of the ladder (rank correlation)", order)),
    );
    for player in &skill.players {
        facts.push(Fact::share(format!("{} wins", player.player), &player.wins));
    }
    let note = "The strongest player against the best of those who do not look ahead, over all levels of a game; then each \
                player over all games.";
    let points = five("difference of win rates", skill.points.as_ref());
    with(
        section("Does skill pay?", note, facts),
        [points, five("the same, players held out", skill.held_out.as_ref())],
    )
}

fn rules(rules: &Rules) -> Section {
    let facts = vec![
        Fact::share("games of which every rule runs", &rules.all_used),
        Fact::share("rules that run", &rules.executed),
        Fact::share("games without dead sprites", &rules.no_dead_sprites),
    ];
    let section =
        section("Is everything used?", "In some recorded episode; guards do not count as rules.", facts);
    with(section, [five("rules of a game", rules.count.as_ref())])
}

fn play(play: &Play) -> Section {
    let facts = vec![Fact::share("levels with a known win", &play.won)];
    let quantiles = [
        five("ticks of the shortest win found", play.ticks.as_ref()),
        five("mechanics that wins use", play.mechanics.as_ref()),
        five("drama", play.drama.as_ref()),
    ];
    with(section("How are they won?", "", facts), quantiles)
}

fn rising(difficulties: &Difficulties) -> Option<Section> {
    let rising = over_games(
        "harder and harder (rank correlation of place and difficulty)",
        difficulties.rising.as_ref()?,
    );
    Some(section("Do their levels get harder?", "", vec![rising]))
}

fn variety(variety: &Variety, games: u64) -> Section {
    let mut facts = vec![
        Fact::plain("kinds of avatar × goal", variety.kinds.len().to_string()).of(words::many(games, "game")),
    ];
    facts.extend(variety.largest.as_ref().map(|share| Fact::share("are of the most frequent kind", share)));
    let mut list = |what: &str, counted: &[Counted]| {
        facts.push(Fact::plain(what, counted.len().to_string()));
        facts
            .extend(counted.iter().map(|counted| Fact::share(format!("– {}", counted.name), &counted.games)));
    };
    list("families of effects", &variety.effects);
    list("classes of what moves by itself", &variety.npcs);
    list("classes of what makes others", &variety.producers);
    section("How varied are they?", "Games that have each.", facts)
}

fn novelty(novelty: &Novelty) -> Section {
    let facts = vec![
        Fact::share("different games: names and order of rules do not count", &novelty.unique),
        Fact::share("near-duplicates in the set", &novelty.near_duplicates),
        Fact::share("near-duplicates of the corpus", &novelty.near_corpus),
    ];
    let quantiles = [
        five("distance to the most similar one", novelty.nearest.as_ref()),
        five("distance of two of them", novelty.pairs.as_ref()),
        five("to the most similar one of the corpus", novelty.nearest_corpus.as_ref()),
        five("for scale: within the corpus", novelty.among_corpus.as_ref()),
    ];
    with(section("How new are they?", "Distances go from 0 (the same rules) to 1.", facts), quantiles)
}

fn price(cost: &GamesCost, accepted: Option<&Share>) -> Section {
    let each = cost.calls.checked_div(cost.accepted).map_or(words::NONE.to_owned(), words::grouped);
    let mut facts: Vec<Fact> =
        accepted.map(|share| Fact::share("accepted of those judged", share)).into_iter().collect();
    facts.push(Fact::plain("forward-model calls", words::grouped(cost.calls)));
    facts.push(Fact::plain("calls for each that was accepted", each));
    for (why, count) in &cost.rejections {
        facts.push(Fact::plain(format!("turned down: {why}"), words::grouped(*count)));
    }
    section("What did they cost?", "Judging them for this report apart.", facts)
}
