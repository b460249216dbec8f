//! What lies between the arm and the file: foundation, tracker, hall and load
//! cell, with their faults.

use nalgebra::{Matrix3, Vector3};

use super::Arm;
use super::frame::{exp, log};
use super::hidden::{Follows, Hidden, Mount};
use super::outside::Outside;

/// The temperature in the hall at the beginning (C).
const MORNING: f64 = 21.0;

/// By how much it warms up (K), and with which time constant (s).
const WARMS: (f64, f64) = (4.0, 7200.0);

/// How long the gates of the hall take to open and close again (s).
const SWING: f64 = 5400.0;

/// The hall, the rig in it, and what is wrong with it.
pub(super) struct Rig<'a> {
    arm: &'a Arm,
    hidden: &'a [Hidden],
    /// When the last reading is taken (s).
    end: f64,
    /// Amplitude of the hall's temperature about its rise (K).
    swing: f64,
    /// Whether what is read is given in the tool frame of the unloaded arm.
    in_tool: bool,
}

/// The arm at one moment: a point of it, and how it has moved.
pub(super) struct Stand<'a> {
    /// When (s).
    pub time: f64,
    /// Joint coordinates.
    pub q: &'a [f64],
    /// Where readings are taken (m) and the tool's axes without a load, in the
    /// base frame.
    pub at: Vector3<f64>,
    pub tool: Matrix3<f64>,
    /// What the load has done: displacement there (m) and rotation vector (rad).
    pub displacement: Vector3<f64>,
    pub rotation: Vector3<f64>,
}

impl<'a> Rig<'a> {
    pub fn new(arm: &'a Arm, hidden: &'a [Hidden], end: f64, swing: f64, in_tool: bool) -> Self {
        Self { arm, hidden, end, swing, in_tool }
    }

    /// The temperature in the hall (C): it warms up over a morning.
    pub fn temperature(&self, time: f64) -> f64 {
        let (rise, constant) = WARMS;
        MORNING - rise * (-time / constant).exp_m1() + self.swing * (std::f64::consts::TAU * time / SWING).sin()
    }

    /// How much warmer it is than at the beginning (K).
    pub fn warmer(&self, time: f64) -> f64 {
        self.temperature(time) - self.temperature(0.0)
    }

    /// The displacement and the rotation between two readings, as they are read
    /// but for noise.
    pub fn between(&self, unloaded: &Stand<'_>, loaded: &Stand<'_>) -> ([f64; 3], [f64; 3]) {
        let (from, to) = (self.stands(unloaded), self.stands(loaded));
        let frame = if self.in_tool { unloaded.tool.transpose() } else { Matrix3::identity() };
        let turn = self.tracker() * frame;
        ((turn * (to.0 - from.0)).into(), (turn * log(&(to.1 * from.1.transpose()))).into())
    }

    /// The turn from the frame of the file into that which is measured in.
    fn tracker(&self) -> Matrix3<f64> {
        let turns = self.hidden.iter().map(|hidden| match hidden {
            Hidden::TrackerMisalignment(turn) => exp(&Vector3::from(*turn)),
            _ => Matrix3::identity(),
        });
        turns.fold(Matrix3::identity(), |all, turn| turn * all)
    }

    /// Where the marker is, seen from where it was on the unloaded arm when that
    /// was new, and how the tool has turned since.
    fn stands(&self, stand: &Stand<'_>) -> (Vector3<f64>, Matrix3<f64>) {
        let mut point = stand.at + stand.displacement;
        let mut turned = exp(&stand.rotation);
        for hidden in self.hidden {
            match hidden {
                Hidden::BaseSlip { shift, turn, when } if stand.time > when * self.end => {
                    let turn = exp(&Vector3::from(*turn));
                    point = turn * point + Vector3::from(*shift);
                    turned = turn * turned;
                }
                Hidden::ThermalDrift { rate, follows } => {
                    point += Vector3::from(*rate) * self.drift(*follows, stand.time)
                }
                Hidden::ReflectorSlip { shift, when } if stand.time > when * self.end => {
                    point += stand.tool * Vector3::from(*shift);
                }
                _ => {}
            }
        }
        if let Some(grown) = self.grown(stand.time) {
            point += Vector3::from(grown.tcp(stand.q)) - Vector3::from(self.arm.tcp(stand.q));
        }
        ((point - stand.at) * self.scale(), turned)
    }

    /// How long the tracker reads what is one long.
    pub fn scale(&self) -> f64 {
        let of = |hidden: &Hidden| if let Hidden::TrackerScale(scale) = hidden { 1.0 + scale } else { 1.0 };
        self.hidden.iter().map(of).product()
    }

    /// The arm at a time, where its links grow.
    pub fn grown(&self, time: f64) -> Option<Arm> {
        let links = |hidden: &Hidden| match hidden {
            Hidden::Outside(Outside::LinkGrowth { link, per_kelvin }) => {
                vec![(*link, per_kelvin * self.warmer(time))]
            }
            Hidden::Expansion { rate, follows } => {
                (1..=self.arm.links()).map(|link| (link, rate * self.drift(*follows, time))).collect()
            }
            _ => vec![],
        };
        let growing: Vec<(usize, f64)> = self.hidden.iter().flat_map(links).collect();
        let grown = growing.iter().fold(self.arm.clone(), |arm, &(link, share)| arm.stretched(link, share));
        (!growing.is_empty()).then_some(grown)
    }

    /// How far what drifts is at a time, in units of its rate.
    pub fn drift(&self, follows: Follows, time: f64) -> f64 {
        match follows {
            Follows::Time => time / 3600.0,
            Follows::Temperature => self.warmer(time),
            Follows::Settling(constant) => -(-time / constant).exp_m1(),
        }
    }

    /// What the load cell reads of a force of a size (N) at joint coordinates, as a share, along
    /// its axes.
    fn of_load(&self, size: f64, grew: bool, q: &[f64]) -> f64 {
        let way = if grew { 1.0 } else { -1.0 };
        let of = |hidden: &Hidden| match hidden {
            Hidden::Outside(Outside::BentCell { bend }) => 1.0 - bend * size / 1000.0,
            Hidden::Outside(Outside::LoadFriction { share }) => 1.0 + way * share,
            Hidden::Outside(Outside::GainOfAngle { joint, gain }) => 1.0 + gain * q[joint - 1],
            _ => 1.0,
        };
        self.hidden.iter().map(of).product()
    }

    /// What the load cell says of a wrench, in the base frame, that grew to what
    /// it is or fell, on an arm at joint coordinates at which its tool has these axes.
    pub fn cell(&self, wrench: &[f64; 6], grew: bool, (q, tool): (&[f64], &Matrix3<f64>)) -> [f64; 6] {
        let mut force = Vector3::from_column_slice(&wrench[..3]);
        let mut moment = Vector3::from_column_slice(&wrench[3..]);
        let of_load = self.of_load(force.norm(), grew, q);
        (force, moment) = (force * of_load, moment * of_load);
        for hidden in self.hidden {
            let (Hidden::LoadCellMisalignment { mount, .. }
            | Hidden::LoadCellBias { mount, .. }
            | Hidden::LoadCellScale { mount, .. }) = hidden
            else {
                continue;
            };
            let axes = match mount {
                Mount::Ground => Matrix3::identity(),
                Mount::Tool => *tool,
            };
            (force, moment) = (axes.tr_mul(&force), axes.tr_mul(&moment));
            match hidden {
                Hidden::LoadCellMisalignment { turn, .. } => {
                    let turn = exp(&Vector3::from(*turn));
                    (force, moment) = (turn.tr_mul(&force), turn.tr_mul(&moment));
                }
                Hidden::LoadCellBias { force: bias, .. } => force -= Vector3::from(*bias),
                Hidden::LoadCellScale { scale, .. } => {
                    let by = Vector3::from(*scale).add_scalar(1.0);
                    (force, moment) = (force.component_div(&by), moment.component_div(&by));
                }
                _ => unreachable!("only what is wrong with the cell comes here"),
            }
            (force, moment) = (axes * force, axes * moment);
        }
        [force.x, force.y, force.z, moment.x, moment.y, moment.z]
    }
}

/// What creep adds to a displacement or rotation: every step that was made of
/// it, grown by a share a decade since.
pub(super) struct Creep {
    share: f64,
    onset: f64,
    steps: Vec<(f64, Vector3<f64>)>,
    last: Vector3<f64>,
}

impl Creep {
    /// The creep of an arm that stands unloaded, if it creeps.
    pub fn new(hidden: &[Hidden]) -> Option<Self> {
        hidden.iter().find_map(|hidden| match *hidden {
            Hidden::Creep { share, onset } => Some(Self { share, onset, steps: Vec::new(), last: Vector3::zeros() }),
            _ => None,
        })
    }

    /// What it adds at a time to a displacement that began at another, when the
    /// load changed last.
    pub fn adds(&mut self, displacement: &Vector3<f64>, since: f64, time: f64) -> Vector3<f64> {
        self.steps.push((since, displacement - self.last));
        self.last = *displacement;
        let grown =
            |&(since, step): &(f64, Vector3<f64>)| step * (self.share * (1.0 + (time - since) / self.onset).log10());
        self.steps.iter().map(grown).sum()
    }
}
