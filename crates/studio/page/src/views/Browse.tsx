import { useMemo, useState } from 'preact/hooks';
import { live } from '../data/studio';
import * as studio from '../data/studio';
import type { GameEntry, Release, Workspace } from '../data/types';
import { Thumb } from '../parts/Board';
import { Icon } from '../parts/Icon';
import { useAsked, useTitle } from '../parts/hooks';
import { go, href } from '../parts/route';
import { NewDialog } from './NewDialog';

/** What the gallery shows of a game, with a release's facts where there are any. */
interface Shown {
  entry: GameEntry;
  kind: string | null;
  tiers: string[];
  difficulties: string[];
}

function shown(entry: GameEntry, release: Release | null): Shown {
  const released = release?.games.find((game) => game.id === entry.id);
  const merged = released ? { ...entry, tile: entry.tile ?? released.frame, tiles: entry.tile ? entry.tiles : released.tiles } : entry;
  return {
    entry: merged,
    kind: released?.kind ?? entry.kind,
    tiers: unique(released?.levels.map((level) => (level.tier === null ? null : String(level.tier))) ?? []).sort(),
    difficulties: byEase(unique(released?.levels.map((level) => level.difficulty) ?? [])),
  };
}

function unique(words: (string | null | undefined)[]): string[] {
  return [...new Set(words.filter((word): word is string => Boolean(word)))];
}

export const EASE = ['very_easy', 'easy', 'medium', 'hard', 'very_hard', 'unbeaten'];

/** Labels of difficulty, the easiest first. */
export function byEase(labels: string[]): string[] {
  return [...labels].sort((a, b) => EASE.indexOf(a) - EASE.indexOf(b));
}

export function tierWords(tier: string | number): string {
  return `tier ${tier}`;
}

export function easeWords(label: string): string {
  return label.replaceAll('_', ' ');
}

/** The span of labels, such as "easy to hard". */
export function easeSpan(labels: string[]): string | null {
  const [first, last] = [labels[0], labels[labels.length - 1]];
  if (first === undefined || last === undefined) return null;
  return first === last ? easeWords(first) : `${easeWords(first)} to ${easeWords(last)}`;
}

function counted(count: number, of: string): string {
  return `${count} ${of}${count === 1 ? '' : 's'}`;
}

export function Browse({ workspace, onChanged }: { workspace: Workspace; onChanged: () => void }) {
  useTitle('');
  const [beginning, setBeginning] = useState(false);
  const writes = workspace.templates.length > 0 && (workspace.kind === 'games' || workspace.kind === 'corpus');
  const [text, setText] = useState('');
  const [kind, setKind] = useState('');
  const [tier, setTier] = useState('');
  const [ease, setEase] = useState('');
  const release = useAsked<Release | null>(() => (workspace.kind === 'snapshot' ? studio.release() : Promise.resolve(null)), [workspace]);
  const all = useMemo(() => workspace.games.map((entry) => shown(entry, release.value)), [workspace, release.value]);
  const kinds = unique(all.map((one) => one.kind)).sort();
  const tiers = unique(all.flatMap((one) => one.tiers)).sort();
  const eases = byEase(unique(all.flatMap((one) => one.difficulties)));
  const wanted = text.trim().toLowerCase();
  const games = all.filter(
    (one) =>
      (!wanted || `${one.entry.title} ${one.entry.id} ${one.entry.summary} ${one.kind ?? ''}`.toLowerCase().includes(wanted)) &&
      (!kind || one.kind === kind) &&
      (!tier || one.tiers.includes(tier)) &&
      (!ease || one.difficulties.includes(ease)),
  );
  return (
    <main class="browse">
      <header class="heading">
        <div>
          <h1>{workspace.kind === 'corpus' ? 'The corpus' : workspace.name}</h1>
          <p class="soft">
            {games.length === all.length ? counted(all.length, 'game') : `${games.length} of ${counted(all.length, 'game')}`}
            {workspace.kind === 'snapshot' && <> · <a href={href('release')}>about this release</a></>}
          </p>
        </div>
        <form class="filters" role="search" onSubmit={(event) => {
          event.preventDefault();
          const first = games[0];
          if (first) go('game', first.entry.id);
        }}>
          <input type="search" placeholder="Find a game" aria-label="Find a game" value={text} onInput={(event) => setText(event.currentTarget.value)} />
          {kinds.length > 1 && <Choice label="Kind" all="All kinds" value={kind} options={kinds} onChange={setKind} />}
          {tiers.length > 1 && <Choice label="Tier" all="All tiers" value={tier} options={tiers} words={tierWords} onChange={setTier} />}
          {writes && all.length > 0 && <button type="button" onClick={() => setBeginning(true)}><Icon name="plus" /> New game</button>}
          {eases.length > 1 && <Choice label="Difficulty" all="Any difficulty" value={ease} options={eases} words={easeWords} onChange={setEase} />}
        </form>
      </header>
      {release.error && <p class="notice bad" role="alert">{release.error}</p>}
      {games.length === 0 && (
        <p class="empty">
          {all.length === 0 ? 'There are no games here yet.' : 'No game matches.'}
          {all.length === 0 && writes && <button type="button" class="strong" onClick={() => setBeginning(true)}><Icon name="plus" /> New game</button>}
          {all.length > 0 && <button type="button" onClick={() => { setText(''); setKind(''); setTier(''); setEase(''); }}>Show all</button>}
        </p>
      )}
      <ul class="cards">
        {games.map((one) => (
          <li key={one.entry.id}>
            <a class="card" href={href('game', one.entry.id)}>
              <Thumb tiles={one.entry.tiles} frame={one.entry.tile} label={`Board of ${one.entry.title}`} />
              <span class="name">{one.entry.title}</span>
              {one.entry.summary && <span class="summary">{one.entry.summary}</span>}
              <span class="facts">
                {one.kind && <span class="chip">{one.kind}</span>}
                {one.tiers.map((number) => <span class="chip">{tierWords(number)}</span>)}
                <span class="soft">{counted(one.entry.levels, 'level')}</span>
                {one.difficulties.length > 0 && <span class="soft">{easeSpan(one.difficulties)}</span>}
                {live && one.entry.writable && <span class="soft">yours</span>}
              </span>
            </a>
          </li>
        ))}
      </ul>
      {beginning && <NewDialog workspace={workspace} onClose={() => setBeginning(false)} onBegun={onChanged} />}
    </main>
  );
}

export function Choice({ label, all, value, options, words, onChange }: { label: string; all?: string; value: string; options: readonly string[]; words?: (option: string) => string; onChange: (value: string) => void }) {
  return (
    <select aria-label={label} value={value} onChange={(event) => onChange(event.currentTarget.value)}>
      {all !== undefined && <option value="">{all}</option>}
      {options.map((one) => <option value={one}>{words ? words(one) : one}</option>)}
    </select>
  );
}
