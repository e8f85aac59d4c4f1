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

/// A batch as short as this has loops of its own: four times as many lanes as it needs would double its time.
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
        REGISTERS.with_borrow_mut(|registers| {
            registers.prepare(self);
            if out.len() <= SHORT {
                registers.batch::<SHORT>(self, columns, out);
            } else {
                registers.batch::<LANES>(self, columns, out);
            }
        });
    }

    /// The values as complex numbers, one a lane.
    pub fn fill_complex(&self, columns: &[Column<'_>], out: &mut [C]) {
        REGISTERS.with_borrow_mut(|registers| {
            registers.prepare(self);
            let varying = registers.uniform::<LANES>(self, columns);
            for (block, out) in out.chunks_mut(LANES).enumerate() {
                registers.partial::<LANES>(self, columns, varying, block * LANES, out.len());
                match self.kind {
                    Kind::Real => {
                        let values = registers.real[self.root].0.iter();
                        out.iter_mut().zip(values).for_each(|(out, value)| *out = value.into());
                    }
                    Kind::Complex => out.copy_from_slice(&registers.complex[self.root].0[..out.len()]),
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
        program.steps.iter().for_each(|step| self.run::<1>(step, 1, Window::NONE));
    }

    /// The real values of a batch, in blocks of N.
    #[inline(always)]
    fn batch<const N: usize>(&mut self, program: &Program, columns: &[Column<'_>], out: &mut [f64]) {
        let varying = self.uniform::<N>(program, columns);
        let whole = match program.steps.split_last() {
            Some((last, before)) if last.depends & varying != 0 => {
                let (blocks, _) = out.as_chunks_mut::<N>();
                for (block, out) in blocks.iter_mut().enumerate() {
                    let window = Window { columns, start: block * N };
                    for step in before.iter().filter(|step| step.depends & varying != 0) {
                        self.run::<N>(step, N, window);
                    }
                    last.real_value::<N>(out, &self.real, &self.complex, N, window);
                }
                blocks.len() * N
            }
            _ => 0,
        };
        for (block, out) in out[whole..].chunks_mut(N).enumerate() {
            self.partial::<N>(program, columns, varying, whole + block * N, out.len());
            out.copy_from_slice(&self.real[program.root].0[..out.len()]);
        }
    }

    /// What is the same in all lanes; then bit k tells whether column k is not.
    #[inline(always)]
    fn uniform<const N: usize>(&mut self, program: &Program, columns: &[Column<'_>]) -> u64 {
        let mut varying = 0;
        for (k, column) in columns.iter().enumerate() {
            match column {
                Column::Same(value) => self.real[k].0[..N].fill(*value),
                Column::Each(_) => varying |= 1 << k,
            }
        }
        for step in program.steps.iter().filter(|step| step.depends & varying == 0) {
            self.run::<N>(step, 1, Window::NONE);
        }
        varying
    }

    /// What is not, for the first lanes of the block that starts at lane `start`.
    fn partial<const N: usize>(
        &mut self,
        program: &Program,
        columns: &[Column<'_>],
        varying: u64,
        start: usize,
        lanes: usize,
    ) {
        for (register, column) in self.real.iter_mut().zip(columns) {
            if let Column::Each(values) = column {
                register.0[..lanes].copy_from_slice(&values[start..start + lanes]);
            }
        }
        for step in program.steps.iter().filter(|step| step.depends & varying != 0) {
            self.run::<N>(step, lanes, Window::NONE);
        }
    }

    /// One step, on the first lanes at least and on no more than N. Its register lies behind those that it reads.
    #[inline(always)]
    fn run<const N: usize>(&mut self, step: &Step, lanes: usize, window: Window<'_>) {
        if step.real {
            let (before, rest) = self.real.split_at_mut(step.register);
            step.real_value::<N>(rest[0].first_mut(), before, &self.complex, lanes, window);
        } else {
            let (before, rest) = self.complex.split_at_mut(step.register);
            step.complex_value::<N>(rest[0].first_mut(), &self.real, before, lanes, window);
        }
    }
}

/// Where a whole block of the columns can be read in place.
#[derive(Clone, Copy)]
struct Window<'a> {
    columns: &'a [Column<'a>],
    start: usize,
}

impl<'a> Window<'a> {
    /// The columns are in their registers.
    const NONE: Window<'static> = Window { columns: &[], start: 0 };

    /// An argument: a column in place, or a register.
    #[inline(always)]
    fn real<'b, const N: usize>(self, registers: &'b [Block<f64>], argument: usize) -> &'b [f64; N]
    where
        'a: 'b,
    {
        if let Some(Column::Each(values)) = self.columns.get(argument)
            && let Some(values) = values[self.start..].first_chunk()
        {
            return values;
        }
        registers[argument].first()
    }
}

impl Step {
    #[inline(always)]
    fn real_value<const N: usize>(
        &self,
        out: &mut [f64; N],
        real: &[Block<f64>],
        complex: &[Block<C>],
        lanes: usize,
        window: Window<'_>,
    ) {
        let [a, b, c] = self.arguments;
        let real = |argument: usize| window.real::<N>(real, argument);
        let complex = |argument: usize| complex[argument].first::<N>();
        let operation = match self.action {
            Action::One(operation) => operation,
            Action::Two(first, second) => {
                return lanes::fused(first, second, out, [real(a), real(b), real(c)]);
            }
        };
        match operation {
            Operation::Unary(operation) if self.real_arguments[0] => {
                lanes::unary(operation, out, real(a), lanes);
            }
            Operation::Unary(operation) => lanes::real_of_complex(operation, out, complex(a), lanes),
            Operation::Binary(operation) if self.real_arguments[0] => {
                lanes::binary(operation, out, real(a), real(b), lanes);
            }
            Operation::Binary(operation) => lanes::comparison(operation, out, complex(a), complex(b)),
            Operation::Power(n) => lanes::powers(n, out, real(a), lanes),
            Operation::Select => lanes::selection(out, real(a), real(b), real(c), f64::NAN),
            // these are no steps of real value
            Operation::Constant(_) | Operation::Variable(_) | Operation::Promote => out.fill(f64::NAN),
        }
    }

    #[inline(never)]
    fn complex_value<const N: usize>(
        &self,
        out: &mut [C; N],
        real: &[Block<f64>],
        complex: &[Block<C>],
        lanes: usize,
        window: Window<'_>,
    ) {
        let [a, b, c] = self.arguments;
        let real = |argument: usize| window.real::<N>(real, argument);
        let complex = |argument: usize| complex[argument].first::<N>();
        let undefined = C::new(f64::NAN, f64::NAN);
        let Action::One(operation) = self.action else { return }; // two are always real
        match operation {
            Operation::Unary(operation) => lanes::complex_unary(operation, out, complex(a), lanes),
            Operation::Binary(operation) => match self.real_arguments {
                [true, false, _] => lanes::arithmetic(operation, out, real(a), complex(b)),
                [false, true, _] => lanes::arithmetic(operation, out, complex(a), real(b)),
                _ => lanes::complex_binary(operation, out, complex(a), complex(b), lanes),
            },
            Operation::Power(n) => lanes::complex_powers(n, out, complex(a), lanes),
            Operation::Select => lanes::selection(out, real(a), complex(b), complex(c), undefined),
            Operation::Promote => lanes::promoted(out, real(a)),
            // these are no steps
            Operation::Constant(_) | Operation::Variable(_) => out.fill(undefined),
        }
    }
}
