//! The equation as its user states it: the command line's word before the file's.

use super::Said;
use super::args::{ProblemArgs, SourceArgs};
use super::file::ProblemFile;
use super::formulas::constant;
use anyhow::Result;

/// All that was said of the equation, in words.
#[derive(Debug)]
pub struct Statement {
    /// What the file says, where there is one.
    pub file: ProblemFile,
    /// Kernels, m × m of them for m sources, row by row.
    pub kernels: Vec<Said>,
    /// Sources.
    pub sources: Vec<Said>,
    /// Solutions, where they are known.
    pub exact: Vec<Said>,
    /// The ends of the interval.
    pub interval: Option<[Said; 2]>,
    /// A domain of the plane.
    pub domain: Option<Said>,
    /// Names and values.
    pub parameters: Vec<(String, f64)>,
}

impl Statement {
    /// Puts the command line and the file together; an equation for its eigenvalues has no source.
    pub fn new(args: &ProblemArgs, source: Option<&SourceArgs>) -> Result<Self> {
        let mut file = args.file.as_deref().map(ProblemFile::read).transpose()?.unwrap_or_default();
        let list = |name: &str, text: Option<&String>, file: Vec<Said>| match text {
            Some(text) => vec![Said::option(name, text)],
            None => file,
        };
        let kernels = list("kernel", args.kernel.as_ref(), std::mem::take(&mut file.kernels));
        let (sources, exact) = match source {
            None => (Vec::new(), Vec::new()),
            Some(args) => (
                list("source", args.source.as_ref(), std::mem::take(&mut file.sources)),
                list("exact", args.exact.as_ref(), std::mem::take(&mut file.exact)),
            ),
        };
        let domain = args.domain.as_ref().map(|text| Said::option("domain", text));
        let interval = match args.interval.as_deref() {
            Some([a, b]) => Some([a, b].map(|end| Said::option("interval", end))),
            _ => file.interval.take().filter(|_| domain.is_none()),
        };
        let domain = domain.or(file.domain.take().filter(|_| interval.is_none()));
        let parameters = parameters(&file, &args.parameters)?;
        Ok(Self { file, kernels, sources, exact, interval, domain, parameters })
    }
}

/// Those of the file, by the alphabet, with the command line's word for those that it has too; then the others of the
/// command line. Each may use the ones before it.
fn parameters(file: &ProblemFile, args: &[(String, String)]) -> Result<Vec<(String, f64)>> {
    let option = |(name, text): &(String, String)| (name.clone(), Said::option(&format!("set {name}"), text));
    let ours = |name: &str| args.iter().rev().find(|(own, _)| own == name).map(option);
    let theirs = file.parameters.iter().map(|own| ours(&own.0).unwrap_or_else(|| own.clone()));
    let more = args.iter().filter(|(name, _)| file.parameters.iter().all(|(own, _)| own != name));
    let mut values: Vec<(String, f64)> = Vec::new();
    for (name, said) in theirs.chain(more.map(option)) {
        let value = constant(&said, &values)?;
        values.retain(|(known, _)| *known != name);
        values.push((name, value));
    }
    Ok(values)
}
