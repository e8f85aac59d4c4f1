//! A problem as a TOML file.

use super::Said;
use anyhow::{Context, Result, anyhow, bail};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs;
use std::ops::Range;
use std::path::Path;
use toml::Spanned;

/// What a problem file says, each text with its place.
#[derive(Debug, Default)]
pub struct ProblemFile {
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
    pub parameters: Vec<(String, Said)>,
    /// The greatest error wanted.
    pub tolerance: Option<f64>,
    /// The kernel's class.
    pub class: Option<Said>,
    /// The method by name.
    pub method: Option<Said>,
    /// Its space.
    pub space: Option<Said>,
    /// Its rule.
    pub rule: Option<Said>,
    /// Its size.
    pub n: Option<usize>,
    /// The most unknowns.
    pub unknowns: Option<usize>,
    /// Where the solution is wanted.
    pub at: Option<Said>,
    /// Whether one solution of many is an answer.
    pub general: bool,
}

impl ProblemFile {
    /// Reads the file.
    pub fn read(path: &Path) -> Result<Self> {
        let text = fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
        let name = path.display().to_string();
        let source = Source { name: &name, text: &text };
        let entries: Entries = toml::from_str(&text).map_err(|error| source.syntax(&error))?;
        entries.said(&source)
    }
}

/// The file as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entries {
    kernel: Option<Spanned<String>>,
    kernels: Option<Spanned<Vec<Vec<Spanned<String>>>>>,
    source: Option<Spanned<String>>,
    sources: Option<Vec<Spanned<String>>>,
    exact: Option<Spanned<OneOrMore>>,
    interval: Option<Spanned<Vec<Constant>>>,
    domain: Option<Spanned<String>>,
    #[serde(default)]
    parameters: BTreeMap<String, Spanned<Constant>>,
    tolerance: Option<Spanned<f64>>,
    class: Option<Spanned<String>>,
    method: Option<Spanned<String>>,
    space: Option<Spanned<String>>,
    rule: Option<Spanned<String>>,
    n: Option<Spanned<usize>>,
    unknowns: Option<Spanned<usize>>,
    at: Option<Spanned<String>>,
    #[serde(default)]
    general: bool,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "a formula, or a list of them")]
enum OneOrMore {
    One(String),
    More(Vec<String>),
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "a number, or a formula for one")]
enum Constant {
    Number(f64),
    Formula(String),
}

impl Constant {
    fn text(&self) -> String {
        match self {
            Self::Number(number) => number.to_string(),
            Self::Formula(text) => text.clone(),
        }
    }
}

impl Entries {
    fn said(self, source: &Source<'_>) -> Result<ProblemFile> {
        if let (Some(_), Some(kernels)) = (&self.kernel, &self.kernels) {
            bail!("{}: `kernel` and `kernels` cannot both be given", source.place(&kernels.span()));
        }
        if let (Some(interval), Some(_)) = (&self.interval, &self.domain) {
            bail!("{}: `interval` and `domain` cannot both be given", source.place(&interval.span()));
        }
        let said = |key: &str, text: &Option<Spanned<String>>| {
            text.as_ref().map(|text| source.said(key, text.get_ref(), &text.span()))
        };
        Ok(ProblemFile {
            kernels: match &self.kernels {
                Some(kernels) => source.square(kernels)?,
                None => said("kernel", &self.kernel).into_iter().collect(),
            },
            sources: match &self.sources {
                Some(list) => list.iter().map(|f| source.said("sources", f.get_ref(), &f.span())).collect(),
                None => said("source", &self.source).into_iter().collect(),
            },
            exact: self.exact.as_ref().map_or_else(Vec::new, |exact| source.exact(exact)),
            interval: self.interval.as_ref().map(|interval| source.ends(interval)).transpose()?,
            domain: said("domain", &self.domain),
            parameters: self.parameters.iter().map(|(name, value)| source.parameter(name, value)).collect(),
            tolerance: self.tolerance.as_ref().map(|tolerance| source.positive(tolerance)).transpose()?,
            class: said("class", &self.class),
            method: said("method", &self.method),
            space: said("space", &self.space),
            rule: said("rule", &self.rule),
            n: self.n.as_ref().map(|n| source.at_least_one("n", n)).transpose()?,
            unknowns: self.unknowns.as_ref().map(|n| source.at_least_one("unknowns", n)).transpose()?,
            at: said("at", &self.at),
            general: self.general,
        })
    }
}

/// The file, to turn places in its text into lines.
struct Source<'a> {
    name: &'a str,
    text: &'a str,
}

impl Source<'_> {
    fn place(&self, span: &Range<usize>) -> String {
        let before = self.text.as_bytes().iter().take(span.start);
        format!("{}:{}", self.name, 1 + before.filter(|&&byte| byte == b'\n').count())
    }

    fn said(&self, key: &str, text: &str, span: &Range<usize>) -> Said {
        Said { text: text.to_owned(), place: format!("{}: {key}", self.place(span)) }
    }

    fn syntax(&self, error: &toml::de::Error) -> anyhow::Error {
        let place = error.span().map_or_else(|| self.name.to_owned(), |span| self.place(&span));
        anyhow!("{place}: {}", error.message().replace('\n', "; "))
    }

    fn square(&self, kernels: &Spanned<Vec<Vec<Spanned<String>>>>) -> Result<Vec<Said>> {
        let rows = kernels.get_ref();
        if rows.is_empty() || rows.iter().any(|row| row.len() != rows.len()) {
            let place = self.place(&kernels.span());
            bail!("{place}: `kernels` must be m lists of m formulas each, for a system of m equations");
        }
        Ok(rows
            .iter()
            .flatten()
            .map(|kernel| self.said("kernels", kernel.get_ref(), &kernel.span()))
            .collect())
    }

    fn ends(&self, interval: &Spanned<Vec<Constant>>) -> Result<[Said; 2]> {
        let span = interval.span();
        let [a, b] = interval.get_ref().as_slice() else {
            bail!("{}: `interval` has two ends, not {}", self.place(&span), interval.get_ref().len());
        };
        Ok([a, b].map(|end| self.said("interval", &end.text(), &span)))
    }

    fn exact(&self, exact: &Spanned<OneOrMore>) -> Vec<Said> {
        let said = |text: &String| self.said("exact", text, &exact.span());
        match exact.get_ref() {
            OneOrMore::One(text) => vec![said(text)],
            OneOrMore::More(texts) => texts.iter().map(said).collect(),
        }
    }

    fn parameter(&self, name: &str, value: &Spanned<Constant>) -> (String, Said) {
        (name.to_owned(), self.said(name, &value.get_ref().text(), &value.span()))
    }

    fn positive(&self, tolerance: &Spanned<f64>) -> Result<f64> {
        let value = *tolerance.get_ref();
        if value > 0.0 && value.is_finite() {
            return Ok(value);
        }
        bail!("{}: tolerance: {value} is not a positive finite number", self.place(&tolerance.span()));
    }

    fn at_least_one(&self, key: &str, n: &Spanned<usize>) -> Result<usize> {
        match *n.get_ref() {
            0 => bail!("{}: {key}: give a whole number, 1 or more", self.place(&n.span())),
            n => Ok(n),
        }
    }
}
