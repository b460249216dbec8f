//! What single options give: quantities, axes, forces.

use robstiff::nalgebra::{Unit, Vector3};
use robstiff_machining::grade;
use robstiff_robots::quantity::{self, Dimension};

/// A quantity that an option gives. It carries its unit, since `0.1` is a tenth
/// of a millimetre to who mills and of a metre to SI; ratios have none, and a
/// frequency can be in nothing but Hz.
pub fn with_unit(text: &str, dimension: Dimension) -> Result<f64, String> {
    let value = quantity::parse(text, dimension).map_err(|error| error.to_string())?;
    let bare = text.trim().parse::<f64>().is_ok();
    if bare && value != 0.0 && !matches!(dimension, Dimension::Number | Dimension::Frequency) {
        let example = match dimension {
            Dimension::Length => "mm",
            Dimension::Time => "ms",
            Dimension::Speed => "mm/min",
            Dimension::Angle => "deg",
            Dimension::RotationalSpeed => "rpm",
            _ => dimension.unit(),
        };
        let text = text.trim();
        return Err(format!("`{text}` has no unit; write e.g. `{text} {example}`"));
    }
    Ok(value)
}

/// A quantity above zero, with its unit.
pub fn positive(dimension: Dimension) -> impl Fn(&str) -> Result<f64, String> + Clone {
    move |text| above_zero(with_unit(text, dimension)?, dimension)
}

/// The same of what is read already.
pub fn above_zero(value: f64, dimension: Dimension) -> Result<f64, String> {
    if value > 0.0 { Ok(value) } else { Err(format!("{} above zero is expected here", dimension.name())) }
}

/// A whole number of an option, from and up to some.
pub fn whole<T: TryFrom<u64>>(from: u64, to: u64) -> impl Fn(&str) -> Result<T, String> + Clone {
    move |text| {
        let number = text.trim().parse().ok().filter(|number| (from..=to).contains(number));
        let of_type = number.and_then(|number| T::try_from(number).ok());
        of_type.ok_or_else(|| match to {
            u64::MAX => format!("a whole number from {from} on is expected here"),
            _ => format!("a whole number from {from} to {to} is expected here"),
        })
    }
}

/// A seed.
pub fn seed(text: &str) -> Result<u64, String> {
    whole(0, u64::MAX)(text)
}

/// Several quantities; the unit of the last is that of those without one.
pub fn all_with_unit(parts: &[&str], dimension: Dimension) -> Result<Vec<f64>, String> {
    let unit = parts.last().map_or("", |last| last.trim_start_matches(|c: char| c == ' ' || is_of_number(c)).trim());
    let quantity = |part: &&str| {
        let part = part.trim();
        let is_bare = part.ends_with(|c: char| c.is_ascii_digit() || c == '.');
        let whole = if is_bare && !unit.is_empty() { format!("{part} {unit}") } else { part.to_owned() };
        with_unit(&whole, dimension)
    };
    parts.iter().map(quantity).collect()
}

fn is_of_number(c: char) -> bool {
    c.is_ascii_digit() || ".+-eE".contains(c)
}

/// A length of either sign.
pub fn length(text: &str) -> Result<f64, String> {
    with_unit(text, Dimension::Length)
}

/// How far from its place something may be, either way: a length, or half the zone of a tolerance grade, `IT9 of 50 mm`.
pub fn tolerance(text: &str) -> Result<f64, String> {
    let Some(rest) = text.trim().strip_prefix(['I', 'i']).and_then(|rest| rest.strip_prefix(['T', 't'])) else {
        return positive(Dimension::Length)(text);
    };
    let said = rest.split_once(" of ").and_then(|(grade, size)| Some((grade.trim().parse().ok()?, size)));
    let (grade, size) = said.ok_or("a grade has its nominal size behind it: `IT9 of 50 mm`")?;
    Ok(0.5 * grade::width(grade, length(size)?)?)
}

/// A ratio from 0 to below 1.
pub fn ratio(text: &str) -> Result<f64, String> {
    let ratio = quantity::parse(text, Dimension::Number).map_err(|error| error.to_string())?;
    if (0.0..1.0).contains(&ratio) { Ok(ratio) } else { Err("a ratio from 0 to below 1 is expected here".to_owned()) }
}

/// A margin to limits in percent: less than half of the range at either end.
pub fn margin(text: &str) -> Result<f64, String> {
    let number = text.trim().trim_end_matches('%').trim().parse::<f64>();
    match number {
        Ok(margin) if (0.0..=45.0).contains(&margin) => Ok(margin),
        _ => Err("a percentage from 0 to 45 is expected here, e.g. `5`".to_owned()),
    }
}

/// Three of them.
pub fn three_with_unit(parts: [&str; 3], dimension: Dimension) -> Result<[f64; 3], String> {
    let all = all_with_unit(&parts, dimension)?;
    Ok([all[0], all[1], all[2]])
}

/// An axis of the tool's frame by its name.
pub fn tool_axis(text: &str) -> Result<Unit<Vector3<f64>>, String> {
    let axis = match text.strip_prefix('-').unwrap_or(text) {
        "x" => Vector3::x_axis(),
        "y" => Vector3::y_axis(),
        "z" => Vector3::z_axis(),
        _ => return Err("one of x, y, z, -x, -y, -z".to_owned()),
    };
    Ok(if text.starts_with('-') { -axis } else { axis })
}

/// The name that [`tool_axis`] reads.
pub fn axis_name(axis: &Vector3<f64>) -> String {
    let along = axis.iamax();
    format!("{}{}", if axis[along] < 0.0 { "-" } else { "" }, ["x", "y", "z"][along])
}

/// Reads a direction, of any length, or the name of an axis.
pub fn axis(text: &str) -> Result<Vector3<f64>, String> {
    if let Ok(axis) = tool_axis(text) {
        return Ok(axis.into_inner());
    }
    let parts: Vec<&str> = text.split(',').collect();
    let [x, y, z] = parts[..] else {
        return Err("one of x, y, z, -x, -y, -z or three numbers are expected here, e.g. `0,0,1`".to_owned());
    };
    let number = |part: &str| quantity::parse(part, Dimension::Number).map_err(|error| error.to_string());
    let axis = Vector3::new(number(x)?, number(y)?, number(z)?);
    axis.try_normalize(1e-9).ok_or_else(|| "an axis has a length, e.g. `0,0,1`".to_owned())
}

/// A force in the base frame (N).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Force(pub [f64; 3]);

impl Force {
    /// The force with no moment.
    pub fn wrench(self) -> [f64; 6] {
        let [x, y, z] = self.0;
        [x, y, z, 0.0, 0.0, 0.0]
    }
}

/// Reads its three components.
pub fn force(text: &str) -> Result<Force, String> {
    let parts: Vec<&str> = text.split(',').collect();
    let [x, y, z] = parts[..] else { return Err("three components are expected, e.g. \"0, 0, -400 N\"".to_owned()) };
    three_with_unit([x, y, z], Dimension::Force).map(Force)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_of_options_carry_their_unit() {
        assert_eq!(with_unit("0.1 mm", Dimension::Length), Ok(1e-4));
        assert_eq!(with_unit("0", Dimension::Length), Ok(0.0));
        assert_eq!(with_unit("15", Dimension::Frequency), Ok(15.0));
        assert_eq!(with_unit("0.7", Dimension::Number), Ok(0.7));
        assert_eq!(with_unit(" 0.1", Dimension::Length), Err("`0.1` has no unit; write e.g. `0.1 mm`".to_owned()));
        assert_eq!(with_unit("4", Dimension::Time), Err("`4` has no unit; write e.g. `4 ms`".to_owned()));
    }

    #[test]
    fn whole_numbers_are_within_their_range() {
        assert_eq!(whole::<u16>(1, 200)("200"), Ok(200));
        for wrong in ["0", "201", "-3", "1e2", "1.5", "many"] {
            assert_eq!(whole::<u16>(1, 200)(wrong), Err("a whole number from 1 to 200 is expected here".to_owned()));
        }
        assert_eq!(seed("-1"), Err("a whole number from 0 on is expected here".to_owned()));
    }

    #[test]
    fn three_quantities_have_one_unit_or_their_own() {
        let force = |parts| three_with_unit(parts, Dimension::Force);
        assert_eq!(force(["0.5", " -1e-1 ", "2 kN"]), Ok([500.0, -100.0, 2000.0]));
        assert_eq!(force(["300 N", "0", "-1.5 kN"]), Ok([300.0, 0.0, -1500.0]));
        assert_eq!(force(["0", "0", "0"]), Ok([0.0; 3]));
        assert_eq!(force(["0", "0", "-400"]), Err("`-400` has no unit; write e.g. `-400 N`".to_owned()));
        assert!(force(["1", "2", "3 mm"]).is_err());
        // With a blank before the unit or without.
        assert_eq!(force(["150", "-200", "300N"]), Ok([150.0, -200.0, 300.0]));
        assert_eq!(all_with_unit(&["12", " 4ms"], Dimension::Time), Ok(vec![0.012, 0.004]));
        assert_eq!(all_with_unit(&["0.2", "5"], Dimension::Frequency), Ok(vec![0.2, 5.0]));
    }

    #[test]
    fn a_force_has_three_components() {
        assert_eq!(force("0, 0, -0.4 kN"), Ok(Force([0.0, 0.0, -400.0])));
        assert!(force("400 N").unwrap_err().contains("three components"));
        assert!(force("0,0,4 mm").unwrap_err().contains("`mm` is a length"));
    }
}
