// u = Σ g_k u_k: the light of each lamp alone, added up for any factors at once.

import type { Message } from './protocol';

type Lamp = Extract<Message, { type: 'lamp' }>;

export class Relit {
  /** Whether this is wanted in place of a solver's course. */
  active = false;
  private version = 0;
  private asked = false;
  private parts: (Float32Array | undefined)[];
  private sum: Float32Array;

  constructor(
    private readonly lamps: number,
    private readonly patches: number,
  ) {
    this.parts = new Array<undefined>(lamps).fill(undefined);
    this.sum = new Float32Array(3 * patches);
  }

  /** The number of a new request; what answers older ones is no longer wanted. */
  ask(): number {
    this.asked = true;
    return ++this.version;
  }

  get isAsked(): boolean {
    return this.asked;
  }

  /** Forgets all, and wants none of what was asked for: the method is another. */
  forget(): void {
    this.asked = false;
    this.version++;
    this.parts.fill(undefined);
  }

  /** Takes the light of a lamp; says whether it was wanted. */
  take(lamp: Lamp): boolean {
    if (lamp.version !== this.version || lamp.lamp >= this.lamps) return false;
    this.parts[lamp.lamp] = lamp.radiosity;
    return true;
  }

  /** Whether the light of every lamp is there. */
  get isWhole(): boolean {
    return this.lamps > 0 && this.parts.every((part) => part !== undefined);
  }

  /** Whether it is wanted and there. */
  get isShown(): boolean {
    return this.active && this.isWhole;
  }

  /** The light of all lamps with these factors. */
  combine(factors: number[]): Float32Array {
    this.sum = new Float32Array(3 * this.patches);
    this.parts.forEach((part, k) => {
      const factor = factors[k]!;
      if (part && factor !== 0) for (let i = 0; i < part.length; i++) this.sum[i]! += factor * part[i]!;
    });
    return this.sum;
  }
}
