// Files of what is shown: the picture from this page, tables from the server, by the writers of `fredholm radiosity`.

import { element } from './panel';
import type { Source } from './source';
import type { View } from './view';

export function save(name: string, blob: Blob): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

export function offerFiles(source: Source, view: View, notice: (message: string) => void): void {
  const button = (name: string, tip: string, act: () => void): HTMLButtonElement => {
    const made = Object.assign(document.createElement('button'), { textContent: name, title: tip });
    made.addEventListener('click', act);
    return made;
  };
  const buttons = [
    button('picture', 'What is shown now, as PNG', () => {
      view.png().then((blob) => save(`${source.scene.name}.png`, blob), (error: unknown) => notice(String(error)));
    }),
  ];
  if (source.live) {
    const ask = (format: 'csv' | 'npz' | 'json' | 'png'): void =>
      source.send({ type: 'export', format, ...(format === 'png' ? { camera: view.eye } : {}) });
    buttons.push(
      button('photograph', 'PNG with sharp shadows: direct light by formula, the rest gathered; takes some seconds', () => {
        notice('The picture is being computed …');
        ask('png');
      }),
      button('CSV', 'Each patch with its place, ρ, emission, radiosity and irradiance', () => ask('csv')),
      button('NPZ', 'The same as NumPy arrays', () => ask('npz')),
      button('JSON', 'Means over surfaces, residual and error bound', () => ask('json')),
    );
  }
  element('save').replaceChildren(...buttons);
  element('save-hint').textContent = source.live
    ? 'Tables hold the newest state of the first solver, not the moment scrubbed to, nor what is relit.'
    : 'For tables, run fredholm radiosity --patches FILE.';
}
