//! ρ = base (1 − metallic) and E = π × emissive: of a material, or of each triangle where pictures or vertices paint it.
//!
//! White is 1 in these files, and no surface returns all light: ρ = 1 is taken to be 0.95, and told.

use super::bytes::Data;
use super::texture::{Coding, Texels, Texture};
use crate::scene::error::{Place, Problem};
use crate::scene::material::{Located, Material};
use crate::scene::mesh::{Mesh, unique};
use ::gltf::Document;
use ::gltf::material::AlphaMode;
use ::gltf::texture::Info;
use fredholm::value::Spectrum;
use std::cell::Cell;
use std::collections::{BTreeSet, HashMap};
use std::f64::consts::PI;
use std::path::Path;
use std::rc::Rc;

/// How the triangles of a material are painted.
pub(super) struct Paint {
    /// The material's name; none where a primitive has no material.
    pub name: Option<String>,
    base: [f64; 3],
    metallic: f64,
    /// π times the radiance.
    emission: [f64; 3],
    /// Of the base colour, of metal, and of the emission.
    textures: [Option<Texture>; 3],
    /// Whether a triangle of it would return all light of some colour.
    is_white: Cell<bool>,
}

/// What a vertex says of its paint.
pub(super) struct Vertex {
    pub colour: [f64; 3],
    /// Where it lies in each texture.
    pub places: [[f64; 2]; 3],
}

/// Colours that are the same to a 512th, of ρ, and to three digits, of E.
pub(super) type Key = [i64; 6];

/// The paints of a document, by material.
pub(super) struct Paints {
    paints: Vec<Rc<Paint>>,
    plain: Rc<Paint>,
}

impl Paints {
    /// Reads the pictures of all materials, and says what is not done of them.
    pub fn new(document: &Document, data: &Data, mesh: &mut Mesh) -> Result<Self, Problem> {
        let mut pictures = Pictures { data, known: HashMap::new() };
        let (mut paints, mut taken, mut told) = (Vec::new(), BTreeSet::new(), Told::default());
        for material in document.materials() {
            let number = material.index().unwrap_or_default();
            let given = material.name().map_or_else(|| format!("material-{number}"), str::to_owned);
            let paint = Paint::new(unique(given, &mut taken), &material, &mut pictures)?;
            told.take(&material, &paint);
            if let Some(name) = &paint.name {
                let own = paint.material(paint.base, [1.0; 3], paint.metallic, &mesh.file);
                mesh.materials.insert(name.clone(), own);
            }
            paints.push(Rc::new(paint));
        }
        told.tell(mesh);
        let plain = Paint {
            name: None,
            base: [0.5; 3],
            metallic: 0.0,
            emission: [0.0; 3],
            textures: [None, None, None],
            is_white: Cell::new(false),
        };
        Ok(Self { paints, plain: Rc::new(plain) })
    }

    /// Says which materials are white as no surface is, once all triangles are painted.
    pub fn tell_white(&self, mesh: &mut Mesh) {
        let white = self.paints.iter().filter(|paint| paint.is_white.get());
        let names: Vec<String> = white.filter_map(|paint| paint.name.clone()).collect();
        let what =
            format!("has the reflectance 1 in some colour, as no surface has: it is taken to be {WHITEST}");
        tell(mesh, &names, &what);
    }

    /// Of a primitive's material; without one it is grey, as faces of every format are.
    pub fn of(&self, material: &::gltf::Material<'_>) -> Rc<Paint> {
        material.index().and_then(|index| self.paints.get(index)).unwrap_or(&self.plain).clone()
    }
}

/// Pictures that have been read.
struct Pictures<'a> {
    data: &'a Data,
    known: HashMap<usize, Rc<Texels>>,
}

impl Pictures<'_> {
    fn texture(&mut self, info: Option<Info<'_>>) -> Result<Option<Texture>, Problem> {
        let Some(info) = info else { return Ok(None) };
        let image = info.texture().source();
        let texels = match self.known.get(&image.index()) {
            Some(texels) => texels.clone(),
            None => {
                let texels = Rc::new(Texels::read(self.data, &image)?);
                self.known.insert(image.index(), texels.clone());
                texels
            }
        };
        Ok(Some(Texture::new(&info, texels)))
    }
}

impl Paint {
    fn new(
        name: String,
        material: &::gltf::Material<'_>,
        pictures: &mut Pictures<'_>,
    ) -> Result<Self, Problem> {
        let (look, strength) =
            (material.pbr_metallic_roughness(), material.emissive_strength().unwrap_or(1.0));
        let [red, green, blue, _] = look.base_color_factor().map(f64::from);
        // What is unlit is a paint of its colour, whatever is said of metal.
        let metallic = if material.unlit() { 0.0 } else { f64::from(look.metallic_factor()) };
        let metal = look.metallic_roughness_texture().filter(|_| metallic != 0.0);
        let emission = material.emissive_factor().map(|factor| PI * f64::from(factor) * f64::from(strength));
        let glowing = material.emissive_texture().filter(|_| emission != [0.0; 3]);
        let textures = [
            pictures.texture(look.base_color_texture())?,
            pictures.texture(metal)?,
            pictures.texture(glowing)?,
        ];
        let (base, is_white) = ([red, green, blue], Cell::new(false));
        Ok(Self { name: Some(name), base, metallic, emission, textures, is_white })
    }

    /// Which coordinates its textures go by.
    pub fn sets(&self) -> [Option<u32>; 3] {
        [0, 1, 2].map(|k| self.textures[k].as_ref().map(|texture| texture.set))
    }

    /// Whether its triangles differ.
    pub fn varies(&self, has_colours: bool) -> bool {
        has_colours || self.textures.iter().any(Option::is_some)
    }

    /// The material of a triangle, and what tells it from those of others.
    pub fn of_triangle(&self, corners: &[Vertex; 3], file: &Path) -> Result<(Key, Material), Problem> {
        let mean = |k: usize, coding| match &self.textures[k] {
            Some(texture) => texture.mean([0, 1, 2].map(|corner| corners[corner].places[k]), coding),
            None => Ok([1.0; 3]),
        };
        let (picture, metal, glow) =
            (mean(0, Coding::Srgb)?, mean(1, Coding::Linear)?, mean(2, Coding::Srgb)?);
        let vertices = [0, 1, 2].map(|c| corners.iter().map(|corner| corner.colour[c]).sum::<f64>() / 3.0);
        let base = [0, 1, 2].map(|c| self.base[c] * picture[c] * vertices[c]);
        // Metal is the blue channel; where it differs within a triangle the product of means is not the mean of products.
        let metallic = self.metallic * metal[2];
        self.look_for_white(base, metallic);
        let mut material = self.material(base, glow, metallic, file);
        let mut key = [0; 6];
        for (k, located) in [(0, &mut material.reflectance), (3, &mut material.emission)] {
            let Some(located) = located else { continue };
            for (channel, key) in located.value.0.iter_mut().zip(&mut key[k..]) {
                let step =
                    if k == 0 { STEP } else { 1e-3 * 10_f64.powf(channel.abs().max(1e-300).log10().floor()) };
                let steps = (*channel / step).round();
                *channel = steps * step;
                *key = channel.to_bits() as i64;
            }
        }
        Ok((key, material))
    }

    /// Takes note of triangles that all have the base colour.
    pub fn used_as_it_is(&self) {
        self.look_for_white(self.base, self.metallic);
    }

    fn look_for_white(&self, base: [f64; 3], metallic: f64) {
        self.is_white
            .set(self.is_white.get() || base.iter().any(|channel| is_all(channel * (1.0 - metallic))));
    }

    fn material(&self, base: [f64; 3], glow: [f64; 3], metallic: f64, file: &Path) -> Material {
        let located = |value: [f64; 3]| Some(Located { value: Spectrum(value), place: Place::file(file) });
        let reflectance = base.map(|channel| channel * (1.0 - metallic));
        let reflectance = reflectance.map(|rho| if is_all(rho) { WHITEST } else { rho });
        let emission = [0, 1, 2].map(|c| self.emission[c] * glow[c]);
        Material { reflectance: located(reflectance), emission: located(emission), power: None }
    }
}

/// What a reflectance of 1 is taken for: more than paint and paper have, and less than would take a hundred bounces to die out.
const WHITEST: f64 = 0.95;

/// Whether a reflectance is 1, as near as colours are told from each other.
fn is_all(reflectance: f64) -> bool {
    (reflectance - 1.0).abs() < 0.5 * STEP
}

/// Reflectances of one surface: twice as fine as pictures of 8 bits a channel.
const STEP: f64 = 1.0 / 512.0;

/// Materials of which something is not done, the first of a kind by name.
#[derive(Default)]
struct Told {
    double_sided: Names,
    transparent: Names,
    metal: Names,
    unlit: Names,
}

type Names = Vec<String>;

impl Told {
    fn take(&mut self, material: &::gltf::Material<'_>, paint: &Paint) {
        let is_metal = paint.metallic >= 1.0 && paint.textures[1].is_none();
        for (names, is_so) in [
            (&mut self.double_sided, material.double_sided()),
            (&mut self.transparent, material.alpha_mode() != AlphaMode::Opaque),
            (&mut self.metal, is_metal),
            (&mut self.unlit, material.unlit()),
        ] {
            names.extend(paint.name.clone().filter(|_| is_so));
        }
    }

    fn tell(self, mesh: &mut Mesh) {
        for (names, what) in [
            (
                self.double_sided,
                "double-sided: its faces emit and reflect on the front alone, and block on both sides",
            ),
            (self.transparent, "transparent: it is taken to be opaque"),
            (
                self.metal,
                "metal, which reflects no light diffusely: its reflectance is 0 unless a scene file (.toml) gives it one \
                 under [materials]",
            ),
            (self.unlit, "unlit: it is taken for a paint of its base colour"),
        ] {
            tell(mesh, &names, &format!("is {what}"));
        }
    }
}

/// Says something of the first of some materials, and how many more it is true of.
fn tell(mesh: &mut Mesh, names: &[String], what: &str) {
    let Some(first) = names.first() else { return };
    let first: String = first.chars().filter(|c| !c.is_control()).take(60).collect();
    let more = if names.len() > 1 { format!(" (and {} more)", names.len() - 1) } else { String::new() };
    let place = Place::file(&mesh.file);
    mesh.warn(place, format!("the material `{first}`{more} {what}"));
}
