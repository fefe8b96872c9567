//! Frequency responses: dataset 58 and its binary form, functions at nodal degrees of freedom.

use super::super::records::FunctionRecord;
use super::super::set::Quantity;
use super::units::{UnitFactors, hertz, is_force, labelled, order};
use stridor_base::error::Result;
use stridor_base::universal::ValueLayout;
use stridor_base::universal::record::{columns, e_format, text_line, whole};
use stridor_base::universal::{Binary, Dataset, shown};
use stridor_linalg::c64;

/// Code of a frequency response function.
const FRF: i64 = 4;
/// Code of what is not known.
const UNKNOWN: i64 = 0;
/// Specific data types.
const DISPLACEMENT: i64 = 8;
const REACTION: i64 = 9;
const VELOCITY: i64 = 11;
const ACCELERATION: i64 = 12;
const FORCE: i64 = 13;
const FREQUENCY: i64 = 18;
/// Columns of the record of degrees of freedom: type, number, version, load case; blank, name, node, direction, twice.
const WHO: [usize; 12] = [5, 10, 5, 10, 1, 10, 10, 4, 1, 10, 10, 4];
/// Columns of an axis: type, three exponents, label, unit.
const AXIS: [usize; 8] = [10, 5, 5, 5, 1, 20, 1, 20];

/// What of a response could be read.
pub(super) struct ReadFunction {
    pub record: FunctionRecord,
    /// Whether the file states the units.
    pub stated: bool,
    /// Words on frequencies that are left out.
    pub left_out: Vec<String>,
}

/// Reads dataset 58; what it is, in words, where it is no frequency response of motion over force.
///
/// A unit in the label of an axis says what its numbers are; else they are in `units`, or SI where there are none. Axes of
/// type 0 (unknown) are what their labels and units say, else `quantity`, a motion over a force.
pub(super) fn read(
    dataset: &Dataset<'_>,
    units: Option<UnitFactors>,
    quantity: Option<Quantity>,
) -> Result<std::result::Result<ReadFunction, String>> {
    let [first, second] = [dataset.line(0)?.trim(), dataset.line(1)?.trim()];
    let title = if first == "NONE" || first.is_empty() { second } else { first };
    let who = who(dataset)?;
    let name = format!("{title}, {}/{}", dof(who.response), dof(who.reference));
    let form = ValueLayout::read(dataset)?;
    let response = who.kind == FRF || (who.kind == UNKNOWN && quantity.is_some() && form.complex());
    if !response {
        return Ok(Err(format!("functions of type {}, which are no frequency responses", who.kind)));
    }
    let [abscissa, ordinate, denominator] = [axis(dataset, 7)?, axis(dataset, 8)?, axis(dataset, 9)?];
    let moving = match ordinate.kind {
        DISPLACEMENT => Quantity::Receptance,
        VELOCITY => Quantity::Mobility,
        ACCELERATION => Quantity::Accelerance,
        UNKNOWN => match motion(&ordinate.unit).or_else(|| motion(&ordinate.label)).or(quantity) {
            Some(quantity) => quantity,
            None => {
                return Ok(Err(
                    "responses of an unknown quantity (ordinate of data type 0): `quantity`, as in \
                               quantity = \"accelerance\", says what they are"
                        .into(),
                ));
            }
        },
        kind => return Ok(Err(format!("responses of data type {kind}, which is no motion"))),
    };
    let force = match denominator.kind {
        FORCE | REACTION => true,
        UNKNOWN => {
            let none = |text: &str| text.is_empty() || text == "NONE";
            denominator.label.to_lowercase().contains("force")
                || is_force(&denominator.unit)
                || ordinate.unit.to_lowercase().ends_with("/n")
                || (none(&denominator.label) && none(&denominator.unit))
        }
        _ => false,
    };
    if !force || !matches!(abscissa.kind, UNKNOWN | FREQUENCY) {
        return Ok(Err("responses that are not motion over force over frequency".into()));
    }
    let (Some(excitation), Some(response)) = (direction(who.reference.1), direction(who.response.1)) else {
        return Ok(Err("responses of rotations or moments".into()));
    };
    let over = labelled(&ordinate.unit).or(units.map(|u| u.length));
    let under = labelled(&denominator.unit).or(units.map(|u| u.force));
    let stated = over.is_some() && under.is_some();
    let scale = over.unwrap_or(1.0) / under.unwrap_or(1.0);
    let to_hertz = hertz(&abscissa.unit);
    let numbers = match &dataset.binary {
        Some(binary) => binary_numbers(binary, &form),
        None => text_numbers(dataset, &form)?,
    };
    let stride = form.parts() + usize::from(!form.even);
    let (mut rows, mut left_out) = (Vec::new(), Vec::new());
    let (mut broken, mut first_broken) = (0, None);
    for (k, row) in numbers.chunks_exact(stride).enumerate() {
        let (hz, value) =
            if form.even { (form.first + k as f64 * form.step, row) } else { (row[0], &row[1..]) };
        let hz = to_hertz * hz;
        if row.iter().all(|number| number.is_finite()) {
            rows.push((hz, scale * c64::new(value[0], value.get(1).copied().unwrap_or(0.0))));
        } else {
            broken += 1;
            first_broken.get_or_insert((k, hz));
        }
    }
    if let Some((k, hz)) = first_broken {
        let place = dataset.row_place(11, k * stride);
        let at = if hz.is_finite() { format!(" ({hz} Hz)") } else { String::new() };
        left_out.push(format!(
            "{place}{at}: no finite number: {broken} of {} frequencies left out",
            broken + rows.len()
        ));
    }
    // Measured downwards.
    if rows.len() > 1 && rows.windows(2).all(|pair| pair[0].0 >= pair[1].0) {
        rows.reverse();
    }
    if rows.windows(2).any(|pair| pair[0].0 > pair[1].0) || rows.iter().any(|(hz, _)| *hz < 0.0) {
        return Err(dataset.fault(
            6,
            "frequencies that neither rise nor fall",
            "frequencies of zero or more in their order",
        ));
    }
    // Those of six digits may be alike.
    let all = rows.len();
    let again = rows.windows(2).find(|pair| pair[0].0 == pair[1].0).map(|pair| pair[0].0);
    rows.dedup_by(|later, earlier| later.0 == earlier.0);
    if let Some(hz) = again {
        let (place, count) = (dataset.row_place(6, 0), all - rows.len());
        left_out.push(format!(
            "{place}: {hz} Hz again: {count} of {all} frequencies left out, the first of each is taken"
        ));
    }
    if rows.is_empty() {
        return Err(dataset.fault(6, "no frequency with a finite value", "some"));
    }
    let (frequencies_hz, values) = rows.into_iter().unzip();
    let (excitation, response) = ((who.reference.0, excitation), (who.response.0, response));
    let record = FunctionRecord { name, quantity: moving, excitation, response, frequencies_hz, values };
    Ok(Ok(ReadFunction { record, stated, left_out }))
}

/// The motion that a unit or a label names.
fn motion(text: &str) -> Option<Quantity> {
    let words = text.to_lowercase();
    let named = |parts: [&str; 2]| parts.iter().any(|part| words.contains(part));
    match order(text) {
        Some(0) => Some(Quantity::Receptance),
        Some(1) => Some(Quantity::Mobility),
        Some(2) => Some(Quantity::Accelerance),
        _ if named(["accel", "inertance"]) => Some(Quantity::Accelerance),
        _ if named(["veloc", "mobility"]) => Some(Quantity::Mobility),
        _ if named(["displ", "recept"]) => Some(Quantity::Receptance),
        _ => None,
    }
}

/// Type of a function and its points, with codes of directions.
struct Who {
    kind: i64,
    response: (u64, i64),
    reference: (u64, i64),
}

fn who(dataset: &Dataset<'_>) -> Result<Who> {
    const RECORD: usize = 5;
    let text = dataset.line(RECORD)?;
    let cells = columns(text, &WHO);
    let words: Vec<&str> = text.split_whitespace().collect();
    // In its columns, or between white space.
    let in_columns = [0, 6, 7, 10, 11].map(|k| whole(&cells[k]));
    let all = |found: [Option<i64>; 5]| -> Option<[i64; 5]> {
        let found: Option<Vec<i64>> = found.into_iter().collect();
        found?.try_into().ok()
    };
    let between = || all([0, 5, 6, 8, 9].map(|k| words.get(k).and_then(|word| whole(word))));
    let found = all(in_columns).or_else(between);
    let [kind, node, along, base, driven] = found
        .ok_or_else(|| dataset.fault(RECORD, shown(text), "a type, and twice a name, a node, a direction"))?;
    let label = |node: i64| {
        u64::try_from(node)
            .map_err(|_| dataset.fault(RECORD, format!("node {node}"), "a node of zero or more"))
    };
    Ok(Who { kind, response: (label(node)?, along), reference: (label(base)?, driven) })
}

/// A point and a direction as test engineers write them: `3-y`.
fn dof((node, code): (u64, i64)) -> String {
    let along = ["", "x", "y", "z", "rx", "ry", "rz"].get(code.unsigned_abs() as usize).unwrap_or(&"");
    match code {
        0 => node.to_string(),
        code => format!("{node}{}{along}", if code < 0 { '-' } else { '+' }),
    }
}

/// Quantity along an axis, its label and its unit.
struct AxisRecord {
    kind: i64,
    label: String,
    unit: String,
}

fn axis(dataset: &Dataset<'_>, record: usize) -> Result<AxisRecord> {
    let text = dataset.line(record)?;
    let cells = columns(text, &AXIS);
    let first = text.split_whitespace().next().unwrap_or("");
    let kind = whole(&cells[0]).or(whole(first));
    let kind = kind.ok_or_else(|| dataset.fault(record, shown(&cells[0]), "a specific data type"))?;
    Ok(AxisRecord { kind, label: cells[5].clone(), unit: cells[7].clone() })
}

/// The unit vector of a code: ±1, ±2, ±3; zero where the direction is not stated; `None` for rotations.
fn direction(code: i64) -> Option<[f64; 3]> {
    match code {
        0 => Some([0.0; 3]),
        -3..=3 => {
            let axis = code.unsigned_abs() as usize - 1;
            Some([0, 1, 2].map(|k| if k == axis { code.signum() as f64 } else { 0.0 }))
        }
        _ => None,
    }
}

/// Numbers in lines that are all of one length, but for the last.
fn text_numbers(dataset: &Dataset<'_>, form: &ValueLayout) -> Result<Vec<f64>> {
    const FIRST: usize = 11;
    let wanted = form.count.saturating_mul(form.parts() + usize::from(!form.even));
    let (mut numbers, mut length) = (Vec::new(), None);
    for index in FIRST..dataset.lines.len() {
        let line = dataset.values(index, form.widths())?;
        if line.is_empty() {
            continue;
        }
        if numbers.len() >= wanted {
            let found = format!("{} numbers beyond the {wanted} of the header", line.len());
            return Err(dataset.fault(index, found, "the end of the dataset"));
        }
        let length = *length.get_or_insert(line.len());
        // The last line may be filled up.
        if line.len() > length || (line.len() < length && numbers.len() + line.len() < wanted) {
            let found = format!("{} numbers in a line", line.len());
            return Err(dataset.fault(index, found, format!("{length}, as in the first line of numbers")));
        }
        numbers.extend(line);
    }
    if numbers.len() < wanted || numbers.len() > wanted.saturating_add(5) {
        let last = dataset.lines.len().saturating_sub(1);
        return Err(dataset.fault(last, format!("{} numbers", numbers.len()), format!("{wanted}")));
    }
    numbers.truncate(wanted);
    Ok(numbers)
}

fn binary_numbers(binary: &Binary<'_>, form: &ValueLayout) -> Vec<f64> {
    let [abscissa, value] = binary.sizes;
    let row = [abscissa].into_iter().filter(|size| *size > 0).chain(std::iter::repeat_n(value, form.parts()));
    let row: Vec<usize> = row.collect();
    let (mut at, mut numbers) = (0, Vec::new());
    for size in row.iter().cycle() {
        let Some(bytes) = binary.data.get(at..at + size).filter(|bytes| !bytes.is_empty()) else { break };
        let number = match (<[u8; 8]>::try_from(bytes), <[u8; 4]>::try_from(bytes)) {
            (Ok(b), _) if binary.big_endian => f64::from_be_bytes(b),
            (Ok(b), _) => f64::from_le_bytes(b),
            (_, Ok(b)) if binary.big_endian => f64::from(f32::from_be_bytes(b)),
            (_, Ok(b)) => f64::from(f32::from_le_bytes(b)),
            _ => break,
        };
        numbers.push(number);
        at += size;
    }
    numbers
}

/// A frequency response to write.
#[derive(Debug, Clone)]
pub struct Function<'a> {
    /// Two lines of text: what it is, and how it came about.
    pub title: [&'a str; 2],
    /// Receptance, mobility or accelerance.
    pub quantity: Quantity,
    /// Label of the point that the force acts on, and the code of its direction.
    pub excitation: (u64, i64),
    /// Label of the point whose motion it is, and the code of its direction.
    pub response: (u64, i64),
    /// \[Hz\].
    pub frequencies_hz: &'a [f64],
    /// In the SI unit of the quantity.
    pub values: &'a [c64],
}

/// The lines of text of dataset 58 before its rows of numbers: complex in double precision, uneven frequencies.
fn heading(function: &Function<'_>, rows: usize) -> String {
    let (kind, label, unit) = match function.quantity {
        Quantity::Receptance => (DISPLACEMENT, "Displacement", "m"),
        Quantity::Mobility => (VELOCITY, "Velocity", "m/s"),
        Quantity::Accelerance => (ACCELERATION, "Acceleration", "m/s^2"),
    };
    let mut text = text_line(function.title[0]);
    text += &text_line(function.title[1]);
    text += &text_line("NONE").repeat(3);
    let ((node, along), (base, driven)) = (function.response, function.excitation);
    text += &format!(
        "{FRF:5}{:10}{:5}{:10} {:<10}{node:10}{along:4} {:<10}{base:10}{driven:4}\n",
        0, 0, 0, "NONE", "NONE"
    );
    let zero = e_format(0.0, 13, 5);
    text += &format!("{:10}{:10}{:10}{}\n", 6, rows, 0, zero.repeat(3));
    let axis = |kind: i64, label: &str, unit: &str| {
        format!("{kind:10}{:5}{:5}{:5} {label:<20} {unit:<20}\n", 0, 0, 0)
    };
    text += &axis(FREQUENCY, "Frequency", "Hz");
    text += &axis(kind, label, unit);
    text += &axis(FORCE, "Force", "N");
    text + &axis(0, "NONE", "NONE")
}

/// Dataset 58: complex in double precision, uneven frequencies. It has six digits for a frequency: of those that are alike in
/// them the first is written.
pub(super) fn write(function: &Function<'_>) -> Vec<u8> {
    let row =
        |(hz, value): (&f64, &c64)| (e_format(*hz, 13, 5), [value.re, value.im].map(|v| e_format(v, 20, 12)));
    let mut rows: Vec<_> = function.frequencies_hz.iter().zip(function.values).map(row).collect();
    rows.dedup_by(|later, earlier| later.0 == earlier.0);
    let mut text = String::from("    -1\n    58\n") + &heading(function, rows.len());
    for (hz, [re, im]) in rows {
        text += &format!("{hz}{re}{im}\n");
    }
    (text + "    -1\n").into_bytes()
}

/// Dataset 58b: the same in IEEE 754 numbers of eight bytes, the lowest first; a frequency, a real and an imaginary part each.
pub(super) fn write_binary(function: &Function<'_>) -> Vec<u8> {
    const LOWEST_FIRST: u32 = 1;
    const IEEE_754: u32 = 2;
    let heading = heading(function, function.frequencies_hz.len());
    let (lines, size) = (heading.lines().count(), 3 * size_of::<f64>() * function.values.len());
    let form = format!("{LOWEST_FIRST:6}{IEEE_754:6}{lines:12}{size:12}{:6}{:6}{:12}{:12}", 0, 0, 0, 0);
    let mut bytes = format!("    -1\n    58b{form}\n{heading}").into_bytes();
    for (hz, value) in function.frequencies_hz.iter().zip(function.values) {
        bytes.extend([*hz, value.re, value.im].iter().flat_map(|number| number.to_le_bytes()));
    }
    bytes.extend(b"\n    -1\n");
    bytes
}
