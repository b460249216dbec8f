robstiff::robot!();
robstiff::robot!(rv130hsc);
robstiff::robot!("rv130hsc.yaml", "other.yaml");
robstiff::robot!(pub(crate));
robstiff::robot!(struct "rv130hsc.yaml");

fn main() {}
