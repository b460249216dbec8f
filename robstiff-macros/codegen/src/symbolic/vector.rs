//! Vectors and symmetric matrices of symbols.

use std::ops::{Add, Index, Neg, Sub};

use crate::graph::{Graph, Sym};

/// The letters of the axes, for names.
pub(crate) const AXES: [char; 3] = ['x', 'y', 'z'];

/// A vector in space.
#[derive(Clone, Copy, Debug)]
pub struct Vec3<'g>(pub [Sym<'g>; 3]);

impl<'g> Vec3<'g> {
    /// The zero vector.
    pub fn zero(g: &'g Graph) -> Self {
        Self([g.number(0.0); 3])
    }

    /// The unit vector along `axis`, from 0.
    pub fn unit(g: &'g Graph, axis: usize) -> Self {
        Self(std::array::from_fn(|i| g.number(f64::from(u8::from(i == axis)))))
    }

    /// Times a factor.
    pub fn scaled(self, factor: Sym<'g>) -> Self {
        Self(self.0.map(|x| factor * x))
    }

    /// The scalar product.
    pub fn dot(self, other: Self) -> Sym<'g> {
        self[0] * other[0] + self[1] * other[1] + self[2] * other[2]
    }

    /// The vector product `self x other`.
    pub fn cross(self, other: Self) -> Self {
        Self([
            self[1] * other[2] - self[2] * other[1],
            self[2] * other[0] - self[0] * other[2],
            self[0] * other[1] - self[1] * other[0],
        ])
    }

    /// Whether every component is known to be 0.
    pub fn is_zero(self) -> bool {
        self.0.iter().all(|x| x.is_zero())
    }

    /// Turned about `axis` by the angle of the given sine and cosine.
    pub fn turned(self, axis: usize, (s, c): (Sym<'g>, Sym<'g>)) -> Self {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut out = self.0;
        out[i] = c * self[i] - s * self[j];
        out[j] = s * self[i] + c * self[j];
        Self(out)
    }

    /// Names the components `<name>x`, `<name>y`, `<name>z`.
    pub fn named(self, name: &str) -> Self {
        for (axis, x) in self.0.into_iter().enumerate() {
            x.named(format!("{name}{}", AXES[axis]));
        }
        self
    }
}

impl<'g> Index<usize> for Vec3<'g> {
    type Output = Sym<'g>;

    fn index(&self, axis: usize) -> &Sym<'g> {
        &self.0[axis]
    }
}

impl Add for Vec3<'_> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self([self[0] + other[0], self[1] + other[1], self[2] + other[2]])
    }
}

impl Sub for Vec3<'_> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self([self[0] - other[0], self[1] - other[1], self[2] - other[2]])
    }
}

impl Neg for Vec3<'_> {
    type Output = Self;

    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

/// A 3 x 3 matrix by rows.
pub(crate) type Matrix3<'g> = [[Sym<'g>; 3]; 3];

/// Upper triangle of a symmetric 3 x 3 matrix; `at(i, j)` is symmetric.
#[derive(Clone, Copy, Debug)]
pub struct Symmetric3<'g> {
    upper: [Sym<'g>; 6],
}

impl<'g> Symmetric3<'g> {
    const POSITION: [[usize; 3]; 3] = [[0, 1, 2], [1, 3, 4], [2, 4, 5]];

    /// The zero matrix.
    pub fn zero(g: &'g Graph) -> Self {
        Self { upper: [g.number(0.0); 6] }
    }

    /// A diagonal matrix.
    pub fn diagonal(g: &'g Graph, entries: [Sym<'g>; 3]) -> Self {
        let mut out = Self::zero(g);
        for (i, entry) in entries.into_iter().enumerate() {
            out.set(i, i, entry);
        }
        out
    }

    /// Each entry from its row and column, `row <= column`.
    pub fn from_fn(mut entry: impl FnMut(usize, usize) -> Sym<'g>) -> Self {
        Self { upper: [entry(0, 0), entry(0, 1), entry(0, 2), entry(1, 1), entry(1, 2), entry(2, 2)] }
    }

    /// The entry in row `i` and column `j`, either way round.
    pub fn at(&self, i: usize, j: usize) -> Sym<'g> {
        self.upper[Self::POSITION[i][j]]
    }

    /// Sets the entry in row `i` and column `j`, and its mirror image.
    pub fn set(&mut self, i: usize, j: usize, value: Sym<'g>) {
        self.upper[Self::POSITION[i][j]] = value;
    }

    /// Whether every entry is known to be 0.
    pub fn is_zero(&self) -> bool {
        self.upper.iter().all(|x| x.is_zero())
    }
}

impl Add for Symmetric3<'_> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::from_fn(|i, j| self.at(i, j) + other.at(i, j))
    }
}
