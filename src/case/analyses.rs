//! `[modes.NAME]`, `[cea]`, `[sensitivity]`: real modes, complex eigenvalues, and how these answer scalars.

use crate::schema::raw::LARGEST;
use crate::schema::units::*;
use crate::schema::{Report, choices, declare, key};
use std::ops::Bound;

choices! {
    /// The contact during a real-mode analysis.
    pub enum ContactState {
        /// No contact.
        Open = "open",
        /// The contact's normal stiffness at steady sliding, without friction.
        Closed = "closed",
    }
}

declare! {
    /// Real modes of parts or of the whole.
    pub struct ModesAnalysis, checked by check_modes {
        /// Regions of shells, bars and solids; all of them when empty. Modes of the whole, complex ones too, are compared with those of parts
        /// alone and named by them.
        pub parts: Vec<String> = key::names("regions of shells, bars and solids").or(Vec::new()),
        /// Regions held in all degrees of freedom in this analysis only.
        pub clamp: Vec<String> = key::names("regions").or(Vec::new()),
        /// Supports, springs and rigid bodies of the case are left out.
        pub free: bool = key::flag(false),
        /// All modes below this frequency \[Hz\] …
        pub below: Option<f64> = key::quantity(FREQUENCY).positive().optional(),
        /// … or this many.
        pub count: Option<usize> = key::count().optional(),
        /// Contact open or closed.
        pub contact: ContactState = key::choice().or(ContactState::Open),
        /// Computed frequencies are multiplied by this before they are compared: an unknown thickness or modulus.
        pub frequency_scale: f64 = key::quantity(NUMBER).positive().or(1.0),
        /// Measured natural frequencies \[Hz\] to set beside the computed ones.
        pub measured: Vec<f64> = key::quantity_list(FREQUENCY).or(Vec::new()),
        /// Where they come from.
        pub measured_source: String = key::text(),
        /// Writes the shapes as a universal file too.
        pub uff: bool = key::flag(false),
    }
}

fn check_modes(modes: &ModesAnalysis, report: &mut Report) {
    match (modes.below, modes.count) {
        (None, None) => {
            report.fault("below", "nothing", "`below = \"3 kHz\"`, or a `count` of modes", "");
        }
        (Some(_), Some(_)) => report.fault("count", "both `below` and `count`", "one of them", ""),
        _ => {}
    }
}

declare! {
    /// Complex eigenvalues at steady sliding.
    pub struct CeaAnalysis, checked by check_cea {
        /// Only the pairs whose λ is nearest to iω of this frequency \[Hz\] …
        pub nearest: Option<f64> = key::quantity(FREQUENCY).positive().optional(),
        /// … this many of them.
        pub count: Option<usize> = key::count().optional(),
        /// Frequency band \[Hz\]; the pairs nearest to a frequency are sought inside.
        pub band: [f64; 2] = {
            let band = key::quantities(FREQUENCY)
                .expecting("a band such as [0, \"6 kHz\"]")
                .check("a lower and a higher frequency", |[a, b]| *a >= 0.0 && b > a);
            match *nearest {
                None => band.required_sometimes("required; with `nearest` 0 to four times that"),
                Some(hz) => band
                    .check("a band that holds the frequency of `nearest`", move |[a, b]| *a <= hz && hz <= *b)
                    .or_by("required; with `nearest` 0 to four times that", [0.0, (4.0 * hz).min(LARGEST)]),
            }
        },
        /// Real modes up to this frequency span the first subspace \[Hz\].
        pub basis_below: f64 = key::quantity(FREQUENCY)
            .within(Bound::Included(band[1]), Bound::Unbounded)
            .or_by("1.5 times the upper end of `band`", (1.5 * band[1]).min(LARGEST)),
        /// Counts the unstable eigenvalues of the band, to certify that none was missed: always, never, or, when not said,
        /// where that is expected to take no more operations than the analysis.
        pub certify: Option<bool> = key::flag(false).optional(),
        /// Looks for the same modes again by a second, independent method on the full order.
        pub confirm: bool = key::flag(false),
        /// Whether the left vectors are among the results, which take as much memory as the right ones. Sensitivities and a run
        /// in time need them, and keep them all the same.
        pub left_vectors: bool = key::flag(true),
        /// Measured squeal frequencies \[Hz\].
        pub measured_squeal: Vec<f64> = key::quantity_list(FREQUENCY).or(Vec::new()),
        /// Where they come from.
        pub measured_source: String = key::text(),
    }
}

fn check_cea(cea: &CeaAnalysis, report: &mut Report) {
    if cea.nearest.is_some() != cea.count.is_some() {
        let absent = if cea.count.is_some() { "nearest" } else { "count" };
        report.fault(absent, "nothing", "`nearest = \"2 kHz\"` and `count = 50` together", "");
    }
}

declare! {
    /// How complex eigenvalues answer the scalars of the case, and small things mounted on its nodes.
    pub struct SensitivityAnalysis {
        /// The complex modes nearest to these frequencies \[Hz\]; the unstable ones when empty.
        pub modes: Vec<f64> = key::quantity_list(FREQUENCY)
            .check("frequencies of zero or more", |list| list.iter().all(|f| *f >= 0.0))
            .or(Vec::new()),
        /// Paths of scalars; a `*` stands for any letters, so that `*` alone is all of them.
        pub parameters: Vec<String> = key::names("paths of scalars, or parts of them with `*`").or(vec!["*".into()]),
        /// Whether to work out where a mass, a spring or a damper helps.
        pub advice: bool = key::flag(true),
        /// The mass that the advice speaks of \[kg\].
        pub mass: f64 = key::quantity(MASS).positive().or(1e-3),
        /// The constant of the damper that the advice speaks of \[N s/m\].
        pub damper: f64 = key::quantity(DASHPOT).positive().or(1.0),
        /// Mounts the best mass and the best damper of each mode, and runs the analysis anew.
        pub verify: bool = key::flag(false),
    }
}
