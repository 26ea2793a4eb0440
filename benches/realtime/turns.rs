//! What is compared is measured in turn, so that a disturbance of the machine hits one side like the other.

/// How often, and how long.
#[derive(clap::Args)]
pub struct Turns {
    /// How often each is measured, in turn.
    #[arg(long, default_value_t = Self::default().repeats)]
    pub repeats: usize,
    /// How long each time, s.
    #[arg(long, default_value_t = Self::default().seconds)]
    pub seconds: u64,
}

impl Default for Turns {
    fn default() -> Self {
        Self { repeats: 5, seconds: 5 }
    }
}
