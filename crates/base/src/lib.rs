//! What every part of stridor needs: errors that carry data ([`error`]), progress of long work ([`progress`]), numbers as text
//! ([`numbers`]), input files of a bounded size ([`input`]), the memory that is left ([`memory`]), memory in large pages ([`pages`]), connected components ([`connected`]), what solid materials have ([`solids`]), universal files as datasets ([`universal`]) and, for tests, comparisons with the origin of their bounds ([`bounds`]).

pub mod bounds;
pub mod connected;
pub mod error;
pub mod input;
pub mod memory;
pub mod numbers;
pub mod pages;
pub mod progress;
pub mod solids;
pub mod universal;
