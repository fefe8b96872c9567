//! The ranks of an MPI program, and messages between them.

use super::{alone, check, ffi};
use bytemuck::Pod;
use std::ffi::c_int;
use std::sync::atomic::{AtomicBool, Ordering};
use stridor_base::error::Result;

/// Whether MPI has been started: it can be once in a process.
static STARTED: AtomicBool = AtomicBool::new(false);

/// All ranks of the program, which ends their work when it is dropped. Rank 0 leads.
#[derive(Debug)]
pub struct World {
    rank: usize,
    size: usize,
    abandoned: AtomicBool,
}

impl World {
    /// Starts MPI, PETSc and SLEPc; collective. A program that `mpirun` has not started is rank 0 of 1.
    ///
    /// # Panics
    /// When it has been started before in this process.
    pub fn start() -> Result<World> {
        assert!(!STARTED.swap(true, Ordering::SeqCst), "MPI starts once in a process");
        let (mut rank, mut size) = (0, 0);
        // SAFETY: both pointers are valid for the call.
        check("starting MPI", unsafe { ffi::stridor_start(&mut rank, &mut size) })?;
        Ok(World { rank: rank as usize, size: size as usize, abandoned: AtomicBool::new(false) })
    }

    /// The number of this rank, from 0.
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// How many ranks there are.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Copies `values` of rank 0 to all others; collective.
    pub fn broadcast<T: Pod>(&self, values: &mut [T]) -> Result<()> {
        let bytes: &mut [u8] = bytemuck::cast_slice_mut(values);
        let _alone = alone();
        // SAFETY: the slice is valid for reads and writes of its length.
        check("MPI broadcast", unsafe { ffi::stridor_broadcast(bytes.as_mut_ptr(), bytes.len() as i64) })
    }

    /// [`World::broadcast`] of a few values for which the other ranks may wait for long: they leave their cores to others
    /// meanwhile. Collective.
    pub fn announce<T: Pod>(&self, values: &mut [T]) -> Result<()> {
        let bytes: &mut [u8] = bytemuck::cast_slice_mut(values);
        let _alone = alone();
        // SAFETY: the slice is valid for reads and writes of its length until the call returns.
        check("MPI broadcast", unsafe { ffi::stridor_announce(bytes.as_mut_ptr(), bytes.len() as i64) })
    }

    /// Sends `values` to a rank, which [receives](World::receive) them.
    pub fn send<T: Pod>(&self, values: &[T], to: usize) -> Result<()> {
        let count = [values.len() as u64];
        let _alone = alone();
        for bytes in [bytemuck::cast_slice(&count), bytemuck::cast_slice::<T, u8>(values)] {
            // SAFETY: the slice is valid for reads of its length.
            let code = unsafe { ffi::stridor_send(bytes.as_ptr(), bytes.len() as i64, to as c_int) };
            check("MPI send", code)?;
        }
        Ok(())
    }

    /// The values that a rank has [sent](World::send).
    pub fn receive<T: Pod>(&self, from: usize) -> Result<Vec<T>> {
        let mut count = [0u64];
        self.receive_into(&mut count, from)?;
        let mut values = vec![T::zeroed(); count[0] as usize];
        self.receive_into(&mut values, from)?;
        Ok(values)
    }

    /// A rank that has sent something which is not received yet; comes back at once.
    pub fn waiting(&self) -> Result<Option<usize>> {
        let mut from = -1;
        let _alone = alone();
        // SAFETY: the pointer is valid for the call.
        check("MPI probe", unsafe { ffi::stridor_waiting(&mut from) })?;
        Ok(usize::try_from(from).ok())
    }

    /// Leaves MPI running when this is dropped: after an error on this rank alone the others would never come to the common end. The end
    /// of the process then ends them.
    pub fn abandon(&self) {
        self.abandoned.store(true, Ordering::SeqCst);
    }

    fn receive_into<T: Pod>(&self, values: &mut [T], from: usize) -> Result<()> {
        let bytes: &mut [u8] = bytemuck::cast_slice_mut(values);
        let _alone = alone();
        // SAFETY: the slice is valid for writes of its length.
        let code = unsafe { ffi::stridor_receive(bytes.as_mut_ptr(), bytes.len() as i64, from as c_int) };
        check("MPI receive", code)
    }

    /// Ends all ranks at once, whatever they do; comes back only where MPI refuses.
    pub fn abort(&self, code: u8) {
        // SAFETY: allowed at any time between start and end.
        unsafe { ffi::stridor_abort(c_int::from(code)) };
    }
}

impl Drop for World {
    fn drop(&mut self) {
        if self.abandoned.load(Ordering::SeqCst) {
            return;
        }
        let _alone = alone();
        // SAFETY: MPI runs, and nothing uses it any more: the owner of factors and matrices drops them before.
        unsafe { ffi::stridor_stop() };
    }
}
