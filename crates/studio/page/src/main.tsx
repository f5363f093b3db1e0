import { render } from 'preact';
import { useEffect, useState } from 'preact/hooks';
import { takeToken } from './data/api';
import { live } from './data/studio';
import * as studio from './data/studio';
import type { Game, Workspace } from './data/types';
import { Design } from './design/Design';
import { useAsked } from './parts/hooks';
import { href, type Route, useRoute } from './parts/route';
import { Browse } from './views/Browse';
import { GamePage } from './views/GamePage';
import { HelpPage } from './views/HelpPage';
import { Judge, JudgeReportPage } from './views/Judge';
import { Play } from './views/Play';
import { ReleasePage } from './views/ReleasePage';
import { ResultPage, ResultsPage } from './views/ResultsPage';
import './style.css';
import './design.css';

function Studio() {
  const route = useRoute();
  const [version, setVersion] = useState(0);
  const asked = useAsked(() => studio.workspace(), [version]);
  const [kept, setKept] = useState<Workspace | null>(null);
  useEffect(() => {
    if (asked.value) setKept(asked.value);
  }, [asked.value]);
  const workspace = asked.value ?? kept;
  if (asked.error && !workspace) return <Trouble text={asked.error} />;
  if (!workspace) return <><header class="top"><Mark /></header><main aria-busy="true" /></>;
  return <Views route={route} workspace={workspace} onChanged={() => setVersion((before) => before + 1)} />;
}

function Views({ route, workspace, onChanged }: { route: Route; workspace: Workspace; onChanged: () => void }) {
  const [view = workspace.judge && workspace.games.length === 0 ? 'judge' : workspace.kind === 'results' && workspace.games.length === 0 ? 'results' : 'browse', id = ''] = route;
  const ofGame = view === 'game' || view === 'play' || view === 'watch' || view === 'design';
  if (ofGame) return <OfGame key={id} view={view} id={id} rest={route[2] ?? null} workspace={workspace} onChanged={onChanged} />;
  return (
    <>
      <Top view={view} workspace={workspace} game={null} />
      <Plain view={view} rest={route[1] ?? null} workspace={workspace} onChanged={onChanged} />
    </>
  );
}

function Plain({ view, rest, workspace, onChanged }: { view: string; rest: string | null; workspace: Workspace; onChanged: () => void }) {
  switch (view) {
    case 'browse':
      return <Browse workspace={workspace} onChanged={onChanged} />;
    case 'help':
      return <HelpPage key={rest} name={rest ?? 'first-game'} />;
    case 'release':
      return <ReleasePage />;
    case 'results':
      return rest === null ? <ResultsPage /> : <ResultPage index={rest} />;
    case 'judge':
      return rest === 'report' ? <JudgeReportPage /> : <Judge />;
    default:
      return <Trouble text="There is no such page." />;
  }
}

function OfGame({ view, id, rest, workspace, onChanged }: { view: string; id: string; rest: string | null; workspace: Workspace; onChanged: () => void }) {
  // Another view of a game reads it afresh: the design view may have saved it.
  const asked = useAsked<Game>(() => studio.game(id), [id, view]);
  const game = asked.value;
  const level = Number(rest ?? 0) || 0;
  return (
    <>
      <Top view={view} workspace={workspace} game={game} />
      {asked.error && <Trouble text={asked.error} />}
      {!game && !asked.error && <main aria-busy="true" />}
      {game && view === 'game' && <GamePage game={game} workspace={workspace} onCopied={onChanged} />}
      {game && view === 'play' && live && <Play game={game} level={level} watch={null} />}
      {game && !live && (view === 'play' || view === 'design') && <Trouble text="A gallery has no server to play or write games: it shows recorded wins." />}
      {game && view === 'watch' && <Play game={game} level={0} watch={rest ?? ''} />}
      {game && view === 'design' && live && <Design game={game} level={level} onChanged={onChanged} />}
    </>
  );
}

/** The bar at the top: where one is, and where one can go. */
function Top({ view, workspace, game }: { view: string; workspace: Workspace; game: Game | null }) {
  const link = (name: string, label: string, ...parts: (string | number)[]) => (
    <a href={href(...parts)} aria-current={view === name ? 'page' : undefined}>{label}</a>
  );
  return (
    <header class="top">
      <button type="button" class="skip" onClick={toContent}>Skip to the content</button>
      <Mark />
      <nav aria-label="Views">
        {game ? (
          <>
            <a class="here" href={href('game', game.id)} aria-current={view === 'game' ? 'page' : undefined}>{game.title}</a>
            {live && link('play', 'Play', 'play', game.id, 0)}
            {live && link('design', 'Design', 'design', game.id, 0)}
          </>
        ) : (
          <>
            {(workspace.games.length > 0 || workspace.templates.length > 0) && !workspace.judge && <a href="#/" aria-current={view === 'browse' ? 'page' : undefined}>Games</a>}
            {workspace.kind === 'snapshot' && link('release', 'Release', 'release')}
            {workspace.kind === 'results' && link('results', 'Results', 'results')}
            {workspace.judge && link('judge', 'Judge', 'judge')}
          </>
        )}
        {live && view !== 'design' && link('help', 'Help', 'help', 'first-game')}
      </nav>
    </header>
  );
}

function Mark() {
  return (
    <a class="mark" href="#/" aria-label="Infinite Arcade, all games">
      <svg viewBox="0 0 20 20" width="20" height="20" aria-hidden="true"><circle cx="10" cy="10" r="8" fill="none" stroke="currentColor" stroke-width="2.5" /><path d="M8 6.8v6.4l5-3.2z" fill="currentColor" /></svg>
      <span>Infinite Arcade</span>
    </a>
  );
}

function toContent(): void {
  const main = document.querySelector('main');
  main?.setAttribute('tabindex', '-1');
  main?.focus();
}

function Trouble({ text }: { text: string }) {
  return <main class="trouble"><h1>This did not work</h1><p role="alert">{text}</p><p><a href="#/">All games</a></p></main>;
}

function start(): void {
  takeToken();
  const root = document.getElementById('studio');
  if (root) render(<Studio />, root);
}

// Deferred scripts run before this event: the gallery's data, if they are there, have arrived.
if (document.readyState === 'complete') start();
else document.addEventListener('DOMContentLoaded', start, { once: true });
