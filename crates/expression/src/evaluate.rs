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
        REGISTERS.with_borrow_mut(|registers| {
            let varying = registers.uniform(self, columns, out.len());
            for (block, out) in out.chunks_mut(LANES).enumerate() {
                let window = Window { columns, start: block * LANES, lanes: out.len() };
                match self.steps.split_last() {
                    // the last step, which is the root's, writes where the values are wanted
                    Some((last, before)) if last.depends & varying != 0 => {
                        registers.varying(before, varying, window);
                        last.real_value(out, &registers.real, &registers.complex, window);
                    }
                    _ => out.copy_from_slice(window.real(&registers.real, self.root)),
                }
            }
        });
    }

    /// The values as complex numbers, one a lane.
    pub fn fill_complex(&self, columns: &[Column<'_>], out: &mut [C]) {
        REGISTERS.with_borrow_mut(|registers| {
            let varying = registers.uniform(self, columns, out.len());
            for (block, out) in out.chunks_mut(LANES).enumerate() {
                let window = Window { columns, start: block * LANES, lanes: out.len() };
                registers.varying(&self.steps, varying, window);
                match self.kind {
                    Kind::Real => lanes::promoted(out, window.real(&registers.real, self.root)),
                    Kind::Complex => out.copy_from_slice(window.complex(&registers.complex, self.root)),
                }
            }
        });
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
        program.steps.iter().for_each(|step| self.run(step, Window::POINT));
    }

    /// What is the same in all lanes; then bit k tells whether column k is not.
    #[inline(always)]
    fn uniform(&mut self, program: &Program, columns: &[Column<'_>], lanes: usize) -> u64 {
        self.prepare(program);
        let mut varying = 0;
        for (k, (register, column)) in self.real.iter_mut().zip(columns).enumerate() {
            match column {
                Column::Same(value) => register.spread(*value, lanes),
                Column::Each(_) => varying |= 1 << k,
            }
        }
        for step in program.steps.iter().filter(|step| step.depends & varying == 0) {
            self.run(step, Window::POINT);
            if step.real {
                let register = &mut self.real[step.register];
                register.spread(register.0[0], lanes);
            } else {
                let register = &mut self.complex[step.register];
                register.spread(register.0[0], lanes);
            }
        }
        varying
    }

    /// What is not, of these steps.
    #[inline(always)]
    fn varying(&mut self, steps: &[Step], varying: u64, window: Window<'_>) {
        for step in steps.iter().filter(|step| step.depends & varying != 0) {
            self.run(step, window);
        }
    }

    /// One step. Its register lies behind those that it reads.
    #[inline(always)]
    fn run(&mut self, step: &Step, window: Window<'_>) {
        if step.real {
            let (before, rest) = self.real.split_at_mut(step.register);
            step.real_value(&mut rest[0].0[..window.lanes], before, &self.complex, window);
        } else {
            let (before, rest) = self.complex.split_at_mut(step.register);
            step.complex_value(&mut rest[0].0[..window.lanes], &self.real, before, window);
        }
    }
}

/// Some lanes, at most as many as a register has: columns are read in place.
#[derive(Clone, Copy)]
struct Window<'a> {
    columns: &'a [Column<'a>],
    start: usize,
    lanes: usize,
}

impl<'a> Window<'a> {
    /// One lane, and the columns are in their registers.
    const POINT: Window<'static> = Window { columns: &[], start: 0, lanes: 1 };

    /// An argument: a column in place, or a register.
    #[inline(always)]
    fn real<'b>(self, registers: &'b [Block<f64>], argument: usize) -> &'b [f64]
    where
        'a: 'b,
    {
        match self.columns.get(argument) {
            Some(Column::Each(values)) => &values[self.start..self.start + self.lanes],
            _ => &registers[argument].0[..self.lanes],
        }
    }

    /// An argument that is complex.
    fn complex(self, registers: &[Block<C>], argument: usize) -> &[C] {
        &registers[argument].0[..self.lanes]
    }
}

impl Step {
    #[inline(always)]
    fn real_value(&self, out: &mut [f64], real: &[Block<f64>], complex: &[Block<C>], window: Window<'_>) {
        if self.real_arguments[0] {
            let [a, b, c] = self.arguments;
            let arguments = [window.real(real, a), window.real(real, b), window.real(real, c)];
            (self.kernel)(&self.action, out, arguments);
        } else {
            self.real_of_complex(out, complex, window);
        }
    }

    #[inline(never)]
    fn real_of_complex(&self, out: &mut [f64], complex: &[Block<C>], window: Window<'_>) {
        let [a, b, _] = self.arguments;
        let complex = |argument: usize| window.complex(complex, argument);
        match self.action {
            Action::One(Operation::Unary(operation)) => lanes::real_of_complex(operation, out, complex(a)),
            Action::One(Operation::Binary(operation)) => {
                lanes::comparison(operation, out, complex(a), complex(b));
            }
            _ => out.fill(f64::NAN), // the others are never real
        }
    }

    #[inline(never)]
    fn complex_value(&self, out: &mut [C], real: &[Block<f64>], complex: &[Block<C>], window: Window<'_>) {
        let [a, b, c] = self.arguments;
        let real = |argument: usize| window.real(real, argument);
        let complex = |argument: usize| window.complex(complex, argument);
        let undefined = C::new(f64::NAN, f64::NAN);
        let Action::One(operation) = self.action else { return }; // two are always real
        match operation {
            Operation::Unary(operation) => lanes::complex_unary(operation, out, complex(a)),
            Operation::Binary(operation) => match self.real_arguments {
                [true, false, _] => lanes::arithmetic(operation, out, real(a), complex(b)),
                [false, true, _] => lanes::arithmetic(operation, out, complex(a), real(b)),
                _ => lanes::complex_binary(operation, out, complex(a), complex(b)),
            },
            Operation::Power(n) => lanes::complex_powers(n, out, complex(a)),
            Operation::Select => lanes::complex_selection(out, real(a), complex(b), complex(c), undefined),
            Operation::Promote => lanes::promoted(out, real(a)),
            // these are no steps of complex value
            Operation::Constant(_) | Operation::Variable(_) | Operation::BySign => out.fill(undefined),
        }
    }
}
