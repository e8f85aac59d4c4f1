// The numbers of the patch under the pointer, each with its unit.

import { element } from './panel';
import type { Patches } from './patches';
import type { Scene } from './protocol';
import { QUANTITIES, UNKNOWN, type Sight } from './quantities';
import { text } from './scale';
import type { Display } from './settings';

export function patchName(scene: Scene, patches: Patches, i: number): string {
  return `patch ${text(i, 9)} (${scene.surfaces[patches.surface[i]!]?.name ?? ''})`;
}

/** One number where all colours are the same. */
function list(values: number[]): string {
  return values.every((value) => value === values[0]) ? text(values[0]!) : values.map((value) => text(value)).join(' · ');
}

export function describe(i: number, sight: Sight, scene: Scene, patches: Patches, display: Display): string {
  const { exitance, radiance, length, power } = scene.units;
  const colour = [0, 1, 2].map((c) => sight.radiosity[3 * i + c]!);
  const lines = [patchName(scene, patches, i), `u ${list(colour)} ${exitance}`];
  if (power === 'lm') lines.push(`luminance ${text(colour[0]! / Math.PI)} ${radiance}`);
  if (display !== 'light' && display !== 'radiosity') {
    const quantity = QUANTITIES[display];
    const value = quantity.values(sight, patches, scene)[i]!;
    const said = value < UNKNOWN / 2 ? 'not known' : `${text(value)} ${quantity.unit(scene)}`;
    if (!quantity.lacks?.(sight)) lines.push(`${quantity.title(scene, sight)} ${said}`);
  }
  if (sight.rest && display !== 'unshot') lines.push(`|r| ${text(sight.rest[i]!)} ${exitance}`);
  lines.push(`ρ ${list(sight.reflectance[patches.surface[i]!]!)}, ${text(patches.areas[i]!)} ${length}²`);
  return lines.join('\n');
}

/** Puts the numbers beside the pointer, within the picture; or takes them away. */
export function showReadout(said: string | undefined, pointer: { clientX: number; clientY: number } | undefined, canvas: HTMLElement): void {
  const readout = element('readout');
  readout.hidden = said === undefined || !pointer;
  if (said === undefined || !pointer) return;
  readout.textContent = said;
  const box = canvas.getBoundingClientRect();
  const [x, y] = [pointer.clientX - box.left, pointer.clientY - box.top];
  readout.style.left = `${Math.max(4, Math.min(x + 14, box.width - readout.offsetWidth - 4))}px`;
  readout.style.top = `${y + readout.offsetHeight + 24 > box.height ? Math.max(4, y - readout.offsetHeight - 10) : y + 16}px`;
}
