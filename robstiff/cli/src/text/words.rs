//! Full names of effects in words.

use crate::text::and;

/// `lost_motion@joint 1` as `lost motion of joint 1`.
pub fn spoken(name: &str) -> String {
    by_kind(&[name.to_owned()]).join(", ")
}

/// Several names, each kind once: `lost motion of joints 1 and 2`.
pub fn by_kind(names: &[String]) -> Vec<String> {
    let mut kinds: Vec<(&str, Vec<&str>)> = Vec::new();
    for name in names {
        let (kind, place) = name.split_once('@').unwrap_or((name, ""));
        match kinds.iter_mut().find(|(known, _)| *known == kind) {
            Some((_, places)) => places.push(place),
            None => kinds.push((kind, vec![place])),
        }
    }
    let said = |(kind, places): &(&str, Vec<&str>)| {
        // Where the place says again what the kind says, once is enough.
        let part = ["joint_", "link_"].into_iter().find_map(|part| kind.strip_prefix(part)).unwrap_or(kind);
        let placed = [kind, part][usize::from(kind.len() != part.len() && places != &[""])];
        let kind = placed.replace('_', " ").replace("dh error", "DH error");
        match places[..] {
            [""] => kind,
            [place] if kind.starts_with(place) => kind,
            ["rig"] => format!("{kind} (measurement)"),
            _ => format!("{kind} of {}", together(places)),
        }
    };
    kinds.iter().map(said).collect()
}

/// Places as a sentence lists them: `joint 1` and `joint 2` are `joints 1 and
/// 2`, the pair `joints 1,2` is `joints 1/2`.
fn together(places: &[&str]) -> String {
    for what in ["joint", "link"] {
        let number = |place: &&str| place.strip_prefix(what)?.strip_prefix(' ').map(str::to_owned);
        if let Some(numbers) = places.iter().map(number).collect::<Option<Vec<_>>>() {
            return format!("{what}{} {}", if numbers.len() == 1 { "" } else { "s" }, and(&numbers));
        }
    }
    let place = |place: &&str| match *place {
        "base" | "tool" | "robot" | "rig" => format!("the {place}"),
        place => place.replace(',', "/"),
    };
    and(&places.iter().map(place).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_read_as_words() {
        assert_eq!(spoken("lost_motion@joint 1"), "lost motion of joint 1");
        assert_eq!(spoken("lever_arm@rig"), "lever arm (measurement)");
        assert_eq!(spoken("joint_coupling@joints 2,3"), "coupling of joints 2/3");
        let names = ["dh_error@d1", "creep@rig", "dh_error@a2", "base_compliance@base"].map(str::to_owned);
        assert_eq!(by_kind(&names), ["DH error of d1 and a2", "creep (measurement)", "base compliance"]);
        let names = ["joint 1", "joint 4", "joint 6"].map(|place| format!("joint_zero_offset@{place}"));
        assert_eq!(by_kind(&names), ["zero offset of joints 1, 4 and 6"]);
    }
}
