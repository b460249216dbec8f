//! What came of the matrix, for people (Markdown) and for programs (CSV).

use std::fmt::Write as _;

use super::case::Group;
use super::interval::interval;
use super::run::Record;
use crate::judge_tracing::{Held, within};
use crate::simulator::Hidden;

/// The table of all records, a line a group and some for several together.
pub fn markdown(records: &[Record]) -> String {
    let mut text = String::from(
        "| hidden | runs | as expected | named | alone | a wrong name | misled | verdicts A/E/P/U/I | unseen | elsewhere | numbers in 95 % | joints in 95 % |\n\
         |---|---:|---|---|---|---|---|---|---:|---:|---|---|\n",
    );
    let mut add = |name: &str, chosen: Vec<&Record>| {
        if !chosen.is_empty() {
            text += &row(name, &chosen);
        }
    };
    let of = |group: Group| records.iter().filter(|record| record.ready.case.group == group).collect::<Vec<_>>();
    for group in super::groups() {
        add(group.name(), of(group));
    }
    let ones = |record: &&Record| matches!(record.ready.case.group, Group::One(_));
    add("**all of one**", records.iter().filter(ones).collect());
    let outside = |record: &&Record| matches!(record.ready.case.group, Group::Outside(_));
    add("**all outside**", records.iter().filter(outside).collect());
    add("**all**", records.iter().collect());
    text + "\n\
        As expected: named, or nothing named where nothing can be seen, or no whole truth told, neither names nor that nothing is missing, of what is outside the catalogue; \
        of the runs of which something is expected. Named, alone: of the runs whose effects matter, up to aliases; \
        beside something outside the catalogue, the effect. \
        A wrong name, misled (names that are not the truth told as the whole of it, or nothing told to be missing where \
        something hidden shows): of all runs. \
        Brackets: 95 % (Clopper, Pearson). Verdicts: adequate, explained, partial, unexplained, insufficient. \
        Unseen: rms over runs of the error after on poses the fit has not seen, over that of noise alone. \
        Elsewhere: share of runs in which the description's own error on other poses would add no more than 3 % to noise.\n"
}

fn row(name: &str, records: &[&Record]) -> String {
    let share = |right: usize, all: usize| {
        let [low, high] = interval(right, all);
        if all == 0 { String::from("-") } else { format!("{right}/{all} [{:.0}-{:.0} %]", 100.0 * low, 100.0 * high) }
    };
    let expected: Vec<bool> = records.iter().filter_map(|record| record.is_as_expected()).collect();
    let matters: Vec<_> = records.iter().filter(|record| record.has_a_name_to_find()).collect();
    let count = |of: &dyn Fn(&Record) -> bool| records.iter().filter(|record| of(record)).count();
    let verdicts = ["adequate", "explained", "partial", "unexplained", "insufficient"].map(|verdict| {
        count(&|record| record.told.as_ref().is_some_and(|told| told.verdict.to_string() == verdict)).to_string()
    });
    let held = |of: &dyn Fn(&Record) -> &[Held]| {
        let all =
            records.iter().map(|record| within(of(record))).fold((0, 0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
        share(all.0, all.1)
    };
    let unseen: Vec<f64> =
        records.iter().map(|record| record.unseen.powi(2)).filter(|square| square.is_finite()).collect();
    format!(
        "| {name} | {} | {} | {} | {} | {} | {} | {} | {:.3} | {} | {} | {} |\n",
        records.len(),
        share(expected.iter().filter(|right| **right).count(), expected.len()),
        share(matters.iter().filter(|record| record.judgement.right).count(), matters.len()),
        share(matters.iter().filter(|record| record.judgement.alone).count(), matters.len()),
        share(count(&|record| !record.judgement.wrong.is_empty()), records.len()),
        share(count(&Record::misleads), records.len()),
        verdicts.join("/"),
        (unseen.iter().sum::<f64>() / unseen.len() as f64).sqrt(),
        share(count(&|record| record.elsewhere.hypot(1.0) <= 1.03), records.len()),
        held(&|record| &record.numbers),
        held(&|record| &record.joints),
    )
}

/// All classes that a probability is reported of, a line each.
pub fn claims_csv(records: &[Record]) -> String {
    let mut text = String::from("group,replicate,seed,hidden,verdict,class,probability,right,why_not\n");
    for record in records {
        let case = &record.ready.case;
        let hidden: Vec<String> = record.ready.scenario.hidden.iter().map(Hidden::name).collect();
        let verdict = record.told.as_ref().map_or(String::new(), |told| told.verdict.to_string());
        for claim in &record.claims {
            writeln!(
                text,
                "{},{},{},{},{verdict},{},{:.6},{},\"{}\"",
                case.group.name(),
                case.replicate,
                case.seed,
                hidden.join(" + ").replace(',', "-"),
                claim.name.replace(',', "-"),
                claim.probability,
                claim.is_right,
                claim.why_not.as_deref().unwrap_or_default()
            )
            .expect("a string takes all that is written to it");
        }
    }
    text
}

/// All records, a line each.
pub fn csv(records: &[Record]) -> String {
    let mut text = String::from(
        "group,replicate,seed,arm,shares_unloaded,rotations,noise_um,hidden,left,expected,verdict,names,\
         right,alone,wrong,misled,unseen,elsewhere,numbers_in,numbers,joints_in,joints,seconds\n",
    );
    for record in records {
        let (ready, case) = (&record.ready, &record.ready.case);
        let hidden: Vec<String> =
            ready.scenario.hidden.iter().map(|hidden| format!("{} {hidden:?}", hidden.name())).collect();
        let left: Vec<String> = ready.left.iter().map(|left| format!("{left:.2}")).collect();
        let told = record.told.as_ref();
        let names = told.map_or_else(Vec::new, |told| {
            told.names.iter().map(|name| format!("{} = [{}]", name.name, name.same_as.join("; "))).collect()
        });
        let judged = &record.judgement;
        let cells = [
            case.group.name().to_string(),
            case.replicate.to_string(),
            case.seed.to_string(),
            ready.declared.name.clone(),
            ready.scenario.shares_unloaded.to_string(),
            case.rotations.to_string(),
            format!("{:.2}", 1e6 * ready.scenario.noise),
            hidden.join(" + "),
            left.join(" + "),
            format!("{:?}", ready.expected),
            told.map_or_else(|| "failed".into(), |told| told.verdict.to_string()),
            names.join(" + "),
            judged.right.to_string(),
            judged.alone.to_string(),
            judged.wrong.join(" + "),
            record.misleads().to_string(),
            format!("{:.4}", record.unseen),
            format!("{:.4}", record.elsewhere),
            within(&record.numbers).0.to_string(),
            record.numbers.len().to_string(),
            within(&record.joints).0.to_string(),
            record.joints.len().to_string(),
            format!("{:.2}", record.seconds),
        ];
        line(&mut text, cells);
    }
    text
}

/// All numbers with an interval, a line each.
pub fn numbers_csv(records: &[Record]) -> String {
    let mut text = String::from("group,replicate,verdict,number,value,std,truth,within\n");
    for record in records {
        let (case, told) = (&record.ready.case, record.told.as_ref());
        let verdict = told.map_or_else(String::new, |told| told.verdict.to_string());
        for held in record.numbers.iter().chain(&record.joints) {
            let cells = [
                case.group.name().to_string(),
                case.replicate.to_string(),
                verdict.clone(),
                held.name.clone(),
                format!("{:e}", held.value),
                format!("{:e}", held.std),
                format!("{:e}", held.truth),
                held.is_within().to_string(),
            ];
            line(&mut text, cells);
        }
    }
    text
}

/// A line of cells, quoted where they have to be.
fn line<const N: usize>(text: &mut String, cells: [String; N]) {
    let quoted =
        cells.map(|cell| if cell.contains([',', '"']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell });
    writeln!(text, "{}", quoted.join(",")).expect("a string takes all that is written to it");
}
