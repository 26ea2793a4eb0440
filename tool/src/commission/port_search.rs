//! Finds the board of a finger that has none in the configuration.

use std::path::PathBuf;
use sun2xp::hand::{FoundFinger, search_boards};
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

    /// The keys of the table of the finger.
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

/// Searches these ports for the board of a finger. `taken` are the boards of other fingers.
///
/// # Errors
/// Returns the reason if no board or no single board belongs to the finger.
pub fn search(patterns: &[String], baud: u32, finger: FingerNumber, taken: &[BoardNumber]) -> Result<Chosen, String> {
    let searched = search_boards(patterns, &[baud]);
    let answers = searched.iter().flat_map(|port| {
        let found = port.answer.iter().flatten().cloned();
        found.map(|found| Answer { port: port.path.clone(), found })
    });
    choose(answers.collect(), finger, taken).map_err(|reason| format!("{reason} ({})", Shown(&patterns.join(", "))))
}

fn choose(answers: Vec<Answer>, finger: FingerNumber, taken: &[BoardNumber]) -> Result<Chosen, String> {
    let (others, free): (Vec<Answer>, Vec<Answer>) =
        answers.into_iter().partition(|answer| taken.contains(&answer.number()));
    // A board can have several fingers. One with the address of this finger is the right one.
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
                "{} fingers answer: {all}. Connect only one, or name its port with --port",
                free.len()
            ));
        }
    };
    Ok(Chosen { answer: answer.clone(), reason })
}
