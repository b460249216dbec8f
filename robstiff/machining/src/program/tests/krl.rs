use proptest::prelude::*;

use super::made::{Digits, edits, file, moved, program, same, statement};
use crate::program::krl::{Options, read, write};
use crate::program::{Frame, Instruction, Language, Motion, Position, Speed, Target, Zone};

/// 4 decimals of a mm, 5 of a degree; three angles add up.
const DIGITS: Digits = Digits { length: 0.51e-7, angle: 3.0e-7 };

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn read_back_it_is_the_same(program in program(Language::Krl), inline: bool, split in 1usize..20) {
        let files = write(&program, &Options { inline, most_instructions: split }).unwrap();
        let text = files[0].text.clone();
        let document = read(files).unwrap_or_else(|problems| panic!("{problems}"));
        same(&program, document.program(), DIGITS).map_err(|why| TestCaseError::fail(format!("{why}\n{text}")))?;
        edits(&document, moved, DIGITS).map_err(TestCaseError::fail)?;
    }
}

/// As the pendant's inline forms make it.
pub(super) const SRC: &str = "\
&ACCESS RVP
&PARAM TEMPLATE = C:\\KRC\\Roboter\\Template\\vorgabe
DEF Part ( )
;FOLD INI
  ;FOLD BASISTECH INI
    GLOBAL INTERRUPT DECL 3 WHEN $STOPMESS==TRUE DO IR_STOPM ( )
    INTERRUPT ON 3
    BAS (#INITMOV,0 )
  ;ENDFOLD (BASISTECH INI)
;ENDFOLD (INI)
;FOLD PTP HOME  Vel= 100 % DEFAULT;%{PE}%R 8.3.22
$BWDSTART = FALSE
PDAT_ACT=PDEFAULT
FDAT_ACT=FHOME
BAS (#PTP_PARAMS,100 )
$H_POS=XHOME
PTP  XHOME
;ENDFOLD
;FOLD LIN P1 CONT Vel=0.2 m/s CPDAT1 Tool[3] Base[2];%{PE}
$BWDSTART=FALSE
LDAT_ACT=LCPDAT1
FDAT_ACT=FP1
BAS(#CP_PARAMS,0.2)
LIN XP1 C_DIS C_DIS
;ENDFOLD
$OUT[3]=TRUE ; \"spindle; on\"
lin {x 100,y -50.5,z 12.25} c_dis
circ {X 1,Y 2,Z 3,A 0,B 0,C 0},{X 2,Y 3,Z 3,A 0,B 0,C 0}
IF $IN[1]==TRUE THEN
  Retract( )
ENDIF
Retract( )
END

DEF Retract( )
PTP {A1 10.5,A2 -90,A3 90,A4 0,A5 15,A6 -20,E1 1200.5} C_PTP
PTP {A2 -80}
END
";

const DAT: &str = "\
DEFDAT PART
;FOLD EXTERNAL DECLARATIONS
DECL BASIS_SUGG_T LAST_BASIS={POINT1[] \"P1   \",POINT2[] \"P1   \",CP_PARAMS[] \"CPDAT1\"}
DECL E6POS XP1={X 1000.0,Y 0.0,Z 500.0,A 0.0,B 90.0,C 0.0,S 2,T 35,E1 0.0,E2 0.0,E3 0.0,E4 0.0,E5 0.0,E6 0.0}
DECL FDAT FP1={TOOL_NO 3,BASE_NO 2,IPO_FRAME #BASE,POINT2[] \" \"}
DECL LDAT LCPDAT1={VEL 2.0,ACC 100.0,APO_DIST 7.5,APO_FAC 50.0,ORI_TYP #VAR}
ENDDAT
";

#[test]
fn a_taught_program_is_read_and_changed_in_place() {
    let document = read(vec![file("part.src", SRC), file("part.dat", DAT)]).unwrap_or_else(|p| panic!("{p}"));
    assert_eq!(document.program().name, "Part");
    let moves: Vec<_> = document.moves().collect();
    assert_eq!(moves.iter().map(|to| to.line).collect::<Vec<_>>(), [24, 27, 36, 37]);
    assert_eq!((moves[0].point.as_deref(), &moves[0].zone), (Some("XP1"), &Zone::Within(7.5e-3)));
    assert_eq!((&moves[0].speed, &moves[2].speed), (&Some(Speed::Tool(0.2)), &Some(Speed::Share(1.0))));
    // The orientation is that of the point before.
    let Target::Pose(pose, None) = &moves[1].position.target else { panic!("{:?}", moves[1]) };
    assert!((pose.translation.vector.y + 0.0505).abs() < 1e-12);
    assert!((pose.rotation.to_rotation_matrix()[(2, 0)] + 1.0).abs() < 1e-12);
    assert_eq!(moves[2].position.external, [Some(1200.5)]);
    let Target::Joints(angles) = &moves[3].position.target else { panic!("{:?}", moves[3]) };
    assert!((angles[1].to_degrees() + 80.0).abs() < 1e-12 && (angles[0].to_degrees() - 10.5).abs() < 1e-12);
    let kept: Vec<(usize, &str)> = document
        .program()
        .instructions
        .iter()
        .filter_map(|instruction| match instruction {
            Instruction::KeptMove { line, why, .. } => Some((*line, why.as_str())),
            _ => None,
        })
        .collect();
    assert_eq!(kept, [(17, "`XHOME` is declared in none of the files"), (28, "a circular motion")]);
    let frames: Vec<&Instruction> = document
        .program()
        .instructions
        .iter()
        .filter(|instruction| matches!(instruction, Instruction::Tool(_) | Instruction::Work(_)))
        .collect();
    let frame = |name: &str| Frame { name: name.to_owned(), pose: None };
    assert_eq!(frames[2..], [&Instruction::Tool(frame("3")), &Instruction::Work(frame("2"))]);
    let statements = document.program().instructions.iter().filter(|one| matches!(one, Instruction::Statement { .. }));
    assert!(
        statements.clone().any(|one| matches!(one, Instruction::Statement { text, .. } if text.starts_with("$OUT[3]")))
    );
    edits(&document, moved, DIGITS).unwrap();
    let files = document.with_positions(&document.moves().map(|to| moved(&to.position)).collect::<Vec<_>>()).unwrap();
    // Numbers that were left out are put in.
    assert!(files[0].text.contains("z 12.5500,A "), "{}", files[0].text);
    assert!(files[0].text.contains("LIN XP1 C_DIS C_DIS\n") && files[1].text.contains(",S 2,T 35,E1 0.0"));
}

#[test]
fn a_point_cannot_be_in_two_places() {
    let src = "DEF A( )\nLIN XP1\nLIN XP1\nEND\n";
    let document = read(vec![file("a.src", src), file("a.dat", DAT)]).unwrap_or_else(|p| panic!("{p}"));
    let mut positions: Vec<Position> = document.moves().map(|to| moved(&to.position)).collect();
    assert!(document.with_positions(&positions).is_ok());
    positions[1] = moved(&positions[1]);
    let shared = document.with_positions(&positions).unwrap_err();
    assert_eq!((shared.lines, shared.point.as_deref()), ([2, 3], Some("XP1")));
}

#[test]
fn what_the_program_computes_is_kept() {
    let src = "DEF A( )\nXP1.X=XP1.X+10\nLIN XP1\nLIN P[3]\nLIN XP1:DIF\nXP1={X 1,Y 2,Z 3,A 0,B 0,C 0}\nLIN XP1\nEND\n";
    let document = read(vec![file("a.src", src), file("a.dat", DAT)]).unwrap_or_else(|p| panic!("{p}"));
    assert_eq!(document.moves().map(|to| to.line).collect::<Vec<_>>(), [7]);
    let kept = document.program().instructions.iter().filter(|one| matches!(one, Instruction::KeptMove { .. })).count();
    assert_eq!(kept, 3);
}

#[test]
fn frames_are_followed() {
    let src = "DEF A( )\nTOOL_DATA[4]={X 0,Y 0,Z 120,A 0,B 0,C 0}\n$TOOL=TOOL_DATA[4]\n$BASE={FRAME: X 1000,Y 0,Z 0,A 90,B 0,C 0}\n\
               $VEL.CP=0.05\nLIN {X 1,Y 2,Z 3,A 0,B 0,C 0,S 6,T 3}\nBAS(#BASE,0)\nEND\n";
    let document = read(vec![file("a.src", src)]).unwrap_or_else(|p| panic!("{p}"));
    let [Instruction::Tool(tool), Instruction::Work(work), Instruction::Move(to), Instruction::Work(world)] =
        &document.program().instructions[..]
    else {
        panic!("{:?}", document.program())
    };
    assert_eq!((tool.name.as_str(), tool.pose.map(|pose| pose.translation.z)), ("4", Some(0.12)));
    assert_eq!((work.name.as_str(), work.pose.map(|pose| pose.translation.x)), ("", Some(1.0)));
    assert_eq!((world.name.as_str(), world.pose), ("0", Some(nalgebra::Isometry3::identity())));
    assert_eq!((to.speed.clone(), to.motion), (Some(Speed::Tool(0.05)), Motion::Linear));
}

#[test]
fn mistakes_are_shown_where_they_are() {
    let told = |text: &str| read(vec![file("a.src", text)]).unwrap_err().to_string();
    assert!(told("PTP {A1 0}\n").contains("the file has no routine\n --> a.src:1:1"));
    assert!(told("DEF A( )\nPTP {A1 0}\n").contains("the routine `A` does not end\n --> a.src:2:11"));
    assert!(told("DEF A( )\nLIN {X 1,Y 2\nEND\n").contains("the `{` is not closed\n --> a.src:2:5"));
    assert!(told("DEF A( )\nLIN {X 1,X 2}\nEND\n").contains("`X` is given twice\n --> a.src:2:10"));
    assert!(told("DEF A( )\nLIN\nEND\n").contains("the motion has no position\n --> a.src:2:4"));
    assert!(told("DEF A( )\n$IPO_MODE=#TCP\nEND\n").contains(" --> a.src:2:11"));
}

#[test]
fn what_krl_cannot_say_is_refused() {
    let mut program = crate::program::Program { name: "A".to_owned(), instructions: Vec::new() };
    let joints = Position::from(Target::Joints(vec![0.0; 6]));
    program.instructions.push(Instruction::statement(statement(Language::Krl)));
    program.instructions.push(Instruction::Move(crate::program::Move::to(Motion::Linear, joints)));
    let wrong = write(&program, &Options::default()).unwrap_err();
    assert_eq!(wrong.len(), 1);
    assert_eq!(wrong[0].instruction, 2);
    program.instructions.pop();
    program.name = "7 up".to_owned();
    assert_eq!(write(&program, &Options::default()).unwrap_err()[0].instruction, 0);
}
