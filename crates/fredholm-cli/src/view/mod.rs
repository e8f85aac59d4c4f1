//! `fredholm view`: u = f + ρ ⊙ (F u) in a browser, while it is being solved.
//!
//! A [`stage`] is what all windows share: patches, visibility, form factors. A [`session`] is a window's own: its solvers
//! ([`solvers`]), at its [`pace`]; the [`server`] carries what they say to each other ([`protocol`]).

pub mod args;
pub mod description;
mod discrete;
mod export;
mod guard;
mod inbox;
mod kept;
mod lamps;
mod pace;
pub mod page;
pub mod protocol;
mod race;
mod relight;
mod server;
mod session;
mod setup;
mod shared;
pub mod solvers;
mod stage;

use self::args::View;
use self::description::{Description, geometry};
pub use self::discrete::Kind;
use self::guard::Guard;
use self::server::{Hall, SEATS};
use self::solvers::Solver;
use self::stage::{Discretisation, Stage};
use crate::ending::Ending;
use crate::radiosity::args::{Bands, Method};
use crate::radiosity::settings::wish;
use crate::terminal::{Stream, say, warn};
use anyhow::{Context, Result, bail};
use fredholm::memory;
use fredholm::value::Rgb;
use radiosity::patches::size_for_count;
use radiosity::scene::{Scene, SolveOptions, Units, cornell_box, load_in};
use std::net::{Ipv4Addr, TcpListener};
use std::path::Path;
use std::sync::Arc;
use tokio::sync::Semaphore;

/// Patches when nobody says how many: their form factors are there in a second or two, and each shot in an instant.
const PATCHES: usize = 3000;

/// Where a browser finds its way back to, unless another program is there already.
const PORT: u16 = 8731;

/// `fredholm view`.
pub fn command(args: &View) -> Result<Ending> {
    if let Some(threads) = args.threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build_global().with_context(|| format!("cannot start {threads} threads"))?;
    }
    if args.bands == Bands::Spectral {
        bail!(
            "windows solve red, green and blue; `fredholm radiosity --bands spectral --html FILE` makes a page of all bands"
        );
    }
    let (scene, units, wishes) = scene(args)?;
    let solver = solver(args, &wishes)?;
    let how = discretisation(args, &wishes, &scene)?;
    let listener = listen(args.port)?;
    let port = listener.local_addr()?.port();
    let stage = Stage::new(scene, units, how)?;
    let first = stage.first();
    let solver = match solver {
        Some(solver) if !solver.shoots() && !first.is_stored => bail!("{}", session::too_large(first)),
        Some(solver) => solver,
        None => Solver::Southwell,
    };
    let hall = Arc::new(hall(stage, solver, port)?);
    hall.stage.want(how.kind);
    store(Arc::clone(&hall))?;
    let address = format!("http://127.0.0.1:{port}/");
    say(
        Stream::Out,
        &format!(
            "{}: {} patches at {address}, until Ctrl-C\n",
            hall.stage.scene.name,
            hall.stage.patches.len()
        ),
    )?;
    if !args.no_open
        && let Err(error) = open::that_detached(&address)
    {
        warn(&format!("no browser opens ({error}); open {address} in one"))?;
    }
    server::serve(listener, hall).context("the server ends")?;
    Ok(Ending::Converged)
}

/// Stores the form factors that are wanted, one kind after the other, as long as the process lives.
fn store(hall: Arc<Hall>) -> Result<()> {
    // A pool of their own: in the common one they would be in the way of every shot until all of them are there.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(rayon::current_num_threads()).build()?;
    let work = move || {
        loop {
            let discrete = hall.stage.discrete(hall.stage.wanted());
            pool.install(|| discrete.assemble(&hall.stage));
        }
    };
    std::thread::Builder::new().name("form factors".into()).spawn(work)?;
    Ok(())
}

fn hall(stage: Stage, solver: Solver, port: u16) -> Result<Hall> {
    let described = Description::new(
        (&stage.scene, stage.units),
        (&stage.patches, &stage.visibility),
        stage.how.size,
        stage.camera(),
    )
    .with(stage.first(), &stage.scene.lights, solver);
    Ok(Hall {
        description: serde_json::to_string(&described)?,
        geometry: geometry(&stage.patches.polygons),
        guard: Guard::new(port),
        seats: Arc::new(Semaphore::new(SEATS)),
        stage,
        solver,
    })
}

/// The scene, its units, and its wishes.
fn scene(args: &View) -> Result<(Scene<Rgb>, Units, SolveOptions)> {
    let Some(file) = &args.scene else {
        return Ok((cornell_box(), Units::Radiometric, SolveOptions::default()));
    };
    let loaded = load_in(file, args.photometric.then_some(Units::Photometric))?;
    loaded.warnings.iter().try_for_each(warn)?;
    Ok((loaded.scene, loaded.units, loaded.solve))
}

/// The solver that begins, if one is asked for.
fn solver(args: &View, wishes: &SolveOptions) -> Result<Option<Solver>> {
    let file = args.scene.as_deref().unwrap_or(Path::new(""));
    // Only what is said on the command line must be followed: a file asks for an answer, a window for a sight.
    let wished = wish("solver", wishes.solver.as_deref(), file)?.and_then(Solver::watched);
    match args.solver {
        Some(solver) => Solver::watched(solver)
            .context("the direct solver has no steps to be watched; choose another, or `fredholm radiosity`")
            .map(Some),
        None => Ok(wished),
    }
}

fn discretisation(args: &View, wishes: &SolveOptions, scene: &Scene<Rgb>) -> Result<Discretisation> {
    let file = args.scene.as_deref().unwrap_or(Path::new(""));
    let method = args.method.or(wish("method", wishes.method.as_deref(), file)?).unwrap_or(Method::Galerkin);
    if wishes.accuracy.is_some() {
        let file = file.display();
        warn(&format!(
            "{file}: [solve] accuracy finds a mesh of its own; what is watched has patches of one size"
        ))?;
    }
    let size = args.patch_size.or(wishes.patch_size.filter(|_| args.patch_count.is_none()));
    Ok(Discretisation {
        size: size.unwrap_or_else(|| size_for_count(scene, args.patch_count.unwrap_or(PATCHES))),
        kind: Kind { method, space: args.space },
        accuracy: args.factor_accuracy.or(wishes.factor_accuracy).unwrap_or(1e-3),
        tolerance: args.tolerance.or(wishes.tolerance).unwrap_or(1e-6),
        memory: memory::limit(),
    })
}

/// A port of this machine alone.
fn listen(port: Option<u16>) -> Result<TcpListener> {
    let bind = |port| TcpListener::bind((Ipv4Addr::LOCALHOST, port));
    match port {
        Some(port) => {
            bind(port).with_context(|| format!("cannot listen at port {port}; --port 0 takes a free one"))
        }
        None => bind(PORT).or_else(|_| bind(0)).context("cannot listen at any port of 127.0.0.1"),
    }
}
