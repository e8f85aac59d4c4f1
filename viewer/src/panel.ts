// The controls beside the picture: what they say is put into the settings, and what they show comes from there.

import { DEGREES, DISCRETISATIONS, METHODS } from './methods';
import { swatch, type Material } from './materials';
import type { Degree, Discretisation, Scene, Solver } from './protocol';
import { QUANTITIES } from './quantities';
import { text } from './scale';
import { offered, type Settings } from './settings';

export function element<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no #${id}`);
  return found as T;
}

/** What the controls ask for. */
export interface Wishes {
  /** Another method, or a race: all begins anew. */
  solvers(): void;
  /** Something is shown differently. */
  look(): void;
  lamps(): void;
  materials(): void;
  speed(passes: number): void;
  home(): void;
}

export class Panel {
  private readonly sliders: { lamps: HTMLInputElement[]; materials: HTMLInputElement[] } = { lamps: [], materials: [] };

  constructor(
    private readonly scene: Scene,
    private readonly materials: Material[],
    readonly settings: Settings,
    private readonly first: Settings,
    private readonly wishes: Wishes,
  ) {
    this.options();
    this.bind();
    this.relight();
    this.show();
  }

  private options(): void {
    const { scene } = this;
    const fill = (id: string, entries: [string, string, string][]): void => {
      element<HTMLSelectElement>(id).replaceChildren(
        ...entries.map(([value, name, tip]) => Object.assign(new Option(name, value), { title: tip })),
      );
    };
    const solvers = scene.solvers.map((solver): [string, string, string] => [solver, METHODS[solver].name, METHODS[solver].tip]);
    fill('method-of', Object.entries(DISCRETISATIONS).map(([value, { name, tip }]) => [value, name, tip]));
    fill('space', Object.entries(DEGREES).map(([value, { name, tip }]) => [value, name, tip]));
    fill('solver', solvers);
    fill('rival', [['', 'nobody', 'One solver alone'], ...solvers]);
    fill('display', offered(scene).map((display) =>
      display === 'light' ? [display, 'light, as the eye sees it', ''] : [display, QUANTITIES[display].name, QUANTITIES[display].hint],
    ));
    element<HTMLSelectElement>('rival').disabled = scene.solvers.length < 2;
  }

  private bind(): void {
    const { settings, wishes } = this;
    const on = <T extends HTMLElement>(id: string, event: string, act: (target: T) => void): void =>
      element<T>(id).addEventListener(event, () => act(element<T>(id)));
    on<HTMLSelectElement>('method-of', 'change', ({ value }) => {
      settings.method = value as Discretisation;
      wishes.solvers();
    });
    on<HTMLSelectElement>('space', 'change', ({ value }) => {
      settings.space = value as Degree;
      wishes.solvers();
    });
    on<HTMLSelectElement>('solver', 'change', ({ value }) => {
      settings.solver = value as Solver;
      if (settings.rival === settings.solver) settings.rival = undefined;
      wishes.solvers();
    });
    on<HTMLSelectElement>('rival', 'change', ({ value }) => {
      settings.rival = value && value !== settings.solver ? (value as Solver) : undefined;
      wishes.solvers();
    });
    on<HTMLSelectElement>('display', 'change', ({ value }) => {
      settings.display = value as Settings['display'];
      wishes.look();
    });
    for (const id of ['smooth', 'mesh', 'contours', 'walk'] as const) {
      on<HTMLInputElement>(id, 'change', ({ checked }) => {
        settings[id] = checked;
        wishes.look();
      });
    }
    on<HTMLInputElement>('exposure', 'input', ({ value }) => {
      settings.exposure = Number(value);
      wishes.look();
    });
    on<HTMLSelectElement>('tone', 'change', ({ value }) => {
      settings.tone = value as Settings['tone'];
      wishes.look();
    });
    on<HTMLSelectElement>('theme', 'change', ({ value }) => {
      settings.theme = value as Settings['theme'];
      wishes.look();
    });
    on<HTMLInputElement>('speed', 'input', ({ value }) => wishes.speed(10 ** Number(value)));
    on('home', 'click', () => wishes.home());
    on('as-file', 'click', () => {
      settings.lamps = [...this.first.lamps];
      settings.materials = [...this.first.materials];
      this.show();
      wishes.materials();
    });
  }

  private relight(): void {
    const { scene, materials, settings, wishes } = this;
    const slider = (most: number, name: string, colour: number[], set: (value: number) => void, done: () => void): HTMLLabelElement => {
      const label = document.createElement('label');
      label.className = 'wide';
      label.innerHTML = '<span class="name"><span class="swatch"></span></span><output></output><input type="range" min="0" step="0.01">';
      label.querySelector('.name')!.append(name);
      label.title = name;
      label.querySelector<HTMLElement>('.swatch')!.style.background = swatch(colour);
      const input = label.querySelector('input')!;
      input.max = String(most);
      input.addEventListener('input', () => {
        set(Number(input.value));
        this.show();
        if (scene.stored) done();
      });
      // Without a stored matrix lamps and materials need a new start, which is not for every touch.
      input.addEventListener('change', () => scene.stored || done());
      return label;
    };
    const lampColour = (k: number): number[] => {
      const emission = scene.surfaces[scene.lamps[k]!.surfaces[0] ?? -1]?.emission ?? [1, 1, 1];
      const most = Math.max(...emission) || 1;
      return emission.map((e) => e / most);
    };
    const lamps = scene.lamps.map(({ name }, k) =>
      slider(2, name, lampColour(k), (value) => (settings.lamps[k] = value), () => wishes.lamps()));
    const rho = materials.map((material, k) =>
      slider(Math.max(0.95, material.strongest), material.name, material.colour, (value) => (settings.materials[k] = value), () => wishes.materials()));
    element('lamps').replaceChildren(...lamps);
    element('materials').replaceChildren(...rho);
    this.sliders.lamps = lamps.map((label) => label.querySelector('input')!);
    this.sliders.materials = rho.map((label) => label.querySelector('input')!);
  }

  /** Shows the settings. */
  show(): void {
    const { settings } = this;
    const set = (id: string, value: string): void => {
      element<HTMLInputElement | HTMLSelectElement>(id).value = value;
    };
    set('method-of', settings.method);
    set('space', settings.space);
    set('solver', settings.solver);
    set('rival', settings.rival ?? '');
    set('display', settings.display);
    set('tone', settings.tone);
    set('theme', settings.theme);
    set('exposure', String(settings.exposure));
    for (const id of ['smooth', 'mesh', 'contours', 'walk'] as const) element<HTMLInputElement>(id).checked = settings[id];
    element('exposure-said').textContent = `${settings.exposure >= 0 ? '+' : '−'}${Math.abs(settings.exposure).toFixed(1)} EV`;
    element('exposure-said').title = 'Stops: each doubles the brightness';
    element('relight-hint').textContent = this.scene.stored
      ? 'The solution is linear in the lamps: one solution is kept for each, and dimming adds them up at once.'
      : 'So many form factors are not stored: lamps and materials take effect with a new start.';
    element('method-hint').textContent = DISCRETISATIONS[settings.method].tip;
    element('race-hint').hidden = settings.rival === undefined;
    element('display-hint').textContent = settings.display === 'light'
      ? 'Radiance u/π, exposed and tone-mapped for the screen.' : QUANTITIES[settings.display].hint;
    document.body.classList.toggle('lit', settings.display === 'light');
    document.documentElement.dataset['theme'] = settings.theme;
    for (const option of element<HTMLSelectElement>('rival').options) option.disabled = option.value === settings.solver;
    const said = (input: HTMLInputElement, value: number, words: string): void => {
      input.value = String(value);
      input.parentElement!.querySelector('output')!.textContent = words;
    };
    this.sliders.lamps.forEach((input, k) => said(input, settings.lamps[k]!, `× ${settings.lamps[k]!.toFixed(2)}`));
    this.sliders.materials.forEach((input, k) => said(input, settings.materials[k]!, settings.materials[k]!.toFixed(2)));
  }

  /** Shows a speed, in passes a second, as the method counts. */
  showSpeed(passes: number, unknowns: number): void {
    const method = METHODS[this.settings.solver];
    element<HTMLInputElement>('speed').value = String(Math.log10(passes));
    const { rival } = this.settings;
    const shoots = method.shoots && (rival === undefined || METHODS[rival].shoots);
    const [rate, unit] = shoots ? [passes * unknowns, 'shots'] : [passes, rival ? 'passes' : `${method.step}s`];
    element('speed-said').textContent = `${text(rate, 2)} ${unit}/s`;
  }
}
