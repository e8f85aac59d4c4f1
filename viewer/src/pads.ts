// Walking by touch: a pad under one thumb to go, the picture under the other to look around.

import { element } from './panel';
import type { Walk } from './walk';

/** How far the knob goes, in pixels, and what of it is no push yet: a thumb is never still. */
const REACH = 40;
const STILL = 0.15;

/** `toggle` turns walking on or off; `changed` asks for a picture, `rest` is told when the eye stands still again. */
export function offerPads(walk: Walk, act: { toggle(): void; changed(): void; rest(): void }): void {
  const touches = (): void => document.body.classList.add('touch');
  if (matchMedia('(any-pointer: coarse)').matches) touches();
  addEventListener('pointerdown', (event) => event.pointerType === 'touch' && touches());
  element('walk-here').addEventListener('click', act.toggle);
  const pad = element('pad');
  const knob = element('knob');
  const push = (x: number, forward: number): void => {
    [walk.push[0], walk.push[2]] = [x, forward];
    knob.style.transform = `translate(${REACH * x}px, ${-REACH * forward}px)`;
    act.changed();
  };
  const drag = (event: PointerEvent): void => {
    if (!pad.hasPointerCapture(event.pointerId)) return;
    const box = pad.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left - box.width / 2, event.clientY - box.top - box.height / 2];
    const length = Math.hypot(x, y) / REACH;
    if (length < STILL) return push(0, 0);
    const share = Math.min(1, length) / (length * REACH);
    push(x * share, -y * share);
  };
  pad.addEventListener('pointerdown', (event) => {
    pad.setPointerCapture(event.pointerId);
    drag(event);
  });
  pad.addEventListener('pointermove', drag);
  pad.addEventListener('lostpointercapture', () => {
    push(0, 0);
    act.rest();
  });
  for (const [id, up] of [['rise', 1], ['sink', -1]] as const) {
    const button = element(id);
    const lift = (by: number): void => {
      walk.push[1] = by;
      act.changed();
    };
    button.addEventListener('pointerdown', (event) => {
      button.setPointerCapture(event.pointerId);
      lift(up);
    });
    button.addEventListener('lostpointercapture', () => {
      lift(0);
      act.rest();
    });
  }
}
