// The command under test, and what a page shows of it.

import { execFileSync, spawn } from 'node:child_process';
import { once } from 'node:events';
import { fileURLToPath } from 'node:url';
import { expect, type Page } from '@playwright/test';

const here = (path: string): string => fileURLToPath(new URL(path, import.meta.url));
const PROGRAM = process.env['FREDHOLM'] ?? here('../../target/debug/fredholm');
export const FURNACE = here('../../scenes/furnace/furnace.toml');
export const DAYLIGHT = here('../../scenes/daylight');

/** Runs the command to its end. */
export const run = (...words: string[]): void => void execFileSync(PROGRAM, words);

/** Runs the command to its end and reads what it tells, as JSON. */
export const told = (...words: string[]): unknown => JSON.parse(execFileSync(PROGRAM, words, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] }));

export interface Server {
  address: string;
  stop(): void;
}

/** Starts `fredholm view`. */
export async function serve(...words: string[]): Promise<Server> {
  const child = spawn(PROGRAM, ['view', '--no-open', '--port', '0', ...words], { stdio: ['ignore', 'pipe', 'inherit'] });
  let said = '';
  while (!said.includes('\n')) said += String((await once(child.stdout, 'data'))[0]);
  const address = /http:\/\/127\.0\.0\.1:\d+\//.exec(said)?.[0];
  if (!address) throw new Error(`no address in ${said}`);
  return { address, stop: () => child.kill() };
}

/** Opens a page that may complain of nothing and ask nobody but its own server. */
export async function visit(page: Page, address: string): Promise<void> {
  page.on('pageerror', (error) => expect(error.message, 'an error of the page').toBe(''));
  page.on('console', (message) => message.type() === 'error' && expect(message.text(), 'a complaint').toBe(''));
  page.on('request', (request) => expect(request.url()).toMatch(/^(http:\/\/127\.0\.0\.1:|file:|data:|blob:)/));
  await page.goto(address);
  await expect(page.locator('body')).toHaveAttribute('data-iteration', /\d/);
}

export const residual = async (page: Page): Promise<number> => Number(await page.locator('body').getAttribute('data-residual'));

export async function converged(page: Page): Promise<void> {
  await expect(page.locator('body')).toHaveAttribute('data-state', 'Converged', { timeout: 30_000 });
}

/** The mean of red, green and blue over a part of the picture, on the linear scale on which white is 1. */
export async function meanColour(page: Page, part = { x: 0.25, y: 0.25, width: 0.5, height: 0.5 }): Promise<number[]> {
  const box = (await page.locator('#picture').boundingBox())!;
  const clip = {
    x: box.x + part.x * box.width,
    y: box.y + part.y * box.height,
    width: part.width * box.width,
    height: part.height * box.height,
  };
  // Two frames, so that what was asked for last is drawn.
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  const picture = (await page.screenshot({ clip })).toString('base64');
  return page.evaluate(async (data) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    const canvas = Object.assign(document.createElement('canvas'), { width: image.width, height: image.height });
    const pen = canvas.getContext('2d')!;
    pen.drawImage(image, 0, 0);
    const { data: bytes } = pen.getImageData(0, 0, image.width, image.height);
    const linear = (byte: number): number => {
      const c = byte / 255;
      return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
    };
    const sums = [0, 0, 0];
    for (let at = 0; at < bytes.length; at += 4) for (let c = 0; c < 3; c++) sums[c]! += linear(bytes[at + c]!);
    return sums.map((sum) => (4 * sum) / bytes.length);
  }, picture);
}

/** Moves a slider as a user does. */
export async function slide(page: Page, selector: string, value: number): Promise<void> {
  await page.locator(selector).evaluate((input: HTMLInputElement, to) => {
    input.value = String(to);
    input.dispatchEvent(new Event('input', { bubbles: true }));
    input.dispatchEvent(new Event('change', { bubbles: true }));
  }, value);
}
