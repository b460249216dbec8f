//! A plan for a terminal.

use robstiff_identify::campaign::{Campaign, Data};
use robstiff_identify::plan::{Outlook, Pair, Plan};
use robstiff_identify::trace::Trace;

use super::document::columns_of_loads;
use crate::text::{Table, count, decimals, significant};

/// The page.
pub fn page(plan: &Plan, trace: &Trace, campaign: &Campaign) -> String {
    let mut page = format!(
        "{}: {} to measure next, after {} (verdict: {})\n\n",
        trace.robot,
        count(plan.proposals.len(), "pose"),
        trace.poses,
        trace.verdict
    );
    page += &proposals(plan, campaign);
    page += &pairs(plan);
    page += &numbers(plan, campaign);
    page += "\nTaken for granted:\n";
    for said in &plan.assumptions {
        page += &format!("- {said}\n");
    }
    page + "- the loads act and are read where the campaign's are; nothing is known of what the arm could hit\n"
}

fn proposals(plan: &Plan, campaign: &Campaign) -> String {
    let joints = &campaign.robot.joints;
    let columns = columns_of_loads(plan, campaign);
    let mut header = vec!["next".to_owned()];
    header.extend((1..).zip(joints).map(|(number, joint)| format!("q{number} [{}]", joint.people_unit())));
    header.extend(columns.iter().map(|&name| name.to_owned()));
    if !plan.pairs.is_empty() {
        header.push("pair".to_owned());
    }
    let mut table = Table::new(0, header);
    for (index, planned) in (1..).zip(&plan.proposals) {
        let mut row = vec![format!("{index}")];
        row.extend(planned.visit.q.iter().zip(joints).map(|(&q, joint)| decimals(joint.for_people(q), 1)));
        let greatest = match &campaign.data {
            Data::Position(_) => planned.visit.payloads().into_iter().reduce(f64::max).into_iter().collect(),
            Data::Displacement(_) | Data::Clamped(_) => planned.greatest.to_vec(),
        };
        row.extend(greatest.iter().take(columns.len()).map(|&value| decimals(value, 0)));
        row.extend(planned.separates.map(|pair| format!("{}", pair + 1)));
        table.row(row);
    }
    table.to_string()
}

fn pairs(plan: &Plan) -> String {
    if plan.pairs.is_empty() {
        return "\nThe trace has no rivals to tell apart: the poses sharpen the numbers.\n".to_owned();
    }
    let mut table = Table::new(2, ["pair", "to tell apart", "now", "after", "ln Bayes factor"]);
    for (index, pair) in (1..).zip(&plan.pairs) {
        table.row([
            format!("{index}"),
            pair.names.join(" / "),
            decimals(pair.now, 1),
            decimals(pair.after, 1),
            decimals(pair.log_bayes, 1),
        ]);
    }
    let mut page = format!("\nExpected separation [sigmas]\n{table}");
    for pair in &plan.pairs {
        page += &sentences(pair);
    }
    page
}

fn sentences(pair: &Pair) -> String {
    let [one, other] = &pair.names;
    let said = match pair.outlook {
        Outlook::Separable => return String::new(),
        Outlook::Alias => format!("No pose and load can tell {one} from {other}: they show the same"),
        Outlook::Slow(poses) => format!("To tell {one} from {other} takes about {} like these", count(poses, "pose")),
    };
    let mut said = format!("{said}.\n");
    if pair.remedies.is_empty() {
        said += "  No sensor that was tried would do it either.\n";
    }
    for (index, remedy) in pair.remedies.iter().enumerate() {
        let lead = if index == 0 { "  It would take" } else { "  or" };
        let sigmas = remedy.separation.map(|sigmas| format!(" ({} sigmas)", decimals(sigmas, 1)));
        said += &format!("{lead} {}{}\n", remedy.words, sigmas.unwrap_or_default());
    }
    said
}

/// What the numbers are, and why those of `trace` are others.
fn as_against_trace(campaign: &Campaign) -> &'static str {
    match &campaign.data {
        Data::Position(_) => {
            "The standard deviations are as the noise alone makes them; trace has in its own what each pose leaves and \
             what numbers of the table without a name may do, so they are mostly larger."
        }
        Data::Displacement(_) | Data::Clamped(_) => {
            "The values are those of the linear fit that a plan is made with, knees held at the best of a grid; trace \
             fits every number in its own form, knees too, and takes standard deviations from what each pose leaves, \
             so its values differ and its standard deviations are mostly larger."
        }
    }
}

fn numbers(plan: &Plan, campaign: &Campaign) -> String {
    let mut table = Table::new(1, ["number", "value", "sigma now", "after", "factor"]);
    for number in &plan.numbers {
        table.row([
            number.name.clone(),
            format!("{} {}", significant(number.value, 3), number.unit),
            significant(number.now, 2),
            significant(number.after, 2),
            decimals(number.now / number.after, 2),
        ]);
    }
    format!("\nExpected standard deviations, from the noise alone\n{table}{}\n", as_against_trace(campaign))
}
