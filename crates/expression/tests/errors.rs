//! What is told of a text that is no formula, and where.

use expression::{ErrorKind, Formula, ParseError};

fn error(text: &str) -> ParseError {
    let parameters = [("width".to_string(), 1.0), ("y".to_string(), 2.0)];
    match Formula::with_parameters(text, &["x", "y", "speed"], &parameters) {
        Ok(_) => panic!("`{text}` is a formula"),
        Err(error) => error,
    }
}

#[test]
fn every_error_points_at_its_characters() {
    for (text, carets, message) in [
        ("", "^", "the formula is empty"),
        ("  ", "^", "the formula is empty"),
        ("sine(x)*x", "^^^^", "unknown function `sine`; did you mean `sin`?"),
        ("1+arctan(x)", "  ^^^^^^", "unknown function `arctan`; did you mean `atan`?"),
        ("SIN(x)", "^^^", "unknown function `SIN`; did you mean `sin`?"),
        ("frobnicate(x)", "^^^^^^^^^^", "unknown function `frobnicate`"),
        ("x+sped", "  ^^^^", "unknown name `sped`; did you mean `speed`?"),
        ("x*widht", "  ^^^^^", "unknown name `widht`; did you mean `width`?"),
        ("PI*x", "^^", "unknown name `PI`; did you mean `pi`?"),
        ("z", "^", "unknown name `z`; known are `x`, `y`, `speed`, `width`, `y`, `pi`, `e`, `i`"),
        ("x+y", "  ^", "`y` is both a variable and a parameter; rename the parameter"),
        ("2x", "^^", "an operator is missing; to multiply, write `2*x`"),
        ("1 + 2 pi", "    ^^^^", "an operator is missing; to multiply, write `2*pi`"),
        ("2(x+1)", "^^", "an operator is missing; to multiply, write `2*(…)`"),
        ("(x)(x)", "^^^^", "an operator is missing; to multiply, write `(x)*(…)`"),
        ("x speed", "^^^^^^^", "an operator is missing; to multiply, write `x*speed`"),
        ("2e", "^^", "an operator is missing; to multiply, write `2*e`"),
        ("sin(x)cos(x)", "^^^^^^^^^", "an operator is missing; to multiply, write `sin(x)*cos`"),
        ("x(2)", "^", "`x` is no function; to multiply, write `x*(`"),
        ("pi(2)", "^^", "`pi` is no function; to multiply, write `pi*(`"),
        ("sin x", "^^^", "the function `sin` needs its arguments in parentheses: `sin(z)`"),
        ("2*exp", "  ^^^", "the function `exp` needs its arguments in parentheses: `exp(z)`"),
        ("min(x)", "^^^^^^", "`min(a,b,…)` takes two arguments or more, not 1"),
        ("1+sin()", "  ^^^^^", "`sin(z)` takes one argument, not 0"),
        ("if(x,1)", "^^^^^^^", "`if(c,a,b)` takes three arguments, not 2"),
        ("atan2(x,1,2)", "^^^^^^^^^^^^", "`atan2(y,x)` takes two arguments, not 3"),
        ("expint(-1,x)", "       ^^", "the order of `expint` is 0, 1, 2, …"),
        ("expint(1/2,x)", "       ^^^", "the order of `expint` is 0, 1, 2, …"),
        ("x+", "  ^", "a value is missing before the end of the formula"),
        ("x*/2", "  ^", "a value is missing before `/`"),
        ("()", " ^", "a value is missing before `)`"),
        ("sin(x,)", "      ^", "a value is missing before `)`"),
        ("*x", "^", "a value is missing before `*`"),
        ("(x+1", "^", "this parenthesis is never closed"),
        ("2*(x+(1-x)", "  ^", "this parenthesis is never closed"),
        ("sin(x", "   ^", "this parenthesis is never closed"),
        ("x+1)", "   ^", "this parenthesis was never opened"),
        (")", "^", "this parenthesis was never opened"),
        (
            "0,5",
            " ^",
            "unexpected `,`; arguments belong in a function's parentheses, and decimals behind a `.`",
        ),
        ("x!", " ^", "unexpected `!`; for a factorial, write `gamma(n+1)`"),
        ("0<x<1", "   ^", "comparisons do not chain; write `a < b && b < c`"),
        ("x=1", " ^", "unexpected character `=`; write `==` to compare"),
        ("|x|", "^", "unexpected character `|`; write `abs(…)` for an absolute value, `||` for or"),
        ("x²", " ^", "unexpected character `²`; write `^2`"),
        ("x−1", " ^", "unexpected character `−`; write `-`"),
        ("x $ 1", "  ^", "unexpected character `$`"),
        ("1.2.3", "^^^^^", "malformed number `1.2.3`"),
        ("x+1e999", "  ^^^^^", "the number `1e999` is too large for double precision"),
        (
            "erf(i*x)",
            "    ^^^",
            "`erf` takes real arguments, and this one may be complex; `real(…)` takes its real part",
        ),
        (
            "besselj(0, sqrt(x)) + 0*i",
            "           ^^^^^^^",
            "`besselj` takes real arguments, and this one may be complex; `real(…)` takes its real part",
        ),
        (
            "i < 1",
            "^",
            "`<` takes real arguments, and this one may be complex; `real(…)` takes its real part",
        ),
        (
            "1 > 2i",
            "    ^^",
            "`>` takes real arguments, and this one may be complex; `real(…)` takes its real part",
        ),
        (
            "max(x,1,i)",
            "        ^",
            "`max` takes real arguments, and this one may be complex; `real(…)` takes its real part",
        ),
        (
            "if(i,1,2)",
            "   ^",
            "`if` takes real arguments, and this one may be complex; `real(…)` takes its real part",
        ),
    ] {
        let shown = if text.is_empty() { String::new() } else { text.to_string() };
        assert_eq!(error(text).to_string(), format!("{message}\n  1 | {shown}\n    | {carets}"), "{text}");
    }
}

#[test]
fn the_line_is_found_among_many_and_cut_if_long() {
    assert_eq!(
        error("x +\n  speed * sped +\n 1").to_string(),
        "unknown name `sped`; did you mean `speed`?\n  2 |   speed * sped +\n    |           ^^^^"
    );
    let long = format!("{}sped{}", "x+".repeat(500), "+x".repeat(500));
    let message = error(&long).to_string();
    let lines: Vec<&str> = message.lines().collect();
    assert!(lines[1].chars().count() < 120, "{message}");
    let column = lines[2].chars().position(|c| c == '^');
    assert_eq!(column, lines[1].find("sped").map(|at| lines[1][..at].chars().count()));
    assert_eq!(error(&long).span(), 1000..1004);
}

#[test]
fn spans_are_bytes() {
    assert_eq!(error("π*π*sped").span(), 6..10);
}

#[test]
fn nothing_is_too_deep_or_too_long_to_be_told() {
    for deep in ["(", "-", "!", "2^", "sin(", "if(1,", "x^-"] {
        let error = error(&deep.repeat(10_000));
        assert!(matches!(error.kind(), ErrorKind::TooDeep { .. }), "{error}");
    }
    assert!(matches!(error(&"(".repeat(100_000)).kind(), ErrorKind::TooLong { .. }));
    let sum = Formula::parse(&vec!["x"; 30_000].join("+"), &["x"]);
    assert_eq!(sum.map(|sum| sum.at(&[0.5])), Ok(15_000.0));
}

#[test]
fn as_deep_as_allowed_is_a_formula() {
    let nested = format!("{}x{}", "sin(".repeat(199), ")".repeat(199));
    assert!(Formula::parse(&nested, &["x"]).is_ok_and(|formula| formula.at(&[1.0]) > 0.0));
}
