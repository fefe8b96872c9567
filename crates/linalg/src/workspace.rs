//! Workspace: blocks of memory that are used again by the next call that needs as much.
//!
//! A block of a few megabytes that is given back goes to the operating system, which has to clear every page before it hands
//! it out again: for products and substitutions with multivectors that would be a tenth of their time.

use std::any::Any;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Blocks at rest.
static AT_REST: Mutex<Rest> = Mutex::new(Rest { calls: 0, blocks: Vec::new() });
/// The most of them that are kept: two for each of two threads.
const MOST: usize = 4;
/// Calls for workspace after which a block that was of no use to any of them is given back.
const IDLE: u64 = 12;

/// Blocks, each with the number of calls when it was allocated.
struct Rest {
    calls: u64,
    blocks: Vec<(u64, Box<dyn Any + Send>)>,
}

/// The result of `f` on workspace for `n` values, which hold whatever they held before.
pub(super) fn with_workspace<T: Copy + Send + 'static, R>(
    n: usize,
    zero: T,
    f: impl FnOnce(&mut [T]) -> R,
) -> R {
    let found = {
        let mut kept = at_rest();
        kept.calls += 1;
        let blocks = &mut kept.blocks;
        blocks.iter().position(|(_, block)| block.is::<Vec<T>>()).map(|k| blocks.remove(k).1)
    };
    let mut block = found.and_then(|block| block.downcast::<Vec<T>>().ok()).unwrap_or_default();
    if block.len() < n {
        block = Box::new(vec![zero; n]);
    }
    let result = f(&mut block[..n]);
    let mut kept = at_rest();
    let Rest { calls, blocks } = &mut *kept;
    blocks.retain(|(laid_down, _)| *calls - laid_down <= IDLE);
    if blocks.len() == MOST {
        blocks.remove(0);
    }
    blocks.push((*calls, block));
    result
}

/// A panic elsewhere leaves nothing half done here.
fn at_rest() -> MutexGuard<'static, Rest> {
    AT_REST.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn room_is_as_long_as_asked_for_whatever_was_there_before() {
        // A type of its own: other tests take workspace at the same time.
        #[derive(Clone, Copy, PartialEq, Debug)]
        struct Own(u8);
        for n in [5, 0, 9, 3] {
            let filled = with_workspace(n, Own(0), |block| {
                block.fill(Own(7));
                // Inside, another block.
                with_workspace(4, Own(1), |other| other.fill(Own(2)));
                block.to_vec()
            });
            assert_eq!(filled, vec![Own(7); n]);
        }
    }
}
