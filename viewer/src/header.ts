// The equation that is being solved, in the paper's notation, with the term lit that is being computed.

import { equation, METHODS } from './methods';
import { element } from './panel';
import { State, type Frame, type Scene } from './protocol';
import type { Run } from './run';
import { text } from './scale';
import type { Settings } from './settings';

/** What is written into the page only if it differs, so that a pointer on a term keeps its tip. */
function set(id: string, html: string): void {
  if (element(id).innerHTML !== html) element(id).innerHTML = html;
}

export function showRelit(isWhole: boolean): void {
  set('formula', 'u = Σ<sub>k</sub> <span class="term lit" title="how bright lamp k is">g<sub>k</sub></span> u<sub>k</sub>');
  set('method', 'u<sub>k</sub> = f<sub>k</sub> + ρ <i>⊙</i> F u<sub>k</sub>');
  element('now').textContent = isWhole
    ? 'Relit: the solution, summed over its lamps. Restart to watch this light converge.'
    : 'The light of each lamp is being computed …';
}

export function showWaiting(settings: Settings, assembled: number): void {
  const names = [settings.solver, settings.rival].flatMap((solver) => (solver ? [METHODS[solver].name.split(':')[0]] : []));
  element('now').textContent =
    `${names.join(' and ')} begin${names.length > 1 ? '' : 's'} when all form factors are known: ${text(100 * assembled, 2)} % are.`;
}

export function showEquation(run: Run, frame: Frame, patchName: (i: number) => string): void {
  const method = METHODS[run.solvers[0]!];
  set('formula', equation(method, frame));
  set('method', method.formula(frame));
  element('now').textContent = run.solvers.length > 1
    ? `A race at equal work: ${text(frame.work)} n² form factors for each.`
    : method.now(frame, patchName) + ending(frame);
}

function ending(frame: Frame): string {
  switch (frame.state) {
    case State.Converged:
      return ' Converged.';
    case State.Diverged:
      return ' It diverges: light does not die out here.';
    case State.Stalled:
      return ' Rounding lets the residual fall no further.';
    default:
      return '';
  }
}

/** What the letters mean, behind a button. */
export function letters(scene: Scene): void {
  const { exitance } = scene.units;
  const meanings: [string, string][] = [
    ['u', `radiosity: what leaves a patch, emitted and reflected, in ${exitance}`],
    ['f', `what the lamps make leave a patch by themselves, in ${exitance}`],
    ['ρ', 'reflectance: the share of what is received that is sent back, by colour'],
    ['F', 'form factors: F_ij is the share of the view of patch i that patch j fills'],
    ['⊙', 'times, patch by patch and colour by colour'],
    ['r', 'residual f + ρ ⊙ F u − u: what is still to be passed on'],
    ['‖ ‖', 'the largest of all patches and colours'],
    ['A', 'the area of a patch, in m²'],
    ['n²', 'all form factors once: one sweep, or as many shots as there are patches'],
  ];
  element('letters').replaceChildren(
    ...meanings.flatMap(([letter, meaning]) => [
      Object.assign(document.createElement('dt'), { textContent: letter }),
      Object.assign(document.createElement('dd'), { textContent: meaning }),
    ]),
  );
  element('help').addEventListener('click', () => {
    const list = element('letters');
    list.hidden = !list.hidden;
    element('help').setAttribute('aria-expanded', String(!list.hidden));
  });
}

/** The names of two that race, each on its picture. */
export function showLanes(run: Run | undefined, canvas: HTMLCanvasElement): void {
  const { clientWidth: width, clientHeight: height } = canvas;
  const beside = width > height;
  const label = (lane: number): HTMLElement => {
    const { name } = METHODS[run!.solvers[lane]!];
    const made = document.createElement('span');
    made.textContent = `${width < 500 ? name.split(':')[0] : name}, ${text(run!.frame(lane)!.iteration, 9)}`;
    made.style.left = beside && lane === 1 ? `${width / 2 + 8}px` : '8px';
    made.style.bottom = beside || lane === 1 ? '10px' : `${height / 2 + 8}px`;
    return made;
  };
  element('lanes').replaceChildren(...(run ? [label(0), label(1)] : []));
}
