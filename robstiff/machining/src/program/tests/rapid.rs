use proptest::prelude::*;

use super::made::{Digits, edits, file, kept_lines, moved, program, same};
use crate::program::rapid::{read, write};
use crate::program::{Configuration, Instruction, Language, Motion, Move, Position, Speed, Target, Zone};

/// 4 decimals of a mm; 8 of the parts of a quaternion; 5 of a degree.
const DIGITS: Digits = Digits { length: 0.51e-7, angle: 1.0e-7 };

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn read_back_it_is_the_same(program in program(Language::Rapid)) {
        let mut program = program;
        let files = write(&program).unwrap();
        let text = files[0].text.clone();
        let document = read(files).unwrap_or_else(|problems| panic!("{problems}"));
        // Frames are set by the motions that name them.
        let first = program.instructions.iter().position(|one| matches!(one, Instruction::Move(_)));
        let frames: Vec<Instruction> = program.instructions.drain(..2).collect();
        if let Some(first) = first {
            program.instructions.splice(first - 2..first - 2, frames);
        }
        same(&program, document.program(), DIGITS).map_err(|why| TestCaseError::fail(format!("{why}\n{text}")))?;
        edits(&document, moved, DIGITS).map_err(TestCaseError::fail)?;
    }
}

pub(super) const MODULE: &str = "\
MODULE Part
  PERS tooldata tMill:=[TRUE,[[0,0,150.5],[0.707106781,0,0.707106781,0]],[3,[0,0,80],[1,0,0,0],0,0,0]];
  TASK PERS wobjdata wPart:=[FALSE,TRUE,\"\",[[1000,0,500],[1,0,0,0]],[[10,0,0],[1,0,0,0]]];
  CONST robtarget p10:=[[100,-50.5,12.25],[0,0,1,0],[-1,0,1,0],[1200.5,9E9,9E9,9E9,9E9,9E+09]];
  CONST jointtarget jHome:=[[0,-20,20,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR speeddata vCut:=[12.5,500,5000,1000];
  ! MoveL nowhere
  PROC Retract()
    MoveAbsJ jHome\\NoEOffs,v500,z50,tMill;
  ENDPROC
  PROC main()
    SetDO doSpindle,1; ! spindle; on
    IF di1=1 THEN
      Retract;
    ENDIF
    MoveJ p10,v1000,fine,tMill\\WObj:=wPart;
    MoveL [[100,-40,12.25],[0,0,1,0],[-1,0,1,0],
      [9E9,9E9,9E9,9E9,9E9,9E9]],vCut,z1,tMill\\WObj:=wPart;
    MoveL Offs(p10,0,0,50),v100,fine,tMill\\WObj:=wPart;
    MoveC p10,p20,v100,fine,tMill\\WObj:=wPart;
    IF di2=1 MoveL p10,v100,fine,tMill;
    TPWrite \"done; MoveL\";
  ENDPROC
ENDMODULE
";

#[test]
fn a_module_is_read_and_changed_in_place() {
    let document = read(vec![file("part.mod", MODULE)]).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(document.program().name, "Part");
    let moves: Vec<&Move> = document.moves().collect();
    assert_eq!(moves.iter().map(|to| to.line).collect::<Vec<_>>(), [9, 16, 17]);
    assert_eq!(
        (moves[0].motion, moves[0].options.as_str(), &moves[0].zone),
        (Motion::Joint, "\\NoEOffs", &Zone::Within(0.05))
    );
    assert_eq!(moves[1].position.external, [Some(1200.5)]);
    let Target::Pose(pose, which) = &moves[1].position.target else { panic!("{:?}", moves[1]) };
    assert_eq!((pose.translation.x, *which), (0.1, Some(Configuration::Abb([-1, 0, 1, 0]))));
    assert_eq!((moves[2].speed.clone(), moves[2].motion), (Some(Speed::Tool(0.0125)), Motion::Linear));
    let works: Vec<f64> = document
        .program()
        .instructions
        .iter()
        .filter_map(|one| match one {
            Instruction::Work(frame) => frame.pose.map(|pose| pose.translation.x),
            _ => None,
        })
        .collect();
    assert_eq!(works, [0.0, 1.01]);
    assert_eq!(kept_lines(&document), [19, 20, 21]);
    edits(&document, moved, DIGITS).unwrap();
    let positions: Vec<Position> = document.moves().map(|to| moved(&to.position)).collect();
    let text = &document.with_positions(&positions).unwrap()[0].text;
    assert!(text.contains("[-1,0,1,0],[1200.5,9E9,9E9,9E9,9E9,9E+09]];") && text.contains("! spindle; on\n"), "{text}");
}

#[test]
fn mistakes_are_shown_where_they_are() {
    let told = |body: &str| {
        let text = format!("MODULE A\nPROC main()\n{body}\nENDPROC\nENDMODULE\n");
        read(vec![file("a.mod", &text)]).unwrap_err().to_string()
    };
    let long = "MoveL [[1,2,3],[1,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;";
    assert!(told(long).contains("the quaternion's length is 1.4142, not 1\n --> a.mod:3:17"), "{}", told(long));
    assert!(told("MoveL p10,v100;").contains("a motion has four arguments, not 2\n --> a.mod:3:1"));
    assert!(told("MoveL p10,v100,fine,tool0").contains("the statement does not end\n --> a.mod:3:1"));
    assert!(told("VAR robtarget p:=[[1,2,3];").contains("the `[` is not closed\n --> a.mod:3:18"));
    let none = read(vec![file("a.mod", "MoveL p10,v100,fine,tool0;\n")]).unwrap_err().to_string();
    assert!(none.contains("the file has no module\n --> a.mod:1:1"), "{none}");
}

#[test]
fn what_the_program_changes_is_kept() {
    let text = "MODULE A\nVAR robtarget p:=[[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nPROC main()\np.trans.x:=7;\n\
                MoveL p,v100,fine,tool0;\nENDPROC\nENDMODULE\n";
    let document = read(vec![file("a.mod", text)]).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(document.moves().count(), 0);
    let [_, Instruction::KeptMove { line: 5, why, .. }] = &document.program().instructions[..] else {
        panic!("{:?}", document.program())
    };
    assert_eq!(why, "the program changes `p`");
}
