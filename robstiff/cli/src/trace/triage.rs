//! What the readings say before any model, for a terminal, `trace.json` and the
//! report.

use robstiff_identify::triage::{Answer, Check, Finding, LEVEL, Triage};
use serde_json::{Value, json};

use crate::json::number;
use crate::report::content;
use crate::text::{Table, and, count, probability, significant};

/// The answers for a terminal: what fails, and the rest in a sentence each.
pub fn page(triage: &Triage) -> String {
    let mut page = String::from("Before any model, the readings themselves:\n");
    let mut table = Table::new(1, ["check", "found", "p"]);
    for (check, finding) in triage.violated() {
        let p = finding.adjusted.map_or_else(|| "-".to_owned(), probability);
        table.row([format!("{} fails", check.name), found(finding), p]);
    }
    if triage.violated().next().is_some() {
        page += &table.to_string();
    }
    for (_, finding) in triage.violated() {
        page += &format!("  {}\n", finding.said);
    }
    let holds: Vec<String> =
        triage.asked().filter(|(_, finding)| !finding.violated).map(|(check, _)| check.name.to_owned()).collect();
    if !holds.is_empty() {
        page += &format!("  {} {}.\n", and(&holds), if holds.len() == 1 { "holds" } else { "hold" });
    }
    for outlier in &triage.outliers {
        page += &format!("  Does not belong: {outlier}.\n");
    }
    let not_asked = triage.checks.len() - triage.asked().count();
    if not_asked > 0 {
        page += &format!("  {} other data than these; the report says which.\n", needing(not_asked));
    }
    page + "\n"
}

/// `3 checks need`, `1 check needs`.
fn needing(number: usize) -> String {
    format!("{} need{}", count(number, "further check"), if number == 1 { "s" } else { "" })
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
