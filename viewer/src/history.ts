// Frames that were shown, so that one can scrub back: all of them, or ever fewer old ones when they grow too many.

import type { Frame } from './protocol';

/** Bytes of frames that a page keeps. A phone's browser ends a page at about three times this. */
const BUDGET = 192e6;

export type Point = Pick<Frame, 'work' | 'iteration' | 'residual' | 'bound' | 'unshot'>;

/** The frames of one solver. */
export class History {
  frames: Frame[] = [];
  /** What the curves are drawn from: of every frame, also of those that are gone. */
  points: Point[] = [];

  constructor(private readonly lanes: number) {}

  add(frame: Frame): void {
    this.frames.push(frame);
    this.points.push({
      work: frame.work,
      iteration: frame.iteration,
      residual: frame.residual,
      bound: frame.bound,
      unshot: frame.unshot,
    });
    const size = 4 * (frame.radiosity.length + frame.rest.length);
    if (this.frames.length > 8 && size * this.frames.length * this.lanes > BUDGET) {
      this.frames = this.frames.filter((_, k) => k % 2 === 0 || k === this.frames.length - 1);
    }
    // As many points as a screen is wide, twice over, are a curve.
    if (this.points.length > 4000) this.points = this.points.filter((_, k) => k % 2 === 0);
  }

  get last(): Frame | undefined {
    return this.frames[this.frames.length - 1];
  }

  /** The frame shown at a moment: number `k`, or the last if it has fewer. */
  at(k: number): Frame | undefined {
    return this.frames[Math.min(k, this.frames.length - 1)];
  }
}
