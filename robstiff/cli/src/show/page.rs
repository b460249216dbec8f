//! A robot in one pose, for people: lengths in mm, displacements in um, angles
//! in degrees.

use std::fmt::Write as _;

use robstiff::analysis::Stiffness;
use robstiff::nalgebra::{Dim, Matrix, RawStorage};
use robstiff_robots::words::count;
use robstiff_robots::{Description, Joint, JointKind};

use super::pose::{Direction, Shown};
use crate::effect;
use crate::text::{Table, capital, decimals, significant};

const AXES: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

/// Everything that is shown, one section after the other.
pub fn page(robot: &Description, shown: &Shown) -> String {
    let mut page = robot.name.clone();
    if !robot.description.is_empty() {
        page += &format!(": {}", robot.description.trim());
    }
    page.push('\n');
    if !robot.source.is_empty() {
        page += &format!("source: {}\n", robot.source.split_whitespace().collect::<Vec<_>>().join(" "));
    }
    chain(&mut page, robot);
    pose(&mut page, robot, shown);
    let rows = |heading: &str| Table::new(1, std::iter::once(heading).chain(AXES));
    section(&mut page, "Jacobian of the tool centre point (m and rad per unit of each joint)");
    let heads = (1..=robot.joints.len()).map(|k| format!("q{k}"));
    page += &matrix(Table::new(1, std::iter::once(String::new()).chain(heads)), &AXES, &shown.jacobian, 1.0);
    if shown.compliance.iter().all(|&entry| entry == 0.0) {
        section(&mut page, "Compliance H_x: the description gives none, the robot is rigid");
        return page;
    }
    section(&mut page, "Compliance H_x (um and urad per N and Nm)");
    if let Some(of) = effect::unloaded(robot) {
        page += &format!("and what comes of it, {of} (`robstiff map` takes a force)\n");
    }
    page += &matrix(rows(""), &AXES, &shown.compliance, 1e6);
    stiffness(&mut page, robot, shown, rows(""));
    translation(&mut page, shown);
    shares(&mut page, shown);
    page
}

fn section(page: &mut String, title: &str) {
    page.push('\n');
    page.push_str(title);
    page.push('\n');
}

fn chain(page: &mut String, robot: &Description) {
    let convention = robot.convention.word();
    section(page, &format!("Chain ({convention} Denavit-Hartenberg; mm and deg)"));
    let head = ["joint", "theta", "d", "a", "alpha", "limits", "compliance", "stiffness", ""];
    let mut table = Table::new(1, head);
    for (number, joint) in (1..).zip(&robot.joints) {
        let (mut theta, mut d) = (degrees(joint.theta), millimetres(joint.d));
        let moved = match joint.kind {
            JointKind::Revolute => &mut theta,
            JointKind::Prismatic => &mut d,
        };
        *moved = if moved == "0" { format!("q{number}") } else { format!("{moved} + q{number}") };
        let mut cells = vec![number.to_string(), theta, d, millimetres(joint.a), degrees(joint.alpha), limits(joint)];
        cells.extend(elasticity(joint));
        table.row(cells);
    }
    page.push_str(&table.to_string());
    for (number, joint) in (1..).zip(&robot.joints).filter(|(_, joint)| joint.compliance.len() > 1) {
        let parts: Vec<String> =
            joint.compliance.iter().map(|part| format!("{} {}", part.name, significant(part.value, 4))).collect();
        let _ = writeln!(page, "  the compliance of joint {number} is {}", parts.join(" + "));
    }
    for (name, placement) in [("base", &robot.base), ("tool", &robot.tool)] {
        if *placement != Default::default() {
            let (xyz, rpy) = (placement.xyz.map(millimetres).join(", "), placement.rpy.map(degrees).join(", "));
            let _ = writeln!(page, "  {name}: xyz {xyz} mm, roll pitch yaw {rpy} deg");
        }
    }
    for effect in &robot.effects {
        let numbers: Vec<String> = effect::parameters(effect)
            .into_iter()
            .map(|(name, value, unit)| format!("{name} {} {unit}", significant(value, 4)).trim_end().to_owned())
            .collect();
        let _ = writeln!(page, "  with {effect}: {}", numbers.join(", "));
        let _ = writeln!(page, "    {}. {}", capital(&effect::words(effect)), effect.explanation());
    }
}

fn limits(joint: &Joint) -> String {
    let written = match joint.kind {
        JointKind::Revolute => degrees,
        JointKind::Prismatic => millimetres,
    };
    joint.limits.map_or_else(|| "-".to_owned(), |[low, high]| format!("{} .. {}", written(low), written(high)))
}

fn elasticity(joint: &Joint) -> [String; 3] {
    let compliance = joint.compliance();
    if compliance == 0.0 {
        return ["rigid".to_owned(), "-".to_owned(), String::new()];
    }
    let stiffness = compliance.recip();
    let (soft, stiff, gear) = match joint.kind {
        JointKind::Revolute => {
            // What gear makers' catalogues give.
            let per_arcmin = significant(stiffness * 1_f64.to_radians() / 60.0, 4);
            ("rad/Nm", "Nm/rad", format!("{per_arcmin} Nm/arcmin"))
        }
        JointKind::Prismatic => ("m/N", "N/m", format!("{} N/um", significant(stiffness * 1e-6, 4))),
    };
    [format!("{} {soft}", significant(compliance, 4)), format!("{} {stiff}", significant(stiffness, 4)), gear]
}

fn pose(page: &mut String, robot: &Description, shown: &Shown) {
    let coordinates: Vec<String> = robot
        .joints
        .iter()
        .zip(&shown.q)
        .map(|(joint, &q)| match joint.kind {
            JointKind::Revolute => format!("{} deg", degrees(q)),
            JointKind::Prismatic => format!("{} mm", millimetres(q)),
        })
        .collect();
    section(page, &format!("Tool centre point at q = ({})", coordinates.join(", ")));
    let mut table = Table::new(1, ["base frame", "tool x", "tool y", "tool z", "origin [mm]"]);
    for (row, axis) in AXES[..3].iter().enumerate() {
        let entry = |column| decimals(shown.transform[(row, column)], 6);
        let origin = decimals(shown.transform[(row, 3)] * 1e3, 3);
        table.row([(*axis).to_owned(), entry(0), entry(1), entry(2), origin]);
    }
    page.push_str(&table.to_string());
}

fn stiffness(page: &mut String, robot: &Description, shown: &Shown, rows: Table) {
    match &shown.stiffness {
        Some(stiffness @ Stiffness::Full(_)) => {
            section(page, "Stiffness K_x (N and Nm per um and urad)");
            page.push_str(&matrix(rows, &AXES, stiffness.matrix(), 1e-6));
        }
        Some(Stiffness::Deficient { rank, pseudo_inverse }) => {
            section(page, &format!("Stiffness K_x: the compliance has rank {rank} of 6 and no inverse"));
            let why = if robot.effects.is_empty() && elastic(robot) < 6 {
                let [joints, directions] = ["elastic joint", "direction"].map(|noun| count(elastic(robot), noun));
                format!("with {joints} it yields in {directions} at most")
            } else {
                "in this pose there is a wrench that no elastic element yields to".to_owned()
            };
            let _ = writeln!(page, "  ({why}); its pseudo-inverse (N and Nm per um and urad) is");
            page.push_str(&matrix(rows, &AXES, pseudo_inverse, 1e-6));
        }
        None => section(page, "Stiffness K_x: the compliance is too small to have one"),
    }
}

fn elastic(robot: &Description) -> usize {
    robot.joints.iter().filter(|joint| joint.compliance() > 0.0).count()
}

fn translation(page: &mut String, shown: &Shown) {
    match &shown.translational_stiffness {
        Some(stiffness) => {
            section(page, "Translational stiffness, the tool free to turn (N/um)");
            page.push_str(&matrix(Table::new(1, ["", "x", "y", "z"]), &AXES, stiffness, 1e-6));
        }
        None => section(page, "Translational stiffness: the robot does not yield to every force in this pose"),
    }
    section(page, "Forces and the displacement along them");
    let mut table = Table::new(1, ["force along", "x", "y", "z", "compliance [um/N]", "stiffness [N/um]"]);
    let mut row = |name: &str, direction: &Direction| {
        let [x, y, z] = direction.unit.map(|component| decimals(component, 3));
        let stiffness = direction.stiffness.map_or_else(|| "rigid".to_owned(), |k| significant(k * 1e-6, 4));
        // Rounding may leave a rigid direction a little below zero.
        let compliance = significant(direction.compliance.max(0.0) * 1e6, 4);
        table.row([
            name.to_owned(),
            x,
            y,
            z,
            if stiffness == "rigid" { "0".to_owned() } else { compliance },
            stiffness,
        ]);
    };
    for (name, direction) in ["softest", "second", "stiffest"].into_iter().zip(&shown.principal) {
        row(name, direction);
    }
    for (name, direction) in AXES.into_iter().zip(&shown.axes) {
        row(name, direction);
    }
    page.push_str(&table.to_string());
}

fn shares(page: &mut String, shown: &Shown) {
    section(page, "Share in the displacement under a force (mean over all directions, and in the softest one)");
    let mut table = Table::new(1, ["element", "mean", "softest"]);
    let percent =
        |share: Option<f64>| share.map_or_else(|| "-".to_owned(), |x| format!("{} %", decimals(x * 100.0, 1)));
    for share in &shown.shares {
        table.row([share.element.clone(), percent(share.translation), percent(share.softest)]);
    }
    page.push_str(&table.to_string());
}

/// A matrix with a name before each row; entries that are rounding against the
/// largest of their row and column are zero.
fn matrix<R: Dim, C: Dim, S: RawStorage<f64, R, C>>(
    mut table: Table,
    names: &[&str],
    matrix: &Matrix<f64, R, C, S>,
    scale: f64,
) -> String {
    let largest = |values: &mut dyn Iterator<Item = &f64>| values.fold(0.0_f64, |most, value| most.max(value.abs()));
    let columns: Vec<f64> = matrix.column_iter().map(|column| largest(&mut column.iter())).collect();
    for (row, name) in matrix.row_iter().zip(names) {
        let most = largest(&mut row.iter());
        let entry = |(&value, &column): (&f64, &f64)| {
            let rounding = value.abs() < 1e-12 * most.min(column);
            significant(if rounding { 0.0 } else { value * scale }, 4)
        };
        table.row(std::iter::once((*name).to_owned()).chain(row.iter().zip(&columns).map(entry)));
    }
    table.to_string()
}

fn degrees(angle: f64) -> String {
    trimmed(angle.to_degrees())
}

fn millimetres(length: f64) -> String {
    trimmed(length * 1e3)
}

/// Micrometres and microdegrees suffice, and hide the rounding of the change
/// of units.
fn trimmed(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    if rounded == 0.0 { "0".to_owned() } else { rounded.to_string() }
}
