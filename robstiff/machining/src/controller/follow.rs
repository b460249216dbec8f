//! The motions of a program as joint coordinates, and back.

use nalgebra::{Isometry3, SVector, Unit, Vector3};
use robstiff::Robot;
use robstiff_robots::text::Lines;
use robstiff_robots::{Diagnostic, Diagnostics, Line};

use super::posture::{Postures, said};
use crate::compensation::Keep;
use crate::inverse::Inverse;
use crate::path::{Goal, PathPoint, SolvedPath, ToolPath, Waypoint};
use crate::program::{Document, Frame, Instruction, Language, Motion, Move, Position, Speed, Target, TextFile};

/// Joint coordinates that differ by less are the same (rad or m): rounding, below all digits that programs have.
const UNCHANGED: f64 = 1e-9;

/// Frames that a program takes from its controller, by name: tools in the controller's flange, work
/// frames in its world (m).
#[derive(Clone, Debug, Default)]
pub struct Frames {
    /// Tools.
    pub tools: Vec<(String, Isometry3<f64>)>,
    /// Work frames.
    pub works: Vec<(String, Isometry3<f64>)>,
    /// Linear motions at this speed of the TCP (m/s) or above cut nothing.
    pub rapid_from: Option<f64>,
}

/// A motion of a program, in joint coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Stop<const N: usize> {
    /// Which of the files, from 0.
    pub file: usize,
    /// The line, from 1.
    pub line: usize,
    /// Joint coordinates (rad or m) that the controller takes the arm to.
    pub q: SVector<f64, N>,
    /// Where the TCP is to be, in the base frame (m); `None` for angles of joints that a joint motion goes
    /// to, which stay as they are.
    pub wanted: Option<Isometry3<f64>>,
    /// Whether nothing is cut on the way there.
    pub rapid: bool,
    /// How fast the TCP moves there (m/s), where the program says it.
    pub feed: Option<f64>,
    /// The tool in the controller's flange.
    tool: Isometry3<f64>,
    /// The work frame in the base frame.
    work: Isometry3<f64>,
    /// How many motions before it are kept as they are: between two of them directions are known.
    run: usize,
}

/// A program whose motions are known in joint coordinates.
#[derive(Clone, Debug)]
pub struct Followed<'d, const N: usize> {
    document: &'d Document,
    lines: Vec<Lines<&'d str>>,
    /// One for each motion that is read, in order.
    pub stops: Vec<Stop<N>>,
    /// The tool of the cuts, in the controller's flange.
    pub tool: Isometry3<f64>,
}

impl<'d, const N: usize> Followed<'d, N> {
    /// Takes the motions of a program to joint coordinates, as the controller does: by its nominal
    /// model, in the posture that the program asks for, nearest to the motion before. The first is the
    /// nearest to `start`, or to the middle of the joints' ranges.
    ///
    /// # Errors
    /// The motions that cannot be taken there, each at its line: a frame that only the controller knows,
    /// a position out of reach, further axes that move.
    pub fn new(
        document: &'d Document,
        postures: &Postures<'_, N>,
        frames: &Frames,
        start: Option<&SVector<f64, N>>,
    ) -> Result<Self, Diagnostics> {
        let near = start.copied().unwrap_or_else(|| middle(postures));
        let mut walk = Walk {
            language: document.language(),
            postures,
            frames,
            tool: None,
            work: None,
            near,
            run: 0,
            external: Vec::new(),
            reported: Vec::new(),
        };
        let lines: Vec<Lines<&str>> = document.files().iter().map(|file| Lines::new(file.text.as_str())).collect();
        let (mut stops, mut problems) = (Vec::new(), Vec::new());
        for instruction in &document.program().instructions {
            match instruction {
                Instruction::Tool(frame) => walk.tool = Some(frame),
                Instruction::Work(frame) => walk.work = Some(frame),
                Instruction::KeptMove { .. } => walk.run += 1,
                Instruction::Statement { .. } => {}
                Instruction::Move(to) => match walk.stop(to) {
                    Ok(stop) => stops.push(stop),
                    Err(_) if problems.len() >= Diagnostics::MOST => {}
                    Err(Some((message, help))) => {
                        problems.push(problem(document, &lines, (to.file, to.line), message, help));
                    }
                    // Said already.
                    Err(None) => {}
                },
            }
        }
        if let Some(problems) = Diagnostics::new(problems) {
            return Err(problems);
        }
        let cuts = || stops.iter().filter(|stop: &&Stop<N>| !stop.rapid);
        let of_cut = cuts().next().or(stops.iter().find(|stop| stop.wanted.is_some()));
        let tool = of_cut.map_or_else(Isometry3::identity, |stop| stop.tool);
        Ok(Self { document, lines, stops, tool })
    }

    /// The document.
    pub fn document(&self) -> &'d Document {
        self.document
    }

    /// That all cuts are with one tool, at whose tip a force acts.
    ///
    /// # Errors
    /// The first one with another.
    pub fn one_tool(&self) -> Result<(), Diagnostics> {
        let other = self.stops.iter().find(|stop| !stop.rapid && stop.tool != self.tool);
        let Some(other) = other else { return Ok(()) };
        let message = "this motion cuts with another tool than those before it";
        let help = "forces act at the tip of one tool: correct a program for each tool";
        Err(self.refused((other.file, other.line), message.to_owned(), help))
    }

    /// The path of the real arm, whose tool is [`tool`](Self::tool): joint coordinates that bring it to
    /// where the program wants the TCP. With `taught` that is where the arm stands at the positions,
    /// which were taught on it. `axis` is that of the tool in the TCP's frame.
    ///
    /// # Errors
    /// Motions that the real arm cannot do.
    pub fn path<R: Robot<N>>(
        &self,
        arm: &R,
        axis: Unit<Vector3<f64>>,
        taught: bool,
    ) -> Result<(ToolPath, SolvedPath<N>), Diagnostics> {
        let (inverse, keep) = (Inverse::new(arm), Keep::of(N, axis));
        let (mut points, mut problems) = (Vec::with_capacity(self.stops.len()), Vec::new());
        for stop in &self.stops {
            let q = match stop.wanted.filter(|_| !taught) {
                None => Ok(stop.q),
                Some(wanted) => {
                    let tip = wanted * stop.tool.inverse() * self.tool;
                    inverse.nearest(&keep.target(&tip.to_homogeneous()), &stop.q)
                }
            };
            match q {
                Ok(q) => points.push(Waypoint {
                    line: stop.line,
                    goal: Goal::Joints(q.iter().copied().collect()),
                    feed: stop.feed,
                    s: None,
                    rapid: stop.rapid,
                    spindle: None,
                    tool: None,
                    width: None,
                    depth: None,
                }),
                Err(_) if problems.len() >= Diagnostics::MOST => {}
                Err(why) => {
                    let help = "the controller gets there, the described arm does not: keep away from the limits";
                    problems.push(self.problem((stop.file, stop.line), why.to_string(), help));
                }
            }
        }
        match Diagnostics::new(problems) {
            Some(problems) => Err(problems),
            None => {
                let solved = self.solved(arm, &points, axis)?;
                Ok((self.tool_path(points, axis), solved))
            }
        }
    }

    /// Stretch by stretch: what lies between two motions that are kept has no direction.
    fn solved<R: Robot<N>>(
        &self,
        arm: &R,
        points: &[Waypoint],
        axis: Unit<Vector3<f64>>,
    ) -> Result<SolvedPath<N>, Diagnostics> {
        let mut all: SolvedPath<N> = SolvedPath { points: Vec::with_capacity(points.len()), jumps: Vec::new() };
        let mut from = 0;
        for stops in self.stops.chunk_by(|one, other| one.run == other.run) {
            let part = self.tool_path(points[from..from + stops.len()].to_vec(), axis);
            let solved = part.solve(arm, None).map_err(|unsolved| unsolved.problems)?;
            let before = all.points.last().map_or(0.0, |point| point.s);
            all.points.extend(solved.points.into_iter().map(|point| PathPoint { s: before + point.s, ..point }));
            all.jumps.extend(solved.jumps);
            from += stops.len();
        }
        Ok(all)
    }

    /// Lines are those of the one file that has all motions; of several none is shown.
    fn tool_path(&self, points: Vec<Waypoint>, axis: Unit<Vector3<f64>>) -> ToolPath {
        let files = self.document.files();
        let first = self.stops.first().map_or(0, |stop| stop.file);
        let one = self.stops.iter().all(|stop| stop.file == first);
        let text = if one { files[first].text.clone() } else { String::new() };
        ToolPath::of_motions(&files[if one { first } else { 0 }].name, text, points, axis)
    }

    /// The positions at which the controller takes the arm to these joint coordinates (rad or m), one for
    /// each stop, in the form that the program has; and the stops that are then in another posture or turn
    /// than the program says.
    ///
    /// # Panics
    /// If there is another number of coordinates than stops.
    pub fn positions(
        &self,
        postures: &Postures<'_, N>,
        commanded: &[SVector<f64, N>],
    ) -> (Vec<Position>, Vec<(usize, String)>) {
        assert_eq!(commanded.len(), self.stops.len(), "joint coordinates for every motion");
        let mut otherwise = Vec::new();
        let moves = self.document.moves().zip(&self.stops).zip(commanded).enumerate();
        let positions = moves.map(|(i, ((to, stop), q))| {
            // What is not corrected stays byte for byte.
            if stop.wanted.is_none() || (q - stop.q).amax() < UNCHANGED {
                return to.position.clone();
            }
            let target = match &to.position.target {
                Target::Joints(_) => Target::Joints(postures.nominal.pendant(q)),
                Target::Pose(_, configuration) => {
                    let now = postures.configuration(q, self.document.language());
                    let before = postures.configuration(&stop.q, self.document.language());
                    // A joint motion minds if an axis that was at 0 degrees is a little below.
                    let leaves = to.motion == Motion::Joint && before != now;
                    if let Some((asked, now)) = configuration.zip(now)
                        && (leaves || !postures.is(q, &asked))
                    {
                        otherwise.push((i, format!("{} in place of {}", said(&now), said(&asked))));
                    }
                    Target::Pose(stop.work.inverse() * postures.nominal.pose(q, &stop.tool), *configuration)
                }
            };
            Position { target, external: to.position.external.clone() }
        });
        let positions = positions.collect();
        (positions, otherwise)
    }

    /// The files with these positions.
    ///
    /// # Errors
    /// Two motions to one point that are to be in different places.
    pub fn files(&self, positions: &[Position]) -> Result<Vec<TextFile>, Diagnostics> {
        self.document.with_positions(positions).map_err(|shared| {
            let [_, second] = shared.lines;
            let file = self.stops.iter().find(|stop| stop.line == second).map_or(0, |stop| stop.file);
            self.refused((file, second), shared.to_string(), "give each motion a point for itself")
        })
    }

    fn problem(&self, place: (usize, usize), message: String, help: &str) -> Diagnostic {
        problem(self.document, &self.lines, place, message, help.to_owned())
    }

    fn refused(&self, place: (usize, usize), message: String, help: &str) -> Diagnostics {
        Diagnostics::new(vec![self.problem(place, message, help)]).expect("there is a problem")
    }
}

/// A problem at a line, at what it says behind its indentation.
fn problem(
    document: &Document,
    lines: &[Lines<&str>],
    (file, number): (usize, usize),
    message: String,
    help: String,
) -> Diagnostic {
    let text = lines[file].line(number);
    let indent = text.chars().take_while(|letter| letter.is_whitespace()).count();
    let width = text.trim().chars().count();
    Diagnostic::new(&document.files()[file].name, Line { number, text }, (indent + 1, width), message, help)
}

/// The middle of the joints' ranges.
fn middle<const N: usize>(postures: &Postures<'_, N>) -> SVector<f64, N> {
    let middle = |limits: Option<[f64; 2]>| limits.map_or(0.0, |[low, high]| 0.5 * (low + high));
    SVector::from_iterator(postures.nominal.arm.limits().into_iter().map(middle))
}

/// A message and what would be right; `None` where it was said before.
type Refusal = Option<(String, String)>;

/// What holds at a motion.
struct Walk<'w, const N: usize> {
    language: Language,
    postures: &'w Postures<'w, N>,
    frames: &'w Frames,
    tool: Option<&'w Frame>,
    work: Option<&'w Frame>,
    near: SVector<f64, N>,
    run: usize,
    /// Where the further axes are, as far as it is said.
    external: Vec<Option<f64>>,
    /// Frames that are reported as unknown.
    reported: Vec<String>,
}

impl<'w, const N: usize> Walk<'w, N> {
    fn stop(&mut self, to: &'w Move) -> Result<Stop<N>, Refusal> {
        if !self.stands_by(&to.position.external) {
            let message = "further axes move, and the description has those of the arm alone";
            return Err(Some((
                message.to_owned(),
                "correct the program of each place of the arm by itself".to_owned(),
            )));
        }
        let rapid = to.motion == Motion::Joint || self.is_fast(to);
        let feed = match to.speed {
            Some(Speed::Tool(speed)) if to.motion == Motion::Linear && speed > 0.0 => Some(speed),
            _ => None,
        };
        let nominal = self.postures.nominal;
        let (q, wanted, tool, work) = match &to.position.target {
            Target::Joints(angles) => {
                let q = nominal.joints(angles).ok_or_else(|| {
                    let message = format!("the position has {} angles, the robot {N} joints", angles.len());
                    Some((message, "give one for each joint".to_owned()))
                })?;
                let identity = Isometry3::identity();
                if to.motion == Motion::Joint {
                    (q, None, identity, identity)
                } else {
                    let tool = self.tool()?;
                    (q, Some(nominal.pose(&q, &tool)), tool, identity)
                }
            }
            Target::Pose(pose, configuration) => {
                let (tool, work) = (self.tool()?, self.work()?);
                let work = nominal.in_base(&work);
                let wanted = work * pose;
                let q = self.postures.solve(&wanted, &tool, configuration.as_ref(), &self.near).map_err(|why| {
                    let help = "are `controller`, the tool and the work frame those of the real controller?";
                    Some((why.to_string(), help.to_owned()))
                })?;
                (q, Some(wanted), tool, work)
            }
        };
        self.near = q;
        Ok(Stop { file: to.file, line: to.line, q, wanted, rapid, feed, tool, work, run: self.run })
    }

    /// Whether further axes stay where they are; those of which nothing is said do.
    fn stands_by(&mut self, external: &[Option<f64>]) -> bool {
        if self.external.len() < external.len() {
            self.external.resize(external.len(), None);
        }
        let mut pairs = self.external.iter_mut().zip(external);
        pairs.all(|(stands, given)| match given {
            Some(value) => *stands.get_or_insert(*value) == *value,
            None => true,
        })
    }

    fn is_fast(&self, to: &Move) -> bool {
        match (&to.speed, self.frames.rapid_from) {
            (Some(Speed::Tool(speed)), Some(from)) => *speed >= from,
            _ => false,
        }
    }

    fn tool(&mut self) -> Result<Isometry3<f64>, Refusal> {
        let frames = self.frames;
        self.frame(self.tool, &frames.tools, ("tool", "--tool-data"))
    }

    fn work(&mut self) -> Result<Isometry3<f64>, Refusal> {
        let frames = self.frames;
        self.frame(self.work, &frames.works, ("work frame", "--work-data"))
    }

    fn frame(
        &mut self,
        frame: Option<&Frame>,
        given: &[(String, Isometry3<f64>)],
        (what, option): (&str, &str),
    ) -> Result<Isometry3<f64>, Refusal> {
        if let Some(pose) = frame.and_then(|frame| frame.pose) {
            return Ok(pose);
        }
        let name = frame.map_or("", |frame| frame.name.as_str());
        if let Some((_, pose)) = given.iter().find(|(known, _)| known.eq_ignore_ascii_case(name)) {
            return Ok(*pose);
        }
        // Frame 0 of a TP program is the world, tool 0 the flange.
        if self.language == Language::Ls && name == "0" {
            return Ok(Isometry3::identity());
        }
        let (whole, message) = match name {
            "" => (what.to_owned(), format!("the program does not say which {what} it is with")),
            name => {
                (format!("{what} {name}"), format!("where the {what} `{name}` stands is known to the controller alone"))
            }
        };
        if self.reported.contains(&whole) {
            return Err(None);
        }
        self.reported.push(whole);
        let help = format!("give it: {option} \"{name} = x, y, z, roll, pitch, yaw\"");
        Err(Some((message, help)))
    }
}
