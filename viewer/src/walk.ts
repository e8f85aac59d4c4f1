// Walking: drag to look around, W A S D or the arrows to go, Q and E down and up. The eye stays where it is put.

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

  constructor(
    private readonly camera: PerspectiveCamera,
    private readonly target: Vector3,
    private readonly diagonal: number,
    canvas: HTMLElement,
    private readonly changed: () => void,
  ) {
    canvas.addEventListener('pointermove', (event) => {
      if (this.enabled && event.buttons & 1) this.turn(event.movementX, event.movementY);
    });
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
    return this.enabled && this.held.size > 0;
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
    step.setLength(step.length() > 0 ? SPEED * this.diagonal * Math.min(seconds, 0.1) : 0);
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
