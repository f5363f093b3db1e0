import { type ChildProcess, spawn } from 'node:child_process';
import { cpSync, mkdtempSync, renameSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { expect, test as base, type Page } from '@playwright/test';

/** Where the tests' own games are; each test works on a copy. */
export const GAMES = join(import.meta.dirname, 'games');

/** A title that would run if a page took it for markup; a game's folder is named so at run time, since not every system allows it. */
export const HOSTILE = '<img src=x onerror="window.owned=1">';

/** The binary under test; without one the mock answers. */
const ARCADE = process.env.ARCADE;

export interface Studio {
  address: string;
  folder: string;
}

export type Mode = 'games' | 'empty' | 'corpus' | 'snapshot' | 'line' | 'judge' | 'results';

interface Fixtures {
  /** Starts a studio on a fresh copy of the tests' games, and ends it after the test. */
  studio: (mode: Mode) => Promise<Studio>;
  /** Fails the test if the page logged an error, broke the content policy, or let foreign text run. */
  quiet: undefined;
}

export const isMock = ARCADE === undefined;

function command(mode: Mode, folder: string): [string, string[]] {
  if (ARCADE === undefined) return ['node', [join(import.meta.dirname, 'mock.mjs'), mode, folder]];
  const common = ['studio', '--no-open'];
  switch (mode) {
    case 'games':
      return [ARCADE, [...common, folder]];
    case 'empty':
      return [ARCADE, [...common, join(folder, 'fresh')]];
    case 'corpus':
      return [ARCADE, [...common, '--out', folder]];
    case 'snapshot':
      return [ARCADE, [...common, process.env.SNAPSHOT ?? '', '--against', process.env.SNAPSHOT ?? '']];
    case 'line':
      return [ARCADE, [...common, join(folder, 'line/two')]];
    case 'results':
      return [ARCADE, [...common, process.env.RESULTS ?? '']];
    case 'judge':
      return [ARCADE, [...common, '--judge', folder, '--judge', folder, '--seed', 'tests', '--out', join(folder, 'judged.jsonl')]];
  }
}

/** Ends a program and waits for it: until then it may write. */
function ended(child: ChildProcess): Promise<unknown> {
  if (child.exitCode !== null || child.signalCode !== null) return Promise.resolve();
  const gone = new Promise((resolve) => child.once('exit', resolve));
  child.kill();
  return gone;
}

export const test = base.extend<Fixtures>({
  studio: async ({ page }, use) => {
    const children: ChildProcess[] = [];
    const folders: string[] = [];
    // Also after a test that failed.
    try {
      await use(async (mode) => {
        const folder = mkdtempSync(join(tmpdir(), 'studio-'));
        folders.push(folder);
        cpSync(GAMES, folder, { recursive: true });
        renameSync(join(folder, 'hostile-words'), join(folder, HOSTILE));
        if (mode === 'line') cpSync(process.env.LINE ?? '', join(folder, 'line'), { recursive: true });
        const [program, words] = command(mode, folder);
        const child = spawn(program, words, { stdio: ['ignore', 'pipe', 'pipe'] });
        children.push(child);
        let said = '';
        const address = await new Promise<string>((resolve, reject) => {
          const hear = (chunk: Buffer): void => {
            said += chunk.toString();
            const found = /http:\/\/[^\s]+token=[^\s]+/.exec(said);
            if (found) resolve(found[0]);
          };
          child.stdout.on('data', hear);
          child.stderr.on('data', hear);
          child.on('exit', () => reject(new Error(`${program} ${words.join(' ')} ended: ${said}`)));
        });
        return { address, folder };
      });
    } finally {
      // First, so that it asks nothing of a studio that has ended.
      await page.close();
      await Promise.all(children.map(ended));
      for (const folder of folders) rmSync(folder, { recursive: true, force: true });
    }
  },
  quiet: [
    async ({ page }, use) => {
      const errors: string[] = [];
      page.on('pageerror', (error) => errors.push(String(error)));
      page.on('console', (message) => {
        // A refusal is an answer that a test asks for; the browser logs its status all the same.
        if (message.type() === 'error' && !/status of (403|404|409)/.test(message.text())) errors.push(message.text());
      });
      page.on('request', (request) => {
        const { protocol, hostname } = new URL(request.url());
        if (!['data:', 'blob:', 'file:'].includes(protocol) && hostname !== '127.0.0.1') errors.push(`asked ${request.url()}`);
      });
      await use(undefined);
      expect(errors).toEqual([]);
    },
    { auto: true },
  ],
});

/** Opens a view; waits until something of it is shown. */
export async function open(page: Page, studio: Studio, route: string): Promise<void> {
  await page.goto(`${studio.address}#/${route}`);
  await expect(page.locator('main:not([aria-busy="true"])')).toBeVisible();
}

export { expect };
