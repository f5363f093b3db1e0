import { existsSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from '@playwright/test';
import { expect, isMock, open, test } from './studio';

const VIEW = 'design/moth-and-lamps/0';

/** Clicks a square of the level. */
async function paint(page: Page, x: number, y: number): Promise<void> {
  const canvas = page.locator('.paint canvas');
  const box = await canvas.boundingBox();
  if (!box) throw new Error('the level is not shown');
  const cell = box.width / 8;
  await canvas.click({ position: { x: (x + 0.5) * cell, y: (y + 0.5) * cell } });
}

/** Misspells the sprite in the line that collects lamps. */
async function misspell(page: Page): Promise<void> {
  await page.locator('.cm-line', { hasText: 'lamp moth' }).click();
  await page.keyboard.press('Home');
  for (let letter = 0; letter < 4; letter += 1) await page.keyboard.press('Delete');
  await page.keyboard.type('lmap', { delay: 20 });
  await page.keyboard.press('Escape');
}

test('a level that cannot be won says why, and can be won again after an undo', async ({ page, studio }) => {
  await open(page, await studio('games'), VIEW);
  await expect(page.getByText('Can be won in 4 ticks')).toBeVisible();
  await page.getByRole('radio', { name: /^hedge/ }).click();
  await paint(page, 2, 3);
  await paint(page, 4, 3);
  await expect(page.getByText('Cannot be won', { exact: true })).toBeVisible();
  await expect(page.getByRole('heading', { name: 'Out of reach' })).toBeVisible();
  await page.locator('.verdict .evidence button').first().click();
  await page.locator('.paint canvas').focus();
  await page.keyboard.press('Control+z');
  await expect(page.getByText(/^Can be won in/)).toBeVisible();
  await page.keyboard.press('Control+Shift+Z');
  await expect(page.getByText('Cannot be won', { exact: true })).toBeVisible();
});

test('a level is painted with the keyboard alone, and the cursor is announced', async ({ page, studio }) => {
  await open(page, await studio('games'), VIEW);
  await expect(page.getByText('Can be won in 4 ticks')).toBeVisible();
  await page.locator('.paint canvas').focus();
  for (const key of ['ArrowDown', 'ArrowRight', 'ArrowRight', 'ArrowDown', 'ArrowDown', 'ArrowDown']) await page.keyboard.press(key);
  await expect(page.locator('.under')).toContainText('Column 3, row 4: floor');
  await page.keyboard.press('w');
  await expect(page.locator('.under')).toContainText('Column 3, row 4: hedge');
  await expect(page.getByText('Can be won in 6 ticks')).toBeVisible();
});

test('a misspelt name is underlined, and a click repairs it', async ({ page, studio }) => {
  const running = await studio('games');
  await open(page, running, VIEW);
  await expect(page.getByText('Can be won in 4 ticks')).toBeVisible();
  await misspell(page);
  const problem = page.getByRole('list', { name: 'Problems' }).getByRole('listitem').filter({ hasText: 'lmap' }).first();
  await expect(problem).toBeVisible();
  await expect(page.locator('.cm-lintRange-error').first()).toBeVisible();
  await problem.getByRole('button', { name: /lamp/ }).click();
  await expect(page.locator('.cm-line', { hasText: 'lamp moth' })).toBeVisible();
  await expect(page.getByRole('list', { name: 'Problems' })).toBeHidden();
  await expect(page.getByText('Can be won in 4 ticks')).toBeVisible();

  await misspell(page);
  await expect(problem).toBeVisible();
  await page.keyboard.press('Control+.');
  await expect(page.getByRole('list', { name: 'Problems' })).toBeHidden();
});

test('names are renamed everywhere, completed and explained', async ({ page, studio }) => {
  await open(page, await studio('games'), VIEW);
  await page.locator('.cm-line', { hasText: 'lamp moth' }).click();
  await page.keyboard.press('Home');
  await page.keyboard.press('F2');
  await page.getByLabel('New name').fill('lantern');
  await page.getByRole('button', { name: 'Rename everywhere' }).click();
  await expect(page.locator('.cm-line', { hasText: 'lantern' })).toHaveCount(4);
  await expect(page.getByText('Can be won in 4 ticks')).toBeVisible();
  // A level character changes in the levels too.
  if (!isMock) {
    await page.locator('.cm-line', { hasText: 'l > floor lantern' }).click();
    await page.keyboard.press('Home');
    await page.keyboard.press('F2');
    await page.getByLabel('New name').fill('x');
    await page.getByRole('button', { name: 'Rename everywhere' }).click();
    await expect(page.locator('.cm-line', { hasText: 'x > floor lantern' })).toBeVisible();
    await expect(page.getByText('Can be won in 4 ticks')).toBeVisible();
    await page.getByRole('button', { name: 'Text', exact: true }).click();
    await expect(page.getByLabel('Level as text')).toHaveValue(/w\.\.x\.w\.w/);
  }
  await page.locator('.cm-line', { hasText: 'lantern moth' }).getByText('killSprite').hover();
  await expect(page.locator('.cm-tooltip-hover')).toContainText(/\w/);
  await page.mouse.move(1, 1);
  await expect(page.locator('.cm-tooltip-hover')).toBeHidden();
  await page.locator('.cm-line', { hasText: 'moth hedge' }).click();
  await page.keyboard.press('End');
  await page.keyboard.press('Enter');
  await page.keyboard.type('lantern hedge > kill', { delay: 30 });
  await expect(page.locator('.cm-tooltip-autocomplete')).toContainText('killSprite');
});

test('files are saved, and what another program wrote is not overwritten', async ({ page, studio }) => {
  const running = await studio('games');
  const file = join(running.folder, 'moth-and-lamps/lvl0.txt');
  await open(page, running, VIEW);
  await expect(page.getByText('Can be won in 4 ticks')).toBeVisible();
  await page.getByRole('radio', { name: /^hedge/ }).click();
  await paint(page, 1, 3);
  await page.keyboard.press('Control+s');
  await expect(page.getByText('Saved lvl0.txt.')).toBeVisible();
  expect(readFileSync(file, 'utf8').split('\n')[3]).toBe('ww.l.w.w');

  await paint(page, 4, 3);
  const outside = readFileSync(file, 'utf8').replace('wa', 'w.').replace('.....w', '....aw');
  writeFileSync(file, outside);
  await expect(page.getByText(/lvl0.txt changed outside, and here too/)).toBeVisible();
  await page.keyboard.press('Control+s');
  await expect(page.getByRole('dialog')).toContainText('changed outside');
  await page.getByRole('button', { name: 'Keep mine' }).click();
  await page.keyboard.press('Control+s');
  await expect(page.getByText('Saved lvl0.txt.')).toBeVisible();
  expect(readFileSync(file, 'utf8').split('\n')[3]).toBe('ww.lww.w');

  writeFileSync(file, outside);
  await expect(page.getByText('lvl0.txt changed outside and was reloaded.')).toBeVisible();
});

test('a made level is inserted, and evidence plays in the board', async ({ page, studio }) => {
  await open(page, await studio('games'), VIEW);
  await expect(page.getByText('Can be won in 4 ticks')).toBeVisible();
  await page.getByRole('button', { name: 'Watch' }).click();
  await expect(page.locator('.tick')).toHaveText(/\/4$/);
  await page.getByRole('button', { name: 'Back to painting' }).click();
  await page.getByRole('tab', { name: 'More like this' }).click();
  await page.getByRole('button', { name: 'Make six' }).click();
  const second = page.locator('.more canvas').nth(1);
  await second.scrollIntoViewIfNeeded({ timeout: 20_000 });
  await expect.poll(() => second.evaluate((canvas: HTMLCanvasElement) => canvas.getContext('2d')?.getImageData(0, 0, 1, 1).data[3])).toBe(255);
  await page.getByRole('button', { name: 'Add', exact: true }).first().click();
  await expect(page.getByRole('navigation', { name: 'Levels' }).getByRole('link')).toHaveCount(3);
  await page.getByRole('tab', { name: 'Verdict' }).click();
  await expect(page.getByText(/^Can be won in/)).toBeVisible();
});

test('a level with a fault says what is wrong and offers the repair', async ({ page, studio }) => {
  await open(page, await studio('games'), VIEW);
  await page.getByRole('button', { name: 'Text', exact: true }).click();
  const text = page.getByLabel('Level as text');
  await text.fill((await text.inputValue()).replace('..l.w', '..l?w'));
  const problem = page.getByRole('list', { name: 'Problems of the level' }).getByRole('listitem').filter({ hasText: 'not in the LevelMapping' });
  await expect(problem).toBeVisible();
  await problem.locator('.fix').first().click();
  await expect(problem).toBeHidden();
});

test('fingers paint on a phone, and the verdict is a tap away', async ({ browser, studio }) => {
  const running = await studio('games');
  const context = await browser.newContext({ viewport: { width: 375, height: 812 }, hasTouch: true, isMobile: true });
  const page = await context.newPage();
  await open(page, running, VIEW);
  await page.getByRole('radio', { name: /^hedge/ }).tap();
  const box = await page.locator('.paint canvas').boundingBox();
  if (!box) throw new Error('the level is not shown');
  for (const x of [2.5, 4.5]) await page.touchscreen.tap(box.x + (x * box.width) / 8, box.y + (3.5 * box.width) / 8);
  await page.getByRole('button', { name: 'Verdict', exact: true }).tap();
  await expect(page.getByText('Cannot be won', { exact: true })).toBeVisible();
  await context.close();
});

test('the whole game is judged in the background, and never in the way', async ({ page, studio }) => {
  await open(page, await studio('games'), VIEW);
  const whole = page.locator('.whole');
  const judged: string[] = [];
  page.on('request', (request) => { if (request.url().endsWith('/api/necessity')) judged.push(request.url()); });
  await expect(page.getByText('Can be won in 4 ticks')).toBeVisible();
  await expect(whole.locator('.criteria')).toContainText('necessity');
  expect(judged).toHaveLength(1);
  await expect(whole.getByText('of an earlier text')).toBeHidden();
  // A change keeps the result, marked, until there is a new one.
  await page.getByRole('radio', { name: /^hedge/ }).click();
  await paint(page, 1, 3);
  await expect(whole.getByText('of an earlier text')).toBeVisible();
  await expect(whole.locator('.criteria')).toContainText('necessity');
  await expect(page.getByText(/^Can be won in/)).toBeVisible();
  await expect(whole.getByText('of an earlier text')).toBeHidden();
  expect(judged).toHaveLength(2);
  // Switched off, it waits for the button.
  await whole.getByRole('checkbox', { name: 'in the background' }).uncheck();
  await page.locator('.paint canvas').focus();
  await page.keyboard.press('Control+z');
  await expect(whole.getByText('of an earlier text')).toBeVisible();
  await page.waitForTimeout(3800);
  expect(judged).toHaveLength(2);
  await whole.getByRole('button', { name: 'Judge all levels' }).click();
  await expect(whole.getByText('of an earlier text')).toBeHidden();
});

test('the manual opens at a word and at a problem', async ({ page, studio }) => {
  await open(page, await studio('games'), VIEW);
  const title = page.getByRole('tabpanel').locator('.prose h3').first();
  await page.locator('.cm-line', { hasText: 'lamp moth' }).getByText('killSprite').click();
  await page.keyboard.press('F1');
  await expect(page.getByRole('tab', { name: 'Manual' })).toHaveAttribute('aria-selected', 'true');
  await expect(title).toHaveText(/killSprite/);
  await misspell(page);
  await expect(page.locator('.cm-lintRange-error').first()).toBeVisible();
  await page.locator('.cm-lintRange-error').first().click();
  await page.keyboard.press('F1');
  await expect(title).toHaveText('unknown-sprite');
});

test('a name leads to its definition, by key and by click', async ({ page, studio }) => {
  test.skip(isMock, 'the mock knows no definitions');
  await open(page, await studio('games'), VIEW);
  const definition = page.locator('.cm-activeLine', { hasText: 'lamp > Immovable' });
  const use = page.locator('.cm-line', { hasText: 'stype=lamp' });
  await use.click();
  await page.keyboard.press('Home');
  for (let step = 0; step < 'SpriteCounter stype=l'.length; step += 1) await page.keyboard.press('ArrowRight');
  await page.keyboard.press('F12');
  await expect(definition).toBeVisible();
  // Away from words, which are explained above the others.
  await page.mouse.move(1, 1);
  await expect(page.locator('.cm-tooltip-hover')).toBeHidden();
  await page.locator('.cm-line', { hasText: 'moth hedge' }).click();
  await expect(definition).toBeHidden();
  // Plain names have no element of their own.
  const line = page.locator('.cm-line', { hasText: 'lamp moth' });
  const position = await line.evaluate((node) => {
    const texts = document.createTreeWalker(node, NodeFilter.SHOW_TEXT);
    for (let text = texts.nextNode(); text; text = texts.nextNode()) {
      const at = text.nodeValue?.indexOf('lamp') ?? -1;
      if (at < 0) continue;
      const range = document.createRange();
      range.setStart(text, at + 1);
      range.setEnd(text, at + 3);
      const [name, whole] = [range.getBoundingClientRect(), node.getBoundingClientRect()];
      return { x: name.x + name.width / 2 - whole.x, y: name.y + name.height / 2 - whole.y };
    }
    throw new Error('the name is not shown');
  });
  await line.click({ position, modifiers: ['Control'] });
  await expect(definition).toBeVisible();
});

test('evidence leads to the rule that it names', async ({ page, studio }) => {
  await open(page, await studio('games'), VIEW);
  await page.getByRole('radio', { name: /^hedge/ }).click();
  await paint(page, 2, 3);
  await paint(page, 4, 3);
  // Between the two, another verdict has other evidence.
  await expect(page.getByText('Cannot be won', { exact: true })).toBeVisible();
  const cause = page.locator('.verdict .evidence li', { hasText: / line \d/ }).first();
  await expect(cause).toBeVisible();
  const line = Number(/ line (\d+)/.exec((await cause.textContent()) ?? '')?.[1]);
  await cause.getByRole('button').click();
  await expect(page.locator('.cm-shown')).toHaveCount(1);
  const shown = await page.locator('.cm-shown').evaluate((node) => [...(node.parentElement?.children ?? [])].indexOf(node) + 1);
  expect(shown).toBe(line);
  await expect(page.locator('.cm-content')).toBeFocused();
});

test('a game of the corpus is saved as a copy with the changes', async ({ page, studio }) => {
  test.skip(isMock, 'the mock has no corpus');
  const running = await studio('corpus');
  await open(page, running, 'design/hailglass/0');
  await page.getByRole('button', { name: 'Text', exact: true }).click();
  const level = page.getByLabel('Level as text');
  const before = await level.inputValue();
  const after = `${before.split('\n')[0]}\n${before}`;
  await level.fill(after);
  await page.locator('.cm-line').first().click();
  await page.keyboard.press('End');
  await page.keyboard.type(' # mine');
  await page.keyboard.press('Control+s');
  await page.getByRole('dialog').getByLabel('Title').fill('My Hail');
  await page.getByRole('dialog').getByRole('button', { name: 'Save' }).click();
  await expect(page).toHaveURL(/#\/design\/my-hail\/0$/);
  await expect(page.getByRole('link', { name: 'My Hail' })).toBeVisible();
  const file = (name: string): string => readFileSync(join(running.folder, 'my-hail', name), 'utf8');
  expect(file('lvl0.txt')).toBe(after);
  expect(file('game.vgdl').split('\n')[0]).toBe('BasicGame # mine');
  await page.getByRole('button', { name: 'Text', exact: true }).click();
  await expect(level).toHaveValue(after);
  await expect(page.getByRole('button', { name: 'Save', exact: true })).toBeVisible();
});

test('the last level is removed after a question, and no other', async ({ page, studio }) => {
  const running = await studio('games');
  const file = join(running.folder, 'moth-and-lamps/lvl1.txt');
  await open(page, running, VIEW);
  const tabs = page.getByRole('navigation', { name: 'Levels' });
  const remove = tabs.getByRole('button', { name: 'Remove this level' });
  await expect(tabs.getByRole('link')).toHaveCount(2);
  await expect(remove).toBeHidden();
  await tabs.getByRole('link').last().click();
  await remove.click();
  await page.getByRole('dialog').getByRole('button', { name: 'Keep it' }).click();
  expect(existsSync(file)).toBe(true);
  await remove.click();
  await expect(page.getByRole('dialog')).toContainText('lvl1.txt');
  await page.getByRole('dialog').getByRole('button', { name: 'Remove it' }).click();
  await expect(tabs.getByRole('link')).toHaveCount(1);
  await expect(page.getByText('Removed lvl1.txt.')).toBeVisible();
  expect(existsSync(file)).toBe(false);
  await expect(remove).toBeHidden();
  // One that was never saved goes without a trace, and the next takes its number.
  await tabs.getByRole('button', { name: 'Add a level' }).click();
  await remove.click();
  await page.getByRole('dialog').getByRole('button', { name: 'Remove it' }).click();
  await expect(tabs.getByRole('link')).toHaveCount(1);
  await tabs.getByRole('button', { name: 'Add a level' }).click();
  await page.keyboard.press('Control+s');
  await expect(page.getByText('Saved lvl1.txt.')).toBeVisible();
  // Removed by another program, it goes here too.
  rmSync(file);
  await expect(page.getByText('lvl1.txt was removed outside.')).toBeVisible();
  await expect(tabs.getByRole('link')).toHaveCount(1);
});

test('a game without a character for the floor has an eraser', async ({ page, studio }) => {
  test.skip(isMock, 'the mock does not compile rules');
  await open(page, await studio('games'), VIEW);
  await expect(page.getByText('Can be won in 4 ticks')).toBeVisible();
  await expect(page.getByRole('radio', { name: /^eraser/ })).toHaveCount(0);
  const line = page.locator('.cm-line', { hasText: '. > floor' });
  await line.click();
  await page.keyboard.press('End');
  await page.keyboard.press('Shift+Home');
  await page.keyboard.press('Delete');
  await page.getByRole('radio', { name: /^eraser/ }).click();
  await paint(page, 1, 3);
  await page.getByRole('button', { name: 'Text', exact: true }).click();
  await expect(page.getByLabel('Level as text')).toHaveValue(/\nw /);
});
