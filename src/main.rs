//! The program `stridor`.

#[global_allocator]
static MEMORY: stridor::cli::OrExit = stridor::cli::OrExit;

fn main() -> std::process::ExitCode {
    stridor::cli::process(None)
}
