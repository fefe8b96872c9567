//! Finds and checks PETSc, SLEPc, MUMPS and MPI, compiles the C side of the module `slepc`, and links them.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Where to look, in a sentence.
const HELP: &str = "Install them (Debian, Ubuntu: `.ci/setup --mpi`), or set PETSC_DIR, PETSC_ARCH and SLEPC_DIR to a build \
    configured with --with-scalar-type=complex and MUMPS.";

/// Folders of headers and libraries, and the names of the libraries.
#[derive(Default)]
struct Libraries {
    headers: Vec<PathBuf>,
    folders: Vec<PathBuf>,
    names: Vec<String>,
}

fn main() {
    for variable in ["PETSC_DIR", "PETSC_ARCH", "SLEPC_DIR", "MPICC"] {
        println!("cargo:rerun-if-env-changed={variable}");
    }
    let found = of_variables().unwrap_or_else(of_pkg_config);
    let settings = check(&found.headers);
    let compiler = std::env::var("MPICC").unwrap_or_else(|_| "mpicc".to_string());
    let mut shim = cc::Build::new();
    let sources = ["messages.c", "factor.c", "eigen.c"].map(|file| Path::new("src/slepc").join(file));
    shim.compiler(&compiler).files(sources).includes(&found.headers).compile("stridor_slepc");
    for folder in found.folders.iter().map(|folder| folder.display()) {
        println!("cargo:rustc-link-search=native={folder}");
        // Programs and tests find the libraries again where they are in no place that the system searches.
        println!("cargo:rustc-link-arg=-Wl,-rpath,{folder}");
    }
    for name in found.names.iter().chain([&real_mumps(&settings)]) {
        println!("cargo:rustc-link-lib=dylib={name}");
    }
    link_mpi(&compiler);
}

/// The build that PETSC_DIR, PETSC_ARCH and SLEPC_DIR name; none where PETSC_DIR is not set.
fn of_variables() -> Option<Libraries> {
    let folder = |variable| std::env::var_os(variable).filter(|value| !value.is_empty()).map(PathBuf::from);
    let petsc = folder("PETSC_DIR")?;
    let arch = folder("PETSC_ARCH").unwrap_or_default();
    let slepc = folder("SLEPC_DIR").unwrap_or_else(|| petsc.clone());
    let (mut headers, mut folders) = (Vec::new(), Vec::new());
    for root in [&slepc, &petsc] {
        headers.extend([root.join("include"), root.join(&arch).join("include")]);
        folders.push(root.join(&arch).join("lib"));
    }
    let plain = |base: &str| {
        let has = |name: &String| folders.iter().any(|folder| folder.join(format!("lib{name}.so")).exists());
        ["", "_complex", "64_complex"]
            .map(|suffix| format!("{base}{suffix}"))
            .into_iter()
            .find(has)
            .unwrap_or_else(|| base.to_string())
    };
    let names = vec![plain("slepc"), plain("petsc")];
    Some(Libraries { headers, folders, names })
}

fn of_pkg_config() -> Libraries {
    let mut found = Libraries::default();
    let mut config = pkg_config::Config::new();
    let library = config.cargo_metadata(false).probe("slepc").unwrap_or_else(|error| {
        panic!("`stridor-mpi` needs SLEPc and PETSc, and pkg-config does not find them. {HELP}\n{error}")
    });
    found.headers.extend(library.include_paths);
    found.folders.extend(library.link_paths);
    found.names.extend(library.libs);
    found
}

/// The file of PETSc's settings, by which it is built for complex numbers, with MUMPS and for several processes.
fn check(headers: &[PathBuf]) -> PathBuf {
    let file = headers.iter().map(|folder| folder.join("petscconf.h")).find(|file| file.exists());
    let Some(file) = file else { panic!("no petscconf.h in {headers:?}. {HELP}") };
    println!("cargo:rerun-if-changed={}", file.display());
    let settings = std::fs::read_to_string(&file).unwrap_or_default();
    let set = |name: &str| settings.lines().any(|line| line.split_whitespace().nth(1) == Some(name));
    let refused = [
        (!set("PETSC_USE_COMPLEX"), "for real scalars: `stridor-mpi` needs complex ones"),
        (!set("PETSC_HAVE_MUMPS"), "without MUMPS, which `stridor-mpi` needs"),
        (set("PETSC_HAVE_MPIUNI"), "without MPI, which `stridor-mpi` needs"),
    ];
    if let Some((_, how)) = refused.iter().find(|(refused, _)| *refused) {
        panic!("PETSc of {} is built {how}. {HELP}", file.display());
    }
    file
}

/// The library of MUMPS for real numbers beside the one for complex numbers that PETSc links, whose integers may have another
/// size in a build of its own: `-ldmumps_64` of MUMPS_LIB in lib/petsc/conf/petscvariables.
fn real_mumps(settings: &Path) -> String {
    let variables = settings.parent().map(|folder| folder.join("../lib/petsc/conf/petscvariables"));
    let text = variables.and_then(|file| std::fs::read_to_string(file).ok()).unwrap_or_default();
    let line = text.lines().find(|line| line.starts_with("MUMPS_LIB"));
    let mut words = line.unwrap_or_default().split_whitespace().filter_map(|word| word.strip_prefix("-l"));
    words.find(|name| name.starts_with("dmumps")).unwrap_or("dmumps").to_string()
}

/// The libraries that MPI's compiler links: the linker does not resolve symbols through those of PETSc.
fn link_mpi(compiler: &str) {
    let output = Command::new(compiler).arg("-show").output();
    let line = output.ok().filter(|output| output.status.success()).map(|output| output.stdout);
    let Some(line) = line else {
        panic!("`{compiler} -show` fails: set MPICC to the compiler of your MPI. {HELP}")
    };
    for word in String::from_utf8_lossy(&line).split_whitespace() {
        if let Some(folder) = word.strip_prefix("-L").filter(|folder| Path::new(folder).is_dir()) {
            println!("cargo:rustc-link-search=native={folder}");
        } else if let Some(name) = word.strip_prefix("-l") {
            println!("cargo:rustc-link-lib=dylib={name}");
        }
    }
}
