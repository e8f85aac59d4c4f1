//! Formulas with the imaginary unit.

use expression::{Column, Formula};
use num_complex::Complex;

fn value(text: &str) -> Complex<f64> {
    let formula = Formula::parse(text, &["x", "y"]).unwrap_or_else(|error| panic!("{error}"));
    formula.at_complex(&[0.7, 0.4])
}

#[test]
fn the_unit_and_its_powers() {
    for (text, re, im) in [
        ("i", 0.0, 1.0),
        ("2i", 0.0, 2.0),
        ("2*i", 0.0, 2.0),
        ("1+.5i", 1.0, 0.5),
        ("1e1i", 0.0, 10.0),
        ("i^2", -1.0, 0.0),
        ("i*i", -1.0, 0.0),
        ("1/i", 0.0, -1.0),
        ("sqrt(-4)+0*i", 0.0, 2.0),
        ("sqrt(max(-4*x/x,-9))+0*i", 0.0, 2.0),
        ("sqrt(min(4*x/x,-9))+0*i", 0.0, 3.0),
        ("(-8*x/x)^(1/3)+0*i", 1.0, 3_f64.sqrt()),
        ("(1+i)*(1-i)", 2.0, 0.0),
        ("(x+i*y)^2", 0.7 * 0.7 - 0.4 * 0.4, 2.0 * 0.7 * 0.4),
        ("conj(x+i*y)", 0.7, -0.4),
        ("if(x>y, i, 1)", 0.0, 1.0),
        ("if(x<y, i, 1)", 1.0, 0.0),
        ("i == i", 1.0, 0.0),
        ("i*x != x", 1.0, 0.0),
    ] {
        assert!((value(text) - Complex::new(re, im)).norm() < 1e-15, "{text} = {}", value(text));
    }
}

#[test]
fn identities_hold() {
    for (left, right) in [
        ("exp(i*x)", "cos(x)+i*sin(x)"),
        ("exp(i*(x-y))", "exp(i*x)*exp(-i*y)"),
        ("sqrt(x+i*y)^2", "x+i*y"),
        ("exp(ln(x+i*y))", "x+i*y"),
        ("(x+i*y)^(1/3)", "exp(ln(x+i*y)/3)"),
        ("(x+i*y)^(i*x)", "exp(i*x*ln(x+i*y))"),
        ("e^(i*pi*x)", "exp(i*pi*x)"),
        ("10^log10(x+i*y)", "x+i*y"),
        ("sin(x+i*y)^2+cos(x+i*y)^2", "1"),
        ("cosh(x+i*y)^2-sinh(x+i*y)^2", "1"),
        ("tan(x+i*y)", "sin(x+i*y)/cos(x+i*y)"),
        ("tanh(x+i*y)", "sinh(x+i*y)/cosh(x+i*y)"),
        ("sin(asin(x+i*y))", "x+i*y"),
        ("cos(acos(x+i*y))", "x+i*y"),
        ("tan(atan(x+i*y))", "x+i*y"),
        ("sinh(asinh(x+i*y))", "x+i*y"),
        ("cosh(acosh(x+i*y))", "x+i*y"),
        ("tanh(atanh(x+i*y))", "x+i*y"),
        ("cosh(acosh(x)+0*i)", "x"),
        ("abs(x+i*y)^2", "x^2+y^2"),
        ("abs(x+i*y)*exp(i*arg(x+i*y))", "x+i*y"),
        ("real(x+i*y)+i*imag(x+i*y)", "x+i*y"),
        ("(x+i*y)^-2", "1/((x+i*y)*(x+i*y))"),
        ("(x+i*y)^11", "(x+i*y)^5*(x+i*y)^6"),
        ("(y-x)^(1/2)+0*i", "i*sqrt(x-y)"),
        ("ln(-x)+0*i", "ln(x)+i*pi"),
        ("(i-x)-(i-x)", "0"),
        ("x-i", "-(i-x)"),
    ] {
        let (left_value, right_value) = (value(left), value(right));
        assert!((left_value - right_value).norm() < 4e-15, "{left} = {left_value}, {right} = {right_value}");
    }
}

#[test]
fn nothing_overflows_on_the_way() {
    assert_eq!(value("tanh(1000+i)"), Complex::new(1.0, 0.0));
    assert!((value("tan(x+1000*i)") - Complex::I).norm() < 1e-15);
    assert!(value("exp(1000*x*y*10+0*i)").re.is_infinite());
}

#[test]
fn a_formula_is_complex_if_its_value_may_be() {
    let complex = |text: &str| Formula::parse(text, &["x"]).unwrap().is_complex();
    for text in ["i", "exp(i*x)", "sqrt(x)+i", "0*x*i", "if(x>0,1,i)"] {
        assert!(complex(text), "{text}");
    }
    for text in ["x", "sqrt(-x)", "real(exp(i*x))", "abs(x+i)", "i^2", "0*i*x", "i==x", "sqrt(x^2)*imag(i)"] {
        assert!(!complex(text), "{text}");
    }
    assert_eq!(Formula::parse("real(exp(i*x))", &["x"]).unwrap().at(&[0.3]), 0.3_f64.cos());
    // without `i`, the root of a negative number is undefined
    assert!(Formula::parse("sqrt(-x)", &["x"]).unwrap().at_complex(&[1.0]).re.is_nan());
}

#[test]
fn batches_are_complex_too() {
    let formula = Formula::parse("exp(i*(x-y))/2", &["x", "y"]).unwrap();
    let y: Vec<f64> = (0..100).map(|k| f64::from(k) / 7.0).collect();
    let mut out = vec![Complex::ZERO; y.len()];
    formula.fill_complex(&[Column::Same(0.3), Column::Each(&y)], &mut out);
    for (y, out) in y.iter().zip(&out) {
        assert!((out - 0.5 * Complex::cis(0.3 - y)).norm() < 1e-15);
    }
    let real = Formula::parse("x*y", &["x", "y"]).unwrap();
    real.fill_complex(&[Column::Same(0.3), Column::Each(&y)], &mut out);
    assert!(y.iter().zip(&out).all(|(y, out)| *out == Complex::new(0.3 * y, 0.0)));
}
