import { mkdirSync } from 'node:fs';
import { expect, type Mode, open, test } from './studio';

// Pictures of every view, to be looked at: `LOOK=1 npx playwright test look` writes them into shots/.
test.skip(process.env.LOOK === undefined, 'set LOOK=1 to take pictures');

const VIEWS: [string, Mode, string][] = [
  ['browse', 'corpus', ''],
  ['game', 'corpus', 'game/first-ice'],
  ['play', 'corpus', 'play/first-ice/4'],
  ['design', 'corpus', 'design/quiet-jars/1'],
  ['whole', 'games', 'design/moth-and-lamps/0'],
  ['removal', 'games', 'design/moth-and-lamps/1'],
  ['broken', 'games', 'design/moth-and-lamps/0'],
  ['snapshot', 'snapshot', ''],
  ['release', 'snapshot', 'release'],
  ['line', 'line', 'release'],
  ['watch', 'snapshot', ''],
  ['judge', 'judge', 'judge'],
  ['watched', 'judge', 'judge'],
  ['report', 'judge', 'judge/report'],
  ['results', 'results', 'results'],
  ['result', 'results', 'results/2'],
];

for (const [name, mode, route] of VIEWS) {
  test(`pictures of ${name}`, async ({ page, studio }) => {
    mkdirSync('shots', { recursive: true });
    const running = await studio(mode);
    for (const scheme of ['light', 'dark'] as const) {
      for (const [width, height] of [[1280, 800], [375, 812]] as const) {
        await page.emulateMedia({ colorScheme: scheme });
        await page.setViewportSize({ width, height });
        await page.goto('about:blank');
        await open(page, running, route);
        if (name === 'watch') {
          await page.locator('a.card').first().click();
          await page.getByRole('link', { name: /^watch/ }).first().click();
          await page.getByRole('slider', { name: 'Rewind' }).fill('20');
        }
        if (name === 'broken') {
          if (width === 375) await page.getByRole('button', { name: 'Rules' }).click();
          await page.locator('.cm-line', { hasText: 'lamp moth' }).click();
          await page.keyboard.press('Home');
          await page.keyboard.type('z');
          await page.keyboard.press('Escape');
          await expect(page.getByRole('list', { name: 'Problems' })).toBeVisible();
        }
        if (name === 'whole') {
          if (width === 375) await page.getByRole('button', { name: 'Verdict', exact: true }).click();
          await page.locator('.whole .criteria').scrollIntoViewIfNeeded();
        }
        if (name === 'removal') await page.getByRole('button', { name: 'Remove this level' }).click();
        if (name === 'watched') {
          await page.getByRole('button', { name: 'Watch a program play it' }).first().click();
          await expect(page.getByText('Won', { exact: true })).toBeVisible();
        }
        if (name === 'release' || name === 'line') await page.getByRole('button', { name: 'Verify' }).click();
        await page.waitForTimeout(name === 'design' ? 2500 : 900);
        await page.screenshot({ path: `shots/${name}-${width}-${scheme}.png` });
        if (width === 375) await page.screenshot({ path: `shots/${name}-${width}-${scheme}-full.png`, fullPage: true });
      }
    }
  });
}
