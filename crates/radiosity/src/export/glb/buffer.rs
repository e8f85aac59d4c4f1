//! The binary buffer of a glTF, what is where in it, and the container of both.

use serde_json::{Value as Json, json};
use std::io::{self, Write};

/// The binary buffer, and what is where in it.
#[derive(Default)]
pub(super) struct Buffer {
    pub(super) bytes: Vec<u8>,
    pub(super) views: Vec<Json>,
    pub(super) accessors: Vec<Json>,
}

/// Component types of glTF.
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;

impl Buffer {
    pub(super) fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() }));
        self.bytes.extend_from_slice(bytes);
        self.views.len() - 1
    }

    fn accessor(&mut self, bytes: &[u8], kind: &str, component: u32, count: usize) -> usize {
        let view = self.view(bytes);
        self.accessors
            .push(json!({ "bufferView": view, "componentType": component, "count": count, "type": kind }));
        self.accessors.len() - 1
    }

    pub(super) fn vectors<const N: usize>(&mut self, vectors: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = vectors.iter().flatten().flat_map(|c| c.to_le_bytes()).collect();
        self.accessor(&bytes, &format!("VEC{N}"), FLOAT, vectors.len())
    }

    /// Positions, of which a reader wants to know the box around them.
    pub(super) fn positions(&mut self, positions: &[[f32; 3]]) -> usize {
        let accessor = self.vectors(positions);
        let bound = |pick: fn(f32, f32) -> f32| {
            positions.iter().copied().reduce(|a, b| [0, 1, 2].map(|c| pick(a[c], b[c]))).unwrap_or_default()
        };
        self.accessors[accessor]["min"] = json!(bound(f32::min));
        self.accessors[accessor]["max"] = json!(bound(f32::max));
        accessor
    }

    /// The corners of triangles.
    pub(super) fn indices(&mut self, corners: impl ExactSizeIterator<Item = u32>) -> usize {
        let count = corners.len();
        let bytes: Vec<u8> = corners.flat_map(u32::to_le_bytes).collect();
        self.accessor(&bytes, "SCALAR", UNSIGNED_INT, count)
    }
}

/// The container: a header, the JSON, the buffer; each chunk a multiple of four bytes long.
pub(super) fn write_chunks(json: &[u8], bytes: &[u8], out: &mut impl Write) -> io::Result<()> {
    let padded = |length: usize| length.next_multiple_of(4);
    let total = 12 + 8 + padded(json.len()) + 8 + padded(bytes.len());
    let total = u32::try_from(total).map_err(|_| io::Error::other("a GLB file has 4 GB at most"))?;
    out.write_all(b"glTF")?;
    out.write_all(&[2_u32, total].map(u32::to_le_bytes).concat())?;
    for (kind, chunk, filler) in [(b"JSON", json, b' '), (b"BIN\0", bytes, 0)] {
        out.write_all(&(padded(chunk.len()) as u32).to_le_bytes())?;
        out.write_all(kind)?;
        out.write_all(chunk)?;
        out.write_all(&vec![filler; padded(chunk.len()) - chunk.len()])?;
    }
    Ok(())
}
