//! F ≈ F̃, in blocks U Vᵀ of low rank where clusters of unknowns are far apart, and dense ones where they are near.

mod cluster;

pub use cluster::{Bounds, Cluster, ClusterError, ClusterTree};
