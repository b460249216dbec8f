//! Writing a description as a person would: one row a joint, units spelled
//! out, and not a bit lost.

use crate::angle::snapped;
use crate::controller::{Controller, Pendant};
use crate::description::{Description, Joint, Link};
use crate::effect::{Effect, JointKind, Place};
use crate::placement::Placement;
use crate::quantity::{self, Dimension, number};
use std::fmt::Write;

/// The width texts are folded to.
const WIDTH: usize = 110;

impl Description {
    /// The description as YAML, which [`parse`](Self::parse) reads back as the
    /// same description, bit for bit.
    ///
    /// That holds for every description that `parse` could have made: one with
    /// a name that is none, or an angle that should have been snapped, is
    /// written as it is and then refused or corrected on reading.
    pub fn to_yaml(&self) -> String {
        let mut yaml = format!("name: {}\n", scalar(&self.name, &[PLAIN]));
        for (field, text) in [("description", &self.description), ("source", &self.source)] {
            if !text.is_empty() {
                writeln!(yaml, "{field}: {}", block(text)).expect("a string takes any text");
            }
        }
        yaml += &format!("convention: {}\n", self.convention.word());
        yaml += &placement("base", &self.base);
        yaml += &list("joints", self.joints.iter().map(joint));
        yaml += &placement("tool", &self.tool);
        yaml += &list("links", self.links.iter().map(link));
        yaml += &list("effects", self.effects.iter().map(effect));
        if let Some(controller) = &self.controller {
            yaml += &self.controller(controller);
        }
        yaml
    }

    fn controller(&self, controller: &Controller) -> String {
        let kinds = self.joints.iter().map(|joint| joint.kind);
        let joints = kinds.zip(&controller.joints).map(|(kind, joint)| pendant(joint, kind));
        let mut parts = list("joints", joints);
        parts += &placement("world", &controller.world);
        parts += &placement("flange", &controller.flange);
        if let Some(nominal) = &controller.nominal {
            writeln!(parts, "nominal: {}", scalar(nominal, &[PLAIN])).expect("a string takes any text");
        }
        parts.lines().fold("controller:\n".to_owned(), |text, line| text + "  " + line + "\n")
    }
}

fn pendant(joint: &Pendant, kind: JointKind) -> String {
    let mut fields = Vec::new();
    if joint.reversed {
        fields.push(("sign", "-1".to_owned()));
    }
    if joint.offset != 0.0 {
        let written = if kind == JointKind::Revolute { angle(joint.offset) } else { length(joint.offset) };
        fields.push(("offset", written));
    }
    let add: Vec<String> = joint.add.iter().map(|(joint, factor)| format!("t{joint}: {}", number(*factor))).collect();
    if !add.is_empty() {
        fields.push(("add", format!("{{{}}}", add.join(", "))));
    }
    flow_map(&fields)
}

fn list(field: &str, items: impl ExactSizeIterator<Item = String>) -> String {
    if items.len() == 0 {
        return String::new();
    }
    items.fold(format!("{field}:\n"), |text, item| text + "  - " + &item + "\n")
}

fn flow_map(fields: &[(&str, String)]) -> String {
    let fields: Vec<String> = fields.iter().map(|(name, value)| format!("{name}: {value}")).collect();
    format!("{{{}}}", fields.join(", "))
}

fn flow_list(items: impl IntoIterator<Item = String>) -> String {
    format!("[{}]", items.into_iter().collect::<Vec<_>>().join(", "))
}

fn placement(field: &str, placement: &Placement) -> String {
    let mut fields = Vec::new();
    if placement.xyz != [0.0; 3] {
        fields.push(("xyz", flow_list(placement.xyz.map(length))));
    }
    if placement.rpy != [0.0; 3] {
        fields.push(("rpy", flow_list(placement.rpy.map(angle))));
    }
    if fields.is_empty() { String::new() } else { format!("{field}: {}\n", flow_map(&fields)) }
}

fn joint(joint: &Joint) -> String {
    let mut fields = Vec::new();
    if joint.kind == JointKind::Prismatic {
        fields.push(("type", "prismatic".to_owned()));
    }
    fields.push(("theta", angle(joint.theta)));
    for (name, value, written) in
        [("d", joint.d, length as fn(f64) -> String), ("a", joint.a, length), ("alpha", joint.alpha, angle)]
    {
        if value != 0.0 {
            fields.push((name, written(value)));
        }
    }
    let coordinate: fn(f64) -> String = match joint.kind {
        JointKind::Revolute => angle,
        JointKind::Prismatic => length,
    };
    let unit = joint.kind.compliance().unit();
    if let Some(limits) = joint.limits {
        fields.push(("limits", flow_list(limits.map(coordinate))));
    }
    match joint.compliance.as_slice() {
        [] => {}
        [part] if part.name.is_empty() => fields.push(("compliance", in_unit(part.value, unit))),
        parts => {
            let names: Vec<String> = parts.iter().map(|part| scalar(&part.name, &[PLAIN])).collect();
            let parts: Vec<_> =
                names.iter().map(String::as_str).zip(parts.iter().map(|part| in_unit(part.value, unit))).collect();
            fields.push(("compliance", flow_map(&parts)));
        }
    }
    flow_map(&fields)
}

fn link(link: &Link) -> String {
    let mut fields = Vec::new();
    if link.mass != 0.0 {
        fields.push(("mass", in_unit(link.mass, "kg")));
    }
    if link.center_of_mass != [0.0; 3] {
        fields.push(("center_of_mass", flow_list(link.center_of_mass.map(length))));
    }
    flow_map(&fields)
}

fn effect(effect: &Effect) -> String {
    let at = match effect.place() {
        place @ Place::Joints(_) => format!("\"{place}\""),
        place => place.to_string(),
    };
    let mut fields = vec![("kind", effect.kind().to_owned()), ("at", at)];
    let written: Vec<(&str, Option<f64>, String)> = effect
        .parameters()
        .map(|(parameter, value)| {
            let text = match parameter.quantity.at(effect.place()) {
                Dimension::Number => number(value),
                dimension => in_unit(value, dimension.unit()),
            };
            (parameter.name, parameter.default.filter(|default| *default == value), text)
        })
        .collect();
    // What has its default is left out, unless nothing would be left.
    let all_default = written.iter().all(|(_, default, _)| default.is_some());
    let stated = written.into_iter().filter(|(_, default, _)| all_default || default.is_none());
    fields.extend(stated.map(|(name, _, text)| (name, text)));
    flow_map(&fields)
}

fn in_unit(value: f64, unit: &str) -> String {
    format!("{} {unit}", number(value))
}

/// In mm where that is shorter and exact, else in m.
fn length(value: f64) -> String {
    let metres = in_unit(value, "m");
    // What was 865 mm once is not 865 times 1e-3 again: try the round number too.
    [value * 1e3, (value * 1e6).round() / 1e3]
        .map(|millimetres| in_unit(millimetres, "mm"))
        .into_iter()
        .find(|text| text.len() <= metres.len() && quantity::parse(text, Dimension::Length) == Ok(value))
        .unwrap_or(metres)
}

/// In degrees where a round number of them is exact, else in rad.
fn angle(value: f64) -> String {
    let degrees = in_unit((value.to_degrees() * 1e6).round() / 1e6, "deg");
    match quantity::parse(&degrees, Dimension::Angle) {
        Ok(read) if snapped(read) == value => degrees,
        _ => in_unit(value, "rad"),
    }
}

/// Punctuation that is plain text everywhere.
const PLAIN: &str = " _-./+()";
/// Punctuation that is plain text outside brackets, behind a first letter.
const PLAIN_OUTSIDE: &str = ",;'\"%&=*!?";

/// A text on one line, in quotes where it could be read as something else.
fn scalar(text: &str, punctuation: &[&str]) -> String {
    let may_be_plain =
        |character: char| character.is_alphanumeric() || punctuation.iter().any(|allowed| allowed.contains(character));
    let is_plain = text.starts_with(|first: char| first.is_ascii_alphabetic())
        && text.chars().all(may_be_plain)
        && !text.ends_with(' ');
    // Other readers of YAML take these for a boolean, nothing or a number.
    const WORDS: [&str; 11] = ["null", "true", "false", "yes", "no", "on", "off", "y", "n", "nan", "inf"];
    if is_plain && !WORDS.contains(&text.to_ascii_lowercase().as_str()) { text.to_owned() } else { quoted(text) }
}

fn quoted(text: &str) -> String {
    let mut quoted = String::from('"');
    for character in text.chars() {
        match character {
            '"' | '\\' => quoted.extend(['\\', character]),
            '\n' => quoted += "\\n",
            other if is_unprintable(other) => {
                write!(quoted, "\\U{:08x}", u32::from(other)).expect("a string takes any text");
            }
            other => quoted.push(other),
        }
    }
    quoted + "\""
}

/// Whether YAML asks for a character to be escaped, or would take it for a
/// line break.
fn is_unprintable(character: char) -> bool {
    character.is_control() || matches!(character, '\u{2028}' | '\u{2029}' | '\u{feff}' | '\u{fffe}' | '\u{ffff}')
}

/// A text after `field:`: on the same line if it is short, else folded.
fn block(text: &str) -> String {
    if text.len() <= WIDTH && !text.contains('\n') {
        return scalar(text, &[PLAIN, PLAIN_OUTSIDE]);
    }
    let body = text.strip_suffix('\n').unwrap_or(text);
    // Folding keeps lines apart that begin with a blank, and drops blanks and
    // breaks elsewhere: such a text is quoted.
    let folds = !body.is_empty()
        && body.split('\n').all(|line| !line.starts_with(' ') && !line.ends_with(' '))
        && !body.starts_with('\n')
        && !body.ends_with('\n')
        && !body.chars().any(|character| character != '\n' && is_unprintable(character));
    if !folds {
        return quoted(text);
    }
    let mut folded = String::from(if body.len() < text.len() { ">" } else { ">-" });
    for (index, line) in body.split('\n').enumerate() {
        if index > 0 {
            // One break more than the text has: folding takes one away.
            folded.push('\n');
        }
        fold(line, &mut folded);
    }
    folded
}

/// Adds a line, broken at single blanks, each piece on an indented line.
fn fold(line: &str, folded: &mut String) {
    let mut column = 0;
    for word in words(line) {
        let width = word.chars().count();
        if column == 0 || column + 1 + width > WIDTH {
            if column > 0 || !word.is_empty() {
                folded.push_str("\n  ");
            }
            column = 2 + width;
        } else {
            folded.push(' ');
            column += 1 + width;
        }
        folded.push_str(&word);
    }
}

/// The words of a line; those with more than one blank between them stay
/// together.
fn words(line: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for piece in line.split(' ') {
        match words.last_mut() {
            Some(last) if piece.is_empty() || last.ends_with(' ') => {
                last.push(' ');
                last.push_str(piece);
            }
            _ => words.push(piece.to_owned()),
        }
    }
    words
}
