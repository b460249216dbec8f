//! What G codes mean, and what stays until another code of its group.

use super::fault::Fault;
use super::lex::Word;

/// How blocks move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// G80, or no code so far.
    None,
    /// G0.
    Rapid,
    /// G1.
    Feed,
    /// G2, G3.
    Arc {
        /// Whether it is G2.
        clockwise: bool,
    },
    /// G73, G81 and the like, by their number.
    Cycle(u32),
}

/// What F says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FeedMode {
    /// G94.
    PerMinute,
    /// G93.
    Inverse,
    /// G95.
    PerRevolution,
}

/// What a block does beside moving, and in place of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Once {
    /// G4: its words are a time.
    Dwell,
    /// G28, G30, by their number in tenths: to a place of the machine.
    Home(u32),
    /// G53: its words count from the machine's zero.
    Machine,
    /// G5, G5.1 without axes: how smooth corners are.
    Smoothing,
}

/// How the tool's axis is programmed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tcp {
    /// The machine is sent to places.
    Off,
    /// By G43.4: rotary words turn the tool about its tip. G49 ends it.
    ByLength,
    /// By G43.5: I J K are the tool's axis. G49 ends it.
    Vector,
    /// By M128 or M428: as by G43.4, and M129 or M429 end it.
    ByFunction,
}

/// What stays.
#[derive(Clone, Debug)]
pub struct Modal {
    /// How blocks move.
    pub motion: Motion,
    /// The axis across the plane of arcs, 0 to 2: G19, G18, G17.
    pub across: usize,
    /// G91.
    pub incremental: bool,
    /// G90.1.
    pub absolute_centers: bool,
    /// What F says.
    pub feed_mode: FeedMode,
    /// G20, G21: the unit of lengths (m), once it is named.
    pub unit: Option<f64>,
    /// G53 to G59.3, by the index in `OFFSETS`.
    pub offset: usize,
    /// G99: drills go back to R only.
    pub to_r: bool,
    /// How the tool's axis is programmed.
    pub tcp: Tcp,
}

impl Default for Modal {
    fn default() -> Self {
        Self {
            motion: Motion::None,
            across: 2,
            incremental: false,
            absolute_centers: false,
            feed_mode: FeedMode::PerMinute,
            unit: None,
            offset: 1,
            to_r: false,
            tcp: Tcp::Off,
        }
    }
}

/// Codes that a reader knows and does not follow, in tenths, and what they are.
const NOT_FOLLOWED: [(u32, &str); 24] = [
    (52, "splines"),
    (53, "splines"),
    (70, "diameters of a lathe"),
    (100, "setting of data"),
    (160, "polar coordinates"),
    (330, "threading"),
    (382, "probing"),
    (383, "probing"),
    (384, "probing"),
    (385, "probing"),
    (410, "cutter compensation"),
    (411, "cutter compensation"),
    (420, "cutter compensation"),
    (421, "cutter compensation"),
    (510, "scaling"),
    (511, "mirroring"),
    (520, "a shift of the offsets"),
    (541, "a table of further offsets"),
    (680, "a turn of the coordinates"),
    (682, "a tilted plane"),
    (740, "tapping"),
    (840, "tapping"),
    (920, "a shift of the coordinates"),
    (960, "a constant cutting speed"),
];

/// Codes of no group here that change nothing, in tenths: an exact stop (G9), and what ends those
/// that are not followed (G15, G50, G50.1, G67, G69, G69.3).
const WITHOUT_EFFECT: [u32; 7] = [90, 150, 500, 501, 670, 690, 693];

fn name(word: &Word) -> String {
    format!("G{}", word.value)
}

impl Modal {
    /// Takes a G word. `groups` are those that the block has named so far.
    ///
    /// # Errors
    /// A code that is not known or not followed; two of a group.
    pub fn take(&mut self, word: &Word, groups: &mut u32) -> Result<Option<Once>, Fault> {
        let Some(tenths) = word.tenths() else {
            return Err(word.fault(format!("{} is not known", name(word)), UNKNOWN));
        };
        let group = match tenths {
            40 | 50 | 51 | 280 | 300 | 530 => 0,
            0 | 10 | 20 | 30 | 730 | 810 | 820 | 830 | 850 | 860 | 890 => 1,
            // It stands beside G0 in the first block of many programs.
            800 => 9,
            170 | 180 | 190 => 2,
            900 | 910 => 3,
            901 | 911 => 4,
            930 | 940 | 950 => 5,
            200 | 210 => 6,
            400 => 7,
            430 | 431 | 432 | 434 | 435 | 440 | 490 => 8,
            980 | 990 => 10,
            540 | 550 | 560 | 570 | 580 | 590 | 591 | 592 | 593 => 12,
            610 | 611 | 640 => 13,
            970 => 14,
            other => match NOT_FOLLOWED.iter().find(|(code, _)| *code == other) {
                Some((code, what)) => return Err(not_followed(word, *code, what)),
                None if WITHOUT_EFFECT.contains(&other) => return Ok(None),
                None => return Err(word.fault(format!("{} is not known", name(word)), UNKNOWN)),
            },
        };
        let bit = 1 << group;
        if *groups & bit != 0 {
            let message = format!("{} does not go with a code before it in the block", name(word));
            return Err(word.fault(message, "codes of one group exclude each other; keep one of them"));
        }
        *groups |= bit;
        Ok(self.set(tenths))
    }

    fn set(&mut self, tenths: u32) -> Option<Once> {
        match tenths {
            40 => return Some(Once::Dwell),
            50 | 51 => return Some(Once::Smoothing),
            280 | 300 => return Some(Once::Home(tenths)),
            530 => return Some(Once::Machine),
            0 => self.motion = Motion::Rapid,
            10 => self.motion = Motion::Feed,
            20 | 30 => self.motion = Motion::Arc { clockwise: tenths == 20 },
            800 if matches!(self.motion, Motion::Cycle(_)) => self.motion = Motion::None,
            730 | 810..=890 => self.motion = Motion::Cycle(tenths / 10),
            170 | 180 | 190 => self.across = 2 - (tenths as usize - 170) / 10,
            900 | 910 => self.incremental = tenths == 910,
            901 | 911 => self.absolute_centers = tenths == 901,
            930 => self.feed_mode = FeedMode::Inverse,
            940 => self.feed_mode = FeedMode::PerMinute,
            950 => self.feed_mode = FeedMode::PerRevolution,
            200 => self.unit = Some(25.4e-3),
            210 => self.unit = Some(1e-3),
            434 => self.tcp = Tcp::ByLength,
            435 => self.tcp = Tcp::Vector,
            490 if matches!(self.tcp, Tcp::ByLength | Tcp::Vector) => self.tcp = Tcp::Off,
            980 | 990 => self.to_r = tenths == 990,
            540..=590 => self.offset = (tenths as usize - 530) / 10,
            591..=593 => self.offset = tenths as usize - 584,
            _ => {}
        }
        None
    }
}

const UNKNOWN: &str = "known are G0 to G4, G17 to G21, G28, G30, G40, G43, G43.4, G43.5, G49, G53 to G59.3, G61, G64, G73, \
     G80 to G83, G85, G86, G89, G90 to G95, G97 to G99";

fn not_followed(word: &Word, code: u32, what: &str) -> Fault {
    let help = match code {
        410..=421 => "have the CAM system write the path of the tool's centre, with G40",
        520 | 541 | 920 => "use G54 to G59, whose zeros options give",
        840 | 740 => "take the tapping out of the program",
        _ => "have the CAM system write plain moves",
    };
    word.fault(format!("{} is not followed: {what}", name(word)), help)
}
