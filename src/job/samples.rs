//! Sample cases of several tests, those in `tests` included.

/// A steel disc of 1 mm, held at its hub: `radial` and `around` cells.
pub(crate) fn disc(radial: usize, around: usize) -> String {
    format!(
        r#"
[mesh.annulus]
outer_radius = "75 mm"
hub_radius = "15 mm"
radial = {radial}
around = {around}
[material.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
density = "7850 kg/m^3"
[shell.disc]
material = "steel"
thickness = "1 mm"
bending_only = true
[support.hub]
on = "hub"
"#
    )
}
