//! Descriptions broken at random: told or read, never a panic.
#![cfg(feature = "read")]

use robstiff_robots::Description;
use robstiff_robots::catalogue::find;

#[test]
fn random_damage_never_panics() {
    let robot = find("rv130hsc").unwrap();
    let effects = "effects:\n  - {kind: joint_coupling, at: \"joints 1,2\", value: 1e-8}\n  \
                   - {kind: stiffness_nonlinearity, at: joint 2, added: 1e-8, knee: 5 Nm}\nlinks: [{}, {}, {}, {}, {}]\n";
    let text: Vec<char> = format!("{robot}{effects}").chars().collect();
    let damage: Vec<char> = "{}[]:,#&*!|>'\"%@`-?\n\t 0eE.i~é机\u{85}\u{feff}\u{0}".chars().collect();
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut below = |most: usize| {
        // xorshift64
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % most as u64) as usize
    };
    for _ in 0..4000 {
        let mut broken = text.clone();
        for _ in 0..=below(3) {
            let at = below(broken.len());
            match below(3) {
                0 => drop(broken.drain(at..broken.len().min(at + 1 + below(8)))),
                1 => broken.insert(at, damage[below(damage.len())]),
                _ => broken[at] = damage[below(damage.len())],
            }
        }
        let broken: String = broken.into_iter().collect();
        Description::outline(&broken);
        if let Err(problems) = Description::parse("robot.yaml", &broken) {
            assert!(!problems.to_string().is_empty());
        }
    }
}
