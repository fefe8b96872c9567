//! What rank 0 has all ranks do together.

use crate::error::Result;
use crate::slepc::World;

/// Numbers of a message.
const LENGTH: usize = 4;

/// A step that all ranks perform together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Command {
    /// Receive the places of the entries of a pattern of order `n`.
    Pattern { id: u64, n: u64 },
    /// Factorise a matrix of a pattern, whose values follow; without keeping the factors where `kept` is none.
    Factorize { pattern: u64, kept: Option<u64> },
    /// Solve for right-hand sides of rank 0.
    Solve { factor: u64, count: u64 },
    /// Forget a factor.
    FreeFactor(u64),
    /// Forget a pattern.
    FreePattern(u64),
    /// End with this exit code.
    End(u8),
}

impl Command {
    fn encoded(self) -> [u64; LENGTH] {
        match self {
            Command::Pattern { id, n } => [0, id, n, 0],
            Command::Factorize { pattern, kept } => [1, pattern, kept.map_or(0, |id| id + 1), 0],
            Command::Solve { factor, count } => [2, factor, count, 0],
            Command::FreeFactor(id) => [3, id, 0, 0],
            Command::FreePattern(id) => [4, id, 0, 0],
            Command::End(code) => [5, u64::from(code), 0, 0],
        }
    }

    fn decoded(message: [u64; LENGTH]) -> Self {
        match message {
            [0, id, n, _] => Command::Pattern { id, n },
            [1, pattern, kept, _] => Command::Factorize { pattern, kept: kept.checked_sub(1) },
            [2, factor, count, _] => Command::Solve { factor, count },
            [3, id, ..] => Command::FreeFactor(id),
            [4, id, ..] => Command::FreePattern(id),
            [_, code, ..] => Command::End(code as u8),
        }
    }

    /// Lets the other ranks know of it; on those, gives the next one. Collective.
    ///
    /// # Errors
    /// MPI refuses.
    pub fn announce(world: &World, command: Option<Command>) -> Result<Command> {
        let mut message = command.map_or([0; LENGTH], Command::encoded);
        world.announce(&mut message)?;
        Ok(Command::decoded(message))
    }
}

#[cfg(test)]
mod tests {
    use super::Command;

    #[test]
    fn a_command_arrives_as_it_was() {
        for command in [
            Command::Pattern { id: 3, n: 70 },
            Command::Factorize { pattern: 3, kept: None },
            Command::Factorize { pattern: 3, kept: Some(0) },
            Command::Solve { factor: 9, count: 16 },
            Command::FreeFactor(9),
            Command::FreePattern(3),
            Command::End(2),
        ] {
            assert_eq!(Command::decoded(command.encoded()), command);
        }
    }
}
