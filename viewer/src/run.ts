// The solvers of now: their frames, and which moment of them is shown.

import { History } from './history';
import { State, type Frame, type Kind, type Solver } from './protocol';

export class Run {
  readonly histories: History[];
  /** The moment shown; the newest if there is none. */
  private moment: number | undefined;

  constructor(
    readonly number: number,
    readonly kind: Kind,
    readonly solvers: Solver[],
    /** How many; a shot is that of one of them. */
    readonly unknowns: number,
    /** What it is the light of. */
    readonly lamps: number[],
    readonly reflectance: number[][],
  ) {
    this.histories = solvers.map(() => new History(solvers.length));
  }

  add(frame: Frame): void {
    if (frame.run === this.number) this.histories[frame.lane]?.add(frame);
  }

  /** How many moments there are. */
  get length(): number {
    return Math.max(...this.histories.map((history) => history.frames.length));
  }

  /** The number of the moment shown. */
  get shown(): number {
    return Math.min(this.moment ?? Infinity, this.length - 1);
  }

  get isNewest(): boolean {
    return this.shown >= this.length - 1;
  }

  /** Shows a moment, and the newest again when it is the last. */
  show(moment: number): void {
    this.moment = moment >= this.length - 1 ? undefined : Math.max(0, moment);
  }

  /** Shows the moment at which the first solver had done so much work. */
  showWork(work: number): void {
    const later = this.histories[0]!.frames.findIndex((frame) => frame.work >= work);
    this.show(later < 0 ? Infinity : later);
  }

  frame(lane: number): Frame | undefined {
    return this.histories[lane]?.at(this.shown);
  }

  /** Whether some solver has more to do. */
  get goesOn(): boolean {
    return this.histories.some((history) => (history.last?.state ?? State.Running) === State.Running);
  }
}
