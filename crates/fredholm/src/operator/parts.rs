//! What an operator may do better than line by line for a solver that changes u bit by bit: F = L M, where M takes means of u over
//! parts and L is sparse, so that neither a row nor a column need be spelled out.

use std::fmt::Debug;

/// F u by groups of unknowns while u changes group after group: for Gauss–Seidel.
pub trait Gather<V>: Debug + Send + Sync {
    /// How many groups there are; each unknown is in one.
    fn groups(&self) -> usize;

    /// What a group gathers from u. The first one begins a sweep: u may be any then, and is afterwards what was told.
    fn group(&mut self, group: usize, u: &[V]) -> Gathered<'_, V>;

    /// The unknowns of a group have changed by these steps.
    fn changed(&mut self, group: usize, steps: &[V]);
}

/// Of the unknowns of a group.
#[derive(Clone, Copy, Debug)]
pub struct Gathered<'a, V> {
    /// Which they are.
    pub unknowns: &'a [usize],
    /// (F u)_i of each.
    pub sums: &'a [V],
    /// F_ik between them, row by row.
    pub inside: &'a [f64],
}

/// Columns of F that are added up before they are received: for Southwell's method. What unknowns of one part send is held until it
/// is much.
pub trait Shoot<V>: Debug + Send + Sync {
    /// Unknown j has changed by a step: column j times that is held.
    fn send(&mut self, j: usize, step: V);

    /// No unknown has more than about that to receive, in the largest channel.
    fn held(&self) -> f64;

    /// Delivers the largest part of what is held: unknowns, and what each receives.
    fn deliver(&mut self, receive: &mut dyn FnMut(&[usize], &[V]));

    /// What each unknown has to receive.
    fn outstanding(&self) -> Vec<V>;
}
