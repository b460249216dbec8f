//! URDF files.

use nalgebra::SVector;
use robstiff::{Generic, Robot};
use robstiff_robots::Description;
use robstiff_robots::urdf::{Chain, Tree};

use super::accepted::{assert_same, with_line_breaks_of_windows};
use super::descriptions::assert_written;
use super::grammar::Grammar;
use super::refused::assert_places;

pub const GRAMMAR: &Grammar = &[
    (
        "file",
        &[
            "<robot name=\"r\">\n%link0%%link1%%joint1%</robot>\n",
            "<?xml version=\"1.0\"?>\n<robot name=\"%name%\">\n%link0%%link1%%joint1%%link2%%joint2%%extra%</robot>\n",
            "<robot name='r'>\n%joint2%%joint1%%extra%%link2%%link1%%link0%</robot>\n",
            "<!-- %name% --><robot>%link0%%link1%%joint1%%extra%</robot>",
        ],
    ),
    ("name", &["r", "milling_arm", "", "&amp;", "&lt;x&gt;", "&#233;", "&bad;", "-->"]),
    ("link0", &["<link name=\"base\"/>\n", "<link name=\"base\">%inertia%</link>\n"]),
    ("link1", &["<link name=\"l1\"/>\n", "<link name=\"l1\">%inertia%</link>\n"]),
    ("link2", &["<link name=\"l2\"/>\n", "<link name=\"l2\">%inertia%</link>\n", "<link name=\"l1\"/>\n"]),
    (
        "inertia",
        &[
            "<inertial><mass value=\"10\"/></inertial>",
            "<inertial><mass value=\"%number%\"/><origin xyz=\"%xyz%\"/></inertial>",
            "<visual/>",
        ],
    ),
    (
        "joint1",
        &[
            "<joint name=\"j1\" type=\"revolute\"><parent link=\"base\"/><child link=\"l1\"/><limit lower=\"-1\" upper=\"1\"/></joint>\n",
            "<joint name=\"j1\" type=\"%type%\"><parent link=\"base\"/><child link=\"l1\"/>%parts%</joint>\n",
            "<joint name=\"j1\" type=\"%type%\">%parts%<child link=\"l1\"/><parent link=\"base\"/></joint>\n",
        ],
    ),
    (
        "joint2",
        &[
            "<joint name=\"j2\" type=\"continuous\"><parent link=\"l1\"/><child link=\"l2\"/></joint>\n",
            "<joint name=\"j2\" type=\"%type%\"><parent link=\"l1\"/><child link=\"l2\"/>%parts%</joint>\n",
            "<joint name=\"j2\" type=\"revolute\"><parent link=\"%end%\"/><child link=\"%end%\"/>%parts%</joint>\n",
        ],
    ),
    ("end", &["l1", "l2", "base", "nowhere", ""]),
    ("type", &["revolute", "continuous", "prismatic", "fixed", "revolute", "planar", "floating", "", "%odd%"]),
    (
        "parts",
        &[
            "<limit lower=\"-1\" upper=\"1\"/>",
            "<origin xyz=\"%xyz%\" rpy=\"%xyz%\"/><axis xyz=\"%axis%\"/><limit lower=\"-1.5\" upper=\"2\"/>",
            "<origin xyz=\"%xyz%\"/><axis xyz=\"%axis%\"/><limit lower=\"%number%\" upper=\"%number%\"/>",
            "<axis xyz=\"0 1 0\"/><limit lower=\"-3\" upper=\"3\"/><mimic joint=\"j1\"/>",
        ],
    ),
    ("axis", &["0 0 1", "0 1 0", "1 0 0", "0 0 -1", "0.6 0.8 0", "1 1 1", "0 0 0", "1e-9 0 1", "%xyz%"]),
    ("xyz", &["0 0 0", "0 0 0.5", "%number% %number% %number%", "1 2", "1 2 3 4", "%odd%"]),
    ("number", &["0", "0.5", "1", "-1.5707963267948966", "3.14159", "%small%", "%odd%"]),
    (
        "extra",
        &[
            "",
            "<material name=\"grey\"/>\n",
            "<gazebo>&#0;</gazebo>\n",
            "<link name=\"l3\"/><joint name=\"j3\" type=\"fixed\"><parent link=\"l2\"/><child link=\"l3\"/></joint>\n",
            "<xacro:macro/>\n",
            "<![CDATA[ %odd% ]]>\n",
            "<joint name=\"j1\"/>",
            "</robot><robot>",
        ],
    ),
];

pub fn check(data: &[u8]) -> Result<(), String> {
    let text = std::str::from_utf8(data).map_err(|error| error.to_string())?;
    let files = [("arm.urdf", text)];
    let tree = Tree::parse("arm.urdf", text).map_err(|problems| assert_places(&problems, &files))?;
    if let Some(broken) = with_line_breaks_of_windows(text) {
        let again = Tree::parse("arm.urdf", &broken).unwrap_or_else(|problems| panic!("{problems}"));
        let both = [&tree, &again].map(|tree| tree.chain(None, None).ok().map(|chain| chain.description()));
        assert_same("with other line breaks", &both[0], &both[1]);
    }
    let of_all = tree.links.iter().map(|link| tree.chain(None, Some(&link.name)));
    let mut refused = Some(String::new());
    for chain in [tree.chain(None, None)].into_iter().chain(of_all) {
        match chain {
            Ok(chain) => {
                refused = None;
                assert_described(&chain);
            }
            Err(problems) => {
                let said = assert_places(&problems, &files);
                refused = refused.map(|all| all + &said);
            }
        }
    }
    refused.map_or(Ok(()), Err)
}

/// The table stands for the same arm as the file, and is read back from what is written of it.
fn assert_described(chain: &Chain) {
    let description = chain.description();
    let yaml = description.to_yaml();
    // Numbers that no description may have are refused as those of any other.
    let Ok(read) = Description::parse("arm.yaml", &yaml) else { return };
    assert_same(&yaml, &description, &read);
    assert_written(&read);
    match chain.joints.len() {
        1 => assert_there::<1>(chain, &read),
        2 => assert_there::<2>(chain, &read),
        3 => assert_there::<3>(chain, &read),
        _ => {}
    }
}

fn assert_there<const N: usize>(chain: &Chain, description: &Description) {
    let robot = Generic::<N>::new(description).expect("as many joints");
    let lengths = chain.joints.iter().map(|joint| joint.before.translation.vector.norm());
    let size = lengths.sum::<f64>() + chain.end.translation.vector.norm() + 1.0;
    for q in [0.0, 0.7, -1.3] {
        let (there, here) = (chain.pose(&[q; N]).to_homogeneous(), robot.transform(&SVector::from([q; N])));
        let off = (there - here).iter().fold(0.0_f64, |most, entry| most.max(entry.abs()));
        assert!(off <= 1e-8 * size, "off by {off:e} of {size:e} at {q}:\n{there}{here}");
    }
}
