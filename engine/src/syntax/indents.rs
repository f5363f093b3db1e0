//! Checks of the indentation. Neighbouring lines that deviate in the same way are reported as one problem.

use super::description::Section;
use super::layout::Line;
use crate::diagnostic::Diagnostic;

/// The most frequent indent; of several, the first one.
pub(super) fn usual(indents: impl Iterator<Item = usize>) -> usize {
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

/// The usual indent of the lines without a parent among `lines`.
pub(super) fn of_siblings(lines: &[&Line<'_>]) -> usize {
    let mut sibling = usize::MAX;
    usual(lines.iter().map(|line| line.indent).filter(|&indent| {
        let is_sibling = indent <= sibling;
        sibling = if is_sibling { indent } else { sibling };
        is_sibling
    }))
}

/// Reports lines that are not indented deeper than the name of their section.
pub(super) fn outside(section: Section, head: usize, lines: &[&Line<'_>], problems: &mut Vec<Diagnostic>) {
    for (first, count) in runs(lines, |_, line| (line.indent <= head).then_some(0)) {
        let message = format!("{} not indented below {}{}", these(count), section.name(), of_tabs(first));
        let problem = Diagnostic::error("stray-line", first.span, message);
        problems.push(problem.help(format!("indent {} deeper than `{}`", them(count), section.name())));
    }
}

/// Reports lines of a section without subtypes that are not indented like most of them.
pub(super) fn uneven(section: Section, head: usize, lines: &[&Line<'_>], problems: &mut Vec<Diagnostic>) {
    let inside = lines.iter().map(|line| line.indent).filter(|&indent| indent > head);
    let indent = usual(inside);
    let off = |line: &Line<'_>| line.indent > head && line.indent != indent;
    for (first, count) in runs(lines, |_, line| off(line).then_some(line.indent)) {
        let message = format!("{} indented unlike the others{}", these(count), of_tabs(first));
        let problem = Diagnostic::error("stray-indent", first.span, message);
        let help = format!("indent every line of {} by the same {indent} columns", section.name());
        problems.push(problem.help(help));
    }
}

/// Reports lines of a SpriteSet that are indented between the columns of the others: children or siblings by accident. A
/// file without such columns has no such problems. Returns `true` if there are columns.
pub(super) fn off_grid(head: usize, lines: &[&Line<'_>], problems: &mut Vec<Diagnostic>) -> bool {
    let indents = || std::iter::once(head).chain(lines.iter().map(|line| line.indent));
    let above: Vec<usize> = indents().map(|indent| indent - head).collect();
    let mut steps: Vec<usize> =
        indents().zip(indents().skip(1)).map(|(a, b)| a.abs_diff(b)).filter(|&step| step > 0).collect();
    steps.push(usual(lines.iter().map(|line| line.indent)).saturating_sub(head).max(1));
    steps.sort_unstable();
    steps.dedup();
    // The deviation of a line between columns, or more than one column to the right of the line above.
    let off = |step: usize, at: usize, line: &Line<'_>| {
        let (rest, above) = ((line.indent - head) % step, above[at].next_multiple_of(step));
        (rest > 0 || line.indent - head > above + step).then_some(rest)
    };
    let count =
        |step: usize| lines.iter().enumerate().filter(|(at, line)| off(step, *at, line).is_some()).count();
    // The widest columns that nearly all lines follow.
    let Some(step) = steps.into_iter().rev().find(|&step| count(step) * 4 <= lines.len()) else {
        return false;
    };
    for (first, count) in runs(lines, |at, line| off(step, at, line)) {
        let below = head + (first.indent - head) / step * step;
        let near = if below == head { below + step } else { below };
        let message = format!("{} indented unlike the others{}", these(count), of_tabs(first));
        let problem = Diagnostic::warning("uneven-indent", first.span, message);
        let it = if count == 1 { "it" } else { "the first of them" };
        problems.push(problem.help(match near == below {
            true => format!("indent {it} by {near} columns, or by {} below its parent", near + step),
            false => format!("indent {it} by {near} columns, like them"),
        }));
    }
    true
}

/// The first line of each run of neighbours for which `off` returns the same value, and the length of the run.
fn runs<'a, 'b>(
    lines: &[&'b Line<'a>],
    off: impl Fn(usize, &Line<'a>) -> Option<usize>,
) -> Vec<(&'b Line<'a>, usize)> {
    let mut runs: Vec<(&'b Line<'a>, usize)> = Vec::new();
    let mut last = None;
    for (at, &line) in lines.iter().enumerate() {
        let own = off(at, line);
        match runs.last_mut() {
            Some((_, count)) if own.is_some() && own == last => *count += 1,
            _ if own.is_some() => runs.push((line, 1)),
            _ => {}
        }
        last = own;
    }
    runs
}

/// A note for indents with tabs, which are not as wide as they may look.
pub(super) fn of_tabs(line: &Line<'_>) -> &'static str {
    if line.tabbed { ": a tab counts as one column" } else { "" }
}

fn these(count: usize) -> String {
    if count == 1 { "this line is".to_owned() } else { format!("these {count} lines are") }
}

fn them(count: usize) -> &'static str {
    if count == 1 { "it" } else { "them" }
}
