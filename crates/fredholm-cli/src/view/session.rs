//! A page's own solvers: commands in, frames out. All that is solved here is solved by the crate `fredholm`.

use super::export::export;
use super::inbox::{Heard, Inbox};
use super::kept::Kept;
use super::pace::Pace;
use super::protocol::{Command, Message, Remark, factors};
use super::race::Run;
use super::relight::Relight;
use super::setup::{Setup, check};
use super::solvers::{Lane, Solver};
use super::stage::Stage;
use fredholm::operator::{Columns, Rows};
use fredholm::system::System;
use radiosity::form_factor::FormFactors;
use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant};

/// Where messages go; it says whether somebody is there to take them, and may wait until they are taken.
pub type Say<'a> = &'a mut dyn FnMut(Message) -> bool;

/// Between two looks at what is going on in the background.
const LOOK: Duration = Duration::from_millis(150);

/// Serves a page until it is gone.
pub fn serve(stage: &Stage, solver: Solver, commands: &Receiver<Command>, say: Say<'_>) {
    let computed = stage.form_factors();
    let mut session = Session {
        stage,
        computed: &computed,
        inbox: Inbox::new(commands),
        say,
        relight: Relight::new(stage),
        pace: Pace::new(),
        run: 0,
        told: None,
    };
    let mut next = Some(Setup::of(stage, solver));
    while let Some(setup) = next {
        next = session.wait(&setup).and_then(|waited| match waited {
            Waited::Ready(kept) => session.show(&setup, &kept),
            Waited::Other(setup) => Some(*setup),
        });
    }
}

struct Session<'a> {
    stage: &'a Stage,
    computed: &'a FormFactors<'a>,
    inbox: Inbox<'a>,
    say: Say<'a>,
    relight: Relight,
    pace: Pace,
    run: u32,
    /// The progress that was told last.
    told: Option<u64>,
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

impl<'a> Session<'a> {
    /// Waits until F is kept as the solvers need it; those that shoot need not wait.
    fn wait(&mut self, setup: &Setup) -> Option<Waited<'a>> {
        loop {
            let shoots = setup.solvers.iter().all(|solver| solver.shoots());
            let failed = matches!(self.stage.matrix(), Some(Err(_)));
            if matches!(self.stage.matrix(), Some(Ok(_))) || (shoots && !failed) {
                return Some(Waited::Ready(self.stage.kept(self.computed)));
            }
            if let Some(Err(message)) = self.stage.matrix() {
                let message = message.clone();
                self.refuse(message)?;
            } else if !self.stage.is_stored() {
                self.refuse(too_large(self.stage))?;
            }
            self.look()?;
            let idle = failed || !self.stage.is_stored();
            match self.inbox.fresh((!idle).then_some(LOOK)) {
                Heard::Gone => return None,
                Heard::Silence => {}
                Heard::Command(Command::Start { solvers, lamps, reflectance }) => {
                    match Setup::new(self.stage, solvers, lamps, reflectance) {
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
    fn show(&mut self, setup: &Setup, kept: &Kept<'_>) -> Option<Setup> {
        let weights = &self.stage.patches.areas;
        let system = match System::new(&setup.source, &setup.reflectance, kept) {
            Ok(system) => system,
            Err(error) => {
                self.refuse(error.to_string())?;
                return None;
            }
        };
        let norm = self.stage.norm(&setup.reflectance);
        self.run += 1;
        let lane = |solver: &Solver| Lane::new(*solver, system, weights, setup.target);
        let mut run = Run { setup, kept, norm, lanes: setup.solvers.iter().map(lane).collect() };
        self.pace.restart();
        let (solvers, target) = (setup.solvers.clone(), setup.target);
        self.remark(&Remark::Started { run: self.run, solvers, norm, target })?;
        self.frames(&mut run)?;
        loop {
            self.look()?;
            match self.inbox.next(self.patience(&run)) {
                Heard::Gone => return None,
                Heard::Silence => self.go_on(&mut run)?,
                Heard::Command(command) => match self.follow(command, &mut run) {
                    Done::Nothing => {}
                    Done::Other(setup) => return Some(setup),
                    Done::Gone => return None,
                },
            }
        }
    }

    /// How long to wait for a command before there is something to do.
    fn patience(&self, run: &Run<'_>) -> Option<Duration> {
        let playing = if run.runs() { self.pace.rest() } else { None };
        if self.relight.is_busy() && matches!(self.stage.matrix(), Some(Ok(_))) {
            return Some(Duration::ZERO);
        }
        playing.or_else(|| (self.is_assembling() || self.relight.is_busy()).then_some(LOOK))
    }

    fn is_assembling(&self) -> bool {
        self.stage.is_stored() && self.told != Some(self.stage.progress().1)
    }

    /// Does what is due.
    fn go_on(&mut self, run: &mut Run<'_>) -> Option<()> {
        if let Some(Ok(matrix)) = self.stage.matrix()
            && let Some(answer) = self.relight.advance(self.stage, &matrix.entries)
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

    fn follow(&mut self, command: Command, run: &mut Run<'_>) -> Done {
        let done = match command {
            Command::Start { solvers, lamps, reflectance } => {
                match Setup::new(self.stage, solvers, lamps, reflectance) {
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
            Command::Factors { patch } => self.factors(patch, run.kept),
            Command::Relight { reflectance, version } => self.ask(&reflectance, version),
            Command::Export { format, camera } => {
                match export(self.stage, run.setup, (&run.lanes[0], run.kept), format, camera) {
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

    fn factors(&mut self, patch: u32, kept: &Kept<'_>) -> Option<()> {
        let (i, n) = (patch as usize, self.stage.patches.len());
        if i >= n {
            return self.refuse(format!("there is no patch {patch}: they are numbered from 0 to {}", n - 1));
        }
        let (mut buffer, mut other) = (Vec::new(), Vec::new());
        let row: Vec<f64> = kept.row(i, &mut buffer).iter().collect();
        let column: Vec<f64> = kept.column(i, &mut other).iter().collect();
        self.tell(Message::Bytes(factors(patch, &row, &column)))
    }

    fn ask(&mut self, reflectance: &[[f64; 3]], version: u32) -> Option<()> {
        if let Err(error) = check(self.stage, reflectance) {
            return self.refuse(format!("{error:#}"));
        }
        if let Some(Err(message)) = self.stage.matrix() {
            return self.refuse(message.clone());
        }
        if !self.stage.is_stored() {
            return self.refuse(too_large(self.stage));
        }
        self.relight.ask(self.stage.spread(reflectance), version);
        Some(())
    }

    /// Tells how far the matrix is, if that has changed.
    fn look(&mut self) -> Option<()> {
        if !self.is_assembling() {
            return Some(());
        }
        let (done, of) = self.stage.progress();
        if self.told == Some(done) || (done == of && self.stage.matrix().is_none()) {
            return Some(());
        }
        self.told = Some(done);
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

/// What is told of a scene whose F is not stored.
pub fn too_large(stage: &Stage) -> String {
    format!(
        "the form factors of {} patches are too many to be stored: only southwell, which stores none, can be \
         watched, and lamps and materials need a new start; take larger patches",
        stage.patches.len()
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
        let reflectance = stage.scene.surfaces.iter().map(|surface| surface.reflectance.0).collect();
        Command::Start { solvers: solvers.to_vec(), lamps: vec![1.0; stage.lamps.len()], reflectance }
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
