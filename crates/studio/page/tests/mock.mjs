// A stand-in for the server: it answers the contract for games of hedges and lamps, so that the page can be worked on alone.
// Usage: node mock.mjs games|snapshot|judge|results [FOLDER]; the first line of output is the address.
import { createServer } from 'node:http';
import { createHash, randomUUID } from 'node:crypto';
import { existsSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const mode = process.argv[2] ?? 'games';
const here = dirname(fileURLToPath(import.meta.url));
const folder = process.argv[3] ?? join(here, 'games');
const bundle = process.env.STUDIO_BUNDLE ?? join(here, '../../bundle');
const token = randomUUID();
const digest = (text) => createHash('sha256').update(text).digest('hex');

const tile = (inside) => `<svg viewBox="0 0 1 1" xmlns="http://www.w3.org/2000/svg">${inside}</svg>`;
const LOOKS = {
  floor: tile('<path d="M0 0H1V1H0Z" fill="#f4f0e7"/>'),
  hedge: tile('<path d="M0 0H1V1H0Z" fill="#61574f"/><path d="M0 .03H.47V.3H0ZM.53 .03H1V.3H.53ZM.2 .36H.8V.64H.2ZM0 .7H.47V.97H0ZM.53 .7H1V.97H.53Z" fill="#8c7864"/>'),
  lamp: tile('<path d="M.5 .1 .61 .38.9 .4.67 .58.75 .87.5 .7.25 .87.33 .58.1 .4.39 .38Z" fill="#f5c842" stroke="#222630" stroke-width=".04"/>'),
  moth: tile('<circle cx=".5" cy=".5" r=".44" fill="#fff" stroke="#1f9fd6" stroke-width=".08"/><circle cx=".5" cy=".42" r=".15" fill="#c4571a"/><path d="M.3 .8Q.5 .4.7 .8Z" fill="#c4571a"/>'),
};
const NAMES = Object.keys(LOOKS);
const TILES = NAMES.map((id) => ({ id, svg: LOOKS[id] }));

function mapping(source) {
  const part = /LevelMapping([\s\S]*?)\n {4}\w/.exec(source)?.[1] ?? '';
  return [...part.matchAll(/^\s+(\S) > (.+)$/gm)].map(([, symbol, types]) => ({ symbol, types: types.trim().split(/\s+/) }));
}
const sprites = (source) => [.../SpriteSet([\s\S]*?)\n {4}\w/.exec(source)[1].matchAll(/^\s+(\w+) >/gm)].map((found) => found[1]);
function near(word, names) {
  const score = (name) => [...name].filter((letter, at) => word[at] === letter || word[at - 1] === letter || word[at + 1] === letter).length / Math.max(name.length, word.length);
  return names.map((name) => [score(name), name]).sort((a, b) => b[0] - a[0])[0];
}
function problems(source) {
  const names = sprites(source);
  const found = [];
  let offset = 0;
  let section = '';
  source.split('\n').forEach((line, index) => {
    section = /^ {4}(\w+)$/.exec(line)?.[1] ?? section;
    const words = section === 'InteractionSet' ? /^\s{8}(\w+) (\w+) >/.exec(line)?.slice(1) : /stype=(\w+)/.exec(line)?.slice(1);
    for (const word of words ?? []) {
      if (names.includes(word) || word === 'EOS') continue;
      const start = offset + line.indexOf(word);
      const [, guess] = near(word, names);
      found.push({ code: 'unknown-sprite', severity: 'error', message: `no sprite named \`${word}\``, label: 'not in the SpriteSet', help: `did you mean \`${guess}\`?`, start, end: start + word.length, line: index + 1, column: start - offset + 1, fixes: [{ title: `Change to ${guess}`, edits: [{ start, end: start + word.length, text: guess }] }], page: 'unknown-sprite' });
    }
    offset += line.length + 1;
  });
  return found;
}
function levelProblems(source, level) {
  let start = -1;
  const symbols = mapping(source).map((one) => one.symbol);
  return level.split('\n').flatMap((line, y) => [...`${line}\n`].flatMap((symbol, x) => ((start += 1), symbol === '\n' || symbols.includes(symbol) ? [] : [{ code: 'unknown-symbol', severity: 'error', message: `\`${symbol}\` is not in the LevelMapping`, label: '', help: null, start, end: start + 1, line: y + 1, column: x + 1, fixes: [{ title: 'Write `w`', edits: [{ start, end: start + 1, text: 'w' }] }], page: null }])));
}
const describe = () => 'How you play:\n  You are the moth: the arrow keys move you up, left, down and right.\n\nHow you win:\n  You win when no lamp is left.\n\nWhat happens when sprites meet:\n  You cannot enter the hedge.\n  The lamp disappears on touching you. You gain 1 point.\n';

function begin(source, level) {
  const map = new Map(mapping(source).map((one) => [one.symbol, one.types]));
  const cells = level.replace(/\n+$/, '').split('\n').map((line) => [...line].map((symbol) => map.get(symbol) ?? ['floor']));
  const width = Math.max(...cells.map((row) => row.length));
  const lamps = [];
  let moth = null;
  cells.forEach((row, y) => row.forEach((types, x) => {
    if (types.includes('lamp')) lamps.push(`${x},${y}`);
    if (types.includes('moth')) moth = [x, y];
  }));
  return { cells, width, height: cells.length, lamps, moth, tick: 0, score: 0, outcome: 'playing' };
}
const WAYS = { ACTION_LEFT: [-1, 0], ACTION_RIGHT: [1, 0], ACTION_UP: [0, -1], ACTION_DOWN: [0, 1], ACTION_NIL: [0, 0] };
function step(state, action) {
  if (state.outcome !== 'playing') return state;
  const [dx, dy] = WAYS[action] ?? [0, 0];
  const next = { ...state, tick: state.tick + 1 };
  if (state.moth) {
    const [x, y] = [state.moth[0] + dx, state.moth[1] + dy];
    const types = state.cells[y]?.[x];
    if (types && !types.includes('hedge')) next.moth = [x, y];
    next.lamps = state.lamps.filter((lamp) => lamp !== next.moth.join());
    next.score += state.lamps.length - next.lamps.length;
  }
  if (next.lamps.length === 0) next.outcome = 'won';
  else if (next.tick > 200) next.outcome = 'lost';
  return next;
}
function frame(state) {
  const marks = [];
  state.cells.forEach((row, y) => row.forEach((types, x) => {
    for (const type of types) {
      if ((type === 'lamp' && !state.lamps.includes(`${x},${y}`)) || type === 'moth') continue;
      if (NAMES.includes(type)) marks.push([NAMES.indexOf(type), x, y, 1, 1]);
    }
  }));
  if (state.moth) marks.push([3, ...state.moth, 1, 1]);
  return { width: state.width, height: state.height, marks, caption: [], tick: state.tick, score: state.score, outcome: state.outcome, actions: Object.keys(WAYS).slice(0, 4) };
}
function search(start) {
  let open = [{ state: start, actions: [] }];
  const seen = new Set();
  while (open.length > 0) {
    const next = [];
    for (const { state, actions } of open) {
      for (const action of Object.keys(WAYS).slice(0, 4)) {
        const after = step(state, action);
        if (after.outcome === 'won') return { actions: [...actions, action], seen: seen.size };
        const key = `${after.moth} ${after.lamps}`;
        if (!seen.has(key)) {
          seen.add(key);
          next.push({ state: after, actions: [...actions, action] });
        }
      }
    }
    open = next;
  }
  return { actions: null, seen: seen.size };
}
function play(source, level, actions) {
  const states = [begin(source, level)];
  for (const action of actions) states.push(step(states.at(-1), action));
  return states;
}

const toml = (text, name) => {
  const found = new RegExp(`^${name} = (.*)$`, 'm').exec(text);
  return found ? JSON.parse(found[1]) : null;
};
const dirs = new Map(readdirSync(folder).map((id) => [id, join(folder, id)]));
function game(id) {
  const dir = dirs.get(id);
  const read = (name) => readFileSync(join(dir, name), 'utf8');
  const file = (name) => ({ name, text: read(name), digest: digest(read(name)) });
  const card = existsSync(join(dir, 'CARD.toml')) ? read('CARD.toml') : '';
  const levels = readdirSync(dir).filter((name) => /^lvl\d+\.txt$/.test(name)).sort().map(file);
  if (mode === 'games') return { id, title: id, writable: true, source: file('game.vgdl'), levels, card: null, witnesses: [], describe: describe() };
  const fields = Object.fromEntries(['title', 'description', 'goal', 'kind', 'skill', 'real_time'].map((name) => [name, toml(card, name)]));
  fields.levels = [...card.matchAll(/^intent = (.*)$/gm)].map((found) => ({ intent: JSON.parse(found[1]) }));
  return { id, title: fields.title ?? id, writable: mode === 'games', source: file('game.vgdl'), levels, card: fields, witnesses: levels.map((level, index) => ({ name: `lvl${index}`, level: index })), describe: describe() };
}
const entry = (id) => {
  const of = game(id);
  return { id, title: of.title, levels: of.levels.length, writable: of.writable, summary: of.card?.description ?? '', tile: frame(begin(of.source.text, of.levels[0].text)), tiles: TILES, kind: of.card?.kind ?? null };
};

const sessions = new Map();
const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
let judged = 0;
let ended = false;
const side = (id) => {
  const of = game(id);
  return { title: of.title, describe: of.describe, source: of.source.text, levels: of.levels.map((level) => level.text) };
};

const ROUTES = {
  'GET workspace': () => ({ kind: { snapshot: 'snapshot', results: 'results' }[mode] ?? 'games', name: mode === 'snapshot' ? 'april' : 'games', version: 'mock', games: mode === 'judge' ? [] : [...dirs.keys()].map(entry), judge: mode === 'judge' }),
  'POST check': ({ source, levels }) => ({ problems: problems(source), levels: levels.map((level) => ({ problems: levelProblems(source, level.replace(/\n+$/, '')) })), describe: describe(), legend: problems(source).length ? [] : mapping(source).map(({ symbol, types }) => ({ symbol, types, label: types.join(', '), tile: Math.max(0, NAMES.indexOf(types.at(-1))) })), tiles: TILES }),
  'POST hover': ({ source, at }) => {
    const word = [...source.matchAll(/\w+/g)].find((found) => found.index <= at && at <= found.index + found[0].length);
    return word ? { start: word.index, end: word.index + word[0].length, markdown: `**${word[0]}**: a word of *VGDL*.` } : null;
  },
  'POST complete': ({ source, at }) => ({ start: at - /\w*$/.exec(source.slice(0, at))[0].length, end: at, items: ['killSprite', 'stepBack', ...sprites(source)].map((label) => ({ label, detail: 'a word', markdown: `\`${label}\``, insert: label })) }),
  'POST rename': ({ source, at, name }) => {
    const word = [...source.matchAll(/\w+/g)].find((found) => found.index <= at && at <= found.index + found[0].length)[0];
    return { levels: [], edits: [...source.matchAll(new RegExp(`\\b${word}\\b`, 'g'))].map((found) => ({ start: found.index, end: found.index + word.length, text: name })) };
  },
  'POST format': ({ source }) => ({ text: source.replace(/[ \t]+$/gm, '') }),
  'POST definition': () => null,
  'POST page': ({ name }) => ({ markdown: `# ${name}\n\nA page of the manual.\n\n| a | b |\n|---|---|\n| 1 | \`2\` |\n` }),
  'POST board': ({ source, level }) => ({ tiles: TILES, frame: frame(begin(source, level)), problems: [], cells: begin(source, level).cells }),
  'POST play/begin': ({ source, level }) => {
    const session = randomUUID();
    sessions.set(session, { states: [begin(source, level)], actions: [] });
    return { session, tiles: TILES, frame: frame(sessions.get(session).states[0]) };
  },
  'POST play/act': ({ session, action, planner }) => {
    const of = sessions.get(session);
    const chosen = action ?? (planner ? (search(of.states.at(-1)).actions?.[0] ?? 'ACTION_NIL') : 'ACTION_NIL');
    of.states.push(step(of.states.at(-1), chosen));
    of.actions.push(chosen);
    return { tiles: [], frame: frame(of.states.at(-1)), action: chosen };
  },
  'POST play/seek': ({ session, tick }) => {
    const of = sessions.get(session);
    of.states.length = tick + 1;
    of.actions.length = tick;
    return { tiles: [], frame: frame(of.states.at(-1)) };
  },
  'POST play/episode': ({ session }) => ({ actions: sessions.get(session).actions }),
  'GET planners': () => [{ name: 'mcts', help: 'Monte-Carlo tree search' }, { name: 'random', help: 'any action' }],
  'POST replay': ({ source, level, episode }) => ({ tiles: TILES, frames: play(source, level, episode.actions).map(frame), actions: episode.actions, agrees: true, note: null }),
  'GET release': () => ({ name: 'april', root: digest('root'), parent: digest('parent'), format: 3, semantics: 12, generation: 4, sealed: false, games: [...dirs.keys()].map((id) => ({ id, title: game(id).title, kind: game(id).card.kind, levels: game(id).levels.map((level, at) => ({ name: level.name, tier: at + 1, difficulty: at ? 'very_hard' : 'easy', ticks: 4, width: 8, height: 5 })), tiles: TILES, frame: entry(id).tile })) }),
  'GET release/compare': () => ({ other: 'march', new: [...dirs.keys()], gone: ['old-game'], kept: [], changed: [], nearest: [...dirs.keys()].map((id) => ({ id, other: 'old-game', distance: 0.41 })) }),
  'GET results': () => ({ players: [{ name: 'a-model', episodes: [{ index: 0, game: 'moth-and-lamps', level: 0, run: 0, outcome: 'won', score: 1, steps: 6 }] }] }),
  'GET results/0': () => {
    const of = game('moth-and-lamps');
    const { actions } = search(begin(of.source.text, of.levels[0].text));
    return { title: 'a-model on Moth and Lamps, level 0', tiles: TILES, frames: play(of.source.text, of.levels[0].text, actions).map(frame), actions, talk: actions.map((action, at) => ({ frame: at, prompt: `Tick ${at}. The board:\n${of.levels[0].text}`, answer: `I go on.\n${action}`, parsed: action, validity: 'valid' })) };
  },
  'GET judge': () => (judged >= 2 ? { pair: 2, of: 2, done: true, left: null, right: null } : { pair: judged, of: 2, done: false, left: side([...dirs.keys()][0]), right: side([...dirs.keys()][1]) }),
  'POST judge': () => { judged += 1; return {}; },
  'POST judge/watch': ({ side, level }) => {
    const of = game([...dirs.keys()][side === 'left' ? 0 : 1]);
    const { actions } = search(begin(of.source.text, of.levels[level].text));
    return { tiles: TILES, frames: play(of.source.text, of.levels[level].text, actions).map(frame), actions, agrees: true, note: null };
  },
  'POST judge/end': () => { ended = true; return {}; },
  'GET judge/report': () => (judged < 2 && !ended ? { blind: true, judged, of: 2 } : { blind: false, judged, of: 2, sources: [{ name: 'a', wins: judged, losses: 0, ties: 0, rate: 1, low: 0.3, high: 1 }], measures: [{ name: 'drama', agrees: 1, pairs: 2, rate: 0.5, low: 0.1, high: 0.9 }] }),
};
const STREAMS = {
  async *verdict({ source, level }) {
    yield { stage: 'problems', problems: [...problems(source), ...levelProblems(source, level.replace(/\n+$/, ''))] };
    if (problems(source).length) return;
    const start = begin(source, level);
    const open = [start.moth ?? [0, 0]];
    const seen = new Set();
    while (open.length) {
      const [x, y] = open.pop();
      if (seen.has(`${x},${y}`) || !start.cells[y]?.[x] || start.cells[y][x].includes('hedge')) continue;
      seen.add(`${x},${y}`);
      open.push([x + 1, y], [x - 1, y], [x, y + 1], [x, y - 1]);
    }
    const cells = start.lamps.filter((lamp) => !seen.has(lamp)).map((lamp) => lamp.split(',').map(Number));
    const rule = (text) => ({ line: source.slice(0, source.indexOf(text)).split('\n').length, start: source.indexOf(text), end: source.indexOf(text) + text.length });
    yield { stage: 'reach', reachable: ['floor'], unreachable: cells.length ? [{ type: 'lamp', cells }] : [], why: cells.map((cell) => ({ text: 'the lamp is walled in by the hedge', cell, rule: rule('moth hedge > stepBack') })) };
    if (cells.length) yield { stage: 'impossible', text: 'A lamp that has to go cannot be reached.', states: seen.size };
    else {
      yield { stage: 'search', calls: 100 };
      const { actions, seen } = search(start);
      yield { stage: 'win', ticks: actions.length, shortest: true, calls: seen * 4, episode: { actions } };
      await pause(30);
      yield { stage: 'criterion', name: 'not-idle', verdict: 'pass', text: 'doing nothing does not win', evidence: [], episode: null };
      yield { stage: 'criterion', name: 'not-random', verdict: 'fail', text: '40 of 40 random plays won', evidence: [{ text: 'a random play wins', tick: 2, cell: null, rule: null }], episode: { actions } };
      yield { stage: 'ladder', rows: [{ player: 'random', wins: 5, plays: 40, low: 0.05, high: 0.26 }, { player: 'mcts:100', wins: 12, plays: 12, low: 0.76, high: 1 }] };
    }
  },
  async *necessity() {
    yield { stage: 'criterion', name: 'necessity', verdict: 'pass', text: 'every rule matters', evidence: [], episode: null };
  },
  async *more({ level, source, count }) {
    for (let at = 0; at < count; at += 1) {
      await pause(20);
      yield { stage: 'level', level, tiles: at === 0 ? TILES : [], frame: frame(begin(source, level)), ticks: 7 + at };
    }
  },
  async *'release/verify'() {
    const files = [...dirs.keys()].flatMap((id) => [`games/${id}/game.vgdl`, `games/${id}/lvl0.txt`]);
    for (const [at, path] of files.entries()) yield { stage: 'file', path, ok: true, done: at + 1, total: files.length };
    yield { stage: 'ancestor', name: 'march', root: digest('parent'), place: 'march', ok: true, text: 'every file agrees with this root, which `april` names as its parent' };
    yield { stage: 'verdict', ok: true, sound: true, lines: [`root ${digest('root')}`] };
  },
};

const CSP = "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
const TYPES = { html: 'text/html; charset=utf-8', js: 'text/javascript', css: 'text/css' };
const server = createServer(async (request, response) => {
  const { pathname } = new URL(request.url, 'http://localhost');
  const answer = (status, value, type = 'application/json') => {
    response.writeHead(status, { 'Content-Type': type, 'Content-Security-Policy': CSP, 'X-Content-Type-Options': 'nosniff', 'Referrer-Policy': 'no-referrer', 'Cache-Control': 'no-store' });
    response.end(typeof value === 'string' || Buffer.isBuffer(value) ? value : JSON.stringify(value));
  };
  if (!pathname.startsWith('/api/')) {
    const file = pathname === '/' ? 'index.html' : pathname.slice(1);
    if (!['index.html', 'app.js', 'app.css'].includes(file)) return answer(404, 'no such file', 'text/plain');
    return answer(200, readFileSync(join(bundle, file)), TYPES[file.split('.')[1]]);
  }
  if (request.headers['x-arcade-token'] !== token) return answer(403, { error: 'wrong token', help: null });
  const chunks = [];
  for await (const chunk of request) chunks.push(chunk);
  try {
    const body = chunks.length ? JSON.parse(Buffer.concat(chunks).toString()) : {};
    const name = pathname.slice(5);
    const parts = name.split('/').map(decodeURIComponent);
    if (STREAMS[name] && request.method === 'POST') {
      response.writeHead(200, { 'Content-Type': 'application/x-ndjson' });
      for await (const line of STREAMS[name](body)) response.write(`${JSON.stringify(line)}\n`);
      return response.end(`${JSON.stringify({ stage: 'done' })}\n`);
    }
    if (parts[0] === 'games' && parts.length > 1) {
      if (!dirs.has(parts[1])) return answer(404, { error: 'there is no such game here', help: null });
      const of = game(parts[1]);
      const files = [of.source, ...of.levels];
      if (parts.length === 2) return answer(200, of);
      if (parts[2] === 'versions') return answer(200, { files: Object.fromEntries(files.map((file) => [file.name, file.digest])) });
      if (parts[2] === 'witness') return answer(200, { actions: search(begin(of.source.text, of.levels[Number(parts[3].slice(3))].text)).actions });
      const now = files.find((file) => file.name === parts[3]);
      if ((now?.digest ?? null) !== body.base) return answer(409, { error: `${parts[3]} was changed by another program`, help: null, text: now?.text, digest: now?.digest });
      if (request.method === 'DELETE') {
        rmSync(join(dirs.get(parts[1]), parts[3]));
        return answer(200, {});
      }
      writeFileSync(join(dirs.get(parts[1]), parts[3]), body.text);
      return answer(200, { digest: digest(body.text) });
    }
    const route = ROUTES[`${request.method} ${name}`];
    if (!route) return answer(404, { error: `no such question: ${name}`, help: null });
    return answer(200, route(body));
  } catch (error) {
    return answer(500, { error: String(error.message), help: null });
  }
});
server.listen(0, '127.0.0.1', () => console.log(`http://127.0.0.1:${server.address().port}/?token=${token}`));
