//! The words and the unit of what is reported: displacements of the tool at poses, or
//! deflections of axes that are loaded one by one.

use robstiff::JointKind;
use robstiff_identify::campaign::{Campaign, Data};

/// The words for one kind of campaign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Terms {
    /// What rows belong to, one and several: `pose`, `axis`.
    pub place: [&'static str; 2],
    /// What comes before the id of one; nothing where the id says it.
    of_id: &'static str,
    /// What a model is judged by that it has not seen, one and several: `pose`, `row`.
    pub unseen: [&'static str; 2],
    /// What is read: `displacement`, `deflection`.
    pub reading: &'static str,
    /// What an error is the root mean square of.
    pub component: &'static str,
    /// What effects do.
    pub moves: &'static str,
    /// The unit of errors: `um`, `urad`.
    pub unit: &'static str,
    /// The same as print writes it.
    pub printed: &'static str,
}

impl Terms {
    /// Of the tool at poses.
    pub const POSES: Self = Self {
        place: ["pose", "poses"],
        of_id: "pose ",
        unseen: ["pose", "poses"],
        reading: "displacement",
        component: "error of one axis",
        moves: "move the tool",
        unit: "um",
        printed: "µm",
    };

    /// Of clamped axes that turn.
    pub const AXES: Self = Self {
        place: ["axis", "axes"],
        of_id: "",
        unseen: ["row", "rows"],
        reading: "deflection",
        component: "error",
        moves: "turn the axes",
        unit: "urad",
        printed: "µrad",
    };

    /// Of clamped axes that slide.
    pub const SLIDES: Self = Self { moves: "move the axes", unit: "um", printed: "µm", ..Self::AXES };

    /// Of a campaign. Errors of clamped axes of both kinds are of no unit; most turn.
    pub fn of(campaign: &Campaign) -> Self {
        let Data::Clamped(rows) = &campaign.data else { return Self::POSES };
        let slides = |axis: usize| campaign.robot.joints[axis - 1].kind == JointKind::Prismatic;
        if rows.iter().all(|row| slides(row.axis)) { Self::SLIDES } else { Self::AXES }
    }

    /// A count of what rows belong to.
    pub fn places(&self, number: usize) -> String {
        format!("{number} {}", self.place[usize::from(number != 1)])
    }

    /// One of these by its id.
    pub fn named(&self, id: &str) -> String {
        format!("{}{id}", self.of_id)
    }
}

impl Default for Terms {
    fn default() -> Self {
        Self::POSES
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_and_names_are_of_their_kind() {
        assert_eq!([1, 3].map(|number| Terms::POSES.places(number)), ["1 pose", "3 poses"]);
        assert_eq!([1, 3].map(|number| Terms::AXES.places(number)), ["1 axis", "3 axes"]);
        assert_eq!([Terms::POSES.named("7"), Terms::AXES.named("axis 2")], ["pose 7", "axis 2"]);
    }
}
