// The page: hears of frames, shows the moment that is looked at, and says what the user asks for.

import { letters, showEquation, showLanes, showRelit, showWaiting } from './header';
import { listenToKeys } from './keys';
import { marked, showLegend } from './legend';
import { materials, reflectances, type Material } from './materials';
import { METHODS } from './methods';
import { offerPads } from './pads';
import { element, Panel } from './panel';
import { Patches } from './patches';
import { NONE, State, type Kind, type Message, type Scene, type Shown } from './protocol';
import { QUANTITIES, type Sight } from './quantities';
import { describe, patchName, showReadout } from './readout';
import { Relit } from './relit';
import { Run } from './run';
import { base64, offerFiles, save } from './saving';
import { text, type Scale } from './scale';
import { initial, offered, read, write, type Settings } from './settings';
import { open, type Source } from './source';
import { Timeline } from './timeline';
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
  private readonly timeline: Timeline;
  private readonly materials: Material[];
  private readonly first: Settings;
  private readonly settings: Settings;
  private readonly panel: Panel;
  private readonly relit: Relit;
  private run: Run | undefined;
  private playing = false;
  /** What was asked for last. */
  private asked: { kind: Kind; lamps: number[]; reflectance: number[][] } | undefined;
  /** Until the solver that was asked for begins. */
  private waiting = false;
  /** The share of the form factors that are known. */
  private assembled = 0;
  private factors: Sight['factors'];
  private scale: Scale | undefined;
  private pending = false;
  private relightTimer = 0;
  private noticeTimer = 0;
  private pointer: { clientX: number; clientY: number } | undefined;

  constructor(private readonly source: Source) {
    const scene = (this.scene = source.scene);
    this.materials = materials(scene);
    const strongest = (): number[] => this.materials.map((material) => material.strongest);
    this.first = initial(scene, strongest());
    this.settings = read(location.hash, scene, initial(scene, strongest()));
    this.patches = new Patches(scene, source.corners);
    this.view = new View(element<HTMLCanvasElement>('picture'), this.patches, scene.camera, scene.sky);
    this.timeline = new Timeline(scene);
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
    letters(scene);
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
    const { paused, relit } = this.settings;
    if (source.live) this.start(!paused && !relit);
    if (relit) this.relight(true);
    if (!source.live && !matchMedia('(prefers-reduced-motion: reduce)').matches) this.replay();
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
        return this.begin(message);
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

  private begin(message: Extract<Message, { type: 'started' }>): void {
    const { settings, scene } = this;
    const { kind, solvers, unknowns } = message;
    this.waiting = this.source.live && (solvers[0] !== settings.solver || solvers[1] !== settings.rival || !this.isAsked(kind));
    const asked = this.waiting ? undefined : this.asked;
    const reflectance = asked?.reflectance ?? scene.surfaces.map((surface) => surface.reflectance);
    this.run = new Run(message.run, kind, solvers, unknowns, asked?.lamps ?? scene.lamps.map(() => 1), reflectance);
    Object.assign(scene, { stored: message.stored, row_sum: message.row_sum ?? Infinity });
    this.scale = undefined;
    // A shot is another share of the work when there are more unknowns.
    if (this.playing && settings.speed === undefined && this.source.live) this.source.send({ type: 'play', passes: this.passes });
    this.panel.show();
    this.panel.showSpeed(this.passes, unknowns);
    this.refresh();
  }

  private isAsked({ method, space }: Kind): boolean {
    return method === this.settings.method && space === this.settings.space;
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
    const { method, space, solver, rival } = this.settings;
    const [lamps, reflectance] = [[...this.settings.lamps], this.reflectance];
    this.setRelit(false);
    if (this.asked && !this.isAsked(this.asked.kind)) this.relit.forget();
    this.asked = { kind: { method, space }, lamps, reflectance };
    this.waiting = true;
    document.body.dataset['state'] = 'Asked';
    const solvers = rival ? [solver, rival] : [solver];
    this.source.send({ type: 'start', kind: this.asked.kind, solvers, lamps, reflectance });
    this.setPlaying(play);
    this.look();
  }

  private get passes(): number {
    const { solver, rival, speed } = this.settings;
    if (speed !== undefined) return speed;
    if (rival) return RACE;
    return METHODS[solver].shoots ? SHOTS_A_SECOND / this.unknowns : SWEEPS_A_SECOND;
  }

  private get unknowns(): number {
    return this.run?.unknowns ?? this.scene.patches;
  }

  private setSpeed(passes: number): void {
    this.settings.speed = passes;
    this.panel.showSpeed(passes, this.unknowns);
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
      this.setRelit(false);
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
    this.setRelit(true);
    if (fresh || !this.relit.isAsked) this.askRelight();
    this.refresh();
  }

  private setRelit(active: boolean): void {
    this.relit.active = this.settings.relit = active;
    this.remember();
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
    this.panel.showSpeed(this.passes, this.unknowns);
    document.body.classList.toggle('walking', settings.walk);
    element('walk-here').setAttribute('aria-pressed', String(settings.walk));
    this.timeline.recolour();
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
    document.body.classList.toggle('relit', this.relit.isShown);
    // A difference is one picture.
    view.shown = this.relit.isShown || this.settings.display === 'difference' ? 1 : run.histories.length;
    for (let lane = 0; lane < view.shown; lane++) this.showLane(lane);
    view.draw();
    showLegend(this.marked());
    this.showHeader(run);
    this.timeline.show(run, this.relit.isShown, this.source.live);
    this.showReadout();
    const frame = run.frame(0)!;
    if (this.waiting) return;
    Object.assign(document.body.dataset, { iteration: String(frame.iteration), residual: String(frame.residual), state: State[frame.state] });
  }

  private marked(): ReturnType<typeof marked> {
    return marked(this.scene, this.settings.display, this.scale, this.sight(0));
  }

  /** The light that is shown, unless it is what the server has now. */
  private shown(): Shown | undefined {
    const { relit, run, settings } = this;
    if (relit.isShown) {
      return { radiosity: base64(relit.combine(settings.lamps)), lamps: settings.lamps, reflectance: this.reflectance };
    }
    const frame = run?.frame(0);
    if (!run || !frame || (run.isNewest && !this.playing)) return undefined;
    const { iteration, work, residual } = frame;
    const moment = Number.isFinite(residual) ? { moment: { iteration, work, residual } } : {};
    return { radiosity: base64(frame.radiosity), lamps: run.lamps, reflectance: run.reflectance, ...moment };
  }

  private showHeader(run: Run): void {
    const { scene, patches, view } = this;
    if (this.relit.active) showRelit(this.relit.isWhole);
    else if (this.waiting && this.assembled < 1) showWaiting(this.settings, this.assembled);
    else showEquation(run, run.frame(0)!, (i) => patchName(scene, patches, i));
    showLanes(view.shown > 1 ? run : undefined, view.canvas);
  }

  private showReadout(): void {
    const hit = this.pointer && this.view.pick(this.pointer);
    const sight = hit && this.sight(Math.min(hit.picture, this.view.shown - 1));
    const said = hit && sight && describe(hit.patch, sight, this.scene, this.patches, this.settings.display);
    showReadout(said, this.pointer, this.view.canvas);
  }

  private notice(message: string, stays = false): void {
    const notice = element('notice');
    notice.textContent = message;
    notice.hidden = false;
    clearTimeout(this.noticeTimer);
    if (!stays) this.noticeTimer = window.setTimeout(() => (notice.hidden = true), 7000);
  }

  private sight(lane: number): Sight | undefined {
    const { run, relit, settings } = this;
    const frame = run?.frame(lane);
    if (!run || !frame) return undefined;
    const emission = this.scene.surfaces.map((surface) => surface.emission);
    this.scene.lamps.forEach((lamp, k) => {
      for (const s of lamp.surfaces) emission[s] = emission[s]!.map((e) => e * settings.lamps[k]!);
    });
    const common = { factors: this.factors, reflectance: this.reflectance, emission, first: run.histories[0]!.points[0]?.residual ?? 0 };
    if (relit.isShown) {
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

  /** How bright the sky is, of what the scene says. */
  private get skyGain(): number {
    const lamp = this.scene.sky?.lamp ?? -1;
    return (this.relit.isShown ? this.settings.lamps : this.run!.lamps)[lamp] ?? 1;
  }

  private showLane(lane: number): void {
    const sight = this.sight(lane);
    if (!sight) return;
    const { settings, patches, scene } = this;
    const picture = this.view.pictures[lane]!;
    picture.mark('picked', settings.patch);
    const frame = this.run!.frame(lane)!;
    const shoots = frame.shot !== NONE && frame.state === State.Running && !this.relit.isShown;
    picture.mark('shot', shoots ? frame.shot : undefined);
    if (settings.display === 'light') {
      this.scale = undefined;
      picture.showLight(BRIGHTER * scene.exposure * 2 ** settings.exposure, this.skyGain);
      picture.set('light', sight.radiosity, settings.smooth);
      return;
    }
    const quantity = QUANTITIES[settings.display];
    const values = quantity.values(sight, patches, scene);
    if (lane === 0) this.scale = quantity.scale(values, patches, sight);
    picture.showNumbers(this.scale!, settings.contours && quantity.contours);
    picture.set('number', values, settings.smooth && settings.display !== 'received' && settings.display !== 'sent');
  }

  // ---- buttons, pointer and keys

  private buttons(): void {
    const click = (id: string, act: () => void): void => element(id).addEventListener('click', act);
    click('restart', () => this.start(true));
    click('back', () => this.move(-1));
    click('play', () => this.toggle());
    click('step', () => this.move(1));
    element<HTMLInputElement>('scrub').addEventListener('input', (event) => this.scrub(Number((event.target as HTMLInputElement).value)));
    this.timeline.ontouch(() => this.run, (work) => {
      this.setRelit(false);
      this.run?.showWork(work);
      if (this.playing && !this.run?.isNewest) this.setPlaying(false, this.source.live);
      this.refresh();
    });
    offerFiles(this.source, this.view, { shown: () => this.shown(), marked: () => this.marked() }, (message) => this.notice(message));
    offerPads(this.view.walk, {
      toggle: () => {
        this.settings.walk = !this.settings.walk;
        this.look();
      },
      changed: () => this.view.draw(),
      rest: () => this.view.onmove(),
    });
  }

  private scrub(moment: number): void {
    if (!this.run) return;
    if (this.playing) this.setPlaying(false, this.source.live);
    this.setRelit(false);
    this.run.show(moment);
    this.refresh();
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
    offered(this.scene).forEach((display, k) => (acts[String(k + 1)] = () => (this.settings.display = display)));
    listenToKeys(acts, () => this.look());
  }
}

open()
  .then((source) => new Page(source))
  .catch((error: unknown) => {
    const notice = element('notice');
    notice.textContent = `The page cannot be shown: ${error instanceof Error ? error.message : String(error)}`;
    notice.hidden = false;
  });
