//! The rig's complex eigenvalues against a dense solver on the full order: another method, no projection.

use faer::Mat;
use faer::linalg::solvers::Solve;
use std::f64::consts::TAU;
use std::path::PathBuf;
use stridor::case::Case;
use stridor::equilibrium::{SteadyOptions, directions, linearize, solve_steady};
use stridor::job::Prepared;
use stridor::linalg::c64;
use stridor::modal::{ModesWanted, compute};
use stridor::stability::complex_modes;

/// The reference case with a large hub and on a mesh so coarse that dense algebra can follow.
fn coarse_rig() -> Case {
    let text = include_str!("../validation/rig-convergence/case.toml")
        .replace("contact_size = \"0.4 mm\"", "hub_radius = \"50 mm\"\ncontact_size = \"12 mm\"")
        .replace("contact_radius = \"2 mm\"", "contact_radius = \"12 mm\"")
        .replace("disc_size = \"3 mm\"", "disc_size = \"30 mm\"")
        .replace("slider_size = \"8 mm\"", "slider_size = \"40 mm\"")
        .replace("modal_ratio = 0.0035", "modal_ratio = 0")
        .replace(
            "density = \"7850 kg/m^3\"",
            "density = \"7850 kg/m^3\"\nrayleigh = { alpha = 20, beta = \"0.2 us\" }",
        );
    Case::parse("coarse rig", &text, PathBuf::from(".")).expect("a sound case")
}

#[test]
fn full_order_eigenvalues_of_the_rig_agree_with_a_dense_solver() {
    let case = coarse_rig();
    let prepared = Prepared::new(&case).expect("a sound rig");
    let system = &prepared.system;
    let n = system.n_dofs();
    assert!(n < 1000, "{n} degrees of freedom are too many for dense algebra");
    let steady = solve_steady(system, &SteadyOptions::default(), &()).expect("a steady state");
    let (real, _) = compute(&system.structure, ModesWanted::BelowHz(9000.0), &()).expect("real modes");
    let band = [200.0, 6000.0];
    let modes = complex_modes(system, &steady, &real, band, &()).expect("complex modes");

    let mut stiffness = system.structure.stiffness.to_dense();
    let mut damping = system.structure.damping.viscous.as_ref().expect("Rayleigh damping").to_dense();
    let points: Vec<_> = system.points().map(|(_, point)| point).collect();
    for block in linearize(system, &steady).blocks {
        let u = directions(points[block.point]);
        for (row, column) in (0..3).flat_map(|r| (0..3).map(move |c| (r, c))) {
            for (i, a) in u[row].iter() {
                for (j, b) in u[column].iter() {
                    stiffness[(i, j)] += a * block.stiffness[row][column] * b;
                    damping[(i, j)] += a * block.damping[row][column] * b;
                }
            }
        }
    }
    // 1/λ is an eigenvalue of [−K⁻¹C, −s K⁻¹M; I/s, 0]: the lowest λ are its largest, and come out most exactly.
    let scale = TAU * band[1];
    let factor = stiffness.partial_piv_lu();
    let by_velocity = factor.solve(&damping);
    let by_inertia = factor.solve(system.structure.mass.to_dense());
    let companion = Mat::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
        (true, true) => -by_velocity[(i, j)],
        (true, false) => -scale * by_inertia[(i, j - n)],
        (false, true) => f64::from(i - n == j) / scale,
        (false, false) => 0.0,
    });
    let dense: Vec<c64> = companion
        .eigenvalues()
        .expect("dense eigenvalues")
        .into_iter()
        .map(|z| c64::new(1.0, 0.0) / z)
        .filter(|l| l.im > TAU * band[0] && l.im < TAU * band[1])
        .collect();

    assert_eq!(modes.modes.len(), dense.len());
    assert!(dense.len() >= 10, "{} modes", dense.len());
    assert!(
        modes.modes.iter().any(|m| m.unstable()),
        "the lead angle and the falling friction make some mode grow"
    );
    for mode in &modes.modes {
        let l = mode.eigenvalue;
        let nearest = dense.iter().map(|d| (d - l).norm() / l.norm()).fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-8, "{l}: {nearest:e}");
    }
}
