//! Figures 3, 4 and 5 of Rusli et al. (2020), drawn from the cases in `validation/` beside their READMEs.

use plotters::prelude::*;
use std::error::Error;
use std::path::Path;
use stridor::case::read_case;
use stridor::job::{Histories, Prepared, ResultStage, Selection, analyse};
use stridor::results::{ComplexResult, TransientResult};

/// Room for the words below the lowest panel, beyond the numbers [px].
const WORDS: u32 = 26;
const FONT: &str = "system-ui, 'Segoe UI', Helvetica, Arial, sans-serif";
const SIZE: (u32, u32) = (1080, 620);
const GROWS: RGBColor = RGBColor(213, 94, 0);
const STAYS: RGBColor = RGBColor(0, 114, 178);
const INK: RGBColor = RGBColor(27, 31, 36);
const MUTED: RGBColor = RGBColor(91, 101, 112);

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
    let sheet = SVGBackend::new(&file, SIZE).into_drawing_area();
    sheet.fill(&WHITE)?;
    for (half, part) in sheet.split_evenly((1, 2)).iter().zip(&parts) {
        let responses = part.values.iter().map(|value| respond(&folder, part, *value));
        let responses = responses.collect::<Result<Vec<_>, _>>()?;
        let (title, below) = half.split_vertically(34);
        title.draw_text(part.title, &text(16.0, INK), (74, 10))?;
        let largest = |r: &Response| r.x.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let all = responses.iter().map(largest).fold(0.0, f64::max);
        // The last one has the words below it.
        let each = (below.dim_in_pixel().1 - WORDS) / responses.len() as u32;
        let ends: Vec<u32> = (1..responses.len() as u32).map(|k| k * each).collect();
        let areas = below.split_by_breakpoints(Vec::<u32>::new(), ends);
        for (k, (area, response)) in areas.iter().zip(&responses).enumerate() {
            let scale = if part.one_scale { all } else { largest(response) };
            panel(area, response, 1.1 * scale, k + 1 == responses.len())?;
        }
    }
    sheet.present()?;
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

fn panel(
    area: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>,
    response: &Response,
    scale: f64,
    last: bool,
) -> Result<(), Box<dyn Error>> {
    let end = response.step * (response.x.len() - 1) as f64;
    let mut chart = ChartBuilder::on(area)
        .margin_left(14)
        .margin_right(16)
        .margin_top(20)
        .x_label_area_size(if last { 18 + WORDS } else { 18 })
        .y_label_area_size(60)
        .build_cartesian_2d(0.0..end, -scale..scale)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(RGBColor(230, 233, 237))
        .axis_style(MUTED)
        .label_style(text(12.0, INK))
        .x_desc(if last { "time [s]" } else { "" })
        .y_desc("x [m]")
        .x_labels(6)
        .y_labels(6)
        .x_label_formatter(&|t| format!("{t:.0}"))
        .y_label_formatter(&|x| if scale < 0.5 { format!("{x:.2}") } else { format!("{x}") })
        .draw()?;
    let every = response.x.len().div_ceil(1000);
    let points = response.x.iter().enumerate().step_by(every).map(|(k, x)| (k as f64 * response.step, *x));
    let colour = if response.grows { GROWS } else { STAYS };
    chart.draw_series([PathElement::new(points.collect::<Vec<_>>(), colour.stroke_width(1))])?;
    area.draw_text(&response.label, &text(13.0, colour), (80, 3))?;
    Ok(())
}

fn text(pixels: f64, colour: RGBColor) -> TextStyle<'static> {
    (FONT, 1.24 * pixels).into_font().color(&colour)
}
