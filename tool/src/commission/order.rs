//! The order of sensors: which encoder responds to each motor, or which gauge responds to each tendon.

use super::outcome::Outcome;
use super::wrong::Wrong;

/// The order of a finger in which sensor n responds to motor or tendon n.
pub const RIGHT: [usize; 4] = [1, 2, 3, 4];

/// Whether an exchange of cables explains the order: it is not [`RIGHT`], and each sensor responds to exactly one motor
/// or tendon.
pub fn is_exchange(order: [usize; 4]) -> bool {
    let mut sorted = order;
    sorted.sort_unstable();
    sorted == RIGHT && order != RIGHT
}

/// Whether a sensor responds to two motors or tendons. 0 in `order` means that no sensor responds.
pub fn repeats(order: [usize; 4]) -> bool {
    (1..=4).any(|part| order.iter().filter(|&&found| found == part).count() > 1)
}

/// If exactly one motor or tendon has no sensor in `order`, and exactly one sensor is not in `order`, the two belong
/// together. Adds this sensor to the order, which is then complete. If the sensor was reported as `dead` under the
/// number of the motor or tendon, the report gets the sensor's own number.
pub fn name_the_missing(outcome: &mut Outcome, order: &mut [usize; 4], dead: fn(usize) -> Wrong) {
    let missing: Vec<usize> = (0..4).filter(|&place| order[place] == 0).collect();
    let unused: Vec<usize> = (1..=4).filter(|sensor| !order.contains(sensor)).collect();
    if let ([place], [sensor]) = (&missing[..], &unused[..]) {
        order[*place] = *sensor;
        for wrong in &mut outcome.wrong {
            if *wrong == dead(place + 1) {
                *wrong = dead(*sensor);
            }
        }
    }
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
