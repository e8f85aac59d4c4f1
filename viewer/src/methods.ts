// The solvers as the paper has them: their names, their formulas, and what a step of each does.

import type { Degree, Discretisation, Frame, Solver } from './protocol';
import { NONE } from './protocol';
import { text } from './scale';

/** What F_ij is: the paper's three ways to make numbers of the equation. */
export const DISCRETISATIONS: Record<Discretisation, { name: string; tip: string }> = {
  galerkin: {
    name: 'Galerkin: patch to patch',
    tip: 'The equation holds in the mean over each patch. F_ij is the share of the view of patch i that patch j fills, on average over patch i.',
  },
  collocation: {
    name: 'collocation: point to patch',
    tip: 'The equation holds at chosen points of each patch. F_ij is the share of the view of such a point that patch j fills.',
  },
  nystrom: {
    name: 'Nyström: point to point',
    tip: 'The integral becomes a sum over points. Fast, but wrong where patches touch: dark or bright seams in corners are its error.',
  },
};

export const DEGREES: Record<Degree, { name: string; tip: string }> = {
  p0: { name: 'constant on each patch (P0)', tip: 'One number for each patch' },
  p1: { name: 'linear (P1, Q1)', tip: 'Three numbers for a triangle, four for a quadrilateral; the mean is shown' },
  p2: { name: 'quadratic (P2, Q2)', tip: 'Six numbers for a triangle, nine for a quadrilateral; the mean is shown' },
};

export interface Method {
  name: string;
  /** What one iteration is called. */
  step: string;
  tip: string;
  /** Shots are a column each; all others use all of F in one iteration. */
  shoots: boolean;
  /** Of the equation, which terms an iteration computes. */
  lit: string[];
  formula(frame: Frame): string;
  now(frame: Frame, patch: (i: number) => string): string;
}

const term = (letter: string, lit: boolean, tip: string): string =>
  `<span class="term${lit ? ' lit' : ''}" title="${tip}">${letter}</span>`;

const gathered = (frame: Frame): string =>
  `u<sub>i</sub> ← ( ${term('f<sub>i</sub>', false, 'what patch i sends out by itself')} + ${term(
    'ρ<sub>i</sub> Σ<sub>j≠i</sub> F<sub>ij</sub> u<sub>j</sub>',
    frame.iteration > 0,
    'what patch i receives from all others along row i of F, and sends back',
  )} ) / (1 − ρ<sub>i</sub> F<sub>ii</sub>)`;

export const METHODS: Record<Solver, Method> = {
  southwell: {
    name: 'Southwell: shooting',
    step: 'shot',
    tip: 'Progressive radiosity: the patch with the most unshot light sends it to all others, along a column of F. What is shown is u + r.',
    shoots: true,
    lit: ['F'],
    formula: (frame) =>
      `u<sub>j</sub> ← u<sub>j</sub> + ${term('r<sub>j</sub>', frame.iteration > 0, 'the unshot light of patch j')} / (1 − ρ<sub>j</sub> F<sub>jj</sub>), &nbsp; j : largest A<sub>j</sub>|r<sub>j</sub>|`,
    now: (frame, patch) => {
      if (frame.iteration === 0) return 'Before the first shot only the lamps shine: r = f.';
      const of = frame.shot === NONE ? '' : `: ${patch(frame.shot)} has sent its unshot light to all others`;
      return `Shot ${text(frame.iteration, 9)}${of}.`;
    },
  },
  'gauss-seidel': {
    name: 'Gauss–Seidel: gathering',
    step: 'sweep',
    tip: 'Classical radiosity: one patch after the other gathers what all others send it, along its row of F, and is used at once.',
    shoots: false,
    lit: ['rho', 'F', 'u'],
    formula: (frame) => `${gathered(frame)}, &nbsp; i after i`,
    now: (frame) =>
      frame.iteration === 0
        ? 'Before the first sweep u is f: only the lamps shine.'
        : `Sweep ${frame.iteration}: each patch in turn has gathered from all others.`,
  },
  jacobi: {
    name: 'Jacobi: all at once',
    step: 'sweep',
    tip: 'All patches gather at the same time, from what the others were one sweep before.',
    shoots: false,
    lit: ['rho', 'F', 'u'],
    formula: (frame) => `${gathered(frame)}, &nbsp; all i at once`,
    now: (frame) =>
      frame.iteration === 0 ? 'Before the first sweep u is 0.' : `Sweep ${frame.iteration}: all patches have gathered at once.`,
  },
  successive: {
    name: 'Successive approximations: bounces',
    step: 'bounce',
    tip: 'The Neumann series: each term is the light that has bounced once more.',
    shoots: false,
    lit: ['rho', 'F', 'u'],
    formula: series,
    now: (frame) => {
      if (frame.iteration === 0) return 'Before the first term u is 0.';
      if (frame.iteration === 1) return 'Term 0 of the Neumann series: what the lamps send out.';
      return `Term ${frame.iteration - 1} of the Neumann series: light that has bounced ${times(frame.iteration - 1)}.`;
    },
  },
  gmres: {
    name: 'GMRES: Krylov',
    step: 'iteration',
    tip: 'The combination of all bounces so far that leaves the smallest residual.',
    shoots: false,
    lit: ['rho', 'F', 'u'],
    formula: (frame) =>
      `u = f + ${term(`Σ<sub>k≤${frame.iteration}</sub> c<sub>k</sub> (I − ρF)<sup>k</sup> r<sub>0</sub>`, frame.iteration > 0, 'a sum of bounces, weighed')}, &nbsp; c : smallest ‖r‖`,
    now: (frame) =>
      frame.iteration === 0 ? 'At first u is f.' : `Iteration ${frame.iteration}: the bounces so far, weighed to leave the smallest residual.`,
  },
};

const times = (k: number): string => (k === 1 ? 'once' : k === 2 ? 'twice' : `${k} times`);

/** u = f + ρF f + … with the term lit that was added last. */
function series(frame: Frame): string {
  const last = frame.iteration - 1;
  const power = (k: number): string =>
    k === 0 ? 'f' : k === 1 ? '(ρF) f' : `(ρF)<sup>${k}</sup> f`;
  const first = Math.max(0, Math.min(last - 1, 2));
  const shown = last <= 3 ? [0, 1, 2, 3] : [0, 1, last - 1, last];
  const terms = shown.map((k) => term(power(k), k === last, k === 0 ? 'emitted' : `bounced ${times(k)}`));
  if (last > 3 && last - 1 > first) terms.splice(2, 0, '…');
  return `u = ${terms.join(' + ')} + …`;
}

/** The equation with the terms lit that are being computed. */
export function equation(method: Method, frame: Frame | undefined): string {
  const lit = frame && frame.iteration > 0 ? method.lit : ['f'];
  const letter = (text: string, name: string, tip: string): string => term(text, lit.includes(name), tip);
  return `${letter('u', 'left', 'radiosity: what leaves a patch')} = ${letter('f', 'f', 'what lamps send out by themselves')} + ${letter(
    'ρ',
    'rho',
    'reflectance',
  )} <i>⊙</i> ${letter('F', 'F', 'form factors: who sees how much of whom')} ${letter('u', 'u', 'radiosity of all other patches')}`;
}
