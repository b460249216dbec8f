//! `robstiff identify`: the joints' compliances, from measurements.

use std::path::PathBuf;

use robstiff_identify::campaign::{Campaign, Data, Displacements, Positions};
use robstiff_identify::identify::{
    Estimate, Identification, NoiseSource, Scatter, Visibility, identify, misread, noise_not_used, off_by_one_factor,
};
use robstiff_identify::rounded;
use robstiff_robots::Description;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::output::{self, Files};
use crate::text::words::spoken;
use crate::text::{Table, and, change, count, decimals, is_compliance, micrometres, significant, uncertain};
use crate::{input, json};

/// The compliances that fit a campaign, with their uncertainty
#[derive(clap::Args)]
pub struct Arguments {
    /// The campaign
    #[arg(value_name = "CAMPAIGN.yaml")]
    campaign: PathBuf,
    /// The folder for the description with these compliances, `robot.yaml`
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Write the result as JSON to FILE
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Identifies the compliances.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let campaign = input::campaign(&arguments.campaign)?;
    let mut files = Files::default();
    files.protect_campaign(&campaign);
    let robot = arguments.out.join("robot.yaml");
    files.foresee(arguments.json.iter().chain([&robot]))?;
    files.foresee_robot(&robot, &campaign.robot)?;
    let found = identify(&campaign).map_err(Failure::about(&campaign))?;
    let written = rounded(found.description.clone(), &campaign.robot);
    let written = input::moved(&written, (&campaign.robot, &campaign.robot_path), &arguments.out);
    files.add(robot, written.to_yaml());
    if let Some(path) = &arguments.json {
        files.add(path, json::document(&document(&campaign, &found)));
    }
    let said = files.write()?;
    output::print(page(&campaign, &found) + &said)
}

fn page(campaign: &Campaign, found: &Identification) -> String {
    let mut page = match found.poses {
        0 => format!("{}: {}\n\n", campaign.robot.name, count(found.rows, "row")),
        poses => format!("{}: {} at {}\n\n", campaign.robot.name, count(found.rows, "row"), count(poses, "pose")),
    };
    page += &compliances(&found.estimates);
    page += &unseen(found);
    for said in warnings(campaign, found) {
        page += &format!("\n{said}\n");
    }
    page += &compound(&found.description);
    if let Data::Position(data) = &campaign.data
        && !payloads_vary(data)
    {
        page += "\nno visit has two payloads: only where the arm stands tells these compliances from errors of the \
            table\n";
    }
    if let (Some(declared), Some(rms)) = (found.rms_declared, found.rms) {
        page += &format!("\nerror: {} um as declared, {} um identified", micrometres(declared), micrometres(rms));
        page += &match found.noise {
            Some((noise, source)) => format!("; noise {} um ({})\n", micrometres(noise), source_of(source)),
            None => "\n".to_owned(),
        };
    }
    if let (Some(scatter), Data::Displacement(data)) = (&found.scatter, &campaign.data) {
        page += &noise(scatter, data);
    }
    if !found.left_out.is_empty() {
        let lines: Vec<String> = found.left_out.iter().map(usize::to_string).collect();
        let (s, do_not) =
            if lines.len() == 1 { ("", "does not belong, and has") } else { ("s", "do not belong, and have") };
        page += &format!("line{s} {} {do_not} no part in the fit\n", and(&lines));
    }
    page
}

/// What looks wrong with the files, a sentence each.
fn warnings(campaign: &Campaign, found: &Identification) -> Vec<String> {
    let noise = found.noise.and_then(|noise| noise_not_used(campaign, noise));
    let misread = misread(campaign, found).zip(found.rms).map(|(misread, rms)| misread.sentence(rms));
    off_by_one_factor(campaign, &found.estimates).into_iter().chain(misread).chain(noise).collect()
}

/// Whether some visit has one payload and another.
fn payloads_vary(data: &Positions) -> bool {
    let mut first = vec![None; data.visits.len()];
    data.rows.iter().any(|row| *first[row.visit].get_or_insert(row.payload) != row.payload)
}

/// Sentences on how the readings scatter.
fn noise(scatter: &Scatter, data: &Displacements) -> String {
    let mut said = String::new();
    if data.visits.len() < data.rows.len() {
        let shared = decimals(scatter.shared, 2);
        said += &format!("an unloaded reading has {shared} times the variance of what a row has to itself\n");
    }
    if scatter.growth > 0.0 {
        said += &format!("the noise grows by {} % of the displacement\n", decimals(100.0 * scatter.growth, 1));
    }
    said
}

/// Where a noise is known from.
pub fn source_of(source: NoiseSource) -> &'static str {
    match source {
        NoiseSource::Declared => "as declared",
        NoiseSource::Rounded => "as declared, which is below the step of the readings, and what rounding to it adds",
        NoiseSource::Repetitions => "from repeated readings",
        NoiseSource::Residuals => "from what the model leaves, so at most that",
    }
}

/// The table of compliances, declared against identified.
fn compliances(estimates: &[Estimate]) -> String {
    let mut table = Table::new(1, ["compliance", "declared", "identified", "stiffness", "change", ""]);
    for estimate in estimates {
        let identified = match (&estimate.visibility, estimate.std) {
            (Visibility::Seen, _) if estimate.at_bound => format!("0 {}", estimate.unit),
            (Visibility::Seen, Some(std)) => format!("{} {}", uncertain(estimate.value, std), estimate.unit),
            (Visibility::Seen, None) => format!("{} {}", significant(estimate.value, 4), estimate.unit),
            (Visibility::Unseen, _) => "not seen".to_owned(),
            (Visibility::Confounded(_), _) => "not told apart".to_owned(),
        };
        let changed = estimate.deviation().map(change).unwrap_or_default();
        let stiffness = if estimate.value > 0.0 && is_compliance(estimate.unit) {
            format!("{} {}", significant(estimate.value.recip(), 3), stiffness_unit(estimate.unit))
        } else {
            "-".to_owned()
        };
        table.row([
            estimate.name.clone(),
            significant(estimate.declared, 4),
            identified,
            stiffness,
            changed,
            if estimate.is_noteworthy() { "beyond 25 %".to_owned() } else { String::new() },
        ]);
    }
    table.to_string()
}

fn stiffness_unit(unit: &str) -> &'static str {
    if unit == "m/N" { "N/m" } else { "Nm/rad" }
}

/// Of a number that is zero because it cannot be less. A law of a joint, by its full name,
/// among the effects that go with it has the joint's compliance in it.
pub fn at_bound(name: &str, mut effects: impl Iterator<Item = String>) -> String {
    let is_law =
        |effect: &String| effect.split_once('@').is_some_and(|(kind, place)| LAWS.contains(&kind) && place == name);
    if let Some(law) = effects.find(is_law) {
        return format!("{name} is at its bound 0: its compliance is in the {}", spoken(&law));
    }
    let (what, written) =
        if name.starts_with("joint ") { ("this joint", ", and written as rigid") } else { ("it", "") };
    format!("{name} is at its bound 0{written}: the data do not follow the load on {what}")
}

/// Laws by which a joint gives way, and which may be all that it gives way by.
const LAWS: [&str; 3] = ["stiffness_nonlinearity", "lost_motion", "hysteresis"];

/// Sentences on joints whose compliance is a sum of parts.
fn compound(description: &Description) -> String {
    let joints = (1..).zip(&description.joints).filter(|(_, joint)| joint.compliance.len() > 1);
    joints
        .map(|(number, joint)| {
            let parts: Vec<String> = joint.compliance.iter().map(|part| part.name.clone()).collect();
            format!("\njoint {number}: a load shows the sum of {}, which keep their proportion\n", and(&parts))
        })
        .collect()
}

/// Sentences on what the data cannot see, or see against the load.
fn unseen(found: &Identification) -> String {
    let estimates = &found.estimates;
    let mut said = String::new();
    for estimate in estimates {
        match &estimate.visibility {
            Visibility::Seen if estimate.at_bound => {
                let effects = found.description.effects.iter().map(ToString::to_string);
                said += &format!("\n{}", at_bound(&estimate.name, effects));
            }
            Visibility::Seen => {}
            Visibility::Unseen => {
                said += &format!("\n{} does not show in these data and keeps its value", estimate.name);
            }
            Visibility::Confounded(others) => {
                let others: Vec<String> = others.iter().map(|&other| estimates[other].name.clone()).collect();
                said += &format!(
                    "\n{} cannot be told from {} in these data and keeps its value",
                    estimate.name,
                    and(&others)
                );
            }
        }
    }
    if said.is_empty() { said } else { said + "\n" }
}

fn document(campaign: &Campaign, found: &Identification) -> Value {
    json!({
        "robot": found.description.name,
        "rows": found.rows,
        "poses": found.poses,
        "left_out": found.left_out,
        "noise_um": found.noise.map(|(noise, _)| json::number(noise * 1e6)),
        "scatter": found.scatter.as_ref().map(scatter),
        "declared": {"rms_um": found.rms_declared.map(|rms| json::number(rms * 1e6))},
        "identified": {"rms_um": found.rms.map(|rms| json::number(rms * 1e6))},
        "compliances": numbers(&found.estimates),
        "correlation": json::matrix(&found.correlation),
        "warnings": warnings(campaign, found),
    })
}

fn scatter(scatter: &Scatter) -> Value {
    json!({
        "own_um": json::number(scatter.own * 1e6),
        "own_urad": scatter.rotation.map(|own| json::number(own * 1e6)),
        "shared": json::number(scatter.shared),
        "growth": json::number(scatter.growth),
    })
}

/// The numbers of a description after a fit, for other programs.
pub fn numbers(estimates: &[Estimate]) -> Value {
    estimates.iter().map(|one| number(one, estimates)).collect()
}

fn number(estimate: &Estimate, all: &[Estimate]) -> Value {
    let (seen, others): (_, &[usize]) = match &estimate.visibility {
        Visibility::Seen => ("seen", &[]),
        Visibility::Unseen => ("unseen", &[]),
        Visibility::Confounded(others) => ("confounded", others),
    };
    let others = others.iter().map(|&other| &all[other].name);
    json!({
        "name": estimate.name,
        "declared": json::number(estimate.declared),
        "value": json::number(estimate.value),
        "std": estimate.std.map(json::number),
        "unit": estimate.unit,
        "visibility": seen,
        "at_bound": estimate.at_bound,
        "confounded_with": others.map(String::as_str).collect::<Value>(),
        "deviation": estimate.deviation().map(json::number),
        "noteworthy": estimate.is_noteworthy(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_joint_at_its_bound_may_give_way_by_a_law() {
        let told = |effects: &[&str]| at_bound("joint 2", effects.iter().map(|&effect| effect.to_owned()));
        let others = ["hysteresis@joint 3", "transverse_compliance@joint 2"];
        assert_eq!(
            told(&others),
            "joint 2 is at its bound 0, and written as rigid: the data do not follow the load on this joint"
        );
        let law = told(&[others[0], "lost_motion@joint 2"]);
        assert_eq!(law, "joint 2 is at its bound 0: its compliance is in the lost motion of joint 2");
    }
}
