//! u_i ← u_i + r_i / (1 − ρ_i F_ii) for the i of the largest |r_i| w_i: Southwell (paper, §3.4.4, (3.10)).

use super::{Largest, Relaxation, step};
use crate::neumann::estimated_rest;
use crate::operator::{Columns, Shoot};
use crate::system::System;
use crate::value::{Value, max_norm};

/// Southwell's method from u = 0, shooting along columns: with areas for weights it is the progressive radiosity
/// algorithm (paper, §3.5.2), whose picture is u + r.
///
/// A sweep relaxes one unknown. Its residual update costs O(n) and one column of F, which may be computed for the
/// purpose and forgotten: the memory is O(n). An operator that has its own way of [`shooting`](Columns::shooting) holds back what
/// unknowns send until it is as large as the largest residual: then i is of the largest residual but for what is held.
#[derive(Debug)]
pub struct Southwell<'a, V, F> {
    system: System<'a, V, F>,
    weights: &'a [f64],
    ambient: bool,
    solution: Vec<V>,
    residual: Vec<V>,
    gathered: Vec<V>,
    buffer: Vec<f64>,
    held: Option<Held<'a, V>>,
}

/// What is sent and not yet received, with the largest residuals, weighted and not.
#[derive(Debug)]
struct Held<'a, V> {
    shoot: Box<dyn Shoot<V> + 'a>,
    weighted: Largest,
    residuals: Largest,
}

impl<'a, V: Value, F: Columns> Southwell<'a, V, F> {
    /// Starts from u = 0; `weights` are positive, one per unknown: ones for Southwell's own choice of i.
    pub fn new(system: System<'a, V, F>, weights: &'a [f64]) -> Self {
        assert_eq!(weights.len(), system.source.len(), "one weight per unknown");
        let sizes = || system.source.iter().map(V::magnitude);
        let held = system.operator.shooting().map(|shoot| Held {
            shoot,
            weighted: Largest::new(sizes().zip(weights).map(|(size, weight)| size * weight)),
            residuals: Largest::new(sizes()),
        });
        Self {
            system,
            weights,
            ambient: false,
            solution: vec![V::splat(0.0); system.source.len()],
            residual: system.source.to_vec(),
            gathered: vec![V::splat(0.0); system.source.len()],
            buffer: Vec::new(),
            held,
        }
    }

    /// Adds to previews the ambient estimate: ρ times the [`estimated_rest`] of the Neumann series.
    pub fn with_ambient(mut self) -> Self {
        self.ambient = true;
        self
    }

    /// F u, carried along with the residual: what each unknown has gathered, or has to receive.
    pub fn gathered(&self) -> Vec<V> {
        let mut gathered = self.gathered.clone();
        if let Some(held) = &self.held {
            gathered.iter_mut().zip(held.shoot.outstanding()).for_each(|(sum, held)| *sum += held);
        }
        gathered
    }

    /// Relaxes one unknown after what is held is no larger than the residuals; returns a bound of these.
    fn sweep_held(&mut self, held: &mut Held<'a, V>) -> f64 {
        while held.shoot.held() > held.residuals.size() {
            held.shoot.deliver(&mut |unknowns, received| {
                for (i, received) in unknowns.iter().zip(received) {
                    self.gathered[*i] += *received;
                    self.residual[*i] += self.system.coefficient[*i] * *received;
                    let size = self.residual[*i].magnitude();
                    held.weighted.set(*i, size * self.weights[*i]);
                    held.residuals.set(*i, size);
                }
            });
        }
        let i = held.weighted.first();
        let step = step(self.residual[i], self.system.coefficient[i], self.system.operator.diagonal(i));
        self.solution[i] += step;
        self.residual[i] -= step;
        held.weighted.set(i, self.residual[i].magnitude() * self.weights[i]);
        held.residuals.set(i, self.residual[i].magnitude());
        held.shoot.send(i, step);
        held.residuals.size() + held.shoot.held()
    }

    /// The unknown with the largest weighted residual, the first of equals; a NaN is chosen at once.
    fn choose(&self) -> usize {
        let mut best = (0, -1.0);
        for (i, (r, w)) in self.residual.iter().zip(self.weights).enumerate() {
            let size = r.magnitude() * w;
            if size.is_nan() {
                return i;
            }
            if size > best.1 {
                best = (i, size);
            }
        }
        best.0
    }
}

impl<V: Value, F: Columns> Relaxation<V> for Southwell<'_, V, F> {
    fn sweep(&mut self) -> f64 {
        if self.residual.is_empty() {
            return 0.0;
        }
        if let Some(mut held) = self.held.take() {
            let norm = self.sweep_held(&mut held);
            self.held = Some(held);
            return norm;
        }
        let i = self.choose();
        let column = self.system.operator.column(i, &mut self.buffer);
        let step = step(self.residual[i], self.system.coefficient[i], column.get(i));
        self.solution[i] += step;
        let receivers = self.residual.iter_mut().zip(&mut self.gathered).zip(self.system.coefficient);
        for (((r, gathered), rho), entry) in receivers.zip(column.iter()) {
            let received = step * entry;
            *gathered += received;
            *r += *rho * received;
        }
        self.residual[i] = V::splat(0.0);
        max_norm(&self.residual)
    }

    fn solution(&self) -> Vec<V> {
        self.solution.clone()
    }

    fn residual(&self) -> Vec<V> {
        let Some(held) = &self.held else { return self.residual.clone() };
        let outstanding = held.shoot.outstanding();
        let all = self.residual.iter().zip(outstanding).zip(self.system.coefficient);
        all.map(|((r, received), rho)| *r + *rho * received).collect()
    }

    fn preview(&self) -> Vec<V> {
        let rho = self.system.coefficient;
        let rest = match self.ambient {
            true => estimated_rest(&self.residual, rho, self.weights),
            false => V::splat(0.0),
        };
        let shown = self.solution.iter().zip(&self.residual).zip(rho);
        shown.map(|((u, r), rho)| *u + *r + *rho * rest).collect()
    }
}
