//! One environment of a batch (a *lane* in the code), which plays one episode of a game after another, and its
//! observations.

use crate::errors::invalid;
use crate::game::{Game, Level, OUTCOMES, Rules, outcome_name, seed_of};
use crate::picture;
use crate::status::Status;
use base::Seed;
use engine::{Chance, Drawn, Outcome, Planes};
use pyo3::prelude::*;

/// The text from which the seed of an unseeded environment is derived.
const UNSEEDED: &str = "unseeded";

/// The rule that determines when an environment whose episode has ended starts a new one.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Autoreset {
    /// The next step starts a new episode and ignores its action.
    NextStep,
    /// The step that ends an episode also starts the next episode.
    SameStep,
    /// An environment whose episode has ended stays idle until it is reset.
    Disabled,
}

/// The format of an observation.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sight {
    /// `[planes][rows][columns]`, with 1 in each cell that contains a sprite of the plane's type.
    Planes,
    /// `[rows][columns]`, with the ASCII code for each cell's topmost sprite. `Lanes.symbols` lists the
    /// characters.
    Symbols,
    /// `[height][width][3]`, an RGB image with the given number of pixels per cell.
    Rgb(u32),
}

/// The data shared by all environments.
pub(crate) struct Setting {
    pub(crate) game: Game,
    pub(crate) levels: Vec<Level>,
    /// The initial states of the levels.
    pub(crate) roots: Vec<engine::State>,
    pub(crate) planes: Planes,
    pub(crate) status: Status,
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    pub(crate) sight: Sight,
    /// The sprite types in drawing order, each with the character that represents it on boards of symbols.
    pub(crate) characters: Vec<(usize, u8)>,
    pub(crate) max_steps: u64,
    pub(crate) autoreset: Autoreset,
}

/// An environment and its current episode.
pub(crate) struct Lane {
    pub(crate) state: engine::State,
    pub(crate) root: usize,
    /// The level selected for the next episode, or `None` to draw it.
    pub(crate) chosen: Option<usize>,
    pub(crate) seed: Seed,
    /// The number of episodes started with this seed before the current one.
    pub(crate) episodes: u64,
    /// The seed of the current episode.
    pub(crate) current: Seed,
    /// The indices of the actions played in the current episode.
    pub(crate) actions: Vec<u8>,
    pub(crate) is_over: bool,
    pub(crate) last: Last,
    pub(crate) drawn: Drawn,
}

/// The score, outcome and status at the end of an environment's last finished episode. Callers need them if the step
/// that ended the episode has already started the next episode.
pub(crate) type Last = (f64, &'static str, Vec<f32>);

/// The parts of an environment from which it can be restored: the level, the seed, the number of episodes started with
/// the seed, the seed of the current episode, the actions, the end flag, and the end of the last episode.
pub(crate) type SavedLane = (usize, String, u64, String, Vec<u8>, bool, (f64, String, Vec<f32>));

/// The output of one environment's step.
pub(crate) struct Told<'a> {
    pub(crate) observation: &'a mut [u8],
    pub(crate) reward: &'a mut f64,
    pub(crate) terminated: &'a mut bool,
    pub(crate) truncated: &'a mut bool,
}

impl Autoreset {
    pub(crate) fn named(name: &str) -> PyResult<Autoreset> {
        match name {
            "next-step" => Ok(Autoreset::NextStep),
            "same-step" => Ok(Autoreset::SameStep),
            "disabled" => Ok(Autoreset::Disabled),
            _ => Err(invalid(format_args!("there is no autoreset mode `{name}`"))),
        }
    }
}

impl Sight {
    pub(crate) fn named(name: &str, cell: u32) -> PyResult<Sight> {
        match name {
            "planes" => Ok(Sight::Planes),
            "symbols" => Ok(Sight::Symbols),
            "rgb" => Ok(Sight::Rgb(cell)),
            _ => Err(invalid(format_args!("there is no observation `{name}`"))),
        }
    }
}

impl Lane {
    /// Returns the parts from which [`Setting::restore`] restores the environment.
    pub(crate) fn saved(&self) -> SavedLane {
        let (score, outcome, status) = self.last.clone();
        let (seed, current) = (self.seed.to_string(), self.current.to_string());
        let last = (score, outcome.to_owned(), status);
        (self.root, seed, self.episodes, current, self.actions.clone(), self.is_over, last)
    }
}

impl Setting {
    /// Creates the setting of environments that play the given levels of one game on boards of the given size.
    pub(crate) fn new(
        levels: Vec<Level>,
        (columns, rows): (usize, usize),
        sight: Sight,
        max_steps: u64,
        autoreset: Autoreset,
    ) -> PyResult<Setting> {
        let Some(first) = levels.first() else { return Err(invalid("there is no level to play")) };
        let game = first.game.clone();
        if levels.iter().any(|level| level.game.0.game.digest() != game.0.game.digest()) {
            return Err(invalid("all levels of a vector environment must belong to one game"));
        }
        check_size(&levels, (columns, rows))?;
        let first_state = |level: &Level| game.0.game.start(&level.level, Seed::from_text(UNSEEDED));
        let roots: Vec<engine::State> = levels.iter().map(first_state).collect();
        if let Sight::Rgb(cell) = sight {
            for root in &roots {
                picture::pixels(&game.0.looks, root, cell).map_err(invalid)?;
            }
        }
        let planes = Planes::new(&game.0.game, game.0.looks.shown(), columns, rows);
        let characters = characters(&game.0, &planes);
        if sight == Sight::Symbols && characters.is_none() {
            return Err(invalid("the game has more sprite types than there are ASCII characters"));
        }
        let (characters, status) = (characters.unwrap_or_default(), Status::of(&game.0));
        Ok(Setting {
            game,
            levels,
            roots,
            planes,
            status,
            columns,
            rows,
            sight,
            characters,
            max_steps,
            autoreset,
        })
    }

    /// Creates the environment with the given number, before its first episode.
    pub(crate) fn lane(&self, number: usize) -> Lane {
        let root = number % self.roots.len();
        let seed = Seed::from_text(UNSEEDED).child("lane", number as u64);
        Lane {
            state: self.roots[root].clone(),
            root,
            chosen: None,
            seed,
            episodes: 0,
            current: seed,
            actions: Vec::new(),
            is_over: false,
            last: (0.0, outcome_name(Outcome::Ongoing), Vec::new()),
            drawn: Drawn::default(),
        }
    }

    /// Returns `true` if this setting has the level and the actions of a saved environment.
    pub(crate) fn fits(&self, saved: &SavedLane) -> bool {
        let known = self.rules().actions.len();
        saved.0 < self.roots.len() && saved.4.iter().all(|&action| usize::from(action) < known)
    }

    /// Restores a saved environment by replaying its episode, and draws its observation.
    pub(crate) fn restore(&self, lane: &mut Lane, saved: SavedLane, out: &mut [u8]) {
        let (root, seed, episodes, current, actions, is_over, (score, outcome, status)) = saved;
        (lane.seed, lane.episodes, lane.current) = (seed_of(&seed), episodes, seed_of(&current));
        lane.chosen = Some(root);
        self.place(lane);
        for action in actions {
            self.advance(lane, action);
        }
        lane.is_over = is_over;
        let outcome = OUTCOMES.into_iter().find(|name| *name == outcome).unwrap_or_default();
        lane.last = (score, outcome, status);
        self.draw(lane, out);
    }

    pub(crate) fn rules(&self) -> &Rules {
        &self.game.0
    }

    /// Returns the size of an observation, in bytes.
    pub(crate) fn size(&self) -> usize {
        match self.sight {
            Sight::Planes => self.planes.size(),
            Sight::Symbols => self.columns * self.rows,
            Sight::Rgb(cell) => self.columns * self.rows * (cell * cell * 3) as usize,
        }
    }

    pub(crate) fn shape(&self) -> Vec<usize> {
        match self.sight {
            Sight::Planes => vec![self.planes.types().len(), self.rows, self.columns],
            Sight::Symbols => vec![self.rows, self.columns],
            Sight::Rgb(cell) => vec![self.rows * cell as usize, self.columns * cell as usize, 3],
        }
    }

    /// Draws an observation from scratch.
    pub(crate) fn draw(&self, lane: &mut Lane, out: &mut [u8]) {
        match self.sight {
            Sight::Planes => self.planes.draw(&mut lane.state, &mut lane.drawn, out),
            Sight::Symbols => self.draw_symbols(&lane.state, out),
            Sight::Rgb(cell) => self.draw_pixels(&lane.state, cell, out),
        }
    }

    /// Draws an observation by updating the environment's previous observation.
    pub(crate) fn update(&self, lane: &mut Lane, out: &mut [u8]) {
        match self.sight {
            Sight::Planes => self.planes.update(&mut lane.state, &mut lane.drawn, out),
            _ => self.draw(lane, out),
        }
    }

    pub(crate) fn draw_symbols(&self, state: &engine::State, out: &mut [u8]) {
        out.fill(render::EMPTY as u8);
        for &(plane, character) in &self.characters {
            self.planes.visit(state, plane, |cell| out[cell] = character);
        }
    }

    pub(crate) fn draw_pixels(&self, state: &engine::State, cell: u32, out: &mut [u8]) {
        let image = picture::pixels(&self.rules().looks, state, cell).expect("the size was checked");
        let width = self.columns * cell as usize * 3;
        out.fill(0);
        for (row, line) in out.chunks_exact_mut(width).zip(image.pixels.chunks(image.width as usize)) {
            for (pixel, colour) in row.chunks_exact_mut(3).zip(line) {
                pixel.copy_from_slice(&colour.0);
            }
        }
    }

    /// Starts the next episode in an environment.
    pub(crate) fn begin(&self, lane: &mut Lane, out: &mut [u8]) {
        lane.current = lane.seed.child("episode", lane.episodes);
        lane.episodes += 1;
        self.start(lane, out);
    }

    /// Starts an episode in an environment with the environment's current seed.
    pub(crate) fn start(&self, lane: &mut Lane, out: &mut [u8]) {
        self.place(lane);
        self.draw(lane, out);
    }

    /// Puts an environment at the start of an episode. The level is drawn from the episode's seed, unless a level has
    /// been chosen.
    pub(crate) fn place(&self, lane: &mut Lane) {
        lane.root = lane.chosen.take().unwrap_or_else(|| match self.roots.len() {
            1 => 0,
            several => lane.current.child("level", 0).sampler().below(several),
        });
        lane.state.fork_from(&self.roots[lane.root], Chance::from_seed(lane.current));
        lane.actions.clear();
        lane.is_over = false;
    }

    /// Plays one tick in an environment, and records its action.
    pub(crate) fn advance(&self, lane: &mut Lane, action: u8) -> Outcome {
        lane.actions.push(action);
        let rules = self.rules();
        rules.game.step(&mut lane.state, rules.actions[usize::from(action)])
    }

    /// Writes the status of an environment's state.
    pub(crate) fn write_status(&self, lane: &Lane, out: &mut [f32]) {
        let steps_left = self.max_steps.saturating_sub(lane.actions.len() as u64);
        self.status.write(self.rules(), &lane.state, steps_left, out);
    }

    /// Returns the score, outcome and status of an environment's current episode.
    pub(crate) fn end_of(&self, lane: &Lane) -> Last {
        let mut status = vec![0.0; self.status.len()];
        self.write_status(lane, &mut status);
        (lane.state.score(), outcome_name(lane.state.outcome()), status)
    }

    /// Plays one step in an environment. Returns `true` if the step ended an episode.
    pub(crate) fn step(&self, lane: &mut Lane, action: u8, told: Told<'_>, last: Option<&mut [u8]>) -> bool {
        (*told.reward, *told.terminated, *told.truncated) = (0.0, false, false);
        if lane.is_over {
            if self.autoreset == Autoreset::NextStep {
                self.begin(lane, told.observation);
            }
            return false;
        }
        let before = lane.state.score();
        let outcome = self.advance(lane, action);
        *told.reward = lane.state.score() - before;
        *told.terminated = outcome != Outcome::Ongoing;
        *told.truncated = !*told.terminated && lane.actions.len() as u64 >= self.max_steps;
        lane.is_over = *told.terminated || *told.truncated;
        match last.filter(|_| lane.is_over) {
            Some(last) => {
                self.draw(lane, last);
                lane.last = self.end_of(lane);
                self.begin(lane, told.observation);
                true
            }
            None => {
                self.update(lane, told.observation);
                lane.is_over
            }
        }
    }
}

/// Checks that boards of the given size have room for all levels.
pub(crate) fn check_size(levels: &[Level], (columns, rows): (usize, usize)) -> PyResult<()> {
    let is_larger = |level: &&Level| level.level.columns() > columns || level.level.rows() > rows;
    match levels.iter().find(is_larger) {
        None => Ok(()),
        Some(level) => Err(invalid(format_args!(
            "size=({columns}, {rows}) is too small for {}, which has {} columns and {} rows",
            level.name,
            level.level.columns(),
            level.level.rows()
        ))),
    }
}

/// Returns the planes and their characters in drawing order, without floors. Returns `None` if a character is
/// not ASCII.
pub(crate) fn characters(rules: &Rules, planes: &Planes) -> Option<Vec<(usize, u8)>> {
    let order = rules.game.drawing_order();
    let place = |stype: engine::SpriteType| order.iter().position(|&other| other == stype.0);
    let mut shown: Vec<(Option<usize>, usize, char)> = planes
        .types()
        .iter()
        .enumerate()
        .map(|(plane, &stype)| (place(stype), plane, rules.symbols.symbol(stype)))
        .filter(|&(_, _, symbol)| symbol != render::EMPTY)
        .collect();
    shown.sort_unstable();
    shown.into_iter().map(|(_, plane, symbol)| symbol.is_ascii().then_some((plane, symbol as u8))).collect()
}
