//! A game's rules as a graph. The nodes are types, rules and the sets of types that level characters place. The edges
//! lead from each node to the types that it names.

use crate::measures::EffectFamily;
use engine::{Analysis, Clauses, Game, InteractionClause, Party, SpriteType, Term, Terms, TypeClause};

/// A label's level of detail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Grain {
    /// Families of classes and effects, without parameters.
    Coarse,
    /// Classes and effects, with parameters but without their values.
    Medium,
    /// Labels with all details.
    Fine,
}

impl Grain {
    pub(super) const ALL: [Grain; 3] = [Grain::Coarse, Grain::Medium, Grain::Fine];
}

/// A node in the graph.
#[derive(Clone, Debug)]
pub(super) struct Node {
    /// The label at each grain, without type names.
    pub(super) labels: [String; 3],
    /// The node's weight in the distance.
    pub(super) weight: u32,
    /// The types to which the node refers, each with its role.
    pub(super) edges: Vec<(String, usize)>,
}

/// A game's graph. Type nodes come first.
#[derive(Clone, Debug)]
pub(super) struct RuleGraph {
    pub(super) nodes: Vec<Node>,
    /// The number of type nodes.
    pub(super) types: usize,
    /// The game's types that the type nodes represent.
    pub(super) stypes: Vec<SpriteType>,
}

/// The weights of nodes. Nodes that nearly every game has weigh least: blocking, handling of the screen edge, and
/// placement by characters. Terminations weigh most.
const FRAME: u32 = 1;
const TYPE: u32 = 2;
const RULE: u32 = 4;
const ENDING: u32 = 6;

impl RuleGraph {
    pub(super) fn of(game: &Game) -> RuleGraph {
        let clauses = game.clauses();
        let analysis = Analysis::of(game);
        let used = used(&clauses);
        let kept: Vec<&TypeClause> =
            clauses.types.iter().filter(|clause| clause.declared || used[clause.stype.index()]).collect();
        let mut place = vec![usize::MAX; clauses.types.len()];
        kept.iter().enumerate().for_each(|(at, clause)| place[clause.stype.index()] = at);
        let edges = |terms: &Terms, ordered: bool| {
            let mut edges = Vec::new();
            for (key, term) in terms {
                let Term::Types(types) = term else { continue };
                for (at, stype) in types.iter().enumerate() {
                    let role = if ordered { format!("{key}{at}") } else { (*key).to_owned() };
                    edges.push((role, place[stype.index()]));
                }
            }
            edges
        };
        let mut nodes: Vec<Node> = kept
            .iter()
            .map(|clause| {
                // A parent without sprites of its own only groups its subtypes.
                let stands = clause.leaf || analysis.facts(clause.stype).possible;
                let terms = if stands { &clause.terms } else { &Terms::new() };
                let mut edges = edges(terms, true);
                edges.extend(clause.parent.map(|parent| ("below".to_owned(), place[parent.index()])));
                Node { labels: labels_of_type(clause, stands), weight: TYPE, edges }
            })
            .collect();
        let types = nodes.len();
        for clause in &clauses.interactions {
            let mut edges = edges(&clause.terms, false);
            for (role, party) in [("first", clause.first), ("second", clause.second)] {
                if let Party::Type(stype) = party {
                    edges.push((role.to_owned(), place[stype.index()]));
                }
            }
            let weight = if is_frame(clause) { FRAME } else { RULE };
            nodes.push(Node { labels: labels_of_interaction(clause), weight, edges });
        }
        for clause in &clauses.terminations {
            let label = |grain| format!("end {} {}{}", clause.class, clause.win, spell(&clause.terms, grain));
            let labels = Grain::ALL.map(label);
            nodes.push(Node { labels, weight: ENDING, edges: edges(&clause.terms, false) });
        }
        let mut sets: Vec<Vec<usize>> = Vec::new();
        for (_, placed) in &clauses.mapping {
            let mut set: Vec<usize> = placed.iter().map(|stype| place[stype.index()]).collect();
            set.retain(|&at| at != usize::MAX);
            set.sort_unstable();
            if !set.is_empty() && !sets.contains(&set) {
                sets.push(set);
            }
        }
        // A placement that another placement includes is omitted. In every game that gives `w` and `A` no other
        // meaning, they place only a wall and an avatar. If such placements counted, the choice of characters could
        // change the form.
        let within = |set: &[usize], other: &[usize]| {
            set.len() < other.len() && set.iter().all(|at| other.contains(at))
        };
        for set in sets.iter().filter(|set| !sets.iter().any(|other| within(set, other))) {
            let labels = [(); 3].map(|()| format!("places {}", set.len()));
            let edges = set.iter().map(|&at| ("placed".to_owned(), at)).collect();
            nodes.push(Node { labels, weight: FRAME, edges });
        }
        if !clauses.header.is_empty() {
            let spelled = |grain| format!("game{}", spell(&clauses.header, grain));
            let labels = Grain::ALL.map(spelled);
            nodes.push(Node { labels, weight: FRAME, edges: edges(&clauses.header, false) });
        }
        RuleGraph { nodes, types, stypes: kept.iter().map(|clause| clause.stype).collect() }
    }
}

/// Returns, for each type, `true` if a rule names the type or a character places it. `wall` and `avatar` exist in every
/// game, but are not part of a game's rules if the file does not use them.
fn used(clauses: &Clauses) -> Vec<bool> {
    let mut used = vec![false; clauses.types.len()];
    let mut named = |terms: &Terms| {
        for (_, term) in terms {
            if let Term::Types(types) = term {
                types.iter().for_each(|stype| used[stype.index()] = true);
            }
        }
    };
    named(&clauses.header);
    clauses.types.iter().for_each(|clause| named(&clause.terms));
    clauses.interactions.iter().for_each(|clause| named(&clause.terms));
    clauses.terminations.iter().for_each(|clause| named(&clause.terms));
    for party in clauses.interactions.iter().flat_map(|clause| [clause.first, clause.second]) {
        if let Party::Type(stype) = party {
            used[stype.index()] = true;
        }
    }
    clauses.mapping.iter().flat_map(|(_, placed)| placed).for_each(|stype| used[stype.index()] = true);
    used
}

/// Returns `true` for a rule that nearly every game has: blocking without a price or reward, or handling of
/// the screen edge.
fn is_frame(clause: &InteractionClause) -> bool {
    let blocks = EffectFamily::of(clause.effect) == Some(EffectFamily::Block);
    clause.second == Party::Edge || (blocks && clause.terms.is_empty())
}

fn labels_of_type(clause: &TypeClause, stands: bool) -> [String; 3] {
    let Some(class) = clause.class.filter(|_| stands) else { return [(); 3].map(|()| "group".to_owned()) };
    let name = class.name();
    [
        format!("type {}", class.family().name()),
        format!("type {name}{}", spell(&clause.terms, Grain::Medium)),
        format!("type {name}{}", spell(&clause.terms, Grain::Fine)),
    ]
}

fn labels_of_interaction(clause: &InteractionClause) -> [String; 3] {
    let kind = |party: Party| match party {
        Party::Type(_) => "type",
        Party::Edge => "edge",
        Party::Clock => "clock",
        Party::Nobody => "nobody",
    };
    let family = EffectFamily::of(clause.effect).map_or("", EffectFamily::name);
    let (effect, parties) = (clause.effect, format!("{} {}", kind(clause.first), kind(clause.second)));
    [
        format!("rule {parties} {family}"),
        format!("rule {parties} {effect}{}", spell(&clause.terms, Grain::Medium)),
        format!("rule {parties} {effect}{}", spell(&clause.terms, Grain::Fine)),
    ]
}

/// The numeric parameters that change a rule's kind if they are present and positive.
const COMPARED_PARAMETERS: [&str; 5] =
    ["scoreChange", "scoreChangeIfKilled", "time_to_live", "health", "total"];

/// Writes the parameters in key order, each after a space. Types are omitted, because edges represent them.
fn spell(terms: &Terms, grain: Grain) -> String {
    let mut spelled: Vec<String> = Vec::new();
    for (key, term) in terms {
        let value = match (term, grain) {
            (Term::Types(_), _) | (_, Grain::Coarse) => continue,
            (Term::Flag(flag), _) => flag.to_string(),
            (Term::Effect(keyword), _) => (*keyword).to_owned(),
            (Term::Direction(to), _) => format!("{:?},{:?}", to.x + 0.0, to.y + 0.0),
            (Term::Number(number), Grain::Medium) => match *number {
                number if number < 0.0 => "-".to_owned(),
                0.0 => "0".to_owned(),
                _ if COMPARED_PARAMETERS.contains(key) => "+".to_owned(),
                _ => continue,
            },
            (Term::Numbers(_), Grain::Medium) => String::new(),
            (Term::Number(number), Grain::Fine) => format!("{number:?}"),
            (Term::Numbers(numbers), Grain::Fine) => format!("{numbers:?}"),
        };
        spelled.push(format!(" {key}={value}"));
    }
    spelled.sort_unstable();
    spelled.concat()
}
