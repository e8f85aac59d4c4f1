//! ∫ of a texture over a triangle, over its area: the mean of texels at points spread evenly, four a texel.

use super::bytes::Data;
use super::malformed;
use crate::reconstruct::{Rotation, lattice};
use crate::scene::error::Problem;
use ::gltf::image::Source;
use ::gltf::texture::{Info, WrappingMode};
use std::rc::Rc;

/// Points in a triangle of fewer texels, and in one of more: a sixteenth of the largest step between texels, and a thousandth.
const FEWEST: usize = 64;
const MOST: usize = 4096;

/// A picture, in 8 bits a channel.
pub(super) struct Texels {
    width: usize,
    height: usize,
    texels: Vec<[u8; 4]>,
}

/// A picture as a material has it.
pub(super) struct Texture {
    texels: Rc<Texels>,
    wrap: [WrappingMode; 2],
    /// Which coordinates of the vertices it goes by.
    pub set: u32,
    /// u′ = row · (u, v, 1) of `KHR_texture_transform`.
    rows: [[f64; 3]; 2],
}

/// What the bytes of a channel mean.
#[derive(Clone, Copy)]
pub(super) enum Coding {
    /// A colour, in the curve of sRGB.
    Srgb,
    /// A number.
    Linear,
}

impl Texels {
    pub fn read(data: &Data, image: &::gltf::Image<'_>) -> Result<Self, Problem> {
        let owner = format!("image {}", image.index());
        let bytes = match image.source() {
            Source::View { view, .. } => data.view(&view)?.to_vec(),
            Source::Uri { uri, .. } => data.of_uri(uri, &owner)?,
        };
        let picture = image::load_from_memory(&bytes).map_err(|error| {
            let shown: String = error.to_string().chars().filter(|c| !c.is_control()).take(120).collect();
            malformed(format!("{owner} cannot be read ({shown}); PNG and JPEG can: convert it"))
        })?;
        let picture = picture.into_rgba8();
        let (width, height) = (picture.width() as usize, picture.height() as usize);
        if width == 0 || height == 0 {
            return Err(malformed(format!("{owner} has no pixels; export the scene again")));
        }
        Ok(Self { width, height, texels: picture.pixels().map(|pixel| pixel.0).collect() })
    }
}

impl Texture {
    pub fn new(info: &Info<'_>, texels: Rc<Texels>) -> Self {
        let sampler = info.texture().sampler();
        let transform = info.texture_transform();
        let set = transform.as_ref().and_then(::gltf::texture::TextureTransform::tex_coord);
        let rows = transform.map_or([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], |transform| {
            let [[x, y], [across, down]] =
                [transform.offset(), transform.scale()].map(|pair| pair.map(f64::from));
            // Counter-clockwise as it is seen, with v downwards.
            let (sine, cosine) = f64::from(transform.rotation()).sin_cos();
            [[cosine * across, sine * down, x], [-sine * across, cosine * down, y]]
        });
        Self {
            texels,
            wrap: [sampler.wrap_s(), sampler.wrap_t()],
            set: set.unwrap_or(info.tex_coord()),
            rows,
        }
    }

    /// The mean over a triangle with these coordinates.
    pub fn mean(&self, corners: [[f64; 2]; 3], coding: Coding) -> Result<[f64; 3], Problem> {
        let [a, b, c] = corners.map(|[u, v]| self.rows.map(|[x, y, offset]| x * u + y * v + offset));
        if let Some(value) = [a, b, c].into_iter().flatten().find(|value| !value.is_finite()) {
            return Err(malformed(format!(
                "the texture coordinate {value} is not a finite number; export the scene again"
            )));
        }
        let doubled = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let texels = 0.5 * doubled.abs() * self.texels.width as f64 * self.texels.height as f64;
        let count = ((4.0 * texels) as usize).clamp(FEWEST, MOST);
        let mut sum = [0.0; 3];
        for (s, t) in lattice(count, Rotation::NONE) {
            // The unit square folded onto the triangle, as of a polygon's points.
            let root = s.sqrt();
            let at = |k: usize| a[k] * (1.0 - root) + b[k] * (root * (1.0 - t)) + c[k] * (root * t);
            let texel = self.texel([at(0), at(1)]);
            sum.iter_mut().zip(texel).for_each(|(sum, byte)| *sum += coding.decode(byte));
        }
        Ok(sum.map(|sum| sum / count as f64))
    }

    fn texel(&self, [u, v]: [f64; 2]) -> [u8; 4] {
        let Texels { width, height, texels } = &*self.texels;
        let [x, y] = [(u, self.wrap[0], *width), (v, self.wrap[1], *height)]
            .map(|(u, wrap, size)| ((wrapped(u, wrap) * size as f64) as usize).min(size - 1));
        texels[y * width + x]
    }
}

/// A coordinate in [0, 1].
fn wrapped(u: f64, mode: WrappingMode) -> f64 {
    match mode {
        WrappingMode::ClampToEdge => u.clamp(0.0, 1.0),
        WrappingMode::Repeat => u.rem_euclid(1.0),
        WrappingMode::MirroredRepeat => 1.0 - (u.rem_euclid(2.0) - 1.0).abs(),
    }
}

impl Coding {
    fn decode(self, byte: u8) -> f64 {
        let value = f64::from(byte) / 255.0;
        match self {
            Self::Linear => value,
            Self::Srgb if value <= 0.040_45 => value / 12.92,
            Self::Srgb => ((value + 0.055) / 1.055).powf(2.4),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Black but for a white quarter.
    fn quarter(wrap: WrappingMode) -> Texture {
        let texels = vec![[255; 4], [0; 4], [0; 4], [0; 4]];
        let texels = Rc::new(Texels { width: 2, height: 2, texels });
        Texture { texels, wrap: [wrap; 2], set: 0, rows: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] }
    }

    #[test]
    fn means_are_those_of_the_footprint_and_go_by_the_wrap() {
        let over = |texture: &Texture, corners| texture.mean(corners, Coding::Linear).unwrap()[0];
        let texture = quarter(WrappingMode::Repeat);
        // The lower left half of the picture, and one with none of the white.
        assert!((over(&texture, [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]) - 0.5).abs() < 0.02);
        assert_eq!(over(&texture, [[1.0, 0.51], [1.0, 1.0], [0.51, 1.0]]), 0.0);
        // Far beyond: a repeated picture has a quarter, one that is continued by its rim nothing, a mirrored one shows.
        let beyond = [[1.0, 0.0], [1.49, 0.0], [1.0, 0.49]];
        let of = |wrap| over(&quarter(wrap), beyond);
        assert_eq!((of(WrappingMode::Repeat), of(WrappingMode::ClampToEdge)), (1.0, 0.0));
        assert_eq!(of(WrappingMode::MirroredRepeat), 0.0);
        let mirrored = over(&quarter(WrappingMode::MirroredRepeat), [[1.51, 0.0], [2.49, 0.0], [1.51, 0.49]]);
        assert_eq!(mirrored, 1.0);
        let many = over(&texture, [[0.0, 0.0], [40.0, 0.0], [0.0, 40.0]]);
        assert!((many - 0.25).abs() < 0.02, "{many}");
    }

    #[test]
    fn a_transform_moves_the_picture() {
        let mut texture = quarter(WrappingMode::Repeat);
        let inside = [[0.05, 0.05], [0.45, 0.05], [0.05, 0.45]];
        assert_eq!(texture.mean(inside, Coding::Linear).unwrap(), [1.0; 3]);
        texture.rows[0][2] = 0.5;
        assert_eq!(texture.mean(inside, Coding::Linear).unwrap(), [0.0; 3]);
        assert!(texture.mean([[f64::NAN, 0.0]; 3], Coding::Linear).is_err());
    }

    #[test]
    fn colours_are_decoded() {
        assert_eq!((Coding::Srgb.decode(255), Coding::Srgb.decode(0)), (1.0, 0.0));
        assert!(
            (Coding::Srgb.decode(188) - 0.5).abs() < 0.003
                && (Coding::Srgb.decode(5) - 5.0 / 255.0 / 12.92).abs() < 1e-15
        );
    }
}
