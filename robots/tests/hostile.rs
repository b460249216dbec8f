//! Documents that are made to take all the time and memory there is. None of these tests is timed:
//! a reader whose time grows faster than the text does not come to their end.
#![cfg(feature = "read")]

use robstiff_robots::document::Document;
use robstiff_robots::text::MOST_OF_DOCUMENT;
use robstiff_robots::{Description, Outline};

const ARM: &str = "name: Arm\nconvention: standard\njoints: [{a: 1 m, compliance: 1e-7 rad/Nm}]\n";

/// What is said of a text that is no document, and of a robot in it.
fn refused(text: &str) -> String {
    assert!(text.len() <= MOST_OF_DOCUMENT + 1, "{}", text.len());
    let told = Document::parse("x.yaml", text).map(|_| ()).unwrap_err().to_string();
    assert_eq!(Description::parse("x.yaml", text).unwrap_err().to_string(), told);
    told
}

/// As many repetitions of a part as a document holds.
fn full_of(part: impl Fn(usize) -> String) -> String {
    let mut text = String::new();
    for index in 0.. {
        let part = part(index);
        if text.len() + part.len() + 200 > MOST_OF_DOCUMENT {
            break;
        }
        text += &part;
    }
    text
}

#[test]
fn aliases_repeat_no_more_than_a_document_holds() {
    let laughs = |times: usize, lines: usize| -> String {
        let line = |i: usize| format!("a{}: &a{} [{}]\n", i + 1, i + 1, format!("*a{i}, ").repeat(times));
        "a0: &a0 [x, x]\n".to_owned() + &(0..lines).map(line).collect::<String>()
    };
    let long = format!("{ARM}source: &s \"{}\"\nmore: [{}]\n", "x".repeat(60_000), "*s, ".repeat(32_000));
    let squared = |n: usize| format!("a: &a [{}]\nb: &b [{}]\n", "x, ".repeat(n), "*a, ".repeat(n));
    for text in [laughs(9, 9), laughs(2, 30), laughs(900, 3), long, squared(15_000)] {
        let told = refused(&text);
        assert!(told.starts_with("error: aliases repeat more than 1 MiB of this document\n"), "{told}");
        assert!(Description::outline(&text).name.is_none_or(|name| name == "Arm"));
    }
    // As people use them they are read.
    let few = format!("few: &few [1 mm, 2 mm]\nmany: [{}]\n", "*few, ".repeat(1000));
    let document = Document::parse("x.yaml", &few).unwrap();
    let many = document.root().any_map("").and_then(|map| map.get("many")).and_then(|many| many.sequence()).unwrap();
    assert!(many.len() == 1000 && many.iter().all(|few| few.sequence().is_some_and(|few| few.len() == 2)));
}

#[test]
fn aliases_nest_no_deeper_than_brackets() {
    let deep = |levels: usize| -> String {
        "a0: &a0 [x]\n".to_owned()
            + &(0..levels).map(|i| format!("a{}: &a{} [*a{i}]\n", i + 1, i + 1)).collect::<String>()
    };
    assert!(Document::parse("x.yaml", &deep(100)).is_ok());
    assert!(refused(&deep(5000)).starts_with("error: this is nested more than 128 deep"));
    assert!(refused("a: &a [1, *a]\n").contains("what this repeats is not complete yet"));
}

#[test]
fn a_document_has_a_size() {
    let text = |more: usize| format!("{ARM}#{}", "x".repeat(MOST_OF_DOCUMENT - ARM.len() - 1 + more));
    assert!(Description::parse("x.yaml", &text(0)).is_ok());
    assert!(refused(&text(1)).starts_with("error: this document is larger than 1 MiB"));
    assert_eq!(Description::outline(&text(1)), Outline::default());
}

/// Every field is unknown, and every value wrong: each is looked up and said once.
#[test]
fn a_document_may_be_wrong_everywhere() {
    for text in [
        ARM.to_owned() + &full_of(|index| format!("k{index}: 1\n")),
        ARM.to_owned() + &full_of(|_| "k: 1\n".to_owned()),
        ARM.to_owned() + &full_of(|index| format!("{index}: 1\n")),
        format!("{ARM}x: {{{}}}", full_of(|index| format!("k{}: {{a:1}}, ", index % 9))),
        format!("name: A\nconvention: standard\njoints: [{}]", full_of(|_| "{a: x}, ".to_owned())),
        format!("name: A\nconvention: standard\njoints:\n{}", full_of(|_| "- {a: 1, b:2}\n".to_owned())),
        format!("{ARM}base: {{xyz: [{}]}}", full_of(|_| "1,5 m, ".to_owned())),
        format!("{ARM}links: [{}]", full_of(|_| "{mass: -1}, ".to_owned())),
        format!("{ARM}effects:\n{}", full_of(|_| "- {kind: base_compliance, at: base}\n".to_owned())),
        format!(
            "{ARM}effects:\n{}",
            full_of(|index| format!("- {{kind: lost_motion, at: joint {index}, gap: 1, knee: 1}}\n"))
        ),
    ] {
        let problems = Description::parse("x.yaml", &text).unwrap_err();
        assert!((1..=100).contains(&problems.iter().count()), "{}: {problems}", &text[ARM.len()..200]);
        // Nor is what is said a multiple of the text.
        assert!(problems.to_string().len() < MOST_OF_DOCUMENT);
        Description::outline(&text);
    }
}

/// The items of a list are not each to have a name as long as the key of it.
#[test]
fn a_key_may_be_long() {
    let text = format!("{ARM}? \"{}\"\n: [{}]\n", "k".repeat(400_000), "[], ".repeat(100_000));
    let told = Description::parse("x.yaml", &text).unwrap_err().to_string();
    assert!(told.starts_with("error: unknown field `kkk") && told.len() < 3000, "{}", told.len());
}

/// The same text is not parsed for each problem in it.
#[test]
fn a_problem_is_found_without_the_text_before_it() {
    let text = format!("[{}]", full_of(|_| "1, ".to_owned()));
    let document = Document::parse("x.yaml", &text).unwrap();
    let items = document.root().sequence().unwrap();
    assert_eq!(items.iter().map(robstiff_robots::document::Node::line).max(), Some(1));
    items.iter().for_each(|item| item.error(format!("at {}", item.path()), ""));
    let problems = document.finish(Some(())).unwrap_err();
    assert_eq!(problems.iter().count(), 100);
    assert!(problems.to_string().contains("error: at [99]\n --> x.yaml:1:299  ([99])\n"), "{problems}");
}
