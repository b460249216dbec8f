//! A robot in one pose: everything that is shown of it.

use robstiff::Robot;
use robstiff::analysis::{
    self, PrincipalDirections, Stiffness, directional_compliance, directional_stiffness, principal_directions,
};
use robstiff::elements::{Element, contributions, share_along, share_of_translation};
use robstiff::nalgebra::{DMatrix, Matrix3, Matrix4, Matrix6, SVector, Unit, Vector3};
use robstiff_robots::Description;

/// What is shown of a robot in one pose, whatever its number of joints.
pub struct Shown {
    /// Joint coordinates [rad or m].
    pub q: Vec<f64>,
    /// The tool centre point's frame in the base frame.
    pub transform: Matrix4<f64>,
    /// 6 x n, translation first.
    pub jacobian: DMatrix<f64>,
    /// 6 x 6 at the TCP in the base frame.
    pub compliance: Matrix6<f64>,
    /// Its inverse or pseudo-inverse, where it has a finite one.
    pub stiffness: Option<Stiffness<f64>>,
    /// The inverse of the translational block (N/m), where there is one.
    pub translational_stiffness: Option<Matrix3<f64>>,
    /// The directions in which a force moves the TCP along itself, the softest
    /// first.
    pub principal: Vec<Direction>,
    /// The directions of the base frame's axes.
    pub axes: [Direction; 3],
    /// What each joint and effect gives.
    pub shares: Vec<Share>,
}

/// How the TCP yields to a force.
pub struct Direction {
    /// The force's direction in the base frame.
    pub unit: [f64; 3],
    /// Displacement along it per force (m/N).
    pub compliance: f64,
    /// Force per displacement (N/m); none where the robot does not yield.
    pub stiffness: Option<f64>,
}

/// An element's part in the compliance, as fractions; none where there is no
/// compliance.
pub struct Share {
    /// `joint 3`, `transverse_compliance@joint 3`.
    pub element: String,
    /// Of the trace of the translational block.
    pub translation: Option<f64>,
    /// Of the displacement along the softest direction.
    pub softest: Option<f64>,
}

impl Shown {
    /// The robot at joint coordinates `q`, one for each joint.
    pub fn new(robot: &Description, q: Vec<f64>) -> Self {
        with_arm!(robot, |robot| shown(&robot, q))
    }
}

fn shown<const N: usize>(robot: &impl Robot<N>, coordinates: Vec<f64>) -> Shown {
    let q = SVector::<f64, N>::from_column_slice(&coordinates);
    let compliance = robot.compliance(&q);
    let principal: Vec<Direction> =
        principal_directions(&compliance).iter().flat_map(directions(&compliance)).collect();
    let softest = principal.first().map(|direction| Vector3::from(direction.unit));
    let yields = |element: &Element| !matches!(element, Element::Effect(effect) if effect.is_kinematic());
    let shares = contributions(robot, &q).filter(|(element, _)| yields(element)).map(|(element, part)| Share {
        element: element.to_string(),
        translation: share_of_translation(&part, &compliance),
        softest: softest.and_then(|direction| share_along(&part, &compliance, &direction)),
    });
    Shown {
        transform: robot.transform(&q),
        jacobian: DMatrix::from_iterator(6, N, robot.jacobian(&q).iter().copied()),
        stiffness: Stiffness::of(&compliance),
        translational_stiffness: analysis::translational_stiffness(&compliance),
        principal,
        axes: [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()].map(|axis| direction(&compliance, &axis)),
        shares: shares.collect(),
        compliance,
        q: coordinates,
    }
}

fn directions(compliance: &Matrix6<f64>) -> impl Fn(&PrincipalDirections<f64>) -> [Direction; 3] {
    move |principal| {
        std::array::from_fn(|k| {
            direction(compliance, &Unit::new_unchecked(principal.directions.column(k).into_owned()))
        })
    }
}

fn direction(compliance: &Matrix6<f64>, unit: &Unit<Vector3<f64>>) -> Direction {
    Direction {
        unit: [unit.x, unit.y, unit.z],
        compliance: directional_compliance(compliance, unit),
        stiffness: directional_stiffness(compliance, unit),
    }
}
