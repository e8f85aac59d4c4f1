// The page: hears of frames, shows the moment that is looked at, and says what the user asks for.

import { Curves } from './curves';
import { equation, METHODS } from './methods';
import { materials, reflectances, type Material } from './materials';
import { element, Panel } from './panel';
import { Patches } from './patches';
import { gradient } from './palette';
import { NONE, State, type Frame, type Message, type Scene } from './protocol';
import { QUANTITIES, UNKNOWN, type Sight } from './quantities';
import { Relit } from './relit';
import { Run } from './run';
import { mark, position, text, type Scale } from './scale';
import { DISPLAYS, initial, read, write, type Settings } from './settings';
import { open, type Source } from './source';
import { View } from './view';

/** Passes a second at first: shots that can be followed, and sweeps that can be seen. */
const SHOTS_A_SECOND = 100;
const SWEEPS_A_SECOND = 1;
const RACE = 0.1;

/** The tone mappings take some off below and bend above, so that the exposure for a line with a shoulder leaves them dark. */
const BRIGHTER = 1.7;

class Page {
  private readonly scene: Scene;
  private readonly patches: Patches;
  private readonly view: View;
  private readonly curves = new Curves(element<HTMLCanvasElement>('curves'));
  private readonly materials: Material[];
  private readonly first: Settings;
  private readonly settings: Settings;
  private readonly panel: Panel;
  private readonly relit: Relit;
  private run: Run | undefined;
  private playing = false;
  /** Until the solver that was asked for begins. */
  private waiting = false;
  /** The share of the form factors that are known. */
  private assembled = 0;
  private factors: Sight['factors'];
  private scale: Scale | undefined;
  private pending = false;
  private relightTimer = 0;
  private noticeTimer = 0;
  private inks = inks();
  private pointer: { clientX: number; clientY: number } | undefined;

  constructor(private readonly source: Source) {
    const scene = (this.scene = source.scene);
    this.materials = materials(scene);
    const strongest = (): number[] => this.materials.map((material) => material.strongest);
    this.first = initial(scene, strongest());
    this.settings = read(location.hash, scene, initial(scene, strongest()));
    this.patches = new Patches(scene, source.corners);
    this.view = new View(element<HTMLCanvasElement>('picture'), this.patches, scene.camera);
    this.relit = new Relit(scene.lamps.length, scene.patches);
    document.title = `${scene.name}: fredholm view`;
    element('title').textContent = `${scene.name}, ${text(scene.patches, 9)} patches up to ${text(scene.patch_size)} ${scene.units.length}`;
    document.body.classList.toggle('recorded', !source.live);
    this.panel = new Panel(scene, this.materials, this.settings, this.first, {
      solvers: () => this.start(),
      look: () => this.look(),
      lamps: () => this.relight(false),
      materials: () => this.relight(true),
      speed: (passes) => this.setSpeed(passes),
      home: () => this.home(),
    });
    this.letters();
    this.buttons();
    this.pointing();
    this.keys();
    this.view.onmove = () => {
      const { position, target } = this.view.eye;
      this.settings.camera = [...position, ...target];
      this.remember();
    };
    const { camera } = this.settings;
    if (camera) this.view.go({ ...scene.camera, position: camera.slice(0, 3), target: camera.slice(3) });
    source.listen((message) => this.hear(message), () => this.lost());
    if (source.live) this.start(!this.settings.paused);
    else if (!matchMedia('(prefers-reduced-motion: reduce)').matches) this.replay();
    if (this.settings.patch !== undefined) this.pick(this.settings.patch);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.look());
    addEventListener('resize', () => this.refresh());
    this.look();
    document.body.dataset['ready'] = 'true';
  }

  // ---- what is heard

  private hear(message: Message): void {
    switch (message.type) {
      case 'assembly':
        return this.showAssembly(message.done, message.of);
      case 'started':
        this.waiting = message.solvers[0] !== this.settings.solver || message.solvers[1] !== this.settings.rival;
        this.run = new Run(message.run, message.solvers, message.norm, message.target);
        this.scale = undefined;
        return this.refresh();
      case 'frame':
        this.run?.add(message.frame);
        if (!this.run?.goesOn) this.setPlaying(false, false);
        return this.refresh();
      case 'factors':
        if (message.patch !== this.settings.patch) return;
        this.factors = { row: message.row, column: message.column };
        return this.refresh();
      case 'lamp':
        if (this.relit.take(message)) this.refresh();
        return;
      case 'file':
        return save(message.name, new Blob([message.content]));
      case 'error':
        return this.notice(message.message);
    }
  }

  private lost(): void {
    this.setPlaying(false, false);
    this.notice('The server has ended. What was shown can still be looked at; start fredholm view again to go on.', true);
  }

  private showAssembly(done: number, of: number): void {
    this.assembled = done / of;
    if (this.waiting) this.refresh();
    const bar = element<HTMLProgressElement>('assembly');
    bar.hidden = done >= of;
    bar.value = done / of;
    const said = element('assembly-said');
    said.hidden = done >= of;
    said.textContent = `${text((100 * done) / of, 2)} % of ${text(of)} form factors. Shooting needs none stored and goes on meanwhile; gathering waits.`;
  }

  // ---- what is asked for

  private get reflectance(): number[][] {
    return reflectances(this.scene, this.materials, this.settings.materials);
  }

  private start(play = this.playing || !this.run?.goesOn): void {
    const { solver, rival, lamps } = this.settings;
    this.relit.active = false;
    this.waiting = true;
    document.body.dataset['state'] = 'Asked';
    this.source.send({ type: 'start', solvers: rival ? [solver, rival] : [solver], lamps, reflectance: this.reflectance });
    this.setPlaying(play);
    this.look();
  }

  private get passes(): number {
    const { solver, rival, speed } = this.settings;
    if (speed !== undefined) return speed;
    if (rival) return RACE;
    return METHODS[solver].shoots ? SHOTS_A_SECOND / this.scene.patches : SWEEPS_A_SECOND;
  }

  private setSpeed(passes: number): void {
    this.settings.speed = passes;
    this.panel.showSpeed(passes);
    if (this.playing) this.source.send({ type: 'play', passes });
    this.remember();
  }

  private setPlaying(playing: boolean, tell = true): void {
    this.playing = playing;
    element('play').setAttribute('aria-pressed', String(playing));
    if (!tell) return;
    this.settings.paused = !playing;
    this.source.send(playing ? { type: 'play', passes: this.passes } : { type: 'pause' });
    this.remember();
  }

  private toggle(): void {
    if (this.relit.active || (this.source.live && this.run && !this.run.goesOn)) return this.start(true);
    if (!this.source.live) return this.replay();
    if (!this.playing) this.run?.show(Infinity);
    this.setPlaying(!this.playing);
    this.refresh();
  }

  /** Plays a recording: a frame every so often, from the first if it has ended. */
  private replay(): void {
    const { run } = this;
    if (!run) return;
    if (this.playing) return this.setPlaying(false, false);
    if (run.isNewest) run.show(0);
    this.setPlaying(true, false);
    const next = (): void => {
      if (!this.playing) return;
      run.show(run.shown + 1);
      if (run.isNewest) this.setPlaying(false, false);
      this.refresh();
      setTimeout(next, 120);
    };
    setTimeout(next, 120);
    this.refresh();
  }

  private move(by: number): void {
    const { run } = this;
    if (!run) return;
    if (this.playing) this.setPlaying(false, this.source.live);
    if (by > 0 && run.isNewest && this.source.live) {
      this.relit.active = false;
      this.source.send({ type: 'step' });
    } else {
      run.show(run.shown + by);
    }
    this.refresh();
  }

  private relight(fresh: boolean): void {
    this.remember();
    if (!this.scene.stored) return this.start();
    if (this.playing) this.setPlaying(false);
    this.relit.active = true;
    if (fresh || !this.relit.isAsked) this.askRelight();
    this.refresh();
  }

  /** Asks for the lamps' light, not more often than it can be answered. */
  private askRelight(): void {
    clearTimeout(this.relightTimer);
    this.relightTimer = window.setTimeout(() => {
      this.source.send({ type: 'relight', reflectance: this.reflectance, version: this.relit.ask() });
    }, this.relit.isAsked ? 60 : 0);
  }

  private pick(patch: number | undefined): void {
    this.settings.patch = patch;
    this.factors = undefined;
    if (patch !== undefined && this.source.live) this.source.send({ type: 'factors', patch });
    this.remember();
    this.refresh();
  }

  private home(): void {
    this.view.go();
    this.settings.camera = undefined;
    this.remember();
  }

  private remember(): void {
    const said = write(this.settings, this.first);
    const address = `${location.pathname}${location.search}${said ? `#${said}` : ''}`;
    try {
      history.replaceState(null, '', address);
    } catch {
      // A page from a file may not change its address in every browser; nothing else depends on it.
    }
  }

  // ---- what is shown

  /** After a change of how things are shown. */
  private look(): void {
    const { settings, view } = this;
    this.scale = undefined;
    view.setTone(settings.tone);
    view.setWalking(settings.walk);
    for (const picture of view.pictures) picture.material.showMesh(settings.mesh);
    if (settings.display === 'difference' && !settings.rival && this.scene.stored && !this.relit.isAsked) this.askRelight();
    this.panel.show();
    this.panel.showSpeed(this.passes);
    this.inks = inks();
    this.remember();
    this.refresh();
  }

  /** Asks for all to be shown anew, once before the next picture. */
  private refresh(): void {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      this.show();
    });
  }

  private show(): void {
    const { run, view } = this;
    if (!run || run.histories.some((history) => history.frames.length === 0)) return;
    document.body.classList.toggle('relit', this.relit.active);
    view.shown = this.relit.active ? 1 : run.histories.length;
    for (let lane = 0; lane < view.shown; lane++) this.showLane(lane);
    view.draw();
    this.showLegend();
    this.showEquation();
    this.showTimeline();
    this.showReadout();
  }

  private sight(lane: number): Sight | undefined {
    const { run, relit, settings } = this;
    const frame = run?.frame(lane);
    if (!run || !frame) return undefined;
    const emission = this.scene.surfaces.map((surface) => {
      const lamp = this.scene.lamps.indexOf(surface.name);
      return surface.emission.map((e) => e * (lamp < 0 ? 1 : settings.lamps[lamp]!));
    });
    const common = { factors: this.factors, reflectance: this.reflectance, emission, first: run.histories[0]!.points[0]?.residual ?? 0 };
    if (relit.active) {
      const radiosity = relit.combine(settings.lamps);
      return { ...common, radiosity, rest: undefined, bound: NaN, other: undefined, otherName: '' };
    }
    const rival = run.frame(1 - lane);
    const recorded = this.source.live ? undefined : run.histories[0]!.last?.radiosity;
    const solution = run.histories.length === 1 && relit.isWhole ? relit.combine(settings.lamps) : recorded;
    const otherName = rival
      ? `${METHODS[run.solvers[lane]!].name} minus ${METHODS[run.solvers[1 - lane]!].name}`
      : 'this moment minus the solution';
    return { ...common, radiosity: frame.radiosity, rest: frame.rest, bound: frame.bound, other: rival?.radiosity ?? solution, otherName };
  }

  private showLane(lane: number): void {
    const sight = this.sight(lane);
    if (!sight) return;
    const { settings, patches, scene } = this;
    const picture = this.view.pictures[lane]!;
    picture.mark('picked', settings.patch);
    const frame = this.run!.frame(lane)!;
    picture.mark('shot', frame.shot === NONE || this.relit.active ? undefined : frame.shot);
    if (settings.display === 'light') {
      this.scale = undefined;
      picture.material.showLight(((BRIGHTER * scene.exposure) / Math.PI) * 2 ** settings.exposure);
      picture.set('light', sight.radiosity, settings.smooth);
      return;
    }
    const quantity = QUANTITIES[settings.display];
    const values = quantity.values(sight, patches, scene);
    if (lane === 0) this.scale = quantity.scale(values, patches, sight);
    picture.material.showNumbers(this.scale!, settings.contours && quantity.contours);
    picture.set('number', values, settings.smooth && settings.display !== 'received' && settings.display !== 'sent');
  }

  private showLegend(): void {
    const { display } = this.settings;
    const legend = element('legend');
    const sight = this.sight(0);
    legend.hidden = display === 'light' || !this.scale || !sight;
    if (display === 'light' || !this.scale || !sight) return;
    const quantity = QUANTITIES[display];
    const lacks = quantity.lacks?.(sight);
    legend.querySelector('figcaption')!.textContent = lacks ?? `${quantity.title(this.scene, sight)}, ${quantity.unit(this.scene)}`;
    const { scale } = this;
    legend.querySelector<HTMLElement>('.bar')!.style.background = gradient(scale.palette);
    legend.querySelector('.ticks')!.replaceChildren(
      ...scale.ticks.map((tick, k) => {
        const label = document.createElement('span');
        label.style.bottom = `${100 * position(scale, tick)}%`;
        label.textContent = `${scale.cut && k === scale.ticks.length - 1 ? '≥ ' : ''}${mark(scale, tick)}`;
        return label;
      }),
    );
  }

  private patchName(i: number): string {
    return `patch ${text(i, 9)} (${this.scene.surfaces[this.patches.surface[i]!]?.name ?? ''})`;
  }

  private showEquation(): void {
    const { run, relit, settings } = this;
    const frame = run?.frame(0);
    if (!run || !frame) return;
    const method = METHODS[run.solvers[0]!];
    const set = (id: string, html: string): void => {
      if (element(id).innerHTML !== html) element(id).innerHTML = html;
    };
    if (relit.active) {
      set('formula', 'u = Σ<sub>k</sub> <span class="term lit" title="how bright lamp k is">g<sub>k</sub></span> u<sub>k</sub>');
      set('method', 'u<sub>k</sub> = f<sub>k</sub> + ρ <i>⊙</i> F u<sub>k</sub>');
      element('now').textContent = 'Relit: the solution, summed over its lamps. Restart to watch this light converge.';
      element('lanes').replaceChildren();
      return;
    }
    if (this.waiting && this.assembled < 1) {
      const names = [settings.solver, settings.rival].flatMap((solver) => (solver ? [METHODS[solver].name.split(':')[0]] : []));
      element('now').textContent =
        `${names.join(' and ')} begin${names.length > 1 ? '' : 's'} when all form factors are known: ${text(100 * this.assembled, 2)} % are.`;
      return;
    }
    set('formula', equation(method, frame));
    set('method', method.formula(frame));
    element('now').textContent = run.solvers.length > 1
      ? `A race at equal work: ${text(frame.work)} n² form factors for each.`
      : method.now(frame, (i) => this.patchName(i)) + ending(frame);
    this.showLanes(run);
  }

  /** The names of two that race, each on its picture. */
  private showLanes(run: Run): void {
    const { clientWidth: width, clientHeight: height } = this.view.canvas;
    const names = run.solvers.length < 2 ? [] : run.solvers.map((solver, lane) => {
      const label = document.createElement('span');
      const frame = run.frame(lane);
      label.textContent = `${METHODS[solver].name}${frame ? `, ${text(frame.iteration, 9)}` : ''}`;
      const beside = width > height;
      label.style.left = beside && lane === 1 ? `${width / 2 + 8}px` : '8px';
      label.style.bottom = beside || lane === 1 ? '10px' : `${height / 2 + 8}px`;
      return label;
    });
    element('lanes').replaceChildren(...names);
  }

  private showTimeline(): void {
    const { run, scene } = this;
    if (!run) return;
    const scrub = element<HTMLInputElement>('scrub');
    scrub.max = String(run.length - 1);
    scrub.value = String(run.shown);
    element<HTMLButtonElement>('back').disabled = run.shown === 0;
    element<HTMLButtonElement>('step').disabled = run.isNewest && (!this.source.live || !run.goesOn);
    const { exitance, power } = scene.units;
    element('numbers').replaceChildren(
      ...run.solvers.map((solver, lane) => {
        const frame = run.frame(lane)!;
        const line = document.createElement('span');
        line.className = run.solvers.length > 1 ? `lane-${lane}` : '';
        const bound = Number.isFinite(frame.bound) ? `${text(frame.bound)} ${exitance}` : 'none, as ‖ρF‖ ≥ 1';
        line.innerHTML = `${METHODS[solver].step} <b>${text(frame.iteration, 9)}</b> · residual <b>${text(frame.residual)} ${exitance}</b> · error at most <b>${bound}</b> · unshot <b>${text(frame.unshot)} ${power}</b>`;
        line.title = 'residual: the largest |r| of a patch. error at most: how far any patch is from the solution on this mesh. unshot: the power still to be passed on.';
        return line;
      }),
    );
    const { ink, faint, lanes } = this.inks;
    this.curves.draw(
      run.solvers.map((solver, lane) => ({ name: METHODS[solver].name, points: run.histories[lane]!.points })),
      run.isNewest ? undefined : run.frame(0)?.work,
      { units: scene.units, ink, faint, colours: lanes },
    );
    const frame = run.frame(0)!;
    if (this.waiting) return;
    Object.assign(document.body.dataset, { iteration: String(frame.iteration), residual: String(frame.residual), state: State[frame.state] });
  }

  private showReadout(): void {
    const readout = element('readout');
    const hit = this.pointer && this.view.pick(this.pointer);
    const sight = hit && this.sight(Math.min(hit.picture, this.view.shown - 1));
    readout.hidden = !hit || !sight;
    if (!hit || !sight || !this.pointer) return;
    readout.textContent = this.describe(hit.patch, sight);
    const box = this.view.canvas.getBoundingClientRect();
    const [x, y] = [this.pointer.clientX - box.left, this.pointer.clientY - box.top];
    readout.style.left = `${Math.max(4, Math.min(x + 14, box.width - readout.offsetWidth - 4))}px`;
    readout.style.top = `${y + readout.offsetHeight + 24 > box.height ? y - readout.offsetHeight - 10 : y + 16}px`;
  }

  private describe(i: number, sight: Sight): string {
    const { scene, patches } = this;
    const { exitance } = scene.units;
    const colour = [0, 1, 2].map((c) => sight.radiosity[3 * i + c]!);
    const rho = sight.reflectance[patches.surface[i]!]!;
    const same = (values: number[]): boolean => values.every((value) => value === values[0]);
    const list = (values: number[]): string => (same(values) ? text(values[0]!) : values.map((value) => text(value)).join(' · '));
    const lines = [this.patchName(i), `u ${list(colour)} ${exitance}`];
    if (scene.units.power === 'lm') lines.push(`luminance ${text(colour[0]! / Math.PI)} ${scene.units.radiance}`);
    const { display } = this.settings;
    if (display !== 'light' && display !== 'radiosity') {
      const quantity = QUANTITIES[display];
      const value = quantity.values(sight, patches, scene)[i]!;
      if (!quantity.lacks?.(sight)) {
        lines.push(`${quantity.title(scene, sight)} ${value < UNKNOWN / 2 ? 'not known' : `${text(value)} ${quantity.unit(scene)}`}`);
      }
    }
    if (sight.rest && display !== 'unshot') lines.push(`|r| ${text(sight.rest[i]!)} ${exitance}`);
    lines.push(`ρ ${list(rho)}, ${text(patches.areas[i]!)} ${scene.units.length}²`);
    return lines.join('\n');
  }

  private letters(): void {
    const { exitance } = this.scene.units;
    const letters: [string, string][] = [
      ['u', `radiosity: what leaves a patch, emitted and reflected, in ${exitance}`],
      ['f', `what the lamps make leave a patch by themselves, in ${exitance}`],
      ['ρ', 'reflectance: the share of what is received that is sent back, by colour'],
      ['F', 'form factors: F_ij is the share of the view of patch i that patch j fills'],
      ['⊙', 'times, patch by patch and colour by colour'],
      ['r', 'residual f + ρ ⊙ F u − u: what is still to be passed on'],
      ['n²', 'all form factors once: one sweep, or as many shots as there are patches'],
    ];
    element('letters').replaceChildren(
      ...letters.flatMap(([letter, meaning]) => [
        Object.assign(document.createElement('dt'), { textContent: letter }),
        Object.assign(document.createElement('dd'), { textContent: meaning }),
      ]),
    );
  }

  private notice(message: string, stays = false): void {
    const notice = element('notice');
    notice.textContent = message;
    notice.hidden = false;
    clearTimeout(this.noticeTimer);
    if (!stays) this.noticeTimer = window.setTimeout(() => (notice.hidden = true), 7000);
  }

  // ---- buttons, pointer and keys

  private buttons(): void {
    const click = (id: string, act: () => void): void => element(id).addEventListener('click', act);
    click('help', () => {
      const letters = element('letters');
      letters.hidden = !letters.hidden;
      element('help').setAttribute('aria-expanded', String(!letters.hidden));
    });
    click('restart', () => this.start(true));
    click('back', () => this.move(-1));
    click('play', () => this.toggle());
    click('step', () => this.move(1));
    element<HTMLInputElement>('scrub').addEventListener('input', (event) => this.scrub(Number((event.target as HTMLInputElement).value)));
    const curves = element<HTMLCanvasElement>('curves');
    const drag = (event: PointerEvent): void => {
      if (!(event.buttons & 1) || !this.run) return;
      const half = (curves.clientWidth - 12) / 2;
      const x = event.offsetX % (half + 12);
      const most = Math.max(...this.run.histories.flatMap((history) => history.points.map((point) => point.work)));
      this.relit.active = false;
      this.run.showWork((Math.max(0, x - 34) / (half - 40)) * most);
      if (this.playing && !this.run.isNewest) this.setPlaying(false, this.source.live);
      this.refresh();
    };
    curves.addEventListener('pointerdown', drag);
    curves.addEventListener('pointermove', drag);
    this.saving();
  }

  private scrub(moment: number): void {
    if (!this.run) return;
    if (this.playing) this.setPlaying(false, this.source.live);
    this.relit.active = false;
    this.run.show(moment);
    this.refresh();
  }

  private saving(): void {
    const button = (name: string, tip: string, act: () => void): HTMLButtonElement => {
      const made = Object.assign(document.createElement('button'), { textContent: name, title: tip });
      made.addEventListener('click', act);
      return made;
    };
    const buttons = [
      button('picture', 'What is shown now, as PNG', () => {
        this.view.png().then((blob) => save(`${this.scene.name}.png`, blob), (error: unknown) => this.notice(String(error)));
      }),
    ];
    if (this.source.live) {
      const ask = (format: 'csv' | 'npz' | 'json' | 'png'): void =>
        this.source.send({ type: 'export', format, ...(format === 'png' ? { camera: this.view.eye } : {}) });
      buttons.push(
        button('photograph', 'PNG with sharp shadows: direct light by formula, the rest gathered; takes some seconds', () => {
          this.notice('The picture is being computed …');
          ask('png');
        }),
        button('CSV', 'Each patch with its place, ρ, emission, radiosity and irradiance', () => ask('csv')),
        button('NPZ', 'The same as NumPy arrays', () => ask('npz')),
        button('JSON', 'Means over surfaces, residual and error bound', () => ask('json')),
      );
    }
    element('save').replaceChildren(...buttons);
    element('save-hint').textContent = this.source.live
      ? 'Tables hold the newest state of the first solver, not the moment scrubbed to, nor what is relit.'
      : 'For tables, run fredholm radiosity --patches FILE.';
  }

  private pointing(): void {
    const { canvas } = this.view;
    let down: { x: number; y: number } | undefined;
    canvas.addEventListener('pointerdown', (event) => (down = { x: event.clientX, y: event.clientY }));
    canvas.addEventListener('pointermove', (event) => {
      this.pointer = event.buttons ? undefined : event;
      this.showReadout();
    });
    canvas.addEventListener('pointerleave', () => {
      this.pointer = undefined;
      this.showReadout();
    });
    canvas.addEventListener('pointerup', (event) => {
      // A click, not the end of a turn.
      if (!down || Math.hypot(event.clientX - down.x, event.clientY - down.y) > 4) return;
      this.pointer = event;
      this.pick(this.view.pick(event)?.patch);
    });
  }

  private keys(): void {
    const acts: Record<string, () => void> = {
      ' ': () => this.toggle(),
      ArrowLeft: () => this.move(-1),
      ArrowRight: () => this.move(1),
      r: () => this.source.live && this.start(true),
      m: () => (this.settings.mesh = !this.settings.mesh),
      c: () => (this.settings.contours = !this.settings.contours),
      s: () => (this.settings.smooth = !this.settings.smooth),
      g: () => (this.settings.walk = !this.settings.walk),
      f: () => this.home(),
      '+': () => (this.settings.exposure = Math.min(6, this.settings.exposure + 0.5)),
      '-': () => (this.settings.exposure = Math.max(-6, this.settings.exposure - 0.5)),
      Escape: () => this.pick(undefined),
    };
    DISPLAYS.forEach((display, k) => (acts[String(k + 1)] = () => (this.settings.display = display)));
    addEventListener('keydown', (event) => {
      const at = event.target as HTMLElement;
      if (event.ctrlKey || event.metaKey || event.altKey || /^(SELECT|TEXTAREA)$/.test(at.tagName)) return;
      const isControl = /^(INPUT|BUTTON|SUMMARY)$/.test(at.tagName);
      if (isControl && (event.key === ' ' || event.key.startsWith('Arrow'))) return;
      const act = acts[event.key.length === 1 ? event.key.toLowerCase() : event.key];
      if (!act) return;
      event.preventDefault();
      act();
      this.look();
    });
  }
}

/** The colours of curves, as the style sheet has them now. */
function inks(): { ink: string; faint: string; lanes: [string, string] } {
  const probe = document.body.appendChild(document.createElement('span'));
  const [ink, faint, first, second] = ['--soft', '--line', '--lane-0', '--lane-1'].map((name) => {
    probe.style.color = `var(${name})`;
    return getComputedStyle(probe).color;
  }) as [string, string, string, string];
  probe.remove();
  return { ink, faint, lanes: [first, second] };
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

function save(name: string, blob: Blob): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

open()
  .then((source) => new Page(source))
  .catch((error: unknown) => {
    const notice = element('notice');
    notice.textContent = `The page cannot be shown: ${error instanceof Error ? error.message : String(error)}`;
    notice.hidden = false;
  });
