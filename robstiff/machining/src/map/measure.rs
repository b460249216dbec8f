//! What is computed at each cell of a map.

use nalgebra::{Matrix3, Vector3, Vector6};

use super::largest::{Principal, largest, softest};
use super::{Evaluate, Poses};
use robstiff::analysis::{PrincipalDirections, upright};

/// What a map shows of a pose. The first column is the one that is drawn and
/// ranked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measure {
    /// How far the TCP moves under a wrench (N, Nm at the TCP in the base
    /// frame), and where to.
    Deviation(Vector6<f64>),
    /// How far a force of this size (N) moves the TCP in the direction in which
    /// it moves it most, and that direction.
    AnyDirection(f64),
    /// The force per displacement along it in the weakest direction, the tool free
    /// to turn, and that direction: of small forces, about the unloaded state.
    Stiffness,
    /// The same, and the upper triangle of the 6 x 6 compliance by rows.
    Compliance,
}

/// A column of a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    /// `deviation`, `weak_x`, `h_12`.
    pub name: &'static str,
    /// The unit it is written in; empty for a number.
    pub unit: &'static str,
    /// What a value in SI is multiplied by to be in that unit.
    pub scale: f64,
}

/// Values this near are alike but for rounding, by share.
const ROUNDING: f64 = 1e-9;

const fn column(name: &'static str, unit: &'static str, scale: f64) -> Column {
    Column { name, unit, scale }
}

const DEVIATION: [Column; 4] =
    [column("deviation", "um", 1e6), column("dx", "um", 1e6), column("dy", "um", 1e6), column("dz", "um", 1e6)];

const ANY: [Column; 4] =
    [column("deviation", "um", 1e6), column("weak_x", "", 1.0), column("weak_y", "", 1.0), column("weak_z", "", 1.0)];

const COMPLIANCE: [Column; 25] = {
    const N: &str = "um/N";
    const M: &str = "urad/N";
    const R: &str = "urad/Nm";
    let mut columns = [column("stiffness", "N/um", 1e-6); 25];
    let mut k = 1;
    while k < 4 {
        columns[k] = ANY[k];
        k += 1;
    }
    let names = [
        ("h_11", N),
        ("h_12", N),
        ("h_13", N),
        ("h_14", M),
        ("h_15", M),
        ("h_16", M),
        ("h_22", N),
        ("h_23", N),
        ("h_24", M),
        ("h_25", M),
        ("h_26", M),
        ("h_33", N),
        ("h_34", M),
        ("h_35", M),
        ("h_36", M),
        ("h_44", R),
        ("h_45", R),
        ("h_46", R),
        ("h_55", R),
        ("h_56", R),
        ("h_66", R),
    ];
    while k < 25 {
        columns[k] = column(names[k - 4].0, names[k - 4].1, 1e6);
        k += 1;
    }
    columns
};

impl Measure {
    /// What it computes of each pose.
    pub fn columns(&self) -> &'static [Column] {
        match self {
            Self::Deviation(_) => &DEVIATION,
            Self::AnyDirection(_) => &ANY,
            Self::Stiffness => &COMPLIANCE[..4],
            Self::Compliance => &COMPLIANCE,
        }
    }

    /// Whether the first column is worse where it is larger.
    pub fn worse_is_larger(&self) -> bool {
        matches!(self, Self::Deviation(_) | Self::AnyDirection(_))
    }

    /// Whether one value of the first column is worse than another.
    pub fn is_worse(&self, one: f64, other: f64) -> bool {
        if self.worse_is_larger() { one > other } else { one < other }
    }

    /// The same, by more than rounding: of ways that are all alike the first is as good.
    pub fn is_clearly_worse(&self, one: f64, other: f64) -> bool {
        self.is_worse(one, other) && (one - other).abs() > ROUNDING * other.abs()
    }

    /// The columns at some poses, in SI. Where no force moves the tool the stiffness is infinite,
    /// and the weakest direction is none (NaN).
    pub fn compute<const N: usize>(&self, robot: &impl Evaluate<N>, poses: Poses<'_, N>) -> Vec<Vec<f64>> {
        let count = poses.len();
        let mut columns = vec![vec![0.0; count]; self.columns().len()];
        if let Self::Deviation(wrench) = self {
            let mut deflections = vec![Vector6::zeros(); count];
            robot.deflections(poses, wrench, &mut deflections);
            let [length, x, y, z] = columns.as_mut_slice() else { unreachable!("these are the columns") };
            for (i, d) in deflections.iter().enumerate() {
                length[i] = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
                (x[i], y[i], z[i]) = (d[0], d[1], d[2]);
            }
            return columns;
        }
        let mut triangles = vec![[0.0; 21]; count];
        robot.triangles(poses, &mut triangles);
        let principal: Vec<_> = triangles.iter().map(principal).collect();
        let found = match self {
            Self::AnyDirection(force) => largest(robot, poses, *force, &principal),
            _ => principal.iter().map(softest).collect(),
        };
        for (i, (triangle, (figure, direction))) in triangles.iter().zip(found).enumerate() {
            columns[0][i] = if self.worse_is_larger() { figure } else { figure.recip() };
            let weak = if figure == 0.0 { Vector3::repeat(f64::NAN) } else { upright(direction) };
            for k in 0..3 {
                columns[1 + k][i] = weak[k];
            }
            if *self == Self::Compliance {
                for (column, entry) in columns[4..].iter_mut().zip(triangle) {
                    column[i] = *entry;
                }
            }
        }
        columns
    }
}

/// The principal directions of the translational compliance as columns, the softest first, and
/// its compliances (m/N); no numbers where it has none.
fn principal(triangle: &[f64; 21]) -> Principal {
    let [xx, xy, xz, ..] = *triangle;
    let (yy, yz, zz) = (triangle[6], triangle[7], triangle[11]);
    PrincipalDirections::of(&Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz))
        .map_or((Matrix3::repeat(f64::NAN), Vector3::repeat(f64::NAN)), |found| (found.directions, found.compliances))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of turns of the tool that make no difference the first stays.
    #[test]
    fn what_differs_by_rounding_is_no_worse() {
        let deviation = Measure::Deviation(Vector6::zeros());
        assert!(!deviation.is_clearly_worse(1e-4 * (1.0 + 1e-12), 1e-4) && deviation.is_clearly_worse(1.01e-4, 1e-4));
        assert!(
            !Measure::Stiffness.is_clearly_worse(1e6 * (1.0 - 1e-12), 1e6)
                && Measure::Stiffness.is_clearly_worse(0.99e6, 1e6)
        );
        assert!(
            !deviation.is_clearly_worse(f64::INFINITY, f64::INFINITY) && deviation.is_clearly_worse(f64::INFINITY, 1.0)
        );
    }
}
