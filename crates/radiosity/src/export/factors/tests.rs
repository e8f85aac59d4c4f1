//! Each file is read back by a reader that shares nothing with its writer.

use super::*;
use crate::view_factors::Exchange;
use npyz::npz::NpzArchive;
use std::io::{self, Cursor, Write};

/// Three faces of different areas, one exchange of nothing, one tiny, one of a face with itself.
fn factors(storage: Storage) -> ViewFactors {
    let given = [[0.0, 1.0 / 3.0, 1e-9 / 7.0], [0.0, 0.25, 0.0], [0.0, 0.0, 0.0]];
    let pair = |i: usize, j: usize| Exchange {
        value: given[i][j],
        error: if given[i][j] == 0.0 { 0.0 } else { 1e-5 },
    };
    let names = ["a, \"b\"", "tür", "c\nd"].map(String::from).to_vec();
    ViewFactors::assemble(names, vec![1.0, 0.7, 3.0], storage, pair, |_| ())
}

/// F of a file against F in memory: equal in f64, and within the error that was told in f32.
fn assert_same(read: &[Vec<f64>], factors: &ViewFactors) {
    assert_eq!(read.len(), factors.len());
    for (i, row) in read.iter().enumerate() {
        assert_eq!(row.len(), factors.len());
        for (j, factor) in row.iter().enumerate() {
            let expected = factors.factor(i, j);
            match factors.precision() {
                Storage::Single => assert_eq!(*factor as f32, expected as f32, "{i} {j}"),
                Storage::Double => assert_eq!(*factor, expected, "{i} {j}"),
            }
        }
    }
}

fn text(write: impl Fn(&mut Vec<u8>) -> io::Result<()>) -> String {
    let mut bytes = Vec::new();
    write(&mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

fn numbers(line: &str, separator: char) -> Vec<f64> {
    line.split(separator).map(|word| word.parse().unwrap()).collect()
}

const STORAGES: [Storage; 2] = [Storage::Single, Storage::Double];

#[test]
fn npz_has_factors_errors_areas_and_names() {
    for storage in STORAGES {
        let factors = factors(storage);
        let mut bytes = Cursor::new(Vec::new());
        write_npz(&factors, &mut bytes).unwrap();
        let mut archive = NpzArchive::new(bytes).unwrap();
        let f = archive.by_name("F").unwrap().unwrap();
        assert_eq!(f.shape(), [3, 3]);
        let f: Vec<f64> = match storage {
            Storage::Single => f.into_vec::<f32>().unwrap().into_iter().map(f64::from).collect(),
            Storage::Double => f.into_vec().unwrap(),
        };
        assert_same(&f.chunks(3).map(<[f64]>::to_vec).collect::<Vec<_>>(), &factors);
        let errors = archive.by_name("error").unwrap().unwrap();
        assert_eq!(errors.shape(), [3, 3]);
        for (k, error) in errors.into_vec::<f32>().unwrap().into_iter().map(f64::from).enumerate() {
            let told = factors.error(k / 3, k % 3);
            assert!(error >= told && error <= told * (1.0 + 1.2e-7), "{error:e} {told:e}");
        }
        let areas: Vec<f64> = archive.by_name("areas").unwrap().unwrap().into_vec().unwrap();
        assert_eq!(areas, [1.0, 0.7, 3.0]);
        let names: Vec<String> = archive.by_name("names").unwrap().unwrap().into_vec().unwrap();
        assert_eq!(names, ["a, \"b\"", "tür", "c\nd"]);
    }
}

#[test]
fn csv_has_the_names_and_a_row_for_each() {
    for storage in STORAGES {
        let factors = factors(storage);
        let text = text(|out| write_csv(&factors, out));
        let rows = text.strip_prefix("\"a, \"\"b\"\"\",tür,\"c\nd\"\n").unwrap();
        assert_same(&rows.lines().map(|line| numbers(line, ',')).collect::<Vec<_>>(), &factors);
        let single = storage == Storage::Single;
        assert!(!single || text.contains("\n0,0.33333334,1.4285714e-10\n"), "no digits of noise: {text}");
    }
}

#[test]
fn matrix_market_lists_what_is_not_nothing() {
    for storage in STORAGES {
        let factors = factors(storage);
        let text = text(|out| write_matrix_market(&factors, out));
        assert!(text.starts_with("%%MatrixMarket matrix coordinate real general\n"));
        assert!(text.contains("\n% 2 0.7 tür\n% 3 3 c d\n"), "{text}");
        let mut lines = text.lines().filter(|line| !line.starts_with('%')).map(|line| numbers(line, ' '));
        assert_eq!(lines.next().unwrap(), [3.0, 3.0, 5.0]);
        let mut read = vec![vec![0.0; 3]; 3];
        let mut listed = 0;
        for entry in lines {
            read[entry[0] as usize - 1][entry[1] as usize - 1] = entry[2];
            listed += 1;
        }
        assert_eq!(listed, 5);
        assert_same(&read, &factors);
    }
}

#[test]
fn view3d_reads_its_own_format() {
    for (storage, digits) in [(Storage::Single, 5e-9), (Storage::Double, 5e-13)] {
        let factors = factors(storage);
        let surroundings =
            Surroundings { is_closed: true, with_reflections: false, emittances: &[0.9, 0.85, 0.1234] };
        let text = text(|out| write_view3d(&factors, &surroundings, out));
        // As its reader does: 34 characters of a first line, six words, and then numbers, whatever the lines.
        let (header, rest) = text.split_once('\n').unwrap();
        assert!(header.len() < 34, "`{header}`");
        let words: Vec<&str> = header.split_whitespace().collect();
        assert_eq!((words[0], &words[2..]), ("fredholm", &["0", "1", "0", "3"][..]));
        assert!(words[0].len() < 16 && words[1].len() < 8, "`{header}`");
        let read: Vec<f64> = rest.split_whitespace().map(|word| word.parse().unwrap()).collect();
        assert_eq!((&read[..3], &read[12..]), (&[1.0, 0.7, 3.0][..], &[0.9, 0.85, 0.123][..]));
        for (k, factor) in read[3..12].iter().enumerate() {
            assert!((factor - factors.factor(k / 3, k % 3)).abs() <= digits, "{k}");
        }
        assert_eq!(rest.lines().count(), 5);
    }
}

#[test]
fn view3d_reads_its_own_binary_format() {
    for storage in STORAGES {
        let factors = factors(storage);
        let surroundings =
            Surroundings { is_closed: true, with_reflections: true, emittances: &[0.9, 0.85, 0.1234] };
        let mut bytes = Vec::new();
        write_view3d_binary(&factors, &surroundings, &mut bytes).unwrap();
        // As its reader does: a first line, whose end is its 32nd byte, six words; and then numbers of four bytes.
        assert_eq!(bytes.iter().position(|byte| *byte == b'\n'), Some(31));
        let (header, rest) = bytes.split_at(32);
        let header = std::str::from_utf8(header).unwrap();
        let words: Vec<&str> = header.split_whitespace().collect();
        assert_eq!((words[0], &words[2..]), ("fredholm", &["1", "1", "1", "3"][..]));
        assert!(header.is_ascii() && header.ends_with(" \r\n"), "{header:?}");
        let numbers: Vec<f32> =
            rest.chunks(4).map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap())).collect();
        assert_eq!(numbers.len(), 3 + 9 + 3);
        assert_eq!((&numbers[..3], &numbers[12..]), (&[1.0, 0.7, 3.0][..], &[0.9, 0.85, 0.1234][..]));
        for (k, factor) in numbers[3..12].iter().enumerate() {
            assert_eq!(*factor, factors.factor(k / 3, k % 3) as f32, "{k}");
        }
    }
}

/// A disk with room for so many bytes.
struct Small(Cursor<Vec<u8>>, usize);

impl Write for Small {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.0.position() as usize + bytes.len() > self.1 {
            return Err(io::ErrorKind::StorageFull.into());
        }
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl io::Seek for Small {
    fn seek(&mut self, to: io::SeekFrom) -> io::Result<u64> {
        self.0.seek(to)
    }
}

#[test]
fn a_full_disk_is_told_wherever_the_archive_is() {
    let factors = factors(Storage::Single);
    let mut whole = Cursor::new(Vec::new());
    write_npz(&factors, &mut whole).unwrap();
    let length = whole.into_inner().len();
    for room in (0..length).step_by(7) {
        let error = write_npz(&factors, Small(Cursor::new(Vec::new()), room)).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::StorageFull, "with room for {room} bytes");
    }
    assert!(write_npz(&factors, Small(Cursor::new(Vec::new()), length)).is_ok());
}
