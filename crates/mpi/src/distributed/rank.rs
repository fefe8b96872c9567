//! What a rank holds, and how it performs the commands of rank 0.

use super::command::Command;
use crate::slepc::{DistributedFactor, DistributedMatrix, Entries, KrylovSchur, Quadratic, Rows, World};
use std::collections::HashMap;
use stridor_base::error::Result;
use stridor_linalg::{Inertia, c64};

/// The part of the patterns, factors and problems that lies on this rank, each with its number.
#[derive(Debug)]
pub struct Rank {
    patterns: HashMap<u64, Entries>,
    factors: HashMap<u64, DistributedFactor>,
    quadratics: HashMap<u64, Quadratic>,
    // Ends MPI when it is dropped: after the others.
    world: World,
}

/// A factorisation in figures.
#[derive(Debug, Clone, Copy)]
pub struct Factorized {
    /// Signs of the eigenvalues.
    pub inertia: Inertia,
    /// Bytes of the factors on all ranks.
    pub memory_bytes: usize,
}

/// The own part of a quadratic problem.
#[derive(Debug)]
pub struct QuadraticPart {
    /// n.
    pub n: usize,
    /// Of K, C and M.
    pub matrices: [Rows; 3],
    /// The own rows of B, column after column.
    pub basis: Vec<f64>,
    /// c.
    pub coefficients: Vec<f64>,
}

impl Rank {
    /// A rank that holds nothing yet.
    pub fn new(world: World) -> Self {
        Rank { patterns: HashMap::new(), factors: HashMap::new(), quadratics: HashMap::new(), world }
    }

    /// The ranks.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// Holds the own part of a pattern.
    pub fn add_pattern(&mut self, id: u64, entries: Entries) {
        self.patterns.insert(id, entries);
    }

    /// Factorises with the own values of a pattern; collective.
    pub fn factorize(&mut self, pattern: u64, kept: Option<u64>, mut values: Vec<f64>) -> Result<Factorized> {
        let entries = self.patterns.get_mut(&pattern).expect("a pattern that was sent");
        let factor = DistributedFactor::new(&self.world, entries, &mut values, kept.is_some())?;
        let figures = Factorized { inertia: factor.inertia(), memory_bytes: factor.memory_bytes() };
        if let Some(id) = kept {
            self.factors.insert(id, factor);
        }
        Ok(figures)
    }

    /// Solves for the columns of rank 0; collective.
    pub fn solve(&mut self, factor: u64, columns: &mut [f64], count: usize) -> Result<()> {
        self.factors.get_mut(&factor).expect("a factor that was made").solve(columns, count)
    }

    /// The eigenpairs nearest the shift of a factor; collective. See [`KrylovSchur::solve`].
    pub fn eigenpairs(
        &mut self,
        pencil: [Rows; 2],
        (factor, shift): (u64, f64),
        order: &[i32],
        count: usize,
        tolerance: f64,
    ) -> Result<(Vec<f64>, Vec<f64>)> {
        let factor = self.factors.get_mut(&factor).expect("a factor that was made");
        let n = factor.n();
        let [k, m] = pencil.map(|rows| DistributedMatrix::new(&self.world, n, &rows));
        let (k, m) = (k?, m?);
        KrylovSchur { pencil: [&k, &m], factor, order, shift }.solve(&self.world, count, tolerance)
    }

    /// Takes the own part of a quadratic problem; collective.
    pub fn add_quadratic(&mut self, id: u64, part: QuadraticPart) -> Result<()> {
        let QuadraticPart { n, matrices, basis, coefficients } = part;
        let [k, c, m] = matrices.map(|rows| DistributedMatrix::new(&self.world, n, &rows));
        self.quadratics.insert(id, Quadratic { matrices: [k?, c?, m?], basis, coefficients });
        Ok(())
    }

    /// The eigenvalues of a quadratic problem nearest a shift; collective.
    pub fn nearest(&mut self, quadratic: u64, shift: c64, count: usize, tolerance: f64) -> Result<Vec<c64>> {
        let quadratic = self.quadratics.get(&quadratic).expect("a problem that was sent");
        quadratic.nearest(&self.world, shift, count, tolerance)
    }

    /// Forgets what has this number; collective.
    pub fn free(&mut self, id: u64) {
        self.patterns.remove(&id);
        self.factors.remove(&id);
        self.quadratics.remove(&id);
    }
}

/// Sends the own rows of a matrix to another rank.
pub fn send_rows(world: &World, rows: &Rows, to: usize) -> Result<()> {
    world.send(&rows.starts, to)?;
    world.send(&rows.columns, to)?;
    world.send(&rows.values, to)
}

fn receive_rows(world: &World) -> Result<Rows> {
    Ok(Rows { starts: world.receive(0)?, columns: world.receive(0)?, values: world.receive(0)? })
}

/// Performs the commands of rank 0 until it ends; gives the exit code.
///
/// # Errors
/// MPI refuses. An error of a collective step is one of rank 0, too, which reports it.
pub fn serve(world: World) -> Result<()> {
    let mut rank = Rank::new(world);
    loop {
        let command = Command::announce(rank.world(), None)?;
        let world = rank.world();
        // What fails here fails on rank 0, too.
        match command {
            Command::Pattern { id, n } => {
                let [rows, columns] = [world.receive(0)?, world.receive(0)?];
                rank.add_pattern(id, Entries { n: n as i32, rows, columns, place: Vec::new() });
            }
            Command::Factorize { pattern, kept } => {
                let values = world.receive(0)?;
                let _ = rank.factorize(pattern, kept, values);
            }
            Command::Solve { factor, count } => {
                let _ = rank.solve(factor, &mut [], count as usize);
            }
            Command::Eigenpairs { factor, shift, count, tolerance } => {
                let pencil = [receive_rows(world)?, receive_rows(world)?];
                let _ = rank.eigenpairs(pencil, (factor, shift), &[], count as usize, tolerance);
            }
            Command::Quadratic { id, n } => {
                let part = QuadraticPart {
                    n: n as usize,
                    matrices: [receive_rows(world)?, receive_rows(world)?, receive_rows(world)?],
                    basis: world.receive(0)?,
                    coefficients: world.receive(0)?,
                };
                let _ = rank.add_quadratic(id, part);
            }
            Command::Nearest { quadratic, shift, count, tolerance } => {
                let _ = rank.nearest(quadratic, shift, count as usize, tolerance);
            }
            Command::Free(id) => rank.free(id),
            Command::End => return Ok(()),
        }
    }
}
