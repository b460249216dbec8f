//! APT and CLDATA, statement by statement.

use std::collections::VecDeque;

use nalgebra::{Unit, Vector3};

use super::arc::{Arc, Given};
use super::moves::{Move, Options, tool_number};
use super::notes::{Note, Notes};
use super::statement::{Problem, Statement};
use super::track::{Common, Pace, Shape, Turn, split};

/// What is between statements. Lengths are in m.
pub struct Apt<'o> {
    options: &'o Options,
    statement: Statement,
    is_open: bool,
    unit: Option<f64>,
    at: Option<Vector3<f64>>,
    axis: Unit<Vector3<f64>>,
    feed: Option<Feed>,
    is_rapid: bool,
    spindle: f64,
    speed: f64,
    tool: Option<u32>,
    circle: Option<Circle>,
    held: Option<Held>,
    system: Option<Vec<f64>>,
    ended: bool,
}

/// m/s, or m a turn.
#[derive(Clone, Copy)]
enum Feed {
    PerSecond(f64),
    PerTurn(f64),
}

#[derive(Clone, Copy)]
struct Circle {
    center: Vector3<f64>,
    axis: Unit<Vector3<f64>>,
    radius: f64,
    /// What it sweeps (rad), where the statement says it.
    angle: Option<f64>,
    /// Whether points on it may follow, and not its end alone.
    may_be_points: bool,
}

/// A move along a circle that waits for what follows it: another point of the circle, and both are
/// ends of chords, or anything else, and it is the end of an arc.
struct Held {
    statement: Statement,
    circle: Circle,
    to: Vector3<f64>,
    axis: Unit<Vector3<f64>>,
    pace: Pace,
}

/// Statements that are known and change nothing here.
const WITHOUT_EFFECT: [&str; 33] = [
    "PARTNO",
    "PPRINT",
    "TPRINT",
    "REMARK",
    "MACHIN",
    "CUTTER",
    "COOLNT",
    "INTOL",
    "OUTTOL",
    "TOLER",
    "LINTOL",
    "PAINT",
    "TLDATA",
    "TOOL PATH",
    "END-OF-PATH",
    "END",
    "STOP",
    "OPSTOP",
    "OPSKIP",
    "DELAY",
    "DWELL",
    "MODE",
    "REWIND",
    "SEQNO",
    "LEADER",
    "CLPRNT",
    "NOPOST",
    "DISPLY",
    "CLEARP",
    "SELECT",
    "SELCTL",
    "THICK",
    "",
];

/// Statements that move the tool or the coordinates and are not followed.
const NOT_FOLLOWED: [&str; 22] = [
    "GOFWD", "GOLFT", "GORGT", "GOBACK", "GOUP", "GODOWN", "TLON", "TLLFT", "TLRGT", "INDIRV", "INDIRP", "GO",
    "GOHOME", "RETRCT", "GOCLER", "ORIGIN", "TRANS", "ROTATE", "ROTABL", "ROTHED", "TRACUT", "COPY",
];

/// How far a point may be from the circle that it is on (m), or by which share of the radius.
const ON_CIRCLE: f64 = 1e-4;
const ON_CIRCLE_SHARE: f64 = 1e-3;

/// How far a swept angle may be from the one that is said (rad).
const SAME_ANGLE: f64 = 0.02;

const PLAIN: &str = "have the CAM system write GOTO with points, or MOVARC";

impl<'o> Apt<'o> {
    /// The state that programs begin in.
    pub fn new(options: &'o Options) -> Self {
        Self {
            options,
            statement: Statement::default(),
            is_open: false,
            unit: None,
            at: None,
            axis: Vector3::z_axis(),
            feed: None,
            is_rapid: false,
            spindle: 0.0,
            speed: 0.0,
            tool: None,
            circle: None,
            held: None,
            system: None,
            ended: false,
        }
    }

    /// Reads a line, and puts its moves behind those in a queue. `false` behind the end of the
    /// program.
    ///
    /// # Errors
    /// What is wrong with it or the statement that ends in it.
    pub fn line(
        &mut self,
        number: usize,
        text: &str,
        moves: &mut VecDeque<Move>,
        notes: &mut Notes,
    ) -> Result<bool, Problem> {
        if self.ended {
            return Ok(notes.behind(text.trim().is_empty() || text.trim().starts_with("$$"), number));
        }
        let goes_on = core::mem::take(&mut self.is_open);
        let mut statement = core::mem::take(&mut self.statement);
        let read = statement.take(number, text, goes_on).and_then(|is_open| {
            self.is_open = is_open;
            if is_open { Ok(()) } else { self.execute(&statement, moves, notes) }
        });
        self.statement = statement;
        read.map(|()| true)
    }

    /// What is left at the end.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn finish(&mut self, moves: &mut VecDeque<Move>, notes: &mut Notes) -> Result<(), Problem> {
        if self.is_open {
            return Err(self.statement.fault("the statement goes on behind the end of the file", "end it without `$`"));
        }
        self.release(None, moves, notes)
    }

    fn execute(&mut self, statement: &Statement, moves: &mut VecDeque<Move>, notes: &mut Notes) -> Result<(), Problem> {
        let first = statement.major.split([' ', ',']).next().unwrap_or_default();
        if statement.major != "GOTO" {
            self.release(None, moves, notes)?;
        }
        match statement.major.as_str() {
            "GOTO" | "FROM" | "GODLTA" => return self.go(statement, moves, notes),
            "RAPID" => self.is_rapid = true,
            "UNITS" => self.units(statement)?,
            "FEDRAT" => self.feed = Some(self.feed(statement)?),
            "SPINDL" => self.spindle(statement)?,
            "LOADTL" | "TOOLNO" | "LOAD" | "TURRET" => {
                let Some(number) = statement.first_number().and_then(tool_number) else {
                    return Err(statement.fault("the tool has no number", "e.g. `LOADTL/3`"));
                };
                self.tool = Some(number);
            }
            "MULTAX" if statement.has("OFF") => self.axis = Vector3::z_axis(),
            "MULTAX" => {}
            "TLAXIS" => self.axis = axis(statement, &statement.numbers()?)?,
            "CIRCLE" | "MOVARC" => self.circle = Some(self.circle(statement)?),
            "CUTCOM" | "CYCLE" if statement.has("OFF") => {}
            "CUTCOM" => {
                let help = "have the CAM system write the path of the tool's centre";
                return Err(statement.fault("cutter compensation (CUTCOM) is not followed", help));
            }
            "CYCLE" => return Err(statement.fault("cycles (CYCLE) are not followed", PLAIN)),
            "MSYS" => {
                let numbers = statement.numbers()?;
                if self.system.get_or_insert_with(|| numbers.clone()) != &numbers {
                    let help = "write a file for each system of coordinates";
                    return Err(statement.fault("another system of coordinates (MSYS) than before", help));
                }
            }
            "FINI" => self.ended = true,
            _ if NOT_FOLLOWED.contains(&first) => {
                return Err(statement.fault(format!("{first} is not followed"), PLAIN));
            }
            major if major.contains('=') => {
                return Err(statement.fault("definitions (=) are not followed", PLAIN));
            }
            major if WITHOUT_EFFECT.contains(&major) => {}
            _ => notes.add(Note::Statement(first.chars().take(24).collect()), statement.line),
        }
        Ok(())
    }

    fn units(&mut self, statement: &Statement) -> Result<(), Problem> {
        let words = [("MM", 1e-3), ("CM", 1e-2), ("INCHES", 25.4e-3), ("INCH", 25.4e-3), ("FEET", 0.3048)];
        let unit = words.iter().find(|(word, _)| statement.has(word));
        let Some((_, unit)) = unit else {
            return Err(statement.fault("the unit is not known", "`UNITS/MM` or `UNITS/INCHES`"));
        };
        self.unit = Some(*unit);
        Ok(())
    }

    fn feed(&self, statement: &Statement) -> Result<Feed, Problem> {
        let unit = self.unit.unwrap_or(1e-3);
        let (mut value, mut per) = (None, Feed::PerSecond(unit / 60.0));
        for part in &statement.parts {
            match part.word.as_str() {
                "" => value = value.or(Some(part.number)),
                "PERMIN" | "IPM" | "MMPM" | "UPM" => {
                    let unit = match part.word.as_str() {
                        "IPM" => 25.4e-3,
                        "MMPM" => 1e-3,
                        _ => unit,
                    };
                    per = Feed::PerSecond(unit / 60.0);
                }
                "PERREV" | "IPR" | "MMPR" | "UPR" => {
                    per = Feed::PerTurn(match part.word.as_str() {
                        "IPR" => 25.4e-3,
                        "MMPR" => 1e-3,
                        _ => unit,
                    });
                }
                other => {
                    return Err(part.fault(format!("`{other}` is no unit of a feed here"), "e.g. `FEDRAT/250,MMPM`"));
                }
            }
        }
        match value {
            Some(value) if value > 0.0 => Ok(match per {
                Feed::PerSecond(unit) => Feed::PerSecond(unit * value),
                Feed::PerTurn(unit) => Feed::PerTurn(unit * value),
            }),
            _ => Err(statement.fault("the feed is missing or not above zero", "e.g. `FEDRAT/250,MMPM`")),
        }
    }

    fn spindle(&mut self, statement: &Statement) -> Result<(), Problem> {
        let mut skips = false;
        for part in &statement.parts {
            match part.word.as_str() {
                // The number behind is that of the word.
                _ if core::mem::take(&mut skips) => {}
                "" if part.number >= 0.0 => {
                    self.speed = part.number * core::f64::consts::TAU / 60.0;
                    self.spindle = self.speed;
                }
                "RANGE" | "MAXRPM" => skips = true,
                "OFF" | "ORIENT" | "LOCK" => self.spindle = 0.0,
                "RPM" => {}
                "ON" | "CLW" => self.spindle = self.speed,
                "CCLW" => self.spindle = -self.speed,
                _ => {
                    let help = "e.g. `SPINDL/8000,RPM,CLW` or `SPINDL/OFF`";
                    return Err(part.fault("this is no speed of a spindle here", help));
                }
            }
        }
        Ok(())
    }

    fn circle(&self, statement: &Statement) -> Result<Circle, Problem> {
        let mut numbers: Vec<f64> = Vec::new();
        let mut named = false;
        for part in &statement.parts {
            match part.word.as_str() {
                "" if named => named = false,
                "" => numbers.push(part.number),
                "CENTER" | "AXIS" | "RADIUS" => {}
                "ANGLE" | "TIMES" => named = true,
                other => return Err(part.fault(format!("`{other}` is not known here"), CIRCLE)),
            }
        }
        let [x, y, z, i, j, k, radius, rest @ ..] = &numbers[..] else {
            return Err(statement.fault("the circle has fewer than seven numbers", CIRCLE));
        };
        let Some(axis) = Unit::try_new(Vector3::new(*i, *j, *k), 1e-6) else {
            return Err(statement.fault("the axis of the circle has no direction", CIRCLE));
        };
        let unit = self.unit.unwrap_or(1e-3);
        let is_arc = statement.major == "MOVARC";
        let angle = statement.behind("ANGLE").or(rest.first().copied().filter(|_| is_arc));
        Ok(Circle {
            center: Vector3::new(*x, *y, *z) * unit,
            axis,
            radius: radius * unit,
            angle: angle.map(|angle| angle.to_radians().abs()),
            may_be_points: !is_arc,
        })
    }

    fn go(&mut self, statement: &Statement, moves: &mut VecDeque<Move>, notes: &mut Notes) -> Result<(), Problem> {
        let numbers = statement.numbers()?;
        if !matches!(numbers.len(), 3 | 6) {
            let message = format!("{} has {} numbers", statement.major, numbers.len());
            return Err(statement.fault(message, "three of the point, and where the tool tilts three of its axis"));
        }
        if self.unit.is_none() {
            notes.add(Note::Unit, statement.line);
            self.unit = Some(1e-3);
        }
        let mut to = Vector3::from_column_slice(&numbers[..3]) * self.unit.unwrap_or(1e-3);
        if statement.major == "GODLTA" {
            let Some(from) = self.at else {
                return Err(statement.fault("GODLTA counts from a point that is not known", "begin with FROM or GOTO"));
            };
            to += from;
        }
        let axis = if numbers.len() == 6 { axis(statement, &numbers[3..])? } else { self.axis };
        let is_from = statement.major == "FROM";
        let pace = match self.feed {
            _ if core::mem::take(&mut self.is_rapid) || is_from => Pace::Rapid,
            Some(Feed::PerSecond(speed)) => Pace::Speed(speed, 0.0),
            Some(Feed::PerTurn(length)) => Pace::Speed(length * self.spindle.abs() / core::f64::consts::TAU, 0.0),
            None if self.at.is_none() => Pace::Rapid,
            None => return Err(statement.fault("the move has no feed", "give FEDRAT or RAPID before")),
        };
        if pace == Pace::Speed(0.0, 0.0) {
            return Err(statement.fault("the feed is per revolution, and the spindle stands", "give SPINDL before"));
        }
        self.release(Some(to), moves, notes)?;
        match self.circle {
            Some(circle) if self.at.is_some() && !is_from => {
                let held = Held { statement: statement.clone(), circle, to, axis, pace };
                self.circle = None;
                if circle.may_be_points {
                    self.held = Some(held);
                    return Ok(());
                }
                self.arc(&held, moves, notes)
            }
            _ => self.push(statement, (to, axis), pace, None, moves),
        }
    }

    /// Moves along the circle that waits; `next` is the point that follows.
    fn release(
        &mut self,
        next: Option<Vector3<f64>>,
        moves: &mut VecDeque<Move>,
        notes: &mut Notes,
    ) -> Result<(), Problem> {
        let Some(held) = self.held.take() else { return Ok(()) };
        if next.is_some_and(|next| held.circle.has(&next)) {
            return self.push(&held.statement, (held.to, held.axis), held.pace, None, moves);
        }
        self.arc(&held, moves, notes)
    }

    fn arc(&mut self, held: &Held, moves: &mut VecDeque<Move>, notes: &mut Notes) -> Result<(), Problem> {
        let Held { statement, circle, to, axis, pace } = held;
        let from = self.at.unwrap_or(*to);
        let place = (*to, *axis);
        if !(circle.has(&from) && circle.has(to)) {
            (self.at, self.axis) = (Some(*to), *axis);
            return Err(statement.fault("the tool does not move on the circle before", CIRCLE));
        }
        let turns = circle.angle.map_or(0.0, |angle| (angle / core::f64::consts::TAU - 1e-3).max(0.0).floor());
        let given = Given { from, to: *to, axis: circle.axis.into_inner(), turns: turns.min(1e4) as u32 };
        let fits = |arc: &Arc| circle.angle.is_none_or(|angle| (arc.sweep() - angle).abs() < SAME_ANGLE);
        let arc = Arc::about(&given, circle.center).map_err(|why| statement.fault(why, CIRCLE))?;
        let other = Arc::reversed(&given, circle.center).map_err(|why| statement.fault(why, CIRCLE))?;
        let Some(arc) = [arc, other].into_iter().find(fits) else {
            (self.at, self.axis) = (Some(*to), *axis);
            return Err(statement.fault("the end of the arc does not fit the angle before it", CIRCLE));
        };
        if circle.may_be_points && arc.sweep() > core::f64::consts::PI * 1.001 {
            notes.add(Note::LongArc, statement.line);
        }
        self.push(statement, place, *pace, Some(arc), moves)
    }

    fn push(
        &mut self,
        statement: &Statement,
        (to, axis): (Vector3<f64>, Unit<Vector3<f64>>),
        pace: Pace,
        arc: Option<Arc>,
        moves: &mut VecDeque<Move>,
    ) -> Result<(), Problem> {
        let common = Common { line: statement.line, pace, spindle: self.spindle, tool: self.tool };
        let shape = arc.map_or(Shape::Line(self.at.unwrap_or(to), to), Shape::Arc);
        let is_first = self.at.is_none();
        let turn = Turn::Axis(if is_first { axis } else { self.axis }, axis);
        (self.at, self.axis) = (Some(to), axis);
        split(moves, common, &shape, &turn, is_first, self.options.arc_tolerance).map_err(|parts| {
            let message = format!("the arc takes {parts:.0} chords");
            statement.fault(message, "allow for a larger `--arc-tolerance`")
        })
    }
}

const CIRCLE: &str = "`CIRCLE/x,y,z,i,j,k,radius` or `MOVARC/x,y,z,i,j,k,radius,ANGLE,degrees`, then `GOTO/x,y,z` with the \
     end; the arc turns about i, j, k by the right-hand rule";

impl Circle {
    /// Whether a point is on it, or beside it along its axis.
    fn has(&self, point: &Vector3<f64>) -> bool {
        let out = point - self.center;
        let off = (out - self.axis.into_inner() * self.axis.dot(&out)).norm() - self.radius;
        off.abs() <= ON_CIRCLE.max(ON_CIRCLE_SHARE * self.radius.abs())
    }
}

fn axis(statement: &Statement, numbers: &[f64]) -> Result<Unit<Vector3<f64>>, Problem> {
    let axis = match numbers {
        [i, j, k, ..] => Unit::try_new(Vector3::new(*i, *j, *k), 1e-6),
        _ => None,
    };
    axis.ok_or_else(|| statement.fault("the tool's axis has no direction", "three numbers, e.g. `0,0,1`"))
}
