//! A description written and read again is the same, bit for bit.
#![cfg(feature = "read")]

use robstiff_robots::angle::snapped;
use robstiff_robots::catalogue::catalogue;
use robstiff_robots::effect::physics::LEAST_KNEE;
use robstiff_robots::{Convention, Description, DhEntry, Effect, Joint, JointKind, Link, Part, Place, Placement};

/// Marsaglia's xorshift64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, most: usize) -> usize {
        (self.next() % most as u64) as usize
    }

    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Round values, values with all their digits, and powers of ten.
    fn value(&mut self) -> f64 {
        let sign = if self.below(2) == 0 { 1.0 } else { -1.0 };
        match self.below(5) {
            0 => 0.0,
            1 => sign * self.below(5000) as f64 / 1000.0,
            2 => sign * self.unit(),
            3 => sign * self.unit() * 1e3,
            _ => sign * self.unit() * 10_f64.powi(self.below(40) as i32 - 20),
        }
    }

    fn positive(&mut self) -> f64 {
        self.value().abs() + 1e-12
    }

    /// As small a torque as the knee of a law may be at.
    fn knee(&mut self) -> f64 {
        self.positive().max(LEAST_KNEE)
    }

    fn angle(&mut self) -> f64 {
        let degrees = self.below(1440) as f64 / 2.0 - 360.0;
        let whole = f64::to_radians((self.below(9) as f64 - 4.0) * 90.0);
        let any = self.any_angle();
        snapped([degrees.to_radians(), whole, any][self.below(3)])
    }

    fn any_angle(&mut self) -> f64 {
        self.value().clamp(-1e6, 1e6)
    }

    fn vector(&mut self, value: fn(&mut Self) -> f64) -> [f64; 3] {
        std::array::from_fn(|_| value(self))
    }

    fn text(&mut self) -> String {
        const PIECES: &[&str] = &[
            "yes",
            "no",
            "null",
            "1e5",
            "word",
            "a: b",
            "c # d",
            "- ",
            "{e}",
            "\"",
            "'",
            "\\",
            " ",
            "  ",
            "\n",
            "\n\n",
            "\t",
            "é",
            "机器",
            "\u{85}",
            "\u{2028}",
            "\u{7}",
            "\u{feff}",
            "🤖",
            "&f",
            "*g",
            "!h",
            "%",
            "@",
            "`",
            "|",
            ">",
            "?",
            "---",
            "...",
            ",",
            "~",
            "a sentence of several words, as a source has many of them.",
        ];
        let length = [0, 1, 3, 40][self.below(4)];
        // Most texts are of plain words, as people write them.
        let pieces = if self.below(2) == 0 { PIECES } else { &["word", " ", "another ", "long-winded ", "\n"] };
        (0..length).map(|_| pieces[self.below(pieces.len())]).collect()
    }

    fn joint(&mut self) -> Joint {
        let kind = if self.below(4) == 0 { JointKind::Prismatic } else { JointKind::Revolute };
        let limit = match kind {
            JointKind::Revolute => Self::angle,
            JointKind::Prismatic => Self::value,
        };
        let (lower, upper) = (limit(self), limit(self));
        let limits = (self.below(2) == 0 && lower < upper).then_some([lower, upper]);
        let compliance = match self.below(3) {
            0 => Vec::new(),
            1 => vec![Part { name: String::new(), value: self.value().abs() }],
            _ => (0..1 + self.below(3))
                .map(|part| Part { name: format!("{part}{}", self.text()), value: self.value().abs() })
                .collect(),
        };
        let (theta, alpha) = (self.angle(), self.angle());
        Joint { kind, theta, d: self.value(), a: self.value(), alpha, limits, compliance }
    }

    fn placement(&mut self) -> Placement {
        if self.below(3) == 0 {
            return Placement::default();
        }
        Placement { xyz: self.vector(Self::value), rpy: self.vector(Self::angle) }
    }

    fn effects(&mut self, joints: &[Joint]) -> Vec<Effect> {
        let revolute = |joint: usize| joints[joint - 1].kind == JointKind::Revolute;
        let joint = 1 + self.below(joints.len());
        let mut effects = vec![
            Effect::TransverseCompliance { joint, value: self.value().abs() },
            Effect::BaseCompliance { tilt: self.value().abs(), translation: self.value().abs() },
            Effect::ToolCompliance { rotation: self.value().abs(), translation: self.value().abs() },
        ];
        if joint < joints.len() {
            effects.push(Effect::LinkCompliance {
                link: joint,
                bending: self.value().abs(),
                torsion: self.value().abs(),
            });
            let bound = joints[joint - 1].compliance().sqrt() * joints[joint].compliance().sqrt();
            // What varies with the angle takes a quarter at most.
            let value = (2.0 * self.unit() - 1.0) * 0.7 * bound;
            if revolute(joint) && revolute(joint + 1) && value.abs() < bound {
                effects.push(Effect::JointCoupling { joints: [joint, joint + 1], value });
            }
        }
        if revolute(joint) {
            effects.push(Effect::StiffnessNonlinearity { joint, added: self.positive(), knee: self.knee() });
            effects.push(Effect::LostMotion { joint, gap: self.any_angle().abs(), knee: self.knee() });
            effects.push(self.hysteresis(joint));
            let [cos1, sin1, cos2, sin2] =
                [0; 4].map(|_| [0.0, self.unit() / 16.0, -self.unit() / 16.0][self.below(3)]);
            effects.push(Effect::PoseDependentCompliance { joint, cos1, sin1, cos2, sin2 });
            effects.push(Effect::JointZeroOffset { joint, value: self.any_angle() });
            let [sin, cos] = [0; 2].map(|_| [0.0, self.unit() * 3e-3][self.below(2)]);
            let order = (1 + self.below(1000)) as f64;
            effects.push(Effect::TransmissionError { joint, order, sin, cos });
        }
        let entry = [DhEntry::A, DhEntry::Alpha, DhEntry::D, DhEntry::Theta][self.below(4)](joint);
        effects.push(Effect::DhError { entry, value: self.any_angle() });
        effects.retain(|_| self.below(2) == 0);
        // An error of theta is the zero offset of a joint that turns.
        if effects.iter().any(|effect| matches!(effect, Effect::JointZeroOffset { .. })) {
            effects.retain(|effect| !matches!(effect, Effect::DhError { entry: DhEntry::Theta(_), .. }));
        }
        effects
    }

    fn hysteresis(&mut self, joint: usize) -> Effect {
        let mut pairs = [[0.0; 2]; 3];
        let mut radius = 0.0;
        for pair in pairs.iter_mut().take(1 + self.below(3)) {
            radius += 1e-3 + self.unit() * 100.0;
            *pair = [radius, self.value().abs()];
        }
        let [[radius1, weight1], [radius2, weight2], [radius3, weight3]] = pairs;
        Effect::Hysteresis { joint, radius1, weight1, radius2, weight2, radius3, weight3 }
    }

    fn description(&mut self) -> Description {
        let joints: Vec<Joint> = (0..1 + self.below(8)).map(|_| self.joint()).collect();
        let link = |random: &mut Self| Link { mass: random.value().abs(), center_of_mass: random.vector(Self::value) };
        let links = if self.below(2) == 0 { Vec::new() } else { joints.iter().map(|_| link(self)).collect() };
        let effects = self.effects(&joints);
        let mut robot = Description {
            name: ["Rv130hsc", "N", "No", "YES", "Null", "E5"][self.below(6)].to_owned(),
            description: self.text(),
            source: self.text(),
            convention: [Convention::Standard, Convention::Modified][self.below(2)],
            base: self.placement(),
            joints,
            tool: self.placement(),
            links,
            effects,
            controller: None,
        };
        let points: Vec<usize> = (1..robot.joints.len()).filter(|&link| !robot.is_beam(link)).collect();
        robot.effects.retain(|effect| !matches!(effect.place(), Place::Link(link) if points.contains(&link)));
        robot
    }
}

#[track_caller]
fn assert_round_trip(description: &Description) {
    let yaml = description.to_yaml();
    match Description::parse("robot.yaml", &yaml) {
        Ok(read) => assert_eq!(&read, description, "{yaml}"),
        Err(problems) => panic!("{problems}\n\n{yaml}"),
    }
}

#[test]
fn random_descriptions_survive() {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    for _ in 0..3000 {
        assert_round_trip(&random.description());
    }
}

#[test]
fn the_catalogue_survives() {
    for (file, text) in catalogue() {
        assert_round_trip(&Description::parse(file, text).unwrap());
    }
}

#[test]
fn the_style_is_a_persons() {
    let text = "\
name: Rv130hsc
description: Reis RV130HSC, \"surrogate\"
source: >
  Every number comes from somewhere, and where it comes from is said here, in as many words as it takes. A
  line is folded where it is long.

  A second paragraph.
convention: standard
base: {rpy: [180 deg, 0 deg, 0 deg]}
joints:
  - {theta: 0 deg, d: 865 mm, a: 410 mm, alpha: -90 deg, limits: [-170 deg, 170 deg], compliance: 2.97e-7 rad/Nm}
  - {theta: -90 deg, a: 1 m, compliance: {gear: 1.9e-7 rad/Nm, belt: 1.22e-7 rad/Nm}}
  - {type: prismatic, theta: 0.1 rad, limits: [0 m, 1.5 m], compliance: 2e-8 m/N}
tool: {xyz: [0 m, 0 m, 120 mm]}
links:
  - {mass: 350 kg, center_of_mass: [0 m, 0 m, 0.1 m]}
  - {}
  - {mass: 2.5 kg}
effects:
  - {kind: transverse_compliance, at: joint 3, value: 6.35e-7 rad/Nm}
  - {kind: joint_coupling, at: \"joints 1,2\", value: -1e-8 rad/Nm}
  - {kind: stiffness_nonlinearity, at: joint 1, added: 1e-7 rad/Nm, knee: 500 Nm}
";
    let description = Description::parse("robot.yaml", text).unwrap();
    assert_eq!(description.to_yaml(), text);
}
