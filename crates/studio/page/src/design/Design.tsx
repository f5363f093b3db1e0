import { useEffect, useMemo, useRef, useState } from 'preact/hooks';
import { Failure, get, post, put, remove, segment, words } from '../data/api';
import { numberOf, replay } from '../data/studio';
import { Run } from '../data/run';
import type { Check, Edit, Episode, Game, Problem, RuleSpan } from '../data/types';
import type { Highlight } from '../parts/Board';
import { Dialog } from '../parts/Dialog';
import { Icon } from '../parts/Icon';
import { Markdown, Words } from '../parts/Markdown';
import { Player } from '../parts/Player';
import { arrows } from '../parts/arrows';
import { useTitle } from '../parts/hooks';
import { go, leaving } from '../parts/route';
import { isTurnBased } from '../views/Play';
import { parse, widthOf } from './grid';
import { LevelEditor, spanOf } from './LevelEditor';
import { MorePanel } from './MorePanel';
import { Problems } from './Problems';
import { type EditorHandle, RulesEditor } from './RulesEditor';
import { VerdictPanel } from './VerdictPanel';

/** A file as it is edited: its text now, and what was last saved or read. */
interface Draft {
  name: string;
  text: string;
  saved: string;
  base: string | null;
}

interface Conflict {
  name: string;
  theirs: string;
  digest: string | null;
}

const EMPTY: Check = { problems: [], levels: [], describe: '', legend: [], tiles: [] };

type Panel = 'verdict' | 'words' | 'more' | 'page';

export function Design({ game, level, onChanged }: { game: Game; level: number; onChanged: () => void }) {
  const [source, setSource] = useState<Draft>(() => draft(game.source));
  const [levels, setLevels] = useState<Draft[]>(() => game.levels.map(draft));
  const [check, setCheck] = useState<Check>(EMPTY);
  const [checked, setChecked] = useState('');
  const [checkedLevels, setCheckedLevels] = useState<string[]>([]);
  const [sound, setSound] = useState(game.source.text);
  const [panel, setPanel] = useState<Panel>('verdict');
  const [pane, setPane] = useState<'rules' | 'board' | 'panel'>('board');
  const [page, setPage] = useState<{ name: string; markdown: string } | null>(null);
  const [run, setRun] = useState<Run | null>(null);
  const [runName, setRunName] = useState('');
  const [highlights, setHighlights] = useState<Highlight[]>([]);
  const [notice, setNotice] = useState<{ text: string; bad: boolean } | null>(null);
  const [conflict, setConflict] = useState<Conflict | null>(null);
  const [renaming, setRenaming] = useState<{ at: number; word: string } | null>(null);
  const [copying, setCopying] = useState(false);
  const [removing, setRemoving] = useState(false);
  const [brush, setBrush] = useState<string | null>(null);
  const pasts = useRef(new Map<string, { past: string[]; future: string[]; stroke: number }>());
  const editor = useRef<EditorHandle>(null);
  const saves = useRef(0);
  const saving = useRef(false);
  const runs = useRef(0);
  const pages = useRef(0);
  const at = Math.max(0, Math.min(level, levels.length - 1));
  const now = levels[at];
  const number = numberOf(levels, at);
  const texts = useMemo(() => levels.map((one) => one.text), [levels]);
  const dirty = [source, ...levels].filter((one) => one.text !== one.saved);
  const state = useRef({ source, levels });
  state.current = { source, levels };
  useTitle(`${dirty.length > 0 ? '● ' : ''}${game.title}, design`);

  useEffect(() => {
    const abort = new AbortController();
    const timer = window.setTimeout(() => {
      post<Check>('/api/check', { source: source.text, levels: texts }, abort.signal).then(
        (answer) => {
          // The palette of the last rules that compiled stays.
          setCheck((before) => (answer.legend.length > 0 ? answer : { ...answer, legend: before.legend, tiles: before.tiles }));
          setChecked(source.text);
          setCheckedLevels(texts);
          // Boards are drawn by the last rules that compiled.
          if (!answer.problems.some((problem) => problem.severity === 'error')) setSound(source.text);
        },
        (failure: unknown) => {
          if (!abort.signal.aborted) setNotice({ text: words(failure), bad: true });
        },
      );
    }, 80);
    return () => {
      window.clearTimeout(timer);
      abort.abort();
    };
  }, [source.text, texts]);

  useEffect(() => {
    setHighlights([]);
    stopRun();
  }, [at]);
  useEffect(() => () => run?.close(), [run]);
  useEffect(() => () => { runs.current += 1; }, []);

  useEffect(() => {
    const unsaved = (): boolean => [state.current.source, ...state.current.levels].some((one) => one.text !== one.saved);
    const before = (event: BeforeUnloadEvent): void => {
      if (unsaved()) event.preventDefault();
    };
    leaving.ask = () => {
      const here = location.hash.startsWith(`#/design/${segment(game.id)}/`);
      return here || !unsaved() || window.confirm('There are unsaved changes. Leave without them?');
    };
    window.addEventListener('beforeunload', before);
    return () => {
      leaving.ask = null;
      window.removeEventListener('beforeunload', before);
    };
  }, [game.id]);

  useEffect(() => {
    const timer = window.setInterval(() => void lookOutside(), 2000);
    return () => window.clearInterval(timer);
  }, [game.id]);

  /** Takes over what changed outside where nothing is unsaved; otherwise says so. */
  const lookOutside = async (): Promise<void> => {
    if (document.hidden) return;
    const began = saves.current;
    try {
      const { files } = await get<{ files: Record<string, string> }>(`/api/games/${segment(game.id)}/versions`);
      const before = [state.current.source, ...state.current.levels];
      const known = new Map(before.map((one) => [one.name, one]));
      const changed = Object.entries(files).filter(([name, digest]) => known.get(name)?.base !== digest);
      const isGone = (one: Draft): boolean => one.base !== null && !(one.name in files);
      if ((changed.length === 0 && !before.some(isGone)) || began !== saves.current) return;
      const fresh = await get<Game>(`/api/games/${segment(game.id)}`);
      if (began !== saves.current) return;
      // As it is now: someone may have typed while the files were read.
      const { source, levels } = state.current;
      const taken: string[] = [];
      const kept: string[] = [];
      const renew = (one: Draft): Draft => {
        const file = [fresh.source, ...fresh.levels].find((other) => other.name === one.name);
        // Saving writes it anew.
        if (!file && one.base !== null) return { ...one, saved: '', base: null };
        if (!file || file.digest === one.base) return one;
        if (one.text === file.text) return { ...one, saved: file.text, base: file.digest };
        if (one.text !== one.saved) {
          kept.push(one.name);
          return one;
        }
        taken.push(one.name);
        return draft(file);
      };
      const nextSource = renew(source);
      const gone = levels.filter((one) => one.base !== null && one.text === one.saved && !fresh.levels.some((file) => file.name === one.name));
      const nextLevels = levels.filter((one) => !gone.includes(one)).map(renew);
      for (const file of fresh.levels) {
        if (nextLevels.some((one) => one.name === file.name)) continue;
        taken.push(file.name);
        nextLevels.push(draft(file));
      }
      if (nextSource !== source) {
        editor.current?.replace(nextSource.text);
        setSource(nextSource);
      }
      setLevels(nextLevels);
      if (kept.length > 0) setNotice({ text: `${kept.join(', ')} changed outside, and here too. When you save, you choose which version to keep.`, bad: true });
      else if (taken.length > 0) setNotice({ text: `${taken.join(', ')} changed outside and was reloaded.`, bad: false });
      else if (gone.length > 0) setNotice({ text: `${gone.map((one) => one.name).join(', ')} was removed outside.`, bad: false });
    } catch {
      return; // The next look may succeed; saving reports what is wrong.
    }
  };

  const setFile = (name: string, change: (one: Draft) => Draft): void => {
    setSource((one) => (one.name === name ? change(one) : one));
    setLevels((all) => all.map((one) => (one.name === name ? change(one) : one)));
  };

  const save = async (): Promise<void> => {
    if (!game.writable) return setCopying(true);
    if (saving.current) return undefined;
    if (dirty.length === 0) return setNotice({ text: 'Everything is saved.', bad: false });
    saving.current = true;
    try {
      await saveAll();
    } finally {
      saving.current = false;
    }
    return undefined;
  };
  const saveAll = async (): Promise<void> => {
    for (const file of dirty) {
      saves.current += 1;
      try {
        const { digest } = await put<{ digest: string }>(`/api/games/${segment(game.id)}/files/${segment(file.name)}`, { text: file.text, base: file.base });
        setFile(file.name, (one) => ({ ...one, saved: file.text, base: digest }));
      } catch (failure) {
        if (failure instanceof Failure && failure.status === 409) {
          const { text, digest } = failure.body;
          setConflict({ name: file.name, theirs: typeof text === 'string' ? text : '', digest: typeof digest === 'string' ? digest : null });
        } else setNotice({ text: words(failure), bad: true });
        return undefined;
      } finally {
        saves.current += 1;
      }
    }
    setNotice({ text: `Saved ${dirty.map((one) => one.name).join(', ')}.`, bad: false });
    return onChanged();
  };

  // Set while drawing: an effect would come after a key that is pressed at once.
  const latestSave = useRef(save);
  latestSave.current = save;
  useEffect(() => {
    const keys = (event: KeyboardEvent): void => {
      if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === 's' && !event.defaultPrevented) {
        event.preventDefault();
        void latestSave.current();
      }
    };
    window.addEventListener('keydown', keys);
    return () => window.removeEventListener('keydown', keys);
  }, []);
  useEffect(() => {
    if (!notice || notice.bad) return undefined;
    const timer = window.setTimeout(() => setNotice(null), 4000);
    return () => window.clearTimeout(timer);
  }, [notice]);

  const past = (name: string) => {
    let found = pasts.current.get(name);
    if (!found) pasts.current.set(name, (found = { past: [], future: [], stroke: -1 }));
    return found;
  };
  const edit = (text: string, stroke: number): void => {
    if (!now || text === now.text) return;
    const history = past(now.name);
    if (history.stroke !== stroke) history.past.push(now.text);
    history.stroke = stroke;
    history.future = [];
    setHighlights([]);
    setFile(now.name, (one) => ({ ...one, text }));
  };
  const travel = (from: 'past' | 'future', to: 'past' | 'future'): void => {
    if (!now) return;
    const history = past(now.name);
    const text = history[from].pop();
    if (text === undefined) return;
    history[to].push(now.text);
    history.stroke = -1;
    setHighlights([]);
    setFile(now.name, (one) => ({ ...one, text }));
  };
  const addLevel = (text: string): void => {
    const number = 1 + Math.max(-1, ...levels.map((one) => Number(/\d+/.exec(one.name)?.[0] ?? -1)));
    setLevels([...levels, { name: `lvl${number}.txt`, text, saved: '', base: null }]);
    go('design', game.id, levels.length);
  };

  /** Removes the last level, from the disk too if it was saved. */
  const removeLevel = async (): Promise<void> => {
    const last = levels[levels.length - 1];
    if (!last) return;
    saves.current += 1;
    try {
      if (last.base !== null) await remove(`/api/games/${segment(game.id)}/files/${segment(last.name)}`, { base: last.base });
    } finally {
      saves.current += 1;
    }
    pasts.current.delete(last.name);
    setLevels((all) => all.filter((one) => one.name !== last.name));
    setRemoving(false);
    setNotice({ text: `Removed ${last.name}.`, bad: false });
    go('design', game.id, Math.max(0, levels.length - 2));
    if (last.base !== null) onChanged();
  };

  const stopRun = (): void => {
    runs.current += 1;
    setRun((before) => { before?.close(); return null; });
  };
  const showRun = (make: Promise<Run>, name: string, then?: (run: Run) => void): void => {
    runs.current += 1;
    const mine = runs.current;
    make.then(
      (made) => {
        // Something else was asked for meanwhile.
        if (mine !== runs.current) return made.close();
        setRun((before) => { before?.close(); return made; });
        setRunName(name);
        setPane('board');
        return then?.(made);
      },
      (failure: unknown) => { if (mine === runs.current) setNotice({ text: words(failure), bad: true }); },
    );
  };
  const tryOut = (): void => showRun(Run.begin(source.text, now?.text ?? '', 'design', isTurnBased(null, check.describe)), 'Trying it out');
  const watch = (episode: Episode, tick: number | null, name: string): void =>
    showRun(replay(source.text, now?.text ?? '', episode).then((answer) => Run.replay(answer)), name, (made) => (tick === null ? made.start() : made.go(tick)));
  const showCells = (cells: [number, number][]): void => {
    setHighlights(cells.map(([x, y]) => ({ x, y })));
    setPane('board');
  };
  const showRule = (rule: RuleSpan): void => {
    setPane('rules');
    // The editor can take the focus only once its pane is shown.
    window.setTimeout(() => editor.current?.show(rule.start, rule.end), 0);
  };
  const showProblem = (problem: Problem): void => {
    setPane('rules');
    window.setTimeout(() => editor.current?.show(problem.start, problem.end), 0);
  };
  const showPage = (name: string): void => {
    pages.current += 1;
    const mine = pages.current;
    post<{ markdown: string }>('/api/page', { name }).then(
      ({ markdown }) => {
        if (mine !== pages.current) return;
        setPage({ name, markdown });
        setPanel('page');
        setPane('panel');
      },
      (failure: unknown) => { if (mine === pages.current) setNotice({ text: words(failure), bad: true }); },
    );
  };
  const format = (): void => {
    const asked = source.text;
    post<{ text: string }>('/api/format', { source: asked }).then(
      // Whoever typed on does not lose that.
      ({ text }) => { if (state.current.source.text === asked) editor.current?.replace(text); },
      (failure: unknown) => setNotice({ text: words(failure), bad: true }),
    );
  };

  // Only the last one, so that the numbers have no gap; a game keeps one level.
  const removable = levels.length > 1 && at === levels.length - 1 && (game.writable || now?.base === null);
  const grid = parse(now?.text ?? '');
  const problems = checked === source.text ? check.problems : [];
  const levelProblems = check.levels[at]?.problems ?? [];
  return (
    <main class="design" data-pane={pane}>
      <div class="bar">
        <h1 class="hidden">{`${game.title}, design`}</h1>
        <nav class="tabs" aria-label="Levels">
          {levels.map((one, index) => (
            <a href={`#/design/${segment(game.id)}/${index}`} aria-current={index === at ? 'page' : undefined} title={one.name} class={check.levels[index]?.problems.some((problem) => problem.severity === 'error') ? 'wrong' : ''}>
              {numberOf(levels, index)}{one.text !== one.saved && <span class="unsaved" aria-label="unsaved">●</span>}
            </a>
          ))}
          <button type="button" aria-label="Add a level" title="Add a level" onClick={() => addLevel(now?.text ?? '')}><Icon name="plus" /></button>
          {removable && <button type="button" aria-label="Remove this level" title="Remove this level" onClick={() => setRemoving(true)}><Icon name="minus" /></button>}
        </nav>
        <div class="segments panes" role="group" aria-label="Shown">
          {(['rules', 'board', 'panel'] as const).map((one) => (
            <button type="button" aria-pressed={pane === one} onClick={() => setPane(one)}>{one === 'panel' ? 'Verdict' : one === 'rules' ? 'Rules' : 'Board'}</button>
          ))}
        </div>
        <p class={`said ${notice?.bad ? 'bad' : ''}`} role="status">{notice && <Words text={notice.text} />}</p>
        {run === null
          ? <button type="button" onClick={tryOut}><Icon name="play" /> Try it</button>
          : <button type="button" onClick={stopRun}>Back to painting</button>}
        <button type="button" class="quiet" onClick={() => showPage('first-game')}>Help</button>
        <button type="button" class={dirty.length > 0 ? 'strong' : ''} onClick={() => void save()} title="Save (Ctrl-S)"><Icon name="save" /> {game.writable ? 'Save' : 'Save a copy'}</button>
      </div>

      <section class="pane rules-pane" aria-label="Rules">
        <header><h2>{source.name}{source.text !== source.saved && <span class="unsaved" aria-label="unsaved">●</span>}</h2>
          <span class="row">
            <button type="button" class="quiet" onClick={() => editor.current?.explain()} title="Explain the word at the cursor (F1)">Explain <kbd>F1</kbd></button>
            <button type="button" class="quiet" onClick={format} title="Format (Shift-Alt-F)">Format</button>
          </span>
        </header>
        <RulesEditor
          handle={editor}
          text={source.text}
          problems={check.problems}
          checked={checked}
          onChange={(text) => setSource((one) => ({ ...one, text }))}
          onRename={(place, word) => setRenaming({ at: place, word })}
          onFormat={format}
          onSave={() => void save()}
          onPage={showPage}
        />
        <Problems name="Problems" problems={problems} onShow={showProblem} onPage={showPage} onFix={(edits) => { if (checked === source.text) editor.current?.apply(edits); }} />
      </section>

      <section class="pane board-pane" aria-label={run ? runName : `Level ${number}`}>
        {run ? (
          <div class="stage"><p class="run-name">{runName}</p><Player run={run} keys="page" label={`${game.title}, level ${number}`} /></div>
        ) : now ? (
          <LevelEditor
            key={now.name}
            source={sound}
            text={now.text}
            legend={check.legend}
            tiles={check.tiles}
            problems={levelProblems}
            highlights={highlights}
            brush={brush}
            onBrush={setBrush}
            onChange={edit}
            onUndo={() => travel('past', 'future')}
            onRedo={() => travel('future', 'past')}
            canUndo={past(now.name).past.length > 0}
            canRedo={past(now.name).future.length > 0}
          />
        ) : (
          <p class="empty">This game has no level yet. <button type="button" onClick={() => addLevel('wwwwwwww\nw......w\nw......w\nwwwwwwww\n')}>Add one</button></p>
        )}
        {run === null && now && (
          <Problems
            name="Problems of the level"
            problems={levelProblems}
            onShow={(problem) => showCells(spanOf(problem))}
            onPage={showPage}
            onFix={(edits) => { if (checkedLevels[at] === now.text) edit(applied(now.text, edits), -2 - Math.random()); }}
          />
        )}
      </section>

      <section class="pane side-pane" aria-label="What the suite says">
        <div class="tablist" role="tablist" onKeyDown={arrows}>
          {([['verdict', 'Verdict'], ['words', 'In words'], ['more', 'More like this'], ...(page ? [['page', 'Manual']] : [])] as [Panel, string][]).map(([name, label]) => (
            <button type="button" role="tab" tabIndex={panel === name ? 0 : -1} aria-selected={panel === name} onClick={() => setPanel(name)}>{label}</button>
          ))}
        </div>
        <div class="panel" role="tabpanel">
          {/* The verdict goes on in the background: it is what one comes back to. */}
          <div hidden={panel !== 'verdict'}>
            {now && <VerdictPanel source={source.text} level={now.text} levels={texts} onCells={showCells} onRule={showRule} onEpisode={watch} />}
          </div>
          {panel === 'words' && <Markdown text={check.describe || 'The rules do not compile yet.'} />}
          {panel === 'more' && now && <MorePanel source={source.text} level={now.text} width={widthOf(grid)} height={grid.length} onUse={(text) => edit(text, -2 - Math.random())} onAdd={addLevel} />}
          {panel === 'page' && page && <Markdown text={page.markdown} />}
        </div>
      </section>

      {conflict && (
        <ConflictDialog
          conflict={conflict}
          mine={[source, ...levels].find((one) => one.name === conflict.name)?.text ?? ''}
          onClose={() => setConflict(null)}
          onMine={() => {
            setFile(conflict.name, (one) => ({ ...one, base: conflict.digest, saved: conflict.theirs }));
            setConflict(null);
            setNotice({ text: 'Your text is kept. Save again to write it.', bad: false });
          }}
          onTheirs={() => {
            setFile(conflict.name, (one) => ({ ...one, text: conflict.theirs, saved: conflict.theirs, base: conflict.digest }));
            if (conflict.name === source.name) editor.current?.replace(conflict.theirs);
            setConflict(null);
          }}
        />
      )}
      {renaming && (
        <RenameDialog
          word={renaming.word}
          onClose={() => setRenaming(null)}
          onRename={async (name) => {
            const asked = { source: source.text, levels: texts };
            const made = await post<{ edits: Edit[]; levels: Edit[][] }>('/api/rename', { ...asked, at: renaming.at, name });
            setRenaming(null);
            if (state.current.source.text !== asked.source) return setNotice({ text: 'The rules changed in the meantime, so nothing was renamed.', bad: true });
            window.setTimeout(() => editor.current?.apply(made.edits), 0);
            // A level character changes in the levels too.
            levels.forEach((one, index) => {
              const edits = made.levels[index] ?? [];
              if (edits.length === 0) return;
              past(one.name).past.push(one.text);
              setFile(one.name, (now) => (now.text === asked.levels[index] ? { ...now, text: applied(now.text, edits) } : now));
            });
            return undefined;
          }}
        />
      )}
      {removing && now && <RemoveDialog level={number} name={now.name} isSaved={now.base !== null} onClose={() => setRemoving(false)} onRemove={removeLevel} />}
      {copying && (
        <CopyWithChanges
          game={game}
          onClose={() => setCopying(false)}
          onCopy={async (title) => {
            const { id } = await post<{ id: string }>('/api/copy', { id: game.id, title });
            const made = await get<Game>(`/api/games/${segment(id)}`);
            const bases = new Map([made.source, ...made.levels].map((one) => [one.name, one.digest]));
            for (const [name, text] of [[made.source.name, source.text] as const, ...levels.map((one, index) => [`lvl${index}.txt`, one.text] as const)]) {
              await put(`/api/games/${segment(id)}/files/${segment(name)}`, { text, base: bases.get(name) ?? null });
            }
            setSource((one) => ({ ...one, saved: one.text }));
            setLevels((all) => all.map((one) => ({ ...one, saved: one.text })));
            state.current = { source: { ...source, saved: source.text }, levels: levels.map((one) => ({ ...one, saved: one.text })) };
            setCopying(false);
            onChanged();
            go('design', id, at);
          }}
        />
      )}
    </main>
  );
}

/** A text with edits made, whose places are those of the text before. */
function applied(text: string, edits: Edit[]): string {
  return [...edits].sort((a, b) => b.start - a.start).reduce((made, { start, end, text: put }) => made.slice(0, start) + put + made.slice(end), text);
}

function draft(file: { name: string; text: string; digest: string }): Draft {
  return { name: file.name, text: file.text, saved: file.text, base: file.digest };
}

function ConflictDialog({ conflict, mine, onClose, onMine, onTheirs }: { conflict: Conflict; mine: string; onClose: () => void; onMine: () => void; onTheirs: () => void }) {
  const theirLines = new Set(conflict.theirs.split('\n'));
  const myLines = new Set(mine.split('\n'));
  const side = (title: string, text: string, other: Set<string>) => (
    <div><h3>{title}</h3><pre tabIndex={0} aria-label={title}>{text.split('\n').map((line) => <span class={other.has(line) ? '' : 'differs'}>{`${line}\n`}</span>)}</pre></div>
  );
  return (
    <Dialog title={`${conflict.name} changed outside`} onClose={onClose}>
      <p>Another program changed this file after the studio read it. Lines that the other text lacks are marked.</p>
      <div class="compare">{side('Yours', mine, theirLines)}{side('In the file', conflict.theirs, myLines)}</div>
      <div class="buttons">
        <button type="button" onClick={onClose}>Decide later</button>
        <button type="button" onClick={onTheirs}>Take the file's</button>
        <button type="button" class="strong" onClick={onMine}>Keep mine</button>
      </div>
    </Dialog>
  );
}

function RemoveDialog({ level, name, isSaved, onClose, onRemove }: { level: number; name: string; isSaved: boolean; onClose: () => void; onRemove: () => Promise<void> }) {
  const [error, setError] = useState<string | null>(null);
  return (
    <Dialog title={`Remove level ${level}?`} onClose={onClose}>
      <p>{isSaved ? <>The file <code>{name}</code> is deleted from the disk. This cannot be undone.</> : <><code>{name}</code> was never saved. This cannot be undone.</>}</p>
      {error && <p class="notice bad" role="alert">{error}</p>}
      <div class="buttons">
        <button type="button" onClick={onClose} autofocus>Keep it</button>
        <button type="button" class="strong" onClick={() => void onRemove().catch((failure: unknown) => setError(words(failure)))}>Remove it</button>
      </div>
    </Dialog>
  );
}

function RenameDialog({ word, onClose, onRename }: { word: string; onClose: () => void; onRename: (name: string) => Promise<void> }) {
  const [name, setName] = useState(word);
  const [error, setError] = useState<string | null>(null);
  return (
    <Dialog title={`Rename ${word}`} onClose={onClose}>
      <form onSubmit={(event) => { event.preventDefault(); onRename(name).catch((failure: unknown) => setError(words(failure))); }}>
        <label class="field">New name<input value={name} onInput={(event) => setName(event.currentTarget.value)} autofocus /></label>
        {error && <p class="notice bad" role="alert">{error}</p>}
        <div class="buttons"><button type="button" onClick={onClose}>Cancel</button><button type="submit" class="strong" disabled={!name.trim() || name === word}>Rename everywhere</button></div>
      </form>
    </Dialog>
  );
}

function CopyWithChanges({ game, onClose, onCopy }: { game: Game; onClose: () => void; onCopy: (title: string) => Promise<void> }) {
  const [title, setTitle] = useState(`${game.title} (mine)`);
  const [error, setError] = useState<string | null>(null);
  return (
    <Dialog title="Save a copy" onClose={onClose}>
      <p>{game.title} itself stays as it is. The copy, with your changes, is written to a new folder.</p>
      <form onSubmit={(event) => { event.preventDefault(); onCopy(title).catch((failure: unknown) => setError(words(failure))); }}>
        <label class="field">Title<input value={title} onInput={(event) => setTitle(event.currentTarget.value)} autofocus /></label>
        {error && <p class="notice bad" role="alert">{error}</p>}
        <div class="buttons"><button type="button" onClick={onClose}>Cancel</button><button type="submit" class="strong" disabled={!title.trim()}>Save</button></div>
      </form>
    </Dialog>
  );
}
