import type { ComponentChildren } from 'preact';
import { useEffect, useRef, useState } from 'preact/hooks';
import { stream, words } from '../data/api';
import type { Episode, Evidence, RuleSpan, VerdictLine } from '../data/types';
import { Icon } from '../parts/Icon';
import { Words } from '../parts/Markdown';
import { Share } from '../views/Judge';

type Criterion = Extract<VerdictLine, { stage: 'criterion' }>;
type Of<S extends VerdictLine['stage']> = Extract<VerdictLine, { stage: S }>;

/** All that a stream has said so far. */
interface Said {
  problems: Of<'problems'> | null;
  reach: Of<'reach'> | null;
  calls: number;
  answer: Of<'win'> | Of<'impossible'> | Of<'unknown'> | null;
  criteria: Criterion[];
  ladder: Of<'ladder'> | null;
  done: boolean;
  error: string | null;
}

const NOTHING: Said = { problems: null, reach: null, calls: 0, answer: null, criteria: [], ladder: null, done: false, error: null };

function hear(said: Said, line: VerdictLine): Said {
  switch (line.stage) {
    case 'problems':
      return { ...said, problems: line };
    case 'reach':
      return { ...said, reach: line };
    case 'search':
      return { ...said, calls: line.calls };
    case 'win':
    case 'impossible':
    case 'unknown':
      return { ...said, answer: line };
    case 'criterion':
      return { ...said, criteria: [...said.criteria.filter((one) => one.name !== line.name), line] };
    case 'ladder':
      return { ...said, ladder: line };
    case 'done':
      return { ...said, done: true };
    case 'error':
      return { ...said, done: true, error: line.error };
    default:
      return said; // A stage of a later server.
  }
}

interface Props {
  source: string;
  level: string;
  levels: string[];
  onCells: (cells: [number, number][]) => void;
  onRule: (rule: RuleSpan) => void;
  onEpisode: (episode: Episode, tick: number | null, name: string) => void;
}

/** The verdict on the level as it is drawn; a change ends the search and starts it over. */
export function VerdictPanel(props: Props) {
  const { source, level } = props;
  const [said, setSaid] = useState<Said>(NOTHING);
  const [stale, setStale] = useState(true);
  const [budget, setBudget] = useState<number | null>(null);

  useEffect(() => setBudget(null), [source, level]);
  useEffect(() => {
    const abort = new AbortController();
    setStale(true);
    const timer = window.setTimeout(async () => {
      let now = NOTHING;
      try {
        for await (const line of stream<VerdictLine>('/api/verdict', { source, level, budget, seed: null }, abort.signal)) {
          if (abort.signal.aborted) return;
          now = hear(now, line);
          setSaid(now);
          setStale(false);
        }
      } catch (failure) {
        if (abort.signal.aborted) return;
        setSaid({ ...now, done: true, error: words(failure) });
        setStale(false);
      }
    }, 120);
    return () => {
      window.clearTimeout(timer);
      abort.abort();
    };
  }, [source, level, budget]);

  const settled = said.done && !stale && said.error === null && !said.problems?.problems.some((one) => one.severity === 'error');
  return (
    <div class={`verdict ${stale ? 'stale' : ''}`} aria-live="polite" aria-busy={!said.done || stale}>
      <Headline said={said} onEpisode={props.onEpisode} onLonger={(calls) => setBudget(calls * 10)} />
      {said.error && <p class="notice bad" role="alert">{said.error}</p>}
      {said.reach && said.reach.unreachable.length > 0 && (
        <section>
          <h3>Out of reach</h3>
          <ul class="evidence">
            {said.reach.unreachable.map((one) => (
              <li><button type="button" class="link" onClick={() => props.onCells(one.cells)}>{one.type}</button><span class="soft"> {one.cells.length} {one.cells.length === 1 ? 'square' : 'squares'}</span></li>
            ))}
          </ul>
        </section>
      )}
      {said.reach && said.reach.why.length > 0 && (
        <section>
          <h3>Why</h3>
          <ul class="evidence">{said.reach.why.map((one) => <Seen evidence={{ ...one, tick: null }} episode={null} {...props} />)}</ul>
        </section>
      )}
      {said.criteria.length > 0 && <Criteria criteria={fresh(said)} {...props} />}
      {said.ladder && (
        <section>
          <h3>Players</h3>
          <table class="ladder"><tbody>
            {said.ladder.rows.map((row) => (
              <tr><td>{row.player}</td><td class="n">{row.wins}/{row.plays}</td><td><Share rate={row.plays ? row.wins / row.plays : 0} low={row.low} high={row.high} /></td></tr>
            ))}
          </tbody></table>
        </section>
      )}
      <Whole settled={settled} {...props} />
    </div>
  );
}

function Headline({ said, onEpisode, onLonger }: { said: Said; onEpisode: Props['onEpisode']; onLonger: (calls: number) => void }) {
  const { answer } = said;
  const errors = said.problems?.problems.filter((one) => one.severity === 'error') ?? [];
  if (errors.length > 0) {
    return (
      <div class="headline bad"><Icon name="cross" /><div><strong>{errors.length === 1 ? 'A problem comes first' : `${errors.length} problems come first`}</strong>
        {errors.slice(0, 3).map((one) => <p><Words text={one.message} /></p>)}
      </div></div>
    );
  }
  if (answer?.stage === 'win') {
    return (
      <div class="headline good"><Icon name="check" /><div>
        <strong>{`Can be won in ${answer.ticks} ${answer.ticks === 1 ? 'tick' : 'ticks'}`}</strong>
        <p class="soft">{answer.shortest ? 'No win is shorter.' : 'A shorter win may exist.'} Found with {answer.calls.toLocaleString('en')} calls.</p>
        <button type="button" onClick={() => onEpisode(answer.episode, null, 'A win')}><Icon name="play" /> Watch</button>
      </div></div>
    );
  }
  if (answer?.stage === 'impossible') {
    return (
      <div class="headline bad"><Icon name="cross" /><div>
        <strong>Cannot be won</strong>
        <p><Words text={answer.text} /></p>
        {answer.states > 0 && <p class="soft">All {answer.states.toLocaleString('en')} reachable states were searched.</p>}
      </div></div>
    );
  }
  if (answer?.stage === 'unknown') {
    return (
      <div class="headline"><Icon name="help" /><div>
        <strong>Not known</strong>
        <p><Words text={answer.text} /></p>
        <button type="button" onClick={() => onLonger(Math.max(answer.calls, 1000))}>Look ten times longer</button>
      </div></div>
    );
  }
  if (said.done) return <div class="headline"><Icon name="help" /><div><strong>No verdict</strong></div></div>;
  return (
    <div class="headline"><span class="spinner" aria-hidden="true" /><div>
      <strong>Looking for a win</strong>
      <p class="soft">{said.calls > 0 ? `${said.calls.toLocaleString('en')} calls` : ' '}</p>
    </div></div>
  );
}

/** The criteria without the evidence that is listed under the reasons already. */
function fresh(said: Said): Criterion[] {
  const listed = new Set(said.reach?.why.map((one) => one.text));
  return said.criteria.map((one) => ({ ...one, evidence: one.evidence.filter((seen) => !listed.has(seen.text)) }));
}

const SIGNS = { pass: ['✓', 'passes'], fail: ['✗', 'fails'], unknown: ['?', 'not known'], skipped: ['–', 'skipped'] } as const;

const RANKS = ['fail', 'unknown', 'pass', 'skipped'];

function Criteria({ criteria, ...props }: Props & { criteria: Criterion[] }) {
  return (
    <section>
      <h3>Criteria</h3>
      <ul class="criteria">
        {[...criteria].sort((a, b) => RANKS.indexOf(a.verdict) - RANKS.indexOf(b.verdict)).map((one) => {
          const [sign, word] = SIGNS[one.verdict] ?? SIGNS.unknown;
          const { episode } = one;
          // What the head says is not said again, unless it leads somewhere.
          const evidence = one.evidence.filter((seen) => seen.text !== one.text || seen.cell || seen.rule || (episode && seen.tick !== null));
          return (
            <li class={one.verdict}>
              <span class="sign" role="img" aria-label={word}>{sign}</span>
              <div>
                <Shown open={one.verdict !== 'pass'} head={<><strong>{one.name}</strong> <span><Words text={one.text} /></span></>}>
                  {evidence.length === 0 && !episode ? null : (
                    <ul class="evidence">
                      {evidence.map((seen) => <Seen evidence={seen} episode={episode} {...props} />)}
                      {episode && !evidence.some((seen) => seen.tick !== null) && (
                        <li><button type="button" class="link" onClick={() => props.onEpisode(episode, null, one.name)}>watch</button></li>
                      )}
                    </ul>
                  )}
                </Shown>
              </div>
            </li>
          );
        })}
      </ul>
    </section>
  );
}

/** What was seen below its head; of what passes it is folded away, since a designer looks for what does not. */
function Shown({ open, head, children }: { open: boolean; head: ComponentChildren; children: ComponentChildren }) {
  if (!children) return <>{head}</>;
  return <details open={open}><summary>{head}</summary>{children}</details>;
}

/** A piece of evidence: a click shows its square, its rule and its moment. */
function Seen({ evidence, episode, ...props }: Props & { evidence: Evidence; episode: Episode | null }) {
  const { cell, rule, tick } = evidence;
  if (!cell && !rule && (tick === null || !episode)) return <li><Words text={evidence.text} /></li>;
  const show = (): void => {
    if (episode && tick !== null) props.onEpisode(episode, tick, evidence.text);
    if (cell) props.onCells([cell]);
    if (rule) props.onRule(rule);
  };
  return (
    <li>
      <button type="button" class="link" onClick={show}><Words text={evidence.text} /></button>
      <span class="soft">
        {rule && ` line ${rule.line}`}
        {cell && ` square ${cell[0] + 1}, ${cell[1] + 1}`}
        {episode && tick !== null && ` tick ${tick}`}
      </span>
    </li>
  );
}

/** A criterion without links: in another text, its places are elsewhere. */
function unlinked(one: Criterion): Criterion {
  return { ...one, episode: null, evidence: one.evidence.map((seen) => ({ ...seen, tick: null, cell: null, rule: null })) };
}

/** The pause after the verdict on the level before all levels are judged, in milliseconds. */
const PAUSE = 3000;

/** The choice to judge all levels in the background, for as long as the page is open. */
let inBackground = true;

/** The criteria of the whole game, over all levels: by themselves when nothing changes for a while, or on request. A change ends it. */
function Whole({ settled, ...props }: Props & { settled: boolean }) {
  const key = `${props.source}\n${props.levels.join('\n')}`;
  const [result, setResult] = useState<{ key: string; criteria: Criterion[] } | null>(null);
  const [failed, setFailed] = useState<{ key: string; text: string } | null>(null);
  const [progress, setProgress] = useState<string | null>(null);
  const [background, setBackground] = useState(inBackground);
  const [stopped, setStopped] = useState('');
  const running = useRef<AbortController | null>(null);

  const stop = (): void => {
    running.current?.abort();
    running.current = null;
    setProgress(null);
  };
  const judge = async (): Promise<void> => {
    stop();
    const control = new AbortController();
    running.current = control;
    setFailed(null);
    setProgress('judging');
    const criteria: Criterion[] = [];
    let error: string | null = null;
    try {
      for await (const line of stream<VerdictLine>('/api/necessity', { source: props.source, levels: props.levels }, control.signal)) {
        if (control.signal.aborted) return;
        if (line.stage === 'criterion') criteria.push(line);
        else if (line.stage === 'judging') setProgress(`judging level ${line.level}, ${line.level + 1} of ${line.of}`);
        else if (line.stage === 'error') error = line.error;
      }
    } catch (failure) {
      error = words(failure);
    }
    if (control.signal.aborted) return;
    running.current = null;
    setProgress(null);
    if (error === null) setResult({ key, criteria });
    else setFailed({ key, text: error === 'superseded' ? 'other pages of this studio had priority.' : error });
  };

  // Another text, or a verdict on a level that has begun, comes first.
  useEffect(() => stop, [key, settled]);
  const wanted = background && settled && result?.key !== key && failed?.key !== key && stopped !== key;
  useEffect(() => {
    if (!wanted) return undefined;
    const timer = window.setTimeout(() => void judge(), PAUSE);
    return () => window.clearTimeout(timer);
  }, [wanted, key]);
  return (
    <section class="whole">
      <h3>The whole game</h3>
      <p class="row">
        {progress !== null
          ? <button type="button" onClick={() => { setStopped(key); stop(); }}>Stop</button>
          : <button type="button" disabled={!settled} onClick={() => void judge()}>Judge all levels</button>}
        <label class="check"><input type="checkbox" checked={background} onChange={(event) => {
          inBackground = event.currentTarget.checked;
          setBackground(inBackground);
          if (!inBackground) stop();
        }} /> in the background</label>
      </p>
      <p class="row soft progress" aria-live="off">
        {progress !== null && <><span class="spinner" aria-hidden="true" />{progress}</>}
        {result && result.key !== key && <span class="chip">of an earlier text</span>}
      </p>
      {failed?.key === key && <p class="soft">Not judged: {failed.text}</p>}
      {result && <Criteria criteria={result.key === key ? result.criteria : result.criteria.map(unlinked)} {...props} />}
    </section>
  );
}
