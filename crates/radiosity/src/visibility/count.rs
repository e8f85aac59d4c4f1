//! How many rays were cast, or pairs seen, counted by all threads without waiting for each other.

use std::sync::atomic::{AtomicU64, Ordering};

/// A sum that many threads add to.
#[derive(Debug, Default)]
pub struct Count([Shard; 16]);

/// How many rays were cast.
pub type RayCount = Count;

/// A cache line of its own: threads that share one would pass it to and fro at every step (some 20 ns).
#[derive(Debug, Default)]
#[repr(align(64))]
struct Shard(AtomicU64);

impl Count {
    /// Counts some more.
    pub fn add(&self, more: u32) {
        let thread = rayon::current_thread_index().unwrap_or(0);
        self.0[thread % self.0.len()].0.fetch_add(u64::from(more), Ordering::Relaxed);
    }

    /// All so far.
    pub fn total(&self) -> u64 {
        self.0.iter().map(|shard| shard.0.load(Ordering::Relaxed)).sum()
    }
}
