use nalgebra::{Matrix4, Rotation3, Vector3};
use proptest::prelude::*;

use super::{Chain, Motion, Tree};
use crate::{Description, Diagnostics, JointKind, Placement};

const ARM: &str = include_str!("arm.urdf");

/// One turn and one shift after the other: the table's own meaning.
fn by_table(robot: &Description, q: &[f64]) -> Matrix4<f64> {
    let turn = |axis: Vector3<f64>, angle: f64| Rotation3::new(axis * angle).to_homogeneous();
    let placement = |at: &Placement| {
        let [roll, pitch, yaw] = at.rpy;
        let turned = turn(Vector3::z(), yaw) * turn(Vector3::y(), pitch) * turn(Vector3::x(), roll);
        Matrix4::new_translation(&Vector3::from(at.xyz)) * turned
    };
    let mut pose = placement(&robot.base);
    for (joint, &q) in robot.joints.iter().zip(q) {
        let (theta, d) = match joint.kind {
            JointKind::Revolute => (joint.theta + q, joint.d),
            JointKind::Prismatic => (joint.theta, joint.d + q),
        };
        pose *= turn(Vector3::z(), theta) * Matrix4::new_translation(&Vector3::new(joint.a, 0.0, d));
        pose *= turn(Vector3::x(), joint.alpha);
    }
    pose * placement(&robot.tool)
}

fn apart(chain: &Chain, robot: &Description, q: &[f64]) -> f64 {
    (by_table(robot, q) - chain.pose(q).to_homogeneous()).abs().max()
}

fn chain(text: &str, tip: Option<&str>) -> Chain {
    let tree = Tree::parse("arm.urdf", text).unwrap_or_else(|problems| panic!("{problems}"));
    tree.chain(None, tip).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Numbers of a table in degrees and millimetres.
fn rows(robot: &Description) -> Vec<[f64; 4]> {
    let round = |value: f64| (value * 1e6).round() / 1e6 + 0.0;
    let row = |joint: &crate::Joint| {
        [joint.theta.to_degrees(), joint.d * 1e3, joint.a * 1e3, joint.alpha.to_degrees()].map(round)
    };
    robot.joints.iter().map(row).collect()
}

#[test]
fn six_axes_become_the_table_a_person_would_write() {
    let chain = chain(ARM, Some("flange"));
    let robot = chain.description();
    assert_eq!(robot.name, "MillingArm180");
    assert_eq!(robot.base, Placement::default());
    assert_eq!(
        rows(&robot),
        [
            [0.0, 780.0, 320.0, -90.0],
            [-90.0, 0.0, 1075.0, 0.0],
            [0.0, 0.0, 200.0, -90.0],
            [0.0, 1392.0, 0.0, 90.0],
            [0.0, 0.0, 0.0, -90.0],
            [180.0, 200.0, 0.0, 0.0],
        ]
    );
    assert_eq!(robot.tool, Placement::default());
    assert_eq!(robot.joints[0].limits, Some([-2.967, 2.967]));
    assert_eq!(robot.joints[5].limits, None);
    assert!(apart(&chain, &robot, &[0.3, -0.4, 0.5, 1.6, -0.7, 0.8]) < 1e-12);
}

#[test]
fn masses_are_those_that_move_with_a_joint() {
    let robot = chain(ARM, Some("cutter_tip")).description();
    let masses: Vec<f64> = robot.links.iter().map(|link| link.mass).collect();
    assert_eq!(masses, [280.0, 160.0, 130.0, 70.0, 30.0, 30.0]);
    // Link 1's own, 0.1 m before the first axis and 0.1 m above 0.78 m; frame 1 is at (0.32, 0, 0.78).
    let [x, y, z] = robot.links[0].center_of_mass;
    assert!((x + 0.22).abs() < 1e-12 && (y + 0.1).abs() < 1e-12 && z.abs() < 1e-12, "{x} {y} {z}");
    // The hand (5 kg, 180 mm along the last axis) with the spindle (25 kg, 150 mm before the flange).
    let along = (5.0 * 0.18 + 25.0 * 0.35) / 30.0;
    let [x, y, z] = robot.links[5].center_of_mass;
    let bare = Description { tool: Placement::default(), ..robot };
    let center = by_table(&bare, &[0.0; 6]) * nalgebra::Vector4::new(x, y, z, 1.0);
    assert!((center.xyz() - Vector3::new(1.712 + along, 0.0, 2.055)).norm() < 1e-12, "{center}");
}

#[test]
fn ends_and_links_are_chosen_or_asked_for() {
    let tree = Tree::parse("arm.urdf", ARM).unwrap();
    let said = tree.chain(None, None).unwrap_err().to_string();
    assert!(said.contains("several ends") && said.contains("`cutter_tip` (behind 6 joints)"), "{said}");
    assert!(said.contains("arm.urdf:4:3"), "{said}");
    let said = tree.chain(None, Some("flang")).unwrap_err().to_string();
    assert!(said.contains("did you mean `flange`?"), "{said}");
    let said = tree.chain(Some("flange"), Some("link_2")).unwrap_err().to_string();
    assert!(said.contains("no chain leads from `flange` down to `link_2`"), "{said}");
    let part = tree.chain(Some("link_2"), Some("link_5")).unwrap();
    assert_eq!(part.joints.len(), 3);
    assert!(apart(&part, &part.description(), &[0.1, 0.2, 0.3]) < 1e-12);
}

/// Editors on Windows begin a file with one.
#[test]
fn a_byte_order_mark_is_no_part_of_the_file() {
    let tree = Tree::parse("arm.urdf", &format!("\u{feff}{ARM}")).unwrap();
    let said = tree.chain(Some("flange"), Some("flang")).unwrap_err().to_string();
    assert!(said.contains("there is no link `flang`") && said.contains("arm.urdf:1:1"), "{said}");
    let said = tree.chain(Some("flange"), Some("flange")).unwrap_err().to_string();
    assert!(said.contains("0 moving joints") && said.contains("arm.urdf:1:1"), "{said}");
}

#[test]
fn what_does_not_move_needs_no_axis() {
    let joint = |kind: &str| {
        let ends = "<parent link=\"a\"/><child link=\"b\"/><axis xyz=\"0 0 0\"/>";
        format!(
            r#"<robot name="x"><link name="a"/><link name="b"/><joint name="j" type="{kind}">{ends}</joint></robot>"#
        )
    };
    for kind in ["fixed", "floating"] {
        Tree::parse("x.urdf", &joint(kind)).unwrap_or_else(|problems| panic!("{problems}"));
    }
    for kind in ["revolute", "continuous", "prismatic"] {
        let said = Tree::parse("x.urdf", &joint(kind)).unwrap_err().to_string();
        assert!(said.contains("the axis has no direction"), "{said}");
    }
}

#[test]
fn a_scara_with_a_slide_is_imported() {
    let text = r#"<robot name="scara"><link name="a"/><link name="b"/><link name="c"/><link name="d"/><link name="e"/>
<joint name="j1" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0 0 0.4"/><axis xyz="0 0 1"/>
  <limit lower="-2" upper="2"/></joint>
<joint name="j2" type="revolute"><parent link="b"/><child link="c"/><origin xyz="0.45 0 0"/><axis xyz="0 0 1"/>
  <limit lower="-2.5" upper="2.5"/></joint>
<joint name="j3" type="prismatic"><parent link="c"/><child link="d"/><origin xyz="0.4 0 0"/><axis xyz="0 0 -1"/>
  <limit lower="0" upper="0.2"/></joint>
<joint name="j4" type="continuous"><parent link="d"/><child link="e"/><axis xyz="0 0 -1"/></joint></robot>"#;
    let chain = chain(text, None);
    let robot = chain.description();
    assert_eq!(robot.joints[2].kind, JointKind::Prismatic);
    assert_eq!(robot.joints[2].limits, Some([0.0, 0.2]));
    for q in [[0.0; 4], [0.3, -1.0, 0.15, 2.0], [-1.5, 2.0, 0.02, -3.0]] {
        assert!(apart(&chain, &robot, &q) < 1e-12, "{}", apart(&chain, &robot, &q));
    }
    assert_eq!(Description::parse("x", &robot.to_yaml()).unwrap(), robot);
}

#[test]
fn mistakes_are_shown_where_they_are() {
    let refused = |from: &str, to: &str| {
        assert!(ARM.contains(from), "{from}");
        Tree::parse("arm.urdf", &ARM.replacen(from, to, 1)).unwrap_err().to_string()
    };
    for (from, to, part) in [
        ("type=\"revolute\"", "type=\"revolut\"", "unknown type of joint `revolut`"),
        ("<child link=\"link_1\"/>", "<child link=\"link_11\"/>", "did you mean `link_1`?"),
        ("xyz=\"0 0 0.78\"", "xyz=\"0 0.78\"", "`xyz` has 2 numbers, 3 expected"),
        ("xyz=\"0 0 0.78\"", "xyz=\"0 0 ${d1}\"", "macro of xacro"),
        ("xyz=\"0 0 0.78\"", "xyz=\"0 0 up\"", "arm.urdf:34:18"),
        ("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 0\"/>", "the axis has no direction"),
        ("lower=\"-2.967\"", "lower=\"9\"", "the lower limit is above the upper"),
        ("lower=\"-2.967\"", "lower=\"-1e16\"", "`-1e16` is no limit of a joint"),
        ("lower=\"-2.967\"", "lower=\"-inf\"", "leave `limit` out, or make it a joint of type `continuous`"),
        ("lower=\"-2.967\"", "lower=\"-170\"", "a URDF file has lengths in m and angles in rad"),
        ("<mass value=\"400\"/>", "<mass value=\"-1\"/>", "the mass is negative"),
        ("xyz=\"0 0 0.78\"", "xyz=\"1\"", "`xyz` has 1 number, 3 expected"),
        ("</robot>", "", "this is not XML: the file ends before its root element does\n  --> arm.urdf:LINES:1"),
        (
            "<axis xyz=\"0 0 1\"/>",
            "<axis xyz=\"0 & 1\"/>",
            "this is not XML: malformed entity reference\n  --> arm.urdf:34:",
        ),
        ("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 & 1\"/>", "`&` and `<` in a text are `&amp;` and `&lt;`"),
        ("<child link=\"link_2\"/>", "<child link=\"link_1\"/>", "hangs on two joints"),
    ] {
        let (said, lines) = (refused(from, to), ARM.lines().count().to_string());
        let part = &part.replace("LINES", &lines);
        assert!(said.contains(part), "{to}: {said}");
    }
    let floating = ARM.replacen("type=\"revolute\"", "type=\"floating\"", 1);
    let said = Tree::parse("arm.urdf", &floating).unwrap().chain(None, Some("flange")).unwrap_err().to_string();
    assert!(said.contains("the joint `joint_1` is floating") && said.contains("arm.urdf:32:3"), "{said}");
    let mimic = ARM.replacen("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\"/><mimic joint=\"joint_1\"/>", 1);
    let said = Tree::parse("arm.urdf", &mimic).unwrap().chain(None, Some("flange")).unwrap_err().to_string();
    assert!(said.contains("the joint `joint_2` follows another one"), "{said}");
}

/// What is misspelt, or there twice, would be left out without a word.
#[test]
fn words_that_nobody_reads_are_told() {
    for (from, to, part) in [
        ("<origin xyz=\"0.32", "<origin XYZ=\"0.32", "`origin` has an unknown attribute `XYZ`\n  --> arm.urdf:39:13"),
        ("<origin xyz=\"0.32", "<orgin xyz=\"0.32", "`joint` has an unknown element `orgin`\n  --> arm.urdf:39:5"),
        ("<origin xyz=\"0.1 0 0.1\"", "<origin xzy=\"0.1 0 0.1\"", "did you mean `xyz`?"),
        ("<axis xyz=\"0 1 0\"/>", "<axes xyz=\"0 1 0\"/>", "did you mean `axis`?"),
        ("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\" dir=\"1\"/>", "it may have `xyz`"),
        ("lower=\"-1.134\"", "lowr=\"-1.134\"", "did you mean `lower`?"),
        ("<mass value=\"280\"", "<Mass value=\"280\"", "did you mean `mass`?"),
        ("<link name=\"flange\"/>", "<Link name=\"flange\"/>", "`robot` has an unknown element `Link`"),
        ("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"0 1 0\"/><axis xyz=\"1 0 0\"/>", "`joint` has a second `axis`"),
        ("<mass value=\"280\"/>", "<mass value=\"280\"/><mass value=\"1\"/>", "`inertial` has a second `mass`"),
        ("<parent link=\"link_1\"/>", "<parent link=\"link_1\"/><parent link=\"link_2\"/>", "a second `parent`"),
        ("<joint name=\"joint_2\"", "<joint name=\"joint_1\"", "the joint `joint_1` is there twice"),
    ] {
        assert!(ARM.contains(from), "{from}");
        let said = Tree::parse("arm.urdf", &ARM.replacen(from, to, 1)).unwrap_err().to_string();
        assert!(said.contains(part), "{to}: {said}");
    }
}

/// What URDF has where nothing is written may not be what was meant.
#[test]
fn axes_and_limits_that_are_left_out_are_told() {
    let warned = |from: &str, to: &str| {
        let tree = Tree::parse("arm.urdf", &ARM.replacen(from, to, 1)).unwrap_or_else(|problems| panic!("{problems}"));
        tree.warnings[0].clone()
    };
    let said = warned("<axis xyz=\"0 1 0\"/>", "");
    assert_eq!(said, "arm.urdf:37: the joint `joint_2` has no `axis`: it is x, as URDF has it");
    let said = warned("lower=\"-1.134\" ", "");
    assert_eq!(said, "arm.urdf:40: the limit of the joint `joint_2` has no `lower`: it is 0, as URDF has it");
    assert_eq!(Tree::parse("arm.urdf", ARM).unwrap().warnings.len(), 1, "rounded angles");
}

#[test]
fn an_axis_may_have_any_length() {
    let arm = ARM.replacen("<axis xyz=\"0 1 0\"/>", "<axis xyz=\"1e308 0 -1e308\"/>", 1);
    let Some(Motion::Axis { axis, .. }) = &Tree::parse("arm.urdf", &arm).unwrap().joints[1].motion else { panic!() };
    assert!((axis.into_inner() - Vector3::new(1.0, 0.0, -1.0).normalize()).norm() < 1e-15, "{axis:?}");
}

/// Programs put elements of their own into a file.
#[test]
fn extensions_and_what_is_not_read_pass() {
    let joint = "<g:axis g:a=\"1\"/><axis xyz=\"0 1 0\"/><dynamics damping=\"1\"/><calibration rising=\"0\"/><mount><axis dir=\"1\"/></mount>\
                 <safety_controller k_velocity=\"1\"/><implicitSpringDamper>1</implicitSpringDamper>";
    let link = "<link name=\"flange\"><visual><origin rpy=\"0 0 0\"/></visual><visual/><collision/><contact/><verbose/></link>\
                <gazebo reference=\"flange\"/><transmission/><material name=\"grey\"/>";
    let arm = ARM.replacen("<axis xyz=\"0 1 0\"/>", joint, 1).replacen("<link name=\"flange\"/>", link, 1).replacen(
        "<robot ",
        "<robot xmlns:g=\"http://g\" ",
        1,
    );
    let tree = Tree::parse("arm.urdf", &arm).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(tree.joints[1].motion, Tree::parse("arm.urdf", ARM).unwrap().joints[1].motion);
}

#[test]
fn angles_that_were_rounded_are_exact_again() {
    for (text, quarters) in [("1.5708", 1.0), ("1.57", 1.0), ("-3.14159", -2.0), ("3.1415926535897931", 2.0)] {
        let arm = ARM.replacen("rpy=\"0 1.5708 0\"", &format!("rpy=\"0 0 {text}\""), 1);
        let tree = Tree::parse("arm.urdf", &arm).unwrap();
        let turn = tree.joints[6].origin.rotation.to_rotation_matrix();
        let exact = Rotation3::new(Vector3::z() * quarters * core::f64::consts::FRAC_PI_2);
        assert!((turn.matrix() - exact.matrix()).abs().max() < 1e-15, "{text}");
    }
    // A unit of the last decimal beside what it would be rounded to, and more decimals than
    // any power of ten.
    let endless = format!("1.{}", "0".repeat(400));
    for (text, angle) in [("1.55", 1.55), ("1.58", 1.58), ("3.13", 3.13), ("1.5709", 1.5709), (&endless, 1.0)] {
        let arm = ARM.replacen("rpy=\"0 1.5708 0\"", &format!("rpy=\"0 0 {text}\""), 1);
        let kept = Tree::parse("arm.urdf", &arm).unwrap();
        assert!((kept.joints[6].origin.rotation.angle() - angle).abs() < 1e-12, "{text}");
    }
}

#[test]
fn rings_and_files_without_links_are_refused() {
    let joint = |parent: &str, child: &str| {
        let ends = format!("<parent link=\"{parent}\"/><child link=\"{child}\"/>");
        format!("<joint name=\"{parent}_{child}\" type=\"fixed\">{ends}</joint>\n")
    };
    let links = ["world", "a", "b", "c"].map(|name| format!("<link name=\"{name}\"/>\n")).concat();
    let file = |joints: &[String]| format!("<robot name=\"ring\">\n{links}{}</robot>", joints.concat());
    let ring = file(&[joint("b", "c"), joint("a", "b"), joint("b", "a")]);
    let said = Tree::parse("ring.urdf", &ring).unwrap_err().to_string();
    assert!(said.contains("the link `b` hangs on itself") && said.contains("ring.urdf:7:1"), "{said}");
    let said = Tree::parse("itself.urdf", &file(&[joint("a", "a")])).unwrap_err().to_string();
    assert!(said.contains("the link `a` hangs on itself"), "{said}");
    let said = Tree::parse("none.urdf", "<robot name=\"x\"></robot>").unwrap_err().to_string();
    assert!(said.contains("the file has no links") && said.contains("none.urdf:1:1"), "{said}");
}

#[test]
fn no_more_problems_are_told_than_anybody_reads() {
    let links = "<link/>\n".repeat(3 * Diagnostics::MOST);
    let problems = Tree::parse("x.urdf", &format!("<robot name=\"x\">\n{links}</robot>")).unwrap_err();
    assert_eq!((problems.iter().count(), problems.may_be_more()), (Diagnostics::MOST, true));
}

/// Turns by quarters, and any others.
fn angle() -> impl Strategy<Value = f64> {
    let quarter = core::f64::consts::FRAC_PI_2;
    prop_oneof![
        4 => prop::sample::select(vec![0.0, quarter, -quarter, 2.0 * quarter]),
        1 => -3.0..3.0_f64,
    ]
}

fn direction() -> impl Strategy<Value = [f64; 3]> {
    prop_oneof![
        3 => prop::sample::select(vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]),
        1 => prop::array::uniform3(-1.0..1.0_f64).prop_filter("a direction", |v| Vector3::from(*v).norm() > 0.2),
    ]
}

/// A joint: how it moves (0 fixed, 1 turning, 2 sliding), axis, place, turn.
type Link = (u8, [f64; 3], [f64; 3], [f64; 3]);

fn link() -> impl Strategy<Value = Link> {
    let length = || prop_oneof![2 => Just(0.0), 1 => Just(0.5), 2 => -1.5..1.5_f64];
    let kind = prop_oneof![1 => Just(0_u8), 5 => Just(1), 2 => Just(2)];
    (kind, direction(), prop::array::uniform3(length()), prop::array::uniform3(angle()))
}

fn urdf(links: &[Link]) -> String {
    let mut text = String::from("<robot name=\"drawn\"><link name=\"l0\"/>");
    for (i, (kind, axis, xyz, rpy)) in links.iter().enumerate() {
        let kind = ["fixed", "continuous", "prismatic"][usize::from(*kind)];
        let words = |numbers: &[f64; 3]| numbers.map(|number| format!("{number:?}")).join(" ");
        let (axis, xyz, rpy) = (words(axis), words(xyz), words(rpy));
        text += &format!(
            "<link name=\"l{}\"/><joint name=\"j{i}\" type=\"{kind}\"><parent link=\"l{i}\"/><child link=\"l{}\"/>\
             <origin xyz=\"{xyz}\" rpy=\"{rpy}\"/><axis xyz=\"{axis}\"/></joint>\n",
            i + 1,
            i + 1
        );
    }
    text + "</robot>"
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_chain_moves_as_its_table(
        links in prop::collection::vec(link(), 1..9),
        q in prop::array::uniform8(-3.0..3.0_f64),
    ) {
        let moving = links.iter().filter(|link| link.0 > 0).count();
        prop_assume!((1..=8).contains(&moving));
        let tree = Tree::parse("drawn.urdf", &urdf(&links)).unwrap();
        let tip = format!("l{}", links.len());
        let chain = tree.chain(Some("l0"), Some(&tip)).unwrap();
        let robot = chain.description();
        let far = robot.joints.iter().map(|joint| joint.d.abs() + joint.a.abs()).fold(1.0, f64::max);
        prop_assert!(apart(&chain, &robot, &q[..moving]) < 1e-10 * far, "{robot:?}");
        let read = Description::parse("drawn.yaml", &robot.to_yaml()).unwrap();
        prop_assert!(apart(&chain, &read, &q[..moving]) < 1e-9 * far);
    }
}

/// As many repetitions of a part as make a megabyte or two, in a robot. The test is not timed: a reader
/// whose time grows faster than the text does not come to its end.
fn full_of(part: impl Fn(usize) -> String) -> String {
    format!("<robot name=\"r\">\n{}</robot>\n", (0..20_000).map(part).collect::<String>())
}

fn joint(kind: &str, name: usize, parent: usize, child: usize) -> String {
    format!(
        "<joint name=\"j{name}\" type=\"{kind}\"><parent link=\"l{parent}\"/><child link=\"l{child}\"/>\
         <axis xyz=\"0 0 1\"/></joint>\n"
    )
}

/// Links on each other in any way, in a time that grows with their number.
#[test]
fn a_tree_may_be_large() {
    let link = |index: usize| format!("<link name=\"l{index}\"/>\n");
    let tree = |kind: &str, parent: fn(usize) -> usize| {
        full_of(|i| link(i) + &if i > 0 { joint(kind, i, parent(i), i) } else { String::new() })
    };
    let told = |text: &str| match Tree::parse("r.urdf", text) {
        Ok(tree) => tree.chain(None, None).unwrap_err().to_string(),
        Err(problems) => problems.to_string(),
    };
    for (parent, expected) in [
        ((|i| i - 1) as fn(usize) -> usize, "19999 moving joints between `l0` and `l19999`"),
        (|_| 0, "the tree has several ends"),
        (|i| i / 2, "the tree has several ends"),
    ] {
        let said = told(&tree("continuous", parent));
        assert!(said.contains(expected) && said.len() < 5000, "{} {said}", said.len());
        let said = told(&tree("fixed", parent));
        assert!(said.contains("nothing moves behind this link"), "{said}");
    }
    // A ring of all of them, rings of two, and none of a ring but hanging on one.
    let said = told(&tree("fixed", |i| i - 1).replace("</robot>", &(joint("fixed", 0, 19_999, 0) + "</robot>")));
    assert!(said.contains("the link `l1` hangs on itself, in a ring of joints"), "{said}");
    let said = told(
        &full_of(|i| link(i) + &joint("fixed", i, i ^ 1, i))
            .replace("l1\"/><child link=\"l0", "l2\"/><child link=\"l0"),
    );
    assert!(said.contains("the link `l2` hangs on itself"), "{said}");
}

/// What is wrong everywhere is said a hundred times, and looked up as often.
#[test]
fn a_tree_may_be_wrong_everywhere() {
    let wrong: [&dyn Fn(usize) -> String; 8] = [
        &|_| "<link name=\"l\"/>".to_owned(),
        &|_| "<link/>".to_owned(),
        &|index| format!("<link name=\"l{index}\"><inertial><mass value=\"x\"/></inertial></link>"),
        &|index| joint("fixed", index, index, index + 1),
        &|index| joint("continuous", 1, index, index),
        &|_| "<jiont/><origin/><origin/>\n".to_owned(),
        &|index| if index < 10_000 { "<a/>\n".to_owned() } else { "<link/>\n".to_owned() },
        &|_| "<joint name=\"j\"><!-- don't --></joint>\n".to_owned(),
    ];
    for part in wrong {
        let text = full_of(part);
        let problems = Tree::parse("r.urdf", &text).unwrap_err();
        assert_eq!(problems.iter().count(), Diagnostics::MOST, "{}", &text[..200]);
    }
    // Of each of which only the first of its kind counts, behind many others.
    let inside = format!("<a/>{0}{0}", "<origin xyz=\"0 0 0\"/>".repeat(30_000));
    let text = full_of(|index| if index == 0 { format!("<joint>{inside}</joint>") } else { String::new() });
    assert_eq!(Tree::parse("r.urdf", &text).unwrap_err().iter().count(), Diagnostics::MOST);
}

#[test]
fn an_element_has_no_thousand_attributes() {
    let many: String = (0..60_000).map(|index| format!(" a{index}=\"1\"")).collect();
    let told = Tree::parse("r.urdf", &format!("<robot>\n<link{many}/></robot>")).unwrap_err().to_string();
    assert!(told.starts_with("error: more than 1000 attributes of an element\n --> r.urdf:2:1\n"), "{told}");
    let nested = |index: usize| format!("<a xmlns:n{index}=\"n\">");
    let told = Tree::parse("r.urdf", &full_of(nested)).unwrap_err().to_string();
    assert!(told.starts_with("error: more than 1000 declarations of namespaces\n"), "{told}");
    // In comments and texts are no attributes.
    let marks = "=".repeat(2000);
    let text = format!("<robot name=\"r\"><!-- {marks} don't --><link name=\"l{marks}\"/>{marks}</robot>");
    assert!(Tree::parse("r.urdf", &text).is_ok());
}

/// Names that are compared letter by letter would take hours.
#[test]
fn a_name_may_be_long() {
    let [a, b] = ["ab", "ba"].map(|name| name.repeat(100_000));
    let text = format!(
        "<robot name=\"r\"><link name=\"{a}\"/><joint name=\"j\" type=\"fixed\"><parent link=\"{b}\"/></joint></robot>"
    );
    let told = Tree::parse("r.urdf", &text).unwrap_err().to_string();
    assert!(told.contains("error: there is no link `bab") && told.len() < 3000, "{}", told.len());
}

#[test]
fn a_file_has_a_size() {
    let text =
        format!("<robot name=\"r\"><link name=\"l\"/><!-- {} --></robot>", "x".repeat(crate::text::MOST_OF_URDF));
    let told = Tree::parse("r.urdf", &text).unwrap_err().to_string();
    assert!(told.starts_with("error: this text is larger than 16 MiB"), "{told}");
}
