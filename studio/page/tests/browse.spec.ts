import AxeBuilder from '@axe-core/playwright';
import type { Page } from '@playwright/test';
import { expect, HOSTILE, open, type Studio, test } from './studio';

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
  await expect(page.getByText(/^Beside/)).toBeVisible();
});

test('one pair is judged blind, and the report counts it', async ({ page, studio }) => {
  await open(page, await studio('judge'), 'judge');
  await expect(page.getByRole('heading', { level: 1 })).toHaveText(/^Pair 1 of/);
  const left = page.locator('.player').first();
  await left.focus();
  await page.keyboard.press('ArrowDown');
  await expect(left.locator('.tick')).toHaveText('1/1');
  await expect(page.locator('.player').last().locator('.tick')).toHaveText('0/0');
  await expect(page.getByRole('button', { name: 'Next' })).toBeDisabled();
  await page.getByRole('group', { name: 'Which is the better game?' }).getByText('Right').click();
  await page.getByRole('group', { name: 'Which would you play again?' }).getByText('Both').click();
  await page.getByLabel(/In a few words/).fill('The hedges matter.');
  await page.getByRole('button', { name: 'Next' }).click();
  await expect(page.getByRole('heading', { level: 1 })).toHaveText(/^(Pair 2 of|All pairs)/);
  await page.getByRole('link', { name: /Report|See what/ }).click();
  await expect(page.getByRole('cell').first()).toBeVisible();
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
