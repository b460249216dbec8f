//! A simulated campaign as files.

use std::fmt::Write as _;
use std::path::Path;
use std::{fs, io};

use robstiff_robots::JointKind;

use super::{Row, Simulated};

impl Simulated {
    /// Writes `campaign.yaml`, `loads.csv` and `robot.yaml` into a directory,
    /// which is made where it is missing.
    ///
    /// `robot` is the text of the robot's description as declared, which need
    /// not be the arm that was simulated.
    ///
    /// # Errors
    ///
    /// Where a file cannot be written.
    pub fn write(&self, directory: &Path, robot: &str) -> io::Result<()> {
        fs::create_dir_all(directory)?;
        fs::write(directory.join("robot.yaml"), robot)?;
        fs::write(directory.join("campaign.yaml"), self.campaign_yaml())?;
        fs::write(directory.join("loads.csv"), self.loads_csv())
    }

    /// The text of `campaign.yaml`.
    pub fn campaign_yaml(&self) -> String {
        let scenario = &self.scenario;
        let mut text = format!(
            "name: simulated static loads on {}, seed {}\n\
             robot: robot.yaml\n\
             observations: loads.csv\n\
             kind: displacement\n\
             wrench: {}\n\
             measured: {}\n",
            scenario.truth.name,
            scenario.seed,
            place(scenario.wrench_in_tool, scenario.hook),
            place(scenario.measured_in_tool, scenario.marker),
        );
        if scenario.states_noise {
            let rotation = scenario.rotation_noise.map(|sigma| format!(", rotation: {} urad", sigma * 1e6));
            let displacement = scenario.noise * 1e6;
            text += &format!("noise: {{displacement: {displacement} um{}}}\n", rotation.unwrap_or_default());
        }
        text
    }

    /// The text of `loads.csv`: degrees or millimetres, newtons, micrometres
    /// and microradians. Moments and rotations have columns where there are
    /// any.
    pub fn loads_csv(&self) -> String {
        let kinds: Vec<_> = self.scenario.truth.joints.iter().map(|joint| joint.kind).collect();
        let moments = self.scenario.moment.is_some();
        let mut header = String::from("pose,visit,time [s],temperature [C]");
        let encoders = self.scenario.encoders;
        let read = [
            ("q", true),
            ("j", encoders.is_some_and(|encoders| encoders.output.is_some())),
            ("m", encoders.is_some_and(|encoders| encoders.motors.is_some())),
        ];
        for (name, _) in read.into_iter().filter(|(_, is_read)| *is_read) {
            for (index, kind) in kinds.iter().enumerate() {
                let unit = match kind {
                    JointKind::Revolute => "deg",
                    JointKind::Prismatic => "mm",
                };
                header += &format!(",{name}{} [{unit}]", index + 1);
            }
        }
        header += ",Fx [N],Fy [N],Fz [N]";
        if moments {
            header += ",Mx [Nm],My [Nm],Mz [Nm]";
        }
        header += ",dx [um],dy [um],dz [um]";
        if self.scenario.rotation_noise.is_some() {
            header += ",rx [urad],ry [urad],rz [urad]";
        }
        let mut text = header + "\n";
        for row in &self.rows {
            line(&mut text, row, &kinds, moments);
        }
        text
    }
}

/// A frame and a point of the tool, as `campaign.yaml` has them.
fn place(in_tool: bool, at: [f64; 3]) -> String {
    let frame = if in_tool { "tool" } else { "base" };
    let at = if at == [0.0; 3] { String::from("tcp") } else { format!("{at:?}") };
    format!("{{frame: {frame}, at: {at}}}")
}

/// One row of the table, with all the digits it has.
fn line(text: &mut String, row: &Row, kinds: &[JointKind], moments: bool) {
    let angles = [Some(&row.q), row.encoders.as_ref(), row.motors.as_ref()];
    let coordinates = angles.into_iter().flatten().flat_map(|all| {
        all.iter().zip(kinds).map(|(q, kind)| match kind {
            JointKind::Revolute => q.to_degrees(),
            JointKind::Prismatic => q * 1e3,
        })
    });
    let wrench = &row.wrench[..if moments { 6 } else { 3 }];
    let micro = row.displacement.iter().chain(row.rotation.iter().flatten()).map(|value| value * 1e6);
    text.push_str(&format!("{},{}", row.pose, row.visit));
    let mut put = |value: f64| write!(text, ",{value}").expect("a string takes all that is written to it");
    put(row.time);
    put(row.temperature);
    coordinates.for_each(&mut put);
    wrench.iter().copied().for_each(&mut put);
    micro.for_each(put);
    text.push('\n');
}

#[cfg(test)]
mod tests {
    use robstiff_robots::Effect;

    use super::super::{Scenario, five_axis};

    #[test]
    fn the_table_says_what_was_measured() {
        let scenario = Scenario {
            poses: 2,
            moment: Some([10.0, 20.0]),
            rotation_noise: Some(5e-5),
            states_noise: true,
            ..Scenario::new(five_axis(), vec![Effect::BaseCompliance { tilt: 2e-8, translation: 0.0 }], 1)
        };
        let simulated = scenario.run();
        let text = simulated.loads_csv();
        let mut lines = text.lines();
        assert_eq!(
            lines.next().unwrap(),
            "pose,visit,time [s],temperature [C],q1 [deg],q2 [deg],q3 [deg],q4 [deg],q5 [deg],Fx [N],Fy [N],Fz [N],\
             Mx [Nm],My [Nm],Mz [Nm],dx [um],dy [um],dz [um],rx [urad],ry [urad],rz [urad]"
        );
        for (line, row) in lines.by_ref().zip(&simulated.rows) {
            let values: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            assert_eq!(values.len(), 21);
            assert_eq!(values[..3], [row.pose as f64, row.visit as f64, row.time]);
            assert!((values[4].to_radians() - row.q[0]).abs() < 1e-15);
            assert_eq!(values[9..15], row.wrench);
            assert!((values[17] * 1e-6 - row.displacement[2]).abs() < 1e-18);
            assert!((values[20] * 1e-6 - row.rotation.unwrap()[2]).abs() < 1e-18);
        }
        assert_eq!(lines.next(), None);
        assert!(simulated.campaign_yaml().ends_with("noise: {displacement: 8 um, rotation: 50 urad}\n"));
    }

    #[test]
    fn files_are_written() {
        let directory = std::env::temp_dir().join(format!("robstiff-simulator-{}", std::process::id()));
        let simulated = Scenario { poses: 1, ..Scenario::new(five_axis(), Vec::new(), 1) }.run();
        simulated.write(&directory, "name: Declared\n").unwrap();
        let read = |name: &str| std::fs::read_to_string(directory.join(name)).unwrap();
        assert_eq!(read("robot.yaml"), "name: Declared\n");
        assert_eq!(read("loads.csv"), simulated.loads_csv());
        assert_eq!(read("campaign.yaml"), simulated.campaign_yaml());
        assert!(!read("campaign.yaml").contains("noise"));
        std::fs::remove_dir_all(directory).unwrap();
    }
}
