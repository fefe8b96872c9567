//! An allocator that counts bytes in use and their peak, over all threads, from the beginning of a reading.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicIsize, Ordering::Relaxed};

/// Bytes of one reading beyond which it is taken to be without bound.
const CEILING: isize = 1 << 30;

/// May be negative: what was there before the reading is freed.
static IN_USE: AtomicIsize = AtomicIsize::new(0);
static PEAK: AtomicIsize = AtomicIsize::new(0);

/// The system's allocator with counters.
pub struct Counting;

/// A layout is never longer than `isize` holds.
fn grown(bytes: usize) {
    let bytes = bytes as isize;
    let in_use = IN_USE.fetch_add(bytes, Relaxed) + bytes;
    PEAK.fetch_max(in_use, Relaxed);
    if in_use > CEILING {
        super::watch::give_up(b"more than 1 GiB is asked for\n");
    }
}

// SAFETY: every call goes to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        grown(layout.size());
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        grown(layout.size());
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        IN_USE.fetch_sub(layout.size() as isize, Relaxed);
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // As if the new block were there before the old one is freed.
        grown(size);
        IN_USE.fetch_sub(layout.size() as isize, Relaxed);
        unsafe { System.realloc(pointer, layout, size) }
    }
}

/// The value of `act` and the most bytes in use during it, beyond those before: 0 at least.
pub fn peak_of<T>(act: impl FnOnce() -> T) -> (T, usize) {
    IN_USE.store(0, Relaxed);
    PEAK.store(0, Relaxed);
    let value = act();
    (value, PEAK.load(Relaxed).unsigned_abs())
}
