//! A file whose first error is kept and told at the end.
//!
//! A zip archive that is given up in the middle, on a full disk say, still tries to write its directory, and complains
//! about that on its own. Here it is let believe that all goes well.

use std::io::{self, Seek, SeekFrom, Write};

/// The first error, and where the file would be without it.
pub(super) struct Sticky<W> {
    out: W,
    error: Option<io::Error>,
    position: u64,
    end: u64,
}

impl<W: Write + Seek> Sticky<W> {
    pub(super) fn new(out: W) -> Self {
        Self { out, error: None, position: 0, end: 0 }
    }

    /// The first error, if there was one.
    pub(super) fn result(self) -> io::Result<()> {
        self.error.map_or(Ok(()), Err)
    }

    /// Keeps an error; what fails after the first is of no interest.
    fn keep<T>(&mut self, result: io::Result<T>) {
        if let Err(error) = result {
            self.error.get_or_insert(error);
        }
    }
}

impl<W: Write + Seek> Write for Sticky<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.error.is_none() {
            let written = self.out.write_all(bytes);
            self.keep(written);
        }
        self.position += bytes.len() as u64;
        self.end = self.end.max(self.position);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        if self.error.is_none() {
            let flushed = self.out.flush();
            self.keep(flushed);
        }
        Ok(())
    }
}

impl<W: Write + Seek> Seek for Sticky<W> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let target = match to {
            SeekFrom::Start(position) => Some(position),
            SeekFrom::Current(by) => self.position.checked_add_signed(by),
            SeekFrom::End(by) => self.end.checked_add_signed(by),
        };
        self.position = target.ok_or(io::ErrorKind::InvalidInput)?;
        if self.error.is_none() {
            let sought = self.out.seek(SeekFrom::Start(self.position));
            self.keep(sought);
        }
        Ok(self.position)
    }
}
