//! Special functions of real arguments, to some units of the last digit.
pub(crate) fn ei(_x: f64) -> f64 { f64::NAN }
pub(crate) fn li2(_x: f64) -> f64 { f64::NAN }
pub(crate) fn ellip_k(_x: f64) -> f64 { f64::NAN }
pub(crate) fn ellip_e(_x: f64) -> f64 { f64::NAN }
pub(crate) fn bessel_j(_n: f64, _x: f64) -> f64 { f64::NAN }
pub(crate) fn bessel_y(_n: f64, _x: f64) -> f64 { f64::NAN }
pub(crate) fn bessel_i(_n: f64, _x: f64) -> f64 { f64::NAN }
pub(crate) fn bessel_k(_n: f64, _x: f64) -> f64 { f64::NAN }
pub(crate) fn expint(_n: f64, _x: f64) -> f64 { f64::NAN }
