import { useEffect, useRef, useState } from 'preact/hooks';
import { Failure, get, stream, words } from '../data/api';
import { live } from '../data/studio';
import * as studio from '../data/studio';
import type { Ancestor, Comparison, Release, VerifyLine } from '../data/types';
import { Thumb } from '../parts/Board';
import { Words } from '../parts/Markdown';
import { useAsked, useTitle } from '../parts/hooks';
import { Wide } from '../parts/Wide';
import { href } from '../parts/route';
import { byEase, easeSpan } from './Browse';

export function ReleasePage() {
  useTitle('Release');
  const asked = useAsked(() => studio.release(), []);
  const release = asked.value;
  if (asked.error) return <main><p class="notice bad" role="alert">{asked.error}</p></main>;
  if (!release) return <main aria-busy="true" />;
  const rows: [string, string | null][] = [
    ['Root', release.root],
    ['Parent', release.parent],
    ['Format', String(release.format)],
    ['Semantics', String(release.semantics)],
    ['Generation', String(release.generation)],
    ['Sealed', release.sealed ? 'yes' : 'no'],
    ['Games', String(release.games.length)],
    ['Levels', String(release.games.reduce((sum, game) => sum + game.levels.length, 0))],
  ];
  return (
    <main class="release">
      <header class="heading"><div><h1>{release.name}</h1><p class="soft">A release: games and levels under one digest.</p></div></header>
      <dl class="facts-list digests">
        {rows.map(([name, value]) => value && <div><dt>{name}</dt><dd>{name === 'Root' || name === 'Parent' ? <code>{value}</code> : value}</dd></div>)}
        {!release.parent && <div><dt>Parent</dt><dd class="soft">none: this is the first release of its chain</dd></div>}
      </dl>
      {live && <Verify />}
      <Levels release={release} />
      {live && <Compare release={release} />}
    </main>
  );
}

/** Checks every file against its digest, replays the wins and follows the parents, and shows each as it is checked. */
function Verify() {
  const [lines, setLines] = useState<{ path: string; ok: boolean }[]>([]);
  const [progress, setProgress] = useState<[number, number]>([0, 0]);
  const [verdict, setVerdict] = useState<Extract<VerifyLine, { stage: 'verdict' }> | null>(null);
  const [ancestors, setAncestors] = useState<Ancestor[]>([]);
  const [error, setError] = useState<string | null>(null);
  const [abort, setAbort] = useState<AbortController | null>(null);
  const list = useRef<HTMLOListElement>(null);
  useEffect(() => () => abort?.abort(), [abort]);
  useEffect(() => {
    if (list.current) list.current.scrollTop = list.current.scrollHeight;
  }, [lines]);

  const verify = async (): Promise<void> => {
    const control = new AbortController();
    setAbort(control);
    setLines([]);
    setProgress([0, 0]);
    setAncestors([]);
    setVerdict(null);
    setError(null);
    try {
      for await (const line of stream<VerifyLine>('/api/release/verify', {}, control.signal)) {
        if (line.stage === 'file') {
          setLines((before) => [...before.slice(-400), { path: line.path, ok: line.ok }]);
          setProgress([line.done, line.total]);
        } else if (line.stage === 'ancestor') setAncestors((before) => [...before, line]);
        else if (line.stage === 'verdict') setVerdict(line);
        else if (line.stage === 'error') setError(line.error);
      }
    } catch (failure) {
      setError(words(failure));
    }
    setAbort(null);
  };
  return (
    <section class="verify">
      <h2>Verify</h2>
      <p class="soft">Reads every file of the release again, compares its digest with the manifest, replays the recorded wins, and follows the parents as far as they are found.</p>
      <p class="row">
        {abort ? <button type="button" onClick={() => abort.abort()}>Stop</button> : <button type="button" class="strong" onClick={() => void verify()}>Verify</button>}
        {abort && progress[1] > 0 && progress[0] === progress[1] && <span class="spinner" aria-hidden="true" />}
        {progress[1] > 0 && <><progress max={progress[1]} value={progress[0]} aria-label="Files checked" /><span class="soft">{progress[0]} of {progress[1]} files</span></>}
      </p>
      {error && <p class="notice bad" role="alert">{error}</p>}
      {verdict && (
        <div class={`notice ${verdict.ok ? 'good' : 'bad'}`} role="status">
          <strong>{verdict.ok ? 'Every digest agrees.' : verdict.sound ? 'The release agrees with its manifest, but some related files do not.' : 'This release does not match its manifest.'}</strong>
          {verdict.lines.map((line) => <p><Words text={line} /></p>)}
        </div>
      )}
      {ancestors.length > 0 && (
        <>
          <h3>Releases before it</h3>
          <ol class="ancestors" aria-label="Releases before it">
            {ancestors.map((one) => {
              const [kind, sign, word] = one.ok === null ? ['', '–', 'not found'] : one.ok ? ['ok', '✓', 'agrees'] : ['wrong', '✗', 'differs'];
              return (
                <li class={kind}>
                  <span class="sign" role="img" aria-label={word}>{sign}</span>
                  <div><strong>{one.name ?? 'Not found'}</strong>{one.place && one.place !== one.name && <span class="soft"> in {one.place}</span>}<code>{one.root}</code><p class="soft"><Words text={one.text} /></p></div>
                </li>
              );
            })}
          </ol>
        </>
      )}
      {lines.length > 0 && (
        <ol class="digests-seen" ref={list} tabIndex={0} aria-label="Files checked">
          {lines.map((line) => <li class={line.ok ? 'ok' : 'wrong'}><span role="img" aria-label={line.ok ? 'agrees' : 'differs'}>{line.ok ? '✓' : '✗'}</span> {line.path}</li>)}
        </ol>
      )}
    </section>
  );
}

function Levels({ release }: { release: Release }) {
  const hasTiers = release.games.some((game) => game.levels.some((level) => level.tier));
  const hasEase = release.games.some((game) => game.levels.some((level) => level.difficulty));
  return (
    <section>
      <h2>Games and levels</h2>
      <Wide name="Games and levels">
        <table>
          <thead><tr><th>Game</th><th>Kind</th><th class="n">Levels</th>{hasTiers && <th>Tiers</th>}{hasEase && <th>Difficulty</th>}</tr></thead>
          <tbody>
            {release.games.map((game) => {
              const tiers = [...new Set(game.levels.map((level) => level.tier).filter((tier) => tier !== null))].sort();
              const eases = byEase([...new Set(game.levels.map((level) => level.difficulty).filter((one) => one !== null))]);
              return (
                <tr>
                  <td><a href={href('game', game.id)}>{game.title}</a></td>
                  <td>{game.kind ?? '–'}</td>
                  <td class="n">{game.levels.length}</td>
                  {hasTiers && <td>{tiers.length ? tiers.join(', ') : '–'}</td>}
                  {hasEase && <td>{easeSpan(eases) ?? '–'}</td>}
                </tr>
              );
            })}
          </tbody>
        </table>
      </Wide>
    </section>
  );
}

/** The release beside the one that the studio was started with. */
function Compare({ release }: { release: Release }) {
  const asked = useAsked<Comparison | null>(
    (signal) =>
      get<Comparison>('/api/release/compare', signal).catch((error: unknown) => {
        if (error instanceof Failure && error.status === 404) return null;
        throw error;
      }),
    [],
  );
  const compared = asked.value;
  const title = (id: string): string => release.games.find((game) => game.id === id)?.title ?? id;
  return (
    <section>
      <h2>Compared with another release</h2>
      {asked.error && <p class="notice bad" role="alert">{asked.error}</p>}
      {!compared && !asked.error && <p class="soft">Start the studio with <code>--against SNAPSHOT</code> to see the differences from an earlier release.</p>}
      {compared && (
        <>
          <p>Beside <strong>{compared.other}</strong>: {compared.new.length} new, {compared.changed.length} changed, {compared.kept.length} kept, {compared.gone.length} gone.</p>
          <div class="columns four">
            {([['New', compared.new], ['Changed', compared.changed], ['Kept', compared.kept], ['Gone', compared.gone]] as const).map(([name, ids]) => (
              <div>
                <h3>{name}</h3>
                {ids.length === 0 && <p class="soft">none</p>}
                <ul class="plain">{ids.map((id) => <li>{name === 'Gone' ? id : <a href={href('game', id)}>{title(id)}</a>}</li>)}</ul>
              </div>
            ))}
          </div>
          {compared.nearest.length > 0 && (
            <>
              <h3>The nearest game of the other release</h3>
              <p class="soft">A distance of 0 means identical rules.</p>
              <ul class="cards small">
                {[...compared.nearest].sort((a, b) => a.distance - b.distance).map((near) => {
                  const game = release.games.find((one) => one.id === near.id);
                  return (
                    <li>
                      <a class="card" href={href('game', near.id)}>
                        <Thumb tiles={game?.tiles ?? []} frame={game?.frame ?? null} label={`Board of ${title(near.id)}`} />
                        <span class="name">{title(near.id)}</span>
                        <span class="soft">nearest: {near.other}, {near.distance.toFixed(2)} away</span>
                      </a>
                    </li>
                  );
                })}
              </ul>
            </>
          )}
        </>
      )}
    </section>
  );
}
