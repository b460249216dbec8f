//! Campaigns: what was measured, the robot, and the table of observations.

use std::fs;

use robstiff_identify::campaign::{Campaign, Data};
use robstiff_identify::identify::identify;
use robstiff_identify::predict::predict;
use robstiff_identify::triage::triage;

use super::accepted::{assert_same, with_line_breaks_of_windows};
use super::grammar::Grammar;
use super::refused::assert_told;
use super::sections::sections;
use crate::folder::Folder;

pub const GRAMMAR: &Grammar = &[
    (
        "file",
        &[
            "robot: robot.yaml\nobservations: loads.csv\nkind: displacement\n=> loads.csv\n%displacements%",
            "%plan%kind: displacement\n%fields%=> loads.csv\n%displacements%",
            "%plan%kind: displacement\n%fields%=> loads.csv\n%displacements%",
            "%plan%kind: position\n%fields%=> loads.csv\n%positions%",
            "%plan%kind: clamped\n=> loads.csv\n%clamped%",
            "%plan%kind: %odd%\n%fields%=> loads.csv\n%displacements%=> robot.yaml\n%robot%",
        ],
    ),
    (
        "plan",
        &[
            "name: hall 3\nrobot: robot.yaml\nobservations: loads.csv\n",
            "robot: rv130hsc\nobservations: loads.csv\n",
            "robot: robot.yaml\nobservations: %odd%\n",
            "robot: %odd%\nobservations: loads.csv\n",
        ],
    ),
    (
        "fields",
        &[
            "",
            "wrench: {frame: %frame%, at: %at%}\nmeasured: {frame: %frame%, at: %at%}\n",
            "noise: {displacement: %sigma%, rotation: 50 urad}\n",
            "holdout: {fraction: %small%, seed: %count%}\n%fields%",
            "noise: {displacement: 8 um}\nholdout: {fraction: 0.5, seed: 1}\n",
            "wrench: {at: tcp}\n%fields%",
            "# a remark\nunknown: %odd%\n",
        ],
    ),
    ("frame", &["base", "tool", "world"]),
    ("at", &["tcp", "[0, 0, 120 mm]", "[%length%, %length%, %length%]"]),
    ("sigma", &["8 um", "0.1 mm", "%length%"]),
    ("robot", &["name: One\nconvention: standard\njoints: [{a: 1 m, compliance: 1e-6 rad/Nm}]\n", "%odd%"]),
    (
        "displacements",
        &[
            "pose,q1,q2 [deg],Fx [N],Fy [N],Fz [N],dx [um],dy [um],dz [um]\na,0,30,100,200,300,10,20,30\n",
            "pose,visit,q1 [deg],q2 [deg],Fx [N],Fy [N],Fz [N],dx [um],dy [um],dz [um]\n%loads%",
            "pose,visit,q1 [deg],q2 [deg],Fx [N],Fy [N],Fz [N],dx [um],dy [um],dz [um]\n%loads%%loads%%loads%",
            "pose,time,q1 [deg],q2 [deg],Fx [N],Fy [N],Fz [N],dx [um],dy [um],dz [um]\n%timed%",
            "dz [um],dy [um],dx [um],rx [urad],ry [urad],rz [urad],Fz,Fy,Fx,Mx [Nm],My,Mz,q2,q1,pose\n%turned%",
            "\u{feff}pose;q1;q2;Fx;Fy;Fz;dx;dy;dz\n",
            "pose,visit,q1 [deg],q2 [deg],j1 [deg],j2 [deg],Fx [N],Fy [N],Fz [N],dx [mm],dy [mm],dz [mm]\n%encoders%",
        ],
    ),
    ("loads", &["%load%\n", "%load%\n%loads%", "%load%\n%load%\n%load%\n", "%load%\n%load%\n%loads%"]),
    (
        "load",
        &[
            "a,1,0,30,100,200,300,10,20,30",
            "a,1,0,30,%newtons%,%newtons%,%newtons%,%um%,%um%,%um%",
            "b,2,45,60,%newtons%,%newtons%,%newtons%,%um%,%um%,%um%",
            "%id%,%id%,%degrees%,%degrees%,%newtons%,%newtons%,%newtons%,%um%,%um%,%um%",
            "c,3,-45,10,0,0,0,0,0,0",
            "%id%,%id%,%degrees%",
            "",
        ],
    ),
    ("timed", &["a,%time%,0,30,100,200,300,10,20,30\n", "a,%time%,0,30,100,200,300,10,20,30\n%timed%"]),
    ("time", &["0", "60", "08:15:00", "23:59:59", "2026-11-25 08:15:00", "2026-11-25T08:15:00Z", "25:61:00", "%odd%"]),
    (
        "turned",
        &[
            "%um%,%um%,%um%,1,2,3,100,200,300,1,0,0,0.5,0.1,a\n",
            "1,2,3,%um%,2,3,%newtons%,0,0,0,0,0,0.5,0.1,a\n%turned%",
        ],
    ),
    (
        "encoders",
        &["a,1,0,30,0.001,30.001,%newtons%,0,100,1,2,3\n", "b,2,%degrees%,30,%degrees%,30,10,20,30,1,2,3\n%encoders%"],
    ),
    (
        "positions",
        &[
            "pose,q1,q2,px,py,pz\na,0,0.5,1,2,3\n",
            "pose,q1 [deg],q2 [deg],payload [kg],px [mm],py [mm],pz [mm]\n%points%",
        ],
    ),
    ("points", &["%point%\n", "%point%\n%points%", "%point%\n%point%\n%points%"]),
    ("point", &["a,0,30,0,1000,200,300", "b,%degrees%,%degrees%,%kg%,%um%,%um%,%um%", "%id%,10,-30,150,%um%,2,3"]),
    ("kg", &["0", "150", "-1", "%small%", "%odd%"]),
    (
        "clamped",
        &["axis,torque [Nm],deflection [rad]\n1,100,1e-4\n", "axis,torque [Nm],deflection [urad]\n%axes%%axes%"],
    ),
    ("axes", &["%axis%\n", "%axis%\n%axes%", "%axis%\n%axis%\n%axes%"]),
    ("axis", &["1,100,100", "2,%newtons%,%um%", "1,%newtons%,%um%", "%odd%,1,2"]),
    ("id", &["a", "b", "1", "\"\"", "\"x,y\"", "", "%odd%"]),
    ("degrees", &["0", "30", "-45.5", "90", "%small%", "%odd%"]),
    ("newtons", &["100", "-200", "0", "1e3", "%small%", "%odd%"]),
    ("um", &["10", "-20", "0", "3.25", "123456", "%small%", "%odd%"]),
];

/// The robot where a text brings none of its own.
const ROBOT: &str = "name: Two\nconvention: standard\njoints:\n  - {a: 1 m, compliance: 1e-6 rad/Nm}\n  \
                     - {a: 500 mm, compliance: 2e-6 rad/Nm}\n";

/// Fits of more rows take long.
const MOST_ROWS: usize = 12;

pub fn check(data: &[u8]) -> Result<(), String> {
    let text = std::str::from_utf8(data).map_err(|error| error.to_string())?;
    let (plan, files) = sections(text);
    let of = |name: &str| files.iter().find(|(file, _)| *file == name).map(|(_, text)| *text);
    let files = [("campaign.yaml", plan), ("robot.yaml", of("robot.yaml").unwrap_or(ROBOT))];
    let files: Vec<(&str, &str)> = files.into_iter().chain(of("loads.csv").map(|text| ("loads.csv", text))).collect();
    let read = |texts: &[(&str, &str)]| {
        let folder = Folder::new();
        for (file, text) in texts {
            fs::write(folder.0.join(file), text).expect("a temporary file");
        }
        Campaign::read(folder.0.join("campaign.yaml")).map_err(|error| {
            let named: Vec<(String, &str)> =
                texts.iter().map(|(file, text)| (folder.0.join(file).display().to_string(), *text)).collect();
            let named: Vec<(&str, &str)> = named.iter().map(|(file, text)| (file.as_str(), *text)).collect();
            assert_told(&error, &named)
        })
    };
    let campaign = read(&files);
    let broken: Option<Vec<(&str, String)>> =
        files.iter().map(|(file, text)| with_line_breaks_of_windows(text).map(|text| (*file, text))).collect();
    if let Some(broken) = broken {
        let again = read(&broken.iter().map(|(file, text)| (*file, text.as_str())).collect::<Vec<_>>());
        let both = [&campaign, &again].map(|read| read.as_ref().ok().map(|read| (&read.robot, &read.data, read.noise)));
        assert_same("with other line breaks", &both[0], &both[1]);
    }
    campaign.map(|campaign| used(&campaign))
}

/// What is asked of a campaign that was read. Few rows say little, and are refused; they
/// must not panic.
fn used(campaign: &Campaign) {
    assert!(campaign.check().is_ok(), "what was read is refused: {:?}", campaign.check());
    let rows = match &campaign.data {
        Data::Displacement(data) => data.rows.len(),
        Data::Position(data) => data.rows.len(),
        Data::Clamped(rows) => rows.len(),
    };
    if rows > MOST_ROWS || campaign.robot.joints.len() > 2 {
        return;
    }
    let triage = triage(campaign);
    assert!(triage.asked().all(|(_, finding)| !finding.said.is_empty()), "{triage:?}");
    let refused = [predict(&campaign.robot, campaign).err(), identify(campaign).err()];
    for refused in refused.into_iter().flatten() {
        assert!(!refused.to_string().is_empty());
    }
}
