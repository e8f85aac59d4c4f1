// The picture: patches seen by one camera, once or twice side by side, drawn when something has changed.

import {
  AgXToneMapping, BufferAttribute, BufferGeometry, DynamicDrawUsage, Line, LineBasicMaterial,
  LineSegments, Mesh, MOUSE, NeutralToneMapping,
  NoToneMapping, PerspectiveCamera, Scene as Space, Vector2, Vector3, WebGLRenderer, type ToneMapping,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { PatchMaterial } from './material';
import type { Hit, Patches, V } from './patches';
import type { Camera, Sky } from './protocol';
import type { Scale } from './scale';
import { Backdrop } from './sky';
import { Walk } from './walk';

export type Tone = 'neutral' | 'agx' | 'linear';
const TONES: Record<Tone, ToneMapping> = { neutral: NeutralToneMapping, agx: AgXToneMapping, linear: NoToneMapping };

/** What is drawn of one solver. */
export class Picture {
  readonly material = new PatchMaterial();
  readonly space = new Space();
  private readonly geometry = new BufferGeometry();
  private readonly outlines: Record<'picked' | 'shot', Line>;
  private readonly backdrop: Backdrop | undefined;

  constructor(
    private readonly patches: Patches,
    shape: ReturnType<Patches['build']>,
    sky: Sky | null,
  ) {
    const { geometry } = this;
    geometry.setIndex(new BufferAttribute(shape.index, 1));
    geometry.setAttribute('position', new BufferAttribute(shape.position, 3));
    geometry.setAttribute('edge', new BufferAttribute(shape.edge, 1));
    geometry.setAttribute('normal', new BufferAttribute(shape.normal, 3));
    for (const [name, channels] of [['light', 3], ['number', 1]] as const) {
      const attribute = new BufferAttribute(new Float32Array(channels * patches.vertices), channels);
      geometry.setAttribute(name, attribute.setUsage(DynamicDrawUsage));
    }
    const mesh = new Mesh(geometry, this.material);
    // Where patches of different sizes meet, rounding leaves cracks between them, which their edges cover.
    const seams = new BufferGeometry().setIndex(new BufferAttribute(shape.edges, 1));
    for (const name of Object.keys(geometry.attributes)) seams.setAttribute(name, geometry.getAttribute(name));
    const edges = new LineSegments(seams, this.material.forEdges());
    mesh.frustumCulled = edges.frustumCulled = false;
    this.space.add(mesh, edges);
    if (sky) this.space.add((this.backdrop = new Backdrop(sky)));
    this.outlines = { picked: outline(0xffffff), shot: outline(0xffb000) };
    this.space.add(...Object.values(this.outlines));
  }

  /** Shows light; `exposure` is from radiance to a screen on which 1 is white, `sky` how bright that is, of what the scene says. */
  showLight(exposure: number, sky: number): void {
    this.material.showLight(exposure / Math.PI);
    this.backdrop?.show(exposure * sky);
  }

  /** Shows numbers of patches on a scale; what is no surface has none. */
  showNumbers(scale: Scale, contours: boolean): void {
    this.material.showNumbers(scale, contours);
    if (this.backdrop) this.backdrop.visible = false;
  }

  /** Values of patches, three or one each. */
  set(name: 'light' | 'number', values: Float32Array, smooth: boolean): void {
    const attribute = this.geometry.getAttribute(name) as BufferAttribute;
    this.patches.spread(values, name === 'light' ? 3 : 1, smooth, attribute.array as Float32Array);
    attribute.needsUpdate = true;
  }

  /** Draws a line around a patch, or none. */
  mark(what: 'picked' | 'shot', patch: number | undefined): void {
    const line = this.outlines[what];
    line.visible = patch !== undefined && patch < this.patches.count;
    if (!line.visible) return;
    const { patches } = this;
    const sides = patches.sides[patch!]!;
    const lift = 1e-3 * patches.diagonal;
    const normal = patches.normals.subarray(3 * patch!, 3 * patch! + 3);
    const points = Array.from({ length: sides + 1 }, (_, k) => {
      const corner = patches.corner(patch!, k % sides);
      return new Vector3(...(corner.map((x, c) => x + lift * normal[c]!) as V));
    });
    line.geometry.dispose();
    line.geometry = new BufferGeometry().setFromPoints(points);
  }
}

function outline(colour: number): Line {
  const line = new Line(new BufferGeometry(), new LineBasicMaterial({ color: colour, toneMapped: false, depthTest: false }));
  line.visible = false;
  line.renderOrder = 1;
  return line;
}

export class View {
  readonly pictures: Picture[];
  readonly renderer: WebGLRenderer;
  readonly camera: PerspectiveCamera;
  readonly orbit: OrbitControls;
  readonly walk: Walk;
  /** One picture or two. */
  shown = 1;
  private dirty = true;
  private last = performance.now();
  /** Called when the camera has come to rest somewhere else. */
  onmove = (): void => {};

  constructor(
    readonly canvas: HTMLCanvasElement,
    private readonly patches: Patches,
    private readonly home: Camera,
    sky: Sky | null,
  ) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: false });
    this.renderer.autoClear = false;
    const shape = patches.build();
    this.pictures = [new Picture(patches, shape, sky), new Picture(patches, shape, sky)];
    const size = patches.diagonal;
    this.camera = new PerspectiveCamera(home.vertical_angle, 1, 1e-3 * size, 20 * size);
    // The controls take what is up when they are made.
    this.camera.up.set(...(home.up as V)).normalize();
    this.orbit = new OrbitControls(this.camera, canvas);
    this.orbit.zoomToCursor = true;
    this.orbit.mouseButtons = { LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.PAN };
    this.orbit.addEventListener('change', () => this.draw());
    this.orbit.addEventListener('end', () => this.onmove());
    this.walk = new Walk(this.camera, this.orbit.target, size, canvas, () => this.draw());
    canvas.addEventListener('pointerup', () => this.walk.enabled && this.onmove());
    this.go(home);
    new ResizeObserver(() => this.draw()).observe(canvas);
    requestAnimationFrame(() => this.tick());
  }

  /** Puts the camera somewhere, or back where it was at first. */
  go(camera: Camera = this.home): void {
    this.camera.position.set(...(camera.position as V));
    this.orbit.target.set(...(camera.target as V));
    this.camera.lookAt(this.orbit.target);
    this.orbit.update();
    this.draw();
  }

  /** Where the camera is. */
  get eye(): Camera & { aspect: number } {
    return {
      position: this.camera.position.toArray(),
      target: this.orbit.target.toArray(),
      up: this.camera.up.toArray(),
      vertical_angle: this.camera.fov,
      aspect: this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight),
    };
  }

  setWalking(walking: boolean): void {
    this.walk.enabled = walking;
    this.orbit.enabled = !walking;
  }

  setTone(tone: Tone): void {
    this.renderer.toneMapping = TONES[tone];
    this.draw();
  }

  /** Asks for a new picture. */
  draw(): void {
    this.dirty = true;
  }

  private tick(): void {
    const now = performance.now();
    if (this.walk.moving) {
      this.walk.go((now - this.last) / 1000);
      this.draw();
    }
    this.last = now;
    if (this.dirty) this.render();
    requestAnimationFrame(() => this.tick());
  }

  /** The parts of the canvas that show each picture, in CSS pixels from the lower left: x, y, width, height. */
  private parts(): [number, number, number, number][] {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (this.shown === 1) return [[0, 0, width, height]];
    return width > height
      ? [[0, 0, width / 2, height], [width / 2, 0, width / 2, height]]
      : [[0, height / 2, width, height / 2], [0, 0, width, height / 2]];
  }

  render(): void {
    this.dirty = false;
    const { renderer, camera, canvas } = this;
    const { clientWidth: width, clientHeight: height } = canvas;
    if (width === 0 || height === 0) return;
    const size = renderer.getSize(new Vector2());
    const ratio = Math.min(devicePixelRatio, 2);
    if (size.x !== width || size.y !== height || renderer.getPixelRatio() !== ratio) {
      renderer.setPixelRatio(ratio);
      renderer.setSize(width, height, false);
    }
    renderer.setScissorTest(true);
    renderer.setClearColor(getComputedStyle(canvas).backgroundColor, 1);
    this.parts().forEach((part, k) => {
      const aspect = part[2] / part[3];
      camera.aspect = aspect;
      // A view of a landscape must not lose its sides in a portrait.
      const whole = Math.tan((this.home.vertical_angle * Math.PI) / 360);
      camera.fov = (360 / Math.PI) * Math.atan(aspect < 1 ? whole / aspect : whole);
      camera.updateProjectionMatrix();
      renderer.setViewport(...part);
      renderer.setScissor(...part);
      renderer.clear();
      renderer.render(this.pictures[k]!.space, camera);
    });
  }

  /** Which picture and patch are under a pointer. */
  pick(event: { clientX: number; clientY: number }): (Hit & { picture: number }) | undefined {
    const box = this.canvas.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, box.bottom - event.clientY];
    const parts = this.parts();
    const picture = parts.findIndex((part) => x >= part[0] && x < part[0] + part[2] && y >= part[1] && y < part[1] + part[3]);
    const part = parts[picture];
    if (!part) return undefined;
    const direction = new Vector3((2 * (x - part[0])) / part[2] - 1, (2 * (y - part[1])) / part[3] - 1, 0.5)
      .unproject(this.camera)
      .sub(this.camera.position);
    const hit = this.patches.pick(this.camera.position.toArray() as V, direction.normalize().toArray() as V);
    return hit && { ...hit, picture };
  }
}
