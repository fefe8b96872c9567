//! A Python with packages, in an environment below the target folder.

use std::path::{Path, PathBuf};
use std::process::Command;

/// xarray with both of its readers of HDF5.
#[allow(dead_code)]
pub const XARRAY: [(&str, &str); 4] =
    [("xarray", "2026.9.0"), ("h5netcdf", "1.8.2"), ("h5py", "3.16.0"), ("netCDF4", "1.7.5.1.post1")];

/// A Python that has these releases of packages. It is made when it is not there.
pub fn with(packages: &[(&str, &str)]) -> PathBuf {
    let name: Vec<String> = packages.iter().map(|(name, version)| format!("{name}-{version}")).collect();
    let home = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name.join("-"));
    let own = home.join("bin/python");
    let import: String = packages
        .iter()
        .map(|(name, version)| format!("import {name}; assert version('{name}') == '{version}'\n"))
        .collect();
    let import = format!("from importlib.metadata import version\n{import}");
    let knows = |python: &Path| {
        Command::new(python).args(["-c", &import]).output().is_ok_and(|done| done.status.success())
    };
    if knows(&own) {
        return own;
    }
    let folder = home.to_string_lossy();
    run(Path::new("python3"), &["-m", "venv", "--clear", &folder], "making a Python environment");
    let mut pip = vec!["-m", "pip", "install", "--quiet", "--disable-pip-version-check"];
    let wanted: Vec<String> = packages.iter().map(|(name, version)| format!("{name}=={version}")).collect();
    pip.extend(wanted.iter().map(String::as_str));
    run(&own, &pip, "installing packages");
    assert!(knows(&own), "{packages:?} are not there after their installation");
    own
}

fn run(program: &Path, arguments: &[&str], what: &str) {
    let done = Command::new(program).args(arguments).output();
    let said = match &done {
        Ok(done) if done.status.success() => return,
        Ok(done) => String::from_utf8_lossy(&done.stderr).into_owned(),
        Err(error) => error.to_string(),
    };
    panic!(
        "{what} failed; it needs Python 3.11 or newer with venv (Debian: python3-venv) and a network: {said}"
    );
}
