//! The axes that three columns of a file are along.

use std::format;
use std::string::String;
use std::vec::Vec;

use crate::words::and;

/// For each axis, which component of the file is along it, and its sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes([(usize, f64); 3]);

impl Axes {
    /// Every one but that in which each component is along its own axis.
    pub fn others() -> impl Iterator<Item = Self> {
        const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 0, 2], [0, 2, 1], [2, 1, 0], [1, 2, 0], [2, 0, 1]];
        let signs = |of: usize| [0, 1, 2].map(|axis| if of >> axis & 1 == 0 { 1.0 } else { -1.0 });
        let all = ORDERS
            .into_iter()
            .flat_map(move |order| (0..8).map(move |of| Self([0, 1, 2].map(|axis| (order[axis], signs(of)[axis])))));
        all.skip(1)
    }

    /// Whether right-handed axes stay so.
    fn is_right_handed(&self) -> bool {
        let [x, y, z] = self.0;
        let is_even = (x.0 + 1) % 3 == y.0;
        (x.1 * y.1 * z.1 > 0.0) == is_even
    }

    pub fn apply(&self, vector: &mut [f64]) {
        let read = [vector[0], vector[1], vector[2]];
        vector.iter_mut().zip(self.0).for_each(|(component, (of, sign))| *component = sign * read[of]);
    }

    /// The same of a moment or a rotation, which counts the other way in a mirror.
    pub fn apply_to_turn(&self, vector: &mut [f64]) {
        self.apply(vector);
        if !self.is_right_handed() {
            vector.iter_mut().for_each(|component| *component = -*component);
        }
    }

    /// What stands in the columns of a vector.
    pub fn words(&self, column: fn(usize) -> String) -> String {
        let moved: Vec<usize> = (0..3).filter(|&axis| self.0[axis].0 != axis).collect();
        let reversed: Vec<usize> = (0..3).filter(|&axis| self.0[axis].1 < 0.0).collect();
        match (&moved[..], &reversed[..]) {
            ([], reversed) => {
                let columns: Vec<String> = reversed.iter().map(|&axis| column(axis)).collect();
                format!("{} with the other sign", and(&columns))
            }
            (&[one, other], []) => format!("{} and {} exchanged", column(one), column(other)),
            _ => {
                let stands = |place: usize| {
                    let in_it = |&axis: &usize| self.0[axis].0 == place;
                    let axis = (0..3).find(in_it).unwrap_or(place);
                    format!("{}{}", if self.0[axis].1 < 0.0 { "-" } else { "" }, column(axis))
                };
                format!("{} where {} should be", and(&[0, 1, 2].map(stands)), and(&[0, 1, 2].map(column)))
            }
        }
    }
}
