import { readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import AxeBuilder from '@axe-core/playwright';
import type { Page } from '@playwright/test';
import { expect, HOSTILE, isMock, open, type Studio, test } from './studio';

test('a release is browsed, filtered, verified and compared', async ({ page, studio }) => {
  await open(page, await studio('snapshot'), '');
  const cards = page.locator('a.card');
  const all = await cards.count();
  expect(all).toBeGreaterThan(1);
  const name = (await cards.last().locator('.name').textContent()) ?? '';
  await page.getByRole('searchbox', { name: 'Find a game' }).fill(name);
  await expect(cards).toHaveCount(1);
  await page.keyboard.press('Enter');
  await expect(page.getByRole('heading', { level: 1 })).toHaveText(name);
  await expect(page.getByRole('heading', { name: 'The rules in words' })).toBeVisible();
  await page.getByRole('link', { name: /all games/ }).click();
  await page.getByRole('link', { name: 'Release', exact: true }).click();
  await page.getByRole('button', { name: 'Verify' }).click();
  await expect(page.getByText('Every digest agrees.')).toBeVisible();
  await expect(page.getByRole('list', { name: 'Files checked' }).getByRole('listitem').first()).toBeVisible();
  await expect(page.getByText(/first release of its chain|successor states/).first()).toBeVisible();
  await expect(page.getByText(/^Beside/)).toBeVisible();
});

test('games of tiers are browsed and filtered by them', async ({ page, studio }) => {
  await open(page, await studio(isMock ? 'snapshot' : 'line'), '');
  const cards = page.locator('a.card');
  await expect(cards.filter({ hasText: /tier 1.*tier 2/ }).first()).toBeVisible();
  await page.getByRole('combobox', { name: 'Tier' }).selectOption('tier 2');
  await expect(cards.first()).toBeVisible();
  await cards.first().click();
  await expect(page.locator('.levels').getByText(/^tier [12]$/).first()).toBeVisible();
});

test('verification follows the parent, and tells one that was altered', async ({ page, studio }) => {
  test.skip(isMock, 'the mock has no files of releases');
  const running = await studio('line');
  await open(page, running, 'release');
  const before = page.getByRole('list', { name: 'Releases before it' });
  await page.getByRole('button', { name: 'Verify' }).click();
  await expect(page.getByText('Every digest agrees.')).toBeVisible();
  await expect(before.getByRole('listitem')).toHaveCount(1);
  await expect(before.getByRole('img', { name: 'agrees' })).toBeVisible();
  await expect(before).toContainText('one');
  writeFileSync(join(running.folder, 'line/one/README.md'), 'tampered');
  await page.getByRole('button', { name: 'Verify' }).click();
  await expect(before.getByRole('img', { name: 'differs' })).toBeVisible();
  await expect(before).toContainText('README.md');
  await expect(page.getByText('but some related files do not')).toBeVisible();
  rmSync(join(running.folder, 'line/one'), { recursive: true });
  await page.getByRole('button', { name: 'Verify' }).click();
  await expect(before.getByRole('img', { name: 'not found' })).toBeVisible();
  await expect(page.getByText('Every digest agrees.')).toBeVisible();
});

/** Answers the two questions that have to be answered, and goes on. */
async function judge(page: Page): Promise<void> {
  await page.getByRole('group', { name: 'Which is the better game?' }).getByText('Right').click();
  await page.getByRole('group', { name: 'Which would you play again?' }).getByText('Both').click();
  await page.getByLabel(/In a few words/).fill('The hedges matter.');
  await page.getByRole('button', { name: 'Next' }).click();
}

test('a pair is played, watched and judged blind, and the report waits', async ({ page, studio }) => {
  const running = await studio('judge');
  await open(page, running, 'judge');
  await expect(page.getByRole('heading', { level: 1 })).toHaveText(/^Pair 1 of/);
  const [left, right] = [page.getByRole('region', { name: /^Left/ }), page.getByRole('region', { name: /^Right/ })];
  await left.locator('.player').focus();
  await page.keyboard.press('ArrowDown');
  await expect(left.locator('.tick')).toHaveText('1/1');
  await expect(right.locator('.tick')).toHaveText('0/0');
  // With the keyboard alone: the button keeps the focus while it changes.
  const watch = right.getByRole('button', { name: 'Watch a program play it' });
  await watch.focus();
  await page.keyboard.press('Enter');
  await expect(right.getByRole('region', { name: /played by a program/ })).toBeVisible();
  await expect(right.getByText('Won', { exact: true })).toBeVisible();
  await expect(right.getByRole('button', { name: 'Play it yourself' })).toBeFocused();
  await page.keyboard.press('Enter');
  await expect(watch).toBeFocused();
  await expect(right.locator('.tick')).toHaveText('0/0');
  // What was played of the other side stays.
  await left.getByRole('button', { name: 'Watch a program play it' }).click();
  await left.getByRole('button', { name: 'Play it yourself' }).click();
  await expect(left.locator('.tick')).toHaveText('1/1');
  await expect(page.getByRole('button', { name: 'Next' })).toBeDisabled();
  await judge(page);
  await expect(page.getByRole('heading', { level: 1 })).toHaveText(/^Pair 2 of/);

  await page.getByRole('link', { name: 'Report' }).click();
  await expect(page.getByText(/^1 of \d+ pairs are judged\./)).toBeVisible();
  await expect(page.getByRole('table')).toHaveCount(0);
  await page.getByRole('button', { name: 'Show the report and end blinding' }).click();
  await expect(page.getByRole('cell').first()).toBeVisible();
  await page.getByRole('link', { name: 'Back to judging' }).click();
  await judge(page);
  if (isMock) return;
  await expect(page.getByRole('heading', { level: 1 })).toHaveText(/^Pair 3 of/);
  interface Line { watched: { right: boolean }; played: { left: number }; after_report?: boolean }
  const lines = readFileSync(join(running.folder, 'judged.jsonl'), 'utf8').trim().split('\n').map((line) => JSON.parse(line) as Line);
  expect(lines.map((line) => [line.watched.right, line.played.left, line.after_report ?? false])).toEqual([[true, 1, false], [false, 0, true]]);
});

test('a program is watched on a phone', async ({ browser, studio }) => {
  const running = await studio('judge');
  const context = await browser.newContext({ viewport: { width: 375, height: 812 }, hasTouch: true, isMobile: true });
  const page = await context.newPage();
  await open(page, running, 'judge');
  const right = page.getByRole('region', { name: /^Right/ });
  await right.getByRole('button', { name: 'Watch a program play it' }).tap();
  await expect(right.getByText('Won', { exact: true })).toBeVisible();
  await right.getByRole('button', { name: 'Play it yourself' }).tap();
  await expect(right.getByText('Won', { exact: true })).toBeHidden();
  await context.close();
});

test('hostile names are shown as text and run nothing', async ({ page, studio }) => {
  const running = await studio('games');
  await open(page, running, '');
  await expect(page.getByText(HOSTILE).first()).toBeVisible();
  const id = encodeURIComponent(HOSTILE);
  for (const route of [`game/${id}`, `play/${id}/0`, `design/${id}/0`, `watch/${id}/${id}`, 'game/%3Cscript%3Ewindow.owned=1%3C%2Fscript%3E', `results/${id}`, id]) {
    await page.evaluate((address) => { location.hash = `#/${address}`; }, route).catch(() => undefined);
    await page.waitForTimeout(400);
    expect(await page.evaluate(() => ({ owned: 'owned' in window, nodes: document.querySelectorAll('#studio :is(script, iframe, [onerror], [onload], [src=x])').length }))).toEqual({ owned: false, nodes: 0 });
  }
});

test('a wrong token is refused with the next move', async ({ page, studio }) => {
  const { address } = await studio('games');
  await page.goto(address.replace(/token=.*/, 'token=wrong'));
  await expect(page.getByRole('alert')).toBeVisible();
});

/** Opens a view and looks for what screen readers would miss, for weak contrast, and for parts wider than the screen. */
async function inspect(page: Page, running: Studio, route: string): Promise<void> {
  await page.goto('about:blank');
  await open(page, running, route);
  await page.waitForTimeout(300);
  const { violations } = await new AxeBuilder({ page }).analyze();
  expect.soft(violations.map((one) => `${route}: ${one.id}: ${one.nodes.map((node) => node.target.join(' ')).join(', ')}`)).toEqual([]);
  expect.soft(await page.evaluate(() => document.documentElement.scrollWidth - innerWidth), `${route} is wider than the screen`).toBeLessThanOrEqual(0);
}

// Each view at both sizes, and in both schemes.
for (const [width, height, colorScheme] of [[1280, 800, 'light'], [375, 812, 'dark']] as const) {
  test(`every view is named for screen readers and fits, at ${width} pixels, ${colorScheme}`, async ({ page, studio }) => {
    await page.setViewportSize({ width, height });
    await page.emulateMedia({ colorScheme });
    const games = await studio('games');
    for (const route of ['', 'game/moth-and-lamps', 'play/moth-and-lamps/0', 'design/moth-and-lamps/0']) await inspect(page, games, route);
    await inspect(page, await studio('snapshot'), 'release');
    const results = await studio('results');
    for (const route of ['results', 'results/0']) await inspect(page, results, route);
    const judge = await studio('judge');
    for (const route of ['judge', 'judge/report']) await inspect(page, judge, route);
  });
}

test('the time to the first paint is printed', async ({ page, studio }) => {
  await open(page, await studio('games'), '');
  await expect(page.locator('a.card').first()).toBeVisible();
  const paint = await page.evaluate(() => new Promise<number>((resolve) => {
    new PerformanceObserver((list) => {
      const entry = list.getEntriesByName('first-contentful-paint')[0];
      if (entry) resolve(entry.startTime);
    }).observe({ type: 'paint', buffered: true });
  }));
  console.log(`first contentful paint: ${Math.round(paint)} ms`);
});

test('a game is begun where there is none, and the manual is a click away', async ({ page, studio }) => {
  test.skip(isMock, 'the mock cannot write');
  await open(page, await studio('empty'), '');
  await expect(page.getByText('There are no games here yet.')).toBeVisible();
  await page.getByRole('button', { name: 'New game' }).click();
  await page.getByLabel('Title').fill('River Post');
  await page.getByLabel(/crossing/).check();
  await page.getByRole('button', { name: 'Begin' }).click();
  await expect(page.getByRole('navigation', { name: 'Levels' }).getByRole('link', { name: '0' })).toBeVisible();
  await expect(page.getByText(/^Can be won in/)).toBeVisible();
  await expect(page.getByRole('radio', { name: /symbol A/ })).toHaveCount(0);
  await page.getByRole('button', { name: 'Help' }).click();
  await expect(page.getByRole('heading', { name: 'Your first game' })).toBeVisible();
  await page.locator('.cm-line', { hasText: 'hedgehog boat' }).getByText('pullWithIt').click();
  await page.getByRole('button', { name: /^Explain/ }).click();
  await expect(page.getByRole('heading', { name: 'pullWithIt' })).toBeVisible();
  await page.goto(page.url().replace(/#.*/, '#/help/first-game'));
  await expect(page.getByRole('heading', { name: 'Your first game' })).toBeVisible();
});
