// fredholm view on a phone: walking with two thumbs, turning and pinching.

import { expect, test, type CDPSession, type Page } from '@playwright/test';
import { serve, visit, type Server } from './program';

test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 });

let cornell: Server;
test.beforeAll(async () => {
  cornell = await serve('--patch-count', '300');
});
test.afterAll(() => cornell?.stop());

type Finger = { id: number; x: number; y: number };

const touch = (session: CDPSession, type: 'touchStart' | 'touchMove' | 'touchEnd', fingers: Finger[]): Promise<unknown> =>
  session.send('Input.dispatchTouchEvent', { type, touchPoints: fingers });

/** Where the eye is and what it looks at, as the address has it: six numbers. */
async function eye(page: Page): Promise<number[]> {
  await expect(page).toHaveURL(/camera=/);
  return new URLSearchParams(new URL(page.url()).hash.slice(1)).get('camera')!.split(',').map(Number);
}

/** The middle of an element, and a shift. */
async function at(page: Page, selector: string, id: number, dx = 0, dy = 0): Promise<Finger> {
  const box = (await page.locator(selector).boundingBox())!;
  return { id, x: box.x + box.width / 2 + dx, y: box.y + box.height / 2 + dy };
}

test('two thumbs walk: one goes, the other looks around', async ({ page }) => {
  await visit(page, `${cornell.address}#speed=1`);
  await expect(page.locator('#pad')).toBeHidden();
  await page.locator('#walk-here').tap();
  await expect(page.locator('#pad')).toBeVisible();
  const session = await page.context().newCDPSession(page);
  const thumb = await at(page, '#pad', 0);
  await touch(session, 'touchStart', [thumb]);
  await touch(session, 'touchMove', [{ ...thumb, y: thumb.y - 40 }]);
  await page.waitForTimeout(500);
  await touch(session, 'touchEnd', []);
  const gone = await eye(page);
  const { position, target } = await page.evaluate(
    async () => ((await (await fetch('scene.json')).json()) as { camera: { position: number[]; target: number[] } }).camera,
  );
  // Forward, along the line of sight.
  const ahead = target.map((t, k) => t - position[k]!);
  const way = gone.slice(0, 3).map((x, k) => x - position[k]!);
  const along = ahead.reduce((sum, a, k) => sum + a * way[k]!, 0) / Math.hypot(...ahead) / Math.hypot(...way);
  expect(along).toBeGreaterThan(0.999);
  // With one thumb on the pad the other turns the head; the eye stays when the first is still.
  const still = await at(page, '#pad', 0);
  const other = await at(page, '#picture', 1, 60, -40);
  await touch(session, 'touchStart', [still, other]);
  for (const dx of [-20, -40, -60]) await touch(session, 'touchMove', [still, { ...other, x: other.x + dx }]);
  await touch(session, 'touchEnd', []);
  const turned = await eye(page);
  expect(Math.hypot(...turned.slice(0, 3).map((x, k) => x - gone[k]!)), 'the eye moved').toBeLessThan(1e-4);
  expect(Math.hypot(...turned.slice(3).map((x, k) => x - gone[3 + k]!)), 'the head did not turn').toBeGreaterThan(0.05);
});

test('without walking a finger turns the scene and two pinch it', async ({ page }) => {
  await visit(page, `${cornell.address}#speed=1`);
  const session = await page.context().newCDPSession(page);
  const finger = await at(page, '#picture', 0);
  await touch(session, 'touchStart', [finger]);
  for (const dx of [15, 30, 45]) await touch(session, 'touchMove', [{ ...finger, x: finger.x + dx }]);
  await touch(session, 'touchEnd', []);
  const turned = await eye(page);
  const distance = (view: number[]): number => Math.hypot(...[0, 1, 2].map((k) => view[k]! - view[3 + k]!));
  const [left, right] = [await at(page, '#picture', 0, -30), await at(page, '#picture', 1, 30)];
  await touch(session, 'touchStart', [left, right]);
  for (const d of [10, 20, 40]) await touch(session, 'touchMove', [{ ...left, x: left.x - d }, { ...right, x: right.x + d }]);
  await touch(session, 'touchEnd', []);
  await expect(async () => expect(distance(await eye(page))).toBeLessThan(0.8 * distance(turned))).toPass();
});

for (const colorScheme of ['light', 'dark'] as const) {
  test(`all of it can be read and reached on a phone, ${colorScheme}`, async ({ page }, info) => {
    await page.emulateMedia({ colorScheme });
    await visit(page, `${cornell.address}#speed=1&show=radiosity&walk=1`);
    expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(390);
    // What is touched is as large as a finger tip, and nothing lies on the pad.
    for (const id of ['play', 'step', 'walk-here', 'rise', 'sink', 'pad']) {
      const box = (await page.locator(`#${id}`).boundingBox())!;
      expect(Math.min(box.width, box.height), id).toBeGreaterThanOrEqual(32);
      const hit = await page.evaluate(([x, y]) => document.elementFromPoint(x!, y!)?.closest('[id]')?.id, [box.x + box.width / 2, box.y + box.height / 2]);
      expect([id, 'knob'], `${id} is covered`).toContain(hit);
    }
    // Letters are no smaller than 11 px.
    const small = await page.evaluate(() =>
      [...document.querySelectorAll('p, span, label, button, figcaption, summary, dd')]
        .filter((e) => e.checkVisibility() && e.textContent?.trim() && parseFloat(getComputedStyle(e).fontSize) < 11)
        .map((e) => e.textContent));
    expect(small).toEqual([]);
    await page.screenshot({ path: info.outputPath(`phone-${colorScheme}.png`) });
  });
}
