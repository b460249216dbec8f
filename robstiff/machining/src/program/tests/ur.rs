use nalgebra::{Isometry3, Vector3};
use proptest::prelude::*;

use super::made::{Digits, edits, file, kept_lines, moved, program, same};
use crate::program::ur::{read, write};
use crate::program::{Frame, Instruction, Language, Motion, Move, Position, Program, Speed, Target, Zone};

/// 7 decimals of a m and of a rad; the three of a rotation vector add up.
const DIGITS: Digits = Digits { length: 0.51e-7, angle: 1.0e-7 };

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn read_back_it_is_the_same(program in program(Language::Ur)) {
        let mut program = program;
        let files = write(&program).unwrap();
        let text = files[0].text.clone();
        let document = read(files).unwrap_or_else(|problems| panic!("{problems}"));
        // The frame of poses is set by the first of them.
        let is_pose = |one: &Instruction| matches!(one, Instruction::Move(to) if matches!(to.position.target, Target::Pose(..)));
        let work = program.instructions.remove(1);
        if let Some(first) = program.instructions.iter().position(is_pose) {
            program.instructions.insert(first, work);
        }
        same(&program, document.program(), DIGITS).map_err(|why| TestCaseError::fail(format!("{why}\n{text}")))?;
        edits(&document, moved, DIGITS).map_err(TestCaseError::fail)?;
    }
}

pub(super) const SCRIPT: &str = "\
def part():
  # movel(p[0,0,0,0,0,0])
  global home = [0, -1.57, 1.57, -1.57, -1.57, 0]
  wPart = p[0.4, 0, 0.1, 0, 0, 1.5707963]
  p10 = p[0.1, 0.05, 0.012, 0, 3.1415927, 0]
  set_tcp(p[0, 0, 0.15, 0, 0, 0])
  def retract():
    movej(home, a=1.4, v=1.05)
  end
  set_digital_out(3, True) # spindle (on
  if digital_in(1):
    retract()
  end
  movel(pose_trans(wPart, p10), 0.5, 0.1, 0, 0.002)
  movep(pose_trans(wPart, p[0.1, 0.06, 0.012, 0, 3.1415927, 0]), v=vCut, r=0.0001)
  movel(p[0.1, 0.06, 0.3, 0, 3.1415927, 0], a=0.5, t=2)
  movel([0, -1.5, 1.5, -1.57, -1.57, 0], v=0.1)
  movec(p10, p10)
  movel(pose_add(p10, p[0, 0, 0.05, 0, 0, 0]), v=0.1)
  if digital_in(2): movel(p10, v=0.1) end
  p10 = get_actual_tcp_pose()
  movel(p10, v=0.1)
  set_tcp(tOther)
  movej(p[0.1, 0.06, 0.3, 0, 3.1415927, 0])
  textmsg(\"done\")
end
";

#[test]
fn a_script_is_read_and_changed_in_place() {
    let document = read(vec![file("part.script", SCRIPT)]).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(document.program().name, "part");
    let moves: Vec<&Move> = document.moves().collect();
    // The call stands where it runs.
    assert_eq!(moves.iter().map(|to| to.line).collect::<Vec<_>>(), [8, 14, 15, 16, 17, 24]);
    assert_eq!(kept_lines(&document), [18, 19, 20, 22]);
    assert_eq!((moves[0].motion, &moves[0].speed), (Motion::Joint, &Some(Speed::Joints(1.05))));
    assert_eq!((moves[0].point.as_deref(), moves[0].options.as_str()), (Some("home"), "a=1.4"));
    assert_eq!((&moves[1].speed, &moves[1].zone), (&Some(Speed::Tool(0.1)), &Zone::Within(0.002)));
    assert_eq!(moves[2].speed, Some(Speed::Named("vCut".to_owned())));
    // A time in place of a speed.
    assert_eq!((&moves[3].speed, moves[3].options.as_str()), (&None, "a=0.5, t=2"));
    assert_eq!((moves[4].motion, &moves[4].zone), (Motion::Linear, &Zone::Fine));
    let Target::Pose(pose, None) = &moves[1].position.target else { panic!("{:?}", moves[1]) };
    assert!((pose.rotation * Vector3::z() + Vector3::z()).norm() < 1e-7, "{pose}");
    let frames: Vec<(bool, &str, Option<f64>)> = document
        .program()
        .instructions
        .iter()
        .filter_map(|one| match one {
            Instruction::Tool(frame) => Some((true, &*frame.name, frame.pose.map(|pose| pose.translation.z))),
            Instruction::Work(frame) => Some((false, &*frame.name, frame.pose.map(|pose| pose.translation.z))),
            _ => None,
        })
        .collect();
    let expected =
        [(true, "", Some(0.15)), (false, "wPart", Some(0.1)), (false, "", Some(0.0)), (true, "tOther", None)];
    assert_eq!(frames, expected);
    edits(&document, moved, DIGITS).unwrap();
    let positions: Vec<Position> = document.moves().map(|to| moved(&to.position)).collect();
    let text = &document.with_positions(&positions).unwrap()[0].text;
    assert!(
        text.contains("# movel(p[0,0,0,0,0,0])") && text.contains("movep(pose_trans(wPart, p[0.1001000, "),
        "{text}"
    );
}

#[test]
fn mistakes_are_shown_where_they_are() {
    let told = |text: &str| read(vec![file("a.script", text)]).unwrap_err().to_string();
    assert!(told("movel(p[0,0,0,0,0,0])\n").contains("the file has no function\n --> a.script:1:1"));
    assert!(told("\ndef a():\n  if x:\n  end\n").contains("the function `a` does not end\n --> a.script:2:1"));
    assert!(told("def a():\n  movel(p[0,0,0,0,0,0]\nend\n").contains("the `(` is not closed\n --> a.script:2:8"));
    assert!(told("def a():\n  movel( )\nend\n").contains("the motion has no position\n --> a.script:2:8"));
}

#[test]
fn what_the_language_lacks_is_refused() {
    let pose = Position::from(Target::Pose(Isometry3::translation(0.4, 0.1, 0.3), None));
    let of = |to: Move| write(&Program { name: "a".to_owned(), instructions: vec![Instruction::Move(to)] });
    let line = |speed, zone| Move { speed: Some(speed), zone, ..Move::to(Motion::Linear, pose.clone()) };
    let text = of(line(Speed::Tool(0.02), Zone::Fine)).unwrap()[0].text.clone();
    assert!(
        text.contains("  movel(p[0.4000000, 0.1000000, 0.3000000, 0.0000000, 0.0000000, 0.0000000], v=0.02)\n"),
        "{text}"
    );
    assert!(of(line(Speed::Tool(0.02), Zone::Within(1e-3))).unwrap()[0].text.contains("movep("));
    for (speed, zone) in [
        (Speed::Share(0.1), Zone::Fine),
        (Speed::Joints(0.1), Zone::Fine),
        (Speed::Tool(1e-9), Zone::Fine),
        (Speed::Tool(0.1), Zone::Share(0.5)),
    ] {
        assert_eq!(of(line(speed, zone)).unwrap_err()[0].instruction, 1);
    }
    let five = Move::to(Motion::Joint, Position::from(Target::Joints(vec![0.0; 5])));
    assert!(of(five).is_err());
    let rail = Position { external: vec![Some(100.0)], ..pose.clone() };
    assert!(of(Move::to(Motion::Linear, rail)).is_err());
    let frame = Frame { name: "2nd".to_owned(), pose: Some(Isometry3::identity()) };
    let tool = Program { name: "a".to_owned(), instructions: vec![Instruction::Tool(frame)] };
    assert_eq!(write(&tool).unwrap_err()[0].instruction, 1);
}
