//! The book's example of a description reads, and its table of effects is the
//! catalogue's. With `ROBSTIFF_BLESS=1` the table is written again.
#![cfg(feature = "read")]

use robstiff_robots::Description;
use robstiff_robots::effect::CATALOGUE;
use robstiff_robots::effect::physics::{About, Quantity, Range};
use std::fs;
use std::path::Path;

#[test]
fn the_example_reads() {
    let page = include_str!("../../robstiff/docs/description.md");
    let example = page.split("```yaml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let robot = Description::parse("description.md", example).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!((robot.joints.len(), robot.effects.len()), (3, 2));
}

#[test]
fn the_table_of_effects_is_the_catalogues() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robstiff/docs/description.md");
    let page = fs::read_to_string(&path).unwrap();
    let head = "| effect | at | parameters |\n|---|---|---|\n";
    let (before, rest) = page.split_once(head).expect("a table of effects");
    let (found, after) = rest.split_once("\n\n").expect("an end of the table");
    let expected: Vec<String> = CATALOGUE.iter().map(|about| row(about)).collect();
    if std::env::var_os("ROBSTIFF_BLESS").is_some_and(|value| value == "1") {
        fs::write(&path, format!("{before}{head}{}\n\n{after}", expected.join("\n"))).unwrap();
    } else {
        assert_eq!(found, expected.join("\n"));
    }
}

fn row(about: &About) -> String {
    let parameters = about.parameters.iter().map(|parameter| {
        let unit = match parameter.quantity {
            Quantity::Of(dimension) if dimension.unit().is_empty() => String::new(),
            Quantity::Of(dimension) => format!(" [{}]", dimension.unit()),
            Quantity::Entry => " [m or rad]".to_owned(),
        };
        let range = match parameter.range {
            Range::Any => String::new(),
            Range::NotNegative => ", not negative".to_owned(),
            Range::Positive => ", above 0".to_owned(),
            Range::Whole(most) => format!(", 1 to {most}"),
        };
        let default = parameter.default.map_or(String::new(), |default| format!(", default {default}"));
        format!("`{}`{unit}{range}{default}", parameter.name)
    });
    format!("| `{}` | `{}` | {} |", about.kind, about.at.example(), parameters.collect::<Vec<_>>().join("; "))
}
