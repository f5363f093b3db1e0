//! The page: one HTML file that needs nothing else.

use super::frames::Frames;
use super::{Showcase, sections};
use crate::failure::Failure;
use crate::page::facts::{Fact, Section};
use crate::page::{Figure, words};
use forge::games::report::{Difficulties, GameEntry, GameSetReport, Nearest, Variety};
use serde::Serialize;
use std::collections::BTreeSet;
use validators::Difficulty;

const TEMPLATE: &str = include_str!("page.html");

/// A game on the page.
#[derive(Serialize)]
struct Card<'a> {
    title: &'a str,
    goal: &'a str,
    figure: Option<Figure<'a>>,
    /// What it is, in a line.
    line: String,
    levels: Vec<Chip>,
}

/// A level of a game: a coloured mark.
#[derive(Serialize)]
struct Chip {
    class: &'static str,
    label: String,
}

impl Chip {
    fn of(number: usize, label: Option<Difficulty>) -> Chip {
        let class = match label {
            Some(Difficulty::VeryEasy) => "d0",
            Some(Difficulty::Easy) => "d1",
            Some(Difficulty::Medium) => "d2",
            Some(Difficulty::Hard) => "d3",
            Some(Difficulty::VeryHard) => "d4",
            Some(Difficulty::Unbeaten) => "d5",
            None => "dx",
        };
        let label = label.map_or("not measured".to_owned(), |label| label.to_string());
        Chip { class, label: format!("level {number}: {label}") }
    }
}

impl<'a> Card<'a> {
    fn of(entry: &'a GameEntry, figure: Option<Figure<'a>>) -> Card<'a> {
        let kind = &entry.kind;
        let mut parts = vec![format!("{} × {}", kind.avatar.name(), kind.goal.name())];
        parts.push(words::many(entry.found.rules, "rule"));
        parts.extend(entry.obstacle.as_ref().map(|criterion| words::not_passed(criterion)));
        let chips = entry.levels.iter().enumerate().map(|(number, level)| Chip::of(number, level.label));
        Card {
            title: &entry.title,
            goal: &entry.goal,
            figure,
            line: parts.join(" · "),
            levels: chips.collect(),
        }
    }
}

/// Counts in rows and columns.
#[derive(Serialize)]
struct Grid {
    columns: Vec<String>,
    rows: Vec<(String, Vec<u64>)>,
}

impl Grid {
    /// Kinds of avatars against kinds of goals.
    fn of_kinds(variety: &Variety) -> Grid {
        let avatars: BTreeSet<_> = variety.kinds.iter().map(|kind| kind.avatar).collect();
        let goals: BTreeSet<_> = variety.kinds.iter().map(|kind| kind.goal).collect();
        let games = |avatar, goal| {
            let found = variety.kinds.iter().find(|kind| kind.avatar == avatar && kind.goal == goal);
            found.map_or(0, |kind| kind.games)
        };
        let row = |&avatar: &validators::game_measures::AvatarKind| {
            (avatar.name().to_owned(), goals.iter().map(|&goal| games(avatar, goal)).collect())
        };
        let columns = goals.iter().map(|goal| goal.name().to_owned()).collect();
        Grid { columns, rows: avatars.iter().map(row).collect() }
    }

    /// Places of levels against labels.
    fn of_difficulties(difficulties: &Difficulties) -> Grid {
        let rows = difficulties.table.iter().enumerate();
        Grid {
            columns: difficulties.labels.iter().map(ToString::to_string).collect(),
            rows: rows.map(|(place, counts)| (format!("level {place}"), counts.clone())).collect(),
        }
    }
}

/// The table of all games.
#[derive(Serialize)]
struct Table {
    columns: Vec<&'static str>,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn of(entries: &[GameEntry]) -> Table {
        let columns = vec![
            "game",
            "verdict",
            "won",
            "rules",
            "run",
            "sprites",
            "there",
            "mechanics",
            "drama",
            "strongest",
            "floor",
            "points",
            "95 %",
            "score",
            "held out",
            "order",
            "nearest",
            "in the corpus",
            "digest",
        ];
        Table { columns, rows: entries.iter().map(row).collect() }
    }
}

fn row(entry: &GameEntry) -> Vec<String> {
    let (found, none) = (&entry.found, || words::NONE.to_owned());
    let edge = found.edge.as_ref();
    let near = |near: &Option<Nearest>| {
        near.as_ref().map_or_else(none, |near| format!("{} {}", words::mean(near.distance), near.name))
    };
    let of = |value: Option<String>| value.unwrap_or_else(none);
    vec![
        entry.title.clone(),
        entry.obstacle.as_ref().map_or("passes".to_owned(), |criterion| words::not_passed(criterion)),
        format!("{} of {}", found.won, found.levels),
        found.rules.to_string(),
        found.executed.to_string(),
        found.types.to_string(),
        found.there.to_string(),
        of(found.mechanics.map(|count| count.to_string())),
        of(found.drama.map(words::mean)),
        of(edge.map(|edge| format!("{} {} of {}", edge.strongest, edge.wins, edge.plays))),
        of(edge.map(|edge| format!("{} {}", edge.floor, edge.floor_wins))),
        of(edge.map(|edge| format!("{:+.0}", 100.0 * edge.points))),
        of(edge.map(|edge| format!("{:+.0} to {:+.0}", 100.0 * edge.interval[0], 100.0 * edge.interval[1]))),
        of(edge.and_then(|edge| edge.score).map(words::signed)),
        of(entry.held_out.as_ref().map(|edge| format!("{} {:+.0}", edge.strongest, 100.0 * edge.points))),
        of(found.order.map(words::signed)),
        near(&entry.nearest),
        near(&entry.nearest_corpus),
        entry.rules.short(),
    ]
}

/// All that the template shows.
#[derive(Serialize)]
struct Page<'a> {
    title: &'a str,
    method: &'a str,
    count: u64,
    semantics: u32,
    generation: u32,
    seconds: Option<String>,
    headlines: Vec<Fact>,
    games: Vec<Card<'a>>,
    kinds: Grid,
    difficulties: Option<Grid>,
    sections: Vec<Section>,
    table: Table,
}

/// The page. The same arguments give the same bytes.
pub(super) fn render(
    report: &GameSetReport,
    showcase: &Showcase<'_>,
    frames: &Frames,
) -> Result<String, Failure> {
    let cards = report.games.iter().zip(&frames.each).map(|(entry, frame)| {
        let figure =
            frame.as_ref().map(|frame| Figure::new(&frame.png, frame.size, &entry.title, &entry.goal));
        Card::of(entry, figure)
    });
    let page = Page {
        title: showcase.title,
        method: &report.method,
        count: report.count,
        semantics: report.semantics,
        generation: report.generation,
        seconds: showcase.seconds.map(words::short),
        headlines: sections::headlines(report),
        games: cards.collect(),
        kinds: Grid::of_kinds(&report.variety),
        difficulties: report.difficulty.as_ref().map(Grid::of_difficulties),
        sections: sections::all(report),
        table: Table::of(&report.games),
    };
    crate::page::render(TEMPLATE, &page)
}
