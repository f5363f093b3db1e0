import { useEffect, useState } from 'preact/hooks';
import { stream, words } from '../data/api';
import type { MoreLine, Tile } from '../data/types';
import { Thumb } from '../parts/Board';
import { EASE, easeWords } from '../views/Browse';

type Made = Extract<MoreLine, { stage: 'level' }>;

const METHODS = [
  ['constructive', 'built up'],
  ['search', 'searched'],
  ['evolutionary', 'evolved'],
] as const;

/** How far ahead a winner has to see: the suite's tiers. */
const TIERS = ['1', '2', '3', '4'] as const;

/** Levels made for these rules; one that is liked replaces the level shown or becomes a new one. */
export function MorePanel({ source, level, width, height, onUse, onAdd }: { source: string; level: string; width: number; height: number; onUse: (text: string) => void; onAdd: (text: string) => void }) {
  const [method, setMethod] = useState<string>('constructive');
  const [columns, setColumns] = useState(String(width));
  const [rows, setRows] = useState(String(height));
  const [difficulty, setDifficulty] = useState('');
  const [tier, setTier] = useState('');
  const [seed, setSeed] = useState('more');
  const [made, setMade] = useState<Made[]>([]);
  const [error, setError] = useState<string | null>(null);
  const [failed, setFailed] = useState<string[]>([]);
  const [abort, setAbort] = useState<AbortController | null>(null);
  useEffect(() => () => abort?.abort(), [abort]);
  useEffect(() => { setColumns(String(width)); setRows(String(height)); }, [width, height]);

  const make = async (): Promise<void> => {
    const control = new AbortController();
    setAbort(control);
    setMade([]);
    setFailed([]);
    setError(null);
    const asked = { source, level, method, width: Number(columns) || width, height: Number(rows) || height, difficulty: difficulty || null, tier: Number(tier) || null, seed, count: 6 };
    // A line brings only the tiles that no line before it brought.
    const tiles: Tile[] = [];
    try {
      for await (const line of stream<MoreLine>('/api/more', asked, control.signal)) {
        if (line.stage === 'level') {
          tiles.push(...line.tiles);
          const whole = { ...line, tiles: [...tiles] };
          setMade((before) => [...before, whole]);
        }
        else if (line.stage === 'none') setFailed((before) => [...before, line.text]);
        else if (line.stage === 'error') setError(line.error);
      }
    } catch (failure) {
      setError(words(failure));
    }
    setAbort(null);
  };
  return (
    <div class="more">
      <form class="more-form" onSubmit={(event) => { event.preventDefault(); void make(); }}>
        <label class="field">Method
          <select value={method} onChange={(event) => setMethod(event.currentTarget.value)}>{METHODS.map(([name, label]) => <option value={name}>{label}</option>)}</select>
        </label>
        <label class="field">Width<input class="short" inputMode="numeric" value={columns} onInput={(event) => setColumns(event.currentTarget.value)} /></label>
        <label class="field">Height<input class="short" inputMode="numeric" value={rows} onInput={(event) => setRows(event.currentTarget.value)} /></label>
        <label class="field">Difficulty
          <select value={difficulty} onChange={(event) => setDifficulty(event.currentTarget.value)}>
            <option value="">any</option>{EASE.map((label) => <option value={label}>{easeWords(label)}</option>)}
          </select>
        </label>
        <label class="field">Tier
          <select value={tier} onChange={(event) => setTier(event.currentTarget.value)}>
            <option value="">any</option>{TIERS.map((label) => <option value={label}>{label}</option>)}
          </select>
        </label>
        <label class="field">Seed<input class="medium" value={seed} onInput={(event) => setSeed(event.currentTarget.value)} /></label>
        {abort ? <button type="button" onClick={() => abort.abort()}>Stop</button> : <button type="submit" class="strong">Make six</button>}
      </form>
      {error && <p class="notice bad" role="alert">{error}</p>}
      {abort && made.length === 0 && <p class="soft"><span class="spinner" aria-hidden="true" /> Making levels that can be won</p>}
      {failed.length > 0 && <p class="soft">{`${failed.length} more could not be made as requested: ${failed[0]}`}</p>}
      <ul class="cards small">
        {made.map((one, index) => (
          <li>
            <Thumb tiles={one.tiles} frame={one.frame} label={`Made level ${index + 1}`} />
            <p class="facts">{one.ticks !== null && <span class="soft">won in {one.ticks} ticks</span>}{one.difficulty && <span class="chip">{easeWords(one.difficulty)}</span>}{one.tier && <span class="chip">tier {one.tier}</span>}</p>
            <p class="row"><button type="button" onClick={() => onUse(one.level)}>Use here</button><button type="button" onClick={() => onAdd(one.level)}>Add</button></p>
          </li>
        ))}
      </ul>
    </div>
  );
}
