//! The column `time`: seconds, or what a clock showed.

use std::format;
use std::vec::Vec;

use robstiff_robots::quantity::Dimension;

use super::beyond::warn_of;
use robstiff_robots::table::{Numbers, Table};

/// What is right.
const HELP: &str = "write every time as `08:15:00`, as `2026-11-25 08:15:00`, or in seconds";

/// Seconds.
const DAY: f64 = 86400.0;

/// What a clock shows.
struct Shown<'t> {
    /// Days from any day on, where there is a date.
    day: Option<i64>,
    /// Seconds since midnight.
    seconds: f64,
    /// The zone as it is written, `Z` or `+01:00`, if it is.
    zone: &'t str,
}

/// The time of every row (s), if the table has any; `None` for those with mistakes, which
/// are reported. A column with a colon in it is a clock's, and counts from the midnight
/// before its first row.
pub fn read(table: &Table<'_>) -> Option<Vec<Option<f64>>> {
    let column = table.numbers("time", Dimension::Time)?;
    let clock = table.records.iter().find(|record| table.written(record, column).contains(':'));
    Some(match clock {
        None => table.records.iter().map(|record| table.number(record, column)).collect(),
        Some(record) if table.has_unit(column) => {
            let text = table.written(record, column);
            let message = format!("`{text}` is what a clock shows, and the header has a unit");
            table.report_number(record, column, &message, "write `time` without a unit, or numbers in this unit");
            table.records.iter().map(|_| None).collect()
        }
        Some(_) => of_clock(table, column),
    })
}

fn of_clock(table: &Table<'_>, column: Numbers) -> Vec<Option<f64>> {
    let (mut first, mut earlier) = (None, Vec::new());
    let (mut nights, mut before) = (0, 0.0);
    let times = table.records.iter().map(|record| {
        let text = table.written(record, column);
        let Some(shown) = Shown::parse(text) else {
            let message =
                if text.is_empty() { "a time is missing" } else { &format!("`{text}` is no time of a clock") };
            table.report_number(record, column, message, HELP);
            return None;
        };
        let &mut (line, begun, zone) = first.get_or_insert((record.line, shown.day, shown.zone));
        if (shown.day.is_some(), shown.zone) != (begun.is_some(), zone) {
            let message = format!("`{text}` is written otherwise than the time on line {line}");
            table.report_number(record, column, &message, "all rows have a date or none, and one zone or none");
            return None;
        }
        if begun.is_none() && shown.seconds < before {
            nights += 1;
            // A pause over night, or rows in another order.
            if before - shown.seconds < DAY / 2.0 {
                earlier.push(record.line);
            }
        }
        before = shown.seconds;
        let days = shown.day.zip(begun).map_or(nights, |(day, begun)| day - begun);
        Some(days as f64 * DAY + shown.seconds)
    });
    let times = times.collect();
    let ask = ", and taken for the next day's: if the rows were read in another order, write the date, too";
    warn_of(table, "the time is earlier than the one before", earlier.into_iter(), ask);
    times
}

impl<'t> Shown<'t> {
    /// `08:15:00`, `2026-11-25 08:15:00.25`, `2026-11-25T08:15:00+01:00`.
    fn parse(text: &'t str) -> Option<Self> {
        let (date, clock) = match text.split_once(['T', ' ']) {
            Some((date, clock)) => (Some(date), clock),
            None => (None, text),
        };
        let (clock, zone) = clock.split_at(clock.find(['Z', '+', '-']).unwrap_or(clock.len()));
        let is_zone = zone.bytes().skip(1).all(|byte| byte == b':' || byte.is_ascii_digit());
        let zone = is_zone.then_some(zone)?;
        let (seconds, fraction) = clock.split_once('.').unwrap_or((clock, "0"));
        let [hours, minutes, seconds] = numbers(seconds, ':')?;
        let fraction = fraction.bytes().all(|byte| byte.is_ascii_digit()).then_some(fraction)?;
        let fraction: f64 = format!("0.{fraction}").parse().ok()?;
        let day = match date {
            Some(date) => Some(day_of(numbers(date, '-')?)?),
            None => None,
        };
        let seconds = (hours < 24 && minutes < 60 && seconds < 60).then_some(3600 * hours + 60 * minutes + seconds)?;
        Some(Self { day, seconds: seconds as f64 + fraction, zone })
    }
}

/// Three numbers of up to four digits.
fn numbers(text: &str, between: char) -> Option<[i64; 3]> {
    let number = |text: &str| {
        let is_number = (1..=4).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_digit());
        is_number.then(|| text.parse().ok()).flatten()
    };
    let numbers: Option<Vec<i64>> = text.split(between).map(number).collect();
    numbers?.try_into().ok()
}

/// A year, month and day of the calendar as a day; years begin in March, so that the day
/// of a leap year is the last.
fn day_of([year, month, day]: [i64; 3]) -> Option<i64> {
    let (months, since) = ((month + 9) % 12, if month < 3 { year - 1 } else { year });
    let is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let length = match month {
        2 => 28 + i64::from(is_leap),
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    };
    let is_date = year >= 1900 && (1..=12).contains(&month) && (1..=length).contains(&day);
    is_date.then_some(365 * since + since / 4 - since / 100 + since / 400 + (153 * months + 2) / 5 + day)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_those_of_the_calendar() {
        let days = |from, to| day_of(to).unwrap() - day_of(from).unwrap();
        assert_eq!(days([1970, 1, 1], [2026, 11, 25]), 20_782);
        for (from, to) in [([2024, 2, 29], [2024, 3, 1]), ([2026, 2, 28], [2026, 3, 1]), ([2026, 12, 31], [2027, 1, 1])]
        {
            assert_eq!(days(from, to), 1);
        }
        assert_eq!([day_of([26, 11, 25]), day_of([2026, 13, 1]), day_of([2026, 1, 0])], [None; 3]);
        // The last days of months, and none after them.
        for date in [[2026, 2, 29], [2026, 2, 30], [2100, 2, 29], [2026, 4, 31], [2026, 12, 32]] {
            assert_eq!(day_of(date), None, "{date:?}");
        }
        assert!([[2000, 2, 29], [2026, 4, 30], [2026, 12, 31]].into_iter().all(|date| day_of(date).is_some()));
    }

    #[test]
    fn clocks_are_read_or_refused() {
        let seconds = |text| Shown::parse(text).map(|shown| (shown.day.is_some(), shown.seconds, shown.zone));
        assert_eq!(seconds("8:15:00"), Some((false, 29_700.0, "")));
        assert_eq!(seconds("2026-11-25 08:15:00.25"), Some((true, 29_700.25, "")));
        assert_eq!(seconds("2026-11-25T08:15:00Z"), Some((true, 29_700.0, "Z")));
        assert_eq!(seconds("2026-11-25T08:15:00+01:00"), Some((true, 29_700.0, "+01:00")));
        for text in [
            "",
            "08:15",
            "24:00:00",
            "08:60:00",
            "8:15:00 AM",
            "25.11.2026 08:15:00",
            "08:15:-1",
            "08:15:00.x",
            "08:15:00-x",
        ] {
            assert_eq!(seconds(text), None, "{text}");
        }
    }
}
