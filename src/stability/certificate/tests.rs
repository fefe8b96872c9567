use super::region::CountedRegion;
use super::*;
use crate::bounds::{Origin::*, within};
use crate::equilibrium::SteadySliding;
use crate::equilibrium::samples::*;
use crate::linalg::multivector::beside;
use crate::linalg::random::Random;
use crate::linalg::{SparseVector, c64};
use crate::modal::RealModes;
use crate::stability::analysis::analyse;
use crate::stability::basis::Basis;
use crate::stability::closed::closed_modes;
use crate::stability::complex_modes;
use crate::stability::tests::{damped, dense_matrices, dense_modes, dense_spectrum, steady};
use crate::system::{Coupling, System};
use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

fn dense_count(spectrum: &[c64], certificate: &Certificate) -> i64 {
    let [low, high] = certificate.band_hz.map(|f| TAU * f);
    let bottom = if low == 0.0 { -high } else { low };
    let [slow, fast] = certificate.growth;
    spectrum.iter().filter(|z| z.re > slow && z.re < fast && z.im > bottom && z.im < high).count() as i64
}

/// A small system with random contacts, damping of the given kind, and a random unsymmetric coupling strong enough for
/// flutter and divergence.
fn small_system(seed: u64) -> System {
    let mut random = Random::seeded(seed + 1000);
    // Up to twelve degrees of freedom, and now and then more than the basis will span.
    let n = if seed % 16 == 9 { 60 } else { 2 + random.below(11) };
    let load = random.between(5.0, 40.0);
    let mut system = random_system(n, 1 + random.below(3), load, seed);
    let r = 1 + random.below(4);
    let size = 5000.0 * random.between(0.0, 1.0).powi(2);
    let directions: Vec<SparseVector> =
        (0..r).map(|_| vector(&[0, 1, 2].map(|_| (random.below(n), random.between(-1.0, 1.0))))).collect();
    let stiffness = Mat::from_fn(r, r, |_, _| size * random.between(-1.0, 1.0));
    let push = if seed.is_multiple_of(3) { 0.0 } else { random.between(0.0, 4.0) };
    let damping = Mat::from_fn(r, r, |_, _| push * random.between(-1.0, 1.0));
    system.coupling = Some(Coupling { directions, stiffness, damping, skew: None });
    damped_small(system, seed % 16, &mut random)
}

/// Damping of every kind by turns: Rayleigh, hysteretic of a part, modal, dashpots; none at all for kind 0.
fn damped_small(mut system: System, kind: u64, random: &mut Random) -> System {
    let n = system.n_dofs();
    let (m, k) = (system.structure.mass.to_dense(), system.structure.stiffness.to_dense());
    let dashpot: Vec<f64> =
        (0..n).map(|_| if random.between(0.0, 1.0) < 0.3 { random.between(0.0, 2.0) } else { 0.0 }).collect();
    let (rayleigh, dashpots) = (kind & 1 != 0, kind & 8 != 0);
    if rayleigh || dashpots {
        system.structure.damping.viscous = Some(
            sparse(n, |i, j| {
                let proportional = if rayleigh { 0.02 * m[(i, j)] + 4e-4 * k[(i, j)] } else { 0.0 };
                proportional + if dashpots && i == j { dashpot[i] } else { 0.0 }
            })
            .into(),
        );
    }
    if kind & 2 != 0 {
        let part = if kind & 4 != 0 { n } else { n / 2 };
        system.structure.damping.hysteretic =
            Some(sparse(n, |i, j| if i < part && j < part { 0.01 * k[(i, j)] } else { 0.0 }).into());
    }
    if kind & 4 != 0 {
        let modes = dense_modes(&system, (n / 2).max(1));
        let coefficients = modes.eigenvalues.iter().map(|w| 2.0 * 0.01 * w.sqrt()).collect();
        system.structure.damping.modal =
            Some(crate::system::ModalDamping { basis: &m * &modes.shapes, coefficients });
    }
    system
}

#[test]
fn a_thousand_random_systems_agree_with_the_dense_count() {
    let (mut stable, mut several, mut diverging, mut partial, mut held, mut bounded) = (0, 0, 0, 0, 0, 0);
    let mut one_by_one = 0;
    for seed in 0..1000 {
        let system = small_system(seed);
        let n = system.n_dofs();
        let state = steady(&System { coupling: None, ..system.clone() });
        let kept = if n == 60 { 8 } else { (n / 2 + 1 + (seed % 5) as usize).min(n) };
        let real = dense_modes(&system, kept);
        let top = 0.6 * real.certificate.below_hz;
        let low = if seed % 2 == 0 { 0.0 } else { 0.1 * top };
        let (modes, certificate) =
            certified_modes(&system, &state, &real, [low, top], f64::INFINITY, &()).unwrap();
        let certificate = certificate.unwrap_or_else(|| panic!("seed {seed}: {:?}", modes.warnings));
        let spectrum = dense_spectrum(&system, &state);
        let exact = dense_count(&spectrum, &certificate);
        held += usize::from(certificate.holds());
        assert!(
            certificate.counted == exact || certificate.margin <= 1.0,
            "seed {seed}: {exact} by the dense solver, {certificate:?}"
        );
        analyse(&system, &state, &real, [low, top], &(), |modes, analysis| {
            let listed = count_by(Way::Spectrum, &analysis, modes, f64::INFINITY);
            let proven = listed.as_ref().is_ok_and(Certificate::holds);
            one_by_one += usize::from(proven);
            if let Ok(listed) = listed {
                let exact = dense_count(&spectrum, &listed);
                assert!(listed.counted == exact || listed.margin <= 1.0, "seed {seed}: {exact}, {listed:?}");
            }
        })
        .unwrap();
        let fastest = spectrum.iter().filter(|z| z.im.abs() <= TAU * top).fold(0.0f64, |g, z| g.max(z.re));
        assert!(!certificate.nothing_faster || fastest < certificate.growth[1], "seed {seed}");
        assert!(certificate.dissipative && certificate.structure_poles == 0, "seed {seed}: {certificate:?}");
        bounded += usize::from(certificate.nothing_faster);
        stable += usize::from(exact == 0);
        several += usize::from(exact > 2);
        let real_root = |z: &&c64| z.im.abs() < 1e-9 * z.norm() && z.re > certificate.growth[0];
        diverging += usize::from(low == 0.0 && spectrum.iter().any(|z| real_root(&z)));
        partial += usize::from(modes.subspace_dimension < n);
    }
    println!("{stable} {several} {diverging} {partial} {held} {one_by_one} {bounded}");
    assert!(held >= 950 && one_by_one >= 950, "{held} and {one_by_one} of 1000 proven");
    assert!(stable > 100 && several > 50 && diverging > 50 && partial > 30 && bounded > 300);
}

/// M, K and perhaps C of random signs with nothing else, and a coupling of rank one or two: divergence near and far beyond the band,
/// premises that are false.
fn signed(seed: u64) -> (System, [bool; 3]) {
    let mut random = Random::seeded(seed + 77);
    let n = 2 + random.below(5);
    let base = random_system(n, 1, 20.0, seed);
    let mut signed = |negative: bool, size: f64| {
        let q = Mat::from_fn(n, n, |_, _| random.between(-1.0, 1.0)).qr().compute_Q();
        let values: Vec<f64> = (0..n)
            .map(|i| size * random.between(0.5, 2.0) * if negative && i == 0 { -0.5 } else { 1.0 })
            .collect();
        let a = &q * Mat::from_fn(n, n, |i, j| if i == j { values[i] } else { 0.0 }) * q.transpose();
        sparse(n, |i, j| 0.5 * (a[(i, j)] + a[(j, i)]))
    };
    let bad = [seed % 7 == 3, seed % 5 == 2, false];
    let soft = seed.is_multiple_of(3);
    let (mass, damping) = (signed(bad[0], 1.0), signed(bad[1], 3.0));
    let stiffness = signed(soft, 10f64.powi(4 + (seed % 4) as i32));
    let mut structure = base.structure.clone();
    (structure.mass, structure.stiffness) = (mass.into(), stiffness.into());
    structure.damping = Default::default();
    let damped = bad[1] || seed % 2 == 1;
    structure.damping.viscous = damped.then(|| damping.into());
    let size = 10f64.powi(3 + (seed % 5) as i32);
    let r = 1 + seed as usize % 2;
    let mut direction = || vector(&[0, 1].map(|_| (random.below(n), random.between(-1.0, 1.0))));
    let directions: Vec<SparseVector> = (0..r).map(|_| direction()).collect();
    let stiffness = Mat::from_fn(r, r, |_, _| size * random.between(-1.0, 1.0));
    let coupling = Coupling { directions, stiffness, damping: Mat::zeros(r, r), skew: None };
    let system =
        System { structure, coupling: Some(coupling), pairs: Vec::new(), load: vec![0.0; n], ..base };
    (system, [bad[0], damped && bad[1], soft])
}

/// Divergence is found whatever the band, a certificate holds for every growth rate that it does not name, and there is none where a
/// premise is false. The values come from dense eigenvalues.
#[test]
fn growth_beyond_the_band_is_found_or_named() {
    let (mut diverging, mut whole, mut without) = (0, 0, 0);
    for seed in 0..400 {
        let (system, [mass, damping, _]) = signed(seed);
        let state = steady(&system);
        let n = system.n_dofs();
        if mass {
            let identity = sparse(n, |i, j| if i == j { 1.0 } else { 0.0 });
            let mut positive = system.clone();
            positive.structure.mass = identity.into();
            let real = dense_modes(&positive, n);
            let top = 0.5 * real.frequency_hz(n - 1).max(1.0);
            let found = certified_modes(&system, &state, &real, [0.0, top], f64::INFINITY, &());
            let broken = found.is_err()
                || found.is_ok_and(|(modes, count)| count.is_none() && modes.broken_premise.is_some());
            assert!(broken, "seed {seed}: the mass is indefinite");
            without += 1;
            continue;
        }
        let real = dense_modes(&system, n);
        let top = [0.02, 0.3, 1.1][seed as usize % 3] * real.frequency_hz(n - 1).max(1.0);
        let low = if seed % 4 == 1 { 0.1 * top } else { 0.0 };
        let spectrum = dense_spectrum(&system, &state);
        let (modes, certificate) =
            certified_modes(&system, &state, &real, [low, top], f64::INFINITY, &()).unwrap();
        let slowest = SLOWEST_GROWTH * TAU * top;
        for z in spectrum.iter().filter(|z| z.re > 1.01 * slowest && z.im.abs() < 1e-9 * z.norm()) {
            diverging += 1;
            let near = modes.modes.iter().map(|m| (m.eigenvalue - z).norm()).fold(f64::INFINITY, f64::min);
            assert!(within(near, 1e-6 * z.norm(), Tolerance), "seed {seed}: {z} {:?}", modes.warnings);
        }
        let Some(certificate) = certificate else { continue };
        assert!(!damping || !certificate.holds(), "seed {seed}: C is indefinite, {certificate:?}");
        if certificate.whole() {
            whole += 1;
            let exact = dense_count(
                &spectrum,
                &Certificate { growth: [certificate.growth[0], f64::INFINITY], ..certificate.clone() },
            );
            assert_eq!(exact, certificate.found, "seed {seed}: {certificate:?}");
        }
    }
    println!("{diverging} {whole} {without}");
    assert!(diverging > 100 && whole > 150 && without > 40, "{diverging} {whole} {without}");
}

/// A system larger than its basis, with a coupling that makes pairs of modes flutter.
fn large(seed: u64, kind: u64) -> (System, SteadySliding, RealModes, [f64; 2]) {
    let n = 140;
    let mut system = damped(random_system(n, 3, 20.0, seed), kind);
    let state = steady(&system);
    let real = dense_modes(&system, 40);
    let top = 0.5 * (real.frequency_hz(4) + real.frequency_hz(5));
    let mut random = Random::seeded(seed);
    let mut direction = || vector(&[0, 1, 2].map(|_| (random.below(n), random.between(-1.0, 1.0))));
    let directions = vec![direction(), direction()];
    let (stiffness, damping) = (faer::mat![[0.0, 900.0], [-900.0, 0.0]], faer::mat![[-8.0, 0.0], [0.0, 0.0]]);
    system.coupling = Some(Coupling { directions, stiffness, damping, skew: None });
    (system, state, real, [0.0, top])
}

/// Falling friction, and degrees of freedom with stiffness alone, whose masses are exact zeros or the rounding of one.
#[test]
fn the_rounding_of_a_mass_of_zero_costs_no_proof() {
    let certified = |noise: f64| {
        let (system, ..) = large(1003, 3);
        let n = system.n_dofs();
        let (m, k) = (system.structure.mass.to_dense(), system.structure.stiffness.to_dense());
        let massless = |i: usize| i >= n;
        let mut system = system.clone();
        system.structure.mass = sparse(n + 3, |i, j| match (massless(i), massless(j)) {
            (false, false) => 1e-6 * m[(i, j)],
            (true, true) if i == j => noise,
            _ => 0.0,
        })
        .into();
        system.structure.stiffness = sparse(n + 3, |i, j| match (massless(i), massless(j)) {
            (false, false) => 1e-6 * k[(i, j)] + if i == j && i < 3 { 1e-4 } else { 0.0 },
            (true, true) => {
                if i == j {
                    3e-4
                } else {
                    0.0
                }
            }
            _ => {
                if i.abs_diff(j) == n {
                    -1e-4
                } else {
                    0.0
                }
            }
        })
        .into();
        system.structure.damping = Default::default();
        system.load = vec![0.0; n + 3];
        system.pairs.clear();
        let coupling = system.coupling.as_mut().unwrap();
        let micro = |a: &Mat<f64>| a * faer::Scale(1e-6);
        (coupling.stiffness, coupling.damping) = (micro(&coupling.stiffness), micro(&coupling.damping));
        let state = steady(&system);
        let (real, _) =
            crate::modal::compute(&system.structure, crate::modal::ModesWanted::BelowHz(12.0), &()).unwrap();
        let band = [0.0, 0.5 * (real.frequency_hz(4) + real.frequency_hz(5))];
        let (_, certificate) = certified_modes(&system, &state, &real, band, f64::INFINITY, &()).unwrap();
        certificate.unwrap()
    };
    let exact = certified(0.0);
    for noise in [1e-27, -1e-27] {
        let certificate = certified(noise);
        assert!(certificate.holds() && certificate.proven, "{noise:e}: {certificate:?}");
        assert_eq!(
            (certificate.counted, certificate.nothing_faster),
            (exact.counted, exact.nothing_faster),
            "{noise:e}: {certificate:?}"
        );
    }
}

#[test]
fn a_truncated_basis_is_bounded_and_counts_as_the_full_order() {
    let mut unstable = 0;
    for kind in 0..8 {
        let (system, state, real, band) = large(1000 + kind, kind);
        let (modes, certificate) = certified_modes(&system, &state, &real, band, f64::INFINITY, &()).unwrap();
        assert!(modes.subspace_dimension < system.n_dofs());
        let certificate = certificate.unwrap();
        let exact = dense_count(&dense_spectrum(&system, &state), &certificate);
        println!("{kind} {} {certificate:?}", modes.subspace_dimension);
        assert!(certificate.holds(), "{certificate:?}");
        assert_eq!(certificate.counted, exact);
        unstable += exact;
        analyse(&system, &state, &real, band, &(), |modes, analysis| {
            let listed = count_by(Way::Spectrum, &analysis, modes, f64::INFINITY).unwrap();
            println!("{kind} one by one: {listed:?}");
            assert!(listed.holds() && listed.counted == exact, "{listed:?}");
        })
        .unwrap();
    }
    assert!(unstable > 0);
}

/// Contact in some hundred points, whose directions are more than the real modes: counted in a narrow basis, or in a richer one, as by the
/// dense solver, or not proven, which is said.
#[test]
fn hundreds_of_points_are_counted_as_by_the_dense_solver_or_said_not_to_be() {
    let (mut proven, mut open, mut grows) = (0, 0, 0);
    for seed in 0..6u64 {
        let n = 240;
        let mut system = damped(random_system(n, 120, 60.0, 2000 + seed), seed);
        let mut state = steady(&system);
        let mut random = Random::seeded(seed);
        let mut direction = || vector(&[0, 1, 2].map(|_| (random.below(n), random.between(-1.0, 1.0))));
        let directions = vec![direction(), direction()];
        let stiffness = faer::mat![[0.0, 300.0], [-300.0, 0.0]];
        let damping = faer::mat![[-8.0, 0.0], [0.0, 0.0]];
        system.coupling = Some(Coupling { directions, stiffness, damping, skew: None });
        for point in &mut state.points {
            let weak = [0.05, 0.2, 1.0][seed as usize % 3];
            point.tangent.by_penetration[1..].iter_mut().for_each(|friction| *friction *= weak);
            point.tangent.by_slip_velocity.as_flattened_mut().iter_mut().for_each(|damping| *damping *= weak);
        }
        let real = dense_modes(&system, 50);
        let band = [0.0, 0.5 * (real.frequency_hz(9) + real.frequency_hz(10))];
        let (modes, certificate) = certified_modes(&system, &state, &real, band, f64::INFINITY, &()).unwrap();
        let Some(certificate) = certificate else {
            assert!(!modes.warnings.is_empty(), "seed {seed}");
            open += 1;
            continue;
        };
        let exact = dense_count(&dense_spectrum(&system, &state), &certificate);
        println!("{seed} {} {exact} {certificate:?}", modes.subspace_dimension);
        if certificate.margin > 1.0 {
            assert_eq!(certificate.counted, exact, "seed {seed}: {certificate:?}");
            assert!(certificate.holds(), "seed {seed}: {certificate:?}");
            proven += 1;
            grows += exact;
        } else {
            assert!(modes.warnings.iter().any(|words| words.contains("no proof")), "seed {seed}");
            open += 1;
        }
    }
    println!("{proven} proven, {open} open, {grows} that grow");
    assert!(proven >= 3, "{proven} proven, {open} open, {grows} that grow");
}

#[test]
fn a_mode_too_few_or_too_many_is_noticed() {
    // The first sample with a mode that grows.
    let grows = |(system, state, real, band): &(System, SteadySliding, RealModes, [f64; 2])| {
        let found = complex_modes(system, state, real, *band, &()).unwrap();
        found.modes.iter().any(|mode| mode.growth_rate() > 1e-3)
    };
    let mut samples = (1000..1050).map(|seed| large(seed, 4));
    let (system, state, real, band) = samples.find(grows).expect("a sample with a mode that grows");
    analyse(&system, &state, &real, band, &(), |modes, analysis| {
        assert!(count(&analysis, modes, f64::INFINITY).unwrap().agrees());
        let at = modes.modes.iter().position(|m| m.growth_rate() > 1e-3).expect("that mode");
        let removed = modes.modes.remove(at);
        let fewer = count(&analysis, modes, f64::INFINITY).unwrap();
        assert!(!fewer.agrees() && !fewer.holds() && fewer.counted == fewer.found + 2);
        modes.modes.extend([removed.clone(), removed]);
        assert!(!count(&analysis, modes, f64::INFINITY).unwrap().agrees());
    })
    .unwrap();
}

#[test]
fn too_few_real_modes_or_static_responses_do_not_pass_for_a_proof() {
    let (system, state, real, [_, top]) = large(1003, 1);
    // The band reaches above what the Sturm count covers.
    let few = dense_modes(&system, 6);
    let high = 1.05 * few.certificate.below_hz;
    let (modes, certificate) =
        certified_modes(&system, &state, &few, [0.0, high], f64::INFINITY, &()).unwrap();
    assert!(modes.subspace_dimension < system.n_dofs());
    assert!(!modes.warnings.is_empty());
    assert!(certificate.is_none_or(|c| !c.holds() && c.margin == 0.0));
    // A count of the real modes that does not hold.
    let mut doubtful = real.clone();
    doubtful.certificate.counted[0] += 1;
    let (_, certificate) =
        certified_modes(&system, &state, &doubtful, [0.0, top], f64::INFINITY, &()).unwrap();
    assert!(!certificate.unwrap().holds());
    // Real modes alone, their static responses missing: an honest 1/ρ below that of the whole basis.
    analyse(&system, &state, &real, [0.0, top], &(), |modes, analysis| {
        let whole = count(&analysis, modes, f64::INFINITY).unwrap();
        let poor = Basis::new(analysis.operator, real.shapes.as_ref(), (TAU * top).powi(2));
        let analysis = CompletedAnalysis { basis: &poor, ..analysis };
        for way in [Way::Contour, Way::Spectrum] {
            let poor = count_by(way, &analysis, modes, f64::INFINITY);
            let poor = poor.unwrap();
            assert!(!poor.holds() && poor.margin < 0.5 * whole.margin, "{} {}", poor.margin, whole.margin);
        }
    })
    .unwrap();
}

/// ρ and the disc of each point, against dense matrices of the full order.
#[test]
fn bounds_hold_at_full_order() {
    for kind in 0..8 {
        let (system, state, real, band) = large(1010 + kind, kind);
        analyse(&system, &state, &real, band, &(), |_, analysis| {
            bounds_hold(kind, &system, &state, band, &analysis);
            // Without the static responses to the interface, W_Z and its coupling with Γ count.
            let poor = Basis::new(analysis.operator, real.shapes.as_ref(), (TAU * band[1]).powi(2));
            bounds_hold(kind, &system, &state, band, &CompletedAnalysis { basis: &poor, ..analysis });
        })
        .unwrap();
    }
}

/// The same with more directions of contact than images of the basis, and norms of W_Z from a few products.
#[test]
fn bounds_of_many_directions_hold_at_full_order() {
    for kind in 0..4 {
        let system = damped(random_system(150, 60, 60.0, 3000 + kind), kind);
        let (state, real) = (steady(&system), dense_modes(&system, 14));
        let band = [0.0, 0.5 * (real.frequency_hz(3) + real.frequency_hz(4))];
        let (closed, own, _) = closed_modes((&system, &state), &real, TAU * band[1], &()).unwrap().unwrap();
        analyse(&system, &state, &real, band, &(), |_, analysis| {
            let poor = Basis::new(analysis.operator, own.shapes.as_ref(), (TAU * band[1]).powi(2));
            let narrow = narrow::narrow(&analysis).unwrap();
            assert!(narrow.n_real() < narrow.len() && narrow.len() <= analysis.basis.len());
            assert!(directions(&analysis) > 3 * poor.len(), "{} {}", directions(&analysis), poor.len());
            for basis in [&poor, &narrow] {
                let analysis = CompletedAnalysis { basis, ..analysis };
                bounds_hold(kind, &closed.system, &closed.steady, band, &analysis);
            }
            bounds_hold(kind, &closed.system, &closed.steady, band, &analysis);
        })
        .unwrap();
    }
}

fn bounds_hold(
    kind: u64,
    system: &System,
    state: &SteadySliding,
    band: [f64; 2],
    analysis: &CompletedAnalysis<'_>,
) {
    let model = ReducedModel::new(analysis).unwrap();
    let top = TAU * band[1];
    let interface = &analysis.operator.interface;
    let pencil = Pencil::new(&model, &interface.terms, &interface.sizes(top), top).unwrap();
    let spectrum = ReducedSpectrum::new(&model, &interface.terms, &interface.sizes(top), top).unwrap();
    let (k, c) = dense_matrices(system, state);
    let (m, n) = (system.structure.mass.to_dense(), system.n_dofs());
    let real_k = system.structure.stiffness.to_dense();
    let a = &real_k - faer::Scale(analysis.shift) * &m;
    // Z: orthogonal to the basis in A, ZᵀAZ = 1.
    let b = &beside(analysis.basis.modes, analysis.basis.added.as_ref());
    let ab = &a * b;
    let project =
        Mat::<f64>::identity(n, n) - b * (b.transpose() * &ab).partial_piv_lu().solve(ab.transpose());
    let az = project.transpose() * &a * &project;
    let eigen = az.self_adjoint_eigen(Side::Lower).unwrap();
    let outside = n - b.ncols();
    let z = Mat::from_fn(n, outside, |i, j| {
        let j = n - outside + j;
        (0..n).map(|l| project[(i, l)] * eigen.U()[(l, j)]).sum::<f64>() / eigen.S()[j].sqrt()
    });
    let complex = |x: &Mat<f64>| Mat::from_fn(x.nrows(), x.ncols(), |i, j| c64::new(x[(i, j)], 0.0));
    let (b, z) = (complex(b), complex(&z));
    let mut random = Random::seeded(kind);
    for _ in 0..12 {
        let s = c64::new(random.between(1e-5, 0.3) * top, random.between(0.0, 1.0) * top);
        let point = pencil.point(s, 0.05 * top).unwrap();
        let q = Mat::from_fn(n, n, |i, j| s * s * m[(i, j)] + s * c[(i, j)] + k[(i, j)]);
        let block = |x: &Mat<c64>, y: &Mat<c64>| x.transpose() * &q * y;
        let schur = block(&z, &z) - block(&z, &b) * block(&b, &b).partial_piv_lu().solve(block(&b, &z));
        // P_ZZ: the structure without its contact.
        let structure = {
            let mut bare = system.clone();
            bare.pairs.clear();
            bare.coupling = None;
            let bare_state = SteadySliding { points: Vec::new(), ..state.clone() };
            let (k, c) = dense_matrices(&bare, &bare_state);
            Mat::from_fn(n, n, |i, j| s * s * m[(i, j)] + s * c[(i, j)] + k[(i, j)])
        };
        let p = z.transpose() * structure * &z;
        let e = &p - schur;
        let rho = p.partial_piv_lu().solve(&e).svd().unwrap().S().column_vector()[0].norm();
        assert!(
            within(rho, point.defect * (1.0 + 1e-6) + 1e-11, Stated),
            "kind {kind}: {rho:.2e} {:.2e}",
            point.defect
        );
        let bound = spectrum.bound_at(s).unwrap();
        assert!(
            within(rho, bound * (1.0 + 1e-6) + 1e-11, Stated),
            "kind {kind}: {rho:.2e} {bound:.2e} one by one"
        );
        for _ in 0..4 {
            let turn = random.between(0.0, 1.0) * TAU;
            let near = s + c64::new(turn.cos(), turn.sin()) * (point.reach * random.between(0.0, 1.0));
            let other = pencil.point(near, 1e-6 * top).unwrap();
            let change = (other.phase * point.phase.conj()).arg();
            assert!(within(change.abs(), 0.75f64.asin() + 1e-9, Stated), "kind {kind}: {change}");
        }
    }
}

#[test]
fn the_contour_leaves_out_what_is_outside() {
    let region = CountedRegion { growth: [1.0, 10.0], omega: [0.0, 20.0] };
    assert!(
        region.symmetric() && region.contains(c64::new(2.0, -5.0)) && !region.contains(c64::new(0.5, 1.0))
    );
    assert_eq!(region.distance(c64::new(3.0, 0.0)), 2.0);
    assert_eq!(region.distance(c64::new(-2.0, 24.0)), 5.0);
}

/// A flutter pair of the two-degree-of-freedom model, slower than ε, faster, and its divergence: closed form.
#[test]
fn two_dof_pairs_are_counted_and_slow_ones_are_named() {
    let run = |mu: f64| {
        let system = two_dof(0.5, 1.0, mu);
        let real = dense_modes(&system, 2);
        certified_modes(&system, &steady(&system), &real, [0.0, 0.5], f64::INFINITY, &()).unwrap().1.unwrap()
    };
    let (stable, unstable) = (run(0.6), run(0.7));
    assert!(stable.holds() && stable.counted == 0 && stable.close_calls.is_empty());
    assert!(unstable.holds() && unstable.counted == 2 && unstable.nothing_faster);
    // λ² = −(1 + k_t + k_n)/2 … ± i √−Δ: σ ≈ √−Δ / 2ω; just past μ_c = 0.625 it is below ε = 1e-5 · π.
    let slow = run(0.625 + 1e-9);
    assert_eq!(slow.counted, 0);
    assert!(slow.close_calls.iter().any(|call| call.growth_rate > 0.0 && !call.inside), "{slow:?}");
}

#[test]
fn the_certificate_does_not_depend_on_the_number_of_threads() {
    let (system, state, real, band) = large(1005, 5);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| certified_modes(&system, &state, &real, band, f64::INFINITY, &()).unwrap().1)
    };
    assert_eq!(run(1), run(3));
}
