// What can be shown of a patch: its light, or a number of it with a unit and a scale.

import type { Patches } from './patches';
import type { Scene } from './protocol';
import { linear, logarithmic, luminance, percentile, symmetric, type Scale } from './scale';
import type { Display } from './settings';

/** What is not known of a patch is drawn grey. */
export const UNKNOWN = -1e30;

/** All that a quantity may depend on, of one picture. */
export interface Sight {
  radiosity: Float32Array;
  rest: Float32Array | undefined;
  bound: number;
  /** Of the other solver, or of the solution. */
  other: Float32Array | undefined;
  otherName: string;
  factors: { row: Float32Array; column: Float32Array } | undefined;
  /** ρ of each surface. */
  reflectance: number[][];
  /** Factors of the lamps that are surfaces, by surface. */
  emission: number[][];
  /** The largest |r| of the run's first frame. */
  first: number;
}

export interface Quantity {
  name: string;
  hint: string;
  title(scene: Scene, sight: Sight): string;
  unit(scene: Scene): string;
  values(sight: Sight, patches: Patches, scene: Scene): Float32Array;
  scale(values: Float32Array, patches: Patches, sight: Sight): Scale;
  /** Why there is nothing to be seen yet. */
  lacks?(sight: Sight): string | undefined;
  contours: boolean;
}

const brightness = (radiosity: Float32Array): Float32Array =>
  Float32Array.from({ length: radiosity.length / 3 }, (_, i) =>
    luminance(radiosity[3 * i]!, radiosity[3 * i + 1]!, radiosity[3 * i + 2]!),
  );

/** Around what is lit; lamps are above the scale. */
function around(values: Float32Array, patches: Patches, sight: Sight): Scale {
  const isLamp = (i: number): boolean => sight.emission[patches.surface[i]!]!.some((e) => e > 0);
  const all = Array.from(values.keys()).filter((i) => values[i]! > UNKNOWN / 2);
  const reflecting = all.filter((i) => !isLamp(i));
  const known = reflecting.length > 0 ? reflecting : all;
  const own = Float32Array.from(known, (i) => values[i]!);
  const areas = Float32Array.from(known, (i) => patches.areas[i]!);
  const high = percentile(own, areas, 0.98);
  const most = all.reduce((largest, i) => Math.max(largest, values[i]!), 0);
  return most <= 1.3 * high ? linear(0, most) : linear(0, high, true);
}

const isPhotometric = (scene: Scene): boolean => scene.units.power === 'lm';
const factorLack = (sight: Sight): string | undefined => (sight.factors ? undefined : 'Click a patch to see its form factors.');

function irradiance(sight: Sight, patches: Patches): Float32Array {
  return Float32Array.from({ length: patches.count }, (_, i) => {
    const s = patches.surface[i]!;
    const [rho, emitted] = [sight.reflectance[s]!, sight.emission[s]!];
    if (rho.some((r) => r <= 0)) return UNKNOWN;
    const [r, g, b] = [0, 1, 2].map((c) => (sight.radiosity[3 * i + c]! - emitted[c]!) / rho[c]!) as [number, number, number];
    return luminance(r, g, b);
  });
}

/** The share of a patch's error bound: |r| of its own, and what the error of all others does to it. */
function errors(sight: Sight, patches: Patches, rowSum: number): Float32Array {
  return Float32Array.from({ length: patches.count }, (_, i) => {
    const rho = Math.max(...sight.reflectance[patches.surface[i]!]!);
    return (sight.rest?.[i] ?? 0) + rho * rowSum * sight.bound;
  });
}

const ofLargest = (decades: number) => (values: Float32Array, _: Patches, sight: Sight): Scale =>
  logarithmic(Math.max(sight.first, 0) || values.reduce((a, b) => Math.max(a, b), 0), decades);

export const QUANTITIES: Record<Exclude<Display, 'light'>, Quantity> = {
  radiosity: {
    name: 'radiosity u, in false colours',
    hint: 'What leaves each patch, emitted and reflected; of a colour its luminance, 0.21 R + 0.72 G + 0.07 B.',
    title: (scene) => (isPhotometric(scene) ? 'luminance u/π' : 'radiosity u'),
    unit: (scene) => (isPhotometric(scene) ? scene.units.radiance : scene.units.exitance),
    values: (sight, _, scene) => {
      const values = brightness(sight.radiosity);
      return isPhotometric(scene) ? values.map((b) => b / Math.PI) : values;
    },
    scale: around,
    contours: true,
  },
  irradiance: {
    name: 'light received, Fu',
    hint: 'What reaches each patch, from lamps and all others; of a colour its luminance. Not known where nothing is reflected: grey.',
    title: (scene) => (isPhotometric(scene) ? 'illuminance' : 'irradiance'),
    unit: (scene) => scene.units.irradiance,
    values: irradiance,
    scale: around,
    contours: true,
  },
  unshot: {
    name: 'residual |r|: still to come',
    hint: 'r = f + ρ ⊙ Fu − u: the light that the method has not passed on yet. Where it is zero everywhere, u solves the equation.',
    title: () => 'residual |r|',
    unit: (scene) => scene.units.exitance,
    values: (sight, patches) => sight.rest ?? new Float32Array(patches.count),
    scale: ofLargest(6),
    lacks: (sight) => (sight.rest ? undefined : 'Restart to see the residual of a solver.'),
    contours: false,
  },
  error: {
    name: 'error bound, patch by patch',
    hint: 'No patch is further from the solution of this mesh than this: |r| + ρ ‖r‖ / (1 − ‖ρF‖).',
    title: () => 'error at most',
    unit: (scene) => scene.units.exitance,
    values: (sight, patches, scene) => errors(sight, patches, scene.row_sum),
    scale: ofLargest(6),
    lacks: (sight) =>
      !sight.rest ? 'Restart to see the error bound of a solver.'
        : Number.isFinite(sight.bound) ? undefined : 'There is no bound: ‖ρF‖ is 1 or more.',
    contours: false,
  },
  difference: {
    name: 'difference',
    hint: 'Between the two solvers of a race; without a race, what the solver lacks to the solution.',
    title: (_, sight) => sight.otherName,
    unit: (scene) => scene.units.exitance,
    values: (sight, patches) => {
      const [own, other] = [brightness(sight.radiosity), brightness(sight.other ?? sight.radiosity)];
      return Float32Array.from({ length: patches.count }, (_, i) => own[i]! - other[i]!);
    },
    scale: (values, patches) => symmetric(percentile(values.map(Math.abs), patches.areas, 0.98)),
    lacks: (sight) => (sight.other ? undefined : 'Start a race, or wait until the solution is known.'),
    contours: false,
  },
  received: {
    name: 'form factors, received: row of F',
    hint: 'Click a patch i. F_ij is the share of its view that patch j fills: what it gathers from there.',
    title: () => 'F_ij: received by the patch',
    unit: () => '%',
    values: (sight, patches) => sight.factors?.row.map((factor) => 100 * factor) ?? new Float32Array(patches.count),
    scale: around,
    lacks: factorLack,
    contours: false,
  },
  sent: {
    name: 'form factors, sent: column of F',
    hint: 'Click a patch j. F_ij is the share of the view of patch i that it fills: where its light goes when it is shot.',
    title: () => 'F_ij: sent by the patch',
    unit: () => '%',
    values: (sight, patches) => sight.factors?.column.map((factor) => 100 * factor) ?? new Float32Array(patches.count),
    scale: around,
    lacks: factorLack,
    contours: false,
  },
};
