//! Prompts for the person who holds a finger that is zeroed at a pose.

use crate::failure::Failure;
use std::io::{self, Write};
use sun2xp::model::configuration::ConfiguredFinger;

/// Asks the person to hold the finger in its zeroing pose. If `yes` is true, the function does not wait for Enter.
pub fn ask_to_hold(finger: i32, configured: &ConfiguredFinger, yes: bool) -> Result<(), Failure> {
    let reason = match configured.zeroing.method {
        Some(_) => "zeroing.method is \"pose\"",
        None => "zeroing.lower_stop_degrees and zeroing.upper_stop_degrees are not both set",
    };
    let text = format!(
        "finger {finger} is zeroed at a pose, because {reason}.\n\
         Hold it in this pose with a jig or a steady hand, until its zeros are found (about 10 s):\n{}",
        pose(configured.zeroing.pose_degrees)
    );
    wait(&text, ["when you hold it there", "a jig holds the finger"], yes)
}

/// Asks the person to let go of a finger that will move by itself. `yes` has the same meaning as in [`ask_to_hold`].
pub fn ask_to_release(finger: i32, yes: bool) -> Result<(), Failure> {
    wait(
        &format!("finger {finger} will move by itself. Let go of it and clear the space around it.\n"),
        ["when it is free", "nothing holds the finger"],
        yes,
    )
}

/// Describes the joints in words, one per line.
pub fn pose([side, base, middle]: [f64; 3]) -> String {
    let toward = |angle: f64, positive, negative, zero| match angle {
        angle if angle > 0.0 => positive,
        angle if angle < 0.0 => negative,
        _ => zero,
    };
    let side_words =
        toward(side, "swung toward the +x axis of its frame", "swung toward its -x axis", "straight ahead");
    let base_words = toward(base, "bent inward", "bent back", "in line with the first link");
    let middle_words = toward(middle, "bent inward", "bent back", "in line with the middle link");
    format!(
        "  joint 0, which swings the whole finger sideways:        {side:6.1} degrees, {side_words}\n  \
           joint 1, which bends the middle link against the first: {base:6.1} degrees, {base_words}\n  \
           joint 2, which bends the last link against the middle:  {middle:6.1} degrees, {middle_words}\n"
    )
}

/// Waits for Enter, unless `yes` is true. `when` says when to press Enter, and `condition` when `--yes` may be given.
fn wait(text: &str, [when, condition]: [&str; 2], yes: bool) -> Result<(), Failure> {
    let mut output = io::stderr().lock();
    write!(output, "{text}")?;
    if yes {
        writeln!(output, "Continuing without waiting (--yes).")?;
        return Ok(());
    }
    write!(output, "Press Enter {when}, or Ctrl-C to cancel: ")?;
    output.flush()?;
    if io::stdin().read_line(&mut String::new())? == 0 {
        writeln!(output)?;
        return Err(format!(
            "standard input ended before Enter was pressed: run the tool in a terminal, or with --yes if {condition}"
        )
        .into());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_joint_is_described_in_degrees_and_in_words() {
        let text = pose([-5.0, 30.0, 0.0]);
        for part in
            ["-5.0 degrees, swung toward its -x axis", "30.0 degrees, bent inward", " 0.0 degrees, in line with"]
        {
            assert!(text.contains(part), "{part:?} is not in:\n{text}");
        }
        assert_eq!(text.lines().count(), 3);
    }
}
