// Surfaces that reflect alike are one material, with one slider for its strongest colour.

import type { Scene } from './protocol';

export interface Material {
  name: string;
  colour: number[];
  /** Its surfaces, by number. */
  surfaces: number[];
  strongest: number;
}

export function materials(scene: Scene): Material[] {
  const found = new Map<string, Material>();
  scene.surfaces.forEach((surface, s) => {
    const key = surface.reflectance.map((rho) => rho.toFixed(6)).join(' ');
    const known = found.get(key);
    if (known) known.surfaces.push(s);
    else found.set(key, { name: '', colour: surface.reflectance, surfaces: [s], strongest: Math.max(...surface.reflectance) });
  });
  const all = [...found.values()];
  for (const material of all) {
    const names = material.surfaces.map((s) => scene.surfaces[s]!.name);
    material.name = names.length > 3 ? `${names.slice(0, 2).join(', ')} and ${names.length - 2} more` : names.join(', ');
  }
  return all;
}

/** The reflectance of each surface when the strongest channels of materials are these; black ones become grey. */
export function reflectances(scene: Scene, all: Material[], strongest: number[]): number[][] {
  const result = scene.surfaces.map((surface) => surface.reflectance);
  all.forEach((material, k) => {
    const value = strongest[k]!;
    if (value === material.strongest) return;
    const changed = material.strongest > 0
      ? material.colour.map((rho) => (rho * value) / material.strongest)
      : [value, value, value];
    for (const s of material.surfaces) result[s] = changed;
  });
  return result;
}

/** A colour for a style sheet, of a linear one. */
export function swatch(colour: number[]): string {
  const screen = colour.map((c) => Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055)));
  return `rgb(${screen.join(' ')})`;
}
