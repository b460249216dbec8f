//! Positions in another unit than their header says: no arm has its tool in places that are as
//! far apart.

use std::format;
use std::string::String;

use robstiff_robots::Description;

use crate::campaign::Positions;
use crate::identify::misread::{apart, from_middle};
use crate::identify::scale::HEADER;
use crate::observe::position::Position;

/// Pairs of units of length that are taken for each other, and how many of the one the other is.
/// Those that are nearer to each other are not asked about: with angles in radians taken for
/// degrees, too, the description has places as much closer together, by up to 57 times.
const PAIRS: [(f64, &str, &str); 3] = [(1e3, "mm", "m"), (1e6, "um", "m"), (100.0, "cm", "m")];

/// A unit makes all lengths larger alike, so that they are off by just its factor: of a single
/// column in another unit, or of angles that are not what they should be, few come as near.
const WITHIN: f64 = 1.15;

/// Places closer than this to each other (m), the root mean square from their middle, tell what an
/// arm yields by rather than how large it is.
const CLOSE: f64 = 0.01;

/// Why nothing can be made of positions that are as many times as far apart as the description
/// puts them as one unit of length is of another, and what would be right.
pub fn other_unit(robot: &Description, data: &Positions) -> Option<String> {
    let described = from_middle(Position::new(robot, data).points(robot).into_iter());
    let read = apart(data);
    if described < CLOSE {
        return None;
    }
    let off = read / described;
    let is_near = |(factor, ..): &&(f64, &str, &str)| {
        let rest = off.max(off.recip()) / factor;
        (WITHIN.recip()..WITHIN).contains(&rest)
    };
    let &(factor, fine, coarse) = PAIRS.iter().find(is_near)?;
    let (was, taken, which) = if off > 1.0 { (fine, coarse, "far apart") } else { (coarse, fine, "close together") };
    Some(format!(
        "the positions are about {factor:.0} times as {which} as the description puts them: positions in {was} taken for \
         {taken} look like that; {HEADER} `px [mm]` does"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::Data;
    use crate::campaign::made_positions::Plan;
    use crate::identify::{Error, identify};
    use robstiff_robots::samples::five_axis;

    /// What is told of positions in another unit, as many times what they were.
    fn told(times: f64) -> Option<String> {
        let campaign = Plan::new(five_axis(), 1).run();
        let Data::Position(mut data) = campaign.data else { unreachable!("positions") };
        data.rows.iter_mut().for_each(|row| row.position = row.position.map(|length| times * length));
        other_unit(&campaign.robot, &data)
    }

    #[test]
    fn positions_in_another_unit_are_told_as_such() {
        let right = "; the header of the table has to say what unit its numbers are in, as `px [mm]` does";
        let far = |times: &str, units: &str| {
            format!(
                "the positions are about {times} as the description puts them: positions in {units} look like that{right}"
            )
        };
        assert_eq!(told(1e3), Some(far("1000 times as far apart", "mm taken for m")));
        assert_eq!(told(1e-3), Some(far("1000 times as close together", "m taken for mm")));
        for arm in [0.5, 1.0, 2.0, 5.0, 57.3] {
            assert_eq!(told(arm), None);
        }
    }

    /// Positions without a payload are refused for it, too.
    #[test]
    fn identification_refuses_positions_in_another_unit() {
        for payloads in [std::vec![0.0], std::vec![0.0, 100.0]] {
            let mut campaign = Plan { payloads, ..Plan::new(five_axis(), 1) }.run();
            let Data::Position(data) = &mut campaign.data else { unreachable!("positions") };
            data.rows.iter_mut().for_each(|row| row.position = row.position.map(|length| 1e3 * length));
            let refused = identify(&campaign);
            assert!(matches!(&refused, Err(Error::OtherUnit(why)) if why.contains("mm taken for m")), "{refused:?}");
        }
    }
}
