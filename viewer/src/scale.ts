// Scales with round numbers, and numbers as people read them.

import type { Palette } from './palette';

export interface Scale {
  low: number;
  high: number;
  logarithmic: boolean;
  palette: Palette;
  /** Marks, and contour lines. */
  ticks: number[];
  /** What is above the scale is shown as its end. */
  cut: boolean;
}

/** 1, 2 or 5 times a power of ten, at least this. */
function round(step: number): number {
  const power = 10 ** Math.floor(Math.log10(step));
  return [1, 2, 5, 10].map((k) => k * power).find((k) => k >= step * (1 - 1e-9)) ?? 10 * power;
}

/** From a round number to a round number, over these. */
export function linear(low: number, high: number, cut = false): Scale {
  const span = high - low > 1e-9 * Math.abs(high) ? high - low : Math.abs(high) || 1;
  const step = round(span / 8);
  const from = Math.floor(low / step + 1e-9) * step;
  const count = Math.max(1, Math.ceil((Math.max(high, low + span) - from) / step - 1e-9));
  const ticks = Array.from({ length: count + 1 }, (_, k) => from + k * step);
  return { low: from, high: ticks[count]!, logarithmic: false, palette: 'viridis', ticks, cut };
}

/** Powers of ten, from at most `decades` below the top. */
export function logarithmic(high: number, decades: number): Scale {
  const top = Math.ceil(Math.log10(high > 0 ? high : 1) - 1e-9);
  const ticks = Array.from({ length: decades + 1 }, (_, k) => 10 ** (top - decades + k));
  return { low: ticks[0]!, high: ticks[decades]!, logarithmic: true, palette: 'viridis', ticks, cut: false };
}

/** The same both ways from 0, for differences. */
export function symmetric(size: number): Scale {
  const step = round((size || 1) / 3);
  const count = Math.max(1, Math.ceil(size / step - 1e-9));
  const ticks = Array.from({ length: 2 * count + 1 }, (_, k) => (k - count) * step);
  return { low: -count * step, high: count * step, logarithmic: false, palette: 'diverging', ticks, cut: false };
}

/** Where a number is on a scale, from 0 to 1. */
export function position(scale: Scale, value: number): number {
  const of = scale.logarithmic ? (x: number) => Math.log10(Math.max(x, 1e-300)) : (x: number) => x;
  return (of(value) - of(scale.low)) / (of(scale.high) - of(scale.low));
}

/** Three or so digits. */
export function text(value: number, digits = 3): string {
  if (value < 0) return `−${text(-value, digits)}`;
  if (!Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  if (value >= 1e5 && digits < 6 || value < 1e-3) {
    const [mantissa, exponent] = value.toExponential(Math.max(0, digits - 1)).split('e');
    return `${trim(mantissa!)}·10${[...exponent!.replace('+', '')].map((c) => SUPERSCRIPT[c]).join('')}`;
  }
  return grouped(trim(Number(value.toPrecision(digits)).toFixed(Math.max(0, digits - 1 - Math.floor(Math.log10(value))))));
}

/** A mark of a scale. */
export function mark(scale: Scale, value: number): string {
  if (!scale.logarithmic) return text(Math.abs(value) < 1e-9 * scale.high ? 0 : value);
  return `10${[...String(Math.round(Math.log10(value)))].map((c) => SUPERSCRIPT[c]).join('')}`;
}

const trim = (number: string): string => (number.includes('.') ? number.replace(/\.?0+$/, '') : number);
const grouped = (number: string): string => {
  const [whole, part] = number.split('.');
  const groups = whole!.length > 4 ? whole!.replace(/\B(?=(\d{3})+$)/g, ' ') : whole!;
  return part ? `${groups}.${part}` : groups;
};

/** A power of ten, as short as it is read. */
export const power = (exponent: number): string =>
  Math.abs(exponent) <= 3 ? text(10 ** exponent, 1) : `10${[...String(exponent)].map((c) => SUPERSCRIPT[c]).join('')}`;

const SUPERSCRIPT: Record<string, string> = {
  '-': '⁻', '0': '⁰', '1': '¹', '2': '²', '3': '³', '4': '⁴', '5': '⁵', '6': '⁶', '7': '⁷', '8': '⁸', '9': '⁹',
};

/** The smallest number that at least a share of them, by weight, do not exceed. */
export function percentile(values: Float32Array, weights: Float32Array, share: number): number {
  const order = Array.from(values.keys()).sort((a, b) => values[a]! - values[b]!);
  const total = weights.reduce((sum, weight) => sum + weight, 0);
  let sum = 0;
  for (const i of order) {
    sum += weights[i]!;
    if (sum >= share * total) return values[i]!;
  }
  return 0;
}

/** How bright a colour is: Y of linear Rec. 709. */
export const luminance = (red: number, green: number, blue: number): number =>
  0.2126 * red + 0.7152 * green + 0.0722 * blue;
