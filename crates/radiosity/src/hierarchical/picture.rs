//! Who gathers from what: receivers against senders, both in the order of the tree, as an SVG.

use super::Hierarchical;
use std::fmt::Write;
use std::ops::Range;

/// The side of the matrix, in the picture's units.
const SIDE: f64 = 960.0;

/// Cells along a side, at most: what is finer is seen as its mean.
const CELLS: usize = 240;

/// From single patches to the largest clusters: where all patches of the receiver get something, and where some get nothing.
const SHADES: [[&str; 6]; 2] = [
    ["#08306b", "#08519c", "#2171b5", "#4292c6", "#6baed6", "#9ecae1"],
    ["#7f2704", "#a63603", "#d94801", "#f16913", "#fd8d3c", "#fdae6b"],
];

/// What the links over a cell have in common; all are sums over the pairs of patches in it.
#[derive(Clone, Copy, Debug, Default)]
struct Cell {
    linked: f64,
    /// log₂ of the patches of the sender.
    size: f64,
    /// Of links that bring some patches of the receiver nothing.
    partly: f64,
}

impl Hierarchical {
    /// A picture of the links as an SVG: receivers go down and senders to the right, in the order of the tree of clusters. The
    /// darker, the fewer patches a sender has. Blue is where all patches that share a cut get something, orange where some get nothing,
    /// as something hides the sender from them or they face away; white is where no link is, since nothing would arrive or next to
    /// nothing.
    pub fn picture(&self) -> String {
        let n = self.places.len().max(1);
        let (side, largest) = (CELLS.min(n), self.largest_sender());
        let cells = self.cells(side);
        let mut body = String::new();
        for (row, cells) in cells.chunks(side).enumerate() {
            let shades: Vec<Option<&str>> = cells
                .iter()
                .enumerate()
                .map(|(k, cell)| shade(cell, pairs(n, side, row, k), largest))
                .collect();
            let mut k = 0;
            for run in shades.chunk_by(|a, b| a == b) {
                if let Some(shade) = run[0] {
                    let unit = SIDE / side as f64;
                    let (x, y, width) = (k as f64 * unit, row as f64 * unit, run.len() as f64 * unit);
                    // Writing to a string does not fail.
                    let _ = writeln!(
                        body,
                        "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{unit:.1}\" fill=\"{shade}\"/>"
                    );
                }
                k += run.len();
            }
        }
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-12 -56 984 1028\" font-family=\"sans-serif\" \
             font-size=\"16\" text-anchor=\"middle\" shape-rendering=\"crispEdges\">\n\
             <rect x=\"-12\" y=\"-56\" width=\"984\" height=\"1028\" fill=\"white\"/>\n\
             <text x=\"480\" y=\"-32\">{n} patches, down, gather by {} links from clusters of 1 to {largest} of them, across: \
             the darker the smaller</text>\n\
             <text x=\"480\" y=\"-12\">blue: all that share a cut get something; orange: not all; white: no link</text>\n\
             <rect x=\"0\" y=\"0\" width=\"960\" height=\"960\" fill=\"none\" stroke=\"#cccccc\"/>\n{body}</svg>\n",
            self.statistics.links,
        )
    }

    fn largest_sender(&self) -> usize {
        let senders = self.blocks().flat_map(|block| block.columns());
        senders.map(|(sender, _)| self.clusters.tree.range(sender).len()).max().unwrap_or(1)
    }

    /// Row by row.
    fn cells(&self, side: usize) -> Vec<Cell> {
        let tree = &self.clusters.tree;
        let n = self.places.len();
        let mut cells = vec![Cell::default(); side * side];
        for block in self.blocks() {
            for (sender, column) in block.columns() {
                let range = tree.range(sender);
                let size = (range.len() as f64).log2();
                let partly = f64::from(u8::from(column.contains(&0.0)));
                for (row, height) in spans(n, side, tree.range(block.receiver())) {
                    for (k, width) in spans(n, side, range.clone()) {
                        let (cell, pairs) = (&mut cells[row * side + k], height * width);
                        cell.linked += pairs;
                        cell.size += pairs * size;
                        cell.partly += pairs * partly;
                    }
                }
            }
        }
        cells
    }
}

/// The places of a cell of so many along a side.
fn places(n: usize, side: usize, cell: usize) -> Range<usize> {
    cell * n / side..(cell + 1) * n / side
}

fn pairs(n: usize, side: usize, row: usize, column: usize) -> f64 {
    (places(n, side, row).len() * places(n, side, column).len()) as f64
}

/// The cells that a range of places is in, each with how many of them.
fn spans(n: usize, side: usize, range: Range<usize>) -> impl Iterator<Item = (usize, f64)> {
    let first = ((range.start + 1) * side).div_ceil(n) - 1;
    (first..side)
        .map(move |cell| (cell, places(n, side, cell)))
        .take_while({
            let end = range.end;
            move |(_, places)| places.start < end
        })
        .map(move |(cell, places)| (cell, (places.end.min(range.end) - places.start.max(range.start)) as f64))
}

/// The colour of a cell; none where most of its pairs have no link.
fn shade(cell: &Cell, pairs: f64, largest: usize) -> Option<&'static str> {
    let shades = &SHADES[usize::from(2.0 * cell.partly > cell.linked)];
    let part = cell.size / cell.linked / (largest as f64).log2().max(1.0);
    (2.0 * cell.linked > pairs).then(|| shades[((part * 6.0) as usize).min(5)])
}
