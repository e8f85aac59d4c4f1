//! The blocks as they lie in the matrix, the darker the higher their rank: an SVG.

use super::Hierarchical;
use super::block::Kept;
use std::collections::BTreeSet;
use std::fmt::Write;
use std::ops::Range;

/// The side of the matrix, in the picture's units.
const SIDE: f64 = 960.0;

/// What is smaller than this part of the matrix is not drawn by itself.
const CELLS: usize = 320;

/// A block of so many units has its rank written in it.
const ROOM: f64 = 24.0;

/// Of dense blocks, of low ranks, of high ones, and of what is too small to be told apart.
const COLOURS: [[u8; 3]; 4] = [[224, 112, 48], [222, 235, 247], [8, 69, 148], [120, 110, 110]];

impl Hierarchical {
    /// A picture of the blocks as an SVG: dense ones orange, the others the bluer the higher their rank, which is written in
    /// those with room for it. Rows go down and columns to the right, in the order of the cluster tree. Blocks of less than
    /// a 320th of the matrix are grey, cell by cell.
    pub fn picture(&self) -> String {
        let n = self.order.len().max(1);
        let least = n.div_ceil(CELLS);
        let (mut body, mut cells) = (String::new(), BTreeSet::new());
        for (rows, columns, rank) in self.outlines() {
            if rows.len() < least || columns.len() < least {
                cells.insert((rows.start / least, columns.start / least));
            } else {
                self.draw((rows, columns), rank, &mut body);
            }
        }
        for (row, column) in cells {
            let span = |cell: usize| cell * least..((cell + 1) * least).min(n);
            rectangle(n, (&span(row), &span(column)), COLOURS[3], &mut body);
        }
        let told = &self.statistics;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-12 -36 984 1008\" font-family=\"sans-serif\" \
             text-anchor=\"middle\">\n<rect x=\"-12\" y=\"-36\" width=\"984\" height=\"1008\" fill=\"white\"/>\n\
             <text x=\"480\" y=\"-12\" font-size=\"18\">{} unknowns: {} dense blocks, {} of ranks {} to {}, {:.3} % of the dense matrix's \
             memory</text>\n{body}</svg>\n",
            told.unknowns,
            told.dense_blocks,
            told.low_rank_blocks,
            told.ranks.0,
            told.ranks.2,
            100.0 * told.compression(),
        )
    }

    /// Rows, columns and rank of each block; no rank for dense ones.
    fn outlines(&self) -> impl Iterator<Item = (&Range<usize>, &Range<usize>, Option<usize>)> {
        let small = self.shelves.iter().flat_map(super::Shelf::blocks).map(|block| match block.kept {
            Kept::Dense(_) => (block.rows, block.columns, None),
            Kept::LowRank { values, .. } => (block.rows, block.columns, Some(values.len())),
        });
        let large = (0..self.large.len()).map(|block| {
            let (rows, columns) = self.large.outline(block);
            (rows, columns, Some(self.large.span(block).len()))
        });
        small.chain(large)
    }

    fn draw(&self, span: (&Range<usize>, &Range<usize>), rank: Option<usize>, body: &mut String) {
        let n = self.order.len();
        let colour = match rank {
            None => COLOURS[0],
            Some(rank) => mixed(rank as f64 / self.statistics.ranks.2.max(1) as f64),
        };
        rectangle(n, span, colour, body);
        let unit = SIDE / n as f64;
        let (height, width) = (span.0.len() as f64 * unit, span.1.len() as f64 * unit);
        if let Some(rank) = rank.filter(|_| height.min(width) >= ROOM) {
            let (x, y) =
                (span.1.start as f64 * unit + 0.5 * width, span.0.start as f64 * unit + 0.5 * height + 4.0);
            let ink = if 2 * rank > self.statistics.ranks.2 { "white" } else { "black" };
            // Writing to a string does not fail.
            let _ = writeln!(
                body,
                "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"12\" fill=\"{ink}\">{rank}</text>"
            );
        }
    }
}

fn rectangle(n: usize, (rows, columns): (&Range<usize>, &Range<usize>), colour: [u8; 3], body: &mut String) {
    let unit = SIDE / n as f64;
    let [red, green, blue] = colour;
    let (x, y) = (columns.start as f64 * unit, rows.start as f64 * unit);
    let (width, height) = (columns.len() as f64 * unit, rows.len() as f64 * unit);
    let _ = writeln!(
        body,
        "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{width:.2}\" height=\"{height:.2}\" fill=\"#{red:02x}{green:02x}{blue:02x}\" \
         stroke=\"white\" stroke-width=\"0.4\"/>"
    );
}

/// Between the colours of low ranks and of high ones.
fn mixed(part: f64) -> [u8; 3] {
    let (low, high) = (COLOURS[1], COLOURS[2]);
    std::array::from_fn(|k| {
        (f64::from(low[k]) + part * (f64::from(high[k]) - f64::from(low[k]))).round() as u8
    })
}
