use super::content::{
    Arm, Candidate, Check, Compliance, Dependence, Effect, Next, Number, PoseError, Report, Residual, SearchStep,
    Stage, State,
};
use super::html;

/// A report in which every text tries to be markup, and numbers are missing.
fn hostile() -> Report {
    let bad = || "<script>alert(\"a & 'b'\")</script>".to_owned();
    Report {
        robot: bad(),
        description: bad(),
        campaign: bad(),
        headline: bad(),
        summary: vec![bad()],
        verdict: bad(),
        reading_um: f64::NAN,
        noise_um: f64::INFINITY,
        noise_source: bad(),
        unseen: bad(),
        rows: 2,
        poses: 1,
        checks: [State::Holds, State::Violated, State::NotAsked]
            .map(|state| Check {
                name: bad(),
                question: bad(),
                state,
                found: bad(),
                p_value: Some(f64::NAN),
                said: bad(),
            })
            .to_vec(),
        outliers: vec![bad()],
        stages: vec![Stage { name: bad(), remark: bad(), rms_um: f64::NAN, holdout_rms_um: f64::INFINITY }],
        effects: vec![Effect {
            name: bad(),
            words: bad(),
            explanation: bad(),
            of_rig: true,
            written: false,
            numbers: vec![Number { name: bad(), value: f64::NAN, std: None, unit: bad() }],
            p_value: f64::NAN,
            holdout_rms_um: f64::NAN,
            same_as: bad(),
        }],
        compliances: vec![Compliance { name: bad(), unit: bad(), declared: 0.0, identified: None, after: None }],
        errors: vec![PoseError {
            id: bad(),
            declared: f64::NAN,
            identified: f64::NAN,
            after: 0.0,
            contribution: 1.0,
            held_out: true,
            wild: true,
        }],
        residuals: vec![Residual { before: [f64::NAN; 3], after: [0.0; 3] }],
        arms: vec![Arm { id: bad(), points: vec![[f64::NAN; 3]; 3], before: [f64::NAN; 3], after: [1.0; 3] }],
        dependences: vec![Dependence {
            name: bad(),
            unit: bad(),
            axis: 0,
            share: [f64::NAN; 2],
            points: vec![[f64::NAN, 1.0, f64::INFINITY], [0.0; 3]],
        }],
        doubts: vec![bad()],
        steps: vec![SearchStep {
            named: vec![bad()],
            outcome: bad(),
            candidates: vec![Candidate {
                name: bad(),
                statistic: None,
                p_value: f64::NAN,
                left_out_rms_um: None,
                reason: bad(),
            }],
        }],
        next: vec![Next { pose: bad(), load: bad(), separates: [bad(), bad()] }],
        warnings: vec![bad()],
        origins: vec![(bad(), bad())],
        ..Report::default()
    }
}

#[test]
fn no_text_becomes_markup() {
    let page = html(&hostile());
    assert!(!page.contains("<script") && !page.contains("alert(\""));
}

#[test]
fn no_number_becomes_nan() {
    let page = html(&hostile());
    assert!(!page.contains("NaN") && !page.contains("inf\""), "{page}");
}

#[test]
fn nothing_is_loaded_from_elsewhere() {
    for page in [html(&hostile()), html(&Report::default())] {
        let page = page.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
        for part in ["http:", "https:", "src=", "url(", "@import", "<link", "<script"] {
            assert!(!page.contains(part), "{part}");
        }
    }
}
