//! Texts of errors about recordings. They leave out the remedy of a configuration error, because nobody can change the
//! configuration in a recording.

/// Returns the reason why a configuration cannot be used, without its remedy, which is for a person who writes the
/// configuration. The remedy is everything after the first sentence. If there is only one sentence, the remedy is the
/// part after its last colon. Abbreviations such as "eq. 17" end no sentence.
#[must_use]
pub fn without_remedy(reason: &str) -> String {
    let begins_sentence = |&(end, _): &(usize, &str)| reason[end + 2..].starts_with(char::is_uppercase);
    let sentence = reason.match_indices(". ").find(begins_sentence).map(|(end, _)| &reason[..end]);
    let cause = sentence.or_else(|| reason.rsplit_once(": ").map(|(cause, _)| cause));
    cause.unwrap_or(reason).into()
}
