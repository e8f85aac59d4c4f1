// What is drawn between the middles of patches.

import { expect, test } from '@playwright/test';
import { Patches } from '../src/patches';
import type { Scene } from '../src/protocol';

/** A unit square in n × n patches. */
function square(n: number): Patches {
  const corners = new Float32Array(12 * n * n);
  for (let i = 0; i < n * n; i++) {
    const [x, y] = [i % n, Math.floor(i / n)];
    const corner = (dx: number, dy: number): number[] => [(x + dx) / n, (y + dy) / n, 0];
    corners.set([...corner(0, 0), ...corner(1, 0), ...corner(1, 1), ...corner(0, 1)], 12 * i);
  }
  return new Patches({ patches: n * n, surfaces: [{ patches: [0, n * n] }] } as never as Scene, corners);
}

test('light that grows evenly is drawn so up to the rim, and what is the same everywhere stays so', () => {
  const patches = square(4);
  for (const light of [(y: number) => 1 + y, () => 3]) {
    const values = Float32Array.from({ length: patches.count }, (_, i) => light(patches.centres[3 * i + 1]!));
    const out = new Float32Array(patches.vertices);
    patches.spread(values, 1, true, out);
    const { position } = patches.build();
    for (let vertex = 0; vertex < patches.vertices; vertex++) {
      expect(out[vertex], `at ${position.slice(3 * vertex, 3 * vertex + 2)}`).toBeCloseTo(light(position[3 * vertex + 1]!), 5);
    }
  }
});

test('what goes on at the rim is never below nothing', () => {
  const patches = square(3);
  const values = new Float32Array(9);
  values[4] = 1;
  const out = new Float32Array(patches.vertices);
  patches.spread(values, 1, true, out);
  expect(Math.min(...out)).toBe(0);
});
