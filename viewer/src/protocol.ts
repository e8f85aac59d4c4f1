// What the page and the server say to each other; the table is in crates/fredholm-cli/src/view/protocol.rs.

/** What F_ij is. */
export type Discretisation = 'galerkin' | 'collocation' | 'nystrom';
/** What light is on each patch: constant, linear, quadratic. */
export type Degree = 'p0' | 'p1' | 'p2';
export interface Kind {
  method: Discretisation;
  space: Degree;
}

export type Solver = 'southwell' | 'gauss-seidel' | 'jacobi' | 'successive' | 'gmres';

export interface Camera {
  position: number[];
  target: number[];
  up: number[];
  /** Degrees. */
  vertical_angle: number;
}

export interface Surface {
  name: string;
  /** The first of its patches, and the one after its last. */
  patches: [number, number];
  reflectance: number[];
  emission: number[];
}

/** A sky, from which its radiance in any direction follows: sky.ts. */
export interface Sky {
  /** The radiance of the zenith. */
  zenith: number[];
  up: number[];
  towards_sun: number[];
  overcast: boolean;
  /** a, b, c, d, e of the CIE's general skies. */
  numbers: number[];
  /** The lamp that dims it. */
  lamp: number | null;
}

export interface Scene {
  name: string;
  patches: number;
  patch_size: number;
  units: { exitance: string; irradiance: string; radiance: string; power: string; length: string };
  surfaces: Surface[];
  /** Which surfaces each lamp is; none if it is a point. */
  lamps: { name: string; surfaces: number[] }[];
  /** What is beyond the surfaces, if there is something. */
  sky: Sky | null;
  camera: Camera;
  /** From radiance to a screen on which 1 is white. */
  exposure: number;
  /** What begins; none of a recording. */
  kind: Kind | null;
  solvers: Solver[];
  /** Of the run of now: whether F is stored, without which there is only shooting, and its largest row sum. */
  stored: boolean;
  row_sum: number;
}

export type Command =
  | { type: 'start'; kind: Kind; solvers: Solver[]; lamps: number[]; reflectance: number[][] }
  | { type: 'play'; passes: number }
  | { type: 'pause' }
  | { type: 'step' }
  | { type: 'factors'; patch: number }
  | { type: 'relight'; reflectance: number[][]; version: number }
  | { type: 'export'; format: Format; camera?: Camera & { aspect: number }; shown?: Shown };

export type Format = 'csv' | 'npz' | 'json' | 'png' | 'exr' | 'vtu' | 'glb';

/** Light that is shown, and which the server does not have. */
export interface Shown {
  /** Three numbers for each patch, f32, in base64. */
  radiosity: string;
  lamps: number[];
  reflectance: number[][];
  /** Of the solver's course; none of a sum over lamps. */
  moment?: { iteration: number; work: number; residual: number };
}

export enum State {
  Running,
  Converged,
  Diverged,
  Stalled,
}

export const NONE = 0xffffffff;

export interface Frame {
  lane: number;
  run: number;
  iteration: number;
  /** The patch shot last, or NONE. */
  shot: number;
  state: State;
  /** Form factors used over n². */
  work: number;
  residual: number;
  /** NaN where there is none. */
  bound: number;
  unshot: number;
  /** B of each patch, three channels. */
  radiosity: Float32Array;
  /** |r| of each patch. */
  rest: Float32Array;
}

export type Message =
  | { type: 'assembly'; done: number; of: number }
  | {
      type: 'started'; run: number; kind: Kind; solvers: Solver[]; unknowns: number; stored: boolean; row_sum: number | null;
      norm: number | null; target: number;
    }
  | { type: 'error'; message: string }
  | { type: 'frame'; frame: Frame }
  | { type: 'factors'; patch: number; row: Float32Array; column: Float32Array }
  | { type: 'lamp'; lamp: number; version: number; state: State; radiosity: Float32Array }
  | { type: 'file'; name: string; content: ArrayBuffer };

/** Reads a binary message; `patches` is how many there are. */
export function decode(bytes: ArrayBuffer, patches: number): Message {
  const view = new DataView(bytes);
  const word = (k: number): number => view.getUint32(4 * k, true);
  switch (word(0)) {
    case 1:
      return { type: 'frame', frame: decodeFrame(bytes, patches) };
    case 2:
      return {
        type: 'factors',
        patch: word(1),
        row: new Float32Array(bytes, 8, patches),
        column: new Float32Array(bytes, 8 + 4 * patches, patches),
      };
    case 3:
      return {
        type: 'lamp',
        lamp: word(1),
        version: word(2),
        state: word(3),
        radiosity: new Float32Array(bytes, 16, 3 * patches),
      };
    case 4: {
      const end = 8 + word(1);
      return { type: 'file', name: new TextDecoder().decode(bytes.slice(8, end)), content: bytes.slice(end) };
    }
    default:
      throw new Error(`a message of kind ${word(0)} is none`);
  }
}

function decodeFrame(bytes: ArrayBuffer, patches: number): Frame {
  const view = new DataView(bytes);
  return {
    ...decodeHead(view, 0),
    radiosity: new Float32Array(bytes, 56, 3 * patches),
    rest: new Float32Array(bytes, 56 + 12 * patches, patches),
  };
}

/** The head of a frame, 56 bytes from `at`. */
export function decodeHead(view: DataView, at: number): Omit<Frame, 'radiosity' | 'rest'> {
  const word = (k: number): number => view.getUint32(at + 4 * k, true);
  const number = (k: number): number => view.getFloat64(at + 24 + 8 * k, true);
  return {
    lane: word(1),
    run: word(2),
    iteration: word(3),
    shot: word(4),
    state: word(5),
    work: number(0),
    residual: number(1),
    bound: number(2),
    unshot: number(3),
  };
}
