//! What a node of the expression graph computes.

/// Index of a node in its graph.
pub type Id = usize;

/// What a node computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Op {
    /// A number, by its bits.
    Number(u64),
    /// A number of the description that has a name.
    NamedNumber(usize),
    /// Joint coordinate, from 0 (rad or m).
    Coordinate(usize),
    /// Component of the wrench at the TCP, from 0 (N, then Nm).
    Wrench(usize),
    /// A joint's play operator before the load, both from 0 (Nm).
    Play(usize, usize),
    /// Sine of an angle.
    Sin(usize),
    /// Cosine of an angle.
    Cos(usize),
    /// Sum.
    Add(Id, Id),
    /// Difference.
    Sub(Id, Id),
    /// Product.
    Mul(Id, Id),
    /// Negative.
    Neg(Id),
    /// Square root.
    Sqrt(Id),
    /// Reciprocal.
    Recip(Id),
    /// The larger of two.
    Max(Id, Id),
    /// The smaller of two.
    Min(Id, Id),
    /// Four numbers side by side, see [`Column`](crate::symbolic::column::Column).
    Column([Id; 4]),
    /// A column times a number.
    Scaled(Id, Id),
    /// The sum of a column and of another times a number.
    PlusScaled(Id, Id, Id),
    /// The product of two columns, entry by entry.
    Product(Id, Id),
    /// The sum of a column and of the product of two others.
    PlusProduct(Id, Id, Id),
    /// A column with its entries in the order [`CYCLED`].
    Cycled(Id),
    /// A column with 0 for its last entry.
    Direction(Id),
    /// An entry of a column, from 0.
    Entry(Id, usize),
}

/// Which entries a column has once it is cycled: y, z, x, and the last as it was.
pub const CYCLED: [usize; 4] = [1, 2, 0, 3];

impl Op {
    /// The nodes that this one is computed from.
    pub fn operands(self) -> impl Iterator<Item = Id> {
        let (mut operands, mut count) = ([None; 4], 0);
        self.map_operands(|id| {
            operands[count] = Some(id);
            count += 1;
            id
        });
        operands.into_iter().flatten()
    }

    /// The same on other nodes.
    pub fn map_operands(self, mut of: impl FnMut(Id) -> Id) -> Self {
        match self {
            Self::Add(a, b) => Self::Add(of(a), of(b)),
            Self::Sub(a, b) => Self::Sub(of(a), of(b)),
            Self::Mul(a, b) => Self::Mul(of(a), of(b)),
            Self::Max(a, b) => Self::Max(of(a), of(b)),
            Self::Min(a, b) => Self::Min(of(a), of(b)),
            Self::Scaled(a, b) => Self::Scaled(of(a), of(b)),
            Self::Product(a, b) => Self::Product(of(a), of(b)),
            Self::Neg(a) => Self::Neg(of(a)),
            Self::Sqrt(a) => Self::Sqrt(of(a)),
            Self::Recip(a) => Self::Recip(of(a)),
            Self::Cycled(a) => Self::Cycled(of(a)),
            Self::Direction(a) => Self::Direction(of(a)),
            Self::Entry(a, entry) => Self::Entry(of(a), entry),
            Self::PlusScaled(a, b, c) => Self::PlusScaled(of(a), of(b), of(c)),
            Self::PlusProduct(a, b, c) => Self::PlusProduct(of(a), of(b), of(c)),
            Self::Column(entries) => Self::Column(entries.map(of)),
            Self::Number(_)
            | Self::NamedNumber(_)
            | Self::Coordinate(_)
            | Self::Wrench(_)
            | Self::Play(..)
            | Self::Sin(_)
            | Self::Cos(_) => self,
        }
    }

    /// Cycles until the result is known once the operands are, much the same on
    /// all current machines; a product, fused or not, a sum or a comparison, a root.
    pub fn latency(self) -> usize {
        match self {
            Self::Mul(..) | Self::Scaled(..) | Self::PlusScaled(..) | Self::Product(..) | Self::PlusProduct(..) => 4,
            Self::Add(..) | Self::Sub(..) | Self::Max(..) | Self::Min(..) | Self::Cycled(_) => 3,
            Self::Sqrt(_) | Self::Recip(_) => 13,
            _ => 0,
        }
    }

    /// Whether it is four numbers side by side.
    pub fn is_column(self) -> bool {
        use Op::{Column, Cycled, Direction, PlusProduct, PlusScaled, Product, Scaled};
        matches!(
            self,
            Column(_) | Scaled(..) | PlusScaled(..) | Product(..) | PlusProduct(..) | Cycled(_) | Direction(_)
        )
    }
}
