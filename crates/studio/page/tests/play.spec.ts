import { readFileSync } from 'node:fs';
import { expect, open, test } from './studio';

const WAY = ['ArrowDown', 'ArrowDown', 'ArrowRight', 'ArrowRight'];

test('a level is played to its win, rewound, recorded and opened again', async ({ page, studio }) => {
  await open(page, await studio('games'), 'play/moth-and-lamps/0');
  await expect(page.getByText('Score 0')).toBeVisible();
  for (const [ticks, key] of WAY.entries()) {
    await page.keyboard.press(key);
    await expect(page.locator('.tick')).toHaveText(`${ticks + 1}/${ticks + 1}`);
  }
  await expect(page.getByText('Won', { exact: true })).toBeVisible();
  await expect(page.getByText('Score 1')).toBeVisible();

  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Save episode' }).click()]);
  const file = await download.path();
  expect(JSON.parse(readFileSync(file, 'utf8'))).toHaveProperty('actions');

  await page.keyboard.press('z');
  await expect(page.locator('.tick')).toHaveText('3/4');
  await expect(page.getByText('Won', { exact: true })).toBeHidden();
  await page.keyboard.press('r');
  await expect(page.locator('.tick')).toHaveText('0/4');
  // What came after is dropped as soon as someone plays on from here.
  await page.keyboard.press('d');
  await expect(page.locator('.tick')).toHaveText('1/1');

  await page.locator('input[type=file]').setInputFiles(file);
  await expect(page.locator('.tick')).toHaveText('0/4');
  await page.getByRole('slider', { name: 'Rewind' }).fill('4');
  await expect(page.getByText('Won', { exact: true })).toBeVisible();
});

test('a planner is watched, by the step and on its own', async ({ page, studio }) => {
  await open(page, await studio('games'), 'play/moth-and-lamps/0');
  await page.getByRole('combobox', { name: 'Planner' }).selectOption('mcts');
  await page.getByRole('button', { name: 'Step', exact: true }).click();
  await expect(page.locator('.tick')).toHaveText('1/1');
  await page.getByRole('button', { name: 'Let it run' }).click();
  await expect(page.getByText('Won', { exact: true })).toBeVisible();
});

test('with the clock running a game goes on by itself, at the chosen pace', async ({ page, studio }) => {
  await open(page, await studio('games'), 'play/moth-and-lamps/0');
  await page.getByRole('checkbox', { name: 'Wait for me each turn' }).uncheck();
  await page.keyboard.press('+');
  await expect(page.getByText('16 ticks per second')).toBeVisible();
  await page.keyboard.press('p');
  await expect(page.locator('.tick')).toHaveText(/^([5-9]|\d\d)\//);
  await page.keyboard.press('p');
  await expect(page.getByRole('button', { name: 'Run (P)' })).toBeVisible();
  // A tick that was under way when the clock stopped still arrives.
  await page.waitForTimeout(200);
  const stopped = await page.locator('.tick').textContent();
  await page.waitForTimeout(300);
  expect(await page.locator('.tick').textContent()).toBe(stopped);
});

test('a recorded win is watched from its level', async ({ page, studio }) => {
  await open(page, await studio('snapshot'), '');
  await page.locator('a.card').first().click();
  await page.getByRole('link', { name: /^watch/ }).first().click();
  await expect(page.locator('.tick')).toHaveText(/^0\/\d+/);
  await page.keyboard.press('ArrowRight');
  await expect(page.locator('.tick')).toHaveText(/^1\//);
  await page.keyboard.press('+');
  await page.keyboard.press('+');
  await page.keyboard.press('p');
  await expect(page.getByText('Won', { exact: true })).toBeVisible();
});

test('fingers play on the pad', async ({ browser, studio }) => {
  const running = await studio('games');
  const context = await browser.newContext({ viewport: { width: 375, height: 812 }, hasTouch: true, isMobile: true });
  const page = await context.newPage();
  await open(page, running, 'play/moth-and-lamps/0');
  for (const [ticks, name] of ['down', 'down', 'right', 'right'].entries()) {
    await page.getByRole('button', { name, exact: true }).tap();
    await expect(page.locator('.tick')).toHaveText(`${ticks + 1}/${ticks + 1}`);
  }
  await expect(page.getByText('Won', { exact: true })).toBeVisible();
  await context.close();
});

test('what a model was asked and what it answered stand beside the board', async ({ page, studio }) => {
  await open(page, await studio('results'), 'results');
  await page.getByRole('link', { name: /^Watch/ }).first().click();
  await expect(page.getByRole('heading', { name: 'Answer' })).toBeVisible();
  await expect(page.getByLabel('Prompt', { exact: true })).not.toBeEmpty();
  await page.getByRole('button', { name: 'Later' }).click();
  await expect(page.getByText('Turn 2 of')).toBeVisible();
});
