//! Tests of the prompts of the corpus games.
//!
//! `BLESS=1 cargo test -p infinite-arcade-evaluation --test it prompts` rewrites the files in `golden/`.
//! Review their diff like code. A change to any word requires a new [`evaluation::prompt::VERSION`].

use crate::walk::{Walk, corpus, game, public_games};
use base::{Digest, Seed};
use engine::{Action, Game, Outcome};
use evaluation::client::{ChatMessage, Role};
use evaluation::metrics::EndCause;
use evaluation::prompt::{
    Attempt, Encodings, Mode, Past, PromptSettings, PromptStyle, Prompter, Rules, sections,
};
use evaluation::{Commitment, Subject};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::io::Write as _;
use std::path::Path;

fn prompter(subject: &Subject, settings: &PromptSettings) -> Prompter {
    Prompter::new(subject, settings.clone()).unwrap_or_else(|error| panic!("{}: {error}", subject.id))
}

pub(crate) fn text(messages: &[ChatMessage]) -> String {
    let one = |message: &ChatMessage| {
        format!("[{}]\n{}\n", format!("{:?}", message.role).to_lowercase(), message.text)
    };
    messages.iter().map(one).collect::<Vec<_>>().join("\n")
}

/// Compares a text with a file in `golden/`, or rewrites the file.
pub(crate) fn golden(name: &str, got: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name);
    if std::env::var_os("BLESS").is_some() {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, got).unwrap();
    }
    let committed = fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(committed, got, "{} is old: BLESS=1 writes it anew", path.display());
}

fn median(mut values: Vec<u64>) -> u64 {
    values.sort_unstable();
    values[values.len() / 2]
}

#[test]
fn first_turns_of_all_games() {
    let mut lines = String::new();
    for subject in corpus() {
        let prompter = prompter(&subject, &PromptSettings::default());
        let prompt = prompter.prompt(&Walk::new(&subject, 0).turn(), &[], &[]);
        let digest = Digest::of(text(&prompt.messages).as_bytes());
        let (id, fixed, turn) = (&subject.id, prompt.tokens.fixed(), prompt.tokens.turn());
        writeln!(lines, "{id} {} {fixed} + {turn} tokens", digest.short()).unwrap();
    }
    golden("first_turns.txt", &lines);
}

/// Prompts of all styles are compared with golden files. The games include one with several avatar states,
/// one with shots, and one that never stands still.
#[test]
fn prompts_to_read() {
    let plans = ["10", "all"].map(|commit| {
        let (subject, commit) = (game("first-ice"), commit.parse().unwrap());
        let prompter = Prompter::within(&subject, PromptSettings::default(), 1000, commit).unwrap();
        text(&prompter.prompt(&Walk::new(&subject, 0).turn(), &[], &[]).messages)
    });
    golden("plans.txt", &plans.join("\n"));
    let show = |name: &str, subject: &str, settings: &PromptSettings, steps: usize| {
        let subject = game(subject);
        let prompter = prompter(&subject, settings);
        let mut walk = Walk::new(&subject, 0);
        let mut past = Vec::new();
        for _ in 0..steps {
            let shown = prompter.prompt(&walk.turn(), &past, &[]).shown;
            walk.step();
            let played = walk.before.as_ref().unwrap().1;
            let answer = Attempt { answer: format!("ACTION: {played}"), complaint: None };
            past.push(Past::new(shown, &[answer], played));
        }
        golden(name, &text(&prompter.prompt(&walk.turn(), &past, &[]).messages));
    };
    let standard = PromptSettings::default();
    show("first-ice.txt", "first-ice", &standard, 0);
    show("turnip-heist.txt", "turnip-heist", &standard, 0);
    show("moth-observatory.txt", "moth-observatory", &standard, 12);
    let contextual = PromptSettings { mode: Mode::Contextual, ..standard.clone() };
    show("contextual.txt", "kiln-gecko", &contextual, 2);
    let vgdl = PromptSettings { rules: Rules::Vgdl, masked_names: true, ..standard.clone() };
    show("vgdl_masked.txt", "first-ice", &vgdl, 0);
    let encodings = Encodings {
        grid: true,
        grounding: true,
        coordinates: true,
        rotated: true,
        json: true,
        ..Encodings::default()
    };
    show("encodings.txt", "first-ice", &PromptSettings { encodings, ..standard.clone() }, 3);
    let reference = PromptSettings { style: PromptStyle::Reference, ..standard };
    show("reference.txt", "first-ice", &reference, 0);
    show("reference_contextual.txt", "first-ice", &PromptSettings { mode: Mode::Contextual, ..reference }, 2);
}

/// The last tick stated in a turn equals the last tick in the rules, unless the prompt has no rules.
#[test]
fn the_last_tick_matches_the_rules() {
    let subject = game("first-ice");
    for (rules, last) in [(Rules::Described, 201), (Rules::Vgdl, 201), (Rules::None, 1000)] {
        let settings = PromptSettings { rules, ..PromptSettings::default() };
        let shown =
            text(&prompter(&subject, &settings).prompt(&Walk::new(&subject, 0).turn(), &[], &[]).messages);
        assert!(shown.contains(&format!("Tick 0 of at most {last}.")), "{rules:?}: {shown}");
    }
}

/// If the step limit comes before the Timeout, the prompt states only the step limit.
#[test]
fn the_rules_know_the_limit_of_decisions() {
    let subject = game("first-ice");
    let rules = |limit: u64| {
        let prompter = Prompter::within(&subject, PromptSettings::default(), limit, Commitment::ONE).unwrap();
        prompter.static_part().to_owned()
    };
    assert_eq!(rules(1000), prompter(&subject, &PromptSettings::default()).static_part());
    let (own, ours) =
        ("You lose when tick 201 is reached.", "Play stops at tick 60: if you have not won by then");
    assert!(rules(201).contains(own) && !rules(201).contains("Play stops at tick"), "{}", rules(201));
    assert!(rules(60).contains(ours) && !rules(60).contains(own), "{}", rules(60));
}

/// The rules state the steward's pace, so the prompt may foretell its next move. Without rules, it must not.
#[test]
fn only_prompts_with_rules_foretell() {
    let subject = game("turnip-heist");
    let walk = Walk::new(&subject, 0);
    for (rules, foretold) in [(Rules::Described, true), (Rules::Vgdl, true), (Rules::None, false)] {
        let prompter = prompter(&subject, &PromptSettings { rules, ..PromptSettings::default() });
        let prompt = prompter.prompt(&walk.turn(), &[], &[]);
        let text = &prompt.messages.last().unwrap().text;
        assert_eq!(text.contains("\n## Soon\nsteward: can move in 2 ticks"), foretold, "{text}");
        assert_eq!(text.contains("## Soon"), foretold, "{text}");
    }
}

/// The last message states how the episode ended.
#[test]
fn the_last_message_tells_the_outcome() {
    let subject = game("first-ice");
    let prompter = prompter(&subject, &PromptSettings::default());
    let mut walk = Walk::new(&subject, 0);
    let ending = prompter.ending(&walk.turn());
    assert!(
        ending.starts_with(
            "## End\nThe limit of 1000 actions was reached before the game was over, which is not a win. Score 0, after 0 actions. \
             No answer is expected.\n\n## Turn\nTick 0 of at most 201."
        ),
        "{ending}"
    );
    for (outcome, expect) in [
        (Outcome::Won, "You have won. Score 0,"),
        (Outcome::Lost, "You have lost. Score 0,"),
        (Outcome::Ended, "The game is over without a winner. Score 0,"),
    ] {
        walk.now.outcome = outcome;
        let mut turn = walk.turn();
        turn.actions = &[];
        let ending = prompter.ending(&turn);
        assert!(ending.starts_with(&format!("## End\n{expect}")), "{ending}");
        assert!(!ending.contains("Actions now"), "{ending}");
    }
}

/// Measures the number of tokens per step. `cargo test -p infinite-arcade-evaluation --test it prompts --
/// --nocapture tokens` prints the table in `docs/reference/prompts.md`.
#[test]
fn tokens_of_the_default_prompt() {
    let (mut whole, mut turns, mut parts) = (Vec::new(), Vec::new(), BTreeMap::<String, Vec<u64>>::new());
    for subject in corpus() {
        let prompter = prompter(&subject, &PromptSettings::default());
        for level in 0..subject.levels.len() {
            let mut walk = Walk::new(&subject, level);
            // The first turn and a later turn are measured.
            for _ in 0..2 {
                let tokens = prompter.prompt(&walk.turn(), &[], &[]).tokens;
                whole.push(tokens.total);
                turns.push(tokens.turn());
                for part in tokens.fixed.into_iter().chain(tokens.turn) {
                    parts.entry(part.part).or_default().push(part.tokens);
                }
                for _ in 0..20 {
                    if !walk.step() {
                        break;
                    }
                }
            }
        }
    }
    let prompts = whole.len();
    let mut table = String::new();
    for (part, tokens) in parts {
        let (shown, most) = (tokens.len(), tokens.iter().max().copied().unwrap_or(0));
        writeln!(table, "{part}: median {}, most {most}, in {shown} of {prompts}", median(tokens)).unwrap();
    }
    let (most, most_turn) = (whole.iter().max().copied().unwrap(), turns.iter().max().copied().unwrap());
    let (whole, turns) = (median(whole), median(turns));
    writeln!(table, "turn: median {turns}, most {most_turn}\nwhole: median {whole}, most {most}").unwrap();
    let _ = std::io::Write::write_all(&mut std::io::stderr(), table.as_bytes());
    assert!(whole <= 1500 && turns <= 500, "{table}");
}

#[test]
fn the_static_part_never_changes() {
    for subject in corpus() {
        let prompter = prompter(&subject, &PromptSettings::default());
        for level in 0..subject.levels.len() {
            let mut walk = Walk::new(&subject, level);
            for _ in 0..if crate::sweeping() { 15 } else { 5 } {
                let prompt = prompter.prompt(&walk.turn(), &[], &[]);
                assert_eq!(prompt.messages[0].role, Role::System);
                assert_eq!(prompt.messages[0].text, prompter.static_part(), "{}", subject.id);
                assert_eq!(prompt, prompter.prompt(&walk.turn(), &[], &[]), "{}", subject.id);
                if !walk.step() {
                    break;
                }
            }
        }
    }
}

#[test]
fn vgdl_in_prompts_is_the_game() {
    for subject in corpus() {
        let settings = PromptSettings { rules: Rules::Vgdl, ..PromptSettings::default() };
        let prompter = prompter(&subject, &settings);
        let all = sections(prompter.static_part());
        let (_, rules) = all.iter().find(|(heading, _)| *heading == "Rules").unwrap();
        let (_, source) = rules.split_once('\n').unwrap();
        assert_eq!(Game::from_source(source).unwrap().digest(), subject.game.digest(), "{}", subject.id);
    }
}

/// A name counts as leaked if a masked prompt contains it and no masked prompt of another game does, because
/// then it is not part of the common wording.
#[test]
fn masked_prompts_contain_no_names() {
    let words = |subject: &Subject, rules: Rules| -> BTreeSet<String> {
        let encodings = Encodings { coordinates: true, json: true, ..Encodings::default() };
        let mode = Mode::Contextual;
        let settings =
            PromptSettings { rules, masked_names: true, mode, encodings, ..PromptSettings::default() };
        let prompter = prompter(subject, &settings);
        let mut walk = Walk::new(subject, 0);
        walk.step();
        let told = text(&prompter.prompt(&walk.turn(), &[], &[]).messages);
        told.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').map(str::to_owned).collect()
    };
    for rules in [Rules::Described, Rules::Vgdl] {
        let games: Vec<(Subject, BTreeSet<String>)> = corpus()
            .into_iter()
            .map(|subject| (words(&subject, rules), subject))
            .map(|(w, s)| (s, w))
            .collect();
        for (subject, words) in &games {
            for (_, line) in subject.game.description().sprite_lines() {
                let name = line.name.text.as_str();
                let elsewhere =
                    games.iter().any(|(other, words)| other.id != subject.id && words.contains(name));
                assert!(elsewhere || !words.contains(name), "{}: {name}", subject.id);
            }
        }
    }
}

#[test]
fn all_settings_render() {
    let subjects = [game("first-ice"), game("moth-observatory"), game("pantry-mouse")];
    for (at, subject) in (0..).zip(&subjects) {
        for bits in (0_u32..1 << 12).filter(|bits| crate::sweeping() || bits % 29 == at) {
            let has = |bit: u32| bits >> bit & 1 == 1;
            // Images take long to draw, and no template depends on their content.
            let image = has(0) && bits % 128 == 1;
            let settings = PromptSettings {
                style: if has(1) { PromptStyle::Reference } else { PromptStyle::Standard },
                mode: if has(2) { Mode::Contextual } else { Mode::ZeroShot },
                rules: [Rules::Described, Rules::Vgdl, Rules::None][(bits % 3) as usize],
                masked_names: has(3),
                neutral_names: has(10),
                legend: has(4),
                action_meanings: has(5),
                position: has(6),
                feedback: [None, Some(true), Some(false)][(bits / 3 % 3) as usize],
                encodings: Encodings {
                    grid: has(7),
                    spaced: has(0),
                    grounding: has(8),
                    coordinates: has(9),
                    rotated: has(10),
                    json: has(11),
                    image,
                    image_cell: 8,
                },
                identity_tracking: has(4),
                shuffled_symbols: has(5).then_some(u64::from(bits)),
                strategy: has(6).then(|| "Take your time.".to_owned()),
                history_tokens: u64::from(bits),
            };
            let prompter = prompter(subject, &settings);
            let mut walk = Walk::new(subject, 0);
            walk.step();
            let wrong =
                Attempt { answer: "No.".to_owned(), complaint: Some(prompter.complaint("it is silly")) };
            let past = [Past::new("Seen.".to_owned(), &[wrong.clone(), wrong.clone()], Action::Nil)];
            let prompt = prompter.prompt(&walk.turn(), &past, &[wrong]);
            let all = text(&prompt.messages);
            assert!(!all.contains("\n\n\n") && !all.contains("undefined"), "{settings:?}\n{all}");
            assert!(all.contains("## Turn\n") || all.contains("## Cells\n"), "{all}");
            assert_eq!(prompt.messages.iter().any(|message| message.image.is_some()), image);
            assert_eq!(
                serde_json::from_str::<PromptSettings>(&serde_json::to_string(&settings).unwrap()).unwrap(),
                settings
            );
        }
    }
}

#[test]
fn unknown_settings_are_rejected() {
    assert_eq!(serde_json::from_str::<PromptSettings>("{}").unwrap(), PromptSettings::default());
    assert!(serde_json::from_str::<PromptSettings>(r#"{"rulez": "vgdl"}"#).is_err());
    assert!(serde_json::from_str::<PromptSettings>(r#"{"encodings": {"gird": true}}"#).is_err());
    let encodings = Encodings { image_cell: 1, ..Encodings::default() };
    let settings = PromptSettings { encodings, ..PromptSettings::default() };
    assert!(Prompter::new(&game("first-ice"), settings).is_err());
}

#[test]
fn aids_list_the_changed_settings() {
    assert_eq!(PromptSettings::default().aids(), Vec::<String>::new());
    let settings = PromptSettings {
        mode: Mode::Contextual,
        rules: Rules::Vgdl,
        legend: false,
        feedback: Some(false),
        strategy: Some("Hurry.".to_owned()),
        history_tokens: 500,
        encodings: Encodings { json: true, grounding: false, ..Encodings::default() },
        ..PromptSettings::default()
    };
    let expected =
        ["history-tokens=500", "json", "no-feedback", "no-grounding", "no-legend", "rules=vgdl", "strategy"];
    assert_eq!(settings.aids(), expected);
}

#[test]
fn digests_distinguish_settings() {
    let subject = game("first-ice");
    let standard = prompter(&subject, &PromptSettings::default());
    assert_eq!(standard.digest(), prompter(&game("turnip-heist"), &PromptSettings::default()).digest());
    let other = PromptSettings { legend: false, ..PromptSettings::default() };
    assert_ne!(standard.digest(), prompter(&subject, &other).digest());
}

/// When the budget would be exceeded, whole turns are dropped, oldest first. Between such cuts, the
/// conversation grows only at its end. Only the static part and the newest turn can exceed the budget.
#[test]
fn histories_keep_to_their_budget() {
    let subject = game("first-ice");
    for budget in [0, 1200, 2000, 4000, 20_000] {
        let settings =
            PromptSettings { mode: Mode::Contextual, history_tokens: budget, ..PromptSettings::default() };
        let prompter = prompter(&subject, &settings);
        let (mut past, mut cuts, mut left_out) = (Vec::new(), 0, 0);
        let mut walk = Walk::new(&subject, 0);
        for turn in 0..120 {
            let prompt = prompter.prompt(&walk.turn(), &past, &[]);
            let least = prompter.prompt(&walk.turn(), &[], &[]).tokens.total;
            assert!(prompt.tokens.total <= budget.max(least), "turn {turn}: {:?} of {budget}", prompt.tokens);
            assert!(prompt.left_out >= left_out);
            cuts += u64::from(prompt.left_out > left_out);
            left_out = prompt.left_out;
            assert_eq!(prompt.messages[0].text, prompter.static_part());
            assert_eq!(prompt.messages.last().unwrap().text, prompt.shown);
            assert_eq!(prompt.messages.len(), 2 + 4 * (turn - left_out));
            let long = "I wonder. ".repeat(1000);
            let wrong = Attempt { answer: long, complaint: Some(prompter.complaint("it names no action")) };
            let right = Attempt { answer: "<think>Hm.</think>ACTION: up".to_owned(), complaint: None };
            past.push(Past::new(prompt.shown, &[wrong, right], Action::Up));
            if !walk.step() {
                walk = Walk::new(&subject, 0);
            }
        }
        // A quarter of the budget is freed at once.
        let expected = match budget {
            0 | 1200 | 2000 => 0..=120,
            _ => 2..=60,
        };
        assert!(expected.contains(&cuts), "{cuts} cuts at {budget}");
    }
}

#[test]
fn answers_use_the_action_names_of_the_prompt() {
    let subject = game("first-ice");
    let walk = Walk::new(&subject, 0);
    let standard = prompter(&subject, &PromptSettings::default());
    assert_eq!(standard.read("ACTION: left", &walk.turn()).choice(), Some(vec![Action::Left]));
    assert_eq!(standard.read("ACTION: use", &walk.turn()).choice(), None);
    let reference = PromptSettings { style: PromptStyle::Reference, ..PromptSettings::default() };
    let reference = prompter(&subject, &reference);
    let number = reference.actions().iter().position(|action| *action == Action::Down).unwrap();
    let answer = format!("```\nAction:{number}\n```\nDown it is.");
    assert_eq!(reference.read(&answer, &walk.turn()).choice(), Some(vec![Action::Down]));
    let why = "`fly` is not an action of the list";
    assert!(standard.complaint(why).contains(why) && reference.complaint(why).contains("from 0 to"));
}

#[test]
fn only_the_newest_turn_has_a_picture() {
    let subject = game("first-ice");
    let encodings = Encodings { image: true, ..Encodings::default() };
    let settings = PromptSettings { mode: Mode::Contextual, encodings, ..PromptSettings::default() };
    let prompter = prompter(&subject, &settings);
    let mut walk = Walk::new(&subject, 0);
    let first = prompter.prompt(&walk.turn(), &[], &[]);
    for _ in 0..5 {
        walk.step();
    }
    let past = [Past::new(first.shown.clone(), &[], Action::Nil)];
    let second = prompter.prompt(&walk.turn(), &past, &[]);
    let pictures: Vec<bool> = second.messages.iter().map(|message| message.image.is_some()).collect();
    assert_eq!(pictures, [false, false, false, true]);
    let bytes = second.messages[3].image.as_ref().unwrap();
    assert!(bytes.starts_with(b"\x89PNG") && first.messages[1].image.as_ref() != Some(bytes));
}

/// The last message states the termination that ended the game, and the interaction that led to it. Masked prompts use
/// masked names, and prompts without rules state neither.
#[test]
fn the_last_message_tells_the_rules_that_ended_the_game() {
    let subject = game("moth-observatory");
    let told = |settings: &PromptSettings, cause: EndCause| {
        let mut walk = Walk::new(&subject, 0);
        walk.now.outcome = Outcome::Lost;
        prompter(&subject, settings).ending(&evaluation::Turn { cause: Some(cause), ..walk.turn() })
    };
    let is_bat = |stype: engine::SpriteType| subject.game.name(stype) == "bat";
    let encounters = subject.analysis.encounters();
    let interaction = encounters.iter().find(|met| met.second.is_some_and(is_bat)).map(|met| met.line);
    let termination = subject.analysis.goals().iter().find(|goal| goal.can_lose()).map(|goal| goal.line);
    let cause = EndCause { termination, interaction };
    let standard = told(&PromptSettings::default(), cause);
    let rules = "The rules that ended the game:\n- You lose when you are gone.\n- You die on touching the bat. You lose 3 points.\n\n## Turn";
    assert!(standard.contains(rules), "{standard}");
    let masked = told(&PromptSettings { masked_names: true, ..PromptSettings::default() }, cause);
    assert!(masked.contains("- You die on touching the t") && !masked.contains("bat"), "{masked}");
    let silent = told(&PromptSettings { rules: Rules::None, ..PromptSettings::default() }, cause);
    assert!(!silent.contains("ended the game:"), "{silent}");
}

/// No episode exceeds the highest score that prompts state.
#[test]
fn the_highest_score_is_never_exceeded() {
    let (mut known, mut levels, mut reached) = (0, 0, 0);
    for subject in corpus().into_iter().chain(public_games()) {
        for level in 0..subject.levels.len() {
            levels += 1;
            let start = subject.game.start(&subject.levels[level].level, Seed::from_text("start"));
            let Some(most) = subject.analysis.most_points(&start) else { continue };
            known += 1;
            let mut walk = Walk::new(&subject, level);
            let shown = prompter(&subject, &PromptSettings::default()).prompt(&walk.turn(), &[], &[]).shown;
            assert!(shown.contains(&format!("Score 0 of at most {most}.")), "{}: {shown}", subject.id);
            let mut best = 0.0_f64;
            for _ in 0..300 {
                let goes_on = walk.step();
                best = best.max(walk.now.score);
                if !goes_on {
                    break;
                }
            }
            assert!(best <= most as f64, "{} level {level}: {best} of at most {most}", subject.id);
            reached += usize::from(best == most as f64);
        }
    }
    let _ = writeln!(
        std::io::stderr(),
        "{known} of {levels} levels have a highest score; {reached} were reached"
    );
    assert!(known > 10, "{known} of {levels}");
}
