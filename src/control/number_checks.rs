//! Checks single numbers, for example those of the configuration. Several parts of the controller use these checks.

use crate::model::configuration::Unusable;

/// Returns an error unless every value is finite and above zero.
pub(super) fn positive(key: &'static str, values: &[f64]) -> Result<(), Unusable> {
    match values.iter().find(|value| !(value.is_finite() && **value > 0.0)) {
        Some(value) => Err(Unusable { key, reason: format!("is {value}; it must be a number above 0") }),
        None => Ok(()),
    }
}

/// Returns an error unless the value is finite and at least zero.
pub(super) fn not_negative(key: &'static str, value: f64) -> Result<(), Unusable> {
    if value.is_finite() && value >= 0.0 {
        return Ok(());
    }
    Err(Unusable { key, reason: format!("is {value}; it must be 0 or a number above 0") })
}

/// Returns an error unless every value is +1 or -1.
pub(super) fn signs(key: &'static str, values: &[i8]) -> Result<(), Unusable> {
    match values.iter().find(|value| !matches!(value, 1 | -1)) {
        Some(value) => Err(Unusable { key, reason: format!("is {value}; a sign is 1 or -1") }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_plus_and_minus_one_are_signs() {
        assert!(signs("encoder.sign", &[1, -1, 1, 1]).is_ok());
        for wrong in [0, 2, i8::MIN, i8::MAX] {
            let unusable = signs("encoder.sign", &[1, wrong]).expect_err("no sign");
            assert_eq!(unusable.reason, format!("is {wrong}; a sign is 1 or -1"));
        }
    }
}
