//! What the report shows of a tracing.

use robstiff_identify::campaign::Campaign;
use robstiff_identify::trace::{
    EffectParameter, Estimate, Misfit, NamedEffect, RowResidual, Suspected, Trace, Verdict, Visibility,
};
use robstiff_identify::triage::Triage;

use super::doubts::doubts;
use super::pose_errors::errors;
use super::{finding, pictures, wording};
use crate::failure::Failure;
use crate::report::content::{
    Compliance, Effect, Next, Number, ProbableSet, Repeated, Report, Residual, Stage, Unexplained,
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
    triage: &Triage,
    campaign: &Campaign,
    seed: u64,
) -> Result<Report, Failure> {
    let terms = Terms::of(campaign);
    Ok(Report {
        robot: trace.robot.clone(),
        description: campaign.robot.description.trim().to_owned(),
        campaign: about(campaign),
        headline: finding::headline(trace, campaign),
        summary,
        verdict: trace.verdict.to_string(),
        conclusive: matches!(trace.verdict, Verdict::Adequate | Verdict::Explained),
        terms,
        rows: trace.rows,
        poses: trace.poses,
        checks: triage.checks.iter().map(super::triage::check).collect(),
        outliers: super::triage::strays(triage).map(|stray| stray.said.clone()).collect(),
        reading_um: trace.noise * 1e6,
        noise_um: wording::noise(trace, campaign) * 1e6,
        noise_source: wording::source_of(trace.noise_source).to_owned(),
        unseen: wording::unseen(trace, terms),
        stages: stages(trace),
        effects: trace.effects.iter().map(|one| named(trace, one)).collect(),
        suspected: trace.suspected.iter().map(|one| suspected(trace, one)).collect(),
        doubts: doubts(trace),
        compliances: compliances(trace),
        errors: errors(trace, campaign)?,
        // Those of clamped axes are no vectors.
        residuals: trace.residuals.iter().filter(|_| trace.components == 3).map(residual).collect(),
        arms: pictures::arms(trace, campaign),
        dependences: pictures::dependences(trace, campaign),
        sets: trace.sets.iter().map(set).collect(),
        repeated: repeated(trace),
        unexplained: Unexplained { fraction: trace.unexplained, depends_on: trace.depends_on.clone() },
        next: trace
            .next
            .iter()
            .map(|next| Next {
                pose: wording::pose(next, &campaign.robot.joints),
                load: wording::load(next),
                separates: next.separates.each_ref().map(|name| spoken(name)),
            })
            .collect(),
        warnings: campaign.warnings.clone(),
        origins: origins(trace, campaign, seed),
    })
}

/// What the campaign calls itself, when it was measured and by whom.
fn about(campaign: &Campaign) -> String {
    let by = if campaign.operator.is_empty() { String::new() } else { format!("measured by {}", campaign.operator) };
    let parts = [campaign.name.clone(), campaign.date.clone(), by];
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
}

fn stages(trace: &Trace) -> Vec<Stage> {
    let stage = |name: &str, remark: &str, misfit: &Misfit| Stage {
        name: name.to_owned(),
        remark: remark.to_owned(),
        rms_um: misfit.rms * 1e6,
        holdout_rms_um: misfit.holdout_rms * 1e6,
    };
    let mut stages = vec![
        stage("As declared", "the description as it came", &trace.declared),
        stage("Identified", "the same model, its numbers fitted again", &trace.identified),
    ];
    let in_doubt = trace.suspected.len();
    if trace.effects.len() + in_doubt > 0 {
        let mut remark = count(trace.effects.len(), "effect");
        if in_doubt > 0 {
            remark += &format!(" and {in_doubt} suspected");
        }
        stages.push(stage("With effects", &(remark + ", everything fitted again"), &trace.after));
        let remark = "what the description takes, faults of the measurement corrected for";
        stages.push(stage("As written", remark, &trace.written));
    }
    stages
}

fn named(trace: &Trace, named: &NamedEffect) -> Effect {
    Effect {
        name: named.effect.to_string(),
        words: named.effect.words() + &wording::lines(named),
        explanation: named.effect.explanation().to_owned(),
        of_rig: named.effect.is_of_rig(),
        written: wording::is_written(trace, &named.effect),
        numbers: wording::reported(&named.effect).map(number).collect(),
        probability: wording::probability(named.probability),
        recurs: recurs(trace, named.recurs),
        holdout_rms_um: named.holdout_rms * 1e6,
        same_as: wording::alternatives(&named.class),
        why_not: String::new(),
    }
}

fn suspected(trace: &Trace, suspected: &Suspected) -> Effect {
    Effect {
        name: suspected.effect.to_string(),
        words: suspected.effect.words(),
        explanation: suspected.effect.explanation().to_owned(),
        of_rig: suspected.effect.is_of_rig(),
        written: wording::is_written(trace, &suspected.effect),
        numbers: wording::reported(&suspected.effect).map(number).collect(),
        probability: wording::probability(suspected.probability),
        recurs: recurs(trace, suspected.recurs),
        // An effect that was not named has no part in the way from the joints to the last model.
        holdout_rms_um: f64::NAN,
        same_as: wording::alternatives(&suspected.class),
        why_not: suspected.why_not.clone(),
    }
}

/// In how many of the repeated searches an effect is back; empty where none was.
fn recurs(trace: &Trace, share: f64) -> String {
    if wording::is_repeated(trace) { wording::share(share) } else { String::new() }
}

fn set((names, p): &(Vec<String>, f64)) -> ProbableSet {
    ProbableSet { names: names.clone(), probability: wording::probability(*p) }
}

fn repeated(trace: &Trace) -> Repeated {
    let share = |(name, share): &(String, f64)| (name.clone(), wording::share(*share));
    Repeated { folds: trace.nested.folds, names: trace.nested.names.iter().map(share).collect() }
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

fn residual(row: &RowResidual) -> Residual {
    Residual { before: row.before.map(|metres| metres * 1e6), after: row.after.map(|metres| metres * 1e6) }
}

fn origins(trace: &Trace, campaign: &Campaign, seed: u64) -> Vec<(String, String)> {
    let mut origins =
        vec![("Campaign", campaign.path.display().to_string()), ("Robot", campaign.robot_path.display().to_string())];
    if !campaign.robot.source.trim().is_empty() {
        origins.push(("Source of the description", campaign.robot.source.trim().to_owned()));
    }
    if !trace.held_out.is_empty() {
        origins.push(("Poses held out", trace.held_out.join(", ")));
    }
    if wording::is_repeated(trace) {
        origins.push(("Search", format!("repeated {} times, seed {seed}", trace.nested.folds)));
    }
    origins.push(("Program", format!("robstiff {}", env!("CARGO_PKG_VERSION"))));
    origins.into_iter().map(|(name, text)| (name.to_owned(), text)).collect()
}
