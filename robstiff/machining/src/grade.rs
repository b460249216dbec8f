//! Tolerance grades of ISO 286-1: how wide the zone of a dimension is.

/// Up to which nominal size a row of [`WIDTHS`] holds (mm).
const SIZES: [f64; 21] = [
    3.0, 6.0, 10.0, 18.0, 30.0, 50.0, 80.0, 120.0, 180.0, 250.0, 315.0, 400.0, 500.0, 630.0, 800.0, 1000.0, 1250.0,
    1600.0, 2000.0, 2500.0, 3150.0,
];

/// The first and the last grade of [`WIDTHS`].
const GRADES: [u32; 2] = [6, 14];

/// How wide the zone is (um), by nominal size and grade: ISO 286-1:2010, table 1.
const WIDTHS: [[f64; 9]; 21] = [
    [6.0, 10.0, 14.0, 25.0, 40.0, 60.0, 100.0, 140.0, 250.0],
    [8.0, 12.0, 18.0, 30.0, 48.0, 75.0, 120.0, 180.0, 300.0],
    [9.0, 15.0, 22.0, 36.0, 58.0, 90.0, 150.0, 220.0, 360.0],
    [11.0, 18.0, 27.0, 43.0, 70.0, 110.0, 180.0, 270.0, 430.0],
    [13.0, 21.0, 33.0, 52.0, 84.0, 130.0, 210.0, 330.0, 520.0],
    [16.0, 25.0, 39.0, 62.0, 100.0, 160.0, 250.0, 390.0, 620.0],
    [19.0, 30.0, 46.0, 74.0, 120.0, 190.0, 300.0, 460.0, 740.0],
    [22.0, 35.0, 54.0, 87.0, 140.0, 220.0, 350.0, 540.0, 870.0],
    [25.0, 40.0, 63.0, 100.0, 160.0, 250.0, 400.0, 630.0, 1000.0],
    [29.0, 46.0, 72.0, 115.0, 185.0, 290.0, 460.0, 720.0, 1150.0],
    [32.0, 52.0, 81.0, 130.0, 210.0, 320.0, 520.0, 810.0, 1300.0],
    [36.0, 57.0, 89.0, 140.0, 230.0, 360.0, 570.0, 890.0, 1400.0],
    [40.0, 63.0, 97.0, 155.0, 250.0, 400.0, 630.0, 970.0, 1550.0],
    [44.0, 70.0, 110.0, 175.0, 280.0, 440.0, 700.0, 1100.0, 1750.0],
    [50.0, 80.0, 125.0, 200.0, 320.0, 500.0, 800.0, 1250.0, 2000.0],
    [56.0, 90.0, 140.0, 230.0, 360.0, 560.0, 900.0, 1400.0, 2300.0],
    [66.0, 105.0, 165.0, 260.0, 420.0, 660.0, 1050.0, 1650.0, 2600.0],
    [78.0, 125.0, 195.0, 310.0, 500.0, 780.0, 1250.0, 1950.0, 3100.0],
    [92.0, 150.0, 230.0, 370.0, 600.0, 920.0, 1500.0, 2300.0, 3700.0],
    [110.0, 175.0, 280.0, 440.0, 700.0, 1100.0, 1750.0, 2800.0, 4400.0],
    [135.0, 210.0, 330.0, 540.0, 860.0, 1350.0, 2100.0, 3300.0, 5400.0],
];

/// How wide the zone of a grade is (m) at a nominal size (m).
///
/// # Errors
/// A grade or a size that the table does not have, with what it has.
pub fn width(grade: u32, size: f64) -> Result<f64, String> {
    let [first, last] = GRADES;
    let Some(column) = grade.checked_sub(first).filter(|_| grade <= last) else {
        return Err(format!("the grades are IT{first} to IT{last}, and IT{grade} is none"));
    };
    // A size on a limit belongs to the smaller ones, up to rounding.
    let row = SIZES.iter().position(|&most| size * 1e3 <= most + 1e-9).filter(|_| size > 0.0);
    let row = row.ok_or("the grades are for sizes above 0, up to 3150 mm")?;
    Ok(WIDTHS[row][column as usize] * 1e-6)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_has_the_width_that_the_standard_prints() {
        for (grade, size, width_um) in
            [(9, 50.0, 62.0), (9, 50.1, 74.0), (7, 25.0, 21.0), (6, 0.5, 6.0), (14, 3150.0, 5400.0)]
        {
            assert_eq!(width(grade, size * 1e-3).unwrap(), width_um * 1e-6, "IT{grade} of {size} mm");
        }
        assert!(width(5, 0.05).unwrap_err().contains("IT6 to IT14"));
        for size in [0.0, -1.0, 3.1501, f64::NAN, f64::INFINITY] {
            assert!(width(9, size).is_err(), "{size}");
        }
    }

    /// The standard computes its table from the geometric mean D of a range of sizes: up to 500 mm from
    /// `i = 0.45 D^(1/3) + 0.001 D` um, above from `I = 0.004 D + 2.1` um, of which IT6 is ten, IT7 16 and so on, and rounds.
    #[test]
    fn the_table_follows_the_formulas_of_the_standard() {
        let factors = [10.0, 16.0, 25.0, 40.0, 64.0, 100.0, 160.0, 250.0, 400.0];
        for (row, widths) in WIDTHS.iter().enumerate() {
            let mean = (if row == 0 { 1.0 } else { SIZES[row - 1] } * SIZES[row]).sqrt();
            let unit = if SIZES[row] <= 500.0 { 0.45 * mean.cbrt() + 0.001 * mean } else { 0.004 * mean + 2.1 };
            for (width, factor) in widths.iter().zip(factors) {
                // Small ones are rounded far.
                let most = if row < 2 { 0.16 } else { 0.06 };
                assert!((width / (factor * unit) - 1.0).abs() < most, "{} mm: {width} {}", SIZES[row], factor * unit);
            }
        }
    }
}
