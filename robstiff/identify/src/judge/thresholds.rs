//! Every number that decides what is said. None was fitted to simulated campaigns; how often what is
//! said is right is a figure that is measured and reported.

/// A class that is less likely is not named: one in twenty is the usual level of a first finding.
pub const PROBABLE: f64 = 0.95;

/// The probability must hold whatever effects are likely to be: for priors this much narrower and
/// wider.
pub const SIZES: [f64; 2] = [1.0 / 3.0, 3.0];

/// A class must be back in this part of the folds (Meinshausen and Buehlmann, J. R. Statist. Soc. B
/// 72, 2010, take 0.6 to 0.9).
pub const RECURS: f64 = 0.8;

/// The whole search must predict unseen poses better than the description's own numbers alone, by this part. A fault of
/// the rig may do so little by itself, and much with another: what is asked is whether all together predict.
pub const FALLS: f64 = 0.01;

/// Of absolute positions an arm deviates in many small ways, of which most may replace each other.
/// With the best of all others in its place unseen poses must be predicted worse by this part, and by
/// this many standard errors of the difference between poses: one in a hundred and fifty by chance,
/// one-sided.
pub const LOSS: f64 = 0.03;
/// See [`LOSS`].
pub const WORSE: f64 = 2.5;

/// An effect without which the error grows by less than this part of the noise does not matter.
pub const MATTERS: f64 = 0.1;

/// A number within so many standard deviations of zero is not distinct from it: the 95 % interval.
pub const DISTINCT: f64 = 1.96;

/// Of absolute positions every number of the table is off a little, and any of them can take most of what
/// another says. One stands out if it is so many standard deviations from zero, and moves the readings by
/// more than the noise.
pub const STANDS_OUT: f64 = 5.0;

/// A discrepancy is left where one of this size or a larger one is likelier than none or a smaller one:
/// it doubles the error at a load of usual size.
pub const DISCREPANCY: f64 = 0.3;

/// Where a discrepancy is left, effects are named only if together they account for this part of what
/// is beyond the noise: what takes less may stand in for what is not in the catalogue.
pub const ACCOUNTS: f64 = 0.8;

/// More names at once are never the whole truth.
pub const MOST_NAMES: usize = 3;

/// Fewer poses tell nothing apart.
pub const FEWEST_POSES: usize = 8;

/// A model that leaves more than the known noise by this factor does not account for the readings.
pub const ABOVE_NOISE: f64 = 1.25;

/// Where the error of all rows is above the noise of most by more than this factor, some rows are far off. Student's
/// distribution with three degrees of freedom, which has heavier tails than readings have, comes to 1.7.
pub const FAR_OFF: f64 = 3.0;

/// An effect that is less likely than this is not even suspected: odds of nineteen to one against it.
pub const SUSPECTED: f64 = 0.05;

/// Folds in which the search is repeated: four fifths of the poses are left to search on, and an effect
/// may be missing in one fold ([`RECURS`]).
pub const FOLDS: usize = 5;

/// More outlying rows than this part of all are not single mistakes: something is missing that a few rows show.
pub const MOST_OUTLYING: f64 = 0.05;

/// Outlying rows are reported if they are this part of all rows or more: fewer are the tail of the others.
pub const OUTLYING_ROWS: f64 = 0.002;
