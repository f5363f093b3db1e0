//! Semantic lints: valid rules that are almost certainly mistakes, according to the rule analysis. Mistakes
//! that are visible in the text alone are reported by the parser and the compiler.

mod swapped;
mod terminations;
mod walls;

pub use swapped::{SwappedRule, swapped_rule};
pub(crate) use terminations::over_at_start;
pub(crate) use walls::open_border;

use crate::analysis::{Analysis, EffectSummary, Encounter, Motion, Precondition};
use crate::diagnostic::{Diagnostic, Diagnostics, Span};
use crate::game::Game;
use crate::rules::SpriteType;
use crate::rules::class::SpriteClass;
use crate::rules::effects::{Displacement, EffectFamily};
use crate::syntax::Param;

impl Game {
    /// Returns the warnings: parts of the file that are valid but almost certainly unintended, sorted by
    /// position. The result is empty for games loaded in reference mode.
    ///
    /// Cost: the first call analyses the rules ([`Analysis::of`](crate::Analysis::of)).
    pub fn warnings(&self) -> &[Diagnostic] {
        self.0.all_warnings.get_or_init(|| {
            let meant = if self.0.as_reference { Vec::new() } else { lint(self) };
            Diagnostics::sorted(self.0.warnings.iter().cloned().chain(meant).collect()).0
        })
    }
}

/// Returns all warnings about a game's semantics, in no particular order. Cost: one call to [`Analysis::of`].
fn lint(game: &Game) -> Vec<Diagnostic> {
    let linter = Linter { game, analysis: &Analysis::of(game) };
    let mut problems = Vec::new();
    linter.rules_that_never_fire(&mut problems);
    linter.terminations(&mut problems);
    linter.unreachable_outcomes(&mut problems);
    linter.swapped_barriers(&mut problems);
    linter.hidden_sprites(&mut problems);
    linter.ignored_parameters(&mut problems);
    linter.avatar_drawn_first(&mut problems);
    linter.open_walls(&mut problems);
    problems
}

struct Linter<'a> {
    game: &'a Game,
    analysis: &'a Analysis,
}

impl Linter<'_> {
    /// Reports interactions whose sprites never collide, or that require more of a resource than any sprite
    /// can hold.
    fn rules_that_never_fire(&self, problems: &mut Vec<Diagnostic>) {
        let lines = &self.game.description().interactions;
        for (number, line) in lines.iter().enumerate() {
            let own: Vec<&Encounter> =
                self.analysis.encounters().iter().filter(|encounter| encounter.line == number).collect();
            let Some(reasons) =
                own.iter().map(|encounter| self.never_fires_reason(encounter)).collect::<Option<Vec<_>>>()
            else {
                continue;
            };
            // Types that never occur have their own warning.
            let Some(reason) = reasons.into_iter().find(|reason| !reason.is_empty()) else { continue };
            let span = Span::new(line.first.span.start, line.effect.span.end);
            let message = format!("this rule never fires: {reason}");
            let problem = Diagnostic::warning("never-fires", span, message);
            problems.push(problem.help("remove the rule, or make its condition possible"));
        }
    }

    /// Reports interactions that move back a motionless sprite, if nothing else stops the avatar that walks
    /// into it.
    fn swapped_barriers(&self, problems: &mut Vec<Diagnostic>) {
        let encounters = self.analysis.encounters();
        for (number, line) in self.game.description().interactions.iter().enumerate() {
            if line.effect.text != "stepBack" {
                continue;
            }
            let walks_through = |encounter: &&Encounter| {
                let still = self.tree(encounter.first);
                let Some(avatar) = encounter.second.filter(|_| !still.is_empty()) else { return false };
                let plays = |stype: &SpriteType| self.game.class(*stype).is_some_and(SpriteClass::is_avatar);
                let avatars = self.tree(avatar);
                // Any other effect on an avatar in this pair of types is assumed to be intended.
                let meets = |other: &Encounter| {
                    let avatar = avatars.iter().any(|&stype| self.analysis.applies(other.first, stype));
                    let second =
                        |stype| other.second.is_some_and(|other| self.analysis.applies(other, stype));
                    avatar && still.iter().any(|&stype| second(stype))
                };
                !still.iter().any(|&stype| self.roams(stype) || plays(&stype))
                    && !avatars.is_empty()
                    && avatars.iter().all(plays)
                    && !encounters.iter().any(meets)
            };
            let mut own = encounters.iter().filter(|encounter| encounter.line == number);
            let Some(avatar) = own.find(walks_through).and_then(|encounter| encounter.second) else {
                continue;
            };
            let span = Span::new(line.first.span.start, line.effect.span.end);
            if problems.iter().any(|problem| problem.span == span) {
                continue;
            }
            let (first, avatar) = (&line.first.text, self.game.name(avatar));
            let others = line.second.iter().map(|word| word.text.as_str()).filter(|name| *name != avatar);
            let partners: Vec<&str> = [first.as_str()].into_iter().chain(others).collect();
            let message = format!(
                "`{first}` does not move, so this rule never moves it back, and nothing stops `{avatar}` there"
            );
            let problem = Diagnostic::warning("swapped-rule", span, message);
            let meant = format!("{avatar} {} > stepBack", partners.join(" "));
            problems.push(problem.help(format!("did you mean `{meant}`?")).replace(span, &meant));
        }
    }

    /// Returns the reason why an interaction never happens, or `None` if the interaction may happen. The
    /// reason is empty if one of the interaction's two types never occurs.
    fn never_fires_reason(&self, encounter: &Encounter) -> Option<String> {
        let name = |stype: SpriteType| self.game.name(stype);
        let first = self.tree(encounter.first);
        let second = encounter.second.map(|second| self.tree(second));
        if first.is_empty() || second.as_ref().is_some_and(Vec::is_empty) {
            return Some(String::new());
        }
        if let Precondition::Holds(_, resource, amount) = encounter.precondition
            && amount > 0
            && !self.gained(resource)
        {
            return Some(format!("it needs {amount} `{}`, but no rule gives any", name(resource)));
        }
        let (second, other) = (second?, encounter.second?);
        if first.iter().any(|&stype| self.roams(stype)) || second.iter().any(|&stype| self.roams(stype)) {
            return None;
        }
        let together = |one: SpriteType, two: SpriteType| {
            self.analysis.facts(one).symbols.iter().any(|&symbol| {
                let places = self.game.places(symbol);
                let count = |stype| places.iter().filter(|&&placed| placed == stype).count();
                if one == two { count(one) > 1 } else { count(one) > 0 && count(two) > 0 }
            })
        };
        let meet = first.iter().any(|&one| second.iter().any(|&two| together(one, two)));
        (!meet).then(|| {
            format!(
                "neither `{}` nor `{}` ever moves, and no character places both",
                name(encounter.first),
                name(other)
            )
        })
    }

    /// Returns the types to which a rule on `written` applies, without types that can never be on the board.
    fn tree(&self, written: SpriteType) -> Vec<SpriteType> {
        let types = self.game.sprite_types();
        types
            .filter(|&stype| self.analysis.applies(written, stype) && self.analysis.facts(stype).possible)
            .collect()
    }

    /// Returns `true` if sprites of the type can reach cells in which no level places them.
    fn roams(&self, stype: SpriteType) -> bool {
        let facts = self.analysis.facts(stype);
        let info = &self.game.0.types[stype.index()];
        let made = |effect: &EffectSummary| effect.makes().contains(&stype);
        let copied = |effect: &EffectSummary| matches!(effect, EffectSummary::Clone | EffectSummary::Undo(_));
        let moves = |encounter: &Encounter| {
            let displacement = self.game.0.effects[usize::from(encounter.effect)].summary.displacement;
            encounter.does(copied) || displacement.is_some_and(|to| to != Displacement::Back)
        };
        // Avatars that the player cannot control are reported elsewhere.
        facts.motion != Motion::Still
            || info.class.is_some_and(SpriteClass::is_avatar)
            || info.given_speed
            || info.traits.continuous
            || info.traits.width_factor != 1.0
            || info.traits.height_factor != 1.0
            || self.game.sprite_types().any(|maker| self.analysis.facts(maker).makes.contains(&stype))
            || !self.game.0.timed.is_empty()
            || self.analysis.encounters().iter().any(|encounter| {
                encounter.does(made) || self.analysis.applies(encounter.first, stype) && moves(encounter)
            })
    }

    /// Returns `true` if a sprite can gain more of a resource.
    fn gained(&self, resource: SpriteType) -> bool {
        let gains = |effect: &EffectSummary| matches!(effect, EffectSummary::Change { resource: other, by, .. } if *other == resource && *by > 0);
        self.analysis.encounters().iter().any(|encounter| {
            let collects = encounter.effects.contains(&EffectSummary::Collect);
            collects && self.analysis.applies(encounter.first, resource)
        }) || self.analysis.any_effect(gains)
    }

    /// Reports sprites that take part in rules but are drawn beneath scenery, which takes part in no rules.
    fn hidden_sprites(&self, problems: &mut Vec<Diagnostic>) {
        let rules = &self.game.0;
        let acts = |stype: SpriteType| {
            let timed = !rules.timed.is_empty();
            let takes_part = |encounter: &Encounter| {
                self.analysis.applies(encounter.first, stype)
                    || encounter.second.is_some_and(|second| self.analysis.applies(second, stype))
            };
            timed || self.analysis.encounters().iter().any(takes_part)
        };
        for line in &self.game.description().mapping {
            let Ok(symbol) = u8::try_from(line.symbol) else { continue };
            let places = self.game.places(symbol);
            let order = |stype: SpriteType| rules.types[stype.index()].order;
            for (&below, word) in places.iter().zip(&line.names) {
                let covers = |&&above: &&SpriteType| {
                    let traits = &rules.types[above.index()].traits;
                    order(above) > order(below) && !traits.hidden && !traits.invisible && !acts(above)
                };
                let traits = &rules.types[below.index()].traits;
                let seen = traits.hidden || traits.invisible || order(below).is_none();
                let Some(&above) = places.iter().find(covers).filter(|_| !seen && acts(below)) else {
                    continue;
                };
                let (above, below) = (self.game.name(above), self.game.name(below));
                let message =
                    format!("`{below}` is hidden: `{above}`, which no rule mentions, is drawn over it");
                let problem = Diagnostic::warning("hidden-sprite", word.span, message);
                problems.push(problem.help(format!("declare `{above}` before `{below}` in the SpriteSet")));
            }
        }
    }

    /// Reports an avatar type that is drawn before all other types. The reference does not search that type
    /// for the player's avatar.
    fn avatar_drawn_first(&self, problems: &mut Vec<Diagnostic>) {
        let Some(&first) = self.game.0.order.first() else { return };
        if self.game.class(first).is_some_and(SpriteClass::is_avatar) {
            let name = self.game.name(first);
            let lines = self.game.description().sprite_lines();
            let Some((_, line)) = lines.iter().find(|(_, line)| line.name.text == name) else { return };
            let message = format!(
                "`{name}` is declared before every other sprite, `wall` included, so the player cannot control it"
            );
            let problem = Diagnostic::warning("lost-avatar", line.name.span, message);
            problems.push(problem.help(format!("declare another sprite, such as `wall`, before `{name}`")));
        }
    }

    /// Reports parameters that are ignored by every class that accepts them.
    fn ignored_parameters(&self, problems: &mut Vec<Diagnostic>) {
        let mut found: Vec<(&Param, bool, String)> = Vec::new();
        for (_, line) in self.game.description().sprite_lines() {
            let Some(stype) = self.game.sprite_type(&line.name.text) else { continue };
            // If the line declares a parent type, some of the subtypes may use the parameter.
            let heirs: Vec<SpriteType> = self
                .game
                .sprite_types()
                .filter(|&heir| {
                    let info = &self.game.0.types[heir.index()];
                    info.leaf && info.path.contains(&stype)
                })
                .collect();
            for param in &line.params {
                let taken = heirs.iter().any(|&heir| self.looks_at(heir, &param.key.text));
                found.push((param, taken, line.name.text.clone()));
            }
        }
        for (param, taken, name) in found {
            if !taken {
                let key = &param.key.text;
                let message = match key.as_str() {
                    "jump_strength" => format!("`{name}` does not jump: `{key}` does nothing"),
                    _ => format!("`{name}` has grid physics: `{key}` does nothing"),
                };
                let problem = Diagnostic::warning("ignored-parameter", param.span(), message);
                problems.push(problem.help(match key.as_str() {
                    "jump_strength" => "remove the parameter, or choose a class that jumps",
                    _ => "remove the parameter, or add `physicstype=CONT`",
                }));
            }
        }
    }

    /// Returns `true` if the parameter changes the behaviour of the type's sprites.
    fn looks_at(&self, stype: SpriteType, key: &str) -> bool {
        use SpriteClass as C;
        let info = &self.game.0.types[stype.index()];
        let Some(class) = info.class else { return true };
        // Walls slow sprites down to the speed of gravity, regardless of their physics.
        let hits = |encounter: &Encounter| {
            let family = self.game.0.effects[usize::from(encounter.effect)].summary.family;
            family == EffectFamily::Bounce && self.analysis.applies(encounter.first, stype)
        };
        match key {
            "gravity" if self.analysis.encounters().iter().any(hits) => true,
            "gravity" | "mass" | "friction" => info.traits.continuous || class.is_a(C::Walker),
            "max_speed" => info.traits.continuous || class.is_a(C::Walker),
            "jump_strength" => {
                [C::PlatformerAvatar, C::BirdAvatar, C::WalkerJumper].iter().any(|&c| class.is_a(c))
            }
            _ => true,
        }
    }
}
