import { useEffect, useState } from 'preact/hooks';
import { get, post, words } from '../data/api';
import { Run } from '../data/run';
import type { JudgePair, JudgeReport, JudgeSide, Replay, Side } from '../data/types';
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
  const [watched, setWatched] = useState({ left: false, right: false });
  const [error, setError] = useState<string | null>(null);
  const [sending, setSending] = useState(false);
  const pair = asked.value;

  const send = async (): Promise<void> => {
    if (!pair || sending) return;
    setSending(true);
    setError(null);
    try {
      await post('/api/judge', { pair: pair.pair, better: form.better, again: form.again, machine: form.machine || null, words: form.words, played, watched });
      setForm(NOBODY);
      setPlayed({ left: 0, right: 0 });
      setWatched({ left: false, right: false });
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
          <p class="soft">Play or watch both. The origin of the games stays hidden until the report.</p>
        </div>
        <a href={href('judge', 'report')}>Report</a>
      </header>
      <div class="pair" key={pair.pair}>
        {(['left', 'right'] as const).map((side) => (
          <One
            key={side}
            pair={pair.pair}
            side={side}
            game={pair[side] as JudgeSide}
            onPlayed={(ticks) => setPlayed((before) => ({ ...before, [side]: Math.max(before[side], ticks) }))}
            onWatched={() => setWatched((before) => ({ ...before, [side]: true }))}
          />
        ))}
      </div>
      <form class="verdict-form" onSubmit={(event) => { event.preventDefault(); if (ready) void send(); }}>
        <Question name="better" title="Which is the better game?" value={form.better} onChange={choose('better')} options={[['left', 'Left'], ['same', 'Neither'], ['right', 'Right']]} />
        <Question name="again" title="Which would you play again?" value={form.again} onChange={choose('again')} options={[['left', 'Left'], ['both', 'Both'], ['neither', 'Neither'], ['right', 'Right']]} />
        <Question name="machine" title="Which was made by a machine?" note="optional" value={form.machine} onChange={choose('machine')} options={[['left', 'Left'], ['both', 'Both'], ['neither', 'Neither'], ['right', 'Right']]} />
        <label class="field"><span>In a few words <span class="soft">optional</span></span>
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

/** A game of the pair: its levels to play, or to watch a program play. */
function One({ pair, side, game, onPlayed, onWatched }: { pair: number; side: Side; game: JudgeSide; onPlayed: (ticks: number) => void; onWatched: () => void }) {
  const [level, setLevel] = useState(0);
  const [watching, setWatching] = useState(false);
  const [played, setPlayed] = useState<Run | null>(null);
  const [shown, setShown] = useState<Run | null>(null);
  const [error, setError] = useState<string | null>(null);
  useEffect(() => {
    let dropped = false;
    let made: Run | null = null;
    setPlayed(null);
    setError(null);
    Run.begin(game.source, game.levels[level] ?? '', 'judge', isTurnBased(null, game.describe)).then(
      (one) => {
        if (dropped) return one.close();
        made = one;
        one.listen(() => onPlayed(one.reached));
        return setPlayed(one);
      },
      (failure: unknown) => { if (!dropped) setError(words(failure)); },
    );
    return () => { dropped = true; made?.close(); };
  }, [game, level]);
  useEffect(() => {
    if (!watching) return undefined;
    const abort = new AbortController();
    let made: Run | null = null;
    setError(null);
    post<Replay>('/api/judge/watch', { pair, side, level }, abort.signal).then(
      (answer) => {
        if (abort.signal.aborted) return;
        made = Run.replay(answer);
        setShown(made);
        made.start();
        onWatched();
      },
      (failure: unknown) => {
        if (abort.signal.aborted) return;
        setError(words(failure));
        setWatching(false);
      },
    );
    return () => {
      abort.abort();
      made?.close();
      setShown(null);
    };
  }, [pair, side, level, watching]);
  const toggle = (): void => {
    played?.stop();
    setWatching(!watching);
  };
  const name = side === 'left' ? 'Left' : 'Right';
  const run = watching && shown ? shown : played;
  return (
    <section class="one" aria-label={`${name}: ${game.title}`}>
      <header>
        <h2 title={game.title}><span class="soft">{name}</span> {game.title}</h2>
        <nav class="tabs" aria-label={`Levels of the ${side} game`}>
          {game.levels.map((_, index) => <button type="button" aria-pressed={index === level} onClick={() => { setWatching(false); setLevel(index); }}>{index}</button>)}
        </nav>
      </header>
      {error && <p class="notice bad" role="alert">{error}</p>}
      {run ? <Player run={run} keys="focus" compact label={`${name} game, level ${level}${run.kind === 'replay' ? ', played by a program' : ''}`} /> : <div class="board" aria-busy="true" />}
      <p class="row">
        <button type="button" class={watching ? 'strong' : ''} onClick={toggle}>{watching ? 'Play it yourself' : <><Icon name="play" /> Watch a program play it</>}</button>
        {watching && !shown && <span class="soft" role="status"><span class="spinner" aria-hidden="true" /> A program is playing</span>}
        {!watching && <span class="soft hint">Click the board, then use the arrow keys.</span>}
      </p>
      <details><summary>How it is played</summary><Markdown text={game.describe} /></details>
    </section>
  );
}

/** What the judgements say: of the sources, and of the measures against them. While judging goes on it would tell which source wins. */
export function JudgeReportPage() {
  useTitle('Report of the judgements');
  const [round, setRound] = useState(0);
  const asked = useAsked<JudgeReport>((signal) => get('/api/judge/report', signal), [round]);
  const [error, setError] = useState<string | null>(null);
  const report = asked.value;
  const end = (): void => {
    post('/api/judge/end', {}).then(() => setRound(round + 1), (failure: unknown) => setError(words(failure)));
  };
  const left = report ? report.of - report.judged : 0;
  return (
    <main class="judge-report">
      <header class="heading"><div><h1>What the judgements say</h1>{report && !report.blind && <p class="soft">Percentages with 95% intervals.</p>}</div><a href={href('judge')}>Back to judging</a></header>
      {(asked.error ?? error) && <p class="notice bad" role="alert">{asked.error ?? error}</p>}
      {report?.blind && (
        <section class="blind">
          <p>{`${report.judged} of ${report.of} pairs are judged.`} The report is shown when all pairs are judged.</p>
          <p class="soft">{`The report shows which source wins: the ${left === 1 ? 'answer' : `${left} answers`} still to come would no longer be blind, and would be marked as not blind in the record.`}</p>
          <p><button type="button" onClick={end}>Show the report and end blinding</button></p>
        </section>
      )}
      {report && !report.blind && (
        <>
          <h2>Sources</h2>
          {report.sources.length === 0 && <p class="soft">Nothing is judged yet.</p>}
          {report.sources.length > 0 && (
            <Wide name="Sources"><table>
              <thead><tr><th>Source</th><th class="n">Wins</th><th class="n">Losses</th><th class="n">Ties</th><th>Percentage of wins</th></tr></thead>
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
export function Share({ rate, low, high }: { rate: number | null; low: number; high: number }) {
  if (rate === null) return <span class="soft">no answer yet</span>;
  const percent = (value: number): string => `${Math.round(value * 100)}`;
  const x = (value: number): number => Math.max(0, Math.min(1, value)) * 100;
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
