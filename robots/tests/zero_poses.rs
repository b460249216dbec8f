//! The catalogue's DH tables against the makers' robots as ros-industrial's
//! URDFs have them: same pose of the flange for every joint coordinate.
#![cfg(feature = "read")]

use robstiff_robots::catalogue::find;
use robstiff_robots::{Convention, Description, Joint};

type Vector = [f64; 3];

/// A frame: the images of x, y, z as columns, and the origin.
#[derive(Clone, Copy, Debug)]
struct Frame {
    axes: [Vector; 3],
    origin: Vector,
}

const BASE: Frame = Frame { axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], origin: [0.0; 3] };

impl Frame {
    fn along(&self, v: Vector) -> Vector {
        std::array::from_fn(|k| (0..3).map(|j| self.axes[j][k] * v[j]).sum())
    }

    fn translated(self, v: Vector) -> Self {
        let step = self.along(v);
        Self { origin: std::array::from_fn(|k| self.origin[k] + step[k]), ..self }
    }

    /// Turned about one of its own axes.
    fn turned(self, axis: usize, angle: f64) -> Self {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let (s, c) = angle.sin_cos();
        let mut axes = self.axes;
        axes[i] = std::array::from_fn(|k| c * self.axes[i][k] + s * self.axes[j][k]);
        axes[j] = std::array::from_fn(|k| c * self.axes[j][k] - s * self.axes[i][k]);
        Self { axes, ..self }
    }
}

/// The flange by the DH table.
fn by_table(robot: &Description, q: &[f64]) -> Frame {
    assert_eq!(robot.convention, Convention::Standard);
    let [roll, pitch, yaw] = robot.base.rpy;
    let base = BASE.translated(robot.base.xyz).turned(2, yaw).turned(1, pitch).turned(0, roll);
    robot.joints.iter().zip(q).fold(base, |frame, (Joint { theta, d, a, alpha, .. }, q)| {
        frame.turned(2, theta + q).translated([*a, 0.0, *d]).turned(0, *alpha)
    })
}

/// A joint of a URDF: its origin in the frame before, its axis (0, 1, 2 for x,
/// y, z) and the sense of it. No joint here has an `rpy`.
type UrdfJoint = (Vector, usize, f64);

struct Urdf {
    file: &'static str,
    joints: [UrdfJoint; 6],
    /// From the last link to the flange with z outwards: steps of a
    /// translation along x and turns about y, then x [degrees].
    flange: (f64, f64, f64),
    tolerance: f64,
}

const ROBOTS: &[Urdf] = &[
    Urdf {
        file: "kuka-kr270-r2700",
        joints: [
            ([0.0, 0.0, 0.675], 2, -1.0),
            ([0.350, 0.0, 0.0], 1, 1.0),
            ([1.150, 0.0, 0.0], 1, 1.0),
            ([1.200, 0.0, -0.041], 0, -1.0),
            ([0.0, 0.0, 0.0], 1, 1.0),
            ([0.240, 0.0, 0.0], 0, -1.0),
        ],
        flange: (0.0, 90.0, 0.0),
        tolerance: 1e-12,
    },
    Urdf {
        file: "kuka-kr210-l150",
        joints: [
            ([-0.00262, 0.00097586, 0.33099], 2, 1.0),
            ([0.35277, -0.037476, 0.4192], 1, 1.0),
            ([-9.8483e-5, -0.1475, 1.2499], 1, 1.0),
            ([0.95795, 0.184, -0.055059], 0, 1.0),
            ([0.542, 0.0, 0.0], 1, 1.0),
            ([0.1925, 0.0, 0.0], 0, 1.0),
        ],
        flange: (0.0375, 90.0, 0.0),
        // The CAD model's axis 1 is 2.6 mm off its base's origin, and more such.
        tolerance: 8e-3,
    },
    Urdf {
        file: "abb-irb6640-185-280",
        joints: [
            ([0.0, 0.0, 0.780], 2, 1.0),
            ([0.320, 0.0, 0.0], 1, 1.0),
            ([0.0, 0.0, 1.075], 1, 1.0),
            ([0.0, 0.0, 0.2], 0, 1.0),
            ([1.392, 0.0, 0.0], 1, 1.0),
            ([0.2, 0.0, 0.0], 0, 1.0),
        ],
        flange: (0.0, 90.0, 0.0),
        tolerance: 1e-12,
    },
    Urdf {
        file: "abb-irb6600-225-255",
        joints: [
            ([0.0, 0.0, 0.780], 2, 1.0),
            ([0.320, 0.0, 0.0], 1, 1.0),
            ([0.0, 0.0, 1.075], 1, 1.0),
            ([0.0, 0.0, 0.2], 0, 1.0),
            ([1.142, 0.0, 0.0], 1, 1.0),
            ([0.2, 0.0, 0.0], 0, 1.0),
        ],
        flange: (0.0, 90.0, 0.0),
        tolerance: 1e-12,
    },
    Urdf {
        file: "fanuc-m900ib-700",
        joints: [
            ([0.0, 0.0, 0.940], 2, 1.0),
            ([0.410, 0.0, 0.0], 1, 1.0),
            ([0.0, 0.0, 1.120], 1, -1.0),
            ([0.0, 0.0, 0.250], 0, -1.0),
            ([1.285, 0.0, 0.0], 1, -1.0),
            ([0.300, 0.0, 0.0], 0, -1.0),
        ],
        flange: (0.0, -90.0, 180.0),
        tolerance: 1e-12,
    },
    Urdf {
        file: "staubli-rx160",
        joints: [
            ([0.0, 0.0, 0.55], 2, 1.0),
            ([0.15, 0.0, 0.0], 1, 1.0),
            ([0.0, 0.0, 0.825], 1, 1.0),
            ([0.0, 0.0, 0.0], 2, 1.0),
            ([0.0, 0.0, 0.625], 1, 1.0),
            ([0.0, 0.0, 0.11], 2, 1.0),
        ],
        flange: (0.0, 0.0, 0.0),
        tolerance: 1e-12,
    },
];

fn by_urdf(urdf: &Urdf, q: &[f64]) -> Frame {
    let last = urdf
        .joints
        .iter()
        .zip(q)
        .fold(BASE, |frame, ((xyz, axis, sense), q)| frame.translated(*xyz).turned(*axis, sense * q));
    let (x, pitch, roll) = urdf.flange;
    last.translated([x, 0.0, 0.0]).turned(1, pitch.to_radians()).turned(0, roll.to_radians())
}

#[test]
fn the_tables_are_the_makers_robots() {
    for urdf in ROBOTS {
        let robot = Description::parse(urdf.file, find(urdf.file).unwrap()).unwrap();
        for pose in 0..200 {
            // Pose 0 is the zero position; the others cover the circle.
            let q: Vec<f64> = (0..6).map(|joint| f64::from(pose * (7 * joint + 3)) * 0.37 % 6.2).collect();
            let (table, maker) = (by_table(&robot, &q), by_urdf(urdf, &q));
            for k in 0..3 {
                let off = (table.origin[k] - maker.origin[k]).abs();
                assert!(off < urdf.tolerance, "{}, pose {pose}: {table:?} {maker:?}", urdf.file);
                for axis in 0..3 {
                    assert!((table.axes[axis][k] - maker.axes[axis][k]).abs() < 1e-12, "{}, pose {pose}", urdf.file);
                }
            }
        }
    }
}
