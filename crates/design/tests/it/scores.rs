//! Scores of designers, and the reference designers.

use crate::games::{PIT_LEVELS, PITS, PLUM_LEVELS, PLUMS, idea, levels, rules};
use crate::scripted::{Scripted, settings};
use infinite_arcade_design::{
    DesignFolder, DesignSettings, Designer, DesignerScore, Known, Reference, replay, run, table,
};
use serde_json::json;

#[test]
fn steps_and_costs_are_counted() {
    let home = tempfile::tempdir().unwrap();
    let broken = rules(&PITS.replace("bounceForward", "bounceForwards"));
    let mut answers = vec![idea("plum-walk"), rules(PLUMS), levels(&PLUM_LEVELS)];
    answers.extend([idea("pit-stop"), broken.clone(), rules(PITS), levels(&PIT_LEVELS)]);
    answers.extend([idea("never-done"), broken.clone(), broken.clone(), broken.clone(), broken]);
    let folder = DesignFolder::create(&home.path().join("designs"), settings(3)).unwrap();
    run(&folder, &Scripted::new(&answers).designer(), &Known::default(), &mut |_| ()).unwrap();
    let score = DesignerScore::read(&folder).unwrap();
    let count = |step: &str| score.rates.iter().find(|rate| rate.step == step).unwrap().count;
    let steps = ["compiles", "loads", "won", "winnable", "new", "accepted at once", "accepted"];
    assert_eq!(steps.map(count), [2, 2, 2, 2, 2, 1, 2]);
    let cost = |unit: &str| score.costs.iter().find(|cost| cost.unit == unit).unwrap().value;
    // Twelve answers of 110 tokens, and four corrections, for two games.
    assert_eq!((cost("answers"), cost("tokens"), cost("corrections")), (Some(6.0), Some(660.0), Some(2.0)));
    assert_eq!(cost("US dollars"), None);
    let text = table(&[score]).to_markdown();
    assert!(text.contains("| accepted, % | 67"), "{text}");
}

fn reference(reference: Reference, drafts: u64) -> DesignSettings {
    let details = json!({ "reference": reference });
    DesignSettings { designer: reference.name().to_owned(), details, ..settings(drafts) }
}

#[test]
fn reference_designers_need_no_model_and_replay() {
    for (designer, drafts) in [(Reference::Grammar, 6), (Reference::Kernels, 2)] {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().join("designs");
        let folder = DesignFolder::create(&folder, reference(designer, drafts)).unwrap();
        let known = Known::default();
        let outcome = run(&folder, &Designer::Reference(designer), &known, &mut |_| ()).unwrap();
        assert_eq!(outcome.results.drafts.len() as u64, drafts);
        let is_kernels = designer == Reference::Kernels;
        assert!(outcome.results.drafts.iter().all(|draft| draft.measures.compiles || !is_kernels));
        let (results, differing) = replay(&folder, &known).unwrap();
        assert_eq!((results, differing), (outcome.results, vec![]));
    }
}
