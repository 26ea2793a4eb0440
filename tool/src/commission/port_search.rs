//! Finds the board of a finger for which the configuration names no board.

use std::path::PathBuf;
use sun2xp::hand::{FoundFinger, found_at, search_boards};
use sun2xp::model::configuration::BoardNumber;
use sun2xp::model::{FingerNumber, Shown, ShownPath};

/// A finger of a board at a port.
#[derive(Clone, Debug)]
pub struct Answer {
    pub port: PathBuf,
    pub found: FoundFinger,
}

impl Answer {
    pub fn number(&self) -> BoardNumber {
        BoardNumber(self.found.identity.unique_number)
    }

    /// Returns the encoder counts per revolution that the board reports; `None` if the board does not know them.
    pub fn counts_per_revolution(&self) -> Option<u32> {
        Some(self.found.identity.counts_per_revolution).filter(|&counts| counts != 0)
    }

    fn text(&self) -> String {
        format!("{} address {} at {}", self.number(), self.found.address, ShownPath(&self.port))
    }
}

/// The answer that belongs to a finger, and why.
pub struct Chosen {
    pub answer: Answer,
    pub reason: String,
}

impl Chosen {
    /// What was chosen, in a sentence.
    pub fn text(&self) -> String {
        format!("Took the board {}: {}.", self.answer.text(), self.reason)
    }
}

/// A finger of a board: the unique number and the address. A board may report the same unique number for all of its
/// fingers, although the protocol demands different ones. Then only the address distinguishes them.
pub type Taken = (BoardNumber, u8);

/// Searches these ports for the board of a finger. `taken` lists the boards and addresses of the other fingers of the
/// hand.
///
/// # Errors
/// Returns the reason if no finger answers, or if every finger that answers is in `taken`. If several fingers that are
/// not in `taken` answer, returns the reason unless exactly one of them has the number of `finger` as its address.
pub fn search(patterns: &[String], baud: u32, finger: FingerNumber, taken: &[Taken]) -> Result<Chosen, String> {
    let searched = search_boards(patterns, &[baud]);
    let answers = searched.iter().flat_map(|port| {
        let found = port.answer.iter().flatten().cloned();
        found.map(|found| Answer { port: port.path.clone(), found })
    });
    choose(answers.collect(), finger, taken).map_err(|reason| {
        format!("{reason}. Ports searched: {}. Found: {}", Shown(&patterns.join(", ")), found_at(&searched))
    })
}

fn choose(answers: Vec<Answer>, finger: FingerNumber, taken: &[Taken]) -> Result<Chosen, String> {
    let (others, free): (Vec<Answer>, Vec<Answer>) =
        answers.into_iter().partition(|answer| taken.contains(&(answer.number(), answer.found.address)));
    // If several free fingers answer, the right one is the one whose address is the number of `finger`.
    let same: Vec<&Answer> = free.iter().filter(|answer| i32::from(answer.found.address) == finger.get()).collect();
    let (answer, reason) = match (&free[..], &same[..]) {
        ([], _) if others.is_empty() => {
            return Err("no board answers: connect and switch on the board, or name its port with --port".into());
        }
        ([], _) => {
            return Err("only boards of other fingers answer: connect and switch on the board, or name its port with \
                        --port"
                .into());
        }
        ([only], _) if others.is_empty() => (only, "it is the only one that answers".into()),
        ([only], _) => (only, "the others that answer belong to other fingers of the file".into()),
        (_, [only]) => {
            let rest = free.iter().filter(|other| other.text() != only.text()).map(Answer::text);
            let rest = rest.collect::<Vec<_>>().join("; ");
            (*only, format!("its address is the number of the finger. Not taken: {rest}"))
        }
        _ => {
            let all = free.iter().map(Answer::text).collect::<Vec<_>>().join("; ");
            return Err(format!(
                "{} fingers answer, and none or several of them have the address {finger}: {all}. Connect only the \
                 board of the finger, or name its port with --port. If they are on one board, write \
                 finger.{finger}.board, finger.{finger}.address and hand.fingers into the configuration file",
                free.len()
            ));
        }
    };
    Ok(Chosen { answer: answer.clone(), reason })
}

#[cfg(test)]
mod tests {
    use super::*;
    use sun2xp::board::protocol::{Capabilities, FirmwareVersion, Identity};

    fn answer(board: u8, address: u8) -> Answer {
        let identity = Identity {
            version: 1,
            addresses: 0b1110,
            board_kind: 0,
            unique_number: [board; 12],
            firmware: FirmwareVersion([1, 0, 0]),
            counts_per_revolution: 2000,
            gauge_bits: 12,
            torque_unit: 2000,
            torque_limit: 23_750,
            shortest_watchdog_ms: 2,
            capabilities: Capabilities::HOLD,
        };
        Answer { port: format!("/dev/board{board}").into(), found: FoundFinger { address, identity } }
    }

    fn chosen(answers: &[(u8, u8)], taken: &[(u8, u8)]) -> Result<(u8, u8, String), String> {
        let answers = answers.iter().map(|&(board, address)| answer(board, address)).collect();
        let taken: Vec<Taken> = taken.iter().map(|&(board, address)| (BoardNumber([board; 12]), address)).collect();
        let Chosen { answer, reason } = choose(answers, FingerNumber::TWO, &taken)?;
        Ok((answer.found.identity.unique_number[0], answer.found.address, reason))
    }

    #[test]
    fn the_board_that_is_taken_and_the_reason_are_named() {
        for (answers, taken, expected, reason) in [
            (&[(5, 1)][..], &[][..], (5, 1), "only one that answers"),
            (&[(5, 1), (6, 1)], &[(5, 1)], (6, 1), "belong to other fingers of the file"),
            (&[(5, 1), (5, 2), (5, 3)], &[(5, 1)], (5, 2), "its address is the number of the finger. Not taken: "),
            (&[(6, 1), (7, 2)], &[], (7, 2), "its address is the number of the finger"),
        ] {
            let (board, address, why) = chosen(answers, taken).expect("chosen");
            assert!((board, address) == expected && why.contains(reason), "{answers:?}: {board}, {address}, {why}");
        }
    }

    #[test]
    fn without_a_single_right_board_the_choice_is_refused() {
        for (answers, taken, reason) in [
            (&[][..], &[][..], "no board answers"),
            (&[(5, 1)], &[(5, 1)], "only boards of other fingers answer"),
            (&[(5, 1), (6, 1)], &[], "2 fingers answer, and none or several of them have the address 2: "),
            (&[(5, 2), (6, 2)], &[], "Connect only the board of the finger"),
            (
                &[(5, 1), (5, 3)],
                &[],
                "write finger.2.board, finger.2.address and hand.fingers into the configuration file",
            ),
        ] {
            let refusal = chosen(answers, taken).expect_err("refused");
            assert!(refusal.contains(reason), "{answers:?}: {refusal}");
        }
    }
}
