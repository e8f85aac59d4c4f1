//! The largest of many numbers while they change one by one: a tree of maxima.

/// Sizes, and the largest of them; a NaN is larger than any.
#[derive(Clone, Debug, PartialEq)]
pub struct Largest {
    /// The sizes, the maxima over each [`FAN`] of them, over each of these, and so on to a single one.
    levels: Vec<Vec<f64>>,
}

/// Numbers under one maximum: a change looks at that many where the largest of them falls.
const FAN: usize = 16;

impl Largest {
    /// Of these sizes, which are not negative.
    pub fn new(sizes: impl Iterator<Item = f64>) -> Self {
        let mut levels = vec![sizes.map(comparable).collect::<Vec<f64>>()];
        while let Some(last) = levels.last().filter(|last| last.len() > 1) {
            levels.push(last.chunks(FAN).map(most).collect());
        }
        Self { levels }
    }

    /// Number `at` is now of this size.
    pub fn set(&mut self, mut at: usize, size: f64) {
        let mut size = comparable(size);
        for level in 0..self.levels.len() {
            let before = std::mem::replace(&mut self.levels[level][at], size);
            let Some(above) = self.levels.get(level + 1).map(|above| above[at / FAN]) else { return };
            at /= FAN;
            if size < above {
                if before < above {
                    return;
                }
                let fan = FAN * at..(FAN * (at + 1)).min(self.levels[level].len());
                size = most(&self.levels[level][fan]);
            }
        }
    }

    /// The largest size; 0 of none.
    pub fn size(&self) -> f64 {
        self.levels.last().and_then(|top| top.first()).copied().unwrap_or(0.0)
    }

    /// The first of those with the largest size.
    pub fn first(&self) -> usize {
        self.levels.iter().rev().skip(1).fold(0, |at, level| {
            let fan = &level[FAN * at..(FAN * (at + 1)).min(level.len())];
            let largest = most(fan);
            FAN * at + fan.iter().position(|size| *size == largest).unwrap_or(0)
        })
    }
}

fn comparable(size: f64) -> f64 {
    if size.is_nan() { f64::INFINITY } else { size }
}

fn most(sizes: &[f64]) -> f64 {
    sizes.iter().fold(0.0, |a, b| if *b > a { *b } else { a })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_what_a_look_at_all_would_find() {
        let mut sizes: Vec<f64> = (0..1000).map(|k| f64::from(k * 7919 % 1009)).collect();
        let mut largest = Largest::new(sizes.iter().copied());
        for step in 0..5000_usize {
            let size = *sizes.iter().max_by(|a, b| a.total_cmp(b)).unwrap();
            assert_eq!(largest.size(), size);
            let first = sizes.iter().position(|s| *s == size).unwrap();
            assert_eq!(largest.first(), first, "step {step}");
            // The largest falls, or another changes to anything.
            let at = if step % 3 == 0 { step * 577 % 1000 } else { first };
            sizes[at] = (step * 31 % 997) as f64 * if step % 5 == 0 { 1.0 } else { 0.1 };
            largest.set(at, sizes[at]);
        }
        largest.set(700, f64::NAN);
        assert_eq!((largest.first(), largest.size()), (700, f64::INFINITY));
    }

    #[test]
    fn nothing_and_one_have_a_largest() {
        assert_eq!(Largest::new(std::iter::empty()).size(), 0.0);
        let mut one = Largest::new(std::iter::once(3.0));
        one.set(0, 2.0);
        assert_eq!((one.first(), one.size()), (0, 2.0));
    }
}
