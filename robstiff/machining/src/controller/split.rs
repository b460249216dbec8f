//! The files of a program that may be larger than its controller takes.

use crate::program::{Instruction, Language, Program, TextFile, Unwritable, write};

/// Motions of a TP program, as post-processors have them at most (RoboDK: 9999 lines).
const MOST_OF_LS: usize = 9000;

/// The files of a program. KRL is split by its writer; a TP program with more than 9000
/// instructions calls others, `NAME_1` and so on, each with its frames. A RAPID module stays one
/// file.
///
/// # Errors
/// The instructions that the language cannot express.
pub fn files(language: Language, program: &Program) -> Result<Vec<TextFile>, Vec<Unwritable>> {
    if language != Language::Ls || program.instructions.len() <= MOST_OF_LS {
        return write(language, program);
    }
    let (mut frames, mut rest) = (Vec::new(), Vec::new());
    for instruction in &program.instructions {
        match instruction {
            Instruction::Tool(_) | Instruction::Work(_) if rest.is_empty() => frames.push(instruction.clone()),
            _ => rest.push(instruction.clone()),
        }
    }
    let parts = rest.chunks(MOST_OF_LS).enumerate().map(|(i, part)| Program {
        name: format!("{}_{}", program.name, i + 1),
        instructions: [&frames[..], part].concat(),
    });
    let parts: Vec<Program> = parts.collect();
    let calls = parts.iter().map(|part| Instruction::statement(format!("CALL {}", part.name.to_ascii_uppercase())));
    let main = Program { name: program.name.clone(), instructions: calls.collect() };
    let mut files = write(language, &main)?;
    for part in &parts {
        files.extend(write(language, part)?);
    }
    Ok(files)
}
