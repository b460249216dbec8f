//! Frames that a controller knows by name, and speeds as its language has them.

use robstiff::nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion};
use robstiff_machining::program::{Language, Speed, Zone};
use robstiff_robots::quantity::Dimension;

use super::options::{above_zero, with_unit};

/// The languages of robots.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum RobotLanguage {
    /// KUKA Robot Language
    Krl,
    /// ABB RAPID
    Rapid,
    /// FANUC TP programs as text
    Ls,
    /// Universal Robots' URScript
    Ur,
}

impl From<RobotLanguage> for Language {
    fn from(language: RobotLanguage) -> Self {
        match language {
            RobotLanguage::Krl => Self::Krl,
            RobotLanguage::Rapid => Self::Rapid,
            RobotLanguage::Ls => Self::Ls,
            RobotLanguage::Ur => Self::Ur,
        }
    }
}

/// A frame by its name, as in `1 = 0, 0, 250 mm, 0, 0, 0`; one of the description where nothing else is said.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedFrame {
    /// Its name or number.
    pub name: String,
    /// Where it stands (m); `None` for `description`.
    pub pose: Option<Isometry3<f64>>,
}

/// Reads a frame with its name.
pub fn named_frame(text: &str) -> Result<NamedFrame, String> {
    let help = "a frame has a name and stands somewhere, as in \"1 = 0, 0, 250 mm, 0, 90 deg, 0\"";
    let (name, given) = text.split_once('=').ok_or(help)?;
    let name = name.trim().to_owned();
    if given.trim() == "description" {
        return Ok(NamedFrame { name, pose: None });
    }
    let parts: Vec<&str> = given.split(',').collect();
    let [x, y, z, roll, pitch, yaw] = parts[..] else {
        return Err(format!("six numbers are expected behind the name, here are {}; {help}", parts.len()));
    };
    let [x, y, z] = [x, y, z].map(|text| with_unit(text, Dimension::Length));
    let [roll, pitch, yaw] = [roll, pitch, yaw].map(|text| with_unit(text, Dimension::Angle));
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_euler_angles(roll?, pitch?, yaw?));
    Ok(NamedFrame { name, pose: Some(Isometry3::from_parts(Translation3::new(x?, y?, z?), turn)) })
}

/// A speed of joint motions: a share of the fastest in KRL and TP programs, one of the TCP in RAPID, one of the joint that
/// moves most in URScript.
pub fn joint_speed(text: &str, language: Language) -> Result<Speed, String> {
    match language {
        Language::Rapid => Ok(Speed::Tool(above_zero(with_unit(text, Dimension::Speed)?, Dimension::Speed)?)),
        Language::Ur => {
            let of = Dimension::RotationalSpeed;
            Ok(Speed::Joints(above_zero(with_unit(text, of)?, of)?))
        }
        Language::Krl | Language::Ls => share(text).map(Speed::Share),
    }
}

/// How near the tool passes: a share in TP programs, a distance in the others.
pub fn blend(text: &str, language: Language) -> Result<Zone, String> {
    match language {
        Language::Ls => share(text).map(Zone::Share),
        _ => Ok(Zone::Within(above_zero(with_unit(text, Dimension::Length)?, Dimension::Length)?)),
    }
}

/// A share from a percentage.
fn share(text: &str) -> Result<f64, String> {
    let number = text.trim().strip_suffix('%').and_then(|number| number.trim().parse::<f64>().ok());
    let number = number.filter(|percent| *percent > 0.0 && *percent <= 100.0);
    number
        .map(|percent| percent * 1e-2)
        .ok_or_else(|| "a share above 0 and up to 100 % is expected, e.g. \"10 %\"".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_have_a_name() {
        let frame = named_frame("3 = 0, 0, 250 mm, 0, 90 deg, 0").unwrap();
        assert_eq!((frame.name.as_str(), frame.pose.unwrap().translation.z), ("3", 0.25));
        assert_eq!(named_frame("t = description").unwrap().pose, None);
        for wrong in ["0,0,0,0,0,0", "1 = 0, 0, 5, 0, 0, 0", "1 = 1 mm"] {
            assert!(named_frame(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn each_language_has_its_speeds() {
        assert_eq!(joint_speed("10 %", Language::Krl), Ok(Speed::Share(0.1)));
        assert_eq!(joint_speed("200 mm/s", Language::Rapid), Ok(Speed::Tool(0.2)));
        assert_eq!(joint_speed("180 deg/s", Language::Ur), Ok(Speed::Joints(core::f64::consts::PI)));
        assert!(joint_speed("10 %", Language::Ur).is_err());
        assert!(joint_speed("200 mm/s", Language::Ls).is_err() && joint_speed("120 %", Language::Krl).is_err());
        assert_eq!(blend("0.1 mm", Language::Krl), Ok(Zone::Within(1e-4)));
        assert_eq!(blend("50%", Language::Ls), Ok(Zone::Share(0.5)));
    }
}
