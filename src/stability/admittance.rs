//! The driving-point admittance of a fingertip: the velocity with which the tip responds to a force on it.

use super::one_cycle_map::{Moving, OneCycleMap};
use super::rest::Rest;
use crate::plant::Plant;
use nalgebra::{Complex, Matrix3, Vector3};
use std::f64::consts::TAU;

/// Force of a pulse, N. It is so small that the response is linear.
const PULSE: f64 = 1e-3;

/// Longest observation of the response to a pulse, s.
const OBSERVED: f64 = 8.0;

/// The response is over when its velocity stays below [`OVER`] times its largest velocity for this time, s. This time
/// is longer than a period of the slow modes of the tip.
const QUIET: f64 = 0.25;
const OVER: f64 = 1e-6;

/// The admittance Y of a tip at one frequency: the velocity of the tip is Y times the force on it.
#[derive(Clone, Copy, Debug)]
pub struct Admittance {
    /// Frequency, Hz.
    pub frequency: f64,
    /// Y in the finger's frame, m/s per N.
    pub matrix: Matrix3<Complex<f64>>,
}

impl Admittance {
    /// Returns the least eigenvalue of the Hermitian part of Y, divided by the largest singular value of Y. The tip is
    /// passive at this frequency if the result is not negative. If it is negative, a force at this frequency in the
    /// worst direction receives energy from the finger. The smallest possible result is -1.
    pub fn passivity(&self) -> f64 {
        let hermitian = (self.matrix + self.matrix.adjoint()) * Complex::from(0.5);
        hermitian.symmetric_eigenvalues().min() / self.matrix.singular_values().max()
    }
}

impl OneCycleMap {
    /// Returns the driving-point admittance of the tip at `rest`, at each frequency, Hz. Returns None if the finger
    /// does not come to rest after a pulse, or a tendon is slack.
    ///
    /// The map of plant and controller is periodic with the period of the servo. So the response to a pulse depends on
    /// the instant of the pulse within a period. The admittance is the mean over all instants. A sinusoidal force
    /// causes a response with several frequencies, and this mean describes the part at the frequency of the force. The
    /// velocities are those in the middle of each plant step, because a force and the velocity at the end of its step
    /// differ in phase.
    pub fn admittances(&self, rest: &Rest, frequencies: &[f64]) -> Option<Vec<Admittance>> {
        let settled = self.settled(rest);
        let mut still = Vec::with_capacity(self.cycles(OBSERVED) * self.steps);
        let mut finger = settled.clone();
        for _ in 0..self.cycles(OBSERVED) {
            self.cycle_watched(&mut finger, None, |velocity| still.push(velocity));
            if finger.plant.tensions().min() <= 0.0 {
                return None;
            }
        }
        let mut sums = vec![Matrix3::zeros(); frequencies.len()];
        for axis in 0..3 {
            for instant in 0..self.steps {
                let pulse = Pulse { instant, force: settled.load + Vector3::ith(axis, PULSE) };
                let response = self.response(&settled, &still, &pulse)?;
                for (sum, frequency) in sums.iter_mut().zip(frequencies) {
                    let spectrum = self.spectrum(&response[instant..], *frequency);
                    sum.set_column(axis, &(sum.column(axis) + spectrum));
                }
            }
        }
        let mean = Complex::from(1.0 / (PULSE * self.steps as f64));
        let found = frequencies.iter().zip(sums);
        Some(found.map(|(&frequency, sum)| Admittance { frequency, matrix: sum * mean }).collect())
    }

    /// Returns the velocities of the tip in every plant step, m/s, after a pulse in the first cycle, minus the
    /// velocities without the pulse. Returns None if the tip does not come to rest.
    fn response(&self, settled: &Moving, still: &[Vector3<f64>], pulse: &Pulse) -> Option<Vec<Vector3<f64>>> {
        let mut finger = settled.clone();
        let mut response: Vec<Vector3<f64>> = Vec::new();
        let (mut largest, mut quiet) = (0.0f64, 0);
        while response.len() < still.len() {
            let began = response.len();
            let first = (began == 0).then_some(pulse);
            self.cycle_watched(&mut finger, first, |velocity| response.push(velocity - still[response.len()]));
            let size = response[began..].iter().map(Vector3::norm).fold(0.0, f64::max);
            largest = largest.max(size);
            quiet = if size > OVER * largest { 0 } else { quiet + 1 };
            if quiet > self.cycles(QUIET) {
                return Some(response);
            }
        }
        None
    }

    /// Runs one cycle, with a pulse in one of its plant steps. `watch` receives the velocity of the tip in each step.
    fn cycle_watched(&self, finger: &mut Moving, pulse: Option<&Pulse>, mut watch: impl FnMut(Vector3<f64>)) {
        let load = finger.load;
        let mut before = self.tip_velocity(&finger.plant);
        self.cycle_with(finger, |instant, plant, torques| {
            let force = pulse.filter(|pulse| pulse.instant == instant).map_or(load, |pulse| pulse.force);
            plant.set_external_force(force);
            plant.step(torques);
            let after = self.tip_velocity(plant);
            watch((before + after) * 0.5);
            before = after;
        });
    }

    fn tip_velocity(&self, plant: &Plant) -> Vector3<f64> {
        self.links.jacobian(&plant.joints()) * plant.joint_rates() * 0.01
    }

    /// Returns the Fourier transform of velocities in consecutive plant steps, relative to the first step.
    fn spectrum(&self, velocities: &[Vector3<f64>], frequency: f64) -> Vector3<Complex<f64>> {
        let turn = Complex::from_polar(1.0, -TAU * frequency * self.step);
        let mut phase = Complex::from(1.0);
        let mut sum = Vector3::zeros();
        for velocity in velocities {
            sum += velocity.map(|part| phase * part);
            phase *= turn;
        }
        sum
    }
}

/// A force in one plant step.
struct Pulse {
    /// Number of the plant step in its cycle.
    instant: usize,
    /// Force at the tip, N.
    force: Vector3<f64>,
}
