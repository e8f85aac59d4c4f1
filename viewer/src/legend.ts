// Beside a picture in false colours: what it shows, in which unit, and which colour is which number.

import { colour, gradient } from './palette';
import { element } from './panel';
import type { Scene } from './protocol';
import { QUANTITIES, type Sight } from './quantities';
import { mark, position, type Scale } from './scale';
import type { Display } from './settings';

/** What a scale is of, and the scale. */
export interface Marked {
  caption: string;
  scale: Scale;
}

/** Of what is shown in false colours; none of light, nor where there is nothing to be seen yet. */
export function marked(scene: Scene, display: Display, scale: Scale | undefined, sight: Sight | undefined): Marked | undefined {
  if (display === 'light' || !scale || !sight) return undefined;
  const quantity = QUANTITIES[display];
  return { caption: quantity.lacks?.(sight) ?? `${quantity.title(scene, sight)}, ${quantity.unit(scene)}`, scale };
}

/** The marks of a scale: how far up each is, and what it says. */
function ticks(scale: Scale): { at: number; text: string }[] {
  const last = scale.ticks.length - 1;
  return scale.ticks.map((tick, k) => ({ at: position(scale, tick), text: `${scale.cut && k === last ? '≥ ' : ''}${mark(scale, tick)}` }));
}

export function showLegend(shown: Marked | undefined): void {
  const legend = element('legend');
  legend.hidden = !shown;
  if (!shown) return;
  legend.querySelector('figcaption')!.textContent = shown.caption;
  legend.querySelector<HTMLElement>('.bar')!.style.background = gradient(shown.scale.palette);
  legend.querySelector('.ticks')!.replaceChildren(
    ...ticks(shown.scale).map(({ at, text }) => {
      const label = document.createElement('span');
      label.style.bottom = `${100 * at}%`;
      label.textContent = text;
      return label;
    }),
  );
}

/** The width of a legend that is drawn, in pixels. */
export const LEGEND_WIDTH = 150;

/** Draws it on white, right of a picture of some height, in pixels. */
export function drawLegend(pen: CanvasRenderingContext2D, at: { left: number; height: number }, { caption, scale }: Marked): void {
  const { left, height } = at;
  pen.fillStyle = '#fff';
  pen.fillRect(left, 0, LEGEND_WIDTH, height);
  pen.fillStyle = '#1b1d20';
  pen.font = '13px system-ui, sans-serif';
  const lines = wrapped(pen, caption, LEGEND_WIDTH - 20);
  lines.forEach((line, k) => pen.fillText(line, left + 10, 24 + 17 * k));
  const top = 44 + 17 * lines.length;
  const tall = Math.max(40, Math.min(300, height - top - 20));
  for (let y = 0; y < tall; y++) {
    pen.fillStyle = `rgb(${colour(scale.palette, 1 - y / (tall - 1)).join(' ')})`;
    pen.fillRect(left + 10, top + y, 18, 1.5);
  }
  pen.fillStyle = '#1b1d20';
  for (const { at, text } of ticks(scale)) pen.fillText(text, left + 36, top + (1 - at) * tall + 4);
}

/** A text in lines that are no wider than so many pixels. */
function wrapped(pen: CanvasRenderingContext2D, text: string, width: number): string[] {
  const lines = [''];
  for (const word of text.split(' ')) {
    const longer = `${lines[lines.length - 1]} ${word}`.trim();
    if (pen.measureText(longer).width <= width) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines.filter((line) => line !== '');
}
