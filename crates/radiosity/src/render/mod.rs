//! Room 8: the radiance L = B/π that reaches a camera, as a picture, and as a map of numbers.

mod automatic;
mod colour;
mod false_colour;
mod final_picture;
mod fragments;
mod of_field;
mod palette;
mod picture;
mod preview;
mod smooth;
mod tone;
mod view;

pub use colour::{Colour, luminance};
pub use false_colour::{Scale, false_colour, map_of_values};
pub use final_picture::final_picture;
pub use of_field::Sightings;
pub use picture::Picture;
pub use preview::Preview;
pub use tone::Exposure;
pub(crate) use tone::srgb;
pub use view::{Rays, View};
