//! The order of parts: which encoder or gauge responds at the place of each number.

/// The order of a finger whose parts are all at their places.
pub const RIGHT: [usize; 4] = [1, 2, 3, 4];

/// Whether an exchange of cables explains the order: each part answers at exactly one place.
pub fn is_exchange(order: [usize; 4]) -> bool {
    let mut sorted = order;
    sorted.sort_unstable();
    sorted == RIGHT && order != RIGHT
}

/// Whether a part answers at two places. 0 means that no part answers.
pub fn repeats(order: [usize; 4]) -> bool {
    (1..=4).any(|part| order.iter().filter(|&&found| found == part).count() > 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_permutation_is_an_exchange() {
        assert!(is_exchange([2, 1, 3, 4]) && is_exchange([2, 3, 1, 4]));
        assert!(!is_exchange(RIGHT) && !is_exchange([2, 2, 3, 4]) && !is_exchange([2, 1, 0, 4]));
        assert!(repeats([2, 2, 0, 4]) && !repeats([2, 1, 0, 0]));
    }
}
