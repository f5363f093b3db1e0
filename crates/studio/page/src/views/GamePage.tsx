import { useState } from 'preact/hooks';
import { post, words } from '../data/api';
import { live } from '../data/studio';
import * as studio from '../data/studio';
import type { Game, Release, Workspace } from '../data/types';
import { Thumb } from '../parts/Board';
import { Dialog } from '../parts/Dialog';
import { Icon } from '../parts/Icon';
import { Markdown } from '../parts/Markdown';
import { useAsked, useTitle } from '../parts/hooks';
import { go, href } from '../parts/route';
import { easeWords, tierWords } from './Browse';
import { intentOf } from './Play';

/** The card of a game: levels as boards, facts, rules in words, witnesses to watch. */
export function GamePage({ game, workspace, onCopied }: { game: Game; workspace: Workspace; onCopied: () => void }) {
  useTitle(game.title);
  const [copying, setCopying] = useState(false);
  const release = useAsked<Release | null>(() => (workspace.kind === 'snapshot' ? studio.release() : Promise.resolve(null)), [workspace]);
  const released = release.value?.games.find((one) => one.id === game.id);
  const about = text(game.card?.description);
  const goal = text(game.card?.goal);
  return (
    <main class="card-page">
      <header class="heading">
        <div>
          <h1>{game.title}</h1>
          {about && <p class="lead">{about}</p>}
          {goal && <p class="soft">{goal}</p>}
        </div>
        <div class="actions">
          {live && <a class="button strong" href={href('play', game.id, 0)}><Icon name="play" /> Play</a>}
          {!live && game.witnesses.length > 0 && (
            <a class="button strong" href={href('watch', game.id, game.witnesses[0]?.name ?? '')}><Icon name="play" /> Watch</a>
          )}
          {live && game.writable && <a class="button" href={href('design', game.id, 0)}>Design</a>}
          {live && !game.writable && <button type="button" onClick={() => setCopying(true)}>Edit a copy</button>}
        </div>
      </header>

      <h2>Levels</h2>
      <ul class="cards levels">
        {game.levels.map((level, index) => {
          const facts = released?.levels.find((one) => one.name === level.name || `${one.name}.txt` === level.name) ?? released?.levels[index];
          const intent = intentOf(game, index);
          const own = game.witnesses.filter((witness) => studio.levelOf(game, witness) === index);
          return (
            <li key={level.name}>
              <LevelBoard game={game} index={index} />
              <p class="name">{`Level ${studio.numberOf(game.levels, index)}`}</p>
              {intent && <p class="summary">{intent}</p>}
              <p class="facts">
                {facts?.tier && <span class="chip">{tierWords(facts.tier)}</span>}
                {facts && facts.ticks !== null && <span class="soft">won in {facts.ticks} ticks</span>}
                {facts?.difficulty && <span class="soft">{easeWords(facts.difficulty)}</span>}
                {own.map((witness) => (
                  <a href={href('watch', game.id, witness.name)}>{own.length === 1 ? 'watch a win' : `watch ${witness.name}`}</a>
                ))}
              </p>
            </li>
          );
        })}
      </ul>

      <div class="columns">
        <section>
          <h2>The rules in words</h2>
          <Markdown text={game.describe} />
        </section>
        <section>
          {game.card && <Facts card={game.card} />}
          <h2>The rules as written</h2>
          <pre class="source" tabIndex={0} aria-label="The rules as written">{game.source.text}</pre>
        </section>
      </div>
      {copying && <CopyDialog game={game} onClose={() => setCopying(false)} onCopied={onCopied} />}
    </main>
  );
}

function text(value: unknown): string | null {
  return typeof value === 'string' && value ? value : null;
}

function LevelBoard({ game, index }: { game: Game; index: number }) {
  const asked = useAsked((signal) => studio.board(game, index, signal), [game, index]);
  const number = studio.numberOf(game.levels, index);
  const label = `Board of level ${number}`;
  if (asked.error) return <p class="notice bad">{asked.error}</p>;
  const board = <Thumb tiles={asked.value?.tiles ?? []} frame={asked.value?.frame ?? null} label={label} />;
  return live ? <a class="board-link" href={href('play', game.id, index)} aria-label={`Play level ${number}`}>{board}</a> : board;
}

const SHOWN_ELSEWHERE = new Set(['title', 'description', 'goal', 'levels', 'rules', 'id']);

/** The facts of a card that are plain words, numbers or lists of them; those of a part of a card with its name. */
function plainFacts(card: object, part: string): [string, string][] {
  return Object.entries(card).flatMap(([name, value]: [string, unknown]): [string, string][] => {
    if (SHOWN_ELSEWHERE.has(name) || value === null) return [];
    const label = `${part}${name.replaceAll('_', ' ')}`;
    if (typeof value === 'boolean') return [[label, value ? 'yes' : 'no']];
    if (typeof value === 'string' || typeof value === 'number') return [[label, String(value)]];
    if (Array.isArray(value)) return value.length > 0 && value.every((one) => typeof one === 'string' || typeof one === 'number') ? [[label, value.join(', ')]] : [];
    return typeof value === 'object' && part === '' ? plainFacts(value, `${label}, `) : [];
  });
}

function Facts({ card }: { card: Record<string, unknown> }) {
  const rows = plainFacts(card, '');
  if (rows.length === 0) return null;
  return (
    <>
      <h2>Card</h2>
      <dl class="facts-list">
        {rows.map(([name, value]) => <div><dt>{name}</dt><dd>{value}</dd></div>)}
      </dl>
    </>
  );
}

/** Asks for the name of a copy that can be edited. */
function CopyDialog({ game, onClose, onCopied }: { game: Game; onClose: () => void; onCopied: () => void }) {
  const [title, setTitle] = useState(`${game.title} (mine)`);
  const [error, setError] = useState<string | null>(null);
  const copy = async (): Promise<void> => {
    try {
      const made = await post<{ id: string }>('/api/copy', { id: game.id, title });
      onCopied();
      onClose();
      go('design', made.id, 0);
    } catch (failure) {
      setError(words(failure));
    }
  };
  return (
    <Dialog title="Edit a copy" onClose={onClose}>
      <p>{game.title} itself stays as it is. The copy is written to a new folder in the studio's working folder.</p>
      <form onSubmit={(event) => { event.preventDefault(); void copy(); }}>
        <label class="field">Title<input value={title} onInput={(event) => setTitle(event.currentTarget.value)} autofocus /></label>
        {error && <p class="notice bad" role="alert">{error}</p>}
        <div class="buttons"><button type="button" onClick={onClose}>Cancel</button><button class="strong" type="submit" disabled={!title.trim()}>Copy and edit</button></div>
      </form>
    </Dialog>
  );
}
