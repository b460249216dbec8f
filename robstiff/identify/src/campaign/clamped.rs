//! The rows of a campaign of kind `clamped`.

use std::format;
use std::string::String;
use std::vec::Vec;

use robstiff_robots::Description;
use robstiff_robots::quantity::Dimension;

use super::ClampedRow;
use super::beyond::{Beyond, DISPLACEMENT, FORCE, MOMENT, ROTATION};
use robstiff::JointKind;
use robstiff_robots::table::{Numbers, Record, Table};

/// What is read of axes of one kind: the dimensions of their load and of how far they move by it,
/// and what is more than they come to.
struct Read {
    moves: &'static str,
    dimensions: [Dimension; 2],
    beyond: [Beyond; 2],
}

const TURNING: Read =
    Read { moves: "turns", dimensions: [Dimension::Torque, Dimension::Angle], beyond: [MOMENT, ROTATION] };

const SLIDING: Read =
    Read { moves: "slides", dimensions: [Dimension::Force, Dimension::Length], beyond: [FORCE, DISPLACEMENT] };

fn read_of(kind: JointKind) -> Read {
    match kind {
        JointKind::Revolute => TURNING,
        JointKind::Prismatic => SLIDING,
    }
}

/// Reads the rows; `None` with the problems reported to the table.
///
/// `torque` and `deflection` are a torque and an angle, of an axis that slides a force and a
/// length. A column has one unit, so where axes of both kinds are in one file, those of the
/// kind that it is not of cannot be read from it.
pub fn read(table: &Table<'_>, robot: &Description) -> Option<Vec<ClampedRow>> {
    let column = table.require("axis", Dimension::Number).map(Numbers::whole);
    // Collected before they are judged, so that every row is checked.
    let axes: Vec<Option<usize>> = table.records.iter().map(|record| axis(table, record, column?, robot)).collect();
    let kind_of = |axis: &usize| robot.joints[axis - 1].kind;
    // One axis that turns makes the columns what they are called.
    let slides = axes.iter().all(|axis| axis.as_ref().is_some_and(|axis| kind_of(axis) == JointKind::Prismatic));
    let of_columns = if slides { SLIDING } else { TURNING };
    let [load, moved] = of_columns.dimensions;
    let columns = [table.require("torque", load), table.require("deflection", moved)];
    let [Some(torque), Some(deflection)] = columns else { return None };
    let columns = [torque, deflection];
    let numbers: Vec<Option<[f64; 2]>> = table.records.iter().map(|record| table.all(record, columns)).collect();
    let (axes, numbers) = (every(axes)?, every(numbers)?);
    for (record, axis) in table.records.iter().zip(&axes) {
        let own = read_of(kind_of(axis));
        let strange = (0..2).find(|&k| own.dimensions[k] != of_columns.dimensions[k] && table.has_unit(columns[k]));
        if let Some(k) = strange {
            let message = format!(
                "axis {axis} {}, and a column `{}` with a unit of {} says nothing of it",
                own.moves,
                table.name_of(columns[k]),
                plural(of_columns.dimensions[k])
            );
            let help = "leave the units out of both columns: torques and angles are in Nm and rad then, forces and \
                        lengths in N and m; or put the axes that slide into a file of their own";
            table.report_number(record, columns[k], &message, help);
            return None;
        }
    }
    for kind in [JointKind::Revolute, JointKind::Prismatic] {
        for (k, beyond) in read_of(kind).beyond.iter().enumerate() {
            let rows = table.records.iter().zip(&axes).zip(&numbers).filter(|((_, axis), _)| kind_of(axis) == kind);
            beyond.warn(table, columns[k], rows.map(|((record, _), numbers)| (record.line, numbers[k])));
        }
    }
    let row = |((record, &axis), &[torque, deflection]): ((&Record, &usize), &[f64; 2])| ClampedRow {
        line: record.line,
        axis,
        torque,
        deflection,
    };
    Some(table.records.iter().zip(&axes).zip(&numbers).map(row).collect())
}

fn every<T>(read: Vec<Option<T>>) -> Option<Vec<T>> {
    read.into_iter().collect()
}

/// The axis of a row, from 1; one that the robot does not have is reported.
fn axis(table: &Table<'_>, record: &Record, column: Numbers, robot: &Description) -> Option<usize> {
    let axis = table.number(record, column)?;
    let count = robot.joints.len();
    if axis.fract() != 0.0 || !(1.0..=count as f64).contains(&axis) {
        let message = format!("the robot has no axis {axis}");
        table.report_number(record, column, &message, &format!("axes count from 1 to {count}"));
        return None;
    }
    Some(axis as usize)
}

fn plural(dimension: Dimension) -> String {
    let name = dimension.name();
    format!("{}s", name.strip_prefix("an ").or_else(|| name.strip_prefix("a ")).unwrap_or(name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::Data;
    use crate::campaign::tests::{CAMPAIGN, Folder, ROBOT};

    /// The rows of a robot whose second axis slides, or the problems of its table.
    fn read(table: &str) -> Result<Vec<ClampedRow>, String> {
        let folder = Folder::new(&CAMPAIGN.replace("displacement", "clamped"), table);
        let robot =
            ROBOT.replace("- {a: 500 mm, alpha: 90 deg, compliance: 2e-6}", "- {type: prismatic, compliance: 2e-8}");
        std::fs::write(folder.0.join("robot.yaml"), robot).expect("a temporary file");
        match folder.read() {
            Ok(campaign) => match campaign.data {
                Data::Clamped(rows) => Ok(rows),
                _ => panic!("kind clamped"),
            },
            Err(problems) => Err(std::string::ToString::to_string(&problems)),
        }
    }

    #[test]
    fn axes_that_slide_are_read_in_newtons_and_metres() {
        let alone = read("axis,torque [kN],deflection [um]\n2,0.5,10\n2,-1,-20\n").expect("sliding axes");
        assert_eq!([alone[0].torque, alone[1].torque], [500.0, -1000.0]);
        assert!((alone[0].deflection - 1e-5).abs() < 1e-18);
        let both = read("axis,torque,deflection\n1,100,1e-4\n2,500,1e-5\n").expect("numbers in SI");
        assert_eq!([both[0].torque, both[1].torque], [100.0, 500.0]);
    }

    #[test]
    fn a_unit_that_is_not_of_the_axis_is_refused() {
        let said = read("axis,torque [Nm],deflection [urad]\n1,100,30\n2,100,30\n").expect_err("a length in urad");
        assert!(
            said.contains("axis 2 slides, and a column `torque` with a unit of torques says nothing of it"),
            "{said}"
        );
        assert!(said.contains(":3:3") && said.contains("a file of their own"), "{said}");
        let said = read("axis,torque [Nm],deflection [urad]\n2,100,30\n").expect_err("a force in Nm");
        assert!(said.contains("`Nm` is a torque, a force is expected here"), "{said}");
    }
}
