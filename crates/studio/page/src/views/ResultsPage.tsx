import { useEffect, useState } from 'preact/hooks';
import { get } from '../data/api';
import { Run } from '../data/run';
import type { ResultEpisode, ResultReplay, Results, Talk } from '../data/types';
import { Player } from '../parts/Player';
import { useAsked, useRun, useTitle } from '../parts/hooks';
import { Wide } from '../parts/Wide';
import { href } from '../parts/route';
import { Choice } from './Browse';

const PAGE = 200;

/** All recorded episodes of an evaluation, by player. */
export function ResultsPage() {
  useTitle('Results');
  const asked = useAsked<Results>((signal) => get('/api/results', signal), []);
  const [player, setPlayer] = useState('');
  const [game, setGame] = useState('');
  const [outcome, setOutcome] = useState('');
  const [count, setCount] = useState(PAGE);
  const all = asked.value?.players.flatMap((one) => one.episodes.map((episode) => ({ player: one.name, episode }))) ?? [];
  const choices = (of: (one: (typeof all)[number]) => string): string[] => [...new Set(all.map(of))].sort();
  const rows = all.filter((one) =>
    (!player || one.player === player) && (!game || one.episode.game === game) && (!outcome || one.episode.outcome === outcome));
  return (
    <main class="results">
      <header class="heading">
        <div><h1>Results</h1><p class="soft">{rows.length === all.length ? `${all.length} episodes` : `${rows.length} of ${all.length} episodes`}</p></div>
        <div class="filters">
          <Choice label="Player" all="All players" value={player} options={choices((one) => one.player)} onChange={setPlayer} />
          <Choice label="Game" all="All games" value={game} options={choices((one) => one.episode.game)} onChange={setGame} />
          <Choice label="Outcome" all="All outcomes" value={outcome} options={choices((one) => one.episode.outcome)} words={outcomeWords} onChange={setOutcome} />
        </div>
      </header>
      {asked.error && <p class="notice bad" role="alert">{asked.error}</p>}
      <Wide name="Episodes">
        <table>
          <thead><tr><th>Player</th><th>Game</th><th>Level</th><th>Run</th><th>Outcome</th><th class="n">Score</th><th class="n">Steps</th></tr></thead>
          <tbody>{rows.slice(0, count).map((one) => <Row key={one.episode.index} player={one.player} episode={one.episode} />)}</tbody>
        </table>
      </Wide>
      {rows.length > count && <p><button type="button" onClick={() => setCount(count + PAGE)}>Show more</button></p>}
    </main>
  );
}

/** The outcome as the report names it. */
function outcomeWords(outcome: string): string {
  return outcome === 'playing' ? 'not finished' : outcome === 'limit' ? 'limit of steps' : outcome;
}

function Row({ player, episode }: { player: string; episode: ResultEpisode }) {
  return (
    <tr>
      <td>{player}</td>
      <td><a href={href('results', episode.index)} aria-label={`Watch ${player} on ${episode.game}, level ${episode.level}`}>{episode.game}</a></td>
      <td>{String(episode.level)}</td>
      <td>{String(episode.run)}</td>
      <td><span class={`outcome ${episode.outcome}`}>{outcomeWords(episode.outcome)}</span></td>
      <td class="n">{episode.score}</td>
      <td class="n">{episode.steps}</td>
    </tr>
  );
}

/** A recorded episode with what was said to the model and what it answered, beside the board. */
export function ResultPage({ index }: { index: string }) {
  const asked = useAsked<ResultReplay>((signal) => get(`/api/results/${encodeURIComponent(index)}`, signal), [index]);
  const [run, setRun] = useState<Run | null>(null);
  useTitle(asked.value?.title ?? 'Results');
  useRun(run);
  useEffect(() => {
    if (!asked.value) return undefined;
    const made = Run.replay({ ...asked.value, agrees: asked.value.agrees ?? true, note: asked.value.note ?? null });
    setRun(made);
    return () => made.close();
  }, [asked.value]);
  const talk = asked.value?.talk ?? [];
  const at = talkAt(talk, run?.at ?? 0);
  return (
    <main class="play">
      <div class="stage">
        {asked.error && <p class="notice bad" role="alert">{asked.error}</p>}
        {run && asked.value ? <Player run={run} keys="page" label={asked.value.title} /> : !asked.error && <div class="board" aria-busy="true" />}
      </div>
      <aside class="side talk" aria-label="Prompt and answer">
        <p><a href={href('results')}>All results</a></p>
        <h1>{asked.value?.title}</h1>
        {asked.value?.player && <p class="soft">{asked.value.player}</p>}
        {run && talk.length === 0 && <p class="soft">No prompts were kept for this episode.</p>}
        {at && (
          <>
            <p class="row">
              <button type="button" disabled={at.position === 0} onClick={() => run?.go(talk[at.position - 1]?.frame ?? 0)}>Earlier</button>
              <span class="soft">{`Turn ${at.position + 1} of ${talk.length}`}</span>
              <button type="button" disabled={at.position >= talk.length - 1} onClick={() => run?.go(talk[at.position + 1]?.frame ?? 0)}>Later</button>
            </p>
            <h2>Answer</h2>
            <pre class="answer" tabIndex={0} aria-label="Answer">{at.talk.answer}</pre>
            <p class="facts">
              {at.talk.parsed && <span class="chip">{at.talk.parsed}</span>}
              {at.talk.validity && <span class="soft">{at.talk.validity}</span>}
            </p>
            {at.talk.reasoning && <details><summary>Reasoning</summary><pre tabIndex={0} aria-label="Reasoning">{at.talk.reasoning}</pre></details>}
            <h2>Prompt</h2>
            <pre class="prompt" tabIndex={0} aria-label="Prompt">{at.talk.prompt}</pre>
          </>
        )}
      </aside>
    </main>
  );
}

/** The last exchange at or before a frame. */
function talkAt(talk: Talk[], frame: number): { talk: Talk; position: number } | null {
  let position = -1;
  talk.forEach((one, index) => {
    if (one.frame <= frame) position = index;
  });
  const found = talk[Math.max(position, 0)];
  return found ? { talk: found, position: Math.max(position, 0) } : null;
}
