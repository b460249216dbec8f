//! Where the fields of a table are in its lines.

/// Where a field is in its line: its column in characters from 1, and its
/// width; `separator` separates the fields.
pub fn extent(line: &str, separator: char, field: usize) -> (usize, usize) {
    let (mut quoted, mut index, mut column, mut width) = (false, 0, 1, 0);
    let mut before = None;
    for (i, character) in line.chars().enumerate() {
        match character {
            '"' if quoted => quoted = false,
            // In the middle of a field a quote is a character; two are one.
            '"' => quoted = width == 0 || before == Some('"'),
            _ if character == separator && !quoted => {
                if index == field {
                    break;
                }
                index += 1;
                (column, width, before) = (i + 2, 0, None);
                continue;
            }
            _ => {}
        }
        width += 1;
        before = Some(character);
    }
    if index < field { (1, line.chars().count()) } else { (column, width) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_found_in_their_line() {
        assert_eq!(extent("1,abc,3", ',', 1), (3, 3));
        assert_eq!(extent("\"a,b\",x", ',', 1), (7, 1));
        assert_eq!(extent("\"a\"\",b\",x", ',', 1), (9, 1));
        assert_eq!(extent("3\" pipe,x", ',', 1), (9, 1));
        assert_eq!(extent("1,\"2,3", ',', 1), (3, 4));
        assert_eq!(extent("1,2", ',', 5), (1, 3));
        assert_eq!(extent("1,5;abc", ';', 1), (5, 3));
    }
}
