import { mkdirSync } from 'node:fs';
import { open, test } from './studio';

// Pictures of every view, to be looked at: `LOOK=1 npx playwright test look` writes them into shots/.
test.skip(process.env.LOOK === undefined, 'set LOOK=1 to take pictures');

const VIEWS: [string, 'games' | 'snapshot' | 'judge' | 'results', string][] = [
  ['browse', 'snapshot', ''],
  ['game', 'games', 'game/moth-and-lamps'],
  ['release', 'snapshot', 'release'],
  ['play', 'games', 'play/moth-and-lamps/0'],
  ['watch', 'snapshot', 'watch/moth-and-lamps/lvl0'],
  ['design', 'games', 'design/moth-and-lamps/1'],
  ['judge', 'judge', 'judge'],
  ['report', 'judge', 'judge/report'],
  ['results', 'results', 'results'],
  ['result', 'results', 'results/0'],
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
        await page.waitForTimeout(900);
        await page.screenshot({ path: `shots/${name}-${width}-${scheme}.png` });
        if (width === 375) await page.screenshot({ path: `shots/${name}-${width}-${scheme}-full.png`, fullPage: true });
      }
    }
  });
}
