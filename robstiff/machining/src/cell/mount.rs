//! Which tool is in the spindle.

use robstiff_robots::Diagnostics;

use super::parts::{Cell, Tool};
use crate::path::ToolPath;

/// Tools whose lengths differ by less have the same tip (m).
const SAME_LENGTH: f64 = 1e-9;

impl Cell {
    /// The tool in the spindle where no path says it; `None` where the cell has no tools.
    ///
    /// # Errors
    /// Several, of which the cell names none: what to write.
    pub fn mounted(&self) -> Result<Option<&Tool>, String> {
        match (self.tool, &self.tools[..]) {
            (Some(number), tools) => Ok(tools.iter().find(|tool| tool.number == number)),
            (None, []) => Ok(None),
            (None, [tool]) => Ok(Some(tool)),
            (None, [first, ..]) => Err(format!(
                "{} does not say which of the tools {} is in the spindle; write e.g. `tool: T{}` there",
                self.file,
                self.numbers(),
                first.number
            )),
        }
    }

    /// The tool that a path is cut with; `None` where the cell has no tools.
    ///
    /// # Errors
    /// A tool that the cell does not have, tools of several lengths, or none that is named where the cell
    /// has several: at its line, with what to write.
    pub fn tool_on(&self, path: &ToolPath) -> Result<Option<&Tool>, Diagnostics> {
        if self.tools.is_empty() {
            return Ok(None);
        }
        let mut used: Option<&Tool> = None;
        let has = |number: u32| self.tools.iter().find(|tool| tool.number == number);
        // T0 is an empty spindle.
        let named = path.points.iter().filter_map(|point| Some((point.line, point.tool?)));
        for (line, number) in named.filter(|(_, number)| *number != 0 || has(0).is_some()) {
            let Some(tool) = has(number) else {
                let help = format!("add `T{number}` to `tools`; there are {}", self.numbers());
                return Err(path.diagnostic(line, format!("{} has no tool T{number}", self.file), &help).into());
            };
            let first = *used.get_or_insert(tool);
            let more = tool.length - first.length;
            if more.abs() > SAME_LENGTH {
                let how = if more > 0.0 { "longer" } else { "shorter" };
                let message = format!(
                    "T{number} is {:.3} mm {how} than T{}, and one path has one tip",
                    more.abs() * 1e3,
                    first.number
                );
                return Err(path.diagnostic(line, message, "split the program where the tool changes").into());
            }
        }
        if used.is_some() {
            return Ok(used);
        }
        self.mounted().map_err(|unsaid| {
            let line = path.points.first().map_or(1, |point| point.line);
            path.diagnostic(line, "the path names no tool".to_owned(), &unsaid).into()
        })
    }

    fn numbers(&self) -> String {
        let numbers: Vec<String> = self.tools.iter().map(|tool| format!("T{}", tool.number)).collect();
        numbers.join(", ")
    }
}
