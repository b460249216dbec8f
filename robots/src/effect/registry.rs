//! From the list of effects to the type that holds one.

use core::ops::Deref;

/// The most numbers an effect has.
pub const MOST_PARAMETERS: usize = 6;

/// The numbers of an effect, in the order of its parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Numbers {
    values: [f64; MOST_PARAMETERS],
    count: usize,
}

impl Numbers {
    pub(super) fn of(numbers: &[f64]) -> Self {
        let mut values = [0.0; MOST_PARAMETERS];
        values[..numbers.len()].copy_from_slice(numbers);
        Self { values, count: numbers.len() }
    }
}

impl Deref for Numbers {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.values[..self.count]
    }
}

impl IntoIterator for Numbers {
    type Item = f64;
    type IntoIter = core::iter::Take<core::array::IntoIter<f64, MOST_PARAMETERS>>;

    fn into_iter(self) -> Self::IntoIter {
        self.values.into_iter().take(self.count)
    }
}

/// The parameters as an array.
pub(super) fn exactly<S: Copy, const P: usize>(parameters: &[S]) -> [S; P] {
    parameters.try_into().expect("an effect's parameters, all of them")
}

/// The name, if there is one.
pub(super) const fn first(names: &[&'static str]) -> Option<&'static str> {
    match names {
        [] => None,
        [name, ..] => Some(name),
    }
}

/// `file::Kind, Place(field: type), parameters..;` for every effect: the enum
/// with a variant each, and what hands a question on to the effect's file.
macro_rules! registry {
    ($($file:ident :: $kind:ident, $place:ident ( $($field:ident: $type:ty)? ), $($parameter:ident),+;)+) => {
        /// An effect, with its place and its numbers in SI units.
        ///
        /// Each variant is described in the module of its name. Joints and
        /// links are counted from 1, as in the descriptions. The *joint frame*
        /// of joint `i` is frame `i - 1` under the standard convention and
        /// frame `i` under the modified one: the frame on whose z axis it
        /// acts. The *flange frame* is frame `n`, before the tool.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum Effect {
            $(
                #[doc = concat!("See [`", stringify!($file), "`].")]
                $kind {
                    $(
                        /// Where it sits.
                        $field: $type,
                    )?
                    $(
                        #[doc = concat!("The parameter `", stringify!($parameter), "`.")]
                        $parameter: f64,
                    )+
                },
            )+
        }

        $(const _: () = assert!(
            count!($($parameter)+) <= MOST_PARAMETERS,
            concat!(stringify!($file), " has more numbers than MOST_PARAMETERS"),
        );)+

        /// Every kind of effect, in the order of the registry.
        pub const CATALOGUE: &[&About] = &[$(&about!($file $kind $($parameter)+)),+];

        impl Effect {
            /// What is known of the kind.
            pub const fn about(&self) -> &'static About {
                match self {
                    $(Self::$kind { .. } => &about!($file $kind $($parameter)+),)+
                }
            }

            /// Where the effect sits.
            pub const fn place(&self) -> Place {
                match *self {
                    $(Self::$kind { $($field,)? .. } => Place::$place { $(0: $field)? },)+
                }
            }

            /// The numbers, in the order of the kind's parameters.
            pub fn numbers(&self) -> Numbers {
                match *self {
                    $(Self::$kind { $($parameter,)+ .. } => Numbers::of(&[$($parameter),+]),)+
                }
            }

            /// The effect of a kind at a place, with its numbers in order;
            /// nothing if there is no such kind, it does not sit at such a
            /// place or takes another count of numbers. Whether the numbers
            /// are physical is not asked.
            pub fn of_kind(kind: &str, place: Place, numbers: &[f64]) -> Option<Self> {
                match (kind, place, numbers) {
                    $(
                        (kind, Place::$place { $(0: $field)? }, &[$($parameter),+])
                            if kind == stringify!($file) =>
                        {
                            Some(Self::$kind { $($field,)? $($parameter),+ })
                        }
                    )+
                    _ => None,
                }
            }

            /// The variant's name, and that of its field for the place, as in
            /// Rust.
            pub const fn variant(&self) -> (&'static str, Option<&'static str>) {
                match self {
                    $(Self::$kind { .. } => {
                        (stringify!($kind), $crate::effect::registry::first(&[$(stringify!($field))?]))
                    })+
                }
            }

            /// The linear elements, each with the index of the parameter that
            /// is its compliance.
            pub fn springs(&self) -> impl Iterator<Item = (usize, Spring)> + use<> {
                let mut springs = [None; MOST_PARAMETERS];
                match self {
                    $(Self::$kind { .. } => {
                        let own: [_; count!($($parameter)+)] = $file::$kind::springs(self.place());
                        springs[..own.len()].copy_from_slice(&own);
                    })+
                }
                springs.into_iter().enumerate().filter_map(|(k, spring)| Some((k, spring?)))
            }

            /// By how much its joint turns more (rad) than by the joint's
            /// own compliance, if the effect has a part in the joint's law;
            /// `parameters` as numbers or symbols, in order.
            ///
            /// # Panics
            /// For another count of parameters.
            pub fn turn<S: Scalar>(&self, parameters: &[S], joint: &Joint<S>) -> Option<S> {
                match self {
                    $(Self::$kind { .. } => {
                        $file::$kind::turn::<S>(registry::exactly::<S, { count!($($parameter)+) }>(parameters), joint)
                    })+
                }
            }

            /// How many of its joint's play operators the effect uses.
            pub fn plays_in_use(&self) -> usize {
                match *self {
                    $(Self::$kind { $($parameter,)+ .. } => $file::$kind::plays_in_use([$($parameter),+]),)+
                }
            }

            /// The play operators (Nm) of its joint after a torque (Nm)
            /// that follows the state `before`.
            ///
            /// # Panics
            /// For another count of parameters.
            pub fn plays<S: Scalar>(&self, parameters: &[S], torque: S, before: [S; PLAYS]) -> [S; PLAYS] {
                match self {
                    $(Self::$kind { .. } => {
                        $file::$kind::plays::<S>(registry::exactly::<S, { count!($($parameter)+) }>(parameters), torque, before)
                    })+
                }
            }

            /// Corrects the [`row`](Self::row) of the DH table it sits at.
            pub fn correct(&self, row: &mut Row) {
                match *self {
                    $(Self::$kind { $($parameter,)+ .. } => {
                        $file::$kind::correct([$($parameter),+], self.place(), row);
                    })+
                }
            }

            /// By how much its joint stands aside (rad) of its coordinate,
            /// if it does: `harmonic` gives sine and cosine of a whole multiple
            /// of the coordinate.
            ///
            /// # Panics
            /// For another count of parameters.
            pub fn deviation<S: Scalar>(&self, parameters: &[S], harmonic: &dyn Fn(f64) -> (S, S)) -> Option<S> {
                match *self {
                    $(Self::$kind { $($parameter,)+ .. } => {
                        let symbols = registry::exactly::<S, { count!($($parameter)+) }>(parameters);
                        $file::$kind::deviation::<S>([$($parameter),+], symbols, harmonic)
                    })+
                }
            }

            /// The share of the arm's own weight that every joint yields to,
            /// unloaded, if the effect is of that sort.
            ///
            /// # Panics
            /// For another count of parameters.
            pub fn share_of_weight<S: Scalar>(&self, parameters: &[S]) -> Option<S> {
                match self {
                    $(Self::$kind { .. } => {
                        $file::$kind::share_of_weight::<S>(registry::exactly::<S, { count!($($parameter)+) }>(parameters))
                    })+
                }
            }

            /// The share of the arm's own weight that gears carry before the load,
            /// if the effect is of that sort.
            ///
            /// # Panics
            /// For another count of parameters.
            pub fn share_of_preload<S: Scalar>(&self, parameters: &[S]) -> Option<S> {
                match self {
                    $(Self::$kind { .. } => {
                        $file::$kind::share_of_preload::<S>(registry::exactly::<S, { count!($($parameter)+) }>(parameters))
                    })+
                }
            }

            /// Whether its law is linear in the torque and the play operators: a preload
            /// makes no difference to what it turns by.
            pub const fn is_linear(&self) -> bool {
                match self {
                    $(Self::$kind { .. } => <$file::$kind as Physics<{ count!($($parameter)+) }>>::LINEAR,)+
                }
            }

            fn noun_of_numbers(&self) -> &'static str {
                match *self {
                    $(Self::$kind { $($parameter,)+ .. } => $file::$kind::noun([$($parameter),+]),)+
                }
            }

            /// What it is, what causes it, and what one does about it.
            pub fn explanation(&self) -> &'static str {
                match *self {
                    $(Self::$kind { $($parameter,)+ .. } => $file::$kind::explanation([$($parameter),+]),)+
                }
            }

            /// What physics asks of the numbers beyond their ranges.
            #[cfg(feature = "read")]
            pub(crate) fn check(&self, compliance: f64) -> Option<physics::Complaint> {
                match *self {
                    $(Self::$kind { $($parameter,)+ .. } => {
                        $file::$kind::check([$($parameter),+], self.place(), compliance)
                    })+
                }
            }

            /// What the effect adds at least to the tangent compliance of its
            /// joint (rad/Nm).
            #[cfg(feature = "read")]
            pub(crate) fn least(&self, compliance: f64) -> f64 {
                match *self {
                    $(Self::$kind { $($parameter,)+ .. } => $file::$kind::least([$($parameter),+], compliance),)+
                }
            }
        }

        #[cfg(all(test, feature = "read"))]
        mod tests {
            use super::*;

            /// The registry repeats the parameters' names, for the fields.
            #[test]
            fn the_registry_agrees_with_the_files() {
                $({
                    let about = &about!($file $kind $($parameter)+);
                    assert_eq!(about.kind, stringify!($file));
                    let names: std::vec::Vec<_> = about.parameters.iter().map(|parameter| parameter.name).collect();
                    assert_eq!(names, [$(stringify!($parameter)),+], "{}", about.kind);
                })+
            }
        }
    };
}

/// What is known of a kind.
macro_rules! about {
    ($file:ident $kind:ident $($parameter:ident)+) => {
        <$file::$kind as Physics<{ count!($($parameter)+) }>>::ABOUT
    };
}

macro_rules! count {
    ($($parameter:ident)+) => { [$(stringify!($parameter)),+].len() };
}
