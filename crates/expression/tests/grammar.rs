//! What a formula means.

use expression::{Column, Formula, functions};
use std::f64::consts::{E, PI};

/// The value at x = 2, y = 3, with a parameter c = 0.5.
fn value(text: &str) -> f64 {
    let formula = Formula::with_parameters(text, &["x", "y"], &[("c".into(), 0.5)]);
    formula.unwrap_or_else(|error| panic!("{error}")).at(&[2.0, 3.0])
}

#[test]
fn numbers_names_and_blanks() {
    for (text, expected) in [
        ("1", 1.0),
        (".5", 0.5),
        ("1.", 1.0),
        ("1e-3", 1e-3),
        ("2.5E+2", 250.0),
        ("pi", PI),
        ("π", PI),
        ("e", E),
        (" x\n+\ty ", 5.0),
        ("c", 0.5),
        ("c*x", 1.0),
        ("+x", 2.0),
    ] {
        assert_eq!(value(text), expected, "{text}");
    }
}

#[test]
fn operators_bind_as_in_mathematics() {
    for (text, expected) in [
        ("1+x*y", 7.0),
        ("(1+x)*y", 9.0),
        ("10-x-y", 5.0),
        ("24/x/y", 4.0),
        ("24/x*y", 36.0),
        ("y/10", 0.3), // as 3 × 0.1 it would be 0.30000000000000004
        ("-x^2", -4.0),
        ("(-x)^2", 4.0),
        ("2^-1", 0.5),
        ("2^-x^2", 1.0 / 16.0),
        ("2^3^2", 512.0),
        ("2**3", 8.0),
        ("--x", 2.0),
        ("-x*y", -6.0),
        ("y--x", 5.0),
        ("x*-y", -6.0),
        ("x+1<y+1", 1.0),
    ] {
        assert_eq!(value(text), expected, "{text}");
    }
}

#[test]
fn conditions_are_one_or_zero() {
    for (text, expected) in [
        ("x<y", 1.0),
        ("x>y", 0.0),
        ("x<=2", 1.0),
        ("x>=2", 1.0),
        ("x<2", 0.0),
        ("x==2", 1.0),
        ("x!=2", 0.0),
        ("x<y && y<x", 0.0),
        ("x<y || y<x", 1.0),
        ("x<y && x>1 && y>1", 1.0),
        ("0 && 0 || 1", 1.0),
        ("1 || 0 && 0", 1.0),
        ("!(x<y)", 0.0),
        ("!0", 1.0),
        ("if(x<y,10,20)", 10.0),
        ("if(x>y,10,20)", 20.0),
        ("if(x>y, 1, if(x==2, 7, 8))", 7.0),
    ] {
        assert_eq!(value(text), expected, "{text}");
    }
}

#[test]
fn the_branch_not_taken_does_not_matter() {
    assert_eq!(value("if(x>0, x, ln(-x))"), 2.0);
    assert_eq!(value("if(x<0, ln(-x)/0, y)"), 3.0);
    assert_eq!(value("x<0 && ln(-x)>0"), 0.0);
    assert_eq!(value("x>0 || ln(-x)>0"), 1.0);
}

#[test]
fn undefined_values_spread() {
    for text in [
        "sqrt(-x)",
        "ln(-x)",
        "asin(x)",
        "(-x)^0.3",
        "0*ln(-x)",
        "min(ln(-x), 1)",
        "min(1, ln(-x))",
        "max(ln(-x), 1)",
        "max(1, ln(-x))",
        "sign(ln(-x))",
        "ln(-x) < 1",
        "ln(-x) != 1",
        "if(ln(-x), 1, 2)",
        "if(ln(-x) < 0, 1, 2)",
        "!ln(-x)",
        "ellipk(x)",
        "expint(1,-x)",
        "bessely(0,-x)",
        "besselj(0.5,-x)",
    ] {
        assert!(value(text).is_nan(), "{text} = {}", value(text));
    }
}

#[test]
fn functions_compute_what_their_names_say() {
    for (text, expected) in [
        ("abs(-x)", 2.0),
        ("sign(-x)+sign(0)+sign(y)", 0.0),
        ("floor(-2.5)", -3.0),
        ("ceil(-2.5)", -2.0),
        ("mod(-1,y)", 2.0),
        ("mod(7,-y)", -2.0),
        ("min(y,x,7)", 2.0),
        ("max(x,7,y)", 7.0),
        ("exp(x)", 2_f64.exp()),
        ("e^x", 2_f64.exp()),
        ("ln(x)", 2_f64.ln()),
        ("log(x)", 2_f64.ln()),
        ("log10(1000)", 3.0),
        ("sqrt(x)", 2_f64.sqrt()),
        ("x^0.5", 2_f64.sqrt()),
        ("x^(-3/2)", 1.0 / (2.0 * 2_f64.sqrt())),
        ("cbrt(-8)", -2.0),
        ("sin(x)", 2_f64.sin()),
        ("cos(x)", 2_f64.cos()),
        ("tan(x)", 2_f64.tan()),
        ("asin(c)", 0.5_f64.asin()),
        ("acos(c)", 0.5_f64.acos()),
        ("atan(x)", 2_f64.atan()),
        ("atan2(x,-y)", 2_f64.atan2(-3.0)),
        ("sinh(x)", 2_f64.sinh()),
        ("cosh(x)", 2_f64.cosh()),
        ("tanh(x)", 2_f64.tanh()),
        ("gamma(5)", 24.0),
        ("real(x)+imag(x)+conj(x)+arg(-x)", 4.0 + PI),
        ("x^7", 128.0),
        ("x^20", 1048576.0),
        ("x^-3", 0.125),
        ("(-x)^3", -8.0),
        ("x^0", 1.0),
    ] {
        assert_eq!(value(text), expected, "{text}");
    }
    for (text, expected) in
        [("asinh(x)", 2_f64.asinh()), ("acosh(x)", 2_f64.acosh()), ("atanh(c)", 0.5_f64.atanh())]
    {
        assert!((value(text) - expected).abs() < 1e-15, "{text}");
    }
}

#[test]
fn special_functions_are_connected() {
    for (what, zero) in [
        ("the Wronskian", "besselj(1.3,x)*bessely(0.3,x) - besselj(0.3,x)*bessely(1.3,x) - 2/(pi*x)"),
        ("the modified Wronskian", "besseli(0.3,x)*besselk(1.3,x) + besseli(1.3,x)*besselk(0.3,x) - 1/x"),
        (
            "Legendre's relation",
            "ellipe(.6)*ellipk(.8) + ellipe(.8)*ellipk(.6) - ellipk(.6)*ellipk(.8) - pi/2",
        ),
        ("the recurrence of E_n", "2*expint(3,x) - (exp(-x) - x*expint(2,x))"),
        ("the complement", "erf(c) + erfc(c) - 1"),
        ("Euler's reflection", "li2(.3) + li2(.7) + ln(.3)*ln(.7) - pi^2/6"),
        ("the factorial", "gamma(x+0.3) - (x-0.7)*gamma(x-0.7)"),
    ] {
        assert!(value(zero).abs() < 2e-15, "{what}: {:e}", value(zero));
    }
    assert_eq!(value("ellipk(0)"), PI / 2.0);
}

#[test]
fn every_function_is_listed_and_can_be_called() {
    for (signature, meaning) in functions() {
        assert!(!meaning.is_empty());
        let call = signature.replace(",…", "");
        let arguments: Vec<&str> = call[call.find('(').unwrap() + 1..call.len() - 1].split(',').collect();
        Formula::parse(&call, &arguments).unwrap_or_else(|error| panic!("{error}"));
    }
    let names: std::collections::BTreeSet<_> = functions().iter().map(|(signature, _)| signature).collect();
    assert_eq!(names.len(), functions().len());
}

#[test]
fn callers_may_take_the_names_of_constants() {
    assert_eq!(Formula::parse("2*i", &["i"]).unwrap().at(&[3.0]), 6.0);
    let e = Formula::with_parameters("e+gamma", &[], &[("e".into(), 1.0), ("gamma".into(), 2.0)]).unwrap();
    assert_eq!(e.at(&[]), 3.0);
    assert_eq!(Formula::parse("gamma(gamma)", &["gamma"]).unwrap().at(&[4.0]), 6.0);
}

#[test]
fn dependence_is_of_the_columns_read() {
    let formula = Formula::parse("x*t + if(x>0, 1, 2)", &["x", "y", "s", "t"]).unwrap();
    assert_eq!([0, 1, 2, 3, 4, 99].map(|k| formula.depends_on(k)), [true, false, false, true, false, false]);
    assert!(!Formula::parse("1+pi", &["x"]).unwrap().depends_on(0));
}

#[test]
fn a_greens_function_is_what_its_parts_are() {
    // one step of four operations, against the operations one by one, to the last bit, in batches of every kind of rest
    type Closure = fn(f64, f64) -> f64;
    let parts: [(&str, Closure); 6] = [
        ("min(x,y)*(1-max(x,y))", |x, y| x.min(y) * (1.0 - x.max(y))),
        ("(1-max(x,y))*min(x,y)", |x, y| x.min(y) * (1.0 - x.max(y))),
        ("max(x,y)*(min(x,y)-3)", |x, y| x.max(y) * (x.min(y) - 3.0)),
        ("min(x,y)*(max(x,y)/7)", |x, y| x.min(y) * (x.max(y) / 7.0)),
        ("min(x,y)*max(x,y)^2", |x, y| x.min(y) * (x.max(y) * x.max(y))),
        ("min(x,y)*(1-max(x,2*y))", |x, y| x.min(y) * (1.0 - x.max(2.0 * y))),
    ];
    for (text, expected) in parts {
        let formula = Formula::parse(text, &["x", "y"]).unwrap();
        let exact = Formula::with_difference(text, &["x", "y"], &[], ("y", "x")).unwrap();
        for lanes in 1..=70 {
            let y: Vec<f64> = (0..lanes).map(|k| f64::from(k) / 9.0 - 2.0).collect();
            let gaps: Vec<f64> = y.iter().map(|y| y - 0.3).collect();
            let points: Vec<f64> = y.iter().map(|y| expected(0.3, *y)).collect();
            let mut row = vec![0.0; y.len()];
            formula.fill(&[Column::Same(0.3), Column::Each(&y)], &mut row);
            assert_eq!(row, points, "{text}");
            row.fill(0.0);
            exact.fill(&[Column::Same(0.3), Column::Each(&y), Column::Each(&gaps)], &mut row);
            assert_eq!(row, points, "{text}, exact");
        }
        assert!(formula.at(&[f64::NAN, 0.3]).is_nan() && formula.at(&[0.3, f64::NAN]).is_nan(), "{text}");
        assert!(exact.at(&[0.3, 0.4, f64::NAN]).is_nan(), "{text}");
    }
}

#[test]
fn a_batch_of_any_length_is_its_points() {
    // slow functions leave lanes of the last piece to the piece before; sums of them show it
    let formula = Formula::parse("exp(-x*y) + sin(y)*ln(y+4)", &["x", "y"]).unwrap();
    for lanes in 0..=140 {
        let y: Vec<f64> = (0..lanes).map(|k| f64::from(k) / 50.0).collect();
        let points: Vec<f64> = y.iter().map(|y| formula.at(&[0.7, *y])).collect();
        let mut row = vec![f64::NAN; y.len()];
        formula.fill(&[Column::Same(0.7), Column::Each(&y)], &mut row);
        assert_eq!(row, points);
    }
}

#[test]
#[should_panic(expected = "a value for each lane")]
fn a_column_of_another_length_is_refused() {
    let formula = Formula::parse("x+y", &["x", "y"]).unwrap();
    formula.fill(&[Column::Same(0.7), Column::Each(&[1.0, 2.0, 3.0])], &mut [0.0; 2]);
}
