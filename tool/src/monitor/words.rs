//! Events and times in words.

use sun2xp::FaultKind;
use sun2xp::events::{Event, ValueKind};
use sun2xp::model::Part;

/// Returns an event in words: kind, part and values with their units.
pub fn event_text(event: &Event) -> String {
    let description = event.kind.description();
    let mut text = description.name.to_owned();
    if event.part != Part::Finger {
        text += &format!(", {}", event.part);
    }
    let mut values = event.values.iter().copied();
    for &meaning in description.values {
        let own: Vec<f64> = values.by_ref().take(meaning.places()).collect();
        if let Some(words) = value_text(meaning, &own) {
            text += &format!(", {words}");
        }
    }
    text
}

/// Returns values with their unit, or `None` if they mean nothing to a person.
fn value_text(meaning: ValueKind, values: &[f64]) -> Option<String> {
    let first = *values.first()?;
    Some(match (meaning, values) {
        (ValueKind::Force, values) => {
            let parts: Vec<_> = values.iter().map(|part| fixed(*part, 2)).collect();
            format!("force {} N", parts.join(" "))
        }
        (ValueKind::Joints, values) => {
            let degrees: Vec<_> = values.iter().map(|angle| fixed(angle.to_degrees(), 1)).collect();
            format!("joints {} deg", degrees.join(" "))
        }
        (ValueKind::Angle, _) => format!("{} deg", fixed(first.to_degrees(), 1)),
        (ValueKind::Limit, _) => format!("limit {} deg", fixed(first.to_degrees(), 1)),
        (ValueKind::Tension, _) => format!("{} N", fixed(first, 1)),
        (ValueKind::Bound, _) => format!("bound {first:.1} N"),
        (ValueKind::FaultNumber, _) => {
            let kind = FaultKind::from_number(first as i32)?;
            format!("{} ({})", kind.description().name, kind.number())
        }
        (ValueKind::Element, _) => format!("element {first:.0}"),
        (ValueKind::Pressure, _) => format!("{first:.2} N"),
        (ValueKind::Rule, _) => format!("rule {first:.0}"),
        (ValueKind::Age, _) => format!("after {first:.0} ms"),
        _ => return None,
    })
}

/// Returns a value with this number of decimals, without the sign of a negative zero.
fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().all(|byte| matches!(byte, b'0' | b'.')) => digits.to_owned(),
        _ => text,
    }
}

/// Returns a time span with a unit that suits it. Up to 999 days, it has at most eight characters.
pub fn span(seconds: f64) -> String {
    match seconds {
        s if s < 99.95 => format!("{s:.1} s"),
        s if s < 5999.5 => format!("{:.0} min", s / 60.0),
        s if s < 359_999.0 => format!("{:.0} h", s / 3600.0),
        s => format!("{:.0} days", s / 86_400.0),
    }
}

/// Returns a time, s since 1970, as `2026-11-22T15:04:05Z`.
pub fn utc(seconds: u64) -> String {
    let (days, rest) = (seconds / 86_400, seconds % 86_400);
    // The calendar repeats after 400 years, which are 146097 days. Years are counted from March, so that a leap day is
    // the last day of its year.
    let shifted = days + 719_468;
    let (era, day_of_era) = (shifted / 146_097, shifted % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    let year = era * 400 + year_of_era + u64::from(month <= 2);
    let (hour, minute, second) = (rest / 3600, rest / 60 % 60, rest % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z")
}

/// Breaks a text into lines of at most `width` characters, at spaces where possible. Only white space is lost.
pub fn wrap(text: &str, width: usize) -> Vec<String> {
    let width = width.max(1);
    let mut lines = vec![String::new()];
    let mut length = 0;
    for word in text.split_whitespace() {
        let mut word: Vec<char> = word.chars().collect();
        let needed = word.len() + usize::from(length > 0);
        if length > 0 && length + needed > width {
            lines.push(String::new());
            length = 0;
        }
        while word.len() > width {
            let rest = word.split_off(width);
            lines.last_mut().into_iter().for_each(|line| line.extend(&word));
            lines.push(String::new());
            word = rest;
        }
        if let Some(line) = lines.last_mut() {
            if length > 0 {
                line.push(' ');
                length += 1;
            }
            line.extend(&word);
            length += word.len();
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_those_of_the_calendar() {
        for (seconds, text) in [
            (0, "1970-01-01T00:00:00Z"),
            (951_782_399, "2000-02-28T23:59:59Z"),
            (951_782_400, "2000-02-29T00:00:00Z"),
            (1_795_359_845, "2026-11-22T15:04:05Z"),
            (4_107_542_400, "2100-03-01T00:00:00Z"),
        ] {
            assert_eq!(utc(seconds), text);
        }
        assert_eq!([0.04, 99.9, 120.0, 7300.0, 1e6].map(span), ["0.0 s", "99.9 s", "2 min", "2 h", "12 days"]);
    }

    #[test]
    fn a_wrapped_text_keeps_every_word() {
        let text = "broken tendon, tendon 3 (0.0 N): a tendon has no tension. Likely cause: it is torn";
        for width in [1, 7, 20, 60, 200] {
            let lines = wrap(text, width);
            assert!(lines.iter().all(|line| line.chars().count() <= width), "{lines:?}");
            let together: String = lines.concat().split_whitespace().collect();
            assert_eq!(together, text.split_whitespace().collect::<String>());
        }
        assert_eq!(wrap("aa bb cc", 5), ["aa bb", "cc"]);
    }
}
