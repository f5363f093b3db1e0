//! Prompts: the conversations sent to language models.
//!
//! The static part comes first. It consists of the rules, the legend, the actions and the answer format, and
//! is byte-identical in all turns of all levels of a game. The observation follows. The texts are in
//! `templates/`, and [`Prompter::digest`] covers the texts and the settings.
//! [`docs/reference/prompts.md`](../../../../docs/reference/prompts.md) shows an example, part by part.

mod discover;
mod history;
mod limit;
mod sections;
mod settings;
mod turn;

pub(crate) use discover::kinds_at_start;
pub use history::{Attempt, Past};
pub(crate) use limit::limited;
pub use sections::{TASK, sections};
pub use settings::{Encodings, Mode, PromptSettings, PromptStyle, Rules};

use crate::answer::{self, Format, Reading};
use crate::client::{ChatMessage, Role};
use crate::commitment::Commitment;
use crate::encoding;
use crate::error::EvaluationError;
use crate::legend::{Legend, LegendOptions};
use crate::mask::{Mask, without_pictures};
use crate::metrics::EndCause;
use crate::subject::{Subject, SubjectLevel};
use crate::thought::AnswerLimit;
use crate::tokens;
use crate::turn::{Turn, is_of_use};
use base::{Digest, Seed};
use engine::analysis::Avatar;
use engine::describe::{self, Guide};
use engine::syntax::print_bare;
use engine::{Action, Analysis, Outcome};
use minijinja::Environment;
use minijinja::syntax::SyntaxConfig;
use minijinja::value::{Serde, Value};
use render::Style;
use serde::Serialize;
use std::collections::BTreeMap;

/// The version of the templates and the English rules. It is incremented whenever their wording changes, so
/// that results with different prompts are easy to tell apart.
pub const VERSION: u32 = 12;

const TEMPLATES: [(&str, &str); 7] = [
    ("standard_static.j2", include_str!("templates/standard_static.j2")),
    ("standard_turn.j2", include_str!("templates/standard_turn.j2")),
    ("reference_static.j2", include_str!("templates/reference_static.j2")),
    ("reference_turn.j2", include_str!("templates/reference_turn.j2")),
    ("ending.j2", include_str!("templates/ending.j2")),
    ("complaint.j2", include_str!("templates/complaint.j2")),
    ("limit.j2", include_str!("templates/limit.j2")),
];

/// The templates for [`PromptStyle::Discover`]. They are not in the shared list, because the digests of the
/// other styles cover every template in that list.
const DISCOVER: [(&str, &str); 4] = [
    ("discover_static.j2", include_str!("templates/discover_static.j2")),
    ("discover_turn.j2", include_str!("templates/discover_turn.j2")),
    ("discover_question.j2", include_str!("templates/discover_question.j2")),
    ("discover_complaint.j2", include_str!("templates/discover_complaint.j2")),
];

/// The actions, in the order of their numbers in the reference's prompts.
const NUMBERED: [Action; 6] =
    [Action::Nil, Action::Use, Action::Left, Action::Right, Action::Down, Action::Up];

/// A writer of prompts for one game.
#[derive(Debug)]
pub struct Prompter {
    settings: PromptSettings,
    commit: Commitment,
    environment: Environment<'static>,
    legend: Legend,
    mask: Option<Mask>,
    /// The actions available in any avatar state, in prompt order.
    actions: Vec<Action>,
    /// `true` if the game has resources that the avatar can hold.
    holding: bool,
    /// The highest possible score on each level, by level number. Levels without a proved limit are missing.
    most_points: BTreeMap<usize, i64>,
    /// The limit on each answer's length, if any.
    answer_limit: Option<AnswerLimit>,
    static_part: String,
    static_tokens: Vec<PartTokens>,
}

/// The token count of one part of a prompt.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PartTokens {
    /// The heading of the section, or [`TASK`] for the text before the first heading.
    pub part: String,
    /// The number of tokens in the section, as counted by [`tokens::count`].
    pub tokens: u64,
}

/// The token counts of a prompt's parts.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PromptTokens {
    /// The token counts of the static part, by section.
    pub fixed: Vec<PartTokens>,
    /// The token counts of the current turn, by section. Image tokens are estimated.
    pub turn: Vec<PartTokens>,
    /// The number of tokens in earlier turns, and in this turn's earlier answers.
    pub history: u64,
    /// The total number of tokens, including the overhead per message.
    pub total: u64,
}

impl PromptTokens {
    /// Returns the number of tokens in the static part.
    pub fn fixed(&self) -> u64 {
        self.fixed.iter().map(|part| part.tokens).sum()
    }

    /// Returns the number of tokens in the current turn.
    pub fn turn(&self) -> u64 {
        self.turn.iter().map(|part| part.tokens).sum()
    }
}

/// A prompt for a language model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Prompt {
    /// The messages of the conversation.
    pub messages: Vec<ChatMessage>,
    /// The text of the newest turn, to be passed to [`Past::new`] when the turn is over.
    pub shown: String,
    /// The number of turns that were dropped. The oldest turns are dropped first.
    pub left_out: usize,
    /// The prompt's token counts.
    pub tokens: PromptTokens,
}

impl Prompter {
    /// Prepares a game's prompts, with one action per decision and without a step limit.
    ///
    /// # Errors
    /// Returns an error if the settings are out of range, or if the game's names cannot be masked.
    pub fn new(subject: &Subject, settings: PromptSettings) -> Result<Prompter, EvaluationError> {
        Prompter::within(subject, settings, u64::MAX, Commitment::ONE)
    }

    /// Prepares the prompts for a game whose episodes have at most `limit` actions. The rules in the prompts mention no
    /// later tick, and the prompts request the number of actions that the player commits to at each decision.
    ///
    /// # Errors
    /// Returns an error if the settings are out of range, if the reference's style is combined with several actions per
    /// decision, or if the game's names cannot be masked.
    pub fn within(
        subject: &Subject,
        settings: PromptSettings,
        limit: u64,
        commit: Commitment,
    ) -> Result<Prompter, EvaluationError> {
        if settings.style == PromptStyle::Reference && !commit.is_one() {
            let message = "the reference's prompts ask for one action; a commitment to several needs the standard style";
            return Err(EvaluationError::Malformed(message.to_owned()));
        }
        let cell = settings.encodings.image_cell;
        if !(render::MIN_CELL..=40).contains(&cell) {
            let message = format!("`image_cell` is {cell}, but must be from 4 to 40 pixels");
            return Err(EvaluationError::Malformed(message));
        }
        if settings.style == PromptStyle::Discover && !commit.is_one() {
            let message = "the prompts of `discover` report what each action does: they ask for one action \
                           at a time; leave out --commit";
            return Err(EvaluationError::Malformed(message.to_owned()));
        }
        let is_neutral = settings.neutral_names || settings.style == PromptStyle::Discover;
        let mask = match settings.masked_names {
            _ if is_neutral => Some(Mask::neutral(&subject.game)),
            true => Some(Mask::of(&subject.game)?),
            false => None,
        };
        let masked = mask.as_ref().map(|mask| Analysis::of(&mask.game));
        let analysis = masked.as_ref().unwrap_or(&subject.analysis);
        // A game's characters can reveal as much as its names.
        let neutral = is_neutral.then(|| Mask::neutral_characters(&subject.game));
        let shuffled = settings.shuffled_symbols.or(neutral).or(settings.masked_names.then_some(0));
        let options = LegendOptions { tracking: settings.identity_tracking, shuffled };
        let legend = Legend::new(analysis, &options);
        let order = match settings.style {
            PromptStyle::Standard | PromptStyle::Discover => Action::ALL,
            PromptStyle::Reference => NUMBERED,
        };
        let actions: Vec<Action> = order.into_iter().filter(|&action| is_of_use(analysis, action)).collect();
        let mut prompter = Prompter {
            environment: environment(),
            legend,
            mask,
            actions,
            holding: !analysis.resources().is_empty(),
            most_points: most_points(subject),
            answer_limit: None,
            static_part: String::new(),
            static_tokens: Vec::new(),
            commit,
            settings,
        };
        prompter.static_part = prompter.write_static(analysis, limit);
        prompter.static_tokens = by_section(&prompter.static_part);
        Ok(prompter)
    }

    /// States a limit on each answer's length at the end of the static part. The player enforces the limit.
    #[must_use]
    pub fn with_answer_limit(mut self, limit: Option<AnswerLimit>) -> Prompter {
        let Some(limit) = limit else { return self };
        let (is_in_words, most) = (matches!(limit, AnswerLimit::Words(_)), limit.most());
        let limited = data(serde_json::json!({ "is_in_words": is_in_words, "most": most }));
        let sentences = self.render("limit.j2", limited);
        self.static_part = format!("{}\n{}", self.static_part, sentences.trim_end());
        self.static_tokens = by_section(&self.static_part);
        self.answer_limit = Some(limit);
        self
    }

    /// Returns the limit on each answer's length, if any.
    pub fn answer_limit(&self) -> Option<AnswerLimit> {
        self.answer_limit
    }

    /// Returns the prompt settings.
    pub fn settings(&self) -> &PromptSettings {
        &self.settings
    }

    /// Returns the legend (the table of the board's characters).
    pub fn legend(&self) -> &Legend {
        &self.legend
    }

    /// Returns the actions in prompt order. In the reference style, the order determines their numbers.
    pub fn actions(&self) -> &[Action] {
        &self.actions
    }

    /// Returns the byte-identical beginning shared by all of the game's prompts.
    pub fn static_part(&self) -> &str {
        &self.static_part
    }

    /// Returns a BLAKE3 digest of [`VERSION`], all templates, the settings, the number of actions per decision and the
    /// limit on answers. If two runs of the same game have the same digest, [`engine::SEMANTICS`] and step limit, they
    /// have the same prompts.
    pub fn digest(&self) -> Digest {
        let settings = serde_json::to_string(&self.settings).expect("plain data");
        let mut hasher = blake3::Hasher::new_derive_key("infinite-arcade 1 prompts");
        hasher.update(&VERSION.to_le_bytes());
        let own: &[_] = if self.settings.style == PromptStyle::Discover { &DISCOVER } else { &[] };
        let texts = TEMPLATES.iter().chain(own).flat_map(|(name, text)| [*name, *text]);
        for text in texts.chain([settings.as_str()]) {
            hasher.update(&(text.len() as u64).to_le_bytes()).update(text.as_bytes());
        }
        if let Some(commit) = self.commit.aid() {
            hasher.update(commit.as_bytes());
        }
        if let Some(limit) = self.answer_limit {
            hasher.update(format!("{limit:?}").as_bytes());
        }
        Digest::from_bytes(*hasher.finalize().as_bytes())
    }

    /// Returns the conversation at a turn. `past` contains all previous turns of the episode, which are
    /// omitted in zero-shot mode. `attempts` contains this turn's unusable answers, with the messages about
    /// them. Images are shown only for the newest turn. If a prompt exceeds the budget, entire turns are
    /// dropped, but never the newest turn.
    pub fn prompt(&self, turn: &Turn<'_>, past: &[Past], attempts: &[Attempt]) -> Prompt {
        self.conversation(self.write_turn(turn, past), self.picture(turn), past, attempts)
    }

    /// Returns a conversation that ends with the given user message.
    fn conversation(
        &self,
        shown: String,
        picture: Option<encoding::Picture>,
        past: &[Past],
        attempts: &[Attempt],
    ) -> Prompt {
        let picture_tokens =
            picture.as_ref().map(|picture| tokens::of_picture(picture.width, picture.height));
        let mut turn_tokens = by_section(&shown);
        turn_tokens.extend(picture_tokens.map(|tokens| PartTokens { part: "Picture".to_owned(), tokens }));
        let attempts = history::kept(attempts);
        let past = if self.settings.mode == Mode::ZeroShot { &[] } else { past };
        let fixed = history::cost(&self.static_part);
        let again = history::answer_tokens(&attempts);
        let now = history::cost(&shown) + picture_tokens.unwrap_or(0) + again;
        let left_out = history::first_kept(past, fixed, now, self.settings.history_tokens);
        let mut messages = Vec::new();
        // The reference's zero-shot prompt consists of a single message.
        let single = self.settings.style == PromptStyle::Reference && self.settings.mode == Mode::ZeroShot;
        if !single {
            messages.push(message(Role::System, &self.static_part));
        }
        for turn in &past[left_out..] {
            messages.push(message(Role::User, &turn.shown));
            push_messages(&mut messages, &turn.attempts);
        }
        let text = if single { format!("{}\n\n{shown}", self.static_part) } else { shown.clone() };
        messages.push(ChatMessage { role: Role::User, text, image: picture.map(|picture| picture.png) });
        push_messages(&mut messages, &attempts);
        let before: u64 = past[left_out..].iter().map(|turn| turn.tokens).sum();
        let tokens = PromptTokens {
            fixed: self.static_tokens.clone(),
            turn: turn_tokens,
            history: before + again,
            total: fixed + before + now,
        };
        Prompt { messages, shown, left_out, tokens }
    }

    /// Returns the message about an unusable answer. `why` is a clause whose subject is the answer, such as
    /// the reason in [`Reading::Invalid`].
    pub fn complaint(&self, why: &str) -> String {
        self.render(
            "complaint.j2",
            data(serde_json::json!({
                "why": why,
                "style": match self.settings.style {
                    PromptStyle::Discover => PromptStyle::Standard,
                    style => style,
                },
                "commit": self.commit_data(),
                "actions": self.words(),
            })),
        )
    }

    /// Returns an episode's last message, with the outcome, the rules that ended the game, the score and the final
    /// state. `last` contains the final observation. No answer is expected, so the message is not sent to language models.
    pub fn ending(&self, last: &Turn<'_>) -> String {
        let outcome = match last.observation.outcome {
            Outcome::Won => "won",
            Outcome::Lost => "lost",
            Outcome::Ended => "ended",
            Outcome::Ongoing => "ongoing",
            Outcome::Stopped(_) => "stopped",
        };
        let end = self.render(
            "ending.j2",
            data(serde_json::json!({
                "causes": self.causes(last),
                "outcome": outcome,
                "limit": last.limit,
                "steps": last.number,
                "score": last.observation.score.to_string(),
            })),
        );
        format!("{}\n\n{}", end.trim_end(), self.write_turn(last, &[]))
    }

    /// Returns the sentences about the rules that ended the game. Prompts without rules do not reveal them.
    fn causes(&self, last: &Turn<'_>) -> Vec<String> {
        let Some(EndCause { termination, interaction }) = last.cause else { return Vec::new() };
        if self.settings.rules == Rules::None {
            return Vec::new();
        }
        let masked = self.mask.as_ref().map(|mask| Analysis::of(&mask.game));
        let analysis = masked.as_ref().unwrap_or(&last.subject.analysis);
        let is_won = last.observation.outcome == Outcome::Won;
        let ended = termination.and_then(|line| describe::termination(analysis, line, is_won));
        let before = interaction.map(|line| describe::interaction(analysis, line)).unwrap_or_default();
        ended.into_iter().chain(before).collect()
    }

    /// Reads a turn's answer: one action, or a plan with as many actions as are due.
    pub fn read(&self, answer: &str, turn: &Turn<'_>) -> Reading<Vec<Action>> {
        if !self.commit.is_one() {
            return answer::read_plan(answer, turn.due(), &self.actions);
        }
        let format = match self.settings.style {
            PromptStyle::Standard | PromptStyle::Discover => Format::Word,
            PromptStyle::Reference => Format::Number,
        };
        answer::read(answer, format, &self.actions, turn.actions).map(|action| vec![action])
    }

    /// Returns the number of actions per decision for use in templates: `None` for one action, and otherwise a number
    /// or `all`.
    fn commit_data(&self) -> Option<String> {
        (!self.commit.is_one()).then(|| self.commit.to_string())
    }

    fn template(&self, [standard, reference, discover]: [&'static str; 3]) -> &'static str {
        match self.settings.style {
            PromptStyle::Standard => standard,
            PromptStyle::Reference => reference,
            PromptStyle::Discover => discover,
        }
    }

    fn words(&self) -> Vec<String> {
        self.actions.iter().map(ToString::to_string).collect()
    }

    fn write_static(&self, analysis: &Analysis, limit: u64) -> String {
        let guide = limited(Guide::from_analysis(analysis), limit);
        let (described, vgdl) = match self.settings.rules {
            Rules::Described => (true, None),
            Rules::Vgdl => (false, Some(print_bare(&without_pictures(analysis.game().description())))),
            Rules::None => (false, None),
        };
        let text = self.render(
            self.template(["standard_static.j2", "reference_static.j2", "discover_static.j2"]),
            data(serde_json::json!({
            "settings": self.settings,
            "commit": self.commit_data(),
            "described": described,
            "vgdl": vgdl,
            "winning": guide.winning,
            "losing": guide.losing,
            "order": guide.order,
            "sprites": guide.sprites,
            "groups": guide.groups,
            "clockwork": guide.timed_effects,
            "meetings": guide.meetings,
            "controls": guide.controls,
            "legend": self.legend_lines(),
            "actions": self.words(),
            "varying": self.actions.iter().any(|&action| !is_always_there(analysis, action)),
            })),
        );
        text.trim_end().to_owned()
    }

    fn write_turn(&self, turn: &Turn<'_>, past: &[Past]) -> String {
        let template = self.template(["standard_turn.j2", "reference_turn.j2", "discover_turn.j2"]);
        let mask = |seen| self.mask.as_ref().map(|mask| mask.observation(seen));
        let seen = mask(turn.observation);
        let before = turn.before.as_ref().and_then(|before| mask(before.observation));
        let previous = turn.series.and_then(|series| series.previous).map(|end| self.told_end(end));
        let most_points = self.most_points.get(&turn.level).copied();
        let view = turn::View {
            previous,
            most_points: most_points.filter(|_| self.settings.rules != Rules::None),
            legend: &self.legend,
            settings: &self.settings,
            actions: &self.actions,
            holding: self.holding,
            turn,
            now: seen.as_ref().unwrap_or(turn.observation),
            before: turn.before.as_ref().map(|own| before.as_ref().unwrap_or(own.observation)),
            recent: past.iter().rev().take(3).rev().map(|turn| turn.played).collect(),
        };
        let text = self.render(template, data(view.data()));
        text.trim_end().to_owned()
    }

    fn picture(&self, turn: &Turn<'_>) -> Option<encoding::Picture> {
        if !self.settings.encodings.image {
            return None;
        }
        let masked = self.mask.as_ref().map(|mask| mask.observation(turn.observation));
        let seen = masked.as_ref().unwrap_or(turn.observation);
        let cell = Style::cell_for(seen.columns as u32, seen.rows as u32);
        let cell = cell.min(self.settings.encodings.image_cell);
        Some(
            encoding::picture(seen, &self.legend, cell)
                .expect("boards have fewer cells than pictures pixels"),
        )
    }

    fn render(&self, template: &str, data: Value) -> String {
        let template = self.environment.get_template(template).expect("the template exists");
        template.render(data).expect("the templates are ours, and a test writes with each")
    }
}

/// Returns the highest possible score on each level whose rules limit it, by level number.
fn most_points(subject: &Subject) -> BTreeMap<usize, i64> {
    let most = |level: &SubjectLevel| {
        let start = subject.game.start(&level.level, Seed::from_text("start"));
        Some((level.number, subject.analysis.most_points(&start)?))
    };
    subject.levels.iter().filter_map(most).collect()
}

/// Returns `true` if an action is available in every avatar state.
fn is_always_there(analysis: &Analysis, action: Action) -> bool {
    let offers = |avatar: &Avatar| analysis.game().actions_of(avatar.stype).contains(&action);
    action == Action::Nil || analysis.avatars().iter().all(offers)
}

fn data(data: serde_json::Value) -> Value {
    Value::from(Serde(data))
}

fn environment() -> Environment<'static> {
    let mut environment = Environment::new();
    let syntax = SyntaxConfig::builder().trim_blocks(true).lstrip_blocks(true).build();
    environment.set_syntax(syntax.expect("the delimiters are the usual ones"));
    for (name, text) in TEMPLATES.into_iter().chain(DISCOVER) {
        environment.add_template(name, text).expect("the templates are ours");
    }
    environment
}

fn by_section(text: &str) -> Vec<PartTokens> {
    let part = |(heading, body): (&str, &str)| {
        let heading_tokens = if heading == TASK { 0 } else { tokens::count(&format!("## {heading}\n")) };
        PartTokens { part: heading.to_owned(), tokens: heading_tokens + tokens::count(body) }
    };
    sections(text).into_iter().map(part).collect()
}

fn message(role: Role, text: &str) -> ChatMessage {
    ChatMessage { role, text: text.to_owned(), image: None }
}

/// Appends answers to a conversation, each followed by the message about it.
fn push_messages(messages: &mut Vec<ChatMessage>, attempts: &[Attempt]) {
    for attempt in attempts {
        messages.push(message(Role::Assistant, &attempt.answer));
        messages.extend(attempt.complaint.as_ref().map(|complaint| message(Role::User, complaint)));
    }
}
