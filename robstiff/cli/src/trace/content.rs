//! What the report shows of a tracing.

use robstiff_identify::campaign::{Campaign, Data};
use robstiff_identify::identify::{Estimate, Visibility, predict};
use robstiff_identify::trace::{
    EffectParameter, NamedEffect, Nested, Options, RowResidual, Step, Tested, Trace, Verdict,
};
use robstiff_identify::triage::Triage;
use robstiff_robots::Description;

use super::doubts::doubts;
use super::{clamped, pictures, story};
use crate::failure::Failure;
use crate::identify::source_of;
use crate::report::content::{
    Candidate, Compliance, Effect, Next, Number, PoseError, Report, Residual, SearchStep, Stage, Structure, Unexplained,
};
use crate::report::terms::Terms;
use crate::text::count;
use crate::text::words::spoken;

/// Brings together what the report shows, with the summary of the trace.
///
/// # Errors
/// What predicting the campaign says against it, which a campaign that was
/// traced does not.
pub fn report(
    (trace, summary): (&Trace, Vec<String>),
    nested: Option<&Nested>,
    triage: &Triage,
    campaign: &Campaign,
    options: &Options,
) -> Result<Report, Failure> {
    let terms = Terms::of(campaign);
    Ok(Report {
        robot: trace.robot.clone(),
        description: campaign.robot.description.trim().to_owned(),
        campaign: campaign.name.clone(),
        headline: story::headline(trace, nested, terms),
        summary,
        verdict: trace.verdict.to_string(),
        settled: matches!(trace.verdict, Verdict::Adequate | Verdict::Explained),
        terms,
        rows: trace.rows,
        poses: trace.poses,
        checks: triage.checks.iter().map(super::triage::check).collect(),
        outliers: super::triage::strays(triage).map(|stray| stray.said.clone()).collect(),
        reading_um: trace.noise * 1e6,
        noise_um: story::noise(trace) * 1e6,
        noise_source: source_of(trace.noise_source).to_owned(),
        unseen: story::unseen(trace, terms),
        stages: stages(trace),
        effects: trace.effects.iter().map(|one| named(trace, one)).collect(),
        doubts: doubts(trace),
        compliances: compliances(trace),
        errors: errors(trace, campaign)?,
        // Those of clamped axes are no vectors.
        residuals: trace.residuals.iter().filter(|_| trace.components == 3).map(residual).collect(),
        arms: pictures::arms(trace, campaign),
        dependences: pictures::dependences(trace, campaign),
        steps: trace.steps.iter().map(step).collect(),
        left: Unexplained {
            fraction: trace.unexplained,
            depends_on: trace.depends_on.clone(),
            tests: trace
                .structure
                .iter()
                .map(|test| Structure { name: test.name.clone(), statistic: test.statistic, p_value: test.p_value })
                .collect(),
        },
        next: trace
            .next
            .iter()
            .map(|next| Next {
                pose: story::pose(next, &campaign.robot.joints),
                load: story::load(next),
                separates: next.separates.each_ref().map(|name| spoken(name)),
            })
            .collect(),
        warnings: campaign.warnings.clone(),
        origins: origins(trace, campaign, options),
    })
}

fn stages(trace: &Trace) -> Vec<Stage> {
    let stage = |name: &str, remark: &str, misfit: &robstiff_identify::trace::Misfit| Stage {
        name: name.to_owned(),
        remark: remark.to_owned(),
        rms_um: misfit.rms * 1e6,
        holdout_rms_um: misfit.holdout_rms * 1e6,
    };
    let mut stages = vec![
        stage("As declared", "the description as it came", &trace.declared),
        stage("Identified", "the same model, its numbers fitted again", &trace.identified),
    ];
    if !trace.effects.is_empty() {
        let number = count(trace.effects.len(), "effect");
        let left_out = match story::left_out(trace).len() {
            0 => String::new(),
            rows => format!(", {} predicted", count(rows, "wild row")),
        };
        let remark = format!("{number}, everything fitted again{left_out}");
        stages.push(stage("With effects", &remark, &trace.after));
    }
    stages
}

fn named(trace: &Trace, named: &NamedEffect) -> Effect {
    Effect {
        name: named.effect.to_string(),
        words: named.effect.words() + &story::lines(named),
        explanation: named.effect.explanation().to_owned(),
        of_rig: named.effect.is_of_rig(),
        written: story::is_written(trace, named),
        numbers: story::told(named).map(number).collect(),
        p_value: named.p_value,
        holdout_rms_um: named.holdout_rms * 1e6,
        same_as: story::either(&[&named.same_as[..], &named.in_part].concat()),
    }
}

fn number(parameter: &EffectParameter) -> Number {
    let EffectParameter { name, value, std, unit } = *parameter;
    Number { name: name.to_owned(), value, std, unit: unit.to_owned() }
}

fn compliances(trace: &Trace) -> Vec<Compliance> {
    let seen = |estimate: &Estimate| {
        (estimate.visibility == Visibility::Seen).then(|| (estimate.value, estimate.std.unwrap_or(f64::NAN)))
    };
    let pairs = trace.estimates_before.iter().zip(&trace.estimates);
    let one = |(before, after): (&Estimate, &Estimate)| Compliance {
        name: before.name.clone(),
        unit: before.unit.to_owned(),
        declared: before.declared,
        identified: seen(before),
        after: seen(after),
    };
    pairs.map(one).collect()
}

/// The errors of every pose, in the campaign's order.
fn errors(trace: &Trace, campaign: &Campaign) -> Result<Vec<PoseError>, Failure> {
    let poses = match &campaign.data {
        Data::Displacement(data) => &data.poses,
        Data::Position(data) => &data.poses,
        Data::Clamped(rows) => return Ok(clamped::errors(trace, campaign, rows)),
    };
    let predict = |robot| predict(robot, campaign).map_err(Failure::about(campaign));
    let declared = predict(&campaign.robot)?;
    let (with, without) = (predict(&trace.description)?, predict(&without_effects(trace, &campaign.robot))?);

    let left_out = story::left_out(trace);
    let mut sums = vec![Sums::default(); poses.len()];
    for (index, residual) in trace.residuals.iter().enumerate() {
        let sum = &mut sums[residual.pose];
        sum.rows += 1;
        sum.wild |= left_out.contains(&residual.line);
        sum.declared += declared.rows[index].error().powi(2);
        sum.identified += mean_square(residual.before);
        sum.after += mean_square(residual.after);
        let (with, without) = (with.rows[index].predicted, without.rows[index].predicted);
        sum.contribution += mean_square(std::array::from_fn(|axis| with[axis] - without[axis]));
    }
    let error = |(id, sum): (&String, &Sums)| PoseError {
        id: id.clone(),
        declared: sum.rms_um(sum.declared),
        identified: sum.rms_um(sum.identified),
        after: sum.rms_um(sum.after),
        contribution: sum.rms_um(sum.contribution),
        held_out: trace.held_out.contains(id),
        wild: sum.wild,
    };
    Ok(poses.iter().zip(&sums).map(error).collect())
}

/// The description that is written without the effects that were named: of those that a robot
/// declares, which are changed in their place, what it declares.
pub(super) fn without_effects(trace: &Trace, robot: &Description) -> Description {
    let mut without = trace.description.clone();
    without.effects.truncate(robot.effects.len());
    for (effect, declared) in without.effects.iter_mut().zip(&robot.effects) {
        if trace.effects.iter().any(|named| story::declared(robot, named) == Some(declared)) {
            *effect = *declared;
        }
    }
    without
}

/// Squares of one axis, summed over the rows of a pose (m^2), how many these are, and whether one
/// was left out as wild.
#[derive(Clone, Default)]
struct Sums {
    rows: usize,
    wild: bool,
    declared: f64,
    identified: f64,
    after: f64,
    contribution: f64,
}

impl Sums {
    fn rms_um(&self, sum: f64) -> f64 {
        (sum / self.rows.max(1) as f64).sqrt() * 1e6
    }
}

fn mean_square(vector: [f64; 3]) -> f64 {
    vector.iter().map(|component| component * component).sum::<f64>() / 3.0
}

fn residual(row: &RowResidual) -> Residual {
    Residual { before: row.before.map(|metres| metres * 1e6), after: row.after.map(|metres| metres * 1e6) }
}

fn step(step: &Step) -> SearchStep {
    let mut candidates: Vec<&Tested> = step.candidates.iter().collect();
    candidates.sort_by(|a, b| b.statistic.unwrap_or(0.0).total_cmp(&a.statistic.unwrap_or(0.0)));
    let candidate = |tested: &&Tested| Candidate {
        name: tested.name.clone(),
        statistic: tested.statistic,
        p_value: tested.p_value,
        left_out_rms_um: tested.left_out_rms.map(|rms| rms * 1e6),
        reason: tested.reason.clone(),
    };
    SearchStep {
        named: step.named.clone(),
        outcome: step.outcome.clone(),
        candidates: candidates.iter().map(candidate).collect(),
    }
}

fn origins(trace: &Trace, campaign: &Campaign, options: &Options) -> Vec<(String, String)> {
    let mut origins =
        vec![("Campaign", campaign.path.display().to_string()), ("Robot", campaign.robot_path.display().to_string())];
    if !campaign.robot.source.trim().is_empty() {
        origins.push(("Source of the description", campaign.robot.source.trim().to_owned()));
    }
    if !trace.held_out.is_empty() {
        origins.push(("Poses held out", trace.held_out.join(", ")));
    }
    let tests = format!("level {}, {} bootstrap draws, seed {}", options.alpha, options.draws, options.seed);
    origins.push(("Tests", tests));
    origins.push(("Program", format!("robstiff {}", env!("CARGO_PKG_VERSION"))));
    origins.into_iter().map(|(name, text)| (name.to_owned(), text)).collect()
}

#[cfg(test)]
mod tests {
    use robstiff_identify::campaign::{ClampedRow, Noise};
    use robstiff_identify::simulate::{Scenario, simulate};
    use robstiff_robots::catalogue;

    use super::*;

    fn robot(effect: &str) -> Description {
        let text = catalogue::find("kuka-kr270-r2700").expect("in the catalogue");
        Description::parse("robot.yaml", &format!("{text}{effect}")).expect("of the catalogue")
    }

    fn traced(robot: Description, data: Data) -> (Trace, Campaign) {
        let nowhere = || std::path::PathBuf::new();
        let campaign = Campaign {
            name: "x".to_owned(),
            path: nowhere(),
            robot_path: nowhere(),
            observations_path: nowhere(),
            robot,
            data,
            noise: Noise::default(),
            holdout: None,
            held_out: Vec::new(),
            warnings: Vec::new(),
        };
        let options = Options { draws: 499, ..Options::default() };
        let trace = robstiff_identify::trace::trace(&campaign, &options, &|_| {}).expect("joints are seen");
        (trace, campaign)
    }

    const PLAN: &str = "\
name: x
seed: 3
poses: {count: 30, floor: 100 mm, column: 600 mm}
visits: 2
ramp: [0.35, 0.7, 1]
force: {bounds: [500 N, 1300 N]}
noise: {displacement: 8 um, stated: no}
";

    /// What is declared and is true no longer is changed in its place, and the change is what
    /// is added.
    #[test]
    fn a_change_of_what_is_declared_adds_something() {
        let measured = robot("");
        let scenario = Scenario::parse("try.yaml", PLAN, &measured).unwrap_or_else(|problems| panic!("{problems}"));
        let data = simulate(&measured, &scenario).expect("it can be measured").data;
        let stale = robot("effects: [{kind: dh_error, at: theta3, value: 0.03 rad}]\n");
        let (trace, campaign) = traced(stale, data);
        assert_eq!(trace.effects.len(), 1, "{}", trace.why);
        assert!(story::is_written(&trace, &trace.effects[0]));
        let without = without_effects(&trace, &campaign.robot);
        assert_eq!(without.effects, campaign.robot.effects);
        assert_ne!(without.effects, trace.description.effects);
        let errors = errors(&trace, &campaign).expect("it was traced");
        assert!(errors.iter().all(|pose| pose.contribution > 1.0));
    }

    /// Of clamped axes as of poses: all that the curve of a gear does, not what the joints alone
    /// could not take up of it.
    #[test]
    fn of_clamped_axes_the_whole_curve_is_added() {
        let robot = robot("");
        let curve = |torque: f64| 2e-7 * torque / (torque / 300.0).hypot(1.0);
        let torques: Vec<f64> = (-10..=10).filter(|k| *k != 0).map(|k| 100.0 * f64::from(k)).collect();
        let mut rows: Vec<ClampedRow> = Vec::new();
        for axis in 1..=robot.joints.len() {
            for (k, &torque) in torques.iter().enumerate() {
                // Rounded as a drawn reading would be off.
                let noise = [3e-7, -4e-7, 1e-7, 5e-7, -5e-7, -2e-7, 2e-7][(3 * k + axis) % 7];
                let more = if axis == 2 { curve(torque) } else { 0.0 };
                let deflection = robot.joints[axis - 1].compliance() * torque + more + noise;
                rows.push(ClampedRow { line: rows.len() + 2, axis, torque, deflection });
            }
        }
        let (trace, campaign) = traced(robot, Data::Clamped(rows));
        assert_eq!(trace.effects[0].effect.to_string(), "stiffness_nonlinearity@joint 2", "{}", trace.why);
        let errors = errors(&trace, &campaign).expect("it was traced");
        let whole = (torques.iter().map(|&torque| curve(torque).powi(2)).sum::<f64>() / torques.len() as f64).sqrt();
        let told = errors.iter().find(|axis| axis.id == "axis 2").expect("it was loaded").contribution;
        assert!((told / (1e6 * whole) - 1.0).abs() < 0.2, "{told} of {}", 1e6 * whole);
        assert!(errors.iter().filter(|axis| axis.id != "axis 2").all(|axis| axis.contribution < 1e-6));
    }
}
