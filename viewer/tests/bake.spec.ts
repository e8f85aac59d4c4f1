// What `fredholm bake` writes, opened and drawn by three.js.

import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { expect, test, type Page } from '@playwright/test';
import { build } from 'esbuild';
import { FURNACE, run, told } from './program';

type Loaders = {
  extrasOf(base64: string): Promise<Record<string, string>>;
  seen(base64: string, exposure: number): Promise<number[]>;
  facing(base64: string, name: string, exposure: number, exr?: string): Promise<{ mean: number[]; extras: Record<string, number> }>;
  lightmap(base64: string): { width: number; height: number; rgb: number[]; comments: string };
};

const base64 = (path: string): string => readFileSync(path).toString('base64');

/** A page with three.js' loaders in it. */
async function loaders(page: Page): Promise<void> {
  page.on('pageerror', (error) => expect(error.message, 'an error of the page').toBe(''));
  page.on('console', (message) => /error|warning/.test(message.type()) && !message.text().includes('GPU stall') && expect(message.text()).toBe(''));
  const made = await build({
    entryPoints: [fileURLToPath(new URL('loaders.ts', import.meta.url))], bundle: true, write: false, format: 'iife', target: 'es2022',
  });
  await page.setContent('<!doctype html><body></body>');
  await page.addScriptTag({ content: made.outputFiles[0]!.text });
}

/** Calls one of the loaders in the page. */
function call<K extends keyof Loaders>(page: Page, name: K, ...words: Parameters<Loaders[K]>): Promise<Awaited<ReturnType<Loaders[K]>>> {
  return page.evaluate(([name, words]) => (window as never as Record<string, (...all: unknown[]) => unknown>)[name as string]!(...(words as unknown[])), [name, words] as const) as never;
}

/** That each number is within so much of what is expected. */
function near(numbers: number[], expected: number[], relative: number): void {
  expected.forEach((e, c) => expect(Math.abs(numbers[c]! / e - 1), `${numbers} for ${expected}`).toBeLessThan(relative));
}

test('three.js shows the radiance of a furnace, as a texture and as colours of vertices', async ({ page }, info) => {
  // B = E/(1 − ρ) everywhere: 2, 4/3 and 4 W/m².
  const radiance = [2, 4 / 3, 4].map((b) => b / Math.PI);
  const [texture, colours] = [info.outputPath('texture.glb'), info.outputPath('colours.glb')];
  run('bake', FURNACE, '--size', '128', '-o', texture);
  run('bake', FURNACE, '--vertex-colours', '-o', colours);
  await loaders(page);
  near(await call(page, 'seen', base64(texture), 0.5), radiance, 0.02);
  expect((await call(page, 'extrasOf', base64(texture)))['quantity']).toContain('B/π: emissive texture × emissiveStrength');
  // A colour of 1 is the largest radiance, which only the material tells.
  near(await call(page, 'seen', base64(colours), 1), radiance.map((l) => (l * Math.PI) / 4), 0.02);
  expect((await call(page, 'extrasOf', base64(colours)))['quantity']).toContain('COLOR_0');
});

test('three.js shows each wall as bright as it was solved', async ({ page }, info) => {
  const [texture, colours, map] = ['texture.glb', 'colours.glb', 'map.exr'].map((name) => info.outputPath(name)) as [string, string, string];
  const { surfaces } = told('radiosity', '--accuracy', '1%', '--json', '-') as {
    surfaces: { name: string; mean_radiosity: number[]; mean_irradiance: number[] }[];
  };
  run('bake', '--size', '512', '-o', texture, '--irradiance', map);
  run('bake', '--vertex-colours', '-o', colours);
  await loaders(page);
  for (const name of ['back', 'left', 'right']) {
    const surface = surfaces.find((surface) => surface.name === name)!;
    const solved = surface.mean_radiosity.map((b) => b / Math.PI);
    const received = surface.mean_irradiance.map((h) => h / Math.PI);
    const exposure = 0.2 / Math.max(...solved);
    near((await call(page, 'facing', base64(texture), name, exposure)).mean, solved, 0.04);
    const { mean, extras } = await call(page, 'facing', base64(colours), name, 1);
    near(mean.map((c) => c * extras['radiance_of_1']!), solved, 0.04);
    const white = await call(page, 'facing', base64(texture), name, 0.2 / Math.max(...received), base64(map));
    near(white.mean, received, 0.04);
  }
});

test('three.js reads the lightmap, which is where the texture is', async ({ page }, info) => {
  const [glb, exr] = [info.outputPath('a.glb'), info.outputPath('a.exr')];
  run('bake', FURNACE, '--size', '64', '-o', glb, '--irradiance', exr);
  await loaders(page);
  const { width, height, rgb, comments } = await call(page, 'lightmap', base64(exr));
  expect([width, height]).toEqual([64, 64]);
  expect(comments).toContain('irradiance H in W/m^2');
  const lit = Array.from({ length: width * height }, (_, k) => rgb.slice(3 * k, 3 * k + 3)).filter(([red]) => red! > 0);
  expect(lit.length).toBeGreaterThan((64 * 64) / 2);
  // In a furnace H is B: 2, 4/3 and 4 W/m².
  for (const h of lit) near(h, [2, 4 / 3, 4], 0.02);
});
