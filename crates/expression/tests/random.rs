//! Formulas that nobody would write: nothing panics, and a batch is what its points are.

use expression::{Column, Formula, functions};
use num_complex::Complex;

/// xorshift64*: the same numbers in every run.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33) as usize % bound
    }

    fn one_of<'a, T: ?Sized>(&mut self, choices: &[&'a T]) -> &'a T {
        choices[self.below(choices.len())]
    }
}

const VARIABLES: [&str; 2] = ["x", "y"];

/// A formula of some depth; with complex numbers if `complex`.
fn formula(random: &mut Random, depth: usize, complex: bool) -> String {
    if depth == 0 {
        let leaves: &[&str] =
            if complex { &["x", "y", "2", "i", "0.5"] } else { &["x", "y", "2", "-1", "0.5", "pi"] };
        return random.one_of(leaves).to_string();
    }
    let mut part = || formula(random, depth - 1, complex);
    let (a, b, c) = (part(), part(), part());
    match random.below(8) {
        0..4 => format!("({a}){}({b})", random.one_of(&["+", "-", "*", "/"])),
        4 => format!("({a})^{}", random.one_of(&["2", "3", "-1", "0.5", "(-3/2)", "y", "(1/3)", "9"])),
        5 if complex => {
            format!("{}({a})", random.one_of(&["exp", "sin", "sqrt", "conj", "abs", "imag", "tanh"]))
        }
        5 => format!("if(({a})<({b}),{b},{c})"),
        6 if complex => format!("if(real({a})>0,{b},{c})"),
        6 => format!("{}({a},{b})", random.one_of(&["min", "max", "atan2", "mod"])),
        _ => format!("{}({a})", random.one_of(&["abs", "exp", "cos", "ln", "-", "atan", "log10"])),
    }
}

/// Equal to the last bit, or both undefined.
fn same(a: f64, b: f64) -> bool {
    a == b || (a.is_nan() && b.is_nan())
}

#[test]
fn a_batch_is_its_points() {
    let mut random = Random(1);
    for round in 0..2000 {
        let text = formula(&mut random, 1 + round % 5, false);
        let formula = Formula::parse(&text, &VARIABLES).unwrap_or_else(|error| panic!("{error}"));
        let lanes = [1, 2, 15, 16, 17, 63, 64, 65, 150][round % 9];
        let y: Vec<f64> = (0..lanes).map(|_| random.below(2000) as f64 / 500.0 - 2.0).collect();
        let x: Vec<f64> = y.iter().rev().map(|y| y + 0.25).collect();
        let mut out = vec![0.0; lanes];
        formula.fill(&[Column::Each(&x), Column::Each(&y)], &mut out);
        for k in 0..lanes {
            let exact = formula.at(&[x[k], y[k]]);
            assert!(same(out[k], exact), "{text} at {} {}: {} is not {exact}", x[k], y[k], out[k]);
        }
        formula.fill(&[Column::Same(0.7), Column::Each(&y)], &mut out);
        for k in 0..lanes {
            assert!(same(out[k], formula.at(&[0.7, y[k]])), "{text} at 0.7 {}", y[k]);
        }
        formula.fill(&[Column::Same(0.7), Column::Same(0.2)], &mut out);
        assert!(out.iter().all(|out| same(*out, formula.at(&[0.7, 0.2]))), "{text}");
    }
}

#[test]
fn a_complex_batch_is_its_points() {
    let mut random = Random(2);
    for round in 0..1000 {
        let text = formula(&mut random, 1 + round % 4, true);
        let formula = Formula::parse(&text, &VARIABLES).unwrap_or_else(|error| panic!("{error}"));
        let lanes = [1, 16, 17, 64, 130][round % 5];
        let y: Vec<f64> = (0..lanes).map(|_| random.below(2000) as f64 / 500.0 - 2.0).collect();
        let mut out = vec![Complex::ZERO; lanes];
        formula.fill_complex(&[Column::Same(0.7), Column::Each(&y)], &mut out);
        for k in 0..lanes {
            let exact = formula.at_complex(&[0.7, y[k]]);
            assert!(
                same(out[k].re, exact.re) && same(out[k].im, exact.im),
                "{text} at {}: {} is not {exact}",
                y[k],
                out[k]
            );
        }
    }
}

#[test]
fn what_is_written_for_another_has_its_value() {
    // folding, common sub-expressions and quick powers against the same formula with constants as columns
    let mut random = Random(3);
    for round in 0..1000 {
        let text = formula(&mut random, 1 + round % 4, false);
        let folded = Formula::parse(
            &text.replace('x', "(0.75)").replace("ma(0.75)", "max").replace("e(0.75)p", "exp"),
            &VARIABLES,
        );
        let (folded, plain) =
            (folded.unwrap().at(&[0.75, 0.5]), Formula::parse(&text, &VARIABLES).unwrap().at(&[0.75, 0.5]));
        assert!(
            same(folded, plain) || (folded - plain).abs() <= 1e-12 * plain.abs(),
            "{text}: {folded}, {plain}"
        );
    }
}

#[test]
fn no_text_panics() {
    let mut random = Random(4);
    let mut words: Vec<&str> =
        functions().iter().filter_map(|(signature, _)| signature.split('(').next()).collect();
    words.extend([
        "x", "y", "i", "2i", "pi", "1", ".5", "1e", "1e-3", "e", "(", ")", "(", ")", ",", "+", "-", "*", "/",
    ]);
    words.extend([
        "^", "**", "<", "<=", "==", "!=", "&&", "||", "!", "=", "|", "²", "π", "é", "\n", " ", "…", "\0",
        "1e400",
    ]);
    let mut formulas = 0;
    for _ in 0..100_000 {
        let text: String = (0..1 + random.below(9)).map(|_| random.one_of(&words)).collect();
        match Formula::with_difference(&text, &VARIABLES, &[], ("y", "x")) {
            Ok(formula) => {
                formulas += 1;
                formula.at_complex(&[0.5, 0.25, -0.25]);
            }
            Err(error) => {
                assert!(text.get(error.span()).is_some(), "{text}");
                assert!(!error.to_string().is_empty());
            }
        }
    }
    assert!(formulas > 1000, "{formulas}");
}

#[test]
fn threads_may_share_a_formula() {
    let product = Formula::parse("(x+1)*y", &VARIABLES).unwrap();
    let sum = Formula::parse("(x+2)+y", &VARIABLES).unwrap();
    std::thread::scope(|scope| {
        for x in [1.0, 2.0, 3.0] {
            let (product, sum) = (&product, &sum);
            scope.spawn(move || {
                // in turns: each finds the registers as the other left them
                for y in [4.0, 5.0, 6.0] {
                    assert_eq!([product.at(&[x, y]), sum.at(&[x, y])], [(x + 1.0) * y, x + 2.0 + y]);
                }
            });
        }
    });
}
