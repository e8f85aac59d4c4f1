//! A program over columns, block by block: what is the same in all lanes once, the rest for each block.

use crate::graph::Kind;
use crate::lanes::{self, Block, LANES};
use crate::operation::Operation;
use crate::program::{Action, Program, Step};
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

/// A batch as short as this is worth short loops: half of its time is the way there.
const SHORT: usize = 16;

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
            match self.kind {
                Kind::Real => registers.real[self.root].0[0].into(),
                Kind::Complex => registers.complex[self.root].0[0],
            }
        })
    }

    /// The real values, one a lane.
    pub fn fill(&self, columns: &[Column<'_>], out: &mut [f64]) {
        self.blocks(columns, out, |registers, out| copy(&registers.real[self.root], out));
    }

    /// The values as complex numbers, one a lane.
    pub fn fill_complex(&self, columns: &[Column<'_>], out: &mut [C]) {
        self.blocks(columns, out, |registers, out| match self.kind {
            Kind::Real => out.iter_mut().zip(&registers.real[self.root].0).for_each(|(out, x)| *out = C::from(x)),
            Kind::Complex => copy(&registers.complex[self.root], out),
        });
    }

    /// Runs the program over a batch; `take` takes the results of each block.
    #[inline(always)]
    fn blocks<T>(&self, columns: &[Column<'_>], out: &mut [T], take: impl Fn(&Registers, &mut [T])) {
        REGISTERS.with_borrow_mut(|registers| {
            registers.prepare(self);
            if out.len() <= SHORT {
                registers.batch::<SHORT, T>(self, columns, out, take);
            } else {
                registers.batch::<LANES, T>(self, columns, out, take);
            }
        });
    }
}

/// The first lanes; 16 or 64 as moves of known length, which need no call.
#[inline(always)]
fn copy<T: Copy>(block: &Block<T>, out: &mut [T]) {
    match out.len() {
        SHORT => out.copy_from_slice(&block.0[..SHORT]),
        LANES => out.copy_from_slice(&block.0),
        lanes => out.copy_from_slice(&block.0[..lanes]),
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
        program.steps.iter().for_each(|step| self.run::<1>(step, 1));
    }

    /// What is the same in all lanes once; what is not, for each block of N.
    #[inline(always)]
    fn batch<const N: usize, T>(
        &mut self,
        program: &Program,
        columns: &[Column<'_>],
        out: &mut [T],
        take: impl Fn(&Registers, &mut [T]),
    ) {
        let mut varying = 0;
        for (k, column) in columns.iter().enumerate() {
            match column {
                Column::Same(value) => self.real[k].0[..N].fill(*value),
                Column::Each(_) => varying |= 1 << k,
            }
        }
        for step in program.steps.iter().filter(|step| step.depends & varying == 0) {
            self.run::<N>(step, 1);
        }
        for (block, out) in out.chunks_mut(N).enumerate() {
            self.load::<N>(columns, block * N, out.len());
            for step in program.steps.iter().filter(|step| step.depends & varying != 0) {
                self.run::<N>(step, out.len());
            }
            take(self, out);
        }
    }

    /// The columns that differ from lane to lane, from lane `start` on.
    #[inline(always)]
    fn load<const N: usize>(&mut self, columns: &[Column<'_>], start: usize, lanes: usize) {
        for (register, column) in self.real.iter_mut().zip(columns) {
            if let Column::Each(values) = column {
                match values[start..].first_chunk::<N>() {
                    Some(block) => register.0[..N].copy_from_slice(block),
                    None => register.0[..lanes].copy_from_slice(&values[start..start + lanes]),
                }
            }
        }
    }

    /// One step, on the first lanes at least and on no more than N. Its register lies behind those that it reads.
    #[inline(always)]
    fn run<const N: usize>(&mut self, step: &Step, lanes: usize) {
        if step.real {
            let (before, rest) = self.real.split_at_mut(step.register);
            step.real_value::<N>(&mut rest[0], before, &self.complex, lanes);
        } else {
            let (before, rest) = self.complex.split_at_mut(step.register);
            step.complex_value::<N>(&mut rest[0], &self.real, before, lanes);
        }
    }
}

impl Step {
    #[inline(always)]
    fn real_value<const N: usize>(
        &self,
        out: &mut Block<f64>,
        real: &[Block<f64>],
        complex: &[Block<C>],
        lanes: usize,
    ) {
        let [a, b, c] = self.arguments;
        let operation = match self.action {
            Action::One(operation) => operation,
            Action::Two(first, second) => {
                return lanes::fused::<N>(first, second, out, [&real[a], &real[b], &real[c]]);
            }
        };
        match operation {
            Operation::Unary(operation) if self.real_arguments[0] => {
                lanes::unary::<N>(operation, out, &real[a], lanes);
            }
            Operation::Unary(operation) => lanes::real_of_complex::<N>(operation, out, &complex[a], lanes),
            Operation::Binary(operation) if self.real_arguments[0] => {
                lanes::binary::<N>(operation, out, &real[a], &real[b], lanes);
            }
            Operation::Binary(operation) => lanes::comparison::<N>(operation, out, &complex[a], &complex[b]),
            Operation::Power(n) => lanes::powers::<N>(n, out, &real[a], lanes),
            Operation::Select => lanes::selection::<N, _>(out, &real[a], &real[b], &real[c], f64::NAN),
            // these are no steps of real value
            Operation::Constant(_) | Operation::Variable(_) | Operation::Promote => out.0.fill(f64::NAN),
        }
    }

    fn complex_value<const N: usize>(
        &self,
        out: &mut Block<C>,
        real: &[Block<f64>],
        complex: &[Block<C>],
        lanes: usize,
    ) {
        let [a, b, c] = self.arguments;
        let undefined = C::new(f64::NAN, f64::NAN);
        let Action::One(operation) = self.action else { return }; // two are always real
        match operation {
            Operation::Unary(operation) => lanes::complex_unary::<N>(operation, out, &complex[a], lanes),
            Operation::Binary(operation) => match self.real_arguments {
                [true, ..] => lanes::arithmetic::<N, _, _>(operation, out, &real[a], &complex[b]),
                [_, true, _] => lanes::arithmetic::<N, _, _>(operation, out, &complex[a], &real[b]),
                _ => lanes::complex_binary::<N>(operation, out, &complex[a], &complex[b], lanes),
            },
            Operation::Power(n) => lanes::complex_powers::<N>(n, out, &complex[a], lanes),
            Operation::Select => {
                lanes::selection::<N, _>(out, &real[a], &complex[b], &complex[c], undefined);
            }
            Operation::Promote => lanes::promoted::<N>(out, &real[a]),
            // these are no steps
            Operation::Constant(_) | Operation::Variable(_) => out.0.fill(undefined),
        }
    }
}
