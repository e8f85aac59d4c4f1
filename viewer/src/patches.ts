// The patches as triangles around their centres, corners shared by neighbours, and which patch a ray meets.

import type { Scene } from './protocol';

export interface Hit {
  patch: number;
  distance: number;
}

/** Corners that are this near, relative to the scene, are one; normals that differ by no more are of one plane. */
const NEAR = 1e-5;

export class Patches {
  readonly count: number;
  /** 3 or 4. */
  readonly sides: Uint8Array;
  readonly areas: Float32Array;
  readonly centres: Float32Array;
  readonly normals: Float32Array;
  /** The surface of each patch. */
  readonly surface: Uint16Array;
  /** The first vertex of each patch: its corners, then its centre. */
  readonly first: Uint32Array;
  readonly low = [Infinity, Infinity, Infinity];
  readonly high = [-Infinity, -Infinity, -Infinity];
  /** Which shared corner each vertex is; the centres have none of their own. */
  private readonly shared: Uint32Array;
  private readonly sums: Float32Array;
  /** The shared corners at the rim of a surface, beyond which there is no neighbour. */
  private readonly rim: Uint8Array;
  private readonly uses: Float32Array;

  constructor(
    scene: Scene,
    private readonly corners: Float32Array,
  ) {
    const n = (this.count = scene.patches);
    this.sides = new Uint8Array(n);
    this.areas = new Float32Array(n);
    this.centres = new Float32Array(3 * n);
    this.normals = new Float32Array(3 * n);
    this.surface = new Uint16Array(n);
    this.first = new Uint32Array(n + 1);
    scene.surfaces.forEach(({ patches: [from, to] }, s) => this.surface.fill(s, from, to));
    for (let i = 0; i < n; i++) this.measure(i);
    this.shared = new Uint32Array(this.vertices);
    const groups = this.weld();
    this.sums = new Float32Array(3 * groups);
    this.uses = new Float32Array(groups);
    this.eachCorner((vertex) => this.uses[this.shared[vertex]!]!++);
    this.rim = this.findRim(groups);
  }

  get vertices(): number {
    return this.first[this.count]!;
  }

  get diagonal(): number {
    return Math.hypot(...this.high.map((high, k) => high - this.low[k]!));
  }

  corner(i: number, k: number): [number, number, number] {
    const at = 12 * i + 3 * k;
    return [this.corners[at]!, this.corners[at + 1]!, this.corners[at + 2]!];
  }

  /** Area, centre and normal of a patch, from the two triangles abc and acd. */
  private measure(i: number): void {
    const [a, b, c, d] = [0, 1, 2, 3].map((k) => this.corner(i, k)) as [V, V, V, V];
    const sides = c.every((x, k) => x === d[k]) ? 3 : 4;
    const first = cross(sub(b, a), sub(c, a));
    const second = cross(sub(c, a), sub(d, a));
    const whole = add(first, second);
    const area = Math.hypot(...whole);
    const normal = whole.map((x) => x / area) as V;
    const [w1, w2] = [dot(first, normal) / area, dot(second, normal) / area];
    this.sides[i] = sides;
    this.areas[i] = area / 2;
    this.first[i + 1] = this.first[i]! + sides + 1;
    for (let k = 0; k < 3; k++) {
      this.centres[3 * i + k] = (w1 * (a[k]! + b[k]! + c[k]!) + w2 * (a[k]! + c[k]! + d[k]!)) / 3;
      this.normals[3 * i + k] = normal[k]!;
      this.low[k] = Math.min(this.low[k]!, a[k]!, b[k]!, c[k]!, d[k]!);
      this.high[k] = Math.max(this.high[k]!, a[k]!, b[k]!, c[k]!, d[k]!);
    }
  }

  /** Finds the corners that neighbours in one plane of one surface have in common; returns how many there are. */
  private weld(): number {
    const numbers = new Map<string, number>();
    const unit = NEAR * this.diagonal;
    for (let i = 0; i < this.count; i++) {
      const plane = [0, 1, 2].map((k) => Math.round(this.normals[3 * i + k]! * 1e3));
      for (let k = 0; k < this.sides[i]!; k++) {
        const place = this.corner(i, k).map((x) => Math.round(x / unit));
        const key = `${this.surface[i]} ${plane.join(' ')} ${place.join(' ')}`;
        const number = numbers.get(key) ?? numbers.size;
        numbers.set(key, number);
        this.shared[this.first[i]! + k] = number;
      }
    }
    return numbers.size;
  }

  /** The ends of edges that belong to one patch alone. */
  private findRim(groups: number): Uint8Array {
    const edges = new Map<number, number>();
    const key = (a: number, b: number): number => Math.min(a, b) * groups + Math.max(a, b);
    const eachEdge = (visit: (a: number, b: number) => void): void =>
      this.eachCorner((vertex, i) => {
        const next = this.first[i]! + ((vertex - this.first[i]! + 1) % this.sides[i]!);
        visit(this.shared[vertex]!, this.shared[next]!);
      });
    eachEdge((a, b) => edges.set(key(a, b), (edges.get(key(a, b)) ?? 0) + 1));
    const rim = new Uint8Array(groups);
    eachEdge((a, b) => {
      if (edges.get(key(a, b)) === 1) rim[a] = rim[b] = 1;
    });
    return rim;
  }

  private eachCorner(visit: (vertex: number, patch: number) => void): void {
    for (let i = 0; i < this.count; i++) {
      const first = this.first[i]!;
      for (let k = 0; k < this.sides[i]!; k++) visit(first + k, i);
    }
  }

  /** Values of patches become values of vertices: means over neighbours at corners, or everywhere the patch's own. */
  spread(values: Float32Array, channels: number, smooth: boolean, out: Float32Array): void {
    const { sums, shared, uses, first } = this;
    if (smooth) {
      sums.fill(0);
      this.eachCorner((vertex, i) => {
        const group = channels * shared[vertex]!;
        for (let c = 0; c < channels; c++) sums[group + c]! += values[channels * i + c]!;
      });
    }
    for (let i = 0; i < this.count; i++) {
      const centre = first[i + 1]! - 1;
      for (let vertex = first[i]!; vertex <= centre; vertex++) {
        const own = !smooth || vertex === centre;
        for (let c = 0; c < channels; c++) {
          const group = shared[vertex]!;
          out[channels * vertex + c] = own ? values[channels * i + c]! : sums[channels * group + c]! / uses[group]!;
        }
      }
    }
    if (smooth) this.extrapolate(values, channels, out);
  }

  /**
   * At the rim the mean of patches is that of half a patch further in, and half a row would be flat: on quadrilaterals light goes
   * on from the opposite corner through the centre, to twice the mean at most.
   */
  private extrapolate(values: Float32Array, channels: number, out: Float32Array): void {
    const { sums, shared, uses, rim, first, sides } = this;
    const opposite = (vertex: number, i: number): number => first[i]! + ((vertex - first[i]! + 2) % 4);
    const goesOn = (vertex: number, i: number): boolean =>
      sides[i] === 4 && rim[shared[vertex]!] === 1 && rim[shared[opposite(vertex, i)]!] === 0;
    const counts = new Uint8Array(uses.length);
    const means = out.slice();
    sums.fill(0);
    this.eachCorner((vertex, i) => {
      if (!goesOn(vertex, i)) return;
      const group = shared[vertex]!;
      counts[group]!++;
      for (let c = 0; c < channels; c++) {
        const mean = means[channels * vertex + c]!;
        const on = 2 * values[channels * i + c]! - means[channels * opposite(vertex, i) + c]!;
        sums[channels * group + c]! += Math.min(mean + Math.abs(mean), Math.max(mean - Math.abs(mean), on));
      }
    });
    this.eachCorner((vertex) => {
      const group = shared[vertex]!;
      if (counts[group] === 0) return;
      for (let c = 0; c < channels; c++) out[channels * vertex + c] = sums[channels * group + c]! / counts[group]!;
    });
  }

  /** Positions and normals of vertices, the distance from the edge (0 at corners, 1 at centres), triangles, and edges. */
  build(): { position: Float32Array; normal: Float32Array; edge: Float32Array; index: Uint32Array; edges: Uint32Array } {
    const position = new Float32Array(3 * this.vertices);
    const normal = new Float32Array(3 * this.vertices);
    const edge = new Float32Array(this.vertices);
    const edges = new Uint32Array(2 * (this.vertices - this.count));
    const index = new Uint32Array(3 * (this.vertices - this.count));
    let at = 0;
    for (let i = 0; i < this.count; i++) {
      const [first, sides] = [this.first[i]!, this.sides[i]!];
      const centre = first + sides;
      for (let k = 0; k < sides; k++) {
        position.set(this.corner(i, k), 3 * (first + k));
        const next = first + ((k + 1) % sides);
        index.set([first + k, next, centre], 3 * at);
        edges.set([first + k, next], 2 * at);
        at++;
      }
      position.set(this.centres.subarray(3 * i, 3 * i + 3), 3 * centre);
      edge[centre] = 1;
      for (let vertex = first; vertex <= centre; vertex++) normal.set(this.normals.subarray(3 * i, 3 * i + 3), 3 * vertex);
    }
    return { position, normal, edge, index, edges };
  }

  /** The first front that a ray meets. */
  pick(origin: V, direction: V): Hit | undefined {
    let best: Hit | undefined;
    for (let i = 0; i < this.count; i++) {
      const normal: V = [this.normals[3 * i]!, this.normals[3 * i + 1]!, this.normals[3 * i + 2]!];
      const slope = dot(direction, normal);
      if (slope >= 0) continue;
      const distance = dot(sub(this.corner(i, 0), origin), normal) / slope;
      if (distance <= 0 || (best && distance >= best.distance)) continue;
      const point = direction.map((x, k) => origin[k]! + distance * x) as V;
      if (this.contains(i, point, normal)) best = { patch: i, distance };
    }
    return best;
  }

  private contains(i: number, point: V, normal: V): boolean {
    const sides = this.sides[i]!;
    for (let k = 0; k < sides; k++) {
      const from = this.corner(i, k);
      const edge = sub(this.corner(i, (k + 1) % sides), from);
      if (dot(cross(edge, sub(point, from)), normal) < 0) return false;
    }
    return true;
  }
}

export type V = [number, number, number];
const sub = (a: V, b: V): V => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const add = (a: V, b: V): V => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const dot = (a: V, b: V): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a: V, b: V): V => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
