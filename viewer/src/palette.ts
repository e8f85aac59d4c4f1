// Colours for numbers: viridis, whose lightness rises evenly, and for differences blue to red through white.

type Colour = [number, number, number];

/** Viridis as a polynomial through the table of Smith and van der Walt, as crates/radiosity/src/render/palette.rs has it. */
const VIRIDIS: Colour[] = [
  [0.2777273, 0.0054073, 0.3340998],
  [0.105093, 1.4046135, 1.3845902],
  [-0.3308618, 0.2148476, 0.0950952],
  [-4.6342305, -5.799101, -19.332441],
  [6.2282699, 14.1799334, 56.6905526],
  [4.7763854, -13.7451454, -65.3530326],
  [-5.4354559, 4.6458526, 26.3124352],
];

/** Brewer's RdBu, from blue to red, which also the colour-blind tell apart. */
const DIVERGING: Colour[] = [
  [5, 48, 97], [33, 102, 172], [67, 147, 195], [146, 197, 222], [209, 229, 240], [247, 247, 247],
  [253, 219, 199], [244, 165, 130], [214, 96, 77], [178, 24, 43], [103, 0, 31],
];

export type Palette = 'viridis' | 'diverging';

/** The colour at t in [0, 1], in sRGB, 0 to 255. */
export function colour(palette: Palette, t: number): Colour {
  const at = Math.min(1, Math.max(0, t));
  if (palette === 'viridis') {
    return [0, 1, 2].map((c) => Math.round(255 * VIRIDIS.reduceRight((sum, k) => sum * at + k[c]!, 0))) as Colour;
  }
  const place = at * (DIVERGING.length - 1);
  const k = Math.min(DIVERGING.length - 2, Math.floor(place));
  return [0, 1, 2].map((c) => Math.round(DIVERGING[k]![c]! + (place - k) * (DIVERGING[k + 1]![c]! - DIVERGING[k]![c]!))) as Colour;
}

/** 256 colours, red, green, blue and 255 each. */
export function table(palette: Palette): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(1024);
  for (let k = 0; k < 256; k++) bytes.set([...colour(palette, k / 255), 255], 4 * k);
  return bytes;
}

/** The same for a style sheet. */
export function gradient(palette: Palette): string {
  const stops = Array.from({ length: 17 }, (_, k) => `rgb(${colour(palette, k / 16).join(' ')})`);
  return `linear-gradient(to top, ${stops.join(', ')})`;
}
