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
        checks: [State::Holds, State::Violated, State::AccountedFor, State::NotAsked]
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

/// Without effects the last model of the pictures is that of the table, the joints identified
/// again; what is written may be as declared, where the data cannot tell.
#[test]
fn without_effects_pictures_show_what_their_legend_says() {
    let page = |after: f64| {
        let residuals = vec![Residual { before: [3.0; 3], after: [after; 3] }];
        let arms = vec![Arm { id: "a".into(), points: vec![[0.0; 3], [1.0; 3]], before: [3.0; 3], after: [after; 3] }];
        let dependences = vec![Dependence {
            name: "q1".into(),
            unit: "deg".into(),
            axis: 0,
            share: [0.5, 0.1],
            points: vec![[0.0, 3.0, after]],
        }];
        let errors = ["a", "b"].map(|id| PoseError {
            id: id.to_owned(),
            declared: 90.0,
            identified: 56.2,
            after,
            contribution: 0.0,
            held_out: false,
            wild: false,
        });
        html(&Report { errors: errors.to_vec(), residuals, arms, dependences, noise_um: 1.0, ..Report::default() })
    };
    let shown = page(90.0);
    assert!(shown.contains("declared 90.0 µm, identified 56.2 µm<") && shown.contains("joints identified again"));
    assert_eq!(shown, page(56.2));
}

#[test]
fn readings_that_no_check_could_be_made_on_are_not_praised() {
    let [holds, violated, _, not_asked] = <[Check; 4]>::try_from(hostile().checks).expect("one of each state");
    let said = |checks: &[&Check]| {
        html(&Report { checks: checks.iter().map(|&check| check.clone()).collect(), ..Report::default() })
    };
    let none = said(&[&not_asked, &not_asked]);
    assert!(none.contains("No check of the readings by themselves could be made") && !none.contains("nothing wrong"));
    assert!(said(&[&holds, &not_asked]).contains("show nothing wrong, as far as 1 of 2 checks could be made on them."));
    assert!(said(&[&holds]).contains("show nothing wrong.") && !said(&[&violated]).contains("nothing wrong"));
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
