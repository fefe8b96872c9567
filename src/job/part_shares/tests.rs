use super::*;
use crate::bounds::{Origin::*, within};
use crate::case::Case;
use crate::job::{Prepared, Selection, analyse};
use crate::mesh::Cell;
use crate::modal::{ModesWanted, compute};
use crate::results::ComplexResult;
use crate::structure::{Bar, Material, Part, RayleighDamping, Section, Support, assemble};
use std::path::Path;

/// Half of a rod: length \[m\], cross section \[m²\], modulus \[Pa\], density \[kg/m³\], loss factor.
struct Half {
    length: f64,
    area: f64,
    modulus: f64,
    density: f64,
    loss: f64,
}

const HALVES: [Half; 2] = [
    Half { length: 0.6, area: 1e-4, modulus: 70e9, density: 2700.0, loss: 0.01 },
    Half { length: 0.4, area: 3e-4, modulus: 5e9, density: 7000.0, loss: 0.05 },
];

impl Half {
    /// k ℓ and E A k at ω, with a loss factor or without.
    fn wave(&self, omega: c64, loss: f64) -> [c64; 2] {
        let modulus = c64::new(1.0, loss) * self.modulus;
        let k = omega * (c64::new(self.density, 0.0) / modulus).sqrt();
        [k * self.length, modulus * self.area * k]
    }
}

/// ω of a rod that is held at the first half's end and free at the other's: E₁A₁k₁ cos k₁ℓ₁ cos k₂ℓ₂ = E₂A₂k₂ sin k₁ℓ₁ sin k₂ℓ₂, near a
/// start \[rad/s\].
fn rod(start: f64, losses: [f64; 2]) -> c64 {
    let residual = |omega: c64| {
        let [[a, ea], [b, eb]] = [0, 1].map(|h| HALVES[h].wave(omega, losses[h]));
        (ea * a.cos() * b.cos() - eb * a.sin() * b.sin()) / ea
    };
    let (mut last, mut omega) = (c64::new(0.999 * start, 0.0), c64::new(start, 0.0));
    for _ in 0..30 {
        let [before, now] = [last, omega].map(residual);
        if now == before {
            break;
        }
        let step = now * (omega - last) / (now - before);
        (last, omega) = (omega, omega - step);
    }
    omega
}

fn rod_model(elements: usize) -> Model {
    let x = |k: usize| {
        let part = k as f64 / elements as f64;
        if part <= 1.0 { HALVES[0].length * part } else { HALVES[0].length + HALVES[1].length * (part - 1.0) }
    };
    let nodes: Vec<[f64; 3]> = (0..=2 * elements).map(|k| [x(k), 0.0, 0.0]).collect();
    let part = |h: usize, name: &str| {
        let Half { area, modulus, density, loss, .. } = HALVES[h];
        let material = Material {
            youngs_modulus: modulus,
            poissons_ratio: 0.3,
            density,
            loss_factor: loss,
            rayleigh: RayleighDamping::default(),
            orthotropic: None,
        };
        let section = Section::round((4.0 * area / std::f64::consts::PI).sqrt());
        let cells = (h * elements..(h + 1) * elements).map(|k| Cell::line([k, k + 1])).collect();
        Part::new(name, cells, Bar { material, section, orientation: [0.0, 0.0, 1.0] })
    };
    Model {
        supports: vec![
            Support { nodes: (0..=2 * elements).collect(), held: [false, true, true, true, true, true] },
            Support { nodes: vec![0], held: [true; 6] },
        ],
        parts: vec![part(0, "first"), part(1, "second")],
        nodes,
        ..Model::default()
    }
}

/// Energies of a rod of two halves beside those of its closed form, u = sin k₁x/sin k₁ℓ₁ and cos k₂(ℓ − x)/cos k₂ℓ₂; and the shares of its
/// damping beside the damping ratios that closed forms have with either loss factor alone.
#[test]
fn shares_of_a_rod_of_two_halves_are_those_of_its_closed_form() {
    let model = rod_model(60);
    let assembled = assemble(&model).unwrap();
    let (modes, _) = compute(&assembled.structure, ModesWanted::Count(4), &()).unwrap();
    let shares = real_shares((&model, &assembled), &modes, &[0.0; 4]).unwrap();
    assert_eq!(shares.parts, ["first", "second"]);
    for k in 0..4 {
        let omega = rod(TAU * modes.frequency_hz(k), [0.0; 2]).re;
        assert!(within((TAU * modes.frequency_hz(k) / omega - 1.0).abs(), 5e-3, Discretisation), "{k}");
        // ∫ u² = ℓ/2 ∓ sin 2kℓ/4k, and with the other sign ∫ u′²/k².
        let energies: Vec<[f64; 2]> = (0..2)
            .map(|h| {
                let Half { length, area, modulus, density, .. } = HALVES[h];
                let kl = HALVES[h].wave(c64::new(omega, 0.0), 0.0)[0].re;
                let wave = kl / length;
                let (at_joint, sign) = if h == 0 { (kl.sin(), -1.0) } else { (kl.cos(), 1.0) };
                let part = sign * (2.0 * kl).sin() / (4.0 * wave);
                let scale = area / at_joint.powi(2);
                [
                    density * omega.powi(2) * (0.5 * length + part) * scale,
                    modulus * wave.powi(2) * (0.5 * length - part) * scale,
                ]
            })
            .collect();
        let exact = |which: usize| energies[0][which] / (energies[0][which] + energies[1][which]);
        let [first, second] = &shares.modes[k][..] else { panic!("two parts") };
        for (a, b) in [(first.kinetic, exact(0)), (first.strain, exact(1))] {
            assert!(within((a.unwrap() - b).abs(), 1e-2, Discretisation), "{k} {a:?} {b}");
        }
        let alone = [0, 1].map(|h| {
            let z = rod(omega, [0, 1].map(|other| if other == h { HALVES[h].loss } else { 0.0 }));
            z.im / z.norm()
        });
        let share = alone[0] / (alone[0] + alone[1]);
        assert!(within((first.damping.unwrap() - share).abs(), 1e-2, Theory), "{k} {first:?} {share}");
        for of in [|s: &PartShare| s.kinetic, |s: &PartShare| s.strain, |s: &PartShare| s.damping] {
            assert!(within((of(first).unwrap() + of(second).unwrap() - 1.0).abs(), 1e-14, RoundOff));
        }
    }
}

fn rig(changes: &[(&str, &str)]) -> ComplexResult {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/small-rig");
    let text = std::fs::read_to_string(folder.join("case.toml")).unwrap();
    let (model, rest) = text.split_once("[measured.impact]").unwrap();
    let cea = &rest[rest.find("[cea]").unwrap()..rest.find("[sensitivity]").unwrap()];
    let mut text = format!("{model}{cea}").replace("certify = true", "certify = false");
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let case = Case::parse("rig", &text, folder).unwrap();
    let prepared = Prepared::new(&case).unwrap();
    let mut results = analyse(&prepared, Selection::Listed, &mut |_| Ok(()), &()).unwrap();
    results.records.take::<ComplexResult>().unwrap()
}

/// Without friction the damping of a part is what the growth rates lose by its loss factor alone, to first order in it; the shares of all
/// parts, springs and modal damping add up to 1.
#[test]
fn damping_shares_of_complex_modes_are_those_of_each_loss_factor_alone() {
    let with = |disc: f64, slider: f64| {
        let materials = format!(
            "loss_factor = {disc}\n[material.iron]\nyoungs_modulus = \"200 GPa\"\npoissons_ratio = 0.3\n\
             density = \"7850 kg/m^3\"\nloss_factor = {slider}"
        );
        rig(&[
            ("rayleigh = { alpha = \"20 1/s\", beta = \"0.2 us\" }", materials.as_str()),
            ("[shell.slider]\nmaterial = \"steel\"", "[shell.slider]\nmaterial = \"iron\""),
            ("mu0 = 0.6, mu1 = 0.1", "mu0 = 0, mu1 = 0"),
            ("modal_ratio = 0.0035", "modal_ratio = 0"),
        ])
    };
    let (both, steel, iron) = (with(2e-4, 5e-4), with(2e-4, 0.0), with(0.0, 5e-4));
    let shares = both.shares.as_ref().unwrap();
    let slider = shares.parts.iter().position(|part| part == "slider").unwrap();
    let mut spread = [1.0f64, 0.0];
    for (k, mode) in both.modes.modes.iter().enumerate() {
        let [steel, iron] = [&steel, &iron].map(|other| other.modes.modes[k].growth_rate());
        let share = shares.modes[k][slider].damping.unwrap();
        let alone = iron / (steel + iron);
        // What the analysis leaves of σ, 1e-8 |λ|, and η.
        let bound = 1e-3 + 1e-7 * mode.eigenvalue.norm() / mode.growth_rate().abs();
        assert!(within((share - alone).abs(), bound, Theory), "{} Hz: {share} {alone}", mode.frequency_hz());
        spread = [spread[0].min(share), spread[1].max(share)];
    }
    assert!(spread[0] < 0.05 && spread[1] > 0.5, "{spread:?}");
}

#[test]
fn shares_add_up_to_one_and_discs_are_named() {
    let found = rig(&[]);
    let shares = found.shares.as_ref().unwrap();
    assert_eq!(shares.parts, ["disc", "slider", "bar", POINTS, MODAL]);
    for mode in &shares.modes {
        for of in [|s: &PartShare| s.kinetic, |s: &PartShare| s.strain, |s: &PartShare| s.damping] {
            assert!(mode.iter().all(|share| (-1e-12..=1.0 + 1e-12).contains(&of(share).unwrap())));
            let sum: f64 = mode.iter().filter_map(of).sum();
            assert!(within((sum - 1.0).abs(), 1e-13, RoundOff));
        }
    }
    // All of the damping is the structure's: the share of modal damping is that of 2ζω in what the growth rate loses to damping.
    let moving: Vec<_> = found.discs.iter().flatten().map(|n| (n.nodal_diameters, n.nodal_circles)).collect();
    assert!(moving.contains(&(2, 0)) && moving.contains(&(3, 0)), "{moving:?}");
}

/// A disc that the contact hardly touches moves in its own modes.
#[test]
fn a_part_that_is_coupled_weakly_moves_in_a_mode_of_its_own() {
    let found = rig(&[
        ("20 MN/m^2", "1e3 N/m^2"),
        ("load = \"20 N\"", "load = 1e-3"),
        ("mu0 = 0.6, mu1 = 0.1", "mu0 = 0.1, mu1 = 0"),
        ("[modes.rig]", "[modes.all]"),
        (
            "youngs_modulus = \"200 GPa\"\npoissons_ratio = 0.3\ndensity = \"7850 kg/m^3\"\nrayleigh = { alpha = \"20 1/s\", beta = \"0.2 us\" }",
            "youngs_modulus = \"200 GPa\"\npoissons_ratio = 0.3\ndensity = \"7850 kg/m^3\"",
        ),
        ("diameter = \"30 mm\"", "diameter = \"60 mm\""),
    ]);
    let shares = found.shares.as_ref().unwrap();
    let disc = shares.parts.iter().position(|part| part == "disc").unwrap();
    let mut seen = 0;
    for (k, mode) in shares.modes.iter().enumerate() {
        let Some(own) = found.discs[k].filter(|_| mode[disc].kinetic.unwrap() > 0.999) else { continue };
        let alone = mode[disc].alone.as_ref().unwrap();
        let name = format!("disc ({}, {})", own.nodal_diameters, own.nodal_circles);
        assert_eq!((&alone.name, shares.part_mode(k).unwrap()), (&name, alone));
        assert!(within(1.0 - alone.mac, 1e-3, Theory), "{name} {}", alone.mac);
        seen += 1;
    }
    assert!(seen > 4, "{seen}");
}
