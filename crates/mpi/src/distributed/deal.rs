//! Numbers handed out to the ranks as they come free.

use crate::slepc::World;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;
use stridor_base::error::Result;

/// How long rank 0 sleeps between looks for requests of other ranks.
const PAUSE: Duration = Duration::from_millis(1);

/// Takes note of a rank and the number that it got.
type Handed = dyn Fn(usize, usize) + Send + Sync;

/// Hands out 0, 1, 2, … below `count`, each to one rank.
pub struct Deal {
    world: Arc<World>,
    count: u64,
    next: Arc<AtomicU64>,
    handed: Arc<Handed>,
    /// On rank 0, the thread that answers the others.
    answering: Option<JoinHandle<Result<()>>>,
}

impl Deal {
    /// Begins to hand out; collective. `handed` is called on rank 0 with each rank and number.
    pub fn new(world: &Arc<World>, count: usize, handed: Arc<Handed>) -> Self {
        let (next, count) = (Arc::new(AtomicU64::new(0)), count as u64);
        let mut deal = Deal {
            world: Arc::clone(world),
            count,
            next: Arc::clone(&next),
            handed: Arc::clone(&handed),
            answering: None,
        };
        if world.rank() == 0 {
            let world = Arc::clone(world);
            deal.answering = Some(std::thread::spawn(move || {
                let mut waiting = world.size() - 1;
                while waiting > 0 {
                    let Some(from) = world.waiting()? else {
                        std::thread::sleep(PAUSE);
                        continue;
                    };
                    world.receive::<u64>(from)?;
                    let number = next.fetch_add(1, Ordering::SeqCst);
                    if number < count {
                        handed(from, number as usize);
                    } else {
                        waiting -= 1;
                    }
                    world.send(&[number], from)?;
                }
                Ok(())
            }));
        }
        deal
    }

    /// The next number; none when all are handed out.
    pub fn next(&self) -> Result<Option<usize>> {
        let number = match self.world.rank() {
            0 => {
                let number = self.next.fetch_add(1, Ordering::SeqCst);
                if number < self.count {
                    (self.handed)(0, number as usize);
                }
                number
            }
            _ => {
                self.world.send(&[0u64], 0)?;
                self.world.receive::<u64>(0)?[0]
            }
        };
        Ok((number < self.count).then_some(number as usize))
    }

    /// Waits until every rank has seen that all are handed out; collective.
    pub fn end(mut self) -> Result<()> {
        match self.answering.take() {
            Some(thread) => thread.join().expect("a thread without a panic"),
            None => Ok(()),
        }
    }
}
