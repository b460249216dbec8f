//! Columns under names of other people: those that controllers give to joints, and those that
//! a campaign says.

use super::Table;
use super::header::Header;

/// What controllers call joints, besides `q1` and so on.
const OF_JOINTS: [char; 2] = ['A', 'J'];

impl Table<'_> {
    /// Takes columns `A1`, `A2` and so on, or `J1`, `J2` and so on, for the coordinates of as many
    /// joints, where there is no column `q1` and so on. It is the name that is taken, with the
    /// unit that the header gives.
    pub fn take_joints(&mut self, joints: usize) {
        let there = |header: &[Header], letter: char| {
            let is_joint = |joint: usize| header.iter().any(|header| header.key == format!("{letter}{joint}"));
            (1..=joints).any(is_joint)
        };
        if there(&self.header, 'q') {
            return;
        }
        let found: Vec<char> = OF_JOINTS.into_iter().filter(|&letter| there(&self.header, letter)).collect();
        match found[..] {
            [] => {}
            [letter] => {
                for header in &mut self.header {
                    // One joint more is another robot's, and is asked about.
                    let joint = header.key.strip_prefix(letter).and_then(|number| number.parse::<usize>().ok());
                    if let Some(joint) = joint {
                        header.key = format!("q{joint}");
                    }
                }
            }
            _ => self.report_header(
                "there are columns `A1` .. and `J1` ..: which are the joints?",
                "call the joint coordinates `q1`, `q2` and so on",
            ),
        }
    }

    /// Takes the column called `name` for `key`, whatever else is called so.
    ///
    /// # Errors
    /// What is wrong and what would be right, where there is no such column.
    pub fn take(&mut self, key: &str, name: &str) -> Result<(), [String; 2]> {
        let Some(index) = self.header.iter().position(|header| header.name == name) else {
            return Err(self.no_column(name));
        };
        for header in &mut self.header {
            if header.key == key {
                // It is there, and nobody looks for it.
                header.key.clear();
            }
        }
        key.clone_into(&mut self.header[index].key);
        Ok(())
    }

    fn no_column(&self, name: &str) -> [String; 2] {
        let message = format!("{} has no column `{name}`", self.file);
        let round = self
            .header
            .iter()
            .find(|header| header.name.split_once('(').is_some_and(|(before, _)| before.trim() == name));
        let without_unit = name.split(['[', '(']).next().unwrap_or_default().trim();
        let meant = self
            .header
            .iter()
            .find(|header| header.name == without_unit || header.name.to_lowercase() == name.to_lowercase());
        let help = match (round, meant) {
            (Some(header), _) => {
                let unit = header.name.split(['(', ')']).nth(1).unwrap_or_default().trim();
                format!("the unit is in round brackets: write `{name} [{unit}]` in the table's header")
            }
            (None, Some(header)) => format!("write `{}`; the unit is the table's", header.name),
            (None, None) => {
                let names: Vec<String> = self.header.iter().map(|header| format!("`{}`", header.name)).collect();
                format!("the header line has {}", names.join(", "))
            }
        };
        [message, help]
    }
}
