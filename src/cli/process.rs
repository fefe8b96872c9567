//! The program as a process of its own: what it says when the machine gives no more memory.

use super::{Ranks, main_with};
use crate::pages::LargePages;
use std::alloc::{GlobalAlloc, Layout};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Whether the program has come to its own end.
static ENDED: AtomicBool = AtomicBool::new(false);

/// Runs the program on the arguments of this process, which it ends where memory is short: for `main` of a program, beside
/// [`OrExit`].
pub fn process(ranks: Option<&dyn Ranks>) -> ExitCode {
    on_abort();
    on_exit();
    return_large_blocks();
    let code = main_with(std::env::args_os(), ranks);
    ENDED.store(true, Relaxed);
    code.into()
}

/// Memory in large pages, the allocator of a program. Where there is none left the program says so and ends with exit code 1.
#[derive(Debug, Clone, Copy)]
pub struct OrExit;

// SAFETY: every call is handed on as it came; a null pointer never comes back.
unsafe impl GlobalAlloc for OrExit {
    #[inline]
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's promises are those that LargePages asks for, here and below.
        or_exit(unsafe { LargePages.alloc(layout) }, layout.size())
    }

    #[inline]
    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as above.
        or_exit(unsafe { LargePages.alloc_zeroed(layout) }, layout.size())
    }

    #[inline]
    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { LargePages.dealloc(memory, layout) }
    }

    #[inline]
    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as above.
        or_exit(unsafe { LargePages.realloc(memory, layout, size) }, size)
    }
}

#[inline]
fn or_exit(memory: *mut u8, size: usize) -> *mut u8 {
    if memory.is_null() {
        let mut digits = [b'0'; 20];
        let mut first = digits.len();
        let mut mebibytes = size.div_ceil(1 << 20);
        while mebibytes > 0 || first == digits.len() {
            first -= 1;
            digits[first] = b'0' + (mebibytes % 10) as u8;
            mebibytes /= 10;
        }
        end(&[
            b"error: memory: the machine gives no more, and another ",
            &digits[first..],
            b" MiB were requested. Take a coarser mesh, fewer modes or `--threads 1`, raise the limit (`ulimit -v`), or \
              take a machine with more memory. Results that were written before are whole.\n",
        ]);
    }
    memory
}

/// Writes a text to stderr without any memory, and ends the process with exit code 1, whatever other threads do.
fn end(text: &[&[u8]]) -> ! {
    for part in text {
        // SAFETY: the part is as long as it says. Where nobody listens there is nothing else to do.
        unsafe { libc::write(2, part.as_ptr().cast(), part.len() as _) };
    }
    // SAFETY: no memory is touched.
    unsafe { libc::_exit(1) }
}

const NO_MEMORY: &[u8] =
    b"error: the program had to end: a stack or a library ran out of memory. Raise the limits (`ulimit -s`, \
    `ulimit -v`), or take a coarser mesh or `--threads 1`.\n";

const INVALID_ADDRESS: &[u8] =
    b"error: the program had to end at an invalid address: a stack or a library ran out of memory, or the program is at \
    fault. Raise the limits (`ulimit -s`, `ulimit -v`), or take a coarser mesh or `--threads 1`; where memory is not short, \
    report it.\n";

/// C libraries without memory may call exit(3), HDF5 for one: that is an error with a sentence, too.
fn on_exit() {
    extern "C" fn said() {
        if !ENDED.load(Relaxed) {
            end(&[NO_MEMORY]);
        }
    }
    // SAFETY: the handler only reads a flag, writes and ends the process. Without it the exit code is the library's.
    unsafe { libc::atexit(said) };
}

/// Has the C library give blocks of 16 MiB and more back to the system as soon as they are free. By default it raises this bound with
/// every such block, up to 32 MiB, and keeps smaller ones: a tenth to a fifth of the peak of an analysis. SuperLU_DIST, which PETSc
/// loads, has it keep all of them.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn return_large_blocks() {
    const LARGE: libc::c_int = 16 << 20;
    /// The C library's own.
    const MOST_BLOCKS: libc::c_int = 65_536;
    let settings =
        [(libc::M_MMAP_MAX, MOST_BLOCKS), (libc::M_MMAP_THRESHOLD, LARGE), (libc::M_TRIM_THRESHOLD, LARGE)];
    for (setting, value) in settings {
        // SAFETY: settings of the allocator, made before there are other threads. One that is refused changes nothing.
        unsafe { libc::mallopt(setting, value) };
    }
}

#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
fn return_large_blocks() {}

/// Signals that end a program which is out of memory: a stack that overflows touches its guard page, C libraries abort or follow
/// a null pointer, as HDF5 does while it makes an attribute. Then, too, the program ends with one sentence and exit code 1.
#[cfg(unix)]
fn on_abort() {
    extern "C" fn aborted(_: libc::c_int) {
        end(&[NO_MEMORY]);
    }
    extern "C" fn astray(_: libc::c_int) {
        end(&[INVALID_ADDRESS]);
    }
    for (signal, handler) in [
        (libc::SIGABRT, aborted as extern "C" fn(libc::c_int)),
        (libc::SIGSEGV, astray),
        (libc::SIGBUS, astray),
    ] {
        // SAFETY: the handlers only write and end the process, which is allowed in one. They run on the stack that the standard
        // library keeps for signals in each of its threads, so that an overflowing stack does no harm.
        unsafe {
            let mut action: libc::sigaction = std::mem::zeroed();
            action.sa_sigaction = handler as libc::sighandler_t;
            action.sa_flags = libc::SA_ONSTACK;
            libc::sigaction(signal, &action, std::ptr::null_mut());
        }
    }
}

#[cfg(not(unix))]
fn on_abort() {}
