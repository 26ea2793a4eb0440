//! The cases of a comparison (its sides) are measured alternately, so that a disturbance of the machine affects them
//! alike.

/// Number and duration of the measurements.
#[derive(clap::Args)]
pub struct Turns {
    /// Number of measurements of each side.
    #[arg(long, default_value_t = Self::default().repeats)]
    pub repeats: usize,
    /// Duration of each measurement, s.
    #[arg(long, default_value_t = Self::default().seconds)]
    pub seconds: u64,
}

impl Default for Turns {
    fn default() -> Self {
        Self { repeats: 5, seconds: 5 }
    }
}
