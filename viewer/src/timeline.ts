// Below the picture: the numbers of the moment shown, the curves up to now, and where on them it is.

import { Curves } from './curves';
import { METHODS } from './methods';
import { element } from './panel';
import type { Scene } from './protocol';
import type { Run } from './run';
import { text } from './scale';

const TIP =
  'residual: the largest |r| of a patch. error at most: how far any patch is from the solution on this mesh. unshot: the power still to be passed on.';

/** The colours of curves, as the style sheet has them now. */
function inks(): { ink: string; faint: string; colours: [string, string] } {
  const probe = document.body.appendChild(document.createElement('span'));
  const [ink, faint, first, second] = ['--soft', '--line', '--lane-0', '--lane-1'].map((name) => {
    probe.style.color = `var(${name})`;
    return getComputedStyle(probe).color;
  }) as [string, string, string, string];
  probe.remove();
  return { ink, faint, colours: [first, second] };
}

export class Timeline {
  private readonly canvas = element<HTMLCanvasElement>('curves');
  private readonly curves = new Curves(this.canvas);
  private inks = inks();

  constructor(private readonly scene: Scene) {}

  /** Takes the colours of a new theme. */
  recolour(): void {
    this.inks = inks();
  }

  show(run: Run, relit: boolean, live: boolean): void {
    const scrub = element<HTMLInputElement>('scrub');
    scrub.max = String(run.length - 1);
    scrub.value = String(run.shown);
    element<HTMLButtonElement>('back').disabled = run.shown === 0;
    element<HTMLButtonElement>('step').disabled = run.isNewest && (!live || !run.goesOn);
    this.numbers(run, relit);
    this.curves.draw(
      run.solvers.map((solver, lane) => ({ name: METHODS[solver].name, points: run.histories[lane]!.points })),
      run.isNewest ? undefined : run.frame(0)?.work,
      { units: this.scene.units, ...this.inks },
    );
  }

  private numbers(run: Run, relit: boolean): void {
    const { exitance, power } = this.scene.units;
    const line = (lane: number): HTMLElement => {
      const frame = run.frame(lane)!;
      const made = document.createElement('span');
      made.className = run.solvers.length > 1 ? `lane-${lane}` : '';
      const bound = Number.isFinite(frame.bound) ? `${text(frame.bound)} ${exitance}` : 'none, as ‖ρF‖ ≥ 1';
      made.innerHTML = `${METHODS[run.solvers[lane]!].step} <b>${text(frame.iteration, 9)}</b> · residual <b>${text(frame.residual)} ${exitance}</b> · error at most <b>${bound}</b> · unshot <b>${text(frame.unshot)} ${power}</b>`;
      made.title = TIP;
      return made;
    };
    if (relit) {
      element('numbers').textContent = 'The curves are of the light as it was before lamps or materials were changed.';
    } else {
      element('numbers').replaceChildren(...run.solvers.map((_, lane) => line(lane)));
    }
  }

  /** Tells at which amount of work the curves are touched. */
  ontouch(run: () => Run | undefined, touched: (work: number) => void): void {
    const drag = (event: PointerEvent): void => {
      const now = run();
      if (!(event.buttons & 1) || !now) return;
      touched(this.curves.workAt(event.offsetX, now.histories.flatMap((history) => history.points)));
    };
    this.canvas.addEventListener('pointerdown', drag);
    this.canvas.addEventListener('pointermove', drag);
  }
}
