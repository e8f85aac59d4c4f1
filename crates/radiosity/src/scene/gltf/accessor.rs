//! The numbers of an accessor: components of any type, strided, normalised, sparse; every byte is asked for before it is read.

use super::bytes::Data;
use super::malformed;
use crate::scene::error::Problem;
use ::gltf::accessor::sparse::IndexType;
use ::gltf::accessor::{Accessor, DataType};

/// The items of an accessor with `N` components each, as numbers.
pub(super) fn read<const N: usize>(data: &Data, accessor: &Accessor<'_>) -> Result<Vec<[f64; N]>, Problem> {
    let number = accessor.index();
    let components = accessor.dimensions().multiplicity();
    if components != N {
        return Err(malformed(format!(
            "accessor {number} has {components} components where {N} are needed; export the file again"
        )));
    }
    let (kind, normalized, count) = (accessor.data_type(), accessor.normalized(), accessor.count());
    let item = |bytes: &[u8]| -> [f64; N] {
        std::array::from_fn(|k| component(&bytes[k * kind.size()..], kind, normalized))
    };
    let size = N * kind.size();
    let mut items: Vec<[f64; N]> = match accessor.view() {
        Some(view) => {
            let bytes = data.view(&view)?;
            chunks(bytes, accessor.offset(), count, view.stride().unwrap_or(size), size)
                .ok_or_else(|| beyond(number))?
                .map(item)
                .collect()
        }
        // Zeros, which sparse values replace: no more of them than bytes, or a number in the file could take all memory.
        None if count <= data.len() => vec![[0.0; N]; count],
        None => return Err(beyond(number)),
    };
    if let Some(sparse) = accessor.sparse() {
        let (indices, values) = (sparse.indices(), sparse.values());
        let width = match indices.index_type() {
            IndexType::U8 => 1,
            IndexType::U16 => 2,
            IndexType::U32 => 4,
        };
        let places = chunks(data.view(&indices.view())?, indices.offset(), sparse.count(), width, width);
        let replaced = chunks(data.view(&values.view())?, values.offset(), sparse.count(), size, size);
        let both = places.zip(replaced).ok_or_else(|| beyond(number))?;
        for (place, value) in both.0.zip(both.1) {
            let place = place.iter().rev().fold(0, |place, byte| place << 8 | usize::from(*byte));
            *items.get_mut(place).ok_or_else(|| beyond(number))? = item(value);
        }
    }
    Ok(items)
}

fn beyond(number: usize) -> Problem {
    malformed(format!("accessor {number} reaches beyond the data that it is of; export the file again"))
}

/// The bytes of `count` items, if all of them are there.
fn chunks(
    bytes: &[u8],
    offset: usize,
    count: usize,
    stride: usize,
    size: usize,
) -> Option<impl Iterator<Item = &[u8]>> {
    let last = stride.checked_mul(count.saturating_sub(1))?;
    let end = if count == 0 { offset } else { offset.checked_add(last)?.checked_add(size)? };
    let bytes = bytes.get(offset..end)?;
    (stride >= size || count < 2).then(|| (0..count).map(move |k| &bytes[k * stride..][..size]))
}

/// A component; of the `normalized` integers the largest is 1.
fn component(bytes: &[u8], kind: DataType, normalized: bool) -> f64 {
    let two = [bytes[0], bytes.get(1).copied().unwrap_or(0)];
    let four = || [0, 1, 2, 3].map(|k| bytes.get(k).copied().unwrap_or(0));
    let (value, largest) = match kind {
        DataType::I8 => (f64::from(i8::from_le_bytes([bytes[0]])), 127.0),
        DataType::U8 => (f64::from(bytes[0]), 255.0),
        DataType::I16 => (f64::from(i16::from_le_bytes(two)), 32_767.0),
        DataType::U16 => (f64::from(u16::from_le_bytes(two)), 65_535.0),
        DataType::U32 => (f64::from(u32::from_le_bytes(four())), f64::from(u32::MAX)),
        DataType::F32 => return f64::from(f32::from_le_bytes(four())),
    };
    if normalized { (value / largest).max(-1.0) } else { value }
}
