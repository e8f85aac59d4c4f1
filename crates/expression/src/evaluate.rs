//! A program over columns, block by block: what is the same in all lanes once, the rest for each block.

use crate::graph::Kind;
use crate::lanes::{self, Block, LANES};
use crate::program::{Program, Step};
use num_complex::Complex;
use std::cell::RefCell;

type C = Complex<f64>;

/// The values of a variable over a batch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Column<'a> {
    /// The same for all lanes. What depends on such columns alone is computed once.
    Same(f64),
    /// One value a lane, as many as results are wanted.
    Each(&'a [f64]),
}

/// The registers, kept from call to call by each thread.
struct Registers {
    real: Vec<Block<f64>>,
    complex: Vec<Block<C>>,
    /// The program whose constants they hold.
    owner: u64,
}

thread_local! {
    static REGISTERS: RefCell<Registers> =
        const { RefCell::new(Registers { real: Vec::new(), complex: Vec::new(), owner: 0 }) };
}

impl Program {
    /// The real value at a point.
    pub fn at(&self, point: &[f64]) -> f64 {
        REGISTERS.with_borrow_mut(|registers| {
            registers.point(self, point);
            registers.real[self.root].0[0]
        })
    }

    /// The value at a point, as a complex number.
    pub fn at_complex(&self, point: &[f64]) -> C {
        REGISTERS.with_borrow_mut(|registers| {
            registers.point(self, point);
            if self.kind == Kind::Real {
                registers.real[self.root].0[0].into()
            } else {
                registers.complex[self.root].0[0]
            }
        })
    }

    /// The real values, one a lane.
    pub fn fill(&self, columns: &[Column<'_>], out: &mut [f64]) {
        REGISTERS.with_borrow_mut(|registers| registers.fill(self, columns, out));
    }

    /// The values as complex numbers, one a lane.
    pub fn fill_complex(&self, columns: &[Column<'_>], out: &mut [C]) {
        REGISTERS.with_borrow_mut(|registers| registers.fill_complex(self, columns, out));
    }
}

impl Registers {
    /// Room for the program, with its constants in place.
    #[inline]
    fn prepare(&mut self, program: &Program) {
        if self.owner != program.identity {
            self.adopt(program);
        }
    }

    #[cold]
    fn adopt(&mut self, program: &Program) {
        let [real, complex] = program.registers;
        if self.real.len() < real {
            self.real.resize(real, Block([0.0; LANES]));
        }
        if self.complex.len() < complex {
            self.complex.resize(complex, Block([C::ZERO; LANES]));
        }
        program.constants.iter().for_each(|(register, value)| self.real[*register].0.fill(*value));
        program.complex_constants.iter().for_each(|(register, value)| self.complex[*register].0.fill(*value));
        self.owner = program.identity;
    }

    /// All steps, at one point.
    fn point(&mut self, program: &Program, point: &[f64]) {
        self.prepare(program);
        self.real.iter_mut().zip(point).for_each(|(register, value)| register.0[0] = *value);
        program.steps.iter().for_each(|step| self.run(step, 1));
    }

    /// The real values. A function of its own, of which only a call is compiled into what looks for the registers.
    #[inline(never)]
    fn fill(&mut self, program: &Program, columns: &[Column<'_>], out: &mut [f64]) {
        let lanes = out.len().min(LANES);
        let varying = self.first(program, columns, out.len());
        self.values(program, varying, &mut out[..lanes]);
        if out.len() > LANES {
            self.fill_rest(program, columns, varying, out);
        }
    }

    /// The real values of the blocks after the first: apart, so that less is kept aside in a batch of one block.
    #[inline(never)]
    fn fill_rest(&mut self, program: &Program, columns: &[Column<'_>], varying: u64, out: &mut [f64]) {
        for (block, out) in out.chunks_mut(LANES).enumerate().skip(1) {
            self.next(columns, varying, block * LANES, out.len());
            self.values(program, varying, out);
        }
    }

    /// The real values of a block of which the columns have been loaded.
    #[inline(always)]
    fn values(&mut self, program: &Program, varying: u64, out: &mut [f64]) {
        match program.steps.split_last() {
            // the last step, which is the root's, writes where the values are wanted
            Some((last, before)) if last.depends & varying != 0 => {
                self.varying(before, varying, out.len());
                last.real_value(&self.real, &self.complex, out);
            }
            _ => out.copy_from_slice(self.real[program.root].lanes(out.len())),
        }
    }

    /// The values as complex numbers.
    #[inline(never)]
    fn fill_complex(&mut self, program: &Program, columns: &[Column<'_>], out: &mut [C]) {
        let varying = self.first(program, columns, out.len());
        for (block, out) in out.chunks_mut(LANES).enumerate() {
            if block > 0 {
                self.next(columns, varying, block * LANES, out.len());
            }
            self.varying(&program.steps, varying, out.len());
            if program.kind == Kind::Real {
                lanes::promoted(out, self.real[program.root].lanes(out.len()));
            } else {
                out.copy_from_slice(self.complex[program.root].lanes(out.len()));
            }
        }
    }

    /// What is the same in all lanes, and the columns of the first block. Bit k tells whether column k is needed, and not
    /// the same.
    #[inline(always)]
    fn first(&mut self, program: &Program, columns: &[Column<'_>], all: usize) -> u64 {
        self.prepare(program);
        let lanes = all.min(LANES);
        let mut varying = 0;
        for (k, (register, column)) in self.real.iter_mut().zip(columns).enumerate() {
            match column {
                Column::Same(value) => register.spread(*value, lanes),
                Column::Each(values) => {
                    assert!(values.len() == all, "a column has a value for each lane");
                    if program.depends >> k & 1 == 1 {
                        varying |= 1 << k;
                        register.load(&values[..lanes]);
                    }
                }
            }
        }
        for step in program.steps.iter().filter(|step| step.depends & varying == 0) {
            self.once(step, lanes);
        }
        varying
    }

    /// The columns of a block after the first.
    #[inline(always)]
    fn next(&mut self, columns: &[Column<'_>], varying: u64, start: usize, lanes: usize) {
        for (k, (register, column)) in self.real.iter_mut().zip(columns).enumerate() {
            if let Column::Each(values) = column
                && varying >> k & 1 == 1
            {
                register.load(&values[start..start + lanes]);
            }
        }
    }

    /// Those of these steps of which the value is not the same in all lanes.
    #[inline(always)]
    fn varying(&mut self, steps: &[Step], varying: u64, lanes: usize) {
        for step in steps.iter().filter(|step| step.depends & varying != 0) {
            self.run(step, lanes);
        }
    }

    /// One step. Its register lies behind those that it reads.
    #[inline(always)]
    fn run(&mut self, step: &Step, lanes: usize) {
        if step.real {
            let (before, rest) = self.real.split_at_mut(step.register);
            step.real_value(before, &self.complex, &mut rest[0].0[..lanes]);
        } else {
            let (before, rest) = self.complex.split_at_mut(step.register);
            lanes::complex(step, &self.real, before, &mut rest[0].0[..lanes]);
        }
    }

    /// One step, whose value is the same in so many lanes. It is found beside its register, whose first lane would not be
    /// written again with the others, and vectors that were written in two parts are read slowly.
    #[inline(never)]
    fn once(&mut self, step: &Step, lanes: usize) {
        if step.real {
            let mut value = [0.0];
            step.real_value(&self.real, &self.complex, &mut value);
            self.real[step.register].spread(value[0], lanes);
        } else {
            let mut value = [C::ZERO];
            lanes::complex(step, &self.real, &self.complex, &mut value);
            self.complex[step.register].spread(value[0], lanes);
        }
    }
}

impl Step {
    #[inline(always)]
    fn real_value(&self, real: &[Block<f64>], complex: &[Block<C>], out: &mut [f64]) {
        if self.real_arguments[0] {
            (self.kernel)(self, real, out);
        } else {
            lanes::real_of_complex(self, complex, out);
        }
    }
}
