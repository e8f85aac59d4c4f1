// What runs in the browser: baked files, opened by three.js' own loaders and drawn by its renderer, as somebody else's page does.

import {
  Color, DataTexture, DataUtils, LinearFilter, LinearToneMapping, Mesh, MeshStandardMaterial, NoToneMapping, OrthographicCamera, PerspectiveCamera, Scene, Vector3, WebGLRenderer,
  type Camera, type Object3D,
} from 'three';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

const bytes = (base64: string): ArrayBuffer => Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0)).buffer;

const SIZE = 256;
const renderer = new WebGLRenderer({ canvas: document.body.appendChild(document.createElement('canvas')), preserveDrawingBuffer: true });
renderer.setSize(SIZE, SIZE);

async function load(base64: string): Promise<{ scene: Object3D; cameras: Camera[]; extras: Record<string, unknown> }> {
  const { scene, cameras, asset } = await new GLTFLoader().parseAsync(bytes(base64), '');
  return { scene, cameras, extras: asset.extras as Record<string, unknown> };
}

/** The means of red, green and blue of what is drawn, linear, over the exposure. */
function drawn(scene: Object3D, camera: Camera, exposure: number): number[] {
  const space = new Scene();
  space.background = new Color(0);
  space.add(scene);
  renderer.toneMapping = exposure === 1 ? NoToneMapping : LinearToneMapping;
  renderer.toneMappingExposure = exposure;
  renderer.render(space, camera);
  const pixels = new Uint8Array(4 * SIZE * SIZE);
  const gl = renderer.getContext();
  gl.readPixels(0, 0, SIZE, SIZE, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  const linear = (byte: number): number => (byte <= 10.3 ? byte / 255 / 12.92 : ((byte / 255 + 0.055) / 1.055) ** 2.4);
  const sums = [0, 0, 0];
  for (let at = 0; at < pixels.length; at += 4) for (let c = 0; c < 3; c++) sums[c]! += linear(pixels[at + c]!);
  return sums.map((sum) => sum / (SIZE * SIZE) / exposure);
}

/** What the file's own camera sees. */
async function seen(base64: string, exposure: number): Promise<number[]> {
  const { scene, cameras } = await load(base64);
  const camera = cameras[0] as PerspectiveCamera;
  camera.aspect = 1;
  camera.updateProjectionMatrix();
  scene.updateMatrixWorld(true);
  return drawn(scene, camera, exposure);
}

/** One planar surface alone, seen from straight before it, so that it fills the picture; with what its material says. */
async function facing(base64: string, name: string, exposure: number, exr?: string): Promise<{ mean: number[]; extras: Record<string, number> }> {
  const { scene } = await load(base64);
  scene.updateMatrixWorld(true);
  const mesh = scene.getObjectByName(name) as Mesh;
  scene.traverse((other) => other instanceof Mesh && (other.visible = other === mesh));
  const world = (attribute: string, k: number): Vector3 => {
    const vector = new Vector3().fromBufferAttribute(mesh.geometry.getAttribute(attribute) as never, k);
    return attribute === 'position' ? vector.applyMatrix4(mesh.matrixWorld) : vector.transformDirection(mesh.matrixWorld);
  };
  const normal = world('normal', 0);
  const camera = new OrthographicCamera(-1, 1, 1, -1, 0.01, 100);
  camera.up.set(0, Math.abs(normal.y) > 0.9 ? 0 : 1, Math.abs(normal.y) > 0.9 ? 1 : 0);
  camera.position.copy(world('position', 0)).add(normal);
  camera.lookAt(world('position', 0));
  camera.updateMatrixWorld(true);
  const corners = Array.from({ length: mesh.geometry.getAttribute('position').count }, (_, k) => camera.worldToLocal(world('position', k)));
  const across = corners.map(({ x }) => x);
  const down = corners.map(({ y }) => y);
  Object.assign(camera, { left: Math.min(...across), right: Math.max(...across), bottom: Math.min(...down), top: Math.max(...down) });
  camera.updateProjectionMatrix();
  const material = mesh.material as { userData: Record<string, number> };
  // White paint under the lightmap: H/π.
  if (exr) mesh.material = new MeshStandardMaterial({ color: 0xffffff, roughness: 1, lightMap: irradianceMap(exr) });
  return { mean: drawn(scene, camera, exposure), extras: material.userData };
}

/** An irradiance map as three.js wants it: looked up where the texture is, with rows from below. */
function irradianceMap(base64: string): DataTexture {
  const { data, width, height, format, type } = new EXRLoader().parse(bytes(base64)) as unknown as {
    data: Float32Array; width: number; height: number; format: DataTexture['format']; type: DataTexture['type'];
  };
  const map = new DataTexture(data as never, width, height, format, type);
  map.magFilter = map.minFilter = LinearFilter;
  map.repeat.set(1, -1);
  map.offset.set(0, 1);
  map.channel = 0;
  map.needsUpdate = true;
  return map;
}

/** The texels of an OpenEXR, rows from above. */
function lightmap(base64: string): { width: number; height: number; rgb: number[]; comments: string } {
  const { width, height, data, header } = new EXRLoader().parse(bytes(base64)) as unknown as {
    width: number; height: number; data: Uint16Array | Float32Array; header: Record<string, unknown>;
  };
  const number = (k: number): number => (data instanceof Uint16Array ? DataUtils.fromHalfFloat(data[k]!) : data[k]!);
  const rgb: number[] = [];
  for (let y = height - 1; y >= 0; y--) {
    for (let x = 0; x < width; x++) for (let c = 0; c < 3; c++) rgb.push(number((y * width + x) * (data.length / width / height) + c));
  }
  return { width, height, rgb, comments: String(header['comments']) };
}

Object.assign(window, { extrasOf: async (base64: string) => (await load(base64)).extras, seen, facing, lightmap });
