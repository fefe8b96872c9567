//! Ctrl-C: the run ends at once, as the system ends it, with a line that says how to continue it.

/// There is no such signal here.
#[cfg(not(unix))]
pub fn says_how_to_continue(_record: &std::path::Path) {}

#[cfg(unix)]
pub use unix::says_how_to_continue;

#[cfg(unix)]
mod unix {
    use std::ffi::CString;
    use std::os::unix::ffi::OsStrExt;
    use std::path::Path;
    use std::sync::OnceLock;

    static RECORD: OnceLock<CString> = OnceLock::new();
    const WORDS: &[u8] = b"\nInterrupted. The same command with --resume continues.\n";

    /// From here on an interrupt (SIGINT) says that `--resume` continues the run, if its record `record` is there by then. Where
    /// interrupts are ignored, as in jobs in the background, they stay ignored.
    pub fn says_how_to_continue(record: &Path) {
        let Ok(path) = CString::new(record.as_os_str().as_bytes()) else { return };
        if RECORD.set(path).is_err() {
            return;
        }
        // SAFETY: the handler calls nothing but functions that a signal handler may call.
        unsafe {
            if libc::signal(libc::SIGINT, interrupted as *const () as libc::sighandler_t) == libc::SIG_IGN {
                libc::signal(libc::SIGINT, libc::SIG_IGN);
            }
        }
    }

    /// Says it and ends the process by the same signal, so that a shell sees why.
    extern "C" fn interrupted(signal: libc::c_int) {
        // SAFETY: access, write, signal and raise are safe in a signal handler (POSIX.1-2017, 2.4.3); the record was set before the
        // handler was installed.
        unsafe {
            if RECORD.get().is_some_and(|path| libc::access(path.as_ptr(), libc::F_OK) == 0) {
                libc::write(libc::STDERR_FILENO, WORDS.as_ptr().cast(), WORDS.len());
            }
            libc::signal(signal, libc::SIG_DFL);
            libc::raise(signal);
        }
    }
}
