//! A description next to the source file that calls `robot!`, of a crate that
//! is compiled from elsewhere, as the members of a workspace are: it comes
//! before the one of the same name in the crate's `robots/`.

use robstiff::Robot;

robstiff::robot!("pendulum.yaml");

#[test]
fn the_nearest_description_is_taken() {
    assert_eq!(BesidePendulum.name(), "BesidePendulum");
    assert_eq!(robstiff_tests::arms::Pendulum.name(), "Pendulum");
}
