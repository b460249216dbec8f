//! Machines with rotary axes: which way they turn the tool, and where its tip is.

use nalgebra::{Rotation3, Unit, Vector3};

/// The rotary axes of a machine, as its controller counts them.
///
/// At zero all axes are parallel to the frame of the path and the tool to its z. An axis turns
/// what it carries, a table with the workpiece or a head with the tool, by the right-hand rule
/// about x (A), y (B) or z (C), or against it.
#[derive(Clone, Debug, PartialEq)]
pub struct Machine {
    /// Axes of the table, the one that carries the others first.
    pub table: Vec<Rotary>,
    /// Axes of the head, the one that carries the others first.
    pub head: Vec<Rotary>,
    /// Where the axes of the table meet, in the frame of the path (m); needed without TCP.
    pub center: Option<Vector3<f64>>,
    /// From the point where the axes of the head meet to the tip (m); needed without TCP.
    pub pivot_length: Option<f64>,
}

/// A rotary axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rotary {
    /// 0, 1, 2 for A, B, C.
    pub letter: usize,
    /// Whether it turns against the right-hand rule.
    pub reversed: bool,
}

/// Angles of A, B and C (rad).
pub type Angles = [f64; 3];

const HELP: &str = "name one of `xyzac-trt` and `xyzbc-trt` (LinuxCNC), or the axes, the carrying one first: \
     `table A C`, `head C B`, `head B table C`, with a `-` before those that turn against the right-hand rule";

impl Machine {
    /// Reads the axes: `table A C`, `head C -B`, `head B table C`, or the name of a machine that
    /// LinuxCNC has: `xyzac-trt`, `xyzbc-trt`.
    ///
    /// # Errors
    /// What it is not, and what it can be.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut machine = Self { table: Vec::new(), head: Vec::new(), center: None, pivot_length: None };
        // `trtfuncs.c`, with its directions as they are unless `conventional-directions` is set.
        let text = match text.trim() {
            "xyzac-trt" => "table A C",
            "xyzbc-trt" => "table B C",
            other => other,
        };
        let (mut of_table, mut used) = (None, [false; 3]);
        for part in text.split([' ', ',']).filter(|part| !part.is_empty()) {
            match part {
                "table" => of_table = Some(true),
                "head" => of_table = Some(false),
                axis => {
                    let letter = match axis.trim_start_matches('-') {
                        "A" | "a" => 0,
                        "B" | "b" => 1,
                        "C" | "c" => 2,
                        _ => return Err(HELP.to_owned()),
                    };
                    let rotary = Rotary { letter, reversed: axis.starts_with('-') };
                    if core::mem::replace(&mut used[letter], true) {
                        return Err(format!("an axis is named twice; {HELP}"));
                    }
                    match of_table {
                        Some(true) => machine.table.push(rotary),
                        Some(false) => machine.head.push(rotary),
                        None => return Err(HELP.to_owned()),
                    }
                }
            }
        }
        if used.contains(&true) { Ok(machine) } else { Err(HELP.to_owned()) }
    }

    /// Whether it has an axis (0, 1, 2 for A, B, C).
    pub fn has(&self, letter: usize) -> bool {
        self.table.iter().chain(&self.head).any(|rotary| rotary.letter == letter)
    }

    /// From the tip to the spindle, in the workpiece's frame.
    pub fn axis(&self, angles: Angles) -> Unit<Vector3<f64>> {
        Unit::new_normalize(turn(&self.table, angles).inverse() * (turn(&self.head, angles) * Vector3::z()))
    }

    /// The tip in the workpiece's frame (m), where the machine without TCP is sent to a place: that
    /// of the tip with all rotary axes at zero.
    pub fn tip(&self, sent: Vector3<f64>, angles: Angles) -> Vector3<f64> {
        let (center, lever) = (self.center.unwrap_or_default(), self.lever());
        let tip = sent + lever - turn(&self.head, angles) * lever;
        center + turn(&self.table, angles).inverse() * (tip - center)
    }

    /// Where the machine without TCP is sent (m) for a tip in the workpiece's frame.
    pub fn sent(&self, tip: Vector3<f64>, angles: Angles) -> Vector3<f64> {
        let (center, lever) = (self.center.unwrap_or_default(), self.lever());
        let tip = center + turn(&self.table, angles) * (tip - center);
        tip - lever + turn(&self.head, angles) * lever
    }

    /// How far from what it turns about a place can be (m).
    pub fn reach(&self, sent: &Vector3<f64>) -> f64 {
        (sent - self.center.unwrap_or_default()).norm() + 2.0 * self.lever().z.abs()
    }

    /// What is missing to tell where the tip is without TCP.
    pub fn lacks(&self) -> Option<&'static str> {
        if !self.table.is_empty() && self.center.is_none() {
            return Some("where the axes of the table meet: `--center x,y,z`");
        }
        let lacks = !self.head.is_empty() && self.pivot_length.is_none();
        lacks.then_some("from where the axes of the head meet to the tip: `--pivot-length`")
    }

    fn lever(&self) -> Vector3<f64> {
        Vector3::z() * self.pivot_length.unwrap_or_default()
    }
}

fn turn(axes: &[Rotary], angles: Angles) -> Rotation3<f64> {
    axes.iter().fold(Rotation3::identity(), |turn, rotary| {
        let axis = Unit::new_unchecked(Vector3::ith(rotary.letter, 1.0));
        let angle = angles[rotary.letter];
        turn * Rotation3::from_axis_angle(&axis, if rotary.reversed { -angle } else { angle })
    })
}
