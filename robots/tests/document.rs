//! The document reader as another file format would use it: every place exact.
#![cfg(feature = "read")]

use robstiff_robots::document::{Document, Node};
use robstiff_robots::quantity::Dimension;
use robstiff_robots::{Description, Outline};

/// Where a problem with each of the nodes is shown: line, column, width.
fn places(document: Document, nodes: impl Fn(&Document) -> Vec<Node<'_>>) -> Vec<(usize, usize, usize)> {
    for node in nodes(&document) {
        node.error(format!("problem at {}", node.path()), "");
    }
    let problems = document.finish::<()>(None).unwrap_err();
    problems.iter().map(|problem| (problem.line, problem.column, problem.width)).collect()
}

/// The node and all below it.
fn all<'d>(node: &Node<'d>) -> Vec<Node<'d>> {
    let mut nodes = vec![node.clone()];
    if node.is_map() {
        nodes.extend(node.any_map("").unwrap().fields().flat_map(|(_, field)| all(&field)));
    } else if node.is_sequence() {
        nodes.extend(node.sequence().unwrap().iter().flat_map(all));
    }
    nodes
}

#[track_caller]
fn assert_places(text: &str, expected: &[(usize, usize, usize)]) {
    let document = Document::parse("x.yaml", text).unwrap();
    assert_eq!(places(document, |document| all(&document.root())), expected, "{text}");
}

#[test]
fn places_in_block_style() {
    assert_places(
        "a: 1\nb:\n  c: two words\n  d:\n    - 3\n    - e: 4\n",
        &[(1, 1, 1), (1, 4, 1), (3, 3, 1), (3, 6, 9), (5, 5, 3), (5, 7, 1), (6, 7, 1), (6, 10, 1)],
    );
}

#[test]
fn places_in_flow_style() {
    assert_places(
        "a: {b: [1, 'x, y', {c: \"é]\"}], d: 22}  # comment\n",
        &[(1, 1, 1), (1, 4, 34), (1, 8, 22), (1, 9, 1), (1, 12, 6), (1, 20, 9), (1, 24, 4), (1, 35, 2)],
    );
}

#[test]
fn quotes_that_are_escaped_end_nothing() {
    assert_places(
        r#"{a: "x \"y\" z", b: 'it''s', c: ["\"]", 'a''}', "\\"], d: 1}"#,
        &[(1, 1, 60), (1, 5, 11), (1, 21, 7), (1, 33, 21), (1, 34, 5), (1, 41, 6), (1, 49, 4), (1, 59, 1)],
    );
}

#[test]
fn places_across_lines() {
    assert_places(
        "# first\n\n'k': |\n  long\n  text\nj: >-\n  folded\nf: {x: 1,\n    y: 2}\nw: plain text\n  goes on\n",
        &[(3, 1, 3), (4, 3, 4), (7, 3, 6), (8, 4, 6), (8, 8, 1), (9, 8, 1), (10, 4, 10)],
    );
}

#[test]
fn places_with_other_line_ends_and_a_byte_order_mark() {
    assert_places("\u{feff}a: 1\r\nb: \"µ\"\r\n", &[(1, 1, 1), (1, 4, 1), (2, 4, 3)]);
    let shown = Document::parse("x.yaml", "\u{feff}a: 1\r\nb: 2\r\n").unwrap();
    shown.root().map(&["a"]);
    let told = shown.finish(Some(())).unwrap_err().to_string();
    assert!(told.contains("\n2 | b: 2\n  | ^\n"), "{told}");
}

#[test]
fn what_an_alias_repeats_is_where_the_anchor_is() {
    let text = "a: &x [1 mm]\nb: *x\n";
    assert_places(text, &[(1, 1, 1), (1, 7, 6), (1, 7, 6), (1, 8, 4), (1, 8, 4)]);
}

#[test]
fn a_reader_gets_its_values() {
    let text = "name: loads\nframe: tool\nseed: 7\nnoise: {displacement: 8 um}\nat: [0, 0, 120 mm]\n";
    let document = Document::parse("campaign.yaml", text).unwrap();
    let map = document.root().map(&["name", "frame", "seed", "noise", "at"]).unwrap();
    assert_eq!(map.get("name").unwrap().text(), Some("loads"));
    assert_eq!(map.get("frame").unwrap().choice(&[("base", 0), ("tool", 1)]), Some(1));
    assert_eq!(map.get("seed").unwrap().integer(1), Some(7));
    let noise = map.get("noise").unwrap().map(&["displacement", "rotation"]).unwrap();
    assert_eq!(noise.get("displacement").unwrap().positive(Dimension::Length), Some(8e-6));
    assert!(noise.get("rotation").is_none());
    assert_eq!(map.require("at", "at: tcp").unwrap().quantities(Dimension::Length), Some([0.0, 0.0, 0.12]));
    assert_eq!(document.finish(Some(3)), Ok(3));
}

#[test]
fn hostile_documents_are_refused() {
    let bomb = (0..30)
        .fold("a0: &a0 [x, x]\n".to_owned(), |text, i| text + &format!("a{}: &a{} [*a{i}, *a{i}]\n", i + 1, i + 1));
    let deep = "[".repeat(10_000) + &"]".repeat(10_000);
    for text in
        [bomb.as_str(), deep.as_str(), "{a: *a}", "a: &a [*a]", "\u{0}", "!!binary x: [", "? {a: 1}\n: 2\n? [3]\n"]
    {
        match Document::parse("x.yaml", text) {
            Ok(document) => drop(document.finish(Some(()))),
            Err(problems) => assert!(!problems.to_string().is_empty()),
        }
    }
    let many: String = (0..5000).map(|i| format!("f{i}: 1\n")).collect();
    let document = Document::parse("x.yaml", &many).unwrap();
    document.root().map(&["a"]);
    assert_eq!(document.finish(Some(())).unwrap_err().iter().count(), 100);
}

#[test]
fn what_is_nested_too_deep_is_refused() {
    for open in ["[", "{a: ", "- ", "? "] {
        let text = |count: usize| format!("name: A\nb:\n {}", open.repeat(count));
        let told = Document::parse("deep.yaml", &text(100_000)).map(|_| ()).unwrap_err().to_string();
        assert!(told.starts_with("error: this is nested more than 128 deep\n --> deep.yaml:3:"), "{open}: {told}");
    }
    let by_indentation: String = (0..1000).map(|depth| format!("{}a:\n", " ".repeat(depth))).collect();
    let told = Document::parse("deep.yaml", &by_indentation).map(|_| ()).unwrap_err().to_string();
    assert!(told.contains("nested more than 128 deep\n   --> deep.yaml:129:129"), "{told}");
    let text = format!("name: A\njoints: {}\n", "[".repeat(100_000));
    let told = Document::parse("deep.yaml", &text).unwrap_err().to_string();
    assert!(told.starts_with("error: this is nested more than 128 deep\n --> deep.yaml:2:137"), "{told}");
    assert_eq!(Description::outline(&text), Outline { name: Some("A".into()), joints: None });
}

/// Where it breaks is a line or more behind the bracket that was to be closed.
#[test]
fn a_bracket_that_is_not_closed_is_told_with_its_line() {
    let told = Document::parse("x.yaml", "name: [bench\nrobot: robot.yaml\n").map(|_| ()).unwrap_err().to_string();
    assert!(told.contains(", and the `[` of line 1 is not closed\n --> x.yaml:2:"), "{told}");
}

/// Neither in a text without a last line break nor behind one.
#[test]
fn no_problem_is_behind_the_last_line() {
    for (text, place) in [("a: 1\nb", (2, 1)), ("a: 1\nb\n", (2, 1)), ("a: 1\r\n<", (2, 1))] {
        let problems = Document::parse("x.yaml", text).unwrap_err();
        let problem = problems.iter().next().unwrap();
        assert_eq!((problem.line, problem.column), place, "{text:?}: {problem}");
    }
    let nothing = Document::parse("x.yaml", "# a remark").unwrap();
    assert_eq!(places(nothing, |document| vec![document.root()]), [(1, 1, 0)]);
}
