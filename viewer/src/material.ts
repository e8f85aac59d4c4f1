// How a patch is drawn: its light, tone-mapped, or a number of it in colours with contour lines; its edges; one marked.

import { DataTexture, FrontSide, LinearFilter, ShaderMaterial, SRGBColorSpace } from 'three';
import { table, type Palette } from './palette';
import type { Scale } from './scale';

const VERTEX = /* glsl */ `
attribute vec3 light;
attribute float number;
attribute float edge;
varying vec3 vLight;
varying float vNumber;
varying float vEdge;
void main() {
  vLight = light;
  vNumber = number;
  vEdge = edge;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  #ifdef EDGES
    // Triangles have a back that is not drawn; lines have none, and are put behind the eye.
    if (dot(cameraPosition - position, normal) <= 0.0) gl_Position = vec4(0.0, 0.0, -2.0, 1.0);
    // They are to be seen through cracks only.
    gl_Position.z += 2e-4 * gl_Position.w;
  #endif
}`;

const FRAGMENT = /* glsl */ `
uniform bool lit;
uniform float exposure;
uniform sampler2D colours;
uniform float low;
uniform float high;
uniform bool logarithmic;
uniform float interval;
uniform bool contours;
uniform float mesh;
varying vec3 vLight;
varying float vNumber;
varying float vEdge;

float onScale(float x) {
  return logarithmic ? (log(max(x, 1e-30)) - log(low)) / (log(high) - log(low)) : (x - low) / (high - low);
}

void main() {
  vec3 colour;
  if (lit) {
    colour = max(vLight, 0.0) * exposure;
    #ifdef TONE_MAPPING
      colour = toneMapping(colour);
    #endif
  } else {
    float at = onScale(vNumber);
    bool known = vNumber > -1e29;
    colour = texture2D(colours, vec2(clamp(at, 0.0, 1.0) * 255.0 / 256.0 + 0.5 / 256.0, 0.5)).rgb;
    if (!known) colour = vec3(0.2);
    if (contours && known) {
      float line = at / interval;
      float width = fwidth(line);
      float distance = abs(fract(line - 0.5) - 0.5);
      float inside = step(0.02, at) * step(at, 0.98) * (1.0 - smoothstep(0.2, 0.6, width));
      colour *= 1.0 - 0.75 * inside * (1.0 - smoothstep(0.6 * width, 1.4 * width, distance));
    }
  }
  float grid = 1.0 - smoothstep(0.2, 0.9, vEdge / max(fwidth(vEdge), 1e-6));
  float brightness = dot(colour, vec3(0.2126, 0.7152, 0.0722));
  // Dark lines, but where it is too dark to see them.
  colour = mix(colour, vec3(lit && brightness < 0.02 ? 0.2 : 0.0), mesh * grid);
  gl_FragColor = linearToOutputTexel(vec4(colour, 1.0));
}`;

const tables = new Map<Palette, DataTexture>();

function texture(palette: Palette): DataTexture {
  const known = tables.get(palette);
  if (known) return known;
  const made = new DataTexture(table(palette), 256, 1);
  made.colorSpace = SRGBColorSpace;
  made.minFilter = made.magFilter = LinearFilter;
  made.needsUpdate = true;
  tables.set(palette, made);
  return made;
}

export class PatchMaterial extends ShaderMaterial {
  constructor() {
    super({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      side: FrontSide,
      uniforms: {
        lit: { value: true },
        exposure: { value: 1 },
        colours: { value: texture('viridis') },
        low: { value: 0 },
        high: { value: 1 },
        logarithmic: { value: false },
        interval: { value: 1 },
        contours: { value: false },
        mesh: { value: 0 },
      },
    });
  }

  /** The same for the edges of patches, whatever is shown. */
  forEdges(): ShaderMaterial {
    const { uniforms } = this;
    return Object.assign(new ShaderMaterial({ vertexShader: VERTEX, fragmentShader: FRAGMENT, defines: { EDGES: '' } }), { uniforms });
  }

  /** Shows light; `exposure` is from exitance to a screen on which 1 is white. */
  showLight(exposure: number): void {
    this.uniforms.lit!.value = true;
    this.uniforms.exposure!.value = exposure;
  }

  /** Shows numbers on a scale. */
  showNumbers(scale: Scale, contours: boolean): void {
    const { uniforms } = this;
    uniforms.lit!.value = false;
    uniforms.colours!.value = texture(scale.palette);
    uniforms.low!.value = scale.low;
    uniforms.high!.value = scale.high;
    uniforms.logarithmic!.value = scale.logarithmic;
    uniforms.contours!.value = contours;
    uniforms.interval!.value = 1 / (scale.ticks.length - 1);
  }

  showMesh(shown: boolean): void {
    this.uniforms.mesh!.value = shown ? 0.55 : 0;
  }
}
