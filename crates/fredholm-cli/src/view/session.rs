//! A page's own solvers: commands in, frames out. All that is solved here is solved by the crate `fredholm`.

use super::discrete::{Discrete, Factors, Kind, space};
use super::export::{Source, export};
use super::inbox::{Heard, Inbox};
use super::kept::Kept;
use super::pace::Pace;
use super::protocol::{Command, Message, Remark, factors};
use super::race::Run;
use super::relight::Relight;
use super::setup::{Setup, check};
use super::solvers::{Lane, Solver};
use super::stage::Stage;
use crate::radiosity::args::Space as Degrees;
use fredholm::operator::{Columns, Rows};
use fredholm::system::System;
use fredholm::value::{Rgb, Spectrum};
use radiosity::elements::Space;
use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant};

/// Where messages go; it says whether somebody is there to take them, and may wait until they are taken.
pub type Say<'a> = &'a mut dyn FnMut(Message) -> bool;

/// Between two looks at what is going on in the background.
const LOOK: Duration = Duration::from_millis(150);

/// Serves a page until it is gone.
pub fn serve(stage: &Stage, solver: Solver, commands: &Receiver<Command>, say: Say<'_>) {
    let mut session = Session {
        stage,
        inbox: Inbox::new(commands),
        say,
        relight: Relight::new(stage.first()),
        pace: Pace::new(),
        run: 0,
        told: None,
    };
    let mut next = Some(Setup::of(stage, solver));
    while let Some(setup) = next {
        let space = space(stage, setup.kind);
        let computed = Factors::new(stage, setup.kind, &space);
        let on = On { discrete: stage.discrete(setup.kind), space: &space, computed: &computed };
        session.enter(on.discrete);
        next = session.wait(&setup, on).and_then(|waited| match waited {
            Waited::Ready(kept) => session.show(&setup, on, &kept),
            Waited::Other(setup) => Some(*setup),
        });
    }
}

struct Session<'a> {
    stage: &'a Stage,
    inbox: Inbox<'a>,
    say: Say<'a>,
    relight: Relight,
    pace: Pace,
    run: u32,
    /// The progress that was told last, and of which kind.
    told: Option<(Kind, u64)>,
}

/// What the unknowns of now are, and what F_ij is between them.
#[derive(Clone, Copy)]
struct On<'a> {
    discrete: &'a Discrete,
    space: &'a Space<'a>,
    computed: &'a Factors<'a>,
}

/// What came of waiting for F.
enum Waited<'a> {
    /// It is at hand.
    Ready(Kept<'a>),
    /// Something else is to be solved.
    Other(Box<Setup>),
}

/// What a command did to the run.
enum Done {
    /// It goes on.
    Nothing,
    /// Another begins.
    Other(Setup),
    /// Nobody is there.
    Gone,
}

impl Session<'_> {
    /// Has F of these unknowns stored, if that is possible.
    fn enter(&mut self, discrete: &Discrete) {
        self.stage.want(discrete.kind);
        self.relight.enter(discrete);
    }

    /// Waits until F is kept as the solvers need it; those that shoot need not wait.
    fn wait<'b>(&mut self, setup: &Setup, on: On<'b>) -> Option<Waited<'b>> {
        let discrete = on.discrete;
        loop {
            let shoots = setup.solvers.iter().all(|solver| solver.shoots());
            let failed = matches!(discrete.matrix(), Some(Err(_)));
            if matches!(discrete.matrix(), Some(Ok(_))) || (shoots && !failed) {
                return Some(Waited::Ready(discrete.kept(on.computed)));
            }
            if let Some(Err(message)) = discrete.matrix() {
                let message = message.clone();
                self.refuse(message)?;
            } else if !discrete.is_stored {
                self.refuse(too_large(discrete))?;
            }
            self.look(discrete)?;
            let idle = failed || !discrete.is_stored;
            match self.inbox.fresh((!idle).then_some(LOOK)) {
                Heard::Gone => return None,
                Heard::Silence => {}
                Heard::Command(Command::Start { kind, solvers, lamps, reflectance }) => {
                    let kind = kind.unwrap_or(self.stage.how.kind);
                    match Setup::new(self.stage, kind, solvers, lamps, reflectance) {
                        Ok(setup) => return Some(Waited::Other(Box::new(setup))),
                        Err(error) => self.refuse(format!("{error:#}"))?,
                    }
                }
                Heard::Command(later) => {
                    if !self.inbox.keep(later) {
                        self.refuse(
                            "too much is asked for at once; wait until the form factors are there".to_owned(),
                        )?;
                    }
                }
            }
        }
    }

    /// Runs the solvers until something else is to be solved, or nobody looks.
    fn show(&mut self, setup: &Setup, on: On<'_>, kept: &Kept<'_>) -> Option<Setup> {
        let system = match System::new(&setup.source, &setup.reflectance, kept) {
            Ok(system) => system,
            Err(error) => {
                self.refuse(error.to_string())?;
                return None;
            }
        };
        let accuracy = self.stage.how.accuracy;
        let norm = on.discrete.norm(&setup.reflectance, accuracy);
        self.run += 1;
        let lane = |solver: &Solver| Lane::new(*solver, system, on.space, setup.target);
        let mut run = Run { setup, kept, norm, lanes: setup.solvers.iter().map(lane).collect() };
        self.pace.restart();
        let known = |number: f64| Some(number).filter(|number| number.is_finite());
        self.remark(&Remark::Started {
            run: self.run,
            kind: setup.kind,
            solvers: setup.solvers.clone(),
            unknowns: on.discrete.dim(),
            stored: on.discrete.is_stored,
            row_sum: known(on.discrete.row_sum(accuracy)),
            norm: known(norm),
            target: setup.target,
        })?;
        self.frames(&mut run)?;
        loop {
            self.look(on.discrete)?;
            match self.inbox.next(self.patience(&run, on.discrete)) {
                Heard::Gone => return None,
                Heard::Silence => self.go_on(&mut run, on)?,
                Heard::Command(command) => match self.follow(command, &mut run, on) {
                    Done::Nothing => {}
                    Done::Other(setup) => return Some(setup),
                    Done::Gone => return None,
                },
            }
        }
    }

    /// How long to wait for a command before there is something to do.
    fn patience(&self, run: &Run<'_>, discrete: &Discrete) -> Option<Duration> {
        let playing = if run.runs() { self.pace.rest() } else { None };
        if self.relight.is_busy() && matches!(discrete.matrix(), Some(Ok(_))) {
            return Some(Duration::ZERO);
        }
        playing.or_else(|| (self.is_assembling(discrete) || self.relight.is_busy()).then_some(LOOK))
    }

    fn is_assembling(&self, discrete: &Discrete) -> bool {
        discrete.is_stored && self.told != Some((discrete.kind, discrete.progress().1))
    }

    /// Does what is due.
    fn go_on(&mut self, run: &mut Run<'_>, on: On<'_>) -> Option<()> {
        if let Some(Ok(matrix)) = on.discrete.matrix()
            && let Some(answer) = self.relight.advance(self.stage, (on.discrete, on.space), &matrix.entries)
        {
            self.tell(answer)?;
        }
        if self.pace.is_playing() && run.runs() && self.pace.rest().is_none_or(|rest| rest.is_zero()) {
            let (due, until) = self.pace.tick();
            if run.advance(due, Some(until)) {
                self.frames(run)?;
            }
            self.pace.done(run.work(), Instant::now() >= until);
        }
        Some(())
    }

    fn follow(&mut self, command: Command, run: &mut Run<'_>, on: On<'_>) -> Done {
        let done = match command {
            Command::Start { kind, solvers, lamps, reflectance } => {
                let kind = kind.unwrap_or(self.stage.how.kind);
                match Setup::new(self.stage, kind, solvers, lamps, reflectance) {
                    Ok(setup) => return Done::Other(setup),
                    Err(error) => self.refuse(format!("{error:#}")),
                }
            }
            Command::Play { passes } if passes > 0.0 && passes.is_finite() => {
                self.pace.set(Some(passes));
                Some(())
            }
            Command::Play { passes } => {
                self.refuse(format!("{passes} passes a second: give a positive number"))
            }
            Command::Pause => {
                self.pace.set(None);
                Some(())
            }
            Command::Step => self.step(run),
            Command::Factors { patch } => self.factors(patch, run.kept, on.space),
            Command::Relight { reflectance, version } => self.ask(&reflectance, version, on.discrete),
            Command::Export { format, camera, shown } => {
                let source = Source { stage: self.stage, setup: run.setup, kept: run.kept, space: on.space };
                match export(source, (&run.lanes[0], run.norm), format, camera, shown.as_deref()) {
                    Ok((name, content)) => self.tell(Message::Bytes(super::protocol::file(&name, &content))),
                    Err(error) => self.refuse(format!("{error:#}")),
                }
            }
        };
        done.map_or(Done::Gone, |()| Done::Nothing)
    }

    fn step(&mut self, run: &mut Run<'_>) -> Option<()> {
        self.pace.set(None);
        let due = match run.lanes.as_slice() {
            [lane] => lane.work() + lane.cost(),
            _ => run.work() + 1.0,
        };
        // What is asked for by hand is done, however long it takes.
        run.advance(due, None);
        self.pace.done(run.work(), true);
        self.frames(run)
    }

    /// The form factors of a patch: means over what it receives with, and all that it sends.
    fn factors(&mut self, patch: u32, kept: &Kept<'_>, space: &Space<'_>) -> Option<()> {
        let (i, n) = (patch as usize, self.stage.patches.len());
        if i >= n {
            return self.refuse(format!("there is no patch {patch}: they are numbered from 0 to {}", n - 1));
        }
        let mut buffer = Vec::new();
        let (mut row, mut column) = (vec![0.0; space.dim()], vec![0.0; space.dim()]);
        let area: f64 = space.weights()[space.range(i)].iter().sum();
        for a in space.range(i) {
            let share = space.weights()[a] / area;
            row.iter_mut().zip(kept.row(a, &mut buffer).iter()).for_each(|(sum, f)| *sum += share * f);
            column.iter_mut().zip(kept.column(a, &mut buffer).iter()).for_each(|(sum, f)| *sum += f);
        }
        let of_patch = |j: usize| row[space.range(j)].iter().sum::<f64>();
        let row: Vec<f64> = (0..n).map(of_patch).collect();
        self.tell(Message::Bytes(factors(patch, &row, &space.means(&column))))
    }

    fn ask(&mut self, reflectance: &[[f64; 3]], version: u32, discrete: &Discrete) -> Option<()> {
        if let Err(error) = check(self.stage, reflectance) {
            return self.refuse(format!("{error:#}"));
        }
        if let Some(Err(message)) = discrete.matrix() {
            return self.refuse(message.clone());
        }
        if !discrete.is_stored {
            return self.refuse(too_large(discrete));
        }
        let colours: Vec<Rgb> = reflectance.iter().map(|rho| Spectrum(*rho)).collect();
        self.relight.ask(discrete.spread(&colours), version);
        Some(())
    }

    /// Tells how far the matrix is, if that has changed.
    fn look(&mut self, discrete: &Discrete) -> Option<()> {
        if !self.is_assembling(discrete) {
            return Some(());
        }
        let (done, of) = discrete.progress();
        let now = Some((discrete.kind, done));
        if self.told == now || (done == of && discrete.matrix().is_none()) {
            return Some(());
        }
        self.told = now;
        self.remark(&Remark::Assembly { done, of })
    }

    fn frames(&mut self, run: &mut Run<'_>) -> Option<()> {
        for (k, lane) in run.lanes.iter_mut().enumerate() {
            self.tell(Message::Bytes(lane.frame(k, self.run, run.norm)))?;
        }
        Some(())
    }

    fn refuse(&mut self, message: String) -> Option<()> {
        self.remark(&Remark::Error { message })
    }

    fn remark(&mut self, remark: &Remark) -> Option<()> {
        self.tell(remark.into())
    }

    fn tell(&mut self, message: Message) -> Option<()> {
        (self.say)(message).then_some(())
    }
}

/// What is told of unknowns whose F is not stored.
pub fn too_large(discrete: &Discrete) -> String {
    let unknowns = match discrete.kind.space {
        Degrees::P0 => "patches",
        _ => "coefficients of patches",
    };
    format!(
        "the form factors of {} {unknowns} are too many to be stored: only southwell, which stores none, can be \
         watched, and lamps and materials need a new start; take larger patches",
        discrete.dim()
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::stage::tests::cornell;
    use std::sync::mpsc::sync_channel;

    /// What a page is told that says all of this and then goes.
    fn told(stage: &Stage, commands: Vec<Command>) -> Vec<Message> {
        let (tell, heard) = sync_channel(commands.len().max(1));
        commands.into_iter().for_each(|command| tell.send(command).unwrap());
        drop(tell);
        let mut messages = Vec::new();
        serve(stage, Solver::Southwell, &heard, &mut |message| {
            messages.push(message);
            true
        });
        messages
    }

    fn start(stage: &Stage, solvers: &[Solver]) -> Command {
        start_of(stage, None, solvers)
    }

    fn start_of(stage: &Stage, kind: Option<Kind>, solvers: &[Solver]) -> Command {
        let reflectance = stage.scene.surfaces.iter().map(|surface| surface.reflectance.0).collect();
        let lamps = vec![1.0; stage.first().lamps.len()];
        Command::Start { kind, solvers: solvers.to_vec(), lamps, reflectance }
    }

    /// Run, lane, iteration and state, residual, and B.
    fn frames(messages: &[Message]) -> Vec<([u32; 4], f64, Vec<f32>)> {
        let frame = |bytes: &Vec<u8>| {
            let word = |k: usize| u32::from_le_bytes(bytes[4 * k..][..4].try_into().unwrap());
            let residual = f64::from_le_bytes(bytes[32..40].try_into().unwrap());
            let n = (bytes.len() - 56) / 16;
            let floats = bytes[56..][..12 * n].chunks(4);
            let radiosity = floats.map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect();
            ([word(2), word(1), word(3), word(5)], residual, radiosity)
        };
        let frames = messages.iter().filter_map(|message| match message {
            Message::Bytes(bytes) if bytes[0] == 1 => Some(frame(bytes)),
            _ => None,
        });
        frames.collect()
    }

    #[test]
    fn every_solver_comes_to_the_solution_step_by_step() {
        let stage = cornell(200);
        let expected = radiosity::solve::solve(
            &stage.patches,
            &stage.visibility,
            &radiosity::solve::Options::default(),
            &mut radiosity::solve::Unobserved,
        );
        let expected = expected.unwrap().radiosity;
        for solver in Solver::ALL {
            let steps = if solver.shoots() { 20_000 } else { 60 };
            let commands = [vec![start(&stage, &[solver])], vec![Command::Step; steps]].concat();
            let frames = frames(&told(&stage, commands));
            let (first, last) = (&frames[1], &frames[frames.len() - 1]);
            assert_eq!((first.0, last.0[3]), ([2, 0, 0, 0], 1), "{solver:?}");
            assert!(last.1 < 1e-5 * first.1, "{solver:?}: {} to {}", first.1, last.1);
            let size = expected.iter().map(|b| b.0[0]).fold(0.0, f64::max);
            for (i, b) in expected.iter().enumerate() {
                let off = b.0[0] - f64::from(last.2[3 * i]);
                assert!(off.abs() < 1e-4 * size, "{solver:?}: patch {i} is off by {off}");
            }
        }
    }

    #[test]
    fn every_method_and_polynomial_comes_to_the_means_of_its_solution() {
        use crate::radiosity::args::Method;
        let mut stage = cornell(60);
        stage.how.accuracy = 0.03;
        for (method, degrees) in [
            (Method::Collocation, Degrees::P0),
            (Method::Nystrom, Degrees::P0),
            (Method::Galerkin, Degrees::P1),
            (Method::Collocation, Degrees::P2),
            (Method::Nystrom, Degrees::P1),
        ] {
            let kind = Kind { method, space: degrees };
            stage.discrete(kind).assemble(&stage);
            let options =
                radiosity::solve::Options { method: method.into(), accuracy: 0.03, ..Default::default() };
            let unobserved = &mut radiosity::solve::Unobserved;
            let (patches, visibility) = (&stage.patches, &stage.visibility);
            let expected = match degrees.degree() {
                None => radiosity::solve::solve(patches, visibility, &options, unobserved).unwrap().radiosity,
                Some(degree) => {
                    let space = Space::new(&patches.polygons, degree);
                    let solved =
                        radiosity::solve::solve_elements(&space, patches, visibility, &options, unobserved);
                    space.means(&solved.unwrap().radiosity)
                }
            };
            let size = expected.iter().map(|b| b.0[0]).fold(0.0, f64::max);
            let commands = vec![start_of(&stage, Some(kind), &[Solver::GaussSeidel])];
            let messages = told(&stage, [commands, vec![Command::Step; 60]].concat());
            let frames = frames(&messages);
            let last = &frames[frames.len() - 1];
            assert_eq!((last.0[3], last.2.len()), (1, 3 * patches.len()), "{kind:?}");
            for (i, b) in expected.iter().enumerate() {
                let off = b.0[0] - f64::from(last.2[3 * i]);
                assert!(off.abs() < 1e-4 * size, "{kind:?}: patch {i} is off by {off} of {size}");
            }
        }
    }

    #[test]
    fn the_form_factors_of_a_patch_are_the_same_for_all_polynomials() {
        use crate::radiosity::args::Method;
        let stage = cornell(60);
        let told_of = |degrees: Degrees| -> Vec<f32> {
            let kind = Kind { method: Method::Galerkin, space: degrees };
            if stage.discrete(kind).matrix().is_none() {
                stage.discrete(kind).assemble(&stage);
            }
            let commands =
                vec![start_of(&stage, Some(kind), &[Solver::Jacobi]), Command::Factors { patch: 3 }];
            let factors = told(&stage, commands).into_iter().find_map(|message| match message {
                Message::Bytes(bytes) if bytes[0] == 2 => Some(bytes),
                _ => None,
            });
            factors.unwrap()[8..].chunks(4).map(|f| f32::from_le_bytes(f.try_into().unwrap())).collect()
        };
        let (constant, linear) = (told_of(Degrees::P0), told_of(Degrees::P1));
        assert_eq!(constant.len(), 2 * stage.patches.len());
        // Sampled where something may hide them: in sum to a thousandth.
        let off: f32 = constant.iter().zip(&linear).map(|(a, b)| (a - b).abs()).sum();
        assert!(off < 0.02 && constant.iter().sum::<f32>() > 0.5, "{off}");
    }

    #[test]
    fn a_race_is_run_at_equal_work() {
        let stage = cornell(200);
        let race = start(&stage, &[Solver::GaussSeidel, Solver::Southwell]);
        let frames = frames(&told(&stage, vec![race, Command::Step, Command::Step]));
        let n = stage.patches.len() as u32;
        let last: Vec<_> = frames[frames.len() - 2..].iter().map(|frame| frame.0).collect();
        assert_eq!(last, [[2, 0, 2, 0], [2, 1, 2 * n, 0]]);
    }

    #[test]
    fn nonsense_is_refused_and_the_session_goes_on() {
        let stage = cornell(200);
        let mut bright = start(&stage, &[Solver::Jacobi]);
        if let Command::Start { lamps, .. } = &mut bright {
            lamps[0] = f64::NAN;
        }
        let white = vec![[1.5; 3]; stage.scene.surfaces.len()];
        let commands = vec![
            bright,
            start(&stage, &[]),
            Command::Play { passes: -1.0 },
            Command::Factors { patch: u32::MAX },
            Command::Relight { reflectance: white, version: 1 },
            Command::Relight { reflectance: Vec::new(), version: 1 },
            Command::Step,
        ];
        let messages = told(&stage, commands);
        let errors = messages.iter().filter(|m| matches!(m, Message::Text(t) if t.contains("\"error\"")));
        assert_eq!(errors.count(), 6);
        assert_eq!(frames(&messages).last().map(|frame| frame.0[2]), Some(1));
    }
}
