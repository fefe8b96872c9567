//! The rig's complex eigenvalues against a dense solver on the full order: another method, no projection.

use faer::Mat;
use faer::linalg::solvers::Solve;
use std::f64::consts::TAU;
use std::path::PathBuf;
use stridor::bounds::{Origin::*, within};
use stridor::case::Case;
use stridor::equilibrium::{SteadyOptions, directions, linearize, solve_steady};
use stridor::job::{Prepared, Selection, analyse};
use stridor::linalg::c64;
use stridor::modal::{ModesWanted, compute};
use stridor::results::{ComplexResult, SensitivityResult};
use stridor::stability::{ComplexMode, complex_modes};

/// The reference case with a large hub and on a mesh so coarse that dense algebra can follow.
fn coarse_rig() -> Case {
    let text = include_str!("../../validation/rig-convergence/case.toml")
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
        assert!(within(nearest, 1e-8, Tolerance), "{l}: {nearest:e}");
    }
}

/// The same rig with modal damping, its sensitivities requested by scalars of every kind.
fn sensitive_rig(prestress: bool) -> Case {
    let scalars = [
        "contact.rim.friction.mu0",
        "contact.rim.friction.alpha",
        "contact.rim.sliding_velocity",
        "contact.rim.load",
        "contact.rim.normal.stiffness",
        "contact.rim.placement.lead_angle",
        "material.steel.youngs_modulus",
        "material.steel.density",
        "shell.disc.thickness",
        "bar.bar.diameter",
        "spring.drive.stiffness",
        "damping.modal_ratio",
    ];
    let case = coarse_rig().with_parameter("damping.modal_ratio", 0.0035).expect("a sound ratio");
    let lists = format!(
        "prestress = {prestress}\n{}",
        case.to_toml().replace("prestress = false\n", "").replace("[cea]", "[cea]\ncertify = false")
    );
    let text = format!(
        "{lists}\n[sensitivity]\nparameters = {scalars:?}\nadvice = true\nmass = \"0.1 g\"\ndamper = 0.01\nverify = true\n"
    );
    Case::parse("sensitive rig", &text, PathBuf::from(".")).expect("a sound case")
}

/// dλ/dp by sixth-order differences of eigenvalues, every one of an analysis of its own.
fn by_rerun(case: &Case, path: &str, value: f64, step: f64, lambda: &[c64]) -> Vec<c64> {
    let at = |p: f64| -> Vec<c64> {
        let case = case.with_parameter(path, p).expect("the case accepts it");
        let prepared = Prepared::new(&case).expect("a sound rig");
        let mut results =
            analyse(&prepared, Selection::Only("cea"), &mut |_| Ok(()), &()).expect("an analysis");
        let modes = results.take::<ComplexResult>().expect("complex modes").modes.modes;
        let distance = |m: &ComplexMode, l: &c64| (m.eigenvalue - l).norm();
        let nearest = |l: &c64| modes.iter().min_by(|a, b| distance(a, l).total_cmp(&distance(b, l)));
        lambda.iter().map(|l| nearest(l).expect("a mode").eigenvalue).collect()
    };
    let central = |h: f64| -> Vec<c64> {
        at(value + h).iter().zip(at(value - h)).map(|(a, b)| (a - b) / (2.0 * h)).collect()
    };
    let [one, two, three] = [1.0, 2.0, 3.0].map(|k| central(k * step));
    (0..lambda.len()).map(|j| one[j] * 1.5 - two[j] * 0.6 + three[j] * 0.1).collect()
}

#[test]
fn sensitivities_of_the_rig_equal_differences_of_reruns() {
    for prestress in [false, true] {
        let case = sensitive_rig(prestress);
        let prepared = Prepared::new(&case).expect("a sound rig");
        let mut results = analyse(&prepared, Selection::Listed, &mut |_| Ok(()), &()).expect("an analysis");
        let found = results.take::<SensitivityResult>().expect("sensitivities");
        assert!(found.left_out.is_empty(), "{:?}", found.left_out);
        let lambda: Vec<c64> = found.modes.iter().map(|m| m.eigenvalue).collect();
        assert!(lambda.iter().all(|l| l.re > 0.0));
        let paths: Vec<(String, f64)> =
            found.modes[0].parameters.iter().map(|p| (p.path.clone(), p.value)).collect();
        assert_eq!(paths.len(), 12);
        for (path, value) in paths {
            // With prestress a few of each kind are enough.
            if prestress && !["load", "thickness", "mu0", "modal_ratio"].iter().any(|end| path.ends_with(end))
            {
                continue;
            }
            let step = 3e-3 * value.abs();
            let exact = by_rerun(&case, &path, value, step, &lambda);
            for (mode, exact) in found.modes.iter().zip(exact) {
                let rate = mode.parameters.iter().find(|p| p.path == path).expect("a rate").rate;
                let error = (rate - exact).norm() / exact.norm();
                // What the eigenvalues themselves are known to.
                let noise = 1e-12 * mode.eigenvalue.norm() / (step * exact.norm());
                println!(
                    "{path} {:.1} Hz: p dλ/dp = {:.3e} 1/s, error {error:.1e}, noise {noise:.1e}",
                    mode.eigenvalue.im / TAU,
                    value * exact.norm()
                );
                assert!(
                    within(error, 1e-6 + noise, Reference),
                    "{path} at {}: {rate} {exact}, {error:.1e}",
                    mode.eigenvalue
                );
            }
        }
        for thing in found.modes.iter().flat_map(|m| &m.best) {
            let done = thing.done.expect("requested");
            let slope_error = thing.slope_error.expect("requested");
            println!(
                "{} {:.1e}: predicted {:.4} done {:.4}, slope error {slope_error:.1e}",
                thing.kind, thing.amount, thing.predicted, done
            );
            // A whole gram is beyond first order; a thousandth of it, really mounted, is not.
            assert!(done.re < 0.0 && within(slope_error, 1e-3, Theory), "{thing:?}");
        }
    }
}

/// Components of directions that are zero in the case have derivatives, too: dλ/dp across is that of reruns, and zero along the
/// direction and along the normal of the contact, of which nothing is used.
#[test]
fn components_of_directions_that_are_zero_have_derivatives() {
    let given = "sliding_direction = [1.0, 0.0, 0.0]";
    let text = coarse_rig().to_toml().replace("[cea]", "[cea]\ncertify = false");
    // Off the middle of the slider, so that a turn to either side is not the same.
    let text = text.replace("position = [0.0, 0.0]", "position = [0.0, 0.007]");
    assert!(text.contains(given) && text.contains("0.007"), "{text}");
    for length in [1.0f64, -2e-3, 30.0] {
        let direction = [length, 0.0, 0.0];
        let text = text.replace(given, &format!("sliding_direction = {direction:?}"))
            + "\n[sensitivity]\nparameters = [\"contact.rim.sliding_direction.*\"]\n";
        let case = Case::parse("a rig", &text, PathBuf::from(".")).expect("a sound case");
        let prepared = Prepared::new(&case).expect("a sound rig");
        let mut results = analyse(&prepared, Selection::Listed, &mut |_| Ok(()), &()).expect("an analysis");
        let found = results.take::<SensitivityResult>().expect("sensitivities");
        assert!(found.left_out.is_empty() && !found.modes.is_empty(), "{direction:?}: {:?}", found.left_out);
        let lambda: Vec<c64> = found.modes.iter().map(|mode| mode.eigenvalue).collect();
        let across = "contact.rim.sliding_direction.1";
        let mut seen = false;
        let exact = by_rerun(&case, across, 0.0, 3e-3 * length.abs(), &lambda);
        for (mode, exact) in found.modes.iter().zip(exact) {
            // What eigenvalues are known to, in steps of 3e-3.
            let noise = 1e-9 * mode.eigenvalue.norm() / length.abs();
            assert_eq!(mode.parameters.len(), 3, "{direction:?}");
            for rate in &mode.parameters {
                let exact = if rate.path == across { exact } else { c64::new(0.0, 0.0) };
                let error = (rate.rate - exact).norm();
                assert!(
                    within(error, 1e-5 * exact.norm() + noise, Reference),
                    "{direction:?} {}: {} {exact}",
                    rate.path,
                    rate.rate
                );
            }
            seen |= exact.norm() > 1e3 * noise;
        }
        assert!(seen, "{direction:?}");
    }
}
