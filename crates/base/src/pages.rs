//! Memory in large pages. Matrices are gone through from end to end, and Linux hands memory out in pages of 4 KiB, each at its first
//! touch: that alone can take a tenth of the time of an analysis.

use std::alloc::{GlobalAlloc, Layout, System};

/// The system's allocator, which asks Linux for pages of 2 MiB where an allocation holds some (madvise(2), `MADV_HUGEPAGE`).
///
/// The command line uses it; a program that uses the library may, too:
/// ```
/// #[global_allocator]
/// static MEMORY: stridor_base::pages::LargePages = stridor_base::pages::LargePages;
/// ```
#[derive(Debug)]
pub struct LargePages;

// SAFETY: every call is handed on to the system's allocator as it came; what is asked of the kernel changes no contents.
unsafe impl GlobalAlloc for LargePages {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's promises are those that the system's allocator asks for, here and below.
        advised(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as above.
        advised(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(memory, layout) }
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as above.
        advised(unsafe { System.realloc(memory, layout, size) }, size)
    }
}

/// Bytes of a large page.
const PAGE: usize = 2 << 20;

/// The addresses of the whole large pages in `size` bytes from `start` on, as the first and their length.
fn whole_pages(start: usize, size: usize) -> Option<(usize, usize)> {
    let first = start.checked_next_multiple_of(PAGE)?;
    let end = (start + size) / PAGE * PAGE;
    (first < end).then(|| (first, end - first))
}

#[cfg(target_os = "linux")]
fn advised(memory: *mut u8, size: usize) -> *mut u8 {
    if let Some((first, length)) = (!memory.is_null()).then(|| whole_pages(memory.addr(), size)).flatten() {
        // SAFETY: the range lies inside an allocation, and advice on its pages leaves their contents alone. Refused advice, as
        // where the kernel has no large pages, harms nothing.
        unsafe { libc::madvise(memory.with_addr(first).cast(), length, libc::MADV_HUGEPAGE) };
    }
    memory
}

#[cfg(not(target_os = "linux"))]
fn advised(memory: *mut u8, _: usize) -> *mut u8 {
    memory
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_pages_lie_inside_the_memory() {
        assert_eq!(whole_pages(PAGE, PAGE), Some((PAGE, PAGE)));
        assert_eq!(whole_pages(PAGE + 1, 2 * PAGE - 2), None);
        assert_eq!(whole_pages(PAGE - 16, 3 * PAGE), Some((PAGE, 2 * PAGE)));
        assert_eq!(whole_pages(64, 100), None);
        assert_eq!(whole_pages(usize::MAX - 10, 5), None);
    }

    #[test]
    fn memory_keeps_what_is_written_when_it_grows() {
        let layout = |size: usize| Layout::from_size_align(size, 64).unwrap();
        // SAFETY: written and read inside what was allocated, and given back with the layout it has then.
        unsafe {
            let memory = LargePages.alloc_zeroed(layout(5 * PAGE));
            assert!((0..5 * PAGE).step_by(999).all(|i| *memory.add(i) == 0));
            *memory.add(5 * PAGE - 1) = 7;
            let grown = LargePages.realloc(memory, layout(5 * PAGE), 9 * PAGE);
            assert_eq!(*grown.add(5 * PAGE - 1), 7);
            LargePages.dealloc(grown, layout(9 * PAGE));
        }
    }
}
