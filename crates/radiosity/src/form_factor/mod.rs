//! Room 5: F_ij, the share of the light leaving patch i that reaches patch j.

mod lambert;

pub use lambert::point_to_polygon;
