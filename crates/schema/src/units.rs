//! Quantities with units: `"1 mm"`, `"10 MN/m"`, `"210 GPa"` → SI values, with their dimension checked.

use std::f64::consts::TAU;

/// A dimension as powers of (kg, m, s, turn). Angles have none; turns are counted, so that a frequency \[Hz\] and a rate \[1/s\],
/// which differ by 2π where something turns, are not taken for one another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dimension {
    powers: Powers,
    /// Its SI unit; empty for a pure number.
    pub symbol: &'static str,
    /// Name of the dimension, with an example.
    pub name: &'static str,
}

/// Of kg, m, s and turns.
type Powers = [i32; 4];

const fn dimension(powers: Powers, symbol: &'static str, name: &'static str) -> Dimension {
    Dimension { powers, symbol, name }
}

/// A pure number.
pub const NUMBER: Dimension = dimension([0, 0, 0, 0], "", "a number");
/// Radians.
pub const ANGLE: Dimension = dimension([0, 0, 0, 0], "rad", "an angle such as \"4 deg\"");
/// Metres.
pub const LENGTH: Dimension = dimension([0, 1, 0, 0], "m", "a length such as \"1 mm\"");
/// Square metres.
pub const AREA: Dimension = dimension([0, 2, 0, 0], "m^2", "an area such as \"20 mm^2\"");
/// Second moments of area.
pub const AREA_MOMENT: Dimension =
    dimension([0, 4, 0, 0], "m^4", "a second moment of area such as \"200 mm^4\"");
/// Hertz.
pub const FREQUENCY: Dimension = dimension([0, 0, -1, 1], "Hz", "a frequency such as \"6 kHz\"");
/// Per second.
pub const RATE: Dimension = dimension([0, 0, -1, 0], "1/s", "a rate such as \"5 1/s\"");
/// Radians per second; turns per minute are taken, too.
pub const ANGULAR_VELOCITY: Dimension =
    dimension([0, 0, -1, 0], "rad/s", "an angular velocity such as \"600 rpm\" or \"62.8 rad/s\"");
/// Seconds.
pub const TIME: Dimension = dimension([0, 0, 1, 0], "s", "a time such as \"1 us\"");
/// Kilograms.
pub const MASS: Dimension = dimension([1, 0, 0, 0], "kg", "a mass such as \"5 g\"");
/// Moments of inertia.
pub const INERTIA: Dimension = dimension([1, 2, 0, 0], "kg m^2", "a moment of inertia such as \"2 kg*mm^2\"");
/// Metres per second.
pub const VELOCITY: Dimension = dimension([0, 1, -1, 0], "m/s", "a velocity such as \"0.1 m/s\"");
/// Inverse velocity.
pub const INVERSE_VELOCITY: Dimension =
    dimension([0, -1, 1, 0], "s/m", "an inverse velocity such as \"5 s/m\"");
/// Kilograms per cubic metre.
pub const DENSITY: Dimension = dimension([1, -3, 0, 0], "kg/m^3", "a density such as \"7850 kg/m^3\"");
/// Pascals.
pub const PRESSURE: Dimension = dimension([1, -1, -2, 0], "Pa", "a modulus such as \"210 GPa\"");
/// Newtons.
pub const FORCE: Dimension = dimension([1, 1, -2, 0], "N", "a force such as \"20 N\"");
/// Newtons per metre.
pub const STIFFNESS: Dimension = dimension([1, 0, -2, 0], "N/m", "a stiffness such as \"10 MN/m\"");
/// Newton metres per radian.
pub const ROTATIONAL_STIFFNESS: Dimension =
    dimension([1, 2, -2, 0], "N m", "a rotational stiffness such as \"10 N*m\"");
/// Newton seconds per metre.
pub const DASHPOT: Dimension = dimension([1, 0, -1, 0], "N s/m", "a damping constant such as \"5 N*s/m\"");
/// Newton metre seconds per radian.
pub const ROTATIONAL_DASHPOT: Dimension =
    dimension([1, 2, -1, 0], "N m s", "a rotational damping constant such as \"0.1 N*m*s\"");

impl Dimension {
    /// The same quantity per metre to the power `n` of contact length or area, or times metres when `n` < 0.
    pub const fn per_metre(self, n: i32, symbol: &'static str, name: &'static str) -> Dimension {
        let [mass, length, time, turns] = self.powers;
        Dimension { powers: [mass, length - n, time, turns], symbol, name }
    }
}

/// The dimension of a quantity whose SI unit is `symbol`; a pure number when the symbol is none.
pub fn dimension_of(symbol: &'static str) -> Dimension {
    let powers = parse_unit(symbol).map_or([0; 4], |unit| unit.powers);
    Dimension { powers, symbol, name: "a value in the unit of the parameter" }
}

/// Reads `"1.5 mm"` as SI in the expected dimension; the error states what was found instead.
pub fn parse_quantity(text: &str, expected: Dimension) -> Result<f64, String> {
    let (value, unit, powers) = parse_any(text)?;
    if powers == expected.powers {
        return Ok(value);
    }
    if unit == PER_MINUTE && expected.symbol == ANGULAR_VELOCITY.symbol {
        return Ok(TAU * value);
    }
    let text = text.trim();
    Err(match unit {
        "" => format!("\"{text}\", a number without a unit (in SI, write {text} without quotation marks)"),
        _ => format!("\"{text}\", whose unit \"{unit}\" is of another dimension"),
    })
}

/// The unit of turns per minute.
const PER_MINUTE: &str = "rpm";

/// Reads the value of a scalar that is not known yet as SI: turns per minute are an angular velocity.
pub(super) fn parse_of_any_scalar(text: &str) -> Result<f64, String> {
    let (value, unit, _) = parse_any(text)?;
    Ok(if unit == PER_MINUTE { TAU * value } else { value })
}

/// [`parse_quantity`] of a value of another scalar, which was read before that was known: turns per minute are no frequency there.
pub fn parse_of_scalar(text: &str, expected: Dimension) -> Result<f64, String> {
    let (_, unit, powers) = parse_any(text)?;
    match unit == PER_MINUTE && powers == expected.powers {
        true => Err(format!("\"{}\", an angular velocity", text.trim())),
        false => parse_quantity(text, expected),
    }
}

/// Reads `"1.5 mm"` as SI, with its unit and the powers of that.
fn parse_any(text: &str) -> Result<(f64, &str, Powers), String> {
    let text = text.trim();
    let bytes = text.as_bytes();
    let exponent = |i: usize| {
        matches!(bytes[i], b'e' | b'E')
            && bytes.get(i + 1).is_some_and(|next| next.is_ascii_digit() || b"+-".contains(next))
    };
    let of_number = |i: usize| bytes[i].is_ascii_digit() || b".+-".contains(&bytes[i]) || exponent(i);
    let split = (0..bytes.len()).find(|i| !of_number(*i)).unwrap_or(bytes.len());
    let number = &text[..split];
    let plain: f64 = number.parse().map_err(|_| format!("\"{text}\", which does not begin with a number"))?;
    let unit = text[split..].trim();
    let found = parse_unit(unit).ok_or_else(|| format!("\"{text}\", whose unit \"{unit}\" is not known"))?;
    Ok((found.in_si(number).unwrap_or(plain), unit, found.powers))
}

/// A unit in SI: 10^tens · times / over.
#[derive(Debug, Clone, Copy)]
struct Unit {
    /// Power of ten.
    tens: i32,
    /// Factor that is no power of ten: π/180.
    times: f64,
    /// Divisor: 60.
    over: f64,
    powers: Powers,
}

impl Unit {
    /// The decimal `number` of the unit. The power of ten goes into the exponent of its text, so that the value of a unit that
    /// is nothing else is the double nearest to it: 10 µs are 1e-5 s, which 10 · 1e-6 is not.
    fn in_si(&self, number: &str) -> Option<f64> {
        let (digits, exponent) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
        let exponent = exponent.parse::<i64>().ok()?.saturating_add(i64::from(self.tens));
        let value: f64 = format!("{digits}e{exponent}").parse().ok()?;
        Some(value * self.times / self.over)
    }
}

/// A unit such as `MN/m^2` or `1/s`; what follows each `/` divides.
fn parse_unit(text: &str) -> Option<Unit> {
    let mut unit = Unit { tens: 0, times: 1.0, over: 1.0, powers: [0; 4] };
    let one_over = text.strip_prefix('1').filter(|rest| rest.trim_start().starts_with('/'));
    for (k, side) in one_over.unwrap_or(text).split('/').enumerate() {
        for token in side.split(['*', '·', ' ']).map(str::trim).filter(|t| !t.is_empty()) {
            let (symbol, power) = split_power(token)?;
            let symbol = symbol_in_si(symbol)?;
            let (sign, [times, over]) = match k {
                0 => (1, [symbol.times, symbol.over]),
                _ => (-1, [symbol.over, symbol.times]),
            };
            unit.tens += sign * power * symbol.tens;
            unit.times *= times.powi(power);
            unit.over *= over.powi(power);
            for (sum, exponent) in unit.powers.iter_mut().zip(symbol.powers) {
                *sum += sign * power * exponent;
            }
        }
    }
    Some(unit)
}

/// `mm^3`, `mm3` or `mm³` → (`mm`, 3).
fn split_power(token: &str) -> Option<(&str, i32)> {
    for (superscript, power) in [('²', 2), ('³', 3), ('⁴', 4)] {
        if let Some(symbol) = token.strip_suffix(superscript) {
            return Some((symbol, power));
        }
    }
    let symbol = token.trim_end_matches(|c: char| c.is_ascii_digit());
    let digits = &token[symbol.len()..];
    let power = if digits.is_empty() { 1 } else { digits.parse().ok().filter(|p| *p <= 12)? };
    Some((symbol.strip_suffix('^').unwrap_or(symbol), power))
}

/// One symbol with its prefix in SI.
fn symbol_in_si(symbol: &str) -> Option<Unit> {
    const DEGREE: f64 = std::f64::consts::PI / 180.0;
    const UNITS: [(&str, i32, f64, f64, Powers); 12] = [
        ("kg", 0, 1.0, 1.0, [1, 0, 0, 0]),
        ("deg", 0, DEGREE, 1.0, [0; 4]),
        ("°", 0, DEGREE, 1.0, [0; 4]),
        ("rad", 0, 1.0, 1.0, [0; 4]),
        ("rpm", 0, 1.0, 60.0, [0, 0, -1, 1]),
        ("Hz", 0, 1.0, 1.0, [0, 0, -1, 1]),
        ("Pa", 0, 1.0, 1.0, [1, -1, -2, 0]),
        ("N", 0, 1.0, 1.0, [1, 1, -2, 0]),
        ("m", 0, 1.0, 1.0, [0, 1, 0, 0]),
        ("s", 0, 1.0, 1.0, [0, 0, 1, 0]),
        ("g", -3, 1.0, 1.0, [1, 0, 0, 0]),
        ("%", -2, 1.0, 1.0, [0; 4]),
    ];
    const PREFIXES: [(&str, i32); 8] =
        [("G", 9), ("M", 6), ("k", 3), ("c", -2), ("m", -3), ("u", -6), ("µ", -6), ("n", -9)];
    let plain = |s: &str| {
        let (_, tens, times, over, powers) = *UNITS.iter().find(|(name, ..)| *name == s)?;
        Some(Unit { tens, times, over, powers })
    };
    plain(symbol).or_else(|| {
        PREFIXES.iter().find_map(|(prefix, tens)| {
            let unit = plain(symbol.strip_prefix(prefix)?)?;
            Some(Unit { tens: unit.tens + tens, ..unit })
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use stridor_base::bounds::{Origin::*, within};

    #[test]
    fn units_become_si() {
        let close = |text: &str, dimension, expected: f64| {
            let got = parse_quantity(text, dimension).unwrap();
            assert!(
                within((got - expected).abs(), 1e-14 * expected.abs(), RoundOff),
                "{text}: {got} {expected}"
            );
        };
        close("1 mm", LENGTH, 1e-3);
        close("210 GPa", PRESSURE, 210e9);
        close("1e1 MN/m", STIFFNESS, 1e7);
        close("2.5e-3 kN", FORCE, 2.5);
        close("180 deg", ANGLE, std::f64::consts::PI);
        close("7.85 g/cm^3", DENSITY, 7850.0);
        close("3 kHz", FREQUENCY, 3000.0);
        close("5 N*s/m", DASHPOT, 5.0);
        close("12 mm⁴", AREA_MOMENT, 12e-12);
        close("0.5", NUMBER, 0.5);
        close("0.2 %", NUMBER, 2e-3);
        close("1e-1%", NUMBER, 1e-3);
        close("4°", ANGLE, std::f64::consts::PI / 45.0);
        close("5 1/s", RATE, 5.0);
        close("5/ms", RATE, 5e3);
        close("-2e3 rad/s", RATE, -2e3);
        close("1200 rpm", FREQUENCY, 20.0);
        close("30 rpm", ANGULAR_VELOCITY, std::f64::consts::PI);
        close("-30 rpm", dimension_of("rad/s"), -std::f64::consts::PI);
        close("2 rad/s", ANGULAR_VELOCITY, 2.0);
        close("5 s/m", INVERSE_VELOCITY, 5.0);
        close("1 GN/m^2", STIFFNESS.per_metre(1, "N/m^2", "a stiffness per length"), 1e9);
    }

    #[test]
    fn a_value_in_any_unit_is_the_nearest_double() {
        let exact = |text: &str, dimension, expected: f64| {
            let got = parse_quantity(text, dimension).unwrap();
            assert!(got.to_bits() == expected.to_bits(), "{text}: {got:e}, not {expected:e}");
        };
        let numbers = ["10", "3", "1.1", "7e-1", "0.3", "-2.5E+3", "+4", ".6", "5."];
        let lengths = [
            ("nm", -9),
            ("um", -6),
            ("µm", -6),
            ("mm", -3),
            ("cm", -2),
            ("m", 0),
            ("km", 3),
            ("Mm", 6),
            ("Gm", 9),
        ];
        for number in numbers {
            let shifted = |tens: i32| -> f64 {
                let (digits, exponent) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
                format!("{digits}e{}", exponent.parse::<i32>().unwrap() + tens).parse().unwrap()
            };
            for (unit, tens) in lengths {
                exact(&format!("{number} {unit}"), LENGTH, shifted(tens));
                exact(&format!("{number} {unit}^2"), AREA, shifted(2 * tens));
                exact(&format!("{number} s/{unit}"), INVERSE_VELOCITY, shifted(-tens));
                let prefix = unit.strip_suffix('m').unwrap();
                exact(&format!("{number} {prefix}s"), TIME, shifted(tens));
            }
            exact(&format!("{number} g/cm^3"), DENSITY, shifted(3));
            exact(&format!("{number} GPa"), PRESSURE, shifted(9));
            exact(&format!("{number} MN/m"), STIFFNESS, shifted(6));
            exact(&format!("{number} kN/mm"), STIFFNESS, shifted(6));
            exact(&format!("{number} g"), MASS, shifted(-3));
            exact(&format!("{number} kg*mm^2"), INERTIA, shifted(-6));
            exact(&format!("{number} %"), NUMBER, shifted(-2));
        }
        exact("10 us", TIME, 1e-5);
        exact("1200 rpm", FREQUENCY, 20.0);
        exact("1 rpm", FREQUENCY, 1.0 / 60.0);
        exact("180 deg", ANGLE, std::f64::consts::PI);
        exact("1e-400 m", LENGTH, 0.0);
        exact("1e320 nm", LENGTH, f64::INFINITY);
    }

    #[test]
    fn other_dimensions_and_unknown_units_are_refused() {
        assert!(parse_quantity("1 kg", LENGTH).unwrap_err().contains("dimension"));
        assert!(parse_quantity("1 furlong", LENGTH).unwrap_err().contains("furlong"));
        assert!(parse_quantity("mm", LENGTH).unwrap_err().contains("number"));
        assert!(parse_quantity("", LENGTH).is_err());
        // 2π lies between them.
        assert!(parse_quantity("20 Hz", RATE).unwrap_err().contains("dimension"));
        assert!(parse_quantity("20 rad/s", FREQUENCY).unwrap_err().contains("dimension"));
        assert!(parse_quantity("20 Hz", ANGULAR_VELOCITY).unwrap_err().contains("dimension"));
        // Values of a scalar that is known later only are read as what they are taken for then.
        for (text, dimension) in
            [("30 rpm", ANGULAR_VELOCITY), ("2 rad/s", ANGULAR_VELOCITY), ("5 Hz", FREQUENCY)]
        {
            assert_eq!(parse_of_any_scalar(text), parse_of_scalar(text, dimension));
        }
        assert!(parse_of_scalar("30 rpm", FREQUENCY).unwrap_err().contains("angular velocity"));
        assert!(parse_quantity("20 1", NUMBER).is_err() && parse_quantity("20 1 s", TIME).is_err());
        assert!(parse_quantity("1 m^99999999999", LENGTH).is_err());
    }
}
