// What a user has chosen, kept in the address, so that a sight can be bookmarked and sent.

import type { Degree, Discretisation, Scene, Solver } from './protocol';
import type { Tone } from './view';

const DISPLAYS = ['light', 'radiosity', 'irradiance', 'unshot', 'error', 'difference', 'received', 'sent'] as const;
export type Display = (typeof DISPLAYS)[number];

/** What can be shown: form factors only where somebody can be asked for them. */
export const offered = (scene: Scene): Display[] =>
  DISPLAYS.filter((display) => scene.solvers.length > 0 || (display !== 'received' && display !== 'sent'));

export interface Settings {
  /** How the equation becomes numbers. */
  method: Discretisation;
  space: Degree;
  solver: Solver;
  rival: Solver | undefined;
  display: Display;
  smooth: boolean;
  mesh: boolean;
  contours: boolean;
  walk: boolean;
  /** Stops: powers of two of the automatic exposure. */
  exposure: number;
  tone: Tone;
  theme: 'auto' | 'light' | 'dark';
  /** Passes a second, or the method's own. */
  speed: number | undefined;
  paused: boolean;
  /** Whether lamps and materials are as they are by relighting, and no solver's course is shown. */
  relit: boolean;
  /** A factor for each lamp. */
  lamps: number[];
  /** The strongest channel of each material. */
  materials: number[];
  patch: number | undefined;
  /** Position and target, six numbers. */
  camera: number[] | undefined;
}

export function initial(scene: Scene, materials: number[]): Settings {
  return {
    method: scene.kind?.method ?? 'galerkin',
    space: scene.kind?.space ?? 'p0',
    solver: scene.solvers[0] ?? 'southwell',
    rival: undefined,
    display: 'light',
    smooth: true,
    mesh: false,
    contours: true,
    walk: false,
    exposure: 0,
    tone: 'neutral',
    theme: 'auto',
    speed: undefined,
    paused: false,
    relit: false,
    lamps: scene.lamps.map(() => 1),
    materials,
    patch: undefined,
    camera: undefined,
  };
}

/** Reads what an address says, as far as it makes sense here. */
export function read(hash: string, scene: Scene, settings: Settings): Settings {
  const said = new URLSearchParams(hash.replace(/^#/, ''));
  const one = <T extends string>(key: string, of: readonly T[], otherwise: T): T => {
    const value = said.get(key) as T | null;
    return value !== null && of.includes(value) ? value : otherwise;
  };
  const number = (key: string, low: number, high: number): number | undefined => {
    const value = Number(said.get(key) ?? NaN);
    return value >= low && value <= high ? value : undefined;
  };
  const numbers = (key: string, count: number, low: number, high: number): number[] | undefined => {
    const values = (said.get(key) ?? '').split(',').map(Number);
    const fine = said.has(key) && values.length === count && values.every((value) => value >= low && value <= high);
    return fine ? values : undefined;
  };
  const flag = (key: string, otherwise: boolean): boolean => (said.has(key) ? said.get(key) === '1' : otherwise);
  const patch = number('patch', 0, scene.patches - 1);
  const solver = one('solver', scene.solvers, settings.solver);
  return {
    method: one('method', ['galerkin', 'collocation', 'nystrom'], settings.method),
    space: one('space', ['p0', 'p1', 'p2'], settings.space),
    solver,
    rival: scene.solvers.find((rival) => rival === said.get('rival') && rival !== solver),
    display: one('show', offered(scene), settings.display),
    smooth: flag('smooth', settings.smooth),
    mesh: flag('mesh', settings.mesh),
    contours: flag('contours', settings.contours),
    walk: flag('walk', settings.walk),
    exposure: number('exposure', -6, 6) ?? settings.exposure,
    tone: one('tone', ['neutral', 'agx', 'linear'], settings.tone),
    theme: one('theme', ['auto', 'light', 'dark'], settings.theme),
    speed: number('speed', 1e-6, 1e3),
    paused: flag('paused', settings.paused),
    relit: flag('relit', settings.relit) && scene.stored,
    lamps: numbers('lamps', scene.lamps.length, 0, 10) ?? settings.lamps,
    materials: numbers('materials', settings.materials.length, 0, 0.99) ?? settings.materials,
    patch: patch !== undefined && Number.isInteger(patch) ? patch : undefined,
    camera: numbers('camera', 6, -1e9, 1e9),
  };
}

/** What differs from what a page begins with, for an address. */
export function write(settings: Settings, first: Settings): string {
  const said = new URLSearchParams();
  const short = (values: number[]): string => values.map((value) => Number(value.toPrecision(6))).join(',');
  const say = (key: string, value: string | number | boolean | undefined, usual: typeof value): void => {
    if (value === undefined || value === usual) return;
    said.set(key, typeof value === 'boolean' ? (value ? '1' : '0') : String(value));
  };
  say('method', settings.method, first.method);
  say('space', settings.space, first.space);
  say('solver', settings.solver, first.solver);
  say('rival', settings.rival, undefined);
  say('show', settings.display, first.display);
  for (const key of ['smooth', 'mesh', 'contours', 'walk', 'exposure', 'tone', 'theme', 'paused', 'relit'] as const) {
    say(key, settings[key], first[key]);
  }
  say('speed', settings.speed && Number(settings.speed.toPrecision(4)), undefined);
  say('lamps', short(settings.lamps), short(first.lamps));
  say('materials', short(settings.materials), short(first.materials));
  say('patch', settings.patch, undefined);
  say('camera', settings.camera && short(settings.camera), undefined);
  return said.toString().replaceAll('%2C', ',');
}
