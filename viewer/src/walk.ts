// Walking: drag to look around; W A S D or the arrows, or a pad under a thumb, to go; Q and E down and up. The eye stays where it is put.

import { Quaternion, Vector3, type PerspectiveCamera } from 'three';

const KEYS: Record<string, [number, number, number]> = {
  KeyW: [0, 0, 1], ArrowUp: [0, 0, 1], KeyS: [0, 0, -1], ArrowDown: [0, 0, -1],
  KeyA: [-1, 0, 0], ArrowLeft: [-1, 0, 0], KeyD: [1, 0, 0], ArrowRight: [1, 0, 0],
  KeyE: [0, 1, 0], KeyQ: [0, -1, 0],
};

/** Of the scene's diagonal, a second. */
const SPEED = 0.2;
/** Radians a pixel. */
const TURN = 0.004;

export class Walk {
  enabled = false;
  private readonly held = new Set<string>();
  /** What a pad asks for: to the right, up and forward, each from −1 to 1. */
  readonly push: [number, number, number] = [0, 0, 0];
  /** The pointer that looks around, and where it was last: by touch no browser need say how far it moved. */
  private looking: { pointer: number; x: number; y: number } | undefined;

  constructor(
    private readonly camera: PerspectiveCamera,
    private readonly target: Vector3,
    private readonly diagonal: number,
    canvas: HTMLElement,
    private readonly changed: () => void,
  ) {
    canvas.addEventListener('pointerdown', (event) => {
      if (!this.enabled || this.looking || !(event.buttons & 1)) return;
      this.looking = { pointer: event.pointerId, x: event.clientX, y: event.clientY };
    });
    canvas.addEventListener('pointermove', (event) => {
      const { looking } = this;
      if (!this.enabled || looking?.pointer !== event.pointerId) return;
      this.turn(event.clientX - looking.x, event.clientY - looking.y);
      [looking.x, looking.y] = [event.clientX, event.clientY];
    });
    for (const end of ['pointerup', 'pointercancel'] as const) {
      addEventListener(end, (event) => {
        if (this.looking?.pointer === event.pointerId) this.looking = undefined;
      });
    }
    canvas.addEventListener('keydown', (event) => {
      if (this.enabled && event.code in KEYS && !event.ctrlKey && !event.metaKey) {
        this.held.add(event.code);
        event.preventDefault();
        event.stopPropagation();
        this.changed();
      }
    });
    addEventListener('keyup', (event) => this.held.delete(event.code));
    addEventListener('blur', () => this.held.clear());
  }

  get moving(): boolean {
    return this.enabled && (this.held.size > 0 || this.push.some((part) => part !== 0));
  }

  /** Goes on for so many seconds. */
  go(seconds: number): void {
    if (!this.moving) return;
    const forward = this.target.clone().sub(this.camera.position).normalize();
    const right = forward.clone().cross(this.camera.up).normalize();
    const step = new Vector3();
    for (const key of this.held) {
      const [x, y, z] = KEYS[key]!;
      step.addScaledVector(right, x).addScaledVector(this.camera.up, y).addScaledVector(forward, z);
    }
    const [x, y, z] = this.push;
    step.addScaledVector(right, x).addScaledVector(this.camera.up, y).addScaledVector(forward, z);
    // Keys are on or off, a pad is pushed more or less.
    step.clampLength(0, 1).multiplyScalar(SPEED * this.diagonal * Math.min(seconds, 0.1));
    this.camera.position.add(step);
    this.target.add(step);
  }

  private turn(x: number, y: number): void {
    const ahead = this.target.clone().sub(this.camera.position);
    const right = ahead.clone().cross(this.camera.up).normalize();
    ahead.applyQuaternion(new Quaternion().setFromAxisAngle(this.camera.up, -TURN * x));
    const tilted = ahead.clone().applyQuaternion(new Quaternion().setFromAxisAngle(right, -TURN * y));
    // Not over the zenith: there right and left change places.
    if (tilted.clone().normalize().cross(this.camera.up).length() > 0.05) ahead.copy(tilted);
    this.target.copy(this.camera.position).add(ahead);
    this.camera.lookAt(this.target);
    this.changed();
  }
}
