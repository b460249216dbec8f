//! `robstiff show`: the chain, and what its elasticity amounts to in one pose.

mod page;
mod pose;

use std::path::PathBuf;

use robstiff::analysis::Stiffness;
use robstiff_robots::{Description, JointKind};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::output::{self, Files};
use crate::{effect, input, json};
use pose::Shown;

/// The chain, transform, Jacobian, compliance and stiffness of a robot, and which joint or effect gives how much
#[derive(clap::Args)]
pub struct Arguments {
    /// The robot's description, or the name of a robot in the catalogue
    #[arg(value_name = "ROBOT.yaml")]
    robot: PathBuf,
    #[command(flatten)]
    at: input::At,
    /// Write the same as JSON to FILE
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Shows a robot.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (robot, _) = input::robot(&arguments.robot)?;
    let q = arguments.at.pose(&robot)?;
    let shown = Shown::new(&robot, q);
    let mut files = Files::default();
    files.protect(&arguments.robot);
    if let Some(path) = &arguments.json {
        files.add(path, json::document(&document(&robot, &shown)));
    }
    let said = files.write()?;
    output::print(page::page(&robot, &shown) + &said)
}

/// Everything in SI units; what does not exist is null.
fn document(robot: &Description, shown: &Shown) -> Value {
    let full = shown.stiffness.as_ref().filter(|stiffness| matches!(stiffness, Stiffness::Full(_)));
    let deficient = shown.stiffness.as_ref().filter(|stiffness| matches!(stiffness, Stiffness::Deficient { .. }));
    let matrix = |stiffness: &Stiffness<f64>| json::matrix(stiffness.matrix());
    json!({
        "robot": robot.name,
        "description": robot.description,
        "source": robot.source,
        "convention": robot.convention.word(),
        "joints": robot.joints.iter().map(joint).collect::<Value>(),
        "effects": robot.effects.iter().map(effect).collect::<Value>(),
        "q": json::numbers(shown.q.iter().copied()),
        "transform": json::matrix(&shown.transform),
        "jacobian": json::matrix(&shown.jacobian),
        "compliance": json::matrix(&shown.compliance),
        "rank": shown.stiffness.as_ref().map(Stiffness::rank),
        "stiffness": full.map(matrix),
        "stiffness_pseudo_inverse": deficient.map(matrix),
        "translational_stiffness": shown.translational_stiffness.as_ref().map(json::matrix),
        "principal_directions": shown.principal.iter().map(|direction| json!({
            "direction": json::numbers(direction.unit),
            "compliance_m_per_N": json::number(direction.compliance),
            "stiffness_N_per_m": direction.stiffness,
        })).collect::<Value>(),
        "axis_directions": shown.axes.iter().map(|direction| json!({
            "direction": json::numbers(direction.unit),
            "compliance_m_per_N": json::number(direction.compliance),
            "stiffness_N_per_m": direction.stiffness,
        })).collect::<Value>(),
        "shares": shown.shares.iter().map(|share| json!({
            "element": share.element,
            "translation": share.translation,
            "softest_direction": share.softest,
        })).collect::<Value>(),
    })
}

fn joint(joint: &robstiff_robots::Joint) -> Value {
    let (kind, unit) = match joint.kind {
        JointKind::Revolute => ("revolute", "rad/Nm"),
        JointKind::Prismatic => ("prismatic", "m/N"),
    };
    let parts = joint.compliance.iter().filter(|part| !part.name.is_empty());
    json!({
        "type": kind, "theta": joint.theta, "d": joint.d, "a": joint.a, "alpha": joint.alpha,
        "limits": joint.limits, "compliance": joint.compliance(), "unit": unit,
        "parts": parts.map(|part| json!({"name": part.name, "value": part.value})).collect::<Value>(),
    })
}

fn effect(effect: &robstiff_robots::Effect) -> Value {
    let parameters = effect::parameters(effect).into_iter();
    json!({
        "kind": effect.kind(), "at": effect.place().to_string(), "what": effect::words(effect),
        "explanation": effect.explanation(),
        "parameters": parameters.map(|(name, value, unit)| json!({"name": name, "value": value, "unit": unit}))
            .collect::<Value>(),
    })
}
