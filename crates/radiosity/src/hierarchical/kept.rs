//! Links that were found before a run was interrupted, and the file that they are kept in.
//!
//! All numbers are little-endian: 8 bytes `FREDLINK`, the version, a digest of what the links are of, the number of patches, the light
//! that the cuts were made for, and region by region the number of its blocks, which are those of its receivers from the first on; block
//! by block the numbers of its patches, of its senders, and of rays cast for it; and sender by sender its number and the factors. At
//! the end a CRC-32 of all that.

use super::block::Blocks;
use super::build::{Light, Plan};
use crate::form_factor::sampled::mix;
use fredholm::operator::hierarchical::Cluster;
use fredholm::value::Value;
use std::io::{self, Read, Write};

const MAGIC: [u8; 8] = *b"FREDLINK";
const VERSION: u32 = 4;

/// Links of some of the receivers.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept {
    /// What they are of: patches, light and the part that a link may bring.
    pub(super) digest: u64,
    pub(super) light: Light,
    /// Of each region, of its receivers from the first on.
    pub(super) regions: Vec<Blocks>,
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
        Self { digest: plan.digest(part, source), light, regions: plan.unbuilt() }
    }

    /// The light that the links are made for.
    pub fn light(&self) -> &Light {
        &self.light
    }

    /// How many patches have their links.
    pub fn patches(&self) -> usize {
        self.regions.iter().flat_map(Blocks::iter).map(|block| block.patches()).sum()
    }

    /// Whether a file is of links, from its first bytes.
    pub fn is_in(input: &mut impl Read) -> io::Result<bool> {
        let mut start = Vec::new();
        input.take(MAGIC.len() as u64).read_to_end(&mut start)?;
        Ok(start == MAGIC)
    }

    /// Writes the file.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let mut out = Checked { inner: out, crc: crc32fast::Hasher::new() };
        out.write_all(&MAGIC)?;
        out.write_all(&VERSION.to_le_bytes())?;
        for number in [self.digest, self.light.brightness.len() as u64] {
            out.write_all(&number.to_le_bytes())?;
        }
        for number in self.light.brightness.iter().chain(&self.light.arriving) {
            out.write_all(&number.to_le_bytes())?;
        }
        for blocks in &self.regions {
            out.write_all(&(blocks.len() as u32).to_le_bytes())?;
            for block in blocks.iter() {
                let senders = block.columns().count() as u32;
                for number in [block.patches() as u32, senders] {
                    out.write_all(&number.to_le_bytes())?;
                }
                out.write_all(&block.rays().to_le_bytes())?;
                for (sender, column) in block.columns() {
                    out.write_all(&(sender.index() as u32).to_le_bytes())?;
                    column.iter().try_for_each(|factor| out.write_all(&factor.to_le_bytes()))?;
                }
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
        let magic = input.take::<8>();
        if matches!(magic, Err(KeptError::Damaged)) || magic? != MAGIC {
            return Err(KeptError::Foreign);
        }
        let version = input.word()?;
        if version != VERSION {
            return Err(KeptError::Version(version));
        }
        let (digest, patches) = (input.long()?, input.long()?);
        if digest != plan.digest(part, source) || patches != source.len() as u64 {
            return Err(KeptError::Another);
        }
        let mut numbers =
            || (0..patches).map(|_| Ok(f64::from_bits(input.long()?))).collect::<Result<_, KeptError>>();
        let light = Light { brightness: numbers()?, arriving: numbers()? };
        let clusters: Vec<Cluster> = plan.clusters.tree.top_down().collect();
        let (mut regions, mut column) = (plan.unbuilt(), Vec::new());
        for (region, blocks) in regions.iter_mut().enumerate() {
            let known = input.word()? as usize;
            for receiver in plan.receivers(region).get(..known).ok_or(KeptError::Damaged)? {
                let (patches, senders, rays) = (input.word()? as usize, input.word()?, input.long()?);
                if plan.clusters.tree.range(*receiver).len() != patches {
                    return Err(KeptError::Damaged);
                }
                for _ in 0..senders {
                    let sender = clusters.get(input.word()? as usize).ok_or(KeptError::Damaged)?;
                    column.clear();
                    for _ in 0..patches {
                        column.push(f64::from(f32::from_bits(input.word()?)));
                    }
                    blocks.add(*sender, &column);
                }
                blocks.close(*receiver, patches, rays);
            }
        }
        let found = input.crc.clone().finalize();
        if input.word()? != found {
            return Err(KeptError::Damaged);
        }
        Ok(Self { digest, light, regions })
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
    fn take<const N: usize>(&mut self) -> Result<[u8; N], KeptError> {
        let mut bytes = [0; N];
        self.inner.read_exact(&mut bytes).map_err(|error| match error.kind() {
            io::ErrorKind::UnexpectedEof => KeptError::Damaged,
            _ => KeptError::Read(error.to_string()),
        })?;
        self.crc.update(&bytes);
        Ok(bytes)
    }

    fn word(&mut self) -> Result<u32, KeptError> {
        self.take().map(u32::from_le_bytes)
    }

    fn long(&mut self) -> Result<u64, KeptError> {
        self.take().map(u64::from_le_bytes)
    }
}
