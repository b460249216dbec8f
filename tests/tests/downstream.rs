//! `robot!` in the hands of a user: an own crate, with the dependency renamed
//! (`tests/fixtures/renamed`), built by cargo from a copy. Judged by what it
//! prints: where descriptions are found and which comes first, that a changed
//! description changes the program, and that a broken one says where.

mod user;

use user::User;

const PRINTED: &str = "\
BesideInner 1e-6
BesideMain 2e-6
InManifest 3e-6
InFolder 4e-6
InSubfolder 5e-6
NamedAsAFolder 7e-6
OwnRv130hsc 6e-6
StaubliRx160, KukaKr270R2700
";

#[test]
fn finds_descriptions_and_follows_them() {
    let user = User::new("renamed");
    // A folder is no description, whatever its name.
    std::fs::create_dir(user.folder.join("src/folder.yaml")).expect("a folder");
    assert_eq!(user.prints(), PRINTED);

    // Nothing else changes than the description.
    user.edit("src/beside.yaml", "2e-6 rad/Nm", "125000 Nm/rad");
    assert_eq!(user.prints(), PRINTED.replace("BesideMain 2e-6", "BesideMain 8e-6"));
    user.edit("robots/arms/deep.yaml", "1 m,", "2 m,");
    assert!(user.prints().contains("InSubfolder 2e-5\n"));

    // A mistake: at its place in the description, and no other error for it.
    user.edit("robots/folder.yaml", "compliance: 4e-6", "complience: 4e-6");
    let message = refusal(&user);
    assert!(message.contains("robots/folder.yaml:5:14"), "{message}");
    assert!(message.contains("`compliance`"), "{message}");
    assert!(message.contains("due to 1 previous error"), "{message}");
    user.edit("robots/folder.yaml", "complience", "compliance");
    assert!(user.prints().contains("InFolder 4e-6\n"));
}

/// What the compiler says when it refuses.
fn refusal(user: &User) -> String {
    let output = user.run();
    assert!(!output.status.success(), "it compiled");
    String::from_utf8_lossy(&output.stderr).replace('\\', "/")
}
