//! The exact difference of two variables.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use expression::{Column, Formula};

/// The value at x = y = 0.3 to all digits, but for d = y − x.
fn near(text: &str, d: f64) -> f64 {
    let parameters = [("c".to_string(), 0.1)];
    let formula = Formula::with_difference(text, &["x", "y"], &parameters, ("y", "x")).unwrap();
    formula.at(&[0.3, 0.3, d])
}

#[test]
fn a_difference_keeps_its_digits() {
    let d: f64 = 1e-25;
    for (text, expected) in [
        ("y-x", d),
        ("x-y", -d),
        ("-(x-y)", d),
        ("x + -y", -d),
        ("-x+y", d),
        ("(x-y)/2", -0.5 * d),
        ("2*x-2*y", -2.0 * d),
        ("c*x-c*y", -(0.1 * d)),
        ("x/4-y/4", -0.25 * d),
        ("(x+1)-(y+1)", -d),
        ("x-y-x+y+y-x", d),
        ("abs(x-y)", d),
        ("(x-y)^2", d * d),
        ("ln(abs(x-y))", d.ln()),
        ("sqrt(abs(y-x))", d.sqrt()),
        ("exp(x-y)-1", 0.0),
        ("sin(y-x)", d),
        ("abs(x-y)^(-1/3)", d.powf(-1.0 / 3.0)),
        ("x+1-y", 1.0 - d),
        ("1-(x-y)", 1.0 + d),
        ("min(x-y,0)", -d),
        ("max(x-y,0)", 0.0),
    ] {
        assert_eq!(near(text, d), expected, "{text}");
    }
    let singular = near("abs(x-y)^(-1/2)", d);
    assert!((singular / 10_f64.powf(12.5) - 1.0).abs() < 4e-16, "{singular}");
}

#[test]
fn comparisons_see_what_doubles_cannot() {
    for (text, above, below) in [
        ("x<y", 1.0, 0.0),
        ("x<=y", 1.0, 0.0),
        ("y>x", 1.0, 0.0),
        ("y<x", 0.0, 1.0),
        ("x>=y", 0.0, 1.0),
        ("x==y", 0.0, 0.0),
        ("x!=y", 1.0, 1.0),
        ("2*x<2*y", 1.0, 0.0),
        ("-x<-y", 0.0, 1.0),
        ("x-y<0", 1.0, 0.0),
        ("0<x-y", 0.0, 1.0),
        ("if(x<y,1,2)", 1.0, 2.0),
        ("sign(y-x)", 1.0, -1.0),
    ] {
        assert_eq!([near(text, 1e-25), near(text, -1e-25)], [above, below], "{text}");
    }
    assert_eq!([near("x==y", 0.0), near("x<=y", 0.0), near("x<y", 0.0)], [1.0, 1.0, 0.0]);
}

#[test]
fn the_smaller_is_chosen_by_the_difference() {
    let choose = |text: &str, d: f64| {
        let formula = Formula::with_difference(text, &["x", "y"], &[], ("y", "x")).unwrap();
        formula.at(&[1.0, 2.0, d]) // numbers that tell which was taken
    };
    assert_eq!([choose("min(x,y)", 1e-25), choose("min(x,y)", -1e-25)], [1.0, 2.0]);
    assert_eq!([choose("max(x,y)", 1e-25), choose("max(x,y)", -1e-25)], [2.0, 1.0]);
    assert_eq!([choose("max(y,x)", 1e-25), choose("min(3*x,3*y)", -1e-25)], [2.0, 6.0]);
    // in one step with what is done to the chosen
    assert_eq!([choose("5-min(x,y)", 1e-25), choose("max(x,y)/8", -1e-25)], [4.0, 0.125]);
    assert!(choose("min(x,y)*2", f64::NAN).is_nan());
    assert!(choose("min(x,y)", f64::NAN).is_nan() && choose("max(x,y)", f64::NAN).is_nan());
}

#[test]
fn a_row_near_the_diagonal_is_its_points() {
    let x = 0.3;
    for text in ["min(x,y)*(1-max(x,y))", "max(y,2*x-y)", "if(x<y,x,y)/(1+abs(x-y))"] {
        let formula = Formula::with_difference(text, &["x", "y"], &[], ("y", "x")).unwrap();
        for lanes in [1, 7, 16, 17, 25, 41, 64, 150] {
            let y: Vec<f64> = (0..lanes).map(|k| f64::from(k) / f64::from(lanes)).collect();
            let gaps: Vec<f64> = y.iter().map(|y| y - x).collect();
            let mut row = vec![0.0; y.len()];
            formula.fill(&[Column::Same(x), Column::Each(&y), Column::Each(&gaps)], &mut row);
            let points: Vec<f64> = y.iter().zip(&gaps).map(|(y, gap)| formula.at(&[x, *y, *gap])).collect();
            assert_eq!(row, points, "{text}");
        }
    }
}

#[test]
fn a_kernel_of_convolution_depends_on_the_difference_alone() {
    let depends = |text: &str| {
        let formula = Formula::with_difference(text, &["x", "y"], &[], ("y", "x")).unwrap();
        [0, 1, 2].map(|k| formula.depends_on(k))
    };
    assert_eq!(depends("exp(-abs(x-y))/4"), [false, false, true]);
    assert_eq!(depends("cos(x+y)"), [true, true, false]);
    assert_eq!(depends("x*abs(x-y)"), [true, false, true]);
    assert_eq!(depends("min(x,y)*(1-max(x,y))"), [true, true, true]);
}

#[test]
fn other_combinations_are_left_alone() {
    let formula = |text: &str| Formula::with_difference(text, &["x", "y"], &[], ("y", "x")).unwrap();
    // a wrong d shows where it is used
    for (text, expected) in
        [("x+y", 5.0), ("2*x-y", 1.0), ("x*x-x*y", -2.0), ("x-x", 0.0), ("x/y", 2.0 / 3.0)]
    {
        assert_eq!(formula(text).at(&[2.0, 3.0, 100.0]), expected, "{text}");
    }
}

#[test]
fn the_difference_is_a_column_of_the_batch() {
    let formula = Formula::with_difference("abs(x-y)^(-1/2)", &["x", "y"], &[], ("y", "x")).unwrap();
    let mut out = [0.0; 3];
    let d = [1e-20, 1e-24, 1e-28];
    formula.fill(&[Column::Same(0.3), Column::Each(&[0.3; 3]), Column::Each(&d)], &mut out);
    assert_eq!(out, d.map(|d: f64| 1.0 / d.sqrt()));
}

#[test]
fn either_variable_may_come_first() {
    let formula =
        Formula::with_difference("x-y + if(x<y,100,200)", &["y", "t", "x"], &[], ("x", "y")).unwrap();
    assert_eq!(formula.columns(), 4);
    assert_eq!(formula.at(&[0.3, 0.0, 0.3, 1.0]), 201.0);
    assert_eq!(formula.at(&[0.3, 0.0, 0.3, -1.0]), 99.0);
}
