//! Kinds of quantities.

/// What kind of quantity is expected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// A plain number.
    Number,
    /// A length (m).
    Length,
    /// An angle (rad).
    Angle,
    /// The compliance of something that turns (rad/Nm); a stiffness is taken
    /// as its inverse.
    Compliance,
    /// The compliance of something that slides (m/N); a stiffness is taken as
    /// its inverse.
    LinearCompliance,
    /// A mass (kg).
    Mass,
    /// A force (N).
    Force,
    /// A torque (Nm).
    Torque,
    /// A time (s).
    Time,
    /// A speed (m/s).
    Speed,
    /// A rotational speed (rad/s).
    RotationalSpeed,
    /// A frequency (Hz).
    Frequency,
    /// The velocity of something by a force on it that swings ((m/s)/N).
    Mobility,
    /// The acceleration of something by a force on it that swings ((m/s^2)/N).
    Accelerance,
    /// The feed of a mill per tooth (m).
    FeedPerTooth,
    /// A force per area, such as a cutting coefficient (Pa).
    Pressure,
    /// A force per length, such as an edge coefficient (N/m).
    LineForce,
    /// A temperature of which only differences count: `C` and `K` are the same.
    Temperature,
}

impl Dimension {
    /// The SI unit, as descriptions spell it; empty for a number.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Number => "",
            Self::Length => "m",
            Self::Angle => "rad",
            Self::Compliance => "rad/Nm",
            Self::LinearCompliance => "m/N",
            Self::Mass => "kg",
            Self::Force => "N",
            Self::Torque => "Nm",
            Self::Time => "s",
            Self::Speed => "m/s",
            Self::RotationalSpeed => "rad/s",
            Self::Frequency => "Hz",
            Self::Mobility => "m/s/N",
            Self::Accelerance => "m/s2/N",
            Self::FeedPerTooth => "m/tooth",
            Self::Pressure => "Pa",
            Self::LineForce => "N/m",
            Self::Temperature => "K",
        }
    }
}
