//! The mass on the arm: of its links, or what a measured frequency says.

use core::f64::consts::TAU;
use core::fmt;

use nalgebra::{DMatrix, DVector, Matrix3, Matrix3x6, Matrix6, SVector, SymmetricEigen, Vector3};
use robstiff_robots::Link;

use super::Modes;
use robstiff::Robot;
use robstiff::elements::{Element, Pose, Spring, springs};

/// Why the masses of the links give no modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MassError {
    /// No link has a mass.
    Unknown,
    /// Nothing that yields moves a link with a mass.
    Still,
    /// An entry is not finite.
    NotFinite,
}

impl fmt::Display for MassError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Unknown => "the description gives no masses of the links",
            Self::Still => "nothing that yields moves a link that has a mass",
            Self::NotFinite => "the compliance in this pose is not finite",
        })
    }
}

impl core::error::Error for MassError {}

/// The least squared period over the longest: what is quicker by more, a hundred times,
/// follows the slow modes as if it had no mass.
const QUICK: f64 = 1e-4;

/// What of the tool's compliance no mode has, over the whole, that is rounding.
const ROUNDING: f64 = 1e-9;

/// A point that moves with the arm: of the links' masses one each, and the tool.
struct Point {
    /// Its link (from 1); of the tool behind all.
    body: usize,
    /// From the TCP to it, in the base frame (m).
    arm: Vector3<f64>,
}

impl Point {
    /// Its displacement by the twist of the TCP, if it were in one body with it.
    fn shift(&self) -> Matrix3x6<f64> {
        let mut shift = Matrix3x6::zeros();
        shift.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
        shift.fixed_view_mut::<3, 3>(0, 3).copy_from(&-self.arm.cross_matrix());
        shift
    }
}

/// Something that yields: the twist at the TCP by a wrench on it, and the first links that
/// the two move.
struct Part {
    compliance: Matrix6<f64>,
    from: [usize; 2],
}

impl Modes {
    /// The modes of an arm with the links' point masses (a description gives no moments of
    /// inertia), `parts` being what yields in it
    /// ([`contributions`](robstiff::elements::contributions), or those under a force); `damping`
    /// is the damping ratio of every mode.
    ///
    /// With the compliances `G` from masses `m` to masses, `g` from there to the tool and `C`
    /// at the tool, the masses move by `u = -G m u'' + g^T f`: the eigenvalues of
    /// `m^(1/2) G m^(1/2)` are the squared inverses of the natural frequencies. The tool moves
    /// by `x = -g m u'' + C f`, of which what no mode has is massless. A link that bends or
    /// twists moves the links behind it.
    ///
    /// # Errors
    /// [`MassError`], where the links do not say.
    pub fn of_links<'r, const N: usize, R: Robot<N>>(
        robot: &'r R,
        links: &[Link],
        q: &SVector<f64, N>,
        parts: impl Iterator<Item = (Element<'r>, Matrix6<f64>)>,
        damping: f64,
    ) -> Result<Self, MassError> {
        let (frames, tcp) = (robot.link_frames(q), robot.transform(q));
        let bodies: Vec<(usize, &Link)> = (1..=N).zip(links).filter(|(_, link)| link.mass > 0.0).collect();
        if bodies.is_empty() {
            return Err(MassError::Unknown);
        }
        let tool = tcp.fixed_view::<3, 1>(0, 3);
        let point = |&(body, link): &(usize, &Link)| {
            let center = frames[body - 1].transform_point(&link.center_of_mass.into());
            Point { body, arm: center.coords - tool }
        };
        let mut points: Vec<Point> = bodies.iter().map(point).collect();
        points.push(Point { body: usize::MAX, arm: Vector3::zeros() });
        let between = compliance_between(&points, &parts_of(robot, q, parts));
        let count = 3 * bodies.len();
        let roots = DMatrix::from_fn(count, count, |i, j| if i == j { bodies[i / 3].1.mass.sqrt() } else { 0.0 });
        let weighted = &roots * between.view((0, 0), (count, count)) * &roots;
        if between.iter().any(|entry| !entry.is_finite()) {
            return Err(MassError::NotFinite);
        }
        let SymmetricEigen { eigenvectors, eigenvalues } =
            SymmetricEigen::new(0.5 * (&weighted + weighted.transpose()));
        let slowest = eigenvalues.max();
        if slowest <= 0.0 {
            return Err(MassError::Still);
        }
        let mut kept: Vec<usize> = (0..count).filter(|&i| eigenvalues[i] > QUICK * slowest).collect();
        kept.sort_by(|&i, &j| eigenvalues[j].total_cmp(&eigenvalues[i]));
        let vectors = DMatrix::from_fn(count, kept.len(), |row, i| eigenvectors[(row, kept[i])] / eigenvalues[kept[i]]);
        let shapes = between.view((count, 0), (3, count)) * &roots * vectors;
        let frequencies: Vec<f64> = kept.iter().map(|&i| eigenvalues[i].sqrt().recip()).collect();
        let at_tool: Matrix3<f64> = between.fixed_view::<3, 3>(count, count).into_owned();
        let of_modes = |i: usize, j: usize| {
            (0..kept.len()).map(|k| shapes[(i, k)] * shapes[(j, k)] * eigenvalues[kept[k]]).sum::<f64>()
        };
        let mut massless = Matrix3::from_fn(|i, j| at_tool[(i, j)] - of_modes(i, j));
        if massless.amax() <= ROUNDING * at_tool.amax() {
            massless = Matrix3::zeros();
        }
        let damping = DVector::from_element(kept.len(), damping);
        Ok(Self { compliance: at_tool, frequencies: frequencies.into(), shapes, massless, damping })
    }

    /// The mass that the tool has on the arm for a blow that is shorter than all periods,
    /// 3 x 3 (kg): the inverse of `shapes shapes^T`. `None` where a direction has none.
    pub fn mass(&self) -> Option<Matrix3<f64>> {
        let mobility = &self.shapes * self.shapes.transpose();
        let mobility = Matrix3::from_fn(|i, j| mobility[(i, j)]);
        let sizes = mobility.symmetric_eigenvalues();
        let is_regular = self.massless == Matrix3::zeros() && sizes.min() > ROUNDING * sizes.max();
        is_regular.then(|| mobility.try_inverse()).flatten()
    }
}

/// What yields, with what it moves.
fn parts_of<'r, const N: usize, R: Robot<N>>(
    robot: &'r R,
    q: &SVector<f64, N>,
    parts: impl Iterator<Item = (Element<'r>, Matrix6<f64>)>,
) -> Vec<Part> {
    let pose = Pose::of(robot, q);
    let mut all = Vec::new();
    for (element, compliance) in parts {
        let first = match element {
            Element::Joint(joint) => Some((Spring::Joint(joint), 1.0)),
            Element::Effect(effect) => {
                // Else a law of a joint; what is none has no compliance.
                springs(effect).next().or_else(|| Some((Spring::Joint(effect.row()?), 1.0)))
            }
        };
        match first {
            // Each of the two joints moves the links behind it.
            Some((Spring::Coupling([i, j]), value)) => {
                let twist = |joint| pose.geometry().joint_twist(joint);
                let product = twist(i) * twist(j).transpose() * value;
                all.push(Part { compliance: product, from: [i, j] });
                all.push(Part { compliance: product.transpose(), from: [j, i] });
            }
            Some((spring, _)) => all.push(Part { compliance, from: [first_moved(spring); 2] }),
            None => {}
        }
    }
    all
}

/// The first link that a spring moves; the tool alone is behind all.
fn first_moved(spring: Spring) -> usize {
    match spring {
        Spring::BaseTilt | Spring::BaseTranslation => 1,
        Spring::Joint(joint) | Spring::Transverse(joint) | Spring::Coupling([joint, _]) => joint,
        Spring::LinkBending(link) | Spring::LinkTorsion(link) => link + 1,
        Spring::ToolRotation | Spring::ToolTranslation => usize::MAX,
    }
}

/// The displacement of each point by a force on each, three rows and columns a point (m/N).
fn compliance_between(points: &[Point], parts: &[Part]) -> DMatrix<f64> {
    let mut between = DMatrix::zeros(3 * points.len(), 3 * points.len());
    for (i, moved) in points.iter().enumerate() {
        for (j, pushed) in points.iter().enumerate() {
            let moves = |part: &&Part| moved.body >= part.from[0] && pushed.body >= part.from[1];
            let whole: Matrix6<f64> = parts.iter().filter(moves).map(|part| part.compliance).sum();
            let block = moved.shift() * whole * pushed.shift().transpose();
            between.fixed_view_mut::<3, 3>(3 * i, 3 * j).copy_from(&block);
        }
    }
    between
}

/// The mass, the same in all directions, with which an arm of a translational
/// compliance (m/N) has its first mode at a measured frequency (Hz), 3 x 3
/// (kg). `None` where the arm does not yield, or the frequency is not above
/// zero.
pub fn mass_of_first_mode(compliance: &Matrix3<f64>, frequency: f64) -> Option<Matrix3<f64>> {
    let softest = compliance.symmetric_eigenvalues().max();
    let mass = (softest * (TAU * frequency).powi(2)).recip();
    (softest > 0.0 && frequency > 0.0 && mass.is_finite()).then(|| Matrix3::identity() * mass)
}
