//! results.h5 in xarray, an independent reader (Python), which this test installs below the target folder.

use crate::program::{CASE, command, folder_with};
use crate::python;
use std::process::Command;

/// Opens the file as a tree of datasets with named axes, by both readers of xarray, and compares it with summary.json.
const SCRIPT: &str = r#"
import json, sys
import numpy as np, xarray
folder = sys.argv[1]
# netCDF4 shows complex numbers as pairs.
def complexes(values):
    return values if np.iscomplexobj(values) else values['r'] + 1j * values['i']
summary = json.load(open(folder + '/summary.json'))
for engine in ['h5netcdf', 'netcdf4']:
    tree = xarray.open_datatree(folder + '/results.h5', engine=engine)
    modes = tree['cea/eigenvalues'].to_dataset()
    assert modes['right'].dims == ('mode', 'node', 'freedom'), modes['right'].dims
    assert list(modes['mode'].values) == [m['mode'] for m in summary['cea']['eigenvalues']]
    assert list(modes['freedom'].values) == ['ux', 'uy', 'uz', 'rx', 'ry', 'rz']
    for key in ['frequency_hz', 'growth_rate', 'damping_ratio', 'unstable', 'verdict']:
        assert list(modes[key].values) == [m[key] for m in summary['cea']['eigenvalues']], key
    assert np.all(complexes(modes['eigenvalue'].values).real == modes['growth_rate'].values)
    assert modes['growth_rate'].attrs['units'] == '1/s'
    first = modes.sel(mode=1, freedom='ux')['right']
    assert first.shape == (modes.sizes['node'],) and np.any(complexes(first.values) != 0)
    for path, dimensions in json.loads(sys.argv[2]).items():
        group, key = path.rsplit('/', 1)
        assert list(tree[group][key].dims) == dimensions, (path, tree[group][key].dims)
"#;

#[test]
fn results_open_in_xarray_with_named_axes() {
    let python = python::with(&python::XARRAY);
    let folder = folder_with(CASE);
    let done = command(folder.path(), &["run", "case.toml", "--out", "out", "--quiet"]).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let axes = serde_json::json!({
        "/modes/disc/shapes": ["mode", "node", "freedom"],
        "/modes/disc/effective_mass_kg": ["mode", "axis"],
        "/steady_sliding/points/friction_force_n": ["point", "direction"],
        "/steady_sliding/displacement": ["node", "freedom"],
        "/transient/history/rim_velocity": ["time_s"],
        "/transient/events/kind": ["time_s"],
    });
    let out = folder.path().join("out");
    let done = Command::new(&python).args(["-c", SCRIPT]).arg(&out).arg(axes.to_string()).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}
