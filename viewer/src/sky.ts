// L(ω) = L_z f(χ) φ(Z) / (f(Z_s) φ(0)), the CIE's skies (ISO 15469), behind all surfaces; crates/radiosity/src/sky/model.rs has them too.

import { BufferAttribute, BufferGeometry, Mesh, ShaderMaterial, Vector3 } from 'three';
import type { V } from './patches';
import type { Sky } from './protocol';

const VERTEX = /* glsl */ `
varying vec3 vDirection;
void main() {
  // Through this point of the screen, seen from the eye and then in the scene.
  vec3 seen = vec3(position.x / projectionMatrix[0][0], position.y / projectionMatrix[1][1], -1.0);
  vDirection = transpose(mat3(viewMatrix)) * seen;
  // As far away as can be.
  gl_Position = vec4(position.xy, 1.0, 1.0);
}`;

const FRAGMENT = /* glsl */ `
uniform vec3 zenith;
uniform vec3 up;
uniform vec3 towardsSun;
uniform bool overcast;
uniform float numbers[5];
uniform float exposure;
varying vec3 vDirection;

float gradation(float height) {
  return 1.0 + numbers[0] * exp(numbers[1] / max(height, 1e-4));
}

float indicatrix(float cosine) {
  float chi = acos(clamp(cosine, -1.0, 1.0));
  return 1.0 + numbers[2] * (exp(numbers[3] * chi) - exp(numbers[3] * 1.5707963267948966)) + numbers[4] * cosine * cosine;
}

void main() {
  vec3 direction = normalize(vDirection);
  float height = dot(direction, up);
  // Nothing is below the horizon; half a pixel above and below it is its edge.
  float above = clamp(height / max(fwidth(height), 1e-9) + 0.5, 0.0, 1.0);
  if (above == 0.0) discard;
  height = max(height, 0.0);
  float part = overcast
    ? (1.0 + 2.0 * height) / 3.0
    : indicatrix(dot(direction, towardsSun)) * gradation(height) / (indicatrix(dot(up, towardsSun)) * gradation(1.0));
  vec3 colour = max(zenith * part, 0.0) * exposure;
  #ifdef TONE_MAPPING
    colour = toneMapping(colour);
  #endif
  gl_FragColor = linearToOutputTexel(vec4(colour, above));
}`;

/** What is seen where there is no surface. */
export class Backdrop extends Mesh<BufferGeometry, ShaderMaterial> {
  constructor(sky: Sky) {
    // One triangle that the screen is a part of.
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
    const material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      transparent: true,
      depthWrite: false,
      uniforms: {
        zenith: { value: new Vector3(...(sky.zenith as V)) },
        up: { value: new Vector3(...(sky.up as V)) },
        towardsSun: { value: new Vector3(...(sky.towards_sun as V)) },
        overcast: { value: sky.overcast },
        numbers: { value: sky.numbers },
        exposure: { value: 1 },
      },
    });
    super(geometry, material);
    this.frustumCulled = false;
    this.visible = false;
  }

  /** Shows it; `exposure` is from radiance to a screen on which 1 is white. */
  show(exposure: number): void {
    this.visible = true;
    this.material.uniforms.exposure!.value = exposure;
  }
}
