//! Reading a URDF file.

use core::f64::consts::FRAC_PI_2;
use core::ops::Range;
use std::collections::{HashMap, HashSet};

use nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion, Vector3};
use roxmltree::{Document, Node};

use super::{Body, Connection, Hangs, Motion, Tree};
use crate::bare::in_si;
use crate::document::without_byte_order_mark;
use crate::quantity::Dimension;
use crate::suggest::list;
use crate::text::{Lines, MOST_OF_URDF, larger};
use crate::words::count;
use crate::{Diagnostic, Diagnostics, JointKind, Line, ReadError, text};

/// A reader with the problems found so far.
pub(super) struct Reader<'t> {
    file: &'t str,
    lines: &'t Lines<String>,
    problems: Vec<Diagnostic>,
    warnings: Vec<String>,
    rounded: usize,
}

impl Tree {
    /// Reads a URDF file.
    ///
    /// # Errors
    /// A file that cannot be read; what is wrong with it, each problem at its
    /// place.
    pub fn read(path: impl AsRef<std::path::Path>) -> Result<Self, ReadError> {
        let path = path.as_ref();
        Self::parse(&path.display().to_string(), &text::read(path, MOST_OF_URDF)?).map_err(ReadError::Invalid)
    }

    /// Reads a URDF text; `file` is the name that problems show.
    ///
    /// An angle that is a multiple of 90 degrees rounded to the decimals that it
    /// is written with, such as `1.5708`, is that multiple.
    ///
    /// # Errors
    /// What is wrong with it, each problem at its place; more text than
    /// [`MOST_OF_URDF`], elements that are nested too deep.
    pub fn parse(file: &str, text: &str) -> Result<Self, Diagnostics> {
        let whole = text;
        let text = without_byte_order_mark(text);
        if text.len() > MOST_OF_URDF {
            let (line, message) = (Line { number: 1, text: "" }, format!("this text is {}", larger(MOST_OF_URDF)));
            return Err(Diagnostic::new(file, line, (1, 1), message, "a URDF file names its meshes").into());
        }
        let lines = Lines::new(text.to_owned());
        if let Some((at, message)) = too_many(text) {
            let help = "a URDF file names a namespace or two, and its elements have a few attributes";
            return Err(self::at(file, &lines, &(at..at + 1), &message, help).into());
        }
        let document = Document::parse(text).map_err(|error| {
            let help = "close every element and every quote; `&` and `<` in a text are `&amp;` and `&lt;`";
            let problem = |number, column, message: &str| {
                Diagnostic::new(file, line(&lines, number), (column, 1), format!("this is not XML: {message}"), help)
            };
            // Of a file that is cut off the parser tells the beginning.
            if matches!(error, roxmltree::Error::UnexpectedEndOfStream | roxmltree::Error::UnclosedRootNode) {
                // Behind the end of the last line is no other.
                let (number, column) = lines.place(text.strip_suffix('\n').unwrap_or(text).len());
                return problem(number, column, "the file ends before its root element does");
            }
            let (at, message) = (error.pos(), error.to_string());
            // The place is shown on its own.
            problem(at.row as usize, at.col as usize, message.trim_end_matches(&format!(" at {at}")))
        })?;
        let mut reader = Reader { file, lines: &lines, problems: Vec::new(), warnings: Vec::new(), rounded: 0 };
        let tree = reader.tree(document.root_element());
        let rounded = reader.rounded;
        if rounded > 0 {
            let (angles, are) = if rounded == 1 { ("angle", "is") } else { ("angles", "are") };
            let warning = format!(
                "{file}: {rounded} {angles} such as 1.5708 {are} taken as the multiple of 90 degrees that was rounded"
            );
            reader.warnings.push(warning);
        }
        let (problems, warnings) = (reader.problems, reader.warnings);
        match Diagnostics::new(problems) {
            Some(problems) => Err(problems),
            None => Ok(Self { warnings, lines, is_marked: text.len() < whole.len(), ..tree }),
        }
    }

    /// Where problems of the whole file are shown: at its first character.
    pub(super) fn whole(&self) -> Range<usize> {
        0..self.lines.text().chars().next().map_or(0, char::len_utf8)
    }

    /// A problem at a place of the file.
    pub(super) fn problem(&self, place: &Range<usize>, message: &str, help: &str) -> Diagnostics {
        at(&self.file, &self.lines, place, message, help).into()
    }
}

/// A line of the text, empty where there is none.
fn line(lines: &Lines<String>, number: usize) -> Line<'_> {
    Line { number, text: lines.line(number) }
}

/// A problem with a range of the text, shown in its first line.
fn at(file: &str, lines: &Lines<String>, place: &Range<usize>, message: &str, help: &str) -> Diagnostic {
    let (number, column) = lines.place(place.start);
    let end = lines.range(number).end.min(place.end).max(place.start);
    let shown = &lines.text()[place.start..end];
    // Of an element only its start tag.
    let width = shown.find('>').map_or(shown, |end| &shown[..=end]).chars().count();
    Diagnostic::new(file, line(lines, number), (column, width), message, help)
}

/// Attributes of an element, and declarations of namespaces in a file. The parser compares each
/// with all others, so that a file of nothing else would take it hours.
const MOST_ATTRIBUTES: usize = 1000;

/// The byte of the start tag that has too many of them, and what is said of it.
fn too_many(text: &str) -> Option<(usize, String)> {
    let (mut namespaces, mut from) = (0, 0);
    while let Some(start) = text[from..].find('<').map(|at| from + at) {
        // In a comment a quote is a letter.
        let skipped =
            [("<!--", "-->"), ("<![CDATA[", "]]>")].into_iter().find(|(open, _)| text[start..].starts_with(open));
        if let Some((_, close)) = skipped {
            from = text[start..].find(close).map_or(text.len(), |at| start + at);
            continue;
        }
        let (mut quote, mut attributes) = (None, 0);
        from = text.len();
        for (at, byte) in text.bytes().enumerate().skip(start + 1) {
            match (quote, byte) {
                (None, b'>') => {
                    from = at;
                    break;
                }
                (None, b'=') => attributes += 1,
                (None, b'"' | b'\'') => quote = Some(byte),
                (Some(open), _) if open == byte => quote = None,
                _ => {}
            }
        }
        namespaces += text[start..from].matches("xmlns").count();
        let said = |what| format!("more than {MOST_ATTRIBUTES} {what}");
        match (attributes, namespaces) {
            (MOST_ATTRIBUTES.., _) => return Some((start, said("attributes of an element"))),
            (_, MOST_ATTRIBUTES..) => return Some((start, said("declarations of namespaces"))),
            _ => {}
        }
    }
    None
}

impl Reader<'_> {
    /// Whether as many problems are recorded as anybody reads.
    fn is_full(&self) -> bool {
        self.problems.len() >= Diagnostics::MOST
    }

    pub(super) fn report(&mut self, place: &Range<usize>, message: &str, help: &str) {
        if !self.is_full() {
            self.problems.push(at(self.file, self.lines, place, message, help));
        }
    }

    /// What the reader does not refuse, with its line.
    pub(super) fn warn(&mut self, node: Node<'_, '_>, message: &str) {
        let line = self.lines.number_at(node.range().start);
        self.warnings.push(format!("{}:{line}: {message}", self.file));
    }

    fn tree(&mut self, root: Node<'_, '_>) -> Tree {
        if root.tag_name().name() != "robot" {
            let message = format!("the root element is `{}`, not `robot`", root.tag_name().name());
            self.report(&root.range(), &message, "a URDF file is `<robot name=\"..\"> .. </robot>`");
        }
        let is_macro = |node: &Node<'_, '_>| node.tag_name().namespace().is_some_and(|space| space.contains("xacro"));
        if let Some(node) = root.descendants().find(is_macro) {
            let help = "expand it first: `xacro FILE.xacro > FILE.urdf`";
            self.report(&node.range(), "this is a xacro file, not a URDF file", help);
        }
        self.spelling(root);
        let elements = |name: &'static str| root.children().filter(move |node| node.has_tag_name(name));
        let mut links = Links::default();
        for node in elements("link") {
            self.spelling(node);
            let Some(name) = self.attribute(node, "name") else { continue };
            if links.named.contains_key(&name) {
                self.report(&node.range(), &format!("the link `{name}` is there twice"), "give one another name");
            }
            let inertia = self.inertia(node);
            links.push(Body { name, inertia, place: node.range() });
        }
        let (mut joints, mut names): (Vec<Connection>, HashSet<String>) = (Vec::new(), HashSet::new());
        let mut hangs = Hangs::of(links.all.len());
        for node in elements("joint") {
            let joint = self.joint(node, &links);
            let Some(joint) = joint else { continue };
            if !names.insert(joint.name.clone()) {
                let message = format!("the joint `{}` is there twice", joint.name);
                self.report(&node.range(), &message, "give one another name");
            }
            if hangs.on[joint.child].is_some() {
                let child = &links.all[joint.child].name;
                let message = format!("the link `{child}` hangs on two joints");
                self.report(&node.range(), &message, "a URDF file is a tree: give every link one parent");
            }
            hangs.add(joints.len(), &joint);
            joints.push(joint);
        }
        let links = links.all;
        if root.has_tag_name("robot") && elements("link").next().is_none() {
            self.report(
                &root.range(),
                "the file has no links",
                "a chain leads from link to link: `<link name=\"..\"/>`",
            );
        }
        if let Some(joint) = hangs.in_a_ring(&joints) {
            let message = format!("the link `{}` hangs on itself, in a ring of joints", links[joint.child].name);
            self.report(&joint.place, &message, "a URDF file is a tree: leave out the joint that closes the ring");
        }
        Tree {
            name: root.attribute("name").unwrap_or_default().to_owned(),
            links,
            joints,
            warnings: Vec::new(),
            file: self.file.to_owned(),
            lines: Lines::new(String::new()),
            is_marked: false,
            hangs,
        }
    }

    fn joint(&mut self, node: Node<'_, '_>, links: &Links) -> Option<Connection> {
        self.spelling(node);
        let name = self.attribute(node, "name");
        let kind = self.attribute(node, "type");
        let parent = self.end(node, "parent", links);
        let child = self.end(node, "child", links);
        let origin = self.origin(node);
        // Others may have one, of any numbers: it means nothing.
        let moves = matches!(kind.as_deref(), Some("revolute" | "continuous" | "prismatic"));
        let axis = if moves { self.axis(node) } else { None };
        let limits = self.limits(node, kind.as_deref());
        let (name, kind) = (name?, kind?);
        let mimics = element(node, "mimic").is_some();
        let moving = |kind, limits| Some(Motion::Axis { kind, axis: axis?, limits, mimics });
        let motion = match kind.as_str() {
            "fixed" => None,
            "revolute" => Some(moving(JointKind::Revolute, limits)?),
            "continuous" => Some(moving(JointKind::Revolute, None)?),
            "prismatic" => Some(moving(JointKind::Prismatic, limits)?),
            "floating" | "planar" => Some(Motion::Other(kind)),
            other => {
                let known = ["revolute", "continuous", "prismatic", "fixed", "floating", "planar"];
                let place = node.attribute_node("type").map_or(node.range(), |attribute| attribute.range_value());
                self.report(&place, &format!("unknown type of joint `{other}`"), &format!("one of {}", list(known)));
                return None;
            }
        };
        Some(Connection { name, motion, parent: parent?, child: child?, origin: origin?, place: node.range() })
    }

    /// An attribute whose absence is reported.
    fn attribute(&mut self, node: Node<'_, '_>, name: &str) -> Option<String> {
        let value = node.attribute(name);
        if value.is_none() {
            let tag = node.tag_name().name();
            self.report(&node.range(), &format!("`{tag}` has no `{name}`"), &format!("write `<{tag} {name}=\"..\">`"));
        }
        value.map(str::to_owned)
    }

    /// The link that `parent` or `child` names.
    fn end(&mut self, node: Node<'_, '_>, tag: &str, links: &Links) -> Option<usize> {
        let Some(end) = element(node, tag) else {
            self.report(&node.range(), &format!("the joint has no `{tag}`"), &format!("write `<{tag} link=\"..\"/>`"));
            return None;
        };
        let name = self.attribute(end, "link")?;
        let index = links.named.get(&name).copied();
        if index.is_none() && !self.is_full() {
            let place = end.attribute_node("link").map_or(end.range(), |attribute| attribute.range_value());
            let near = crate::suggest::closest(&name, links.all.iter().map(|link| link.name.as_str()));
            let help = near.map_or("a joint's links are elements `link` of the same file".to_owned(), |near| {
                format!("did you mean `{near}`?")
            });
            self.report(&place, &format!("there is no link `{name}`"), &help);
        }
        index
    }

    /// Mass and centre of mass.
    fn inertia(&mut self, node: Node<'_, '_>) -> Option<(f64, Vector3<f64>)> {
        let inertial = element(node, "inertial")?;
        self.spelling(inertial);
        let mass = element(inertial, "mass")?;
        let [value] = self.numbers(mass, "value", Dimension::Mass)?;
        if value < 0.0 {
            self.report(&mass.range(), "the mass is negative", "write a mass in kg, or leave `inertial` out");
            return None;
        }
        let center = self.origin(inertial)?.translation.vector;
        Some((value, center))
    }

    fn origin(&mut self, node: Node<'_, '_>) -> Option<Isometry3<f64>> {
        let Some(origin) = element(node, "origin") else { return Some(Isometry3::identity()) };
        let xyz =
            if origin.has_attribute("xyz") { self.numbers(origin, "xyz", Dimension::Length) } else { Some([0.0; 3]) };
        let rpy = if origin.has_attribute("rpy") { self.angles(origin) } else { Some([0.0; 3]) };
        let ([x, y, z], [roll, pitch, yaw]) = (xyz?, rpy?);
        let turn = Rotation3::from_matrix_unchecked(exact_turn(roll, pitch, yaw));
        Some(Isometry3::from_parts(Translation3::new(x, y, z), UnitQuaternion::from_rotation_matrix(&turn)))
    }

    /// Roll, pitch and yaw, with those that were rounded made exact.
    fn angles(&mut self, node: Node<'_, '_>) -> Option<[f64; 3]> {
        let mut angles: [f64; 3] = self.numbers(node, "rpy", Dimension::Angle)?;
        let texts = node.attribute("rpy").unwrap_or_default().split_whitespace();
        for (angle, text) in angles.iter_mut().zip(texts) {
            if let Some(exact) = unrounded(*angle, text) {
                self.rounded += usize::from((exact - *angle).abs() > crate::angle::SNAP);
                *angle = exact;
            }
        }
        Some(angles)
    }

    /// The finite numbers of an attribute, of which none is more than a robot can have in SI.
    pub(super) fn numbers<const K: usize>(
        &mut self,
        node: Node<'_, '_>,
        name: &str,
        dimension: Dimension,
    ) -> Option<[f64; K]> {
        let Some(attribute) = node.attribute_node(name) else {
            let tag = node.tag_name().name();
            // No axis points nowhere.
            let last = if tag == "axis" { "1" } else { "0" };
            let numbers = [vec!["0"; K - 1], vec![last]].concat().join(" ");
            let help = format!("write `<{tag} {name}=\"{numbers}\"/>`");
            self.report(&node.range(), &format!("`{tag}` has no `{name}`"), &help);
            return None;
        };
        let place = attribute.range_value();
        let words: Vec<&str> = attribute.value().split_whitespace().collect();
        let mut values = [0.0; K];
        if words.len() != K {
            let numbers = |number| count(number, "number");
            let message = format!("`{name}` has {}, {K} expected", numbers(words.len()));
            self.report(&place, &message, &format!("{}, in SI", numbers(K)));
            return None;
        }
        for (value, word) in values.iter_mut().zip(words) {
            match word.parse::<f64>() {
                Ok(number) if number.is_finite() => match in_si(number, dimension) {
                    Ok(number) => *value = number,
                    Err(beyond) => {
                        self.report(&place, &beyond.message, "a URDF file has lengths in m and angles in rad");
                        return None;
                    }
                },
                _ if word.contains("${") => {
                    let help = "expand it first: `xacro FILE.xacro > FILE.urdf`";
                    self.report(&place, &format!("`{word}` is a macro of xacro"), help);
                    return None;
                }
                _ => {
                    let help = match dimension {
                        Dimension::Mass => "a mass in kg",
                        Dimension::Number => "a direction, of any length",
                        _ => "lengths in m, angles in rad",
                    };
                    self.report(&place, &format!("`{word}` is not a finite number"), help);
                    return None;
                }
            }
        }
        Some(values)
    }
}

/// The links read so far, with the index of each name, the first where several have it.
#[derive(Default)]
struct Links {
    all: Vec<Body>,
    named: HashMap<String, usize>,
}

impl Links {
    fn push(&mut self, link: Body) {
        self.named.entry(link.name.clone()).or_insert(self.all.len());
        self.all.push(link);
    }
}

impl Hangs {
    fn of(links: usize) -> Self {
        Self { on: vec![None; links], carries: vec![Vec::new(); links] }
    }

    fn add(&mut self, index: usize, joint: &Connection) {
        self.on[joint.child].get_or_insert(index);
        self.carries[joint.parent].push(index);
    }

    /// The first joint that is in a ring: its child is above it, too.
    fn in_a_ring<'j>(&self, joints: &'j [Connection]) -> Option<&'j Connection> {
        // On which way up a link was met, from 1: each is gone through once.
        let mut met = vec![0; self.on.len()];
        let mut first = None;
        for way in 1..=self.on.len() {
            let mut link = way - 1;
            while met[link] == 0 {
                met[link] = way;
                let Some(joint) = self.on[link] else { break };
                link = joints[joint].parent;
            }
            // A way that meets itself has come round.
            if met[link] == way && self.on[link].is_some() {
                let ring = core::iter::successors(self.on[link], |&joint| self.on[joints[joint].parent]);
                let ring = ring.enumerate().take_while(|&(steps, joint)| steps == 0 || joints[joint].child != link);
                first = ring.map(|(_, joint)| joint).chain(first).min();
            }
        }
        first.map(|joint| &joints[joint])
    }
}

pub(super) fn element<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    // With a prefix it is an extension, whatever its name.
    let is_own = |child: &Node<'a, 'i>| child.tag_name().namespace() == node.tag_name().namespace();
    node.children().find(|child| child.has_tag_name(name) && is_own(child))
}

/// Decimals beyond which powers of ten are no longer exact.
const MOST_DECIMALS: usize = 22;

/// The multiple of 90 degrees that a number of at least two decimals is, when
/// that is rounded or, as is common too, truncated to as many.
pub(super) fn unrounded(value: f64, text: &str) -> Option<f64> {
    let (_, decimals) = text.split_once('.')?;
    // No number is written with more than its digits.
    let counts = (2..=MOST_DECIMALS).contains(&decimals.len());
    if !counts || !decimals.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let exact = (value / FRAC_PI_2).round() * FRAC_PI_2;
    let units = |value: f64| value * 10_f64.powi(decimals.len() as i32);
    let written = units(value).round();
    let is_exact = (value - exact).abs() <= crate::angle::SNAP;
    (is_exact || written == units(exact).round() || written == units(exact).trunc()).then_some(exact)
}

/// `Rz(yaw) Ry(pitch) Rx(roll)`, exact at the multiples of 90 degrees.
pub(super) fn exact_turn(roll: f64, pitch: f64, yaw: f64) -> nalgebra::Matrix3<f64> {
    let sin_cos =
        |angle: f64| crate::angle::quarter_turns(angle).map_or_else(|| angle.sin_cos(), crate::angle::sin_cos_of_turns);
    let ((sr, cr), (sp, cp), (sy, cy)) = (sin_cos(roll), sin_cos(pitch), sin_cos(yaw));
    let x = nalgebra::Matrix3::new(1.0, 0.0, 0.0, 0.0, cr, -sr, 0.0, sr, cr);
    let y = nalgebra::Matrix3::new(cp, 0.0, sp, 0.0, 1.0, 0.0, -sp, 0.0, cp);
    let z = nalgebra::Matrix3::new(cy, -sy, 0.0, sy, cy, 0.0, 0.0, 0.0, 1.0);
    z * y * x
}
