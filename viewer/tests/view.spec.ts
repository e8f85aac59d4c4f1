// fredholm view in a browser: the light converges, is asked, dimmed, raced and sent on.

import { readFileSync } from 'node:fs';
import { expect, test, type Page } from '@playwright/test';
import { converged, FURNACE, meanColour, residual, run, serve, slide, visit, type Server } from './program';

let cornell: Server;
let furnace: Server;
test.beforeAll(async () => {
  [cornell, furnace] = await Promise.all([serve('--patch-count', '400'), serve(FURNACE, '--patch-count', '150')]);
});
test.afterAll(() => [cornell, furnace].forEach((server) => server?.stop()));

test('light is seen to converge, can be paused, stepped and scrubbed back', async ({ page }) => {
  await visit(page, cornell.address);
  await page.waitForFunction(() => Number(document.body.dataset['iteration']) > 20);
  const early = await residual(page);
  await page.getByRole('button', { name: 'Play or pause' }).click();
  await page.waitForTimeout(300);
  const at = Number(await page.locator('body').getAttribute('data-iteration'));
  await page.getByRole('button', { name: 'Step' }).click();
  await expect(page.locator('body')).toHaveAttribute('data-iteration', String(at + 1));
  await slide(page, '#scrub', 0);
  await expect(page.locator('body')).toHaveAttribute('data-iteration', '0');
  await expect(page.locator('#now')).toContainText('only the lamps shine');
  await slide(page, '#scrub', 1e6);
  await slide(page, '#speed', 1.5);
  await page.keyboard.press('Escape');
  await page.getByRole('button', { name: 'Play or pause' }).click();
  await converged(page);
  expect(await residual(page)).toBeLessThan(1e-3 * early);
  await expect(page.locator('#numbers')).toContainText('W/m²');
});

test('the picture has the brightness of the solution', async ({ page }) => {
  // In the furnace u = E/(1 − ρ) everywhere: 2, 4/3 and 4 W/m².
  await visit(page, `${furnace.address}#solver=gauss-seidel&speed=50&tone=linear&exposure=-2`);
  await converged(page);
  const exposure = await page.evaluate(async () => ((await (await fetch('scene.json')).json()) as { exposure: number }).exposure);
  const colour = await meanColour(page);
  [2, 4 / 3, 4].forEach((u, c) => {
    const expected = ((1.7 * exposure) / Math.PI) * 0.25 * u;
    expect(expected, 'the test must not look at what is cut off').toBeLessThan(0.95);
    expect(colour[c]! / expected).toBeCloseTo(1, 1.7);
  });
});

test('a dimmed lamp is that much less light, at once', async ({ page, context }) => {
  await visit(page, `${cornell.address}#solver=gauss-seidel&speed=50&tone=linear&exposure=-2`);
  await converged(page);
  const full = await meanColour(page, { x: 0.4, y: 0.5, width: 0.2, height: 0.3 });
  await slide(page, '#lamps input', 0.5);
  await expect(page.locator('#now')).toContainText('Relit');
  await expect(async () => {
    const half = await meanColour(page, { x: 0.4, y: 0.5, width: 0.2, height: 0.3 });
    for (const c of [0, 1]) expect(half[c]! / full[c]!).toBeCloseTo(0.5, 1.7);
  }).toPass();
  expect(page.url()).toContain('lamps=0.5');
  const relit = await meanColour(page);
  // Whoever is sent the address sees the same.
  const again = await context.newPage();
  await visit(again, page.url());
  await expect(again.locator('#now')).toContainText('Relit');
  await expect(async () => expect((await meanColour(again))[1]! / relit[1]!).toBeCloseTo(1, 1.7)).toPass();
  // Solved anew with that lamp it is the same.
  await page.getByRole('button', { name: 'Restart' }).click();
  await converged(page);
  const solved = await meanColour(page);
  for (const c of [0, 1]) expect(solved[c]! / relit[c]!).toBeCloseTo(1, 1.7);
});

test('brighter walls make more light', async ({ page }) => {
  await visit(page, `${furnace.address}#solver=gauss-seidel&speed=50&tone=linear&exposure=-2`);
  await converged(page);
  const before = await meanColour(page);
  // ρ = (1/2, 1/4, 3/4) times 0.4/0.75 is (4/15, 2/15, 2/5): u = E/(1 − ρ) again.
  await slide(page, '#materials input', 0.4);
  await expect(async () => {
    const after = await meanColour(page);
    [[0.5, 4 / 15], [0.25, 2 / 15], [0.75, 0.4]].forEach(([old, now], c) => {
      expect(after[c]! / before[c]!).toBeCloseTo((1 - old!) / (1 - now!), 1.7);
    });
  }).toPass();
});

test('a patch tells its numbers and its form factors', async ({ page }) => {
  await visit(page, `${cornell.address}#solver=gauss-seidel&speed=50`);
  await converged(page);
  const box = (await page.locator('#picture').boundingBox())!;
  await page.mouse.click(box.x + box.width / 2, box.y + box.height * 0.4);
  const readout = page.locator('#readout');
  await expect(readout).toContainText(/patch \d+ \(back\)/);
  await expect(readout).toContainText('W/m²');
  await expect(page).toHaveURL(/patch=\d+/);
  await page.getByLabel('quantity').selectOption('received');
  await expect(page.locator('#legend')).toContainText('F_ij: received by the patch, %');
  await expect(page.locator('#legend .ticks span')).not.toHaveCount(0);
  await page.keyboard.press('Escape');
  await expect(page.locator('#legend')).toContainText('Click a patch');
});

test('every quantity has a legend with its unit', async ({ page }) => {
  await visit(page, `${cornell.address}#solver=jacobi&speed=1&paused=1&rival=gauss-seidel`);
  for (const [display, words] of [
    ['radiosity', 'W/m²'], ['irradiance', 'W/m²'], ['unshot', 'residual |r|, W/m²'], ['error', 'error at most, W/m²'],
    ['difference', 'Jacobi: all at once minus Gauss–Seidel: gathering, W/m²'],
  ] as const) {
    await page.getByLabel('quantity').selectOption(display);
    await expect(page.locator('#legend figcaption')).toContainText(words);
  }
});

test('two solvers race, and the address says so', async ({ page, context }) => {
  await visit(page, `${cornell.address}#speed=2`);
  await page.getByLabel('race against').selectOption('gauss-seidel');
  await expect(page.locator('#lanes span')).toHaveCount(2);
  await page.waitForFunction(() => document.querySelectorAll('#numbers span').length === 2);
  await page.getByLabel('quantity').selectOption('difference');
  await expect(page.locator('#lanes span'), 'a difference is one picture').toHaveCount(0);
  await page.getByLabel('quantity').selectOption('radiosity');
  await page.keyboard.press('m');
  await expect(page).toHaveURL(/rival=gauss-seidel/);
  const again = await context.newPage();
  await visit(again, page.url());
  await expect(again.locator('#lanes span')).toHaveCount(2);
  await expect(again.getByLabel('quantity')).toHaveValue('radiosity');
  await expect(again.getByLabel('mesh')).toBeChecked();
});

test('the keyboard does what the mouse does', async ({ page }) => {
  await visit(page, `${cornell.address}#paused=1`);
  const body = page.locator('body');
  await page.keyboard.press('ArrowRight');
  await expect(body).toHaveAttribute('data-iteration', '1');
  await page.keyboard.press('ArrowLeft');
  await expect(body).toHaveAttribute('data-iteration', '0');
  await page.keyboard.press('2');
  await expect(page.getByLabel('quantity')).toHaveValue('radiosity');
  await page.keyboard.press(' ');
  await page.waitForFunction(() => Number(document.body.dataset['iteration']) > 5);
  await page.keyboard.press(' ');
  await page.waitForTimeout(500);
  const before = await meanColour(page);
  expect(Math.hypot(...(await meanColour(page)).map((c, k) => c - before[k]!)), 'it is not paused').toBeLessThan(1e-6);
  await page.keyboard.press('g');
  await page.locator('#picture').focus();
  await page.keyboard.down('w');
  await page.waitForTimeout(400);
  await page.keyboard.up('w');
  const after = await meanColour(page);
  expect(Math.hypot(...after.map((c, k) => c - before[k]!)), 'the eye has not moved').toBeGreaterThan(1e-3);
});

test('a phone has room for all of it, in the dark too', async ({ page }) => {
  await page.setViewportSize({ width: 360, height: 740 });
  await page.emulateMedia({ colorScheme: 'dark' });
  await visit(page, `${cornell.address}#show=radiosity&rival=gauss-seidel&speed=1`);
  expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(360);
  for (const id of ['picture', 'play', 'step', 'scrub', 'speed-said', 'curves', 'legend', 'formula']) {
    const box = (await page.locator(`#${id}`).boundingBox())!;
    const stage = (await page.locator('#stage').boundingBox())!;
    if (id === 'legend') expect(box.y >= stage.y && box.y + box.height <= stage.y + stage.height, 'legend').toBe(true);
    expect(box.x >= 0 && box.x + box.width <= 361 && box.y + box.height <= 740, `${id}: ${JSON.stringify(box)}`).toBe(true);
  }
});

test('the header has room for all that it says', async ({ page }) => {
  for (const [width, solver] of [[1200, 'southwell'], [900, 'successive'], [360, 'southwell']] as const) {
    await page.setViewportSize({ width, height: 740 });
    await visit(page, `${cornell.address}#solver=${solver}&speed=50`);
    await page.reload();
    await converged(page);
    await expect(page.locator('#now')).toContainText('Converged');
    const header = (await page.locator('#equation').boundingBox())!;
    for (const id of ['title', 'formula', 'now']) {
      const box = (await page.locator(`#${id}`).boundingBox())!;
      const fits = box.y >= header.y && box.y + box.height <= header.y + header.height + 1;
      expect(fits, `${id} of ${width}: ${JSON.stringify(box)} in ${JSON.stringify(header)}`).toBe(true);
      expect(await page.locator(`#${id}`).evaluate((all) => all.scrollHeight <= all.clientHeight + 1), `${id} of ${width} is cut off`).toBe(true);
    }
  }
});

/** Clicks a button of those that save, and reads what comes. */
async function saved(page: Page, name: string): Promise<Buffer> {
  const download = page.waitForEvent('download');
  await page.getByRole('button', { name, exact: true }).click();
  return readFileSync(await (await download).path());
}

test('every format can be saved', async ({ page }) => {
  // Two of them are pictures that are computed.
  test.slow();
  await visit(page, `${cornell.address}#solver=gauss-seidel&speed=50`);
  await converged(page);
  await page.getByText('Save', { exact: true }).click();
  for (const [name, begin] of [
    ['CSV', 'x,y,z,'], ['NPZ', 'PK'], ['JSON', '{'], ['picture', '\x89PNG'], ['photograph', '\x89PNG'],
    ['EXR', '\x76\x2f\x31\x01'], ['VTU', '<?xml'], ['GLB', 'glTF'],
  ] as const) {
    const content = await saved(page, name);
    expect(content.length, name).toBeGreaterThan(500);
    expect(content.toString('latin1').slice(0, begin.length)).toBe(begin);
  }
  // A picture in false colours has its scale with it.
  for (const [display, more] of [['light', 0], ['radiosity', 150]] as const) {
    await page.getByLabel('quantity').selectOption(display);
    await expect(page.locator('#legend')).toBeVisible({ visible: more > 0 });
    const { width } = (await page.locator('#picture').boundingBox())!;
    expect((await saved(page, 'picture')).readUInt32BE(16)).toBe(Math.round(width) + more);
  }
});

/** The mean over patches of the red radiosity in a table, of those that emit nothing. */
function meanRed(table: Buffer): number {
  const [head, ...rows] = table.toString().trim().split('\n').map((line) => line.split(','));
  const at = (name: string): number => head!.indexOf(name);
  const reflecting = rows.filter((row) => Number(row[at('emission_g')]) === 0);
  return reflecting.reduce((sum, row) => sum + Number(row[at('radiosity_r')]), 0) / reflecting.length;
}

test('what is saved is what is shown: a moment gone by, or the light as relit', async ({ page }) => {
  await visit(page, `${cornell.address}#solver=gauss-seidel&speed=50`);
  await converged(page);
  await page.getByText('Save', { exact: true }).click();
  const newest = meanRed(await saved(page, 'CSV'));
  expect(newest).toBeGreaterThan(0.01);
  await slide(page, '#scrub', 0);
  await expect(page.locator('body')).toHaveAttribute('data-iteration', '0');
  expect(meanRed(await saved(page, 'CSV')), 'before the first sweep only the lamps shine').toBe(0);
  const report = JSON.parse((await saved(page, 'JSON')).toString()) as { iterations: number; state: string };
  expect([report.iterations, report.state]).toEqual([0, 'a moment of the solver']);
  await slide(page, '#lamps input', 0.5);
  await expect(page.locator('#formula')).toContainText('Σ');
  await expect(async () => expect(meanRed(await saved(page, 'CSV')) / newest).toBeCloseTo(0.5, 2)).toPass();
  expect(JSON.parse((await saved(page, 'JSON')).toString())).toMatchObject({ iterations: null, residual: null, state: 'a sum over lamps' });
});

test('the method is switched, and the same light comes of each', async ({ page }) => {
  await visit(page, `${furnace.address}#solver=gauss-seidel&speed=50&tone=linear&exposure=-2`);
  await converged(page);
  const before = await meanColour(page);
  const shown = async (tolerance: number): Promise<void> => {
    await expect(page.locator('body')).not.toHaveAttribute('data-state', 'Asked');
    await converged(page);
    const now = await meanColour(page);
    for (const c of [0, 1]) expect(Math.abs(now[c]! / before[c]! - 1)).toBeLessThan(tolerance);
  };
  await page.locator('#space').selectOption('p1');
  await shown(0.02);
  await expect(page).toHaveURL(/space=p1/);
  await page.locator('#method-of').selectOption('collocation');
  await shown(0.02);
  await page.locator('#space').selectOption('p0');
  // Point to point is wrong where patches touch, by as much as they are large.
  await page.locator('#method-of').selectOption('nystrom');
  await shown(0.3);
  await expect(page).toHaveURL(/method=nystrom/);
  // Lamps are dimmed with this method, too.
  await slide(page, '#lamps label:first-child input', 0.5);
  await expect(page.locator('#now')).toContainText('Relit: the solution');
});

test('a page of its own shows the same without a server', async ({ page }, info) => {
  const path = info.outputPath('furnace.html');
  run('radiosity', FURNACE, '--patch-count', '150', '--solver', 'jacobi', '--html', path);
  await visit(page, `file://${path}#tone=linear&exposure=-2`);
  await converged(page);
  const exposure = await page.evaluate(
    () => (JSON.parse(document.getElementById('recording')!.textContent!) as { scene: { exposure: number } }).scene.exposure,
  );
  const colour = await meanColour(page);
  [2, 4 / 3, 4].forEach((u, c) => expect(colour[c]! / (((1.7 * exposure) / Math.PI) * 0.25 * u)).toBeCloseTo(1, 1.7));
  await slide(page, '#scrub', 0);
  await expect(page.locator('body')).toHaveAttribute('data-iteration', '1');
  await expect(page.getByRole('button', { name: 'Restart' })).toBeHidden();
});
