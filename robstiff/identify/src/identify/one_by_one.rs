//! Outlying readings that hide each other.
//!
//! Each of several makes the others look less outlying. So the one that stands out most is taken
//! away time and again, and all are outlying up to the last that was significant, whatever those
//! before it seemed (Rosner, Technometrics 25, 1983, 165-172). What stands out, and when that is
//! significant, is asked of each kind of reading in its own way.

use std::vec::Vec;

/// Those that are outlying, the one that stands out most first, with what is said of the last.
///
/// `take` takes away what stands out most of what is left: which one it is, and what there is to
/// say of it where it is significant. It is asked up to `most` times, and not again once it has
/// nothing more to take. `None` where none was significant.
pub fn up_to_the_last<S>(most: usize, mut take: impl FnMut() -> Option<(usize, Option<S>)>) -> Option<(Vec<usize>, S)> {
    let (mut taken, mut last) = (Vec::new(), None);
    while taken.len() < most
        && let Some((row, significant)) = take()
    {
        taken.push(row);
        if let Some(said) = significant {
            last = Some((taken.len(), said));
        }
    }
    let (count, said) = last?;
    taken.truncate(count);
    Some((taken, said))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(most: usize, significant: &[bool]) -> Option<(Vec<usize>, usize)> {
        let mut rows = significant.iter().copied().enumerate();
        up_to_the_last(most, || rows.next().map(|(row, is)| (row, is.then_some(10 * row))))
    }

    #[test]
    fn what_hides_behind_the_last_is_wild_too() {
        assert_eq!(found(5, &[false, false, true, false]), Some((std::vec![0, 1, 2], 20)));
        assert_eq!(found(2, &[true, false, true]), Some((std::vec![0], 0)));
        assert_eq!(found(2, &[false, false, true]), None);
        assert_eq!(found(5, &[]), None);
    }
}
