//! What the readings say before any model, for a terminal, `trace.json` and the
//! report.

use robstiff_identify::triage::{Answer, Check, Finding, LEVEL, Stray, Triage};
use serde_json::{Value, json};

use crate::json::number;
use crate::report::content;
use crate::text::words::spoken;
use crate::text::{Table, and, count, probability, significant};

/// The answers for a terminal: what fails, and the rest in a sentence each.
pub fn page(triage: &Triage) -> String {
    let mut page = String::from("Before any model, the readings themselves:\n");
    let mut table = Table::new(1, ["check", "found", "p"]);
    for (check, finding) in failing(triage) {
        let p = finding.adjusted.map_or_else(|| "-".to_owned(), probability);
        table.row([format!("{} fails", check.name), found(finding), p]);
    }
    if failing(triage).next().is_some() {
        page += &table.to_string();
    }
    for (_, finding) in failing(triage) {
        page += &format!("  {}\n", finding.said);
    }
    let holds: Vec<String> =
        triage.asked().filter(|(_, finding)| !finding.violated).map(|(check, _)| check.name.to_owned()).collect();
    if !holds.is_empty() {
        page += &format!("  {} {}.\n", and(&holds), if holds.len() == 1 { "holds" } else { "hold" });
    }
    for stray in strays(triage) {
        page += &format!("  Does not belong: {}.\n", stray.said);
    }
    let accounted: Vec<(&Check, &Finding)> = triage.violated().filter(|(_, finding)| !is_open(finding)).collect();
    if let Some((_, finding)) = accounted.first() {
        let names: Vec<String> = accounted.iter().map(|(check, _)| check.name.to_owned()).collect();
        let verb = if names.len() == 1 { "fails" } else { "fail" };
        page += &format!("  {} {verb} by the readings themselves, {}.\n", and(&names), accounts(finding));
    }
    let not_asked = triage.checks.len() - triage.asked().count();
    if not_asked > 0 {
        page += &format!("  {} other data than these; the report says which.\n", needing(not_asked));
    }
    page + "\n"
}

/// Whether nothing that was named accounts for a check that fails.
fn is_open(finding: &Finding) -> bool {
    finding.accounted_for_by.is_empty()
}

/// The checks that fail, and nothing that was named accounts for it.
fn failing(triage: &Triage) -> impl Iterator<Item = (&Check, &Finding)> {
    triage.violated().filter(|(_, finding)| is_open(finding))
}

/// The readings that do not belong to the others, whatever was named.
pub fn strays(triage: &Triage) -> impl Iterator<Item = &Stray> {
    triage.outliers.iter().filter(|stray| stray.accounted_for_by.is_empty())
}

/// `accounted for by lost motion of joint 2`.
fn accounts(finding: &Finding) -> String {
    let names: Vec<String> = finding.accounted_for_by.iter().map(|name| spoken(name)).collect();
    format!("accounted for by {}", and(&names))
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
            "accounted_for_by": finding.accounted_for_by,
        }),
    };
    let accounted = triage.outliers.iter().filter(|stray| !stray.accounted_for_by.is_empty());
    json!({
        "level": LEVEL,
        "reading_um": triage.reading.map(|reading| number(reading * 1e6)),
        "checks": triage.checks.iter().map(check).collect::<Value>(),
        "outliers": strays(triage).map(|stray| stray.said.as_str()).collect::<Value>(),
        "outliers_accounted_for": accounted.map(|stray| stray.said.as_str()).collect::<Value>(),
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
            state: match (finding.violated, is_open(finding)) {
                (false, _) => content::State::Holds,
                (true, true) => content::State::Violated,
                (true, false) => content::State::AccountedFor,
            },
            found: found(finding),
            p_value: finding.adjusted,
            said: match is_open(finding) {
                true => finding.said.clone(),
                false => format!("It fails by the readings themselves, {}.", accounts(finding)),
            },
        },
    }
}
