//! The control line `C eps=1e-4 encl=1 …`: how View3D is asked for view factors.

use crate::scene::error::Problem;

/// How a View3D file asks for its view factors. What only steers View3D's own integration (`maxU`, `maxO`, `minO`,
/// `prjD`, `maxV`) or its log (`list`) is passed over.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Control {
    /// The line of the file, the last if there are several; `None` if there is none, and all else is as View3D has it
    /// where a file says nothing.
    pub line: Option<usize>,
    /// `eps`, the convergence that is aimed at; View3D takes 10⁻⁴ where a file says nothing.
    pub accuracy: Option<f64>,
    /// `row`, the one row that is asked for, counted from 1 among the surfaces that radiate; `None` for all.
    pub row: Option<usize>,
    /// `col`, the one column.
    pub column: Option<usize>,
    /// `encl`: whether the surfaces form an enclosure, so that each row should sum to 1.
    pub is_enclosure: bool,
    /// `emit`: whether diffuse reflection is to be included (Hottel's script-F).
    pub with_reflection: bool,
    /// `out`, the format of the output: 0 text, 1 binary; 2 is allowed, but View3D writes nothing then.
    pub output: u8,
}

/// The words that are meaningful to View3D alone.
const PASSED_OVER: [&str; 6] = ["list", "maxu", "maxo", "mino", "prjd", "maxv"];

impl Control {
    /// Takes a control line, and hands the words that it does not know to `unknown`.
    pub(super) fn take(&mut self, line: &str, mut unknown: impl FnMut(&str)) -> Result<(), Problem> {
        let is_between = |c: char| c == '=' || c == ',' || c.is_whitespace();
        let mut words = line.split(is_between).filter(|word| !word.is_empty());
        while let Some(key) = words.next() {
            let value = words.next().ok_or_else(|| {
                Problem::Malformed(format!("the control word `{key}` has no value; write `{key}=1`"))
            })?;
            self.set(key, value, &mut unknown)?;
        }
        if self.column.is_some() && self.row.is_none() {
            let problem = "`col` asks for one column of one row; give the `row` as well".to_owned();
            return Err(Problem::Malformed(problem));
        }
        Ok(())
    }

    fn set(&mut self, key: &str, value: &str, unknown: &mut impl FnMut(&str)) -> Result<(), Problem> {
        let whole = || whole(key, value);
        match key.to_ascii_lowercase().as_str() {
            "eps" => self.accuracy = Some(accuracy(value)?),
            "row" => self.row = number_of(whole()?),
            "col" => self.column = number_of(whole()?),
            "encl" => self.is_enclosure = whole()? != 0,
            "emit" => self.with_reflection = whole()? != 0,
            "out" => {
                let known = u8::try_from(whole()?).ok().filter(|&output| output <= 2);
                self.output = known.ok_or_else(|| {
                    Problem::Malformed(format!("`out={value}` is no output format; there are 0, 1 and 2"))
                })?;
            }
            other if PASSED_OVER.contains(&other) => {
                whole()?;
            }
            _ => unknown(key),
        }
        Ok(())
    }
}

fn whole(key: &str, value: &str) -> Result<i64, Problem> {
    value.parse().map_err(|_| {
        Problem::Malformed(format!("`{key}={value}` is not a whole number; write one, like `{key}=1`"))
    })
}

/// A row or a column; 0, and to View3D all that is less, means all.
fn number_of(value: i64) -> Option<usize> {
    usize::try_from(value).ok().filter(|&number| number > 0)
}

fn accuracy(value: &str) -> Result<f64, Problem> {
    let number: Option<f64> = value.parse().ok();
    number.filter(|eps| *eps > 0.0 && eps.is_finite()).ok_or_else(|| {
        Problem::Malformed(format!("`eps={value}` is not a positive number; write one, like `eps=1e-4`"))
    })
}
