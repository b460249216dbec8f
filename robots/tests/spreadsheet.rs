//! Tables from spreadsheets. The files were written by openpyxl 3.1.
#![cfg(feature = "table")]

use std::path::{Path, PathBuf};

use robstiff_robots::table::text_of;

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files").join(name)
}

#[test]
#[cfg(not(feature = "xlsx"))]
fn a_build_without_spreadsheets_says_how_to_get_them() {
    let told = text_of(&file("one-sheet.xlsx")).unwrap_err().to_string();
    assert!(told.contains("this build reads neither"), "{told}");
    assert!(told.contains("save the sheet as CSV, or build robstiff with `--features xlsx`"), "{told}");
}

#[cfg(feature = "xlsx")]
mod read {
    use std::fs;
    use std::io::Write as _;

    use robstiff_robots::quantity::Dimension;
    use robstiff_robots::table::{Table, text_of_sheet};

    use super::{PathBuf, file, text_of};

    #[test]
    fn a_row_is_a_line() {
        assert_eq!(
            text_of(&file("one-sheet.xlsx")).unwrap(),
            "\npose,time,q1 [deg],\"Fz, up [N]\",temperature\n1,2026-11-25 08:15:00,12.5,-300,20\n\
             P 2,2026-11-25 08:16:30.500,0.1,,\n\n3,09:00:00,two lines,true,21"
        );
    }

    #[test]
    fn a_mistake_is_shown_at_the_row_that_the_spreadsheet_numbers() {
        let text = text_of(&file("one-sheet.xlsx")).unwrap();
        let table = Table::parse("one-sheet.xlsx", &text).unwrap();
        let column = table.require("q1", Dimension::Angle).unwrap();
        assert_eq!(table.number(&table.records[0], column), Some(12.5_f64.to_radians()));
        assert_eq!(table.number(&table.records[2], column), None);
        let told = table.finish(Some(())).unwrap_err().to_string();
        assert!(told.contains("--> one-sheet.xlsx:6:"), "{told}");
    }

    #[test]
    fn of_several_sheets_one_is_named() {
        let two = file("two-sheets.xlsx");
        let told = text_of(&two).unwrap_err().to_string();
        assert!(told.contains("several sheets of this spreadsheet have cells: `loads` and `notes`"), "{told}");
        assert!(told.contains("`sheet: loads`"), "{told}");
        assert_eq!(text_of_sheet(&two, Some("notes")).unwrap(), "by,K. Meyer");
        let told = text_of_sheet(&two, Some("load")).unwrap_err().to_string();
        assert!(told.contains("no sheet `load`") && told.contains("its sheets: `loads`, `notes`"), "{told}");
    }

    /// A file for a test, which ends with it.
    struct Made(PathBuf);

    impl Made {
        fn new(name: &str, bytes: &[u8]) -> Self {
            let path = std::env::temp_dir().join(format!("robstiff-{}-{name}", std::process::id()));
            fs::write(&path, bytes).unwrap();
            Self(path)
        }

        fn told(&self) -> String {
            text_of(&self.0).unwrap_err().to_string()
        }
    }

    impl Drop for Made {
        fn drop(&mut self) {
            let _ = fs::remove_file(&self.0);
        }
    }

    #[test]
    fn what_is_no_spreadsheet_is_told() {
        assert!(Made::new("old.xls", b"\xd0\xcf\x11\xe0\xa1\xb1").told().contains("an old kind (.xls)"));
        let whole = fs::read(file("one-sheet.xlsx")).unwrap();
        for length in [4, 30, whole.len() / 2, whole.len() - 1] {
            let told = Made::new("cut.xlsx", &whole[..length]).told();
            assert!(told.contains("no spreadsheet that can be read"), "{told}");
        }
        let csv = Made::new("loads.csv", b"pose,q1\n1,2\n");
        let told = text_of_sheet(&csv.0, Some("loads")).unwrap_err().to_string();
        assert!(told.contains("this file is no spreadsheet"), "{told}");
    }

    #[test]
    fn a_packed_file_is_no_larger_than_a_table_may_be() {
        let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
        archive.start_file("xl/sharedStrings.xml", zip::write::SimpleFileOptions::default()).unwrap();
        let million = vec![b' '; 1 << 20];
        for _ in 0..257 {
            archive.write_all(&million).unwrap();
        }
        let packed = archive.finish().unwrap().into_inner();
        assert!(packed.len() < 1 << 20);
        let told = Made::new("large.xlsx", &packed).told();
        assert!(told.contains("larger than 256 MiB"), "{told}");
    }
}
