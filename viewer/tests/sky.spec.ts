// The sky behind the scene: as bright as the solver has it, in every direction, dimmed with its lamp, and no quantity.

import { writeFileSync } from 'node:fs';
import { expect, test, type Page } from '@playwright/test';
import { converged, DAYLIGHT, meanColour, run, serve, slide, visit, type Server } from './program';

let clear: Server;
let overcast: Server;
test.beforeAll(async () => {
  const of = (name: string): Promise<Server> => serve(`${DAYLIGHT}/${name}.toml`, '--patch-count', '200', '--solver', 'gauss-seidel');
  [clear, overcast] = await Promise.all([of('daylight'), of('overcast')]);
});
test.afterAll(() => [clear, overcast].forEach((server) => server?.stop()));

/** From high above the room, a bright sky on a dim screen. */
const settings = (direction: number[]): string =>
  `#speed=50&tone=linear&exposure=-4&camera=0,0,200,${direction.map((x, k) => 10 * x + (k === 2 ? 200 : 0)).join(',')}`;
const MIDDLE = { x: 0.49, y: 0.49, width: 0.02, height: 0.02 };
const exposureOf = (page: Page): Promise<number> =>
  page.evaluate(async () => ((await (await fetch('scene.json')).json()) as { exposure: number }).exposure);

/** Up by so many degrees, towards an azimuth from north. */
function towards(elevation: number, azimuth: number): [number, number, number] {
  const [e, a] = [elevation, azimuth].map((degrees) => (degrees * Math.PI) / 180) as [number, number];
  return [Math.cos(e) * Math.sin(a), Math.cos(e) * Math.cos(a), Math.sin(e)];
}

test('an overcast sky is as bright as its horizontal illuminance says', async ({ page }) => {
  for (const elevation of [70, 30, 8]) {
    await visit(page, overcast.address + settings(towards(elevation, 40)));
    await page.reload();
    await converged(page);
    // ∫ L cos Z dω = 7π/9 L_z = 10 000 lx.
    const luminance = ((9 * 10_000) / (7 * Math.PI)) * ((1 + 2 * Math.sin((elevation * Math.PI) / 180)) / 3);
    const expected = (1.7 * (await exposureOf(page)) * luminance) / 16;
    expect(expected, 'the test must not look at what is cut off').toBeLessThan(0.95);
    for (const c of await meanColour(page, MIDDLE)) expect(c / expected).toBeCloseTo(1, 1.7);
  }
});

test('a clear sky has its bright side about the sun and its dark one across', async ({ page }) => {
  const sun = towards(42, 205);
  const angle = (a: number[], b: number[]): number => Math.acos(a.reduce((sum, x, k) => sum + x * b[k]!, 0));
  // ISO 15469, type 12, in parts of any one number.
  const luminance = (direction: number[]): number => {
    const chi = angle(direction, sun);
    const indicatrix = 1 + 10 * (Math.exp(-3 * chi) - Math.exp((-3 * Math.PI) / 2)) + 0.45 * Math.cos(chi) ** 2;
    return indicatrix * (1 - Math.exp(-0.32 / direction[2]!));
  };
  const seen: number[][] = [];
  const directions = [towards(75, 205), towards(60, 25), towards(25, 25), towards(15, 180)];
  for (const direction of directions) {
    await visit(page, clear.address + settings(direction));
    await page.reload();
    await converged(page);
    seen.push(await meanColour(page, MIDDLE));
  }
  for (const k of [1, 2, 3]) {
    const expected = luminance(directions[k]!) / luminance(directions[0]!);
    expect(Math.abs(Math.log(expected)), 'the test must look where it matters').toBeGreaterThan(0.3);
    for (const c of [0, 1, 2]) expect(seen[k]![c]! / seen[0]![c]! / expected).toBeCloseTo(1, 1.3);
  }
  // As blue as in the file.
  expect(seen[0]![2]! / seen[0]![0]!).toBeCloseTo(46 / 26, 1);
});

test('the sky is dimmed with its lamp, is in no false colours, and below the horizon there is none', async ({ page }) => {
  await visit(page, overcast.address + settings(towards(50, 40)));
  await converged(page);
  const whole = await meanColour(page, MIDDLE);
  await slide(page, '#lamps input', 0.5);
  await expect(page.locator('#now')).toContainText('Relit: the solution');
  await expect(async () => expect((await meanColour(page, MIDDLE))[1]! / whole[1]!).toBeCloseTo(0.5, 1.7)).toPass();
  const nothing = await page.evaluate(() => {
    const [red] = getComputedStyle(document.getElementById('picture')!).backgroundColor.match(/\d+/)!;
    return ((Number(red) / 255 + 0.055) / 1.055) ** 2.4;
  });
  await page.getByLabel('quantity').selectOption('radiosity');
  await expect(async () => expect((await meanColour(page, MIDDLE))[0]! / nothing).toBeCloseTo(1, 1.7)).toPass();
  await visit(page, overcast.address + settings(towards(-1, 40)));
  await page.reload();
  await converged(page);
  await expect(async () => expect((await meanColour(page, MIDDLE))[0]! / nothing).toBeCloseTo(1, 1.7)).toPass();
});

test('a page of its own has the sky too', async ({ page }, info) => {
  const [scene, path] = [info.outputPath('sky.toml'), info.outputPath('sky.html')];
  writeFileSync(scene, `unit = "m"\nmeshes = ["${DAYLIGHT}/room.obj"]\n[sky]\nkind = "uniform"\nzenith_radiance = [1, 2, 3]\n`);
  run('radiosity', scene, '--patch-count', '150', '--html', path);
  await visit(page, `file://${path}${settings(towards(30, 0))}`);
  await converged(page);
  const exposure = await page.evaluate(
    () => (JSON.parse(document.getElementById('recording')!.textContent!) as { scene: { exposure: number } }).scene.exposure,
  );
  const colour = await meanColour(page, MIDDLE);
  [1, 2, 3].forEach((radiance, c) => expect(colour[c]! / ((1.7 * exposure * radiance) / 16)).toBeCloseTo(1, 1.7));
});
