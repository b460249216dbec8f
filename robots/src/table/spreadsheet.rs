//! Spreadsheets (`.xlsx`): the cells of one sheet as the text of a CSV table. A row is a line, so problems
//! are shown by the row that a spreadsheet numbers alike.

use std::path::Path;

use crate::text::{MOST_OF_TABLE, bytes};
use crate::{Diagnostic, Diagnostics, Line, ReadError};

/// What is in a file: of a spreadsheet a sheet's cells as CSV, else its bytes as they are.
///
/// # Errors
/// A file that cannot be read, or a spreadsheet of which no sheet can be.
pub fn bytes_of(path: &Path, sheet: Option<&str>) -> Result<Vec<u8>, ReadError> {
    let bytes = bytes(path, MOST_OF_TABLE).map_err(|error| ReadError::Io { path: path.to_owned(), error })?;
    let problem = |message: &str, help: &str| {
        let line = Line { number: 1, text: "" };
        let file = path.display().to_string();
        Err(ReadError::Invalid(Diagnostics::from(Diagnostic::of_line(&file, line, message.to_owned(), help))))
    };
    if bytes.starts_with(OLD) {
        return problem("this is a spreadsheet of an old kind (.xls)", "save it as CSV");
    }
    if !bytes.starts_with(ZIP) {
        return match sheet {
            Some(_) => problem("this file is no spreadsheet, and `sheet` names one of its sheets", "leave `sheet` out"),
            None => Ok(bytes),
        };
    }
    match as_csv(bytes, sheet) {
        Ok(text) => Ok(text.into_bytes()),
        Err([message, help]) => problem(&message, &help),
    }
}

/// What a zip archive begins with, as which an `.xlsx` file is packed.
const ZIP: &[u8] = b"PK\x03\x04";

/// What spreadsheets before 2007 begin with.
const OLD: &[u8] = b"\xd0\xcf\x11\xe0";

#[cfg(not(feature = "xlsx"))]
fn as_csv(_: Vec<u8>, _: Option<&str>) -> Result<String, [String; 2]> {
    let help = "save the sheet as CSV, or build robstiff with `--features xlsx`";
    Err(["this is a spreadsheet or an archive, and this build reads neither", help].map(String::from))
}

#[cfg(feature = "xlsx")]
use read::as_csv;

#[cfg(feature = "xlsx")]
mod read {
    use std::io::{self, Cursor, Read as _};

    use calamine::{DataRef, ExcelDateTime, Reader as _, SheetType, SheetVisible, Xlsx, XlsxError};

    use super::super::MOST_COLUMNS;
    use crate::text::{MOST_OF_TABLE, larger, shown_in_line};
    use crate::words::and;

    type Problem = [String; 2];

    /// The cells of a sheet as CSV; without a name, of the only sheet that has any.
    pub fn as_csv(bytes: Vec<u8>, sheet: Option<&str>) -> Result<String, Problem> {
        refuse_large(&bytes)?;
        let mut book: Xlsx<_> = calamine::open_workbook_from_rs(Cursor::new(bytes)).map_err(|error| broken(&error))?;
        let is_table = |sheet: &&calamine::Sheet| sheet.typ == SheetType::WorkSheet;
        let sheets: Vec<_> = book.sheets_metadata().iter().filter(is_table).cloned().collect();
        if let Some(name) = sheet {
            if sheets.iter().any(|found| found.name == name) {
                return csv_of(&mut book, name);
            }
            let message = format!("this spreadsheet has no sheet `{}`", shown_in_line(name));
            let names: Vec<_> = sheets.iter().map(|sheet| quoted(&sheet.name)).collect();
            return Err([message, format!("its sheets: {}", names.join(", "))]);
        }
        let mut filled = Vec::new();
        for sheet in sheets.iter().filter(|sheet| sheet.visible == SheetVisible::Visible) {
            let text = csv_of(&mut book, &sheet.name)?;
            if !text.is_empty() {
                filled.push((&*sheet.name, text));
            }
        }
        match filled.len() {
            1 => Ok(filled.swap_remove(0).1),
            0 => Ok(String::new()),
            _ => {
                let names = and(&filled.iter().map(|(name, _)| quoted(name)).collect::<Vec<_>>());
                let help = format!("name one in the campaign, e.g. `sheet: {}`, or keep one in the file", filled[0].0);
                Err([format!("several sheets of this spreadsheet have cells: {names}"), help])
            }
        }
    }

    fn quoted(name: &str) -> String {
        format!("`{}`", shown_in_line(name))
    }

    /// A packed file may be a thousand times larger than it looks.
    fn refuse_large(bytes: &[u8]) -> Result<(), Problem> {
        let unpacked = |error: zip::result::ZipError| broken(&XlsxError::Zip(error));
        let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).map_err(unpacked)?;
        let mut room = MOST_OF_TABLE as u64;
        for index in 0..archive.len() {
            let file = archive.by_index(index).map_err(unpacked)?;
            let size = io::copy(&mut file.take(room + 1), &mut io::sink()).map_err(|error| broken(&error.into()))?;
            room = room.checked_sub(size).ok_or_else(too_large)?;
        }
        Ok(())
    }

    fn too_large() -> Problem {
        [format!("this spreadsheet is {}", larger(MOST_OF_TABLE)), String::from("save the sheet as CSV, in parts")]
    }

    fn broken(error: &XlsxError) -> Problem {
        [format!("this is no spreadsheet that can be read: {error}"), String::from("save the sheet as CSV")]
    }

    fn csv_of<R: io::Read + io::Seek>(book: &mut Xlsx<R>, sheet: &str) -> Result<String, Problem> {
        let mut cells = book.worksheet_cells_reader(sheet).map_err(|error| broken(&error))?;
        // The first row that has cells names the columns; every other is as long at least.
        let (mut text, mut at, mut width) = (String::new(), (0, 0), None);
        while let Some(cell) = cells.next_cell().map_err(|error| broken(&error))? {
            let written = written(cell.get_value());
            if written.is_empty() {
                continue;
            }
            let (row, column) = cell.get_position();
            if (row, column) < at {
                return Err(
                    ["the cells of this spreadsheet are out of order", "save the sheet as CSV"].map(String::from)
                );
            }
            if column as usize >= MOST_COLUMNS {
                let message = format!("a cell stands in column {}, a table has {MOST_COLUMNS} at most", column + 1);
                return Err([message, String::from("keep the columns that are read")]);
            }
            if row > at.0 {
                if !text.is_empty() {
                    text.extend((at.1..*width.get_or_insert(at.1)).map(|_| ','));
                }
                text.extend((at.0..row).map(|_| '\n'));
                at = (row, 0);
            }
            text.extend((at.1..column).map(|_| ','));
            at.1 = column;
            push_quoted(&mut text, &written);
            if text.len() > MOST_OF_TABLE {
                return Err(too_large());
            }
        }
        text.extend((at.1..width.unwrap_or(at.1)).map(|_| ','));
        Ok(text)
    }

    /// A cell as CSV has it. A line ends in no cell: it would count as two rows.
    fn push_quoted(text: &mut String, cell: &str) {
        let cell = cell.replace(['\n', '\r'], " ");
        if cell.contains([',', '"', ';', '\t']) {
            text.push('"');
            text.push_str(&cell.replace('"', "\"\""));
            text.push('"');
        } else {
            text.push_str(&cell);
        }
    }

    fn written(value: &DataRef<'_>) -> String {
        match value {
            DataRef::Empty => String::new(),
            DataRef::Int(number) => number.to_string(),
            DataRef::Float(number) => number.to_string(),
            DataRef::String(text) | DataRef::DateTimeIso(text) | DataRef::DurationIso(text) => text.clone(),
            DataRef::SharedString(text) => (*text).to_owned(),
            DataRef::Bool(value) => value.to_string(),
            DataRef::DateTime(time) => clock(time),
            DataRef::Error(error) => error.to_string(),
        }
    }

    /// A time as a clock shows it, with the date if there is one.
    fn clock(time: &ExcelDateTime) -> String {
        let (year, month, day, hours, minutes, seconds, milliseconds) = time.to_ymd_hms_milli();
        let mut shown = format!("{hours:02}:{minutes:02}:{seconds:02}");
        if milliseconds > 0 {
            shown += &format!(".{milliseconds:03}");
        }
        // Less than a day is a time alone.
        if time.as_f64() < 1.0 { shown } else { format!("{year:04}-{month:02}-{day:02} {shown}") }
    }
}
