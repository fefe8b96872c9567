//! Limits the vector instructions that a Rust program believes its processor to have, so that one machine runs the kernels of
//! others. Built and loaded into a program that is not stripped by `.ci/widths`:
//!
//! ```sh
//! rustc -O --crate-type cdylib vector_width.rs
//! LD_PRELOAD=$PWD/libvector_width.so VECTOR_WIDTH=avx2 PROGRAM    # or sse2
//! ```
//!
//! `is_x86_feature_detected!`, by which pulp, faer and gemm choose, keeps what it found in a few words, one bit a feature. Before
//! `main` they are set to what this library, of the same compiler, finds without AVX-512 (`avx2`), or to no feature beyond
//! those of every x86-64 processor (`sse2`). Which bits are AVX-512 is tried out on the words of the library itself.

use std::arch::is_x86_feature_detected as has;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::{env, fs};

#[used]
#[unsafe(link_section = ".init_array")]
static BEFORE_MAIN: extern "C" fn() = limit;

/// The words and the bit of each that says that it is set.
type Words = [AtomicUsize; 3];
const SET: usize = 1 << (usize::BITS - 1);

extern "C" fn limit() {
    let (Ok(width), Ok(library)) = (env::var("VECTOR_WIDTH"), env::var("LD_PRELOAD")) else { return };
    let (Some(own), Some(theirs)) = (words(&library), words("/proc/self/exe")) else { return };
    std::hint::black_box(has!("avx2"));
    for (own, theirs) in own.iter().zip(theirs) {
        let all = own.load(Relaxed);
        assert!(all & SET != 0, "the features are not kept as this library supposes");
        let is_wide = |bit: &usize| {
            let before = wide();
            own.store(all & !bit, Relaxed);
            let after = wide();
            own.store(all, Relaxed);
            before != after
        };
        let wide: usize = (0..usize::BITS - 1).map(|b| 1 << b).filter(|b| all & b != 0).filter(is_wide).sum();
        match width.as_str() {
            "avx512" => {}
            "avx2" => theirs.store(all & !wide, Relaxed),
            "sse2" => theirs.store(SET, Relaxed),
            other => panic!("VECTOR_WIDTH={other}: avx512, avx2 or sse2"),
        }
    }
}

/// Every feature of AVX-512 that chooses a kernel.
fn wide() -> [bool; 6] {
    [has!("avx512f"), has!("avx512bw"), has!("avx512cd"), has!("avx512dq"), has!("avx512vl"), has!("avx512vbmi")]
}

/// The words in memory of the file of this process: the address of their symbol in its table of symbols.
fn words(path: &str) -> Option<&'static Words> {
    let path = fs::canonicalize(path).ok()?;
    let maps = fs::read_to_string("/proc/self/maps").ok()?;
    let first = maps.lines().find(|line| line.ends_with(path.to_str().unwrap()))?;
    let base = usize::from_str_radix(first.split('-').next()?, 16).ok()?;
    let file = fs::read(&path).ok()?;
    let number = |at: usize, size: usize| file[at..at + size].iter().rev().fold(0, |n, b| n << 8 | *b as usize);
    // ELF of 64 bits: the table of sections, of which type 2 is that of symbols, with the section of their names.
    let (sections, size, count) = (number(0x28, 8), number(0x3A, 2), number(0x3C, 2));
    let section = |i: usize| sections + i * size;
    let symbols = section((0..count).find(|i| number(section(*i) + 4, 4) == 2)?);
    let names = number(section(number(symbols + 0x28, 4)) + 0x18, 8);
    let (start, length) = (number(symbols + 0x18, 8), number(symbols + 0x20, 8));
    let symbol = (start..start + length).step_by(24).find(|symbol| {
        let name = &file[names + number(*symbol, 4)..];
        let name = &name[..name.iter().position(|b| *b == 0).unwrap_or(0)];
        String::from_utf8_lossy(name).contains("10std_detect6detect5cache5CACHE")
    })?;
    // SAFETY: the symbol is that of the three words, at its place in a file that is loaded as a whole from `base`.
    (number(symbol + 16, 8) == size_of::<Words>()).then(|| unsafe { &*((base + number(symbol + 8, 8)) as *const Words) })
}
