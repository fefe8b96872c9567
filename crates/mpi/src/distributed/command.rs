//! What rank 0 has all ranks do together.

use crate::slepc::World;
use stridor_base::error::Result;
use stridor_linalg::c64;

/// Numbers of a message.
const LENGTH: usize = 6;

/// A step that all ranks perform together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Command {
    /// Receive the places of the entries of a pattern of order `n`.
    Pattern { id: u64, n: u64 },
    /// Factorise a matrix of a pattern, whose values follow; without keeping the factors where `kept` is none.
    Factorize { pattern: u64, kept: Option<u64> },
    /// Solve for right-hand sides of rank 0.
    Solve { factor: u64, count: u64 },
    /// Receive rows of K and M, and find the eigenpairs nearest the shift of a factor of K − σM.
    Eigenpairs { factor: u64, shift: f64, count: u64, tolerance: f64 },
    /// Receive the own part of a quadratic problem of order `n`.
    Quadratic { id: u64, n: u64 },
    /// Find the eigenvalues of a quadratic problem nearest a shift.
    Nearest { quadratic: u64, shift: c64, count: u64, tolerance: f64 },
    /// Forget what has this number.
    Free(u64),
    /// End.
    End,
}

impl Command {
    fn encoded(self) -> [u64; LENGTH] {
        match self {
            Command::Pattern { id, n } => [0, id, n, 0, 0, 0],
            Command::Factorize { pattern, kept } => [1, pattern, kept.map_or(0, |id| id + 1), 0, 0, 0],
            Command::Solve { factor, count } => [2, factor, count, 0, 0, 0],
            Command::Eigenpairs { factor, shift, count, tolerance } => {
                [3, factor, count, shift.to_bits(), tolerance.to_bits(), 0]
            }
            Command::Quadratic { id, n } => [4, id, n, 0, 0, 0],
            Command::Nearest { quadratic, shift, count, tolerance } => {
                [5, quadratic, count, shift.re.to_bits(), shift.im.to_bits(), tolerance.to_bits()]
            }
            Command::Free(id) => [6, id, 0, 0, 0, 0],
            Command::End => [7, 0, 0, 0, 0, 0],
        }
    }

    fn decoded(message: [u64; LENGTH]) -> Self {
        let number = f64::from_bits;
        match message {
            [0, id, n, ..] => Command::Pattern { id, n },
            [1, pattern, kept, ..] => Command::Factorize { pattern, kept: kept.checked_sub(1) },
            [2, factor, count, ..] => Command::Solve { factor, count },
            [3, factor, count, shift, tolerance, _] => {
                Command::Eigenpairs { factor, shift: number(shift), count, tolerance: number(tolerance) }
            }
            [4, id, n, ..] => Command::Quadratic { id, n },
            [5, quadratic, count, re, im, tolerance] => {
                let shift = c64::new(number(re), number(im));
                Command::Nearest { quadratic, shift, count, tolerance: number(tolerance) }
            }
            [6, id, ..] => Command::Free(id),
            _ => Command::End,
        }
    }

    /// Lets the other ranks know of it; on those, gives the next one. Collective.
    pub fn announce(world: &World, command: Option<Command>) -> Result<Command> {
        let mut message = command.map_or([0; LENGTH], Command::encoded);
        world.announce(&mut message)?;
        Ok(Command::decoded(message))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_arrives_as_it_was() {
        for command in [
            Command::Pattern { id: 3, n: 70 },
            Command::Factorize { pattern: 3, kept: None },
            Command::Factorize { pattern: 3, kept: Some(0) },
            Command::Solve { factor: 9, count: 16 },
            Command::Eigenpairs { factor: 9, shift: -1.5, count: 20, tolerance: 1e-9 },
            Command::Quadratic { id: 4, n: 70 },
            Command::Nearest { quadratic: 4, shift: c64::new(0.1, -3.0), count: 5, tolerance: 1e-12 },
            Command::Free(9),
            Command::End,
        ] {
            assert_eq!(Command::decoded(command.encoded()), command);
        }
    }
}
