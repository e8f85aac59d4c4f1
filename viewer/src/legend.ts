// Beside a picture in false colours: what it shows, in which unit, and which colour is which number.

import { gradient } from './palette';
import { element } from './panel';
import type { Scene } from './protocol';
import { QUANTITIES, type Sight } from './quantities';
import { mark, position, type Scale } from './scale';
import type { Display } from './settings';

export function showLegend(scene: Scene, display: Display, scale: Scale | undefined, sight: Sight | undefined): void {
  const legend = element('legend');
  legend.hidden = display === 'light' || !scale || !sight;
  if (display === 'light' || !scale || !sight) return;
  const quantity = QUANTITIES[display];
  legend.querySelector('figcaption')!.textContent =
    quantity.lacks?.(sight) ?? `${quantity.title(scene, sight)}, ${quantity.unit(scene)}`;
  legend.querySelector<HTMLElement>('.bar')!.style.background = gradient(scale.palette);
  legend.querySelector('.ticks')!.replaceChildren(
    ...scale.ticks.map((tick, k) => {
      const label = document.createElement('span');
      label.style.bottom = `${100 * position(scale, tick)}%`;
      label.textContent = `${scale.cut && k === scale.ticks.length - 1 ? '≥ ' : ''}${mark(scale, tick)}`;
      return label;
    }),
  );
}
