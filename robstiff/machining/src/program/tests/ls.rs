use proptest::prelude::*;

use super::made::{Digits, edits, file, kept_lines, moved, program, same};
use crate::program::ls::{read, write};
use crate::program::{
    Configuration, Frame, Instruction, Language, Motion, Move, Position, Program, Speed, Target, Zone,
};

/// 3 decimals of a mm and of a degree; three angles add up.
const DIGITS: Digits = Digits { length: 0.51e-6, angle: 3.0e-5 };

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn read_back_it_is_the_same(program in program(Language::Ls)) {
        let files = write(&program).unwrap();
        let text = files[0].text.clone();
        let document = read(files).unwrap_or_else(|problems| panic!("{problems}"));
        same(&program, document.program(), DIGITS).map_err(|why| TestCaseError::fail(format!("{why}\n{text}")))?;
        edits(&document, moved, DIGITS).map_err(TestCaseError::fail)?;
    }
}

pub(super) const TP: &str = "\
/PROG  PART
/ATTR
OWNER\t\t= MNEDITOR;
COMMENT\t\t= \"a / b\";
LINE_COUNT\t= 9;
/APPL
/MN
   1:  UFRAME_NUM=1 ;
   2:  UTOOL_NUM=2 ;
   3:  !spindle on; slowly ;
   4:J P[1:home] 100% FINE    ;
   5:L @P[2] 240cm/min CNT50 ACC80
    :  TB .10sec,CALL GRIP    ;
   6:L P[3] R[4]mm/sec FINE ;
   7:C P[2]
    :  P[3] 100mm/sec FINE ;
   8:L PR[1] 100mm/sec FINE ;
   9:L P[2] 100mm/sec FINE Offset,PR[3] ;
  10:L P[9] 100mm/sec FINE ;
/POS
P[1:\"home\"]{
   GP1:
\tUF : F, UT : F,\t
\tJ1=     0.000 deg,\tJ2=   -20.000 deg,\tJ3=    10.500 deg,
\tJ4=     0.000 deg,\tJ5=   -80.000 deg,\tJ6=     5.000 deg,
\tE1=  1200.500  mm
   GP2:
\tUF : 1, UT : 1,
\tJ1=     7.000  mm
};
P[2]{
   GP1:
\tUF : 1, UT : 2,\t\tCONFIG : 'N U T, 0, -1, 0',
\tX =  1000.000  mm,\tY =   -50.500  mm,\tZ =   500.000  mm,
\tW =   180.000 deg,\tP =     0.000 deg,\tR =    90.000 deg
};
P[3]{
   GP1:
\tUF : 3, UT : 2,\t\tCONFIG : 'F L D B, 0, 0, 0',
\tX =  1000.000  mm,\tY =   -50.500  mm,\tZ =   500.000  mm,
\tW =   180.000 deg,\tP =     0.000 deg,\tR =    90.000 deg
};
/END
";

#[test]
fn a_taught_program_is_read_and_changed_in_place() {
    let document = read(vec![file("part.ls", TP)]).unwrap_or_else(|problems| panic!("{problems}"));
    let moves: Vec<&Move> = document.moves().collect();
    assert_eq!(moves.iter().map(|to| to.line).collect::<Vec<_>>(), [11, 12, 14]);
    assert_eq!((moves[0].point.as_deref(), moves[0].position.external.as_slice()), (Some("home"), &[Some(1200.5)][..]));
    assert_eq!((&moves[0].speed, &moves[1].zone), (&Some(Speed::Share(1.0)), &Zone::Share(0.5)));
    let Some(Speed::Tool(speed)) = moves[1].speed else { panic!("{:?}", moves[1]) };
    assert!((speed - 0.04).abs() < 1e-12 && moves[1].options.contains("CALL GRIP"));
    assert_eq!(moves[2].speed, Some(Speed::Named("R[4]mm/sec".to_owned())));
    let Target::Pose(pose, which) = &moves[1].position.target else { panic!("{:?}", moves[1]) };
    // Turned about the fixed x, then about the fixed z: the tool's y points along x.
    assert!((pose.rotation * nalgebra::Vector3::y() - nalgebra::Vector3::x()).norm() < 1e-12, "{pose}");
    let fanuc = Configuration::Fanuc { flip: false, left: None, up: true, front: true, turns: [0, -1, 0] };
    assert_eq!(*which, Some(fanuc));
    assert_eq!(kept_lines(&document), [15, 17, 18, 19]);
    let works: Vec<&str> = document
        .program()
        .instructions
        .iter()
        .filter_map(|one| match one {
            Instruction::Work(frame) => Some(frame.name.as_str()),
            _ => None,
        })
        .collect();
    assert_eq!(works, ["1", "3"]);
    edits(&document, moved, DIGITS).unwrap();
    let positions: Vec<Position> = document.moves().map(|to| moved(&to.position)).collect();
    let text = &document.with_positions(&positions).unwrap()[0].text;
    assert!(text.contains("J1=     7.000  mm") && text.contains("CONFIG : 'F L D B, 0, 0, 0'"), "{text}");
}

#[test]
fn mistakes_are_shown_where_they_are() {
    let told = |position: &str| {
        let text = format!("/PROG A\n/MN\n 1:L P[1] 10mm/sec FINE ;\n/POS\n{position}\n/END\n");
        read(vec![file("a.ls", &text)]).unwrap_err().to_string()
    };
    let axes = "Y = 1 mm, Z = 1 mm, W = 1 deg, P = 1 deg, R = 1 deg";
    let config = "UF : 1, UT : 1, CONFIG : 'N U T, 0, 0, 0'";
    let of = |position: &str| told(position);
    assert!(of(&format!("P[1]{{\nGP1:\n{config}, {axes}\n}};")).contains("the position has no X\n --> a.ls:5:5"));
    assert!(of(&format!("P[1]{{\nGP1:\n{config}, X = 1 deg, {axes}\n}};")).contains("X is in `deg`, not in `mm`"));
    assert!(
        of(&format!("P[1]{{\nGP1:\nCONFIG : 'N U X', X = 1 mm, {axes}\n}};"))
            .contains("the CONFIG is not known\n --> a.ls:7:10")
    );
    assert!(
        of(&format!("P[1]{{\nGP1:\nX = 1 mm, X = 2 mm, {axes}\n}};")).contains("`X` is given twice\n --> a.ls:7:11")
    );
    assert!(
        of(&format!("P[1]{{\nGP1:\n{config}, X = 1 mm, {axes}\n")).contains("the `{` is not closed\n --> a.ls:5:5")
    );
    let none = read(vec![file("a.ls", "1: L P[1] 10mm/sec FINE ;\n")]).unwrap_err().to_string();
    assert!(none.contains("no `/PROG`") && none.contains("no `/MN`"), "{none}");
}

#[test]
fn a_frame_that_is_known_becomes_remarks() {
    let pose = nalgebra::Isometry3::translation(-1.234567, 0.0, -1.234567);
    let frame = Frame { name: "1".to_owned(), pose: Some(pose) };
    let mut program = Program { name: "a".to_owned(), instructions: vec![Instruction::Work(frame)] };
    let text = write(&program).unwrap()[0].text.clone();
    assert!(text.contains("!UFRAME 1 X -1234.567 Y 0.000 ;") && text.contains("UFRAME_NUM=1 ;"), "{text}");
    assert!(text.lines().filter_map(|line| line.split_once('!')).all(|(_, remark)| remark.len() <= 34), "{text}");
    // Without CONFIG the controller could not tell the postures apart.
    let pose = Position::from(Target::Pose(pose, None));
    let to = Move { speed: Some(Speed::Tool(0.1)), ..Move::to(Motion::Linear, pose) };
    program.instructions.push(Instruction::Move(to));
    assert_eq!(write(&program).unwrap_err()[0].instruction, 2);
}
