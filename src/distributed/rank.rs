//! What a rank holds, and how it performs the commands of rank 0.

use super::command::Command;
use crate::error::Result;
use crate::linalg::Inertia;
use crate::slepc::{DistributedFactor, Entries, World};
use std::collections::HashMap;

/// The part of the patterns and factors that lies on this rank.
#[derive(Debug)]
pub struct Rank {
    patterns: HashMap<u64, Entries>,
    factors: HashMap<u64, DistributedFactor>,
    // Ends MPI when it is dropped: after the factors.
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

impl Rank {
    /// A rank that holds nothing yet.
    pub fn new(world: World) -> Self {
        Rank { patterns: HashMap::new(), factors: HashMap::new(), world }
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
    ///
    /// # Errors
    /// As [`DistributedFactor::new`].
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
    ///
    /// # Errors
    /// As [`DistributedFactor::solve`].
    pub fn solve(&mut self, factor: u64, columns: &mut [f64], count: usize) -> Result<()> {
        self.factors.get_mut(&factor).expect("a factor that was made").solve(columns, count)
    }

    /// Forgets a factor; collective.
    pub fn free_factor(&mut self, id: u64) {
        self.factors.remove(&id);
    }

    /// Forgets a pattern.
    pub fn free_pattern(&mut self, id: u64) {
        self.patterns.remove(&id);
    }
}

/// Performs the commands of rank 0 until it ends; gives the exit code.
///
/// # Errors
/// MPI refuses. An error of a collective step is one of rank 0, too, which reports it.
pub fn serve(world: World) -> Result<u8> {
    let mut rank = Rank::new(world);
    loop {
        match Command::announce(rank.world(), None)? {
            Command::Pattern { id, n } => {
                let [rows, columns] = [rank.world().receive(0)?, rank.world().receive(0)?];
                rank.add_pattern(id, Entries { n: n as i32, rows, columns, place: Vec::new() });
            }
            Command::Factorize { pattern, kept } => {
                let values = rank.world().receive(0)?;
                // Rank 0 has the same error.
                let _ = rank.factorize(pattern, kept, values);
            }
            Command::Solve { factor, count } => {
                let _ = rank.solve(factor, &mut [], count as usize);
            }
            Command::FreeFactor(id) => rank.free_factor(id),
            Command::FreePattern(id) => rank.free_pattern(id),
            Command::End(code) => return Ok(code),
        }
    }
}
