//! Mode shapes: dataset 55, data at nodes.

use super::super::records::ModeRecord;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use stridor_base::error::Result;
use stridor_base::universal::Dataset;
use stridor_base::universal::record::{e_format, text_line};
use stridor_linalg::c64;

/// Codes of the analysis: normal modes, complex modes of first and second order.
const NORMAL: i64 = 2;
const COMPLEX: [i64; 2] = [3, 7];
/// Codes of what a node has: three or six motions.
const VECTORS: [(i64, i64); 2] = [(2, 3), (3, 6)];
/// Lines before the analysis: five of text, one of codes.
const CODES: usize = 5;

/// Reads dataset 55; what it is, in words, where it is no mode.
///
/// A complex eigenvalue λ \[rad/s\] gives f = |λ|/2π and ζ = −Re λ/|λ|. Rotations are left out.
pub(super) fn read(dataset: &Dataset<'_>) -> Result<std::result::Result<ModeRecord, String>> {
    let [_, analysis, character, _, data, values] = dataset.wholes(CODES, [10; 6])?;
    if analysis != NORMAL && !COMPLEX.contains(&analysis) {
        return Ok(Err(format!("data of analysis type {analysis}, which are no modes")));
    }
    if !VECTORS.contains(&(character, values)) {
        let words =
            format!("data of characteristic {character} with {values} values a node, which are no motions");
        return Ok(Err(words));
    }
    let parts = match data {
        2 => 1,
        5 => 2,
        _ => return Err(dataset.fault(CODES, format!("data type {data}"), "2 (real) or 5 (complex)")),
    };
    let [integers, reals] = dataset.wholes(CODES + 1, [10, 10]).or_else(|_| {
        let all = dataset.numbers(CODES + 1, &[10])?;
        Ok(<[i64; 2]>::try_from(all.iter().take(2).map(|v| *v as i64).collect::<Vec<_>>()).unwrap_or([0; 2]))
    })?;
    if !(1..=10).contains(&integers) || !(1..=12).contains(&reals) {
        let found = format!("{integers} whole and {reals} real parameters");
        return Err(dataset.fault(CODES + 1, found, "1 to 10, and 1 to 12"));
    }
    let begin = CODES + 1 + (2 + integers as usize).div_ceil(8);
    let own = dataset.numbers(begin, &[13])?;
    let at = |k: usize| own.get(k).copied().unwrap_or(0.0);
    let (frequency_hz, damping) = if analysis == NORMAL {
        // Viscous, or half of the hysteretic one.
        (at(0), if at(2) != 0.0 { at(2) } else { 0.5 * at(3) })
    } else {
        let size = at(0).hypot(at(1));
        (size / TAU, if size > 0.0 { -at(0) / size } else { 0.0 })
    };
    if frequency_hz < 0.0 {
        return Err(dataset.fault(begin, format!("{frequency_hz} Hz"), "a frequency of zero or more"));
    }
    let mut shape = BTreeMap::new();
    let mut index = begin + (reals as usize).div_ceil(6);
    let wanted = values as usize * parts;
    while index < dataset.lines.len() {
        if dataset.line(index)?.trim().is_empty() {
            index += 1;
            continue;
        }
        let [label] = dataset.wholes(index, [10])?;
        let label = u64::try_from(label)
            .map_err(|_| dataset.fault(index, format!("node {label}"), "a node of zero or more"))?;
        let mut numbers = Vec::new();
        while numbers.len() < wanted {
            index += 1;
            let more = dataset.numbers(index, &[13])?;
            if more.is_empty() {
                return Err(dataset.fault(
                    index,
                    "an empty line",
                    format!("{wanted} numbers of node {label}"),
                ));
            }
            numbers.extend(more);
        }
        if numbers.len() > wanted {
            let found = format!("{} numbers of node {label}", numbers.len());
            return Err(dataset.fault(index, found, format!("{wanted}")));
        }
        let along = |axis: usize| match parts {
            1 => c64::new(numbers[axis], 0.0),
            _ => c64::new(numbers[2 * axis], numbers[2 * axis + 1]),
        };
        let motion = [0, 1, 2].map(along);
        if shape.insert(label, motion).is_some_and(|before| before != motion) {
            return Err(dataset.fault(
                index,
                format!("node {label} again, moving otherwise"),
                "each node once",
            ));
        }
        index += 1;
    }
    let damping_ratio = Some(damping).filter(|ratio| *ratio != 0.0);
    Ok(Ok(ModeRecord { frequency_hz, damping_ratio, deviation: None, shape }))
}

/// A real mode to write: number, frequency \[Hz\], modal mass \[kg\], ζ, and the motion of each node by label.
pub struct RealShape<'a> {
    /// Counts from 1.
    pub number: usize,
    /// f \[Hz\].
    pub frequency_hz: f64,
    /// φᵀMφ in the scale of the motion \[kg\].
    pub modal_mass: f64,
    /// ζ; zero where it is not known.
    pub damping_ratio: f64,
    /// Label and ux, uy, uz of each node.
    pub motion: Box<dyn Iterator<Item = (u64, [f64; 3])> + 'a>,
}

/// Dataset 55 of a real mode: normal mode, displacement, three motions a node.
pub(super) fn write(title: &str, mode: RealShape<'_>) -> String {
    let number = |v: f64| e_format(v, 13, 5);
    let mut text = String::from("    -1\n    55\n");
    text += &text_line(title);
    text += &text_line(&format!("Mode {}, {:.4} Hz", mode.number, mode.frequency_hz));
    text += &text_line("NONE").repeat(3);
    text += &format!("{:10}{NORMAL:10}{:10}{:10}{:10}{:10}\n", 1, 2, 8, 2, 3);
    text += &format!("{:10}{:10}{:10}{:10}\n", 2, 4, 1, mode.number);
    let own = [mode.frequency_hz, mode.modal_mass, mode.damping_ratio, 0.0].map(number);
    text += &(own.concat() + "\n");
    for (label, motion) in mode.motion {
        text += &format!("{label:10}\n{}\n", motion.map(number).concat());
    }
    text + "    -1\n"
}
