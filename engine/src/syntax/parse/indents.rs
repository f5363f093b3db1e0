//! Indentation checks. Neighbouring lines that deviate in the same way are reported as one problem.

use super::layout::Line;
use crate::diagnostic::{Diagnostic, Edit};
use crate::syntax::description::Section;

/// Returns the most frequent indent. If several are equally frequent, returns the first.
pub(crate) fn usual(indents: impl Iterator<Item = usize>) -> usize {
    let mut counts: Vec<(usize, usize)> = Vec::new();
    for indent in indents {
        match counts.iter_mut().find(|(known, _)| *known == indent) {
            Some((_, count)) => *count += 1,
            None => counts.push((indent, 1)),
        }
    }
    let most = counts.iter().map(|&(_, count)| count).max();
    counts.iter().find(|(_, count)| Some(*count) == most).map_or(0, |&(indent, _)| indent)
}

/// Returns the usual indent of those `lines` that have no parent.
pub(crate) fn of_siblings(lines: &[&Line<'_>]) -> usize {
    let mut sibling = usize::MAX;
    usual(lines.iter().map(|line| line.indent).filter(|&indent| {
        let is_sibling = indent <= sibling;
        sibling = if is_sibling { indent } else { sibling };
        is_sibling
    }))
}

/// Returns the problem, with a repair that indents the first line by `columns` and shifts the other lines by
/// the same distance.
fn shifted(problem: Diagnostic, lines: &[&Line<'_>], columns: usize) -> Diagnostic {
    let first = lines.first().map_or(0, |line| line.indent);
    let moved = |line: &&Line<'_>| line.indented((line.indent + columns).saturating_sub(first));
    let edits: Vec<Edit> = lines.iter().map(moved).collect();
    problem.fix(format!("Indent {} by {columns} columns", them(lines.len())), edits)
}

/// Reports lines that are not indented more deeply than their section's name.
pub(crate) fn outside(section: Section, head: usize, lines: &[&Line<'_>], problems: &mut Vec<Diagnostic>) {
    let inside = lines.iter().map(|line| line.indent).filter(|&indent| indent > head);
    let inside = Some(usual(inside)).filter(|&indent| indent > head).unwrap_or(head + 4);
    for run in runs(lines, |_, line| (line.indent <= head).then_some(0)) {
        let message =
            format!("{} not indented below {}{}", these(run.len()), section.name(), of_tabs(run[0]));
        let problem = Diagnostic::error("stray-line", run[0].span, message);
        let problem = problem.help(format!("indent {} deeper than `{}`", them(run.len()), section.name()));
        problems.push(shifted(problem, run, inside));
    }
}

/// Reports lines that are not indented like most lines of their section. The section must not be the
/// SpriteSet, whose lines can be nested.
pub(crate) fn uneven(section: Section, head: usize, lines: &[&Line<'_>], problems: &mut Vec<Diagnostic>) {
    let inside = lines.iter().map(|line| line.indent).filter(|&indent| indent > head);
    let indent = usual(inside);
    let off = |line: &Line<'_>| line.indent > head && line.indent != indent;
    for run in runs(lines, |_, line| off(line).then_some(line.indent)) {
        let message = format!("{} not indented like the others{}", these(run.len()), of_tabs(run[0]));
        let problem = Diagnostic::error("stray-indent", run[0].span, message);
        let help = format!("indent every line of {} by the same {indent} columns", section.name());
        problems.push(shifted(problem.help(help), run, indent));
    }
}

/// Reports SpriteSet lines whose indent lies between the columns of the other lines, which makes them
/// children or siblings by accident. Returns `true` if the lines' indentation is aligned to columns.
/// Otherwise, reports nothing.
pub(crate) fn off_grid(head: usize, lines: &[&Line<'_>], problems: &mut Vec<Diagnostic>) -> bool {
    let indents = || std::iter::once(head).chain(lines.iter().map(|line| line.indent));
    let above: Vec<usize> = indents().map(|indent| indent - head).collect();
    let mut steps: Vec<usize> =
        indents().zip(indents().skip(1)).map(|(a, b)| a.abs_diff(b)).filter(|&step| step > 0).collect();
    steps.push(usual(lines.iter().map(|line| line.indent)).saturating_sub(head).max(1));
    steps.sort_unstable();
    steps.dedup();
    // The deviation of a line that lies between columns, or more than one column to the right of the previous
    // line.
    let off = |step: usize, at: usize, line: &Line<'_>| {
        let (rest, above) = ((line.indent - head) % step, above[at].next_multiple_of(step));
        (rest > 0 || line.indent - head > above + step).then_some(rest)
    };
    let count =
        |step: usize| lines.iter().enumerate().filter(|(at, line)| off(step, *at, line).is_some()).count();
    // Find the largest column width with which nearly all lines are aligned.
    let Some(step) = steps.into_iter().rev().find(|&step| count(step) * 4 <= lines.len()) else {
        return false;
    };
    for run in runs(lines, |at, line| off(step, at, line)) {
        let (first, count) = (run[0], run.len());
        let below = head + (first.indent - head) / step * step;
        let near = if below == head { below + step } else { below };
        let message = format!("{} not indented like the others{}", these(count), of_tabs(first));
        let problem = Diagnostic::warning("uneven-indent", first.span, message);
        let it = if count == 1 { "it" } else { "the first of them" };
        let problem = problem.help(match near == below {
            true => format!("indent {it} by {near} columns, or by {} below its parent", near + step),
            false => format!("indent {it} by {near} columns, like the others"),
        });
        let at = lines.iter().position(|line| line.span == first.span).unwrap_or(0);
        let deepest = above[at].next_multiple_of(step) + step;
        problems.push(if near - head <= deepest { shifted(problem, run, near) } else { problem });
    }
    true
}

/// Returns the runs of neighbouring lines for which `off` returns the same value. Lines for which it returns `None`
/// belong to no run.
fn runs<'a, 'b, 'c>(
    lines: &'c [&'b Line<'a>],
    off: impl Fn(usize, &Line<'a>) -> Option<usize>,
) -> Vec<&'c [&'b Line<'a>]> {
    let values: Vec<Option<usize>> = lines.iter().enumerate().map(|(at, line)| off(at, line)).collect();
    let mut start = 0;
    let mut runs = Vec::new();
    for run in values.chunk_by(|one, other| one == other) {
        let own = start..start + run.len();
        start = own.end;
        if run[0].is_some() {
            runs.push(&lines[own]);
        }
    }
    runs
}

/// Returns a note about indents with tabs. Such an indent may look wider than it is, because each tab counts
/// as a single column.
pub(crate) fn of_tabs(line: &Line<'_>) -> &'static str {
    if line.tabbed { ": a tab counts as one column" } else { "" }
}

fn these(count: usize) -> String {
    if count == 1 { "this line is".to_owned() } else { format!("these {count} lines are") }
}

fn them(count: usize) -> &'static str {
    if count == 1 { "it" } else { "them" }
}
