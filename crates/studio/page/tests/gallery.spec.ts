import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { expect, test } from './studio';

const ARCADE = process.env.ARCADE;
const folders: string[] = [];

test.afterEach(() => {
  for (const folder of folders.splice(0)) rmSync(folder, { recursive: true, force: true });
});

test('a static gallery is browsed and watched from the disk, without a server', async ({ page }) => {
  test.skip(ARCADE === undefined, 'the mock writes no gallery');
  const folder = mkdtempSync(join(tmpdir(), 'gallery-'));
  folders.push(folder);
  const out = join(folder, 'out');
  execFileSync(ARCADE ?? '', ['gallery', process.env.SNAPSHOT ?? '', '--out', out, '--quiet']);
  await page.goto(pathToFileURL(join(out, 'index.html')).href);
  const first = page.locator('a.card').first();
  const name = (await first.locator('.name').textContent()) ?? '';
  await first.click();
  await expect(page.getByRole('heading', { level: 1 })).toHaveText(name);
  await expect(page.getByRole('link', { name: 'Design' })).toHaveCount(0);
  await expect(page.locator('.levels canvas').first()).toBeVisible();
  await page.getByRole('link', { name: /^watch/ }).first().click();
  const last = Number(await page.getByRole('slider', { name: 'Rewind' }).getAttribute('max'));
  expect(last).toBeGreaterThan(0);
  await page.getByRole('slider', { name: 'Rewind' }).fill(String(last));
  await expect(page.getByText('Won', { exact: true })).toBeVisible();
  await page.goto(`${pathToFileURL(join(out, 'index.html')).href}#/release`);
  await expect(page.getByRole('heading', { name: 'Games and levels' })).toBeVisible();
});
