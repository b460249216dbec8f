//! The header of a table.

/// `name [unit]`.
pub struct Header {
    /// What the column is called.
    pub name: String,
    /// What readers look for it by: its name, but where it is another's.
    pub key: String,
    /// Its unit, if there is one.
    pub unit: Option<String>,
    /// Whether the bracket of the unit is closed.
    pub closed: bool,
}

impl Header {
    /// Reads a field of the header.
    pub fn parse(text: &str) -> Self {
        let (name, unit, closed) = match text.split_once('[') {
            Some((name, rest)) => {
                let inside = rest.trim_end().strip_suffix(']');
                (name, Some(inside.unwrap_or(rest).trim().to_string()), inside.is_some())
            }
            None => (text, None, true),
        };
        let name = name.trim().to_owned();
        Self { key: name.clone(), name, unit, closed }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_have_names_and_units() {
        let header = Header::parse("q1 [deg] ");
        assert_eq!((header.name.as_str(), header.unit.as_deref()), ("q1", Some("deg")));
        assert_eq!(Header::parse("pose").unit, None);
        let open = Header::parse("dx [um");
        assert_eq!((open.name.as_str(), open.unit.as_deref(), open.closed), ("dx", Some("um"), false));
    }
}
