//! The tables as CSV: a header with units, a comma between fields, a point in numbers, full precision.

use super::folder::FileNames;
use super::{
    ComplexResult, NamedModes, RunResults, SensitivityResult, SteadyResult, TransientResult, write_result,
};
use crate::error::Result;
use std::path::Path;

/// Writes `modes_<set>.csv` for every set of real modes, `contact_points.csv`, `complex_modes.csv`, `sensitivities.csv`,
/// and `transient_spectrum.csv`, those of them that the run has, into the folder `dir`.
///
/// # Errors
/// [`crate::error::Error::Io`] when the folder cannot be made or a file not be written.
pub fn write_csv(dir: &Path, results: &RunResults) -> Result<()> {
    let mut names = FileNames::default();
    for set in &results.modes {
        write_result(dir, &format!("modes_{}.csv", names.next(&set.name)), modes(set).as_bytes())?;
    }
    if let Some(steady) = &results.steady {
        write_result(dir, "contact_points.csv", contact_points(steady).as_bytes())?;
    }
    if let Some(complex) = &results.complex {
        write_result(dir, "complex_modes.csv", complex_modes(complex).as_bytes())?;
    }
    if let Some(sensitivity) = &results.sensitivity {
        write_result(dir, "sensitivities.csv", sensitivities(sensitivity).as_bytes())?;
    }
    if let Some(transient) = &results.transient {
        write_result(dir, "transient_spectrum.csv", spectra(transient).as_bytes())?;
    }
    Ok(())
}

fn modes(set: &NamedModes) -> String {
    let mut table = Table::new(&[
        "mode",
        "frequency [Hz]",
        "moving part",
        "nodal diameters",
        "nodal circles",
        "effective mass x [kg]",
        "effective mass y [kg]",
        "effective mass z [kg]",
        "backward error",
    ]);
    for k in 0..set.modes.len() {
        let name = set.names.get(k).copied().flatten();
        let count = |n: Option<usize>| n.map(|n| n.to_string()).unwrap_or_default();
        let mut row = vec![
            (k + 1).to_string(),
            number(set.modes.frequency_hz(k)),
            set.moving_part.get(k).cloned().flatten().unwrap_or_default(),
            count(name.map(|n| n.nodal_diameters)),
            count(name.map(|n| n.nodal_circles)),
        ];
        row.extend((0..3).map(|axis| set.effective_mass.get(k).map(|m| number(m[axis])).unwrap_or_default()));
        row.push(number(set.modes.backward_errors[k]));
        table.row(&row);
    }
    table.text
}

fn contact_points(steady: &SteadyResult) -> String {
    let mut table = Table::new(&[
        "point",
        "pair",
        "x [m]",
        "y [m]",
        "z [m]",
        "penetration [m]",
        "normal force [N]",
        "friction force 1 [N]",
        "friction force 2 [N]",
        "closed",
    ]);
    for (k, ((pair, [x, y, z]), state)) in steady.points.iter().zip(&steady.state.points).enumerate() {
        let [f1, f2] = state.forces.friction;
        let mut row = vec![(k + 1).to_string(), pair.clone()];
        row.extend([*x, *y, *z, state.penetration, state.forces.normal, f1, f2].map(number));
        row.push(u8::from(state.closed()).to_string());
        table.row(&row);
    }
    table.text
}

fn spectra(transient: &TransientResult) -> String {
    let named: Vec<String> =
        transient.spectra.iter().map(|of| transient.channels[of.channel].heading()).collect();
    let headings: Vec<&str> =
        std::iter::once("frequency [Hz]").chain(named.iter().map(String::as_str)).collect();
    let mut table = Table::new(&headings);
    let Some(first) = transient.spectra.first() else { return table.text };
    for k in 0..first.spectrum.amplitude.len() {
        let values = transient.spectra.iter().map(|of| number(of.spectrum.amplitude[k]));
        let row: Vec<String> =
            std::iter::once(number(first.spectrum.frequency_hz(k))).chain(values).collect();
        table.row(&row);
    }
    table.text
}

fn complex_modes(complex: &ComplexResult) -> String {
    let mut table = Table::new(&[
        "mode",
        "frequency [Hz]",
        "growth rate [1/s]",
        "damping ratio",
        "verdict",
        "growth by structural damping [1/s]",
        "growth by falling friction [1/s]",
        "growth by transverse friction [1/s]",
        "growth by mode coupling [1/s]",
        "backward error",
        "eigenvalue error",
        "condition",
        "real modes that take part",
    ]);
    for (k, mode) in complex.modes.modes.iter().enumerate() {
        let mut row = vec![(k + 1).to_string()];
        row.extend([mode.frequency_hz(), mode.growth_rate(), mode.damping_ratio()].map(number));
        row.push(mode.verdict().word().to_string());
        let budget = &mode.growth;
        let terms = [
            budget.structural_damping,
            budget.falling_friction,
            budget.transverse_friction,
            budget.mode_coupling,
        ];
        row.extend(terms.map(number));
        row.extend([mode.backward_error, mode.eigenvalue_error, mode.condition].map(number));
        row.push(complex.participation.get(k).cloned().unwrap_or_default());
        table.row(&row);
    }
    table.text
}

fn sensitivities(result: &SensitivityResult) -> String {
    let mut table = Table::new(&[
        "mode",
        "frequency [Hz]",
        "parameter",
        "value [SI]",
        "SI unit",
        "d growth rate / dp [1/s per unit]",
        "d frequency / dp [Hz per unit]",
        "error of d lambda / dp [1/s per unit]",
        "growth rate per 1 % [1/s]",
        "frequency per 1 % [Hz]",
        "kink",
    ]);
    for mode in &result.modes {
        for p in &mode.parameters {
            let hz = mode.eigenvalue.im / std::f64::consts::TAU;
            let mut row = vec![(mode.mode + 1).to_string(), number(hz), p.path.clone()];
            row.extend([number(p.value), p.unit.clone()]);
            let figures =
                [p.rate.re, p.frequency_rate(), p.error, p.growth_per_percent(), p.frequency_per_percent()];
            row.extend(figures.map(number));
            row.push(u8::from(p.kink).to_string());
            table.row(&row);
        }
    }
    table.text
}

/// Lines of comma-separated fields.
#[derive(Debug, Default)]
pub(crate) struct Table {
    /// The lines so far, each with its end.
    pub(crate) text: String,
}

impl Table {
    pub(super) fn new(header: &[&str]) -> Self {
        let mut table = Table::default();
        table.row(header);
        table
    }

    /// Adds a line of fields.
    pub(crate) fn row(&mut self, fields: &[impl AsRef<str>]) {
        let quoted: Vec<String> = fields.iter().map(|field| quote(field.as_ref())).collect();
        self.text.push_str(&quoted.join(","));
        self.text.push('\n');
    }
}

/// A field in quotes where it needs them (RFC 4180). Text that a spreadsheet would take for a formula begins with an
/// apostrophe, which makes it text there.
fn quote(field: &str) -> String {
    let formula = field.starts_with(['=', '+', '-', '@', '\t', '\r']) && field.parse::<f64>().is_err();
    let field = if formula { format!("'{field}") } else { field.to_string() };
    if field.contains([',', ';', '"', '\n', '\r', '\t']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field
    }
}

/// The shortest text that reads back as exactly `value`; empty when it is not finite.
pub(super) fn number(value: f64) -> String {
    let magnitude = value.abs();
    match magnitude {
        m if !m.is_finite() => String::new(),
        m if m == 0.0 || (1e-3..1e9).contains(&m) => value.to_string(),
        _ => format!("{value:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;

    #[test]
    fn every_row_has_the_fields_of_its_header_and_reads_back_exactly() {
        let dir = tempfile::tempdir().unwrap();
        let results = sample::rig();
        write_csv(dir.path(), &results).unwrap();
        for name in ["modes_disc.csv", "modes_rig_with_closed_contact.csv", "contact_points.csv"] {
            let text = std::fs::read_to_string(dir.path().join(name)).unwrap();
            let width = text.lines().next().unwrap().split(',').count();
            assert!(
                text.lines().count() > 5 && text.lines().all(|l| l.split(',').count() == width),
                "{name}"
            );
        }
        let text = std::fs::read_to_string(dir.path().join("complex_modes.csv")).unwrap();
        for (line, mode) in text.lines().skip(1).zip(&results.complex.as_ref().unwrap().modes.modes) {
            let fields: Vec<&str> = line.split(',').collect();
            assert_eq!(fields[1].parse::<f64>().unwrap(), mode.frequency_hz());
            assert_eq!(fields[2].parse::<f64>().unwrap(), mode.growth_rate());
            let budget: f64 = fields[5..9].iter().map(|f| f.parse::<f64>().unwrap()).sum();
            assert!((budget - mode.growth_rate()).abs() < 1e-9 * (1.0 + mode.growth_rate().abs()));
        }
    }

    #[test]
    fn names_are_no_formulas() {
        let mut table = Table::new(&["=1+1", "@sum(a)", "\tx", "\rx", "+3 N", "-a", "a=b"]);
        table.row(&["-2.5e-13", "+1", "-", "1 \n2", "=\"a\"", "a;=b", "'=1"]);
        let fields = "'=1+1,'@sum(a),\"'\tx\",\"'\rx\",'+3 N,'-a,a=b\n-2.5e-13,+1,'-,\"1 \n2\",\"'=\"\"a\"\"\",\"a;=b\",'=1\n";
        assert_eq!(table.text, fields);
    }

    #[test]
    fn fields_are_quoted_and_numbers_short() {
        assert_eq!(quote("61 % (0,1), \"x\""), "\"61 % (0,1), \"\"x\"\"\"");
        assert_eq!(number(f64::NAN), "");
        assert_eq!(number(0.1), "0.1");
        assert_eq!(number(-2.5e-13), "-2.5e-13");
    }
}
