//! The description that a controller solves with.

use std::fs;
use std::path::{Component, Path, PathBuf};

use robstiff_machining::controller::NoNominal;
use robstiff_robots::{Controller, Description, catalogue};

use crate::failure::Failure;

/// Reads the nominal description that the `controller` of a robot names; `None` where it names none.
pub fn nominal(path: &Path, robot: &Description) -> Result<Option<Description>, Failure> {
    let Some(controller) = &robot.controller else {
        return Err(Failure::new(format_args!("{}: {}", path.display(), NoNominal::NoController)));
    };
    let Some(name) = &controller.nominal else { return Ok(None) };
    let folder = folder_of(path);
    let named = folder.join(name);
    if !named.exists() && catalogue::find(name).is_none() {
        return Err(Failure::new(format_args!(
            "{}: `controller` names the nominal description {name}, and there is no file {}; give its path from the \
             description's folder",
            path.display(),
            named.display()
        )));
    }
    let (nominal, _) = catalogue::read(folder, Path::new(name))?;
    Ok(Some(nominal))
}

/// A description that was made of that of a file and goes to another folder. The nominal description that it
/// names is still found from there. Where it names none and its table was changed, the nominal one is the
/// file that it was made of.
pub fn moved(robot: &Description, (before, from): (&Description, &Path), to: &Path) -> Description {
    let mut robot = robot.clone();
    let seen = |name: &Path| {
        let file = fs::canonicalize(folder_of(from).join(name)).ok()?;
        between(to, &file)
    };
    if let Some(Controller { nominal: Some(name), .. }) = &mut robot.controller {
        // One of the catalogue has no path.
        *name = seen(Path::new(name)).unwrap_or_else(|| name.clone());
        return robot;
    }
    let table = |of: &Description| of.joints.iter().map(|row| [row.theta, row.d, row.a, row.alpha]).collect::<Vec<_>>();
    if table(&robot) == table(before) && robot.base == before.base {
        return robot;
    }
    let file = from.file_name().map(Path::new).unwrap_or(from);
    let name = seen(file).unwrap_or_else(|| from.display().to_string());
    match &mut robot.controller {
        Some(controller) => controller.nominal = Some(name),
        None => {
            let said = format!("The table is corrected; the controller solves with that of {name}: its `nominal`.");
            robot.source = format!("{}\n{said}", robot.source.trim_end()).trim_start().to_owned();
        }
    }
    robot
}

/// The path of a file from a folder that need not be there yet.
fn between(folder: &Path, file: &Path) -> Option<String> {
    let there = folder.ancestors().find_map(|part| {
        let part = if part.as_os_str().is_empty() { Path::new(".") } else { part };
        Some((fs::canonicalize(part).ok()?, part))
    });
    let (mut whole, part) = there?;
    whole.extend(folder.strip_prefix(part).unwrap_or(folder).components().filter(|part| *part != Component::CurDir));
    let common = whole.components().zip(file.components()).take_while(|(one, other)| one == other).count();
    let up = whole.components().skip(common).map(|_| Component::ParentDir);
    let path: PathBuf = up.chain(file.components().skip(common)).collect();
    Some(path.to_str()?.replace('\\', "/"))
}

fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_nominal_description_is_found_from_another_folder() {
        let folder = std::env::temp_dir().join(format!("robstiff-nominal-{}", std::process::id()));
        fs::create_dir_all(folder.join("arms")).unwrap();
        let text = "name: Arm\nconvention: standard\njoints: [{a: 1 m}]\ncontroller: {nominal: maker.yaml}\n";
        let from = folder.join("arms/arm.yaml");
        let robot = Description::parse("arm.yaml", text).unwrap();
        assert!(nominal(&from, &robot).unwrap_err().to_string().contains("there is no file"));
        fs::write(folder.join("arms/maker.yaml"), "name: Maker\nconvention: standard\njoints: [{a: 2 m}]\n").unwrap();
        assert_eq!(nominal(&from, &robot).unwrap().unwrap().name, "Maker");
        for (to, expected) in [("out/new", "../../arms/maker.yaml"), ("arms", "maker.yaml"), ("", "arms/maker.yaml")] {
            let moved = moved(&robot, (&robot, &from), &folder.join(to));
            assert_eq!(moved.controller.as_ref().unwrap().nominal.as_deref(), Some(expected));
            // It was not there before.
            fs::create_dir_all(folder.join(to)).unwrap();
            assert_eq!(nominal(&folder.join(to).join("robot.yaml"), &moved).unwrap().unwrap().name, "Maker");
        }
        // A table that was changed is not the controller's.
        let text = text.replace("controller: {nominal: maker.yaml}", "controller: {}");
        fs::write(&from, &text).unwrap();
        let robot = Description::parse("arm.yaml", &text).unwrap();
        let mut corrected = robot.clone();
        let out = folder.join("out");
        assert_eq!(moved(&corrected, (&robot, &from), &out), robot);
        corrected.joints[0].a += 1e-3;
        let written = moved(&corrected, (&robot, &from), &out);
        assert_eq!(written.controller.unwrap().nominal.as_deref(), Some("../arms/arm.yaml"));
        corrected.controller = None;
        let written = moved(&corrected, (&robot, &from), &out);
        assert!(written.source.contains("../arms/arm.yaml: its `nominal`"), "{}", written.source);
        fs::remove_dir_all(&folder).unwrap();
    }
}
