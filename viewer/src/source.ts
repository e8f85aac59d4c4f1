// Where frames come from: a server that solves while one looks, or a recording in the page itself.

import { decode, decodeHead, type Command, type Frame, type Message, type Scene } from './protocol';

export interface Source {
  readonly live: boolean;
  readonly scene: Scene;
  /** Corners of patches, 12 numbers each, in metres. */
  readonly corners: Float32Array;
  send(command: Command): void;
  listen(hear: (message: Message) => void, lost: () => void): void;
}

/** The recording in this page if there is one, else the server that it came from. */
export async function open(): Promise<Source> {
  const recorded = document.getElementById('recording');
  return recorded ? new Recording(recorded.textContent ?? '') : Live.connect();
}

class Live implements Source {
  readonly live = true;

  private constructor(
    readonly scene: Scene,
    readonly corners: Float32Array,
    private readonly socket: WebSocket,
  ) {}

  static async connect(): Promise<Live> {
    const [scene, geometry] = await Promise.all([
      get('scene.json').then((answer) => answer.json() as Promise<Scene>),
      get('geometry.bin').then((answer) => answer.arrayBuffer()),
    ]);
    const socket = new WebSocket(`ws://${location.host}/session`);
    socket.binaryType = 'arraybuffer';
    // Until a run begins and says it.
    Object.assign(scene, { stored: scene.solvers.length > 1, row_sum: 1 });
    return new Live(scene, new Float32Array(geometry), socket);
  }

  send(command: Command): void {
    const text = JSON.stringify(command);
    if (this.socket.readyState === WebSocket.CONNECTING) {
      this.socket.addEventListener('open', () => this.socket.send(text), { once: true });
    } else if (this.socket.readyState === WebSocket.OPEN) {
      this.socket.send(text);
    }
  }

  listen(hear: (message: Message) => void, lost: () => void): void {
    this.socket.onmessage = ({ data }) =>
      hear(typeof data === 'string' ? (JSON.parse(data) as Message) : decode(data as ArrayBuffer, this.scene.patches));
    this.socket.onclose = lost;
  }
}

async function get(path: string): Promise<Response> {
  const answer = await fetch(path);
  if (!answer.ok) throw new Error(`${path}: ${answer.status} ${await answer.text()}`);
  return answer;
}

/** What `fredholm radiosity --html` writes into the page. */
interface Recorded {
  scene: Scene;
  started: Omit<Extract<Message, { type: 'started' }>, 'type' | 'run'>;
  geometry: string;
  /** Heads as in the protocol; then a scale, f32, and f16 parts of it: 3 of radiosity, 1 of residual, for each patch. */
  frames: string[];
}

class Recording implements Source {
  readonly live = false;
  readonly scene: Scene;
  readonly corners: Float32Array;
  private readonly recorded: Recorded;

  constructor(text: string) {
    this.recorded = JSON.parse(text) as Recorded;
    this.scene = { ...this.recorded.scene, stored: false, row_sum: 1 };
    this.corners = new Float32Array(bytes(this.recorded.geometry));
  }

  send(): void {
    // Nobody is there to be told; what a recording cannot do is not offered.
  }

  listen(hear: (message: Message) => void): void {
    hear({ type: 'started', run: 0, ...this.recorded.started });
    for (const text of this.recorded.frames) hear({ type: 'frame', frame: this.frame(bytes(text)) });
  }

  private frame(buffer: ArrayBuffer): Frame {
    const view = new DataView(buffer);
    const scales = [view.getFloat32(56, true), view.getFloat32(60, true)];
    const n = this.scene.patches;
    const halves = new Uint16Array(buffer, 64);
    const part = (from: number, count: number, scale: number): Float32Array =>
      Float32Array.from(halves.subarray(from, from + count), (half) => scale * number(half));
    return { ...decodeHead(view, 0), radiosity: part(0, 3 * n, scales[0]!), rest: part(3 * n, n, scales[1]!) };
  }
}

function bytes(base64: string): ArrayBuffer {
  return Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0)).buffer;
}

/** A number in half precision (IEEE 754), of which none is infinite here. */
function number(half: number): number {
  const sign = half & 0x8000 ? -1 : 1;
  const exponent = (half >> 10) & 0x1f;
  const fraction = half & 0x3ff;
  return sign * (exponent === 0 ? fraction * 2 ** -24 : (1 + fraction / 1024) * 2 ** (exponent - 15));
}
