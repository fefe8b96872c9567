//! The binary: parse, run, exit code.

#[global_allocator]
static MEMORY: stridor::pages::LargePages = stridor::pages::LargePages;

fn main() -> std::process::ExitCode {
    stridor::cli::main()
}
