//! Links that were found before a run was interrupted, and the file that they are kept in.
//!
//! All numbers are little-endian: 8 bytes `FREDLINK`, the version, a digest of what the links are of, the numbers of patches and of
//! blocks, the light that the cuts were made for, and block by block the number of its receiver, of its patches and of its
//! senders, the senders and the factors; at the end a CRC-32 of all that.

use super::block::Block;
use super::build::{Light, Plan};
use crate::form_factor::sampled::mix;
use fredholm::operator::hierarchical::Cluster;
use fredholm::value::Value;
use std::io::{self, Read, Write};

const MAGIC: [u8; 8] = *b"FREDLINK";
const VERSION: u32 = 1;

/// Links of some of the receivers.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept {
    /// What they are of: patches, light and the part that a link may bring.
    pub(super) digest: u64,
    pub(super) light: Light,
    /// By the number of the receiver, ascending.
    pub(super) blocks: Vec<(u32, Block)>,
    pub(super) rays: u64,
}

/// Why a file of links cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum KeptError {
    /// It cannot be read.
    #[error("it cannot be read: {0}")]
    Read(String),
    /// Something else.
    #[error("this is no checkpoint of fredholm")]
    Foreign,
    /// Of another version of the format.
    #[error("this is a checkpoint of version {0}, and only version {VERSION} is read: start anew")]
    Version(u32),
    /// Cut off, or changed.
    #[error("the checkpoint is damaged or cut off: start anew")]
    Damaged,
    /// Of another run.
    #[error(
        "the checkpoint is of another scene, other patches or another --factor-accuracy: give the same, or start anew"
    )]
    Another,
}

impl Kept {
    /// No links yet, for light as it is guessed.
    pub fn none<V: Value>(plan: &Plan<'_, V>, light: Light, part: f64, source: &[V]) -> Self {
        Self { digest: plan.digest(part, source), light, blocks: Vec::new(), rays: 0 }
    }

    /// The light that the links are made for.
    pub fn light(&self) -> &Light {
        &self.light
    }

    /// How many patches have their links.
    pub fn patches(&self) -> usize {
        self.blocks.iter().map(|(_, block)| block.patches()).sum()
    }

    /// Writes the file.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let mut out = Checked { inner: out, crc: crc32fast::Hasher::new() };
        out.write_all(&MAGIC)?;
        out.write_all(&VERSION.to_le_bytes())?;
        let (patches, blocks) = (self.light.brightness.len() as u64, self.blocks.len() as u64);
        for number in [self.digest, patches, blocks, self.rays] {
            out.write_all(&number.to_le_bytes())?;
        }
        for number in self.light.brightness.iter().chain(&self.light.arriving) {
            out.write_all(&number.to_le_bytes())?;
        }
        for (receiver, block) in &self.blocks {
            let senders = block.columns().count() as u32;
            for number in [*receiver, block.patches() as u32, senders] {
                out.write_all(&number.to_le_bytes())?;
            }
            for (sender, _) in block.columns() {
                out.write_all(&(sender.index() as u32).to_le_bytes())?;
            }
            for (_, column) in block.columns() {
                column.iter().try_for_each(|factor| out.write_all(&factor.to_le_bytes()))?;
            }
        }
        let Checked { inner, crc } = out;
        inner.write_all(&crc.finalize().to_le_bytes())
    }

    /// Reads the file, for the links that a plan makes.
    pub fn read<V: Value>(
        plan: &Plan<'_, V>,
        part: f64,
        source: &[V],
        input: &mut impl Read,
    ) -> Result<Self, KeptError> {
        let mut input = Checked { inner: input, crc: crc32fast::Hasher::new() };
        let cut_off = |error: io::Error| match error.kind() {
            io::ErrorKind::UnexpectedEof => KeptError::Damaged,
            _ => KeptError::Read(error.to_string()),
        };
        if input.take::<8>().map_err(|error| match cut_off(error) {
            KeptError::Damaged => KeptError::Foreign,
            other => other,
        })? != MAGIC
        {
            return Err(KeptError::Foreign);
        }
        let version = u32::from_le_bytes(input.take().map_err(cut_off)?);
        if version != VERSION {
            return Err(KeptError::Version(version));
        }
        let [digest, patches, blocks, rays] = [(); 4].map(|()| input.take().map(u64::from_le_bytes));
        let [digest, patches, blocks, rays] = [
            digest.map_err(cut_off)?,
            patches.map_err(cut_off)?,
            blocks.map_err(cut_off)?,
            rays.map_err(cut_off)?,
        ];
        if digest != plan.digest(part, source) || patches != source.len() as u64 {
            return Err(KeptError::Another);
        }
        let mut numbers = || -> Result<Vec<f64>, KeptError> {
            (0..patches).map(|_| Ok(f64::from_le_bytes(input.take().map_err(cut_off)?))).collect()
        };
        let light = Light { brightness: numbers()?, arriving: numbers()? };
        let clusters: Vec<Cluster> = plan.clusters.tree.top_down().collect();
        let mut kept = Self { digest, light, blocks: Vec::new(), rays };
        for _ in 0..blocks {
            let mut number = || Ok::<u32, KeptError>(u32::from_le_bytes(input.take().map_err(cut_off)?));
            let (receiver, patches, senders) = (number()?, number()? as usize, number()? as usize);
            let known =
                plan.receiver(receiver).filter(|_| kept.blocks.last().is_none_or(|last| last.0 < receiver));
            let known = known.filter(|known| plan.clusters.tree.range(*known).len() == patches);
            let (Some(known), true) = (known, senders <= clusters.len()) else {
                return Err(KeptError::Damaged);
            };
            let senders =
                (0..senders).map(|_| clusters.get(number()? as usize).copied().ok_or(KeptError::Damaged));
            let senders = senders.collect::<Result<Vec<Cluster>, _>>()?;
            let factors = (0..senders.len() * patches).map(|_| Ok(f32::from_bits(number()?)));
            let factors = factors.collect::<Result<Vec<f32>, KeptError>>()?;
            kept.blocks.push((receiver, Block::from_parts(known, patches, senders, factors)));
        }
        let found = input.crc.clone().finalize();
        if u32::from_le_bytes(input.take().map_err(cut_off)?) != found {
            return Err(KeptError::Damaged);
        }
        Ok(kept)
    }
}

impl<V: Value> Plan<'_, V> {
    /// A number that tells apart what links are of: corners, reflectances, sources and the part that one may bring.
    pub fn digest(&self, part: f64, source: &[V]) -> u64 {
        let mut digest = u64::from(VERSION);
        let mut add = |number: f64| digest = mix(digest ^ number.to_bits());
        add(part);
        for polygon in &self.patches.polygons {
            polygon.vertices().iter().for_each(|v| v.to_array().into_iter().for_each(&mut add));
        }
        for value in self.patches.reflectance.iter().chain(source) {
            value.channels().iter().copied().for_each(&mut add);
        }
        digest
    }
}

/// A reader or writer that adds up what goes through.
struct Checked<T> {
    inner: T,
    crc: crc32fast::Hasher,
}

impl<W: Write> Checked<&mut W> {
    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.crc.update(bytes);
        self.inner.write_all(bytes)
    }
}

impl<R: Read> Checked<&mut R> {
    fn take<const N: usize>(&mut self) -> io::Result<[u8; N]> {
        let mut bytes = [0; N];
        self.inner.read_exact(&mut bytes)?;
        self.crc.update(&bytes);
        Ok(bytes)
    }
}
