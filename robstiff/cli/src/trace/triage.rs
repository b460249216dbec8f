//! What the readings say before any model, for a terminal, `trace.json` and the
//! report.

use robstiff::triage::{Answer, Check, Finding, LEVEL, Triage};
use serde_json::{Value, json};

use crate::json::number;
use crate::report::content;
use crate::text::{Table, and, probability, significant};

/// The answers for a terminal.
pub fn page(triage: &Triage) -> String {
    let mut page = String::from("Before any model, the readings themselves:\n");
    let mut table = Table::new(2, ["", "check", "found", "p"]);
    for (check, finding) in triage.asked() {
        let mark = if finding.violated { "!" } else { "" };
        let p = finding.adjusted.map_or_else(|| "-".to_owned(), probability);
        table.row([mark.to_owned(), check.name.to_owned(), found(finding), p]);
    }
    page += &format!("{table}  (p: of noise alone, all checks counted; ! beyond {LEVEL} and large enough to matter)\n");
    for (_, finding) in triage.violated() {
        page += &format!("{}\n", finding.said);
    }
    for outlier in &triage.outliers {
        page += &format!("Does not belong: {outlier}.\n");
    }
    // Checks with one need in common are told together.
    let mut needs: Vec<(&str, Vec<String>)> = Vec::new();
    for check in &triage.checks {
        let Answer::NotAsked(need) = &check.answer else { continue };
        match needs.iter_mut().find(|(known, _)| known == need) {
            Some((_, names)) => names.push(check.name.to_owned()),
            None => needs.push((need, vec![check.name.to_owned()])),
        }
    }
    if !needs.is_empty() {
        page += "These data cannot be asked about\n";
    }
    for (need, names) in needs {
        page += &format!("  {}; that needs {need}\n", and(&names));
    }
    page + "\n"
}

fn found(finding: &Finding) -> String {
    format!("{} {}", significant(finding.statistic, 3), finding.unit)
}

/// The answers for other programs.
pub fn document(triage: &Triage) -> Value {
    let check = |check: &Check| match &check.answer {
        Answer::NotAsked(needs) => {
            json!({"name": check.name, "question": check.question, "asked": false, "needs": needs})
        }
        Answer::Asked(finding) => json!({
            "name": check.name,
            "question": check.question,
            "asked": true,
            "statistic": number(finding.statistic),
            "unit": finding.unit,
            "p_value": finding.p_value.map(number),
            "p_adjusted": finding.adjusted.map(number),
            "matters_from": number(finding.matters_from),
            "violated": finding.violated,
            "witnesses": finding.witnesses,
            "said": finding.said,
        }),
    };
    json!({
        "level": LEVEL,
        "reading_um": triage.reading.map(|reading| number(reading * 1e6)),
        "checks": triage.checks.iter().map(check).collect::<Value>(),
        "outliers": triage.outliers,
    })
}

/// A check for the report.
pub fn check(check: &Check) -> content::Check {
    let (name, question) = (check.name.to_owned(), check.question.to_owned());
    match &check.answer {
        Answer::NotAsked(needs) => content::Check {
            name,
            question,
            state: content::State::NotAsked,
            found: String::new(),
            p_value: None,
            said: format!("Needs {needs}."),
        },
        Answer::Asked(finding) => content::Check {
            name,
            question,
            state: if finding.violated { content::State::Violated } else { content::State::Holds },
            found: found(finding),
            p_value: finding.adjusted,
            said: finding.said.clone(),
        },
    }
}
