//! The delays from contacts to reactions, and how many of them are within a goal.

use crate::explain::Pauses;

/// The delay from a contact to the first command that reacts to it.
pub struct Delay {
    pub periods: u64,
    /// Beginning of the period of the contact, and end of the period of the command, ns.
    pub time: [u64; 2],
}

/// The delays from contacts to reactions.
pub struct Delays {
    known: Vec<Delay>,
    /// Longest permitted delay, periods.
    goal: u64,
    /// Contacts without a reaction.
    missing: u32,
}

impl Delays {
    pub fn new(goal: u64) -> Self {
        Self { known: Vec::new(), goal, missing: 0 }
    }

    /// Adds the delay of a contact, or a contact without a reaction.
    pub fn add(&mut self, delay: Option<Delay>) {
        match delay {
            Some(delay) => self.known.push(delay),
            None => self.missing += 1,
        }
    }

    /// Returns the number of contacts.
    pub fn contacts(&self) -> usize {
        self.known.len() + self.missing as usize
    }

    /// Returns the share of these delays that is within the goal, %.
    fn share<'a>(&self, delays: impl Iterator<Item = &'a Delay>) -> f64 {
        let (mut within, mut all) = (0_u32, 0_u32);
        for delay in delays {
            within += u32::from(delay.periods <= self.goal);
            all += 1;
        }
        100.0 * f64::from(within) / f64::from(all.max(1))
    }

    /// Prints a row of the table. The machine counts as paused during a delay if the pauses of one core within the
    /// delay add up to at least `paused`, ns.
    pub fn print(mut self, what: &str, paused: u64, pauses: &Pauses) {
        if self.contacts() == 0 {
            println!("| {what} | not measured, because every measurement failed or was skipped | | | | | | |");
            return;
        }
        self.known.sort_unstable_by_key(|delay| delay.periods);
        let count = self.known.len();
        let at = |place: usize| self.known.get(place).map_or("-".into(), |delay| delay.periods.to_string());
        let undisturbed = || self.known.iter().filter(|delay| pauses.total_on_worst_core(delay.time) < paused);
        println!(
            "| {what} | {count} | {:.2} % | {} | {} | {} | {} | {:.2} % |",
            self.share(self.known.iter()),
            at((count as f64 * 0.999) as usize),
            at(count.saturating_sub(1)),
            self.missing,
            count - undisturbed().count(),
            self.share(undisturbed()),
        );
    }
}
