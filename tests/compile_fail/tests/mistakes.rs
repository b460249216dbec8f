//! What the compiler says of `robot!` used wrongly and of broken descriptions:
//! each program in `programs` against its `.stderr`.
//!
//! Every program uses the type after the mistake: one mistake gives one error.
//! To accept new wording, run with `TRYBUILD=overwrite` and read the
//! difference. The words of every rule of a description are pinned in the
//! crate robstiff-robots; here is how they reach a user.

#[test]
fn mistakes_are_explained() {
    trybuild::TestCases::new().compile_fail("programs/*.rs");
}
