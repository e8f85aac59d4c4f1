// Files of what is shown: the picture from this page, all else from the server, by the writers of `fredholm radiosity`.

import { drawLegend, LEGEND_WIDTH, type Marked } from './legend';
import { element } from './panel';
import type { Format, Shown } from './protocol';
import type { Source } from './source';
import type { View } from './view';

export function save(name: string, blob: Blob): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** What is shown at the moment: light that the server does not have, and the scale of false colours. */
export interface Sighted {
  shown(): Shown | undefined;
  marked(): Marked | undefined;
}

export function offerFiles(source: Source, view: View, sighted: Sighted, notice: (message: string) => void): void {
  const button = (name: string, tip: string, act: () => void): HTMLButtonElement => {
    const made = Object.assign(document.createElement('button'), { textContent: name, title: tip });
    made.addEventListener('click', act);
    return made;
  };
  const buttons = [
    button('picture', 'What is shown now, with its scale, as PNG', () => {
      picture(view, sighted.marked()).then((blob) => save(`${source.scene.name}.png`, blob), (error: unknown) => notice(String(error)));
    }),
  ];
  if (source.live) {
    const ask = (format: Format, from = false): void => {
      const shown = sighted.shown();
      source.send({ type: 'export', format, ...(from ? { camera: view.eye } : {}), ...(shown ? { shown } : {}) });
    };
    const slow = (format: Format): void => {
      notice('The picture is being computed …');
      ask(format, true);
    };
    buttons.push(
      button('photograph', 'PNG with sharp shadows: direct light by formula, the rest gathered; takes some seconds', () => slow('png')),
      button('EXR', 'The same, linear, as OpenEXR: radiance in W/(m² sr) or cd/m²', () => slow('exr')),
      button('GLB', 'The patches as binary glTF, with radiance as colours of vertices: for three.js, Blender, engines', () => ask('glb', true)),
      button('CSV', 'Each patch with its place, ρ, emission, radiosity and irradiance', () => ask('csv')),
      button('NPZ', 'The same as NumPy arrays', () => ask('npz')),
      button('VTU', 'The same with the shapes of patches, for ParaView', () => ask('vtu')),
      button('JSON', 'Means over surfaces, residual and error bound', () => ask('json')),
    );
  }
  element('save').replaceChildren(...buttons);
  element('save-hint').textContent = source.live
    ? 'Files hold what is shown: the moment scrubbed to, or the light as relit; of a race that of the first solver.'
    : 'For tables, run fredholm radiosity --patches FILE.';
}

/** The picture as PNG, with the scale beside it. */
function picture(view: View, marked: Marked | undefined): Promise<Blob> {
  // What is drawn is there only until the browser shows it.
  view.render();
  const { width, height, clientHeight } = view.canvas;
  const ratio = height / clientHeight;
  const canvas = document.createElement('canvas');
  canvas.width = width + (marked ? LEGEND_WIDTH * ratio : 0);
  canvas.height = height;
  const pen = canvas.getContext('2d');
  if (!pen) return Promise.reject(new Error('this browser makes no PNG'));
  pen.drawImage(view.canvas, 0, 0);
  if (marked) {
    pen.scale(ratio, ratio);
    drawLegend(pen, { left: width / ratio, height: clientHeight }, marked);
  }
  return new Promise((resolve, reject) =>
    canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error('this browser makes no PNG'))), 'image/png'),
  );
}

/** Numbers in single precision, little-endian, in base64. */
export function base64(numbers: Float32Array): string {
  const bytes = new Uint8Array(numbers.buffer, numbers.byteOffset, numbers.byteLength);
  const parts: string[] = [];
  // A call takes so many arguments and not many more.
  for (let at = 0; at < bytes.length; at += 0x8000) parts.push(String.fromCharCode(...bytes.subarray(at, at + 0x8000)));
  return btoa(parts.join(''));
}
