//! The README's example is a description.
#![cfg(feature = "read")]

use robstiff_robots::Description;

#[test]
fn the_example_reads() {
    let readme = include_str!("../README.md");
    let example = readme.split("```yaml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let robot = Description::parse("README.md", example).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!((robot.joints.len(), robot.effects.len()), (3, 2));
}
