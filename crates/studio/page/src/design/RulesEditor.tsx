import { acceptCompletion, autocompletion, closeCompletion, completionKeymap, type CompletionContext, type CompletionResult } from '@codemirror/autocomplete';
import { defaultKeymap, history, historyKeymap, indentWithTab } from '@codemirror/commands';
import { indentUnit } from '@codemirror/language';
import { type Diagnostic, forceLinting, lintGutter, lintKeymap, nextDiagnostic, openLintPanel, setDiagnostics } from '@codemirror/lint';
import { highlightSelectionMatches, searchKeymap } from '@codemirror/search';
import { EditorSelection, EditorState, StateEffect, StateField } from '@codemirror/state';
import {
  Decoration, type DecorationSet, EditorView, drawSelection, highlightActiveLine, highlightActiveLineGutter, hoverTooltip, keymap, lineNumbers,
} from '@codemirror/view';
import { render } from 'preact';
import { useEffect, useImperativeHandle, useRef } from 'preact/hooks';
import type { Ref } from 'preact';
import { post } from '../data/api';
import type { Edit, Problem } from '../data/types';
import { Markdown } from '../parts/Markdown';
import { language } from './language';
import { ProblemWords } from './Problems';

/** What other parts of the view may ask of the editor. */
export interface EditorHandle {
  /** Selects a stretch of the rules, scrolls to it and marks its line. */
  show: (start: number, end: number) => void;
  apply: (edits: Edit[]) => void;
  replace: (text: string) => void;
  /** Opens the manual's page on the problem or the word at the cursor. */
  explain: () => void;
}

interface Props {
  handle: Ref<EditorHandle>;
  text: string;
  problems: Problem[];
  /** The text that the problems were found in: positions in another text would be wrong. */
  checked: string;
  onChange: (text: string) => void;
  onRename: (at: number, word: string) => void;
  onFormat: () => void;
  onSave: () => void;
  onPage: (name: string) => void;
}

const markLine = StateEffect.define<number | null>();
const markedLine = StateField.define<DecorationSet>({
  create: () => Decoration.none,
  update(marks, transaction) {
    let next = marks.map(transaction.changes);
    for (const effect of transaction.effects) {
      if (!effect.is(markLine)) continue;
      next = effect.value === null ? Decoration.none : Decoration.set([Decoration.line({ class: 'cm-shown' }).range(effect.value)]);
    }
    return next;
  },
  provide: (field) => EditorView.decorations.from(field),
});

function markdownNode(text: string): HTMLElement {
  const node = document.createElement('div');
  node.className = 'cm-words';
  render(<Markdown text={text} />, node);
  return node;
}

/** The number of words at the beginning of a completion that come first because they are likely. */
const LIKELY = 20;

async function complete(context: CompletionContext): Promise<CompletionResult | null> {
  const word = context.matchBefore(/[\w.]+$/);
  const before = context.state.sliceDoc(Math.max(0, context.pos - 1), context.pos);
  if (!context.explicit && !word && !/[ =>]/.test(before)) return null;
  try {
    interface Item { label: string; detail: string | null; markdown: string | null; insert: string }
    const answer = await post<{ start: number; end: number; items: Item[] } | null>('/api/complete', { source: context.state.doc.toString(), at: context.pos });
    if (!answer || answer.items.length === 0) return null;
    return {
      from: answer.start,
      to: answer.end,
      validFor: /^[\w.]*$/,
      options: answer.items.map((item, index) => {
        const markdown = item.markdown;
        // The server's order, likely words first, decides among those that fit equally well.
        return { label: item.label, apply: item.insert, boost: Math.max(0, LIKELY - index), ...(item.detail ? { detail: item.detail } : {}), ...(markdown ? { info: () => markdownNode(markdown) } : {}) };
      }),
    };
  } catch {
    return null; // No completion is a lesser evil than an alert at every key.
  }
}

const hover = hoverTooltip(async (view, at) => {
  try {
    const answer = await post<{ start: number; end: number; markdown: string } | null>('/api/hover', { source: view.state.doc.toString(), at });
    // The pointer may have left meanwhile: then nothing would take the explanation away again.
    if (!answer || !view.contentDOM.matches(':hover')) return null;
    return { pos: answer.start, end: answer.end, above: true, create: () => ({ dom: markdownNode(answer.markdown) }) };
  } catch {
    return null;
  }
}, { hoverTime: 350 });

/** The rules in CodeMirror. */
export function RulesEditor(props: Props) {
  const box = useRef<HTMLDivElement>(null);
  const view = useRef<EditorView | null>(null);
  const unmark = useRef(0);
  const latest = useRef(props);
  latest.current = props;

  useEffect(() => {
    if (!box.current) return undefined;
    const command = (run: (view: EditorView) => void) => (of: EditorView): boolean => {
      run(of);
      return true;
    };
    const made = new EditorView({
      parent: box.current,
      state: EditorState.create({
        doc: props.text,
        extensions: [
          lineNumbers(), highlightActiveLineGutter(), highlightActiveLine(), drawSelection(), history(), indentUnit.of('    '),
          EditorState.tabSize.of(4), EditorState.allowMultipleSelections.of(true),
          highlightSelectionMatches(), EditorView.lineWrapping, language, markedLine, lintGutter({ hoverTime: 200 }), hover,
          autocompletion({ override: [complete], activateOnTypingDelay: 60 }),
          EditorView.contentAttributes.of({ 'aria-label': 'Rules', spellcheck: 'false', autocapitalize: 'off' }),
          keymap.of([
            { key: 'Mod-s', preventDefault: true, run: command(() => latest.current.onSave()) },
            { key: 'Shift-Alt-f', preventDefault: true, run: command(() => latest.current.onFormat()) },
            { key: 'F2', preventDefault: true, run: command((of) => rename(of, latest.current.onRename)) },
            { key: 'F12', preventDefault: true, run: command((of) => void define(of)) },
            { key: 'F1', preventDefault: true, run: command((of) => explain(of, latest.current)) },
            { key: 'Mod-.', preventDefault: true, run: command((of) => quickFix(of, latest.current)) },
            { key: 'F8', preventDefault: true, run: nextDiagnostic },
            { key: 'Tab', run: acceptCompletion },
            { key: 'Escape', run: closeCompletion },
            ...completionKeymap, ...lintKeymap, ...searchKeymap, ...historyKeymap, ...defaultKeymap, indentWithTab,
          ]),
          EditorView.updateListener.of((update) => {
            if (update.docChanged) latest.current.onChange(update.state.doc.toString());
          }),
          EditorView.domEventHandlers({
            click(event, of) {
              if (!event.ctrlKey && !event.metaKey) return false;
              void define(of);
              return true;
            },
          }),
        ],
      }),
    });
    view.current = made;
    return () => {
      window.clearTimeout(unmark.current);
      made.destroy();
    };
  }, []);

  useEffect(() => {
    const made = view.current;
    if (!made || made.state.doc.toString() !== props.checked) return;
    made.dispatch(setDiagnostics(made.state, props.problems.map((problem) => diagnostic(problem, props.checked, latest))));
    forceLinting(made);
  }, [props.problems, props.checked]);

  useImperativeHandle(props.handle, () => ({
    show(start, end) {
      const made = view.current;
      if (!made) return;
      const length = made.state.doc.length;
      const from = Math.min(start, length);
      made.dispatch({
        selection: EditorSelection.single(from, Math.min(Math.max(end, from), length)),
        effects: [EditorView.scrollIntoView(from, { y: 'center' }), markLine.of(made.state.doc.lineAt(from).from)],
      });
      made.focus();
      window.clearTimeout(unmark.current);
      unmark.current = window.setTimeout(() => view.current === made && made.dispatch({ effects: markLine.of(null) }), 2500);
    },
    apply(edits) {
      if (view.current) applyEdits(view.current, edits);
    },
    replace(text) {
      const made = view.current;
      if (!made || made.state.doc.toString() === text) return;
      const at = Math.min(made.state.selection.main.head, text.length);
      made.dispatch({ changes: { from: 0, to: made.state.doc.length, insert: text }, selection: { anchor: at } });
    },
    explain() {
      if (view.current) explain(view.current, latest.current);
    },
  }), []);

  return <div class="rules" ref={box} />;
}

function applyEdits(view: EditorView, edits: Edit[]): void {
  const length = view.state.doc.length;
  const changes = edits.filter((edit) => edit.end <= length).map((edit) => ({ from: edit.start, to: edit.end, insert: edit.text }));
  view.dispatch({ changes, userEvent: 'input.fix' });
  view.focus();
}

function diagnostic(problem: Problem, checked: string, latest: { current: Props }): Diagnostic {
  const from = Math.min(problem.start, checked.length);
  return {
    from,
    to: Math.min(Math.max(problem.end, from), checked.length),
    severity: problem.severity,
    source: problem.code,
    message: problem.message,
    renderMessage: () => {
      const node = document.createElement('div');
      render(<ProblemWords problem={problem} onPage={(name) => latest.current.onPage(name)} />, node);
      return node;
    },
    actions: problem.fixes.map((fix) => ({
      name: fix.title.replaceAll('`', ''),
      apply(view: EditorView) {
        if (view.state.doc.toString() === checked) applyEdits(view, fix.edits);
      },
    })),
  };
}

function rename(view: EditorView, call: (at: number, word: string) => void): void {
  const at = view.state.selection.main.head;
  const word = view.state.wordAt(at);
  // Level characters need not be letters.
  const name = word ? view.state.sliceDoc(word.from, word.to) : view.state.sliceDoc(at, at + 1).trim();
  if (name) call(at, name);
}

/** Goes to where the name under the cursor is defined. */
async function define(view: EditorView): Promise<void> {
  const { doc } = view.state;
  try {
    const found = await post<{ start: number; end: number } | null>('/api/definition', { source: doc.toString(), at: view.state.selection.main.head });
    if (found && view.state.doc.eq(doc)) view.dispatch({ selection: { anchor: found.start, head: found.end }, scrollIntoView: true });
  } catch {
    return; // Stays where it is.
  }
}

/** Opens the manual page of the problem under the cursor, else of the word there. */
function explain(view: EditorView, props: Props): void {
  const at = view.state.selection.main.head;
  const problem = props.problems.find((one) => one.page && one.start <= at && at <= one.end);
  const word = view.state.wordAt(at);
  if (problem?.page) props.onPage(problem.page);
  else props.onPage(word ? view.state.sliceDoc(word.from, word.to) : 'first-game');
}

/** Applies the first fix on the cursor's line; shows the list of problems if there is none. */
function quickFix(view: EditorView, props: Props): void {
  const line = view.state.doc.lineAt(view.state.selection.main.head);
  const problem = props.problems.find((one) => one.fixes.length > 0 && one.start <= line.to && one.end >= line.from);
  const fix = problem?.fixes[0];
  if (fix && view.state.doc.toString() === props.checked) applyEdits(view, fix.edits);
  else openLintPanel(view);
}
