//! A program over columns, block by block: what is the same in all lanes once, the rest for each block.

use crate::graph::Kind;
use crate::lanes::{self, Block, LANES};
use crate::operation::Operation;
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
            registers.prepare(self);
            registers.point(self, point);
            registers.real[self.root][0]
        })
    }

    /// The value at a point, as a complex number.
    pub fn at_complex(&self, point: &[f64]) -> C {
        REGISTERS.with_borrow_mut(|registers| {
            registers.prepare(self);
            registers.point(self, point);
            match self.kind {
                Kind::Real => registers.real[self.root][0].into(),
                Kind::Complex => registers.complex[self.root][0],
            }
        })
    }

    /// The real values, one a lane.
    pub fn fill(&self, columns: &[Column<'_>], out: &mut [f64]) {
        REGISTERS.with_borrow_mut(|registers| {
            let varying = registers.start(self, columns);
            for (block, out) in out.chunks_mut(LANES).enumerate() {
                registers.block(self, columns, varying, block * LANES, out.len());
                copy(&registers.real[self.root], out);
            }
        });
    }

    /// The values as complex numbers, one a lane.
    pub fn fill_complex(&self, columns: &[Column<'_>], out: &mut [C]) {
        REGISTERS.with_borrow_mut(|registers| {
            let varying = registers.start(self, columns);
            for (block, out) in out.chunks_mut(LANES).enumerate() {
                registers.block(self, columns, varying, block * LANES, out.len());
                match self.kind {
                    Kind::Real => copy(&lanes::promoted(&registers.real[self.root]), out),
                    Kind::Complex => copy(&registers.complex[self.root], out),
                }
            }
        });
    }
}

/// The first lanes; a whole block as one move of known length.
#[inline(always)]
fn copy<T: Copy>(block: &Block<T>, out: &mut [T]) {
    match <&mut Block<T>>::try_from(&mut *out) {
        Ok(out) => *out = *block,
        Err(_) => out.copy_from_slice(&block[..out.len()]),
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
            self.real.resize(real, [0.0; LANES]);
        }
        if self.complex.len() < complex {
            self.complex.resize(complex, [C::ZERO; LANES]);
        }
        program.constants.iter().for_each(|(register, value)| self.real[*register] = [*value; LANES]);
        program.complex_constants.iter().for_each(|(register, value)| self.complex[*register] = [*value; LANES]);
        self.owner = program.identity;
    }

    /// All steps, at one point.
    fn point(&mut self, program: &Program, point: &[f64]) {
        self.real.iter_mut().zip(point).for_each(|(register, value)| *register = [*value; LANES]);
        program.steps.iter().for_each(|step| self.run(step, 1));
    }

    /// What is the same in all lanes; then bit k tells whether column k is not.
    #[inline]
    fn start(&mut self, program: &Program, columns: &[Column<'_>]) -> u64 {
        self.prepare(program);
        let mut varying = 0;
        for (k, column) in columns.iter().enumerate() {
            match column {
                Column::Same(value) => self.real[k] = [*value; LANES],
                Column::Each(_) => varying |= 1 << k,
            }
        }
        for step in program.steps.iter().filter(|step| step.depends & varying == 0) {
            self.run(step, 1);
        }
        varying
    }

    /// What is not, for the block that starts at lane `start`.
    #[inline]
    fn block(&mut self, program: &Program, columns: &[Column<'_>], varying: u64, start: usize, lanes: usize) {
        for (k, column) in columns.iter().enumerate() {
            if let Column::Each(values) = column {
                match values[start..].first_chunk() {
                    Some(block) => self.real[k] = *block,
                    None => self.real[k][..lanes].copy_from_slice(&values[start..start + lanes]),
                }
            }
        }
        for step in program.steps.iter().filter(|step| step.depends & varying != 0) {
            self.run(step, lanes);
        }
    }

    /// One step, on the first lanes at least.
    #[inline(always)]
    fn run(&mut self, step: &Step, lanes: usize) {
        if step.real {
            self.real[step.register] = self.real_value(step, lanes);
        } else {
            self.complex[step.register] = self.complex_value(step, lanes);
        }
    }

    #[inline(always)]
    fn real_value(&self, step: &Step, lanes: usize) -> Block<f64> {
        let [a, b, c] = step.arguments;
        match step.operation {
            Operation::Unary(operation) if step.real_arguments[0] => {
                lanes::unary(operation, &self.real[a], lanes)
            }
            Operation::Unary(operation) => lanes::real_of_complex(operation, &self.complex[a], lanes),
            Operation::Binary(operation) if step.real_arguments[0] => {
                lanes::binary(operation, &self.real[a], &self.real[b], lanes)
            }
            Operation::Binary(operation) => lanes::comparison(operation, &self.complex[a], &self.complex[b]),
            Operation::Power(n) => lanes::powers(n, &self.real[a], lanes),
            Operation::Select => lanes::selection(&self.real[a], &self.real[b], &self.real[c], f64::NAN),
            // these are no steps of real value
            Operation::Constant(_) | Operation::Variable(_) | Operation::Promote => [f64::NAN; LANES],
        }
    }

    fn complex_value(&self, step: &Step, lanes: usize) -> Block<C> {
        let [a, b, c] = step.arguments;
        let (real, complex) = (&self.real, &self.complex);
        let undefined = C::new(f64::NAN, f64::NAN);
        match step.operation {
            Operation::Unary(operation) => lanes::complex_unary(operation, &complex[a], lanes),
            Operation::Binary(operation) => match step.real_arguments {
                [true, ..] => lanes::arithmetic(operation, &real[a], &complex[b]),
                [_, true, _] => lanes::arithmetic(operation, &complex[a], &real[b]),
                _ => lanes::complex_binary(operation, &complex[a], &complex[b], lanes),
            },
            Operation::Power(n) => lanes::complex_powers(n, &complex[a], lanes),
            Operation::Select => lanes::selection(&real[a], &complex[b], &complex[c], undefined),
            Operation::Promote => lanes::promoted(&real[a]),
            // these are no steps
            Operation::Constant(_) | Operation::Variable(_) => [undefined; LANES],
        }
    }
}
