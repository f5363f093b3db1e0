import { useMemo, useState } from 'preact/hooks';
import { live } from '../data/studio';
import * as studio from '../data/studio';
import type { GameEntry, Release, Workspace } from '../data/types';
import { Thumb } from '../parts/Board';
import { useAsked, useTitle } from '../parts/hooks';
import { go, href } from '../parts/route';

/** What the gallery shows of a game, with a release's facts where there are any. */
interface Shown {
  entry: GameEntry;
  kind: string | null;
  tiers: string[];
  difficulty: [number, number] | null;
}

function shown(entry: GameEntry, release: Release | null): Shown {
  const released = release?.games.find((game) => game.id === entry.id);
  const tiers = released ? unique(released.levels.map((level) => level.tier)) : unique([entry.tier]);
  const numbers = (released?.levels.map((level) => level.difficulty) ?? [entry.difficulty])
    .filter((one) => one !== null && one !== undefined && one !== '')
    .map(Number)
    .filter((one) => Number.isFinite(one));
  const merged = released ? { ...entry, tile: entry.tile ?? released.frame, tiles: entry.tile ? entry.tiles ?? released.tiles : released.tiles } : entry;
  return {
    entry: merged,
    kind: released?.kind ?? entry.kind ?? null,
    tiers,
    difficulty: numbers.length ? [Math.min(...numbers), Math.max(...numbers)] : null,
  };
}

function unique(words: (string | null | undefined)[]): string[] {
  return [...new Set(words.filter((word): word is string => Boolean(word)))];
}

export function difficultyWords(range: [number, number] | null): string | null {
  if (!range) return null;
  const [low, high] = range.map((one) => one.toFixed(Number.isInteger(one) ? 0 : 2));
  return low === high ? `difficulty ${low}` : `difficulty ${low}–${high}`;
}

export function Browse({ workspace }: { workspace: Workspace }) {
  useTitle('');
  const [text, setText] = useState('');
  const [kind, setKind] = useState('');
  const [tier, setTier] = useState('');
  const release = useAsked<Release | null>(() => (workspace.kind === 'snapshot' ? studio.release() : Promise.resolve(null)), [workspace]);
  const all = useMemo(() => workspace.games.map((entry) => shown(entry, release.value)), [workspace, release.value]);
  const kinds = unique(all.map((one) => one.kind)).sort();
  const tiers = unique(all.flatMap((one) => one.tiers)).sort();
  const wanted = text.trim().toLowerCase();
  const games = all.filter(
    (one) =>
      (!wanted || `${one.entry.title} ${one.entry.id} ${one.entry.summary} ${one.kind ?? ''}`.toLowerCase().includes(wanted)) &&
      (!kind || one.kind === kind) &&
      (!tier || one.tiers.includes(tier)),
  );
  return (
    <main class="browse">
      <header class="heading">
        <div>
          <h1>{workspace.name}</h1>
          <p class="soft">
            {games.length === all.length ? `${all.length} games` : `${games.length} of ${all.length} games`}
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
          {tiers.length > 1 && <Choice label="Tier" all="All tiers" value={tier} options={tiers} onChange={setTier} />}
        </form>
      </header>
      {release.error && <p class="notice bad" role="alert">{release.error}</p>}
      {games.length === 0 && (
        <p class="empty">
          {all.length === 0 ? 'There are no games here yet.' : 'No game matches.'}
          {all.length > 0 && <button type="button" onClick={() => { setText(''); setKind(''); setTier(''); }}>Show all</button>}
        </p>
      )}
      <ul class="cards">
        {games.map((one) => (
          <li key={one.entry.id}>
            <a class="card" href={href('game', one.entry.id)}>
              <Thumb tiles={one.entry.tiles ?? workspace.tiles ?? []} frame={one.entry.tile} label={`Board of ${one.entry.title}`} />
              <span class="name">{one.entry.title}</span>
              {one.entry.summary && <span class="summary">{one.entry.summary}</span>}
              <span class="facts">
                {one.kind && <span class="chip">{one.kind}</span>}
                {one.tiers.map((word) => <span class="chip">{word}</span>)}
                <span class="soft">{one.entry.levels} {one.entry.levels === 1 ? 'level' : 'levels'}</span>
                {one.difficulty && <span class="soft">{difficultyWords(one.difficulty)}</span>}
                {live && one.entry.writable && <span class="soft">yours</span>}
              </span>
            </a>
          </li>
        ))}
      </ul>
    </main>
  );
}

export function Choice({ label, all, value, options, onChange }: { label: string; all?: string; value: string; options: readonly string[]; onChange: (value: string) => void }) {
  return (
    <select aria-label={label} value={value} onChange={(event) => onChange(event.currentTarget.value)}>
      {all !== undefined && <option value="">{all}</option>}
      {options.map((one) => <option value={one}>{one}</option>)}
    </select>
  );
}
