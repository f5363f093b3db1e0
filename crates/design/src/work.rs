//! The work on one draft, from the idea to the levels.

use crate::answer;
use crate::brief::Brief;
use crate::dialogue::Dialogue;
use crate::draft::{Draft, DraftMeasures, MAX_REPAIRS, Spending, Status, digest};
use crate::known::Known;
use crate::manual;
use crate::references::{Proposal, Reference};
use crate::settings::DesignSettings;
use crate::stages::levels::{self, Verdicts};
use crate::stages::rules::{self, Rules};
use crate::stages::{Problem, Stage, idea};
use evaluation::Halt;
use evaluation::client::{ChatMessage, Role};
use std::collections::BTreeMap;
use validators::CheckedCriteria;

/// Everything on which a draft depends, apart from the designer's answers.
pub(crate) struct Context<'a> {
    pub(crate) settings: &'a DesignSettings,
    pub(crate) criteria: &'a CheckedCriteria,
    /// The games from which the draft must differ, earlier drafts included.
    pub(crate) known: &'a Known,
    /// The earlier drafts.
    pub(crate) earlier: &'a [Draft],
}

/// Writes one draft.
///
/// # Errors
/// Returns an error if an answer is missing for a reason that is not the designer's fault.
pub(crate) fn write(context: &Context<'_>, number: u64, dialogue: &mut Dialogue<'_>) -> Result<Draft, Halt> {
    let mut work = Work {
        context,
        dialogue,
        repairs: BTreeMap::new(),
        name: None,
        idea: None,
        game: GameSoFar::default(),
    };
    let end = match work.stages() {
        // The server rejected only this draft's questions, so the next draft may succeed.
        Err(Halt::Unfit(message)) => Some(message),
        end => end?,
    };
    let stage = work.repairs.last_key_value().map_or(Stage::Idea, |(stage, _)| *stage);
    let Work { repairs, name, idea, game: GameSoFar { rules, levels, measures }, .. } = work;
    let events = dialogue.journal.events();
    Ok(Draft {
        number,
        status: if end.is_none() { Status::Accepted } else { Status::GivenUp },
        stage,
        problem: end,
        name,
        idea,
        repairs,
        measures,
        spending: Spending::of(events, context.settings.price.as_ref()),
        answers: digest(events),
        rules: rules.map(|rules| rules.source),
        levels,
    })
}

/// Judges one draft by a reference designer. Such a draft has no corrections.
pub(crate) fn propose(context: &Context<'_>, number: u64, reference: Reference) -> Draft {
    let settings = context.settings;
    let mut game = GameSoFar::default();
    let judged = match reference.propose(settings.brief.levels, settings.draft_seed(number)) {
        Some(proposal) => game.accept_proposal(proposal, context),
        None => Err(Problem::plain("The designer draws no rules that compile.")),
    };
    let problem = judged.err().map(|problem| problem.summary);
    Draft {
        number,
        status: if problem.is_none() { Status::Accepted } else { Status::GivenUp },
        stage: if game.rules.is_some() { Stage::Levels } else { Stage::Rules },
        problem,
        name: Some(format!("{}-{number:04}", reference.name())),
        idea: None,
        repairs: BTreeMap::new(),
        measures: game.measures,
        spending: Spending::of(&[], None),
        answers: digest(&[]),
        rules: game.rules.map(|rules| rules.source),
        levels: game.levels,
    }
}

/// A draft under construction.
struct Work<'a, 'd> {
    context: &'a Context<'a>,
    dialogue: &'a mut Dialogue<'d>,
    repairs: BTreeMap<Stage, u32>,
    name: Option<String>,
    idea: Option<String>,
    game: GameSoFar,
}

/// The last version of the game.
#[derive(Default)]
struct GameSoFar {
    rules: Option<Rules>,
    levels: Vec<String>,
    measures: DraftMeasures,
}

impl Work<'_, '_> {
    /// Runs all stages. Returns the last problem if the draft was given up.
    fn stages(&mut self) -> Result<Option<String>, Halt> {
        let Context { settings, criteria, known, earlier } = *self.context;
        let brief = &settings.brief;
        let opening = manual::idea(brief, criteria, earlier);
        let is_idea = |text: &str| answer::idea(text).is_ok();
        let idea = match self.stage(Stage::Idea, opening, is_idea, |_, text| idea::check(text, earlier))? {
            Ok(idea) => idea,
            Err(problem) => return Ok(Some(problem.summary)),
        };
        (self.name, self.idea) = (Some(idea.name.clone()), Some(idea.text.clone()));
        let is_rules = |text: &str| answer::rules(text).is_some();
        let check = |game: &mut GameSoFar, text: &str| game.accept_rules(text, brief, known);
        if let Err(problem) = self.stage(Stage::Rules, manual::rules(brief, &idea), is_rules, check)? {
            return Ok(Some(problem.summary));
        }
        let rules = self.game.rules.as_ref().map(|rules| rules.source.clone()).unwrap_or_default();
        let opening = manual::levels(brief, criteria, &idea, &rules);
        let is_levels = |text: &str| answer::levels(text).is_some();
        let check = |game: &mut GameSoFar, text: &str| game.accept_levels(text, self.context);
        let end = stage(
            self.dialogue,
            &mut self.repairs,
            &mut self.game,
            Stage::Levels,
            opening,
            is_levels,
            check,
        )?;
        Ok(end.err().map(|problem| problem.summary))
    }

    fn stage<T>(
        &mut self,
        name: Stage,
        opening: String,
        is_usable: impl Fn(&str) -> bool,
        check: impl Fn(&mut GameSoFar, &str) -> Result<T, Problem>,
    ) -> Result<Result<T, Problem>, Halt> {
        stage(self.dialogue, &mut self.repairs, &mut self.game, name, opening, is_usable, check)
    }
}

/// Asks for an answer until `check` accepts it, or until no corrections are left.
fn stage<T>(
    dialogue: &mut Dialogue<'_>,
    repairs: &mut BTreeMap<Stage, u32>,
    game: &mut GameSoFar,
    stage: Stage,
    opening: String,
    is_usable: impl Fn(&str) -> bool,
    check: impl Fn(&mut GameSoFar, &str) -> Result<T, Problem>,
) -> Result<Result<T, Problem>, Halt> {
    let mut messages = vec![message(Role::System, manual::SYSTEM.to_owned()), message(Role::User, opening)];
    let mut attempt = 0;
    loop {
        repairs.insert(stage, attempt);
        let reply = dialogue.ask(stage, attempt, &messages, &is_usable)?;
        let problem = match check(game, &reply.text) {
            Ok(accepted) => return Ok(Ok(accepted)),
            Err(problem) => problem,
        };
        if attempt == MAX_REPAIRS {
            return Ok(Err(problem));
        }
        messages.push(message(Role::Assistant, reply.text));
        messages.push(message(Role::User, problem.message(MAX_REPAIRS - attempt)));
        attempt += 1;
    }
}

impl GameSoFar {
    fn accept_rules(&mut self, text: &str, brief: &Brief, known: &Known) -> Result<(), Problem> {
        let missing = "The answer contains no block with rules, ```` ```vgdl ````.";
        let source = answer::rules(text).ok_or_else(|| Problem::plain(missing))?;
        self.accept_source(&source, brief, known)
    }

    fn accept_source(&mut self, source: &str, brief: &Brief, known: &Known) -> Result<(), Problem> {
        let compiled = rules::compile(source, known)?;
        let nearest = compiled.nearest.clone();
        self.measures = DraftMeasures { compiles: true, nearest, ..DraftMeasures::default() };
        self.levels.clear();
        let checked = rules::check(&compiled, brief);
        self.rules = Some(compiled);
        checked
    }

    fn accept_levels(&mut self, text: &str, context: &Context<'_>) -> Result<(), Problem> {
        let missing = "The answer contains no block with a level, ```` ```level ````.";
        let answered = answer::levels(text).ok_or_else(|| Problem::plain(missing))?;
        if answered.rules.is_some() {
            self.accept_rules(text, &context.settings.brief, context.known)?;
        }
        self.accept_boards(answered.levels, context)
    }

    fn accept_boards(&mut self, texts: Vec<String>, context: &Context<'_>) -> Result<(), Problem> {
        let brief = &context.settings.brief;
        let rules = self.rules.as_ref().expect("the rules were accepted before");
        let loaded = levels::load(texts, rules, brief)?;
        let Verdicts { won, criteria, tier, problem } =
            levels::judge(rules, &loaded, brief, context.criteria);
        self.levels = loaded.texts;
        self.measures = DraftMeasures { loads: true, won, criteria, tier, ..self.measures.clone() };
        problem.map_or(Ok(()), Err)
    }

    /// Judges a reference designer's proposal. Levels are judged even if the rules are not new, because a reference
    /// designer's score counts each step separately.
    fn accept_proposal(&mut self, proposal: Proposal, context: &Context<'_>) -> Result<(), Problem> {
        let checked = self.accept_source(&proposal.rules, &context.settings.brief, context.known);
        if self.rules.is_none() {
            return checked;
        }
        let judged = self.accept_boards(proposal.levels, context);
        checked.and(judged)
    }
}

fn message(role: Role, text: String) -> ChatMessage {
    ChatMessage { role, text, image: None }
}
