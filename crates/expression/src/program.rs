//! A graph becomes a list of steps, each of which fills a register of its own.

use crate::fuse::{Fusion, Outer, fusions};
use crate::graph::{Graph, Kind, Node};
use crate::lanes::{Kernel, kernel};
use crate::operation::Operation;
use num_complex::Complex;
use std::sync::atomic::{AtomicU64, Ordering};

/// What a step does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Action {
    One(Operation),
    /// The first two arguments combined, or three by their sign, then the last.
    Two(Operation, Outer),
    /// What the operation chooses of two arguments, times the outer one of what it leaves and of the last.
    ChosenAndLeft(Operation, Outer),
}

/// One action: on the registers of its arguments, into its own.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    pub action: Action,
    /// The loop that does it, if the arguments are real.
    pub kernel: Kernel,
    /// Registers, as many as the action has arguments; the rest is not read.
    pub arguments: [usize; 4],
    pub register: usize,
    /// Whether the result is real, and whether each argument is: real and complex numbers have registers apart.
    pub real: bool,
    pub real_arguments: [bool; 4],
    /// Bit k: the result depends on column k.
    pub depends: u64,
}

/// Registers with their numbers in front: the columns, the constants, then one for each step. None is used twice: what
/// is the same for a whole batch stays where it is, and a register is small.
#[derive(Debug)]
pub(crate) struct Program {
    /// Tells programs apart: registers that hold one's constants need not be filled with them again.
    pub identity: u64,
    pub columns: usize,
    pub constants: Vec<(usize, f64)>,
    pub complex_constants: Vec<(usize, Complex<f64>)>,
    pub steps: Vec<Step>,
    /// Registers of real and of complex numbers.
    pub registers: [usize; 2],
    /// The register of the result.
    pub root: usize,
    pub kind: Kind,
    pub depends: u64,
}

impl Program {
    pub fn new(graph: &Graph, root: Node, columns: usize) -> Self {
        static COUNT: AtomicU64 = AtomicU64::new(1);
        let facts = graph.facts(root);
        let mut program = Program {
            identity: COUNT.fetch_add(1, Ordering::Relaxed),
            columns,
            constants: Vec::new(),
            complex_constants: Vec::new(),
            steps: Vec::new(),
            registers: [columns, 0],
            root: 0,
            kind: facts.kind,
            depends: facts.depends,
        };
        let mut registers = vec![0; root + 1];
        let order = reachable(graph, root);
        let fusions = fusions(graph, &order);
        let mut swallowed = vec![false; root + 1];
        fusions
            .iter()
            .flatten()
            .flat_map(|fusion| &fusion.swallowed)
            .for_each(|node| swallowed[*node] = true);
        for node in order.into_iter().filter(|node| !swallowed[*node]) {
            registers[node] = program.compile(graph, node, fusions[node].as_ref(), &registers);
        }
        program.root = registers[root];
        program
    }

    /// Adds a node whose arguments have been added; its register.
    fn compile(&mut self, graph: &Graph, node: Node, fusion: Option<&Fusion>, registers: &[usize]) -> usize {
        let facts = graph.facts(node);
        if let Operation::Variable(column) = facts.operation {
            return column;
        }
        let register = self.registers[facts.kind as usize];
        self.registers[facts.kind as usize] += 1;
        let step = |action: Action, nodes: &[Node]| {
            let mut arguments = [0; 4];
            let mut real_arguments = [true; 4];
            for (k, argument) in nodes.iter().enumerate() {
                arguments[k] = registers[*argument];
                real_arguments[k] = graph.is_real(*argument);
            }
            let (real, depends) = (facts.kind == Kind::Real, facts.depends);
            Step { action, kernel: kernel(action), arguments, register, real, real_arguments, depends }
        };
        match (facts.operation, facts.kind, fusion) {
            (Operation::Constant(value), Kind::Real, _) => {
                self.constants.push((register, Complex::from(value).re));
            }
            (Operation::Constant(value), Kind::Complex, _) => {
                self.complex_constants.push((register, value.into()));
            }
            (_, _, Some(fusion)) => self.steps.push(step(fusion.action, &fusion.arguments)),
            (operation, _, None) => self.steps.push(step(Action::One(operation), &facts.arguments)),
        }
        register
    }
}

/// The nodes that `root` needs, arguments first.
fn reachable(graph: &Graph, root: Node) -> Vec<Node> {
    let mut needed = vec![false; root + 1];
    needed[root] = true;
    for node in (0..=root).rev() {
        if needed[node] {
            graph.facts(node).arguments.iter().for_each(|argument| needed[*argument] = true);
        }
    }
    (0..=root).filter(|node| needed[*node]).collect()
}
