// The residual, the error bound and the unshot power over the work that they took: two small plots with one axis of work.

import type { Point } from './history';
import { power, text } from './scale';

export interface Series {
  name: string;
  points: Point[];
}

interface Kind {
  of: (point: Point) => number;
  dash: number[];
  label: string;
  short: string;
}

const RESIDUAL: Kind = { of: (p) => p.residual, dash: [], label: 'residual ‖r‖', short: '‖r‖' };
const BOUND: Kind = { of: (p) => p.bound, dash: [5, 3], label: 'error bound', short: 'bound' };
const UNSHOT: Kind = { of: (p) => p.unshot, dash: [], label: 'unshot power', short: 'unshot' };

export interface Look {
  units: { exitance: string; power: string };
  ink: string;
  faint: string;
  colours: [string, string];
}

/** Between the two plots, and left and right of a plot's area, in pixels. */
const GAP = 12;
const LEFT = 40;
const RIGHT = 6;

const most = (points: Point[]): number => points.reduce((largest, point) => Math.max(largest, point.work), 0) || 1;

export class Curves {
  constructor(private readonly canvas: HTMLCanvasElement) {}

  /** The work under a place of the canvas. */
  workAt(x: number, points: Point[]): number {
    const half = (this.canvas.clientWidth - GAP) / 2;
    const within = (x % (half + GAP)) - LEFT;
    return (Math.max(0, within) / (half - LEFT - RIGHT)) * most(points);
  }

  draw(series: Series[], shown: number | undefined, look: Look): void {
    const { canvas } = this;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    const ratio = devicePixelRatio;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const pen = canvas.getContext('2d');
    if (!pen || width === 0) return;
    pen.scale(ratio, ratio);
    const all = series.flatMap(({ points }) => points);
    if (all.length === 0) return;
    const half = (width - GAP) / 2;
    const plot = (left: number, kinds: Kind[], unit: string): void =>
      new Plot(pen, { left, width: half, height }, most(all), look).draw(series, kinds, unit, shown);
    plot(0, [RESIDUAL, BOUND], look.units.exitance);
    plot(half + GAP, [UNSHOT], look.units.power);
  }
}

interface Box {
  left: number;
  width: number;
  height: number;
}

class Plot {
  private low = 0;
  private high = 1;

  constructor(
    private readonly pen: CanvasRenderingContext2D,
    private readonly box: Box,
    private readonly most: number,
    private readonly look: Look,
  ) {}

  private get area(): { x: number; y: number; width: number; height: number } {
    const { left, width, height } = this.box;
    return { x: left + LEFT, y: 16, width: width - LEFT - RIGHT, height: height - 32 };
  }

  draw(series: Series[], kinds: Kind[], unit: string, shown: number | undefined): void {
    const values = series.flatMap(({ points }) => points.flatMap((point) => kinds.map((kind) => kind.of(point))));
    const positive = values.filter((value) => value > 0 && Number.isFinite(value)).map(Math.log10);
    if (positive.length === 0) return;
    this.high = Math.ceil(Math.max(...positive) + 1e-9);
    this.low = Math.min(Math.floor(Math.min(...positive)), this.high - 1);
    this.frame(kinds, unit);
    series.forEach(({ points }, lane) => kinds.forEach((kind) => this.curve(points, kind, this.look.colours[lane]!)));
    if (shown !== undefined) this.line(this.x(shown));
  }

  /** On a phone. */
  private get isNarrow(): boolean {
    return this.box.width < 260;
  }

  private x(work: number): number {
    return this.area.x + (work / this.most) * this.area.width;
  }

  private y(value: number): number {
    const at = (Math.log10(Math.max(value, 1e-300)) - this.low) / (this.high - this.low);
    return this.area.y + (1 - Math.min(1, Math.max(0, at))) * this.area.height;
  }

  private frame(kinds: Kind[], unit: string): void {
    const { pen, look, area } = this;
    pen.font = '11px system-ui, sans-serif';
    pen.lineWidth = 1;
    const step = Math.max(1, Math.ceil((this.high - this.low) / Math.max(1, Math.floor(area.height / 16))));
    for (let exponent = this.low; exponent <= this.high; exponent += step) {
      const y = this.y(10 ** exponent);
      pen.strokeStyle = look.faint;
      pen.beginPath();
      pen.moveTo(area.x, y);
      pen.lineTo(area.x + area.width, y);
      pen.stroke();
      pen.fillStyle = look.ink;
      pen.textAlign = 'right';
      pen.fillText(power(exponent), area.x - 4, y + 4);
    }
    pen.textAlign = 'left';
    this.title(kinds, unit);
    pen.textAlign = 'center';
    if (!this.isNarrow) pen.fillText('form factors used', area.x + area.width / 2, this.box.height - 3);
    pen.textAlign = 'right';
    pen.fillText(`${text(this.most)} n²`, area.x + area.width, this.box.height - 3);
    pen.textAlign = 'left';
    pen.fillText('0', area.x, this.box.height - 3);
  }

  private title(kinds: Kind[], unit: string): void {
    const { pen, look } = this;
    let x = this.area.x;
    for (const kind of kinds) {
      pen.strokeStyle = look.ink;
      pen.setLineDash(kind.dash);
      pen.beginPath();
      pen.moveTo(x, 7);
      pen.lineTo(x + 14, 7);
      pen.stroke();
      pen.setLineDash([]);
      const label = this.isNarrow ? kind.short : kind.label;
      pen.fillText(label, x + 18, 11);
      x += 26 + pen.measureText(label).width;
    }
    pen.fillText(this.isNarrow ? unit : `in ${unit}`, x - 4, 11);
  }

  private curve(points: Point[], kind: Kind, colour: string): void {
    const { pen } = this;
    pen.strokeStyle = colour;
    pen.lineWidth = 1.75;
    pen.setLineDash(kind.dash);
    pen.beginPath();
    let begun = false;
    for (const point of points) {
      const value = kind.of(point);
      if (!(value > 0)) continue;
      if (begun) pen.lineTo(this.x(point.work), this.y(value));
      else pen.moveTo(this.x(point.work), this.y(value));
      begun = true;
    }
    pen.stroke();
    pen.setLineDash([]);
  }

  private line(x: number): void {
    const { pen, area, look } = this;
    pen.strokeStyle = look.ink;
    pen.lineWidth = 1;
    pen.beginPath();
    pen.moveTo(x, area.y);
    pen.lineTo(x, area.y + area.height);
    pen.stroke();
  }
}
