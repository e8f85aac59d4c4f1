//! F_·j of the patches that were shot, kept for the other windows: they mostly shoot the same ones first.

use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// A column, or what will be one as soon as somebody has computed it.
type Column = Arc<OnceLock<Vec<f32>>>;

/// Columns of F, as many as there is room for; the oldest go first.
pub struct Shared {
    most: usize,
    kept: Mutex<Kept>,
}

#[derive(Default)]
struct Kept {
    columns: HashMap<usize, Column>,
    order: VecDeque<usize>,
}

/// Bytes of columns: 2600 of 50 000 patches, in which most of the light is shot. A matrix may take more, and is of more use.
const ROOM: u64 = 512 << 20;

impl Shared {
    /// Room for columns of `n` numbers, where so many bytes are free.
    pub fn new(n: usize, memory: u64) -> Self {
        let most = ROOM.min(memory / 4) / (4 * n.max(1) as u64);
        Self { most: most.max(1) as usize, kept: Mutex::default() }
    }

    /// Column j, computed unless it is known; who asks for it meanwhile waits, and computes nothing.
    pub fn column(&self, j: usize, buffer: &mut Vec<f64>, compute: impl FnOnce(&mut Vec<f64>)) {
        let column = self.place(j);
        let mut computed = false;
        let numbers = column.get_or_init(|| {
            compute(buffer);
            computed = true;
            buffer.iter().map(|number| *number as f32).collect()
        });
        // The same for whoever computed it: what all windows see is the same light.
        if computed {
            buffer.iter_mut().for_each(|number| *number = f64::from(*number as f32));
        } else {
            buffer.clear();
            buffer.extend(numbers.iter().map(|number| f64::from(*number)));
        }
    }

    fn place(&self, j: usize) -> Column {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = kept.columns.get(&j) {
            return Arc::clone(known);
        }
        if kept.order.len() == self.most
            && let Some(oldest) = kept.order.pop_front()
        {
            kept.columns.remove(&oldest);
        }
        let column = Column::default();
        kept.columns.insert(j, Arc::clone(&column));
        kept.order.push_back(j);
        column
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_is_computed_once_and_the_oldest_is_forgotten() {
        // Room for two columns.
        let shared = Shared::new(3, 4 * 2 * 3 * 4);
        let mut computed = Vec::new();
        for j in [7, 8, 7, 9, 8, 7] {
            let mut buffer = vec![0.0; 5];
            shared.column(j, &mut buffer, |out| {
                computed.push(j);
                *out = vec![j as f64, 0.1, 0.5];
            });
            assert_eq!(buffer, [j as f64, f64::from(0.1_f32), 0.5]);
        }
        assert_eq!(computed, [7, 8, 9, 7]);
    }
}
