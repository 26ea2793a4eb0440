//! The person in front of a terminal, or a script at standard input.

use super::outcome::Outcome;
use super::person::{Act, Answer, NoAnswer, Person};
use super::progress_file::{CommissionedFinger, Done};
use super::step::Step;
use crate::failure::Failure;
use crate::monitor::words::wrap;
use crate::print::{Look, Screen, painted};
use std::io::{self, BufRead, IsTerminal, Write};
use std::path::Path;
use sun2xp::model::ShownPath;
use sun2xp::model::configuration::ConfiguredFinger;

/// Width of the text where the output is not a terminal, columns.
const WIDTH: usize = 100;

/// Prompts on standard output, and answers on standard input.
pub struct Terminal {
    screen: Screen,
    /// Whether every request counts as done at once.
    yes: bool,
    /// Whether to print nothing, because standard output is for other programs.
    pub quiet: bool,
    /// Retries that are left in this session. With `yes`, what has failed is tried again without a question until this
    /// number is 0.
    pub retries: u32,
    /// The steps of this session.
    steps: Vec<Step>,
}

/// An answer to a prompt.
enum Reply {
    Enter,
    No,
}

impl Terminal {
    pub fn new(yes: bool, steps: Vec<Step>) -> Self {
        Self { screen: Screen::stdout(), yes, quiet: false, retries: 0, steps }
    }

    /// Prints the steps that have passed and are not done again in this session, and the steps that have failed.
    pub fn heading(&self, finger: i32, file: &Path, known: &CommissionedFinger) -> Result<(), Failure> {
        self.line(Look::Title, &format!("Commissioning finger {finger} of {}", ShownPath(file)));
        for (step, Done { when, .. }) in known.steps.iter().filter(|(step, _)| !self.steps.contains(step)) {
            self.line(Look::Dim, &format!("  done   {step}, {when}"));
        }
        for (step, Done { when, found }) in &known.failed {
            self.paragraph(Look::Warning, "  failed ", &format!("{step}, {when}: {}", found.join("; ")));
        }
        if self.steps.is_empty() {
            self.line(
                Look::Plain,
                "  Every step has passed. --step STEP does one step again, and --again does all steps again.",
            );
        }
        Ok(())
    }

    fn line(&self, look: Look, text: &str) {
        if self.quiet {
            return;
        }
        // An error is ignored. If the reader of standard output has ended, nobody needs the line, and the next question
        // fails.
        let _ = writeln!(io::stdout(), "{}", painted(&self.screen, look, text));
    }

    /// Prints `mark` and a text. The further lines of the text are indented by the width of `mark`.
    fn paragraph(&self, look: Look, mark: &str, text: &str) {
        let width = self.screen.width.unwrap_or(WIDTH).saturating_sub(mark.len());
        for (number, line) in wrap(text, width).iter().enumerate() {
            let mark = if number == 0 { mark } else { &" ".repeat(mark.len()) };
            self.line(look, &format!("{mark}{line}"));
        }
    }

    /// Prints a question, and reads a line.
    fn reply(&self, question: &str, done: &str, no: &str) -> Result<Reply, Failure> {
        if self.quiet && self.yes {
            return Ok(Reply::Enter);
        }
        let width = self.screen.width.unwrap_or(WIDTH).saturating_sub(4);
        let lines: Vec<String> = match question.split_once('\n') {
            // The lines below the first one are a table, which is not wrapped.
            Some((text, table)) => wrap(text, width).into_iter().chain(table.lines().map(String::from)).collect(),
            None => wrap(question, width),
        };
        let keys = format!("[Enter: {done}; n: {no}; q: leave]");
        let mut output = io::stdout().lock();
        write!(output, "  > {}\n    {} ", lines.join("\n    "), painted(&self.screen, Look::Dim, &keys))?;
        if self.yes {
            writeln!(output, "(--yes)")?;
            return Ok(Reply::Enter);
        }
        if !io::stdin().is_terminal() {
            // A script reads whole lines.
            writeln!(output)?;
        }
        output.flush()?;
        drop(output);
        loop {
            let mut line = String::new();
            if io::stdin().lock().read_line(&mut line)? == 0 {
                return Err(NoAnswer::InputEnded.into());
            }
            match line.trim() {
                "" | "y" | "yes" => return Ok(Reply::Enter),
                "n" | "no" => return Ok(Reply::No),
                "q" | "quit" => return Err(NoAnswer::Left.into()),
                _ => self.line(Look::Dim, "    not understood: press Enter, or type n or q and then press Enter"),
            }
        }
    }
}

impl Person for Terminal {
    fn begin(&mut self, step: Step, _: &ConfiguredFinger) -> Result<(), Failure> {
        self.line(Look::Title, &format!("\nStep {} of {}: {step}", step.number(), Step::ALL.len()));
        self.paragraph(Look::Plain, "  does   ", step.does());
        self.paragraph(Look::Plain, "  expect ", step.expect());
        Ok(())
    }

    fn ask(&mut self, act: Act) -> Result<Answer, Failure> {
        let (done, no) = match act {
            Act::PressEmergencyStop => ("done", "there is none"),
            Act::TurnMotor(_) => ("done", "it does not turn"),
            Act::ConfirmDirection => ("yes", "no"),
            _ => ("done", "I cannot"),
        };
        match self.reply(act.text().trim_end(), done, no)? {
            Reply::Enter => Ok(Answer::Done),
            Reply::No => Ok(Answer::Cannot),
        }
    }

    fn show(&mut self, line: &str) {
        self.line(Look::Dim, &format!("    {line}"));
    }

    fn conclude(&mut self, outcome: &Outcome) {
        for line in &outcome.found {
            self.paragraph(Look::Plain, "  found  ", line);
        }
        for wrong in &outcome.wrong {
            let (look, word) = match (wrong.compensated(), wrong.suspect()) {
                (true, false) => (Look::Warning, "note "),
                (true, true) => (Look::Warning, "CHECK"),
                (false, _) => (Look::Bad, "WRONG"),
            };
            self.paragraph(look, &format!("  {word:<6} "), &wrong.to_string());
            let remedy = wrong.remedy();
            if !remedy.is_empty() {
                self.paragraph(Look::Plain, "         ", &format!("{remedy}."));
            }
        }
        match outcome.passed() {
            true => self.line(Look::Good, "  passed"),
            false => self.line(Look::Bad, "  not passed"),
        }
    }

    fn again(&mut self, question: &str) -> Result<bool, Failure> {
        if self.yes {
            let retries = self.retries;
            self.retries = retries.saturating_sub(1);
            return Ok(retries > 0);
        }
        Ok(matches!(self.reply(question, "try again", "do not try again")?, Reply::Enter))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_person_a_failed_step_is_tried_again_a_limited_number_of_times() {
        let mut terminal = Terminal::new(true, vec![Step::Zeros]);
        terminal.quiet = true;
        assert!(!terminal.again("Do it again.").expect("answered"));
        terminal.retries = 2;
        let answers = [(); 3].map(|()| terminal.again("Do it again.").expect("answered"));
        assert_eq!(answers, [true, true, false]);
    }
}
