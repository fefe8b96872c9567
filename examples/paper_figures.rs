//! Figures 3, 4 and 5 of Rusli et al. (2020), drawn from the cases in `validation/` beside their READMEs.

use std::error::Error;
use std::path::Path;
use stridor::case::read_case;
use stridor::job::{Histories, Prepared, ResultStage, Selection, analyse};
use stridor::report::chart::{Axis, Chart};
use stridor::report::svg::{Sheet, ink, stroke};
use stridor::results::{ComplexResult, TransientResult};

const SIZE: [f64; 2] = [1080.0, 620.0];
const GROWS: &str = "#d55e00";
const STAYS: &str = "#0072b2";
const INK: &str = "#1b1f24";

/// One half of a figure: a panel for each value of a scalar.
struct Part {
    title: &'static str,
    /// Its path in the case.
    scalar: &'static str,
    /// Its symbol and its unit.
    symbol: [&'static str; 2],
    values: &'static [f64],
    /// How long to look [s].
    duration: f64,
    /// The panels have one scale.
    one_scale: bool,
}

/// x over time for one value, and whether small disturbances grow.
struct Response {
    label: String,
    step: f64,
    x: Vec<f64>,
    grows: bool,
}

fn main() -> Result<(), Box<dyn Error>> {
    const MU: Part = Part {
        title: "",
        scalar: "contact.belt.friction.mu0",
        symbol: ["μ", ""],
        values: &[0.2, 0.4, 0.6],
        duration: 100.0,
        one_scale: true,
    };
    const KN: Part = Part {
        scalar: "contact.belt.normal.stiffness",
        symbol: ["kₙ", " N/m"],
        values: &[0.5, 1.0, 1.25],
        ..MU
    };
    const V: Part = Part {
        title: "(a) sliding velocity, F = 1 N",
        scalar: "contact.belt.sliding_velocity",
        symbol: ["V", " m/s"],
        values: &[0.2, 1.0, 2.0, 5.0],
        duration: 50.0,
        one_scale: true,
    };
    const F: Part = Part {
        title: "(b) pressing force, V = 1 m/s",
        scalar: "force.press.force.1",
        symbol: ["F", " N"],
        values: &[0.2, 0.5, 1.0, 2.0],
        ..V
    };
    let stable = "(a) stable: it rings";
    let unstable = "(b) unstable: it grows";
    let growing =
        |part: Part, values| Part { title: unstable, values, duration: 60.0, one_scale: false, ..part };
    draw("paper-figure-3", [Part { title: stable, ..MU }, growing(MU, &[0.65, 0.7, 0.8])])?;
    draw("paper-figure-4", [Part { title: stable, ..KN }, growing(KN, &[1.4, 1.5, 2.0])])?;
    draw("paper-figure-5", [V, F])?;
    draw("paper-figure-5-belt", [V, F])
}

/// Runs the case of a folder for all values and writes `response.svg` into it.
fn draw(folder: &str, parts: [Part; 2]) -> Result<(), Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation").join(folder);
    let file = folder.join("response.svg");
    let mut sheet = Sheet::new(SIZE[0], SIZE[1]);
    for (half, part) in parts.iter().enumerate() {
        let responses = part.values.iter().map(|value| respond(&folder, part, *value));
        let responses = responses.collect::<Result<Vec<_>, _>>()?;
        let left = 0.5 * SIZE[0] * half as f64;
        sheet.text([left + 74.0, 25.0], part.title, ink(16.0, INK));
        let largest = |r: &Response| r.x.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let all = responses.iter().map(largest).fold(0.0, f64::max);
        let each = (SIZE[1] - 60.0) / responses.len() as f64;
        for (k, response) in responses.iter().enumerate() {
            let scale = 1.1 * if part.one_scale { all } else { largest(response) };
            let top = 34.0 + each * k as f64;
            let area = [left + 74.0, top + 20.0, left + 0.5 * SIZE[0] - 16.0, top + each - 18.0];
            panel(&mut sheet, area, response, scale, k + 1 == responses.len());
        }
    }
    std::fs::write(&file, sheet.finish())?;
    println!("{}", file.display());
    Ok(())
}

/// The case with the scalar set to a value, in time.
fn respond(folder: &Path, part: &Part, value: f64) -> Result<Response, stridor::error::Error> {
    let case = read_case(&folder.join("case.toml"))?
        .with_parameter(part.scalar, value)?
        .with_parameter("transient.duration", part.duration)?;
    let mut histories = Histories::default();
    let mut keep = |stage: ResultStage<'_>| {
        histories.keep(&stage);
        Ok(())
    };
    let results = analyse(&Prepared::new(&case)?, Selection::Only("transient"), &mut keep, &())?;
    let run = results.get::<TransientResult>().expect("the case has a [transient]");
    let history = histories.of("block_displacement");
    let [symbol, unit] = part.symbol;
    Ok(Response {
        label: format!("{symbol} = {value}{unit}"),
        step: run.time_step,
        x: history.expect("the case has a probe `block`").to_vec(),
        grows: results
            .get::<ComplexResult>()
            .is_some_and(|c| c.modes.modes.iter().any(|m| m.growth_rate() > 1e-6)),
    })
}

/// x over time between four edges of the sheet.
fn panel(sheet: &mut Sheet, area: [f64; 4], response: &Response, scale: f64, last: bool) {
    let end = response.step * (response.x.len() - 1) as f64;
    let across = Axis::new(if last { "time [s]" } else { "" }, 0.0..end);
    let mut chart = Chart::new(area, across, Axis::new("x [m]", -scale..scale));
    let every = response.x.len().div_ceil(1000);
    let points = response.x.iter().enumerate().step_by(every).map(|(k, x)| [k as f64 * response.step, *x]);
    let colour = if response.grows { GROWS } else { STAYS };
    chart.line(points, &stroke(colour, 1.0));
    chart.text([0.0, scale], [6.0, -6.0], &response.label, ink(13.0, colour));
    chart.draw(sheet);
}
