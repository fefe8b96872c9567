//! A made-up run with the shape of a real one, for the tests of the writers and the report: an annular disc with
//! shapes cos nθ · R(r), a slider, a bar, steady sliding on a dozen rim nodes, and a few complex modes.
//! Its figures look like the rig's and are not computed from anything.

mod calibration;
mod explored;
mod measured;
pub use calibration::calibration;

use super::record::InputFile;
use super::*;
use crate::equilibrium::{PointState, SteadySliding};
use crate::linalg::c64;
use crate::modal::{DiscModeName, RealModes, SturmCertificate};
use crate::stability::{ComplexMode, ComplexModes, GrowthBudget};
use crate::structure::{DofMap, FreeDof};
use crate::system::{ContactForces, ContactTangent};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

const HUB: f64 = 0.021;
const RIM: f64 = 0.075;
const RINGS: usize = 9;
const SECTORS: usize = 72;
const LEAD: f64 = 4.0 * PI / 180.0;
const LOAD: f64 = 20.0;
const MU: f64 = 0.4;

/// (n, s, frequency \[Hz\], whether it is a double mode), ascending.
const DISC_MODES: [(usize, usize, f64, bool); 11] = [
    (1, 0, 272.4, true),
    (0, 0, 281.3, false),
    (2, 0, 337.9, true),
    (3, 0, 582.6, true),
    (4, 0, 974.8, true),
    (5, 0, 1484.2, true),
    (0, 1, 1745.0, false),
    (1, 1, 1834.7, true),
    (6, 0, 2098.1, true),
    (2, 1, 2122.9, true),
    (3, 1, 2644.3, true),
];

/// The whole run.
pub(crate) fn rig() -> RunResults {
    let (geometry, disc_nodes) = geometry();
    let disc = disc_modes(&geometry, disc_nodes);
    let whole = NamedModes { name: "rig with closed contact".into(), ..disc_modes(&geometry, disc_nodes) };
    let complex = complex_result(&disc);
    let paired = |n, s| disc.names.iter().position(|name| *name == Some(mode_name(n, s)));
    let measured = measured::modes(&disc, [paired(2, 0), paired(4, 0), paired(0, 1), None]);
    let sensitivity = sensitivity(&geometry, &complex);
    let mut records = Records::default();
    records.push(disc);
    records.push(measured);
    records.push(whole);
    records.push(steady_result(&geometry));
    records.push(complex);
    records.push(sensitivity);
    records.push(transient(geometry.nodes.len()));
    records.push(explored::sweep());
    records.push(explored::map());
    records.push(explored::damping());
    records.push(explored::uncertainty());
    records.push(frf());
    records.push(measured::responses(frf()));
    records.push(calibration::calibration());
    RunResults {
        records,
        title: "Disc on slider <reference & \"first\" case>".into(),
        resolved_case: "title = \"Disc on slider\"\n[contact]\nmu = 0.4\nload = 20.0 # N\n".into(),
        assumptions: vec!["hub radius 21 mm: not stated".into(), "frequencies scaled by 0.972".into()],
        warnings: vec!["The slider (10 mm) is thick for Kirchhoff theory: about 2 % at 2600 Hz.".into()],
        size: ModelSize {
            nodes: geometry.nodes.len(),
            elements: geometry.elements.len(),
            dofs: 6 * geometry.nodes.len() - 60,
            nonzeros: 40 * geometry.nodes.len(),
            contact_points: 26,
        },
        timings: [
            ("mesh and assembly", 0.21),
            ("real modes", 1.3),
            ("steady sliding", 0.07),
            ("complex", 1.9),
        ]
        .map(|(phase, s)| (phase.to_string(), s))
        .to_vec(),
        geometry,
        inputs: vec![InputFile { path: "rig.msh".into(), bytes: 1234, sha256: "0".repeat(64) }],
        provenance: Some(Provenance {
            commit: "unknown",
            started: "2026-01-31T09:05:00Z".into(),
            command: ["stridor", "run", "rig.toml"].map(String::from).to_vec(),
            threads: 2,
            engine: "default",
            ranks: 1,
            system: "linux".into(),
            processor: None,
            cores: Some(2),
            memory_bytes: Some(1 << 34),
            case_file: Some(InputFile { path: "rig.toml".into(), bytes: 12, sha256: "1".repeat(64) }),
            case_text: "title = \"<written by hand>\"\n".into(),
        }),
        failed: None,
    }
}

fn mode_name(n: usize, s: usize) -> DiscModeName {
    DiscModeName { nodal_diameters: n, nodal_circles: s }
}

/// Turns about the lateral axis through the hub's centre: the lowest rim point moves towards −x.
fn tilt([x, y, z]: [f64; 3]) -> [f64; 3] {
    let (s, c) = LEAD.sin_cos();
    let lowest = RIM - RIM * c;
    [c * x + s * (z - RIM), y, RIM - s * x + c * (z - RIM) - lowest]
}

/// The mesh, and how many of its first nodes are the disc's.
fn geometry() -> (Geometry, usize) {
    let mut g = Geometry { parts: vec!["disc".into(), "slider".into(), "bar".into()], ..Default::default() };
    for ring in 0..=RINGS {
        let r = HUB + (RIM - HUB) * ring as f64 / RINGS as f64;
        for sector in 0..SECTORS {
            let angle = TAU * sector as f64 / SECTORS as f64 - 0.5 * PI;
            g.nodes.push(tilt([0.0, r * angle.cos(), RIM + r * angle.sin()]));
        }
    }
    let n_disc = g.nodes.len();
    for ring in 0..RINGS {
        for sector in 0..SECTORS {
            let (a, b) = (ring * SECTORS + sector, ring * SECTORS + (sector + 1) % SECTORS);
            g.elements.push(vec![a, a + SECTORS, b + SECTORS]);
            g.elements.push(vec![a, b + SECTORS, b]);
        }
    }
    g.part_of.resize(g.elements.len(), 0);
    let (nx, ny) = (20, 12);
    for j in 0..=ny {
        for i in 0..=nx {
            g.nodes.push([-0.1 + 0.2 * i as f64 / nx as f64, -0.06 + 0.12 * j as f64 / ny as f64, -0.005]);
        }
    }
    for j in 0..ny {
        for i in 0..nx {
            let a = n_disc + j * (nx + 1) + i;
            g.elements.push(vec![a, a + 1, a + nx + 2, a + nx + 1]);
        }
    }
    g.part_of.resize(g.elements.len(), 1);
    let first = g.nodes.len();
    for i in 0..=10 {
        g.nodes.push(tilt([0.015 * i as f64, 0.0, RIM]));
    }
    g.elements.extend((0..10).map(|i| vec![first + i, first + i + 1]));
    g.part_of.resize(g.elements.len(), 2);
    (g, n_disc)
}

/// The disc's normal after tilting.
fn disc_normal() -> [f64; 3] {
    [LEAD.cos(), 0.0, -LEAD.sin()]
}

fn disc_shape(geometry: &Geometry, n_disc: usize, n: usize, s: usize, phase: f64) -> NodalField<f64> {
    let normal = disc_normal();
    let node = |k: usize| {
        if k >= n_disc {
            return [0.0; 6];
        }
        let xi = (k / SECTORS) as f64 / RINGS as f64;
        let angle = TAU * (k % SECTORS) as f64 / SECTORS as f64;
        let radial = if s == 0 { xi * xi } else { 4.0 * xi * xi * (xi - 0.8) };
        let w = radial * (n as f64 * angle + phase).cos();
        [w * normal[0], 0.0, w * normal[2], 0.0, 0.0, 0.0]
    };
    (0..geometry.nodes.len()).map(node).collect()
}

/// Every node moves in all six ways.
fn every_freedom(geometry: &Geometry) -> Arc<DofMap> {
    let free = (0..6 * geometry.nodes.len())
        .map(|k| FreeDof { node: k / 6, direction: std::array::from_fn(|axis| f64::from(axis == k % 6)) });
    Arc::new(DofMap::given(geometry.nodes.clone(), free.collect()))
}

fn disc_modes(geometry: &Geometry, n_disc: usize) -> NamedModes {
    let (mut eigenvalues, mut shapes, mut names) = (vec![], vec![], vec![]);
    for (n, s, hz, double) in DISC_MODES {
        for copy in 0..=usize::from(double) {
            eigenvalues.push((TAU * hz).powi(2) * (1.0 + 1e-9 * copy as f64));
            shapes.push(disc_shape(geometry, n_disc, n, s, -0.5 * PI * copy as f64));
            names.push(Some(mode_name(n, s)));
        }
    }
    let count = eigenvalues.len();
    NamedModes {
        name: "disc".into(),
        modes: RealModes {
            eigenvalues,
            shapes: faer::Mat::from_fn(6 * geometry.nodes.len(), count, |i, k| shapes[k][i / 6][i % 6]),
            backward_errors: (0..count).map(|k| 1e-16 * (k + 1) as f64).collect(),
            rigid_bodies: 0,
            certificate: SturmCertificate {
                below_hz: 3000.0,
                shifts_hz: [2999.0, 3001.0],
                counted: [count; 2],
                found: count,
            },
        },
        dofs: every_freedom(geometry),
        moving_part: vec![Some("disc".into()); count],
        names,
        effective_mass: (0..count).map(|k| [0.08 / (k + 1) as f64, 0.0, 1e-4]).collect(),
        total_mass: 0.139,
        damping_ratio: vec![0.0035; count],
        universal: false,
    }
}

/// Thirteen rim nodes with a point at each edge; only the lower edge near the lowest point carries the load.
fn steady_result(geometry: &Geometry) -> SteadyResult {
    let depth = |y: f64, edge: f64| 4e-6 * (1.0 - (y / 0.012).powi(2)) + 3e-6 * (edge - 1.0);
    let mut places = vec![];
    for i in -6..=6i32 {
        for edge in [-1.0, 1.0] {
            let y = RIM * (TAU * f64::from(i) / 200.0).sin();
            places.push(([-0.0052 - 0.0005 * edge, y, y * y / 0.15], depth(y, edge)));
        }
    }
    let total: f64 = places.iter().map(|(_, d)| d.max(0.0)).sum();
    let point = |&(_, penetration): &([f64; 3], f64)| {
        let normal = LOAD * penetration.max(0.0) / total;
        let k = if normal > 0.0 { LOAD / total } else { 0.0 };
        PointState {
            penetration,
            forces: ContactForces { normal, friction: [MU * normal, 0.0] },
            tangent: ContactTangent { by_penetration: [k, MU * k, 0.0], ..Default::default() },
        }
    };
    SteadyResult {
        state: SteadySliding {
            displacement: vec![0.0; 6 * geometry.nodes.len()],
            approach: vec![5e-6],
            points: places.iter().map(point).collect(),
            iterations: 6,
            residual: 3e-15,
        },
        displacement: vec![[1e-6, 0.0, -2e-6, 0.0, 0.0, 0.0]; geometry.nodes.len()],
        points: places.iter().map(|(place, _)| ("rim".to_string(), *place)).collect(),
        pairs: vec![("rim".into(), LOAD, 0.5)],
        directions: vec![[[0.0, 0.0, -1.0], [1.0, 0.0, 0.0]]],
    }
}

/// Travelling waves: each shape is one of a pair of disc modes plus i times the other.
fn complex_result(disc: &NamedModes) -> ComplexResult {
    let terms = [
        (272.1, -3.1, 1.0, -0.2, 0.6),
        (280.9, -2.0, 0.2, -0.1, 0.1),
        (336.0, -4.0, 1.5, -0.2, 0.3),
        (340.2, -4.1, 0.3, -0.2, -0.4),
        (583.1, -7.2, 1.0, -0.1, 0.0),
        (941.5, -11.0, 5.5, -0.6, 26.0),
        (975.2, -11.5, 2.0, -0.1, -26.0),
        (1484.6, -15.0, 0.5, 0.0, 1.0),
        (1668.3, -19.0, 14.0, -1.2, 118.0),
        (1702.9, -21.0, 3.0, -0.4, -117.0),
        (1836.0, -22.0, 1.0, -0.2, 2.0),
        (2098.8, -26.0, 0.5, 0.0, 0.4),
        (2603.9, -31.0, 9.0, -0.9, 38.5),
        (2644.1, -640.0, 1.0, -0.1, -3.0),
    ];
    let mode = |(k, &(hz, damping, falling, transverse, coupling)): (usize, &(f64, f64, f64, f64, f64))| {
        let growth = GrowthBudget {
            structural_damping: damping,
            falling_friction: falling,
            transverse_friction: transverse,
            mode_coupling: coupling,
        };
        let n = disc.modes.shapes.nrows();
        ComplexMode {
            eigenvalue: c64::new(damping + falling + transverse + coupling, TAU * hz),
            right: (0..n)
                .map(|i| c64::new(disc.modes.shapes[(i, k)], disc.modes.shapes[(i, k + 1)]))
                .collect(),
            left: (0..n)
                .map(|i| c64::new(disc.modes.shapes[(i, k)], -disc.modes.shapes[(i, k + 1)]))
                .collect(),
            backward_error: 2e-16 * (k + 1) as f64,
            eigenvalue_error: 4e-12,
            condition: 1.5 + k as f64,
            growth,
            participation: vec![(k, 0.61), (k + 1, 0.22)],
        }
    };
    let modes: Vec<ComplexMode> = terms.iter().enumerate().map(mode).collect();
    let name = |k: usize| disc.names[k].map(|n| format!("({},{})", n.nodal_diameters, n.nodal_circles));
    let words = |k: usize| format!("61 % disc {}; 22 % disc {}", name(k).unwrap(), name(k + 1).unwrap());
    ComplexResult {
        dofs: Arc::clone(&disc.dofs),
        participation: (0..modes.len()).map(words).collect(),
        real_modes: (0..disc.names.len())
            .map(|k| {
                disc.names[k]
                    .map_or(String::new(), |n| format!("disc ({}, {})", n.nodal_diameters, n.nodal_circles))
            })
            .collect(),
        measured_squeal_hz: [936.0, 1661.0, 2600.0].map(|hz| (hz, "accelerometer".to_string())).to_vec(),
        band_hz: [100.0, 3000.0],
        certificate: None,
        confirmation: None,
        modes: ComplexModes { modes, subspace_dimension: 142, refinements: 2, warnings: Vec::new() },
    }
}

/// Rates that fall off from the rim's lowest point, and a few scalars, for the unstable modes.
fn sensitivity(geometry: &Geometry, complex: &ComplexResult) -> SensitivityResult {
    let far = |x: &[f64; 3]| (x[0] * x[0] + x[1] * x[1] + (x[2] + RIM).powi(2)).sqrt() / RIM;
    let field = |k: usize| -> Vec<c64> {
        let scale = 2e3 * (k as f64 + 1.0);
        let rate = |x| c64::new(-scale * (4.0 * far(x)).cos() * (-far(x)).exp(), -3e4 * (-far(x)).exp());
        geometry.nodes.iter().map(rate).collect()
    };
    let scalars = [
        ("contact.rim.friction.mu0", 0.4, "", 310.0),
        ("material.steel.youngs_modulus", 2e11, "Pa", -2.2e-10),
        ("contact.rim.load", 20.0, "N", 0.7),
        ("contact.rim.placement.lead_angle", 0.07, "rad", 90.0),
        ("damping.modal_ratio", 0.0035, "", -1.05e4),
    ];
    let unstable = complex.modes.modes.iter().enumerate().filter(|(_, m)| m.unstable());
    let modes = unstable.map(|(k, mode)| {
        let mass = field(k);
        let rate = |(path, value, unit, rate): &(&str, f64, &str, f64)| ParameterRate {
            path: path.to_string(),
            value: *value,
            unit: unit.to_string(),
            rate: c64::new(*rate, 30.0 * rate),
            error: 1e-8 * rate.abs(),
            kink: path.ends_with("angle"),
        };
        let node = (0..mass.len()).min_by(|a, b| mass[*a].re.total_cmp(&mass[*b].re)).unwrap();
        let predicted = 1e-3 * mass[node];
        ModeSensitivity {
            mode: k,
            eigenvalue: mode.eigenvalue,
            parameters: scalars.iter().map(rate).collect(),
            best: vec![Mounted {
                kind: "mass",
                amount: 1e-3,
                unit: "kg",
                node,
                position: geometry.nodes[node],
                direction: None,
                predicted,
                done: Some(0.97 * predicted),
                slope_error: Some(2e-5),
            }],
            advice: Some(AdviceField {
                stiffness: mass.iter().map(|m| [-1e-6 * m; 4]).collect(),
                damping: mass.iter().map(|m| [1e-3 * m; 4]).collect(),
                mass,
            }),
        }
    });
    let left_out = vec![("mesh.rig.disc_size".to_string(), "an element size".to_string())];
    SensitivityResult { modes: modes.collect(), left_out }
}

/// A reduced model that is as good as one may expect.
fn reduced_check() -> ReducedCheck {
    ReducedCheck {
        modes: [14, 14],
        eigenvalue: Some(Deviation { relative: 3.2e-6, mode: 9 }),
        growth: Some(Deviation { relative: 1.4e-4, mode: 3 }),
        motion: Some(MotionCompared {
            steps: 100,
            probe: "rim".into(),
            displacement: Some(2.5e-4),
            normal_force: None,
        }),
    }
}

/// Two resonances, of which the second does not show at the second place.
fn frf() -> FrfResult {
    let frequencies_hz: Vec<f64> = (0..400).map(|k| 100.0 + 5.0 * k as f64).collect();
    let term = |hz: f64, own: f64| {
        let turn = hz / own;
        -(c64::new(turn * turn, 0.0) / c64::new(1.0 - turn * turn, 0.007 * turn))
    };
    let response = |(name, parts): (&str, [f64; 2])| FrfResponse {
        name: name.into(),
        place: "a node of disc, 0.3 mm from the place".into(),
        at: PlaceAndDirection { position: [0.0, 0.0, -0.07], direction: [0.8, 0.6, 0.0] },
        values: frequencies_hz
            .iter()
            .map(|hz| term(*hz, 338.0) * parts[0] + term(*hz, 1745.0) * parts[1])
            .collect(),
    };
    let resonance = |frequency_hz, name: &str, seen: [f64; 2]| Resonance {
        frequency_hz,
        name: name.into(),
        seen: seen.to_vec(),
    };
    FrfResult {
        name: "hammer".into(),
        quantity: crate::measured::Quantity::Accelerance,
        force: PlaceAndDirection { position: [0.0, 0.0, -0.07], direction: [1.0, 0.0, 0.0] },
        about: "contacts open; superposition of 88 real modes and 2 static residuals".into(),
        excitation: "a node of disc, 0.3 mm from the place".into(),
        responses: [("rim", [10.0, 25.0]), ("inside", [4.0, 1e-3])].map(response).into(),
        resonances: vec![
            resonance(338.0, "disc (2, 0)", [0.4, 1.0]),
            resonance(1745.0, "disc (0, 1)", [1.0, 2.5e-4]),
        ],
        measured: vec![330.0, 1697.0],
        deviation: 3e-5,
        compared: 5,
        frequencies_hz,
        binary: false,
    }
}

/// A decaying transient at 1668 Hz with its double; all of the nodes move along x by 2 µm.
fn transient(nodes: usize) -> TransientResult {
    let (step, steps) = (2e-5, 4000);
    let of = |f: &dyn Fn(f64) -> f64| (0..=steps).map(|k| f(k as f64 * step)).collect::<Vec<f64>>();
    let squeal = |t: f64| 0.3 * (TAU * 1668.0 * t).sin() * (1.0 - (-60.0 * t).exp());
    let records = [
        ("rim_velocity", "m/s", of(&squeal)),
        ("contact_friction_force", "N", of(&|t| 8.0 + 2.0 * squeal(t) + squeal(t).powi(2))),
        ("penetration", "m", of(&|t| 1e-6 * (1.0 + 0.2 * squeal(t)))),
    ];
    let channel = |(name, unit, values): &(&str, &'static str, Vec<f64>)| {
        let mut channel = Channel::new(name.to_string(), unit, name.replace('_', " "));
        channel
            .look(values.len(), step, |part| Ok(values[part].to_vec()))
            .expect("reading memory does not fail");
        channel
    };
    let channels = records.iter().map(channel).collect();
    let spectra = [0, 1].map(|channel| {
        let spectrum = crate::signal::spectrum(&records[channel].2[steps / 2..], step, 1000);
        let peaks = crate::signal::peaks(&spectrum, 1e-2, 5);
        let measured = if channel == 0 { vec![936.0, 1661.0, 2600.0] } else { Vec::new() };
        SpectrumOf { channel, window: [0.04, 0.08], spectrum, peaks, measured, beyond: None }
    });
    let short = |k: usize| (k, crate::signal::spectrogram(&records[k].2, step, 4000.0));
    let cycle = |k: usize| crate::signal::limit_cycle(&records[k].2[3000..], step, 1668.0).map(|c| (k, c));
    let motion: Vec<[f64; 2]> = records[0].2[3600..].iter().map(|v| [1e-4 * v.abs().sqrt(), *v]).collect();
    let mut contact = ContactWatch::new(steps + 1, step, 4);
    for k in 0..=steps {
        contact.take([k / 400 % 2, k / 800 % 2, 1]);
    }
    let diagnostics = Diagnostics {
        spectrograms: [0, 1].map(short).into(),
        cycles: [0, 1].into_iter().filter_map(cycle).collect(),
        window: [0.06, 0.08],
        orbit: Orbit {
            periods: [12.0, 1668.0],
            curves: vec![
                PhaseCurve {
                    channels: [0, 1],
                    points: motion.iter().map(|[_, v]| [0.5 - v, 8.0 + 2.0 * v]).collect(),
                },
                PhaseCurve { channels: [2, 0], points: motion },
            ],
        },
        contact: contact.finish(),
    };
    TransientResult {
        time_step: step,
        rows: steps + 1,
        scheme: "HHT, α = -0.05".into(),
        set_valued: vec![],
        reduced: Some([88, 13]),
        reduced_check: Some(reduced_check()),
        channels,
        shown: vec![0, 1],
        spectra: spectra.into(),
        fundamental_hz: Some(1668.0),
        cycle: Some(CycleFields {
            frequency_hz: 1668.0,
            window: [0.0704, 0.08],
            harmonics: [2e-6, 1e-8].map(|x| vec![[c64::new(0.0, x), c64::ZERO, c64::ZERO]; nodes]).into(),
        }),
        growth: Some(GrowthCompared { mode: 3, eigenvalue: c64::new(60.0, TAU * 1668.0), found: None }),
        work: crate::transient::Work { drive: 0.5, heat: 0.49, damping: -0.01, ..Default::default() },
        worst_residual: 1e-13,
        split: (0, 1),
        spent: [0.0, 0.0, 0.0, 1.0],
        parts: 0,
        events: [2, 1, 4, 0, 0],
        diagnostics,
        sound: Some(sound()),
    }
}

/// Two plates that sound at 1668 Hz and its double, and a second of it.
fn sound() -> Sound {
    let line = |k: usize, scale: f64| {
        let near = |at: f64| (-((k as f64 * 10.0 - at) / 12.0).powi(2)).exp();
        scale * (1e-3 * near(1668.0) + 1e-5 * near(3336.0) + 1e-10)
    };
    let lines =
        |scale: f64| (0..500).map(|k| if k == 0 { 0.0 } else { line(k, scale) }).collect::<Vec<f64>>();
    let microphone = |(name, part): (&str, f64)| MicrophoneSound {
        name: name.into(),
        at: [part, 0.0, 0.075],
        spectrum: crate::signal::Spectrum {
            resolution_hz: 10.0,
            amplitude: lines(1.0).iter().map(|w| part * (100.0 * w).sqrt()).collect(),
        },
        recording: PressureRecord {
            begin: 0.0,
            rate: 48_000,
            pressure: (0..4800).map(|k| 0.3 * part * (TAU * 1668.0 * k as f64 / 48e3).sin()).collect(),
        },
    };
    let peak = crate::signal::Peak { frequency_hz: 1668.0, amplitude: 0.0316, relation: String::new() };
    Sound {
        window: [0.04, 0.08],
        air: crate::sound::Air::default(),
        resolution_hz: 10.0,
        plates: vec![("disc".into(), lines(1.0)), ("slider".into(), lines(0.02))],
        mode_shares: vec![0.01, 0.9, 0.09],
        tones: vec![Tone { peak, power: 2e-3, share: 0.98 }],
        microphones: [("axis", 1.0), ("side", 0.5)].map(microphone).into(),
    }
}
