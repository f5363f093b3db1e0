//! The tables of the page, one for each question.

use crate::page::facts::{Beside, Fact, Section, five, section};
use crate::page::words;
use forge::levels::report::{
    Control, Diversity, Estimate, Expense, Fit, Hits, LevelSetReport, NEAR, Novelty, Rules, Share, Skill,
};

/// What is looked at first.
pub(super) fn headlines(report: &LevelSetReport) -> Vec<Fact> {
    let mut facts = vec![
        Fact::share("solved", &report.solvability.solved),
        Fact::share("not won for nothing", &report.triviality.both_levels),
        Fact::share("unique", &report.diversity.unique),
    ];
    let ticks = report.lengths.ticks.as_ref();
    facts.extend(ticks.map(|ticks| Fact::plain("ticks of a win, median", words::short(ticks.median))));
    let pushes = report.lengths.pushes.as_ref();
    facts.extend(pushes.map(|pushes| Fact::plain("pushes, median", words::short(pushes.median))));
    facts.extend(report.skill.as_ref().map(|skill| signed("gain of looking ahead", &skill.wins)));
    facts.extend(report.control.as_ref().map(|control| Fact::share("as hard as asked", &control.all.exact)));
    facts
}

/// All questions with their answers.
pub(super) fn all(report: &LevelSetReport) -> Vec<Section> {
    let LevelSetReport { diversity, novelty, control, cost, .. } = report;
    let mut sections = vec![validity(report), solvability(report), triviality(report), lengths(report)];
    sections.extend(report.skill.as_ref().map(skill));
    sections.push(rules(&report.rules));
    sections.push(differences(diversity));
    sections.extend(novelty.as_ref().map(news));
    sections.extend(control.as_ref().map(hits));
    sections.push(price(cost));
    sections
}

fn validity(report: &LevelSetReport) -> Section {
    let validity = &report.validity;
    let mut facts = vec![
        Fact::share("well-formed", &validity.well_formed),
        Fact::share("without warnings", &validity.clean),
        Fact::share("every criterion met", &validity.passes),
    ];
    for (criterion, count) in &validity.obstacles {
        facts.push(Fact::share(format!("fail first: {criterion}"), &Share::new(*count, report.count)));
    }
    let fits = validity.fit.iter().map(beside).collect();
    Section {
        fits,
        ..section("Are they levels?", "See `arcade docs validate` for what each criterion asks.", facts)
    }
}

fn solvability(report: &LevelSetReport) -> Section {
    let solvability = &report.solvability;
    let facts = vec![
        Fact::share("solved: an episode wins, and replays", &solvability.solved),
        Fact::share("impossible: proved", &solvability.impossible),
        Fact::share("unknown: the budget was spent", &solvability.unknown),
    ];
    section("Can they be won?", "", facts)
}

fn triviality(report: &LevelSetReport) -> Section {
    let triviality = &report.triviality;
    let facts = vec![
        Fact::share("episodes won by doing nothing", &triviality.idle),
        Fact::share("episodes won by random keys", &triviality.random),
        Fact::share("levels of which doing nothing wins at most 10\u{a0}%", &triviality.idle_levels),
        Fact::share("levels of which random keys win at most 10\u{a0}%", &triviality.random_levels),
        Fact::share("both", &triviality.both_levels),
    ];
    section("Are they won for nothing?", "", facts)
}

fn lengths(report: &LevelSetReport) -> Section {
    let lengths = &report.lengths;
    let facts = vec![Fact::share("no fewer ticks win: proved", &lengths.proved)];
    let quantiles = [
        five("ticks of the witness", lengths.ticks.as_ref()),
        five("ticks, where no fewer win", lengths.shortest.as_ref()),
        five("pushes of the witness", lengths.pushes.as_ref()),
    ];
    Section {
        quantiles: quantiles.into_iter().flatten().collect(),
        ..section("How long is a win?", "Of the shortest win that was found.", facts)
    }
}

fn skill(skill: &Skill) -> Section {
    let mut facts = vec![signed("more wins by looking ahead", &skill.wins)];
    facts.extend(skill.reward.as_ref().map(|reward| signed("more score by looking ahead", reward)));
    let order = skill.order.as_ref();
    facts.extend(
        order.map(|order| signed("players fare in the order of the ladder (rank correlation)", order)),
    );
    for player in &skill.players {
        facts.push(Fact::share(format!("{} wins", player.player), &player.wins));
    }
    section("Does skill pay?", "Means over levels; then each player over all levels.", facts)
}

fn rules(rules: &Rules) -> Section {
    let mut facts = vec![Fact::share("interactions that some witness executes", &rules.used)];
    facts.extend(rules.each.as_ref().map(|each| mean("share of them that one witness executes", each)));
    for line in &rules.lines {
        let edge = if line.guard { " (edge: not counted)" } else { "" };
        facts.push(Fact::share(format!("{}{edge}", line.rule), &line.levels));
    }
    section("Which rules do they use?", "Then each interaction: the levels whose witness executes it.", facts)
}

fn differences(diversity: &Diversity) -> Section {
    let mut facts = vec![Fact::share("unique up to symmetry", &diversity.unique)];
    facts.extend(diversity.distance.as_ref().map(|found| mean("distance of two levels", found)));
    facts
        .push(Fact::share(format!("near-duplicates: another one within {NEAR}"), &diversity.near_duplicates));
    Section {
        quantiles: five("distance to the most similar one", diversity.nearest.as_ref()).into_iter().collect(),
        ..section("How different are they?", "Distances go from 0 (the same level) to 1.", facts)
    }
}

fn news(novelty: &Novelty) -> Section {
    let facts = vec![
        Fact::share("copies of one of the game's own, up to symmetry", &novelty.copies),
        Fact::share(format!("near-duplicates of one: within {NEAR}"), &novelty.near_duplicates),
    ];
    let quantiles = [
        five("distance to the most similar one of the game's own", novelty.nearest.as_ref()),
        five("for scale: among the game's own", novelty.among_examples.as_ref()),
    ];
    Section {
        quantiles: quantiles.into_iter().flatten().collect(),
        ..section("How new are they?", "", facts)
    }
}

fn hits(control: &Control) -> Section {
    let of = |hits: &Hits, which: &str| {
        let random = |value: Option<f64>| {
            value.map(|value| Fact::plain("— picked at random", words::whole_percent(value)))
        };
        let exact = Fact::share(format!("measured as asked, {which}"), &hits.exact);
        let near = Fact::share(format!("within one label, {which}"), &hits.within_one);
        let facts = [Some(exact), random(hits.random_exact), Some(near), random(hits.random_within_one)];
        facts.into_iter().flatten().collect::<Vec<Fact>>()
    };
    let labels: Vec<String> = control.expressible.iter().map(ToString::to_string).collect();
    let note = if control.pool.is_empty() {
        "Measured with seeds that the search was not guided by.".to_owned()
    } else {
        let labels = if labels.is_empty() { "none".to_owned() } else { labels.join(", ") };
        format!(
            "Measured with seeds that the search was not guided by. The game can express (at least 5 % of an unconstrained pool \
             of {}): {labels}.",
            words::grouped(control.pool.iter().sum())
        )
    };
    let mut facts = of(&control.all, "all labels");
    if (1..control.all.exact.of).contains(&control.of_expressible.exact.of) {
        facts.extend(of(&control.of_expressible, "labels that the game can express"));
    }
    section("Are they as hard as asked?", note, facts)
}

fn price(cost: &Expense) -> Section {
    let each = cost.calls.checked_div(cost.accepted).map_or(words::NONE.to_owned(), words::grouped);
    let mut facts = vec![
        Fact::plain("forward-model calls", words::grouped(cost.calls)),
        Fact::plain("candidates that a search looked at", words::grouped(cost.looks)),
        Fact::plain("candidates before the panel", words::grouped(cost.judged)),
        Fact::plain("accepted", words::grouped(cost.accepted)),
        Fact::plain("calls for each that was accepted", each),
    ];
    for (why, count) in &cost.rejections {
        facts.push(Fact::plain(format!("turned down: {why}"), words::grouped(*count)));
    }
    section("What did they cost?", "Judging them for this report apart.", facts)
}

/// A mean over levels that may be negative.
fn signed(name: &str, estimate: &Estimate) -> Fact {
    Fact::signed(name, estimate.mean, estimate.interval).of(words::many(estimate.levels, "level"))
}

/// A mean over levels from 0 to 1.
fn mean(name: &str, estimate: &Estimate) -> Fact {
    Fact::mean(name, estimate.mean, estimate.interval).of(words::many(estimate.levels, "level"))
}

fn beside(fit: &Fit) -> Beside {
    let span = |[low, high]: [f64; 2]| {
        let [low, high] = [low, high].map(words::short);
        if low == high { low } else { format!("{low} to {high}") }
    };
    Beside {
        measure: fit.measure.clone(),
        levels: span(fit.levels),
        examples: span(fit.examples),
        within: words::percent(&fit.within),
        of: words::counted(&fit.within),
    }
}
