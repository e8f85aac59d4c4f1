//! The bytes of buffers and images: in the file, in a `data:` URI, or in a file beside it.

use super::malformed;
use crate::scene::error::Problem;
use ::gltf::Document;
use ::gltf::buffer::{Source, View};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::path::{Path, PathBuf};

/// All buffers of a document.
pub(super) struct Data {
    buffers: Vec<Vec<u8>>,
    folder: PathBuf,
}

impl Data {
    /// Reads them; `binary` is the chunk that a binary file has.
    pub fn new(file: &Path, document: &Document, binary: Option<&[u8]>) -> Result<Self, Problem> {
        let folder = file.parent().unwrap_or(Path::new("")).to_owned();
        let mut data = Self { buffers: Vec::new(), folder };
        for buffer in document.buffers() {
            let number = buffer.index();
            let bytes = match buffer.source() {
                Source::Bin => binary.map(<[u8]>::to_vec).ok_or_else(|| {
                    malformed(format!(
                        "buffer {number} is to be in a binary chunk, which is missing; export the file again"
                    ))
                })?,
                Source::Uri(uri) => data.of_uri(uri, &format!("buffer {number}"))?,
            };
            if bytes.len() < buffer.length() {
                return Err(malformed(format!(
                    "buffer {number} has {} bytes where {} are promised; it was cut off: export the file again",
                    bytes.len(),
                    buffer.length()
                )));
            }
            data.buffers.push(bytes);
        }
        Ok(data)
    }

    /// How many bytes there are in all: nothing that is counted can be more.
    pub fn len(&self) -> usize {
        self.buffers.iter().map(Vec::len).sum()
    }

    pub fn view(&self, view: &View<'_>) -> Result<&[u8], Problem> {
        let buffer = self.buffers.get(view.buffer().index()).map_or(&[][..], Vec::as_slice);
        let end = view.offset().checked_add(view.length());
        end.and_then(|end| buffer.get(view.offset()..end)).ok_or_else(|| {
            malformed(format!(
                "buffer view {} reaches beyond its buffer of {} bytes; export the file again",
                view.index(),
                buffer.len()
            ))
        })
    }

    /// What a URI stands for; `owner` is named where it is nothing.
    pub fn of_uri(&self, uri: &str, owner: &str) -> Result<Vec<u8>, Problem> {
        let shown = || uri.chars().filter(|c| !c.is_control()).take(80).collect::<String>();
        if let Some(data) = uri.strip_prefix("data:") {
            let text = data.split_once(";base64,").map(|(_, text)| text);
            let bytes = text.and_then(|text| STANDARD.decode(text).ok());
            return bytes.ok_or_else(|| {
                malformed(format!(
                    "the data of {owner} are not base64: `{}…`; export the file again",
                    shown()
                ))
            });
        }
        if uri.contains("://") {
            return Err(malformed(format!(
                "{owner} is at `{}`, and only files are read; fetch it, or embed it",
                shown()
            )));
        }
        let file = self.folder.join(without_percents(uri));
        std::fs::read(&file).map_err(|reason| Problem::Unreadable { file, reason })
    }
}

/// A URI's path as a file's name: `%20` is a blank.
fn without_percents(uri: &str) -> String {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [first, after @ ..] = rest {
        let code = after.get(..2).and_then(|two| std::str::from_utf8(two).ok());
        match code.filter(|_| *first == b'%').and_then(|code| u8::from_str_radix(code, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                rest = &after[2..];
            }
            None => {
                bytes.push(*first);
                rest = after;
            }
        }
    }
    String::from_utf8(bytes).unwrap_or_else(|_| uri.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percents_stand_for_bytes() {
        for (uri, name) in [("a%20b.png", "a b.png"), ("B%C3%BCro", "Büro"), ("100%", "100%"), ("%zz", "%zz")]
        {
            assert_eq!(without_percents(uri), name);
        }
    }
}
