import { useEffect, useState } from 'preact/hooks';
import { get, post, words } from '../data/api';
import { replay } from '../data/studio';
import { Run } from '../data/run';
import type { Episode, JudgePair, JudgeReport, JudgeSide, Side } from '../data/types';
import { Icon } from '../parts/Icon';
import { Markdown } from '../parts/Markdown';
import { Player } from '../parts/Player';
import { useAsked, useTitle } from '../parts/hooks';
import { Wide } from '../parts/Wide';
import { href } from '../parts/route';
import { isTurnBased } from './Play';

const NOBODY = { better: '', again: '', machine: '', words: '' };

/** Pairs of games without their sources, side by side: play both, say which is better. */
export function Judge() {
  useTitle('Judge');
  const [round, setRound] = useState(0);
  const asked = useAsked<JudgePair>((signal) => get('/api/judge', signal), [round]);
  const [form, setForm] = useState(NOBODY);
  const [played, setPlayed] = useState({ left: 0, right: 0 });
  const [error, setError] = useState<string | null>(null);
  const [sending, setSending] = useState(false);
  const pair = asked.value;

  const send = async (): Promise<void> => {
    if (!pair || sending) return;
    setSending(true);
    setError(null);
    try {
      await post('/api/judge', { pair: pair.pair, better: form.better, again: form.again, machine: form.machine || null, words: form.words, played });
      setForm(NOBODY);
      setPlayed({ left: 0, right: 0 });
      setRound(round + 1);
      window.scrollTo(0, 0);
    } catch (failure) {
      setError(words(failure));
    }
    setSending(false);
  };

  if (asked.error) return <main><p class="notice bad" role="alert">{asked.error}</p></main>;
  if (!pair) return <main aria-busy="true" />;
  if (pair.done || !pair.left || !pair.right) {
    return (
      <main class="judge">
        <h1>All pairs are judged</h1>
        <p>Thank you. <a href={href('judge', 'report')}>See what the judgements say</a></p>
      </main>
    );
  }
  const ready = form.better !== '' && form.again !== '' && !sending;
  const choose = (name: keyof typeof NOBODY) => (value: string) => setForm((before) => ({ ...before, [name]: value }));
  return (
    <main class="judge">
      <header class="heading">
        <div>
          <h1>{`Pair ${pair.pair + 1} of ${pair.of}`}</h1>
          <p class="soft">Play or watch both. Where they come from stays hidden until the report.</p>
        </div>
        <a href={href('judge', 'report')}>Report</a>
      </header>
      <div class="pair" key={pair.pair}>
        {(['left', 'right'] as const).map((side) => (
          <One key={side} side={side} game={pair[side] as JudgeSide} onPlayed={(ticks) => setPlayed((before) => ({ ...before, [side]: Math.max(before[side], ticks) }))} />
        ))}
      </div>
      <form class="verdict-form" onSubmit={(event) => { event.preventDefault(); if (ready) void send(); }}>
        <Question name="better" title="Which is the better game?" value={form.better} onChange={choose('better')} options={[['left', 'Left'], ['same', 'Neither'], ['right', 'Right']]} />
        <Question name="again" title="Which would you play again?" value={form.again} onChange={choose('again')} options={[['left', 'Left'], ['both', 'Both'], ['neither', 'Neither'], ['right', 'Right']]} />
        <Question name="machine" title="Which was made by a machine?" note="optional" value={form.machine} onChange={choose('machine')} options={[['left', 'Left'], ['both', 'Both'], ['neither', 'Neither'], ['right', 'Right']]} />
        <label class="field">In a few words <span class="soft">optional</span>
          <textarea rows={2} maxLength={4000} value={form.words} onInput={(event) => choose('words')(event.currentTarget.value)} />
        </label>
        {error && <p class="notice bad" role="alert">{error}</p>}
        <div class="buttons">
          {!ready && !sending && <span class="soft">Answer the first two questions to go on.</span>}
          <button type="submit" class="strong" disabled={!ready}>Next</button>
        </div>
      </form>
    </main>
  );
}

function Question({ name, title, note, value, options, onChange }: { name: string; title: string; note?: string; value: string; options: [string, string][]; onChange: (value: string) => void }) {
  return (
    <fieldset class="question">
      <legend>{title} {note && <span class="soft">{note}</span>}</legend>
      <div class="segments">
        {options.map(([one, label]) => (
          <label class={value === one ? 'on' : ''}>
            <input type="radio" name={name} value={one} checked={value === one} onChange={() => onChange(one)} />
            {label}
          </label>
        ))}
      </div>
    </fieldset>
  );
}

function levelText(level: JudgeSide['levels'][number]): string {
  return typeof level === 'string' ? level : (level.text ?? level.level ?? '');
}

function One({ side, game, onPlayed }: { side: Side; game: JudgeSide; onPlayed: (ticks: number) => void }) {
  const [level, setLevel] = useState(0);
  const [watching, setWatching] = useState(false);
  const [run, setRun] = useState<Run | null>(null);
  const [error, setError] = useState<string | null>(null);
  const episode: Episode | null = game.episodes[level] ?? null;
  useEffect(() => {
    let dropped = false;
    let made: Run | null = null;
    setError(null);
    const text = levelText(game.levels[level] ?? '');
    const make = watching && episode
      ? replay(game.source, text, episode).then((answer) => Run.replay(answer))
      : Run.begin(game.source, text, 'judge', isTurnBased(null, game.describe));
    make.then(
      (one) => {
        if (dropped) return one.close();
        made = one;
        if (one.kind === 'replay') one.start();
        else one.listen(() => onPlayed(one.reached));
        return setRun(one);
      },
      (failure: unknown) => { if (!dropped) setError(words(failure)); },
    );
    return () => { dropped = true; made?.close(); };
  }, [game, level, watching]);
  const name = side === 'left' ? 'Left' : 'Right';
  return (
    <section class="one" aria-label={`${name}: ${game.title}`}>
      <header>
        <h2 title={game.title}><span class="soft">{name}</span> {game.title}</h2>
        <nav class="tabs" aria-label={`Levels of the ${side} game`}>
          {game.levels.map((_, index) => <button type="button" aria-pressed={index === level} onClick={() => { setWatching(false); setLevel(index); }}>{index + 1}</button>)}
        </nav>
      </header>
      {error && <p class="notice bad" role="alert">{error}</p>}
      {run ? <Player run={run} keys="focus" compact label={`${name} game, level ${level + 1}`} /> : <div class="board" aria-busy="true" />}
      <p class="row">
        {episode && !watching && <button type="button" onClick={() => setWatching(true)}><Icon name="play" /> Watch it won</button>}
        {watching && <button type="button" class="strong" onClick={() => setWatching(false)}>Play it yourself</button>}
        {!watching && <span class="soft hint">Click the board, then use the arrow keys.</span>}
      </p>
      <details><summary>How it is played</summary><Markdown text={game.describe} /></details>
    </section>
  );
}

/** What the judgements say so far: of the sources, and of the measures against them. */
export function JudgeReportPage() {
  useTitle('Report of the judgements');
  const asked = useAsked<JudgeReport>((signal) => get('/api/judge/report', signal), []);
  const report = asked.value;
  return (
    <main class="judge-report">
      <header class="heading"><div><h1>What the judgements say</h1><p class="soft">Shares with 95 % intervals.</p></div><a href={href('judge')}>Back to judging</a></header>
      {asked.error && <p class="notice bad" role="alert">{asked.error}</p>}
      {report && (
        <>
          <h2>Sources</h2>
          {report.sources.length === 0 && <p class="soft">Nothing is judged yet.</p>}
          {report.sources.length > 0 && (
            <Wide name="Sources"><table>
              <thead><tr><th>Source</th><th class="n">Wins</th><th class="n">Losses</th><th class="n">Ties</th><th>Share of wins</th></tr></thead>
              <tbody>{report.sources.map((one) => <tr><td>{one.name}</td><td class="n">{one.wins}</td><td class="n">{one.losses}</td><td class="n">{one.ties}</td><td><Share {...one} /></td></tr>)}</tbody>
            </table></Wide>
          )}
          {report.measures.length > 0 && (
            <>
              <h2>Measures</h2>
              <p class="soft">How often a measure prefers the game that people preferred.</p>
              <Wide name="Measures"><table>
                <thead><tr><th>Measure</th><th class="n">Agrees</th><th class="n">Pairs</th><th>Share</th></tr></thead>
                <tbody>{report.measures.map((one) => <tr><td>{one.name}</td><td class="n">{one.agrees}</td><td class="n">{one.pairs}</td><td><Share {...one} /></td></tr>)}</tbody>
              </table></Wide>
            </>
          )}
        </>
      )}
    </main>
  );
}

/** A share with its interval, as a bar and in numbers. */
export function Share({ rate, low, high }: { rate: number; low: number; high: number }) {
  const percent = (value: number): string => (Number.isFinite(value) ? `${Math.round(value * 100)}` : '–');
  const x = (value: number): number => Math.max(0, Math.min(1, value || 0)) * 100;
  return (
    <span class="share">
      <svg viewBox="0 0 100 10" width="100" height="10" role="img" aria-label={`${percent(rate)} %, between ${percent(low)} and ${percent(high)} %`}>
        <rect class="track" x="0" y="1" width="100" height="8" rx="2" />
        <rect class="fill" x="0" y="1" width={x(rate)} height="8" rx="2" />
        <path class="whisker" d={`M${x(low)} 5H${x(high)}M${x(low)} 2.5V7.5M${x(high)} 2.5V7.5`} />
      </svg>
      <span>{percent(rate)} % <small class="soft">{percent(low)}–{percent(high)}</small></span>
    </span>
  );
}
